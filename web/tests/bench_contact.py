"""Times of a static contact in the browser over those of the command with one thread: `pytest -s web/tests/bench_contact.py`.

Both compute the same rough contact in turn; the times are those of their summaries, without figures and pages.
"""

import json
import statistics
import subprocess

import pytest

ROUNDS = 5
CASE = """
lower = {{ young = 210e9, poisson = 0.3, topography = {{ generate = "low-pass", sq = 30e-9, cutoff = 30e-6, seed = 1, shape = [{n}, {n}], pitch = 1e-6 }} }}
upper = {{ young = 210e9, poisson = 0.3, topography = {{ generate = "low-pass", sq = 30e-9, cutoff = 30e-6, seed = 2, shape = [{n}, {n}], pitch = 1e-6 }} }}
contact = {{ mean_pressure = 20e6 }}
"""


@pytest.mark.parametrize("cells", [256, 512, 1024])
def test_a_contact(module, asperity, tmp_path, cells):
    case = CASE.format(n=cells)
    (tmp_path / "case.toml").write_text(case)
    module("put", "case.toml", case.encode())
    times = {"browser": [], "command": []}
    areas = set()
    for _ in range(ROUNDS):
        module("run", "case.toml", "results", "overwrite")
        subprocess.run([asperity, "run", "case.toml", "--out", "results", "--overwrite", "--threads", "1", "--quiet"], check=True, cwd=tmp_path)
        for name, text in (("browser", module("get", "results/summary.json")), ("command", (tmp_path / "results/summary.json").read_text())):
            summary = json.loads(text)
            times[name].append(summary["wall_time_s"])
            areas.add(round(summary["static"]["contact_area"] * 1e12, 6))
    median = {name: statistics.median(each) for name, each in times.items()}
    ratio = statistics.median(b / c for b, c in zip(times["browser"], times["command"]))
    print(f"{cells}²: browser {median['browser']:.2f} s, command {median['command']:.2f} s, ratio {ratio:.2f}")
    assert len(areas) == 1, areas
