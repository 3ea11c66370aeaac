//! From text to [`Case`]. The tables are read in the order of the contract, each by one function.

use std::path::{Path, PathBuf};

use super::body::body;
use super::contact::contact;
use super::cursor::{Entry, Table};
use super::document::Document;
use super::friction::{friction, stages};
use super::motion::{fresh, motion};
use super::output::output;
use super::plasticity::{self, PlasticitySpec};
use super::running;
use super::schema::root;
use super::schema::tables::{belongs, known_in};
use super::sliding::{alone, sliding};
use super::subsurface::subsurface;
use super::sweep;
use super::topography::topography;
use super::{
    Body, Boundary, Case, Contact, CounterBody, FrictionSpec, MotionSpec, OffsetY, StageSpec, TopographySpec,
};
use crate::error::Result;
use crate::material;
use crate::motion::Acceleration;
use crate::solver::Coupling;

/// A topography that stands alone, in the table `[topography]`, and the document that it stands in.
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
    known_in(&root)?;
    let stem = || file.file_stem().map(|stem| stem.to_string_lossy().into_owned()).unwrap_or_default();
    let title = root::TITLE.of(&root)?.unwrap_or_else(stem);
    let lower = body(&root.required_table("lower")?, folder)?;
    let upper_table = root.required_table("upper")?;
    let upper = body(&upper_table, folder)?;
    one_tells_the_other(&lower.topography, &upper.topography, &upper_table)?;
    if material::composite_modulus(&lower.material, &upper.material).is_err() {
        let hint = "give one of them a finite 'young' or a coating";
        return Err(upper_table
            .required("young", "\"210 GPa\"")?
            .error("both bodies are rigid".to_owned(), Some(hint.to_owned())));
    }
    let contact_table = root.required_table("contact")?;
    let contact = contact(&contact_table)?;
    let mut motion =
        root.table("motion")?.map(|table| motion(&table, &contact_table, &contact)).transpose()?;
    let sliding = root.table("sliding")?.map(|table| sliding(&table)).transpose()?;
    alone(&root, [&lower, &upper])?;
    let slides = motion.is_some() || sliding.is_some();
    let yields = lower.hardness.yields() || upper.hardness.yields();
    let mut friction = root.table("friction")?.map(|table| friction(&table, yields, slides)).transpose()?;
    let stages = root.get("history");
    stands_alone(&contact_table, friction.as_ref(), motion.is_some(), stages.is_some())?;
    let bodies = [&lower, &upper];
    let plasticity = plasticity::plasticity(&root, bodies, contact.boundary, &mut motion, &mut friction)?;
    let history = history(stages.as_ref(), motion.is_some(), friction.as_ref(), plasticity.as_ref())?;
    if let (Some(_), Some(motion)) = (&friction, motion)
        && motion.strategy.direction() == 0.0
    {
        let hint = "give the speeds different values, or leave [friction] out".to_owned();
        let message = "surfaces of equal speeds do not slide over each other".to_owned();
        return Err(root.required_table("friction")?.error(message, Some(hint)));
    }
    if let Some(motion) = motion {
        fresh(&root, &motion, &upper.topography)?;
    }
    running::runs_in(&root, [&lower, &upper], motion.as_ref(), sliding.as_ref())?;
    let acceleration =
        root.table("acceleration")?.map(|table| accelerated(&table, [&lower, &upper], motion.as_ref()));
    let acceleration = acceleration.transpose()?;
    let temperature =
        running::temperature(&root, [&lower, &upper], motion.as_ref(), sliding.as_ref(), contact.boundary)?;
    let subsurface =
        root.table("subsurface")?.map(|table| subsurface(&table, motion.is_some())).transpose()?;
    if let Some(entry) = root.table("friction")?.and_then(|table| table.get("spin"))
        && contact.boundary != Boundary::FREE
    {
        let hint = "use `boundary = \"free\"`, or leave 'spin' out".to_owned();
        return Err(
            entry.error("what spins does not repeat itself: its boundary is free".to_owned(), Some(hint))
        );
    }
    if let (Some(_), Some(entry)) = (&subsurface, contact_table.get("boundary"))
        && contact.boundary.repeats(0) != contact.boundary.repeats(1)
    {
        let message = "a boundary periodic along one axis alone has no [subsurface] yet";
        let hint = "leave [subsurface] out, or use \"free\" or \"periodic\"".to_owned();
        return Err(entry.error(message.to_owned(), Some(hint)));
    }
    if [&lower, &upper].iter().any(|body| body.material.coating.is_some()) {
        pressed_alone(&root, &contact, friction.as_ref(), slides)?;
    }
    let output = output(&root)?;
    Ok(Case {
        title,
        lower,
        upper,
        contact,
        friction,
        history,
        motion,
        sliding,
        acceleration,
        temperature,
        plasticity,
        subsurface,
        output,
        document,
    })
}

