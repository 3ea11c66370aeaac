//! The numbers that a reader looks for first, each with what it is.

use std::fmt::Write;

use asperity_base::units::{CELSIUS, Dimension, format, format_number};
use asperity_contact::motion::{IncrementRecord, PassRecord, StaticRecord, SweepRecord};
use asperity_contact::with::interface_cells;
use asperity_contact::with::views::{Answer, RowCell};
use asperity_study::{Outcome, SubsurfaceRecord, column, dimension_of_column};

use super::html::{escaped, minus};
use super::page_data::PageData;
use super::verdict::{differ, largest_temperature, shaken_down, share_of_overlap};
use crate::words::numbers::change;

/// Cards on a page, at most.
const MAX: usize = 6;

/// A number under its name.
struct Card {
    name: String,
    value: String,
    /// What it is, or what stands beside it.
    about: String,
}

impl Card {
    fn new(name: &str, value: String, about: impl Into<String>) -> Self {
        Self { name: name.to_owned(), value, about: about.into() }
    }

    /// A number of a column of the results with the column's meaning.
    fn of(name: &str, column_name: &str, value: String) -> Self {
        Self::new(name, value, column(column_name).map_or("", |column| column.text))
    }
}

/// The cards of a run; nothing where nothing is finished.
pub(super) fn html(found: &PageData, answers: Vec<Answer>) -> String {
    let answers = answers.into_iter();
    let mut cards: Vec<Card> =
        answers.map(|answer| Card::new(&answer.name, answer.value, answer.about)).collect();
    cards.extend(match (&found.passes[..], &found.points[..]) {
        ([first, .., last], _) => of_passes(found, first, last),
        ([only], _) => of_passes(found, only, only),
        ([], [_, ..]) => of_points(&found.points),
        ([], []) => match found.summary.as_ref().map(|summary| (&summary.outcome, &summary.interface)) {
            Some((Outcome::Static(record), interface)) => of_rest(found, &interface.as_shown(record)),
            _ => Vec::new(),
        },
    });
    if cards.is_empty() {
        return String::new();
    }
    let mut html = String::from("<dl class=\"cards\">");
    for Card { name, value, about } in cards.into_iter().take(MAX) {
        let _ = write!(
            html,
            "<div><dt>{}</dt><dd>{}</dd><dd class=\"about\">{}</dd></div>",
            escaped(&name),
            escaped(&minus(&value)),
            escaped(&minus(&about))
        );
    }
    html + "</dl>"
}

