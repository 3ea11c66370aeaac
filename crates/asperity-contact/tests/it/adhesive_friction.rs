//! Bodies that attract each other under friction: the law of friction by direct summation, and Derjaguin's
//! law.

use std::f64::consts::FRAC_1_PI;
use std::sync::Arc;

use asperity_base::{Error, Field, Grid};
use asperity_contact::adhesion::{Adhesion, Potential};
use asperity_contact::material::Material;
use asperity_contact::motion::{
    Acceleration, Changes, Cycles, LoadedContact, Pair, SlipRegime, Stage, StagedLoading, load_in_stages,
    press,
};
use asperity_contact::operator::{Boundary, CoupledOperator, CoupledSum};
use asperity_contact::reference::cattaneo::tangential_modulus;
use asperity_contact::reference::{CattaneoMindlin, HertzSphere};
use asperity_contact::solver::{
    Control, Coupling, Creep, Friction, FrictionalSolution, HardWall, Loading, Params, Rolling, Tangential,
};
use asperity_surface::{Amplitude, SelfAffine, Topography};

use crate::support::{archard, largest};

const COEFFICIENT: f64 = 0.4;
const PARAMS: Params = Params::new().with_tolerance(1e-9);

fn friction() -> Friction {
    Friction::coulomb(COEFFICIENT).unwrap()
}

/// Rough bodies of these materials that attract each other.
fn rough(materials: [&Material; 2]) -> Pair {
    let grid = Grid::new([20, 18], [1.0; 2]).unwrap();
    let amplitude = Amplitude::Sdq(0.1);
    let form = SelfAffine { hurst: 0.8, rolloff: Some(10.0), shortest: Some(4.0), amplitude };
    let [lower, upper] = [3, 4].map(|seed| form.generate(&grid, seed).unwrap());
    let adhesion = Adhesion::new(0.004, 0.12).unwrap();
    Pair::new(lower, upper.underside(), materials).unwrap().with_interface(Arc::new(adhesion))
}

fn body() -> Material {
    Material::elastic(1.5, 0.3).unwrap()
}

/// Tangential displacement under the shear of a solution by direct summation.
fn displacement(pair: &Pair, solution: &FrictionalSolution) -> [Field; 2] {
    let mut operator = CoupledSum::new(pair.lower_grid(), pair.response().clone());
    let mut displacement = [0, 1].map(|_| pair.lower_grid().zeros());
    let ([x, y], [u, v]) = (&solution.shear, displacement.each_mut());
    operator.apply([Some(x), Some(y), None], [Some(u), Some(v), None]);
    displacement
}

/// Checks the law of friction in each cell for this slip. Returns the numbers of cells that stick, that slip
/// and that are under tension.
fn check(solution: &FrictionalSolution, slip: &[Field; 2]) -> [usize; 3] {
    let size = slip.iter().chain(&solution.displacement).flatten().fold(0.0f64, |m, s| m.max(s.abs()));
    let near = 1e-5 * size;
    let mut counts = [0; 3];
    for (cell, &p) in solution.normal.pressure.indexed_iter() {
        let [q, s] = [&solution.shear, slip].map(|field| [field[0][cell], field[1][cell]]);
        let (shear, slipped) = (q[0].hypot(q[1]), s[0].hypot(s[1]));
        if p <= 0.0 {
            assert_eq!(q, [0.0; 2], "a cell under {p} bears no shear");
            counts[2] += usize::from(p < 0.0);
            continue;
        }
        let limit = COEFFICIENT * p;
        assert!(shear <= limit * (1.0 + 1e-9), "{shear} of {limit}");
        if shear < 0.999 * limit {
            assert!(slipped <= near, "{slipped:e} of {size:e} in a cell that sticks");
            counts[0] += 1;
        } else {
            let [along, across] = [q[0] * s[0] + q[1] * s[1], q[0] * s[1] - q[1] * s[0]].map(|w| w / shear);
            assert!(along >= -near && across.abs() <= near, "{along:e}, {across:e} of {size:e}");
            counts[1] += 1;
        }
    }
    counts
}

