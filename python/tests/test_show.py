"""Pictures, tables of notebooks, and results handed over."""

import base64
import csv
import re
import struct
import subprocess
import sys
import zlib

import numpy as np
import pytest

import asperity as asp
from asperity import _show
from conftest import rough
from test_study import CASE

plt = pytest.importorskip("matplotlib.pyplot")


@pytest.fixture(scope="module")
def steel():
    return asp.Material(young="210 GPa", poisson=0.3, hardness="4 GPa")


@pytest.fixture(scope="module")
def pair():
    return [asp.generate.low_pass((24, 16), pitch="1 um", sq="50 nm", cutoff="8 um", seed=seed) for seed in (1, 2)]


@pytest.fixture(scope="module")
def pressed(pair, steel):
    return asp.contact(*pair, steel, steel, load="50 mN", progress=False)


@pytest.fixture(scope="module")
def run(pair, steel):
    return asp.simulate(*pair, steel, steel, load="20 mN", passes=2, title="<b> & c", threads=1, progress=False)


@pytest.fixture(autouse=True)
def no_figures_left():
    plt.switch_backend("agg")
    yield
    plt.close("all")


def pixels(text):
    """The first inline PNG of a text, decoded by the standard: rows from the top."""
    data = base64.b64decode(re.search(r"base64,([^\"]+)", text)[1])
    assert data[:8] == b"\x89PNG\r\n\x1a\n"
    place, chunks = 8, []
    while place < len(data):
        (length,) = struct.unpack(">I", data[place : place + 4])
        kind, body = data[place + 4 : place + 8], data[place + 8 : place + 8 + length]
        assert struct.unpack(">I", data[place + 8 + length : place + 12 + length])[0] == zlib.crc32(kind + body)
        chunks.append((kind, body))
        place += 12 + length
    width, height = struct.unpack(">II", chunks[0][1][:8])
    rows = np.frombuffer(zlib.decompress(chunks[1][1]), dtype=np.uint8).reshape(height, 1 + 3 * width)
    assert chunks[-1] == (b"IEND", b"") and not rows[:, 0].any()
    return rows[:, 1:].reshape(height, width, 3)


def surface(heights):
    return asp.Surface(heights, pitch="1 um")


def test_a_small_map_has_x_to_the_right_and_y_upwards():
    heights = np.zeros((5, 3))
    heights[4, 2] = 1e-6
    image = pixels(surface(heights)._repr_html_())
    assert image.shape == (3, 5, 3)
    bright = np.argwhere((image == (0xFE, 0xE8, 0x38)).all(axis=2))
    assert bright.tolist() == [[0, 4]], "the highest cell is not at the upper right"


def test_a_small_map_of_a_large_surface_averages():
    heights = np.zeros((400, 330))
    heights[:200] = 1e-6
    heights[10:19, 20:40] = np.nan
    image = pixels(surface(heights)._repr_html_())
    assert image.shape == (110, 134, 3)
    # Steps of three cells: 200 lies within the square from 198 to 201, two thirds of it high.
    colours = [np.interp(2 / 3, np.linspace(0, 1, 9)[5:7], pair) for pair in ((0x9B, 0xBC), (0x94, 0xAE), (0x76, 0x6C))]
    assert np.abs(image[0, 66] - colours).max() <= 1
    # Cells 12 to 18 of x are whole squares of missing ones; a square that is partly missing shows the rest.
    assert (image[-1 - 8, 4:6] == 191).all() and (image[-1 - 8, 3] != 191).any()


def test_out_of_contact_the_small_map_is_white(pressed):
    image = pixels(pressed._repr_html_())
    white = (image == 255).all(axis=2)
    assert np.array_equal(white.T[:, ::-1], pressed.pressure == 0.0)
    assert 0 < white.sum() < white.size


