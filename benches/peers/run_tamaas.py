"""Tamaas under a load: Polonsky-Keer-Rey, or its KatoSaturated where a hardness is given."""

import time

import numpy as np
import tamaas

import runner


def main():
    # KatoSaturated takes steps of a length fixed in Tamaas's own units: its speed depends on the length of the side.
    options = runner.task(length=1.0)
    side = options.gap.shape[0]
    length = options.length if np.isfinite(options.hardness) else float(side)
    heights = np.ascontiguousarray(-options.gap * length / side)
    tamaas.initialize(1)
    model = tamaas.Model(tamaas.model_type.basic_2d, [length] * 2, [side] * 2)
    model.E, model.nu = 1.0, 0.0
    if options.boundary == "free":
        tamaas.ModelFactory.registerNonPeriodic(model, "dcfft")
    if np.isfinite(options.hardness):
        solver = tamaas.KatoSaturated(model, heights, options.tolerance, options.hardness)
        each = 1  # convolution in an iteration: the gradient
    else:
        kind = tamaas.PolonskyKeerRey.type.pressure
        solver = tamaas.PolonskyKeerRey(model, heights, options.tolerance, kind, kind)
        each = 2  # the gap, and the response to the direction
    if options.boundary == "free":
        solver.setIntegralOperator("dcfft")
    solver.max_iter, solver.dump_freq = 20_000, 1
    with runner.Captured() as captured:
        start = time.perf_counter()
        solver.solve(options.mean)
        seconds = time.perf_counter() - start
    pressure = np.array(model.traction).reshape(options.gap.shape)
    count = runner.tamaas_iterations(captured.text)
    runner.answer(options, pressure, seconds, each * count, iterations=count)


main()
