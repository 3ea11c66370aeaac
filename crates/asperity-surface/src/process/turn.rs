//! Rotation of a topography in its plane, mirroring, and turning over.

use std::f64::consts::FRAC_PI_2;

use ndarray::Axis as Dimension;

use super::spline::{hermite, slopes};
use crate::{Axis, Fill, Topography};
use asperity_base::error::{Result, check_in};
use asperity_base::grid::{Field, Grid, flat_mut};
use asperity_base::math::parallel;
use asperity_base::units;

impl Topography {
    /// Mirrors the topography: along `axis` the first sample becomes the last.
    pub fn mirror(mut self, axis: Axis) -> Self {
        let [rows, columns] = self.grid().shape;
        let heights = flat_mut(self.heights_mut());
        match axis {
            Axis::X => {
                let (first, last) = heights.split_at_mut(rows / 2 * columns);
                first
                    .chunks_mut(columns)
                    .zip(last.rchunks_mut(columns))
                    .for_each(|(a, b)| a.swap_with_slice(b));
            }
            Axis::Y => heights.chunks_mut(columns).for_each(<[f64]>::reverse),
        }
        self
    }

    /// Turns the topography over about the y axis, to mount it as the upper body: mirrored in x and negated.
    ///
    /// Heights measured with the material's side up become the height of the underside. Applied twice, it is
    /// the identity.
    pub fn underside(self) -> Self {
        let mut mirrored = self.mirror(Axis::X);
        mirrored.heights_mut().mapv_inplace(|z| -z);
        mirrored
    }

    /// Rotates the topography in its plane by `angle`, in radians, from x towards y.
    ///
    /// Quarter turns are exact and exchange the numbers of cells and the pitches. The remainder, at most an
    /// eighth of a turn in either direction, keeps the pitches after the quarter turns. Its heights are those
    /// of the cubic spline through the samples, of fourth order in the pitch. They cover the largest
    /// rectangle along x and y around the middle that lies within the outermost samples, so that no height is
    /// extrapolated. A height with an undefined sample among the four around it is undefined.
    ///
    /// # Errors
    /// [`asperity_base::Error::OutOfRange`] if the angle is not finite.
    pub fn rotate(self, angle: f64) -> Result<Self> {
        let (quarters, left) = quarters(angle)?;
        let turned = self.quarter_turns(quarters)?;
        if left == 0.0 || turned.defined() == 0 { Ok(turned) } else { turned.rotate_a_little(left) }
    }

    fn quarter_turns(self, quarters: usize) -> Result<Self> {
        let Grid { shape: [nx, ny], pitch: [px, py] } = *self.grid();
        let z = self.heights();
        let (x, y) = (nx - 1, ny - 1);
        let (grid, heights) = match quarters {
            0 => return Ok(self),
            1 => (Grid::new([ny, nx], [py, px])?, Field::from_shape_fn([ny, nx], |(i, j)| z[[j, y - i]])),
            2 => (*self.grid(), Field::from_shape_fn([nx, ny], |(i, j)| z[[x - i, y - j]])),
            _ => (Grid::new([ny, nx], [py, px])?, Field::from_shape_fn([ny, nx], |(i, j)| z[[x - j, i]])),
        };
        Self::new(grid, heights)
    }

    /// Rotates the topography by at most an eighth of a turn, but not by 0.
    fn rotate_a_little(self, angle: f64) -> Result<Self> {
        let old = *self.grid();
        let new = rotated_a_little(&old, angle)?;
        let shape = new.shape;
        let (sin, cos) = angle.sin_cos();
        let undefined = self.heights().mapv(f64::is_nan);
        let spline = Spline::through(self.fill(Fill::Nearest)?.into_heights());
        let mut heights = new.zeros();
        let rows = heights.as_slice_mut().expect("fields are in standard layout").chunks_mut(shape[1]);
        parallel::tasks(rows.enumerate(), |(ix, row)| {
            for (iy, z) in row.iter_mut().enumerate() {
                let from_middle = |axis: usize, index: usize| {
                    (index as f64 - 0.5 * (shape[axis] - 1) as f64) * old.pitch[axis]
                };
                let (x, y) = (from_middle(0, ix), from_middle(1, iy));
                let position = [cos * x + sin * y, cos * y - sin * x];
                let sample = [0, 1].map(|axis| {
                    let last = (old.shape[axis] - 1) as f64;
                    (position[axis] / old.pitch[axis] + 0.5 * last).clamp(0.0, last)
                });
                let around = [0, 1].map(|axis| Spline::around(sample[axis], old.shape[axis]));
                let [below, above] = [0, 1].map(|i| [around[0].0[i], around[1].0[i]]);
                let corners = [below, [below[0], above[1]], [above[0], below[1]], above];
                *z = if corners.iter().any(|&corner| undefined[corner]) {
                    f64::NAN
                } else {
                    spline.at(around)
                };
            }
        });
        Self::new(new, heights)
    }
}

