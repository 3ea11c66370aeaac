"""Studies: many cases made of one."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from . import _case, _core, fields
from ._contact import Contact
from ._keywords import Tasks, takes
from ._progress import Teller
from ._run import Run, _path, open
from ._same import Comparable
from ._units import path
from .errors import FailedCases, NoResults, NotResumable, _make, bad_input, warn

if TYPE_CHECKING:
    from typing_extensions import Unpack

_State = NDArray[np.str_]


class Study(Comparable):
    """A study: a case, changed in some of its values, many times.

    Cases are known by their number, from 1. What has become of them is read when it is asked for: other processes may be at work on
    the study at the same time.

    Parameters
    ----------
    file : path
        The study file, as ``asperity study`` takes it.
    out : path, optional
        Directory of the study; by default called as the file, without its end.

    Attributes
    ----------
    file : pathlib.Path
        The study file.
    directory : pathlib.Path
        Directory of the study, made by :meth:`run`.
    title : str
        By default the file's name.
    axes : dict of str to ndarray
        The values of each axis by its key: numbers in SI, or texts.
    units : dict of str to str
        The SI unit of each axis; empty of pure numbers and of texts.

    Raises
    ------
    asperity.errors.CaseError
        For a mistake in the study file, its table or its base, with its `key`, `line` and `column`. Every value of every axis is tried.
    """

    def __init__(self, file: str | os.PathLike[str], out: str | os.PathLike[str] | None = None) -> None:
        self.file = _path(path("file", file))
        self.directory = self.file.with_suffix("") if out is None else _path(path("out", out))
        self._core = _core.Study(os.fspath(self.file), os.fspath(self.directory))
        self.title: str = self._core.title()
        axes = self._core.axes()
        self.axes: dict[str, NDArray[Any]] = {key: np.array(values) for key, _, values in axes}
        self.units: dict[str, str] = {key: unit for key, unit, _ in axes}

    def _compared(self) -> dict[str, Any]:
        return {"plan": self.plan, "table": self.table}

    def __reduce__(self) -> tuple[Any, ...]:
        return Study, (self.file, self.directory)

    def __len__(self) -> int:
        """How many cases there are."""
        return len(self._core.indices())

    def __repr__(self) -> str:
        return f"<Study {self.title}: {self._told()}, in {self.directory}>"

    def _repr_html_(self) -> str:
        from ._html import study

        return study(self)

    def _told(self) -> str:
        states = self.states
        done, failed = (int((states == state).sum()) for state in ("done", "failed"))
        return f"{done} of {len(states)} cases are done" + (f", {failed} have failed" if failed else "")

    @property
    def plan(self) -> NDArray[np.void]:
        """A record for each case: its number, `case`, and its value of each axis, SI."""
        indices = self._core.indices()
        columns: dict[str, NDArray[Any]] = {"case": np.arange(1, len(indices) + 1, dtype=np.int64)}
        for n, (key, values) in enumerate(self.axes.items()):
            columns[key] = values[indices[:, n]]
        return _records(columns)

    @property
    def states(self) -> _State:
        """How each case stands: ``"done"``, ``"failed"``, ``"running"`` in some process, or ``"open"``."""
        return np.array([state for state, _ in self._core.states()])

    @property
    def left(self) -> NDArray[np.int64]:
        """The numbers of the cases that are neither done nor failed."""
        states = self.states
        return np.flatnonzero((states == "open") | (states == "running")) + 1

    @property
    def failures(self) -> dict[int, str]:
        """Why cases have failed, by their numbers."""
        return {n: message for n, (_, message) in enumerate(self._core.states(), 1) if message is not None}

    @property
    def table(self) -> NDArray[np.void]:
        """A record for each case that is over, with the columns of ``table.csv``.

        These are `case`, the axes, numbers of the summary, SI, NaN where a case has none, then `warnings`, how many, `state`,
        ``"done"`` or ``"failed"``, and the `message` of a failure.
        """
        return self._records(self._core.table())

    @takes(Tasks)
    def run(self, **options: Unpack[Tasks]) -> None:
        """Compute what is left, as the command ``asperity study`` does; who finishes the last case makes tables and page.

        A case that cannot be computed is a row of the :attr:`table` with its message; the others are computed. Stopped, killed or
        called again, it goes on where it was, and any number of processes may be at work on one study.

        Parameters
        ----------
        **options

        Raises
        ------
        asperity.errors.NotThisStudy
            If the directory holds another study, or something else.
        asperity.errors.FileProblem
            Where the study cannot be written to.
        KeyboardInterrupt
            At Ctrl-C; what is done stays.

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
        """Write ``table.csv``, ``table.h5`` and ``study.html`` of what is there, and give the :attr:`table`.

        Raises
        ------
        asperity.errors.NotThisStudy
            If the study was not begun.
        """
        return self._records(self._core.collect())

    def open(self, case: int) -> Run | Contact:
        """Open the results of a case, from 1, as :func:`open` does.

        Raises
        ------
        asperity.errors.NoResults
            If it is not done.
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
        raise _make("NoResults", f"case {case} failed: {failure}", {"path": directory}, "retry=True computes it again")

    def to_pandas(self) -> Any:
        """The :attr:`table` as a DataFrame of pandas over `case`, with its units as the attribute `units`."""
        made = fields.frame(self.table, "case")
        for key, values in self.axes.items():
            made.attrs["units"][key] = self.units[key] or ("1" if values.dtype.kind in "iuf" else "")
        return made

    def _records(self, collected: Any) -> NDArray[np.void]:
        cases, columns, warnings, messages = collected or ([], [], [], [])
        plan = self.plan[np.array(cases, dtype=np.int64) - 1]
        table: dict[str, NDArray[Any]] = {name: plan[name] for name in plan.dtype.names or ()}
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
    file, out
        As of :class:`Study`.
    **options

    Returns
    -------
    Study

    Raises
    ------
    asperity.errors.CaseError, asperity.errors.NotThisStudy, KeyboardInterrupt
        As of :class:`Study` and :meth:`Study.run`.

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
    """Columns of one length as a structured array."""
    lengths = {len(values) for values in columns.values()}
    table = np.zeros(lengths.pop(), dtype=[(name, values.dtype) for name, values in columns.items()])
    for name, values in columns.items():
        table[name] = values
    return table
