//! What the user asked for, before the contact itself: the answers of capabilities, of adhesion and of the laws of the bodies.

use asperity_contact::each_capability;
use asperity_contact::with::views::Answer;
use asperity_contact::with::{self, Capability, Listed, adhesion, answering};
use asperity_study::Outcome;

use super::found::PageData;

/// The answers, the first of which is that to the question of the case.
pub(super) fn all(found: &PageData) -> Vec<Answer> {
    let mut answers = Vec::new();
    each_capability!(C => if let Some(asked) = C::of(&found.case.with) {
        let rows = found.results.rows::<C>().unwrap_or_default();
        answers.extend(asked.answers(&answering::<C>(&rows, !found.points.is_empty())));
    });
    let outcome = found.summary.as_ref().map(|summary| &summary.outcome);
    if let Some(Outcome::Static(record)) = outcome {
        let numbers = found.summary.as_ref().and_then(|summary| summary.adhesion.as_ref());
        answers.extend(record.adhesion.iter().flat_map(|attraction| adhesion::answers(numbers, attraction)));
        answers.extend(record.fretting.iter().flat_map(with::after_cycles));
    }
    answers.extend(with::after_points(&found.points));
    answers.extend(with::after_increments(&found.increments));
    answers.extend(with::after_passes(&found.passes));
    answers.extend(found.updates.last().into_iter().flat_map(with::after_sliding));
    answers
}
