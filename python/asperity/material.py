"""Materials of bodies."""

from __future__ import annotations

import copy
import math
from collections.abc import Sequence
from typing import Annotated, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from ._described import described
from ._raise import bad_input, warn
from ._same import Comparable
from ._units import Quantity, number, quantity, written
from .keys import Viscoelastic

_SOFT = 1e6
"""Young's modulus that is softer than any rubber, Pa."""


def _poisson(value: Any) -> float:
    return number("poisson", value, "a number from 0 to 0.5", 0.0, 0.5)


class Coating(Comparable):
    """An elastic layer on a body.

    Parameters
    ----------
    thickness : float or str
        Above 0, m.
    young : float or str
        Young's modulus, above 0, Pa; or the name of a material, see :func:`materials`.
    poisson : float, optional
        Poisson's ratio, 0 to 0.5. A named material has its own.
    viscoelastic : keys.Viscoelastic, optional
        Relaxation of the layer, for the argument `steady` of :func:`contact`; `young` is then its relaxed modulus.

    Examples
    --------
    >>> import asperity as asp
    >>> asp.Coating(thickness="2 um", young="300 GPa", poisson=0.25).thickness
    2e-06
    >>> asp.Coating("2 um", "dlc").young
    259000000000.0
    >>> asp.Coating("1 mm", "2 MPa", 0.49, viscoelastic={"moduli": ["20 MPa"], "times": ["1 ms"]})
    Coating(thickness='1 mm', young='2 MPa', poisson=0.49, viscoelastic={'moduli': ['20 MPa'], 'times': ['1 ms']})
    """

    def __init__(
        self, thickness: Quantity, young: Quantity, poisson: float | None = None, viscoelastic: Viscoelastic | None = None
    ) -> None:
        self.thickness = quantity("thickness", thickness, "length")
        self.name, (young, poisson) = _elastic(young, poisson)
        self.young = quantity("young", young, "pressure")
        self.poisson = _poisson(poisson)
        self.viscoelastic = copy.deepcopy(viscoelastic)

    def __repr__(self) -> str:
        relaxing = [] if self.viscoelastic is None else [f"viscoelastic={self.viscoelastic!r}"]
        parts = [f"thickness={written(self.thickness, 'length')}", *_elastic_parts(self), *relaxing]
        return f"Coating({', '.join(parts)})"

    def _table(self) -> dict[str, Any]:
        table: dict[str, Any] = {"thickness": self.thickness, "young": self.young, "poisson": self.poisson}
        if self.name is not None:
            table["material"] = self.name
        if self.viscoelastic is not None:
            table["viscoelastic"] = self.viscoelastic
        return table


class Plasticity(Comparable):
    """Plasticity below the surface of a body: von Mises' (J2) with hardening.

    Give either `yield_stress` or `curve`.

    Parameters
    ----------
    yield_stress : float or str, optional
        Yield stress of the virgin body in tension, above 0, Pa.
    hardening : float or str, optional
        Growth of the yield stress with the plastic strain, at least 0, Pa; 0 by default.
    curve : array_like, optional
        Points of plastic strain and yield stress, Pa, from strain 0 on, rising. It replaces `yield_stress` and `hardening`.
    kinematic : float or str, optional
        Prager's modulus of the back stress, at least 0, Pa; 0 by default.
    recovery : float, optional
        Armstrong's and Frederick's recovery of the back stress, at least 0, with `kinematic`; 0 by default.

    Examples
    --------
    >>> import asperity as asp
    >>> asp.Plasticity(yield_stress="1.5 GPa", hardening="10 GPa").yield_stress
    1500000000.0
    """

    def __init__(
        self,
        yield_stress: Quantity | None = None,
        hardening: Quantity | None = None,
        curve: ArrayLike | None = None,
        kinematic: Quantity | None = None,
        recovery: float = 0.0,
    ) -> None:
        def pressure(key: str, value: Quantity | None) -> float | None:
            return None if value is None or value == 0 else quantity(key, value, "pressure")

        self.yield_stress = pressure("yield_stress", yield_stress)
        self.hardening = pressure("hardening", hardening)
        self.curve = None if curve is None else np.array(curve, dtype=np.float64)
        self.kinematic = pressure("kinematic", kinematic)
        self.recovery = float(recovery)

    def __repr__(self) -> str:
        parts = [
            f"{key}={written(value, 'pressure') if key in ('yield_stress', 'hardening', 'kinematic') else repr(value)}"
            for key, value in self._table().items()
        ]
        return f"Plasticity({', '.join(parts)})"

    def _table(self) -> dict[str, Any]:
        table: dict[str, Any] = {"yield_stress": self.yield_stress, "hardening": self.hardening}
        if self.curve is not None:
            table["curve"] = self.curve.tolist()
        if self.kinematic is not None:
            table["kinematic"] = self.kinematic
        if self.recovery:
            table["recovery"] = self.recovery
        return {key: value for key, value in table.items() if value is not None}


