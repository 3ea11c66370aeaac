//! Where a motion begins its next pass: the file from which a run goes on with the same bits.
//!
//! ```text
//! /              attributes: version, pass, approach and slope of the guess (m, 1/m; where a mean load is prescribed),
//!                digest: MD5 of all numbers of this file and of the heights after the pass
//! /approach      of each position, m
//! /bearing       cells with p > 0 at each position
//! /cell          those cells, position by position: flat index
//! /pressure      their pressure, Pa
//! ```

use std::path::Path;

use md5::{Digest, Md5};

use crate::error::{Error, Result};
use crate::io::fields::{Attribute, FieldFile, Fields};
use crate::motion::{Bearing, Guess, Pair, WarmStart};

/// Writes where the pass after `pass` begins, which leaves the `pair` behind.
///
/// # Errors
/// [`Error::File`].
pub(super) fn write(path: &Path, pass: usize, warm: &WarmStart, pair: &Pair) -> Result<()> {
    let mut file = FieldFile::new();
    file.set("version", env!("CARGO_PKG_VERSION"))
        .set("pass", pass)
        .set("digest", digest(warm, pair).as_str());
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

/// Reads what [`write`] wrote beside the surfaces of `pair`.
///
/// # Errors
/// [`Error::NoWarmStart`] where the file is missing, damaged, or was written beside other surfaces.
pub(super) fn read(path: &Path, pair: &Pair) -> Result<WarmStart> {
    let lost = |defect| Error::NoWarmStart { path: path.to_owned(), defect };
    if !path.exists() {
        return Err(lost("is missing"));
    }
    let (warm, written) = numbers(path).ok().flatten().ok_or_else(|| lost("is damaged"))?;
    if digest(&warm, pair) != written {
        return Err(lost("does not belong to the surfaces beside it"));
    }
    Ok(warm)
}

/// The numbers of the file, and their digest as written.
fn numbers(path: &Path) -> Result<Option<(WarmStart, String)>> {
    let fields = Fields::open(path)?;
    let attributes = fields.attributes()?;
    let number = |name: &str| match attributes.get(name) {
        Some(Attribute::Number(number)) => Some(*number),
        _ => None,
    };
    let Some(Attribute::Text(written)) = attributes.get("digest") else { return Ok(None) };
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
    Ok(Some((WarmStart { guess, positions }, written.clone())))
}

/// MD5 of the heights of both bodies and of all numbers of a warm start.
fn digest(warm: &WarmStart, pair: &Pair) -> String {
    let mut digest = Md5::new();
    let mut take = |value: f64| digest.update(value.to_le_bytes());
    pair.lower.iter().chain(&pair.upper).for_each(|z| take(*z));
    warm.guess.iter().for_each(|guess| [guess.approach, guess.slope].into_iter().for_each(&mut take));
    for position in &warm.positions {
        take(position.approach);
        take(position.pressure.len() as f64);
        position.pressure.iter().for_each(|(cell, p)| [f64::from(*cell), *p].into_iter().for_each(&mut take));
    }
    digest.finalize().iter().map(|byte| format!("{byte:02x}")).collect()
}
