//! Stress under the surface of a contact: the points requested in a case, and the result file.
//!
//! ```text
//! /                      attributes: body, poisson, section, planes, columns; the record, see [`SubsurfaceRecord`]
//! /von_mises_01          float64 [x, y]   von Mises' stress on the first of the planes
//! /section_xx … _xy      float64 [x, z]   the stress on the section, and `section_von_mises`
//! /column_01_xx … _xy    float64 [z]      the stress under the first of the columns
//! /                      of a body with layers: layer_depth, layer_max_von_mises, …, a number for each layer
//! /section_residual_xx … /column_01_residual_xx …    its residual part, for an elasto-plastic body
//! ```

use std::path::Path;

use ndarray::{Array1, Array2, Axis};
use serde::{Deserialize, Serialize};

use super::case::{Case, Side};
use crate::io::fields::{Attribute, FieldFile, Fields};
use crate::io::vti;
use asperity_base::error::{Error, Result};
use asperity_base::grid::{Field, Grid, Placement};
use asperity_base::record::columns;
use asperity_base::units::{self, Dimension, Metre, Pascal};
use asperity_contact::kernel::Stack;
use asperity_contact::material::Material;
use asperity_contact::motion::Position;
use asperity_contact::operator::Boundary;
use asperity_contact::plasticity::{Layers, PlasticState, residual_below};
use asperity_contact::stress::{Component, Stress};
use asperity_contact::subsurface::{
    Extreme, LayerStress, LayeredStress, Maximum, Plane, Subsurface, Survey, Tractions, von_mises,
};

/// Requested points on the grid of one contact.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Plan {
    /// Index of the requested position.
    pub index: usize,
    /// The grid of the overlap at this position.
    pub grid: Grid,
    /// Evenly spaced, from the surface down.
    pub depths: Vec<Metre>,
    body: Side,
    poisson: f64,
    boundary: Boundary,
    /// The corner of the overlap on the body.
    corner: [Metre; 2],
    planes: Vec<Metre>,
    section: Option<usize>,
    columns: Vec<[usize; 2]>,
    /// Whether the stress is also requested as a volume.
    volume: bool,
    /// The plastic layers of the body; `None` if it is elastic.
    layers: Option<Layers>,
    material: Material,
    /// The grid of the body.
    of_body: Grid,
}

columns! {
    /// The most stressed points of a contact: an entry of `subsurface` in `summary.json`.
    #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
    #[non_exhaustive]
    pub struct SubsurfaceRecord {
        /// Pass of a motion, from 1; left out of a static contact.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub pass: Option<usize>,
        /// Position in the pass of a motion, from 1; left out of a static contact.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub step: Option<usize>,
        /// Largest von Mises stress over all cells and depths.
        pub max_von_mises: Pascal,
        /// Place of the largest von Mises stress: x and y from the corner of the body, z from its surface.
        /// Where a contact passes the end of a body in a shift, x goes on at its beginning, as on the maps of
        /// the body.
        pub position: [Metre; 3],
        /// Largest shear stress on any plane, ½(σ₁ − σ₃).
        pub max_shear: Pascal,
        /// Place of the largest shear stress, in the same coordinates.
        pub max_shear_position: [Metre; 3],
        /// Largest principal tension at the surface of a body with layers, which cracks them.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub max_surface_tension: Option<Pascal>,
        /// Place of the largest tension at the surface, in the same coordinates.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub max_surface_tension_position: Option<[Metre; 3]>,
        /// Largest shear across an interface of its layers, which makes them come off.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub max_interface_shear: Option<Pascal>,
        /// Largest tension across an interface of its layers.
        #[serde(skip_serializing_if = "Option::is_none")]
        pub max_interface_tension: Option<Pascal>,
    }
}

/// The stress on a plane at the requested points.
struct Cut {
    /// The cell along y of the section.
    row: usize,
    section: [Array1<f64>; 6],
    columns: Vec<Stress>,
    volume: Option<Array2<f32>>,
}

