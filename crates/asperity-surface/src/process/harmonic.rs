//! Laplace's equation over the holes of a topography, by conjugate gradients preconditioned with multigrid.

use asperity_base::grid::{Field, Grid};
use asperity_base::units::Metre;

/// Relative residual at convergence.
const TOLERANCE: f64 = 1e-12;
/// Largest number of iterations; a disc of two million samples needs 35.
const MAX_ITERATIONS: usize = 200;

/// Replaces the undefined heights by the discrete harmonic surface through the defined ones.
///
/// The five-point equation is Σ g (z − z') = 0 over the neighbours z', with g = Δy/Δx along x and Δx/Δy along
/// y. Neighbours beyond the grid are left out, so that the surface has zero slope at its boundary.
///
/// # Panics
/// If no height is defined.
pub(super) fn harmonic(grid: &Grid, z: &mut Field) {
    let (known, count) = z.iter().filter(|z| !z.is_nan()).fold((0.0, 0usize), |(s, n), z| (s + z, n + 1));
    assert!(count > 0, "a membrane needs a frame");
    let mean = known / count as f64;
    let cells: Vec<[usize; 2]> =
        z.indexed_iter().filter(|(_, z)| z.is_nan()).map(|((ix, iy), _)| [ix, iy]).collect();
    let (network, sources) = Network::of_holes(grid, z, mean, &cells);
    let (membrane, _) = Multigrid::new(network, grid).solve(&sources);
    for ([ix, iy], height) in cells.into_iter().zip(membrane) {
        z[[ix, iy]] = mean + height;
    }
}

/// A graph of nodes with up to four neighbours, connected by couplings, some of them to ground.
///
/// Its matrix A has ground + couplings on the diagonal and −couplings off it. It is symmetric, and positive
/// definite if every part has a connection to ground.
struct Network {
    /// Coupling from each node to ground.
    ground: Vec<f64>,
    /// Neighbours at −x, +x, −y, +y; the node itself, with zero coupling, if there is none.
    neighbours: Vec<[u32; 4]>,
    couplings: Vec<[f64; 4]>,
    /// Position on the grid of this network.
    cells: Vec<[usize; 2]>,
}

impl Network {
    /// Creates the network with undefined samples as nodes and defined ones as ground; also returns the
    /// currents from ground.
    fn of_holes(grid: &Grid, z: &Field, mean: f64, cells: &[[usize; 2]]) -> (Self, Vec<f64>) {
        let number = numbering(cells, grid.shape);
        let ratio = grid.pitch[1] / grid.pitch[0];
        let mut network = Self::unlinked(cells.to_vec());
        let mut sources = vec![0.0; cells.len()];
        for (node, &[ix, iy]) in cells.iter().enumerate() {
            let around = [
                (ix > 0).then(|| [ix - 1, iy]),
                (ix + 1 < grid.shape[0]).then(|| [ix + 1, iy]),
                (iy > 0).then(|| [ix, iy - 1]),
                (iy + 1 < grid.shape[1]).then(|| [ix, iy + 1]),
            ];
            for (side, neighbour) in around.into_iter().enumerate() {
                let Some(neighbour) = neighbour else { continue };
                let coupling = if side < 2 { ratio } else { 1.0 / ratio };
                if z[neighbour].is_nan() {
                    network.neighbours[node][side] = number[neighbour[0] * grid.shape[1] + neighbour[1]];
                    network.couplings[node][side] = coupling;
                } else {
                    network.ground[node] += coupling;
                    sources[node] += coupling * (z[neighbour] - mean);
                }
            }
        }
        (network, sources)
    }

    fn unlinked(cells: Vec<[usize; 2]>) -> Self {
        Self {
            ground: vec![0.0; cells.len()],
            neighbours: (0..cells.len()).map(|node| [node as u32; 4]).collect(),
            couplings: vec![[0.0; 4]; cells.len()],
            cells,
        }
    }

