"""Results as data sets of xarray and frames of pandas."""

from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import NDArray

from ._optional import need
from ._show import unit_of

if TYPE_CHECKING:
    from ._run import Run


def run(run: Run) -> Any:
    """The passes over `pass`; the surfaces over `after`, the number of passes that they have seen, from 0.

    Each body has coordinates of its own, from its own corner.
    """
    xarray = need("xarray", "to_xarray()")
    passes = run.passes
    columns = {
        name: ("pass", passes[name], {"units": unit_of(name)}) for name in passes.dtype.names or () if name != "pass"
    }
    coordinates: dict[str, Any] = {"pass": passes["pass"], "after": np.arange(len(passes) + 1)}
    after = [run.fields(number) for number in range(len(passes) + 1)]
    surfaces = {}
    for body in ("lower", "upper"):
        first = after[0][body]
        axes = [f"{axis}_{body}" for axis in first.axes]
        for axis, own in zip(first.axes, axes, strict=True):
            coordinates[own] = (own, first.coordinate(axis), {"units": "m"})
        heights = np.stack([fields[body].values for fields in after])
        surfaces[body] = (("after", *axes), heights, {"units": first.unit})
    attributes = {"title": run.case["title"], "identity": run.case["identity"]}
    return xarray.Dataset({**columns, **surfaces}, coordinates, attributes)


def frame(table: NDArray[np.void], index: str) -> Any:
    """A structured array as a DataFrame, with its units as the attribute `units`."""
    pandas = need("pandas", "to_pandas()")
    made = pandas.DataFrame(table).set_index(index)
    made.attrs["units"] = {name: unit_of(name) for name in made.columns}
    return made
