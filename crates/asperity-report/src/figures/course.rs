//! The course of a motion: curves over the positions of a pass, and over the passes.

use asperity_contact::motion::{IncrementRecord, PassRecord, StepRecord};
use asperity_study::Case;
use asperity_study::case::CounterBody;

use super::Curves;
use super::running;
use crate::draw::{Axis, Chart, Charts, Mark, Series, Unit};

/// A number of a position.
pub(super) type OfStep = fn(&StepRecord) -> f64;
type OfPass = fn(&PassRecord) -> f64;

/// What is drawn over the positions: its figure, its name, its column.
pub(crate) const OVER_POSITIONS: [(&str, &str, &str, OfStep); 7] = [
    ("load", "load", "load", |s| s.load),
    ("friction", "friction force", "tangential_force", |s| s.tangential_force.abs()),
    ("drag", "drag", "drag", |s| s.drag.map_or(f64::NAN, |of| of.drag)),
    ("mean_film", "film", "mean_film", |s| s.film.map_or(f64::NAN, |of| of.mean_film)),
    ("solid_share", "share of the solids in the load", "solid_share", |s| {
        s.film.map_or(f64::NAN, |of| of.solid_share)
    }),
    ("contact_area", "real contact area", "contact_area", |s| s.contact_area),
    ("max_pressure", "largest pressure", "max_pressure", |s| s.max_pressure),
];

/// All curves of a motion whose bodies had these rms heights before it.
pub(crate) fn curves(passes: &[PassRecord], steps: &[StepRecord], sq: [f64; 2]) -> Vec<Curves> {
    let done = done(passes);
    let slides = steps.iter().any(|step| step.tangential_force != 0.0);
    let drags = steps.iter().any(|step| step.drag.is_some());
    let has_film = steps.iter().any(|step| step.film.is_some());
    let shown = OVER_POSITIONS.into_iter().filter(|(name, ..)| match *name {
        "friction" => slides,
        "drag" => drags,
        "mean_film" | "solid_share" => has_film,
        _ => true,
    });
    let mut curves: Vec<Curves> = shown
        .map(|(name, title, column, value)| {
            let charts = over_positions(steps, &done, title, column, value);
            Curves::new(name, format!("{title} over the positions"), charts)
        })
        .collect();
    curves.push(Curves::new("roughness", "roughness over the passes", roughness(passes, &done, sq)));
    let what = if yields(passes) { "approach and plastic volume" } else { "approach" };
    curves.push(Curves::new("approach", format!("{what} over the passes"), approach(passes, &done)));
    curves.push(Curves::new("mean_contact_area", "contact area over the passes", area(passes, &done)));
    curves.extend(mean_drag(passes, &done));
    curves.extend(running::curves(passes, sq));
    curves
}

/// What the solver has left and what it took, over the positions or increments; none of what has neither.
pub(super) fn solution(steps: &[StepRecord], increments: &[IncrementRecord], done: &[usize]) -> Vec<Curves> {
    let title = "residual and cost of the solution";
    if increments.len() > 1 {
        let points = |value: fn(&IncrementRecord) -> f64| {
            increments.iter().map(|i| [i.increment as f64, value(i)]).collect::<Vec<_>>()
        };
        let chart = |y: Axis, points| {
            let x = Axis::linear("increment", Unit::Count);
            Chart::new("", x, y, vec![Series::new("", points, Mark::LineAndPoints)])
        };
        let residual = chart(Axis::log("residual η", Unit::Number), points(|i| i.residual));
        let cost = chart(Axis::of("convolutions", "convolutions"), points(|i| i.convolutions));
        return vec![Curves::new("solution", title, beside([residual, cost]))];
    }
    if steps.is_empty() {
        return Vec::new();
    }
    let residual = over_positions(steps, done, "residual η", "residual", |s| s.residual);
    let cost = over_positions(steps, done, "convolutions", "convolutions", |s| s.convolutions);
    let [mut residual, cost] = [residual, cost].map(|mut charts| charts.charts.remove(0));
    residual.y.log = true;
    vec![Curves::new("solution", title, beside([residual, cost]))]
}

fn beside(charts: [Chart; 2]) -> Charts {
    Charts { charts: charts.into(), columns: 2, aspect: 0.8 }
}

/// Passes of the motion that are done before the first and after each of the computed ones.
pub(crate) fn done(passes: &[PassRecord]) -> Vec<usize> {
    let mut done = vec![0];
    for pass in passes {
        done.push(done[done.len() - 1] + pass.represents());
    }
    done
}

