//! Conductance and flow of the contacts of every course.

use asperity_base::{Field, Grid};
use asperity_contact::conductance::{self, ConductanceRecord, Joint, Kind};
use asperity_contact::flow::{self, Along, Ends, FlowRecord, Fluid, Leakage, Settings, Sides};
use asperity_contact::operator::{Boundary, FreeFft, Operator, PeriodicFft};
use asperity_contact::solver::Params;
use asperity_contact::with::{Capability, Listed};
use asperity_study::{Case, Results};
use asperity_surface::Axis;

use crate::resume::goes_on;
use crate::support::{at_rest, field, parsed, run, written};

const PASSAGE: &str = "
[conductance]
film = \"2e-8 m2 K/W\"
gas = \"0.026 W/(m K)\"
jump = \"0.3 um\"
drop = \"10 K\"

[flow]
viscosity = \"80 mPa s\"
pressure = \"1 bar\"
";

/// The fluid of this `[flow]`.
const OIL: Fluid = Fluid { viscosity: 0.08, drop: 1e5, outlet: None };

/// Two rough bodies under this `[contact]`, with further tables and keys of the lower body.
fn case(lower: &str, contact: &str, more: &str) -> Case {
    parsed(&format!(
        "[lower]
young = \"210 GPa\"
poisson = 0.3
conductivity = \"46 W/(m K)\"
topography = {{ generate = \"self-affine\", hurst = 0.8, sq = \"0.2 um\", shape = [24, 20], pitch = \"1 um\", seed = 3 }}
{lower}
[upper]
young = \"210 GPa\"
poisson = 0.3
conductivity = \"20 W/(m K)\"
topography = {{ generate = \"self-affine\", hurst = 0.8, sq = \"0.2 um\", shape = [24, 20], pitch = \"1 um\", seed = 4 }}
[contact]
{contact}
{more}
{PASSAGE}"
    ))
}

/// A course with its name, its case, and the number of contacts that are observed.
fn courses() -> Vec<(&'static str, Case, usize)> {
    let free = "load = \"0.05 N\"";
    let periodic = "load = \"0.05 N\"\nboundary = \"periodic\"";
    let wear = "wear = { coefficient = \"1e-6 mm3/(N m)\" }";
    vec![
        ("pressed", case("hardness = \"6 GPa\"", free, ""), 1),
        ("periodic", case("", periodic, ""), 1),
        ("swept", case("", "loads = [\"0.01 N\", \"0.05 N\", \"0.2 N\"]\nboundary = \"periodic\"", ""), 3),
        ("loaded", case("hardness = \"6 GPa\"", free, "[[history]]\nload = \"0.02 N\"\nincrements = 3"), 4),
        ("rubbed", case("", free, "[friction]\ncoefficient = 0.3\nforce = \"5 mN\"\nincrements = 2"), 2),
        ("worn", case(wear, free, "[sliding]\ndistance = \"1 mm\"\nupdates = 4"), 5),
        (
            "plastic",
            case(
                "plasticity = { yield_stress = \"1 GPa\" }",
                free,
                "[plasticity]\ndepth = \"6 um\"\nlayers = 6\nincrements = 2\nunload = true",
            ),
            2,
        ),
        ("overlap", case(wear, free, "[motion]\nspeed = \"1 m/s\"\nstride = 7\npasses = 2"), 2 * 7),
        (
            "to and fro",
            case("", free, "[motion]\nspeed = \"1 m/s\"\nstride = 12\npasses = 2\npath = \"reciprocating\""),
            0,
        ),
        (
            "shift",
            case(
                "hardness = \"3 GPa\"",
                periodic,
                "[motion]\nstrategy = \"shift\"\nstride = 8\npasses = 2\nplastic_update = \"step\"\nspeed_upper = \"1 m/s\"",
            ),
            2 * 3,
        ),
    ]
}

/// The conductance of a contact with a film and gas, without the program around it.
fn conducts(grid: Grid, boundary: Boundary, pressure: &Field, gap: &Field) -> f64 {
    let composite = conductance::composite_conductivity(46.0, 20.0).unwrap();
    let mut operator: Box<dyn Operator> = match boundary {
        Boundary::PERIODIC => Box::new(PeriodicFft::new(grid, composite)),
        _ => Box::new(FreeFft::new(grid, composite)),
    };
    let joint = Joint::new(Kind::Thermal).with_film(2e-8).with_gas(0.026, 0.3e-6);
    let touching = pressure.mapv(|p| p > 0.0);
    let params = Params::default().with_tolerance(1e-9);
    conductance::solve(operator.as_mut(), &touching, Some(gap), &joint, None, &params)
        .unwrap()
        .conductance
        .unwrap()
}

/// The leakage through a gap along x, 0 where the bodies touch.
fn leaks(grid: Grid, boundary: Boundary, pressure: &Field, gap: &Field) -> f64 {
    let mut open = gap.mapv(|gap| gap.max(0.0));
    open.zip_mut_with(pressure, |gap, p| *gap = if *p > 0.0 { 0.0 } else { *gap });
    let settings = match boundary {
        Boundary::PERIODIC => Settings { along: Along::X, ..Settings::default() },
        _ => {
            Settings { along: Along::X, ends: Ends::Reservoirs, sides: Sides::Closed, ..Settings::default() }
        }
    };
    let found = flow::solve(&open, &grid, &settings).unwrap();
    found.along[0].as_ref().unwrap().leakage(&OIL).unwrap()
}

fn near(one: f64, other: f64, within: f64) -> bool {
    (one - other).abs() <= within * other.abs()
}

#[test]
fn every_course_goes_on_and_says_what_its_contacts_let_through() {
    for (name, case, contacts) in courses() {
        let results = &goes_on(&case).results;
        agrees(name, &case, contacts, results);
        has_one_table(name, &case, results);
    }
}

/// Checks what each contact conducts and leaks.
fn agrees(name: &str, case: &Case, contacts: usize, results: &Results) {
    let rows = results.rows::<Joint>().unwrap();
    let flows = results.rows::<Leakage>().unwrap();
    assert!(rows.len() == contacts || contacts == 0 && !rows.is_empty(), "{name}: {} rows", rows.len());
    assert_eq!(flows.len(), 2 * rows.len(), "{name}");
    for (row, flows) in rows.iter().zip(flows.chunks(2)) {
        let thermal = &row.quantities;
        assert!(thermal.kind == Kind::Thermal && thermal.conductance.unwrap() > 0.0, "{name}: {row:?}");
        assert!((row.spot_share + row.gas_share - 1.0).abs() < 1e-9, "{name}: {row:?}");
        assert!(near(row.power.unwrap(), 10.0 * thermal.conductance.unwrap(), 1e-12));
        // The joint is what is in series with the spreading from the outline of the contact, at every
        // position.
        let area = row.load / row.mean_pressure;
        match (thermal.resistance_full, thermal.joint_conductance) {
            (_, None) => assert_eq!(case.contact.boundary, Boundary::FREE, "{name}"),
            (None, Some(joint)) => {
                assert!(near(thermal.conductance.unwrap() / area, joint, 1e-9), "{name}")
            }
            (Some(full), Some(joint)) if row.load > 0.0 => {
                let series = full + (joint * area).recip();
                assert!(near(thermal.resistance.unwrap(), series, 1e-9), "{name}: {row:?}");
            }
            (Some(_), Some(_)) => {}
        }
        assert!(thermal.joint_conductance.is_some() || row.spots < 2.0, "{name}: {row:?}");
        for (flow, along) in flows.iter().zip([Axis::X, Axis::Y]) {
            assert_eq!((flow.pass, flow.step, flow.along), (row.pass, row.step, along), "{name}");
            assert!(flow.load == row.load && flow.contact_area == row.contact_area, "{name}");
            assert!(
                flow.leakage >= 0.0 && (flow.leakage > 0.0) == (flow.critical_gap > 0.0),
                "{name}: {flow:?}"
            );
        }
    }
    let summary = results.summary().unwrap();
    if case.motion.is_some() {
        let passes: Vec<_> = summary.found.conductance.iter().map(|row| (row.pass, row.step)).collect();
        assert_eq!(passes, [(Some(1), None), (Some(2), None)], "{name}");
        let of_last: Vec<&ConductanceRecord> = rows.iter().filter(|row| row.pass == Some(2)).collect();
        let mean =
            of_last.iter().map(|row| row.quantities.conductance.unwrap()).sum::<f64>() / of_last.len() as f64;
        assert!(near(summary.found.conductance[1].quantities.conductance.unwrap(), mean, 1e-12), "{name}");
        let along_x: Vec<&FlowRecord> =
            flows.iter().filter(|row| row.pass == Some(2) && row.along == Axis::X).collect();
        let mean = along_x.iter().map(|row| row.leakage).sum::<f64>() / along_x.len() as f64;
        assert!(summary.found.flow.len() == 4 && near(summary.found.flow[2].leakage, mean, 1e-12), "{name}");
    } else {
        assert_eq!(summary.found.conductance.first(), rows.last(), "{name}");
        // As by the solvers on the fields that are written.
        let [pressure, gap, flux, rate] =
            ["pressure", "gap", "flux", "flow_x"].map(|name| written(results, name));
        let grid = Grid::new([24, 20], [1e-6; 2]).unwrap();
        let boundary = case.contact.boundary;
        // The last update of a contact that wears is that of the bodies before they wear.
        let within = if name == "worn" { 0.02 } else { 1e-5 };
        let last = rows.last().unwrap();
        let alone = conducts(grid, boundary, &pressure, &gap);
        assert!(near(last.quantities.conductance.unwrap(), alone, within), "{name}: {last:?} {alone}");
        assert!(
            near(grid.cell_area() * flux.sum(), 10.0 * last.quantities.conductance.unwrap(), 1e-5),
            "{name}"
        );
        let flow = &flows[flows.len() - 2];
        let alone = leaks(grid, boundary, &pressure, &gap);
        // A gap to the third power.
        assert!(near(flow.leakage, alone, 10.0 * within), "{name}: {flow:?} {alone}");
        assert_eq!(flow.leakage > 0.0, rate.iter().any(|rate| *rate > 0.0), "{name}");
        assert_eq!(summary.found.flow, FlowRecord::last(&flows), "{name}");
        let in_memory = at_rest(case);
        assert_eq!((&in_memory.found.conductance, &in_memory.found.flow), (&rows, &flows), "{name}");
    }
}

/// Checks that one table has the answers of all capabilities at each step, with their units.
fn has_one_table(name: &str, case: &Case, results: &Results) {
    let text = std::fs::read(results.directory().join("results.csv")).unwrap();
    assert!(text.starts_with("\u{feff}".as_bytes()), "{name}: Excel knows the encoding by this mark");
    let mut table = csv::Reader::from_reader(&text[..]);
    let heads: Vec<String> = table.headers().unwrap().iter().map(str::to_owned).collect();
    let rows: Vec<csv::StringRecord> = table.records().map(Result::unwrap).collect();
    let column = |head: &str| -> Vec<f64> {
        let at = heads.iter().position(|known| known == head);
        let at = at.unwrap_or_else(|| panic!("{name}: no {head} in {heads:?}"));
        rows.iter().filter_map(|row| row[at].parse().ok()).collect()
    };
    let (step, numbers) = match name {
        "pressed" | "periodic" => ("", 1..=1),
        "swept" => ("point", 1..=3),
        "worn" => ("update", 0..=4),
        "loaded" | "plastic" => ("increment", 1..=4),
        "rubbed" => ("increment", 1..=2),
        _ => ("pass", 1..=2),
    };
    assert_eq!(rows.len(), numbers.clone().count(), "{name}");
    if !step.is_empty() {
        assert_eq!(column(step), numbers.map(f64::from).collect::<Vec<_>>(), "{name}");
    }
    let found = match case.motion {
        Some(_) => results.summary().unwrap().found,
        None => results.observations().unwrap(),
    };
    let along = |axis: Axis| found.flow.iter().filter(move |row| row.along == axis).map(|row| row.leakage);
    assert_eq!(column("flow_x_leakage (m³/s)"), along(Axis::X).collect::<Vec<_>>(), "{name}");
    assert_eq!(column("flow_y_leakage (m³/s)"), along(Axis::Y).collect::<Vec<_>>(), "{name}");
    let joints = found.conductance.iter().map(|row| row.quantities.joint_conductance.unwrap());
    assert_eq!(column("thermal_joint_conductance (W/(m² K))"), joints.collect::<Vec<_>>(), "{name}");
    let load = if case.motion.is_some() { "mean_load (N)" } else { "load (N)" };
    assert_eq!(column(load).len(), rows.len(), "{name}");
    // Each number has its unit, and stands there once.
    let distinct: std::collections::BTreeSet<&String> = heads.iter().collect();
    assert_eq!(distinct.len(), heads.len(), "{name}: {heads:?}");
    for head in &heads {
        let (column, unit) =
            head.strip_suffix(')').and_then(|head| head.split_once(" (")).unwrap_or((head, ""));
        let expected = asperity_study::unit_of_column(column).unwrap_or_else(|| panic!("{name}: {head}"));
        assert_eq!(if expected == "1" { "" } else { expected }, unit, "{name}: {head}");
    }
}

#[test]
fn positions_that_are_kept_have_their_fields() {
    let folder = tempfile::tempdir().unwrap();
    let (_, case, _) = courses().into_iter().find(|(name, ..)| *name == "overlap").unwrap();
    let (_, results) = run(&case, folder.path());
    let names = |name: &str| results.observed_fields(name, 2).unwrap().names().unwrap();
    assert_eq!(names("conductance"), ["flux_00001"]);
    assert!(names("flow").contains(&"fluid_pressure_x_00001".to_owned()), "{:?}", names("flow"));
}

#[test]
fn each_axis_has_the_ends_and_sides_of_its_boundary() {
    for [x, y] in [[true, false], [false, true]] {
        let [one, other] = [x, y].map(|periodic| if periodic { "periodic" } else { "free" });
        let case = case("", &format!("load = \"0.05 N\"\nboundary = [\"{one}\", \"{other}\"]"), "");
        let rest = at_rest(&case);
        let gap = ndarray::Zip::from(field(&rest, "gap"))
            .and(field(&rest, "pressure"))
            .map_collect(|gap, p| if *p > 0.0 { 0.0 } else { gap.max(0.0) });
        let grid = Grid::new([24, 20], [1e-6; 2]).unwrap();
        let ends = |periodic| if periodic { Ends::Periodic } else { Ends::Reservoirs };
        let sides = |periodic| if periodic { Sides::Periodic } else { Sides::Closed };
        let settings = [(x, y), (y, x)].map(|(along, across)| (ends(along), sides(across)));
        for (axis, (ends, sides)) in settings.into_iter().enumerate() {
            let along = [Along::X, Along::Y][axis];
            let found =
                flow::solve(&gap, &grid, &Settings { ends, sides, along, ..Settings::default() }).unwrap();
            let alone = found.along[axis].as_ref().unwrap().leakage(&OIL).unwrap();
            let row = &rest.found.flow[axis];
            assert!(alone > 0.0 && near(row.leakage, alone, 1e-9), "{one} {axis}: {row:?} {alone}");
        }
    }
}

#[test]
fn a_gas_has_the_fields_of_its_leakage() {
    let (inlet, outlet) = (5e5, 2e5);
    let mut case = case("", "load = \"0.05 N\"", "");
    let liquid = at_rest(&case);
    let spec = case.with.flow.as_mut().unwrap();
    (spec.gas, spec.outlet, spec.pressure) = (true, Some(outlet), inlet - outlet);
    let gas = at_rest(&case);
    let ratio = gas.found.flow[0].leakage / liquid.found.flow[0].leakage;
    assert!(near(ratio, (inlet * inlet - outlet * outlet) / (2.0 * outlet * 1e5), 1e-12), "{ratio}");
    let rates = ["flow_x", "flow_y"].map(|name| (field(&liquid, name), field(&gas, name)));
    for (liquid, gas) in rates {
        assert!(liquid.iter().zip(gas).all(|(liquid, gas)| (gas - ratio * liquid).abs() <= 1e-12 * gas));
    }
    // The square of the absolute pressure falls as the pressure of a liquid does.
    let (liquid, gas) = (field(&liquid, "fluid_pressure_x"), field(&gas, "fluid_pressure_x"));
    assert!(liquid.iter().any(|p| *p > 0.0 && *p < 1e5));
    for (liquid, gas) in liquid.iter().zip(gas) {
        let square = outlet * outlet + liquid / 1e5 * (inlet * inlet - outlet * outlet);
        assert!(near(gas + outlet, square.sqrt(), 1e-12), "{liquid} {gas}");
    }
}

#[test]
fn a_path_to_and_fro_has_one_flush_position() {
    let folder = tempfile::tempdir().unwrap();
    let motion = "[motion]\nspeed = \"1 m/s\"\nstride = 12\npasses = 2\npath = \"reciprocating\"";
    let mut case = case("", "load = \"0.05 N\"", motion);
    case.with.flow.as_mut().unwrap().every = 0;
    let (_, results) = run(&case, folder.path());
    let seen: Vec<_> =
        results.rows::<Leakage>().unwrap().iter().map(|row| (row.pass, row.step, row.along)).collect();
    let at = |pass| [Axis::X, Axis::Y].map(|along| (Some(pass), seen[0].1, along));
    assert_eq!(seen, [at(1), at(2)].concat());
}

#[test]
fn clean_elastic_bodies_conduct_as_they_are_stiff_and_a_ball_has_no_joint() {
    let folder = tempfile::tempdir().unwrap();
    let steel = "young = \"210 GPa\"\npoisson = 0.3\nconductivity = \"46 W/(m K)\"";
    let rough = "generate = \"self-affine\", hurst = 0.8, sq = \"0.1 um\", shortest = \"4 um\"";
    for (upper, boundary, is_joint) in [
        (rough, "free", true),
        (rough, "periodic", true),
        ("form = \"sphere\", radius = \"60 um\"", "free", false),
        ("form = \"sphere\", radius = \"60 um\"", "periodic", true),
    ] {
        let text = format!(
            "[lower]\n{steel}\ntopography = {{ form = \"flat\", shape = [32, 32], pitch = \"1 um\" }}\n[upper]\n{steel}\n\
             topography = {{ {upper} }}\n[contact]\nloads = [\"10 mN\", \"30 mN\", \"100 mN\"]\nboundary = \"{boundary}\"\n\
             [conductance]\n"
        );
        let case = parsed(&text);
        let (_, results) = run(&case, &folder.path().join(format!("{boundary} {}", upper.len())));
        let rows = results.rows::<Joint>().unwrap();
        for row in &rows {
            let found = &row.quantities;
            assert!(
                near(found.conductance_of_stiffness.unwrap(), found.conductance.unwrap(), 1e-6),
                "{row:?}"
            );
            assert_eq!(found.joint_conductance.is_some(), is_joint, "{upper}: {row:?}");
            assert_eq!(found.resistance_full.is_some(), boundary == "free");
        }
        let [answer] = &Joint::of(&case.with).unwrap().answers(&rows)[..] else { panic!("one answer") };
        assert_eq!(answer.name, if is_joint { "joint conductance" } else { "conductance" });
    }
}
