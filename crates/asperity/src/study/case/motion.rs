//! `[motion]`: how the bodies move.

use super::cursor::{Entry, Table};
use super::schema::contact::contact::BOUNDARY;
use super::schema::motion::motion as keys;
use super::schema::tables::known_in;
use super::{
    Boundary, Contact, ControlKind, CounterBody, MotionSpec, OffsetY, Prescribed, RANDOM, Source,
    StrategyKind, TopographySpec,
};
use crate::error::Result;
use crate::motion::Strategy;

pub(super) fn motion(table: &Table<'_>, contact_table: &Table<'_>, contact: &Contact) -> Result<MotionSpec> {
    known_in(table)?;
    let is_shift = keys::STRATEGY.of(table)? == StrategyKind::Shift;
    if contact.boundary.repeats(0) && !is_shift {
        let message = "a boundary periodic along x has no overlap, where a finite body passes over another";
        let hint = "use `boundary = \"free\"` or `[\"free\", \"periodic\"]`, or `strategy = \"shift\"` under [motion]"
            .to_owned();
        let place = keys::STRATEGY.entry(table).or(BOUNDARY.entry(contact_table));
        return Err(place.map_or_else(
            || table.error(message.to_owned(), Some(hint.clone())),
            |entry| entry.error(message.to_owned(), Some(hint.clone())),
        ));
    }
    let strategy = if is_shift { shift(table)? } else { overlap(table)? };
    Ok(MotionSpec {
        strategy,
        passes: keys::PASSES.of(table)?,
        stride: keys::STRIDE.of(table)?,
        control: control(table, contact.prescribed)?,
        plastic_update: keys::PLASTIC_UPDATE.of(table)?,
        load_tolerance: keys::LOAD_TOLERANCE.of(table)?,
        speed: speed(table, is_shift)?,
        path: keys::PATH.of(table)?,
        offset_y: offset_y(table, contact.boundary)?,
        counter: keys::COUNTER.of(table)?,
    })
}

/// Where along y the passes lie.
fn offset_y(table: &Table<'_>, boundary: Boundary) -> Result<OffsetY> {
    let entry = keys::OFFSET_Y.entry(table);
    let is_random = entry.as_ref().is_some_and(|entry| entry.text().is_ok());
    if let Some(seed) = keys::SEED.entry(table).filter(|_| !is_random) {
        let hint = "set `offset_y = \"random\"`, or leave 'seed' out".to_owned();
        return Err(seed.error("'seed' is that of passes that lie anywhere along y".to_owned(), Some(hint)));
    }
    let offset = match keys::OFFSET_Y.of(table)? {
        Some(cells) => OffsetY::Cells(cells),
        None => OffsetY::Random { seed: keys::SEED.of(table)? },
    };
    if let Some(entry) = entry.filter(|_| offset != OffsetY::NONE && !boundary.repeats(1)) {
        let hint = "set `boundary = [\"free\", \"periodic\"]` or `\"periodic\"` in [contact], or leave 'offset_y' out".to_owned();
        let message =
            "what is displaced along y comes in on the other side: its boundary is periodic along y";
        return Err(entry.error(message.to_owned(), Some(hint)));
    }
    Ok(offset)
}

/// A number of cells; none of `random`.
pub(super) fn offset(entry: &Entry<'_>) -> Result<Option<usize>> {
    if entry.text().is_err() {
        return entry.count(0).map(Some);
    }
    let random = entry.word(&[(RANDOM, None)]);
    random.map_err(|_| entry.unexpected("a whole number of cells, or \"random\"", None))
}

/// An error if the upper body is to be made anew for each pass, and is not made from a seed.
pub(super) fn fresh(root: &Table<'_>, motion: &MotionSpec, upper: &TopographySpec) -> Result<()> {
    if motion.counter == CounterBody::Same || matches!(upper.source, Source::Generate { .. }) {
        return Ok(());
    }
    let entry = keys::COUNTER.demand(&super::schema::root::MOTION.demand(root)?)?;
    let message = "a fresh counter-body is made from another seed: the upper topography has none".to_owned();
    let hint = "give [upper.topography] a `generate`, or set `counter = \"same\"`".to_owned();
    Err(entry.error(message, Some(hint)))
}

/// The speed of the upper body, of an overlap alone.
fn speed(table: &Table<'_>, is_shift: bool) -> Result<Option<f64>> {
    if let Some(entry) = keys::SPEED.entry(table).filter(|_| is_shift) {
        let hint = "a shift has `speed_lower` and `speed_upper`".to_owned();
        return Err(entry.error("'speed' belongs to strategy = \"overlap\"".to_owned(), Some(hint)));
    }
    keys::SPEED.of(table)
}

fn overlap(table: &Table<'_>) -> Result<Strategy> {
    match keys::SPEED_LOWER.entry(table).or(keys::SPEED_UPPER.entry(table)) {
        None => Ok(Strategy::Overlap),
        Some(entry) => Err(entry.error(
            "a speed has no meaning with strategy = \"overlap\"".to_owned(),
            Some("only positions count there; speeds belong to `strategy = \"shift\"`".to_owned()),
        )),
    }
}

fn shift(table: &Table<'_>) -> Result<Strategy> {
    let (speed_lower, speed_upper) = (keys::SPEED_LOWER.of(table)?, keys::SPEED_UPPER.of(table)?);
    if speed_lower == 0.0
        && speed_upper == 0.0
        && let Some(entry) = keys::SPEED_UPPER.entry(table)
    {
        return Err(entry.error("neither surface moves: both speeds are 0".to_owned(), None));
    }
    Ok(Strategy::Shift { speed_lower, speed_upper })
}

fn control(table: &Table<'_>, prescribed: Prescribed) -> Result<ControlKind> {
    let natural = match prescribed {
        Prescribed::Approach(_) => ControlKind::Approach,
        Prescribed::Load(_) | Prescribed::MeanPressure(_) => ControlKind::PassLoad,
    };
    let Some(entry) = keys::CONTROL.entry(table) else { return Ok(natural) };
    let kind = keys::CONTROL.required(table)?;
    match ((kind == ControlKind::Approach), (natural == ControlKind::Approach)) {
        (true, false) => Err(entry.unexpected(
            "\"pass-load\" or \"step-load\", as [contact] gives a load",
            Some("or give `approach` under [contact] instead of the load".to_owned()),
        )),
        (false, true) => Err(entry.unexpected(
            "\"approach\", as [contact] gives an approach",
            Some("or give `load` or `mean_pressure` under [contact] instead of the approach".to_owned()),
        )),
        _ => Ok(kind),
    }
}
