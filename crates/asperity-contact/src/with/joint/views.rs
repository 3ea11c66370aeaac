//! The law of a joint in words and curves.

use super::JointRecord;
use crate::units::{Dimension, format, format_number_digits};
use crate::with::views::{Answer, Curve, Line, OverPressure, Series, percent};

/// Tangential stiffness, and the area of contact with its theories.
pub(super) const CURVES: &[Curve<JointRecord>] = &[
    Curve {
        names: ["tangential_stiffness", "tangential_stiffness_positions"],
        title: "tangential stiffness",
        caption: "Force over the displacement along the surfaces, of spots that stick. Between bodies of one material it is 2 (1 − ν)/(2 − ν) of the normal stiffness.",
        column: |_| "stiffness_x",
        series: &[
            Series {
                name: "along x",
                has: |_| true,
                value: |row| row.stiffness_x,
                is_dashed: false,
                is_beside: false,
                over_pressure: OverPressure::Exponent,
            },
            Series {
                name: "along y",
                has: |_| true,
                value: |row| row.stiffness_y,
                is_dashed: true,
                is_beside: false,
                over_pressure: OverPressure::Nothing,
            },
            Series {
                name: "normal, by Persson",
                has: |row| row.persson_stiffness.is_some(),
                value: |row| row.persson_stiffness,
                is_dashed: true,
                is_beside: true,
                over_pressure: OverPressure::Nothing,
            },
        ],
    },
    Curve {
        names: ["contact_theories", "contact_theories_positions"],
        title: "contact fraction",
        caption: "Real over apparent area, corrected for the edges of spots, beside theories of random surfaces with the same slopes.",
        column: |_| "corrected_fraction",
        series: &[
            Series {
                name: "computed",
                has: |_| true,
                value: |row| Some(row.corrected_fraction),
                is_dashed: false,
                is_beside: false,
                over_pressure: OverPressure::Exponent,
            },
            Series {
                name: "Persson",
                has: |row| row.persson_fraction.is_some(),
                value: |row| row.persson_fraction,
                is_dashed: true,
                is_beside: true,
                over_pressure: OverPressure::Nothing,
            },
            Series {
                name: "Bush, Gibson, Thomas",
                has: |row| row.bgt_fraction.is_some_and(|fraction| fraction < 1.0),
                value: |row| row.bgt_fraction,
                is_dashed: true,
                is_beside: true,
                over_pressure: OverPressure::Nothing,
            },
        ],
    },
];

pub(super) fn answers(rows: &[JointRecord]) -> Vec<Answer> {
    let Some(most) = rows.iter().max_by(|a, b| a.mean_pressure.total_cmp(&b.mean_pressure)) else {
        return Vec::new();
    };
    let Some(stiffness) = most.stiffness_x else { return Vec::new() };
    let at = format(most.mean_pressure, Dimension::Pressure);
    let value = format(stiffness, Dimension::Stiffness);
    let area = match most.persson_fraction {
        Some(persson) => {
            format!(
                "{} of the area touch ({} by Persson's theory)",
                percent(most.corrected_fraction),
                percent(persson)
            )
        }
        None => format!("{} of the area touch", percent(most.corrected_fraction)),
    };
    vec![Answer {
        name: "tangential stiffness".into(),
        about: format!("At {at}; {area}."),
        sentence: format!("At {at} {area}, and the tangential stiffness is {value}."),
        value,
    }]
}

pub(super) fn numbers(row: &JointRecord) -> Vec<Line> {
    let mut lines = Vec::new();
    if let (Some(x), Some(y)) = (row.stiffness_x, row.stiffness_y) {
        let [x, y] = [x, y].map(|stiffness| format(stiffness, Dimension::Stiffness));
        lines.push(Line::new("tangential stiffness", format!("{x} along x, {y} along y")));
    }
    lines.push(Line::new(
        "corrected area",
        format!("{} of the apparent area", percent(row.corrected_fraction)),
    ));
    let mut beside = |name: &'static str, theory: Option<f64>, computed: f64, text: String| {
        if let Some(theory) = theory.filter(|_| computed > 0.0) {
            let ratio = format_number_digits(theory / computed, 3);
            lines.push(Line::detail(name, format!("{text}, {ratio} times what is computed")));
        }
    };
    let fraction = |theory: Option<f64>| format!("{} touch", percent(theory.unwrap_or_default()));
    beside("Persson", row.persson_fraction, row.corrected_fraction, fraction(row.persson_fraction));
    beside("Bush, Gibson, Thomas", row.bgt_fraction, row.corrected_fraction, fraction(row.bgt_fraction));
    let pressure = row.greenwood_williamson_pressure;
    let text = format!("{} at the same gap", format(pressure.unwrap_or_default(), Dimension::Pressure));
    beside("Greenwood, Williamson", pressure, row.mean_pressure, text);
    let [height, touch] =
        [row.rms_height, row.first_touch_gap].map(|length| format(length, Dimension::Length));
    let nayak = row.nayak.map_or(String::new(), |nayak| {
        format!(
            ", slope {}, Nayak's parameter {}",
            format_number_digits(row.rms_slope, 3),
            format_number_digits(nayak, 3)
        )
    });
    lines.push(Line::detail(
        "sum of the surfaces",
        format!("rms height {height}{nayak}; first touch at {touch}"),
    ));
    lines
}
