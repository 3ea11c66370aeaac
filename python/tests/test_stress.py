"""The stress below the surface against closed forms and NumPy."""

import math
import pickle

import asperity as asp
import numpy as np
import pytest

BALL = asp.reference.HertzSphere(1e-3, 115e9, 1.0)
X = 1e-6 * (np.arange(65) - 32)
PRESSURE = BALL.pressure(np.hypot(*np.meshgrid(X, X, indexing="ij")))
STEEL = asp.Material("210 GPa", 0.3)


def test_under_a_ball_it_is_hertz():
    depths = np.linspace(0.0, 20e-6, 6)
    s = asp.stress(PRESSURE, depths, poisson=0.3, pitch=1e-6)
    assert s.shape == s.xx.shape == (6, 65, 65)
    exact = asp.reference.SlidingSphere(BALL, 0.0, 0.3).stress(
        X[None, :, None], X[None, None, :], depths[1:, None, None]
    )
    for name in ("xx", "yy", "zz", "yz", "xz", "xy"):
        assert np.abs(s[name][1:] - exact[name]).max() < 0.03 * BALL.peak_pressure(), name
    assert s.zz[0] == pytest.approx(-PRESSURE, abs=1e-6 * BALL.peak_pressure())
    most = s.most_stressed
    assert most.cell == (32, 32)
    assert most.value / BALL.peak_pressure() == pytest.approx(0.62, abs=0.002)
    assert most.position == pytest.approx((32.5e-6, 32.5e-6, 0.48 * BALL.contact_radius()), rel=0.05)
    assert s.most_sheared.value / BALL.peak_pressure() == pytest.approx(0.31, abs=0.002)


def test_a_periodic_wave_is_flamants():
    n, pitch, depth, p1 = 32, 1e-6, 3e-6, 1e6
    x = (np.arange(n) + 0.5) * pitch
    q = 2 * math.pi / (n * pitch)
    p = np.repeat((p1 * np.cos(q * x))[:, None], 8, axis=1)
    s = asp.stress(p, depth, poisson=0.3, pitch=pitch, boundary="periodic")
    decay = math.exp(-q * depth)
    assert s.zz[0] == pytest.approx(-p * (1 + q * depth) * decay, abs=1e-6 * p1)
    assert s.xx[0] == pytest.approx(-p * (1 - q * depth) * decay, abs=1e-6 * p1)
    assert s.yy[0] == pytest.approx(-0.6 * p * decay, abs=1e-6 * p1)


def test_invariants_are_those_of_the_eigenvalues():
    random = np.random.default_rng(3).normal(size=(6, 4, 5))
    s = asp.Stress(*random)
    xx, yy, zz, yz, xz, xy = random
    matrices = np.moveaxis(np.array([[xx, xy, xz], [xy, yy, yz], [xz, yz, zz]]), (0, 1), (-2, -1))
    principal = np.moveaxis(np.linalg.eigvalsh(matrices)[..., ::-1], -1, 0)
    assert s.principal == pytest.approx(principal, abs=1e-12)
    assert s.max_shear == pytest.approx(0.5 * (principal[0] - principal[2]), abs=1e-12)
    a, b, c = principal
    assert s.von_mises == pytest.approx(np.sqrt(0.5 * ((a - b) ** 2 + (b - c) ** 2 + (c - a) ** 2)), abs=1e-12)
    assert asp.Stress(1.0, 0.0, 0.0, 0.0, 0.0, 0.0).principal.tolist() == [1.0, 0.0, 0.0]


def test_a_contact_brings_all_along_and_its_bodies_mirror_each_other():
    flat = asp.form.flat((32, 32), pitch="4 um")
    c = asp.contact(
        flat, asp.form.sphere("1 mm"), STEEL, STEEL, load=0.2, progress=False,
        friction={"coefficient": 0.3, "force": [0.03, 0.0]},
    )  # fmt: skip
    lower = asp.stress(c, ["2 um", "5 um"])
    upper = asp.stress(c, ["2 um", "5 um"], body="upper")
    by_hand = asp.stress(
        c.pressure, [2e-6, 5e-6], material=STEEL, pitch=c.pitch,
        shear=(c.fields["traction_x"].values, c.fields["traction_y"].values),
    )  # fmt: skip
    assert by_hand == lower
    without = asp.stress(c.pressure, [2e-6, 5e-6], poisson=0.3, pitch=c.pitch)
    assert 0.5 * (lower.zz + upper.zz) == pytest.approx(without.zz, abs=1e-3)
    assert lower != upper
    # Equilibrium: each plane carries the load and the tangential force, but for what passes beside the grid.
    area = c.pitch[0] * c.pitch[1]
    assert -lower.zz[0].sum() * area == pytest.approx(0.2, rel=0.02)
    assert abs(lower.xz[0].sum()) * area == pytest.approx(0.03, rel=0.06)
    assert lower.xz[0].sum() == pytest.approx(-upper.xz[0].sum(), rel=1e-9)


