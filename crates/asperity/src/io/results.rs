//! A results directory: what a computation leaves, and how it is found again.
//!
//! ```text
//! DIR/case.json            the case as resolved, SI: what --resume compares
//!     steps.csv passes.csv a motion: a row per position, a row per pass
//!     fields/initial.h5    the surfaces before the first pass
//!     fields/pass-0001.h5  the surfaces after it, its mean pressures, the pressures kept
//!     fields/warm-start-0001.h5    where the next pass begins; of the last pass only
//!     fields/subsurface-0001.h5    the stress under the surface in it, where it is wanted
//!     fields.h5            a static contact
//!     increments.csv       with friction or a history, a row per increment of its loading
//!     fields/increment-state.h5   what the next increment goes on from, until all is done
//!     subsurface.h5        the stress under its surface, where it is wanted
//!     summary.json         once all is done
//!     figures/             pictures
//! ```
//!
//! A pass is there once its row stands in `passes.csv`, which is written last; the warm start of the pass before is then
//! removed.

use std::path::{Path, PathBuf};
use std::{fs, io};

use super::fields::{FieldFile, Fields};
use super::loading::LoadingWriter;
use super::{atomic, summary, tables, warm_start};
use crate::error::{Error, Result};
use crate::grid::{Field, Grid};
use crate::io::subsurface::{Plan, SubsurfaceRecord};
use crate::io::summary::Summary;
use crate::motion::{
    IncrementRecord, LoadedContact, Output, Pair, PassRecord, PassReport, StepRecord, WarmStart,
};
use crate::solver::Solution;
use crate::subsurface::Tractions;
use crate::surface::Topography;

/// What to do about results that are there already.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Existing {
    /// Refuse.
    Keep,
    /// Replace them.
    Overwrite,
    /// Go on from the last finished pass.
    Resume,
}

/// A results directory.
#[derive(Debug, Clone)]
pub struct Results {
    directory: PathBuf,
}

impl Results {
    /// Makes the directory for the results of `case`, or enters it again.
    ///
    /// # Errors
    /// [`Error::ResultsExist`] where there is something that must be kept, [`Error::OtherCase`] if results to be
    /// resumed are those of another case (more passes of the same are welcome), [`Error::File`].
    pub fn create(directory: &Path, case: &serde_json::Value, existing: Existing) -> Result<Self> {
        let results = Self { directory: directory.to_owned() };
        fs::create_dir_all(directory).map_err(|source| match source.kind() {
            io::ErrorKind::AlreadyExists => results.failed(directory, io::ErrorKind::NotADirectory.into()),
            _ => results.failed(directory, source),
        })?;
        let occupied =
            fs::read_dir(directory).map_err(|source| results.failed(directory, source))?.next().is_some();
        let ours = results.case_path().exists();
        match existing {
            Existing::Keep if occupied => {
                return Err(Error::ResultsExist { path: directory.to_owned(), results: ours });
            }
            Existing::Overwrite | Existing::Resume if occupied && !ours => {
                return Err(Error::ResultsExist { path: directory.to_owned(), results: false });
            }
            Existing::Overwrite => results.clear()?,
            Existing::Resume if ours => {
                let mut before = results.case()?;
                let mut now = case.clone();
                for case in [&mut before, &mut now] {
                    if let Some(passes) = case.pointer_mut("/motion/passes") {
                        passes.take();
                    }
                    // Its folder is seen from wherever the program was called.
                    for file in ["/lower/topography/file", "/upper/topography/file"] {
                        if let Some(file) = case.pointer_mut(file) {
                            *file = Path::new(file.as_str().unwrap_or_default())
                                .file_name()
                                .map_or(serde_json::Value::Null, |name| name.to_string_lossy().into());
                        }
                    }
                }
                if before != now {
                    return Err(Error::OtherCase { path: directory.to_owned() });
                }
                // It tells of all passes, or is not there.
                results.remove("summary.json")?;
            }
            Existing::Keep | Existing::Resume => {}
        }
        let fields = results.directory.join("fields");
        fs::create_dir_all(&fields).map_err(|source| results.failed(&fields, source))?;
        for directory in [directory, &fields] {
            atomic::sweep(directory)?;
        }
        let text = serde_json::to_vec_pretty(case).expect("a JSON value can be written");
        atomic::write(&results.case_path(), &text)?;
        Ok(results)
    }

    /// Opens a directory that holds results.
    ///
    /// # Errors
    /// [`Error::NoResults`].
    pub fn open(directory: &Path) -> Result<Self> {
        let results = Self { directory: directory.to_owned() };
        if results.case_path().exists() {
            Ok(results)
        } else {
            Err(Error::NoResults { path: directory.to_owned() })
        }
    }

