"""Studies: many cases made of one."""

from __future__ import annotations

import copy
import csv
import os
import pathlib
import pickle
import signal
import subprocess
import sys
import textwrap
import time

import asperity as asp
import numpy as np
import pytest
from asperity import errors

CASE = """
[lower]
young = "210 GPa"
poisson = 0.3
hardness = "4 GPa"
topography = { generate = "low-pass", shape = [16, 16], pitch = "1 um", sq = "20 nm", cutoff = "6 um", seed = 1 }
[upper]
young = "210 GPa"
poisson = 0.3
topography = { form = "sphere", radius = "100 um" }
[contact]
load = "2 mN"
"""

STUDY = """
base = "case.toml"
[axes]
contact.load = ["1 mN", 0.002]
"lower.topography.seed" = { seeds = 3, first = 7 }
[[exclude]]
"contact.load" = "2 mN"
"lower.topography.seed" = 8
"""

MOTION = '[motion]\nstride = 4\n[output]\npressure_every = 0\n'


@pytest.fixture
def folder(tmp_path: pathlib.Path, monkeypatch: pytest.MonkeyPatch) -> pathlib.Path:
    monkeypatch.chdir(tmp_path)
    write(STUDY)
    return tmp_path


def write(study: str, more: str = "") -> None:
    case = CASE.replace('"100 um"', '"100 um", shape = [12, 16]') if more else CASE
    pathlib.Path("case.toml").write_text(case + more)
    pathlib.Path("load.toml").write_text(study)


def command(arguments: str) -> subprocess.CompletedProcess[str]:
    return subprocess.run([sys.executable, "-m", "asperity", *arguments.split()], capture_output=True, text=True)


def test_a_study_is_known_before_anything_is_computed(folder: pathlib.Path) -> None:
    study = asp.Study("load.toml")
    assert (study.title, study.directory, len(study)) == ("load", pathlib.Path("load"), 5)
    assert {key: values.tolist() for key, values in study.axes.items()} == {
        "contact.load": [0.001, 0.002], "lower.topography.seed": [7, 8, 9],
    }  # fmt: skip
    assert study.units == {"contact.load": "N", "lower.topography.seed": ""}
    assert study.plan.tolist() == [(1, 0.001, 7), (2, 0.001, 8), (3, 0.001, 9), (4, 0.002, 7), (5, 0.002, 9)]
    assert study.plan.dtype.names == ("case", "contact.load", "lower.topography.seed")
    assert study.left.tolist() == [1, 2, 3, 4, 5] and set(study.states) == {"open"} and study.failures == {}
    assert len(study.table) == 0 and {"contact.load", "state", "message"} <= set(study.table.dtype.names)
    with pytest.raises(errors.NoResults):
        study.open(1)
    with pytest.raises(errors.NotThisStudy, match="holds no study"):
        study.collect()
    assert not study.directory.exists()


def test_a_study_is_that_of_the_command_bit_for_bit(folder: pathlib.Path) -> None:
    study = asp.study("load.toml", threads=2, progress=False)
    assert command("study load.toml --out other").returncode == 0
    for name in ("plan.csv", "table.csv"):
        assert (study.directory / name).read_bytes() == pathlib.Path("other", name).read_bytes(), name
    assert (study.directory / "study.html").exists()
    with open("load/table.csv", newline="", encoding="utf-8-sig") as file:
        rows = list(csv.DictReader(file))
    assert len(study.table) == len(rows) == 5 and len(study.left) == 0
    units = study.table_units
    for name in study.table.dtype.names:
        column = [row[name if units[name] in ("", "1") else f"{name} ({units[name]})"] for row in rows]
        values = study.table[name]
        expected = column if values.dtype.kind == "U" else [float(cell or "nan") for cell in column]
        assert values.tolist() == expected or np.array_equal(values, np.array(expected), equal_nan=True), name
    # Each case is what it is alone.
    for case, load, seed in study.plan.tolist():
        contact = study.open(case)
        row = study.table[case - 1]
        assert isinstance(contact, asp.Contact) and row["case"] == case
        assert (row["contact_area"], row["approach"]) == (contact.contact_area, contact.approach)
        assert contact.load == pytest.approx(load, rel=1e-9) and contact.case["lower"]["topography"]["seed"] == seed
    with pytest.raises(errors.CaseError, match="'case' is 6, expected a case from 1 to 5"):
        study.open(6)


