import numpy as np
from ContactMechanics import FreeFFTElasticHalfSpace, make_system
from SurfaceTopography import Topography


def press(heights, side, mean_pressure, tolerance):
    modulus = 210e9 / (1 - 0.3**2)
    substrate = FreeFFTElasticHalfSpace(heights.shape, modulus, (side, side))
    system = make_system(substrate=substrate, surface=Topography(heights, (side, side)))
    result = system.minimize_proxy(
        external_force=mean_pressure * side**2, pentol=tolerance * heights.std(),
        forcetol=np.inf, thermotol=np.inf, maxiter=100_000,   # the penetration decides alone
    )
    nx, ny = heights.shape
    return np.asarray(result.jac)[:nx, :ny] / substrate.area_per_pt
