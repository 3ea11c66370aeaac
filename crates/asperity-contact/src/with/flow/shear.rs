//! Sliding surfaces carry fluid through their gap, and shear it: factors of mean equations of lubrication.
//!
//! A rough surface slides with U over a smooth one, without a mean gradient of pressure. In its frame the gap stands still,
//! and the pressure is p = 6ηU ψ with
//!
//! ```text
//! ∇·(g³ ∇ψ) = −∂g/∂x          mean flux per width = U (ḡ + Φ)/2
//! ```
//!
//! Φ is what the valleys carry besides the mean gap. A pocket that contact closes moves with the rough surface. All
//! roughness on the surface at rest gives −Φ; of two rough surfaces Φ takes part by the difference of the mean squares of
//! their heights over the sum. Patir & Cheng, J. Lubr. Technol. 101, 220 (1979).

use super::faces::{Faces, Network, Topology};
use super::solver::Solver;
use crate::grid::{Field, Grid, flat, in_rows};
use crate::units::Metre;

/// The shear of a rough surface that slides over a smooth one along an axis, under a gap that repeats along both axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ShearFlow {
    /// Additional film Φ that is carried. Over the rms height it is the shear flow factor.
    pub carried: Metre,
    /// Mean of the shear that the pressure adds to either surface, over η U/ḡ: the shear stress factor φ_fs.
    pub stress_factor: f64,
}

/// Rounds of solving for what is left of the imbalance.
const ROUNDS: usize = 3;

/// Tolerance of each round, if the solver iterates.
const TOLERANCE: f64 = 1e-6;

/// Solves for the shear along x and along y. Cells whose gap is not positive are closed. The answer is 0 without open
/// cells.
///
/// # Panics
/// If the gap has another shape than the grid.
pub fn shear_flow(gap: &Field, grid: &Grid, faces: Faces) -> [ShearFlow; 2] {
    assert_eq!(gap.dim(), (grid.shape[0], grid.shape[1]), "shape of the gap");
    let gap = in_rows(gap);
    let largest = gap.iter().copied().fold(0.0, f64::max);
    if largest <= 0.0 {
        return [ShearFlow { carried: 0.0, stress_factor: 0.0 }; 2];
    }
    let gaps: Vec<f64> = flat(&gap).iter().map(|gap| (gap / largest).max(0.0)).collect();
    let mean = gaps.iter().sum::<f64>() / gaps.len() as f64;
    let topology = Topology { shape: grid.shape, closed: [false; 2], between: None };
    let network = Network::new(&gaps, grid.pitch, faces, topology);
    let open: Vec<bool> = gaps.iter().map(|gap| *gap > 0.0).collect();
    let mut solver = Solver::new(&network, &open, [true; 2]);
    // Gap and permeability of a face are those of one gap.
    let width = [grid.pitch[1], grid.pitch[0]];
    let ratio = [0, 1].map(|axis| width[axis] / grid.pitch[axis]);
    let face_gap = |axis: usize, cell: usize| (network.faces[axis][cell] / ratio[axis]).cbrt();
    [0, 1].map(|axis| {
        let mut potential = vec![0.0; gaps.len()];
        let mut round = 0;
        while round < ROUNDS {
            let mut right = vec![0.0; gaps.len()];
            for (direction, faces) in network.faces.iter().enumerate() {
                for (cell, transmissibility) in faces.iter().enumerate() {
                    let (before, _) = network.before(cell, direction);
                    let driven = if direction == axis { face_gap(axis, cell) * width[axis] } else { 0.0 };
                    let through = transmissibility * (potential[before] - potential[cell]) - driven;
                    right[cell] += through;
                    right[before] -= through;
                }
            }
            if solver.solve(&mut right, TOLERANCE) {
                potential.iter_mut().zip(right).for_each(|(potential, more)| *potential += more);
                round += 1;
            } else {
                // From the start: what is left of the currents has lost digits.
                solver.eliminate();
                potential.fill(0.0);
                round = 0;
            }
        }
        let (mut carried, mut stress) = (0.0, 0.0);
        for (cell, transmissibility) in network.faces[axis].iter().enumerate() {
            let (before, _) = network.before(cell, axis);
            let rise = potential[cell] - potential[before];
            let gap = face_gap(axis, cell);
            carried -= gap + transmissibility * rise / width[axis];
            stress -= gap * rise / grid.pitch[axis];
        }
        let cells = gaps.len() as f64;
        ShearFlow { carried: largest * (mean + carried / cells), stress_factor: 3.0 * mean * stress / cells }
    })
}

