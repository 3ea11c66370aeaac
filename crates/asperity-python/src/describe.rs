//! Description of surfaces: parameters, profiles, curves, spectra, hills.

use asperity::motion::Watch;
use asperity::surface::{
    Axis, BearingCurve, Bins, Classes, Core, Correlation, Distribution, FeatureParameters,
    GreenwoodWilliamson, Motif, Parameter, Parameters, Profile, Segmentation, SelfAffinity, Slope,
    SpectralMoments, SpectralPoint, Spectrum, Stop, Summits, Topography, Window,
};
use asperity::{Choice, Result};
use numpy::{IntoPyArray, PyArray1, PyArray2, PyReadonlyArray1, ToPyArray};
use pyo3::prelude::*;

use crate::arrays::ok;
use crate::surface::{Heights, topography};
use crate::{errors, work};

/// Applies `work` to the topography with these heights, unless it is asked to stop.
fn of_until<T: Send>(
    py: Python<'_>,
    heights: &Heights<'_>,
    work: impl FnOnce(&Topography, Stop<'_>) -> Result<T> + Send,
) -> PyResult<T> {
    let topography = topography(py, heights)?;
    work::run(py, 0, None, |looking| work(&topography, &|| looking.stop()))
}

/// Returns the option with this name.
fn word<C: Choice>(py: Python<'_>, key: &str, word: &str) -> PyResult<C> {
    C::of_word(word).ok_or_else(|| {
        let words: Vec<_> = C::WORDS.iter().map(|(known, _)| format!("\"{known}\"")).collect();
        let message = format!("'{key}' is \"{word}\", expected {}", words.join(" or "));
        errors::bad_input(py, key, &message, None)
    })
}

/// Applies `work` to the topography with these heights.
fn of<T: Send>(
    py: Python<'_>,
    heights: &Heights<'_>,
    work: impl FnOnce(&Topography) -> Result<T> + Send,
) -> PyResult<T> {
    of_until(py, heights, |topography, _| work(topography))
}

/// Symbol, value, unit, family, meaning, and the value as text.
type Row = (&'static str, f64, &'static str, &'static str, &'static str, String);

fn table(rows: Vec<Parameter>) -> Vec<Row> {
    let row = |Parameter { symbol, value, unit, family, meaning }| {
        (symbol, value, unit.symbol(), family, meaning, unit.format(value))
    };
    rows.into_iter().map(row).collect()
}

/// Computes all parameters of ISO 25178.
#[pyfunction]
pub(crate) fn parameters(py: Python<'_>, heights: Heights<'_>) -> PyResult<Vec<Row>> {
    of_until(py, &heights, |topography, stop| Ok(table(Parameters::until(topography, stop)?.rows())))
}

/// Computes the feature parameters of ISO 25178, pruned at this fraction of Sz.
#[pyfunction]
pub(crate) fn feature_parameters(py: Python<'_>, heights: Heights<'_>, pruning: f64) -> PyResult<Vec<Row>> {
    of_until(py, &heights, |topography, stop| {
        Ok(table(FeatureParameters::until(topography, pruning, stop)?.rows()))
    })
}

/// Computes the ISO 21920 roughness parameters of all profiles along an axis, each as the mean over them.
#[pyfunction]
pub(crate) fn profile_parameters(
    py: Python<'_>,
    heights: Heights<'_>,
    axis: &str,
    cutoff: f64,
) -> PyResult<Vec<Row>> {
    let axis = word::<Axis>(py, "axis", axis)?;
    of(py, &heights, |topography| Ok(table(topography.profile_parameters(axis, cutoff)?.rows())))
}

/// Returns the heights of a profile and their pitch.
#[pyfunction]
pub(crate) fn profile<'py>(
    py: Python<'py>,
    heights: Heights<'py>,
    axis: &str,
    index: usize,
) -> PyResult<(Bound<'py, PyArray1<f64>>, f64)> {
    let axis = word::<Axis>(py, "axis", axis)?;
    let profile = ok(topography(py, &heights)?.profile(axis, index), py)?;
    Ok((profile.heights().to_pyarray(py), profile.pitch()))
}