impl Plan {
    /// Creates the plan of `case` for bodies that overlap at the `positions`.
    ///
    /// # Errors
    /// [`Error::Case`] if a requested point lies outside the contact.
    pub fn new(case: &Case, [lower, upper]: [&Grid; 2], positions: &[Position]) -> Result<Option<Self>> {
        let Some(spec) = &case.subsurface else { return Ok(None) };
        let error = |key: &str, message| case.error_at(&format!("subsurface.{key}"), message, None);
        let flush = || positions.iter().position(|p| p.offset == 0.0).expect("a pass has a flush position");
        let index = spec.step.map_or_else(flush, |step| step - 1);
        let position = positions.get(index).ok_or_else(|| {
            error("step", format!("'step' is {}, a pass has {} positions", index + 1, positions.len()))
        })?;
        let grid = Grid { shape: [position.columns, lower.shape[1]], pitch: lower.pitch };
        let corner = corner(spec.body, position, lower);
        let boundary = case.contact.boundary;
        let cell = |key: &str, axis: usize, at: Metre| {
            let length = |value| units::format(value, Dimension::Length);
            let [from, to] = [corner[axis], corner[axis] + grid.extent()[axis]];
            // A contact that passes the end of its body goes on at the beginning.
            let at = if at < from && boundary.repeats(axis) { at + grid.extent()[axis] } else { at };
            let index = ((at - from) / grid.pitch[axis]).floor();
            if at < from || at > to * (1.0 + 1e-12) {
                let (name, at, from, to) = (["x", "y"][axis], length(at), length(from), length(to));
                return Err(error(
                    key,
                    format!("{name} = {at} in '{key}' is not on the contact, {from} to {to}"),
                ));
            }
            Ok((index as usize).min(grid.shape[axis] - 1))
        };
        let column = |[x, y]: &[Metre; 2]| Ok([cell("columns", 0, *x)?, cell("columns", 1, *y)?]);
        let body = match spec.body {
            Side::Lower => &case.lower,
            Side::Upper => &case.upper,
        };
        let thickness = body.material.thickness();
        let deepest = [("to", Some(spec.to)), ("planes", spec.planes.iter().copied().reduce(f64::max))];
        let rigid = body.material.is_layered() && body.material.young.is_infinite();
        for (key, depth) in deepest {
            if let Some(depth) = depth.filter(|depth| rigid && *depth > thickness * (1.0 + 1e-12)) {
                let [depth, end] = [depth, thickness].map(|length| units::format(length, Dimension::Length));
                let message = format!(
                    "'{key}' goes down to {depth}, but the stress in a rigid base, below {end}, is not determined"
                );
                return Err(error(key, message));
            }
        }
        Ok(Some(Self {
            index,
            depths: (0..=spec.layers).map(|k| k as f64 * spec.to / spec.layers as f64).collect(),
            body: spec.body,
            poisson: body.material.poisson,
            boundary,
            corner,
            planes: spec.planes.clone(),
            section: spec.section.map(|y| cell("section", 1, y)).transpose()?,
            columns: spec.columns.iter().map(column).collect::<Result<_>>()?,
            volume: case.output.paraview,
            layers: match (&body.plasticity, case.plasticity) {
                (Some(_), Some(spec)) => Some(spec.layers()?),
                _ => None,
            },
            material: body.material.clone(),
            of_body: match spec.body {
                Side::Lower => *lower,
                Side::Upper => *upper,
            },
            grid,
        }))
    }

    /// Returns the plan with the cells of a pass. On a body that moves from pass to pass they differ.
    pub(super) fn at_position(&self, position: &Position, lower: &Grid) -> Self {
        Self { corner: corner(self.body, position, lower), ..self.clone() }
    }

