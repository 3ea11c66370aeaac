//! Output of a course to a results directory, step by step.
//!
//! The fields of a step are written first, then the state from which the next one continues, and last its
//! row. A step is done once its row is written, and the state of the step before is then removed. The state
//! after the last step is needed only for a motion, which may be extended by more passes.

use std::path::PathBuf;

use super::bodies::{add_bodies, add_volumes, set_caps};
use super::kept_contacts::KeptContacts;
use super::state::{self, ROWS};
use super::write::Writer;
use super::{Results, cap_name, pressure_name, temperature_name, traction_name};
use crate::io::fields::FieldFile;
use crate::subsurface::{Plan, SubsurfaceRecord};
use crate::tables::{self, GrowingTable};
use asperity_base::error::Result;
use asperity_base::grid::{CellValues, Field};
use asperity_base::record::Record;
use asperity_contact::lubrication::Film;
use asperity_contact::motion::{
    IncrementRecord, Output, PassReport, Step, StepRecord, StepRow, SweepRecord, UpdateRecord,
};
use asperity_contact::with::plasticity::Keep;

/// Writes each step of a course to files.
pub struct StepWriter {
    results: Results,
    identity: String,
    /// The table with a row for each step.
    rows: GrowingTable,
    /// Digest of all rows.
    digest: String,
    /// The table of the positions of the passes of a motion.
    positions: Option<GrowingTable>,
    /// The increments, or the points of a sweep, whose fields are kept.
    kept: KeptContacts,
    /// Interval of the positions of a pass whose fields are kept; 0 for none.
    fields_every: usize,
    /// The plan of the stress under the surface in each pass.
    plan: Option<Plan>,
    /// The passes whose plastic volumes are kept.
    keep: Keep,
}

impl Output for StepWriter {
    fn step(&mut self, step: &Step<'_>) -> Result<()> {
        match step.pass() {
            Some(report) => self.write_pass(report)?,
            None => self.write_contact(step)?,
        }
        let positions = step.pass().map_or(&[][..], |report| report.steps);
        match step.row {
            StepRow::Increment(row) => self.add(step, positions, row),
            StepRow::Update(row) => self.add(step, positions, row),
            StepRow::Point(row) => self.add(step, positions, row),
            StepRow::Pass(row) => self.add(step, positions, row),
        }?;
        if let Some(before) = self.kept.add(step.number, step.row)
            && let Some((_, path)) = self.contact_file(step.row, before)
        {
            self.results.remove(&path)?;
        }
        match (step.pass(), self.keep) {
            (Some(_), Keep::Last) => self.results.remove(&self.results.volume_path(Some(step.number - 1))),
            _ => Ok(()),
        }
    }
}

impl Writer {
    /// Creates the output for the increments of a loading, after those that are `done`, with the fields of
    /// every `fields_every`-th (0 for none), and of the one that the answers describe.
    ///
    /// # Errors
    /// [`asperity_base::Error::File`].
    pub fn increments(&self, done: &[IncrementRecord], fields_every: usize) -> Result<StepWriter> {
        let writer = self.steps(self.results.increments_path(), done.len(), tables::digest("", done))?;
        let (kept, left) = KeptContacts::after(fields_every, done.iter().map(StepRow::Increment));
        left.map_or(Ok(()), |left| self.results.remove(&self.results.increment_path(left)))?;
        Ok(StepWriter { kept, ..writer })
    }

    /// Creates the output for the updates of a contact that slides in place, after those that are `done`.
    ///
    /// # Errors
    /// [`asperity_base::Error::File`].
    pub fn updates(&self, done: &[UpdateRecord]) -> Result<StepWriter> {
        self.steps(self.results.updates_path(), done.len(), tables::digest("", done))
    }

