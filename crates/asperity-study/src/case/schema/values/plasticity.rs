//! Values of `[plasticity]` and `[lower.plasticity]`.

use crate::case::cursor::Entry;
use asperity_base::choice::choice;
use asperity_base::error::Result;
use asperity_base::units::{Dimension, Pascal};

/// The passes of a motion whose volumes are stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Keep {
    /// The last one.
    Last,
    /// All of them.
    Passes,
}

choice!(Keep: "last" => Last, "passes" => Passes);

/// A measured curve of the yield stress.
pub(in crate::case) fn curve(entry: &Entry<'_>) -> Result<Vec<(f64, Pascal)>> {
    const EXPECTED: &str =
        "points of plastic strain and stress such as [[0, \"1.5 GPa\"], [0.01, \"1.7 GPa\"]]";
    let point = |item: &Entry<'_>| -> Result<(f64, Pascal)> {
        let values = item.items(EXPECTED)?;
        match values.as_slice() {
            [strain, stress] => Ok((
                strain.number(|strain| strain >= 0.0, "a plastic strain of at least 0")?,
                stress.positive(Dimension::Pressure)?,
            )),
            _ => Err(item.unexpected(EXPECTED, None)),
        }
    };
    let points = entry.list(EXPECTED, point)?;
    let first = points.first().ok_or_else(|| entry.unexpected(EXPECTED, None))?;
    let hint = |text: &str| Some(text.to_owned());
    if first.0 != 0.0 {
        return Err(entry.error(
            "the first point of 'curve' has a plastic strain above 0".to_owned(),
            hint("begin with the yield stress of the virgin body, `[0, \"1.5 GPa\"]`"),
        ));
    }
    if points.windows(2).any(|pair| pair[1].0 <= pair[0].0) {
        return Err(
            entry.error("the strains of 'curve' do not increase from point to point".to_owned(), None)
        );
    }
    if points.windows(2).any(|pair| pair[1].1 < pair[0].1) {
        let softens = hint(
            "a falling curve localises strain in bands whose width depends on the grid: make the curve constant there",
        );
        return Err(entry.error("the stresses of 'curve' fall".to_owned(), softens));
    }
    Ok(points)
}
