//! Heat, current and fluid through a contact, in words for the terminal and the page.

use asperity::Choice;
use asperity::conductance::Kind;
use asperity::study::{Case, ConductanceRecord, FlowAxis, GapFlowRecord};
use asperity::units::{Dimension, format, format_number};

/// Returns the requested conductance and flow of a case, as `asperity check` prints them: name and value.
pub(crate) fn asked(case: &Case) -> Vec<(&'static str, String)> {
    let mut rows = Vec::new();
    if let Some(spec) = case.conductance {
        let film = spec.film.map_or(String::new(), |film| {
            let dimension = match spec.kind {
                Kind::Thermal => Dimension::ThermalInsulance,
                Kind::Electrical => Dimension::ElectricalInsulance,
            };
            format!(", film {}", format(film, dimension))
        });
        let gas = spec.gas.map_or(String::new(), |gas| {
            let jump = format(spec.jump, Dimension::Length);
            format!(", gas {} with a jump distance of {jump}", format(gas, Dimension::Conductivity))
        });
        rows.push(("conducts", format!("{}{film}{gas}; {}", spec.kind.word(), often(case, spec.every))));
    }
    if let Some(spec) = case.flow {
        let (viscosity, pressure) =
            (format(spec.viscosity, Dimension::Viscosity), format(spec.pressure, Dimension::Pressure));
        let kind = if spec.gas { "a gas" } else { "a liquid" };
        let ends = spec.ends.word();
        rows.push((
            "leaks",
            format!("{kind} of {viscosity} under {pressure}, ends {ends}; {}", often(case, spec.every)),
        ));
    }
    rows
}

/// Describes the observed contacts.
fn often(case: &Case, every: usize) -> String {
    match (case.motion.is_some(), every) {
        (true, 0) => "once a pass".to_owned(),
        (true, 1) => "at each position".to_owned(),
        (true, every) => format!("at every {every}th position"),
        (false, 0) => "of the last contact".to_owned(),
        (false, 1) => "of each contact".to_owned(),
        (false, every) => format!("of every {every}th contact"),
    }
}

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
