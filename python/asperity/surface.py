"""Surfaces: the heights of one body, and the steps that prepare them for a contact."""

from __future__ import annotations

import copy
import os
from collections.abc import Sequence
from typing import TYPE_CHECKING, Any, Literal

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from ._same import Comparable
from ._units import Pair, Quantity, choice, lengths, quantity, whole
from ._units import path as paths
from .describe import (
    LAGS,
    WOLF_PRUNING,
    Axis,
    BearingCurve,
    Correlation,
    Distribution,
    Parameters,
    Profile,
    Segmentation,
    SelfAffinity,
    SpectralMoments,
    Spectrum,
    Summits,
    Window,
    ascending,
    law,
    share_of_sz,
)
from ._raise import bad_input, exception
from .errors import AsperityError
from .fields import Field, on_cells

if TYPE_CHECKING:
    from matplotlib.axes import Axes
    from xarray import DataArray

_STEPS = (
    "window", "despike", "fill", "level", "mirror", "rotate", "s_filter", "l_filter", "filter", "resample", "interpolate",
    "taper", "plus",
)  # fmt: skip
"""Steps of a preparation in the order of their action."""

_MADE = ("generate", "form")

Filter = Literal["gaussian", "robust"]
"""Kind of an S-filter or an L-filter."""


class Surface(Comparable):
    """The heights of one body on a regular grid, with its material below them.

    Index 0 of `heights` runs along x, the direction of motion, and index 1 along y. The methods do not change a surface; they
    return a new one.

    Parameters
    ----------
    heights : array_like
        A matrix ``[ix, iy]`` of heights, in metres without a `unit`. Missing heights are masked or NaN. The matrix is copied. An
        xarray DataArray provides its pitch by its coordinates. A topography of the package SurfaceTopography provides its pitch
        and its unit.
    pitch : float, str or pair of them
        Size of a cell along x and y, above 0, m.
    unit : str or float, optional
        Unit of the heights, for example ``"um"``.

    Raises
    ------
    asperity.errors.CaseError
        If the heights are no matrix of real numbers, or the pitch is missing or wrong.

    Notes
    -----
    The steps of the preparation (:meth:`window` to :meth:`taper`, :meth:`plus`) act in the order of the case file, whatever the order
    of the calls: part to keep, spikes, holes, form, direction, waves, grid, rim. If a step is called a second time, the
    preparation starts again from the heights of all steps so far.

    Examples
    --------
    >>> import numpy as np, asperity as asp
    >>> surface = asp.Surface(1e-9 * np.add.outer(np.arange(4.0), np.arange(3.0)), pitch="1 um")
    >>> surface.shape, surface.pitch
    ((4, 3), (1e-06, 1e-06))
    >>> bool(abs(surface.level("plane").heights).max() < 1e-24)
    True
    """

    def __init__(self, heights: ArrayLike | Any, pitch: Pair | None = None, *, unit: Quantity | None = None) -> None:
        array, told, scale = _heights(heights)
        if unit is not None:
            if scale is not None:
                raise bad_input("unit", "'unit' is given, but the heights have a unit of their own")
            scale = _unit(unit)
        if scale not in (None, 1.0):
            array *= scale
        if pitch is None and told is None:
            raise bad_input("pitch", "'pitch' is missing: how far apart are the heights?", "for example pitch=\"0.5 um\"")
        _check(array)
        self._table: dict[str, Any] = {"given": "heights"}
        array.flags.writeable = False
        self._given: NDArray[np.float64] | None = array
        self._given_pitch = lengths("pitch", pitch) if pitch is not None else told
        self._made: dict[str, Any] | None = None

    @classmethod
    def _of(cls, table: dict[str, Any], given: Surface | None = None) -> Surface:
        """Makes the surface of a table `[topography]` of a case."""
        _core.check_surface(table)
        surface = cls.__new__(cls)
        # The caller may change lists in its table later.
        surface._table = copy.deepcopy(table)
        surface._given = None if given is None else given._given
        surface._given_pitch = None if given is None else given._given_pitch
        surface._made = None
        return surface

    @classmethod
    def _made_as(cls, how: str, kind: str, arguments: dict[str, Any]) -> Surface:
        """Makes the surface of a form or a generator with the `arguments` that are not `None`."""
        return cls._of({how: kind, **{key: value for key, value in arguments.items() if value is not None}})

    def _with(self, **steps: Any) -> Surface:
        """Makes the same surface with further steps."""
        steps = {key: value for key, value in steps.items() if value is not None}
        if any(key in self._table for key in steps):
            return Surface(self.heights, self.pitch)._with(**steps)
        return Surface._of({**self._table, **steps}, self)

    def _handed(self) -> tuple[NDArray[np.float64], tuple[float, float]] | None:
        """The heights to which the table refers by `given`."""
        if self._given is None:
            return None
        assert self._given_pitch is not None
        return self._given, self._given_pitch

    def _all(self) -> dict[str, Any]:
        if self._made is None:
            if self._given is not None and len(self._table) == 1:
                heights = self._given.view()
                missing = int(np.count_nonzero(np.isnan(heights)))
                made: dict[str, Any] = {"heights": heights, "pitch": self._given_pitch, "undefined": missing}
                made |= {"spikes": 0, "radius": None, "underside": False}
            else:
                made = _core.surface(self._table, self._handed())
            heights = made["heights"]
            heights.flags.writeable = False
            # A view of a read-only array cannot be made writeable again.
            made["heights"] = heights.view()
            self._made = made
        return self._made

    def _compared(self) -> dict[str, Any]:
        if any(key in self._table for key in _MADE) and not {"shape", "pitch"} <= self._table.keys():
            # It has no heights without the grid of the other body.
            return {"table": self._table}
        return {"heights": self.heights, "pitch": self.pitch}

    def __getstate__(self) -> dict[str, Any]:
        return {**self.__dict__, "_made": None}

    def __array__(self, dtype: Any = None, copy: bool | None = None) -> NDArray[Any]:
        if copy is False and dtype not in (None, np.float64):
            raise ValueError("heights are float64: another type is a copy")
        return np.array(self.heights, dtype=dtype) if copy or dtype else self.heights

    def __repr__(self) -> str:
        key, value = next(iter(self._table.items()))
        source = "" if key == "given" else f"from {os.path.basename(value)}" if key == "file" else f"{key} {value!r}"
        parts = [source, *(step for step in self._table if step in _STEPS)]
        try:
            nx, ny, missing = *self.shape, self.undefined
            size = " × ".join(dict.fromkeys(_core.format(step, "length") for step in self.pitch))
            # Heights of 1e300 have no square.
            with np.errstate(over="ignore", invalid="ignore"):
                sq = "" if missing == nx * ny else f", Sq {_core.format(float(np.nanstd(self.heights)), 'length')}"
            holes = f", {missing} missing" if missing else ""
            parts.insert(0, f"{nx} × {ny} cells of {size}{sq}{holes}")
        except AsperityError:
            parts.append("on the grid of the other body")
        return f"<Surface: {', '.join(part for part in parts if part)}>"

    def _repr_html_(self) -> str:
        from . import _html

        try:
            return _html.surface(self.heights, self.pitch)
        except AsperityError:
            # A surface without a shape takes it from the other body.
            return _html.code(repr(self))

    @property
    def heights(self) -> NDArray[np.float64]:
        """Heights, m, ``[ix, iy]``; NaN if missing. The array is read-only: copy it to change it."""
        heights: NDArray[np.float64] = self._all()["heights"]
        return heights

    @property
    def pitch(self) -> tuple[float, float]:
        """Size of a cell along x and y, m."""
        x, y = self._all()["pitch"]
        return float(x), float(y)

    @property
    def shape(self) -> tuple[int, int]:
        """Number of cells along x and y."""
        nx, ny = self.heights.shape
        return nx, ny

    @property
    def extent(self) -> tuple[float, float]:
        """Length along x and y, m."""
        return self.shape[0] * self.pitch[0], self.shape[1] * self.pitch[1]

    @property
    def undefined(self) -> int:
        """Number of missing samples."""
        return int(np.count_nonzero(np.isnan(self.heights)))

    @property
    def filled(self) -> int:
        """Number of samples that were missing or removed as spikes before they were filled."""
        return int(self._all()["undefined"]) + int(self._all()["spikes"])

    @property
    def spikes(self) -> int:
        """Number of samples that :meth:`despike` removed."""
        return int(self._all()["spikes"])

    @property
    def radius(self) -> float | None:
        """Radius of the sphere or cylinder that :meth:`level` subtracted, m, else `None`; negative for a hollow one."""
        radius = self._all()["radius"]
        return None if radius is None else float(radius)

    @property
    def is_underside(self) -> bool:
        """Whether the heights are the underside of an upper body, as in results."""
        return bool(self._all()["underside"])

    # ---- steps of the preparation, in the order of their action

    def window(self, x0: int, y0: int, nx: int, ny: int) -> Surface:
        """Keep `nx` × `ny` samples, the first of them ``[x0, y0]``."""
        return self._with(window=[x0, y0, nx, ny])

    def despike(self, factor: float = 6.0) -> Surface:
        """Remove samples that differ from their neighbourhood by more than `factor` times its scatter."""
        return self._with(despike=factor)

    def fill(self, fill: Literal["harmonic", "nearest"] = "harmonic") -> Surface:
        """Fill missing samples by a membrane over each hole, or with the nearest sample."""
        return self._with(fill=fill)

    def level(self, level: str = "plane") -> Surface:
        """Subtract a form: ``"mean"``, ``"plane"``, ``"polynomial-N"``, ``"sphere"``, ``"cylinder"``, ``"none"``."""
        return self._with(level=level)

    def mirror(self, mirror: Literal["x", "y"]) -> Surface:
        """Mirror along an axis."""
        return self._with(mirror=mirror)

    def rotate(self, rotate: Quantity) -> Surface:
        """Rotate by an angle from x towards y, rad or a text such as ``"30 deg"``."""
        return self._with(rotate=rotate)

    def s_filter(self, nesting_index: Quantity, filter: Filter | None = None) -> Surface:
        """Remove waves shorter than `nesting_index`, m, with a Gaussian or a robust `filter`."""
        return self._with(s_filter=nesting_index, filter=filter)

    def l_filter(self, nesting_index: Quantity, filter: Filter | None = None) -> Surface:
        """Remove waves longer than `nesting_index`, m, with a Gaussian or a robust `filter`."""
        return self._with(l_filter=nesting_index, filter=filter)

    def resample(
        self,
        shape: Sequence[int] | None = None,
        *,
        pitch: Pair | None = None,
        interpolate: Literal["linear", "spline"] | None = None,
    ) -> Surface:
        """Resample to another number of cells on the same extent, or to another `pitch`, m."""
        if (shape is None) == (pitch is None):
            raise bad_input("resample", "give resample() a shape or a pitch, one of them")
        if shape is not None:
            return self._with(resample=list(shape), interpolate=interpolate)
        base = Surface(self.heights, self.pitch)
        return base._with(pitch=list(lengths("pitch", pitch if pitch is not None else 0.0)), interpolate=interpolate)

    def taper(self, width: Quantity) -> Surface:
        """Fade the heights to their mean over a rim of this width, m, so that the surface can be repeated."""
        return self._with(taper=width)

    def plus(self, other: Surface) -> Surface:
        """Add the heights of another surface on the same grid, or of a form or generator without a shape."""
        key = next((key for key in _MADE if key in other._table), None)
        if key is not None and "shape" not in other._table and not any(step in other._table for step in _STEPS):
            layer = {name: value for name, value in other._table.items() if name != "pitch"}
            layers = [*self._table.get("plus", []), layer]
            return Surface._of({**self._table, "plus": layers}, self)
        if self.shape != other.shape or not np.allclose(self.pitch, other.pitch, rtol=1e-9, atol=0.0):
            message = (
                f"the surfaces have different grids: {_grid(self)} and {_grid(other)}; expected the same shape and pitch"
            )
            raise bad_input("plus", message)
        return Surface(self.heights + other.heights, self.pitch)

    def __add__(self, other: Surface) -> Surface:
        return self.plus(other) if isinstance(other, Surface) else NotImplemented

    # ---- description

    @property
    def _grid(self) -> tuple[NDArray[np.float64], tuple[float, float]]:
        return self.heights, self.pitch

    def parameters(self) -> Parameters:
        """Return all parameters of ISO 25178: height, spatial, hybrid, functional and feature parameters.

        ``.Sq`` is a value, SI. The parameters are computed once.
        """
        made = self._all()
        if "parameters" not in made:
            made["parameters"] = Parameters(_core.parameters(self._grid))
        found: Parameters = made["parameters"]
        return found

    @property
    def sa(self) -> float:
        """Arithmetical mean height Sa, m, one of :meth:`parameters`."""
        return self.parameters().Sa

    @property
    def sq(self) -> float:
        """Root mean square height Sq, m, one of :meth:`parameters`."""
        return self.parameters().Sq

    @property
    def sz(self) -> float:
        """Maximum height Sz, from the deepest pit to the highest peak, m, one of :meth:`parameters`."""
        return self.parameters().Sz

    @property
    def sdq(self) -> float:
        """Root mean square gradient Sdq, one of :meth:`parameters`."""
        return self.parameters().Sdq

    def feature_parameters(self, pruning: float = WOLF_PRUNING) -> Parameters:
        """Return the feature parameters of ISO 25178, with hills and dales pruned at this share of Sz, 0 to 1."""
        return Parameters(_core.feature_parameters(self._grid, share_of_sz(pruning)))

    def profile(self, axis: Axis = "x", index: int = 0) -> Profile:
        """Return the profile along an axis at the sample `index` of the other axis."""
        return Profile(*_core.profile(self._grid, axis, whole("index", index, 0)))

    def profile_parameters(self, axis: Axis, cutoff: Quantity) -> Parameters:
        """Return the mean ISO 21920 parameters of the roughness profiles along an axis; `cutoff` is λc, m."""
        return Parameters(_core.profile_parameters(self._grid, axis, quantity("cutoff", cutoff, "length")))

    def bearing_curve(self) -> BearingCurve:
        """Return the areal material ratio curve of the defined samples."""
        return BearingCurve(self.heights)

    def height_distribution(self, classes: int | None = None) -> Distribution:
        """Return the probability density of the heights about their mean.

        Without a number of `classes` the rule of Freedman and Diaconis is used.
        """
        return self._distribution(None, classes)

    def slope_distribution(
        self, slope: Literal["x", "y", "magnitude"] = "magnitude", classes: int | None = None
    ) -> Distribution:
        """Return the probability density of the slope along an axis, or of its magnitude."""
        return self._distribution(slope, classes)

    def _distribution(self, slope: str | None, classes: int | None) -> Distribution:
        count = None if classes is None else whole("classes", classes, 1)
        return Distribution(*_core.distribution(self._grid, slope, count))

    def spectrum(self, window: Window = "hann") -> Spectrum:
        """Return the power spectral density. A periodic surface needs ``window="none"``."""
        return Spectrum(self._grid, window)

    def autocorrelation(self, *, periodic: bool = False) -> Correlation:
        """Return the autocorrelation of a surface that ends at its rim, or is `periodic`."""
        return Correlation(self._grid, periodic)

    def moments(self, by: Literal["spectrum", "differences"] = "spectrum", window: Window = "hann") -> SpectralMoments:
        """Return the spectral moments from the spectrum, or from differences, which attenuate short waves."""
        choice("by", by, "spectrum", "differences")
        if by == "differences":
            return SpectralMoments(_core.moments_by_differences(self._grid))
        return self.spectrum(window).moments()

    def summits(self) -> Summits:
        """Return the summits, and the Greenwood–Williamson asperities derived from them."""
        return Summits(_core.summits(self._grid))

    def self_affinity(
        self,
        wave_numbers: tuple[float, float] | None = None,
        *,
        lags: tuple[float, float] | None = None,
        axis: Axis = "x",
        window: Window = "hann",
    ) -> SelfAffinity:
        """Return the self-affine law of the surface: Hurst exponent, its error and range.

        The law is fitted to the spectrum over a range of `wave_numbers`, rad/m, by default the longest range that follows a law. If
        `lags`, m, are given, it is fitted to the mean square height differences along `axis`. The spectrum is more reliable.
        """
        if lags is None:
            return self.spectrum(window).self_affinity(wave_numbers)
        if wave_numbers is not None:
            raise bad_input("lags", "'lags' and 'wave_numbers' are both given, expected one of them")
        return law(_core.self_affinity_of_differences(self._grid, axis, ascending("lags", lags)))

    def height_differences(self, axis: Axis = "x") -> NDArray[np.void]:
        """Return the mean square height differences along an axis: records of `lag`, m, and `value`, m²."""
        return np.array(_core.height_differences(self._grid, axis), dtype=LAGS)

    def hills(self, pruning: float = WOLF_PRUNING) -> Segmentation:
        """Return the hills that rise at least `pruning` times Sz, 0 to 1, above their saddles."""
        return Segmentation(_core.segments(self._grid, False, share_of_sz(pruning)))

    def dales(self, pruning: float = WOLF_PRUNING) -> Segmentation:
        """Return the dales that lie at least `pruning` times Sz, 0 to 1, below their saddles."""
        return Segmentation(_core.segments(self._grid, True, share_of_sz(pruning)))

    # ---- output

    def write(self, path: str | os.PathLike[str]) -> None:
        """Write the heights to a file. Its extension selects the format: npy, x3p, sdf, gwy or vtk.

        Raises
        ------
        asperity.errors.NoFormat
            If the extension belongs to no format.
        asperity.errors.File
            If the file cannot be written.
        """
        _core.write_surface(paths("path", path), (self.heights, self.pitch))

    def to_xarray(self) -> DataArray:
        """Return the heights as an xarray DataArray, with the centres of the cells as coordinates, m."""
        return self._field.to_xarray()

    def plot(self, *, ax: Axes | None = None, **options: Any) -> Axes:
        """Draw a map of the heights with matplotlib.

        Parameters
        ----------
        ax : matplotlib.axes.Axes, optional
            Axes to draw on; new ones by default.
        **options
            Passed on to ``Axes.imshow``.
        """
        return self._field.plot(ax=ax, **options)

    @property
    def _field(self) -> Field:
        return on_cells("heights", self.heights, "m", self.pitch)


