"""slippy under a load, by an interpreter of its own: it needs Python 3.9 or older."""

import os
import tempfile
import time

import numpy as np
import slippy
from slippy import contact, surface
from slippy.contact import _step_utils as steps

import runner

slippy.CORES = 1


class Timed:
    """A function, how often it was called and how long it took."""

    def __init__(self, function):
        self.function = function
        self.calls = 0
        self.seconds = 0.0

    def __call__(self, *arguments, **options):
        start = time.perf_counter()
        result = self.function(*arguments, **options)
        self.calls += 1
        self.seconds += time.perf_counter() - start
        return result


def counted_convolutions(plan):
    """A counter of the calls of all convolutions that slippy plans from now on."""
    method = Timed(plan.__call__)
    plan.__call__ = lambda self, *arguments, **options: method(self, *arguments, **options)
    return method


def main():
    options = runner.task()
    side = options.gap.shape[0]
    periodic = options.boundary == "periodic"
    # In space the kernel is Love's; in frequency, with a mean of zero, it is the periodic half-space.
    kernel = {"use_frequency_domain": periodic, "zero_frequency_value": 0.0 if periodic else None}
    soft = contact.Elastic("soft", {"E": 1.0, "v": 0.0}, max_load=options.hardness, **kernel)
    rough = surface.Surface(profile=-options.gap, grid_spacing=1.0)
    flat = surface.FlatSurface(shape=(side, side), grid_spacing=1.0, generate=True)
    rough.material, flat.material = contact.rigid, soft
    os.chdir(tempfile.mkdtemp())  # slippy leaves files where it runs
    model = contact.ContactModel("contact", rough, flat)
    model.add_step(
        contact.StaticStep(
            "load",
            normal_load=options.mean * side**2,
            periodic_geometry=periodic,
            periodic_axes=(periodic, periodic),
            max_it=100_000,
            tolerance=options.tolerance,
            tolerance_outer=1e-12,
        )
    )
    # What belongs to the operator is not counted: the coefficients, the plans.
    steps.plan_convolve = Timed(steps.plan_convolve)
    soft.influence_matrix = Timed(soft.influence_matrix)
    convolutions = counted_convolutions(slippy.core.influence_matrix_utils.FftwConvolutionFunction)
    with runner.Captured():
        start = time.perf_counter()
        result = model.solve()
        seconds = time.perf_counter() - start
    seconds -= steps.plan_convolve.seconds + soft.influence_matrix.seconds
    runner.answer(options, np.asarray(result["loads_z"]), seconds, convolutions.calls)


main()
