//! Figures of what a contact lets through: heat or current, and a fluid.

use asperity::io::fields::Fields;
use asperity::study::{ConductanceRecord, FlowAxis, GapFlowRecord, Results};

use super::Curves;
use super::sheet::Sheet;
use super::stored::StoredArray;
use crate::draw::{Axis, Chart, Colours, Maps, Mark, Series, Unit};
use crate::report::Outcome;

/// From such a ratio of the largest to the smallest value an axis is logarithmic.
const DECADE: f64 = 10.0;
/// Relative change of the load from which the curves are drawn over the mean pressure.
const LOADED: f64 = 0.01;

pub(super) fn draw(results: &Results, of: &str, sheet: &mut Sheet) -> Outcome {
    let (conductance, flow) = (results.conductance()?, results.flow()?);
    curves(&conductance, &flow).into_iter().try_for_each(|curves| sheet.add_curves(curves, of))?;
    // The fields of a static contact are those of its last contact.
    if conductance.iter().all(|row| row.pass.is_none()) && flow.iter().all(|row| row.pass.is_none()) {
        maps(&results.static_fields()?, GapFlowRecord::last(&flow), of, sheet)?;
    }
    Ok(())
}

/// The maps of flux and flow, with the critical constriction.
fn maps(fields: &Fields, flow: &[GapFlowRecord], of: &str, sheet: &mut Sheet) -> Outcome {
    let names = fields.names()?;
    let given = |name: &str| names.iter().any(|given| given == name);
    if given("flux") {
        let flux = StoredArray::read(fields, "flux")?;
        let unit = Unit::Of(if fields.read("flux")?.unit == "A/m²" { "A/m²" } else { "W/m²" });
        let largest = flux.field.iter().copied().fold(0.0, f64::max);
        // Without gas all of it passes through the spots; with gas the spots would hide what passes beside them.
        let everywhere = flux.field.iter().all(|flux| *flux > 0.0);
        if largest > 0.0 {
            sheet.add("flux", "flux through the contact", of, || {
                let colours = if everywhere { Colours::Logarithmic } else { Colours::Pressure };
                Ok(Maps::new(vec![flux.map("", "flux", unit, colours)]))
            })?;
        }
    }
    for row in flow {
        let (name, title) = match row.along {
            FlowAxis::X => ("flow_x", "flow through the gap under a pressure that falls along x"),
            FlowAxis::Y => ("flow_y", "flow through the gap under a pressure that falls along y"),
        };
        if !given(name) || row.leakage == 0.0 {
            continue;
        }
        let rate = StoredArray::read(fields, name)?;
        sheet.add(name, title, of, || {
            let map = rate.map("", "flow per width", Unit::Of("m²/s"), Colours::Logarithmic);
            let place = row.critical_x.zip(row.critical_y).map(|(x, y)| [x, y]);
            Ok(Maps::new(vec![match place {
                Some(place) => map.marked(place, "critical constriction"),
                None => map,
            }]))
        })?;
    }
    Ok(())
}

/// The curves over the loads of a sweep, or over the contacts of the last pass; none for a single contact.
pub(crate) fn curves(conductance: &[ConductanceRecord], flow: &[GapFlowRecord]) -> Vec<Curves> {
    let last_pass = |pass: Option<usize>, rows: Option<Option<usize>>| rows == Some(pass);
    let conductance: Vec<&ConductanceRecord> = {
        let last = conductance.last().map(|row| row.pass);
        conductance.iter().filter(|row| last_pass(row.pass, last)).collect()
    };
    let flow: Vec<&GapFlowRecord> = {
        let last = flow.last().map(|row| row.pass);
        flow.iter().filter(|row| last_pass(row.pass, last)).collect()
    };
    of_conductance(&conductance).into_iter().chain(of_flow(&flow)).collect()
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
fn of_conductance(rows: &[&ConductanceRecord]) -> Option<Curves> {
    if rows.len() < 2 {
        return None;
    }
    let pressures: Vec<f64> = rows.iter().map(|row| row.mean_pressure).collect();
    let order = Order::of(&pressures);
    let column =
        if rows[0].thermal.is_some() { "thermal_joint_conductance" } else { "electrical_joint_conductance" };
    let curve = |which: usize| {
        order.curve(rows.iter().map(|row| (row.mean_pressure, row.joint()[which].unwrap_or(f64::NAN))))
    };
    let series = vec![
        Series::new("computed", curve(0), Mark::LineAndPoints),
        Series::new("correlation", curve(1), Mark::Dashed),
    ];
    let vertical = Axis { log: order.log, ..Axis::of("joint conductance", column) };
    let title = if order.by_pressure {
        "joint conductance over mean pressure"
    } else {
        "joint conductance, contact after contact"
    };
    Some(Curves::new("joint_conductance", title, Chart::new("", order.axis(), vertical, series)))
}

/// Leakage along each axis.
fn of_flow(rows: &[&GapFlowRecord]) -> Option<Curves> {
    let along = |axis: FlowAxis| rows.iter().filter(move |row| row.along == axis);
    let contacts = along(FlowAxis::X).count().max(along(FlowAxis::Y).count());
    if contacts < 2 {
        return None;
    }
    let pressures: Vec<f64> = rows.iter().map(|row| row.mean_pressure).collect();
    let order = Order::of(&pressures);
    // A closed contact leaks nothing, which has no logarithm.
    let shown = |leakage: f64| if leakage > 0.0 || !order.log { leakage } else { f64::NAN };
    let both = [("along x", FlowAxis::X, Mark::LineAndPoints), ("along y", FlowAxis::Y, Mark::Dashed)];
    let series =
        both.into_iter().filter(|(_, axis, _)| along(*axis).count() > 0).map(|(name, axis, mark)| {
            Series::new(
                name,
                order.curve(along(axis).map(|row| (row.mean_pressure, shown(row.leakage)))),
                mark,
            )
        });
    let vertical = Axis { log: order.log, ..Axis::of("leakage", "leakage") };
    let title =
        if order.by_pressure { "leakage over mean pressure" } else { "leakage, contact after contact" };
    Some(Curves::new("leakage", title, Chart::new("", order.axis(), vertical, series.collect())))
}
