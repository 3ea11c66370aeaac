//! Plan of a study: the values of each of its cases.

use std::collections::BTreeSet;
use std::fmt::Write as _;
use std::path::Path;

use rayon::prelude::*;

use super::axis::Axis;
use super::named_file::NamedFile;
use super::study_file::{self, StudyFile};
use crate::case::{Case, Device};
use crate::cell::quoted;
use crate::estimate::check_plastic_limit;
use crate::io::sha256;
use crate::prepare::grids;
use crate::surface_input::SurfaceInput;
use asperity_base::error::{CaseError, Error, Result};

/// Largest number of cases of a study, before exclusions.
pub const MAX_CASES: usize = 10_000_000;

/// A study: a base case, and the values that replace those of the base in each case.
///
/// Cases are numbered from 1. The first axis changes slowest.
#[derive(Debug)]
pub struct Study {
    file: StudyFile,
    /// Index of a value of each axis, case after case.
    indices: Vec<u32>,
}

impl Study {
    /// Reads a study file and makes its plan. Every value of every axis is tried in one case, so that
    /// mistakes are reported before anything is computed. Mistakes that depend on several values, or on the
    /// content of files, are reported when the case runs.
    ///
    /// # Errors
    /// [`Error::File`] if a file cannot be read, [`Error::Case`] if the study, its table or its base has a
    /// mistake.
    pub fn load(path: &Path) -> Result<Self> {
        Self::of(study_file::load(path)?)
    }

    /// Makes a study from the text of a study file. `path` is its name in errors; paths of files are relative
    /// to its folder.
    ///
    /// # Errors
    /// The errors of [`Study::load`].
    pub fn parse(text: &str, path: &Path) -> Result<Self> {
        Self::of(study_file::read(text, path)?)
    }

    /// Makes a study of these cases of the case file at `path`: the values of each key, case after case. `change` prepares
    /// the base.
    ///
    /// # Errors
    /// The errors of [`Study::load`].
    pub(crate) fn of_cases(
        path: &Path,
        keys: Vec<(String, Vec<toml::Value>)>,
        change: impl FnOnce(&mut toml::Table),
    ) -> Result<Self> {
        Self::of(study_file::of_cases(path, keys, change)?)
    }

    fn of(file: StudyFile) -> Result<Self> {
        let indices = indices(&file)?;
        let study = Self { file, indices };
        study.check()?;
        Ok(study)
    }

    /// Returns the study as it is solved by another device.
    ///
    /// # Errors
    /// [`Error::Case`] if this device does not solve a case.
    pub fn on(mut self, device: Device) -> Result<Self> {
        self.file.base.on(device)?;
        self.check()?;
        Ok(self)
    }

    /// Opens the devices of the cases, so that one that is not there is reported before anything is computed.
    ///
    /// # Errors
    /// [`Error::NoDevice`], [`Error::DeviceFailed`], and those of the cases.
    pub fn open_devices(&self) -> Result<()> {
        let differ = self.axes().iter().any(|axis| ["contact", "contact.device"].contains(&axis.key()));
        let cases = if differ { self.tried() } else { vec![1] };
        cases.into_iter().try_for_each(|number| self.case(number)?.contact.device.card().map(drop))
    }

    /// The title; by default the file name.
    pub fn title(&self) -> &str {
        &self.file.title
    }

    /// The axes of the grid, then those of the table.
    pub fn axes(&self) -> &[Axis] {
        &self.file.axes
    }

    /// Number of cases.
    #[expect(clippy::len_without_is_empty, reason = "a study without cases is refused")]
    pub fn len(&self) -> usize {
        self.indices.len() / self.axes().len()
    }

    /// Returns the index of the value of each axis in a case, from 1.
    ///
    /// # Panics
    /// If there is no such case.
    pub fn indices(&self, case: usize) -> &[u32] {
        let axes = self.axes().len();
        &self.indices[(case - 1) * axes..case * axes]
    }

    /// Returns the values of a case, from 1, for people: `contact.load = 2 N, friction.coefficient = 0.1`.
    pub fn text(&self, case: usize) -> String {
        let values = self.axes().iter().zip(self.indices(case));
        let values = values.map(|(axis, index)| format!("{} = {}", axis.key(), axis.text(*index as usize)));
        values.collect::<Vec<_>>().join(", ")
    }