def read(
    path: str | os.PathLike[str],
    *,
    channel: str | None = None,
    unit: Quantity | None = None,
    pitch: Pair | None = None,
    lines: Literal["x", "y"] | None = None,
    skip: int = 0,
) -> Surface:
    """Read a topography. The format, one of more than thirty, is detected from the content of the file.

    Parameters
    ----------
    path : str or path
        The file.
    channel : str, optional
        The channel to read, see :func:`channels`; by default the first height channel.
    unit : str or float, optional
        Unit of the heights in a file without units, for example ``"um"``.
    pitch : float, str or pair, optional
        Size of a cell along x and y, m. A file with a pitch is resampled to this one.
    lines : {"x", "y"}, optional
        Direction of a line of a matrix. By default it is x for text, and y for npy, npz, mat and HDF5, which are indexed
        ``[ix, iy]``. Other formats determine it. Text that looks like points is a matrix if this is given.
    skip : int
        Number of lines above the numbers of a text.

    Returns
    -------
    Surface
        The heights in metres; missing ones are NaN.

    Raises
    ------
    asperity.errors.MissingFile, asperity.errors.CaseError
        If the file does not exist, or contains no such topography.
    """
    path = paths("path", path)
    if not os.path.exists(path):
        raise exception("File", f"{path}: no such file", {"path": path, "errno": 2}, None)
    table: dict[str, Any] = {"file": path, "channel": channel, "unit": unit, "lines": lines, "skip": skip or None}
    if pitch is not None:
        table["pitch"] = list(lengths("pitch", pitch))
    surface = Surface._of({key: value for key, value in table.items() if value is not None})
    surface._all()
    return surface


