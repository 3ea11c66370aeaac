"""Types of the tables that arguments take, such as ``friction={"coefficient": 0.3}``.

Each type has the keys of a table of a case file. A type checker finds unknown keys with them. At run time a plain dictionary is
enough. A quantity is a number in SI or a text with a unit.

This file is made from the declarations of the keys of case files: ``UPDATE=1 cargo test -p asperity-study``.
"""

# Annotations are not postponed here: types and texts are read when the package is imported.

from collections.abc import Sequence
from typing import Annotated, Literal, TypedDict

from ._units import Pair, Quantity

Boundary = Literal["free", "periodic"]
"""Boundary of the grid."""

__all__ = [
    "Acceleration",
    "Adhesion",
    "Conductance",
    "Fatigue",
    "FatigueLimits",
    "Film",
    "Flow",
    "Friction",
    "Joint",
    "Lubrication",
    "Plasticity",
    "Stage",
    "Steady",
    "Subsurface",
    "Temperature",
    "Thermal",
    "Viscoelastic",
    "Wear",
]


class _RequiredFriction(TypedDict):
    coefficient: float


class Friction(_RequiredFriction, total=False):
    """Keys of ``friction``.

    At most one of `force`, `displacement`, `sliding`, `creepage`, `creepages` and `rolling_force` is given, and only
    for a static contact.

    Attributes
    ----------
    coefficient : float
        Coefficient of friction μ; number ≥ 0, or `inf`: nothing slips. Required.
    coupling : {"full", "goodman", "none"}
        Coupling between dissimilar bodies: `"goodman"`, pressure displaces tangentially, but shear does not displace
        normally; `"none"`, neither. By default `"full"`.
    shear_strength : float or str
        τ, the largest shear stress of the interface under any pressure, for example of a boundary film; pressure > 0,
        or `inf`: no limit. By default `inf`.
    junction_growth : float
        α in p² + αq² ≤ H²: shear lowers the cap of the pressure, and the contact grows; about 9 for metals; number ≥ 0.
        By default `0`.
    force : float, str or pair of them
        Force of the upper body on the lower one; force along x, or `[x, y]`. Without it: 0.
    displacement : float, str or pair of them
        Displacement of the upper body relative to the lower one; length along x, or `[x, y]`. Without it: at most one
        of the six in the plane.
    sliding : pair of float
        Sliding direction of the upper body; every cell slips; `[x, y]` of any length. Without it: at most one of the
        six in the plane.
    creepage : float or pair of float
        Steady rolling along x: velocity of the upper body relative to the lower one, over the rolling velocity; number
        along x, or `[x, y]`. Without it: at most one of the six in the plane.
    creepages : sequence
        Several creepages, one after the other; list of at least one value, or a table. Without it: at most one of the
        six in the plane.
    rolling_force : float, str or pair of them
        Steady rolling along x: force of the upper body on the lower one; force along x, or `[x, y]`. Without it: at
        most one of the six in the plane.
    spin : float
        Rolling only, in 1/m: angular velocity of the upper body relative to the lower one, over the rolling velocity;
        its axis is z through the middle of the grid, and a positive spin turns from +x towards +y; number. By default
        `0`.
    increments : int
        Equal steps in which load and tangential load grow together from 0: a loading path, not a resolution. To press
        first and push then, push in a [[history]]; whole number ≥ 1. By default `1`.
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
    spin: float
    increments: int


class Stage(TypedDict, total=False):
    """Keys of a stage of ``history``. Quantities that a stage does not name do not change.

    Attributes
    ----------
    load : float or str
        As in [contact]; at most one of the three; with [adhesion] it may be 0 or pull, below 0; force. Without it:
        unchanged.
    mean_pressure : float or str
        As in [contact]; at most one of the three; with [adhesion] it may be 0 or pull, below 0; pressure. Without it:
        unchanged.
    approach : float or str
        As in [contact]; at most one of the three; length. Without it: unchanged.
    force : float, str or pair of them
        As in [friction], which it requires; at most one of the three; force along x, or `[x, y]`. Without it:
        unchanged.
    displacement : float, str or pair of them
        As in [friction], which it requires; at most one of the three; length along x, or `[x, y]`. Without it:
        unchanged.
    sliding : pair of float
        As in [friction], which it requires; at most one of the three; `[x, y]` of any length. Without it: unchanged.
    increments : int
        Equal steps from the end of the previous stage; in a cycle of each way; whole number ≥ 1. Without it: 1; with a
        `duration` or a `dwell` 16; for elasto-plastic bodies the number in [plasticity].
    cycles : int
        Number of cycles, in each of which the loading goes there and comes back; whole number ≥ 1. Without it: none:
        the loading goes there once.
    duration : float or str
        Time in which the loading goes there, in equal steps, for viscoelastic bodies; time > 0. Without it: none: at
        once.
    dwell : float or str
        Time for which the loading then stays, in `increments` steps that grow, for viscoelastic bodies; time > 0.
        Without it: none.
    period : float or str
        Time of a cycle, for films that grow and for viscoelastic bodies; time > 0. Without it: unknown.
    """

    load: Quantity
    mean_pressure: Quantity
    approach: Quantity
    force: Pair
    displacement: Pair
    sliding: Sequence[float]
    increments: int
    cycles: int
    duration: Quantity
    dwell: Quantity
    period: Quantity


class _RequiredPlasticity(TypedDict):
    depth: Quantity
    layers: int


class Plasticity(_RequiredPlasticity, total=False):
    """Keys of ``plasticity``, for bodies with an :class:`asperity.Plasticity`.

    Attributes
    ----------
    depth : float or str
        Depth of the volume that may deform plastically, from one cell to the smaller side of the grid; 2.5 radii of the
        largest spot are enough; length > 0. Required.
    layers : int
        Number of layers; whole number, 1 … 512. Required.
    growth : float
        Ratio of the thickness of a layer to that of the layer above; number, 1 … 2. By default `1`.
    increments : int
        Static: equal steps of the loading in [contact], of each [[history]] stage without its own number, and of the
        unloading; whole number ≥ 1. By default `16`.
    tolerance : float
        Return-mapping residual over the yield stress at which an increment has converged; number > 0, < 1. By default
        `1e-4`.
    unload : bool
        Static: whether the contact is unloaded at the end. By default `true`.
    keep : {"last", "passes"}
        [motion] only: whether the volumes of the last pass or of all passes are stored. By default `"last"`.
    """

    growth: float
    increments: int
    tolerance: float
    unload: bool
    keep: Literal["last", "passes"]


class _RequiredSubsurface(TypedDict):
    to: Quantity


class Subsurface(_RequiredSubsurface, total=False):
    """Keys of ``subsurface``: the stress below the surface of one body.

    Attributes
    ----------
    to : float or str
        Deepest plane; the largest stress of a contact spot lies at about a quarter of its width; length > 0. Required.
    layers : int
        Steps from the surface to `to`; whole number, 1 … 10000. By default `40`.
    body : {"lower", "upper"}
        Body, with its own Poisson's ratio. By default `"lower"`.
    planes : sequence of float or str
        Depths at which von Mises' stress is stored on the whole plane; list of lengths ≥ 0. Without it: none.
    section : float or str
        Place y of the section along x on which the stress is stored, in the contact; length ≥ 0. Without it: the most
        stressed point.
    columns : sequence of pairs of float or str
        Positions in the contact below which the stress is stored; list of `[x, y]`, lengths ≥ 0. Without it: none.
    step : int
        [motion] only: position of each pass at which the stress is computed; whole number ≥ 1. Without it: the position
        with aligned left edges.
    """

    layers: int
    body: Literal["lower", "upper"]
    planes: Sequence[Quantity]
    section: Quantity
    columns: Sequence[Sequence[Quantity]]
    step: int


class _RequiredAdhesion(TypedDict):
    work: Quantity
    range: Quantity


class Adhesion(_RequiredAdhesion, total=False):
    """Keys of ``adhesion``: the attraction between the bodies.

    Attributes
    ----------
    work : float or str
        Work of adhesion: the energy that separates an area of flat surfaces; energy of an area > 0. Required.
    range : float or str
        Range of the attraction, the gap at which the exponential tension has fallen to 1/e; length > 0, or `"grid"`:
        the shortest range that the grid resolves. Required.
    potential : {"exponential", "dugdale"}
        Tension as a function of the gap: `"exponential"`, or constant up to the range, for comparison with closed
        forms. By default `"exponential"`.
    history : {"none", "path"}
        In a motion: `"none"`, the bodies come from afar at each position; `"path"`, in a shift, from the position
        before, so that jumps lose energy. By default `"none"`.
    """

    potential: Literal["exponential", "dugdale"]
    history: Literal["none", "path"]


class Acceleration(TypedDict, total=False):
    """Keys of ``acceleration``: the extrapolation over several passes.

    Attributes
    ----------
    tolerance : float
        Largest error estimate of an extrapolation, over the depth to which the largest pressure presses a single cell;
        number > 0. By default `0.01`.
    max_jump : int
        Largest number of passes per extrapolation, the computed pass included; 1 computes all passes; whole number ≥ 1.
        By default `10000`.
    max_wear : float or str
        Largest wear depth in an extrapolation; length > 0. By default `"5 nm"`.
    """

    tolerance: float
    max_jump: int
    max_wear: Quantity


class _RequiredTemperature(TypedDict):
    bulk: Pair


class Temperature(_RequiredTemperature, total=False):
    """Keys of ``temperature``.

    Attributes
    ----------
    bulk : float, str or pair of them
        Temperature of the bodies far from the contact; a number without a unit is in kelvin; temperature > 0 K, or two:
        `[lower, upper]`. Required.
    every : int
        Computes the flash temperature at each position of every n-th computed pass, from the first on, for films and
        results; in other passes each cell has its mean temperature over the contacts of the last of these. It requires
        the thermal constants of both bodies, [friction] and a speed. 0: the surfaces have the temperatures of the
        bodies; whole number ≥ 0. Without it: 1 with thermal constants, else 0.
    """

    every: int


class Viscoelastic(TypedDict, total=False):
    """Keys of ``viscoelastic`` of a body or a layer: its relaxation. Either `moduli` and `times`, or `file` is given.

    Attributes
    ----------
    moduli : sequence of float or str
        Moduli that relax, in tension as `young`, which is the modulus that remains; list of pressures > 0. Without it:
        those of `file`.
    times : sequence of float or str
        Relaxation times, one for each modulus, all different; list of times > 0. Without it: those of a fit to `file`.
    file : str
        Master curve instead of `moduli` and `times`: a text whose titles name frequency, storage and loss modulus (or
        tan δ) with their units, such as `frequency_Hz, storage_MPa, loss_MPa`, or the export of an instrument; file
        name, relative to the case file. Without it: none.
    terms_per_decade : float
        Relaxation times a decade of the fit to `file`; number > 0. By default `2.0`.
    shift : float
        Shift factor a_T: all times are multiplied by it, for another temperature than that of the moduli; number > 0.
        By default `1.0`.
    wlf_c1 : float
        Constant c₁ of the shift of Williams, Landel and Ferry, log₁₀ a_T = −c₁(T − Tᵣ)/(c₂ + T − Tᵣ), at the
        temperature `bulk` of the body in [temperature]; number > 0. Without it: no such shift.
    wlf_c2 : float or str
        Constant c₂ of this shift; temperature difference > 0. Without it: no such shift.
    wlf_at : float or str
        Temperature Tᵣ of the moduli; temperature > 0. Without it: no such shift.
    """

    moduli: Sequence[Quantity]
    times: Sequence[Quantity]
    file: str
    terms_per_decade: float
    shift: float
    wlf_c1: float
    wlf_c2: Quantity
    wlf_at: Quantity


class _RequiredFatigueLimits(TypedDict):
    torsion: Quantity
    tension: Quantity


class FatigueLimits(_RequiredFatigueLimits, total=False):
    """Keys of ``fatigue`` of a body: its limits under alternating loads.

    Attributes
    ----------
    torsion : float or str
        Limit τ₋₁ in alternating torsion: an amplitude; pressure > 0. Required.
    tension : float or str
        Limit σ₋₁ in alternating tension: an amplitude, at most twice that in torsion; pressure > 0. Required.
    exponent : float
        Exponent m of Basquin's law: a pass or cycle does the damage (f/b)^m/N₀; number > 0, ≤ 100. By default `10.0`.
    cycles : float
        Cycles N₀ that a material endures at the limit; number > 0. By default `2e6`.
    endurance : bool
        Whether there is no damage below the limit. By default `false`.
    pit_depth : float or str
        Largest depth from which material breaks out where the damage reaches 1; 0 only reports it; length ≥ 0. By
        default `"0 um"`.
    risk : bool
        Whether the life is compared to that of the bodies without their roughness. By default `false`.
    """

    exponent: float
    cycles: float
    endurance: bool
    pit_depth: Quantity
    risk: bool


class Steady(TypedDict, total=False):
    """Keys of ``steady``: steady sliding of viscoelastic bodies. `speed` or `speeds` is given.

    Attributes
    ----------
    speed : float or str
        Speed of the contact over the body that is smooth along x; speed > 0. Without it: exactly one of the two.
    speeds : sequence of float or str
        Several speeds, one after the other, each from the contact at the one before; list of at least one speed > 0, or
        a table. Without it: exactly one of the two.
    """

    speed: Quantity
    speeds: Sequence[Quantity]


class Lubrication(TypedDict, total=False):
    """Keys of ``lubrication``: an oil between the bodies, in a steady film. `oil` or `viscosity` is given, and `speed` or
    `speeds`.

    Attributes
    ----------
    oil : {"ISO VG 32", "ISO VG 46", "ISO VG 68", "ISO VG 100", "ISO VG 150", "ISO VG 220", "ISO VG 320", "PAO 4", "PAO 6", "PAO 40", "ester", "glycerol", "water"}
        Oil by name, see lubricants, at the mean temperature of the bodies in [temperature]. Without it: exactly one of
        the two.
    viscosity : float or str
        Viscosity at ambient pressure; viscosity > 0. Without it: exactly one of the two.
    pressure_viscosity : float or str
        Pressure–viscosity coefficient α, the relative rise of the viscosity with pressure at ambient pressure; rise per
        pressure > 0. Without it: must be given with `viscosity`, but for `law = "constant"`.
    law : {"constant", "barus", "roelands", "doolittle"}
        How the viscosity rises with pressure: `"roelands"`; `"barus"`, exponentially, far too stiff above 0.3 GPa;
        `"doolittle"`, by the free volume of the oil, which follows measured viscosities to several GPa; or
        `"constant"`. Without it: `"roelands"`, or that of `oil`.
    bulk_modulus : float or str
        Isothermal bulk modulus of the oil at ambient pressure; pressure > 0. Without it: must be given with `law =
        "doolittle"`.
    occupied_volume : float
        Share of the volume of the oil at ambient pressure that its molecules occupy, below 1; number > 0. Without it:
        must be given with `law = "doolittle"`.
    compressible : bool
        Whether the density rises with pressure, by Dowson and Higginson, or by Tait with `law = "doolittle"`. Without
        it: true, or that of `oil`.
    limiting_stress : float
        Largest shear stress of the oil over its pressure, the limiting stress coefficient; number > 0. Without it: no
        limit.
    eyring_stress : float or str
        Eyring's stress τ₀, above which the oil shears more easily: τ = τ₀ asinh(η Δu/h τ₀); pressure > 0. Without it:
        Newtonian.
    speed : float or str
        Mean speed of both surfaces along +x, which entrains the oil: half the speed of the one that moves where the
        other one is at rest. 0 if a pressure at an end drives it; speed ≥ 0. Without it: exactly one of the two; none
        in a motion.
    speeds : float or str
        Several mean speeds, one after the other: a Stribeck curve; list of at least one speed > 0, or a table. Without
        it: exactly one of the two; none in a motion.
    sliding : float or str
        Difference of the speeds of both surfaces; 0 in pure rolling; speed ≥ 0. Without it: twice the mean speed: one
        body is at rest.
    boundary_film : float or str
        Film that solids that touch keep between them: a few molecules; length > 0. By default `"2 nm"`.
    boundary_friction : float
        Friction coefficient of the solids where they touch, with their boundary film; number ≥ 0. Without it: 0, with a
        warning where solids bear.
    inlet_pressure : float or str
        Pressure of the oil at the inlet, above that around; pressure ≥ 0. By default `0`.
    outlet_pressure : float or str
        Pressure of the oil at the outlet, above that around; pressure ≥ 0. By default `0`.
    """

    oil: Literal["ISO VG 32", "ISO VG 46", "ISO VG 68", "ISO VG 100", "ISO VG 150", "ISO VG 220", "ISO VG 320", "PAO 4", "PAO 6", "PAO 40", "ester", "glycerol", "water"]
    viscosity: Quantity
    pressure_viscosity: Quantity
    law: Literal["constant", "barus", "roelands", "doolittle"]
    bulk_modulus: Quantity
    occupied_volume: float
    compressible: bool
    limiting_stress: float
    eyring_stress: Quantity
    speed: Quantity
    speeds: Quantity
    sliding: Quantity
    boundary_film: Quantity
    boundary_friction: float
    inlet_pressure: Quantity
    outlet_pressure: Quantity


class Thermal(TypedDict, total=False):
    """Keys of ``thermal`` of a body: what it conducts.

    A flash temperature needs the first three.

    Attributes
    ----------
    conductivity : float or str
        Thermal conductivity, for the flash temperature and for heat that passes a contact; give it for both bodies;
        thermal conductivity > 0, or `inf`: no resistance, only where heat passes a contact. Without it: unknown.
    resistivity : float or str
        Electrical resistivity, for a current that passes a contact; give it for both bodies; resistivity > 0. Without
        it: unknown.
    heat_capacity : float or str
        Heat capacity; required with `conductivity`; heat capacity > 0. Without it: unknown.
    density : float or str
        Density; required with `conductivity`; density > 0. Without it: unknown.
    """

    conductivity: Quantity
    resistivity: Quantity
    heat_capacity: Quantity
    density: Quantity


class _RequiredFlow(TypedDict):
    viscosity: Quantity


class Flow(_RequiredFlow, total=False):
    """Keys of ``flow``: flow of a fluid through the gap.

    Attributes
    ----------
    viscosity : float or str
        Viscosity of the fluid, constant; viscosity > 0. Required.
    pressure : float or str
        Pressure difference that drives the leakage; pressure ≥ 0. By default `1e5`.
    along : {"x", "y", "both"}
        Direction of the pressure gradient. By default `"both"`.
    ends : {"periodic", "reservoirs"}
        `"periodic"`: the gap repeats itself, under a mean gradient of pressure; `"reservoirs"`: the fluid has two
        pressures at the ends of the grid, and the sides are closed along a free axis. Without it: `"periodic"` along
        periodic axes, `"reservoirs"` along free ones.
    gas : bool
        Whether the fluid is an ideal gas at constant temperature; needs `outlet`. By default `false`.
    outlet : float or str
        Absolute pressure of a gas at the outlet, to which its leakage refers; pressure > 0. Without it: with a gas:
        must be given.
    density : float or str
        Density of a liquid, by which its leakage is also given as a mass; density > 0. Without it: unknown.
    width : float or str
        Width of the face of a seal along the flow, for which the leakage of a metre of seal is given. This leakage is
        inversely proportional to the width; length > 0. Without it: the length of the map along the flow.
    shear : bool
        Whether to compute how the surfaces carry and shear the fluid when they slide: the shear flow factor and the
        stress factors of mean equations of lubrication. By default `false`.
    every : int
        Interval of the positions of a pass, or of the increments, updates or points, whose flow is computed; 0: once a
        pass, where the left edges are flush, or for the last contact alone; whole number ≥ 0. By default `1`.
    """

    pressure: Quantity
    along: Literal["x", "y", "both"]
    ends: Literal["periodic", "reservoirs"]
    gas: bool
    outlet: Quantity
    density: Quantity
    width: Quantity
    shear: bool
    every: int


class Conductance(TypedDict, total=False):
    """Keys of ``conductance``: thermal or electrical conductance of the contacts.

    Attributes
    ----------
    kind : {"thermal", "electrical"}
        Whether heat or current passes: bodies need `conductivity` or `resistivity`. By default `"thermal"`.
    film : float or str
        Resistance of a film on the spots, of an area; resistance of an area ≥ 0, such as "1e-8 m2 K/W"; "1e-12 ohm m2"
        with `kind = "electrical"`. Without it: none.
    gas : float or str
        Thermal conductivity of a gas in the gap; thermal conductivity > 0. Without it: none.
    jump : float or str
        Temperature jump distance of the gas at both surfaces together, which adds to the gap; length ≥ 0. By default
        `0.0`.
    drop : float or str
        Difference between the bodies; it scales flux and power, nothing else; temperature difference > 0, such as "10
        K"; "0.1 V" with `kind = "electrical"`. Without it: 1 K, or 1 V.
    every : int
        Interval of the positions of a pass, or of the increments, updates or points, whose conductance is computed; 0:
        once a pass, where the left edges are flush, or for the last contact alone; whole number ≥ 0. By default `1`.
    """

    kind: Literal["thermal", "electrical"]
    film: Quantity
    gas: Quantity
    jump: Quantity
    drop: Quantity
    every: int


class _RequiredFatigue(TypedDict):
    to: Quantity


class Fatigue(_RequiredFatigue, total=False):
    """Keys of ``fatigue``: fatigue below the surfaces of bodies under loads that repeat.

    Attributes
    ----------
    to : float or str
        Largest depth, below which nothing is looked at; length > 0. Required.
    layers : int
        Number of depths, geometric from half a cell, or from the lowest interface of a body with thicker layers, to the
        largest; whole number ≥ 1. By default `8`.
    every : int
        Interval of the positions of a pass, or of the increments of a cycle, whose stress is computed; whole number ≥
        1. By default `1`.
    passes : sequence
        Passes, or cycles of each stage, that are looked at, counted as they are computed; list of whole numbers ≥ 1.
        Without it: all computed ones.
    """

    layers: int
    every: int
    passes: Sequence[int]


class Joint(TypedDict, total=False):
    """Keys of ``joint``: law of a joint of rough surfaces: tangential stiffness, and theories beside.

    Attributes
    ----------
    samples : int
        Samples that `asperity joint` computes, each of generated surfaces from other seeds; whole number, 1 … 10000.
        Without it: 1, or the number of patches or files.
    patches : sequence
        Patches along x and y into which `asperity joint` cuts measured surfaces; each is a sample; `[nx, ny]`, each ≥
        1. Without it: the whole map.
    files : sequence
        Measured files that `asperity joint` takes in place of that of the one measured body; each is a sample; file
        names, relative to the case file. Without it: that of the body.
    every : int
        Interval of the points of a sweep, or of the increments, that are computed; 0 for the last contact alone; whole
        number ≥ 0. By default `1`.
    """

    samples: int
    patches: Sequence[int]
    files: Sequence[str]
    every: int


class Wear(TypedDict, total=False):
    """Keys of ``wear`` of a body: wear law.

    Attributes
    ----------
    coefficient : float or str
        Wear volume per load and sliding distance (Archard); volume per load and distance > 0. Without it: exactly one
        of the three.
    dimensionless : float
        `coefficient` times the `hardness` of the body, which must be a single number; number > 0. Without it: exactly
        one of the three.
    energy : float or str
        Wear volume per frictional energy; requires [friction]; volume per load and distance > 0. Without it: exactly
        one of the three.
    under_film : float or str
        Coefficient under the thickest film, in the unit of `coefficient` or `energy`, also with `dimensionless`, at
        most the coefficient of the bare body; it decreases linearly with the thickness; the body needs a film; volume
        per load and distance > 0. Without it: the coefficient of the bare body.
    """

    coefficient: Quantity
    dimensionless: float
    energy: Quantity
    under_film: Quantity


class _RequiredFilm(TypedDict):
    law: Literal["arrhenius", "mechano-chemical", "solid-lubricant"]
    max_thickness: Quantity


class Film(_RequiredFilm, total=False):
    """Keys of ``film`` of a body: growing tribofilm.

    Attributes
    ----------
    law : {"arrhenius", "mechano-chemical", "solid-lubricant"}
        `"arrhenius"`: growth activated by stress, removal by sliding; `"mechano-chemical"`; `"solid-lubricant"`: a film
        that is there at its thickest in the beginning and is only worn off. Required.
    max_thickness : float or str
        Upper limit of the film thickness; length > 0. Required.
    hardness : float or str
        Hardness under the thickest film, at most the hardness of the body; interpolated linearly in the thickness;
        pressure > 0. Without it: the hardness of the body.
    rate : float or str
        With `law = "arrhenius"`: initial growth rate, at `at_temperature` and `at_stress`; speed > 0.
    at_temperature : float or str
        With `law = "arrhenius"`: temperature at which `rate` holds; temperature, 2e2 … 5e3 K.
    at_stress : float or str
        With `law = "arrhenius"`: stress at which `rate` holds; pressure ≥ 0.
    activation_energy : float or str
        With `law = "arrhenius"`: activation energy of the growth; energy, 0 or 1e-24 … 1e-17 J.
    activation_volume : float or str
        With `law = "arrhenius"`: activation volume of the growth; volume, 0 or 1e-36 … 1e-18 m³.
    stress : {"pressure", "shear"}
        With `law = "arrhenius"`: stress that activates the growth; `"shear"` requires [friction]. By default
        `"pressure"`.
    removal : float or str
        With `law = "arrhenius"`: removal per pressure and sliding distance; rate per pressure and distance ≥ 0. By
        default `0`.
    x : float
        With `law = "mechano-chemical"`: factor x of the growth; number, 1e-45 … 1e0.
    c3 : float or str
        With `law = "mechano-chemical"`: final removal C₃ as a thickness, at most `max_thickness`; length ≥ 0.
    c4 : float
        With `law = "mechano-chemical"`: rate C₄ of the removal, in 1/s; number, 0 or 1e-15 … 1e15 1/s.
    wear : float or str
        With `law = "solid-lubricant"`: film volume lost per load and sliding distance, until the film is worn off; the
        heights of the surface include the film; volume per load and distance > 0.
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


