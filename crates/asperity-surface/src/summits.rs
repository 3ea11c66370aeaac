//! Summits, and the asperities of Greenwood and Williamson.

use ndarray::Array2;
use serde::Serialize;

use crate::Topography;
use asperity_base::grid::Field;
use asperity_base::units::{Metre, SquareMetre};

/// The summits of a topography: samples higher than their eight neighbours.
///
/// A plateau of equal heights is one summit if no neighbour is as high; its position is that of its first
/// sample in memory order. Samples on the boundary or beside an undefined one are not judged, nor are
/// plateaus with such a sample. The density refers to the area of the judged samples.
///
/// The summits depend on the pitch: on a sampled surface some are missed, and noise adds others (Greenwood,
/// Proc. R. Soc. A 393, 133, 1984). With eight samples per shortest wave of an isotropic Gaussian surface,
/// the density is accurate to 1 % and the radius 5 % too large, with twelve 2 %.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct Summits {
    /// The summits, in memory order.
    pub summits: Vec<Summit>,
    /// Area of the judged samples.
    pub area: SquareMetre,
}

/// A local maximum of the heights.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Summit {
    /// Index `[ix, iy]` of its sample.
    pub sample: [usize; 2],
    /// Height above the mean.
    pub height: Metre,
    /// Mean curvature −½(∂²z/∂x² + ∂²z/∂y²) by second differences, 1/m, not negative.
    pub curvature: f64,
}

/// A rough surface in the model of Greenwood & Williamson, Proc. R. Soc. A 295, 300 (1966): asperities with
/// spherical tips of equal radius and Gaussian heights.
///
/// Determined from the surface by [`Summits::greenwood_williamson`], or from the theory of random surfaces by
/// [`crate::SpectralMoments::greenwood_williamson`].
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct GreenwoodWilliamson {
    /// Asperities per area η, 1/m².
    pub density: f64,
    /// Radius R of their tips, the inverse of their mean curvature.
    pub radius: Metre,
    /// Standard deviation σs of their heights.
    pub height_deviation: Metre,
    /// Mean height of the summits above the mean of the surface.
    pub mean_height: Metre,
}

impl Summits {
    /// Finds the summits of `topography`.
    pub fn new(topography: &Topography) -> Self {
        let (grid, z) = (topography.grid(), topography.heights());
        let mean = topography.mean();
        let mut seen = Array2::from_elem(grid.shape, false);
        let mut summits = Vec::new();
        let mut judged = 0usize;
        for ix in 0..grid.shape[0] {
            for iy in 0..grid.shape[1] {
                let Some(highest) = highest_neighbour(z, [ix, iy]) else { continue };
                judged += 1;
                if highest < z[[ix, iy]] || highest == z[[ix, iy]] && is_summit(z, [ix, iy], &mut seen) {
                    let second = |before: f64, after: f64| 2.0 * z[[ix, iy]] - before - after;
                    let along_x = second(z[[ix - 1, iy]], z[[ix + 1, iy]]) / grid.pitch[0].powi(2);
                    let along_y = second(z[[ix, iy - 1]], z[[ix, iy + 1]]) / grid.pitch[1].powi(2);
                    let (height, curvature) = (z[[ix, iy]] - mean, 0.5 * (along_x + along_y));
                    summits.push(Summit { sample: [ix, iy], height, curvature });
                }
            }
        }
        Self { summits, area: judged as f64 * grid.cell_area() }
    }

    /// Computes the density, the mean height, its standard deviation and the radius of the mean curvature;
    /// NaN for those that need more summits than found.
    pub fn greenwood_williamson(&self) -> GreenwoodWilliamson {
        let count = self.summits.len() as f64;
        let mean = |f: &dyn Fn(&Summit) -> f64| self.summits.iter().map(f).sum::<f64>() / count;
        let mean_height = mean(&|summit| summit.height);
        GreenwoodWilliamson {
            density: count / self.area,
            radius: 1.0 / mean(&|summit| summit.curvature),
            height_deviation: mean(&|summit| (summit.height - mean_height).powi(2)).sqrt(),
            mean_height,
        }
    }
}

/// Returns the highest of the eight heights around a sample; `None` if it or one of them is undefined or off
/// the grid.
fn highest_neighbour(z: &Field, [ix, iy]: [usize; 2]) -> Option<f64> {
    let inside = |index: usize, n: usize| index > 0 && index + 1 < n;
    if !(inside(ix, z.nrows()) && inside(iy, z.ncols())) || z[[ix, iy]].is_nan() {
        return None;
    }
    let mut highest = f64::NEG_INFINITY;
    for neighbour in neighbours([ix, iy]) {
        if z[neighbour].is_nan() {
            return None;
        }
        highest = highest.max(z[neighbour]);
    }
    Some(highest)
}

/// Whether the plateau of `start` is a summit; true only for the first call with one of its samples.
fn is_summit(z: &Field, start: [usize; 2], seen: &mut Array2<bool>) -> bool {
    if std::mem::replace(&mut seen[start], true) {
        return false;
    }
    let (mut plateau, mut summit) = (vec![start], true);
    while let Some(sample) = plateau.pop() {
        match highest_neighbour(z, sample) {
            None => summit = false,
            Some(highest) => {
                summit &= highest <= z[start];
                for neighbour in neighbours(sample) {
                    if z[neighbour] == z[start] && !std::mem::replace(&mut seen[neighbour], true) {
                        plateau.push(neighbour);
                    }
                }
            }
        }
    }
    summit
}

