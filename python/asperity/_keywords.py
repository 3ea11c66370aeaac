"""Keywords of contacts and motions, each with its type, its table in a case and its meaning.

The table is empty for a key at the top of a case. A keyword without a table says how a case is computed.
"""

# Annotations are not postponed here: types and texts are read when the package is imported.

import functools
import inspect
import os
import textwrap
from collections.abc import Callable, Sequence
from types import NoneType, UnionType
from typing import Annotated, Any, Literal, TypedDict, TypeVar, Union, cast, get_args, get_origin, is_typeddict

from . import keys
from ._progress import Told
from ._units import Quantity

Boundary = Literal["free", "periodic"]
"""Boundary of the grid."""


# fmt: off
class Common(keys.Capabilities, total=False):
    """Keywords of every contact."""

    load: Annotated[Quantity | None, "contact", "Normal force, above 0, N. Give one of `load`, `mean_pressure` and `approach`."]
    mean_pressure: Annotated[Quantity | None, "contact", "Normal force over the area of all cells, above 0, Pa."]
    approach: Annotated[Quantity | None, "contact", "Approach of the bodies, from the heights without a shift, m."]
    boundary: Annotated[Boundary | Sequence[Boundary] | None, "contact",
        'Boundary of the grid: ``"free"`` (by default) or ``"periodic"``, for both axes or for each axis.']
    grid: Annotated[Literal["as-prepared", "common"] | None, "contact",
        '``"common"`` resamples both surfaces to the coarser pitch and crops them to a common size; ``"as-prepared"`` by default.']
    method: Annotated[Literal["auto", "active-set", "polonsky-keer", "direct"] | None, "contact",
        'Solver: ``"auto"`` (by default), ``"active-set"``, ``"polonsky-keer"`` or ``"direct"``. All give the same result.']
    device: Annotated[Literal["cpu", "cuda", "host"] | None, "contact",
        'What solves the contact: ``"cpu"`` (by default), ``"cuda"``, a GPU of NVIDIA, or ``"host"``, its solver in plain loops.']
    tolerance: Annotated[float | None, "contact", "Residual at which the solver stops, above 0, below 1; 1e-6 by default."]
    friction: Annotated[float | keys.Friction | None, "",
        "The coefficient, or a table with `coefficient`, `coupling`, `shear_strength` and `junction_growth`. In a motion and in "
        "wear in place the upper body slides. A static contact also takes `force`, `displacement` or `sliding`, and `increments`; "
        "steady rolling takes `creepage`, `creepages` or `rolling_force`, and `spin`."]
    adhesion: Annotated[keys.Adhesion | None, "",
        "Attraction between the bodies: `work`, `range`, `potential` and `history`. Loads of a `history` of stages may then pull."]


class Rest(TypedDict, total=False):
    """Keywords of a static contact."""

    loads: Annotated[Sequence[Quantity] | None, "contact", "Loads of a sweep in place of `load`, each on virgin bodies, N."]
    mean_pressures: Annotated[Sequence[Quantity] | None, "contact",
        "Mean pressures of a sweep in place of `mean_pressure`, each on virgin bodies, Pa."]
    approaches: Annotated[Sequence[Quantity] | None, "contact",
        "Approaches of a sweep in place of `approach`, each on virgin bodies, m."]
    history: Annotated[Sequence[keys.Stage] | None, "",
        "Stages of the loading after the first. Quantities that a stage does not name do not change."]
    acceleration: Annotated[keys.Acceleration | None, "",
        "Computed cycles of a `history` stand for several: `tolerance`, `max_jump`, `max_wear`. Without it all cycles are computed."]
    temperature: Annotated[keys.Temperature | None, "",
        '`bulk`, K or text such as ``"100 °C"``: the temperature of the bodies, for films that grow in cycles.']
    plasticity: Annotated[keys.Plasticity | None, "",
        "The plastic volume, for bodies with a :class:`Plasticity`: `depth`, `layers`, `growth`, `increments`, "
        "`tolerance`, `unload`."]
    subsurface: Annotated[keys.Subsurface | None, "",
        "The stress below the surface, written to `out`: `to`, `layers`, `planes` and others."
        " Without `out`, :func:`asperity.stress` computes stresses."]
    pressure_every: Annotated[int | None, "output",
        "In a sweep, the fields of every n-th point are stored; 0 stores none, 8 by default."]


