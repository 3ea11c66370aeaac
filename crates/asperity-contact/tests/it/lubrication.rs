//! Films of an oil between bodies, checked cell by cell with direct sums.
//!
//! `CASES=300 cargo test -p asperity-contact --test it films_of_random` tries this number of contacts and of motions, starting
//! from `SEED`.

use asperity_contact::lubrication::{
    Film, FilmParams, FilmProblem, FilmSolution, FilmSpeeds, FreeVolume, Oil, OilStep, Shear, ViscosityLaw,
    solve_film,
};
use asperity_contact::operator::{Boundary, DirectSum, Edge, FreeFft, Operator, Operators};
use asperity_contact::solver::Control;
use asperity_contact::{Error, Field, Grid, Result};
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

const MODULUS: f64 = 115e9;

const OIL: Oil = Oil {
    viscosity: 0.04,
    pressure_viscosity: 20e-9,
    law: ViscosityLaw::Roelands,
    compressible: true,
    free_volume: None,
};

/// A ball of 10 mm radius with waves, on cells of 8 µm.
fn ball(shape: [usize; 2], waves: f64, phase: f64) -> (Grid, Field) {
    let grid = Grid::new(shape, [8e-6; 2]).unwrap();
    let gap = Field::from_shape_fn(shape, |(i, j)| {
        let [x, y] = [(0, i), (1, j)].map(|(axis, i)| grid.centre(axis, i) - 0.5 * grid.extent()[axis]);
        let wave = |x: f64| (6e4 * x + phase).cos();
        (x * x + y * y) / 20e-3 + waves * wave(x) * wave(y + 0.3 * x)
    });
    (grid, gap)
}

fn problem(gap: &Field, speed: f64, load: f64) -> FilmProblem<'_> {
    FilmProblem {
        gap,
        oil: OIL,
        speed,
        boundary_film: 2e-9,
        control: Control::Load(load),
        ends: [0.0; 2],
        step: None,
    }
}

fn solved(operator: &mut dyn Operator, problem: FilmProblem<'_>) -> Result<FilmSolution> {
    let speed = problem.speed;
    Ok(FilmSpeeds::new(operator, &problem, FilmParams::default())?.film_at(operator, speed)?.solution)
}

/// What the flow sees of a cell.
struct Cell {
    p: f64,
    h: f64,
    cavity: f64,
}