def channels(path: str | os.PathLike[str]) -> list[str]:
    """Return the names of the height channels of a file, the default one first."""
    return _core.channels(paths("path", path))


def _grid(surface: Surface) -> str:
    (nx, ny), (dx, dy) = surface.shape, surface.pitch
    return f"{nx} × {ny} cells of {_core.format(dx, 'length')} × {_core.format(dy, 'length')}"


def _unit(unit: Quantity) -> float:
    text = f"1 {unit}" if isinstance(unit, str) and unit[:1].isalpha() else unit
    return quantity("unit", text, "length")


def _heights(heights: Any) -> tuple[NDArray[np.float64], tuple[float, float] | None, float | None]:
    """Returns heights as a matrix, and their pitch and the unit of their numbers in metres if they have them."""
    if isinstance(heights, Surface):
        return heights.heights.copy(), heights.pitch, 1.0
    if hasattr(heights, "physical_sizes") and callable(getattr(heights, "heights", None)):
        return _of_topography(heights)
    told = scale = None
    if hasattr(heights, "coords") and hasattr(heights, "dims"):
        told = _pitch_of_coordinates(heights)
        unit = heights.attrs.get("units", heights.attrs.get("unit"))
        scale = _unit(unit) if isinstance(unit, str) else None
        heights = heights.data
    if np.ma.isMaskedArray(heights):
        heights = np.ma.asarray(heights, dtype=np.float64).filled(np.nan)
    try:
        # A copy: the caller may change the heights later.
        found = np.array(heights)
    except (TypeError, ValueError) as error:
        raise bad_input("heights", f"'heights' is no matrix of numbers: {error}") from error
    if found.dtype.kind not in "fiub":
        raise bad_input("heights", f"'heights' is of type {found.dtype}, expected real numbers")
    return np.asarray(found, dtype=np.float64), told, scale


