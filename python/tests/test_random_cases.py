"""Random cases over all tables of a case file hold the laws that every result obeys.

`CASES=5000 SEED=0 pytest python/tests/test_random_cases.py` tries this many from that seed. `ASPERITY` names another command than
that of the package.
"""

from __future__ import annotations

import csv
import json
import math
import os
import pathlib
import re
import signal
import subprocess
import sys
import time
from typing import Any

import asperity as asp
import h5py
import numpy as np
import pytest
from random_cases import COURSES, RandomCase

CASES = int(os.environ.get("CASES", "99"))
SEED = int(os.environ.get("SEED", "0"))
COMMAND = os.environ.get("ASPERITY", f"{sys.executable} -m asperity").split()

# What a case may rightly come to in place of results.
NO_ANSWER = re.compile(
    r"closes the whole periodic gap|plastic limit|holds? at most|is at most|cannot carry|full contact|a single pass removes so much|what friction holds"
)
# Cells of these columns may be empty.
OPTIONAL = {
    "power", "permeability_across", "critical_x", "critical_y", "step",
    *(f"{kind}_{what}" for kind in ("thermal", "electrical") for what in (
        "conductance", "joint_conductance", "resistance", "resistance_full", "resistance_holm_greenwood", "joint_correlation",
        "conductance_of_stiffness")),
    "approach", "friction_coefficient", "max_flash_temperature", "stiffness", "time", "friction_power", "max_temperature",
}  # fmt: skip


@pytest.mark.parametrize("seed", range(SEED, SEED + CASES))
def test_a_random_case_holds_the_laws_of_every_result(seed: int, tmp_path: pathlib.Path) -> None:
    case = RandomCase(seed)
    path = case.write(tmp_path / "case")
    checked = command("check", path)
    if checked.returncode == 1 and NO_ANSWER.search(checked.stderr):
        pytest.skip(checked.stderr.splitlines()[0])
    assert checked.returncode == 0, checked.stderr
    out = tmp_path / "results"
    ran = command("run", path, "--out", out, "--threads", 1, "--quiet")
    if ran.returncode in (1, 2) and NO_ANSWER.search(ran.stderr):
        pytest.skip(ran.stderr.splitlines()[0])
    assert ran.returncode == 0, ran.stderr
    results = Results(out)
    results.hold_numbers()
    hold_pictures(out)
    hold_passes(case, results) if case.moves else hold_rest(case, results)
    hold_passage(results)
    if case.course in ("rolling", "traction"):
        hold_rolling(case, results)
    if case.flows:
        hold_flow(results)
    again = tmp_path / "threads"
    asp.run(path, out=again, threads=2, progress=False)
    hold_same(results, Results(again))
    hold_resumed(case, path, tmp_path / "resumed", results)
    hold_python(case, path.parent, results)


def test_all_courses_are_tried() -> None:
    assert {RandomCase(seed).course for seed in range(len(COURSES))} == set(COURSES)


def command(*arguments: Any) -> subprocess.CompletedProcess[str]:
    return subprocess.run([*COMMAND, *map(str, arguments)], capture_output=True, text=True)


