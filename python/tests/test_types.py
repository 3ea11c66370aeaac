"""Types that editors and type checkers see."""

from __future__ import annotations

import inspect
import re
import subprocess
import sys
import textwrap
from pathlib import Path

import asperity as asp
import pytest

INPUT = Path(__file__).parents[2] / "docs/input"
TABLES = {
    "Friction": "friction", "Stage": "history", "Plasticity": "plasticity", "Subsurface": "subsurface",
    "Conductance": "conductance", "Flow": "flow", "Adhesion": "adhesion",
    "Acceleration": "acceleration", "Temperature": "temperature", "Wear": "lower.wear", "Film": "lower.film",
    "Viscoelastic": "lower.viscoelastic", "Steady": "steady", "Lubrication": "lubrication", "Fatigue": "fatigue", "Joint": "joint", "FatigueLimits": "lower.fatigue",
}  # fmt: skip


def test_every_table_has_a_type() -> None:
    assert TABLES.keys() | {"Thermal"} == set(asp.keys.__all__)


@pytest.mark.skipif(not INPUT.exists(), reason="an installed package without the documents")
@pytest.mark.parametrize(("name", "table"), TABLES.items())
def test_a_type_has_the_keys_of_the_table_of_a_case_file(name: str, table: str) -> None:
    pages = "".join(page.read_text(encoding="utf-8") for page in INPUT.glob("*.md"))
    keys: dict[str, bool] = {}
    for listed in re.findall(rf"<!-- keys: {re.escape(table)}(?: with .*)? -->\n\n((?:\|.*\n)+)", pages):
        for key, default in re.findall(r"^\| `(\w+)` \|.*\| (.*?) \|$", listed, re.MULTILINE):
            # Keys of one law are optional in a type for all of them.
            keys[key] = keys.get(key, False) or default == "required" and "law" in (listed[:200] if name == "Film" else "law")
    kind = getattr(asp.keys, name)
    assert set(kind.__annotations__) == set(keys)
    assert kind.__required_keys__ == {key for key, is_required in keys.items() if is_required}
    described = re.findall(r"^    (\w+) : ", inspect.cleandoc(kind.__doc__).replace("\n", "\n    "), re.MULTILINE)
    assert described == [*kind.__annotations__]


def test_mypy_finds_wrong_words_and_keys(tmp_path: Path) -> None:
    pytest.importorskip("mypy")
    program = """
        import asperity as asp

        steel = asp.Material("210 GPa", 0.3)
        ball, plane = asp.form.sphere("10 mm"), asp.form.flat((32, 32), "10 um")
        c = asp.contact(ball, plane, steel, steel, load="1 N", boundary=["free", "periodic"], friction={"coefficient": 0.3})
        c.plot().set_title("pressure")
        c.sweep.to_xarray().sel(point=1)
        asp.contact(ball, plane, steel, steel, load="1 N", boundary="perodic")
        asp.contact(ball, plane, steel, steel, load="1 N", friction={"coeff": 0.3})
        asp.contact(ball, plane, steel, steel, load="1 N", history=[{"lod": "2 N"}])
        asp.simulate(ball, plane, steel, steel, load="1 N", strategy="overlp", offset_y="anywhere")
        asp.Body(ball, steel, wear={"coeficient": 1e-15})
        c.sweep.to_pandas(units="nm")
    """
    file = tmp_path / "program.py"
    file.write_text(textwrap.dedent(program))
    command = [sys.executable, "-m", "mypy", "--cache-dir", str(tmp_path), "--ignore-missing-imports", str(file)]
    answer = subprocess.run(command, capture_output=True, text=True)
    found = {int(line) for line in re.findall(r"program\.py:(\d+): error", answer.stdout)}
    assert found == {9, 10, 11, 12, 13, 14}, answer.stdout
