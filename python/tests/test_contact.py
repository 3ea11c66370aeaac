"""Static contacts."""

from __future__ import annotations

import copy
import pathlib
import pickle
import warnings

import asperity as asp
import numpy as np
import pytest
from asperity import errors
from conftest import rough

Pair = tuple[asp.Body, asp.Body]


def test_a_ball_on_a_plane_is_hertz_contact() -> None:
    steel, radius, load = asp.Material("210 GPa", 0.3), 10e-3, 10.0
    plane = asp.form.flat((128, 128), pitch="5 um")
    c = asp.contact(plane, asp.form.sphere(radius), steel, steel, load=load)
    modulus = 210e9 / (1 - 0.3**2) / 2
    peak = (6 * load * modulus**2 / (np.pi**3 * radius**2)) ** (1 / 3)
    approach = (9 * load**2 / (16 * radius * modulus**2)) ** (1 / 3)
    assert c.max_pressure == pytest.approx(peak, rel=0.01)
    assert c.approach == pytest.approx(approach, rel=0.01)
    assert c.load == pytest.approx(load, rel=1e-9) == c.pressure.sum() * 25e-12
    assert c.residual < 1e-6


def test_fields_have_unit_pitch_and_origin(pair: Pair) -> None:
    c = asp.contact(*pair, load="5 mN")
    pressure = c.fields["pressure"]
    assert (pressure.unit, pressure.pitch, pressure.origin, pressure.axes) == ("Pa", (1e-6, 1e-6), (5e-7, 5e-7), ("x", "y"))
    assert type(c.pressure) is np.ndarray and c.pressure is pressure.values and c.pressure.flags.writeable
    assert set(c.fields) == {"pressure", "gap", "displacement", "lower", "upper", "plastic"}
    assert np.allclose(c.gap[c.pressure > 0], 0.0, atol=1e-12)
    assert c.contact_fraction == pytest.approx(c.contact_area / c.apparent_area)
    with pytest.raises(KeyError, match="no field 'presure'"):
        c.fields["presure"]


def test_a_device_solves_the_same_contact_or_says_why_not(pair: Pair) -> None:
    here, there = (asp.contact(*pair, load="5 mN", device=device) for device in ("cpu", "host"))
    assert np.allclose(there.pressure, here.pressure, atol=1e-5 * here.max_pressure)
    assert there.case["contact"]["device"] == "host" and "device" not in here.case["contact"]
    with pytest.raises(errors.BadInput, match="a device does not solve friction with stick"):
        asp.contact(*pair, load="5 mN", device="host", friction={"coefficient": 0.3, "force": "1 mN"})
    try:
        asp.contact(*pair, load="5 mN", device="cuda")
    except errors.NoDevice as error:
        assert error.device == "cuda" and error.found


def test_the_upper_body_is_turned_over_unless_it_is_an_underside(steel: asp.Material) -> None:
    lower, upper = asp.Body(rough(1), steel), rough(2)
    turned = asp.contact(lower, asp.Body(upper, steel), load="5 mN")
    assert np.array_equal(turned.fields["upper"].values, -upper.heights[::-1])
    mounted = asp.contact(lower, asp.Body(turned.upper, steel, mount="as-is"), load="5 mN")
    assert np.array_equal(mounted.pressure, turned.pressure)


CASE = """
[lower]
young = "210 GPa"
poisson = 0.3
hardness = "4 GPa"
[lower.topography]
file = "disc.npy"
pitch = "1 um"
level = "plane"
fill = "harmonic"
[upper]
young = "110 GPa"
poisson = 0.25
hardness = {{ file = "hardness.npy" }}
[upper.topography]
generate = "low-pass"
shape = [32, 32]
pitch = "1 um"
sq = "50 nm"
cutoff = "8 um"
seed = 2
[contact]
load = "5 mN"
{}
"""


