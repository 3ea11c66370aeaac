//! Curves: a place for each on the page, its numbers in the data.

use std::fmt::Write;

use serde_json::{Value, json};

use super::html::escaped;
use crate::draw::{Axis, Chart, Charts, Unit};
use crate::figures::Curves;

/// [`html`] with the charts over the whole width, for the curve that answers the question of the case.
pub(super) fn first(curves: Vec<Curves>, data: &mut Vec<Value>) -> String {
    html(curves, data).replace("<div class=\"charts\">", "<div class=\"charts first\">")
}

/// HTML with a place for each chart that shows something, whose numbers go to `data`; nothing where none
/// does.
pub(super) fn html(curves: Vec<Curves>, data: &mut Vec<Value>) -> String {
    let mut html = String::new();
    for Curves { name, title, caption, charts } in curves {
        let Charts { charts, .. } = charts;
        let several = charts.len() > 1;
        let charts: Vec<Chart> = charts.into_iter().filter(shows).collect();
        let last = charts.len().saturating_sub(1);
        for (index, chart) in charts.into_iter().enumerate() {
            let title = match (several, chart.title.as_str(), title.as_str()) {
                (false, ..) => title.clone(),
                (true, "", _) => format!("{} over {}", chart.y.label, chart.x.label),
                (true, of, "") => of.to_owned(),
                (true, of, title) => format!("{title}, {of}"),
            };
            let _ = write!(
                html,
                "<figure class=\"chart\" data-chart=\"{}\"><figcaption><span>{}</span></figcaption></figure>",
                data.len(),
                escaped(&sentence(&title))
            );
            let mut of_chart = of_chart(name, &title, &chart);
            // As in a paper, panels share their caption.
            of_chart["caption"] = if index == last { caption } else { "" }.into();
            data.push(of_chart);
        }
    }
    if html.is_empty() { html } else { format!("<div class=\"charts\">{html}</div>") }
}

/// A title as a caption: it begins with a capital and ends with a full stop.
pub(super) fn sentence(title: &str) -> String {
    let mut letters = title.chars();
    let first = letters.next().map(|first| first.to_uppercase().to_string()).unwrap_or_default();
    format!("{first}{}.", letters.as_str())
}

/// Whether there is anything but zeros on a chart, and more than a point. What is held is a number, no curve.
fn shows(chart: &Chart) -> bool {
    if chart.is_held() {
        return false;
    }
    let points = || chart.series.iter().flat_map(|series| &series.points);
    chart.series.iter().any(|series| series.points.len() > 1) && points().any(|[_, y]| *y != 0.0)
}

fn of_chart(name: &str, title: &str, chart: &Chart) -> Value {
    let points = |right: bool| {
        let series = chart.series.iter().filter(move |series| series.is_on_the_right() == right);
        series.flat_map(|series| series.points.iter().copied())
    };
    let largest = |values: &mut dyn Iterator<Item = f64>| {
        values.map(f64::abs).filter(|size| size.is_finite()).fold(0.0, f64::max)
    };
    let all = || points(false).chain(points(true));
    let series: Vec<Value> = chart
        .series
        .iter()
        .map(|series| {
            let values =
                |axis: usize| -> Vec<f64> { series.points.iter().map(|point| point[axis]).collect() };
            json!({
                "name": series.name,
                "mark": format!("{:?}", series.mark).to_lowercase(),
                "right": series.is_on_the_right(),
                "x": values(0),
                "y": values(1),
            })
        })
        .collect();
    json!({
        "name": name,
        "title": title,
        "x": axis(&chart.x, largest(&mut all().map(|point| point[0]))),
        "y": axis(&chart.y, largest(&mut points(false).map(|point| point[1]))),
        "right": chart.right.as_ref().map(|right| axis(right, largest(&mut points(true).map(|p| p[1])))),
        "series": series,
        "words": chart.words,
        "shaded": chart.shaded.as_ref().map(|(name, areas)| json!({ "name": name, "areas": areas })),
    })
}

fn axis(axis: &Axis, largest: f64) -> Value {
    // Powers of ten stand at the ticks of a logarithmic axis.
    let largest = if axis.log && !axis.unit.has_multiples() { 1.0 } else { largest };
    let mut value = unit(axis.unit, largest);
    value["label"] = axis.label.as_str().into();
    value["log"] = axis.log.into();
    value["range"] = json!(axis.range);
    value["whole"] = (axis.unit == Unit::Count).into();
    value
}

/// The multiple that suits numbers up to `largest`: its size in SI, its symbol, and that of the SI unit
/// itself.
pub(super) fn unit(unit: Unit, largest: f64) -> Value {
    let (factor, symbol) = unit.shown(largest);
    json!({ "factor": factor, "symbol": symbol, "si": unit.base() })
}
