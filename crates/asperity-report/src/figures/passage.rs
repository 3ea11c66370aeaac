//! Figures of what a contact lets through: heat or current, and a fluid.

use asperity_base::units::{Dimension, format};
use asperity_base::{Field, Grid};
use asperity_study::io::fields::Fields;
use asperity_study::{ConductanceRecord, GapFlowRecord, Results};
use asperity_surface::Axis as Direction;

use super::Curves;
use super::sheet::Sheet;
use super::stored::StoredArray;
use crate::draw::{Axis, Chart, Colours, Map, Maps, Mark, Quantity, Series, Unit};
use crate::error::Result;

/// From such a ratio of the largest to the smallest value an axis is logarithmic.
const DECADE: f64 = 10.0;
/// Smallest flow with a colour of its own over the largest: dead ends carry next to nothing.
pub(crate) const LEAST_FLOW: f64 = 1e-6;
/// Relative change of the load from which the curves are drawn over the mean pressure.
const LOADED: f64 = 0.01;

/// Draws the figures. The curves have all contacts, `of_all`, and the maps the last one, `of`.
///
/// `done` are the passes of a motion that are done before the first and after each of the computed ones.
pub(super) fn draw(results: &Results, done: &[usize], of: &str, of_all: &str, sheet: &mut Sheet) -> Result {
    let (conductance, flow) = (results.conductance()?, results.flow()?);
    curves(&conductance, &flow, done).into_iter().try_for_each(|curves| sheet.add_curves(curves, of_all))?;
    // The fields of a static contact are those of its last contact.
    if conductance.iter().all(|row| row.pass.is_none()) && flow.iter().all(|row| row.pass.is_none()) {
        maps(&results.static_fields()?, GapFlowRecord::last(&flow), of, sheet)?;
    }
    Ok(())
}

/// The maps of flux and flow, with the critical constriction.
fn maps(fields: &Fields, flow: &[GapFlowRecord], of: &str, sheet: &mut Sheet) -> Result {
    let names = fields.names()?;
    let given = |name: &str| names.iter().any(|given| given == name);
    if given("flux") {
        let flux = StoredArray::read(fields, "flux")?;
        let unit = Unit::Of(if fields.read("flux")?.unit == "A/m²" { "A/m²" } else { "W/m²" });
        if flux.field.iter().any(|flux| *flux > 0.0) {
            sheet.add("flux", FLUX, of, || Ok(flux_map(&flux.field, &flux.grid, unit)))?;
        }
    }
    for row in flow {
        let (name, title) = FLOW[row.along as usize];
        if !given(name) || row.leakage == 0.0 {
            continue;
        }
        let rate = StoredArray::read(fields, name)?;
        let place = row.critical_x.zip(row.critical_y).map(|(x, y)| [x, y]);
        let quantity = Quantity::new("flow per width", Unit::Of("m²/s"));
        sheet.add(name, title, of, || Ok(flow_map(&rate.field, &rate.grid, quantity, place)))?;
    }
    Ok(())
}

/// Title of the map of a flux.
pub const FLUX: &str = "flux through the contact";
/// Names and titles of the maps of a flow along x and along y.
pub const FLOW: [(&str, &str); 2] = [
    ("flow_x", "flow through the gap under a pressure that falls along x"),
    ("flow_y", "flow through the gap under a pressure that falls along y"),
];

/// Whether a flux passes through all cells: without gas all of it passes through the spots; with gas the spots would hide what
/// passes beside them.
pub(crate) fn passes_everywhere(flux: &Field) -> bool {
    flux.iter().all(|flux| *flux > 0.0)
}

/// The map of a flux through a contact.
pub fn flux_map<'a>(flux: &'a Field, grid: &Grid, unit: Unit) -> Maps<'a> {
    let colours = if passes_everywhere(flux) { Colours::Logarithmic } else { Colours::Pressure };
    Maps::new(vec![Map::new("", flux, grid, Quantity::new("flux", unit), colours)])
}

