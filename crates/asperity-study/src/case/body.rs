//! `[lower]` and `[upper]`: the bodies.

use std::path::Path;

use super::cursor::Table;
use super::running::{self, Used};
use super::schema::body::{both, upper};
use super::schema::tables::{self, known_in};
use super::topography::topography;
use super::{Body, Hardness, HardnessMap, Mount, Source};
use asperity_base::error::Result;
use asperity_base::table::Table as _;
use asperity_contact::each_property;
use asperity_contact::material::{Material, NamedMaterial};
use asperity_contact::with::plasticity::Yielding;
use asperity_contact::with::{BodyProperties, BodyProperty as _, Listed as _};
use asperity_surface::UNDERSIDE;

/// Reads a body of a case, whose tables use some constants of a named material; files are relative to the `folder` of the case.
pub(super) fn body(table: &Table<'_>, folder: &Path, used: Used) -> Result<Body> {
    let is_upper = table.path() == "upper";
    known_in(table)?;
    let named = both::MATERIAL.of(table)?;
    let young = both::YOUNG.of_material(table, named.map(|named| named.young))?;
    let poisson = both::POISSON.of_material(table, named.map(|named| named.poisson))?;
    // A body that flows below its surface has no hardness.
    let hardness = hardness(table, folder, named.filter(|_| both::PLASTICITY.entry(table).is_none()))?;
    let coating = tables::read(&both::COATING, table)?;
    let plasticity = tables::read(&both::PLASTICITY, table)?.map(Yielding::resolved);
    let mut properties = BodyProperties::default();
    each_property!(P => if let Some(table) = table.table(P::NAME)? {
        known_in(&table)?;
        P::read(&table)?.in_folder(folder).give(&mut properties);
    });
    let laws = running::laws(table, &hardness)?;
    let topography = topography(&both::TOPOGRAPHY.demand(table)?, folder)?;
    let mount = match upper::MOUNT.of(table)? {
        Some(mount) => Some(mount),
        None if is_upper && may_be_an_underside(&topography.source) => None,
        None if is_upper => Some(Mount::TurnedOver),
        None => Some(Mount::AsIs),
    };
    // Checked above, entry by entry, so this cannot fail.
    let material = Material { coating, ..Material::elastic(young, poisson)? };
    let thermal = running::thermal(table, named, used)?;
    let conducts = named.filter(|_| used.conduction);
    let conductivity = match thermal {
        None => both::CONDUCTIVITY.of(table)?.or(conducts.and_then(|named| named.conductivity)),
        Some(_) => None,
    };
    let resistivity = both::RESISTIVITY.of(table)?.or(conducts.and_then(|named| named.resistivity));
    Ok(Body {
        material,
        hardness,
        plasticity,
        properties,
        thermal,
        conductivity,
        resistivity,
        laws,
        topography,
        mount,
    })
}

/// Whether a results file there may contain the underside of a body.
fn may_be_an_underside(source: &Source) -> bool {
    matches!(source, Source::File { channel: Some(channel), .. } if channel == UNDERSIDE)
}

/// Reads the hardness from the table of a body, by default that of a named material; files are relative to the folder of the case.
fn hardness(table: &Table<'_>, folder: &Path, named: Option<&NamedMaterial>) -> Result<Hardness> {
    if let (None, Some(hardness)) = (both::HARDNESS.entry(table), named.and_then(|named| named.hardness)) {
        return Ok(Hardness::Uniform(hardness));
    }
    Ok(match both::HARDNESS.of(table)? {
        Hardness::Map(map) => Hardness::Map(HardnessMap { path: folder.join(map.path), ..map }),
        other => other,
    })
}