    /// Creates the coarse network, joining `block` nodes, 1 or 2, in each direction; also returns the coarse
    /// node of each node. `shape` is that of the grid of this network.
    ///
    /// The equation of a coarse node is the sum of those of its nodes (Galerkin, constant prolongation). This
    /// makes smooth modes twice too stiff along a joined direction, hence the factor one half. Braess,
    /// Computing 55, 379 (1995).
    fn joined(&self, shape: [usize; 2], block: [usize; 2]) -> (Self, Vec<u32>) {
        let coarse = [shape[0].div_ceil(block[0]), shape[1].div_ceil(block[1])];
        let mut number = vec![NOWHERE; coarse[0] * coarse[1]];
        let mut cells = Vec::new();
        let joint: Vec<u32> = self
            .cells
            .iter()
            .map(|&[ix, iy]| {
                let cell = [ix / block[0], iy / block[1]];
                let entry = &mut number[cell[0] * coarse[1] + cell[1]];
                if *entry == NOWHERE {
                    *entry = cells.len() as u32;
                    cells.push(cell);
                }
                *entry
            })
            .collect();
        let mut network = Self::unlinked(cells);
        for (node, &own) in joint.iter().enumerate() {
            network.ground[own as usize] += 0.5 * self.ground[node];
            for side in 0..4 {
                let other = joint[self.neighbours[node][side] as usize];
                if other != own {
                    network.neighbours[own as usize][side] = other;
                    network.couplings[own as usize][side] +=
                        self.couplings[node][side] / block[side / 2] as f64;
                }
            }
        }
        (network, joint)
    }

    /// Diagonal of the matrix.
    fn diagonal(&self) -> Vec<f64> {
        self.ground
            .iter()
            .zip(&self.couplings)
            .map(|(ground, links)| ground + links.iter().sum::<f64>())
            .collect()
    }

    /// Current into `node` from its neighbours.
    fn inflow(&self, node: usize, x: &[f64]) -> f64 {
        let [a, b, c, d] = self.neighbours[node].map(|neighbour| x[neighbour as usize]);
        let [ga, gb, gc, gd] = self.couplings[node];
        (ga * a + gb * b) + (gc * c + gd * d)
    }
}

/// Number of a cell that is not a node.
const NOWHERE: u32 = u32::MAX;

/// Returns for each cell of the grid its index in `cells`.
fn numbering(cells: &[[usize; 2]], shape: [usize; 2]) -> Vec<u32> {
    assert!(cells.len() < NOWHERE as usize, "a hole of more than four thousand million samples");
    let mut number = vec![NOWHERE; shape[0] * shape[1]];
    for (node, [ix, iy]) in cells.iter().enumerate() {
        number[ix * shape[1] + iy] = node as u32;
    }
    number
}

/// A network and its coarser ones, down to a single node.
struct Multigrid {
    tiers: Vec<Tier>,
}

/// A level of the multigrid.
struct Tier {
    network: Network,
    diagonal: Vec<f64>,
    inverse_diagonal: Vec<f64>,
    /// Node of the next level for each node; empty on the last.
    joint: Vec<u32>,
}

impl Tier {
    fn new(network: Network, joint: Vec<u32>) -> Self {
        let diagonal = network.diagonal();
        let inverse_diagonal = diagonal.iter().map(|d| d.recip()).collect();
        Self { network, diagonal, inverse_diagonal, joint }
    }

    /// (A x) at `node`.
    fn apply(&self, node: usize, x: &[f64]) -> f64 {
        self.diagonal[node] * x[node] - self.network.inflow(node, x)
    }

    /// One Gauss–Seidel step at `node`.
    fn relax(&self, node: usize, x: &mut [f64], right: &[f64]) {
        x[node] = (right[node] + self.network.inflow(node, x)) * self.inverse_diagonal[node];
    }
}

impl Multigrid {
    /// Joins in both directions, but only along the smaller pitch until both pitches are similar.
    fn new(finest: Network, grid: &Grid) -> Self {
        let (mut shape, mut pitch, mut network) = (grid.shape, grid.pitch, finest);
        let mut tiers = Vec::new();
        while shape != [1, 1] {
            let block = block(shape, pitch);
            let (coarser, joint) = network.joined(shape, block);
            tiers.push(Tier::new(network, joint));
            network = coarser;
            for axis in 0..2 {
                shape[axis] = shape[axis].div_ceil(block[axis]);
                pitch[axis] *= block[axis] as f64;
            }
        }
        tiers.push(Tier::new(network, Vec::new()));
        Self { tiers }
    }

