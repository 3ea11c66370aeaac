//! Adhesive contacts against closed forms and an independent program.

use std::f64::consts::FRAC_1_PI;
use std::sync::Arc;

use asperity_base::{CellValues, Error, Field, Grid};
use asperity_contact::adhesion::{Adhesion, Potential};
use asperity_contact::material::Material;
use asperity_contact::motion::{Pair, Stage, load_in_stages};
use asperity_contact::operator::{Boundary, FreeFft, Operator, PeriodicFft};
use asperity_contact::reference::{KendallPunch, MaugisSphere};
use asperity_contact::solver::{Bounds, Control, Loading, Params, Solution, solve_adhesive, solve_normal};
use asperity_surface::{Amplitude, SelfAffine, Topography};

const ELASTIC: CellValues = CellValues::Uniform(f64::INFINITY);
/// Modulus and work of adhesion for which loads are in πwR and lengths in the units of Maugis, with a sphere
/// of radius 1.
const MODULUS: f64 = 0.75;
const WORK: f64 = FRAC_1_PI;

/// A contact and the last state that it reached.
struct Contact {
    operator: Box<dyn Operator>,
    gap: Field,
    adhesion: Adhesion,
    last: Option<Solution>,
}

impl Contact {
    fn sphere(cells: usize, width: f64, adhesion: Adhesion) -> Self {
        let pitch = width / cells as f64;
        let grid = Grid::new([cells, cells], [pitch, pitch]).unwrap();
        let gap = sphere(&grid);
        Self { operator: Box::new(FreeFft::new(grid, MODULUS)), gap, adhesion, last: None }
    }

    fn to(&mut self, control: Control) -> Result<&Solution, Error> {
        let Self { operator, gap, adhesion, last } = self;
        let params = Params::new();
        let next =
            solve_adhesive(operator.as_mut(), gap, adhesion, &ELASTIC, control, last.as_ref(), &params)?;
        Ok(last.insert(next))
    }

    /// Returns the load at an approach.
    fn load_at(&mut self, approach: f64) -> f64 {
        self.to(Control::Approach(approach)).unwrap().load()
    }

    /// Returns the least load of a retreat in `steps` from one approach to another.
    fn least_load(&mut self, from: f64, to: f64, steps: usize) -> f64 {
        let approaches = (0..=steps).map(|n| from + (to - from) * n as f64 / steps as f64);
        approaches.map(|approach| self.load_at(approach)).fold(f64::INFINITY, f64::min)
    }
}

/// Gap under a sphere of radius 1 in the middle of a square grid.
fn sphere(grid: &Grid) -> Field {
    let at = |index| grid.centre(0, index) - 0.5 * grid.extent()[0];
    Field::from_shape_fn(grid.shape, |(i, j)| 0.5 * (at(i).powi(2) + at(j).powi(2)))
}

/// The exponential attraction with Maugis' parameter λ.
fn exponential(lambda: f64) -> Adhesion {
    Adhesion::new(WORK, WORK / (0.5 * lambda)).unwrap()
}

/// Least load of a sphere with a constant tension on a grid of so many cells, over the closed form of Maugis,
/// minus 1.
fn maugis_error(lambda: f64, cells: usize) -> f64 {
    let exact = MaugisSphere::from_lambda(1.0, MODULUS, WORK, lambda);
    let adhesion = Adhesion::new(WORK, WORK / exact.tension).unwrap().with_potential(Potential::Dugdale);
    let a = exact.pull_off_radius();
    // The zone of attraction at the first approach is the largest.
    let zone = 1.35 * exact.outer_ratio(1.35);
    let mut contact = Contact::sphere(cells, 2.3 * zone, adhesion);
    let [top, turn] = [1.35, a].map(|a| exact.approach(a));
    contact.least_load(top, turn - 0.25, 14) / exact.pull_off() - 1.0
}

#[test]
fn a_constant_tension_pulls_as_maugis_says() {
    for (lambda, most) in [(0.05, 0.01), (0.5, 0.03), (1.0, 0.06)] {
        let error = maugis_error(lambda, 72);
        assert!(error.abs() < most, "λ = {lambda}: {error}");
    }
}

