"""The programs that are compared, and how one of them is run."""

import json
import math
import os
import subprocess
import sys
from pathlib import Path
from typing import NamedTuple

import numpy as np

HERE = Path(__file__).resolve().parent
TARGET = Path(os.environ.get("CARGO_TARGET_DIR", HERE.parents[1] / "target"))
SOLVE_GAP = TARGET / "release" / "examples" / "solve_gap"
THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "NUMBA_NUM_THREADS", "RAYON_NUM_THREADS")
ENVIRONMENT = os.environ | dict.fromkeys(THREADS, "1")


class Program(NamedTuple):
    """A program that takes the command line of `solve_gap`."""

    name: str
    command: list
    options: tuple = ()
    variants: tuple = ((),)
    """Options to choose the fastest of."""
    ordered: bool = True
    """Whether the variants stand in the order of growing speed and falling stability; otherwise all are tried."""


ASPERITY = Program("asperity", [SOLVE_GAP])
ADHESIVE_ASPERITY = Program("asperity", [SOLVE_GAP], ["boundary=periodic"])
PROGRAMS = ["polonsky-keer", "tamaas", "contactmechanics", "dual", "slippy", "aspher"]
ADHESIVE_PROGRAMS = ["tamaas", "adhesion"]


def script(name, python=sys.executable):
    """The command of a peer behind the command line of `solve_gap`."""
    return [python, HERE / f"run_{name}.py"]


def peers(boundary, capped, slippy_python):
    """The programs that solve the problem, by the names they are chosen by."""
    found = {"polonsky-keer": Program("asperity, Polonsky–Keer", [SOLVE_GAP], ["method=polonsky-keer"])}
    if capped:
        lengths = tuple([f"length={length}"] for length in (16, 24, 32, 48, 64, 96, 128, 192, 256))
        found["tamaas"] = Program("Tamaas, KatoSaturated", script("tamaas"), variants=lengths)
    else:
        found["tamaas"] = Program("Tamaas, Polonsky–Keer–Rey", script("tamaas"))
    found["contactmechanics"] = Program("ContactMechanics, Polonsky–Keer", script("contactmechanics"))
    if not capped:
        name = "ContactMechanics, dual CG at our approach"
        found["dual"] = Program(name, script("contactmechanics"), ["method=dual"])
        precisions = tuple([f"precision={precision}"] for precision in ("double", "float_then_double"))
        found["aspher"] = Program("ASPHER", script("aspher"), variants=precisions, ordered=False)
    # With a cap slippy searches for the approach, which its periodic kernel leaves open.
    if slippy_python and not (capped and boundary == "periodic"):
        name = "slippy, double iteration" if capped else "slippy, Polonsky–Keer"
        found["slippy"] = Program(name, script("slippy", slippy_python))
    return found


def adhesive_peers():
    """The programs that solve a contact with adhesion, by the names they are chosen by."""
    methods = ("lbfgsb", "newton", "cg", "cg-restart", "cg-mean-gap", "cg-restart-mean-gap")
    variants = tuple([f"method={method}"] for method in methods)
    return {
        "tamaas": Program("Tamaas, Polonsky–Keer–Rey", script("adhesive_tamaas")),
        "adhesion": Program("Adhesion", script("adhesive_contactmechanics"), variants=variants, ordered=False),
    }


class Case(NamedTuple):
    """A gap in the file `gap.npy` of a folder, and how it is closed."""

    folder: Path
    boundary: str
    mean: float
    hardness: float = math.inf
    approach: float = 0.0

    def task(self, program):
        """The arguments that state the problem."""
        task = [f"boundary={self.boundary}", f"mean={self.mean!r}", f"hardness={self.hardness!r}"]
        return task + ([f"approach={self.approach!r}"] if "method=dual" in program.options else [])


class AdhesiveCase(NamedTuple):
    """A periodic gap in the file `gap.npy` of a folder, closed to an approach, with an exponential attraction."""

    folder: Path
    work: float
    range: float
    approach: float
    mean: float = 0.0
    """The mean pressure of the answer of ours, from which a peer knows the displacement that it prescribes."""

    def task(self, program):
        """The arguments that state the problem."""
        task = [f"work={self.work!r}", f"range={self.range!r}", f"approach={self.approach!r}"]
        return task if program is ADHESIVE_ASPERITY else [*task, f"mean={self.mean!r}"]


class Answer(NamedTuple):
    pressure: np.ndarray
    report: dict


def run(program, case, tolerance, options=(), limit=None):
    """The answer; None where the program fails or takes longer than `limit` seconds."""
    out = case.folder / "pressure.npy"
    task = case.task(program)
    task += [f"tolerance={tolerance!r}", f"pressure={out}", *program.options, *options]
    command = [*program.command, case.folder / "gap.npy", *task]
    out.unlink(missing_ok=True)
    try:
        done = subprocess.run(
            command, check=False, capture_output=True, text=True, timeout=limit, env=ENVIRONMENT
        )
    except subprocess.TimeoutExpired:
        return None
    if done.returncode != 0:
        print(f"{program.name}: {done.stderr.strip().splitlines()[-1:]}", file=sys.stderr)
        return None
    return Answer(np.load(out), json.loads(done.stdout.splitlines()[-1]))