class Results:
    """The files of a results directory, read without asperity."""

    def __init__(self, folder: pathlib.Path) -> None:
        self.folder = folder
        refuse = lambda word: pytest.fail(f"{word} in summary.json")  # noqa: E731
        self.summary: dict[str, Any] = json.loads((folder / "summary.json").read_text(), parse_constant=refuse)
        text = lambda path: path.read_text(encoding="utf-8-sig")  # noqa: E731
        self.tables = {path.name: list(csv.DictReader(text(path).splitlines())) for path in sorted(folder.glob("*.csv"))}
        self.fields = {str(path.relative_to(folder)): _arrays(path) for path in sorted(folder.rglob("*.h5"))}

    def column(self, table: str, name: str) -> np.ndarray:
        return np.array([float(row[name] or "nan") for row in self.tables[table]])

    def hold_numbers(self) -> None:
        """No number is NaN or infinite but where the documents say so, and none is -0."""
        for name, rows in self.tables.items():
            for row in rows:
                for column, cell in row.items():
                    if column == "along":
                        assert cell in ("x", "y")
                        continue
                    if name == "limits.csv" and column in ("limit", "body"):
                        assert not cell or cell.isalpha()
                        continue
                    # Not each step has all that is joined.
                    assert cell or name == "results.csv" or column in OPTIONAL, f"{name}: {column} is empty"
                    assert not cell or math.isfinite(float(cell)), f"{name}: {column} is {cell}"
                    assert cell not in ("-0", "-0.0"), f"{name}: {column} is {cell}"
        for name, (arrays, _) in self.fields.items():
            for array, values in arrays.items():
                if "temperature" in array and "flash" not in array:
                    continue
                finite = ~np.isnan(values) if array.startswith(("hardness", "cap")) else np.isfinite(values)
                assert finite.all(), f"{name}: {array} has {np.count_nonzero(~finite)} values that are not finite"


def _arrays(path: pathlib.Path) -> tuple[dict[str, np.ndarray], dict[str, Any]]:
    with h5py.File(path) as file:
        return {name: values[()] for name, values in file.items()}, dict(file.attrs)


def hold_pictures(out: pathlib.Path) -> None:
    figures = list((out / "figures").iterdir())
    assert figures and all(figure.stat().st_size > 100 for figure in figures)
    page = (out / "report.html").read_text()
    assert "</html>" in page and "NaN" not in re.sub(r"<script.*?</script>|data:[^\"]*", "", page, flags=re.S)


def hold_rest(case: RandomCase, results: Results) -> None:
    """Load, bounds and complementarity of a static contact, and its displacement by an independent sum."""
    static = results.summary.get("static") or results.summary["sweep"][-1]
    fields, attributes = results.fields["fields.h5"]
    pressure, displacement, gap = fields["pressure"], fields["displacement"], fields["gap"]
    area = case.pitch[0] * case.pitch[1]
    plastic = fields.get("plastic", np.zeros_like(pressure))
    load = area * pressure.sum()
    assert load == pytest.approx(static["load"], rel=1e-9, abs=1e-9 * area * np.abs(pressure).sum())
    adhesion = results.summary.get("adhesion")
    assert (adhesion is None) == ("adhesion" not in case.tables) == ("contact" not in fields)
    touches = fields["contact"] > 0 if adhesion else pressure > 0
    if adhesion:
        hold_adhesion(case, results, touches)
    else:
        assert (pressure >= 0).all()
    height = fields["upper"] - fields["lower"]
    scale = np.ptp(height) + np.abs(displacement).max() + abs(attributes["approach"])
    assert np.abs(height + displacement - attributes["approach"] - gap).max() <= 1e-9 * scale
    cap = fields.get("cap", np.minimum(_hardness(fields, attributes, "lower"), _hardness(fields, attributes, "upper")))
    assert (pressure <= cap * (1 + 1e-9)).all()
    deformed = [np.std(displacement), 1e-4 * np.abs(displacement).max(), 1e-4 * case.pitch[0] * np.abs(pressure).max() / case.modulus]
    small = 300 * case.tolerance * max(*deformed, 1e-15 * scale)
    if case.slides:
        small *= 10
    small += _removed_after(case, fields)
    touching = gap + plastic
    assert touching.min() >= -small, (touching.min(), small)
    assert np.abs(touching[touches]).max(initial=0) <= small, (np.abs(touching[touches]).max(), small)
    assert area * plastic.sum() == pytest.approx(static["plastic_volume"], rel=1e-6, abs=area * small)
    coupled = case.slides and not case.similar and case.tables["friction"].get("coupling", "full") == "full"
    if not (case.coated or case.mixed or coupled or case.flows):
        independent = _displacement(pressure / case.modulus, case.pitch, case.boundary[0] == "periodic")
        assert np.abs(independent - displacement).max() <= 1e-5 * np.abs(independent).max() + small


