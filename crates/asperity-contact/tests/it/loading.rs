//! Static contacts loaded stage after stage: plastic deformation is irreversible, and interruptions leave no
//! trace.

use asperity_base::{Error, Field, Grid};
use asperity_contact::material::{Compliances, Material};
use asperity_contact::motion::{
    LoadedContact, LoadingState, Output, Pair, SlipRegime, Stage, Step, load_in_stages, press,
};
use asperity_contact::operator::{Boundary, CoupledSum};
use asperity_contact::solver::{Control, Coupling, Friction, Loading, Method, Params, Tangential};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use crate::support::cell_by_cell::CellByCell;
use crate::support::{self, over_a_plane, steel};

const FINE: Params =
    Params::new().with_method(Method::Auto).with_tolerance(1e-10).with_max_convolutions(10_000);

fn load(
    pair: &Pair,
    friction: Option<&Friction>,
    stages: &[Stage],
    params: &Params,
    outputs: &mut [&mut dyn Output],
) -> Result<LoadedContact, Error> {
    load_in_stages(pair, Boundary::FREE, friction, stages, params, None, &(), outputs)
}

/// A steel ball of 1 mm on steel with this hardness.
fn ball(cells: usize, pitch: f64, hardness: f64) -> Pair {
    let grid = Grid::new([cells; 2], [pitch; 2]).unwrap();
    over_a_plane(grid, support::ball(&grid), [&steel(hardness); 2])
}

fn to(load: f64, force: f64, increments: usize) -> Stage {
    let loading = Loading { normal: Control::Load(load), tangential: Tangential::Force([force, 0.0]) };
    Stage::new(loading, increments)
}

/// By independent calculation from the heights: 242 µm², 281 MPa, 63.9 nm.
#[test]
fn what_the_largest_load_has_flattened_stays_flat_when_the_load_falls() {
    let pair = ball(64, 0.5e-6, 0.5e9);
    let friction = Friction::coulomb(0.3).unwrap();
    for friction in [None, Some(&friction)] {
        for increments in [1, 5] {
            let stages = [to(0.2, 0.0, 1), to(0.05, 0.0, increments)];
            let contact = load(&pair, friction, &stages, &Params::default(), &mut []).unwrap();
            let record = &contact.record;
            assert!((record.contact_area / 242e-12 - 1.0).abs() < 2e-3, "{record:?}");
            assert!((record.max_pressure / 281e6 - 1.0).abs() < 2e-3, "{record:?}");
            assert!((record.approach / 63.9e-9 - 1.0).abs() < 1e-3, "{record:?}");
            // Back at the largest load the contact is unchanged, and beyond it as if never unloaded.
            let virgin = load(&pair, friction, &[to(0.3, 0.0, 1)], &Params::default(), &mut []).unwrap();
            let stages = [to(0.2, 0.0, 1), to(0.05, 0.0, increments), to(0.3, 0.0, increments)];
            let again = load(&pair, friction, &stages, &Params::default(), &mut []).unwrap();
            let most = virgin.record.max_pressure;
            let difference = &again.solution.normal().pressure - &virgin.solution.normal().pressure;
            assert!(difference.iter().all(|e| e.abs() < 1e-5 * most));
            assert!((again.record.plastic_volume / virgin.record.plastic_volume - 1.0).abs() < 1e-4);
        }
    }
}

#[test]
fn a_load_that_only_grows_gives_what_it_gives_at_once_bit_by_bit() {
    let pair = ball(48, 0.6e-6, 0.7e9);
    let whole = load(&pair, None, &[to(0.25, 0.0, 1)], &Params::default(), &mut []).unwrap();
    let LoadedContact { record, solution, .. } =
        press(&pair, Boundary::FREE, Control::Load(0.25), SlipRegime::Frictionless, &Params::default(), &())
            .unwrap();
    assert_eq!(whole.record, record);
    assert_eq!(whole.solution.normal().pressure, solution.normal().pressure);
    let mut states = Kept::default();
    let stages = [to(0.1, 0.0, 4), to(0.25, 0.05, 6)];
    let friction = Friction::coulomb(0.3).unwrap();
    load(&pair, Some(&friction), &stages, &Params::default(), &mut [&mut states]).unwrap();
    assert!(states.0.iter().all(|state| state.flattening.kept.is_none()));
}