/// The map of the flow through a gap, with the critical constriction at its place.
pub fn flow_map<'a>(rate: &'a Field, grid: &Grid, quantity: Quantity, place: Option<[f64; 2]>) -> Maps<'a> {
    let largest = rate.iter().copied().fold(0.0, f64::max);
    let map = Map::new("", rate, grid, quantity, Colours::Logarithmic).range([LEAST_FLOW * largest, largest]);
    Maps::new(vec![match place {
        Some(place) => map.marked(place, "critical constriction"),
        None => map,
    }])
}

/// The curves over the loads of a sweep, or over the passes, and over the contacts of the last pass; none for a single contact.
pub(crate) fn curves(
    conductance: &[ConductanceRecord],
    flow: &[GapFlowRecord],
    done: &[usize],
) -> Vec<Curves> {
    let mut curves: Vec<Curves> = over_passes(conductance, flow, done);
    let last = conductance.last().map(|row| row.pass);
    let conductance: Vec<_> = conductance.iter().filter(|row| Some(row.pass) == last).collect();
    let last = flow.last().map(|row| row.pass);
    let flow: Vec<_> = flow.iter().filter(|row| Some(row.pass) == last).collect();
    let names = match curves.is_empty() {
        true => ["joint_conductance", "leakage"],
        false => ["joint_conductance_positions", "leakage_positions"],
    };
    curves.extend(of_conductance(&conductance, names[0]));
    curves.extend(of_flow(&flow, names[1]));
    curves
}

/// The curves over the passes, with the mean over the contacts of each; none for a single pass.
fn over_passes(conductance: &[ConductanceRecord], flow: &[GapFlowRecord], done: &[usize]) -> Vec<Curves> {
    let after = |pass: Option<usize>| pass.and_then(|pass| done.get(pass)).map(|done| *done as f64);
    let mut curves = Vec::new();
    let mut add = |name, title, column, named: Vec<(&str, Vec<[f64; 2]>, Mark)>| {
        if named.iter().any(|(_, points, _)| points.len() > 1) {
            let series =
                named.into_iter().map(|(name, points, mark)| Series::new(name, points, mark)).collect();
            let (x, y) = (Axis::linear("pass", Unit::Count), Axis::of(title, column));
            let chart = Chart::new("", x, y, series);
            curves.push(Curves::new(name, format!("{title} over the passes"), chart));
        }
    };
    let means = ConductanceRecord::means(conductance);
    if let Some(first) = means.first() {
        let points =
            means.iter().filter_map(|row| Some([after(row.pass)?, row.joint()[0].unwrap_or(f64::NAN)]));
        let series = vec![("", points.collect(), Mark::LineAndPoints)];
        add("joint_conductance", "joint conductance", joint_column(first), series);
    }
    let along = [("along x", Direction::X, Mark::LineAndPoints), ("along y", Direction::Y, Mark::Dashed)];
    let along = along.into_iter().filter_map(|(name, axis, mark)| {
        let rows: Vec<_> = flow.iter().filter(|row| row.along == axis).collect();
        let mean = |rows: &[&GapFlowRecord]| {
            let sum: f64 = rows.iter().map(|row| row.leakage).sum();
            Some([after(rows[0].pass)?, sum / rows.len() as f64])
        };
        let points: Vec<_> = rows.chunk_by(|one, other| one.pass == other.pass).filter_map(mean).collect();
        (!points.is_empty()).then_some((name, points, mark))
    });
    add("leakage", "leakage", "leakage", along.collect());
    curves
}

/// The column of the joint conductance.
fn joint_column(row: &ConductanceRecord) -> &'static str {
    if row.thermal.is_some() { "thermal_joint_conductance" } else { "electrical_joint_conductance" }
}

/// How the contacts are lined up: by their mean pressure, or one after another.
struct Order {
    by_pressure: bool,
    log: bool,
}

impl Order {
    fn of(pressures: &[f64]) -> Self {
        let [least, most] = [f64::min, f64::max].map(|pick| pressures.iter().copied().fold(f64::NAN, pick));
        let by_pressure = most > (1.0 + LOADED) * least;
        Self { by_pressure, log: by_pressure && least > 0.0 && most >= DECADE * least }
    }

    fn axis(&self) -> Axis {
        match self.by_pressure {
            true => Axis { log: self.log, ..Axis::of("mean pressure", "mean_pressure") },
            false => Axis::linear("contact", Unit::Number),
        }
    }

