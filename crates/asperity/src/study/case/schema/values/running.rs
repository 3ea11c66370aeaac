//! Values of `[lower.film]` and `[temperature]`.

use crate::choice::choice;
use crate::error::Result;
use crate::study::case::cursor::Entry;
use crate::units::{Dimension, Kelvin};

/// A [`FilmLaw`](crate::motion::FilmLaw) without its parameters.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::study::case) enum LawKind {
    Arrhenius,
    MechanoChemical,
    SolidLubricant,
}

choice!(LawKind: "arrhenius" => Arrhenius, "mechano-chemical" => MechanoChemical, "solid-lubricant" => SolidLubricant);

/// The temperatures of the lower and of the upper body.
pub(in crate::study::case) fn bulk(entry: &Entry<'_>) -> Result<[Kelvin; 2]> {
    let expected = "a temperature above 0 K such as \"100 °C\", or two: of the lower and of the upper body";
    entry.pair(expected, |item| item.positive(Dimension::Temperature))
}
