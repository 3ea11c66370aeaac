//! Potentials of a network under given currents.

use super::faces::Network;
use super::factor::Factor;
use super::multigrid::Multigrid;
use super::ordering::Ordering;

/// Fewest cells that are solved for by multigrid. Below, their elimination takes less time.
pub(super) const FEWEST: usize = 30_000;

/// Most iterations for one network. Beyond, its cells are eliminated: gaps that vary by orders of magnitude from each
/// cell to the next need more.
const MAX_ITERATIONS: usize = 200;

/// A solver for the potentials of some cells of a network.
pub(super) struct Solver<'a> {
    network: &'a Network,
    wanted: &'a [bool],
    periodic: [bool; 2],
    method: Method<'a>,
}

enum Method<'a> {
    Multigrid { levels: Multigrid<'a>, iterations: usize },
    Elimination(Factor),
}

impl<'a> Solver<'a> {
    /// Creates the solver for the cells that are `wanted`.
    pub(super) fn new(network: &'a Network, wanted: &'a [bool], periodic: [bool; 2]) -> Self {
        Self::with_fewest(network, wanted, periodic, FEWEST)
    }

    /// Creates the solver, by multigrid from this number of cells on.
    pub(super) fn with_fewest(
        network: &'a Network,
        wanted: &'a [bool],
        periodic: [bool; 2],
        fewest: usize,
    ) -> Self {
        let cells = wanted.iter().filter(|wanted| **wanted).count();
        let method = if cells < fewest || network.shape.contains(&1) {
            Method::Elimination(eliminated(network, wanted, periodic))
        } else {
            Method::Multigrid { levels: Multigrid::new(network, wanted), iterations: 0 }
        };
        Self { network, wanted, periodic, method }
    }

    /// Returns whether solutions have an error that depends on the tolerance.
    pub(super) fn iterates(&self) -> bool {
        matches!(self.method, Method::Multigrid { .. })
    }

    /// Solves for the potentials under the currents `right` into each cell, in its place. By multigrid, the error is
    /// reduced to the `tolerance` in the norm of energy. Returns false if there are too many iterations.
    pub(super) fn solve(&mut self, right: &mut [f64], tolerance: f64) -> bool {
        match &mut self.method {
            Method::Elimination(factor) => {
                factor.solve(right);
                true
            }
            Method::Multigrid { levels, iterations } => {
                *iterations += levels.solve(right, tolerance, MAX_ITERATIONS - *iterations);
                *iterations < MAX_ITERATIONS
            }
        }
    }

    /// Eliminates the cells for the solutions that follow.
    pub(super) fn eliminate(&mut self) {
        self.method = Method::Elimination(eliminated(self.network, self.wanted, self.periodic));
    }
}

