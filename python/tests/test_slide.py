"""Wear in place."""

from __future__ import annotations

import pathlib

import numpy as np
import pytest

import asperity as asp

STEEL = asp.Material(young="210 GPa", poisson=0.3)


def worn(**more: object) -> asp.Contact:
    ball = asp.Body(asp.form.sphere("50 mm"), STEEL, wear={"coefficient": 1.33e-13})
    disc = asp.Body(asp.form.flat((65, 65), pitch="20 um"), STEEL)
    return asp.slide(disc, ball, load=10.3846, distance="640 mm", updates=40, progress=False, **more)  # type: ignore[arg-type]


def test_a_ball_on_a_disc_wears_to_its_closed_form(tmp_path: pathlib.Path) -> None:
    contact = worn()
    updates = contact.updates
    assert len(updates) == 41 and updates["distance"][-1] == pytest.approx(0.64)
    assert updates["wear_volume_upper"] == pytest.approx(1.33e-13 * 10.3846 * updates["distance"], rel=1e-9)
    # Argatov, Wear 271, 1147 (2011), with a uniform pressure: 2.3546 µm.
    assert contact.fields["wear_upper"].values.max() == pytest.approx(2.3546e-6, rel=1e-3)
    assert np.all(contact.updates["wear_volume_lower"] == 0.0)
    kept = worn(out=tmp_path / "out")
    assert (kept.numbers, kept.fields) == (contact.numbers, contact.fields)
    assert kept.updates["max_pressure"].tolist() == contact.updates["max_pressure"].tolist()


def test_what_does_not_wear_does_not_slide() -> None:
    with pytest.raises(asp.errors.CaseError):
        asp.slide(asp.form.flat((8, 8), pitch=1e-6), asp.form.sphere(1e-3), STEEL, STEEL, load=1.0, distance=1.0)
