//! Contacts that slide in place: implicit updates, and the compliance used to solve them.

use std::sync::Arc;

use asperity_base::grid::CellValues;
use asperity_base::{Error, Field, Grid, Result};
use asperity_contact::adhesion::Adhesion;
use asperity_contact::film::{FILM, Film, FilmLaw, Films};
use asperity_contact::material::Material;
use asperity_contact::motion::{
    Changes, ContactCells, Law, Output, Pair, Slide, SlidingContact, SlidingOutcome, SlidingState,
    SlipRegime, Stage, StageTime, State, Step, load_in_stages, press,
};
use asperity_contact::operator::{
    Boundary, Compliant, CoupledSum, DirectSum, FreeFft, Operator, PeriodicFft,
};
use asperity_contact::solver::{
    Bounds, Control, Coupling, Friction, Loading, Method, Params, Solution, Tangential, solve_frictional,
    solve_normal,
};
use asperity_contact::temperature::Thermal;
use asperity_contact::viscoelastic::{Relaxation, RelaxationTerm};
use asperity_contact::wear::{WEAR, Wear, WearCoefficient};
use asperity_surface::{Amplitude, Form, SelfAffine, Topography};

use crate::support::{archard, difference, largest, rough_gap, self_affine, steel, zddp};

const PITCH: f64 = 1e-6;
const METHODS: [Method; 3] = [Method::Direct, Method::PolonskyKeer, Method::ActiveSet];

/// Random numbers from 0 to 1.
struct Draw(u64);

impl Draw {
    fn next(&mut self) -> f64 {
        // The generator of Knuth's MMIX.
        self.0 = self.0.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 11) as f64 / (1_u64 << 53) as f64
    }

    fn between(&mut self, from: f64, to: f64) -> f64 {
        from + (to - from) * self.next()
    }

    fn field(&mut self, shape: [usize; 2], from: f64, to: f64) -> Field {
        Field::from_shape_simple_fn(shape, || self.between(from, to))
    }
}

fn on(grid: Grid, boundary: Boundary) -> Box<dyn Operator> {
    if boundary == Boundary::PERIODIC {
        Box::new(PeriodicFft::new(grid, 1.0))
    } else {
        Box::new(FreeFft::new(grid, 1.0))
    }
}

#[test]
fn a_compliance_adds_to_the_displacement_by_any_operator() {
    let grid = Grid::new([9, 12], [1.0, 1.3]).unwrap();
    let mut draw = Draw(1);
    let (pressure, cells) = (draw.field(grid.shape, -1.0, 1.0), draw.field(grid.shape, 0.0, 3.0));
    for compliance in [CellValues::Uniform(0.7), CellValues::Field(cells)] {
        let applied = |operator: Box<dyn Operator>| {
            let mut operator = Compliant::new(operator, compliance.clone()).unwrap();
            let (mut double, mut single) = (grid.zeros(), grid.zeros().mapv(|_| 0.0f32));
            operator.apply(&pressure, &mut double);
            operator.apply_single(&pressure.mapv(|p| p as f32), &mut single);
            assert!(difference(&single.mapv(f64::from), &double) < 1e-6);
            let own = operator.self_influence();
            let mut unit = grid.zeros();
            for cell in [[0, 0], [4, 7], [8, 11]] {
                unit.fill(0.0);
                unit[cell] = 1.0;
                let mut displacement = grid.zeros();
                operator.apply(&unit, &mut displacement);
                assert!((displacement[cell] / own.value(cell[0] * 12 + cell[1]) - 1.0).abs() < 1e-12);
            }
            assert!((own.sum(108) / 108.0 / operator.influence(0, 0) - 1.0).abs() < 1e-12);
            double
        };
        let mut plain = grid.zeros();
        DirectSum::new(grid, 1.0).apply(&pressure, &mut plain);
        for (cell, u) in plain.iter_mut().enumerate() {
            *u += compliance.value(cell) * pressure.as_slice().unwrap()[cell];
        }
        assert!(difference(&applied(Box::new(DirectSum::new(grid, 1.0))), &plain) < 1e-13);
        assert!(difference(&applied(Box::new(FreeFft::new(grid, 1.0))), &plain) < 1e-12);
    }
    let refused = Compliant::new(Box::new(FreeFft::new(grid, 1.0)) as Box<dyn Operator>, -1.0);
    assert!(matches!(refused.err(), Some(Error::OutOfRange { .. })));
}

