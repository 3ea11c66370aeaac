"""Functions of positions: a number gives a number, an array an array of the same shape."""

from __future__ import annotations

from collections.abc import Callable
from typing import Any, TypeVar

import numpy as np
from numpy.typing import NDArray

Point = TypeVar("Point", float, NDArray[np.float64])
"""A number, or an array of them."""


def spread(places: tuple[Any, ...], answer: Callable[[NDArray[np.float64]], NDArray[np.float64]]) -> Any:
    """What `answer` makes of each point: rows of coordinates in, rows of numbers out.

    `places` are numbers or arrays, which are broadcast as in NumPy. For more than one
    number there is a tuple.
    """
    arrays = np.broadcast_arrays(*(np.asarray(place, dtype=np.float64) for place in places))
    shape = arrays[0].shape if arrays else ()
    rows = np.empty((1, 0)) if not arrays else np.stack([array.ravel() for array in arrays], axis=-1)
    # Without points, the result of one point determines the number of values.
    columns = answer(rows).T if len(rows) else answer(np.full((1, rows.shape[1]), np.nan)).T[:, :0]
    parts = tuple(column.reshape(shape) if shape else float(column[0]) for column in columns)
    return parts[0] if len(parts) == 1 else parts
