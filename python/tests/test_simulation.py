"""Motions, and custom laws."""

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

CASE = """
[lower]
young = "210 GPa"
poisson = 0.3
hardness = "4 GPa"
[lower.topography]
generate = "low-pass"
shape = [32, 32]
pitch = "1 um"
sq = 5e-8
cutoff = "8 um"
seed = 1
[upper]
young = "210 GPa"
poisson = 0.3
hardness = "4 GPa"
[upper.topography]
generate = "low-pass"
shape = [32, 32]
pitch = "1 um"
sq = 5e-8
cutoff = "8 um"
seed = 2
[contact]
load = "20 mN"
{}
"""

COLUMNS = [name for name in asp._core.PASS_COLUMNS if name != "wall_time_s"]


def numbers(run: asp.Run) -> list:
    return [run.passes[name].tolist() for name in COLUMNS] + [run.steps.tolist()]


@pytest.mark.parametrize(
    ("more", "arguments"),
    [
        ("[motion]\npasses = 2", {"passes": 2}),
        (
            'boundary = "periodic"\n[friction]\ncoefficient = 0.1\n'
            '[motion]\nstrategy = "shift"\nstride = 4\nspeed_upper = "2 m/s"\nplastic_update = "step"',
            {"boundary": "periodic", "friction": 0.1, "strategy": "shift", "stride": 4, "speed_upper": "2 m/s", "plastic_update": "step"},
        ),
    ],
    ids=["overlap", "shift"],
)  # fmt: skip
def test_a_call_is_the_case_file_bit_for_bit(tmp_path: pathlib.Path, pair: Pair, more: str, arguments: dict) -> None:
    path = tmp_path / "case.toml"
    path.write_text(CASE.format(more))
    of_file = asp.run(path, out=tmp_path / "out", progress=False)
    called = asp.simulate(*pair, load="20 mN", **arguments)
    assert isinstance(of_file, asp.Run)
    assert numbers(of_file) == numbers(called)
    assert called.lower() == of_file.lower() and called.upper() == of_file.upper()
    assert called == of_file


def test_a_run_tells_its_passes_positions_and_surfaces(pair: Pair) -> None:
    run = asp.simulate(*pair, load=0.02, passes=2, pressure_every=4)
    assert run.is_done and run.passes["pass"].tolist() == [1, 2]
    assert run.passes["mean_load"] == pytest.approx([0.02, 0.02], rel=1e-4)
    assert len(run.steps) == 2 * 63 and run.steps["overlap_columns"].max() == 32
    assert run.passes.dtype["pass"] == np.int64
    assert "pressure_00033" in run.fields() and run.fields(1)["pressure_00001"].values.shape == (1, 32)
    assert run.fields(0)["lower"].unit == "m"
    lost = run.passes["plastic_volume_lower"].sum() + run.passes["plastic_volume_upper"].sum()
    assert lost > 0
    gone = (run.lower(0).heights - run.lower().heights).sum() - (run.upper(0).heights - run.upper().heights).sum()
    assert gone * 1e-12 == pytest.approx(lost, rel=1e-9)
    with pytest.raises(errors.CaseError, match="'number' is 3"):
        run.fields(3)


def test_a_run_whose_bodies_never_touch_is_read(pair: Pair, tmp_path: pathlib.Path) -> None:
    run = asp.simulate(*pair, approach="-1 um", stride=8, out=tmp_path / "out")
    assert np.isnan(run.passes["friction_coefficient"]).all() and run.passes["max_load"].tolist() == [0.0]
    assert any("no contact" in text for text in run.warnings) and asp.open(tmp_path / "out") == run


