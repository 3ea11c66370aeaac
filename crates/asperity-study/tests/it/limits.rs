//! The limits of the model are compared with results while they come.

use std::path::Path;
use std::sync::Mutex;

use approx::assert_relative_eq;
use asperity_base::error::Error::{AtPass, WornAway};
use asperity_base::grid::Field;
use asperity_base::{Error, Result};
use asperity_contact::motion::{PassRecord, Progress, Watch};
use asperity_study::{Existing, Limit, Passes, Results, SurfaceInput};

use crate::support::parsed;

/// A gear flank, 128 × 64 µm: both bodies move, under 400 MPa, and get hot.
fn flank(wear: &str, friction: f64, passes: usize) -> String {
    let body = |name: &str, grid: &str, seed: u64| {
        format!(
            "[{name}]\nyoung = \"210 GPa\"\npoisson = 0.3\nconductivity = \"46 W/(m K)\"\nheat_capacity = \"460 J/(kg K)\"\n\
             density = \"7850 kg/m3\"\n[{name}.topography]\ngenerate = \"low-pass\"\n{grid}sq = \"50 nm\"\ncutoff = \"64 um\"\n\
             seed = {seed}\n"
        )
    };
    format!(
        "{}[lower.wear]\n{wear}\n{}[contact]\nmean_pressure = \"400 MPa\"\nboundary = \"periodic\"\n[motion]\n\
         strategy = \"shift\"\nspeed_lower = \"3 m/s\"\nspeed_upper = \"5 m/s\"\nstride = 4\npasses = {passes}\n[friction]\n\
         coefficient = {friction}\ncoupling = \"none\"\n[temperature]\nbulk = \"80 °C\"\n",
        body("lower", "shape = [16, 8]\npitch = \"8 um\"\n", 1),
        body("upper", "", 2)
    )
}

/// What a watch was told, in its order.
#[derive(Default)]
struct Log(Mutex<Vec<String>>);

impl Log {
    fn lines(self) -> Vec<String> {
        self.0.into_inner().unwrap()
    }
}

impl Watch for Log {
    fn position(&self, _: &Progress) {}

    fn pass(&self, record: &PassRecord) {
        self.0.lock().unwrap().push(format!("done {}", record.pass));
    }

    fn warning(&self, warning: &str) {
        self.0.lock().unwrap().push(warning.to_owned());
    }

    fn stop(&self) -> bool {
        false
    }
}

fn run(text: &str, folder: &Path, existing: Existing, watch: &dyn Watch) -> Result<Vec<String>> {
    asperity_study::run(&parsed(text), SurfaceInput::default(), folder, existing, watch)
        .map(|(summary, _)| summary.warnings)
}

/// A dimensionless number of Archard where 1/Pa is meant: metres of wear.
#[test]
fn a_pass_that_wears_more_than_the_body_is_long_ends_the_run() {
    for coefficient in [1e-4, 1e-8] {
        let folder = tempfile::tempdir().unwrap();
        let text = flank(&format!("coefficient = {coefficient:e}"), 0.1, 3);
        let error = run(&text, folder.path(), Existing::Keep, &()).unwrap_err();
        let AtPass { pass: 1, source } = &error else { panic!("{error:?}") };
        let WornAway { body: "lower", depth, length } = &**source else { panic!("{error:?}") };
        // The lower body slides two fifths of its length in a pass, under 400 MPa.
        assert_relative_eq!(*depth, coefficient * 400e6 * 0.4 * 128e-6, max_relative = 1e-3);
        assert_relative_eq!(*length, 128e-6, max_relative = 1e-12);
        assert!(error.to_string().starts_with("pass 1: the lower body loses "), "{error}");
    }
}

/// Twenty micrometres in a pass on cells of 8 µm: the pressures at its end have no solution worth searching
/// for.
#[test]
fn a_pass_that_wears_more_than_a_cell_is_wide_ends_the_run_at_once() {
    let folder = tempfile::tempdir().unwrap();
    let error = run(&flank("coefficient = 1e-9", 0.1, 3), folder.path(), Existing::Keep, &()).unwrap_err();
    assert!(
        error.to_string().starts_with("pass 1: a single pass removes more than the width of a cell"),
        "{error}"
    );
}

