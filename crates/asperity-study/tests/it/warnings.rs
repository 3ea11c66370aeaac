//! Warnings of a run outside the validity of its model, on both sides of each threshold. Random contacts are
//! compared with the same contact on a sufficiently large grid, and with Hertz.

use std::f64::consts::PI;

use asperity_base::{Field, Grid};
use asperity_contact::motion::StaticRecord;
use asperity_contact::reference::{HertzEllipse, HertzSphere};
use asperity_study::{Case, Existing, Outcome, Summary, SurfaceInput};
use asperity_surface::Topography;
use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use crate::support::{foreseen, parsed};

/// E* of steel on steel.
const MODULUS: f64 = 210e9 / (2.0 * (1.0 - 0.09));
const RADIUS: f64 = 1e-3;
const PITCH: f64 = 0.5e-6;

// ---- coatings --------------------------------------------------------------------------------------------

#[test]
fn a_coating_thinner_than_a_cell_is_told_of_and_hertz_says_nothing_of_a_coated_body() {
    const THIN: &str = "[lower.coating]\nthickness = 0.4e-6\nyoung = \"3 GPa\"\npoisson = 0.3\n";
    const THICK: &str = "[upper.coating]\nthickness = 5e-6\nyoung = \"3 GPa\"\npoisson = 0.3\n";
    let warnings = |motion| Static { form: sphere(), load: 1.0, motion, ..Static::default() }.check();
    let said =
        "the thickness of the coating of the lower body, 400 nm, is less than a cell; a cell is 500 nm";
    assert!(warnings(THIN).iter().any(|warning| warning.starts_with(said)), "{:?}", warnings(THIN));
    // By Hertz' estimate the boundary cuts off a body without the coating.
    assert!(warnings("").iter().any(|warning| warning.contains("by Hertz")));
    assert_eq!(warnings(THICK), Vec::<String>::new());
}

// ---- running-in ------------------------------------------------------------------------------------------

/// Rough surfaces; a seed follows.
const ROUGH: &str =
    "shape = [32, 16]\npitch = \"1 um\"\ngenerate = \"low-pass\"\nsq = \"20 nm\"\ncutoff = \"10 um\"\n";

/// Surfaces supplied by the caller under the names of their bodies; the following text is not a key.
const RAISED: &str = "given = \"BODY\"\n#";

/// Two rough bodies of 32 × 16 cells that slide at a speed, with `more` keys for each.
fn sliding(speed: &str, more: &str, rest: &str) -> Case {
    sliding_under("30 mN", ROUGH, speed, more, rest)
}

/// The same bodies under a load, with other topographies.
fn sliding_under(load: &str, topography: &str, speed: &str, more: &str, rest: &str) -> Case {
    let body = |name: &str, seed: u32| {
        format!(
            "[{name}]\nyoung = \"210 GPa\"\npoisson = 0.3\nconductivity = 46\nheat_capacity = 460\ndensity = 7850\n{more}\n\
             [{name}.topography]\n{}seed = {seed}\n",
            topography.replace("BODY", name)
        )
    };
    parsed(&format!(
        "{}{}[contact]\nload = \"{load}\"\n[friction]\ncoefficient = 0.1\ncoupling = \"none\"\n\
         [motion]\nspeed = \"{speed}\"\n{rest}",
        body("lower", 1),
        body("upper", 2)
    ))
}

#[test]
fn a_flash_temperature_of_cells_that_heat_does_not_leave_is_told_of() {
    // D = 12.74 mm²/s: the Péclet number V Δx/2D of a cell of a micrometre is 1 at 25.5 m/s.
    let told = |speed: &str, bulk: &str| {
        let warnings = foreseen(&sliding(speed, "", bulk));
        warnings.into_iter().find(|warning| warning.contains("Péclet number"))
    };
    let bulk = "[temperature]\nbulk = 300\n";
    assert_eq!(told("25 m/s", bulk), None);
    let fast = told("26 m/s", bulk).unwrap();
    assert!(fast.contains("its Péclet number is 1.02, up to 1"), "{fast}");
    assert_eq!(told("26 m/s", "[temperature]\nbulk = 300\nevery = 0\n"), None);
}

