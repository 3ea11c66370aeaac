//! Fatigue over the cycles of a loading: fretting, and loads that repeat.

use std::collections::BTreeMap;

use asperity_base::Field;
use asperity_contact::fatigue::{DangVan, Fatigue, FatigueRecord, OnBody};
use asperity_contact::reference::{HertzSphere, SlidingSphere};
use asperity_contact::stress::Stress;
use asperity_contact::subsurface::{Subsurface, Tractions};
use asperity_contact::with::Capability;
use asperity_study::StaticResult;

use crate::resume::{Whole, goes_on};
use crate::support::{at_rest, field, most, parsed, run, written};

/// Rough bodies under a load and a tangential force, both with limits; `upper` has further keys of the upper
/// body.
fn rough(limits: &str, upper: &str, boundary: &str, tables: &str) -> String {
    format!(
        r#"
[lower]
young = "210 GPa"
poisson = 0.3
topography = {{ generate = "low-pass", shape = [14, 12], pitch = "1 um", sq = "40 nm", cutoff = "6 um", seed = 4 }}
fatigue = {{ torsion = "350 MPa", tension = "600 MPa"{limits} }}
[upper]
young = "70 GPa"
poisson = 0.2
topography = {{ form = "flat" }}
fatigue = {{ torsion = "200 MPa", tension = "300 MPa" }}
{upper}
[contact]
load = "12 mN"
boundary = "{boundary}"
tolerance = 1e-11
[friction]
coefficient = 0.4
force = ["2 mN", "1 mN"]
[fatigue]
to = "4 um"
layers = 3
{tables}
"#
    )
}

/// The same bodies without fatigue.
fn plain(text: &str) -> String {
    let is_kept = |line: &&str| {
        !["fatigue =", "[fatigue]", "to =", "layers ="].iter().any(|start| line.starts_with(start))
    };
    text.lines().filter(is_kept).collect::<Vec<_>>().join("\n")
}

fn solved(text: &str) -> StaticResult {
    at_rest(&parsed(text))
}

fn tractions(result: &StaticResult) -> Tractions {
    let field = |name: &str| field(result, name).clone();
    Tractions {
        pressure: field("pressure"),
        shear: ["traction_x", "traction_y"].map(|name| Some(field(name))),
    }
}

#[test]
fn a_cycle_is_that_of_the_stresses_of_its_increments_one_by_one() {
    // A stage on the way from 12 to 20 mN and from (2, 1) to (-4, 3) mN, so many thirds of it.
    let way = |thirds: usize, increments: usize, cycles: &str| {
        let at = |from: f64, to: f64| from + (to - from) * thirds as f64 / 3.0;
        let (load, x, y) = (at(12.0, 20.0), at(2.0, -4.0), at(1.0, 3.0));
        format!(
            "[[history]]\nload = {load:?}e-3\nforce = [{x:?}e-3, {y:?}e-3]\nincrements = {increments}\n{cycles}\n"
        )
    };
    for boundary in ["free", "periodic"] {
        let text = |ways: &str| rough("", "", boundary, ways);
        let cyclic = solved(&text(&way(3, 3, "cycles = 1")));
        let mut ways = vec![String::new()];
        ways.extend((1..=3).map(|there| way(there, there, "")));
        ways.extend((1..=3).map(|back| way(3, 3, "") + &way(3 - back, back, "")));
        let contacts: Vec<Tractions> =
            ways.iter().map(|ways| tractions(&solved(&plain(&text(ways))))).collect();
        let case = parsed(&text(&way(3, 3, "cycles = 1")));
        let depths = case.with.fatigue.as_ref().unwrap().depths([1e-6; 2], 0.0);
        let bodies = [("lower", 0.3, DangVan::new(350e6, 600e6)), ("upper", 0.2, DangVan::new(200e6, 300e6))];
        for (body, poisson, criterion) in bodies {
            let criterion = criterion.unwrap();
            for (k, depth) in depths.iter().enumerate() {
                let plane = |contact: &Tractions| {
                    let on_body = if body == "lower" { contact.clone() } else { contact.clone().on_upper() };
                    Subsurface::new(cyclic.fields.grid, case.contact.boundary, poisson, &on_body)
                        .plane(*depth)
                };
                let planes: Vec<_> = contacts.iter().map(plane).collect();
                let found = field(&cyclic, &format!("over_limit_{:02}_{body}", k + 1));
                for ((i, j), found) in found.indexed_iter() {
                    let history: Vec<Stress> = planes.iter().map(|plane| plane.stress([i, j])).collect();
                    let expected = criterion.evaluate(&history)[0] / criterion.limit();
                    assert!((found - expected).abs() < 1e-8, "{boundary} {body} {depth}: {found} {expected}");
                }
            }
        }
        let largest = most(field(&cyclic, "over_limit_01_lower"));
        assert!(largest > 0.1, "{largest}");
    }
}

