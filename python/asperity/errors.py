"""Exceptions of asperity: one for each cause, with the numbers needed to act on it as attributes.

Every exception is an :class:`AsperityError`. Bad input is a :class:`ValueError`, a computation that failed a
:class:`RuntimeError`, a file or a directory an :class:`OSError`. What to do about it, where that is known, is a note
(:pep:`678`), which tracebacks show.
"""

from __future__ import annotations

import os
import sys
import warnings
from typing import Any

__all__ = [
    "AsperityError",
    "AtIncrement",
    "AtPass",
    "AtPoint",
    "AtPosition",
    "AtUpdate",
    "BadInput",
    "BeyondFriction",
    "BeyondPass",
    "BeyondPlasticLimit",
    "CaseError",
    "CorruptTopography",
    "Failed",
    "FailedCases",
    "File",
    "FileProblem",
    "FlowNotConverged",
    "GridMismatch",
    "InUse",
    "InternalError",
    "Interrupted",
    "LoadNotReached",
    "Memory",
    "MissingFile",
    "ModelWarning",
    "NoChannel",
    "NoField",
    "NoFormat",
    "NoPitch",
    "NoResults",
    "NotATopography",
    "NotConverged",
    "NotFinite",
    "NotResumable",
    "NotThisStudy",
    "NothingDefined",
    "OtherCase",
    "OtherRows",
    "OutOfRange",
    "OwnUnit",
    "PeriodicFullContact",
    "RanksDiffer",
    "ResultsExist",
    "SurfaceChanged",
    "Threads",
    "TooManyRanks",
    "UndefinedSamples",
    "Unsupported",
    "WindowOutside",
    "WithinResults",
]


class AsperityError(Exception):
    """Base of all exceptions of asperity."""

    hint: str | None = None
    """What to do about it, where that is known."""

    def __reduce__(self) -> tuple[Any, ...]:
        return (type(self), (str(self),), dict(self.__dict__))


class BadInput(AsperityError, ValueError):
    """An argument, a key of a case or the content of a file has no meaning."""


class Failed(AsperityError, RuntimeError):
    """A computation failed."""


class FileProblem(AsperityError, OSError):
    """A file or a directory cannot be read, written or used."""

    path: str

    def __str__(self) -> str:
        return str(self.args[0]) if self.args else ""


class OutOfRange(BadInput):
    """A quantity lies outside the range in which it has a meaning: `quantity`, `value` in SI, `expected`."""

    quantity: str
    value: float
    expected: str


class GridMismatch(BadInput):
    """Two grids that must agree do not: `what`, and what it is on the `left` and on the `right`."""

    what: str
    left: str
    right: str


class Unsupported(BadInput):
    """A combination that has no meaning."""


class CaseError(BadInput):
    """An argument or a key of a case is wrong: `key`, dotted; of a case file `path`, `line` and `column`, from 1."""

    key: str


class NotATopography(BadInput):
    """A file is in none of the formats that are read: `path`, `reason`."""


class CorruptTopography(BadInput):
    """A topography file is damaged: `path`, `format`, `reason`."""


class NoChannel(BadInput):
    """A file has no such channel: `path`, `channel`, `available`."""


class OwnUnit(BadInput):
    """A unit is given for a file that has one: `path`, `format`."""


class NoPitch(BadInput):
    """A file has no pitch, and none is given: `path`, `format`."""


class NoFormat(BadInput):
    """The name of a file tells no format to write: `path`."""


class UndefinedSamples(BadInput):
    """Heights are missing where each is needed: `undefined` of `samples`."""

    undefined: int
    samples: int


class NothingDefined(BadInput):
    """None of the heights is defined: `samples`."""


class WindowOutside(BadInput):
    """A window does not lie within the surface: `window`, `shape`."""


class OtherCase(BadInput):
    """Results that are to be resumed are those of another case: `path`, `key`, `before`, `now`."""


class SurfaceChanged(BadInput):
    """A surface is no longer the one that results to be resumed began with: `path`, `file`."""


class NoField(BadInput):
    """There is no field of that name: `path`, `name`, `available`."""


class BeyondPlasticLimit(Failed):
    """The load is more than all cells bear at the hardness: `load`, `limit`, N."""

    load: float
    limit: float


class BeyondFriction(Failed):
    """A tangential force is more than friction holds: `force`, `limit`, N."""

    force: float
    limit: float


class NotConverged(Failed):
    """The iteration ended above the tolerance: `iterations`, `residual`, `tolerance`."""

    iterations: int
    residual: float
    tolerance: float


class PeriodicFullContact(Failed):
    """At this approach a periodic contact has no solution: `approach`, `mean_gap`, m."""


