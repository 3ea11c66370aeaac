//! What the terminal shows of bodies that change: a row for each pass, and what has become of them at the
//! end.

use std::fs;

use crate::support::{asperity, ok};
use crate::survival::{ball, folder_with, motion};

const K: f64 = 1e-15;

/// Returns the number that follows `words` in the `text`.
fn number_after(text: &str, words: &str) -> f64 {
    let (_, after) = text.split_once(words).unwrap_or_else(|| panic!("no {words:?} in {text}"));
    let number: String =
        after.trim_start().chars().take_while(|c| c.is_ascii_digit() || ".e-".contains(*c)).collect();
    number.parse().unwrap_or_else(|_| panic!("no number after {words:?} in {text}"))
}

/// Archard's volume k W s, with its depth, rate and coefficient, and the temperature.
#[test]
fn wear_and_temperature_end_the_terminal() {
    let heat = "[friction]\ncoefficient = 0.2\n";
    let bodies = |case: String| {
        case.replace(
            "young = \"210 GPa\"",
            "young = \"210 GPa\"\nconductivity = 50\nheat_capacity = 460\ndensity = 7800",
        )
        .replace("[contact]", "wear = { coefficient = 1e-15 }\n[contact]")
    };
    let slide = format!(
        "{heat}[sliding]\ndistance = \"10 mm\"\nupdates = 3\nspeed = 2\n[temperature]\nbulk = \"20 °C\"\n"
    );
    let in_place = bodies(ball(&slide));
    let passes = motion(2, "friction = { coefficient = 0.2 }\ntemperature = { bulk = \"20 °C\" }\n")
        .replace("hardness =", "conductivity = 50, heat_capacity = 460, density = 7800, wear = { coefficient = 1e-15 }, hardness =")
        .replace("stride = 2", "stride = 2, speed = 2");
    for (case, distance, bodies) in [(in_place, 1e-2, 1.0), (passes, 2.0 * 30e-6, 2.0)] {
        let folder = folder_with(&case);
        let text = ok(&asperity(&folder, "run case.toml --out out"));
        let worn = 1e18 * bodies * K * 20e-3 * distance;
        let told = number_after(&text, "\nwear ");
        assert!((told - worn).abs() < 0.02 * worn, "{told} instead of {worn} µm³ in {text}");
        let coefficient = number_after(&text, "a coefficient of ");
        assert!((coefficient - 1e9 * bodies * K).abs() < 0.02e9 * bodies * K, "{coefficient} in {text}");
        assert!(number_after(&text, "\ntemperature       up to ") > 20.0, "{text}");
        assert!(text.contains(" deep: "), "{text}");
    }
}

/// A row has Dang Van's f and the damage of its pass, also the rows before an interruption.
#[test]
fn rows_of_passes_have_what_capabilities_found() {
    let limit = "fatigue = { torsion = \"550 MPa\", tension = \"850 MPa\", cycles = 3, pit_depth = \"0.5 um\" }, hardness =";
    let case =
        |passes| motion(passes, "fatigue = { to = \"4 um\", layers = 3 }\n").replacen("hardness =", limit, 1);
    let folder = folder_with(&case(3));
    let whole = ok(&asperity(&folder, "run case.toml --out out"));
    assert!(whole.contains("f/b   damage   pitted"), "{whole}");
    let rows = |text: &str| -> Vec<String> {
        let is_row = |line: &&str| line.trim_start().starts_with(|c: char| c.is_ascii_digit());
        text.lines().filter(is_row).map(str::to_owned).collect()
    };
    assert_eq!(rows(&whole).len(), 3, "{whole}");
    fs::write(folder.path().join("case.toml"), case(2)).unwrap();
    ok(&asperity(&folder, "run case.toml --out two"));
    fs::write(folder.path().join("case.toml"), case(3)).unwrap();
    let resumed = ok(&asperity(&folder, "run case.toml --out two --resume"));
    assert_eq!(rows(&resumed), rows(&whole));
    // Bodies that do not pit have no column of pits.
    fs::write(folder.path().join("case.toml"), case(1).replace(", pit_depth = \"0.5 um\"", "")).unwrap();
    let without = ok(&asperity(&folder, "run case.toml --out without"));
    assert!(without.contains("f/b   damage") && !without.contains("pitted"), "{without}");
}
