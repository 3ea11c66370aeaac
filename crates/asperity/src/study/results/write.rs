//! What a run writes into its results directory.

use std::path::{Path, PathBuf};

use serde_json::Value;

use super::entry::{self, Existing, Kept, Lock};
use super::step::StepWriter;
use super::{BODIES, Results, depths_attribute, state_name, states_attribute, tensor_name};
use crate::choice::Choice;
use crate::error::Result;
use crate::grid::{CellValues, Grid, Seat};
use crate::io::fields::FieldFile;
use crate::io::{atomic, vti};
use crate::motion::{Flowed, FlowedVolume, IncrementRecord, Pair, State, SweepRecord, UpdateRecord};
use crate::plasticity::TensorField;
use crate::solver::Friction;
use crate::stress::Component;
use crate::study::case::Keep;
use crate::study::rest::{NamedField, RestFields};
use crate::study::subsurface::{Plan, SubsurfaceRecord};
use crate::study::summary::Summary;
use crate::study::tables::GrowingTable;
use crate::study::{identity, summary, tables};
use crate::subsurface::Tractions;
use crate::units::Pascal;

/// A results directory that one run has for itself: others are refused until this is dropped, or its process is gone.
#[derive(Debug)]
pub struct Writer {
    results: Results,
    case: Value,
    identity: String,
    kept: Kept,
    lock: Lock,
}

impl Writer {
    /// Makes `directory` for the results of `case`, the content of its `case.json`, or enters it again. What is there
    /// stays until [`Self::begin`].
    ///
    /// # Errors
    /// [`crate::Error::ResultsExist`] where there is something that must be kept, [`crate::Error::WithinResults`], [`crate::Error::InUse`] while another run writes
    /// there; of results to be resumed [`crate::Error::OtherCase`] (more passes and another title are welcome),
    /// [`crate::Error::SurfaceChanged`], [`crate::Error::NotResumable`] where a file is missing or of another run; [`crate::Error::File`].
    pub fn enter(directory: &Path, case: &Value, existing: Existing) -> Result<Self> {
        let (lock, kept) = entry::enter(directory, case, existing)?;
        Ok(Self {
            results: Results { directory: directory.to_owned() },
            case: case.clone(),
            identity: identity::of(case),
            kept,
            lock,
        })
    }

    /// Clears what is replaced, and what killed runs have left, and writes `case.json`.
    ///
    /// # Errors
    /// [`crate::Error::File`].
    pub fn begin(&self) -> Result<()> {
        let fields = self.results.fields_folder();
        entry::clear(&self.results, self.kept, self.keep())?;
        for directory in [self.results.directory(), &fields, &self.results.figures_folder()] {
            atomic::sweep(directory);
        }
        let text = serde_json::to_vec_pretty(&self.case).expect("a JSON value can be written");
        atomic::replace(&self.results.case_path(), &text)
    }

    /// What is there already.
    pub fn results(&self) -> &Results {
        &self.results
    }

