//! `asperity surface info`.

use std::fmt::Write as _;

use asperity::surface::Parameters;
use asperity::units::{self, Dimension};
use serde_json::{Value, json};

use super::{Read, read_prepared};
use crate::args::Info;
use crate::report::{Outcome, print};

pub(super) fn info(arguments: &Info) -> Outcome {
    let file = read_prepared(&arguments.file, &arguments.reading, &arguments.preparing)?;
    let mut parameters = file.topography.parameters();
    if file.pitch.is_none() {
        // A slope needs lengths along the surface.
        parameters.sdq = f64::NAN;
    }
    if arguments.json {
        print(&format!("{:#}\n", json(&file, &parameters)));
    } else {
        print(&text(&file, &parameters));
    }
    Ok(())
}

fn json(file: &Read, parameters: &Parameters) -> Value {
    let [low, high] = extremes(file);
    json!({
        "format": file.scan.format,
        "channel": file.scan.channel,
        "channels": file.scan.channels,
        "shape": file.topography.grid().shape,
        "pitch": file.pitch,
        "undefined": file.topography.undefined(),
        "min": low,
        "max": high,
        "mean": file.topography.mean(),
        "parameters": parameters,
    })
}

fn text(file: &Read, parameters: &Parameters) -> String {
    let length = |value: f64| match value.is_nan() {
        true => "–".to_owned(),
        false => units::format(value, Dimension::Length),
    };
    let number = |value: f64| if value.is_nan() { "–".to_owned() } else { format!("{value:.4}") };
    let both = |[x, y]: [f64; 2]| format!("{} × {}", length(x), length(y));
    let grid = file.topography.grid();
    let none = || "– (the file has none: --pitch)".to_owned();
    let [low, high] = extremes(file);
    let undefined = file.topography.undefined();
    let share = 100.0 * undefined as f64 / grid.cells() as f64;
    let mut rows = vec![
        ("format", file.scan.format.to_owned(), ""),
        ("channel", file.scan.channel.clone(), ""),
        ("shape", format!("{} × {}", grid.shape[0], grid.shape[1]), "samples along x and y"),
        ("pitch", file.pitch.map_or_else(none, both), ""),
        ("extent", file.pitch.map_or_else(|| "–".to_owned(), |_| both(grid.extent())), ""),
        ("undefined", format!("{undefined} ({share:.2} %)"), ""),
        ("min", length(low), ""),
        ("max", length(high), ""),
        ("mean", length(file.topography.mean()), ""),
        ("Sa", length(parameters.sa), "arithmetical mean height"),
        ("Sq", length(parameters.sq), "rms height"),
        ("Ssk", number(parameters.ssk), "skewness"),
        ("Sku", number(parameters.sku), "kurtosis"),
        ("Sz", length(parameters.sz), "maximum height"),
        ("Sp", length(parameters.sp), "highest peak"),
        ("Sv", length(parameters.sv), "deepest pit"),
        ("Sdq", number(parameters.sdq), "rms slope"),
    ];
    if file.scan.channels.len() > 1 {
        rows.insert(2, ("channels", file.scan.channels.join(", "), ""));
    }
    let width = rows.iter().filter(|row| !row.2.is_empty()).map(|row| row.1.chars().count()).max();
    let width = width.unwrap_or_default();
    rows.iter().fold(String::new(), |mut table, (name, value, remark)| {
        let line = format!("{name:<10} {value:<width$}  {remark}");
        let _ = writeln!(table, "{}", line.trim_end());
        table
    })
}

/// NaN where nothing is defined.
fn extremes(file: &Read) -> [f64; 2] {
    let heights = file.topography.heights();
    [f64::min, f64::max].map(|pick| heights.iter().copied().fold(f64::NAN, pick))
}
