//! Figures of a film of oil: maps of film, pressures and cavity, and a section along x.

use asperity_study::io::fields::Fields;

use super::sheet::Sheet;
use super::stored::StoredArray;
use crate::draw::{Axis, Chart, Charts, Colours, Maps, Mark, Series, Unit};
use crate::error::Result;

/// Share of the largest pressure above which a place belongs to the contact.
const LOADED: f64 = 0.05;

pub(super) fn draw(fields: &Fields, of: &str, sheet: &mut Sheet) -> Result {
    let read = |name| StoredArray::read(fields, name);
    let (film, oil) = (read("gap")?, read("oil_pressure")?);
    let (solids, cavity) = (read("solid_pressure")?, read("cavity")?);
    sheet.add("oil_film", "film of oil", of, || {
        Ok(Maps::new(vec![
            film.map("film", "thickness", Unit::Length, Colours::Logarithmic),
            cavity.map("cavity", "share that is empty", Unit::Number, Colours::Pressure).blank("none"),
            oil.map("oil", "pressure", Unit::Pressure, Colours::Pressure).blank("none"),
            solids.map("solids", "pressure", Unit::Pressure, Colours::Pressure).blank("none"),
        ]))
    })?;
    // The line with the largest pressure of oil and solids together.
    let borne = &oil.field + &solids.field;
    let most = borne.indexed_iter().max_by(|a, b| a.1.total_cmp(b.1)).map_or(0, |((_, iy), _)| iy);
    let along = |array: &StoredArray| -> Vec<[f64; 2]> {
        let x = |ix: usize| (ix as f64 + 0.5) * array.grid.pitch[0];
        array.field.column(most).iter().enumerate().map(|(ix, value)| [x(ix), *value]).collect()
    };
    // The gap far ahead of the contact and behind it would hide the film: the axis ends at twice what it is in it.
    let loaded = LOADED * borne.iter().copied().fold(0.0, f64::max);
    let in_contact =
        film.field.column(most).into_iter().zip(borne.column(most)).filter(|(_, p)| **p > loaded);
    let shown = 2.0 * in_contact.map(|(h, _)| *h).fold(0.0, f64::max);
    let line: Vec<[f64; 2]> =
        along(&film).into_iter().map(|[x, h]| [x, if h <= shown { h } else { f64::NAN }]).collect();
    sheet.add("oil_film_section", "section along x through the largest pressure", of, || {
        let x = || Axis::linear("x", Unit::Length);
        let pressures = vec![
            Series::new("oil", along(&oil), Mark::Line),
            Series::new("solids", along(&solids), Mark::Line),
        ];
        let film = vec![Series::new("", line.clone(), Mark::Line)];
        Ok(Charts {
            charts: vec![
                Chart::new("film", x(), Axis::linear("thickness", Unit::Length), film),
                Chart::new("pressure", x(), Axis::linear("pressure", Unit::Pressure), pressures),
            ],
            columns: 1,
            aspect: 0.36,
        })
    })
}
