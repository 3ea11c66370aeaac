//! Output of a run: every number is finite, no field is missing, and each belongs to the right contact.

use std::fs;

use asperity_base::Error;
use asperity_base::error::Error::{AtPass, AtUpdate, NotFinite};
use asperity_base::grid::{Field, Grid};
use asperity_contact::material::Material;
use asperity_contact::motion::{
    Changes, ContactCells, Law, LoadControl, Motion, Pair, Simulation, Slide, SlidingContact, State, Strategy,
};
use asperity_contact::operator::Boundary;
use asperity_contact::solver::{Control, Params};
use asperity_study::io::fields::Attribute;
use asperity_study::{Outcome, cap_name, pressure_name};
use asperity_surface::Form;

use crate::support::{at_rest, field, most, parsed, run};

// ---- numbers that are not finite -------------------------------------------------------------------------

/// A law that corrupts one cell of the upper body, or of its state, in its n-th call.
struct Spoil {
    field: &'static str,
    value: f64,
    after: std::sync::atomic::AtomicUsize,
}

impl Law for Spoil {
    fn name(&self) -> &str {
        "spoil"
    }

    fn prepare(&mut self, pair: &mut Pair) {
        let state = State { unit: "m".to_owned(), values: Field::zeros(pair.upper.heights.raw_dim()) };
        pair.upper.state.insert("kept".to_owned(), state);
    }

    fn repeats(&self) -> bool {
        false
    }

    fn add(&self, _: &Pair, _: &ContactCells, _: &mut [Vec<Field>; 2]) {}

    fn advance(&self, pair: &mut Pair, _: &[Vec<Field>; 2], _: f64) -> [Field; 2] {
        let mut depths = [&pair.lower, &pair.upper].map(|body| Field::zeros(body.heights.raw_dim()));
        if self.after.fetch_sub(1, std::sync::atomic::Ordering::Relaxed) == 1 {
            match self.field {
                "upper" => depths[1][[2, 3]] = self.value,
                _ => pair.upper.state.get_mut("kept").unwrap().values[[2, 3]] = self.value,
            }
        }
        depths
    }
}

fn ball() -> Pair {
    let grid = Grid::new([8, 6], [1e-6; 2]).unwrap();
    let steel = Material::new(210e9, 0.3, f64::INFINITY).unwrap();
    let [flat, ball] = [Form::Flat, Form::Sphere { radius: 1e-4 }].map(|form| form.on(&grid).unwrap());
    Pair::new(flat, ball.underside(), [&steel, &steel]).unwrap()
}

#[test]
fn no_pass_and_no_update_that_is_no_number_is_handed_on() {
    for (field, value) in [("upper", f64::NAN), ("upper", f64::INFINITY), ("kept_upper", f64::NAN)] {
        let law = |calls: usize| Spoil { field, value, after: calls.into() };
        let motion = Motion::new(Strategy::Overlap, Control::Load(1e-3))
            .with_passes(3)
            .with_stride(4)
            .with_load_control(LoadControl::Step);
        let simulation = Simulation::new(ball(), Boundary::FREE, motion, Params::default()).unwrap();
        let mut simulation = simulation.with_changes(Changes::by(law(2))).unwrap();
        let error = simulation.run(&(), &mut []).unwrap_err();
        let AtPass { pass: 2, source } = &error else { panic!("{error:?}") };
        let NotFinite { field: found, cell } = &**source else { panic!("{error:?}") };
        assert_eq!((found.as_str(), &cell[..]), (field, &[2, 3][..]));
        assert_eq!(error.to_string(), format!("pass 2: `{field}` is not a finite number in cell [2, 3]"));
        assert!(error.hint().unwrap().contains("unit"));

        let slide = Slide::to(vec![1e-3, 2e-3, 3e-3], Control::Load(1e-3));
        let contact = SlidingContact::new(ball(), Boundary::FREE, slide, Params::default()).unwrap();
        let error = contact.with_changes(Changes::by(law(3))).unwrap().run(None, &(), &mut []).unwrap_err();
        let AtUpdate { update: 3, source } = &error else { panic!("{error:?}") };
        assert!(matches!(&**source, NotFinite { field: found, .. } if found == field), "{error:?}");
    }
}

