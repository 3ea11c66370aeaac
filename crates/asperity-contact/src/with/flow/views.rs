//! The flow through a gap in words, curves and maps.

use super::{Along, FlowRecord, Leakage};
use crate::surface::Axis;
use crate::units::{Dimension, Metre, Multiple, format, format_number};
use crate::with::Surroundings;
use crate::with::views::{Answer, Curve, Line, Map, OverPressure, Scale, Series, closing};
use asperity_base::Choice;

/// Leakage along both axes.
pub(super) const CURVES: &[Curve<FlowRecord>] = &[Curve {
    names: ["leakage", "leakage_positions"],
    title: "leakage",
    caption: "Volume that leaks in a unit of time. A curve ends where no path leads through the gap any more.",
    column: |_| "leakage",
    series: &[
        Series {
            name: "along x",
            has: |row| row.along == Axis::X,
            value: |row| Some(row.leakage),
            is_dashed: false,
            is_beside: false,
            over_pressure: OverPressure::End,
        },
        Series {
            name: "along y",
            has: |row| row.along == Axis::Y,
            value: |row| Some(row.leakage),
            is_dashed: true,
            is_beside: false,
            over_pressure: OverPressure::End,
        },
    ],
}];

/// Smallest flow with a colour of its own over the largest: dead ends carry next to nothing.
pub const LEAST_FLOW: f64 = 1e-6;
/// Name of the critical constriction on a map.
pub const CONSTRICTION: &str = "critical constriction";
/// Titles of the maps of a flow along x and along y.
pub const TITLES: [&str; 2] = [
    "flow through the gap under a pressure that falls along x",
    "flow through the gap under a pressure that falls along y",
];

/// Caption of the maps.
const FLOW: &str = "The fluid follows few channels; the cross marks the narrowest place of the widest path, where the pressure falls.";

/// The flow along each axis, with the critical constriction.
pub(super) const MAPS: &[Map<FlowRecord>] = &[
    Map {
        field: "flow_x",
        title: TITLES[0],
        caption: FLOW,
        quantity: "flow per width",
        unit: |_| "m²/s",
        scale: Scale::Logarithmic(LEAST_FLOW),
        is_section: false,
        mark: constriction,
        marked: CONSTRICTION,
    },
    Map {
        field: "flow_y",
        title: TITLES[1],
        caption: FLOW,
        quantity: "flow per width",
        unit: |_| "m²/s",
        scale: Scale::Logarithmic(LEAST_FLOW),
        is_section: false,
        mark: constriction,
        marked: CONSTRICTION,
    },
];

/// The critical constriction of the flow that a field belongs to.
fn constriction(row: &FlowRecord, field: &str) -> Option<[Metre; 2]> {
    row.constriction().filter(|_| field.ends_with(row.along.word()))
}

pub(super) fn describe(leakage: &Leakage, surroundings: &Surroundings) -> String {
    let (viscosity, pressure) =
        (format(leakage.viscosity, Dimension::Viscosity), format(leakage.pressure, Dimension::Pressure));
    let kind = if leakage.gas { "a gas" } else { "a liquid" };
    let ends = |axis| leakage.ends_along(axis, surroundings.boundary).word();
    let ends = match leakage.along {
        Along::X => ends(0).to_owned(),
        Along::Y => ends(1).to_owned(),
        Along::Both if ends(0) == ends(1) => ends(0).to_owned(),
        Along::Both => format!("{} along x and {} along y", ends(0), ends(1)),
    };
    let often = surroundings.often(leakage.every);
    format!("{kind} of {viscosity} under {pressure}, ends {ends}; {often}")
}

pub(super) fn answers(leakage: &Leakage, rows: &[FlowRecord]) -> Vec<Answer> {
    let last = rows.last().and_then(|row| row.pass);
    let told = |axis: Axis| {
        let leaking = rows.iter().filter(|row| row.along == axis && row.pass == last && row.leakage > 0.0);
        leaking.max_by(|one, other| one.mean_pressure.total_cmp(&other.mean_pressure))
    };
    // Both directions in one unit.
    let most = [Axis::X, Axis::Y].into_iter().filter_map(told).map(|row| row.leakage).fold(0.0, f64::max);
    let unit = Dimension::VolumeFlow.multiple(most);
    let along = |axis: Axis| {
        if last.is_some() {
            return of_pass(axis, &unit, rows.iter().filter(|row| row.pass == last && row.along == axis));
        }
        let mut rows: Vec<&FlowRecord> = rows.iter().filter(|row| row.along == axis).collect();
        rows.sort_by(|one, other| one.mean_pressure.total_cmp(&other.mean_pressure));
        answer(leakage, axis, &unit, &rows)
    };
    [Axis::X, Axis::Y].into_iter().filter_map(along).collect()
}

