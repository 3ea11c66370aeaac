"""Bodies: surfaces with their material."""

from __future__ import annotations

import copy
from collections.abc import Mapping
from typing import TYPE_CHECKING, Any, Literal, cast

import numpy as np
from numpy.typing import ArrayLike

from . import keys
from ._keywords import takes, with_rows
from ._raise import bad_input
from ._same import Comparable
from .material import Material
from .surface import Surface

if TYPE_CHECKING:
    from typing_extensions import Unpack

Mount = Literal["turned-over", "as-is"]


class Body(Comparable):
    """A body: a surface with its material.

    Parameters
    ----------
    surface : Surface
        The heights.
    material : Material
        The material below the heights.
    mount : {"turned-over", "as-is"}, optional
        Orientation of the heights of an upper body. ``"turned-over"``: they are measured with the material below, and the body is
        turned over about y. ``"as-is"``: they are already the heights of the underside. By default an underside from results is
        taken as it is, and any other surface is turned over. A lower body does not use it.
    thermal : keys.Thermal, optional
        Thermal constants for a flash temperature: `conductivity`, W/(m K), `heat_capacity`, J/(kg K), and `density`, kg/m³. For heat
        that passes a contact `conductivity` alone, for a current `resistivity`, Ω m.
    **options
    """

    @takes(keys.OfBody)
    def __init__(
        self,
        surface: Surface,
        material: Material,
        mount: Mount | None = None,
        *,
        thermal: keys.Thermal | None = None,
        **options: Unpack[keys.OfBody],
    ) -> None:
        if not isinstance(surface, Surface):
            hint = "asp.Surface(heights, pitch=...) makes one of an array"
            message = f"'surface' is of type {type(surface).__name__}, expected an asperity.Surface"
            raise bad_input("surface", message, hint)
        if not isinstance(material, Material):
            message = f"'material' is of type {type(material).__name__}, expected an asperity.Material"
            raise bad_input("material", message, "for example asp.Material(young=\"210 GPa\", poisson=0.3)")
        self.surface = surface
        self.material = material
        self.mount = mount
        self.thermal = _copied(thermal)
        vars(self).update({name: _copied(table) for name, table in options.items()})

    def __repr__(self) -> str:
        mount = "" if self.mount is None else f", mount={self.mount!r}"
        return f"Body({self.surface!r}, {self.material!r}{mount})"


Body.__doc__ = with_rows(Body.__doc__ or "", keys.OfBody)


def _copied(table: object) -> dict[str, Any] | None:
    return None if table is None else copy.deepcopy(dict(cast(Mapping[str, Any], table)))


class Handed:
    """The bodies of a case: their tables, and the arrays that belong to them."""

    def __init__(self, lower: Body, upper: Body) -> None:
        self.tables: dict[str, Any] = {}
        self.topographies: dict[str, Any] = {}
        self.hardness: dict[str, Any] = {}
        for name, body in (("lower", lower), ("upper", upper)):
            self._add(name, body)

    def _add(self, name: str, body: Body) -> None:
        table = body.material._table()
        topography = dict(body.surface._table)
        heights = body.surface._handed()
        if heights is not None:
            topography["given"] = name
            self.topographies[name] = heights
        table["topography"] = topography
        hardness = body.material.hardness
        if isinstance(hardness, np.ndarray):
            if hardness.ndim != 2:
                message = f"'hardness' has {hardness.ndim} dimensions, expected a number, or a matrix [ix, iy]"
                raise bad_input(f"{name}.hardness", message)
            self.hardness[name] = hardness
            table["hardness"] = {"given": name}
        table |= {name: getattr(body, name) for name in keys.OfBody.__annotations__}
        table |= body.thermal or {}
        if name == "upper" and body.mount is not None:
            table["mount"] = body.mount
        self.tables[name] = table

    @property
    def given(self) -> dict[str, Any]:
        """The arrays for the compiled module."""
        return {"topographies": self.topographies, "hardness": self.hardness}


def bodies(lower: Any, upper: Any, lower_material: Material | None, upper_material: Material | None) -> tuple[Body, Body]:
    """Makes two bodies of bodies, or of surfaces with their materials."""
    return _body("lower", lower, lower_material), _body("upper", upper, upper_material)


def _body(name: str, given: Any, material: Material | None) -> Body:
    if isinstance(given, Body):
        if material is not None:
            message = f"'{name}_material' is given, but '{name}' is a body, which has a material"
            raise bad_input(f"{name}_material", message)
        return given
    if material is None:
        message = f"'{name}' has no material"
        hint = f"give asp.Body(surface, material), or a surface and '{name}_material'"
        raise bad_input(f"{name}_material", message, hint)
    return Body(given, material)


def heights_like(value: ArrayLike, shape: tuple[int, int], key: str) -> Any:
    """Makes a matrix of this shape. A number is used for all cells."""
    array = np.asarray(value, dtype=np.float64)
    if array.ndim > 0 and array.shape != shape:
        found = " × ".join(map(str, array.shape))
        message = f"'{key}' has the shape {found}, expected {shape[0]} × {shape[1]}, a value for each cell of the body"
        raise bad_input(key, message)
    if not np.isfinite(array).all():
        raise bad_input(key, f"'{key}' holds numbers that are not finite, expected lengths")
    return np.full(shape, float(array)) if array.ndim == 0 else array