/// Recomputes what a film leaves unbalanced, cell by cell: the largest of the balances of the oil over
/// u · 100 nm · pitch, of the films over 100 nm, of the complementarities, and of the load.
fn residual(grid: &Grid, problem: &FilmProblem<'_>, solution: &FilmSolution, across: Edge) -> f64 {
    let [nx, ny] = grid.shape;
    let [dx, dy] = grid.pitch;
    let film = &solution.film;
    let total = &film.oil_pressure + &film.solid_pressure;
    let mut displacement = Field::zeros(grid.shape);
    if across == Edge::Free {
        DirectSum::new(*grid, MODULUS).apply(&total, &mut displacement);
    } else {
        Operators::new(*grid, MODULUS, Boundary([Edge::Free, across]))
            .on(grid.shape)
            .apply(&total, &mut displacement);
    }
    let at = |i: usize, j: usize| {
        let h = problem.gap[(i, j)] - film.approach + displacement[(i, j)];
        Cell { p: film.oil_pressure[(i, j)], h: h.max(problem.boundary_film), cavity: film.cavity[(i, j)] }
    };
    let viscosity = |p: f64| {
        let (a, p0): (f64, f64) = (problem.oil.viscosity.ln() + 9.67, 1.96e8);
        let z = problem.oil.pressure_viscosity * p0 / a;
        problem.oil.viscosity * (a * ((1.0 + p / p0).powf(z) - 1.0)).exp()
    };
    let density = |p: f64| (5.9e8 + 1.34 * p) / (5.9e8 + p);
    let m = |c: &Cell| density(c.p) * c.h.powi(3) / (12.0 * viscosity(c.p));
    let mean =
        |a: f64, b: f64| if (a / b - 1.0).abs() < 1e-6 { 0.5 * (a + b) } else { (a - b) / (a / b).ln() };
    let face = |one: f64, next: f64| (1.5 * one - 0.5 * next).clamp(0.5 * one, 2.0 * one);
    // Along x, face i lies before column i.
    let along = |i: usize, j: usize| {
        if i == 0 {
            let (c, next) = (at(0, j), at(1, j));
            return problem.speed * dy * face(c.h, next.h) - 2.0 * m(&c) * c.p * dy / dx;
        }
        let c = at(i - 1, j);
        let before = at(i.max(2) - 2, j);
        let carried = face(density(c.p) * c.h, density(before.p) * before.h) * (1.0 - c.cavity);
        let driven = if i == nx {
            2.0 * m(&c) * c.p
        } else {
            let next = at(i, j);
            mean(m(&c), m(&next)) * (c.p - next.p)
        };
        problem.speed * dy * carried + driven * dy / dx
    };
    let beside = |i: usize, j: usize| {
        let wraps = across == Edge::Periodic;
        if (j == 0 || j == ny) && !wraps {
            let (c, sign) = if j == 0 { (at(i, 0), -1.0) } else { (at(i, ny - 1), 1.0) };
            return sign * 2.0 * m(&c) * c.p * dx / dy;
        }
        let (c, next) = (at(i, (j + ny - 1) % ny), at(i, j % ny));
        mean(m(&c), m(&next)) * (c.p - next.p) * dx / dy
    };
    let unit = problem.speed * 1e-7 * dy;
    let mut worst = match problem.control {
        Control::Load(load) => (dx * dy * total.sum() / load - 1.0).abs(),
        Control::Approach(approach) => (film.approach / approach - 1.0).abs(),
    };
    for (i, j) in (0..nx).flat_map(|i| (0..ny).map(move |j| (i, j))) {
        let mut left = along(i, j) - along(i + 1, j) + beside(i, j) - beside(i, j + 1);
        if let Some(step) = problem.step {
            let c = at(i, j);
            let stored = density(c.p) * c.h * (1.0 - c.cavity);
            left -= dx * dy * (stored - step.before[i * ny + j]) / step.duration;
        }
        let h = problem.gap[(i, j)] - film.approach + displacement[(i, j)];
        let (p, c, cavity) = (film.oil_pressure[(i, j)], film.solid_pressure[(i, j)], film.cavity[(i, j)]);
        assert!(p >= 0.0 && c >= 0.0 && (0.0..=1.0).contains(&cavity) && p * cavity == 0.0);
        let apart =
            if c > 0.0 { (h - problem.boundary_film).abs() } else { (problem.boundary_film - h).max(0.0) };
        worst = worst.max((left / unit).abs()).max(apart / 1e-7);
    }
    worst
}

#[test]
fn films_of_random_contacts_leave_no_residual() {
    let cases = cases(12);
    let mut mixed = 0;
    for n in cases.clone() {
        let mut random = ChaCha8Rng::seed_from_u64(n);
        let shape = [random.random_range(16..28), random.random_range(14..24)];
        let across = if n % 3 == 2 { Edge::Periodic } else { Edge::Free };
        let (grid, gap) =
            ball(shape, 10_f64.powf(random.random_range(-8.0..-6.8)), random.random_range(0.0..6.0));
        let mut operator = Operators::new(grid, MODULUS, Boundary([Edge::Free, across])).on(shape);
        let speed = 10_f64.powf(random.random_range(-4.0..-0.5));
        let load = 10_f64.powf(random.random_range(-1.0..0.3));
        let problem = problem(&gap, speed, load);
        let solution = solved(&mut *operator, problem).unwrap();
        let left = residual(&grid, &problem, &solution, across);
        assert!(left < 2e-7, "{shape:?} at {speed:e} m/s under {load} N: {left:e}");
        let solids = solution.film.solid_pressure.sum()
            / (&solution.film.oil_pressure + &solution.film.solid_pressure).sum();
        mixed += u64::from((0.01..0.99).contains(&solids));
    }
    assert!(4 * mixed >= cases.end - cases.start, "{mixed} of {cases:?} mixed");
}

/// Numbers of random cases, and the seed of the first, for longer runs.
fn cases(default: u64) -> std::ops::Range<u64> {
    let number = |name: &str, default: u64| std::env::var(name).map_or(default, |text| text.parse().unwrap());
    let seed = number("SEED", 0);
    seed..seed + number("CASES", default)
}