/// A film that grows without bound: the largest accepted growth leaves it at its largest thickness.
#[test]
fn a_film_that_grows_without_bound_stays_at_its_thickest() {
    let film = "film = { law = \"arrhenius\", max_thickness = \"10 nm\", rate = 1e9, at_temperature = 200, at_stress = 0, \
                activation_energy = 1e-17, activation_volume = 1e-18, removal = 1e9 }";
    let text = format!(
        "{SLIDING}wear = {{ coefficient = 1e-16, under_film = 1e-17 }}\n{film}\n{BALL}updates = 3\nspeed = 1e-9\n[temperature]\nbulk = 9e4\n"
    );
    let rest = at_rest(&parsed(&text));
    let [film, pressure] = ["film_lower", "pressure"].map(|name| field(&rest, name));
    let thickest = most(film);
    assert!((thickest / 10e-9 - 1.0).abs() < 1e-6, "{thickest:e}");
    assert!(film.iter().all(|f| (0.0..=10e-9 * (1.0 + 1e-9)).contains(f)));
    assert!(pressure.iter().any(|p| *p > 0.0));
}

/// A ball that slides in place; wear, film and constants of the lower body follow, then the ball.
const SLIDING: &str = "[lower]\nyoung = \"210 GPa\"\npoisson = 0.3\n\
    topography = { form = \"flat\", shape = [16, 16], pitch = \"1 um\" }\n";
const BALL: &str = "[upper]\nyoung = \"210 GPa\"\npoisson = 0.3\ntopography = { form = \"sphere\", radius = \"1 mm\" }\n\
    [contact]\nload = \"10 mN\"\n[sliding]\ndistance = \"10 mm\"\n";

// ---- films -----------------------------------------------------------------------------------------------

/// A mechano-chemical film is not removed before it has grown, and its growth is in the ledger.
#[test]
fn what_a_film_loses_has_grown_and_its_volume_is_that_of_its_thickness() {
    for x in [1e-13, 3e-11] {
        let film = format!(
            "film = {{ law = \"mechano-chemical\", max_thickness = 1e-7, x = {x:e}, c3 = 3e-8, c4 = 1000 }}"
        );
        let text = format!("{SLIDING}{film}\n{BALL}speed = 1\nupdates = 4\n[temperature]\nbulk = 373.15\n");
        let rest = at_rest(&parsed(&text));
        let [film, lower] = ["film_lower", "lower"].map(|name| field(&rest, name));
        assert!(film.iter().all(|f| *f >= 0.0), "{film}");
        let [volume, rise] = [film, lower].map(|field| 1e-12 * field.sum());
        let lost = rest.updates.last().unwrap().lost("film")[0];
        assert!((volume + lost).abs() <= 1e-12 * volume, "{volume:e}, {lost:e}");
        assert!((rise - volume).abs() <= 1e-9 * volume, "{rise:e}, {volume:e}");
        assert_eq!(volume > 0.0, x > 1e-12, "{volume:e}");
    }
}

/// Bodies softened by a film, in passes.
const SOFTENED: &str = r#"
[lower]
young = "210 GPa"
poisson = 0.3
hardness = "1.3 GPa"
topography = { generate = "self-affine", shape = [16, 8], pitch = "1 um", sq = "30 nm", hurst = 0.8, seed = 1 }
[lower.film]
law = "arrhenius"
max_thickness = "1 nm"
rate = "1 m/s"
at_temperature = "100 °C"
at_stress = "1 GPa"
activation_energy = "0.8 eV"
activation_volume = "3.8e-3 nm3"
hardness = "0.9 GPa"
[upper]
young = "210 GPa"
poisson = 0.3
topography = { generate = "self-affine", sq = "30 nm", hurst = 0.8, seed = 2 }
[contact]
load = "5 mN"
[motion]
passes = 2
stride = 5
speed = 1
[temperature]
bulk = "100 °C"
[output]
pressure_every = 1
"#;