class Capabilities(TypedDict, total=False):
    """Keywords of the capabilities."""

    flow: Annotated[Flow | None, "",
        "Flow of a fluid through the gap: `viscosity`, `pressure`, `along`, `ends`, `gas`, `outlet`, `density`, `width`, `shear`, `every`."]
    conductance: Annotated[Conductance | None, "",
        "Thermal or electrical conductance of the contacts: `kind`, `film`, `gas`, `jump`, `drop`, `every`."]
    fatigue: Annotated[Fatigue | None, "",
        "Fatigue below the surfaces of bodies under loads that repeat: `to`, `layers`, `every`, `passes`."]
    joint: Annotated[Joint | None, "",
        "Law of a joint of rough surfaces: tangential stiffness, and theories beside: `samples`, `patches`, `files`, `every`."]


class OfBody(TypedDict, total=False):
    """Keywords of a body: what contacts do to it, and how it responds."""

    wear: Annotated[Wear | None, "",
        "Wear law: `coefficient`, `dimensionless`, `energy`, `under_film`."]
    film: Annotated[Film | None, "",
        "Growing tribofilm: `law`, `max_thickness`, `hardness`, `rate`, `at_temperature`, `at_stress`, `activation_energy`, `activation_volume`, `stress`, `removal`, `x`, `c3`, `c4`, `wear`."]
    viscoelastic: Annotated[Viscoelastic | None, "",
        "Relaxation of the body: `moduli`, `times`, `file`, `terms_per_decade`, `shift`, `wlf_c1`, `wlf_c2`, `wlf_at`."]
    fatigue: Annotated[FatigueLimits | None, "",
        "Limits of the material under alternating loads: `torsion`, `tension`, `exponent`, `cycles`, `endurance`, `pit_depth`, `risk`."]


