"""Exceptions of asperity: one for each cause, with its numbers as attributes.

Every exception is an :class:`AsperityError`. Bad input is a :class:`ValueError`, a computation that failed a
:class:`RuntimeError`, and a problem with a file or a directory an :class:`OSError`. A hint, if there is one, is a note
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
    "DeviceFailed",
    "DeviceMemory",
    "Failed",
    "FailedCases",
    "File",
    "FileProblem",
    "PlasticNotConverged",
    "GridMismatch",
    "InUse",
    "InternalError",
    "Interrupted",
    "LoadNotReached",
    "Memory",
    "MissingFile",
    "ModelWarning",
    "NoChannel",
    "NoDevice",
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
    "OptionOfText",
    "OtherCase",
    "OtherRows",
    "OutOfRange",
    "OwnUnit",
    "PeriodicFullContact",
    "PullOff",
    "RanksDiffer",
    "ResultsExist",
    "SurfaceChanged",
    "Threads",
    "TooManyRanks",
    "UndefinedSamples",
    "Unsupported",
    "WindowOutside",
    "WithinResults",
    "WornAway",
]


class AsperityError(Exception):
    """Base of all exceptions of asperity."""

    hint: str | None = None
    """Advice on what to do, if there is any."""

    def __reduce__(self) -> tuple[Any, ...]:
        return (type(self), (str(self),), dict(self.__dict__))


class BadInput(AsperityError, ValueError):
    """An argument, a key of a case or the content of a file is invalid."""


class Failed(AsperityError, RuntimeError):
    """A computation failed."""


class FileProblem(AsperityError, OSError):
    """A file or a directory cannot be read, written or used."""

    path: str

    def __str__(self) -> str:
        return str(self.args[0]) if self.args else ""


class OutOfRange(BadInput):
    """A quantity is out of its range: `quantity`, `value` in SI, `expected`."""

    quantity: str
    value: float
    expected: str


class GridMismatch(BadInput):
    """Two grids that must agree do not: `what` differs, and its values on the `left` and on the `right`."""

    what: str
    left: str
    right: str


class Unsupported(BadInput):
    """A combination is not supported."""


class CaseError(BadInput):
    """An argument or a key of a case is wrong: `key`, with dots. In a case file also `path`, `line` and `column`, from 1."""

    key: str


class NotATopography(BadInput):
    """A file has none of the known formats: `path`, `reason`, `export`."""


class CorruptTopography(BadInput):
    """A topography file is damaged: `path`, `format`, `reason`."""


class NoChannel(BadInput):
    """A file has no such channel: `path`, `channel`, `available`."""


class OwnUnit(BadInput):
    """A unit is given for a file that has one: `path`, `format`."""


class OptionOfText(BadInput):
    """``lines`` or ``skip`` is given for a file whose format leaves nothing open: `path`, `format`, `option`."""


class NoPitch(BadInput):
    """A file has no pitch, and none is given: `path`, `format`."""


class NoFormat(BadInput):
    """The extension of a file belongs to no format: `path`."""


class UndefinedSamples(BadInput):
    """Heights are missing: `undefined` of `samples`."""

    undefined: int
    samples: int


class NothingDefined(BadInput):
    """None of the heights is defined: `samples`."""


class WindowOutside(BadInput):
    """A window does not lie within the surface: `window`, `shape`."""


class OtherCase(BadInput):
    """The results to resume belong to another case: `path`, `key`, `before`, `now`."""


class SurfaceChanged(BadInput):
    """A surface has changed since the results to resume were begun: `path`, `file`."""


class NoField(BadInput):
    """There is no field of that name: `path`, `name`, `available`."""


class BeyondPlasticLimit(Failed):
    """The load exceeds the load of all cells at the hardness: `load`, `limit`, N."""

    load: float
    limit: float


class BeyondFriction(Failed):
    """A tangential force exceeds the largest friction force: `force`, `limit`, N."""

    force: float
    limit: float


class NotConverged(Failed):
    """The solver stopped above the tolerance: `iterations`, `residual`, `tolerance`."""

    iterations: int
    residual: float
    tolerance: float


class NoDevice(BadInput):
    """There is no such device, or the package was built without it: `device`, and what was `found`."""

    device: str
    found: str


class DeviceMemory(Failed):
    """A device has too little memory: `device`, its name; `needed` and `free`, bytes."""

    device: str
    needed: float
    free: float


class DeviceFailed(Failed):
    """A device or its driver failed: `device`, its name, and the `reason`."""

    device: str
    reason: str


class PeriodicFullContact(Failed):
    """At this approach a periodic contact has no solution: `approach`, `mean_gap`, m."""


class PullOff(Failed):
    """The `load` pulls the bodies apart: adhesion holds at most `least`, the pull-off force, N."""

    load: float
    least: float


class LoadNotReached(Failed):
    """No approach gives the mean load of a pass: `load`, `below`, N; `trials`; `approach`, m."""


class BeyondPass(Failed):
    """One approach for a whole pass cannot carry the load: `load`, `most`, N; `approach`, m; `cause`."""


class AtPosition(Failed):
    """A position of a motion could not be solved: `pass_number`, `position`, `positions`, and the `cause`."""

    cause: AsperityError


class AtPoint(Failed):
    """A point of a sweep could not be solved: `point`, `points`, and the `cause`."""

    cause: AsperityError


class AtIncrement(Failed):
    """An increment of a load could not be solved: `increment`, from 1, and the `cause`."""

    increment: int
    cause: AsperityError


class AtPass(Failed):
    """A pass as a whole has no valid result: `pass_number`, from 1, and the `cause`."""

    cause: AsperityError


class AtUpdate(Failed):
    """An update of a contact that slides in place has no valid result: `update`, from 1 (0 before the first), and the `cause`."""

    update: int
    cause: AsperityError


class NotFinite(Failed):
    """A result is NaN or infinite: `field`, and `cell`, the index of the first such cell along each axis (empty for a number)."""

    field: str
    cell: list[int]


class WornAway(Failed):
    """A `body` loses more height than it is long, and is no longer a surface: `depth`, `length`, m."""

    body: str
    depth: float
    length: float


class PlasticNotConverged(Failed):
    """The return mapping of plastic strain did not converge: `products`, `mismatch` over the yield stress, `tolerance`."""

    products: int
    mismatch: float
    tolerance: float


class Memory(Failed):
    """A computation needs more memory than is available: `needed`, `available`, bytes."""

    needed: float
    available: float


class Threads(Failed):
    """Threads cannot be started: `reason`."""

    reason: str


class Interrupted(Failed):
    """A computation was interrupted."""


class File(FileProblem):
    """A file could not be read or written: `path`, `errno`, `reason`."""


class MissingFile(File, FileNotFoundError):
    """A file does not exist: `path`."""


class ResultsExist(FileProblem, FileExistsError):
    """A directory for results is not empty: `path`; `results`, whether it contains results."""


class WithinResults(FileProblem):
    """A directory for results lies within other results: `path`, `results`."""


class NotResumable(FileProblem):
    """The results to resume are incomplete: `path`, `reason`."""


class InUse(FileProblem):
    """Another run writes its results there: `path`."""


class NotThisStudy(FileProblem):
    """A directory for a study contains something else: `path`, `what`."""


class NoResults(FileProblem):
    """A directory contains no results: `path`."""


class TooManyRanks(BadInput):
    """There are more ranks than rows of the grid: `ranks`, `rows`."""

    ranks: int
    rows: int


class OtherRows(FileProblem):
    """The file of a rank contains other rows than the index of its run says.

    `path`; `rows`, the first and the last row of the file, and `ranks`, the number of ranks of its run; `expected` and
    `expected_ranks`, the same in the index.
    """

    rows: list[int]
    ranks: int
    expected: list[int]
    expected_ranks: int


class RanksDiffer(BadInput):
    """The ranks of one contact differ in their input: `rank`, `what`."""

    rank: int
    what: str


class InternalError(AsperityError, RuntimeError):
    """A mistake in asperity itself. Please report it."""


class ModelWarning(UserWarning):
    """A model may not hold, or a result is less certain than it looks."""


class FailedCases(UserWarning):
    """Cases of a study could not be computed."""


def warn(texts: list[str], category: type[UserWarning] = ModelWarning) -> None:
    """Warns of each text at the line that called asperity."""
    package = os.path.dirname(__file__)
    level, frame = 1, sys._getframe()
    while frame.f_back is not None and frame.f_code.co_filename.startswith(package):
        level, frame = level + 1, frame.f_back
    for text in texts:
        warnings.warn(text, category, stacklevel=level)


class Warner:
    """Warns of each text once, at the line that called asperity."""

    def __init__(self) -> None:
        self._texts: set[str] = set()

    def __call__(self, text: str) -> None:
        """Warn of a text that is new."""
        self.all([text])

    def all(self, texts: list[str]) -> None:
        """Warn of the texts that are new."""
        new = [text for text in texts if text not in self._texts]
        self._texts.update(new)
        warn(new)


def bad_input(key: str, message: str, hint: str | None = None) -> AsperityError:
    """Makes the exception of an invalid argument, to be raised."""
    return _make("CaseError", message, {"key": key}, hint)


def _make(name: str, message: str, attributes: dict[str, Any], hint: str | None) -> AsperityError:
    """Makes the exception of that name. The compiled module calls it."""
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
