//! Runs that are stopped and go on, or begin from the surfaces of a pass, for each kind of course and of
//! state.

use std::collections::BTreeMap;
use std::fs;
use std::path::Path;

use asperity_base::Error;
use asperity_contact::motion::Watch;
use asperity_study::io::fields::Fields;
use asperity_study::{Case, Existing, Outcome, Results, Summary, SurfaceInput};
use tempfile::TempDir;

use crate::support::{StopAfter, on_threads, parsed, parsed_in, run};

// ---- stopped and gone on ---------------------------------------------------------------------------------

/// A run that was not stopped, in a folder of its own.
pub(crate) struct Whole {
    pub(crate) summary: Summary,
    pub(crate) results: Results,
    _folder: TempDir,
}

/// Runs a case on one thread without a stop, and on two threads with stops after some or all of its steps,
/// which leaves the same files.
///
/// After each stop the case goes on by a step. Then its tables and its state become those of the stop again,
/// as if it had been killed after the state of the step was written and before its rows were. It goes on from
/// there to its end, and once more from its end.
#[track_caller]
pub(crate) fn goes_on(case: &Case) -> Whole {
    let folder = tempfile::tempdir().unwrap();
    let run = |name: &str, existing, watch: &dyn Watch| {
        asperity_study::run(case, SurfaceInput::default(), &folder.path().join(name), existing, watch)
    };
    let count = StopAfter::steps(usize::MAX);
    let (summary, writer) = on_threads(1, || run("whole", Existing::Keep, &count)).unwrap();
    let whole = bits(&folder.path().join("whole"));
    let steps = count.solved();
    let stops: Vec<usize> =
        if steps < 10 { (1..steps).collect() } else { [1, 3, 5].map(|sixth| sixth * steps / 6).to_vec() };
    for stop in &stops {
        let name = format!("stopped after {stop}");
        let out = folder.path().join(&name);
        let until = |existing, steps| on_threads(2, || run(&name, existing, &StopAfter::steps(steps)));
        let stopped = until(Existing::Keep, *stop);
        assert!(matches!(stopped, Err(Error::Interrupted)), "{stop} of {steps}: {:?}", stopped.err());
        let left = files(&out);
        for table in ["increments.csv", "sweep.csv", "updates.csv"] {
            let rows = left.get(table).map(|table| table.iter().filter(|byte| **byte == b'\n').count() - 1);
            assert!(rows.is_none_or(|rows| rows == *stop), "{stop} of {steps}: {rows:?} rows in {table}");
        }
        if let Err(error) = until(Existing::Resume, 1) {
            assert!(matches!(error, Error::Interrupted), "{stop} of {steps}: {error:?}");
            left.iter().for_each(|(name, bytes)| fs::write(out.join(name), bytes).unwrap());
        }
        drop(until(Existing::Resume, usize::MAX).unwrap());
        assert_same(&bits(&out), &whole, &format!("{stop} of {steps}"));
    }
    drop(on_threads(2, || run("again", Existing::Keep, &())).unwrap());
    assert_same(&bits(&folder.path().join("again")), &whole, "on two threads");
    drop(run("again", Existing::Resume, &()).unwrap());
    assert_same(&bits(&folder.path().join("again")), &whole, "from its end");
    Whole { summary, results: writer.results().clone(), _folder: folder }
}

/// All files of a directory and of its folders, by their paths in it.
fn files(directory: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut files = BTreeMap::new();
    for entry in fs::read_dir(directory).unwrap() {
        let path = entry.unwrap().path();
        let name = path.file_name().unwrap().to_str().unwrap().to_owned();
        if path.is_dir() {
            let within = self::files(&path).into_iter();
            files.extend(within.map(|(file, bytes)| (format!("{name}/{file}"), bytes)));
        } else if !name.starts_with('.') {
            files.insert(name, fs::read(&path).unwrap());
        }
    }
    files
}

