//! Adhesion of a case in numbers.

use serde::{Deserialize, Serialize};

use crate::adhesion::Adhesion;
use crate::grid::{Field, Grid};
use crate::motion::IncrementRecord;
use crate::operator::Boundary;
use crate::units::{Joule, Metre, Newton, Pascal, PerMetre};
use asperity_base::math::RealFft2;
use asperity_base::math::fft::angular_frequency;
use asperity_base::record::columns;

columns! {
    /// Adhesion of two bodies in numbers: `adhesion` in `summary.json`.
    #[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
    #[non_exhaustive]
    pub struct AdhesionSummary {
        /// Range of the attraction.
        pub range: Metre,
        /// Largest tension σ(0), in contact.
        pub max_tension: Pascal,
        /// Length of the process zone at the edge of a contact, E*ϱ²/πw.
        pub process_zone: Metre,
        /// Length of the process zone over the pitch, the larger one; pull-off is accurate to 1 % from 1.5.
        pub process_zone_cells: f64,
        /// Tabor's parameter (w²/E*²ϱ³κ)^⅓, with κ the rms mean curvature of the gap; unknown for flat
        /// surfaces.
        pub tabor: Option<f64>,
        /// Parameter of Pastewka and Robbins; rough surfaces stick below 1. Unknown for flat surfaces.
        pub pastewka_robbins: Option<f64>,
        /// Elastic energy of full contact over the work of adhesion; unknown unless both axes are periodic.
        pub full_contact_energy: Option<f64>,
        /// Pull-off force, the least load of a retreat; unknown if no retreat goes beyond it.
        pub pull_off: Option<Newton>,
        /// Work of separation: the work of the loads that pull, over the retreat; unknown as the pull-off is.
        pub work_of_separation: Option<Joule>,
    }
}

impl AdhesionSummary {
    /// Creates the numbers of bodies of this composite modulus with this initial `gap`, before they are
    /// pressed.
    pub fn new(
        adhesion: &Adhesion,
        gap: &Field,
        pitch: [Metre; 2],
        boundary: Boundary,
        modulus: Pascal,
    ) -> Self {
        let grid = &Grid { shape: [gap.nrows(), gap.ncols()], pitch };
        let [slope, laplacian] = moments(gap, grid, boundary);
        let is_rough = slope > 0.0 && laplacian > 0.0;
        let zone = adhesion.process_zone(modulus);
        let periodic = boundary.repeats(0) && boundary.repeats(1);
        Self {
            range: adhesion.range,
            max_tension: adhesion.max_tension(),
            process_zone: zone,
            process_zone_cells: zone / pitch[0].max(pitch[1]),
            tabor: is_rough.then(|| adhesion.tabor(modulus, 0.5 * laplacian)),
            pastewka_robbins: is_rough
                .then(|| adhesion.pastewka_robbins(modulus, slope, laplacian / std::f64::consts::SQRT_2)),
            full_contact_energy: periodic.then(|| flattening(gap, grid, modulus) / adhesion.work),
            pull_off: None,
            work_of_separation: None,
        }
    }

    /// Returns the largest force, pressure and energy among the numbers, 0 where they are unknown.
    pub fn scales(&self) -> [f64; 3] {
        let known = |value: Option<f64>| value.map_or(0.0, f64::abs);
        [known(self.pull_off), self.max_tension, known(self.work_of_separation)]
    }

    /// Adds what a retreat shows: the increments over which the approach falls. It goes beyond the pull-off
    /// where the load rises again, or the surfaces do not touch any more.
    pub fn after(self, increments: &[IncrementRecord]) -> Self {
        let retreats = increments.windows(2).filter(|pair| pair[1].approach < pair[0].approach);
        let (mut least, mut work, mut is_beyond): (Newton, Joule, _) = (f64::INFINITY, 0.0, false);
        for pair in retreats {
            let [before, after] = [&pair[0], &pair[1]];
            let pull = |increment: &IncrementRecord| (-increment.load).max(0.0);
            work += 0.5 * (pull(before) + pull(after)) * (before.approach - after.approach);
            least = least.min(before.load).min(after.load);
            is_beyond |= after.load > before.load || after.contact_area == 0.0;
        }
        Self { pull_off: is_beyond.then_some(least), work_of_separation: is_beyond.then_some(work), ..self }
    }
}

