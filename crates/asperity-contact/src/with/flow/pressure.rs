//! Pressures as the sum of two doubles, and the fluxes that follow from them.
//!
//! Where channels are wide, the pressure differs little from cell to cell, and its round-off times a large
//! transmissibility is more than what flows through the next constriction. So the pressure is P₁ + P₂. P₁ is
//! a multiple of a power of 2, so that the drops between cells follow from it without round-off. The
//! imbalance of the fluxes is summed cell by cell, and P₂ solves for it.

use super::faces::{Network, end_cells};
use super::solver::Solver;

/// Fewest and most rounds of solving for what is left, with the cells eliminated.
const ELIMINATED: [usize; 2] = [2, 16];

/// Fewest and most rounds of a solver that iterates.
const ITERATED: [usize; 2] = [1, 6];

/// Difference between sections at which no further round is made, with the cells eliminated.
const ENOUGH: f64 = 4e-15;

/// Difference between sections above which rounds go on, though one of them may not have helped. A solver that iterates does
/// not go on below.
const TOO_MUCH: f64 = 1e-11;

/// Least tolerance of a solver that iterates. Without reservoirs, the round-off in the sum of the currents is never balanced.
const LEAST_TOLERANCE: f64 = 1e-13;

/// Tolerance of the first round between reservoirs. A second round is seldom needed.
const BETWEEN_RESERVOIRS: f64 = 3e-15;

/// Flow along an axis, for a drop of 1 between neighbouring cells of a periodic axis, or of 1 between
/// reservoirs.
pub(super) struct Solved {
    /// The axis along which the pressure falls.
    pub(super) axis: usize,
    /// Pressure without its mean fall along a periodic axis.
    pub(super) pressure: Vec<f64>,
    /// Flux through the face before each cell along x and y.
    pub(super) flux: [Vec<f64>; 2],
    /// Flux into the first and out of the last cells, between reservoirs.
    pub(super) ends: [Vec<f64>; 2],
    /// Flux through a section across the axis, the mean of all sections.
    pub(super) through: f64,
    /// Largest difference of a section from it, relative.
    pub(super) sections: f64,
    /// Largest imbalance of a cell over the largest flux of a face.
    pub(super) imbalance: f64,
    /// Rounds of solving.
    pub(super) rounds: usize,
}

/// Pressure of one direction: two doubles, and what drives it.
struct State<'a> {
    axis: usize,
    flowing: &'a [bool],
    coarse: Vec<f64>,
    fine: Vec<f64>,
}

/// Solves for the flow along an axis, of the cells that flow along it.
///
/// Cells are eliminated if a solver that iterates does not reach enough.
pub(super) fn solve(network: &Network, solver: &mut Solver<'_>, axis: usize, flowing: &[bool]) -> Solved {
    let mut solved = solve_in_rounds(network, solver, axis, flowing);
    if solver.iterates() && solved.sections > TOO_MUCH {
        solver.eliminate();
        solved = solve_in_rounds(network, solver, axis, flowing);
    }
    solved
}

fn solve_in_rounds(network: &Network, solver: &mut Solver<'_>, axis: usize, flowing: &[bool]) -> Solved {
    let cells = network.cells();
    let mut state = State { axis, flowing, coarse: vec![0.0; cells], fine: vec![0.0; cells] };
    let (_, mut right) = state.fluxes(network, 0);
    let [least, most] = if solver.iterates() { ITERATED } else { ELIMINATED };
    let enough = if solver.iterates() { TOO_MUCH } else { ENOUGH };
    let mut tolerance = if network.ends.is_some() { BETWEEN_RESERVOIRS } else { LEAST_TOLERANCE };
    let mut best: Option<Solved> = None;
    for round in 1..=most {
        if !solver.solve(&mut right, tolerance) {
            break;
        }
        state.add(&right);
        drop(right);
        let (solved, imbalance) = state.fluxes(network, round);
        let sections = solved.sections;
        let before = best.as_ref().map_or(f64::INFINITY, |best| best.sections);
        let better = round < 2 || sections < 0.5 * before;
        if better {
            best = Some(solved);
        }
        let reached = if better { sections } else { before };
        if round >= least && (reached <= enough || (!better && reached < TOO_MUCH)) {
            break;
        }
        tolerance = (0.1 * enough / sections).max(LEAST_TOLERANCE);
        right = imbalance;
    }
    best.unwrap_or_else(|| state.fluxes(network, 0).0)
}

