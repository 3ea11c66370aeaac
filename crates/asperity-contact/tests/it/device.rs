//! The solver of devices, in plain loops, finds the contacts that the processor finds.

use asperity_base::{CellValues, Error, Field, Grid};
use asperity_contact::kernel::response;
use asperity_contact::material::{Coating, Material};
use asperity_contact::motion::{LoadControl, Motion, Pair, PlasticUpdate, Simulation, Strategy};
use asperity_contact::operator::{Boundary, Deferred, Edge, Operator, Operators};
use asperity_contact::solver::{Bounds, Control, Device, Method, Params, Solution, residual, solve_normal};
use asperity_surface::{Amplitude, SelfAffine};
use rand_chacha::ChaCha8Rng;
use rand_chacha::rand_core::{Rng, SeedableRng};

use crate::support::{Kept, largest, self_affine, steel};

const TOLERANCE: f64 = 1e-7;

/// Random numbers of one contact.
struct Draw(ChaCha8Rng);

impl Draw {
    fn number(&mut self, from: f64, to: f64) -> f64 {
        from + (to - from) * (f64::from(self.0.next_u32()) / f64::from(u32::MAX))
    }

    fn one_of<T: Copy>(&mut self, of: &[T]) -> T {
        of[self.0.next_u32() as usize % of.len()]
    }
}

/// A contact that is drawn from a seed: its operators, gap, bounds and control.
struct Drawn {
    operators: Operators,
    gap: Field,
    bounds: Bounds,
    control: Control,
    grid: Grid,
}

fn draw(seed: u64, largest: usize) -> Drawn {
    let mut draw = Draw(ChaCha8Rng::seed_from_u64(seed));
    let mut side = || (draw.number(16f64.ln(), (largest as f64).ln())).exp().round() as usize;
    let shape = [side(), side()];
    let grid = Grid::new(shape, [draw.number(0.5, 2.0), draw.number(0.5, 2.0)]).unwrap();
    let boundary = draw.one_of(&[
        Boundary::FREE,
        Boundary::PERIODIC,
        Boundary::PERIODIC,
        Boundary([Edge::Periodic, Edge::Free]),
        Boundary([Edge::Free, Edge::Periodic]),
    ]);
    let modulus = draw.number(0.1, 10.0);
    let shortest = draw.one_of(&[None, Some(4.0 * grid.pitch[0].max(grid.pitch[1]))]);
    let form =
        SelfAffine { hurst: draw.number(0.3, 0.9), rolloff: None, shortest, amplitude: Amplitude::Sdq(0.1) };
    let heights = form.generate(&grid, seed).unwrap().into_heights();
    let gap = heights.iter().copied().fold(f64::NEG_INFINITY, f64::max) - heights;
    let pressure = modulus * 0.1;
    let hardness = pressure * draw.number(0.3, 2.0);
    let mut cap = || hardness * draw.number(0.5, 1.5);
    let bounds = match seed % 3 {
        0 => Bounds::ELASTIC,
        1 => Bounds::up_to(hardness),
        _ => Bounds::up_to(CellValues::Field(Field::from_shape_simple_fn(shape, &mut cap))),
    };
    let control = if draw.number(0.0, 1.0) < 0.7 {
        Control::Load(pressure * draw.number(-6.0, -1.5).exp() * grid.area())
    } else {
        // Periodic bodies have no contact beyond their mean gap.
        Control::Approach(gap.mean().unwrap() * draw.number(0.2, 0.8))
    };
    Drawn { operators: Operators::new(grid, modulus, boundary), gap, bounds, control, grid }
}

fn solve(drawn: &Drawn, device: Device, start: Option<&Field>) -> Result<Solution, Error> {
    let Drawn { operators, gap, bounds, control, grid } = drawn;
    let params = Params::new().with_method(Method::ActiveSet).with_tolerance(TOLERANCE).with_device(device);
    solve_normal(operators.on(grid.shape).as_mut(), gap, bounds, *control, start, &params)
}

