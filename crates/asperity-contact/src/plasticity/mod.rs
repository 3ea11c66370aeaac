//! Elasto-plastic bodies: plastic strain in the volume under a contact, its residual stress and surface
//! displacement.
//!
//! A body is a half-space with [`Layers`] under its surface that may take plastic strain ε, uniform in each
//! cell of each layer. The strain moves with the material, preserves volume and is zero outside the grid.
//!
//! ```text
//! σ = S p + K ε                        stress in the layers
//! r = Sᵀ ε                             inward displacement of the surface
//! g = h − δ + C p + r₁ + r₂ ≥ 0        the gap between two such bodies
//! ```
//!
//! [`Volume`] implements these operators, and [`J2`] determines the growth of ε. Jacq, Nélias,
//! Lormand and Girodin, J. Tribol. 124, 653 (2002); for the operators see [`Volume`].
//!
//! ```
//! use asperity_contact::material::Material;
//! use asperity_contact::plasticity::{CellState, Hardening, J2, Layers, Volume};
//! use asperity_contact::subsurface::Tractions;
//! use asperity_contact::{Field, Grid};
//! use asperity_contact::operator::Boundary;
//!
//! let grid = Grid::new([16, 16], [1e-6; 2])?;
//! let steel = Material::elastic(210e9, 0.3)?;
//! let mut volume = Volume::new(grid, Layers::new(10e-6, 8, 1.1)?, Boundary::FREE, &steel)?;
//! let pressed = Field::from_shape_fn([16, 16], |(i, j)| if (i / 4, j / 4) == (1, 1) { 4e9 } else { 0.0 });
//! let stress = volume.elastic(&Tractions::frictionless(pressed));
//!
//! let law = J2::new(Hardening::linear(1.5e9, 10e9)?);
//! let below: [f64; 6] = std::array::from_fn(|component| stress[[2, component, 6, 6]]);
//! let mean = (below[0] + below[1] + below[2]) / 3.0;
//! let deviator = std::array::from_fn(|c| below[c] - if c < 3 { mean } else { 0.0 });
//! let flowed = law.flow(&deviator, 210e9 / 1.3, &CellState::default()).expect("above its yield stress");
//! assert!(flowed.strain[2] < 0.0, "it is flattened");
//! # Ok::<(), asperity_contact::Error>(())
//! ```

mod anderson;
mod body;
mod contact;
mod law;
mod hardening;
mod images;
mod increment;
mod influence;
mod j2;
mod lanes;
mod layers;
mod residual_stress;
mod sweep;
mod uncovered;
mod volume;
mod waves;

pub use body::{Action, BodyIncrement, PlasticBody, PlasticState, SurfaceDisplacement};
pub use contact::{PlasticContact, RelativePosition};
pub use hardening::Hardening;
pub use increment::{Increment, Loading, PlasticParams, advance};
pub use j2::J2;
pub use law::{CellState, Tensor};
pub use layers::{Layers, MAX_LAYERS};
pub use residual_stress::residual_below;
pub use volume::Volume;

/// Components of a symmetric tensor, in the order of [`crate::stress::Component::ALL`].
const COMPONENTS: usize = 6;

/// Independent components of plastic strain; zz follows from volume preservation.
const INDEPENDENT: [usize; 5] = [0, 1, 3, 4, 5];

/// A symmetric tensor in each cell of each layer: `[layer, component, ix, iy]`, with the components in the
/// order of [`crate::stress::Component::ALL`].
pub type TensorField = ndarray::Array4<f64>;

/// A number in each cell of each layer: `[layer, ix, iy]`.
pub type VolumeField = ndarray::Array3<f64>;
