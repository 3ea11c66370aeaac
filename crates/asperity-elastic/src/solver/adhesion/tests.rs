//! Adhesive contacts against closed forms, dense programs and the work done.

use std::f64::consts::FRAC_1_PI;

use ndarray::{Array1, Array2};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::*;
use crate::grid::Grid;
use crate::math::Cholesky;
use crate::operator::{Boundary, FreeFamily, FreeFft, PeriodicFft};
use crate::solver::Method;
use crate::units::Metre;

const ELASTIC: CellValues = CellValues::Uniform(f64::INFINITY);

/// A sphere of radius 1 over a grid of this width. With E* = 3/4 and w = 1/π, loads are in πwR and lengths in
/// the units of Maugis.
fn sphere(cells: usize, width: f64) -> (FreeFft, Field) {
    let pitch = width / cells as f64;
    let grid = Grid::new([cells, cells], [pitch, pitch]).unwrap();
    let at = |i: usize| (i as f64 - 0.5 * (cells as f64 - 1.0)) * pitch;
    let gap = Field::from_shape_fn(grid.shape, |(i, j)| 0.5 * (at(i).powi(2) + at(j).powi(2)));
    (FreeFft::new(grid, 0.75), gap)
}

/// The adhesion with Maugis' parameter λ.
fn adhesion(lambda: f64) -> Adhesion {
    Adhesion::new(FRAC_1_PI, FRAC_1_PI / (0.5 * lambda)).unwrap()
}

/// Solves at one approach or load after the other; `None` comes from afar.
fn path(
    operator: &mut dyn Operator,
    gap: &Field,
    adhesion: &Adhesion,
    controls: impl IntoIterator<Item = Control>,
) -> Vec<Solution> {
    let mut solutions: Vec<Solution> = Vec::new();
    for control in controls {
        let last = solutions.last();
        let next = solve_adhesive(operator, gap, adhesion, &ELASTIC, control, last, &Params::new());
        solutions.push(next.unwrap());
    }
    solutions
}

#[test]
fn a_sphere_held_by_its_position_lets_go_at_the_pull_off_force() {
    let (mut operator, gap) = sphere(48, 4.8);
    let approaches = (-3..=2).chain((-13..=1).rev()).map(|n| Control::Approach(0.1 * f64::from(n)));
    let solutions = path(&mut operator, &gap, &adhesion(1.5), approaches);
    let least = solutions.iter().map(Solution::load).fold(f64::INFINITY, f64::min);
    assert!((least + 1.622).abs() < 0.008, "{least}");
    let convolutions: f64 = solutions.iter().map(|s| s.stats.convolutions).sum::<f64>();
    assert!(convolutions < 80.0 * solutions.len() as f64, "{convolutions} for {}", solutions.len());
}

#[test]
fn a_load_pulls_until_adhesion_does_not_hold() {
    let (mut operator, gap) = sphere(48, 4.8);
    let loads = [0.5, 0.0, -1.0, -1.5, -1.6].map(Control::Load);
    let solutions = path(&mut operator, &gap, &adhesion(1.5), loads);
    let approaches = [1.126, 0.441, -0.114, -0.345];
    for (solution, approach) in solutions[1..].iter().zip(approaches) {
        assert!((solution.approach - approach).abs() < 0.03, "{} {approach}", solution.approach);
    }
    let last = solutions.last();
    let control = Control::Load(-1.7);
    let pulled = solve_adhesive(&mut operator, &gap, &adhesion(1.5), &ELASTIC, control, last, &Params::new());
    let Err(Error::PullOff { load, least }) = pulled else { panic!("{pulled:?}") };
    assert!(load == -1.7 && (least + 1.622).abs() < 0.008, "{least}");
}

/// Random rough contact with attraction.
struct Random {
    operator: Box<dyn Operator>,
    gap: Field,
    adhesion: Adhesion,
    upper: CellValues,
    /// The approach that is looked at, and one that closes most of the gap.
    approaches: [Metre; 2],
}

