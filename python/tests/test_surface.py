"""Surfaces: what they are made of, and what is done with them."""

from __future__ import annotations

import copy
import pathlib
import pickle

import asperity as asp
import numpy as np
import pytest
from asperity import errors
from conftest import rough

HEIGHTS = 1e-9 * np.random.default_rng(1).normal(size=(6, 5))


@pytest.mark.parametrize(
    "given",
    [
        HEIGHTS.tolist(),
        np.asfortranarray(HEIGHTS),
        np.repeat(np.repeat(HEIGHTS, 2, 0), 3, 1)[::2, ::3],
        np.flip(np.flip(HEIGHTS, 0).copy(), 0),
        np.ma.masked_array(HEIGHTS),
        HEIGHTS.astype(">f8"),
    ],
    ids=["lists", "columns", "strides", "negative strides", "masked array", "big-endian"],
)
def test_heights_of_any_order_are_the_same(given: object) -> None:
    surface = asp.Surface(given, pitch=1e-6)
    assert np.array_equal(surface.heights, HEIGHTS)
    assert np.array_equal(surface.level("mean").heights, asp.Surface(HEIGHTS, 1e-6).level("mean").heights)


def test_single_precision_whole_numbers_and_units() -> None:
    single = asp.Surface(HEIGHTS.astype(np.float32), "1 um")
    assert single.heights.dtype == np.float64
    assert np.allclose(single.heights, HEIGHTS, rtol=1e-7, atol=0)
    levels = asp.Surface(np.arange(6).reshape(3, 2), ("1 um", "2 um"), unit="nm")
    assert levels.pitch == (1e-6, 2e-6)
    assert levels.heights[2, 1] == pytest.approx(5e-9, rel=1e-15)


def test_read_only_heights_are_accepted_and_heights_given_out_are_read_only() -> None:
    heights = HEIGHTS.copy()
    heights.flags.writeable = False
    surface = asp.Surface(heights, 1e-6)
    assert surface.level("plane").shape == (6, 5)
    with pytest.raises(ValueError, match="read-only"):
        surface.heights[0, 0] = 1.0


def test_the_callers_array_stays_his() -> None:
    heights = HEIGHTS.copy()
    surface = asp.Surface(heights, 1e-6)
    assert surface.heights is not heights
    _ = surface.heights
    heights[0, 0] = 7e-9  # still writeable


def test_masked_and_nan_are_missing() -> None:
    mask = np.zeros(HEIGHTS.shape, bool)
    mask[2, 3] = True
    holed = HEIGHTS.copy()
    holed[2, 3] = np.nan
    one, other = asp.Surface(np.ma.masked_array(HEIGHTS, mask), 1e-6), asp.Surface(holed, 1e-6)
    assert one == other and one.undefined == 1
    filled = one.fill("nearest")
    assert filled.undefined == 0 and filled.filled == 1
    assert filled.heights[2, 3] in HEIGHTS


def test_a_data_array_tells_its_pitch_and_unit() -> None:
    xarray = pytest.importorskip("xarray")
    x, y = 0.5 + 2.0 * np.arange(6), 1.5 * np.arange(5)
    array = xarray.DataArray(1e9 * HEIGHTS, {"x": ("x", x, {"units": "um"}), "y": ("y", 1e-6 * y)}, attrs={"units": "nm"})
    surface = asp.Surface(array)
    assert surface.pitch == pytest.approx((2e-6, 1.5e-6), rel=1e-12)
    assert np.allclose(surface.heights, HEIGHTS, rtol=1e-12, atol=0)
    again = asp.Surface(surface.to_xarray())
    assert again.pitch == pytest.approx(surface.pitch, rel=1e-12)
    assert np.array_equal(again.heights, surface.heights)
    uneven = xarray.DataArray(HEIGHTS, {"x": x**2, "y": y}, ("x", "y"))
    with pytest.raises(errors.CaseError, match="'x' are not evenly spaced"):
        asp.Surface(uneven)


