"""The flow of a fluid through the gap of a contact."""

# Annotations are not postponed here: types and texts are read when the package is imported.

from typing import TYPE_CHECKING, Annotated, Any, Literal, TypedDict

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _case, _core
from ._described import described
from ._keywords import takes
from ._raise import bad_input
from ._same import Comparable
from ._solved import Solved
from ._units import Pair, Quantity, choice, edges, lengths, matrix, quantity, written

if TYPE_CHECKING:
    from typing_extensions import Unpack

Ends = Literal["periodic", "reservoirs"]
"""What lies beyond the ends of the gap along the pressure gradient."""

Sides = Literal["periodic", "closed"]
"""What lies beyond its sides."""

Faces = Literal["linear", "harmonic"]
"""Rule for the gap between two cells."""


@described
class GapFlow(Comparable):
    """The flow of a fluid through a gap, under a pressure gradient along x and under one along y.

    Returned by :func:`asperity.flow` and :meth:`Contact.flow`.

    An attribute with one value for each direction of the gradient is an array ``[along x, along y]``. Without an open path along an
    axis its numbers are 0.
    """

    permeability: Annotated[NDArray[np.float64],
        "Permeability K of the whole gap, 2 × 2, m³: the mean flux per width is −K ∇P/12η. Between reservoirs or "
        "closed sides the elements off the diagonal are not defined, and 0."]
    leakage: Annotated[NDArray[np.float64] | None,
        "Volume that leaks in a unit of time along each axis, m³/s; of a gas, at the pressure of the outlet. None "
        "without a fluid."]
    hydraulic_gap: Annotated[NDArray[np.float64], "Gap between parallel plates of the same permeability, m."]
    flow_factor: Annotated[NDArray[np.float64], "Permeability over the cube of the mean gap."]
    critical_gap: Annotated[NDArray[np.float64],
        "Critical constriction: the largest gap that all cells of some path reach, m."]
    critical_cell: Annotated[list[tuple[int, int] | None],
        "Cell ``(ix, iy)`` of the critical constriction; None without a path."]
    flowing_share: Annotated[NDArray[np.float64], "Share of the cells that are part of a path, with their dead ends."]
    trapped_volume: Annotated[NDArray[np.float64], "Volume from which no path leads out, m³."]
    estimate: Annotated[NDArray[np.float64],
        "Estimate of the relative error of the permeability, from the other rule for `faces`."]
    other_faces: Annotated[NDArray[np.float64],
        "Lower and upper bound of the permeability with the other rule for `faces`, ``[direction, bound]``, m³."]
    residual: Annotated[NDArray[np.float64],
        "Largest relative difference of the flux through a section from the mean of all sections."]
    dissipation: Annotated[NDArray[np.float64],
        "Relative difference of the dissipated work from that of the mean flux."]
    pressure: Annotated[NDArray[np.float64],
        "Pressure of the fluid over its drop, ``[direction, ix, iy]``: 1 at the start of the axis, 0 at its end. 0 in "
        "contact and where no path leads to an end."]
    flux: Annotated[NDArray[np.float64],
        "Flux per width over the mean gradient and 1/12η, ``[direction, component, ix, iy]``, m³; its mean is the "
        "permeability."]
    flowing: Annotated[NDArray[np.bool_], "Whether a cell is part of a path, ``[direction, ix, iy]``."]
    mean_gap: Annotated[float, "Mean gap over all cells, m."]
    closed_share: Annotated[float, "Share of the cells in contact."]
    effective_medium: Annotated[float,
        "Permeability of an isotropic effective medium (Bruggeman) with the same gaps, m³. It is a comparison only."]

    def __init__(self, found: tuple[Any, Any, Any]) -> None:
        numbers, coupling, along = found
        for name, value in numbers:
            setattr(self, name, value)
        of_axes, bounds, cells, leakage, pressure, flux, flowing = zip(*along)
        for name in dict(of_axes[0]):
            setattr(self, name, np.array([dict(of_axis)[name] for of_axis in of_axes]))
        off = 0.0 if coupling is None else coupling
        own = self.permeability
        self.permeability = np.array([[own[0], off], [off, own[1]]])
        self.leakage = None if None in leakage else np.array(leakage)
        self.critical_cell = [None if cell is None else (cell[0], cell[1]) for cell in cells]
        self.other_faces = np.array(bounds)
        self.pressure = np.array(pressure)
        self.flux = np.array(flux)
        self.flowing = np.array(flowing)

    def __repr__(self) -> str:
        def both(values: NDArray[np.float64]) -> str:
            return f"{values[0]:.3g} and {values[1]:.3g}"

        nx, ny = self.flowing.shape[1:]
        leakage = "" if self.leakage is None else f", leakage {both(self.leakage)} m³/s"
        return (
            f"<GapFlow: {nx} × {ny} cells, along x and y: permeability {both(np.diag(self.permeability))} m³"
            f"{leakage}, critical gap {both(self.critical_gap)} m>"
        )


