//! The result in a sentence or two.

use asperity_base::units::{CELSIUS, Dimension, Kelvin, format, format_number};
use asperity_contact::motion::{PassRecord, PlasticRecord, Regime, StaticRecord, SweepRecord};
use asperity_contact::with::views::Answer;
use asperity_study::{Outcome, SubsurfaceRecord};

use super::page_data::PageData;
use crate::words::closed_form;
use crate::words::numbers::change;

/// The outcome of a run, or what there is of it so far.
pub(super) fn sentence(found: &PageData, answers: &[Answer]) -> String {
    let answers =
        answers.iter().map(|answer| answer.sentence.clone()).filter(|sentence| !sentence.is_empty());
    let layers = last_stress(found).and_then(layers_in_words);
    answers.chain(layers).chain([of_contact(found)]).collect::<Vec<_>>().join(" ")
}

fn last_stress<'a>(found: &'a PageData<'_>) -> Option<&'a SubsurfaceRecord> {
    found.summary.as_ref()?.subsurface.last()
}

/// The contact in a sentence.
fn of_contact(found: &PageData) -> String {
    if let Some(last) = found.passes.last() {
        return of_passes(found, last);
    }
    if !found.points.is_empty() {
        return of_points(&found.points);
    }
    match found.summary.as_ref().map(|summary| &summary.outcome) {
        Some(Outcome::Static(record)) => of_rest(found, record),
        _ => match found.increments.last() {
            Some(last) => format!("{} increments so far, load {}.", last.increment, force(last.load)),
            None if !found.updates.is_empty() => format!("{} updates so far.", found.updates.len() - 1),
            None => "Nothing has been finished yet.".to_owned(),
        },
    }
}

fn of_passes(found: &PageData, last: &PassRecord) -> String {
    let passes = match found.done[found.passes.len()] {
        1 => "one pass".to_owned(),
        done => format!("{done} passes"),
    };
    let under = format!("After {passes} under a mean load of {}", force(last.mean_load));
    let plastic = found.summary.as_ref().and_then(|summary| summary.plasticity.as_ref());
    if let Some(plastic) = plastic {
        return format!("{under}, {}.", of_regime(plastic, shaken_down(&found.passes)));
    }
    let area = format(last.mean_contact_area, Dimension::Area);
    // Through a film of oil, area and pressure are those of the solids.
    let [touch, most] = match last.film {
        Some(_) => ["the solids touch on", " under up to"],
        None => ["the real area of contact is", " and the largest pressure"],
    };
    let mut text = format!("{under}, {touch} {area}");
    if let Some(share) = share_of_overlap(last) {
        text += &format!(" ({share} % of the overlap)");
    }
    text += &format!("{most} {}", format(last.max_pressure, Dimension::Pressure));
    text += ". ";
    if let Some(temperature) = largest_temperature(found, last) {
        text += &format!("The surfaces reach {} °C. ", format_number(temperature - CELSIUS));
    }
    if let Some(stress) = last_stress(found) {
        text += &format!("{} ", of_stress(stress));
    }
    text + &of_roughness(found, last)
}

/// The largest stress below the surface, and its place.
fn of_stress(stress: &SubsurfaceRecord) -> String {
    let [x, y, depth] = stress.position.map(|length| format(length, Dimension::Length));
    let most = format(stress.max_von_mises, Dimension::Pressure);
    let place = if stress.position[2] > 0.0 {
        format!("{depth} below the surface")
    } else {
        "at the surface".to_owned()
    };
    format!("The largest von Mises stress is {most}, {place} at x = {x}, y = {y}.")
}

