//! The definition of a capability.

use std::borrow::Cow;
use std::fmt::Debug;

use serde::Serialize;
use serde::de::DeserializeOwned;

use super::views::{Answer, Curve, Line, Map};
use super::{BodyProperties, Capabilities, Listed, Observations};
use crate::error::Result;
use crate::grid::{Field, Grid};
use crate::material::Material;
use crate::motion::{CycleReport, Memory, ObservedContact, Pair, StepCell};
use crate::operator::Boundary;
use crate::solver::Params;
use crate::units::{MetrePerSecond, Pascal};
use asperity_base::record::{Column, Record};
use asperity_base::table::{self, Table};

/// Something that is computed from each solved contact and changes nothing. Its struct is the table of the
/// case.
pub trait Capability: Table + Serialize + Clone + PartialEq + Debug + Send + Sync + 'static {
    /// Name of its table in a case and in a summary, of its rows in `NAME.csv`, and of its field files
    /// `fields/NAME-NNNN.h5`.
    const NAME: &'static str;
    /// Heading of its section on the page.
    const TITLE: &'static str;
    /// Its meaning in the list of the tables of a case.
    const MEANING: &'static str;
    /// Name of what it computes in the rows of `asperity check`: "conducts".
    const VERB: &'static str;
    /// Whether it looks at whole load cycles, the passes of a motion or the cycles of a loading, instead of
    /// single contacts.
    const OF_LOAD_CYCLES: bool = false;

    /// A row of its table: what it has computed from a contact, or from a contact along one axis.
    type Row: Row;
    /// The computation of the rows.
    type Observer: Observer<Row = Self::Row>;

    /// Combinations that exclude it, and what it requires.
    const RULES: &'static [Rule<Self>];
    /// Its curves. The first answers the question that the user asked.
    const CURVES: &'static [Curve<Self::Row>];
    /// The maps of its fields.
    const MAPS: &'static [Map<Self::Row>];
    /// Keys of a body that it uses, without the others of their group.
    const CONSTANTS: &'static [&'static str];
    /// Prefixes of its columns in the table of a study, see [`Self::prefix`].
    const PREFIXES: &'static [&'static str];

    /// Interval of the positions of a pass, or of the increments, updates or points, that are looked at: 1
    /// for all of them; 0 for the position of full overlap of each pass, or for the last contact.
    fn every(&self) -> usize;

    /// Prepares the computation for the contacts of a pair of bodies.
    ///
    /// # Errors
    /// The reason why it is not possible.
    fn begin(&self, given: &Given<'_>) -> Result<Self::Observer>;

    /// Returns what it has to remember of load cycles, of a capability [of load
    /// cycles](Self::OF_LOAD_CYCLES).
    ///
    /// # Errors
    /// The reason why it is not possible.
    fn cycle_memory(&self, given: &Given<'_>) -> Result<Option<Box<dyn Memory>>> {
        let _ = given;
        Ok(None)
    }

    /// Number of fields that this memory keeps with each body.
    fn remembered(&self) -> usize {
        0
    }

    /// Returns the rows of a summary: those of the last contact or, after a motion, of its passes.
    fn summary(rows: &[Self::Row]) -> Vec<Self::Row>;

    /// Describes what is asked for, for `asperity check`.
    fn describe(&self, surroundings: &Surroundings) -> String;

    /// Returns the answers to the question of the user from the rows that [`answering`] selects.
    fn answers(&self, rows: &[Self::Row]) -> Vec<Answer>;

    /// Returns what the row of a pass on the terminal shows of its rows; of no rows the heads alone.
    fn cells(&self, rows: &[Self::Row]) -> Vec<StepCell> {
        let _ = rows;
        Vec::new()
    }

    /// Returns the numbers of a row.
    fn numbers(&self, row: &Self::Row) -> Vec<Line>;

    /// Returns reasons in the rows not to trust them.
    fn doubts(&self, rows: &[Self::Row], surroundings: &Surroundings) -> Vec<String>;

    /// Returns the prefix of the columns of a row in the table of a study, one of [`Self::PREFIXES`]; empty
    /// for a column that needs none.
    fn prefix(row: &Self::Row, column: &str) -> &'static str;

    /// Work of a contact for each cell and log₂ of their number, in units of a convolution with free
    /// boundary.
    fn effort(&self) -> f64;

    /// Memory of the computation from a contact, bytes.
    fn memory(shape: [usize; 2]) -> f64;
}

