//! `[motion]`: motion of the bodies.

use super::cursor::Table;
use super::schema::moving::motion as keys;
use super::schema::tables::known_in;
use super::{ControlKind, MotionSpec, OffsetY, Prescribed, StrategyKind};
use asperity_base::error::Result;
use asperity_contact::motion::Strategy;

pub(super) fn motion(table: &Table<'_>, prescribed: Prescribed) -> Result<MotionSpec> {
    known_in(table)?;
    let natural = match prescribed {
        Prescribed::Approach(_) => ControlKind::Approach,
        Prescribed::Load(_) | Prescribed::MeanPressure(_) => ControlKind::PassLoad,
    };
    let strategy = match keys::STRATEGY.of(table)? {
        StrategyKind::Shift => shift(table)?,
        StrategyKind::Overlap => Strategy::Overlap,
    };
    let offset_y = match keys::OFFSET_Y.of(table)? {
        Some(cells) => OffsetY::Cells(cells),
        None => OffsetY::Random { seed: keys::SEED.of(table)? },
    };
    Ok(MotionSpec {
        strategy,
        passes: keys::PASSES.of(table)?,
        stride: keys::STRIDE.of(table)?,
        control: keys::CONTROL.of(table)?.unwrap_or(natural),
        plastic_update: keys::PLASTIC_UPDATE.of(table)?,
        load_tolerance: keys::LOAD_TOLERANCE.of(table)?,
        speed: keys::SPEED.of(table)?,
        pause: keys::PAUSE.of(table)?,
        path: keys::PATH.of(table)?,
        offset_y,
        counter: keys::COUNTER.of(table)?,
    })
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