/// All files of a directory without the times in them.
fn bits(directory: &Path) -> BTreeMap<String, Vec<u8>> {
    let mut files = files(directory);
    let mut lines = |name: &str, untimed: fn(&str) -> Option<&str>| {
        let Some(bytes) = files.get_mut(name) else { return };
        let text = String::from_utf8(std::mem::take(bytes)).unwrap();
        *bytes = text.lines().filter_map(untimed).collect::<Vec<_>>().join("\n").into_bytes();
    };
    lines("passes.csv", |row| row.rsplit_once(',').map(|(row, _)| row));
    lines("summary.json", |line| (!line.contains("wall_time_s")).then_some(line));
    files
}

#[track_caller]
fn assert_same(found: &BTreeMap<String, Vec<u8>>, expected: &BTreeMap<String, Vec<u8>>, when: &str) {
    assert!(found.keys().eq(expected.keys()), "{when}: {:?}, expected {:?}", found.keys(), expected.keys());
    let is_other = |name: &&String| found[*name] != expected[*name];
    let differ: Vec<_> = found.keys().filter(is_other).collect();
    assert!(differ.is_empty(), "{when}: {differ:?} differ");
}

/// One test for each course, with what shows that it has the state it is about.
macro_rules! courses {
    ($($name:ident: $text:expr, $shows:expr;)*) => {
        $(#[test]
        fn $name() {
            let whole = goes_on(&parsed(&$text));
            let shows: fn(&Whole) -> bool = $shows;
            assert!(shows(&whole), "{:?}", whole.summary);
        })*
    };
}

courses! {
    a_load_at_each_position: moving(3, STEP_LOAD), yields;
    flattening_at_each_position: moving(3, AT_EACH_POSITION), yields;
    flattening_at_each_position_under_friction:
        moving(3, &format!("{STEP_LOAD}, {AT_EACH_POSITION}")) + "friction = { coefficient = 0.3 }\n",
        yields;
    a_shift_with_junctions_that_grow:
        moving(3, SHIFT) + "friction = { coefficient = 0.3, junction_growth = 9.0 }\n",
        yields;
    dissimilar_bodies_that_slide:
        moving(2, "stride = 4").replace("4 GPa", "2 GPa").replacen("210 GPa", "70 GPa", 1)
            + "friction = { coefficient = 0.3 }\n",
        yields;
    stress_below_the_surfaces_and_volumes_for_paraview:
        moving(2, "stride = 4").replace("every = 4", "every = 4, paraview = true")
            + "subsurface = { to = \"6 um\", layers = 6, step = 9, planes = [\"1 um\"] }\n",
        |whole| whole.summary.subsurface.len() == 2;
    rubber_in_a_shift:
        rubber_in_passes(&format!("{SHIFT}, {STEP_LOAD}, stride = 2"), "periodic"),
        has_drag;
    rubber_that_is_passed_over_with_pauses:
        rubber_in_passes("speed = 1, pause = \"1 us\", stride = 4", "free"),
        has_drag;
    plastic_strain_below_what_wears_warms_up_and_breaks_out:
        flowing(&format!("{FLOWS}, {PITS}"), HEAT, "", &format!("{VOLUME}fatigue = {{ to = \"12 um\" }}\n")),
        wears_and_warms_up;
    plastic_strain_below_what_wears_under_a_hardness:
        flowing(FLOWS, &format!("{HEAT}, hardness = \"3 GPa\""), "", VOLUME),
        wears_and_warms_up;
    flattening_at_each_position_beside_wear_and_heat:
        flowing(&format!("{HEAT}, {WEARS}, hardness = \"3 GPa\""), HEAT, ", plastic_update = \"step\"", ""),
        wears_and_warms_up;
    films_between_columns: films_in_passes(ROUND, "stride = 2"), films_grow;
    films_on_ways_there_and_back:
        films_in_passes(ROUND, "path = \"reciprocating\", stride = 3"),
        films_grow;
    films_against_a_fresh_body_that_is_offset:
        films_in_passes(ROUND, "offset_y = \"random\", seed = 4, counter = \"fresh\", stride = 4"),
        films_grow;
    films_on_a_line_that_is_offset: films_in_passes(OVER, "stride = 4, offset_y = 5"), films_grow;
    films_on_a_line_against_a_fresh_body_there_and_back:
        films_in_passes(OVER, "stride = 4, counter = \"fresh\", path = \"reciprocating\""),
        films_grow;
    passes_that_stand_for_others:
        moving(60, "strategy = \"shift\", speed_upper = 1.0, stride = 8").replace("poisson = 0.3", WORN_ROUGH)
            + "acceleration = { max_wear = \"20 nm\" }\n",
        |whole| whole.results.passes().unwrap().iter().any(|pass| pass.represents() > 1);
    stages_with_friction: format!("{BODIES}{PUSHED}"), |whole| stages(whole) == [1, 1, 2, 2, 3, 3, 4, 4];
    stages_without_friction: format!("{BODIES}{PRESSED}"), |whole| stages(whole) == [1, 2, 2, 2, 3, 3];
    a_sweep_of_approaches:
        small("", "contact = { approaches = { from = \"1 nm\", to = \"20 nm\", points = 3 } }"),
        is_sweep;
    a_sweep_of_bodies_that_attract_each_other:
        small("", "contact = { loads = [\"1 mN\", \"5 mN\"] }\n[adhesion]\nwork = \"50 mJ/m2\"\nrange = \"grid\""),
        is_sweep;
    rubber_in_stages:
        small(RUBBER, "contact = { load = \"2 mN\" }\n[[history]]\nload = \"4 mN\"\nduration = \"5 ms\"\n\
                       [[history]]\ndwell = \"20 ms\""),
        |whole| whole.results.increments().unwrap().iter().all(|row| row.creep.is_some());
}

