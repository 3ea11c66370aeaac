//! Correlations of the joint conductance of rough surfaces, to compare with.

use crate::grid::{Field, Grid};
use crate::units::{Metre, Pascal};

/// Largest contact fraction for which the correlations are to be compared with: they are fits to clean spots
/// far apart, for a pressure of up to 0.023 of the hardness.
pub const MAX_CORRELATED_FRACTION: f64 = 0.05;

/// Roughness of the sum of two surfaces, on which the correlations are based.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct JointRoughness {
    /// Rms height σ about the mean, m.
    pub height: Metre,
    /// Mean |slope| m along a profile: mean over both axes of differences of neighbouring cells.
    pub slope: f64,
}

impl JointRoughness {
    /// Computes the roughness of the undeformed `gap` of the bodies, m, whose neighbours go across the
    /// boundary where the grid is `periodic`. An axis with a single cell has no slope and does not count.
    ///
    /// # Panics
    /// If the gap has another shape than the grid.
    pub fn new(grid: &Grid, gap: &Field, periodic: [bool; 2]) -> Self {
        assert_eq!(gap.dim(), (grid.shape[0], grid.shape[1]), "shape of the gap");
        let mean = gap.sum() / gap.len() as f64;
        let height = (gap.iter().map(|h| (h - mean) * (h - mean)).sum::<f64>() / gap.len() as f64).sqrt();
        let slopes: Vec<f64> = (0..2)
            .filter(|axis| grid.shape[*axis] > 1)
            .map(|axis| {
                let mut sum = 0.0;
                let mut steps = 0_usize;
                for line in gap.lanes(ndarray::Axis(axis)) {
                    let between =
                        line.iter().zip(line.iter().skip(1)).map(|(one, other)| (other - one).abs());
                    sum += between.sum::<f64>();
                    steps += line.len() - 1;
                    if periodic[axis] {
                        sum += (line[0] - line[line.len() - 1]).abs();
                        steps += 1;
                    }
                }
                sum / (steps as f64 * grid.pitch[axis])
            })
            .collect();
        let slope = if slopes.is_empty() { 0.0 } else { slopes.iter().sum::<f64>() / slopes.len() as f64 };
        Self { height, slope }
    }

    /// Joint conductance h, W/(m² K) or S/m², of surfaces that yield, by the correlation
    ///
    /// ```text
    /// h σ/(κ_s m) = 1.25 (P/H)^0.95
    /// ```
    ///
    /// with the `composite` conductivity κ_s, W/(m K) or S/m, the mean `pressure` P ≥ 0 and the `hardness` H.
    /// `None` for flat surfaces and for an infinite hardness. Computed contacts of self-affine surfaces have
    /// 0.77 to 1.05 of it.
    ///
    /// Cooper, Mikic and Yovanovich, Int. J. Heat Mass Transfer 12, 279 (1969); Yovanovich's constants.
    pub fn cooper_mikic_yovanovich(&self, composite: f64, pressure: Pascal, hardness: Pascal) -> Option<f64> {
        self.scaled(composite, 1.25 * (pressure / hardness).powf(0.95)).filter(|_| hardness.is_finite())
    }

    /// Joint conductance h, W/(m² K) or S/m², of elastic surfaces, by the correlation
    ///
    /// ```text
    /// h σ/(κ_s m) = 1.55 (√2 P/(E* m))^0.94
    /// ```
    ///
    /// with the composite `modulus` E*, and as [`Self::cooper_mikic_yovanovich`] besides; computed contacts
    /// have 0.83 to 1.03 of it.
    ///
    /// Mikic, Int. J. Heat Mass Transfer 17, 205 (1974).
    pub fn mikic(&self, composite: f64, pressure: Pascal, modulus: Pascal) -> Option<f64> {
        self.scaled(composite, 1.55 * (2f64.sqrt() * pressure / (modulus * self.slope)).powf(0.94))
    }

    fn scaled(&self, composite: f64, value: f64) -> Option<f64> {
        let h = composite * self.slope / self.height * value;
        (self.height > 0.0 && self.slope > 0.0 && h.is_finite()).then_some(h)
    }
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;

    use super::*;

    #[test]
    fn a_triangular_wave_has_the_slope_of_its_sides() {
        let grid = Grid::new([8, 3], [0.5, 1.0]).unwrap();
        let gap = Field::from_shape_fn(grid.shape, |(i, _)| (i as f64 - 4.0).abs());
        let roughness = JointRoughness::new(&grid, &gap, [true; 2]);
        // Along y it is level.
        assert_relative_eq!(roughness.slope, 1.0);
        assert_relative_eq!(roughness.height, 1.5f64.sqrt(), max_relative = 1e-14);
        let line = JointRoughness::new(
            &Grid::new([8, 1], [0.5, 1.0]).unwrap(),
            &gap.slice(ndarray::s![.., ..1]).to_owned(),
            [true, false],
        );
        assert_relative_eq!(line.slope, 2.0);
    }

    #[test]
    fn correlations_are_in_proportion_to_slope_over_height_and_flat_surfaces_have_none() {
        let roughness = JointRoughness { height: 1e-6, slope: 0.1 };
        let h = roughness.cooper_mikic_yovanovich(46.0, 1e7, 1e9).unwrap();
        assert_relative_eq!(h, 1.25 * 46.0 * 1e5 * 0.01f64.powf(0.95), max_relative = 1e-14);
        let h = roughness.mikic(46.0, 1e7, 1e11).unwrap();
        assert_relative_eq!(h, 1.55 * 46.0 * 1e5 * (2f64.sqrt() * 1e-3).powf(0.94), max_relative = 1e-14);
        assert_eq!(roughness.cooper_mikic_yovanovich(46.0, 1e7, f64::INFINITY), None);
        let flat = JointRoughness { height: 0.0, slope: 0.0 };
        assert_eq!([flat.mikic(1.0, 1.0, 1.0), flat.cooper_mikic_yovanovich(1.0, 1.0, 1.0)], [None, None]);
    }
}
