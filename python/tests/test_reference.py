"""Closed forms: their answers, arguments and copies."""

import copy
import math
import pickle

import asperity as asp
import numpy as np
import pytest
from asperity import reference as ref

STEEL = asp.Material(young="210 GPa", poisson=0.3)
RUBBER = asp.Material(young="5 MPa", poisson=0.49)
BALL = ref.HertzSphere(10e-3, 115.4e9, 10.0)
LINE = ref.HertzLine(10e-3, 100e9, 1e5)
PUSHED = ref.CattaneoMindlin(BALL, 80e9, 0.3, 2.0)

FORMS = [
    BALL,
    LINE,
    ref.HertzEllipse((1e-3, "4 mm"), 100e9, 3.0),
    ref.Cone(0.05, 100e9, 1.0),
    ref.FlatPunch(1e-3, 100e9, 10.0),
    ref.Westergaard(1e-7, 1e-5, 100e9, 1e9),
    PUSHED,
    ref.MindlinDeresiewicz(PUSHED, -0.5),
    ref.Carter(LINE, 0.3, 1e4),
    ref.SlidingSphere(BALL, 0.25, 0.3),
    ref.StickingPunch(1e-3, 100e9, 0.3, 10.0),
    ref.StickingSphere(1e-3, 100e9, 0.3, 10.0),
    ref.COUPLED[0],
]


# The right quantity in the right unit, from the right arguments; the formulas are tested in the library.
ANSWERS = {
    "HertzSphere": {
        "contact_radius": 8.662e-05, "approach": 7.503e-07, "peak_pressure": 6.3636e8, "elastic_energy": 3.0012e-06,
        "pressure 5e-5": 5.1964e8, "displacement 2e-4": 1.4067e-07, "axis_stress 5e-5 0.3": [-8.8502e7, -4.7732e8],
    },
    "HertzLine": {
        "half_width": 1.1284e-4, "peak_pressure": 5.6419e8, "pressure 5e-5": 5.0578e8, "approach 1.0": 6.5462e-06,
        "gap 5e-4": 1.0797e-05,
    },
    "HertzEllipse": {
        "semi_axes": [2.1929e-05, 5.4837e-05], "approach": 6.1633e-07, "peak_pressure": 1.1912e9, "contact_area": 3.7778e-09,
        "elastic_energy": 7.3959e-07, "pressure 1e-5 2e-5": 9.6699e8,
    },
    "Cone": {
        "contact_radius": 1.1284e-05, "approach": 8.8623e-07, "mean_pressure": 2.5e9, "elastic_energy": 2.9541e-07,
        "pressure 5e-6": 3.6348e9, "pressure 0.0": math.inf, "displacement 5e-5": 6.3936e-08,
    },
    "FlatPunch": {"approach": 5e-8, "elastic_energy": 2.5e-7, "pressure 5e-4": 1.8378e6, "displacement 2e-3": 1.6667e-08},
    "Westergaard": {
        "full_contact_pressure": 3.1416e9, "half_width": 1.9081e-06, "contact_fraction": 0.38162, "mean_gap": 3.1731e-08,
        "elastic_energy": 26.177, "pressure 1e-6": 2.8207e9, "gap 5e-6": 9.0371e-08,
    },
    "CattaneoMindlin": {"stick_radius": 6.0059e-05, "displacement": 1.686e-07, "cycle_loss": 8.0005e-08, "shear 5e-5": 8.2559e7},
    "MindlinDeresiewicz": {"stick_radius": 7.2375e-05, "displacement": -2.7425e-08, "shear 5e-5": 1.4337e6},
    "Carter": {"stick_half_width": 9.2132e-05, "stick_centre": 2.0706e-05, "creepage": 6.2118e-4, "shear 5e-5": 2.0707e7},
    "StickingPunch": {"approach": 4.8462e-08},
    "StickingSphere": {"contact_radius": 4.1362e-05, "approach": 1.7575e-06},
}


@pytest.mark.parametrize(("name", "answers"), ANSWERS.items())
def test_a_form_answers_in_si(name, answers):
    form = next(form for form in FORMS if type(form).__name__ == name)
    for question, expected in answers.items():
        method, *places = question.split()
        assert getattr(form, method)(*map(float, places)) == pytest.approx(expected, rel=1e-4), question


