//! A load sweep of a static contact: each point is an independent contact, and its stiffness is the slope of the curve.

use std::fs;
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

use asperity::material::Material;
use asperity::motion::{
    LoadedContact, Pair, Point, Progress, StaticContact, SweepRecord, Watch, press, roll, sweep,
};
use asperity::operator::Boundary;
use asperity::reference::HertzLine;
use asperity::solver::{Control, Creep, Friction, Method, Params, Rolling};
use asperity::study;
use asperity::study::Case;
use asperity::study::Outcome;
use asperity::study::{Existing, Results};
use asperity::surface::{Amplitude, SelfAffine, Topography};
use asperity::{Error, Field, Grid};
use rand::seq::SliceRandom;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

const FINE: Params =
    Params::new().with_method(Method::Auto).with_tolerance(1e-9).with_max_convolutions(10_000);

fn pair(grid: Grid, gap: Field, hardness: f64) -> Pair {
    let steel = Material::new(210e9, 0.3, hardness).unwrap();
    let topography = |heights| Topography::new(grid, heights).unwrap();
    Pair::new(topography(grid.zeros()), topography(gap), [&steel, &steel]).unwrap()
}

/// A self-affine surface with slope 0.05 on a plane.
fn rough(shape: [usize; 2], hardness: f64, seed: u64) -> Pair {
    let grid = Grid::new(shape, [1e-6; 2]).unwrap();
    let amplitude = Amplitude::Sdq(0.05);
    let method = SelfAffine { hurst: 0.8, rolloff: None, shortest: Some(6e-6), amplitude };
    pair(grid, method.generate(&grid, seed).unwrap().into_heights(), hardness)
}

fn ball(cells: usize, pitch: f64) -> Pair {
    let grid = Grid::new([cells; 2], [pitch; 2]).unwrap();
    let middle = 0.5 * cells as f64 * pitch;
    let gap = Field::from_shape_fn(grid.shape, |(i, j)| {
        ((grid.centre(0, i) - middle).powi(2) + (grid.centre(1, j) - middle).powi(2)) / 2e-3
    });
    pair(grid, gap, f64::INFINITY)
}

fn at(control: Control) -> Point {
    Point { control, rolling: None }
}

fn swept(
    pair: &Pair,
    boundary: Boundary,
    points: &[Point],
    params: &Params,
) -> (Vec<SweepRecord>, LoadedContact) {
    sweep(pair, boundary, None, points, params, Vec::new(), &(), &mut []).unwrap()
}

#[test]
fn in_any_order_each_point_is_the_contact_of_its_load_alone_bit_by_bit() {
    let mut random = ChaCha8Rng::seed_from_u64(11);
    for n in 0..24 {
        let hardness = if n % 2 == 0 { f64::INFINITY } else { random.random_range(2e9..6e9) };
        let boundary = if n % 4 < 2 { Boundary::FREE } else { Boundary::PERIODIC };
        let shape = [random.random_range(12..80), random.random_range(12..80)];
        let pair = rough(shape, hardness, n);
        let full = pair.lower_grid().area() * 3e9;
        let approach = |random: &mut ChaCha8Rng| {
            let gap = pair.initial_gap(&pair.at_rest());
            let touch = gap.iter().copied().fold(f64::INFINITY, f64::min);
            Control::Approach(touch + random.random_range(-0.1..0.9) * (gap.mean().unwrap() - touch))
        };
        let mut controls: Vec<_> =
            (0..4).map(|_| Control::Load(full * 10f64.powf(random.random_range(-4.0..-0.6)))).collect();
        controls.push(approach(&mut random));
        controls.shuffle(&mut random);
        let points: Vec<_> = controls.iter().copied().map(at).collect();
        let (records, last) = swept(&pair, boundary, &points, &Params::default());
        for (record, control) in records.iter().zip(&controls) {
            let StaticContact { record: alone, solution, .. } =
                press(&pair, boundary, *control, &Params::default(), &()).unwrap();
            let area = alone.apparent_area;
            assert_eq!(
                (record.load, record.approach, record.mean_gap, record.contact_area, record.max_pressure),
                (alone.load, alone.approach, alone.mean_gap, alone.contact_area, alone.max_pressure)
            );
            assert_eq!(
                (record.plastic_volume, record.elastic_energy, record.iterations, record.residual),
                (alone.plastic_volume, alone.elastic_energy, alone.iterations, alone.residual)
            );
            assert_eq!(
                (record.mean_pressure, record.contact_fraction),
                (alone.load / area, alone.contact_area / area)
            );
            assert_eq!(record.plastic_area, alone.plastic_cells as f64 * pair.cell_area());
            if record.point == points.len() {
                assert_eq!((&last.record, &last.solution.normal().pressure), (&alone, &solution.pressure));
            }
        }
    }
}