def archard(p: asp.Pass, over_hardness: float = 2e-13) -> tuple[np.ndarray, np.ndarray]:
    """Depths by Archard's law: coefficient over hardness, 1/Pa, times pressure times sliding distance."""
    depths = [np.zeros(shape[0] * shape[1]) for shape in p.shapes]
    for depth, cells in zip(depths, (p.contacts.lower_cell, p.contacts.upper_cell), strict=True):
        np.add.at(depth, cells, over_hardness * p.contacts.pressure * p.sliding_distance)
    return depths[0].reshape(p.shapes[0]), depths[1].reshape(p.shapes[1])


def test_archards_wear_balances_its_volume(pair: Pair) -> None:
    elastic = tuple(asp.Body(body.surface, asp.Material("210 GPa", 0.3)) for body in pair)
    run = asp.simulate(*elastic, load=0.02, passes=3, law=archard)
    # V = k W s: the load of a pass is the sum over its positions, each slides over one cell.
    worn = 2e-13 * 63 * run.passes["mean_load"] * 1e-6
    for body in ("lower", "upper"):
        assert run.passes[f"wear_volume_{body}"] == pytest.approx(worn, rel=1e-9)
    gone = (run.lower(0).heights - run.lower().heights).sum() * 1e-12
    assert gone == pytest.approx(worn.sum(), rel=1e-9)
    assert (run.passes["plastic_volume_lower"] == 0).all()


def test_a_custom_law_counts_in_an_accelerated_run(pair: Pair, tmp_path: pathlib.Path) -> None:
    elastic = [asp.Body(body.surface, asp.Material(young="210 GPa", poisson=0.3)) for body in pair]
    most = []

    def law(p: asp.Pass) -> tuple:
        depths = p.on_bodies(1e-16 * p.contacts.pressure * p.sliding_distance)
        most.append(p.numbers["represents"] * depths[0].max())
        return depths

    limits = {"acceleration": {"max_wear": "0.2 nm", "tolerance": 1}, "speed": 0.5, "load": 0.02, "progress": False}
    whole = asp.simulate(*elastic, passes=400, law=law, out=tmp_path / "whole", **limits)
    table = whole.passes
    assert table["represents"].sum() == 400 and len(table) < 100
    # k W s: the depths of a single pass come off once for each pass that is represented.
    distance = table["distance"][-1] / 400
    expected = 1e-16 * (table["represents"] * table["mean_load"]).sum() * distance
    assert table["wear_volume_lower"].sum() == pytest.approx(expected, rel=1e-6)
    assert 0.1e-9 < max(most) < 0.22e-9
    simulation = asp.Simulation(*elastic, passes=400, out=tmp_path / "parts", **limits)
    for p in simulation:
        p.remove(*law(p))
        if p.number == 7:
            break
    simulation.close()
    asp.simulate(*elastic, passes=400, law=law, out=tmp_path / "parts", resume=True, **limits)
    assert (asp.open(tmp_path / "parts").passes["wear_volume_lower"] == table["wear_volume_lower"]).all()
    with pytest.raises(errors.CaseError, match="needs a body that passes change"):
        asp.simulate(*elastic, passes=400, **limits)


def test_what_is_done_between_two_cells_comes_to_both(pair: Pair) -> None:
    simulation = asp.Simulation(
        *pair, load=0.02, passes=1, strategy="shift", speed_lower=0.3, speed_upper=1.0, stride=2, boundary="periodic"
    )
    p = next(iter(simulation))
    c = p.contacts
    assert set(np.round(np.unique(c.lower_beyond), 9)) == {0.0, 0.2, 0.4, 0.6, 0.8} and (c.upper_beyond == 0).all()
    lower, upper = p.on_bodies(c.pressure)
    assert lower.shape, upper.shape == p.shapes
    for found in (lower, upper):
        assert found.sum() == pytest.approx(c.pressure.sum(), rel=1e-12)
    # The mean pressure of the pass, as the results have it.
    positions = len(p.steps)
    expected = simulation.results().fields(1)
    for found, name in ((lower, "mean_pressure_lower"), (upper, "mean_pressure_upper")):
        assert found / positions == pytest.approx(np.asarray(expected[name].values), rel=1e-12)


