"""Dang Van's criterion against NumPy, and what it says of arguments."""

from __future__ import annotations

import itertools
from typing import Any

import asperity as asp
import numpy as np
import pytest
from asperity import errors

LIMITS = {"torsion": "350 MPa", "tension": "600 MPa", "poisson": 0.3}


def pressures(positions: int = 6, shape: tuple[int, int] = (6, 5)) -> np.ndarray:
    random = np.random.default_rng(1).normal(size=(positions, *shape))
    return 1e9 * np.maximum(random, 0)


def ball(points: np.ndarray) -> tuple[np.ndarray, float]:
    """The smallest of the balls through up to six points that leave none out."""
    best: tuple[np.ndarray, float] = (points[0], np.inf)
    for count in range(1, min(6, len(points)) + 1):
        for chosen in itertools.combinations(points, count):
            edges = np.array(chosen[1:]).reshape(-1, 5) - chosen[0]
            weights = np.linalg.lstsq(2 * edges @ edges.T, (edges**2).sum(1), rcond=None)[0] if len(edges) else np.zeros(0)
            centre = chosen[0] + weights @ edges
            radius = np.linalg.norm(chosen[0] - centre)
            if radius < best[1] and np.linalg.norm(points - centre, axis=1).max() <= radius * (1 + 1e-9):
                best = (centre, radius)
    return best


def test_f_is_that_of_the_smallest_ball_around_the_deviators():
    found = asp.fatigue(pressures(), [0.0, 1e-6], pitch="1 um", friction=0.2, **LIMITS)
    assert found.weight == pytest.approx(0.25) and found.limit == 350e6
    each = [
        asp.stress(p, [0.0, 1e-6], pitch="1 um", poisson=0.3, boundary="periodic", shear=(0.2 * p, None)) for p in pressures()
    ]
    for cell in [(0, 0, 0), (1, 3, 2), (0, 5, 4)]:
        s = np.array([[stress[name][cell] for name in ("xx", "yy", "zz", "yz", "xz", "xy")] for stress in each])
        xx, yy, zz, yz, xz, xy = s.T
        mean = (xx + yy + zz) / 3
        root = np.sqrt(2)
        points = np.stack([(xx - yy) / root, np.sqrt(1.5) * (zz - mean), root * xy, root * yz, root * xz], axis=1)
        centre, radius = ball(points / 1e9)
        d = points - 1e9 * centre
        szz = d[:, 1] / np.sqrt(1.5)
        sxx, syy = d[:, 0] / root - szz / 2, -d[:, 0] / root - szz / 2
        shear = asp.Stress(sxx, syy, szz, d[:, 3] / root, d[:, 4] / root, d[:, 2] / root).max_shear
        assert found.f[cell] == pytest.approx((shear + 0.25 * mean).max(), rel=1e-7)
        assert found.radius[cell] == pytest.approx(1e9 * radius, rel=1e-8)
        assert found.shear_amplitude[cell] == pytest.approx(np.ptp(xz) / 2, rel=1e-12)


def test_damage_and_the_wear_that_is_faster():
    found = asp.fatigue(pressures(), [0.5e-6, 1e-6, 2e-6], pitch="1 um", **LIMITS)
    damage = found.damage(10, 2e6)
    over = np.maximum(found.over_limit, 0)
    assert damage == pytest.approx(over**10 / 2e6)
    integral = 0.5e-6 * damage[0] + np.trapezoid(damage, [0.5e-6, 1e-6, 2e-6], axis=0)
    assert found.critical_wear(10, 2e6) == pytest.approx(integral)
    assert np.all(found.damage(10, 2e6, endurance=True)[over < 1] == 0)
    assert found.most.value == found.f.max() and found.to_xarray()["f"].shape == found.f.shape


def test_the_upper_body_is_the_mirror_image():
    p = pressures()
    one = asp.fatigue(p, 1e-6, pitch="1 um", friction=0.2, **LIMITS)
    other = asp.fatigue(p[:, ::-1], 1e-6, pitch="1 um", friction=[0.2] * len(p), body="upper", **LIMITS)
    assert other.f[:, ::-1] == pytest.approx(one.f, rel=1e-7)