/// Balls with random waves move over each other, at a load or an approach: each position is a step, or two of half its time.
#[test]
fn films_of_random_motions_leave_no_residual() {
    for n in cases(4) {
        let mut random = ChaCha8Rng::seed_from_u64(n);
        let shape = [random.random_range(14..24), random.random_range(12..20)];
        let across = if n % 3 == 2 { Edge::Periodic } else { Edge::Free };
        let waves = 10_f64.powf(random.random_range(-8.0..-7.0));
        let speed = 10_f64.powf(random.random_range(-3.0..-0.5));
        let load = 10_f64.powf(random.random_range(-1.0..0.3));
        let wander = random.random_range(0.2..1.5);
        let at = |phase: f64| ball(shape, waves, phase);
        let (grid, mut gap) = at(0.0);
        let mut operator = Operators::new(grid, MODULUS, Boundary([Edge::Free, across])).on(shape);
        let mut now = solved(&mut *operator, problem(&gap, speed, load)).unwrap();
        let control = if n % 2 == 0 { Control::Load(load) } else { Control::Approach(now.film.approach) };
        for step in 1..=5 {
            let after = at(wander * f64::from(step)).1;
            let middle = 0.5 * (&gap + &after);
            let duration = grid.pitch[0] / speed;
            let mut whole = true;
            for (gap, duration) in [(&after, duration), (&middle, 0.5 * duration), (&after, 0.5 * duration)] {
                let before = now.oil.clone();
                let step = Some(OilStep { before: &before, duration });
                let problem = FilmProblem { step, control, ..problem(gap, speed, load) };
                match solve_film(&mut *operator, &problem, &now.film, &FilmParams::default()) {
                    Ok(solution) => now = solution,
                    Err(Error::FilmNotConverged { .. }) if whole => {
                        whole = false;
                        continue;
                    }
                    Err(error) => panic!("{n}: {error}"),
                }
                let left = residual(&grid, &problem, &now, across);
                assert!(left < 1e-6, "case {n}, {shape:?} at {speed:e} m/s: {left:e}");
                if whole {
                    break;
                }
            }
            gap = after;
        }
    }
}

/// The rise of the viscosity and of the density is the derivative of the value, and α is that at ambient pressure.
#[test]
fn an_oil_rises_as_it_says() {
    let volume = Some(FreeVolume { bulk_modulus: 1.4e9, occupied_volume: 0.67 });
    let laws = [ViscosityLaw::Barus, ViscosityLaw::Roelands, ViscosityLaw::Doolittle].map(|law| Oil {
        law,
        free_volume: volume,
        ..OIL
    });
    for oil in laws {
        assert!((oil.under(1e-3).viscosity_rise / 20e-9 - 1.0).abs() < 1e-9, "{:?}", oil.law);
        for p in [1e7, 3e8, 1e9] {
            let [less, here, more] = [p * (1.0 - 1e-5), p, p * (1.0 + 1e-5)].map(|p| oil.under(p));
            let rise = (more.viscosity / less.viscosity).ln() / (2e-5 * p);
            assert!((here.viscosity_rise / rise - 1.0).abs() < 1e-6, "{:?}: {rise:e}", oil.law);
            let rise = (more.density - less.density) / (2e-5 * p);
            assert!((here.density_rise / rise - 1.0).abs() < 1e-5, "{:?}: {rise:e}", oil.law);
        }
    }
    // Tait with K₀′ = 11.
    let compressed = 1.0 - (1.0_f64 + 12.0 / 1.4).ln() / 12.0;
    assert!((laws[2].under(1e9).density * compressed - 1.0).abs() < 1e-12);
}

#[test]
fn a_ball_that_moves_keeps_all_oil_in_each_step() {
    let shape = [24, 20];
    let (grid, gap) = ball(shape, 40e-9, 0.0);
    let mut operator = FreeFft::new(grid, MODULUS);
    let load = 2.0;
    let mut now = solved(&mut operator, problem(&gap, 0.03, load)).unwrap();
    for n in 1..=6 {
        let (_, gap) = ball(shape, 40e-9, 0.4 * f64::from(n));
        let before = now.oil.clone();
        let step = Some(OilStep { before: &before, duration: 0.1 * grid.pitch[0] / 0.03 });
        let problem = FilmProblem { step, ..problem(&gap, 0.03, load) };
        let params = FilmParams { tolerance: 1e-9, ..FilmParams::default() };
        now = solve_film(&mut operator, &problem, &now.film, &params).unwrap();
        let left = residual(&grid, &problem, &now, Edge::Free);
        assert!(left < 1e-8, "step {n}: {left:e}");
    }
}

