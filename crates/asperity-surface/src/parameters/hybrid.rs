//! Hybrid parameters, which depend on heights and lateral lengths together.

use super::row::family;
use super::slope::gradients;
use crate::Topography;
use asperity_base::math::parallel;

family! {
    /// Hybrid parameters of ISO 25178-2:2021, 4.4, over the samples that have a slope.
    ///
    /// The standard defines the integrals; the derivatives are those of ISO 4287 for the local slope,
    ///
    /// ∂z/∂x = (z₊₃ − 9 z₊₂ + 45 z₊₁ − 45 z₋₁ + 9 z₋₂ − z₋₃)/60Δx,
    ///
    /// which are accurate to the sixth power of Δx/wavelength and too small below about four samples per
    /// wave. NaN if no sample has three defined neighbours on every side; the slope along a direction with
    /// one sample is 0.
    HybridParameters: "hybrid" {
        /// Root mean square gradient, √⟨(∂z/∂x)² + (∂z/∂y)²⟩.
        sdq: Number as "Sdq",
        /// Developed interfacial area ratio, ⟨√(1 + (∂z/∂x)² + (∂z/∂y)²) − 1⟩.
        ///
        /// The integral of the standard. The area of triangles between the samples, which some programs use
        /// instead, has an error of the second power of Δx/wavelength. At most Sdq²/2, and close to it if
        /// slopes are small.
        sdr: Share as "Sdr",
    }
}

impl HybridParameters {
    /// Computes the hybrid parameters of `topography`.
    pub fn new(topography: &Topography) -> Self {
        let [squares, excess, count] = parallel::merged(topography.grid().shape, |rows| {
            let mut sums = [0.0; 3];
            for [x, y] in gradients(topography, rows) {
                let square = x * x + y * y;
                sums = [sums[0] + square, sums[1] + area_excess(square), sums[2] + 1.0];
            }
            sums
        });
        Self { sdq: (squares / count).sqrt(), sdr: excess / count }
    }
}

/// √(1 + s) − 1 without cancellation: the relative excess area over the projection for the squared slope
/// `square`.
pub(crate) fn area_excess(square: f64) -> f64 {
    square / ((1.0 + square).sqrt() + 1.0)
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use approx::assert_relative_eq;

    use super::*;
    use crate::Form;
    use asperity_base::grid::{Field, Grid};

    #[test]
    fn a_sinusoid_has_the_slope_and_the_area_of_its_derivative() {
        // The samples with three neighbours on every side span one whole wave; relative error (2π/40)⁶/140.
        let whole = Grid::new([46, 20], [0.1, 0.1]).unwrap();
        let wave = Form::Sinusoid { amplitude: 2.0, wavelength: [4.0, f64::INFINITY] };
        let parameters = HybridParameters::new(&wave.on(&whole).unwrap());
        let steepest = TAU / 4.0 * 2.0;
        assert_relative_eq!(parameters.sdq, steepest / 2f64.sqrt(), max_relative = 1.1e-7);
        let excess = |t: f64| (1.0 + (steepest * (TAU * t).sin()).powi(2)).sqrt() - 1.0;
        let exact = asperity_base::math::integrate(0.0, 1.0, excess);
        // The trapezoidal rule for a periodic function: negligible compared with the error of the slope,
        // which is at most doubled.
        assert_relative_eq!(parameters.sdr, exact, max_relative = 2.2e-7);
    }

    #[test]
    fn the_gradient_is_of_sixth_order_and_knows_both_pitches() {
        let error = |n: usize| {
            let length = TAU;
            let grid = Grid::new([n, 2 * n], [length / n as f64, 0.5 * length / n as f64]).unwrap();
            let heights = Field::from_shape_fn(grid.shape, |(ix, iy)| {
                (0.7 * grid.centre(0, ix) + 0.4).exp() * (grid.centre(1, iy) * 0.3).exp()
            });
            let exact = |ix, iy| heights[[ix, iy]].powi(2) * (0.49 + 0.09);
            let (mut sum, mut count) = (0.0, 0.0);
            for ix in 3..n - 3 {
                for iy in 3..2 * n - 3 {
                    sum += exact(ix, iy);
                    count += 1.0;
                }
            }
            let exact = (sum / count).sqrt();
            (Topography::new(grid, heights.clone()).unwrap().sdq() / exact - 1.0).abs()
        };
        let (coarse, fine) = (error(16), error(32));
        let order = (coarse / fine).log2();
        assert!(5.8 < order, "error {coarse:e} → {fine:e} is order {order:.2}");
    }

    #[test]
    fn slope_and_area_of_a_plane_are_its_own_around_holes_too() {
        let grid = Grid::new([30, 20], [0.5, 0.25]).unwrap();
        let mut heights =
            Field::from_shape_fn(grid.shape, |(ix, iy)| 3.0 * grid.centre(0, ix) - 4.0 * grid.centre(1, iy));
        heights[[10, 10]] = f64::NAN;
        let parameters = HybridParameters::new(&Topography::new(grid, heights).unwrap());
        assert_relative_eq!(parameters.sdq, 5.0, max_relative = 1e-12);
        assert_relative_eq!(parameters.sdr, 26f64.sqrt() - 1.0, max_relative = 1e-12);
    }

    #[test]
    fn the_area_of_gentle_slopes_keeps_its_digits() {
        let grid = Grid::new([9, 9], [1.0; 2]).unwrap();
        let heights = Field::from_shape_fn(grid.shape, |(ix, _)| 1e-9 * ix as f64);
        let parameters = HybridParameters::new(&Topography::new(grid, heights).unwrap());
        assert_relative_eq!(parameters.sdr, 0.5e-18, max_relative = 1e-9);
    }
}
