"""Smooth bodies.

Without a `shape` or a `pitch`, a body takes that of the other body of the contact.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

from ._units import Pair, Quantity
from .surface import Surface

__all__ = ["cone", "cylinder", "ellipsoid", "flat", "grooves", "sinusoid", "sphere"]


def sphere(radius: Quantity, shape: Sequence[int] | None = None, pitch: Pair | None = None) -> Surface:
    """Make a sphere of this radius, m: its paraboloid, with the apex in the middle at height 0."""
    return Surface._made_as("form", "sphere", locals())


def ellipsoid(
    radius: Sequence[Quantity], shape: Sequence[int] | None = None, pitch: Pair | None = None
) -> Surface:
    """Make an ellipsoid with the radii of curvature along x and along y, m."""
    return Surface._made_as("form", "ellipsoid", locals())


def cylinder(
    radius: Quantity,
    shape: Sequence[int] | None = None,
    pitch: Pair | None = None,
    *,
    axis: Literal["x", "y"] | None = None,
) -> Surface:
    """Make a cylinder of this radius, m, with its axis along ``"x"`` or ``"y"``."""
    return Surface._made_as("form", "cylinder", locals())


def cone(angle: Quantity, shape: Sequence[int] | None = None, pitch: Pair | None = None) -> Surface:
    """Make a cone. `angle` is the angle between its flank and the plane, below a right angle, rad."""
    return Surface._made_as("form", "cone", locals())


def flat(shape: Sequence[int] | None = None, pitch: Pair | None = None) -> Surface:
    """Make a plane at height 0."""
    return Surface._made_as("form", "flat", locals())


def sinusoid(
    amplitude: Quantity, wavelength: Pair, shape: Sequence[int] | None = None, pitch: Pair | None = None
) -> Surface:
    """Make a sinusoidal wave of this amplitude, m, and wavelength along x and y, m; ``"inf"`` for no variation."""
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
    """Make grooves of this period and depth, m, with a parabolic or triangular `profile`; `lay` is their angle from x, rad."""
    return Surface._made_as("form", "grooves", locals())


def __dir__() -> list[str]:
    return __all__
