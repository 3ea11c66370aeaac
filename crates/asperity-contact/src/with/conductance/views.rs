//! The conductance of a contact in words, curves and maps.

use super::{ConductanceRecord, Joint, Kind, MAX_CORRELATED_FRACTION};
use crate::units::{Dimension, format, format_number};
use crate::with::Surroundings;
use crate::with::views::{Answer, Curve, Line, Map, OverPressure, Scale, Series, exponent};
use asperity_base::Choice;

/// Joint conductance, with that of the spots among gas, and that of clean spots by the correlation.
/// The whole conductance is shown where there is no joint.
pub(super) const CURVES: &[Curve<ConductanceRecord>] = &[JOINT, WHOLE];

const JOINT: Curve<ConductanceRecord> = Curve {
    names: ["joint_conductance", "joint_conductance_positions"],
    title: "joint conductance",
    caption: "Conductance of a unit of the apparent area. Clean metal spots alone grow about as the power 0.95 of the pressure.",
    column: |row| row.quantities.joint_column(),
    series: &[
        Series {
            name: "computed",
            has: is_joint,
            value: |row| row.quantities.joint_conductance,
            is_dashed: false,
            is_beside: false,
            over_pressure: OverPressure::Exponent,
        },
        Series {
            name: "through the spots",
            has: |row| is_joint(row) && row.gas_share > 0.0,
            value: |row| row.quantities.joint_conductance.map(|joint| joint * row.spot_share),
            is_dashed: false,
            is_beside: true,
            over_pressure: OverPressure::Nothing,
        },
        Series {
            name: "correlation of clean spots",
            has: |row| is_joint(row) && row.film_share == 0.0,
            value: |row| row.quantities.joint_correlation,
            is_dashed: true,
            is_beside: true,
            over_pressure: OverPressure::Nothing,
        },
    ],
};

/// Whether the joint of a contact is known by itself.
fn is_joint(row: &ConductanceRecord) -> bool {
    row.quantities.joint_conductance.is_some()
}

const WHOLE: Curve<ConductanceRecord> = Curve {
    names: ["conductance", "conductance_positions"],
    title: "conductance",
    caption: "Conductance with the spreading into the bodies: spots in a part of the grid have no joint of their own.",
    column: |row| row.quantities.conductance_column(),
    series: &[Series {
        name: "computed",
        has: |row| !is_joint(row),
        value: |row| row.quantities.conductance,
        is_dashed: false,
        is_beside: false,
        over_pressure: OverPressure::Exponent,
    }],
};

/// The flux.
pub(super) const MAPS: &[Map<ConductanceRecord>] = &[Map {
    field: "flux",
    title: "flux through the contact",
    caption: "Heat or current through each cell; it crowds at the edges of the spots.",
    quantity: "flux",
    unit: |row| flux_unit(row.quantities.kind),
    scale: Scale::FromZeroOrLogarithmic,
    is_section: false,
    mark: |_, _| None,
    marked: "",
}];

/// Unit of a flux.
pub(super) fn flux_unit(kind: Kind) -> &'static str {
    match kind {
        Kind::Thermal => "W/m²",
        Kind::Electrical => "A/m²",
    }
}

pub(super) fn describe(joint: &Joint, surroundings: &Surroundings) -> String {
    let film =
        joint.film.map_or(String::new(), |film| format!(", film {}", format(film, joint.kind.insulance())));
    let gas = joint.gas.map_or(String::new(), |gas| {
        let jump = format(joint.jump, Dimension::Length);
        format!(", gas {} with a jump distance of {jump}", format(gas, Dimension::Conductivity))
    });
    format!("{}{film}{gas}; {}", joint.kind.word(), surroundings.often(joint.every))
}

