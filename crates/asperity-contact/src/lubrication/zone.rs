//! Where a film is measured.

use crate::grid::{Field, Grid};
use crate::operator::Boundary;
use crate::units::Metre;

/// Share of the area of the contact around its centre over which the central film is a mean.
const CENTRAL: f64 = 0.1;

/// The contact of two bodies as a whole: the ellipse over which Hertz' pressure would have the second moments of the
/// dry pressure, the strip of a line contact that repeats along y, or all cells if nothing is pressed.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ContactZone {
    /// The centre, from the corner of the grid.
    pub centre: [Metre; 2],
    /// Half the width along x and y; infinite along y for a strip, and along both axes for all cells.
    pub half_widths: [Metre; 2],
}

impl ContactZone {
    /// Finds the contact from the pressure of the dry bodies on a grid with this boundary.
    pub fn new(dry: &Field, grid: &Grid, boundary: Boundary) -> Self {
        let total = dry.sum();
        let everywhere =
            Self { centre: grid.extent().map(|side| 0.5 * side), half_widths: [f64::INFINITY; 2] };
        if total <= 0.0 {
            return everywhere;
        }
        let mean = |axis: usize, value: &dyn Fn(f64) -> f64| {
            dry.indexed_iter().map(|((i, j), p)| p * value(grid.centre(axis, [i, j][axis]))).sum::<f64>()
                / total
        };
        let moments = [0, 1].map(|axis| {
            let centre = mean(axis, &|place| place);
            // The pressure of one cell has the moment of its own width.
            let own = grid.pitch[axis] * grid.pitch[axis] / 12.0;
            [centre, mean(axis, &|place| (place - centre) * (place - centre)) + own]
        });
        // Hertz: a² is five times the second moment of an ellipse, and four times that of a strip.
        if boundary.repeats(1) {
            let [centre, moment] = moments[0];
            return Self {
                centre: [centre, everywhere.centre[1]],
                half_widths: [(4.0 * moment).sqrt(), f64::INFINITY],
            };
        }
        Self {
            centre: moments.map(|[centre, _]| centre),
            half_widths: moments.map(|[_, moment]| (5.0 * moment).sqrt()),
        }
    }

    /// The central part of the contact.
    pub fn central(&self) -> Self {
        let is_strip = self.half_widths[1].is_infinite();
        let factor = if is_strip { CENTRAL } else { CENTRAL.sqrt() };
        Self { half_widths: self.half_widths.map(|width| factor * width), ..*self }
    }

    /// Returns the flat cells of a grid whose centres lie in the contact; at least the one nearest to its centre.
    pub fn cells(&self, grid: &Grid) -> Vec<usize> {
        let distance = |cell: usize| {
            let place = [cell / grid.shape[1], cell % grid.shape[1]];
            let along =
                |axis: usize| (grid.centre(axis, place[axis]) - self.centre[axis]) / self.half_widths[axis];
            along(0).powi(2) + along(1).powi(2)
        };
        let cells: Vec<usize> = (0..grid.cells()).filter(|cell| distance(*cell) <= 1.0).collect();
        if cells.is_empty() {
            return (0..grid.cells())
                .min_by(|a, b| distance(*a).total_cmp(&distance(*b)))
                .into_iter()
                .collect();
        }
        cells
    }

    /// Returns the rms of a gap in the contact about the second-order surface closest to it: the composite roughness
    /// of both bodies. Returns `None` for fewer than 20 cells, or below a thousandth of the range of the gap: so much of
    /// a smooth form differs from that surface.
    pub fn roughness(&self, gap: &Field, grid: &Grid) -> Option<Metre> {
        /// Fewest cells, and the least share of the range of the gap that is roughness.
        const FEWEST: usize = 20;
        const SMOOTH: f64 = 1e-3;
        let cells = self.cells(grid);
        if cells.len() < FEWEST {
            return None;
        }
        let heights: Vec<f64> =
            cells.iter().map(|cell| gap[[cell / grid.shape[1], cell % grid.shape[1]]]).collect();
        let scale = [0, 1].map(|axis| self.half_widths[axis].min(grid.extent()[axis]));
        let terms: Vec<[f64; 6]> = cells
            .iter()
            .map(|cell| {
                let place = [cell / grid.shape[1], cell % grid.shape[1]];
                let [x, y] =
                    [0, 1].map(|axis| (grid.centre(axis, place[axis]) - self.centre[axis]) / scale[axis]);
                [1.0, x, y, x * x, x * y, y * y]
            })
            .collect();
        let left = residuals(&terms, &heights);
        let rms = (left.iter().map(|z| z * z).sum::<f64>() / left.len() as f64).sqrt();
        let [least, most] = [f64::min, f64::max].map(|pick| heights.iter().copied().fold(heights[0], pick));
        (rms > SMOOTH * (most - least)).then_some(rms)
    }
}

