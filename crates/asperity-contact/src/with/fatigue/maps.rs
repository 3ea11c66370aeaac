//! Maps of fields below the surface.

use crate::with::views::{Map, Scale};

/// A map of a pure number, linear or logarithmic.
pub(super) const fn map<R>(
    field: &'static str,
    title: &'static str,
    caption: &'static str,
    quantity: &'static str,
) -> Map<R> {
    Map {
        field,
        title,
        caption,
        quantity,
        unit: |_| "1",
        scale: Scale::FromZeroOrLogarithmic,
        is_section: false,
        mark: |_, _| None,
        marked: "largest f",
    }
}

/// A logarithmic map.
pub(super) const fn logarithmic<R>(
    field: &'static str,
    title: &'static str,
    caption: &'static str,
    quantity: &'static str,
    unit: fn(&R) -> &'static str,
) -> Map<R> {
    Map { unit, scale: Scale::Logarithmic(1e-4), ..map(field, title, caption, quantity) }
}
