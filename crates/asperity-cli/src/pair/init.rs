//! `asperity init`: a case file with comments.

use std::fmt::Write as _;
use std::io::{BufRead, Write as _};
use std::path::Path;

use asperity::with::{BodyLaw, Capability};
use asperity::{each_capability, each_law, io};

use super::draft::{Draft, DraftBody};
use super::name;
use super::surface::quoted;
use crate::args::{Init, Load, load, pair_of_materials};
use crate::place;
use crate::report::{Failure, Outcome, note, print};

/// Other tables of a case, as comments.
const MORE: &str = include_str!("more.toml");

/// Returns the tables that a case may have beside those of the draft, as comments.
fn more() -> String {
    let mut text = MORE.to_owned();
    let mut table = |name: &str, meaning: &str| {
        let _ = writeln!(text, "#\n# {:<32} # {meaning}", format!("[{name}]"));
    };
    each_law!(L => table(&format!("lower.{}", L::NAME), L::MEANING));
    each_capability!(C => table(C::NAME, C::MEANING));
    text
}

/// A rough surface, for bodies without a file.
const GENERATED: [(&str, &str); 5] = [
    ("generate", "\"self-affine\""),
    ("shape", "[256, 256]"),
    ("pitch", "\"1 um\""),
    ("sq", "\"0.2 um\""),
    ("hurst", "0.8"),
];

pub(crate) fn init(arguments: &Init) -> Outcome {
    if arguments.case.exists() && !arguments.overwrite {
        let message = format!("`{}` exists", arguments.case.display());
        return Err(Failure::usage(message, Some("--overwrite replaces it; or name another file")));
    }
    let lower = answer(
        &arguments.lower,
        "--lower",
        "topography file of the lower body (empty: a generated rough surface)",
        "",
    )?;
    let upper =
        answer(&arguments.upper, "--upper", "topography file of the upper body (empty: a flat one)", "")?;
    let materials = match &arguments.material {
        Some(both) => both.clone(),
        None => asked("--material", "material of both bodies, or two with a comma", "steel", |text| {
            pair_of_materials(text)
        })?,
    };
    let pressed = match &arguments.load {
        Some(load) => load.clone(),
        None => asked("--load", "load, such as 0.5 N, or mean pressure, such as 20 MPa", "1 N", load)?,
    };
    let passes = match arguments.passes {
        Some(passes) => passes,
        None => asked("--passes", "number of passes (0: a contact at rest)", "0", |text| {
            text.parse::<u32>().map_err(|_| "expected a whole number".to_owned())
        })?,
    };
    let text = draft([&lower, &upper], materials.0, pressed, passes).text() + &more();
    io::replace(&arguments.case, text.as_bytes())?;
    let case = place::shown(&arguments.case);
    note(&format!("next: asperity check {case}, then asperity run {case}"));
    print(&format!("{}\n", arguments.case.display()))
}

fn draft(files: [&str; 2], materials: [String; 2], load: Load, passes: u32) -> Draft {
    let [lower_material, upper_material] = materials;
    let body = |material: String, file: &str, otherwise: Vec<(&'static str, String)>| DraftBody {
        material,
        hardness: None,
        topography: match file {
            "" => otherwise,
            file => vec![("file", quoted(file)), ("fill", quoted("harmonic")), ("level", quoted("plane"))],
        },
    };
    let generated = GENERATED.map(|(key, value)| (key, value.to_owned())).to_vec();
    let flat = vec![("form", quoted("flat"))];
    let lower = files[0];
    let upper = files[1];
    let called = |file: &str, otherwise: &str| match file {
        "" => otherwise.to_owned(),
        file => name(Path::new(file)),
    };
    Draft {
        title: format!("{} on {}", called(upper, "a flat body"), called(lower, "a rough one")),
        bodies: [body(lower_material, lower, generated), body(upper_material, upper, flat)],
        load,
        periodic: false,
        is_common: !lower.is_empty() && !upper.is_empty(),
        passes: Some(passes).filter(|passes| *passes > 0),
    }
}

/// Returns the value of an option, or the answer to a question.
fn answer(given: &Option<String>, option: &str, question: &str, default: &str) -> Outcome<String> {
    match given {
        Some(text) => Ok(text.clone()),
        None => asked(option, question, default, |text| Ok(text.to_owned())),
    }
}

/// Asks until an answer is good. An empty answer takes the default.
fn asked<T>(
    option: &str,
    question: &str,
    default: &str,
    read: impl Fn(&str) -> Result<T, String>,
) -> Outcome<T> {
    loop {
        let mut stderr = std::io::stderr().lock();
        let shown = if default.is_empty() { String::new() } else { format!(" [{default}]") };
        let _ = write!(stderr, "{question}{shown}: ");
        let _ = stderr.flush();
        let mut line = String::new();
        let read_bytes = std::io::stdin().lock().read_line(&mut line).unwrap_or(0);
        if read_bytes == 0 {
            let _ = writeln!(stderr);
            let hint = format!("give {option}");
            return Err(Failure::usage("there is no answer to read", Some(&hint)));
        }
        let text = if line.trim().is_empty() { default } else { line.trim() };
        match read(text) {
            Ok(value) => return Ok(value),
            Err(message) => {
                let _ = writeln!(stderr, "{message}");
            }
        }
    }
}