def test_tables_are_escaped_and_tell_the_main_numbers(run, pressed):
    text = run._repr_html_()
    assert "&lt;b&gt; &amp; c" in text and "<b>" not in text
    assert "2 of 2 passes" in text and "mean load" in text
    assert "50 mN" in pressed._repr_html_()
    named = pressed.fields["gap"]._repr_html_()
    assert "least" in named and "µm" in named
    assert "sphere" in asp.form.sphere("1 mm")._repr_html_(), "a surface that takes its grid from another one"


def test_small_maps_need_no_matplotlib():
    code = """
import sys
sys.modules["matplotlib"] = sys.modules["xarray"] = sys.modules["pandas"] = None
import asperity as asp
s = asp.form.sphere("1 mm", (8, 8), "1 um")
assert "<img" in s._repr_html_()
for call, package in ((s.plot, "matplotlib"), (s.to_xarray, "xarray")):
    try:
        call()
    except ModuleNotFoundError as error:
        assert f"pip install {package}" in str(error), error
    else:
        raise AssertionError(package)
"""
    subprocess.run([sys.executable, "-c", code], check=True)


def test_a_map_shows_each_cell_where_it_is():
    heights = np.full((6, 4), 1e-9)
    heights[5, 0] = 300e-9
    heights[0, 3] = np.nan
    ax = surface(heights).plot()
    (image,) = ax.images
    assert image.get_extent() == [0.0, 6.0, 0.0, 4.0] and ax.get_xlabel() == "x (µm)"
    shown = image.get_array()
    assert shown.shape == (4, 6) and shown[0, 5] == pytest.approx(300.0) and shown.mask[3, 0]
    assert image.origin == "lower" and ax.get_aspect() == 1.0
    assert ax.child_axes[0].get_ylabel() == "height (nm)"


def test_a_pressure_map_leaves_out_what_is_out_of_contact(pressed):
    ax = pressed.plot(cmap="magma")
    image = ax.images[-1]
    assert np.array_equal(np.ma.getmaskarray(image.get_array()).T, pressed.pressure == 0.0)
    assert image.get_clim() == pytest.approx((0.0, pressed.max_pressure * 1e-9))
    assert image.get_cmap().name == "magma"


def test_touching_cells_are_blank_in_a_map_of_the_gap(pressed):
    image = pressed.plot("gap").images[-1]
    assert np.array_equal(np.ma.getmaskarray(image.get_array()).T, (pressed.pressure > 0.0) & (pressed.plastic == 0.0))


def test_depth_points_downwards():
    section = asp.Field("section_zz", -np.outer([1e9, 2e9], [3.0, 2.0, 1.0]), "Pa", ("x", "z"), (1e-6, 2e-6), (5e-7, 0.0))
    ax = section.plot()
    assert ax.yaxis.get_inverted() and ax.images[-1].get_clim() == pytest.approx((-6.0, 6.0))
    column = asp.Field("column_01_zz", np.array([-3e9, -1e9]), "Pa", ("z",), (2e-6,), (0.0,))
    ax = column.plot()
    assert ax.yaxis.get_inverted() and ax.lines[0].get_ydata() == pytest.approx([0.0, 2.0])


def test_a_run_draws_its_columns(run):
    ax = run.plot("mean_contact_area", color="k")
    assert ax.get_ylabel() == "mean contact area (µm²)"
    assert ax.lines[0].get_ydata() == pytest.approx(1e12 * run.passes["mean_contact_area"])
    ax = run.plot()
    assert [text.get_text() for text in ax.get_legend().get_texts()] == ["pass 1", "pass 2"]
    assert len(ax.lines[0].get_xdata()) == (run.steps["pass"] == 1).sum()
    with pytest.raises(asp.errors.CaseError, match=r"'quantity' is 'sq'.*sq_lower"):
        run.plot("sq")


