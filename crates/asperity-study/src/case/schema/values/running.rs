//! Values of `[lower.film]` and `[temperature]`.

use crate::case::cursor::Entry;
use asperity_base::choice::choice;
use asperity_base::error::Result;
use asperity_base::units::{Dimension, Kelvin};

/// A [`FilmLaw`](asperity_contact::motion::FilmLaw) without its parameters.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::case) enum LawKind {
    Arrhenius,
    MechanoChemical,
    SolidLubricant,
}

choice!(LawKind: "arrhenius" => Arrhenius, "mechano-chemical" => MechanoChemical, "solid-lubricant" => SolidLubricant);

/// The temperatures of the lower and of the upper body.
pub(in crate::case) fn bulk(entry: &Entry<'_>) -> Result<[Kelvin; 2]> {
    let expected = "a temperature above 0 K such as \"100 °C\", or two: of the lower and of the upper body";
    entry.pair(expected, |item| item.positive(Dimension::Temperature))
}
