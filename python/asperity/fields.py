"""Fields of results: arrays with their unit, pitch and origin."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
from numpy.typing import NDArray

from ._described import described
from ._optional import need
from ._same import Comparable, same

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from xarray import DataArray, Dataset


@described
class Field(Comparable):
    """An array of a result with its unit and its grid."""

    name: Annotated[str, "Name of the field."]
    values: Annotated[NDArray[np.float64], "The values; those of a field on cells are indexed ``[ix, iy]``."]
    unit: Annotated[str, "SI unit of the values."]
    axes: Annotated[tuple[str, ...], "Names of the axes."]
    pitch: Annotated[tuple[float, ...], "Distance of neighbouring values along each axis, m."]
    origin: Annotated[tuple[float, ...], "Position of the first value along each axis, m."]

    def __init__(
        self,
        name: str,
        values: NDArray[np.float64],
        unit: str,
        axes: tuple[str, ...],
        pitch: tuple[float, ...],
        origin: tuple[float, ...],
    ) -> None:
        self.name = name
        self.values = values
        self.unit = unit
        self.axes = axes
        self.pitch = pitch
        self.origin = origin

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> NDArray[Any]:
        if copy is False and dtype not in (None, self.values.dtype):
            raise ValueError("the values are float64: another type is a copy")
        return np.array(self.values, dtype=dtype) if copy or dtype else self.values

    def __repr__(self) -> str:
        shape = " × ".join(map(str, self.values.shape))
        return f"<Field {self.name}: {shape} values in {self.unit}>"

    def _repr_html_(self) -> str:
        from ._html import field

        return field(self)

    def coordinate(self, axis: str) -> NDArray[np.float64]:
        """Return the positions of the values along an axis, m."""
        index = self.axes.index(axis)
        count = self.values.shape[index]
        return self.origin[index] + self.pitch[index] * np.arange(count, dtype=np.float64)

    def to_xarray(self) -> DataArray:
        """Return the field as an xarray DataArray with its unit and its coordinates, m."""
        xarray = need("xarray", "to_xarray()")
        coordinates = {axis: (axis, self.coordinate(axis), {"units": "m"}) for axis in self.axes}
        attributes = {"units": self.unit}
        array: DataArray = xarray.DataArray(self.values, coordinates, self.axes, self.name, attributes)
        return array

    def plot(self, *, ax: Axes | None = None, **options: Any) -> Axes:
        """Draw the field with matplotlib: a map, a section, or a curve over the depth.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Axes to draw on; new ones by default.
        **options
            Passed on to ``Axes.imshow``, or to ``Axes.plot`` for a curve.
        """
        from ._plot import field

        return field(self, ax, **options)


class Fields(Mapping[str, Field]):
    """Fields by name. Each is read on first access."""

    def __init__(self, names: list[str], read: Callable[[str], Field]) -> None:
        self._names = names
        self._read = read
        self._known: dict[str, Field] = {}

    def __getitem__(self, name: str) -> Field:
        if name not in self._known:
            if name not in self._names:
                raise KeyError(f"no field {name!r}, there are {', '.join(self._names)}")
            self._known[name] = self._read(name)
        return self._known[name]

    def __iter__(self) -> Iterator[str]:
        return iter(self._names)

    def __len__(self) -> int:
        return len(self._names)

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Fields) and same(dict(self), dict(other))

    __hash__ = None  # type: ignore[assignment]

    def __reduce__(self) -> tuple[Any, ...]:
        # All fields are read: the files may be missing where it is unpickled.
        return _known, (dict(self),)

    def __repr__(self) -> str:
        return f"<Fields: {', '.join(self._names)}>"

    def to_xarray(self) -> Dataset:
        """Return the fields on the grid of the first one as an xarray Dataset."""
        xarray = need("xarray", "to_xarray()")
        grid = None
        arrays = {}
        for name in self._names:
            field = self[name]
            grid = grid or (field.axes, field.values.shape, field.origin)
            if grid == (field.axes, field.values.shape, field.origin):
                arrays[name] = field.to_xarray()
        dataset: Dataset = xarray.Dataset(arrays)
        return dataset


def _known(fields: dict[str, Field]) -> Fields:
    return Fields(list(fields), fields.__getitem__)


def on_cells(name: str, values: NDArray[np.float64], unit: str, pitch: tuple[float, float]) -> Field:
    """Makes a field of an array on the cells of a grid. The values belong to the centres of the cells."""
    return Field(name, values, unit, ("x", "y"), pitch, (0.5 * pitch[0], 0.5 * pitch[1]))


def of_cells(arrays: dict[str, tuple[NDArray[np.float64], str]], pitch: tuple[float, float]) -> Fields:
    """Makes fields of arrays on the cells of a grid."""
    return _known({name: on_cells(name, values, unit, pitch) for name, (values, unit) in arrays.items()})


def stored(core: Any, kind: str, number: int | None) -> Fields:
    """Opens the fields of a file of a results directory."""

    def read(name: str) -> Field:
        values, unit, axes, pitch, origin = core.read(kind, number, name)
        return Field(name, values, unit, tuple(axes), tuple(pitch), tuple(origin))

    return Fields(core.names(kind, number), read)