/// Returns the shear stress factor φ_f of surfaces that slide without a pressure, ḡ ⟨1/g⟩ over cells with a film of at least
/// `least` > 0: below it a film has no viscous stress of its own, and the mean would have no bound at the edges of contact.
pub fn sliding_stress_factor(gap: &Field, least: Metre) -> f64 {
    let cells = gap.len() as f64;
    let mean = gap.iter().map(|gap| gap.max(0.0)).sum::<f64>() / cells;
    mean * gap.iter().filter(|gap| **gap >= least).map(|gap| gap.recip()).sum::<f64>() / cells
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use approx::assert_relative_eq;

    use super::*;

    /// Ridges across the motion: g³ψ′ = c − g with c = ⟨g⁻²⟩/⟨g⁻³⟩, so that Φ = ḡ − c. Order 2; nothing along the ridges.
    #[test]
    fn ridges_carry_what_the_integral_says() {
        let amplitude = 0.6e-6;
        let gap = |n: usize, i: usize| 1e-6 + amplitude * (TAU * (i as f64 + 0.5) / n as f64).cos();
        let mean = |power: i32| (0..4096).map(|i| gap(4096, i).powi(power)).sum::<f64>() / 4096.0;
        let (c, slope) = (mean(-2) / mean(-3), 3.0 * 1e-6 * (mean(-1) - mean(-2) * mean(-2) / mean(-3)));
        let off = [32, 64].map(|n| {
            let grid = Grid::new([n, 4], [2e-6, 3e-6]).unwrap();
            let field = Field::from_shape_fn(grid.shape, |(i, _)| gap(n, i));
            let [x, y] = shear_flow(&field, &grid, Faces::default());
            assert!(y.carried.abs() < 1e-12 * 1e-6 && y.stress_factor.abs() < 1e-12);
            [x.carried / (1e-6 - c) - 1.0, x.stress_factor / slope - 1.0]
        });
        for n in 0..2 {
            assert!(off[1][n].abs() < 0.01, "{off:?}");
            assert!(off[0][n].abs() > 3.0 * off[1][n].abs(), "{off:?}");
        }
    }

    /// A surface that carries all of its fluid in closed pockets: Φ = ḡ.
    #[test]
    fn closed_pockets_move_with_their_surface() {
        let grid = Grid::new([16, 16], [1e-6; 2]).unwrap();
        let gap = Field::from_shape_fn(grid.shape, |(i, j)| {
            let inside = |k: usize| (k % 8) > 1;
            if inside(i) && inside(j) { 1e-7 * (1.0 + (i * j % 5) as f64) } else { 0.0 }
        });
        for shear in shear_flow(&gap, &grid, Faces::default()) {
            assert_relative_eq!(shear.carried, gap.mean().unwrap(), max_relative = 1e-10);
        }
        let nothing = shear_flow(&grid.zeros(), &grid, Faces::default());
        assert_eq!(nothing[0].carried, 0.0);
    }

    /// Cells in which a smooth wall moves, solved as what they are: a moving wall and the sum of all fluxes by a dense
    /// solution.
    #[test]
    fn a_rough_gap_carries_what_a_dense_solution_does() {
        let n = 7;
        let grid = Grid::new([n, n], [1e-6, 1.5e-6]).unwrap();
        let gap = Field::from_shape_fn(grid.shape, |(i, j)| match (3 * i + 5 * j) % 7 {
            0 => 0.0,
            k => 1e-8 * k as f64,
        });
        let at = |cell: usize| gap[(cell / n, cell % n)];
        let next = |cell: usize, axis: usize| {
            if axis == 0 { (cell + n) % (n * n) } else { cell / n * n + (cell % n + 1) % n }
        };
        let [mut matrix, mut right] = [Field::eye(n * n) * 1e-30, Field::zeros([n * n, 1])];
        let k = |a: usize, b: usize| Faces::default().mean(at(a), at(b));
        for axis in 0..2 {
            let (w, d) = (grid.pitch[1 - axis], grid.pitch[axis]);
            for a in 0..n * n {
                let b = next(a, axis);
                let t = k(a, b) * w / d;
                matrix[(a, a)] += t;
                matrix[(b, b)] += t;
                matrix[(a, b)] -= t;
                matrix[(b, a)] -= t;
                if axis == 0 {
                    right[(a, 0)] += k(a, b).cbrt() * w;
                    right[(b, 0)] -= k(a, b).cbrt() * w;
                }
            }
        }
        let scale = matrix.iter().copied().fold(0.0, f64::max);
        (0..n * n).for_each(|cell| matrix[(cell, cell)] += 1e-11 * scale);
        let potential = crate::math::Cholesky::new(matrix).unwrap().solve(&right.column(0).to_vec());
        let flux = |a: usize| {
            let b = next(a, 0);
            k(a, b).cbrt() + k(a, b) * (potential[b] - potential[a]) / grid.pitch[0]
        };
        let relative = (0..n * n).map(flux).sum::<f64>() / (n * n) as f64;
        let expected = gap.mean().unwrap() - relative;
        let found = shear_flow(&gap, &grid, Faces::default())[0].carried;
        assert_relative_eq!(found, expected, max_relative = 1e-6);
    }

    /// A rough wall moves over cells at rest. Its motion and the change of the gap cause a new pressure at each time. The mean
    /// flux over time through a section at rest is U (ḡ + Φ)/2, to second order.
    #[test]
    fn a_moving_wall_carries_as_much_through_a_section_at_rest() {
        let gap = |x: f64, y: f64| {
            1.0 + 0.35 * (TAU * x).cos() * (TAU * y).cos() + 0.25 * (TAU * (2.0 * x + y) + 1.0).cos()
        };
        let off = [16, 32].map(|n| {
            let field = Field::from_shape_fn([n, n], |(i, j)| {
                gap((i as f64 + 0.5) / n as f64, (j as f64 + 0.5) / n as f64)
            });
            let grid = Grid::new([n, n], [1.0 / n as f64; 2]).unwrap();
            let found = shear_flow(&field, &grid, Faces::default())[0].carried;
            let times = 24;
            let flux = (0..times)
                .map(|k| flux_at_rest(n, &|x, y| gap(x - f64::from(k) / f64::from(times), y)))
                .sum::<f64>();
            let expected = 2.0 * flux / f64::from(times) - field.mean().unwrap();
            found / expected - 1.0
        });
        assert!(off[1].abs() < 0.02 && off[0].abs() > 3.0 * off[1].abs(), "{off:?}");
    }

    /// Mean flux along x through the section x = 0 of n × n cells of unit length, while `gap` moves along x with unit speed
    /// and the other wall rests, at unit viscosity. The pressure is found by conjugate gradients.
    fn flux_at_rest(n: usize, gap: &dyn Fn(f64, f64) -> f64) -> f64 {
        let d = 1.0 / n as f64;
        let at = |i: f64, j: f64| gap(i * d, j * d);
        let cells = || (0..n).flat_map(|i| (0..n).map(move |j| (i, j)));
        // Conductance of the faces before a cell along x and along y.
        let face = |i: usize, j: usize| {
            let (i, j) = (i as f64, j as f64);
            [at(i, j + 0.5), at(i + 0.5, j)].map(|gap| gap.powi(3) / 12.0)
        };
        let apply = |p: &Field| {
            let mut sum = Field::zeros([n, n]);
            for (i, j) in cells() {
                let before = [((i + n - 1) % n, j), (i, (j + n - 1) % n)];
                for (conductance, before) in face(i, j).into_iter().zip(before) {
                    let through = conductance * (p[(i, j)] - p[before]);
                    sum[(i, j)] += through;
                    sum[before] -= through;
                }
            }
            sum
        };
        // The walls bring fluid into a cell, and its rising gap takes some: ∂g/∂t = −∂g/∂x.
        let mut residual = Field::from_shape_fn([n, n], |(i, j)| {
            let (i, j) = (i as f64, j as f64 + 0.5);
            0.5 * d * (at(i, j) - at(i + 1.0, j)) - d * (at(i, j) - at(i + 1.0, j))
        });
        let mut pressure = Field::zeros([n, n]);
        let mut direction = residual.clone();
        let mut square = (&residual * &residual).sum();
        let first = square;
        while square > 1e-24 * first {
            let response = apply(&direction);
            let step = square / (&direction * &response).sum();
            pressure.scaled_add(step, &direction);
            residual.scaled_add(-step, &response);
            let next = (&residual * &residual).sum();
            direction = &residual + &(direction * (next / square));
            square = next;
        }
        (0..n)
            .map(|j| {
                face(0, j)[0] * (pressure[(n - 1, j)] - pressure[(0, j)]) + 0.5 * d * at(0.0, j as f64 + 0.5)
            })
            .sum()
    }
}