def _of_topography(topography: Any) -> tuple[NDArray[np.float64], tuple[float, float], float]:
    """Returns heights, pitch and unit of a topography of the package SurfaceTopography."""
    found = topography.heights()
    array = np.array(np.ma.asarray(found, dtype=np.float64).filled(np.nan))
    if array.ndim != 2:
        raise bad_input("heights", f"the topography has {array.ndim} dimensions, expected 2")
    unit = getattr(topography, "unit", None)
    scale = 1.0 if unit is None else _unit(unit)
    sizes = topography.physical_sizes
    return array, (scale * sizes[0] / array.shape[0], scale * sizes[1] / array.shape[1]), scale


def _pitch_of_coordinates(array: Any) -> tuple[float, float] | None:
    """Returns the pitch of a DataArray with two dimensions, from its coordinates."""
    if len(array.dims) != 2 or any(name not in array.coords for name in array.dims):
        return None
    pitches = []
    for name in array.dims:
        coordinate = array.coords[name]
        values = np.asarray(coordinate.values, dtype=np.float64)
        steps = np.diff(values)
        if len(steps) == 0 or not np.allclose(steps, steps[0], rtol=1e-6, atol=0.0) or steps[0] <= 0.0:
            raise bad_input("heights", f"the coordinates '{name}' are not evenly spaced and ascending")
        unit = coordinate.attrs.get("units", coordinate.attrs.get("unit"))
        scale = _unit(unit) if isinstance(unit, str) else 1.0
        pitches.append(scale * float(values[-1] - values[0]) / (len(values) - 1))
    return pitches[0], pitches[1]


def _check(array: NDArray[np.float64]) -> None:
    if array.ndim != 2:
        raise bad_input("heights", f"'heights' has {array.ndim} dimensions, expected a matrix [ix, iy]")
    if 0 in array.shape:
        shape = " × ".join(map(str, array.shape))
        raise bad_input("heights", f"'heights' has {shape} cells, expected at least 1 × 1")
    if np.isinf(array).any():
        raise bad_input("heights", "'heights' holds an infinite number, expected lengths, or NaN where they are missing")