#[test]
fn no_compliance_is_the_contact_without_it_to_the_last_bit() {
    for boundary in [Boundary::FREE, Boundary::PERIODIC] {
        for method in METHODS {
            let shape = if method == Method::Direct { [20, 22] } else { [66, 70] };
            let grid = Grid::new(shape, [1.0; 2]).unwrap();
            let gap = rough_gap(&grid, 3);
            let params = Params::new().with_method(method).with_tolerance(1e-5);
            let load = Control::Load(0.013 * grid.area());
            let solve = |operator: &mut dyn Operator| {
                solve_normal(operator, &gap, &Bounds::up_to(0.3), load, None, &params).unwrap()
            };
            let plain = solve(on(grid, boundary).as_mut());
            let with = solve(&mut Compliant::new(on(grid, boundary), 0.0).unwrap());
            assert_eq!(with.pressure, plain.pressure, "{method:?}");
            assert_eq!(with.displacement, plain.displacement);
            assert_eq!((with.approach, with.stats), (plain.approach, plain.stats));
        }
    }
}

/// The pressure at an approach, by Gauss–Seidel iteration with the dense matrix, projected onto the bounds.
fn by_projection(
    operator: &dyn Operator,
    compliance: &CellValues,
    gap: &Field,
    upper: f64,
    approach: f64,
) -> Field {
    let (nx, ny) = gap.dim();
    let n = nx * ny;
    let influence = |a: usize, b: usize| {
        let own = if a == b { compliance.value(a) } else { 0.0 };
        operator.influence((a / ny).abs_diff(b / ny), (a % ny).abs_diff(b % ny)) + own
    };
    let matrix = Field::from_shape_fn([n, n], |(a, b)| influence(a, b));
    let gap = gap.as_slice().unwrap();
    let mut p = vec![0.0; n];
    for _ in 0..200_000 {
        let mut most: f64 = 0.0;
        for cell in 0..n {
            let u: f64 = matrix.row(cell).iter().zip(&p).map(|(c, p)| c * p).sum();
            let next = (p[cell] + (approach - gap[cell] - u) / matrix[[cell, cell]]).clamp(0.0, upper);
            most = most.max((next - p[cell]).abs());
            p[cell] = next;
        }
        if most < 1e-13 * p.iter().fold(1e-300, |most, p| f64::max(most, *p)) {
            break;
        }
    }
    Field::from_shape_vec([nx, ny], p).unwrap()
}

#[test]
fn all_methods_find_the_pressure_on_compliant_cells() {
    let mut draw = Draw(7);
    for case in 0..60 {
        let shape = [0, 1].map(|_| 3 + (14.0 * draw.next()) as usize);
        let grid = Grid::new(shape, [1.0, draw.between(0.7, 1.4)]).unwrap();
        let boundary = if draw.next() < 0.5 { Boundary::FREE } else { Boundary::PERIODIC };
        let gap = rough_gap(&grid, case);
        let size = 10.0f64.powf(draw.between(-2.0, 2.0));
        let compliance = match case % 3 {
            0 => CellValues::Uniform(size),
            1 => draw.field(shape, 0.0, size).into(),
            // Some cells are a thousand times more compliant than others.
            _ => draw.field(shape, -3.0, 0.0).mapv(|power| size * 10.0f64.powf(power)).into(),
        };
        let hardness = if draw.next() < 0.5 { f64::INFINITY } else { draw.between(0.05, 0.3) };
        let load = grid.area() * if hardness.is_finite() { hardness * draw.between(0.05, 0.9) } else { 0.05 };
        let solve = |method, control| {
            let params = Params::new().with_method(method).with_tolerance(1e-9).with_max_convolutions(50_000);
            let mut operator = Compliant::new(on(grid, boundary), compliance.clone()).unwrap();
            solve_normal(&mut operator, &gap, &Bounds::up_to(hardness), control, None, &params)
                .unwrap_or_else(|error| panic!("case {case}, {method:?}, {control:?}: {error}"))
        };
        let exact = solve(Method::Direct, Control::Load(load));
        let projected =
            by_projection(on(grid, boundary).as_ref(), &compliance, &gap, hardness, exact.approach);
        assert!(
            difference(&exact.pressure, &projected) < 1e-7,
            "case {case}: {}",
            difference(&exact.pressure, &projected)
        );
        for control in [Control::Load(load), Control::Approach(exact.approach)] {
            for method in METHODS {
                let found: Solution = solve(method, control);
                let error = difference(&found.pressure, &exact.pressure);
                assert!(error < 2e-5, "case {case}, {boundary:?}, {method:?}, {control:?}: {error:e}");
            }
        }
    }
}