/// Returns the rows that answer the question of the user: those of all points of a sweep, of all positions of
/// the last pass of a motion, else of the last contact, because a loading history has other states at the
/// same pressure.
pub fn answering<C: Capability>(rows: &[C::Row], is_sweep: bool) -> Vec<C::Row> {
    match rows.last().and_then(Row::pass) {
        _ if is_sweep => rows.to_vec(),
        Some(pass) => rows.iter().filter(|row| row.pass() == Some(pass)).cloned().collect(),
        None => C::summary(rows),
    }
}

/// A capability with its rows among those of all capabilities.
pub trait Reported: Capability + Listed<Capabilities> {
    /// Returns its rows.
    fn rows(all: &Observations) -> &[Self::Row];

    /// Sets its rows.
    fn add(all: &mut Observations, rows: Vec<Self::Row>);
}

/// A row of a capability.
pub trait Row: Record + DeserializeOwned + Clone + PartialEq + Debug + Send + Sync {
    /// Its groups of columns, by the names of their records.
    const GROUPS: &'static [(&'static str, &'static [Column])];

    /// Pass of a motion, from 1; `None` for a static contact.
    fn pass(&self) -> Option<usize>;

    /// Last increment of a cycle of a loading, and the cycles that are done by then; `None` if the row is not
    /// that of a whole cycle.
    fn cycle(&self) -> Option<[usize; 2]> {
        None
    }

    /// Mean pressure over the apparent area.
    fn mean_pressure(&self) -> Pascal;
}

/// Computes the rows of a capability.
pub trait Observer: Send + Sync {
    /// A row.
    type Row;

    /// Computes the rows and the fields of a contact.
    ///
    /// # Errors
    /// The reason why they cannot be computed.
    fn observe(
        &self,
        place: Place,
        contact: &ObservedContact<'_>,
    ) -> Result<(Vec<Self::Row>, Vec<NamedField>)>;

    /// Computes the rows and the fields of a load cycle, of a capability [of load
    /// cycles](Capability::OF_LOAD_CYCLES).
    ///
    /// # Errors
    /// The reason why they cannot be computed.
    fn after_cycle(&self, report: &CycleReport<'_>) -> Result<(Vec<Self::Row>, Vec<BodyField>)> {
        let _ = report;
        Ok((Vec::new(), Vec::new()))
    }
}

/// Place of a contact in its course.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Place {
    /// Number of the pass, from 1; `None` for a static contact.
    pub pass: Option<usize>,
    /// Number of the position, increment, update or point, from 1, but from 0 for updates; 1 for a contact in
    /// one step.
    pub step: usize,
}

/// A field with its name in files.
#[derive(Debug, Clone)]
pub struct NamedField {
    /// The name.
    pub name: Cow<'static, str>,
    /// Unit of the values, SI.
    pub unit: Cow<'static, str>,
    /// The values, `[ix, iy]`.
    pub values: Field,
}

impl NamedField {
    /// Creates a field.
    pub fn new(
        name: impl Into<Cow<'static, str>>,
        unit: impl Into<Cow<'static, str>>,
        values: Field,
    ) -> Self {
        Self { name: name.into(), unit: unit.into(), values }
    }
}

/// A field of a body, with its name in files.
#[derive(Debug, Clone)]
pub struct BodyField {
    /// The name.
    pub name: String,
    /// Unit of the values, SI.
    pub unit: &'static str,
    /// The cells: those of the body, or those of a section along x into the depth.
    pub grid: Grid,
    /// The values, `[ix, iy]`, or `[ix, iz]` of a section.
    pub values: Field,
}

