//! What to be wary of in a result, told once it is there.

use super::case::Case;
use super::estimate::{CELLS_ACROSS, NOT_FLATTENED, cut_off, spot, too_few_cells};
use crate::grid::Field;
use crate::motion::{Interior, LoadedContact, Pair, PassRecord, SweepRecord};
use crate::operator::Boundary;
use crate::units::{self, Dimension};

/// The warnings of a static contact, by its pressure.
pub(super) fn static_contact(pair: &Pair, boundary: Boundary, pressure: &Field) -> Vec<String> {
    let gap = || pair.initial_gap(&pair.at_rest());
    let rim = cut_off(pressure, gap, pair.pitch(), boundary);
    rim.into_iter().chain(too_few_cells(spot(pressure, boundary))).collect()
}

/// The warnings of a sweep, by its points, of which the `last` is known as a whole.
pub(super) fn sweep(points: &[SweepRecord], last: &LoadedContact) -> Vec<String> {
    let coarse =
        || points.iter().map(|p| p.largest_spot_cells).filter(|cells| (1..CELLS_ACROSS).contains(cells));
    let at = |count: usize, warning: &str| format!("at {count} of {} points {warning}", points.len());
    let too_few = coarse().min().and_then(too_few_cells).map(|warning| at(coarse().count(), &warning));
    let rolls = last.record.shear.as_ref().is_some_and(|shear| shear.creepage.is_some());
    let plastic = points.iter().filter(|point| rolls && point.plastic_area > 0.0).count();
    let ploughed = (plastic > 0).then(|| at(plastic, &format!("cells yield {NOT_FLATTENED}")));
    too_few.into_iter().chain(ploughed).collect()
}

/// What to be wary of in a static contact that was loaded in stages, or rolls.
pub(super) fn loaded(contact: &LoadedContact) -> Vec<String> {
    /// Dissipation that is known less accurately than this is warned of.
    const ACCURATE: f64 = 0.1;
    let mut warnings = Vec::new();
    let Some(shear) = &contact.record.shear else { return warnings };
    let error = contact.dissipation_error / shear.dissipation;
    if error > ACCURATE {
        warnings.push(format!(
            "cells slip while what they bear changes: `dissipation` is known within {:.0} % only; give more `increments` \
             where the load and what acts in the plane change together",
            (100.0 * error).ceil()
        ));
    }
    let plastic = contact.record.plastic_cells;
    if shear.creepage.is_some() && plastic > 0 {
        warnings.push(format!("{plastic} cells yield {NOT_FLATTENED}"));
    }
    warnings
}

/// The warnings of a motion of bodies of these `shapes`, by its passes.
pub(super) fn motion(case: &Case, shapes: [[usize; 2]; 2], passes: &[PassRecord]) -> Vec<String> {
    let largest = passes.iter().map(|pass| pass.largest_spot_cells).max().unwrap_or(0);
    let flows = at_the_rim(case, shapes, passes, "plastic", "the plastic volume");
    let wears = at_the_rim(case, shapes, passes, "wear", "the wear");
    let all = flows.into_iter().chain(wears).chain(too_few_cells(largest));
    all.chain(thick_films(passes)).chain(all_computed(case, passes)).chain(settled(passes)).collect()
}

/// The warning that a film is thicker than the roughness that it stands on, whose contact it then is.
fn thick_films(passes: &[PassRecord]) -> Option<String> {
    let last = passes.last()?;
    let running = last.running?;
    let bodies = [
        ("lower", running.mean_film_lower, last.sq_lower),
        ("upper", running.mean_film_upper, last.sq_upper),
    ];
    let (name, film, sq) = bodies.into_iter().find(|(_, film, sq)| film > sq)?;
    let [film, sq] = [film, sq].map(|length| units::format(length, Dimension::Length));
    Some(format!(
        "the film on the {name} body is thicker, {film}, than the body is rough, {sq}: it is taken to be as stiff as the body"
    ))
}

/// The warning that every pass was computed where few would have done.
fn all_computed(case: &Case, passes: &[PassRecord]) -> Option<String> {
    /// Passes from which on it is worth a word.
    const MANY: usize = 100;
    let repeats = case.motion?.repeats();
    let all = case.acceleration.is_none() && case.runs_in() && passes.len() >= MANY;
    (all && repeats).then(|| {
        format!("all {} passes were computed: with `[acceleration]` one stands for many, within an error that is told", passes.len())
    })
}

/// The warning that the last passes have changed the bodies no more.
fn settled(passes: &[PassRecord]) -> Option<String> {
    /// Passes from which on it is worth a word.
    const MANY: usize = 10;
    /// Share of the largest volume that a pass has moved, up to which one moves none.
    const NONE: f64 = 1e-6;
    let moved = |pass: &PassRecord| {
        let volumes = pass.lost.iter().flat_map(|lost| lost.whole);
        volumes.map(f64::abs).sum::<f64>() / pass.represents() as f64
    };
    let most = passes.iter().map(moved).fold(0.0, f64::max);
    let last = passes.iter().skip(1).rev().take_while(|pass| moved(pass) <= NONE * most).count();
    let finished: usize = passes[..passes.len() - last].iter().map(PassRecord::represents).sum();
    (last >= MANY).then(|| {
        format!(
            "from pass {} on the bodies change no more: `passes = {finished}` tells as much",
            finished + 1
        )
    })
}

/// The warning that most of the volume of a law, which is called `what`, is lost at the free ends, more than their area accounts
/// for.
fn at_the_rim(
    case: &Case,
    shapes: [[usize; 2]; 2],
    passes: &[PassRecord],
    law: &str,
    what: &str,
) -> Option<String> {
    /// Times the volume per area of the interior.
    const DENSER: f64 = 2.0;
    let strategy = case.motion?.strategy;
    let interiors = Interior::of_bodies(shapes, case.contact.boundary, strategy, case.output.rim);
    let [mut all, mut rim, mut of_area] = [0.0; 3];
    for body in 0..2 {
        let lost: f64 = passes.iter().map(|pass| pass.lost(law)[body]).sum();
        let inside: f64 = passes.iter().map(|pass| pass.lost_inside(law)[body]).sum();
        let area = 1.0 - interiors[body].cells() as f64 / (shapes[body][0] * shapes[body][1]) as f64;
        all += lost;
        rim += lost - inside;
        of_area += lost * area;
    }
    if !(rim > 0.5 * all && rim / (all - rim) > DENSER * of_area / (all - of_area)) {
        return None;
    }
    Some(format!(
        "the rim of the bodies, {:.2} % of their area, takes {:.2} % of {what}: free ends plough; read the \
         columns `..._interior`, or let surfaces without ends pass by `strategy = \"shift\"` under a periodic boundary",
        100.0 * of_area / all,
        100.0 * rim / all
    ))
}
