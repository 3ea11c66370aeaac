//! Static contacts loaded stage after stage: what they leave, what is refused and what is told.

use asperity_base::{Error, Grid};
use asperity_study::SurfaceInput;
use asperity_surface::{Form, Topography};

use crate::resume::{BODIES, PRESSED};
use crate::support::{at_rest, foreseen, parsed, parsed_in, run, written};

#[test]
fn a_loading_without_friction_leaves_increments_and_one_gap_with_all_taken_up() {
    let folder = tempfile::tempdir().unwrap();
    let (summary, results) = run(&parsed(&format!("{BODIES}{PRESSED}")), folder.path());
    let rows = results.increments().unwrap();
    assert_eq!(rows.iter().map(|row| row.stage).collect::<Vec<_>>(), [1, 2, 2, 2, 3, 3]);
    assert!(rows.iter().all(|row| row.tangential_force_x == 0.0 && row.stick_area == 0.0));
    let read = |name| written(&results, name);
    let [lower, upper, gap, plastic] = ["lower", "upper", "gap", "plastic"].map(read);
    let asperity_study::Outcome::Static(record) = summary.outcome else { panic!("a static contact") };
    assert!(record.shear.is_none());
    let recomputed = &upper - &lower + &read("displacement") - record.approach;
    assert_eq!(gap, recomputed);
    let apart = &gap + &plastic;
    let scale = read("displacement").std(0.0);
    for (distance, p) in apart.iter().zip(&read("pressure")) {
        assert!(*distance > -1e-5 * scale && (*p == 0.0 || *distance < 1e-5 * scale), "{distance:e}");
    }
    assert!(rows[0].plastic_volume > 0.0 && rows[3].plastic_volume >= rows[0].plastic_volume * (1.0 - 1e-6));
    assert_eq!(rows[5].plastic_volume, record.plastic_volume);
}

/// Each is refused before anything is cleared.
#[test]
fn loads_that_what_slides_does_not_bear_are_refused_beforehand() {
    let sliding =
        "[contact]\nmean_pressure = \"0.5 GPa\"\n[friction]\ncoefficient = 0.5\njunction_growth = 9\n";
    for (text, bears) in [
        (format!("{sliding}sliding = [1, 0]"), false),
        (format!("{sliding}increments = 2"), true),
        (
            format!("{sliding}[[history]]\nsliding = [1, 0]\nmean_pressure = \"0.1 GPa\"\nincrements = 20"),
            false,
        ),
        (format!("{sliding}[[history]]\nsliding = [1, 0]\nmean_pressure = \"0.1 GPa\""), true),
        (format!("{sliding}force = \"0.06 N\""), false),
        (format!("{sliding}[motion]\nstrategy = \"overlap\"\nplastic_update = \"pass\""), false),
        ("[contact]\nload = \"1 mN\"\n[[history]]\nload = \"1 N\"".to_owned(), false),
    ] {
        let case = parsed(&format!("{BODIES}{text}"));
        let bodies = asperity_study::bodies(&case, SurfaceInput::default()).unwrap();
        let found = asperity_study::estimate(&case, &bodies);
        match found {
            Ok(_) => assert!(bears, "{text}"),
            Err(Error::BeyondPlasticLimit { load, limit }) => assert!(!bears && load >= limit, "{text}"),
            Err(other) => panic!("{text}: {other}"),
        }
    }
}

#[test]
fn what_friction_is_not_asked_rightly_is_said_beforehand() {
    const ONE_STEP: &str = "loaded in one step";
    const AT_ONCE: &str = "pressed and pushed in one step";
    const ROUGH: &str = "steady rolling of a rough surface";
    const TRACK: &str = "not flattened before";
    let load = "[contact]\nload = \"50 mN\"\n[friction]\ncoefficient = 0.3\n";
    let light = "[contact]\nload = \"5 mN\"\n[friction]\ncoefficient = 0.3\n";
    let onwards = "[[history]]\nload = \"50 mN\"\nincrements = 20\n";
    let elastic = |text: &str| text.replace("hardness = \"0.6 GPa\"\n", "");
    let smooth =
        |text: &str| text.lines().filter(|line| !line.starts_with("plus")).collect::<Vec<_>>().join("\n");
    let rolling = format!("{BODIES}{load}creepage = 1e-3");
    for (text, said) in [
        (format!("{BODIES}{load}"), vec![ONE_STEP]),
        (format!("{BODIES}{load}coupling = \"none\""), vec![]),
        (format!("{BODIES}{load}increments = 10"), vec![]),
        (format!("{BODIES}{light}{onwards}"), vec![]),
        (format!("{BODIES}{load}").replace("0.3\n", "0.001\n"), vec![]),
        (format!("{BODIES}{load}force = \"1 mN\""), vec![ONE_STEP, AT_ONCE]),
        (format!("{BODIES}{load}increments = 10\nforce = \"1 mN\""), vec![]),
        (format!("{BODIES}{load}sliding = [0, 1]"), vec![]),
        (rolling.clone(), vec![ROUGH]),
        (rolling.replace("0.6 GPa", "0.2 GPa"), vec![ROUGH, TRACK]),
        (elastic(&rolling), vec![ROUGH]),
        (smooth(&rolling), vec![]),
        (smooth(&rolling).replace("0.6 GPa", "0.2 GPa"), vec![TRACK]),
        (smooth(&elastic(&rolling)), vec![]),
        (smooth(&rolling).replace("0.6 GPa", "0.2 GPa").replace("50 mN", "1 uN"), vec![]),
    ] {
        let warnings = foreseen(&parsed(&text)).join("\n");
        for part in [ONE_STEP, AT_ONCE, ROUGH, TRACK] {
            assert_eq!(warnings.contains(part), said.contains(&part), "{part}: {text}\n{warnings}");
        }
    }
}

