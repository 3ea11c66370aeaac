"""Exceptions of asperity: one for each cause, with its numbers as attributes.

Every exception is an :class:`AsperityError`. Bad input is a :class:`ValueError`, a computation that failed a
:class:`RuntimeError`, and a problem with a file or a directory an :class:`OSError`. A hint, if there is one, is a note
(:pep:`678`), which tracebacks show.

This file is made from the variants of the library's error: ``UPDATE=1 cargo test -p asperity-study``.
"""

from __future__ import annotations

from typing import Annotated

from ._described import described
from ._exceptions import AsperityError, BadInput, CaseError, Failed, FailedCases, FileProblem, InternalError, ModelWarning

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
    "FilmNotConverged",
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
    "PlasticNotConverged",
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


@described
class OutOfRange(BadInput):
    """A quantity lies outside its valid range."""

    quantity: Annotated[str, "The quantity's name, as the user knows it."]
    value: Annotated[float, "The value given, SI."]
    expected: Annotated[str, "The accepted values."]


@described
class GridMismatch(BadInput):
    """Two grids that must agree do not."""

    what: Annotated[str, "The property that must agree, for example \"pitch of the two bodies\"."]
    left: Annotated[str, "Its value on the first grid."]
    right: Annotated[str, "Its value on the second grid."]


@described
class TooManyRanks(BadInput):
    """More ranks than rows of the grid that is divided among them."""

    ranks: Annotated[int, "Number of ranks."]
    rows: Annotated[int, "Number of rows."]


@described
class RanksDiffer(BadInput):
    """Ranks that compute one contact together differ in something that must be the same."""

    rank: Annotated[int, "The first rank that differs."]
    what: Annotated[str, "The differing property, for example \"version of asperity\"."]


class Unsupported(BadInput):
    """A combination that is not supported."""


@described
class NotATopography(BadInput):
    """A file in none of the supported formats."""

    path: Annotated[str, "The file."]
    reason: Annotated[str, "The apparent kind of the file."]
    export: Annotated[str, "Advice on an export that is read; empty if any format that is read will do."]


@described
class CorruptTopography(BadInput):
    """A file of a known format that is damaged, or that uses an unsupported part of the format."""

    path: Annotated[str, "The file."]
    format: Annotated[str, "The format it was recognised as."]
    reason: Annotated[str, "The defect and its place."]


@described
class NoChannel(BadInput):
    """A channel that the file does not have, or no channel given for a file with several."""

    path: Annotated[str, "The file."]
    channel: Annotated[str, "The requested channel; empty if none was given."]
    available: Annotated[list[str], "The channels of the file."]


@described
class OwnUnit(BadInput):
    """A unit given for a file that states the unit of its heights."""

    path: Annotated[str, "The file."]
    format: Annotated[str, "The format it was recognised as."]


@described
class OptionOfText(BadInput):
    """An option for text or for a matrix of open order, given for a file of another format."""

    path: Annotated[str, "The file."]
    format: Annotated[str, "The format it was recognised as."]
    option: Annotated[str, "`lines` or `skip`."]


@described
class NoPitch(BadInput):
    """A topography file without a pitch, and no pitch given."""

    path: Annotated[str, "The file."]
    format: Annotated[str, "The format it was recognised as."]


@described
class NoFormat(BadInput):
    """A file name whose extension names no format for writing a topography."""

    path: Annotated[str, "The file."]


@described
class UndefinedSamples(BadInput):
    """A topography with undefined samples where every sample is needed."""

    undefined: Annotated[int, "Number of undefined samples."]
    samples: Annotated[int, "Number of all samples."]


@described
class NothingDefined(BadInput):
    """A topography without any defined sample, so that nothing can be filled."""

    samples: Annotated[int, "Number of all samples."]


@described
class WindowOutside(BadInput):
    """A window that does not lie within the topography."""

    window: Annotated[list[int], "First sample and number of samples, `[x0, y0, nx, ny]`."]
    shape: Annotated[list[int], "Samples of the topography along x and y."]