def test_a_pass_there_and_back_and_across_has_its_steps(pair: Pair) -> None:
    run = asp.simulate(
        *pair, load=0.02, passes=3, stride=8, boundary=("free", "periodic"), path="reciprocating", offset_y="random", seed=3
    )
    for number in (1, 2, 3):
        steps = run.steps[run.steps["pass"] == number]
        assert np.array_equal(steps["offset"], steps["offset"][::-1]) and len(set(steps["offset_y"])) == 1
        assert np.array_equal(steps["load"], steps["load"][::-1])
    with pytest.raises(errors.CaseError, match="needs a generated upper surface"):
        asp.simulate(pair[0], asp.Body(asp.form.flat((32, 32), pitch="1 um"), pair[0].material), load=0.02, counter="fresh")


def test_a_fresh_counter_body_is_another_in_each_pass(pair: Pair) -> None:
    lower, upper = (
        asp.Body(asp.generate.low_pass((24, 16), pitch="1 um", sq="50 nm", cutoff="8 um", seed=s), pair[0].material)
        for s in (1, 2)
    )
    run = asp.simulate(lower, upper, load=0.01, passes=3, stride=4, counter="fresh")
    first, second, third = (run.upper(number).heights for number in (1, 2, 3))
    assert abs(second - first).max() > 20e-9 and abs(third - second).max() > 20e-9


def test_a_loop_is_the_law(pair: Pair) -> None:
    by_law = asp.simulate(*pair, load=0.02, passes=3, law=archard)
    simulation = asp.Simulation(*pair, load=0.02, passes=3)
    for p in simulation:
        p.remove(*archard(p))
    assert simulation.results() == by_law


def test_contacts_are_flat_arrays(pair: Pair) -> None:
    simulation = asp.Simulation(*pair, load=0.02, passes=1)
    p = next(iter(simulation))
    c = p.contacts
    assert len({len(array) for array in c}) == 1 and (np.diff(c.position) >= 0).all()
    load = np.bincount(c.position, weights=c.pressure, minlength=63) * p.cell_area
    assert load == pytest.approx(p.steps["load"], rel=1e-12)
    assert (c.plastic > 0).sum() == p.steps["plastic_cells"].sum()
    parts = list(c.by_position())
    assert sum(len(part.pressure) for part in parts) == len(c.pressure)
    assert all((part.position == part.position[0]).all() for part in parts)
    # The cells that face each other: over the flush position column k of one is column k of the other.
    flush = c.position == 31
    assert np.array_equal(c.lower_cell[flush], c.upper_cell[flush])


def test_what_is_left_by_break_counts_once_it_is_asked_for(pair: Pair) -> None:
    simulation = asp.Simulation(*pair, load=0.02, passes=5)
    for p in simulation:
        p.remove(1e-9, 0.0)
        if p.number == 2:
            break
    assert simulation.done == 1
    run = simulation.results()
    assert len(run.passes) == 2 and not run.is_done
    assert run.passes["wear_volume_lower"] == pytest.approx(2 * [1e-9 * 1024e-12], rel=1e-9)


def test_a_pass_is_there_until_the_loop_goes_on(pair: Pair) -> None:
    simulation = asp.Simulation(*pair, load=0.02, passes=2)
    passes = iter(simulation)
    first = next(passes)
    next(passes)
    with pytest.raises(RuntimeError, match="this pass is finished"):
        first.remove(0.0, 0.0)
    with pytest.raises(RuntimeError, match="this pass is finished"):
        _ = first.contacts


