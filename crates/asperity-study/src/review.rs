//! Warnings about a finished result.

use ndarray::Axis;

use super::case::Case;
use super::estimate::{CELLS_ACROSS, NOT_FLATTENED, cut_off, spot, too_few_cells};
use asperity_base::grid::Field;
use asperity_base::units::{self, Dimension, Joule, Metre, SquareMetre};
use asperity_contact::each;
use asperity_contact::motion::{
    IncrementRecord, Interior, LoadedContact, Pair, Paraboloid, PassPlasticRecord, PassRecord, PlasticVolume,
    ShearRecord, StaticRecord, StepRecord, SweepRecord,
};
use asperity_contact::operator::Boundary;
use asperity_contact::with::{self, BodyLaw};

/// Returns the warnings of a static contact, from its pressure.
pub(super) fn static_contact(pair: &Pair, boundary: Boundary, pressure: &Field) -> Vec<String> {
    let gap = || pair.initial_gap(&pair.at_rest());
    let rim = cut_off(pressure, gap, pair.pitch(), boundary);
    let of_interface =
        with::doubts_at_rest(pressure, boundary, || Paraboloid::fit(&gap(), pair.pitch()).is_some());
    rim.into_iter().chain(of_interface).chain(too_few_cells(spot(pressure, boundary))).collect()
}

/// Warns of a scar on curved bodies that reaches a free side of the grid, from the bodies before and after
/// they were worn.
pub(super) fn scar(before: &Pair, after: &Pair, boundary: Boundary) -> Option<String> {
    /// Depth at the rim over the deepest that needs no warning.
    const SHALLOW: f64 = 0.01;
    // The upper heights are those of its underside.
    let worn = |high: &Field, low: &Field| (high - low).mapv(|depth| depth.max(0.0));
    let depth =
        worn(&before.lower.heights, &after.lower.heights) + worn(&after.upper.heights, &before.upper.heights);
    let deepest = |depth: ndarray::ArrayView1<f64>| depth.iter().copied().fold(0.0, f64::max);
    let most = depth.iter().copied().fold(0.0, f64::max);
    let at_rim = |axis: usize| {
        let last = depth.len_of(Axis(axis)) - 1;
        deepest(depth.index_axis(Axis(axis), 0)).max(deepest(depth.index_axis(Axis(axis), last)))
    };
    let free = [0, 1].into_iter().filter(|axis| !boundary.repeats(*axis));
    let (axis, rim) = free.map(|axis| (axis, at_rim(axis))).max_by(|one, other| one.1.total_cmp(&other.1))?;
    let is_cut_off = rim > SHALLOW * most;
    let is_curved = || Paraboloid::fit(&before.initial_gap(&before.at_rest()), before.pitch()).is_some();
    (is_cut_off && is_curved()).then(|| {
        format!(
            "the scar reaches the rim of the grid along {}: the outermost cells have lost {}, the deepest {}, and what is worn beyond the \
             grid is missing; take a larger `shape`, or let the bodies slide less far",
            ["x", "y"][axis],
            units::format(rim, Dimension::Length),
            units::format(most, Dimension::Length)
        )
    })
}

/// Returns the warnings of a sweep, from its points and the contact of the `last` one.
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

/// Returns the warnings of a static contact loaded in stages, or of a rolling contact.
pub(super) fn loaded(contact: &LoadedContact, boundary: Boundary) -> Vec<String> {
    let mut warnings = Vec::new();
    let Some(shear) = &contact.record.shear else { return warnings };
    warnings.extend(inaccurate(contact.dissipation_error, shear));
    warnings.extend(moves_on(contact, boundary));
    let plastic = contact.record.plastic_cells;
    if shear.creepage.is_some() && plastic > 0 {
        warnings.push(format!("{plastic} cells yield {NOT_FLATTENED}"));
    }
    warnings
}

