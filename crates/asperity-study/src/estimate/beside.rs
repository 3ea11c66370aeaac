//! Values of a case that are far from the quantities beside which they are judged.

use super::plausible::{GivenValue, far, given};
use super::{Estimate, STRENGTH};
use crate::case::{Body, Case, Course, Hardness, Layer, Part, Source, TopographySpec};
use crate::prepare::Bodies;
use asperity_base::beside::{Beside, Scale};
use asperity_base::grid::Grid;
use asperity_base::table::Kind;
use asperity_base::units::{self, Dimension, Metre, Newton};
use asperity_contact::each;
use asperity_contact::motion::Stage;
use asperity_contact::solver::{Control, Tangential};
use asperity_contact::with::{BodyLaw, Listed};

/// Warns of values in `case` far from their scales. A gap that is not `curved` is flat or rough.
pub(super) fn out_of_scale(case: &Case, bodies: &Bodies, estimate: &Estimate, curved: bool) -> Vec<String> {
    let given = given(case);
    let scales = Scales { case, given: &given, bodies, estimate, curved };
    given
        .iter()
        .flat_map(|value| value.key.beside.iter().filter_map(|beside| scales.judge(value, beside)))
        .collect()
}

/// Warns of laws that take more off the bodies than they have, or nothing that counts.
pub(super) fn lost(case: &Case, bodies: &Bodies, estimate: &Estimate) -> Vec<String> {
    /// Depth that no instrument measures.
    const NOTHING: Metre = 1e-11;
    /// Mean depth over the rms height of both surfaces, and over the longer side of the grid, up to which
    /// they stay surfaces.
    const MOST: [f64; 2] = [30.0, 0.1];
    let grid = bodies.lower.topography.grid();
    let Control::Load(load) = estimate.control else { return Vec::new() };
    let distance = match &estimate.course {
        Course::Passes(motion) => {
            let cells = motion.cells_of_position(grid.shape[0]) * (estimate.positions * motion.passes) as f64;
            motion.sliding_distance_of(cells, grid.pitch[0])
        }
        Course::InPlace(slide) => slide.ends.last().copied().unwrap_or(0.0),
        Course::Stages(stages) => shifted(stages),
        Course::Rolling(_) | Course::Sweep(_) => 0.0,
    };
    let friction = case.friction.as_ref().map_or(0.0, |friction| friction.law.coefficient);
    let most = || {
        let heights = bodies.lower.topography.sq().hypot(bodies.upper.topography.sq());
        let side = grid.extent()[0].max(grid.extent()[1]);
        if heights > 0.0 { (MOST[0] * heights).min(MOST[1] * side) } else { MOST[1] * side }
    };
    let pressure = estimate.hardness.min(STRENGTH * estimate.modulus);
    let length = |value| units::format(value, Dimension::Length);
    let mut warnings = Vec::new();
    for (name, body) in [("lower", &case.lower), ("upper", &case.upper)] {
        each!(law L => if let Some(law) = L::of(&body.laws) {
            let loss = law.per_pressure(friction) * distance;
            let (mean, deepest) = (loss * load / estimate.apparent_area, loss * pressure);
            let told = match (mean > most(), deepest > 0.0 && deepest < NOTHING) {
                (true, _) => Some(format!("{} deep in the mean, and no surface lasts so long", length(mean))),
                (_, true) => Some(format!("at most {} deep, which is nothing", length(deepest))),
                _ => None,
            };
            warnings.extend(told.map(|told| format!(
                "the {} of the {name} body over a distance of {} is {told}: check its coefficient, and the distance",
                L::NAME,
                length(distance)
            )));
        });
    }
    warnings
}

/// Returns the length of the way of displaced bodies over all cycles.
fn shifted(stages: &[Stage]) -> Metre {
    let mut place = [0.0; 2];
    let mut way = 0.0;
    for Stage { loading, cycles, .. } in stages {
        if let Tangential::Displacement([x, y]) = loading.tangential {
            let step = (x - place[0]).hypot(y - place[1]);
            way += cycles.map_or(step, |cycles| 2.0 * cycles.count as f64 * step);
            place = if cycles.is_some() { place } else { [x, y] };
        }
    }
    way
}

/// The quantities of a case beside which values are judged.
struct Scales<'a> {
    case: &'a Case,
    given: &'a [GivenValue],
    bodies: &'a Bodies,
    estimate: &'a Estimate,
    curved: bool,
}

