"""Wear by slip in the cycles of a history."""

from __future__ import annotations

import pathlib
from typing import Any

import numpy as np
import pytest

import asperity as asp

STEEL = asp.Material(young="210 GPa", poisson=0.3)


def fretted(**more: Any) -> asp.Contact:
    plate = asp.Body(asp.form.flat((32, 32), pitch="13 um"), STEEL, wear={"coefficient": "1e-6 mm3/(N m)"})
    ball = asp.Body(asp.form.sphere("10 mm"), STEEL)
    history = [{"force": "20 N", "increments": 2}, {"force": "-20 N", "increments": 2, "cycles": 300}]
    acceleration = {"max_wear": "1 um"}
    return asp.contact(
        plate, ball, load="50 N", friction={"coefficient": 0.6}, history=history, acceleration=acceleration, progress=False, **more
    )


def test_the_volume_is_in_proportion_to_the_energy(tmp_path: pathlib.Path) -> None:
    contact = fretted()
    assert contact.numbers["cycles"] == 300 and len(contact.increments) < 100
    volume = contact.numbers["worn_volume_lower"]
    assert volume == pytest.approx(1e-15 / 0.6 * contact.numbers["dissipation"], rel=1e-3)
    scar = contact.fields["wear_lower"].values
    assert np.sum(scar) * (13e-6) ** 2 == pytest.approx(volume, rel=1e-12)
    # The middle sticks and does not wear.
    assert scar[16, 16] == 0.0 and contact.fields["stick"].values[16, 16] == 1.0
    assert contact.increments["cycles"][-1] == 300
    kept = fretted(out=tmp_path / "out")
    assert (kept.numbers, kept.fields) == (contact.numbers, contact.fields)


def test_cycles_that_slide_are_refused() -> None:
    with pytest.raises(asp.errors.CaseError, match="go there and back"):
        asp.contact(
            asp.form.flat((8, 8), pitch=1e-6), asp.form.sphere(1e-3), STEEL, STEEL, load=1.0, friction=0.3,
            history=[{"sliding": [1, 0], "cycles": 3}],
        )  # fmt: skip
