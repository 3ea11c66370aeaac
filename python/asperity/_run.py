"""Results in a directory, and case files that lead to them."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from . import _case, _contact, _core, fields
from ._contact import Contact
from ._flow import Flow, of_results
from ._keywords import Execution, takes
from ._progress import Teller
from ._optional import need
from ._same import Comparable
from ._show import unit_of
from ._temporary import Temporary
from ._units import path as paths
from .errors import _make, bad_input
from .fields import Fields
from .surface import Surface

if TYPE_CHECKING:
    import pathlib

    from typing_extensions import Unpack


class Run(Comparable):
    """Results of a motion in a directory, finished or under way.

    Everything is read when it is asked for.

    Attributes
    ----------
    directory : pathlib.Path
        Where the results are.
    """

    def __init__(self, directory: str | os.PathLike[str]) -> None:
        self.directory = _path(paths("directory", directory))
        self._core = _core.Results(os.fspath(self.directory))
        self._temporary: Temporary | None = None

    def _compared(self) -> dict[str, Any]:
        # What a computation took is no part of its answer.
        passes = self.passes
        names = [name for name in passes.dtype.names or () if name != "wall_time_s"]
        rows = {name: passes[name] for name in names}
        return {"identity": self.case.get("identity"), "passes": rows, "steps": self.steps}

    def __getstate__(self) -> dict[str, Any]:
        if self._temporary is None:
            return {"directory": self.directory}
        files = {
            os.path.relpath(path, self.directory): path.read_bytes()
            for path in sorted(self.directory.rglob("*"))
            if path.is_file()
        }
        return {"files": files}

    def __setstate__(self, state: dict[str, Any]) -> None:
        if "files" in state:
            temporary = Temporary()
            for name, content in state["files"].items():
                path = _path(temporary.path) / name
                path.parent.mkdir(parents=True, exist_ok=True)
                path.write_bytes(content)
            self.__init__(temporary.path)  # type: ignore[misc]
            self._temporary = temporary
        else:
            self.__init__(state["directory"])  # type: ignore[misc]

    def __repr__(self) -> str:
        where = "" if self._temporary is not None else f" in {self.directory}"
        return f"<Run: {len(self.passes)} of {self.case['motion']['passes']} passes{where}>"

    def _repr_html_(self) -> str:
        from ._html import run

        return run(self)

    @property
    def case(self) -> dict[str, Any]:
        """The case as it was resolved, SI."""
        case: dict[str, Any] = self._core.case()
        return case

    @property
    def is_done(self) -> bool:
        """Whether all passes are there."""
        passes = self.passes
        done = passes["represents"].sum() if "represents" in (passes.dtype.names or ()) else len(passes)
        return int(done) >= int(self.case["motion"]["passes"])

    @property
    def passes(self) -> NDArray[np.void]:
        """A record for each pass, with the columns of `passes.csv`."""
        return fields.table(self._core.passes(), _core.PASS_COLUMNS)

    @property
    def steps(self) -> NDArray[np.void]:
        """A record for each position of each pass, with the columns of `steps.csv`."""
        return fields.table(self._core.steps(), _core.STEP_COLUMNS)

    @property
    def warnings(self) -> list[str]:
        """What to be wary of; nothing until all is done."""
        summary = self._core.summary()
        return [] if summary is None else list(summary["warnings"])

    @property
    def wall_time(self) -> float:
        """Time that the whole computation took, s; NaN until all is done."""
        summary = self._core.summary()
        return float("nan") if summary is None else float(summary["wall_time_s"])

    def fields(self, number: int | None = None) -> Fields:
        """Fields after a pass: the surfaces `lower` and `upper`, mean pressures, and pressures at the positions kept.

        Parameters
        ----------
        number : int, optional
            The pass, from 1; 0 for the surfaces before the first. The last one by default.
        """
        return fields.stored(self._core, "pass", self._number(number))

    def subsurface(self, number: int | None = None) -> Fields:
        """The stress under the surface in a pass, where `subsurface` asked for it."""
        return fields.stored(self._core, "subsurface", self._number(number))

    def flow(self, number: int | None = None) -> dict[str, Flow]:
        """Of bodies that flow below their surfaces, by ``"lower"`` and ``"upper"``, what they have left after a pass.

        Parameters
        ----------
        number : int, optional
            The pass, from 1, whose volumes are kept: the last one by default, of the others with ``keep="passes"``.
        """
        return of_results(self._core, self._number(number))

    @property
    def regime(self) -> str | None:
        """What becomes of bodies that flow: ``"elastic"``, ``"shakes-down"``, ``"cyclic"``, ``"ratchets"`` or ``"undecided"``.

        `None` of others, and until all is done.
        """
        found = (self._core.summary() or {}).get("plasticity")
        return None if found is None else str(found["regime"])

    def lower(self, number: int | None = None) -> Surface:
        """The lower body's surface after a pass, from 1; 0 before the first; the last one by default."""
        return self._surface("lower", number)

    def upper(self, number: int | None = None) -> Surface:
        """The upper body's underside after a pass; a body of it is mounted ``"as-is"``."""
        return self._surface("upper", number)

    def _surface(self, name: str, number: int | None) -> Surface:
        field = self.fields(number)[name]
        return Surface(field.values, field.pitch)

    def _number(self, number: int | None) -> int:
        done = len(self.passes)
        if number is None:
            return done
        if not 0 <= number <= done:
            message = f"'number' is {number}, expected a pass from 0, before the first, to {done}, the last"
            raise bad_input("number", message)
        return number

    def to_xarray(self) -> Any:
        """The passes as a Dataset of xarray over `pass`, with the surfaces after each and before the first over `after`.

        Each body has coordinates of its own, from its own corner.
        """
        xarray = need("xarray", "to_xarray()")
        passes = self.passes
        columns = {
            name: ("pass", passes[name], {"units": unit_of(name)}) for name in passes.dtype.names or () if name != "pass"
        }
        coordinates: dict[str, Any] = {"pass": passes["pass"], "after": np.arange(len(passes) + 1)}
        after = [self.fields(number) for number in range(len(passes) + 1)]
        surfaces = {}
        for body in ("lower", "upper"):
            first = after[0][body]
            axes = [f"{axis}_{body}" for axis in first.axes]
            for axis, own in zip(first.axes, axes, strict=True):
                coordinates[own] = (own, first.coordinate(axis), {"units": "m"})
            heights = np.stack([found[body].values for found in after])
            surfaces[body] = (("after", *axes), heights, {"units": first.unit})
        attributes = {"title": self.case["title"], "identity": self.case["identity"]}
        return xarray.Dataset({**columns, **surfaces}, coordinates, attributes)

    def to_pandas(self) -> Any:
        """The passes as a DataFrame of pandas."""
        return fields.frame(self.passes, "pass")

    def plot(self, quantity: str | None = None, **options: Any) -> Any:
        """Draw a column of `passes` over the passes, or, without one, the load at the positions of first and last pass.

        `ax` says on which axes; other `options` go to ``plot``. Gives the axes.
        """
        from ._plot import run

        return run(self, quantity, **options)

    def report(self, out: str | os.PathLike[str] | None = None) -> pathlib.Path:
        """Write a page of the run, maps, curves and tables in one HTML file, and give its path.

        It opens in any browser without a network. What of the results cannot be read is left out, and named on it.

        Parameters
        ----------
        out : path, optional
            The file; by default `report.html` beside the results, which goes with them where no `out` was given to keep them.
        """
        return _path(self._core.report(None if out is None else paths("out", out)))

    def animate(self, number: int | None = None, **options: Any) -> Any:
        """An animation of matplotlib of the pressures kept in a pass; in a notebook it plays.

        `interval` is the time of each position, 100 ms by default; other `options` go to ``imshow``.
        """
        from ._plot import animation

        return animation(self, self._number(number), **options)