class Material(Comparable):
    """Elastic constants of a body, and its hardness or plasticity.

    Parameters
    ----------
    young : float or str
        Young's modulus, above 0, Pa. A rigid body has ``inf``. Or the name of a material, see :func:`materials`: the other constants are
        then its own by default, and a case uses those of heat and current where it needs them.
    poisson : float, optional
        Poisson's ratio, 0 to 0.5. A named material has its own.
    hardness : float, str or array_like, optional
        Largest pressure of a cell, above 0, Pa: one number, or a matrix with a number for each cell of the prepared body. A body
        without hardness is elastic. A named material may have its own; ``inf`` makes it elastic.
    coating : Coating or list of Coating, optional
        Elastic layer on the body, or several from the surface down.
    plasticity : Plasticity, optional
        Plasticity below the surface, in place of a hardness. It needs the argument `plasticity` of :func:`contact` or
        :func:`simulate`.

    Raises
    ------
    asperity.errors.CaseError
        If a value is out of its range, or a text has no suitable unit.

    Warns
    -----
    asperity.errors.ModelWarning
        If the body is softer than any rubber, as 210 Pa in place of 210 GPa.

    Examples
    --------
    >>> import asperity as asp
    >>> steel = asp.Material(young="210 GPa", poisson=0.3, hardness=4e9)
    >>> steel.young
    210000000000.0
    >>> steel
    Material(young='210 GPa', poisson=0.3, hardness='4 GPa')
    >>> asp.Material("alumina").hardness
    15000000000.0
    """

    def __init__(
        self,
        young: Quantity,
        poisson: float | None = None,
        hardness: Quantity | ArrayLike | None = None,
        coating: Coating | Sequence[Coating] | None = None,
        plasticity: Plasticity | None = None,
    ) -> None:
        self.name, (young, poisson) = _elastic(young, poisson)
        # A body that flows below its surface has no hardness.
        if self.name is not None and hardness is None and plasticity is None:
            hardness = materials()[self.name]["hardness"]
        self.young = quantity("young", young, "pressure", infinite=True)
        self.poisson = _poisson(poisson)
        self.hardness: float | NDArray[np.float64] = math.inf
        if hardness is not None:
            if isinstance(hardness, str) or np.ndim(hardness) == 0:
                self.hardness = quantity("hardness", hardness, "pressure", infinite=True)
            else:
                self.hardness = np.array(hardness, dtype=np.float64)
        self.coating = coating
        self.plasticity = plasticity
        if self.young < _SOFT and coating is None:
            guess = isinstance(young, (int, float)) and young < 1e4
            advice = f'was "{young} GPa" meant?' if guess else "check its unit"
            warn([f"young = {young} is {_core.format(self.young, 'pressure')}, softer than any rubber: {advice}"])

    def __repr__(self) -> str:
        named = {} if self.name is None else materials()[self.name]
        parts = _elastic_parts(self)
        usual = None if self.plasticity is not None else named.get("hardness")
        if isinstance(self.hardness, np.ndarray):
            parts.append(f"hardness=<{' × '.join(map(str, self.hardness.shape))} values>")
        elif math.isfinite(self.hardness) and self.hardness != usual:
            parts.append(f"hardness={written(self.hardness, 'pressure')}")
        elif usual is not None and math.isinf(self.hardness):
            parts.append("hardness='inf'")
        if self.coating is not None:
            parts.append(f"coating={self.coating!r}")
        if self.plasticity is not None:
            parts.append(f"plasticity={self.plasticity!r}")
        return f"Material({', '.join(parts)})"

    def _table(self) -> dict[str, Any]:
        """The keys of a body in a case, without a map of the hardness."""
        table: dict[str, Any] = {"young": self.young, "poisson": self.poisson}
        if not isinstance(self.hardness, np.ndarray) and math.isfinite(self.hardness):
            table["hardness"] = self.hardness
        if self.name is not None:
            table["material"] = self.name
            table.setdefault("hardness", math.inf)
            if self.plasticity is not None:
                del table["hardness"]
        if isinstance(self.coating, Coating):
            table["coating"] = self.coating._table()
        elif self.coating is not None:
            table["layers"] = [layer._table() for layer in self.coating]
        if self.plasticity is not None:
            table["plasticity"] = self.plasticity._table()
        return table

    def _constants(self) -> tuple[float, float, list[list[float]]]:
        layers = [self.coating] if isinstance(self.coating, Coating) else self.coating or []
        return self.young, self.poisson, [[layer.thickness, layer.young, layer.poisson] for layer in layers]


