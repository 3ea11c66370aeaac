"""Contact of two rough surfaces that press together and move, by the boundary element method.

Everything is SI: a quantity is a number in metres, pascals, newtons, or text with a unit, ``"210 GPa"``. Matrices are
``[ix, iy]``, x the direction of motion. Pressure is positive in compression, an approach moves the bodies together, stress is
positive in tension.

Surfaces are made (:mod:`asperity.generate`, :mod:`asperity.form`), read (:func:`read`) or given (:class:`Surface`).
:func:`contact` presses two bodies together, :func:`simulate` lets them pass over each other, :class:`Simulation` does so with
laws of one's own, :func:`run` computes a case file, :func:`open` opens results. :mod:`asperity.reference` holds closed forms.
"""

from . import errors, form, generate
from ._core import __version__
from ._progress import Progress
from .body import Body
from ._contact import Contact, contact
from .fields import Field, Fields
from .material import Coating, Material
from ._run import Run, open, run, simulate
from .simulation import Contacts, Pass, Simulation
from .surface import Surface, channels, read

__all__ = [
    "Body",
    "Coating",
    "Contact",
    "Contacts",
    "Field",
    "Fields",
    "Material",
    "Pass",
    "Progress",
    "Run",
    "Simulation",
    "Surface",
    "__version__",
    "channels",
    "contact",
    "errors",
    "form",
    "generate",
    "open",
    "read",
    "run",
    "simulate",
]
