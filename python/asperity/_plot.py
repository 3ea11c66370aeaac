"""Maps and curves with matplotlib."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ._optional import need
from ._raise import bad_input
from ._show import Look, Values, largest, look, scale, unit_of, words

if TYPE_CHECKING:
    from matplotlib.axes import Axes

MISSING = "0.75"
"""The grey of cells without a value."""


def axes(ax: Axes | None) -> Axes:
    """The axes that are given, or new ones."""
    if ax is not None:
        return ax
    pyplot = need("matplotlib.pyplot", "plot()")
    made: Axes = pyplot.subplots(layout="constrained")[1]
    return made


def masked(values: NDArray[np.float64], factor: float, colours: Look) -> Any:
    """The values in the unit that is shown, without those that are left white."""
    return np.ma.masked_array(factor * values, colours.is_blank(values))


def map_of(ax: Any, values: Any, colours: Look, factor: float, options: dict[str, Any]) -> Any:
    """A map on axes whose background shows omitted cells: zeros white, NaN grey."""
    matplotlib = need("matplotlib", "plot()")
    ax.set_facecolor(MISSING if colours.blank is None else "white")
    name = options.pop("cmap", colours.colours)
    chosen = matplotlib.colormaps[name] if isinstance(name, str) else name
    chosen = chosen.with_extremes(bad=(1.0, 1.0, 1.0, 0.0), under=None if colours.blank is None else "crimson")
    if not {"vmin", "vmax", "norm"} & options.keys():
        options = {"vmin": factor * colours.low, "vmax": factor * colours.high, **options}
    filled = {"origin": "lower", "interpolation": "nearest", **options, "cmap": chosen}
    return ax.imshow(np.ma.masked_invalid(values).T, **filled)


def bar(ax: Any, image: Any, values: Any, label: str) -> Any:
    """A colour bar as high as the map, pointed where values lie beyond its ends."""
    low, high = image.get_clim()
    below, above = values.min() < low, values.max() > high
    extend = ("neither", "max", "min", "both")[2 * bool(below) + bool(above)]
    beside = ax.inset_axes((1.03, 0.0, 0.05, 1.0))
    return ax.figure.colorbar(image, cax=beside, label=label, extend=extend)


def labelled(name: str, unit: str) -> str:
    return words(name) if unit in ("", "1") else f"{words(name)} ({unit})"


def field(field: Values, ax: Axes | None = None, **options: Any) -> Axes:
    """Draws a field and returns the axes.

    In a map x points to the right and y up; in a section the depth points down. Cells without a value are grey, cells without
    contact are white. A column of points is drawn as a curve over the depth.
    """
    ax = axes(ax)
    values = np.asarray(field.values, dtype=np.float64)
    colours = look(field.name, values)
    value = scale(field.unit, max(abs(colours.low), abs(colours.high)))
    label = labelled(field.name, value.unit)
    ends = [(origin - 0.5 * pitch, origin + (count - 0.5) * pitch)
            for origin, pitch, count in zip(field.origin, field.pitch, values.shape, strict=True)]  # fmt: skip
    length = scale("m", max(end - begin for begin, end in ends))
    if values.ndim == 1:
        depth = length.factor * field.coordinate(field.axes[0])
        ax.plot(value.factor * values, depth, **options)
        ax.set(xlabel=label, ylabel=f"{field.axes[0]} ({length.unit})")
        ax.yaxis.set_inverted(field.axes[0] == "z")
        return ax
    extent: Any = [length.factor * end for pair in ends for end in pair]
    shown = masked(values, value.factor, colours)
    missing = np.isnan(values)
    if colours.blank is not None and missing.any():
        grey = np.where(missing, float(MISSING), np.nan)
        ax.imshow(grey.T, origin="lower", extent=extent, cmap="gray", vmin=0.0, vmax=1.0, interpolation="nearest")
    image = map_of(ax, shown, colours, value.factor, {"extent": extent, **options})
    bar(ax, image, np.ma.masked_invalid(shown), label)
    ax.set(xlabel=f"{field.axes[0]} ({length.unit})", ylabel=f"{field.axes[1]} ({length.unit})", aspect="equal")
    ax.yaxis.set_inverted(field.axes[1] == "z")
    return ax


def over_passes(
    passes: NDArray[np.void], quantity: str, before: float | None = None, ax: Axes | None = None, **options: Any
) -> Axes:
    """Draws a column over the passes, after its value `before` the first one if there is such; returns the axes."""
    column(passes, quantity, "quantity", "passes", but="pass")
    # An accelerated run computes only some of its passes.
    number = np.cumsum(passes["represents"]) if "represents" in (passes.dtype.names or ()) else passes["pass"]
    values = passes[quantity]
    if before is not None:
        number, values = np.insert(number, 0, 0), np.insert(values, 0, before)
    ax = axes(ax)
    value = scale(unit_of(quantity), largest(values))
    ax.plot(number, value.factor * values, **{"marker": "o", **options})
    locator: Any = ax.xaxis.get_major_locator()
    locator.set_params(integer=True)
    ax.set(xlabel="pass", ylabel=labelled(quantity, value.unit))
    return ax


def loads(steps: NDArray[np.void], last: int, ax: Axes | None = None, **options: Any) -> Axes:
    """Draws the load over the positions of the first and the `last` pass; returns the axes."""
    ax = axes(ax)
    length, force = scale("m", largest(steps["offset"])), scale("N", largest(steps["load"]))
    for number in sorted({1, last} - {0}):
        of_pass = steps[steps["pass"] == number]
        label = {"label": f"pass {number}"}
        ax.plot(length.factor * of_pass["offset"], force.factor * of_pass["load"], **{**label, **options})
    ax.set(xlabel=f"offset of the upper body ({length.unit})", ylabel=f"load ({force.unit})")
    ax.set_ylim(bottom=0.0)
    if last > 0:
        ax.legend()
    return ax


_OVER = {
    "step": ["offset"], "update": ["distance"], "point": ["load", "creepage_x", "creepage_y"], "pass": [], "increment": [],
}  # fmt: skip
"""By the column that numbers the records: the columns over which curves are drawn, the first that varies."""


def curve(table: NDArray[np.void], quantity: str, x: str | None = None, ax: Axes | None = None, **options: Any) -> Axes:
    """Draws a column of a table over another one; returns the axes."""
    column(table, quantity, "quantity", "table")
    over = _over(table, quantity) if x is None else column(table, x, "x", "table")
    ax = axes(ax)
    scales = [scale(unit_of(name), largest(table[name])) for name in (over, quantity)]
    ax.plot(scales[0].factor * table[over], scales[1].factor * table[quantity], **{"marker": "o", **options})
    ax.set(xlabel=labelled(over, scales[0].unit), ylabel=labelled(quantity, scales[1].unit))
    return ax


def _over(table: NDArray[np.void], quantity: str) -> str:
    names = table.dtype.names or ()
    index = next((name for name in _OVER if name in names), names[0])
    # A load that is held varies by the tolerance of the solver.
    others = [name for name in _OVER.get(index, []) if name in names and name != quantity]
    return next((name for name in others if np.ptp(table[name]) > 1e-3 * largest(table[name])), index)


def column(table: NDArray[np.void], name: str, argument: str, noun: str, but: str = "") -> str:
    """Returns the name of a column, or raises an exception that lists the columns."""
    columns = [known for known in table.dtype.names or () if known != but]
    if name not in columns:
        raise bad_input(argument, f"'{argument}' is {name!r}, expected a column of the {noun}: {', '.join(columns)}")
    return name
