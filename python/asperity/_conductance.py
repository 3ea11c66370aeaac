"""The thermal or electrical conductance of a contact."""

# Annotations are not postponed here: types and texts are read when the package is imported.

import math
from collections.abc import Sequence
from typing import TYPE_CHECKING, Annotated, Any, Literal, TypedDict

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _case, _core
from ._described import described
from ._keywords import takes
from ._raise import bad_input
from ._same import Comparable
from ._solved import Solved
from ._units import Pair, Quantity, choice, edges, lengths, matrix, number, quantity
from .fields import on_cells
from .keys import Boundary

if TYPE_CHECKING:
    from typing_extensions import Unpack
    from xarray import DataArray


Kind = Literal["thermal", "electrical"]
"""Whether heat or current passes."""

_UNITS = {"thermal": ("W/K", "W/(m² K)", "K/W"), "electrical": ("S", "S/m²", "Ω")}


@described
class Conductance(Comparable):
    """Conductance of a contact.

    Returned by :func:`asperity.conductance` and :meth:`Contact.conductance`.
    """

    kind: Annotated[str, "``\"thermal\"`` or ``\"electrical\"``."]
    conductance: Annotated[float | None,
        "Conductance G, at least 0, W/K or S; 0 if nothing conducts. ``None`` if the joint adds no resistance: all "
        "cells of a period touch without a film."]
    joint_conductance: Annotated[float | None,
        "Conductance of the joint alone over the area of the grid, W/(m² K) or S/m²: 1/((R - R_full) A) under a free "
        "boundary. ``None`` with the conductance, and where the two cannot be split: spots in a part of the grid, or "
        "all cells in contact."]
    resistance: Annotated[float | None, "1/G, K/W or Ω; ``None`` if there is none, and if nothing conducts."]
    full_resistance: Annotated[float | None,
        "Resistance if all cells touched without a film, K/W or Ω: the spreading from the grid into the half-spaces. "
        "``None`` under a periodic boundary, where there is none."]
    flux: Annotated[NDArray[np.float64] | None,
        "Flux of each cell per unit drop, W/(m² K) or S/m², 0 in cells that do not conduct; ``None`` with the "
        "conductance."]
    spot_share: Annotated[float, "Share of the flux through the cells in contact."]
    gas_share: Annotated[float, "Share of the flux through the gas."]
    film_share: Annotated[float,
        "Share of the resistance that the film takes. Above ½, the number given for the film decides."]
    spots: Annotated[int, "Number of spots: cells in contact that are connected over edges and corners."]
    median_cells: Annotated[float, "Median number of cells of a spot. Below 9, the cells are too coarse for the spots."]
    holm_greenwood: Annotated[float | None,
        "Resistance of the clean spots by the estimate of Holm and Greenwood, K/W or Ω; ``None`` without contact and "
        "unless the boundary is free."]
    pitch: Annotated[tuple[float, float], "Size of a cell along x and y, m."]
    iterations: Annotated[int, "Iterations of the solution."]
    residual: Annotated[float, "Largest deviation of the drop of a cell from that of the joint, as a share of it."]

    def __init__(self, kind: str, pitch: tuple[float, float], found: dict[str, Any]) -> None:
        self.kind = kind
        self.pitch = pitch
        self.spot_share, self.gas_share, self.film_share = found.pop("shares")
        vars(self).update(found)

    def __repr__(self) -> str:
        whole, per_area, _ = _UNITS[self.kind]
        spots = f"{self.spots} spot{'' if self.spots == 1 else 's'}"
        if self.conductance is None:
            return f"<Conductance: no resistance, {spots}>"
        joint = [] if self.joint_conductance is None else [f"{self.joint_conductance:.4g} {per_area}"]
        parts = [f"{self.conductance:.4g} {whole}", *joint, spots]
        if self.gas_share > 0.0:
            parts.append(f"{100.0 * self.gas_share:.3g} % through gas")
        if self.film_share > 0.0:
            parts.append(f"film {100.0 * self.film_share:.3g} % of the resistance")
        return f"<Conductance: {', '.join(parts)}>"

    def to_xarray(self) -> "DataArray":
        """Return the flux as an xarray DataArray over x and y, m; its attributes are the numbers.

        Raises
        ------
        asperity.errors.BadInput
            If the joint has no resistance, so that no drop drives a flux.
        """
        if self.flux is None:
            raise bad_input("flux", "the joint has no resistance, so that no drop drives a flux")
        array = on_cells("flux", self.flux, _UNITS[self.kind][1], self.pitch).to_xarray()
        array.attrs.update({key: value for key, value in vars(self).items() if isinstance(value, (int, float, str))})
        return array


# fmt: off
class _RequiredKeywords(TypedDict):
    conductivity: Annotated[Quantity | Sequence[Quantity],
        "Conductivity of both bodies, or of the lower and the upper one, above 0, W/(m K) or S/m. One of a pair may be ``inf``."]


