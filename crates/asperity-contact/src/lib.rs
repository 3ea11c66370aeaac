//! Contact of two rough surfaces that are pressed together and moved, by the boundary element method.
//!
//! # Conventions
//!
//! ```text
//! z              up, out of the lower body         gap       g = h + u − δ ≥ 0   (h: undeformed, at δ = 0)
//! pressure   p   positive in compression           approach  δ grows as the bodies move together
//! displacement u positive where it opens the gap   fields    indexed [ix, iy]; metres, pascals, newtons
//! x              the direction of motion           load      W = ΔA Σ p, ΔA the area of a cell
//! stress     σ   positive in tension; z then points from the surface into the loaded body
//! ```
//!
//! Everything is SI and `f64`. Single precision is used only inside iterations. The lower body is described
//! by the height of its surface, the upper one by the height of its underside. The undeformed gap is
//! `h = z₂ − z₁`.
//!
//! # Where to begin
//!
//! Start with [`motion::press`] for a static contact, [`motion::Simulation`] for a motion, or
//! [`solver::solve_normal`] for a contact given only by its gap. Materials, kernels, operators, solvers and
//! closed forms are the modules of [`asperity_elastic`]. Topographies are in [`asperity_surface`]; case files
//! and results on disk are in `asperity-study`.
//!
//! | you have | use | you get |
//! |---|---|---|
//! | statistics or a shape | [`surface::Generator`], [`surface::Form`] | [`surface::Topography`] |
//! | a topography | [`surface::Preparation`], [`surface::Parameters`] | a topography ready for a contact; its roughness parameters (ISO 25178) |
//! | constants of two bodies | [`material::Material`], [`material::Compliances`] | E*, Dundurs' β |
//! | two topographies and materials | [`motion::Pair`] | the argument of [`motion::press`], [`motion::load_in_stages`], [`motion::SlidingContact`] and [`motion::Simulation`] |
//! | a grid and compliances | [`operator::Operators`] | an [`operator::Operator`]: pressure in, displacement out |
//! | an operator and a gap | [`solver::solve_normal`], [`solver::Params`] | [`solver::Solution`] with its [`solver::Stats`] |
//! | an attraction between the surfaces | [`adhesion::Adhesion`], [`motion::Pair::with_interface`], [`solver::solve_adhesive`] | the contact that the bodies reach on their way |
//! | cells in contact and their heat sources | [`temperature::FlashTemperature`], [`temperature::SteadyTemperature`] | their temperature and the heat partition |
//! | cells in contact and conductivities | [`conductance::solve`] | [`conductance::Conductance`]: thermal or electrical |
//! | the deformed gap of a contact | [`flow::solve()`] | its permeability, leakage and critical constriction |
//! | an operator, a gap and an oil | [`lubrication::solve_film`], [`lubrication::FilmSpeeds`] | [`lubrication::FilmSolution`]: from full film to dry contact |
//! | tractions | [`subsurface::Subsurface`] | [`stress::Stress`] plane by plane, and its maximum |
//! | the pressures of a pass that repeats | [`fatigue::StressHistory`] | Dang Van's criterion below the surface |
//! | plastic strain below a surface | [`plasticity::Volume`], [`plasticity::J2`] | its residual stress and displacement, and its growth |
//! | a result to check | [`reference`](mod@reference), [`verification`] | closed forms, and the order of convergence to each |
//!
//! ```
//! use asperity_contact::material::Material;
//! use asperity_contact::motion::{Pair, SlipRegime, press};
//! use asperity_surface::LowPass;
//! use asperity_contact::Grid;
//! use asperity_contact::operator::Boundary;
//! use asperity_contact::solver::{Control, Params};
//!
//! let grid = Grid::new([64, 64], [1e-6; 2])?;
//! let rough = LowPass::new(35e-9, [8e-6; 2]);
//! let steel = Material::new(210e9, 0.3, 2.8e9)?;
//! let (lower, upper) = (rough.generate(&grid, 1)?, rough.generate(&grid, 2)?.underside());
//! let pair = Pair::new(lower, upper, [&steel, &steel])?;
//!
//! let load = Control::Load(0.3);
//! let contact = press(&pair, Boundary::FREE, load, SlipRegime::Frictionless, &Params::default(), &())?;
//! assert!(contact.record.residual < 1e-6 && contact.record.max_pressure <= 2.8e9);
//! assert_eq!(contact.solution.normal().load(), contact.record.load);
//! # Ok::<(), asperity_contact::Error>(())
//! ```
//!
//! # Limits
//!
//! - The bodies are half-spaces: homogeneous, isotropic and linearly elastic. Slopes and strains are small, and the contact
//!   is small compared with the bodies.
//! - Bodies that attract each other ([`mod@adhesion`]) are elastic or have a hardness. They have no elasto-plastic deformation.
//! - A cell yields at the hardness, the upper limit of its pressure. Its surface is truncated there,
//!   which leaves no residual stress.
//! - Friction follows Coulomb's law in each cell, up to a shear strength. All positions of a motion are in gross slip.
//! - There is no inertia. A film of oil ([`lubrication`]) is solved for by itself, not in a motion. Of the materials only viscoelastic ones ([`mod@viscoelastic`]) depend on time, none on
//!   temperature.
//!   [`temperature`] computes the frictional heating of half-spaces with constant properties at a given bulk temperature.
//! - A grid has at most 2³² cells. Roughness shorter than about eight cells is not resolved.
//!
//! # References
//!
//! - K. L. Johnson, *Contact Mechanics*, Cambridge University Press (1985).
//! - I. A. Polonsky, L. M. Keer, Wear 231, 206 (1999): the constrained conjugate gradient method.
//! - H. M. Stanley, T. Kato, J. Tribol. 119, 481 (1997): periodic contact by Fourier transforms.
//! - S. Liu, Q. Wang, G. Liu, Wear 243, 101 (2000): free contact by padded transforms.
//! - J. J. Kalker, *Three-Dimensional Elastic Bodies in Rolling Contact*, Kluwer (1990).
//! - ISO 25178-2:2021 and ISO 21920-2:2021: parameters of areas and of profiles.
//!
//! Each formula names its own source.

// A module may use those above it, never those below: `tests/it/module_order.rs` holds it.
mod math;
pub mod subsurface;
pub mod temperature;
pub mod plasticity;
pub mod viscoelastic;
pub mod lubrication;
pub mod motion;
pub mod with;
pub mod verification;

pub use asperity_base::{choice, error, grid, ndarray, ranks, units};
pub use asperity_elastic::solver::adhesion;
pub use asperity_elastic::{kernel, material, operator, reference, solver, stress};
pub use asperity_surface as surface;
pub use with::{conductance, fatigue, film, flow, joint, wear};

pub use choice::Choice;
pub use error::{Error, Result};
pub use grid::{CellValues, Field, Grid, SingleField};
