//! Figures of a sweep: what changes from point to point.

use asperity_contact::motion::SweepRecord;
use asperity_contact::solver::Friction;
use asperity_contact::with;
use asperity_contact::with::views::{BesidePoints, OfPoints};
use asperity_study::Case;
use asperity_study::case::Prescribed;

use super::sheet::Sheet;
use super::theories::Theories;
use super::{Curves, force};
use crate::draw::{Axis, Chart, Mark, Series, Unit};
use crate::error::Result;

type Number = fn(&SweepRecord) -> f64;

/// The curves of the contact. The mean gap falls with the logarithm of the load.
const DRAWN: [OfPoints; 5] = [
    drawn("contact_area", "real contact area", true, |p| Some(p.contact_area)),
    drawn("mean_gap", "mean gap", false, |p| Some(p.mean_gap)),
    drawn("stiffness", "normal stiffness", true, |p| p.stiffness),
    drawn("max_pressure", "largest pressure", true, |p| Some(p.max_pressure)),
    drawn("max_plastic_strain", "largest plastic strain", false, |p| Some(p.plastic?.max_plastic_strain)),
];

const fn drawn(
    column: &'static str,
    label: &'static str,
    may_be_log: bool,
    value: fn(&SweepRecord) -> Option<f64>,
) -> OfPoints {
    OfPoints { column, label, may_be_log, value, beside: &[] }
}

pub(super) fn draw(
    points: &[SweepRecord],
    case: &Case,
    theories: Option<&Theories>,
    sheet: &mut Sheet,
) -> Result {
    let of = loads_in_words(points);
    curves(points, case, theories).into_iter().try_for_each(|curves| sheet.add_curves(curves, &of))
}

/// The loads of a sweep, as subtitles name them.
pub(super) fn loads_in_words(points: &[SweepRecord]) -> String {
    let [from, to] = loads(points).map(force);
    if from == to { format!("load {from}") } else { format!("load {from} to {to}") }
}

/// All curves of a sweep of at least one point, beside theories of rough bodies.
pub(crate) fn curves(points: &[SweepRecord], case: &Case, theories: Option<&Theories>) -> Vec<Curves> {
    if let Some(friction) = case.friction.as_ref().filter(|friction| friction.sweeps()) {
        // Bodies that attract each other slide under more than their load.
        let limit = case.interface.is_empty().then_some(&friction.law);
        return traction(points, limit).into_iter().collect();
    }
    let (column, x): (_, Number) = match case.contact.prescribed() {
        _ if points.iter().any(|point| point.speed.is_some()) => {
            ("speed", |point| point.speed.unwrap_or(f64::NAN))
        }
        Prescribed::Load(_) => ("load", |point| point.load),
        Prescribed::MeanPressure(_) => ("mean_pressure", |point| point.mean_pressure),
        Prescribed::Approach(_) => ("approach", |point| point.approach),
    };
    let swept = column.replace('_', " ");
    // The points in the order of what is swept, whatever order they were given in.
    let mut ordered: Vec<&SweepRecord> = points.iter().collect();
    ordered.sort_by(|a, b| x(a).total_cmp(&x(b)));
    let [least, most] = [f64::min, f64::max].map(|pick| points.iter().map(x).fold(f64::NAN, pick));
    let log = least > 0.0 && most >= DECADE * least;
    // Only hard walls have a stiffness.
    let all = with::of_points().into_iter().chain(DRAWN);
    let known =
        all.filter(|drawn| points.iter().any(|point| (drawn.value)(point).is_some_and(f64::is_finite)));
    let drawn = known.map(|OfPoints { column: name, label, may_be_log, value, beside }| {
        let curve = |value: fn(&SweepRecord) -> Option<f64>| {
            ordered.iter().map(|point| [x(point), value(point).unwrap_or(f64::NAN)]).collect::<Vec<_>>()
        };
        let theories = of_theories(theories, name, &ordered, x);
        let own = if theories.is_empty() { "" } else { "computed" };
        let alone = BesidePoints { name: own, value, is_dashed: false };
        let all = if beside.is_empty() { std::slice::from_ref(&alone) } else { beside };
        let series = all.iter().filter_map(|BesidePoints { name, value, is_dashed }| {
            let mark = if *is_dashed { Mark::Dashed } else { Mark::LineAndPoints };
            let curve = curve(*value);
            curve.iter().any(|[_, y]| y.is_finite()).then(|| Series::new(*name, curve, mark))
        });
        let series = series.chain(theories).collect();
        let horizontal = Axis { log, ..Axis::of(swept.as_str(), column) };
        let vertical = Axis { log: log && may_be_log, ..Axis::of(label, name) };
        Curves::new(name, format!("{label} over {swept}"), Chart::new("", horizontal, vertical, series))
    });
    drawn.collect()
}

