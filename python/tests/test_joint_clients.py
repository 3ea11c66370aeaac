"""Other programs return the law of a joint from the files that were written for them: CalculiX and OpenSees.

Two blocks, a C3D8 each, without lateral contraction and with guided sides, are pressed together: closure, drop of temperature and
shear follow from the law alone. A test is left out where its program is missing (Debian's `calculix-ccx`; `pip install openseespy`).
"""

import re
import runpy
import shutil
import subprocess

import numpy as np
import pytest

import asperity as asp

from test_joint import CASE

YOUNG, CONDUCTIVITY, SIDE, DROP = 210e9, 46.0, 1e-3, 100.0
FACES = {"lower": (5, 6, 7, 8), "upper": (9, 10, 11, 12)}
# Factors from SI: pressure, length, conductivity.
UNITS = {"mm": (1e-6, 1e3, 1.0), "si": (1.0, 1.0, 1.0)}


@pytest.fixture(scope="module", params=UNITS)
def law(request, tmp_path_factory):
    path = tmp_path_factory.mktemp("joint") / "faces.toml"
    path.write_text(CASE)
    with pytest.warns(asp.errors.ModelWarning):
        return asp.joint(path, clients=["calculix", "opensees"], units=request.param, friction=0.3, progress=False), request.param


def between(law):
    """Pressures at the points of the law and between them, without the largest."""
    points = law.pressure[:-1]
    return np.sort(np.concatenate([points, 0.5 * (law.pressure[1:] + points)]))


def pressed(law, units, name, loads, tmp_path, *, heat=False, slip=None):
    """Closure, drop of temperature and shear that ccx returns at each load, SI."""
    pascal, metre, watt = UNITS[units]
    side = SIDE * metre
    lines = ["*NODE, NSET=ALL"]
    for first, z in ((1, -side), (9, 0.0)):
        for n in range(8):
            x, y = side * (n % 4 in (1, 2)), side * (n % 4 in (2, 3))
            lines.append(f"{first + n}, {x:g}, {y:g}, {z + side * (n > 3):g}")
    lines += [
        "*ELEMENT, TYPE=C3D8, ELSET=BLOCKS", "1, 1,2,3,4,5,6,7,8", "2, 9,10,11,12,13,14,15,16",
        "*NSET, NSET=LOWER, GENERATE", "1, 8", "*NSET, NSET=UPPER, GENERATE", "9, 16", "*NSET, NSET=FACES, GENERATE", "5, 12",
        "*NSET, NSET=BOTTOM, GENERATE", "1, 4", "*NSET, NSET=TOP, GENERATE", "13, 16",
        "*SURFACE, NAME=MASTER", "1, S2", "*SURFACE, NAME=SLAVE", "2, S1",
        "*MATERIAL, NAME=STEEL", "*ELASTIC", f"{YOUNG * pascal:g}, 0.0", "*CONDUCTIVITY", f"{CONDUCTIVITY * watt:g}",
        "*SOLID SECTION, ELSET=BLOCKS, MATERIAL=STEEL", f"*INCLUDE, INPUT={name}",
        "*CONTACT PAIR, INTERACTION=JOINT, TYPE=NODE TO SURFACE", "SLAVE, MASTER",
        "*INITIAL CONDITIONS, TYPE=TEMPERATURE", "ALL, 0.",
        "*BOUNDARY", "ALL, 2, 2", "LOWER, 1, 1", "UPPER, 1, 1", "BOTTOM, 3, 3",
    ]
    for load in loads:
        lines += ["*STEP, NLGEOM, INC=200"]
        lines += ["*COUPLED TEMPERATURE-DISPLACEMENT, STEADY STATE" if heat else "*STATIC", "0.25, 1., 1e-6, 0.5"]
        if heat:
            lines += ["*BOUNDARY", "BOTTOM, 11, 11, 0.", f"TOP, 11, 11, {DROP:g}"]
        if slip is not None:
            lines += ["*BOUNDARY", f"UPPER, 1, 1, {slip * metre:.9e}"]
        lines += ["*DLOAD", f"2, P2, {load * pascal:.9g}", "*NODE PRINT, NSET=FACES", "U, NT" if heat else "U"]
        lines += ["*CONTACT PRINT", "CDIS, CSTR", "*END STEP"]
    shutil.copy(law.directory / name, tmp_path / name)
    (tmp_path / "blocks.inp").write_text("\n".join(lines) + "\n")
    ran = subprocess.run(["ccx", "-i", "blocks"], cwd=tmp_path, capture_output=True, text=True, timeout=300, check=False)
    assert (tmp_path / "blocks.dat").exists(), ran.stdout[-2000:]
    found = read(tmp_path / "blocks.dat")
    times = sorted(time for kind, time in found if kind == "displacements" and time == round(time))
    assert len(times) == len(loads), ran.stdout[-2000:]
    mean = lambda rows, face, column: np.mean([rows[node][column] for node in FACES[face]])
    jump = lambda rows, column: mean(rows, "upper", column) - mean(rows, "lower", column)
    closure = [-jump(found["displacements", time], 2) / metre for time in times]
    drop = [jump(found["temperatures", time], 0) for time in times] if heat else None
    shear = [np.mean([np.hypot(*row[-2:]) for row in found["contact stress", time].values()]) / pascal for time in times]
    return np.array(closure), drop, shear


