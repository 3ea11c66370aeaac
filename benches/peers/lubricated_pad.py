"""A lubricated elastic pad in asperity and in GaPFlow 1.2.0, one thread each, in turns.

    pip install GaPFlow==1.2.0         # Python 3.11; into the environment of requirements.txt or one of its own
    cargo build --release -p asperity-cli
    python benches/peers/lubricated_pad.py [--asperity PROGRAM] [--pad polymer steel] [--side 32 64 128] [--rounds 3]

A square pad is tilted over a plate that moves: the undeformed film is twice as thick at the inlet as at the outlet. One body is
rigid, the other an elastic half-space. The oil is at ambient pressure on all four sides. Both programs have Barus' viscosity,
the density of Dowson and Higginson, the same cells and the same load. GaPFlow fixes the film at a corner and finds the load.
asperity takes this load and finds the approach. In another run it takes that approach.

GaPFlow takes explicit steps of time until its kinetic energy is steady. The residual is that of asperity for both: the largest
imbalance of a cell, over the oil that a film of 100 nm carries at the mean speed. GaPFlow's tolerance is the loosest, in steps
of half a decade, whose residual is below `--residual`, by default the tolerance of asperity, 1e-7.

Seconds are processor time. "Run" is all of `asperity run`: start, film, film on half as many cells, files, figures and page.
"Film" is wall time, without start, figures and page. GaPFlow's time has neither imports nor files.
"""

import argparse
import json
import os
import resource
import statistics
import subprocess
import tempfile
import time
from pathlib import Path
from typing import NamedTuple

# Before the libraries load, which would start threads of their own.
THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "RAYON_NUM_THREADS")
os.environ.update(dict.fromkeys(THREADS, "1"))

import h5py  # noqa: E402
import numpy as np  # noqa: E402
from GaPFlow.problem import Problem  # noqa: E402

from runner import Captured  # noqa: E402

LENGTH = 10e-3
POISSON = 0.3
VISCOSITY, PRESSURE_VISCOSITY, DENSITY = 0.04, 20e-9, 850.0
COMPRESSION = 5.9e8, 1.34
"""Of Dowson and Higginson, Pa and 1: ρ/ρ₀ = (5.9e8 + 1.34 p)/(5.9e8 + p)."""

UNIT = 100e-9
"""Film in the residual: 50 boundary films of asperity, m."""


class Pad(NamedTuple):
    young: float
    outlet: float
    """Undeformed film at the outlet, m; at the inlet it is twice as thick."""
    speed: float
    """Speed of the plate, m/s."""


PADS = {"polymer": Pad(3e9, 10e-6, 4.0), "steel": Pad(210e9, 5e-6, 10.0)}


class Answer(NamedTuple):
    pressure: np.ndarray
    film: np.ndarray
    residual: float
    seconds: list

    def load(self):
        return float(self.pressure.sum()) * (LENGTH / len(self.pressure)) ** 2

    def numbers(self):
        """Largest pressure, least film and mean film."""
        return np.array([self.pressure.max(), self.film.min(), self.film.mean()])


def ours(program, pad, side, control, folder):
    """The answer of asperity, with the seconds of the run and of the film, and the approach."""
    place = (np.arange(side) + 0.5) / side
    np.save(folder / "pad.npy", np.repeat(pad.outlet * (2.0 - place)[:, None], side, axis=1))
    (folder / "case.toml").write_text(f"""
[lower]
young = {pad.young}
poisson = {POISSON}
topography = {{ form = "flat", shape = [{side}, {side}], pitch = {LENGTH / side} }}
[upper]
young = "inf"
poisson = {POISSON}
mount = "as-is"
topography = {{ file = "pad.npy", unit = "m", pitch = {LENGTH / side} }}
[contact]
{control}
[lubrication]
viscosity = {VISCOSITY}
pressure_viscosity = {PRESSURE_VISCOSITY}
law = "barus"
speed = {pad.speed / 2}
""")
    case, results = folder / "case.toml", folder / "results"
    before = resource.getrusage(resource.RUSAGE_CHILDREN)
    command = [program, "run", case, "--out", results, "--overwrite", "--threads", "1", "--quiet"]
    subprocess.run(command, check=True, capture_output=True)
    after = resource.getrusage(resource.RUSAGE_CHILDREN)
    seconds = after.ru_utime + after.ru_stime - before.ru_utime - before.ru_stime
    summary = json.loads((results / "summary.json").read_text())
    with h5py.File(results / "fields.h5") as fields:
        pressure, film = fields["oil_pressure"][...], fields["gap"][...]
    point = summary["sweep"][0]
    return Answer(pressure, film, point["residual"], [seconds, summary["wall_time_s"]]), point["approach"]


def problem(pad, side, tolerance):
    """GaPFlow's problem."""
    # Its half-space has the cells around the grid, too, on the length of the grid, which makes it softer by this factor.
    young = pad.young * (side + 2) / side
    # The longest stable steps: the sound may cross 0.6 cells, and the thinnest film needs the viscous time 1.5 times.
    stiffness = COMPRESSION[0] / (COMPRESSION[1] - 1.0)
    sound = (stiffness / DENSITY) ** 0.5
    viscous = DENSITY * pad.outlet**2 / (12.0 * VISCOSITY)
    courant = min(0.6, 1.5 * viscous * sound * side / LENGTH)
    end = "['D', 'N', 'N']"
    return Problem.from_string(f"""
options: {{silent: True, write_freq: 1000000000}}
grid:
    {{Lx: {LENGTH}, Ly: {LENGTH}, Nx: {side}, Ny: {side}, xE: {end}, xW: {end}, yS: {end}, yN: {end},
     xE_D: {DENSITY}, xW_D: {DENSITY}, yS_D: {DENSITY}, yN_D: {DENSITY}}}
geometry: {{type: inclined, hmax: {2 * pad.outlet}, hmin: {pad.outlet}, U: {pad.speed}, V: 0.}}
numerics: {{adaptive: 1, CFL: {courant}, tol: {tolerance}, max_it: 1000000}}
properties:
    {{EOS: DH, rho0: {DENSITY}, P0: 0., C1: {COMPRESSION[0]}, C2: {COMPRESSION[1]}, shear: {VISCOSITY}, bulk: 0.,
     piezo: {{name: Barus, aB: {PRESSURE_VISCOSITY}}},
     elastic: {{E: {young}, v: {POISSON}, alpha_underrelax: 0.1}}}}
""")


