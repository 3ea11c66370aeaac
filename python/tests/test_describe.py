"""What a surface is like, against NumPy and formulas written here."""

import copy
import math
import pickle

import asperity as asp
import numpy as np
import pytest

NX, NY, DX, DY = 48, 40, 1e-6, 1.5e-6
RANDOM = np.random.default_rng(11)
NOISE = 1e-7 * RANDOM.normal(size=(NX, NY))
ROUGH = asp.Surface(NOISE, (DX, DY))
MEAN_FREE = NOISE - NOISE.mean()
X = (np.arange(NX) + 0.5) * DX
SMOOTH = asp.generate.low_pass((128, 128), pitch="0.5 um", sq="0.2 um", cutoff="8 um", seed=5)


def holes(heights):
    heights = np.array(heights)
    heights[3, 4] = heights[20, 10:14] = np.nan
    return heights


def test_height_parameters_are_moments():
    p = ROUGH.parameters()
    sq = math.sqrt(np.mean(MEAN_FREE**2))
    assert p.Sq == pytest.approx(sq, rel=1e-12)
    assert p.Sa == pytest.approx(np.abs(MEAN_FREE).mean(), rel=1e-12)
    assert p.Ssk == pytest.approx(np.mean(MEAN_FREE**3) / sq**3, rel=1e-9)
    assert p.Sku == pytest.approx(np.mean(MEAN_FREE**4) / sq**4, rel=1e-9)
    assert p.Sz == pytest.approx(np.ptp(NOISE), rel=1e-12)
    assert p["Sq"] == ("Sq", p.Sq, "m", "height", p["Sq"].meaning, p["Sq"].text)
    assert float(p["Sq"]) == p.Sq
    with_holes = asp.Surface(holes(NOISE), (DX, DY)).parameters()
    assert with_holes.Sq == pytest.approx(np.nanstd(holes(NOISE)), rel=1e-12)


def test_parameters_are_a_mapping_that_prints():
    p = SMOOTH.parameters()
    assert p.families == ["height", "spatial", "hybrid", "functional", "feature"]
    assert len(p) == len(dict(p)) == sum(len(p.family(name)) for name in p.families) > 35
    assert list(p.family("hybrid")) == ["Sdq", "Sdr"]
    assert "Sq" in p and "Rq" not in p and "Sq" in dir(p)
    assert p["Sq"].text == "200 nm" and str(p["Sq"]) == "Sq = 200 nm"
    assert "  Sq               200 nm  Root mean square height" in str(p)
    assert "<td>Sq</td><td>200 nm</td>" in p._repr_html_()
    assert p.numbers["Sq"] == p.Sq
    assert copy.deepcopy(p) == p == pickle.loads(pickle.dumps(p)) != ROUGH.parameters()
    with pytest.raises(KeyError, match="no parameter 'Rq', there are Sa, Sq"):
        p["Rq"]
    with pytest.raises(AttributeError, match="no parameter 'Rq'"):
        p.Rq  # noqa: B018
    with pytest.raises(KeyError, match="no family 'odd'"):
        p.family("odd")
    flat = asp.Surface(np.zeros((8, 8)), 1e-6).parameters()
    assert math.isnan(flat.Ssk) and flat["Ssk"].text == "–"
    assert flat == asp.Surface(np.zeros((8, 8)), 1e-6).parameters()


def test_profiles_are_lines_of_the_surface():
    along_x, along_y = ROUGH.profile("x", 7), ROUGH.profile("y", 3)
    assert (along_x.heights == NOISE[:, 7]).all() and along_x.pitch == DX
    assert (along_y.heights == NOISE[3]).all() and along_y.pitch == DY
    assert along_y.length == pytest.approx(NY * DY)
    assert along_x.positions[1] == pytest.approx(1.5 * DX)
    p = along_x.parameters()
    assert p.Rq == pytest.approx(NOISE[:, 7].std(), rel=1e-12)
    assert p.Rt == pytest.approx(np.ptp(NOISE[:, 7]), rel=1e-12)
    assert p["Rq"].family == "profile"
    assert ROUGH.profile() == ROUGH.profile("x", 0)


