"""Random valid cases over all tables of a case file, each with small surfaces.

`python python/tests/random_cases.py SEED FOLDER` writes one case with its surfaces, to look at it.
"""

from __future__ import annotations

import math
import pathlib
import random
import sys
from typing import Any

import numpy as np

Table = dict[str, Any]

COURSES = (
    "press", "sweep", "history", "friction", "rolling", "traction", "in-place", "overlap", "shift", "flowing", "flowing-motion",
)  # fmt: skip

PITCH = 1e-6


class RandomCase:
    """A case of one course with options drawn from a seed.

    Attributes
    ----------
    tables : dict
        The tables of the case file, numbers in SI.
    arrays : dict
        Heights and maps of hardness that the tables name as `.npy` files.
    """

    def __init__(self, seed: int, course: str | None = None) -> None:
        self.rng = random.Random(seed)
        self.seed = seed
        self.course = course or COURSES[seed % len(COURSES)]
        self.arrays: dict[str, np.ndarray] = {}
        rng = self.rng
        self.moves = self.course in ("overlap", "shift", "flowing-motion")
        self.strategy = {"overlap": "overlap", "shift": "shift", "flowing-motion": rng.choice(["overlap", "shift"])}.get(self.course)
        self.flows = self.course.startswith("flowing")
        self.boundary = self._boundary()
        self.mixed = self.boundary[0] != self.boundary[1]
        self.shape = self._shape()
        self.pitch = [PITCH, PITCH * rng.choice([1.0, 1.0, 0.5, 2.0])]
        self.similar = rng.random() < 0.6
        self.coated = not (self.flows or self.mixed) and self.course in ("press", "sweep", "history", "overlap", "shift", "in-place") and rng.random() < 0.2
        self.slides = self.course in ("friction", "rolling", "traction") or (self.moves and rng.random() < 0.4) or (self.course in ("in-place", "history", "flowing") and rng.random() < 0.4)
        if self.coated and not self.moves:
            self.slides = False
        self.wears = self.course == "in-place" or (self.course in ("overlap", "shift") and rng.random() < 0.6)
        self.sq = 10 ** rng.uniform(-8.3, -7)
        self.tables = self._case()

    def _boundary(self) -> list[str]:
        rng = self.rng
        if self.flows:
            x = "periodic" if self.strategy == "shift" else "free" if self.strategy == "overlap" else rng.choice(["free", "periodic"])
            return [x, x]
        x = "free" if self.strategy == "overlap" else rng.choice(["free", "periodic"])
        return [x, rng.choice([x, x, "free", "periodic"])]

    def _shape(self) -> list[list[int]]:
        rng = self.rng
        width = rng.choice([1, rng.randint(2, 9), rng.randint(8, 20)])
        if self.flows:
            width = rng.randint(6, 12)
        long = rng.randint(8 if self.flows else 5, 18)
        other = rng.randint(8, 18) if self.strategy == "overlap" else long
        return [[long, width], [other, width]]

    def _case(self) -> Table:
        rng = self.rng
        young = 10 ** rng.uniform(9.3, 11.5)
        self.film = [False, False]
        self.warm = False
        tables: Table = {"title": f"random case {self.seed}, {self.course}"}
        bodies = [self._body(0, young), self._body(1, young if self.similar else young * 10 ** rng.uniform(-1, 1))]
        rigid = not (self.similar or self.flows or self.coated) and rng.random() < 0.1
        if rigid:
            bodies[rng.randrange(2)]["young"] = "inf"
        inverse = sum((1 - b["poisson"] ** 2) / float(b["young"]) for b in bodies)
        self.modulus = 1 / inverse
        self._surfaces(bodies)
        self._hardness(bodies)
        if self.wears:
            self._running_in(bodies, tables)
        tables["lower"], tables["upper"] = bodies
        tables["contact"] = self._contact()
        if self.slides:
            tables["friction"] = self._friction()
        if self.course == "history" or (self.course in ("friction", "flowing") and rng.random() < 0.5):
            tables["history"] = self._history(tables)
        if self.moves:
            tables["motion"] = self._motion(tables)
        if self.course == "in-place":
            tables["sliding"] = {"distance": self.distance, "speed": 10 ** rng.uniform(-2, 0), "updates": rng.randint(1, 5)}
        if self.flows:
            tables["plasticity"] = self._plasticity(bodies)
        if not (self.mixed or self.coated) and self.course != "in-place" and rng.random() < 0.2:
            tables["subsurface"] = self._subsurface()
        output: Table = {}
        if self.moves or self.course == "sweep":
            output["pressure_every"] = rng.choice([1, 1, 1, 2, 3])
        if rng.random() < 0.1:
            output["paraview"] = True
        if output:
            tables["output"] = output
        if rng.random() < 0.3:
            self._passage(tables, bodies)
        # Drawn apart, so that the other options of a seed do not depend on it.
        self._adhesion(tables, random.Random(f"adhesion {self.seed}"))
        self._together(tables, bodies, random.Random(f"together {self.seed}"))
        return tables

    def _together(self, tables: Table, bodies: list[Table], rng: random.Random) -> None:
        """What bodies remember besides each other: plastic strain, a hardness, wear, heat, attraction."""
        if rng.random() < 0.4:
            return
        stages = tables.get("history", [])
        slips = "friction" in tables and self.course in ("history", "friction", "flowing") and not self.coated
        rate = 10 ** rng.uniform(-3, -1.5) * self.sq / (0.05 * self.modulus * self._slope() * self.shape[0][0] * PITCH)
        if self.flows and rng.random() < 0.5:
            # The other body has a hardness.
            other = 1 if "plasticity" in bodies[0] and "plasticity" not in bodies[1] else 0
            if "plasticity" not in bodies[other]:
                bodies[other]["hardness"] = self.modulus * self._slope() * 10 ** rng.uniform(-0.5, 0.5)
        if self.course == "flowing" and not slips and not stages and rng.random() < 0.5 and self.control in ("load", "mean_pressure"):
            value = tables["contact"].pop(self.control)
            tables["contact"] = {f"{self.control}s": [0.4 * value, value], **tables["contact"]}
            tables["plasticity"].pop("unload", None)
            return
        if self.course == "flowing-motion" or slips:
            bodies[rng.randrange(2)]["wear"] = {"coefficient": rate}
        if self.course == "flowing-motion" and "friction" in tables and (self.strategy == "overlap" or self.boundary[0] == "periodic"):
            tables["motion"].setdefault("speed" if self.strategy == "overlap" else "speed_upper", 1.0)
            self._conducts(tables, bodies)
        if slips and stages and rng.random() < 0.6:
            stage = stages[-1]
            stage |= {"cycles": rng.randint(1, 4), "period": 10 ** rng.uniform(-6, -2), "increments": rng.randint(1, 3)}
            if not self.mixed and rng.random() < 0.5:
                self._conducts(tables, bodies)
        if self.course in ("overlap", "shift") and self.wears and self.hardness < math.inf and rng.random() < 0.6:
            tables["motion"]["plastic_update"] = "step"
            if tables.get("acceleration", {}).get("max_jump", 1) > 1:
                tables["acceleration"]["max_jump"] = 1

    def _conducts(self, tables: Table, bodies: list[Table]) -> None:
        """Heat of friction."""
        tables.setdefault("temperature", {"bulk": 350.0})["every"] = 1
        for body in bodies:
            body |= {"conductivity": 46.0, "heat_capacity": 460.0, "density": 7850.0}

    def _adhesion(self, tables: Table, rng: random.Random) -> None:
        """Attraction of the bodies of some contacts, whose process zone has a cell or more."""
        moves = self.course in ("overlap", "shift") and "subsurface" not in tables
        static = self.course in ("press", "sweep", "history", "friction", "rolling", "traction", "in-place")
        if not moves and not static or rng.random() < 0.6:
            return
        pitch, extents = max(self.pitch), [n * d for n, d in zip(self.shape[0], self.pitch)]
        work = self.modulus * pitch * self._slope() ** 2 * 10 ** rng.uniform(-1.2, 0.3)
        shortest = math.sqrt(1.5 * math.pi * work * pitch / self.modulus)
        length = shortest * rng.uniform(0.9, 1.8)
        if length > 0.09 * min(extents):
            return
        tables["adhesion"] = {"work": work, "range": rng.choice(["grid", length, length])}
        if rng.random() < 0.2:
            tables["adhesion"]["potential"] = "dugdale"
        if self.strategy == "shift" and rng.random() < 0.5:
            tables["adhesion"]["history"] = "path"
        if "friction" in tables:
            tables["friction"]["coupling"] = "none" if self.coated else rng.choice(["goodman", "none"])
            if not moves:
                tables["friction"].pop("junction_growth", None)
        last = tables.get("history", [{}])[-1]
        if self.control in last and rng.random() < 0.5:
            # Some of these loads pull the bodies apart.
            pull = 0.2 * work / shortest * 10 ** rng.uniform(-2, 0)
            last[self.control] = -{"load": pull * self._area(), "mean_pressure": pull, "approach": 3 * self.sq}[self.control]

    def _passage(self, tables: Table, bodies: list[Table]) -> None:
        """What the contacts let through: heat or current, and a fluid."""
        rng = self.rng
        if not self.coated:
            kind = rng.choice(["thermal", "electrical"])
            table: Table = {"kind": kind, "every": rng.choice([1, 1, 2, 0])}
            if rng.random() < 0.5:
                table["film"] = 10 ** (rng.uniform(-10, -6) if kind == "thermal" else rng.uniform(-14, -10))
            if kind == "thermal" and rng.random() < 0.5:
                table["gas"] = 10 ** rng.uniform(-2, 0)
                table["jump"] = PITCH * rng.choice([0.0, 0.3])
            for body in bodies:
                if kind == "electrical":
                    body["resistivity"] = 10 ** rng.uniform(-8, -5)
                else:
                    body.setdefault("conductivity", 10 ** rng.uniform(0, 2))
            tables["conductance"] = table
        tables["flow"] = {"viscosity": 10 ** rng.uniform(-3, 0), "pressure": 10 ** rng.uniform(2, 6), "every": rng.choice([1, 1, 2, 0])}
        if rng.random() < 0.2:
            tables["flow"] |= {"gas": True, "outlet": 1e5}

    def _body(self, index: int, young: float) -> Table:
        rng = self.rng
        body: Table = {"young": young, "poisson": 0.3 if self.similar else rng.choice([0.0, 0.25, 0.3, 0.5])}
        if self.coated and (index == 0 or rng.random() < 0.3):
            body["coating"] = {
                "thickness": PITCH * 10 ** rng.uniform(-1, 1),
                "young": young * 10 ** rng.uniform(-1.5, 1.5),
                "poisson": rng.choice([0.0, 0.3, 0.45]),
            }
        if index == 1 and rng.random() < 0.2:
            body["mount"] = "as-is"
        return body

    def _surfaces(self, bodies: list[Table]) -> None:
        rng = self.rng
        smooth = rng.choice([None, None, 0, 1])
        for index, body in enumerate(bodies):
            shape, name = self.shape[index], ("lower", "upper")[index]
            extent = min(n * d for n, d in zip(shape, self.pitch) if n > 1)
            if index == smooth or (self.flows and index == 1):
                kinds = ["flat", "sphere", "cylinder", "sinusoid", "grooves"]
                form = "sphere" if self.flows else rng.choice(kinds)
                topography: Table = {"form": form, "shape": shape, "pitch": self.pitch}
                if form in ("sphere", "cylinder"):
                    topography["radius"] = extent**2 / 8 / max(self.sq, 5e-8)
                if form == "cylinder":
                    topography["axis"] = "y"
                if form == "sinusoid":
                    wide = shape[1] * self.pitch[1]
                    topography |= {"amplitude": self.sq, "wavelength": [shape[0] * PITCH, wide if shape[1] > 3 else "inf"]}
                if form == "grooves":
                    topography |= {"period": 4 * PITCH, "depth": self.sq}
            elif rng.random() < 0.4:
                topography = {"generate": "self-affine", "shape": shape, "pitch": self.pitch, "sq": self.sq, "hurst": rng.uniform(0.3, 1), "seed": rng.randrange(1000)}
            elif rng.random() < 0.5 and min(shape) * min(self.pitch) >= 5e-6:
                topography = {"generate": "low-pass", "shape": shape, "pitch": self.pitch, "sq": self.sq, "cutoff": 4e-6, "seed": rng.randrange(1000)}
            else:
                noise = np.random.default_rng(rng.randrange(2**31)).normal(0, self.sq, shape)
                self.arrays[f"{name}.npy"] = noise
                topography = {"file": f"{name}.npy", "pitch": self.pitch}
                if rng.random() < 0.3:
                    topography["mirror"] = rng.choice("xy")
                if rng.random() < 0.2 and not self.moves and min(shape) > 4:
                    topography["level"] = rng.choice(["mean", "plane"])
            if rng.random() < 0.15 and "form" not in topography and min(shape) > 3:
                topography["plus"] = [{"form": "sphere", "radius": extent**2 / 8 / max(self.sq, 5e-8)}]
            body["topography"] = topography

    def _slope(self) -> float:
        return self.sq / PITCH

    def _hardness(self, bodies: list[Table]) -> None:
        rng = self.rng
        self.hardness = math.inf
        self.maps = False
        if self.flows or rng.random() < 0.4:
            return
        for index, body in enumerate(bodies):
            if rng.random() < 0.3:
                continue
            hardness = self.modulus * self._slope() * 10 ** rng.uniform(-0.7, 0.5)
            if rng.random() < 0.3:
                name = f"hardness-{index}.npy"
                noise = np.random.default_rng(rng.randrange(2**31)).uniform(0.7, 1, self.shape[index])
                self.arrays[name] = hardness * noise
                body["hardness"] = {"file": name}
                hardness *= 0.7
                self.maps = True
            else:
                body["hardness"] = hardness
            self.hardness = min(self.hardness, hardness)

    def _running_in(self, bodies: list[Table], tables: Table) -> None:
        rng = self.rng
        self.distance = 10 ** rng.uniform(-3, 0)
        per_pass = self.shape[0][0] * PITCH if self.moves else self.distance
        pressure = 0.05 * self.modulus * self._slope()
        rate = 10 ** rng.uniform(-3, -0.5) * self.sq / (pressure * per_pass)
        # The heat of surfaces that go round goes round with them.
        heated = self.slides and rng.random() < 0.4 and (self.strategy != "shift" or self.boundary[0] == "periodic")
        heated = heated and not (self.mixed and self.course == "in-place")
        filmed = rng.random() < 0.5
        for index, body in enumerate(bodies):
            if index == 1 and rng.random() < 0.4:
                continue
            kind = rng.random()
            if kind < 0.2 and self.slides:
                body["wear"] = {"energy": rate / 0.2}
            elif kind < 0.4 and isinstance(body.get("hardness"), float):
                body["wear"] = {"dimensionless": rate * body["hardness"]}
            else:
                body["wear"] = {"coefficient": rate}
            if filmed and rng.random() < 0.8:
                body["film"] = self._film(body)
                if rng.random() < 0.5:
                    key = next(iter(body["wear"]))
                    bare = body["wear"][key] / (body["hardness"] if key == "dimensionless" else 1)
                    body["wear"]["under_film"] = bare * rng.choice([0.1, 0.5, 0.99])
        if filmed or heated:
            tables["temperature"] = {"bulk": rng.choice([300.0, [350.0, 400.0], 400.0])}
        if heated:
            for body in bodies:
                body |= {"conductivity": 46.0, "heat_capacity": 460.0, "density": 7850.0}
            every = [1] if self.course == "in-place" else [1, 1, 2, 0]
            tables["temperature"]["every"] = rng.choice(every)
        if self.moves and rng.random() < 0.5:
            tables["acceleration"] = {"max_jump": rng.choice([1, 3, 100])}

    def _film(self, body: Table) -> Table:
        rng = self.rng
        thickest = self.sq * 10 ** rng.uniform(-1.5, 0.5)
        film: Table = {"max_thickness": thickest}
        hardness = body.get("hardness")
        if isinstance(hardness, float) and rng.random() < 0.5:
            film["hardness"] = hardness * rng.uniform(0.4, 1)
        if rng.random() < 0.6:
            pressure = 0.05 * self.modulus * self._slope()
            film |= {
                "law": "arrhenius", "rate": thickest * 10 ** rng.uniform(0, 5), "at_temperature": 370.0,
                "at_stress": pressure, "activation_energy": rng.choice([0.0, 0.3, 0.8]) * 1.602e-19,
                "activation_volume": rng.uniform(0, 2) * 1.38e-23 * 370 / pressure,
            }  # fmt: skip
            if rng.random() < 0.5:
                film["removal"] = 10 ** rng.uniform(-2, 1) / pressure / PITCH / 100
            if self.slides and rng.random() < 0.3:
                film["stress"] = "shear"
        else:
            film |= {"law": "mechano-chemical", "x": 10 ** rng.uniform(-13, -9), "c3": thickest * rng.uniform(0.1, 1), "c4": 10 ** rng.uniform(0, 5)}
        return film

    def _mean_pressure(self) -> float:
        cells = self.shape[0][0] * self.shape[0][1]
        share = 10 ** self.rng.uniform(max(-2.5, -math.log10(cells)), -0.8)
        pressure = share * self.modulus * self._slope()
        return min(pressure, 0.25 * self.hardness)

    def _area(self) -> float:
        cells = min(math.prod(self.shape[0]), math.prod(self.shape[1]))
        return cells * self.pitch[0] * self.pitch[1]

    def _contact(self) -> Table:
        rng = self.rng
        contact: Table = {}
        pressure = self._mean_pressure()
        self.load = pressure * self._area() * (0.5 if self.strategy == "overlap" else 1)
        if self.course == "sweep":
            kind = rng.choice(["loads", "mean_pressures", "approaches"])
            unit = self._area() if kind == "loads" else 1.0
            if kind == "approaches":
                contact[kind] = {"from": 0.5 * self.sq, "to": 1.5 * self.sq, "points": rng.randint(2, 4)}
            elif rng.random() < 0.5:
                contact[kind] = [pressure * unit * part for part in (0.2, 1.0, 0.5)]
            else:
                contact[kind] = {"from": pressure * unit / 10, "to": pressure * unit, "points": rng.randint(2, 5)}
        elif self.slides and not self.moves or self.course == "in-place":
            contact[rng.choice(["load", "mean_pressure"])] = None
        else:
            contact[rng.choice(["load", "load", "mean_pressure", "approach"])] = None
        if "load" in contact:
            contact["load"] = self.load
        if "mean_pressure" in contact:
            contact["mean_pressure"] = self.load / self._area()
        if "approach" in contact:
            contact["approach"] = self.sq * rng.uniform(0, 1.5)
        self.control = next(iter(contact))
        x, y = self.boundary
        if x == y and rng.random() < 0.7:
            contact["boundary"] = x
        else:
            contact["boundary"] = [x, y]
        contact["tolerance"] = self.tolerance = rng.choice([1e-6, 1e-6, 1e-8])
        if rng.random() < 0.4 and not self.flows:
            contact["method"] = rng.choice(["direct", "active-set", "polonsky-keer"])
        return contact

    def _friction(self) -> Table:
        rng = self.rng
        friction: Table = {"coefficient": rng.uniform(0.05, 0.6)}
        if rng.random() < 0.2:
            friction["shear_strength"] = 0.3 * self.modulus * self._slope()
        steady = self.course in ("rolling", "traction")
        if self.coated:
            friction["coupling"] = "none"
        elif rng.random() < 0.4:
            friction["coupling"] = rng.choice(["full", "goodman", "none"])
        if self.hardness < math.inf and rng.random() < 0.3 and not self.wears:
            friction["junction_growth"] = 9.0
        if self.moves or self.course == "in-place":
            return friction
        mu = friction["coefficient"]
        if "shear_strength" in friction:
            mu *= 0.3
        along = rng.uniform(0, 2 * math.pi) if rng.random() < 0.5 else rng.choice([0, math.pi / 2, math.pi])
        way = [round(math.cos(along), 6) + 0.0, round(math.sin(along), 6) + 0.0]
        slip = mu * self._slope() * 10 ** rng.uniform(-1.5, 0.5)
        if steady:
            if self.course == "traction":
                friction["creepages"] = {"from": [0.0, 0.0], "to": [slip * part for part in way], "points": rng.randint(2, 4)}
            elif rng.random() < 0.7:
                friction["creepage"] = [slip * part for part in way]
            else:
                friction["rolling_force"] = [rng.uniform(0.1, 0.8) * mu * self.load * part for part in way]
            if self.boundary == ["free", "free"] and rng.random() < 0.4:
                friction["spin"] = slip / (self.shape[0][0] * PITCH) * rng.choice([-1, 1])
            return friction
        kind = rng.choice(["force", "displacement", "sliding"])
        if kind == "force":
            friction[kind] = [rng.uniform(0.1, 0.7) * mu * self.load * part for part in way]
        elif kind == "displacement":
            friction[kind] = [rng.uniform(0.1, 2) * mu * self.sq * part for part in way]
        else:
            friction[kind] = way
        if not self.flows:
            friction["increments"] = rng.randint(1, 6)
        return friction

    def _history(self, tables: Table) -> list[Table]:
        rng = self.rng
        stages = []
        for _ in range(rng.randint(1, 3)):
            stage: Table = {"increments": rng.randint(1, 4)}
            if self.control in ("load", "mean_pressure"):
                stage[self.control] = tables["contact"][self.control] * rng.uniform(0.3 if self.slides else 0.1, 1.5)
            else:
                stage["approach"] = self.sq * rng.uniform(0, 2)
            if self.slides and rng.random() < 0.5:
                stage["displacement"] = [rng.uniform(-1, 1) * self.sq * 0.3, 0.0]
            stages.append(stage)
        return stages

    def _motion(self, tables: Table) -> Table:
        rng = self.rng
        motion: Table = {"strategy": self.strategy, "passes": rng.randint(1, 3), "stride": rng.choice([1, 2, 3])}
        timed = self.wears or "temperature" in tables
        if self.strategy == "shift":
            motion |= {"speed_lower": rng.choice([0.0, 0.0, -0.5, 0.3]), "speed_upper": 1.0}
        elif timed or rng.random() < 0.3:
            motion["speed"] = 10 ** rng.uniform(-2, 0)
        if self.flows:
            motion["passes"] = rng.randint(1, 2)
            if self.control == "load":
                motion["control"] = "step-load"
            return motion
        if self.control != "approach" and rng.random() < 0.3 and not self.wears:
            motion["control"] = "step-load"
        if rng.random() < 0.3 and not self.wears:
            motion["plastic_update"] = "step"
        alike = True
        if rng.random() < 0.3:
            motion["path"] = "reciprocating"
        if self.boundary[1] == "periodic" and rng.random() < 0.3:
            motion["offset_y"] = rng.choice([1, 2, "random"])
            alike = False
            if motion["offset_y"] == "random":
                motion["seed"] = rng.randrange(100)
        if "generate" in tables["upper"]["topography"] and rng.random() < 0.3 and not self.maps:
            motion["counter"] = "fresh"
            alike = False
        if motion.get("speed_lower", 0.0) != 0.0 and "path" not in motion:
            alike = False
        if "acceleration" in tables:
            if not alike:
                tables["acceleration"]["max_jump"] = 1
            else:
                motion["passes"] = rng.choice([2, 5, 20])
        return motion

    def _plasticity(self, bodies: list[Table]) -> Table:
        rng = self.rng
        # Hertz' largest pressure would be about this under the mean pressure on the part of the grid that touches.
        stress = self.modulus * max(self.sq, 5e-8) / PITCH
        for body in bodies if rng.random() < 0.3 else bodies[:1]:
            law: Table = {"yield_stress": stress * 10 ** rng.uniform(-1.6, -0.3)}
            if rng.random() < 0.5:
                law["hardening"] = body["young"] * 10 ** rng.uniform(-3, -1)
            if rng.random() < 0.3:
                law["kinematic"] = body["young"] * 10 ** rng.uniform(-2, -1)
                if rng.random() < 0.5:
                    law["recovery"] = rng.uniform(1, 50)
            body["plasticity"] = law
        shorter = min(n * d for n, d in zip(self.shape[0], self.pitch))
        table: Table = {"depth": shorter * rng.uniform(0.5, 0.9), "layers": rng.randint(2, 5), "growth": rng.choice([1, 1.2])}
        if not self.moves:
            table["increments"] = rng.randint(1, 5)
            if rng.random() < 0.3:
                table["unload"] = False
        elif rng.random() < 0.3:
            table["keep"] = "passes"
        return table

    def _subsurface(self) -> Table:
        rng = self.rng
        table: Table = {"to": PITCH * rng.uniform(1, 8), "layers": rng.randint(1, 6), "body": rng.choice(["lower", "upper"])}
        if rng.random() < 0.4:
            table["planes"] = [0.0, PITCH]
        if rng.random() < 0.4:
            table["columns"] = [[2 * PITCH, 0.0]]
        return table

    def write(self, folder: pathlib.Path) -> pathlib.Path:
        """Writes the case file and the arrays that it names, and returns the path of the case file."""
        folder.mkdir(parents=True, exist_ok=True)
        for name, array in self.arrays.items():
            np.save(folder / name, array)
        path = folder / "case.toml"
        path.write_text(toml(self.tables))
        return path