#[test]
#[ignore = "a minute: eight parameters on two grids"]
fn a_constant_tension_pulls_as_maugis_says_for_every_parameter() {
    for (lambda, most) in [
        (0.05, 0.01),
        (0.1, 0.01),
        (0.3, 0.02),
        (0.5, 0.03),
        (1.0, 0.04),
        (2.0, 0.1),
        (3.0, 0.2),
        (5.0, 0.35),
    ] {
        let [coarse, fine] = [64, 128].map(|cells| maugis_error(lambda, cells));
        assert!(fine.abs() < most, "λ = {lambda}: {fine}");
        // The process zone of larger λ is below a cell of the coarse grid.
        let is_resolved = lambda < 2.5;
        assert!(
            !is_resolved || fine.abs() < 0.9 * coarse.abs() || fine.abs() < 0.01,
            "λ = {lambda}: {coarse} {fine}"
        );
    }
}

/// The numbers are those of an independent program.
#[test]
fn the_pull_off_force_converges_with_the_cells_of_the_process_zone() {
    let expected = [(24, -1.6319), (32, -1.6300), (48, -1.6234), (64, -1.6220)];
    for (cells, load) in expected {
        let mut contact = Contact::sphere(cells, 4.8, exponential(1.5));
        let least = contact.least_load(0.1, -0.9, 20);
        assert!((least - load).abs() < 8e-3, "{cells} cells: {least}");
    }
}

/// The largest difference between the loads on the way apart and back, between the jumps.
fn hysteresis(cells: usize, lambda: f64) -> f64 {
    let mut contact = Contact::sphere(cells, 4.8, exponential(lambda));
    let approaches = || (0..=28).map(|n| 0.4 - 0.03 * f64::from(n));
    let apart: Vec<f64> = approaches().map(|approach| contact.load_at(approach)).collect();
    let back: Vec<f64> = approaches().rev().map(|approach| contact.load_at(approach)).collect();
    apart.iter().zip(back.iter().rev()).map(|(one, other)| (one - other).abs()).fold(0.0, f64::max)
}

#[test]
fn a_lattice_that_resolves_the_process_zone_causes_no_hysteresis() {
    // Process zones of 1.5 and of 0.1 cells.
    let [resolved, coarse] = [hysteresis(54, 1.5), hysteresis(24, 4.0)];
    assert!(resolved < 1e-4, "{resolved}");
    assert!(coarse > 1e-2, "{coarse}");
}

#[test]
fn a_state_between_jumps_does_not_depend_on_the_increments() {
    let end = |steps: usize| {
        let mut contact = Contact::sphere(48, 4.8, exponential(1.5));
        contact.load_at(0.5);
        for n in 1..=steps {
            contact.load_at(0.5 - n as f64 / steps as f64);
        }
        contact.last.unwrap().load()
    };
    let one = end(1);
    for steps in [2, 5, 13] {
        assert!((end(steps) - one).abs() < 1e-5, "{steps} steps: {} {one}", end(steps));
    }
}

/// A punch of this many cells along its radius, drawn off by a load.
fn kendall(cells: usize) -> f64 {
    let grid = Grid::new([2 * cells + 2; 2], [1.0 / cells as f64; 2]).unwrap();
    let half = 0.5 * grid.extent()[0];
    let at = |i: usize| grid.centre(0, i) - half;
    let inside = |(i, j): (usize, usize)| at(i).hypot(at(j)) < 1.0;
    let gap = Field::from_shape_fn(grid.shape, |cell| if inside(cell) { 0.0 } else { 9.0 });
    let work = 1e-3;
    // The tension of the outermost cells is that at which Pohrt & Popov, Facta Univ. Mech. Eng. 13, 3 (2015),
    // let a cell go. The edge of a punch does not move before it lets go, so that the grid need not resolve
    // the process zone.
    let range = (0.473_201 * work * grid.pitch[0]).sqrt();
    let adhesion = Adhesion::new(work, range).unwrap();
    let cells_inside = gap.iter().filter(|h| **h == 0.0).count();
    let radius = (cells_inside as f64 * grid.cell_area() / std::f64::consts::PI).sqrt();
    let mut contact = Contact { operator: Box::new(FreeFft::new(grid, 1.0)), gap, adhesion, last: None };
    contact.load_at(0.01);
    let pull = -adhesion.max_tension() * grid.area();
    let Err(Error::PullOff { least, .. }) = contact.to(Control::Load(pull)) else { panic!("it holds") };
    least / KendallPunch { radius, modulus: 1.0, work }.pull_off() - 1.0
}

#[test]
fn a_flat_punch_lets_go_as_kendall_says() {
    let [coarse, fine] = [9, 18].map(kendall);
    assert!(coarse.abs() < 0.04 && fine.abs() < 0.03, "{coarse} {fine}");
}