def read(path):
    """The last table of each kind at each time, by the number in the first column."""
    found, rows = {}, None
    for line in path.read_text().splitlines():
        head = re.match(r"\s*(displacements|temperatures|contact stress)\b.*time\s+(\S+)", line)
        words = line.split()
        if head:
            rows = found[head[1], round(float(head[2]), 6)] = {}
        elif words and rows is not None and words[0].isdigit():
            rows[int(words[0]) if len(rows) == 0 or int(words[0]) not in rows else -len(rows)] = [float(word) for word in words[1:]]
        elif words:
            rows = None
    return found


@pytest.mark.skipif(shutil.which("ccx") is None, reason="needs CalculiX")
class TestCalculix:
    def test_it_closes_the_joint_as_the_law_says(self, law, tmp_path):
        law, units = law
        loads = between(law)
        closure, _, _ = pressed(law, units, "joint-calculix.inp", loads, tmp_path)
        expected = np.interp(loads, *law.closure)
        # In metres a stiff joint suffers from steps below 1e-10, which CalculiX moves apart.
        assert np.max(np.abs(closure - expected)) < (1e-4 if units == "mm" else 3e-3) * law.closure[1][-1]

    def test_it_conducts_as_the_law_says_at_its_points(self, law, tmp_path):
        law, units = law
        loads = law.pressure[:-1]
        _, drop, _ = pressed(law, units, "joint-calculix-heat.inp", loads, tmp_path, heat=True)
        conductance = law["thermal_joint_conductance"].median[:-1]
        expected = DROP / (1.0 + 2.0 * conductance * SIDE / CONDUCTIVITY)
        assert drop == pytest.approx(expected, rel=2e-3)

    def test_it_shears_in_proportion_to_the_slip(self, law, tmp_path):
        law, units = law
        if units == "si":
            pytest.skip("steps of displacement in metres are too small for it: the documents advise mm")
        middle = len(law.pressure) // 2
        slip = 1e-10
        _, _, shear = pressed(law, units, "joint-calculix.inp", [law.pressure[middle]], tmp_path, slip=slip)
        assert shear[0] == pytest.approx(law["stiffness_x"].median[middle] * slip, rel=1e-3)

    def test_its_defects_are_still_there(self, law, tmp_path):
        """Once this fails, a newer CalculiX takes a table in SURFACE TO SURFACE, and the advice in the files may go."""
        law, units = law
        name = "joint-calculix.inp"
        text = (law.directory / name).read_text()
        (tmp_path / name).write_text(text)
        _, _, _ = pressed(law, units, name, law.pressure[:1], tmp_path)
        deck = (tmp_path / "blocks.inp").read_text().replace("NODE TO SURFACE", "SURFACE TO SURFACE")
        (tmp_path / "faces.inp").write_text(deck)
        ran = subprocess.run(["ccx", "-i", "faces"], cwd=tmp_path, capture_output=True, text=True, timeout=300, check=False)
        assert "diverge" in ran.stdout.lower() or "best solution" in ran.stdout.lower() or ran.returncode != 0


def test_opensees_has_the_law_as_a_spring(law, tmp_path):
    ops = pytest.importorskip("openseespy.opensees")
    law, units = law
    pascal, metre, _ = UNITS[units]
    area = 1e-6 * metre**2
    joint = runpy.run_path(str(law.directory / "joint-opensees.py"))["joint"]
    largest, most = law.pressure[-1], law.closure[1][-1]
    slope = (largest - law.closure[0][-2]) / (most - law.closure[1][-2])
    for load in [*between(law), 1.2 * largest]:
        ops.wipe()
        ops.model("basic", "-ndm", 1, "-ndf", 1)
        ops.node(1, 0.0)
        ops.node(2, 0.0)
        ops.fix(1, 1)
        joint(ops, 1, area)
        ops.element("zeroLength", 1, 1, 2, "-mat", 1, "-dir", 1)
        ops.timeSeries("Linear", 1)
        ops.pattern("Plain", 1, 1)
        ops.load(2, load * pascal * area)
        ops.system("FullGeneral")
        ops.numberer("Plain")
        ops.constraints("Plain")
        ops.integrator("LoadControl", 0.1)
        ops.test("NormUnbalance", 1e-9 * load * pascal * area, 100)
        ops.algorithm("Newton")
        ops.analysis("Static")
        assert ops.analyze(10) == 0
        expected = np.interp(load, *law.closure) if load <= largest else most + (load - largest) / slope
        assert ops.nodeDisp(2, 1) / metre == pytest.approx(expected, rel=1e-7)
