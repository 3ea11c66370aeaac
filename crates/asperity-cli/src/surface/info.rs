//! `asperity surface info`.

use asperity::Choice;
use asperity::study::exact_pitch;
use asperity::surface::{Axis, GreenwoodWilliamson, LengthUnit, Parameter, Parameters, Unit};
use asperity::units::{self, Metre, Multiple};
use serde_json::{Value, json};

use super::description::{Description, Law, Profiles, Statistics};
use super::table::Table;
use super::{ReadSurface, line_of, read_prepared, suggest_level, without_pitch};
use crate::args::Info;
use crate::report::{Outcome, print};
use asperity_report::words::numbers::meaning;

pub(super) fn info(arguments: &Info) -> Outcome {
    let file = read_prepared(&arguments.input)?;
    if arguments.cutoff.is_some() && file.pitch.is_none() {
        let message = "a cut-off needs a pitch, which the heights have not";
        return Err(without_pitch(message));
    }
    suggest_level(&file.topography);
    let cutoff = arguments.cutoff.or_else(|| cutoff_of_a_line(&file));
    let description = Description::of(&file, cutoff)?;
    if arguments.json {
        print(&format!("{:#}\n", json(&file, &description)))
    } else {
        print(&text(&file, &description))
    }
}

fn json(file: &ReadSurface, description: &Description) -> Value {
    let [low, high] = extremes(file);
    let mut json = json!({
        "format": file.scan.format,
        "channel": file.scan.channel,
        "channels": file.scan.channels,
        "lines": file.scan.lines,
        "shape": file.topography.grid().shape,
        "pitch": file.pitch,
        "undefined": file.topography.undefined(),
        "min": low,
        "max": high,
        "mean": file.topography.mean(),
    });
    let described = serde_json::to_value(description).expect("numbers under names");
    if let (Some(all), Value::Object(more)) = (json.as_object_mut(), described) {
        all.extend(more);
    }
    json
}

fn text(file: &ReadSurface, description: &Description) -> String {
    let mut table = Table::default();
    about_file(&mut table, file);
    let parameters = description.parameters.as_ref().map_or_else(Vec::new, Parameters::rows);
    for family in parameters.chunk_by(|a, b| a.family == b.family) {
        table.title(format!("{} parameters, ISO 25178-2", family[0].family));
        for row in family {
            let alike = parameters.iter().filter(|other| is_of_one_column(row, other));
            let multiple = row.unit.multiple(alike.map(|other| other.value));
            // Without a pitch no length along the surface is known, which `pitch` says.
            let why = file.pitch.map(|_| row.value);
            table.numbers(row.symbol, [row.value], &multiple, meaning(row, why));
        }
    }
    if let Some(statistics) = &description.statistics {
        about_statistics(&mut table, statistics);
    }
    if let Some(profiles) = &description.profiles {
        about_profiles(&mut table, profiles);
    }
    table.text()
}

/// Returns the default cut-off for a line: the longest of ISO 21920-3 that fits five times into the line, else a
/// fifth of the line.
fn cutoff_of_a_line(file: &ReadSurface) -> Option<Metre> {
    const CUTOFFS: [Metre; 5] = [8e-3, 2.5e-3, 0.8e-3, 0.25e-3, 0.08e-3];
    file.pitch?;
    let axis = line_of(&file.topography)?;
    let grid = file.topography.grid();
    let [fifth, pitch] = [grid.extent()[axis as usize] / 5.0, grid.pitch[axis as usize]];
    let cutoff = CUTOFFS.into_iter().find(|cutoff| *cutoff <= fifth).unwrap_or(fifth);
    Some(cutoff).filter(|cutoff| *cutoff >= 2.0 * pitch)
}

/// Whether two parameters are told in one unit: heights with heights, lengths along the surface with such.
fn is_of_one_column(one: &Parameter, other: &Parameter) -> bool {
    let along = |row: &Parameter| row.family == "spatial";
    one.unit == other.unit && along(one) == along(other)
}