fn of_passes(found: &PageData, first: &PassRecord, last: &PassRecord) -> Vec<Card> {
    let length = |value| format(value, Dimension::Length);
    let of_overlap =
        share_of_overlap(last).map_or(String::new(), |share| format!(", {share} % of the overlap"));
    let inside = if differ(last.mean_contact_area, last.mean_contact_area_interior) {
        format!(
            " {} of it in the interior, without the rim.",
            format(last.mean_contact_area_interior, Dimension::Area)
        )
    } else {
        String::new()
    };
    let mut cards = vec![
        Card::new(
            "real area of contact",
            format(last.mean_contact_area, Dimension::Area),
            format!("Mean over the last pass{of_overlap}.{inside}"),
        ),
        Card::new(
            "largest pressure",
            format(last.max_pressure, Dimension::Pressure),
            "At any position of the last pass.",
        ),
    ];
    if let Some(plastic) = found.summary.as_ref().and_then(|summary| summary.plasticity.as_ref()) {
        let after = shaken_down(&found.passes).map_or(String::new(), |passes| {
            format!(
                "The plastic work of a pass is below a thousandth of the first one's after pass {passes}."
            )
        });
        let dent = length(plastic.residual_displacement);
        cards.extend([
            Card::new("plastic flow", plastic.regime.to_string(), after),
            Card::of(
                "plastic strain",
                "max_plastic_strain",
                format!("{} %", format_number(100.0 * plastic.max_plastic_strain)),
            ),
            Card::of(
                "residual tension",
                "max_residual_tension",
                format(plastic.max_residual_tension, Dimension::Pressure),
            ),
            Card::new("depth of the dent or groove", dent, "Range of the height changes by plastic flow."),
        ]);
        return cards;
    }
    let before = found.results.surfaces_after(0).map(|bodies| bodies.map(|body| body.sq())).ok();
    let after =
        [("lower", last.sq_lower, last.sq_lower_interior), ("upper", last.sq_upper, last.sq_upper_interior)];
    for ((body, after, inside), before) in after.into_iter().zip(before.into_iter().flatten()) {
        if differ(before, after) {
            let about = if differ(after, inside) {
                format!(
                    "Before the first and after the last pass, the whole body; {} without the rim.",
                    length(inside)
                )
            } else {
                "Before the first and after the last pass.".to_owned()
            };
            cards.push(Card::new(
                &format!("Sq of the {body} body"),
                change([before, after], Dimension::Length),
                about,
            ));
        }
    }
    let plastic: f64 = found.passes.iter().flat_map(|pass| pass.lost("plastic")).sum();
    if plastic > 0.0 {
        let all = "Volume that plastic flow has levelled in both bodies, all passes together.";
        cards.push(Card::new("plastic volume", format(plastic, Dimension::Volume), all));
    }
    if let Some(temperature) = largest_temperature(found, last) {
        let celsius = format!("{} °C", format_number(temperature - CELSIUS));
        cards.push(Card::new("largest temperature", celsius, "Of the surfaces in the last pass."));
    }
    if let Some(stress) = found.summary.as_ref().and_then(|summary| summary.subsurface.last()) {
        cards.push(of_stress(stress));
    }
    let of_interface = last.interface.iter().flat_map(interface_cells);
    for RowCell { head, column, value, .. } in of_interface.filter(|cell| cell.is_answer) {
        let value = dimension_of_column(column)
            .map_or_else(|| format_number(value), |dimension| format(value, dimension));
        cards.push(Card::of(head, column, value));
    }
    if let Some(drag) = last.drag {
        cards.push(Card::of("mean drag", "mean_drag", format(drag.mean_drag, Dimension::Force)));
    }
    if last.mean_tangential_force != 0.0 && last.friction_coefficient.is_finite() {
        let coefficient = format_number(last.friction_coefficient);
        cards.push(Card::of("coefficient of friction", "friction_coefficient", coefficient));
    }
    let approach = if differ(first.approach, last.approach) {
        change([first.approach, last.approach], Dimension::Length)
    } else {
        length(last.approach)
    };
    cards.push(Card::new("approach", approach, "Rigid-body approach in the first and in the last pass."));
    cards
}

fn of_points(points: &[SweepRecord]) -> Vec<Card> {
    let ends = |value: fn(&SweepRecord) -> f64, dimension| match points {
        [only] => format(value(only), dimension),
        _ => change([value(&points[0]), value(&points[points.len() - 1])], dimension),
    };
    let largest = |value: fn(&SweepRecord) -> f64| points.iter().map(value).fold(0.0, f64::max);
    let pressure = format(largest(|point| point.max_pressure), Dimension::Pressure);
    let traction = largest(|point| point.traction().map_or(0.0, |[x, y]| x.hypot(y)));
    if traction > 0.0 {
        let last = &points[points.len() - 1];
        let stick = |point: &SweepRecord| format_number(100.0 * point.stick_area / point.contact_area);
        let shear = format(largest(|point| point.max_shear), Dimension::Pressure);
        return vec![
            Card::new(
                "traction coefficient",
                format_number(traction),
                "Largest tangential force over the load.",
            ),
            Card::of("largest shear", "max_shear", shear),
            Card::of("largest pressure", "max_pressure", pressure),
            Card::new(
                "stick",
                format!("{} → {} %", stick(&points[0]), stick(last)),
                "Share of the contact, at the first and the last point.",
            ),
            Card::of("area of contact", "contact_area", format(last.contact_area, Dimension::Area)),
        ];
    }
    let from_to = if points.len() > 1 { "From the first to the last point." } else { "At the only point." };
    let last = &points[points.len() - 1];
    let load = if points.iter().all(|point| (point.load / last.load - 1.0).abs() < 1e-6) {
        Card::of("load", "load", format(last.load, Dimension::Force))
    } else {
        Card::new("load", ends(|point| point.load, Dimension::Force), from_to)
    };
    let mut cards = vec![
        load,
        Card::new("real area of contact", ends(|point| point.contact_area, Dimension::Area), from_to),
        Card::new("largest pressure", pressure, "Largest pressure of all points."),
        Card::new("approach", ends(|point| point.approach, Dimension::Length), from_to),
        Card::new("mean gap", ends(|point| point.mean_gap, Dimension::Length), from_to),
    ];
    if points.iter().all(|point| point.stiffness.is_some()) {
        let stiffness = ends(|point| point.stiffness.unwrap_or(f64::NAN), Dimension::Stiffness);
        cards.push(Card::of("normal stiffness", "stiffness", stiffness));
    }
    cards
}

