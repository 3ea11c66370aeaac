//! Helpers shared by several tests.

pub(crate) mod cell_by_cell;
pub(crate) mod dense;

use asperity_contact::film::{FilmLaw, FilmStress};
use asperity_contact::material::{Compliances, Material};
use asperity_contact::motion::{
    Contact, LoadControl, Output, Pair, PassRecord, PlasticVolume, Simulation, Step, StepRecord, WarmStart,
};
use asperity_contact::solver::Control;
use asperity_contact::wear::{Wear, WearCoefficient};
use asperity_contact::{Field, Grid, Result};
use asperity_surface::{Amplitude, SelfAffine, Topography};

pub(crate) fn steel(hardness: f64) -> Material {
    Material::new(210e9, 0.3, hardness).unwrap()
}

pub(crate) fn compliances(poisson: [f64; 2], young: [f64; 2]) -> Compliances {
    let [lower, upper] = [0, 1].map(|k| Material::elastic(young[k], poisson[k]).unwrap());
    Compliances::new(&lower, &upper).unwrap()
}

/// A plane under a body of these heights.
pub(crate) fn over_a_plane(grid: Grid, heights: Field, materials: [&Material; 2]) -> Pair {
    let [plane, body] = [grid.zeros(), heights].map(|heights| Topography::new(grid, heights).unwrap());
    Pair::new(plane, body, materials).unwrap()
}

/// Heights of a ball of a radius of 1 mm over its apex in the middle of a grid.
pub(crate) fn ball(grid: &Grid) -> Field {
    let at = |axis: usize, n: usize| grid.centre(axis, n) - 0.5 * grid.extent()[axis];
    Field::from_shape_fn(grid.shape, |(i, j)| (at(0, i).powi(2) + at(1, j).powi(2)) / 2e-3)
}

/// A self-affine surface with a Hurst exponent of 0.8.
pub(crate) fn self_affine(grid: &Grid, amplitude: Amplitude, shortest: Option<f64>, seed: u64) -> Topography {
    SelfAffine { hurst: 0.8, rolloff: None, shortest, amplitude }.generate(grid, seed).unwrap()
}

/// A self-affine gap with an rms slope of 0.1, above 0.
pub(crate) fn rough_gap(grid: &Grid, seed: u64) -> Field {
    let heights = -self_affine(grid, Amplitude::Sdq(0.1), None, seed).into_heights();
    &heights - heights.iter().copied().fold(f64::INFINITY, f64::min)
}

/// Archard's wear of both bodies, of none where the coefficient is 0.
pub(crate) fn archard(k: [f64; 2]) -> Wear {
    let coefficient = |k: f64| (k > 0.0).then(|| WearCoefficient::archard(k).unwrap());
    Wear::new(k.map(coefficient), [None, None]).unwrap()
}

/// Growth of a film of ZDDP, at its `rate` under 1 GPa at 100 °C.
pub(crate) fn zddp(rate: f64, removal: f64) -> FilmLaw {
    FilmLaw::Arrhenius {
        rate,
        at_temperature: 373.15,
        at_stress: 1e9,
        activation_energy: 0.8 * 1.602_176_634e-19,
        activation_volume: 3.8e-30,
        stress: FilmStress::Pressure,
        removal,
    }
}

pub(crate) fn largest(field: &Field) -> f64 {
    field.iter().fold(0.0, |most: f64, value| most.max(value.abs()))
}

/// Largest difference over largest value.
pub(crate) fn difference(one: &Field, other: &Field) -> f64 {
    largest(&(one - other)) / largest(other)
}

/// What a motion leaves after each of its passes.
#[derive(Default)]
pub(crate) struct Kept {
    pub(crate) passes: Vec<PassRecord>,
    pub(crate) steps: Vec<StepRecord>,
    pub(crate) contacts: Vec<Vec<Contact>>,
    pub(crate) pairs: Vec<Pair>,
    pub(crate) mean_pressure: Vec<[Field; 2]>,
    pub(crate) warm_starts: Vec<WarmStart>,
    pub(crate) volumes: Vec<Vec<PlasticVolume>>,
}

impl Kept {
    pub(crate) fn run(mut simulation: Simulation) -> Self {
        let mut kept = Self::default();
        simulation.run(&(), &mut [&mut kept]).unwrap();
        kept
    }

    /// The bodies after the last pass.
    pub(crate) fn last(&self) -> &Pair {
        self.pairs.last().unwrap()
    }

    /// Sum of the loads of the positions of a pass, from 0.
    pub(crate) fn force(&self, pass: usize) -> f64 {
        self.contacts[pass].iter().map(|contact| contact.load).sum()
    }
}

impl Output for Kept {
    fn step(&mut self, step: &Step<'_>) -> Result<()> {
        let Some(report) = step.pass() else { return Ok(()) };
        self.passes.push(report.record.clone());
        self.steps.extend_from_slice(report.steps);
        self.contacts.push(report.contacts.to_vec());
        self.pairs.push(report.pair.clone());
        self.mean_pressure.push(report.mean_pressure());
        self.warm_starts.push(report.warm.clone());
        self.volumes.push(report.plastic_volumes.to_vec());
        Ok(())
    }
}

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
