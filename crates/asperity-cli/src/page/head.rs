//! The head: what was computed, what came of it, what to be wary of, the case.

use asperity::study::Outcome;
use asperity::units::{Dimension, format, format_number, format_time};
use serde_json::{Map, Value};

use super::found::Found;
use super::html::{details, escaped, facts, minus, number};
use super::table::text_of;

/// The title of the case.
pub(super) fn title(found: &Found) -> String {
    match found.case["title"].as_str().map(str::trim) {
        Some(title) if !title.is_empty() => title.to_owned(),
        _ => "a contact".to_owned(),
    }
}

/// Everything above the sections.
pub(super) fn html(found: &Found) -> String {
    let mut html = format!(
        "<h1>{}</h1><p class=\"verdict\">{}</p>",
        escaped(&title(found)),
        escaped(&minus(&verdict(found)))
    );
    html += &unfinished(found);
    let told = found.summary.iter().flat_map(|summary| &summary.warnings);
    let warnings: Vec<String> = told.map(|warning| escaped(warning)).collect();
    html += &list("Warnings", "warning", &warnings);
    let missing: Vec<String> = found.missing.iter().map(|message| escaped(message)).collect();
    html += &list("Not on this page", "missing", &missing);
    html += &facts(cost(found));
    if let Some(Outcome::Static(record)) = found.summary.as_ref().map(|summary| &summary.outcome)
        && let Ok(Value::Object(record)) = serde_json::to_value(record)
    {
        html += &details("All numbers", &facts(numbers("static", &record))).replacen(
            "<details",
            "<details open",
            1,
        );
    }
    html + &details("The case, as it was resolved", &case(&found.case))
}

/// The outcome in a sentence.
fn verdict(found: &Found) -> String {
    let force = |load| format(load, Dimension::Force);
    if let Some(last) = found.passes.last() {
        let done = found.done[found.passes.len()];
        let passes = if done == 1 { "1 pass".to_owned() } else { format!("{done} passes") };
        let mut text = format!("{passes}, mean load {}", force(last.mean_load));
        if last.mean_tangential_force != 0.0 && last.friction_coefficient.is_finite() {
            text += &format!(", coefficient of friction {}", format_number(last.friction_coefficient));
        }
        let before = found.results.surfaces_after(0).map(|bodies| bodies.map(|body| body.sq()));
        for (body, before, after) in before
            .iter()
            .flat_map(|[lower, upper]| [("lower", lower, last.sq_lower), ("upper", upper, last.sq_upper)])
        {
            let [before, after] = [*before, after].map(|sq| format(sq, Dimension::Length));
            if before != after {
                text += &format!(", Sq of the {body} body {before} → {after}");
            }
        }
        if let Some(flow) = found.summary.as_ref().and_then(|summary| summary.plasticity.as_ref()) {
            text += &format!(", {}", flow.regime);
            if let Some(rate) = flow.strain_per_pass {
                text += &format!(", strain grows by {} % a pass", format_number(100.0 * rate));
            }
        }
        return text + ".";
    }
    if let [first, .., last] = &found.points[..] {
        let (points, [from, to]) = (found.points.len(), [first.load, last.load].map(force));
        let loads = if from == to { from } else { format!("{from} to {to}") };
        let areas = [first, last].map(|point| format(point.contact_area, Dimension::Area));
        return format!("{points} points, load {loads}, real contact area {} to {}.", areas[0], areas[1]);
    }
    match found.summary.as_ref().map(|summary| &summary.outcome) {
        Some(Outcome::Static(record)) => {
            let area = format(record.contact_area, Dimension::Area);
            let pressure = format(record.max_pressure, Dimension::Pressure);
            let share = format_number(100.0 * record.contact_area / record.apparent_area);
            let mut text = format!(
                "Load {} on {area} of real contact ({share} %), largest pressure {pressure}, approach {}",
                force(record.load),
                format(record.approach, Dimension::Length)
            );
            if let Some(shear) = &record.shear {
                let stick =
                    format_number(100.0 * shear.stick_area / record.contact_area.max(f64::MIN_POSITIVE));
                text += &format!(
                    ", tangential force {} of the load, {stick} % sticks",
                    format_number(shear.force_ratio)
                );
            }
            if let Some(flow) = &record.flow {
                text += &match flow.max_plastic_strain {
                    0.0 => ", nothing flows below the surfaces".to_owned(),
                    strain => format!(", plastic strain up to {} %", format_number(100.0 * strain)),
                };
            }
            if let Some(last) = found.updates.last() {
                let deepest = format(last.max_wear_lower.max(last.max_wear_upper), Dimension::Length);
                let distance = format(last.distance, Dimension::Length);
                text += &format!(", deepest wear {deepest} after {distance} of sliding");
            }
            text + "."
        }
        _ => match found.increments.last() {
            Some(last) => format!("{} increments so far, load {}.", last.increment, force(last.load)),
            None if !found.updates.is_empty() => {
                format!("{} updates so far.", found.updates.len() - 1)
            }
            None => "Nothing has been finished yet.".to_owned(),
        },
    }
}

