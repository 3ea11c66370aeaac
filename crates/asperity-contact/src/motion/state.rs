//! States of static courses: everything that the next step depends on.

use std::borrow::Cow;

use crate::grid::Field;
use crate::motion::fretting::ChangedBodies;
use crate::motion::pair::Pair;
use crate::motion::record::{IncrementRecord, StaticRecord, UpdateRecord};
use crate::motion::stage::{Origin, Progress};
use crate::solver::Equilibrium;
use crate::units::{Joule, Metre};

/// A static contact at the end of its loading, with its history.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct LoadedContact {
    /// The record of the contact at the end of its loading.
    pub record: StaticRecord,
    /// The increments of the loading; empty for a rolling contact.
    pub increments: Vec<IncrementRecord>,
    /// The solution at the end of the loading.
    pub solution: Equilibrium,
    /// Plastic interference of both bodies together, m.
    pub plastic: Field,
    /// Sum of the slip of all increments along x and y, m; in rolling, the slip while the contact moves on by a cell;
    /// `None` without friction.
    pub slip: Option<[Field; 2]>,
    /// Bound on the error of the frictional energy in the record, without the contribution of the first increment: see
    /// [`FrictionalSolution::dissipation_error`](crate::solver::FrictionalSolution::dissipation_error).
    pub dissipation_error: Joule,
    /// Bodies that laws have changed; `None` if none did.
    pub changed: Option<ChangedBodies>,
}

/// State of a loading: everything that its next increment depends on.
#[derive(Debug, Clone)]
pub struct LoadingState {
    /// The increments done so far.
    pub increments: Vec<IncrementRecord>,
    /// The contact at the end of the last increment.
    pub contact: Equilibrium,
    /// Load, approach, force and displacement at the beginning of the current stage.
    pub origin: Origin,
    /// The plastic interference of the cells.
    pub flattening: Flattening,
    /// Sum of the slip of all increments along x and y, m; `None` without friction.
    pub slip: Option<[Field; 2]>,
    /// Sum over the increments of [`FrictionalSolution::dissipation_error`](crate::solver::FrictionalSolution::dissipation_error).
    pub dissipation_error: Joule,
    /// The next increment.
    pub next: Progress,
    /// Bodies that laws have changed; `None` without laws.
    pub changed: Option<ChangedBodies>,
}

/// Plastic interference of the cells of a contact over its loading.
#[derive(Debug, Clone)]
pub struct Flattening {
    /// Permanent plastic flattening, m: both bodies are lowered by it together. `None` before plastic cells are first
    /// unloaded.
    pub kept: Option<Field>,
    /// Largest plastic interference of each cell, m, on the surfaces lowered by `kept`.
    pub deepest: Field,
}

impl Flattening {
    /// Returns the initial gap of the permanently lowered surfaces.
    pub fn open<'a>(&self, gap: &'a Field) -> Cow<'a, Field> {
        match &self.kept {
            None => Cow::Borrowed(gap),
            Some(kept) => Cow::Owned(gap + kept),
        }
    }

    /// Whether the interference of some cell has been larger than `now` by more than `allowed`.
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

    /// Updates the largest interference of each cell with the present contact.
    pub(super) fn deepen(&mut self, now: &Field) {
        self.deepest.zip_mut_with(now, |deepest, now| *deepest = deepest.max(*now));
    }

    /// Returns the total plastic interference, with `now` that of the present contact.
    pub fn total(&self, now: Field) -> Field {
        match &self.kept {
            None => now,
            Some(kept) => kept + &now,
        }
    }
}

/// State of a contact after its updates so far: everything that the next one depends on.
#[derive(Debug, Clone)]
pub struct SlidingState {
    /// The bodies in their present state.
    pub pair: Pair,
    /// The updates so far; the first is the contact before sliding.
    pub updates: Vec<UpdateRecord>,
    /// Pressure of the last update, Pa.
    pub pressure: Field,
}
