"""ContactMechanics: Polonsky-Keer under a load, or the dual CG without restart (NuMPI) at a given approach."""

import time

import numpy as np
from ContactMechanics import FreeFFTElasticHalfSpace, PeriodicFFTElasticHalfSpace, make_system
from SurfaceTopography import Topography

import runner


def main():
    options = runner.task(method="load")
    shape = options.gap.shape
    free = options.boundary == "free"
    if free:
        substrate = FreeFFTElasticHalfSpace(shape, 1.0, shape)
    else:
        # Only with a mean displacement of zero is our approach theirs; Polonsky-Keer needs it invertible to start.
        stiffness = 0.0 if options.method == "dual" else None
        substrate = PeriodicFFTElasticHalfSpace(shape, 1.0, shape, stiffness_q0=stiffness)
    substrate.evaluate_disp = runner.Counted(substrate.evaluate_disp)
    substrate.evaluate_force = runner.Counted(substrate.evaluate_force)
    system = make_system(substrate=substrate, surface=Topography(-options.gap, shape, periodic=not free))
    tolerance = options.tolerance * options.gap.std()
    start = time.perf_counter()
    if options.method == "dual":
        result = system.dual_minimize_proxy(
            offset=options.approach, init_force=np.zeros(shape), gtol=tolerance, maxiter=100_000
        )
        pressure = np.reshape(result.x, shape)
    else:
        # Of its criteria the penetration decides alone: the others only cost it iterations.
        cap = {"hardness": options.hardness} if np.isfinite(options.hardness) else {}
        result = system.minimize_proxy(
            external_force=options.mean * options.gap.size,
            pentol=tolerance,
            forcetol=np.inf,
            thermotol=np.inf,
            maxiter=100_000,
            **cap,
        )
        pressure = np.asarray(result.jac)[: shape[0], : shape[1]]
    seconds = time.perf_counter() - start
    runner.answer(options, pressure, seconds, substrate.evaluate_disp.calls + substrate.evaluate_force.calls)


main()
