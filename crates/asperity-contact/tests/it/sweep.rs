//! A load sweep of a static contact: each point is an independent contact, and its stiffness is the slope of
//! the curve.

use asperity_base::{Error, Grid};
use asperity_contact::motion::{
    LoadedContact, Pair, Point, SlipRegime, SweepRecord, SweepState, press, sweep,
};
use asperity_contact::operator::Boundary;
use asperity_contact::solver::{Control, Creep, Friction, Method, Params, Rolling};
use asperity_surface::Amplitude;
use rand::seq::SliceRandom;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use crate::support::{self, over_a_plane, self_affine, steel};

const FINE: Params =
    Params::new().with_method(Method::Auto).with_tolerance(1e-9).with_max_convolutions(10_000);

/// A self-affine surface with slope 0.05 on a plane.
fn rough(shape: [usize; 2], hardness: f64, seed: u64) -> Pair {
    let grid = Grid::new(shape, [1e-6; 2]).unwrap();
    let rough = self_affine(&grid, Amplitude::Sdq(0.05), Some(6e-6), seed);
    over_a_plane(grid, rough.into_heights(), [&steel(hardness); 2])
}

fn ball(cells: usize, pitch: f64) -> Pair {
    let grid = Grid::new([cells; 2], [pitch; 2]).unwrap();
    over_a_plane(grid, support::ball(&grid), [&steel(f64::INFINITY); 2])
}

fn at(control: Control) -> Point {
    Point { control, regime: SlipRegime::Frictionless, speed: None }
}

fn swept(
    pair: &Pair,
    boundary: Boundary,
    points: &[Point],
    params: &Params,
) -> (Vec<SweepRecord>, LoadedContact) {
    sweep(pair, boundary, points, params, SweepState::default(), &(), &mut []).unwrap()
}

#[test]
fn in_any_order_each_point_is_the_contact_of_its_load_alone_bit_by_bit() {
    let mut random = ChaCha8Rng::seed_from_u64(11);
    for n in 0..24 {
        let hardness = if n % 2 == 0 { f64::INFINITY } else { random.random_range(2e9..6e9) };
        let boundary = if n % 4 < 2 { Boundary::FREE } else { Boundary::PERIODIC };
        let shape = [random.random_range(12..80), random.random_range(12..80)];
        let pair = rough(shape, hardness, n);
        let full = pair.lower_grid().area() * 3e9;
        let approach = |random: &mut ChaCha8Rng| {
            let gap = pair.initial_gap(&pair.at_rest());
            let touch = gap.iter().copied().fold(f64::INFINITY, f64::min);
            Control::Approach(touch + random.random_range(-0.1..0.9) * (gap.mean().unwrap() - touch))
        };
        let mut controls: Vec<_> =
            (0..4).map(|_| Control::Load(full * 10f64.powf(random.random_range(-4.0..-0.6)))).collect();
        controls.push(approach(&mut random));
        controls.shuffle(&mut random);
        let points: Vec<_> = controls.iter().copied().map(at).collect();
        let (records, last) = swept(&pair, boundary, &points, &Params::default());
        for (record, control) in records.iter().zip(&controls) {
            let LoadedContact { record: alone, solution, .. } =
                press(&pair, boundary, *control, SlipRegime::Frictionless, &Params::default(), &()).unwrap();
            let area = alone.apparent_area;
            assert_eq!(
                (record.load, record.approach, record.mean_gap, record.contact_area, record.max_pressure),
                (alone.load, alone.approach, alone.mean_gap, alone.contact_area, alone.max_pressure)
            );
            assert_eq!(
                (record.plastic_volume, record.elastic_energy, record.iterations, record.residual),
                (alone.plastic_volume, alone.elastic_energy, alone.iterations, alone.residual)
            );
            assert_eq!(
                (record.mean_pressure, record.contact_fraction),
                (alone.load / area, alone.contact_area / area)
            );
            assert_eq!(record.plastic_area, alone.plastic_cells as f64 * pair.cell_area());
            if record.point == points.len() {
                assert_eq!(
                    (&last.record, &last.solution.normal().pressure),
                    (&alone, &solution.normal().pressure)
                );
            }
        }
    }
}