/// Returns the rms slope and the rms Laplacian of a gap, by differences of neighbouring cells. They wrap
/// round periodic axes.
fn moments(gap: &Field, grid: &Grid, boundary: Boundary) -> [f64; 2] {
    let [nx, ny] = grid.shape;
    let mut slopes = [0.0; 2];
    let (mut squares, mut inner) = (0.0, 0.0);
    let neighbour = |index: usize, axis: usize, forward: bool| -> Option<usize> {
        let count = grid.shape[axis];
        match (forward, boundary.repeats(axis)) {
            (true, true) => Some((index + 1) % count),
            (false, true) => Some((index + count - 1) % count),
            (true, false) => (index + 1 < count).then_some(index + 1),
            (false, false) => index.checked_sub(1),
        }
    };
    let mut pairs = [0.0; 2];
    for i in 0..nx {
        for j in 0..ny {
            let here = gap[[i, j]];
            let next =
                [neighbour(i, 0, true).map(|i| gap[[i, j]]), neighbour(j, 1, true).map(|j| gap[[i, j]])];
            let last =
                [neighbour(i, 0, false).map(|i| gap[[i, j]]), neighbour(j, 1, false).map(|j| gap[[i, j]])];
            for axis in 0..2 {
                if let Some(next) = next[axis] {
                    slopes[axis] += ((next - here) / grid.pitch[axis]).powi(2);
                    pairs[axis] += 1.0;
                }
            }
            // A line of one row has no curvature across it.
            let second = |axis: usize| match (last[axis], next[axis]) {
                _ if grid.shape[axis] == 1 => Some(0.0),
                (Some(last), Some(next)) => Some((last - 2.0 * here + next) / grid.pitch[axis].powi(2)),
                _ => None,
            };
            if let (Some(x), Some(y)) = (second(0), second(1)) {
                squares += (x + y).powi(2);
                inner += 1.0;
            }
        }
    }
    let mean = |sum: f64, count: f64| if count > 0.0 { sum / count } else { 0.0 };
    let slope: f64 = slopes.iter().zip(pairs).map(|(sum, count)| mean(*sum, count)).sum();
    [slope.sqrt(), mean(squares, inner).sqrt()]
}

