//! One semismooth Newton method for the film, the cavity and the contact.
//!
//! Cells are sorted by what their last step said: full or empty of oil, touching or not. Then the balance of the
//! oil, h = h_c where solids touch, and the load are linear systems, solved by GMRES with the displacement by
//! transforms. What makes it converge where the solids bear part of the load:
//!
//! - below the boundary film, the flow sees a film that bends smoothly, and Newton's matrix its derivative;
//! - after each step pressures and cavity fractions are brought back into their range with p + c kept;
//! - cells are sorted before that.

use std::borrow::Cow;

use super::flow::{Balance, Flow, OFFSETS, UPSTREAM};
use super::near::{Near, NearFactor, Neighbours};
use super::state::{Scales, Sides, State};
use crate::grid::Field;
use crate::math::{gmres, parallel};
use crate::operator::Operator;
use crate::solver::Control;

/// Residual of a linear system relative to its right-hand side.
const REDUCTION: f64 = 1e-3;

/// Most Krylov steps of a linear system.
const MOST_KRYLOV: usize = 60;

/// Shares of a step that are tried.
const SHARES: [f64; 6] = [1.0, 0.6, 0.35, 0.2, 0.1, 0.05];

/// A share of a step is taken at once if it leaves less than this part of the norm of all residuals.
const FALL: f64 = 0.7;

/// Largest change of a pressure in a step, relative to the largest pressure.
const LARGEST_CHANGE: f64 = 0.5;

/// A problem, its bodies, and the counts of its solution.
pub(super) struct Newton<'a> {
    pub(super) operator: &'a mut dyn Operator,
    pub(super) flow: &'a Flow<'a>,
    pub(super) gap: Cow<'a, Field>,
    pub(super) control: Control,
    pub(super) scales: Scales,
    pub(super) near: Near,
    pub(super) convolutions: usize,
    pub(super) krylov: usize,
}

/// The last state of an iteration.
pub(super) struct Reached {
    pub(super) state: State,
    pub(super) h: Vec<f64>,
    pub(super) residual: f64,
    pub(super) iterations: usize,
}

/// A state with all that is computed from it.
struct Point {
    state: State,
    h: Vec<f64>,
    balances: Vec<Balance>,
    norm: f64,
}

impl Newton<'_> {
    /// Iterates until the largest residual is at most `tolerance`, at most `most` times.
    pub(super) fn solve(&mut self, start: State, tolerance: f64, most: usize) -> Reached {
        let h = self.film(&start);
        let mut sides = Sides::new(&start, &h, self.flow.boundary_film, &self.scales);
        let mut point = self.point(start, h);
        let mut iterations = 0;
        loop {
            let (system, right) = System::new(self, &point, &sides);
            // A NaN stays, which `f64::max` would ignore.
            let larger = |most: f64, r: &f64| if r.abs() > most || r.is_nan() { r.abs() } else { most };
            let residual = right.iter().fold(0.0, larger);
            let is_done = residual <= tolerance && iterations > 0;
            if is_done || iterations == most || !residual.is_finite() {
                return Reached { state: point.state, h: point.h, residual, iterations };
            }
            let step = system.solve(self, right);
            (point, sides) = self.advanced(point, &step);
            iterations += 1;
        }
    }

    /// Returns the norm of all residuals of a state.
    pub(super) fn norm(&mut self, state: State) -> f64 {
        let h = self.film(&state);
        self.point(state, h).norm
    }

    /// Returns the best of the shares of a step, and on which sides it leaves the cells.
    fn advanced(&mut self, from: Point, step: &State) -> (Point, Sides) {
        let sums = from.state.oil.iter().zip(&from.state.solids).map(|(p, c)| p + c);
        let largest = sums.fold(self.scales.pressure, f64::max);
        let changes = step.oil.iter().zip(&step.solids).map(|(p, c)| (p + c).abs());
        let full = (LARGEST_CHANGE * largest / changes.fold(0.0, f64::max)).min(1.0);
        let mut best: Option<(Point, Sides)> = None;
        for share in SHARES {
            let said = from.state.plus(share * full, step);
            let h = self.film(&said);
            let sides = Sides::new(&said, &h, self.flow.boundary_film, &self.scales);
            let (state, pulls) = said.within_range();
            let h = if pulls { self.film(&state) } else { h };
            let point = self.point(state, h);
            let is_enough = point.norm < FALL * from.norm;
            if best.as_ref().is_none_or(|(best, _)| point.norm < best.norm) {
                best = Some((point, sides));
            }
            if is_enough {
                break;
            }
        }
        best.expect("a share was tried")
    }

    fn displacement(&mut self, oil: &[f64], solids: &[f64]) -> Vec<f64> {
        self.convolutions += 1;
        let shape = self.operator.grid().shape;
        let total = oil.iter().zip(solids).map(|(p, c)| p + c).collect();
        let total = Field::from_shape_vec(shape, total).expect("a value for each cell");
        let mut displacement = Field::zeros(shape);
        self.operator.apply(&total, &mut displacement);
        displacement.into_raw_vec_and_offset().0
    }

    /// Returns the film thickness under a state.
    pub(super) fn film(&mut self, state: &State) -> Vec<f64> {
        let mut h = self.displacement(&state.oil, &state.solids);
        h.iter_mut().zip(self.gap.iter()).for_each(|(h, gap)| *h += gap - state.approach);
        h
    }

    fn point(&self, state: State, h: Vec<f64>) -> Point {
        let balances = self.flow.balances(&state.oil, &state.cavity, &h);
        let Scales { pressure, flow, film, .. } = self.scales;
        let mut squares = self.missing_load(&state.oil, &state.solids).powi(2);
        for (k, balance) in balances.iter().enumerate() {
            let cavitation = (state.oil[k] / pressure).min(state.cavity[k]);
            let contact = (state.solids[k] / pressure).min((h[k] - self.flow.boundary_film) * film);
            squares += (balance.residual * flow).powi(2) + cavitation * cavitation + contact * contact;
        }
        Point { state, h, balances, norm: squares.sqrt() }
    }

    /// Returns the share of the load that the pressures do not bear; 0 under a prescribed approach.
    fn missing_load(&self, oil: &[f64], solids: &[f64]) -> f64 {
        let Control::Load(load) = self.control else { return 0.0 };
        let [dx, dy] = self.flow.grid.pitch;
        1.0 - dx * dy * oil.iter().zip(solids).map(|(p, c)| p + c).sum::<f64>() / load
    }
}