def hold_adhesion(case: RandomCase, results: Results, touches: np.ndarray) -> None:
    """Open cells bear the tension at their gap, others no more than the largest; the numbers are those of the fields."""
    fields, _ = results.fields["fields.h5"]
    static = results.summary.get("static") or results.summary["sweep"][-1]
    numbers, area = results.summary["adhesion"], case.pitch[0] * case.pitch[1]
    largest, length = numbers["max_tension"], numbers["range"]
    assert largest == pytest.approx(case.tables["adhesion"]["work"] / length, rel=1e-12)
    pressure, gap = fields["pressure"], np.maximum(fields["gap"] + fields.get("plastic", 0.0), 0)
    assert (pressure >= -largest * (1 + 1e-9)).all()
    if case.tables["adhesion"].get("potential") != "dugdale":
        tension = largest * np.exp(-gap / length)
        slack = 1e3 * case.tolerance * max(np.std(fields["displacement"]) / length, 1e-3) * largest
        slack += largest * _removed_after(case, fields) / length
        assert np.abs(pressure + tension)[~touches].max(initial=0) <= slack
        assert static["adhesive_load"] == pytest.approx(area * tension[~touches].sum(), rel=1e-3, abs=1e-9 * area * largest)
    assert static["min_pressure"] == pytest.approx(pressure.min(), rel=1e-12)
    assert static["contact_area"] == pytest.approx(area * np.count_nonzero(touches), rel=1e-9)


def hold_passage(results: Results) -> None:
    """Shares add up, more than nothing conducts where bodies touch, and what leaks has a path."""
    for row in results.tables.get("conductance.csv", []):
        conductance = row.get("thermal_conductance", row.get("electrical_conductance"))
        shares = [float(row[name]) for name in ("spot_share", "gas_share", "film_share")]
        assert all(0 <= share <= 1 for share in shares)
        if conductance:
            assert sum(shares[:2]) == pytest.approx(1 if float(conductance) > 0 else 0, abs=1e-9)
            assert float(conductance) > 0 or float(row["spots"]) == 0
    for row in results.tables.get("flow.csv", []):
        permeability, critical, gap = (float(row[name]) for name in ("permeability", "critical_gap", "mean_gap"))
        assert (permeability > 0) == (critical > 0) and permeability >= 0
        assert 0 <= float(row["flowing_share"]) <= 1 and float(row["residual"]) < 1e-10
        if permeability > 0:
            assert float(row["effective_medium"]) >= 0 and gap > 0
    if "static" in results.summary:
        fields, _ = results.fields["fields.h5"]
        touching, area = fields.get("contact", fields["pressure"]) > 0, float(results.summary["static"]["contact_area"])
        if "flux" in fields and results.summary["conductance"][0]["gas_share"] == 0:
            assert (fields["flux"][~touching] == 0).all()
        for axis in "xy":
            if f"flow_{axis}" in fields and area > 0:
                assert (fields[f"flow_{axis}"] >= 0).all()


def _removed_after(case: RandomCase, fields: dict[str, np.ndarray]) -> float:
    """Depth that the bodies of stages may have lost to wear after the contact of the fields."""
    if case.course == "in-place":
        return 0.0
    return sum(float(fields[name].max()) for name in ("wear_lower", "wear_upper") if name in fields)


def _hardness(fields: dict[str, np.ndarray], attributes: dict[str, Any], body: str) -> Any:
    return fields.get(f"hardness_{body}", attributes["hardness"])


