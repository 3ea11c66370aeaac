//! From text to [`Case`]: each table is read by its own function, then combinations are checked.

use std::path::{Path, PathBuf};

use super::body::body;
use super::cursor::Table;
use super::document::Document;
use super::plasticity::plasticity;
use super::rules;
use super::running::{Used, heat_together};
use super::schema::root as keys;
use super::schema::tables::{self, belongs, known_in};
use super::topography::{one_tells_the_other, topography};
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
    let spec = topography(&root.required_table("topography")?, folder)?;
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
    let title = keys::TITLE.of(root)?.unwrap_or_else(stem);
    let used = Used {
        flash: keys::TEMPERATURE.entry(root).is_some()
            && keys::FRICTION.entry(root).is_some()
            && (keys::MOTION.entry(root).is_some() || keys::SLIDING.entry(root).is_some()),
        conduction: uses("conductivity", |name| root.get(name).is_some()),
    };
    let lower_table = keys::LOWER.demand(root)?;
    let mut lower = body(&lower_table, folder, used)?;
    let upper_table = keys::UPPER.demand(root)?;
    let mut upper = body(&upper_table, folder, used)?;
    heat_together(&mut lower, &lower_table, &upper, used);
    heat_together(&mut upper, &upper_table, &lower, used);
    one_tells_the_other(&lower.topography, &upper.topography, &upper_table)?;
    let contact = keys::CONTACT.demand(root)?;
    known_in(&contact)?;
    let contact = Contact::read(&contact)?;
    let mut interface = Interfaces::default();
    each_interface!(I => if let Some(table) = root.table(I::NAME)? {
        known_in(&table)?;
        I::read(&table)?.give(&mut interface);
    });
    let motion: Option<MotionSpec> = tables::read(&keys::MOTION, root)?;
    let mut motion = motion.map(|motion| motion.resolved(contact.prescribed()));
    let sliding = tables::read(&keys::SLIDING, root)?;
    let mut friction = tables::read::<FrictionSpec>(&keys::FRICTION, root)?;
    let plasticity = keys::PLASTICITY
        .of(root)?
        .map(|table| plasticity(&table, root, &mut motion, &mut friction))
        .transpose()?;
    // Later stages of elasto-plastic bodies have as many steps as the first one.
    let steps = match (&plasticity, &friction) {
        (None, _) => 1,
        (Some(_), Some(friction)) => friction.increments,
        (Some(plasticity), None) => plasticity.increments.unwrap_or(1),
    };
    let history = stages(root, friction.is_some(), steps)?;
    let acceleration = tables::read(&keys::ACCELERATION, root)?;
    let temperature = tables::read(&keys::TEMPERATURE, root)?
        .map(|temperature: Temperature| temperature.resolved(lower.thermal.is_some()));
    let mut with = Capabilities::default();
    each_capability!(C => if let Some(table) = root.table(C::NAME)? {
        known_in(&table)?;
        C::read(&table)?.give(&mut with);
    });
    Ok(Case {
        title,
        lower,
        upper,
        contact,
        interface,
        friction,
        history,
        motion,
        sliding,
        steady: tables::read(&keys::STEADY, root)?,
        acceleration,
        temperature,
        plasticity,
        subsurface: tables::read(&keys::SUBSURFACE, root)?,
        with,
        output: tables::read(&keys::OUTPUT, root)?.unwrap_or_default(),
        document: Document::default(),
    })
}

/// Reads the stages after the first; by default each that takes no time has `steps` steps.
fn stages(root: &Table<'_>, has_friction: bool, steps: usize) -> Result<Vec<StageSpec>> {
    let Some(entry) = keys::HISTORY.entry(root) else { return Ok(Vec::new()) };
    let keys = if has_friction { "'load', 'force' or another" } else { "'load' or another" };
    let stage = |table: &Table<'_>| {
        known_in(table)?;
        StageSpec::read(table)?
            .resolved(steps, keys)
            .map_err(|hint| table.error("[[history]] names nothing that changes".to_owned(), Some(hint)))
    };
    entry.tables()?.iter().map(stage).collect()
}
