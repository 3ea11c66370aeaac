"""ASPHER: its nested grids, one operator by transforms for each boundary."""

import re
import time

import aspher
import numpy as np

import runner


def main():
    options = runner.task(precision="double", coarsest=64)
    side = options.gap.shape[0]
    # The operator by multipoles ("h2") is slower on these grids, and not exact enough for the residual.
    backend = "fft" if options.boundary == "free" else "periodic"
    start = time.perf_counter()
    result = aspher.solve_nested(
        grid_size=side,
        domain_size=float(side),
        gap=options.gap.ravel(),
        p_nominal=options.mean,
        coarsest=options.coarsest,
        tol=options.tolerance,
        precision=options.precision,
        backend=backend,
    )
    seconds = time.perf_counter() - start - result.timings["build"]
    convolutions = 0.0
    for stage in result.stage_stats:
        cells_a_side = int(re.search(r"\d+", stage["name"])[0])
        convolutions += stage["matvec_count"] * (cells_a_side / side) ** 2
    pressure = np.reshape(result.pressure, options.gap.shape)
    runner.answer(options, pressure, seconds, convolutions, iterations=result.iterations)


main()