@pytest.mark.parametrize(
    ("more", "arguments"),
    [
        ("", {}),
        ('boundary = "periodic"\nmethod = "polonsky-keer"', {"boundary": "periodic", "method": "polonsky-keer"}),
        (
            "[friction]\ncoefficient = 0.2\nforce = 5e-4\nincrements = 2",
            {"friction": {"coefficient": 0.2, "force": 5e-4, "increments": 2}},
        ),
        ('[[history]]\nload = "2 mN"', {"history": [{"load": "2 mN"}]}),
        ("[friction]\ncoefficient = 0.2\ncreepage = 0.001", {"friction": {"coefficient": 0.2, "creepage": 0.001}}),
    ],
    ids=["pressed", "periodic", "friction", "history", "rolling"],
)
@pytest.mark.filterwarnings("ignore::asperity.errors.ModelWarning")
def test_a_call_is_the_case_file_bit_for_bit(tmp_path: pathlib.Path, more: str, arguments: dict) -> None:
    heights = rough(1).heights.copy()
    heights[3, 4] = heights[20, 11] = np.nan
    np.save(tmp_path / "disc.npy", heights)
    hardness = np.random.default_rng(3).uniform(2e9, 4e9, (32, 32))
    np.save(tmp_path / "hardness.npy", hardness)
    path = tmp_path / "case.toml"
    path.write_text(CASE.format(more))
    of_file = asp.run(path, out=tmp_path / "out", progress=False)
    lower = asp.Body(asp.Surface(heights, "1 um").level("plane").fill("harmonic"), asp.Material("210 GPa", 0.3, "4 GPa"))
    upper = asp.Body(rough(2), asp.Material("110 GPa", 0.25, hardness))
    called = asp.contact(lower, upper, load="5 mN", **arguments)
    written = asp.contact(lower, upper, load="5 mN", out=tmp_path / "again", **arguments)
    assert isinstance(of_file, asp.Contact)
    assert called.numbers == of_file.numbers == written.numbers
    assert set(called.fields) == set(of_file.fields)
    for name, field in of_file.fields.items():
        assert np.array_equal(field.values, called.fields[name].values), name
        assert np.array_equal(field.values, written.fields[name].values), name
    assert np.array_equal(called.increments, of_file.increments)


def test_a_sweep_is_a_record_of_each_point(pair: Pair) -> None:
    c = asp.contact(*pair, loads=["1 mN", "2 mN", "4 mN"])
    assert c.sweep["load"] == pytest.approx([1e-3, 2e-3, 4e-3], rel=1e-9)
    assert (np.diff(c.sweep["contact_area"]) > 0).all() and c.load == pytest.approx(4e-3)
    alone = asp.contact(*pair, load="4 mN")
    assert np.array_equal(alone.pressure, c.pressure)
    assert len(alone.sweep) == 0 and "contact_area" in (alone.sweep.dtype.names or ())


def test_the_answer_does_not_depend_on_the_threads(pair: Pair) -> None:
    assert asp.contact(*pair, load=0.01, threads=1) == asp.contact(*pair, load=0.01, threads=3)


def test_results_pickle_copy_and_compare(pair: Pair, tmp_path: pathlib.Path) -> None:
    c = asp.contact(*pair, load="5 mN")
    assert pickle.loads(pickle.dumps(c)) == c == copy.deepcopy(c)
    assert c != asp.contact(*pair, load="6 mN")
    stored = asp.contact(*pair, load="5 mN", out=tmp_path / "out")
    opened = asp.open(tmp_path / "out")
    assert isinstance(opened, asp.Contact)
    assert opened.numbers == stored.numbers == c.numbers
    assert pickle.loads(pickle.dumps(opened)).fields == opened.fields


def test_to_xarray(pair: Pair) -> None:
    pytest.importorskip("xarray")
    dataset = asp.contact(*pair, load="5 mN").to_xarray()
    assert dataset["pressure"].attrs["units"] == "Pa" and dataset.attrs["load"] == pytest.approx(5e-3)
    assert float(dataset["x"][1] - dataset["x"][0]) == pytest.approx(1e-6)


def test_what_is_to_be_wary_of_is_a_warning(steel: asp.Material) -> None:
    steep = asp.Surface(200 * rough(1).heights, 1e-6)
    with pytest.warns(errors.ModelWarning, match="steep") as caught:
        c = asp.contact(steep, rough(2), steel, steel, load="5 mN")
    assert [str(w.message) for w in caught] == c.warnings
    assert {w.filename for w in caught} == {__file__}
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        elastic = asp.Material("210 GPa", 0.3)
        asp.contact(asp.form.flat((64, 64), "5 um"), asp.form.sphere("10 mm"), elastic, elastic, load=10.0)


