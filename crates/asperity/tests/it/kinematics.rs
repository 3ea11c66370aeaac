//! How bodies meet in a motion: between columns, there and back, displaced across.

use asperity::material::Material;
use asperity::motion::{
    Contact, Law, LoadControl, Motion, Output, Pair, PassRecord, PassReport, Simulation, Strategy, Wear,
    WearCoefficient,
};
use asperity::operator::{Boundary, Edge, Operators};
use asperity::solver::{Bounds, Control, Friction, Method, Params, solve_normal};
use asperity::surface::{Amplitude, SelfAffine, Topography};
use asperity::{Field, Grid, Result};
use rand::{Rng, RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

const PITCH: f64 = 1e-6;

#[derive(Default)]
struct Kept {
    passes: Vec<PassRecord>,
    contacts: Vec<Vec<Contact>>,
    pairs: Vec<Pair>,
    mean_pressure: Vec<[Field; 2]>,
}

impl Output for Kept {
    fn pass(&mut self, report: &PassReport) -> Result<()> {
        self.passes.push(report.record.clone());
        self.contacts.push(report.contacts.to_vec());
        self.pairs.push(report.pair.clone());
        self.mean_pressure.push(report.mean_pressure());
        Ok(())
    }
}

fn rough(grid: &Grid, sq: f64, seed: u64) -> Topography {
    let amplitude = Amplitude::Sq(sq);
    SelfAffine { hurst: 0.8, rolloff: None, shortest: None, amplitude }.generate(grid, seed).unwrap()
}

fn archard(k: [f64; 2]) -> impl Law {
    let coefficient = |k: f64| (k > 0.0).then(|| WearCoefficient::archard(k).unwrap());
    Wear::new(k.map(coefficient), [None, None]).unwrap()
}

/// The height of a surface that goes round, at a real column.
fn height(surface: &Field, x: f64, iy: usize) -> f64 {
    let columns = surface.nrows() as isize;
    let below = x.floor();
    let at = |i: isize| surface[[i.rem_euclid(columns) as usize, iy]];
    let part = x - below;
    (1.0 - part) * at(below as isize) + if part > 0.0 { part * at(below as isize + 1) } else { 0.0 }
}

/// A value at a real column of a surface that goes round, to the columns on both sides of it.
fn scatter(sum: &mut Field, x: f64, iy: usize, value: f64) {
    let columns = sum.nrows() as isize;
    let below = x.floor();
    let part = x - below;
    for (i, weight) in [(below as isize, 1.0 - part), (below as isize + 1, part)] {
        sum[[i.rem_euclid(columns) as usize, iy]] += weight * value;
    }
}

/// A shift with two wearing bodies, drawn at random.
#[derive(Debug)]
struct Shifted {
    boundary: Boundary,
    columns: usize,
    width: usize,
    stride: usize,
    speeds: [f64; 2],
    hardness: [f64; 2],
    wear: [f64; 2],
    friction: Option<Friction>,
    seed: u64,
}

impl Shifted {
    fn random(rng: &mut impl Rng) -> Self {
        let edges = [0, 1].map(|_| [Edge::Free, Edge::Periodic][rng.random_range(0..2)]);
        let ratio = [rng.random_range(-1.0..1.0), 0.5, -0.25, 1.0 / 3.0][rng.random_range(0..4)];
        let speeds = [[ratio, 1.0], [-1.0, ratio]][rng.random_range(0..2)];
        Self {
            boundary: Boundary(edges),
            columns: rng.random_range(5..13),
            width: rng.random_range(1..7),
            stride: rng.random_range(1..4),
            speeds,
            hardness: [[f64::INFINITY; 2], [3e9, 3e9], [2e9, 5e9], [f64::INFINITY, 2e9]]
                [rng.random_range(0..4)],
            wear: [rng.random_range(1e-16..1e-14), rng.random_range(1e-16..1e-14)],
            friction: [None, Some(Friction::coulomb(0.2).unwrap())][rng.random_range(0..2)],
            seed: rng.random_range(0..1_000_000),
        }
    }

    fn pair(&self) -> Pair {
        let grid = Grid::new([self.columns, self.width], [PITCH; 2]).unwrap();
        let [lower, upper] = self.hardness.map(|hardness| Material::new(210e9, 0.3, hardness).unwrap());
        Pair::new(rough(&grid, 20e-9, self.seed), rough(&grid, 20e-9, self.seed + 1), [&lower, &upper])
            .unwrap()
    }

    /// How far both surfaces have moved at a position, in columns.
    fn moved(&self, step: usize) -> [f64; 2] {
        let fastest = self.speeds[0].abs().max(self.speeds[1].abs());
        self.speeds.map(|speed| (step * self.stride) as f64 * speed / fastest)
    }
}

#[test]
fn surfaces_between_columns_meet_and_wear_as_by_dense_interpolation() {
    let cases = std::env::var("CASES").map_or(40, |text| text.parse().unwrap());
    let (mut between, mut yielded) = (0, 0);
    for index in 0..cases {
        let case = Shifted::random(&mut ChaCha8Rng::seed_from_u64(index));
        let Shifted { columns, width, .. } = case;
        let area = PITCH * PITCH;
        let load = 0.4e9 * area * (columns * width) as f64;
        let [speed_lower, speed_upper] = case.speeds;
        let motion = Motion::new(Strategy::Shift { speed_lower, speed_upper }, Control::Load(load))
            .with_stride(case.stride)
            .with_friction(case.friction);
        let params = Params::default().with_tolerance(1e-9);
        let before = case.pair();
        let mut kept = Kept::default();
        let mut simulation = Simulation::new(before.clone(), case.boundary, motion, params)
            .unwrap()
            .with_law(archard(case.wear));
        simulation.run(&(), &mut [&mut kept]).unwrap_or_else(|error| panic!("{error}: {case:?}"));
        let slip = case.stride as f64 * PITCH * (speed_upper - speed_lower).abs();
        let zeros = || [Field::zeros([columns, width]), Field::zeros([columns, width])];
        let [mut worn, mut flown, mut pressed] = [zeros(), zeros(), zeros()];
        let operators = Operators::new(before.lower_grid(), before.response().clone(), case.boundary);
        let mut force = 0.0;
        for (step, contact) in kept.contacts[0].iter().enumerate() {
            let moved = case.moved(step);
            let place = |body: usize, j: usize| {
                let x = j as f64 - moved[body];
                if (x - x.round()).abs() < 1e-9 { x.round() } else { x }
            };
            between += usize::from(contact.position.fraction != [0.0; 2]);
            let gap = Field::from_shape_fn([columns, width], |(j, iy)| {
                height(&before.upper.heights, place(1, j), iy)
                    - height(&before.lower.heights, place(0, j), iy)
            });
            let found = before.initial_gap(&contact.position);
            assert!((&found - &gap).iter().all(|off| off.abs() < 1e-20), "{case:?}");
            // The load at this approach, by an exact method.
            let hardest = case.hardness[0].min(case.hardness[1]);
            let cap = case.friction.map_or(hardest, |friction| friction.sliding_cap(hardest));
            let full = contact.pressure.len() == columns * width;
            if !(case.boundary.leaves_mean_free() && full) {
                let exact = Params::default().with_method(Method::Direct).with_tolerance(1e-10);
                let control = Control::Approach(contact.approach);
                let mut operator = operators.on([columns, width]);
                let again = solve_normal(operator.as_mut(), &gap, &Bounds::up_to(cap), control, None, &exact);
                let off = (again.unwrap().load() - contact.load) / load;
                assert!(off.abs() < 1e-5, "{off:e}: {case:?}");
            }
            force += contact.load;
            let deep = contact.interference();
            let mut here = zeros();
            for (&(cell, p), w) in contact.pressure.iter().zip(deep) {
                let (j, iy) = (cell as usize / width, cell as usize % width);
                let share = match case.hardness {
                    [lower, upper] if lower < upper => [1.0, 0.0],
                    [lower, upper] if lower > upper => [0.0, 1.0],
                    _ => [0.5; 2],
                };
                yielded += usize::from(w > 0.0);
                for body in 0..2 {
                    scatter(&mut worn[body], place(body, j), iy, case.wear[body] * p * slip);
                    scatter(&mut here[body], place(body, j), iy, share[body] * w);
                    scatter(&mut pressed[body], place(body, j), iy, p / kept.contacts[0].len() as f64);
                }
            }
            for body in 0..2 {
                flown[body].zip_mut_with(&here[body], |most, w| *most = most.max(*w));
            }
        }
        let pass = &kept.passes[0];
        for body in 0..2 {
            let expected = case.wear[body] * force * slip;
            let off = pass.lost("wear")[body] / expected - 1.0;
            assert!(off.abs() < 1e-12, "volume {off:e}: {case:?}");
            let flow = area * flown[body].sum();
            assert!((pass.lost("plastic")[body] - flow).abs() <= 1e-12 * flow, "{case:?}");
            let fell = match body {
                0 => &before.lower.heights - &kept.pairs[0].lower.heights,
                _ => &kept.pairs[0].upper.heights - &before.upper.heights,
            };
            let off = &fell - &worn[body] - &flown[body];
            assert!(off.iter().all(|off| off.abs() < 1e-21), "{:e}: {case:?}", off[[0, 0]]);
            let ledger = area * fell.sum() / (pass.lost("wear")[body] + pass.lost("plastic")[body]) - 1.0;
            assert!(ledger.abs() < 1e-9, "ledger {ledger:e}: {case:?}");
            let off = &kept.mean_pressure[0][body] - &pressed[body];
            assert!(off.iter().all(|off| off.abs() < 1e-3), "{case:?}");
        }
    }
    assert!(between > 3 * cases as usize && yielded > 100, "{between} {yielded}");
}

/// What is the same along the sliding does not see where between its columns the other surface is.
#[test]
fn grooves_along_the_sliding_wear_as_by_whole_cells() {
    let grid = Grid::new([10, 16], [PITCH; 2]).unwrap();
    let groove = |phase: f64, grid: &Grid| {
        let wave = |iy: usize| 5e-9 * (std::f64::consts::TAU * (iy as f64 / 16.0 + phase)).cos();
        Topography::new(*grid, Field::from_shape_fn(grid.shape, |(_, iy)| wave(iy))).unwrap()
    };
    let material = Material::new(210e9, 0.3, 2e9).unwrap();
    let run = |speed_lower: f64| {
        let pair = Pair::new(groove(0.0, &grid), groove(0.3, &grid), [&material, &material]).unwrap();
        let strategy = Strategy::Shift { speed_lower, speed_upper: 1.0 };
        let motion = Motion::new(strategy, Control::Load(0.3e9 * grid.area()));
        let motion = motion.with_passes(3).with_load_control(LoadControl::Step);
        let mut kept = Kept::default();
        // So much per distance that it is the same in each step.
        let k = 1e-15 / (1.0 - speed_lower);
        let params = Params::default().with_tolerance(1e-10);
        let simulation = Simulation::new(pair, Boundary::PERIODIC, motion, params).unwrap();
        simulation.with_law(archard([k, 2.0 * k])).run(&(), &mut [&mut kept]).unwrap();
        kept
    };
    let whole = run(0.0);
    for speed_lower in [0.3, -0.45] {
        let between = run(speed_lower);
        for (a, b) in whole.pairs.iter().zip(&between.pairs) {
            for (a, b) in [(&a.lower, &b.lower), (&a.upper, &b.upper)] {
                let off = (&a.heights - &b.heights).fold(0.0, |most: f64, off| most.max(off.abs()));
                assert!(off < 1e-16, "{off:e}");
            }
        }
    }
}
