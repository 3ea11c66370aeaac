"""The law of a joint in Python: the same as the command, its bands, and bad input."""

import json
import subprocess
import sys

import numpy as np
import pytest

import asperity as asp

CASE = """
title = "two faces"
[lower]
young = "210 GPa"
poisson = 0.3
conductivity = "46 W/(m K)"
topography = { generate = "self-affine", shape = [32, 32], pitch = "1 um", sq = "50 nm", hurst = 0.8, rolloff = "8 um", shortest = "4 um" }
[upper]
young = "210 GPa"
poisson = 0.3
conductivity = "46 W/(m K)"
topography = { form = "flat" }
[contact]
mean_pressures = ["10 MPa", "40 MPa", "160 MPa"]
boundary = "periodic"
[conductance]
[joint]
samples = 4
"""


@pytest.fixture(scope="module")
def case(tmp_path_factory):
    path = tmp_path_factory.mktemp("joint") / "faces.toml"
    path.write_text(CASE)
    return path


def test_a_joint_is_that_of_the_command(case, tmp_path):
    with pytest.warns(asp.errors.ModelWarning, match="roll-off"):
        law = asp.joint(case, clients=["calculix", "coefficients"], threads=2, progress=False)
    assert law.directory == case.with_name("faces-joint") and law.samples == 4
    arguments = [sys.executable, "-m", "asperity", "joint", case, "--out", tmp_path / "other", "--quiet"]
    subprocess.run(arguments, check=True, capture_output=True, timeout=300)
    mine, other = ((folder / "joint.csv").read_text() for folder in (law.directory, tmp_path / "other"))
    assert mine == other
    for name in ("joint.html", "joint-calculix-heat.inp", "figures/joint_closure.png"):
        assert (law.directory / name).stat().st_size > 500
    assert json.loads((law.directory / "joint-coefficients.json").read_text()) == law.coefficients
    assert law.sentence.startswith("At 40 MPa the joint is closed by") and "4 samples" in law.sentence
    assert law.sentence in repr(law)
    table = np.genfromtxt(law.directory / "joint.csv", encoding="utf-8", delimiter=",", names=True)
    np.testing.assert_allclose(table["mean_pressure_Pa"], law.pressure)
    pressure, closure = law.closure
    assert pressure[0] == closure[0] == 0.0 and np.all(np.diff(pressure) > 0) and np.all(np.diff(closure) > 0)
    np.testing.assert_allclose(closure[-3:], law.datum - law["mean_gap"].median)


def test_bands_are_quantiles_of_the_samples(case):
    with pytest.warns(asp.errors.ModelWarning):
        law = asp.joint(case, progress=False)
    gaps = np.array([asp.open(law.directory / "cases" / f"{n:04}").sweep["mean_gap"] for n in range(1, 5)])
    band = law["mean_gap"]
    assert band.unit == "m"
    np.testing.assert_allclose(band.median, np.median(gaps, axis=0))
    np.testing.assert_allclose([band.low, band.high], np.quantile(gaps, [0.16, 0.84], axis=0))
    # Persson's law of the stiffness, p/(0.4 σ), within a factor of two of what is computed.
    sigma = law.coefficients["rms_height"]
    ratio = law["stiffness"].median * 0.4 * sigma / law.pressure
    assert np.all((ratio > 0.5) & (ratio < 3.0)), ratio


def test_what_is_no_joint_is_refused(case, tmp_path):
    free = tmp_path / "free.toml"
    free.write_text(CASE.replace('"periodic"', '"free"'))
    with pytest.raises(asp.errors.CaseError, match="repeat along both axes") as caught:
        asp.joint(free, progress=False)
    assert caught.value.key == "joint"
    for options, words in (({"clients": "nastran"}, "clients"), ({"units": "inch"}, "units"), ({"friction": 0.0}, "friction")):
        with pytest.raises(asp.errors.BadInput, match=words):
            asp.joint(case, progress=False, **options)
    with pytest.warns(asp.errors.ModelWarning):
        law = asp.joint(case, progress=False)
    with pytest.raises(asp.errors.BadInput, match="expected one of mean_gap"):
        law["gap"]
