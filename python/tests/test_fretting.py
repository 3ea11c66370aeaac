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
    history = [{"force": "20 N", "increments": 2}, {"force": "-20 N", "increments": 2, "cycles": 30}]
    acceleration = {"max_wear": "1 um"}
    return asp.contact(
        plate, ball, load="50 N", friction={"coefficient": 0.6}, history=history, acceleration=acceleration, progress=False, **more
    )


def test_worn_bodies_have_their_numbers_and_fields(tmp_path: pathlib.Path) -> None:
    contact = fretted()
    assert contact.cycles == contact.increments["cycles"][-1] == 30
    scar = contact.fields["wear_lower"].values
    assert np.sum(scar) * (13e-6) ** 2 == pytest.approx(contact.worn_volume_lower, rel=1e-12)
    assert contact.max_wear_lower == scar.max() > 0.0 == contact.worn_volume_upper
    kept = fretted(out=tmp_path / "out")
    assert (kept.numbers, kept.fields) == (contact.numbers, contact.fields)


def test_cycles_that_slide_are_refused() -> None:
    with pytest.raises(asp.errors.CaseError, match="go there and back"):
        asp.contact(
            asp.form.flat((8, 8), pitch=1e-6), asp.form.sphere(1e-3), STEEL, STEEL, load=1.0, friction=0.3,
            history=[{"sliding": [1, 0], "cycles": 3}],
        )  # fmt: skip
