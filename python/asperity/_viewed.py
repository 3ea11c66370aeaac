"""What figures and notebooks look at, whoever has it."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any, Protocol

import numpy as np
from numpy.typing import NDArray


class Surface(Protocol):
    """Heights on a grid."""

    @property
    def heights(self) -> NDArray[np.float64]: ...
    @property
    def shape(self) -> tuple[int, int]: ...
    @property
    def pitch(self) -> tuple[float, float]: ...
    @property
    def undefined(self) -> int: ...


class Field(Protocol):
    """Values on a grid, with their unit."""

    name: str
    values: NDArray[np.float64]
    unit: str
    axes: tuple[str, ...]
    pitch: tuple[float, ...]
    origin: tuple[float, ...]

    def coordinate(self, axis: str) -> NDArray[np.float64]: ...


class Contact(Protocol):
    """A static contact in numbers and fields."""

    load: float
    approach: float
    contact_area: float
    max_pressure: float
    mean_gap: float
    plastic_volume: float
    convolutions: float
    residual: float
    adhesive_load: float
    warnings: list[str]
    case: dict[str, Any]
    closed_form: dict[str, Any] | None
    adhesion: dict[str, Any] | None

    @property
    def sweep(self) -> NDArray[np.void]: ...
    @property
    def numbers(self) -> dict[str, Any]: ...
    @property
    def pressure(self) -> NDArray[np.float64]: ...
    @property
    def pitch(self) -> tuple[float, float]: ...
    @property
    def contact_fraction(self) -> float: ...


class Run(Protocol):
    """A motion, pass by pass."""

    @property
    def case(self) -> dict[str, Any]: ...
    @property
    def passes(self) -> NDArray[np.void]: ...
    @property
    def steps(self) -> NDArray[np.void]: ...
    @property
    def warnings(self) -> list[str]: ...
    def fields(self, number: int | None = None) -> Mapping[str, Field]: ...
    def lower(self, number: int | None = None) -> Surface: ...
    def upper(self, number: int | None = None) -> Surface: ...


class Study(Protocol):
    """A study of many cases."""

    title: str

    @property
    def axes(self) -> dict[str, NDArray[Any]]: ...
    @property
    def units(self) -> dict[str, str]: ...
    @property
    def failures(self) -> dict[int, str]: ...
    @property
    def table(self) -> NDArray[np.void]: ...
    @property
    def table_units(self) -> dict[str, str]: ...
    @property
    def _table_axes(self) -> dict[str, NDArray[Any]]: ...
    def _told(self) -> str: ...
