//! Figures of a static contact.

use asperity::Field;
use asperity::io::fields::{Attribute, Fields};
use asperity::study::{Case, Results};
use asperity::units::{Dimension, format};

use super::profile::{OverlapFields, Profile};
use super::sheet::Sheet;
use super::stored::{Cap, StoredArray};
use super::{course, flow, force_distance, friction, loading, pressure, surfaces};
use crate::draw::{Charts, Colours, Maps, Unit, range_of_heights};
use crate::report::Outcome;

/// Draws them, and says of what load they are.
pub(super) fn draw(results: &Results, sheet: &mut Sheet) -> Outcome<String> {
    let fields = results.static_fields()?;
    let p = StoredArray::read(&fields, "pressure")?;
    let load = p.field.sum() * p.grid.pitch[0] * p.grid.pitch[1];
    let of = format!("load {}", format(load, Dimension::Force).replace('-', "−"));

    bodies(&fields, sheet, &of)?;
    contact(&fields, &p, sheet, &of)?;
    if let Some(profile) = profile(&fields, &results.case()?)? {
        sheet.add("profile", "section through the most loaded spot", &of, || Ok(profile))?;
    }
    if fields.names()?.iter().any(|name| name == "stick") {
        friction::draw(&fields, &p, &of, sheet)?;
    }
    let increments = results.increments()?;
    course::solution(&[], &increments, &[])
        .into_iter()
        .try_for_each(|curves| sheet.add_curves(curves, &of))?;
    if increments.len() > 1 {
        let curves = match force_distance::curves(&increments) {
            Some(curves) => vec![curves],
            None => loading::curves(&increments),
        };
        let curves = curves.into_iter().chain(flow::of_increments(&increments));
        curves.into_iter().try_for_each(|curves| sheet.add_curves(curves, &of))?;
    }
    Ok(of)
}

/// The bodies as they are pressed together.
fn bodies(fields: &Fields, sheet: &mut Sheet, of: &str) -> Outcome<()> {
    let bodies = [StoredArray::read(fields, "lower")?, StoredArray::read(fields, "upper")?];
    let [lower, upper] = &bodies;
    sheet.add("topographies", "topographies", of, || Ok(topographies(lower, upper)))?;
    for (name, title, body) in [
        ("relief_lower", "lower body in perspective", lower),
        ("relief_upper", "upper body in perspective, underside", upper),
    ] {
        if !body.relief().is_flat() {
            sheet.add(name, title, of, || Ok(body.relief()))?;
        }
    }
    sheet.add_dear(&surfaces::NAMES, of, || Ok(surfaces::curves(&surfaces::as_measured(&bodies)?, None)))
}

/// The pressure `p`, and what it makes of the gap.
fn contact(fields: &Fields, p: &StoredArray, sheet: &mut Sheet, of: &str) -> Outcome<()> {
    let cap = Cap::read(fields)?;
    sheet.add("pressure", "pressure", of, || Ok(Maps::new(vec![p.pressure("")])))?;
    let touching = StoredArray::touching(fields, p)?;
    sheet.add("pressure_histogram", "distribution of the pressure over the contact", of, || {
        Ok(pressure::histogram_on(&p.field, &touching, &cap))
    })?;
    let contact = p.contact_on(&touching, &cap);
    sheet.add("contact", "contact", of, || {
        Ok(Maps::new(vec![contact.map("", "", Unit::Number, cap.colours())]))
    })?;
    let plastic = StoredArray::read(fields, "plastic")?;
    let open = open_gap(StoredArray::read(fields, "gap")?, &plastic.field, &touching);
    sheet.add("gap", "deformed gap", of, || {
        let map = open.map("", "gap", Unit::Length, Colours::Gap);
        Ok(Maps::new(vec![map.outlined(&touching, "edge of the contact")]))
    })?;
    if cap.is_finite() {
        sheet.add("plastic", "plastic interference", of, || {
            Ok(Maps::new(vec![plastic.map("", "interference", Unit::Length, Colours::Pressure)]))
        })?;
    }
    Ok(())
}

/// The section through the most loaded spot; none without contact.
pub(crate) fn profile(fields: &Fields, case: &Case) -> Outcome<Option<Charts>> {
    let read = |name| StoredArray::read(fields, name);
    let (lower, upper, pressure) = (read("lower")?, read("upper")?, read("pressure")?);
    let (displacement, plastic) = (read("displacement")?, read("plastic")?);
    let facing = OverlapFields {
        lower: &lower.field,
        upper: &upper.field,
        pressure: &pressure.field,
        touching: &StoredArray::touching(fields, &pressure)?,
        displacement: &displacement.field,
        plastic: &plastic.field,
        approach: approach(fields)?,
        pitch: pressure.grid.pitch,
        column: 0,
    };
    Ok(Profile::of(&facing, case)?.map(Profile::charts))
}

/// Both bodies, between heights that are not the rarest.
fn topographies<'a>(lower: &'a StoredArray, upper: &'a StoredArray) -> Maps<'a> {
    let bodies = [(lower, "lower body"), (upper, "upper body, underside")];
    let mut remarks = Vec::new();
    let maps = bodies.map(|(body, title)| {
        let map = body.heights(title);
        match range_of_heights([&body.field]) {
            Some((range, remark)) => {
                remarks.extend(remark);
                map.range(range)
            }
            None => map,
        }
    });
    remarks.into_iter().fold(Maps::new(maps.into()), Maps::remark)
}

/// Open where the bodies are apart, 0 where they touch, negative where they touch and have yielded.
pub(crate) fn open_gap(mut gap: StoredArray, plastic: &Field, touching: &Field) -> StoredArray {
    ndarray::Zip::from(&mut gap.field).and(touching).and(plastic).for_each(|gap, touching, w| {
        *gap = if *touching > 0.0 { -w.max(0.0) } else { (*gap + w).max(0.0) };
    });
    gap
}

/// The approach at which the fields were found; NaN where it is not said.
pub(crate) fn approach(fields: &Fields) -> Outcome<f64> {
    match fields.attributes()?.get("approach") {
        Some(Attribute::Number(approach)) => Ok(*approach),
        _ => Ok(f64::NAN),
    }
}
