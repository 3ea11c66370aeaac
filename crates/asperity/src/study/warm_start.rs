//! Where a motion begins its next pass: the file from which a run goes on with the same bits.
//!
//! ```text
//! /              attributes: pass; approach and slope of the guess (m, 1/m; where a mean load is prescribed)
//! /approach      of each position, m
//! /bearing       cells with p > 0 at each position
//! /cell          those cells, position by position: flat index
//! /pressure      their pressure, Pa
//! ```

use std::path::Path;

use crate::error::Result;
use crate::io::fields::{Attribute, FieldFile, Fields};
use crate::motion::{Bearing, Guess, WarmStart};

/// Writes where the pass after `pass` begins into `file`, which says of which run it is.
///
/// # Errors
/// [`Error::File`].
pub(super) fn write(mut file: FieldFile, path: &Path, pass: usize, warm: &WarmStart) -> Result<()> {
    file.set("pass", pass);
    if let Some(Guess { approach, slope }) = warm.guess {
        file.set("approach", approach).set("slope", slope);
    }
    let of_positions = |value: fn(&Bearing) -> f64| warm.positions.iter().map(value).collect::<Vec<_>>();
    let of_cells = |value: fn(&(u32, f64)) -> f64| {
        warm.positions.iter().flat_map(|p| &p.pressure).map(value).collect::<Vec<_>>()
    };
    for (name, unit, axis, values) in [
        ("approach", "m", "position", of_positions(|p| p.approach)),
        ("bearing", "1", "position", of_positions(|p| p.pressure.len() as f64)),
        ("cell", "1", "bearing", of_cells(|(cell, _)| f64::from(*cell))),
        ("pressure", "Pa", "bearing", of_cells(|(_, p)| *p)),
    ] {
        if !values.is_empty() {
            file.add_series(name, unit, axis, 1.0, 0.0, &values);
        }
    }
    file.write(path)
}

/// Reads what [`write`] wrote.
///
/// # Errors
/// [`Error::File`].
pub(super) fn read(path: &Path) -> Result<WarmStart> {
    let fields = Fields::open(path)?;
    let attributes = fields.attributes()?;
    let number = |name: &str| match attributes.get(name) {
        Some(Attribute::Number(number)) => Some(*number),
        _ => None,
    };
    let names = fields.names()?;
    let series = |name: &str| -> Result<Vec<f64>> {
        match names.iter().any(|other| other == name) {
            true => Ok(fields.read(name)?.values.into_iter().collect()),
            false => Ok(Vec::new()),
        }
    };
    let [approach, bearing, cell, pressure] =
        [series("approach")?, series("bearing")?, series("cell")?, series("pressure")?];
    let mut cells = cell.into_iter().map(|cell| cell as u32).zip(pressure);
    let positions = approach.into_iter().zip(bearing).map(|(approach, count)| Bearing {
        approach,
        pressure: cells.by_ref().take(count as usize).collect(),
    });
    let positions = positions.collect();
    let guess = number("approach").zip(number("slope"));
    let guess = guess.map(|(approach, slope)| Guess { approach, slope });
    Ok(WarmStart { guess, positions })
}
