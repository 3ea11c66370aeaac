//! The closed form of a contact of smooth forms, in words.

use asperity_base::units::{Dimension, Metre, Pascal, format};
use asperity_study::{ClosedForm, ClosedFormRecord};

/// Describes the expected closed form of a contact.
pub fn expected(form: &ClosedForm) -> String {
    format!("{}, {}", form.theory, values(form.half_widths, form.max_pressure, form.approach))
}

/// Describes the closed form beside a computed contact.
pub fn computed(record: &ClosedFormRecord) -> String {
    values(record.theory_half_widths, record.theory_max_pressure, record.theory_approach)
}

/// Describes the deviation of the computed contact from its closed form.
pub fn deviations(record: &ClosedFormRecord) -> String {
    let of = [
        ("area", Some(record.contact_area_deviation)),
        ("largest pressure", record.max_pressure_deviation),
        ("approach", record.approach_deviation),
    ];
    let shown = of.into_iter().filter_map(|(name, deviation)| Some((name, 100.0 * deviation?)));
    // A zero after rounding has no sign.
    let rounded = |percent: f64| (100.0 * percent).round() / 100.0 + 0.0;
    shown.map(|(name, percent)| format!("{name} {:+.2} %", rounded(percent))).collect::<Vec<_>>().join(", ")
}

fn values([a, b]: [Metre; 2], max_pressure: Option<Pascal>, approach: Option<Metre>) -> String {
    let length = |value| format(value, Dimension::Length);
    let widths = if (a - b).abs() <= 1e-9 * a {
        format!("contact radius {}", length(a))
    } else {
        format!("half widths {} along x and {} along y", length(a), length(b))
    };
    let pressure =
        max_pressure.map(|pressure| format!("largest pressure {}", format(pressure, Dimension::Pressure)));
    let approach = approach.map(|approach| format!("approach {}", length(approach)));
    [Some(widths), pressure, approach].into_iter().flatten().collect::<Vec<_>>().join(", ")
}
