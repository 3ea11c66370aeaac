//! The force–distance curve of bodies that are no hard walls to each other: the load over their distance, on
//! the way together and apart.

use asperity_contact::motion::IncrementRecord;

use super::{Curve, Curves, force};
use crate::draw::{Axis, Chart, Mark, Series};

/// Increments up to which each has a marker.
const MAX_MARKED: usize = 140;

/// The curve of increments that go together and apart again; none of others, and none between hard walls.
pub(crate) fn curves(increments: &[IncrementRecord]) -> Option<Curves> {
    increments.iter().any(|increment| increment.interface.is_some()).then_some(())?;
    let legs = legs(increments);
    let mark = if increments.len() > MAX_MARKED { Mark::Line } else { Mark::LineAndPoints };
    let series = |name: &str, together: bool| {
        let own: Vec<&Curve> =
            legs.iter().filter(|leg| leg.together == together).map(|leg| &leg.points).collect();
        // Between two ways of one direction the line is broken.
        let points = own.iter().flat_map(|points| points.iter().copied().chain([[f64::NAN; 2]]));
        (!own.is_empty()).then(|| Series::new(name, points.take(points_of(&own)).collect(), mark))
    };
    let (together, apart) = (series("approach", true)?, series("retreat", false)?);
    let least = legs
        .iter()
        .filter(|leg| !leg.together)
        .flat_map(|leg| leg.points.iter().copied())
        .min_by(|a, b| a[1].total_cmp(&b[1]))
        .filter(|[_, load]| *load < 0.0);
    let jumped = |increment: &&IncrementRecord| increment.interface.is_some_and(|record| record.jumps > 0);
    let jumps: Curve = increments.iter().filter(jumped).map(point).collect();
    let mut series = vec![together, apart];
    series.extend(least.map(|least| Series::new("pull-off", vec![least], Mark::Points)));
    if !jumps.is_empty() {
        series.push(Series::new("after a jump", jumps, Mark::Points));
    }
    let words = least.map(|least| {
        let pull = force(least[1]);
        (least, format!("pull-off {pull}"))
    });
    let chart = Chart {
        words: words.into_iter().collect(),
        shaded: Some(("hysteresis".to_owned(), legs.chunks(2).filter_map(loop_of).collect())),
        ..Chart::new("", Axis::of("distance −δ", "approach"), Axis::of("load", "load"), series)
    };
    Some(Curves::new("force_distance", "force–distance curve", chart))
}

/// Number of the points of some curves with a break between each two.
fn points_of(curves: &[&Curve]) -> usize {
    curves.iter().map(|points| points.len() + 1).sum::<usize>() - 1
}

/// A way together or apart; both include their turning points.
struct Leg {
    together: bool,
    points: Curve,
}

fn point(increment: &IncrementRecord) -> [f64; 2] {
    [-increment.approach, increment.load]
}

/// The ways of a loading, one after the other.
fn legs(increments: &[IncrementRecord]) -> Vec<Leg> {
    let mut legs: Vec<Leg> = Vec::new();
    for pair in increments.windows(2) {
        let [from, to] = [point(&pair[0]), point(&pair[1])];
        let together = to[0] < from[0];
        match legs.last_mut() {
            Some(leg) if leg.together == together || to[0] == from[0] => leg.points.push(to),
            _ => legs.push(Leg { together, points: vec![from, to] }),
        }
    }
    legs
}

/// The area between two successive ways, over the distances of both.
fn loop_of(legs: &[Leg]) -> Option<Curve> {
    let [one, other] = legs else { return None };
    let ends = |leg: &Leg| {
        [f64::min, f64::max].map(|pick| leg.points.iter().map(|point| point[0]).fold(f64::NAN, pick))
    };
    let ([a, b], [c, d]) = (ends(one), ends(other));
    let common = [a.max(c), b.min(d)];
    (common[0] < common[1]).then(|| [within(&one.points, common), within(&other.points, common)].concat())
}

/// The part of a curve with x between two ends, cut by linear interpolation.
fn within(curve: &[[f64; 2]], [low, high]: [f64; 2]) -> Curve {
    let mut cut = Vec::new();
    for (index, point) in curve.iter().enumerate() {
        if let Some(before) = index.checked_sub(1).map(|index| curve[index]) {
            // Where the segment crosses the ends, in its order.
            let mut crossings: Curve = [low, high]
                .into_iter()
                .filter(|end| (before[0] - end) * (point[0] - end) < 0.0)
                .map(|end| {
                    let share = (end - before[0]) / (point[0] - before[0]);
                    [end, before[1] + share * (point[1] - before[1])]
                })
                .collect();
            if point[0] < before[0] {
                crossings.reverse();
            }
            cut.extend(crossings);
        }
        if (low..=high).contains(&point[0]) {
            cut.push(*point);
        }
    }
    cut
}

#[cfg(test)]
mod tests {
    use asperity_contact::solver::InterfaceRecord;

    use super::*;

    fn path(points: &[[f64; 2]]) -> Vec<IncrementRecord> {
        let row = |(index, [distance, load]): (usize, &[f64; 2])| {
            let mut row = IncrementRecord::default();
            (row.increment, row.approach, row.load) = (index + 1, -distance, *load);
            row.interface = Some(InterfaceRecord::default());
            row
        };
        points.iter().enumerate().map(row).collect()
    }

    #[test]
    fn the_ways_have_their_turning_points_and_the_least_load_is_marked() {
        let path = path(&[[3.0, 0.0], [1.0, -1.0], [-1.0, 5.0], [1.0, -2.0], [2.0, -3.0], [4.0, 0.0]]);
        let chart = curves(&path).unwrap().charts.charts.remove(0);
        let points: Vec<_> = chart.series.iter().map(|series| series.points.clone()).collect();
        assert_eq!(points[0], [[3.0, 0.0], [1.0, -1.0], [-1.0, 5.0]]);
        assert_eq!(points[1], [[-1.0, 5.0], [1.0, -2.0], [2.0, -3.0], [4.0, 0.0]]);
        assert_eq!(points[2], [[2.0, -3.0]]);
        assert_eq!(chart.words[0].1, "pull-off −3 N");
        // The retreat goes farther than the approach began.
        let (_, loops) = chart.shaded.unwrap();
        assert_eq!(loops[0].last(), Some(&[3.0, -1.5]));
        assert_eq!(loops[0].len(), 7);
    }

    #[test]
    fn a_way_in_one_direction_has_no_such_curve() {
        assert!(curves(&path(&[[1.0, 0.0], [0.0, 1.0]])).is_none());
        let mut without = path(&[[1.0, 0.0], [0.0, 1.0], [1.0, 0.0]]);
        assert!(curves(&without).is_some());
        without.iter_mut().for_each(|increment| increment.interface = None);
        assert!(curves(&without).is_none());
    }
}
