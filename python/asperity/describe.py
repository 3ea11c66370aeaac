"""Description of surfaces: the answers of the methods of :class:`asperity.Surface`.

Level and filter a surface first: nothing here does so. Numbers are in SI, heights are measured from their mean, and undefined
samples are left out.
"""

from __future__ import annotations

import html
from collections.abc import Iterator, Mapping
from functools import cached_property
from typing import Annotated, Any, Literal, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from . import _core
from ._described import described
from ._points import Point, spread
from ._raise import bad_input
from ._same import Cached, Comparable, same
from ._units import Quantity, number, quantity, whole

__all__ = [
    "Axis",
    "BearingCurve",
    "Core",
    "Correlation",
    "Distribution",
    "GreenwoodWilliamson",
    "Parameter",
    "Parameters",
    "Profile",
    "Segmentation",
    "SelfAffinity",
    "SpectralMoments",
    "Spectrum",
    "Summits",
    "WOLF_PRUNING",
    "Window",
]

Axis = Literal["x", "y"]
"""A direction in the plane of the surface."""

Window = Literal["none", "hann", "radial-hann", "welch"]
"""Window that falls to zero at the rim: none for periodic surfaces, Hann along x and y, radial Hann, or Welch."""

WOLF_PRUNING: float = _core.WOLF_PRUNING
"""The Wolf pruning of ISO 25178-3, as a share of Sz."""

_Given = tuple[NDArray[np.float64], tuple[float, float]]
"""Heights and their pitch."""


@described
class Parameter(NamedTuple):
    """A roughness parameter."""

    symbol: Annotated[str, "Symbol in the ISO standard."]
    value: Annotated[float, "Value in SI, a ratio between 0 and 1; NaN if it has no meaning."]
    unit: Annotated[str, "SI unit of the value; ``\"1\"`` for a pure number."]
    family: Annotated[str,
        "``\"height\"``, ``\"spatial\"``, ``\"hybrid\"``, ``\"functional\"``, ``\"feature\"`` or ``\"profile\"``."]
    meaning: Annotated[str, "Meaning in a few words."]
    text: Annotated[str, "The value with a suitable unit."]

    def __float__(self) -> float:
        return self.value

    def __str__(self) -> str:
        return f"{self.symbol} = {self.text}"


class Parameters(Mapping[str, Parameter]):
    """Roughness parameters by their symbols.

    ``p.Sq`` is a value. ``p["Sq"]`` is a :class:`Parameter` with its unit and meaning. ``print(p)`` prints a table.

    Examples
    --------
    >>> import numpy as np, asperity as asp
    >>> wave = 1e-7 * np.cos(2 * np.pi * np.arange(64) / 32)
    >>> p = asp.Surface(np.add.outer(wave, np.zeros(64)), pitch="1 um").parameters()
    >>> p["Sq"].unit, f"{p.Sq:.3e}"
    ('m', '7.071e-08')
    """

    def __init__(self, rows: list[tuple[str, float, str, str, str, str]]) -> None:
        self._rows = {row[0]: Parameter(*row) for row in rows}

    def __getitem__(self, symbol: str) -> Parameter:
        if symbol not in self._rows:
            raise KeyError(f"no parameter {symbol!r}, there are {', '.join(self._rows)}")
        return self._rows[symbol]

    def __getattr__(self, symbol: str) -> float:
        rows: dict[str, Parameter] = self.__dict__.get("_rows", {})
        if symbol not in rows:
            raise AttributeError(f"no parameter {symbol!r}, there are {', '.join(rows)}")
        return rows[symbol].value

    def __iter__(self) -> Iterator[str]:
        return iter(self._rows)

    def __len__(self) -> int:
        return len(self._rows)

    def __dir__(self) -> list[str]:
        return [*super().__dir__(), *self._rows]

    def __eq__(self, other: object) -> bool:
        return isinstance(other, Parameters) and same(self._rows, other._rows)

    __hash__ = None  # type: ignore[assignment]

    def __repr__(self) -> str:
        return f"<Parameters: {', '.join(map(str, self._rows.values()))}>"

    def __str__(self) -> str:
        lines = []
        for family in self.families:
            lines.append(f"{family} parameters")
            lines += [f"  {row.symbol:<7}{row.text:>16}  {row.meaning}" for row in self.family(family).values()]
        return "\n".join(lines)

    def _repr_html_(self) -> str:
        rows = []
        for family in self.families:
            rows.append(f'<tr><th colspan="3">{html.escape(family)}</th></tr>')
            rows += [
                f"<tr><td>{row.symbol}</td><td>{html.escape(row.text)}</td><td>{html.escape(row.meaning)}</td></tr>"
                for row in self.family(family).values()
            ]
        return f"<table>{''.join(rows)}</table>"

    @property
    def families(self) -> list[str]:
        """Names of the families in their order."""
        return list(dict.fromkeys(row.family for row in self._rows.values()))

    def family(self, name: str) -> Parameters:
        """Return the parameters of one family."""
        if name not in self.families:
            raise KeyError(f"no family {name!r}, there are {', '.join(self.families)}")
        return Parameters([row for row in self._rows.values() if row.family == name])

    @property
    def numbers(self) -> dict[str, float]:
        """Return the values by symbol."""
        return {symbol: row.value for symbol, row in self._rows.items()}