/// A law of the caller takes 50 µm in each pass off a body of 128 µm.
#[test]
fn finished_passes_are_kept_when_a_body_has_worn_away() {
    let folder = tempfile::tempdir().unwrap();
    let case = parsed(&flank("coefficient = 1e-18", 0.1, 4));
    let worn = |existing| {
        let log = Log::default();
        let mut passes = Passes::enter(&case, SurfaceInput::default(), folder.path(), existing).unwrap();
        let end = loop {
            let mut pass = passes.solve(&log).unwrap().unwrap();
            let number = pass.record().pass as f64;
            let depth = Field::from_elem([16, 8], 50e-6 * number);
            pass.remove("wear", &[depth, Field::zeros([16, 8])]);
            if let Err(error) = passes.finish(pass, &log) {
                break error;
            }
        };
        (end, log.lines())
    };
    let says = |error: &Error| matches!(error, AtPass { pass: 3, source } if matches!(**source, WornAway { body: "lower", .. }));
    let (error, lines) = worn(Existing::Keep);
    assert!(says(&error), "{error:?}");
    assert_eq!([&lines[0], lines.last().unwrap()], ["done 1", "done 2"]);
    assert!(lines[1].starts_with("pass 1: the lower body wears 50 µm deep in one pass"), "{lines:?}");
    let results = Results::open(folder.path()).unwrap();
    assert_eq!((results.passes().unwrap().len(), results.steps().unwrap().len()), (2, 8));
    assert!(results.surfaces_after(2).is_ok() && results.summary().is_err());
    let broken = results.broken_limits().unwrap();
    assert!(
        broken.iter().any(|broken| broken.limit == Limit::Law("wear") && broken.pass == Some(1)),
        "{broken:?}"
    );
    let (error, lines) = worn(Existing::Resume);
    assert!(says(&error) && lines.is_empty(), "{error:?} {lines:?}");
}

#[test]
fn steel_beyond_its_melting_point_is_reported_in_the_first_pass_and_once() {
    let text = |passes| flank("coefficient = 1e-16", 5.0, passes);
    let whole = tempfile::tempdir().unwrap();
    let log = Log::default();
    let warnings = run(&text(3), whole.path(), Existing::Keep, &log).unwrap();
    let lines = log.lines();
    let hot: Vec<_> =
        lines.iter().enumerate().filter(|(_, line)| line.contains("steel melts at 1800 K")).collect();
    let &[(at, line)] = &hot[..] else { panic!("{lines:?}") };
    assert!(line.starts_with("pass 1, position ") && line.contains("the surfaces reach "), "{line}");
    assert!(at < lines.iter().position(|line| line == "done 2").unwrap(), "{lines:?}");
    assert_eq!(warnings.iter().filter(|warning| *warning == line).count(), 1, "{warnings:?}");
    let broken = Results::open(whole.path()).unwrap().broken_limits().unwrap();
    let broken: Vec<_> = broken.iter().filter(|broken| broken.limit == Limit::Temperature).collect();
    assert!(broken.len() == 1 && broken[0].value > 1800.0 && broken[0].bound == 1800.0, "{broken:?}");

    let parts = tempfile::tempdir().unwrap();
    run(&text(1), parts.path(), Existing::Keep, &()).unwrap();
    assert_eq!(run(&text(3), parts.path(), Existing::Resume, &()).unwrap(), warnings);

    let cool = tempfile::tempdir().unwrap();
    let warnings = run(&flank("coefficient = 1e-16", 0.02, 1), cool.path(), Existing::Keep, &()).unwrap();
    assert!(warnings.iter().all(|warning| !warning.contains("melts")), "{warnings:?}");
}

/// Rough steel on a plane, with more keys of the lower body and of its contact.
fn rough(body: &str, contact: &str) -> String {
    format!(
        "[lower]\nyoung = \"210 GPa\"\npoisson = 0.3\n{body}\n[lower.topography]\ngenerate = \"low-pass\"\nshape = [64, 64]\n\
         pitch = \"1 um\"\nsq = \"1 um\"\ncutoff = \"8 um\"\nseed = 1\n[upper]\nyoung = \"inf\"\npoisson = 0\n[upper.topography]\n\
         form = \"flat\"\n[contact]\nboundary = \"periodic\"\n{contact}\n"
    )
}

fn at_rest(text: &str) -> (Vec<String>, Vec<String>) {
    let log = Log::default();
    let warnings =
        asperity_study::static_contact(&parsed(text), SurfaceInput::default(), &log).unwrap().warnings;
    (warnings, log.lines())
}

#[test]
fn no_solid_is_elastic_above_a_tenth_of_its_modulus() {
    for pressure in ["100 MPa", "20 GPa"] {
        let (warnings, at_once) = at_rest(&rough("", &format!("mean_pressure = \"{pressure}\"")));
        let [warning] = &at_once[..] else { panic!("{at_once:?}") };
        let end = "above a tenth of E*, 23.08 GPa, where no solid stays elastic: give a `hardness`, or [plasticity]";
        assert!(warning.starts_with("the largest pressure is ") && warning.ends_with(end), "{warning}");
        assert!(warnings.contains(warning), "{warnings:?}");
    }
    let (_, at_once) = at_rest(&rough("hardness = \"4 GPa\"", "mean_pressure = \"100 MPa\""));
    assert!(at_once.is_empty(), "{at_once:?}");
    // Rubber stays elastic.
    let soft = rough("", "mean_pressure = \"1 kPa\"").replace("210 GPa", "2 MPa");
    let (_, at_once) = at_rest(&soft);
    assert!(at_once.is_empty(), "{at_once:?}");
}