#[test]
fn a_flash_temperature_without_the_layers_of_a_body_is_told_of() {
    let told = |layer: &str, bulk: &str| {
        let case =
            sliding("1 m/s", "", &format!("[temperature]\nbulk = 300\n{bulk}[upper.coating]\n{layer}"));
        foreseen(&case)
            .into_iter()
            .filter(|warning| warning.contains("takes the upper body without its layers"))
            .count()
    };
    let layer = "thickness = \"5 um\"\nmaterial = \"dlc\"\n";
    assert_eq!([told(layer, ""), told(layer, "every = 0\n")], [1, 0]);
}

#[test]
fn wear_of_the_rim_a_thick_film_and_passes_all_computed_are_told_of() {
    let wear = "wear = { coefficient = \"1e-8 mm3/(N m)\" }\n";
    let film = "film = { law = \"arrhenius\", max_thickness = \"1 um\", rate = \"10 m/s\", at_temperature = 300, at_stress = 0, \
                activation_energy = 0, activation_volume = 0 }\n";
    let bulk = "[temperature]\nbulk = 300\nevery = 0\n";
    let told = |warnings: &[String], words: &str| warnings.iter().any(|warning| warning.contains(words));
    let light = run(&sliding("0.5 m/s", wear, &format!("stride = 4\n{bulk}"))).warnings;
    assert!(
        !told(&light, "of the wear") && !told(&light, "the film") && !told(&light, "computed"),
        "{light:?}"
    );
    // Pressed flat, the whole body grows the film.
    let flat =
        sliding_under("2 N", ROUGH, "0.5 m/s", &format!("{wear}{film}"), &format!("stride = 4\n{bulk}"));
    let flat = run(&flat).warnings;
    assert!(told(&flat, "pass 1: the film on the lower body is "), "{flat:?}");
    let case = sliding_under("30 mN", RAISED, "0.5 m/s", wear, &format!("stride = 4\n{bulk}"));
    let mut given = SurfaceInput::default();
    for name in ["lower", "upper"] {
        // Its ends are raised.
        let heights = Field::from_shape_fn([32, 16], |(i, j)| {
            if (2..30).contains(&i) { 0.0 } else { 2e-7 + 1e-9 * (j % 3) as f64 }
        });
        let grid = Grid::new([32, 16], [1e-6; 2]).unwrap();
        given.topographies.insert(name.to_owned(), Topography::new(grid, heights).unwrap());
    }
    let folder = tempfile::tempdir().unwrap();
    let ends = asperity_study::run(&case, given, &folder.path().join("results"), Existing::Keep, &())
        .unwrap()
        .0
        .warnings;
    assert!(told(&ends, "of the wear: free ends plough"), "{ends:?}");
    let [all, accelerated] = ["", "[acceleration]\n"].map(|table| {
        run(&sliding("0.5 m/s", wear, &format!("passes = 100\nstride = 16\n{bulk}{table}"))).warnings
    });
    let computed =
        |warnings: &[String]| warnings.iter().any(|warning| warning.contains("passes were computed"));
    assert!(computed(&all) && !computed(&accelerated), "{all:?} {accelerated:?}");
}

#[test]
fn passes_that_change_the_bodies_no_more_are_told_of() {
    let bulk = "[temperature]\nbulk = 300\nevery = 0\n";
    let warned = |more: &str, passes: usize| {
        let warnings =
            run(&sliding("0.5 m/s", more, &format!("passes = {passes}\nstride = 16\n{bulk}"))).warnings;
        warnings.into_iter().find(|warning| warning.contains("stop changing"))
    };
    let elastic = warned("", 11).unwrap();
    assert_eq!(elastic, "the bodies stop changing at pass 2: `passes = 1` is enough");
    assert_eq!(warned("", 10), None);
    assert_eq!(warned("wear = { coefficient = \"1e-8 mm3/(N m)\" }\n", 11), None);
    // It yields until it has shaken down.
    let shaken = warned("hardness = \"1 GPa\"\n", 60).unwrap();
    let first = shaken.split([' ', ':']).nth(6).unwrap().parse::<usize>().unwrap();
    assert!((3..50).contains(&first), "{shaken}");
}