/// A ball on a flat body of the same material without Poisson's effect, whose contact is 1.3 times narrower
/// than the grid of `cells`.
fn ball(cells: usize, load: &str, tables: &str) -> String {
    let (radius, pitch) = (5e-3, 2.6 * HERTZ.contact_radius() / cells as f64);
    format!(
        r#"
[lower]
young = "200 GPa"
poisson = 0
topography = {{ form = "flat", shape = [{cells}, {cells}], pitch = {pitch:e} }}
fatigue = {{ torsion = "300 MPa", tension = "500 MPa" }}
[upper]
young = "200 GPa"
poisson = 0
topography = {{ form = "sphere", radius = {radius:e} }}
[contact]
load = {load}
tolerance = 1e-9
[fatigue]
to = {:e}
layers = 2
{tables}
"#,
        0.4 * HERTZ.contact_radius()
    )
}

const HERTZ: HertzSphere = HertzSphere { radius: 5e-3, modulus: 100e9, load: 10.0 };

#[test]
fn partial_slip_fatigues_the_trailing_edges_as_cattaneo_and_mindlin_have_it() {
    let reach = 3.0;
    // Shear of the whole contact under full slip, less that of a circle, in parts.
    let shear = |load: f64, part: f64, place: [f64; 2], depth: f64| {
        let normal = HertzSphere { load, ..HERTZ };
        let at = |friction: f64| SlidingSphere { normal, friction, poisson: 0.0 }.stress(place, depth);
        part * (at(0.5) + -1.0 * at(0.0))
    };
    let slip = |tangential: f64, part: f64, place: [f64; 2], depth: f64| {
        let left = HERTZ.load * (1.0 - tangential / (0.5 * HERTZ.load));
        shear(HERTZ.load, part, place, depth) + shear(left, -part, place, depth)
    };
    let criterion = DangVan::new(300e6, 500e6).unwrap();
    let of = |cells: usize| {
        let steps = 4;
        let text = ball(
            cells,
            "\"10 N\"",
            &format!(
                "[friction]\ncoefficient = 0.5\nforce = \"3 N\"\n[[history]]\nforce = \"-3 N\"\nincrements = {steps}\ncycles = 1"
            ),
        );
        let result = solved(&text);
        let found = field(&result, "over_limit_02_lower");
        let grid = result.fields.grid;
        let centre = 0.5 * cells as f64 * grid.pitch[0];
        let depth = parsed(&text).with.fatigue.as_ref().unwrap().to;
        let mut worst: f64 = 0.0;
        for ((i, j), found) in found.indexed_iter() {
            let place = [grid.centre(0, i) - centre, grid.centre(1, j) - centre];
            let pressed = SlidingSphere { normal: HERTZ, friction: 0.0, poisson: 0.0 }.stress(place, depth);
            // From +Q to −Q, and back: the mirror image.
            let history: Vec<Stress> = [1.0, -1.0]
                .into_iter()
                .flat_map(|sign| (0..=steps).map(move |step| (sign, reach * step as f64 / steps as f64)))
                .map(|(sign, half)| {
                    pressed + sign * (slip(reach, 1.0, place, depth) + slip(half, -2.0, place, depth))
                })
                .collect();
            worst = worst.max((found - criterion.evaluate(&history)[0] / criterion.limit()).abs());
        }
        // The largest of all is at the edge, where the shallowest stress is.
        let row = &result.found.fatigue[0];
        let away = (row.x - centre).hypot(row.y - centre) / HERTZ.contact_radius();
        assert!((row.x - centre).abs() > 0.8 * (row.y - centre).abs(), "{row:?}");
        assert!(row.depth < 0.51 * grid.pitch[0] && (0.8..1.1).contains(&away), "{cells}: {away}");
        worst / most(found)
    };
    let [coarse, fine] = [16, 32].map(of);
    assert!(fine < 0.01 && coarse / fine > 2.0, "{coarse:e} {fine:e}");
}

#[test]
fn a_load_that_comes_and_goes_has_half_the_range_of_the_shear() {
    let of = |cells: usize| {
        let text = ball(cells, "\"1 nN\"", "[[history]]\nload = \"10 N\"\nincrements = 2\ncycles = 2");
        let result = solved(&text);
        let depth = parsed(&text).with.fatigue.as_ref().unwrap().to;
        // From 0 to the largest shear ½(σr − σz): the ball has a radius of half the way, and there is no
        // pressure at 0.
        let [radial, axial] = HERTZ.axis_stress(depth, 0.0);
        let expected = 0.25 * (radial - axial) / DangVan::new(300e6, 500e6).unwrap().limit();
        (field(&result, "over_limit_02_lower")[[cells / 2, cells / 2]] / expected - 1.0).abs()
    };
    let [coarse, fine] = [17, 35].map(of);
    assert!(fine < 2e-3 && coarse / fine > 2.0, "{coarse:e} {fine:e}");
}

