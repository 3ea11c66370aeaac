//! What a contact lets through, in words for the terminal and the page.

use asperity::study::{ConductanceRecord, FlowAxis, GapFlowRecord};
use asperity::units::{Dimension, format, format_number};

/// The rows of a conductance: name and value.
pub(crate) fn conductance(row: &ConductanceRecord) -> Vec<(String, String)> {
    let (kind, of_area, resistance) = match row.thermal.is_some() {
        true => {
            (Dimension::ThermalConductance, Dimension::ThermalConductanceOfArea, Dimension::ThermalResistance)
        }
        false => (
            Dimension::ElectricalConductance,
            Dimension::ElectricalConductanceOfArea,
            Dimension::ElectricalResistance,
        ),
    };
    let Some(conductance) = row.conductance() else {
        return vec![("conductance".to_owned(), "no resistance: all cells touch without a film".to_owned())];
    };
    let mut value = format(conductance, kind);
    if conductance > 0.0 {
        value += &format!(", resistance {}", format(1.0 / conductance, resistance));
    }
    let mut rows = vec![("conductance".to_owned(), value)];
    if let [Some(joint), correlation] = row.joint() {
        let beside =
            correlation.map_or(String::new(), |h| format!(", by the correlation {}", format(h, of_area)));
        rows.push(("joint conductance".to_owned(), format(joint, of_area) + &beside));
    }
    rows
}

/// The rows of a flow along one axis: name and value.
pub(crate) fn flow(row: &GapFlowRecord) -> Vec<(String, String)> {
    let axis = if row.along == FlowAxis::X { "x" } else { "y" };
    let name = format!("leakage along {axis}");
    if row.leakage == 0.0 && row.critical_gap == 0.0 {
        return vec![(name, "none: no path through the gap".to_owned())];
    }
    let length = |value| format(value, Dimension::Length);
    let place = row.critical_x.zip(row.critical_y);
    let place = place.map_or(String::new(), |(x, y)| format!(" at x = {}, y = {}", length(x), length(y)));
    vec![
        (name, format(row.leakage, Dimension::VolumeFlow)),
        (
            "constriction".to_owned(),
            format!(
                "gap {}{place}; permeability within {} %",
                length(row.critical_gap),
                format_number((1000.0 * row.estimate).ceil() / 10.0)
            ),
        ),
    ]
}