fn random_contact(random: &mut ChaCha8Rng, cells: [usize; 2]) -> Random {
    let shape = [random.random_range(cells[0]..=cells[1]), random.random_range(cells[0]..=cells[1])];
    let grid = Grid::new(shape, [1.0, random.random_range(0.7..1.4)]).unwrap();
    let boundary = random.random_range(0..3);
    let line = Boundary([crate::operator::Edge::Free, crate::operator::Edge::Periodic]);
    let operator: Box<dyn Operator> = match boundary {
        0 => Box::new(PeriodicFft::new(grid, 1.0)),
        1 => Box::new(FreeFft::new(grid, 1.0)),
        _ => Box::new(FreeFamily::new(&grid, 1.0, line).operator(shape)),
    };
    let mut gap = Field::zeros(shape);
    for wave in 1..=2 {
        let size = random.random_range(0.05..0.3) / f64::from(wave);
        let phases: [f64; 2] = [0.0; 2].map(|_| random.random_range(0.0..6.3));
        gap.indexed_iter_mut().for_each(|((i, j), h)| {
            let x = std::f64::consts::TAU * f64::from(wave) * i as f64 / shape[0] as f64 + phases[0];
            let y = std::f64::consts::TAU * f64::from(wave) * j as f64 / shape[1] as f64 + phases[1];
            *h += size * (x.cos() + y.cos() + (x + y).sin());
        });
    }
    gap.iter_mut().for_each(|h| *h += random.random_range(0.0..0.01));
    let mean = gap.mean().unwrap() - gap.iter().copied().fold(f64::INFINITY, f64::min);
    let mut range = random.random_range(0.04..0.3);
    // Length of the process zone in cells.
    let mut zone = random.random_range(0.2f64..2.0);
    let mut approach = mean * random.random_range(-0.5..0.5);
    // Smooth tips on a free boundary jump, and have two states.
    if boundary == 1 {
        let radius = random.random_range(5.0..20.0f64);
        let middle = shape.map(|n| 0.5 * n as f64 + random.random_range(-1.0..0.0));
        gap.indexed_iter_mut().for_each(|((i, j), h)| {
            let r2 = (i as f64 - middle[0]).powi(2) + (j as f64 - middle[1]).powi(2);
            *h = 0.5 * r2 / radius + random.random_range(0.0..0.05);
        });
        (range, zone) = (random.random_range(0.05..0.2), random.random_range(0.1..0.5));
        let work = range * range / (std::f64::consts::PI * zone);
        approach =
            random.random_range(-0.6..0.0) * 2.0 * (std::f64::consts::TAU * work * radius.sqrt()).sqrt();
    }
    let lowest = gap.iter().copied().fold(f64::INFINITY, f64::min);
    gap -= lowest;
    let mean = gap.mean().unwrap();
    let adhesion = Adhesion::new(range * range / (std::f64::consts::PI * zone), range).unwrap();
    let upper =
        if random.random_bool(0.2) { CellValues::Uniform(random.random_range(0.05..0.3)) } else { ELASTIC };
    Random { operator, gap, adhesion, upper, approaches: [approach, 0.95 * mean] }
}

/// Returns the largest difference between two fields.
fn largest_difference(one: &Field, other: &Field) -> f64 {
    one.iter().zip(other).fold(0.0, |most, (one, other)| f64::max(most, (one - other).abs()))
}

/// Solves by lagged bounds alone, each contact to 1e-9, until the bounds stop changing. This converges from
/// the first bounds to the right state, however slowly.
fn lagged(contact: &mut Random, method: Method, approach: Metre, closed: bool) -> Solution {
    let params = Params::new().with_method(method).with_tolerance(1e-9).with_max_convolutions(100_000);
    let Random { operator, gap, adhesion, upper, .. } = contact;
    let mut lower = Field::from_elem(gap.raw_dim(), if closed { -adhesion.max_tension() } else { 0.0 });
    let mut start: Option<Field> = None;
    for _ in 0..20_000 {
        let bounds = Bounds::up_to(upper.clone()).above(lower.clone());
        let control = Control::Approach(approach);
        let solution =
            crate::solver::solve_normal(operator.as_mut(), gap, &bounds, control, start.as_ref(), &params)
                .unwrap();
        let next = solution.gap().mapv(|g| -adhesion.tension(g));
        let change = largest_difference(&next, &lower);
        // Solutions by the active set have rounding errors of this size.
        if change < 1e-7 * adhesion.max_tension() {
            return solution;
        }
        lower = next;
        start = Some(solution.pressure);
    }
    panic!("the bounds do not settle");
}