/// Returns the quarter turns, 0 to 3, and the remainder of an angle, at most an eighth of a turn.
fn quarters(angle: f64) -> Result<(usize, f64)> {
    /// Fraction of a quarter turn that is round-off.
    const CRUMB: f64 = 1e-9;
    check_in(units::Dimension::Angle, "rotate", angle, angle.is_finite(), "a finite angle")?;
    let quarters = (angle / FRAC_PI_2).round();
    let left = angle - quarters * FRAC_PI_2;
    Ok((quarters.rem_euclid(4.0) as usize, if left.abs() <= CRUMB { 0.0 } else { left }))
}

/// Returns the grid of a topography on `old` after [`Topography::rotate`], if any of its heights is defined.
pub(super) fn rotated(old: &Grid, angle: f64) -> Result<Grid> {
    let (quarters, left) = quarters(angle)?;
    let Grid { shape: [nx, ny], pitch: [px, py] } = *old;
    let turned = if quarters % 2 == 0 { *old } else { Grid::new([ny, nx], [py, px])? };
    if left == 0.0 { Ok(turned) } else { rotated_a_little(&turned, left) }
}

fn rotated_a_little(old: &Grid, angle: f64) -> Result<Grid> {
    let span = |axis: usize| (old.shape[axis] - 1) as f64 * old.pitch[axis];
    let (sin, cos) = angle.sin_cos();
    let inscribed = inscribed([span(0), span(1)], sin.abs(), cos);
    let shape = [0, 1].map(|axis| (inscribed[axis] / old.pitch[axis] * (1.0 + 1e-9)) as usize + 1);
    Grid::new(shape, old.pitch)
}

/// Returns the sides of the largest rotated rectangle w × h within W × H: w cos + h sin ≤ W, w sin + h cos ≤
/// H.
fn inscribed([width, height]: [f64; 2], sin: f64, cos: f64) -> [f64; 2] {
    // If one of the two is much shorter, it alone is the bound.
    let slim = 2.0 * sin * cos;
    if height <= slim * width {
        return [0.5 * height / sin, 0.5 * height / cos];
    }
    if width <= slim * height {
        return [0.5 * width / cos, 0.5 * width / sin];
    }
    let determinant = cos * cos - sin * sin;
    [(width * cos - height * sin) / determinant, (height * cos - width * sin) / determinant]
}

/// The bicubic spline through a field: heights, slopes along x and y, and the mixed derivative.
struct Spline([Field; 4]);

impl Spline {
    fn through(z: Field) -> Self {
        let [along_x, along_y] = [slopes(&z, Dimension(0)), slopes(&z, Dimension(1))];
        let cross = slopes(&along_x, Dimension(1));
        Self([z, along_x, along_y, cross])
    }

    /// Returns the samples, of `n`, below and above a position, and its weights; both samples are equal at
    /// the last one.
    fn around(position: f64, n: usize) -> ([usize; 2], [f64; 4]) {
        let below = (position as usize).min(n - 1);
        ([below, (below + 1).min(n - 1)], hermite(position - below as f64))
    }

