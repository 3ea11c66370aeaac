//! `summary.json`: the results of a computation in numbers.

use std::collections::BTreeMap;
use std::path::Path;

use serde::{Deserialize, Serialize, Serializer};

use super::closed_form::ClosedFormRecord;
use super::subsurface::SubsurfaceRecord;
use crate::io::{atomic, regular};
use crate::{json, tables};
use asperity_base::error::{Error, Result};
use asperity_base::record::columns;
use asperity_base::units::{CubicMetre, Metre, Second};
use asperity_contact::motion::{Column, PassRecord, PlasticRecord, StaticRecord, SweepRecord, UpdateRecord};
use asperity_contact::with::{InterfaceNumbers, Observations};

/// The content of `summary.json`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct Summary {
    /// Version of the program that wrote it.
    pub version: String,
    /// The resolved case: in SI, with defaults filled in.
    pub case: serde_json::Value,
    /// The outcome, in the file under the key `static`, `sweep` or `passes`.
    #[serde(flatten)]
    pub outcome: Outcome,
    /// Totals over the passes of bodies that laws change; `None` for others.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub running_in: Option<RunningIn>,
    /// The last update of a contact that slid in place, with its losses and final state; `None` for others.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub sliding: Option<UpdateRecord>,
    /// Residual plastic state after the passes of elasto-plastic bodies, with its long-term regime; `None`
    /// for others. The residual state of a static contact is in its record.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub plasticity: Option<PlasticRecord>,
    /// The interface of the bodies in numbers, under the name of its table.
    #[serde(flatten)]
    pub interface: InterfaceNumbers,
    /// Closed form of the contact beside the computed one, if both bodies are smooth forms; `None` for
    /// others.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub closed_form: Option<ClosedFormRecord>,
    /// The most stressed point, once for a static contact, once per pass for a motion; empty if the stress
    /// was not requested.
    #[serde(default, skip_serializing_if = "Vec::is_empty")]
    pub subsurface: Vec<SubsurfaceRecord>,
    /// The rows of the capabilities: those of the last contact or, after a motion, of its passes.
    #[serde(flatten)]
    pub found: Observations,
    /// Warnings for the user.
    pub warnings: Vec<String>,
    /// Time of the whole computation.
    pub wall_time_s: Second,
}

columns! {
    /// The passes of bodies that laws change, together: `running_in` in `summary.json`.
    #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
    #[non_exhaustive]
    pub struct RunningIn {
        /// Passes that were computed.
        pub computed: usize,
        /// Passes of the motion that the computed passes represent.
        pub represented: usize,
        /// Bound on the error of the heights by extrapolation: the sum of the estimates.
        pub error_bound: Metre,
        /// Volumes that the lower and the upper body have lost, by law; negative for a grown film.
        pub lost: BTreeMap<String, [CubicMetre; 2]>,
    }
}

impl RunningIn {
    /// Sums these passes, if laws change the bodies in them.
    pub(super) fn from_passes(passes: &[PassRecord]) -> Option<Self> {
        passes.first()?.running?;
        let mut lost = BTreeMap::<String, [CubicMetre; 2]>::new();
        for volumes in passes.iter().flat_map(|pass| &pass.lost) {
            let sum = lost.entry(volumes.law.clone()).or_default();
            sum.iter_mut().zip(volumes.whole).for_each(|(sum, volume)| *sum += volume);
        }
        Some(Self {
            computed: passes.len(),
            represented: passes.iter().map(PassRecord::represents).sum(),
            error_bound: passes
                .iter()
                .filter_map(|pass| pass.running)
                .map(|running| running.error_estimate)
                .sum(),
            lost,
        })
    }
}

/// Outcome of a computation.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Outcome {
    /// One static contact.
    #[serde(serialize_with = "with_converged")]
    Static(Box<StaticRecord>),
    /// Static contacts at several loads: one record each.
    Sweep(Vec<SweepRecord>),
    /// A motion: one record per pass.
    Passes(Vec<PassRecord>),
}

