"""Closed forms against formulas and quadrature written here."""

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


def integral(f, a, b, n=200):
    """Gauss–Legendre with the substitution x = a + (b − a) sin θ, which takes a root at b away."""
    t, w = np.polynomial.legendre.leggauss(n)
    theta = 0.25 * math.pi * (t + 1.0)
    return float(np.sum(0.25 * math.pi * w * (b - a) * np.cos(theta) * f(a + (b - a) * np.sin(theta))))


def test_a_sphere_is_hertz():
    a = (0.75 * 10.0 * 10e-3 / 115.4e9) ** (1 / 3)
    assert BALL.contact_radius() == pytest.approx(a, rel=1e-14)
    assert BALL.approach() == pytest.approx(a * a / 10e-3, rel=1e-14)
    assert BALL.peak_pressure() == pytest.approx(1.5 * 10.0 / (math.pi * a * a), rel=1e-14)
    assert BALL.elastic_energy() == pytest.approx(0.4 * 10.0 * a * a / 10e-3, rel=1e-14)
    assert integral(lambda r: 2 * math.pi * r * BALL.pressure(r), 0.0, a) == pytest.approx(10.0, rel=1e-12)
    r = np.array([0.0, 0.5, 2.0]) * a
    root = math.sqrt(3.0) * a
    outside = ((2 * a * a - 4 * a * a) * math.asin(0.5) + a * root) / (math.pi * 10e-3)
    assert BALL.displacement(r) == pytest.approx([a * a / 10e-3, 0.875 * a * a / 10e-3, outside], rel=1e-12)
    radial, axial = BALL.axis_stress(np.array([0.0, a]), 0.3)
    assert axial == pytest.approx([-BALL.peak_pressure(), -0.5 * BALL.peak_pressure()], rel=1e-13)
    assert radial[0] == pytest.approx(-0.8 * BALL.peak_pressure(), rel=1e-12)


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
    many = np.linspace(0.0, 2e-4, 100_001)
    a = BALL.contact_radius()
    hertz = BALL.peak_pressure() * np.sqrt(np.maximum(1.0 - (many / a) ** 2, 0.0))
    assert BALL.pressure(many) == pytest.approx(hertz, rel=1e-9, abs=1.0)
    ellipse = FORMS[2]
    assert ellipse.pressure(np.zeros((3, 1)), np.zeros(4)).shape == (3, 4)


def test_a_line_is_hertz_and_its_gap_opens_by_the_pressure():
    a = math.sqrt(4 * 1e5 * 10e-3 / (math.pi * 100e9))
    assert LINE.half_width() == pytest.approx(a, rel=1e-14)
    assert LINE.peak_pressure() == pytest.approx(2e5 / (math.pi * a), rel=1e-13)
    assert 2 * integral(LINE.pressure, 0.0, a) == pytest.approx(1e5, rel=1e-12)
    assert LINE.approach(1.0) == pytest.approx(2e5 / (math.pi * 100e9) * (math.log(2 / a) + 0.5), rel=1e-13)
    steep = integral(lambda x: np.sqrt(x * x - a * a) / 10e-3, 3 * a, a)
    assert LINE.gap(3 * a) == pytest.approx(-steep, rel=1e-10)


def test_an_ellipse_of_equal_radii_is_a_sphere_and_carries_its_load():
    round_ = ref.HertzEllipse(10e-3, 115.4e9, 10.0)
    assert round_.semi_axes() == pytest.approx([BALL.contact_radius()] * 2, rel=1e-12)
    assert round_.approach() == pytest.approx(BALL.approach(), rel=1e-12)
    long = FORMS[2]
    a, b = long.semi_axes()
    assert a < b
    assert long.peak_pressure() == pytest.approx(4.5 / (math.pi * a * b), rel=1e-12)
    assert long.contact_area() == pytest.approx(math.pi * a * b)
    assert long.pressure(0.5 * a, 0.5 * b) == pytest.approx(long.peak_pressure() * math.sqrt(0.5), rel=1e-12)
    # The curvature that the pressure makes is that of the bodies: I(t) of the elliptic potential.
    t = np.tan(np.linspace(0.0, 0.5 * math.pi, 200_001)[1:-1])
    def curvature(axis):
        s = t * b
        root = np.sqrt((a * a + s * s) * (b * b + s * s))
        f = 2.0 * b * (1 + t * t) / ((axis * axis + s * s) * root)
        return a * b * long.peak_pressure() / 100e9 * f.sum() * (0.5 * math.pi / 200_000)
    assert curvature(a) == pytest.approx(1.0 / 1e-3, rel=1e-4)
    assert curvature(b) == pytest.approx(1.0 / 4e-3, rel=1e-4)