/// Constants of a body.
#[derive(Debug, Clone, PartialEq)]
pub struct BodyConstants {
    /// Elastic constants and the coating.
    pub material: Material,
    /// Thermal conductivity, W/(m K); `None` if it is unknown.
    pub conductivity: Option<f64>,
    /// Electrical resistivity, Ω m; `None` if it is unknown.
    pub resistivity: Option<f64>,
    /// Its other properties.
    pub properties: BodyProperties,
}

/// Surroundings of a contact: the constants of both bodies, and how they move.
#[derive(Debug, Clone, PartialEq)]
pub struct Surroundings {
    /// The lower and the upper body.
    pub bodies: [BodyConstants; 2],
    /// Continuation of the surfaces beyond the grid.
    pub boundary: Boundary,
    /// Whether the bodies move over each other in passes.
    pub moves: bool,
    /// Whether they do so by a circular shift.
    pub is_shift: bool,
    /// Whether all passes have the same bodies at the same positions.
    pub repeats: bool,
    /// Whether stages of a loading go there and come back, again and again.
    pub has_cycles: bool,
    /// Sum of the speeds at which both bodies move past the contact; `None` if it is unknown or they are at
    /// rest.
    pub dragging_speed: Option<MetrePerSecond>,
    /// Whether there is friction.
    pub has_friction: bool,
    /// Whether the shear changes the pressures in a way that depends on them: it displaces the bodies
    /// normally, or grows junctions of cells that may stick.
    pub shear_changes_pressures: bool,
    /// Whether a body deforms plastically below its surface.
    pub flows: bool,
    /// Whether a device solves the contact.
    pub on_device: bool,
}

impl Surroundings {
    /// Describes the contacts that an interval selects.
    pub fn often(&self, every: usize) -> String {
        match (self.moves, every) {
            (true, 0) => "once a pass".to_owned(),
            (true, 1) => "at each position".to_owned(),
            (true, every) => format!("at every {} position", ordinal(every)),
            (false, 0) => "of the last contact".to_owned(),
            (false, 1) => "of each contact".to_owned(),
            (false, every) => format!("of every {} contact", ordinal(every)),
        }
    }
}

/// Writes an ordinal number: `2nd`.
pub fn ordinal(number: usize) -> String {
    let ending = match (number % 10, number % 100) {
        (1..=3, 11..=13) => "th",
        (1, _) => "st",
        (2, _) => "nd",
        (3, _) => "rd",
        _ => "th",
    };
    format!("{number}{ending}")
}

/// Returns the rows of the last pass or cycle; all rows if they belong to none.
pub fn of_last<R: Row>(rows: &[R]) -> impl Iterator<Item = &R> {
    let last = rows.last().map(|row| (row.pass(), row.cycle()));
    rows.iter().filter(move |row| Some((row.pass(), row.cycle())) == last)
}

/// Everything that a capability gets before the first contact.
#[derive(Debug)]
pub struct Given<'a> {
    /// The bodies.
    pub pair: &'a Pair,
    /// Surroundings of the contacts.
    pub surroundings: Surroundings,
    /// Parameters of the solver.
    pub params: Params,
}

/// A combination that excludes a capability `C`, or something that it requires. It is broken only where its
/// key is given.
pub type Rule<C> = table::Rule<fn(&C, &Surroundings) -> bool>;

#[cfg(test)]
mod tests {
    use super::ordinal;

    #[test]
    fn ordinal_numbers_have_their_endings() {
        let numbers = [2, 3, 4, 10, 11, 12, 13, 21, 22, 103, 111, 1012];
        let words =
            ["2nd", "3rd", "4th", "10th", "11th", "12th", "13th", "21st", "22nd", "103rd", "111th", "1012th"];
        assert_eq!(numbers.map(ordinal), words);
    }
}
