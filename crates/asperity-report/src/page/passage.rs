//! What a contact lets through: heat or current, and a fluid.

use asperity_base::units::{Dimension, format, format_number};
use asperity_base::{Choice, Field};
use asperity_study::{ConductanceRecord, GapFlowRecord};
use serde_json::Value;

use super::curves;
use super::found::PageData;
use super::html::{escaped, facts};
use super::packed::QuantisedField;
use super::plane::{self, Plane, Shades};
use crate::draw::Unit;
use crate::figures::{self, LEAST_FLOW, passes_everywhere};
use crate::words::passage;

/// The section, and the data that it shows; none where nothing was asked for.
pub(super) fn section(found: &mut PageData, data: &mut Value, charts: &mut Vec<Value>) -> Option<String> {
    if found.case.conductance.is_none() && found.case.flow.is_none() {
        return None;
    }
    let conductance = found.kept(found.results.conductance()).unwrap_or_default();
    let flow = found.kept(found.results.flow()).unwrap_or_default();
    let done = figures::done(&found.kept(found.results.passes()).unwrap_or_default());
    let mut html = facts(rows(&conductance, GapFlowRecord::last(&flow)));
    let planes = if found.moves() || !found.is_finished() {
        Vec::new()
    } else {
        planes(found, GapFlowRecord::last(&flow))
    };
    if !planes.is_empty() {
        html += &plane::html(planes, data);
    }
    html += &curves::html(figures::passage_curves(&conductance, &flow, &done), charts);
    Some(html)
}

/// The numbers of the last contact, or the means over its last pass.
fn rows(conductance: &[ConductanceRecord], flow: &[GapFlowRecord]) -> Vec<(String, String)> {
    let mut rows = Vec::new();
    if let Some(row) = conductance.last() {
        let means = ConductanceRecord::means(conductance);
        let row = if row.pass.is_some() { means.last().unwrap_or(row) } else { row };
        rows.extend(passage::conductance(row));
        rows.push((
            "spots".to_owned(),
            format!(
                "{}, with {} cells in the median",
                format_number(row.spots),
                format_number(row.median_spot_cells)
            ),
        ));
        let share = |share: f64| format!("{} %", format_number((1000.0 * share).round() / 10.0));
        rows.push((
            "shares".to_owned(),
            format!(
                "spots {}, gas {} of what passes; film {} of the resistance",
                share(row.spot_share),
                share(row.gas_share),
                share(row.film_share)
            ),
        ));
    }
    for row in flow {
        rows.extend(passage::flow(row));
        if row.leakage > 0.0 {
            rows.push((
                "flow factor".to_owned(),
                format!(
                    "{}, an effective medium has {}",
                    format_number(row.flow_factor),
                    format_number(row.effective_medium / row.mean_gap.powi(3))
                ),
            ));
        }
        rows.push((
            "trapped".to_owned(),
            format!(
                "{}; {} % of the cells are part of a path",
                format(row.trapped_volume, Dimension::Volume),
                format_number((1000.0 * row.flowing_share).round() / 10.0)
            ),
        ));
    }
    rows.into_iter().map(|(name, value)| (name, escaped(&value))).collect()
}

/// The maps of the last contact.
fn planes(found: &mut PageData, flow: &[GapFlowRecord]) -> Vec<Plane> {
    let Some(fields) = found.fields(found.results.static_fields()) else { return Vec::new() };
    let read = |name: &str| -> Option<(Field, [f64; 2], String)> {
        let stored = fields.read(name).ok()?;
        let (pitch, unit) = ([stored.pitch[0], stored.pitch[1]], stored.unit.clone());
        Some((stored.into_field()?, pitch, unit))
    };
    let plane = |name: &str,
                 title: String,
                 quantity,
                 (field, pitch, unit): &(Field, [f64; 2], String),
                 mark,
                 shades| Plane {
        file: name.to_owned(),
        title,
        map: match shades {
            Shades::Logarithmic => QuantisedField::logarithmic(field, *pitch, LEAST_FLOW),
            _ => QuantisedField::positive(field, *pitch),
        },
        x: 0.0,
        down: false,
        quantity,
        unit: Unit::Of(match unit.as_str() {
            "A/m²" => "A/m²",
            "W/m²" => "W/m²",
            _ => "m²/s",
        }),
        shades,
        spans: Vec::new(),
        mark,
    };
    let is_there = |(field, ..): &(Field, [f64; 2], String)| field.iter().any(|value| *value > 0.0);
    let flux = read("flux").filter(is_there);
    let mut planes: Vec<Plane> = flux
        .iter()
        .map(|flux| {
            let shades = if passes_everywhere(&flux.0) { Shades::Logarithmic } else { Shades::FromZero };
            plane("flux", "Flux through the contact.".to_owned(), "flux", flux, None, shades)
        })
        .collect();
    for row in flow {
        let axis = row.along.word();
        let name = &format!("flow_{axis}");
        if let Some(rate) = read(name).filter(is_there) {
            let title = format!("Flow per width through the gap under a pressure that falls along {axis}.");
            let place = row.critical_x.zip(row.critical_y).map(|(x, y)| ([x, y], "critical constriction"));
            planes.push(plane(name, title, "flow per width", &rate, place, Shades::Logarithmic));
        }
    }
    planes
}
