//! `asperity surface info`.

use asperity::Choice;
use asperity::study::exact_pitch;
use asperity::surface::{Axis, LengthUnit, Unit};
use asperity::units;
use asperity_report::describe::{Description, Table, cutoff_of_a_line};
use serde_json::{Value, json};

use super::{ReadSurface, read_prepared, suggest_level, without_pitch};
use crate::args::Info;
use crate::report::{Outcome, print};

pub(super) fn info(arguments: &Info) -> Outcome {
    let file = read_prepared(&arguments.input)?;
    if arguments.cutoff.is_some() && file.pitch.is_none() {
        let message = "a cut-off needs a pitch, which the heights have not";
        return Err(without_pitch(message));
    }
    suggest_level(&file.topography);
    let cutoff = arguments.cutoff.or_else(|| file.pitch.and_then(|_| cutoff_of_a_line(&file.topography)));
    let description = Description::new(&file.topography, file.pitch.is_some(), cutoff)?;
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
    description.add_to(&mut table);
    table.text()
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

/// Returns NaN if nothing is defined.
fn extremes(file: &ReadSurface) -> [f64; 2] {
    let heights = file.topography.heights();
    [f64::min, f64::max].map(|pick| heights.iter().copied().fold(f64::NAN, pick))
}
