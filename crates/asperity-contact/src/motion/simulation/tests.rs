//! Tests of the motion.

use super::*;
use crate::grid::Field;
use crate::material::Material;
use crate::motion::PassRecord;
use crate::solver::Method;
use crate::surface::{Amplitude, SelfAffine};

struct Reports(Vec<PassRecord>);

impl Output for Reports {
    fn step(&mut self, step: &Step<'_>) -> Result<()> {
        self.0.extend(step.pass().map(|report| report.record.clone()));
        Ok(())
    }
}

fn passes(strategy: Strategy, boundary: Boundary, together: bool) -> Vec<PassRecord> {
    let grid = crate::grid::Grid::new([32, 24], [1e-6, 1.5e-6]).unwrap();
    let form =
        SelfAffine { hurst: 0.8, rolloff: None, shortest: Some(6e-6), amplitude: Amplitude::Sq(0.1e-6) };
    let steel = Material::new(210e9, 0.3, 3e9).unwrap();
    let surface = |seed| form.generate(&grid, seed).unwrap();
    let pair = Pair::new(surface(1), surface(2), [&steel, &steel]).unwrap();
    let motion = Motion::new(strategy, Control::Load(0.05 * 3e9 * grid.area()))
        .with_passes(3)
        .with_stride(1)
        .with_load_tolerance(1e-6);
    let mut simulation =
        Simulation::new(pair, boundary, motion, Params::new().with_method(Method::ActiveSet)).unwrap();
    assert!(simulation.together);
    simulation.together = together;
    let mut reports = Reports(Vec::new());
    simulation.run(&(), &mut [&mut reports]).unwrap();
    reports.0
}

#[test]
fn cells_that_never_yield_bear_what_those_that_do_leave_them() {
    let grid = crate::grid::Grid::new([12, 8], [1e-6; 2]).unwrap();
    let form = SelfAffine { hurst: 0.8, rolloff: None, shortest: None, amplitude: Amplitude::Sq(5e-9) };
    let steel = Material::new(210e9, 0.3, f64::INFINITY).unwrap();
    let surface = |seed| form.generate(&grid, seed).unwrap();
    let pair = Pair::new(surface(1), surface(2), [&steel, &steel]).unwrap();
    let soft = Field::from_shape_fn([12, 8], |(i, _)| if i % 4 < 2 { 0.1e9 } else { f64::INFINITY });
    let pair = pair.with_hardness([soft.into(), f64::INFINITY.into()]).unwrap();
    let load = 1e9 * grid.area();
    let motion = Motion::new(Strategy::Shift { speed_lower: 0.0, speed_upper: 1.0 }, Control::Load(load))
        .with_passes(1)
        .with_stride(3)
        .with_load_tolerance(1e-4);
    for method in [Method::Direct, Method::ActiveSet] {
        let params = Params::new().with_method(method);
        let mut simulation = Simulation::new(pair.clone(), Boundary::PERIODIC, motion, params).unwrap();
        let mut reports = Reports(Vec::new());
        simulation.run(&(), &mut [&mut reports]).unwrap();
        // The planes of the mean heights are at 0: pressed beyond full contact.
        assert!(reports.0[0].approach > 0.0, "{method:?}: {:e}", reports.0[0].approach);
        assert!((reports.0[0].mean_load / load - 1.0).abs() < 1e-4, "{method:?}");
    }
}

#[test]
fn a_sample_of_the_positions_saves_convolutions_and_changes_no_answer() {
    let shift = Strategy::Shift { speed_lower: 0.0, speed_upper: 1.0 };
    for (strategy, boundary) in [(Strategy::Overlap, Boundary::FREE), (shift, Boundary::PERIODIC)] {
        let [one, other] = [true, false].map(|together| passes(strategy, boundary, together));
        for (a, b) in one.iter().zip(&other) {
            let close = |a: f64, b: f64, tolerance: f64| (a / b - 1.0).abs() < tolerance;
            assert!((a.approach - b.approach).abs() < 1e-6 * 0.1e-6, "{a:?}\n{b:?}");
            assert!(close(a.mean_load, b.mean_load, 2e-6) && close(a.max_load, b.max_load, 1e-5));
            assert!(close(a.lost("plastic")[0], b.lost("plastic")[0], 1e-3), "{a:?}\n{b:?}");
        }
        let cost = |passes: &[PassRecord]| passes.iter().map(|p| p.convolutions).sum::<f64>();
        assert!(cost(&one) < cost(&other), "{} and {}", cost(&one), cost(&other));
    }
}