#[test]
fn the_answer_does_not_depend_on_the_start_or_on_the_order_of_speeds() {
    let (grid, gap) = ball([28, 24], 60e-9, 1.0);
    let mut operator = FreeFft::new(grid, MODULUS);
    let load = 3.0;
    let slow_first = {
        let mut speeds =
            FilmSpeeds::new(&mut operator, &problem(&gap, 1.0, load), FilmParams::default()).unwrap();
        [1e-3, 1e-2, 0.1].map(|speed| speeds.film_at(&mut operator, speed).unwrap().solution)
    };
    let mut speeds =
        FilmSpeeds::new(&mut operator, &problem(&gap, 1.0, load), FilmParams::default()).unwrap();
    let fast_first =
        [2.0, 0.1, 1e-2, 1e-3].map(|speed| speeds.film_at(&mut operator, speed).unwrap().solution);
    for (one, other) in slow_first.iter().zip(fast_first.iter().rev()) {
        let most = one.film.oil_pressure.iter().chain(&one.film.solid_pressure).copied().fold(0.0, f64::max);
        for (a, b) in [
            (&one.film.oil_pressure, &other.film.oil_pressure),
            (&one.film.solid_pressure, &other.film.solid_pressure),
        ] {
            let off = (a - b).iter().fold(0.0, |most: f64, off| most.max(off.abs()));
            assert!(off < 1e-4 * most, "{off:e} of {most:e}");
        }
    }
}

#[test]
fn a_film_comes_with_that_on_half_as_many_cells() {
    let (grid, gap) = ball([48, 40], 0.0, 0.0);
    let mut operator = FreeFft::new(grid, MODULUS);
    let films = FilmSpeeds::new(&mut operator, &problem(&gap, 1.0, 4.0), FilmParams::default());
    let film = films.unwrap().film_at(&mut operator, 1.0).unwrap();
    let (coarse, half) = film.half.unwrap();
    assert_eq!((coarse.shape, coarse.pitch), ([24, 20], [16e-6; 2]));
    let central = |solution: &FilmSolution| {
        let (nx, ny) = solution.thickness.dim();
        solution.thickness[(nx / 2, ny / 2)]
    };
    let off = central(&half) / central(&film.solution) - 1.0;
    assert!(off.abs() > 1e-4 && off.abs() < 0.1, "{off:e}");
}

#[test]
fn an_oil_that_is_ten_times_thinner_and_faster_gives_the_same_film() {
    let (grid, gap) = ball([20, 16], 30e-9, 0.5);
    let mut operator = FreeFft::new(grid, MODULUS);
    let params = FilmParams { tolerance: 1e-11, ..FilmParams::default() };
    let [one, other] = [(0.04, 0.05), (0.004, 0.5)].map(|(viscosity, speed)| {
        let oil = Oil { viscosity, law: ViscosityLaw::Barus, ..OIL };
        let problem = FilmProblem { oil, ..problem(&gap, speed, 1.0) };
        FilmSpeeds::new(&mut operator, &problem, params)
            .unwrap()
            .film_at(&mut operator, speed)
            .unwrap()
            .solution
    });
    let off = (&one.thickness - &other.thickness).iter().fold(0.0, |most: f64, off| most.max(off.abs()));
    assert!(off < 1e-9 * one.thickness.iter().copied().fold(0.0, f64::max), "{off:e}");
}

