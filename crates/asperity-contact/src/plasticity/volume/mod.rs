//! The plastic volume under a surface, and its elastic operators.

use std::sync::OnceLock;

use super::images::{Coarsening, Images};
use super::influence::Influence;
use super::waves::Waves;
use super::{COMPONENTS, Layers, TensorField};
use crate::error::{Error, Result, check, check_in};
use crate::grid::{Field, Grid};
use crate::kernel::Traction;
use crate::material::Material;
use crate::operator::Boundary;
use crate::subsurface::Tractions;
use crate::units::Dimension;

/// The elastic half-space under a grid, in layers with plastic strain. It computes the stress of tractions
/// and of plastic strain, and the displacement of the surface by plastic strain.
///
/// ```text
/// σ = S p + K ε      Volume::elastic, Volume::residual
/// r = Sᵀ ε           Volume::displacement
/// ```
///
/// Plastic strain ε is traceless (εzz is never read, but computed as −εxx − εyy), uniform in each cell of
/// each layer, a tensor strain, and zero outside the grid. Stress is the mean over each layer, at the centre
/// of each cell. Both are indexed `[layer, component, ix, iy]`, with the components in the order of
/// [`crate::stress::Component::ALL`]. z points into the body. The frame of the upper body is the mirror
/// image: the same x and y, its own z, and its shear tractions reversed.
///
/// - [`Boundary::PERIODIC`]: exact for the harmonics of the grid.
/// - [`Boundary::FREE`]: S and Sᵀ from the closed form of the cell, at two depths per layer; K from a period of twice the
///   size, corrected for its images. The error is below 10⁻³ of the largest residual stress.
pub struct Volume {
    grid: Grid,
    layers: Layers,
    boundary: Boundary,
    material: Material,
    period: [usize; 2],
    influence: [OnceLock<Influence>; 3],
    waves: Waves,
    images: Option<Images>,
    /// Whether the stored strain is not zero throughout.
    strained: bool,
}

impl Volume {
    /// Creates the volume under `grid` of a body with the elastic constants of `material`; its hardness is
    /// ignored.
    ///
    /// # Errors
    /// [`Error::Unsupported`] for a body with layers, or for a boundary that is periodic along one axis alone,
    /// [`Error::OutOfRange`] for a rigid body.
    pub fn new(grid: Grid, layers: Layers, boundary: Boundary, material: &Material) -> Result<Self> {
        if boundary.repeats(0) != boundary.repeats(1) {
            return Err(Error::Unsupported(
                "elasto-plastic bodies do not support a boundary that is periodic along one axis only",
            ));
        }
        if material.is_layered() {
            return Err(Error::Unsupported("a body with layers cannot be elasto-plastic yet"));
        }
        let Material { young, poisson, .. } = *material;
        check_in(
            Dimension::Pressure,
            "young",
            young,
            young.is_finite(),
            "a finite modulus: a rigid body cannot be elasto-plastic",
        )?;
        check("poisson", poisson, (0.0..=0.5).contains(&poisson), "Poisson's ratio from 0 to 0.5")?;
        let free = !boundary.leaves_mean_free();
        let period = if free { grid.shape.map(|n| Coarsening::new(n).period()) } else { grid.shape };
        let waves = Waves::new(&grid, period, &layers, young, poisson);
        let images = free.then(|| Images::new(&grid, &layers, young, poisson));
        Ok(Self {
            grid,
            layers,
            boundary,
            material: material.clone(),
            period,
            influence: Default::default(),
            waves,
            images,
            strained: false,
        })
    }

    /// The grid of the surface.
    pub fn grid(&self) -> &Grid {
        &self.grid
    }

    /// The layers.
    pub fn layers(&self) -> &Layers {
        &self.layers
    }

    /// Continuation of the surface beyond the edges of the grid.
    pub fn boundary(&self) -> Boundary {
        self.boundary
    }

    /// The elastic constants.
    pub fn material(&self) -> &Material {
        &self.material
    }

    /// Creates a tensor field of zeros.
    pub fn zeros(&self) -> TensorField {
        TensorField::zeros([self.layers.count(), COMPONENTS, self.grid.shape[0], self.grid.shape[1]])
    }