/// What cracks layers and takes them off, in a sentence; `None` of bodies without layers.
pub fn layers_in_words(stress: &SubsurfaceRecord) -> Option<String> {
    let write = |stress: f64| format(stress, Dimension::Pressure);
    let [x, y, _] = stress.max_surface_tension_position?.map(|length| format(length, Dimension::Length));
    let tension = write(stress.max_surface_tension?);
    let surface = format!("The surface is stretched by up to {tension} at x = {x}, y = {y}");
    let interfaces = stress.max_interface_shear.zip(stress.max_interface_tension);
    Some(match interfaces {
        Some((shear, tension)) => {
            format!(
                "{surface}; the interfaces are sheared by up to {} and pulled by up to {}.",
                write(shear),
                write(tension)
            )
        }
        None => surface + ".",
    })
}

/// How the rms heights of the bodies have changed.
fn of_roughness(found: &PageData, last: &PassRecord) -> String {
    let Ok(before) = found.results.surfaces_after(0) else { return String::new() };
    let before = before.map(|body| body.sq());
    let changes = [("lower", before[0], last.sq_lower), ("upper", before[1], last.sq_upper)];
    let changes = changes.into_iter().filter(|(_, before, after)| differ(*before, *after));
    let changes: Vec<String> = changes
        .map(|(body, before, after)| {
            format!("Sq of the {body} body has changed: {}.", change([before, after], Dimension::Length))
        })
        .collect();
    if changes.is_empty() { "The roughness has not changed.".to_owned() } else { changes.join(" ") }
}

/// Whether two lengths differ by more than their rounding.
pub(super) fn differ(one: f64, other: f64) -> bool {
    (one - other).abs() > 1e-6 * one.abs().max(other.abs())
}

/// The largest temperature of the surfaces in a pass, if it is known.
pub(super) fn largest_temperature(found: &PageData, pass: &PassRecord) -> Option<Kelvin> {
    let steps = found.steps.iter().filter(|step| step.pass == pass.pass);
    let of_steps = steps.filter_map(|step| Some(step.heat?.max_flash_temperature));
    let of_pass = pass.running.map(|running| running.max_flash_temperature);
    of_steps.chain(of_pass).filter(|temperature| temperature.is_finite()).reduce(f64::max)
}

/// The mean area of contact over that of the overlap, in per cent; none without load.
pub(super) fn share_of_overlap(pass: &PassRecord) -> Option<String> {
    let overlap = pass.mean_load / pass.mean_pressure;
    (overlap > 0.0).then(|| format_number(100.0 * pass.mean_contact_area / overlap))
}

/// The passes after which the plastic work of a pass stays below a thousandth of the first one's.
pub(super) fn shaken_down(passes: &[PassRecord]) -> Option<usize> {
    let work = |pass: &PassRecord| {
        pass.plastic.map_or(0.0, |plastic| plastic.plastic_work_lower + plastic.plastic_work_upper)
    };
    let first = work(passes.first()?);
    passes.iter().rposition(|pass| work(pass) >= 1e-3 * first).map(|last| last + 1).filter(|_| first > 0.0)
}

fn of_regime(plastic: &PlasticRecord, shaken_down: Option<usize>) -> String {
    let strain =
        format!("the plastic strain is up to {} %", format_number(100.0 * plastic.max_plastic_strain));
    let tension =
        format!("the residual tension up to {}", format(plastic.max_residual_tension, Dimension::Pressure));
    match plastic.regime {
        Regime::Elastic => "the bodies have stayed elastic below their surfaces".to_owned(),
        Regime::ShakesDown => {
            let after = match shaken_down {
                Some(1) => "after one pass".to_owned(),
                Some(passes) => format!("after {passes} passes"),
                None => "at once".to_owned(),
            };
            format!("the bodies have shaken down ({after}): {strain}, {tension}")
        }
        Regime::Cyclic => format!("the same plastic flow comes and goes in each pass: {strain}, {tension}"),
        Regime::Ratchets => {
            let rate = plastic
                .strain_per_pass
                .map_or(String::new(), |rate| format!(", by {} % a pass", format_number(100.0 * rate)));
            format!("the plastic strain keeps growing{rate}: {strain}, {tension}")
        }
        _ => format!("{strain}, {tension}; more passes would show what becomes of the bodies"),
    }
}