/// The linear system of a step. Its rows are the balance of each cell, the film of each that touches, and the
/// load; its unknowns the pressure or the cavity fraction of each cell, the pressure of the solids where they
/// touch, and the approach, each over its scale.
struct System<'a> {
    balances: &'a [Balance],
    sides: &'a Sides,
    cells: Neighbours,
    /// The known part of the step: pressures and fractions that become 0.
    known: State,
    /// Share of the load that a unit of pressure in a cell bears; none under a prescribed approach.
    unit_load: Option<f64>,
}

impl<'a> System<'a> {
    /// Returns the system and its right-hand side.
    fn new(newton: &mut Newton<'_>, point: &'a Point, sides: &'a Sides) -> (Self, Vec<f64>) {
        let Point { state, h, balances, .. } = point;
        let count = h.len();
        let to_zero = |values: &[f64], becomes: &dyn Fn(usize) -> bool| -> Vec<f64> {
            values.iter().enumerate().map(|(k, value)| if becomes(k) { -value } else { 0.0 }).collect()
        };
        let known = State {
            oil: to_zero(&state.oil, &|k| sides.empty[k]),
            solids: to_zero(&state.solids, &|k| !sides.touch[k]),
            cavity: to_zero(&state.cavity, &|k| !sides.empty[k]),
            approach: 0.0,
        };
        let displacement = newton.displacement(&known.oil, &known.solids);
        let cells = Neighbours { shape: newton.flow.grid.shape, repeats: newton.flow.repeats };
        let [dx, dy] = newton.flow.grid.pitch;
        let unit_load = match newton.control {
            Control::Load(load) => Some(newton.scales.pressure * dx * dy / load),
            Control::Approach(_) => None,
        };
        let system = Self { balances, sides, cells, known, unit_load };
        let Scales { flow, film, .. } = newton.scales;
        let mut right = vec![0.0; count + sides.contacts.len() + 1];
        system.balance_changes(&system.known, &displacement, &mut right[..count]);
        for (right, balance) in right.iter_mut().zip(balances) {
            *right = -(*right + balance.residual) * flow;
        }
        let boundary_film = newton.flow.boundary_film;
        for (right, &k) in right[count..].iter_mut().zip(&sides.contacts) {
            *right = (boundary_film - h[k] - displacement[k]) * film;
        }
        let there = state.plus(1.0, &system.known);
        right[count + sides.contacts.len()] = newton.missing_load(&there.oil, &there.solids);
        (system, right)
    }

    /// Returns Newton's step.
    fn solve(&self, newton: &mut Newton<'_>, right: Vec<f64>) -> State {
        let near = NearFactor::new(self.cells, self.balances, &newton.near, self.sides, &newton.scales);
        let lifted = self.lifted(&near, &newton.scales);
        let solution = gmres(
            |v| self.product(newton, self.preconditioned(&near, &lifted, v)),
            right,
            REDUCTION,
            MOST_KRYLOV,
        );
        newton.krylov += solution.products;
        let unknowns = self.preconditioned(&near, &lifted, &solution.solution);
        self.step(unknowns, &newton.scales).plus(1.0, &self.known)
    }