    /// Creates the output for the points of a sweep, after those that are `done`, with the fields of every
    /// `fields_every`-th (0 for none), and of the one that the answers describe.
    ///
    /// # Errors
    /// [`asperity_base::Error::File`].
    pub fn points(&self, done: &[SweepRecord], fields_every: usize) -> Result<StepWriter> {
        let writer = self.steps(self.results.sweep_path(), done.len(), tables::digest("", done))?;
        let (kept, left) = KeptContacts::after(fields_every, done.iter().map(StepRow::Point));
        left.map_or(Ok(()), |left| self.results.remove(&self.results.point_path(left)))?;
        Ok(StepWriter { kept, ..writer })
    }

    /// Creates the output for passes, with the pressures of every `pressure_every`-th position (0 for none),
    /// the stress under the surface if there is a `plan`, and the volumes of elasto-plastic bodies.
    ///
    /// # Errors
    /// [`asperity_base::Error::File`] if the results of earlier passes cannot be read.
    pub fn passes(&self, pressure_every: usize, plan: Option<Plan>) -> Result<StepWriter> {
        let passes = self.results.passes()?;
        let steps = self.results.steps()?;
        let digest = tables::digest_of_passes(&passes, &steps);
        let writer = self.steps(self.results.passes_path(), passes.len(), digest)?;
        let positions = Some(GrowingTable::open(self.results.steps_path(), steps.len())?);
        Ok(StepWriter { positions, fields_every: pressure_every, plan, keep: self.keep(), ..writer })
    }

    /// Creates the output for steps, after `rows` rows with this digest.
    fn steps(&self, table: PathBuf, rows: usize, digest: String) -> Result<StepWriter> {
        Ok(StepWriter {
            results: self.results.clone(),
            identity: self.identity.clone(),
            rows: GrowingTable::open(table, rows)?,
            digest,
            positions: None,
            kept: KeptContacts::new(0),
            fields_every: 0,
            plan: None,
            keep: Keep::Last,
        })
    }
}

impl StepWriter {
    /// Reads the stress under the surface in each of `passes` passes; empty without a plan.
    ///
    /// # Errors
    /// [`asperity_base::Error::File`].
    pub fn subsurface(&self, passes: usize) -> Result<Vec<SubsurfaceRecord>> {
        let wanted = self.plan.iter().flat_map(|_| 1..=passes);
        wanted.map(|pass| SubsurfaceRecord::read(&self.results.subsurface_path(Some(pass)))).collect()
    }

    /// Writes the state after a step, if another one follows, and appends the rows of its `positions` and its
    /// own row.
    fn add<T: Record>(&mut self, step: &Step<'_>, positions: &[StepRecord], record: &T) -> Result<()> {
        let record = std::slice::from_ref(record);
        let digest = tables::digest(&tables::digest(&self.digest, positions), record);
        let state = step.state.filter(|_| !step.is_last());
        if let Some(state) = state {
            let mut file = FieldFile::of_run(&self.identity, &self.results.state_path(step.number));
            if step.pass().is_some() {
                file.set("pass", step.number);
            }
            state::add(&mut file, step.pitch().expect("what goes on has bodies"), state);
            file.set(ROWS, digest.as_str());
            file.write()?;
        }
        if let Some(table) = &mut self.positions {
            table.add(positions)?;
        }
        self.rows.add(record)?;
        self.digest = digest;
        match step.number.checked_sub(1).filter(|_| state.is_some()) {
            Some(before) => self.results.remove(&self.results.state_path(before)),
            None => Ok(()),
        }
    }

    /// Name of the contacts that rows of this kind describe, and the file of their fields.
    fn contact_file(&self, row: StepRow<'_>, number: usize) -> Option<(&'static str, PathBuf)> {
        match row {
            StepRow::Increment(_) => Some(("increment", self.results.increment_path(number))),
            StepRow::Point(_) => Some(("point", self.results.point_path(number))),
            StepRow::Update(_) | StepRow::Pass(_) => None,
        }
    }

