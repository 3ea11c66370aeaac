"""Computes the Contact-Mechanics Challenge on several grids and writes the tables of the documents.

python benches/challenge/challenge.py run FOLDER      computes what FOLDER lacks, by the example `contact_challenge`
python benches/challenge/challenge.py write FOLDER    writes the tables from FOLDER into docs/challenge.md and docs/performance.md
"""

import json
import os
import re
import statistics
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).parents[2]
PROGRAM = ROOT / "target/release/examples/contact_challenge"
BUILD = ["cargo", "build", "--release", "-p", "asperity", "--no-default-features", "--example", "contact_challenge"]
WHOLE = "100"
LOADS = "0.02,0.05,0.1,0.2,0.5,1,2,5"
GRIDS = [512, 1024, 2048]
# Grids of which only the contact at 250 kPa is computed, from a cold start. The largest takes 14 GB.
COLD_GRIDS = [2048, 4096, 8192, 16384]
SEEDS = [1, 2, 3, 4, 5, 6]
SEEDED = 512
# A piece of the surface on which a grid resolves the true range.
PIECE, PIECE_GRIDS, PIECE_LOADS = "0.47", [256, 512, 1024], "1,2,5,10,20"
NAMES = {"none": "without adhesion", "grid": "range of the grid", "true": "2.071 nm"}

COLD = [(cells, 1, "none", WHOLE, "1") for cells in COLD_GRIDS]
RUNS = [
    *COLD,
    *[(cells, 1, kind, WHOLE, LOADS) for cells in GRIDS[:-1] for kind in ("none", "grid")],
    (GRIDS[-1], 1, "none", WHOLE, LOADS),
    (GRIDS[-1], 1, "grid", WHOLE, "1"),
    (4096, 1, "grid", WHOLE, "1"),
    (512, 1, "true", WHOLE, LOADS),
    *[(SEEDED, seed, kind, WHOLE, LOADS) for seed in SEEDS[1:] for kind in ("none", "grid")],
    *[(cells, 1, kind, PIECE, PIECE_LOADS) for cells in PIECE_GRIDS for kind in ("none", "grid") if (cells, kind) != (1024, "grid")],
    (PIECE_GRIDS[0], 1, "true", PIECE, PIECE_LOADS),
    (PIECE_GRIDS[-1], 1, "true", PIECE, "1"),
]


def path(folder, cells, seed, kind, width, loads):
    return Path(folder) / f"{cells}-{seed}-{kind}-{width}-{loads}.json"


def run(folder):
    Path(folder).mkdir(parents=True, exist_ok=True)
    subprocess.run(BUILD, cwd=ROOT, check=True)
    for key in RUNS:
        out = path(folder, *key)
        if not out.exists():
            with subprocess.Popen([PROGRAM, *map(str, key)], stdout=subprocess.PIPE, text=True) as process:
                done = process.stdout.read()
                _, status, usage = os.wait4(process.pid, 0)
                process.returncode = os.waitstatus_to_exitcode(status)
            if process.returncode:
                raise SystemExit(f"{PROGRAM.name} {key} ended with {process.returncode}")
            out.write_text(done + json.dumps({"peak_bytes": 1024 * usage.ru_maxrss}) + "\n")
            print(out.name, flush=True)


class Run:
    """The states of one run, the distributions at 250 kPa, and the peak memory in bytes."""

    def __init__(self, lines):
        self.head, *rest = map(json.loads, lines)
        self.states = {row["load"]: row for row in rest if "load" in row}
        self.distributions = next((row for row in rest if "patches" in row), None)
        self.peak = rest[-1]["peak_bytes"]


def load(folder, keys):
    files = {key[:4]: path(folder, *key) for key in keys}
    return {key: Run(file.read_text().splitlines()) for key, file in files.items() if file.exists()}


def table(head, rows):
    lines = ["| " + " | ".join(head) + " |", "|" + "---|" * len(head)]
    return "\n".join([*lines, *("| " + " | ".join(row) + " |" for row in rows)]) + "\n"


def over_load(runs, value, width, grids, loads):
    """A row for each load, a column for each grid and range."""
    keys = [(cells, 1, kind, width) for kind in NAMES for cells in grids if (cells, 1, kind, width) in runs]
    head = ["p̄, kPa", *(f"{cells}² {NAMES[kind]}" for cells, _, kind, _ in keys)]
    rows = []
    for factor in map(float, loads.split(",")):
        cells = [runs[key].states.get(factor) for key in keys]
        rows.append([f"{250 * factor:g}", *(value(state) if state else "" for state in cells)])
    return table(head, rows)


def area(state):
    return f"{100 * state['contact_fraction']:.3f}"


def gap(unit, digits):
    return lambda state: f"{state['mean_gap'] / unit:.{digits}f}"