/// All states of a loading.
#[derive(Default)]
struct Kept(Vec<LoadingState>);

impl Output for Kept {
    fn step(&mut self, step: &Step<'_>) -> Result<(), Error> {
        self.0.extend(step.state_as::<LoadingState>().cloned());
        Ok(())
    }
}

/// A random contact and its loading.
struct Case {
    materials: [Material; 2],
    gap: Field,
    grid: Grid,
    friction: Option<Friction>,
    stages: Vec<Stage>,
}

impl Case {
    fn at_random(seed: u64, shape: [usize; 2], growth: bool) -> Self {
        let mut random = ChaCha8Rng::seed_from_u64(seed);
        let grid = Grid::new(shape, [1.0, random.random_range(0.7..1.3)]).unwrap();
        let [cx, cy] = shape.map(|n| 0.5 * (n as f64 - 1.0));
        let bump = random.random_range(0.005..0.03);
        let gap = Field::from_shape_fn(shape, |(i, j)| {
            let (x, y) = (i as f64 - cx, j as f64 - cy);
            bump * (x * x + y * y) + random.random_range(-0.1..0.1)
        });
        let hardness = random.random_range(0.03..0.12);
        let (young, poisson) = if random.random_bool(0.5) {
            ([2.0, 2.0], [0.3, 0.3])
        } else {
            ([1.0, random.random_range(1.5..30.0)], [random.random_range(0.1..0.4), 0.3])
        };
        let harder = *[1.0, 2.0, f64::INFINITY].get(random.random_range(0..3)).unwrap();
        let materials = [0, 1]
            .map(|k| Material::new(young[k], poisson[k], if k == 0 { hardness } else { hardness * harder }));
        let friction = random.random_bool(0.7).then(|| {
            let couplings = [Coupling::Full, Coupling::Goodman, Coupling::None];
            let strengths = [f64::INFINITY, f64::INFINITY, 0.02];
            Friction::coulomb(random.random_range(0.1..0.7))
                .unwrap()
                .with_coupling(couplings[random.random_range(0..3)])
                .with_shear_strength(strengths[random.random_range(0..3)])
                .with_junction_growth(if growth { random.random_range(0.0..15.0) } else { 0.0 })
        });
        let limit = hardness * grid.area();
        let by_load = random.random_bool(0.5);
        let by_force = by_load && random.random_bool(0.5);
        let lowest = gap.iter().copied().fold(f64::INFINITY, f64::min);
        let stages = (0..random.random_range(2..6))
            .map(|_| {
                let load = limit * random.random_range(0.01..0.5);
                // A fully plastic contact carries the least shear.
                let bound = friction.map_or(0.0, |f| f.shear_limit(hardness) * load / hardness);
                let angle = random.random_range(0.0..std::f64::consts::TAU);
                let share = random.random_range(0.0..0.5);
                let direction = [angle.cos(), angle.sin()];
                Stage::new(
                    Loading {
                        normal: if by_load {
                            Control::Load(load)
                        } else {
                            Control::Approach(lowest + random.random_range(-0.05..0.5))
                        },
                        tangential: if by_force {
                            Tangential::Force(direction.map(|n| n * share * bound))
                        } else {
                            Tangential::Displacement(direction.map(|n| n * share * 0.2))
                        },
                    },
                    random.random_range(1..4),
                )
            })
            .collect();
        Self { materials: materials.map(Result::unwrap), gap, grid, friction, stages }
    }

    fn run(&self, params: &Params) -> Result<Vec<LoadingState>, Error> {
        let mut states = Kept::default();
        load(&self.pair(), self.friction.as_ref(), &self.stages, params, &mut [&mut states])?;
        Ok(states.0)
    }

    fn pair(&self) -> Pair {
        over_a_plane(self.grid, self.gap.clone(), self.materials.each_ref())
    }

