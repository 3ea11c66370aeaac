"""Viscoelastic bodies in steady sliding."""

from __future__ import annotations

import pathlib

import asperity as asp
import numpy as np
import pytest
from asperity import errors

RELAXING = {"moduli": ["9 MPa", "90 MPa"], "times": ["10 ms", "0.2 ms"]}


def bodies(**relaxation: object) -> tuple[asp.Body, asp.Body]:
    rubber, rigid = asp.Material("1 MPa", 0.5), asp.Material("inf", 0.3)
    slider = asp.generate.self_affine(shape=(32, 32), pitch="10 um", sdq=0.1, hurst=0.8, shortest="80 um")
    smooth = asp.form.flat((32, 32), pitch="10 um")
    return asp.Body(smooth, rubber, viscoelastic=relaxation or RELAXING), asp.Body(slider, rigid)  # type: ignore[arg-type]


def test_rubber_touches_less_and_resists_most_in_between() -> None:
    lower, upper = bodies()
    speeds = {"from": "0.1 mm/s", "to": "1 m/s", "points": 5}
    c = asp.contact(lower, upper, mean_pressure="50 kPa", boundary="periodic", steady={"speeds": speeds})
    drag, area = c.sweep["drag_coefficient"], c.sweep["contact_area"]
    assert c.sweep["speed"] == pytest.approx(np.geomspace(1e-4, 1, 5))
    assert np.all(drag > 0) and drag.argmax() in (1, 2, 3) and np.all(np.diff(area) < 0)
    assert c.sweep["drag_power"] == pytest.approx(drag * c.sweep["load"] * c.sweep["speed"])


def test_a_master_curve_is_fitted(tmp_path: pathlib.Path) -> None:
    frequency = np.logspace(-2, 6, 41)
    z = 2j * np.pi * frequency * 1e-3
    modulus = 1e6 + 9e6 * z / (1 + z)
    file = tmp_path / "master.csv"
    table = np.column_stack([frequency, modulus.real, modulus.imag])
    np.savetxt(file, table, delimiter=",", header="frequency_Hz,storage_Pa,loss_Pa", comments="")

    def drag(**relaxation: object) -> float:
        lower, upper = bodies(**relaxation)
        c = asp.contact(lower, upper, mean_pressure="50 kPa", boundary="periodic", steady={"speed": 0.1})
        return float(c.sweep["drag_coefficient"][0])

    fitted = drag(file=str(file), terms_per_decade=3)
    assert fitted == pytest.approx(drag(moduli=[9e6], times=[1e-3]), rel=0.1)
    file.write_text("frequency,storage_Pa,loss_Pa\n1,2,3\n")
    with pytest.raises(errors.CaseError, match="the frequency `frequency` has no unit"):
        drag(file=str(file))


def test_a_layer_on_a_rigid_base_relaxes() -> None:
    _, upper = bodies()
    smooth = asp.form.flat((32, 32), pitch="10 um")

    def drag(thickness: str) -> float:
        layer = asp.Coating(thickness, "1 MPa", 0.49, viscoelastic=RELAXING)  # type: ignore[arg-type]
        lower = asp.Body(smooth, asp.Material("inf", 0.3, coating=[layer, asp.Coating("0.1 mm", "10 GPa", 0.3)]))
        c = asp.contact(lower, upper, mean_pressure="50 kPa", boundary="periodic", steady={"speed": "10 mm/s"})
        return float(c.sweep["drag_coefficient"][0])

    body, rigid = bodies()
    half_space = asp.contact(body, rigid, mean_pressure="50 kPa", boundary="periodic", steady={"speed": "10 mm/s"})
    assert 0 < drag("10 um") < drag("2 mm")
    assert drag("2 mm") == pytest.approx(half_space.sweep["drag_coefficient"][0], rel=0.02)
    with pytest.raises(errors.CaseError, match="a rigid body does not relax"):
        flat = asp.Body(smooth, asp.Material("inf", 0.3), viscoelastic=RELAXING)  # type: ignore[arg-type]
        asp.contact(flat, asp.Body(upper.surface, asp.Material("1 GPa", 0.3)), load="1 mN", steady={"speed": 1.0})


def test_two_rough_bodies_do_not_slide_steadily() -> None:
    lower, upper = bodies()
    rough = asp.Body(upper.surface, lower.material, viscoelastic=RELAXING)  # type: ignore[arg-type]
    with pytest.raises(errors.CaseError, match="needs a body that is smooth along x"):
        asp.contact(rough, upper, load="10 mN", steady={"speed": 1.0})


def test_rubber_creeps_under_a_load() -> None:
    lower, _ = bodies(moduli=["9 MPa"], times=["0.1 s"])
    ball = asp.Body(asp.form.sphere("10 mm"), asp.Material("inf", 0.3))
    c = asp.contact(lower, ball, load="1 mN", history=[{"dwell": "20 s", "increments": 8}])
    time, area = c.increments["time"], c.increments["contact_area"]
    assert time[0] == 0 and time[-1] == pytest.approx(20) and np.all(np.diff(area) >= 0)
    assert c.increments["approach"][-1] == pytest.approx(10 ** (2 / 3) * c.increments["approach"][0], rel=0.05)


def test_passes_of_rubber_remember_the_ones_before() -> None:
    lower, upper = bodies(moduli=["9 MPa"], times=["1 ms"])
    keywords = {"mean_pressure": "50 kPa", "boundary": "periodic", "strategy": "shift", "speed_upper": "20 mm/s"}
    run = asp.simulate(lower, upper, passes=3, stride=1, progress=False, **keywords)
    drag = run.passes["drag_coefficient"]
    assert np.all(drag > 0) and np.isnan(run.steps["drag"][0]) and np.all(np.isfinite(run.steps["drag"][1:]))
    c = asp.contact(lower, upper, mean_pressure="50 kPa", boundary="periodic", steady={"speed": "20 mm/s"})
    assert drag[-1] == pytest.approx(c.sweep["drag_coefficient"][0], rel=0.2)
    apart = asp.simulate(lower, upper, passes=2, stride=1, pause="1 s", progress=False, **keywords)
    assert apart.passes["approach"][1] == pytest.approx(apart.passes["approach"][0], rel=1e-3)
    with pytest.raises(errors.CaseError, match="passes of viscoelastic bodies need a speed"):
        asp.simulate(lower, upper, load="1 mN", progress=False)
