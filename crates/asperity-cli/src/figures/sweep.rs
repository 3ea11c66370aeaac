//! Figures of a sweep: what changes from point to point.

use asperity::motion::SweepRecord;
use asperity::units::{Dimension, format};
use serde_json::Value;

use super::sheet::Sheet;
use crate::draw::{Axis, Chart, Charts, Mark, Series, Unit};
use crate::report::Outcome;

type Number = fn(&SweepRecord) -> f64;

/// What may be swept: its key in [contact], its name, its unit.
const SWEPT: [(&str, &str, Unit, Number); 3] = [
    ("loads", "load", Unit::Force, |p| p.load),
    ("mean_pressures", "mean pressure", Unit::Pressure, |p| p.mean_pressure),
    ("approaches", "approach", Unit::Length, |p| p.approach),
];

/// What is drawn over it: the figure, its axis, and whether that is logarithmic beside a logarithmic one. The mean gap
/// falls with the logarithm of the load.
const DRAWN: [(&str, &str, Unit, bool, Number); 4] = [
    ("contact_area", "real contact area", Unit::Area, true, |p| p.contact_area),
    ("mean_gap", "mean gap", Unit::Length, false, |p| p.mean_gap),
    ("stiffness", "normal stiffness", Unit::Stiffness, true, |p| p.stiffness.unwrap_or(f64::NAN)),
    ("max_pressure", "largest pressure", Unit::Pressure, true, |p| p.max_pressure),
];

pub(super) fn draw(points: &[SweepRecord], case: &Value, sheet: &mut Sheet) -> Outcome {
    let given = |(key, ..): &&(&str, &str, Unit, Number)| case["contact"].get(*key).is_some();
    let (_, swept, unit, x) = *SWEPT.iter().find(given).unwrap_or(&SWEPT[0]);
    // The points in the order of what is swept, whatever order they were given in.
    let mut ordered: Vec<&SweepRecord> = points.iter().collect();
    ordered.sort_by(|a, b| x(a).total_cmp(&x(b)));
    let [least, most] = [f64::min, f64::max].map(|pick| points.iter().map(x).fold(f64::NAN, pick));
    let log = least > 0.0 && most >= DECADE * least;
    let loads = [f64::min, f64::max].map(|pick| points.iter().map(|p| p.load).fold(f64::NAN, pick));
    let [from, to] = loads.map(|load| format(load, Dimension::Force));
    let of = format!("load {from} to {to}");
    for (name, label, y_unit, may_be_log, y) in DRAWN {
        sheet.add(name, &format!("{label} over {swept}"), &of, || {
            let curve = ordered.iter().map(|point| [x(point), y(point)]).collect();
            let axis =
                |label: &str, unit, log| if log { Axis::log(label, unit) } else { Axis::linear(label, unit) };
            let series = vec![Series::new("", curve, Mark::LineAndPoints)];
            let [horizontal, vertical] = [axis(swept, unit, log), axis(label, y_unit, log && may_be_log)];
            Ok(Charts::from(Chart::new("", horizontal, vertical, series)))
        })?;
    }
    Ok(())
}

/// From such a ratio of the largest to the least on what is swept is drawn by its logarithm.
const DECADE: f64 = 10.0;