/// The theories of a column, over what is swept.
fn of_theories(
    theories: Option<&Theories>,
    column: &str,
    ordered: &[&SweepRecord],
    x: Number,
) -> Vec<Series> {
    let (Some(theories), Some(first)) = (theories, ordered.first()) else { return Vec::new() };
    let names = theories.beside(column, first).into_iter().map(|(name, _)| name).enumerate();
    names
        .map(|(n, name)| {
            let values = ordered.iter().map(|point| [x(point), theories.beside(column, point)[n].1]);
            Series::new(name, values.collect(), Mark::Dashed)
        })
        .collect()
}

/// The smallest and the largest load.
fn loads(points: &[SweepRecord]) -> [f64; 2] {
    [f64::min, f64::max].map(|pick| points.iter().map(|p| p.load).fold(f64::NAN, pick))
}

/// The force ratio over the creepage, along x and along y, under what all that slides bears by the law of
/// friction, if one is given. `None` if there is no such ratio.
///
/// Over the creepage with its sign where that has one direction, over its amount elsewhere.
fn traction(points: &[SweepRecord], friction: Option<&Friction>) -> Option<Curves> {
    /// Component, creepage and traction coefficient along each axis.
    const ALONG: [(&str, Number, Number); 2] = [
        ("along x", |p| p.creepage_x, |p| p.traction().map_or(f64::NAN, |[x, _]| x)),
        ("along y", |p| p.creepage_y, |p| p.traction().map_or(f64::NAN, |[_, y]| y)),
    ];
    /// What rounding leaves of a component that is not there.
    const NOTHING: f64 = 1e-6;
    let largest = |value: Number| points.iter().map(|p| value(p).abs()).fold(0.0, f64::max);
    let one_direction = ALONG.iter().position(|(_, creepage, _)| largest(*creepage) == 0.0);
    let x = |point: &SweepRecord| match one_direction {
        Some(across) => ALONG[1 - across].1(point),
        None => point.creepage_x.hypot(point.creepage_y),
    };
    let mut ordered: Vec<&SweepRecord> = points.iter().collect();
    ordered.sort_by(|a, b| x(a).total_cmp(&x(b)));
    let strongest = ALONG.map(|(.., ratio)| largest(ratio));
    let shown = ALONG.iter().zip(strongest);
    let shown: Vec<_> = shown
        .filter(|(_, most)| *most > NOTHING * strongest[0].max(strongest[1]))
        .map(|(of, _)| of)
        .collect();
    let curve = |ratio: Number| ordered.iter().map(|point| [x(point), ratio(point)]).collect::<Vec<_>>();
    if shown.is_empty() {
        return None;
    }
    let mut series: Vec<Series> =
        shown.iter().map(|(name, _, ratio)| Series::new(*name, curve(*ratio), Mark::LineAndPoints)).collect();
    // Under a film's shear strength what slides bears less.
    let limit = friction.filter(|law| law.coefficient.is_finite() && law.shear_strength.is_infinite());
    if let Some(Friction { coefficient, .. }) = limit {
        let signs = [1.0, -1.0].into_iter().filter(|sign| {
            points.iter().any(|point| shown.iter().any(|(.., ratio)| sign * ratio(point) > 0.0))
        });
        let ends = [ordered.first(), ordered.last()].into_iter().flatten();
        let ends: Vec<f64> = ends.map(|point| x(point)).collect();
        series.extend(signs.enumerate().map(|(k, sign)| {
            let name = if k == 0 { "full sliding" } else { "" };
            let limit = ends.iter().map(|x| [*x, sign * coefficient]).collect();
            Series::new(name, limit, Mark::Dashed)
        }));
    }
    let across = match one_direction {
        Some(0) => "creepage along y",
        Some(_) => "creepage along x",
        None => "creepage",
    };
    let [horizontal, vertical] =
        [across, "tangential force over load"].map(|l| Axis::linear(l, Unit::Number));
    let chart = Chart::new("", horizontal, vertical, series);
    Some(Curves::new("traction", "tangential force over creepage", chart))
}

/// From such a ratio of the largest to the least on what is swept is drawn by its logarithm.
const DECADE: f64 = 10.0;