    /// Returns the case file of a case, from 1. `folder` is its future place; without one, files are relative
    /// to the working directory.
    ///
    /// # Errors
    /// [`Error::Case`] if a value cannot be inserted in the base.
    pub fn case_file(&self, case: usize, folder: Option<&Path>) -> Result<String> {
        let title = format!("{}, case {case}: {}", self.title(), self.text(case));
        let values = self.axes().iter().zip(self.indices(case));
        let values = values.map(|(axis, index)| (axis, axis.value(*index as usize)));
        self.file
            .base
            .with(&title, values, folder)
            .map_err(|(axis, message)| self.error_at(case, axis, &message, None))
    }

    /// Returns the cases whose load is known to exceed the plastic limit before anything is computed, and the
    /// error of each. In a study of more than 1000 cases, only the first case with each value of each axis is
    /// checked. Hardness maps are not read.
    pub fn beyond_plastic_limit(&self) -> Vec<(usize, Error)> {
        const ALL: usize = 1000;
        let looked_at = if self.len() <= ALL { (1..=self.len()).collect() } else { self.tried() };
        let beyond = |number: usize| {
            let case = self.case(number).ok()?;
            // A file that is missing is reported when the case runs.
            let grids = grids(&case, &SurfaceInput::default()).ok()?;
            let error = check_plastic_limit(&case, grids).err()?;
            matches!(error, Error::BeyondPlasticLimit { .. }).then_some((number, error))
        };
        looked_at.into_par_iter().filter_map(beyond).collect()
    }

    /// Numbers the cases in another order, from 0.
    pub(super) fn in_order(self, order: &[usize]) -> Self {
        let indices = order.iter().flat_map(|case| self.indices(case + 1)).copied().collect();
        Self { indices, ..self }
    }

    /// Writes the plan as CSV: for each case a row with its number and the values of its axes. A text that a
    /// spreadsheet would read as a formula begins with an apostrophe.
    pub fn csv(&self) -> String {
        let cells: Vec<Vec<String>> = self
            .axes()
            .iter()
            .map(|axis| (0..axis.len()).map(|index| quoted(&axis.cell(index))).collect())
            .collect();
        let mut csv = String::from("case");
        for axis in self.axes() {
            let _ = write!(csv, ",{}", quoted(&axis.label()));
        }
        csv.push('\n');
        for case in 1..=self.len() {
            let _ = write!(csv, "{case:04}");
            for (cells, index) in cells.iter().zip(self.indices(case)) {
                let _ = write!(csv, ",{}", cells[*index as usize]);
            }
            csv.push('\n');
        }
        csv
    }

    /// Returns the files named in the study, in the base and on its axes.
    pub(super) fn files(&self) -> Vec<NamedFile> {
        let base = &self.file.base;
        let of_axes = self
            .axes()
            .iter()
            .flat_map(|axis| (0..axis.len()).flat_map(move |index| base.files_of(axis, axis.value(index))));
        base.files().into_iter().chain(of_axes).collect()
    }

    /// Returns the files named in a case, from 1.
    pub(super) fn files_of(&self, case: usize) -> Vec<NamedFile> {
        let base = &self.file.base;
        let mut files = base.files();
        for (axis, index) in self.axes().iter().zip(self.indices(case)) {
            files.retain(|file| file.key != axis.key() && !beneath(&file.key, axis.key()));
            files.extend(base.files_of(axis, axis.value(*index as usize)));
        }
        files
    }

    /// Digest of the part shared by all cases.
    pub(super) fn digest(&self) -> String {
        let keys: Vec<&str> = self.axes().iter().map(Axis::key).collect();
        sha256(format!("{}\n{}", self.file.base.digest(), keys.join("\n")).as_bytes())
    }

    /// Reads the case from its text, with files relative to the working directory.
    pub(crate) fn case(&self, case: usize) -> Result<Case> {
        Case::parse(&self.case_file(case, None)?, Path::new("case.toml"), Path::new(""))
    }

    /// Reads, for each value of each axis, the first case that has it.
    fn check(&self) -> Result<()> {
        let tried = self.tried();
        let wrong = tried.par_iter().find_map_first(|case| Some((*case, self.case(*case).err()?)));
        match wrong {
            None => Ok(()),
            Some((case, Error::Case(error))) if error.file == Path::new("case.toml") => {
                Err(self.located(case, &error))
            }
            Some((_, error)) => Err(error),
        }
    }