def test_filters_halve_the_wave_of_their_cutoff():
    n, wave = 4000, 40
    profile = asp.Profile(1e-6 * np.sin(2 * math.pi * np.arange(n) / wave), "1 um")
    waviness, roughness = profile.waviness("40 um"), profile.roughness(40e-6)
    middle = slice(n // 4, 3 * n // 4)
    assert np.ptp(waviness.heights[middle]) == pytest.approx(1e-6, rel=1e-3)
    assert waviness.heights + roughness.heights == pytest.approx(profile.heights, abs=1e-18)
    assert (profile.primary("40 um").heights == waviness.heights).all()
    assert (waviness.section, roughness.section) == (None, 40e-6)
    # Rz is a mean over sections: a profile without any is one section.
    double = asp.Profile(roughness.heights, 1e-6)
    assert double.parameters().Rq == pytest.approx(roughness.parameters().Rq, rel=1e-12)
    steps = asp.Profile(np.where(np.arange(n) < n // 2, 1.0, 4.0) * profile.heights, 1e-6)
    rough = steps.roughness("500 um")
    assert rough.parameters().Rz < 0.8 * asp.Profile(rough.heights, 1e-6).parameters().Rz
    assert pickle.loads(pickle.dumps(rough)) == rough != steps
    assert "roughness at 500 µm" in repr(rough)
    mean = ROUGH.profile_parameters("y", "6 um")
    each = [ROUGH.profile("y", i).roughness("6 um").parameters().Ra for i in range(NX)]
    assert mean.Ra == pytest.approx(np.mean(each), rel=1e-12)


def test_the_bearing_curve_is_the_sorted_heights():
    curve = ROUGH.bearing_curve()
    ordered = np.sort(MEAN_FREE, axis=None)[::-1]
    assert curve.heights == pytest.approx(ordered, abs=1e-20)
    n = ordered.size
    middles = (np.arange(n) + 0.5) / n
    assert curve.height(middles) == pytest.approx(ordered, abs=1e-18)
    assert curve.ratio(ordered[10]) == pytest.approx(middles[10], rel=1e-9)
    assert curve.height(np.full((2, 3), 0.5)).shape == (2, 3)
    assert isinstance(curve.height(0.5), float)
    c = curve.height(0.1)
    assert curve.material_volume(0.1) == pytest.approx(np.maximum(MEAN_FREE - c, 0.0).mean(), rel=1e-3)
    assert curve.void_volume(0.8) == pytest.approx(np.maximum(curve.height(0.8) - MEAN_FREE, 0.0).mean(), rel=1e-3)
    p = ROUGH.parameters()
    core = curve.core()
    assert core is not None
    assert (core.k, core.pk, core.mrk2) == pytest.approx((p.Sk, p.Spk, p.Smrk2), rel=1e-12)
    assert asp.BearingCurve([1.0, 2.0]).core() is None
    assert pickle.loads(pickle.dumps(curve)) == curve == copy.copy(curve)
    assert ROUGH.profile("y", 2).bearing_curve().heights == pytest.approx(np.sort(NOISE[2] - NOISE[2].mean())[::-1])


def test_distributions_count():
    found = ROUGH.height_distribution(9)
    counts, edges = np.histogram(MEAN_FREE, bins=9)
    assert found.density * found.width * NOISE.size == pytest.approx(counts, abs=1e-6)
    assert found.edges == pytest.approx(edges, rel=1e-9)
    assert found.centres == pytest.approx(0.5 * (edges[1:] + edges[:-1]))
    tilted = asp.Surface(np.add.outer(0.01 * X, 0.02 * DY * np.arange(NY)) + 1e-4 * NOISE, (DX, DY))
    for slope, expected in (("x", 0.01), ("y", 0.02), ("magnitude", math.hypot(0.01, 0.02))):
        density = tilted.slope_distribution(slope)
        assert np.sum(density.density) * density.width == pytest.approx(1.0)
        assert np.sum(density.density * density.centres) * density.width == pytest.approx(expected, rel=1e-2)
    assert pickle.loads(pickle.dumps(found)) == found


def test_the_spectrum_is_numpys():
    spectrum = ROUGH.spectrum("none")
    expected = np.abs(DX * DY * np.fft.rfft2(MEAN_FREE)) ** 2 / (NX * NY * DX * DY)
    expected[0, 0] = 0.0
    assert spectrum.density == pytest.approx(expected, rel=1e-8, abs=1e-12 * expected.max())
    qx, qy = spectrum.wave_numbers
    assert np.abs(qx) == pytest.approx(np.abs(2 * math.pi * np.fft.fftfreq(NX, DX)), rel=1e-12)
    assert qy == pytest.approx(2 * math.pi * np.fft.rfftfreq(NY, DY), rel=1e-12)
    assert spectrum.variance == pytest.approx(MEAN_FREE.var(), rel=1e-12)
    assert spectrum.nyquist == pytest.approx(math.pi / DY)
    along = spectrum.along("x")
    columns = np.abs(DX * np.fft.rfft(MEAN_FREE, axis=0)) ** 2 / (NX * DX)
    assert along["density"] == pytest.approx(columns.mean(axis=1), rel=1e-8, abs=1e-12 * along["density"].max())
    assert (along["waves"] == NY).all()
    # Hann's window, made here.
    hann = np.outer(*(np.sin(math.pi * (np.arange(n) + 0.5) / n) ** 2 for n in (NX, NY)))
    hann /= math.sqrt(np.mean(hann**2))
    weighted = hann * (NOISE - (hann * NOISE).sum() / hann.sum())
    windowed = np.abs(np.fft.rfft2(weighted)) ** 2 * DX * DY / (NX * NY)
    assert ROUGH.spectrum().density == pytest.approx(windowed, rel=1e-7, abs=1e-12 * windowed.max())


def test_rings_and_directions_share_the_power():
    wave = 1e-7 * np.cos(2 * math.pi * (np.add.outer(3 * np.arange(64), 4 * np.arange(64)) / 64))
    spectrum = asp.Surface(wave, 1e-6).spectrum("none")
    angles, density = spectrum.angular(360)
    assert angles[np.argmax(density)] == pytest.approx(math.atan2(4, 3), abs=math.pi / 360)
    assert density.sum() * math.pi / 360 == pytest.approx(0.5e-14, rel=1e-6)
    rings = spectrum.radial(None)
    assert rings["wave_number"][np.argmax(rings["density"])] == pytest.approx(2 * math.pi * 5 / 64e-6, rel=0.05)
    assert rings["waves"].sum() == pytest.approx(math.pi * 32**2, rel=0.05)
    assert len(spectrum.radial(5)) < len(spectrum.radial(20))
    assert pickle.loads(pickle.dumps(spectrum)) == spectrum != ROUGH.spectrum()


def test_the_autocorrelation_is_a_mean_over_pairs():
    periodic = ROUGH.autocorrelation(periodic=True)
    power = np.abs(np.fft.fft2(MEAN_FREE)) ** 2
    circular = np.fft.fftshift(np.fft.ifft2(power).real) / NOISE.size
    assert periodic.values[:-1, :-1] == pytest.approx(circular, abs=1e-22)
    found = asp.Surface(holes(NOISE), (DX, DY)).autocorrelation()
    z = holes(NOISE) - np.nanmean(holes(NOISE))
    for i, j in ((0, 0), (5, 0), (-7, 3), (12, -20)):
        here = z[max(0, -i) : NX - max(0, i), max(0, -j) : NY - max(0, j)]
        there = z[max(0, i) : NX + min(0, i), max(0, j) : NY + min(0, j)]
        assert found.values[NX // 2 + i, NY // 2 + j] == pytest.approx(np.nanmean(here * there), rel=1e-7)
    lx, ly = found.lags
    assert lx[NX // 2 + 5] == pytest.approx(5 * DX) and ly[0] == pytest.approx(-NY // 2 * DY)
    assert found.along("x")["value"][5] == found.values[NX // 2 + 5, NY // 2]
    assert found.variance == found.values[NX // 2, NY // 2] == found.radial()["value"][0]
    smooth = SMOOTH.autocorrelation()
    p = SMOOTH.parameters()
    fastest, slowest = smooth.decay_lengths()
    assert (fastest, fastest / slowest) == pytest.approx((p.Sal, p.Str), rel=1e-12)
    assert fastest <= smooth.decay_length("30 deg") <= slowest
    assert smooth.decay_length(math.pi / 6) == smooth.decay_length("30 deg")
    assert pickle.loads(pickle.dumps(smooth)) == smooth


def test_moments_are_integrals_over_the_spectrum():
    qx, qy = (2 * math.pi * np.fft.fftfreq(128, 0.5e-6) for _ in range(2))
    power = np.abs(np.fft.fft2(SMOOTH.heights)) ** 2 / 128**4
    power[0, 0] = 0.0
    m = SMOOTH.moments(window="none")
    m2 = [(power * qx[:, None] ** 2).sum(), (power * qy**2).sum()]
    m4 = [(power * qx[:, None] ** 4).sum(), (power * qy**4).sum()]
    assert m.m0 == pytest.approx(power.sum(), rel=1e-9)
    assert m.m2 == pytest.approx(m2, rel=1e-9) and m.m4 == pytest.approx(m4, rel=1e-9)
    alpha = m.m0 * np.mean(m4) / np.mean(m2) ** 2
    assert m.bandwidth == pytest.approx(alpha, rel=1e-9)
    gw = m.greenwood_williamson()
    assert gw.radius == pytest.approx(3 * math.sqrt(math.pi) / (8 * math.sqrt(np.mean(m4))), rel=1e-9)
    assert gw.density == pytest.approx(np.mean(m4) / (6 * math.pi * math.sqrt(3) * np.mean(m2)), rel=1e-9)
    d = SMOOTH.moments("differences")
    assert d.m2[0] == pytest.approx(np.mean(np.diff(SMOOTH.heights, axis=0) ** 2) / 0.25e-12, rel=1e-12)
    assert d.m4[1] == pytest.approx(np.mean(np.diff(SMOOTH.heights, 2, axis=1) ** 2) / 0.0625e-24, rel=1e-9)
    assert SMOOTH.moments() == SMOOTH.spectrum().moments() != m
    assert pickle.loads(pickle.dumps(m)) == m


def test_summits_are_higher_than_their_neighbours():
    z = SMOOTH.heights
    inner = z[1:-1, 1:-1]
    around = [z[1 + i : 127 + i, 1 + j : 127 + j] for i in (-1, 0, 1) for j in (-1, 0, 1) if (i, j) != (0, 0)]
    ix, iy = np.nonzero(inner > np.max(around, axis=0))
    found = SMOOTH.summits()
    assert found.summits["ix"].tolist() == (ix + 1).tolist() and found.summits["iy"].tolist() == (iy + 1).tolist()
    heights = inner[ix, iy] - z.mean()
    assert found.summits["height"] == pytest.approx(heights, rel=1e-9, abs=1e-18)
    gw = found.greenwood_williamson()
    assert gw.density == pytest.approx(len(found) / (126**2 * 0.25e-12), rel=1e-12)
    assert gw.mean_height == pytest.approx(heights.mean()) and gw.height_deviation == pytest.approx(heights.std())
    assert gw.radius == pytest.approx(1 / found.summits["curvature"].mean())
    assert pickle.loads(pickle.dumps(found)) == found


def test_a_self_affine_surface_has_its_hurst_exponent():
    fractal = asp.generate.self_affine((256, 256), pitch="1 um", hurst=0.7, sq="0.1 um", seed=3)
    law = fractal.self_affinity(window="none")
    assert law.hurst == pytest.approx(0.7, abs=0.03) and law.fractal_dimension == pytest.approx(3 - law.hurst)
    assert law.doubt is None and law.decades == pytest.approx(math.log10(law.range[1] / law.range[0]))
    part = fractal.self_affinity((1e5, 1e6), window="none")
    assert part.hurst == pytest.approx(0.7, abs=0.05) and 1e5 <= part.range[0] < part.range[1] <= 1e6
    differences = fractal.height_differences("y")
    z = fractal.heights
    assert differences["lag"][1] == 2e-6 or differences["lag"][1] == pytest.approx(2e-6)
    assert differences["value"][1] == pytest.approx(np.mean((z[:, 2:] - z[:, :-2]) ** 2), rel=1e-9)
    by_lags = fractal.self_affinity(lags=(2e-6, 2e-5), axis="y")
    inside = differences[(differences["lag"] >= 2e-6) & (differences["lag"] <= 2e-5 * (1 + 1e-12))]
    slope = np.polyfit(np.log(inside["lag"]), np.log(inside["value"]), 1)[0]
    assert by_lags.hurst == pytest.approx(0.5 * slope, rel=1e-6)


def test_hills_and_dales_divide_the_surface():
    wave = np.cos(2 * math.pi * np.arange(60) / 20)
    eggs = asp.Surface(1e-6 * np.add.outer(wave, wave), 1e-6)
    hills, dales = eggs.hills(), eggs.dales(0.1)
    assert set(np.unique(hills.labels)) == set(range(1, len(hills) + 1))
    assert hills.motifs["area"].sum() == pytest.approx(3600e-12)
    for motif, label in ((hills.motifs[0], hills), (dales.motifs[0], dales)):
        assert label.labels[motif["ix"], motif["iy"]] == 1
        assert eggs.heights[motif["ix"], motif["iy"]] == motif["height"]
        assert motif["local_height"] == abs(motif["height"] - motif["saddle"])
    pits = dales.motifs
    assert len(pits) == 9 and pits["height"] == pytest.approx(-2e-6)
    middle = pits[pits["closed"]]
    assert (middle["ix"], middle["iy"]) == (30, 30)
    assert pits["saddle"] == pytest.approx(0.0, abs=1e-7)
    q2 = (2 * math.pi / 20e-6) ** 2
    assert pits["curvature"] == pytest.approx(-1e-6 * q2, rel=0.02)
    p = eggs.feature_parameters()
    assert p.Svd == pytest.approx(len(eggs.dales()) / 3600e-12)
    assert list(p) == list(eggs.parameters().family("feature"))
    assert len(SMOOTH.hills(0.0)) > len(SMOOTH.hills(0.5)) > 0
    assert pickle.loads(pickle.dumps(hills)) == hills != dales


@pytest.mark.parametrize(
    "ask, told",
    [
        (lambda s: s.profile("z"), "'axis' is \"z\", expected \"x\" or \"y\""),
        (lambda s: s.profile("x", NY), "index of the profile"),
        (lambda s: s.profile("x", -1), "'index' is -1, expected a whole number of at least 0"),
        (lambda s: s.profile("x", 1.5), "'index' is 1.5"),
        (lambda s: s.profile_parameters("x", "1 um"), "at least two pitches"),
        (lambda s: s.profile_parameters("x", "1 N"), "'cutoff'"),
        (lambda s: s.spectrum("square"), "'window' is \"square\", expected \"none\" or \"hann\" or"),
        (lambda s: s.spectrum().radial(0), "'per_decade' is 0, expected a whole number of at least 1"),
        (lambda s: s.spectrum().angular(0), "'directions' is 0"),
        (lambda s: s.spectrum().along("q"), "'axis' is \"q\""),
        (lambda s: s.spectrum().self_affinity((1e5, 1e4)), "'wave_numbers' is (100000.0, 10000.0)"),
        (lambda s: s.self_affinity((1.0, 2.0)), "points in the range"),
        (lambda s: s.self_affinity((1.0, 2.0), lags=(1.0, 2.0)), "'lags' and 'wave_numbers' are both given"),
        (lambda s: s.self_affinity(lags=3.0), "'lags' is 3.0, expected two numbers that ascend"),
        (lambda s: s.moments("eye"), "'by' is 'eye', expected \"spectrum\" or \"differences\""),
        (lambda s: s.slope_distribution("steep"), "'slope' is \"steep\""),
        (lambda s: s.height_distribution(0), "'classes' is 0"),
        (lambda s: s.hills(1.5), "'pruning' is 1.5, expected a share of Sz from 0 to 1"),
        (lambda s: s.feature_parameters(math.nan), "'pruning' is nan"),
        (lambda s: s.autocorrelation().decay_length(0.0, 1.0), "'level' is 1.0, expected a part of R(0) below 1"),
        (lambda s: asp.Surface(np.zeros((4, 4)), 1.0).height_distribution(), "two values that differ"),
        (lambda s: asp.Surface(np.full((4, 4), np.nan), 1.0).bearing_curve(), "defined"),
        (lambda s: asp.Profile(np.zeros((2, 2)), 1e-6), "'heights' has 2 dimensions"),
        (lambda s: asp.Profile([], 1e-6), "number of heights"),
        (lambda s: asp.Profile([0.0, math.inf], 1e-6), "height"),
        (lambda s: asp.Profile([0.0, 1.0], 0.0), "'pitch' is 0.0"),
    ],
)
def test_bad_input_is_refused(ask, told):
    with pytest.raises(asp.errors.BadInput) as raised:
        ask(ROUGH)
    assert told in str(raised.value)


def test_a_single_sample_and_a_line_have_what_has_a_meaning():
    one = asp.Surface([[1e-6]], 1e-6)
    assert one.parameters().Sz == 0.0
    assert one.autocorrelation().variance == 0.0
    assert len(one.summits()) == 0 and math.isnan(one.summits().greenwood_williamson().radius)
    line = asp.Surface(NOISE[:1], (DX, DY))
    assert line.spectrum("none").along("y")["density"].shape == (NY // 2 + 1,)
    nothing = asp.Surface(np.full((4, 4), np.nan), 1e-6)
    assert math.isnan(nothing.parameters().Sq)
    assert len(nothing.hills()) == 0