@described
class Core(NamedTuple):
    """Core, peaks and pits of a material ratio curve. The names are the letters after S or R, such as Sk and Spk."""

    upper: Annotated[float, "Height of the equivalent line at the ratio 0, from the mean, m."]
    lower: Annotated[float, "Height of the equivalent line at the ratio 1, from the mean, m."]
    k: Annotated[float, "Height of the core, m."]
    pk: Annotated[float, "Reduced height of the peaks above the core, m."]
    vk: Annotated[float, "Reduced depth of the pits below the core, m."]
    pkx: Annotated[float, "Height of the highest sample above the core, m."]
    vkx: Annotated[float, "Depth of the lowest sample below the core, m."]
    mrk1: Annotated[float, "Material ratio at the upper end of the core."]
    mrk2: Annotated[float, "Material ratio at the lower end of the core."]
    ak1: Annotated[float, "Material above the core, m³/m² (for a profile m²/m)."]
    ak2: Annotated[float, "Void below the core, m³/m² (for a profile m²/m)."]


class _Computed(Cached):
    """An object of the compiled module, which is made again from its data where it is unpickled."""

    _kind: Any
    _data: tuple[Any, ...]

    @cached_property
    def _core(self) -> Any:
        return self._kind(*self._data)


class BearingCurve(_Computed):
    """Material ratio curve (Abbott–Firestone curve): the height above which a share of the samples lies.

    The curve is linear between the samples in descending order; each lies in the middle of its share of the ratio. A ratio outside
    0 … 1 is replaced by the nearer of the two. ISO 25178-2:2021, 4.5.

    Parameters
    ----------
    samples : array_like
        Heights of any shape, m; undefined ones are NaN.

    Raises
    ------
    asperity.errors.NothingDefined
        If all samples are undefined.

    Examples
    --------
    >>> import asperity as asp
    >>> curve = asp.BearingCurve([3e-6, 1e-6, 2e-6, 0.0])
    >>> curve.height(0.125)
    1.5e-06
    """

    _kind = _core.BearingCurve

    def __init__(self, samples: ArrayLike) -> None:
        self._data = (np.array(samples, dtype=np.float64).ravel(),)
        self._core  # noqa: B018

    def _compared(self) -> dict[str, Any]:
        return {"heights": self.heights}

    def __repr__(self) -> str:
        return f"<BearingCurve of {self.heights.size} samples>"

    @cached_property
    def heights(self) -> NDArray[np.float64]:
        """Heights of the samples from their mean, descending, m."""
        heights: NDArray[np.float64] = self._core.heights()
        return heights

    def height(self, ratio: Point) -> Point:
        """Return the height Smc at a material ratio from 0 (the highest sample) to 1 (the lowest), m."""
        return self._at("height", ratio)  # type: ignore[no-any-return]

    def ratio(self, height: Point) -> Point:
        """Return the material ratio Smr at a height from the mean: the largest ratio at which the curve is as high."""
        return self._at("ratio", height)  # type: ignore[no-any-return]

    def material_volume(self, ratio: Point) -> Point:
        """Return the material volume Vm above the height at a material ratio, m³/m²."""
        return self._at("material_volume", ratio)  # type: ignore[no-any-return]

    def void_volume(self, ratio: Point) -> Point:
        """Return the void volume Vv below the height at a material ratio, m³/m²."""
        return self._at("void_volume", ratio)  # type: ignore[no-any-return]

    def core(self) -> Core | None:
        """Return the parameters of stratified surfaces, such as Sk, by ISO 13565-2; `None` for fewer than about five samples."""
        found = self._core.core()
        return None if found is None else Core(*found)

    def _at(self, what: str, places: Any) -> Any:
        return spread((places,), lambda points: self._core.at(what, points[:, 0])[:, np.newaxis])


