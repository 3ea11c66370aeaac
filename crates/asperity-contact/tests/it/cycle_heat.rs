//! The heat of slip in cycles.

use std::f64::consts::PI;
use std::sync::{Arc, Mutex};

use asperity_base::{Error, Field, Grid};
use asperity_contact::material::Material;
use asperity_contact::motion::{
    Changes, ContactCells, Cycles, Law, LoadedContact, Pair, Stage, StagedLoading,
};
use asperity_contact::operator::Boundary;
use asperity_contact::solver::{Control, Coupling, Friction, Loading, Params, Tangential};
use asperity_contact::temperature::Thermal;
use asperity_surface::{Form, Topography};

const BULK: f64 = 300.0;
const PERIOD: f64 = 0.02;
const CONDUCTIVITY: f64 = 46.0;

/// Keeps the temperatures that it sees, and changes nothing.
struct Thermometer(Arc<Mutex<Vec<f64>>>);

impl Law for Thermometer {
    fn name(&self) -> &str {
        "thermometer"
    }

    fn add(&self, _: &Pair, cells: &ContactCells, _: &mut [Vec<Field>; 2]) {
        assert_eq!(cells.temperature[0], cells.temperature[1]);
        self.0.lock().unwrap().push(cells.temperature[0].iter().copied().fold(0.0, f64::max));
    }

    fn advance(&self, pair: &mut Pair, _: &[Vec<Field>; 2], _: f64) -> [Field; 2] {
        [&pair.lower, &pair.upper].map(|body| Field::zeros(body.heights.raw_dim()))
    }
}

/// A ball of 10 mm slides to and fro by 100 µm under 20 N, on cells of this pitch.
fn slid(cells: usize, period: Option<f64>) -> Result<(LoadedContact, Vec<f64>), Error> {
    let grid = Grid::new([cells; 2], [0.6e-3 / cells as f64; 2]).unwrap();
    let ball = Form::Sphere { radius: 10e-3 }.on(&grid).unwrap();
    let steel = Material::elastic(210e9, 0.3).unwrap();
    let flat = Topography::new(grid, grid.zeros()).unwrap();
    let pair = Pair::new(flat, ball.underside(), [&steel, &steel]).unwrap();
    let stage = |way: f64, steps: usize| {
        Stage::new(
            Loading { normal: Control::Load(20.0), tangential: Tangential::Displacement([way, 0.0]) },
            steps,
        )
    };
    let stages = vec![stage(50e-6, 1), stage(-50e-6, 2).with_cycles(Some(Cycles { count: 3, period }))];
    let friction = Friction::coulomb(0.3).unwrap().with_coupling(Coupling::None);
    let seen = Arc::new(Mutex::new(Vec::new()));
    let thermal = Thermal::new(CONDUCTIVITY, 460.0, 7850.0).unwrap();
    let changes = Changes::by(Thermometer(seen.clone())).with_bulk([BULK; 2]).with_heat([thermal; 2], 1);
    let loading = StagedLoading::new(pair, Boundary::FREE, Some(friction), stages, Params::default())
        .unwrap()
        .with_changes(changes);
    let contact = loading.run(None, &(), &mut [])?;
    let seen = seen.lock().unwrap().clone();
    Ok((contact, seen))
}

/// The rise in the middle of a circle whose heat is that of Hertz' pressure, π q₀ a/(4 k), shared by two
/// bodies.
#[test]
fn a_ball_that_slides_to_and_fro_has_the_steady_temperature_of_its_mean_heat() {
    let errors = [16, 32].map(|cells| {
        let (contact, seen) = slid(cells, Some(PERIOD)).unwrap();
        let last = contact.increments.last().unwrap();
        let heat = last.heat.unwrap();
        let cycle: f64 =
            contact.increments[contact.increments.len() - 4..].iter().map(|each| each.dissipation).sum();
        assert!((heat.friction_power * PERIOD / cycle - 1.0).abs() < 1e-9, "{heat:?} {cycle:e}");
        // Laws see the temperature of the cycle before; in the first that of the bodies.
        assert_eq!(seen.len(), 13);
        assert!(seen[..5].iter().all(|kelvin| *kelvin == BULK));
        assert!(
            seen[9..].iter().all(|kelvin| (kelvin / heat.max_flash_temperature - 1.0).abs() < 1e-3),
            "{seen:?}"
        );
        let radius = (3.0_f64 * 20.0 * 10e-3 / (4.0 * 0.5 * 210e9 / 0.91)).cbrt();
        let flux = 3.0 * heat.friction_power / (2.0 * PI * radius * radius);
        let rise = PI * flux * radius / (8.0 * CONDUCTIVITY);
        let field = contact.changed.unwrap().heat.unwrap().temperature_field();
        assert!(field[[cells / 2, cells / 2]] > field[[cells / 2, cells / 4 + cells / 8]]);
        (heat.max_flash_temperature - BULK) / rise - 1.0
    });
    assert!(errors[1].abs() < 0.01 && errors[1].abs() < errors[0].abs(), "{errors:?}");
}

#[test]
fn cycles_without_a_period_have_no_temperature() {
    let error = slid(8, None).map(|_| ()).unwrap_err().to_string();
    assert!(error.contains("needs the period"), "{error}");
}