def test_a_body_below_layers() -> None:
    def steel(young: str) -> asp.Material:
        return asp.Material("210 GPa", 0.3, coating=asp.Coating("1 um", young, 0.3))

    given: dict[str, Any] = {"pitch": "1 um", "torsion": "350 MPa", "tension": "600 MPa"}
    plain = asp.fatigue(pressures(), ["1 um", "2 um"], poisson=0.3, **given)
    assert asp.fatigue(pressures(), ["1 um", "2 um"], material=steel("210 GPa"), **given).f == pytest.approx(plain.f, rel=1e-6)
    assert asp.fatigue(pressures(), "1 um", material=steel("800 GPa"), **given).f.max() < 0.8 * plain.f[0].max()


@pytest.mark.parametrize(
    ("change", "words"),
    [
        ({"tension": "800 MPa"}, "at most twice the limit in torsion"),
        ({"torsion": 0.0}, "torsion"),
        ({"friction": [0.1, 0.2]}, "expected a number, or one for each of 6 positions"),
        ({"boundary": "open"}, "boundary"),
        ({"body": "middle"}, "body"),
        ({"poisson": 0.7}, "poisson"),
    ],
)
def test_arguments_that_mean_nothing_are_refused(change: dict, words: str) -> None:
    with pytest.raises(errors.BadInput, match=words):
        asp.fatigue(pressures(), 1e-6, **{"pitch": "1 um", **LIMITS, **change})  # type: ignore[arg-type]


def test_pressures_are_matrices_position_by_position():
    for wrong, words in ((np.ones((3, 3)), "expected matrices"), (np.full((2, 3, 3), np.nan), "not finite"), ("abc", "no numbers")):
        with pytest.raises(errors.BadInput, match=words):
            asp.fatigue(wrong, 1e-6, pitch=1e-6, **LIMITS)


def test_the_pressures_of_a_pass_lie_on_the_cells_of_each_body() -> None:
    def rough(seed: int) -> asp.Body:
        surface = asp.generate.low_pass((24, 12), "1 um", sq="35 nm", cutoff="8 um", seed=seed)
        return asp.Body(surface, asp.Material("210 GPa", 0.3))

    run = asp.Simulation(rough(1), rough(2), load="5 mN", stride=3, progress=False)
    for each in run:
        load = each.steps["load"]
        for index, body in enumerate(("lower", "upper")):
            on_body = each.pressures(body)  # type: ignore[arg-type]
            assert on_body.shape == (len(load), 24, 12)
            assert on_body.sum(axis=(1, 2)) * each.cell_area == pytest.approx(load, rel=1e-6, abs=1e-12)
            assert on_body.sum(axis=0) == pytest.approx(each.on_bodies(each.contacts.pressure)[index])
        with pytest.raises(errors.BadInput, match="body"):
            each.pressures("both")  # type: ignore[arg-type]
        found = asp.fatigue(each.pressures("lower"), [1e-6], pitch="1 um", boundary="free", **LIMITS)
        assert found.f.max() > 0


def test_a_run_tells_where_its_bodies_tire() -> None:
    def rough(seed: int, **limits: object) -> asp.Body:
        surface = asp.generate.low_pass((24, 12), "1 um", sq="35 nm", cutoff="8 um", seed=seed)
        return asp.Body(surface, asp.Material("210 GPa", 0.3), fatigue=limits or None)  # type: ignore[arg-type]

    limits = {"torsion": "350 MPa", "tension": "600 MPa"}
    keywords = {"mean_pressure": "50 MPa", "boundary": "periodic", "strategy": "shift", "speed_lower": 0, "progress": False}
    run = asp.simulate(rough(1, **limits), rough(2), passes=2, stride=2, fatigue={"to": "4 um", "layers": 3}, **keywords)
    assert list(run.fatigue) == ["lower"]
    found = run.fatigue["lower"]
    assert list(found["pass"]) == [1, 2]
    # The passes of elastic bodies are alike, and damage adds up.
    assert found["damage"][1] == pytest.approx(2 * found["damage_of_pass"][0], rel=1e-4)
    assert found["life"][1] == pytest.approx(1 / found["damage_of_pass"][0], rel=1e-4)
    # The same from the pressures of a pass.
    for each in asp.Simulation(rough(1), rough(2), passes=1, stride=2, **keywords):
        depths = np.geomspace(0.5e-6, 4e-6, 3)
        again = asp.fatigue(each.pressures("lower"), depths, pitch="1 um", **LIMITS)
    assert found["over_limit"][0] == pytest.approx(again.over_limit.max(), rel=1e-6)
    assert found["critical_wear"][0] == pytest.approx(again.critical_wear(10, 2e6).max(), rel=1e-5)
    with pytest.raises(errors.CaseError, match="needs the limits of a body"):
        asp.simulate(rough(1), rough(2), fatigue={"to": "4 um"}, **keywords)