    /// What the user should know of the directory.
    pub fn warning(&self) -> Option<&'static str> {
        self.lock.warning()
    }

    /// Writes the summary.
    ///
    /// # Errors
    /// [`crate::Error::File`].
    pub fn finish(&self, content: &Summary) -> Result<()> {
        summary::write(&self.results.summary_path(), content)
    }

    /// Writes the fields of a static contact.
    ///
    /// # Errors
    /// [`crate::Error::File`].
    pub fn write_rest(&self, contact: RestFields) -> Result<()> {
        let mut file = self.field_file(&self.results.static_path());
        file.set("approach", contact.approach).set("hardness", contact.hardness);
        for NamedField { name, unit, values } in contact.fields {
            file.add_field(name, unit, &contact.grid, [0.0, 0.0], &values);
        }
        file.write()
    }

    /// Writes what has flowed below the surfaces of a static contact.
    ///
    /// # Errors
    /// [`crate::Error::File`].
    pub(in crate::study) fn write_flow(&self, contact: &Flowed) -> Result<()> {
        let mut file = self.field_file(&self.results.flow_path(None));
        let left = if contact.residual.is_empty() { &contact.volumes } else { &contact.residual };
        add_volumes(&mut file, &contact.volumes, left);
        file.write()?;
        tables::write_increments(&self.results.increments_path(), &contact.increments)
    }

    /// Computes and writes the stress under the surface of a static contact, whose lower body bears `tractions`, and in whose bodies
    /// this has flowed.
    ///
    /// # Errors
    /// [`crate::Error::File`].
    pub(in crate::study) fn write_subsurface(
        &self,
        plan: &Plan,
        tractions: Tractions,
        flowed: &[FlowedVolume],
    ) -> Result<SubsurfaceRecord> {
        let seat = Seat::flush(plan.grid.shape);
        let flowed = flowed.iter().find(|volume| volume.body == plan.side());
        let flowed = flowed.map(|volume| (&volume.state, &seat));
        let path = self.results.subsurface_path(None);
        plan.write(self.field_file(&path), &path, None, tractions, flowed)
    }

    /// Writes the bodies before the first pass, which slide under `friction`.
    ///
    /// # Errors
    /// [`crate::Error::File`].
    pub fn write_initial(&self, pair: &Pair, friction: Option<&Friction>) -> Result<()> {
        let mut file = self.field_file(&self.results.fields_path(0));
        file.set("pass", 0);
        set_caps(&mut file, pair.min_hardness(), friction);
        add_bodies(&mut file, pair);
        file.write()
    }

    /// The output that keeps each increment of a loading here, after those that are `done`.
    ///
    /// # Errors
    /// [`crate::Error::File`].
    pub fn increments(&self, done: &[IncrementRecord]) -> Result<StepWriter> {
        self.steps(self.results.increments_path(), done.len(), tables::digest("", done))
    }

    /// The output that keeps each update of a contact that slides in place here, after those that are `done`.
    ///
    /// # Errors
    /// [`crate::Error::File`].
    pub fn updates(&self, done: &[UpdateRecord]) -> Result<StepWriter> {
        self.steps(self.results.updates_path(), done.len(), tables::digest("", done))
    }

    /// The output that keeps each point of a sweep here, after those that are `done`, with the fields of every `fields_every`-th (0: of
    /// none).
    ///
    /// # Errors
    /// [`crate::Error::File`].
    pub fn points(&self, done: &[SweepRecord], fields_every: usize) -> Result<StepWriter> {
        let writer = self.steps(self.results.sweep_path(), done.len(), tables::digest("", done))?;
        Ok(StepWriter { fields_every, ..writer })
    }

    /// The output that keeps each pass here, with the pressures of every `pressure_every`-th position (0: none), the stress under the
    /// surface, where there is a plan for it, and the volumes of bodies that flow.
    ///
    /// # Errors
    /// [`crate::Error::File`] if the results of earlier passes cannot be read.
    pub fn passes(&self, pressure_every: usize, plan: Option<Plan>) -> Result<StepWriter> {
        let passes = self.results.passes()?;
        let steps = self.results.steps()?;
        let digest = tables::digest_of_passes(&passes, &steps);
        let writer = self.steps(self.results.passes_path(), passes.len(), digest)?;
        let positions = Some(GrowingTable::open(self.results.steps_path(), steps.len())?);
        Ok(StepWriter { positions, fields_every: pressure_every, plan, keep: self.keep(), ..writer })
    }

    /// The output that keeps each step here, after so many `rows` of that digest.
    fn steps(&self, table: PathBuf, rows: usize, digest: String) -> Result<StepWriter> {
        Ok(StepWriter {
            results: self.results.clone(),
            identity: self.identity.clone(),
            rows: GrowingTable::open(table, rows)?,
            digest,
            positions: None,
            fields_every: 0,
            plan: None,
            keep: Keep::Last,
        })
    }

    /// Writes each file of fields as image data for ParaView, too, unless that is there.
    ///
    /// # Errors
    /// [`crate::Error::File`].
    pub fn write_for_paraview(&self) -> Result<()> {
        let finished = self.results.passes()?.len();
        let passes = (0..=finished).filter(|_| finished > 0).map(|pass| self.results.fields_path(pass));
        let points = self.results.sweep()?.into_iter().map(|point| self.results.point_path(point.point));
        let all = passes.chain(points).chain([self.results.static_path()]).filter(|path| path.exists());
        for path in all.filter(|path| !path.with_extension("vti").exists()) {
            vti::write_fields(&path)?;
        }
        Ok(())
    }

    /// Of which passes the volumes that flow are kept.
    fn keep(&self) -> Keep {
        let word = self.case.pointer("/plasticity/keep").and_then(Value::as_str);
        word.and_then(Keep::of_word).unwrap_or(Keep::Last)
    }

    /// A file of fields that says which run it is of.
    fn field_file(&self, path: &Path) -> FieldFile {
        FieldFile::of_run(&self.identity, path)
    }
}

