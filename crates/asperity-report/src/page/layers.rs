//! Maps that a contact may have, and their levels.

use asperity_base::Grid;

use super::quantised::Levels;
use crate::draw::{Colours, Unit};
use crate::figures::StoredArray;

/// One of the maps.
pub(super) struct Layer {
    pub(super) name: &'static str,
    pub(super) title: &'static str,
    pub(super) unit: Unit,
    pub(super) kind: Kind,
}

/// Values of a map.
pub(super) enum Kind {
    /// Above 0 or nothing.
    Positive,
    /// Below 0, too.
    Signed,
    /// From the least to the largest, where there is any.
    Between,
    Classes(Colours),
}

/// All maps that a position may have, in the order of the page.
pub(super) const LAYERS: [Layer; 12] = [
    Layer { name: "pressure", title: "pressure", unit: Unit::Pressure, kind: Kind::Positive },
    Layer { name: "oil_pressure", title: "pressure of the oil", unit: Unit::Pressure, kind: Kind::Positive },
    Layer {
        name: "solid_pressure",
        title: "pressure of the solids",
        unit: Unit::Pressure,
        kind: Kind::Positive,
    },
    Layer { name: "cavity", title: "cavity", unit: Unit::Number, kind: Kind::Positive },
    Layer { name: "contact", title: "contact", unit: Unit::Number, kind: Kind::Classes(Colours::CONTACT) },
    Layer { name: "temperature", title: "temperature", unit: Unit::Of("°C"), kind: Kind::Between },
    Layer { name: "shear", title: "shear on the lower body", unit: Unit::Pressure, kind: Kind::Positive },
    Layer { name: "stick", title: "stick and slip", unit: Unit::Number, kind: Kind::Classes(Colours::STICK) },
    Layer { name: "slip", title: "slip", unit: Unit::Length, kind: Kind::Positive },
    Layer { name: "gap", title: "gap", unit: Unit::Length, kind: Kind::Signed },
    Layer {
        name: "displacement",
        title: "displacement of both bodies",
        unit: Unit::Length,
        kind: Kind::Between,
    },
    Layer { name: "plastic", title: "plastic interference", unit: Unit::Length, kind: Kind::Positive },
];

/// A field in the levels of its layer, if it has one; a pressure that `pulls` with its signs.
pub(super) fn levels_of(name: &str, array: &StoredArray, pulls: bool) -> Option<Levels> {
    let StoredArray { field, grid: Grid { pitch, .. }, place, .. } = array;
    let layer = LAYERS.iter().find(|layer| layer.name == name)?;
    let levels = match layer.kind {
        Kind::Positive if pulls && name == "pressure" => Levels::even(field, *pitch),
        Kind::Positive => Levels::positive(field, *pitch),
        Kind::Signed | Kind::Between => Levels::even(field, *pitch),
        Kind::Classes(_) => Levels::classes(field, *pitch),
    };
    Some(levels.with_corner([*place, 0.0], *pitch))
}
