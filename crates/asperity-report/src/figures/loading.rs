//! The figure of a loading: force over displacement, increment after increment.

use asperity_contact::motion::IncrementRecord;

use super::{Curves, fretting};
use crate::draw::{Axis, Chart, Charts, Mark, Series};

/// The curves of a loading of several increments.
pub(crate) fn curves(increments: &[IncrementRecord]) -> Vec<Curves> {
    if increments.iter().any(|increment| increment.creep.is_some()) {
        return over_time(increments);
    }
    let curves = Curves::new("loading", "force over displacement", chart(&fretting::selected(increments)));
    std::iter::once(curves).chain(fretting::curves(increments)).collect()
}

/// A curve over time: the name of the figure, the column, its axis and its value.
type OverTime = (&'static str, &'static str, &'static str, fn(&IncrementRecord) -> f64);

/// The curves over the time of viscoelastic bodies.
const OVER_TIME: [OverTime; 3] = [
    ("creep", "approach", "approach", |i| i.approach),
    ("creep_area", "contact_area", "real contact area", |i| i.contact_area),
    ("creep_load", "load", "load", |i| i.load),
];

fn over_time(increments: &[IncrementRecord]) -> Vec<Curves> {
    let time = |increment: &IncrementRecord| increment.creep.map_or(0.0, |creep| creep.time);
    let curve = |(name, column, label, y): OverTime| {
        let points = increments.iter().map(|increment| [time(increment), y(increment)]).collect();
        let series = vec![Series::new("", points, Mark::LineAndPoints)];
        let chart = Chart::new("", Axis::of("time", "time"), Axis::of(label, column), series);
        Curves::new(name, format!("{label} over time"), chart)
    };
    OVER_TIME.into_iter().map(curve).collect()
}

/// Force over displacement in the plane, or where nothing acts there, load over approach.
fn chart(increments: &[IncrementRecord]) -> Charts {
    // What rounding leaves of a force that is not there does not count.
    let acts = |i: &IncrementRecord| i.tangential_force_x.hypot(i.tangential_force_y) > 1e-8 * i.load.abs();
    if increments.iter().any(acts) { pushing(increments) } else { pressing(increments) }
}

fn pressing(increments: &[IncrementRecord]) -> Charts {
    let axes = [Axis::of("approach", "approach"), Axis::of("load", "load")];
    course(increments, axes, None, |i| [i.approach, i.load])
}

/// Along the direction of the loading.
fn pushing(increments: &[IncrementRecord]) -> Charts {
    let [x, y] = direction(increments);
    let along = match [x, y] {
        [1.0, 0.0] => "along x".to_owned(),
        [0.0, 1.0] => "along y".to_owned(),
        _ => format!("along {:.1}° from x to y", y.atan2(x).to_degrees()).replace('-', "−"),
    };
    let axes = [
        Axis::of(format!("displacement of the upper body {along}"), "tangential_displacement"),
        Axis::of(format!("force {along}"), "tangential_force"),
    ];
    course(increments, axes, Some([0.0, 0.0]), |i| {
        [
            x * i.tangential_displacement_x + y * i.tangential_displacement_y,
            x * i.tangential_force_x + y * i.tangential_force_y,
        ]
    })
}

/// A line from the start through the points of the increments, with arrows along it and where its stages end.
fn course(
    increments: &[IncrementRecord],
    [x, y]: [Axis; 2],
    start: Option<[f64; 2]>,
    point: impl Fn(&IncrementRecord) -> [f64; 2],
) -> Charts {
    let points: Vec<[f64; 2]> = start.into_iter().chain(increments.iter().map(&point)).collect();
    let last = |(i, increment): (usize, &IncrementRecord)| {
        let ends = increments.get(i + 1).is_none_or(|next| next.stage != increment.stage);
        ends.then(|| (point(increment), format!("end of stage {}", increment.stage)))
    };
    let ends: Vec<_> = increments.iter().enumerate().filter_map(last).collect();
    let places = ends.iter().map(|(point, _)| *point).collect();
    let mut words: Vec<([f64; 2], String)> = Vec::new();
    for (point, end) in ends {
        // Stages that end where others did share their words.
        match words.iter_mut().find(|(other, _)| near(*other, point, &points)) {
            Some((_, words)) => words.push_str(&end.replace("end of stage ", ", ")),
            None => words.push((point, end)),
        }
    }
    let series = vec![
        Series::new("loading", points, Mark::Arrows),
        Series::new("end of a stage", places, Mark::Points),
    ];
    Chart { words, ..Chart::new("", x, y, series) }.into()
}

/// Whether two points are the same but for 2 % of the largest of all.
fn near(a: [f64; 2], b: [f64; 2], all: &[[f64; 2]]) -> bool {
    let largest = |axis: usize| all.iter().map(|point| point[axis].abs()).fold(0.0, f64::max);
    (0..2).all(|axis| (a[axis] - b[axis]).abs() <= 0.02 * largest(axis))
}

/// The direction in which a contact is loaded: that of most of its force, signed towards +x, or towards +y
/// where it lies along y. Rounding decides neither the axis nor the sign: a force to and fro along x has the
/// direction +x.
pub(super) fn direction(increments: &[IncrementRecord]) -> [f64; 2] {
    let forces = || increments.iter().map(|i| [i.tangential_force_x, i.tangential_force_y]);
    // The principal axis of the forces, which has no sign yet.
    let [xx, yy, xy] = forces().fold([0.0; 3], |s, [x, y]| [s[0] + x * x, s[1] + y * y, s[2] + x * y]);
    let angle = 0.5 * (2.0 * xy).atan2(xx - yy);
    let (y, x) = angle.sin_cos();
    /// Component of a unit vector that is rounding.
    const ROUNDING: f64 = 1e-6;
    match [x, y] {
        [_, y] if y.abs() < ROUNDING => [1.0, 0.0],
        [x, _] if x.abs() < ROUNDING => [0.0, 1.0],
        [x, y] if x < 0.0 => [-x, -y],
        both => both,
    }
}
