"""Closed forms: contacts with a known solution, to compare a computation with.

A contact is a class with its data (geometry, composite modulus E*, load), and its answers are methods. Methods of a position take a
number or an array, and return the same shape. Lengths, moduli and loads are numbers in SI or texts with a unit. Displacements are
the sum of both bodies, positive where they open the gap, and 0 far away. :func:`asperity.composite_modulus` computes the composite
modulus of two materials.

Examples
--------
>>> import numpy as np, asperity as asp
>>> ball = asp.reference.HertzSphere(radius="10 mm", modulus=115.4e9, load=10.0)
>>> f"{ball.contact_radius():.3e} m"
'8.662e-05 m'
>>> ball.pressure(np.linspace(0.0, 1e-4, 5)).shape
(5,)
"""

from __future__ import annotations

import math
from collections.abc import Callable, Sequence
from typing import Annotated, Any, TypeVar, cast

from numpy.typing import ArrayLike

from . import _core
from ._described import described
from ._points import Point, spread
from ._raise import bad_input
from ._same import Comparable
from ._stress import Stress
from ._units import Pair, Quantity, lengths, number, quantity
from .material import _poisson, tangential_modulus

__all__ = [
    "BGT_COEFFICIENT",
    "COUPLED",
    "PERSSON_COEFFICIENT",
    "Carter",
    "CattaneoMindlin",
    "Cone",
    "CoupledPunch",
    "FlatPunch",
    "HertzEllipse",
    "HertzLine",
    "HertzSphere",
    "MindlinDeresiewicz",
    "SlidingSphere",
    "StickingPunch",
    "StickingSphere",
    "Westergaard",
    "bgt_area_fraction",
    "centre_displacement",
    "corner_displacement",
    "full_contact_pressure_2d",
    "fully_plastic_area",
    "light_contact_fraction_2d",
    "mean_displacement",
    "persson_area_fraction",
    "stick_ratio",
    "stick_ratio_plane",
    "tangential_modulus",
]


Pressed = TypeVar("Pressed", bound="_Pressed")

# Parameters of several closed forms.
_Radius = Annotated[Quantity, "Relative radius R, 1/R = 1/R₁ + 1/R₂, above 0, m."]
_PunchRadius = Annotated[Quantity, "Radius a of the punch, above 0, m."]
_Modulus = Annotated[Quantity, "Composite modulus E*, above 0, Pa."]
_Load = Annotated[Quantity, "Normal load W, at least 0, N."]
_Friction = Annotated[float, "Coefficient of friction μ, above 0."]
_Dundurs = Annotated[float, "Dundurs' β, from −0.5 to 0.5, see :func:`asperity.dundurs`; its sign does not matter."]


def _answer(question: str, data: Sequence[float], *places: Any) -> Any:
    return spread(places, lambda points: _core.closed_form(question, list(data), points))


def _least_0(key: str, value: Quantity, dimension: str) -> float:
    found = quantity(key, value, dimension, positive=False)
    if found < 0.0:
        raise bad_input(key, f"'{key}' is {value!r}, expected at least 0")
    return found


def _load(value: Quantity) -> float:
    return _least_0("load", value, "force")


def _per_length(key: str, value: Any) -> float:
    return number(key, value, "a force per length of at least 0, N/m", 0.0)


def _within(key: str, value: float, unit: str, least: float, most: float) -> float:
    """A force from `least` to `most`, a rounding of these aside."""
    crumb = 1e-12 * most
    number(key, value, f"a number from {least:g} to {most:g} {unit}", least - crumb, most + crumb)
    return min(max(value, least), most)


def _friction(value: Any) -> float:
    return number("friction", value, "a coefficient of friction above 0", math.ulp(0.0))


def _dundurs(value: Any) -> float:
    return number("dundurs", value, "Dundurs' constant from -0.5 to 0.5", -0.5, 0.5)


class _Number:
    """Becomes a method that returns one number of a closed form."""

    def __init__(self, text: str) -> None:
        self._text = text

    def __set_name__(self, owner: type, name: str) -> None:
        def number(self: Any) -> float:
            return float(self._ask(name))

        number.__name__, number.__qualname__, number.__doc__ = name, f"{owner.__qualname__}.{name}", self._text
        number.__annotations__ = {"return": float}
        setattr(owner, name, number)