    /// Writes the fields of a contact, a point of a sweep or an increment, if they are kept.
    fn write_contact(&self, step: &Step<'_>) -> Result<()> {
        let number = step.number;
        let Some((kind, path)) = self.contact_file(step.row, number) else { return Ok(()) };
        let is_between = match step.row {
            StepRow::Increment(row) => row.interface.is_some(),
            StepRow::Point(row) => row.interface.is_some() || row.lubrication.is_some(),
            StepRow::Update(_) | StepRow::Pass(_) => false,
        };
        let (Some(solution), true) = (step.contact, self.kept.has(number, step.row)) else { return Ok(()) };
        let mut file = FieldFile::of_run(&self.identity, &path);
        file.set(kind, number).set("approach", solution.approach);
        let mut add = |name: &str, unit: &str, field: &Field| {
            file.add_field(name, unit, &solution.grid, [0.0, 0.0], field);
        };
        add("pressure", "Pa", &solution.pressure);
        // The pressure alone does not say which cells are in contact.
        if is_between {
            add("contact", "1", &solution.contact_field());
        }
        add("gap", "m", &solution.gap());
        step.film.into_iter().flat_map(Film::parts).for_each(|(name, unit, field)| add(name, unit, field));
        if let (Some(plastic), true) = (step.plastic(), solution.bounds.upper().min().is_finite()) {
            add("plastic", "m", &plastic);
        }
        file.write()
    }

    /// Writes the fields of a pass.
    fn write_pass(&self, report: &PassReport<'_>) -> Result<()> {
        let pair = report.pair;
        let results = &self.results;
        let mut file = FieldFile::of_run(&self.identity, &results.fields_path(report.record.pass));
        file.set("pass", report.record.pass);
        set_caps(&mut file, report.min_hardness(), report.motion.friction.as_ref());
        add_bodies(&mut file, pair);
        let [lower, upper] = report.mean_pressure();
        file.add_field("mean_pressure_lower", "Pa", &pair.lower_grid(), [0.0, 0.0], &lower);
        file.add_field("mean_pressure_upper", "Pa", &pair.upper_grid(), [0.0, 0.0], &upper);
        for (index, contact) in report.contacts.iter().enumerate() {
            if self.fields_every > 0 && index % self.fields_every == 0 {
                let pressure: Field = contact.pressure_field(pair.lower.width());
                let corner = [contact.position.places()[0] * pair.pitch()[0], 0.0];
                let grid = pair.grid(contact.position.columns);
                file.add_field(&pressure_name(index + 1), "Pa", &grid, corner, &pressure);
                if let Some(temperature) = contact.temperature_field(pair.lower.width()) {
                    file.add_field(&temperature_name(index + 1), "K", &grid, corner, &temperature);
                }
                if let CellValues::Field(cap) = report.bounds(contact).upper() {
                    file.add_field(&cap_name(index + 1), "Pa", &grid, corner, cap);
                }
                if let Some(sliding) = report.motion.sliding(contact.position.stroke) {
                    let traction = pressure.mapv(|p| sliding.shear(p)[0]);
                    file.add_field(&traction_name(index + 1), "Pa", &grid, corner, &traction);
                }
            }
        }
        file.write()?;
        if let Some(plan) = &self.plan {
            let pass = Some(report.record.pass);
            let contact = &report.contacts[plan.index];
            let sliding = report.motion.sliding(contact.position.stroke);
            let path = results.subsurface_path(pass);
            let tractions = contact.tractions(pair.lower.width(), sliding.as_ref());
            let plan = plan.at_position(&contact.position, &pair.lower_grid());
            let placements = pair.placements(&contact.position);
            let states_under_load = report.plastic_volumes.iter().zip(report.states_under_load);
            let plastic_state = states_under_load.into_iter().find(|(volume, _)| volume.body == plan.side());
            let plastic_state = plastic_state.map(|(_, state)| (state, &placements[plan.side()]));
            plan.write(FieldFile::of_run(&self.identity, &path), &path, pass, tractions, plastic_state)?;
        }
        let passes = report.record.pass;
        if !report.plastic_volumes.is_empty() {
            let mut file = FieldFile::of_run(&self.identity, &results.volume_path(Some(passes)));
            file.set("pass", passes);
            add_volumes(&mut file, report.plastic_volumes, report.plastic_volumes);
            file.write()?;
        }
        Ok(())
    }
}