/// A surface from a file is rough because of its heights, not because it comes from a file.
#[test]
fn what_rolls_from_a_file_is_rough_by_what_it_holds() {
    let folder = tempfile::tempdir().unwrap();
    let text = "[lower]\nyoung = \"210 GPa\"\npoisson = 0.3\nhardness = \"20 GPa\"\ntopography = { form = \"flat\" }\n\
                [upper]\nyoung = \"210 GPa\"\npoisson = 0.3\ntopography = { file = \"ball.npy\", pitch = \"1 um\" }\n\
                [contact]\nload = \"5 mN\"\n[friction]\ncoefficient = 0.3\ncreepage = 1e-3\n";
    let ball = Form::Sphere { radius: 1e-3 }.on(&Grid::new([24, 24], [1e-6; 2]).unwrap()).unwrap();
    let rough = |amplitude: f64| {
        let mut heights = ball.heights().clone();
        heights.indexed_iter_mut().for_each(|((i, j), z)| *z += amplitude * ((i * 7 + j * 5) % 3) as f64);
        Topography::new(*ball.grid(), heights).unwrap()
    };
    for (surface, is_rough) in [(ball.clone(), false), (rough(1e-11), false), (rough(2e-8), true)] {
        surface.write(folder.path().join("ball.npy")).unwrap();
        let warnings = foreseen(&parsed_in(text, folder.path()));
        let said = |part: &str| warnings.iter().any(|warning| warning.contains(part));
        assert_eq!(said("steady rolling of a rough surface"), is_rough, "{warnings:?}");
        assert!(!said("not flattened before"), "{warnings:?}");
    }
}

#[test]
fn what_only_the_answer_shows_is_said_with_it() {
    let folder = tempfile::tempdir().unwrap();
    let warnings =
        |name: &str, text: &str| run(&parsed(text), &folder.path().join(name)).0.warnings.join("\n");
    let contact = "[contact]\nload = \"20 mN\"\n[friction]\ncoefficient = 0.3\nincrements = 2\n";
    let both = |increments: usize| {
        format!(
            "{BODIES}{contact}[[history]]\nload = \"0.1 N\"\nforce = \"20 mN\"\nincrements = {increments}"
        )
    };
    assert!(warnings("coarse", &both(1)).contains("`dissipation` depends on the steps"));
    let fine = both(60).replace("increments = 2", "increments = 30");
    assert!(!warnings("fine", &fine).contains("`dissipation` depends on the steps"));
    // Reported once, whether it is predictable or not.
    let rolling = format!("{BODIES}{}creepage = 1e-3", contact.replace("increments = 2\n", ""));
    let rolling = rolling.replace("0.6 GPa", "0.2 GPa");
    assert_eq!(warnings("rolling", &rolling).matches("not flattened before").count(), 1);
    let slow = rolling
        .replace("sq = \"20 nm\"", "sq = \"5 nm\"")
        .replace("shortest = \"4 um\"", "shortest = \"10 um\"");
    assert_eq!(warnings("slow", &slow).matches("cells yield").count(), 1);
}

// ---- cycles ----------------------------------------------------------------------------------------------

#[test]
fn a_stage_after_cycles_stays_where_they_ended() {
    const FIRST: &str = "[contact]\nload = \"20 mN\"\n[friction]\ncoefficient = 0.3\n";
    // Loads and forces along x after the stages from the second one on; the cycles come back to 20 mN, 2 mN.
    let last = |history: &str| {
        let result = at_rest(&parsed(&format!("{BODIES}{FIRST}{history}")));
        let ends = result.increments.chunk_by(|one, next| one.stage == next.stage);
        ends.map(|stage| stage.last().unwrap().clone()).collect::<Vec<_>>()
    };
    let pushes = "[[history]]\nforce = \"2 mN\"\n";
    for (history, quantity) in [
        ("load = \"40 mN\"", "a load"),
        ("approach = \"60 nm\"", "an approach"),
        ("load = \"40 mN\"\nforce = \"6 mN\"", "both"),
        ("displacement = \"3 nm\"", "a displacement"),
        ("mean_pressure = \"100 MPa\"\nforce = \"-1 mN\"", "a pressure"),
    ] {
        let ends = last(&format!(
            "{pushes}[[history]]\n{history}\nincrements = 2\ncycles = 2\n[[history]]\nforce = \"1 mN\"\n[[history]]\napproach = \"50 nm\"\n"
        ));
        let [.., cycles, force, approach] = &ends[..] else { panic!("{quantity}: {} stages", ends.len()) };
        // The bodies have flowed under more than 20 mN, so that the load at an approach is a little less.
        assert!((cycles.load / 20e-3 - 1.0).abs() < 1e-2, "{quantity}: {cycles:?}");
        // The load, or the approach at which it was reached, stays under a new force.
        let stays = (force.load / cycles.load - 1.0).abs() < 1e-3;
        assert!(stays && (force.tangential_force_x / 1e-3 - 1.0).abs() < 1e-6, "{quantity}: {force:?}");
        assert!((approach.tangential_force_x / 1e-3 - 1.0).abs() < 1e-6, "{quantity}: {approach:?}");
        let ends =
            last(&format!("{pushes}[[history]]\n{history}\ncycles = 1\n[[history]]\nload = \"21 mN\"\n"));
        let [.., cycles, load] = &ends[..] else { panic!("{quantity}: {} stages", ends.len()) };
        let [before, after] = [cycles, load].map(|end| {
            let displacement = end.tangential_displacement_x;
            if quantity == "a displacement" { displacement } else { end.tangential_force_x }
        });
        assert!((after / before - 1.0).abs() < 1e-6, "{quantity}: {before:e} {after:e}");
    }
}