/// Returns the elastic energy of an area that closes a periodic gap, J/m²: ¼E* Σ |q| |ĥ(q)|².
fn flattening(gap: &Field, grid: &Grid, modulus: Pascal) -> f64 {
    let [nx, ny] = grid.shape;
    let spectrum = RealFft2::new(grid.shape).forward(gap);
    let mut sum = 0.0;
    for ((k, l), value) in spectrum.indexed_iter() {
        let q: PerMetre =
            angular_frequency(k, nx, grid.pitch[0]).hypot(angular_frequency(l, ny, grid.pitch[1]));
        // All but the first and, of an even number, the last column stand for two waves.
        let waves = if l == 0 || 2 * l == ny { 1.0 } else { 2.0 };
        sum += waves * q * value.norm_sqr();
    }
    0.25 * modulus * sum / (grid.cells() as f64).powi(2)
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;

    use super::*;

    #[test]
    fn a_sphere_has_the_curvature_of_its_radius() {
        let grid = Grid::new([40, 40], [0.1, 0.1]).unwrap();
        let at = |i: usize| (i as f64 - 19.5) * 0.1;
        let gap = Field::from_shape_fn(grid.shape, |(i, j)| 0.5 * (at(i).powi(2) + at(j).powi(2)) / 7.0);
        let adhesion = Adhesion::new(0.3, 0.2).unwrap();
        let numbers = AdhesionSummary::new(&adhesion, &gap, grid.pitch, Boundary::FREE, 2.0);
        assert_relative_eq!(numbers.tabor.unwrap(), adhesion.tabor(2.0, 1.0 / 7.0), max_relative = 1e-9);
        assert_eq!(numbers.full_contact_energy, None);
        let flat = AdhesionSummary::new(&adhesion, &grid.zeros(), grid.pitch, Boundary::FREE, 2.0);
        assert_eq!((flat.tabor, flat.pastewka_robbins), (None, None));
    }

    /// A wave h cos qx has the slope hq/√2 and takes ¼E* q ½h² an area to flatten.
    #[test]
    fn a_wave_takes_the_energy_of_westergaard_to_flatten() {
        let grid = Grid::new([256, 4], [0.5, 0.5]).unwrap();
        let q = std::f64::consts::TAU * 3.0 / (256.0 * 0.5);
        let gap = Field::from_shape_fn(grid.shape, |(i, _)| 0.2 * (q * 0.5 * i as f64).cos());
        let adhesion = Adhesion::new(0.3, 0.2).unwrap();
        let numbers = AdhesionSummary::new(&adhesion, &gap, grid.pitch, Boundary::PERIODIC, 2.0);
        let energy = 0.25 * 2.0 * q * 0.5 * 0.04;
        assert_relative_eq!(numbers.full_contact_energy.unwrap(), energy / 0.3, max_relative = 1e-12);
        let [slope, laplacian] = moments(&gap, &grid, Boundary::PERIODIC);
        assert_relative_eq!(slope, 0.2 * q / 2.0f64.sqrt(), max_relative = 1e-3);
        assert_relative_eq!(laplacian, 0.2 * q * q / 2.0f64.sqrt(), max_relative = 1e-3);
    }

    #[test]
    fn the_retreat_tells_pull_off_and_work() {
        let grid = Grid::new([4, 4], [0.1, 0.1]).unwrap();
        let numbers = AdhesionSummary::new(
            &Adhesion::new(0.3, 0.2).unwrap(),
            &grid.zeros(),
            grid.pitch,
            Boundary::FREE,
            2.0,
        );
        let row = |approach, load| IncrementRecord {
            approach,
            load,
            contact_area: 0.01,
            ..IncrementRecord::default()
        };
        let path = [row(0.0, -1.0), row(1.0, 5.0), row(0.0, -2.0), row(-1.0, -3.0), row(-2.0, 0.0)];
        let numbers = numbers.after(&path);
        assert_eq!(numbers.pull_off, Some(-3.0));
        assert_relative_eq!(numbers.work_of_separation.unwrap(), 1.0 + 2.5 + 1.5);
        assert_eq!(numbers.after(&path[..2]).pull_off, None);
    }

    /// A pull that the bodies bear is no pull-off, and neither is the end of a partial unloading.
    #[test]
    fn bodies_that_still_hold_have_no_pull_off() {
        let grid = Grid::new([4, 4], [0.1, 0.1]).unwrap();
        let adhesion = Adhesion::new(0.3, 0.2).unwrap();
        let numbers = AdhesionSummary::new(&adhesion, &grid.zeros(), grid.pitch, Boundary::FREE, 2.0);
        let row = |approach, load, contact_area| IncrementRecord {
            approach,
            load,
            contact_area,
            ..IncrementRecord::default()
        };
        let pulled = [row(1.0, 5.0, 0.3), row(0.0, -2.0, 0.2)];
        let [held, apart] = [row(-1.0, -2.5, 0.1), row(-1.0, -2.5, 0.0)]
            .map(|end| numbers.after(&[&pulled[..], &[end]].concat()));
        assert_eq!((held.pull_off, held.work_of_separation), (None, None));
        assert_eq!(apart.pull_off, Some(-2.5));
    }
}