def test_a_share_of_a_study_and_the_last_makes_the_tables(folder: pathlib.Path) -> None:
    study = asp.Study("load.toml")
    told: list[asp.Progress] = []
    study.run(task=(2, 2), threads=1, progress=told.append)
    assert study.left.tolist() == [1, 3, 5] and study.states.tolist() == ["open", "done", "open", "done", "open"]
    assert not (study.directory / "table.csv").exists()
    assert (told[-1].solved, told[-1].positions, told[-1].fraction) == (2, 2, 1.0)
    assert study.table["case"].tolist() == [2, 4]
    assert study.collect().tolist() == study.table.tolist() and (study.directory / "study.html").exists()
    study.run(task=(1, 2), progress=False)
    assert len(study.left) == 0 and len((study.directory / "table.csv").read_text().splitlines()) == 6
    study.run(progress=told.append)
    assert len(study.table) == 5


@pytest.mark.parametrize("task", [(5, 4), (0, 4), 4, "3/4", (1.0, 2), (1, 2, 3)])
def test_a_share_that_there_is_not(folder: pathlib.Path, task: object) -> None:
    with pytest.raises(errors.CaseError, match="'task' is .*, expected the number of a task, from 1") as raised:
        asp.study("load.toml", task=task)  # type: ignore[arg-type]
    assert raised.value.key == "task" and not pathlib.Path("load").exists()


def test_cases_that_fail_are_rows_with_their_message(folder: pathlib.Path) -> None:
    write('base = "case.toml"\n[axes]\n"contact.load" = ["1 mN", "2 N", "2 mN"]\n')
    with pytest.warns(errors.FailedCases, match="1 of 3 cases have failed, the first is case 2: load 2 N exceeds") as warned:
        study = asp.study("load.toml", progress=False)
    assert warned[0].filename == __file__
    assert study.states.tolist() == study.table["state"].tolist() == ["done", "failed", "done"] and len(study.left) == 0
    assert list(study.failures) == [2] and study.failures[2] == study.table["message"][1]
    assert np.isnan(study.table["contact_area"]).tolist() == [False, True, False]
    with pytest.raises(errors.NoResults, match="case 2 failed: load 2 N exceeds the plastic limit"):
        study.open(2)
    assert "1 have failed" in repr(study) and "exceeds" in study._repr_html_()
    failed = study.directory / "cases/0002/failed.json"
    before = failed.stat().st_mtime_ns
    with pytest.warns(errors.FailedCases):
        study.run(progress=False)
    assert failed.stat().st_mtime_ns == before
    with pytest.warns(errors.FailedCases):
        study.run(retry=True, progress=False)
    assert failed.stat().st_mtime_ns > before


@pytest.mark.skipif(os.name == "nt", reason="signals of POSIX")
@pytest.mark.parametrize("kind", [signal.SIGINT, signal.SIGKILL])
def test_a_study_that_is_stopped_goes_on(folder: pathlib.Path, kind: signal.Signals) -> None:
    write('base = "case.toml"\n[axes]\n"motion.passes" = [1, 2, 40, 3, 4]\n', MOTION)
    program = textwrap.dedent(
        """
        import signal
        import asperity as asp
        signal.signal(signal.SIGINT, signal.default_int_handler)
        study = asp.Study("load.toml")
        try:
            study.run(threads=1, progress=False)
            print("done")
        except KeyboardInterrupt:
            print("interrupted", study.left.tolist(), study.states.tolist())
        """
    )
    process = subprocess.Popen([sys.executable, "-c", program], stdout=subprocess.PIPE, text=True)
    study = asp.Study("load.toml")
    passes = study.directory / "cases/0003/passes.csv"
    began = time.monotonic()
    while not passes.exists() or len(passes.read_text().splitlines()) < 3:
        assert process.poll() is None and time.monotonic() - began < 60
        time.sleep(0.005)
    assert study.states.tolist() == ["done", "done", "running", "open", "open"]
    process.send_signal(kind)
    printed, _ = process.communicate(timeout=60)
    assert printed == ("interrupted [3, 4, 5] ['done', 'done', 'open', 'open', 'open']\n" if kind == signal.SIGINT else "")
    assert study.left.tolist() == [3, 4, 5] and study.states[2] == "open"
    summary = study.directory / "cases/0001/summary.json"
    before = summary.stat().st_mtime_ns
    study.run(progress=False)
    assert summary.stat().st_mtime_ns == before
    run = study.open(3)
    assert isinstance(run, asp.Run) and run.is_done
    whole = asp.study("load.toml", out="whole", progress=False)
    assert study == whole
    assert (study.directory / "table.csv").read_bytes() == (whole.directory / "table.csv").read_bytes()


