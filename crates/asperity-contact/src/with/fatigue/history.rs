//! Stress of all contacts of a load cycle, depth by depth.

use rayon::prelude::*;

use super::ball::{Point, RIM, less, smallest_ball, squared};
use super::criterion::{DangVan, max_shear};
use crate::error::{Error, Result, check, check_in};
use crate::grid::{Field, Grid};
use crate::kernel::Stack;
use crate::operator::Boundary;
use crate::stress::Stress;
use crate::subsurface::{StressAtDepth, Tractions};
use crate::units::{Dimension, Metre, Pascal};

/// Bytes of the stress that is kept instead of computed anew for each sweep, at all depths that are computed
/// at the same time.
const KEPT: f64 = 512e6;
/// Sweeps over the contacts without an end, which do not happen.
const MOST_SWEEPS: usize = 64;
/// Distance from a ball, over its radius, by which a point may lie outside.
const OUTSIDE: f64 = 1e-10;
/// Rounding of the stress over the largest pressure.
const ROUNDING: f64 = 1e-14;

/// A body under a load cycle, which repeats: the contacts that it sees, one after another, as those of a pass
/// or of a cycle of fretting.
///
/// `tractions` returns the tractions on this body, on its own cells, in a contact of the cycle, from 0. It is
/// called several times for each contact, from several threads.
pub struct StressHistory<'a, F> {
    grid: Grid,
    boundary: Boundary,
    poisson: f64,
    stack: Option<Stack>,
    contacts: usize,
    tractions: F,
    stop: Option<&'a (dyn Fn() -> bool + Sync)>,
}

/// The points at one depth, and all that they have seen.
#[derive(Debug, Clone, PartialEq)]
pub struct AtDepth {
    /// The depth.
    pub depth: Metre,
    /// Dang Van's f of each cell, Pa.
    pub f: Field,
    /// Radius of the smallest ball around the deviators, Pa.
    pub radius: Field,
    /// Half the range of σxz, Pa.
    pub shear_amplitude: Field,
    /// Sweeps over the contacts, the last of which found all deviators inside of the balls.
    pub sweeps: usize,
}

/// The ball around the deviators of a cell so far.
struct Grown {
    /// The first deviator. The others count from it, so that a ball much smaller than the stress is as exact.
    origin: Point,
    centre: Point,
    square: f64,
    rim: Vec<Point>,
    /// Whether no contact of the present sweep was outside.
    holds: bool,
    done: bool,
    f: Pascal,
    shear: [Pascal; 2],
}

impl Grown {
    fn new(deviator: Point, shear: Pascal) -> Self {
        let (centre, rim) = ([0.0; 5], vec![[0.0; 5]]);
        let (holds, done) = (true, false);
        Self {
            origin: deviator,
            centre,
            square: 0.0,
            rim,
            holds,
            done,
            f: f64::NEG_INFINITY,
            shear: [shear; 2],
        }
    }

    /// Takes in a deviator that is outside.
    fn take_in(&mut self, deviator: &Point) {
        self.rim.push(*deviator);
        let (centre, square) = smallest_ball(&mut self.rim);
        // The ball holds its points up to their rounding.
        self.square = square.max(self.square);
        self.centre = centre;
        let far = (1.0 - 1e-9) * square;
        self.rim.retain(|point| squared(point, &centre) >= far);
        self.rim.truncate(RIM);
        self.holds = false;
    }

    /// Looks at a contact.
    fn see(&mut self, stress: [Pascal; 6], weight: f64, rounding: Pascal) {
        let (deviator, mean) = Stress::from_components(stress).split();
        let shear = stress[4];
        self.shear = [self.shear[0].min(shear), self.shear[1].max(shear)];
        let deviator = less(&deviator, &self.origin);
        let allowed = self.square * (1.0 + OUTSIDE).powi(2) + rounding * rounding;
        if squared(&deviator, &self.centre) > allowed {
            self.take_in(&deviator);
        }
        if self.holds {
            self.f = self.f.max(max_shear(&less(&deviator, &self.centre)) + weight * mean);
        }
    }

    /// Ends a sweep: the ball is the smallest if it held all of it.
    fn end_sweep(&mut self) {
        self.done = self.holds;
        if !self.done {
            (self.holds, self.f) = (true, f64::NEG_INFINITY);
        }
    }
}

impl DangVan {
    /// Returns f of a point that sees this `history` of stresses again and again, and the radius of the
    /// smallest ball around its deviators. Without stresses f is −∞.
    pub fn evaluate(&self, history: &[Stress]) -> [Pascal; 2] {
        let components = history.iter().map(Stress::components);
        let largest = components.clone().flatten().fold(0.0f64, |most, s| most.max(s.abs()));
        let Some(first) = history.first() else { return [f64::NEG_INFINITY, 0.0] };
        let mut cell = Grown::new(first.split().0, first.xz);
        for _ in 0..MOST_SWEEPS {
            components.clone().for_each(|stress| cell.see(stress, self.weight(), ROUNDING * largest));
            cell.end_sweep();
            if cell.done {
                break;
            }
        }
        [cell.f, cell.square.sqrt()]
    }
}

