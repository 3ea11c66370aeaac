"""Types of the tables that arguments take, such as ``friction={"coefficient": 0.3}``.

Each type has the keys of a table of a case file. A type checker finds unknown keys with them. At run time a plain dictionary is
enough. A quantity is a number in SI or a text with a unit.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal, TypedDict

from ._units import Pair, Quantity

__all__ = ["Acceleration", "Adhesion", "Conductance", "Film", "Friction", "GapFlow", "Plasticity", "Stage", "Subsurface", "Temperature", "Thermal", "Wear"]


class _Law(TypedDict):
    coefficient: float


class Friction(_Law, total=False):
    """Keys of ``friction``.

    At most one of `force`, `displacement`, `sliding`, `creepage`, `creepages` and `rolling_force` is given, and only for a static
    contact.

    Attributes
    ----------
    coefficient : float
        Coefficient of friction, at least 0; infinite if nothing slips. Required.
    coupling : {"full", "goodman", "none"}
        Coupling of pressure and shear between dissimilar bodies. With ``"goodman"`` pressure shears, but shear does not press.
    shear_strength : float or str
        Largest shear traction of the interface, above 0, Pa.
    junction_growth : float
        Factor α of junction growth p² + αq² ≤ H², at least 0.
    force : float, str or pair of them
        Force of the upper body on the lower one, N, along x or along both axes.
    displacement : float, str or pair of them
        Displacement of the upper body against the lower one, m, along x or along both axes.
    sliding : pair of float
        Direction in which the upper body slides, of any length.
    creepage : float or pair of float
        Creepage of steady rolling along x, along x or along both axes.
    creepages : sequence
        Several creepages, one after the other: a traction curve.
    rolling_force : float, str or pair of them
        Force of the upper body on the lower one in steady rolling along x, N.
    spin : float
        Spin of rolling, 1/m.
    increments : int
        Number of equal steps in which the load and the tangential load grow from 0, at least 1.
    """

    coupling: Literal["full", "goodman", "none"]
    shear_strength: Quantity
    junction_growth: float
    force: Pair
    displacement: Pair
    sliding: Sequence[float]
    creepage: float | Sequence[float]
    creepages: Sequence[float | Sequence[float]]
    rolling_force: Pair
    spin: Quantity
    increments: int


class Stage(TypedDict, total=False):
    """Keys of a stage of ``history``. Quantities that a stage does not name do not change.

    Attributes
    ----------
    load : float or str
        Normal force, above 0, N. With adhesion it may pull, below 0.
    mean_pressure : float or str
        Load over the area of all cells, above 0, Pa. With adhesion it may pull, below 0.
    approach : float or str
        Approach of the bodies, m.
    force : float, str or pair of them
        Tangential force of the upper body on the lower one, N.
    displacement : float, str or pair of them
        Tangential displacement of the upper body relative to the lower one, m.
    sliding : pair of float
        Direction in which the upper body slides, of any length.
    increments : int
        Number of equal steps from the end of the stage before, at least 1.
    """

    load: Quantity
    mean_pressure: Quantity
    approach: Quantity
    force: Pair
    displacement: Pair
    sliding: Sequence[float]
    increments: int


class _Volume(TypedDict):
    depth: Quantity
    layers: int


class Plasticity(_Volume, total=False):
    """Keys of ``plasticity``, for bodies with an :class:`asperity.Plasticity`.

    Attributes
    ----------
    depth : float or str
        Depth of the volume that may deform plastically, m. Required.
    layers : int
        Number of its layers, 1 to 512. Required.
    growth : float
        Thickness of a layer over the thickness of the one above, 1 to 2.
    increments : int
        Number of equal steps of the load of a static contact, at least 1.
    tolerance : float
        Largest return-mapping residual over the yield stress, above 0, below 1.
    unload : bool
        Whether the load of a static contact is removed at the end.
    keep : {"last", "passes"}
        Whether the volumes of the last pass or of all passes are kept.
    """

    growth: float
    increments: int
    tolerance: float
    unload: bool
    keep: Literal["last", "passes"]


class _Depth(TypedDict):
    to: Quantity


class Subsurface(_Depth, total=False):
    """Keys of ``subsurface``: the stress below the surface of one body.

    Attributes
    ----------
    to : float or str
        Depth of the deepest plane, above 0, m. Required.
    layers : int
        Number of steps from the surface to `to`, 1 to 10 000.
    body : {"lower", "upper"}
        The body.
    planes : sequence of float or str
        Depths at which the von Mises stress is kept on the whole plane, m.
    section : float or str
        Position y of the section along x on which the stress is kept, m.
    columns : sequence of pairs of float or str
        Positions ``[x, y]`` below which the stress is kept, m.
    step : int
        The position of each pass that is computed, at least 1, in a motion.
    """

    layers: int
    body: Literal["lower", "upper"]
    planes: Sequence[Quantity]
    section: Quantity
    columns: Sequence[Sequence[Quantity]]
    step: int


class _Attraction(TypedDict):
    work: Quantity
    range: Quantity


class Adhesion(_Attraction, total=False):
    """Keys of ``adhesion``: the attraction between the bodies.

    Attributes
    ----------
    work : float or str
        Work of adhesion, above 0, J/m². Required.
    range : float or str
        Range of the attraction, above 0, m, or ``"grid"``: the shortest range that the grid resolves. Required.
    potential : {"exponential", "dugdale"}
        Tension as a function of the gap: ``"exponential"`` (by default), or constant up to the range.
    history : {"none", "path"}
        In a motion, whether the bodies come from afar at each position (``"none"``, by default), or from the position before.
    """

    potential: Literal["exponential", "dugdale"]
    history: Literal["none", "path"]


class Conductance(TypedDict, total=False):
    """Keys of ``conductance``: the thermal or electrical conductance of the contacts.

    Attributes
    ----------
    kind : {"thermal", "electrical"}
        Whether heat or current passes.
    film : float or str
        Resistance of a film on the spots, of an area, at least 0, m² K/W or Ω m².
    gas : float or str
        Thermal conductivity of a gas in the gap, above 0, W/(m K).
    jump : float or str
        Temperature jump distance of the gas, at least 0, m.
    drop : float or str
        Difference between the bodies, above 0, K or V.
    every : int
        Interval of the contacts whose conductance is computed.
    """

    kind: Literal["thermal", "electrical"]
    film: Quantity
    gas: Quantity
    jump: Quantity
    drop: Quantity
    every: int


class _Viscosity(TypedDict):
    viscosity: Quantity


class GapFlow(_Viscosity, total=False):
    """Keys of ``flow``: the flow of a fluid through the gap.

    Attributes
    ----------
    viscosity : float or str
        Viscosity of the fluid, above 0, Pa s. Required.
    pressure : float or str
        Pressure difference, at least 0, Pa.
    along : {"x", "y", "both"}
        Direction of the pressure gradient.
    ends : {"periodic", "reservoirs"}
        What lies beyond the ends of the grid along the gradient.
    gas : bool
        Whether the fluid is an ideal gas.
    outlet : float or str
        Absolute pressure of a gas at the outlet, above 0, Pa.
    every : int
        Interval of the contacts whose flow is computed.
    """

    pressure: Quantity
    along: Literal["x", "y", "both"]
    ends: Literal["periodic", "reservoirs"]
    gas: bool
    outlet: Quantity
    every: int


class Acceleration(TypedDict, total=False):
    """Keys of ``acceleration``: the extrapolation over several passes.

    Attributes
    ----------
    tolerance : float
        Largest error estimate of an extrapolation, above 0, relative.
    max_jump : int
        Largest number of passes that a computed pass represents, at least 1.
    max_wear : float or str
        Largest depth of wear of an extrapolation, above 0, m.
    """

    tolerance: float
    max_jump: int
    max_wear: Quantity


class _Bulk(TypedDict):
    bulk: Pair


class Temperature(_Bulk, total=False):
    """Keys of ``temperature``.

    Attributes
    ----------
    bulk : float, str or pair of them
        Temperature of the bodies far from the contact, K or a text such as ``"100 °C"``; two for the lower and the upper body.
        Required.
    every : int
        The flash temperature is computed in every n-th computed pass; 0 for none.
    """

    every: int


class Wear(TypedDict, total=False):
    """Keys of ``wear`` of a body. Exactly one of the first three is given.

    Attributes
    ----------
    coefficient : float or str
        Volume lost per load and distance slid, m³/(N m), such as ``"1e-7 mm3/(N m)"``.
    dimensionless : float
        The wear coefficient times the hardness of the body.
    energy : float or str
        Volume lost per energy of friction, m³/J, such as ``"1e-6 mm3/J"``.
    under_film : float or str
        The coefficient under the thickest film, in the unit of `coefficient` or `energy`.
    """

    coefficient: Quantity
    dimensionless: float
    energy: Quantity
    under_film: Quantity


class _Layer(TypedDict):
    law: Literal["arrhenius", "mechano-chemical", "solid-lubricant"]
    max_thickness: Quantity


class Film(_Layer, total=False):
    """Keys of ``film`` of a body: its tribofilm.

    Attributes
    ----------
    law : {"arrhenius", "mechano-chemical", "solid-lubricant"}
        Law of growth and removal. Required.
    max_thickness : float or str
        Largest thickness, above 0, m. Required.
    hardness : float or str
        Largest pressure of a cell under the thickest film, above 0, Pa.
    rate : float or str
        Law ``"arrhenius"``: growth rate at `at_temperature` and `at_stress`, m/s.
    at_temperature : float or str
        Law ``"arrhenius"``: temperature of that rate, K.
    at_stress : float or str
        Law ``"arrhenius"``: stress of that rate, Pa.
    activation_energy : float or str
        Law ``"arrhenius"``: activation energy, J.
    activation_volume : float or str
        Law ``"arrhenius"``: activation volume, m³.
    stress : {"pressure", "shear"}
        Law ``"arrhenius"``: the stress that activates the growth.
    removal : float or str
        Law ``"arrhenius"``: removal per pressure and distance slid, 1/(Pa m).
    x : float
        Law ``"mechano-chemical"``: the factor x.
    c3 : float or str
        Law ``"mechano-chemical"``: final removed thickness C₃, m.
    c4 : float
        Law ``"mechano-chemical"``: removal rate C₄, 1/s.
    wear : float or str
        Law ``"solid-lubricant"``: volume that the film loses per load and distance slid, m³/(N m).
    """

    hardness: Quantity
    rate: Quantity
    at_temperature: Quantity
    at_stress: Quantity
    activation_energy: Quantity
    activation_volume: Quantity
    stress: Literal["pressure", "shear"]
    removal: Quantity
    x: float
    c3: Quantity
    c4: float
    wear: Quantity


class Thermal(TypedDict, total=False):
    """Keys of ``thermal`` of a body: what it conducts.

    A flash temperature needs the first three. A conductance needs the conductivity, or the resistivity if it is electrical.

    Attributes
    ----------
    conductivity : float or str
        Thermal conductivity, W/(m K).
    heat_capacity : float or str
        Heat capacity, J/(kg K).
    density : float or str
        Density, kg/m³.
    resistivity : float or str
        Electrical resistivity, Ω m.
    """

    conductivity: Quantity
    heat_capacity: Quantity
    density: Quantity
    resistivity: Quantity


def __dir__() -> list[str]:
    return __all__