/// Warns of bodies that laws change and that shift by more than a small part of their contact, while the same
/// cells stay opposite each other.
fn moves_on(contact: &LoadedContact, boundary: Boundary) -> Option<String> {
    /// Amplitude over the width of the largest spot that needs no warning.
    const SMALL: f64 = 0.2;
    contact.changed.as_ref()?;
    let normal = contact.solution.normal();
    let range = |value: fn(&IncrementRecord) -> f64| {
        let values = || contact.increments.iter().map(value);
        values().fold(f64::NEG_INFINITY, f64::max) - values().fold(f64::INFINITY, f64::min)
    };
    let amplitude =
        0.5 * range(|i| i.tangential_displacement_x).hypot(range(|i| i.tangential_displacement_y));
    let [x, y] = normal.grid.pitch;
    let width = spot(&normal.pressure, boundary) as f64 * x.min(y);
    (width > 0.0 && amplitude > SMALL * width).then(|| {
        format!(
            "the bodies shift by {} to either side, and their largest spot of contact is {} wide: the model keeps the same cells opposite \
             each other, which is for slip that is small compared with a spot",
            units::format(amplitude, Dimension::Length),
            units::format(width, Dimension::Length)
        )
    })
}

/// Warns of cycles in which a warm contact has time to cool, because their temperature is that of their mean
/// heat.
pub(super) fn flash_in_cycles(case: &Case, contact: &LoadedContact, boundary: Boundary) -> Option<String> {
    /// Largest rise that needs no warning, K.
    const SMALL: f64 = 10.0;
    let heat = contact.changed.as_ref()?.heat.as_ref()?;
    let normal = contact.solution.normal();
    let [x, y] = normal.grid.pitch;
    let radius = 0.5 * spot(&normal.pressure, boundary) as f64 * x.min(y);
    let bodies = [&case.lower, &case.upper].into_iter().filter_map(|body| body.thermal);
    let slowest = bodies.map(|thermal| thermal.diffusivity()).fold(f64::INFINITY, f64::min);
    let crosses = radius * radius / slowest;
    let period = case.history.iter().filter_map(|stage| stage.period).fold(0.0, f64::max);
    let bulk = case.temperature?.bulk;
    let rise = heat.temperature.iter().copied().fold(0.0, f64::max) - bulk[0].max(bulk[1]);
    (radius > 0.0 && period > crosses && rise > SMALL).then(|| {
        format!(
            "heat crosses the largest spot of contact in {}, and a cycle takes {}: the temperature follows the slip within the cycle, and \
             while the bodies slip fast it rises above that of the mean heat, which the films see",
            units::format(crosses, Dimension::Time),
            units::format(period, Dimension::Time)
        )
    })
}

/// Warns of an inaccurate frictional energy.
fn inaccurate(error: Joule, shear: &ShearRecord) -> Option<String> {
    /// Relative uncertainty of the dissipation that needs no warning.
    const ACCURATE: f64 = 0.1;
    (error > ACCURATE * shear.dissipation).then(|| {
        "cells slip while their pressure changes, so that `dissipation` depends on the steps in which load and push grow together: press first \
         and push in a [[history]], or give a stage in which both change more `increments`"
            .to_owned()
    })
}

/// Returns the warnings of a static contact of elasto-plastic bodies.
pub(super) fn elasto_plastic(case: &Case, pair: &Pair, contact: &LoadedContact) -> Vec<String> {
    /// Step of the load, relative to the load reached, above which the loading path is resolved only roughly.
    const STEP: f64 = 0.15;
    let LoadedContact { record, plastic_result: Some(plastic_result), .. } = contact else {
        return Vec::new();
    };
    let mut warnings = volumes(case.contact.boundary, &plastic_result.volumes);
    let Some(plastic) = &record.plastic else { return warnings };
    let spot = spot_width(record, pair.cell_area());
    warnings.extend(thick_layers(&plastic_result.volumes, plastic.max_plastic_strain, spot));
    let mut before = 0.0;
    let coarse = contact.increments.iter().any(|increment| {
        let step = increment.load - std::mem::replace(&mut before, increment.load);
        let flows = increment.plastic.is_some_and(|plastic| plastic.yielded_cells > 0);
        flows && increment.increment > 1 && step.abs() > STEP * record.load.max(increment.load)
    });
    if coarse {
        let hint = "the load changes by more than 15 % in an increment while the bodies yield, which follows the loading path only roughly: give more `increments`";
        warnings.push(hint.to_owned());
    }
    warnings
}

