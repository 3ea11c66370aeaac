"""From the arguments of a call to the tables of a case."""

from __future__ import annotations

from collections.abc import Mapping
from typing import Any

from . import _core
from ._keywords import LOADS
from ._raise import bad_input
from ._units import whole
from .body import Handed


def tables(handed: Handed, keywords: Any, options: Mapping[str, Any]) -> dict[str, Any]:
    """Makes the tables of a case from the `options` of a call with these `keywords`. Options that are `None` are left out."""
    _check_load(keywords, options)
    case: dict[str, Any] = dict(handed.tables)
    for key, annotation in keywords.__annotations__.items():
        *place, _ = annotation.__metadata__
        if not place:
            continue
        # The table of a motion makes the case a motion, even if it is empty.
        table = case.setdefault(place[0], {}) if place[0] else case
        if options[key] is not None:
            table[key] = options[key] if place[0] else _entry(key, options[key])
    return case


def _check_load(keywords: Any, options: Mapping[str, Any]) -> None:
    """Raises an exception if no load is given."""
    known = [key for key in LOADS if key in keywords.__annotations__]
    if all(options[key] is None for key in known):
        raise bad_input("load", f"no load is given, expected one of the arguments {', '.join(known)}", 'for example load="2 N"')


def _entry(key: str, value: Any) -> Any:
    """A table, or another entry at the top of a case."""
    if key == "title":
        return value
    if key == "history":
        return [dict(stage) for stage in value]
    if key == "friction" and not isinstance(value, Mapping):
        return {"coefficient": value}
    return dict(value)


def threads(count: int | None) -> int:
    """Number of threads for the compiled module: 0 is one for each core."""
    if count is None:
        return 0
    return whole("threads", count, 1, ", or None for one on each core", most=_core.MAX_THREADS)


def execution(options: Mapping[str, Any]) -> tuple[int, str]:
    """Number of threads, and the treatment of existing results."""
    count = threads(options["threads"])
    if options["resume"] and options["overwrite"]:
        raise bad_input("resume", "'resume' and 'overwrite' are both given, expected one of them")
    return count, "resume" if options["resume"] else "overwrite" if options["overwrite"] else "keep"