#[test]
fn compliant_cells_cost_no_more_than_stiff_ones() {
    let grid = Grid::new([128, 128], [1.0; 2]).unwrap();
    let gap = rough_gap(&grid, 5);
    let params = Params::new().with_method(Method::ActiveSet);
    let mut draw = Draw(3);
    let cost = |compliance: CellValues| {
        let mut operator = Compliant::new(on(grid, Boundary::FREE), compliance).unwrap();
        let control = Control::Load(0.02 * grid.area());
        let solved = solve_normal(&mut operator, &gap, &Bounds::ELASTIC, control, None, &params).unwrap();
        solved.stats.convolutions
    };
    let stiff = cost(0.0.into());
    for size in [0.1, 1.0, 10.0, 100.0, 1000.0] {
        let field = draw.field(grid.shape, 0.1 * size, size);
        let [even, uneven] = [cost(size.into()), cost(field.into())];
        assert!(even < 1.3 * stiff && uneven < 1.6 * stiff, "κ = {size}: {even}, {uneven} against {stiff}");
    }
}

fn sliding(pair: Pair, boundary: Boundary, slide: Slide, params: Params, changes: Changes) -> SlidingContact {
    SlidingContact::new(pair, boundary, slide, params).unwrap().with_changes(changes).unwrap()
}

fn rough(hardness: f64, shape: [usize; 2], seed: u64) -> Pair {
    rough_bodies(shape, seed, [&steel(hardness); 2])
}

fn rough_bodies(shape: [usize; 2], seed: u64, materials: [&Material; 2]) -> Pair {
    let grid = Grid::new(shape, [PITCH; 2]).unwrap();
    let [lower, upper] = [seed, seed + 1].map(|seed| self_affine(&grid, Amplitude::Sq(50e-9), None, seed));
    Pair::new(lower, upper.underside(), materials).unwrap()
}

/// A constant film that reduces the wear to a tenth at its largest thickness.
fn frozen() -> Film {
    Film::new(FilmLaw::MechanoChemical { x: 1e-40, c3: 0.0, c4: 0.0 }, 100e-9, None).unwrap()
}

const EXACT: Params = Params::new().with_tolerance(1e-11);

#[test]
fn an_update_wears_by_the_pressure_that_it_leaves() {
    let mut draw = Draw(11);
    for case in 0..40 {
        let shape = [0, 1].map(|_| 4 + (12.0 * draw.next()) as usize);
        let boundary = if draw.next() < 0.5 { Boundary::FREE } else { Boundary::PERIODIC };
        let mut pair = rough(f64::INFINITY, shape, 100 + 2 * case);
        let films = [draw.field(shape, 0.0, 120e-9), draw.field(shape, 0.0, 120e-9)];
        pair.lower.state.insert(FILM.to_owned(), State { unit: "m".to_owned(), values: films[0].clone() });
        pair.upper.state.insert(FILM.to_owned(), State { unit: "m".to_owned(), values: films[1].clone() });
        let (area, before) = (pair.cell_area(), pair.clone());
        let load = 0.3e9 * area * (shape[0] * shape[1]) as f64;
        // From much less to much more than the compliance of a cell.
        let k = 10.0f64.powf(draw.between(-2.0, 2.0)) * PITCH / pair.modulus() / 0.2;
        let ks = [k, 0.3 * k];
        let slide = Slide::to(vec![0.2], Control::Load(load)).with_speed(0.1);
        let coefficient = |k: f64| Some(WearCoefficient::archard(k).unwrap().with_film(0.1 * k).unwrap());
        let wear = Wear::new(ks.map(coefficient), [Some(frozen()), Some(frozen())]).unwrap();
        let contact = sliding(pair, boundary, slide, EXACT, Changes::by(wear).with_bulk([300.0; 2]));
        let SlidingOutcome { state, solution, .. } = contact.run(None, &(), &mut []).unwrap();
        // On the bodies after the update the pressure is that of the update.
        assert!(difference(&state.pressure, &solution.pressure) < 1e-6, "case {case}");
        let after = press(
            &state.pair,
            boundary,
            Control::Load(load),
            SlipRegime::Frictionless,
            &EXACT.with_method(Method::Direct),
            &(),
        );
        assert!(
            difference(&state.pressure, &after.unwrap().solution.normal().pressure) < 1e-6,
            "case {case}"
        );
        let depths = [
            &before.lower.heights - &state.pair.lower.heights,
            &state.pair.upper.heights - &before.upper.heights,
        ];
        for (body, depth) in depths.iter().enumerate() {
            let expected = ndarray::Zip::from(&films[body])
                .and(&state.pressure)
                .map_collect(|film, p| ks[body] * (1.0 - 0.9 * (film / 100e-9).min(1.0)) * p * 0.2);
            assert!(difference(depth, &expected) < 1e-8, "case {case}, body {body}");
        }
        assert_eq!(state.updates[1].solutions, 1, "the coefficients are known beforehand");
    }
}

