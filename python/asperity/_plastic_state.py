"""The plastic state of elasto-plastic bodies."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Annotated, Any

import numpy as np
from numpy.typing import NDArray

from ._described import described
from ._same import Comparable


@described
class PlasticState(Comparable):
    """The plastic state below the surface of an elasto-plastic body."""

    depths: Annotated[NDArray[np.float64], "Depths of the faces of the layers, from 0 at the surface, m."]
    strain: Annotated[NDArray[np.float64],
        "Plastic strain under the last load, ``[component, ix, iy, iz]``, with the components of `COMPONENTS`."]
    accumulated: Annotated[NDArray[np.float64], "Accumulated plastic strain, ``[ix, iy, iz]``."]
    back_stress: Annotated[NDArray[np.float64] | None,
        "Back stress of a body with kinematic hardening, Pa, ``[component, ix, iy, iz]``."]
    displacement: Annotated[NDArray[np.float64],
        "Inward displacement of the surface by the plastic strain under the last load, m, ``[ix, iy]``."]
    residual_stress: Annotated[NDArray[np.float64],
        "Residual stress of the plastic strain, Pa, ``[component, ix, iy, iz]``; after unloading, if the load is "
        "removed."]
    residual_displacement: Annotated[NDArray[np.float64],
        "Inward displacement of the surface by the plastic strain, m, ``[ix, iy]``; after unloading, if the load is "
        "removed."]

    COMPONENTS = ("xx", "yy", "zz", "yz", "xz", "xy")

    def __init__(self, depths: Sequence[float], back_stress: NDArray[np.float64] | None = None, **arrays: NDArray[np.float64]) -> None:
        self.depths = np.array(depths, dtype=np.float64)
        self.back_stress = back_stress
        vars(self).update(arrays)

    def __repr__(self) -> str:
        nx, ny, nz = self.accumulated.shape
        return f"<PlasticState: {nx} × {ny} × {nz} cells, largest plastic strain {self.accumulated.max():.3g}>"


def of_results(core: Any, number: int | None) -> dict[str, PlasticState]:
    """Reads the plastic state of a static contact, or after a pass, from a results directory."""
    if "plasticity" not in core.case():
        return {}
    names = set(core.names("plasticity", number))
    attributes = core.attributes("plasticity", number)

    def read(name: str) -> NDArray[np.float64]:
        values: NDArray[np.float64] = core.read("plasticity", number, name)[0]
        return values

    def tensor(name: str, body: str) -> NDArray[np.float64]:
        return np.stack([read(f"{name}_{component}_{body}") for component in PlasticState.COMPONENTS])

    return {
        body: PlasticState(
            depths=attributes[f"depths_{body}"],
            strain=tensor("strain", body),
            accumulated=read(f"accumulated_{body}"),
            back_stress=tensor("back_stress", body) if f"back_stress_xx_{body}" in names else None,
            displacement=read(f"displacement_{body}"),
            residual_stress=tensor("residual_stress", body),
            residual_displacement=read(f"residual_displacement_{body}"),
        )
        for body in ("lower", "upper")
        if f"accumulated_{body}" in names
    }