/// `[acceleration]`, of bodies that run in by passes that repeat.
fn accelerated(table: &Table<'_>, bodies: [&Body; 2], motion: Option<&MotionSpec>) -> Result<Acceleration> {
    let acceleration = running::acceleration(table)?;
    if bodies.iter().all(|body| body.wear.is_none() && body.film.is_none()) {
        let hint = "give a body `[lower.wear]` or `[lower.film]`, or leave [acceleration] out".to_owned();
        return Err(table.error("[acceleration] is of bodies that wear or grow films".to_owned(), Some(hint)));
    }
    if let Some(motion) = motion.filter(|motion| acceleration.max_jump > 1 && !motion.repeats()) {
        let (what, other) = match motion {
            MotionSpec { counter: CounterBody::Fresh, .. } => {
                ("a fresh counter-body meets", "`counter = \"same\"`")
            }
            MotionSpec { offset_y, .. } if *offset_y != OffsetY::NONE => {
                ("surfaces that are displaced across meet", "`offset_y = 0`")
            }
            _ => (
                "surfaces that do not move by whole rounds meet",
                "speeds of which one is 0 or which are equal, or `path = \"reciprocating\"`",
            ),
        };
        let message = format!("{what} anew in each pass: no pass stands for others");
        return Err(table.error(message, Some(format!("set `max_jump = 1`, or {other}"))));
    }
    Ok(acceleration)
}

/// What a coated body answers to is a pressure, on a surface that is free or periodic: an error where more is asked for.
fn pressed_alone(
    root: &Table<'_>,
    contact: &Contact,
    friction: Option<&FrictionSpec>,
    moves: bool,
) -> Result<()> {
    if let (Some(table), Some(friction)) = (root.table("friction")?, friction)
        && (!moves || friction.law.coupling != Coupling::None)
    {
        let message = "what shear does to a coated body is not known yet".to_owned();
        let hint = match moves {
            true => "set `coupling = \"none\"`, or leave the coating out",
            false => "leave [friction] or the coating out",
        };
        let hint = Some(hint.to_owned());
        return Err(match table.get("coupling").filter(|_| moves) {
            Some(entry) => entry.error(message, hint),
            None => table.error(message, hint),
        });
    }
    if let Some(entry) = root.required_table("contact")?.get("boundary")
        && contact.boundary.repeats(0) != contact.boundary.repeats(1)
    {
        let message = "a coated body has no boundary that is periodic along one axis alone yet".to_owned();
        let hint = "use \"free\" or \"periodic\", or leave the coating out".to_owned();
        return Err(entry.error(message, Some(hint)));
    }
    match root.table("subsurface")? {
        None => Ok(()),
        Some(table) => {
            let hint = "leave [subsurface] or the coating out".to_owned();
            Err(table.error("stresses under a coating are not known yet".to_owned(), Some(hint)))
        }
    }
}

/// An error if both bodies wait for each other's shape or pitch.
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

/// An error if the bodies of a sweep have a past, or a future.
fn stands_alone(
    contact: &Table<'_>,
    friction: Option<&FrictionSpec>,
    moves: bool,
    has_history: bool,
) -> Result<()> {
    let Some(entry) = sweep::KEYS.iter().find_map(|key| contact.get(key)) else { return Ok(()) };
    let refused = |message: &str, hint: &str| {
        Err(entry.error(message.replace("{}", entry.key()), Some(hint.to_owned())))
    };
    if moves {
        return refused("a [motion] has no '{}'", "it has one `load`, `mean_pressure` or `approach`");
    }
    if has_history {
        let hint = "each of its values presses virgin bodies, in a history what is flattened stays flat";
        return refused("'{}' and [[history]] are both given, expected one of them", hint);
    }
    if friction.is_some_and(|friction| !friction.creepages.is_empty()) {
        let hint = "a sweep goes through loads at one `creepage`, or through creepages under one `load`";
        return refused("'{}' and 'creepages' are both given, expected one of them", hint);
    }
    if friction.is_some_and(|friction| !friction.rolls()) {
        let message = "with [friction] only what rolls has '{}'";
        let hint = "what sticks and slips depends on how a load came about: give a `creepage`, a `rolling_force`, or \
                    stages in a [[history]]";
        return refused(message, hint);
    }
    Ok(())
}

/// The stages after the first, which only a static contact has.
fn history(
    entry: Option<&Entry<'_>>,
    moves: bool,
    friction: Option<&FrictionSpec>,
    plasticity: Option<&PlasticitySpec>,
) -> Result<Vec<StageSpec>> {
    let Some(entry) = entry else { return Ok(Vec::new()) };
    let tables = entry.tables()?;
    if moves {
        let table = tables.first();
        let message = "a [motion] has no [[history]]".to_owned();
        let hint = Some("a history is that of a static contact".to_owned());
        return Err(match table {
            Some(table) => table.error(message, hint),
            None => entry.error(message, hint),
        });
    }
    stages(&tables, friction, plasticity)
}
