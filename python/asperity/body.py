"""A body: a surface of a material."""

from __future__ import annotations

import copy
from collections.abc import Mapping
from typing import Any, Literal

import numpy as np
from numpy.typing import ArrayLike

from ._same import Comparable
from .errors import bad_input
from .material import Material
from .surface import Surface

Mount = Literal["turned-over", "as-is"]


class Body(Comparable):
    """A surface of a material.

    Parameters
    ----------
    surface : Surface
        The heights.
    material : Material
        What is below them.
    mount : {"turned-over", "as-is"}, optional
        How the heights of an upper body face: measured material side up and turned over about y when it is mounted, or the
        heights of its underside already. Without it, an underside from results is taken as it is, and all else turned over. It
        means nothing of a lower body.
    wear : mapping, optional
        How it wears, with the keys of `[lower.wear]`: `coefficient`, `dimensionless` or `energy`; `under_film`.
    film : mapping, optional
        The tribofilm that grows on it, with the keys of `[lower.film]`.
    thermal : mapping, optional
        `conductivity`, W/(m K), `heat_capacity`, J/(kg K), and `density`, kg/m³, for a flash temperature.
    """

    def __init__(
        self,
        surface: Surface,
        material: Material,
        mount: Mount | None = None,
        *,
        wear: Mapping[str, Any] | None = None,
        film: Mapping[str, Any] | None = None,
        thermal: Mapping[str, Any] | None = None,
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
        self.wear = _copied(wear)
        self.film = _copied(film)
        self.thermal = _copied(thermal)

    def __repr__(self) -> str:
        mount = "" if self.mount is None else f", mount={self.mount!r}"
        return f"Body({self.surface!r}, {self.material!r}{mount})"


def _copied(table: Mapping[str, Any] | None) -> dict[str, Any] | None:
    return None if table is None else copy.deepcopy(dict(table))


class Handed:
    """The bodies of a case as its tables, and what is handed over beside them."""

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
        table |= {"wear": body.wear, "film": body.film, **(body.thermal or {})}
        if name == "upper" and body.mount is not None:
            table["mount"] = body.mount
        self.tables[name] = table

    @property
    def given(self) -> dict[str, Any]:
        """What the compiled module takes."""
        return {"topographies": self.topographies, "hardness": self.hardness}


def bodies(lower: Any, upper: Any, lower_material: Material | None, upper_material: Material | None) -> tuple[Body, Body]:
    """Two bodies, of bodies or of surfaces with their materials."""
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
    """A matrix of this shape; a number stands for all cells."""
    array = np.asarray(value, dtype=np.float64)
    if array.ndim > 0 and array.shape != shape:
        found = " × ".join(map(str, array.shape))
        message = f"'{key}' has the shape {found}, expected {shape[0]} × {shape[1]}, a value for each cell of the body"
        raise bad_input(key, message)
    if not np.isfinite(array).all():
        raise bad_input(key, f"'{key}' holds numbers that are not finite, expected lengths")
    return np.full(shape, float(array)) if array.ndim == 0 else array