/// Returns the warnings of plastic volumes under a boundary.
pub(super) fn volumes(boundary: Boundary, volumes: &[PlasticVolume]) -> Vec<String> {
    /// Plastic strain above which strains are not small, and the same for the slope of the residual surface.
    const SMALL: [f64; 2] = [0.1, 0.3];
    let mut warnings = Vec::new();
    let mut largest = 0.0_f64;
    for volume in volumes {
        let name = if volume.body == 0 { "lower" } else { "upper" };
        let flows = |layer: ndarray::ArrayView2<f64>| layer.iter().any(|strain| *strain > 0.0);
        let strain = &volume.state.accumulated;
        if strain.outer_iter().next_back().is_some_and(flows) {
            warnings.push(format!(
                "the {name} body yields in its deepest layer, and below it the model is elastic: give a larger `depth`"
            ));
        }
        let at_edge = |axis: usize| {
            let last = strain.shape()[axis] - 1;
            [0, last].iter().any(|at| strain.index_axis(Axis(axis), *at).iter().any(|strain| *strain > 0.0))
        };
        if [0, 1].iter().any(|axis| !boundary.repeats(*axis) && at_edge(axis + 1)) {
            warnings.push(format!(
                "the {name} body yields at the edge of the grid, and beyond it the model is elastic: take a larger grid"
            ));
        }
        let steepest = slope(&volume.displacement, volume.grid.pitch);
        if steepest > SMALL[1] {
            warnings.push(format!(
                "plastic strain leaves a slope of {} on the {name} body: the model assumes small strains and slopes",
                units::format_number(steepest)
            ));
        }
        largest = strain.iter().fold(largest, |most, strain| most.max(*strain));
    }
    if largest > SMALL[0] {
        warnings.push(format!(
            "the largest plastic strain is {}: the model assumes small strains, up to {}",
            units::format_number(largest),
            SMALL[0]
        ));
    }
    warnings
}

/// Warns if the first layer of elasto-plastic bodies is too thick for the width of the contact spot.
fn thick_layers(volumes: &[PlasticVolume], strain: f64, spot: Metre) -> Option<String> {
    let first = volumes.first().map_or(0.0, |volume| volume.faces[1]);
    (strain > 0.0 && first > 0.25 * spot).then(|| {
        format!(
            "the first layer is {} thick, more than a quarter of the width of the contact: give more `layers`, or set `growth` above 1",
            units::format(first, Dimension::Length)
        )
    })
}

/// Returns the warnings of a motion of elasto-plastic bodies, from its positions and passes, and from the
/// residual volumes.
pub(super) fn rolled(
    case: &Case,
    pitch: Metre,
    steps: &[StepRecord],
    passes: &[PassRecord],
    left: &[PlasticVolume],
) -> Vec<String> {
    /// Step of the load from one position to the next, relative to the load reached, above which the loading
    /// path is resolved only roughly.
    const STEP: f64 = 0.15;
    /// Stride, relative to the width of a spot, above which the path is resolved only roughly.
    const STRIDE: f64 = 0.1;
    /// Largest acceptable share of the plastic work at the rim.
    const RIM: f64 = 0.1;
    let mut warnings = volumes(case.contact.boundary, left);
    let flows = |step: &StepRecord| step.plastic.is_some_and(|plastic| plastic.yielded_cells > 0);
    let strain =
        steps.iter().filter_map(|step| step.plastic).fold(0.0, |m: f64, f| m.max(f.max_plastic_strain));
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
            "the load changes by more than 15 % from one position to the next while the bodies yield, which follows the loading path only roughly: give a smaller `stride`"
                .to_owned(),
        );
    }
    let stride = case.motion.map_or(1, |motion| motion.stride) as f64;
    if stride > STRIDE * widest {
        warnings.push(format!(
            "a stride of {stride} cells is {:.0} % of the widest contact spot, {widest} cells: the error of the plastic strain is about \
             4 % at a tenth and 17 % at a quarter; give a smaller `stride` or finer grids",
            100.0 * stride / widest
        ));
    }
    let sum = |value: fn(&PassPlasticRecord) -> f64| -> f64 {
        passes.iter().filter_map(|pass| pass.plastic).map(|plastic| value(&plastic)).sum()
    };
    let work = sum(|plastic| plastic.plastic_work_lower + plastic.plastic_work_upper);
    let rim = sum(|plastic| plastic.plastic_work_rim);
    if rim > RIM * work {
        warnings.push(format!(
            "{:.0} % of the plastic work is under the outer two columns of the overlap, where free edges plough; add a sphere or a cylinder to \
             a body by `[[upper.topography.plus]]`, `taper` it, or let surfaces without ends pass by `strategy = \"shift\"` under \
             a periodic boundary",
            100.0 * rim / work
        ));
    }
    warnings
}

