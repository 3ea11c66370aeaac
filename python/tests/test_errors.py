"""Exceptions: one for each cause that the library tells."""

from __future__ import annotations

import pathlib
import re

import numpy as np
import pytest

import asperity as asp

SOURCE = pathlib.Path(__file__).parents[2] / "crates/asperity/src/error.rs"


@pytest.mark.skipif(not SOURCE.exists(), reason="the library's source is not there")
def test_each_error_of_the_library_has_its_exception() -> None:
    text = SOURCE.read_text(encoding="utf-8")
    enum = text.split("pub enum Error {", 1)[1].split("\n}\n", 1)[0]
    variants = re.findall(r"^    ([A-Z]\w+)(?: \{|\(|,)", enum, re.MULTILINE)
    assert len(variants) > 30 and {"AtIncrement", "FlowNotConverged"} <= set(variants)
    for name in variants:
        exception = getattr(asp.errors, {"Case": "CaseError"}.get(name, name), None)
        assert exception is not None and issubclass(exception, asp.errors.AsperityError), name


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
    with pytest.raises(asp.errors.AtIncrement, match=r"increment 1: plastic flow does not settle") as raised:
        asp.contact(asp.form.flat((16, 16), pitch="6 um"), ball, soft, soft, load="100 N", plasticity=flows, progress=False)
    cause = raised.value.cause
    assert raised.value.increment == 1 and isinstance(cause, asp.errors.FlowNotConverged)
    assert cause.mismatch > cause.tolerance == 1e-14 and cause.products > 0
    assert raised.value.hint is not None and "increments" in raised.value.hint
