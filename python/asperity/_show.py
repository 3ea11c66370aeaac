"""What pictures and tables share: words, units that suit, colours."""

from __future__ import annotations

import re
from typing import Any, NamedTuple, Protocol

import numpy as np
from numpy.typing import NDArray

from . import _core

_POWER = {"m²": 2, "m³": 3}
"""A prefix stands before the metre, and is raised with it."""

_PREFIXES = {-9: "n", -6: "µ", -3: "m", 0: "", 3: "k", 6: "M", 9: "G"}


class Values(Protocol):
    """A field: values on a grid, with their unit."""

    name: str
    values: NDArray[np.float64]
    unit: str
    axes: tuple[str, ...]
    pitch: tuple[float, ...]
    origin: tuple[float, ...]

    def coordinate(self, axis: str) -> NDArray[np.float64]: ...


class Scale(NamedTuple):
    """A suitable unit of some numbers: its factor and its name."""

    factor: float
    unit: str


def scale(unit: str, largest: float) -> Scale:
    """The unit in which a number `largest` is read best: 1 to 1000 of a length, 0.001 to 10⁶ of a volume."""
    if unit not in ("m", "m²", "m³", "Pa", "N", "J", "s", "N m") or not np.isfinite(largest) or largest <= 0.0:
        return Scale(1.0, unit)
    power = _POWER.get(unit, 1)
    # Rounded up a little: 0.9999999 µm is 1 µm.
    step = 3 * int(np.floor((np.log10(largest) / power + 0.5 * (power - 1) + 1e-6) / 3))
    exponent = min(max(step, -9), 9 if unit == "Pa" else 3 if unit == "N" else 0)
    return Scale(10.0 ** (-exponent * power), _PREFIXES[exponent] + unit)


def largest(values: NDArray[Any]) -> float:
    """The largest magnitude of the numbers that are there; 0 of none."""
    finite = np.abs(values[np.isfinite(values)])
    return float(finite.max()) if finite.size else 0.0


def unit_of(column: str) -> str:
    """The SI unit of a column of the tables of results: ``"1"`` of a pure number, nothing of a text or of an unknown column."""
    return _core.unit_of_column(column) or ""


_NAMES = {
    "lower": "height of the lower body",
    "upper": "underside of the upper body",
    "heights": "height",
    "plastic": "plastic interference",
    "stick": "stick",
    "contact": "contact",
    "cap": "largest pressure of a cell",
    "section_von_mises": "von Mises stress",
}


def words(name: str) -> str:
    """The name of a field or a column as people say it."""
    if name in _NAMES:
        return _NAMES[name]
    kept = re.fullmatch(r"(.*)_(\d{5})", name)
    if kept is not None:
        return f"{words(kept[1])} at position {int(kept[2])}"
    of_body = re.fullmatch(r"(.*)_(lower|upper)(_interior)?", name)
    if of_body is not None:
        where = "interior of the " if of_body[3] else ""
        what = "Sq" if of_body[1] == "sq" else words(of_body[1])
        return f"{what}, {where}{of_body[2]} body"
    stress = re.fullmatch(r"(?:section|column_\d+)_([xyz])([xyz])", name)
    if stress is not None:
        return f"stress σ{stress[1]}{stress[2]}"
    deep = re.fullmatch(r"von_mises_(\d+)", name)
    if deep is not None:
        return f"von Mises stress in plane {int(deep[1])}"
    name = re.sub(r"^(wall_time|min|max)(_s)?", lambda found: found[1].replace("wall_time", "time"), name)
    return re.sub(r"\bmin ", "least ", re.sub(r"\bmax ", "largest ", name.replace("_", " ")))


class Look(NamedTuple):
    """Colours of a field: a colour map and its range; magnitudes up to `blank` are white."""

    colours: str
    low: float
    high: float
    blank: float | None = None

    def is_blank(self, values: NDArray[np.float64]) -> NDArray[np.bool_]:
        """Which of the values are left white."""
        if self.blank is None:
            return np.zeros(values.shape, dtype=bool)
        return np.asarray(np.abs(values) <= self.blank)


def look(name: str, values: NDArray[np.float64]) -> Look:
    """How a field of this name is coloured.

    Pressures and other fields that are zero without contact begin at zero, which is white. Heights, gaps and displacements go
    from the smallest to the largest value. Signed fields have zero in the middle.
    """
    finite = values[np.isfinite(values)]
    if finite.size == 0:
        return Look("viridis", 0.0, 1.0)
    low, high = float(finite.min()), float(finite.max())
    if name == "pressure" and low < 0.0:
        # A tension would be pale beside a pressure that is much larger.
        end = max(min(high, -4.0 * low), -low)
        return Look("RdBu_r", -end, end)
    if re.match(r"(mean_)?pressure|plastic|stick|contact|cap|(section_)?von_mises", name):
        return Look("viridis", 0.0, high or 1.0, None if "von_mises" in name else 0.0)
    if name == "gap":
        # In contact it is 0 within the residual of the solver, or negative by the plastic interference.
        high = max(high, 0.0) or 1.0
        return Look("viridis", 0.0, high, 1e-4 * high)
    if re.match(r"traction|slip|section|column|displacement_[xy]", name) and low < 0.0:
        return Look("RdBu_r", -max(-low, high), max(-low, high))
    if name in ("lower", "upper", "heights"):
        # A few samples that stand out would leave one colour to all others.
        inner = np.quantile(finite, [0.001, 0.999])
        if inner[1] - inner[0] < 0.5 * (high - low) and inner[1] > inner[0]:
            low, high = float(inner[0]), float(inner[1])
        return Look("cividis", low, high if high > low else low + 1e-9)
    return Look("viridis", low, high if high > low else low + (abs(low) or 1.0))