    /// The directory.
    pub fn directory(&self) -> &Path {
        &self.directory
    }

    /// The case as resolved.
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn case(&self) -> Result<serde_json::Value> {
        let path = self.case_path();
        let text = fs::read(&path).map_err(|source| self.failed(&path, source))?;
        serde_json::from_slice(&text).map_err(|error| self.failed(&path, error.into()))
    }

    /// The summary, which is there once all is done.
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn summary(&self) -> Result<Summary> {
        summary::read(&self.summary_path())
    }

    /// Writes the summary.
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn finish(&self, content: &Summary) -> Result<()> {
        summary::write(&self.summary_path(), content)
    }

    /// The finished passes; none where nothing moved yet.
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn passes(&self) -> Result<Vec<PassRecord>> {
        let path = self.directory.join("passes.csv");
        if path.exists() { tables::read_passes(&path) } else { Ok(Vec::new()) }
    }

    /// The positions of the finished passes.
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn steps(&self) -> Result<Vec<StepRecord>> {
        let path = self.directory.join("steps.csv");
        let finished = self.passes()?.len();
        let steps = if path.exists() { tables::read_steps(&path)? } else { Vec::new() };
        Ok(steps.into_iter().filter(|step| step.pass <= finished).collect())
    }

    /// The fields of a motion after so many passes, 0 for those before the first.
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn fields_after(&self, passes: usize) -> Result<Fields> {
        Fields::open(&self.fields_path(passes))
    }

    /// The fields of a static contact.
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn static_fields(&self) -> Result<Fields> {
        Fields::open(&self.directory.join("fields.h5"))
    }

    /// Writes the fields of a static contact.
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn write_static(&self, pair: &Pair, solution: &Solution) -> Result<()> {
        let plastic = solution.plastic_interference(&(&pair.upper - &pair.lower), pair.hardness());
        static_fields(pair, solution, &plastic).write(&self.directory.join("fields.h5"))
    }

    /// Writes the fields of a static contact that has been loaded in stages, or rolls.
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn write_loaded(&self, pair: &Pair, contact: &LoadedContact) -> Result<()> {
        let grid = pair.lower_grid();
        let mut file = static_fields(pair, contact.solution.normal(), &contact.plastic);
        let mut add = |name: &str, unit: &str, field: &Field| {
            file.add_field(name, unit, &grid, [0.0, 0.0], field);
        };
        if let Some(solution) = contact.solution.frictional() {
            add("traction_x", "Pa", &solution.shear[0]);
            add("traction_y", "Pa", &solution.shear[1]);
            add("displacement_x", "m", &solution.displacement[0]);
            add("displacement_y", "m", &solution.displacement[1]);
        }
        if let Some([x, y]) = &contact.slip {
            add("slip_x", "m", x);
            add("slip_y", "m", y);
        }
        if let Some(solution) = contact.solution.frictional() {
            add("stick", "1", &solution.stick);
            if solution.cap.iter().any(|cap| *cap != pair.hardness()) {
                add("cap", "Pa", &solution.cap);
            }
        }
        file.write(&self.directory.join("fields.h5"))
    }

    /// What keeps each increment of a loading of so many `increments` here.
    pub fn loading(&self, pair: &Pair, increments: usize) -> LoadingWriter {
        LoadingWriter::new(&self.directory, pair.lower_grid(), increments)
    }

    /// The increments of a static contact that was loaded in stages; none of other contacts.
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn increments(&self) -> Result<Vec<IncrementRecord>> {
        let path = self.directory.join("increments.csv");
        if path.exists() { tables::read_increments(&path) } else { Ok(Vec::new()) }
    }

    /// The stress under the surface: of a static contact, or in the pass, from 1, of a motion.
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn subsurface_fields(&self, pass: Option<usize>) -> Result<Fields> {
        Fields::open(&self.subsurface_path(pass))
    }

    /// Computes and writes the stress under the surface of a static contact, whose lower body bears
    /// `tractions`.
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn write_subsurface(&self, plan: &Plan, tractions: Tractions) -> Result<SubsurfaceRecord> {
        plan.write(&self.subsurface_path(None), None, tractions)
    }

    /// Writes the surfaces before the first pass.
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn write_initial(&self, pair: &Pair) -> Result<()> {
        let mut file = FieldFile::new();
        file.set("version", env!("CARGO_PKG_VERSION")).set("pass", 0);
        set_caps(&mut file, pair);
        add_surfaces(&mut file, pair);
        file.write(&self.fields_path(0))
    }

