"""Self-affine surfaces pressed against a flat: every peer beside asperity, to the same residual, one thread each.

Prints Markdown tables; with `--json FILE` every row is also appended to a file as a line of JSON.
"""

import argparse
import math
import tempfile
from pathlib import Path
from typing import NamedTuple

import numpy as np

from bench import WANTED, Bench, Table, add_options
from contact_residual import Judge
from programs import ASPERITY, PROGRAMS, Case, peers, run
from surfaces import self_affine_gap


class Run(NamedTuple):
    eta: float
    load_error: float
    area: float
    capped: float
    seconds: float
    convolutions: float
    iterations: float | None = None

    @property
    def miss(self):
        """How far the answer is from what is wanted: met below 1."""
        return max(self.eta, self.load_error) / WANTED

    @property
    def merit(self):
        """The less, the better among the variants of a program."""
        return (self.miss >= 1, self.seconds)

    @property
    def remark(self):
        return "" if self.miss < 1 else ", residual not met"


class StaticBench(Bench):
    """A contact under a load."""

    def judged(self, answer):
        p = answer.pressure
        return Run(
            self.judge.eta(p, self.gap, self.case.hardness),
            abs(p.mean() / self.case.mean - 1),
            (p > 0).mean(),
            (p >= self.case.hardness * (1 - 1e-12)).sum() / (p > 0).sum(),
            answer.report["solve_seconds"],
            answer.report["convolutions"],
            answer.report.get("iterations"),
        )


def two_digits(number):
    return float(f"{number:.1e}")


def mean_for_area(folder, boundary, area):
    """The mean pressure, to two digits, at which about this share of the surface is in contact."""
    mean = 0.05 * area
    for _ in range(30):
        found = run(ASPERITY, Case(folder, boundary, mean), 1e-3).report["area"]
        if abs(found / area - 1) < 0.01:
            break
        mean *= area / found
    return two_digits(mean)


def hardness_for_share(folder, boundary, mean, share):
    """The hardness, to two digits, at which about this share of the contact is at the cap."""
    pressure = run(ASPERITY, Case(folder, boundary, mean), 1e-3).pressure
    low, high = np.quantile(pressure[pressure > 0], [1 - 3 * share, 1])
    for _ in range(10):
        middle = math.sqrt(low * high)
        report = run(ASPERITY, Case(folder, boundary, mean, middle), 1e-3).report
        low, high = (middle, high) if report["plastic"] > share * report["area"] else (low, middle)
    return two_digits(high)


class StaticTable(Table):
    """The contacts of one surface under one boundary."""

    parameters = ("p/E*",)
    findings = ("contact area", "η", "load error")

    def case_values(self, case):
        return {"mean": case.mean, "hardness": case.hardness if math.isfinite(case.hardness) else None}

    def case_cells(self, case):
        return [f"{case.mean:g}"]

    def run_cells(self, case, outcome):
        area = f"{100 * outcome.area:.1f} %"
        if math.isfinite(case.hardness):
            area += f", {100 * outcome.capped:.0f} % of it at H = {case.hardness:g} E*"
        return [area, f"{outcome.eta:.1e}", f"{outcome.load_error:.0e}"]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--side", type=int, nargs="+", default=[512])
    parser.add_argument("--boundary", nargs="+", default=["free", "periodic"], choices=["free", "periodic"])
    parser.add_argument("--shortest", type=float, nargs="+", default=[8, 2], help="shortest wave, cells")
    parser.add_argument(
        "--area", type=float, nargs="+", default=[1, 5, 20, 60], help="contact area, per cent"
    )
    parser.add_argument(
        "--mean", type=float, nargs="+", help="mean pressure over E*, in place of the contact area"
    )
    parser.add_argument("--hardness", action="store_true", help="a cap that holds a tenth of the contact")
    parser.add_argument("--programs", nargs="+", choices=PROGRAMS, help="default: all")
    parser.add_argument("--slippy-python", help="the interpreter, 3.9 or older, that has slippy")
    parser.add_argument("--seed", type=int, default=1)
    add_options(parser, limit=300)
    arguments = parser.parse_args()

    with tempfile.TemporaryDirectory() as folder:
        folder = Path(folder)
        for side in arguments.side:
            for shortest in arguments.shortest:
                gap = self_affine_gap(side, shortest, arguments.seed)
                np.save(folder / "gap.npy", gap)
                for boundary in arguments.boundary:
                    programs = peers(boundary, arguments.hardness, arguments.slippy_python)
                    chosen = {key: programs[key] for key in arguments.programs or programs if key in programs}
                    about = {"boundary": boundary, "side": side, "shortest wave": shortest}
                    table, judge, steps = StaticTable(about, arguments.json), Judge(side, boundary), {}
                    found = (mean_for_area(folder, boundary, percent / 100) for percent in arguments.area)
                    for mean in arguments.mean or found:
                        case = Case(folder, boundary, mean)
                        if arguments.hardness:
                            case = case._replace(hardness=hardness_for_share(folder, boundary, mean, 0.1))
                        else:
                            case = case._replace(approach=run(ASPERITY, case, 1e-9).report["approach"])
                        bench = StaticBench(case, judge, gap, arguments.limit)
                        bench.compare(table, chosen, arguments, steps)


if __name__ == "__main__":
    main()