def test_a_run_writes_its_page(run, tmp_path):
    path = run.report(tmp_path / "page.html")
    assert path == tmp_path / "page.html"
    page = path.read_text(encoding="utf-8")
    assert page.startswith("<!doctype html>") and "After 2 passes under a mean load of" in page
    for column in ("mean_load", "max_pressure", "sq_lower"):
        told = re.search(rf'data-key="passes\.1\.{column}" value="([^"]+)"', page)
        assert told is not None and float(told[1]) == run.passes[column][1], column
    assert run.report() == run.directory / "report.html" and (run.directory / "report.html").read_text(encoding="utf-8") == page
    with pytest.raises(asp.errors.FileProblem, match=r"no/page\.html"):
        run.report(tmp_path / "no" / "page.html")


def test_an_animation_shows_each_pressure_on_the_lower_body(run):
    film = run.animate(1, interval=50.0)
    fields = run.fields(1)
    names = [name for name in fields if name.startswith("pressure_")]
    film._draw_frame(len(names) - 1)
    (image,) = (one for one in film._fig.axes[0].images if one.get_array().ndim == 2)
    last = fields[names[-1]]
    shown = 1e9 * np.ma.filled(image.get_array(), 0.0).T
    begin = round((last.origin[0] - 0.5e-6) / 1e-6)
    assert begin > 0 and shown[begin:].sum() == pytest.approx(last.values.sum()) and not shown[:begin].any()
    assert "<img" in film._repr_html_()


def test_without_kept_pressures_an_animation_says_what_keeps_them(pair, steel):
    run = asp.simulate(*pair, steel, steel, load="20 mN", pressure_every=0, stride=8, progress=False)
    with pytest.raises(asp.errors.CaseError, match="no pressures are kept") as caught:
        run.animate()
    assert "pressure_every=8" in caught.value.hint


def test_passes_and_surfaces_become_a_data_set(run):
    pytest.importorskip("xarray")
    data = run.to_xarray()
    assert data["mean_load"].attrs["units"] == "N" and np.array_equal(data["pass"], [1, 2])
    for number in range(3):
        assert np.array_equal(data["lower"].sel(after=number), run.lower(number).heights)
        assert np.array_equal(data["upper"].sel(after=number), run.upper(number).heights)
    assert float(data["x_lower"][1]) == pytest.approx(1.5e-6) and data["y_upper"].attrs["units"] == "m"


def test_passes_become_a_frame(run):
    pytest.importorskip("pandas")
    frame = run.to_pandas()
    assert frame.index.name == "pass" and frame.loc[2, "max_pressure"] == run.passes["max_pressure"][1]
    assert frame.attrs["units"]["plastic_volume_lower"] == "m³"


def test_every_column_of_the_tables_has_a_unit():
    from asperity import _core

    plain = {
        "pass", "step", "overlap_columns", "largest_spot_cells", "plastic_cells", "iterations", "convolutions", "residual",
        "friction_coefficient", "outer_iterations", "increment", "stage", "point", "contact_fraction", "creepage_x",
        "creepage_y",
    }  # fmt: skip
    for column in {*_core.STEP_COLUMNS, *_core.PASS_COLUMNS, *_core.INCREMENT_COLUMNS, *_core.SWEEP_COLUMNS}:
        assert (_show.unit_of(column) == "1") == (column in plain), column
    for column, unit in _core.COLUMN_UNITS:
        assert _show.unit_of(column) == unit


@pytest.mark.parametrize(
    ("column", "unit"),
    [
        ("distance", "m"), ("time", "s"), ("max_wear_lower", "m"), ("max_wear_upper", "m"), ("mean_film_lower", "m"),
        ("mean_film_upper", "m"), ("error_estimate", "m"), ("friction_work", "J"), ("max_flash_temperature", "K"),
        ("plastic_work_lower", "J"), ("plastic_work_rim", "J"), ("surface_shift_upper", "m"), ("max_temperature", "K"),
        ("friction_power", "W"), ("offset_y", "m"), ("subsurface_max_von_mises", "Pa"), ("max_residual_tension", "Pa"),
        ("own_volume_lower", "m³"), ("represents", "1"), ("state", ""), ("message", ""), ("of nobody", ""),
    ],
)  # fmt: skip
def test_columns_have_the_units_of_the_documents(column, unit):
    assert _show.unit_of(column) == unit


