"""The keywords of contacts and motions: in signatures, docstrings and messages."""

from __future__ import annotations

import inspect
import re
import typing
from collections.abc import Callable
from typing import Any

import asperity as asp
import pytest
from asperity import _conductance, _gap_flow, _keywords

TAKING = {
    asp.contact: _keywords.ContactKeywords,
    asp.slide: _keywords.SlideKeywords,
    asp.simulate: _keywords.MotionKeywords,
    asp.run: _keywords.Execution,
    asp.study: _keywords.Tasks,
    asp.Study.run: _keywords.Tasks,
    asp.conductance: _conductance.ConductanceKeywords,
    asp.Contact.conductance: _conductance.ConductanceKeywords,
    asp.flow: _gap_flow.FlowKeywords,
    asp.Contact.flow: _gap_flow.FlowKeywords,
}


@pytest.mark.parametrize(("function", "keywords"), TAKING.items())
def test_help_tells_each_keyword_with_its_type_and_meaning(function: Callable[..., Any], keywords: Any) -> None:
    parameters = inspect.signature(function).parameters
    hints = typing.get_type_hints(function)
    told = inspect.getdoc(function) or ""
    for key in keywords.__annotations__:
        assert parameters[key].kind is inspect.Parameter.KEYWORD_ONLY and parameters[key].annotation == hints[key]
        assert re.search(rf"^{key} : .+\n    \S", told, re.MULTILINE), f"nothing is told of {key}"
    assert not any(each.kind is each.VAR_KEYWORD for each in parameters.values()) and "**" not in told


@pytest.mark.parametrize("kind", [asp.Contact, asp.Parameter, asp.GapFlow, asp.reference.HertzSphere, asp.errors.PullOff])
def test_help_tells_each_attribute_and_parameter_of_a_class(kind: type) -> None:
    told = inspect.getdoc(kind) or ""
    names = [*inspect.signature(kind).parameters] if kind is asp.reference.HertzSphere else [*kind.__annotations__]
    for name in names:
        assert re.search(rf"^{name} : .+\n    \S", told, re.MULTILINE), f"nothing is told of {name}"
    assert "Annotated" not in told
    if kind in (asp.Parameter, asp.reference.HertzSphere):
        assert "Annotated" not in str(inspect.signature(kind))


def test_a_simulation_takes_what_simulate_takes_but_its_law() -> None:
    assert inspect.signature(asp.Simulation).parameters.keys() == inspect.signature(asp.simulate).parameters.keys() - {"law"}


def test_a_keyword_that_there_is_not_is_refused_by_name() -> None:
    ball, plane = asp.form.sphere("1 mm"), asp.form.flat((8, 8), "1 um")
    with pytest.raises(TypeError, match=r"contact\(\) got an unexpected keyword argument 'lod'. Did you mean 'load'\?"):
        asp.contact(plane, ball, lod="1 N")  # type: ignore[call-arg]
    with pytest.raises(TypeError, match=r"simulate\(\) got an unexpected keyword argument 'distance'"):
        asp.simulate(plane, ball, distance="1 m")  # type: ignore[call-arg]
    with pytest.raises(TypeError, match=r"slide\(\) missing a required keyword-only argument: 'distance'"):
        asp.slide(plane, ball, load="1 N")  # type: ignore[call-arg]
