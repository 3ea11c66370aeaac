//! Below the surface: the section of von Mises' stress, the most stressed point, stress down the columns.

use asperity_base::units::{Dimension, format};
use asperity_study::io::fields::{Attribute, Fields};
use asperity_study::io::fs;
use serde_json::Value;

use super::curves;
use super::html::{escaped, facts};
use super::page_data::PageData;
use super::plane::{self, Plane, Shades};
use super::quantised::QuantisedField;
use crate::draw::Unit;
use crate::error::{Error, Result};
use crate::figures;
use crate::words::captions;

/// The section, and the data that it shows; none where no stress was wanted.
pub(super) fn section(found: &mut PageData, data: &mut Value, charts: &mut Vec<Value>) -> Option<String> {
    found.case.subsurface.as_ref()?;
    let pass = found.passes.last().map(|pass| pass.pass);
    let there = if found.moves() {
        pass.is_some()
    } else {
        found.is_finished() || fs::exists(found.directory().join("subsurface.h5"))
    };
    if !there {
        return None;
    }
    let fields = found.fields(found.results.subsurface_fields(pass))?;
    let shown = stress(&fields);
    let (map, rows) = found.ok_or_note(shown)?;
    let mut html = facts(rows) + &plane::html(vec![map], data);
    let columns = found.ok_or_note(figures::stress_columns(&fields)).flatten();
    html += &curves::html(columns.into_iter().collect(), charts);
    Some(html)
}

type CaptionedPlane = (Plane, Vec<(String, String)>);

fn stress(fields: &Fields) -> Result<CaptionedPlane> {
    let stored = fields.read("section_von_mises")?;
    let (pitch, x) = ([stored.pitch[0], stored.pitch[1]], stored.origin[0] - 0.5 * stored.pitch[0]);
    let section =
        stored.into_field().ok_or_else(|| Error::missing("`section_von_mises` is no section", None))?;
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
    let spans = figures::contact_of_section(fields, x, pitch[0])?;
    let depth = (section.ncols() - 1) as f64 * pitch[1];
    let on_it = at[1] == number("section");
    let ends = [x, x + section.nrows() as f64 * pitch[0]];
    let map = Plane {
        file: "subsurface".to_owned(),
        title: format!(
            "Von Mises stress in the {body} body in the section y = {}.",
            format(number("section"), Dimension::Length)
        ),
        caption: captions::find("subsurface").unwrap_or_default(),
        map: QuantisedField::positive(&section, pitch),
        x,
        down: true,
        quantity: "von Mises stress",
        unit: Unit::Pressure,
        shades: Shades::FromZero,
        spans,
        interfaces: figures::interfaces(&attributes, depth),
        mark: on_it.then_some(([figures::on_section(at[0], ends), at[2]], "most stressed point")),
    };
    Ok((map, rows))
}