def _displacement(pressure: np.ndarray, pitch: list[float], periodic: bool) -> np.ndarray:
    """Love's sum over all cells, or the harmonics of a periodic half-space, of unit composite modulus."""
    nx, ny = pressure.shape
    if periodic:
        q = np.hypot(*np.meshgrid(*(2 * np.pi * np.fft.fftfreq(n, d) for n, d in zip((nx, ny), pitch)), indexing="ij"))
        q[0, 0] = np.inf
        return np.fft.ifft2(np.fft.fft2(pressure) * 2 / q).real
    def corner(x: np.ndarray, y: np.ndarray) -> np.ndarray:
        return x * np.arcsinh(y / np.abs(x)) + y * np.arcsinh(x / np.abs(y))
    x, y = np.meshgrid(*(d * np.arange(-n + 1, n) for n, d in zip((nx, ny), pitch)), indexing="ij")
    a, b = pitch[0] / 2, pitch[1] / 2
    love = (corner(x + a, y + b) - corner(x + a, y - b) - corner(x - a, y + b) + corner(x - a, y - b)) / np.pi
    at = np.arange(nx)[:, None] - np.arange(nx)[None, :] + nx - 1
    across = np.arange(ny)[:, None] - np.arange(ny)[None, :] + ny - 1
    return np.einsum("ikjl,kl->ij", love[at[:, :, None, None], across[None, None, :, :]], pressure)


def hold_passes(case: RandomCase, results: Results) -> None:
    """Loads, bounds and ledgers of a motion."""
    area = case.pitch[0] * case.pitch[1]
    contact, motion = results.summary["case"]["contact"], results.summary["case"]["motion"]
    adhesion = results.summary.get("adhesion")
    assert (adhesion is None) == ("adhesion" not in case.tables)
    passes, steps = results.tables["passes.csv"], results.tables["steps.csv"]
    before = results.fields["fields/initial.h5"][0]
    for row in passes:
        number = int(row["pass"])
        here = [step for step in steps if int(step["pass"]) == number]
        loads = np.array([float(step["load"]) for step in here])
        assert float(row["mean_load"]) == pytest.approx(loads.mean(), rel=1e-9, abs=1e-300)
        wanted = case.load if case.control in ("load", "mean_pressure") else None
        if wanted is not None and motion["control"] == "pass-load":
            assert loads.mean() == pytest.approx(wanted, rel=max(1.01 * motion["load_tolerance"], 100 * case.tolerance))
        if wanted is not None and motion["control"] == "step-load":
            assert loads == pytest.approx(wanted, rel=1e-8)
        after, attributes = results.fields[f"fields/pass-{number:04}.h5"]
        for name, pressure in after.items():
            if not re.fullmatch(r"pressure_\d+", name):
                continue
            step = here[int(name[9:]) - 1]
            largest = adhesion["max_tension"] if adhesion else 0.0
            tension = float(step.get("adhesive_load", 0.0))
            assert (pressure >= -largest * (1 + 1e-9)).all()
            # The tension of open cells is the adhesive load.
            small = 1e3 * case.tolerance * area * np.abs(pressure).sum() if adhesion else 1e-300
            assert area * pressure.sum() == pytest.approx(float(step["load"]), rel=1e-9, abs=small)
            assert -area * pressure[pressure < 0].sum() >= tension * (1 - 1e-9) - small
            assert pressure.max(initial=0) == pytest.approx(float(step["max_pressure"]), rel=1e-9)
            if adhesion:
                assert area * np.count_nonzero(pressure > 0) <= float(step["contact_area"]) * (1 + 1e-9)
            else:
                assert area * np.count_nonzero(pressure) == pytest.approx(float(step["contact_area"]))
            cap = after.get(f"cap_{name[9:]}", attributes["cap"])
            assert (pressure <= cap * (1 + 1e-9)).all(), f"{name} in pass {number}"
        for body, sign in (("lower", 1), ("upper", -1)):
            lost = area * sign * (before[body] - after[body]).sum()
            ledger = sum(float(row.get(f"{law}_volume_{body}") or 0) for law in ("plastic", "wear", "film"))
            if not case.flows:
                size = 1e-12 * area * np.abs(after[body]).sum()
                assert lost == pytest.approx(ledger, rel=1e-6, abs=size), f"{body} in pass {number}"
            film = after.get(f"film_{body}")
            if film is not None:
                thickest = case.tables[body]["film"]["max_thickness"] if "film" in case.tables[body] else 0
                assert film.min() >= 0 and film.max() <= thickest * (1 + 1e-12)
            worn, was = after.get(f"wear_{body}"), before.get(f"wear_{body}")
            if worn is not None and "counter" not in case.tables["motion"]:
                assert (worn >= (0 if was is None else was) - 1e-30).all()
        before = after if case.tables["motion"].get("counter") != "fresh" else {**after, "upper": None}
        if before["upper"] is None:
            break