def materials() -> dict[str, dict[str, Any]]:
    """Return the materials that are known by name, with their constants at room temperature.

    Returns
    -------
    dict
        For each name `about`, the grade; `young` and `hardness`, Pa; `poisson`; `conductivity`, W/(m K); `heat_capacity`, J/(kg K);
        `density`, kg/m³; `resistivity`, Ω m; and `source`. A constant that differs too much between grades is None.

    Examples
    --------
    >>> import asperity as asp
    >>> asp.materials()["steel"]["young"]
    210000000000.0
    """
    keys = ("about", "young", "poisson", "hardness", "conductivity", "heat_capacity", "density", "resistivity", "source")
    return {material["name"]: {key: material[key] for key in keys} for material in _core.named_materials()}


def oils() -> dict[str, dict[str, Any]]:
    """Return the lubricants that are known by name, with their constants.

    Returns
    -------
    dict
        For each name `about`, the grade; `viscosity` at 40 °C and at 100 °C, Pa s; `pressure_viscosity` at 40 °C, 1/Pa; `density` at
        15 °C, kg/m³; `law`, how the viscosity rises with pressure; `compressible`; `temperatures`, the lowest and the highest one
        for which the constants are meant, K; and `source`.

    Examples
    --------
    >>> import asperity as asp
    >>> asp.oils()["ISO VG 46"]["pressure_viscosity"]
    2.07e-08
    """
    keys = ("about", "viscosity", "pressure_viscosity", "density", "law", "compressible", "temperatures", "source")
    return {oil["name"]: {key: oil[key] for key in keys} for oil in _core.named_oils()}


def _elastic(young: Quantity, poisson: float | None) -> tuple[str | None, tuple[Quantity, float]]:
    """Return the name of a material, if `young` is one, and its constants."""
    named = _named(young)
    if named is not None:
        return str(young), (named["young"], named["poisson"] if poisson is None else poisson)
    if poisson is None:
        raise bad_input("poisson", "missing 'poisson', Poisson's ratio", 'for example asp.Material("210 GPa", 0.3), or asp.Material("steel")')
    return None, (young, poisson)