class Distance(TypedDict):
    """The keyword that wear in place requires."""

    distance: Annotated[Quantity, "sliding", "Sliding distance, above 0, m."]


class Sliding(TypedDict, total=False):
    """Keywords of wear in place."""

    speed: Annotated[Quantity | None, "sliding",
        "Speed of the upper body, above 0, m/s; required for growing films and temperature."]
    updates: Annotated[int | None, "sliding",
        "Number of implicit updates, each a contact with the wear during it; 40 by default."]
    temperature: Annotated[keys.Temperature | None, "",
        '`bulk`, K or text such as ``"100 °C"``, and `every`: 1 if friction heats the bodies, 0 if not.']


class Motion(TypedDict, total=False):
    """Keywords of a motion."""

    passes: Annotated[int | None, "motion", "Number of passes; 1 by default."]
    stride: Annotated[int | None, "motion", "Cells from one position to the next; 1 by default."]
    strategy: Annotated[Literal["overlap", "shift"] | None, "motion",
        '``"overlap"`` (by default) solves only the overlap; ``"shift"`` shifts both surfaces cyclically.']
    speed_lower: Annotated[Quantity | None, "motion",
        "Speed of the lower surface in a shift, m/s; 0 by default. Only the ratio of both speeds matters. The slower surface "
        "moves by parts of a cell."]
    speed_upper: Annotated[Quantity | None, "motion", "Speed of the upper surface in a shift, m/s; 1 by default."]
    control: Annotated[Literal["pass-load", "step-load", "approach"] | None, "motion",
        'Prescribed quantity: ``"pass-load"`` the mean load of a pass (by default), ``"step-load"`` the load at every position, '
        '``"approach"`` the approach.']
    plastic_update: Annotated[Literal["pass", "step"] | None, "motion",
        'When plastic deformation changes the surfaces: after the ``"pass"``, or at every ``"step"``.']
    load_tolerance: Annotated[float | None, "motion",
        "Relative tolerance of the mean load of a pass, above 0, below 1; 1e-4 by default."]
    speed: Annotated[Quantity | None, "motion",
        "Speed of the upper body in an overlap, above 0, m/s; required for wear, films and temperature."]
    path: Annotated[Literal["one-way", "reciprocating"] | None, "motion",
        'A pass goes ``"one-way"`` (by default), or forth and back: ``"reciprocating"``.']
    offset_y: Annotated[int | Literal["random"] | None, "motion",
        'Shift of the upper body along y from pass to pass, in cells; 0 by default. ``"random"`` '
        "is a random position, from the `seed` and the number of the pass."]
    seed: Annotated[int | None, "motion", 'Seed of ``offset_y="random"``; 0 by default.']
    counter: Annotated[Literal["same", "fresh"] | None, "motion",
        'The upper body of the passes after the first: the ``"same"`` (by default), or a ``"fresh"`` one, made by its '
        "generator from another seed. A fresh one requires an upper surface of a generator without heights yet, such as "
        "``asp.generate.low_pass(...)``."]
    acceleration: Annotated[keys.Acceleration | None, "",
        "Extrapolation over several passes: `tolerance`, `max_jump`, `max_wear`. Without it all passes are computed."]
    temperature: Annotated[keys.Temperature | None, "",
        '`bulk`, K or text such as ``"100 °C"``, and `every`: the flash temperature is computed in every n-th pass, 0 for '
        "none."]
    plasticity: Annotated[keys.Plasticity | None, "",
        "The plastic volume, for bodies with a :class:`Plasticity`: `depth`, `layers`, `growth`, "
        "`tolerance`, `keep`."]
    subsurface: Annotated[keys.Subsurface | None, "",
        "The stress below the surface: `to`, `layers` and others."]
    pressure_every: Annotated[int | None, "output", "The pressures of every n-th position are stored; 0 stores none, 8 by default."]
    rim: Annotated[float | None, "output",
        "Part of a body's length at free ends that the columns of its interior leave out; 0.1 by default."]