/// A profile: its heights, their pitch, and the filters to apply, each with its length.
type Line<'py> = (PyReadonlyArray1<'py, f64>, f64, Vec<(String, f64)>);

fn line(py: Python<'_>, (heights, pitch, filters): Line<'_>) -> PyResult<Profile> {
    let heights = heights.as_array().to_vec();
    work::run(py, 0, None, move |_| {
        filters.iter().try_fold(Profile::new(pitch, heights)?, |profile, (filter, length)| {
            match filter.as_str() {
                "roughness" => profile.roughness(*length),
                "waviness" => profile.waviness(*length),
                _ => profile.primary(*length),
            }
        })
    })
}

/// Returns the heights of a filtered profile.
#[pyfunction]
pub(crate) fn line_heights<'py>(py: Python<'py>, given: Line<'py>) -> PyResult<Bound<'py, PyArray1<f64>>> {
    Ok(line(py, given)?.heights().to_pyarray(py))
}

/// Computes the ISO 21920 parameters of a filtered profile.
#[pyfunction]
pub(crate) fn line_parameters(py: Python<'_>, given: Line<'_>) -> PyResult<Vec<Row>> {
    Ok(table(line(py, given)?.parameters().rows()))
}

/// Lowest value, width of a class, and densities.
type Histogram<'py> = (f64, f64, Bound<'py, PyArray1<f64>>);

/// Computes the distribution of the heights, or of a slope, over a number of classes.
#[pyfunction]
#[pyo3(signature = (heights, slope=None, classes=None))]
pub(crate) fn distribution<'py>(
    py: Python<'py>,
    heights: Heights<'py>,
    slope: Option<&str>,
    classes: Option<usize>,
) -> PyResult<Histogram<'py>> {
    let slope = slope.map(|name| word::<Slope>(py, "slope", name)).transpose()?;
    let classes = classes.map_or(Classes::FreedmanDiaconis, Classes::Number);
    let Distribution { lowest, width, density } = of(py, &heights, |topography| match slope {
        Some(slope) => topography.slope_distribution(slope, classes),
        None => topography.height_distribution(classes),
    })?;
    Ok((lowest, width, density.into_pyarray(py)))
}

/// A material ratio curve.
#[pyclass(name = "BearingCurve", frozen)]
pub(crate) struct CoreBearingCurve(BearingCurve);

#[pymethods]
impl CoreBearingCurve {
    #[new]
    fn new(py: Python<'_>, samples: PyReadonlyArray1<'_, f64>) -> PyResult<Self> {
        let samples = samples.as_array().to_vec();
        work::run(py, 0, None, |_| BearingCurve::new(&samples).map(Self))
    }

    fn heights<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray1<f64>> {
        self.0.heights().to_pyarray(py)
    }

    /// Evaluates `"height"`, `"ratio"`, `"material_volume"` or `"void_volume"` at each of the places.
    fn at<'py>(
        &self,
        py: Python<'py>,
        what: &str,
        places: PyReadonlyArray1<'py, f64>,
    ) -> Bound<'py, PyArray1<f64>> {
        let curve = &self.0;
        let value = |place: &f64| match what {
            "height" => curve.height(*place),
            "ratio" => curve.ratio(*place),
            "material_volume" => curve.material_volume(*place),
            _ => curve.void_volume(*place),
        };
        places.as_array().iter().map(value).collect::<Vec<_>>().into_pyarray(py)
    }

    /// Returns the parts of the core in the order of Python's class; `None` for too few samples.
    fn core(&self) -> Option<[f64; 11]> {
        let Core { upper, lower, k, pk, vk, pkx, vkx, mrk1, mrk2, ak1, ak2 } = self.0.core()?;
        Some([upper, lower, k, pk, vk, pkx, vkx, mrk1, mrk2, ak1, ak2])
    }
}

/// Density of summits, radius of their tips, standard deviation and mean of their heights.
type Asperities = [f64; 4];

fn asperities(found: &GreenwoodWilliamson) -> Asperities {
    [found.density, found.radius, found.height_deviation, found.mean_height]
}

/// m₀, m₂, m₄, the means over x and y of the latter two, the bandwidth, and the asperities.
type Moments = (f64, [f64; 2], [f64; 2], f64, f64, f64, Asperities);

