//! `asperity init`: a case file with comments.

use std::fmt::Write as _;
use std::io::{BufRead, Write as _};
use std::path::Path;

use asperity::study::case::schema::{Fallback, Key, Section};
use asperity::study::{Case, keys};
use asperity::with::{BodyLaw, Capability};
use asperity::{each, io};

use super::draft::{Draft, DraftBody};
use super::name;
use super::surface::quoted;
use crate::args::{Init, Load, load, pair_of_materials};
use crate::place;
use crate::report::{Failure, Outcome, note, print};

/// Adds tables that the case may have, each on a line that is a comment, and becomes part of a valid case
/// without its leading `# `.
fn with_more(text: &str) -> String {
    let (title, rest) = text.split_once('\n').expect("a case begins with its title");
    let topography = "[lower.topography]\n";
    let place = |name: &str, lines: &str| match name.strip_prefix("lower.") {
        Some(_) => text.replacen(topography, &format!("{lines}{topography}"), 1),
        None => format!("{title}\n{lines}{rest}"),
    };
    let is_case = |text: &str| Case::parse(text, Path::new("case.toml"), Path::new("")).is_ok();
    let (mut of_case, mut of_body) = (String::new(), String::new());
    let mut add = |path: &str, meaning: &str| {
        let name = path.strip_prefix("lower.").unwrap_or(path);
        let line = |keys: String| format!("{name} = {{ {keys} }}\n");
        if let Some(line) = examples(path).map(line).find(|line| is_case(&place(path, line))) {
            let lines = if name == path { &mut of_case } else { &mut of_body };
            // Without the links of the documents.
            let meaning = meaning.split(", see [").next().unwrap_or_default();
            let _ = writeln!(lines, "# {:<54} # {meaning}", line.trim_end());
        }
    };
    add("friction", "friction of the bodies");
    add("output", "keep the fields of every 4th position, point or increment");
    each!(capability C => add(C::NAME, C::MEANING));
    each!(law L => add(&format!("lower.{}", L::NAME), L::MEANING));
    let head = "# Remove the leading \"# \" of a line that you need; docs/input.md explains each key.\n";
    let rest = rest.replacen(topography, &format!("{of_body}{topography}"), 1);
    format!("{title}\n\n{head}{of_case}{rest}")
}

/// Returns examples of the keys of a table: those that are required with each of its choices, or one of the
/// others.
fn examples(path: &str) -> impl Iterator<Item = String> {
    let sections = keys().iter().filter(move |section| section.tables.contains(&path));
    let (own, choices): (Vec<&Section>, Vec<&Section>) =
        sections.partition(|section| section.kind.is_empty());
    let own: Vec<&Key> = own.iter().flat_map(|section| section.keys).collect();
    let example = |key: &Key| format!("{} = {}", key.name, key.example);
    let required = |keys: &mut dyn Iterator<Item = &Key>| {
        keys.filter(|key| key.default == Fallback::Required).map(example).collect::<Vec<_>>()
    };
    let of_choice = |choice: &&Section| {
        let chooses = |key: &&&Key| !choice.kind.starts_with(&format!("{} =", key.name));
        let keys = required(&mut own.iter().filter(chooses).copied().chain(choice.keys));
        [vec![choice.kind.to_owned()], keys].concat().join(", ")
    };
    let all = required(&mut own.iter().copied()).join(", ");
    let found: Vec<String> = match (&choices[..], all.is_empty()) {
        ([], false) => vec![all],
        ([], true) => own.iter().copied().map(example).collect(),
        (choices, _) => choices.iter().map(of_choice).collect(),
    };
    found.into_iter()
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
    let text = with_more(&draft([&lower, &upper], materials.0, pressed, passes).text());
    io::replace(&arguments.case, text.as_bytes())?;
    let case = place::quoted(&arguments.case);
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
