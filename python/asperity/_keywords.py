"""Keywords of contacts and motions, each with its type, its table in a case and its meaning.

Those with a table are made from the keys of case files, in :mod:`asperity.keys`; the table is empty for a key at the top of a case.
A keyword without a table says how a case is computed.
"""

# Annotations are not postponed here: types and texts are read when the package is imported.

import functools
import inspect
import os
from collections.abc import Callable
from types import NoneType
from typing import Annotated, Any, TypedDict, TypeVar, cast, get_args

from . import keys
from ._described import row, words
from ._progress import Told


# fmt: off
class Output(keys.Output, total=False):
    """Keywords of the results."""

    out: Annotated[str | os.PathLike[str] | None,
        "Directory for the results. Without it a contact writes nothing, and the results of a motion live as long as its "
        ":class:`Run`."]


class Execution(TypedDict, total=False):
    """Keywords of a computation."""

    resume: Annotated[bool, "Continue from interrupted results in `out`; a motion continues after its last pass."]
    overwrite: Annotated[bool, "Replace the results in `out`."]
    threads: Annotated[int | None, "Number of threads that share the work; one for each core by default."]
    progress: Annotated[Told,
        "Whether a progress bar is shown, if tqdm is installed; or a function that is called with each :class:`Progress`."]


class Samples(TypedDict, total=False):
    """Keywords of the computation of many cases."""

    retry: Annotated[bool, "Compute failed cases again."]
    threads: Annotated[int | None,
        "Number of cases at a time; one for each core by default. If fewer are left, each gets several threads."]
    progress: Annotated[Told,
        "Whether a progress bar is shown, if tqdm is installed; or a function that is called with each :class:`Progress`, "
        "whose positions are the remaining cases."]


class Tasks(Samples, total=False):
    """Keywords of the computation of a study."""

    task: Annotated[tuple[int, int] | None,
        "Compute only a part of the cases: ``(3, 40)`` is the third case and every fortieth after it."]


# fmt: on
class ContactKeywords(keys.Common, keys.Rest, Output, Execution, total=False):
    """Keywords of :func:`asperity.contact`."""


class SlideKeywords(keys.Common, keys.Sliding, Output, Execution, total=False):
    """Keywords of :func:`asperity.slide`."""


class MotionKeywords(keys.Common, keys.Motion, Output, Execution, total=False):
    """Keywords of :func:`asperity.simulate` and :class:`asperity.Simulation`."""


LOADS = ("load", "mean_pressure", "approach", "loads", "mean_pressures", "approaches")
"""Keywords that prescribe the load; each call has exactly one of them."""

_FLAGS = {"resume": False, "overwrite": False, "retry": False, "progress": True}
"""Defaults of the keywords that are not `None` by default."""

Function = TypeVar("Function", bound=Callable[..., Any])


def takes(keywords: Any, **more: Any) -> Callable[[Function], Function]:
    """Decorates a function whose ``**options`` are these `keywords`, a class such as those above; `more` are further defaults.

    The keywords are added to its signature, and replace ``**options`` in its docstring. The function is called with all of them,
    each by default with its default value.
    """
    annotations = keywords.__annotations__
    types = {key: get_args(annotation)[0] for key, annotation in annotations.items()}
    defaults = {key: {**_FLAGS, **more}.get(key) for key in types.keys() - keywords.__required_keys__}

    def decorate(function: Function) -> Function:
        name = function.__qualname__
        signature = inspect.signature(function)
        parameters = [each for each in signature.parameters.values() if each.kind is not each.VAR_KEYWORD]
        fixed = [each.name for each in parameters]
        for key, kind in types.items():
            default = defaults.get(key, inspect.Parameter.empty)
            parameters.append(inspect.Parameter(key, inspect.Parameter.KEYWORD_ONLY, default=default, annotation=kind))

        @functools.wraps(function)
        def call(*args: Any, **options: Any) -> Any:
            for key in options.keys() - types.keys() - set(fixed):
                raise TypeError(f"{name}() got an unexpected keyword argument {key!r}{_meant(key, [*fixed, *types])}")
            for key in keywords.__required_keys__ - options.keys():
                raise TypeError(f"{name}() missing a required keyword-only argument: {key!r}")
            return function(*args, **{**defaults, **options})

        described: Any = call
        described.__signature__ = signature.replace(parameters=parameters)
        described.__annotations__ = {**function.__annotations__, **types}
        del described.__annotations__["options"]
        if function.__doc__ is not None:
            described.__doc__ = with_rows(function.__doc__, keywords)
        return cast(Function, call)

    return decorate


def with_rows(text: str, keywords: Any) -> str:
    """A docstring in which rows of the `keywords` replace ``**options``."""
    rows = "\n".join(_row(key, annotation) for key, annotation in keywords.__annotations__.items())
    return inspect.cleandoc(text).replace("**options", rows)


def _meant(key: str, known: list[str]) -> str:
    """A suggestion for a misspelled keyword."""
    import difflib

    close = difflib.get_close_matches(key, known, 1)
    return f". Did you mean {close[0]!r}?" if close else ""


def _row(key: str, annotation: Any) -> str:
    """A keyword as a row of a docstring."""
    kind, *_, text = get_args(annotation)
    is_optional = NoneType in get_args(kind)
    return row(key, words(kind).removesuffix(" or None") + (", optional" if is_optional else ""), text)
