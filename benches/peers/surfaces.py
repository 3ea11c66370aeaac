"""The surfaces that are pressed against a flat."""

import numpy as np


def self_affine_gap(side, shortest, seed):
    """Hurst exponent 0.8, roll-off at a quarter of the side, rms slope 0.1, pitch 1; the highest point touches."""
    k = np.fft.fftfreq(side, 1 / side)
    k = np.hypot(k[:, None], k[None, :])
    inside = (k > 0) & (k <= side / shortest)
    magnitude = np.zeros_like(k)
    magnitude[inside] = np.maximum(k[inside], 4) ** -1.8
    phase = np.fft.fft2(np.random.default_rng(seed).standard_normal((side, side)))
    heights = np.fft.ifft2(magnitude * phase / np.abs(phase)).real
    slope = np.sqrt((np.abs(np.fft.fft2(heights)) ** 2 * (2 * np.pi * k / side) ** 2).sum()) / side**2
    heights *= 0.1 / slope
    return heights.max() - heights