// ---- the courses -----------------------------------------------------------------------------------------

const STEP_LOAD: &str = "control = \"step-load\"";
const AT_EACH_POSITION: &str = "plastic_update = \"step\"";
const SHIFT: &str = "strategy = \"shift\", speed_lower = 0.0, speed_upper = 1.0";
const WORN_ROUGH: &str = "poisson = 0.3, wear = { coefficient = \"1e-6 mm3/(N m)\" }";

/// Two rough steel surfaces of 32 × 32 cells that yield a little.
fn moving(passes: usize, keys: &str) -> String {
    let stride = if keys.contains("stride") { "" } else { "stride = 4, " };
    let body = |name: &str, seed: usize| {
        format!(
            "{name} = {{ young = \"210 GPa\", poisson = 0.3, hardness = \"4 GPa\", topography = {{ \
             generate = \"low-pass\", shape = [32, 32], pitch = \"1 um\", sq = \"35 nm\", cutoff = \"8 um\", \
             seed = {seed} }} }}\n"
        )
    };
    format!(
        "{}{}contact = {{ load = \"10 mN\" }}\n\
         motion = {{ passes = {passes}, load_tolerance = 1e-6, {stride}{keys} }}\noutput = {{ pressure_every = 4 }}\n",
        body("lower", 1),
        body("upper", 2)
    )
}

fn yields(whole: &Whole) -> bool {
    whole.results.passes().unwrap()[0].lost("plastic")[0] > 0.0
}

fn rubber_in_passes(keys: &str, boundary: &str) -> String {
    format!(
        r#"
lower = {{ young = "1 MPa", poisson = 0.5, viscoelastic = {{ moduli = ["9 MPa"], times = ["10 us"] }}, topography = {{ form = "flat" }} }}
upper = {{ young = "inf", poisson = 0.3, topography = {{ generate = "low-pass", shape = [24, 24], pitch = "1 um", sq = "0.2 um", cutoff = "8 um" }} }}
contact = {{ mean_pressure = "50 kPa", boundary = "{boundary}" }}
motion = {{ passes = 3, {keys} }}
"#
    )
}

