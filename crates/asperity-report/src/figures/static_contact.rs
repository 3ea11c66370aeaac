//! Figures of a static contact.

use asperity_base::Field;
use asperity_study::io::fields::{Attribute, Fields};
use asperity_study::{Case, Results};
use ndarray::Array1;

use super::profile::{OverlapFields, Profile, Row, most_loaded};
use super::sheet::Sheet;
use super::stored::{Cap, StoredArray};
use super::{course, force, force_distance, friction, loading, lubrication, plastic, pressure, surfaces};
use crate::draw::{Charts, Colours, Maps, Unit, range_of_heights};
use crate::error::Result;

/// An observer of the arrays of a static contact while they are in memory.
pub trait Witness: Send {
    /// Sees an array.
    fn array(&mut self, name: &'static str, array: &StoredArray);

    /// Sees a body, the lower one first, with the range of its colours and a remark about it.
    fn body(&mut self, body: &StoredArray, range: Option<HeightRange>);

    /// Takes the section through the most loaded spot, if there is one.
    fn profile(&mut self, profile: Option<&Charts>);
}

/// Heights at the ends of the colours, and a remark if others are beyond them.
pub(crate) type HeightRange = ([f64; 2], Option<&'static str>);

/// Draws them, and says of what load they are. Each array is read once, and the witness sees it.
pub(super) fn draw(
    results: &Results,
    sheet: &mut Sheet,
    witness: Option<(&Fields, &mut dyn Witness)>,
) -> Result<String> {
    let opened;
    let (fields, mut witness) = match witness {
        Some((fields, witness)) => (fields, Some(witness)),
        None => {
            opened = results.static_fields()?;
            (&opened, None)
        }
    };
    let p = StoredArray::read(fields, "pressure")?;
    let load = p.field.sum() * p.grid.pitch[0] * p.grid.pitch[1];
    let of = format!("load {}", force(load));
    let touching = StoredArray::touching(fields, &p)?;
    let spot = most_loaded(&p.field, &touching);

    let [lower, upper] = bodies(fields, spot, sheet, &of, &mut witness)?;
    let Deformed { displacement, is_plastic, row } =
        contact(fields, (&p, &touching), spot, sheet, &of, &mut witness)?;
    let profile = match spot.zip(row) {
        Some((spot, yielded)) => {
            let row = Row { lower: lower.view(), upper: upper.view(), plastic: yielded.view() };
            let section =
                Section { pressure: &p, touching: &touching, displacement: &displacement, row, is_plastic };
            section.charts(approach(fields)?, spot, &results.case()?)?
        }
        None => None,
    };
    drop(displacement);
    if let Some(witness) = &mut witness {
        witness.profile(profile.as_ref());
    }
    if let Some(profile) = profile {
        sheet.add("profile", "section through the most loaded spot", &of, || Ok(profile))?;
    }
    if fields.names()?.iter().any(|name| name == "stick") {
        friction::draw(fields, &p, &of, sheet)?;
    }
    if fields.names()?.iter().any(|name| name == "oil_pressure") {
        lubrication::draw(fields, &of, sheet)?;
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
        let curves = curves.into_iter().chain(plastic::of_increments(&increments));
        curves.into_iter().try_for_each(|curves| sheet.add_curves(curves, &of))?;
    }
    Ok(of)
}

/// The bodies as they are pressed together. Returns their heights along the row of the section.
fn bodies(
    fields: &Fields,
    spot: Option<[usize; 2]>,
    sheet: &mut Sheet,
    of: &str,
    witness: &mut Option<&mut dyn Witness>,
) -> Result<[Array1<f64>; 2]> {
    let ranged = |name| -> Result<(StoredArray, Option<HeightRange>)> {
        let body = StoredArray::read(fields, name)?;
        let range = range_of_heights([&body.field]);
        Ok((body, range))
    };
    let (lower, upper) = rayon::join(|| ranged("lower"), || ranged("upper"));
    let ((lower, lower_range), (upper, upper_range)) = (lower?, upper?);
    let (bodies, ranges) = ([&lower, &upper], [lower_range, upper_range]);
    let see = || {
        if let Some(witness) = witness {
            bodies.iter().zip(ranges).for_each(|(body, range)| witness.body(body, range));
        }
    };
    let draw = || -> Result {
        sheet.add("topographies", "topographies", of, || Ok(topographies(bodies, ranges)))?;
        for (name, title, body) in [
            ("relief_lower", "lower body in perspective", &lower),
            ("relief_upper", "upper body in perspective, underside", &upper),
        ] {
            if !body.relief().is_flat() {
                sheet.add(name, title, of, || Ok(body.relief()))?;
            }
        }
        Ok(())
    };
    rayon::join(see, draw).1?;
    let row = |body: &StoredArray| spot.map_or(Array1::zeros(0), |[_, iy]| body.field.column(iy).to_owned());
    let rows = [row(&lower), row(&upper)];
    sheet.add_dear(&surfaces::NAMES, of, || surfaces::at_rest([lower, upper]))?;
    Ok(rows)
}

/// The pressure `p`, the cells `touching` under it, and what it makes of the gap.
fn contact(
    fields: &Fields,
    (p, touching): (&StoredArray, &Field),
    spot: Option<[usize; 2]>,
    sheet: &mut Sheet,
    of: &str,
    witness: &mut Option<&mut dyn Witness>,
) -> Result<Deformed> {
    let cap = Cap::read(fields)?;
    let contact = p.contact_on(touching, &cap);
    let draw = || -> Result {
        sheet.add("pressure", "pressure", of, || Ok(Maps::new(vec![p.pressure("")])))?;
        sheet.add("pressure_histogram", "distribution of the pressure over the contact", of, || {
            Ok(pressure::histogram_on(&p.field, touching, &cap))
        })?;
        sheet.add("contact", "contact", of, || {
            Ok(Maps::new(vec![contact.map("", "", Unit::Number, cap.colours())]))
        })
    };
    let open = || -> Result<[StoredArray; 2]> {
        let plastic = StoredArray::read(fields, "plastic")?;
        let open = open_gap(StoredArray::read(fields, "gap")?, &plastic.field, touching);
        Ok([open, plastic])
    };
    let (drawn, open) = rayon::join(draw, open);
    drawn?;
    let [open, plastic] = open?;
    let draw = || -> Result {
        sheet.add("gap", "deformed gap", of, || {
            let map = open.map("", "gap", Unit::Length, Colours::Gap);
            Ok(Maps::new(vec![map.outlined(touching, "edge of the contact")]))
        })?;
        if cap.is_finite() {
            sheet.add("plastic", "plastic interference", of, || {
                Ok(Maps::new(vec![plastic.map("", "interference", Unit::Length, Colours::Pressure)]))
            })?;
        }
        Ok(())
    };
    let see = || -> Result<StoredArray> {
        let displacement = StoredArray::read(fields, "displacement")?;
        if let Some(witness) = witness {
            let arrays = [
                ("pressure", p),
                ("contact", &contact),
                ("gap", &open),
                ("plastic", &plastic),
                ("displacement", &displacement),
            ];
            arrays.into_iter().for_each(|(name, array)| witness.array(name, array));
        }
        Ok(displacement)
    };
    let (displacement, drawn) = rayon::join(see, draw);
    drawn?;
    let is_plastic = plastic.field.iter().any(|w| *w > 0.0);
    let row = spot.map(|[_, iy]| plastic.field.column(iy).to_owned());
    Ok(Deformed { displacement: displacement?, is_plastic, row })
}

/// Deformation of the bodies, for a section.
struct Deformed {
    displacement: StoredArray,
    /// Whether any cell has yielded.
    is_plastic: bool,
    /// Plastic interference along the row of the section.
    row: Option<Array1<f64>>,
}

/// Fields of a section.
struct Section<'a> {
    pressure: &'a StoredArray,
    /// Above 0 in contact.
    touching: &'a Field,
    displacement: &'a StoredArray,
    row: Row<'a>,
    is_plastic: bool,
}

impl Section<'_> {
    fn charts(self, approach: f64, spot: [usize; 2], case: &Case) -> Result<Option<Charts>> {
        let facing = OverlapFields {
            pressure: &self.pressure.field,
            touching: self.touching,
            row: self.row,
            displacement: &self.displacement.field,
            is_plastic: self.is_plastic,
            approach,
            pitch: self.pressure.grid.pitch,
            column: 0,
        };
        Ok(Profile::through(&facing, spot, case)?.map(Profile::charts))
    }
}

