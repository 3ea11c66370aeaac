//! Curved bodies: the paraboloid closest to a gap.

use std::f64::consts::SQRT_2;

use crate::grid::Field;
use crate::reference::HertzEllipse;
use crate::solver::Control;
use crate::units::{Metre, Pascal};
use asperity_base::math::parallel;
use asperity_base::math::sum::sums;
use asperity_base::ranks::Merged;

/// The paraboloid closest to a gap, by least squares over all cells.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Paraboloid {
    /// Principal curvatures, the larger one first; positive where the gap opens outwards.
    pub curvatures: [f64; 2],
    /// Direction of the larger curvature, (cos φ, sin φ).
    pub direction: [f64; 2],
    /// The lowest point, relative to the corner of the grid; along a straight line, the centre.
    pub apex: [Metre; 2],
    /// Size of the grid along x and y.
    pub extent: [Metre; 2],
    /// Size of a cell along x and y.
    pub pitch: [Metre; 2],
}

impl Paraboloid {
    /// Fits the paraboloid closest to `gap`. Returns `None` if it explains less than nine tenths of the
    /// variance of the gap about a plane: such a gap is rough rather than curved.
    pub fn fit(gap: &Field, pitch: [Metre; 2]) -> Option<Self> {
        /// Smallest fraction of the variance of the gap that a paraboloid must explain.
        const DOMINATES: f64 = 0.9;
        let shape = [gap.nrows(), gap.ncols()];
        // On a full grid these six are orthogonal: 1, x, y, x² − its mean, y² − its mean, xy.
        let places = [0, 1].map(|axis| {
            let middle = 0.5 * (shape[axis] as f64 - 1.0);
            (0..shape[axis]).map(|i| (i as f64 - middle) * pitch[axis]).collect::<Vec<f64>>()
        });
        let squares = [0, 1].map(|axis| {
            let mean = places[axis].iter().map(|s| s * s).sum::<f64>() / shape[axis] as f64;
            places[axis].iter().map(|s| s * s - mean).collect::<Vec<f64>>()
        });
        let mean = gap.mean()?;
        let [y, yy] = [&places[1], &squares[1]];
        let of_row = |i: usize| {
            let row = gap.row(i);
            let row = row.to_slice().expect("standard layout");
            let [h, hy, hyy, hh] =
                sums(row, |j, h| [h - mean, (h - mean) * y[j], (h - mean) * yy[j], (h - mean).powi(2)]);
            [places[0][i] * h, hy, squares[0][i] * h, hyy, places[0][i] * hy, hh]
        };
        let [x_sum, y_sum, xx_sum, yy_sum, xy_sum, variance] =
            parallel::merged(shape, |rows| Merged::of_parts(rows.map(of_row)));
        let norm = |values: &[f64]| values.iter().map(|value| value * value).sum::<f64>();
        let (rows, columns) = (shape[0] as f64, shape[1] as f64);
        let products = [
            [x_sum, columns * norm(&places[0])],
            [y_sum, rows * norm(y)],
            [xx_sum, columns * norm(&squares[0])],
            [yy_sum, rows * norm(yy)],
            [xy_sum, norm(&places[0]) * norm(y)],
        ];
        let coefficient = |[product, norm]: [f64; 2]| if norm > 0.0 { product / norm } else { 0.0 };
        let told = |[product, norm]: [f64; 2]| if norm > 0.0 { product * product / norm } else { 0.0 };
        let planar = variance - told(products[0]) - told(products[1]);
        let curved: f64 = products[2..].iter().map(|product| told(*product)).sum();
        if !(curved > DOMINATES * planar && curved > 1e-12 * variance) {
            return None;
        }
        let [tilt_x, tilt_y, xx, yy, xy] = products.map(coefficient);
        let (xx, yy) = (2.0 * xx, 2.0 * yy);
        let (middle, half) = (0.5 * (xx + yy), (0.5 * (xx - yy)).hypot(xy));
        let curvatures = [middle + half, middle - half];
        let angle = 0.5 * xy.atan2(0.5 * (xx - yy));
        let direction = [angle.cos(), angle.sin()];
        // Along each principal direction the slope vanishes at the lowest point.
        let across = [-direction[1], direction[0]];
        let least = 1e-6 * curvatures[0].abs().max(curvatures[1].abs());
        let mut apex = [0, 1].map(|axis| 0.5 * shape[axis] as f64 * pitch[axis]);
        for (curvature, [x, y]) in curvatures.into_iter().zip([direction, across]) {
            if curvature.abs() > least {
                let distance = -(tilt_x * x + tilt_y * y) / curvature;
                apex = [apex[0] + distance * x, apex[1] + distance * y];
            }
        }
        let extent = [0, 1].map(|axis| shape[axis] as f64 * pitch[axis]);
        Some(Self { curvatures, direction, apex, extent, pitch })
    }

    /// Whether the gap does not open outwards in all directions: a line contact, a saddle or a hollow.
    pub fn is_endless(&self) -> bool {
        self.curvatures[1] <= 1e-6 * self.curvatures[0]
    }

    /// Axis of a line contact: that of the smaller curvature.
    pub fn line(&self) -> usize {
        usize::from(self.direction[0].abs() > 1.0 / SQRT_2)
    }

    /// Returns Hertz' contact of the paraboloid under `control`, with the approach relative to the gap
    /// `touch`. `None` if the gap does not open outwards in all directions, or if nothing presses.
    pub fn hertz(&self, modulus: Pascal, control: Control, touch: Metre) -> Option<HertzEllipse> {
        if self.is_endless() {
            return None;
        }
        let contact = |load: f64| HertzEllipse::new(self.curvatures.map(f64::recip), modulus, load);
        let load = match control {
            Control::Load(load) => load,
            // δ is proportional to W^⅔.
            Control::Approach(approach) => ((approach - touch).max(0.0) / contact(1.0).approach).powf(1.5),
        };
        (load > 0.0 && load.is_finite()).then(|| contact(load))
    }
}