def test_what_a_run_writes_has_units_in_frame_and_dataset(tmp_path, steel):
    pytest.importorskip("pandas")
    pytest.importorskip("xarray")
    worn = asp.Body(rough(1), steel, wear={"coefficient": 1e-15})
    run = asp.simulate(worn, asp.Body(rough(2), steel), load="20 mN", passes=1, stride=8, speed=1.0, friction=0.1,
                       progress=False)  # fmt: skip
    frame, dataset = run.to_pandas(), run.to_xarray()
    from asperity import _core

    for column in run.passes.dtype.names:
        unit = _core.unit_of_column(column)
        assert unit is not None, column
        if column != "pass":
            assert frame.attrs["units"][column] == unit and dataset[column].attrs["units"] == unit
    assert run.plot("max_wear_lower").get_ylabel().endswith("m)")
    (tmp_path / "case.toml").write_text(CASE)
    (tmp_path / "load.toml").write_text('base = "case.toml"\n[axes]\n"contact.load" = ["1 mN"]\n"lower.topography.seed" = [1]\n')
    study = asp.study(tmp_path / "load.toml", progress=False)
    units = study.to_pandas().attrs["units"]
    with open(study.directory / "table.csv", newline="", encoding="utf-8-sig") as file:
        for head in next(csv.reader(file)):
            name, unit = re.fullmatch(r"(.+?)(?: \((.+)\))?", head).groups()
            assert units.get(name, "1") in ([unit] if unit else ["", "1"]), head
    assert units["lower.topography.seed"] == "1" and units["contact.load"] == "N" and units["message"] == ""


@pytest.mark.parametrize(
    ("unit", "number", "text"),
    [("m", 2.5e-7, "250 nm"), ("m", 1e-6, "1 µm"), ("Pa", 3.2e9, "3.2 GPa"), ("m³", 7.9e-19, "0.79 µm³"), ("N", 5e-2, "50 mN"),
     ("m²", 6.5e-11, "65 µm²"), ("1", 0.3, "0.3 1"), ("m", 12.0, "12 m")],
)  # fmt: skip
def test_units_suit_the_numbers(unit, number, text):
    factor, name = _show.scale(unit, number)
    assert f"{factor * number:.3g} {name}" == text


def test_printed_objects_have_their_main_numbers_with_units(run, pair, steel):
    assert str(pair[0]) == "<Surface: 24 × 16 cells of 1 µm, Sq 50 nm, generate 'low-pass'>"
    assert repr(surface([[0.0, np.nan], [1e-9, 1e-9]])) == "<Surface: 2 × 2 cells of 1 µm, Sq 471.4 pm, 1 missing>"
    assert repr(asp.form.flat(pitch="1 um")) == "<Surface: form 'flat', on the grid of the other body>"
    assert str(steel) == "Material(young='210 GPa', poisson=0.3, hardness='4 GPa')"
    coated = asp.Material(1.23456789e9, 0.3, coating=asp.Coating("2 um", "300 GPa", 0.25), plasticity=asp.Plasticity("1 GPa"))
    for material in (steel, coated, asp.Material(np.inf, 0.3)):
        assert eval(repr(material), {**vars(asp)}) == material
    assert re.fullmatch(r"<Run: 2 of 2 passes, mean load 20 mN, Sq [\d.]+ nm \(lower\) and [\d.]+ nm \(upper\)>", repr(run))


def test_completion_offers_only_names_of_the_package():
    for module in (asp, asp.reference, asp.describe, asp.errors, asp.form, asp.generate):
        names = dir(module)
        assert names == sorted(module.__all__) and not {"np", "math", "annotations", "Any", "surface", "simulation"} & set(names)
        for name in names:
            assert hasattr(module, name), name
            assert getattr(getattr(module, name), "__module__", "asperity").startswith(("asperity", "typing")), name