impl<'a, F: Fn(usize) -> Tractions + Sync> StressHistory<'a, F> {
    /// Creates the history of a body with Poisson's ratio `poisson`.
    pub fn new(grid: Grid, boundary: Boundary, poisson: f64, contacts: usize, tractions: F) -> Self {
        Self { grid, boundary, poisson, stack: None, contacts, tractions, stop: None }
    }

    /// Sets or removes layers on the body.
    #[must_use]
    pub fn with_layers(self, stack: impl Into<Option<Stack>>) -> Self {
        Self { stack: stack.into(), ..self }
    }

    /// Ends with [`Error::Interrupted`] as soon as `stop` is true.
    #[must_use]
    pub fn until(self, stop: &'a (dyn Fn() -> bool + Sync)) -> Self {
        Self { stop: Some(stop), ..self }
    }

    /// Computes Dang Van's f at the `depths` ≥ 0.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for a depth below 0 or without a contact; [`Error::Interrupted`].
    ///
    /// # Panics
    /// If a traction has another shape than the grid.
    pub fn dang_van(&self, criterion: &DangVan, depths: &[Metre]) -> Result<Vec<AtDepth>> {
        check("contacts", self.contacts as f64, self.contacts > 0, "at least one contact")?;
        for depth in depths {
            let is_depth = *depth >= 0.0 && depth.is_finite();
            check_in(Dimension::Length, "depth", *depth, is_depth, "a finite depth of at least 0")?;
        }
        depths.par_iter().map(|depth| self.at(criterion.weight(), *depth)).collect()
    }

    /// Returns the stress in a contact, component by component, and its largest traction.
    fn stress(&self, at_depth: &StressAtDepth, contact: usize) -> Result<([Field; 6], Pascal)> {
        if self.stop.is_some_and(|stop| stop()) {
            return Err(Error::Interrupted);
        }
        let tractions = (self.tractions)(contact);
        let all = tractions.shear.iter().flatten().chain([&tractions.pressure]).flatten();
        let largest = all.fold(0.0f64, |most, traction| most.max(traction.abs()));
        Ok((at_depth.under(&tractions), largest))
    }

    fn at(&self, weight: f64, depth: Metre) -> Result<AtDepth> {
        let at_depth = StressAtDepth::new(self.grid, self.boundary, self.poisson, depth);
        let at_depth = at_depth.with_layers(self.stack.clone());
        let bytes = 48.0 * (self.contacts * self.grid.cells()) as f64;
        let mut kept: Vec<[Field; 6]> = Vec::new();
        let mut cells: Vec<Grown> = Vec::new();
        let (mut sweeps, mut largest) = (0, 0.0f64);
        while sweeps < MOST_SWEEPS && !cells.iter().all(|cell| cell.done) || sweeps == 0 {
            for contact in 0..self.contacts {
                let computed;
                let stress = match kept.get(contact) {
                    Some(stress) => stress,
                    None => {
                        let traction;
                        (computed, traction) = self.stress(&at_depth, contact)?;
                        largest = largest.max(traction);
                        &computed
                    }
                };
                let components = stress.each_ref().map(|field| field.as_slice().expect("standard layout"));
                let of_cell = |cell: usize| components.map(|component| component[cell]);
                if cells.is_empty() {
                    let first = (0..self.grid.cells()).map(of_cell);
                    cells.extend(
                        first.map(|stress| Grown::new(Stress::from_components(stress).split().0, stress[4])),
                    );
                }
                let left = cells.par_iter_mut().enumerate().filter(|(_, cell)| !cell.done);
                left.for_each(|(index, cell)| cell.see(of_cell(index), weight, ROUNDING * largest));
                if sweeps == 0 && bytes <= KEPT / rayon::current_num_threads() as f64 {
                    kept.push(stress.clone());
                }
            }
            cells.par_iter_mut().filter(|cell| !cell.done).for_each(Grown::end_sweep);
            sweeps += 1;
        }
        let field = |value: &dyn Fn(&Grown) -> f64| {
            let values = cells.iter().map(value).collect();
            Field::from_shape_vec(self.grid.shape, values).expect("a value for each cell")
        };
        Ok(AtDepth {
            depth,
            f: field(&|cell| cell.f),
            radius: field(&|cell| cell.square.sqrt()),
            shear_amplitude: field(&|cell| 0.5 * (cell.shear[1] - cell.shear[0])),
            sweeps,
        })
    }
}
