"""Flow through rough gaps of ours beside reynoldsflow, the same faces and ends, one thread each, in turns.

A gap is that of a self-affine surface pressed against a plane, computed by asperity. Both programs use the harmonic mean of the
permeabilities of two cells. The time of ours is that of both directions and of the critical
constriction. reynoldsflow solves by iterations, to its own tolerance; the fluxes must agree to 1e-6.
"""

import argparse
import os
import statistics
import time

# Before the libraries load, which would start threads of their own: with two of them reynoldsflow takes many times as long.
THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "NUMBA_NUM_THREADS")
os.environ.update(dict.fromkeys(THREADS, "1"))

import asperity as asp  # noqa: E402
import numpy as np  # noqa: E402
from reynoldsflow import transport  # noqa: E402

ENDS = ("reservoirs", "periodic")


def gap_of(side, seed, load):
    """Gap over the side of the surface, 0 in contact."""
    rough = asp.generate.self_affine(
        (side, side), pitch=1.0 / side, hurst=0.8, sdq=1e-3, seed=seed, rolloff=0.25, shortest=1 / 16
    )
    flat = asp.form.flat((side, side), pitch=1.0 / side)
    steel = asp.Material("210 GPa", 0.3)
    pressure = load * asp.composite_modulus(steel, steel) * 1e-3
    contact = asp.contact(flat, rough, steel, steel, mean_pressure=pressure, boundary="periodic", progress=False)
    return np.where(contact.pressure > 0.0, 0.0, contact.gap), (contact.pressure > 0.0).mean()


def ours(gap, ends):
    start = time.perf_counter()
    flow = asp.flow(gap, pitch=1.0 / len(gap), ends=ends, faces="harmonic", threads=1)
    # Both directions are solved, and the critical constriction found.
    return flow.permeability[0, 0], time.perf_counter() - start


def theirs(gap, ends):
    start = time.perf_counter()
    # Its unit of length is the side, and its fluxes are those of k = g³.
    scale = gap.max()
    if ends == "reservoirs":
        found, _, flux = transport.solve_fluid_problem(gap / scale, solver="auto", p_west=1.0, p_east=0.0)
    else:
        found, _, flux = transport.solve_fluid_problem(
            gap / scale, solver="auto", boundary_mode="periodic", pressure_gradient=1.0
        )
    total, _ = transport.compute_total_flux(found, flux, len(gap))
    return total * scale**3, time.perf_counter() - start


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--side", type=int, nargs="+", default=[64, 128, 256])
    parser.add_argument("--load", type=float, nargs="+", default=[0.05, 0.15, 0.2])
    parser.add_argument("--rounds", type=int, default=5, help="turns of each")
    arguments = parser.parse_args()
    print("| side | contact | ends | permeability | difference | ours, s | reynoldsflow, s | ratio |")
    print("|---|---|---|---|---|---|---|---|")
    for side in arguments.side:
        for load in arguments.load:
            gap, area = gap_of(side, 1, load)
            for ends in ENDS:
                turns = [(ours(gap, ends), theirs(gap, ends)) for _ in range(arguments.rounds)]
                (mine, _), (other, _) = turns[0]
                difference = abs(other / mine - 1) if mine > 0 else abs(other)
                assert difference < 1e-6, f"{mine} and {other}"
                seconds = [statistics.median(turn[which][1] for turn in turns) for which in (0, 1)]
                ratio = statistics.median(turn[1][1] / turn[0][1] for turn in turns)
                print(
                    f"| {side} | {area:.2f} | {ends} | {mine:.4g} | {difference:.1e} | {seconds[0]:.3g} | {seconds[1]:.3g} | {ratio:.1f} |",
                    flush=True,
                )


if __name__ == "__main__":
    main()