def test_the_stress_of_a_sliding_sphere_has_its_components():
    stress = FORMS[9].stress(3e-5, 4e-5, 2e-5)
    found = [stress[name] for name in ("xx", "yy", "zz", "yz", "xz", "xy")]
    assert found == pytest.approx([-2.5423e8, -2.104e8, -4.8848e8, -7.0006e7, -1.1784e8, -2.5733e7], rel=1e-4)


def test_a_creepage_gives_the_load():
    assert ref.Carter.from_creepage(LINE, 0.3, FORMS[8].creepage()).tangential_load_per_length == pytest.approx(1e4, rel=1e-12)


def test_a_position_may_have_any_shape():
    one = BALL.pressure(1e-5)
    assert isinstance(one, float)
    for places in (np.full(3, 1e-5), np.full((2, 3, 4), 1e-5), [1e-5, 1e-5], np.full((4, 4), 1e-5)[::2, ::-1]):
        found = BALL.pressure(places)
        assert found.shape == np.shape(places)
        assert (found == one).all()
    assert BALL.pressure(np.zeros((0, 3))).shape == (0, 3)
    assert ref.SlidingSphere(BALL, 0.1, 0.3).stress(np.zeros(0), 0.0, 0.0).xx.shape == (0,)
    # More than fit into one go of the compiled loop.
    many = np.linspace(0.0, 2e-4, 10_001)
    assert (BALL.pressure(many)[::1000] == BALL.pressure(many[::1000])).all()
    ellipse = FORMS[2]
    assert ellipse.pressure(np.zeros((3, 1)), np.zeros(4)).shape == (3, 4)


@pytest.mark.parametrize(
    "made, given",
    [
        (ref.HertzSphere.from_approach(1e-3, 1e11, "1 um"), "1 um"),
        (ref.Cone.from_approach(0.1, 1e11, 1e-6), 1e-6),
        (ref.FlatPunch.from_approach(1e-3, 1e11, 1e-6), 1e-6),
        (ref.StickingPunch.from_approach(1e-3, 1e11, 0.2, 1e-6), 1e-6),
        (ref.StickingSphere.from_approach(1e-3, 1e11, -0.2, 1e-6), 1e-6),
    ],
)
def test_what_is_made_of_an_approach_has_it(made, given):
    assert made.approach() == pytest.approx(1e-6, rel=1e-12)


@pytest.mark.parametrize(
    ("found", "expected"),
    [
        (ref.stick_ratio(0.2, 0.3), 0.7015),
        (ref.stick_ratio(np.array([0.1, 0.2]), 0.0), [1.0, 1.0]),
        (ref.stick_ratio_plane(0.2, -0.3), 0.36592),
        (ref.bgt_area_fraction(1e6, 1e11, 0.1), 2.5066e-4),
        (ref.persson_area_fraction(5e9, 1e11, 0.1), 0.68269),
        (ref.fully_plastic_area(np.array([1.0, 2.0]), 1e9), [1e-9, 2e-9]),
        (ref.corner_displacement(1e6, ("2 um", 1e-6), 1e11), 7.6587e-12),
        (ref.centre_displacement(1e6, (2e-6, 1e-6), 1e11), 1.5317e-11),
        (ref.mean_displacement(1e6, 1e-6, 1e11), 9.464e-12),
        (ref.full_contact_pressure_2d(1e-7, 1e-5, 1e11), 4.4429e9),
        (ref.light_contact_fraction_2d(1e6, 1e9), 7.6162e-3),
        ([ref.BGT_COEFFICIENT, ref.PERSSON_COEFFICIENT], [math.sqrt(2 * math.pi), math.sqrt(8 / math.pi)]),
        ([len(ref.COUPLED), ref.COUPLED[-1].stick_ratio], [16, 0.698_178]),
    ],
)
def test_a_function_answers_in_si(found, expected):
    assert found == pytest.approx(expected, rel=1e-4)


