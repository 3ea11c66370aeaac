//! Spheres and cylinders of best fit.

use super::normal_equations::NormalEquations;
use crate::Topography;
use asperity_base::grid::{Field, Grid};
use asperity_base::math::parallel;
use asperity_base::units::Metre;

/// A sphere or a circular cylinder fitted to a topography.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Round {
    /// Radius, positive for a convex surface (a ball), negative for a concave one (a cup); infinite for a
    /// plane.
    pub radius: Metre,
    /// Centre of the sphere, or the point of the cylinder's axis closest to the middle of the samples; x and
    /// y relative to the grid's corner, z like the heights.
    pub centre: [Metre; 3],
    /// Direction of a cylinder's axis in the plane, from x towards y, −π/2 < θ ≤ π/2.
    pub axis: Option<f64>,
}

impl Topography {
    /// Fits a sphere by least squares of the vertical distances of the defined samples. They differ from the
    /// radial distances by the cosine of the slope. `None` if no sample is defined.
    ///
    /// The upper or lower side of the sphere is z = z₀ + v, v − (c/2)v² = b·r + (c/2)r², with r relative to
    /// the middle of the samples. The curvature c = −√(1 + b²)/R passes smoothly through 0.
    /// Levenberg–Marquardt, starting from the plane; Marquardt, J. SIAM 11, 431 (1963). If the samples do not
    /// determine the fit, it returns one of the best.
    pub fn best_sphere(&self) -> Option<Round> {
        remove_sphere(&mut self.clone())
    }

    /// Fits a cylinder by least squares of the vertical distances, like [`Topography::best_sphere`]. Its axis
    /// may have any direction in the plane, and a tilt.
    ///
    /// With s along the axis, t across, and the slope a of the axis: z = z₀ + a s + v, v − (c/2) v²/(1 + a²)
    /// = b t + (c/2) t².
    pub fn best_cylinder(&self) -> Option<Round> {
        remove_cylinder(&mut self.clone())
    }
}

/// Subtracts the best sphere.
pub(super) fn remove_sphere(topography: &mut Topography) -> Option<Round> {
    let cloud = Cloud::of(topography)?;
    let p = cloud.fit(sphere, [0.0; N]);
    cloud.subtract(sphere, &p, topography);
    let [z, bx, by, c, ..] = p;
    let radius = -(1.0 + bx * bx + by * by).sqrt() / c;
    Some(cloud.placed(radius, [-bx / c, -by / c, z + 1.0 / c], None))
}

/// Subtracts the best cylinder.
pub(super) fn remove_cylinder(topography: &mut Topography) -> Option<Round> {
    let cloud = Cloud::of(topography)?;
    // The axis of least curvature of the best-fit paraboloid.
    let [_, _, _, xx, xy, yy] = cloud.fit(paraboloid, [0.0; N]);
    let steepest = 0.5 * (2.0 * xy).atan2(xx - yy);
    let quarter = std::f64::consts::FRAC_PI_2;
    let theta = if xx + yy > 0.0 { steepest + quarter } else { steepest };
    let p = cloud.fit(cylinder, [0.0, 0.0, 0.0, 0.0, theta, 0.0]);
    cloud.subtract(cylinder, &p, topography);
    let [z, a, b, c, theta, _] = p;
    let radius = -(1.0 + a * a + b * b).sqrt() / c;
    let (sin, cos) = theta.sin_cos();
    let centre = [sin * b / c, -cos * b / c, z + (1.0 + a * a) / c];
    let axis = quarter - (quarter - theta).rem_euclid(std::f64::consts::PI);
    Some(cloud.placed(radius, centre, Some(axis)))
}

/// Largest number of parameters of a surface.
const N: usize = 6;

/// Height at (x, y) and its derivatives with respect to the parameters; `None` where the surface does not
/// extend.
type Surface = fn(&[f64; N], f64, f64) -> Option<(f64, [f64; N])>;

/// Parameters z, bx, by, c.
fn sphere(p: &[f64; N], x: f64, y: f64) -> Option<(f64, [f64; N])> {
    let [z, bx, by, c, ..] = *p;
    let half = 0.5 * (x * x + y * y);
    let (v, rho) = arc(bx * x + by * y + c * half, c)?;
    Some((z + v, [1.0, x / rho, y / rho, (half + 0.5 * v * v) / rho, 0.0, 0.0]))
}