/// What has flowed below the surfaces, and what of it is `left` once the load is taken off.
pub(super) fn add_volumes(file: &mut FieldFile, volumes: &[FlowedVolume], left: &[FlowedVolume]) {
    for FlowedVolume { body, grid, faces, state, displacement, .. } in volumes {
        let body = BODIES[*body];
        file.set(&depths_attribute(body), faces.clone());
        add_tensor(file, "strain", "1", body, grid, &state.strain);
        let accumulated = layers_last(state.accumulated.view());
        file.add_layers(&state_name("accumulated", body), "1", grid, &accumulated);
        if let Some(back) = &state.back_stress {
            add_tensor(file, "back_stress", "Pa", body, grid, back);
        }
        file.add_field(&state_name("displacement", body), "m", grid, [0.0, 0.0], displacement);
    }
    for FlowedVolume { body, grid, residual_stress, displacement, .. } in left {
        let body = BODIES[*body];
        add_tensor(file, "residual_stress", "Pa", body, grid, residual_stress);
        file.add_field(&state_name("residual_displacement", body), "m", grid, [0.0, 0.0], displacement);
    }
}

/// A tensor in the layers of a body: an array for each of its components.
fn add_tensor(file: &mut FieldFile, name: &str, unit: &str, body: &str, grid: &Grid, tensor: &TensorField) {
    for component in Component::ALL {
        let layers = tensor.index_axis(ndarray::Axis(1), component as usize);
        let name = tensor_name(name, component, body);
        file.add_layers(&name, unit, grid, &layers_last(layers));
    }
}

/// `[layer, ix, iy]` as `[ix, iy, layer]`.
fn layers_last(values: ndarray::ArrayView3<f64>) -> ndarray::Array3<f64> {
    values.permuted_axes([1, 2, 0]).as_standard_layout().into_owned()
}

/// The hardness, and what the shear of bodies that slide leaves of it to the pressure.
pub(super) fn set_caps(file: &mut FieldFile, hardness: Pascal, friction: Option<&Friction>) {
    file.set("hardness", hardness);
    file.set("cap", friction.map_or(hardness, |friction| friction.sliding_cap(hardness)));
}

/// The bodies: heights, and what laws keep of them, whose names stand in an attribute.
pub(in crate::study) fn add_bodies(file: &mut FieldFile, pair: &Pair) {
    let grids = [pair.lower_grid(), pair.upper_grid()];
    for ((name, body), grid) in BODIES.into_iter().zip([&pair.lower, &pair.upper]).zip(grids) {
        file.add_field(name, "m", &grid, [0.0, 0.0], &body.heights);
        if let CellValues::Field(hardness) = &body.hardness {
            file.add_field(&state_name("hardness", name), "Pa", &grid, [0.0, 0.0], hardness);
        }
        for (state, State { unit, values }) in &body.state {
            file.add_field(&state_name(state, name), unit, &grid, [0.0, 0.0], values);
        }
        if !body.state.is_empty() {
            let names: Vec<&str> = body.state.keys().map(String::as_str).collect();
            file.set(&states_attribute(name), names.join(",").as_str());
        }
    }
}
