"""The plastic state below the surfaces of elasto-plastic bodies."""

from __future__ import annotations

import pathlib

import numpy as np
import pytest

import asperity as asp

STEEL = asp.Material(young="210 GPa", poisson=0.3)
SOFT = asp.Material(
    young="210 GPa", poisson=0.3, plasticity=asp.Plasticity(yield_stress="1.5 GPa", hardening="5 GPa", kinematic="1 GPa")
)
VOLUME = {"depth": "72 um", "layers": 8, "increments": 3}


def pressed(**more: object) -> asp.Contact:
    plane, ball = asp.form.flat((24, 24), pitch="6 um"), asp.form.sphere("1 mm")
    return asp.contact(plane, ball, SOFT, STEEL, load="20 N", plasticity=VOLUME, progress=False, **more)  # type: ignore[arg-type]


@pytest.mark.filterwarnings("ignore")
def test_a_ball_leaves_a_dent_and_what_flows_keeps_its_volume(tmp_path: pathlib.Path) -> None:
    contact = pressed()
    assert list(contact.plastic_state) == ["lower"]
    state = contact.plastic_state["lower"]
    assert state.strain.shape == state.residual_stress.shape == (6, 24, 24, 8) and state.accumulated.shape == (24, 24, 8)
    assert np.abs(state.strain[:3].sum(axis=0)).max() < 1e-12
    assert state.accumulated.max() == contact.numbers["max_plastic_strain"]
    assert state.back_stress is not None and state.back_stress.shape == (6, 24, 24, 8)
    assert np.allclose(contact.lower.heights, -state.displacement, atol=1e-18)
    assert contact.numbers["residual_stored_energy"] > 0.0
    assert contact.increments["plastic_work"].sum() == pytest.approx(contact.numbers["residual_plastic_work"])
    # The same from the results, and as a case file has it.
    kept = pressed(out=tmp_path / "out")
    assert (kept.plastic_state, kept.numbers, kept.fields) == (contact.plastic_state, contact.numbers, contact.fields)
    assert kept.increments["plastic_work"].tolist() == contact.increments["plastic_work"].tolist()
    assert asp.open(tmp_path / "out").plastic_state["lower"] == state


def test_what_a_plasticity_takes_is_told() -> None:
    assert asp.Plasticity(curve=[[0, 1.5e9], [0.01, 1.7e9]])._table() == {"curve": [[0.0, 1.5e9], [0.01, 1.7e9]]}
    with pytest.raises(asp.errors.CaseError, match="recovery"):
        recovers = asp.Material(210e9, 0.3, plasticity=asp.Plasticity(yield_stress=1e9, recovery=2.0))
        asp.contact(asp.form.flat((8, 8), pitch=1e-6), asp.form.sphere(1e-3), recovers, STEEL, load=1.0, plasticity=VOLUME)
    with pytest.raises(asp.errors.CaseError, match="missing table"):
        asp.contact(asp.form.flat((8, 8), pitch=1e-6), asp.form.sphere(1e-3), SOFT, STEEL, load=1.0)


@pytest.mark.filterwarnings("ignore")
def test_a_ball_rolls_pass_after_pass(tmp_path: pathlib.Path) -> None:
    plane, ball = asp.form.flat((24, 12), pitch="5 um"), asp.form.sphere("0.5 mm")
    hard = asp.Material(young="210 GPa", poisson=0.3, plasticity=asp.Plasticity(yield_stress="1.5 GPa"))

    def rolled(out: pathlib.Path | None = None, **more: object) -> asp.Run:
        return asp.simulate(
            plane, ball, hard, STEEL, load="6 N", passes=2, stride=2, strategy="shift", control="step-load", boundary="periodic",
            plasticity={"depth": "50 um", "layers": 6, "growth": 1.2, **more}, progress=False, out=out,
        )  # fmt: skip

    run = rolled()
    state = run.plastic_state()["lower"]
    assert list(run.plastic_state()) == ["lower"] and state.strain.shape == (6, 24, 12, 6)
    assert state.accumulated.max() == run.passes["max_plastic_strain_lower"][1] > 0.0
    assert np.allclose(run.lower().heights, -state.displacement, atol=1e-18)
    assert (run.passes["plastic_work_lower"] > 0.0).all() and (run.passes["plastic_work_upper"] == 0.0).all()
    assert run.steps["products"].sum() > 24 and run.regime in {"undecided", "shakes-down"}
    with pytest.raises(OSError, match="plasticity-0001"):
        run.plastic_state(1)
    kept = rolled(tmp_path / "out", keep="passes")
    assert kept.plastic_state(2)["lower"] == state and kept.plastic_state(1)["lower"].accumulated.sum() < state.accumulated.sum()
    assert asp.simulate(asp.form.flat((8, 8), pitch="1 um"), ball, STEEL, STEEL, load=1e-3, progress=False).regime is None


@pytest.mark.filterwarnings("ignore")
def test_what_flows_sticks_and_slips() -> None:
    contact = pressed(friction={"coefficient": 0.3, "force": ["2 N", 0]})
    assert {"traction_x", "slip_x", "stick"} <= set(contact.fields)
    assert contact.numbers["tangential_force"][0] == pytest.approx(2.0, rel=1e-4)
    assert contact.numbers["dissipation"] > 0.0 and contact.numbers["stick_area"] > 0.0
    assert contact.numbers["plastic_work"] != pressed().numbers["plastic_work"]