/// Loaded, pushed, pushed back and pulled.
#[test]
fn bodies_that_attract_each_other_stick_and_slip_by_their_pressure() {
    let pair = rough([&body(), &body()]);
    let unit = 2e-3 * pair.lower_grid().area();
    let stage = |(load, force): (f64, [f64; 2])| {
        let tangential = Tangential::Force(force.map(|part| part * unit));
        Stage::new(Loading { normal: Control::Load(load * unit), tangential }, 1)
    };
    let path =
        [(1.0, [0.0; 2]), (1.0, [0.5, 0.2]), (1.0, [-0.3, 0.1]), (0.4, [0.3, 0.0]), (-0.05, [0.0, 0.1])];
    let stages = path.map(stage);
    let loaded = |friction: Option<&Friction>, stages: &[Stage]| {
        load_in_stages(&pair, Boundary::FREE, friction, stages, &PARAMS, None, &(), &mut []).unwrap()
    };
    let mut before = [0, 1].map(|_| pair.lower_grid().zeros());
    let mut counts = [0; 3];
    for n in 1..=stages.len() {
        let LoadedContact { solution, record, .. } = loaded(Some(&friction()), &stages[..n]);
        let alone = loaded(None, &stages[..n]);
        assert_eq!(solution.normal().pressure, alone.solution.normal().pressure);
        assert_eq!(record.interface, alone.record.interface);
        let solution = solution.frictional().unwrap();
        let moved = displacement(&pair, solution);
        let rigid = solution.rigid_displacement;
        let whole = [0, 1].map(|axis| moved[axis].mapv(|u| rigid[axis] - u));
        let slip = [0, 1].map(|axis| &whole[axis] - &before[axis]);
        check(solution, &slip).into_iter().zip(&mut counts).for_each(|(more, count)| *count += more);
        let wanted = path[n - 1].1.map(|part| part * unit);
        solution.force().iter().zip(wanted).for_each(|(found, wanted)| {
            assert!((found - wanted).abs() < 1e-6 * unit, "{found} {wanted}");
        });
        before = whole;
    }
    assert!(counts.iter().all(|count| *count > 20), "{counts:?}");
}

/// In steady rolling the material that arrives at a cell comes from the cell ahead.
#[test]
fn bodies_that_attract_each_other_roll_by_their_pressure() {
    let pair = rough([&body(), &body()]);
    let load = Control::Load(1e-3 * pair.lower_grid().area());
    let creepage = [3e-3, -1e-3];
    let rolling = Rolling { creep: Creep::Creepage(creepage), spin: 0.0 };
    let pressed = |regime| press(&pair, Boundary::FREE, load, regime, &PARAMS, &()).unwrap();
    let rolled = pressed(SlipRegime::Rolling(friction(), rolling));
    let alone = pressed(SlipRegime::Frictionless);
    assert_eq!(rolled.solution.normal().pressure, alone.solution.normal().pressure);
    assert_eq!(rolled.record.interface, alone.record.interface);
    let solution = rolled.solution.frictional().unwrap();
    let moved = displacement(&pair, solution);
    let last = moved[0].nrows() - 1;
    let slip = [0, 1].map(|axis| {
        let u = &moved[axis];
        Field::from_shape_fn(u.raw_dim(), |(i, j)| creepage[axis] - u[[i, j]] + u[[(i + 1).min(last), j]])
    });
    let counts = check(solution, &slip);
    assert!(counts.iter().all(|count| *count > 5), "{counts:?}");
}

/// Errors of the friction force of a sphere against Derjaguin's law, Q = μ(W + 2πwR), and of the tangential
/// displacement under half of it against Cattaneo and Mindlin for that normal force.
fn derjaguin_errors(lambda: f64, cells: usize) -> [f64; 2] {
    // The units of Maugis: loads in πwR, and a sphere of radius 1.
    let (modulus, work, load) = (0.75, FRAC_1_PI, 2.0);
    let range = work / (0.5 * lambda);
    let pitch = 2.3 * (2.0 * range + 4.0).sqrt() / cells as f64;
    let grid = Grid::new([cells; 2], [pitch; 2]).unwrap();
    let from = |index| grid.centre(0, index) - 0.5 * grid.extent()[0];
    let tip = Field::from_shape_fn(grid.shape, |(i, j)| 0.5 * (from(i).powi(2) + from(j).powi(2)));
    let [flat, tip] = [grid.zeros(), tip].map(|heights| Topography::new(grid, heights).unwrap());
    let body = Material::elastic(2.0 * modulus, 0.0).unwrap();
    let adhesion = Adhesion::new(work, range).unwrap().with_potential(Potential::Dugdale);
    let pair = Pair::new(flat, tip, [&body, &body]).unwrap().with_interface(Arc::new(adhesion));
    let pressing = load + 2.0;
    let force = 0.5 * COEFFICIENT * pressing;
    let stages = [Tangential::Force([force, 0.0]), Tangential::Sliding([1.0, 0.0])]
        .map(|tangential| Stage::new(Loading { normal: Control::Load(load), tangential }, 1));
    let to = |stages: &[Stage]| {
        let params = Params::new();
        load_in_stages(&pair, Boundary::FREE, Some(&friction()), stages, &params, None, &(), &mut []).unwrap()
    };
    let exact = CattaneoMindlin {
        normal: HertzSphere { radius: 1.0, modulus, load: pressing },
        tangential_modulus: tangential_modulus(&body, &body),
        friction: COEFFICIENT,
        tangential_load: force,
    };
    let [moved, _] = to(&stages[..1]).solution.rigid_displacement();
    let [slid, _] = to(&stages).solution.force();
    [slid / (COEFFICIENT * pressing) - 1.0, moved / exact.displacement() - 1.0]
}