fn about_file(table: &mut Table, file: &ReadSurface) {
    let both = |[x, y]: [f64; 2]| format!("{} × {}", Unit::Length.format(x), Unit::Length.format(y));
    let grid = file.topography.grid();
    let [low, high] = extremes(file);
    let undefined = file.topography.undefined();
    let share = units::format_number(100.0 * undefined as f64 / grid.cells() as f64);
    table.words("format", file.scan.format, "");
    let side = if file.scan.is_underside() { "an underside: as [upper] it is mounted as it is" } else { "" };
    table.words("channel", &file.scan.channel, side);
    if file.scan.channels.len() > 1 {
        table.words("channels", file.scan.channels.join(", "), "");
    }
    table.words("shape", format!("{} × {}", grid.shape[0], grid.shape[1]), "samples along x and y");
    if let Some(along) = file.scan.lines {
        let other = if along == Axis::X { Axis::Y } else { Axis::X };
        let remark = format!("direction of a line of the matrix; --lines {} for the other", other.word());
        table.words("lines", along.word(), &remark);
    }
    let none = || "– (the file has none: --pitch)".to_owned();
    let pitch = file.pitch.map_or_else(none, |[x, y]| format!("{} × {}", exact_pitch(x), exact_pitch(y)));
    table.words("pitch", pitch, "");
    table.words("extent", file.pitch.map_or_else(|| "–".to_owned(), |_| both(grid.extent())), "");
    if file.scan.unit != LengthUnit::Known {
        table.words("unit", "m (the file has none: --unit)", "");
    }
    if undefined > 0 {
        table.words("undefined", format!("{undefined} ({share} %)"), "samples without a height");
    }
    let mean = file.topography.mean();
    // The rounding error of a subtracted mean.
    let mean = if mean.abs() < 1e-9 * (high - low) { 0.0 } else { mean };
    let heights = Unit::Length.multiple([low.abs().max(high.abs())]);
    for (name, value) in [("min", low), ("max", high), ("mean", mean)] {
        table.numbers(name, [value], &heights, "");
    }
}

fn about_statistics(table: &mut Table, statistics: &Statistics) {
    let Statistics { moments, bandwidth, asperities, self_affine } = statistics;
    let in_units = |factor: f64, symbol: &str| Multiple { factor, symbol: symbol.to_owned() };
    let pure = in_units(1.0, "");
    table.title("spectral moments, along x | along y");
    table.numbers("m0", [moments.m0], &Unit::Area.multiple([moments.m0]), "mean square height");
    table.numbers("m2", moments.m2, &pure, "mean square slope");
    table.numbers("m4", moments.m4, &in_units(1e12, "/µm²"), "mean square second derivative");
    table.numbers("α", [*bandwidth], &pure, "Nayak's bandwidth, m0 m4/m2²");
    table.title("asperities of Greenwood and Williamson, counted as summits | from the moments");
    let heights = [&asperities.counted, &asperities.by_moments].map(|found| found.height_deviation);
    let heights = Unit::Length.multiple(heights);
    let mut row = |name, unit: Option<Unit>, value: fn(&GreenwoodWilliamson) -> f64, remark| {
        let values = [&asperities.counted, &asperities.by_moments].map(value);
        let multiple = unit.map_or_else(|| heights.clone(), |unit| unit.multiple(values));
        table.numbers(name, values, &multiple, remark);
    };
    row("η", Some(Unit::PerArea), |found| found.density, "density");
    row("R", Some(Unit::Length), |found| found.radius, "radius of the tips");
    row("σs", None, |found| found.height_deviation, "standard deviation of their heights");
    row("zs", None, |found| found.mean_height, "mean height above that of the surface");
    if let Some(Law { fit: law, doubt, .. }) = self_affine {
        table.title("self-affine law, on the longest range of the spectrum that follows one");
        table.words("H", format!("{:.3} ± {:.3}", law.hurst, law.hurst_error), "Hurst exponent");
        let wavelength = |q: f64| Unit::Length.format(std::f64::consts::TAU / q);
        let range = format!("{} … {}", wavelength(law.range[1]), wavelength(law.range[0]));
        table.words("range", range, "wavelengths");
        if let Some(doubt) = doubt {
            table.words("H", doubt, "");
        }
    }
}

/// The parameters along both axes, or along the only one of a line.
fn about_profiles(table: &mut Table, profiles: &Profiles) {
    let cutoff = Unit::Length.format(profiles.cutoff);
    let axes = [("along x", &profiles.x), ("along y", &profiles.y)];
    let shown = axes.iter().filter_map(|(name, parameters)| Some((*name, parameters.as_ref()?.rows())));
    let (names, columns): (Vec<_>, Vec<_>) = shown.unzip();
    table.title(format!("profile parameters, ISO 21920-2, cut-off {cutoff}: {}", names.join(" | ")));
    // These lengths lie along the surface, the others are heights.
    let along = |row: &Parameter| ["Rsm", "Rdl"].contains(&row.symbol);
    for (n, row) in columns.first().into_iter().flatten().enumerate() {
        let alike = columns.iter().flatten();
        let alike = alike.filter(|other| row.unit == other.unit && along(row) == along(other));
        let multiple = row.unit.multiple(alike.map(|other| other.value));
        table.numbers(row.symbol, columns.iter().map(|column| column[n].value), &multiple, row.meaning);
    }
}

/// Returns NaN if nothing is defined.
fn extremes(file: &ReadSurface) -> [f64; 2] {
    let heights = file.topography.heights();
    [f64::min, f64::max].map(|pick| heights.iter().copied().fold(f64::NAN, pick))
}
