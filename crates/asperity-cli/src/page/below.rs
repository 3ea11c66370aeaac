//! Below the surface: the section of von Mises' stress, the most stressed point, stress down the columns.

use asperity::io::fields::{Attribute, Fields};
use asperity::units::{Dimension, format};
use serde_json::{Value, json};

use super::curves;
use super::found::Found;
use super::html::{escaped, facts};
use super::packed::Packed;
use crate::draw::{Axis, Chart, Charts, Mark, Series, Unit};
use crate::figures::Curves;
use crate::report::{Failure, Outcome};

/// The section, and the data that it shows; none where no stress was wanted.
pub(super) fn section(found: &mut Found, data: &mut Value, charts: &mut Vec<Value>) -> Option<String> {
    if found.case["subsurface"].is_null() {
        return None;
    }
    let pass = found.passes.last().map(|pass| pass.pass);
    let there = if found.moves() { pass.is_some() } else { found.directory().join("subsurface.h5").exists() };
    if !there {
        return None;
    }
    let fields = found.fields(found.results.subsurface_fields(pass))?;
    let shown = stress(&fields);
    let (map, rows, columns) = found.kept(shown)?;
    data["below"] = map;
    let mut html = facts(rows) + "<div class=\"maps\" id=\"below\"></div>";
    if !columns.charts.is_empty() {
        let title = "stress below chosen places".to_owned();
        html += &curves::html(vec![Curves { name: "stress_columns", title, charts: columns }], charts);
    }
    Some(html)
}

type Shown = (Value, Vec<(String, String)>, Charts);

fn stress(fields: &Fields) -> Outcome<Shown> {
    let stored = fields.read("section_von_mises")?;
    let (pitch, x) = ([stored.pitch[0], stored.pitch[1]], stored.origin[0] - 0.5 * stored.pitch[0]);
    let section =
        stored.into_field().ok_or_else(|| Failure::usage("`section_von_mises` is no section", None))?;
    let attributes = fields.attributes()?;
    let number = |name: &str| match attributes.get(name) {
        Some(Attribute::Number(value)) => *value,
        Some(Attribute::Numbers(values)) if values.len() == 1 => values[0],
        _ => f64::NAN,
    };
    let place = |name: &str| match attributes.get(name) {
        Some(Attribute::Numbers(at)) if at.len() == 3 => [at[0], at[1], at[2]],
        _ => [f64::NAN; 3],
    };
    let body = match attributes.get("body") {
        Some(Attribute::Text(body)) => body.clone(),
        _ => String::new(),
    };
    let at = place("position");
    let written = |name: &str| {
        let [x, y, z] = place(name).map(|length| format(length, Dimension::Length));
        escaped(&format!("x = {x}, y = {y}, depth {z}"))
    };
    let pressure = |name: &str| escaped(&format(number(name), Dimension::Pressure));
    let rows = vec![
        ("body".to_owned(), escaped(&body)),
        (
            "largest von Mises stress".to_owned(),
            format!("{} at {}", pressure("max_von_mises"), written("position")),
        ),
        (
            "largest shear stress".to_owned(),
            format!("{} at {}", pressure("max_shear"), written("max_shear_position")),
        ),
        ("section at y".to_owned(), escaped(&format(number("section"), Dimension::Length))),
    ];
    let largest = section.iter().copied().fold(0.0, f64::max);
    let depth = (section.ncols().saturating_sub(1)) as f64 * pitch[1];
    let map = json!({
        "map": Packed::positive(&section, pitch),
        "x": x,
        "title": format!("von Mises stress in the {body} body, section at y = {}", format(number("section"), Dimension::Length)),
        "unit": curves::unit(Unit::Pressure, largest),
        "length": curves::unit(Unit::Length, depth.max(section.nrows() as f64 * pitch[0])),
        "range": [0.0, largest],
        "mark": if at[1] == number("section") { json!([at[0], at[2]]) } else { Value::Null },
    });
    Ok((map, rows, columns(fields)?))
}

/// The six stresses down each column that was kept.
fn columns(fields: &Fields) -> Outcome<Charts> {
    let names = fields.names()?;
    let mut charts = Vec::new();
    for number in 1.. {
        let of = |component: &str| format!("column_{number:02}_{component}");
        if !names.contains(&of("xx")) {
            break;
        }
        let mut series = Vec::new();
        for component in ["xx", "yy", "zz", "yz", "xz", "xy"] {
            let stored = fields.read(&of(component))?;
            let points = stored.values.iter().enumerate();
            let points = points.map(|(k, stress)| [stored.origin[0] + k as f64 * stored.pitch[0], *stress]);
            series.push(Series::new(format!("σ {component}"), points.collect(), Mark::Line));
        }
        let x = Axis::linear("depth", Unit::Length);
        charts.push(Chart::new(
            format!("column {number}"),
            x,
            Axis::linear("stress", Unit::Pressure),
            series,
        ));
    }
    Ok(Charts { charts, columns: 2, aspect: 0.8 })
}
