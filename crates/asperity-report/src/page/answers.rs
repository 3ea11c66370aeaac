//! What the user asked for, before the contact itself: the answers of capabilities, of the interface and of
//! the laws of the bodies.

use asperity_contact::each;
use asperity_contact::with::views::Answer;
use asperity_contact::with::{self, Capability, Listed, answering};
use asperity_study::Outcome;

use super::page_data::PageData;

/// The answers, the first of which is that to the question of the case.
pub(super) fn all(found: &PageData) -> Vec<Answer> {
    let mut answers = Vec::new();
    each!(capability C => if let Some(asked) = C::of(&found.case.with) {
        let rows = found.results.rows::<C>().unwrap_or_default();
        answers.extend(asked.answers(&answering::<C>(&rows, !found.points.is_empty())));
    });
    if let Some(summary) = &found.summary
        && let Outcome::Static(record) = &summary.outcome
    {
        answers.extend(record.interface.iter().flat_map(|record| summary.interface.answers(record)));
        answers.extend(record.fretting.iter().flat_map(with::after_cycles));
    }
    answers.extend(with::after_points(&found.points));
    answers.extend(with::after_increments(&found.increments));
    answers.extend(with::after_passes(&found.passes));
    answers.extend(with::after_sliding(&found.updates));
    answers
}