fn of_points(points: &[SweepRecord]) -> String {
    let (first, last) = (&points[0], &points[points.len() - 1]);
    let traction = |point: &SweepRecord| point.traction().map_or(0.0, |[x, y]| x.hypot(y));
    if let Some(most) =
        points.iter().max_by(|a, b| traction(a).total_cmp(&traction(b))).filter(|p| traction(p) > 0.0)
    {
        return format!(
            "Over {} creepages under {}, the traction coefficient reaches {} at a creepage of {}.",
            points.len(),
            force(last.load),
            format_number(traction(most)),
            format_number(most.creepage_x.hypot(most.creepage_y))
        );
    }
    if last.speed.is_some() {
        let pressures = || points.iter().map(|point| point.max_pressure);
        let [least, most] = [pressures().fold(f64::INFINITY, f64::min), pressures().fold(0.0, f64::max)];
        let [least, most] = [least, most].map(|pressure| format(pressure, Dimension::Pressure));
        let range = if least == most { format!("is {most}") } else { format!("goes from {least} to {most}") };
        return format!("Under {} the largest pressure {range}.", force(last.load));
    }
    if let [only] = points {
        let area = format(only.contact_area, Dimension::Area);
        return format!("Under {} the real area of contact is {area}.", force(only.load));
    }
    format!(
        "Over {} points from {} to {}, the real area of contact goes from {} to {} ({} % of the grid).",
        points.len(),
        force(first.load),
        force(last.load),
        format(first.contact_area, Dimension::Area),
        format(last.contact_area, Dimension::Area),
        format_number(100.0 * last.contact_fraction)
    )
}

fn of_rest(found: &PageData, record: &StaticRecord) -> String {
    if record.contact_area == 0.0 {
        let gap = format(record.mean_gap, Dimension::Length);
        let most = found.increments.iter().map(|increment| increment.contact_area).fold(0.0, f64::max);
        return if most > 0.0 {
            format!(
                "On the way they touched on up to {} under up to {}; in the end they are {gap} apart.",
                format(most, Dimension::Area),
                force(found.increments.iter().map(|increment| increment.load).fold(0.0, f64::max))
            )
        } else {
            format!("The bodies do not touch: their mean gap is {gap}.")
        };
    }
    let share = format_number(100.0 * record.contact_area / record.apparent_area);
    let mut text = format!(
        "Under {} the bodies touch on {} ({share} % of the grid), the largest pressure is {}, and they approach by {}.",
        force(record.load),
        format(record.contact_area, Dimension::Area),
        format(record.max_pressure, Dimension::Pressure),
        format(record.approach, Dimension::Length)
    );
    if let Some(theory) = found.summary.as_ref().and_then(|summary| summary.closed_form.as_ref()) {
        let (values, deviations) = (closed_form::computed(theory), closed_form::deviations(theory));
        text += &format!(
            " The theory of {} gives: {values}. The computed contact deviates: {deviations}.",
            theory.theory
        );
    }
    if let Some(shear) = &record.shear {
        let stick = format_number(100.0 * shear.stick_area / record.contact_area);
        let [x, y] = shear.tangential_force;
        let size = if record.load > 0.0 {
            format!("{} of the load", format_number(shear.force_ratio))
        } else {
            force(x.hypot(y))
        };
        text += &format!(" The tangential force is {size}; {stick} % of the contact sticks.");
    }
    if let Some(plastic) = &record.plastic {
        text += &match plastic.max_plastic_strain {
            0.0 => " The material below the surfaces stays elastic.".to_owned(),
            strain => format!(
                " The plastic strain below the surfaces is up to {} %.",
                format_number(100.0 * strain)
            ),
        };
    }
    if let Some(stress) = found.summary.as_ref().and_then(|summary| summary.subsurface.first()) {
        text += &format!(" {}", of_stress(stress));
    }
    text
}

fn force(load: f64) -> String {
    format(load, Dimension::Force)
}