def test_an_exception_of_progress_stops_a_study(folder: pathlib.Path) -> None:
    write(STUDY.replace("seeds = 3", "seeds = 2000"))
    study = asp.Study("load.toml")

    def progress(_: asp.Progress) -> None:
        raise LookupError("enough")

    with pytest.raises(LookupError, match="enough"):
        study.run(threads=1, progress=progress)
    done = int((study.states == "done").sum())
    assert 0 < done < len(study) and "running" not in study.states


def test_mistakes_are_told_with_their_place(folder: pathlib.Path) -> None:
    write('base = "case.toml"\n[axes]\n"contact.lod" = [1, 2]\n')
    with pytest.raises(errors.CaseError, match="unknown key 'lod'") as raised:
        asp.Study("load.toml")
    assert (raised.value.key, raised.value.path, raised.value.line) == ("contact.lod", "load.toml", 3)  # type: ignore[attr-defined]
    assert raised.value.hint is not None and "load" in raised.value.hint
    with pytest.raises(errors.MissingFile):
        asp.Study("nowhere.toml")
    write(STUDY)
    study = asp.study("load.toml", progress=False)
    write(STUDY.replace('"1 mN", 0.002', '"3 mN", 0.002'))
    with pytest.raises(errors.NotThisStudy, match="cases of its plan have other values") as other:
        asp.study("load.toml", progress=False)
    assert other.value.hint == "out= names another directory"
    assert len(asp.study("load.toml", out="other", progress=False).table) == len(study)


def test_a_study_grows_and_has_words_for_values(folder: pathlib.Path) -> None:
    study = 'base = "case.toml"\n[axes]\n"contact.boundary" = ["free"{}]\n"contact.tolerance" = [1e-6, 1e-8]\n'
    write(study.format(""))
    assert len(asp.study("load.toml", progress=False).table) == 2
    write(study.format(', "periodic"'))
    grown = asp.Study("load.toml")
    assert grown.left.tolist() == [3, 4] and grown.units["contact.boundary"] == ""
    grown.run(progress=False)
    assert grown.table["contact.boundary"].tolist() == ["free", "free", "periodic", "periodic"]
    frame = grown.to_pandas()
    assert frame.index.name == "case" and frame["contact.boundary"].tolist() == grown.table["contact.boundary"].tolist()
    assert frame.attrs["units"]["contact_area"] == "m²" and frame.attrs["units"]["contact.tolerance"] == "1"


def test_studies_pickle_copy_and_show(folder: pathlib.Path) -> None:
    study = asp.study("load.toml", progress=False)
    for again in (pickle.loads(pickle.dumps(study)), copy.copy(study)):
        assert again == study and again.table.dtype == study.table.dtype
    assert repr(study) == "<Study load: 5 of 5 cases are done, in load>"
    assert "2 values, 1 mN to 2 mN" in study._repr_html_() and "3 values, 7 to 9" in study._repr_html_()
    assert asp.Study("load.toml", "elsewhere") != study


def test_a_study_becomes_a_data_set_over_its_axes(folder: pathlib.Path) -> None:
    pytest.importorskip("xarray")
    write(STUDY.split("[[exclude]]")[0])
    study = asp.Study("load.toml")
    study.run(task=(1, 2), progress=False)
    data = study.to_xarray()
    assert dict(data.sizes) == {"contact.load": 2, "lower.topography.seed": 3} and data["contact.load"].attrs["units"] == "N"
    assert data["contact_area"].attrs["units"] == "m²"
    for case, load, seed in study.plan.tolist():
        point = data.sel({"contact.load": load, "lower.topography.seed": seed})
        row = study.table[study.table["case"] == case]
        assert int(point["case"]) == case and str(point["state"].values) == study.states[case - 1]
        assert float(point["contact_area"]) == row["contact_area"][0] if len(row) else np.isnan(point["contact_area"])
    # The plan of the other study is no full grid.
    write(STUDY)
    data = asp.study("load.toml", out="other", progress=False).to_xarray()
    assert dict(data.sizes) == {"case": 5} and data["lower.topography.seed"].dims == ("case",)


SWEEP = """
base = "case.toml"
[axes]
"lower.topography.seed" = { seeds = 3 }
"contact.tolerance" = [1e-6, 1e-8]
"""