/// Returns what leaks along an axis, from rows with rising mean pressures.
fn answer(leakage: &Leakage, axis: Axis, unit: &Multiple, rows: &[&FlowRecord]) -> Option<Answer> {
    let (least, most) = (rows.first()?, rows.last()?);
    let pressure = |row: &FlowRecord| format(row.mean_pressure, Dimension::Pressure);
    let flow = |row: &FlowRecord| unit.write(row.leakage);
    let in_trade = |row: &FlowRecord| match per_metre(leakage, row) {
        Some(per_metre) => format!(" ({per_metre})"),
        None => String::new(),
    };
    let axis = axis.word();
    let name = format!("leakage along {axis}").into();
    let open = rows.iter().rfind(|row| row.leakage > 0.0);
    let closed = closing(rows.iter().map(|row| [row.mean_pressure, row.leakage]));
    let closed = closed.filter(|_| most.mean_pressure > least.mean_pressure);
    Some(match (open, closed) {
        (None, _) => Answer {
            name,
            value: "none".to_owned(),
            about: "No path leads through the gap.".to_owned(),
            sentence: format!("Along {axis} no path leads through the gap."),
        },
        (Some(open), Some(closed)) => Answer {
            name,
            value: format!("closed from {}", format(closed, Dimension::Pressure)),
            about: format!("At {} {} leak{}.", pressure(open), flow(open), in_trade(open)),
            sentence: format!(
                "Along {axis} the gap is closed from {}; at {} {} leak{}.",
                format(closed, Dimension::Pressure),
                pressure(open),
                flow(open),
                in_trade(open)
            ),
        },
        (Some(_), None) => Answer {
            name,
            value: flow(most),
            about: match per_metre(leakage, most) {
                Some(per_metre) => format!("At {}; {per_metre}.", pressure(most)),
                None => format!("At {}.", pressure(most)),
            },
            sentence: format!("Along {axis} {} leak at {}{}.", flow(most), pressure(most), in_trade(most)),
        },
    })
}

/// Returns the mean of what leaks along an axis over the positions of the last pass.
fn of_pass<'a>(axis: Axis, unit: &Multiple, rows: impl Iterator<Item = &'a FlowRecord>) -> Option<Answer> {
    let leakages: Vec<f64> = rows.map(|row| row.leakage).collect();
    let mean = leakages.iter().sum::<f64>() / leakages.len() as f64;
    let value = unit.write(mean);
    let axis = axis.word();
    (!leakages.is_empty()).then(|| Answer {
        name: format!("leakage along {axis}").into(),
        about: "Mean over the last pass.".to_owned(),
        sentence: if mean > 0.0 {
            format!("Along {axis} {value} leak in the mean of the last pass.")
        } else {
            format!("Along {axis} no path led through the gap in the last pass.")
        },
        value,
    })
}

/// Describes a leakage for a metre of a seal, in the units of the trade: ml/h of a liquid, with its mass if
/// the density is known; mbar l/s of a gas. `None` if the width of the strip is not known.
fn per_metre(leakage: &Leakage, row: &FlowRecord) -> Option<String> {
    let strip = row.load / (row.mean_pressure * row.length);
    let width = leakage.width.unwrap_or(row.length);
    let flow = row.leakage / strip * row.length / width;
    if !(flow.is_finite() && flow > 0.0) {
        return None;
    }
    let text = match (leakage.outlet.filter(|_| leakage.gas), leakage.density) {
        (Some(outlet), _) => format!("{} mbar l/s", format_number(10.0 * outlet * flow)),
        (None, None) => scaled(3.6e6 * flow, "l/h"),
        (None, Some(density)) => {
            format!("{}, {}", scaled(3.6e6 * flow, "l/h"), scaled(1e3 * density * flow, "g/s"))
        }
    };
    let as_the_map = if leakage.width.is_none() { ", as the map" } else { "" };
    Some(format!("{text} per metre of a seal {} wide{as_the_map}", format(width, Dimension::Length)))
}

