"""The residual by which all programs are judged, computed with influence coefficients of our own."""

import numpy as np
from scipy import fft
from scipy.optimize import minimize_scalar


def free_kernel(side, pitch=1.0, modulus=1.0):
    """Transform of Love's coefficients on the doubled grid: the free boundary."""
    offset = np.minimum(np.arange(2 * side), 2 * side - np.arange(2 * side)) * pitch
    x, y, a = offset[:, None], offset[None, :], 0.5 * pitch

    def corner(s, t):
        return s * np.arcsinh(t / np.abs(s)) + t * np.arcsinh(s / np.abs(t))

    integral = corner(x + a, y + a) - corner(x - a, y + a) - corner(x + a, y - a) + corner(x - a, y - a)
    return fft.rfft2(integral / (np.pi * modulus)).real


def periodic_kernel(side, pitch=1.0, modulus=1.0):
    """2/(E*|q|), and 0 for the mean: the periodic boundary."""
    qx = 2 * np.pi * fft.fftfreq(side, pitch)[:, None]
    qy = 2 * np.pi * fft.rfftfreq(side, pitch)[None, :]
    q = np.hypot(qx, qy)
    return np.divide(2 / modulus, q, out=np.zeros_like(q), where=q > 0)


class Judge:
    """The residual eta of any pressure on one grid."""

    def __init__(self, side, boundary):
        self.side = side
        self.kernel = free_kernel(side) if boundary == "free" else periodic_kernel(side)
        self.padded = (2 * side, 2 * side) if boundary == "free" else (side, side)
        self.self_influence = fft.irfft2(self.kernel, self.padded)[0, 0]

    def displacement(self, pressure):
        product = fft.rfft2(pressure, self.padded) * self.kernel
        return fft.irfft2(product, self.padded)[: self.side, : self.side]

    def eta(self, pressure, gap, hardness=np.inf):
        """max|phi| / std(u), phi = c0 (p - clip(p + w/c0, 0, H)), w = delta - h - u, at the best delta."""
        u = self.displacement(pressure)
        deformed = gap + u
        c0 = self.self_influence

        def worst(delta):
            bounded = np.clip(pressure + (delta - deformed) / c0, 0, hardness)
            return c0 * np.abs(pressure - bounded).max()

        # The largest |phi| falls to the best delta and rises behind it; a shift by t changes it by t at the most.
        free = (pressure > 0) & (pressure < hardness)
        if not free.any():
            return np.inf
        middle = np.median(deformed[free])
        reach = 2 * worst(middle)
        interval = (middle - reach, middle + reach)
        best = minimize_scalar(worst, bounds=interval, method="bounded", options={"xatol": 1e-3 * reach})
        return min(best.fun, worst(middle)) / max(u.std(), np.finfo(float).tiny)

    def adhesive(self, pressure, gap, case):
        """Residual of a contact with an exponential attraction at its approach, and the cells that touch.

        eta = max|phi| / std(u), phi = c0 (p - max(-sigma(g), p - g/c0)), g = h - delta + u, sigma(g) = w/rho exp(-g/rho)
        """
        u = self.displacement(pressure)
        c0 = self.self_influence
        deformed = gap - case.approach + u
        tension = case.work / case.range * np.exp(-np.maximum(deformed, 0) / case.range)
        pressed = pressure - deformed / c0
        eta = c0 * np.abs(pressure - np.maximum(-tension, pressed)).max() / u.std()
        return eta, pressed > -tension
