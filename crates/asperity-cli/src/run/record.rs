//! Summary of a contact at the end of a run: a line for each number.

use asperity::each;
use asperity::motion::{PassRecord, PlasticRecord, StaticRecord, UpdateRecord};
use asperity::study::{Case, ClosedFormRecord, Outcome, SubsurfaceRecord, Summary, dimension_of_column};
use asperity::units::{CELSIUS, Dimension, format, format_number};
use asperity::with;
use asperity::with::views::{Answer, Line};
use asperity::with::{
    BodyLaw, BodyLaws, Capability, Listed, Observations, Reported, answering, interface_lines,
};

use super::rows::planes;
use crate::maps::line;
use asperity_report::page::layers_in_words;
use asperity_report::words::closed_form;

/// Describes a static contact and the largest stress below the surface, with a line for each number. The run
/// itself prints the rows of passes and points.
///
/// The rows of the capabilities are those of all contacts that were `found`, or those of the summary. The
/// `updates` are those of a contact that slides in place; none of others.
pub fn text(case: &Case, summary: &Summary, found: &Observations, updates: &[UpdateRecord]) -> String {
    let contact = match &summary.outcome {
        Outcome::Static(record) => static_table(case, &summary.interface.as_shown(record)),
        Outcome::Passes(passes) => changes(passes),
        Outcome::Sweep(points) => with::after_points(points).iter().map(told).collect(),
    };
    let theory = summary.closed_form.as_ref().map_or(String::new(), theory_lines);
    let plastic = summary.plasticity.as_ref().map_or(String::new(), plastic_line);
    let of_interface: String =
        summary.interface.lines().iter().map(|Line { name, value, .. }| line(name, value)).collect();
    answers(case, found, matches!(summary.outcome, Outcome::Sweep(_)))
        + &of_interface
        + &slid(updates)
        + &contact
        + &theory
        + &plastic
        + &summary.subsurface.iter().map(stress_line).collect::<String>()
}

/// Describes what the case asks for beside the contact: the answers from several contacts, or the numbers of
/// a single one.
fn answers(case: &Case, found: &Observations, is_sweep: bool) -> String {
    let mut text = String::new();
    each!(capability C => if let Some(asked) = C::of(&case.with) {
        let rows = answering::<C>(C::rows(found), is_sweep);
        let is_alone = C::summary(&rows).len() == rows.len();
        if is_alone {
            for numbers in rows.iter().flat_map(|row| asked.numbers(row)).filter(|numbers| !numbers.is_detail) {
                text += &line(&numbers.name, &numbers.value);
            }
        } else {
            asked.answers(&rows).iter().for_each(|answer| text += &told(answer));
        }
    });
    text
}

/// Writes an answer as a line.
fn told(answer: &Answer) -> String {
    line(&answer.name, &format!("{}; {}", answer.value, begun_small(answer.about.trim_end_matches('.'))))
}

/// Returns a sentence that goes on from words before it.
fn begun_small(sentence: &str) -> String {
    let mut letters = sentence.chars();
    let first = letters.next().map(|first| first.to_lowercase().to_string()).unwrap_or_default();
    first + letters.as_str()
}

/// Describes what passes have done to the bodies.
fn changes(passes: &[PassRecord]) -> String {
    let temperatures = passes.iter().filter_map(|pass| Some(pass.running?.max_flash_temperature));
    with::after_passes(passes).iter().map(told).collect::<String>() + &warmest(temperatures)
}

/// Describes what sliding in place has done to the bodies.
fn slid(updates: &[UpdateRecord]) -> String {
    let Some(last) = updates.last() else { return String::new() };
    let time = last.time.is_finite().then(|| format!(" in {}", format(last.time, Dimension::Time)));
    line("slid", &format!("{}{}", format(last.distance, Dimension::Length), time.unwrap_or_default()))
        + &with::after_sliding(updates).iter().map(told).collect::<String>()
        + &warmest(updates.iter().map(|update| update.max_temperature))
}

/// Describes the largest of some temperatures that are known; nothing of none.
fn warmest(temperatures: impl Iterator<Item = f64>) -> String {
    let largest = temperatures.filter(|temperature| temperature.is_finite()).reduce(f64::max);
    largest.map_or_else(String::new, |largest| {
        line("temperature", &format!("up to {} °C", format_number(largest - CELSIUS)))
    })
}

/// Describes the closed form of the contact, and the deviation of the computed contact from it.
fn theory_lines(record: &ClosedFormRecord) -> String {
    let rows = [
        (record.theory.to_string(), closed_form::computed(record)),
        ("deviation".to_owned(), closed_form::deviations(record)),
    ];
    rows.iter().map(|(name, value)| line(name, value)).collect()
}

/// Describes the response of elasto-plastic bodies to repeated passes.
fn plastic_line(plastic: &PlasticRecord) -> String {
    let rate = match (plastic.strain_per_pass, plastic.shift_per_pass) {
        (Some(strain), Some(shift)) => {
            let (strain, shift) = (format_number(100.0 * strain), format(shift, Dimension::Length));
            format!(": strain grows by {strain} %, the surface moves by {shift} a pass")
        }
        _ => String::new(),
    };
    format!(
        "{}{rate}; largest plastic strain {}, plastic work {}, residual tension up to {}\n",
        plastic.regime,
        format_number(plastic.max_plastic_strain),
        format(plastic.plastic_work, Dimension::Energy),
        format(plastic.max_residual_tension, Dimension::Pressure)
    )
}