#[test]
fn caps_are_those_of_the_contact_that_they_stand_beside() {
    let folder = tempfile::tempdir().unwrap();
    let (_, results) = run(&parsed(SOFTENED), &folder.path().join("moved"));
    for (pass, hardness) in [(1, 1.3e9), (2, 0.9e9)] {
        let fields = results.fields_after(pass).unwrap();
        let mut most = 0.0_f64;
        for step in results.steps().unwrap().iter().filter(|step| step.pass == pass) {
            let [p, cap] = [pressure_name(step.step), cap_name(step.step)]
                .map(|name| fields.read(&name).unwrap().into_field().unwrap());
            let share = p.iter().zip(&cap).map(|(p, cap)| p / cap).fold(0.0, f64::max);
            assert!(share <= 1.0 + 1e-9, "pass {pass}, position {}: p is {share} of the cap", step.step);
            most = most.max(share);
        }
        assert!(most > 1.0 - 1e-9, "pass {pass}: no cell yields");
        for name in ["hardness", "cap"] {
            let attribute = fields.attributes().unwrap()[name].clone();
            let Attribute::Number(found) = attribute else { panic!("{attribute:?}") };
            assert!((found / hardness - 1.0).abs() < 1e-9, "pass {pass}: {name} {found:e}");
        }
    }
    let place = SOFTENED.split("[motion]").next().unwrap().replace(
        "[upper]",
        "[sliding]\ndistance = \"1 mm\"\nupdates = 2\nspeed = 1\n[temperature]\nbulk = 400\n[upper]",
    );
    let rest = at_rest(&parsed(&place));
    let least = field(&rest, "cap").iter().copied().fold(f64::INFINITY, f64::min);
    assert!((least / 0.9e9 - 1.0).abs() < 1e-6, "{least:e}");
    assert_eq!(rest.fields.hardness, least);
}

// ---- tables ----------------------------------------------------------------------------------------------

/// Two bodies that do not touch.
const APART: &str = r#"
[lower]
young = "210 GPa"
poisson = 0.3
topography = { form = "flat", shape = [8, 8], pitch = "1 um" }
[upper]
young = "210 GPa"
poisson = 0.3
hardness = "1.4 GPa"
topography = { form = "sphere", radius = "60 um" }
[contact]
approach = "-3 nm"
[friction]
coefficient = 0.1
"#;

/// Unknown numbers are empty cells in tables and `null` in the summary; forces without contact are 0, never
/// −0.
#[test]
fn a_number_that_is_not_known_is_an_empty_cell_that_reads_back() {
    let folder = tempfile::tempdir().unwrap();
    let wear = APART.replace("[contact]", "wear = { coefficient = 1e-16 }\n[contact]");
    let moved = "coupling = \"none\"\n[motion]\npasses = 2\nstride = 3\n";
    for (name, text, empty) in [
        ("motion", format!("{APART}{moved}"), &["friction_coefficient"][..]),
        ("worn", format!("{wear}{moved}speed = 1\n"), &["friction_coefficient", "max_flash_temperature"]),
        (
            "place",
            format!("{wear}coupling = \"none\"\n[sliding]\ndistance = \"1 mm\"\nupdates = 2\n"),
            &["time", "friction_power", "max_temperature"],
        ),
        ("rest", format!("{APART}sliding = [-1, 0]\n"), &[]),
        ("rolls", format!("{APART}creepage = 1e-3\n"), &[]),
        (
            "sweep",
            APART
                .replace("approach = \"-3 nm\"", "approaches = [\"-3 nm\", \"-1 nm\"]")
                .replace("[friction]\ncoefficient = 0.1\n", ""),
            &[],
        ),
    ] {
        let directory = folder.path().join(name);
        let (summary, results) = run(&parsed(&text), &directory);
        let json = fs::read_to_string(directory.join("summary.json")).unwrap();
        assert!(!json.contains("-0.0"), "{name}: {json}");
        let mut found = Vec::new();
        for file in ["steps", "passes", "updates", "increments", "sweep"] {
            let Ok(table) = fs::read_to_string(directory.join(format!("{file}.csv"))) else { continue };
            let columns: Vec<&str> = table.lines().next().unwrap().split(',').collect();
            for row in table.lines().skip(1) {
                for (column, cell) in columns.iter().zip(row.split(',')) {
                    let number = cell.is_empty() || cell.parse::<f64>().is_ok_and(f64::is_finite);
                    assert!(number && !cell.starts_with("-0.0"), "{name}: {file}.csv: {column} is {cell}");
                    if cell.is_empty() && !found.iter().any(|known| known == column) {
                        found.push((*column).to_owned());
                    }
                }
            }
        }
        assert_eq!(found, empty, "{name}");
        // The output can be read back, from tables and from the summary.
        results.steps().unwrap();
        results.increments().unwrap();
        assert_eq!(results.sweep().unwrap().len(), if name == "sweep" { 2 } else { 0 });
        let passes = results.passes().unwrap();
        if let (Outcome::Passes(of_summary), Outcome::Passes(again)) =
            (&summary.outcome, &results.summary().unwrap().outcome)
        {
            assert_eq!(format!("{of_summary:?}"), format!("{passes:?}"), "{name}");
            assert_eq!(format!("{again:?}"), format!("{passes:?}"), "{name}");
            assert!(passes.iter().all(|pass| pass.friction_coefficient.is_nan()));
            let runs_in = passes[0].running.is_some_and(|running| running.max_flash_temperature.is_nan());
            assert_eq!(runs_in, name == "worn");
        }
        let updates = results.updates().unwrap();
        assert!(updates.iter().all(|update| update.time.is_nan() && update.max_temperature.is_nan()));
    }
}