/// Parameters z, a, b, c, θ.
fn cylinder(p: &[f64; N], x: f64, y: f64) -> Option<(f64, [f64; N])> {
    let [z, a, b, c, theta, _] = *p;
    let (sin, cos) = theta.sin_cos();
    let (s, t) = (x * cos + y * sin, y * cos - x * sin);
    let stretch = 1.0 + a * a;
    let (v, rho) = arc(b * t + 0.5 * c * t * t, c / stretch)?;
    let half = 0.5 * v * v / stretch;
    let by_a = s - 2.0 * a * c * half / (stretch * rho);
    let by_theta = a * t - (b + c * t) * s / rho;
    Some((z + a * s + v, [1.0, by_a, t / rho, (0.5 * t * t + half) / rho, by_theta, 0.0]))
}

/// Parameters z and the derivatives x, y, xx, xy, yy.
fn paraboloid(p: &[f64; N], x: f64, y: f64) -> Option<(f64, [f64; N])> {
    let terms = [1.0, x, y, 0.5 * x * x, x * y, 0.5 * y * y];
    Some((terms.iter().zip(p).map(|(term, p)| term * p).sum(), terms))
}

/// The solution v of v − (k/2) v² = q that vanishes with q, and √(1 − 2kq) = 1 − kv.
fn arc(q: f64, k: f64) -> Option<(f64, f64)> {
    let rho = (1.0 - 2.0 * k * q).sqrt();
    (rho > 0.0).then(|| (2.0 * q / (1.0 + rho), rho))
}

/// The defined samples, with lengths relative to their middle in units of their spread.
struct Cloud {
    grid: Grid,
    heights: Field,
    middle: [Metre; 3],
    spread: Metre,
}

/// Sums over the samples: squared residuals, Jᵀr, and JᵀJ.
#[derive(Clone, Copy)]
struct Sums {
    squares: f64,
    gradient: [f64; N],
    products: [[f64; N]; N],
}

impl Cloud {
    fn of(topography: &Topography) -> Option<Self> {
        let (grid, heights) = (*topography.grid(), topography.heights());
        let defined = || heights.indexed_iter().filter(|(_, z)| !z.is_nan());
        let n = defined().count();
        if n == 0 {
            return None;
        }
        let place = |(ix, iy): (usize, usize), z: f64| [grid.centre(0, ix), grid.centre(1, iy), z];
        let sum = defined().fold([0.0; 3], |sum, (at, z)| {
            let point = place(at, *z);
            [0, 1, 2].map(|i| sum[i] + point[i])
        });
        let middle = sum.map(|sum| sum / n as f64);
        let squares: f64 = defined()
            .map(|(at, z)| {
                let [x, y, _] = place(at, *z);
                (x - middle[0]).powi(2) + (y - middle[1]).powi(2)
            })
            .sum();
        let spread = if squares > 0.0 { (squares / n as f64).sqrt() } else { 1.0 };
        let heights = heights.mapv(|z| (z - middle[2]) / spread);
        Some(Self { grid, heights, middle, spread })
    }

    /// Fits the parameters by least squares, starting from `p`, for which the surface must extend over all
    /// samples.
    fn fit(&self, surface: Surface, mut p: [f64; N]) -> [f64; N] {
        /// A fit converges in about ten steps.
        const STEPS: usize = 100;
        /// Relative decrease of the sum of squares at convergence.
        const SMALL: f64 = 1e-12;
        let mut damping = 0.0;
        let mut sums = self.sums(surface, &p).expect("the fit begins with a surface that reaches everywhere");
        for _ in 0..STEPS {
            let lower = (0..N)
                .map(|i| {
                    let damp = |j| if i == j { 1.0 + damping } else { 1.0 };
                    (0..=i).map(|j| sums.products[i][j] * damp(j)).collect()
                })
                .collect();
            let step = NormalEquations::new(lower).solve(sums.gradient.to_vec());
            let mut trial = p;
            trial.iter_mut().zip(step).for_each(|(p, step)| *p += step);
            match self.sums(surface, &trial) {
                Some(better) if better.squares < sums.squares => {
                    let decrease = sums.squares - better.squares;
                    (p, damping) = (trial, if damping > 1e-6 { 0.1 * damping } else { 0.0 });
                    sums = better;
                    if decrease < SMALL * sums.squares {
                        break;
                    }
                }
                _ if damping > 1e6 => break,
                _ => damping = (10.0 * damping).max(1e-3),
            }
        }
        p
    }

