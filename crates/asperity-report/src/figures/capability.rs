//! Figures of the capabilities: the curves and maps that each declares.

use asperity_base::units::{Dimension, format};
use asperity_base::{Field, Grid};
use asperity_contact::each;
use asperity_contact::with::views::{
    Curve, Map as MapOf, OverPressure, Scale, Series as SeriesOf, closing, exponent, over_pressure,
};
use asperity_contact::with::{Capability, Listed, Row, of_last};
use asperity_study::Results;
use asperity_study::io::fields::Fields;

use super::Curves;
use super::sheet::Sheet;
use super::stored::StoredArray;
use crate::draw::{Axis, Chart, Colours, Map, Maps, Mark, Quantity, Series, Unit};
use crate::error::Result;

/// From such a ratio of the largest to the smallest value an axis is logarithmic.
const DECADE: f64 = 10.0;
/// Relative change of the load from which the curves are drawn over the mean pressure.
const LOADED: f64 = 0.01;

/// Draws the figures. The curves have all contacts, `of_all`, and the maps the last one, `of`.
///
/// `done` are the passes of a motion that are done before the first and after each of the computed ones.
pub(super) fn draw(results: &Results, done: &[usize], of: &str, of_all: &str, sheet: &mut Sheet) -> Result {
    let case = results.case()?;
    each!(capability C => if C::of(&case.with).is_some() {
        let rows = results.rows::<C>()?;
        curves::<C>(&rows, done).into_iter().try_for_each(|curves| sheet.add_curves(curves, of_all))?;
        let fields = match (load_cycle::<C>(&rows), rows.last()) {
            (Some(number), _) => Some(results.observed_fields(C::NAME, number)),
            // The fields of a static contact are those of its last contact.
            (None, Some(last)) if last.pass().is_none() => Some(results.static_fields()),
            _ => None,
        };
        if let Some(fields) = fields.transpose()? {
            maps::<C>(&fields, &C::summary(&rows), of, sheet)?;
        }
    });
    Ok(())
}

/// Number in the name of the file of the last load cycle: its pass, or its last increment. `None` for a
/// capability of single contacts.
pub(crate) fn load_cycle<C: Capability>(rows: &[C::Row]) -> Option<usize> {
    let last = rows.last().filter(|_| C::OF_LOAD_CYCLES)?;
    last.pass().or(last.cycle().map(|[increment, _]| increment))
}

/// The maps of the last contact, whose `rows` there are.
fn maps<C: Capability>(fields: &Fields, rows: &[C::Row], of: &str, sheet: &mut Sheet) -> Result {
    let (names, Some(row)) = (fields.names()?, rows.last()) else { return Ok(()) };
    for map in C::MAPS.iter().filter(|map| names.iter().any(|name| name == map.field)) {
        let stored = StoredArray::read(fields, map.field)?;
        if stored.field.iter().all(|value| *value == 0.0) {
            continue;
        }
        let quantity = Quantity::new(map.quantity, Unit::of_field((map.unit)(row)));
        let place = rows.iter().find_map(|row| (map.mark)(row, map.field));
        sheet.add(map.field, map.title, of, || {
            Ok(field_map(map, &stored.field, &stored.grid, quantity, place))
        })?;
    }
    Ok(())
}

/// Whether a map with this scale is logarithmic, and down to which share of its largest value, if it has a
/// limit.
pub(crate) fn logarithmic(scale: Scale, field: &Field) -> Option<Option<f64>> {
    match scale {
        Scale::FromZeroOrLogarithmic => field.iter().all(|value| *value > 0.0).then_some(None),
        Scale::Logarithmic(least) => Some(Some(least)),
    }
}

/// The map of a field, with a mark at its place.
pub fn field_map<'a, R>(
    map: &MapOf<R>,
    field: &'a Field,
    grid: &Grid,
    quantity: Quantity,
    place: Option<[f64; 2]>,
) -> Maps<'a> {
    let extent = grid.extent();
    let draw = |colours| {
        if map.is_section {
            Map::section("", field, [[0.0, extent[0]], [0.0, extent[1]]], quantity, colours)
        } else {
            Map::new("", field, grid, quantity, colours)
        }
    };
    let drawn = match logarithmic(map.scale, field) {
        None => draw(Colours::Pressure),
        Some(None) => draw(Colours::Logarithmic),
        Some(Some(least)) => {
            let largest = field.iter().copied().fold(0.0, f64::max);
            draw(Colours::Logarithmic).range([least * largest, largest])
        }
    };
    Maps::new(vec![match place {
        Some(place) => drawn.marked(place, map.marked),
        None => drawn,
    }])
}

/// The curves of a capability over the loads of a sweep, or over the passes or cycles, and over the contacts
/// of the last pass; none for a single contact.
pub(crate) fn curves<C: Capability>(rows: &[C::Row], done: &[usize]) -> Vec<Curves> {
    let of_last: Vec<&C::Row> = of_last(rows).collect();
    let mut curves = Vec::new();
    for curve in C::CURVES {
        let over_cycles = over_cycles(curve, rows, done);
        let name = curve.names[usize::from(over_cycles.is_some())];
        curves.extend(over_cycles);
        curves.extend(over_contacts(curve, &of_last, name));
    }
    curves
}

