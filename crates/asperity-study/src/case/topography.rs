//! `[lower.topography]` and `[upper.topography]`: source and preparation of heights.

use std::path::Path;

use super::cursor::{Entry, Table};
use super::schema::tables::{known_in, suits};
use super::schema::topography::{every, file, form, generate, given};
use super::{Layer, Source, TopographySpec};
use asperity_base::error::Result;
use asperity_base::table::Part;
use asperity_surface::{Form, Generator, Preparation, Resample};

pub(super) fn topography(table: &Table<'_>, folder: &Path) -> Result<TopographySpec> {
    known_in(table)?;
    // Only a program that calls the library can supply heights, so messages do not mention it otherwise.
    let kinds: &[_] = match given::GIVEN.entry(table) {
        Some(_) => &["file", "given", "generate", "form"],
        None => &["file", "generate", "form"],
    };
    let kind = table.exactly_one(
        kinds,
        "for example `file = \"disc.x3p\"`, `generate = \"low-pass\"` or `form = \"sphere\"`",
    )?;
    let source = match kind {
        "file" => measured(table, folder)?,
        "given" => {
            suits(table, "given")?;
            Source::Given { name: given::GIVEN.of(table)? }
        }
        "generate" => Source::Generate {
            generate: Generator::read(table)?,
            seed: generate::SEED.of(table)?,
            shape: generate::SHAPE.of(table)?,
        },
        _ => Source::Form { form: Form::read(table)?, shape: form::SHAPE.of(table)? },
    };
    let pitch = every::PITCH.of(table)?;
    let plus = every::PLUS.entry(table).map(|entry| layers(&entry)).transpose()?.unwrap_or_default();
    Ok(TopographySpec { source, pitch, preparation: preparation(table)?, plus })
}

/// Returns an error if both bodies take their shape or pitch from each other.
pub(super) fn one_tells_the_other(
    lower: &TopographySpec,
    upper: &TopographySpec,
    upper_table: &Table<'_>,
) -> Result<()> {
    let (Some(of_lower), Some(of_upper)) = (lower.lacks().last(), upper.lacks().last()) else {
        return Ok(());
    };
    let table = upper_table.required_table("topography")?;
    let key = upper.lacks().find(|key| lower.lacks().any(|other| other == *key)).unwrap_or(of_upper);
    let why = match lower.lacks().any(|other| other == key) {
        true => "and in [lower.topography]: a body takes from the other what it lacks".to_owned(),
        false => format!("from which [lower.topography] takes its '{of_lower}'"),
    };
    let example = if key == "shape" { "[256, 256]" } else { "\"0.5 um\"" };
    let hint = format!("for example `{key} = {example}`");
    Err(table.error(format!("missing key '{key}' in {}, {why}", table.name()), Some(hint)))
}

fn preparation(table: &Table<'_>) -> Result<Preparation> {
    let (s_filter, l_filter) = (every::S_FILTER.of(table)?, every::L_FILTER.of(table)?);
    if let (Some(shortest), Some(longest), Some(entry)) = (s_filter, l_filter, every::S_FILTER.entry(table))
        && shortest >= longest
    {
        return Err(entry.unexpected("a wavelength below that of 'l_filter'", None));
    }
    Ok(Preparation {
        window: every::WINDOW.of(table)?,
        despike: file::DESPIKE.of(table)?,
        fill: file::FILL.of(table)?,
        level: every::LEVEL.of(table)?,
        mirror: every::MIRROR.of(table)?,
        rotate: every::ROTATE.of(table)?,
        s_filter,
        l_filter,
        filter: every::FILTER.of(table)?,
        resample: every::RESAMPLE.of(table)?.map(Resample::Shape),
        interpolate: every::INTERPOLATE.of(table)?,
        taper: every::TAPER.of(table)?,
    })
}

fn measured(table: &Table<'_>, folder: &Path) -> Result<Source> {
    suits(table, "file")?;
    let path = match file::FILE.of(table)?.as_str() {
        "" => return Err(file::FILE.demand(table)?.unexpected("the name of a file", None)),
        path => folder.join(path),
    };
    Ok(Source::File {
        path,
        channel: file::CHANNEL.of(table)?,
        unit: file::UNIT.of(table)?,
        lines: file::LINES.of(table)?,
        skip: file::SKIP.of(table)?,
    })
}

fn layers(entry: &Entry<'_>) -> Result<Vec<Layer>> {
    let layer = |table: &Table<'_>| {
        known_in(table)?;
        let hint = "for example `generate = \"low-pass\"` or `form = \"sphere\"`";
        match table.exactly_one(&["generate", "form"], hint)? {
            "generate" => {
                Ok(Layer::Generate { generate: Generator::read(table)?, seed: generate::SEED.of(table)? })
            }
            _ => Ok(Layer::Form { form: Form::read(table)? }),
        }
    };
    entry.tables()?.iter().map(layer).collect()
}
