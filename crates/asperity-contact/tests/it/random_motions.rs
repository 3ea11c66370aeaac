//! Motions with random combinations of options; each position is solved again by an independent method.
//!
//! `CASES=1000 cargo test -p asperity-contact --test it random_motions` tries this number, starting from the
//! seed `SEED`.

use asperity_base::error::LoadLimit;
use asperity_base::{Error, Field, Grid};
use asperity_contact::material::{Coating, Material};
use asperity_contact::motion::{
    LoadControl, Motion, OffsetY, Pair, PassRecord, Path, PlasticUpdate, Position, Simulation, StepRecord,
    Strategy,
};
use asperity_contact::operator::{Boundary, CoupledOperator, Edge, Operators};
use asperity_contact::solver::{
    Bounds, Control, Coupling, Friction, Loading, Method, Params, Tangential, solve_frictional, solve_normal,
};
use asperity_surface::{Amplitude, Topography};
use rand::{Rng, RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use crate::support::{Kept, self_affine};

const PITCH: f64 = 1e-6;

#[test]
fn every_motion_is_in_equilibrium_at_every_position() {
    let number = |name: &str, default: u64| std::env::var(name).map_or(default, |text| text.parse().unwrap());
    let (cases, seed) = (number("CASES", 40), number("SEED", 0));
    let mut tally = Tally::default();
    for case in seed..seed + cases {
        check(&Case::random(&mut ChaCha8Rng::seed_from_u64(case)), case, &mut tally);
    }
    assert!(tally.solved > cases as usize / 2, "{tally:?}");
}

#[derive(Debug, Default)]
struct Tally {
    solved: usize,
    yielded: usize,
    full: usize,
    positions: usize,
    largest_error: f64,
}

/// Hardness of the softest cells of a map, relative to the nominal one.
const SOFTEST: f64 = 0.6;

#[derive(Debug)]
struct Case {
    boundary: Boundary,
    motion: Motion,
    method: Method,
    tolerance: f64,
    young: [f64; 2],
    hardness: [f64; 2],
    /// Whether the hardness differs from cell to cell.
    maps: bool,
    coatings: [Option<Coating>; 2],
    columns: [usize; 2],
    width: usize,
    sq: f64,
    seed: u64,
}

impl Case {
    fn random(rng: &mut impl Rng) -> Self {
        let pick = |rng: &mut dyn Rng, n: usize| rng.random_range(0..n);
        let strategy = match pick(rng, 4) {
            0 | 1 => Strategy::Overlap,
            2 => Strategy::Shift { speed_lower: 0.0, speed_upper: 1.0 },
            _ => Strategy::Shift { speed_lower: [-0.5, 0.3, 1.0 / 3.0, 2.5][pick(rng, 4)], speed_upper: 1.0 },
        };
        let overlap = strategy == Strategy::Overlap;
        let edges = [0, 1].map(|_| [Edge::Free, Edge::Periodic][pick(rng, 2)]);
        let boundary = Boundary(if overlap { [Edge::Free, edges[1]] } else { edges });
        let long = rng.random_range(5..15);
        let columns = [long, if overlap { rng.random_range(4..15) } else { long }];
        let width = rng.random_range(1..9);
        let young = [[210e9, 210e9], [2e9, 210e9], [210e9, 70e9]][pick(rng, 3)];
        let hardness = [[4e9, 4e9], [1e9, 4e9], [f64::INFINITY; 2], [3e9, f64::INFINITY]][pick(rng, 4)];
        let sq = [3e-9, 35e-9, 200e-9][pick(rng, 3)];
        let friction = match pick(rng, 4) {
            0 | 1 => None,
            kind => Some(
                Friction::coulomb(rng.random_range(0.05..0.5))
                    .unwrap()
                    .with_junction_growth(if kind == 3 { 9.0 } else { 0.0 })
                    .with_coupling([Coupling::Full, Coupling::Full, Coupling::None][pick(rng, 3)]),
            ),
        };
        let plastic_update = [PlasticUpdate::Pass, PlasticUpdate::Step][pick(rng, 2)];
        let stride = rng.random_range(1..5);
        let mut motion = Motion::new(strategy, Control::Approach(0.0))
            .with_passes(2)
            .with_stride(stride)
            .with_load_control(LoadControl::Pass)
            .with_plastic_update(plastic_update)
            .with_load_tolerance([1e-4, 1e-2, 1e-6][pick(rng, 3)])
            .with_path([Path::OneWay, Path::Reciprocating][pick(rng, 2)])
            .with_friction(friction);
        if boundary.repeats(1) && pick(rng, 2) == 0 {
            motion.offset_y = [OffsetY::Cells(2), OffsetY::Random { seed: 1 }][pick(rng, 2)];
        }
        let maps = pick(rng, 3) == 0;
        let cap = if maps { SOFTEST } else { 1.0 }
            * friction.map_or(hardness[0].min(hardness[1]), |f| f.sliding_cap(hardness[0].min(hardness[1])));
        let column = width as f64 * PITCH * PITCH * cap.min(3e9);
        let positions = strategy.positions(columns[0], columns[1], stride);
        let bearable: Vec<f64> = positions.iter().map(|p| column * p.columns as f64).collect();
        // From light to 95 % of the plastic limit, uniform in the logarithm.
        let share = 0.95 * 10f64.powf(-6.0 * rng.random_range(0.0f64..1.0).powi(2));
        let mut load = |holds: LoadControl| {
            motion.load_control = holds;
            Control::Load(share * holds.plastic_limit(&bearable))
        };
        motion.control = match pick(rng, 4) {
            0 | 1 => load(LoadControl::Pass),
            2 => load(LoadControl::Step),
            _ => Control::Approach(sq * rng.random_range(-2.0..1.0)),
        };
        let method = [Method::Auto, Method::ActiveSet, Method::Direct, Method::PolonskyKeer][pick(rng, 4)];
        let tolerance = [1e-6, 1e-8, 1e-3][pick(rng, 3)];
        let seed: u64 = rng.random();
        // Line contacts and coupled friction are supported only without a coating.
        let coated = boundary.repeats(0) == boundary.repeats(1) && pick(rng, 3) == 0;
        let mut coating = || {
            let thickness = PITCH * 10f64.powf(rng.random_range(-1.5..1.0));
            let young = 100e9 * 10f64.powf(rng.random_range(-2.0..2.0));
            Coating::new(thickness, young, [0.0, 0.3, 0.5][pick(rng, 3)]).unwrap()
        };
        let coatings = if coated {
            motion.friction = None;
            [[true, false], [false, true], [true, true]][seed as usize % 3].map(|is| is.then(&mut coating))
        } else {
            [None; 2]
        };
        Self {
            boundary,
            motion,
            method,
            tolerance,
            young,
            hardness,
            maps,
            coatings,
            columns,
            width,
            sq,
            seed,
        }
    }

    fn params(&self) -> Params {
        Params::default().with_method(self.method).with_tolerance(self.tolerance)
    }

    fn pair(&self) -> Pair {
        let surface = |columns: usize, seed: u64| -> Topography {
            let grid = Grid::new([columns, self.width], [PITCH, PITCH]).unwrap();
            self_affine(&grid, Amplitude::Sq(self.sq), None, seed)
        };
        let [a, b] = [0, 1].map(|k| Material {
            layers: self.coatings[k].into_iter().collect(),
            ..Material::new(self.young[k], 0.3, self.hardness[k]).unwrap()
        });
        let seed = self.seed % 1_000_000;
        let pair = Pair::new(surface(self.columns[0], seed), surface(self.columns[1], seed + 1), [&a, &b]);
        if !self.maps {
            return pair.unwrap();
        }
        let map = |body: usize| {
            let shape = [self.columns[body], self.width];
            Field::from_shape_fn(shape, |(i, j)| self.borne([[i, j]; 2])[body]).into()
        };
        pair.unwrap().with_hardness([map(0), map(1)]).unwrap()
    }

    /// Returns the pressure that a cell of the lower and one of the upper body can carry.
    fn borne(&self, cells: [[usize; 2]; 2]) -> [f64; 2] {
        [0, 1].map(|body| {
            let [i, j] = cells[body];
            let part = [1.0, 0.8, SOFTEST][(3 * i + 5 * j + i * j) % 3];
            if self.maps { part * self.hardness[body] } else { self.hardness[body] }
        })
    }

    /// Returns the cells of a body under a cell of the contact, with their weights.
    fn under(&self, position: &Position, body: usize, [j, iy]: [usize; 2]) -> Vec<([usize; 2], f64)> {
        let first = [position.lower, position.upper][body];
        let part = position.fraction[body];
        let across = [0, position.across][body];
        let cell = |ahead: usize| {
            [(first + j + ahead) % self.columns[body], (iy + self.width - across) % self.width]
        };
        [(cell(0), 1.0 - part), (cell(1), part)].into_iter().filter(|(_, weight)| *weight > 0.0).collect()
    }

    /// Returns the pressures that opposing cells of the lower and of the upper body can carry.
    fn facing(&self, position: &Position, cell: [usize; 2]) -> [f64; 2] {
        [0, 1].map(|body| {
            let borne = |(cell, weight)| weight * self.borne([cell; 2])[body];
            self.under(position, body, cell).into_iter().map(borne).sum()
        })
    }

    fn run(&self, control: Control) -> (asperity_base::Result<()>, Kept) {
        let mut kept = Kept::default();
        let motion = self.motion.with_control(control);
        let mut simulation = Simulation::new(self.pair(), self.boundary, motion, self.params()).unwrap();
        (simulation.run(&(), &mut [&mut kept]), kept)
    }
}

fn check(case: &Case, index: u64, tally: &mut Tally) {
    let what = || format!("case {index}: {case:?}");
    let (ended, kept) = case.run(case.motion.control);
    match ended {
        Ok(()) => tally.solved += 1,
        Err(Error::BeyondPass { load, most, approach, cause }) => {
            assert!(load > most, "{}", what());
            match cause {
                LoadLimit::Yielded => {
                    tally.yielded += 1;
                    assert_eq!(case.motion.plastic_update, PlasticUpdate::Step, "{}", what());
                    if kept.passes.is_empty() {
                        // No smaller approach has a larger load.
                        for share in [0.1, 0.3, 1.0] {
                            let (_, at) = case.run(Control::Approach(share * approach));
                            let bears = at.passes[0].mean_load;
                            assert!(bears <= most * (1.0 + 1e-2), "{bears:e} N, {most:e} N, {}", what());
                        }
                    }
                }
                LoadLimit::FullContact => {
                    tally.full += 1;
                    assert_eq!(case.boundary, Boundary::PERIODIC, "{}", what());
                }
            }
        }
        Err(Error::AtPosition { source, .. })
            if matches!(*source, Error::PeriodicFullContact { .. })
                && matches!(case.motion.control, Control::Approach(_)) =>
        {
            tally.full += 1;
        }
        Err(error) => panic!("{error}: {}", what()),
    }
    let mut before = case.pair();
    for (pass, after) in kept.passes.iter().zip(&kept.pairs) {
        let steps: Vec<&StepRecord> = kept.steps.iter().filter(|step| step.pass == pass.pass).collect();
        before = hold(case, &before, after, pass, &steps, index, tally);
    }
}

/// Compares a pass with the solution of each position at its approach, by the direct method and to round-off,
/// on geometry that is lowered here. Returns the bodies after the pass.
fn hold(
    case: &Case,
    before: &Pair,
    after: &Pair,
    pass: &PassRecord,
    steps: &[&StepRecord],
    index: u64,
    tally: &mut Tally,
) -> Pair {
    let what = || format!("case {index}, pass {}: {case:?}", pass.pass);
    if let (Control::Load(load), LoadControl::Pass) = (case.motion.control, case.motion.load_control) {
        let missed = (pass.mean_load / load - 1.0).abs();
        assert!(missed <= case.motion.load_tolerance.max(100.0 * case.tolerance), "{missed:e}, {}", what());
        assert!(steps.iter().all(|step| step.approach == steps[0].approach), "{}", what());
    }
    let operators = Operators::new(
        before.grid(case.columns[0].min(case.columns[1])),
        before.response().clone(),
        case.boundary,
    );
    let positions = case.motion.positions(case.columns, case.width, pass.pass);
    let mut now = before.clone();
    let mut deepest = [Field::zeros(now.lower.heights.raw_dim()), Field::zeros(now.upper.heights.raw_dim())];
    let area = PITCH * PITCH;
    for (step, position) in steps.iter().zip(&positions) {
        tally.positions += 1;
        let gap = now.initial_gap(position);
        let (pressure, interference) = again(case, &operators, position, &gap, step);
        let load = area * pressure.sum();
        // At one approach the error of the load is a fraction of the residual. The reference is the load at
        // which the displacement deviates by as much as here.
        let scale = load.max(step.load).max(area * pressure.len() as f64 * 1e-6);
        let error = (load - step.load).abs() / scale / case.tolerance;
        tally.largest_error = tally.largest_error.max(error);
        assert!(error < 300.0, "load {:e} N, independently {load:e} N: {step:?} {}", step.load, what());
        if let (Control::Load(wanted), LoadControl::Step) = (case.motion.control, case.motion.load_control) {
            assert!((step.load / wanted - 1.0).abs() < 1e-9, "{step:?} {}", what());
        }
        let volume = area * interference.sum();
        let size = area * pressure.len() as f64 * case.sq;
        assert!(
            (volume - step.plastic_volume).abs() < 30.0 * case.tolerance * size,
            "{volume:e} {step:?} {}",
            what()
        );
        let mut here = [Field::zeros(deepest[0].raw_dim()), Field::zeros(deepest[1].raw_dim())];
        for ((j, iy), &w) in interference.indexed_iter() {
            let share = match case.facing(position, [j, iy]) {
                [lower, upper] if lower < upper => [1.0, 0.0],
                [lower, upper] if lower > upper => [0.0, 1.0],
                _ => [0.5; 2],
            };
            for body in 0..2 {
                for (cell, weight) in case.under(position, body, [j, iy]) {
                    here[body][cell] += weight * share[body] * w;
                }
            }
        }
        if case.motion.plastic_update == PlasticUpdate::Step {
            now.lower.heights -= &here[0];
            now.upper.heights += &here[1];
        }
        for (deepest, here) in deepest.iter_mut().zip(&here) {
            deepest.zip_mut_with(here, |most, w| *most = most.max(*w));
        }
    }
    if case.motion.plastic_update == PlasticUpdate::Pass {
        now.lower.heights -= &deepest[0];
        now.upper.heights += &deepest[1];
    }
    for (found, expected, before, lost) in [
        (&after.lower.heights, &now.lower.heights, &before.lower.heights, pass.lost("plastic")[0]),
        (&after.upper.heights, &now.upper.heights, &before.upper.heights, -pass.lost("plastic")[1]),
    ] {
        let off = (found - expected).fold(0.0, |most: f64, z| most.max(z.abs()));
        assert!(off < 100.0 * case.tolerance * case.sq + 1e-20, "heights differ by {off:e}: {}", what());
        let fell = area * (before - found).sum();
        let rounding = 1e-13 * area * before.len() as f64 * case.sq;
        assert!((fell - lost).abs() <= 1e-9 * lost.abs() + rounding, "{fell:e} {lost:e} {}", what());
    }
    after.clone()
}

/// Returns pressure and plastic interference at a position, at the approach of the record.
fn again(
    case: &Case,
    operators: &Operators,
    position: &Position,
    gap: &Field,
    step: &StepRecord,
) -> (Field, Field) {
    let shape = [position.columns, case.width];
    // In full contact of bodies periodic along both axes the approach does not determine the load.
    let full = step.contact_area > PITCH * PITCH * (gap.len() as f64 - 0.5);
    let normal = if case.boundary.leaves_mean_free() && full {
        Control::Load(step.load)
    } else {
        Control::Approach(step.approach)
    };
    let exact = Params::default().with_method(Method::Direct).with_tolerance(1e-9);
    let caps = Field::from_shape_fn(shape, |(j, iy)| {
        let [lower, upper] = case.facing(position, [j, iy]);
        lower.min(upper)
    });
    let bounds = Bounds::up_to(caps.clone());
    let of = |pressure: &Field, displacement: &Field, slides: Option<Friction>| {
        Field::from_shape_fn(shape, |at| {
            let cap = slides.map_or(caps[at], |friction| friction.sliding_cap(caps[at]));
            let w = step.approach - gap[at] - displacement[at];
            if pressure[at] >= cap { w.max(0.0) } else { 0.0 }
        })
    };
    match case.motion.friction {
        Some(friction) => {
            let mut operator: Box<dyn CoupledOperator> = operators.coupled_on(shape);
            let loading = Loading {
                normal,
                tangential: Tangential::Sliding([
                    position.stroke.sign() * case.motion.strategy.direction(),
                    0.0,
                ]),
            };
            let found = solve_frictional(operator.as_mut(), gap, &bounds, &friction, loading, None, &exact);
            let found = found.unwrap_or_else(|error| panic!("{error}: {case:?} {step:?}")).normal;
            let w = of(&found.pressure, &found.displacement, Some(friction));
            (found.pressure, w)
        }
        None => {
            let mut operator = operators.on(shape);
            let found = solve_normal(operator.as_mut(), gap, &bounds, normal, None, &exact);
            let found = found.unwrap_or_else(|error| panic!("{error}: {case:?} {step:?}"));
            let w = of(&found.pressure, &found.displacement, None);
            (found.pressure, w)
        }
    }
}
