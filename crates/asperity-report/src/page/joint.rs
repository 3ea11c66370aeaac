//! The page of the law of a joint: its first sentence, its figures with their bands, its table, and what was checked.

use std::fmt::Write as _;
use std::path::Path;

use asperity_base::units::{Dimension, format, format_number, format_number_digits};
use asperity_study::io;
use asperity_study::joint::{Band, Edge, Kind, Law};
use serde_json::json;

use super::head::list;
use super::html::{escaped, facts, minus, with_code};
use super::{Section, curves, framed};
use crate::draw::{Colours, palette};
use crate::figures::joint_curves;

/// Relative scatter that is rounding.
const ROUNDING: f64 = 1e-9;

/// Pascals per metre in a GPa per mm.
const GPA_PER_MM: f64 = 1e12;

/// Writes the page of a law to `path`, with these files for other programs; where that fails the one that is there stays.
///
/// # Errors
/// [`asperity_base::Error::File`].
pub fn write_joint(law: &Law, files: &[String], doubts: &[String], path: &Path) -> asperity_base::Result<()> {
    io::replace(path, page(law, files, doubts).as_bytes())
}

/// What the law says in a sentence, in the middle of its pressures.
pub fn joint_in_words(law: &Law) -> String {
    let middle = law.pressures.len() / 2;
    let band = |kind: Kind| law.quantity(kind).and_then(|quantity| quantity.bands[middle]);
    let spread = |band: Band, write: &dyn Fn(f64) -> String| {
        if is_band(law, band) {
            format!("{} ± {}", write(band.median), write(band.half_width()))
        } else {
            write(band.median)
        }
    };
    let with_unit = |band: Band, dimension: Dimension| {
        let unit = dimension.multiple(band.median);
        let number = |value: f64| format_number_digits(value / unit.factor, 3);
        format!("{} {}", spread(band, &number), unit.symbol)
    };
    let at = format(law.pressures[middle], Dimension::Pressure);
    let mut parts = Vec::new();
    if let Some(gap) = band(Kind::MeanGap) {
        let closure = Band { median: law.closures(Edge::Median)[middle], ..gap };
        parts.push(format!("is closed by {}", with_unit(closure, Dimension::Length)));
    }
    if let Some(stiffness) = band(Kind::Stiffness) {
        let number = |value: f64| format_number_digits(value / GPA_PER_MM, 3);
        parts.push(format!("has {} GPa/mm", spread(stiffness, &number)));
    }
    for (kind, dimension) in [
        (Kind::ThermalConductance, Dimension::ThermalConductanceOfArea),
        (Kind::ElectricalConductance, Dimension::ElectricalConductanceOfArea),
    ] {
        parts.extend(band(kind).map(|conductance| format!("conducts {}", with_unit(conductance, dimension))));
    }
    let last = parts.pop().unwrap_or_default();
    let all = if parts.is_empty() { last } else { format!("{} and {last}", parts.join(", ")) };
    let [least, most] = [0, law.pressures.len() - 1].map(|n| format(law.pressures[n], Dimension::Pressure));
    let decay = law.coefficients().exponential.map(|fit| {
        let decay = format(fit.decay, Dimension::Length);
        format!("; from {least} to {most} the pressure falls by e in {decay}")
    });
    let samples = if law.samples == 1 { "1 sample".to_owned() } else { format!("{} samples", law.samples) };
    format!("At {at} the joint {all}; {samples}{}.", decay.unwrap_or_default())
}

/// Whether the samples scatter by more than rounding.
fn is_band(law: &Law, band: Band) -> bool {
    law.samples > 1 && band.half_width() > ROUNDING * band.median.abs()
}

fn page(law: &Law, files: &[String], doubts: &[String]) -> String {
    let mut data = Vec::new();
    let shown = curves::html(joint_curves(law), &mut data);
    let sections: [Section; 4] = [
        ("curves", "Curves", Some(shown)),
        ("table", "Table", Some(table(law))),
        ("theories", "Theories and fits", Some(fits(law))),
        ("about", "About", Some(about(law, files))),
    ];
    let mut head = format!(
        "<h1>{}</h1><p class=\"verdict\">{}</p>",
        escaped(&law.title),
        escaped(&minus(&joint_in_words(law)))
    );
    let warnings: Vec<String> = doubts.iter().map(|doubt| with_code(doubt)).collect();
    head += &list("Warnings", "warning", &warnings);
    let colours = json!({ "pressure": palette(Colours::Pressure) });
    framed(&law.title, &head, &sections, &json!({ "colours": colours, "charts": data }))
}

