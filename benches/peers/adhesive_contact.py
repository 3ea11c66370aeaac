"""Rough surfaces that attract each other: peers beside asperity, to the same residual, one thread each.

A periodic self-affine surface comes from afar to the approach at which it would carry a given mean pressure without
adhesion. Prints Markdown tables; with `--json FILE` every row is also appended to a file as a line of JSON.
"""

import argparse
import tempfile
from pathlib import Path
from typing import NamedTuple

import numpy as np

from bench import WANTED, Bench, Table, add_options
from contact_residual import Judge
from programs import ADHESIVE_ASPERITY, ADHESIVE_PROGRAMS, ASPERITY, AdhesiveCase, Case, adhesive_peers, run
from surfaces import self_affine_gap

SHORTEST = 16
"""Shortest wave, cells."""
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
        return (self.miss >= 1, self.difference >= SAME_STATE, self.seconds)

    @property
    def remark(self):
        remark = "" if self.miss < 1 else ", residual not met"
        return remark + ("" if self.difference < SAME_STATE else ", another state")


class AdhesiveBench(Bench):
    """A contact with adhesion at an approach, beside the answer of ours."""

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


class AdhesiveTable(Table):
    """The contacts of one surface."""

    parameters = ("w/E*",)
    findings = ("mean p/E*", "contact", "difference", "η")

    def case_values(self, case):
        return {"work": case.work, "range": case.range, "approach": case.approach}

    def case_cells(self, case):
        return [f"{case.work:g}"]

    def run_cells(self, case, outcome):
        cells = [f"{outcome.mean:.6g}", f"{100 * outcome.area:.2f} %"]
        return cells + [f"{outcome.difference:.0e}", f"{outcome.eta:.1e}"]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--side", type=int, nargs="+", default=[64, 128, 256])
    parser.add_argument(
        "--work", type=float, nargs="+", default=[0.002, 0.01, 0.03, 0.06], help="over E* and the cell"
    )
    parser.add_argument("--range", type=float, default=0.5, help="cells")
    parser.add_argument("--mean", type=float, default=0.01, help="mean pressure without adhesion, over E*")
    parser.add_argument("--programs", nargs="+", choices=ADHESIVE_PROGRAMS, default=ADHESIVE_PROGRAMS)
    parser.add_argument("--seed", type=int, default=0)
    add_options(parser, limit=120)
    arguments = parser.parse_args()

    programs = {key: adhesive_peers()[key] for key in arguments.programs}
    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        for side in arguments.side:
            gap = self_affine_gap(side, SHORTEST, arguments.seed)
            np.save(folder / "gap.npy", gap)
            approach = run(ASPERITY, Case(folder, "periodic", arguments.mean), 1e-9).report["approach"]
            table, judge, steps = AdhesiveTable({"side": side}, arguments.json), Judge(side, "periodic"), {}
            for work in arguments.work:
                case = AdhesiveCase(folder, work, arguments.range, approach)
                bench = AdhesiveBench(case, judge, gap, arguments.limit)
                bench.compare(table, programs, arguments, steps)


if __name__ == "__main__":
    main()