class Common(Capabilities, total=False):
    """Keywords of every contact."""

    load: Annotated[Quantity | None, "contact",
        "Total normal force; in a motion, the mean over a pass or the force at each position, see `control`; force > 0. Without "
        "it: exactly one of the six that give a load or an approach."]
    mean_pressure: Annotated[Quantity | None, "contact",
        "Load over the apparent area, the area of all cells at full overlap; during an overlap motion half of them overlap on "
        "average, so that the mean pressure there is about twice as large; pressure > 0. Without it: exactly one of the six that "
        "give a load or an approach."]
    approach: Annotated[Quantity | None, "contact",
        "Distance by which the bodies have approached, of any sign; 0 if the planes z = 0 of both height maps coincide; length. "
        "Without it: exactly one of the six that give a load or an approach."]
    boundary: Annotated[Boundary | Sequence[Boundary] | None, "contact",
        "Continuation beyond the edges: `\"free\"`, an unloaded half-space; `\"periodic\"`, copies of the contact; one of each: a "
        "line contact; `\"free\"`, `\"periodic\"`, or one word for each axis: `[\"free\", \"periodic\"]`. By default `\"free\"`."]
    grid: Annotated[Literal["as-prepared", "common"] | None, "contact",
        "`\"common\"` resamples both prepared surfaces to the coarser pitch and crops them about their centres to a common size; "
        "`\"as-prepared\"` requires surfaces that fit. By default `\"as-prepared\"`."]
    method: Annotated[Literal["auto", "direct", "polonsky-keer", "active-set"] | None, "contact",
        "Solver; all methods give the same result. By default `\"auto\"`."]
    device: Annotated[Literal["cpu", "cuda", "host"] | None, "contact",
        "Device that solves the contact: `\"cpu\"`; `\"cuda\"`, a GPU of NVIDIA; `\"host\"`, the solver of the GPU in plain loops on "
        "the processor, for comparison. By default `\"cpu\"`."]
    tolerance: Annotated[float | None, "contact",
        "Residual η at which the solver stops, see theory; number > 0, < 1. By default `1e-6`."]
    friction: Annotated[float | Friction | None, "",
        "Friction law and tangential loading: `coefficient`, `coupling`, `shear_strength`, `junction_growth`, `force`, "
        "`displacement`, `sliding`, `creepage`, `creepages`, `rolling_force`, `spin`, `increments`; a number is its coefficient."]
    adhesion: Annotated[Adhesion | None, "",
        "Attraction between the bodies: `work`, `range`, `potential`, `history`."]


