"""Conductance against closed forms."""

import math
import pickle

import asperity as asp
import numpy as np
import pytest

X = 1e-6 * (np.arange(64) - 31.5)
ROUND = np.hypot(*np.meshgrid(X, X, indexing="ij")) < 20e-6
STEEL = "46 W/(m K)"


def disc(**options):
    return asp.conductance(ROUND, pitch="1 um", **{"conductivity": STEEL, **options})


def test_a_round_spot_conducts_twice_its_radius():
    found = disc()
    radius = math.sqrt(ROUND.sum() / math.pi) * 1e-6
    assert found.conductance == pytest.approx(2 * 46 * radius, rel=1e-2)
    assert found.resistance == pytest.approx(1 / found.conductance, rel=1e-12)
    # The joint is what the spot adds to the resistance of the whole grid.
    joint = found.resistance - found.full_resistance
    assert found.joint_conductance == pytest.approx(1 / (joint * (64e-6) ** 2), rel=1e-12)
    assert found.holm_greenwood == pytest.approx(1 / (2 * 46 * radius), rel=1e-12)
    assert (found.spots, found.spot_share, found.gas_share, found.film_share) == (1, 1.0, 0.0, 0.0)
    assert found.median_cells == ROUND.sum()
    assert 1e-12 * found.flux.sum() == pytest.approx(found.conductance, rel=1e-6)
    assert (found.flux[ROUND] > 0).all() and (found.flux[~ROUND] == 0).all()
    # All of the grid conducts better: a square of 64 µm has 1.1523 κ times its side.
    assert 1 / found.full_resistance == pytest.approx(math.pi * 0.36678916 * 46 * 64e-6, rel=1e-2)
    assert found.residual <= 1e-6 and 0 < found.iterations < 40


def test_bodies_conduct_in_series():
    assert disc(conductivity=[46.0, math.inf]).conductance == pytest.approx(2 * disc().conductance, rel=1e-9)
    assert disc(conductivity=(30.0, "60 W/(m K)")).conductance == pytest.approx(
        disc(conductivity=40.0).conductance, rel=1e-9
    )


def test_a_film_adds_its_resistance_and_more():
    area = ROUND.sum() * 1e-12
    film = disc(film="1e-4 m2 K/W")
    radius = math.sqrt(area / math.pi)
    uniform = 16 / (3 * math.pi**2 * 46 * radius)
    assert film.resistance - 1e-4 / area == pytest.approx(uniform, rel=1e-2)
    assert film.film_share == pytest.approx(1e-4 / area / film.resistance, rel=1e-3)
    assert film.film_share > 0.5


def test_an_even_gap_of_gas_is_in_series_with_its_jump():
    gap = np.full((8, 9), 2e-6)
    found = asp.conductance(
        np.zeros((8, 9)), pitch=1e-6, conductivity=46, boundary="periodic", gas="0.026 W/(m K)", jump="0.37 um", gap=gap
    )
    assert found.joint_conductance == pytest.approx(0.026 / 2.37e-6, rel=1e-9)
    assert (found.gas_share, found.spot_share, found.spots, found.holm_greenwood) == (1.0, 0.0, 0, None)
    assert found.full_resistance is None


def test_no_contact_and_full_contact_have_an_answer():
    nothing = asp.conductance(np.zeros((4, 4)), pitch=1e-6, conductivity=46)
    assert (nothing.conductance, nothing.resistance, nothing.joint_conductance) == (0.0, None, 0.0)
    full = asp.conductance(np.ones((4, 4)), pitch=1e-6, conductivity=46, boundary="periodic")
    assert (full.conductance, full.resistance, full.flux) == (None, None, None)
    assert repr(full) == "<Conductance: no resistance, 1 spot>"
    for shape in ((1, 1), (1, 7)):
        found = asp.conductance(np.ones(shape), pitch=1e-6, conductivity=46, boundary=["free", "periodic"])
        assert found.conductance > 0


def test_electricity_has_its_own_units():
    found = disc(kind="electrical", conductivity="59 MS/m", film="1e-12 ohm m2")
    assert found.kind == "electrical" and repr(found).endswith("% of the resistance>") and " S, " in repr(found)
    again = disc(kind="electrical", conductivity=59e6, film=1e-12)
    assert found == again and pickle.loads(pickle.dumps(found)) == found
    assert found != disc()


