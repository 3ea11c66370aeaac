"""The law of a joint of rough surfaces, for other programs."""

from __future__ import annotations

import json
import os
from typing import TYPE_CHECKING, Annotated, Any, Literal, NamedTuple

from numpy.typing import NDArray

from . import _case, _core
from ._described import described
from ._keywords import Samples, takes
from ._progress import Teller
from ._raise import bad_input, warn
from ._run import _path
from ._same import Comparable
from ._units import choice, path

if TYPE_CHECKING:
    import pathlib

    import numpy as np
    from typing_extensions import Unpack

Client = Literal["csv", "calculix", "abaqus", "ansys", "comsol", "moose", "opensees", "coefficients"]
_CLIENTS = ("csv", "calculix", "abaqus", "ansys", "comsol", "moose", "opensees", "coefficients")


class Band(NamedTuple):
    """A quantity over the samples of a joint, at each pressure; NaN where it is unknown."""

    median: NDArray[np.float64]
    """Median."""
    low: NDArray[np.float64]
    """Quantile 0.16."""
    high: NDArray[np.float64]
    """Quantile 0.84."""
    unit: str
    """SI unit; empty for a pure number."""


@described
class Joint(Comparable):
    """The law of a joint. Returned by :func:`asperity.joint`."""

    directory: Annotated["pathlib.Path", "Directory with the samples, ``joint.csv``, ``joint.html`` and the files for other programs."]
    sentence: Annotated[str, "What the law says in the middle of its pressures."]
    warnings: Annotated[list[str], "Reasons not to trust the law."]
    samples: Annotated[int, "Number of samples."]
    datum: Annotated[float, "Mean gap from which the closure is counted, m."]
    pressure: Annotated["NDArray[np.float64]", "Mean pressures, Pa, rising."]
    closure: Annotated["tuple[NDArray[np.float64], NDArray[np.float64]]",
        "Pressure, Pa, and closure, m, of the median from 0 on, with the continuation below the least pressure."]
    bands: Annotated[dict[str, Band],
        "Mean gap, contact fraction, stiffnesses and conductances of an area, and flow factors by their names, each as a :class:`Band`."]
    coefficients: Annotated[dict[str, Any],
        "Constants of other laws that fit the median, with their ranges: exponential, Greenwood and Tripp, Patir and Cheng."]

    def __init__(self, directory: pathlib.Path, found: Any) -> None:
        (self.sentence, self.warnings, coefficients, self.samples, self.datum), self.pressure, closure, bands = found
        self.directory = directory
        self.closure = (closure[0], closure[1])
        self.bands = {name: Band(median, low, high, unit) for name, unit, (median, low, high) in bands}
        self.coefficients = json.loads(coefficients)

    def __repr__(self) -> str:
        return f"<Joint: {self.sentence}>"

    def __getitem__(self, name: str) -> Band:
        """The band of a quantity, such as ``"stiffness"``."""
        if name not in self.bands:
            raise bad_input("name", f"'name' is {name!r}, expected one of {', '.join(self.bands)}")
        return self.bands[name]


@takes(Samples)
def joint(
    file: str | os.PathLike[str],
    *,
    out: str | os.PathLike[str] | None = None,
    clients: Client | list[Client] | tuple[Client, ...] = (),
    units: Literal["mm", "si"] = "mm",
    friction: float | None = None,
    **options: Unpack[Samples],
) -> Joint:
    """Compute the law of a joint, as the command ``asperity joint`` does.

    The table ``[joint]`` of the case says how many samples of its surfaces are computed. What was stopped continues where it was.

    Parameters
    ----------
    file : path
        The case file, with several loads and a periodic boundary.
    out : path, optional
        Directory. By default it has the name of the file with ``-joint``.
    clients : str or sequence of str
        Programs for which files are written: ``"csv"``, ``"calculix"``, ``"abaqus"``, ``"ansys"``, ``"comsol"``, ``"moose"``,
        ``"opensees"`` or ``"coefficients"``.
    units : {"mm", "si"}
        Units of these files: mm, N and MPa, or m, N and Pa.
    friction : float, optional
        Friction coefficient of surfaces that may slip, for programs that take one.
    **options

    Returns
    -------
    Joint

    Raises
    ------
    asperity.errors.CaseError
        If the case has a mistake, a single load, or a boundary that is free.
    asperity.errors.Unsupported
        If a program cannot take the law.
    KeyboardInterrupt
        At Ctrl-C. Finished samples stay.

    Warns
    -----
    asperity.errors.ModelWarning
        For reasons not to trust the law.
    """
    case = _path(path("file", file))
    directory = case.with_name(case.stem + "-joint") if out is None else _path(path("out", out))
    wanted = [clients] if isinstance(clients, str) else list(clients)
    for client in wanted:
        choice("clients", client, *_CLIENTS)
    choice("units", units, "mm", "si")
    if friction is not None and not friction > 0.0:
        raise bad_input("friction", f"'friction' is {friction!r}, expected a number above 0")
    count = _case.threads(options["threads"])
    settings = (units, None if friction is None else float(friction))
    with Teller(options["progress"]) as tell:
        found = _core.joint(os.fspath(case), os.fspath(directory), wanted, settings, bool(options["retry"]), count, tell)
    law = Joint(directory, found)
    if law.warnings:
        warn(law.warnings)
    return law
