//! A user-defined law, which uses only the public trait.

use asperity_base::{Field, Grid};
use asperity_contact::motion::{
    Acceleration, Changes, ContactCells, Law, LoadControl, Motion, Pair, PassRecord, PlasticUpdate,
    Simulation, State, Strategy,
};
use asperity_contact::operator::Boundary;
use asperity_contact::solver::{Control, Friction, Params};
use asperity_contact::temperature::Thermal;
use asperity_surface::{Amplitude, Form};

use crate::support::{Kept, self_affine, steel};

const PITCH: f64 = 1e-6;
/// Volume lost per load and distance, m²/N.
const WEAR: f64 = 2e-14;

/// Archard's wear of the lower body, and the distance that each of its cells has slid under pressure.
struct Wear;

impl Law for Wear {
    fn name(&self) -> &str {
        "wear"
    }

    fn prepare(&mut self, pair: &mut Pair) {
        let zeros = Field::zeros(pair.lower.heights.raw_dim());
        let state = || State { unit: "m".to_owned(), values: zeros };
        pair.lower.state.entry("slid".to_owned()).or_insert_with(state);
    }

    fn sums(&self) -> usize {
        2
    }

    fn add(&self, _: &Pair, contact_cells: &ContactCells, [lower, _]: &mut [Vec<Field>; 2]) {
        let [work, way] = lower.as_mut_slice() else { panic!("two sums") };
        contact_cells
            .add(0, work, |index| contact_cells.pressure[index] * contact_cells.sliding_distance(index));
        contact_cells.add(0, way, |index| contact_cells.sliding_distance(index));
    }

    fn advance(&self, pair: &mut Pair, [lower, upper]: &[Vec<Field>; 2], passes: f64) -> [Field; 2] {
        let slid = pair.lower.state.get_mut("slid").expect("prepared");
        slid.values.scaled_add(passes, &lower[1]);
        [&lower[0] * (WEAR * passes), Field::zeros(upper[0].raw_dim())]
    }
}

fn pair(hardness: f64) -> Pair {
    let grid = Grid::new([20, 14], [PITCH, PITCH]).unwrap();
    let [lower, upper] = [1, 2].map(|seed| self_affine(&grid, Amplitude::Sq(50e-9), None, seed));
    Pair::new(lower, upper.underside(), [&steel(hardness); 2]).unwrap()
}

fn run(hardness: f64, update: PlasticUpdate) -> Kept {
    let motion = Motion::new(Strategy::Overlap, Control::Load(0.2))
        .with_passes(3)
        .with_stride(1)
        .with_load_control(LoadControl::Pass)
        .with_plastic_update(update)
        .with_load_tolerance(1e-4)
        .with_friction(None);
    let simulation = Simulation::new(pair(hardness), Boundary::FREE, motion, Params::default());
    Kept::run(simulation.unwrap().with_changes(Changes::by(Wear)).unwrap())
}

/// V = k W s, and the ledger of each body: its lost volume is that removed by its laws.
#[test]
fn a_law_from_outside_wears_the_body_that_it_names_and_the_ledger_balances() {
    for (hardness, update) in
        [(f64::INFINITY, PlasticUpdate::Pass), (4e9, PlasticUpdate::Pass), (4e9, PlasticUpdate::Step)]
    {
        let kept = run(hardness, update);
        let mut before = pair(hardness);
        for (index, (pass, after)) in kept.passes.iter().zip(&kept.pairs).enumerate() {
            let work = PITCH * kept.force(index);
            let [worn, untouched] = pass.lost("wear");
            assert!((worn / (WEAR * work) - 1.0).abs() < 1e-12, "{worn:e}, {:e}", WEAR * work);
            assert_eq!(untouched, 0.0);
            let [lower, upper] = pass.lost("plastic");
            assert_eq!(lower > 0.0, hardness.is_finite());
            let area = PITCH * PITCH;
            let fell = area * (&before.lower.heights - &after.lower.heights).sum();
            assert!((fell / (worn + lower) - 1.0).abs() < 1e-9, "{fell:e}, {worn:e}, {lower:e}");
            let rose = area * (&after.upper.heights - &before.upper.heights).sum();
            assert!((rose - upper).abs() <= 1e-9 * upper + 1e-33, "{rose:e}, {upper:e}");
            before = after.clone();
        }
        let slid = &kept.pairs[2].lower.state["slid"];
        assert_eq!(slid.unit, "m");
        assert!(slid.values.iter().any(|way| *way > 0.0) && kept.pairs[2].upper.state.is_empty());
        assert!(
            slid.values.iter().zip(&kept.pairs[0].lower.state["slid"].values).all(|(now, then)| now >= then)
        );
    }
}

