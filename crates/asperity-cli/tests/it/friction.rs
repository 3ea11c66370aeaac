//! `asperity run` with friction and with several loads: pushed, rolling, sliding, swept.

use std::fs;

use asperity::material::{Material, composite_modulus};
use asperity::reference::cattaneo::tangential_modulus;
use asperity::reference::{CattaneoMindlin, HertzSphere, MindlinDeresiewicz};
use asperity::study::{INCREMENT_COLUMNS, Results};

use crate::support::{
    BALL, PUSH, field, folder_with, moving, number, promised, pushed, run, summary, table_of,
};
use crate::support::{asperity, assert_has, files, ok};

#[test]
fn a_contact_with_friction_leaves_its_fields_its_increments_and_its_figures() {
    let folder = folder_with("ball.toml", &pushed(PUSH));
    let table = ok(&run(&folder, "ball.toml --out out"));
    assert_has(&table, "tangential force  3 mN,  … traction coeff.   0.15\n");
    assert!(!table.contains("friction coeff."), "{table}");
    let out = folder.path().join("out");
    let expected = promised(
        "fields.h5 increments.csv",
        "contact gap loading material_ratio pressure pressure_histogram profile relief_upper shear slip
         solution spectrum topographies",
    );
    assert_eq!(files(&out), expected);
    let fields = Results::open(&out).unwrap().static_fields().unwrap();
    for (name, unit) in [("traction_x", "Pa"), ("slip_y", "m"), ("stick", "1"), ("displacement_x", "m")] {
        field(&fields, name, unit);
    }

    fs::write(folder.path().join("ball.toml"), BALL).unwrap();
    ok(&run(&folder, "ball.toml --out out --overwrite"));
    let left = files(&out);
    assert!(!left.contains("increments.csv") && !left.contains("figures/shear.png"), "{left:?}");
}

#[test]
fn a_sweep_leaves_a_row_and_figures_of_its_points_and_prints_them() {
    let swept = BALL.replace("load = \"20 mN\"", "loads = { from = \"1 mN\", to = \"40 mN\", points = 4 }");
    let folder = folder_with("ball.toml", &format!("{swept}[output]\npressure_every = 3\nparaview = true\n"));
    let checked = ok(&asperity(&folder, "check ball.toml"));
    assert_has(&checked, "4 points, load 1 mN to 40 mN … none: 4 static contacts");
    let printed = ok(&run(&folder, "ball.toml --out out"));
    let lines: Vec<&str> = printed.lines().collect();
    assert_eq!(lines.len(), 6, "{printed}");
    assert!(lines[0].starts_with("point     load   p mean approach"), "{printed}");
    assert!(lines[1].starts_with("            mN") && lines[5].starts_with("    4   40.00 "), "{printed}");
    let out = folder.path().join("out");
    let expected = promised(
        "sweep.csv fields.h5 fields.vti fields/point-0001.h5 fields/point-0001.vti fields/point-0004.h5
         fields/point-0004.vti",
        "contact contact_area gap material_ratio max_pressure mean_gap plastic pressure pressure_histogram
         profile relief_upper spectrum stiffness topographies",
    );
    assert_eq!(files(&out), expected);

    // Rows that are there are printed again, and the last point is solved.
    assert_eq!(ok(&run(&folder, "ball.toml --out out --resume")), printed);
    assert_eq!(files(&out), expected);
    fs::write(folder.path().join("ball.toml"), BALL).unwrap();
    ok(&run(&folder, "ball.toml --out out --overwrite"));
    let left = files(&out);
    assert!(!left.contains("sweep.csv") && !left.contains("fields/point-0001.h5"), "{left:?}");
}

#[test]
#[ignore = "computes a whole example: needs an optimised build"]
fn a_ball_pushed_to_and_fro_is_mindlin_and_deresiewicz() {
    let folder = tempfile::tempdir().unwrap();
    ok(&run(&folder, "--example friction"));
    let out = folder.path().join("friction/results");
    let steel = Material::elastic(210e9, 0.3).unwrap();
    let normal = HertzSphere { radius: 1e-3, modulus: composite_modulus(&steel, &steel).unwrap(), load: 1.0 };
    let tangential_modulus = tangential_modulus(&steel, &steel);
    let pushed =
        |force| CattaneoMindlin { normal, tangential_modulus, friction: 0.3, tangential_load: force };
    let turn = pushed(0.18);
    // Displacements come to some parts in a thousand at 47 cells along the radius, areas to a ring of cells.
    let close = |found: f64, expected: f64, tolerance: f64, what: &str| {
        assert!((found / expected - 1.0).abs() < tolerance, "{what}: {found:e}, expected {expected:e}");
    };
    let rows = table_of(&out.join("increments.csv"), &INCREMENT_COLUMNS);
    let displacement = turn.displacement();
    for row in &rows {
        let force = row["tangential_force_x"];
        let expected = match row["stage"] as usize {
            1 => 0.0,
            2 => pushed(force).displacement(),
            3 => MindlinDeresiewicz { turn, tangential_load: force }.displacement(),
            _ => -MindlinDeresiewicz { turn, tangential_load: -force }.displacement(),
        };
        let error = (row["tangential_displacement_x"] - expected).abs();
        assert!(error < 5e-3 * displacement, "{force:e} N: off by {error:e} of {displacement:e} m");
    }
    let stick = |c: f64| std::f64::consts::PI * c * c;
    let record = &summary(&out)["static"];
    close(number(&record["stick_area"]), stick(turn.stick_radius()), 2e-2, "stick area");
    let most = turn.shear(turn.stick_radius());
    close(number(&record["max_shear"]), most, 2e-2, "largest shear");
    let cycle = rows.iter().filter(|row| row["stage"] > 2.0).map(|row| row["dissipation"]).sum();
    close(cycle, turn.cycle_loss(), 2e-2, "loss of the cycle");
}

#[test]
fn a_rolling_contact_tells_its_creepage_and_has_the_figure_of_its_shear() {
    let rolls = pushed("[friction]\ncoefficient = 0.3\ncreepage = [2e-3, -1e-3]\n");
    let folder = folder_with("ball.toml", &rolls);
    assert_has(&ok(&run(&folder, "ball.toml --out out")), "\ncreepage          0.002, -0.001\n");
    let out = folder.path().join("out");
    let left = files(&out);
    assert!(left.contains("figures/shear.png"), "{left:?}");
    assert!(!left.contains("increments.csv") && !left.contains("figures/loading.png"), "{left:?}");
    assert_eq!(summary(&out)["static"]["creepage"], serde_json::json!([2e-3, -1e-3]));
}

#[test]
fn a_motion_tells_its_coefficient_of_friction_and_draws_it() {
    let case = format!("{}friction = {{ coefficient = 0.2 }}\n", moving(2, 4));
    let folder = folder_with("case.toml", &case);
    let table = ok(&run(&folder, "case.toml --out out"));
    assert!(table.lines().nth(3).unwrap().ends_with(" friction"), "{table}");
    assert!(table.lines().nth(5).unwrap().ends_with("      0.2"), "{table}");
    assert!(files(&folder.path().join("out")).contains("figures/friction.png"));
}