def test_a_topography_of_another_package_tells_pitch_and_unit() -> None:
    class Topography:
        physical_sizes = (12.0, 5.0)
        unit = "µm"

        def heights(self) -> np.ma.MaskedArray:
            return np.ma.masked_array(1e6 * HEIGHTS, HEIGHTS == HEIGHTS[1, 1])

    surface = asp.Surface(Topography())
    assert surface.pitch == pytest.approx((2e-6, 1e-6), rel=1e-12)
    assert surface.undefined == 1 and np.isnan(surface.heights[1, 1])
    assert surface.heights[0, 0] == pytest.approx(HEIGHTS[0, 0], rel=1e-12)


def test_steps_act_in_the_order_of_the_case_file() -> None:
    surface = rough(3)
    one = surface.s_filter("12 um").level("plane").mirror("x")
    other = surface.mirror("x").level("plane").s_filter("12 um")
    assert np.array_equal(one.heights, other.heights)
    twice = surface.level("plane").s_filter("12 um").level("mean")
    assert abs(twice.heights.mean()) < 1e-24


def test_surfaces_add_up() -> None:
    ball, one = asp.form.sphere("1 mm"), rough(1)
    made = asp.form.sphere("1 mm", one.shape, one.pitch)
    assert np.array_equal((one + ball).heights, one.heights + made.heights)
    assert np.array_equal((one + rough(2)).heights, one.heights + rough(2).heights)
    with pytest.raises(errors.CaseError, match="different grids"):
        one + rough(2, (16, 16))


@pytest.mark.parametrize("name", ["a.x3p", "a.npy", "a.sdf", "a.gwy"])
def test_what_is_written_is_read(tmp_path: pathlib.Path, name: str) -> None:
    surface = rough(4)
    path = tmp_path / name
    surface.write(path)
    back = asp.read(path, pitch="1 um" if name.endswith("npy") else None)
    assert np.allclose(back.heights, surface.heights, rtol=0, atol=1e-15)
    assert back.pitch == pytest.approx(surface.pitch, rel=1e-6)
    assert asp.channels(path)


def test_copies_pickles_and_equality() -> None:
    for one in (rough(1), asp.Surface(HEIGHTS, 1e-6).level("plane"), asp.Material(210e9, 0.3, np.ones((2, 2)) * 1e9),
                asp.Body(rough(1), asp.Material("70 GPa", 0.3), "as-is"), asp.Coating("2 um", "300 GPa", 0.2)):  # fmt: skip
        assert pickle.loads(pickle.dumps(one)) == one == copy.deepcopy(one) == copy.copy(one)
    assert rough(1) != rough(2)
    assert asp.Material(210e9, 0.3) != asp.Material(210e9, 0.31)
    assert asp.Material(210e9, 0.3) != "steel"


def test_generated_heights_are_those_of_the_seed() -> None:
    assert rough(1) == rough(1)
    spread = asp.generate.self_affine((64, 64), "1 um", hurst=0.8, sq="100 nm", shortest="8 um", seed=5)
    assert spread.heights.std() == pytest.approx(100e-9, rel=1e-9)
    skewed = asp.generate.autocorrelation((64, 64), "1 um", sq="100 nm", correlation_length="4 um", ssk=-1, sku=5, seed=2)
    z = skewed.heights - skewed.heights.mean()
    assert (z**3).mean() / z.std() ** 3 < -0.5