impl Outcome {
    /// Checks the numbers of static contacts. Passes are checked as they finish.
    ///
    /// # Errors
    /// [`Error::NotFinite`].
    pub(super) fn check(&self) -> Result<()> {
        match self {
            Self::Static(record) => tables::checked(std::slice::from_ref(&**record)).map(|_| ()),
            Self::Sweep(points) => tables::checked(points).map(|_| ()),
            Self::Passes(_) => Ok(()),
        }
    }
}

/// The additional column of `static`.
pub(super) const CONVERGED: Column =
    Column::new("converged", "", "`true`: a computation that does not converge leaves no summary.");

/// Writes a static contact with a flag for readers of the file. A contact that did not converge leaves no
/// summary.
fn with_converged<S: Serializer>(
    record: &StaticRecord,
    serializer: S,
) -> std::result::Result<S::Ok, S::Error> {
    #[derive(Serialize)]
    struct Keys<'a> {
        #[serde(flatten)]
        record: &'a StaticRecord,
        converged: bool,
    }
    Keys { record, converged: true }.serialize(serializer)
}

/// Writes `summary` to `path`, atomically. JSON has no NaN, which is written as `null`.
///
/// # Errors
/// [`Error::File`].
pub fn write(path: &Path, summary: &Summary) -> Result<()> {
    atomic::write_with(path, |file| {
        json::write_pretty(&mut *file, summary)?;
        file.write_all(b"\n")
    })
}

/// Reads a file written by [`write()`].
///
/// # Errors
/// [`Error::File`] if the file cannot be read or is not a summary; the message gives line and column.
pub(super) fn read(path: &Path) -> Result<Summary> {
    let failed = |source| Error::File { path: path.to_owned(), source };
    let text = regular::read(path, "a summary", u64::MAX).map_err(failed)?;
    serde_json::from_slice(&text).map_err(|error| failed(error.into()))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_summary_reads_back_and_has_the_promised_keys() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("summary.json");
        let record = StaticRecord {
            load: 2.0,
            approach: 1.25e-7,
            contact_area: 3.1e-11,
            apparent_area: 1e-8,
            max_pressure: 4e9,
            mean_gap: 3e-7,
            elastic_energy: 1e-9,
            plastic_cells: 3,
            plastic_volume: 1e-20,
            iterations: 12,
            convolutions: 15.5,
            residual: 3e-7,
            shear: None,
            interface: None,
            plastic: None,
            fretting: None,
            heat: None,
        };
        let summary = Summary {
            version: "0.1.0".into(),
            case: serde_json::json!({"contact": {"load": 2.0}}),
            running_in: None,
            sliding: None,
            plasticity: None,
            interface: InterfaceNumbers::default(),
            closed_form: None,
            outcome: Outcome::Static(Box::new(record)),
            subsurface: vec![SubsurfaceRecord {
                pass: None,
                step: None,
                max_von_mises: 2.5e9,
                position: [1e-6, 2e-6, 5e-7],
                max_shear: 1.3e9,
                max_shear_position: [1e-6, 2e-6, 4e-7],
                max_surface_tension: Some(1e8),
                max_surface_tension_position: Some([1e-6, 2e-6, 0.0]),
                max_interface_shear: None,
                max_interface_tension: None,
            }],
            found: Observations::default(),
            warnings: vec!["the mesh is coarse".into()],
            wall_time_s: 0.5,
        };
        write(&path, &summary).unwrap();
        assert_eq!(read(&path).unwrap(), summary);

        let passes = Summary { outcome: Outcome::Passes(vec![]), subsurface: vec![], ..summary };
        let value = serde_json::to_value(&passes).unwrap();
        let keys: Vec<_> = value.as_object().unwrap().keys().map(String::as_str).collect();
        assert_eq!(keys, ["case", "passes", "version", "wall_time_s", "warnings"]);
        write(&path, &passes).unwrap();
        assert_eq!(read(&path).unwrap(), passes);
    }

    #[test]
    fn a_truncated_summary_is_an_error_with_its_line() {
        let directory = tempfile::tempdir().unwrap();
        let path = directory.path().join("summary.json");
        std::fs::write(&path, "{\n  \"version\": ").unwrap();
        let message = read(&path).unwrap_err().to_string();
        assert!(message.contains("line 2"), "{message}");
    }
}
