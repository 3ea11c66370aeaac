//! Figures of friction: shear and slip, and where it holds.

use asperity_base::Field;
use asperity_study::io::fields::Fields;

use super::sheet::Sheet;
use super::stored::StoredArray;
use crate::draw::{Colours, Maps, Unit};
use crate::error::Result;

/// Where cells under the pressure stick (1) and slip (2).
pub(crate) fn stick(p: &StoredArray, mut stick: StoredArray) -> StoredArray {
    stick.field.zip_mut_with(&p.field, |stick, p| *stick = if *p > 0.0 { 2.0 - *stick } else { 0.0 });
    stick
}

pub(super) fn draw(fields: &Fields, p: &StoredArray, of: &str, sheet: &mut Sheet) -> Result {
    let read = |name| StoredArray::read(fields, name);
    let shear = [read("traction_x")?, read("traction_y")?];
    let slip = [read("slip_x")?, read("slip_y")?];
    let stick = stick(p, read("stick")?);
    let magnitude = |vector: &[StoredArray; 2]| {
        let mut size: Field = vector[0].field.clone();
        size.zip_mut_with(&vector[1].field, |x, y| *x = x.hypot(*y));
        vector[0].with(size)
    };
    let sizes = [magnitude(&shear), magnitude(&slip)];
    sheet.add("shear", "shear, stick and slip", of, || {
        let arrows = [&shear[0].field, &shear[1].field];
        let map =
            sizes[0].map("shear traction on the lower body", "shear", Unit::Pressure, Colours::Pressure);
        Ok(Maps::new(vec![
            map.with_arrows(arrows, "direction of the shear").blank("no contact"),
            stick.map("stick and slip", "", Unit::Number, Colours::STICK),
        ]))
    })?;
    if sizes[1].field.iter().any(|s| *s > 0.0) {
        sheet.add("slip", "slip of the upper over the lower surface", of, || {
            let map = sizes[1].map("", "slip", Unit::Length, Colours::Pressure);
            let arrows = [&slip[0].field, &slip[1].field];
            let map = map.with_arrows(arrows, "direction of the slip");
            Ok(Maps::new(vec![map.outlined(&p.field, "edge of the contact")]))
        })?;
    }
    Ok(())
}
