"""Quantities: numbers in SI, or text with a unit."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any

from . import _core

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
        from .errors import _make

        message = f"'{key}' has {len(value)} values, expected a length above 0 such as \"0.25 um\", or two"
        raise _make("CaseError", message, {"key": key}, None)
    return quantity(key, value[0], "length"), quantity(key, value[1], "length")
