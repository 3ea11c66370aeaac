"""Tables of results, and contacts that have one."""

from __future__ import annotations

import copy
import pathlib
import pickle

import asperity as asp
import numpy as np
import pytest
from asperity import errors
from conftest import rough

Pair = tuple[asp.Body, asp.Body]


@pytest.fixture
def swept(pair: Pair) -> asp.Contact:
    return asp.contact(*pair, loads=["5 mN", "10 mN", "20 mN"], progress=False)


@pytest.fixture
def unloaded(pair: Pair) -> asp.Contact:
    return asp.contact(*pair, load="10 mN", history=[{"load": "5 mN", "increments": 3}], progress=False)


def test_a_table_is_an_array_of_numpy(swept: asp.Contact) -> None:
    sweep = swept.sweep
    assert isinstance(sweep, asp.Table) and isinstance(sweep[:2], asp.Table)
    assert type(sweep["load"]) is np.ndarray and sweep["load"] == pytest.approx([5e-3, 10e-3, 20e-3])
    assert sweep.units["contact_area"] == "m²" and sweep.units["point"] == "1"
    for again in (pickle.loads(pickle.dumps(sweep)), copy.deepcopy(sweep)):
        assert isinstance(again, asp.Table) and again.tolist() == sweep.tolist() and again.units == sweep.units


def test_a_table_becomes_a_frame_in_si_or_in_suitable_units(swept: asp.Contact) -> None:
    pytest.importorskip("pandas")
    frame = swept.sweep.to_pandas()
    assert frame.index.name == "point" and frame["approach"].to_numpy() == pytest.approx(swept.sweep["approach"])
    assert frame.attrs["units"]["contact_area"] == "m²"
    shown = swept.to_pandas(units="display")
    assert shown["load (mN)"].to_numpy() == pytest.approx([5.0, 10.0, 20.0])
    assert shown.attrs["units"]["load (mN)"] == "mN" and "contact_fraction" in shown.columns
    with pytest.raises(errors.CaseError, match="'units' is 'nm', expected \"si\" or \"display\""):
        swept.sweep.to_pandas(units="nm")  # type: ignore[arg-type]


def test_a_contact_without_a_table_is_a_row_of_its_numbers(pair: Pair) -> None:
    pandas = pytest.importorskip("pandas")
    stuck = asp.contact(*pair, load="5 mN", friction={"coefficient": 0.3, "force": "1 mN"}, progress=False)
    frame = stuck.to_pandas()
    assert len(frame) == 1 and frame["load"][0] == stuck.load and frame["tangential_force_x"][0] == stuck.tangential_force[0]
    assert frame.attrs["units"]["tangential_displacement_y"] == "m"
    assert len(pandas.concat([frame, frame])) == 2


def test_the_data_set_of_a_contact_has_its_table_and_its_units(swept: asp.Contact, unloaded: asp.Contact) -> None:
    pytest.importorskip("xarray")
    data = swept.to_xarray()
    assert data["contact_area"].dims == ("point",) and data["point"].values.tolist() == [1, 2, 3]
    assert data["contact_area"].attrs["units"] == "m²" and data["pressure"].dims == ("x", "y")
    assert data.attrs["load"] == pytest.approx(20e-3) and data.attrs["load_units"] == "N"
    assert unloaded.to_xarray()["approach"].dims == ("increment",)
    assert swept.sweep.to_xarray()["load"].values == pytest.approx(swept.sweep["load"])


def test_positions_are_rows(pair: Pair) -> None:
    pytest.importorskip("xarray")
    run = asp.simulate(*pair, load="20 mN", stride=16, progress=False)
    data = run.steps.to_xarray()
    assert data["load"].dims == ("row",) and data["step"].dims == ("row",) and "step" in data.coords
    frame = run.steps.to_pandas()
    assert frame.index.names == ["pass", "step"] and len(frame) == len(run.steps)


def test_curves_are_drawn_over_what_varies(swept: asp.Contact, unloaded: asp.Contact) -> None:
    pytest.importorskip("matplotlib").use("agg")
    ax = swept.plot("contact_fraction")
    assert ax.get_xlabel() == "load (mN)" and ax.lines[0].get_ydata() == pytest.approx(swept.sweep["contact_fraction"])
    assert swept.plot("contact_area", x="approach").get_xlabel() == "approach (nm)"
    assert swept.sweep.plot("load").get_xlabel() == "point" and swept.plot().get_xlabel() == "x (µm)"
    assert unloaded.plot("contact_area").get_xlabel() == "increment"
    with pytest.raises(errors.CaseError, match="'quantity' is 'sweep', expected a field or a column of a table: pressure, .*load"):
        swept.plot("sweep")
    with pytest.raises(errors.CaseError, match="'x' is 'time', expected a column of the table"):
        swept.plot("load", x="time")


def test_a_contact_in_a_directory_writes_its_page(pair: Pair, tmp_path: pathlib.Path) -> None:
    stored = asp.contact(*pair, load="5 mN", out=tmp_path / "out", progress=False)
    assert stored.report() == tmp_path / "out/report.html" and (tmp_path / "out/report.html").stat().st_size > 10_000
    opened = asp.open(tmp_path / "out")
    assert isinstance(opened, asp.Contact) and opened == stored
    assert opened.report(tmp_path / "page.html").read_text(encoding="utf-8").startswith("<!doctype html>")
    with pytest.raises(errors.CaseError, match=r"report\(\) needs a results directory") as caught:
        asp.contact(*pair, load="5 mN", progress=False).report()
    assert caught.value.hint is not None and "out=" in caught.value.hint


def test_a_run_draws_roughness_from_the_initial_surface_on(steel: asp.Material) -> None:
    pytest.importorskip("matplotlib").use("agg")
    run = asp.simulate(rough(1), rough(2), steel, steel, load="200 mN", passes=2, stride=8, progress=False)
    (line,) = run.plot("sq_lower").lines
    assert line.get_xdata().tolist() == [0, 1, 2]
    assert line.get_ydata() == pytest.approx(1e9 * np.array([run.lower(0).heights.std(), *run.passes["sq_lower"]]))
    assert run.plot("max_pressure").lines[0].get_xdata().tolist() == [1, 2]
