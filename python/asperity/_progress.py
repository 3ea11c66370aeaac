"""Progress of a computation: a bar of tqdm, or a function of the caller."""

from __future__ import annotations

import sys
import time
from collections.abc import Callable
from typing import Annotated, Any, NamedTuple

from ._described import described

_WAIT = 0.5
"""Computations shorter than this, in seconds, show nothing."""


@described
class Progress(NamedTuple):
    """Progress of a computation."""

    pass_number: Annotated[int, "The present pass, from 1; 1 for a static contact."]
    passes: Annotated[int, "Number of passes; 1 for a static contact."]
    trial: Annotated[int, "Number of the approach that is tried in this pass, from 1."]
    solved: Annotated[int, "Number of positions solved in this trial. A static contact has increments or points instead."]
    positions: Annotated[int, "Number of positions in a pass. A static contact has increments or points instead."]
    load: Annotated[float, "Load at the last solved position, N."]
    together: Annotated[float | None,
        "Fraction of the present solution, 0 to 1, if all positions are solved together or one contact is solved."]

    @property
    def fraction(self) -> float:
        """Estimated fraction of the whole computation that is done, 0 to 1."""
        if self.together is not None and self.positions > 1 and self.passes > 1:
            done = 0.5 * self.together
        else:
            done = (self.solved + (self.together or 0.0)) / max(self.positions, 1)
        return min((self.pass_number - 1 + min(done, 1.0)) / max(self.passes, 1), 1.0)


Told = bool | Callable[[Progress], Any]
"""The argument `progress`: whether a bar is shown, or a function that is called with a :class:`Progress` a few times a second."""


class Teller:
    """Calls the function of the caller or updates a bar. A context manager that removes the bar at its end."""

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
    """Makes a bar in a terminal or a notebook, else returns `None`."""
    in_notebook = "ipykernel" in sys.modules
    if not in_notebook and not (sys.stderr is not None and sys.stderr.isatty()):
        return None
    try:
        from tqdm.auto import tqdm
    except ImportError:
        return None
    return tqdm(total=100, bar_format="{desc} {percentage:3.0f} %|{bar}| {elapsed}", leave=False)
