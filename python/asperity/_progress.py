"""How far a computation is: a bar of tqdm where that is installed, or a function of the caller's."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from typing import Any, NamedTuple

_WAIT = 0.5
"""Computations shorter than this, in seconds, show nothing."""


class Progress(NamedTuple):
    """How far a computation is.

    Attributes
    ----------
    pass_number, passes : int
        The pass under way, from 1, and all passes; 1 of a contact at rest.
    trial : int
        The approach that is tried in this pass, from 1.
    solved, positions : int
        Positions solved in this trial, and positions of a pass; of a contact at rest increments or points.
    load : float
        Load at the position solved last, N.
    together : float or None
        Where all positions are solved as one problem, or one contact is being solved: the part of the way, 0 to 1.
    """

    pass_number: int
    passes: int
    trial: int
    solved: int
    positions: int
    load: float
    together: float | None

    @property
    def fraction(self) -> float:
        """Part of the whole computation that is done, 0 to 1: an estimate."""
        if self.together is not None and self.positions > 1 and self.passes > 1:
            done = 0.5 * self.together
        else:
            done = (self.solved + (self.together or 0.0)) / max(self.positions, 1)
        return min((self.pass_number - 1 + min(done, 1.0)) / max(self.passes, 1), 1.0)


Told = bool | Callable[[Progress], Any]
"""What `progress` may be: whether a bar is shown, or what is called with a :class:`Progress` some times a second."""


class Teller:
    """Calls back or moves a bar; used with ``with``, which takes the bar away."""

    def __init__(self, progress: Told) -> None:
        self._progress = progress
        self._began = time.monotonic()
        self._bar: Any = None

    def __enter__(self) -> Callable[..., None] | None:
        return None if self._progress is False else self._tell

    def __exit__(self, *_: object) -> None:
        if self._bar is not None:
            self._bar.close()

    def _tell(self, *numbers: Any) -> None:
        now = Progress(*numbers)
        if callable(self._progress):
            self._progress(now)
        elif self._bar is None:
            if time.monotonic() - self._began > _WAIT:
                self._bar = _bar()
        if self._bar is not None:
            self._bar.n = round(100 * now.fraction)
            if now.passes > 1:
                self._bar.set_description(f"pass {now.pass_number} of {now.passes}", refresh=False)
            self._bar.refresh()


def _bar() -> Any:
    """A bar in the terminal or the notebook, if someone can see it."""
    in_notebook = "ipykernel" in sys.modules
    if not in_notebook and not (sys.stderr is not None and sys.stderr.isatty()):
        return None
    try:
        from tqdm.auto import tqdm
    except ImportError:
        return None
    return tqdm(total=100, bar_format="{desc} {percentage:3.0f} %|{bar}| {elapsed}", leave=False)