/// Returns what is left of some values after their projections on the terms, by Gram and Schmidt, twice for accuracy.
fn residuals<const N: usize>(terms: &[[f64; N]], values: &[f64]) -> Vec<f64> {
    let dot = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a * b).sum::<f64>();
    let mut basis: Vec<Vec<f64>> = Vec::new();
    let orthogonal = |mut values: Vec<f64>, basis: &[Vec<f64>]| {
        for _ in 0..2 {
            for direction in basis {
                let part = dot(direction, &values);
                values.iter_mut().zip(direction).for_each(|(value, d)| *value -= part * d);
            }
        }
        values
    };
    for term in 0..N {
        let column: Vec<f64> = terms.iter().map(|terms| terms[term]).collect();
        let before = dot(&column, &column);
        let column = orthogonal(column, &basis);
        let norm = dot(&column, &column);
        // A term that the others contain, as y in a single row, adds nothing.
        if norm > 1e-12 * before {
            basis.push(column.iter().map(|value| value / norm.sqrt()).collect());
        }
    }
    orthogonal(values.to_vec(), &basis)
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;

    use super::*;

    #[test]
    fn the_zone_of_the_pressure_of_hertz_is_its_ellipse() {
        let grid = Grid::new([120, 90], [1e-6, 2e-6]).unwrap();
        let (centre, axes) = ([55e-6, 100e-6], [30e-6, 60e-6]);
        let at = |i: usize, axis: usize| (grid.centre(axis, i) - centre[axis]) / axes[axis];
        let hertz = Field::from_shape_fn(grid.shape, |(i, j)| {
            (1.0 - at(i, 0).powi(2) - at(j, 1).powi(2)).max(0.0).sqrt()
        });
        let zone = ContactZone::new(&hertz, &grid, Boundary::FREE);
        for axis in [0, 1] {
            assert_relative_eq!(zone.centre[axis], centre[axis], max_relative = 1e-2);
            assert_relative_eq!(zone.half_widths[axis], axes[axis], max_relative = 1e-2);
        }
        let area = std::f64::consts::PI * axes[0] * axes[1] / grid.cell_area();
        assert_relative_eq!(zone.cells(&grid).len() as f64, area, max_relative = 0.03);
        assert_relative_eq!(zone.central().cells(&grid).len() as f64, 0.1 * area, max_relative = 0.1);
        let nothing = ContactZone::new(&grid.zeros(), &grid, Boundary::FREE);
        assert_eq!(nothing.cells(&grid).len(), grid.cells());
    }

    #[test]
    fn waves_on_a_tilted_paraboloid_are_its_roughness() {
        let grid = Grid::new([64, 64], [1e-6; 2]).unwrap();
        let gap = |wave: f64| {
            Field::from_shape_fn(grid.shape, |(i, j)| {
                let [x, y] = [i as f64 - 30.0, j as f64 - 33.0];
                1e-9 * (0.3 * x * x + 0.2 * y * y + 0.1 * x * y + 3.0 * x)
                    + wave * (0.9 * x).cos() * (0.8 * y).cos()
            })
        };
        let zone = ContactZone { centre: [32e-6; 2], half_widths: [25e-6; 2] };
        assert_relative_eq!(zone.roughness(&gap(10e-9), &grid).unwrap(), 5e-9, max_relative = 0.05);
        assert_eq!(zone.roughness(&gap(0.0), &grid), None);
    }
}