/// The same sphere as a pair of bodies, under loads that pull.
#[test]
fn a_pair_is_pulled_until_adhesion_does_not_hold() {
    let grid = Grid::new([48, 48], [0.1, 0.1]).unwrap();
    let flat = Topography::new(grid, grid.zeros()).unwrap();
    let tip = Topography::new(grid, sphere(&grid)).unwrap();
    // Two bodies of 2 E* have the composite modulus E*.
    let body = Material::elastic(1.5, 0.0).unwrap();
    let pair = Pair::new(flat, tip, [&body, &body]).unwrap().with_interface(Arc::new(exponential(1.5)));
    assert!((pair.modulus() - MODULUS).abs() < 1e-12);
    let load = |loads: &[f64]| {
        let stage = |load: &f64| Stage::new(Loading::pressing(Control::Load(*load)), 1);
        let stages: Vec<Stage> = loads.iter().map(stage).collect();
        load_in_stages(&pair, Boundary::FREE, None, &stages, &Params::new(), None, &(), &mut [])
    };
    let contact = load(&[0.5, 0.0, -1.0, -1.5, -1.6]).unwrap();
    for (increment, approach) in contact.increments[1..].iter().zip([1.126, 0.441, -0.114, -0.345]) {
        assert!((increment.approach - approach).abs() < 0.03, "{} {approach}", increment.approach);
        assert_eq!(increment.interface.unwrap().jumps, 0);
        assert!(increment.contact_area > 0.0 && increment.interface.unwrap().adhesive_load > 0.0);
    }
    let Err(Error::AtIncrement { increment: 6, source }) = load(&[0.5, 0.0, -1.0, -1.5, -1.6, -1.7]) else {
        panic!("it holds")
    };
    let Error::PullOff { load, least } = *source else { panic!("{source}") };
    assert!(load == -1.7 && (least + 1.6234).abs() < 8e-3, "{least}");
}

#[test]
fn the_weakest_attraction_gives_the_contact_without_adhesion() {
    let grid = Grid::new([64, 64], [1.0, 1.0]).unwrap();
    let amplitude = Amplitude::Sdq(0.1);
    let rough = SelfAffine { hurst: 0.8, rolloff: Some(16.0), shortest: Some(8.0), amplitude };
    let gap = -rough.generate(&grid, 5).unwrap().into_heights();
    for control in [Control::Load(0.01 * grid.area()), Control::Approach(-0.5 * gap.std(0.0))] {
        let mut operator = PeriodicFft::new(grid, 1.0);
        let params = Params::new();
        let plain = solve_normal(&mut operator, &gap, &Bounds::ELASTIC, control, None, &params).unwrap();
        let adhesion = Adhesion::new(1e-14, 0.5).unwrap();
        let weak = solve_adhesive(&mut operator, &gap, &adhesion, &ELASTIC, control, None, &params).unwrap();
        assert!((weak.approach - plain.approach).abs() < 1e-6 * plain.displacement.std(0.0));
        assert_eq!(weak.contact_cells(), plain.contact_cells());
        let largest = plain.max_pressure();
        let error = weak.pressure.iter().zip(&plain.pressure).map(|(one, other)| (one - other).abs());
        assert!(error.fold(0.0, f64::max) < 1e-5 * largest);
    }
}

/// States of a rough surface at three approaches up and two down by a program in Python: work of adhesion,
/// first of three approaches, mean pressures, shares of the area in contact, and its convolutions for all
/// five states.
struct Rough {
    work: f64,
    mean_pressures: [f64; 5],
    areas: [f64; 5],
    convolutions: f64,
}

/// Gaps of 64² and 128² cells, seed 0 of numpy's random numbers: E* = 1, pitch 1, rms slope 0.1, shortest
/// wave 16 cells, range 0.5.
const GAP_64: &[u8] = include_bytes!("../data/adhesive_gap_64.bin");
const GAP_128: &[u8] = include_bytes!("../data/adhesive_gap_128.bin");

const ROUGH_64: [Rough; 4] = [
    Rough {
        work: 0.002,
        mean_pressures: [-0.000_629_722, 0.001_332_972, 0.007_814_315, 0.001_332_972, -0.000_629_722],
        areas: [0.022_705, 0.087_402, 0.245_117, 0.087_402, 0.022_705],
        convolutions: 129.0,
    },
    Rough {
        work: 0.01,
        mean_pressures: [-0.005_497_886, -0.005_289_285, -0.000_859_975, -0.005_289_285, -0.005_497_886],
        areas: [0.049_561, 0.113_037, 0.276_855, 0.113_037, 0.049_561],
        convolutions: 143.0,
    },
    Rough {
        work: 0.03,
        mean_pressures: [-0.017_519_956, -0.021_642_393, -0.021_679_870, -0.021_642_393, -0.017_519_956],
        areas: [0.107_178, 0.189_941, 0.377_441, 0.189_941, 0.107_178],
        convolutions: 212.0,
    },
    Rough {
        work: 0.06,
        mean_pressures: [-0.035_498_220, -0.042_849_560, -0.051_667_170, -0.042_849_560, -0.035_498_220],
        areas: [0.278_809, 0.365_234, 0.534_180, 0.365_234, 0.278_809],
        convolutions: 2109.0,
    },
];