fn stress_line(record: &SubsurfaceRecord) -> String {
    let pass = record.pass.map_or(String::new(), |pass| format!("pass {pass}: "));
    let [x, y, z] = record.position.map(|length| format(length, Dimension::Length));
    let layers = layers_in_words(record).map_or(String::new(), |layers| layers + "\n");
    format!(
        "{pass}largest von Mises stress {} at x = {x}, y = {y}, depth {z}\n{layers}",
        format(record.max_von_mises, Dimension::Pressure)
    )
}

/// Returns the load over the contact area.
fn mean_pressure(record: &StaticRecord) -> String {
    match record.contact_area {
        0.0 => "–".to_owned(),
        area => format!("{} over the contact", format(record.load / area, Dimension::Pressure)),
    }
}

fn static_table(case: &Case, record: &StaticRecord) -> String {
    let share = 100.0 * record.contact_area / record.apparent_area;
    let mut rows = vec![
        ("load", format(record.load, Dimension::Force)),
        ("nominal pressure", format(record.load / record.apparent_area, Dimension::Pressure)),
        match record.approach {
            approach if approach < 0.0 => {
                (planes(case), format!("{} apart", format(-approach, Dimension::Length)))
            }
            approach => ("approach", format(approach, Dimension::Length)),
        },
        (
            "contact area",
            format!(
                "{} ({} % of the grid)",
                format(record.contact_area, Dimension::Area),
                format_number(share)
            ),
        ),
        ("mean pressure", mean_pressure(record)),
        ("largest pressure", format(record.max_pressure, Dimension::Pressure)),
        ("mean gap", format(record.mean_gap, Dimension::Length)),
        ("elastic energy", format(record.elastic_energy, Dimension::Energy)),
    ];
    let of_interface = record.interface.iter().flat_map(interface_lines).collect::<Vec<_>>();
    rows.extend(of_interface.iter().map(|line| (&*line.name, line.value.clone())));
    if record.plastic_cells > 0 {
        rows.push(("plastic cells", record.plastic_cells.to_string()));
        rows.push(("plastic volume", format(record.plastic_volume, Dimension::Volume)));
    }
    rows.push(("residual", format!("{:.1e}", record.residual)));
    if let Some(shear) = &record.shear {
        let both = |[x, y]: [f64; 2], scale: f64, dimension| {
            // The rounding error of a zero component is not printed.
            let shown = |value: f64| if value.abs() < 1e-8 * scale.max(x.hypot(y)) { 0.0 } else { value };
            format!("{}, {}", format(shown(x), dimension), format(shown(y), dimension))
        };
        let stick = 100.0 * shear.stick_area / record.contact_area;
        rows.extend([
            ("tangential force", both(shear.tangential_force, record.load, Dimension::Force)),
            ("displacement", both(shear.tangential_displacement, 0.0, Dimension::Length)),
        ]);
        if record.load > 0.0 {
            rows.push(("traction coeff.", format_number(shear.force_ratio)));
        }
        rows.extend([
            ("stick area", format!("{} ({stick:.3} %)", format(shear.stick_area, Dimension::Area))),
            ("largest shear", format(shear.max_shear, Dimension::Pressure)),
            ("dissipation", format(shear.dissipation, Dimension::Energy)),
        ]);
        if let Some(coefficient) = shear.friction_coefficient {
            rows.push(("friction coeff.", format_number(coefficient)));
        }
        if let Some([x, y]) = shear.creepage {
            rows.push(("creepage", format!("{}, {}", format_number(x), format_number(y))));
        }
        if let (Some(spin), Some(moment)) = (shear.spin.filter(|spin| *spin != 0.0), shear.moment) {
            rows.push(("spin", format!("{} 1/m", format_number(spin))));
            rows.push(("moment", format!("{} N m", format_number(moment))));
        }
    }
    if let Some(fretting) = &record.fretting {
        let both = |[lower, upper]: [f64; 2], dimension| {
            format!(
                "{} of the lower body, {} of the upper one",
                format(lower, dimension),
                format(upper, dimension)
            )
        };
        rows.push(("cycles", fretting.cycles.to_string()));
        let has = |law: fn(&BodyLaws) -> bool| law(&case.lower.laws) || law(&case.upper.laws);
        each!(law L => if has(|laws| L::of(laws).is_some()) {
            rows.extend(L::OF_CYCLES.iter().filter_map(|shown| {
                let dimension = dimension_of_column(shown.column)?;
                Some((shown.name, both((shown.values)(fretting), dimension)))
            }));
        });
    }
    if let Some(heat) = &record.heat {
        let celsius = format_number(heat.max_flash_temperature - CELSIUS);
        let power = format(heat.friction_power, Dimension::Power);
        rows.push(("temperature", format!("up to {celsius} °C, by a mean of {power} of friction")));
    }
    if let Some(plastic) = &record.plastic {
        let residual = plastic.residual.as_ref();
        let tension =
            residual.map_or(plastic.max_residual_tension, |left| left.residual_max_residual_tension);
        let dent = residual.map_or(plastic.residual_displacement, |left| left.residual_residual_displacement);
        rows.extend([
            ("plastic strain", format_number(plastic.max_plastic_strain)),
            ("yielded volume", format(plastic.yielded_volume, Dimension::Volume)),
            ("plastic work", format(plastic.plastic_work, Dimension::Energy)),
            ("residual tension", format(tension, Dimension::Pressure)),
            ("dent left", format(dent, Dimension::Length)),
        ]);
    }
    rows.iter().map(|(name, value)| line(name, value)).collect()
}
