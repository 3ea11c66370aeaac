"""Curves of a study with matplotlib."""

from __future__ import annotations

from collections.abc import Mapping
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ._optional import need
from ._plot import axes, column, labelled
from ._raise import bad_input
from ._show import Scale, largest, scale, words

if TYPE_CHECKING:
    from matplotlib.axes import Axes


def study(
    table: NDArray[np.void],
    units: Mapping[str, str],
    known: Mapping[str, NDArray[Any]],
    quantity: str,
    x: str,
    color: str | None,
    ax: Axes | None,
    **options: Any,
) -> Axes:
    """Draws a column of the table of a study: a point for each case, and a line through the means over a `known` axis."""
    over = column(table, x, "x", "study")
    column(table, quantity, "quantity", "study")
    if table[quantity].dtype.kind not in "if":
        raise bad_input("quantity", f"'quantity' is {quantity!r}, expected a column of numbers")
    if color is not None and color not in known:
        raise bad_input("color", f"'color' is {color!r}, expected an axis of the study: {', '.join(known)}")
    ax = axes(ax)
    across, up = (_shown(table[name], units[name]) for name in (over, quantity))
    groups = [None] if color is None else list(known[color])
    colours = _colours(groups)
    for group, colour in zip(groups, colours, strict=True):
        rows = table if color is None else table[table[color] == group]
        rows = rows[np.isfinite(rows[quantity])]
        place, value = _scaled(rows[over], across), up.factor * rows[quantity]
        label = None if color is None else _value(group, _shown(known[color], units[color]))
        style = {"color": colour, **options}
        if over not in known:
            ax.plot(place, value, **{"marker": "o", "linestyle": "none", "label": label, **style})
            continue
        # A text stays where it is first seen, a number has its order.
        places = list(dict.fromkeys(place.tolist() if place.dtype.kind == "U" else sorted(place.tolist())))
        means = [float(value[place == one].mean()) for one in places]
        ax.plot(places, means, **{"label": label, **style})
        ax.plot(place, value, **{"marker": "o", "linestyle": "none", **style})
    ax.set(xlabel=labelled(_words(over), across.unit), ylabel=labelled(quantity, up.unit))
    if color is not None:
        ax.legend(title=labelled(_words(color), _shown(known[color], units[color]).unit))
    return ax


def _shown(values: NDArray[Any], unit: str) -> Scale:
    return scale(unit, largest(values)) if values.dtype.kind in "if" else Scale(1.0, "")


def _scaled(values: NDArray[Any], shown: Scale) -> NDArray[Any]:
    return shown.factor * values if values.dtype.kind in "if" else values


def _value(value: Any, shown: Scale) -> str:
    return str(value) if isinstance(value, str) else f"{shown.factor * float(value):.4g}"


def _words(key: str) -> str:
    """The key of an axis in words: ``lower.topography.sq`` is "Sq, lower body"."""
    *place, last = key.split(".")
    return words(f"{last}_{place[0]}" if place and place[0] in ("lower", "upper") else last)


def _colours(groups: list[Any]) -> list[Any]:
    """A colour for each group: a scale for numbers, distinct colours for texts."""
    if groups[0] is None:
        return ["C0"]
    if isinstance(groups[0], str):
        return [f"C{n}" for n in range(len(groups))]
    matplotlib = need("matplotlib", "plot()")
    return list(matplotlib.colormaps["viridis"](np.linspace(0.0, 0.85, len(groups))))
