//! Relative positions of the bodies in a motion: between columns, on forward and return strokes, with offsets
//! along y.

use asperity_base::{Error, Field, Grid};
use asperity_contact::material::Material;
use asperity_contact::motion::{
    Acceleration, Changes, LoadControl, Motion, OffsetY, Pair, Path, PlasticUpdate, Simulation, StepRecord,
    Strategy, Stroke,
};
use asperity_contact::operator::{Boundary, Edge, Operators};
use asperity_contact::solver::{Bounds, Control, Friction, Method, Params, solve_normal};
use asperity_contact::temperature::Thermal;
use asperity_surface::{Amplitude, Topography};
use rand::{Rng, RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use crate::support::{Kept, archard, self_affine, steel};

const PITCH: f64 = 1e-6;
const ROUGHNESS: Amplitude = Amplitude::Sq(20e-9);

/// Height of a periodic surface at a fractional column.
fn height(surface: &Field, x: f64, iy: usize) -> f64 {
    let columns = surface.nrows() as isize;
    let below = x.floor();
    let at = |i: isize| surface[[i.rem_euclid(columns) as usize, iy]];
    let part = x - below;
    (1.0 - part) * at(below as isize) + if part > 0.0 { part * at(below as isize + 1) } else { 0.0 }
}

/// Scatters a value at a fractional column of a periodic surface to the two adjacent columns.
fn scatter(sum: &mut Field, x: f64, iy: usize, value: f64) {
    let columns = sum.nrows() as isize;
    let below = x.floor();
    let part = x - below;
    for (i, weight) in [(below as isize, 1.0 - part), (below as isize + 1, part)] {
        sum[[i.rem_euclid(columns) as usize, iy]] += weight * value;
    }
}

/// A random shift with two wearing bodies.
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
        let [lower, upper] = self.hardness.map(steel);
        let [below, above] = [0, 1].map(|k| self_affine(&grid, ROUGHNESS, None, self.seed + k));
        Pair::new(below, above, [&lower, &upper]).unwrap()
    }

    /// Displacement of both surfaces at a position, in columns.
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
        let simulation = Simulation::new(before.clone(), case.boundary, motion, params).unwrap();
        let kept = Kept::run(simulation.with_changes(Changes::by(archard(case.wear))).unwrap());
        // The positions share one round.
        let stride = columns as f64 / columns.div_ceil(case.stride) as f64;
        let slip = stride * PITCH * (speed_upper - speed_lower).abs();
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
    assert!(between > 2 * cases as usize && yielded > 100, "{between} {yielded}");
}