#[test]
fn a_film_without_a_meaning_is_refused() {
    let (grid, gap) = ball([8, 8], 0.0, 0.0);
    let mut operator = FreeFft::new(grid, MODULUS);
    let start =
        Film { oil_pressure: Field::from_elem([8, 8], 1e7), ..Film::dry(Field::zeros([8, 8]), -1e-7) };
    let good = problem(&gap, 0.1, 1.0);
    let before = vec![1e-7; 64];
    let wrong = [
        (FilmProblem { oil: Oil { viscosity: 0.0, ..OIL }, ..good }, "viscosity is 0"),
        (FilmProblem { oil: Oil { pressure_viscosity: 20.0, ..OIL }, ..good }, "pressure_viscosity is 20"),
        (
            FilmProblem { oil: Oil { viscosity: 2e-5, ..OIL }, ..good },
            "viscosity is 20 µPa s, expected above 100 µPa s",
        ),
        (FilmProblem { speed: -1.0, ..good }, "speed is -1"),
        (FilmProblem { control: Control::Load(0.0), ..good }, "load is 0"),
        (FilmProblem { ends: [0.0, f64::INFINITY], ..good }, "pressure at an end is inf"),
        (FilmProblem { boundary_film: 0.0, ..good }, "boundary_film is 0"),
        (FilmProblem { ends: [-1.0, 0.0], ..good }, "pressure at an end is -1"),
        (FilmProblem { step: Some(OilStep { before: &before, duration: 0.0 }), ..good }, "duration is 0"),
    ];
    for (problem, says) in wrong {
        let error = solve_film(&mut operator, &problem, &start, &FilmParams::default()).unwrap_err();
        assert!(error.to_string().starts_with(says), "{error}");
    }
    let mut speeds = FilmSpeeds::new(&mut operator, &good, FilmParams::default()).unwrap();
    for speed in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        let error = speeds.film_at(&mut operator, speed).unwrap_err();
        assert!(error.to_string().starts_with("speed is "), "{error}");
    }
    let mut periodic = Operators::new(grid, MODULUS, Boundary::PERIODIC).on([8, 8]);
    let error = solve_film(&mut *periodic, &good, &start, &FilmParams::default()).unwrap_err();
    assert!(matches!(error, Error::Unsupported(_)), "{error}");
    let nothing = Film::dry(Field::zeros([8, 8]), -1e-7);
    let error = solve_film(&mut operator, &good, &nothing, &FilmParams::default()).unwrap_err();
    assert!(matches!(error, Error::FilmNotConverged { residual, .. } if residual.is_nan()), "{error}");
    let few = FilmParams { max_iterations: 2, ..FilmParams::default() };
    let error = solve_film(&mut operator, &good, &start, &few).unwrap_err();
    assert!(matches!(error, Error::FilmNotConverged { iterations: 2, .. }), "{error}");
}

#[test]
fn shear_is_at_most_what_the_law_allows() {
    assert_eq!(Shear::Newtonian.stress(0.1, 1e6, 1e8), 1e5);
    assert_eq!(Shear::Limited(0.05).stress(10.0, 1e7, 1e8), 5e6);
    assert_eq!(Shear::Limited(0.05).stress(0.1, 1e6, 1e8), 1e5);
    let eyring = Shear::Eyring(5e6);
    assert!((eyring.stress(0.1, 1e4, 1e8) / 1e3 - 1.0).abs() < 1e-7);
    assert!((eyring.stress(100.0, 1e7, 1e8) / (5e6 * 200_f64.asinh()) - 1.0).abs() < 1e-12);
}

#[test]
fn films_of_few_cells_leave_no_residual() {
    for (shape, across) in [
        ([2, 1], Edge::Free),
        ([2, 5], Edge::Free),
        ([7, 1], Edge::Free),
        ([7, 2], Edge::Free),
        ([3, 3], Edge::Free),
        ([9, 1], Edge::Periodic),
        ([9, 2], Edge::Periodic),
        ([5, 3], Edge::Periodic),
    ] {
        let (grid, gap) = ball(shape, 20e-9, 0.3);
        let mut operator = Operators::new(grid, MODULUS, Boundary([Edge::Free, across])).on(shape);
        for speed in [1e-3, 0.1] {
            let problem = problem(&gap, speed, 0.02);
            let solution = solved(&mut *operator, problem).unwrap();
            let left = residual(&grid, &problem, &solution, across);
            assert!(left < 2e-7, "{shape:?}, {across:?} at {speed} m/s: {left:e}");
        }
    }
    let (grid, gap) = ball([1, 1], 0.0, 0.0);
    let solution = solved(&mut FreeFft::new(grid, MODULUS), problem(&gap, 0.1, 1e-3)).unwrap();
    assert!(solution.thickness[(0, 0)] >= 2e-9);
}