// ---- the boundary of the grid ----------------------------------------------------------------------------

#[test]
fn a_ball_whose_contact_the_rim_cuts_off_is_told_of_with_the_pressures() {
    let cuts = |load: f64| {
        let case = Static { form: sphere(), load, ..Static::default() };
        (rim(&case.check()), rim(&case.run().warnings))
    };
    // Hertz' radius is 16 µm, half the grid, at 0.63 N; the largest pressure agrees with his up to 0.9 N.
    assert_eq!(cuts(0.6), (None, None));
    assert_eq!(cuts(0.8), (None, None));
    let (foreseen, seen) = cuts(1.0);
    assert!(foreseen.unwrap().contains("reaches 18.66 µm from the apex, the rim is 16 µm away"));
    let seen = seen.unwrap();
    for part in [
        "largest pressure there is 1.661 GPa, inside 1.382 GPa",
        "bear 4.89 % of the load; take a larger `shape`",
    ] {
        assert!(seen.contains(part), "{seen}");
    }
    let (foreseen, seen) = cuts(50.0);
    assert!(foreseen.is_some() && seen.is_some());
}

#[test]
fn a_rough_plane_is_meant_to_be_cut_off_and_a_periodic_contact_has_no_rim() {
    let rough = "generate = \"low-pass\"\nsq = 1e-7\ncutoff = 8e-6\nseed = 3\n".to_owned();
    let plane = Static { form: rough, load: 0.5, ..Static::default() };
    assert_eq!((rim(&plane.check()), rim(&plane.run().warnings)), (None, None));
    let periodic = Static { form: sphere(), load: 1.0, boundary: "periodic", ..Static::default() };
    assert_eq!((rim(&periodic.check()), rim(&periodic.run().warnings)), (None, None));
}

#[test]
fn a_free_cylinder_is_told_of_for_its_ends_and_a_hollow_for_its_rim() {
    let cylinder = |boundary| {
        let form = format!("form = \"cylinder\"\nradius = {RADIUS}\n");
        Static { form, load: 0.1, boundary, ..Static::default() }
    };
    let foreseen = rim(&cylinder("free").check()).unwrap();
    assert!(foreseen.starts_with("the line contact ends at the rim of the grid along y"), "{foreseen}");
    assert!(rim(&cylinder("free").run().warnings).unwrap().contains("along y"));
    let periodic = cylinder("periodic");
    assert_eq!((rim(&periodic.check()), rim(&periodic.run().warnings)), (None, None));
}

#[test]
fn a_hollow_that_touches_at_its_rim_is_told_of() {
    // Around the trough of a sinusoid.
    let wavelength = 64.0 * PITCH;
    let form = format!(
        "form = \"sinusoid\"\namplitude = 1e-7\nwavelength = {wavelength}\nshape = [128, 128]\nwindow = [20, 52, 24, 24]\n"
    );
    let hollow = Static { form, shape: [24, 24], load: 0.01, ..Static::default() };
    assert!(rim(&hollow.check()).unwrap().starts_with("the gap is hollow, of radius "));
    assert!(rim(&hollow.run().warnings).is_some());
}

#[test]
fn a_rough_ball_is_told_of_where_a_smooth_one_is() {
    let rough = format!(
        "{}[[upper.topography.plus]]\ngenerate = \"low-pass\"\nsq = 5e-9\ncutoff = 4e-6\nseed = 5\n",
        sphere()
    );
    for (load, cut) in [(0.4, false), (2.0, true)] {
        let case = Static { form: rough.clone(), load, ..Static::default() };
        let (foreseen, seen) = (rim(&case.check()), rim(&case.run().warnings));
        assert_eq!((foreseen.is_some(), seen.is_some()), (cut, cut), "{load} N: {foreseen:?}, {seen:?}");
    }
}

#[test]
fn a_ball_that_passes_over_a_plane_is_told_of_by_hertz() {
    for (load, cut) in [(0.05, false), (4.0, true)] {
        let motion = "[motion]\nstride = 16\ncontrol = \"step-load\"\n";
        let case = Static { form: sphere(), load, motion, ..Static::default() };
        for warnings in [case.check(), case.run().warnings] {
            assert_eq!(rim(&warnings).is_some(), cut, "{load} N: {warnings:?}");
        }
    }
}