    /// Computes ∫ a : b over the volume; with stress and strain it is an energy, J.
    ///
    /// # Panics
    /// If the shape of a field differs.
    pub fn inner_product(&self, a: &TensorField, b: &TensorField) -> f64 {
        assert!(a.dim() == b.dim() && a.dim() == self.zeros_dim(), "shape of the fields");
        let layers = a.outer_iter().zip(b.outer_iter()).enumerate();
        let sum: f64 = layers
            .map(|(layer, (a, b))| {
                let products = a.outer_iter().zip(b.outer_iter()).enumerate().map(|(component, (a, b))| {
                    let sum: f64 = a.iter().zip(b).map(|(a, b)| a * b).sum();
                    if component < 3 { sum } else { 2.0 * sum }
                });
                self.layers.thickness(layer) * products.sum::<f64>()
            })
            .sum();
        self.grid.cell_area() * sum
    }

    /// Applies S: returns the elastic stress under `tractions`, Pa.
    ///
    /// # Panics
    /// If the grid of a traction differs.
    pub fn elastic(&mut self, tractions: &Tractions) -> TensorField {
        let mut stress = self.zeros();
        self.strained = false;
        self.stress(Some(tractions), &mut stress);
        stress
    }

    /// Applies Sᵀ: returns the displacement of the surface along `traction` by plastic strain, m, inward for
    /// the pressure, along +x and +y for the shears. Under a periodic boundary it includes the mean over the
    /// period.
    ///
    /// # Panics
    /// If the shape of the strain differs from that of [`Volume::zeros`].
    pub fn displacement(&mut self, strain: &TensorField, traction: Traction) -> Field {
        self.take(strain);
        self.surface(traction)
    }

    /// Applies K: returns the residual stress of plastic strain, Pa.
    ///
    /// # Panics
    /// If the shape of the strain differs from that of [`Volume::zeros`].
    pub fn residual(&mut self, strain: &TensorField) -> TensorField {
        self.take(strain);
        let mut stress = self.zeros();
        self.stress(None, &mut stress);
        stress
    }

    /// Stores a plastic strain for [`Volume::surface`] and then, once, [`Volume::stress`].
    pub(super) fn take(&mut self, strain: &TensorField) {
        assert_eq!(strain.dim(), self.zeros_dim(), "shape of the strain");
        let strain = strain.as_slice().expect("standard layout");
        self.strained = self.waves.take(strain);
        if let (true, Some(images)) = (self.strained, &mut self.images) {
            images.take(strain);
        }
    }

    /// Resets the stored strain to zero: the body is elastic.
    pub(super) fn reset(&mut self) {
        self.strained = false;
    }

    /// Computes the displacement of the surface along `traction` by the stored strain.
    pub(super) fn surface(&mut self, traction: Traction) -> Field {
        let mut displacement = self.grid.zeros();
        if !self.strained {
            return displacement;
        }
        self.make_influence(traction);
        let influence = self.influence[traction as usize].get().expect("made before");
        self.waves.surface(
            |at, strain, sum| influence.transpose(at, strain, sum),
            displacement.as_slice_mut().expect("standard layout"),
        );
        displacement
    }

    /// Computes the stress under `tractions` and the stored strain.
    pub(super) fn stress(&mut self, tractions: Option<&Tractions>, stress: &mut TensorField) {
        let present: Vec<(Traction, &Field)> = tractions.map(|t| t.present().collect()).unwrap_or_default();
        present.iter().for_each(|(traction, _)| self.make_influence(*traction));
        let (planes, nx) = (&self.waves.planes, self.period[0]);
        let tractions: Vec<_> = present
            .iter()
            .map(|(traction, field)| {
                assert_eq!(field.shape(), self.grid.shape, "shape of the tractions");
                let influence = self.influence[*traction as usize].get().expect("made before");
                let field = field.as_standard_layout();
                (influence, planes.forward(field.as_slice().expect("standard layout")))
            })
            .collect();
        let images = self.images.as_mut().filter(|_| self.strained);
        let images = images.map(|images| {
            images.compute();
            &*images
        });
        self.waves.stress(
            self.strained,
            |[plane, ky], column| {
                for (influence, traction) in &tractions {
                    influence.add([plane, ky], &traction[ky * nx..][..nx], column);
                }
            },
            |row, stress| {
                if let Some(images) = images {
                    images.add(row, stress);
                }
            },
            stress.as_slice_mut().expect("standard layout"),
        );
    }

    fn make_influence(&self, traction: Traction) {
        self.influence[traction as usize].get_or_init(|| {
            let Self { grid, layers, boundary, period, .. } = self;
            Influence::new(grid, *period, *boundary, layers, self.material.poisson, traction)
        });
    }

    fn zeros_dim(&self) -> (usize, usize, usize, usize) {
        (self.layers.count(), COMPONENTS, self.grid.shape[0], self.grid.shape[1])
    }
}

#[cfg(test)]
mod tests;
