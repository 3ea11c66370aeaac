//! What courses at rest have come to: all that the next step depends on.

use std::borrow::Cow;

use crate::grid::Field;
use crate::motion::pair::Pair;
use crate::motion::record::{IncrementRecord, StaticRecord, UpdateRecord};
use crate::solver::Equilibrium;
use crate::units::{Joule, Metre, Newton};

/// A static contact at the end of its loading, with the history of it.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct LoadedContact {
    /// The contact at the end of its loading, in numbers.
    pub record: StaticRecord,
    /// The increments of the loading; none of a rolling contact.
    pub increments: Vec<IncrementRecord>,
    /// The solution at the end of the loading.
    pub solution: Equilibrium,
    /// Plastic interference that both bodies have taken up together, m.
    pub plastic: Field,
    /// Slip of all increments together along x and y, m; in rolling, while the contact moves on by a cell; none without
    /// friction.
    pub slip: Option<[Field; 2]>,
    /// How far the energy that friction took may be from what the record says, but for what the first increment brings:
    /// see [`FrictionalSolution::dissipation_error`](crate::solver::FrictionalSolution::dissipation_error).
    pub dissipation_error: Joule,
}

/// A loading under way: all that its next increment depends on.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct LoadingState {
    /// The increments done so far.
    pub increments: Vec<IncrementRecord>,
    /// The contact at the end of the last increment.
    pub contact: Equilibrium,
    /// Load, approach, force and displacement where the stage of the last increment began.
    pub origin: Origin,
    /// The plastic interference that the cells have taken up.
    pub flattening: Flattening,
    /// Slip of all increments together along x and y, m; none without friction.
    pub slip: Option<[Field; 2]>,
    /// Sum over the increments of [`FrictionalSolution::dissipation_error`](crate::solver::FrictionalSolution::dissipation_error).
    pub dissipation_error: Joule,
}

/// What the cells of a contact have taken up plastically in the course of its loading.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Flattening {
    /// What plastic flow has taken away for good, m: both bodies are lowered by it together. None before plastic
    /// cells are first unloaded.
    pub kept: Option<Field>,
    /// Largest plastic interference of each cell, m, on the surfaces so lowered.
    pub deepest: Field,
}

impl Flattening {
    /// The initial gap of the surfaces as they are lowered for good.
    pub(crate) fn open<'a>(&self, gap: &'a Field) -> Cow<'a, Field> {
        match &self.kept {
            None => Cow::Borrowed(gap),
            Some(kept) => Cow::Owned(gap + kept),
        }
    }

    /// Whether some cell has had a larger interference than `now`, by more than is `allowed`.
    pub(super) fn exceeds(&self, now: &Field, allowed: Metre) -> bool {
        self.deepest.iter().zip(now).any(|(deepest, now)| deepest - now > allowed)
    }

    /// Lowers the surfaces by the largest interference of each cell.
    pub(super) fn keep(&mut self) {
        let virgin = Field::zeros(self.deepest.raw_dim());
        let deepest = std::mem::replace(&mut self.deepest, virgin);
        self.kept = Some(match self.kept.take() {
            None => deepest,
            Some(kept) => kept + deepest,
        });
    }

    /// Raises the largest interference of each cell to that of the present contact.
    pub(super) fn deepen(&mut self, now: &Field) {
        self.deepest.zip_mut_with(now, |deepest, now| *deepest = deepest.max(*now));
    }

    /// All of the plastic interference taken up, that of the present contact being `now`.
    pub(super) fn whole(&self, now: Field) -> Field {
        match &self.kept {
            None => now,
            Some(kept) => kept + &now,
        }
    }
}

/// The state in which a stage begins, in each quantity that it may prescribe.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Origin {
    /// Normal force.
    pub load: Newton,
    /// Rigid-body approach.
    pub approach: Metre,
    /// Force of the upper body on the lower one along x and y.
    pub force: [Newton; 2],
    /// Rigid-body displacement of the upper body against the lower one along x and y.
    pub displacement: [Metre; 2],
}

/// A contact after its updates so far: all that the next one depends on.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct SlidingState {
    /// The bodies as they are now.
    pub pair: Pair,
    /// The updates so far, the first of which is the contact before it slides.
    pub updates: Vec<UpdateRecord>,
    /// Pressure of the last update, Pa.
    pub pressure: Field,
}