/// Whether the upper body of a pass is another one than that of the first; how it was before is not kept.
pub(crate) fn has_new_upper(case: &Case, pass: usize) -> bool {
    pass > 1 && case.motion.is_some_and(|motion| motion.counter == CounterBody::Fresh)
}

/// A quantity of the positions in the first, a middle and the last pass.
fn over_positions(steps: &[StepRecord], done: &[usize], title: &str, column: &str, value: OfStep) -> Charts {
    let passes = done.len() - 1;
    let mut shown = vec![1, passes.div_ceil(2), passes];
    shown.dedup();
    let series = shown.into_iter().map(|pass| {
        let points = steps.iter().filter(|s| s.pass == pass).map(|s| [s.offset, value(s)]).collect();
        Series::new(format!("pass {}", done[pass]), points, Mark::Line)
    });
    let x = Axis::of("offset of the upper body", "offset");
    Chart::new("", x, Axis::of(title, column), series.collect()).into()
}

fn roughness(passes: &[PassRecord], done: &[usize], sq: [f64; 2]) -> Charts {
    let points = |body: usize, value: OfPass| {
        let first = [0.0, sq[body]];
        std::iter::once(first).chain(passes.iter().map(|p| [done[p.pass] as f64, value(p)])).collect()
    };
    let bodies: [(&str, usize, OfPass); 2] =
        [("lower body", 0, |p| p.sq_lower), ("upper body", 1, |p| p.sq_upper)];
    // A body that does not change would hide the change of the other.
    let changes = |(_, body, value): &(&str, usize, OfPass)| {
        passes.iter().any(|p| (value(p) - sq[*body]).abs() > 1e-6 * sq[*body])
    };
    let some = bodies.iter().any(changes);
    let bodies = bodies.into_iter().filter(|body| !some || changes(body));
    let series =
        bodies.map(|(name, body, value)| Series::new(name, points(body, value), Mark::LineAndPoints));
    Chart::new("", Axis::linear("pass", Unit::Count), Axis::of("Sq", "sq_lower"), series.collect()).into()
}

/// The real contact area of a pass, its mean over the positions.
fn area(passes: &[PassRecord], done: &[usize]) -> Charts {
    let points = |value: OfPass| passes.iter().map(|p| [done[p.pass] as f64, value(p)]).collect();
    let mut series = vec![Series::new("whole", points(|p| p.mean_contact_area), Mark::LineAndPoints)];
    if passes.iter().any(|p| p.mean_contact_area_interior != p.mean_contact_area) {
        let inside = points(|p| p.mean_contact_area_interior);
        series.push(Series::new("without the rim", inside, Mark::LineAndPoints));
    }
    let y = Axis::of("mean contact area", "mean_contact_area");
    Chart::new("", Axis::linear("pass", Unit::Count), y, series).into()
}

/// The drag of viscoelastic bodies over their passes; none of others.
fn mean_drag(passes: &[PassRecord], done: &[usize]) -> Option<Curves> {
    let points = passes.iter().map(|pass| Some([done[pass.pass] as f64, pass.drag?.drag_coefficient]));
    let series = vec![Series::new("", points.collect::<Option<_>>()?, Mark::LineAndPoints)];
    let y = Axis::of("mean drag over load", "drag_coefficient");
    let chart: Charts = Chart::new("", Axis::linear("pass", Unit::Count), y, series).into();
    Some(Curves::new("mean_drag", "drag over the passes", chart))
}

fn approach(passes: &[PassRecord], done: &[usize]) -> Charts {
    let points =
        |value: fn(&PassRecord) -> f64| passes.iter().map(|p| [done[p.pass] as f64, value(p)]).collect();
    let x = Axis::linear("pass", Unit::Count);
    let y = Axis::of("approach", "approach");
    let mut series = vec![Series::new("approach", points(|p| p.approach), Mark::LineAndPoints)];
    if !yields(passes) {
        return Chart::new("", x, y, series).into();
    }
    for (name, value) in [
        ("plastic volume, lower body", (|p| p.lost("plastic")[0]) as fn(&PassRecord) -> f64),
        ("plastic volume, upper body", |p| p.lost("plastic")[1]),
    ] {
        if passes.iter().any(|pass| value(pass) != 0.0) {
            series.push(Series::new(name, points(value), Mark::LineAndPoints).on_the_right());
        }
    }
    let right = Axis::of("plastic volume in the pass", "plastic_volume_lower");
    Chart::new("", x, y, series).with_right(right).into()
}

/// Whether a body has yielded.
fn yields(passes: &[PassRecord]) -> bool {
    passes.iter().any(|pass| pass.lost("plastic") != [0.0; 2])
}
