//! What to be wary of in a result, told once it is there.

use ndarray::Axis;

use super::case::Case;
use super::estimate::{CELLS_ACROSS, NOT_FLATTENED, cut_off, spot, too_few_cells};
use crate::grid::Field;
use crate::motion::{
    FlowedContact, FlowedVolume, Interior, LoadedContact, Pair, PassFlowRecord, PassRecord, ShearRecord,
    StaticRecord, StepRecord, SweepRecord,
};
use crate::operator::Boundary;
use crate::units::{self, Dimension, Joule, Metre, SquareMetre};

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
    let mut warnings = Vec::new();
    let Some(shear) = &contact.record.shear else { return warnings };
    warnings.extend(inaccurate(contact.dissipation_error, shear));
    let plastic = contact.record.plastic_cells;
    if shear.creepage.is_some() && plastic > 0 {
        warnings.push(format!("{plastic} cells yield {NOT_FLATTENED}"));
    }
    warnings
}

/// The warning that the energy which friction took is known roughly.
fn inaccurate(error: Joule, shear: &ShearRecord) -> Option<String> {
    /// Dissipation that is known less accurately than this is warned of.
    const ACCURATE: f64 = 0.1;
    let error = error / shear.dissipation;
    (error > ACCURATE).then(|| {
        format!(
            "cells slip while what they bear changes: `dissipation` is known within {:.0} % only; give more `increments` \
             where the load and what acts in the plane change together",
            (100.0 * error).ceil()
        )
    })
}

/// What to be wary of in a static contact of bodies that flow below their surfaces.
pub(super) fn flowed(case: &Case, pair: &Pair, contact: &FlowedContact) -> Vec<String> {
    /// Step of the load, of the load reached, beyond which the path of a flowing contact is followed roughly.
    const STEP: f64 = 0.15;
    let FlowedContact { record, flowed, .. } = contact;
    let mut warnings = volumes(case.contact.boundary, &flowed.volumes);
    let Some(flow) = &record.flow else { return warnings };
    let spot = spot_width(record, pair.cell_area());
    warnings.extend(thick_layers(&flowed.volumes, flow.max_plastic_strain, spot));
    let mut before = 0.0;
    let coarse = flowed.increments.iter().any(|increment| {
        let step = increment.load - std::mem::replace(&mut before, increment.load);
        let flows = increment.flow.is_some_and(|flow| flow.yielded_cells > 0);
        flows && increment.increment > 1 && step.abs() > STEP * record.load.max(increment.load)
    });
    if coarse {
        let hint = "a step of the load above 15 % of it while the bodies flow follows their path roughly: give more `increments`";
        warnings.push(hint.to_owned());
    }
    warnings.extend(record.shear.as_ref().and_then(|shear| inaccurate(contact.dissipation_error, shear)));
    warnings
}

/// What to be wary of in volumes that have flowed under a boundary.
pub(super) fn volumes(boundary: Boundary, volumes: &[FlowedVolume]) -> Vec<String> {
    /// Plastic strain beyond which strains are not small, and slope of the surface that it leaves.
    const SMALL: [f64; 2] = [0.1, 0.3];
    let mut warnings = Vec::new();
    let mut largest = 0.0_f64;
    for volume in volumes {
        let name = if volume.body == 0 { "lower" } else { "upper" };
        let flows = |layer: ndarray::ArrayView2<f64>| layer.iter().any(|strain| *strain > 0.0);
        let strain = &volume.state.accumulated;
        if strain.outer_iter().next_back().is_some_and(flows) {
            warnings.push(format!(
                "the {name} body flows in the deepest layer, below which it is elastic: give a larger `depth`"
            ));
        }
        let at_edge = |axis: usize| {
            let last = strain.shape()[axis] - 1;
            [0, last].iter().any(|at| strain.index_axis(Axis(axis), *at).iter().any(|strain| *strain > 0.0))
        };
        if [0, 1].iter().any(|axis| !boundary.repeats(*axis) && at_edge(axis + 1)) {
            warnings.push(format!(
                "the {name} body flows at the edge of the grid, beyond which it is elastic: take a larger grid"
            ));
        }
        let steepest = slope(&volume.displacement, volume.grid.pitch);
        if steepest > SMALL[1] {
            warnings.push(format!(
                "flow leaves a slope of {} on the {name} body: strains and slopes are taken to be small",
                units::format_number(steepest)
            ));
        }
        largest = strain.iter().fold(largest, |most, strain| most.max(*strain));
    }
    if largest > SMALL[0] {
        warnings.push(format!(
            "the largest plastic strain is {}: strains are taken to be small, up to {}",
            units::format_number(largest),
            SMALL[0]
        ));
    }
    warnings
}

/// The warning that the first layer of bodies that have flowed is too thick for a contact spot so wide.
fn thick_layers(volumes: &[FlowedVolume], strain: f64, spot: Metre) -> Option<String> {
    let first = volumes.first().map_or(0.0, |volume| volume.faces[1]);
    (strain > 0.0 && first > 0.25 * spot).then(|| {
        format!(
            "the first layer, {} thick, is more than a quarter of the contact across: give more `layers`, or let them grow",
            units::format(first, Dimension::Length)
        )
    })
}