#[test]
fn random_contacts_agree_with_those_of_the_processor() {
    let mut convolutions = [0.0; 2];
    for seed in 0..200 {
        let drawn = draw(seed, if seed % 20 == 0 { 256 } else { 64 });
        let fail = |e: Error| panic!("contact {seed} on {:?}: {e}", drawn.grid.shape);
        let [found, expected] =
            [Device::Host, Device::Cpu].map(|device| solve(&drawn, device, None).unwrap_or_else(fail));
        convolutions =
            [convolutions[0] + found.stats.convolutions, convolutions[1] + expected.stats.convolutions];
        let error = largest(&(&found.pressure - &expected.pressure)) / largest(&expected.pressure);
        let scale = largest(&expected.displacement);
        let approach = (found.approach - expected.approach).abs() / scale;
        assert!(error < 1e-4 && approach < 1e-6, "contact {seed}: {error:e}, {approach:e}");
        assert!(found.residual < TOLERANCE, "contact {seed}: residual {:e}", found.residual);
        // The residual reported is that of the pressure.
        let mut operator = drawn.operators.on(drawn.grid.shape);
        let mut u = drawn.grid.zeros();
        operator.apply(&found.pressure, &mut u);
        let own = operator.influence(0, 0);
        let prescribed = match drawn.control {
            Control::Approach(approach) => Some(approach),
            Control::Load(_) => None,
        };
        let again = residual(&found.pressure, &u, &drawn.gap, &drawn.bounds, own, prescribed).eta;
        assert!(
            (again - found.residual).abs() < 1e-3 * TOLERANCE,
            "contact {seed}: {again:e}, {:e}",
            found.residual
        );
    }
    // The processor, which moves its free cells with those that go to bounds, needs a little fewer.
    assert!(convolutions[0] < 1.6 * convolutions[1], "{convolutions:?}");
}

#[test]
fn coated_contacts_agree_with_those_of_the_processor() {
    let soft = Material::elastic(1.0, 0.3).unwrap().coated(Coating::new(3.0, 5.0, 0.25).unwrap());
    let rigid = Material::elastic(f64::INFINITY, 0.3).unwrap();
    for boundary in [Boundary::FREE, Boundary::PERIODIC] {
        let plain = draw(1, 64);
        let grid = Grid::new(plain.grid.shape, [1.0; 2]).unwrap();
        let operators = Operators::new(grid, response(&soft, &rigid).unwrap(), boundary);
        let control = Control::Load(0.01 * grid.area());
        let drawn = Drawn { operators, control, grid, ..plain };
        let [found, expected] =
            [Device::Host, Device::Cpu].map(|device| solve(&drawn, device, None).unwrap());
        let error = largest(&(&found.pressure - &expected.pressure));
        assert!(error < 1e-4 * expected.max_pressure(), "{boundary:?}: {error:e}");
    }
}

#[test]
fn flat_bodies_agree_with_those_of_the_processor() {
    let soft = Material::elastic(1.0, 0.3).unwrap().coated(Coating::new(3.0, 5.0, 0.25).unwrap());
    let rigid = Material::elastic(f64::INFINITY, 0.3).unwrap();
    for shape in [[1, 1], [1, 5], [6, 6], [66, 70]] {
        let grid = Grid::new(shape, [1.0; 2]).unwrap();
        // At this approach a periodic contact has all its cells at the hardness.
        for control in [Control::Load(0.01 * grid.area()), Control::Approach(0.03)] {
            for (boundary, coated) in
                [(Boundary::PERIODIC, false), (Boundary::FREE, false), (Boundary::PERIODIC, true)]
            {
                let operators = if coated {
                    Operators::new(grid, response(&soft, &rigid).unwrap(), boundary)
                } else {
                    Operators::new(grid, 1.0, boundary)
                };
                let bounds = Bounds::up_to(0.05);
                let drawn = Drawn { operators, gap: grid.zeros(), bounds, control, grid };
                let [found, expected] =
                    [Device::Host, Device::Cpu].map(|device| solve(&drawn, device, None).unwrap());
                for (found, expected) in found.pressure.iter().zip(&expected.pressure) {
                    let error = (found - expected).abs();
                    assert!(error < 1e-6, "{shape:?}, {boundary:?}, {control:?}: {found}, not {expected}");
                }
            }
        }
    }
}

#[test]
fn a_start_near_the_solution_saves_work() {
    let drawn = draw(7, 64);
    let cold = solve(&drawn, Device::Host, None).unwrap();
    let warm = solve(&drawn, Device::Host, Some(&cold.pressure)).unwrap();
    assert!(warm.stats.convolutions < 0.2 * cold.stats.convolutions);
    assert_eq!(warm.pressure, cold.pressure, "a solution is returned unchanged");
}