class Rest(TypedDict, total=False):
    """Keywords of a static contact."""

    loads: Annotated[Sequence[Quantity] | None, "contact",
        "Several loads, one after the other; list of at least one value, or a table. Without it: exactly one of the six that give "
        "a load or an approach."]
    mean_pressures: Annotated[Sequence[Quantity] | None, "contact",
        "Several mean pressures, one after the other; list of at least one value, or a table. Without it: exactly one of the six "
        "that give a load or an approach."]
    approaches: Annotated[Sequence[Quantity] | None, "contact",
        "Several approaches, one after the other; list of at least one value, or a table. Without it: exactly one of the six that "
        "give a load or an approach."]
    history: Annotated[Sequence[Stage] | None, "",
        "Further stages of the loading of a static contact: `load`, `mean_pressure`, `approach`, `force`, `displacement`, "
        "`sliding`, `increments`, `cycles`, `duration`, `dwell`, `period`."]
    steady: Annotated[Steady | None, "",
        "Steady sliding of viscoelastic bodies: `speed`, `speeds`."]
    acceleration: Annotated[Acceleration | None, "",
        "Extrapolation over passes of bodies that laws change: `tolerance`, `max_jump`, `max_wear`."]
    temperature: Annotated[Temperature | None, "",
        "Temperature of the bodies: `bulk`, `every`."]
    plasticity: Annotated[Plasticity | None, "",
        "Volume below the surface in which bodies deform plastically: `depth`, `layers`, `growth`, `increments`, `tolerance`, "
        "`unload`, `keep`."]
    subsurface: Annotated[Subsurface | None, "",
        "Stress below the surface: `to`, `layers`, `body`, `planes`, `section`, `columns`, `step`."]
    lubrication: Annotated[Lubrication | None, "",
        "Oil between the bodies: `oil`, `viscosity`, `pressure_viscosity`, `law`, `bulk_modulus`, `occupied_volume`, "
        "`compressible`, `limiting_stress`, `eyring_stress`, `speed`, `speeds`, `sliding`, `boundary_film`, `boundary_friction`, "
        "`inlet_pressure`, `outlet_pressure`."]
    pressure_every: Annotated[int | None, "output",
        "Interval of the steps whose fields are stored, from the first one on; 0: none. A position of a pass has its pressure, a "
        "point of a sweep and an increment of bodies that attract each other have pressure and gap; the point of the largest drag "
        "and the increment of the largest pull are stored as well; whole number ≥ 0. By default `8`."]