@described
class BeyondPlasticLimit(Failed):
    """The load exceeds what the bodies can carry with every cell at the hardness."""

    load: Annotated[float, "The requested load, N."]
    limit: Annotated[float, "The largest load that can be carried, N."]


@described
class BeyondFriction(Failed):
    """The tangential force exceeds the friction limit: the bodies slide."""

    force: Annotated[float, "The requested force, N."]
    limit: Annotated[float, "The friction limit, N; the force must be smaller."]


@described
class NoDevice(BadInput):
    """No device of the requested kind."""

    device: Annotated[str, "The device, as the user named it."]
    found: Annotated[str, "The devices or libraries that are there, or what is missing."]


@described
class DeviceMemory(Failed):
    """A device has too little memory."""

    device: Annotated[str, "Name of the device."]
    needed: Annotated[float, "Memory that the contact takes, bytes."]
    free: Annotated[float, "Memory that is free, bytes."]


@described
class DeviceFailed(Failed):
    """A device, its driver or one of its libraries failed."""

    device: Annotated[str, "Name of the device."]
    reason: Annotated[str, "The message of the driver or of the library."]


@described
class NotConverged(Failed):
    """The iteration stopped above the tolerance."""

    iterations: Annotated[int, "Iterations spent."]
    residual: Annotated[float, "Scale-free complementarity residual η reached."]
    tolerance: Annotated[float, "The requested η."]


@described
class FilmNotConverged(Failed):
    """The iteration for a film of oil stopped above the tolerance."""

    iterations: Annotated[int, "Iterations spent."]
    residual: Annotated[float, "Scale-free residual reached."]
    tolerance: Annotated[float, "The requested residual."]


@described
class PeriodicFullContact(Failed):
    """An approach at which a periodic contact has no solution: the mean displacement is free there."""

    approach: Annotated[float, "The requested approach, m."]
    mean_gap: Annotated[float, "The mean undeformed gap, the limit of the approach, m."]


@described
class PullOff(Failed):
    """A load that pulls the bodies apart. Adhesion holds no more than `least`."""

    load: Annotated[float, "The requested load, N."]
    least: Annotated[float, "The least load found on the way apart, the pull-off force, N."]


@described
class LoadNotReached(Failed):
    """No approach was found that gives the requested pass-mean load."""

    load: Annotated[float, "The requested pass-mean load, N."]
    below: Annotated[float, "The largest load found that is smaller, N."]
    trials: Annotated[int, "Approaches tried."]
    approach: Annotated[float, "The last approach tried, m."]


@described
class BeyondPass(Failed):
    """The requested load exceeds the largest that one approach for a whole pass can carry."""

    load: Annotated[float, "The requested pass-mean load, N."]
    most: Annotated[float, "The load at the approach, N."]
    approach: Annotated[float, "The upper limit of the search for an approach, m."]
    cause: Annotated[str, "The reason for the limit."]


@described
class AtPosition(Failed):
    """A position of a motion could not be solved."""

    pass_number: Annotated[int, "The pass, from 1."]
    position: Annotated[int, "The position, from 1."]
    positions: Annotated[int, "Positions of the pass."]
    cause: Annotated[AsperityError, "The cause."]


@described
class AtPoint(Failed):
    """A point of a load sweep could not be solved."""

    point: Annotated[int, "The point, from 1."]
    points: Annotated[int, "Points of the sweep."]
    cause: Annotated[AsperityError, "The cause."]


@described
class AtIncrement(Failed):
    """An increment of a load could not be solved."""

    increment: Annotated[int, "The increment, from 1."]
    cause: Annotated[AsperityError, "The cause."]


@described
class AtPass(Failed):
    """A pass as a whole could not be solved, or its result is no longer a surface or not finite."""

    pass_number: Annotated[int, "The computed pass, from 1."]
    cause: Annotated[AsperityError, "The cause."]


