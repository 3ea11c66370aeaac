"""What Python hands over is copied: whoever changes an array later changes nothing that was made of it."""

from __future__ import annotations

import copy
import inspect
import pickle
from typing import Any

import asperity as asp
import numpy as np
import pytest
from asperity import generate

from conftest import rough

HEIGHTS = 1e-8 * np.add.outer(np.sin(np.arange(16.0)), np.cos(np.arange(12.0)))
PRESSURE = np.full((8, 8), 1e8)


def _masked(array: Any) -> Any:
    return np.ma.MaskedArray(array, mask=np.zeros(array.shape, dtype=bool))


def _data_array(array: Any) -> Any:
    xarray = pytest.importorskip("xarray")
    return xarray.DataArray(array, dims=("x", "y"), coords={"x": np.arange(16.0), "y": np.arange(12.0)})


def _fatigue(pressures: Any = None, depths: Any = 1e-6, friction: Any = 0.0) -> asp.Fatigue:
    given = np.array([PRESSURE, 0.5 * PRESSURE]) if pressures is None else pressures
    return asp.fatigue(given, depths, pitch=1e-6, poisson=0.3, torsion="350 MPa", tension="600 MPa", friction=friction)


def _steel(**keys: Any) -> asp.Material:
    return asp.Material(210e9, 0.3, **keys)


MAKERS: dict[str, tuple[Any, Any]] = {
    # What is handed over, and what is made of it.
    "Surface": (HEIGHTS, lambda a: asp.Surface(a, pitch=1e-6)),
    "Surface, Fortran": (np.asfortranarray(HEIGHTS), lambda a: asp.Surface(a, pitch=1e-6)),
    "Surface, a part": (np.repeat(HEIGHTS, 2, axis=0), lambda a: asp.Surface(a[::2], pitch=1e-6)),
    "Surface, with a unit": (HEIGHTS, lambda a: asp.Surface(a, pitch=1e-6, unit="um")),
    "Surface, with steps": (HEIGHTS, lambda a: asp.Surface(a, pitch=1e-6).level("plane").taper("2 um")),
    "Surface, masked": (HEIGHTS, lambda a: asp.Surface(_masked(a), pitch=1e-6)),
    "Surface, xarray": (HEIGHTS, lambda a: asp.Surface(_data_array(a))),
    "pitch": (np.array([1e-6, 2e-6]), lambda a: asp.Surface(HEIGHTS, pitch=a)),
    "shape of a form": (np.array([16, 12]), lambda a: asp.form.sphere(1e-3, a, 1e-6)),
    "pitch of a form": (np.array([1e-6, 2e-6]), lambda a: asp.form.sphere(1e-3, (16, 12), a)),
    "radii": (np.array([1e-3, 2e-3]), lambda a: asp.form.ellipsoid(a, (16, 12), 1e-6)),
    "wavelength": (np.array([8e-6, 4e-6]), lambda a: asp.form.sinusoid(1e-8, a, (16, 12), 1e-6)),
    "generator, shape": (np.array([16, 12]), lambda a: generate.low_pass(a, 1e-6, sq=1e-8, cutoff=4e-6)),
    "generator, cutoff": (np.array([4e-6, 8e-6]), lambda a: generate.low_pass((16, 12), 1e-6, sq=1e-8, cutoff=a)),
    "generator, lengths": (
        np.array([4e-6, 3e-6]),
        lambda a: generate.autocorrelation((16, 12), 1e-6, sq=1e-8, correlation_length=a),
    ),
    "hardness": (np.full((16, 12), 2e9), lambda a: _steel(hardness=a)),
    "curve": (np.array([[0.0, 1e9], [0.01, 1.2e9]]), lambda a: asp.Plasticity(curve=a)),
    "wear": ({"coefficient": np.array(1e-15)}, lambda t: asp.Body(asp.Surface(HEIGHTS, 1e-6), _steel(), wear=t)),
    "film": ({"max_thickness": np.array(1e-8)}, lambda t: asp.Body(asp.Surface(HEIGHTS, 1e-6), _steel(), film=t)),
    "thermal": ({"density": np.array(7850.0)}, lambda t: asp.Body(asp.Surface(HEIGHTS, 1e-6), _steel(), thermal=t)),
    "Stress": (np.ones((3, 4)), lambda a: asp.Stress(a, a, a, a, a, a)),
    "stress": (PRESSURE, lambda a: asp.stress(a, pitch=1e-6, poisson=0.3, depths=[0.0, 1e-6])),
    "stress, depths": (np.array([0.0, 1e-6]), lambda a: asp.stress(PRESSURE, pitch=1e-6, poisson=0.3, depths=a)),
    "stress, shear": (
        PRESSURE,
        lambda a: asp.stress(PRESSURE, pitch=1e-6, poisson=0.3, depths=[1e-6], shear=(a, a)),
    ),
    "fatigue": (np.array([PRESSURE, 0.5 * PRESSURE]), lambda a: _fatigue(a)),
    "fatigue, depths": (np.array([0.5e-6, 1e-6]), lambda a: _fatigue(depths=a)),
    "fatigue, friction": (np.array([0.1, 0.2]), lambda a: _fatigue(friction=a)),
    "fatigue of a body": ({"torsion": np.array(3e8), "tension": 5e8}, lambda t: asp.Body(asp.Surface(HEIGHTS, 1e-6), _steel(), fatigue=t)),
    "conductance": (1.0 * (PRESSURE > 0.0), lambda a: asp.conductance(a > 0.0, pitch=1e-6, conductivity=46.0)),
    "flow": (np.ones(PRESSURE.shape), lambda a: asp.flow(a, pitch=1e-6)),
    "conductance, gap": (
        np.ones(PRESSURE.shape),
        lambda a: asp.conductance(PRESSURE > 0.0, pitch=1e-6, conductivity=46.0, gas=0.026, gap=a),
    ),
    "BearingCurve": (np.linspace(0.0, 1e-6, 20), asp.BearingCurve),
    "Profile": (1e-6 * np.sin(np.arange(200.0)), lambda a: asp.Profile(a, pitch=1e-6)),
    "Profile, filtered": (1e-6 * np.sin(np.arange(200.0)), lambda a: asp.Profile(a, pitch=1e-6).roughness(2e-5)),
    "Spectrum": (HEIGHTS, lambda a: asp.Surface(a, pitch=1e-6).spectrum()),
    "Correlation": (HEIGHTS, lambda a: asp.Surface(a, pitch=1e-6).autocorrelation()),
}


