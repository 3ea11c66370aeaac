"""One contact in several programs, in turns, and the table of what they take."""

import json
import math
import statistics

from programs import ASPERITY, run

WANTED = 1e-6
"""What the residual must stay below, and the relative error of the load."""


def tolerance(step):
    return 10.0 ** (-step / 2)


def add_options(parser, limit):
    """The options that all tables take."""
    parser.add_argument("--repeat", type=int, default=3)
    parser.add_argument(
        "--budget", type=float, default=60, help="fewer repetitions where they take longer, seconds"
    )
    parser.add_argument("--limit", type=float, default=limit, help="what one run of a peer may take, seconds")
    parser.add_argument("--json", help="file to append the rows to")


class Bench:
    """One case, and all that is run on it. `judged` makes a run of an answer: with `miss`, `merit`, `remark`, and its cost."""

    ours = ASPERITY

    def __init__(self, case, judge, gap, limit):
        self.case, self.judge, self.gap, self.limit = case, judge, gap, limit

    def run(self, program, tolerance, options=(), limit=None):
        answer = run(program, self.case, tolerance, options, limit or self.limit)
        return answer and self.judged(answer)

    def judged(self, answer):
        raise NotImplementedError

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

    def compare(self, table, programs, arguments, steps):
        """All rows of the case; `steps` remembers the tolerances from case to case."""
        ours, rows = [], []
        first = self.run(self.ours, WANTED)
        for key, program in programs.items():
            if key == "polonsky-keer":
                chosen = [], round(-2 * math.log10(WANTED)), self.run(program, WANTED)
            else:
                chosen = self.prepared(program, steps.get(key, 12))
            if chosen is None or chosen[2] is None:
                late = arguments.limit, arguments.limit / first.seconds, ", not within the limit"
                rows.append((program, None, *late))
                continue
            options, steps[key], outcome = chosen
            repeat = max(1, min(arguments.repeat, int(arguments.budget / outcome.seconds)))
            pairs = self.beside(program, options, steps[key], repeat) or [(first, outcome)]
            ours += [pair[0].seconds for pair in pairs]
            seconds = statistics.median(pair[1].seconds for pair in pairs)
            ratio = statistics.median(pair[1].seconds / pair[0].seconds for pair in pairs)
            remark = "".join(f", {option}" for option in options) + outcome.remark
            rows.append((program, outcome, seconds, ratio, remark))
        table.row(self.case, self.ours, first, statistics.median(ours or [first.seconds]), None)
        for row in rows:
            table.row(self.case, *row)


class Table:
    """Rows as Markdown, and as lines of JSON where a file is given."""

    parameters = ()
    """Heads of the columns of `case_cells`."""
    findings = ()
    """Heads of the columns of `run_cells`, beside its cost."""

    def __init__(self, about, path):
        self.about, self.path = about, path
        heads = [*self.parameters, "program", *self.findings, "convolutions", "iterations", "seconds", "ratio"]
        print("\n" + ", ".join(f"{key} {value}" for key, value in about.items()) + "\n")
        print("| " + " | ".join(heads) + " |")
        print("|" + "---|" * len(heads), flush=True)

    def row(self, case, program, outcome, seconds, ratio, remark=""):
        values = self.about | self.case_values(case) | {"program": program.name, "remark": remark, "ratio": ratio}
        cells = [*self.case_cells(case), program.name + remark]
        if outcome is None:
            cells += [""] * (len(self.findings) + 2) + [f"> {seconds:.0f}", f"> {ratio:.0f}"]
        else:
            values |= outcome._asdict()
            cells += self.run_cells(case, outcome)
            cells += [f"{outcome.convolutions:.4g}", f"{outcome.iterations or ''}"]
            cells += [f"{seconds:.3g}", f"{ratio:.3g}" if ratio else ""]
        print("| " + " | ".join(cells) + " |", flush=True)
        if self.path:
            with open(self.path, "a") as file:
                file.write(json.dumps(values | {"seconds": seconds}, default=float) + "\n")

    def case_values(self, case):
        raise NotImplementedError

    def case_cells(self, case):
        raise NotImplementedError

    def run_cells(self, case, outcome):
        raise NotImplementedError