fn moments(found: &SpectralMoments) -> Moments {
    let asperities = asperities(&found.greenwood_williamson());
    (found.m0, found.m2, found.m4, found.mean_m2(), found.mean_m4(), found.bandwidth(), asperities)
}

/// Computes the moments by differences between samples.
#[pyfunction]
pub(crate) fn moments_by_differences(py: Python<'_>, heights: Heights<'_>) -> PyResult<Moments> {
    of(py, &heights, |topography| Ok(moments(&SpectralMoments::by_differences(topography))))
}

/// Hurst exponent and its error, range, points, decades, dimension, and a reason for doubt.
type Law = (f64, f64, [f64; 2], usize, f64, f64, Option<String>);

fn law(found: &SelfAffinity) -> Law {
    let SelfAffinity { hurst, hurst_error, range, points } = *found;
    (hurst, hurst_error, range, points, found.decades(), found.fractal_dimension(), found.doubt())
}

/// Fits the law to the height differences with lags in a range.
#[pyfunction]
pub(crate) fn self_affinity_of_differences(
    py: Python<'_>,
    heights: Heights<'_>,
    axis: &str,
    range: [f64; 2],
) -> PyResult<Law> {
    let axis = word::<Axis>(py, "axis", axis)?;
    of(py, &heights, |topography| {
        SelfAffinity::of_height_differences(&topography.height_differences(axis), range)
            .map(|found| law(&found))
    })
}

/// Returns the lags along an axis and the mean square differences of the heights at each.
#[pyfunction]
pub(crate) fn height_differences(
    py: Python<'_>,
    heights: Heights<'_>,
    axis: &str,
) -> PyResult<Vec<(f64, f64)>> {
    let axis = word::<Axis>(py, "axis", axis)?;
    of(py, &heights, |topography| Ok(topography.height_differences(axis)))
}

/// A power spectral density.
#[pyclass(name = "Spectrum", frozen)]
pub(crate) struct CoreSpectrum(Spectrum);

/// Wave number, density, number of waves.
type Point = (f64, f64, usize);

fn points(points: &[SpectralPoint]) -> Vec<Point> {
    points.iter().map(|point| (point.wave_number, point.density, point.waves)).collect()
}

fn rings(per_decade: Option<u32>) -> Bins {
    per_decade.map_or(Bins::Linear, |per_decade| Bins::Logarithmic { per_decade })
}

#[pymethods]
impl CoreSpectrum {
    #[new]
    fn new(py: Python<'_>, heights: Heights<'_>, window: &str) -> PyResult<Self> {
        let window = word::<Window>(py, "window", window)?;
        of(py, &heights, |topography| Ok(Self(Spectrum::new(topography, window))))
    }

    fn density<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray2<f64>> {
        self.0.density().to_pyarray(py)
    }

    /// Returns the wave numbers along x, of both signs, and along y.
    fn wave_numbers<'py>(&self, py: Python<'py>) -> [Bound<'py, PyArray1<f64>>; 2] {
        let [nx, ny] = [self.0.density().nrows(), self.0.density().ncols()];
        let x: Vec<_> = (0..nx).map(|k| self.0.wave_vector([k, 0])[0]).collect();
        let y: Vec<_> = (0..ny).map(|l| self.0.wave_vector([0, l])[1]).collect();
        [x.into_pyarray(py), y.into_pyarray(py)]
    }

    fn nyquist(&self) -> f64 {
        self.0.nyquist()
    }

    fn variance(&self) -> f64 {
        self.0.variance()
    }

    #[pyo3(signature = (per_decade=None))]
    fn radial(&self, py: Python<'_>, per_decade: Option<u32>) -> PyResult<Vec<Point>> {
        work::run(py, 0, None, |_| Ok(points(&self.0.radial(rings(per_decade)))))
    }

    fn angular<'py>(&self, py: Python<'py>, directions: usize) -> PyResult<Bound<'py, PyArray1<f64>>> {
        Ok(work::run(py, 0, None, |_| Ok(self.0.angular(directions)))?.into_pyarray(py))
    }

    fn along(&self, py: Python<'_>, axis: &str) -> PyResult<Vec<Point>> {
        let axis = word::<Axis>(py, "axis", axis)?;
        work::run(py, 0, None, |_| Ok(points(&self.0.along(axis))))
    }

    fn moments(&self, py: Python<'_>) -> PyResult<Moments> {
        work::run(py, 0, None, |_| Ok(moments(&self.0.moments())))
    }

    /// Fits the law to the points with wave numbers in a range, or to the longest range that follows a law.
    #[pyo3(signature = (range, per_decade))]
    fn self_affinity(&self, py: Python<'_>, range: Option<[f64; 2]>, per_decade: u32) -> PyResult<Law> {
        work::run(py, 0, None, |_| {
            let radial = self.0.radial(rings(Some(per_decade)));
            let found = match range {
                Some(range) => SelfAffinity::of_spectrum(&radial, range),
                None => SelfAffinity::of_longest_range(&radial),
            };
            found.map(|found| law(&found))
        })
    }
}