def _number(text: str) -> Callable[[Any], float]:
    """Declares a method of a closed form that returns one number, with its docstring."""
    return cast(Callable[[Any], float], _Number(text))


class _Form(Comparable):
    """A closed form: its public attributes are its data."""

    def __init_subclass__(cls) -> None:
        described(cls)

    def __repr__(self) -> str:
        return f"{type(self).__name__}({', '.join(f'{name}={value!r}' for name, value in vars(self).items())})"

    def _data(self) -> list[float]:
        data: list[float] = []
        for value in vars(self).values():
            if isinstance(value, _Form):
                data += value._data()
            elif isinstance(value, tuple):
                data += value
            else:
                data.append(value)
        return data

    def _ask(self, question: str, *places: Any) -> Any:
        return _answer(f"{type(self).__name__}.{question}", self._data(), *places)


class _Pressed(_Form):
    """A closed form whose last number is its load."""

    load: float

    def _pressed(self: Pressed, approach: Quantity) -> Pressed:
        """Sets the load at an approach."""
        *data, _ = self._data()
        depth = _least_0("approach", approach, "length")
        self.load = _answer(f"{type(self).__name__}.from_approach", [], *data, depth)
        return self


class HertzSphere(_Pressed):
    """Frictionless contact of two elastic spheres, or of a sphere and a plane, taken as paraboloids.

    h = r²/2R,  a = (3WR/4E*)^(1/3),  δ = a²/R,  p = p₀ √(1 − r²/a²),  p₀ = 3W/2πa². Exact for the paraboloid; a sphere
    differs by O(a²/R²).

    References
    ----------
    Hertz (1882); Johnson, *Contact Mechanics* (1985), eqs. 4.22–4.24.

    Examples
    --------
    >>> import asperity as asp
    >>> ball = asp.reference.HertzSphere.from_approach("10 mm", "115.4 GPa", "0.75 um")
    >>> round(ball.load, 3)
    9.994
    """

    def __init__(self, radius: _Radius, modulus: _Modulus, load: _Load) -> None:
        self.radius = quantity("radius", radius, "length")
        self.modulus = quantity("modulus", modulus, "pressure")
        self.load = _load(load)

    @classmethod
    def from_approach(cls, radius: Quantity, modulus: Quantity, approach: Quantity) -> HertzSphere:
        """The contact at an approach δ of at least 0, m: W = (4/3) E* R^(1/2) δ^(3/2)."""
        return cls(radius, modulus, 0.0)._pressed(approach)

    contact_radius = _number("Contact radius a, m.")
    approach = _number("Rigid-body approach δ, m.")
    peak_pressure = _number("Pressure p₀ at the centre, Pa; 0 without load.")
    elastic_energy = _number("Elastic energy stored in both bodies, ⅖ W δ, J.")

    def pressure(self, r: Point) -> Point:
        """Pressure at distance `r` from the axis, Pa; 0 outside the contact."""
        return self._ask("pressure", r)  # type: ignore[no-any-return]

    def displacement(self, r: Point) -> Point:
        """Surface displacement at distance `r` from the axis, m.

        u = δ − r²/2R for r ≤ a,  u = [(2a² − r²) asin(a/r) + a √(r² − a²)]/πR for r > a. Far outside about 2 log₁₀(r/a)
        digits are lost. Johnson (1985), eq. 3.42.
        """
        return self._ask("displacement", r)  # type: ignore[no-any-return]

    def axis_stress(self, depth: Point, poisson: float) -> tuple[Point, Point]:
        """Stresses on the axis at a depth of at least 0, Pa, positive in tension: radial, and along the axis.

        σ_z = −p₀/(1 + ζ²),  σ_r = −p₀ (1 + ν)(1 − ζ atan 1/ζ) + ½p₀/(1 + ζ²),  ζ = z/a, in a body of Poisson's ratio
        `poisson`. Johnson (1985), eq. 3.45.
        """
        return self._ask("axis_stress", depth, _poisson(poisson))  # type: ignore[no-any-return]