def hold_rolling(case: RandomCase, results: Results) -> None:
    """What friction takes is what creepage and spin bring in."""
    static = results.summary.get("static")
    points = [static] if static else results.summary["sweep"]
    mu = case.tables["friction"]["coefficient"]
    fields = results.fields["fields.h5"][0]
    shear = np.hypot(fields["traction_x"], fields["traction_y"])
    bound = np.minimum(mu * np.maximum(fields["pressure"], 0), case.tables["friction"].get("shear_strength", math.inf))
    assert (shear <= bound * (1 + 1e-6) + 1e-9 * bound.max()).all()
    for point in points:
        pair = lambda key: point.get(key) or [point.get(f"{key}_x"), point.get(f"{key}_y")]  # noqa: E731
        power = np.dot(pair("creepage"), pair("tangential_force")) + (point.get("spin") or 0) * (point.get("moment") or 0)
        size = case.pitch[0] * point["load"] * np.linalg.norm(pair("creepage")) * mu
        # Between dissimilar bodies the pressure does work, too; a sweep has no column for the moment.
        assert point["dissipation"] >= -1e-6 * size or not case.similar
        if case.similar and (static or not case.tables["friction"].get("spin")):
            assert point["dissipation"] == pytest.approx(power * case.pitch[0], rel=1e-6, abs=1e-6 * size)


def hold_flow(results: Results) -> None:
    """Plastic strain keeps the volume; work and stored energy are not negative."""
    for name, (arrays, _) in results.fields.items():
        if "plasticity" not in name:
            continue
        for body in ("lower", "upper"):
            if f"strain_xx_{body}" not in arrays:
                continue
            trace = sum(arrays[f"strain_{axis}_{body}"] for axis in ("xx", "yy", "zz"))
            accumulated = arrays[f"accumulated_{body}"]
            assert (accumulated >= 0).all() and np.abs(trace).max() <= 1e-9 * max(accumulated.max(), 1e-12)
    record = results.summary.get("plasticity") or results.summary.get("static")
    assert record["plastic_work"] >= 0 and record["stored_energy"] >= -1e-9 * record["plastic_work"]


def hold_same(one: Results, other: Results) -> None:
    """All numbers but times are the same, to the bit."""
    assert one.tables.keys() == other.tables.keys() and one.fields.keys() == other.fields.keys()
    timeless = lambda rows: [{key: row[key] for key in row if key != "wall_time_s"} for row in rows]  # noqa: E731
    for name in one.tables:
        assert timeless(one.tables[name]) == timeless(other.tables[name]), name
    for name, (arrays, _) in one.fields.items():
        for array, values in arrays.items():
            np.testing.assert_array_equal(values, other.fields[name][0][array], f"{name}: {array}")


def hold_resumed(case: RandomCase, path: pathlib.Path, out: pathlib.Path, results: Results) -> None:
    """A run that is interrupted at some moment and resumed comes to the same numbers."""
    run = [*COMMAND, "run", str(path), "--out", str(out), "--quiet"]
    process = subprocess.Popen(run, stdout=subprocess.DEVNULL, stderr=subprocess.PIPE, text=True)
    time.sleep(case.rng.uniform(0.02, 1.5 * results.summary["wall_time_s"] + 0.3))
    process.send_signal(signal.SIGINT)
    _, said = process.communicate()
    # An interpreter that was interrupted before the command began speaks for itself.
    assert process.returncode in (0, 130, -signal.SIGINT) or not out.exists(), said
    resumes = process.returncode == 130 and (out / "case.json").exists()
    asp.run(path, out=out, resume=resumes, overwrite=not resumes, progress=False)
    hold_same(results, Results(out))


