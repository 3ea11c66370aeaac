//! Helpers shared by several tests.

pub(crate) mod cell_by_cell;
pub(crate) mod dense;

use asperity_contact::motion::LoadControl;
use asperity_contact::solver::Control;

/// Checks that numbers agree to `tolerance` of the largest expected one.
#[track_caller]
pub(crate) fn assert_close(got: &[f64], expected: &[f64], tolerance: f64, what: &str) {
    assert_eq!(got.len(), expected.len(), "{what}");
    let scale = expected.iter().fold(f64::MIN_POSITIVE, |m, v| m.max(v.abs()));
    for (k, (a, b)) in got.iter().zip(expected).enumerate() {
        assert!((a - b).abs() <= tolerance * scale, "{what} at {k}: {a:e}, expected {b:e}");
    }
}

/// Prescribed load or approach of a motion, and where a load holds.
pub(crate) type Held = (Control, LoadControl);

pub(crate) fn pass_load(load: f64) -> Held {
    (Control::Load(load), LoadControl::Pass)
}

pub(crate) fn step_load(load: f64) -> Held {
    (Control::Load(load), LoadControl::Step)
}

pub(crate) fn at_approach(approach: f64) -> Held {
    (Control::Approach(approach), LoadControl::Pass)
}
