"""Smooth bodies. A `shape` or a `pitch` that is not given is that of the other body of a contact."""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

from ._units import Pair, Quantity
from .surface import Surface

__all__ = ["cone", "cylinder", "ellipsoid", "flat", "grooves", "sinusoid", "sphere"]


def sphere(radius: Quantity, shape: Sequence[int] | None = None, pitch: Pair | None = None) -> Surface:
    """A sphere of this radius, m, by its paraboloid, its apex in the middle at height 0."""
    return Surface._made_as("form", "sphere", locals())


def ellipsoid(
    radius: Sequence[Quantity], shape: Sequence[int] | None = None, pitch: Pair | None = None
) -> Surface:
    """A body of two radii of curvature, along x and along y, m."""
    return Surface._made_as("form", "ellipsoid", locals())


def cylinder(
    radius: Quantity,
    shape: Sequence[int] | None = None,
    pitch: Pair | None = None,
    *,
    axis: Literal["x", "y"] | None = None,
) -> Surface:
    """A cylinder of this radius, m, whose axis lies along ``"x"`` or ``"y"``."""
    return Surface._made_as("form", "cylinder", locals())


def cone(angle: Quantity, shape: Sequence[int] | None = None, pitch: Pair | None = None) -> Surface:
    """A cone whose flank makes this angle with the plane, rad, below a right angle."""
    return Surface._made_as("form", "cone", locals())


def flat(shape: Sequence[int] | None = None, pitch: Pair | None = None) -> Surface:
    """A plane at height 0."""
    return Surface._made_as("form", "flat", locals())


def sinusoid(
    amplitude: Quantity, wavelength: Pair, shape: Sequence[int] | None = None, pitch: Pair | None = None
) -> Surface:
    """A wave of this amplitude, m, and wavelength along x and y, m; ``"inf"`` where it does not vary."""
    return Surface._made_as("form", "sinusoid", locals())


def grooves(
    period: Quantity,
    depth: Quantity,
    shape: Sequence[int] | None = None,
    pitch: Pair | None = None,
    *,
    profile: Literal["parabolic", "triangular"] | None = None,
    lay: Quantity | None = None,
) -> Surface:
    """Grooves of this period and depth, m, ``"parabolic"`` or ``"triangular"``, their `lay` turned from x, rad."""
    return Surface._made_as("form", "grooves", locals())


def __dir__() -> list[str]:
    return __all__
