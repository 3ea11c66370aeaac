"""Animations with matplotlib."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ._optional import need
from ._plot import MISSING, bar, labelled, map_of, masked
from ._raise import bad_input
from ._show import Look, Values, largest, scale

if TYPE_CHECKING:
    from matplotlib.animation import FuncAnimation


def animation(
    fields: Mapping[str, Values], steps: NDArray[np.void], number: int, interval: float = 100.0, **options: Any
) -> FuncAnimation:
    """Animates the kept pressures of a pass on the lower body. `interval` is the time of each, ms."""
    names = [name for name in fields if name.startswith("pressure_")]
    if not names:
        hint = "pressure_every=8 keeps those of every eighth position"
        raise bad_input("pressure_every", f"no pressures are kept of pass {number}", hint)
    pyplot = need("matplotlib.pyplot", "animate()")
    films = need("matplotlib.animation", "animate()")
    frames = [_on_lower(fields[name], fields["lower"]) for name in names]
    pressure = scale("Pa", max(largest(frame) for frame in frames))
    high = max(largest(frame) for frame in frames) or 1.0
    colours = Look("viridis", 0.0, high, 0.0)
    dx, dy = fields["lower"].pitch
    nx, ny = frames[0].shape
    length = scale("m", max(nx * dx, ny * dy))

    figure, ax = pyplot.subplots(layout="constrained")
    extent = [0.0, length.factor * nx * dx, 0.0, length.factor * ny * dy]
    shown = [np.ma.masked_invalid(masked(frame, pressure.factor, colours)) for frame in frames]
    image = map_of(ax, shown[0], colours, pressure.factor, {"extent": extent, **options})
    ax.set_facecolor(MISSING)
    under = ax.imshow(_facing(frames[0]), origin="lower", extent=extent, zorder=-1, interpolation="nearest")
    bar(ax, image, shown[0], labelled("pressure", pressure.unit))
    ax.set(xlabel=f"x ({length.unit})", ylabel=f"y ({length.unit})", aspect="equal")
    # The layout is computed once, with the longest title: computed for each frame it takes most of the time.
    positions = int(steps["step"].max())
    ax.set_title(f"pass {number}, position {positions} of {positions}", y=1.0)
    figure.draw_without_rendering()
    figure.set_layout_engine("none")

    def draw(index: int) -> list[Any]:
        image.set_data(shown[index].T)
        under.set_data(_facing(frames[index]))
        ax.set_title(f"pass {number}, position {int(names[index].rsplit('_', 1)[1])} of {positions}", y=1.0)
        return [image, under, ax.title]

    def save(film: Any, *arguments: Any, **more: Any) -> None:
        # The writer draws each frame; without this matplotlib draws it for the screen too.
        figure.canvas.draw_idle = lambda: None
        try:
            films.FuncAnimation.save(film, *arguments, **more)
        finally:
            del figure.canvas.draw_idle

    # In a notebook the animation plays, and its figure is not shown a second time.
    film = type("Animation", (films.FuncAnimation,), {"_repr_html_": films.FuncAnimation.to_jshtml, "save": save})
    made: FuncAnimation = film(figure, draw, frames=len(frames), interval=interval)
    if "inline" in pyplot.get_backend():
        pyplot.close(figure)
    return made


def _on_lower(pressure: Values, lower: Values) -> NDArray[np.float64]:
    """Pressures in the frame of the lower body, NaN outside the overlap."""
    whole = np.full(lower.values.shape, np.nan)
    begin = [
        round((one - other) / pitch)
        for one, other, pitch in zip(pressure.origin, lower.origin, lower.pitch, strict=True)
    ]
    part = tuple(slice(first, first + count) for first, count in zip(begin, pressure.values.shape, strict=True))
    whole[part] = pressure.values
    return whole


def _facing(frame: NDArray[np.float64]) -> NDArray[np.float64]:
    """An image that is white in the overlap and transparent elsewhere."""
    image = np.ones((*frame.T.shape, 4))
    image[..., 3] = np.isfinite(frame.T)
    return image
