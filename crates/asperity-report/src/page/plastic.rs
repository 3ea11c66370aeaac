//! Plastic flow below the surfaces: strain and residual stress on a section, what it leaves of the surface,
//! its course.

use asperity_study::Outcome;
use asperity_study::io::fs;
use serde_json::{Map, Value};

use super::curves;
use super::html::{escaped, number};
use super::page_data::PageData;
use super::plane::{self, Plane, Shades};
use super::quantised::QuantisedField;
use super::table::text_of;
use crate::draw::Unit;
use crate::figures::{self, Curves, PlasticSection};
use crate::words::captions;

/// The section, and the data that it shows; none of bodies that do not flow.
pub(super) fn section(found: &mut PageData, data: &mut Value, charts: &mut Vec<Value>) -> Option<String> {
    found.case.plasticity?;
    let mut html = numbers(found).unwrap_or_default();
    let pass = found.passes.last().map(|pass| pass.pass);
    let file = pass.map_or("plasticity.h5".to_owned(), |pass| format!("fields/plasticity-{pass:04}.h5"));
    let is_due = if found.moves() { pass.is_some() } else { found.is_finished() };
    if is_due || fs::exists(found.directory().join(file)) {
        let fields = found.fields(found.results.plastic_fields(pass));
        let bodies = fields.and_then(|fields| found.ok_or_note(figures::plastic_sections(&fields)));
        for body in bodies.into_iter().flatten() {
            html += &of_body(body, data);
        }
    }
    let course: Option<Curves> = if found.moves() {
        figures::of_rolling(&found.passes)
    } else {
        figures::of_plastic_increments(&found.increments)
    };
    html += &curves::html(course.into_iter().collect(), charts);
    Some(html).filter(|html| !html.is_empty())
}

/// The maps of a body.
fn of_body(plastic_sections: PlasticSection, data: &mut Value) -> String {
    let PlasticSection { body, y, extent, strain, stress, surface } = plastic_sections;
    let mut html = format!("<h3>{body} body</h3>");
    if strain.iter().all(|strain| *strain == 0.0) {
        return html + "<p class=\"remark\">No plastic flow in this body.</p>";
    }
    let at = asperity_base::units::format(y, asperity_base::units::Dimension::Length);
    let pitch =
        |field: &asperity_base::Field| [extent[0] / field.nrows() as f64, extent[1] / field.ncols() as f64];
    let section = |name: &str, title: String, map, quantity, unit, shades| Plane {
        file: format!("{name}_{body}"),
        title,
        caption: captions::find(name).unwrap_or_default(),
        map,
        x: 0.0,
        down: true,
        quantity,
        unit,
        shades,
        spans: Vec::new(),
        interfaces: Vec::new(),
        mark: None,
    };
    let title = format!("Accumulated plastic strain in the section y = {at}.");
    let map = QuantisedField::positive(&strain, pitch(&strain));
    let mut planes =
        vec![section("plastic_strain", title, map, "plastic strain", Unit::Number, Shades::FromZero)];
    if let Some(stress) = stress {
        let title = format!("Residual stress along x in the section y = {at}, positive in tension.");
        let map = QuantisedField::even(&stress, pitch(&stress));
        planes.push(section(
            "residual_stress",
            title,
            map,
            "residual stress",
            Unit::Pressure,
            Shades::AroundZero,
        ));
    }
    if let Some(surface) = surface {
        let map = QuantisedField::even(&surface.field, surface.grid.pitch);
        let title = format!("Change of height of the {body} body by plastic flow.");
        let plane = section("residual_surface", title, map, "change", Unit::Length, Shades::AroundZero);
        planes.push(Plane { down: false, ..plane });
    }
    html += &plane::html(planes, data);
    html
}

/// What the summary says of it, under the load and once that is taken off.
fn numbers(found: &PageData) -> Option<String> {
    const NAMES: [&str; 8] = [
        "max_plastic_strain",
        "max_plastic_strain_position",
        "yielded_volume",
        "plastic_work",
        "stored_energy",
        "displaced_volume",
        "max_residual_tension",
        "residual_displacement",
    ];
    let summary = found.summary.as_ref()?;
    // A motion ends with the load taken off.
    let (of, when, record) = match &summary.outcome {
        Outcome::Static(record) => ("static", "under the load", record.plastic.as_ref()?),
        _ => ("plasticity", "after the last pass, unloaded", summary.plasticity.as_ref()?),
    };
    let Ok(Value::Object(plastic)) = serde_json::to_value(record) else { return None };
    let cell = |key: &str| match plastic.get(key) {
        Some(Value::Array(place)) => {
            let place = place.iter().enumerate();
            let shown = place.map(|(n, value)| shown(key, &format!("{of}.{key}.{n}"), value));
            shown.collect::<Vec<_>>().join(", ")
        }
        Some(value) => shown(key, &format!("{of}.{key}"), value),
        None => "–".to_owned(),
    };
    let unloads = has_unloaded(&plastic);
    let unloaded = if unloads { "<th scope=\"col\">unloaded</th>" } else { "" };
    let mut html = format!(
        "<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"strain, work and residual stress\"><table><thead><tr><th scope=\"col\" class=\"words\">both bodies</th><th scope=\"col\">{when}</th>{unloaded}\
         </tr></thead><tbody>"
    );
    for name in NAMES {
        html += &format!("<tr><th scope=\"row\">{}</th><td>{}</td>", name.replace('_', " "), cell(name));
        if unloads {
            html += &format!("<td>{}</td>", cell(&format!("residual_{name}")));
        }
        html += "</tr>";
    }
    Some(html + "</tbody></table></div>")
}

fn shown(key: &str, path: &str, value: &Value) -> String {
    value
        .as_f64()
        .map_or_else(|| escaped(&value.to_string()), |size| number(path, value, &text_of(key, size)))
}

fn has_unloaded(plastic: &Map<String, Value>) -> bool {
    plastic.contains_key("residual_max_plastic_strain")
}