    /// Computes the potentials for the currents `sources` into the nodes of the finest network; also returns
    /// the number of iterations.
    fn solve(&self, sources: &[f64]) -> (Vec<f64>, usize) {
        let tier = &self.tiers[0];
        let mut x = vec![0.0; sources.len()];
        let mut residual = sources.to_vec();
        let mut corrected = self.cycle(0, &residual);
        let mut direction = corrected.clone();
        let mut product = dot(&residual, &corrected);
        let end = TOLERANCE * TOLERANCE * product;
        let mut iterations = 0;
        while product > end && iterations < MAX_ITERATIONS {
            iterations += 1;
            let applied: Vec<f64> = (0..x.len()).map(|node| tier.apply(node, &direction)).collect();
            let step = product / dot(&direction, &applied);
            for node in 0..x.len() {
                x[node] += step * direction[node];
                residual[node] -= step * applied[node];
            }
            corrected = self.cycle(0, &residual);
            let next = dot(&residual, &corrected);
            let ratio = next / product;
            product = next;
            direction.iter_mut().zip(&corrected).for_each(|(d, c)| *d = c + ratio * *d);
        }
        (x, iterations)
    }

    /// Applies an approximate A⁻¹ to `right` on level `depth`, symmetrically: forward Gauss–Seidel, the
    /// coarser levels, backward Gauss–Seidel.
    fn cycle(&self, depth: usize, right: &[f64]) -> Vec<f64> {
        let tier = &self.tiers[depth];
        let nodes = right.len();
        let mut x = vec![0.0; nodes];
        (0..nodes).for_each(|node| tier.relax(node, &mut x, right));
        if let Some(coarser) = self.tiers.get(depth + 1) {
            let mut residual = vec![0.0; coarser.diagonal.len()];
            for (node, &joint) in tier.joint.iter().enumerate() {
                residual[joint as usize] += right[node] - tier.apply(node, &x);
            }
            let correction = self.cycle(depth + 1, &residual);
            x.iter_mut().zip(&tier.joint).for_each(|(x, &joint)| *x += correction[joint as usize]);
            (0..nodes).rev().for_each(|node| tier.relax(node, &mut x, right));
        }
        x
    }
}

/// Returns the number of nodes to join along each direction: 2 along the smaller pitch, and along the other
/// if its pitch is less than twice as large.
fn block(shape: [usize; 2], pitch: [Metre; 2]) -> [usize; 2] {
    std::array::from_fn(|axis| {
        let other = 1 - axis;
        let alike = pitch[axis] < 2.0 * pitch[other] || shape[other] == 1;
        if shape[axis] > 1 && alike { 2 } else { 1 }
    })
}

fn dot(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_cost_hardly_grows_with_the_hole_or_the_ratio_of_the_pitches() {
        for (n, pitch, limit) in
            [(64, [1.0, 1.0], 30), (256, [1.0, 1.0], 30), (256, [1.0, 10.0], 45), (256, [3.0, 1.0], 40)]
        {
            let grid = Grid::new([n, n], pitch).unwrap();
            let from_centre =
                |i: usize, j: usize| (i as f64 / n as f64 - 0.5).hypot(j as f64 / n as f64 - 0.5);
            let z = Field::from_shape_fn([n, n], |(i, j)| {
                if from_centre(i, j) < 0.4 { f64::NAN } else { ((i * i + 3 * j) as f64).sin() }
            });
            let cells: Vec<_> =
                z.indexed_iter().filter(|(_, z)| z.is_nan()).map(|((i, j), _)| [i, j]).collect();
            let (network, sources) = Network::of_holes(&grid, &z, 0.0, &cells);
            let (_, iterations) = Multigrid::new(network, &grid).solve(&sources);
            assert!(iterations <= limit, "{iterations} iterations for {n}² samples, pitch {pitch:?}");
        }
    }
}
