//! An interface from outside the library.

use std::sync::Arc;

use asperity_contact::material::Material;
use asperity_contact::motion::{
    Motion, Pair, Simulation, SlipRegime, Stage, Strategy, load_in_stages, press,
};
use asperity_contact::operator::{Boundary, Operator};
use asperity_contact::solver::{
    Control, HardWall, Interface, Loading, NormalProblem, Params, Solution, solve_normal,
};
use asperity_contact::units::{JoulePerSquareMetre, Metre, Pascal};
use asperity_contact::{Grid, Result};
use asperity_surface::LowPass;

/// Suction of the same tension at every gap, up to a range beyond all gaps.
#[derive(Debug)]
struct Suction {
    tension: Pascal,
    range: Metre,
}

impl Interface for Suction {
    fn solve(&self, operator: &mut dyn Operator, problem: &NormalProblem<'_>) -> Result<Solution> {
        let NormalProblem { gap, bounds, control, before, params, .. } = *problem;
        let bounds = bounds.clone().above(-self.tension);
        solve_normal(operator, gap, &bounds, control, before.pressure(), params)
    }

    fn tension(&self, _: Metre) -> Pascal {
        self.tension
    }

    fn energy(&self, gap: Metre) -> JoulePerSquareMetre {
        -self.tension * (self.range - gap)
    }

    fn is_hard(&self) -> bool {
        false
    }

    fn follows_path(&self) -> bool {
        false
    }

    fn check_combined(&self) -> Result<()> {
        Err(asperity_contact::Error::Unsupported("suction acts alone"))
    }

    fn check_passes(&self, _: bool, _: bool, _: &Params) -> Result<()> {
        Ok(())
    }
}

const TENSION: Pascal = 1e8;

fn rough() -> Pair {
    let grid = Grid::new([48, 32], [1e-6; 2]).unwrap();
    let surface = |seed| LowPass::new(35e-9, [8e-6; 2]).generate(&grid, seed).unwrap();
    let glass = Material::elastic(70e9, 0.2).unwrap();
    Pair::new(surface(1), surface(2).underside(), [&glass, &glass]).unwrap()
}

fn sucked() -> Pair {
    rough().with_interface(Arc::new(Suction { tension: TENSION, range: 1e-3 }))
}

/// Suction presses like a load of the tension on the whole grid: the displacement under an even pressure of a
/// periodic surface is 0.
#[test]
fn suction_presses_as_a_load_does() {
    let (boundary, params) = (Boundary::PERIODIC, Params::new().with_tolerance(1e-9));
    let area = rough().lower_grid().area();
    let load = 0.02 * TENSION * area;
    let pressed = |pair: &Pair, load: f64| {
        press(pair, boundary, Control::Load(load), SlipRegime::Frictionless, &params, &()).unwrap()
    };
    let heavier = pressed(&rough(), load + TENSION * area);
    let alone = pressed(&rough().with_interface(Arc::new(HardWall)), load);
    let contact = pressed(&sucked(), load);
    assert_eq!(contact.record.contact_area, heavier.record.contact_area);
    assert!(contact.record.contact_area > 2.0 * alone.record.contact_area);
    assert!((contact.record.approach / heavier.record.approach - 1.0).abs() < 1e-6);
    let most = heavier.record.max_pressure;
    for (p, q) in contact.solution.normal().pressure.iter().zip(&heavier.solution.normal().pressure) {
        assert!((p + TENSION - q).abs() < 1e-6 * most, "{p} {q}");
    }
    // Its tension on the open cells is in the record; hard walls have none.
    let record = contact.record.interface.unwrap();
    assert_eq!((record.min_pressure, record.jumps), (-TENSION, 0));
    let open = TENSION * (area - contact.record.contact_area);
    assert!((record.adhesive_load / open - 1.0).abs() < 1e-12 && record.adhesion_energy < 0.0);
    assert_eq!((alone.record.interface, heavier.record.interface), (None, None));
}

/// Stages and passes take the same interface, and nothing is lost on the way together: suction has no jumps.
#[test]
fn stages_and_passes_take_the_interface_of_the_pair() {
    let (boundary, params) = (Boundary::PERIODIC, Params::new().with_tolerance(1e-8));
    let load = 0.02 * TENSION * rough().lower_grid().area();
    let stage = Stage::new(Loading::pressing(Control::Load(load)), 3);
    let loaded = load_in_stages(&sucked(), boundary, None, &[stage], &params, None, &(), &mut []).unwrap();
    let pressed =
        press(&sucked(), boundary, Control::Load(load), SlipRegime::Frictionless, &params, &()).unwrap();
    assert_eq!(loaded.record.contact_area, pressed.record.contact_area);
    assert_eq!(loaded.record.interface.unwrap().jumps, 0);
    let motion = Motion::new(Strategy::Shift { speed_lower: 0.0, speed_upper: 1.0 }, Control::Load(load))
        .with_stride(8);
    let pass = Simulation::new(sucked(), boundary, motion, params).unwrap().solve(&()).unwrap().record();
    let interface = pass.interface.unwrap();
    assert!(interface.jumps == 0 && interface.history_difference < 1e-6, "{interface:?}");
    assert!((pass.mean_load / load - 1.0).abs() < 1e-3 && interface.mean_adhesive_load > load);
}