/// The section through the most loaded spot; none without contact.
pub(crate) fn profile(fields: &Fields, case: &Case) -> Result<Option<Charts>> {
    let read = |name| StoredArray::read(fields, name);
    let pressure = read("pressure")?;
    let touching = StoredArray::touching(fields, &pressure)?;
    let Some(spot) = most_loaded(&pressure.field, &touching) else { return Ok(None) };
    let row = |name| -> Result<Array1<f64>> { Ok(read(name)?.field.column(spot[1]).to_owned()) };
    let (lower, upper) = (row("lower")?, row("upper")?);
    let (displacement, plastic) = (read("displacement")?, read("plastic")?);
    let row = Row { lower: lower.view(), upper: upper.view(), plastic: plastic.field.column(spot[1]) };
    let is_plastic = plastic.field.iter().any(|w| *w > 0.0);
    let section =
        Section { pressure: &pressure, touching: &touching, displacement: &displacement, row, is_plastic };
    section.charts(approach(fields)?, spot, case)
}

/// Both bodies, between heights that are not the rarest.
fn topographies<'a>(bodies: [&'a StoredArray; 2], ranges: [Option<HeightRange>; 2]) -> Maps<'a> {
    let mut remarks = Vec::new();
    let titled = bodies.into_iter().zip(["lower body", "upper body, underside"]).zip(ranges);
    let maps = titled.map(|((body, title), range)| {
        let map = body.heights(title);
        match range {
            Some((range, remark)) => {
                remarks.extend(remark);
                map.range(range)
            }
            None => map,
        }
    });
    let maps = maps.collect();
    remarks.into_iter().fold(Maps::new(maps), Maps::remark)
}

/// Open where the bodies are apart, 0 where they touch, negative where they touch and have yielded.
pub(crate) fn open_gap(mut gap: StoredArray, plastic: &Field, touching: &Field) -> StoredArray {
    ndarray::Zip::from(&mut gap.field).and(touching).and(plastic).for_each(|gap, touching, w| {
        *gap = if *touching > 0.0 { -w.max(0.0) } else { (*gap + w).max(0.0) };
    });
    gap
}

/// The approach at which the fields were found; NaN where it is not said.
pub(crate) fn approach(fields: &Fields) -> Result<f64> {
    match fields.attributes()?.get("approach") {
        Some(Attribute::Number(approach)) => Ok(*approach),
        _ => Ok(f64::NAN),
    }
}
