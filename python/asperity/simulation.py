"""Motions: computed at once, or pass after pass for custom laws."""

from __future__ import annotations

from collections.abc import Callable, Iterator
from functools import cached_property
from typing import TYPE_CHECKING, Annotated, Any, Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _case, _core
from ._described import described
from ._keywords import MotionKeywords, takes
from ._progress import Teller
from ._raise import Warner, bad_input
from ._run import Run
from ._table import Table, records
from ._temporary import Temporary
from ._units import choice, path
from .body import Body, Handed, bodies, heights_like
from .material import Material
from .surface import Surface

if TYPE_CHECKING:
    from typing_extensions import Unpack


@described
class Contacts(NamedTuple):
    """The cells in contact at all positions of a pass, as flat arrays of one length."""

    position: Annotated[NDArray[np.int64], "Position in the pass, from 0, ascending."]
    lower_cell: Annotated[NDArray[np.int64], "Cell of the lower body, an index into its raveled heights."]
    upper_cell: Annotated[NDArray[np.int64], "Cell of the upper body, an index into its raveled heights."]
    pressure: Annotated[NDArray[np.float64], "Pressure on the cell, Pa."]
    plastic: Annotated[NDArray[np.float64], "Plastic interference of the cell, m; 0 if the cell does not yield."]
    lower_beyond: Annotated[NDArray[np.float64],
        "Distance from the cell of the lower body to the contact along x, in cells, at least 0 and below 1. It is above 0 "
        "only in a shift whose slower surface moves by parts of a cell. :meth:`Pass.on_bodies` distributes values "
        "over the cells with it."]
    upper_beyond: Annotated[NDArray[np.float64], "Distance from the cell of the upper body to the contact, as `lower_beyond`."]
    shear: Annotated[NDArray[np.float64],
        "Shear traction along x of the upper body on the lower one, Pa; 0 without friction."]
    temperature: Annotated[NDArray[np.float64], "Temperature of both surfaces, K; NaN if it is not computed."]

    def by_position(self) -> Iterator[Contacts]:
        """Iterate over the contacts of each position. Positions without contact are left out."""
        starts = np.flatnonzero(np.diff(self.position, prepend=-1))
        ends = [*starts[1:], len(self.position)]
        for start, end in zip(starts, ends, strict=True):
            yield Contacts._make(array[start:end] for array in self)


class _Moving:
    """The two bodies of a motion."""

    _core: Any

    @property
    def lower(self) -> NDArray[np.float64]:
        """Present heights of the lower body, m: a copy."""
        heights: NDArray[np.float64] = self._core.heights()[0]
        return heights

    @property
    def upper(self) -> NDArray[np.float64]:
        """Present heights of the underside of the upper body, m: a copy."""
        heights: NDArray[np.float64] = self._core.heights()[1]
        return heights