fn neighbours([ix, iy]: [usize; 2]) -> [[usize; 2]; 8] {
    let [x, y] = [ix, iy].map(|index| [index - 1, index, index + 1]);
    [
        [x[0], y[0]],
        [x[0], y[1]],
        [x[0], y[2]],
        [x[1], y[0]],
        [x[1], y[2]],
        [x[2], y[0]],
        [x[2], y[1]],
        [x[2], y[2]],
    ]
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use approx::assert_relative_eq;

    use super::*;
    use crate::{Form, LowPass, Spectrum, Window};
    use asperity_base::grid::Grid;

    fn summits(heights: Field) -> Summits {
        let (nx, ny) = heights.dim();
        Summits::new(&Topography::new(Grid::new([nx, ny], [0.5, 2.0]).unwrap(), heights).unwrap())
    }

    #[test]
    fn a_sinusoid_has_a_summit_of_its_curvature_on_every_crest() {
        let grid = Grid::new([61, 51], [0.5, 1.0]).unwrap();
        let z = Form::Sinusoid { amplitude: 2.0, wavelength: [10.0, 25.0] }.on(&grid).unwrap();
        let found = Summits::new(&z);
        // cos·cos has crests at (m λx, n λy) from the centre and at (m + ½, n + ½) between: inside the
        // boundary 3 × 1 and 2 × 2.
        assert_eq!(found.summits.len(), 7);
        let curvature = 2.0 * 0.5 * ((TAU / 10.0f64).powi(2) + (TAU / 25.0f64).powi(2));
        for summit in &found.summits {
            // Second differences: relative error (qΔ)²/12; samples up to half a pitch from the crest:
            // (qΔ)²/8.
            assert_relative_eq!(summit.curvature, curvature, max_relative = (TAU / 20.0f64).powi(2) / 4.0);
        }
    }

    #[test]
    fn a_plateau_is_one_summit_unless_it_leads_upwards_or_off_the_map() {
        let mut heights = Field::zeros([12, 9]);
        for sample in [[2, 2], [2, 3], [3, 4]] {
            heights[sample] = 1.0;
        }
        // This plateau rises to a higher sample.
        for sample in [[6, 2], [6, 3], [6, 4]] {
            heights[sample] = 1.0;
        }
        heights[[7, 5]] = 2.0;
        // And this one touches the boundary.
        for sample in [[10, 7], [11, 8], [9, 7]] {
            heights[sample] = 3.0;
        }
        let found = summits(heights);
        let samples: Vec<_> = found.summits.iter().map(|summit| summit.sample).collect();
        assert_eq!(samples, [[2, 2], [7, 5]]);
        assert_eq!(found.area, 10.0 * 7.0);
    }

    #[test]
    fn beside_an_undefined_sample_there_is_no_summit_and_no_area() {
        let mut heights =
            Field::from_shape_fn([9, 9], |(ix, iy)| -((ix as f64 - 4.0).powi(2) + (iy as f64 - 4.0).powi(2)));
        assert_eq!(summits(heights.clone()).summits.len(), 1);
        heights[[5, 5]] = f64::NAN;
        let found = summits(heights);
        assert_eq!((found.summits.len(), found.area), (0, 49.0 - 9.0));
        assert!(
            found.greenwood_williamson().mean_height.is_nan() && found.greenwood_williamson().density == 0.0
        );
        assert!(summits(Field::zeros([2, 5])).greenwood_williamson().density.is_nan());
    }

    #[test]
    fn a_gaussian_surface_has_the_summits_of_nayak() {
        // A flat spectrum up to q_c: m₀ = 1, m₂ = q_c²/4, m₄ = q_c⁴/8, α = 2.
        let (wavelength, seeds) = (24.0, 6);
        let grid = Grid::new([384, 384], [1.0; 2]).unwrap();
        let mut all = Summits { summits: Vec::new(), area: 0.0 };
        let mut predicted = Vec::new();
        for seed in 0..seeds {
            let z = LowPass::new(1.0, [wavelength; 2]).generate(&grid, seed).unwrap();
            let Summits { summits, area } = Summits::new(&z);
            all.summits.extend(summits);
            all.area += area;
            predicted.push(Spectrum::new(&z, Window::Hann).moments().greenwood_williamson());
        }
        let found = all.greenwood_williamson();
        let q2 = (TAU / wavelength).powi(2);
        let pi = std::f64::consts::PI;
        let density = q2 / 2.0 / (6.0 * pi * 3f64.sqrt());
        let radius = 3.0 * pi.sqrt() * 8f64.sqrt() / (8.0 * q2);
        let (mean_height, deviation) = (4.0 / (2.0 * pi).sqrt(), (1.0 - 0.4484f64).sqrt());
        // Summits repel each other, so that their number scatters less than that of independent ones.
        // Sampling lowers the curvature by (qΔ)²/12 of its waves, and heights by no more.
        let count = all.summits.len() as f64;
        let (error, sampling) = (4.0 / count.sqrt(), q2 / 4.0);
        assert_relative_eq!(found.density, density, max_relative = error + sampling);
        assert_relative_eq!(found.radius, radius, max_relative = error + sampling);
        assert_relative_eq!(found.mean_height, mean_height, epsilon = error + sampling);
        assert_relative_eq!(found.height_deviation, deviation, epsilon = error + sampling);
        let mean = |f: fn(&GreenwoodWilliamson) -> f64| predicted.iter().map(f).sum::<f64>() / seeds as f64;
        assert_relative_eq!(mean(|p| p.density), density, max_relative = error);
        assert_relative_eq!(mean(|p| p.radius), radius, max_relative = error);
        assert_relative_eq!(mean(|p| p.mean_height), mean_height, epsilon = error);
        assert_relative_eq!(mean(|p| p.height_deviation), deviation, epsilon = error);
    }
}