/// An autocorrelation.
#[pyclass(name = "Correlation", frozen)]
pub(crate) struct CoreCorrelation(Correlation);

#[pymethods]
impl CoreCorrelation {
    #[new]
    fn new(py: Python<'_>, heights: Heights<'_>, periodic: bool) -> PyResult<Self> {
        of(py, &heights, |topography| {
            Ok(Self(match periodic {
                true => Correlation::periodic(topography),
                false => Correlation::new(topography),
            }))
        })
    }

    fn values<'py>(&self, py: Python<'py>) -> Bound<'py, PyArray2<f64>> {
        self.0.values().to_pyarray(py)
    }

    fn variance(&self) -> f64 {
        self.0.variance()
    }

    fn along(&self, py: Python<'_>, axis: &str) -> PyResult<Vec<(f64, f64)>> {
        Ok(self.0.along(word::<Axis>(py, "axis", axis)?))
    }

    fn radial(&self, py: Python<'_>) -> PyResult<Vec<(f64, f64)>> {
        work::run(py, 0, None, |_| Ok(self.0.radial()))
    }

    fn decay_length(&self, angle: f64, level: f64) -> f64 {
        self.0.decay_length(angle, level)
    }

    fn decay_lengths(&self, py: Python<'_>, level: f64) -> PyResult<[f64; 2]> {
        work::run(py, 0, None, |_| Ok(self.0.decay_lengths(level)))
    }
}

/// Summits with sample, height and curvature; the judged area; the asperities.
type SummitData = (Vec<(usize, usize, f64, f64)>, f64, Asperities);

/// Finds the summits.
#[pyfunction]
pub(crate) fn summits(py: Python<'_>, heights: Heights<'_>) -> PyResult<SummitData> {
    of(py, &heights, |topography| {
        let found = Summits::new(topography);
        let all = found.summits.iter();
        let all = all.map(|summit| (summit.sample[0], summit.sample[1], summit.height, summit.curvature));
        Ok((all.collect(), found.area, asperities(&found.greenwood_williamson())))
    })
}

/// Sample, height, saddle, local height, prominence, curvature, area, volume, and whether it is closed.
type Feature = (usize, usize, f64, f64, f64, f64, f64, f64, f64, bool);

/// Segments hills or dales; also returns the number of the hill or dale of each sample.
#[pyfunction]
pub(crate) fn segments<'py>(
    py: Python<'py>,
    heights: Heights<'py>,
    dales: bool,
    pruning: f64,
) -> PyResult<(Bound<'py, PyArray2<u32>>, Vec<Feature>)> {
    let Segmentation { labels, motifs } = of_until(py, &heights, |topography, stop| match dales {
        true => topography.dales_until(pruning, stop),
        false => topography.hills_until(pruning, stop),
    })?;
    let feature = |motif: Motif| {
        let Motif { at: [ix, iy], height, saddle, prominence, curvature, area, volume, closed } = motif;
        (ix, iy, height, saddle, motif.local_height(), prominence, curvature, area, volume, closed)
    };
    Ok((labels.into_pyarray(py), motifs.into_iter().map(feature).collect()))
}
