"""The program against closed forms, from Python."""

import os
import pickle
import signal
import subprocess
import sys
import time

import asperity as asp
import pytest


def test_a_case_is_computed_and_printed_as_the_command_does():
    found = asp.verify("flat punch", progress=False)
    lines = str(found).splitlines()
    assert lines[0].startswith("flat punch — ")
    assert lines[1].split()[-1] == "order"
    assert lines[-1] == f"all {len(found)} checks passed"
    assert found.passed and len(found) == len(lines) - 4 and found.failures == {}
    for check, line in zip(found, lines[2:], strict=False):
        assert line.strip().startswith(check.quantity) and line.endswith(" ok") and check.expected in line
        assert len(check.sizes) == len(check.errors) and list(check.sizes) == sorted(check.sizes)
    first = found.records[0]
    assert first["case"] == "flat punch" and first["passed"] is True
    assert pickle.loads(pickle.dumps(found)) == found
    assert repr(found) == f"<Verification: {lines[-1]}>" and "<pre>flat punch" in found._repr_html_()


def test_the_order_is_that_of_the_errors():
    import numpy as np

    for check in asp.verify("Hertz: sphere", progress=False):
        if all(check.errors):
            slope = np.polyfit(np.log(check.sizes), np.log(np.abs(check.errors)), 1)[0]
            assert check.order == pytest.approx(-slope, rel=1e-9)


def test_cases_are_chosen_by_name_or_part_of_it_and_kept_in_order():
    names = asp.verification_cases()
    assert len(names) == len(set(names)) > 30
    found = asp.verify("westergaard", "periodic FFT: oblique sinusoid", progress=False)
    cases = list(dict.fromkeys(check.case for check in found))
    assert cases == [name for name in names if "Westergaard" in name or name == "periodic FFT: oblique sinusoid"]
    assert len(cases) == 5


def test_an_unknown_case_and_no_threads_are_refused():
    with pytest.raises(asp.errors.CaseError, match="no case is called 'perpetual motion'") as raised:
        asp.verify("flat punch", "perpetual motion")
    assert '"flat punch"' in (raised.value.hint or "")
    with pytest.raises(asp.errors.CaseError, match="'threads' is 0"):
        asp.verify("flat punch", threads=0)


def test_progress_is_told_and_may_stop_it():
    seen = []
    asp.verify("Westergaard", progress=seen.append)
    assert [(now.solved, now.positions) for now in seen] == [(1, 4), (2, 4), (3, 4), (4, 4)]

    def enough(now):
        raise RuntimeError("enough")

    with pytest.raises(RuntimeError, match="enough"):
        asp.verify("Westergaard", progress=enough)


@pytest.mark.skipif(os.name != "posix", reason="a signal to a process")
def test_ctrl_c_ends_it_between_two_cases():
    script = (
        "import signal\n"
        "import asperity as asp\n"
        # A shell lets what it runs in the background ignore Ctrl-C.
        "signal.signal(signal.SIGINT, signal.default_int_handler)\n"
        "try:\n"
        "    asp.verify(progress=lambda now: print(now.solved, flush=True))\n"
        "except KeyboardInterrupt:\n"
        "    print('stopped', flush=True)\n"
    )
    process = subprocess.Popen([sys.executable, "-c", script], stdout=subprocess.PIPE, text=True)
    assert process.stdout is not None
    assert process.stdout.readline() == "1\n"
    process.send_signal(signal.SIGINT)
    began = time.monotonic()
    output, _ = process.communicate(timeout=60)
    assert output.splitlines()[-1] == "stopped"
    assert len(output.splitlines()) < len(asp.verification_cases()) - 5
    assert time.monotonic() - began < 30
