//! The contacts of a course whose fields are kept.

use super::is_nth;
use asperity_contact::motion::StepRow;
use asperity_contact::with;

/// The points of a sweep, or the increments of a loading, whose fields are kept: each n-th, and the one that
/// the answers describe.
pub(super) struct KeptContacts {
    /// Interval n; 0 keeps none.
    every: usize,
    /// The number and the rank of the step that the answers describe, among those so far.
    answering: Option<(usize, f64)>,
}

impl KeptContacts {
    /// The choice before the first step of a course.
    pub(super) const fn new(every: usize) -> Self {
        Self { every, answering: None }
    }

    /// The choice after these steps, and a step whose fields may have been left when the course was
    /// interrupted.
    pub(super) fn after<'a>(every: usize, done: impl Iterator<Item = StepRow<'a>>) -> (Self, Option<usize>) {
        let (mut kept, mut left) = (Self::new(every), None);
        for (index, row) in done.enumerate() {
            left = kept.add(index + 1, row).or(left);
        }
        (kept, left)
    }

    /// Whether the next step is kept.
    pub(super) fn has(&self, number: usize, row: StepRow<'_>) -> bool {
        self.every > 0 && (is_nth(number, self.every) || self.rank(row).is_some())
    }

    /// The step that the answers describe.
    pub(super) fn answering(&self) -> Option<usize> {
        self.answering.map(|(number, _)| number)
    }

    /// Adds a step, and returns the one that is kept no longer.
    pub(super) fn add(&mut self, number: usize, row: StepRow<'_>) -> Option<usize> {
        let before = self.answering();
        self.answering = Some((number, self.rank(row)?));
        before.filter(|before| self.every > 0 && !is_nth(*before, self.every))
    }

    /// The rank of a step above all before it.
    fn rank(&self, row: StepRow<'_>) -> Option<f64> {
        with::answering_rank(row).filter(|rank| self.answering.is_none_or(|(_, most)| *rank > most))
    }
}