/// Balls, ellipsoids, cones and cylinders on grids of various shapes with both boundaries.
///
/// There is a warning if the boundary changes the largest pressure by more than 5 %, and none if pressure and
/// approach are accurate to 1 %. The reference is the contact on a grid twice as long and wide, itself
/// compared with Hertz.
#[test]
fn a_warning_stands_where_the_rim_changes_the_contact_and_nowhere_else() {
    random_rims(1, 40);
}

#[test]
#[ignore = "takes minutes"]
fn a_warning_stands_where_the_rim_changes_many_more_contacts() {
    random_rims(2, 1500);
}

fn random_rims(seed: u64, cases: usize) {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let [mut warned, mut silent, mut foreseen] = [0; 3];
    for _ in 0..cases {
        let shape = [random.random_range(24..56), random.random_range(24..56)];
        let half = 0.5 * PITCH * shape[0].min(shape[1]) as f64;
        // Relative to the shorter half of the grid.
        let reach = random.random_range(0.4..1.7) * half;
        let periodic = random.random_bool(0.15);
        let boundary = if periodic { "periodic" } else { "free" };
        let kind = random.random_range(0..4);
        let ball = HertzSphere { radius: RADIUS, modulus: MODULUS, load: 1.0 };
        let of_a_ball = (reach / ball.contact_radius()).powi(3);
        let (form, load, hertz) = match kind {
            0 => {
                let peak = HertzSphere { load: of_a_ball, ..ball }.peak_pressure();
                (sphere(), of_a_ball, Some(peak))
            }
            1 => {
                let across = RADIUS * 10f64.powf(random.random_range(-0.7..1.0));
                let along = if random.random_bool(0.5) { "x" } else { "y" };
                let form = sphere()
                    + &format!(
                        "[[upper.topography.plus]]\nform = \"cylinder\"\nradius = {across}\naxis = \"{along}\"\n"
                    );
                let sharp = 1.0 / (1.0 / RADIUS + 1.0 / across);
                let radii = if along == "y" { [sharp, RADIUS] } else { [RADIUS, sharp] };
                let peak = HertzEllipse::new(radii, MODULUS, of_a_ball).peak_pressure;
                (form, of_a_ball, Some(peak))
            }
            2 => {
                let load = 0.5 * MODULUS * 1f64.to_radians().tan() * PI * reach * reach;
                ("form = \"cone\"\nangle = \"1 deg\"\n".to_owned(), load, None)
            }
            _ => (format!("form = \"cylinder\"\nradius = {RADIUS}\naxis = \"x\"\n"), of_a_ball, None),
        };
        let case = Static { form, load, shape, boundary, ..Static::default() };
        let summary = case.run();
        let (told, early) = (rim(&summary.warnings), rim(&case.check()));
        let name = format!("{case:?}: {told:?}, {early:?}");
        if periodic {
            assert!(told.is_none() && early.is_none(), "{name}");
            continue;
        }
        if kind == 3 {
            assert!(told.is_some() && early.is_some(), "{name}");
            continue;
        }
        // Its apex has the same place in a cell.
        let held = Static { shape: shape.map(|n| n + 2 * (n / 2)), ..case.clone() }.run();
        let (here, there) = (record(&summary), record(&held));
        // If the larger grid is sufficient, the contact is that of Hertz, except with few cells.
        if let (Some(peak), None) = (hertz, rim(&held.warnings)) {
            assert!(
                (there.max_pressure / peak - 1.0).abs() < 0.03,
                "{name}: {:e}, Hertz {peak:e}",
                there.max_pressure
            );
        }
        let pressure = (here.max_pressure / there.max_pressure - 1.0).abs();
        let approach = (here.approach / there.approach - 1.0).abs();
        assert!(pressure < 0.05 || told.is_some(), "{name}: pressure off by {pressure}");
        assert!(pressure.max(approach) > 0.01 || told.is_none(), "{name}: {pressure}, {approach}");
        // Predicted by an estimate.
        assert!(pressure < 0.3 || early.is_some(), "{name}: pressure off by {pressure}");
        assert!(pressure.max(approach) > 0.002 || early.is_none(), "{name}: {pressure}, {approach}");
        match told {
            Some(_) => warned += 1,
            None => silent += 1,
        }
        foreseen += usize::from(early.is_some());
    }
    let counts = format!("{warned} warned of, {silent} not, {foreseen} foreseen");
    assert!(warned > cases / 10 && silent > cases / 10 && foreseen > cases / 10, "{counts}");
}

