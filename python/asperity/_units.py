"""Quantities: numbers in SI, or text with a unit."""

from __future__ import annotations

import math
import os
from collections.abc import Sequence
from typing import Any

import numpy as np
from numpy.typing import NDArray

from . import _core
from ._raise import bad_input

Quantity = float | str
"""A number in SI units, or text with a unit such as ``"210 GPa"``."""

Pair = Quantity | Sequence[Quantity]
"""One quantity for x and y, or one for each."""


def quantity(key: str, value: Any, dimension: str, *, positive: bool = True, infinite: bool = False) -> float:
    """`value` in SI; mistakes name the `key`."""
    return _core.quantity(key, value, dimension, positive, infinite)


def written(value: float, dimension: str) -> str:
    """`value` as Python code: a text with a suitable unit if it means exactly this value, else the number."""
    text: str = _core.format(value, dimension)
    return repr(text) if _core.quantity("value", text, dimension, False, True) == value else repr(value)


def lengths(key: str, value: Pair) -> tuple[float, float]:
    """One length for x and y, or one for each, in metres."""
    if isinstance(value, (str, float, int)) or not hasattr(value, "__len__") or np.ndim(value) == 0:
        both = quantity(key, value, "length")
        return both, both
    if len(value) != 2:
        message = f"'{key}' has {len(value)} values, expected a length above 0 such as \"0.25 um\", or two"
        raise bad_input(key, message)
    return quantity(key, value[0], "length"), quantity(key, value[1], "length")


def number(key: str, value: Any, expected: str, least: float, most: float = math.inf) -> float:
    """A number without a unit within bounds; errors name the `key` and the `expected` value."""
    try:
        found = float(value)
    except (TypeError, ValueError):
        found = math.nan
    if not least <= found <= most or math.isinf(found):
        raise bad_input(key, f"'{key}' is {value!r}, expected {expected}")
    return found


def whole(key: str, value: Any, least: int, instead: str = "", most: int | None = None) -> int:
    """A whole number from `least` to `most`; `instead` names other accepted values."""
    try:
        found = None if isinstance(value, (bool, np.bool_)) else int(value.__index__())
    except (AttributeError, TypeError):
        found = None
    if found is None or found < least or (most is not None and found > most):
        expected = f"of at least {least}" if most is None else f"from {least} to {most}"
        raise bad_input(key, f"'{key}' is {value!r}, expected a whole number {expected}{instead}")
    return found


def choice(key: str, value: Any, *words: str) -> None:
    """Raises an exception unless the value is one of the words."""
    if value not in words:
        expected = " or ".join(f'"{word}"' for word in words)
        raise bad_input(key, f"'{key}' is {value!r}, expected {expected}")


def edges(boundary: Any) -> list[str]:
    """The boundary along x and along y: one word for both, or one for each; free by default."""
    one = "free" if boundary is None else boundary
    both = [one, one] if isinstance(one, str) else list(one)
    if len(both) != 2 or any(edge not in ("free", "periodic") for edge in both):
        expected = 'expected "free" or "periodic", or one of them for each axis'
        raise bad_input("boundary", f"'boundary' is {boundary!r}, {expected}")
    return both


def matrix(key: str, values: Any, like: tuple[str, tuple[int, ...]] | None = None) -> NDArray[np.float64]:
    """A matrix of numbers, with the shape of the matrix that `like` names if it is given."""
    try:
        found = np.asarray(values, dtype=np.float64)
    except (TypeError, ValueError) as error:
        raise bad_input(key, f"'{key}' is no matrix of numbers: {error}") from error
    if found.ndim != 2 or 0 in found.shape:
        raise bad_input(key, f"'{key}' has the shape {found.shape}, expected a matrix [ix, iy]")
    if like is not None and found.shape != like[1]:
        raise bad_input(key, f"'{key}' has the shape {found.shape}, expected that of the {like[0]}, {like[1]}")
    return found


def path(key: str, value: Any) -> str:
    """The path of a file or a directory as text.

    Raises
    ------
    TypeError
        If the value is neither a text nor a path, such as bytes.
    """
    found = os.fspath(value) if isinstance(value, (str, os.PathLike)) else None
    if not isinstance(found, str):
        raise TypeError(f"'{key}' is of type {type(value).__name__}, expected a text or a path")
    return found