/// What to be wary of in a motion of bodies that flow, by its positions and passes, and the volumes that these have left.
pub(super) fn rolled(
    case: &Case,
    pitch: Metre,
    steps: &[StepRecord],
    passes: &[PassRecord],
    left: &[FlowedVolume],
) -> Vec<String> {
    /// Step of the load from a position to the next, of the load reached, beyond which the path is followed roughly.
    const STEP: f64 = 0.15;
    /// Stride, of the width of a spot, beyond which the path is followed roughly.
    const STRIDE: f64 = 0.1;
    /// Share of the plastic work at the rim that is too much.
    const RIM: f64 = 0.1;
    let mut warnings = volumes(case.contact.boundary, left);
    let flows = |step: &StepRecord| step.flow.is_some_and(|flow| flow.yielded_cells > 0);
    let strain = steps.iter().filter_map(|step| step.flow).fold(0.0, |m: f64, f| m.max(f.max_plastic_strain));
    let widest = steps.iter().filter(|step| flows(step)).map(|step| step.largest_spot_cells).max();
    let Some(widest) = widest.map(|cells| cells as f64) else { return warnings };
    warnings.extend(thick_layers(left, strain, widest * pitch));
    let largest = passes.iter().map(|pass| pass.max_load).fold(0.0, f64::max);
    let rough = steps.windows(2).any(|pair| {
        let [before, now] = pair else { return false };
        before.pass == now.pass && flows(now) && (now.load - before.load).abs() > STEP * largest
    });
    if rough {
        warnings.push(
            "a step of the load above 15 % of it while the bodies flow follows their path roughly: give a smaller `stride`"
                .to_owned(),
        );
    }
    let stride = case.motion.map_or(1, |motion| motion.stride) as f64;
    if stride > STRIDE * widest {
        warnings.push(format!(
            "a step of {stride} cells is {:.0} % of the widest contact spot, {widest} cells: the path of flow is followed to some 4 % \
             at a tenth, 17 % at a quarter: give a smaller `stride`, or finer grids",
            100.0 * stride / widest
        ));
    }
    let sum = |value: fn(&PassFlowRecord) -> f64| -> f64 {
        passes.iter().filter_map(|pass| pass.flow).map(|flow| value(&flow)).sum()
    };
    let work = sum(|flow| flow.plastic_work_lower + flow.plastic_work_upper);
    let rim = sum(|flow| flow.plastic_work_rim);
    if rim > RIM * work {
        warnings.push(format!(
            "{:.0} % of the plastic work is under the outer two columns of the overlap: edges plough; add a sphere or a cylinder to \
             a body by `[[upper.topography.plus]]`, `taper` it, or let surfaces without ends pass by `strategy = \"shift\"` under \
             a periodic boundary",
            100.0 * rim / work
        ));
    }
    warnings
}

/// Side of a square of the area in contact.
fn spot_width(record: &StaticRecord, cell: SquareMetre) -> Metre {
    record.contact_area.max(cell).sqrt()
}

/// Steepest slope of a surface between neighbouring cells.
fn slope(heights: &Field, pitch: [Metre; 2]) -> f64 {
    let along = |axis: usize| {
        let rows = heights.axis_windows(Axis(axis), 2);
        let steps = rows.into_iter().map(move |pair| {
            let step = &pair.index_axis(Axis(axis), 1) - &pair.index_axis(Axis(axis), 0);
            step.iter().fold(0.0, |most: f64, step| most.max(step.abs())) / pitch[axis]
        });
        steps.fold(0.0, f64::max)
    };
    let sides = [heights.nrows(), heights.ncols()];
    [0, 1].into_iter().filter(|axis| sides[*axis] > 1).map(along).fold(0.0, f64::max)
}

/// The warnings of a motion of bodies of these `shapes`, by its passes.
pub(super) fn motion(case: &Case, shapes: [[usize; 2]; 2], passes: &[PassRecord]) -> Vec<String> {
    let largest = passes.iter().map(|pass| pass.largest_spot_cells).max().unwrap_or(0);
    let flows = at_the_rim(case, shapes, passes, "plastic", "the plastic volume");
    let wears = at_the_rim(case, shapes, passes, "wear", "the wear");
    let all = contact_in_the_rim(passes).into_iter().chain(flows).chain(wears).chain(too_few_cells(largest));
    all.chain(thick_films(passes)).chain(all_computed(case, passes)).chain(settled(passes)).collect()
}

/// The warning that most of the contact of the last pass lies in the rim, which means over the interior leave out.
fn contact_in_the_rim(passes: &[PassRecord]) -> Option<String> {
    /// Share of the contact in the rim that is too much; equal bodies that overlap in part have more than a half of it there.
    const MOST: f64 = 0.9;
    let last = passes.last()?;
    let share = 1.0 - last.mean_contact_area_interior / last.mean_contact_area;
    (share > MOST).then(|| {
        format!(
            "{:.1} % of the contact area lies in the rim of the bodies: the columns of the interior describe next to none of the contact; \
             remove tilt and form by `level`, or `taper` the ends",
            100.0 * share
        )
    })
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
    // What flow below the surfaces does has a verdict of its own.
    if passes.iter().any(|pass| pass.flow.is_some()) {
        return None;
    }
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