fn has_drag(whole: &Whole) -> bool {
    whole.results.passes().unwrap()[2].drag.unwrap().drag_coefficient > 1e-3
}

const HEAT: &str =
    "conductivity = \"46 W/(m K)\", heat_capacity = \"460 J/(kg K)\", density = \"7850 kg/m3\"";
const WEARS: &str = "wear = { coefficient = 1e-14 }";
const FLOWS: &str = "conductivity = \"46 W/(m K)\", heat_capacity = \"460 J/(kg K)\", density = \"7850 kg/m3\", \
     wear = { coefficient = 1e-14 }, plasticity = { yield_stress = \"1.5 GPa\" }";
const PITS: &str = "fatigue = { torsion = \"80 MPa\", tension = \"110 MPa\", pit_depth = \"6 um\" }";
const VOLUME: &str = "plasticity = { depth = \"40 um\", layers = 6 }\n";

/// A ball that slides on a body with these further keys, and has some itself.
fn flowing(lower: &str, upper: &str, keys: &str, tables: &str) -> String {
    format!(
        r#"
lower = {{ young = "210 GPa", poisson = 0.3, {lower}, topography = {{ form = "flat", shape = [24, 12], pitch = "5 um" }} }}
upper = {{ young = "210 GPa", poisson = 0.3, {upper}, topography = {{ form = "sphere", radius = "0.5 mm" }} }}
contact = {{ load = "5 N", boundary = "periodic" }}
friction = {{ coefficient = 0.1 }}
temperature = {{ bulk = "20 °C" }}
motion = {{ strategy = "shift", passes = 3, stride = 3, speed_upper = "1 m/s"{keys} }}
{tables}"#
    )
}

fn wears_and_warms_up(whole: &Whole) -> bool {
    let running = whole.results.passes().unwrap()[2].running.unwrap();
    running.max_flash_temperature > 300.0 && running.laws.deepest_wear_lower > 1e-9
}

const ROUND: &str = "strategy = \"shift\", speed_lower = 0.3, speed_upper = 1";
const OVER: &str = "speed = 1";

/// Rough bodies that wear and grow films, and whose relative positions are those of this motion.
fn films_in_passes(course: &str, keys: &str) -> String {
    let body = |name: &str, hardness: &str, wear: &str, of_film: &str, seed: usize| {
        format!(
            r#"{name} = {{ young = "210 GPa", poisson = 0.3, {hardness}wear = {{ coefficient = "{wear} mm3/(N m)" }}, film = {{ law = "arrhenius", max_thickness = "20 nm", rate = "1 mm/s", at_temperature = "100 °C", at_stress = "1 GPa", activation_energy = "0.8 eV", activation_volume = "3.8e-3 nm3"{of_film} }}, topography = {{ generate = "self-affine", shape = [14, 12], pitch = "1 um", sq = "20 nm", hurst = 0.8, seed = {seed} }} }}"#
        )
    };
    let lower = body("lower", "hardness = \"4 GPa\", ", "2e-6", ", hardness = \"3 GPa\"", 1);
    let upper = body("upper", "", "1e-6", "", 2);
    let boundary = if course == OVER { "[\"free\", \"periodic\"]" } else { "\"periodic\"" };
    format!(
        "{lower}\n{upper}\ncontact = {{ load = \"0.04 N\", boundary = {boundary} }}\ntemperature = {{ bulk = \"100 °C\" }}\n\
         motion = {{ passes = 5, {course}, {keys} }}\noutput = {{ paraview = true }}\n"
    )
}