def _path(path: str | os.PathLike[str]) -> pathlib.Path:
    # Imported where it is needed: the package would take a third longer to import.
    import pathlib

    return pathlib.Path(path)


@takes(Execution)
def run(
    case: str | os.PathLike[str],
    *,
    out: str | os.PathLike[str],
    **options: Unpack[Execution],
) -> Run | Contact:
    """Compute a case file, as the command ``asperity run`` does, without the figures.

    Parameters
    ----------
    case : path
        The case file.
    out : path
        Directory for the results.
    **options

    Returns
    -------
    Run or Contact
        Of a motion, or of a contact at rest.

    Raises
    ------
    asperity.errors.CaseError
        For a mistake in the file, with its line and column.
    """
    count, existing = _case.execution(options)
    handed: dict[str, dict[str, Any]] = {"topographies": {}, "hardness": {}}
    with Teller(options["progress"]) as tell:
        _core.run(paths("case", case), handed, paths("out", out), existing, count, tell)
    return open(out)


def open(directory: str | os.PathLike[str]) -> Run | Contact:
    """Open results: those of a motion, also while it runs, or of a contact at rest once it is done.

    Raises
    ------
    asperity.errors.NoResults
        If the directory holds none.
    asperity.errors.NotResumable
        If a contact at rest was interrupted: `resume` finishes it.
    """
    core = _core.Results(paths("directory", directory))
    if "motion" in core.case():
        return Run(directory)
    if core.summary() is None:
        message = f"{os.fspath(directory)} holds a contact that was not finished"
        raise _make("NotResumable", message, {"path": os.fspath(directory)}, "resume=True goes on with it")
    return _contact.stored(core)
