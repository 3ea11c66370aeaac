"""The JSON schema of case files, by which editors complete and check keys."""

from __future__ import annotations

import json
import subprocess
import sys
from pathlib import Path
from typing import Any

import pytest

jsonschema = pytest.importorskip("jsonschema")
tomllib = pytest.importorskip("tomllib")

CRATES = Path(__file__).parents[2] / "crates"


@pytest.fixture(scope="module")
def validator() -> Any:
    command = [sys.executable, "-m", "asperity", "check", "--schema"]
    schema = json.loads(subprocess.run(command, capture_output=True, text=True, check=True).stdout)
    jsonschema.Draft7Validator.check_schema(schema)
    return jsonschema.Draft7Validator(schema)


def completed(case: Any, ball: Any) -> Any:
    """A case of ``ball.toml``, with the keys of the ball that it lacks."""
    loads = {"mean_pressure", "approach", "loads", "mean_pressures", "approaches"}
    for key, value in ball.items():
        if isinstance(value, dict) and key in case and key != "topography":
            completed(case[key], value)
        elif key != "load" or not case.keys() & loads:
            case.setdefault(key, value)
    return case


def cases() -> dict[str, Any]:
    folders = [CRATES / "asperity-cli/examples", CRATES / "asperity-study/tests/inputs/good"]
    files = sorted(file for folder in folders for file in folder.rglob("*.toml"))
    found = {str(file): tomllib.loads(file.read_text(encoding="utf-8")) for file in files}
    rows = found.pop(next(name for name in found if name.endswith("ball.toml")))
    ball = rows.pop("ball")
    rows = {name: completed(case, ball) for name, case in rows.items()}
    return rows | {name: case for name, case in found.items() if "base" not in case}


@pytest.mark.skipif(not CRATES.exists(), reason="an installed package without the examples")
def test_every_case_that_is_computed_is_valid(validator: Any) -> None:
    assert len(cases()) > 30
    for name, case in cases().items():
        errors = [error.message for error in validator.iter_errors(case)]
        assert errors == [], name


BALL = """
lower = { young = "210 GPa", poisson = 0.3, topography = { form = "flat", shape = [16, 16], pitch = "1 um" } }
upper = { young = "210 GPa", poisson = 0.3, topography = { form = "sphere", radius = "1 mm" } }
contact = { load = "1 N" }
"""


@pytest.mark.parametrize(
    ("right", "wrong"),
    [
        ('load = "1 N"', 'laod = "1 N"'),
        ('load = "1 N"', 'load = "1 N", boundary = 3, method = "fast"'),
        ("poisson = 0.3", "poisson = 0.7"),
        ('form = "sphere"', 'form = "ball"'),
        ("contact =", "contacts ="),
        ('young = "210 GPa", ', ""),
        ("contact =", 'flow = { pressure = "1 bar" }\ncontact ='),
        ("contact =", 'conductance = { kind = "magnetic" }\ncontact ='),
    ],
)
def test_a_mistake_is_found(validator: Any, right: str, wrong: str) -> None:
    assert validator.is_valid(tomllib.loads(BALL)) and right in BALL
    assert not validator.is_valid(tomllib.loads(BALL.replace(right, wrong, 1)))