@described
class Distribution(Comparable):
    """A probability density over classes of equal width. Its integral is 1."""

    edges: Annotated[NDArray[np.float64],
        "Edges of the classes, one more than classes: heights from their mean, m, or slopes."]
    density: Annotated[NDArray[np.float64],
        "Share of the values in each class over its width, 1/m for heights, 1 for slopes."]

    def __init__(self, lowest: float, width: float, density: NDArray[np.float64]) -> None:
        self.edges = lowest + width * np.arange(len(density) + 1, dtype=np.float64)
        self.density = density

    def __repr__(self) -> str:
        return f"<Distribution over {self.density.size} classes from {self.edges[0]:.4g} to {self.edges[-1]:.4g}>"

    @property
    def centres(self) -> NDArray[np.float64]:
        """Centres of the classes."""
        return 0.5 * (self.edges[1:] + self.edges[:-1])

    @property
    def width(self) -> float:
        """Width of a class."""
        return float(self.edges[1] - self.edges[0])


class Profile(Comparable):
    """A profile: heights along a line at equal distances, filtered and described by ISO 21920-2:2021.

    Parameters
    ----------
    heights : array_like
        Heights, m; undefined ones are NaN.
    pitch : float or str
        Distance between two samples, above 0, m.

    Raises
    ------
    asperity.errors.BadInput
        If there are no heights, one of them is infinite, or the pitch is wrong.

    Examples
    --------
    >>> import numpy as np, asperity as asp
    >>> profile = asp.Profile(1e-6 * np.sin(2 * np.pi * np.arange(2000) / 40), pitch="1 um")
    >>> f"{profile.roughness('0.25 mm').parameters().Rq:.2e}"
    '7.05e-07'
    """

    def __init__(self, heights: ArrayLike, pitch: Quantity) -> None:
        given = np.array(heights, dtype=np.float64)
        if given.ndim != 1:
            message = f"'heights' has {given.ndim} dimensions, expected heights along a line"
            raise bad_input("heights", message)
        self._given = given
        self.pitch = quantity("pitch", pitch, "length")
        self._filters: list[tuple[str, float]] = []
        self.heights  # noqa: B018

    def _filtered(self, filter: str, length: Quantity) -> Profile:
        found = Profile.__new__(Profile)
        found._given = self._given
        found.pitch = self.pitch
        found._filters = [*self._filters, (filter, quantity("cutoff", length, "length"))]
        found.heights  # noqa: B018
        return found

    def _line(self) -> Any:
        return self._given, self.pitch, self._filters

    def _compared(self) -> dict[str, Any]:
        return {"heights": self.heights, "pitch": self.pitch, "section": self.section}

    def __repr__(self) -> str:
        filters = "".join(f", {name} at {_core.format(length, 'length')}" for name, length in self._filters)
        return f"<Profile: {self.heights.size} samples, {_core.format(self.length, 'length')} long{filters}>"

    @cached_property
    def heights(self) -> NDArray[np.float64]:
        """Heights, m; undefined ones are NaN."""
        heights: NDArray[np.float64] = _core.line_heights(self._line())
        return heights

    @property
    def positions(self) -> NDArray[np.float64]:
        """Positions of the samples along the line, m, the centres of their cells."""
        return self.pitch * (np.arange(self.heights.size, dtype=np.float64) + 0.5)

    @property
    def length(self) -> float:
        """Evaluation length, m: the pitch for each sample."""
        return self.pitch * self.heights.size

    @property
    def section(self) -> float | None:
        """Section length of a roughness profile, which is its cut-off, m; `None` if the whole profile is one section."""
        return next((length for name, length in self._filters[-1:] if name == "roughness"), None)

    def primary(self, nesting_index: Quantity) -> Profile:
        """Return the primary profile, without waves below the nesting index λs, at least two pitches, m. ISO 16610-21."""
        return self._filtered("primary", nesting_index)

    def waviness(self, cutoff: Quantity) -> Profile:
        """Return the waviness profile, without waves below the cut-off λc, at least two pitches, m."""
        return self._filtered("waviness", cutoff)

    def roughness(self, cutoff: Quantity) -> Profile:
        """Return the roughness profile: the profile minus its waviness, with sections of the length λc, m."""
        return self._filtered("roughness", cutoff)

    def parameters(self) -> Parameters:
        """Return the ISO 21920 parameters of this profile. Call :meth:`roughness` first for roughness parameters."""
        return Parameters(_core.line_parameters(self._line()))

    def bearing_curve(self) -> BearingCurve:
        """Return the material ratio curve of the profile."""
        return BearingCurve(self.heights)


