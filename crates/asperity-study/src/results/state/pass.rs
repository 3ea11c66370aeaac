//! Start of the next pass of a motion.
//!
//! ```text
//! /              attributes: pass; approach and slope of the guess (m, 1/m; with a prescribed mean load);
//!                represented, the finished passes of the motion; jump, the passes of the last extrapolation
//! /approach      at each position, m
//! /bearing       cells with p > 0 at each position
//! /cell          those cells, position by position: flat index
//! /pressure      their pressure, Pa
//! /change        its change since the computed pass before, Pa per pass of the motion
//! /persistence   at each position, the fraction of this change that is expected again
//! /sum_lower_1_1 first sum of the first repeating law over the last pass, for the lower body; and so on, if
//!                bodies wear or grow films
//! ```

use std::path::Path;

use crate::io::fields::{Attribute, FieldFile, Fields};
use asperity_base::error::{Error, Result};
use asperity_base::grid::Grid;
use asperity_contact::motion::{Guess, LastExtrapolation, LoadedCells, Sums, WarmStart};

/// Adds the start of the pass after `pass`.
pub(crate) fn add(file: &mut FieldFile, pass: usize, grids: &[Grid; 2], warm: &WarmStart) {
    file.set("pass", pass).set("represented", warm.represented);
    if let Some(last) = &warm.extrapolation {
        file.set("jump", last.passes);
        add_sums(file, "sum", grids, &last.sums);
    }
    if let Some(Guess { approach, slope }) = warm.guess {
        file.set("approach", approach).set("slope", slope);
    }
    let of_positions = |value: fn(&LoadedCells) -> f64| warm.positions.iter().map(value).collect::<Vec<_>>();
    let of_cells = |value: fn(&(u32, f64)) -> f64| {
        warm.positions.iter().flat_map(|p| &p.pressure).map(value).collect::<Vec<_>>()
    };
    for (name, unit, axis, values) in [
        ("approach", "m", "position", of_positions(|p| p.approach)),
        ("bearing", "1", "position", of_positions(|p| p.pressure.len() as f64)),
        ("cell", "1", "bearing", of_cells(|(cell, _)| f64::from(*cell))),
        ("pressure", "Pa", "bearing", of_cells(|(_, p)| *p)),
        ("change", "Pa", "bearing", warm.positions.iter().flat_map(|p| &p.change).copied().collect()),
        ("persistence", "1", "position", of_positions(|p| p.persistence)),
    ] {
        if !values.is_empty() {
            file.add_series(name, unit, axis, 1.0, 0.0, &values);
        }
    }
}

/// Adds sums of laws, each as a field `SUM_BODY_LAW_INDEX`.
pub(super) fn add_sums(file: &mut FieldFile, sum: &str, grids: &[Grid; 2], sums: &[Sums]) {
    for (law, sums) in sums.iter().enumerate() {
        for (body, grid) in grids.iter().enumerate() {
            for (index, values) in sums[body].iter().enumerate() {
                file.add_field(&sum_name(sum, law, body, index), "1", grid, [0.0, 0.0], values);
            }
        }
    }
}

/// Reads sums of laws.
pub(super) fn sums(fields: &Fields, sum: &str) -> Result<Vec<Sums>> {
    let names = fields.names()?;
    let of_body = |law: usize, body: usize| {
        let known =
            (0..).map(|index| sum_name(sum, law, body, index)).take_while(|name| names.contains(name));
        let read = |name: String| {
            fields.read(&name)?.into_field().ok_or(Error::Unsupported("a sum that is not a matrix"))
        };
        known.map(read).collect::<Result<Vec<_>>>()
    };
    let laws = (0..).take_while(|law| names.contains(&sum_name(sum, *law, 0, 0)));
    laws.map(|law| Ok([of_body(law, 0)?, of_body(law, 1)?])).collect()
}

/// Name of the field with a sum of a law over a body; all indices are counted from 0.
fn sum_name(sum: &str, law: usize, body: usize, index: usize) -> String {
    format!("{sum}_{}_{}_{}", ["lower", "upper"][body], law + 1, index + 1)
}

/// Reads the state written by [`add`].
///
/// # Errors
/// [`Error::File`].
pub(crate) fn read(path: &Path) -> Result<WarmStart> {
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
    let [approach, bearing, persistence] = [series("approach")?, series("bearing")?, series("persistence")?];
    let [cell, pressure, change] = [series("cell")?, series("pressure")?, series("change")?];
    let mut cells = cell.into_iter().map(|cell| cell as u32).zip(pressure);
    let mut changes = change.into_iter();
    let positions = approach.into_iter().zip(bearing).zip(persistence);
    let positions = positions.map(|((approach, count), persistence)| LoadedCells {
        approach,
        pressure: cells.by_ref().take(count as usize).collect(),
        change: changes.by_ref().take(count as usize).collect(),
        persistence,
    });
    let positions = positions.collect();
    let guess = number("approach").zip(number("slope"));
    let guess = guess.map(|(approach, slope)| Guess { approach, slope });
    let count = |name: &str| match attributes.get(name) {
        Some(Attribute::Integer(count)) => usize::try_from(*count).ok(),
        _ => None,
    };
    let extrapolation =
        count("jump").map(|passes| Ok::<_, Error>(LastExtrapolation { passes, sums: sums(&fields, "sum")? }));
    let represented = count("represented").or(count("pass")).unwrap_or(0);
    Ok(WarmStart { guess, positions, extrapolation: extrapolation.transpose()?, represented })
}
