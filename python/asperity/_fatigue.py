"""Fatigue below a surface that contacts pass over."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING, Annotated, Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _case, _core
from ._described import described
from ._raise import bad_input
from ._same import Comparable
from ._stress import Extreme, _constants, _dataset, _depths, _finite
from ._units import Pair, Quantity, choice, edges, lengths, quantity
from .keys import Boundary
from .material import Material

if TYPE_CHECKING:
    from xarray import Dataset


@described
class Fatigue(Comparable):
    """What the points below a surface see in a pass that repeats; arrays ``[iz, ix, iy]``. Returned by :func:`asperity.fatigue`."""

    depths: Annotated[NDArray[np.float64], "Depths of the planes, m."]
    pitch: Annotated[tuple[float, float], "Size of a cell along x and y, m."]
    f: Annotated[NDArray[np.float64],
        "Dang Van's f: the largest τ + a σh in the pass, Pa. Nothing fails in the end where it is below the limit."]
    radius: Annotated[NDArray[np.float64], "Radius of the smallest ball around the deviators in five dimensions, Pa."]
    shear_amplitude: Annotated[NDArray[np.float64], "Half the range of σxz in the pass, Pa."]
    weight: Annotated[float, "Weight a of the hydrostatic stress, 3τ₋₁/σ₋₁ − 3/2."]
    limit: Annotated[float, "Limit b of f, Pa: that of alternating torsion τ₋₁."]

    def __init__(self, fields: list[NDArray[np.float64]], criterion: tuple[float, float], depths: list[float], pitch: Any) -> None:
        self.f, self.radius, self.shear_amplitude = fields
        self.weight, self.limit = criterion
        self.depths = np.array(depths)
        self.pitch = pitch

    def __repr__(self) -> str:
        most = self.most
        return f"<Fatigue: f/b {most.value / self.limit:.4g} at a depth of {most.position[2]:.4g} m>"

    @property
    def over_limit(self) -> NDArray[np.float64]:
        """f over its limit b: where it is below 1, nothing fails in the end."""
        return self.f / self.limit

    @property
    def most(self) -> Extreme:
        """The largest f, Pa, and its place."""
        iz, ix, iy = np.unravel_index(int(self.f.argmax()), self.f.shape)
        at = ((ix + 0.5) * self.pitch[0], (iy + 0.5) * self.pitch[1], self.depths[iz])
        return Extreme(float(self.f.max()), (float(at[0]), float(at[1]), float(at[2])), (int(ix), int(iy)))

    def damage(self, exponent: float, cycles: float, *, endurance: bool = False) -> NDArray[np.float64]:
        """Damage of a pass, (f/b)^m/N₀, which adds up to 1 (Basquin, Miner).

        Parameters
        ----------
        exponent : float
            Exponent m, above 0.
        cycles : float
            Cycles N₀ at the limit, above 0.
        endurance : bool
            Whether there is no damage below the limit.
        """
        return self._damage(exponent, cycles, endurance)[0]

    def critical_wear(self, exponent: float, cycles: float, *, endurance: bool = False) -> NDArray[np.float64]:
        """Wear of a pass below which a column pits, m, ``[ix, iy]``: the integral of the :meth:`damage` over the depth.

        A column that loses more than this in each pass wears away before it fails.
        """
        return self._damage(exponent, cycles, endurance)[1]

    def _damage(self, exponent: float, cycles: float, endurance: bool) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        law = (float(exponent), float(cycles), bool(endurance))
        damage, wear = _core.damage(self.over_limit, self.depths.tolist(), law)
        return damage, wear

    def to_xarray(self) -> Dataset:
        """Return f, radius and shear amplitude as an xarray Dataset over z, x and y, m."""
        arrays = {"f": self.f, "radius": self.radius, "shear_amplitude": self.shear_amplitude}
        return _dataset(arrays, self.depths, self.pitch)


def fatigue(
    pressures: ArrayLike,
    depths: Quantity | Sequence[Quantity] | NDArray[np.float64],
    *,
    pitch: Pair,
    torsion: Quantity,
    tension: Quantity,
    poisson: float | None = None,
    material: Material | None = None,
    friction: float | Sequence[float] | NDArray[np.float64] = 0.0,
    boundary: Boundary | Sequence[Boundary] | None = "periodic",
    body: Literal["lower", "upper"] = "lower",
    threads: int | None = None,
) -> Fatigue:
    """Compute Dang Van's criterion of fatigue below a surface, from the pressures of a pass that repeats.

    The pressures may come from anywhere. They are those on the cells of the body, which stay where they are while the contact passes over
    them: at each position a matrix on the same grid.

    Parameters
    ----------
    pressures : array_like
        Pressure at each position of the pass on each cell of the body, ``[position, ix, iy]``, Pa.
    depths : float, str or sequence of them
        Depths below the surface, ascending, at least 0, m.
    pitch : float, str or pair of them
        Size of a cell along x and y, m.
    torsion, tension : float or str
        Limits of the material in alternating torsion τ₋₁ and tension σ₋₁, amplitudes, Pa; the tension is at most twice the torsion.
    poisson : float, optional
        Poisson's ratio of the body, 0 to 0.5. Give it or a `material`.
    material : Material, optional
        Material of the body, with its layers. The limits are those of the material at the depths that are asked for; at an interface
        that is the one below.
    friction : float or sequence of float
        Shear traction along +x on the lower body over the pressure: one number, or one for each position.
    boundary : str or pair of str
        The surroundings of the grid, along x and y if two are given: ``"periodic"`` (by default) or ``"free"``.
    body : str
        ``"lower"`` or ``"upper"``; the shear on the upper body is the reverse.
    threads : int, optional
        Number of threads; one for each core by default.

    Returns
    -------
    Fatigue

    Raises
    ------
    asperity.errors.BadInput
        If an argument is invalid.
    KeyboardInterrupt
        At Ctrl-C.

    Examples
    --------
    A ridge of pressure that passes over a period:

    >>> import numpy as np, asperity as asp
    >>> pressures = 1e9 * np.eye(32)[:, :, None] * np.ones(2)
    >>> found = asp.fatigue(pressures, ["0.5 um", "2 um"], pitch="1 um", torsion="350 MPa", tension="600 MPa", poisson=0.3)
    >>> found.f.shape, bool(found.f[0].max() > found.f[1].max())
    ((2, 32, 2), True)
    """
    choice("body", body, "lower", "upper")
    try:
        found = np.asarray(pressures, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise bad_input("pressures", f"'pressures' are no numbers: {error}") from error
    if found.ndim != 3 or 0 in found.shape:
        raise bad_input("pressures", f"'pressures' has the shape {found.shape}, expected matrices [position, ix, iy]")
    _finite("pressures", found)
    ratio = np.asarray(friction, dtype=np.float64)
    if ratio.ndim > 1 or ratio.size not in (1, len(found)) or not np.isfinite(ratio).all():
        raise bad_input("friction", f"'friction' has the shape {ratio.shape}, expected a number, or one for each of {len(found)} positions")
    ratio = np.broadcast_to(ratio, len(found)) * (-1.0 if body == "upper" else 1.0)
    planes = _depths(depths)
    given = (found, lengths("pitch", pitch), ratio.tolist(), edges(boundary), _constants(poisson, material))
    limits = (quantity("torsion", torsion, "pressure"), quantity("tension", tension, "pressure"))
    fields, criterion = _core.fatigue(given, limits, planes, _case.threads(threads))
    return Fatigue(fields, (criterion[0], criterion[1]), planes, given[1])