    /// Memory that the stress takes for each thread, bytes.
    pub fn memory(&self) -> f64 {
        let cells = self.grid.cells() as f64;
        let padded = self.boundary.padded(self.grid.shape).map(|n| n as f64);
        let padded = padded[0] * padded[1];
        // In layers the six components under three tractions, or ten of each wave ≥ 0.
        let layers = match (self.material.is_layered(), self.boundary.leaves_mean_free()) {
            (false, _) => 0.0,
            (true, false) => 18.0 * cells,
            (true, true) => 2.5 * padded,
        };
        // Six components, von Mises' stress, two tables; influence, its transform, their sum, and one in
        // progress.
        8.0 * (9.0 * cells + 4.0 * padded + layers)
    }

    /// The requested body: 0 the lower, 1 the upper one.
    pub(super) fn side(&self) -> usize {
        match self.body {
            Side::Lower => 0,
            Side::Upper => 1,
        }
    }

    /// Returns the residual stress from the plastic state of the body, on the cells of the contact.
    fn residual(&self, plastic_state: Option<(&PlasticState, &Placement)>) -> Result<Option<LayeredStress>> {
        let (Some((state, placement)), Some(layers)) = (plastic_state, &self.layers) else { return Ok(None) };
        let to = self.depths[self.depths.len() - 1];
        let (grid, columns) = (self.of_body, self.grid.shape[0]);
        residual_below(grid, layers, self.boundary, &self.material, &state.strain, placement, columns, to)
            .map(Some)
    }

    /// Computes the stress in the requested body under `tractions`, which act on the lower body, plus its
    /// residual stress from `plastic_state`. Writes it to `path` with the present content of `file`.
    pub(super) fn write(
        &self,
        mut file: FieldFile,
        path: &Path,
        pass: Option<usize>,
        tractions: Tractions,
        plastic_state: Option<(&PlasticState, &Placement)>,
    ) -> Result<SubsurfaceRecord> {
        let tractions = match self.body {
            Side::Lower => tractions,
            Side::Upper => tractions.on_upper(),
        };
        let residual = self.residual(plastic_state)?;
        let body = Subsurface::new(self.grid, self.boundary, self.poisson, &tractions)
            .with_residual(residual)
            .with_layers(Stack::of(&self.material));
        // The section goes through the most stressed point of all, mostly that of each plane.
        let look = |plane: Plane, most: &Maximum| {
            let row = self.section.unwrap_or(most.von_mises.cell[1]);
            Cut {
                row,
                section: plane.row(row),
                columns: self.columns.iter().map(|cell| plane.stress(*cell)).collect(),
                volume: self.volume.then(|| plane.von_mises().mapv(|stress| stress as f32)),
            }
        };
        let Survey { maximum: most, layers, planes: mut cuts, .. } = body.survey(&self.depths, look);
        let row = self.section.unwrap_or(most.von_mises.cell[1]);
        let elsewhere: Vec<usize> = (0..cuts.len()).filter(|k| cuts[*k].row != row).collect();
        let depths: Vec<Metre> = elsewhere.iter().map(|k| self.depths[*k]).collect();
        for (k, section) in elsewhere.into_iter().zip(body.planes(&depths, |plane| plane.row(row))) {
            cuts[k].section = section;
        }
        let largest = |of: fn(&LayerStress) -> Pascal| layers.iter().skip(1).map(of).reduce(f64::max);
        let record = SubsurfaceRecord {
            pass,
            step: pass.map(|_| self.index + 1),
            max_von_mises: most.von_mises.value,
            position: self.position(&most.von_mises),
            max_shear: most.shear.value,
            max_shear_position: self.position(&most.shear),
            max_surface_tension: layers.first().map(|layer| layer.tension.value.max(0.0)),
            max_surface_tension_position: layers.first().map(|layer| self.position(&layer.tension)),
            max_interface_shear: largest(|layer| layer.shear),
            max_interface_tension: largest(|layer| layer.pull.max(0.0)),
        };
        self.describe(&mut file, &record, row);
        describe_layers(&mut file, &layers);
        for (k, plane) in body.planes(&self.planes, |plane| plane.von_mises()).iter().enumerate() {
            file.add_field(&format!("von_mises_{:02}", k + 1), "Pa", &self.grid, self.corner, plane);
        }
        if self.volume {
            let planes: Vec<_> = cuts.iter().filter_map(|cut| cut.volume.clone()).collect();
            let [dx, dy] = self.grid.pitch;
            let origin = [0, 1].map(|axis| self.corner[axis] + self.grid.centre(axis, 0));
            let pitch = [dx, dy, self.spacing()];
            vti::write_volume(&path.with_extension("vti"), "von_mises", &planes, origin, pitch)?;
        }
        let section = |component: Component| {
            let mut field = Field::zeros([self.grid.shape[0], self.depths.len()]);
            for (mut column, cut) in field.axis_iter_mut(Axis(1)).zip(&cuts) {
                column.assign(&cut.section[component as usize]);
            }
            field
        };
        self.add_section(&mut file, &Component::ALL.map(section));
        for k in 0..self.columns.len() {
            for component in Component::ALL {
                let values: Vec<f64> =
                    cuts.iter().map(|cut| cut.columns[k].components()[component as usize]).collect();
                let name = format!("column_{:02}_{}", k + 1, component.name());
                file.add_series(&name, "Pa", "z", self.spacing(), 0.0, &values);
            }
        }
        if let Some(residual) = body.residual() {
            self.add_residual(&mut file, residual, row);
        }
        file.write()?;
        Ok(record)
    }

