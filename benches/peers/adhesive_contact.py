"""Rough surfaces that attract each other: peers beside asperity, to the same residual, one thread each.

A periodic self-affine surface comes from afar to the approach at which it would carry a given mean pressure without
adhesion. Prints a Markdown table; with `--json FILE` every row is also appended to a file as a line of JSON.
"""

import argparse
import json
import statistics
import tempfile
from pathlib import Path
from typing import NamedTuple

import numpy as np

from contact_residual import Judge
from programs import ADHESIVE_ASPERITY, ADHESIVE_PROGRAMS, ASPERITY, AdhesiveCase, Case, adhesive_peers, run
from static_contact import WANTED, Bench
from surfaces import self_affine_gap

SHORTEST = 16
"""Shortest wave, cells."""
COLUMNS = ["cells", "w/E*", "program", "mean p/E*", "contact", "difference", "η", "convolutions", "iterations"]
COLUMNS += ["seconds", "ratio"]
SAME_STATE = 1e-3
"""Largest difference of the pressure, over the largest pressure of ours, in one and the same state."""


class Run(NamedTuple):
    eta: float
    mean: float
    area: float
    difference: float
    seconds: float
    convolutions: float
    iterations: float

    @property
    def miss(self):
        """How far the answer is from what is wanted: met below 1."""
        return self.eta / WANTED

    @property
    def merit(self):
        """The less, the better among the variants of a program."""
        return (self.miss >= 1, self.difference > SAME_STATE, self.seconds)


class AdhesiveBench(Bench):
    """One case, and all that is run on it."""

    ours = ADHESIVE_ASPERITY

    def __init__(self, case, judge, gap, limit):
        super().__init__(case, judge, gap, limit)
        self.answer = run(self.ours, case, WANTED)
        self.case = case._replace(mean=float(self.answer.pressure.mean()))

    def judged(self, answer):
        p, ours = answer.pressure, self.answer.pressure
        eta, touching = self.judge.adhesive(p, self.gap, self.case)
        difference = np.abs(p - ours).max() / ours.max()
        cost = (answer.report[key] for key in ("solve_seconds", "convolutions", "iterations"))
        return Run(eta, p.mean(), touching.mean(), difference, *cost)


def print_row(about, name, outcome, seconds, ratio, path):
    cells = [f"{about['side']}²", f"{about['work']:g}", name]
    if outcome is None:
        cells[-1] += ", not within the limit"
        cells += [""] * (len(COLUMNS) - len(cells))
    else:
        cells += [f"{outcome.mean:.6g}", f"{100 * outcome.area:.2f} %"]
        cells += [f"{outcome.difference:.0e}", f"{outcome.eta:.1e}"]
        cells += [f"{outcome.convolutions:.4g}", f"{outcome.iterations:g}", f"{seconds:.3g}"]
        cells.append(f"{ratio:.3g}" if ratio else "")
    print("| " + " | ".join(cells) + " |", flush=True)
    if path:
        values = about | {"program": name, "ratio": ratio} | (outcome._asdict() if outcome else {})
        with open(path, "a") as file:
            file.write(json.dumps(values | {"seconds": seconds}, default=float) + "\n")


def compare(bench, programs, about, arguments, steps):
    """All rows of one case; `steps` remembers the tolerances from case to case."""
    ours, rows = [], []
    for key, program in programs.items():
        chosen = bench.prepared(program, steps.get(key, 12))
        if chosen is None:
            rows.append((program.name, None, None, None))
            continue
        options, steps[key], outcome = chosen
        pairs = bench.beside(program, options, steps[key], arguments.repeat)
        ours += [pair[0].seconds for pair in pairs]
        seconds = statistics.median(pair[1].seconds for pair in pairs)
        ratio = statistics.median(pair[1].seconds / pair[0].seconds for pair in pairs)
        name = "".join([program.name, *(f", {option}" for option in options)])
        name += "" if outcome.miss < 1 else ", residual not met"
        name += "" if outcome.difference < SAME_STATE else ", another state"
        rows.append((name, outcome, seconds, ratio))
    first = bench.judged(bench.answer)
    print_row(about, "asperity", first, statistics.median(ours or [first.seconds]), None, arguments.json)
    for row in rows:
        print_row(about, *row, arguments.json)


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--side", type=int, nargs="+", default=[64, 128, 256])
    parser.add_argument(
        "--work", type=float, nargs="+", default=[0.002, 0.01, 0.03, 0.06], help="over E* and the cell"
    )
    parser.add_argument("--range", type=float, default=0.5, help="cells")
    parser.add_argument("--mean", type=float, default=0.01, help="mean pressure without adhesion, over E*")
    parser.add_argument("--programs", nargs="+", choices=ADHESIVE_PROGRAMS, default=ADHESIVE_PROGRAMS)
    parser.add_argument("--repeat", type=int, default=3)
    parser.add_argument("--limit", type=float, default=120, help="what one run of a peer may take, seconds")
    parser.add_argument("--seed", type=int, default=0)
    parser.add_argument("--json", help="file to append the rows to")
    arguments = parser.parse_args()

    print("| " + " | ".join(COLUMNS) + " |")
    print("|" + "---|" * len(COLUMNS), flush=True)
    programs = {key: adhesive_peers()[key] for key in arguments.programs}
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        for side in arguments.side:
            gap = self_affine_gap(side, SHORTEST, arguments.seed)
            np.save(folder / "gap.npy", gap)
            approach = run(ASPERITY, Case(folder, "periodic", arguments.mean), 1e-9).report["approach"]
            judge, steps = Judge(side, "periodic"), {}
            for work in arguments.work:
                case = AdhesiveCase(folder, work, arguments.range, approach)
                about = {"side": side, "work": work, "range": arguments.range, "approach": approach}
                bench = AdhesiveBench(case, judge, gap, arguments.limit)
                compare(bench, programs, about, arguments, steps)


if __name__ == "__main__":
    main()