// ---- contact spots ---------------------------------------------------------------------------------------

#[test]
fn a_contact_spot_of_less_than_six_cells_is_told_of() {
    // Hertz' contact is 4.4 cells across, then 6.8.
    for (cells, across) in [(2.2, Some("4.400")), (3.4, None)] {
        let load = 4.0 * MODULUS * (cells * PITCH).powi(3) / (3.0 * RADIUS);
        let case = Static { form: sphere(), load, ..Static::default() };
        let (foreseen, seen) = (coarse(&case.check()), coarse(&case.run().warnings));
        assert_eq!((foreseen.is_some(), seen.is_some()), (across.is_some(), across.is_some()), "{seen:?}");
        if let Some(across) = across {
            assert!(foreseen.unwrap().contains(&format!("{across} cells")));
            assert!(seen.unwrap().ends_with("needed for its pressures; take a smaller `pitch`"));
        }
    }
    let single = Static { form: sphere(), load: 1e-6, shape: [31, 31], ..Static::default() };
    assert!(coarse(&single.run().warnings).unwrap().contains("a single cell"));
}

#[test]
fn bodies_that_an_approach_does_not_bring_together_are_told_of_with_their_gap() {
    let form = || format!("form = \"sphere\"\nradius = {RADIUS}\n");
    for (approach, motion) in [(-50e-9, ""), (-50e-9, "[motion]\n"), (1e-9, ""), (1e-9, "[motion]\n")] {
        let case =
            Static { form: form(), shape: [31, 31], approach: Some(approach), motion, ..Static::default() };
        for warnings in [case.check(), case.run().warnings] {
            let told = warnings.iter().find(|warning| warning.starts_with("no contact"));
            assert_eq!(told.is_some(), approach < 0.0, "{warnings:?}");
            if let Some(told) = told {
                let parts = ["the approach is -50 nm, the smallest gap 0 m", "from an `approach` of 0 m on"];
                assert!(parts.iter().all(|part| told.contains(part)), "{told}");
                assert!(coarse(&warnings).is_none(), "{warnings:?}");
            }
        }
    }
}

// ---- motion ----------------------------------------------------------------------------------------------

#[test]
fn a_stride_over_material_that_yields_is_told_of_with_the_share_that_meets() {
    let warnings = |stride: usize, hardness: &str| {
        let case = moving(32, &format!("stride = {stride}"), [hardness; 2], 2, "");
        foreseen(&case).into_iter().find(|warning| warning.contains("comb"))
    };
    assert_eq!(warnings(1, "2.8 GPa"), None);
    assert_eq!(warnings(4, "inf"), None);
    let told = warnings(4, "2.8 GPa").unwrap();
    assert!(told.contains("`stride = 4` each column meets 25.00 % of those that pass it"), "{told}");
}

