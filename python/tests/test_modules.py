"""The modules of the package: which may import which."""

from __future__ import annotations

import ast
import graphlib
import pathlib
from collections.abc import Iterator

import asperity as asp

PACKAGE = pathlib.Path(asp.__file__).parent


def imports(tree: ast.AST) -> Iterator[str]:
    """Names of the package's own modules that a module imports, also within its functions and for its types alone."""
    for node in ast.iter_child_nodes(tree):
        if isinstance(node, ast.ImportFrom) and node.level == 1:
            yield from [node.module] if node.module else [name.name for name in node.names]
        yield from imports(node)


def test_no_module_imports_itself_through_others() -> None:
    modules = {path.stem: path.read_text(encoding="utf-8") for path in PACKAGE.glob("*.py")}
    graph = {name: set(imports(ast.parse(text))) & modules.keys() for name, text in modules.items()}
    assert {"_contact", "_html"} <= graph["_run"] | graph["fields"], "the imports are not found"
    # A circle is an exception that names it.
    list(graphlib.TopologicalSorter(graph).static_order())