def _spoil(given: Any) -> None:
    if isinstance(given, dict):
        for value in given.values():
            value *= 3
        given.clear()
    else:
        given *= 3


@pytest.mark.parametrize("name", MAKERS)
def test_nothing_changes_with_an_array_that_was_handed_over(name: str) -> None:
    given, make = copy.deepcopy(MAKERS[name][0]), MAKERS[name][1]
    expected = make(copy.deepcopy(given))
    made = make(given)
    _spoil(given)
    assert made == expected
    assert pickle.loads(pickle.dumps(made)) == expected
    # What is worked out only now is of the same numbers.
    for attribute in ("heights", "fields", "von_mises", "density"):
        if hasattr(made, attribute):
            assert np.array_equal(getattr(made, attribute), getattr(expected, attribute), equal_nan=True)


def test_an_array_that_is_handed_over_is_not_changed() -> None:
    for given, make in MAKERS.values():
        before = copy.deepcopy(given)
        make(given)
        assert np.array_equal(given, before) if isinstance(given, np.ndarray) else given == before


def test_the_heights_that_a_surface_gives_cannot_be_changed() -> None:
    for surface in (asp.Surface(HEIGHTS, 1e-6), rough(1)):
        with pytest.raises(ValueError, match="read-only"):
            surface.heights[0, 0] = 1.0
        with pytest.raises(ValueError, match="WRITEABLE"):
            surface.heights.flags.writeable = True


def test_a_contact_is_that_of_the_arrays_as_they_were(steel: asp.Material) -> None:
    heights, hardness = rough(1).heights.copy(), np.full((32, 32), 3e9)
    body = asp.Body(asp.Surface(heights, 1e-6), asp.Material(210e9, 0.3, hardness=hardness))
    ball = asp.Body(asp.form.sphere("100 um"), steel)
    before = asp.contact(body, ball, load="5 mN", progress=False)
    heights *= 3
    hardness *= 0.1
    assert asp.contact(body, ball, load="5 mN", progress=False) == before


def test_a_law_that_uses_one_array_again_takes_off_what_it_gave(steel: asp.Material) -> None:
    pair = asp.Body(rough(1), steel), asp.Body(rough(2), steel)
    depth = np.full((32, 32), 1e-9)

    def law(_: asp.Pass) -> tuple[Any, Any]:
        nonlocal depth
        given = depth.copy(), depth.copy()
        return given

    def careless(each: asp.Pass) -> None:
        shared = depth.copy()
        each.remove(shared, shared)
        shared *= 100

    run = asp.simulate(*pair, load="20 mN", passes=2, stride=8, law=law, progress=False)
    again = asp.simulate(*pair, load="20 mN", passes=2, stride=8, law=careless, progress=False)
    assert run == again


def test_every_public_name_that_takes_arrays_is_among_these() -> None:
    """A new constructor that takes an array is to be added above."""
    known = {"Surface", "Material", "Plasticity", "Stress", "BearingCurve", "Profile", "stress", "conductance", "flow"}
    known |= {"fatigue"}
    # Answers, which only the package makes, and a container that says that it does not copy.
    made_here = {"Field", "Fields", "PlasticState", "Contact", "Contacts", "Pass", "SubsurfaceStress", "Segmentation", "Summits"}
    for name in asp.__all__:
        thing = getattr(asp, name)
        if name in known | made_here or not callable(thing):
            continue
        try:
            parameters = inspect.signature(thing).parameters.values()
        except (TypeError, ValueError):
            continue
        assert not any("ArrayLike" in str(parameter.annotation) for parameter in parameters), name
