//! Errors within a course name their place.

use asperity_base::error::Error::{AtPass, AtPosition, AtUpdate, NotConverged};
use asperity_base::{Error, Grid};
use asperity_contact::motion::{Changes, Motion, Pair, Simulation, Slide, SlidingContact, Strategy};
use asperity_contact::operator::Boundary;
use asperity_contact::solver::{Control, Method, Params};
use asperity_surface::{Amplitude, Form};

use crate::support::{archard, self_affine, steel};

fn pair() -> Pair {
    let grid = Grid::new([16, 8], [1e-6; 2]).unwrap();
    let lower = self_affine(&grid, Amplitude::Sq(50e-9), None, 1);
    Pair::new(lower, Form::Flat.on(&grid).unwrap(), [&steel(f64::INFINITY); 2]).unwrap()
}

/// A solver that gives up at once.
fn hasty() -> Params {
    Params::default().with_method(Method::PolonskyKeer).with_max_convolutions(2)
}

fn not_converged(source: &Error) -> bool {
    matches!(source, NotConverged { .. })
}

#[test]
fn a_contact_without_equilibrium_names_its_place() {
    let shift = Strategy::Shift { speed_lower: 0.0, speed_upper: 1.0 };
    let load = Control::Load(0.05);
    let motion = Motion::new(shift, load).with_passes(2);
    let mut simulation = Simulation::new(pair(), Boundary::PERIODIC, motion, hasty()).unwrap();
    let error = simulation.run(&(), &mut []).unwrap_err();
    let AtPosition { pass: 1, positions: 16, source, .. } = &error else { panic!("{error:?}") };
    assert!(not_converged(source), "{error:?}");

    let slide = Slide::graded(1e-3, 3, load);
    let error =
        SlidingContact::new(pair(), Boundary::PERIODIC, slide, hasty()).unwrap().run(None, &(), &mut []);
    let AtUpdate { update: 0, source } = error.as_ref().unwrap_err() else { panic!("{error:?}") };
    assert!(not_converged(source), "{error:?}");

    // All positions are solved together with their wear: no equilibrium within so few convolutions.
    let params = Params::default().with_max_convolutions(4);
    let simulation = Simulation::new(pair(), Boundary::PERIODIC, motion, params).unwrap();
    let simulation = simulation.with_changes(Changes::by(archard([1e-10, 0.0]))).unwrap();
    let error = simulation.solve(&()).map(|_| ()).unwrap_err();
    let AtPass { pass: 1, source } = &error else { panic!("{error:?}") };
    assert!(not_converged(source), "{error:?}");
}