class HertzLine(_Form):
    """Frictionless contact of two parallel elastic cylinders in plane strain, taken as parabolas.

    h = x²/2R,  a² = 4P′R/πE*,  p = p₀ √(1 − x²/a²),  p₀ = 2P′/πa. The approach of a half-plane is unbounded: it depends on
    where it is measured.

    References
    ----------
    Johnson (1985), eqs. 4.43–4.45.
    """

    def __init__(
        self,
        radius: _Radius,
        modulus: _Modulus,
        load_per_length: Annotated[float, "Load P′ per length of the line, at least 0, N/m."],
    ) -> None:
        self.radius = quantity("radius", radius, "length")
        self.modulus = quantity("modulus", modulus, "pressure")
        self.load_per_length = _per_length("load_per_length", load_per_length)

    half_width = _number("Half width a of the contact, m.")
    peak_pressure = _number("Pressure p₀ on the centre line, aE*/2R, Pa.")

    def pressure(self, x: Point) -> Point:
        """Pressure at distance `x` from the centre line, Pa; 0 outside the contact."""
        return self._ask("pressure", x)  # type: ignore[no-any-return]

    def approach(self, datum: Point) -> Point:
        """Approach of the bodies against a distance r₀ = `datum`, from a on, m: (2P′/πE*) [ln(2r₀/a) + ½].

        At r₀ the displacement under a line of force, −(2/πE*) ln(r/r₀) per unit, is 0.
        """
        return self._ask("approach", datum)  # type: ignore[no-any-return]

    def gap(self, x: Point) -> Point:
        """Deformed gap at distance `x` from the centre line, m; 0 in the contact.

        g = [x √(x² − a²) − a² acosh(x/a)]/2R for x > a.
        """
        return self._ask("gap", x)  # type: ignore[no-any-return]


class HertzEllipse(_Form):
    """Frictionless contact over an ellipse, h = x²/2Rx + y²/2Ry.

    By complete elliptic integrals, whose parameter is solved for to round-off: relative accuracy 1e-13 for ratios of the
    radii up to 1e6.

    References
    ----------
    Hertz (1882); Johnson (1985), eqs. 4.25–4.32.
    """

    def __init__(
        self,
        radii: Annotated[Pair, "Relative radii along x and y, above 0, m."],
        modulus: _Modulus,
        load: Annotated[Quantity, "Normal load W, above 0, N."],
    ) -> None:
        self.radii = lengths("radii", radii)
        self.modulus = quantity("modulus", modulus, "pressure")
        self.load = quantity("load", load, "force")

    def semi_axes(self) -> tuple[float, float]:
        """Semi-axes of the contact along x and y, m."""
        return self._found("semi_axes")  # type: ignore[no-any-return]

    def approach(self) -> float:
        """Rigid-body approach δ, m."""
        return float(self._found("approach"))

    def peak_pressure(self) -> float:
        """Pressure p₀ at the centre, Pa."""
        return float(self._found("peak_pressure"))

    contact_area = _number("Area π a b of the contact, m².")
    elastic_energy = _number("Elastic energy stored in both bodies, ⅖ W δ, J.")

    def pressure(self, x: ArrayLike, y: ArrayLike) -> Any:
        """Pressure p₀ √(1 − x²/a² − y²/b²) at (`x`, `y`) from the centre, Pa; 0 outside the contact."""
        return self._ask("pressure", x, y)

    def _found(self, question: str) -> Any:
        return _answer(f"HertzEllipse.{question}", [], *self._data())


