"""Self-affine surfaces pressed against a flat: every peer beside asperity, to the same residual, one thread each.

Prints Markdown tables; with `--json FILE` every row is also appended to a file as a line of JSON.
"""

import argparse
import json
import math
import statistics
import tempfile
from pathlib import Path
from typing import NamedTuple

import numpy as np

from contact_residual import Judge
from programs import ASPERITY, PROGRAMS, Case, peers, run
from surfaces import self_affine_gap

WANTED = 1e-6
"""What the residual must stay below, and the relative error of the load."""


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


class Bench:
    """One case, and all that is run on it."""

    ours = ASPERITY

    def __init__(self, case, judge, gap, limit):
        self.case, self.judge, self.gap, self.limit = case, judge, gap, limit

    def run(self, program, tolerance, options=(), limit=None):
        answer = run(program, self.case, tolerance, options, limit or self.limit)
        return answer and self.judged(answer)

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

    def tightened(self, program, options, start, limit):
        """The loosest tolerance, on steps of half a decade, that meets what is wanted, and its run.

        Where none does: the best run; None where the limit ends the search.
        """
        runs, step = {}, start
        while step not in runs and len(runs) < 12:
            outcome = self.run(program, tolerance(step), options, limit)
            if outcome is None:
                break
            runs[step] = outcome
            unmet = max((s for s in runs if runs[s].miss >= 1), default=-math.inf)
            # A residual usually falls with the tolerance, which gives the next step; no looser than one that failed.
            step = max(step + math.ceil(2 * math.log10(max(outcome.miss, 1e-3))), unmet + 1)
        met = [s for s in runs if runs[s].miss < 1]
        if not runs or (outcome is None and not met):
            return None, None
        best = min(met) if met else min(runs, key=lambda s: runs[s].miss)
        return best, runs[best]

    def prepared(self, program, start):
        """The fastest setting that meets what is wanted: options, step of the tolerance, run."""
        chosen = None
        for options in program.variants:
            limit = self.limit if chosen is None else min(self.limit, 2 * chosen[2].seconds + 10)
            step, outcome = self.tightened(program, options, chosen[1] if chosen else start, limit)
            if outcome is None:
                if chosen and program.ordered:
                    break
                continue
            if chosen and program.ordered:
                if outcome.miss >= 1 or outcome.convolutions >= chosen[2].convolutions:
                    break
            elif chosen and outcome.merit >= chosen[2].merit:
                continue
            chosen = options, step, outcome
        return chosen

    def beside(self, program, options, step, repeat):
        """Ours and the peer's, in turns."""
        pairs = [
            (self.run(self.ours, WANTED), self.run(program, tolerance(step), options)) for _ in range(repeat)
        ]
        return [pair for pair in pairs if None not in pair]


def tolerance(step):
    return 10.0 ** (-step / 2)


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


class Table:
    """Rows as Markdown, and as lines of JSON where a file is given."""

    def __init__(self, about, path):
        self.about, self.path = about, path
        print("\n" + ", ".join(f"{key} {value}" for key, value in about.items()) + "\n")
        print("| contact area | p/E* | program | η | load error | convolutions | iterations | seconds | ratio |")
        print("|---|---|---|---|---|---|---|---|---|", flush=True)

    def row(self, case, program, outcome, seconds, ratio, remark=""):
        values = {
            "program": program.name,
            "mean": case.mean,
            "hardness": case.hardness if math.isfinite(case.hardness) else None,
            "remark": remark,
            "seconds": seconds,
            "ratio": ratio,
        }
        cells = [f"{case.mean:g}", program.name + remark]
        if outcome is None:
            cells = ["", *cells, "", "", "", "", f"> {seconds:.0f}", f"> {ratio:.0f}"]
        else:
            values |= outcome._asdict() | {"seconds": seconds}
            area = f"{100 * outcome.area:.1f} %"
            if math.isfinite(case.hardness):
                area += f", {100 * outcome.capped:.0f} % of it at H = {case.hardness:g} E*"
            cells = [area, *cells, f"{outcome.eta:.1e}", f"{outcome.load_error:.0e}"]
            cells += [f"{outcome.convolutions:.4g}", f"{outcome.iterations or ''}"]
            cells += [f"{seconds:.3g}", f"{ratio:.3g}" if ratio else ""]
        print("| " + " | ".join(cells) + " |", flush=True)
        if self.path:
            with open(self.path, "a") as file:
                file.write(json.dumps(self.about | values) + "\n")


def compare(bench, table, programs, arguments, steps):
    """All rows of one case; `steps` remembers the tolerances from case to case."""
    ours, rows = [], []
    first = bench.run(ASPERITY, WANTED)
    for key, program in programs.items():
        if key == "polonsky-keer":
            chosen = [], round(-2 * math.log10(WANTED)), bench.run(program, WANTED)
        else:
            chosen = bench.prepared(program, steps.get(key, 12))
        if chosen is None or chosen[2] is None:
            rows.append(
                (program, None, arguments.limit, arguments.limit / first.seconds, ", not within the limit")
            )
            continue
        options, steps[key], outcome = chosen
        repeat = max(1, min(arguments.repeat, int(arguments.budget / outcome.seconds)))
        pairs = bench.beside(program, options, steps[key], repeat) or [(first, outcome)]
        ours += [pair[0].seconds for pair in pairs]
        seconds = statistics.median(pair[1].seconds for pair in pairs)
        ratio = statistics.median(pair[1].seconds / pair[0].seconds for pair in pairs)
        remark = "".join(f", {option}" for option in options) + (
            "" if outcome.miss < 1 else ", residual not met"
        )
        rows.append((program, outcome, seconds, ratio, remark))
    table.row(bench.case, ASPERITY, first, statistics.median(ours or [first.seconds]), None)
    for row in rows:
        table.row(bench.case, *row)


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
    parser.add_argument("--repeat", type=int, default=3)
    parser.add_argument(
        "--budget", type=float, default=60, help="fewer repetitions where they take longer, seconds"
    )
    parser.add_argument("--limit", type=float, default=300, help="what one run of a peer may take, seconds")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--json", help="file to append the rows to")
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
                    table, judge, steps = Table(about, arguments.json), Judge(side, boundary), {}
                    found = (mean_for_area(folder, boundary, percent / 100) for percent in arguments.area)
                    for mean in arguments.mean or found:
                        case = Case(folder, boundary, mean)
                        if arguments.hardness:
                            case = case._replace(hardness=hardness_for_share(folder, boundary, mean, 0.1))
                        else:
                            case = case._replace(approach=run(ASPERITY, case, 1e-9).report["approach"])
                        compare(Bench(case, judge, gap, arguments.limit), table, chosen, arguments, steps)


if __name__ == "__main__":
    main()
