"""A self-affine surface under a load: Tamaas and asperity side by side, to the same residual."""

import argparse
import json
import os
import re
import statistics
import subprocess
import sys
import tempfile
import time
from pathlib import Path

os.environ["OMP_NUM_THREADS"] = os.environ["RAYON_NUM_THREADS"] = "1"

import numpy as np  # noqa: E402 (threads are fixed before it is loaded)
import tamaas  # noqa: E402

from contact_residual import Judge  # noqa: E402

ROOT = Path(__file__).resolve().parents[2]
TARGET = Path(os.environ.get("CARGO_TARGET_DIR", ROOT / "target"))
PROGRAM = TARGET / "release" / "examples" / "solve_gap"
WANTED = 1e-6


def self_affine_gap(side, shortest, seed):
    """Hurst exponent 0.8, roll-off at a quarter of the side, rms slope 0.1, pitch 1; the highest point touches."""
    k = np.fft.fftfreq(side, 1 / side)
    k = np.hypot(k[:, None], k[None, :])
    inside = (k > 0) & (k <= side / shortest)
    magnitude = np.zeros_like(k)
    magnitude[inside] = np.maximum(k[inside], 4) ** -1.8
    phase = np.fft.fft2(np.random.default_rng(seed).standard_normal((side, side)))
    heights = np.fft.ifft2(magnitude * phase / np.abs(phase)).real
    slope = np.sqrt((np.abs(np.fft.fft2(heights)) ** 2 * (2 * np.pi * k / side) ** 2).sum()) / side**2
    heights *= 0.1 / slope
    return heights.max() - heights


class Captured:
    """What C code writes to standard output and error."""

    def __enter__(self):
        sys.stdout.flush()
        self.file = tempfile.TemporaryFile()
        self.saved = os.dup(1), os.dup(2)
        os.dup2(self.file.fileno(), 1)
        os.dup2(self.file.fileno(), 2)
        return self

    def __exit__(self, *_):
        for number, saved in zip((1, 2), self.saved):
            os.dup2(saved, number)
            os.close(saved)
        self.file.seek(0)
        self.text = self.file.read().decode()


def run_tamaas(gap, mean, boundary, tolerance, count=False):
    """Pressure, seconds and, on demand, convolutions. E* = 1 and pitch 1, so the size is the number of cells."""
    side = gap.shape[0]
    model = tamaas.Model(tamaas.model_type.basic_2d, [float(side)] * 2, [side] * 2)
    model.E, model.nu = 1.0, 0.0
    if boundary == "free":
        tamaas.ModelFactory.registerNonPeriodic(model, "dcfft")
    kind = tamaas.PolonskyKeerRey.type.pressure
    solver = tamaas.PolonskyKeerRey(model, np.ascontiguousarray(-gap), tolerance, kind, kind)
    if boundary == "free":
        solver.setIntegralOperator("dcfft")
    solver.max_iter, solver.dump_freq = 20_000, 1 if count else 100_000
    with Captured() as captured:
        start = time.perf_counter()
        solver.solve(mean)
        seconds = time.perf_counter() - start
    steps = re.findall(r"^\s*(\d+)\s+[-+0-9.einf]+\s+[-+0-9.einf]+", captured.text, re.M)
    # Two in each iteration of the method: the gap, and the response to the direction.
    convolutions = 2 * (max(map(int, steps)) + 1) if count else None
    return np.array(model.traction).reshape(gap.shape), seconds, convolutions


def tightened(gap, mean, boundary, judge):
    """The loosest of Tamaas's tolerances, half a decade apart, at which our residual is met; its convolutions."""
    for exponent in np.arange(6, 18, 0.5):
        pressure, _, convolutions = run_tamaas(gap, mean, boundary, 10.0**-exponent, count=True)
        if judge.eta(pressure, gap) < WANTED:
            return 10.0**-exponent, convolutions
    raise SystemExit("Tamaas does not reach the residual")


def run_asperity(path, out, mean, boundary):
    line = subprocess.run(
        [PROGRAM, path, f"mean={mean}", f"boundary={boundary}", f"tolerance={WANTED}", f"pressure={out}"],
        check=True,
        capture_output=True,
        text=True,
    )
    report = json.loads(line.stdout)
    return np.load(out), report["solve_seconds"], report["convolutions"]


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--side", type=int, default=512)
    parser.add_argument("--mean", type=float, nargs="+", default=[0.0025], help="mean pressure over E*")
    parser.add_argument("--shortest", type=float, default=8.0, help="shortest wave, cells")
    parser.add_argument("--boundary", choices=["free", "periodic"], default="free")
    parser.add_argument("--seed", type=int, default=1)
    parser.add_argument("--repeat", type=int, default=5)
    arguments = parser.parse_args()
    tamaas.initialize(1)
    gap = self_affine_gap(arguments.side, arguments.shortest, arguments.seed)
    judge = Judge(arguments.side, arguments.boundary)
    print("| mean p/E* | program | contact area | η | convolutions | seconds (median) | ratio |")
    print("|---|---|---|---|---|---|---|")
    with tempfile.TemporaryDirectory() as folder:
        path, out = Path(folder) / "gap.npy", Path(folder) / "pressure.npy"
        np.save(path, gap)
        for mean in arguments.mean:
            tolerance, theirs = tightened(gap, mean, arguments.boundary, judge)
            runs = {"Tamaas": [], "asperity": []}
            for _ in range(arguments.repeat):
                runs["Tamaas"].append(run_tamaas(gap, mean, arguments.boundary, tolerance))
                runs["asperity"].append(run_asperity(path, out, mean, arguments.boundary))
            pairs = zip(runs["Tamaas"], runs["asperity"])
            ratio = statistics.median(b[1] / a[1] for b, a in pairs)
            for program, results in runs.items():
                pressure, _, ours = results[0]
                convolutions = theirs if program == "Tamaas" else ours
                seconds = statistics.median(result[1] for result in results)
                print(
                    f"| {mean} | {program} | {(pressure > 0).mean():.4f} | {judge.eta(pressure, gap):.1e} "
                    f"| {convolutions:.1f} | {seconds:.3f} | {ratio if program == 'asperity' else 1:.1f} |",
                    flush=True,
                )


if __name__ == "__main__":
    main()