class Cone(_Pressed):
    """Frictionless indentation by a blunt cone, h = r tan θ, θ the angle between its flank and the plane.

    δ = ½π a tan θ,  W = ½π a² E* tan θ,  p = ½E* tan θ acosh(a/r). The half-space theory requires tan θ ≪ 1.

    References
    ----------
    Love (1939); Sneddon, Int. J. Eng. Sci. 3, 47 (1965).
    """

    def __init__(
        self,
        slope: Annotated[float, "Slope tan θ of the flank, above 0."],
        modulus: _Modulus,
        load: _Load,
    ) -> None:
        self.slope = number("slope", slope, "a slope above 0", math.ulp(0.0))
        self.modulus = quantity("modulus", modulus, "pressure")
        self.load = _load(load)

    @classmethod
    def from_approach(cls, slope: float, modulus: Quantity, approach: Quantity) -> Cone:
        """The cone at an approach δ of at least 0, m: W = 2E*δ²/(π tan θ)."""
        return cls(slope, modulus, 0.0)._pressed(approach)

    contact_radius = _number("Contact radius a, m.")
    approach = _number("Rigid-body approach δ, m.")
    mean_pressure = _number("Mean pressure over the contact, ½E* tan θ at any load, Pa.")
    elastic_energy = _number("Elastic energy stored in both bodies, ⅓ W δ, J.")

    def pressure(self, r: Point) -> Point:
        """Pressure at distance `r` from the axis, Pa: infinite at the tip, 0 outside the contact."""
        return self._ask("pressure", r)  # type: ignore[no-any-return]

    def displacement(self, r: Point) -> Point:
        """Surface displacement at distance `r` from the axis, m.

        u = δ − r tan θ for r ≤ a,  u = tan θ [a asin(a/r) + √(r² − a²) − r] for r > a.
        """
        return self._ask("displacement", r)  # type: ignore[no-any-return]


class FlatPunch(_Pressed):
    """Frictionless indentation by a rigid flat-ended cylinder.

    W = 2aE*δ,  p = W/(2πa²) (1 − r²/a²)^(−1/2).

    References
    ----------
    Boussinesq (1885); Johnson (1985), eqs. 3.34–3.37.
    """

    def __init__(self, radius: _PunchRadius, modulus: _Modulus, load: _Load) -> None:
        self.radius = quantity("radius", radius, "length")
        self.modulus = quantity("modulus", modulus, "pressure")
        self.load = _load(load)

    @classmethod
    def from_approach(cls, radius: Quantity, modulus: Quantity, approach: Quantity) -> FlatPunch:
        """The punch at an approach δ of at least 0, m."""
        return cls(radius, modulus, 0.0)._pressed(approach)

    approach = _number("Rigid-body approach δ, m.")
    elastic_energy = _number("Elastic energy stored, ½ W δ, J.")

    def pressure(self, r: Point) -> Point:
        """Pressure at distance `r` from the axis, Pa: infinite at the edge, 0 outside."""
        return self._ask("pressure", r)  # type: ignore[no-any-return]

    def displacement(self, r: Point) -> Point:
        """Surface displacement at distance `r` from the axis, m: δ under the punch, (2δ/π) asin(a/r) outside."""
        return self._ask("displacement", r)  # type: ignore[no-any-return]


class Westergaard(_Form):
    """Frictionless contact of a sinusoid of one dimension with a plane, in plane strain.

    h = A (1 − cos 2πx/λ), a crest at x = 0. Contact is full from the mean pressure p* = π E* A/λ on.

    References
    ----------
    Westergaard, J. Appl. Mech. 6, 49 (1939); Johnson (1985), eqs. 13.2–13.8.
    """

    def __init__(
        self,
        amplitude: Annotated[Quantity, "Amplitude A, half the height from peak to valley, above 0, m."],
        wavelength: Annotated[Quantity, "Wavelength λ, above 0, m."],
        modulus: _Modulus,
        mean_pressure: Annotated[Quantity, "Mean pressure p̄, at least 0, Pa."],
    ) -> None:
        self.amplitude = quantity("amplitude", amplitude, "length")
        self.wavelength = quantity("wavelength", wavelength, "length")
        self.modulus = quantity("modulus", modulus, "pressure")
        self.mean_pressure = _least_0("mean_pressure", mean_pressure, "pressure")

    full_contact_pressure = _number("Mean pressure p* at which the last gap closes, Pa.")
    half_width = _number("Half width a of each strip of contact, m; λ/2 in full contact.")
    contact_fraction = _number("Fraction of the plane in contact, 2a/λ.")
    mean_gap = _number("Mean deformed gap A (1 − s + s ln s), s = p̄/p*, m.")
    elastic_energy = _number("Elastic energy per apparent area, ¼ p*A s² (1 − 2 ln s), J/m²; ¼ p*A in full contact.")

    def pressure(self, x: Point) -> Point:
        """Pressure at `x` from a crest, Pa; 0 outside the contact.

        2 p* cos ψ √(s − sin²ψ), ψ = πx/λ, for s < 1;  p̄ + p* cos 2ψ for s ≥ 1.
        """
        return self._ask("pressure", x)  # type: ignore[no-any-return]

    def gap(self, x: Point) -> Point:
        """Deformed gap at `x` from a crest, m; 0 in the contact: 2A [t √(t² − s) − s acosh(t/√s)], t = abs(sin ψ)."""
        return self._ask("gap", x)  # type: ignore[no-any-return]


