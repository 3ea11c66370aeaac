"""The same contact in four programs, each used as its users use it: writes docs/peers.md.

    same_contact.py --python PEERS_PYTHON --slippy-python PYTHON39 --asperity-python OURS [--write]

`--python` has Tamaas and ContactMechanics, `--asperity-python` the wheel of a release build, and the interpreter that runs
this numpy and scipy. Without `--write` the page goes to standard output.
"""

import argparse
import json
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np

from contact_residual import Judge
from programs import ENVIRONMENT
from surfaces import self_affine_gap

HERE = Path(__file__).resolve().parent
PAGE = HERE.parents[1] / "docs" / "peers.md"
WANTED = 1e-6
"""What the residual and the relative error of the load must stay below."""

SIDE, CELLS, SHORTEST, MEAN = 256e-6, 256, 8, 2.5e-2
"""The side, m; cells along it; the shortest wave in cells; mean pressure over E* and rms slope."""

MODULUS = 210e9 / (1 - 0.3**2)
SLOPE = 0.1
NAMES = {
    "asperity": "asperity",
    "tamaas": "Tamaas 2.9.0",
    "contactmechanics": "ContactMechanics 1.8.3",
    "slippy": "slippy 0.5.2",
}


def arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--python", required=True)
    parser.add_argument("--slippy-python", required=True)
    parser.add_argument("--asperity-python", required=True)
    parser.add_argument("--repeat", type=int, default=5)
    parser.add_argument("--machine", default="this machine", help="what the page says it was measured on")
    parser.add_argument("--write", action="store_true")
    return parser.parse_args()


class Contact:
    """The contact under one boundary, as all programs solve it."""

    def __init__(self, folder, boundary, pythons):
        self.folder, self.boundary, self.pythons = folder, boundary, pythons
        self.gap = self_affine_gap(CELLS, SHORTEST, 1)
        np.save(folder / "heights.npy", -self.gap * SIDE / CELLS)
        self.mean = MEAN * SLOPE * MODULUS
        self.judge = Judge(CELLS, boundary)

    def run(self, name, tolerance):
        """Residual, relative error of the load, share in contact, seconds."""
        out = self.folder / "pressure.npy"
        file = HERE / "same" / f"{name}_{self.boundary}.py"
        task = [self.folder / "heights.npy", repr(SIDE), repr(self.mean), repr(tolerance), out]
        done = subprocess.run(
            [self.pythons[name], HERE / "same_run.py", file, *task], check=True, capture_output=True, text=True, env=ENVIRONMENT
        )
        pressure = np.load(out)
        eta = self.judge.eta(pressure / MODULUS, self.gap)
        seconds = json.loads(done.stdout.splitlines()[-1])["seconds"]
        return {
            "eta": eta, "error": abs(pressure.mean() / self.mean - 1), "area": (pressure > 0).mean(), "seconds": seconds
        }  # fmt: skip

    def tolerance(self, name):
        """The loosest tolerance, on steps of half a decade, with which the program meets what is wanted."""
        if name == "asperity":
            return WANTED
        for step in range(8, 29):
            found = self.run(name, 10 ** (-step / 2))
            print(f"{name}, {self.boundary}: 1e-{step / 2:g} {found}", file=sys.stderr, flush=True)
            if max(found["eta"], found["error"]) < WANTED:
                return 10 ** (-step / 2)
        raise SystemExit(f"{name} meets η < {WANTED} with no tolerance")

    def rows(self, repeat):
        tolerances = {name: self.tolerance(name) for name in NAMES}
        found = {name: [] for name in NAMES}
        for _ in range(repeat):
            for name in NAMES:
                found[name].append(self.run(name, tolerances[name]))
        ours = [each["seconds"] for each in found["asperity"]]
        for name, runs in found.items():
            ratio = statistics.median(each["seconds"] / own for each, own in zip(runs, ours))
            last = runs[-1]
            yield (
                f"| {NAMES[name]} | {100 * last['area']:.3f} % | {last['error']:.0e} | {last['eta']:.1e} "
                f"| {tolerances[name]:.0e} | {statistics.median(each['seconds'] for each in runs):.3f} "
                f"| {'' if name == 'asperity' else f'{ratio:.1f}'} |"
            )


