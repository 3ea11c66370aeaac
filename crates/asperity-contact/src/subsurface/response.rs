//! Stress at one depth under one contact after another.

use std::sync::OnceLock;

use asperity_transforms::num_complex::Complex64;

use super::{Inside, Spectrum, Subsurface, Tractions, is_imaginary};
use crate::grid::{Field, Grid};
use crate::kernel::{Stack, Traction};
use crate::operator::Boundary;
use crate::stress::Component;
use crate::units::Metre;

/// The stress at one depth of a body under the tractions of one contact after another.
///
/// It keeps the transforms of the influence, which take most of the time of [`Subsurface::plane`]. The
/// results are the same.
pub struct StressAtDepth {
    body: Subsurface,
    depth: Metre,
    /// Stress per unit of each traction, of a body with layers.
    inside: Option<Inside>,
    /// Transforms of the influence of the pressure and of the shear along x and y on each component, each
    /// computed when it is first needed.
    influence: [OnceLock<[Spectrum; 6]>; 3],
}

impl StressAtDepth {
    /// Creates the stress at `depth` ≥ 0 of a body with Poisson's ratio `poisson`.
    pub fn new(grid: Grid, boundary: Boundary, poisson: f64, depth: Metre) -> Self {
        let body = Subsurface::new(grid, boundary, poisson, &Tractions::frictionless(grid.zeros()));
        Self { body, depth, inside: None, influence: Default::default() }
    }

    /// Sets or removes layers on the body. At an interface the stress is that below, but that above on a rigid base.
    pub fn with_layers(self, stack: impl Into<Option<Stack>>) -> Self {
        let body = self.body.with_layers(stack);
        let inside = body.inside(body.layer_at(self.depth), self.depth);
        Self { body, inside, ..self }
    }

    /// The grid of the plane.
    pub fn grid(&self) -> &Grid {
        self.body.grid()
    }

    /// Computes the components of the stress, Pa, in the order of [`Component::ALL`], under these
    /// `tractions`.
    ///
    /// # Panics
    /// If the shape of a traction differs from that of the grid.
    pub fn under(&self, tractions: &Tractions) -> [Field; 6] {
        let Tractions { pressure, shear: [x, y] } = tractions;
        let all =
            [(Traction::Pressure, Some(pressure)), (Traction::X, x.as_ref()), (Traction::Y, y.as_ref())];
        let present: Vec<_> = all
            .into_iter()
            .zip(&self.influence)
            .filter_map(|((traction, field), influence)| {
                let field = field.filter(|field| field.iter().any(|value| *value != 0.0))?;
                assert_eq!(field.shape(), self.grid().shape, "shape of the tractions");
                let influence = influence.get_or_init(|| self.influence_of(traction));
                Some((influence, self.body.fft.forward(field)))
            })
            .collect();
        std::array::from_fn(|component| {
            let mut sum = Spectrum::zeros([self.body.fft.shape()[0], self.body.fft.half()]);
            for (influence, traction) in &present {
                ndarray::Zip::from(&mut sum)
                    .and(&influence[component])
                    .and(traction)
                    .for_each(|sum, g, q| *sum += g * q);
            }
            self.body.fft.inverse_leading(&sum, self.body.grid.shape)
        })
    }

    /// Returns the transforms of the influence of a traction on each component.
    fn influence_of(&self, traction: Traction) -> [Spectrum; 6] {
        Component::ALL.map(|component| {
            let imaginary = is_imaginary(traction, component);
            let pair = if imaginary { [None, Some(traction)] } else { [Some(traction), None] };
            let mut symbol = self.body.symbol(component, pair, self.depth, self.inside.as_ref());
            // Two real tables may share a transform, so that only one part of it belongs to this traction.
            let part = |value: Complex64| {
                if imaginary { Complex64::new(0.0, value.im) } else { Complex64::new(value.re, 0.0) }
            };
            symbol.mapv_inplace(part);
            symbol
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::material::{Coating, Material};
    use crate::operator::Edge;

    #[test]
    fn it_is_the_plane_of_a_body() {
        for boundary in [Boundary::FREE, Boundary::PERIODIC, Boundary([Edge::Free, Edge::Periodic])] {
            let grid = Grid::new([9, 8], [1.0, 0.8]).unwrap();
            let pressure = Field::from_shape_fn(grid.shape, |(i, j)| ((5 * i + 3 * j * j) % 7) as f64);
            for (depth, x, y) in [(0.0, 0.0, 0.1), (0.4, -0.3, 0.0), (2.0, 0.2, -0.4)] {
                let shear = [x, y].map(|friction| Some(friction * &pressure));
                let tractions = Tractions { shear, pressure: pressure.clone() };
                let at_depth = || StressAtDepth::new(grid, boundary, 0.3, depth);
                let body = || Subsurface::new(grid, boundary, 0.3, &tractions);
                let coated =
                    Material::elastic(1.0, 0.3).unwrap().coated(Coating::new(0.4, 5.0, 0.2).unwrap());
                let layers = || Stack::new(&coated);
                for (stress, plane) in [
                    (at_depth().under(&tractions), body().plane(depth)),
                    (
                        at_depth().with_layers(layers()).under(&tractions),
                        body().with_layers(layers()).plane(depth),
                    ),
                ] {
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
}