class LoadNotReached(Failed):
    """No approach gives the mean load of a pass: `load`, `below`, N; `trials`; `approach`, m."""


class BeyondPass(Failed):
    """One approach for a whole pass bears no such load: `load`, `most`, N; `approach`, m; `cause`, why."""


class AtPosition(Failed):
    """A position of a motion could not be solved: `pass_number`, `position`, `positions`, and `cause`, what is wrong there."""

    cause: AsperityError


class AtPoint(Failed):
    """A point of a sweep could not be solved: `point`, `points`, and `cause`, what is wrong there."""

    cause: AsperityError


class AtIncrement(Failed):
    """An increment of a load could not be solved: `increment`, from 1, and `cause`, what is wrong there."""

    increment: int
    cause: AsperityError


class AtPass(Failed):
    """The answer of a pass has no meaning: `pass_number`, from 1, and `cause`, what is wrong there."""

    cause: AsperityError


class AtUpdate(Failed):
    """The answer of an update of wear in place has no meaning: `update`, from 1 (0 before the first), and `cause`."""

    update: int
    cause: AsperityError


class NotFinite(Failed):
    """An answer is NaN or infinite: `field`, and `cell`, the index of the first such cell along each axis (empty for a number)."""

    field: str
    cell: list[int]


class FlowNotConverged(Failed):
    """Plastic strain and stress did not come to agree: `products`, `mismatch` over the yield stress, `tolerance`."""

    products: int
    mismatch: float
    tolerance: float


class Memory(Failed):
    """A computation takes more memory than there is: `needed`, `available`, bytes."""

    needed: float
    available: float


class Threads(Failed):
    """Threads to compute on cannot be made: `reason`."""

    reason: str


class Interrupted(Failed):
    """A computation was asked to stop."""


class File(FileProblem):
    """A file could not be read or written: `path`, `errno`, `reason`."""


class MissingFile(File, FileNotFoundError):
    """A file is not there: `path`."""


class ResultsExist(FileProblem, FileExistsError):
    """A directory that is to take results is not empty: `path`; `results`, whether it holds results."""


class WithinResults(FileProblem):
    """A directory that is to take results lies within others: `path`, `results`."""


class NotResumable(FileProblem):
    """Results that are to be resumed are not whole: `path`, `reason`."""


class InUse(FileProblem):
    """Another run writes its results there: `path`."""


class NotThisStudy(FileProblem):
    """A directory that is to take a study holds something else: `path`, `what`."""


class NoResults(FileProblem):
    """A directory holds no results: `path`."""


class TooManyRanks(BadInput):
    """More ranks than rows of the grid that is divided among them: `ranks`, `rows`."""

    ranks: int
    rows: int


class OtherRows(FileProblem):
    """The file of a rank holds other rows than the index of its run says.

    `path`; `rows`, the first and the last that it holds, and `ranks`, how many ranks its run had; `expected` and `expected_ranks`,
    what the index says of them.
    """

    rows: list[int]
    ranks: int
    expected: list[int]
    expected_ranks: int


class RanksDiffer(BadInput):
    """Ranks that are to compute one contact together have not the same: `rank`, `what`."""

    rank: int
    what: str


class InternalError(AsperityError, RuntimeError):
    """A mistake in asperity itself, which we would like to hear of."""


class ModelWarning(UserWarning):
    """A model is used where it may not hold, or a result is less certain than it looks."""


class FailedCases(UserWarning):
    """Cases of a study could not be computed."""


def warn(texts: list[str], category: type[UserWarning] = ModelWarning) -> None:
    """Warn of each, at the line that called asperity."""
    package = os.path.dirname(__file__)
    level, frame = 1, sys._getframe()
    while frame.f_back is not None and frame.f_code.co_filename.startswith(package):
        level, frame = level + 1, frame.f_back
    for text in texts:
        warnings.warn(text, category, stacklevel=level)


def bad_input(key: str, message: str, hint: str | None = None) -> AsperityError:
    """The exception of an argument that has no meaning, as of a key of a case; to be raised."""
    return _make("CaseError", message, {"key": key}, hint)


def _make(name: str, message: str, attributes: dict[str, Any], hint: str | None) -> AsperityError:
    """The exception of that name; called by the compiled module."""
    if name == "File" and attributes.get("errno") == 2:
        name = "MissingFile"
    error: AsperityError = globals()[name](message)
    for key, value in attributes.items():
        setattr(error, key, str(value) if isinstance(value, os.PathLike) else value)
    if hint is not None:
        error.hint = hint
        # From Python 3.11 on tracebacks show them.
        error.__dict__["__notes__"] = [f"hint: {hint}"]
    return error


def __dir__() -> list[str]:
    return __all__