/// Between dissimilar bodies the shear displaces the surfaces normally. The pressures after the update are
/// those of sliding bodies with the worn surfaces, found by direct summation; they differ from those without
/// coupling.
#[test]
fn an_update_under_coupled_shear_wears_by_the_pressure_that_it_leaves() {
    let polymer = Material::elastic(3e9, 0.2).unwrap();
    let friction = Friction::coulomb(0.5).unwrap();
    let mut draw = Draw(12);
    for case in 0..6 {
        let shape = [0, 1].map(|_| 6 + (8.0 * draw.next()) as usize);
        let pair = rough_bodies(shape, 200 + 2 * case, [&polymer, &steel(f64::INFINITY)]);
        let load = 0.01e9 * pair.cell_area() * (shape[0] * shape[1]) as f64;
        let k = 10.0f64.powf(draw.between(-2.0, 1.0)) * PITCH / pair.modulus() / 0.2;
        let worn = |friction: Friction| {
            let slide = Slide::to(vec![0.2], Control::Load(load)).with_friction(friction);
            let changes = Changes::by(archard([k, 0.0]));
            let contact = sliding(pair.clone(), Boundary::FREE, slide, EXACT, changes);
            contact.run(None, &(), &mut []).unwrap().state
        };
        let state = worn(friction);
        let mut operator = CoupledSum::new(pair.lower_grid(), pair.response().clone());
        let loading = Loading { normal: Control::Load(load), tangential: Tangential::Sliding([1.0, 0.0]) };
        let gap = state.pair.initial_gap(&state.pair.at_rest());
        let params = EXACT.with_method(Method::Direct);
        let bounds = Bounds::ELASTIC;
        let after =
            solve_frictional(&mut operator, &gap, &bounds, &friction, loading, None, &params).unwrap();
        assert!(difference(&state.pressure, &after.normal.pressure) < 1e-6, "case {case}");
        let depth = &pair.lower.heights - &state.pair.lower.heights;
        assert!(difference(&depth, &state.pressure.mapv(|p| 0.2 * k * p)) < 1e-8, "case {case}");
        let alone = worn(friction.with_coupling(Coupling::None));
        assert!(difference(&state.pressure, &alone.pressure) > 1e-2, "case {case}");
    }
}

fn coulomb() -> Friction {
    Friction::coulomb(0.1).unwrap().with_coupling(Coupling::None)
}

fn growing() -> Film {
    Film::new(zddp(20e-9, 1e-10), 60e-9, Some(1.2e9)).unwrap()
}

/// A contact with yielding, wear proportional to the frictional energy, film growth and heating.
fn everything(pair: Pair, updates: usize) -> SlidingContact {
    let thermal = Thermal::new(46.0, 460.0, 7850.0).unwrap();
    let slide = Slide::graded(2.0, updates, Control::Load(0.08)).with_friction(coulomb()).with_speed(0.5);
    let films = [Some(growing()), Some(growing())];
    let coefficient = |k: f64| Some(WearCoefficient::energy(k).unwrap().with_film(0.1 * k).unwrap());
    let law = Films::new(films, &pair).unwrap();
    let wear = Wear::new([4e-16, 2e-16].map(|k| coefficient(10.0 * k)), films).unwrap();
    let changes = Changes::by(wear).with_law(law).with_bulk([373.15; 2]).with_heat([thermal; 2], 1);
    sliding(pair, Boundary::FREE, slide, Params::default(), changes)
}

