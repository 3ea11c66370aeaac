//! Bodies in sliding motion: each position compared with the same contact solved alone, and tests of
//! symmetry.

use asperity_base::{Field, Grid};
use asperity_contact::material::Material;
use asperity_contact::motion::{Contact, Motion, Pair, PlasticUpdate, Simulation, Strategy};
use asperity_contact::operator::{Boundary, Operators};
use asperity_contact::solver::{
    Bounds, Control, Friction, Loading, Method, Params, Tangential, solve_frictional,
};
use asperity_surface::{Amplitude, Topography};

use crate::support::{Held, Kept, largest, pass_load, self_affine, step_load};

const GRID: Grid = Grid { shape: [20, 16], pitch: [1e-6, 1.5e-6] };
const PARAMS: Params =
    Params::new().with_method(Method::Auto).with_tolerance(1e-9).with_max_convolutions(10_000);
const LOAD: f64 = 10e-3;

#[test]
fn each_position_of_a_pass_is_the_contact_that_slides_alone() {
    let pair = pair([20e9, 210e9], |z| z);
    let friction = Friction::coulomb(0.3).unwrap().with_shear_strength(400e6);
    let operators = Operators::new(pair.lower_grid(), *pair.compliances(), Boundary::FREE);
    for control in [pass_load(LOAD), step_load(LOAD)] {
        let kept = slide(pair.clone(), Strategy::Overlap, control, Some(friction));
        assert_eq!(kept.len(), 13, "offsets of −18, −15, … 18 columns");
        for contact in &kept {
            let gap = pair.initial_gap(&contact.position);
            let mut operator = operators.coupled_on([contact.position.columns, GRID.shape[1]]);
            let loading = Loading {
                normal: Control::Approach(contact.approach),
                tangential: Tangential::Sliding([1.0, 0.0]),
            };
            let bounds = Bounds::ELASTIC;
            let alone = solve_frictional(operator.as_mut(), &gap, &bounds, &friction, loading, None, &PARAMS)
                .unwrap();
            let most = alone.normal.max_pressure();
            let pressure = contact.pressure_field(GRID.shape[1]);
            assert!(
                (&pressure - &alone.normal.pressure).iter().all(|e| e.abs() <= 1e-5 * most),
                "{:?}, {control:?}",
                contact.position
            );
            let force = alone.force()[0];
            assert!((contact.tangential_force - force).abs() <= 1e-6 * force, "{:?}", contact.position);
        }
        assert!(kept.iter().any(|contact| contact.load > 0.0));
    }
}

/// The bodies mirrored in x slide in the other direction like these in this one. The pressure differs from
/// that without friction.
#[test]
fn sliding_to_the_other_side_is_the_mirror_image() {
    let mirrored = |z: Field| z.slice(ndarray::s![..;-1, ..]).to_owned();
    let friction = Some(Friction::coulomb(0.4).unwrap());
    let shift = |speed_upper| Strategy::Shift { speed_lower: 0.0, speed_upper };
    let control = step_load(LOAD);
    let right = slide(pair([20e9, 210e9], |z| z), shift(1.0), control, friction);
    let left = slide(pair([20e9, 210e9], mirrored), shift(-1.0), control, friction);
    let alone = slide(pair([20e9, 210e9], |z| z), shift(1.0), control, None);
    assert_eq!(right.len(), 7);
    for ((one, other), alone) in right.iter().zip(&left).zip(&alone) {
        assert_eq!(one.position.offset, -other.position.offset);
        assert!((one.tangential_force / (0.4 * LOAD) - 1.0).abs() < 1e-9);
        assert!((other.tangential_force / one.tangential_force + 1.0).abs() < 1e-9);
        let [p, image, free] = [one, other, alone].map(|contact| contact.pressure_field(GRID.shape[1]));
        let most = one.max_pressure();
        let error = |a: &Field, b: &Field| largest(&(a - b)) / most;
        assert!(error(&mirrored(image), &p) < 1e-6);
        assert!(error(&free, &p) > 1e-2, "friction moves the pressure of dissimilar bodies");
    }
}

#[test]
fn identical_bodies_slide_under_the_pressures_of_no_friction() {
    let control = pass_load(LOAD);
    let run = |friction| slide(pair([210e9, 210e9], |z| z), Strategy::Overlap, control, friction);
    let (sliding, free) = (run(Some(Friction::coulomb(0.3).unwrap())), run(None));
    for (one, other) in sliding.iter().zip(&free) {
        assert_eq!((&one.pressure, one.approach), (&other.pressure, other.approach));
        assert_eq!(other.tangential_force, 0.0);
        assert!((one.tangential_force - 0.3 * one.load).abs() <= 1e-14 * one.load);
    }
}

/// Two rough bodies with these moduli, with their heights changed by `arranged`.
fn pair(young: [f64; 2], arranged: impl Fn(Field) -> Field) -> Pair {
    let surface = |seed| {
        let heights = self_affine(&GRID, Amplitude::Sq(35e-9), Some(6e-6), seed).into_heights();
        Topography::new(GRID, arranged(heights)).unwrap()
    };
    let [lower, upper] = young.map(|young| Material::elastic(young, 0.3).unwrap());
    Pair::new(surface(1), surface(2), [&lower, &upper]).unwrap()
}

/// The contacts of one pass in strides of three columns.
fn slide(
    pair: Pair,
    strategy: Strategy,
    (control, load_control): Held,
    friction: Option<Friction>,
) -> Vec<Contact> {
    let motion = Motion::new(strategy, control)
        .with_passes(1)
        .with_stride(3)
        .with_load_control(load_control)
        .with_plastic_update(PlasticUpdate::Pass)
        .with_load_tolerance(1e-4)
        .with_friction(friction);
    Kept::run(Simulation::new(pair, Boundary::FREE, motion, PARAMS).unwrap()).contacts.remove(0)
}
