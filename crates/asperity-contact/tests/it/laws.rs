//! A user-defined law, which uses only the public trait.

use asperity_base::{Field, Grid, Result};
use asperity_contact::material::Material;
use asperity_contact::motion::{
    Acceleration, Changes, ContactCells, Law, LoadControl, Motion, Output, Pair, PassRecord, PlasticUpdate,
    Simulation, State, Step, Strategy,
};
use asperity_contact::operator::Boundary;
use asperity_contact::solver::{Control, Friction, Params};
use asperity_contact::temperature::Thermal;
use asperity_surface::{Amplitude, Form, SelfAffine};

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

#[derive(Default)]
struct Kept {
    passes: Vec<PassRecord>,
    pairs: Vec<Pair>,
    /// ΔA Σ p times the distance, over the positions of each pass.
    work: Vec<f64>,
}

impl Output for Kept {
    fn step(&mut self, step: &Step<'_>) -> Result<()> {
        let Some(report) = step.pass() else { return Ok(()) };
        self.passes.push(report.record.clone());
        self.pairs.push(report.pair.clone());
        self.work.push(report.contacts.iter().map(|contact| contact.load).sum::<f64>() * PITCH);
        Ok(())
    }
}

fn pair(hardness: f64) -> Pair {
    let grid = Grid::new([20, 14], [PITCH, PITCH]).unwrap();
    let rough = SelfAffine { hurst: 0.8, rolloff: None, shortest: None, amplitude: Amplitude::Sq(50e-9) };
    let body = Material::new(210e9, 0.3, hardness).unwrap();
    let [lower, upper] = [1, 2].map(|seed| rough.generate(&grid, seed).unwrap());
    Pair::new(lower, upper.underside(), [&body, &body]).unwrap()
}

fn run(hardness: f64, update: PlasticUpdate) -> Kept {
    let motion = Motion::new(Strategy::Overlap, Control::Load(0.2))
        .with_passes(3)
        .with_stride(1)
        .with_load_control(LoadControl::Pass)
        .with_plastic_update(update)
        .with_load_tolerance(1e-4)
        .with_friction(None);
    let mut kept = Kept::default();
    let simulation = Simulation::new(pair(hardness), Boundary::FREE, motion, Params::default());
    simulation.unwrap().with_changes(Changes::by(Wear)).unwrap().run(&(), &mut [&mut kept]).unwrap();
    kept
}

/// V = k W s, and the ledger of each body: its lost volume is that removed by its laws.
#[test]
fn a_law_from_outside_wears_the_body_that_it_names_and_the_ledger_balances() {
    for (hardness, update) in
        [(f64::INFINITY, PlasticUpdate::Pass), (4e9, PlasticUpdate::Pass), (4e9, PlasticUpdate::Step)]
    {
        let kept = run(hardness, update);
        let mut before = pair(hardness);
        for ((pass, after), work) in kept.passes.iter().zip(&kept.pairs).zip(&kept.work) {
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

/// The state of the law continues from its last value.
#[test]
fn an_interrupted_motion_goes_on_with_the_state_of_its_laws() {
    let whole = run(4e9, PlasticUpdate::Pass);
    let motion = |passes| {
        Motion::new(Strategy::Overlap, Control::Load(0.2))
            .with_passes(passes)
            .with_stride(1)
            .with_load_control(LoadControl::Pass)
            .with_plastic_update(PlasticUpdate::Pass)
            .with_load_tolerance(1e-4)
            .with_friction(None)
    };
    struct Warm(Kept, Option<asperity_contact::motion::WarmStart>);
    impl Output for Warm {
        fn step(&mut self, step: &Step<'_>) -> Result<()> {
            let Some(report) = step.pass() else { return Ok(()) };
            self.1 = Some(report.warm.clone());
            self.0.step(step)
        }
    }
    let mut first = Warm(Kept::default(), None);
    let begun = Simulation::new(pair(4e9), Boundary::FREE, motion(1), Params::default()).unwrap();
    begun.with_changes(Changes::by(Wear)).unwrap().run(&(), &mut [&mut first]).unwrap();
    let left = first.0.pairs.pop().unwrap();
    let mut rest = Kept::default();
    let goes_on = Simulation::new(left, Boundary::FREE, motion(3), Params::default()).unwrap();
    goes_on
        .with_changes(Changes::by(Wear))
        .unwrap()
        .resumed(1, first.1.unwrap())
        .run(&(), &mut [&mut rest])
        .unwrap();
    for (found, expected) in rest.pairs.iter().zip(&whole.pairs[1..]) {
        assert_eq!(found.lower, expected.lower);
        assert_eq!(found.upper, expected.upper);
    }
    assert_eq!(rest.passes.len(), 2);
}

/// Oxidation of both bodies in contact by the parabolic law: dξ²/dt = A exp(−Q/RT). The surface of the oxide is above that
/// of the consumed metal by the fraction `SWELLING` of its thickness.
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

/// Two flat bodies in sliding contact, heated by friction or not. Returns the thickness of the oxide on the lower body
/// after 1000 passes, and the losses in the computed passes.
fn oxidised(warmed: bool) -> (Vec<PassRecord>, Field) {
    let grid = Grid::new([8, 8], [PITCH, PITCH]).unwrap();
    let steel = Material::new(210e9, 0.3, f64::INFINITY).unwrap();
    let flat = || Form::Flat.on(&grid).unwrap();
    let pair = Pair::new(flat(), flat(), [&steel, &steel]).unwrap();
    let motion = Motion::new(Strategy::Shift { speed_lower: 0.0, speed_upper: 2.0 }, Control::Load(0.05))
        .with_passes(1000)
        .with_stride(2)
        .with_load_control(LoadControl::Step)
        .with_friction(Friction::coulomb(0.1).unwrap());
    let simulation = Simulation::new(pair, Boundary::PERIODIC, motion, Params::default()).unwrap();
    let thermal = Thermal::new(46.0, 460.0, 7850.0).unwrap();
    let changes = Changes::by(Oxidation).with_bulk([400.0, 500.0]).with_acceleration(Acceleration::default());
    let changes = if warmed { changes.with_heat([thermal; 2], 1) } else { changes };
    let mut simulation = simulation.with_changes(changes).unwrap();
    let mut kept = Kept::default();
    simulation.run(&(), &mut [&mut kept]).unwrap();
    let after = kept.pairs.pop().unwrap();
    (kept.passes, after.lower.state["oxide"].values.clone())
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