def _elastic_parts(material: Material | Coating) -> list[str]:
    """Return the arguments that give the elastic constants."""
    if material.name is None:
        return [f"young={written(material.young, 'pressure')}", f"poisson={material.poisson!r}"]
    own = material.poisson == materials()[material.name]["poisson"]
    # The name follows a keyword in a layer.
    parts = [repr(material.name) if isinstance(material, Material) else f"young={material.name!r}"]
    return parts if own else [*parts, f"poisson={material.poisson!r}"]


def _named(young: Any) -> dict[str, Any] | None:
    """Return the constants of a material, if this is its name."""
    if not isinstance(young, str) or not young[:1].isalpha() or young.strip().lower() in ("inf", "infinity", "nan"):
        return None
    known = materials()
    if young not in known:
        raise bad_input("young", f"no material '{young}'", f"there are {', '.join(known)}")
    return known[young]


@described
class Compliances(Comparable):
    """Elastic compliances of a pair of half-spaces without their coatings.

    ::

        1/E* = (1 − ν₁²)/E₁ + (1 − ν₂²)/E₂                        normal
        1/N* = ν₁(1 + ν₁)/E₁ + ν₂(1 + ν₂)/E₂                      lateral
        1/G* = (1 + ν₁)(1 − 2ν₁)/2E₁ − (1 + ν₂)(1 − 2ν₂)/2E₂      coupling

    Parameters
    ----------
    lower, upper : Material
        Materials of the bodies.

    Raises
    ------
    asperity.errors.OutOfRange
        If both bodies are rigid, and neither is coated.

    References
    ----------
    Johnson, *Contact Mechanics* (1985), ch. 3 and 5.
    """

    normal: Annotated[float, "1/E*, 1/Pa."]
    lateral: Annotated[float, "1/N*, 1/Pa."]
    coupling: Annotated[float, "1/G*, 1/Pa; negative if the lower body is the stiffer one."]

    def __init__(self, lower: Material, upper: Material) -> None:
        for key, material in (("lower", lower), ("upper", upper)):
            if not isinstance(material, Material):
                raise bad_input(key, f"'{key}' is {material!r}, expected a Material")
        found = _core.compliances(lower._constants(), upper._constants())
        self.normal, self.lateral, self.coupling, self._modulus, self._dundurs, self._tangential = map(float, found)

    def __repr__(self) -> str:
        return f"<Compliances: 1/E* {self.normal:.4g}, 1/N* {self.lateral:.4g}, 1/G* {self.coupling:.4g} 1/Pa>"

    def modulus(self) -> float:
        """Return the composite modulus E*, Pa."""
        return self._modulus

    def dundurs(self) -> float:
        """Return Dundurs' β = E*/G*, −1/2 to 1/2. It is positive if the lower body is the softer one."""
        return self._dundurs

    def tangential_modulus(self) -> float:
        """Return the composite tangential modulus Gₜ, Pa, see :func:`tangential_modulus`."""
        return self._tangential


def composite_modulus(lower: Material, upper: Material) -> float:
    """Return the composite modulus E* of a pair, 1/E* = (1 − ν₁²)/E₁ + (1 − ν₂²)/E₂, Pa.

    Examples
    --------
    >>> import asperity as asp
    >>> steel = asp.Material(young="210 GPa", poisson=0.3)
    >>> f"{asp.composite_modulus(steel, steel):.4g}"
    '1.154e+11'
    """
    return Compliances(lower, upper).modulus()


def dundurs(lower: Material, upper: Material) -> float:
    """Return Dundurs' β of a pair, −1/2 to 1/2.

    It is positive if the lower body is the softer one, and 0 for identical materials.
    """
    return Compliances(lower, upper).dundurs()


def tangential_modulus(lower: Material, upper: Material) -> float:
    """Return the composite tangential modulus, 1/Gₜ = (2 − ν₁)(1 + ν₁)/2E₁ + (2 − ν₂)(1 + ν₂)/2E₂, Pa.

    A sticking circle of radius a has the stiffness 2aGₜ. Mindlin, J. Appl. Mech. 16, 259 (1949).
    """
    return Compliances(lower, upper).tangential_modulus()