/// K is the slope of the load over the approach, compared with a central difference over ±0.2 % of the load on accurate
/// pressures. It also holds beyond the elastic range, where the pressure of cells at the hardness is constant.
#[test]
fn the_stiffness_is_the_slope_of_the_load_over_the_approach() {
    let mut random = ChaCha8Rng::seed_from_u64(3);
    for n in 0..16 {
        let hardness = if n % 2 == 0 { f64::INFINITY } else { random.random_range(2e9..5e9) };
        let boundary = if n % 4 < 2 { Boundary::FREE } else { Boundary::PERIODIC };
        let pair = rough([random.random_range(24..64), random.random_range(24..64)], hardness, 100 + n);
        let load = pair.lower_grid().area() * 3e9 * 10f64.powf(random.random_range(-2.5..-0.7));
        let points = [0.998, 1.0, 1.002].map(|share| at(Control::Load(share * load)));
        let (records, _) = swept(&pair, boundary, &points, &FINE);
        let [less, here, more] = [&records[0], &records[1], &records[2]];
        let slope = (more.load - less.load) / (more.approach - less.approach);
        let stiffness = here.stiffness.unwrap();
        // Between the two the set of cells changes, and the slope with it.
        let ends = [less, more].map(|point| point.stiffness.unwrap());
        let change = (ends[1] - ends[0]).abs() + 1e-5 * stiffness;
        assert!((slope - stiffness).abs() <= change, "{n}: {slope:e} {stiffness:e} {ends:?}");
        assert!(change < 0.1 * stiffness, "{n}: {ends:?}");
        if boundary == Boundary::PERIODIC && hardness.is_infinite() {
            // The mean displacement is 0: approach and mean gap are equivalent.
            let of_gap = (more.load - less.load) / (less.mean_gap - more.mean_gap);
            assert!((of_gap / slope - 1.0).abs() < 1e-6, "{of_gap} {slope}");
        }
    }
}

/// K = 2 E* a, a = (3WR/4E*)^⅓; the edge of the contact is known to a fraction of a cell.
#[test]
fn the_stiffness_of_a_ball_is_that_of_hertz() {
    let (modulus, radius) = (210e9 / (2.0 * (1.0 - 0.09)), 1e-3);
    let mut errors = Vec::new();
    for (cells, pitch) in [(64, 1e-6), (128, 0.5e-6), (256, 0.25e-6)] {
        let pair = ball(cells, pitch);
        let loads = [0.2, 1.0, 0.5];
        let (records, _) =
            swept(&pair, Boundary::FREE, &loads.map(|load| at(Control::Load(load))), &Params::default());
        let error = records.iter().zip(loads).map(|(record, load)| {
            let contact_radius = (0.75 * load * radius / modulus).cbrt();
            (record.stiffness.unwrap() / (2.0 * modulus * contact_radius) - 1.0).abs()
        });
        errors.push(error.fold(0.0, f64::max));
    }
    assert!(errors[0] < 8e-3 && errors[1] < 3e-3 && errors[2] < 1.5e-3, "{errors:?}");
}

#[test]
fn what_does_not_touch_has_no_stiffness_and_what_closes_a_period_gives_nowhere() {
    let pair = rough([32, 32], f64::INFINITY, 1);
    let gap = pair.initial_gap(&pair.at_rest());
    let touch = gap.iter().copied().fold(f64::INFINITY, f64::min);
    let full = pair.lower_grid().area() * 1e12;
    let points = [Control::Approach(touch - 1e-9), Control::Load(full)].map(at);
    let (records, _) = swept(&pair, Boundary::PERIODIC, &points, &Params::default());
    assert_eq!((records[0].load, records[0].stiffness), (0.0, Some(0.0)));
    assert_eq!((records[1].contact_fraction, records[1].stiffness), (1.0, None));
}

#[test]
fn what_rolls_is_swept_as_it_rolls_alone() {
    let pair = ball(24, 1e-6);
    let friction = Friction::coulomb(0.3).unwrap();
    let rolling = Rolling { creep: Creep::Creepage([5e-4, 0.0]), spin: 0.0 };
    let points = [0.1, 0.03].map(|load| Point { control: Control::Load(load), rolling: Some(rolling) });
    let params = Params::default().with_tolerance(1e-4);
    let (records, _) =
        sweep(&pair, Boundary::FREE, Some(&friction), &points, &params, Vec::new(), &(), &mut []).unwrap();
    for (record, point) in records.iter().zip(&points) {
        let alone =
            roll(&pair, Boundary::FREE, &friction, point.control, rolling, &params, &()).unwrap().record;
        let shear = alone.shear.unwrap();
        assert_eq!([record.tangential_force_x, record.tangential_force_y], shear.tangential_force);
        assert_eq!((record.stick_area, record.max_shear), (shear.stick_area, shear.max_shear));
        assert_eq!(([record.creepage_x, record.creepage_y], record.load), ([5e-4, 0.0], alone.load));
        assert!(record.tangential_force_x.abs() > 0.05 * record.load);
    }
}

