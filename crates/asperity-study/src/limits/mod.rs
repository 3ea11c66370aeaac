//! The limits of the model, compared with results while they come.
//!
//! A limit is a row of [`table::limits`]: the quantity that it bounds and the sentence that says how it was
//! exceeded. Its bound, with the reason, is a field of [`Bounds`]. The first step that exceeds a limit is a
//! row of `limits.csv`, which is written before the row of the step itself, and the sentence goes to the
//! watch at once. A limit is reported once. A body that is no longer a surface at all is an error of
//! `motion::worn_away`.

mod bounds; // the bounds of a case
mod findings; // the quantities of a step
mod table; // the limits: what exceeds them, and what a warning says

use crate::case::{Case, Course};
use crate::estimate::Estimate;
use crate::limit::{BrokenLimit, LIMITS_TABLE};
use crate::results::Writer;
use crate::tables::{self, GrowingTable};
use asperity_base::error::Result;
use asperity_contact::motion::{Output, Pair, Step};
use asperity_contact::solver::Solution;

use bounds::Bounds;
use findings::{ContactFindings, Finding, Findings};
use table::Row;

impl BrokenLimit {
    /// Returns the warning about it, for a result of `case`.
    pub fn sentence(&self, case: &Case) -> String {
        let limits = table::limits();
        let row = limits.iter().find(|row| row.limit == self.limit).expect("a row for each limit");
        self.place(case) + &(row.says)(case, self)
    }

    /// Returns the place of the result as the beginning of a sentence; empty for a contact in one step.
    fn place(&self, case: &Case) -> String {
        match (self.pass, self.step, case.course(1.0)) {
            (Some(pass), Some(position), _) => format!("pass {pass}, position {position}: "),
            (Some(pass), None, _) => format!("pass {pass}: "),
            (None, Some(step), course @ (Course::InPlace(_) | Course::Sweep(_))) => {
                format!("{} {step}: ", course.step())
            }
            (None, Some(step), course @ Course::Stages(_)) if course.keeps_steps() => {
                format!("{} {step}: ", course.step())
            }
            (None, ..) => String::new(),
        }
    }
}

/// The limits of a case, and what has exceeded them.
pub(super) struct Limits {
    case: Case,
    bounds: Bounds,
    broken: Vec<BrokenLimit>,
    /// Number of limits that the step received last exceeds for the first time.
    new: usize,
    table: Option<GrowingTable>,
}

impl Limits {
    /// Creates the limits of a `case` with these bodies before its first step. With a `writer` broken limits
    /// go to its table, after those of the steps that are `done`.
    ///
    /// # Errors
    /// [`asperity_base::Error::File`].
    pub(super) fn new(
        case: &Case,
        pair: &Pair,
        estimate: &Estimate,
        (writer, done): (Option<&Writer>, Option<usize>),
    ) -> Result<Self> {
        let (bounds, case) = (Bounds::new(case, pair, estimate), case.clone());
        let Some(writer) = writer else {
            return Ok(Self { case, bounds, broken: Vec::new(), new: 0, table: None });
        };
        let path = writer.results().observer_table(LIMITS_TABLE);
        let column = if case.course(1.0).moves() { "pass" } else { "step" };
        let rows = done.map_or(Ok(0), |done| tables::rows_up_to(&path, column, done))?;
        let mut broken = writer.results().broken_limits()?;
        broken.truncate(rows);
        Ok(Self { case, bounds, broken, new: 0, table: Some(GrowingTable::open(path, rows)?) })
    }

    /// Compares a contact that is solved in one step with the limits.
    ///
    /// # Errors
    /// [`asperity_base::Error::File`].
    pub(super) fn contact(&mut self, solution: &Solution) -> Result<()> {
        self.compare(&Findings { contacts: vec![ContactFindings::new(1, solution)], ..Findings::default() })
    }

    /// Returns a warning for each broken limit.
    pub(super) fn all(&self) -> Vec<String> {
        self.broken.iter().map(|broken| broken.sentence(&self.case)).collect()
    }

    fn compare(&mut self, findings: &Findings<'_>) -> Result<()> {
        let is_new = |row: &&Row| self.broken.iter().all(|broken| broken.limit != row.limit);
        let broken = |row: &Row| {
            let Finding { step, body, value, bound } = (row.exceeds)(&self.bounds, findings)?;
            Some(BrokenLimit { pass: findings.pass, step, limit: row.limit, body, value, bound })
        };
        let new: Vec<BrokenLimit> = table::limits().iter().filter(is_new).filter_map(broken).collect();
        if let (Some(table), false) = (&mut self.table, new.is_empty()) {
            table.add(&new)?;
        }
        self.new = new.len();
        self.broken.extend(new);
        Ok(())
    }
}

impl Output for Limits {
    fn step(&mut self, step: &Step<'_>) -> Result<()> {
        self.compare(&Findings::from_step(step))
    }

    fn warnings(&self) -> Vec<String> {
        let new = &self.broken[self.broken.len() - self.new..];
        new.iter().map(|broken| broken.sentence(&self.case)).collect()
    }
}
