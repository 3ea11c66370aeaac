"""Comparison of objects that hold arrays."""

from __future__ import annotations

from functools import cached_property
from typing import Any

import numpy as np


def same(one: Any, other: Any) -> bool:
    """Whether two values are equal, arrays number by number; a NaN equals a NaN."""
    if isinstance(one, np.ndarray) or isinstance(other, np.ndarray):
        one, other = np.asarray(one), np.asarray(other)
        if one.shape != other.shape or one.dtype != other.dtype:
            return False
        if one.dtype.names is not None:
            return all(same(one[name], other[name]) for name in one.dtype.names)
        return bool(np.array_equal(one, other, equal_nan=one.dtype.kind in "fc"))
    if isinstance(one, dict) and isinstance(other, dict):
        return one.keys() == other.keys() and all(same(value, other[key]) for key, value in one.items())
    if isinstance(one, (list, tuple)) and isinstance(other, (list, tuple)):
        return len(one) == len(other) and all(map(same, one, other))
    if isinstance(one, float) and isinstance(other, float) and one != one and other != other:
        return True
    return bool(one == other)


class Comparable:
    """Equal where all attributes are; not hashable, since arrays are not."""

    __hash__ = None  # type: ignore[assignment]

    def __eq__(self, other: object) -> bool:
        if not isinstance(other, Comparable) or type(self) is not type(other):
            return NotImplemented
        return same(self._compared(), other._compared())

    def _compared(self) -> dict[str, Any]:
        """What decides whether two are equal."""
        return vars(self)


class Cached(Comparable):
    """Pickled and copied without its cached properties."""

    def __getstate__(self) -> dict[str, Any]:
        cached = {name for name in vars(self) if isinstance(getattr(type(self), name, None), cached_property)}
        return {name: value for name, value in vars(self).items() if name not in cached}
