"""Flow of a fluid through a gap."""

from __future__ import annotations

import pickle

import asperity as asp
import numpy as np
import pytest


def test_plates_leak_as_poiseuille_says():
    gap = np.full((16, 24), 2e-6)
    f = asp.flow(gap, pitch=(1e-6, 2e-6), viscosity="80 mPa s", pressure="1 bar")
    assert f.permeability == pytest.approx(8e-18 * np.eye(2), abs=1e-30)
    aspect = 48 / 16
    assert f.leakage == pytest.approx(8e-18 * 1e5 / (12 * 0.08) * np.array([aspect, 1 / aspect]), rel=1e-12)
    assert f.hydraulic_gap == pytest.approx([2e-6, 2e-6]) and f.flow_factor == pytest.approx([1.0, 1.0])
    assert f.pressure.shape == f.flowing.shape == (2, 16, 24) and f.flux.shape == (2, 2, 16, 24)
    assert f.pressure[0, 0, 0] == pytest.approx(1 - 0.5 / 16)
    assert f.flux.mean(axis=(2, 3)) == pytest.approx(f.permeability, abs=1e-30)
    assert f.closed_share == 0.0 and f.flowing.all() and f.effective_medium == pytest.approx(8e-18)
    assert "permeability 8e-18 and 8e-18 m³" in repr(f) and "m³/s" in repr(f)


def test_a_gas_leaks_more_than_its_drop_says():
    gap = np.full((8, 8), 1e-6)
    liquid = asp.flow(gap, pitch="1 um", viscosity=2e-5, pressure=2e5)
    gas = asp.flow(gap, pitch="1 um", viscosity=2e-5, pressure=2e5, outlet=1e5)
    assert gas.leakage == pytest.approx(2.0 * liquid.leakage)


def test_a_blocked_gap_leaks_nothing_and_says_so():
    gap = np.full((8, 8), 1e-6)
    gap[3] = 0.0
    for ends in ("periodic", "reservoirs"):
        f = asp.flow(gap, pitch=1e-6, viscosity=1.0, pressure=1.0, ends=ends)
        assert f.permeability[0, 0] == f.leakage[0] == f.critical_gap[0] == 0.0 and f.critical_cell[0] is None
        assert f.permeability[1, 1] == pytest.approx(7 / 8 * 1e-18)
        assert np.isfinite(f.pressure).all() and np.isfinite(f.flux).all()
    full = asp.flow(np.zeros((4, 1)), pitch=1e-6)
    assert not full.permeability.any() and full.leakage is None and full.closed_share == 1.0


def test_dead_ends_and_traps_are_known():
    gap = np.zeros((8, 8))
    gap[:, 1] = 1e-6
    gap[4, 4:6] = 2e-6
    f = asp.flow(gap, pitch=1e-6)
    assert f.trapped_volume == pytest.approx([4e-18, 4e-18]) and f.flowing_share.tolist() == [1 / 8, 0.0]
    assert f.critical_cell[0] is not None and f.critical_cell[0][1] == 1
    ends = asp.flow(gap, pitch=1e-6, ends="reservoirs", sides="closed")
    assert ends.permeability == pytest.approx(np.diag([1e-18 / 8, 0.0]), abs=1e-32)


def test_rules_for_faces_differ_by_what_is_estimated():
    x = (np.arange(32) + 0.5) / 32
    gap = np.repeat(1e-6 * (1 + 0.6 * np.cos(2 * np.pi * x))[:, None], 4, axis=1)
    linear, harmonic = (asp.flow(gap, pitch=1e-6, faces=faces) for faces in ("linear", "harmonic"))
    exact = (1 - 0.36) ** 2.5 / (1 + 0.18) * 1e-18
    assert harmonic.permeability[0, 0] == pytest.approx(exact, rel=1e-6)
    low, high = linear.other_faces[0]
    assert low * (1 - 1e-12) <= harmonic.permeability[0, 0] <= high * (1 + 1e-12)
    assert linear.estimate[0] == pytest.approx(abs(linear.permeability[0, 0] / exact - 1), rel=0.2)


