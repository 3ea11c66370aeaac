//! The bodies: topographies before and after, their difference, profiles, parameters, material ratio,
//! spectra.

use asperity_base::units::{Dimension, format};
use asperity_contact::with;
use asperity_study::Results;
use asperity_study::case::{Source, TopographySpec};
use asperity_study::io::fs;
use asperity_surface::{Parameter, Parameters, Topography};
use serde_json::{Value, json};

use super::curves;
use super::html::{details, escaped, minus};
use super::page_data::PageData;
use super::quantised::QuantisedField;
use super::shown_body::{MAX_CELLS, ShownBody};
use crate::draw::{Charts, Unit, range_of_heights};
use crate::error::Result;
use crate::figures::{self, Curves, StoredArray};
use crate::words::numbers::{in_column, meaning};

const BODIES: [(&str, &str); 2] = [("lower", "lower body"), ("upper", "upper body, underside")];

/// The section, and the data that it shows.
pub(super) fn section(found: &mut PageData, data: &mut Value, charts: &mut Vec<Value>) -> Option<String> {
    if let Some([lower, upper]) = found.take_bodies() {
        let html = shown(found, [lower, upper].map(|body| (body, None)), data);
        // So many cells that there are no parameters.
        return Some(html);
    }
    let [before, after] = if found.moves() { of_motion(found)? } else { [of_rest(found)?, None] };
    let before = before?;
    let bodies = [0, 1].map(|index| {
        // A counter-body that is new in each pass has nothing to compare with.
        let compares = index == 0 || !figures::has_new_upper(&found.case, found.passes.len());
        let now = after.as_ref().map(|after| &after[index]).filter(|_| compares);
        let fields: Vec<_> = std::iter::once(&before[index]).chain(now).map(|stored| &stored.field).collect();
        (ShownBody::new(&before[index], range_of_heights(fields)), now.map(|now| (&before[index], now)))
    });
    let mut html = shown(found, bodies, data);

    let before = found.ok_or_note(figures::as_measured(&before))?;
    let after = after.as_ref().and_then(|after| found.ok_or_note(figures::as_measured(after)));
    // Roughness parameters of a ball or a plane say nothing.
    let forms = [&found.case.lower, &found.case.upper].map(|body| is_form(&body.topography));
    if forms.contains(&false) && before.iter().all(|body| body.grid().cells() <= MAX_CELLS) {
        html +=
            &details("ISO 25178 parameters, material upwards", &parameters(&before, after.as_ref(), forms));
        let mut curves = figures::of_surfaces(&before, after.as_ref());
        for Curves { title, charts: Charts { charts, .. }, .. } in &mut curves {
            charts.retain(|chart| !forms[usize::from(chart.title == "upper body")]);
            if let [only] = &charts[..] {
                *title = format!("{title}, {}", only.title);
            }
        }
        html += &curves::html(curves, charts);
    }
    Some(html)
}

/// A body, with its state before and after if they are compared.
type Compared<'a> = (ShownBody, Option<(&'a StoredArray, &'a StoredArray)>);

