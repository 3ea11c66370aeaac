//! Stress at one depth under one pressure after another.

use asperity_transforms::num_complex::Complex64;

use super::{Spectrum, Subsurface, Tractions, is_imaginary};
use crate::grid::{Field, Grid};
use crate::kernel::Traction;
use crate::operator::Boundary;
use crate::stress::Component;
use crate::units::Metre;

/// The stress at one depth of a body under one pressure after another, and under shear tractions along x.
///
/// It keeps the transforms of the influence, which take most of the time of [`Subsurface::plane`]. The results are the same.
pub struct SlidingStress {
    body: Subsurface,
    /// Transforms of the influence of the pressure and of the shear on each component.
    influence: [[Spectrum; 2]; 6],
}

impl SlidingStress {
    /// Creates the stress at `depth` ≥ 0 of a body with Poisson's ratio `poisson`.
    pub fn new(grid: Grid, boundary: Boundary, poisson: f64, depth: Metre) -> Self {
        let body = Subsurface::new(grid, boundary, poisson, &Tractions::frictionless(grid.zeros()));
        let influence = Component::ALL.map(|component| {
            [Traction::Pressure, Traction::X].map(|traction| {
                let imaginary = is_imaginary(traction, component);
                let pair = if imaginary { [None, Some(traction)] } else { [Some(traction), None] };
                let mut symbol = body.symbol(component, pair, depth);
                // Two real tables may share a transform, so that only one part of it belongs to this traction.
                let part = |value: Complex64| match imaginary {
                    true => Complex64::new(0.0, value.im),
                    false => Complex64::new(value.re, 0.0),
                };
                symbol.mapv_inplace(part);
                symbol
            })
        });
        Self { body, influence }
    }

    /// The grid of the plane.
    pub fn grid(&self) -> &Grid {
        self.body.grid()
    }

    /// Computes the components of the stress, Pa, in the order of [`Component::ALL`], under this `pressure` and this `shear` traction along
    /// +x, if there is one.
    pub fn under(&self, pressure: &Field, shear: Option<&Field>) -> [Field; 6] {
        let (pressure, shear) =
            (self.body.fft.forward(pressure), shear.map(|shear| self.body.fft.forward(shear)));
        self.influence.each_ref().map(|[of_pressure, of_shear]| {
            let mut sum = of_pressure * &pressure;
            if let Some(shear) = &shear {
                ndarray::Zip::from(&mut sum).and(of_shear).and(shear).for_each(|sum, g, q| *sum += g * q);
            }
            self.body.fft.inverse_leading(&sum, self.body.grid.shape)
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::operator::Edge;

    #[test]
    fn it_is_the_plane_of_a_body() {
        for boundary in [Boundary::FREE, Boundary::PERIODIC, Boundary([Edge::Free, Edge::Periodic])] {
            let grid = Grid::new([9, 8], [1.0, 0.8]).unwrap();
            let pressure = Field::from_shape_fn(grid.shape, |(i, j)| ((5 * i + 3 * j * j) % 7) as f64);
            for (depth, friction) in [(0.0, 0.0), (0.4, -0.3), (2.0, 0.2)] {
                let stress = SlidingStress::new(grid, boundary, 0.3, depth)
                    .under(&pressure, Some(&(friction * &pressure)));
                let tractions =
                    Tractions { shear: [Some(friction * &pressure), None], pressure: pressure.clone() };
                let plane = Subsurface::new(grid, boundary, 0.3, &tractions).plane(depth);
                for (found, expected) in stress.iter().flatten().zip(plane.stress.iter().flatten()) {
                    assert!(
                        (found - expected).abs() < 1e-12 * 7.0,
                        "{boundary:?} {depth}: {found} {expected}"
                    );
                }
            }
        }
    }
}