def test_cone_and_punch():
    cone = FORMS[3]
    a = math.sqrt(2.0 / (math.pi * 100e9 * 0.05))
    assert cone.contact_radius() == pytest.approx(a, rel=1e-13)
    assert cone.approach() == pytest.approx(0.5 * math.pi * a * 0.05, rel=1e-13)
    assert cone.mean_pressure() == pytest.approx(1.0 / (math.pi * a * a), rel=1e-13)
    assert cone.pressure(0.5 * a) == pytest.approx(2.5e9 * math.acosh(2.0), rel=1e-12)
    assert math.isinf(cone.pressure(0.0))
    punch = FORMS[4]
    assert punch.approach() == pytest.approx(10.0 / (2 * 1e-3 * 100e9), rel=1e-14)
    assert punch.displacement(2e-3) == pytest.approx(punch.approach() / 3.0, rel=1e-13)
    assert punch.pressure(0.0) == pytest.approx(10.0 / (2 * math.pi * 1e-6), rel=1e-13)


def test_a_sinusoid_is_westergaard():
    wave = FORMS[5]
    full = math.pi * 100e9 * 1e-7 / 1e-5
    s = 1e9 / full
    assert wave.full_contact_pressure() == pytest.approx(full, rel=1e-14)
    assert wave.contact_fraction() == pytest.approx(2 / math.pi * math.asin(math.sqrt(s)), rel=1e-13)
    x = (np.arange(20_000) + 0.5) * 1e-5 / 20_000
    assert wave.pressure(x).mean() == pytest.approx(1e9, rel=1e-4)
    assert wave.gap(x).mean() == pytest.approx(wave.mean_gap(), rel=1e-4)
    assert ref.Westergaard(1e-7, 1e-5, 100e9, 2 * full).gap(0.5e-5) == 0.0


def test_a_push_sticks_within_a_circle_and_back_again():
    a, limit = BALL.contact_radius(), 3.0
    assert PUSHED.stick_radius() == pytest.approx(a * (1 / 3) ** (1 / 3), rel=1e-13)
    whole = integral(lambda r: 2 * math.pi * r * PUSHED.shear(r), 0.0, PUSHED.stick_radius())
    whole += integral(lambda r: 2 * math.pi * r * PUSHED.shear(r), PUSHED.stick_radius(), a)
    assert whole == pytest.approx(2.0, rel=1e-6)
    assert PUSHED.displacement() == pytest.approx(0.75 * limit / (a * 80e9) * (1 - (1 / 3) ** (2 / 3)), rel=1e-13)
    back = ref.MindlinDeresiewicz(PUSHED, -2.0)
    r = np.linspace(0.0, 1.1 * a, 50)
    assert back.shear(r) == pytest.approx(-PUSHED.shear(r), rel=1e-9, abs=1.0)
    assert back.displacement() == pytest.approx(-PUSHED.displacement(), rel=1e-12)
    # The loss of a cycle is what its two branches enclose.
    force = np.linspace(-2.0, 2.0, 4001)
    down = np.array([ref.MindlinDeresiewicz(PUSHED, q).displacement() for q in force])
    enclosed = np.trapezoid(down, force) if hasattr(np, "trapezoid") else np.trapz(down, force)
    assert PUSHED.cycle_loss() == pytest.approx(2.0 * enclosed, rel=1e-5)


def test_a_driven_wheel_is_carter():
    wheel = FORMS[8]
    a = LINE.half_width()
    c = a * math.sqrt(1 - 1e4 / 3e4)
    assert wheel.stick_half_width() == pytest.approx(c, rel=1e-13)
    assert wheel.stick_centre() == pytest.approx(a - c, rel=1e-12)
    assert wheel.creepage() == pytest.approx(0.3 * (a - c) / 10e-3, rel=1e-12)
    again = ref.Carter.from_creepage(LINE, 0.3, wheel.creepage())
    assert again.tangential_load_per_length == pytest.approx(1e4, rel=1e-12)
    x = np.linspace(-a, a, 400_001)
    assert wheel.shear(x).sum() * (x[1] - x[0]) == pytest.approx(1e4, rel=1e-5)
    assert ref.Carter.from_creepage(LINE, 0.3, 1.0).stick_half_width() == 0.0