@described
class GreenwoodWilliamson(NamedTuple):
    """A rough surface in the model of Greenwood and Williamson: asperities of one radius with Gaussian heights.

    Greenwood & Williamson, Proc. R. Soc. A 295, 300 (1966).
    """

    density: Annotated[float, "Number of asperities per area η, 1/m²."]
    radius: Annotated[float, "Radius R of the tips, the inverse of their mean curvature, m."]
    height_deviation: Annotated[float, "Standard deviation σs of the heights of the asperities, m."]
    mean_height: Annotated[float, "Mean height of the summits above the mean of the surface, m."]


@described
class SpectralMoments(Comparable):
    """Spectral moments: variances of the heights and, along x and y, of slope and curvature.

    The shortest waves dominate m₂ and m₄. Longuet-Higgins, Phil. Trans. R. Soc. A 249, 321 (1957); Nayak, J. Lubr. Technol.
    93, 398 (1971).
    """

    m0: Annotated[float, "Variance of the heights, m²."]
    m2: Annotated[tuple[float, float], "Variances of the slope along x and y."]
    m4: Annotated[tuple[float, float], "Variances of the curvature along x and y, 1/m²."]
    mean_m2: Annotated[float, "Mean of `m2` over x and y, for an isotropic surface."]
    mean_m4: Annotated[float, "Mean of `m4` over x and y, for an isotropic surface, 1/m²."]
    bandwidth: Annotated[float,
        "Nayak's α = m₀m₄/m₂² with the means: 3/2 for an isotropic surface of a single wavelength."]

    def __init__(self, found: Any) -> None:
        self.m0, m2, m4, self.mean_m2, self.mean_m4, self.bandwidth, asperities = found
        self.m2 = (float(m2[0]), float(m2[1]))
        self.m4 = (float(m4[0]), float(m4[1]))
        self._asperities = GreenwoodWilliamson(*asperities)

    def __repr__(self) -> str:
        return f"<SpectralMoments: m0 {self.m0:.4g} m², m2 {self.mean_m2:.4g}, m4 {self.mean_m4:.4g} 1/m²>"

    def greenwood_williamson(self) -> GreenwoodWilliamson:
        """Return the asperities of an isotropic Gaussian surface with these moments.

        η = m₄/(6π√3 m₂),  R = 3√π/(8√m₄),  σs² = (1 − 0.8968/α) m₀,  z̄s = 4 √(m₀/πα). Nayak (1971) for η; Bush, Gibson &
        Keogh, Mech. Res. Commun. 3, 169 (1976) and McCool, J. Tribol. 109, 264 (1987) for the rest.
        """
        return self._asperities


