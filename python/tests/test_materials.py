"""Materials by name."""

from __future__ import annotations

import math

import asperity as asp
import numpy as np
import pytest
from asperity import errors

from conftest import rough


def test_a_name_stands_for_the_constants() -> None:
    steel = asp.Material("steel")
    known = asp.materials()["steel"]
    assert (steel.young, steel.poisson, steel.hardness) == (known["young"], known["poisson"], math.inf)
    for text in ("Material('steel')", "Material('bearing-steel', hardness='inf')", "Material('bearing-steel', poisson=0.29, hardness='5 GPa')"):
        assert repr(eval(f"asp.{text}")) == text
    assert repr(asp.Material("bearing-steel", plasticity=asp.Plasticity("1.5 GPa"))).startswith("Material('bearing-steel', plasticity=")
    bearing = asp.Material("bearing-steel")
    assert bearing.hardness == asp.materials()["bearing-steel"]["hardness"]
    assert asp.Material("bearing-steel", hardness=math.inf).hardness == math.inf
    assert asp.Material("bearing-steel", plasticity=asp.Plasticity("1.5 GPa")).hardness == math.inf
    assert asp.Material("bearing-steel", 0.29, "5 GPa").poisson == 0.29


def test_lubricants_have_their_constants() -> None:
    oil = asp.oils()["ISO VG 46"]
    warm, hot = oil["viscosity"]
    assert 0.038 < warm < 0.042 and 0.005 < hot < 0.006
    assert (oil["law"], oil["compressible"]) == ("roelands", True)
    assert asp.oils()["water"]["pressure_viscosity"] == 0


def test_the_contact_is_that_of_the_constants() -> None:
    def pressure(material: asp.Material) -> np.ndarray:
        return asp.contact(rough(1), rough(2), material, material, load="20 mN", progress=False).pressure

    numbers = asp.Material(207.9e9, 0.3, 7.3e9)
    assert (pressure(asp.Material("bearing-steel")) == pressure(numbers)).all()
    assert (pressure(asp.Material("bearing-steel", hardness=math.inf)) == pressure(asp.Material(207.9e9, 0.3))).all()


def test_heat_passes_with_the_conductivity_of_the_material() -> None:
    copper = asp.Material("copper")
    given = asp.Body(rough(1), asp.Material(copper.young, copper.poisson), thermal={"conductivity": 401.0})
    found = [
        asp.contact(body, asp.Body(rough(2), copper), load="20 mN", conductance={}, progress=False).conductances["thermal_conductance"]
        for body in (asp.Body(rough(1), copper), given)
    ]
    assert found[0] == found[1]


@pytest.mark.parametrize(("arguments", "message"), [
    (("stele",), "no material 'stele'"),
    (("210 GPa",), "missing 'poisson'"),
    ((210e9,), "missing 'poisson'"),
])  # fmt: skip
def test_mistakes_are_told(arguments: tuple[object, ...], message: str) -> None:
    with pytest.raises(errors.CaseError, match=message):
        asp.Material(*arguments)  # type: ignore[arg-type]
