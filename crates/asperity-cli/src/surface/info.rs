//! `asperity surface info`.

use std::fmt::Write as _;

use asperity::io::topography;
use asperity::surface::{Parameter, Unit};
use asperity::units::{self, Dimension};
use serde_json::{Value, json};

use super::description::{Description, Law, Profiles, Statistics};
use super::{Read, read_prepared, without_pitch};
use crate::args::Info;
use crate::report::{Outcome, print};

pub(super) fn info(arguments: &Info) -> Outcome {
    let file = read_prepared(&arguments.input)?;
    if arguments.cutoff.is_some() && file.pitch.is_none() {
        let message = "a cut-off needs a pitch, which the heights have not";
        return Err(without_pitch(message));
    }
    let description = Description::of(&file, arguments.cutoff)?;
    if arguments.json {
        print(&format!("{:#}\n", json(&file, &description)))
    } else {
        print(&text(&file, &description))
    }
}

fn json(file: &Read, description: &Description) -> Value {
    let [low, high] = extremes(file);
    let mut json = json!({
        "format": file.scan.format,
        "channel": file.scan.channel,
        "channels": file.scan.channels,
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

/// A table in sections.
struct Table {
    rows: Vec<Row>,
}

enum Row {
    Title(String),
    Value { name: String, value: String, remark: String },
}

impl Table {
    fn title(&mut self, title: impl Into<String>) {
        self.rows.push(Row::Title(title.into()));
    }

    fn row(&mut self, name: impl Into<String>, value: impl Into<String>, remark: impl Into<String>) {
        self.rows.push(Row::Value { name: name.into(), value: value.into(), remark: remark.into() });
    }

    fn parameters(&mut self, parameters: &[Parameter]) {
        for row in parameters {
            self.row(row.symbol, row.unit.format(row.value), row.meaning);
        }
    }

    /// In columns, the sections divided by an empty line.
    fn text(&self) -> String {
        let width = |pick: fn(&Row) -> &str| self.rows.iter().map(|row| pick(row).chars().count()).max();
        let names = width(|row| if let Row::Value { name, .. } = row { name } else { "" }).unwrap_or(0);
        let values = width(|row| match row {
            Row::Value { value, remark, .. } if !remark.is_empty() => value,
            _ => "",
        });
        let values = values.unwrap_or(0);
        self.rows.iter().fold(String::new(), |mut text, row| {
            let line = match row {
                Row::Title(title) => format!("\n{title}"),
                Row::Value { name, value, remark } => format!("{name:<names$}  {value:<values$}  {remark}"),
            };
            let _ = writeln!(text, "{}", line.trim_end());
            text
        })
    }
}

fn text(file: &Read, description: &Description) -> String {
    let mut table = Table { rows: Vec::new() };
    about_file(&mut table, file);
    let parameters = description.parameters.rows();
    for family in parameters.chunk_by(|a, b| a.family == b.family) {
        table.title(format!("{} parameters, ISO 25178-2", family[0].family));
        table.parameters(family);
    }
    if let Some(statistics) = &description.statistics {
        about_statistics(&mut table, statistics);
    }
    if let Some(profiles) = &description.profiles {
        about_profiles(&mut table, profiles);
    }
    table.text()
}

fn about_file(table: &mut Table, file: &Read) {
    let length = |value: f64| Unit::Length.format(value);
    let both = |[x, y]: [f64; 2]| format!("{} × {}", length(x), length(y));
    let grid = file.topography.grid();
    let [low, high] = extremes(file);
    let undefined = file.topography.undefined();
    let share = 100.0 * undefined as f64 / grid.cells() as f64;
    table.row("format", file.scan.format, "");
    table.row("channel", &file.scan.channel, "");
    if file.scan.channels.len() > 1 {
        table.row("channels", file.scan.channels.join(", "), "");
    }
    table.row("shape", format!("{} × {}", grid.shape[0], grid.shape[1]), "samples along x and y");
    let none = || "– (the file has none: --pitch)".to_owned();
    table.row("pitch", file.pitch.map_or_else(none, both), "");
    table.row("extent", file.pitch.map_or_else(|| "–".to_owned(), |_| both(grid.extent())), "");
    if file.scan.unit != topography::Unit::Known {
        table.row("unit", "m (the file has none: --unit)", "");
    }
    table.row("undefined", format!("{undefined} ({share:.2} %)"), "");
    table.row("min", length(low), "");
    table.row("max", length(high), "");
    table.row("mean", length(file.topography.mean()), "");
}

fn about_statistics(table: &mut Table, statistics: &Statistics) {
    let Statistics { moments, bandwidth, asperities, self_affine } = statistics;
    table.title("spectral moments, along x and y");
    table.row("m0", units::format(moments.m0, Dimension::Area), "mean square height");
    let both = |[x, y]: [f64; 2], unit: &str| format!("{x:.4e}, {y:.4e}{unit}");
    table.row("m2", both(moments.m2, ""), "mean square slope");
    table.row("m4", both(moments.m4, " 1/m²"), "mean square second derivative");
    table.row("α", format!("{bandwidth:.4}"), "Nayak's bandwidth, m0 m4/m2²");
    table.title("asperities of Greenwood and Williamson: counted as summits | from the moments");
    let mut row = |name, unit: Unit, value: fn(&asperity::surface::GreenwoodWilliamson) -> f64, remark| {
        let [counted, by_moments] =
            [&asperities.counted, &asperities.by_moments].map(|found| unit.format(value(found)));
        table.row(name, format!("{counted} | {by_moments}"), remark);
    };
    row("η", Unit::PerArea, |found| found.density, "density");
    row("R", Unit::Length, |found| found.radius, "radius of the tips");
    row("σs", Unit::Length, |found| found.height_deviation, "standard deviation of their heights");
    row("zs", Unit::Length, |found| found.mean_height, "mean height above that of the surface");
    if let Some(Law { fit: law, doubt, .. }) = self_affine {
        table.title("self-affine law, on the longest range of the spectrum that follows one");
        table.row("H", format!("{:.3} ± {:.3}", law.hurst, law.hurst_error), "Hurst exponent");
        let wavelength = |q: f64| Unit::Length.format(std::f64::consts::TAU / q);
        let range = format!("{} … {}", wavelength(law.range[1]), wavelength(law.range[0]));
        table.row("range", range, "wavelengths");
        if let Some(doubt) = doubt {
            table.row("H", doubt, "");
        }
    }
}

fn about_profiles(table: &mut Table, profiles: &Profiles) {
    let cutoff = Unit::Length.format(profiles.cutoff);
    table.title(format!("profile parameters, ISO 21920-2, cut-off {cutoff}: along x | along y"));
    for (x, y) in profiles.x.rows().iter().zip(profiles.y.rows()) {
        let value = format!("{} | {}", x.unit.format(x.value), y.unit.format(y.value));
        table.row(x.symbol, value, x.meaning);
    }
}

/// NaN where nothing is defined.
fn extremes(file: &Read) -> [f64; 2] {
    let heights = file.topography.heights();
    [f64::min, f64::max].map(|pick| heights.iter().copied().fold(f64::NAN, pick))
}
