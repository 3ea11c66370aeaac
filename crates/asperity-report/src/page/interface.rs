//! The interface of the bodies: its numbers, the force–distance curve, the jumps.

use asperity_base::units::{Dimension, format};
use asperity_contact::each;
use asperity_contact::motion::IncrementRecord;
use asperity_contact::with::views::Line;
use asperity_contact::with::{self, Listed, interface_lines};
use asperity_study::{Outcome, column};
use serde_json::Value;

use super::Section;
use super::curves;
use super::html::{escaped, facts, minus};
use super::numbers;
use super::page_data::PageData;
use crate::figures;

/// Jumps that are listed, at most.
const MAX_JUMPS: usize = 12;

/// The section; without HTML between hard walls.
pub(super) fn section(found: &PageData, charts: &mut Vec<Value>) -> Section {
    let mut section = ("interface", "Interface", None);
    each!(interface I => if I::of(&found.case.interface).is_some() {
        section = (I::NAME, I::TITLE, html(found, I::NAME, I::LABELS, charts));
    });
    section
}

/// The curve over the distance, the numbers of the table of this name with their `labels`, and the jumps.
fn html(found: &PageData, name: &str, labels: &[(&str, &str)], charts: &mut Vec<Value>) -> Option<String> {
    let mut html = String::new();
    let curve = figures::of_force_distance(&found.increments);
    html += &curves::first(curve.into_iter().collect(), charts);
    let summary = found.summary.as_ref()?;
    if let Some(Value::Object(record)) =
        summary.interface.record().and_then(|numbers| serde_json::to_value(numbers).ok())
    {
        let place = |name: &str| labels.iter().position(|(column, _)| column.replace('_', " ") == name);
        let mut named = numbers::of_record(name, &record, &record);
        named.sort_by_key(|(name, _)| place(name).unwrap_or(labels.len()));
        // A number with its meaning beside it.
        let with_meaning = named.into_iter().map(|(name, value)| {
            let (column_name, label) = place(&name).map_or(("", name.as_str()), |place| labels[place]);
            let meaning = column(column_name).map_or("", |column| column.text);
            (label.to_owned(), format!("{value} <small>{}</small>", escaped(meaning)))
        });
        html += &facts(with_meaning);
    }
    if let Some(last) = found.passes.last()
        && let Some(Value::Object(record)) =
            last.interface.and_then(|record| serde_json::to_value(record).ok())
    {
        html += &format!("<h3>Pass {}</h3>", found.done[found.passes.len()]);
        html += &facts(numbers::of_record(&format!("passes.{}", found.passes.len() - 1), &record, &record));
    }
    if let Outcome::Static(record) = &summary.outcome
        && let Some(record) = &summary.interface.as_shown(record).interface
    {
        html += "<h3>At the end</h3>";
        html += &facts(interface_lines(record).into_iter().map(shown));
    }
    if let Some(last) = found.points.last()
        && let Some(Value::Object(record)) =
            last.lubrication.and_then(|record| serde_json::to_value(record).ok())
    {
        let at = last.speed.map_or(String::new(), |speed| format(speed, Dimension::Speed));
        html += &format!("<h3>Film at {at}</h3>");
        html += &facts(numbers::of_record(&format!("sweep.{}", found.points.len() - 1), &record, &record));
    }
    html += &jumps(&found.increments);
    Some(html).filter(|html| !html.is_empty())
}

/// A line in HTML.
fn shown(Line { name, value, .. }: Line) -> (String, String) {
    (name.into_owned(), escaped(&minus(&value)))
}

/// The jumps of a loading, one by one.
fn jumps(increments: &[IncrementRecord]) -> String {
    let jumps = with::jumps(increments);
    if jumps.is_empty() {
        return String::new();
    }
    let more = jumps.len().saturating_sub(MAX_JUMPS);
    let mut html = facts(jumps.into_iter().take(MAX_JUMPS).map(shown));
    if more > 0 {
        html += &format!("<p class=\"remark\">{more} more jumps are in <code>increments.csv</code>.</p>");
    }
    html
}
