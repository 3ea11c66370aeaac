//! The observer of a contact sees its progress, and can stop it within an iteration.

use std::sync::atomic::{AtomicUsize, Ordering};

use asperity_base::{Error, Grid};
use asperity_contact::material::Material;
use asperity_contact::motion::{
    Motion, Pair, Point, Progress, Simulation, SlipRegime, Strategy, SweepState, Watch, load_in_stages,
    press, sweep,
};
use asperity_contact::operator::Boundary;
use asperity_contact::solver::{Control, Creep, Friction, Loading, Method, Params, Rolling, Tangential};
use asperity_surface::Amplitude;

use crate::support::self_affine;

/// Counts its notifications, and stops after a number of calls or of positions.
pub(crate) struct Patience {
    told: AtomicUsize,
    asked: AtomicUsize,
    solved: AtomicUsize,
    most: usize,
    positions: usize,
}

impl Patience {
    fn new(most: usize) -> Self {
        let zero = AtomicUsize::default;
        Self { told: zero(), asked: zero(), solved: zero(), most, positions: usize::MAX }
    }

    pub(crate) fn positions(positions: usize) -> Self {
        Self { positions, ..Self::new(usize::MAX) }
    }
}

impl Watch for Patience {
    fn position(&self, _: &Progress) {
        self.solved.fetch_add(1, Ordering::Relaxed);
    }

    fn solving(&self, progress: &Progress) {
        let way = progress.together.expect("how far it has come");
        assert!((0.0..=1.0).contains(&way) && progress.solved < progress.positions, "{progress:?}");
        self.told.fetch_add(1, Ordering::Relaxed);
    }

    fn stop(&self) -> bool {
        let asked = self.asked.fetch_add(1, Ordering::Relaxed);
        asked >= self.most || self.solved.load(Ordering::Relaxed) >= self.positions
    }
}

fn pair(cells: usize) -> Pair {
    let grid = Grid::new([cells, cells], [1e-6; 2]).unwrap();
    let [steel, brass] = [(210e9, 0.3), (100e9, 0.35)].map(|(e, nu)| Material::new(e, nu, 4e9).unwrap());
    let [lower, upper] = [1, 2].map(|seed| self_affine(&grid, Amplitude::Sq(50e-9), None, seed));
    Pair::new(lower, upper.underside(), [&steel, &brass]).unwrap()
}

#[test]
fn a_contact_at_rest_tells_how_far_it_is_and_stops_when_it_is_asked_to() {
    for (method, cells) in [(Method::ActiveSet, 80), (Method::PolonskyKeer, 40), (Method::Direct, 16)] {
        let pair = pair(cells);
        let load = Control::Load(1e8 * pair.lower_grid().area());
        let params = Params::default().with_method(method);
        let patient = Patience::new(usize::MAX);
        let solved = press(&pair, Boundary::FREE, load, SlipRegime::Frictionless, &params, &patient).unwrap();
        let [told, asked] = [&patient.told, &patient.asked].map(|count| count.load(Ordering::Relaxed));
        assert!(method == Method::Direct || told > 2, "{method:?}: told {told} times");
        assert!(
            asked as f64 >= 0.5 * solved.solution.normal().stats.convolutions,
            "{method:?}: asked {asked} times"
        );
        // Every stop is reported, and an uninterrupted computation is the same to the last bit.
        for most in [0, asked / 3, asked / 2, asked - 1] {
            let stopped =
                press(&pair, Boundary::FREE, load, SlipRegime::Frictionless, &params, &Patience::new(most));
            assert!(matches!(stopped, Err(Error::Interrupted)), "{method:?}, {most} of {asked}: {stopped:?}");
        }
        let alone = press(&pair, Boundary::FREE, load, SlipRegime::Frictionless, &params, &()).unwrap();
        assert_eq!(alone.solution.normal().pressure, solved.solution.normal().pressure);
    }
}

#[test]
fn friction_and_rolling_stop_within_an_increment() {
    let pair = pair(24);
    let load = 1e8 * pair.lower_grid().area();
    let friction = Friction::coulomb(0.3).unwrap().with_junction_growth(9.0);
    let tangential = Tangential::Force([0.1 * load, 0.0]);
    let stage = asperity_contact::motion::Stage::new(Loading { normal: Control::Load(load), tangential }, 1);
    let params = Params::default();
    let staged = |watch: &Patience| {
        load_in_stages(&pair, Boundary::FREE, Some(&friction), &[stage], &params, None, watch, &mut [])
            .map(|_| ())
    };
    let rolling = Rolling { creep: Creep::Creepage([1e-3, 0.0]), spin: 0.0 };
    let plain = Friction::coulomb(0.3).unwrap();
    let rolled = |watch: &Patience| {
        press(&pair, Boundary::FREE, Control::Load(load), SlipRegime::Rolling(plain, rolling), &params, watch)
            .map(|_| ())
    };
    let run = |n: usize, watch: &Patience| if n == 0 { staged(watch) } else { rolled(watch) };
    for n in [0, 1] {
        let patient = Patience::new(usize::MAX);
        run(n, &patient).unwrap();
        let asked = patient.asked.load(Ordering::Relaxed);
        assert!(patient.told.load(Ordering::Relaxed) > 0 && asked > 5, "{n}: asked {asked} times");
        for most in [1, asked / 2, asked - 2] {
            let stopped = run(n, &Patience::new(most));
            assert!(matches!(stopped, Err(Error::Interrupted)), "{n}, {most} of {asked}: {stopped:?}");
        }
    }
}

#[test]
fn motions_and_sweeps_that_stop_within_a_solution_say_so_alone() {
    let pair = pair(12);
    let load = Control::Load(1e8 * pair.lower_grid().area());
    let params = Params::default().with_method(Method::ActiveSet);
    let moved = |watch: &Patience| {
        let motion = Motion::new(Strategy::Overlap, load).with_stride(4);
        Simulation::new(pair.clone(), Boundary::FREE, motion, params)?.run(watch, &mut [])
    };
    let points = [Point { control: load, regime: SlipRegime::Frictionless, speed: None }; 2];
    let swept = |watch: &Patience| {
        sweep(&pair, Boundary::FREE, &points, &params, SweepState::default(), watch, &mut []).map(|_| ())
    };
    let run = |n: usize, watch: &Patience| if n == 0 { moved(watch) } else { swept(watch) };
    for n in [0, 1] {
        let patient = Patience::new(usize::MAX);
        run(n, &patient).unwrap();
        let asked = patient.asked.load(Ordering::Relaxed);
        assert!(asked > 5, "{n}: asked {asked} times");
        for most in 0..asked - 2 {
            let stopped = run(n, &Patience::new(most));
            assert!(matches!(stopped, Err(Error::Interrupted)), "{n}, {most} of {asked}: {stopped:?}");
        }
    }
}
