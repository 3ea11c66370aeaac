"""Tables of results: a record for each point, increment, position or pass."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import NDArray

from ._optional import need
from ._show import largest, scale, unit_of
from ._units import choice

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from pandas import DataFrame
    from xarray import Dataset

Units = Literal["si", "display"]
"""Units of an exported table: SI, or a suitable prefix for each column, written in its name."""

_COUNTERS = ("pass", "step", "point", "increment", "update")
"""Columns that number the records."""


class Table(np.ndarray[Any, np.dtype[np.void]]):
    """A table of results: a structured NumPy array that knows its units.

    ``table["load"]`` is a column, ``table[0]`` is a record, and ``table.dtype.names`` lists the columns. All numbers are in SI.

    Examples
    --------
    >>> import asperity as asp
    >>> steel = asp.Material(young="210 GPa", poisson=0.3)
    >>> ball, plane = asp.form.sphere("10 mm"), asp.form.flat((32, 32), pitch="10 um")
    >>> sweep = asp.contact(plane, ball, steel, steel, loads=["1 N", "2 N"], progress=False).sweep
    >>> sweep.units["contact_area"], len(sweep["contact_area"])
    ('m²', 2)
    """

    def __getitem__(self, key: Any) -> Any:
        found = super().__getitem__(key)
        # A column is a plain array of numbers.
        return found.view(np.ndarray) if isinstance(found, Table) and found.dtype.names is None else found

    @property
    def units(self) -> dict[str, str]:
        """SI unit of each column; ``"1"`` for a pure number."""
        return {name: unit_of(name) for name in self.dtype.names or ()}

    @property
    def _index(self) -> list[str]:
        return [name for name in _COUNTERS if name in (self.dtype.names or ())]

    def to_pandas(self, units: Units = "si") -> DataFrame:
        """Return the table as a pandas DataFrame, with its units in the attribute `units`.

        Parameters
        ----------
        units : {"si", "display"}
            Units of the numbers. ``"display"`` gives each column a suitable prefix and writes the unit into its name, such as
            ``"approach (nm)"``.
        """
        return frame(self, self._index, self.units, units)

    def to_xarray(self) -> Dataset:
        """Return the columns as an xarray Dataset over the number of the record, such as `point` or `increment`.

        Each column has its SI unit in the attribute `units`.
        """
        xarray = need("xarray", "to_xarray()")
        index = self._index
        dimension = index[0] if len(index) == 1 else "row"
        columns = {name: (dimension, self[name], {"units": unit}) for name, unit in self.units.items()}
        coordinates = {name: columns.pop(name) for name in index}
        dataset: Dataset = xarray.Dataset(columns, coordinates)
        return dataset

    def plot(self, quantity: str, x: str | None = None, *, ax: Axes | None = None, **options: Any) -> Axes:
        """Draw a column over another one with matplotlib.

        Parameters
        ----------
        quantity : str
            The column to draw.
        x : str, optional
            The column along the x axis. By default the load of a sweep (or the creepage, if the load is constant), the offset
            of the positions of a motion, the distance of sliding in place, and else the number of the record.
        ax : matplotlib.axes.Axes, optional
            Axes to draw on; new ones by default.
        **options
            Passed on to ``Axes.plot``.
        """
        from ._plot import curve

        return curve(self, quantity, x, ax, **options)


def records(rows: Sequence[Mapping[str, Any]], columns: Sequence[str]) -> Table:
    """Makes a table of `rows`. Without rows it has these `columns`. A missing number is NaN."""
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
    return array.view(Table)


def by_word(rows: Sequence[Mapping[str, Any]], name: str) -> dict[str, Table]:
    """Makes a table of the rows with each word of a column, without this column."""
    found: dict[str, list[dict[str, Any]]] = {}
    for row in rows:
        found.setdefault(row[name], []).append({key: value for key, value in row.items() if key != name})
    return {word: records(some, []) for word, some in sorted(found.items())}


def frame(table: NDArray[np.void], index: list[str], units: Mapping[str, str], shown: Units) -> DataFrame:
    """Makes a DataFrame of a structured array with these SI `units`, in SI or in units to display."""
    choice("units", shown, "si", "display")
    pandas = need("pandas", "to_pandas()")
    columns: dict[str, NDArray[Any]] = {}
    told: dict[str, str] = {}
    for name in table.dtype.names or ():
        values, unit, label = table[name], units[name], name
        if shown == "display" and name not in index and unit not in ("", "1"):
            factor, unit = scale(unit, largest(values))
            values, label = factor * values, f"{name} ({unit})"
        columns[label] = values
        if name not in index:
            told[label] = unit
    made: DataFrame = pandas.DataFrame(columns)
    if index:
        made = made.set_index(index if len(index) > 1 else index[0])
    made.attrs["units"] = told
    return made