    fn hardness(&self) -> f64 {
        self.materials[0].hardness.min(self.materials[1].hardness)
    }
}

/// Returns the plastic interference of the bodies at the end of a state.
fn plastic(state: &LoadingState, gap: &Field) -> Field {
    state.contact.normal().plastic_interference()
        + &state.flattening.kept.clone().unwrap_or_else(|| Field::zeros(gap.raw_dim()))
}

/// Compares with a cell-by-cell solution: in each increment on surfaces lowered by all earlier plastic
/// deformation, as the law requires.
fn against_cell_by_cell(seed: u64) {
    let case = Case::at_random(seed, [7, 6], false);
    let states = case.run(&FINE).unwrap_or_else(|error| panic!("case {seed}: {error}"));
    let [lower, upper] = &case.materials;
    let mut operator = CoupledSum::new(case.grid, Compliances::new(lower, upper).unwrap());
    let none = Friction::coulomb(0.0).unwrap().with_coupling(Coupling::None);
    let friction = case.friction.unwrap_or(none);
    let reference = CellByCell::new(&mut operator, friction.coupling);
    let mut gap = case.gap.clone();
    let mut slip = vec![[0.0; 2]; case.grid.cells()];
    for (k, state) in states.iter().enumerate() {
        let row = &state.increments[k];
        let shift = [row.tangential_displacement_x, row.tangential_displacement_y];
        let tractions = reference.solve(&gap, case.hardness(), &friction, row.approach, shift, &slip);
        let mut taken = Field::zeros(gap.raw_dim());
        for (cell, traction) in tractions.iter().enumerate() {
            let u = reference.displacement(&tractions, cell);
            slip[cell] = [shift[0] - u[0], shift[1] - u[1]];
            let w = row.approach - gap.as_slice().unwrap()[cell] - u[2];
            if traction[2] >= case.hardness() {
                taken.as_slice_mut().unwrap()[cell] = w.max(0.0);
            }
        }
        gap += &taken;
        let most = case.hardness();
        let what = format!("case {seed}, increment {}: {:?}", k + 1, case.stages);
        let pressure = &state.contact.normal().pressure;
        for (cell, p) in pressure.iter().enumerate() {
            assert!((p - tractions[cell][2]).abs() < 1e-6 * most, "{what}: pressure of cell {cell}");
            if let Some(solution) = state.contact.frictional() {
                for (shear, expected) in solution.shear.iter().zip(&tractions[cell]) {
                    let q = shear.as_slice().unwrap()[cell];
                    assert!((q - expected).abs() < 1e-6 * most, "{what}: shear of cell {cell}");
                }
            }
        }
        let (found, expected) = (plastic(state, &case.gap), &gap - &case.gap);
        let difference = (&found - &expected).iter().fold(0.0f64, |m, e| m.max(e.abs()));
        assert!(difference < 1e-6, "{what}: plastic interference off by {difference:e}");
    }
}

#[test]
fn any_loading_of_what_yields_is_that_of_a_cell_by_cell_iteration() {
    (0..40).for_each(against_cell_by_cell);
}

/// Checks the laws of plastic deformation, contact and friction, with and without junction growth.
fn keeps_the_law(seed: u64) {
    let case = Case::at_random(seed, [22, 20], true);
    let params = Params::default().with_tolerance(1e-7);
    let states = case.run(&params).unwrap_or_else(|error| panic!("case {seed}: {error}"));
    let mut before = Field::zeros(case.gap.raw_dim());
    for state in &states {
        let normal = state.contact.normal();
        let allowed = 1e-5 * normal.displacement.std(0.0).max(1e-3);
        let taken = plastic(state, &case.gap);
        let apart = &case.gap + &normal.displacement - normal.approach + &taken;
        for (flat, (cell, p)) in normal.pressure.indexed_iter().enumerate() {
            let what = format!("case {seed}, increment {}, cell {cell:?}", state.increments.len());
            assert!(taken[cell] >= before[cell] - allowed, "{what}: flows back");
            assert!(apart[cell] >= -allowed, "{what}: overlaps by {:e}", apart[cell]);
            assert!(*p == 0.0 || apart[cell] <= allowed, "{what}: bears over a gap of {:e}", apart[cell]);
            let cap = normal.bounds.upper().value(flat);
            let flows = taken[cell] > before[cell] + allowed;
            assert!(!flows || *p >= cap * (1.0 - 1e-9), "{what}: flows under {p:e} of {cap:e}");
        }
        let row = state.increments.last().unwrap();
        assert!(row.dissipation >= 0.0);
        before = taken;
    }
}

