//! `[lower]` and `[upper]`: the bodies.

use std::path::Path;

use super::cursor::Table;
use super::plasticity::yielding;
use super::running;
use super::schema::body::{both, coating as coating_keys, upper};
use super::schema::tables::known_in;
use super::topography::topography;
use super::{Body, Hardness, HardnessMap, Mount, Source};
use asperity_base::error::Result;
use asperity_contact::material::{Coating, Material};
use asperity_surface::UNDERSIDE;

/// Reads a body of a case, whose thermal conductivity may be given alone if `is_alone`; files are relative to the `folder` of the case.
pub(super) fn body(table: &Table<'_>, folder: &Path, is_alone: bool) -> Result<Body> {
    let is_upper = table.path() == "upper";
    known_in(table)?;
    let young = both::YOUNG.of(table)?;
    let poisson = both::POISSON.of(table)?;
    let hardness = hardness(table, folder)?;
    let coating = both::COATING.of(table)?.map(|table| coating(&table)).transpose()?;
    let plasticity = both::PLASTICITY.of(table)?.map(|table| yielding(&table)).transpose()?;
    let film = both::FILM.of(table)?.map(|table| running::film(&table, &hardness)).transpose()?;
    let wear = both::WEAR.of(table)?.map(|table| running::wear(&table, &hardness)).transpose()?;
    let topography = topography(&both::TOPOGRAPHY.demand(table)?, folder)?;
    let mount = match upper::MOUNT.of(table)? {
        Some(mount) => Some(mount),
        None if is_upper && may_be_an_underside(&topography.source) => None,
        None if is_upper => Some(Mount::TurnedOver),
        None => Some(Mount::AsIs),
    };
    // Checked above, entry by entry, so this cannot fail.
    let material = Material { coating, ..Material::elastic(young, poisson)? };
    let thermal = running::thermal(table, is_alone)?;
    let conductivity = if thermal.is_none() { both::CONDUCTIVITY.of(table)? } else { None };
    let resistivity = both::RESISTIVITY.of(table)?;
    Ok(Body {
        material,
        hardness,
        plasticity,
        thermal,
        conductivity,
        resistivity,
        wear,
        film,
        topography,
        mount,
    })
}

fn coating(table: &Table<'_>) -> Result<Coating> {
    known_in(table)?;
    let (thickness, young) = (coating_keys::THICKNESS.of(table)?, coating_keys::YOUNG.of(table)?);
    let coating = Coating::new(thickness, young, coating_keys::POISSON.of(table)?)?;
    let conductivity = coating_keys::CONDUCTIVITY.of(table)?;
    Ok(Coating { conductivity, resistivity: coating_keys::RESISTIVITY.of(table)?, ..coating })
}

/// Whether a results file there may contain the underside of a body.
fn may_be_an_underside(source: &Source) -> bool {
    matches!(source, Source::File { channel: Some(channel), .. } if channel == UNDERSIDE)
}

/// Reads the hardness from the table of a body; files are relative to the folder of the case.
fn hardness(table: &Table<'_>, folder: &Path) -> Result<Hardness> {
    Ok(match both::HARDNESS.of(table)? {
        Hardness::Map(map) => Hardness::Map(HardnessMap { path: folder.join(map.path), ..map }),
        other => other,
    })
}
