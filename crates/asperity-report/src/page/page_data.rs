//! What a results directory holds. What is missing or damaged is left out, and named.

use std::path::Path;

use asperity_contact::motion::{IncrementRecord, PassRecord, StepRecord, SweepRecord, UpdateRecord};
use asperity_study::io::fields::Fields;
use asperity_study::io::fs;
use asperity_study::{Case, Results, Summary};
use serde_json::Value;

use super::quantised::QuantisedField;
use super::shown_body::ShownBody;
use super::table::Table;
use super::witness::{Prepared, Seen};
use crate::draw::Charts;
use crate::error::Result;
use crate::words;

/// The records of a results directory.
pub(super) struct PageData<'a> {
    pub(super) results: &'a Results,
    pub(super) case: Case,
    /// The content of `case.json`.
    pub(super) resolved: Value,
    /// There once all is done.
    pub(super) summary: Option<Summary>,
    pub(super) passes: Vec<PassRecord>,
    /// Passes of the motion that are done before the first and after each of the computed ones.
    pub(super) done: Vec<usize>,
    pub(super) steps: Vec<StepRecord>,
    pub(super) increments: Vec<IncrementRecord>,
    pub(super) updates: Vec<UpdateRecord>,
    pub(super) points: Vec<SweepRecord>,
    /// What could not be read, and why.
    pub(super) missing: Vec<String>,
    /// Parts of the page made beside the figures, until they are taken.
    prepared: Option<Prepared>,
}

impl<'a> PageData<'a> {
    /// Reads the records; an error only without a case that can be read.
    pub(super) fn in_results(results: &'a Results, seen: Option<Seen>) -> asperity_base::Result<Self> {
        let mut missing = Vec::new();
        let (case, resolved) = (results.case()?, results.case_json()?);
        let finished = fs::exists(results.directory().join("summary.json"));
        let summary = if finished { ok_or_note(results.summary(), &mut missing) } else { None };
        let passes = ok_or_note(results.passes(), &mut missing).unwrap_or_default();
        Ok(Self {
            done: crate::figures::done(&passes),
            steps: ok_or_note(results.steps(), &mut missing).unwrap_or_default(),
            increments: ok_or_note(results.increments(), &mut missing).unwrap_or_default(),
            updates: ok_or_note(results.updates(), &mut missing).unwrap_or_default(),
            points: ok_or_note(results.sweep(), &mut missing).unwrap_or_default(),
            results,
            case,
            resolved,
            summary,
            passes,
            missing,
            prepared: seen.map(Seen::prepared),
        })
    }

    /// Maps of the contact, and the cells along a side of the blocks that they show.
    pub(super) fn take_maps(&mut self) -> Option<(Vec<(&'static str, QuantisedField)>, usize)> {
        self.prepared.as_mut().map(|prepared| (std::mem::take(&mut prepared.maps), prepared.block))
    }

    /// The section through the most loaded spot.
    pub(super) fn take_profile(&mut self) -> Option<Charts> {
        self.prepared.as_mut().and_then(|prepared| prepared.profile.take())
    }

    /// Lower and upper body.
    pub(super) fn take_bodies(&mut self) -> Option<[ShownBody; 2]> {
        std::mem::take(&mut self.prepared.as_mut()?.bodies).try_into().ok()
    }

    /// Pictures for who has no JavaScript, if they have been drawn.
    pub(super) fn pictures(&self) -> Option<&[(String, Vec<u8>)]> {
        self.prepared.as_ref().map(|prepared| &prepared.pictures[..])
    }

    /// Returns what was read. If that failed, notes the message and returns `None`.
    pub(super) fn ok_or_note<T>(&mut self, read: impl Into<ReadResult<T>>) -> Option<T> {
        ok_or_note(read, &mut self.missing)
    }

    /// A file of fields that is whole.
    pub(super) fn fields(&mut self, opened: asperity_base::Result<Fields>) -> Option<Fields> {
        self.ok_or_note(opened.and_then(|fields| fields.verify().map(|()| fields)))
    }

    /// The table of that file, if it is there.
    pub(super) fn table(&self, file: &str) -> Option<Table> {
        Table::read(&self.results.directory().join(file)).ok().filter(|table| table.len() > 0)
    }

    /// Whether all is done.
    pub(super) fn is_finished(&self) -> bool {
        self.summary.is_some()
    }

    pub(super) fn moves(&self) -> bool {
        self.case.motion.is_some()
    }

    pub(super) fn directory(&self) -> &Path {
        self.results.directory()
    }
}

/// A result of reading, with its message where it failed.
pub(super) struct ReadResult<T>(std::result::Result<T, String>);

impl<T> From<asperity_base::Result<T>> for ReadResult<T> {
    fn from(read: asperity_base::Result<T>) -> Self {
        Self(read.map_err(|error| words::clipped(&error.to_string())))
    }
}

impl<T> From<Result<T>> for ReadResult<T> {
    fn from(read: Result<T>) -> Self {
        Self(read.map_err(|failure| words::clipped(&failure.to_string())))
    }
}

fn ok_or_note<T>(read: impl Into<ReadResult<T>>, missing: &mut Vec<String>) -> Option<T> {
    match read.into().0 {
        Ok(read) => Some(read),
        Err(message) => {
            if !missing.contains(&message) {
                missing.push(message);
            }
            None
        }
    }
}
