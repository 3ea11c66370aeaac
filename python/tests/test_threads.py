"""Signals, threads and processes."""

from __future__ import annotations

import concurrent.futures
import multiprocessing
import os
import pathlib
import signal
import subprocess
import sys
import textwrap
import threading
import time

import asperity as asp
import numpy as np
import pytest
from conftest import rough

STEEL = asp.Material(young="210 GPa", poisson=0.3, hardness="4 GPa")


def pressed(seed: int) -> float:
    """Largest pressure of a contact; what processes compute."""
    return asp.contact(rough(seed), rough(seed + 100), STEEL, STEEL, load=0.02, progress=False).max_pressure


def interrupted(work: str, after: float, folder: pathlib.Path) -> tuple[float, str]:
    """Runs `work` in a process of its own, sends it SIGINT after `after` seconds, and gives the time it then took to end, and
    what it printed."""
    program = textwrap.dedent(
        """
        import signal
        import sys
        import asperity as asp
        # A shell lets what it runs in the background ignore Ctrl-C.
        signal.signal(signal.SIGINT, signal.default_int_handler)
        steel = asp.Material(young="210 GPa", poisson=0.3, hardness="4 GPa")
        def rough(seed, n, cutoff="8 um"):
            return asp.Surface(asp.generate.low_pass((n, n), pitch="1 um", sq="50 nm", cutoff=cutoff, seed=seed).heights, 1e-6)
        def started(*_):
            print("started", flush=True)
        try:
        {work}
            print("done", flush=True)
        except KeyboardInterrupt:
            print("interrupted", flush=True)
        """
    ).replace("{work}", textwrap.indent(textwrap.dedent(work).strip(), "    "))
    process = subprocess.Popen(
        [sys.executable, "-W", "ignore", "-c", program], stdout=subprocess.PIPE, text=True, cwd=folder
    )
    assert process.stdout is not None
    assert process.stdout.readline() == "started\n"
    time.sleep(after)
    process.send_signal(signal.SIGINT)
    sent = time.monotonic()
    printed = process.stdout.read()
    process.wait(60)
    process.stdout.close()
    return time.monotonic() - sent, printed


@pytest.mark.skipif(os.name == "nt", reason="signals of POSIX")
def test_ctrl_c_stops_a_static_contact(tmp_path: pathlib.Path) -> None:
    work = """
        lower, upper = rough(1, 1024, "4 um"), rough(2, 1024, "4 um")
        started()
        asp.contact(lower, upper, steel, steel, load=1500.0, tolerance=1e-14, method="polonsky-keer", progress=False)
    """
    took, printed = interrupted(work, 0.5, tmp_path)
    assert printed == "interrupted\n"
    # A convolution, and what the interpreter takes to end, on a machine that others use, too.
    assert took < 10.0


@pytest.mark.skipif(os.name == "nt", reason="signals of POSIX")
def test_ctrl_c_stops_a_pass_and_resume_goes_on(tmp_path: pathlib.Path) -> None:
    work = """
        seen = []
        def told(p):
            if p.pass_number >= 2 and not seen:
                seen.append(p)
                started()
        asp.simulate(rough(1, 32), rough(2, 32), steel, steel, load=0.02, passes=400, out="out", progress=told)
    """
    _, printed = interrupted(work, 0.3, tmp_path)
    assert printed.endswith("interrupted\n")
    done = asp.open(tmp_path / "out")
    assert isinstance(done, asp.Run) and 0 < len(done.passes) < 400
    count = len(done.passes) + 1

    def given(seed: int) -> asp.Surface:
        return asp.Surface(rough(seed).heights, 1e-6)

    resumed = asp.simulate(given(1), given(2), STEEL, STEEL, load=0.02, passes=count, out=tmp_path / "out", resume=True)
    whole = asp.simulate(given(1), given(2), STEEL, STEEL, load=0.02, passes=count)
    assert resumed == whole


@pytest.mark.skipif(os.name == "nt", reason="signals of POSIX")
def test_ctrl_c_stops_a_callback(tmp_path: pathlib.Path) -> None:
    work = """
        import time
        def law(p):
            started()
            time.sleep(60)
        asp.simulate(rough(1, 32), rough(2, 32), steel, steel, load=0.02, passes=2, law=law)
    """
    took, printed = interrupted(work, 0.2, tmp_path)
    assert printed == "interrupted\n" and took < 10.0