def test_the_stress_under_a_sliding_sphere_is_that_of_the_axis_and_of_its_tractions():
    still = ref.SlidingSphere(BALL, 0.0, 0.3)
    z = np.linspace(1e-6, 3e-4, 7)
    stress = still.stress(0.0, 0.0, z)
    radial, axial = BALL.axis_stress(z, 0.3)
    assert stress.xx == pytest.approx(radial, rel=1e-8)
    assert stress.yy == pytest.approx(radial, rel=1e-8)
    assert stress.zz == pytest.approx(axial, rel=1e-8)
    a, p0 = BALL.contact_radius(), BALL.peak_pressure()
    surface = FORMS[9].stress(0.3 * a, 0.4 * a, 0.0)
    assert surface.zz == pytest.approx(-p0 * math.sqrt(0.75), rel=1e-10)
    assert abs(surface.xz) == pytest.approx(0.25 * p0 * math.sqrt(0.75), rel=1e-10)
    assert surface.von_mises > still.stress(0.3 * a, 0.4 * a, 0.0).von_mises


def test_contacts_that_stick_are_stiffer():
    beta = 0.3
    factor = math.atanh(beta) / beta
    punch = ref.StickingPunch.from_approach(1e-3, 100e9, beta, 1e-6)
    assert punch.load == pytest.approx(2e-3 * 100e9 * factor * 1e-6, rel=1e-13)
    assert punch.approach() == pytest.approx(1e-6, rel=1e-13)
    eps = math.atanh(beta) / math.pi
    t = (np.arange(1_000_000) + 0.5) / 1_000_000
    j = 2.0 * np.mean(t * np.cos(eps * np.log((1 + t) / (1 - t))))
    ball = FORMS[11]
    a = ball.contact_radius()
    assert ball.load == pytest.approx(4 * 100e9 * a**3 / 3e-3 * factor / j, rel=1e-6)
    assert ball.approach() == pytest.approx(a * a / 1e-3 / j, rel=1e-6)


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


def test_functions():
    k = lambda m: math.pi / 2 / agm(1.0, math.sqrt(1.0 - m))  # noqa: E731

    def agm(a, b):
        while abs(a - b) > 1e-15 * a:
            a, b = 0.5 * (a + b), math.sqrt(a * b)
        return a

    s = ref.stick_ratio(0.2, 0.3)
    assert math.log((1 + s) / (1 - s)) / (2 * s) == pytest.approx(0.2 / 0.3 * k(1 - s * s), rel=1e-12)
    s = ref.stick_ratio_plane(0.2, -0.3)
    assert k(s * s) / k(1 - s * s) == pytest.approx(0.2 / 0.3, rel=1e-12)
    assert ref.stick_ratio(np.array([0.1, 0.2]), 0.0).tolist() == [1.0, 1.0]
    assert ref.BGT_COEFFICIENT == pytest.approx(math.sqrt(2 * math.pi))
    assert ref.PERSSON_COEFFICIENT == pytest.approx(math.sqrt(8 / math.pi))
    assert ref.bgt_area_fraction(1e6, 1e11, 0.1) == pytest.approx(math.sqrt(2 * math.pi) * 1e-4)
    assert ref.persson_area_fraction(5e9, 1e11, 0.1) == pytest.approx(math.erf(math.sqrt(2) * 0.5), rel=1e-14)
    assert ref.fully_plastic_area(np.array([1.0, 2.0]), 1e9).tolist() == [1e-9, 2e-9]
    corner = 1e6 / (math.pi * 1e11) * (2e-6 * math.asinh(0.5) + 1e-6 * math.asinh(2.0))
    assert ref.corner_displacement(1e6, ("2 um", 1e-6), 1e11) == pytest.approx(corner, rel=1e-14)
    assert ref.centre_displacement(1e6, (2e-6, 1e-6), 1e11) == pytest.approx(2 * corner, rel=1e-14)
    assert ref.mean_displacement(1e6, 1e-6, 1e11) == pytest.approx(0.9464 * 1e-11, rel=1e-4)
    full = ref.full_contact_pressure_2d(1e-7, 1e-5, 1e11)
    assert full == pytest.approx(math.sqrt(2) * math.pi * 1e9, rel=1e-14)
    assert ref.light_contact_fraction_2d(1e-3 * full, full) == pytest.approx(math.pi * (3e-3 / (8 * math.pi)) ** (2 / 3))
    assert len(ref.COUPLED) == 16 and ref.COUPLED[-1].stick_ratio == 0.698_178


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