#[test]
fn a_cycle_in_which_nothing_changes_has_the_hydrostatic_stress_alone() {
    let text = rough("", "", "periodic", "[[history]]\nload = \"12 mN\"\ncycles = 2");
    let result = solved(&text);
    let case = parsed(&text);
    let criterion = DangVan::new(350e6, 600e6).unwrap();
    for (k, depth) in case.with.fatigue.as_ref().unwrap().depths([1e-6; 2], 0.0).into_iter().enumerate() {
        let subsurface = Subsurface::new(result.fields.grid, case.contact.boundary, 0.3, &tractions(&result));
        let plane = subsurface.plane(depth);
        for ((i, j), found) in field(&result, &format!("over_limit_{:02}_lower", k + 1)).indexed_iter() {
            let stress = plane.stress([i, j]);
            let mean = criterion.weight() * (stress.xx + stress.yy + stress.zz) / 3.0 / criterion.limit();
            assert!((found - mean).abs() < 1e-7, "{found} {mean}");
        }
    }
}

/// Two stages with cycles and one without, over which the upper body wears.
const STAGES: &str = r#"
acceleration = { max_wear = "50 nm", tolerance = 5, max_jump = 40 }
[[history]]
force = ["-4 mN", "1 mN"]
increments = 2
cycles = 150
[[history]]
load = "16 mN"
[[history]]
force = ["4 mN", "1 mN"]
increments = 2
cycles = 60
"#;

const WEARS: &str = r#"wear = { coefficient = "4e-6 mm3/(N m)" }"#;

/// [`STAGES`] with a table at the top.
fn staged(limits: &str, upper: &str) -> String {
    let (acceleration, stages) = STAGES.trim_start().split_once('\n').unwrap();
    format!("{acceleration}\n{}", rough(limits, upper, "periodic", stages))
}

#[test]
fn damage_over_cycles_that_are_not_computed_is_the_sum_between_those_that_are() {
    let folder = tempfile::tempdir().unwrap();
    let text = staged("", WEARS).replace("to = \"4 um\"\nlayers = 3", "to = \"0.5 um\"");
    let (_, results) = run(&parsed(&text), folder.path());
    let rows = results.rows::<Fatigue>().unwrap();
    let rows: Vec<_> = rows.iter().filter(|row| row.body == OnBody::Lower).collect();
    let law = parsed(&text).lower.properties.fatigue.unwrap().damage().unwrap();
    let mut damage = Field::zeros([14, 12]);
    let mut before: Option<(f64, Field)> = None;
    let mut stage = None;
    let mut done = 0;
    for row in &rows {
        if row.stage != stage {
            (stage, before) = (row.stage, None);
        }
        let read = |name: &str| {
            let fields = results.observed_fields("fatigue", row.step).unwrap();
            fields.read(name).unwrap().into_field().unwrap()
        };
        let each = read("over_limit_lower").mapv(|over| law.damage(over));
        let cycles = (row.cycle.unwrap() - done) as f64;
        if let Some((jump, then)) = &before {
            damage = damage + (&each - then) * (0.5 * (jump - 1.0));
        }
        damage.scaled_add(cycles, &each);
        let error = most(&(&damage - &read("damage_lower")).mapv(f64::abs));
        assert!(error < 1e-9 * most(&damage), "{row:?}: {error}");
        (before, done) = (Some((cycles, each)), row.cycle.unwrap());
    }
    let ends: BTreeMap<_, _> = rows.iter().map(|row| (row.stage.unwrap(), row.cycle.unwrap())).collect();
    assert!(ends == BTreeMap::from([(2, 150), (4, 210)]) && rows.len() < 60, "{ends:?} {}", rows.len());
    let life = |row: &FatigueRecord| row.cycle.unwrap() as f64 + (1.0 - row.damage) / row.damage_of_pass;
    assert!(rows.iter().all(|row| (row.life.unwrap() / life(row) - 1.0).abs() < 1e-3 && row.pass.is_none()));
}

#[test]
fn what_fails_breaks_out_of_worn_bodies_and_cycles_go_on_with_the_same_bits() {
    let upper = format!("{WEARS}\n[lower.wear]\ncoefficient = \"1e-7 mm3/(N m)\"");
    let text = staged(", cycles = 100, exponent = 3, pit_depth = \"1 um\"", &upper);
    let text = text.replace("350 MPa", "35 MPa").replace("600 MPa", "60 MPa");
    let Whole { results, .. } = &goes_on(&parsed(&text));
    let rows = results.rows::<Fatigue>().unwrap();
    let read = |name: &str| written(results, name);
    let flat = solved(&plain(&rough("", "", "periodic", "")));
    let lost = field(&flat, "lower") - read("lower") - read("wear_lower") - read("pitted_lower");
    let [lost, pitted] = [most(&lost.mapv(f64::abs)), most(&read("pitted_lower"))];
    assert!(lost < 1e-15 && pitted > 1e-7, "{lost:e} {pitted:e} {:?}", rows.last());
    let share = rows.iter().rfind(|row| row.body == OnBody::Lower).unwrap().pitted_share.unwrap();
    assert!(share > 0.0 && share < 1.0, "{share}");
    let answers = Fatigue::answers(parsed(&text).with.fatigue.as_ref().unwrap(), &rows);
    assert!(answers[0].sentence.contains("has pitted"), "{}", answers[0].sentence);
}
