"""Tamaas with adhesion: Polonsky-Keer-Rey over the gap, at a mean gap."""

import time

import numpy as np
import tamaas

import runner


def main():
    options = runner.task(work=0.0, range=1.0)
    side = options.gap.shape[0]
    heights = np.ascontiguousarray(options.gap.mean() - options.gap)
    tamaas.initialize(1)
    model = tamaas.Model(tamaas.model_type.basic_2d, [float(side)] * 2, [side] * 2)
    model.E, model.nu = 1.0, 0.0
    kind = tamaas.PolonskyKeerRey.type.gap
    solver = tamaas.PolonskyKeerRey(model, heights, options.tolerance, kind, kind)
    attraction = tamaas.ExponentialAdhesionFunctional(heights)
    attraction.parameters = {"rho": options.range, "surface_energy": options.work}
    solver.addFunctionalTerm(attraction)
    solver.max_iter, solver.dump_freq = 20_000, 1
    # The displacement of a periodic body has no mean: the approach determines the mean gap.
    mean_gap = options.gap.mean() - options.approach
    with runner.Captured() as captured:
        start = time.perf_counter()
        solver.solve(mean_gap)
        seconds = time.perf_counter() - start
    pressure = np.array(model.traction).reshape(options.gap.shape)
    # The gradient, and the response to the direction.
    count = runner.tamaas_iterations(captured.text)
    runner.answer(options, pressure, seconds, 2 * count, iterations=count)


main()
