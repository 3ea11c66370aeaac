//! Curves of the bodies' surfaces: material ratio and spectrum.

use asperity_surface::{Bins, SpectralPoint, Spectrum, Topography, Window};

use super::Curves;
use super::stored::StoredArray;
use crate::draw::{Axis, Chart, Charts, Mark, Series, Unit};
use crate::error::Result;

/// Rings over which spectra are averaged.
pub const RINGS: Bins = Bins::Logarithmic { per_decade: 10 };

/// Points of a material ratio curve.
const POINTS: usize = 257;

/// Names of the curves.
pub(super) const NAMES: [&str; 2] = ["material_ratio", "spectrum"];

/// Both bodies with their material below, as they were measured: the underside is turned over.
pub(crate) fn as_measured([lower, upper]: &[StoredArray; 2]) -> Result<[Topography; 2]> {
    let of = |stored: &StoredArray| Topography::new(stored.grid, stored.field.clone());
    Ok([of(lower)?, of(upper)?.underside()])
}

/// Curves of both bodies at rest. The curves of a body take as much memory as several fields, so that those
/// of the second are made after those of the first, which is dropped before.
pub(super) fn at_rest([lower, upper]: [StoredArray; 2]) -> Result<Vec<Curves>> {
    let of = |stored: StoredArray| Topography::new(stored.grid, stored.field);
    let charts = |body: Topography, title: &str| {
        let states = [("", &body)];
        rayon::join(|| material_ratio(&states, title), || spectrum(&states, title))
    };
    let (lower_ratio, lower_spectrum) = charts(of(lower)?, BODIES[0]);
    let (upper_ratio, upper_spectrum) = charts(of(upper)?.underside(), BODIES[1]);
    Ok(with_points([vec![lower_ratio, upper_ratio], vec![lower_spectrum, upper_spectrum]]))
}

/// The chart of a body from its states with their names, and a title.
type OfStates<'a> = &'a dyn Fn(&[(&str, &Topography)], &str) -> Chart;

/// The curves of both bodies, material upwards, before and, of a body that has changed, after.
pub(crate) fn curves(before: &[Topography; 2], after: Option<&[Topography; 2]>) -> Vec<Curves> {
    let charts = |chart: OfStates<'_>| {
        let body = |(index, title): (usize, &str)| {
            let now = changed(before, after, index).map(|after| ("after", after));
            let before = (if now.is_some() { "before" } else { "" }, &before[index]);
            chart(&[Some(before), now].into_iter().flatten().collect::<Vec<_>>(), title)
        };
        BODIES.into_iter().enumerate().map(body).collect()
    };
    with_points([charts(&material_ratio), charts(&spectrum)])
}

const BODIES: [&str; 2] = ["lower body", "upper body"];

/// The curves of these charts, without those that have no points.
fn with_points([ratios, spectra]: [Vec<Chart>; 2]) -> Vec<Curves> {
    let charts = |charts| Charts { charts, columns: 2, aspect: 0.8 };
    let [ratio, densities] = NAMES;
    let mut curves = [
        Curves::new(ratio, "material ratio (Abbott–Firestone) curves", charts(ratios)),
        Curves::new(densities, "power spectral densities, over all directions", charts(spectra)),
    ];
    // A plane has no spectrum.
    let has_points = |chart: &Chart| chart.series.iter().any(|series| series.points.len() > 1);
    for Curves { charts, .. } in &mut curves {
        charts.charts.retain(has_points);
        charts.columns = charts.charts.len();
    }
    curves.into_iter().filter(|curves| !curves.charts.charts.is_empty()).collect()
}

/// A body as it is afterwards; none where it is as it was before.
pub(crate) fn changed<'a>(
    before: &[Topography; 2],
    after: Option<&'a [Topography; 2]>,
    index: usize,
) -> Option<&'a Topography> {
    after.map(|after| &after[index]).filter(|after| after.heights() != before[index].heights())
}

/// What is before is drawn broken, so that neither hides the other.
fn mark(when: &str) -> Mark {
    if when == "before" { Mark::Dashed } else { Mark::Line }
}

fn material_ratio(bodies: &[(&str, &Topography)], title: &str) -> Chart {
    let series = bodies.iter().filter_map(|(when, body)| {
        let curve = body.bearing_curve().ok()?.sampled(POINTS);
        let per_cent = curve.into_iter().map(|[ratio, z]| [100.0 * ratio, z]).collect();
        Some(Series::new(*when, per_cent, mark(when)))
    });
    let x = Axis { range: Some([0.0, 100.0]), ..Axis::linear("material ratio", Unit::Of("%")) };
    Chart::new(title, x, Axis::linear("height above the mean", Unit::Length), series.collect())
}

fn spectrum(bodies: &[(&str, &Topography)], title: &str) -> Chart {
    let series = bodies.iter().map(|(when, body)| {
        // A plane has none, which takes as long to find out.
        let first = body.heights()[[0, 0]];
        let is_flat = body.heights().iter().all(|z| *z == first);
        let radial = if is_flat { Vec::new() } else { Spectrum::new(body, Window::Hann).radial(RINGS) };
        let shown = |p: &&SpectralPoint| p.wave_number > 0.0 && p.density > 0.0;
        let points = radial.iter().filter(shown).map(|p| [p.wave_number, p.density]).collect();
        Series::new(*when, points, mark(when))
    });
    let series = series.collect();
    Chart::new(title, Axis::log("wave number", Unit::Wavenumber), Axis::log("C", Unit::Of("m⁴")), series)
}