impl State<'_> {
    /// Adds a correction and divides the sum into its two parts anew.
    fn add(&mut self, correction: &[f64]) {
        let largest =
            self.coarse.iter().zip(correction).fold(1.0_f64, |most, (p, c)| most.max((p + c).abs()));
        // Adding and subtracting this rounds to multiples of its last binary digit.
        let round = 3.0 * 2.0_f64.powi(largest.log2().ceil() as i32);
        for ((coarse, fine), correction) in self.coarse.iter_mut().zip(&mut self.fine).zip(correction) {
            let [sum, rest] = two_sum(*coarse, *correction);
            let new = (sum + round) - round;
            *fine += (sum - new) + rest;
            *coarse = new;
        }
    }

    /// Computes the fluxes, and the imbalance of each cell.
    fn fluxes(&self, network: &Network, rounds: usize) -> (Solved, Vec<f64>) {
        let (cells, axis) = (network.cells(), self.axis);
        let (coarse, fine) = (&self.coarse, &self.fine);
        let mut flux = [vec![0.0; cells], vec![0.0; cells]];
        let mut ends = [Vec::new(), Vec::new()];
        let mut imbalance = vec![0.0; cells];
        for (direction, flux) in flux.iter_mut().enumerate() {
            let drive = if direction == axis && network.ends.is_none() { 1.0 } else { 0.0 };
            for (cell, &face) in network.faces[direction].iter().enumerate() {
                if face > 0.0 && self.flowing[cell] {
                    let (before, _) = network.before(cell, direction);
                    let drop = ((coarse[before] - coarse[cell]) + drive) + (fine[before] - fine[cell]);
                    let through = face * drop;
                    flux[cell] = through;
                    imbalance[before] -= through;
                    imbalance[cell] += through;
                }
            }
        }
        if let Some(reservoirs) = &network.ends {
            for (end, transmissibility) in reservoirs.transmissibility.iter().enumerate() {
                let index = if end == 0 { 0 } else { network.shape[axis] - 1 };
                for (cell, transmissibility) in end_cells(network.shape, axis, index).zip(transmissibility) {
                    let drop =
                        if end == 0 { (1.0 - coarse[cell]) - fine[cell] } else { coarse[cell] + fine[cell] };
                    let through = if self.flowing[cell] { transmissibility * drop } else { 0.0 };
                    ends[end].push(through);
                    imbalance[cell] += if end == 0 { through } else { -through };
                }
            }
        }
        let mut sections = sections(network.shape, axis, &flux[axis]);
        if network.ends.is_some() {
            sections[0] = ends[0].iter().sum();
            sections.push(ends[1].iter().sum());
        }
        let through = sections.iter().sum::<f64>() / sections.len() as f64;
        let apart = sections.iter().fold(0.0_f64, |most, section| most.max((section - through).abs()));
        let most = |values: &[f64]| values.iter().fold(0.0_f64, |most, value| most.max(value.abs()));
        let largest =
            [&flux[0], &flux[1], &ends[0], &ends[1]].into_iter().fold(0.0_f64, |m, f| m.max(most(f)));
        let solved = Solved {
            axis,
            pressure: coarse.iter().zip(fine).map(|(coarse, fine)| coarse + fine).collect(),
            through,
            sections: match through > 0.0 {
                true => apart / through,
                // Where something flows, it flows down the gradient.
                false if self.flowing.contains(&true) => f64::INFINITY,
                false => 0.0,
            },
            imbalance: if largest > 0.0 { most(&imbalance) / largest } else { 0.0 },
            flux,
            ends,
            rounds,
        };
        (solved, imbalance)
    }
}

impl Solved {
    /// Returns a lower and an upper bound for the permeability of the `other` network over that of this one.
    ///
    /// The fluxes found are a trial field of Thomson's principle for the other network, which bounds it from
    /// below, and the pressure found is one of Dirichlet's principle, which bounds it from above.
    pub(super) fn bounds(&self, network: &Network, other: &Network) -> [f64; 2] {
        let (mut work, mut least, mut most) = (0.0, 0.0, 0.0);
        let mut add = |flux: &[f64], own: &[f64], other: &[f64]| {
            for ((q, own), other) in flux.iter().zip(own).zip(other).filter(|((q, _), _)| **q != 0.0) {
                let dissipated = q / own * q;
                work += dissipated;
                least += dissipated * (own / other);
                most += dissipated * (other / own);
            }
        };
        for axis in 0..2 {
            add(&self.flux[axis], &network.faces[axis], &other.faces[axis]);
        }
        if let (Some(own), Some(other)) = (&network.ends, &other.ends) {
            for end in 0..2 {
                add(&self.ends[end], &own.transmissibility[end], &other.transmissibility[end]);
            }
        }
        if work > 0.0 { [work / least, most / work] } else { [1.0; 2] }
    }

    /// Returns Σ q q′/T over all faces: the work of the fluxes on the pressure drops of `other`.
    pub(super) fn work(&self, other: &Self, network: &Network) -> f64 {
        let mut sum = 0.0;
        let mut add = |transmissibility: &[f64], a: &[f64], b: &[f64]| {
            sum += transmissibility
                .iter()
                .zip(a.iter().zip(b))
                .filter(|(t, _)| **t > 0.0)
                .map(|(t, (a, b))| a / t * b)
                .sum::<f64>();
        };
        for ((transmissibility, a), b) in network.faces.iter().zip(&self.flux).zip(&other.flux) {
            add(transmissibility, a, b);
        }
        if let Some(reservoirs) = &network.ends {
            for ((transmissibility, a), b) in
                reservoirs.transmissibility.iter().zip(&self.ends).zip(&other.ends)
            {
                add(transmissibility, a, b);
            }
        }
        sum
    }
}

/// Sums of the fluxes through the faces before each row across `axis`.
fn sections([nx, ny]: [usize; 2], axis: usize, flux: &[f64]) -> Vec<f64> {
    if axis == 0 {
        return flux.chunks_exact(ny).map(|row| row.iter().sum()).collect();
    }
    let mut sums = vec![0.0; ny];
    for i in 0..nx {
        sums.iter_mut().zip(&flux[i * ny..]).for_each(|(sum, q)| *sum += q);
    }
    sums
}

/// The sum of two numbers and what is lost of it.
fn two_sum(a: f64, b: f64) -> [f64; 2] {
    let sum = a + b;
    let other = sum - a;
    [sum, (a - (sum - other)) + (b - other)]
}
