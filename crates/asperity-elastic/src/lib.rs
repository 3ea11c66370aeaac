//! Contact of elastic half-spaces by the boundary element method: influence coefficients, operators, solvers
//! with a residual, and closed forms. A contact is given by its gap.
//!
//! # Conventions
//!
//! ```text
//! pressure     p   positive in compression           gap       g = h + u − δ ≥ 0   (h: undeformed, at δ = 0)
//! displacement u   positive where it opens the gap   approach  δ grows as the bodies move together
//! stress       σ   positive in tension               load      W = ΔA Σ p, ΔA the area of a cell
//! z                into the loaded body              fields    indexed [ix, iy]; metres, pascals, newtons
//! ```
//!
//! Everything is SI and `f64`. Single precision is used only inside iterations.
//!
//! # Where to begin
//!
//! | you have | use | you get |
//! |---|---|---|
//! | constants of two bodies | [`material::Material`], [`material::Compliances`] | E*, Dundurs' β |
//! | a grid and compliances | [`operator::Operators`] | an [`operator::Operator`]: pressure in, displacement out |
//! | an operator and a gap | [`solver::solve_normal`], [`solver::Params`] | [`solver::Solution`] with its [`solver::Stats`] |
//! | a contact with friction, or one that rolls | [`solver::solve_frictional`], [`solver::solve_rolling`] | its shear, stick and slip |
//! | a traction on a surface | [`kernel::cell_stress`](kernel::subsurface::cell_stress) | [`stress::Stress`] below it |
//! | a result to check | [`reference`](mod@reference) | closed forms |
//!
//! ```
//! use asperity_elastic::{Field, Grid};
//! use asperity_elastic::operator::FreeFft;
//! use asperity_elastic::reference::HertzSphere;
//! use asperity_elastic::solver::{Bounds, Control, Params, solve_normal};
//!
//! // A sphere of radius 1 mm on a half-space of E* = 100 GPa.
//! let (radius, modulus, load) = (1e-3, 100e9, 1.0);
//! let grid = Grid::new([64, 64], [1e-6; 2])?;
//! let gap = Field::from_shape_fn(grid.shape, |(ix, iy)| {
//!     let [x, y] = [(0, ix), (1, iy)].map(|(axis, i)| grid.centre(axis, i) - 0.5 * grid.extent()[axis]);
//!     (x * x + y * y) / (2.0 * radius)
//! });
//! let mut operator = FreeFft::new(grid, modulus);
//! let params = Params::default();
//! let solution = solve_normal(&mut operator, &gap, &Bounds::ELASTIC, Control::Load(load), None, &params)?;
//!
//! let hertz = HertzSphere { radius, modulus, load };
//! assert!((solution.approach / hertz.approach() - 1.0).abs() < 0.01);
//! # Ok::<(), asperity_elastic::Error>(())
//! ```
//!
//! Surfaces that move over each other are in `asperity-contact`, which re-exports these modules.

// A module may use those above it, never those below: a test of the crate `asperity` holds it.
pub mod math;
pub mod stress;
pub mod material;
pub mod reference;
pub mod kernel;
pub mod operator;
pub mod solver;

pub use asperity_base::{choice, error, grid, ndarray, ranks, units};

pub use choice::Choice;
pub use error::{Error, Result};
pub use grid::{CellValues, Field, Grid, SingleField};