/// HTML with places for both bodies, which go to `data`.
fn shown(found: &mut PageData, bodies: [Compared<'_>; 2], data: &mut Value) -> String {
    let mut html = String::new();
    let mut shown = Vec::new();
    for (index, ((key, title), (shown_body, states))) in BODIES.into_iter().zip(bodies).enumerate() {
        let (mut body, remarks) = body(key, title, shown_body, states);
        html += &format!("<h3>{title}</h3><div class=\"maps\" data-body=\"{index}\"></div>");
        for remark in remarks.into_iter().chain(as_it_is(found, key)) {
            html += &format!("<p class=\"remark\">{}</p>", escaped(&remark));
        }
        body["kept"] = kept(found, key).into();
        shown.push(body);
    }
    data["bodies"] = shown.into();
    html
}

/// Whether a topography is a form alone.
fn is_form(topography: &TopographySpec) -> bool {
    matches!(topography.source, Source::Form { .. }) && topography.plus.is_empty()
}

type Pair = Option<[StoredArray; 2]>;

fn of_motion(found: &mut PageData) -> Option<[Pair; 2]> {
    let last = found.passes.len();
    let mut read = |passes: usize| -> Pair {
        let fields = found.fields(found.results.fields_after(passes))?;
        let both = |fields| -> Result<_> {
            Ok([StoredArray::read(fields, "lower")?, StoredArray::read(fields, "upper")?])
        };
        found.ok_or_note(both(&fields))
    };
    let before = read(0);
    before.is_some().then(|| [before, if last > 0 { read(last) } else { None }])
}

fn of_rest(found: &mut PageData) -> Option<Pair> {
    if !has_rest(found.results) && !found.is_finished() {
        return None;
    }
    let fields = found.fields(found.results.static_fields())?;
    let both = StoredArray::read(&fields, "lower")
        .and_then(|lower| Ok([lower, StoredArray::read(&fields, "upper")?]));
    Some(found.ok_or_note(both))
}

/// Whether the fields of a static contact are there.
pub(super) fn has_rest(results: &Results) -> bool {
    fs::exists(results.directory().join("fields.h5"))
}

/// One body, its heights before and their change since, and what is to be said of it.
fn body(
    key: &str,
    title: &str,
    shown: ShownBody,
    states: Option<(&StoredArray, &StoredArray)>,
) -> (Value, Vec<String>) {
    let ShownBody { grid, range, remark, block, has_missing, .. } = shown;
    let mut remarks: Vec<String> = remark.into_iter().map(str::to_owned).collect();
    let pitch = grid.pitch;
    // Negative where material is gone, on either side.
    let sign = if key == "lower" { 1.0 } else { -1.0 };
    let change = states.filter(|(before, after)| after.field.dim() == before.field.dim());
    let change = change.map(|(before, after)| (&after.field - &before.field) * sign);
    if change.as_ref().is_some_and(|change| change.iter().all(|height| *height == 0.0)) {
        remarks.push("No pass has changed this body.".to_owned());
    }
    let change = change.filter(|change| change.iter().any(|height| *height != 0.0));
    let heights = shown.deflated();
    if block > 1 {
        remarks.push(format!("Shown in blocks of {block} × {block} cells, each at its mean height."));
    }
    // A map and profiles of one height show nothing.
    let flat = heights.low == heights.high && !has_missing;
    if flat {
        let [lx, ly] = grid.extent().map(|side| format(side, Dimension::Length));
        remarks.push(format!("Flat, {lx} × {ly}, at the height {}.", format(heights.low, Dimension::Length)));
    }
    let size = |field: &asperity_base::Field| {
        field.iter().filter(|z| z.is_finite()).fold(0.0, |m: f64, z| m.max(z.abs()))
    };
    let body = json!({
        "name": key,
        "title": title,
        "sign": sign,
        "flat": flat,
        "before": heights,
        "change": change.as_ref().map(|change| QuantisedField::even(change, pitch)),
        "range": range,
        "unit": curves::unit(Unit::Length, range[0].abs().max(range[1].abs())),
        "change_unit": change.as_ref().map(|change| curves::unit(Unit::Length, size(change))),
        "length": curves::unit(Unit::Length, grid.extent()[0].max(grid.extent()[1])),
    });
    (body, remarks)
}

/// What a body at rest has been through when its heights are kept.
fn as_it_is(found: &PageData, body: &str) -> Option<String> {
    let of_body = if body == "lower" { &found.case.lower } else { &found.case.upper };
    match (found.moves(), found.updates.last()) {
        (false, Some(last)) => {
            let distance = format(last.distance, Dimension::Length);
            Some(format!("Heights after {distance} of sliding."))
        }
        (false, None) if of_body.plasticity.is_some() => {
            Some("Heights after plastic flow, without the elastic displacement.".to_owned())
        }
        _ => None,
    }
}

/// What laws keep of a body at the end; what they took only where the surface before is not there to compare
/// with.
fn kept(found: &mut PageData, body: &str) -> Vec<Value> {
    let last = found.passes.len();
    let fields = match (found.moves(), last) {
        (true, 0) => return Vec::new(),
        (true, last) => found.results.fields_after(last),
        (false, _) => found.results.static_fields(),
    };
    let Some(fields) = found.ok_or_note(fields) else { return Vec::new() };
    let Some(names) = found.ok_or_note(fields.names()) else { return Vec::new() };
    let mut maps = Vec::new();
    for kept in with::kept() {
        let name = kept.names[usize::from(body == "upper")];
        let Some(of) = kept.map.filter(|_| names.iter().any(|known| known == name)) else { continue };
        if kept.raises < 0.0 && found.moves() {
            continue;
        }
        if let Some(stored) = found.ok_or_note(StoredArray::read(&fields, name)) {
            let map = QuantisedField::positive(&stored.field, stored.grid.pitch);
            let unit = curves::unit(Unit::Length, map.high);
            let title = format!("{} the {body} body.", of.of_body);
            maps.push(
                json!({ "name": kept.state, "title": title, "quantity": of.quantity, "map": map, "unit": unit }),
            );
        }
    }
    maps
}

/// A table of all parameters of both bodies, before and after, without those that are forms.
fn parameters(before: &[Topography; 2], after: Option<&[Topography; 2]>, forms: [bool; 2]) -> String {
    let mut columns: Vec<(String, Vec<Parameter>)> = Vec::new();
    for (index, (_, title)) in [("", "lower"), ("", "upper")].into_iter().enumerate() {
        if forms[index] {
            continue;
        }
        let mut add = |when: &str, body: &Topography| {
            columns.push((format!("{title}{when}"), Parameters::new(body).rows()));
        };
        match figures::changed(before, after, index) {
            None => add("", &before[index]),
            Some(after) => {
                add(" before", &before[index]);
                add(" after", after);
            }
        }
    }
    let mut html = String::from(
        "<div class=\"scroll whole\" tabindex=\"0\" role=\"region\" aria-label=\"ISO 25178 parameters\"><table><thead><tr>\
         <th scope=\"col\">parameter</th>",
    );
    for (title, _) in &columns {
        html += &format!("<th scope=\"col\">{title}</th>");
    }
    html += "<th scope=\"col\">unit</th><th scope=\"col\" class=\"words\">meaning</th></tr></thead><tbody>";
    for row in 0..columns[0].1.len() {
        let of = &columns[0].1[row];
        html += &format!("<tr><th scope=\"row\">{}</th>", escaped(of.symbol));
        // One unit across a row.
        let unit = of.unit.multiple(columns.iter().map(|(_, values)| values[row].value));
        for (_, values) in &columns {
            let number = in_column(values[row].value / unit.factor);
            html += &format!("<td>{}</td>", escaped(&minus(&number)));
        }
        html += &format!("<td class=\"words\">{}</td>", escaped(&unit.symbol));
        let meaning = meaning(of, columns.iter().map(|(_, values)| values[row].value));
        html += &format!("<td class=\"words\">{}</td></tr>", escaped(&meaning));
    }
    html + "</tbody></table></div>"
}
