//! Output of a run to its results directory.

use std::path::Path;

use serde_json::Value;

use super::Results;
use super::bodies::{add_bodies, add_volumes, set_caps};
use super::entry::{self, Existing, ExistingResults, NO_LOCKS};
use crate::fields::{NamedField, RestFields};
use crate::io::fields::FieldFile;
use crate::io::lock::Lock;
use crate::io::{atomic, fs, vti};
use crate::subsurface::{Plan, SubsurfaceRecord};
use crate::summary::Summary;
use crate::{identity, summary};
use asperity_base::choice::Choice;
use asperity_base::error::Result;
use asperity_base::grid::Placement;
use asperity_contact::motion::{Pair, PassRecord, PlasticResult, PlasticVolume};
use asperity_contact::solver::Friction;
use asperity_contact::subsurface::Tractions;
use asperity_contact::with::plasticity::Keep;

/// A results directory owned by one run. Other runs are refused until this is dropped, or until its process
/// ends.
#[derive(Debug)]
pub struct Writer {
    pub(super) results: Results,
    case: Value,
    pub(super) identity: String,
    kept: ExistingResults,
    lock: Lock,
}

impl Writer {
    /// Creates `directory` for the results of `case`, the content of its `case.json`, or enters an existing
    /// one. Existing files stay until [`Self::begin`].
    ///
    /// # Errors
    /// [`asperity_base::Error::ResultsExist`] if something must be kept,
    /// [`asperity_base::Error::WithinResults`], [`asperity_base::Error::InUse`] if another run writes there,
    /// [`asperity_base::Error::File`]. To resume results, also [`asperity_base::Error::OtherCase`] (more
    /// passes and another title are allowed), [`asperity_base::Error::SurfaceChanged`], and
    /// [`asperity_base::Error::NotResumable`] if a file is missing or belongs to another run.
    pub fn enter(directory: &Path, case: &Value, existing: Existing) -> Result<Self> {
        Self::enter_with(directory, case, existing, None)
    }

    /// [`enter`](Self::enter) with a `lock` of the directory that is held already.
    pub(crate) fn enter_with(
        directory: &Path,
        case: &Value,
        existing: Existing,
        lock: Option<Lock>,
    ) -> Result<Self> {
        let (lock, kept) = entry::enter(directory, case, existing, lock)?;
        let results = Results { directory: directory.to_owned() };
        let mut case = case.clone();
        if let (ExistingResults::Passes(_), Some(passes)) = (kept, case.pointer_mut("/motion/passes")) {
            // Finished passes beyond those of the case stay.
            let finished: usize = results.passes()?.iter().map(PassRecord::represents).sum();
            *passes = passes.as_u64().unwrap_or(0).max(finished as u64).into();
        }
        Ok(Self { results, identity: identity::identity_of(&case), case, kept, lock })
    }

    /// The case of the results, the content of `case.json`: it has at least as many passes as are finished.
    pub(crate) fn case(&self) -> &Value {
        &self.case
    }

    /// Clears replaced files and remains of killed runs, and writes `case.json`.
    ///
    /// # Errors
    /// [`asperity_base::Error::File`].
    pub fn begin(&self) -> Result<()> {
        let fields = self.results.fields_folder();
        entry::clear(&self.results, self.kept, self.keep())?;
        for directory in [self.results.directory(), &fields, &self.results.figures_folder()] {
            atomic::sweep(directory);
        }
        let text = serde_json::to_vec_pretty(&self.case).expect("a JSON value can be written");
        atomic::replace(&self.results.case_path(), &text)
    }

    /// The existing results.
    pub fn results(&self) -> &Results {
        &self.results
    }

    /// The identity of the run.
    pub(crate) fn identity(&self) -> &str {
        &self.identity
    }

    /// Returns the warning about the directory, if any.
    pub fn warning(&self) -> Option<&'static str> {
        (!self.lock.binds()).then_some(NO_LOCKS)
    }

    /// Writes the summary.
    ///
    /// # Errors
    /// [`asperity_base::Error::File`].
    pub fn finish(&self, content: &Summary) -> Result<()> {
        summary::write(&self.results.summary_path(), content)
    }

    /// Writes the fields of a static contact.
    ///
    /// # Errors
    /// [`asperity_base::Error::File`].
    pub fn write_rest(&self, contact: RestFields) -> Result<()> {
        let mut file = self.field_file(&self.results.static_path());
        file.set("approach", contact.approach).set("hardness", contact.hardness);
        for NamedField { name, unit, values } in contact.fields {
            file.add_field(&name, &unit, &contact.grid, [0.0, 0.0], &values);
        }
        file.write()
    }

    /// Writes the plastic state below the surfaces of a static contact.
    ///
    /// # Errors
    /// [`asperity_base::Error::File`].
    pub(crate) fn write_plastic(&self, contact: &PlasticResult) -> Result<()> {
        let mut file = self.field_file(&self.results.volume_path(None));
        let left = if contact.residual.is_empty() { &contact.volumes } else { &contact.residual };
        add_volumes(&mut file, &contact.volumes, left);
        file.write()
    }

    /// Computes and writes the stress under the surface of a static contact with these `tractions` on its
    /// lower body, and with the plastic state of its bodies.
    ///
    /// # Errors
    /// [`asperity_base::Error::File`].
    pub(crate) fn write_subsurface(
        &self,
        plan: &Plan,
        tractions: Tractions,
        plastic_volumes: &[PlasticVolume],
    ) -> Result<SubsurfaceRecord> {
        let placement = Placement::flush(plan.grid.shape);
        let plastic_state = plastic_volumes.iter().find(|volume| volume.body == plan.side());
        let plastic_state = plastic_state.map(|volume| (&volume.state, &placement));
        let path = self.results.subsurface_path(None);
        plan.write(self.field_file(&path), &path, None, tractions, plastic_state)
    }

    /// Writes the bodies before the first pass; they slide under `friction`.
    ///
    /// # Errors
    /// [`asperity_base::Error::File`].
    pub fn write_initial(&self, pair: &Pair, friction: Option<&Friction>) -> Result<()> {
        let mut file = self.field_file(&self.results.fields_path(0));
        file.set("pass", 0);
        set_caps(&mut file, pair.min_hardness(), friction);
        add_bodies(&mut file, pair);
        file.write()
    }

    /// Also writes each field file as image data for ParaView, unless that exists.
    ///
    /// # Errors
    /// [`asperity_base::Error::File`].
    pub fn write_for_paraview(&self) -> Result<()> {
        let finished = self.results.passes()?.len();
        let passes = (0..=finished).filter(|_| finished > 0).map(|pass| self.results.fields_path(pass));
        let points = self.results.sweep()?.into_iter().map(|point| self.results.point_path(point.point));
        let increments = self.results.increments()?.into_iter();
        let increments = increments.map(|increment| self.results.increment_path(increment.increment));
        let at_rest = points.chain(increments).chain([self.results.static_path()]);
        let all = passes.chain(at_rest).filter(|path| fs::exists(path));
        for path in all.filter(|path| !fs::exists(path.with_extension("vti"))) {
            vti::write_fields(&path)?;
        }
        Ok(())
    }

    /// The passes whose plastic volumes are kept.
    pub(super) fn keep(&self) -> Keep {
        let word = self.case.pointer("/plasticity/keep").and_then(Value::as_str);
        word.and_then(Keep::of_word).unwrap_or(Keep::Last)
    }

    /// Creates a field file with the identity of its run.
    fn field_file(&self, path: &Path) -> FieldFile {
        FieldFile::of_run(&self.identity, path)
    }
}