#[test]
fn the_ledger_balances_and_friction_works() {
    let before = rough(2e9, [24, 20], 1);
    let SlidingOutcome { state, temperature, solution, .. } =
        everything(before.clone(), 12).run(None, &(), &mut []).unwrap();
    let last = state.updates.last().unwrap();
    assert_eq!((state.updates.len(), last.update, last.distance, last.time), (13, 12, 2.0, 4.0));
    let depths = [
        &before.lower.heights - &state.pair.lower.heights,
        &state.pair.upper.heights - &before.upper.heights,
    ];
    for (body, depth) in depths.iter().enumerate() {
        let lost: f64 = ["plastic", "wear", "film"].iter().map(|law| last.lost(law)[body]).sum();
        let fell = depth.sum() * before.cell_area();
        assert!((fell / lost - 1.0).abs() < 1e-9, "{fell:e}, {lost:e}");
        assert!(
            last.lost("plastic")[body] > 0.0
                && last.lost("wear")[body] > 0.0
                && last.lost("film")[body] < 0.0
        );
        let worn = &[&state.pair.lower, &state.pair.upper][body].state[WEAR].values;
        assert!((worn.sum() * before.cell_area() / last.lost("wear")[body] - 1.0).abs() < 1e-9);
        assert_eq!(largest(worn), [last.laws.max_wear_lower, last.laws.max_wear_upper][body]);
    }
    assert!((last.friction_work / (0.1 * 0.08 * 2.0) - 1.0).abs() < 1e-9);
    assert!((last.friction_power / (0.1 * 0.08 * 0.5) - 1.0).abs() < 1e-9);
    assert!(last.max_temperature > 373.15 && last.laws.mean_film_lower > 1e-9);
    let temperature = temperature.unwrap();
    let warm = temperature.iter().filter(|t| t.is_finite()).count();
    assert_eq!(warm, solution.contact_cells());
    // Growing films reduce the wear within the update.
    assert!(state.updates.iter().any(|update| update.solutions > 1));
}

#[test]
fn at_an_approach_wear_takes_the_load_away() {
    let pair = rough(f64::INFINITY, [24, 20], 5);
    let pressed =
        press(&pair, Boundary::FREE, Control::Load(0.05), SlipRegime::Frictionless, &Params::default(), &())
            .unwrap();
    let slide = Slide::graded(50.0, 20, Control::Approach(pressed.record.approach));
    let changes = Changes::by(archard([1e-14, 0.0]));
    let contact = sliding(pair, Boundary::FREE, slide, Params::default(), changes);
    let updates = contact.run(None, &(), &mut []).unwrap().state.updates;
    assert!((updates[0].load / 0.05 - 1.0).abs() < 1e-6);
    assert!(updates.windows(2).all(|pair| pair[1].load < pair[0].load));
    assert!(updates[20].load < 0.1 * updates[0].load);
}

/// Wear of the lower body without data for implicit updates.
struct Blunt(f64);

impl Law for Blunt {
    fn name(&self) -> &str {
        "wear"
    }

    fn add(&self, _: &Pair, contact_cells: &ContactCells, [lower, _]: &mut [Vec<Field>; 2]) {
        contact_cells.add(0, &mut lower[0], |cell| {
            contact_cells.pressure[cell] * contact_cells.sliding_distance(cell)
        });
    }

    fn advance(&self, _: &mut Pair, [lower, upper]: &[Vec<Field>; 2], passes: f64) -> [Field; 2] {
        [&lower[0] * (self.0 * passes), upper[0].clone()]
    }
}

