"""Quantities: numbers in SI, or text with a unit."""

from __future__ import annotations

import math
from collections.abc import Sequence
from typing import Any

from . import _core
from .errors import bad_input

Quantity = float | str
"""A number in SI units, or text with a unit such as ``"210 GPa"``."""

Pair = Quantity | Sequence[Quantity]
"""One quantity for x and y, or one for each."""


def quantity(key: str, value: Any, dimension: str, *, positive: bool = True, infinite: bool = False) -> float:
    """`value` in SI; mistakes name the `key`."""
    return _core.quantity(key, value, dimension, positive, infinite)


def lengths(key: str, value: Pair) -> tuple[float, float]:
    """One length for x and y, or one for each, in metres."""
    if isinstance(value, (str, float, int)) or not hasattr(value, "__len__"):
        both = quantity(key, value, "length")
        return both, both
    if len(value) != 2:
        message = f"'{key}' has {len(value)} values, expected a length above 0 such as \"0.25 um\", or two"
        raise bad_input(key, message)
    return quantity(key, value[0], "length"), quantity(key, value[1], "length")


def number(key: str, value: Any, expected: str, least: float, most: float = math.inf) -> float:
    """A number without a unit within bounds; mistakes name the `key` and what was `expected`."""
    try:
        found = float(value)
    except (TypeError, ValueError):
        found = math.nan
    if not least <= found <= most or math.isinf(found):
        raise bad_input(key, f"'{key}' is {value!r}, expected {expected}")
    return found


def whole(key: str, value: Any, least: int, instead: str = "") -> int:
    """A whole number of at least `least`; `instead` says what else would do."""
    if isinstance(value, bool) or not hasattr(value, "__index__") or value.__index__() < least:
        raise bad_input(key, f"'{key}' is {value!r}, expected a whole number of at least {least}{instead}")
    return int(value.__index__())
