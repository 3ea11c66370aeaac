//! Contact of two rough surfaces that press together and move, by the boundary element method.
//!
//! # Conventions
//!
//! ```text
//! z              up, out of the lower body         gap       g = h + u − δ ≥ 0   (h: undeformed, at δ = 0)
//! pressure   p   ≥ 0, positive in compression      approach  δ grows as the bodies move together
//! displacement u positive where it opens the gap   fields    indexed [ix, iy]; metres, pascals, newtons
//! x              the direction of motion           load      W = ΔA Σ p, ΔA the area of a cell
//! stress     σ   positive in tension; z then points from the surface into the body that bears it
//! ```
//!
//! Everything is SI and `f64`; single precision serves the steps of an iteration only. The lower body is described by the height of its surface, the upper one by the
//! height of its underside; the undeformed gap is `h = z₂ − z₁`.
//!
//! # Where to begin
//!
//! [`motion::press`] for a static contact, [`motion::Simulation`] for a motion, [`study::run()`] for a case file;
//! [`solver::solve_normal`] for a contact of which only the gap is known.
//!
//! ```
//! use asperity::material::Material;
//! use asperity::motion::{Pair, press};
//! use asperity::surface::LowPass;
//! use asperity::{Grid, operator::Boundary, solver};
//!
//! let grid = Grid::new([64, 64], [1e-6; 2])?;
//! let rough = LowPass::new(35e-9, [8e-6; 2]);
//! let steel = Material::new(210e9, 0.3, 2.8e9)?;
//! let (lower, upper) = (rough.generate(&grid, 1)?, rough.generate(&grid, 2)?.underside());
//! let pair = Pair::new(lower, upper, [&steel, &steel])?;
//!
//! let load = solver::Control::Load(0.3);
//! let contact = press(&pair, Boundary::FREE, load, &solver::Params::default())?;
//! assert!(contact.record.residual < 1e-6 && contact.record.max_pressure <= 2.8e9);
//! assert_eq!(contact.solution.load(), contact.record.load);
//! # Ok::<(), asperity::Error>(())
//! ```

// A module may use those above it, never those below: `tests/it/module_order.rs` holds it.
pub mod units;
pub mod error;
pub mod grid;
pub mod io;
pub mod math;
pub mod stress;
pub mod material;
pub mod reference;
pub mod surface;
pub mod kernel;
pub mod operator;
pub mod solver;
pub mod subsurface;
pub mod motion;
pub mod verification;
pub mod study;

pub use error::{Error, Result};
pub use grid::{CellValues, Field, Grid, SingleField};

/// The programs in the README are tests.
#[cfg(doctest)]
#[doc = include_str!("../../../README.md")]
struct Readme;