#[test]
fn a_law_without_a_coefficient_is_explicit_and_the_implicit_one_stays_smooth() {
    let k = 1e-14;
    let run = |implicit: bool, updates: usize| {
        let grid = Grid::new([9, 9], [PITCH; 2]).unwrap();
        let flat = || Form::Flat.on(&grid).unwrap();
        let pair = Pair::new(flat(), flat(), [&steel(f64::INFINITY); 2]).unwrap();
        let ends = (1..=updates).map(|update| 0.2 * update as f64 / updates as f64).collect();
        let slide = Slide::to(ends, Control::Load(0.016));
        let changes = if implicit { Changes::by(archard([k, 0.0])) } else { Changes::by(Blunt(k)) };
        let contact = sliding(pair, Boundary::FREE, slide, Params::default(), changes);
        contact.run(None, &(), &mut []).unwrap().state
    };
    let spread = |state: &SlidingState| {
        let p = &state.pressure;
        largest(&(p - p.mean().unwrap())) / p.mean().unwrap()
    };
    // The smallest eigenvalue of C is 0.58 Δx/E*. An explicit update must wear less than twice that, or
    // pressures oscillate.
    let bound = 2.0 * 0.58 * PITCH / 115.4e9 / k;
    let most = (0.2 / bound).floor() as usize;
    assert!(spread(&run(true, 10)) < 0.05, "{}", spread(&run(true, 10)));
    assert!(spread(&run(false, most / 2)) > 0.5);
    let [fine, implicit] = [run(false, 3 * most), run(true, 3 * most)];
    assert!(spread(&fine) < 0.05);
    let [fine, implicit] = [fine, implicit].map(|state| state.pair.lower.heights);
    assert!(difference(&fine, &implicit) < 1e-2);
}

#[test]
fn what_has_no_meaning_is_refused() {
    let pair = || rough(2e9, [8, 8], 1);
    let refused = |slide: Slide| {
        SlidingContact::new(pair(), Boundary::FREE, slide, Params::default()).err().unwrap().to_string()
    };
    let load = Control::Load(0.01);
    assert!(refused(Slide::to(vec![], load)).contains("updates"));
    assert!(refused(Slide::to(vec![0.1, 0.1], load)).contains("distance"));
    assert!(refused(Slide::graded(0.0, 3, load)).contains("distance"));
    assert!(refused(Slide::graded(1.0, 3, load).with_speed(0.0)).contains("speed"));
    assert!(refused(Slide::graded(1.0, 3, Control::Load(1.0))).contains("load"));
    let thermal = Thermal::new(46.0, 460.0, 7850.0).unwrap();
    let cold =
        SlidingContact::new(pair(), Boundary::FREE, Slide::graded(1.0, 3, load), Params::default()).unwrap();
    let changes = Changes::default().with_heat([thermal; 2], 1);
    assert!(matches!(cold.with_changes(changes), Err(Error::Unsupported(_))));
}

/// The pressure of flat periodic bodies is uniform: f = f₀ − k p s until the film is used up, and the body
/// wears by k(f).
#[test]
fn a_solid_lubricant_is_worn_off_and_the_body_after_it() {
    let (thickness, k_film, k_bare, k_under) = (40e-9, 2e-15, 5e-16, 1e-17);
    let pressure = 0.2e9;
    let grid = Grid::new([6, 5], [PITCH; 2]).unwrap();
    let flat = || Form::Flat.on(&grid).unwrap();
    let pair = || Pair::new(flat(), flat(), [&steel(f64::INFINITY); 2]).unwrap();
    let gone = thickness / (k_film * pressure);
    for (share, updates) in [(0.5, 1), (0.5, 4), (3.0, 1), (3.0, 7)] {
        let distance = share * gone;
        let film = Film::new(FilmLaw::SolidLubricant { wear: k_film }, thickness, None).unwrap();
        let coefficient = WearCoefficient::archard(k_bare).unwrap().with_film(k_under).unwrap();
        let wear = Wear::new([Some(coefficient), None], [Some(film), None]).unwrap();
        let films = Films::new([Some(film), None], &pair()).unwrap();
        let slide = Slide::graded(distance, updates, Control::Load(pressure * grid.area()));
        let changes = Changes::by(wear).with_law(films);
        let contact = sliding(pair(), Boundary::PERIODIC, slide, Params::default(), changes);
        let state = contact.run(None, &(), &mut []).unwrap().state;
        let left = thickness * (1.0 - share).max(0.0);
        // ∫ f ds over the distance, for a film that is used up after its share.
        let covered = thickness * gone * if share < 1.0 { share - 0.5 * share * share } else { 0.5 };
        let worn = pressure * (k_bare * distance - (k_bare - k_under) * covered / thickness);
        for (what, found, expected) in [
            ("film", state.pair.lower.state[FILM].values[[2, 3]], left),
            ("wear", state.pair.lower.state[WEAR].values[[2, 3]], worn),
            ("heights", -state.pair.lower.heights[[2, 3]], thickness - left + worn),
        ] {
            let error = (found - expected).abs() / thickness;
            assert!(error < 1e-9, "{what} after {share} by {updates}: {found:e}, expected {expected:e}");
        }
        assert_eq!(state.pair.upper.heights[[0, 0]], 0.0);
    }
}

