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


def cases() -> list[Path]:
    folders = [CRATES / "asperity-cli/examples", CRATES / "asperity-study/tests/inputs/good"]
    files = sorted(file for folder in folders for file in folder.rglob("*.toml"))
    return [file for file in files if "base" not in tomllib.loads(file.read_text(encoding="utf-8"))]


@pytest.mark.skipif(not CRATES.exists(), reason="an installed package without the examples")
def test_every_case_that_is_computed_is_valid(validator: Any) -> None:
    assert len(cases()) > 30
    for file in cases():
        errors = [error.message for error in validator.iter_errors(tomllib.loads(file.read_text(encoding="utf-8")))]
        assert errors == [], file


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
