//! The risk of bodies over that of smooth ones.

use std::sync::OnceLock;

use super::limited_bodies::{Limited, LimitedBodies};
use super::risk;
use crate::error::Result;
use crate::grid::Field;
use crate::motion::{LoadCycle, Motion, Pair, Simulation, StopsWith};
use crate::solver::{Control, Params};
use crate::with::Given;
use asperity_surface::{Level, Topography};

/// Exponents e of Weibull's law of lives, of point and of line contacts, by Lundberg and Palmgren.
const POINT: f64 = 10.0 / 9.0;
const LINE: f64 = 9.0 / 8.0;
/// Largest part of the overlap that a contact of smooth curved bodies covers. Bodies that touch on more are
/// flat.
const FLAT: f64 = 0.8;

/// Bodies without their roughness: those of second order that fit best.
#[derive(Debug)]
pub(super) struct Smooth {
    pair: Pair,
    params: Params,
    /// The risk of each body, and the exponent of lives; `None` if the bodies are flat.
    found: OnceLock<Option<([f64; 2], f64)>>,
}

impl Smooth {
    /// Takes the roughness off the bodies of a case.
    ///
    /// # Errors
    /// The errors of the fit.
    pub(super) fn new(given: &Given<'_>) -> Result<Self> {
        let mut pair = given.pair.clone();
        let grids = [pair.lower_grid(), pair.upper_grid()];
        for (body, grid) in [&mut pair.lower, &mut pair.upper].into_iter().zip(grids) {
            let rough = Topography::new(grid, body.heights.clone())?.level(Level::Quadratic)?;
            body.heights -= rough.heights();
            body.state.clear();
        }
        Ok(Self { pair, params: given.params, found: OnceLock::new() })
    }

    /// Returns the life of a body, by its index, over that of the smooth one under the same load,
    /// (I_smooth/I)^(1/e), from its f over the limit at each depth. `None` if the smooth bodies are flat, or
    /// if nothing is at risk.
    ///
    /// # Errors
    /// The errors of the contact of the smooth bodies; [`Error::Interrupted`](crate::Error::Interrupted).
    pub(super) fn life_ratio(
        &self,
        bodies: &LimitedBodies,
        (index, limited): (usize, &Limited),
        (motion, stop): (&Motion, &(dyn Fn() -> bool + Sync)),
        over_limit: &[&Field],
    ) -> Result<Option<f64>> {
        let found = match self.found.get() {
            Some(found) => found,
            None => {
                let found = self.solve(bodies, motion, stop)?;
                self.found.get_or_init(|| found)
            }
        };
        let Some((risks, exponent)) = found else { return Ok(None) };
        let rough = at_risk(limited, over_limit);
        let ratio = (risks[index] / rough).powf(1.0 / exponent);
        Ok(Some(ratio).filter(|ratio| *ratio > 0.0 && ratio.is_finite()))
    }

    /// Solves a pass of the smooth bodies.
    fn solve(
        &self,
        bodies: &LimitedBodies,
        motion: &Motion,
        stop: &(dyn Fn() -> bool + Sync),
    ) -> Result<Option<([f64; 2], f64)>> {
        let Control::Load(_) = motion.control else { return Ok(None) };
        let motion = Motion { passes: 1, ..*motion };
        let simulation = Simulation::new(self.pair.clone(), bodies.boundary, motion, self.params)?;
        let pass = simulation.solve(&StopsWith(stop))?;
        let widest = pass
            .steps()
            .iter()
            .zip(pass.contacts())
            .max_by(|(a, _), (b, _)| a.contact_area.total_cmp(&b.contact_area));
        let Some((step, contact)) = widest else { return Ok(None) };
        let overlap = self.pair.grid(step.overlap_columns).area();
        if step.contact_area > FLAT * overlap {
            return Ok(None);
        }
        let width = self.pair.lower.width();
        let touched = contact.pressure_field(width);
        let across = touched.columns().into_iter().filter(|row| row.iter().any(|p| *p > 0.0)).count();
        let mut risks = [0.0; 2];
        for (index, limited) in bodies.limited() {
            let cycle = LoadCycle::of_pass(pass.contacts(), &motion).until(stop);
            let found = bodies.dang_van((index, limited), &self.pair, &cycle)?;
            let over: Vec<Field> = found.iter().map(|at| &at.f / limited.criterion.limit()).collect();
            risks[index] = at_risk(limited, &over.iter().collect::<Vec<_>>());
        }
        Ok(Some((risks, if across == width { LINE } else { POINT })))
    }
}

/// Sum of the risk of all columns.
fn at_risk(limited: &Limited, over_limit: &[&Field]) -> f64 {
    let limit = if limited.endurance { 1.0 } else { 0.0 };
    let Some(first) = over_limit.first() else { return 0.0 };
    let column = |cell| -> Vec<f64> { over_limit.iter().map(|over| over[cell]).collect() };
    first.indexed_iter().map(|(cell, _)| risk(&limited.depths, &column(cell), limit)).sum()
}
