//! The page of computed results, whatever they are.

use std::collections::BTreeSet;
use std::fs;
use std::path::Path;

use asperity_base::units::format_number_digits;
use asperity_contact::motion::{IncrementRecord, SweepRecord};
use asperity_study::{self, Case, Existing, Results, SurfaceInput};
use serde_json::Value;
use tempfile::TempDir;

use super::*;

/// Two small rough bodies that pass over each other twice.
const MOVING: &str = "\
title = \"two rough bodies\"
lower = { young = 210e9, poisson = 0.3, hardness = 2e9, topography = { generate = \"low-pass\", shape = [16, 16], pitch = 1e-6, sq = 30e-9, cutoff = 4e-6, seed = 1 } }
upper = { young = 210e9, poisson = 0.3, hardness = 4e9, topography = { generate = \"low-pass\", shape = [16, 16], pitch = 1e-6, sq = 30e-9, cutoff = 4e-6, seed = 2 } }
contact = { load = 5e-3 }
motion = { passes = 2, stride = 4 }
output = { pressure_every = 1 }
";

/// A ball on a plane.
const AT_REST: &str = "\
lower = { young = 210e9, poisson = 0.3, topography = { form = \"flat\", shape = [24, 24], pitch = 1e-6 } }
upper = { young = 210e9, poisson = 0.3, topography = { form = \"sphere\", radius = 1e-4, shape = [24, 24], pitch = 1e-6 } }
contact = { load = 5e-3 }
";

/// A ball that leaves a dent in a plane, which flows below its surface.
const FLOWING: &str = "\
lower = { young = 210e9, poisson = 0.3, plasticity = { yield_stress = 1e9 }, topography = { form = \"flat\", shape = [16, 16], pitch = 4e-6 } }
upper = { young = 210e9, poisson = 0.3, topography = { form = \"sphere\", radius = 1e-3, shape = [16, 16], pitch = 4e-6 } }
contact = { load = 5 }
plasticity = { depth = 30e-6, layers = 6, increments = 3 }
";

/// A soft ball that sticks to a plane, and is drawn off it.
const STICKING: &str = "\
lower = { young = 1e9, poisson = 0.4, topography = { form = \"flat\", shape = [24, 24], pitch = 1e-9 } }
upper = { young = \"inf\", poisson = 0.3, topography = { form = \"sphere\", radius = 40e-9, shape = [24, 24], pitch = 1e-9 } }
adhesion = { work = 0.08, range = 0.6e-9 }
contact = { approach = -4e-9 }
history = [{ approach = 0.5e-9, increments = 5 }, { approach = -5e-9, increments = 6 }, { approach = 0.2e-9 }]
";

/// A folder with the results of a case in it.
struct Computed {
    folder: TempDir,
}

impl Computed {
    fn of(text: &str) -> Self {
        let folder = tempfile::tempdir().unwrap();
        let case = Case::parse(text, Path::new("case.toml"), folder.path())
            .unwrap_or_else(|e| panic!("{e} of\n{text}"));
        let directory = folder.path().join("results");
        asperity_study::run(&case, SurfaceInput::default(), &directory, Existing::Keep, &())
            .unwrap_or_else(|e| panic!("{e} of\n{text}"));
        Self { folder }
    }

    fn path(&self, name: &str) -> PathBuf {
        self.folder.path().join("results").join(name)
    }

    fn results(&self) -> Results {
        Results::open(&self.folder.path().join("results")).unwrap()
    }

    fn page(&self) -> String {
        page(&self.results(), None).unwrap().0
    }

    fn data(&self) -> Value {
        let page = self.page();
        let (_, data) = page.split_once("id=\"data\">").unwrap();
        serde_json::from_str(data.split_once("</script>").unwrap().0).unwrap()
    }

    fn summary(&self) -> Value {
        serde_json::from_slice(&fs::read(self.path("summary.json")).unwrap()).unwrap()
    }
}

#[test]
fn every_number_of_the_summary_is_on_the_page() {
    fn look_for(value: &Value, key: &str, page: &str) -> usize {
        match value {
            Value::Object(keys) => {
                keys.iter().map(|(name, v)| look_for(v, &format!("{key}.{name}"), page)).sum()
            }
            Value::Array(all) => {
                all.iter().enumerate().map(|(n, v)| look_for(v, &format!("{key}.{n}"), page)).sum()
            }
            Value::Number(number) => {
                let begin = format!("data-key=\"{key}\" value=\"");
                let at = page.find(&begin).unwrap_or_else(|| panic!("no {key}")) + begin.len();
                let told: f64 = page[at..].split('"').next().unwrap().parse().unwrap();
                assert_eq!(Some(told), number.as_f64(), "{key}");
                1
            }
            _ => 0,
        }
    }
    let rubbed =
        format!("{AT_REST}friction = {{ coefficient = 0.3 }}\nhistory = [{{ force = [1e-3, 0] }}]\n");
    let swept = AT_REST.replace("load = 5e-3", "loads = [1e-3, 2e-3, 5e-3]");
    for (text, key, least) in [
        (MOVING, "passes", 40),
        (AT_REST, "static", 12),
        (&rubbed, "static", 20),
        (&swept, "sweep", 40),
        (STICKING, "static", 17),
        (STICKING, "adhesion", 8),
    ] {
        let computed = Computed::of(text);
        let found = look_for(&computed.summary()[key], key, &computed.page());
        assert!(found >= least, "{found} numbers of {key}");
    }
}

#[test]
fn bodies_that_attract_each_other_have_a_section_with_their_curve() {
    let computed = Computed::of(STICKING);
    let (page, data) = (computed.page(), computed.data());
    assert!(page.contains("<section id=\"adhesion\""), "{page}");
    // The answer is the first sentence and the first card, and its curve stands before the contact.
    assert!(page.contains("<p class=\"verdict\">The bodies come apart at a pull of"));
    assert!(page.contains("<dl class=\"cards\"><div><dt>pull-off force</dt>"));
    assert!(page.find("id=\"adhesion\"") < page.find("id=\"contact\""));
    let charts = data["charts"].as_array().unwrap();
    let named = |name: &str| charts.iter().filter(|chart| chart["name"] == name).count();
    assert_eq!((named("force_distance"), named("loading")), (1, 0));
    let curve = charts.iter().find(|chart| chart["name"] == "force_distance").unwrap();
    assert_eq!(curve["shaded"]["name"], "hysteresis");
    assert_eq!(curve["shaded"]["areas"].as_array().unwrap().len(), 1);
    // The increments that are kept have their place on the curve.
    assert_eq!(data["contact"]["steps"], "increment");
    let frames = data["contact"]["frames"].as_array().unwrap();
    assert!(frames.len() > 1, "{}", frames.len());
    for frame in frames {
        let [distance, load] = [0, 1].map(|axis| frame["mark"][axis].as_f64().unwrap());
        let series = curve["series"].as_array().unwrap();
        let on_it = series.iter().any(|series| {
            let points = series["x"].as_array().unwrap().iter().zip(series["y"].as_array().unwrap());
            points.into_iter().any(|(x, y)| (x.as_f64(), y.as_f64()) == (Some(distance), Some(load)))
        });
        assert!(on_it, "{distance} {load}");
    }
    // The page opens on the pull-off.
    let load = |row: &IncrementRecord| row.load;
    let least = computed.results().increments().unwrap().iter().map(load).fold(f64::INFINITY, f64::min);
    assert_eq!(frames[data["contact"]["begin"].as_u64().unwrap() as usize]["mark"][1], least);
    let layer = &data["contact"]["layers"][0];
    assert_eq!((&layer["name"], &layer["kind"]), (&"pressure".into(), &"diverging".into()));
    let [low, high] = [0, 1].map(|end| layer["ranges"][0][end].as_f64().unwrap());
    assert!(low < 0.0 && low == -high);
    assert!(!Computed::of(AT_REST).page().contains("id=\"adhesion\""));
}

/// The first sentence tells film, load and friction; the maps have the pressures of oil and solids.
#[test]
fn the_page_of_lubricated_bodies_tells_their_film() {
    let oil = "lubrication = { viscosity = 0.04, pressure_viscosity = 2e-8, limiting_stress = 0.05, speed = 0.05 }\n";
    let computed = Computed::of(&(AT_REST.to_owned() + oil));
    let film = computed.results().sweep().unwrap()[0].lubrication.unwrap().film;
    let page = computed.page();
    let words = format!("the traction coefficient is {}", format_number_digits(film.traction_coefficient, 3));
    assert!(page.contains("At 50 mm/s the film is") && page.contains(&words), "{words}");
    assert!(page.contains("id=\"lubrication\"") && page.contains("Film at 50 mm/s"));
    let data = computed.data();
    let layers = data["contact"]["layers"].as_array().unwrap();
    // A map of zeros is left out.
    for (name, is_there) in
        [("oil_pressure", true), ("solid_pressure", film.solid_share > 0.0), ("cavity", true)]
    {
        assert_eq!(layers.iter().any(|layer| layer["name"] == name), is_there, "{name}");
    }
}

/// A sweep opens on its last point, to which the numbers beside the map belong, and one of speeds on that of
/// the largest drag, which is kept.
#[test]
fn a_sweep_opens_on_the_point_that_its_answers_describe() {
    let loads = AT_REST.replace("load = 5e-3", "loads = { from = 1e-3, to = 5e-3, points = 5 }");
    let rubber = "viscoelastic = { moduli = [9e9], times = [1e-3] }, young = 1e9, ";
    let speeds = AT_REST.replacen("young = 210e9, poisson = 0.3, ", &format!("poisson = 0.5, {rubber}"), 1)
        + "steady = { speeds = { from = 1e-4, to = 1, points = 9 } }\n";
    for text in [loads, speeds] {
        let computed = Computed::of(&text);
        let data = computed.data();
        let points = computed.results().sweep().unwrap();
        let drag = |row: &SweepRecord| row.steady.map(|steady| steady.drag_coefficient);
        let answering = match drag(&points[0]) {
            Some(_) => points.iter().max_by(|a, b| drag(a).unwrap().total_cmp(&drag(b).unwrap())).unwrap(),
            None => points.last().unwrap(),
        };
        let kept = BTreeSet::from([1, answering.point, points.len()]);
        assert_eq!(kept.len(), if drag(&points[0]).is_some() { 3 } else { 2 });
        let labels: Vec<String> =
            kept.iter().map(|point| format!("point {point} of {}", points.len())).collect();
        let frames = data["contact"]["frames"].as_array().unwrap();
        assert_eq!(frames.iter().map(|frame| frame["label"].as_str().unwrap()).collect::<Vec<_>>(), labels);
        let begin = &frames[data["contact"]["begin"].as_u64().unwrap() as usize]["label"];
        assert_eq!(begin, &format!("point {} of {}", answering.point, points.len()));
    }
}

#[test]
fn a_page_made_beside_the_figures_is_the_page_of_the_files() {
    let large = "\
        lower = { young = 210e9, poisson = 0.3, hardness = 6e9, topography = { generate = \"self-affine\", shape = [513, 520], \
        pitch = 1e-6, hurst = 0.8, sdq = 0.1, rolloff = 1e-4, shortest = 8e-6, seed = 1 } }\n\
        upper = { young = 210e9, poisson = 0.3, topography = { form = \"flat\" } }\n\
        contact = { mean_pressure = 5e8, boundary = \"periodic\", tolerance = 1e-4 }\n";
    let computed = Computed::of(large);
    let results = computed.results();
    let (wanted, go_on) = (FigureOptions::default(), || false);
    let (sheet, seen) = gathered(&results, &wanted, &go_on);
    assert!(seen.is_some(), "the arrays are seen");
    assert!(page(&results, seen).unwrap() == page(&results, None).unwrap());
    // The same figures, whether a page is made beside them or not.
    let beside =
        sheet.unwrap_or_else(|_| panic!("figures")).pictures().unwrap_or_else(|_| panic!("pictures"));
    assert!(beside == figures::pictures(&results, &wanted).unwrap_or_else(|_| panic!("pictures")));
    assert_eq!(beside.len(), 10);

    // Nothing is seen of a damaged file, and its page names it.
    let path = computed.path("fields.h5");
    let mut bytes = fs::read(&path).unwrap();
    let middle = bytes.len() / 2;
    bytes[middle] ^= 1;
    fs::write(&path, bytes).unwrap();
    let (_, seen) = gathered(&results, &wanted, &go_on);
    assert!(seen.is_none());
    let (_, missing) = page(&results, seen).unwrap();
    assert!(missing.iter().any(|missing| missing.contains("fields.h5")), "{missing:?}");
}

#[test]
fn the_case_on_a_page_of_an_example_is_that_case() {
    let examples = Path::new(env!("CARGO_MANIFEST_DIR")).join("../asperity-cli/examples");
    let mut looked_at = 0;
    for entry in fs::read_dir(&examples).unwrap() {
        let name = entry.unwrap().file_name().into_string().unwrap();
        // As the command writes it: examples share a file.
        let folder = tempfile::tempdir().unwrap();
        let path = folder.path().join("case.toml");
        fs::copy(examples.join(&name).join("case.toml"), &path).unwrap();
        for file in ["measured/disc.x3p", "viscoelastic/master.csv"] {
            let file = examples.join(file);
            fs::copy(&file, folder.path().join(file.file_name().unwrap())).unwrap();
        }
        let case = Case::load(&path).unwrap();
        let resolved = |case: &Case| {
            asperity_study::resolved(case, &asperity_study::bodies(case, SurfaceInput::default()).unwrap())
        };
        let before = resolved(&case);
        let toml = toml::to_string(&case::written(&before)).unwrap();
        let again = Case::parse(&toml, Path::new("case.toml"), Path::new(""))
            .unwrap_or_else(|e| panic!("{e} in\n{toml}"));
        assert_eq!(resolved(&again)["identity"], before["identity"], "{name}");
        looked_at += 1;
    }
    assert!(looked_at >= 6);
}

#[test]
fn nothing_of_a_case_is_markup_and_nothing_is_asked_for() {
    let title = "</script><img src=x onerror=alert(1)>";
    let computed = Computed::of(&MOVING.replace("two rough bodies", title));
    let page = computed.page();
    assert!(!page.contains("<img src=x"), "the title is markup");
    assert!(page.contains("&lt;/script&gt;&lt;img src=x onerror=alert(1)&gt;"));
    for begin in ["=\"http", "='http", "=\"//", "@import", "url("] {
        assert!(!page.contains(begin), "{begin}");
    }
    assert!(page.contains("default-src 'none'"));
    assert!(page.len() < 600_000, "{} bytes", page.len());
}

#[test]
fn the_same_results_make_the_same_page() {
    let computed = Computed::of(MOVING);
    assert!(computed.page() == computed.page());
}

#[test]
fn a_page_shows_what_there_is_and_leaves_out_what_there_is_not() {
    let section = |page: &str, id: &str| page.contains(&format!("<section id=\"{id}\" "));
    let moving = Computed::of(MOVING);
    let page = moving.page();
    assert!(section(&page, "contact") && section(&page, "curves") && !section(&page, "below"));
    let place = |id: &str| page.find(&format!("<section id=\"{id}\" ")).unwrap();
    assert!(
        place("contact") < place("bodies")
            && place("bodies") < place("curves")
            && place("curves") < place("trust")
    );
    assert!(
        page.contains("<dl class=\"cards\">") && page.contains("After 2 passes under a mean load of 5 mN")
    );
    assert!(page.contains("Table: passes") && page.contains("Table: positions of pass 2"));
    let data = moving.data();
    assert_eq!(data["contact"]["frames"].as_array().unwrap().len(), 14, "all positions of both passes");
    assert_eq!(data["contact"]["groups"][1]["changes"].as_array().unwrap().len(), 2);
    let names = |data: &Value, of: &str, key: &str| -> Vec<String> {
        data.pointer(of)
            .unwrap()
            .as_array()
            .unwrap()
            .iter()
            .map(|v| v[key].as_str().unwrap().to_owned())
            .collect()
    };
    assert_eq!(names(&data, "/contact/layers", "name"), ["pressure", "contact"]);
    for chart in ["load", "contact_area", "max_pressure", "roughness", "approach", "pressure_histogram"] {
        assert!(names(&data, "/charts", "name").iter().any(|name| name == chart), "{chart}");
    }

    let rest = Computed::of(&format!(
        "{AT_REST}subsurface = {{ to = 5e-6, layers = 8, columns = [[12e-6, 12e-6]] }}\n"
    ));
    let page = rest.page();
    assert!(section(&page, "contact") && section(&page, "below") && !section(&page, "curves"));
    let data = rest.data();
    assert_eq!(names(&data, "/contact/layers", "name"), ["pressure", "contact", "gap", "displacement"]);
    assert_eq!(data["contact"]["layers"][1]["classes"], serde_json::json!(["no contact", "elastic"]));
    for (chart, is_there) in [("profile", true), ("stress_columns", true), ("material_ratio", false)] {
        assert_eq!(names(&data, "/charts", "name").iter().any(|name| name == chart), is_there, "{chart}");
    }

    let none = Computed::of(&MOVING.replace("pressure_every = 1", "pressure_every = 0"));
    assert!(none.page().contains("<code>pressure_every = 0</code>") && none.data()["contact"].is_null());
}

#[test]
fn a_load_that_is_held_is_not_drawn_and_a_body_that_keeps_its_shape_has_no_change() {
    let held = MOVING.replace("passes = 2", "passes = 2, control = \"step-load\"");
    let data = Computed::of(&held).data();
    let charts: Vec<&str> =
        data["charts"].as_array().unwrap().iter().map(|c| c["name"].as_str().unwrap()).collect();
    assert!(!charts.contains(&"load") && charts.contains(&"contact_area"), "{charts:?}");
    // The upper body is the harder one.
    assert!(!data["bodies"][0]["change"].is_null() && data["bodies"][1]["change"].is_null());
    let change = &data["bodies"][0]["change"];
    assert!(change["low"].as_f64().unwrap() < 0.0 && change["high"].as_f64().unwrap() <= 0.0);
}

#[test]
fn what_flows_below_a_surface_is_shown_under_the_load_and_without_it() {
    let computed = Computed::of(FLOWING);
    let (page, data, summary) = (computed.page(), computed.data(), computed.summary());
    assert!(page.contains("<section id=\"plastic\" ") && page.contains("<th scope=\"col\">unloaded</th>"));
    assert!(page.contains("unloaded: plastic work") && page.contains("<td>yields</td>"));
    assert_eq!(page.matches("Heights after plastic flow").count(), 1, "the upper body does not flow");
    let planes = data["planes"].as_array().unwrap();
    let files: Vec<&str> = planes.iter().map(|plane| plane["file"].as_str().unwrap()).collect();
    assert_eq!(files, ["plastic_strain_lower", "residual_stress_lower", "residual_surface_lower"]);
    // The section is the one through the largest strain; the dent is as deep as the summary says, but for its
    // rim.
    assert_eq!(planes[0]["map"]["high"], summary["static"]["max_plastic_strain"]);
    let [low, high] = ["low", "high"].map(|end| planes[2]["map"][end].as_f64().unwrap());
    let range = summary["static"]["residual_residual_displacement"].as_f64().unwrap();
    assert!(low < 0.0 && ((high - low) / range - 1.0).abs() < 1e-12, "{low}, {high}, {range}");
    let stress = &planes[1]["range"];
    assert_eq!(stress[0].as_f64().unwrap(), -stress[1].as_f64().unwrap());
    let mut charts =
        data["charts"].as_array().unwrap().iter().filter(|chart| chart["name"] == "plastic_flow");
    let work = charts.next_back().unwrap()["series"][0]["y"].as_array().unwrap().clone();
    let all = summary["static"]["residual_plastic_work"].as_f64().unwrap();
    assert!(work.len() == 6 && (work[5].as_f64().unwrap() / all - 1.0).abs() < 1e-12, "{work:?} of {all}");

    fs::remove_file(computed.path("plasticity.h5")).unwrap();
    let page = computed.page();
    assert!(page.contains("Not on this page") && page.contains("plasticity.h5"), "nothing is missed");
    let elastic = Computed::of(&FLOWING.replace("yield_stress = 1e9", "yield_stress = 1e12"));
    assert!(elastic.page().contains("No plastic flow in this body."));
}

#[test]
fn a_plane_has_no_maps_and_no_number_below_zero() {
    let page = Computed::of(AT_REST).page();
    assert!(page.contains("Flat, 24 µm × 24 µm, at the height 0 m."));
    assert!(!page.contains("−0 ") && !page.contains("-0 m"));
}

#[test]
fn a_run_under_way_says_so_and_what_is_damaged_is_named() {
    let computed = Computed::of(MOVING);
    assert!(!computed.page().contains("under way"));
    fs::remove_file(computed.path("summary.json")).unwrap();
    let page = computed.page();
    assert!(page.contains("2 of 2 passes are there") && page.contains("--resume"), "no banner");

    let fields = computed.path("fields/pass-0001.h5");
    let bytes = fs::read(&fields).unwrap();
    fs::write(&fields, &bytes[..bytes.len() / 2]).unwrap();
    let page = computed.page();
    assert!(page.contains("Not on this page") && page.contains("pass-0001.h5"), "damage goes unnoticed");
    assert_eq!(computed.data()["contact"]["groups"].as_array().unwrap().len(), 1, "the other pass is there");

    fs::remove_file(computed.path("fields/pass-0002.h5")).unwrap();
    let page = computed.page();
    assert!(page.contains("pass-0002.h5") && page.contains("Table: passes"));
    fs::write(computed.path("fields/initial.h5"), b"nothing of it").unwrap();
    assert!(computed.page().contains("initial.h5"));
    // Nothing but a case.
    for name in ["passes.csv", "steps.csv"] {
        fs::remove_file(computed.path(name)).unwrap();
    }
    assert!(computed.page().contains("0 of 2 passes are there"));
}

#[test]
fn the_least_of_contacts_have_a_page() {
    let one_cell = AT_REST.replace("[24, 24]", "[1, 1]").replace("sphere\", radius = 1e-4", "flat\"");
    let rigid = AT_REST.replacen("young = 210e9", "young = inf", 1);
    let apart = AT_REST.replace("load = 5e-3", "approach = -1e-7");
    let flat = MOVING.replace("generate = \"low-pass\"", "form = \"flat\"");
    let flat = flat
        .replace(", sq = 30e-9, cutoff = 4e-6, seed = 1", "")
        .replace(", sq = 30e-9, cutoff = 4e-6, seed = 2", "");
    let narrow = flat.replace("[16, 16]", "[1, 4]");
    let shifted = MOVING.replace("passes = 2", "strategy = \"shift\", speed_upper = 1, passes = 2");
    for text in [&one_cell, &rigid, &apart, &flat, &narrow, &shifted] {
        let computed = Computed::of(text);
        let page = computed.page();
        assert!(page.contains("<section id=\"trust\" ") && !page.contains("Not on this page"), "of\n{text}");
        assert!(!page.contains("NaN</"), "of\n{text}");
    }
}

#[test]
fn beyond_the_budget_positions_are_left_out_evenly() {
    use super::table::evenly;
    let shown = evenly(100, 7);
    assert_eq!((shown[0], shown[6], shown.len()), (0, 99, 7));
    let gaps: Vec<usize> = shown.windows(2).map(|w| w[1] - w[0]).collect();
    assert!(gaps.iter().all(|gap| (16..=17).contains(gap)), "{gaps:?}");
}