const ROUGH_128: [Rough; 4] = [
    Rough {
        work: 0.002,
        mean_pressures: [-0.000_026_760, 0.001_648_600, 0.008_158_217, 0.001_648_600, -0.000_026_760],
        areas: [0.023_254, 0.074_036, 0.226_868, 0.074_036, 0.023_254],
        convolutions: 156.0,
    },
    Rough {
        work: 0.01,
        mean_pressures: [-0.003_566_680, -0.003_546_305, 0.000_929_575, -0.003_546_305, -0.003_566_680],
        areas: [0.034_973, 0.099_548, 0.273_376, 0.099_548, 0.034_973],
        convolutions: 189.0,
    },
    Rough {
        work: 0.03,
        mean_pressures: [-0.012_472_156, -0.016_660_514, -0.015_768_457, -0.016_660_514, -0.012_472_156],
        areas: [0.098_206, 0.202_332, 0.399_841, 0.202_332, 0.098_206],
        convolutions: 906.0,
    },
    Rough {
        work: 0.06,
        mean_pressures: [-0.024_892, -0.032_677, -0.038_426, -0.035_244, -0.030_345],
        areas: [0.322_3, 0.435_4, 0.587_3, 0.406_0, 0.308_1],
        convolutions: 5945.0,
    },
];

/// Goes to the three approaches and back, and compares each state.
#[expect(clippy::print_stdout, reason = "benches/NOTES.md has these numbers")]
fn rough_states(cells: usize, gap: &[u8], approach: f64, known: &Rough) {
    let mut heights =
        gap.chunks_exact(4).map(|bytes| f64::from(f32::from_le_bytes(bytes.try_into().unwrap())));
    let gap = Field::from_shape_simple_fn([cells, cells], || heights.next().unwrap());
    let grid = Grid::new([cells, cells], [1.0, 1.0]).unwrap();
    let adhesion = Adhesion::new(known.work, 0.5).unwrap();
    let mut contact = Contact { operator: Box::new(PeriodicFft::new(grid, 1.0)), gap, adhesion, last: None };
    let mut convolutions = Vec::new();
    for (n, share) in [0.5, 0.75, 1.0, 0.75, 0.5].into_iter().enumerate() {
        let solution = contact.to(Control::Approach(share * approach)).unwrap();
        let mean_pressure = solution.load() / grid.area();
        let area = solution.contact_cells() as f64 / grid.cells() as f64;
        let scale = known.mean_pressures.iter().fold(0.0, |most: f64, p| most.max(p.abs()));
        let (p, a) = (known.mean_pressures[n], known.areas[n]);
        assert!((mean_pressure - p).abs() < 1e-4 * scale, "w {} state {n}: {mean_pressure} {p}", known.work);
        assert!(
            (area - a).abs() < 4.0 / grid.cells() as f64 + 1e-4,
            "w {} state {n}: {area} {a}",
            known.work
        );
        convolutions.push(solution.stats.convolutions);
    }
    let sum: f64 = convolutions.iter().sum();
    println!("{cells}² w {}: {convolutions:.0?}, {sum:.0} in all, {} there", known.work, known.convolutions);
    assert!(sum < 2.0 * known.convolutions + 300.0, "w {}: {convolutions:?}", known.work);
}

#[test]
fn rough_surfaces_reach_the_states_of_another_program() {
    ROUGH_64.iter().for_each(|known| rough_states(64, GAP_64, 0.832_526_816_268_405_5, known));
    ROUGH_128[..3].iter().for_each(|known| rough_states(128, GAP_128, 1.147_379_326_936_473_4, known));
}

/// Between the two ends of its hysteresis, the surface has passed many instabilities.
#[test]
#[ignore = "half a minute"]
fn a_sticky_rough_surface_keeps_what_it_has_gripped() {
    rough_states(128, GAP_128, 1.147_379_326_936_473_4, &ROUGH_128[3]);
}