impl Scales<'_> {
    /// Returns the warning about a value, or about several of which none is plausible.
    fn judge(&self, given: &GivenValue, beside: &Beside) -> Option<String> {
        let dimension = given.key.kind.dimension()?;
        let [low, high] = self.scale(beside.scale, &given.path, dimension)?;
        let numbers = given.numbers.iter().map(|(value, _)| value.abs());
        let sizes: Vec<f64> = match given.key.kind {
            Kind::Vector(_) => vec![numbers.fold(0.0, f64::hypot)],
            _ => numbers.collect(),
        };
        let mut sizes = sizes.into_iter().filter(|size| *size > 0.0 && size.is_finite());
        let first = sizes.next()?;
        let (least, most) =
            sizes.fold((first, first), |(least, most), size| (least.min(size), most.max(size)));
        // A sweep may go beyond what is plausible, but not lie beyond it as a whole.
        let [smaller, larger] = match beside.scale {
            Scale::Flattening | Scale::RelaxationSpeeds => [most, least],
            Scale::Cell => [least, most],
            _ => [most, most],
        };
        let [small, large] = beside.scale.words();
        let (value, ratio, words, scale, meaning) =
            match (smaller < beside.least * low, larger > beside.most * high) {
                (true, _) => (smaller, format!("1/{} of", far(low / smaller)), small, low, beside.meaning[0]),
                (_, true) => {
                    (larger, format!("{} times", far(larger / high)), large, high, beside.meaning[1])
                }
                _ => return None,
            };
        let quantity = |value| units::format(value, dimension);
        let (path, text) = (&given.path, &given.text);
        Some(format!(
            "`{path} = {text}` is {}, {ratio} {words}, {}: {meaning}; check its unit",
            quantity(value),
            quantity(scale)
        ))
    }

    /// Returns the smaller and the larger end of a scale for the key at the dotted `path`; `None` if the case
    /// does not have it.
    fn scale(&self, scale: Scale, path: &str, dimension: Dimension) -> Option<[f64; 2]> {
        let Self { case, bodies, estimate, .. } = self;
        let is_upper = path.starts_with("upper.");
        let body = if is_upper { &case.upper } else { &case.lower };
        let grid = *if is_upper { &bodies.upper } else { &bodies.lower }.topography.grid();
        let side = |grid: Grid| grid.extent()[0].max(grid.extent()[1]);
        let [dx, dy] = grid.pitch;
        let times = estimate.relaxation().map(|(times, _)| times);
        let one = |value: f64| (value > 0.0 && value.is_finite()).then_some([value; 2]);
        match scale {
            Scale::Cell => Some([dx.min(dy), dx.max(dy)]),
            Scale::Side => one(side(grid)),
            Scale::FreeSide => {
                let is_free = [0, 1].iter().any(|axis| !case.contact.boundary.repeats(*axis));
                is_free.then_some([side(grid); 2])
            }
            Scale::Heights => one(bodies.lower.topography.sq().hypot(bodies.upper.topography.sq())),
            Scale::RelaxationTimes => times,
            Scale::RelaxationSpeeds => times.map(|[short, long]| [dx.min(dy) / long, side(grid) / short]),
            Scale::Hardness => match body.hardness {
                Hardness::Uniform(hardness) => one(hardness),
                Hardness::Map(_) => None,
            },
            Scale::Young => {
                let is_of = |part: &Part<'_>| {
                    let table = case.table_of(if is_upper { "upper" } else { "lower" }, part.layer);
                    path.strip_prefix(&table).is_some_and(|key| key.starts_with('.'))
                };
                one(body.parts().find(is_of)?.young)
            }
            Scale::Friction => {
                let law = case.friction.as_ref()?.law;
                one((law.coefficient * self.largest_load()?).min(law.shear_strength * estimate.apparent_area))
            }
            Scale::MeanPressure => one(self.largest_load()? / estimate.apparent_area),
            Scale::Flattening => {
                let [low, high] = self.flattening()?;
                let area = if dimension == Dimension::Force { estimate.apparent_area } else { 1.0 };
                Some([low * area, high * area])
            }
            Scale::Key(key) => {
                let beside = format!("{}.{key}", path.rsplit_once('.')?.0);
                let value = self.given.iter().find(|value| value.path == beside)?;
                one(value.numbers.first()?.0).filter(|_| value.key.kind.dimension().is_some())
            }
        }
    }

    /// Largest load of the course, without an attraction, which presses by an unknown force.
    fn largest_load(&self) -> Option<Newton> {
        let load = |control: Control| match control {
            Control::Load(load) => Some(load),
            Control::Approach(_) => None,
        };
        let loads: Vec<Option<Newton>> = match &self.estimate.course {
            Course::Stages(stages) => stages.iter().map(|stage| load(stage.loading.normal)).collect(),
            Course::Sweep(points) => points.iter().map(|point| load(point.control)).collect(),
            _ => vec![load(self.estimate.control)],
        };
        let largest = loads.into_iter().collect::<Option<Vec<_>>>()?.into_iter().fold(0.0, f64::max);
        self.case.interface.is_empty().then_some(largest)
    }

    /// Returns the mean pressures at which rough surfaces touch in about a cell, and everywhere. Persson
    /// (2001): the area of contact is 2p/E*h' of the whole, and complete above some E*h'.
    fn flattening(&self) -> Option<[f64; 2]> {
        let Self { case, estimate, curved, .. } = self;
        let pressure = estimate.modulus * estimate.gap_slope;
        if *curved || case.is_coated() || !(pressure > 0.0 && pressure.is_finite()) {
            return None;
        }
        let is_random = |body: &Body| {
            let TopographySpec { source, plus, .. } = &body.topography;
            let layers = plus.iter().all(|layer| matches!(layer, Layer::Generate { .. }));
            !matches!(source, Source::Form { form, .. } if *form != asperity_surface::Form::Flat) && layers
        };
        let is_known = case.plasticity.is_none() && case.interface.is_empty();
        let is_known = is_known && [&case.lower, &case.upper].into_iter().all(is_random);
        let cells = estimate.apparent_area / self.bodies.lower.topography.grid().cell_area();
        let low = (0.5 * pressure).min(estimate.hardness) / cells;
        let stiffening = estimate.relaxation().map_or(1.0, |(_, stiffening)| stiffening);
        Some([if is_known { low } else { 0.0 }, pressure * stiffening])
    }
}