def test_the_points_of_a_sweep_are_rows_and_a_dimension(folder: pathlib.Path) -> None:
    pytest.importorskip("xarray")
    pytest.importorskip("matplotlib").use("agg")
    write(SWEEP)
    case = pathlib.Path("case.toml")
    case.write_text(case.read_text().replace('load = "2 mN"', 'loads = ["1 mN", "2 mN", "4 mN"]'))
    study = asp.Study("load.toml")
    study.run(task=(1, 2), progress=False)
    table = study.table
    assert table["case"].tolist() == [case for case in (1, 3, 5) for _ in range(3)]
    assert table["contact.load"].tolist() == [1e-3, 2e-3, 4e-3] * 3 and table["point"].tolist() == [1, 2, 3] * 3
    assert study.table_units["contact.load"] == "N" and "contact.load" not in study.axes
    data = study.to_xarray()
    assert dict(data.sizes) == {"lower.topography.seed": 3, "contact.tolerance": 2, "contact.load": 3}
    assert data["contact.load"].attrs["units"] == "N" and data["case"].dims == ("lower.topography.seed", "contact.tolerance")
    for row in table:
        at = {"lower.topography.seed": row["lower.topography.seed"], "contact.tolerance": row["contact.tolerance"]}
        assert float(data["contact_area"].sel({**at, "contact.load": row["contact.load"]})) == row["contact_area"]
    assert int(data["contact_area"].isnull().sum()) == 9
    line, points = study.plot("contact_area", x="contact.load").lines
    assert line.get_xdata() == pytest.approx([1.0, 2.0, 4.0]) and len(points.get_xdata()) == 9
    frame = study.to_pandas()
    assert list(frame.index.names) == ["case", "point"] and frame.loc[(3, 2), "contact.load"] == 2e-3


def test_a_motion_has_the_sums_of_its_passes(folder: pathlib.Path) -> None:
    write('base = "case.toml"\n[axes]\n"motion.passes" = [1, 3]\n', MOTION)
    study = asp.study("load.toml", progress=False)
    passes = [study.open(case).passes for case in (1, 2)]
    for name in ("plastic_volume_lower", "convolutions"):
        assert study.table[name] == pytest.approx([of[name].sum() for of in passes])
    for name in ("sq_lower", "max_pressure", "pass"):
        assert study.table[name].tolist() == [of[name][-1] for of in passes]
    results = pytest.importorskip("pandas").read_csv("load/cases/0002/results.csv")
    assert results["plastic_volume_lower (m³)"].tolist() == pytest.approx(passes[1]["plastic_volume_lower"].tolist(), rel=1e-15)
    assert results.columns[0] == "pass"


def test_a_study_draws_its_cases_and_their_means(folder: pathlib.Path) -> None:
    pytest.importorskip("matplotlib").use("agg")
    study = asp.study("load.toml", progress=False)
    table = study.table
    ax = study.plot("contact_area", x="contact.load")
    line, points = ax.lines
    assert ax.get_xlabel() == "load (mN)" and ax.get_ylabel() == "contact area (µm²)"
    assert points.get_ydata() == pytest.approx(1e12 * table["contact_area"])
    means = [1e12 * table["contact_area"][table["contact.load"] == load].mean() for load in (1e-3, 2e-3)]
    assert line.get_xdata() == pytest.approx([1.0, 2.0]) and line.get_ydata() == pytest.approx(means)
    legend = study.plot("max_pressure", x="contact_area", color="contact.load").get_legend()
    assert legend is not None and legend.get_title().get_text() == "load (mN)"
    assert [text.get_text() for text in legend.get_texts()] == ["1", "2"]
    for arguments, told in (({"quantity": "area"}, "'quantity' is 'area'"), ({"quantity": "state"}, "a column of numbers"),
                            ({"quantity": "load", "color": "load"}, "an axis of the study")):  # fmt: skip
        with pytest.raises(errors.CaseError, match=told):
            study.plot(**arguments)


def test_a_printed_study_has_suitable_units(folder: pathlib.Path) -> None:
    pytest.importorskip("pandas")
    study = asp.study("load.toml", progress=False)
    shown = study.to_pandas(units="display")
    assert shown["contact.load (mN)"].tolist() == pytest.approx([1.0, 1.0, 1.0, 2.0, 2.0])
    assert shown["contact_area (µm²)"].to_numpy() == pytest.approx(1e12 * study.table["contact_area"])
    assert shown.attrs["units"]["contact_area (µm²)"] == "µm²" and "state" in shown.columns
    with pytest.raises(errors.CaseError, match="'units' is 'um'"):
        study.to_pandas(units="um")  # type: ignore[arg-type]