def test_a_contact_brings_all_along():
    rough = asp.generate.low_pass((48, 48), "1 um", sq="50 nm", cutoff="8 um", seed=3)
    flat = asp.form.flat((48, 48), pitch="1 um")
    steel = asp.Material("210 GPa", 0.3)
    c = asp.contact(asp.Body(rough, steel), asp.Body(flat, steel), mean_pressure="200 MPa", boundary="periodic")
    found = asp.conductance(c, conductivity=46)
    alone = asp.conductance(c.pressure, conductivity=46, pitch="1 um", boundary="periodic")
    assert found == alone and found.conductance > 0 and found.spots > 1
    with_gas = asp.conductance(c, conductivity=46, gas=0.026, jump="0.37 um")
    assert with_gas.conductance > found.conductance and 0 < with_gas.gas_share < 1
    with pytest.raises(asp.errors.BadInput, match="beside a contact"):
        asp.conductance(c, conductivity=46, pitch=1e-6)
    assert c.conductance(conductivity=46) == found
    options = {"conductivity": ["46 W/(m K)", math.inf], "film": 1e-8, "gas": 0.026, "jump": 3e-7, "tolerance": 1e-8, "threads": 1}
    assert c.conductance(**options) == asp.conductance(c, **options)
    current = c.conductance(conductivity="59 MS/m", kind="electrical")
    assert current.kind == "electrical" and current.conductance == pytest.approx(found.conductance * 59e6 / 46, rel=1e-9)
    with pytest.raises(asp.errors.BadInput, match="'jump' is given without 'gas'"):
        c.conductance(conductivity=46, jump=1e-7)


@pytest.mark.parametrize("boundary", ["free", ["periodic", "free"]])
def test_a_method_takes_the_boundary_of_its_contact(boundary):
    steel = asp.Material("210 GPa", 0.3)
    plane, ball = asp.form.flat((32, 32), pitch="6 um"), asp.form.sphere("10 mm")
    c = asp.contact(plane, ball, steel, steel, load="5 N", boundary=boundary)
    alone = asp.conductance(c.pressure, pitch="6 um", conductivity=46, boundary=boundary)
    assert c.conductance(conductivity=46) == alone


def test_the_flux_is_an_xarray():
    pytest.importorskip("xarray")
    flux = disc().to_xarray()
    assert flux.attrs["units"] == "W/(m² K)" and flux.attrs["spots"] == 1
    assert flux.x.values[0] == 0.5e-6


@pytest.mark.parametrize(
    ("options", "message"),
    [
        ({"conductivity": 0.0}, "conductivity"),
        ({"conductivity": "46 GPa"}, "is a pressure, expected a thermal conductivity"),
        ({"conductivity": [1.0, 2.0, 3.0]}, "has 3 values"),
        ({"conductivity": [math.inf, math.inf]}, "conductivity of both bodies"),
        ({"kind": "magnetic"}, "'kind' is 'magnetic'"),
        ({"film": -1e-8}, "film"),
        ({"film": "1e-12 ohm m2"}, "is an electrical resistance of an area"),
        ({"gas": 0.026}, "'gap' is missing"),
        ({"gas": 0.026, "gap": np.ones((3, 3))}, "shape"),
        ({"gas": 0.026, "gap": np.full((64, 64), np.nan)}, "gap is NaN"),
        ({"gas": 0.026, "gap": np.ones((64, 64)), "kind": "electrical", "conductivity": 1e7}, "no current"),
        ({"jump": 1e-7}, "'jump' is given without 'gas'"),
        ({"boundary": "closed"}, "'boundary' is 'closed'"),
        ({"tolerance": 0.0}, "tolerance"),
        ({"pitch": None}, "'pitch' is missing"),
    ],
)
def test_what_has_no_meaning_is_refused(options, message):
    arguments = {"pitch": 1e-6, "conductivity": 46.0, **options}
    with pytest.raises(asp.errors.BadInput, match=message):
        asp.conductance(ROUND, **arguments)


@pytest.mark.parametrize("mask", [[1, 2], [["a"]], np.zeros((0, 3)), np.full((2, 2), np.nan)])
def test_a_contact_is_a_matrix(mask):
    with pytest.raises(asp.errors.BadInput, match="'contact'"):
        asp.conductance(mask, pitch=1e-6, conductivity=1.0)