#[test]
fn a_point_without_an_answer_is_named() {
    let pair = rough([16, 16], 1e9, 1);
    let limit = pair.lower_grid().area() * 1e9;
    let points = [0.1, 1.1, 0.2].map(|share| at(Control::Load(share * limit)));
    let error = sweep(&pair, Boundary::FREE, None, &points, &FINE, Vec::new(), &(), &mut []).unwrap_err();
    assert!(error.to_string().starts_with("point 2 of 3: load"), "{error}");
    assert!(matches!(
        sweep(&pair, Boundary::FREE, None, &[], &FINE, Vec::new(), &(), &mut []),
        Err(Error::Unsupported(_))
    ));
}

// ---- from the case to its results ------------------------------------------------------------------------

const CASE: &str = r#"
[lower]
young = "210 GPa"
poisson = 0.3
hardness = "4 GPa"
topography = { form = "flat", shape = [40, 32], pitch = "1 um" }
[upper]
young = "210 GPa"
poisson = 0.3
topography = { generate = "self-affine", shape = [40, 32], pitch = "1 um", sdq = 0.05, hurst = 0.8, shortest = "6 um" }
[contact]
loads = { from = "1 mN", to = "0.3 N", points = 6 }
[output]
pressure_every = 2
"#;

/// Stops after a number of points.
struct StopAfter(usize, AtomicUsize);

impl StopAfter {
    fn points(count: usize) -> Self {
        Self(count, AtomicUsize::new(0))
    }
}

impl Watch for StopAfter {
    fn at(&self, progress: &Progress) {
        self.1.store(progress.solved, Relaxed);
    }

    fn stop(&self) -> bool {
        self.1.load(Relaxed) >= self.0
    }
}

/// A cylinder rolling at several creepages, with few outputs.
const ROLLING: &str = r#"
[lower]
young = "210 GPa"
poisson = 0.3
topography = { form = "flat", shape = [84, 2], pitch = "1 um" }
[upper]
young = "210 GPa"
poisson = 0.3
topography = { form = "cylinder", radius = "5 mm", shape = [84, 2], pitch = "1 um" }
[contact]
load = "40 mN"
boundary = ["free", "periodic"]
tolerance = 1e-4
[friction]
coefficient = 0.2
creepages = [2e-3, 4e-4, 0, -1e-3]
"#;

/// Carter, Proc. R. Soc. A 112, 151 (1926): Q/μW = 1 − (1 − ξR/μa)², gross slip from ξ = μa/R on.
#[test]
fn through_creepages_a_cylinder_draws_carters_curve() {
    let folder = tempfile::tempdir().unwrap();
    let case = Case::parse(ROLLING, "case.toml".as_ref(), "".as_ref()).unwrap();
    let out = folder.path().join("out");
    let (summary, _) =
        study::run(&case, asperity::study::SurfaceInput::default(), &out, Existing::Keep, &()).unwrap();
    let Outcome::Sweep(points) = &summary.outcome else { panic!() };
    let modulus = 210e9 / (2.0 * (1.0 - 0.09));
    let hertz = HertzLine { radius: 5e-3, modulus, load_per_length: 0.04 / 2e-6 };
    let (a, friction) = (hertz.half_width(), 0.2);
    for (point, creepage) in points.iter().zip([2e-3f64, 4e-4, 0.0, -1e-3]) {
        let share = (creepage.abs() * 5e-3 / (friction * a)).min(1.0);
        let expected = creepage.signum() * friction * (1.0 - (1.0 - share).powi(2));
        let found = point.tangential_force_x / point.load;
        assert!((found - expected).abs() < 0.03 * friction, "{creepage}: {found}, Carter {expected}");
        assert_eq!((point.creepage_x, point.creepage_y), (creepage, 0.0));
        // Equal to a single contact, to the bit.
        let one = ROLLING
            .replace("[2e-3, 4e-4, 0, -1e-3]", &format!("{creepage:e}"))
            .replace("creepages", "creepage");
        let case = Case::parse(&one, "case.toml".as_ref(), "".as_ref()).unwrap();
        let alone = folder.path().join(format!("alone-{}", point.point));
        let Outcome::Static(alone) =
            study::run(&case, asperity::study::SurfaceInput::default(), &alone, Existing::Keep, &())
                .unwrap()
                .0
                .outcome
        else {
            panic!()
        };
        assert_eq!(point.tangential_force_x, alone.shear.unwrap().tangential_force[0]);
    }
    // Interrupted after any point, it continues to the same bytes.
    for count in 1..4 {
        let broken = folder.path().join(format!("broken-{count}"));
        let stopped = study::run(
            &case,
            asperity::study::SurfaceInput::default(),
            &broken,
            Existing::Keep,
            &StopAfter::points(count),
        );
        assert!(matches!(stopped, Err(Error::Interrupted)));
        study::run(&case, asperity::study::SurfaceInput::default(), &broken, Existing::Resume, &()).unwrap();
        for file in ["sweep.csv", "fields.h5"] {
            assert_eq!(
                fs::read(broken.join(file)).unwrap(),
                fs::read(out.join(file)).unwrap(),
                "{count}: {file}"
            );
        }
    }
    let written = fs::read_to_string(out.join("case.json")).unwrap();
    assert!(written.contains("\"creepages\"") && !written.contains("\"creepage\""), "{written}");
}