def hold_python(case: RandomCase, folder: pathlib.Path, results: Results) -> None:
    """A call in Python comes to the numbers of the case file, and reads its results."""
    opened = asp.open(results.folder)
    repr(opened), opened._repr_html_(), opened.to_xarray()
    tables = case.tables
    lower, upper = _body(tables["lower"], folder), _body(tables["upper"], folder)
    shared = {key: tables.get(key) for key in ("friction", "temperature", "conductance", "flow", "adhesion") if key in tables}
    output = tables.get("output", {})
    output = {key: value for key, value in output.items() if key != "paraview"}
    if case.moves:
        keys = {**tables["contact"], **tables["motion"], **shared, **{key: tables[key] for key in ("acceleration", "plasticity") if key in tables}}
        run = asp.simulate(lower, upper, **keys, **output, progress=False)
        for row, found in zip(results.tables["passes.csv"], run.passes, strict=True):
            _equal(row, {name: found[name] for name in run.passes.dtype.names})
        return
    if case.course == "in-place":
        found = asp.slide(lower, upper, **tables["contact"], **tables["sliding"], **shared, progress=False)
    else:
        keys = {**tables["contact"], **shared, **{key: tables[key] for key in ("history", "plasticity") if key in tables}}
        found = asp.contact(lower, upper, **keys, **output, progress=False)
    static = results.summary.get("static")
    if static:
        shared = [key for key, value in static.items() if isinstance(value, float) and key in found.numbers]
        assert "load" in shared
        assert {key: found.numbers[key] for key in shared} == {key: static[key] for key in shared}
    np.testing.assert_array_equal(found.pressure, results.fields["fields.h5"][0]["pressure"])


def _equal(row: dict[str, str], found: dict[str, Any]) -> None:
    for name, cell in row.items():
        if name != "wall_time_s":
            assert float(cell or "nan") == pytest.approx(float(found[name]), rel=0, abs=0, nan_ok=True), name


def _body(table: dict[str, Any], folder: pathlib.Path) -> asp.Body:
    coating = asp.Coating(**table["coating"]) if "coating" in table else None
    plasticity = asp.Plasticity(**table["plasticity"]) if "plasticity" in table else None
    hardness = table.get("hardness")
    if isinstance(hardness, dict):
        hardness = np.load(folder / hardness["file"])
    young = math.inf if table["young"] == "inf" else table["young"]
    material = asp.Material(young, table["poisson"], hardness, coating, plasticity)
    thermal = {key: table[key] for key in ("conductivity", "heat_capacity", "density", "resistivity") if key in table}
    surface = _surface(table["topography"], folder)
    return asp.Body(surface, material, table.get("mount"), wear=table.get("wear"), film=table.get("film"), thermal=thermal or None)


def _surface(table: dict[str, Any], folder: pathlib.Path) -> asp.Surface:
    keys = {key: value for key, value in table.items() if key not in ("plus", "mirror", "level")}
    if "form" in keys:
        surface = getattr(asp.form, keys.pop("form"))(**keys)
    elif "generate" in keys:
        surface = getattr(asp.generate, keys.pop("generate").replace("-", "_"))(**keys)
    else:
        surface = asp.Surface(np.load(folder / keys["file"]), keys["pitch"])
    if "level" in table:
        surface = surface.level(table["level"])
    if "mirror" in table:
        surface = surface.mirror(table["mirror"])
    for other in table.get("plus", []):
        surface = surface.plus(_surface(other, folder))
    return surface