fn eliminated(network: &Network, wanted: &[bool], periodic: [bool; 2]) -> Factor {
    Factor::new(network, Ordering::new(network, wanted, periodic))
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;

    use super::super::components::{AT_END, AT_START, Components, WINDS_X};
    use super::super::faces::{Faces, Topology};
    use super::super::pressure::{self, Solved};
    use super::*;

    /// Numbers from 0 to 1 from a seed.
    fn random(seed: u64) -> impl FnMut() -> f64 {
        let mut state = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1;
        move || {
            state ^= state << 13;
            state ^= state >> 7;
            state ^= state << 17;
            (state >> 11) as f64 / (1u64 << 53) as f64
        }
    }

    /// Solves for the flow along x with the solver from this number of cells on. Returns it with the iterations, `None` if the
    /// cells were eliminated.
    fn flow(gaps: &[f64], shape: [usize; 2], ends: bool, fewest: usize) -> Option<(Solved, Option<usize>)> {
        let topology = Topology { shape, closed: [ends, false], between: ends.then_some(0) };
        let network = Network::new(gaps, [1.0, 1.5], Faces::Linear, topology);
        let mut components = Components::from_network(&network);
        let needed = if ends { AT_START | AT_END } else { WINDS_X };
        let flowing: Vec<bool> =
            (0..gaps.len()).map(|cell| components.marks(cell) & needed == needed).collect();
        let mut solver = Solver::with_fewest(&network, &flowing, [!ends, true], fewest);
        let solved = pressure::solve(&network, &mut solver, 0, &flowing);
        let iterations = match solver.method {
            Method::Multigrid { iterations, .. } => Some(iterations),
            Method::Elimination(_) => None,
        };
        flowing.contains(&true).then_some((solved, iterations))
    }

    /// Compares the flow by multigrid with the one by elimination. Returns the iterations.
    fn compare(gaps: &[f64], shape: [usize; 2], ends: bool) -> Option<usize> {
        let (exact, _) = flow(gaps, shape, ends, usize::MAX)?;
        let (found, iterations) = flow(gaps, shape, ends, 0)?;
        assert_relative_eq!(found.through, exact.through, max_relative = 1e-10);
        assert!(found.sections < 1e-10, "{:e} after {iterations:?}", found.sections);
        let largest = exact.flux.iter().flatten().fold(0.0_f64, |most, flux| most.max(flux.abs()));
        for (found, exact) in found.flux.iter().flatten().zip(exact.flux.iter().flatten()) {
            assert!((found - exact).abs() < 1e-7 * largest, "{found:e} {exact:e} of {largest:e}");
        }
        iterations
    }

    #[test]
    fn multigrid_agrees_with_elimination_on_scattered_gaps() {
        let mut iterated = 0;
        for seed in 0..40 {
            let mut random = random(seed + 1);
            let shape = [2 + (random() * 60.0) as usize, 2 + (random() * 60.0) as usize];
            let (contact, decades) = (0.4 * random(), 6.0 * random());
            let gaps: Vec<f64> = (0..shape[0] * shape[1])
                .map(|_| if random() < contact { 0.0 } else { 10f64.powf(-decades * random()) })
                .collect();
            for ends in [false, true] {
                iterated += usize::from(compare(&gaps, shape, ends).is_some());
            }
        }
        assert!(iterated > 40, "{iterated}");
    }

    #[test]
    fn multigrid_agrees_with_elimination_on_channels_a_cell_wide() {
        // A serpentine between walls, open at alternating ends.
        let (shape, mut random) = ([61, 40], random(3));
        let gaps: Vec<f64> = (0..61 * 40)
            .map(|cell| (cell / 40, cell % 40))
            .map(|(i, j)| {
                let passage = if i % 4 == 1 { 0 } else { 37 };
                if j < 38 && (i % 2 == 0 || j == passage) { 0.1 + random() } else { 0.0 }
            })
            .collect();
        for ends in [false, true] {
            assert!(compare(&gaps, shape, ends).is_some());
        }
    }

    #[test]
    fn multigrid_agrees_with_elimination_on_halls_joined_by_pinholes() {
        for pinhole in [1e-2, 1e-4, 1e-6] {
            let gaps: Vec<f64> = (0..96 * 64)
                .map(|cell| (cell / 64, cell % 64))
                .map(|(i, j)| match (i % 24, j) {
                    (5, 17) => pinhole,
                    (5, _) => 0.0,
                    _ => 1.0 + 0.3 * ((i * j) as f64).sin(),
                })
                .collect();
            for ends in [false, true] {
                compare(&gaps, [96, 64], ends);
            }
        }
    }

    #[test]
    fn iterations_do_not_grow_with_the_grid() {
        let iterations = [64, 128, 256].map(|n| {
            let wave = |k: f64, x: usize| (std::f64::consts::TAU * k * x as f64 / n as f64).sin();
            let gaps: Vec<f64> = (0..n * n)
                .map(|cell| (cell / n, cell % n))
                .map(|(i, j)| (0.55 + wave(3.0, i) * wave(2.0, j) + 0.3 * wave(5.0, i + 2 * j)).max(0.0))
                .collect();
            let (solved, iterations) = flow(&gaps, [n, n], true, 0).expect("a path");
            assert!(solved.through > 0.0 && solved.sections < 1e-10);
            iterations.expect("no elimination")
        });
        assert!(iterations.iter().all(|iterations| *iterations < 50), "{iterations:?}");
    }
}