pub(super) fn answers(rows: &[ConductanceRecord]) -> Vec<Answer> {
    let rows = match rows.last().and_then(|last| last.pass) {
        None => rows.to_vec(),
        Some(_) => ConductanceRecord::means(rows),
    };
    let pressure = |row: &ConductanceRecord| row.mean_pressure;
    let Some(most) = rows.iter().max_by(|one, other| pressure(one).total_cmp(&pressure(other))) else {
        return Vec::new();
    };
    let at = format(most.mean_pressure, Dimension::Pressure);
    let quantities = &most.quantities;
    let kind = quantities.kind;
    let Some(conductance) = quantities.conductance else {
        let about = "all cells touch without a film".to_owned();
        let sentence = format!("At {at} all cells touch without a film: nothing resists.");
        return vec![Answer { name: JOINT.title.into(), value: "no resistance".to_owned(), about, sentence }];
    };
    let whole = format(conductance, kind.conductance());
    let (curve, value, sentence) = match quantities.joint_conductance.map(|joint| of_area(kind, joint)) {
        Some(joint) if quantities.resistance_full.is_some() => {
            let sentence =
                format!("At {at} the joint conducts {joint}, the map with the bodies around it {whole}.");
            (&JOINT, joint, sentence)
        }
        Some(joint) => {
            let sentence = format!("At {at} the joint conducts {joint} ({whole}).");
            (&JOINT, joint, sentence)
        }
        None => {
            let sentence = format!("At {at} the contact conducts {whole}, with the bodies around it.");
            (&WHOLE, whole, sentence)
        }
    };
    let points = rows.iter().filter_map(|row| Some([row.mean_pressure, (curve.series[0].value)(row)?]));
    let grows =
        exponent(points).map(|power| format!("It grows about as the power {power:.2} of the pressure."));
    let with_power = |text: String| [text, grows.clone().unwrap_or_default()].join(" ").trim_end().to_owned();
    let (about, sentence) = (with_power(format!("At {at}.")), with_power(sentence));
    vec![Answer { name: curve.title.into(), value, about, sentence }]
}

pub(super) fn numbers(row: &ConductanceRecord) -> Vec<Line> {
    let quantities = &row.quantities;
    let (kind, joint) = (quantities.kind, quantities.joint_conductance);
    let mut lines = conducts(kind, quantities.conductance, joint);
    if let (Some(joint), Some(line)) = (joint.filter(|joint| *joint > 0.0), lines.get_mut(1)) {
        if row.gas_share > 0.0 {
            line.value += &format!(", of which the spots {}", of_area(kind, joint * row.spot_share));
        }
        match quantities.joint_correlation {
            Some(h) if row.film_share == 0.0 => {
                line.value += &format!(", spots by the correlation {}", of_area(kind, h));
            }
            None if row.contact_fraction() > MAX_CORRELATED_FRACTION => {
                line.value += &format!(
                    " ({:.0} % of the area touch: beyond the {:.0} % of the correlations)",
                    100.0 * row.contact_fraction(),
                    100.0 * MAX_CORRELATED_FRACTION
                );
            }
            _ => {}
        }
    }
    let cells = format_number(row.median_spot_cells);
    lines.push(Line::detail(
        "spots",
        format!("{}, with {cells} cells in the median", format_number(row.spots)),
    ));
    if let Some(full) = quantities.resistance_full {
        let full = resistance(kind, full);
        lines.push(Line::detail(
            "spreading",
            format!("resistance {full} from the outline of the grid into the bodies, not of the joint"),
        ));
    }
    if let (Some(of_stiffness), Some(off)) =
        (quantities.conductance_of_stiffness, quantities.off_the_stiffness())
    {
        let of_stiffness = format(of_stiffness, kind.conductance());
        let off = format_number((1e6 * off.abs()).round() / 1e4);
        lines.push(Line::detail(
            "by the stiffness",
            format!("conductance {of_stiffness} by Barber's identity, {off} % off"),
        ));
    }
    let share = |share: f64| format!("{} %", format_number((1000.0 * share).round() / 10.0));
    lines.push(Line::detail("shares", shares([row.spot_share, row.gas_share, row.film_share].map(share))));
    lines
}

/// Describes the shares of spots, gas and film.
pub fn shares([spots, gas, film]: [String; 3]) -> String {
    format!("spots {spots}, gas {gas} of what passes; film {film} of the resistance")
}

/// Describes a conductance and a joint conductance.
pub fn conducts(kind: Kind, conductance: Option<f64>, joint: Option<f64>) -> Vec<Line> {
    let Some(conductance) = conductance else {
        return vec![Line::new("conductance", "no resistance: all cells touch without a film")];
    };
    let mut value = format(conductance, kind.conductance());
    if conductance > 0.0 {
        value += &format!(", resistance {}", resistance(kind, conductance.recip()));
    }
    let mut lines = vec![Line::new("conductance", value)];
    lines.extend(joint.map(|joint| Line::new("joint conductance", of_area(kind, joint))));
    lines
}

/// Writes a resistance with its unit.
pub fn resistance(kind: Kind, value: f64) -> String {
    let dimension = match kind {
        Kind::Thermal => Dimension::ThermalResistance,
        Kind::Electrical => Dimension::ElectricalResistance,
    };
    format(value, dimension)
}

/// Writes a conductance of an area with its unit.
fn of_area(kind: Kind, value: f64) -> String {
    let dimension = match kind {
        Kind::Thermal => Dimension::ThermalConductanceOfArea,
        Kind::Electrical => Dimension::ElectricalConductanceOfArea,
    };
    format(value, dimension)
}
