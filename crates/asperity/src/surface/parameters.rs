//! Roughness in numbers, after ISO 25178.

use serde::{Deserialize, Serialize};

use crate::grid::{Field, Grid};
use crate::surface::Topography;
use crate::units::Metre;

/// Height and hybrid parameters of ISO 25178-2 over the defined samples, heights taken from their mean.
///
/// No filter is applied: level and filter first. A parameter without meaning is NaN: all without a defined
/// sample, `ssk` and `sku` of a plane, `sdq` where [`Parameters::sdq`] says so.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct Parameters {
    /// Arithmetical mean height, ⟨|z|⟩.
    #[serde(rename = "Sa")]
    pub sa: Metre,
    /// Root mean square height, √⟨z²⟩.
    #[serde(rename = "Sq")]
    pub sq: Metre,
    /// Skewness, ⟨z³⟩/Sq³; 0 for Gaussian heights.
    #[serde(rename = "Ssk")]
    pub ssk: f64,
    /// Kurtosis, ⟨z⁴⟩/Sq⁴; 3 for Gaussian heights.
    #[serde(rename = "Sku")]
    pub sku: f64,
    /// Maximum height, Sp + Sv.
    #[serde(rename = "Sz")]
    pub sz: Metre,
    /// Height of the highest peak above the mean.
    #[serde(rename = "Sp")]
    pub sp: Metre,
    /// Depth of the deepest pit below the mean, positive.
    #[serde(rename = "Sv")]
    pub sv: Metre,
    /// Root mean square gradient, √⟨(∂z/∂x)² + (∂z/∂y)²⟩.
    ///
    /// The standard defines the integral; the derivatives here are ISO 4287's for the local slope,
    ///
    /// ∂z/∂x = (z₊₃ − 9 z₊₂ + 45 z₊₁ − 45 z₋₁ + 9 z₋₂ − z₋₃)/60Δx,
    ///
    /// right to the sixth power of Δx/wavelength and too small below about four samples per wave. NaN where
    /// no sample has three defined neighbours on every side; there is no slope along a direction with one
    /// sample.
    #[serde(rename = "Sdq")]
    pub sdq: f64,
}

impl Parameters {
    /// The parameters of `topography`.
    pub fn of(topography: &Topography) -> Self {
        let mean = topography.mean();
        let [mut absolute, mut second, mut third, mut fourth] = [0.0; 4];
        let (mut lowest, mut highest) = (f64::NAN, f64::NAN);
        for z in topography.heights().iter().filter(|z| !z.is_nan()).map(|z| z - mean) {
            absolute += z.abs();
            second += z * z;
            third += z * z * z;
            fourth += z * z * z * z;
            lowest = z.min(lowest);
            highest = z.max(highest);
        }
        let count = topography.defined() as f64;
        let sq = (second / count).sqrt();
        Self {
            sa: absolute / count,
            sq,
            ssk: third / count / sq.powi(3),
            sku: fourth / count / sq.powi(4),
            sz: highest - lowest,
            sp: highest,
            sv: -lowest,
            sdq: root_mean_square_gradient(topography.grid(), topography.heights()),
        }
    }
}

impl Topography {
    /// The ISO 25178 parameters of the defined samples.
    pub fn parameters(&self) -> Parameters {
        Parameters::of(self)
    }
}

fn root_mean_square_gradient(grid: &Grid, z: &Field) -> f64 {
    // Samples at the border of a direction that have no slope along it.
    let border = grid.shape.map(|n| if n > 1 { 3 } else { 0 });
    let derivative = |ix: usize, iy: usize, axis: usize| {
        if grid.shape[axis] == 1 {
            return 0.0;
        }
        let pair = |distance: usize| match axis {
            0 => z[[ix + distance, iy]] - z[[ix - distance, iy]],
            _ => z[[ix, iy + distance]] - z[[ix, iy - distance]],
        };
        (pair(3) - 9.0 * pair(2) + 45.0 * pair(1)) / (60.0 * grid.pitch[axis])
    };
    let (mut sum, mut count) = (0.0, 0usize);
    for ix in border[0]..grid.shape[0].saturating_sub(border[0]) {
        for iy in border[1]..grid.shape[1].saturating_sub(border[1]) {
            let squared = derivative(ix, iy, 0).powi(2) + derivative(ix, iy, 1).powi(2);
            if !squared.is_nan() {
                sum += squared;
                count += 1;
            }
        }
    }
    (sum / count as f64).sqrt()
}

