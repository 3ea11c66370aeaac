//! From text to [`Case`]: each table is read by its own function, then combinations are checked.

use std::path::{Path, PathBuf};

use super::body::{BodyKeys, UpperKeys, Used};
use super::cursor::Table;
use super::document::Document;
use super::plasticity::plasticity;
use super::rules;
use super::schema::tables::{self, belongs, known_in};
use super::{Case, Contact, FrictionSpec, MotionSpec, StageSpec, TopographySpec};
use asperity_base::error::Result;
use asperity_base::table::Table as _;
use asperity_contact::temperature::Temperature;
use asperity_contact::with::{Capabilities, Capability, Interfaces, Listed, uses};
use asperity_contact::{each_capability, each_interface};

/// Reads a topography in a separate table `[topography]`; also returns its document.
pub(super) fn topography_alone(text: &str, folder: &Path) -> Result<(TopographySpec, Document)> {
    let mut document = Document::new(PathBuf::new(), text);
    let entries = document.parse(text)?;
    let root = Table::root(&document, entries.get_ref());
    root.known(&["topography"], |key| belongs(key, ""))?;
    let table = root.required_table("topography")?;
    known_in(&table)?;
    let spec = TopographySpec::read(&table)?.in_folder(folder);
    Ok((spec, document))
}

pub(super) fn case(text: &str, file: &Path, folder: &Path) -> Result<Case> {
    let mut document = Document::new(file.to_owned(), text);
    let entries = document.parse(text)?;
    let root = Table::root(&document, entries.get_ref());
    let case = read(&root, file, folder)?;
    rules::check(&root, &case)?;
    Ok(Case { document, ..case })
}

/// Returns an error if the case breaks a rule, after a change of its values.
pub(super) fn check_again(case: &Case) -> Result<()> {
    let text = case.document.text();
    let mut document = case.document.clone();
    let entries = document.parse(text)?;
    rules::check(&Table::root(&document, entries.get_ref()), case)
}

/// Reads all tables of a case, still without its document.
fn read(root: &Table<'_>, file: &Path, folder: &Path) -> Result<Case> {
    known_in(root)?;
    let stem = || file.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
    let title = root.get("title").map(|title| title.text().map(str::to_owned)).transpose()?;
    let is_given = |name: &str| root.get(name).is_some();
    let used = Used {
        flash: is_given("temperature") && is_given("friction") && (is_given("motion") || is_given("sliding")),
        conduction: uses("conductivity", is_given),
    };
    let lower_table = tables::required(root, "lower")?;
    let lower_keys = BodyKeys::read(&lower_table)?;
    let mut lower = lower_keys.body(&lower_table, folder, used)?;
    let upper_table = tables::required(root, "upper")?;
    let upper_keys = BodyKeys::read(&upper_table)?;
    let mut upper = upper_keys.body(&upper_table, folder, used)?;
    upper.mount = UpperKeys::read(&upper_table)?.mount(&upper.topography.source);
    lower_keys.heat_together(&mut lower, &upper, used);
    upper_keys.heat_together(&mut upper, &lower, used);
    one_tells_the_other(&lower.topography, &upper.topography, &upper_table)?;
    let contact = Contact::read(&tables::required(root, "contact")?)?;
    let mut interface = Interfaces::default();
    each_interface!(I => if let Some(table) = tables::read::<I>(root, I::NAME)? {
        table.give(&mut interface);
    });
    let motion: Option<MotionSpec> = tables::read(root, "motion")?;
    let mut motion = motion.map(|motion| motion.resolved(contact.prescribed()));
    let sliding = tables::read(root, "sliding")?;
    let mut friction = tables::read::<FrictionSpec>(root, "friction")?;
    let plasticity = root
        .table("plasticity")?
        .map(|table| plasticity(&table, root, &mut motion, &mut friction))
        .transpose()?;
    // Later stages of elasto-plastic bodies have as many steps as the first one.
    let steps = match (&plasticity, &friction) {
        (None, _) => 1,
        (Some(_), Some(friction)) => friction.increments,
        (Some(plasticity), None) => plasticity.increments.unwrap_or(1),
    };
    let history = stages(root, friction.is_some(), steps)?;
    let acceleration = tables::read(root, "acceleration")?;
    let temperature = tables::read(root, "temperature")?
        .map(|temperature: Temperature| temperature.resolved(lower.thermal.is_some()));
    let mut with = Capabilities::default();
    each_capability!(C => if let Some(table) = tables::read::<C>(root, C::NAME)? {
        table.give(&mut with);
    });
    Ok(Case {
        title: title.unwrap_or_else(stem),
        lower,
        upper,
        contact,
        interface,
        friction,
        history,
        motion,
        sliding,
        steady: tables::read(root, "steady")?,
        acceleration,
        temperature,
        plasticity,
        subsurface: tables::read(root, "subsurface")?,
        with,
        output: tables::read(root, "output")?.unwrap_or_default(),
        document: Document::default(),
    })
}

/// Reads the stages after the first; by default each that takes no time has `steps` steps.
fn stages(root: &Table<'_>, has_friction: bool, steps: usize) -> Result<Vec<StageSpec>> {
    let Some(entry) = root.get("history") else { return Ok(Vec::new()) };
    let keys = if has_friction { "'load', 'force' or another" } else { "'load' or another" };
    let stage = |table: &Table<'_>| {
        known_in(table)?;
        StageSpec::read(table)?
            .resolved(steps, keys)
            .map_err(|hint| table.error("[[history]] names nothing that changes".to_owned(), Some(hint)))
    };
    entry.tables()?.iter().map(stage).collect()
}

/// Returns an error if both bodies take their shape or pitch from each other.
fn one_tells_the_other(
    lower: &TopographySpec,
    upper: &TopographySpec,
    upper_table: &Table<'_>,
) -> Result<()> {
    let (Some(of_lower), Some(of_upper)) = (lower.lacks().last(), upper.lacks().last()) else {
        return Ok(());
    };
    let table = upper_table.required_table("topography")?;
    let key = upper.lacks().find(|key| lower.lacks().any(|other| other == *key)).unwrap_or(of_upper);
    let why = match lower.lacks().any(|other| other == key) {
        true => "and in [lower.topography]: a body takes from the other what it lacks".to_owned(),
        false => format!("from which [lower.topography] takes its '{of_lower}'"),
    };
    let example = if key == "shape" { "[256, 256]" } else { "\"0.5 um\"" };
    let hint = format!("for example `{key} = {example}`");
    Err(table.error(format!("missing key '{key}' in {}, {why}", table.name()), Some(hint)))
}
