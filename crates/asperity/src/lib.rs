//! Contact of two rough surfaces that press together and move, by the boundary element method.
//!
//! # Conventions
//!
//! ```text
//! z              up, out of the lower body         gap       g = h + u − δ ≥ 0   (h: undeformed, at δ = 0)
//! pressure   p   ≥ 0, positive in compression      approach  δ grows as the bodies move together
//! displacement u positive where it opens the gap   fields    indexed [ix, iy]; metres, pascals, newtons
//! x              the direction of motion           load      W = ΔA Σ p, ΔA the area of a cell
//! ```
//!
//! Everything is SI and `f64`. The lower body is described by the height of its surface, the upper one by the
//! height of its underside; the undeformed gap is `h = z₂ − z₁`.

// A module may use those above it, never those below: `tests/module_order.rs` holds it.
pub mod units;
pub mod error;
pub mod grid;
pub mod math;
pub mod material;
pub mod reference;
pub mod surface;
pub mod kernel;
pub mod operator;
pub mod solver;
pub mod motion;
pub mod verification;
pub mod io;

pub use error::{Error, Result};
pub use grid::{Field, Grid};
