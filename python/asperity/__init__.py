"""Contact of two rough surfaces that press together and move, by the boundary element method.

All numbers are in SI. A quantity is a number in metres, pascals or newtons, or a text with a unit such as ``"210 GPa"``. Matrices
are indexed ``[ix, iy]``, with x along the direction of motion. Pressure is positive in compression, and stress is positive in
tension. The approach grows as the bodies move together.

Surfaces are generated (:mod:`asperity.generate`, :mod:`asperity.form`), read (:func:`read`) or made from an array
(:class:`Surface`). :func:`contact` presses two bodies together. :func:`simulate` moves them over each other, and
:class:`Simulation` does so with custom laws. :func:`run` computes a case file, and :func:`study` many variants of one.
:func:`open` opens results. :func:`stress` computes the stress below a surface,
:func:`conductance` the thermal or electrical conductance of a contact, and :func:`flow` the leakage through a gap.
:mod:`asperity.reference` has closed forms, and
:func:`verify` compares the program with them.
"""

from . import errors, form, generate, keys, reference
from ._core import __version__
from ._conductance import Conductance, conductance
from ._contact import Contact, contact, slide
from ._fatigue import Fatigue, fatigue
from ._gap_flow import GapFlow, flow
from ._joint import Band, Joint, joint
from ._plastic_state import PlasticState
from ._progress import Progress
from ._run import Run, open, run
from ._stress import Extreme, Stress, SubsurfaceStress, stress
from ._study import Study, study
from ._table import Table
from .body import Body
from .describe import (
    BearingCurve,
    Core,
    Correlation,
    Distribution,
    GreenwoodWilliamson,
    Parameter,
    Parameters,
    Profile,
    Segmentation,
    SelfAffinity,
    SpectralMoments,
    Spectrum,
    Summits,
)
from .fields import Field, Fields
from .material import Coating, Compliances, Material, Plasticity, composite_modulus, dundurs, materials, oils, tangential_modulus
from .simulation import Contacts, Pass, Simulation, simulate
from .surface import Surface, channels, read
from .verification import Check, Verification, verification_cases, verify

__all__ = [
    "Band",
    "BearingCurve",
    "Body",
    "Check",
    "Coating",
    "Compliances",
    "Conductance",
    "Contact",
    "Contacts",
    "Core",
    "Correlation",
    "Distribution",
    "Extreme",
    "Fatigue",
    "Field",
    "Fields",
    "GapFlow",
    "GreenwoodWilliamson",
    "Joint",
    "Material",
    "Parameter",
    "Parameters",
    "Pass",
    "PlasticState",
    "Plasticity",
    "Profile",
    "Progress",
    "Run",
    "Segmentation",
    "SelfAffinity",
    "Simulation",
    "SpectralMoments",
    "Spectrum",
    "Stress",
    "Study",
    "SubsurfaceStress",
    "Summits",
    "Surface",
    "Table",
    "Verification",
    "__version__",
    "channels",
    "composite_modulus",
    "conductance",
    "contact",
    "dundurs",
    "errors",
    "fatigue",
    "flow",
    "form",
    "generate",
    "joint",
    "keys",
    "materials",
    "oils",
    "open",
    "read",
    "reference",
    "run",
    "simulate",
    "slide",
    "stress",
    "study",
    "tangential_modulus",
    "verification_cases",
    "verify",
]


def __dir__() -> list[str]:
    return __all__
