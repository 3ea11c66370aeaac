//! Fatigue below the surface of a body that contacts pass over.
//!
//! Each point sees a stress at each position of a pass, and the pass repeats. [`StressHistory`] computes the stress of all positions depth by
//! depth, and from it Dang Van's f. Nothing fails in the end where f is below the limit b of [`DangVan`]:
//!
//! ```text
//! f = max over the positions of τ + a σh
//! ```
//!
//! σh is the hydrostatic stress, and τ the largest shear of the deviator less s*, the centre of the smallest ball around all deviators in
//! five dimensions: the residual stress that shakedown leaves in a grain.
//!
//! ```
//! use asperity_contact::fatigue::{DangVan, StressHistory};
//! use asperity_contact::operator::Boundary;
//! use asperity_contact::{Field, Grid};
//!
//! // A ridge of pressure that passes over a period.
//! let grid = Grid::new([32, 2], [1.0, 1.0])?;
//! let pressure = |at: usize| Field::from_shape_fn(grid.shape, |(i, _)| if i == at { 1.0 } else { 0.0 });
//! let pass = StressHistory::new(grid, Boundary::PERIODIC, 0.3, 32, |at| (pressure(at), 0.0));
//! let criterion = DangVan::new(1.0, 1.7)?;
//! let found = pass.dang_van(&criterion, &[0.5, 2.0])?;
//! // Each cell sees the same history.
//! assert!(found[0].f.iter().all(|f| (f / found[0].f[[0, 0]] - 1.0).abs() < 1e-9));
//! assert!(found[0].f[[0, 0]] > found[1].f[[0, 0]]);
//! # Ok::<(), asperity_contact::Error>(())
//! ```

mod ball;
mod criterion;
mod damage;
mod history;

pub use criterion::DangVan;
pub use damage::{Basquin, advance_damage, critical_wear, risk};
pub use history::{AtDepth, StressHistory};