class CattaneoMindlin(_Form):
    """Partial slip of a sphere under a constant normal load and a tangential one that has grown from 0.

    Exact for identical materials but for the slip's direction, which it takes along Q.

    References
    ----------
    Cattaneo (1938); Mindlin, J. Appl. Mech. 16, 259 (1949); Johnson (1985), eqs. 7.39–7.42.
    """

    def __init__(
        self,
        normal: Annotated[HertzSphere, "The normal contact."],
        tangential_modulus: Annotated[Quantity,
            "Composite tangential modulus Gₜ, above 0, Pa, see :func:`tangential_modulus`."],
        friction: _Friction,
        tangential_load: Annotated[Quantity, "Tangential load Q, from 0 to μW, N."],
    ) -> None:
        self.normal = normal
        self.tangential_modulus = quantity("tangential_modulus", tangential_modulus, "pressure")
        self.friction = _friction(friction)
        self.tangential_load = quantity("tangential_load", tangential_load, "force", positive=False)
        most = self.friction * normal.load
        self.tangential_load = _within("tangential_load", self.tangential_load, "N", 0.0, most)

    stick_radius = _number("Radius c of the circle that sticks, a (1 − Q/μW)^(1/3), m.")
    displacement = _number("Tangential displacement of the bodies against each other, (3μW/4aGₜ) [1 − (1 − Q/μW)^(2/3)], m.")

    def cycle_loss(self) -> float:
        """Energy that friction takes in a closed cycle of the tangential load between Q and −Q, J.

        Q³/9aGₜμW for small Q, where about 3 log₁₀(μW/Q) digits are lost. Mindlin & Deresiewicz (1953).
        """
        return float(self._ask("cycle_loss"))

    def shear(self, r: Point) -> Point:
        """Shear traction at distance `r` from the axis, Pa, in the direction of Q.

        μ p₀ [√(1 − r²/a²) − (c/a) √(1 − r²/c²)], each root 0 where its argument is negative.
        """
        return self._ask("shear", r)  # type: ignore[no-any-return]


class MindlinDeresiewicz(_Form):
    """The push is taken back: partial slip under a tangential load that has grown to Q* and come down to Q.

    Twice the answer to half the change is taken off the answer at Q*, since slip has to start anew, backwards. At Q = −Q*
    all is as after a first push to −Q*; the way up from there is this one with the signs of Q, shear and displacement
    changed.

    References
    ----------
    Mindlin & Deresiewicz, J. Appl. Mech. 20, 327 (1953); Johnson (1985), section 7.4.
    """

    def __init__(
        self,
        turn: Annotated[CattaneoMindlin, "The contact where the tangential load turned, at Q*."],
        tangential_load: Annotated[Quantity, "Tangential load Q, from −Q* to Q*, N."],
    ) -> None:
        self.turn = turn
        self.tangential_load = quantity("tangential_load", tangential_load, "force", positive=False)
        most = turn.tangential_load
        self.tangential_load = _within("tangential_load", self.tangential_load, "N", -most, most)

    stick_radius = _number("Radius of the region without reverse slip, a (1 − (Q* − Q)/2μW)^(1/3), m.")
    displacement = _number("Tangential displacement of the bodies against each other, m, positive along Q*.")

    def shear(self, r: Point) -> Point:
        """Shear traction at distance `r` from the axis, Pa, positive along Q*."""
        return self._ask("shear", r)  # type: ignore[no-any-return]