/// Side of a square with the contact area.
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

/// Returns the warnings of a motion of bodies with these `shapes`, from its passes.
pub(super) fn motion(case: &Case, shapes: [[usize; 2]; 2], passes: &[PassRecord]) -> Vec<String> {
    let largest = passes.iter().map(|pass| pass.largest_spot_cells).max().unwrap_or(0);
    let flows = at_the_rim(case, shapes, passes, "plastic", "the plastic volume");
    let mut removed = Vec::new();
    each!(law L => if L::CELL.is_inside {
        removed.extend(at_the_rim(case, shapes, passes, L::NAME, &format!("the {}", L::CELL.head)));
    });
    let all =
        contact_in_the_rim(passes).into_iter().chain(flows).chain(removed).chain(too_few_cells(largest));
    let all = all.chain(strides(case, passes));
    all.chain(all_computed(case, passes)).chain(settled(passes)).collect()
}

/// Warns if most of the contact of the last pass lies in the rim, which the numbers of the interior leave
/// out.
fn contact_in_the_rim(passes: &[PassRecord]) -> Option<String> {
    /// Largest share of the contact in the rim without a warning. Equal bodies in partial overlap have more
    /// than half there.
    const MOST: f64 = 0.9;
    let last = passes.last()?;
    let share = 1.0 - last.mean_contact_area_interior / last.mean_contact_area;
    (share > MOST).then(|| {
        format!(
            "{:.1} % of the contact area lies in the rim of the bodies: the columns of the interior leave most of it out; \
             remove tilt and form by `level`, or `taper` the ends",
            100.0 * share
        )
    })
}

/// Warns if viscoelastic bodies move by a large part of their spots of contact in a step.
fn strides(case: &Case, passes: &[PassRecord]) -> Option<String> {
    /// Stride over the width of the widest spot of contact that needs no warning; most spots of rough bodies
    /// are narrower by far.
    const SMALL: f64 = 0.06;
    let last = passes.last().filter(|pass| pass.drag.is_some() && pass.largest_spot_cells > 0)?;
    let (stride, widest) = (case.motion?.stride, last.largest_spot_cells);
    (stride as f64 > SMALL * widest as f64).then(|| {
        format!(
            "the bodies move by {} from one position to the next, and their widest spot of contact has {widest}: in steps of a seventh of a \
             spot the drag is about 3 % too small, in steps of a quarter 10 %, and most spots are narrower than the widest; give {}a finer grid",
            if stride == 1 { "a cell".to_owned() } else { format!("{stride} cells") },
            if stride == 1 { "" } else { "a smaller `stride` or " }
        )
    })
}

/// Warns if every pass was computed although few would have been enough.
fn all_computed(case: &Case, passes: &[PassRecord]) -> Option<String> {
    /// Number of passes from which a warning is useful.
    const MANY: usize = 100;
    let repeats = case.motion?.repeats();
    let all = case.acceleration.is_none() && case.runs_in() && passes.len() >= MANY;
    (all && repeats).then(|| {
        format!("all {} passes were computed: `[acceleration]` extrapolates over many passes with an error estimate", passes.len())
    })
}

/// Warns if the last passes no longer changed the bodies.
fn settled(passes: &[PassRecord]) -> Option<String> {
    /// Number of passes from which a warning is useful.
    const MANY: usize = 10;
    /// Volume of a pass relative to the largest of all passes, below which a pass changes nothing.
    const NONE: f64 = 1e-6;
    // Plastic flow below the surfaces has a separate warning.
    if passes.iter().any(|pass| pass.plastic.is_some()) {
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
        format!("the bodies stop changing at pass {}: `passes = {finished}` is enough", finished + 1)
    })
}

/// Warns if most of the volume of a law, called `what`, is lost at the free ends, more than in proportion to
/// their area.
fn at_the_rim(
    case: &Case,
    shapes: [[usize; 2]; 2],
    passes: &[PassRecord],
    law: &str,
    what: &str,
) -> Option<String> {
    /// Limit as a multiple of the volume per area of the interior.
    const DENSER: f64 = 2.0;
    let strategy = case.motion?.strategy();
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
