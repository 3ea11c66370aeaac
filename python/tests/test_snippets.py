"""The Python of the documents runs, each page in a directory of its own."""

import re
import subprocess
import sys
from pathlib import Path

import pytest

pytest.importorskip("sybil")
pytest.importorskip("matplotlib").use("agg")

from sybil import Sybil
from sybil.parsers.markdown import PythonCodeBlockParser, SkipParser

ROOT = Path(__file__).parents[2]
SYBIL = Sybil(parsers=[PythonCodeBlockParser(), SkipParser()])
PAGES = [page for page in [ROOT / "README.md", *sorted(ROOT.glob("docs/python/*.md"))] if page.exists()]


@pytest.mark.parametrize("page", PAGES, ids=lambda page: page.relative_to(ROOT).as_posix())
@pytest.mark.filterwarnings("ignore::asperity.errors.ModelWarning")
def test_the_snippets_of_a_page_run(page, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    text = page.read_text(encoding="utf-8")
    for name, command in [("quickstart/results", ["run", "--example", "quickstart"]), ("measured/disc.x3p", ["example", "measured"])]:
        if name in text:
            subprocess.run([sys.executable, "-m", "asperity", *command], check=True, capture_output=True)
    examples = list(SYBIL.parse(page))
    assert len(examples) >= len(re.findall(r"^```python$", text, re.MULTILINE))
    for example in examples:
        example.evaluate()