#[cfg(test)]
mod tests {
    use std::f64::consts::{FRAC_PI_4, PI, TAU};

    use approx::assert_relative_eq;

    use super::*;
    use crate::surface::Form;

    #[test]
    fn a_sinusoid_has_its_textbook_parameters() {
        let grid = Grid::new([200, 20], [0.1, 0.1]).unwrap();
        let form = Form::Sinusoid { amplitude: 2.0, wavelength: [4.0, f64::INFINITY] };
        let parameters = form.on(&grid).unwrap().parameters();
        // A sum over the n = 40 samples of a wave in place of the integral of |cos|: relative error π²/3n².
        assert_relative_eq!(parameters.sa, 4.0 / PI, max_relative = (PI / 40.0).powi(2));
        assert_relative_eq!(parameters.sq, 2.0 / 2f64.sqrt(), max_relative = 1e-13);
        assert!(parameters.ssk.abs() < 1e-12);
        assert_relative_eq!(parameters.sku, 1.5, max_relative = 1e-12);
        assert_relative_eq!(parameters.sz, 4.0, max_relative = (PI / 40.0).powi(2));
        assert_relative_eq!(parameters.sp + parameters.sv, parameters.sz, max_relative = 1e-14);
        // The samples with three neighbours on every side hold one whole wave; relative error (2π/40)⁶/140.
        let whole = form.on(&Grid::new([46, 20], [0.1, 0.1]).unwrap()).unwrap().parameters();
        assert_relative_eq!(whole.sdq, TAU / 4.0 * 2.0 / 2f64.sqrt(), max_relative = 1.1e-7);
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
            (Topography::new(grid, heights.clone()).unwrap().parameters().sdq / exact - 1.0).abs()
        };
        let (coarse, fine) = (error(16), error(32));
        let order = (coarse / fine).log2();
        assert!(5.8 < order, "error {coarse:e} → {fine:e} is order {order:.2}");
    }

    #[test]
    fn the_gradient_of_a_plane_is_its_slope_around_holes_too() {
        let grid = Grid::new([30, 20], [0.5, 0.25]).unwrap();
        let mut heights =
            Field::from_shape_fn(grid.shape, |(ix, iy)| 3.0 * grid.centre(0, ix) - 4.0 * grid.centre(1, iy));
        heights[[10, 10]] = f64::NAN;
        let parameters = Topography::new(grid, heights).unwrap().parameters();
        assert_relative_eq!(parameters.sdq, 5.0, max_relative = 1e-12);
    }

    #[test]
    fn a_hemispherical_cap_is_skewed_downwards() {
        // z = −(x² + y²)/2R over a square of side 2a: the variance of x² is 4a⁴/45, so Sq² = 2 (4/45) a⁴/4R².
        let grid = Grid::new([400, 400], [0.005, 0.005]).unwrap();
        let parameters = Form::Sphere { radius: 1.0 }.on(&grid).unwrap().parameters();
        assert_relative_eq!(parameters.sq, (2.0 * 4.0 / 45.0 / 4.0f64).sqrt(), max_relative = 1e-4);
        assert!(parameters.ssk < 0.0 && parameters.sp < parameters.sv);
    }

    #[test]
    fn what_has_no_meaning_is_not_a_number() {
        let grid = Grid::new([4, 4], [1.0, 1.0]).unwrap();
        let flat = Form::Flat.on(&grid).unwrap().parameters();
        assert_eq!((flat.sa, flat.sq, flat.sz), (0.0, 0.0, 0.0));
        assert!(flat.ssk.is_nan() && flat.sdq.is_nan());
        let nothing = Topography::new(grid, Field::from_elem([4, 4], f64::NAN)).unwrap().parameters();
        assert!(nothing.sq.is_nan() && nothing.sz.is_nan());
    }

    #[test]
    fn json_carries_the_names_of_the_standard() {
        let grid = Grid::new([8, 1], [FRAC_PI_4, 1.0]).unwrap();
        let heights = Field::from_shape_fn([8, 1], |(ix, _)| (ix as f64 * FRAC_PI_4).sin());
        let json = serde_json::to_value(Topography::new(grid, heights).unwrap().parameters()).unwrap();
        let names: Vec<_> = ["Sa", "Sq", "Ssk", "Sku", "Sz", "Sp", "Sv", "Sdq"].into();
        assert!(names.iter().all(|name| json[name].is_number()), "{json}");
    }
}