    /// The surfaces after so many passes.
    ///
    /// # Errors
    /// [`Error::File`].
    pub fn surfaces_after(&self, passes: usize) -> Result<[Topography; 2]> {
        let fields = self.fields_after(passes)?;
        let topography = |name| -> Result<Topography> {
            let stored = fields.read(name)?;
            let pitch = [stored.pitch[0], stored.pitch[1]];
            let heights = stored.into_field().ok_or(Error::Unsupported("a surface that is not a matrix"))?;
            Topography::new(Grid::new([heights.nrows(), heights.ncols()], pitch)?, heights)
        };
        Ok([topography("lower")?, topography("upper")?])
    }

    /// Where the pass after so many begins, which have left the `pair` behind.
    ///
    /// # Errors
    /// [`Error::NoWarmStart`].
    pub fn warm_start_after(&self, passes: usize, pair: &Pair) -> Result<WarmStart> {
        warm_start::read(&self.warm_start_path(passes), pair)
    }

    /// The output that writes each pass here, with the pressures of every `pressure_every`-th position (0: none) and
    /// the stress under the surface, where there is a plan for it.
    ///
    /// # Errors
    /// [`Error::File`] if the results of earlier passes cannot be read.
    pub fn writer(&self, pressure_every: usize, plan: Option<Plan>) -> Result<PassWriter> {
        let passes = self.passes()?;
        self.sweep_warm_starts(passes.len())?;
        let done = plan.iter().flat_map(|_| 1..=passes.len());
        Ok(PassWriter {
            steps: self.steps()?,
            subsurface: done
                .map(|pass| SubsurfaceRecord::read(&self.subsurface_path(Some(pass))))
                .collect::<Result<_>>()?,
            passes,
            results: self.clone(),
            pressure_every,
            plan,
        })
    }

    /// Removes what an earlier computation left, and nothing else.
    fn clear(&self) -> Result<()> {
        for path in ["fields", "figures"].map(|name| self.directory.join(name)).iter().filter(|p| p.exists())
        {
            fs::remove_dir_all(path).map_err(|source| self.failed(path, source))?;
        }
        // Last the file by which the directory is known as ours.
        let files = [
            "summary.json",
            "passes.csv",
            "steps.csv",
            "increments.csv",
            "fields.h5",
            "subsurface.h5",
            "case.json",
        ];
        files.iter().try_for_each(|name| self.remove(name))
    }

    fn remove(&self, name: &str) -> Result<()> {
        let path = self.directory.join(name);
        match fs::remove_file(&path) {
            Err(source) if source.kind() != io::ErrorKind::NotFound => Err(self.failed(&path, source)),
            _ => Ok(()),
        }
    }

    fn case_path(&self) -> PathBuf {
        self.directory.join("case.json")
    }

    fn summary_path(&self) -> PathBuf {
        self.directory.join("summary.json")
    }

    fn fields_path(&self, passes: usize) -> PathBuf {
        let name = if passes == 0 { "initial.h5".to_owned() } else { format!("pass-{passes:04}.h5") };
        self.directory.join("fields").join(name)
    }

    fn warm_start_path(&self, passes: usize) -> PathBuf {
        self.directory.join(warm_start_name(passes))
    }

    /// Removes the warm starts that killed runs have left, of all passes but one.
    fn sweep_warm_starts(&self, passes: usize) -> Result<()> {
        let kept = self.warm_start_path(passes);
        let fields = self.directory.join("fields");
        let entries = fs::read_dir(&fields).map_err(|source| self.failed(&fields, source))?;
        for entry in entries {
            let path = entry.map_err(|source| self.failed(&fields, source))?.path();
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            if name.starts_with("warm-start-") && path != kept {
                fs::remove_file(&path).map_err(|source| self.failed(&path, source))?;
            }
        }
        Ok(())
    }

    fn subsurface_path(&self, pass: Option<usize>) -> PathBuf {
        match pass {
            None => self.directory.join("subsurface.h5"),
            Some(pass) => self.directory.join("fields").join(format!("subsurface-{pass:04}.h5")),
        }
    }

    fn failed(&self, path: &Path, source: std::io::Error) -> Error {
        Error::File { path: path.to_owned(), source }
    }
}

/// Writes passes as they are finished: fields, then positions, then the pass itself.
pub struct PassWriter {
    results: Results,
    steps: Vec<StepRecord>,
    passes: Vec<PassRecord>,
    subsurface: Vec<SubsurfaceRecord>,
    pressure_every: usize,
    plan: Option<Plan>,
}