#[test]
fn an_interrupted_sweep_goes_on_to_the_same_bits() {
    let folder = tempfile::tempdir().unwrap();
    let case = Case::parse(CASE, "case.toml".as_ref(), "".as_ref()).unwrap();
    let whole = folder.path().join("whole");
    let (summary, _) =
        study::run(&case, asperity::study::SurfaceInput::default(), &whole, Existing::Keep, &()).unwrap();
    let Outcome::Sweep(points) = &summary.outcome else { panic!() };
    assert_eq!(points, &Results::open(&whole).unwrap().sweep().unwrap());
    assert!(
        points[5].plastic_area > 0.0 && points.windows(2).all(|pair| pair[0].stiffness < pair[1].stiffness)
    );
    for count in 1..6 {
        let broken = folder.path().join(format!("broken-{count}"));
        let stopped = study::run(
            &case,
            asperity::study::SurfaceInput::default(),
            &broken,
            Existing::Keep,
            &StopAfter::points(count),
        );
        assert!(matches!(stopped, Err(Error::Interrupted)));
        assert_eq!(Results::open(&broken).unwrap().sweep().unwrap(), points[..count]);
        study::run(&case, asperity::study::SurfaceInput::default(), &broken, Existing::Resume, &()).unwrap();
        let files = [
            "sweep.csv",
            "fields.h5",
            "fields/point-0001.h5",
            "fields/point-0003.h5",
            "fields/point-0005.h5",
        ];
        for file in files {
            assert!(
                fs::read(broken.join(file)).unwrap() == fs::read(whole.join(file)).unwrap(),
                "{count}: {file}"
            );
        }
        assert_eq!(fs::read_dir(broken.join("fields")).unwrap().count(), 3);
    }
    // Damaged files, and those of another sweep, are refused.
    let broken = folder.path().join("broken-3");
    fs::remove_file(broken.join("fields/point-0003.h5")).unwrap();
    let error = study::run(&case, asperity::study::SurfaceInput::default(), &broken, Existing::Resume, &())
        .err()
        .unwrap()
        .to_string();
    assert!(error.ends_with("point-0003.h5 is missing"), "{error}");
    let other = Case::parse(&CASE.replace("0.3 N", "0.4 N"), "case.toml".as_ref(), "".as_ref()).unwrap();
    let error = study::run(&other, asperity::study::SurfaceInput::default(), &whole, Existing::Resume, &())
        .err()
        .unwrap()
        .to_string();
    assert!(error.contains("'contact.loads."), "{error}");
}

#[test]
fn the_fields_of_points_are_those_of_their_contacts() {
    let folder = tempfile::tempdir().unwrap();
    let case = Case::parse(CASE, "case.toml".as_ref(), "".as_ref()).unwrap();
    let out = folder.path().join("out");
    study::run(&case, asperity::study::SurfaceInput::default(), &out, Existing::Keep, &()).unwrap();
    let results = Results::open(&out).unwrap();
    let field = |point: usize, name: &str| {
        results.point_fields(point).unwrap().read(name).unwrap().into_field().unwrap()
    };
    for record in results.sweep().unwrap().iter().step_by(2) {
        let (p, gap, plastic) =
            (field(record.point, "pressure"), field(record.point, "gap"), field(record.point, "plastic"));
        assert!((p.sum() * 1e-12 / record.load - 1.0).abs() < 1e-9);
        assert!((gap.mean().unwrap() / record.mean_gap - 1.0).abs() < 1e-9);
        assert!((plastic.sum() * 1e-12 - record.plastic_volume).abs() <= 1e-9 * record.plastic_volume);
        let apart = &gap + &plastic;
        let touching =
            p.iter().zip(&apart).filter(|(p, _)| **p > 0.0).map(|(_, g)| g.abs()).fold(0.0, f64::max);
        assert!(touching < 1e-5 * gap.std(0.0), "{touching}");
    }
}
