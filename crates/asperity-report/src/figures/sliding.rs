//! Figures of a contact that slides in place: its course, and what it leaves on the bodies.

use asperity_base::units::CELSIUS;
use asperity_contact::each;
use asperity_contact::motion::UpdateRecord;
use asperity_contact::with::views::KeptMap;
use asperity_contact::with::{self, BodyLaw};
use asperity_study::io::fields::Fields;

use super::sheet::Sheet;
use super::stored::StoredArray;
use super::{Curves, charts_over, of_law};
use crate::draw::{Axis, Charts, Colours, Maps, Mark, Series, Unit};
use crate::error::Result;

type Number = fn(&UpdateRecord) -> f64;

pub(super) fn draw(updates: &[UpdateRecord], fields: &Fields, of: &str, sheet: &mut Sheet) -> Result {
    curves(updates).into_iter().try_for_each(|curves| sheet.add_curves(curves, of))?;
    bodies(fields, of, sheet)
}

/// Draws what laws and heat leave on the bodies.
pub(super) fn bodies(fields: &Fields, of: &str, sheet: &mut Sheet) -> Result {
    let names = fields.names()?;
    let given = |name: &str| names.iter().any(|given| given == name);
    for kept in with::kept() {
        let Some(KeptMap { title, quantity, .. }) = kept.map else { continue };
        let mut maps = Vec::new();
        for (name, body) in kept.names.into_iter().zip(["lower", "upper"]) {
            if given(name) {
                maps.push((StoredArray::read(fields, name)?, format!("{body} body")));
            }
        }
        if !maps.is_empty() {
            sheet.add(kept.state, title, of, || {
                let each = maps.iter();
                let each = each.map(|(map, of)| map.map(of, quantity, Unit::Length, Colours::Pressure));
                Ok(Maps::new(each.collect()))
            })?;
        }
    }
    if given("temperature") {
        let shown = StoredArray::read(fields, "temperature")?.celsius();
        if shown.field.iter().any(|t| t.is_finite()) {
            sheet.add("temperature", "temperature of the contact", of, || {
                let map = shown.map("", "temperature", Unit::Of("°C"), Colours::Between);
                Ok(Maps::new(vec![map.missing("no contact")]))
            })?;
        }
    }
    Ok(())
}

/// The curves of its course.
pub(crate) fn curves(updates: &[UpdateRecord]) -> Vec<Curves> {
    vec![Curves::new("sliding", "sliding in place over the distance", charts(updates))]
}

fn charts(updates: &[UpdateRecord]) -> Charts {
    let over = |value: Number| updates.iter().map(|update| [update.distance, value(update)]).collect();
    let alone = |value: Number| vec![Series::new("", over(value), Mark::Line)];
    let mut shown = vec![
        (Axis::of("contact area", "contact_area"), alone(|u| u.contact_area)),
        (Axis::of("largest pressure", "max_pressure"), alone(|u| u.max_pressure)),
    ];
    each!(law L => shown.extend(
        L::OF_UPDATES.iter().map(|shown| of_law(updates.iter(), |update| Some(update.distance), shown))
    ));
    shown.push((
        Axis::linear("largest temperature", Unit::Of("°C")),
        alone(|update| update.max_temperature - CELSIUS),
    ));
    charts_over(&Axis::of("sliding distance", "distance"), shown)
}
