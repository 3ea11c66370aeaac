"""Exceptions: one for each cause that the library reports."""

from __future__ import annotations

import warnings

import numpy as np
import pytest

import asperity as asp
from asperity import _core


def test_each_error_of_the_library_has_its_exception() -> None:
    variants = dict(_core.ERRORS)
    assert len(variants) > 40 and variants["AtPass"] == ["pass", "source"]
    renamed = {"pass": ["pass_number"], "source": ["cause"], "dimension": []}
    for name, fields in variants.items():
        exception = getattr(asp.errors, {"Case": "CaseError"}.get(name, name))
        assert issubclass(exception, (asp.errors.BadInput, asp.errors.Failed, asp.errors.FileProblem)), name
        for field in fields:
            for attribute in ["errno", "reason"] if (name, field) == ("File", "source") else renamed.get(field, [field]):
                assert f"\n{attribute} : " in exception.__doc__ and attribute in exception.__annotations__, (name, attribute)


def test_each_exception_is_one_of_the_library() -> None:
    own = {"AsperityError", "BadInput", "Failed", "FileProblem", "MissingFile", "InternalError", "CaseError"}
    classes = {
        name for name, kind in vars(asp.errors).items() if isinstance(kind, type) and issubclass(kind, asp.errors.AsperityError)
    }
    assert classes - own == {name for name, _ in _core.ERRORS} - {"Case"}


def test_a_number_that_is_none_does_not_leave_the_program() -> None:
    steel = asp.Material(young="210 GPa", poisson=0.3)
    flat, ball = asp.form.flat((8, 8), pitch="1 um"), asp.form.sphere("100 um")
    depth = np.zeros((8, 8))
    depth[2, 3] = 1e308
    with pytest.raises(asp.errors.AtPass, match=r"pass 1: `lower` is not a finite number in cell \[2, 3\]") as raised:
        for p in asp.Simulation(flat, ball, steel, steel, load="1 mN", passes=2, stride=4, progress=False):
            for _ in range(2):
                p.remove(depth, 0.0, law="spoil")
    cause = raised.value.cause
    assert raised.value.pass_number == 1 and isinstance(cause, asp.errors.NotFinite)
    assert cause.field == "lower" and cause.cell == [2, 3]


def test_flow_that_does_not_settle_says_in_which_increment() -> None:
    soft = asp.Material(young="210 GPa", poisson=0.3, plasticity=asp.Plasticity(yield_stress="100 MPa"))
    ball = asp.form.sphere("1 mm")
    flows = {"depth": "40 um", "layers": 8, "increments": 1, "tolerance": 1e-14}
    with pytest.raises(asp.errors.AtIncrement, match=r"increment 1: the plastic strain did not converge") as raised:
        asp.contact(asp.form.flat((16, 16), pitch="6 um"), ball, soft, soft, load="100 N", plasticity=flows, progress=False)
    cause = raised.value.cause
    assert raised.value.increment == 1 and isinstance(cause, asp.errors.PlasticNotConverged)
    assert cause.mismatch > cause.tolerance == 1e-14 and cause.products > 0
    assert raised.value.hint is not None and "increments" in raised.value.hint


def test_limits_of_the_model_are_warned_of_at_once_and_end_the_run() -> None:
    steel = asp.Material(young="210 GPa", poisson=0.3)
    flat = asp.form.flat((16, 8), pitch="8 um")
    rough = asp.generate.low_pass((16, 8), pitch="8 um", sq="50 nm", cutoff="64 um", seed=1)
    moves = {"strategy": "shift", "speed_lower": "3 m/s", "speed_upper": "5 m/s", "stride": 4, "passes": 4}
    counted = []
    with warnings.catch_warnings(record=True) as warned, pytest.raises(asp.errors.AtPass, match="pass 3: the lower body") as raised:
        warnings.simplefilter("always")
        options = {"mean_pressure": "400 MPa", "boundary": "periodic", "progress": False}
        for p in asp.Simulation(rough, flat, steel, steel, **moves, **options):
            counted.append(sum("deep in one pass" in str(warning.message) for warning in warned))
            p.remove(50e-6 * p.number, 0.0)
    cause = raised.value.cause
    assert counted == [0, 1, 1]
    assert isinstance(cause, asp.errors.WornAway) and cause.body == "lower"
    assert cause.depth == pytest.approx(150e-6) and cause.length == pytest.approx(128e-6)
    assert raised.value.hint is not None and "coefficient" in raised.value.hint
