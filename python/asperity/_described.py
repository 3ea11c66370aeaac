"""Attributes that are described where they are declared, and the rows of docstrings."""

from __future__ import annotations

import inspect
import re
import sys
from types import NoneType, UnionType
from typing import Annotated, Any, ForwardRef, Literal, TypeVar, Union, cast, get_args, get_origin, is_typeddict

Kind = TypeVar("Kind", bound=type)

Meanings = dict[str, tuple[Any, ...]]
"""Type and meaning of attributes or parameters by name."""

_WIDTH = 116
"""Width of the lines of a row."""

_LATER = re.compile(r"^(Raises|Warns|Notes|References|Examples)\n-+$", re.MULTILINE)
"""Sections of a docstring that follow the attributes."""


def described(kind: Kind) -> Kind:
    """Decorates a class: the meanings of its attributes, and of the parameters of its constructor, become sections of its docstring.

    An attribute or a parameter with a meaning is declared as ``load: Annotated[float, "Total normal force, N."]``. Signatures show
    the types alone. The docstring is made when it is read: all of them would take as long as the rest of the import.
    """
    init = vars(kind).get("__init__")
    parameters = {} if init is None else _meanings(kind, init.__annotations__)
    # The signature of a named tuple has its attributes.
    of_tuple = getattr(kind.__new__, "__annotations__", None)
    attributes = None if of_tuple is None else _meanings(kind, of_tuple)
    kind.__doc__ = cast(str, _Docstring(kind, parameters, attributes))
    return kind


class _Docstring:
    """The docstring of a described class."""

    def __init__(self, kind: type, parameters: Meanings, attributes: Meanings | None) -> None:
        self._kind = kind
        self._text = kind.__doc__ or ""
        self._parameters = parameters
        self._attributes = attributes

    def __get__(self, instance: object, owner: type) -> str:
        if self._attributes is None:
            self._attributes = _meanings(self._kind, dict(self._kind.__annotations__))
        text = inspect.cleandoc(self._text)
        for title, meanings in (("Parameters", self._parameters), ("Attributes", self._attributes)):
            if meanings:
                later = _LATER.search(text)
                place = later.start() if later else len(text)
                rows = [row(name, words(kind), meaning) for name, (kind, meaning) in meanings.items()]
                section = "\n".join([title, "-" * len(title), *rows])
                text = f"{text[:place].rstrip()}\n\n{section}\n\n{text[place:]}".rstrip() + "\n"
        return text


def _meanings(kind: type, annotations: dict[str, Any]) -> Meanings:
    """Type and meaning of all that has a meaning. Only its type is left in the `annotations`."""
    names, found = vars(sys.modules[kind.__module__]), {}
    for name, stated in annotations.items():
        # A named tuple wraps its texts.
        declared: Any = getattr(stated, "__forward_arg__", stated)
        if isinstance(declared, str):
            declared = eval(declared, names) if declared.startswith("Annotated[") else names.get(declared)
        if get_origin(declared) is Annotated:
            found[name] = get_args(declared)
    annotations.update({name: of for name, (of, _) in found.items()})
    return found


def row(name: str, kind: str, text: str) -> str:
    """A name, its type in words and its meaning, as a row of a docstring."""
    lines = [""]
    # Much faster than `textwrap`, at each import.
    for word in text.split():
        if len(lines[-1]) + 1 + len(word) > _WIDTH:
            lines.append("")
        lines[-1] += f" {word}" if lines[-1] else word
    return "\n    ".join([f"{name} : {kind}", *lines])


def words(kind: Any) -> str:
    """A type as docstrings name it: ``float or str``."""
    origin, arguments = get_origin(kind), get_args(kind)
    if origin is Annotated:
        return words(arguments[0])
    if origin in (Union, UnionType):
        return " or ".join(map(words, arguments))
    if origin is Literal:
        return "{" + ", ".join(f'"{word}"' for word in arguments) + "}"
    if kind is NoneType:
        return "None"
    if isinstance(kind, ForwardRef):
        return kind.__forward_arg__.replace(" | ", " or ")
    if is_typeddict(kind):
        return f"keys.{kind.__name__}"
    if origin in (list, tuple) and arguments:
        return f"{origin.__name__} of {words(arguments[0])}"
    if origin is dict:
        return f"dict of {words(arguments[0])} to {words(arguments[1])}" if arguments[1] is not Any else "dict"
    name: str = (origin or kind).__name__
    return {"PathLike": "path", "Sequence": "sequence", "Callable": "callable"}.get(name, name)