class _RequiredSliding(TypedDict):
    distance: Annotated[Quantity, "sliding",
        "Sliding distance; length > 0. Required."]


class Sliding(_RequiredSliding, total=False):
    """Keywords of sliding in place."""

    speed: Annotated[Quantity | None, "sliding",
        "Speed of the upper body; required for growing films and for temperature; speed > 0. Without it: unknown."]
    updates: Annotated[int | None, "sliding",
        "Number of implicit updates, each a contact with the changes of the bodies during it; update i of n ends at the distance "
        "· (i/n)²; whole number ≥ 1. By default `40`."]
    temperature: Annotated[Temperature | None, "",
        "Temperature of the bodies: `bulk`, `every`."]


class Motion(TypedDict, total=False):
    """Keywords of a motion."""

    strategy: Annotated[Literal["overlap", "shift"] | None, "motion",
        "`\"overlap\"`: the upper body enters on the left, passes over the lower one and leaves on the right; only the overlap is "
        "solved. `\"shift\"`: both bodies are shifted cyclically and the full contact is solved. By default `\"overlap\"`."]
    passes: Annotated[int | None, "motion",
        "Number of passes; whole number ≥ 1. By default `1`."]
    stride: Annotated[int | None, "motion",
        "Cells from one position to the next; whole number ≥ 1. By default `1`."]
    control: Annotated[Literal["pass-load", "step-load", "approach"] | None, "motion",
        "Prescribed quantity. `\"pass-load\"`: the mean load of a pass, with one approach for the pass; `\"step-load\"`: the load at "
        "each position; `\"approach\"`: the approach at all positions. Without it: `\"pass-load\"`; `\"approach\"` if [contact] gives "
        "an approach."]
    plastic_update: Annotated[Literal["pass", "step"] | None, "motion",
        "When plastic deformation changes the surfaces: after each pass, or at every step; for elasto-plastic bodies always "
        "`\"step\"`. By default `\"pass\"`."]
    load_tolerance: Annotated[float | None, "motion",
        "Relative tolerance of the mean load of a pass; number > 0, < 1. By default `1e-4`."]
    speed_lower: Annotated[Quantity | None, "motion",
        "`\"shift\"` only: speed of the lower surface along x; apart from times, only the ratio of the speeds matters; speed. By "
        "default `0`."]
    speed_upper: Annotated[Quantity | None, "motion",
        "`\"shift\"` only: speed of the upper surface along x; at most one speed may be 0; speed. By default `\"1 m/s\"`."]
    speed: Annotated[Quantity | None, "motion",
        "`\"overlap\"` only: speed of the upper body; required for growing films, temperature, viscoelastic and lubricated bodies; "
        "speed > 0. Without it: unknown."]
    pause: Annotated[Quantity | None, "motion",
        "Viscoelastic bodies only: time for which they are apart between two passes; without it the passes of a shift follow each "
        "other in contact; time ≥ 0. By default `0`."]
    path: Annotated[Literal["one-way", "reciprocating"] | None, "motion",
        "`\"reciprocating\"`: a pass goes forth and back. By default `\"one-way\"`."]
    offset_y: Annotated[int | Literal["random"] | None, "motion",
        "Shift of the upper body along y from pass to pass, in cells; `\"random\"`: a random position, from `seed` and the number "
        "of the pass; whole number ≥ 0, or `\"random\"`. By default `0`."]
    seed: Annotated[int | None, "motion",
        "Seed of `offset_y = \"random\"`; whole number ≥ 0. By default `0`."]
    counter: Annotated[Literal["same", "fresh"] | None, "motion",
        "Upper body in the passes after the first: the same, or a fresh one, generated and prepared in the same way from another "
        "seed. By default `\"same\"`."]
    acceleration: Annotated[Acceleration | None, "",
        "Extrapolation over passes of bodies that laws change: `tolerance`, `max_jump`, `max_wear`."]
    temperature: Annotated[Temperature | None, "",
        "Temperature of the bodies: `bulk`, `every`."]
    plasticity: Annotated[Plasticity | None, "",
        "Volume below the surface in which bodies deform plastically: `depth`, `layers`, `growth`, `increments`, `tolerance`, "
        "`unload`, `keep`."]
    subsurface: Annotated[Subsurface | None, "",
        "Stress below the surface: `to`, `layers`, `body`, `planes`, `section`, `columns`, `step`."]
    lubrication: Annotated[Lubrication | None, "",
        "Oil between the bodies: `oil`, `viscosity`, `pressure_viscosity`, `law`, `bulk_modulus`, `occupied_volume`, "
        "`compressible`, `limiting_stress`, `eyring_stress`, `speed`, `speeds`, `sliding`, `boundary_film`, `boundary_friction`, "
        "`inlet_pressure`, `outlet_pressure`."]
    pressure_every: Annotated[int | None, "output",
        "Interval of the steps whose fields are stored, from the first one on; 0: none. A position of a pass has its pressure, a "
        "point of a sweep and an increment of bodies that attract each other have pressure and gap; the point of the largest drag "
        "and the increment of the largest pull are stored as well; whole number ≥ 0. By default `8`."]
    rim: Annotated[float | None, "output",
        "Part of a body's length, at its free ends, that the columns `…_interior` of the tables leave out; number ≥ 0, < 0.5. By "
        "default `0.1`."]


class Output(TypedDict, total=False):
    """Keywords of the results."""

    paraview: Annotated[bool | None, "output",
        "Whether all fields, and the stress below the surface as a volume, are also written as VTK image data (`.vti`). By "
        "default `false`."]
    title: Annotated[str | None, "",
        "Name for reports. Without it: file name without its extension."]


def __dir__() -> list[str]:
    return __all__
