"""How a program gets its task and returns its answer: the command line of the example `solve_gap`.

    run_PEER.py gap.npy mean=0.01 tolerance=1e-8 pressure=out.npy [boundary=free] [hardness=inf] [approach=0] ...

The composite modulus and the pitch are 1. One line of JSON goes to standard output, as `solve_gap` prints it.
"""

import argparse
import json
import os
import re
import sys
import tempfile

import numpy as np


def task(**extra):
    """The options, with the undeformed gap; those of one program alone come with their defaults as `extra`."""
    path, *pairs = sys.argv[1:]
    defaults = dict(
        mean=0.01, tolerance=1e-8, boundary="free", hardness=np.inf, approach=0.0, pressure="", **extra
    )
    given = dict(pair.split("=", 1) for pair in pairs)
    unknown = given.keys() - defaults.keys()
    if unknown:
        raise SystemExit(f"unknown options: {', '.join(sorted(unknown))}")
    options = {key: type(default)(given.get(key, default)) for key, default in defaults.items()}
    return argparse.Namespace(gap=np.load(path), **options)


def answer(options, pressure, seconds, convolutions, **more):
    """Writes the pressure and prints the cost."""
    np.save(options.pressure, pressure)
    print(json.dumps({"solve_seconds": seconds, "convolutions": convolutions, **more}), flush=True)


class Captured:
    """What the program, C code included, writes to standard output and error."""

    def __enter__(self):
        sys.stdout.flush()
        self.file = tempfile.TemporaryFile()
        self.saved = os.dup(1), os.dup(2)
        for stream in (1, 2):
            os.dup2(self.file.fileno(), stream)
        return self

    def __exit__(self, *_):
        sys.stdout.flush()
        for stream, saved in zip((1, 2), self.saved):
            os.dup2(saved, stream)
            os.close(saved)
        self.file.seek(0)
        self.text = self.file.read().decode()


class Counted:
    """A function and how often it was called."""

    def __init__(self, function):
        self.function = function
        self.calls = 0

    def __call__(self, *arguments, **options):
        self.calls += 1
        return self.function(*arguments, **options)


def tamaas_iterations(log):
    """The number of iterations in a log of Tamaas.

    A block of the log begins at 0 and ends with its number of iterations; KatoSaturated writes several.
    """
    line = re.compile(r"^\s*(\d+)\s+[-+0-9.einfa]+\s+[-+0-9.einfa]+\s*$", re.MULTILINE)
    steps = [int(step) for step in line.findall(log)]
    ends = [step for step, following in zip(steps, steps[1:] + [0]) if following == 0]
    return sum(end + 1 for end in ends)
