"""From the arguments of a call to the tables of a case."""

from __future__ import annotations

import os
from collections.abc import Mapping, Sequence
from typing import Any

from . import _core
from ._units import path, whole
from .body import Handed
from .errors import bad_input

_IN_PLANE = ("force", "displacement", "sliding")


def tables(
    handed: Handed,
    *,
    title: str | None,
    contact: dict[str, Any],
    friction: Any = None,
    history: Sequence[Mapping[str, Any]] | None = None,
    motion: dict[str, Any] | None = None,
    sliding: dict[str, Any] | None = None,
    acceleration: Mapping[str, Any] | None = None,
    temperature: Mapping[str, Any] | None = None,
    plasticity: Mapping[str, Any] | None = None,
    subsurface: Mapping[str, Any] | None = None,
    output: dict[str, Any] | None = None,
) -> dict[str, Any]:
    """The tables of a case; what is `None` is left to its default."""
    case: dict[str, Any] = {"title": title, **handed.tables, "contact": given(contact)}
    if friction is not None:
        case["friction"] = _friction(friction)
    if history is not None:
        case["history"] = [dict(stage) for stage in history]
    if motion is not None:
        case["motion"] = given(motion)
    if sliding is not None:
        case["sliding"] = given(sliding)
    if acceleration is not None:
        case["acceleration"] = dict(acceleration)
    if temperature is not None:
        case["temperature"] = dict(temperature)
    if plasticity is not None:
        case["plasticity"] = dict(plasticity)
    if subsurface is not None:
        case["subsurface"] = dict(subsurface)
    if output:
        case["output"] = given(output)
    return given(case)


def given(entries: dict[str, Any]) -> dict[str, Any]:
    """The entries that are given."""
    return {key: value for key, value in entries.items() if value is not None}


def _friction(friction: Any) -> dict[str, Any]:
    return dict(friction) if isinstance(friction, Mapping) else {"coefficient": friction}


def threads(count: int | None) -> int:
    """Number of threads for the compiled module: 0 is one for each core."""
    if count is None:
        return 0
    return whole("threads", count, 1, ", or None for one on each core", most=_core.MAX_THREADS)


def existing(resume: bool, overwrite: bool) -> str:
    """What becomes of results that are there already."""
    if resume and overwrite:
        message = "'resume' and 'overwrite' are both given, expected one of them"
        raise bad_input("resume", message)
    return "resume" if resume else "overwrite" if overwrite else "keep"


def directory(out: str | os.PathLike[str]) -> str:
    """The directory for results, as a path."""
    return path("out", out)
