//! Heat, current and fluid through a contact, in words.

use asperity_base::Choice;
use asperity_base::units::{Dimension, Metre, format, format_number};
use asperity_contact::conductance::{Kind, MAX_CORRELATED_FRACTION};
use asperity_contact::flow::Along;
use asperity_study::{Case, ConductanceRecord, GapFlowRecord};

/// Returns the requested conductance and flow of a case, as `asperity check` prints them: name and value.
pub fn asked(case: &Case) -> Vec<(&'static str, String)> {
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
        let ends = |axis| spec.ends_along(axis, case.contact.boundary).word();
        let ends = match spec.along {
            Along::X => ends(0).to_owned(),
            Along::Y => ends(1).to_owned(),
            Along::Both if ends(0) == ends(1) => ends(0).to_owned(),
            Along::Both => format!("{} along x and {} along y", ends(0), ends(1)),
        };
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
pub fn conductance(row: &ConductanceRecord) -> Vec<(String, String)> {
    let kind = if row.thermal.is_some() { Kind::Thermal } else { Kind::Electrical };
    let [joint, correlation] = row.joint();
    let mut rows = conducts(kind, row.conductance(), joint);
    if let (Some(joint), Some((_, value))) = (joint.filter(|joint| *joint > 0.0), rows.get_mut(1)) {
        if row.gas_share > 0.0 {
            *value += &format!(", of which the spots {}", of_area(kind, joint * row.spot_share));
        }
        match correlation {
            Some(h) if row.film_share == 0.0 => {
                *value += &format!(", spots by the correlation {}", of_area(kind, h));
            }
            None if row.contact_fraction() > MAX_CORRELATED_FRACTION => {
                *value += &format!(
                    " ({:.0} % of the area touch: beyond the {:.0} % of the correlations)",
                    100.0 * row.contact_fraction(),
                    100.0 * MAX_CORRELATED_FRACTION
                );
            }
            _ => {}
        }
    }
    rows
}

/// A conductance of an area with its unit.
fn of_area(kind: Kind, value: f64) -> String {
    let dimension = match kind {
        Kind::Thermal => Dimension::ThermalConductanceOfArea,
        Kind::Electrical => Dimension::ElectricalConductanceOfArea,
    };
    format(value, dimension)
}

/// The rows of a conductance and of a joint conductance.
pub fn conducts(kind: Kind, conductance: Option<f64>, joint: Option<f64>) -> Vec<(String, String)> {
    let whole = match kind {
        Kind::Thermal => Dimension::ThermalConductance,
        Kind::Electrical => Dimension::ElectricalConductance,
    };
    let Some(conductance) = conductance else {
        return vec![("conductance".to_owned(), "no resistance: all cells touch without a film".to_owned())];
    };
    let mut value = format(conductance, whole);
    if conductance > 0.0 {
        value += &format!(", resistance {}", resistance(kind, conductance.recip()));
    }
    let mut rows = vec![("conductance".to_owned(), value)];
    rows.extend(joint.map(|joint| ("joint conductance".to_owned(), of_area(kind, joint))));
    rows
}

/// A resistance with its unit.
pub fn resistance(kind: Kind, value: f64) -> String {
    let dimension = match kind {
        Kind::Thermal => Dimension::ThermalResistance,
        Kind::Electrical => Dimension::ElectricalResistance,
    };
    format(value, dimension)
}

/// The rows of a flow along one axis: name and value.
pub fn flow(row: &GapFlowRecord) -> Vec<(String, String)> {
    let name = format!("leakage along {}", row.along.word());
    let place = row.critical_x.zip(row.critical_y).map(|(x, y)| [x, y]);
    leaks(name, format(row.leakage, Dimension::VolumeFlow), row.critical_gap, place, row.estimate)
}

/// The row of a leakage or a permeability, and that of the critical constriction and its place.
pub fn leaks(
    name: String,
    value: String,
    critical_gap: Metre,
    place: Option<[Metre; 2]>,
    estimate: f64,
) -> Vec<(String, String)> {
    if critical_gap == 0.0 {
        return vec![(name, "none: no path through the gap".to_owned())];
    }
    let length = |value| format(value, Dimension::Length);
    let place = place.map_or(String::new(), |[x, y]| format!(" at x = {}, y = {}", length(x), length(y)));
    let within = format_number((1000.0 * estimate).ceil() / 10.0);
    let constriction = format!("gap {}{place}; permeability within {within} %", length(critical_gap));
    vec![(name, value), ("constriction".to_owned(), constriction)]
}