/// That the run has not come to its end, where it has not.
fn unfinished(found: &Found) -> String {
    if found.is_finished() {
        return String::new();
    }
    let so_far = match found.case["motion"]["passes"].as_u64() {
        Some(all) => format!("{} of {all} passes are there", found.done[found.passes.len()]),
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

fn list(title: &str, class: &str, lines: &[String]) -> String {
    if lines.is_empty() {
        return String::new();
    }
    let lines: String = lines.iter().map(|line| format!("<li>{line}</li>")).collect();
    format!("<div class=\"{class}\"><h2>{title}</h2><ul>{lines}</ul></div>")
}

/// What it took, by what, when.
fn cost(found: &Found) -> Vec<(String, String)> {
    let mut rows = Vec::new();
    let mut add = |name: &str, value: String| rows.push((name.to_owned(), value));
    let version = found.summary.as_ref().map_or(env!("CARGO_PKG_VERSION"), |summary| &summary.version);
    add("computed by", format!("asperity {}", escaped(version)));
    let files = ["summary.json", "passes.csv", "sweep.csv", "updates.csv", "increments.csv", "case.json"];
    let written =
        |file: &&str| std::fs::metadata(found.directory().join(file)).and_then(|m| m.modified()).ok();
    if let Some(date) = files.iter().find_map(written) {
        add("date of the files", escaped(&httpdate::fmt_http_date(date)));
    }
    if let Some(summary) = &found.summary {
        let time = escaped(&format_time(summary.wall_time_s));
        add("took", number("wall_time_s", &summary.wall_time_s.into(), &time));
    }
    let convolutions: f64 = found.passes.iter().map(|pass| pass.convolutions).sum::<f64>()
        + found.increments.iter().map(|increment| increment.convolutions).sum::<f64>()
        + found.points.iter().map(|point| point.convolutions).sum::<f64>();
    if convolutions > 0.0 {
        let problems = found.steps.len() + found.increments.len() + found.points.len();
        add("convolutions", format!("{convolutions:.0} for {problems} contacts"));
    }
    rows
}

/// The numbers of a record, the most asked for first.
pub(super) fn numbers(key: &str, record: &Map<String, Value>) -> Vec<(String, String)> {
    const FIRST: [&str; 6] =
        ["load", "approach", "contact_area", "apparent_area", "max_pressure", "mean_gap"];
    let rest = record.keys().map(String::as_str).filter(|name| !FIRST.contains(name));
    let mut names: Vec<&str> =
        FIRST.into_iter().filter(|name| record.contains_key(*name)).chain(rest).collect();
    names.sort_by_key(|name| unloaded(name, record).is_some());
    let load = record.get("load").and_then(Value::as_f64).unwrap_or(0.0);
    let row = |name: &str| {
        let shown = |value: &Value, path: &str, scale: f64| match value.as_f64() {
            // What rounding leaves of a component that is not there is not worth reading.
            Some(small) if small.abs() < 1e-8 * scale => number(path, value, &text_of(name, 0.0)),
            Some(size) => number(path, value, &text_of(name, size)),
            None => "–".to_owned(),
        };
        let path = format!("{key}.{name}");
        let text = match &record[name] {
            Value::Array(both) => {
                let sizes = both.iter().filter_map(Value::as_f64);
                let scale =
                    sizes.map(f64::abs).fold(if name.contains("force") { load } else { 0.0 }, f64::max);
                let each = both.iter().enumerate();
                each.map(|(n, value)| shown(value, &format!("{path}.{n}"), scale))
                    .collect::<Vec<_>>()
                    .join(", ")
            }
            Value::String(word) => escaped(word),
            value => shown(value, &path, 0.0),
        };
        let label =
            unloaded(name, record).map_or(name.to_owned(), |under_load| format!("unloaded: {under_load}"));
        (label.replace('_', " "), text)
    };
    names.into_iter().map(row).collect()
}

/// The name under the load of what a record has twice, where `name` is that without it.
fn unloaded<'a>(name: &'a str, record: &Map<String, Value>) -> Option<&'a str> {
    name.strip_prefix("residual_").filter(|under_load| record.contains_key(*under_load))
}

/// The case as a file that can be computed again.
fn case(case: &Value) -> String {
    let toml = toml::to_string(&written(case)).unwrap_or_else(|_| format!("{case:#}"));
    let toml = escaped(&toml);
    format!(
        "<button type=\"button\" class=\"copy\" hidden>copy</button><pre id=\"case\" tabindex=\"0\">{toml}</pre>"
    )
}

/// What a case file has: no digests, no values that are not there.
pub(super) fn written(case: &Value) -> Value {
    match case {
        Value::Object(keys) => {
            let kept = keys.iter().filter(|(key, value)| {
                !value.is_null() && !matches!(key.as_str(), "identity" | "sha256" | "hardness_sha256")
            });
            kept.map(|(key, value)| (key.clone(), written(value))).collect::<Map<_, _>>().into()
        }
        Value::Array(values) => values.iter().map(written).collect(),
        other => other.clone(),
    }
}
