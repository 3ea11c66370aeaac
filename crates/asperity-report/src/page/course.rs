//! Curves over positions, passes, increments or points, and their tables.

use asperity_contact::motion::StepRecord;
use serde_json::{Value, json};

use super::curves;
use super::html::details;
use super::page_data::PageData;
use crate::figures;

/// The section of bodies that change over the distance that they slide; none of others.
pub(super) fn running_in(found: &mut PageData, charts: &mut Vec<Value>) -> Option<String> {
    let mut curves = match (&found.passes[..], &found.updates[..]) {
        ([_, _, ..], _) => {
            let sq = roughness_before(found);
            figures::of_motion(&found.passes, &found.steps, sq)
        }
        (_, [_, _, ..]) => figures::of_sliding(&found.updates),
        _ if found.increments.len() > 1 => figures::of_loading(&found.increments),
        _ => return None,
    };
    curves.retain(|curves| OVER_DISTANCE.contains(&curves.name));
    Some(curves::html(curves, charts)).filter(|html| !html.is_empty())
}

/// Names of the curves over the sliding distance and over the cycles of slip.
const OVER_DISTANCE: [&str; 3] = ["running-in", "sliding", "fretting"];

/// The section of a loading in increments: the force over the displacement; none of others.
pub(super) fn loading(found: &PageData, charts: &mut Vec<Value>) -> Option<String> {
    let is_loading = found.increments.len() > 1 && figures::of_force_distance(&found.increments).is_none();
    let mut curves = if is_loading { figures::of_loading(&found.increments) } else { Vec::new() };
    curves.retain(|curves| !OVER_DISTANCE.contains(&curves.name));
    Some(curves::first(curves, charts)).filter(|html| !html.is_empty())
}

/// The section of bodies that slide at one speed after another: drag or film, and the contact, over the speed;
/// none of others.
pub(super) fn over_speed(found: &PageData, charts: &mut Vec<Value>) -> Option<String> {
    (found.points.len() > 1 && is_over_speed(found)).then_some(())?;
    Some(curves::first(figures::of_sweep(&found.points, &found.case, None), charts))
        .filter(|html| !html.is_empty())
}

/// Whether the points differ by their speed.
fn is_over_speed(found: &PageData) -> bool {
    found.points.iter().any(|point| point.speed.is_some())
}

/// Sq of both bodies before the first pass.
fn roughness_before(found: &mut PageData) -> [f64; 2] {
    let sq = found.results.surfaces_after(0).map(|bodies| bodies.map(|body| spread(body.heights())));
    found.ok_or_note(sq).unwrap_or([f64::NAN; 2])
}

/// The section; none of a contact in one step.
pub(super) fn section(found: &mut PageData, data: &mut Value, charts: &mut Vec<Value>) -> Option<String> {
    let mut html = String::from(
        "<p class=\"remark\">Drag across a plot to zoom along x, double-click to see all of it. A click on a name in a \
         legend hides its curve and shows it again.</p>",
    );
    let without_curves = html.len();
    if !found.passes.is_empty() {
        let sq = roughness_before(found);
        let mut curves = figures::of_motion(&found.passes, &found.steps, sq);
        // The curves over the sliding distance, in a section of their own, show them once more.
        if found.passes.len() > 1 && curves.iter().any(|curves| OVER_DISTANCE.contains(&curves.name)) {
            curves.retain(|curves| {
                let shown = ["roughness", "mean_contact_area"].contains(&curves.name);
                !shown && !OVER_DISTANCE.contains(&curves.name)
            });
        }
        if friction_follows_load(&found.steps) {
            curves.retain(|curves| curves.name != "friction");
        }
        html += &curves::html(curves, charts);
        data["passes"] = of_passes(found);
    }
    // Those over the speed have a section of their own.
    if !found.points.is_empty() && !is_over_speed(found) {
        let theories = figures::Theories::of(found.results, &found.case, &found.points);
        html += &curves::html(figures::of_sweep(&found.points, &found.case, theories.as_ref()), charts);
    }
    let last = found.passes.len();
    for (file, title, key) in [
        ("passes.csv", "passes", Some("passes")),
        ("increments.csv", "increments", None),
        ("sweep.csv", "points", Some("sweep")),
        ("updates.csv", "updates", None),
    ] {
        if let Some(table) = found.table(file) {
            html += &details(&format!("Table: {title}"), &table.html(title, file, key));
        }
    }
    if let Some(steps) = found.table("steps.csv") {
        let title = format!("positions of pass {}", found.done[last]);
        html += &details(
            &format!("Table: {title}"),
            &steps.only("pass", last as f64).html(&title, "steps.csv", None),
        );
    }
    Some(html).filter(|html| html.len() > without_curves)
}

/// Whether the force of friction is the same share of the load at each position, so that its curve is that of
/// the load.
fn friction_follows_load(steps: &[StepRecord]) -> bool {
    let loaded = steps.iter().filter(|step| step.load > 0.0);
    let mut ratios = loaded.map(|step| step.tangential_force.abs() / step.load);
    let first = ratios.next().unwrap_or(0.0);
    ratios.all(|ratio| (ratio - first).abs() <= 1e-6 * first)
}

/// Rms about the mean of what is defined.
fn spread(heights: &asperity_base::Field) -> f64 {
    let defined: Vec<f64> = heights.iter().copied().filter(|z| z.is_finite()).collect();
    let mean = defined.iter().sum::<f64>() / defined.len() as f64;
    (defined.iter().map(|z| (z - mean).powi(2)).sum::<f64>() / defined.len() as f64).sqrt()
}

/// What a chosen pass shows over its positions.
fn of_passes(found: &PageData) -> Value {
    /// Numbers of the page for this, at most.
    const MAX: usize = 40_000;
    let each = found.steps.len() / found.passes.len().max(1);
    let room = (MAX / each.max(1)).max(1);
    let passes = super::table::evenly(found.passes.len(), room);
    let of = |index: usize| {
        let pass = index + 1;
        let steps: Vec<_> = found.steps.iter().filter(|step| step.pass == pass).collect();
        let values = |value: &dyn Fn(&StepRecord) -> f64| -> Vec<f64> {
            steps.iter().map(|step| value(step)).collect()
        };
        let over: serde_json::Map<String, Value> = figures::OVER_POSITIONS
            .iter()
            .map(|(name, .., value)| ((*name).to_owned(), json!(values(value))))
            .collect();
        json!({
            "label": format!("pass {}", found.done[pass]),
            "offset": values(&|step| step.offset),
            "over": over,
        })
    };
    passes.into_iter().map(of).collect()
}
