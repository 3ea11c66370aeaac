//! From text to [`Case`]: each table is read by its own function, then combinations are checked.

use std::path::{Path, PathBuf};

use super::body::{UpperKeys, Used};
use super::cursor::Table;
use super::document::Document;
use super::plasticity::plasticity;
use super::root::Root;
use super::rules;
use super::schema::tables::{self, belongs, known_in};
use super::{Case, StageSpec, TopographySpec};
use asperity_base::error::Result;
use asperity_base::table::Table as _;
use asperity_contact::each;
use asperity_contact::with::{Capabilities, Capability, Interfaces, Listed, uses};

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

pub(super) fn case(text: &str, file: &Path, folder: &Path, has_custom_laws: bool) -> Result<Case> {
    let mut document = Document::new(file.to_owned(), text);
    let entries = document.parse(text)?;
    let root = Table::root(&document, entries.get_ref());
    let case = Case { has_custom_laws, ..read(&root, file, folder)? };
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
fn read(table: &Table<'_>, file: &Path, folder: &Path) -> Result<Case> {
    known_in(table)?;
    let root = Root::read(table)?;
    let stem = || file.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
    let used = Used {
        flash: root.temperature.is_some()
            && root.friction.is_some()
            && (root.motion.is_some() || root.sliding.is_some()),
        conduction: uses("conductivity", |name| table.get(name).is_some()),
    };
    let [lower_table, upper_table] = [table.required_table("lower")?, table.required_table("upper")?];
    let mut lower = root.lower.body(&lower_table, folder, used)?;
    let mut upper = root.upper.body(&upper_table, folder, used)?;
    upper.mount = UpperKeys::read(&upper_table)?.mount(&upper.topography.source);
    root.lower.heat_together(&mut lower, &upper, used);
    root.upper.heat_together(&mut upper, &lower, used);
    one_tells_the_other(&lower.topography, &upper.topography, &upper_table)?;
    let mut interface = Interfaces::default();
    each!(interface I => if let Some(table) = tables::read::<I>(table, I::NAME)? {
        table.give(&mut interface);
    });
    let mut with = Capabilities::default();
    each!(capability C => if let Some(table) = tables::read::<C>(table, C::NAME)? {
        table.give(&mut with);
    });
    let mut motion = root.motion.map(|motion| motion.resolved(root.contact.prescribed()));
    let mut friction = root.friction;
    let gives_increments =
        table.table("friction")?.is_some_and(|friction| friction.get("increments").is_some());
    let sweeps = !root.contact.sweep().is_empty();
    let plasticity = root
        .plasticity
        .map(|region| plasticity(region, &mut motion, &mut friction, gives_increments, sweeps));
    // Later stages of elasto-plastic bodies have as many steps as the first one.
    let steps = match (&plasticity, &friction) {
        (None, _) => 1,
        (Some(_), Some(friction)) => friction.increments,
        (Some(plasticity), None) => plasticity.increments.unwrap_or(1),
    };
    Ok(Case {
        title: root.title.unwrap_or_else(stem),
        contact: root.contact,
        interface,
        history: stages(table, root.history, friction.is_some(), steps)?,
        friction,
        motion,
        sliding: root.sliding,
        steady: root.steady,
        acceleration: root.acceleration,
        temperature: root.temperature.map(|temperature| temperature.resolved(lower.thermal.is_some())),
        lower,
        upper,
        plasticity,
        subsurface: root.subsurface,
        with,
        output: root.output,
        has_custom_laws: false,
        document: Document::default(),
    })
}

/// Returns the stages after the first; by default each that takes no time has `steps` steps.
fn stages(
    root: &Table<'_>,
    stages: Vec<StageSpec>,
    has_friction: bool,
    steps: usize,
) -> Result<Vec<StageSpec>> {
    let keys = if has_friction { "'load', 'force' or another" } else { "'load' or another" };
    let tables = root.get("history").map(|entry| entry.tables()).transpose()?.unwrap_or_default();
    let stage = |(stage, table): (StageSpec, &Table<'_>)| {
        stage
            .resolved(steps, keys)
            .map_err(|hint| table.error("[[history]] names nothing that changes".to_owned(), Some(hint)))
    };
    stages.into_iter().zip(&tables).map(stage).collect()
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
    let why = if lower.lacks().any(|other| other == key) {
        "and in [lower.topography]: a body takes from the other what it lacks".to_owned()
    } else {
        format!("from which [lower.topography] takes its '{of_lower}'")
    };
    let example = if key == "shape" { "[256, 256]" } else { "\"0.5 um\"" };
    let hint = format!("for example `{key} = {example}`");
    Err(table.error(format!("missing key '{key}' in {}, {why}", table.name()), Some(hint)))
}
