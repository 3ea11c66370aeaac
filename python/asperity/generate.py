"""Random rough surfaces.

Without a `shape` or a `pitch`, a surface takes that of the other body of the contact. The same `seed` gives the same heights on
every machine.
"""

from __future__ import annotations

from collections.abc import Sequence
from typing import Literal

from ._units import Pair, Quantity
from .surface import Surface

__all__ = ["autocorrelation", "low_pass", "self_affine"]


def low_pass(
    shape: Sequence[int] | None = None,
    pitch: Pair | None = None,
    *,
    sq: Quantity,
    cutoff: Pair,
    band: Literal["elliptic", "rectangular"] | None = None,
    ssk: float | None = None,
    sku: float | None = None,
    seed: int = 0,
) -> Surface:
    """Make white noise without waves shorter than `cutoff`, with the filter of Hu and Tonder.

    Parameters
    ----------
    shape : pair of int, optional
        Number of cells along x and y.
    pitch : float, str or pair, optional
        Size of a cell, m.
    sq : float or str
        Rms height, m.
    cutoff : float, str or pair
        Shortest remaining wavelength along x and y, m.
    band : str, optional
        Shape of the pass band: ``"elliptic"`` (by default) or ``"rectangular"``.
    ssk, sku : float, optional
        Skewness and kurtosis of the heights; 0 and 3 for Gaussian heights.
    seed : int
        Seed of the random numbers, at least 0.

    References
    ----------
    Hu and Tonder, Int. J. Mach. Tools Manufact. 32, 83 (1992).
    """
    return Surface._made_as("generate", "low-pass", locals())


def autocorrelation(
    shape: Sequence[int] | None = None,
    pitch: Pair | None = None,
    *,
    sq: Quantity,
    correlation_length: Pair,
    decay: Literal["exponential", "gaussian"] | None = None,
    lay: Quantity | None = None,
    ssk: float | None = None,
    sku: float | None = None,
    seed: int = 0,
) -> Surface:
    """Make a random surface with a given autocorrelation.

    Parameters
    ----------
    shape, pitch
        As in :func:`low_pass`.
    sq : float or str
        Rms height, m.
    correlation_length : float, str or pair
        Length over which the autocorrelation falls to 1/10, along and across the lay, m.
    decay : str, optional
        Decay of the autocorrelation: ``"exponential"`` (by default) or ``"gaussian"``.
    lay : float or str, optional
        Angle of the lay from x, rad.
    ssk, sku, seed
        As in :func:`low_pass`.
    """
    return Surface._made_as("generate", "autocorrelation", locals())


def self_affine(
    shape: Sequence[int] | None = None,
    pitch: Pair | None = None,
    *,
    hurst: float,
    sq: Quantity | None = None,
    sdq: float | None = None,
    rolloff: Quantity | None = None,
    shortest: Quantity | None = None,
    seed: int = 0,
) -> Surface:
    """Make a self-affine surface: its spectrum is a power law between two wavelengths.

    Parameters
    ----------
    shape, pitch
        As in :func:`low_pass`.
    hurst : float
        Hurst exponent, above 0, at most 1.
    sq : float or str
        Rms height, m. Give `sq` or `sdq`.
    sdq : float
        Rms slope.
    rolloff : float or str, optional
        Wavelength above which the spectrum is flat, m.
    shortest : float or str, optional
        Shortest wavelength of the surface, m.
    seed : int
        Seed of the random numbers, at least 0.
    """
    return Surface._made_as("generate", "self-affine", locals())


def __dir__() -> list[str]:
    return __all__