class Carter(_Form):
    """Tractive rolling, in the steady state, of elastically identical parallel cylinders in plane strain.

    The surfaces enter the contact at x = a, stick at first, and slip towards the trailing edge x = −a. Against the other
    body, the one on which the tangential load acts along x moves along −x, at the creepage times the speed of rolling.

    References
    ----------
    Carter, Proc. R. Soc. A 112, 151 (1926); Johnson (1985), section 8.3.
    """

    def __init__(
        self,
        normal: Annotated[HertzLine, "The normal contact."],
        friction: _Friction,
        tangential_load_per_length: Annotated[float, "Tangential load Q′ per length of the line, from 0 to μP′, N/m."],
    ) -> None:
        self.normal = normal
        self.friction = _friction(friction)
        most = self.friction * normal.load_per_length
        load = _per_length("tangential_load_per_length", tangential_load_per_length)
        self.tangential_load_per_length = _within("tangential_load_per_length", load, "N/m", 0.0, most)

    @classmethod
    def from_creepage(cls, normal: HertzLine, friction: float, creepage: float) -> Carter:
        """The contact at a creepage ξ of at least 0; all slips from ξ = μa/R on."""
        made = cls(normal, friction, 0.0)
        speed = number("creepage", creepage, "a creepage of at least 0", 0.0)
        load = _answer("Carter.from_creepage", [], *normal._data(), made.friction, speed)
        made.tangential_load_per_length = load
        return made

    stick_half_width = _number("Half width c of the stick, a √(1 − Q′/μP′), m.")
    stick_centre = _number("Centre d = a − c of the stick, which reaches from a − 2c to the leading edge a, m.")
    creepage = _number("Creepage ξ = μd/R: difference of the circumferential speeds over the speed of rolling.")

    def shear(self, x: Point) -> Point:
        """Shear traction at `x`, Pa, in the direction of Q′; 0 outside the contact."""
        return self._ask("shear", x)  # type: ignore[no-any-return]


class SlidingSphere(_Form):
    """The stress under a Hertzian contact in full slip: pressure p and shear traction q = μp.

    Exact for identical materials, or where the shear does not change the pressure. Far away about 3 log₁₀(r/a) digits are
    lost.

    References
    ----------
    Hamilton & Goodman, J. Appl. Mech. 33, 371 (1966); Hamilton, Proc. Inst. Mech. Eng. 197C, 53 (1983); Johnson (1985),
    section 7.1.
    """

    def __init__(
        self,
        normal: Annotated[HertzSphere, "The normal contact."],
        friction: Annotated[float, "q/p, positive where the traction acts along +x."],
        poisson: Annotated[float, "Poisson's ratio of the body, 0 to 0.5."],
    ) -> None:
        self.normal = normal
        self.friction = number("friction", friction, "a finite number", -math.inf)
        self.poisson = _poisson(poisson)

    def stress(self, x: ArrayLike, y: ArrayLike, depth: ArrayLike) -> Stress:
        """Stress at (`x`, `y`) from the axis and at a `depth` of at least 0 into the body, a :class:`asperity.Stress`."""
        return Stress(*self._ask("stress", x, y, depth))


class StickingPunch(_Pressed):
    """Indentation by a rigid flat-ended cylinder that sticks, or a circle that sticks as a whole.

    W = 2aE*δ (atanh β)/β.

    References
    ----------
    Mossakovskii (1954); Spence, Proc. R. Soc. A 305, 55 (1968).
    """

    def __init__(self, radius: _PunchRadius, modulus: _Modulus, dundurs: _Dundurs, load: _Load) -> None:
        self.radius = quantity("radius", radius, "length")
        self.modulus = quantity("modulus", modulus, "pressure")
        self.dundurs = _dundurs(dundurs)
        self.load = _load(load)

    @classmethod
    def from_approach(cls, radius: Quantity, modulus: Quantity, dundurs: float, approach: Quantity) -> StickingPunch:
        """The punch at an approach δ of at least 0, m."""
        return cls(radius, modulus, dundurs, 0.0)._pressed(approach)

    approach = _number("Rigid-body approach δ, m.")


