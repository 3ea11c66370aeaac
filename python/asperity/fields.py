"""Fields of results: arrays with unit, pitch and origin beside them."""

from __future__ import annotations

from collections.abc import Callable, Iterator, Mapping
from typing import Any

import numpy as np
from numpy.typing import NDArray

from ._optional import need
from ._same import Comparable, same
from ._show import unit_of


class Field(Comparable):
    """An array of a result, with what its numbers mean.

    Attributes
    ----------
    name : str
        Name of the field.
    values : ndarray
        The values, ``[ix, iy]`` of a field on cells; the array that is handed in, not a copy.
    unit : str
        Unit of the values, SI.
    axes : tuple of str
        Names of the axes.
    pitch : tuple of float
        Distance of neighbouring values along each axis, m.
    origin : tuple of float
        Position of the first value along each axis, m.
    """

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
        """Positions of the values along an axis, m."""
        index = self.axes.index(axis)
        count = self.values.shape[index]
        return self.origin[index] + self.pitch[index] * np.arange(count, dtype=np.float64)

    def to_xarray(self) -> Any:
        """The field as a DataArray of xarray, with its coordinates, m."""
        xarray = need("xarray", "to_xarray()")
        coordinates = {axis: (axis, self.coordinate(axis), {"units": "m"}) for axis in self.axes}
        attributes = {"units": self.unit}
        return xarray.DataArray(self.values, coordinates, self.axes, self.name, attributes)

    def plot(self, **options: Any) -> Any:
        """Draw the field with matplotlib, on the axes `ax` if given; gives the axes. Other `options` go to ``imshow``."""
        from ._plot import field

        return field(self, **options)


class Fields(Mapping[str, Field]):
    """Fields by name, each read when it is asked for first."""

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
        # What is read is kept; the files may not be there where it is taken to.
        return _known, (dict(self),)

    def __repr__(self) -> str:
        return f"<Fields: {', '.join(self._names)}>"

    def to_xarray(self) -> Any:
        """Those of the fields that share the first one's grid, as a Dataset of xarray."""
        xarray = need("xarray", "to_xarray()")
        grid = None
        arrays = {}
        for name in self._names:
            field = self[name]
            grid = grid or (field.axes, field.values.shape, field.origin)
            if grid == (field.axes, field.values.shape, field.origin):
                arrays[name] = field.to_xarray()
        return xarray.Dataset(arrays)


def _known(fields: dict[str, Field]) -> Fields:
    return Fields(list(fields), fields.__getitem__)


def of_cells(arrays: dict[str, tuple[NDArray[np.float64], str]], pitch: tuple[float, float]) -> Fields:
    """Fields on the cells of a grid, whose values stand at their centres."""
    origin = (0.5 * pitch[0], 0.5 * pitch[1])
    fields = {
        name: Field(name, values, unit, ("x", "y"), pitch, origin) for name, (values, unit) in arrays.items()
    }
    return _known(fields)


def stored(core: Any, kind: str, number: int | None) -> Fields:
    """Fields of a file of a results directory."""

    def read(name: str) -> Field:
        values, unit, axes, pitch, origin = core.read(kind, number, name)
        return Field(name, values, unit, tuple(axes), tuple(pitch), tuple(origin))

    return Fields(core.names(kind, number), read)


def table(rows: list[dict[str, Any]], columns: list[str]) -> NDArray[np.void]:
    """Records as a structured array, which has these columns at least; a number that there is not is NaN."""
    names = list(dict.fromkeys([*columns, *(name for row in rows[:1] for name in row)]))
    if rows:
        names = [name for name in names if name in rows[0]]
    kinds = []
    for name in names:
        whole = bool(rows) and all(isinstance(row.get(name), int) for row in rows)
        kinds.append((name, np.int64 if whole else np.float64))
    array = np.zeros(len(rows), dtype=kinds)
    for name in names:
        array[name] = [np.nan if row.get(name) is None else row[name] for row in rows]
    return array


def frame(table: NDArray[np.void], index: str) -> Any:
    """A structured array as a DataFrame of pandas, with its units as the attribute `units`."""
    pandas = need("pandas", "to_pandas()")
    made = pandas.DataFrame(table).set_index(index)
    made.attrs["units"] = {name: unit_of(name) for name in made.columns}
    return made
