"""Damaged results: an error of the package that names the file, whatever was done to it."""

from __future__ import annotations

import pathlib
import shutil
from typing import Any

import asperity as asp
import pytest
from asperity import errors

STEEL = 'young = "210 GPa"\npoisson = 0.3\n'
BALL = (
    f'[lower]\n{STEEL}topography = {{ form = "flat", shape = [12, 12], pitch = "1 um" }}\n'
    f'[upper]\n{STEEL}topography = {{ form = "sphere", radius = "50 um" }}\n'
)
MOVING = "".join(
    f'[{body}]\n{STEEL}hardness = "4 GPa"\ntopography = {{ generate = "low-pass", shape = [16, 16], pitch = "1 um", '
    f'sq = "30 nm", cutoff = "8 um", seed = {seed} }}\n'
    for body, seed in (("lower", 1), ("upper", 2))
)
KINDS = {
    "rest": BALL + '[contact]\nload = "5 mN"\n[subsurface]\nto = "5 um"\nlayers = 3\n',
    "stages": BALL + '[contact]\nload = "5 mN"\n[friction]\ncoefficient = 0.3\n[[history]]\nforce = "0.5 mN"\nincrements = 2\n',
    "rolling": BALL + '[contact]\nload = "5 mN"\n[friction]\ncoefficient = 0.3\ncreepage = [2e-3, 0.0]\n',
    "sweep": BALL + '[contact]\nloads = ["5 mN", "8 mN"]\n[output]\npressure_every = 1\n',
    "in place": BALL
    + 'wear = { coefficient = 1e-13 }\n[contact]\nload = "5 mN"\n[friction]\ncoefficient = 0.1\n'
    + '[sliding]\ndistance = "10 mm"\nupdates = 3\n',
    "passes": MOVING
    + '[contact]\nload = "20 mN"\n[motion]\npasses = 2\nstride = 8\n[subsurface]\nto = "5 um"\nlayers = 3\n',
    "plastic": BALL.replace("[upper]", 'plasticity = { yield_stress = "0.3 GPa" }\n[upper]').replace("[12, 12]", "[8, 8]")
    + '[contact]\nload = "5 mN"\n[plasticity]\ndepth = "4 um"\nlayers = 3\nincrements = 2\n',
}  # fmt: skip


def everything(directory: pathlib.Path) -> None:
    """Read all there is of results."""
    found = asp.open(directory)
    repr(found)
    if isinstance(found, asp.Run):
        _ = found.case, found.passes, found.steps, found.warnings, found.wall_time, found.is_done, found.regime
        for number in range(len(found.passes) + 1):
            _ = {name: field.values for name, field in found.fields(number).items()}
            _ = found.lower(number), found.upper(number)
            if number > 0 and "subsurface" in found.case:
                _ = {name: field.values for name, field in found.subsurface(number).items()}
        found._repr_html_()
    else:
        _ = {name: field.values for name, field in found.fields.items()}
        _ = found.numbers, found.increments, found.updates, found.sweep, found.warnings, found.case, found.plastic_state
        _ = found.contact_fraction, found.lower, found.upper
        found._repr_html_()


@pytest.mark.parametrize("kind", KINDS)
def test_damaged_results_raise_an_error_that_names_the_file(kind: str, tmp_path: pathlib.Path) -> None:
    (tmp_path / "case.toml").write_text(KINDS[kind])
    whole = tmp_path / "whole"
    asp.run(tmp_path / "case.toml", out=whole, progress=False)
    everything(whole)
    files = [path.relative_to(whole) for path in sorted(whole.rglob("*")) if path.is_file() and path.name != ".lock"]
    assert len(files) >= 3
    refused = set()
    for file in files:
        content = (whole / file).read_bytes()
        damages: dict[str, Any] = {
            "removed": None, "emptied": b"", "cut off": content[: len(content) // 2], "a number": b"3", "a line": b"3\n",
            "a list": b"[1, 2]", "nothing": b"null",
        }  # fmt: skip
        for how, damage in damages.items():
            out = tmp_path / "out"
            shutil.copytree(whole, out)
            (out / file).unlink()
            if damage is not None:
                (out / file).write_bytes(damage)
            try:
                everything(out)
            except errors.AsperityError as error:
                refused.add(str(file))
                # Without a summary it is a run under way, which a static contact has to finish.
                is_named = file.name in str(error) or (str(file) == "summary.json" and how == "removed")
                assert is_named, f"{file} {how}: {error}"
            finally:
                shutil.rmtree(out)
    # results.csv is for spreadsheets.
    unread = ("subsurface.h5", "results.csv")
    spare = {str(file) for file in files if "state" in file.name or "point-" in file.name or file.name in unread}
    assert refused | spare >= {str(file) for file in files}, "what is damaged goes unseen"


@pytest.mark.parametrize("case", ["3", "[]", '{"motion": {}}', '{"motion": {"passes": "two"}}', '{"motion": 3}', '{"title": 3}',
                                  '{"contact": 3}', '"text"', "null"])  # fmt: skip
def test_a_case_that_is_none_is_named(case: str, tmp_path: pathlib.Path) -> None:
    (tmp_path / "case.json").write_text(case)
    with pytest.raises(errors.AsperityError, match=r"case\.json"):
        everything(tmp_path)
    with pytest.raises(errors.AsperityError, match=r"case\.json"):
        asp.Run(tmp_path).report()
