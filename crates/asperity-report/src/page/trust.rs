//! Why one may trust the numbers, and what they come from: residuals, the load reached, cost, all numbers,
//! the case, files.

use std::path::Path;

use asperity_base::units::{Dimension, bytes, format, format_time};
use asperity_study::Outcome;
use asperity_study::case::{Prescribed, StageSpec};
use asperity_study::io::fs;
use serde_json::Value;

use super::html::{details, escaped, facts, number};
use super::page_data::PageData;
use super::{case, numbers};

/// The section.
pub(super) fn section(found: &PageData) -> String {
    let mut rows = Vec::new();
    let residuals = || {
        let steps = found.steps.iter().map(|step| step.residual);
        let increments = found.increments.iter().map(|increment| increment.residual);
        steps.chain(increments).chain(found.points.iter().map(|point| point.residual))
    };
    let at_rest = found.summary.as_ref().and_then(|summary| match &summary.outcome {
        Outcome::Static(record) => Some((record, summary.interface.as_shown(record))),
        _ => None,
    });
    let at_rest = at_rest.as_ref();
    let largest = residuals().chain(at_rest.map(|(record, _)| record.residual)).fold(0.0, f64::max);
    if largest > 0.0 {
        let tolerance = found.case.contact.tolerance;
        rows.push(("largest residual η".to_owned(), format!("{largest:.1e}, tolerance {tolerance:.0e}")));
    }
    let reached = found.passes.last().map(|pass| pass.mean_load).or(at_rest.map(|(_, shown)| shown.load));
    // The last stage that prescribes a load or an approach decides.
    let last = found.case.history.iter().rev().find_map(StageSpec::normal);
    let prescribed = last.unwrap_or(found.case.contact.prescribed());
    if let (Prescribed::Load(wanted), Some(reached)) = (prescribed, reached) {
        let off = (reached - wanted).abs() / if wanted == 0.0 { 1.0 } else { wanted.abs() };
        let [wanted, reached] = [wanted, reached].map(|load| format(load, Dimension::Force));
        let text = match off {
            0.0 => format!("{reached}, exactly the prescribed load"),
            off => format!("{reached}; the prescribed load is {wanted}, relative difference {off:.0e}"),
        };
        rows.push(("load".to_owned(), escaped(&text)));
    }
    if let Some(asperity_study::RunningIn { computed, represented, error_bound, .. }) =
        found.summary.as_ref().and_then(|summary| summary.running_in.as_ref())
    {
        rows.push(("passes".to_owned(), escaped(&computed_passes(*computed, *represented, *error_bound))));
    }
    if let Some(identity) = found.resolved["identity"].as_str() {
        rows.push(("identity".to_owned(), format!("<code>{}</code>", escaped(identity))));
    }
    rows.extend(cost(found));
    let mut html = facts(rows);
    if let Some((record, shown)) = at_rest
        && let (Ok(Value::Object(record)), Ok(Value::Object(shown))) =
            (serde_json::to_value(record), serde_json::to_value(shown))
    {
        html += &details("All numbers of the contact", &facts(numbers::of_record("static", &record, &shown)));
    }
    html += &details("The case with all its defaults", &case::html(&found.resolved));
    html += &details("Files", &files(found.directory()));
    html += &details("How to cite", CITATION);
    html
}

/// Program, date, time and effort.
fn cost(found: &PageData) -> Vec<(String, String)> {
    let mut rows = Vec::new();
    let mut add = |name: &str, value: String| rows.push((name.to_owned(), value));
    let version = found.summary.as_ref().map_or(env!("CARGO_PKG_VERSION"), |summary| &summary.version);
    add("computed by", format!("asperity {}", escaped(version)));
    let files = ["summary.json", "passes.csv", "sweep.csv", "updates.csv", "increments.csv", "case.json"];
    let written = |file: &&str| fs::metadata(found.directory().join(file)).and_then(|m| m.modified()).ok();
    if let Some(date) = files.iter().find_map(written) {
        add("date of the files", escaped(&httpdate::fmt_http_date(date)));
    }
    if let Some(summary) = &found.summary {
        let time = escaped(&format_time(summary.wall_time_s));
        add("computing time", number("wall_time_s", &summary.wall_time_s.into(), &time));
    }
    let convolutions: f64 = found.passes.iter().map(|pass| pass.convolutions).sum::<f64>()
        + found.increments.iter().map(|increment| increment.convolutions).sum::<f64>()
        + found.points.iter().map(|point| point.convolutions).sum::<f64>();
    let contacts = found.steps.len() + found.increments.len() + found.points.len();
    if convolutions > 0.0 && contacts > 1 {
        add(
            "effort",
            format!("{:.1} convolutions for each of {contacts} contacts", convolutions / contacts as f64),
        );
    }
    rows
}

/// How many passes were computed, and the error of the extrapolation over the others, if there are any.
fn computed_passes(computed: usize, represented: usize, error: f64) -> String {
    if computed == represented {
        format!("all {computed} computed")
    } else {
        format!(
            "{computed} of {represented} computed; the extrapolation over the others changes heights by an estimated {} at most",
            format(error, Dimension::Length)
        )
    }
}

/// After `CITATION.cff`.
const CITATION: &str = concat!(
    "<p>The asperity founders: <cite>asperity: contact of two rough surfaces that press together and move</cite>, ",
    "version ",
    env!("CARGO_PKG_VERSION"),
    ".</p><p>A motion by overlap: A. Ghanbarzadeh, M. Wilson, A. Morina, D. Dowson, A. Neville, <cite>A new strategy for \
     the relative movement of rough surfaces in contact using a boundary element method</cite>.</p>"
);

/// The files of the directory with their sizes, without the figures, which are drawn from them.
fn files(directory: &Path) -> String {
    let mut all = Vec::new();
    list(directory, directory, &mut all);
    all.sort_by(|a, b| a.0.cmp(&b.0));
    let rows = all.into_iter().map(|(name, size)| (name, escaped(&bytes(size))));
    facts(rows)
}

fn list(folder: &Path, root: &Path, all: &mut Vec<(String, f64)>) {
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let path = entry.path();
        let name = entry.file_name().to_string_lossy().into_owned();
        let Ok(metadata) = entry.metadata() else { continue };
        if metadata.is_dir() {
            if path != root.join("figures") {
                list(&path, root, all);
            }
        } else if !name.starts_with('.') && name != super::FILE {
            let name = path.strip_prefix(root).unwrap_or(&path).to_string_lossy().into_owned();
            all.push((name, metadata.len() as f64));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_error_is_told_of_passes_that_were_extrapolated_alone() {
        assert_eq!(computed_passes(3, 3, 0.0), "all 3 computed");
        assert_eq!(computed_passes(3, 3, 1e-12), "all 3 computed");
        let text = computed_passes(39, 1024, 2.5e-9);
        assert!(text.starts_with("39 of 1024 computed; ") && text.contains("2.5 nm"), "{text}");
    }
}
