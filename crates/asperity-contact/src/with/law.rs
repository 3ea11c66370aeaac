//! The definition of a law that changes a body, as a table of the body.

use std::fmt::Debug;

use serde::Serialize;

use super::BodyLaws;
use super::views::{Answer, Kept, OfBodies, PassCell};
use crate::error::Result;
use crate::motion::{FrettingRecord, Law, Pair, PassRecord, UpdateRecord};
use crate::units::{Metre, Pascal, PerPascal, SquareMetre};
use asperity_base::table::{self, Source, Table};

/// Something that contacts do to a body, such as a film. Its struct is the table `[lower.NAME]` and
/// `[upper.NAME]` of a case.
pub trait BodyLaw: Table + Serialize + Clone + PartialEq + Debug + Send + Sync + 'static {
    /// Name of its table, and of the law in results.
    const NAME: &'static str;
    /// Its meaning in the list of the keys of a body.
    const MEANING: &'static str;
    /// Combinations that exclude it, and what it requires.
    const RULES: &'static [LawRule<Self>];
    /// Work on a cell of a body in contact at a position, in the unit of effort; 0 if it does not matter
    /// beside the contact.
    const EFFORT: f64;

    /// Fields that it leaves on a body.
    const KEPT: &'static [Kept];
    /// Its column in the table of passes on the terminal.
    const CELL: PassCell;
    /// Its curves over the passes.
    const OF_PASSES: &'static [OfBodies<PassRecord>];
    /// Its curves over the updates of a contact that slides in place.
    const OF_UPDATES: &'static [OfBodies<UpdateRecord>];
    /// Its curves over the cycles of a loading, and its numbers at the end.
    const OF_CYCLES: &'static [OfBodies<FrettingRecord>];

    /// Returns the law as it is on a body. `hardness` is that of the body, if it is one finite number.
    ///
    /// # Errors
    /// A value that is not accepted on this body, at its place.
    fn on(self, hardness: Option<Pascal>, source: &dyn Source) -> Result<Self> {
        let _ = (hardness, source);
        Ok(self)
    }

    /// Creates the law of the lower and of the upper body; `None` if neither has it.
    ///
    /// # Errors
    /// The reason why it does not apply to a body.
    fn law(bodies: [&BodyLaws; 2], pair: &Pair) -> Result<Option<Box<dyn Law>>>;

    /// Depth that the body loses per pressure and distance slid, 1/Pa, with shear equal to `friction` times
    /// the pressure.
    fn per_pressure(&self, friction: f64) -> PerPascal {
        let _ = friction;
        0.0
    }

    /// Describes the law, for `asperity check`.
    fn describe(&self) -> String;

    /// Returns a result of a pass on the lower and on the upper body, each with the bound up to which the
    /// model holds for it.
    fn limit_in_pass(pass: &PassRecord, surfaces: &ChangedSurfaces) -> [[Metre; 2]; 2];

    /// Returns a result of an update with its bound, as [`BodyLaw::limit_in_pass`] does.
    fn limit_in_update(update: &UpdateRecord, surfaces: &ChangedSurfaces) -> [[Metre; 2]; 2] {
        let _ = (update, surfaces);
        [[0.0; 2]; 2]
    }

    /// Returns the warning about a result beyond its bound on the body of this name.
    fn beyond_limit(body: &str, value: Metre, bound: Metre) -> String;

    /// Returns what these passes have done, if it answers a question of the user.
    fn after_passes(passes: &[PassRecord]) -> Option<Answer> {
        let _ = passes;
        None
    }

    /// Returns what cycles of slip have done.
    fn after_cycles(cycles: &FrettingRecord) -> Option<Answer> {
        let _ = cycles;
        None
    }

    /// Returns what sliding in place has done up to the last of the updates, which begin before it slides.
    fn after_sliding(updates: &[UpdateRecord]) -> Option<Answer> {
        let _ = updates;
        None
    }
}

/// Surfaces that laws have changed in a step.
#[derive(Debug, Clone, Copy)]
pub struct ChangedSurfaces {
    /// Area of the lower and of the upper body.
    pub area: [SquareMetre; 2],
    /// Rms height of the lower and of the upper body after the step.
    pub sq: [Metre; 2],
    /// Depth that a cell may lose in one pass.
    pub removal: Metre,
}

/// A body that has a law, in its case.
#[derive(Debug, Clone, Copy)]
pub struct Circumstances<'a> {
    /// All laws of the body.
    pub laws: &'a BodyLaws,
    /// Whether a cell of it can yield at a hardness.
    pub yields: bool,
    /// Whether there is friction.
    pub has_friction: bool,
    /// Whether the temperatures of the bodies are known.
    pub has_temperature: bool,
    /// Whether one of the bodies relaxes.
    pub relaxes: bool,
    /// How the bodies slip on each other.
    pub slip: Slip,
    /// The quantity that is missing to know the time of the steps; `None` if the time is known.
    pub timeless: Option<Timeless>,
}

/// How the bodies slip on each other.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Slip {
    /// Not at all, or all at once without a distance.
    None,
    /// In passes over each other.
    InPasses,
    /// In passes in which both bodies roll without sliding.
    Rolling,
    /// In place, all cells alike.
    InPlace,
    /// In the stages of a loading with friction, each cell by its own distance.
    InStages,
}

/// A missing time.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Timeless {
    /// The speed of a contact that slides in place.
    InPlace,
    /// Cycles in the stages of a loading.
    Cycles,
    /// The time of a cycle.
    Period,
    /// The speed of an overlap.
    Overlap,
    /// The speeds of a shift.
    Shift,
}

/// A combination that excludes a law `L`, or something that it requires. A key `lower.…` stands for that of
/// the body.
pub type LawRule<L> = table::Rule<fn(&L, &Circumstances<'_>) -> bool>;
