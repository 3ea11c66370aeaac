"""Flow through rough gaps of ours beside reynoldsflow, the same faces and ends, one thread each, in turns.

A gap is that of a self-affine surface pressed against a plane, computed by asperity. Both programs use the harmonic mean of the
permeabilities of two cells, and solve for the flow along x. The time of ours includes the critical constriction. reynoldsflow
solves by iterations, to its own tolerance; the permeabilities must agree to 1e-6. Each solution is a process of its own. Its time
is the processor time of the solution, and its memory the peak of the process, with interpreter and libraries.
"""

import argparse
import json
import os
import resource
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

# Before the libraries load, which would start threads of their own: with two of them reynoldsflow takes many times as long.
THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "NUMBA_NUM_THREADS", "RAYON_NUM_THREADS")
os.environ.update(dict.fromkeys(THREADS, "1"))

OURS = Path(__file__).parents[2] / "target/release/examples/gap_flow"


def run(*command):
    """Answer of a program that prints a line of JSON last."""
    done = subprocess.run([str(part) for part in command], check=True, stdout=subprocess.PIPE, text=True)
    return json.loads(done.stdout.splitlines()[-1])


def theirs(path, ends, solver):
    """Solves in this process, and prints the answer."""
    import numpy as np
    from reynoldsflow import transport

    along = {"reservoirs": {"p_west": 1.0, "p_east": 0.0}, "periodic": {"boundary_mode": "periodic", "pressure_gradient": 1.0}}

    def solve(gap):
        found, _, flux = transport.solve_fluid_problem(gap, solver=solver, **along[ends])
        return transport.compute_total_flux(found, flux, len(gap))[0]

    # Its functions are compiled when they are first called.
    small = np.random.default_rng(1).random((32, 32))
    solve(np.where(small < 0.2, 0.0, small))
    gap = np.load(path)
    start = time.process_time()
    # Its unit of length is the side, and its fluxes are those of k = g³.
    scale = gap.max()
    total = solve(gap / scale)
    seconds = time.process_time() - start
    peak = 1024 * resource.getrusage(resource.RUSAGE_SELF).ru_maxrss
    print(json.dumps({"permeability": [total * scale**3], "seconds": seconds, "peak_bytes": peak}))


def compare(gap, area, side, ends, arguments):
    turns = []
    for _ in range(arguments.rounds):
        mine = run(OURS, gap, f"ends={ends}")
        turns.append((mine, run(sys.executable, __file__, "--peer", gap, ends, "--solver", arguments.solver)))
    (mine, other) = turns[0]
    [own], [found] = mine["permeability"], other["permeability"]
    difference = abs(found / own - 1) if own > 0 else abs(found)
    assert difference < 1e-6, f"{own} and {found}"
    seconds = [statistics.median(turn[which]["seconds"] for turn in turns) for which in (0, 1)]
    ratio = statistics.median(other["seconds"] / mine["seconds"] for mine, other in turns)
    memory = [turns[0][which]["peak_bytes"] / 1e6 for which in (0, 1)]
    print(
        f"| {side} | {area:.2f} | {ends} | {difference:.1e} | {seconds[0]:.3g} | {seconds[1]:.3g} | {ratio:.1f} "
        f"| {memory[0]:.0f} | {memory[1]:.0f} |",
        flush=True,
    )


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--side", type=int, nargs="+", default=[64, 128, 256, 512, 1024])
    parser.add_argument("--load", type=float, nargs="+", default=[0.05, 0.15], help="mean pressure over E* times rms slope")
    parser.add_argument("--ends", nargs="+", default=["reservoirs", "periodic"])
    parser.add_argument("--rounds", type=int, default=5, help="turns of each")
    parser.add_argument("--solver", default="scipy.amg-rs", help="of reynoldsflow; its `auto` fails at times from 512² cells on")
    parser.add_argument("--peer", nargs=2, help=argparse.SUPPRESS)
    arguments = parser.parse_args()
    if arguments.peer:
        theirs(*arguments.peer, arguments.solver)
        return
    print("| side | contact | ends | difference | ours, s | reynoldsflow, s | ratio | ours, MB | reynoldsflow, MB |")
    print("|---|---|---|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        gap = Path(folder) / "gap.npy"
        for side in arguments.side:
            for load in arguments.load:
                area = run(OURS, "make", gap, f"side={side}", f"load={load}")["contact"]
                for ends in arguments.ends:
                    compare(gap, area, side, ends, arguments)


if __name__ == "__main__":
    main()