def code(name, boundary):
    return f"```python\n{(HERE / 'same' / f'{name}_{boundary}.py').read_text().strip()}\n```"


def table(rows):
    head = "| program | real area | error of the load | residual η | its tolerance | seconds | over ours |"
    return "\n".join([head, "|---|---|---|---|---|---|---|", *rows])


def page(tables, repeat, machine):
    codes = "\n\n".join(f"### {title}\n\n{code(name, 'periodic')}" for name, title in NAMES.items())
    free = {name: code(name, "free") for name in ("tamaas", "contactmechanics", "slippy")}
    return f"""\
# The same contact in four programs

A rough steel surface is pressed against a rigid flat: Tamaas 2.9.0, ContactMechanics 1.8.3, slippy 0.5.2 and asperity solve
the same problem, each with the code that a user would write. The script
[benches/peers/same_contact.py](../benches/peers/same_contact.py) runs this code and writes this page.

The surface is self-affine, {CELLS} × {CELLS} cells of 1 µm, Hurst exponent 0.8, rms slope {SLOPE}, shortest wave {SHORTEST} cells. All
programs receive the same heights. Young's modulus is 210 GPa, Poisson's ratio 0.3, the mean pressure {MEAN} E* h′ =
{MEAN * SLOPE * MODULUS / 1e6:.0f} MPa. Nothing yields.

## Answers and times

The boundary is periodic:

{table(tables["periodic"])}

The boundary is free:

{table(tables["free"])}

How it was measured:

- One function computes the **residual** η of [theory](theory.md#the-residual) and the **error of the load** from every pressure, with its
  own influence coefficients. Both must be below 10⁻⁶. The tolerance of asperity is η itself. Each peer has the loosest tolerance that meets
  both, in steps of half a decade from 10⁻⁴.
- The **real area** is the share of cells with p > 0. At equal residuals the areas agree, apart from single cells at the edges of spots.
- The **time** is the processor time of the whole call of `press`, as a user makes it: model, influence coefficients, solution. Imports are left out.
  Each program has one thread, each run its own process, and the programs take turns in {repeat} rounds. The table has
  medians, and the median of the ratios within a round. The machine is
  {machine}.
- The Tamaas wheel uses FFTW without wide vector instructions; a local build may be faster. ContactMechanics also has dual conjugate
  gradients at a given approach, several times faster than its solver under a load.
- [Performance](performance.md#beside-the-peers) has convolutions, other sizes and areas. [benches/peers](../benches/peers/README.md) says how to
  run the peers well.

## A lubricated pad

A tilted elastic pad over a moving plate, with the same oil, cells, ends and load in GaPFlow 1.2.0 and asperity: on 128² cells (polymer, 3 GPa, 83 N) GaPFlow
takes 71 s. The whole run of asperity takes 1.26 s, so the ratio is 53. Both residuals are below 10⁻⁷. The largest pressures differ by 0.3 %, the least films by 0.4 %.
[Performance](performance.md#films-of-oil) has other grids and a steel pad, and
[benches/peers/lubricated_pad.py](../benches/peers/lubricated_pad.py) measures them.

## The code, periodic boundary

{codes}

## The code, free boundary

In asperity, replace `"periodic"` by `boundary="free"`.

### Tamaas

{free["tamaas"]}

### ContactMechanics

{free["contactmechanics"]}

### slippy

{free["slippy"]}
"""


def main():
    given = arguments()
    pythons = {"asperity": given.asperity_python, "slippy": given.slippy_python}
    pythons = {name: pythons.get(name, given.python) for name in NAMES}
    with tempfile.TemporaryDirectory() as folder:
        tables = {
            boundary: list(Contact(Path(folder), boundary, pythons).rows(given.repeat)) for boundary in ("periodic", "free")
        }
    text = page(tables, given.repeat, given.machine)
    if given.write:
        PAGE.write_text(text, encoding="utf-8")
    else:
        print(text)


if __name__ == "__main__":
    main()
