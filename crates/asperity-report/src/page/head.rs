//! The head: what was computed, what came of it, what to be wary of.

use super::html::{escaped, minus, with_code};
use super::page_data::PageData;
use super::{answers, cards, verdict};

/// The title of the case.
pub(super) fn title(found: &PageData) -> String {
    match found.case.title.trim() {
        "" => "a contact".to_owned(),
        title => title.to_owned(),
    }
}

/// Everything above the sections: the result in a sentence, its main numbers, what to be wary of.
pub(super) fn html(found: &PageData) -> String {
    let answers = answers::all(found);
    let mut html = format!(
        "<h1>{}</h1><p class=\"verdict\">{}</p>{}",
        escaped(&title(found)),
        escaped(&minus(&verdict::sentence(found, &answers))),
        cards::html(found, answers)
    );
    html += &unfinished(found);
    let warnings: Vec<String> = warnings(found).iter().map(|warning| with_code(warning)).collect();
    html += &list("Warnings", "warning", &warnings);
    let missing: Vec<String> = found.missing.iter().map(|message| escaped(message)).collect();
    html + &list("Not on this page", "missing", &missing)
}

/// Returns the warnings of the summary; before the end of the run, those of the limits exceeded so far.
fn warnings(found: &PageData) -> Vec<String> {
    match &found.summary {
        Some(summary) => summary.warnings.clone(),
        None => {
            let broken = found.results.broken_limits().unwrap_or_default();
            broken.iter().map(|broken| broken.sentence(&found.case)).collect()
        }
    }
}

/// That the run has not come to its end, where it has not.
fn unfinished(found: &PageData) -> String {
    if found.is_finished() {
        return String::new();
    }
    let so_far = match found.case.motion {
        Some(motion) => format!("{} of {} passes are there", found.done[found.passes.len()], motion.passes),
        None if !found.points.is_empty() => format!("{} points are there", found.points.len()),
        None if !found.updates.is_empty() => format!("{} updates are there", found.updates.len() - 1),
        None => format!("{} increments are there", found.increments.len()),
    };
    format!(
        "<p class=\"banner\" role=\"status\">This run is under way, or was interrupted: {so_far}. While it goes on, \
         reload this page to see more; <code>asperity run CASE.toml --out DIR --resume</code> goes on with what was \
         interrupted.</p>"
    )
}

/// A list below a heading; nothing without lines.
pub(super) fn list(title: &str, class: &str, lines: &[String]) -> String {
    if lines.is_empty() {
        return String::new();
    }
    let lines: String = lines.iter().map(|line| format!("<li>{line}</li>")).collect();
    format!("<div class=\"{class}\"><h2>{title}</h2><ul>{lines}</ul></div>")
}