class Output(TypedDict, total=False):
    """Keywords of the results."""

    paraview: Annotated[bool | None, "output", "Whether fields are also written for ParaView."]
    title: Annotated[str | None, "", "Title of the results."]
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


class Tasks(TypedDict, total=False):
    """Keywords of the computation of a study."""

    task: Annotated[tuple[int, int] | None,
        "Compute only a part of the cases: ``(3, 40)`` is the third case and every fortieth after it."]
    retry: Annotated[bool, "Compute failed cases again."]
    threads: Annotated[int | None,
        "Number of cases at a time; one for each core by default. If fewer are left, each gets several threads."]
    progress: Annotated[Told,
        "Whether a progress bar is shown, if tqdm is installed; or a function that is called with each :class:`Progress`, "
        "whose positions are the remaining cases."]


# fmt: on
class ContactKeywords(Common, Rest, Output, Execution, total=False):
    """Keywords of :func:`asperity.contact`."""


class SlideKeywords(Distance, Common, Sliding, Output, Execution, total=False):
    """Keywords of :func:`asperity.slide`."""


class MotionKeywords(Common, Motion, Output, Execution, total=False):
    """Keywords of :func:`asperity.simulate` and :class:`asperity.Simulation`."""


LOADS = ("load", "mean_pressure", "approach", "loads", "mean_pressures", "approaches")
"""Keywords that prescribe the load; each call has exactly one of them."""

_FLAGS = {"resume": False, "overwrite": False, "retry": False, "progress": True}
"""Defaults of the keywords that are not `None` by default."""

Function = TypeVar("Function", bound=Callable[..., Any])


def takes(keywords: Any) -> Callable[[Function], Function]:
    """Decorates a function whose ``**options`` are these `keywords`, one of the classes above.

    The keywords are added to its signature, and replace ``**options`` in its docstring. The function is called with all of them,
    each by default with its default value.
    """
    annotations = keywords.__annotations__
    types = {key: get_args(annotation)[0] for key, annotation in annotations.items()}
    defaults = {key: _FLAGS.get(key) for key in types.keys() - keywords.__required_keys__}

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
            rows = "\n".join(_row(key, annotation) for key, annotation in annotations.items())
            described.__doc__ = inspect.cleandoc(function.__doc__).replace("**options", rows)
        return cast(Function, call)

    return decorate


def _meant(key: str, known: list[str]) -> str:
    """A suggestion for a misspelled keyword."""
    import difflib

    close = difflib.get_close_matches(key, known, 1)
    return f". Did you mean {close[0]!r}?" if close else ""


def _row(key: str, annotation: Any) -> str:
    """A keyword as a row of a docstring."""
    kind, *_, text = get_args(annotation)
    optional = ", optional" if NoneType in get_args(kind) else ""
    return f"{key} : {_words(kind)}{optional}\n" + textwrap.indent(textwrap.fill(text, 116), "    ")


def _words(kind: Any) -> str:
    """The name of a type in docstrings: ``float or str``."""
    if get_origin(kind) in (Union, UnionType):
        return " or ".join(_words(member) for member in get_args(kind) if member is not NoneType)
    if get_origin(kind) is Literal:
        return "{" + ", ".join(f'"{word}"' for word in get_args(kind)) + "}"
    if is_typeddict(kind):
        return f"keys.{kind.__name__}"
    name: str = (get_origin(kind) or kind).__name__.lower()
    return "path" if name == "pathlike" else name