/// Oxidation of both bodies in contact by the parabolic law: dξ²/dt = A exp(−Q/RT). The surface of the oxide
/// is above that of the consumed metal by the fraction `SWELLING` of its thickness.
struct Oxidation;

/// A of the parabolic law, m²/s.
const OXIDATION: f64 = 1e-12;
/// Q over the gas constant, K.
const ACTIVATION: f64 = 5000.0;
const SWELLING: f64 = 0.5;

impl Law for Oxidation {
    fn name(&self) -> &str {
        "oxide"
    }

    fn prepare(&mut self, pair: &mut Pair) {
        for body in [&mut pair.lower, &mut pair.upper] {
            let values = Field::zeros(body.heights.raw_dim());
            body.state.entry("oxide".to_owned()).or_insert(State { unit: "m".to_owned(), values });
        }
    }

    fn add(&self, _: &Pair, contact_cells: &ContactCells, sums: &mut [Vec<Field>; 2]) {
        for (body, sums) in sums.iter_mut().enumerate() {
            contact_cells.add(body, &mut sums[0], |index| {
                OXIDATION * (-ACTIVATION / contact_cells.temperature[body][index]).exp() * contact_cells.time
            });
        }
    }

    fn advance(&self, pair: &mut Pair, sums: &[Vec<Field>; 2], passes: f64) -> [Field; 2] {
        let mut bodies = [&mut pair.lower, &mut pair.upper].into_iter().zip(sums);
        [(); 2].map(|()| {
            let (body, sums) = bodies.next().expect("two bodies");
            let oxide = &mut body.state.get_mut("oxide").expect("prepared").values;
            let before = oxide.clone();
            oxide.zip_mut_with(&sums[0], |thickness, sum| {
                *thickness = thickness.mul_add(*thickness, sum * passes).sqrt();
            });
            (before - &*oxide) * SWELLING
        })
    }
}

/// Two flat bodies in sliding contact, heated by friction or not. Returns the thickness of the oxide on the
/// lower body after 1000 passes, and the losses in the computed passes.
fn oxidised(warmed: bool) -> (Vec<PassRecord>, Field) {
    let grid = Grid::new([8, 8], [PITCH, PITCH]).unwrap();
    let flat = || Form::Flat.on(&grid).unwrap();
    let pair = Pair::new(flat(), flat(), [&steel(f64::INFINITY); 2]).unwrap();
    let motion = Motion::new(Strategy::Shift { speed_lower: 0.0, speed_upper: 2.0 }, Control::Load(0.05))
        .with_passes(1000)
        .with_stride(2)
        .with_load_control(LoadControl::Step)
        .with_friction(Friction::coulomb(0.1).unwrap());
    let simulation = Simulation::new(pair, Boundary::PERIODIC, motion, Params::default()).unwrap();
    let thermal = Thermal::new(46.0, 460.0, 7850.0).unwrap();
    let changes = Changes::by(Oxidation).with_bulk([400.0, 500.0]).with_acceleration(Acceleration::default());
    let changes = if warmed { changes.with_heat([thermal; 2], 1) } else { changes };
    let kept = Kept::run(simulation.with_changes(changes).unwrap());
    let oxide = kept.last().lower.state["oxide"].values.clone();
    (kept.passes, oxide)
}

/// ξ² = A exp(−Q/RT) t for any extrapolation, and the ledger includes the oxide.
#[test]
fn a_law_from_outside_oxidises_the_bodies_by_its_closed_form() {
    let (passes, oxide) = oxidised(false);
    assert!(passes.len() < 20, "{} computed", passes.len());
    let time = 1000.0 * 8.0 * PITCH / 2.0;
    let expected = (OXIDATION * (-ACTIVATION / 400.0f64).exp() * time).sqrt();
    assert!(oxide.iter().all(|thickness| (thickness / expected - 1.0).abs() < 1e-9), "{expected:e} {oxide}");
    let lost: f64 = passes.iter().map(|pass| pass.lost("oxide")[0]).sum();
    let volume = -SWELLING * expected * 64.0 * PITCH * PITCH;
    assert!((lost / volume - 1.0).abs() < 1e-9, "{lost:e} {volume:e}");
    // Both surfaces in contact have the same temperature, above that of the cooler body.
    let (_, warmer) = oxidised(true);
    assert!(warmer.iter().all(|thickness| *thickness > 1.01 * expected), "{expected:e} {warmer}");
}