#[test]
fn a_rim_that_takes_most_of_the_plastic_volume_is_told_of_with_its_share() {
    let mut warned = [0; 2];
    // This number of cells at each end belongs to it.
    for (seed, cells, rim) in [(2, 64, 6), (2, 32, 3), (3, 32, 3), (4, 32, 3)] {
        let area = 1.0 - (f64::from(cells - 2 * rim) / f64::from(cells)).powi(2);
        let told = |rim: &str| {
            let summary = run(&moving(cells, "", ["2.8 GPa", "7 GPa"], seed, rim));
            let Outcome::Passes(passes) = &summary.outcome else { panic!("a motion") };
            let share = 1.0 - passes[0].lost_inside("plastic")[0] / passes[0].lost("plastic")[0];
            (share, summary.warnings.into_iter().find(|warning| warning.contains("of the plastic volume")))
        };
        let (share, warning) = told("rim = 0.1");
        let is_most = share > 0.5 && share / (1.0 - share) > 2.0 * area / (1.0 - area);
        assert_eq!(warning.is_some(), is_most, "{share}: {warning:?}");
        if let Some(warning) = warning {
            assert!(
                warning.contains(&format!("takes {:.2} % of the plastic volume", 100.0 * share)),
                "{warning}"
            );
            assert!(warning.contains(&format!("{:.2} % of their area", 100.0 * area)), "{warning}");
        }
        warned[usize::from(is_most)] += 1;
        assert_eq!(told("rim = 0"), (0.0, None));
    }
    assert!(warned[0] > 0 && warned[1] > 0, "{warned:?}");
}

// ---- helpers ---------------------------------------------------------------------------------------------

/// A form or a rough surface over a flat.
#[derive(Debug, Clone)]
struct Static {
    form: String,
    load: f64,
    approach: Option<f64>,
    shape: [usize; 2],
    boundary: &'static str,
    motion: &'static str,
}

impl Default for Static {
    fn default() -> Self {
        Self { form: String::new(), load: 1.0, approach: None, shape: [64, 64], boundary: "free", motion: "" }
    }
}

impl Static {
    fn case(&self) -> Case {
        let Self { form, load, approach, shape, boundary, motion } = self;
        let steel = "young = \"210 GPa\"\npoisson = 0.3\n";
        let grid = format!("shape = {shape:?}\npitch = {PITCH}\n");
        let of_form = if form.contains("shape") { format!("pitch = {PITCH}\n") } else { grid.clone() };
        let prescribed =
            approach.map_or(format!("load = {load}"), |approach| format!("approach = {approach}"));
        // Layers on a form follow the keys of the form.
        let (own, plus) = form
            .split_once("[[")
            .map_or((form.as_str(), String::new()), |(own, plus)| (own, format!("[[{plus}")));
        parsed(&format!(
            "[lower]\n{steel}[lower.topography]\nform = \"flat\"\n{grid}[upper]\n{steel}[upper.topography]\n{own}{of_form}{plus}\
             [contact]\n{prescribed}\nboundary = \"{boundary}\"\n{motion}"
        ))
    }

    fn check(&self) -> Vec<String> {
        foreseen(&self.case())
    }

    fn run(&self) -> Summary {
        run(&self.case())
    }
}

/// Two rough surfaces that pass over each other.
fn moving(cells: i32, motion: &str, hardness: [&str; 2], seed: u64, output: &str) -> Case {
    let body = |name: &str, hardness: &str, seed: u64| {
        let hardness = if hardness == "inf" { "inf".to_owned() } else { format!("\"{hardness}\"") };
        format!(
            "[{name}]\nyoung = \"210 GPa\"\npoisson = 0.3\nhardness = {hardness}\n[{name}.topography]\n\
             generate = \"low-pass\"\nshape = [{cells}, {cells}]\npitch = 1e-6\nsq = 35e-9\ncutoff = 8e-6\nseed = {seed}\n"
        )
    };
    let (lower, upper) = (body("lower", hardness[0], 1), body("upper", hardness[1], seed));
    let load = 44e-6 * f64::from(cells).powi(2);
    parsed(&format!("{lower}{upper}[contact]\nload = {load}\n[motion]\n{motion}\n[output]\n{output}\n"))
}

fn run(case: &Case) -> Summary {
    crate::support::run(case, tempfile::tempdir().unwrap().path()).0
}

fn record(summary: &Summary) -> &StaticRecord {
    let Outcome::Static(record) = &summary.outcome else { panic!("a static contact") };
    record
}

fn sphere() -> String {
    format!("form = \"sphere\"\nradius = {RADIUS}\n")
}

fn rim(warnings: &[String]) -> Option<String> {
    warnings.iter().find(|warning| warning.contains("the rim of the grid")).cloned()
}

fn coarse(warnings: &[String]) -> Option<String> {
    warnings.iter().find(|warning| warning.contains("coarse for the contact")).cloned()
}
