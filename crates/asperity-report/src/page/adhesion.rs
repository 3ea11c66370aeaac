//! Adhesion: its numbers, the force–distance curve, the jumps.

use asperity_base::units::{Dimension, format};
use asperity_contact::motion::IncrementRecord;
use asperity_study::{Outcome, column};
use serde_json::Value;

use super::curves;
use super::found::PageData;
use super::html::{escaped, facts, minus};
use super::numbers;
use crate::figures;

/// The numbers in the order of the page, with their names there.
const ORDER: [(&str, &str); 9] = [
    ("pull_off", "pull-off"),
    ("work_of_separation", "work of separation"),
    ("tabor", "Tabor's parameter"),
    ("pastewka_robbins", "Pastewka and Robbins"),
    ("range", "range"),
    ("max_tension", "largest tension"),
    ("process_zone", "process zone"),
    ("process_zone_cells", "cells of the process zone"),
    ("full_contact_energy", "energy of full contact"),
];
/// Jumps that are listed, at most.
const MAX_JUMPS: usize = 12;

/// The section; none without adhesion.
pub(super) fn section(found: &PageData, charts: &mut Vec<Value>) -> Option<String> {
    found.case.adhesion?;
    let mut html = String::new();
    let curve = figures::of_force_distance(&found.increments);
    html += &curves::first(curve.into_iter().collect(), charts);
    let summary = found.summary.as_ref()?;
    if let Some(Value::Object(record)) =
        summary.adhesion.and_then(|numbers| serde_json::to_value(numbers).ok())
    {
        let place = |name: &str| ORDER.iter().position(|(column, _)| column.replace('_', " ") == name);
        let mut named = numbers::of("adhesion", &record);
        named.sort_by_key(|(name, _)| place(name).unwrap_or(ORDER.len()));
        // A number with its meaning beside it.
        let with_meaning = named.into_iter().map(|(name, value)| {
            let (column_name, label) = place(&name).map_or(("", name.as_str()), |place| ORDER[place]);
            let meaning = column(column_name).map_or("", |column| column.text);
            (label.to_owned(), format!("{value} <small>{}</small>", escaped(meaning)))
        });
        html += &facts(with_meaning);
    }
    if let Some(last) = found.passes.last()
        && let Some(Value::Object(record)) =
            last.adhesion.and_then(|record| serde_json::to_value(record).ok())
    {
        html += &format!("<h3>Pass {}</h3>", found.done[found.passes.len()]);
        html += &facts(numbers::of(&format!("passes.{}", found.passes.len() - 1), &record));
    }
    if let Outcome::Static(record) = &summary.outcome
        && let Some(adhesion) = &record.adhesion
    {
        let force = |value| format(value, Dimension::Force);
        let energy = |value| format(value, Dimension::Energy);
        let rows = [
            ("adhesive load at the end", force(adhesion.adhesive_load)),
            ("least pressure at the end", format(adhesion.min_pressure, Dimension::Pressure)),
            ("energy of the attraction at the end", energy(adhesion.adhesion_energy)),
            ("energy lost in jumps", energy(adhesion.energy_lost)),
        ];
        html += &facts(rows.map(|(name, value)| (name.to_owned(), escaped(&minus(&value)))));
    }
    Some(html + &jumps(&found.increments))
}

/// The jumps of a loading, one by one.
fn jumps(increments: &[IncrementRecord]) -> String {
    let jumped = |pair: &&[IncrementRecord]| pair[1].adhesion.is_some_and(|adhesion| adhesion.jumps > 0);
    let jumps: Vec<_> = increments.windows(2).filter(jumped).collect();
    if jumps.is_empty() {
        return String::new();
    }
    let row = |pair: &&[IncrementRecord]| {
        let [before, after] = [&pair[0], &pair[1]];
        let lost = after.adhesion.map_or(0.0, |adhesion| adhesion.energy_lost);
        let text = format!(
            "load {} → {}, area of contact {} → {}, energy lost {}",
            format(before.load, Dimension::Force),
            format(after.load, Dimension::Force),
            format(before.contact_area, Dimension::Area),
            format(after.contact_area, Dimension::Area),
            format(lost, Dimension::Energy)
        );
        (format!("jump in increment {}", after.increment), escaped(&minus(&text)))
    };
    let mut html = facts(jumps.iter().take(MAX_JUMPS).map(row));
    if jumps.len() > MAX_JUMPS {
        html += &format!(
            "<p class=\"remark\">{} more jumps are in <code>increments.csv</code>.</p>",
            jumps.len() - MAX_JUMPS
        );
    }
    html
}