/// Positions without contact have a temperature field like all others, without values.
#[test]
fn each_position_has_the_fields_that_others_have() {
    let folder = tempfile::tempdir().unwrap();
    let heated = "conductivity = 46\nheat_capacity = 460\ndensity = 7850\n";
    let rough = |seed: usize| {
        format!(
            "topography = {{ generate = \"low-pass\", shape = [24, 8], pitch = \"1 um\", sq = \"100 nm\", cutoff = \"6 um\", seed = {seed} }}\n"
        )
    };
    let body = "young = \"210 GPa\"\npoisson = 0.3\n";
    let text = format!(
        "[lower]\n{body}{heated}{}[upper]\n{body}{heated}{}[contact]\nload = \"20 mN\"\n[friction]\ncoefficient = 0.1\n\
         [motion]\nspeed = 1\n[temperature]\nbulk = [373.15, 350]\n[output]\npressure_every = 1\n",
        rough(1),
        rough(2)
    );
    let (_, results) = run(&parsed(&text), &folder.path().join("moved"));
    let fields = results.fields_after(1).unwrap();
    let mut apart = 0;
    for step in results.steps().unwrap() {
        let field = fields.read(&asperity_study::temperature_name(step.step)).unwrap().into_field().unwrap();
        let pressure = fields.read(&pressure_name(step.step)).unwrap().into_field().unwrap();
        assert!(field.iter().zip(&pressure).all(|(t, p)| t.is_nan() == (*p == 0.0)), "{}", step.step);
        if pressure.sum() == 0.0 {
            apart += 1;
            assert_eq!(step.heat.unwrap().max_flash_temperature, 373.15);
        }
    }
    assert!(apart > 0, "all positions touch");
    let place = text
        .replace("load = \"20 mN\"", "approach = \"-10 um\"")
        .replace("coefficient = 0.1\n", "coefficient = 0.1\ncoupling = \"none\"\n")
        .replace("[motion]\nspeed = 1\n", "[sliding]\ndistance = 1e-3\nupdates = 1\nspeed = 1\n")
        .replace("[output]\npressure_every = 1\n", "")
        .replacen("poisson = 0.3\n", "poisson = 0.3\nwear = { coefficient = 1e-16 }\n", 1);
    let rest = at_rest(&parsed(&place));
    assert!(field(&rest, "temperature").iter().all(|t| t.is_nan()));
    assert!(matches!(rest.outcome, Outcome::Static(_)));
}

/// Errors of this check also describe the fault to programs.
#[test]
fn an_error_of_the_guard_names_field_cell_and_step() {
    let inner = || Box::new(Error::NotFinite { field: "film_lower".to_owned(), cell: vec![0, 7] });
    for (error, said) in [
        (Error::AtPass { pass: 3, source: inner() }, "pass 3: "),
        (Error::AtUpdate { update: 4, source: inner() }, "update 4: "),
        (Error::AtIncrement { increment: 5, source: inner() }, "increment 5: "),
        (Error::AtPoint { point: 6, points: 7, source: inner() }, "point 6 of 7: "),
    ] {
        assert_eq!(error.to_string(), format!("{said}`film_lower` is not a finite number in cell [0, 7]"));
        assert!(error.hint().is_some(), "{error}");
    }
    let number = Error::NotFinite { field: "approach".to_owned(), cell: Vec::new() };
    assert_eq!(number.to_string(), "`approach` is not a finite number");
}