@pytest.mark.parametrize(
    ("arguments", "told", "kind"),
    [
        ({"load": -2.0}, "'load' is -2", ValueError),
        ({"load": 0}, "'load' is 0", ValueError),
        ({"load": "2 kg"}, "unknown unit 'kg' in 'load'", ValueError),
        ({"load": "2"}, "'load'", ValueError),
        ({"load": float("nan")}, "'load' is nan", ValueError),
        ({"load": object()}, "'load' is of type object, expected", TypeError),
        ({}, "no load is given, expected one of the arguments load, mean_pressure, approach, loads", ValueError),
        ({"load": 1e-3, "approach": 1e-9}, "both 'approach' and 'load' are given", ValueError),
        ({"load": 1e-3, "boundary": "open"}, "'boundary' is \"open\"", ValueError),
        ({"load": 1e-3, "method": "magic"}, "'method' is \"magic\"", ValueError),
        ({"load": 1e-3, "tolerance": 2}, "'tolerance' is 2", ValueError),
        ({"load": 1e-3, "friction": -0.1}, "'coefficient' is -0.1", ValueError),
        ({"load": 1e-3, "friction": {"coefficent": 0.1}}, "unknown key 'coefficent'", ValueError),
        ({"load": 1e-3, "threads": 0}, "'threads' is 0, expected a whole number from 1 to 1024", ValueError),
        ({"load": 1e-3, "threads": 1.5}, "'threads' is 1.5", ValueError),
        ({"load": 1e-3, "subsurface": {"to": "5 um"}}, "'subsurface' needs 'out'", ValueError),
        ({"load": 1e-3, "resume": True}, "'resume' needs 'out'", ValueError),
        ({"load": 1e6}, "exceeds the plastic limit", RuntimeError),
        ({"approach": "1 mm", "boundary": "periodic"}, "", RuntimeError),
    ],
)
def test_bad_arguments_are_named(pair: Pair, arguments: dict, told: str, kind: type) -> None:
    if "approach" in arguments and "boundary" in arguments:
        elastic = asp.Material("210 GPa", 0.3)
        pair = (asp.Body(pair[0].surface, elastic), asp.Body(pair[1].surface, elastic))
    with pytest.raises(kind) as caught:
        asp.contact(*pair, **arguments)
    assert told in str(caught.value)


def test_bodies_that_do_not_fit_are_named(steel: asp.Material) -> None:
    one = rough(1)
    for other, told in [
        (rough(2, (32, 16)), "different numbers of cells along y"),
        (rough(2, (16, 32)), "different numbers of cells along x"),
        (asp.Surface(rough(2).heights, 2e-6), "different pitches"),
    ]:
        with pytest.raises(errors.CaseError, match=told):
            asp.contact(one, other, steel, steel, load=1e-3)
        given = asp.Surface(other.heights, other.pitch)
        with pytest.raises(errors.CaseError, match=told):
            asp.contact(one, given, steel, steel, load=1e-3)
    holed = one.heights.copy()
    holed[0, 0] = np.nan
    with pytest.raises(errors.CaseError, match="1 of 1024 heights of lower are missing"):
        asp.contact(asp.Surface(holed, 1e-6), one, steel, steel, load=1e-3)
    with pytest.raises(errors.CaseError, match="'lower' has no material"):
        asp.contact(one, one, load=1e-3)
    with pytest.raises(errors.CaseError, match="'surface' is of type ndarray"):
        asp.contact(one.heights, one, steel, steel, load=1e-3)
    map_of_another_shape = asp.Material(210e9, 0.3, np.full((3, 3), 1e9))
    with pytest.raises(errors.CaseError, match="3 × 3 values"):
        asp.contact(one, one, map_of_another_shape, steel, load=1e-3)


def test_errors_have_their_numbers_and_hint(pair: Pair) -> None:
    with pytest.raises(errors.BeyondPlasticLimit) as caught:
        asp.contact(*pair, load=1e6)
    assert caught.value.load == 1e6 and caught.value.limit == pytest.approx(32 * 32 * 1e-12 * 4e9)
    with pytest.raises(errors.CaseError) as bad:
        asp.contact(*pair, load=1, method="activeset")
    assert bad.value.key == "contact.method" and bad.value.hint == "did you mean `active-set`?"
    assert any("active-set" in note for note in bad.value.__notes__)
    again = pickle.loads(pickle.dumps(bad.value))
    assert (type(again), str(again), again.key) == (type(bad.value), str(bad.value), bad.value.key)


def test_results_that_are_there_stay(pair: Pair, tmp_path: pathlib.Path) -> None:
    asp.contact(*pair, load="5 mN", out=tmp_path / "out")
    with pytest.raises(FileExistsError) as caught:
        asp.contact(*pair, load="6 mN", out=tmp_path / "out")
    assert isinstance(caught.value, errors.ResultsExist) and "overwrite=True" in (caught.value.hint or "")
    replaced = asp.contact(*pair, load="6 mN", out=tmp_path / "out", overwrite=True)
    assert replaced.load == pytest.approx(6e-3)
    with pytest.raises(errors.CaseError, match="'resume' and 'overwrite' are both given"):
        asp.contact(*pair, load="6 mN", out=tmp_path / "out", overwrite=True, resume=True)


def test_a_material_softer_than_rubber_is_a_warning() -> None:
    with pytest.warns(errors.ModelWarning, match='young = 210 is 210 Pa, softer than any rubber: was "210 GPa" meant') as caught:
        asp.Material(210, 0.3)
    assert caught[0].filename == __file__
    with pytest.warns(errors.ModelWarning, match="young = 20 kPa is 20 kPa, .*: check its unit"):
        asp.Material("20 kPa", 0.3)
    with warnings.catch_warnings():
        warnings.simplefilter("error")
        asp.Material("5 MPa", 0.49)
        asp.Material("20 kPa", 0.49, coating=asp.Coating("1 um", "1 GPa", 0.3))