/// Writes a value with the prefix of its unit that suits it.
fn scaled(value: f64, unit: &str) -> String {
    const PREFIXES: [(f64, &str); 6] =
        [(1.0, ""), (1e-3, "m"), (1e-6, "µ"), (1e-9, "n"), (1e-12, "p"), (1e-15, "f")];
    let (factor, prefix) =
        PREFIXES.into_iter().find(|(factor, _)| value >= *factor).unwrap_or(PREFIXES[PREFIXES.len() - 1]);
    format!("{} {prefix}{unit}", format_number(value / factor))
}

pub(super) fn numbers(leakage: &Leakage, row: &FlowRecord) -> Vec<Line> {
    let name = format!("leakage along {}", row.along.word());
    let mut value = format(row.leakage, Dimension::VolumeFlow);
    if let Some(per_metre) = per_metre(leakage, row) {
        value += &format!(", {per_metre}");
    }
    let mut lines = leaks(name, value, row.critical_gap, row.constriction(), row.estimate);
    if row.leakage > 0.0 {
        let medium = format_number(row.effective_medium / row.mean_gap.powi(3));
        let factor = format!("{}, an effective medium has {medium}", format_number(row.flow_factor));
        lines.push(Line::detail("flow factor", factor));
    }
    let trapped = format(row.trapped_volume, Dimension::Volume);
    let flowing = format_number((1000.0 * row.flowing_share).round() / 10.0);
    lines.push(Line::detail("trapped", format!("{trapped}; {flowing} % of the cells are part of a path")));
    lines
}