/// Whether films grow, while the wear of a body that is replaced in each pass does not add up.
fn films_grow(whole: &Whole) -> bool {
    let states = |pass: usize| whole.results.states_after(pass).unwrap();
    let film = &states(5)[0][asperity_contact::film::FILM].values;
    let volume = |pass: usize| states(pass)[1]["wear"].values.sum();
    let heights = |pass: usize| whole.results.surfaces_after(pass).unwrap()[1].heights().clone();
    let furthest = (heights(1) - heights(5)).fold(0.0f64, |most, off| most.max(off.abs()));
    let is_fresh = whole.summary.case["motion"]["counter"] == "fresh";
    let is_worn = (volume(5) > 3.0 * volume(1)) != is_fresh && (furthest > 40e-9) == is_fresh;
    film.iter().any(|film| *film > 0.0) && is_worn
}

pub(crate) const BODIES: &str = "
[lower]
young = \"210 GPa\"
poisson = 0.3
hardness = \"0.6 GPa\"
topography = { form = \"flat\", shape = [24, 22], pitch = \"1 um\" }
[upper]
young = \"70 GPa\"
poisson = 0.25
[upper.topography]
form = \"sphere\"
radius = \"1 mm\"
shape = [24, 22]
pitch = \"1 um\"
plus = [{ generate = \"self-affine\", seed = 3, sq = \"20 nm\", hurst = 0.8, shortest = \"4 um\" }]
";

const PUSHED: &str = "
[contact]
load = \"50 mN\"
[friction]
coefficient = 0.3
junction_growth = 9
increments = 2
[[history]]
load = \"0.1 N\"
force = [\"10 mN\", \"-5 mN\"]
increments = 2
[[history]]
load = \"30 mN\"
force = \"0 N\"
increments = 2
[[history]]
approach = \"60 nm\"
displacement = \"10 nm\"
increments = 2
";

pub(crate) const PRESSED: &str = "
[contact]
mean_pressure = \"0.1 GPa\"
[[history]]
load = \"10 mN\"
increments = 3
[[history]]
approach = \"80 nm\"
increments = 2
";

fn stages(whole: &Whole) -> Vec<usize> {
    whole.results.increments().unwrap().iter().map(|row| row.stage).collect()
}

const RUBBER: &str = "viscoelastic = { moduli = [\"9 MPa\", \"90 MPa\"], times = [\"10 ms\", \"0.2 ms\"] }, ";

/// A small ball on a body with these further keys.
fn small(lower: &str, tables: &str) -> String {
    format!(
        r#"
lower = {{ young = "1 MPa", poisson = 0.5, {lower}topography = {{ form = "flat", shape = [16, 16], pitch = "10 um" }} }}
upper = {{ young = "1 GPa", poisson = 0.3, topography = {{ form = "sphere", radius = "5 mm" }} }}
{tables}
"#
    )
}

fn is_sweep(whole: &Whole) -> bool {
    matches!(&whole.summary.outcome, Outcome::Sweep(points) if points.len() > 1)
}

// ---- from the surfaces of a pass -------------------------------------------------------------------------

#[test]
fn a_run_from_the_surfaces_of_a_pass_does_what_the_next_pass_did() {
    for keys in ["stride = 4", SHIFT] {
        let motion = moving(3, keys).replace("10 mN", "20 mN").replace("1e-6", "1e-9");
        let folder = tempfile::tempdir().unwrap();
        let (_, whole) = run(&parsed(&motion), &folder.path().join("whole"));
        // The body's material stays; its surface is that of the results.
        let mut next = motion.replace("passes = 3", "passes = 1");
        for name in ["lower", "upper"] {
            let start = next.find(&format!("{name} = {{")).unwrap();
            let start = start + next[start..].find("topography = {").unwrap();
            let end = start + next[start..].find("} }").unwrap();
            let source =
                format!("topography = {{ file = \"whole/fields/pass-0002.h5\", channel = \"{name}\" ");
            next.replace_range(start..end, &source);
        }
        let (_, next) = run(&parsed_in(&next, folder.path()), &folder.path().join("next"));
        let [found, expected] = [&next, &whole].map(|results| results.passes().unwrap().pop().unwrap());
        for (found, expected) in [
            (found.approach, expected.approach),
            (found.mean_load, expected.mean_load),
            (found.mean_contact_area, expected.mean_contact_area),
            (found.max_pressure, expected.max_pressure),
        ] {
            // Both are solved to η < 10⁻⁶, from different guesses.
            assert!((found / expected - 1.0).abs() < 1e-5, "{found} is not {expected}");
        }
        let fields = |results: &Results, pass: usize| {
            Fields::open(&results.directory().join(format!("fields/pass-{pass:04}.h5"))).unwrap()
        };
        let (whole, next) = (fields(&whole, 3), fields(&next, 1));
        for name in ["lower", "upper"] {
            let [found, expected] = [&next, &whole].map(|fields| fields.read(name).unwrap().values);
            for (found, expected) in found.iter().zip(&expected) {
                assert!((found - expected).abs() < 1e-13, "{name}: {found:e} is not {expected:e}");
            }
        }
    }
}

// ---- changed rows ----------------------------------------------------------------------------------------

#[test]
fn what_was_interrupted_goes_on_from_the_rows_it_has_written_and_from_no_others() {
    let body = |form: &str, more: &str| {
        format!(
            "young = 210e9\npoisson = 0.3\ntopography = {{ form = {form}, shape = [12, 12], pitch = 1e-6 }}\n{more}"
        )
    };
    let ball = |more: &str, tables: &str| {
        let (plane, ball) = (body("\"flat\"", ""), body("\"sphere\", radius = 5e-5", more));
        format!("[lower]\n{plane}[upper]\n{ball}{tables}")
    };
    for (case, table) in [
        (
            ball("", "[contact]\nload = 5e-3\n[friction]\ncoefficient = 0.3\nforce = 1e-3\nincrements = 4\n"),
            "increments.csv",
        ),
        (
            ball(
                "",
                "[contact]\nload = 5e-3\n[friction]\ncoefficient = 0.3\nforce = 1e-3\nincrements = 4\ncoupling = \"none\"\n\
                 [adhesion]\nwork = 0.1\nrange = \"grid\"\n",
            ),
            "increments.csv",
        ),
        (
            ball(
                "wear = { coefficient = 1e-13 }\n",
                "[contact]\nload = 5e-3\n[friction]\ncoefficient = 0.1\n[sliding]\ndistance = 0.01\nupdates = 4\n",
            ),
            "updates.csv",
        ),
        (ball("", "[contact]\nloads = [1e-3, 2e-3, 5e-3]\n"), "sweep.csv"),
    ] {
        let folder = tempfile::tempdir().unwrap();
        let out = folder.path().join("out");
        let case = parsed(&case);
        let run = |existing: Existing, watch: &dyn Watch| {
            asperity_study::run(&case, SurfaceInput::default(), &out, existing, watch).map(drop)
        };
        let stopped = run(Existing::Keep, &StopAfter::steps(2));
        assert!(matches!(stopped, Err(Error::Interrupted)), "{table}: {stopped:?}");
        let path = out.join(table);
        let text = fs::read_to_string(&path).unwrap();
        let mut lines: Vec<String> = text.lines().map(str::to_owned).collect();
        let (row, _) = lines[1].rsplit_once(',').unwrap();
        lines[1] = format!("{row},0.125");
        fs::write(&path, lines.join("\n") + "\n").unwrap();
        let refused = run(Existing::Resume, &()).unwrap_err();
        assert!(
            matches!(&refused, Error::NotResumable { path: named, .. } if *named == path),
            "{table}: {refused:?}"
        );
        assert!(refused.to_string().ends_with("has been changed since it was written"), "{refused}");
        fs::write(&path, text).unwrap();
        run(Existing::Resume, &()).unwrap();
    }
}