/// A curve over the passes of a motion or the cycles of a loading, with the mean over the contacts of each;
/// none for a single one.
fn over_cycles<R: Row>(curve: &Curve<R>, rows: &[R], done: &[usize]) -> Option<Curves> {
    let after = |row: &R| match row.cycle() {
        Some([_, done]) => Some(done as f64),
        None => row.pass().and_then(|pass| done.get(pass)).map(|done| *done as f64),
    };
    let points = |series: &SeriesOf<R>| -> Vec<[f64; 2]> {
        let rows: Vec<_> = rows.iter().filter(|row| (series.has)(row)).collect();
        let mean = |rows: &[&R]| {
            let sum = rows.iter().map(|row| (series.value)(row)).sum::<Option<f64>>();
            Some([after(rows[0])?, sum.map_or(f64::NAN, |sum| sum / rows.len() as f64)])
        };
        let of = |row: &R| (row.pass(), row.cycle());
        rows.chunk_by(|one, other| of(one) == of(other)).filter_map(mean).collect()
    };
    let drawn = curve.series.iter().filter(|series| !series.is_beside);
    let drawn = drawn
        .map(|series| (series, points(series)))
        .filter(|(_, points)| points.iter().any(|[_, y]| y.is_finite()));
    let drawn: Vec<_> = drawn.collect();
    if drawn.iter().all(|(_, points)| points.len() < 2) {
        return None;
    }
    // A single curve needs no name.
    let is_alone = drawn.len() == 1;
    let series = drawn.into_iter().map(|(series, points)| {
        let name = if is_alone { "" } else { series.name };
        Series::new(name, points, if series.is_dashed { Mark::Dashed } else { Mark::LineAndPoints })
    });
    let first = rows.first()?;
    let [of, all] = if first.cycle().is_some() { ["cycle", "cycles"] } else { ["pass", "passes"] };
    let (x, y) = (Axis::linear(of, Unit::Count), Axis::of(curve.title, (curve.column)(first)));
    let chart = Chart::new("", x, y, series.collect());
    let title = format!("{} over the {all}", curve.title);
    Some(Curves { caption: curve.caption, ..Curves::new(curve.names[0], title, chart) })
}

/// A curve over the contacts; none for a single one.
fn over_contacts<R: Row>(curve: &Curve<R>, rows: &[&R], name: &'static str) -> Option<Curves> {
    let of =
        |series: &SeriesOf<R>| -> Vec<&R> { rows.iter().copied().filter(|row| (series.has)(row)).collect() };
    if curve.series.iter().all(|series| of(series).len() < 2) {
        return None;
    }
    let order = Order::of(rows);
    let series = curve.series.iter().filter_map(|series| {
        let rows = of(series);
        let mark = match rows.iter().filter(|row| (series.value)(row).is_some()).count() {
            0 => return None,
            // A single number has no line.
            2.. if series.is_dashed => Mark::Dashed,
            _ => Mark::LineAndPoints,
        };
        let name = format!("{}{}", series.name, order.course(series, &rows));
        Some(Series::new(name, order.points(series, &rows), mark))
    });
    let series = series.collect();
    let vertical = Axis { log: order.log, ..Axis::of(curve.title, (curve.column)(rows.first()?)) };
    let over = if order.by_pressure { " over mean pressure" } else { ", contact after contact" };
    let chart = Chart::new("", order.axis(), vertical, series);
    let title = format!("{}{over}", curve.title);
    Some(Curves { caption: curve.caption, ..Curves::new(name, title, chart) })
}

/// How the contacts are lined up: by their mean pressure, or one after another.
struct Order {
    by_pressure: bool,
    log: bool,
}

impl Order {
    fn of<R: Row>(rows: &[&R]) -> Self {
        let pressures = || rows.iter().map(|row| row.mean_pressure());
        let [least, most] = [f64::min, f64::max].map(|pick| pressures().fold(f64::NAN, pick));
        let by_pressure = most > (1.0 + LOADED) * least;
        Self { by_pressure, log: by_pressure && least > 0.0 && most >= DECADE * least }
    }

    fn axis(&self) -> Axis {
        if self.by_pressure {
            Axis { log: self.log, ..Axis::of("mean pressure", "mean_pressure") }
        } else {
            Axis::linear("contact", Unit::Number)
        }
    }

    /// The points of a curve. A value of 0 has no logarithm.
    fn points<R: Row>(&self, series: &SeriesOf<R>, rows: &[&R]) -> Vec<[f64; 2]> {
        let shown = |value: f64| if value > 0.0 || !self.log { value } else { f64::NAN };
        let point = |(index, row): (usize, &&R)| {
            let place = if self.by_pressure { row.mean_pressure() } else { index as f64 + 1.0 };
            [place, shown((series.value)(row).unwrap_or(f64::NAN))]
        };
        let mut points: Vec<[f64; 2]> = rows.iter().enumerate().map(point).collect();
        points.sort_by(|one, other| one[0].total_cmp(&other[0]));
        points
    }

    /// Describes the course of a curve over the pressure, after its name.
    fn course<R: Row>(&self, series: &SeriesOf<R>, rows: &[&R]) -> String {
        let point = |row: &&R| [row.mean_pressure(), (series.value)(row).unwrap_or(0.0)];
        match series.over_pressure {
            OverPressure::End if self.by_pressure => closing(rows.iter().map(point))
                .map_or(String::new(), |end| format!(", closed from {}", format(end, Dimension::Pressure))),
            OverPressure::Exponent if self.by_pressure => {
                // A loading history has no one value at a pressure.
                let power = exponent(over_pressure(rows, |row| row.mean_pressure()).iter().map(point));
                power.map_or(String::new(), |power| format!(", as the power {power:.2} of the pressure"))
            }
            _ => String::new(),
        }
    }
}