class StickingSphere(_Pressed):
    """A sphere on a plane, or two spheres, that stick as they come into touch, under a load that has grown from 0.

    W = (4E*a³/3R) (atanh β)/βJ,  δ = a²/RJ,  J = 2 ∫₀¹ t cos(ε ln((1 + t)/(1 − t))) dt,  ε = (atanh β)/π. Exact for the
    paraboloid.

    References
    ----------
    Mossakovskii (1963); Spence (1968); Borodich & Keer, Proc. R. Soc. A 460, 507 (2004).
    """

    def __init__(self, radius: _Radius, modulus: _Modulus, dundurs: _Dundurs, load: _Load) -> None:
        self.radius = quantity("radius", radius, "length")
        self.modulus = quantity("modulus", modulus, "pressure")
        self.dundurs = _dundurs(dundurs)
        self.load = _load(load)

    @classmethod
    def from_approach(cls, radius: Quantity, modulus: Quantity, dundurs: float, approach: Quantity) -> StickingSphere:
        """The contact at an approach δ of at least 0, m."""
        return cls(radius, modulus, dundurs, 0.0)._pressed(approach)

    contact_radius = _number("Contact radius a, m.")
    approach = _number("Rigid-body approach δ, m.")


class CoupledPunch(_Form):
    """A flat circular punch with slip at its edge, the shear acting back on the pressure: one of :data:`COUPLED`."""

    dundurs: Annotated[float, "Dundurs' β."]
    friction: Annotated[float, "Coefficient of friction μ."]
    stick_ratio: Annotated[float, "Stick ratio c/a, to 2e-6."]
    stiffening: Annotated[float, "Load over that without friction at the same approach, W/2aE*δ, to 5e-6."]

    def __init__(self, dundurs: float, friction: float, stick_ratio: float, stiffening: float) -> None:
        self.dundurs = dundurs
        self.friction = friction
        self.stick_ratio = stick_ratio
        self.stiffening = stiffening


COUPLED: tuple[CoupledPunch, ...] = tuple(CoupledPunch(*punch) for punch in _core.COUPLED_PUNCHES)
"""Stick ratio and load of the flat punch when coupled in full, computed by an independent axisymmetric program."""

BGT_COEFFICIENT: float = _core.AREA_COEFFICIENTS[0]
"""κ = √(2π) of Bush, Gibson & Thomas, Wear 35, 87 (1975), in A/A₀ = κ p̄/(E* h′)."""

PERSSON_COEFFICIENT: float = _core.AREA_COEFFICIENTS[1]
"""κ = √(8/π) of Persson, the slope of :func:`persson_area_fraction` at p̄ = 0."""


def stick_ratio(friction: ArrayLike, dundurs: ArrayLike) -> Any:
    """Stick ratio c/a of a round contact that is pressed together, 0 to 1.

    (1/2s) ln((1 + s)/(1 − s)) = (μ/abs(β)) K(√(1 − s²)), solved to round-off; 1 if β = 0. The same for a flat punch and any
    power-law indenter. By Goodman's formulas, in which the shear does not act back on the pressure: they take too much to
    stick, by at most 0.49 β².

    Parameters
    ----------
    friction : float or array_like
        Coefficient of friction μ, at least 0.
    dundurs : float or array_like
        Dundurs' β, above −1 and below 1.

    Returns
    -------
    float or ndarray

    References
    ----------
    Goodman, J. Appl. Mech. 29, 515 (1962); Spence, J. Elasticity 5, 297 (1975).
    """
    return _answer("stick_ratio", [], friction, dundurs)


def stick_ratio_plane(friction: ArrayLike, dundurs: ArrayLike) -> Any:
    """Stick ratio c/a of a long contact in plane strain, 0 to 1, as :func:`stick_ratio`: K(s)/K(√(1 − s²)) = μ/abs(β)."""
    return _answer("stick_ratio_plane", [], friction, dundurs)


