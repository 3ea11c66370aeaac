"""Runs each example whose contacts a device solves on the GPU and on the processor, and compares their results.

    python benches/gpu/examples.py ASPERITY [NAME ...]

ASPERITY is a program built with the feature `cuda`. Prints, for each example, the largest relative difference of load, approach,
contact area and largest pressure, and both times.
"""

import json
import subprocess
import sys
import tempfile
import time
from pathlib import Path

KEYS = ("load", "approach", "contact_area", "max_pressure", "mean_gap", "mean_load", "mean_contact_area", "plastic_volume")


def numbers(value, path=""):
    """Yields the numbers of a summary with their keys."""
    if isinstance(value, dict):
        for key, inner in value.items():
            yield from numbers(inner, f"{path}.{key}")
    elif isinstance(value, list):
        for index, inner in enumerate(value):
            yield from numbers(inner, f"{path}.{index}")
    elif isinstance(value, (int, float)) and not isinstance(value, bool):
        yield path.lstrip("."), float(value)


def run(program, name, device, folder):
    out = Path(folder) / f"{name}-{device}"
    began = time.time()
    command = [program, "run", "--example", name, "--out", str(out), "--device", device, "--quiet"]
    done = subprocess.run(command, capture_output=True, text=True)
    if done.returncode:
        return (done.stderr.strip().splitlines() or ["failed"])[0], None
    return json.loads((out / "results" / "summary.json").read_text()), time.time() - began


def main(program, *names):
    names = names or [line.split()[0] for line in subprocess.check_output([program, "example"], text=True).splitlines() if line[:1].isalpha()]
    print("| example | largest difference | of | GPU, s | processor, s |\n|---|---|---|---|---|", flush=True)
    with tempfile.TemporaryDirectory() as folder:
        for name in names:
            found, on_gpu = run(program, name, "cuda", folder)
            if on_gpu is None:
                print(f"| {name} | {found} | | | |", flush=True)
                continue
            expected, on_processor = run(program, name, "cpu", folder)
            if on_processor is None:
                print(f"| {name} | on the processor: {expected} | | | |", flush=True)
                continue
            others = dict(numbers(found))
            worst = max(
                ((abs(others.get(key, 0.0) - value) / abs(value), key) for key, value in numbers(expected) if key.split(".")[-1] in KEYS and value),
                default=(0.0, "nothing"),
            )
            print(f"| {name} | {worst[0]:.1e} | {worst[1]} | {on_gpu:.2f} | {on_processor:.2f} |", flush=True)


if __name__ == "__main__":
    main(*sys.argv[1:])