# fmt: off
class FlowKeywords(TypedDict, total=False):
    """Keywords of the flow through the gap of a contact."""

    viscosity: Annotated[Quantity | None,
        "Dynamic viscosity of the fluid, Pa s or a text such as ``\"80 mPa s\"``; needed for the leakage."]
    pressure: Annotated[Quantity | None, "Drop of the pressure over the length of the gap, Pa; needed for the leakage."]
    outlet: Annotated[Quantity | None,
        "Absolute pressure at the outlet of an ideal gas of constant temperature, Pa. Without it the fluid is a liquid."]
    ends: Annotated[Ends | None,
        "``\"periodic\"``: a mean gradient on a gap that repeats itself; or ``\"reservoirs\"`` at both ends. By default they are "
        "periodic; for a contact, along its periodic axes alone."]
    sides: Annotated[Sides | None,
        "``\"periodic\"`` or ``\"closed\"``. By default they are periodic; for a contact, along its periodic axes alone."]
    faces: Annotated[Faces,
        "The gap between two cells: ``\"linear\"`` between their centres, or ``\"harmonic\"``, the harmonic mean of their "
        "permeabilities."]
    threads: Annotated[int | None, "Number of threads; one for each core by default. The answer does not depend on it."]


# fmt: on
@takes(FlowKeywords, faces="linear")
def flow(source: "Solved | ArrayLike", *, pitch: "Pair | None" = None, **options: "Unpack[FlowKeywords]") -> GapFlow:
    """Compute the flow of a fluid through a gap, along x and along y.

    The flow is slow and thin, and its viscosity is constant (Reynolds' equation). The pressure of the fluid does not deform the bodies.

    Parameters
    ----------
    source : Contact or array_like
        A contact, which provides its gap and its pitch; or the gap of each cell, a matrix ``[ix, iy]``, m. A cell whose gap is not
        positive is in contact, and closed.
    pitch : float, str or pair of them, optional
        Size of a cell along x and y, m.
    **options

    Returns
    -------
    GapFlow

    Raises
    ------
    asperity.errors.BadInput
        If an argument is invalid.
    asperity.errors.NotFinite
        If a gap is NaN or infinite.
    asperity.errors.Memory
        If the computation needs more memory than is available.

    Examples
    --------
    >>> import numpy as np, asperity as asp
    >>> gap = np.full((32, 32), 1e-6)
    >>> gap[:8, :8] = 0.0
    >>> f = asp.flow(gap, pitch="2 um", viscosity="80 mPa s", pressure="1 bar")
    >>> f"{f.flow_factor[0]:.3f}", f"{f.leakage[0]:.2e} m³/s"
    ('1.054', '9.05e-14 m³/s')
    """
    repeats = [True, True]
    if isinstance(source, Solved):
        if pitch is not None:
            raise bad_input("pitch", "'pitch' is given beside a contact, which has its own")
        gap, size = np.where(source.touching, 0.0, source.gap), source.pitch
        repeats = [edge == "periodic" for edge in edges(source.case["contact"]["boundary"])]
    else:
        if pitch is None:
            raise bad_input("pitch", "'pitch' is missing: how far apart are the cells of the gap?")
        gap, size = matrix("gap", source), lengths("pitch", pitch)
    ends, sides, faces = options["ends"], options["sides"], options["faces"]
    if ends is not None:
        choice("ends", ends, "periodic", "reservoirs")
    if sides is not None:
        choice("sides", sides, "periodic", "closed")
    choice("faces", faces, "linear", "harmonic")
    fluid = _fluid(options["viscosity"], options["pressure"], options["outlet"])
    all_ends = [ends or ("periodic" if repeats[axis] else "reservoirs") for axis in (0, 1)]
    all_sides = [sides or ("periodic" if repeats[1 - axis] else "closed") for axis in (0, 1)]
    return GapFlow(_core.flow((gap, size), all_ends, all_sides, faces, fluid, _case.threads(options["threads"])))


def _fluid(viscosity: Any, pressure: Any, outlet: Any) -> tuple[float, float, float | None] | None:
    if viscosity is None and pressure is None and outlet is None:
        return None
    for key, value in (("viscosity", viscosity), ("pressure", pressure)):
        if value is None:
            raise bad_input(key, f"'{key}' is missing: the leakage needs 'viscosity' and 'pressure'")
    drop = quantity("pressure", pressure, "pressure", positive=False)
    if drop < 0.0:
        text = written(drop, "pressure")
        raise bad_input("pressure", f"'pressure' is {text}, expected a drop of at least 0")
    absolute = None if outlet is None else quantity("outlet", outlet, "pressure")
    return quantity("viscosity", viscosity, "viscosity"), drop, absolute
