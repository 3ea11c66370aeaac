//! The sections of the capabilities: the numbers, maps and curves that each declares.

use asperity_contact::each;
use asperity_contact::with::{Capability, Listed, of_last};
use asperity_study::io::fields::Fields;
use serde_json::Value;

use super::Section;
use super::curves;
use super::html::{escaped, facts};
use super::page_data::PageData;
use super::plane::{self, Plane, Shades};
use super::quantised::QuantisedField;
use crate::draw::Unit;
use crate::figures;

/// Smallest value with a colour of its own over the largest, on a map whose scale has no limit.
const LEAST: f64 = 1e-6;

/// The sections of the capabilities that the case asks for, and the data that they show.
pub(super) fn sections(found: &mut PageData, data: &mut Value, charts: &mut Vec<Value>) -> Vec<Section> {
    let mut sections = Vec::new();
    each!(capability C => if let Some(asked) = C::of(&found.case.with).cloned() {
        sections.push((C::NAME, C::TITLE, Some(section(&asked, found, data, charts))));
    });
    sections
}

fn section<C: Capability>(
    asked: &C,
    found: &mut PageData,
    data: &mut Value,
    charts: &mut Vec<Value>,
) -> String {
    let rows = found.ok_or_note(found.results.rows::<C>()).unwrap_or_default();
    let done = figures::done(&found.ok_or_note(found.results.passes()).unwrap_or_default());
    let last: Vec<C::Row> = of_last(&C::summary(&rows)).cloned().collect();
    let numbers = last.iter().flat_map(|row| asked.numbers(row));
    let numbers: Vec<_> = numbers.map(|line| (line.name.into_owned(), escaped(&line.value))).collect();
    let html = curves::first(figures::curves_of_capability::<C>(&rows, &done), charts);
    let fields = match figures::load_cycle::<C>(&last) {
        Some(number) => Some(found.results.observed_fields(C::NAME, number)),
        None if !found.moves() && found.is_finished() => Some(found.results.static_fields()),
        None => None,
    };
    if let Some(fields) = fields.and_then(|fields| found.fields(fields)) {
        let planes = planes::<C>(&fields, &last);
        if !planes.is_empty() {
            return html + &plane::beside(planes, &facts(numbers), data);
        }
    }
    html + &facts(numbers)
}

/// The maps of the last contact, or of the last load cycle.
fn planes<C: Capability>(fields: &Fields, rows: &[C::Row]) -> Vec<Plane> {
    let plane = |map: &asperity_contact::with::views::Map<C::Row>| -> Option<Plane> {
        let (stored, row) = (fields.read(map.field).ok()?, rows.last()?);
        let pitch = [stored.pitch[0], stored.pitch[1]];
        let field = stored.into_field()?;
        if field.iter().all(|value| *value <= 0.0) {
            return None;
        }
        let scale = figures::logarithmic(map.scale, &field);
        Some(Plane {
            file: map.field.to_owned(),
            title: curves::sentence(map.title),
            caption: map.caption,
            map: match scale {
                Some(least) => QuantisedField::logarithmic(&field, pitch, least.unwrap_or(LEAST)),
                None => QuantisedField::positive(&field, pitch),
            },
            x: 0.0,
            down: map.is_section,
            quantity: map.quantity,
            unit: Unit::of_field((map.unit)(row)),
            shades: if scale.is_some() { Shades::Logarithmic } else { Shades::FromZero },
            spans: Vec::new(),
            interfaces: Vec::new(),
            mark: rows.iter().find_map(|row| (map.mark)(row, map.field)).map(|place| (place, map.marked)),
        })
    };
    C::MAPS.iter().filter_map(plane).collect()
}