/// Describes a leakage or a permeability, and the critical constriction and its place.
pub fn leaks(
    name: String,
    value: String,
    critical_gap: Metre,
    place: Option<[Metre; 2]>,
    estimate: f64,
) -> Vec<Line> {
    if critical_gap == 0.0 {
        return vec![Line::new(name, "none: no path through the gap")];
    }
    let length = |value| format(value, Dimension::Length);
    let place = place.map_or(String::new(), |[x, y]| format!(" at x = {}, y = {}", length(x), length(y)));
    let within = format_number((1000.0 * estimate).ceil() / 10.0);
    let constriction = format!("gap {}{place}; permeability within {within} %", length(critical_gap));
    vec![Line::new(name, value), Line::new("constriction", constriction)]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::with::{Capability, answering};

    const LIQUID: Leakage = Leakage {
        viscosity: 1e-3,
        pressure: 1e5,
        along: Along::Both,
        ends: None,
        gas: false,
        outlet: None,
        density: None,
        width: None,
        shear: false,
        every: 1,
    };

    /// A contact of 2 mm × 1 mm with this mean pressure and leakage along x.
    fn row(pass: Option<usize>, mean_pressure: f64, leakage: f64) -> FlowRecord {
        FlowRecord {
            pass,
            step: Some((1e-6 * mean_pressure) as usize),
            along: Axis::X,
            length: 2e-3,
            load: mean_pressure * 2e-6,
            mean_pressure,
            contact_area: 1e-9,
            mean_gap: 1e-7,
            permeability: 1e-22,
            permeability_across: None,
            hydraulic_gap: 1e-8,
            flow_factor: 0.1,
            leakage,
            critical_gap: 1e-8,
            critical_x: None,
            critical_y: None,
            critical_cells: 1,
            flowing_share: 0.5,
            trapped_volume: 0.0,
            shear_flow_factor: None,
            shear_stress_factor: None,
            sliding_stress_factor: None,
            pressure_stress_factor: None,
            effective_medium: 1e-22,
            estimate: 0.01,
            residual: 1e-12,
        }
    }

    fn told(leakage: &Leakage, rows: &[FlowRecord]) -> (String, String) {
        let [answer] = &leakage.answers(rows)[..] else { panic!("one axis") };
        (answer.value.clone(), answer.sentence.clone())
    }

    #[test]
    fn a_sweep_is_told_by_the_pressure_that_closes_the_gap() {
        let sweep = [row(None, 1e7, 2e-15), row(None, 2e7, 0.0), row(None, 5e6, 3e-14), row(None, 3e7, 0.0)];
        // 2e-15 m³/s over a width of 1 mm are 7.2 µl/h per metre.
        let closed = "Along x the gap is closed from 20 MPa; at 10 MPa 2000 µm³/s leak (7.2 µl/h per metre of a seal 2 mm wide, as the map).";
        assert_eq!(
            told(&LIQUID, &answering::<Leakage>(&sweep, true)),
            ("closed from 20 MPa".to_owned(), closed.to_owned())
        );
        // A history says what it ends with.
        assert_eq!(told(&LIQUID, &answering::<Leakage>(&sweep, false)).0, "none");
        let unloaded = [row(None, 2e7, 0.0), row(None, 1e7, 2e-15)];
        assert_eq!(told(&LIQUID, &answering::<Leakage>(&unloaded, false)).0, "2000 µm³/s");
        let open = [row(None, 5e6, 3e-14), row(None, 1e7, 2e-15)];
        assert_eq!(told(&LIQUID, &open).0, "2000 µm³/s");
        let closed = [row(None, 5e6, 0.0)];
        assert_eq!(told(&LIQUID, &closed).1, "Along x no path leads through the gap.");
    }

    #[test]
    fn both_directions_have_one_unit() {
        let along_y = |row: FlowRecord| FlowRecord { along: Axis::Y, ..row };
        let told = |pass| {
            let rows = [row(None, 5e6, 1e-6), row(pass, 1e7, 9.178e-13), along_y(row(pass, 1e7, 5.932e-12))];
            let rows = if pass.is_some() { &rows[1..] } else { &rows };
            LIQUID.answers(rows).iter().map(|answer| answer.value.clone()).collect::<Vec<_>>()
        };
        assert_eq!(told(None), ["0.0009178 mm³/s", "0.005932 mm³/s"]);
        assert_eq!(told(Some(1)), told(None));
        // Also where they close at different pressures.
        let closing = [
            row(None, 1e7, 7.4e-20),
            along_y(row(None, 2e7, 7e-22)),
            row(None, 2e7, 0.0),
            along_y(row(None, 3e7, 0.0)),
        ];
        let sentences: Vec<String> =
            LIQUID.answers(&closing).into_iter().map(|answer| answer.sentence).collect();
        assert!(
            sentences[0].contains("at 10 MPa 0.074 µm³/s leak")
                && sentences[1].contains("at 20 MPa 0.0007 µm³/s"),
            "{sentences:?}"
        );
    }

    #[test]
    fn the_units_are_those_of_the_trade() {
        let known = Leakage { density: Some(870.0), ..LIQUID };
        // 2e-12 m²/s of 870 kg/m³.
        assert_eq!(
            per_metre(&known, &row(None, 1e7, 2e-15)).unwrap(),
            "7.2 µl/h, 1.74 µg/s per metre of a seal 2 mm wide, as the map"
        );
        let gas = Leakage { gas: true, outlet: Some(1e5), ..LIQUID };
        // 1 Pa m³/s is 10 mbar l/s.
        let told = per_metre(&gas, &row(None, 1e7, 2e-9)).unwrap();
        assert_eq!(told, "2 mbar l/s per metre of a seal 2 mm wide, as the map");
        // A face of ten times the length of the map leaks a tenth.
        let wide = Leakage { width: Some(2e-2), ..known };
        let told = per_metre(&wide, &row(None, 1e7, 2e-15)).unwrap();
        assert_eq!(told, "720 nl/h, 174 ng/s per metre of a seal 20 mm wide");
        assert_eq!(per_metre(&LIQUID, &row(None, 0.0, 1e-12)), None);
    }

    #[test]
    fn a_pass_is_told_by_its_mean() {
        let rows = [row(Some(1), 1e7, 9e-15), row(Some(2), 2e7, 1e-15), row(Some(2), 1e7, 3e-15)];
        assert_eq!(told(&LIQUID, &rows).0, "2000 µm³/s");
    }
}