fn of_stress(stress: &SubsurfaceRecord) -> Card {
    let depth = format(stress.position[2], Dimension::Length);
    let stress = format(stress.max_von_mises, Dimension::Pressure);
    Card::new("largest von Mises stress", stress, format!("{depth} below the surface."))
}

/// Bodies that are apart in the end: what they were on the way.
fn of_separated(found: &PageData, record: &StaticRecord) -> Vec<Card> {
    let most = |value: fn(&IncrementRecord) -> f64| found.increments.iter().map(value).fold(0.0, f64::max);
    let [area, load] = [most(|increment| increment.contact_area), most(|increment| increment.load)];
    let on_the_way = "On the way together and apart.";
    let mut cards = Vec::new();
    if area > 0.0 {
        cards.push(Card::new("largest area of contact", format(area, Dimension::Area), on_the_way));
        cards.push(Card::new("largest load", format(load, Dimension::Force), on_the_way));
    }
    cards.push(Card::new("mean gap", format(record.mean_gap, Dimension::Length), "In the end."));
    cards
}

fn of_rest(found: &PageData, record: &StaticRecord) -> Vec<Card> {
    let share = format_number(100.0 * record.contact_area / record.apparent_area);
    let mean = record.load / record.contact_area;
    if record.contact_area == 0.0 {
        return of_separated(found, record);
    }
    let mut cards = Vec::new();
    cards.extend([
        Card::new(
            "real area of contact",
            format(record.contact_area, Dimension::Area),
            format!("{share} % of the grid."),
        ),
        Card::new(
            "largest pressure",
            format(record.max_pressure, Dimension::Pressure),
            "In the most loaded cell.",
        ),
    ]);
    if mean.is_finite() {
        let nominal = format(record.load / record.apparent_area, Dimension::Pressure);
        cards.push(Card::new(
            "mean pressure",
            format(mean, Dimension::Pressure),
            format!("Load over the area of contact; {nominal} over the grid."),
        ));
    }
    cards.push(Card::of("approach", "approach", format(record.approach, Dimension::Length)));
    if let Some(stress) = found.summary.as_ref().and_then(|summary| summary.subsurface.first()) {
        cards.push(of_stress(stress));
    }
    if let Some(shear) = &record.shear {
        let stick = format_number(100.0 * shear.stick_area / record.contact_area);
        let sticks = format!("{stick} % of the contact sticks.");
        let [x, y] = shear.tangential_force;
        cards.push(if record.load > 0.0 {
            let about = format!("Tangential force over load; {sticks}");
            Card::new("traction coefficient", format_number(shear.force_ratio), about)
        } else {
            Card::new("tangential force", format(x.hypot(y), Dimension::Force), sticks)
        });
    }
    if let Some(plastic) = record.plastic.as_ref().filter(|plastic| plastic.max_plastic_strain > 0.0) {
        let strain = format!("{} %", format_number(100.0 * plastic.max_plastic_strain));
        cards.insert(2, Card::of("plastic strain", "max_plastic_strain", strain));
    }
    if record.plastic_volume > 0.0 {
        cards.push(Card::new(
            "plastic volume",
            format(record.plastic_volume, Dimension::Volume),
            "Volume levelled at the hardness.",
        ));
    }
    cards
}