@described
class AtUpdate(Failed):
    """An update of a contact that slides in place could not be solved, or its result is no longer a surface or not finite."""

    update: Annotated[int, "The update, from 1; 0 before the first."]
    cause: Annotated[AsperityError, "The cause."]


@described
class NotFinite(Failed):
    """A result is NaN or infinite."""

    field: Annotated[str, "Name of the field, column or number."]
    cell: Annotated[list[int], "Index of the first such cell along each axis, from 0; empty for a single number."]


@described
class WornAway(Failed):
    """A body loses more material than it is long: it is no longer a surface."""

    body: Annotated[str, "The body: \"lower\" or \"upper\"."]
    depth: Annotated[float, "The height that it loses, m."]
    length: Annotated[float, "The longer side of its grid, m."]


@described
class PlasticNotConverged(Failed):
    """The return mapping did not converge: plastic strain and stress do not agree."""

    products: Annotated[int, "Applications of the residual-stress operator."]
    mismatch: Annotated[float, "Return-mapping residual over the yield stress."]
    tolerance: Annotated[float, "The requested tolerance."]


@described
class Memory(Failed):
    """A computation needs more memory than is free."""

    needed: Annotated[float, "The memory needed, bytes."]
    available: Annotated[float, "The free memory, bytes."]


@described
class Threads(Failed):
    """Threads could not be created."""

    reason: Annotated[str, "Message of the operating system."]


class Interrupted(Failed):
    """The caller asked the computation to stop."""


@described
class ResultsExist(FileProblem, FileExistsError):
    """The directory for the results is not empty."""

    path: Annotated[str, "The directory."]
    results: Annotated[bool, "Whether it holds results of this program."]


@described
class WithinResults(FileProblem):
    """The directory for the results lies within other results."""

    path: Annotated[str, "The directory."]
    results: Annotated[str, "The directory of the other results."]


@described
class OtherCase(BadInput):
    """The results to resume belong to another case."""

    path: Annotated[str, "The directory."]
    key: Annotated[str, "The first key that differs, dotted."]
    before: Annotated[str, "The key's value in the results, JSON."]
    now: Annotated[str, "The key's value in the case, JSON."]


@described
class SurfaceChanged(BadInput):
    """A surface file has changed since the results to resume were begun."""

    path: Annotated[str, "The directory."]
    file: Annotated[str, "The surface file."]


@described
class NotResumable(FileProblem):
    """The results to resume are incomplete."""

    path: Annotated[str, "The file at fault."]
    reason: Annotated[str, "The defect."]


@described
class OtherRows(FileProblem):
    """The file of a rank holds other rows than the index of the run states."""

    path: Annotated[str, "The file at fault."]
    rows: Annotated[list[int], "First and last row in the file."]
    ranks: Annotated[int, "Number of ranks of the run that wrote it."]
    expected: Annotated[list[int], "First and last row expected."]
    expected_ranks: Annotated[int, "Number of ranks in the index."]


@described
class InUse(FileProblem):
    """Another process writes its results to the directory."""

    path: Annotated[str, "The directory."]


@described
class NoResults(FileProblem):
    """A directory without results."""

    path: Annotated[str, "The directory."]


@described
class NotThisStudy(FileProblem):
    """The directory for a study holds something else."""

    path: Annotated[str, "The directory."]
    what: Annotated[str, "Its content: \"holds another study\"."]


@described
class File(FileProblem):
    """A file could not be read or written."""

    path: Annotated[str, "The file."]
    errno: Annotated[int | None, "Number of the error of the operating system."]
    reason: Annotated[str, "Message of the operating system."]


@described
class NoField(BadInput):
    """A field that a results file does not have."""

    path: Annotated[str, "The file."]
    name: Annotated[str, "The requested field."]
    available: Annotated[list[str], "The fields of the file."]


class MissingFile(File, FileNotFoundError):
    """A file does not exist."""


def __dir__() -> list[str]:
    return __all__