@described
class SelfAffinity(NamedTuple):
    """The best fit of a self-affine law: C(q) ∝ q^(−2−2H), or mean square height differences ∝ τ^(2H)."""

    hurst: Annotated[float, "Hurst exponent H."]
    hurst_error: Annotated[float, "Standard error of the Hurst exponent."]
    range: Annotated[tuple[float, float], "First and last fitted abscissa: wave numbers, rad/m, or lags, m."]
    points: Annotated[int, "Number of fitted points."]
    decades: Annotated[float, "Decades of the fitted range."]
    fractal_dimension: Annotated[float, "Fractal dimension 3 − H."]
    doubt: Annotated[str | None,
        "Reason why the exponent may be only a slope of the spectrum and no law of the surface."]


def law(found: Any) -> SelfAffinity:
    """The law that the compiled module has found."""
    hurst, error, ends, points, decades, dimension, doubt = found
    return SelfAffinity(hurst, error, (ends[0], ends[1]), points, decades, dimension, doubt)


_SPECTRAL = np.dtype([("wave_number", np.float64), ("density", np.float64), ("waves", np.int64)])
LAGS = np.dtype([("lag", np.float64), ("value", np.float64)])


@described
class Spectrum(_Computed):
    """Power spectral density of a surface, C(q) = abs(z̃(q))²/A, m⁴.

    Without a window, its integral over wave vectors of both signs divided by (2π)² is Sq². Undefined samples are filled by a
    membrane. Jacobs, Junge & Pastewka, Surf. Topogr.: Metrol. Prop. 5, 013001 (2017).

    Returned by :meth:`asperity.Surface.spectrum`.
    """

    window: Annotated[str, "The window."]

    _kind = _core.Spectrum

    def __init__(self, given: _Given, window: str) -> None:
        self._data = (given, window)
        self.window = window
        self._core  # noqa: B018

    def _compared(self) -> dict[str, Any]:
        return {"density": self.density, "pitch": self._data[0][1], "window": self.window}

    def __repr__(self) -> str:
        nx, ny = self._data[0][0].shape
        return f"<Spectrum of {nx} × {ny} samples, window {self.window!r}>"

    @cached_property
    def density(self) -> NDArray[np.float64]:
        """C(q), m⁴, ``[kx, ky]`` of shape ``(nx, ny // 2 + 1)``. Negative qy are left out, because C(−q) = C(q)."""
        density: NDArray[np.float64] = self._core.density()
        return density

    @cached_property
    def wave_numbers(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Wave numbers qx, of both signs, and qy of the rows and columns of `density`, rad/m."""
        x, y = self._core.wave_numbers()
        return x, y

    @property
    def nyquist(self) -> float:
        """Nyquist wave number, up to which waves of all directions are resolved, rad/m."""
        return float(self._core.nyquist())

    @property
    def variance(self) -> float:
        """Variance of the heights, the integral of C over all wave vectors divided by (2π)², m²."""
        return float(self._core.variance())

    def radial(self, per_decade: int | None = 10) -> NDArray[np.void]:
        """Return the mean over all directions, C_iso(q), up to the Nyquist wave number.

        Parameters
        ----------
        per_decade : int or None
            Number of rings for a factor of ten in wave number. With `None` the rings have the width 2π over the longer side.

        Returns
        -------
        ndarray
            Records of `wave_number`, rad/m, `density`, m⁴, and `waves`, the number of wave vectors in the ring.
        """
        rings = None if per_decade is None else whole("per_decade", per_decade, 1)
        return np.array(self._core.radial(rings), dtype=_SPECTRAL)

    def angular(self, directions: int = 180) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Return the variance per radian as a function of the direction of the wave vector.

        Parameters
        ----------
        directions : int
            Number of directions over half a turn.

        Returns
        -------
        angles : ndarray
            Angles from the x axis towards the y axis, from 0 to below π, rad. The lay is perpendicular to them.
        density : ndarray
            Variance per radian, m². Its sum times π/`directions` is the variance of the waves up to the Nyquist wave number.
        """
        count = whole("directions", directions, 1)
        return np.pi / count * np.arange(count, dtype=np.float64), self._core.angular(count)

    def along(self, axis: Axis) -> NDArray[np.void]:
        """Return the mean spectrum of the profiles along an axis.

        Returns
        -------
        ndarray
            Records of `wave_number`, rad/m, `density`, m³, and `waves`, from 0 to the Nyquist wave number of the axis. The
            integral over both signs over 2π is Sq².
        """
        return np.array(self._core.along(axis), dtype=_SPECTRAL)

    def moments(self) -> SpectralMoments:
        """Return the spectral moments, integrals of the spectrum. A Hann window adds (2π/L)² m₀/3 to m₂."""
        return SpectralMoments(self._core.moments())

    def self_affinity(
        self, wave_numbers: tuple[float, float] | None = None, *, per_decade: int = 10
    ) -> SelfAffinity:
        """Return the self-affine law of the mean over all directions.

        Parameters
        ----------
        wave_numbers : pair of float, optional
            The range to fit, rad/m; by default the longest range in which the spectrum follows a law.
        per_decade : int
            Number of rings for a factor of ten in wave number.

        Raises
        ------
        asperity.errors.OutOfRange
            If there are fewer than three points, or no range that follows a law.
        """
        fit = None if wave_numbers is None else ascending("wave_numbers", wave_numbers)
        return law(self._core.self_affinity(fit, whole("per_decade", per_decade, 1)))


@described
class Correlation(_Computed):
    """Autocorrelation function R(τ) = ⟨z(x) z(x + τ)⟩ over all pairs of defined samples, m².

    Returned by :meth:`asperity.Surface.autocorrelation`. The autocorrelation of ISO 25178-2 is R(τ)/R(0).
    """

    periodic: Annotated[bool, "Whether the surface was treated as periodic."]

    _kind = _core.Correlation

    def __init__(self, given: _Given, periodic: bool) -> None:
        self._data = (given, periodic)
        self.periodic = periodic
        self._core  # noqa: B018

    def _compared(self) -> dict[str, Any]:
        return {"values": self.values, "pitch": self._data[0][1]}

    def __repr__(self) -> str:
        nx, ny = self._data[0][0].shape
        return f"<Correlation of {nx} × {ny} samples{', periodic' if self.periodic else ''}>"

    @cached_property
    def values(self) -> NDArray[np.float64]:
        """R at all lags, m², ``[lx, ly]``, with lag 0 in the centre; NaN for a lag without a pair."""
        values: NDArray[np.float64] = self._core.values()
        return values

    @property
    def lags(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]:
        """Lags along x and y of the rows and columns of `values`, m: half the surface in both directions."""
        (nx, ny), (dx, dy) = self.values.shape, self._data[0][1]
        x, y = np.arange(nx, dtype=np.float64), np.arange(ny, dtype=np.float64)
        return dx * (x - nx // 2), dy * (y - ny // 2)

    @property
    def variance(self) -> float:
        """R(0) = Sq², m²."""
        return float(self._core.variance())

    def along(self, axis: Axis) -> NDArray[np.void]:
        """Return R along an axis from lag 0 on: records of `lag`, m, and `value`, m²."""
        return np.array(self._core.along(axis), dtype=LAGS)

    def radial(self) -> NDArray[np.void]:
        """Return the mean of R over all directions: records of `lag`, m, and `value`, m²."""
        return np.array(self._core.radial(), dtype=LAGS)

    def decay_length(self, angle: Quantity, level: float = 0.2) -> float:
        """Return the lag at which R(τ)/R(0) first falls to `level`, below 1, in a direction, m; NaN if it does not.

        The `angle` is measured from the x axis towards the y axis, rad, or text such as ``"30 deg"``.
        """
        return float(self._core.decay_length(quantity("angle", angle, "angle", positive=False), _level(level)))

    def decay_lengths(self, level: float = 0.2) -> tuple[float, float]:
        """Return the shortest and the longest decay length of all directions, Sal and Sal/Str, m; NaN beyond the lags."""
        fastest, slowest = self._core.decay_lengths(_level(level))
        return fastest, slowest


@described
class Summits(Comparable):
    """The summits of a surface: the samples higher than their eight neighbours.

    Their number depends on the pitch (Greenwood, Proc. R. Soc. A 393, 133, 1984).
    """

    summits: Annotated[NDArray[np.float64],
        "A record for each summit: its sample `ix`, `iy`; `height` above the mean, m; mean `curvature`, 1/m, not "
        "negative."]
    area: Annotated[float, "Area that was searched for summits, m²."]

    _DTYPE = np.dtype([("ix", np.int64), ("iy", np.int64), ("height", np.float64), ("curvature", np.float64)])

    def __init__(self, found: Any) -> None:
        summits, self.area, asperities = found
        self.summits: NDArray[np.void] = np.array(summits, dtype=self._DTYPE)
        self._asperities = GreenwoodWilliamson(*asperities)

    def __len__(self) -> int:
        return len(self.summits)

    def __repr__(self) -> str:
        return f"<Summits: {len(self)} on {_core.format(self.area, 'area')}>"

    def greenwood_williamson(self) -> GreenwoodWilliamson:
        """Return density, radius, deviation and mean of the heights of the summits; NaN without summits."""
        return self._asperities


@described
class Segmentation(Comparable):
    """A surface divided into hills around its peaks, or into dales around its pits.

    Insignificant ones are pruned. ISO 25178-2:2012, 3.3.1; ISO 16610-85; Wolf, Computers & Geosciences 17, 1359 (1991).
    """

    labels: Annotated[NDArray[np.float64],
        "Number of the hill or dale of each sample, from 1 in the order of `motifs`; 0 without one."]
    motifs: Annotated[NDArray[np.float64],
        "A record for each hill or dale, beginning with the highest peak or the deepest pit: the sample `ix`, `iy` of "
        "the peak or pit; its `height`, m; the height of its `saddle`, m; `local_height` between the two, m; "
        "`prominence`, the threshold above which it would be pruned, m; mean `curvature`, 1/m, at least 0 at a peak, "
        "at most 0 at a pit; `area`, m²; `volume` above or below the saddle, m³; `closed`, whether it stays clear of "
        "the rim at half the material."]

    _DTYPE = np.dtype(
        [
            ("ix", np.int64), ("iy", np.int64), ("height", np.float64), ("saddle", np.float64),
            ("local_height", np.float64), ("prominence", np.float64), ("curvature", np.float64), ("area", np.float64),
            ("volume", np.float64), ("closed", np.bool_),
        ]
    )  # fmt: skip

    def __init__(self, found: Any) -> None:
        self.labels: NDArray[np.uint32] = found[0]
        self.motifs: NDArray[np.void] = np.array(found[1], dtype=self._DTYPE)

    def __len__(self) -> int:
        return len(self.motifs)

    def __repr__(self) -> str:
        nx, ny = self.labels.shape
        return f"<Segmentation: {len(self)} motifs on {nx} × {ny} samples>"


def share_of_sz(pruning: Any) -> float:
    """The threshold of a pruning."""
    return number("pruning", pruning, "a share of Sz from 0 to 1", 0.0, 1.0)


def _level(level: Any) -> float:
    return number("level", level, "a part of R(0) below 1", -1.0, np.nextafter(1.0, 0.0))


def ascending(key: str, value: Any) -> list[float]:
    """Two numbers that ascend."""
    try:
        low, high = (float(end) for end in value)
    except (TypeError, ValueError):
        low, high = np.nan, np.nan
    if not 0.0 <= low < high:
        raise bad_input(key, f"'{key}' is {value!r}, expected two numbers that ascend")
    return [low, high]


def __dir__() -> list[str]:
    return __all__