/// Pressures at the ends of the updates.
#[derive(Default)]
struct Pressures(Vec<Field>);

impl Output for Pressures {
    fn step(&mut self, step: &Step<'_>) -> Result<()> {
        self.0.extend(step.contact.map(|contact| contact.pressure.clone()));
        Ok(())
    }
}

/// A rough body of a modulus of 1 slides over a flat one that attracts it and wears.
fn attracted(attraction: f64, load: f64, distance: f64, updates: usize) -> (SlidingOutcome, Vec<Field>) {
    let grid = Grid::new([22, 20], [1.0; 2]).unwrap();
    let form =
        SelfAffine { hurst: 0.8, rolloff: Some(10.0), shortest: Some(4.0), amplitude: Amplitude::Sdq(0.1) };
    let rough = form.generate(&grid, 5).unwrap();
    let flat = Topography::new(grid, grid.zeros()).unwrap();
    let body = Material::elastic(1.5, 0.3).unwrap();
    let pair = Pair::new(rough, flat.underside(), [&body, &body]).unwrap();
    let pair = match attraction {
        0.0 => pair,
        share => pair.with_interface(Arc::new(Adhesion::new(share * 0.004, 0.12).unwrap())),
    };
    let slide = Slide::graded(distance, updates, Control::Load(load));
    let params = Params::default().with_tolerance(1e-9);
    let contact = sliding(pair, Boundary::FREE, slide, params, Changes::by(archard([ATTRACTED_WEAR, 0.0])));
    let mut kept = Pressures::default();
    let outcome = contact.run(None, &(), &mut [&mut kept]).unwrap();
    (outcome, kept.0)
}

const ATTRACTED_WEAR: f64 = 1e-2;

/// Wear counts what presses at the end of an update, cell by cell, and nothing of what pulls.
#[test]
fn bodies_that_attract_each_other_wear_in_place_by_what_presses() {
    let (worn, pressures) = attracted(1.0, 0.4, 60.0, 8);
    let updates = &worn.state.updates;
    let mut before = 0.0;
    let mut expected = 0.0;
    for (update, pressure) in updates.iter().zip(&pressures).skip(1) {
        let pressed: f64 = pressure.iter().map(|p| p.max(0.0)).sum();
        let pulled: f64 = pressure.iter().map(|p| p.min(0.0)).sum();
        assert!(pulled < -0.05 * pressed && (pressed + pulled - 0.4).abs() < 1e-6, "{pressed} {pulled}");
        expected += ATTRACTED_WEAR * pressed * (update.distance - before);
        before = update.distance;
        assert!((update.lost("wear")[0] / expected - 1.0).abs() < 1e-9, "{update:?} {expected}");
        let depth = largest(&pressure.mapv(|p| p.max(0.0))) * ATTRACTED_WEAR;
        assert!(update.solutions <= 6 && depth > 0.0, "{update:?}");
        assert!(update.interface.is_some());
    }
    // The bodies at rest are in equilibrium where they have worn to.
    assert!(worn.solution.residual < 1e-8 && worn.record.interface.is_some());
}

#[test]
fn a_faint_attraction_wears_in_place_as_hard_walls_do() {
    let worn = |attraction: f64| attracted(attraction, 0.4, 20.0, 4).0.state.pair.lower.heights;
    let hard = worn(0.0);
    let [faint, fainter] = [1e-3, 1e-5].map(|attraction| largest(&(&hard - &worn(attraction))));
    assert!(faint > 0.0 && (80.0..120.0).contains(&(faint / fainter)), "{faint:e} {fainter:e}");
}

const RUBBER: f64 = 1e6;