def test_an_exception_of_progress_stops_the_work() -> None:
    told = []

    def progress(p: asp.Progress) -> None:
        told.append(p)
        if len(told) == 2:
            raise LookupError("enough")

    with pytest.raises(LookupError, match="enough"):
        asp.simulate(rough(1), rough(2), STEEL, STEEL, load=0.02, passes=1000, progress=progress)
    assert len(told) == 2 and all(0.0 <= p.fraction <= 1.0 and p.passes == 1000 for p in told)


@pytest.mark.parametrize("method", multiprocessing.get_all_start_methods())
@pytest.mark.filterwarnings("ignore::DeprecationWarning")
def test_processes_of_every_kind_compute(method: str) -> None:
    here = [pressed(seed) for seed in range(3)]
    context = multiprocessing.get_context(method)
    with concurrent.futures.ProcessPoolExecutor(2, mp_context=context) as executor:
        there = list(executor.map(pressed, range(3), timeout=120))
    assert there == here


def test_threads_compute_at_once_while_another_one_ticks() -> None:
    ticks = 0
    done = threading.Event()

    def tick() -> None:
        nonlocal ticks
        while not done.is_set():
            ticks += 1
            time.sleep(0.001)

    def run(seed: int) -> asp.Run:
        return asp.simulate(rough(seed), rough(seed + 1), STEEL, STEEL, load=0.02, passes=4, threads=1, progress=False)

    ticker = threading.Thread(target=tick)
    ticker.start()
    began = time.monotonic()
    with concurrent.futures.ThreadPoolExecutor(2) as executor:
        both = list(executor.map(run, (1, 5)))
    took = time.monotonic() - began
    done.set()
    ticker.join()
    # A thread that never gets the interpreter would not tick at all: many ticks came through.
    assert ticks > 20 * took
    assert both == [run(1), run(5)]


def test_one_simulation_serves_one_thread_at_a_time() -> None:
    simulation = asp.Simulation(rough(1), rough(2), STEEL, STEEL, load=0.02, passes=3)

    def progress(_: object) -> None:
        with pytest.raises(RuntimeError, match="another thread"):
            _ = simulation.done

    simulation._progress = progress
    for _ in simulation:
        pass
    assert len(simulation.results().passes) == 3


def test_joblib_takes_and_gives_objects() -> None:
    joblib = pytest.importorskip("joblib")
    work = joblib.Parallel(n_jobs=2)
    contacts = work(
        joblib.delayed(asp.contact)(rough(s), rough(9), STEEL, STEEL, load=0.02, progress=False) for s in (1, 2)
    )
    assert contacts == [asp.contact(rough(s), rough(9), STEEL, STEEL, load=0.02) for s in (1, 2)]


@pytest.mark.filterwarnings("ignore")
def test_dask_takes_and_gives_objects() -> None:
    distributed = pytest.importorskip("distributed")
    with (
        distributed.LocalCluster(n_workers=2, threads_per_worker=1, dashboard_address=None) as cluster,
        distributed.Client(cluster) as client,
    ):
        futures = [
            client.submit(asp.contact, rough(s), rough(9), STEEL, STEEL, load=0.02, progress=False) for s in (1, 2)
        ]
        run = client.submit(asp.simulate, rough(1), rough(9), STEEL, STEEL, load=0.02, progress=False)
        assert client.gather(futures) == [asp.contact(rough(s), rough(9), STEEL, STEEL, load=0.02) for s in (1, 2)]
        assert run.result() == asp.simulate(rough(1), rough(9), STEEL, STEEL, load=0.02)


def test_the_command_is_that_of_the_library() -> None:
    run = subprocess.run([sys.executable, "-m", "asperity", "--version"], capture_output=True, text=True, check=True)
    assert run.stdout.split() == ["asperity", asp.__version__]
    bad = subprocess.run([sys.executable, "-m", "asperity", "run", "nowhere.toml"], capture_output=True, text=True)
    assert bad.returncode == 2 and "nowhere.toml" in bad.stderr


def test_importing_brings_nothing_but_numpy() -> None:
    program = "import sys, numpy; before = set(sys.modules); import asperity; print(*sorted(set(sys.modules) - before))"
    run = subprocess.run([sys.executable, "-c", program], capture_output=True, text=True, check=True)
    brought = {name.split(".")[0] for name in run.stdout.split()}
    assert brought & {"xarray", "matplotlib", "pandas", "tqdm", "h5py", "dask"} == set()


def test_arrays_given_out_are_not_shared_with_what_computes() -> None:
    simulation = asp.Simulation(rough(1), rough(2), STEEL, STEEL, load=0.02, passes=1)
    before = simulation.lower
    before += 1.0
    assert np.abs(simulation.lower).max() < 1e-6