/// A surface that is uniform along the sliding direction is not affected by the fractional column of the
/// other.
#[test]
fn grooves_along_the_sliding_wear_as_by_whole_cells() {
    let grid = Grid::new([10, 16], [PITCH; 2]).unwrap();
    let groove = |phase: f64, grid: &Grid| {
        let wave = |iy: usize| 5e-9 * (std::f64::consts::TAU * (iy as f64 / 16.0 + phase)).cos();
        Topography::new(*grid, Field::from_shape_fn(grid.shape, |(_, iy)| wave(iy))).unwrap()
    };
    let material = steel(2e9);
    let run = |speed_lower: f64| {
        let pair = Pair::new(groove(0.0, &grid), groove(0.3, &grid), [&material, &material]).unwrap();
        let strategy = Strategy::Shift { speed_lower, speed_upper: 1.0 };
        let motion = Motion::new(strategy, Control::Load(0.3e9 * grid.area()));
        let motion = motion.with_passes(3).with_load_control(LoadControl::Step);
        // Wear per distance chosen to be equal in each step.
        let k = 1e-15 / (1.0 - speed_lower);
        let params = Params::default().with_tolerance(1e-10);
        let simulation = Simulation::new(pair, Boundary::PERIODIC, motion, params).unwrap();
        Kept::run(simulation.with_changes(Changes::by(archard([k, 2.0 * k]))).unwrap())
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

const OVERLAP: Motion = Motion::new(Strategy::Overlap, Control::Load(0.05)).with_stride(3);

fn two(columns: [usize; 2], materials: [&Material; 2], seed: u64) -> Pair {
    let grid = |columns| Grid::new([columns, 10], [PITCH; 2]).unwrap();
    let surface = |columns, seed| self_affine(&grid(columns), ROUGHNESS, None, seed);
    Pair::new(surface(columns[0], seed), surface(columns[1], seed + 1), materials).unwrap()
}

fn run(pair: Pair, boundary: Boundary, motion: Motion, wear: [f64; 2]) -> Kept {
    let simulation = Simulation::new(pair, boundary, motion, Params::default().with_tolerance(1e-9)).unwrap();
    Kept::run(simulation.with_changes(Changes::by(archard(wear))).unwrap())
}

fn furthest(a: &Field, b: &Field) -> f64 {
    (a - b).fold(0.0, |most, off| most.max(off.abs()))
}

#[test]
fn the_way_back_meets_the_contacts_of_the_way_forth_again_and_wears_as_much() {
    let material = steel(3e9);
    let friction = Friction::coulomb(0.2).unwrap();
    let pair = two([16, 13], [&material; 2], 5);
    let run = |path| {
        run(pair.clone(), Boundary::FREE, OVERLAP.with_friction(friction).with_path(path), [1e-15, 3e-15])
    };
    let (there, back) = (run(Path::OneWay), run(Path::Reciprocating));
    let [forth, both] = [&there.contacts[0], &back.contacts[0]];
    let n = forth.len();
    assert_eq!(both.len(), 2 * n);
    for (k, contact) in both.iter().enumerate() {
        let again = &forth[if k < n { k } else { 2 * n - 1 - k }];
        assert_eq!((&contact.pressure, &contact.plastic), (&again.pressure, &again.plastic));
        assert_eq!(contact.position.stroke, if k < n { Stroke::Forth } else { Stroke::Back });
        assert_eq!(contact.position.offset, again.position.offset);
        assert_eq!(contact.tangential_force, contact.position.stroke.sign() * again.tangential_force);
        assert_eq!(contact.stats.convolutions == 0.0, k >= n);
    }
    let [one, two] = [&there.passes[0], &back.passes[0]];
    for body in 0..2 {
        assert!((two.lost("wear")[body] / one.lost("wear")[body] / 2.0 - 1.0).abs() < 1e-12);
        assert_eq!(two.lost("plastic")[body], one.lost("plastic")[body]);
    }
    let [one_way, both_ways] = [one, two].map(|pass| pass.running.unwrap());
    assert!((both_ways.distance / one_way.distance - 2.0).abs() < 1e-12);
    assert!((both_ways.friction_work / one_way.friction_work - 2.0).abs() < 1e-12);
    assert!((two.friction_coefficient - 0.2).abs() < 1e-9 && two.mean_tangential_force.abs() < 1e-12);
    assert_eq!(one.convolutions, two.convolutions);
    assert_eq!(back.steps.len(), 2 * n);
    assert!(furthest(&back.mean_pressure[0][0], &there.mean_pressure[0][0]) < 1e-3);
}

/// If friction displaces the surfaces, the return stroke is the forward stroke of the mirrored bodies.
#[test]
fn the_way_back_of_dissimilar_bodies_is_that_of_their_mirror_images() {
    let materials = [&steel(f64::INFINITY), &Material::new(5e9, 0.2, f64::INFINITY).unwrap()];
    let motion = OVERLAP.with_control(Control::Load(0.002)).with_friction(Friction::coulomb(0.4).unwrap());
    let motion = motion.with_load_control(LoadControl::Step);
    let pair = two([12, 12], materials, 8);
    let mirrored = |surface: &Field| {
        let mut heights = surface.clone();
        heights.invert_axis(ndarray::Axis(0));
        Topography::new(pair.lower_grid(), heights.as_standard_layout().into_owned()).unwrap()
    };
    let mirror = Pair::new(mirrored(&pair.lower.heights), mirrored(&pair.upper.heights), materials).unwrap();
    let back = run(pair, Boundary::FREE, motion.with_path(Path::Reciprocating), [0.0, 1e-15]);
    let seen = run(mirror, Boundary::FREE, motion, [0.0, 1e-15]);
    let n = seen.contacts[0].len();
    let mut unlike = 0.0f64;
    for (contact, seen) in back.contacts[0][n..].iter().zip(&seen.contacts[0]) {
        assert_eq!(contact.position.offset, -seen.position.offset);
        let mut field = seen.pressure_field(10);
        field.invert_axis(ndarray::Axis(0));
        let largest = contact.max_pressure();
        assert!(furthest(&contact.pressure_field(10), &field) < 1e-5 * largest);
        let forth = back.contacts[0].iter().find(|c| c.position.offset == contact.position.offset).unwrap();
        unlike = unlike.max(furthest(&forth.pressure_field(10), &contact.pressure_field(10)) / largest);
    }
    assert!(unlike > 1e-3, "{unlike:e}");
}

#[test]
fn bodies_that_yield_step_by_step_go_on_yielding_on_the_way_back() {
    let material = steel(2e9);
    let motion = OVERLAP.with_plastic_update(PlasticUpdate::Step).with_path(Path::Reciprocating);
    let pair = two([12, 12], [&material; 2], 3);
    let kept = Kept::run(Simulation::new(pair, Boundary::FREE, motion, Params::default()).unwrap());
    let n = kept.steps.len() / 2;
    assert!(kept.steps[n..].iter().all(|step| step.convolutions > 0.0));
    let volume = |steps: &[StepRecord]| steps.iter().map(|step| step.plastic_volume).sum::<f64>();
    assert!(volume(&kept.steps[n..]) < volume(&kept.steps[..n]));
    let lost: f64 = kept.passes[0].lost("plastic").iter().sum();
    assert!((volume(&kept.steps) / lost - 1.0).abs() < 1e-9);
}

/// With forward and return strokes, a pass solved with its wear equals a one-way pass with twice the wear.
#[test]
fn a_pass_there_and_back_is_solved_with_the_wear_of_both_ways() {
    let pair = two([12, 12], [&steel(f64::INFINITY); 2], 3);
    let motion = OVERLAP.with_strategy(Strategy::Shift { speed_lower: 0.0, speed_upper: 1.0 });
    let motion = motion.with_control(Control::Load(0.2)).with_stride(2);
    // Above the limit of explicit wear for a cell in contact all the time, over both strokes.
    let k = 2.0 * 0.45 * PITCH / pair.modulus() / (12.0 * PITCH);
    let both = run(pair.clone(), Boundary::PERIODIC, motion.with_path(Path::Reciprocating), [k, k]);
    let twice = run(pair.clone(), Boundary::PERIODIC, motion, [2.0 * k, 2.0 * k]);
    for (a, b) in [
        (&both.pairs[0].lower.heights, &twice.pairs[0].lower.heights),
        (&both.pairs[0].upper.heights, &twice.pairs[0].upper.heights),
    ] {
        let change = furthest(a, &pair.lower.heights).max(1e-9);
        assert!(furthest(a, b) < 1e-6 * change, "{:e} of {change:e}", furthest(a, b));
    }
    let [one, two] = [&both.passes[0], &twice.passes[0]].map(|pass| pass.lost("wear")[0]);
    assert!((one / two - 1.0).abs() < 1e-9, "{one:e} {two:e}");
}

/// Passes with a return stroke repeat at any speeds; one-way passes do not.
#[test]
fn jumps_are_where_passes_repeat() {
    let shift = Strategy::Shift { speed_lower: 0.3, speed_upper: 1.0 };
    let motion = OVERLAP.with_strategy(shift).with_passes(40);
    let pair = two([12, 12], [&steel(f64::INFINITY); 2], 3);
    let accelerated = |motion: Motion| {
        let simulation =
            Simulation::new(pair.clone(), Boundary::PERIODIC, motion, Params::default()).unwrap();
        simulation.with_changes(Changes::by(archard([1e-15; 2])).with_acceleration(Acceleration::default()))
    };
    let refused = [motion, motion.with_path(Path::Reciprocating).with_offset_y(OffsetY::Cells(2))];
    for motion in refused {
        assert!(!motion.repeats() && matches!(accelerated(motion), Err(Error::Unsupported(_))));
    }
    let motion = motion.with_path(Path::Reciprocating);
    let few = Kept::run(accelerated(motion).unwrap());
    let all = run(pair.clone(), Boundary::PERIODIC, motion, [1e-15; 2]);
    assert!(few.passes.len() < 20 && all.passes.len() == 40, "{}", few.passes.len());
    let [few, all] = [&few, &all].map(|kept| &kept.last().lower.heights);
    let change = furthest(all, &pair.lower.heights);
    assert!(furthest(few, all) < 0.02 * change, "{:e} of {change:e}", furthest(few, all));
}

/// Each pass of a one-way shift continues from the end of the one before.
#[test]
fn the_slower_surface_goes_on_from_pass_to_pass() {
    let shift = Strategy::Shift { speed_lower: 0.3, speed_upper: 1.0 };
    let motion = OVERLAP.with_strategy(shift).with_stride(1);
    let place = |pass: usize, step: usize| motion.positions([12, 12], 10, pass)[step].places()[0];
    for pass in 1..9 {
        for step in 0..12 {
            let moved = 0.3 * (12 * (pass - 1) + step) as f64;
            let turns = (place(pass, step) + moved) / 12.0;
            assert!((turns - turns.round()).abs() < 1e-9, "{pass} {step}");
        }
    }
}

/// A pass with an offset along y equals one of an upper body that is shifted accordingly.
#[test]
fn a_body_displaced_across_is_one_whose_cells_are_moved() {
    let line = Boundary([Edge::Free, Edge::Periodic]);
    let motion = OVERLAP.with_load_control(LoadControl::Step);
    let materials = [&steel(3e9), &steel(3e9)];
    for offset_y in [OffsetY::Cells(3), OffsetY::Random { seed: 7 }] {
        let first = two([14, 11], materials, 21);
        let displaced =
            run(first.clone(), line, motion.with_passes(4).with_offset_y(offset_y), [2e-15, 1e-15]);
        let rolled = |field: &Field, cells: usize| {
            Field::from_shape_fn(field.raw_dim(), |(i, j)| field[[i, (j + 10 - cells) % 10]])
        };
        let mut pair = first;
        let mut offsets = Vec::new();
        for (pass, after) in (1..).zip(&displaced.pairs) {
            let cells = offset_y.of_pass(pass, 10);
            offsets.push(cells);
            let mut moved = pair.clone();
            moved.upper.heights = rolled(&pair.upper.heights, cells);
            moved.upper.state.clear();
            let once = run(moved, line, motion, [2e-15, 1e-15]);
            pair.lower.heights = once.pairs[0].lower.heights.clone();
            pair.upper.heights = rolled(&once.pairs[0].upper.heights, 10 - cells);
            let off = furthest(&pair.lower.heights, &after.lower.heights)
                .max(furthest(&pair.upper.heights, &after.upper.heights));
            assert!(off < 1e-15, "pass {pass}: {off:e}");
        }
        let told: Vec<_> = displaced.steps.iter().map(|step| (step.pass, step.offset_y.unwrap())).collect();
        assert!(told.iter().all(|(pass, y)| (y - offsets[pass - 1] as f64 * PITCH).abs() < 1e-20));
        assert!(offsets.windows(2).any(|pair| pair[0] != pair[1]), "{offsets:?}");
    }
    let pair = two([14, 11], materials, 21);
    let refused =
        Simulation::new(pair, Boundary::FREE, motion.with_offset_y(OffsetY::Cells(1)), Params::default());
    assert!(matches!(refused, Err(Error::Unsupported(_))));
}

/// Each pass with a new counterbody is a first pass on the present lower body.
#[test]
fn a_fresh_counter_body_begins_anew_in_each_pass() {
    let bodies = |seed| two([14, 11], [&steel(3e9), &steel(3e9)], seed);
    let motion = OVERLAP.with_load_control(LoadControl::Step);
    let first = bodies(2);
    let upper = move |pass: usize| bodies(2 + 10 * (pass as u64 - 1)).upper.heights;
    let params = Params::default().with_tolerance(1e-9);
    let simulation = Simulation::new(first.clone(), Boundary::FREE, motion.with_passes(4), params);
    let simulation = simulation.unwrap().with_changes(Changes::by(archard([2e-15, 1e-15]))).unwrap();
    let virgin = simulation.pair().upper.clone();
    let counter = move |pass: usize| {
        let mut body = virgin.clone();
        body.heights = upper(pass);
        Ok(body)
    };
    let kept = Kept::run(simulation.with_counter(counter).unwrap());
    let mut pair = first;
    for (pass, after) in (1..).zip(&kept.pairs) {
        pair.upper.heights = upper(pass);
        pair.upper.state.clear();
        let once = run(pair.clone(), Boundary::FREE, motion, [2e-15, 1e-15]);
        let [a, b] = [&once.pairs[0], after];
        assert!(furthest(&a.lower.heights, &b.lower.heights) < 1e-15, "pass {pass}");
        assert!(furthest(&a.upper.heights, &b.upper.heights) < 1e-15, "pass {pass}");
        assert!(furthest(&a.upper.state["wear"].values, &b.upper.state["wear"].values) < 1e-15);
        // The ledger of the upper body covers one pass.
        let lost = kept.passes[pass - 1].lost("wear")[1] + kept.passes[pass - 1].lost("plastic")[1];
        let rose = PITCH * PITCH * (&after.upper.heights - &upper(pass)).sum();
        assert!((rose / lost - 1.0).abs() < 1e-9, "{rose:e} {lost:e}");
        pair.lower = a.lower.clone();
    }
    let again = Simulation::new(pair, Boundary::FREE, motion, Params::default()).unwrap();
    let again = again
        .with_changes(Changes::by(archard([1e-15; 2])).with_acceleration(Acceleration::default()))
        .unwrap();
    assert!(matches!(again.with_counter(|_| unreachable!()), Err(Error::Unsupported(_))));
}

/// Heat is kept over the turn: on the way back the contact returns to a place that is still hot.
#[test]
fn a_pass_there_and_back_is_heated_without_a_break() {
    let thermal = Thermal::new(46.0, 460.0, 7850.0).unwrap();
    let run = |path| {
        let motion = OVERLAP
            .with_strategy(Strategy::Shift { speed_lower: 0.0, speed_upper: 2.0 })
            .with_control(Control::Load(0.02))
            .with_stride(1)
            .with_friction(Friction::coulomb(0.3).unwrap())
            .with_path(path);
        let pair = two([16, 16], [&steel(f64::INFINITY); 2], 4);
        let simulation = Simulation::new(pair, Boundary::PERIODIC, motion, Params::default()).unwrap();
        let changes = Changes::default().with_bulk([300.0; 2]).with_heat([thermal; 2], 1);
        let kept = Kept::run(simulation.with_changes(changes).unwrap());
        kept.steps.iter().map(|step| step.heat.unwrap().max_flash_temperature - 300.0).collect::<Vec<_>>()
    };
    let (there, both) = (run(Path::OneWay), run(Path::Reciprocating));
    for (a, b) in there.iter().zip(&both) {
        assert!((a / b - 1.0).abs() < 2e-3, "{a} {b}");
    }
    // The contact stays for another step, and its temperature rises. Later passes find higher temperatures at
    // the same place.
    assert!(both[16] > both[15] && both[31] > both[0], "{both:?}");
}

#[test]
fn heat_of_what_goes_round_is_not_that_of_a_free_edge() {
    let thermal = Thermal::new(46.0, 460.0, 7850.0).unwrap();
    let motion = OVERLAP
        .with_strategy(Strategy::Shift { speed_lower: 0.0, speed_upper: 2.0 })
        .with_friction(Friction::coulomb(0.3).unwrap());
    let pair = two([16, 16], [&steel(f64::INFINITY); 2], 4);
    let simulation = Simulation::new(pair, Boundary::FREE, motion, Params::default()).unwrap();
    let changes = Changes::default().with_bulk([300.0; 2]).with_heat([thermal; 2], 1);
    assert!(matches!(simulation.with_changes(changes), Err(Error::Unsupported(_))));
}