    fn at(&self, [(xs, wx), (ys, wy)]: [([usize; 2], [f64; 4]); 2]) -> f64 {
        let mut height = 0.0;
        for (i, &ix) in xs.iter().enumerate() {
            for (j, &iy) in ys.iter().enumerate() {
                let [z, along_x, along_y, cross] = [0, 1, 2, 3].map(|part| self.0[part][[ix, iy]]);
                height += wx[i] * (wy[j] * z + wy[j + 2] * along_y);
                height += wx[i + 2] * (wy[j] * along_x + wy[j + 2] * cross);
            }
        }
        height
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::Form;
    use crate::topography::tests::numbered;

    #[test]
    fn turning_over_twice_is_nothing() {
        let twice = numbered().underside().underside();
        assert_eq!(twice.heights(), numbered().heights());
    }

    #[test]
    fn the_underside_of_a_ball_touches_with_its_apex() {
        let grid = Grid::new([9, 9], [1.0, 1.0]).unwrap();
        let ball = Form::Sphere { radius: 10.0 }.on(&grid).unwrap().underside();
        assert_eq!(ball.heights()[[4, 4]], 0.0);
        assert!(ball.heights().iter().all(|&z| z >= 0.0));
        assert_eq!(numbered().underside().heights()[[0, 1]], -31.0);
    }

    #[test]
    fn a_mirror_exchanges_the_ends_of_one_axis() {
        assert_eq!(numbered().mirror(Axis::X).heights()[[0, 1]], 31.0);
        assert_eq!(numbered().mirror(Axis::Y).heights()[[1, 0]], 12.0);
    }

    #[test]
    fn quarter_turns_move_the_samples_and_lose_nothing() {
        let quarter = numbered().rotate(FRAC_PI_2).unwrap();
        assert_eq!((quarter.grid().shape, quarter.grid().pitch), ([3, 4], [2.0, 1.0]));
        // The end of x is mapped to the end of y; the end of y to the beginning of x.
        assert_eq!((quarter.heights()[[2, 3]], quarter.heights()[[0, 0]]), (30.0, 2.0));
        let half = numbered().mirror(Axis::X).mirror(Axis::Y);
        assert_eq!(quarter.clone().rotate(FRAC_PI_2).unwrap().heights(), half.heights());
        assert_eq!(numbered().rotate(-2.0 * FRAC_PI_2).unwrap().heights(), half.heights());
        assert_eq!(
            numbered().rotate(-FRAC_PI_2).unwrap().rotate(FRAC_PI_2).unwrap().heights(),
            numbered().heights()
        );
        assert_eq!(numbered().rotate(-7.0 * FRAC_PI_2).unwrap().heights(), quarter.heights());
        assert!(numbered().rotate(f64::NAN).is_err());
    }

    #[test]
    fn a_known_surface_turns_with_an_error_of_the_fourth_order() {
        let height = |x: f64, y: f64| (3.0 * x + 0.4).sin() * (2.0 * y - 0.3).cos();
        for angle in [0.3, -0.7, 2.0] {
            let error = |n: usize| {
                let grid = Grid::new([n, n / 2 + 1], [2.0 / n as f64, 3.0 / n as f64]).unwrap();
                let from_middle =
                    |grid: &Grid, axis: usize, i: usize| grid.centre(axis, i) - 0.5 * grid.extent()[axis];
                let heights = Field::from_shape_fn(grid.shape, |(i, j)| {
                    height(from_middle(&grid, 0, i), from_middle(&grid, 1, j))
                });
                let turned = Topography::new(grid, heights).unwrap().rotate(angle).unwrap();
                assert!(turned.grid().cells() > grid.cells() / 4);
                let (sin, cos) = f64::sin_cos(angle);
                turned.heights().indexed_iter().fold(0.0, |most: f64, ((i, j), z)| {
                    let (x, y) = (from_middle(turned.grid(), 0, i), from_middle(turned.grid(), 1, j));
                    most.max((z - height(cos * x + sin * y, cos * y - sin * x)).abs())
                })
            };
            let (coarse, fine) = (error(40), error(80));
            let order = (coarse / fine).log2();
            assert!((order - 4.0).abs() < 0.4, "error {coarse:e} → {fine:e} is order {order:.2}");
        }
    }

    #[test]
    fn the_rectangle_kept_is_the_largest_that_fits() {
        for ([width, height], angle) in [([3.0, 2.0], 0.2f64), ([9.0, 1.0], 0.5), ([1.0, 4.0], 0.7)] {
            let (sin, cos) = angle.sin_cos();
            let area = |w: f64| w * ((width - w * cos) / sin).min((height - w * sin) / cos);
            let best = (0..100_000).map(|i| area(1e-4 * f64::from(i))).fold(0.0, f64::max);
            let [w, h] = inscribed([width, height], sin, cos);
            // The search uses steps of 10⁻⁴ of w, and a corner of its bound lies between two.
            assert!((w * h / best - 1.0).abs() < 1e-3);
            assert!(
                w * cos + h * sin <= width * (1.0 + 1e-12) && w * sin + h * cos <= height * (1.0 + 1e-12)
            );
        }
    }

    #[test]
    fn a_hole_turns_with_the_surface() {
        let grid = Grid::new([41, 41], [1.0, 1.0]).unwrap();
        let mut plane = Topography::new(grid, Field::from_shape_fn([41, 41], |(i, _)| i as f64)).unwrap();
        plane.heights_mut()[[30, 20]] = f64::NAN;
        let turned = plane.rotate(0.5).unwrap();
        let n = turned.grid().shape;
        let holes: Vec<_> = turned.heights().indexed_iter().filter(|(_, z)| z.is_nan()).collect();
        assert!((1..=9).contains(&holes.len()));
        for ((i, j), _) in holes {
            let (x, y) = (i as f64 - 0.5 * (n[0] - 1) as f64, j as f64 - 0.5 * (n[1] - 1) as f64);
            assert!((x - 10.0 * 0.5f64.cos()).hypot(y - 10.0 * 0.5f64.sin()) < 1.5);
        }
    }
}