/// A ball of rubber whose modulus falls from ten times that at rest, by one time of a second; on rigid glass,
/// which wears.
fn rubber_ball(speed: f64, updates: usize, wear: f64, relaxes: bool) -> (SlidingOutcome, Vec<Field>, Pair) {
    let grid = Grid::new([24, 24], [10e-6; 2]).unwrap();
    let ball = Form::Sphere { radius: 2e-3 }.on(&grid).unwrap();
    let flat = Topography::new(grid, grid.zeros()).unwrap();
    let [rubber, glass] = [RUBBER, f64::INFINITY].map(|young| Material::elastic(young, 0.5).unwrap());
    let mut pair = Pair::new(flat, ball.underside(), [&glass, &rubber]).unwrap();
    if relaxes {
        let terms = [RelaxationTerm { modulus: 9.0 * RUBBER, time: 0.1 }];
        let relaxation = Relaxation::new(RUBBER, terms).unwrap();
        pair = pair.with_relaxation([&glass, &rubber], [None, Some(relaxation)]).unwrap();
    }
    let slide = Slide::graded(10e-3, updates, Control::Load(2e-3)).with_speed(speed);
    let params = Params::default().with_tolerance(1e-9);
    let contact = sliding(pair.clone(), Boundary::FREE, slide, params, Changes::by(archard([wear, 0.0])));
    let mut kept = Pressures::default();
    let outcome = contact.run(None, &(), &mut [&mut kept]).unwrap();
    (outcome, kept.0, pair)
}

/// With next to no wear it creeps as under a load that stays.
#[test]
fn rubber_that_slides_in_place_creeps_as_under_a_load_that_stays() {
    let (slid, pressures, pair) = rubber_ball(10e-3, 6, 1e-22, true);
    let loading = Loading::pressing(Control::Load(2e-3));
    let stages = vec![Stage::new(loading, 1), Stage::new(loading, 6).within(StageTime::Growing(1.0))];
    let mut kept = Pressures::default();
    let params = Params::default().with_tolerance(1e-9);
    let loaded =
        load_in_stages(&pair, Boundary::FREE, None, &stages, &params, None, &(), &mut [&mut kept]).unwrap();
    assert_eq!((pressures.len(), kept.0.len(), loaded.increments.len()), (7, 7, 7));
    for ((update, increment), (slid, stays)) in
        slid.state.updates.iter().zip(&loaded.increments).zip(pressures.iter().zip(&kept.0))
    {
        assert!((update.approach / increment.approach - 1.0).abs() < 1e-6, "{update:?} {increment:?}");
        assert!(difference(slid, stays) < 1e-5);
    }
    let approaches: Vec<f64> = slid.state.updates.iter().map(|update| update.approach).collect();
    assert!(approaches.windows(2).all(|pair| pair[1] > pair[0]) && approaches[6] > 2.0 * approaches[0]);
}

/// The worn volume is that of Archard, and slow sliding is that of an elastic body with the relaxed modulus.
#[test]
fn rubber_wears_in_place_by_its_pressures_and_slowly_as_an_elastic_body() {
    const WEAR: f64 = 1e-9;
    let (fast, ..) = rubber_ball(10e-3, 8, WEAR, true);
    for update in &fast.state.updates[1..] {
        let expected = WEAR * 2e-3 * update.distance;
        assert!((update.lost("wear")[0] / expected - 1.0).abs() < 1e-9, "{update:?}");
    }
    let heights = |outcome: &SlidingOutcome| outcome.state.pair.lower.heights.clone();
    let elastic = heights(&rubber_ball(10e-3, 8, WEAR, false).0);
    let away = |speed: f64| difference(&heights(&rubber_ball(speed, 8, WEAR, true).0), &elastic);
    let [fast, slow] = [away(10e-3), away(1e-6)];
    assert!(slow < 0.02 && fast > 4.0 * slow, "{fast} {slow}");
}

#[test]
fn rubber_below_a_contact_that_moves_over_it_is_refused() {
    let grid = Grid::new([4, 4], [1e-6; 2]).unwrap();
    let flat = || Topography::new(grid, grid.zeros()).unwrap();
    let rubber = Material::elastic(RUBBER, 0.5).unwrap();
    let relaxation = Relaxation::new(RUBBER, [RelaxationTerm { modulus: RUBBER, time: 1.0 }]).unwrap();
    let refused = |bodies, slide: Slide| {
        let pair = Pair::new(flat(), flat(), [&rubber, &rubber]).unwrap();
        let pair = pair.with_relaxation([&rubber, &rubber], bodies).unwrap();
        match SlidingContact::new(pair, Boundary::FREE, slide, Params::default()).map(|_| ()) {
            Err(Error::Unsupported(words)) => words,
            other => panic!("{other:?}"),
        }
    };
    let slide = || Slide::graded(1e-3, 2, Control::Load(1e-3));
    assert!(
        refused([Some(relaxation.clone()), None], slide().with_speed(1.0)).contains("must be the upper one")
    );
    assert!(refused([None, Some(relaxation)], slide()).contains("need the speed"));
}
