"""One free convolution of ours beside FFTW's transforms of the padded size, one thread each, in turns.

`pair`: a real transform forth and back of the padded field. `convolution`: the padding, the transforms, the product
with a real kernel between them and the cut back to the grid.
"""

import argparse
import statistics
import subprocess
import time

import numpy as np
import pyfftw

from contact_residual import free_kernel
from programs import ENVIRONMENT, TARGET

OURS = "asperity, convolution"


class Fftw:
    """Measured plans of a doubled grid."""

    def __init__(self, side, effort):
        self.side = side
        self.real = pyfftw.empty_aligned((2 * side, 2 * side), "float64")
        self.spectrum = pyfftw.empty_aligned((2 * side, side + 1), "complex128")
        flags, axes = (effort,), (0, 1)
        self.forth = pyfftw.FFTW(self.real, self.spectrum, axes, "FFTW_FORWARD", flags, threads=1)
        self.back = pyfftw.FFTW(self.spectrum, self.real, axes, "FFTW_BACKWARD", flags, threads=1)
        self.kernel = free_kernel(side) / (2 * side) ** 2
        self.pressure = 1.0 + np.outer(np.arange(side), np.arange(side)) % 7
        self.displacement = np.empty((side, side))

    def fill(self):
        self.real.fill(1.0)

    def pair(self):
        self.forth.execute()
        self.back.execute()

    def convolution(self):
        n = self.side
        self.real[:n, :n] = self.pressure
        self.real[:n, n:] = 0
        self.real[n:] = 0
        self.forth.execute()
        self.spectrum *= self.kernel
        self.back.execute()
        self.displacement[:] = self.real[:n, :n]


def seconds(function, repeat, before=lambda: None):
    times = []
    for _ in range(repeat):
        before()
        start = time.perf_counter()
        function()
        times.append(time.perf_counter() - start)
    return statistics.median(times)


def taken_in_turns(side, arguments):
    """Seconds of each in every round."""
    fftw = Fftw(side, arguments.effort)
    command = [TARGET / "release" / "examples" / "free_convolution", str(side), str(arguments.repeat)]
    pipes = {"stdin": subprocess.PIPE, "stdout": subprocess.PIPE, "text": True, "bufsize": 1}
    rounds = []
    with subprocess.Popen(command, env=ENVIRONMENT, **pipes) as ours:
        for _ in range(arguments.rounds):
            ours.stdin.write("\n")
            turn = {OURS: float(ours.stdout.readline())}
            turn["FFTW, pair"] = seconds(fftw.pair, arguments.repeat, fftw.fill)
            turn["FFTW, convolution"] = seconds(fftw.convolution, arguments.repeat)
            rounds.append(turn)
        ours.stdin.close()
    return rounds


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("--side", type=int, nargs="+", default=[256, 512, 1024])
    parser.add_argument("--rounds", type=int, default=15, help="turns of each")
    parser.add_argument(
        "--repeat", type=int, default=5, help="convolutions in a turn, of which the median counts"
    )
    parser.add_argument("--effort", default="FFTW_MEASURE", help="or FFTW_PATIENT")
    arguments = parser.parse_args()
    print("| side | what | seconds | ratio to ours |\n|---|---|---|---|")
    for side in arguments.side:
        rounds = taken_in_turns(side, arguments)
        for what in rounds[0]:
            ratio = statistics.median(turn[what] / turn[OURS] for turn in rounds)
            median = statistics.median(turn[what] for turn in rounds)
            print(f"| {side} | {what} | {median:.3g} | {ratio:.2f} |", flush=True)


if __name__ == "__main__":
    main()
