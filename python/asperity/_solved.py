"""What other computations take from a solved contact."""

from __future__ import annotations

from typing import Any

import numpy as np
from numpy.typing import NDArray

from ._same import Comparable
from .fields import Fields


class Solved(Comparable):
    """A solved contact: its pressure, cells in contact, gap, pitch and case."""

    case: dict[str, Any]
    fields: Fields

    @property
    def pressure(self) -> NDArray[np.float64]:
        """Pressure on each cell, Pa, ``[ix, iy]``."""
        return self.fields["pressure"].values

    @property
    def gap(self) -> NDArray[np.float64]:
        """Gap between the deformed surfaces, m. It is 0 in contact, and negative where cells yield."""
        return self.fields["gap"].values

    @property
    def pitch(self) -> tuple[float, float]:
        """Size of a cell along x and y, m."""
        x, y = self.fields["pressure"].pitch
        return x, y

    @property
    def touching(self) -> NDArray[np.bool_]:
        """Whether each cell is in contact. If the bodies attract each other, such a cell may be under tension."""
        return np.asarray((self.fields["contact"].values if "contact" in self.fields else self.pressure) > 0.0)