/// The attraction of long range presses a sphere as a load does: the errors fall with Maugis' parameter.
#[test]
fn a_long_attraction_rubs_as_derjaguin_says() {
    let [long, longer] = [(0.08, 80), (0.04, 112)].map(|(lambda, cells)| derjaguin_errors(lambda, cells));
    for (long, longer) in long.iter().zip(longer) {
        let order = (long / longer).abs().log2();
        assert!(longer.abs() < 0.04 && (0.6..1.5).contains(&order), "{long} → {longer} is order {order}");
    }
}

/// Shear that changes the pressures needs hard walls.
#[test]
fn shear_that_changes_the_pressures_needs_hard_walls() {
    let stage = Stage::new(Loading::pressing(Control::Load(0.1)), 1);
    let unlike = rough([&body(), &Material::elastic(20.0, 0.1).unwrap()]);
    let load = |friction: Friction| {
        load_in_stages(&unlike, Boundary::FREE, Some(&friction), &[stage], &PARAMS, None, &(), &mut [])
    };
    let error = load(friction()).map(|_| ()).unwrap_err();
    assert!(matches!(error, Error::Unsupported(words) if words.contains("hard walls")), "{error}");
    assert!(load(friction().with_coupling(Coupling::Goodman)).is_ok());
}

/// Loaded, and pushed to and fro for some cycles, with Archard's wear of the lower body.
fn fretted(attraction: f64, wear: f64, cycles: usize, acceleration: Acceleration) -> LoadedContact {
    let pair = rough([&body(), &body()]);
    let pair = match attraction {
        0.0 => pair.with_interface(Arc::new(HardWall)),
        share => pair.with_interface(Arc::new(Adhesion::new(share * 0.004, 0.12).unwrap())),
    };
    let unit = 2e-3 * pair.lower_grid().area();
    let stage = |force: f64| {
        let tangential = Tangential::Force([force * unit, 0.0]);
        Stage::new(Loading { normal: Control::Load(unit), tangential }, 2)
    };
    let stages = vec![stage(0.3), stage(-0.3).with_cycles(Some(Cycles { count: cycles, period: None }))];
    let law = archard([wear, 0.0]);
    StagedLoading::new(pair, Boundary::FREE, Some(friction()), stages, PARAMS)
        .unwrap()
        .with_changes(Changes::by(law).with_acceleration(acceleration))
        .run(None, &(), &mut [])
        .unwrap()
}

/// Each volume is that of the friction work: wear counts the pressures that press, as friction does, and not
/// the tensions that pull.
#[test]
fn bodies_that_attract_each_other_fret_off_what_their_friction_takes() {
    let of_work = |attraction: f64, wear: f64, cycles: usize| {
        let worn = fretted(attraction, wear, cycles, Acceleration::NONE).record.fretting.unwrap();
        assert!(worn.laws.worn_volume_lower > 0.0);
        worn.laws.worn_volume_lower * COEFFICIENT / (wear * worn.friction_work)
    };
    // By little wear exactly, and by more with the order of an implicit step.
    for attraction in [1.0, 0.0] {
        assert!((of_work(attraction, 1e-7, 3) - 1.0).abs() < 1e-5);
        let errors = [4e-2, 2e-2].map(|wear| (of_work(attraction, wear, 1) - 1.0).abs());
        assert!(errors[0] < 0.05, "{errors:?}");
    }
}

#[test]
fn a_faint_attraction_frets_as_hard_walls_do() {
    let before = rough([&body(), &body()]).lower.heights;
    let worn = |attraction: f64| {
        let contact = fretted(attraction, 1e-2, 3, Acceleration::NONE);
        &before - &contact.changed.unwrap().pair.lower.heights
    };
    let hard = worn(0.0);
    let [faint, fainter] =
        [1e-3, 1e-5].map(|attraction| largest(&(&hard - &worn(attraction))) / largest(&hard));
    assert!(faint < 0.02 && (90.0..110.0).contains(&(faint / fainter)), "{faint:e} {fainter:e}");
    // The attraction presses what touches together: more of it sticks under the same push, and less is worn.
    assert!(worn(1.0).sum() < 0.2 * hard.sum());
}

/// Cycles that stand for several, beside all of them.
#[test]
fn cycles_of_bodies_that_attract_each_other_are_extrapolated() {
    let acceleration = Acceleration::default().with_max_jump(8).with_max_wear(1.0).with_tolerance(0.05);
    let all = fretted(1.0, 1e-3, 16, Acceleration::NONE);
    let few = fretted(1.0, 1e-3, 16, acceleration);
    assert!(few.increments.len() < all.increments.len() / 2, "{}", few.increments.len());
    let [all, few] = [&all, &few].map(|contact| contact.record.fretting.unwrap());
    assert_eq!((all.cycles, few.cycles), (16, 16));
    let ratio = few.laws.worn_volume_lower / all.laws.worn_volume_lower;
    assert!((ratio - 1.0).abs() < 5e-3, "{ratio}");
}