def test_an_exception_in_a_law_ends_the_run_and_resume_goes_on(pair: Pair, tmp_path: pathlib.Path) -> None:
    whole = asp.simulate(*pair, load=0.02, passes=3, law=archard, out=tmp_path / "whole")

    def broken(p: asp.Pass) -> tuple[np.ndarray, np.ndarray]:
        if p.number == 2:
            raise ZeroDivisionError("of the law")
        return archard(p)

    with pytest.raises(ZeroDivisionError, match="of the law"):
        asp.simulate(*pair, load=0.02, passes=3, law=broken, out=tmp_path / "out")
    opened = asp.open(tmp_path / "out")
    assert isinstance(opened, asp.Run) and len(opened.passes) == 1 and not opened.is_done
    resumed = asp.simulate(*pair, load=0.02, passes=3, law=archard, out=tmp_path / "out", resume=True)
    assert resumed == whole
    assert resumed.lower() == whole.lower()


@pytest.mark.parametrize(
    ("law", "told"),
    [
        (lambda p: (np.zeros(3), 0.0), "'depth_lower' has the shape 3, expected 32 × 32"),
        (lambda p: (0.0, np.zeros((32, 31))), "'depth_upper' has the shape 32 × 31"),
        (lambda p: (np.nan, 0.0), "'depth_lower' holds numbers that are not finite"),
        (lambda p: 1.0, "'law' gave float"),
        (lambda p: p.remove(0.0, 0.0, law="Wear!"), "'law' is 'Wear!'"),
    ],
)
def test_a_law_that_gives_what_has_no_meaning(pair: Pair, law, told: str) -> None:
    with pytest.raises(errors.CaseError) as caught:
        asp.simulate(*pair, load=0.02, law=law)
    assert told in str(caught.value)


@pytest.mark.parametrize(
    ("arguments", "told"),
    [
        ({"passes": 0}, "'passes' is 0"),
        ({"passes": 1.5}, "'passes' is 1.5"),
        ({"stride": -1}, "'stride' is -1"),
        ({"strategy": "roll"}, "'strategy' is \"roll\""),
        ({"control": "approach"}, "'control'"),
        ({"boundary": "periodic"}, "needs a boundary that is free along x"),
        ({"rim": 0.7}, "'rim' is 0.7"),
        ({"speed_upper": 1}, "applies to strategy = \"shift\" only"),
    ],
)
def test_bad_arguments_are_named(pair: Pair, arguments: dict, told: str) -> None:
    with pytest.raises(errors.CaseError) as caught:
        asp.simulate(*pair, load=0.02, **arguments)
    assert told in str(caught.value)


def test_runs_pickle_and_copy(pair: Pair, tmp_path: pathlib.Path) -> None:
    for out in (None, tmp_path / "out"):
        run = asp.simulate(*pair, load=0.02, out=out)
        again = pickle.loads(pickle.dumps(run))
        assert again == run == copy.deepcopy(run) and again.lower() == run.lower()
    directory = run.directory
    assert directory.exists()
    temporary = asp.simulate(*pair, load=0.02)
    where = temporary.directory
    del temporary
    assert not where.exists()


def test_results_of_another_case_are_not_resumed(pair: Pair, tmp_path: pathlib.Path) -> None:
    asp.simulate(*pair, load=0.02, passes=1, out=tmp_path / "made")
    with pytest.raises(errors.OtherCase, match=r"'contact.load' was 0.02, now it is 0.03"):
        asp.simulate(*pair, load=0.03, passes=1, out=tmp_path / "made", resume=True)
    given = asp.Surface(pair[0].surface.heights, 1e-6)
    lower = asp.Body(given, pair[0].material)
    with pytest.raises(errors.OtherCase):
        asp.simulate(lower, pair[1], load=0.02, passes=1, out=tmp_path / "made", resume=True)
    asp.simulate(lower, pair[1], load=0.02, passes=1, out=tmp_path / "given")
    changed = asp.Body(asp.Surface(given.heights + 1e-9, 1e-6), pair[0].material)
    with pytest.raises(errors.SurfaceChanged):
        asp.simulate(changed, pair[1], load=0.02, passes=2, out=tmp_path / "given", resume=True)
    more = asp.simulate(lower, pair[1], load=0.02, passes=2, out=tmp_path / "given", resume=True)
    assert len(more.passes) == 2