    /// Computes the sums for these parameters, in the order of the rows; `None` if the surface does not
    /// extend over all samples.
    fn sums(&self, surface: Surface, p: &[f64; N]) -> Option<Sums> {
        let zero = Sums { squares: 0.0, gradient: [0.0; N], products: [[0.0; N]; N] };
        let rows = parallel::tasks(0..self.grid.shape[0], |ix| {
            let mut sums = zero;
            for (iy, z) in self.heights.row(ix).iter().enumerate().filter(|(_, z)| !z.is_nan()) {
                let (height, slopes) = self.at(surface, p, ix, iy)?;
                let residual = z - height;
                sums.squares += residual * residual;
                for i in 0..N {
                    sums.gradient[i] += slopes[i] * residual;
                    (0..=i).for_each(|j| sums.products[i][j] += slopes[i] * slopes[j]);
                }
            }
            Some(sums)
        });
        rows.into_iter().try_fold(zero, |mut sums, row| {
            let row = row?;
            sums.squares += row.squares;
            for i in 0..N {
                sums.gradient[i] += row.gradient[i];
                (0..=i).for_each(|j| sums.products[i][j] += row.products[i][j]);
            }
            Some(sums)
        })
    }

    fn at(&self, surface: Surface, p: &[f64; N], ix: usize, iy: usize) -> Option<(f64, [f64; N])> {
        let x = (self.grid.centre(0, ix) - self.middle[0]) / self.spread;
        let y = (self.grid.centre(1, iy) - self.middle[1]) / self.spread;
        surface(p, x, y)
    }

    /// Subtracts the surface, and the middle height.
    fn subtract(&self, surface: Surface, p: &[f64; N], topography: &mut Topography) {
        for ((ix, iy), z) in topography.heights_mut().indexed_iter_mut().filter(|(_, z)| !z.is_nan()) {
            let (height, _) = self.at(surface, p, ix, iy).expect("it reaches all samples");
            *z = (self.heights[[ix, iy]] - height) * self.spread;
        }
    }