def displaced(solved):
    """The displacement of GaPFlow's half-space, with the cells around the grid."""
    pressure = solved.pressure.pressure
    return solved.topo.ElasticDeformation.get_deformation(pressure - pressure[0, 0])


def residual(solved, pad, side):
    """The residual of GaPFlow's state, from one more step."""
    before, duration = solved.q.copy(), solved.dt
    solved.update()
    rate = np.abs(solved.q - before)[:, 1:-1, 1:-1] / duration
    film = solved.topo.h[1:-1, 1:-1]
    unit = DENSITY * pad.speed / 2 * UNIT
    # What is stored in a cell, what the flow is off by, and what the film is off by.
    stored = rate[0] * film * LENGTH / side / unit
    flow = rate[1:].max(axis=0) * DENSITY * film**2 / (12.0 * VISCOSITY) * film / unit
    lifted = displaced(solved)
    lifted = np.abs(solved.topo.h - solved.topo.h_undeformed - lifted + lifted[0, 0])[1:-1, 1:-1] / UNIT
    return max(stored.max(), flow.max(), lifted.max())


def tightened(pad, side, wanted):
    """The loosest tolerance of GaPFlow whose residual is below the one that is wanted."""
    step = 16
    with Captured():
        solved = problem(pad, side, 10.0 ** (-step / 2))
        solved.run()
        while (found := residual(solved, pad, side)) > wanted and step < 28:
            step += 1
            solved.tol = 10.0 ** (-step / 2)
            solved.run()
    if found > wanted:
        raise SystemExit(f"GaPFlow has a residual of {found:.1e}")
    return 10.0 ** (-step / 2)


def theirs(pad, side, tolerance):
    """The answer of GaPFlow and its number of steps."""
    with Captured():
        start = time.process_time()
        solved = problem(pad, side, tolerance)
        solved.run()
        seconds = time.process_time() - start
        steps = solved.step
        fields = [np.array(field[1:-1, 1:-1]) for field in (solved.pressure.pressure, solved.topo.h)]
        found = residual(solved, pad, side)
    return Answer(*fields, found, [seconds]), steps


def row(program, name, side, rounds, wanted):
    """A row of the table: GaPFlow and asperity in turns."""
    pad, tolerance = PADS[name], tightened(PADS[name], side, wanted)
    seconds = []
    with tempfile.TemporaryDirectory() as folder:
        for _ in range(rounds):
            peer, steps = theirs(pad, side, tolerance)
            mine, approach = ours(program, pad, side, f"load = {peer.load()!r}", Path(folder))
            again, _ = ours(program, pad, side, f"approach = {approach!r}", Path(folder))
            seconds.append([*mine.seconds, *again.seconds, *peer.seconds])
    for answer in (mine, again):
        assert abs(answer.load() / peer.load() - 1.0) < 1e-6
    differences = peer.numbers() / mine.numbers() - 1.0
    medians = [statistics.median(times) for times in zip(*seconds)]
    ratios = [statistics.median(turn[-1] / turn[which] for turn in seconds) for which in range(4)]
    pressure, least, mean = mine.numbers()
    lifted = np.ptp(mine.film - pad.outlet * (2.0 - (np.arange(side)[:, None] + 0.5) / side))
    cells = [
        f"{name}, {side}²",
        f"{peer.load():.2f}, {lifted * 1e6:.2f}",
        f"{pressure / 1e6:.3f}, {least * 1e6:.3f}, {mean * 1e6:.3f}",
        ", ".join(f"{100 * difference:+.2f} %" for difference in differences),
        f"{mine.residual:.0e}, {peer.residual:.0e}",
        f"{tolerance:.0e}, {steps}",
        ", ".join(f"{each:.2f}" for each in medians[:4]),
        f"{medians[-1]:.1f}",
        ", ".join(f"{ratio:.0f}" for ratio in ratios),
    ]
    return f"| {' | '.join(cells)} |"


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--asperity", type=Path, default="target/release/asperity")
    parser.add_argument("--pad", nargs="+", choices=PADS, default=["polymer"])
    parser.add_argument("--side", type=int, nargs="+", default=[32, 64, 128])
    parser.add_argument("--rounds", type=int, default=3, help="turns of each")
    parser.add_argument("--residual", type=float, default=1e-7, help="what GaPFlow's residual must stay below")
    given = parser.parse_args()
    head = [
        "pad, cells",
        "load, N; deformation, µm",
        "largest pressure, MPa; least and mean film, µm",
        "GaPFlow differs by",
        "residuals, ours and its",
        "its tolerance, steps",
        "asperity, s: run and film under the load, run and film at the approach",
        "GaPFlow, s",
        "ratios",
    ]
    print(f"| {' | '.join(head)} |")
    print("|---" * len(head) + "|")
    for name in given.pad:
        for side in given.side:
            print(row(given.asperity.resolve(), name, side, given.rounds, given.residual), flush=True)


if __name__ == "__main__":
    main()