/// K is the slope of the load over the approach, compared with a central difference over ±0.2 % of the load
/// on accurate pressures. It also holds beyond the elastic range, where the pressure of cells at the hardness
/// is constant.
#[test]
fn the_stiffness_is_the_slope_of_the_load_over_the_approach() {
    let mut random = ChaCha8Rng::seed_from_u64(3);
    for n in 0..16 {
        let hardness = if n % 2 == 0 { f64::INFINITY } else { random.random_range(2e9..5e9) };
        let boundary = if n % 4 < 2 { Boundary::FREE } else { Boundary::PERIODIC };
        let pair = rough([random.random_range(24..64), random.random_range(24..64)], hardness, 100 + n);
        let load = pair.lower_grid().area() * 3e9 * 10f64.powf(random.random_range(-2.5..-0.7));
        let points = [0.998, 1.0, 1.002].map(|share| at(Control::Load(share * load)));
        let (records, _) = swept(&pair, boundary, &points, &FINE);
        let [less, here, more] = [&records[0], &records[1], &records[2]];
        let slope = (more.load - less.load) / (more.approach - less.approach);
        let stiffness = here.stiffness.unwrap();
        // Between the two the set of cells changes, and the slope with it.
        let ends = [less, more].map(|point| point.stiffness.unwrap());
        let change = (ends[1] - ends[0]).abs() + 1e-5 * stiffness;
        assert!((slope - stiffness).abs() <= change, "{n}: {slope:e} {stiffness:e} {ends:?}");
        assert!(change < 0.1 * stiffness, "{n}: {ends:?}");
        if boundary == Boundary::PERIODIC && hardness.is_infinite() {
            // The mean displacement is 0: approach and mean gap are equivalent.
            let of_gap = (more.load - less.load) / (less.mean_gap - more.mean_gap);
            assert!((of_gap / slope - 1.0).abs() < 1e-6, "{of_gap} {slope}");
        }
    }
}

/// K = 2 E* a, a = (3WR/4E*)^⅓; the edge of the contact is known to a fraction of a cell.
#[test]
fn the_stiffness_of_a_ball_is_that_of_hertz() {
    let (modulus, radius) = (210e9 / (2.0 * (1.0 - 0.09)), 1e-3);
    let mut errors = Vec::new();
    for (cells, pitch) in [(64, 1e-6), (128, 0.5e-6), (256, 0.25e-6)] {
        let pair = ball(cells, pitch);
        let loads = [0.2, 1.0, 0.5];
        let (records, _) =
            swept(&pair, Boundary::FREE, &loads.map(|load| at(Control::Load(load))), &Params::default());
        let error = records.iter().zip(loads).map(|(record, load)| {
            let contact_radius = (0.75 * load * radius / modulus).cbrt();
            (record.stiffness.unwrap() / (2.0 * modulus * contact_radius) - 1.0).abs()
        });
        errors.push(error.fold(0.0, f64::max));
    }
    assert!(errors[0] < 8e-3 && errors[1] < 3e-3 && errors[2] < 1.5e-3, "{errors:?}");
}

#[test]
fn what_does_not_touch_has_no_stiffness_and_what_closes_a_period_gives_nowhere() {
    let pair = rough([32, 32], f64::INFINITY, 1);
    let gap = pair.initial_gap(&pair.at_rest());
    let touch = gap.iter().copied().fold(f64::INFINITY, f64::min);
    let full = pair.lower_grid().area() * 1e12;
    let points = [Control::Approach(touch - 1e-9), Control::Load(full)].map(at);
    let (records, _) = swept(&pair, Boundary::PERIODIC, &points, &Params::default());
    assert_eq!((records[0].load, records[0].stiffness), (0.0, Some(0.0)));
    assert_eq!((records[1].contact_fraction, records[1].stiffness), (1.0, None));
}

#[test]
fn what_rolls_is_swept_as_it_rolls_alone() {
    let pair = ball(24, 1e-6);
    let friction = Friction::coulomb(0.3).unwrap();
    let rolling = Rolling { creep: Creep::Creepage([5e-4, 0.0]), spin: 0.0 };
    let regime = SlipRegime::Rolling(friction, rolling);
    let points = [0.1, 0.03].map(|load| Point { control: Control::Load(load), regime, speed: None });
    let params = Params::default().with_tolerance(1e-4);
    let (records, _) = swept(&pair, Boundary::FREE, &points, &params);
    for (record, point) in records.iter().zip(&points) {
        let alone = press(&pair, Boundary::FREE, point.control, regime, &params, &()).unwrap().record;
        let shear = alone.shear.unwrap();
        assert_eq!([record.tangential_force_x, record.tangential_force_y], shear.tangential_force);
        assert_eq!((record.stick_area, record.max_shear), (shear.stick_area, shear.max_shear));
        assert_eq!(([record.creepage_x, record.creepage_y], record.load), ([5e-4, 0.0], alone.load));
        assert!(record.tangential_force_x.abs() > 0.05 * record.load);
    }
}

#[test]
fn a_point_without_an_answer_is_named() {
    let pair = rough([16, 16], 1e9, 1);
    let limit = pair.lower_grid().area() * 1e9;
    let points = [0.1, 1.1, 0.2].map(|share| at(Control::Load(share * limit)));
    let error =
        sweep(&pair, Boundary::FREE, &points, &FINE, SweepState::default(), &(), &mut []).unwrap_err();
    assert!(error.to_string().starts_with("point 2 of 3: load"), "{error}");
    assert!(matches!(
        sweep(&pair, Boundary::FREE, &[], &FINE, SweepState::default(), &(), &mut []),
        Err(Error::Unsupported(_))
    ));
}
