//! A law of one's own: what a pass does to the bodies, written with nothing but the trait.

use asperity::material::Material;
use asperity::motion::{
    Law, LoadControl, Motion, Output, Pair, PassRecord, PassReport, PlasticUpdate, Simulation, State,
    Strategy, Touching,
};
use asperity::operator::Boundary;
use asperity::solver::{Control, Params};
use asperity::surface::{Amplitude, SelfAffine};
use asperity::{Field, Grid, Result};

const PITCH: f64 = 1e-6;
/// Volume lost per load and distance, m²/N.
const WEAR: f64 = 2e-14;

/// Archard's wear of the lower body, and the distance over which each of its cells has slid under pressure.
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

    fn add(&self, _: &Pair, touching: &Touching, [lower, _]: &mut [Vec<Field>; 2]) {
        let [work, way] = lower.as_mut_slice() else { panic!("two sums") };
        touching.add(0, work, |index| touching.pressure[index] * touching.sliding_distance);
        touching.add(0, way, |_| touching.sliding_distance);
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
    fn pass(&mut self, report: &PassReport) -> Result<()> {
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
    simulation.unwrap().with_law(Wear).run(&(), &mut [&mut kept]).unwrap();
    kept
}

/// V = k W s, and the ledger of each body: what it lost is what its laws took.
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

/// The state of the law goes on from where it was.
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
    struct Warm(Kept, Option<asperity::motion::WarmStart>);
    impl Output for Warm {
        fn pass(&mut self, report: &PassReport) -> Result<()> {
            self.1 = Some(report.warm.clone());
            self.0.pass(report)
        }
    }
    let mut first = Warm(Kept::default(), None);
    let begun = Simulation::new(pair(4e9), Boundary::FREE, motion(1), Params::default()).unwrap();
    begun.with_law(Wear).run(&(), &mut [&mut first]).unwrap();
    let left = first.0.pairs.pop().unwrap();
    let mut rest = Kept::default();
    let goes_on = Simulation::new(left, Boundary::FREE, motion(3), Params::default()).unwrap();
    goes_on.with_law(Wear).resumed(1, first.1.unwrap()).run(&(), &mut [&mut rest]).unwrap();
    for (found, expected) in rest.pairs.iter().zip(&whole.pairs[1..]) {
        assert_eq!(found.lower, expected.lower);
        assert_eq!(found.upper, expected.upper);
    }
    assert_eq!(rest.passes.len(), 2);
}