#[test]
fn what_flows_bears_its_cap_and_never_flows_back() {
    (100..112).for_each(keeps_the_law);
}

/// `cargo test -p asperity-contact --test it loading -- --ignored`
#[test]
#[ignore = "some minutes"]
fn many_loadings() {
    (1000..1500).for_each(against_cell_by_cell);
    (2000..2200).for_each(keeps_the_law);
    (3000..3300).for_each(any_tolerance);
}

/// Checks that even a loose tolerance is met, with pressures within their bounds and the prescribed load.
fn any_tolerance(seed: u64) {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let tolerance = match seed % 3 {
        0 => random.random_range(0.05..0.999),
        _ => 10f64.powf(random.random_range(-6.0..-1.0)),
    };
    let shape = if seed.is_multiple_of(2) { [24, 20] } else { [12, 10] };
    let mut case = Case::at_random(seed, shape, seed.is_multiple_of(5));
    let friction = case.friction.get_or_insert(Friction::coulomb(0.4).unwrap());
    friction.coupling = Coupling::Full;
    if seed.is_multiple_of(4) {
        for stage in &mut case.stages {
            stage.loading.tangential = Tangential::Sliding([0.6, -0.8]);
        }
    }
    let modulus = case.pair().modulus();
    let params = Params::default().with_tolerance(tolerance);
    let states =
        case.run(&params).unwrap_or_else(|error| panic!("case {seed}, tolerance {tolerance:e}: {error}"));
    for state in &states {
        let row = state.increments.last().unwrap();
        assert!(row.residual <= tolerance, "case {seed}: {:e} of {tolerance:e}", row.residual);
        let normal = state.contact.normal();
        // With its shear a cell may exceed its cap by as much as the tolerance allows in the displacement.
        let beyond = if case.friction.is_some_and(|friction| friction.junction_growth > 0.0) {
            1.5 * tolerance * normal.displacement.std(0.0) * modulus
        } else {
            0.0
        };
        let most = case.hardness() + beyond;
        assert!(
            normal.pressure.iter().all(|p| (0.0..=most).contains(p)),
            "case {seed}, tolerance {tolerance:e}"
        );
    }
}

#[test]
fn any_tolerance_is_met() {
    (0..60).for_each(any_tolerance);
}

// ---- frictional energy -----------------------------------------------------------------------------------

/// The first example of the user guide of CONTACT: a ball of polyethylene is pressed on an identical one,
/// then shifted. The numbers are those of the reference output of CONTACT (Vollebregt), with four digits.
#[test]
fn contacts_example_of_a_shift_has_its_work_of_friction_in_one_increment() {
    let pitch = 0.13333e-3;
    let grid = Grid::new([19; 2], [pitch; 2]).unwrap();
    let gap = Field::from_shape_fn(grid.shape, |(i, j)| {
        let [x, y] = [i, j].map(|n| (n as f64 - 9.0) * pitch);
        10.0 * (x * x + y * y)
    });
    let polyethylene = Material::elastic(2.0 * 200e6 * 1.42, 0.42).unwrap();
    let pair = over_a_plane(grid, gap, [&polyethylene; 2]);
    let friction = Friction::coulomb(0.4).unwrap();
    let (w, q) = (9.1954, -0.875 * 0.4 * 9.1954);
    for increments in [1, 4] {
        let stages = [to(w, 0.0, 1), to(w, q, increments)];
        let contact = load(&pair, Some(&friction), &stages, &Params::default(), &mut []).unwrap();
        let shear = contact.record.shear.as_ref().unwrap();
        let area = pair.cell_area();
        for (what, found, expected) in [
            ("contact", contact.record.contact_area / area, 177.0),
            ("stick", shear.stick_area / area, 45.0),
            ("approach", contact.record.approach, 1.998e-5),
            ("pressure", contact.record.max_pressure, 4.393e6),
            ("shift", shear.tangential_displacement[0], -8.155e-6),
            ("elastic energy", contact.record.elastic_energy, 8.525e-5),
            ("work of friction", shear.dissipation, 2.750e-6),
        ] {
            assert!((found / expected - 1.0).abs() < 6e-4, "{what}: {found:e}, expected {expected:e}");
        }
    }
}