def test_what_a_pair_comes_to():
    one, other = (1 - 0.09) / 210e9, (1 - 0.49**2) / 5e6
    assert asp.composite_modulus(STEEL, RUBBER) == pytest.approx(1 / (one + other), rel=1e-14)
    assert asp.composite_modulus(STEEL, asp.Material(math.inf, 0.2)) == pytest.approx(1 / one, rel=1e-14)
    coupling = 1.3 * 0.4 / (2 * 210e9) - 1.49 * 0.02 / (2 * 5e6)
    assert asp.dundurs(STEEL, RUBBER) == pytest.approx(coupling / (one + other), rel=1e-13)
    assert asp.dundurs(STEEL, STEEL) == 0.0
    tangential = 1.7 * 1.3 / (2 * 210e9) + 1.51 * 1.49 / (2 * 5e6)
    assert asp.tangential_modulus(STEEL, RUBBER) == pytest.approx(1 / tangential, rel=1e-14)
    pair = asp.Compliances(STEEL, RUBBER)
    assert pair.lateral == pytest.approx(0.3 * 1.3 / 210e9 + 0.49 * 1.49 / 5e6, rel=1e-14)
    assert pickle.loads(pickle.dumps(pair)) == pair != asp.Compliances(RUBBER, STEEL)
    rigid = asp.Material(math.inf, 0.3)
    with pytest.raises(asp.errors.OutOfRange, match="young of both bodies"):
        asp.composite_modulus(rigid, rigid)
    with pytest.raises(asp.errors.CaseError, match="'upper' is 3, expected a Material"):
        asp.composite_modulus(STEEL, 3)


@pytest.mark.parametrize("form", FORMS, ids=lambda form: type(form).__name__)
def test_every_form_pickles_copies_compares_and_prints(form):
    for other in (pickle.loads(pickle.dumps(form)), copy.copy(form), copy.deepcopy(form)):
        assert other == form
        assert repr(other) == repr(form)
    assert eval(repr(form), {**vars(ref)}) == form
    name = next(iter(vars(form)))
    other = copy.deepcopy(form)
    setattr(other, name, None)
    assert other != form
    assert form.__doc__ and type(form).__doc__


def test_quantities_may_be_text():
    assert ref.HertzSphere("10 mm", "115.4 GPa", "10 N") == BALL


@pytest.mark.parametrize(
    "make, told",
    [
        (lambda: ref.HertzSphere(0.0, 1e11, 1.0), "'radius' is 0.0, expected a length above 0"),
        (lambda: ref.HertzSphere("1 N", 1e11, 1.0), "'radius'"),
        (lambda: ref.HertzSphere(1e-3, -1.0, 1.0), "'modulus' is -1.0"),
        (lambda: ref.HertzSphere(1e-3, 1e11, -1.0), "'load' is -1.0, expected at least 0"),
        (lambda: ref.HertzSphere(1e-3, 1e11, math.nan), "'load' is nan"),
        (lambda: ref.HertzSphere.from_approach(1e-3, 1e11, -1e-6), "'approach' is -1e-06, expected at least 0"),
        (lambda: ref.HertzEllipse((1e-3, 1e-3, 1e-3), 1e11, 1.0), "'radii' has 3 values"),
        (lambda: ref.Cone(0.0, 1e11, 1.0), "'slope' is 0.0, expected a slope above 0"),
        (lambda: ref.CattaneoMindlin(BALL, 1e11, 0.3, 3.1), "'tangential_load' is 3.1, expected a number from 0 to 3 N"),
        (lambda: ref.CattaneoMindlin(BALL, 1e11, 0.0, 0.0), "'friction' is 0.0"),
        (lambda: ref.MindlinDeresiewicz(PUSHED, -2.1), "'tangential_load' is -2.1, expected a number from -2 to 2 N"),
        (lambda: ref.Carter(LINE, 0.3, 4e4), "'tangential_load_per_length' is 40000.0"),
        (lambda: ref.SlidingSphere(BALL, math.inf, 0.3), "'friction' is inf"),
        (lambda: ref.SlidingSphere(BALL, 0.1, 0.6), "'poisson' is 0.6, expected a number from 0 to 0.5"),
        (lambda: ref.StickingPunch(1e-3, 1e11, 0.6, 1.0), "'dundurs' is 0.6"),
        (lambda: ref.Westergaard(1e-7, 1e-5, 1e11, "-1 Pa"), "'mean_pressure'"),
    ],
)
def test_data_without_meaning_are_refused(make, told):
    with pytest.raises(asp.errors.BadInput) as raised:
        make()
    assert told in str(raised.value)


def test_positions_that_are_no_numbers_are_refused():
    with pytest.raises(ValueError):
        BALL.pressure("somewhere")
    with pytest.raises(ValueError):
        FORMS[2].pressure(np.zeros(3), np.zeros(4))
