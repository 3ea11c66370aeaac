//! `[lower.topography]` and `[upper.topography]`: source and preparation of heights.

use std::path::Path;

use super::cursor::{Entry, Table};
use super::schema::tables::{known_in, suits};
use super::schema::topography::{
    autocorrelation, cone, cylinder, ellipsoid, every, file, form, generate, given, grooves, low_pass,
    self_affine, sinusoid, sphere,
};
use super::schema::values::topography::{Method, Shape};
use super::{Layer, Source, TopographySpec};
use asperity_base::choice::Choice;
use asperity_base::error::Result;
use asperity_surface::{
    Amplitude, Autocorrelation, Form, Generator, HeightDistribution, LowPass, Preparation, Resample,
    SelfAffine,
};

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
            generate: generator(table)?,
            seed: generate::SEED.of(table)?,
            shape: generate::SHAPE.of(table)?,
        },
        _ => Source::Form { form: ideal_form(table)?, shape: form::SHAPE.of(table)? },
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
                Ok(Layer::Generate { generate: generator(table)?, seed: generate::SEED.of(table)? })
            }
            _ => Ok(Layer::Form { form: ideal_form(table)? }),
        }
    };
    entry.tables()?.iter().map(layer).collect()
}

fn generator(table: &Table<'_>) -> Result<Generator> {
    let method = generate::GENERATE.of(table)?;
    suits(table, &format!("generate = \"{}\"", method.word()))?;
    Ok(match method {
        Method::LowPass => Generator::LowPass(LowPass {
            sq: low_pass::SQ.of(table)?,
            cutoff: low_pass::CUTOFF.of(table)?,
            band: low_pass::BAND.of(table)?,
            heights: heights(table)?,
        }),
        Method::Autocorrelation => Generator::Autocorrelation(Autocorrelation {
            sq: autocorrelation::SQ.of(table)?,
            correlation_length: autocorrelation::CORRELATION_LENGTH.of(table)?,
            decay: autocorrelation::DECAY.of(table)?,
            lay: autocorrelation::LAY.of(table)?,
            heights: heights(table)?,
        }),
        Method::SelfAffine => {
            let hint = "'sq' is the rms height, a length; 'sdq' the rms slope, a number";
            let amplitude = match table.exactly_one(&["sq", "sdq"], hint)? {
                "sq" => Amplitude::Sq(self_affine::SQ.required(table)?),
                _ => Amplitude::Sdq(self_affine::SDQ.required(table)?),
            };
            let hurst = self_affine::HURST.of(table)?;
            let (rolloff, shortest) = (self_affine::ROLLOFF.of(table)?, self_affine::SHORTEST.of(table)?);
            if let (Some(longest), Some(shortest), Some(entry)) =
                (rolloff, shortest, self_affine::SHORTEST.entry(table))
                && shortest >= longest
            {
                return Err(entry.unexpected("a wavelength below that of 'rolloff'", None));
            }
            Generator::SelfAffine(SelfAffine { hurst, rolloff, shortest, amplitude })
        }
    })
}

/// Reads skewness and kurtosis. A skewness needs a kurtosis, which bounds its range.
fn heights(table: &Table<'_>) -> Result<HeightDistribution> {
    if low_pass::SSK.entry(table).is_some() {
        low_pass::SKU.demand(table)?;
    }
    Ok(HeightDistribution { ssk: low_pass::SSK.of(table)?, sku: low_pass::SKU.of(table)? })
}

fn ideal_form(table: &Table<'_>) -> Result<Form> {
    let shape = form::FORM.of(table)?;
    suits(table, &format!("form = \"{}\"", shape.word()))?;
    Ok(match shape {
        Shape::Sphere => Form::Sphere { radius: sphere::RADIUS.of(table)? },
        Shape::Ellipsoid => Form::Ellipsoid { radius: ellipsoid::RADIUS.of(table)? },
        Shape::Cylinder => {
            Form::Cylinder { radius: cylinder::RADIUS.of(table)?, axis: cylinder::AXIS.of(table)? }
        }
        Shape::Cone => {
            let angle = cone::ANGLE.of(table)?;
            if angle >= std::f64::consts::FRAC_PI_2 {
                let hint = "a number without a unit is in radians".to_owned();
                let expected = "an angle below 90 deg such as \"5 deg\"";
                return Err(cone::ANGLE.demand(table)?.unexpected(expected, Some(hint)));
            }
            Form::Cone { angle }
        }
        Shape::Flat => Form::Flat,
        Shape::Sinusoid => Form::Sinusoid {
            amplitude: sinusoid::AMPLITUDE.of(table)?,
            wavelength: sinusoid::WAVELENGTH.of(table)?,
        },
        Shape::Grooves => Form::Grooves {
            period: grooves::PERIOD.of(table)?,
            depth: grooves::DEPTH.of(table)?,
            profile: grooves::PROFILE.of(table)?,
            lay: grooves::LAY.of(table)?,
        },
    })
}

// Values of the forms.