    /// Adds the residual stress on the section and under the columns.
    fn add_residual(&self, file: &mut FieldFile, residual: &LayeredStress, row: usize) {
        let planes: Vec<[Field; 6]> = self.depths.iter().map(|depth| residual.components(*depth)).collect();
        let pitch = [self.grid.pitch[0], self.spacing()];
        let x = self.corner[0] + self.grid.centre(0, 0);
        for (component, name) in Component::ALL.iter().map(|c| (*c as usize, c.name())) {
            let at = |(ix, k): (usize, usize)| planes[k][component][[ix, row]];
            let section = Field::from_shape_fn([self.grid.shape[0], planes.len()], at);
            file.add_section(&format!("section_residual_{name}"), "Pa", pitch, x, &section);
            for (k, cell) in self.columns.iter().enumerate() {
                let values: Vec<f64> = planes.iter().map(|plane| plane[component][*cell]).collect();
                let name = format!("column_{:02}_residual_{name}", k + 1);
                file.add_series(&name, "Pa", "z", self.spacing(), 0.0, &values);
            }
        }
    }

    fn add_section(&self, file: &mut FieldFile, section: &[Field; 6]) {
        let pitch = [self.grid.pitch[0], self.spacing()];
        let x = self.corner[0] + self.grid.centre(0, 0);
        for (component, field) in Component::ALL.iter().zip(section) {
            file.add_section(&format!("section_{}", component.name()), "Pa", pitch, x, field);
        }
        file.add_section("section_von_mises", "Pa", pitch, x, &von_mises(section));
    }

    fn describe(&self, file: &mut FieldFile, record: &SubsurfaceRecord, row: usize) {
        let body = match self.body {
            Side::Lower => "lower",
            Side::Upper => "upper",
        };
        file.set("body", body)
            .set("poisson", self.poisson)
            .set("section", self.centre([0, row])[1])
            .set("max_von_mises", record.max_von_mises)
            .set("position", record.position.to_vec())
            .set("max_shear", record.max_shear)
            .set("max_shear_position", record.max_shear_position.to_vec());
        for (name, value) in [
            ("max_surface_tension", record.max_surface_tension),
            ("max_interface_shear", record.max_interface_shear),
            ("max_interface_tension", record.max_interface_tension),
        ] {
            if let Some(value) = value {
                file.set(name, value);
            }
        }
        if let Some(position) = record.max_surface_tension_position {
            file.set("max_surface_tension_position", position.to_vec());
        }
        if let (Some(pass), Some(step)) = (record.pass, record.step) {
            file.set("pass", pass).set("step", step);
        }
        if !self.planes.is_empty() {
            file.set("planes", self.planes.clone());
        }
        if !self.columns.is_empty() {
            let centre = |cell: &[usize; 2]| self.centre(*cell);
            file.set("columns", self.columns.iter().flat_map(centre).collect::<Vec<_>>());
        }
    }