def bgt_area_fraction(mean_pressure: ArrayLike, modulus: ArrayLike, rms_slope: ArrayLike) -> Any:
    """Area fraction A/A₀ = κ p̄/(E* h′) of the asperity theory; for A/A₀ ≪ 1 only, and not limited to 1.

    Parameters
    ----------
    mean_pressure, modulus : float or array_like
        Mean pressure p̄ and composite modulus E*, Pa.
    rms_slope : float or array_like
        Root mean square h′ of the gradient (Sdq) of the gap.

    Returns
    -------
    float or ndarray

    References
    ----------
    Bush, Gibson & Thomas, Wear 35, 87 (1975).
    """
    return _answer("bgt_area_fraction", [], mean_pressure, modulus, rms_slope)


def persson_area_fraction(mean_pressure: ArrayLike, modulus: ArrayLike, rms_slope: ArrayLike) -> Any:
    """Area fraction A/A₀ = erf(√2 p̄/(E* h′)) of Persson's theory, from first touch to full contact.

    Parameters as of :func:`bgt_area_fraction`. Persson, J. Chem. Phys. 115, 3840 (2001).
    """
    return _answer("persson_area_fraction", [], mean_pressure, modulus, rms_slope)


def fully_plastic_area(load: ArrayLike, hardness: ArrayLike) -> Any:
    """Area A = W/H when every contact flows, m²: the least that carries the load W, N, at the hardness H, Pa.

    Bowden & Tabor (1950).
    """
    return _answer("fully_plastic_area", [], load, hardness)


def corner_displacement(pressure: ArrayLike, pitch: Pair, modulus: ArrayLike) -> Any:
    """Displacement at a corner of a rectangle under uniform pressure, m.

    πE* u = p [Δx asinh(Δy/Δx) + Δy asinh(Δx/Δy)].

    Parameters
    ----------
    pressure, modulus : float or array_like
        Pressure p and composite modulus E*, Pa.
    pitch : float, str or pair of them
        Sides of the rectangle, m.

    Returns
    -------
    float or ndarray

    References
    ----------
    Love, Phil. Trans. R. Soc. A 228, 377 (1929); Johnson (1985), eq. 3.25.
    """
    return _answer("corner_displacement", [], pressure, *lengths("pitch", pitch), modulus)


def centre_displacement(pressure: ArrayLike, pitch: Pair, modulus: ArrayLike) -> Any:
    """Displacement at the centre of a rectangle under uniform pressure, m: twice :func:`corner_displacement`."""
    return _answer("centre_displacement", [], pressure, *lengths("pitch", pitch), modulus)


def mean_displacement(pressure: ArrayLike, pitch: Pair, modulus: ArrayLike) -> Any:
    """Mean displacement over a rectangle under uniform pressure, m; 0.9464 p L/E* of a square of side L.

    Parameters as of :func:`corner_displacement`. Johnson (1985), section 3.3.
    """
    return _answer("mean_displacement", [], pressure, *lengths("pitch", pitch), modulus)


def full_contact_pressure_2d(amplitude: ArrayLike, wavelength: ArrayLike, modulus: ArrayLike) -> Any:
    """Mean pressure p* = √2 π E*A/λ at which a sinusoid of two dimensions comes into full contact, Pa.

    h = A (1 − cos 2πx/λ cos 2πy/λ); the pressure is then p̄ + p* cos 2πx/λ cos 2πy/λ.
    Johnson, Greenwood & Higginson, Int. J. Mech. Sci. 27, 383 (1985).
    """
    return _answer("full_contact_pressure_2d", [], amplitude, wavelength, modulus)


def light_contact_fraction_2d(mean_pressure: ArrayLike, full_contact_pressure: ArrayLike) -> Any:
    """Fraction π (3p̄/8πp*)^(2/3) of the plane in contact with that sinusoid while p̄ ≪ p*.

    Hertz on two crests per λ², of radius λ²/4π²A. The source is that of :func:`full_contact_pressure_2d`.
    """
    return _answer("light_contact_fraction_2d", [], mean_pressure, full_contact_pressure)


def __dir__() -> list[str]:
    return __all__