class ConductanceKeywords(_RequiredKeywords, total=False):
    """Keywords of the conductance of a contact."""

    kind: Annotated[Kind, "``\"thermal\"`` (by default) or ``\"electrical\"``."]
    film: Annotated[Quantity | None,
        "Resistance of an area of the film on the spots, at least 0, m² K/W or Ω m²; none by default."]
    gas: Annotated[Quantity | None,
        "Conductivity of the gas in the gap between the bodies, above 0, W/(m K); none by default."]
    jump: Annotated[Quantity | None,
        "Temperature jump distance of the gas at both surfaces together, at least 0, m; 0 by default."]
    tolerance: Annotated[float,
        "Largest deviation of the drop of a cell from that of the joint, as a share of it; 1e-6 by default. The error of the "
        "conductance is about its square."]
    threads: Annotated[int | None, "Number of threads; one for each core by default."]


# fmt: on
@takes(ConductanceKeywords, kind="thermal", tolerance=1e-6)
def conductance(
    contact: "Solved | ArrayLike",
    *,
    pitch: "Pair | None" = None,
    boundary: "Boundary | Sequence[Boundary] | None" = None,
    gap: "ArrayLike | None" = None,
    **options: "Unpack[ConductanceKeywords]",
) -> Conductance:
    """Compute the thermal or electrical conductance of a contact.

    Heat or current passes where the bodies touch, through a film on the spots, and through gas in the gap. The bodies are
    half-spaces below their surfaces. Under a free boundary the conductance contains the spreading from the outline of the grid into
    them, which the joint conductance does not. Under a periodic boundary it is that of the joint alone.

    Parameters
    ----------
    contact : Contact or array_like
        A contact, which provides cells in contact, gap, pitch and boundary; or a matrix ``[ix, iy]`` from anywhere, such as a mask, a
        map of pressure or an image: cells above 0 touch.
    pitch : float, str or pair of them, optional
        Size of a cell along x and y, m.
    boundary : str or pair of them, optional
        The surroundings of the grid: ``"free"`` (by default) or ``"periodic"``, for both axes or for each.
    gap : array_like, optional
        Gap between the bodies, a matrix ``[ix, iy]``, m; needed for a `gas`. Only open cells count.
    **options

    Returns
    -------
    Conductance

    Raises
    ------
    asperity.errors.BadInput
        If an argument is invalid.
    asperity.errors.NotConverged
        If the tolerance is not reached.

    Examples
    --------
    A round spot on two half-spaces conducts 2κa:

    >>> import numpy as np, asperity as asp
    >>> x = 1e-6 * (np.arange(64) - 31.5)
    >>> spot = np.hypot(*np.meshgrid(x, x)) < 20e-6
    >>> found = asp.conductance(spot, pitch="1 um", conductivity="46 W/(m K)")
    >>> found.spots, f"{found.conductance / (2 * 46 * 20e-6):.3f}"
    (1, '0.997')
    """
    kind, film, gas, jump = options["kind"], options["film"], options["gas"], options["jump"]
    choice("kind", kind, *_UNITS)
    if isinstance(contact, Solved):
        for key, value in (("pitch", pitch), ("boundary", boundary), ("gap", gap)):
            if value is not None:
                raise bad_input(key, f"'{key}' is given beside a contact, which has its own")
        pitch, boundary, gap = contact.pitch, contact.case["contact"]["boundary"], contact.gap
        touching = contact.touching
    else:
        mask = matrix("contact", contact)
        if np.isnan(mask).any():
            raise bad_input("contact", "'contact' holds NaN, expected cells above 0 where the bodies touch")
        touching = mask > 0.0
    if pitch is None:
        raise bad_input("pitch", "'pitch' is missing: how large is a cell?")
    size = lengths("pitch", pitch)
    between = None if gas is None else _gas(kind, gas, jump, gap)
    if gas is None and jump is not None:
        raise bad_input("jump", "'jump' is given without 'gas'", "a jump of temperature is one between a body and a gas")
    found = _core.conductance(
        (touching, size),
        edges(boundary),
        kind,
        _conductivities(kind, options["conductivity"]),
        0.0 if film is None else quantity("film", film, f"{kind} resistance of an area", positive=False),
        between,
        matrix("gap", gap, ("contact", touching.shape)) if between is not None else None,
        number("tolerance", options["tolerance"], "a number above 0, below 1", math.ulp(0.0), math.nextafter(1.0, 0.0)),
        _case.threads(options["threads"]),
    )
    return Conductance(kind, size, found)


def _gas(kind: str, gas: Quantity, jump: Quantity | None, gap: Any) -> tuple[float, float]:
    if kind != "thermal":
        raise bad_input("gas", "'gas' is given with kind \"electrical\": gas conducts heat, but no current")
    if gap is None:
        raise bad_input("gap", "'gap' is missing: gas conducts across the gap between the bodies")
    distance = 0.0 if jump is None else quantity("jump", jump, "length", positive=False)
    return quantity("gas", gas, "thermal conductivity"), distance


def _conductivities(kind: str, given: Any) -> list[float]:
    one = isinstance(given, str) or np.ndim(given) == 0
    values = [given, given] if one else list(given)
    if len(values) != 2:
        raise bad_input("conductivity", f"'conductivity' has {len(values)} values, expected one or two")
    return [quantity("conductivity", value, f"{kind} conductivity", infinite=not one) for value in values]
