//! A lubricant between the bodies, from full film to dry contact in one problem.
//!
//! Film, cavitation and contact are complementary pairs of one nonlinear system ([`FilmProblem`]), which
//! [`solve_film`] solves by one Newton method. Nothing is switched off where the film is thin: at low speeds the
//! answer is the dry contact. [`FilmSpeeds`] follows a Stribeck curve, [`FilmForces`] has its friction, and an
//! [`OilStep`] takes the film of one position to the next.
//!
//! ```
//! use asperity_contact::lubrication::{FilmForces, FilmParams, FilmProblem, FilmSpeeds, Oil, Shear};
//! use asperity_contact::operator::{Boundary, FreeFft};
//! use asperity_contact::solver::Control;
//! use asperity_contact::{Field, Grid};
//!
//! // A steel ball of 10 mm radius with waves of 40 nm on a plate, under 2 N.
//! let grid = Grid::new([40, 32], [6e-6; 2])?;
//! let gap = Field::from_shape_fn(grid.shape, |(ix, iy)| {
//!     let [x, y] = [(0, ix), (1, iy)].map(|(axis, i)| grid.centre(axis, i) - 0.5 * grid.extent()[axis]);
//!     (x * x + y * y) / 20e-3 + 40e-9 * (1e5 * x).cos() * (1e5 * y).cos()
//! });
//! let mut operator = FreeFft::new(grid, 115e9);
//! let problem = FilmProblem {
//!     gap: &gap,
//!     oil: Oil::new(0.04, 20e-9)?,
//!     speed: 1.0,
//!     boundary_film: 2e-9,
//!     control: Control::Load(2.0),
//!     ends: [0.0; 2],
//!     step: None,
//! };
//! let mut speeds = FilmSpeeds::new(&mut operator, &problem, FilmParams::default())?;
//! for (speed, solids, friction) in [(1e-4, 0.9..=1.0, 0.11..=0.12), (1.0, 0.0..=0.0, 0.03..=0.06)] {
//!     let film = speeds.film_at(&mut operator, speed)?.solution;
//!     let problem = FilmProblem { speed, ..problem };
//!     // A body at rest, and one at twice the mean speed.
//!     let forces = FilmForces::new(&problem, &film, &grid, Boundary::FREE, 2.0 * speed, Shear::Limited(0.05));
//!     assert!(solids.contains(&forces.solid_share()), "{forces:?}");
//!     assert!(friction.contains(&forces.friction_coefficient(0.12)), "{forces:?}");
//! }
//! # Ok::<(), asperity_contact::Error>(())
//! ```

mod between;
mod film;
mod flow;
mod forces;
mod fronts;
mod named;
mod near;
mod newton;
mod oil;
mod speeds;
mod state;
mod zone;

pub use between::Lubrication;
pub use film::{Film, FilmParams, FilmProblem, FilmSolution, solve_film};
pub use flow::OilStep;
pub use forces::{FilmForces, Shear};
pub use named::{NamedOil, OIL_NAMES, OILS};
pub use oil::{CompressedOil, FreeVolume, Oil, ViscosityLaw};
pub use speeds::{FilmAtSpeed, FilmSpeeds, SolvedFilm};
pub use zone::ContactZone;