def test_a_contact_brings_its_gap():
    wave = 1e-6 * np.cos(2 * np.pi * (np.arange(32) + 0.5) / 32)
    rough = asp.Surface(np.add.outer(wave, wave), pitch="4 um")
    flat = asp.form.flat((32, 32), pitch="4 um")
    steel = asp.Material("210 GPa", 0.3)
    contact = asp.contact(flat, rough, steel, steel, mean_pressure="1 GPa", boundary="periodic", progress=False)
    gap = np.where(contact.pressure > 0.0, 0.0, contact.gap)
    f = asp.flow(contact)
    assert f == asp.flow(gap, pitch=contact.pitch) and f == pickle.loads(pickle.dumps(f))
    assert f.closed_share == pytest.approx((contact.pressure > 0.0).mean())
    assert 0.0 < f.flow_factor[0] < 1.0 and f.permeability[0, 0] == pytest.approx(f.permeability[1, 1], rel=1e-6)
    with pytest.raises(asp.errors.BadInput, match="'pitch' is given beside a contact"):
        asp.flow(contact, pitch=1e-6)
    oil = {"viscosity": "80 mPa s", "pressure": "1 bar", "faces": "harmonic", "threads": 1}
    assert contact.flow() == f and contact.flow(**oil) == asp.flow(contact, **oil)
    with pytest.raises(asp.errors.BadInput, match="'pressure' is missing"):
        contact.flow(viscosity=1.0)


@pytest.mark.parametrize("boundary", ["free", ["periodic", "free"], ["free", "periodic"]])
def test_a_contact_has_the_ends_of_its_boundary_and_the_leakage_of_its_case(boundary):
    steel = asp.Material("210 GPa", 0.3)
    rough = asp.generate.self_affine((24, 20), "1 um", hurst=0.8, sq="0.1 um", seed=3)
    oil = {"viscosity": "80 mPa s", "pressure": "1 bar"}
    c = asp.contact(asp.form.flat(), rough, steel, steel, load="0.05 N", boundary=boundary, flow=oil)
    f = c.flow(**oil)
    x, y = [boundary] * 2 if isinstance(boundary, str) else boundary
    leakage = [c.leakages[axis]["leakage"][0] for axis in "xy"]
    assert f.leakage == pytest.approx(leakage, rel=1e-9) and min(leakage) > 0.0
    for axis, (along, across) in enumerate([(x, y), (y, x)]):
        ends = "periodic" if along == "periodic" else "reservoirs"
        sides = "periodic" if across == "periodic" else "closed"
        own = asp.flow(c, ends=ends, sides=sides, **oil)
        assert f.leakage[axis] == own.leakage[axis] and (f.pressure[axis] == own.pressure[axis]).all()


def test_answers_are_the_same_on_any_number_of_threads():
    gap = np.maximum(np.random.default_rng(1).normal(0.3, 1.0, (40, 40)), 0.0)
    one = asp.flow(gap, pitch=1.0, ends="reservoirs", threads=1)
    assert one == asp.flow(gap, pitch=1.0, ends="reservoirs", threads=3)


@pytest.mark.parametrize(
    "arguments, message",
    [
        ({"pitch": None}, "'pitch' is missing"),
        ({"ends": "open"}, "'ends' is 'open', expected \"periodic\" or \"reservoirs\""),
        ({"sides": "free"}, "'sides' is 'free'"),
        ({"faces": "cubic"}, "'faces' is 'cubic'"),
        ({"viscosity": 0.0, "pressure": 1.0}, "'viscosity' is 0.0, expected a viscosity above 0"),
        ({"viscosity": "2 mm", "pressure": 1.0}, "is a length, expected a viscosity"),
        ({"viscosity": 1.0}, "'pressure' is missing"),
        ({"pressure": 1.0}, "'viscosity' is missing"),
        ({"viscosity": 1.0, "pressure": -1.0}, "expected a drop of at least 0"),
        ({"viscosity": 1.0, "pressure": 1.0, "outlet": 0.0}, "'outlet' is 0.0, expected a pressure above 0"),
    ],
)
def test_a_wrong_argument_is_named(arguments, message):
    with pytest.raises(asp.errors.BadInput, match=message):
        asp.flow(np.ones((3, 3)), **{"pitch": 1e-6, **arguments})


def test_a_gap_that_is_no_matrix_of_numbers_is_refused():
    for gap in ([1.0, 2.0], "gap", np.zeros((0, 3))):
        with pytest.raises(asp.errors.BadInput, match="'gap'"):
            asp.flow(gap, pitch=1e-6)
    with pytest.raises(asp.errors.NotFinite):
        asp.flow([[1.0, np.nan]], pitch=1e-6)
