"""Adhesion, on the periodic half-space of ContactMechanics: minimisers of SciPy and NuMPI."""

import time

import numpy as np
import scipy.fft
from Adhesion.Interactions import Exponential
from Adhesion.System import BoundedSmoothContactSystem, make_system
from ContactMechanics import PeriodicFFTElasticHalfSpace
from NuMPI.Optimization import (
    constrained_conjugate_gradients,
    constrained_conjugate_gradients_with_restart,
    tr_newton_bounded,
)
from SurfaceTopography import Topography

import runner
from contact_residual import periodic_kernel

MAX_ITERATIONS = 100_000


def minimised(system, options, tolerance):
    """The gap and the number of iterations."""
    # A body of theirs rests on a spring: this is the offset at which the spring carries the mean pressure of ours.
    spring = system.substrate.surface_stiffness[0, 0].real
    offset = options.approach + options.mean / spring
    if options.method == "lbfgsb":
        limits = {"ftol": 0, "gtol": tolerance, "maxiter": MAX_ITERATIONS, "maxfun": MAX_ITERATIONS}
        result = system.minimize_proxy(offset=offset, lbounds="auto", options=limits)
        return system.gap, result.nit
    objective = system.primal_objective(offset, gradient=True)
    product = system.primal_hessian_product
    # From afar: the surfaces as they are, cut off where they would overlap.
    start = np.maximum(options.gap - options.approach, 0.0)
    if options.method == "newton":
        shape = start.shape
        result = tr_newton_bounded(
            objective,
            start,
            lambda gap, way: product(gap.reshape(shape), way.reshape(shape)).reshape(way.shape),
            bounds_lo=0.0,
            gtol=tolerance,
            maxiter=MAX_ITERATIONS,
        )
    else:
        restart = "restart" in options.method
        solver = constrained_conjugate_gradients_with_restart if restart else constrained_conjugate_gradients
        mean_gap = float((options.gap - options.approach).mean()) if "mean-gap" in options.method else None
        result = solver(
            objective, product, x0=start, mean_val=mean_gap, gtol=tolerance, maxiter=MAX_ITERATIONS
        )
    return np.reshape(result.x, options.gap.shape), result.nit


def pressure_of(gap, options):
    """The pressure under the displacement that a gap requires; its mean is that of the tension on the open cells."""
    displacement = gap - (options.gap - options.approach)
    kernel = periodic_kernel(len(gap))
    stiffness = np.divide(1.0, kernel, out=np.zeros_like(kernel), where=kernel > 0)
    pressure = scipy.fft.irfft2(scipy.fft.rfft2(displacement) * stiffness, gap.shape)
    tension = options.work / options.range * np.exp(-gap / options.range)
    return pressure - (pressure + tension)[gap > 0].mean()


def main():
    options = runner.task(method="lbfgsb", work=0.0, range=1.0)
    shape = options.gap.shape
    substrate = PeriodicFFTElasticHalfSpace(shape, 1.0, shape)
    substrate.evaluate_force = runner.Counted(substrate.evaluate_force)
    system = make_system(
        interaction=Exponential(options.work, options.range),
        surface=Topography(-options.gap, shape, periodic=True),
        substrate=substrate,
        system_class=BoundedSmoothContactSystem,
    )
    start = time.perf_counter()
    gap, iterations = minimised(system, options, options.tolerance * options.gap.std())
    seconds = time.perf_counter() - start
    convolutions = substrate.evaluate_force.calls
    runner.answer(options, pressure_of(gap, options), seconds, convolutions, iterations=int(iterations))


main()