@described
class Pass(_Moving):
    """A solved pass of a :class:`Simulation`, before its bodies change.

    It is valid until the next iteration of the loop.
    """

    number: Annotated[int, "Number of the pass, from 1."]
    numbers: Annotated[dict[str, Any],
        "Numbers of the pass with the columns of `passes.csv`, before material is removed. With `acceleration` a pass "
        "may represent several passes, ``numbers[\"represents\"]`` of them."]
    pitch: Annotated[tuple[float, float], "Size of a cell along x and y, m."]
    sliding_distance: Annotated[float,
        "Sliding distance for which a position stands, m; the way of a pass over the number of its positions."]
    time: Annotated[float, "Time for which a position stands, s; NaN without a speed."]
    shapes: Annotated[tuple[tuple[int, int], tuple[int, int]], "Number of cells of the lower and of the upper body along x and y."]

    def __init__(
        self,
        core: Any,
        pitch: tuple[float, float],
        distance: float,
        time: float,
        shapes: tuple[tuple[int, int], tuple[int, int]],
    ) -> None:
        self._core = core
        self.pitch = pitch
        self.sliding_distance = distance
        self.time = time
        self.shapes = shapes
        self.numbers = core.record()
        self.number = self.numbers["pass"]

    def __repr__(self) -> str:
        return f"<Pass {self.number}>"

    @property
    def cell_area(self) -> float:
        """Area of a cell, m²."""
        return self.pitch[0] * self.pitch[1]

    @cached_property
    def contacts(self) -> Contacts:
        """Cells in contact at all positions."""
        whole, real = self._core.contacts(self.number)
        return Contacts(*whole, *real)

    @cached_property
    def steps(self) -> Table:
        """A record for each position, with the columns of `steps.csv`."""
        return records(self._core.steps(self.number), _core.STEP_COLUMNS)

    def pressures(self, body: Literal["lower", "upper"] = "lower") -> NDArray[np.float64]:
        """Return the pressure at each position on each cell of a body, ``[position, ix, iy]``, Pa.

        :func:`asperity.fatigue` takes them. They need the memory of a body for each position.

        Parameters
        ----------
        body : str
            ``"lower"`` or ``"upper"``.
        """
        choice("body", body, "lower", "upper")
        contacts = self.contacts
        return self._on_body(body, contacts.pressure, contacts.position, len(self.steps["step"]))

    def on_bodies(self, values: ArrayLike) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Sum values of the contacts on the cells of the lower and of the upper body over the pass.

        Parameters
        ----------
        values : array_like
            A value for each cell in contact at each position, as the arrays of `contacts`, or one number for all.

        Returns
        -------
        tuple of ndarray
            The sums on the lower and on the upper body. A value between two cells of a body is divided among them, so that the total
            of each array is the sum of the values.
        """
        weights = np.broadcast_to(np.asarray(values, dtype=float), self.contacts.pressure.shape)
        return self._on_body("lower", weights)[0], self._on_body("upper", weights)[0]

    def _on_body(self, body: str, values: NDArray[np.float64], plane: Any = 0, planes: int = 1) -> NDArray[np.float64]:
        """Sums values of the contacts on the cells of a body, those of each `plane` by themselves: ``[plane, ix, iy]``."""
        contacts = self.contacts
        if body == "lower":
            cell, beyond, (nx, ny) = contacts.lower_cell, contacts.lower_beyond, self.shapes[0]
        else:
            cell, beyond, (nx, ny) = contacts.upper_cell, contacts.upper_beyond, self.shapes[1]
        cells = nx * ny
        here = np.bincount(plane * cells + cell, values * (1.0 - beyond), planes * cells)
        there = np.bincount(plane * cells + (cell + ny) % cells, values * beyond, planes * cells)
        return (here + there).reshape(planes, nx, ny).astype(np.float64, copy=False)

    def remove(self, depth_lower: ArrayLike, depth_upper: ArrayLike, law: str = "wear") -> None:
        """Remove material before the next pass.

        With `acceleration` the depths are those of a single pass. They are removed once for each of the passes that this one represents.
        Their number is chosen before the depths are known: the depths of a pass bound the number of the next one by `max_wear`, and their
        change since the pass before bounds it by `tolerance`. It at most doubles from one computed pass to the next.

        Parameters
        ----------
        depth_lower, depth_upper : array_like
            Depth that a single pass removes from each cell of the body, m; negative for growth. A matrix of the shape of its heights, or
            one number.
        law : str
            Name of the law. The results have the removed volumes in the columns `<law>_volume_lower` and `<law>_volume_upper`.

        Raises
        ------
        asperity.errors.CaseError
            If a depth has another shape, or is not finite.
        """
        if not (law.isidentifier() and law.islower()):
            raise bad_input("law", f"'law' is {law!r}, expected a word in small letters")
        depths = [
            heights_like(depth, shape, key)
            for depth, shape, key in zip(
                (depth_lower, depth_upper), self.shapes, ("depth_lower", "depth_upper"), strict=True
            )
        ]
        self._core.remove(self.number, law, *depths)


class Simulation(_Moving):
    """A motion that yields each pass, for custom laws.

    ``for p in asp.Simulation(...)`` solves a pass, yields it as a :class:`Pass`, and finishes it in the next iteration. After a
    ``break``, :meth:`results` or :meth:`close` finish the pass. After an exception the pass is not finished, and `resume` computes it
    again.

    Parameters
    ----------
    lower, upper, lower_material, upper_material
        The bodies, as in :func:`contact`.
    options
        Keyword arguments of :func:`simulate`, without `law`.

    Examples
    --------
    Archard's wear of both bodies, with its coefficient over hardness, 1/Pa:

    >>> import numpy as np, asperity as asp
    >>> steel = asp.Material(young="210 GPa", poisson=0.3, hardness="4 GPa")
    >>> rough = [asp.generate.low_pass((16, 16), pitch="1 um", sq="50 nm", cutoff="8 um", seed=s) for s in (1, 2)]
    >>> simulation = asp.Simulation(*rough, steel, steel, load="20 mN", passes=2, progress=False)
    >>> for p in simulation:
    ...     p.remove(*p.on_bodies(1e-15 * p.contacts.pressure * p.sliding_distance))
    >>> simulation.results().passes["wear_volume_lower"].shape
    (2,)
    """

    _has_custom_laws = True

    @takes(MotionKeywords)
    def __init__(
        self,
        lower: Surface | Body,
        upper: Surface | Body,
        lower_material: Material | None = None,
        upper_material: Material | None = None,
        **options: Unpack[MotionKeywords],
    ) -> None:
        handed = Handed(*bodies(lower, upper, lower_material, upper_material))
        case = _case.tables(handed, MotionKeywords, options)
        count, existing = _case.execution(options)
        self._progress = options["progress"]
        self._temporary: Temporary | None = None
        out = options["out"]
        if out is None:
            self._temporary = Temporary()
            out = self._temporary.path
        self.directory = path("out", out)
        self._warner = Warner()
        self._core = _core.Passes(case, handed.given, self.directory, existing, count, self._has_custom_laws)

    @property
    def done(self) -> int:
        """Number of finished passes."""
        return int(self._core.done())

    def __iter__(self) -> Iterator[Pass]:
        (dx, dy), distance, time, (lower, upper) = self._core.grid()
        with Teller(self._progress) as tell:
            while True:
                self._core.finish(self._warner)
                if not self._core.solve(tell):
                    break
                yield Pass(self._core, (dx, dy), distance, time, (lower, upper))
        self.close()

    def close(self) -> None:
        """Finish the present pass, and write the summary. No further pass can be solved."""
        self._core.finish(self._warner)
        self._core.end()

    def results(self) -> Run:
        """Finish the present pass, and return the results."""
        self.close()
        run = Run(self.directory)
        # A temporary directory lives as long as the results.
        run._temporary = self._temporary
        self._warner.all(run.warnings)
        return run


class _WithoutLaws(Simulation):
    """A motion whose passes no custom law changes."""

    _has_custom_laws = False


Law = Callable[[Pass], "tuple[ArrayLike, ArrayLike] | None"]
"""A law: takes each pass, and returns the depths that a single pass removes from the lower and the upper body, m, or `None`."""


@takes(MotionKeywords)
def simulate(
    lower: Surface | Body,
    upper: Surface | Body,
    lower_material: Material | None = None,
    upper_material: Material | None = None,
    *,
    law: Law | None = None,
    **options: Unpack[MotionKeywords],
) -> Run:
    """Move the upper body over the lower one, pass after pass.

    Parameters
    ----------
    lower, upper, lower_material, upper_material
        The bodies, as in :func:`contact`.
    law : callable, optional
        Called with each solved :class:`Pass` in the calling thread. It returns the depths that a single pass removes from the lower and the
        upper body, m, or `None`; see :meth:`Pass.remove`. The volumes are the columns `wear_volume_lower` and `wear_volume_upper` of :attr:`Run.passes`.
    **options

    Returns
    -------
    Run

    Raises
    ------
    asperity.errors.BadInput, asperity.errors.Failed, KeyboardInterrupt
        For the same reasons as :func:`contact`. An exception of `law` ends the run, and its pass is not finished.
    """
    motion = _WithoutLaws if law is None else Simulation
    simulation = motion(lower, upper, lower_material, upper_material, **options)
    for each in simulation:
        removed = None if law is None else law(each)
        if removed is not None:
            if not isinstance(removed, tuple) or len(removed) != 2:
                message = f"'law' gave {type(removed).__name__}, expected None, or the depths off the lower and the upper body"
                raise bad_input("law", message)
            each.remove(*removed)
    return simulation.results()