def test_smooth_forms_have_their_closed_form_beside_them(tmp_path: pathlib.Path) -> None:
    steel = asp.Material(young="210 GPa", poisson=0.3)
    ball, plane = asp.form.sphere("10 mm"), asp.form.flat((64, 64), pitch="4 um")
    contact = asp.contact(plane, ball, steel, steel, load="10 N")
    hertz = asp.reference.HertzSphere("10 mm", asp.composite_modulus(steel, steel), 10.0)
    assert contact.closed_form["theory"] == "hertz-point"
    assert contact.closed_form["theory_max_pressure"] == pytest.approx(hertz.peak_pressure())
    deviation = contact.max_pressure / hertz.peak_pressure() - 1.0
    assert contact.closed_form["max_pressure_deviation"] == pytest.approx(deviation) and abs(deviation) < 0.01
    assert "deviation from theory" in contact._repr_html_()
    written = asp.contact(plane, ball, steel, steel, load="10 N", out=tmp_path / "ball", progress=False)
    assert written.closed_form == contact.closed_form
    soft = asp.Material(young="210 GPa", poisson=0.3, hardness="0.5 GPa")
    assert asp.contact(plane, ball, soft, steel, load="10 N").closed_form is None


def sticking(**options: object) -> asp.Contact:
    """A soft plane and a stiff tip that come together and are drawn apart."""
    polymer, silica = asp.Material("1 GPa", 0.4), asp.Material("70 GPa", 0.17)
    tip, plane = asp.form.sphere("40 nm"), asp.form.flat((24, 24), pitch="1 nm")
    adhesion: asp.keys.Adhesion = {"work": "80 mJ/m2", "range": "0.6 nm"}
    return asp.contact(plane, tip, polymer, silica, adhesion=adhesion, **options)  # type: ignore[arg-type]


def test_a_force_distance_curve_has_its_pull_off(tmp_path: pathlib.Path) -> None:
    path = [{"approach": "0.5 nm", "increments": 5}, {"approach": "-5 nm", "increments": 8}]
    c = sticking(approach="-4 nm", history=path)
    approach, load = c.curve
    assert len(load) == len(c.increments) == 14 and (approach == c.increments["approach"]).all()
    assert c.adhesion is not None and c.adhesion["pull_off"] == load[np.argmax(approach) :].min() < 0.0
    modulus = 1 / ((1 - 0.4**2) / 1e9 + (1 - 0.17**2) / 70e9)
    assert c.adhesion["tabor"] == pytest.approx((40e-9 * 0.08**2 / (modulus**2 * 0.6e-9**3)) ** (1 / 3), rel=0.1)
    # Between those of long and of short attraction, DMT and JKR, as far as the coarse grid allows.
    assert 1.4 < -c.adhesion["pull_off"] / (np.pi * 0.08 * 40e-9) < 2.1
    assert c.adhesion["work_of_separation"] > 0.0 and c.max_pressure == 0.0 and c.contact_fraction == 0.0
    assert "pull-off" in c._repr_html_()
    written = sticking(approach="-4 nm", history=path, out=tmp_path / "out")
    assert written.numbers == c.numbers and written.fields == c.fields and (written.increments == c.increments).all()
    opened = asp.open(tmp_path / "out")
    assert isinstance(opened, asp.Contact) and opened.adhesion == written.adhesion == c.adhesion


def test_cells_under_tension_are_in_contact() -> None:
    c = sticking(approach="0.2 nm")
    assert set(c.fields) == {"pressure", "contact", "gap", "displacement", "lower", "upper", "plastic"}
    assert c.contact_fraction == pytest.approx(c.contact_area / c.apparent_area)
    assert np.count_nonzero(c.touching) > np.count_nonzero(c.pressure > 0.0) > 0
    assert c.min_pressure == c.pressure.min() < 0.0 < c.adhesive_load and c.jumps == 0
    approach, load = c.curve
    assert (approach.tolist(), load.tolist()) == ([c.approach], [c.load])


def test_a_load_that_pulls_too_hard_tells_the_pull_off() -> None:
    with pytest.raises(errors.AtIncrement, match="increment 2: .*adhesion holds at most") as raised:
        sticking(load="5 nN", history=[{"load": "-40 nN"}])
    pulled = raised.value.cause
    assert isinstance(pulled, errors.PullOff) and pulled.load == -40e-9 and -21e-9 < pulled.least < -14e-9
    with pytest.raises(errors.CaseError, match="nothing holds the bodies together"):
        steel = asp.Material("210 GPa", 0.3)
        asp.contact(asp.form.flat((8, 8), "1 um"), asp.form.sphere("1 mm"), steel, steel, load=1.0, history=[{"load": -1.0}])
