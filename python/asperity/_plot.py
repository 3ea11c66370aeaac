"""Pictures by matplotlib."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ._optional import need
from ._show import Look, largest, look, scale, unit_of, words
from .errors import bad_input

if TYPE_CHECKING:
    from ._run import Run
    from .fields import Field

_MISSING = "0.75"
"""The grey of cells without a value."""


def _axes(ax: Any) -> Any:
    if ax is not None:
        return ax
    pyplot = need("matplotlib.pyplot", "plot()")
    return pyplot.subplots(layout="constrained")[1]


def _masked(values: NDArray[np.float64], factor: float, colours: Look) -> Any:
    """The values in the unit that is shown, without those that are left white."""
    return np.ma.masked_array(factor * values, colours.is_blank(values))


def _image(ax: Any, values: Any, colours: Look, factor: float, options: dict[str, Any]) -> Any:
    """A map on axes whose background is the colour of what is left out: zeros white, NaN grey."""
    matplotlib = need("matplotlib", "plot()")
    ax.set_facecolor(_MISSING if colours.blank is None else "white")
    name = options.pop("cmap", colours.colours)
    chosen = matplotlib.colormaps[name] if isinstance(name, str) else name
    chosen = chosen.with_extremes(bad=(1.0, 1.0, 1.0, 0.0), under=None if colours.blank is None else "crimson")
    if not {"vmin", "vmax", "norm"} & options.keys():
        options = {"vmin": factor * colours.low, "vmax": factor * colours.high, **options}
    filled = {"origin": "lower", "interpolation": "nearest", **options, "cmap": chosen}
    return ax.imshow(np.ma.masked_invalid(values).T, **filled)


def _bar(ax: Any, image: Any, values: Any, label: str) -> Any:
    """A colour bar as high as the map, pointed where values lie beyond its ends."""
    low, high = image.get_clim()
    below, above = values.min() < low, values.max() > high
    extend = ("neither", "max", "min", "both")[2 * bool(below) + bool(above)]
    beside = ax.inset_axes((1.03, 0.0, 0.05, 1.0))
    return ax.figure.colorbar(image, cax=beside, label=label, extend=extend)


def _labelled(name: str, unit: str) -> str:
    return words(name) if unit in ("", "1") else f"{words(name)} ({unit})"


def field(field: Field, ax: Any = None, **options: Any) -> Any:
    """Draw a field; gives the axes.

    A map has x to the right and y upwards, or, of a section, the depth downwards. Cells without a value are grey, those out of
    contact white. Below a row of points a curve is drawn over the depth.
    """
    ax = _axes(ax)
    values = np.asarray(field.values, dtype=np.float64)
    colours = look(field.name, values)
    value = scale(field.unit, max(abs(colours.low), abs(colours.high)))
    label = _labelled(field.name, value.unit)
    ends = [(origin - 0.5 * pitch, origin + (count - 0.5) * pitch)
            for origin, pitch, count in zip(field.origin, field.pitch, values.shape, strict=True)]  # fmt: skip
    length = scale("m", max(end - begin for begin, end in ends))
    if values.ndim == 1:
        depth = length.factor * field.coordinate(field.axes[0])
        ax.plot(value.factor * values, depth, **options)
        ax.set(xlabel=label, ylabel=f"{field.axes[0]} ({length.unit})")
        ax.yaxis.set_inverted(field.axes[0] == "z")
        return ax
    extent = [length.factor * end for pair in ends for end in pair]
    shown = _masked(values, value.factor, colours)
    missing = np.isnan(values)
    if colours.blank is not None and missing.any():
        grey = np.where(missing, float(_MISSING), np.nan)
        ax.imshow(grey.T, origin="lower", extent=extent, cmap="gray", vmin=0.0, vmax=1.0, interpolation="nearest")
    image = _image(ax, shown, colours, value.factor, {"extent": extent, **options})
    _bar(ax, image, np.ma.masked_invalid(shown), label)
    ax.set(xlabel=f"{field.axes[0]} ({length.unit})", ylabel=f"{field.axes[1]} ({length.unit})", aspect="equal")
    ax.yaxis.set_inverted(field.axes[1] == "z")
    return ax


def run(run: Run, quantity: str | None = None, ax: Any = None, **options: Any) -> Any:
    """Draw a column over the passes, or the load over the positions of first and last pass; gives the axes."""
    passes = run.passes
    if quantity is None:
        return _loads(run, ax, options)
    columns = [name for name in passes.dtype.names or () if name != "pass"]
    if quantity not in columns:
        message = f"'quantity' is {quantity!r}, expected a column of the passes: {', '.join(columns)}"
        raise bad_input("quantity", message)
    ax = _axes(ax)
    value = scale(unit_of(quantity), largest(passes[quantity]))
    ax.plot(passes["pass"], value.factor * passes[quantity], **{"marker": "o", **options})
    ax.xaxis.get_major_locator().set_params(integer=True)
    ax.set(xlabel="pass", ylabel=_labelled(quantity, value.unit))
    return ax


def _loads(run: Run, ax: Any, options: dict[str, Any]) -> Any:
    ax = _axes(ax)
    steps = run.steps
    length, force = scale("m", largest(steps["offset"])), scale("N", largest(steps["load"]))
    for number in sorted({1, len(run.passes)} - {0}):
        of_pass = steps[steps["pass"] == number]
        label = {"label": f"pass {number}"}
        ax.plot(length.factor * of_pass["offset"], force.factor * of_pass["load"], **{**label, **options})
    ax.set(xlabel=f"offset of the upper body ({length.unit})", ylabel=f"load ({force.unit})")
    ax.set_ylim(bottom=0.0)
    if len(run.passes) > 0:
        ax.legend()
    return ax


def animation(run: Run, number: int, interval: float = 100.0, **options: Any) -> Any:
    """Show the pressures kept in a pass one after the other, on the lower body; `interval` is the time of each, ms."""
    fields = run.fields(number)
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
    shown = [np.ma.masked_invalid(_masked(frame, pressure.factor, colours)) for frame in frames]
    image = _image(ax, shown[0], colours, pressure.factor, {"extent": extent, **options})
    ax.set_facecolor(_MISSING)
    under = ax.imshow(_facing(frames[0]), origin="lower", extent=extent, zorder=-1, interpolation="nearest")
    _bar(ax, image, shown[0], _labelled("pressure", pressure.unit))
    ax.set(xlabel=f"x ({length.unit})", ylabel=f"y ({length.unit})", aspect="equal")
    positions = int(run.steps["step"].max())

    def draw(index: int) -> list[Any]:
        image.set_data(shown[index].T)
        under.set_data(_facing(frames[index]))
        ax.set_title(f"pass {number}, position {int(names[index].rsplit('_', 1)[1])} of {positions}")
        return [image, under, ax.title]

    # In a notebook it plays; the picture that its figure would leave behind is not wanted there.
    film = type("Animation", (films.FuncAnimation,), {"_repr_html_": films.FuncAnimation.to_jshtml})
    made = film(figure, draw, frames=len(frames), interval=interval)
    if "inline" in pyplot.get_backend():
        pyplot.close(figure)
    return made


def _on_lower(pressure: Field, lower: Field) -> NDArray[np.float64]:
    """Pressures in the frame of the lower body, NaN where nothing faces it."""
    whole = np.full(lower.values.shape, np.nan)
    begin = [
        round((one - other) / pitch)
        for one, other, pitch in zip(pressure.origin, lower.origin, lower.pitch, strict=True)
    ]
    part = tuple(slice(first, first + count) for first, count in zip(begin, pressure.values.shape, strict=True))
    whole[part] = pressure.values
    return whole


def _facing(frame: NDArray[np.float64]) -> NDArray[np.float64]:
    """An image, white where the bodies face each other and clear elsewhere."""
    image = np.ones((*frame.T.shape, 4))
    image[..., 3] = np.isfinite(frame.T)
    return image