    /// Returns the first case with each value of each axis.
    fn tried(&self) -> Vec<usize> {
        let mut seen: Vec<Vec<bool>> = self.axes().iter().map(|axis| vec![false; axis.len()]).collect();
        let mut tried = BTreeSet::new();
        for case in 1..=self.len() {
            for (axis, index) in self.indices(case).iter().enumerate() {
                if !std::mem::replace(&mut seen[axis][*index as usize], true) {
                    tried.insert(case);
                }
            }
        }
        tried.into_iter().collect()
    }

    /// Locates a mistake of a case in the study: at the value of an axis, or in the base.
    fn located(&self, case: usize, error: &CaseError) -> Error {
        let of_axis = |axis: &Axis| {
            let (axis, key) = (axis.key(), error.key.as_str());
            let is_element = || axis.rsplit('.').next().is_some_and(|last| last.parse::<usize>().is_ok());
            axis == key
                || beneath(key, axis)
                || beneath(axis, key) && (is_element() || !self.file.base.has(key))
        };
        // A table of a list is named without its number: the only axis that may be meant is.
        let in_list =
            |axis: &Axis| error.key.starts_with('[') && unnumbered(axis.key()) == unnumbered(&error.key);
        let mut meant = (0..self.axes().len()).filter(|axis| in_list(&self.axes()[*axis]));
        let only = match (meant.next(), meant.next()) {
            (axis, None) => axis,
            _ => None,
        };
        match self.axes().iter().position(of_axis).or(only) {
            Some(axis) => self.error_at(case, axis, &error.message, error.hint.clone()),
            None => self.file.base.error(error),
        }
    }

    /// Error at the value of an axis in a case.
    fn error_at(&self, case: usize, n: usize, message: &str, hint: Option<String>) -> Error {
        let axis = &self.axes()[n];
        let span = axis.span(self.indices(case)[n] as usize);
        let document = match &self.file.rows {
            Some(rows) if n >= rows.first => &rows.document,
            _ => &self.file.document,
        };
        document.error(axis.key(), span, message, hint)
    }
}

/// Whether a dotted key lies in a table.
fn beneath(key: &str, table: &str) -> bool {
    key.strip_prefix(table).is_some_and(|rest| rest.starts_with('.'))
}

/// Returns a dotted key without the numbers and brackets of lists.
fn unnumbered(key: &str) -> String {
    let names = key.split('.').filter(|name| name.parse::<usize>().is_err());
    names.map(|name| name.trim_matches(['[', ']'])).collect::<Vec<_>>().join(".")
}

/// Returns the indices of all cases that are not excluded.
fn indices(file: &StudyFile) -> Result<Vec<u32>> {
    let grid = file.rows.as_ref().map_or(file.axes.len(), |rows| rows.first);
    let lengths: Vec<usize> = file.axes[..grid].iter().map(Axis::len).collect();
    let rows = file.rows.as_ref().map_or(1, |rows| rows.rows.len());
    let all = lengths.iter().try_fold(rows, |all, length| all.checked_mul(*length));
    let all = all.filter(|all| *all <= MAX_CASES).ok_or_else(|| {
        let factors: Vec<String> =
            lengths.iter().chain((rows > 1).then_some(&rows)).map(usize::to_string).collect();
        let message = format!("{} cases are more than 10⁷", factors.join(" × "));
        file.document.error_at("axes", message, Some("take fewer values, or several studies".to_owned()))
    })?;
    let mut indices = Vec::new();
    let mut case = vec![0; file.axes.len()];
    for n in 0..all {
        let mut rest = n;
        if let Some(table) = &file.rows {
            case[grid..].copy_from_slice(&table.rows[rest % rows]);
            rest /= rows;
        }
        for (index, length) in case[..grid].iter_mut().zip(&lengths).rev() {
            *index = (rest % length) as u32;
            rest /= length;
        }
        if !file.exclusions.iter().any(|exclusion| exclusion.holds(&case)) {
            indices.extend_from_slice(&case);
        }
    }
    if indices.is_empty() {
        let message = format!("[[exclude]] leaves none of {all} cases");
        return Err(file.document.error_at("exclude", message, None));
    }
    Ok(indices)
}
