//! Topographies: what a file says, what a table makes of it, and its roughness.

use std::path::Path;

use asperity_base::grid::Grid;
use asperity_report::describe::{
    Description, Row, Table, cutoff_of_a_line, findings_in_words, line_of, prevailing_form,
};
use asperity_report::draw::{self, Caption, Paper};
use asperity_report::figures::RINGS;
use asperity_report::page;
use asperity_study::{PreparedTopography, SurfaceInput, topography, topography_spec};
use asperity_surface::{LengthUnit, Spectrum, Topography, Window};
use serde_json::{Value, json};

use crate::{Failure, Result};

/// Points of the material ratio curve.
const POINTS: usize = 201;

/// Returns what a file says by itself, read with some keys of the table of a topography.
pub fn scan(name: &str, reading: &str) -> Result<Value> {
    let mut table = parsed(reading)?;
    table.insert("file".to_owned(), name.into());
    let scan = topography_spec(&wrapped(table), Path::new(""))?.source.reading().scan(name)?;
    let (nx, ny) = scan.heights.dim();
    Ok(json!({
        "format": scan.format,
        "channel": scan.channel,
        "channels": scan.channels,
        "shape": [nx, ny],
        "pitch": scan.pitch,
        "unit_known": scan.unit == LengthUnit::Known,
        "lines": scan.lines,
        "undefined": scan.heights.iter().filter(|height| height.is_nan()).count(),
        "underside": scan.is_underside(),
    }))
}

fn parsed(table: &str) -> Result<toml::Table> {
    toml::from_str(table).map_err(|error| Failure::of_toml(table, &error))
}

/// Returns the text of a file with nothing but the table of a topography.
fn wrapped(table: toml::Table) -> String {
    toml::Table::from_iter([("topography".to_owned(), toml::Value::Table(table))]).to_string()
}

/// A topography with its origin.
#[derive(Debug)]
pub struct Surface {
    prepared: PreparedTopography,
}

impl Surface {
    /// Reads or generates the topography of a table, and prepares it.
    pub fn new(table: &str) -> Result<Self> {
        let prepared = topography(&wrapped(parsed(table)?), Path::new(""), SurfaceInput::default());
        let failed = |error| {
            let failure = Failure::from(error);
            let key = failure.key.map(|key| key.trim_start_matches("topography.").to_owned());
            Failure { key, place: None, ..failure }
        };
        Ok(Self { prepared: prepared.map_err(failed)? })
    }

    fn topography(&self) -> &Topography {
        &self.prepared.topography
    }

    /// The surface in numbers and curves.
    pub fn about(&self) -> Result<Value> {
        let topography = self.topography();
        let Grid { shape, pitch } = *topography.grid();
        let defined = || topography.heights().iter().copied().filter(|height| height.is_finite());
        let origin = self.prepared.origin.as_ref();
        let description = Description::new(topography, true, cutoff_of_a_line(topography))?;
        let mut table = Table::default();
        description.add_to(&mut table);
        let mut findings = findings_in_words(&self.prepared.findings, topography);
        let missing = self.prepared.findings.undefined.saturating_sub(topography.undefined());
        if missing > 0 {
            findings.insert(0, format!("{missing} missing heights filled"));
        }
        let advice = prevailing_form(topography).map(|(cause, share, level)| {
            format!("{cause} {:.1} % of Sq²; `level = \"{level}\"` removes it", 100.0 * share)
        });
        let is_rough = topography.defined() > 1 && topography.sq() > 0.0;
        Ok(json!({
            "format": origin.map(|origin| origin.format),
            "channel": origin.map(|origin| &origin.channel),
            "shape": shape,
            "pitch": pitch,
            "extent": topography.grid().extent(),
            "min": defined().fold(f64::NAN, f64::min),
            "max": defined().fold(f64::NAN, f64::max),
            "mean": topography.mean(),
            "undefined": topography.undefined(),
            "findings": findings,
            "advice": advice,
            "sections": sections(&table),
            "numbers": description,
            "spectrum": is_rough.then(|| spectrum(topography)),
            "material_ratio": is_rough.then(|| material_ratio(topography)).transpose()?,
        }))
    }

    /// The heights as the programs of a page draw them.
    pub fn map(&self) -> Value {
        page::map_of_heights(self.topography().heights(), self.topography().grid().pitch)
    }

    /// The heights, the index along y fastest.
    pub fn heights(&self) -> Vec<f32> {
        self.topography().heights().iter().map(|height| *height as f32).collect()
    }

    /// Writes the heights to a file, or draws them, by the end of its name.
    pub fn write(&self, name: &str) -> Result {
        let path = Path::new(name);
        if path.extension().is_some_and(|extension| extension == "png") {
            let title = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            let picture = draw::heights(self.topography().heights(), self.topography().grid());
            let drawn = draw::save(path, &picture, &Caption { title, of: String::new() }, &Paper::default());
            return drawn.map_err(|error| Failure::input(error.to_string()));
        }
        Ok(self.topography().write(path)?)
    }
}

/// Rows by sections.
fn sections(table: &Table) -> Value {
    let parts = table.rows().chunk_by(|_, next| !matches!(next, Row::Title(_)));
    let section = |rows: &[Row]| {
        let title =
            rows.first().map_or("", |row| if let Row::Title(title) = row { title.trim() } else { "" });
        let row = |row: &Row| match row {
            Row::Title(_) => None,
            Row::Words { name, value, remark } => {
                Some(json!({ "name": name, "numbers": [value], "unit": "", "remark": remark }))
            }
            Row::Numbers { name, numbers, unit, remark } => {
                Some(json!({ "name": name, "numbers": numbers, "unit": unit, "remark": remark }))
            }
        };
        json!({ "title": title, "rows": rows.iter().filter_map(row).collect::<Vec<_>>() })
    };
    parts.map(section).collect()
}

/// The spectrum over wave numbers: the radial mean, or that along a line.
fn spectrum(topography: &Topography) -> Value {
    let spectrum = Spectrum::new(topography, Window::Hann);
    let points = match line_of(topography) {
        None => spectrum.radial(RINGS),
        Some(axis) => spectrum.along(axis),
    };
    let shown = || points.iter().filter(|point| point.wave_number > 0.0 && point.density > 0.0);
    json!({
        "wavenumber": shown().map(|point| point.wave_number).collect::<Vec<_>>(),
        "power": shown().map(|point| point.density).collect::<Vec<_>>(),
    })
}

fn material_ratio(topography: &Topography) -> Result<Value> {
    let points = topography.bearing_curve()?.sampled(POINTS);
    let [ratio, height] = [0, 1].map(|k| points.iter().map(|point| point[k]).collect::<Vec<f64>>());
    Ok(json!({ "ratio": ratio, "height": height }))
}
