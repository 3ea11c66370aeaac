"""Smooth bodies. A `shape` or a `pitch` that is not given is that of the other body of a contact."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Any, Literal

from ._units import Pair, Quantity
from .surface import Surface


def _form(kind: str, keys: dict[str, Any]) -> Surface:
    given = {key: value for key, value in keys.items() if value is not None}
    return Surface._of({"form": kind, **given})


def sphere(radius: Quantity, shape: Sequence[int] | None = None, pitch: Pair | None = None) -> Surface:
    """A sphere of this radius, m, by its paraboloid, its apex in the middle at height 0."""
    return _form("sphere", {"radius": radius, "shape": shape, "pitch": pitch})


def ellipsoid(
    radius: Sequence[Quantity], shape: Sequence[int] | None = None, pitch: Pair | None = None
) -> Surface:
    """A body of two radii of curvature, along x and along y, m."""
    return _form("ellipsoid", {"radius": list(radius), "shape": shape, "pitch": pitch})


def cylinder(
    radius: Quantity,
    shape: Sequence[int] | None = None,
    pitch: Pair | None = None,
    *,
    axis: Literal["x", "y"] | None = None,
) -> Surface:
    """A cylinder of this radius, m, whose axis lies along ``"x"`` or ``"y"``."""
    return _form("cylinder", {"radius": radius, "axis": axis, "shape": shape, "pitch": pitch})


def cone(angle: Quantity, shape: Sequence[int] | None = None, pitch: Pair | None = None) -> Surface:
    """A cone whose flank makes this angle with the plane, rad, below a right angle."""
    return _form("cone", {"angle": angle, "shape": shape, "pitch": pitch})


def flat(shape: Sequence[int] | None = None, pitch: Pair | None = None) -> Surface:
    """A plane at height 0."""
    return _form("flat", {"shape": shape, "pitch": pitch})


def sinusoid(
    amplitude: Quantity, wavelength: Pair, shape: Sequence[int] | None = None, pitch: Pair | None = None
) -> Surface:
    """A wave of this amplitude, m, and wavelength along x and y, m; ``"inf"`` where it does not vary."""
    return _form("sinusoid", {"amplitude": amplitude, "wavelength": wavelength, "shape": shape, "pitch": pitch})


def grooves(
    period: Quantity,
    depth: Quantity,
    shape: Sequence[int] | None = None,
    pitch: Pair | None = None,
    *,
    profile: str | None = None,
    lay: Quantity | None = None,
) -> Surface:
    """Grooves of this period and depth, m, ``"parabolic"`` or ``"triangular"``, their `lay` turned from x, rad."""
    keys = {"period": period, "depth": depth, "profile": profile, "lay": lay}
    return _form("grooves", {**keys, "shape": shape, "pitch": pitch})