def test_open_names_what_is_no_results(tmp_path: pathlib.Path) -> None:
    with pytest.raises(errors.NoResults):
        asp.open(tmp_path)
    (tmp_path / "case.json").write_text("{}")
    with pytest.raises((OSError, ValueError)):
        asp.open(tmp_path)
    with pytest.raises(errors.CaseError) as caught:
        (tmp_path / "case.toml").write_text(CASE.format('[motion]\npasses = "two"'))
        asp.run(tmp_path / "case.toml", out=tmp_path / "out")
    assert caught.value.line == 27 and "'passes' is a string" in str(caught.value)


def test_bodies_that_wear_and_grow_films(pair: Pair, tmp_path: pathlib.Path) -> None:
    film = {
        "law": "arrhenius", "max_thickness": "50 nm", "rate": "200 nm/s", "at_temperature": "100 °C", "at_stress": "1 GPa",
        "activation_energy": "0.8 eV", "activation_volume": "3.8e-3 nm3",
    }  # fmt: skip
    heat = {"conductivity": 46.0, "heat_capacity": 460.0, "density": 7850.0}
    lower = asp.Body(pair[0].surface, pair[0].material, wear={"coefficient": "2e-6 mm3/(N m)"}, film=film, thermal=heat)
    upper = asp.Body(pair[1].surface, pair[1].material, wear={"energy": "2e-5 mm3/J"}, thermal=heat)
    assert pickle.loads(pickle.dumps(lower)) == lower != pair[0]
    run = asp.simulate(
        lower, upper, load=0.02, boundary="periodic", strategy="shift", speed_upper="0.5 m/s", stride=4, passes=60,
        friction={"coefficient": 0.1, "coupling": "none"}, acceleration={}, temperature={"bulk": "100 °C"}, out=tmp_path / "out",
    )  # fmt: skip
    assert run.is_done and run.passes["represents"].sum() == 60 and len(run.passes) < 60
    # V = k W s of the lower body, α μ W s of the upper one.
    work = (run.passes["represents"] * run.passes["mean_load"]).sum() * 8 * 4e-6
    assert run.passes["wear_volume_lower"].sum() == pytest.approx(2e-15 * work, rel=1e-3)
    assert run.passes["wear_volume_upper"].sum() == pytest.approx(2e-14 * 0.1 * work, rel=1e-3)
    assert (np.diff(run.passes["mean_film_lower"]) > 0).all() and (run.passes["mean_film_upper"] == 0).all()
    assert run.passes["max_flash_temperature"].min() > 373.15
    assert run.fields()["film_lower"].values.mean() == pytest.approx(run.passes["mean_film_lower"][-1])
    with pytest.raises(errors.CaseError, match="missing key 'speed'"):
        asp.simulate(lower, pair[1], load=0.02, temperature={"bulk": "100 °C"})


def test_laws_see_shear_temperature_and_time(pair: Pair) -> None:
    heat = {"conductivity": 46.0, "heat_capacity": 460.0, "density": 7850.0}
    bodies = [asp.Body(body.surface, body.material, thermal=heat) for body in pair]
    simulation = asp.Simulation(
        *bodies, load=0.02, passes=2, stride=4, speed=0.5, friction=0.1, temperature={"bulk": 373.15}, progress=False
    )
    for p in simulation:
        c = p.contacts
        assert c.shear == pytest.approx(0.1 * c.pressure) and p.time == pytest.approx(p.sliding_distance / 0.5)
        assert c.temperature.min() >= 373.15 - 1e-9 and c.temperature.max() > 373.5
    cold = next(iter(asp.Simulation(*pair, load=0.02, passes=1, stride=4, progress=False))).contacts
    assert (cold.shear == 0.0).all() and np.isnan(cold.temperature).all()