#[test]
fn a_push_and_a_full_reversal_take_the_same_in_one_increment_as_in_many() {
    let pair = ball(64, 0.8e-6, f64::INFINITY);
    let friction = Friction::coulomb(0.3).unwrap();
    let losses = [1, 20].map(|increments| {
        let stages = [to(1.0, 0.0, 1), to(1.0, 0.18, increments), to(1.0, -0.18, increments)];
        let contact = load(&pair, Some(&friction), &stages, &Params::default(), &mut []).unwrap();
        assert!(contact.dissipation_error < 1e-9 * contact.record.shear.as_ref().unwrap().dissipation);
        let rows = &contact.increments;
        let of = |stage| rows.iter().filter(|row| row.stage == stage).map(|row| row.dissipation).sum::<f64>();
        [of(2), of(3)]
    });
    for stage in 0..2 {
        let (one, many) = (losses[0][stage], losses[1][stage]);
        assert!((one / many - 1.0).abs() < 2e-3, "{losses:?}");
    }
    // According to Mindlin and Deresiewicz 1.55 nJ in total.
    let sum: f64 = losses[1].iter().sum();
    assert!((sum / 1.554e-9 - 1.0).abs() < 2e-2, "{sum:e}");
}

/// The bound covers the result of finer increments, and decreases with them.
#[test]
fn where_load_and_push_grow_together_the_error_of_the_loss_is_bounded() {
    let pair = ball(40, 1.2e-6, f64::INFINITY);
    let friction = Friction::coulomb(0.3).unwrap();
    let [coarse, fine, finest] = [2, 8, 64].map(|increments| {
        let stages = [to(0.2, 0.0, 1), to(1.0, 0.28, increments), to(0.4, 0.1, increments)];
        let contact = load(&pair, Some(&friction), &stages, &Params::default(), &mut []).unwrap();
        (contact.record.shear.unwrap().dissipation, contact.dissipation_error)
    });
    for (loss, error) in [coarse, fine] {
        assert!((loss - finest.0).abs() <= error + finest.1, "{coarse:?}, {fine:?}, {finest:?}");
    }
    assert!(coarse.1 > 0.1 * coarse.0 && finest.1 < 0.1 * coarse.1, "{coarse:?}, {fine:?}, {finest:?}");
}

#[test]
fn a_coefficient_of_friction_is_that_of_what_slides() {
    let pair = ball(32, 1.5e-6, f64::INFINITY);
    let friction = Friction::coulomb(0.3).unwrap();
    let under = |tangential| {
        let loading = Loading { normal: Control::Load(1.0), tangential };
        let stages = [Stage::new(loading, 1)];
        load(&pair, Some(&friction), &stages, &Params::default(), &mut []).unwrap().record.shear.unwrap()
    };
    let held = under(Tangential::Force([0.1, 0.0]));
    assert_eq!(held.friction_coefficient, None);
    assert!((held.force_ratio - 0.1).abs() < 1e-9);
    for slides in [Tangential::Sliding([1.0, 0.0]), Tangential::Displacement([1e-3, 0.0])] {
        let shear = under(slides);
        assert!((shear.friction_coefficient.unwrap() - 0.3).abs() < 1e-9, "{shear:?}");
        assert_eq!(shear.friction_coefficient, Some(shear.force_ratio));
    }
}
