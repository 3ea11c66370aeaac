"""Lubricated bodies: films of oil, from full film to dry contact."""

from __future__ import annotations

import asperity as asp
import numpy as np
import pytest
from asperity import errors


def bodies() -> tuple[asp.Body, asp.Body]:
    steel = asp.Material("210 GPa", 0.3)
    plate = asp.form.flat((64, 48), pitch="9 um")
    return asp.Body(plate, steel), asp.Body(asp.form.sphere("10 mm"), steel)


OIL = {"viscosity": "40 mPa s", "pressure_viscosity": "20 1/GPa", "limiting_stress": 0.05, "boundary_friction": 0.12}


def test_a_film_grows_with_the_speed_as_hamrock_and_dowson_found() -> None:
    speeds = ["0.3 m/s", "3 m/s"]
    c = asp.contact(*bodies(), load="8 N", lubrication={**OIL, "speeds": speeds})
    film, formula = c.sweep["central_film"], c.sweep["hamrock_dowson_film"]
    assert np.all(c.sweep["solid_share"] == 0.0) and np.all(np.isnan(c.sweep["lambda"]))
    assert film == pytest.approx(formula, rel=0.2)
    exponent = np.log10(film[1] / film[0])
    assert exponent == pytest.approx(0.67, abs=0.07)
    gap, oil, solids, pressure, contact = (
        np.asarray(c.fields[name]) for name in ("gap", "oil_pressure", "solid_pressure", "pressure", "contact")
    )
    assert gap.min() == pytest.approx(c.sweep["min_film"][1])
    assert np.array_equal(oil + solids, pressure) and not contact.any()


def test_slowly_it_is_the_dry_contact() -> None:
    dry = asp.contact(*bodies(), load="8 N")
    slow = asp.contact(*bodies(), load="8 N", lubrication={**OIL, "speed": "1 um/s"})
    assert slow.sweep["solid_share"][0] > 0.999
    assert slow.sweep["traction_coefficient"][0] == pytest.approx(0.12, rel=1e-3)
    pressures = [np.asarray(c.fields["pressure"]) for c in (slow, dry)]
    assert pressures[0] == pytest.approx(pressures[1], abs=2e-3 * dry.max_pressure)


def test_an_oil_has_its_viscosity_by_the_temperature() -> None:
    def film(celsius: int) -> float:
        oil = {"oil": "ISO VG 46", "speed": "0.5 m/s", "limiting_stress": 0.05}
        c = asp.contact(*bodies(), load="8 N", temperature={"bulk": f"{celsius} °C"}, lubrication=oil)
        return float(c.sweep["central_film"][0])

    assert film(100) < 0.4 * film(40)


@pytest.mark.parametrize(
    ("lubrication", "message"),
    [
        ({**OIL, "speed": 0}, "speed"),
        ({"oil": "ISO VG46", "speed": "1 m/s"}, "did you mean `ISO VG 46`"),
        ({"oil": "ISO VG 46", "speed": "1 m/s"}, "needs the temperature"),
        ({"viscosity": "40 mPa s", "speed": "1 m/s"}, "pressure_viscosity"),
        (OIL, "speed"),
    ],
)
def test_bad_input_is_named(lubrication: dict[str, object], message: str) -> None:
    with pytest.raises(errors.BadInput, match=message):
        asp.contact(*bodies(), load="8 N", lubrication=lubrication)  # type: ignore[arg-type]
