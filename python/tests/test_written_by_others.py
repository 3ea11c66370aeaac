"""Topographies that other programs write: heights, holes, pitch and orientation are read back.

Without the programs (``pip install sdfio surfalize SurfaceTopography``) each test says what it passed over.
"""

from __future__ import annotations

import warnings
from pathlib import Path

import numpy as np
import pytest

import asperity as asp

#: Heights in µm, a row for each y, the first at y = 0; one is missing.
LINES = np.array(
    [
        [-1.232, 0.267, -0.007, 0.502, -1.327],
        [1.108, 0.094, np.nan, -1.358, -1.307],
        [-0.718, 1.186, 0.895, -0.544, -0.547],
    ]
)
WHOLE = np.where(np.isnan(LINES), 0.25, LINES)
PITCH = (2e-6, 3e-6)


def read(path: Path, lines: np.ndarray, tolerance: float = 1e-9, **options: object) -> asp.Surface:
    """Compares what is read with the lines, up to a constant height, and returns it."""
    surface = asp.read(path, **options)
    heights = surface.heights.T * 1e6
    assert heights.shape == lines.shape
    np.testing.assert_array_equal(np.isnan(heights), np.isnan(lines))
    difference = heights - lines
    assert np.nanmax(difference) - np.nanmin(difference) < tolerance, difference
    return surface


def has_pitch(surface: asp.Surface, pitch: tuple[float, float] = PITCH) -> None:
    assert surface.pitch == pytest.approx(pitch, rel=1e-6)


TYPES = {
    "ISO-1.0": ["INT16", "INT32", "BINARY64"],
    "ISO-2.0": ["INT8", "INT16", "INT32", "BINARY32", "BINARY64"],
    "BCR-1.0": ["UINT8", "UINT16", "UINT32", "INT8", "INT16", "INT32", "BINARY32", "BINARY64"],
}


@pytest.mark.parametrize("encoding", ["ASCII", "BINARY"])
@pytest.mark.parametrize(("revision", "kind"), [(r, kind) for r, kinds in TYPES.items() for kind in kinds])
@pytest.mark.parametrize("lines", [LINES, WHOLE], ids=["hole", "whole"])
def test_sdf_of_sdfio(tmp_path: Path, encoding: str, revision: str, kind: str, lines: np.ndarray) -> None:
    sdfio = pytest.importorskip("sdfio", reason="sdfio is not installed: its files are passed over")
    if kind.startswith("U"):
        lines = lines - np.nanmin(lines)
    metadata = sdfio.Metadata(revision=sdfio.Revision(revision), data_type=sdfio.DataType[kind])
    path = tmp_path / "a.sdf"
    sdfio.write(
        path, lines * 1e-6, x_scale=PITCH[0], y_scale=PITCH[1], format=sdfio.FileFormat[encoding], metadata=metadata
    )
    coarse = {"INT8": 0.03, "UINT8": 0.03, "INT16": 1e-4, "UINT16": 1e-4, "BINARY32": 2e-6}
    has_pitch(read(path, lines, coarse.get(kind, 1e-8)))


@pytest.mark.parametrize("format", ["sdf", "sdf in text", "sur", "al3d", "x3p", "tmd"])
def test_files_of_surfalize(tmp_path: Path, format: str) -> None:
    surfalize = pytest.importorskip("surfalize", reason="surfalize is not installed: its files are passed over")
    # surfalize writes al3d without the padding of its lines to 8 bytes, so that an even number of samples is needed.
    lines = np.hstack([LINES, [[0.1], [0.2], [0.3]]]) if format == "al3d" else LINES
    # Its writer of tmd has no missing heights.
    lines = WHOLE if format == "tmd" else lines
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        surface = surfalize.Surface(lines, PITCH[0] * 1e6, PITCH[1] * 1e6)
        path = tmp_path / f"a.{format.split()[0]}"
        surface.save(path, **({"binary": False} if format == "sdf in text" else {}))
    if format == "tmd":
        # surfalize writes tmd in µm; the format is in mm, in which Gwyddion and we read it.
        found = asp.read(path)
        np.testing.assert_allclose(found.heights.T * 1e3, lines, atol=1e-6)
        has_pitch(found, (2e-3, 3e-3))
    else:
        has_pitch(read(path, lines, 1e-4))


def topography() -> object:
    module = pytest.importorskip(
        "SurfaceTopography", reason="SurfaceTopography is not installed: its files are passed over"
    )
    return module.Topography(WHOLE.T * 1e-6, (10e-6, 9e-6), unit="m")


@pytest.mark.parametrize("format", ["netcdf", "x3p", "gwy"])
def test_files_of_surface_topography(tmp_path: Path, format: str) -> None:
    path = tmp_path / "a"
    getattr(topography(), f"to_{format}")(str(path))
    has_pitch(read(path, WHOLE, 1e-6))


def test_a_matrix_of_surface_topography_has_lines_along_x(tmp_path: Path) -> None:
    path = tmp_path / "a.txt"
    topography().to_matrix(str(path))
    read(path, WHOLE, 1e-6, pitch=PITCH)