/// A row for each pressure: median and half of the band.
fn table(law: &Law) -> String {
    let mut html = String::from(
        "<div class=\"scroll\" tabindex=\"0\" role=\"region\" aria-label=\"law of the joint\"><table><thead><tr>\
         <th scope=\"col\">mean pressure</th><th scope=\"col\">closure (m)</th>",
    );
    for quantity in &law.quantities {
        let (name, unit) = (quantity.kind.name().replace('_', " "), quantity.kind.unit());
        let unit = if unit.is_empty() { String::new() } else { format!(" ({unit})") };
        let _ = write!(html, "<th scope=\"col\">{}</th>", escaped(&(name + &unit)));
    }
    html += "</tr></thead><tbody>";
    let number = |value: f64| minus(&format_number_digits(value, 4));
    for (n, (pressure, closure)) in law.pressures.iter().zip(law.closures(Edge::Median)).enumerate() {
        let pressure = format(*pressure, Dimension::Pressure);
        let _ = write!(html, "<tr><td>{pressure}</td><td>{}</td>", number(closure));
        for quantity in &law.quantities {
            let cell = match quantity.bands[n] {
                Some(band) if is_band(law, band) => {
                    format!("{} ± {}", number(band.median), number(band.half_width()))
                }
                Some(band) => number(band.median),
                None => "unknown".to_owned(),
            };
            let _ = write!(html, "<td>{cell}</td>");
        }
        html += "</tr>";
    }
    html + "</tbody></table></div>"
}

/// Theories with their ratios in the middle of the range, and fits with their ranges.
fn fits(law: &Law) -> String {
    let middle = law.pressures.len() / 2;
    let median =
        |kind: Kind| law.quantity(kind).and_then(|quantity| quantity.bands[middle]).map(|band| band.median);
    let row = &law.theories[middle];
    let at = format(law.pressures[middle], Dimension::Pressure);
    let ratio = |theory: Option<f64>, computed: Option<f64>| {
        let ratio = theory
            .zip(computed)
            .map(|(theory, computed)| theory / computed)
            .filter(|ratio| ratio.is_finite());
        ratio.map(|ratio| format!("{} times what is computed at {at}", format_number_digits(ratio, 3)))
    };
    let theories = [
        ("area by Persson", ratio(row.persson_fraction, median(Kind::ContactFraction))),
        ("area by Bush, Gibson and Thomas", ratio(row.bgt_fraction, median(Kind::ContactFraction))),
        ("stiffness by Persson", ratio(row.persson_stiffness_of_area(), median(Kind::Stiffness))),
        (
            "pressure at this gap by Greenwood and Williamson",
            ratio(row.greenwood_williamson_pressure, Some(row.mean_pressure)),
        ),
    ];
    let fits = law.coefficients();
    let length = |value: f64| format(value, Dimension::Length);
    let mut rows: Vec<(String, String)> =
        theories.into_iter().filter_map(|(name, text)| Some((name.to_owned(), escaped(&text?)))).collect();
    if let Some(fit) = fits.exponential {
        rows.push((
            "exponential law of the gap".to_owned(),
            escaped(&format!(
                "p = {} exp(−g/{}), rms of ln p {}",
                format(fit.pressure, Dimension::Pressure),
                length(fit.decay),
                format_number_digits(fit.rms, 2)
            )),
        ));
    }
    if let Some(fit) = fits.greenwood_tripp {
        rows.push((
            "F₅⸝₂ law of the gap".to_owned(),
            escaped(&format!(
                "K = {}, σ_s = {}, datum at the mean planes, g/σ from {} to {}, rms of ln p {}; another datum fits with other constants",
                format_number_digits(fit.factor, 3),
                length(fit.deviation),
                format_number_digits(fit.gap_over_rms_range[0], 3),
                format_number_digits(fit.gap_over_rms_range[1], 3),
                format_number_digits(fit.rms, 2)
            )),
        ));
    }
    for (axis, fit) in ["x", "y"].iter().zip(fits.flow) {
        let Some(fit) = fit else { continue };
        rows.push((
            format!("flow factor along {axis}"),
            escaped(&format!(
                "φ = 1 − {} exp(−{} g/σ), rms {}; at most {} times that of Patir and Cheng",
                format_number_digits(fit.factor, 3),
                format_number_digits(fit.rate, 3),
                format_number_digits(fit.rms, 2),
                format_number_digits(fit.over_theirs, 3)
            )),
        ));
    }
    facts(rows)
}

/// Samples, datum, checks and files.
fn about(law: &Law, files: &[String]) -> String {
    let length = |band: Band| {
        let median = format(band.median, Dimension::Length);
        if is_band(law, band) {
            format!("{median} ± {}", format(band.half_width(), Dimension::Length))
        } else {
            median
        }
    };
    let checks = law.checks;
    let mut rows = vec![
        ("samples".to_owned(), law.samples.to_string()),
        ("datum of the closure".to_owned(), format!("mean gap of {}", format(law.datum, Dimension::Length))),
        ("rms height of both surfaces".to_owned(), length(law.rms_height)),
        ("rms slope".to_owned(), format_number_digits(law.rms_slope.median, 3)),
        ("composite modulus".to_owned(), format(law.modulus, Dimension::Pressure)),
        (
            "stiffness between points".to_owned(),
            format!(
                "{} of {} steps lie between the stiffnesses at their ends",
                checks.bracketed, checks.steps
            ),
        ),
    ];
    if let Some(barber) = checks.barber {
        rows.push((
            "Barber's identity".to_owned(),
            format!("conductances within {} %", format_number(1e2 * (1e4 * barber).ceil() / 1e4)),
        ));
    }
    let links: Vec<String> =
        files.iter().map(|name| format!("<a href=\"{0}\">{0}</a>", escaped(name))).collect();
    rows.push(("files".to_owned(), links.join(", ")));
    facts(rows)
}
