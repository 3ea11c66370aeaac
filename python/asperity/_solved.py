"""What other computations take from a solved contact."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ._same import Comparable


class Solved(Comparable):
    """A solved contact: its pressure, cells in contact, gap, pitch and case."""

    case: dict[str, Any]

    @property
    def pressure(self) -> NDArray[np.float64]:
        """Pressure on each cell, Pa, ``[ix, iy]``."""
        raise NotImplementedError

    @property
    def touching(self) -> NDArray[np.bool_]:
        """Whether each cell is in contact. If the bodies attract each other, such a cell may be under tension."""
        raise NotImplementedError

    @property
    def gap(self) -> NDArray[np.float64]:
        """Gap between the deformed surfaces, m. It is 0 in contact, and negative where cells yield."""
        raise NotImplementedError

    @property
    def pitch(self) -> tuple[float, float]:
        """Size of a cell along x and y, m."""
        raise NotImplementedError
