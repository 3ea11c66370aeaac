"""Arguments of other types than the usual ones: scalars of NumPy, bytes, numbers of threads."""

from __future__ import annotations

import os
import pathlib
from typing import Any

import asperity as asp
import numpy as np
import pytest
from asperity import errors

from conftest import rough


@pytest.mark.parametrize("scalar", [np.array, np.float64, np.float32, lambda x: np.ma.masked_array(x), float])
def test_a_number_is_a_number_whatever_holds_it(scalar: Any, steel: asp.Material) -> None:
    ball, plane = asp.form.sphere(scalar(1e-4)), asp.form.flat((16, 16), scalar(1e-6))
    found = asp.contact(plane, ball, steel, steel, load=scalar(0.01), tolerance=scalar(1e-6), progress=False)
    assert found.load == pytest.approx(0.01, rel=1e-6)
    material = asp.Material(young=scalar(210e9), poisson=scalar(0.3), hardness=scalar(4e9))
    assert material.young == pytest.approx(210e9)
    assert asp.Surface(np.zeros((4, 4)), pitch=scalar(1e-6)).pitch == pytest.approx((1e-6, 1e-6))


def test_a_whole_number_is_one_whatever_holds_it(steel: asp.Material) -> None:
    for whole in (np.array(2), np.int32(2), 2):
        run = asp.simulate(rough(1), rough(2), steel, steel, load="20 mN", passes=whole, stride=np.array(8), threads=whole,
                           progress=False)  # fmt: skip
        assert len(run.passes) == 2
    for wrong in (np.array(2.5), np.array([2]), 2.5, "2"):
        with pytest.raises((errors.CaseError, TypeError)):
            asp.simulate(rough(1), rough(2), steel, steel, load="20 mN", passes=wrong, progress=False)


@pytest.mark.parametrize("count", [0, -1, 1025, 10**9, 2.0, "2", True])
def test_threads_have_a_bound(count: Any, steel: asp.Material, tmp_path: pathlib.Path) -> None:
    expected = "expected a whole number from 1 to 1024"
    calls = [
        lambda: asp.contact(rough(1), rough(2), steel, steel, load="1 mN", threads=count),
        lambda: asp.simulate(rough(1), rough(2), steel, steel, load="1 mN", threads=count),
        lambda: asp.stress(np.ones((4, 4)), pitch=1e-6, poisson=0.3, depths=[0.0], threads=count),
        lambda: asp.run("case.toml", out=tmp_path, threads=count),
        lambda: asp.verify(threads=count),
    ]
    for call in calls:
        with pytest.raises(errors.CaseError, match=expected):
            call()


@pytest.mark.parametrize("wrong", [b"disc.npy", bytearray(b"disc.npy"), 3, None, ["disc.npy"]])
def test_a_path_is_a_text_or_a_path(wrong: Any, steel: asp.Material, tmp_path: pathlib.Path) -> None:
    kind = type(wrong).__name__
    calls = [
        (lambda: asp.read(wrong), "path"),
        (lambda: asp.channels(wrong), "path"),
        (lambda: rough(1).write(wrong), "path"),
        (lambda: asp.open(wrong), "directory"),
        (lambda: asp.Study(wrong), "file"),
        (lambda: asp.run(wrong, out=tmp_path), "case"),
    ]
    if wrong is not None:
        calls.append((lambda: asp.contact(rough(1), rough(2), steel, steel, load="1 mN", out=wrong), "out"))
    for call, key in calls:
        with pytest.raises(TypeError, match=f"'{key}' is of type {kind}, expected a text or a path"):
            call()


def test_a_path_may_be_of_any_kind(tmp_path: pathlib.Path) -> None:
    class Named(os.PathLike[str]):
        def __fspath__(self) -> str:
            return str(tmp_path / "disc.npy")

    rough(1).write(Named())
    assert asp.read(Named(), pitch="1 um") == asp.read(str(Named().__fspath__()), pitch="1 um")


def test_surfaces_without_a_grid_can_be_compared() -> None:
    assert asp.form.flat() == asp.form.flat()
    assert asp.form.flat() != asp.form.flat((8, 8), 1e-6)
    assert asp.form.sphere("1 mm") == asp.form.sphere("1 mm") != asp.form.sphere("2 mm")
    assert asp.form.flat((8, 8)) == asp.form.flat((8, 8))
    assert asp.form.flat((8, 8), 1e-6) == asp.Surface(np.zeros((8, 8)), 1e-6)
    low = asp.generate.low_pass(sq=1e-8, cutoff=np.array([4e-6, 8e-6]))
    assert low == asp.generate.low_pass(sq=1e-8, cutoff=np.array([4e-6, 8e-6]))


def test_no_magnitude_is_written_with_hundreds_of_digits() -> None:
    surface = asp.Surface(1e300 * np.add.outer(np.arange(4.0), np.zeros(4)), pitch=1e-6)
    assert len(surface._repr_html_()) < 20_000
    assert all(len(row.text) < 40 for row in surface.parameters().values())