    fn spacing(&self) -> Metre {
        self.depths[1]
    }

    /// Centre of a cell on the body. Beyond the end of a body that repeats, it is that of the same cell of
    /// the body.
    fn centre(&self, cell: [usize; 2]) -> [Metre; 2] {
        [0, 1].map(|axis| {
            let (at, length) =
                (self.corner[axis] + self.grid.centre(axis, cell[axis]), self.of_body.extent()[axis]);
            if at > length && self.boundary.repeats(axis) { at - length } else { at }
        })
    }

    fn position(&self, at: &Extreme) -> [Metre; 3] {
        let [x, y] = self.centre(at.cell);
        [x, y, at.depth]
    }
}

impl SubsurfaceRecord {
    /// Reads the record from the file at `path`.
    ///
    /// # Errors
    /// [`Error::File`] if it cannot be read, or has no record.
    pub fn read(path: &Path) -> Result<Self> {
        let attributes = Fields::open(path)?.attributes()?;
        let numbers = |name: &str| match attributes.get(name) {
            Some(Attribute::Number(number)) => Some(vec![*number]),
            Some(Attribute::Numbers(numbers)) => Some(numbers.clone()),
            Some(Attribute::Integer(count)) => Some(vec![*count as f64]),
            _ => None,
        };
        let number = |name| Some(*numbers(name)?.first()?);
        let position = |name| <[f64; 3]>::try_from(numbers(name)?).ok();
        let record = || {
            Some(Self {
                pass: number("pass").map(|pass| pass as usize),
                step: number("step").map(|step| step as usize),
                max_von_mises: number("max_von_mises")?,
                position: position("position")?,
                max_shear: number("max_shear")?,
                max_shear_position: position("max_shear_position")?,
                max_surface_tension: number("max_surface_tension"),
                max_surface_tension_position: position("max_surface_tension_position"),
                max_interface_shear: number("max_interface_shear"),
                max_interface_tension: number("max_interface_tension"),
            })
        };
        let missing = || std::io::Error::new(std::io::ErrorKind::InvalidData, "no stress in it");
        record().ok_or_else(|| Error::File { path: path.to_owned(), source: missing() })
    }
}

/// Describes the stress in each layer, from the surface down, and at their upper faces. The tension at the lower faces has no
/// entry for the body below the layers.
fn describe_layers(file: &mut FieldFile, layers: &[LayerStress]) {
    if layers.is_empty() {
        return;
    }
    let each = |of: fn(&LayerStress) -> f64| layers.iter().map(of).collect::<Vec<_>>();
    file.set("layer_depth", each(|layer| layer.depth))
        .set("layer_max_von_mises", each(|layer| layer.von_mises.value))
        .set("layer_max_von_mises_depth", each(|layer| layer.von_mises.depth))
        .set("layer_max_tension_above", each(|layer| layer.tension.value))
        .set(
            "layer_max_tension_below",
            layers.iter().filter_map(|layer| layer.tension_below).collect::<Vec<_>>(),
        )
        .set("layer_max_shear_above", each(|layer| layer.shear))
        .set("layer_max_pull_above", each(|layer| layer.pull));
}

/// Returns the corner of the contact at a position on one of the bodies, in cells of the `lower` one.
fn corner(body: Side, position: &Position, lower: &Grid) -> [Metre; 2] {
    let [first_lower, first_upper] = position.places();
    let [dx, dy] = lower.pitch;
    match body {
        Side::Lower => [first_lower * dx, 0.0],
        Side::Upper => [first_upper * dx, ((lower.shape[1] - position.across) % lower.shape[1]) as f64 * dy],
    }
}
