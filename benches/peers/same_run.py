"""Runs `press` of one file under `same/` in the interpreter that has its program, and prints how long it took.

    same_run.py FILE heights.npy SIDE MEAN_PRESSURE TOLERANCE pressure.npy

Told is the processor time, of all threads, which other work on the machine disturbs less; imports are counted for nobody. One
line of JSON goes to standard output.
"""

import importlib.util
import json
import os
import sys
import tempfile
import time

import numpy as np

from runner import Captured


def main():
    file, heights, side, mean, tolerance, out = sys.argv[1:]
    specification = importlib.util.spec_from_file_location("program", file)
    program = importlib.util.module_from_spec(specification)
    specification.loader.exec_module(program)
    heights, side, mean, out = np.load(heights), float(side), float(mean), os.path.abspath(out)
    os.chdir(tempfile.mkdtemp())  # slippy leaves files where it runs
    with Captured():
        start = time.process_time()
        pressure = program.press(heights, side, mean, float(tolerance))
        seconds = time.process_time() - start
    np.save(out, np.reshape(pressure, heights.shape))
    print(json.dumps({"seconds": seconds}))


main()
