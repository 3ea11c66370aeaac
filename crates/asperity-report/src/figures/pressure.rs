//! How pressures are distributed.

use asperity_base::Field;

use super::stored::Cap;
use crate::draw::{Axis, Chart, Charts, Mark, Series, Unit};

/// Classes of a histogram.
const CLASSES: usize = 40;

/// The shares of the contact area in classes of pressure, with the cap where there is one: of cells with a
/// pressure.
pub(crate) fn histogram<'a>(fields: impl IntoIterator<Item = &'a Field> + Clone, cap: &Cap) -> Charts {
    let values = || fields.clone().into_iter().flat_map(|field| field.iter().copied());
    distribution(|| values().filter(|p| p.abs() > 0.0), cap)
}

/// The shares of the contact area in classes of pressure, of the cells that are `touching`: above 0.
pub(super) fn histogram_on(pressure: &Field, touching: &Field, cap: &Cap) -> Charts {
    let cells = || pressure.iter().zip(touching).filter(|(_, touching)| **touching > 0.0);
    distribution(|| cells().map(|(p, _)| *p), cap)
}

fn distribution<P: Iterator<Item = f64>>(pressures: impl Fn() -> P, cap: &Cap) -> Charts {
    // Cells in contact may be under tension.
    let [least, largest] = [f64::min, f64::max].map(|pick| pressures().fold(0.0, pick));
    let mut counts = [0usize; CLASSES];
    for p in pressures() {
        counts[(((p - least) / (largest - least) * CLASSES as f64) as usize).min(CLASSES - 1)] += 1;
    }
    let all: usize = counts.iter().sum();
    let width = (largest - least) / CLASSES as f64;
    let share = |count: usize| 100.0 * count as f64 / all as f64;
    let bars: Vec<[f64; 2]> = if all == 0 {
        Vec::new()
    } else {
        counts.iter().enumerate().map(|(i, n)| [least + (i as f64 + 0.5) * width, share(*n)]).collect()
    };
    let highest = bars.iter().map(|bar| bar[1]).fold(0.0, f64::max);
    let mut series = vec![Series::new("cells in contact", bars, Mark::Bars)];
    if let Cap::Number(cap) = cap
        && cap.is_finite()
        && *cap <= 1.2 * largest
    {
        series.push(Series::new("hardness", vec![[*cap, 0.0], [*cap, highest]], Mark::Dashed));
    }
    let x = Axis { range: Some([1.03 * least, 1.03 * largest]), ..Axis::linear("pressure", Unit::Pressure) };
    Chart::new("", x, Axis::linear("share of the contact area", Unit::Of("%")), series).into()
}
