"""Results directories, and the case files that they are computed from."""

from __future__ import annotations

import os
from typing import TYPE_CHECKING, Annotated, Any

import numpy as np
from numpy.typing import NDArray

from . import _case, _contact, _core, fields
from ._capabilities import Observed
from ._contact import Contact
from ._described import described
from ._keywords import Execution, takes
from ._optional import need
from ._plastic_state import PlasticState, of_results
from ._progress import Teller
from ._raise import Warner, bad_input, exception
from ._same import Comparable
from ._table import records, Table, Units
from ._temporary import Temporary
from ._units import path as paths
from .fields import Fields
from .surface import Surface

if TYPE_CHECKING:
    import pathlib

    from matplotlib.animation import FuncAnimation
    from matplotlib.axes import Axes
    from pandas import DataFrame
    from typing_extensions import Unpack
    from xarray import Dataset


@described
class Run(Observed, Comparable):
    """The results of a motion in a directory, finished or still running.

    All data are read from the files on access.

    Parameters
    ----------
    directory : path
        The results directory.
    """

    directory: Annotated["pathlib.Path", "The results directory."]

    def __init__(self, directory: str | os.PathLike[str]) -> None:
        self.directory = _path(paths("directory", directory))
        self._core = _core.Results(os.fspath(self.directory))
        self._temporary: Temporary | None = None

    def _compared(self) -> dict[str, Any]:
        # The time of a computation is not part of its answer.
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
        passes = self.passes
        parts = [f"{len(passes)} of {self.case['motion']['passes']} passes"]
        if len(passes):
            load, lower, upper = (float(passes[name][-1]) for name in ("mean_load", "sq_lower", "sq_upper"))
            sq = [_core.format(value, "length") for value in (lower, upper)]
            parts.append(f"mean load {_core.format(load, 'force')}, Sq {sq[0]} (lower) and {sq[1]} (upper)")
        if self._temporary is None:
            parts.append(f"in {self.directory}")
        return f"<Run: {', '.join(parts)}>"

    def _repr_html_(self) -> str:
        from ._html import run

        return run(self.case, self.passes, self.fields, self.warnings)

    @property
    def case(self) -> dict[str, Any]:
        """The resolved case, SI."""
        case: dict[str, Any] = self._core.case()
        return case

    @property
    def is_done(self) -> bool:
        """Whether all passes are computed."""
        passes = self.passes
        done = passes["represents"].sum() if "represents" in (passes.dtype.names or ()) else len(passes)
        return int(done) >= int(self.case["motion"]["passes"])

    @property
    def passes(self) -> Table:
        """A record for each pass, with the columns of `passes.csv`."""
        return records(self._core.rows("passes"), _core.PASS_COLUMNS)

    @property
    def steps(self) -> Table:
        """A record for each position of each pass, with the columns of `steps.csv`."""
        return records(self._core.rows("steps"), _core.STEP_COLUMNS)

    def _found(self, capability: str) -> list[dict[str, Any]]:
        found: dict[str, list[dict[str, Any]]] = self._core.rows("found")
        return found.get(capability, [])

    @property
    def warnings(self) -> list[str]:
        """Warnings about doubtful input and results; empty until the motion is finished."""
        summary = self._core.summary()
        return [] if summary is None else list(summary["warnings"])

    @property
    def wall_time(self) -> float:
        """Time of the whole computation, s; NaN until the motion is finished."""
        summary = self._core.summary()
        return float("nan") if summary is None else float(summary["wall_time_s"])

    def fields(self, number: int | None = None) -> Fields:
        """Return the fields after a pass: the surfaces `lower` and `upper`, mean pressures, and the kept pressures.

        Parameters
        ----------
        number : int, optional
            The pass, from 1; the last one by default. Pass 0 has the initial surfaces.
        """
        return fields.stored(self._core, "pass", self._number(number))

    def subsurface(self, number: int | None = None) -> Fields:
        """Return the stress under the surface in a pass, if the argument `subsurface` was given."""
        return fields.stored(self._core, "subsurface", self._number(number))

    def plastic_state(self, number: int | None = None) -> dict[str, PlasticState]:
        """Return the plastic state of elasto-plastic bodies after a pass, by ``"lower"`` and ``"upper"``.

        Parameters
        ----------
        number : int, optional
            The pass, from 1; the last one by default. Other passes are kept only with ``keep="passes"``.
        """
        return of_results(self._core, self._number(number))

    @property
    def regime(self) -> str | None:
        """Regime of elasto-plastic bodies: ``"elastic"``, ``"shakes-down"``, ``"cyclic"``, ``"ratchets"`` or ``"undecided"``.

        It is `None` for other bodies, and until the motion is finished.
        """
        found = (self._core.summary() or {}).get("plasticity")
        return None if found is None else str(found["regime"])

    def lower(self, number: int | None = None) -> Surface:
        """Return the surface of the lower body after a pass, by default the last one; pass 0 is the initial surface."""
        return self._surface("lower", number)

    def upper(self, number: int | None = None) -> Surface:
        """Return the underside of the upper body after a pass. A body with it is mounted ``"as-is"``."""
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

    def to_xarray(self) -> Dataset:
        """Return the passes as an xarray Dataset over `pass`, with the surfaces over `after`.

        `after` is the number of passes that a surface has seen, from 0. Each body has its own coordinates, from its own corner.
        """
        xarray = need("xarray", "to_xarray()")
        passes = self.passes
        columns = {name: ("pass", passes[name], {"units": unit}) for name, unit in passes.units.items() if name != "pass"}
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
        dataset: Dataset = xarray.Dataset({**columns, **surfaces}, coordinates, attributes)
        return dataset

    def to_pandas(self, units: Units = "si") -> DataFrame:
        """Return the passes as a pandas DataFrame, with its units in the attribute `units`.

        Parameters
        ----------
        units : {"si", "display"}
            Units of the numbers, see :meth:`Table.to_pandas`.
        """
        return self.passes.to_pandas(units)

    def plot(self, quantity: str | None = None, *, ax: Axes | None = None, **options: Any) -> Axes:
        """Draw a column of `passes` over the passes with matplotlib.

        The roughness, such as ``"sq_lower"``, begins with the initial surface at pass 0.

        Parameters
        ----------
        quantity : str, optional
            The column. By default the load at the positions of the first and the last pass is drawn.
        ax : matplotlib.axes.Axes, optional
            Axes to draw on; new ones by default.
        **options
            Passed on to ``Axes.plot``.
        """
        from ._plot import loads, over_passes

        if quantity is None:
            return loads(self.steps, len(self.passes), ax, **options)
        body = {"sq_lower": self.lower, "sq_upper": self.upper}.get(quantity)
        before = None if body is None else float(body(0).heights.std())
        return over_passes(self.passes, quantity, before, ax, **options)

    def report(self, out: str | os.PathLike[str] | None = None) -> pathlib.Path:
        """Write a page with the maps, curves and tables of the run in one HTML file, and return its path.

        The page opens in any browser without a network. It names results that cannot be read, and leaves them out.

        Parameters
        ----------
        out : path, optional
            The file; by default `report.html` beside the results. If the run was computed without `out`, the default file is
            removed together with the run.
        """
        return _contact.report(self._core, out)

    def animate(self, number: int | None = None, **options: Any) -> FuncAnimation:
        """Animate the kept pressures of a pass with matplotlib. In a notebook the animation plays.

        Parameters
        ----------
        number : int, optional
            The pass, from 1; the last one by default.
        **options
            `interval` is the time of each position, 100 ms by default. Other options are passed on to ``Axes.imshow``.
        """
        from ._animation import animation

        number = self._number(number)
        return animation(self.fields(number), self.steps, number, **options)


def _path(path: str | os.PathLike[str]) -> pathlib.Path:
    # Imported here: otherwise the import of the package takes a third longer.
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
        A run for a motion, a contact for a static contact.

    Raises
    ------
    asperity.errors.CaseError
        If the file has a mistake. The exception has its line and column.
    """
    count, existing = _case.execution(options)
    handed: dict[str, dict[str, Any]] = {"topographies": {}, "hardness": {}}
    with Teller(options["progress"]) as tell:
        _core.run(paths("case", case), handed, paths("out", out), existing, count, tell, Warner())
    return open(out)


def open(directory: str | os.PathLike[str]) -> Run | Contact:
    """Open the results of a motion, also while it runs, or of a finished static contact.

    Raises
    ------
    asperity.errors.NoResults
        If the directory contains no results.
    asperity.errors.NotResumable
        If a static contact was interrupted. Computing it again with ``resume=True`` finishes it.
    """
    where = paths("directory", directory)
    core = _core.Results(where)
    if "motion" in core.case():
        return Run(directory)
    if core.summary() is None:
        message = f"{os.fspath(directory)} contains a contact that was not finished"
        raise exception("NotResumable", message, {"path": os.fspath(directory)}, "resume=True goes on with it")
    return _contact.stored(where, core)