@pytest.mark.parametrize(
    ("make", "told"),
    [
        (lambda: asp.Surface(np.zeros((0, 0)), 1e-6), "'heights' has 0 × 0 cells"),
        (lambda: asp.Surface(np.zeros(4), 1e-6), "'heights' has 1 dimensions, expected a matrix"),
        (lambda: asp.Surface([[0.0, np.inf]], 1e-6), "'heights' holds an infinite number"),
        (lambda: asp.Surface([["a"]], 1e-6), "'heights' is of type"),
        (lambda: asp.Surface([[1j]], 1e-6), "'heights' is of type complex"),
        (lambda: asp.Surface([[1.0], [1.0, 2.0]], 1e-6), "'heights' is no matrix"),
        (lambda: asp.Surface([[0.0]]), "'pitch' is missing"),
        (lambda: asp.Surface([[0.0]], -1e-6), "'pitch' is -1e-06, expected a length above 0"),
        (lambda: asp.Surface([[0.0]], "1 GPa"), "'pitch'"),
        (lambda: asp.Surface([[0.0]], "1"), "'pitch'"),
        (lambda: asp.Surface([[0.0]], (1e-6, 1e-6, 1e-6)), "'pitch' has 3 values"),
        (lambda: rough(1).level("plan"), "'level' is \"plan\""),
        (lambda: rough(1).window(30, 0, 8, 8).heights, "window"),
        (lambda: asp.generate.low_pass((8, 8), 1e-6, sq=-1e-9, cutoff=4e-6), "'sq' is -"),
        (lambda: asp.generate.low_pass((8, 0), 1e-6, sq=1e-9, cutoff=4e-6), "'shape'"),
        (lambda: asp.form.sphere("1 mm").heights, "missing key 'shape'"),
        (lambda: asp.form.cone("90 deg"), "'angle'"),
    ],
)
def test_bad_input_is_named(make, told: str) -> None:
    with pytest.raises(ValueError) as caught:
        make()
    assert told in str(caught.value)
    assert isinstance(caught.value, errors.AsperityError)


def test_one_cell_is_a_surface() -> None:
    assert asp.Surface([[1e-9]], 1e-6).shape == (1, 1)


def test_text_and_arrays_have_their_order_of_lines(tmp_path: pathlib.Path) -> None:
    heights = np.random.default_rng(1).normal(size=(7, 5))
    np.savetxt(tmp_path / "z.txt", heights.T)
    np.save(tmp_path / "z.npy", heights)
    np.savez(tmp_path / "z.npz", first=heights, second=-heights)
    options: dict[str, str] = {"pitch": "1 um", "unit": "um"}
    for name in ("z.txt", "z.npy"):
        assert np.allclose(asp.read(tmp_path / name, **options).heights, heights * 1e-6)
    turned = asp.read(tmp_path / "z.txt", lines="y", **options)
    assert np.allclose(turned.heights, heights.T * 1e-6)
    second = asp.read(tmp_path / "z.npz", channel="second", lines="x", **options)
    assert np.allclose(second.heights, -heights.T * 1e-6)
    (tmp_path / "sizes.txt").write_text("a disc\n3 2\n1 2 3\n4 5 7\n")
    with pytest.raises(errors.CaseError, match="the matrix begins at line 3") as caught:
        asp.read(tmp_path / "sizes.txt", pitch="1 um")
    assert "`skip = 2`" in caught.value.__notes__[0]
    assert asp.read(tmp_path / "sizes.txt", pitch="1 um", skip=2).shape == (3, 2)
    with pytest.raises(errors.CaseError, match="determines the order"):
        turned.write(tmp_path / "z.x3p")
        asp.read(tmp_path / "z.x3p", lines="y")


def test_files_that_are_none(tmp_path: pathlib.Path) -> None:
    with pytest.raises(FileNotFoundError):
        asp.read(tmp_path / "nowhere.x3p")
    path = tmp_path / "a.x3p"
    path.write_bytes(b"\0\1\2 not a topography" * 20)
    with pytest.raises(errors.CaseError, match="not a topography"):
        asp.read(path)
    with pytest.raises(errors.NoFormat):
        rough(1).write(tmp_path / "a.xyz")
    with pytest.raises(OSError):
        rough(1).write(tmp_path / "no" / "folder" / "a.npy")


def test_the_usual_parameters_are_properties() -> None:
    surface = rough(1)
    p = surface.parameters()
    assert (surface.sa, surface.sq, surface.sz, surface.sdq) == (p.Sa, p.Sq, p.Sz, p.Sdq)
    assert surface.parameters() is p and surface.sq == pytest.approx(50e-9)