#[test]
fn what_a_device_does_not_do_is_said() {
    let Drawn { operators, gap, control, grid, .. } = draw(0, 32);
    let params = Params::new().with_device(Device::Host);
    let refused = |bounds: Bounds, params: &Params| {
        let error = solve_normal(operators.on(grid.shape).as_mut(), &gap, &bounds, control, None, params);
        error.unwrap_err().to_string()
    };
    let adhesive = Bounds::up_to(1.0).above(-0.1);
    assert_eq!(refused(adhesive, &params), "a device does not solve contacts under tension");
    let direct = params.with_method(Method::Direct);
    assert!(refused(Bounds::ELASTIC, &direct).contains("by the active set only"));
}

#[test]
#[cfg(not(feature = "cuda"))]
fn a_program_without_the_feature_says_so() {
    let drawn = draw(3, 32);
    let error = solve(&drawn, Device::Cuda, None).unwrap_err().to_string();
    assert_eq!(
        error,
        "no device for `cuda`: looked for a GPU of NVIDIA with its driver, NVRTC and cuFFT, found a program that was built \
         without the feature `cuda`"
    );
}

#[test]
fn an_operator_that_is_computed_when_needed_is_the_operator() {
    let drawn = draw(2, 48);
    let mut made = drawn.operators.on(drawn.grid.shape);
    let mut deferred = Deferred::new(made.definition().expect("transforms have one"));
    let (mut one, mut other) = (drawn.grid.zeros(), drawn.grid.zeros());
    made.apply(&drawn.gap, &mut one);
    deferred.apply(&drawn.gap, &mut other);
    assert_eq!(one, other);
}

/// Two rough bodies of steel that yield, 32 × 24 cells of 1 µm.
fn pair() -> Pair {
    let grid = Grid::new([32, 24], [1e-6; 2]).unwrap();
    let [lower, upper] = [1, 2].map(|seed| self_affine(&grid, Amplitude::Sq(60e-9), Some(6e-6), seed));
    Pair::new(lower, upper, [&steel(4e9); 2]).unwrap()
}

#[test]
fn passes_in_one_batch_are_those_of_the_processor() {
    let shift = Strategy::Shift { speed_lower: 0.0, speed_upper: 1.0 };
    let cases = [
        (Strategy::Overlap, Boundary::FREE, Control::Load(0.05), LoadControl::Pass, PlasticUpdate::Pass),
        (Strategy::Overlap, Boundary::FREE, Control::Load(0.02), LoadControl::Step, PlasticUpdate::Pass),
        (Strategy::Overlap, Boundary::FREE, Control::Load(0.05), LoadControl::Pass, PlasticUpdate::Step),
        (Strategy::Overlap, Boundary::FREE, Control::Approach(40e-9), LoadControl::Pass, PlasticUpdate::Pass),
        (shift, Boundary::PERIODIC, Control::Load(0.1), LoadControl::Pass, PlasticUpdate::Pass),
    ];
    for (number, (strategy, boundary, control, load_control, update)) in cases.into_iter().enumerate() {
        let run = |device: Device| {
            let motion = Motion::new(strategy, control)
                .with_passes(2)
                .with_stride(5)
                .with_load_control(load_control)
                .with_plastic_update(update)
                .with_load_tolerance(1e-7);
            let params = Params::new().with_tolerance(1e-8).with_device(device);
            Kept::run(Simulation::new(pair(), boundary, motion, params).unwrap())
        };
        let (found, expected) = (run(Device::Host), run(Device::Cpu));
        assert_eq!((found.passes.len(), found.steps.len()), (2, expected.steps.len()));
        for (found, expected) in found.steps.iter().zip(&expected.steps) {
            let close = |found: f64, expected: f64, scale: f64, what: &str| {
                let error = (found - expected).abs() / scale;
                assert!(error < 2e-5, "motion {number}: {what} {found:e}, on the processor {expected:e}");
            };
            close(found.approach, expected.approach, expected.approach.abs(), "approach");
            close(found.load, expected.load, 0.05, "load");
            close(found.max_pressure, expected.max_pressure, 4e9, "largest pressure");
            close(found.plastic_volume, expected.plastic_volume, 1e-20, "plastic volume");
            assert!(found.residual < 1e-8, "motion {number}: residual {:e}", found.residual);
        }
    }
}