/// A modulus a thousand times too small, of the layer at the surface.
#[test]
fn a_layer_is_not_elastic_above_a_tenth_of_its_modulus() {
    let layered = |young: &str| {
        let layer = format!(
            "hardness = \"4 GPa\"\ncoating = {{ thickness = \"4 um\", young = \"{young}\", poisson = 0.3 }}"
        );
        at_rest(&rough(&layer, "mean_pressure = \"100 MPa\"")).1
    };
    assert!(layered("300 GPa").is_empty());
    let at_once = layered("300 MPa");
    assert!(at_once.iter().any(|warning| warning.contains("above a tenth of E*, 32.97 MPa")), "{at_once:?}");
}

#[test]
fn increments_points_and_updates_name_themselves() {
    let stages = rough("", "mean_pressure = \"100 MPa\"\n[friction]\ncoefficient = 0.1\nincrements = 4");
    let (_, at_once) = at_rest(&stages);
    assert!(at_once.len() == 1 && at_once[0].starts_with("increment 2: the largest pressure"), "{at_once:?}");
    let sweep = rough("", "mean_pressures = [\"1 kPa\", \"100 MPa\", \"200 MPa\"]");
    let (warnings, at_once) = at_rest(&sweep);
    assert!(at_once.len() == 1 && at_once[0].starts_with("point 2: the largest pressure"), "{at_once:?}");
    assert!(warnings.contains(&at_once[0]));
    let film = "hardness = \"4 GPa\"\n[lower.film]\nlaw = \"arrhenius\"\nmax_thickness = \"5 um\"\nrate = \"10 um/s\"\n\
                at_temperature = \"100 °C\"\nat_stress = \"3 GPa\"\nactivation_energy = \"0.8 eV\"\n\
                activation_volume = \"3.8e-3 nm3\"\nstress = \"pressure\"\n";
    let slides = "mean_pressure = \"100 MPa\"\n[sliding]\ndistance = \"1 m\"\nspeed = \"1 m/s\"\nupdates = 4\n[temperature]\n\
                  bulk = \"100 °C\"\nevery = 0";
    let slides = rough(film, slides);
    let (_, at_once) = at_rest(&slides);
    let of_film: Vec<_> =
        at_once.iter().filter(|warning| warning.contains("the film on the lower body is ")).collect();
    assert!(of_film.len() == 1 && of_film[0].starts_with("update "), "{at_once:?}");
}

#[test]
fn bodies_pressed_into_each_other_are_beyond_the_model() {
    let (_, at_once) = at_rest(&rough("hardness = \"10 MPa\"", "approach = \"12 um\""));
    for word in ["% of the cells are at the hardness", "summits are flattened by up to"] {
        assert!(at_once.iter().any(|warning| warning.contains(word)), "{at_once:?}");
    }
    let ball = "[lower]\nyoung = \"2 MPa\"\npoisson = 0.5\n[lower.topography]\nform = \"flat\"\nshape = [32, 32]\n\
                pitch = \"2 um\"\n[upper]\nyoung = \"inf\"\npoisson = 0\n[upper.topography]\nform = \"sphere\"\nradius = \"60 um\"\n\
                [contact]\nboundary = \"free\"\n";
    let pressed = |approach: &str| at_rest(&format!("{ball}approach = \"{approach}\"\n")).1;
    let deep = pressed("7 um");
    assert!(deep.len() == 1 && deep[0].starts_with("cells are displaced by up to 6.98"), "{deep:?}");
    assert_eq!(pressed("6 um"), [""; 0]);
}

/// A law of the caller that carves steep grooves.
#[test]
fn slopes_and_wear_of_a_law_of_the_caller_are_compared_too() {
    let folder = tempfile::tempdir().unwrap();
    let text = flank("coefficient = 1e-18", 0.1, 2);
    let mut passes =
        Passes::enter(&parsed(&text), SurfaceInput::default(), folder.path(), Existing::Keep).unwrap();
    let log = Log::default();
    while let Some(mut pass) = passes.solve(&log).unwrap() {
        let grooves = Field::from_shape_fn([16, 8], |(ix, _)| if ix % 4 < 2 { 20e-6 } else { 0.0 });
        pass.remove("wear", &[grooves, Field::zeros([16, 8])]);
        passes.finish(pass, &log).unwrap();
    }
    let (summary, _) = passes.end().unwrap();
    for word in ["pass 1: the worn surfaces are steep", "pass 1: the lower body wears 10 µm deep in one pass"]
    {
        assert!(summary.warnings.iter().any(|warning| warning.starts_with(word)), "{:?}", summary.warnings);
    }
    assert_eq!(log.lines().iter().filter(|line| line.contains("the worn surfaces are steep")).count(), 1);
}
