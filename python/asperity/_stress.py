"""The stress below a surface."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from functools import cached_property
from typing import TYPE_CHECKING, Annotated, Any, Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _case, _core
from ._contact import Contact
from ._described import described
from ._optional import need
from ._raise import bad_input
from ._same import Cached
from ._units import Pair, Quantity, choice, edges, lengths, matrix, quantity
from .keys import Boundary
from .material import Material, _poisson

if TYPE_CHECKING:
    from xarray import Dataset

COMPONENTS = ("xx", "yy", "zz", "yz", "xz", "xy")
"""The components in the order of their storage."""


@described
class Extreme(NamedTuple):
    """The largest value of a stress and its position."""

    value: Annotated[float, "The value, Pa."]
    position: Annotated[tuple[float, float, float], "x and y of the centre of the cell, and the depth, m."]
    cell: Annotated[tuple[int, int], "Index ``(ix, iy)`` of the cell."]


def _component(name: str, text: str) -> Any:
    """Declares the property of a component, with its docstring."""
    return property(lambda stress: stress[name], doc=text)


class Stress(Cached):
    """Stress tensors, positive in tension, at any number of points; z points into the body.

    Parameters
    ----------
    xx, yy, zz, yz, xz, xy : float or array_like
        The components, all of one shape, Pa.

    Raises
    ------
    asperity.errors.CaseError
        If their shapes differ.

    Examples
    --------
    >>> import asperity as asp
    >>> asp.Stress(100e6, 0.0, 0.0, 0.0, 0.0, 0.0).von_mises
    100000000.0
    """

    def __init__(
        self, xx: ArrayLike, yy: ArrayLike, zz: ArrayLike, yz: ArrayLike, xz: ArrayLike, xy: ArrayLike
    ) -> None:
        parts = [np.array(part, dtype=np.float64) for part in (xx, yy, zz, yz, xz, xy)]
        for name, part in zip(COMPONENTS, parts, strict=True):
            if part.shape != parts[0].shape:
                message = f"'{name}' has the shape {part.shape}, expected that of 'xx', {parts[0].shape}"
                raise bad_input(name, message)
        self._parts = parts

    def _compared(self) -> dict[str, Any]:
        return {"parts": self._parts}

    def __repr__(self) -> str:
        if self.shape:
            return f"<{type(self).__name__}: {' × '.join(map(str, self.shape))} points>"
        return f"Stress({', '.join(f'{name}={getattr(self, name)!r}' for name in COMPONENTS)})"

    @property
    def shape(self) -> tuple[int, ...]:
        """Shape of each component."""
        return self._parts[0].shape

    def __getitem__(self, component: str) -> Any:
        """A component by its name."""
        if component not in COMPONENTS:
            raise KeyError(f"no component {component!r}, there are {', '.join(COMPONENTS)}")
        part = self._parts[COMPONENTS.index(component)]
        return part if self.shape else float(part)

    xx = _component("xx", "Normal stress along x, Pa.")
    yy = _component("yy", "Normal stress along y, Pa.")
    zz = _component("zz", "Normal stress along z, Pa.")
    yz = _component("yz", "Shear stress in the y–z plane, Pa.")
    xz = _component("xz", "Shear stress in the x–z plane, Pa.")
    xy = _component("xy", "Shear stress in the x–y plane, Pa.")

    @cached_property
    def von_mises(self) -> Any:
        """Von Mises equivalent stress, Pa. Yielding begins where it reaches the yield stress in tension."""
        return self._invariant("von_mises", ())

    @cached_property
    def max_shear(self) -> Any:
        """Largest shear stress on any plane (Tresca), ½(σ₁ − σ₃), Pa."""
        return self._invariant("max_shear", ())

    @cached_property
    def principal(self) -> NDArray[np.float64]:
        """Principal stresses σ₁ ≥ σ₂ ≥ σ₃, Pa. The first index selects the stress, the others the point."""
        return np.asarray(self._invariant("principal", (3,)))

    def _invariant(self, which: str, leading: tuple[int, ...]) -> Any:
        values = _core.invariants(which, [np.ravel(part) for part in self._parts])
        shape = leading + self.shape
        return values.reshape(shape) if shape else float(values[0])


@described
class SubsurfaceStress(Stress):
    """The stress in a body on planes parallel to its surface; components are arrays ``[iz, ix, iy]``.

    Returned by :func:`asperity.stress`.
    """

    depths: Annotated[NDArray[np.float64], "Depths of the planes, m."]
    pitch: Annotated[tuple[float, float], "Size of a cell along x and y, m."]
    body: Annotated[str, "``\"lower\"`` or ``\"upper\"``."]

    def __init__(self, given: Any, depths: list[float], threads: int) -> None:
        super().__init__(*_core.stress(given, depths, threads))
        self.depths = np.array(depths)
        self.pitch = given[0][1]
        self.body = "upper" if given[4] else "lower"
        self._given = given

    def _compared(self) -> dict[str, Any]:
        return {"parts": self._parts, "depths": self.depths, "pitch": self.pitch, "body": self.body}

    @cached_property
    def _extremes(self) -> tuple[Extreme, Extreme]:
        von_mises, shear = (
            Extreme(value, ((cell[0] + 0.5) * self.pitch[0], (cell[1] + 0.5) * self.pitch[1], depth), (cell[0], cell[1]))
            for value, cell, depth in _core.most_stressed(self._given, self.depths.tolist(), 0)
        )
        return von_mises, shear

    @property
    def most_stressed(self) -> Extreme:
        """The largest von Mises stress and its position.

        The search uses a few more planes next to the most stressed point, so that its depth is accurate to about a hundredth of the
        distance of the planes.
        """
        return self._extremes[0]

    @property
    def most_sheared(self) -> Extreme:
        """The largest shear stress on any plane and its position, found like :attr:`most_stressed`."""
        return self._extremes[1]

    def to_xarray(self) -> Dataset:
        """Return the components, the von Mises stress and the largest shear as an xarray Dataset over z, x and y, m."""
        arrays: Mapping[str, Any] = {**{name: self[name] for name in COMPONENTS}, "von_mises": self.von_mises}
        return _dataset({**arrays, "max_shear": self.max_shear}, self.depths, self.pitch)


def _dataset(arrays: Mapping[str, Any], depths: NDArray[np.float64], pitch: tuple[float, float]) -> Dataset:
    """Return arrays ``[iz, ix, iy]``, Pa, as an xarray Dataset over z, x and y, m."""
    xarray = need("xarray", "to_xarray()")
    _, nx, ny = next(iter(arrays.values())).shape
    x, y = (pitch[axis] * (np.arange(n) + 0.5) for axis, n in enumerate((nx, ny)))
    coordinates = {name: (name, at, {"units": "m"}) for name, at in (("z", depths), ("x", x), ("y", y))}
    dataset: Dataset = xarray.Dataset(
        {name: (("z", "x", "y"), array, {"units": "Pa"}) for name, array in arrays.items()}, coordinates
    )
    return dataset


def stress(
    source: Contact | ArrayLike,
    depths: Quantity | Sequence[Quantity] | NDArray[np.float64],
    *,
    body: Literal["lower", "upper"] = "lower",
    poisson: float | None = None,
    material: Material | None = None,
    boundary: Boundary | Sequence[Boundary] | None = None,
    shear: Sequence[ArrayLike | None] | None = None,
    pitch: Pair | None = None,
    threads: int | None = None,
) -> SubsurfaceStress:
    """Compute the stress below the surface of a body under given tractions.

    The stress is exact to round-off for tractions that are uniform in each cell (free), or for the harmonics of the values at the
    cells (periodic). Under the mean pressure of a periodic contact the body cannot expand laterally.

    Parameters
    ----------
    source : Contact or array_like
        A contact, which provides tractions, pitch, boundary and Poisson's ratio; or the pressure on each cell, a matrix
        ``[ix, iy]``, Pa.
    depths : float, str or sequence of them
        Depths of the planes below the surface, ascending, at least 0, m; at 0 the limit from within.
    body : str
        ``"lower"`` or ``"upper"``. z points into the body, x and y are those of the contact.
    poisson : float, optional
        Poisson's ratio of the body, 0 to 0.5. Give it or a `material`.
    material : Material, optional
        Material of the body, with its layers.
    boundary : str or pair of str, optional
        The surroundings of the grid, along x and y if two are given: ``"free"`` (by default) or ``"periodic"``.
    shear : pair of array_like, optional
        Shear tractions along +x and +y on the lower body, Pa, matrices of the same shape; ``None`` for none.
    pitch : float, str or pair of them, optional
        Size of a cell along x and y, m.
    threads : int, optional
        Number of threads; one for each core by default.

    Returns
    -------
    SubsurfaceStress

    Raises
    ------
    asperity.errors.BadInput
        If an argument is invalid.
    asperity.errors.Memory
        If the planes need more memory than is available.
    KeyboardInterrupt
        At Ctrl-C, between two planes.

    Examples
    --------
    >>> import numpy as np, asperity as asp
    >>> ball = asp.reference.HertzSphere(1e-3, 115e9, 1.0)
    >>> x = 1e-6 * (np.arange(65) - 32)
    >>> pressure = ball.pressure(np.hypot(*np.meshgrid(x, x)))
    >>> s = asp.stress(pressure, np.linspace(0.0, 12e-6, 4), poisson=0.3, pitch=1e-6)
    >>> s.most_stressed.cell, f"{s.most_stressed.value / ball.peak_pressure():.2f}"
    ((32, 32), '0.62')
    """
    choice("body", body, "lower", "upper")
    if isinstance(source, Contact):
        for key, value in (
            ("poisson", poisson), ("material", material), ("boundary", boundary), ("shear", shear), ("pitch", pitch),
        ):  # fmt: skip
            if value is not None:
                raise bad_input(key, f"'{key}' is given beside a contact, which has its own")
        given = _of_contact(source, body)
    else:
        given = _of_tractions(source, shear, pitch, boundary, _constants(poisson, material), body)
    return SubsurfaceStress(given, _depths(depths), _case.threads(threads))


def _of_contact(contact: Contact, body: str) -> Any:
    table = contact.case[body]
    layers = table.get("layers", [table["coating"]] if "coating" in table else [])
    constants = float(table["young"]), table["poisson"], [[layer[key] for key in ("thickness", "young", "poisson")] for layer in layers]
    found = contact.fields
    shear = [found[name].values if name in found else None for name in ("traction_x", "traction_y")]
    boundary = contact.case["contact"]["boundary"]
    return _of_tractions(contact.pressure, shear, contact.pitch, boundary, constants, body)


def _of_tractions(pressure: Any, shear: Any, pitch: Any, boundary: Any, constants: Any, body: str) -> Any:
    if pitch is None:
        raise bad_input("pitch", "'pitch' is missing: how far apart are the tractions?")
    normal = _finite("pressure", matrix("pressure", pressure))
    parts: list[Any] = [None, None] if shear is None else list(shear)
    if len(parts) != 2:
        raise bad_input("shear", f"'shear' has {len(parts)} entries, expected the traction along x and that along y")
    along = [None if part is None else _finite("shear", matrix("shear", part, ("pressure", normal.shape))) for part in parts]
    return (normal, lengths("pitch", pitch)), along, edges(boundary), constants, body == "upper"


def _finite(key: str, found: NDArray[np.float64]) -> NDArray[np.float64]:
    if not np.isfinite(found).all():
        raise bad_input(key, f"'{key}' holds a number that is not finite")
    return found


def _constants(poisson: float | None, material: Material | None) -> tuple[float, float, list[list[float]]]:
    if (poisson is None) == (material is None):
        raise bad_input("poisson", "give 'poisson' or 'material', one of them")
    # The stress in a body without layers does not depend on its modulus.
    return (1.0, _poisson(poisson), []) if material is None else material._constants()


def _depths(depths: Any) -> list[float]:
    one = isinstance(depths, str) or np.ndim(depths) == 0
    found = [quantity("depths", depth, "length", positive=False) for depth in ([depths] if one else depths)]
    if not found or found[0] < 0.0 or any(b <= a for a, b in zip(found, found[1:])):
        raise bad_input("depths", f"'depths' is {depths!r}, expected lengths of at least 0 that ascend")
    return found