    /// Returns the form in metres, relative to the grid's corner.
    fn placed(&self, radius: f64, centre: [f64; 3], axis: Option<f64>) -> Round {
        let centre = [0, 1, 2].map(|i| self.middle[i] + centre[i] * self.spread);
        Round { radius: radius * self.spread, centre, axis }
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use super::*;
    use crate::Level;

    const GRID: Grid = Grid { shape: [90, 60], pitch: [1e-5, 1.5e-5] };

    fn with_heights(height: impl Fn(f64, f64) -> f64) -> Topography {
        let heights = Field::from_shape_fn(GRID.shape, |(i, j)| height(GRID.centre(0, i), GRID.centre(1, j)));
        Topography::new(GRID, heights).unwrap()
    }

    fn largest(topography: &Topography) -> f64 {
        topography.heights().iter().filter(|z| !z.is_nan()).fold(0.0, |m, z| z.abs().max(m))
    }

    /// A sphere around (4, 5, z) · 1e-4 m, convex or concave.
    fn ball(radius: f64) -> Topography {
        with_heights(|x, y| {
            let r2 = (x - 4e-4).powi(2) + (y - 5e-4).powi(2);
            radius.signum() * (radius * radius - r2).sqrt() + 3e-4
        })
    }

    #[test]
    fn a_ball_and_a_cup_are_found_and_leave_nothing() {
        // Down to a sphere whose flanks reach 50 degrees.
        for radius in [1e-3, -1e-3, 0.8e-3, -0.1] {
            let surface = ball(radius);
            let found = surface.best_sphere().unwrap();
            // A sphere of 0.1 m rises by 3 µm over the samples: 1e-16 of its own height is 1e-10 of its
            // radius.
            assert!((found.radius / radius - 1.0).abs() < 1e-9, "{found:?}");
            for (found, exact) in found.centre.iter().zip([4e-4, 5e-4, 3e-4]) {
                assert!((found - exact).abs() < 1e-9 * radius.abs(), "{found} {exact}");
            }
            assert!(largest(&surface.level(Level::Sphere).unwrap()) < 1e-14 * radius.abs());
        }
    }

    #[test]
    fn a_cylinder_is_found_in_any_direction_and_tilt() {
        for (radius, theta, slope) in
            [(2e-3, 0.0, 0.0), (-2e-3, 0.5, 0.1), (1.2e-3, -1.2, -0.05), (3e-3, PI / 2.0, 0.0)]
        {
            let (sin, cos) = f64::sin_cos(theta);
            let surface = with_heights(|x, y| {
                let (s, t) = ((x - 4e-4) * cos + (y - 5e-4) * sin, (y - 5e-4) * cos - (x - 4e-4) * sin);
                slope * s + f64::signum(radius) * ((radius * radius - t * t) * (1.0 + slope * slope)).sqrt()
            });
            let found = surface.best_cylinder().unwrap();
            assert!((found.radius / radius - 1.0).abs() < 1e-9, "{found:?}");
            let turned = (found.axis.unwrap() - theta + PI / 2.0).rem_euclid(PI) - PI / 2.0;
            assert!(turned.abs() < 1e-9, "{found:?}");
            // The centre is on the axis through (4e-4, 5e-4, 0).
            let [x, y, z] = found.centre;
            let (s, t) = ((x - 4e-4) * cos + (y - 5e-4) * sin, (y - 5e-4) * cos - (x - 4e-4) * sin);
            assert!(t.abs() < 1e-12 && (z - slope * s).abs() < 1e-12, "{found:?}");
            assert!(largest(&surface.level(Level::Cylinder).unwrap()) < 1e-14 * f64::abs(radius));
        }
    }

    #[test]
    fn noise_moves_the_radius_by_no_more_than_its_share() {
        // With noise σ on n samples, the standard error of the curvature is σ/√n over the rms of r²/2 without
        // its mean and plane. Here this is about 4 per cent of the curvature of a radius of one metre. Five
        // times that is not exceeded by chance.
        let (radius, sigma) = (2e-2, 1e-8);
        let mut state = 1u64;
        let mut noise = || {
            state = state.wrapping_mul(6364136223846793005).wrapping_add(1442695040888963407);
            sigma * 12f64.sqrt() * ((state >> 11) as f64 / (1u64 << 53) as f64 - 0.5)
        };
        let mut surface = ball(radius);
        surface.heights_mut().mapv_inplace(|z| z + noise());
        let of_r2 = with_heights(|x, y| 0.5 * ((x - 4.5e-4).powi(2) + (y - 4.5e-4).powi(2)));
        let rms = of_r2.level(Level::Plane).unwrap().sq();
        let uncertainty = sigma / (rms * (GRID.cells() as f64).sqrt());
        let found = surface.best_sphere().unwrap();
        assert!((1.0 / found.radius - 1.0 / radius).abs() < 5.0 * uncertainty, "{found:?}");
        assert!(uncertainty < 0.01 / radius);
        let left = surface.level(Level::Sphere).unwrap().sq();
        assert!((left / sigma - 1.0).abs() < 5.0 / (2.0 * GRID.cells() as f64).sqrt(), "{left:e}");
    }

    #[test]
    fn holes_are_left_out_of_the_fit_and_a_plane_is_a_sphere_without_end() {
        let mut holed = ball(1e-3);
        (10..40).for_each(|i| (5..30).for_each(|j| holed.heights_mut()[[i, j]] = f64::NAN));
        let levelled = holed.level(Level::Sphere).unwrap();
        assert_eq!(levelled.undefined(), 30 * 25);
        assert!(largest(&levelled) < 1e-16);
        let plane = with_heights(|x, y| 1e-5 + 0.1 * x - 0.2 * y);
        assert!(plane.best_sphere().unwrap().radius.abs() > 1e6);
        assert!(largest(&plane.level(Level::Cylinder).unwrap()) < 1e-17);
        let nothing = Topography::new(GRID, Field::from_elem(GRID.shape, f64::NAN)).unwrap();
        assert_eq!(nothing.best_cylinder(), None);
    }
}