    /// The points of a curve.
    fn curve(&self, values: impl Iterator<Item = (f64, f64)>) -> Vec<[f64; 2]> {
        let place = |(index, (pressure, value)): (usize, (f64, f64))| {
            [if self.by_pressure { pressure } else { index as f64 + 1.0 }, value]
        };
        let mut points: Vec<[f64; 2]> = values.enumerate().map(place).collect();
        points.sort_by(|one, other| one[0].total_cmp(&other[0]));
        points
    }
}

/// Joint conductance, with the correlation beside it.
fn of_conductance(rows: &[&ConductanceRecord], name: &'static str) -> Option<Curves> {
    if rows.len() < 2 {
        return None;
    }
    let pressures: Vec<f64> = rows.iter().map(|row| row.mean_pressure).collect();
    let order = Order::of(&pressures);
    let curve = |value: &dyn Fn(&ConductanceRecord) -> Option<f64>| {
        order.curve(rows.iter().map(|row| (row.mean_pressure, value(row).unwrap_or(f64::NAN))))
    };
    let has_gas = rows.iter().any(|row| row.gas_share > 0.0);
    let mut series = vec![Series::new("computed", curve(&|row| row.joint()[0]), Mark::LineAndPoints)];
    if has_gas {
        let spots = |row: &ConductanceRecord| row.joint()[0].map(|joint| joint * row.spot_share);
        series.push(Series::new("through the spots", curve(&spots), Mark::LineAndPoints));
    }
    let correlation = |row: &ConductanceRecord| row.joint()[1].filter(|_| row.film_share == 0.0);
    let mark = match rows.iter().filter(|row| correlation(row).is_some()).count() {
        0 => None,
        // A single number has no line.
        1 => Some(Mark::LineAndPoints),
        _ => Some(Mark::Dashed),
    };
    series.extend(mark.map(|mark| Series::new("correlation of clean spots", curve(&correlation), mark)));
    let vertical = Axis { log: order.log, ..Axis::of("joint conductance", joint_column(rows[0])) };
    let title = if order.by_pressure {
        "joint conductance over mean pressure"
    } else {
        "joint conductance, contact after contact"
    };
    Some(Curves::new(name, title, Chart::new("", order.axis(), vertical, series)))
}

/// Leakage along each axis.
fn of_flow(rows: &[&GapFlowRecord], name: &'static str) -> Option<Curves> {
    let along = |axis: Direction| rows.iter().filter(move |row| row.along == axis);
    let contacts = along(Direction::X).count().max(along(Direction::Y).count());
    if contacts < 2 {
        return None;
    }
    let pressures: Vec<f64> = rows.iter().map(|row| row.mean_pressure).collect();
    let order = Order::of(&pressures);
    // A closed contact leaks nothing, which has no logarithm.
    let shown = |leakage: f64| if leakage > 0.0 || !order.log { leakage } else { f64::NAN };
    let both = [("along x", Direction::X, Mark::LineAndPoints), ("along y", Direction::Y, Mark::Dashed)];
    let series =
        both.into_iter().filter(|(_, axis, _)| along(*axis).count() > 0).map(|(name, axis, mark)| {
            // From the closing pressure on no contact leaks.
            let leaks = along(axis).filter(|row| row.leakage > 0.0).map(|row| row.mean_pressure);
            let open = leaks.fold(0.0, f64::max);
            let closed = along(axis).map(|row| row.mean_pressure).filter(|pressure| *pressure > open);
            let closing = closed.reduce(f64::min).filter(|_| order.by_pressure);
            let closing = closing.map_or(String::new(), |pressure| {
                format!(", closed from {}", format(pressure, Dimension::Pressure))
            });
            Series::new(
                name.to_owned() + &closing,
                order.curve(along(axis).map(|row| (row.mean_pressure, shown(row.leakage)))),
                mark,
            )
        });
    let vertical = Axis { log: order.log, ..Axis::of("leakage", "leakage") };
    let title =
        if order.by_pressure { "leakage over mean pressure" } else { "leakage, contact after contact" };
    Some(Curves::new(name, title, Chart::new("", order.axis(), vertical, series.collect())))
}