impl PassWriter {
    /// The passes written so far.
    pub fn passes(&self) -> &[PassRecord] {
        &self.passes
    }

    /// The stresses under the surface in them; none without a plan.
    pub fn subsurface(&self) -> &[SubsurfaceRecord] {
        &self.subsurface
    }
}

impl Output for PassWriter {
    fn pass(&mut self, report: &PassReport) -> Result<()> {
        let pair = report.pair;
        let mut file = FieldFile::new();
        file.set("version", env!("CARGO_PKG_VERSION")).set("pass", report.record.pass);
        set_caps(&mut file, pair);
        add_surfaces(&mut file, pair);
        let [lower, upper] = report.mean_pressure();
        file.add_field("mean_pressure_lower", "Pa", &pair.lower_grid(), [0.0, 0.0], &lower);
        file.add_field("mean_pressure_upper", "Pa", &pair.upper_grid(), [0.0, 0.0], &upper);
        for (index, contact) in report.contacts.iter().enumerate() {
            if self.pressure_every > 0 && index % self.pressure_every == 0 {
                let pressure: Field = contact.pressure_field(pair.lower.ncols());
                let corner = [contact.position.lower as f64 * pair.pitch()[0], 0.0];
                let grid = pair.grid(contact.position.columns);
                file.add_field(&pressure_name(index + 1), "Pa", &grid, corner, &pressure);
                if let Some(sliding) = report.sliding {
                    let traction = pressure.mapv(|p| sliding.shear(p)[0]);
                    file.add_field(&traction_name(index + 1), "Pa", &grid, corner, &traction);
                }
            }
        }
        file.write(&self.results.fields_path(report.record.pass))?;
        if let Some(plan) = &self.plan {
            let pass = Some(report.record.pass);
            let pressure = report.contacts[plan.index].pressure_field(pair.lower.ncols());
            let path = self.results.subsurface_path(pass);
            let shear = |axis: usize| report.sliding.map(|sliding| pressure.mapv(|p| sliding.shear(p)[axis]));
            let tractions = Tractions { shear: [shear(0), shear(1)], pressure };
            self.subsurface.push(plan.write(&path, pass, tractions)?);
        }
        let passes = report.record.pass;
        warm_start::write(&self.results.warm_start_path(passes), passes, &report.warm_start(), pair)?;
        self.steps.extend_from_slice(report.steps);
        self.passes.push(report.record.clone());
        tables::write_steps(&self.results.directory.join("steps.csv"), &self.steps)?;
        tables::write_passes(&self.results.directory.join("passes.csv"), &self.passes)?;
        self.results.remove(&warm_start_name(passes - 1))
    }
}

fn warm_start_name(passes: usize) -> String {
    format!("fields/warm-start-{passes:04}.h5")
}

/// Name of the pressure field of a position, which is counted from 1.
pub fn pressure_name(step: usize) -> String {
    format!("pressure_{step:05}")
}

/// Name of the shear traction along x of a position, which is counted from 1.
pub fn traction_name(step: usize) -> String {
    format!("traction_x_{step:05}")
}

/// What every static contact leaves.
fn static_fields(pair: &Pair, solution: &Solution, plastic: &Field) -> FieldFile {
    let grid = pair.lower_grid();
    let gap = &pair.upper - &pair.lower;
    let mut file = FieldFile::new();
    file.set("version", env!("CARGO_PKG_VERSION"))
        .set("approach", solution.approach)
        .set("hardness", pair.hardness());
    for (name, unit, field) in [
        ("pressure", "Pa", &solution.pressure),
        ("displacement", "m", &solution.displacement),
        ("gap", "m", &solution.gap(&gap)),
        ("lower", "m", &pair.lower),
        ("upper", "m", &pair.upper),
        ("plastic", "m", plastic),
    ] {
        file.add_field(name, unit, &grid, [0.0, 0.0], field);
    }
    file
}

/// The hardness, and what the shear of bodies that slide leaves of it to the pressure.
fn set_caps(file: &mut FieldFile, pair: &Pair) {
    file.set("hardness", pair.hardness()).set("cap", pair.cap());
}

fn add_surfaces(file: &mut FieldFile, pair: &Pair) {
    file.add_field("lower", "m", &pair.lower_grid(), [0.0, 0.0], &pair.lower);
    file.add_field("upper", "m", &pair.upper_grid(), [0.0, 0.0], &pair.upper);
}