def toml(tables: Table) -> str:
    """A case as text."""
    lines: list[str] = []
    _write(lines, [], tables)
    return "\n".join(lines) + "\n"


def _write(lines: list[str], path: list[str], table: Table) -> None:
    nested = [key for key, value in table.items() if _is_table(value)]
    lines += [f"{key} = {_value(value)}" for key, value in table.items() if key not in nested]
    for key in nested:
        name = ".".join([*path, key])
        if isinstance(table[key], dict):
            lines.append(f"[{name}]")
            _write(lines, [*path, key], table[key])
        for entry in table[key] if isinstance(table[key], list) else []:
            lines.append(f"[[{name}]]")
            _write(lines, [*path, key], entry)


def _is_table(value: Any) -> bool:
    """Whether a value is written under a head of its own; a short one of a sweep or a map is written in its line."""
    if isinstance(value, dict):
        return not value.keys() <= {"from", "to", "points", "file", "unit"}
    return isinstance(value, list) and bool(value) and isinstance(value[0], dict)


def _value(value: Any) -> str:
    if isinstance(value, bool):
        return str(value).lower()
    if isinstance(value, str):
        return f'"{value}"'
    if isinstance(value, list):
        return "[" + ", ".join(map(_value, value)) + "]"
    if isinstance(value, dict):
        return "{ " + ", ".join(f"{key} = {_value(entry)}" for key, entry in value.items()) + " }"
    return repr(value)


if __name__ == "__main__":
    print(RandomCase(int(sys.argv[1])).write(pathlib.Path(sys.argv[2])).read_text())