/// Returns the largest eigenvalue of S D: S the compliance of the open cells while the cells in contact stay
/// closed, D the softening of the attraction. The state is stable below 1.
fn instability(contact: &Random, solution: &Solution) -> f64 {
    let gap = solution.gap();
    let cells: Vec<_> = gap.indexed_iter().map(|(cell, _)| cell).collect();
    let touches = |n: &usize| solution.bounds.touches(*n, solution.pressure.as_slice().unwrap()[*n]);
    let caps = |n: &usize| solution.bounds.caps(*n, solution.pressure.as_slice().unwrap()[*n]);
    let closed: Vec<usize> = (0..cells.len()).filter(|n| touches(n) && !caps(n)).collect();
    let open: Vec<usize> = (0..cells.len()).filter(|n| !touches(n)).collect();
    let influence = |m: usize, n: usize| {
        let ((a, b), (c, d)) = (cells[m], cells[n]);
        contact.operator.influence(a.abs_diff(c), b.abs_diff(d))
    };
    let block = |rows: &[usize], columns: &[usize]| {
        Array2::from_shape_fn([rows.len(), columns.len()], |(m, n)| influence(rows[m], columns[n]))
    };
    let (inner, across, outer) = (block(&closed, &closed), block(&closed, &open), block(&open, &open));
    let factor = (!closed.is_empty()).then(|| Cholesky::new(inner).unwrap());
    let gaps = gap.as_slice().unwrap();
    let softening = Array1::from_iter(open.iter().map(|n| contact.adhesion.softening(gaps[*n])));
    let mut x = Array1::<f64>::ones(open.len());
    let mut value = 0.0;
    for _ in 0..300 {
        let pull = &softening * &x;
        let mut moved = outer.dot(&pull);
        if let Some(factor) = &factor {
            let held = factor.solve(across.dot(&pull).as_slice().unwrap());
            moved -= &across.t().dot(&Array1::from_vec(held));
        }
        value = moved.dot(&moved).sqrt();
        if value == 0.0 {
            return 0.0;
        }
        x = moved / value;
    }
    value
}

/// Compares a number of random contacts with the reference, from afar and from closed contact, and checks
/// that all are stable. Returns how many have two states, and the convolutions.
fn compare(count: usize, seed: u64, cells: [usize; 2], method: Method) -> (usize, f64) {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let (mut two, mut convolutions) = (0, 0.0);
    for n in 0..count {
        let mut contact = random_contact(&mut random, cells);
        let [approach, close] = contact.approaches;
        let reference = [false, true].map(|closed| lagged(&mut contact, method, approach, closed));
        let Random { operator, gap, adhesion, upper, .. } = &mut contact;
        let mut solve = |approach: Metre, last: Option<&Solution>| {
            let control = Control::Approach(approach);
            solve_adhesive(operator.as_mut(), gap, adhesion, upper, control, last, &Params::new()).unwrap()
        };
        let apart = solve(approach, None);
        let pressed = solve(close, None);
        let closed = Solution { initial_gap: -(&pressed.displacement - pressed.approach), ..pressed };
        let back = solve(approach, Some(&closed));
        let scale = apart.displacement.std(0.0).max(1e-4 * adhesion.range);
        for (found, expected, from) in [(&apart, &reference[0], "afar"), (&back, &reference[1], "contact")] {
            let error = largest_difference(&found.gap(), &expected.gap());
            let eigenvalue = instability(&contact, found);
            assert!(
                error < 2e-3 * scale + 2e-5 / (1.0 - eigenvalue.min(0.9999)) * scale,
                "{n} from {from}: {error:e} of {scale:e}, {eigenvalue} {:?}",
                contact.gap.dim()
            );
            assert!(eigenvalue < 1.001, "{n} from {from}: {eigenvalue}");
            convolutions += found.stats.convolutions;
        }
        two +=
            usize::from((reference[0].load() - reference[1].load()).abs() > 1e-3 * reference[0].load().abs());
    }
    (two, convolutions / (2 * count) as f64)
}

#[test]
fn random_contacts_reach_the_states_of_a_dense_program_from_both_sides() {
    let (two, _) = compare(40, 3, [6, 14], Method::Direct);
    assert!(two >= 2, "{two} have two states");
}

/// Run by hand: `COUNT=500 cargo test --lib many_random_contacts -- --ignored`.
#[test]
#[ignore = "takes minutes"]
fn many_random_contacts_reach_the_states_of_lagged_bounds() {
    let count = std::env::var("COUNT").ok().and_then(|count| count.parse().ok()).unwrap_or(500);
    let (two, convolutions) = compare(count, 11, [16, 32], Method::ActiveSet);
    assert!(
        two > count / 30 && convolutions < 150.0,
        "{two} of {count}, {convolutions} convolutions a state"
    );
}
