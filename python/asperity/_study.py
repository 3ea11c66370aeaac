"""Studies: many variants of one case."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
from numpy.typing import NDArray

from . import _case, _core
from ._contact import Contact
from ._described import described
from ._keywords import Tasks, takes
from ._optional import need
from ._progress import Teller
from ._raise import bad_input, exception, warn
from ._run import Run, _path, open
from ._same import Comparable
from ._show import unit_of
from ._table import Units, frame
from ._units import path
from .errors import FailedCases, NoResults, NotResumable

if TYPE_CHECKING:
    import pathlib

    from matplotlib.axes import Axes
    from pandas import DataFrame
    from typing_extensions import Unpack
    from xarray import Dataset

_State = NDArray[np.str_]


@described
class Study(Comparable):
    """A study: many variants of one case.

    Each case has a number, from 1. The state of the cases is read from the files on access, because other processes may work on the
    study at the same time.

    Parameters
    ----------
    file : path
        The study file, as for ``asperity study``.
    out : path, optional
        Directory of the study. By default it has the name of the file without its extension.

    Raises
    ------
    asperity.errors.CaseError
        If the study file, its table or its base has a mistake. The exception has its `key`, `line` and `column`. Every value of
        every axis is checked.
    """

    file: Annotated["pathlib.Path", "The study file."]
    directory: Annotated["pathlib.Path", "Directory of the study, made by :meth:`run`."]
    title: Annotated[str, "Title of the study, by default the name of the file."]
    axes: Annotated[dict[str, NDArray[Any]], "Values of each axis by its key: numbers in SI, or texts."]
    units: Annotated[dict[str, str], "SI unit of each axis; empty for pure numbers and texts."]

    def __init__(self, file: str | os.PathLike[str], out: str | os.PathLike[str] | None = None) -> None:
        self.file = _path(path("file", file))
        self.directory = self.file.with_suffix("") if out is None else _path(path("out", out))
        self._core = _core.Study(os.fspath(self.file), os.fspath(self.directory))
        self.title = self._core.title()
        axes = self._core.axes()
        self.axes = {key: np.array(values) for key, _, values in axes}
        self.units = {key: unit for key, unit, _ in axes}

    def _compared(self) -> dict[str, Any]:
        return {"plan": self.plan, "table": self.table}

    def __reduce__(self) -> tuple[Any, ...]:
        return Study, (self.file, self.directory)

    def __len__(self) -> int:
        """Number of cases."""
        return len(self._core.indices())

    def __repr__(self) -> str:
        return f"<Study {self.title}: {self._told()}, in {self.directory}>"

    def _repr_html_(self) -> str:
        from ._html import study

        return study(f"Study {self.title}: {self._told()}", self.axes, self.units, self.failures)

    def _told(self) -> str:
        states = self.states
        done, failed = (int((states == state).sum()) for state in ("done", "failed"))
        return f"{done} of {len(states)} cases are done" + (f", {failed} have failed" if failed else "")

    @property
    def plan(self) -> NDArray[np.void]:
        """A record for each case: its number `case`, and its value on each axis, SI."""
        indices = self._core.indices()
        columns: dict[str, NDArray[Any]] = {"case": np.arange(1, len(indices) + 1, dtype=np.int64)}
        for n, (key, values) in enumerate(self.axes.items()):
            columns[key] = values[indices[:, n]]
        return _records(columns)

    @property
    def states(self) -> _State:
        """State of each case: ``"done"``, ``"failed"``, ``"running"`` in some process, or ``"open"``."""
        return np.array([state for state, _ in self._core.states()])

    @property
    def left(self) -> NDArray[np.int64]:
        """Numbers of the cases that are neither done nor failed."""
        states = self.states
        return np.flatnonzero((states == "open") | (states == "running")) + 1

    @property
    def failures(self) -> dict[int, str]:
        """Reasons why cases failed, by the number of the case."""
        return {n: message for n, (_, message) in enumerate(self._core.states(), 1) if message is not None}

    @property
    def table(self) -> NDArray[np.void]:
        """A record for each finished case, or for each point of its sweep, with the columns of ``table.csv``.

        The columns are `case`, the axes, the value of the point of a sweep such as ``"contact.load"``, the numbers of the results,
        `warnings`, `state` and `message`. Numbers are in SI, and NaN if a case does not have them. Volumes, work and other amounts of a
        motion are those of all its passes; a value such as the largest pressure is that of the last pass. `warnings` is the number of
        warnings, `state` is ``"done"`` or ``"failed"``, and `message` is the reason of a failure.
        """
        return self._records(self._core.table())

    @takes(Tasks)
    def run(self, **options: Unpack[Tasks]) -> None:
        """Compute the remaining cases, as the command ``asperity study`` does.

        The process that finishes the last case writes the table and the page. A case that cannot be computed has a row in the
        :attr:`table` with its message, and the other cases are computed. A study that was stopped or killed continues where it was.
        Any number of processes may work on one study.

        Parameters
        ----------
        **options

        Raises
        ------
        asperity.errors.NotThisStudy
            If the directory contains another study, or something else.
        asperity.errors.FileProblem
            If the study cannot be written.
        KeyboardInterrupt
            At Ctrl-C. Finished cases stay.

        Warns
        -----
        asperity.errors.FailedCases
            If cases of the study have failed.
        """
        count = _case.threads(options["threads"])
        with Teller(options["progress"]) as tell:
            failed = self._core.run(_share(options["task"]), bool(options["retry"]), count, tell)
        if failed:
            case, message = failed[0]
            warn([f"{len(failed)} of {len(self)} cases have failed, the first is case {case}: {message}"], FailedCases)

    def collect(self) -> NDArray[np.void]:
        """Write ``table.csv`` and ``study.html`` of the finished cases, and return the :attr:`table`.

        Raises
        ------
        asperity.errors.NotThisStudy
            If the study has not been started.
        """
        return self._records(self._core.collect())

    def open(self, case: int) -> Run | Contact:
        """Open the results of a case, counted from 1, as :func:`open` does.

        Raises
        ------
        asperity.errors.NoResults
            If the case is not done.
        """
        if not 1 <= case <= len(self):
            raise bad_input("case", f"'case' is {case}, expected a case from 1 to {len(self)}")
        directory = self.directory / "cases" / f"{case:04}"
        try:
            return open(directory)
        except (NoResults, NotResumable):
            failure = self.failures.get(case)
            if failure is None:
                raise
        raise exception("NoResults", f"case {case} failed: {failure}", {"path": directory}, "retry=True computes it again")

    @property
    def table_units(self) -> dict[str, str]:
        """SI unit of each column of the :attr:`table`; ``"1"`` for a pure number, empty for a text."""
        collected = self._core.table()
        units = {name: unit_of(name) for name in self._records(collected).dtype.names or ()}
        for key, values in self._table_axes.items():
            unit = self.units.get(key, collected[1][1] if collected and collected[1] else "")
            units[key] = unit or ("1" if values.dtype.kind in "iuf" else "")
        return units

    @property
    def _table_axes(self) -> dict[str, NDArray[Any]]:
        """The axes, and that of the points of sweeps."""
        collected = self._core.table()
        points = collected[1] if collected else None
        return self.axes if points is None else {**self.axes, points[0]: np.array(points[2])}

    def to_pandas(self, units: Units = "si") -> DataFrame:
        """Return the :attr:`table` as a pandas DataFrame over `case`, and over `point` of sweeps, with its units in the attribute `units`.

        Parameters
        ----------
        units : {"si", "display"}
            Units of the numbers. ``"display"`` gives each column a suitable prefix and writes the unit into its name, such as
            ``"approach (nm)"``. Use it to print a table: in SI, pandas prints small numbers as 0.0.
        """
        collected = self._core.table()
        counters = ["case", "point"] if collected and collected[1] else ["case"]
        return frame(self._records(collected), counters, self.table_units, units)

    def to_xarray(self) -> Dataset:
        """Return the :attr:`table` as an xarray Dataset, with the units in the attribute `units` of each variable.

        If the plan has one case for each combination of values, the axes are the dimensions. Otherwise the dimension is `case`, and
        the axes are coordinates. The points of sweeps are one more dimension. Numbers of unfinished cases are NaN.
        """
        xarray = need("xarray", "to_xarray()")
        collected = self._core.table()
        table, plan, units = self._records(collected), self.plan, self.table_units
        indices = np.asarray(self._core.indices())
        shape = tuple(len(values) for values in self.axes.values())
        places = np.ravel_multi_index(tuple(indices.T), shape)
        is_grid = len(places) == np.prod(shape) == len(set(places.tolist()))
        points = collected[1] if collected else None
        # The points of sweeps; a case that failed has none.
        over = {} if points is None else {points[0]: np.array(points[2])}
        at = np.array([-1 if index is None else index for index in points[3]] if points else [], dtype=np.int64)
        inner = tuple(len(values) for values in over.values())

        def spread(values: NDArray[Any]) -> tuple[Any, NDArray[Any]]:
            more = tuple(over)[: values.ndim - 1]
            if is_grid:
                return (*self.axes, *more), values[np.argsort(places)].reshape(shape + values.shape[1:])
            return ("case", *more), values

        variables: dict[str, Any] = {"case": plan["case"], "state": self.states}
        for name in table.dtype.names or ():
            if name not in self.axes and name not in over and name not in variables:
                values = table[name]
                size = (len(plan), *inner)
                whole = np.full(size, np.nan) if values.dtype.kind == "f" else np.zeros(size, values.dtype)
                if over:
                    rows = at >= 0
                    whole[table["case"][rows] - 1, at[rows]] = values[rows]
                else:
                    whole[table["case"] - 1] = values
                variables[name] = whole
        coordinates = {
            key: (key if is_grid else "case", values if is_grid else plan[key], {"units": units[key]})
            for key, values in self.axes.items()
        }
        coordinates.update({key: (key, values, {"units": units[key]}) for key, values in over.items()})
        dataset: Dataset = xarray.Dataset(
            {name: (*spread(values), {"units": units[name]}) for name, values in variables.items()},
            coordinates,
            {"title": self.title},
        )
        return dataset

    def plot(
        self, quantity: str, x: str | None = None, color: str | None = None, *, ax: Axes | None = None, **options: Any
    ) -> Axes:
        """Draw a column of the :attr:`table` with matplotlib: a point for each case, and a line through the means.

        Parameters
        ----------
        quantity : str
            The column to draw, such as ``"contact_area"``.
        x : str, optional
            The axis of the study, such as ``"contact.load"``, or another column along the x axis. By default it is the first axis
            of numbers. Only an axis gets a line.
        color : str, optional
            The axis of the study that is shown by colours. Means are taken over all other axes.
        ax : matplotlib.axes.Axes, optional
            Axes to draw on; new ones by default.
        **options
            Passed on to ``Axes.plot``.
        """
        from ._study_plot import study

        if x is None:
            numbers = (key for key, values in self.axes.items() if values.dtype.kind in "if" and len(values) > 1)
            x = next(numbers, next(iter(self.axes)))
        return study(self.table, self.table_units, self._table_axes, quantity, x, color, ax, **options)

    def _records(self, collected: Any) -> NDArray[np.void]:
        cases, points, columns, warnings, messages = collected or ([], None, [], [], [])
        plan = self.plan[np.array(cases, dtype=np.int64) - 1]
        table: dict[str, NDArray[Any]] = {name: plan[name] for name in plan.dtype.names or ()}
        if points is not None:
            key, _, values, indices = points
            missing = "" if values and isinstance(values[0], str) else np.nan
            table[key] = np.array([missing if index is None else values[index] for index in indices])
        table.update({name: values for name, _, values in columns})
        table["warnings"] = np.array(warnings, dtype=np.int64)
        table["state"] = np.array(["done" if message is None else "failed" for message in messages], dtype=np.str_)
        table["message"] = np.array([message or "" for message in messages], dtype=np.str_)
        return _records(table)


@takes(Tasks)
def study(
    file: str | os.PathLike[str],
    *,
    out: str | os.PathLike[str] | None = None,
    **options: Unpack[Tasks],
) -> Study:
    """Compute a study file, as the command ``asperity study`` does.

    Parameters
    ----------
    file : path
        The study file.
    out : path, optional
        Directory of the study. By default it has the name of the file without its extension.
    **options

    Returns
    -------
    Study

    Raises
    ------
    asperity.errors.CaseError, asperity.errors.NotThisStudy, KeyboardInterrupt
        For the same reasons as :class:`Study` and :meth:`Study.run`.

    Warns
    -----
    asperity.errors.FailedCases
        If cases have failed.
    """
    study = Study(file, out)
    study.run(**options)
    return study


def _share(task: tuple[int, int] | None) -> tuple[int, int]:
    if task is None:
        return 1, 1
    numbers = tuple(task) if isinstance(task, (tuple, list)) else ()
    if len(numbers) == 2 and all(isinstance(number, (int, np.integer)) for number in numbers):
        number, of = (int(number) for number in numbers)
        if 1 <= number <= of:
            return number, of
    raise bad_input("task", f"'task' is {task!r}, expected the number of a task, from 1, and how many there are, such as (3, 40)")


def _records(columns: dict[str, NDArray[Any]]) -> NDArray[np.void]:
    """Makes a structured array of columns of the same length."""
    lengths = {len(values) for values in columns.values()}
    table = np.zeros(lengths.pop(), dtype=[(name, values.dtype) for name, values in columns.items()])
    for name, values in columns.items():
        table[name] = values
    return table