    /// Returns what the near matrix answers to a unit of the approach.
    fn lifted(&self, near: &NearFactor, scales: &Scales) -> Vec<f64> {
        let by_approach =
            |balance: &Balance| -balance.by_film.iter().sum::<f64>() * scales.length * scales.flow;
        let contacts = self.sides.contacts.iter().map(|_| -1.0);
        let mut lifted: Vec<f64> = self.balances.iter().map(by_approach).chain(contacts).collect();
        near.solve(&mut lifted);
        lifted
    }

    /// Solves the system with the near matrix, of which the approach and the load are a border.
    fn preconditioned(&self, near: &NearFactor, lifted: &[f64], right: &[f64]) -> Vec<f64> {
        let (last, right) = right.split_last().expect("a load");
        let mut unknowns = right.to_vec();
        near.solve(&mut unknowns);
        let approach = match self.load(&unknowns) {
            Some(load) => (load - last) / self.load(lifted).expect("as before"),
            None => *last,
        };
        unknowns.iter_mut().zip(lifted).for_each(|(unknown, lifted)| *unknown -= approach * lifted);
        unknowns.push(approach);
        unknowns
    }

    /// Returns the product of the matrix with these unknowns.
    fn product(&self, newton: &mut Newton<'_>, unknowns: Vec<f64>) -> Vec<f64> {
        let count = self.balances.len();
        let last = self.load(&unknowns).unwrap_or(unknowns[unknowns.len() - 1]);
        let step = self.step(unknowns, &newton.scales);
        let mut film = newton.displacement(&step.oil, &step.solids);
        film.iter_mut().for_each(|film| *film -= step.approach);
        let mut product = vec![0.0; count];
        self.balance_changes(&step, &film, &mut product);
        product.iter_mut().for_each(|value| *value *= newton.scales.flow);
        product.extend(self.sides.contacts.iter().map(|k| film[*k] * newton.scales.film));
        product.push(last);
        product
    }

    /// Returns the share of the load that these unknowns bear; none under a prescribed approach.
    fn load(&self, unknowns: &[f64]) -> Option<f64> {
        let unit = self.unit_load?;
        let (cells, rest) = unknowns.split_at(self.balances.len());
        let full = cells.iter().zip(&self.sides.empty).filter(|(_, empty)| !**empty);
        let solids: f64 = rest[..self.sides.contacts.len()].iter().sum();
        Some((full.map(|(x, _)| x).sum::<f64>() + solids) * unit)
    }

    /// Returns the unknowns as changes of the state.
    fn step(&self, unknowns: Vec<f64>, scales: &Scales) -> State {
        let count = self.balances.len();
        let mut solids = vec![0.0; count];
        for (k, value) in self.sides.contacts.iter().zip(&unknowns[count..]) {
            solids[*k] = value * scales.pressure;
        }
        let approach = unknowns[unknowns.len() - 1] * scales.length;
        let mut oil = unknowns;
        oil.truncate(count);
        let mut cavity = vec![0.0; count];
        for ((oil, cavity), empty) in oil.iter_mut().zip(&mut cavity).zip(&self.sides.empty) {
            if *empty {
                *cavity = std::mem::take(oil);
            } else {
                *oil *= scales.pressure;
            }
        }
        State { oil, solids, cavity, approach }
    }

    /// Computes the changes of the balances under a step of the state that changes the films.
    fn balance_changes(&self, step: &State, film: &[f64], changes: &mut [f64]) {
        const BAND: usize = 2048;
        let cells = self.cells;
        parallel::map(changes.chunks_mut(BAND).enumerate(), |(band, changes)| {
            for (k, change) in (band * BAND..).zip(changes) {
                let balance = &self.balances[k];
                let mut sum = balance.by_cavity[0] * step.cavity[k];
                for (n, offset) in OFFSETS.into_iter().enumerate() {
                    let (by_pressure, by_film) = (balance.by_pressure[n], balance.by_film[n]);
                    if by_pressure == 0.0 && by_film == 0.0 {
                        continue;
                    }
                    if let Some(other) = cells.cell_at(k, offset) {
                        sum += by_pressure * step.oil[other] + by_film * film[other];
                    }
                }
                if let Some(upstream) = cells.cell_at(k, OFFSETS[UPSTREAM]) {
                    sum += balance.by_cavity[1] * step.cavity[upstream];
                }
                *change = sum;
            }
        });
    }
}