def grids(runs):
    rows = []
    for (cells, seed, kind, width), run in runs.items():
        if width != WHOLE or seed != 1 or 1.0 not in run.states:
            continue
        at, head = run.states[1.0], run.head
        rows.append([
            f"{cells}²", NAMES[kind], f"{1e9 * head['pitch']:.1f}", f"{1e9 * head['shortest']:.0f}", f"{head['slope']:.3f}",
            f"{head['range_nm']:.2f}" if head["range_nm"] else "–",
            f"{head['process_zone_cells']:.4f}".rstrip("0").rstrip(".") if head["range_nm"] else "–",
            area(at), f"{1e9 * at['mean_gap']:.1f}", f"{at['convolutions']:.0f}",
        ])
    head = ["grid", "adhesion", "pitch, nm", "shortest wave, nm", "rms slope", "range, nm", "zone, cells", "area, %", "mean gap, nm",
            "convolutions"]
    return table(head, rows)


def seeds(runs):
    rows = []
    for kind in ("none", "grid"):
        some = [runs[key] for seed in SEEDS if (key := (SEEDED, seed, kind, WHOLE)) in runs]
        some = [run for run in some if 1.0 in run.states and run.distributions]
        if len(some) < 2:
            continue

        def spread(values, digits):
            return f"{statistics.mean(values):.{digits}f} ± {statistics.stdev(values):.{digits}f}"

        rows.append([
            NAMES[kind], str(len(some)),
            *(spread([100 * run.states[factor]["contact_fraction"] for run in some], 3) for factor in (0.1, 1.0, 5.0)),
            spread([1e9 * run.states[1.0]["mean_gap"] for run in some], 0),
            spread([run.distributions["patches"] for run in some], 0),
            spread([run.distributions["largest_patch_um2"] for run in some], 1),
        ])
    head = ["adhesion", "seeds", "area at 25 kPa, %", "at 250 kPa, %", "at 1250 kPa, %", "mean gap at 250 kPa, nm", "patches",
            "largest patch, µm²"]
    return table(head, rows)


def distribution(runs, key, unit):
    """Densities on the finest grid that has both kinds."""
    both = [cells for cells in GRIDS if all(getattr(runs.get((cells, 1, kind, WHOLE)), "distributions", None) for kind in ("none", "grid"))]
    cells = both[-1]
    columns = [runs[cells, 1, kind, WHOLE].distributions[key] for kind in ("none", "grid")]
    rows = []
    for one, other in zip(*columns):
        if one[2] or other[2]:
            rows.append([f"{one[0]:.4g} … {one[1]:.4g}", *(f"{bin[2]:.3g}" for bin in (one, other))])
    return table([f"{unit}, {cells}²", "without adhesion", "range of the grid"], rows)


def cold(runs):
    """Cost and result of the contact at 250 kPa from a cold start."""
    rows = []
    for (cells, *_), run in runs.items():
        at = run.states[1.0]
        rows.append([
            f"{cells}²", f"{1e9 * run.head['pitch']:.1f}", f"{1e9 * run.head['shortest']:.0f}", f"{run.head['slope']:.3f}", area(at),
            f"{1e9 * at['mean_gap']:.1f}", f"{at['convolutions']:.1f}", f"{at['seconds']:.1f}", f"{1e-9 * run.peak:.2f}",
            f"{run.peak / cells**2:.0f}",
        ])
    head = ["grid", "pitch, nm", "shortest wave, nm", "rms slope", "area, %", "mean gap, nm", "convolutions", "solve, s", "peak memory, GB",
            "bytes per cell"]
    return table(head, rows)


def put(page, tables):
    text = page.read_text()
    for name, made in tables.items():
        text, count = re.subn(rf"(<!-- table: {name} -->\n\n)(?:\|.*\n)*", lambda match: match.group(1) + made, text)
        assert count == 1, name
    page.write_text(text)


def write(folder):
    large = load(folder, COLD)
    runs = load(folder, [key for key in RUNS if key not in COLD])
    put(ROOT / "docs/performance.md", {"challenge": cold(large)})
    put(ROOT / "docs/challenge.md", {
        "grids": grids(runs | {key: run for key, run in large.items() if key not in runs}),
        "area": over_load(runs, area, WHOLE, GRIDS, LOADS),
        "gap": over_load(runs, gap(1e-9, 1), WHOLE, GRIDS, LOADS),
        "seeds": seeds(runs),
        "pressure": distribution(runs, "pressure_over_modulus", "p/E*"),
        "gaps": distribution(runs, "gap_um", "g, µm"),
        "patches": distribution(runs, "patch_area_um2", "patch, µm²"),
        "piece": over_load(runs, area, PIECE, PIECE_GRIDS, PIECE_LOADS),
    })


if __name__ == "__main__":
    {"run": run, "write": write}[sys.argv[1]](sys.argv[2])