def test_it_pickles_and_goes_to_xarray():
    s = asp.stress(PRESSURE, [1e-6, 2e-6, 4e-6], poisson=0.3, pitch=1e-6)
    _ = s.von_mises
    again = pickle.loads(pickle.dumps(s))
    assert again == s
    assert again.most_stressed == s.most_stressed
    assert repr(s) == "<SubsurfaceStress: 3 × 65 × 65 points>"
    pytest.importorskip("xarray")
    dataset = s.to_xarray()
    assert dataset["von_mises"].dims == ("z", "x", "y")
    assert dataset["z"].values.tolist() == [1e-6, 2e-6, 4e-6]
    assert float(dataset["x"][0]) == 0.5e-6


def test_layers_alike_are_the_body_and_a_stiff_one_bears_more():
    def at(material):
        return asp.stress(PRESSURE, [0.0, 1e-6, 3e-6], material=material, pitch=1e-6)

    plain = at(asp.Material("210 GPa", 0.3))
    alike = at(asp.Material("210 GPa", 0.3, coating=[asp.Coating("1 um", "210 GPa", 0.3), asp.Coating("2 um", "210 GPa", 0.3)]))
    np.testing.assert_allclose(alike.von_mises, plain.von_mises, rtol=1e-6, atol=1e-6 * plain.von_mises.max())
    stiff = at(asp.Material("steel", coating=asp.Coating("2 um", "dlc")))
    assert stiff["xx"][0].max() > 1.1 * plain["xx"][0].max()


def test_the_stress_of_a_contact_is_that_in_its_layers():
    layered = asp.Material("steel", coating=[asp.Coating("2 um", "dlc"), asp.Coating("0.5 um", "chromium")])
    bodies = asp.form.flat((32, 32), pitch="3 um"), asp.form.sphere("1 mm")
    contact = asp.contact(*bodies, STEEL, layered, load="2 N", progress=False)
    by_contact = asp.stress(contact, [0.0, 2e-6], body="upper")
    by_material = asp.stress(contact.pressure, [0.0, 2e-6], material=layered, pitch=3e-6, body="upper")
    np.testing.assert_array_equal(by_contact["xx"], by_material["xx"])
    assert not np.allclose(by_contact["xx"], asp.stress(contact, [0.0, 2e-6], body="lower")["xx"], rtol=1e-2)


@pytest.mark.parametrize(
    "arguments, told",
    [
        ({"poisson": None}, "give 'poisson' or 'material', one of them"),
        ({"material": STEEL}, "give 'poisson' or 'material', one of them"),
        ({"poisson": 0.7}, "'poisson' is 0.7, expected a number from 0 to 0.5"),
        ({"pitch": None}, "'pitch' is missing"),
        ({"pitch": -1.0}, "'pitch' is -1.0"),
        ({"body": "middle"}, "'body' is 'middle', expected \"lower\" or \"upper\""),
        ({"boundary": "open"}, "'boundary' is 'open', expected \"free\" or \"periodic\""),
        ({"shear": (PRESSURE[:-1], None)}, "'shear' has the shape (64, 65), expected that of the pressure, (65, 65)"),
        ({"shear": (PRESSURE,)}, "'shear' has 1 entries"),
        ({"depths": [2e-6, 1e-6]}, "expected lengths of at least 0 that ascend"),
        ({"depths": [-1e-6]}, "expected lengths of at least 0 that ascend"),
        ({"depths": []}, "expected lengths of at least 0 that ascend"),
        ({"depths": "1 N"}, "'depths'"),
        ({"source": np.zeros(5)}, "'pressure' has the shape (5,), expected a matrix [ix, iy]"),
        ({"source": np.zeros((0, 0))}, "'pressure' has the shape (0, 0)"),
        ({"source": np.full((4, 4), np.nan)}, "'pressure' holds a number that is not finite"),
        ({"source": "high"}, "'pressure' is no matrix of numbers"),
        ({"threads": 0}, "'threads' is 0"),
    ],
)
def test_bad_input_is_refused(arguments, told):
    whole = {"source": PRESSURE, "depths": [1e-6], "poisson": 0.3, "pitch": 1e-6, **arguments}
    with pytest.raises(asp.errors.BadInput) as raised:
        asp.stress(whole.pop("source"), whole.pop("depths"), **whole)
    assert told in str(raised.value)


def test_what_a_contact_has_is_not_given_twice():
    c = asp.contact(
        asp.form.flat((8, 8), pitch="4 um"), asp.form.sphere("1 mm"), STEEL, STEEL, load=1e-3, progress=False
    )
    with pytest.raises(asp.errors.CaseError, match="'poisson' is given beside a contact, which has its own"):
        asp.stress(c, 1e-6, poisson=0.3)


def test_more_planes_than_memory_are_refused():
    with pytest.raises(asp.errors.Memory):
        asp.stress(np.ones((1000, 1000)), np.linspace(0.0, 1.0, 100_000), poisson=0.3, pitch=1e-6)


def test_read_only_and_strided_tractions_are_accepted():
    strided = np.repeat(PRESSURE, 2, axis=1)[:, ::2]
    strided.flags.writeable = False
    one = asp.stress(strided, 1e-6, poisson=0.3, pitch=1e-6)
    assert one == asp.stress(PRESSURE, 1e-6, poisson=0.3, pitch=1e-6)
    integers = asp.stress(np.ones((4, 4), dtype=np.int32), 1e-6, poisson=0.3, pitch=1e-6)
    assert integers.shape == (1, 4, 4)
