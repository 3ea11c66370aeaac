//! `asperity flow`: the flow of a fluid through a gap from a file.

use std::path::Path;

use asperity::flow::{self, Along, Ends, Faces, FlowAlong, Fluid, Leakage, Settings, Sides};
use asperity::io::fields::FieldFile;
use asperity::units::{Dimension, Metre, format, format_number};
use asperity::with::Capability;
use asperity::with::views::Line;
use asperity::{Field, Grid};
use clap::Args;
use serde_json::{Value, json};

use crate::args::values::{choice, default};
use crate::args::{Input, RangedDrawing, Writing, within};
use crate::machine;
use crate::maps::{self, Files, line};
use crate::report::{Outcome, print, report_warning};
use asperity_report::draw::{Quantity, Unit};
use asperity_report::figures::field_map;

/// Names of the axes.
const AXES: [&str; 2] = ["x", "y"];

/// Compute the flow of a fluid through a gap from a map of the gap
///
/// Reads the gap as heights, in any format of `asperity surface info`. Cells whose gap is not positive are
/// closed. Prints permeability, leakage and the critical constriction. The pressure of the fluid does not
/// deform the bodies.
#[derive(Debug, Args)]
#[command(after_help = "Examples:\n  asperity flow gap.npy --pitch 1um --viscosity 80mPas --pressure 1bar
  asperity flow gap.x3p --viscosity 0.018mPas --pressure 4bar --outlet 1bar --ends reservoirs --sides closed --out leak")]
pub(crate) struct Flow {
    /// Viscosity of the fluid, such as 80mPas; required for the leakage
    #[arg(long, value_name = "VALUE", requires = "pressure", value_parser = viscosity)]
    pub(crate) viscosity: Option<f64>,
    /// Pressure difference over the length of the gap, such as 1bar; required for the leakage
    #[arg(long, value_name = "PRESSURE", requires = "viscosity", value_parser = drop)]
    pub(crate) pressure: Option<f64>,
    /// Absolute pressure of an ideal gas at the outlet, such as 1bar; default: the fluid is a liquid
    #[arg(long, value_name = "PRESSURE", requires = "viscosity", value_parser = pressure)]
    pub(crate) outlet: Option<f64>,
    /// Direction of the pressure gradient
    #[arg(long, default_value = default::<Along>(), value_parser = choice::<Along>())]
    pub(crate) along: Along,
    /// Ends of the gap along the gradient: it repeats itself, or the fluid has a given pressure at each end
    #[arg(long, default_value = default::<Ends>(), value_parser = choice::<Ends>())]
    pub(crate) ends: Ends,
    /// Sides of the gap: it repeats itself, or has walls
    #[arg(long, default_value = default::<Sides>(), value_parser = choice::<Sides>())]
    pub(crate) sides: Sides,
    /// Transmissibility between two cells: for a gap linear between their centres, or the harmonic mean
    #[arg(long, default_value = default::<Faces>(), value_parser = choice::<Faces>())]
    pub(crate) faces: Faces,
    #[command(flatten)]
    pub(crate) writing: Writing,
    #[command(flatten)]
    pub(crate) drawing: RangedDrawing,
    #[command(flatten)]
    pub(crate) input: Input,
}

pub(crate) fn flow(arguments: &Flow) -> Outcome {
    let files = Files::new(&arguments.writing, &arguments.input.file, arguments.drawing.papers())?;
    let fluid = fluid(arguments)?;
    let gap = maps::read(&arguments.input)?;
    let (gap, grid) = (gap.heights(), gap.grid());
    machine::holds(flow::memory(grid.shape))?;
    let Flow { ends, sides, faces, along, .. } = *arguments;
    let found = flow::solve(gap, grid, &Settings { ends, sides, faces, along })?;
    let leakage = |along: &FlowAlong| fluid.map(|fluid| along.leakage(&fluid)).transpose();
    let leakage = found.along.iter().flatten().map(leakage).collect::<asperity::Result<Vec<_>>>()?;
    let found = Found { gap, grid, fluid, leakage, flow: found };
    let json = format!("{:#}\n", found.json());
    if let Some(files) = &files {
        files.write("flow.json", json.as_bytes())?;
        found.write_fields(&files.path("fields.h5"))?;
        found.draw(files)?;
    }
    for warning in found.doubts() {
        report_warning(&warning);
    }
    print(&if arguments.writing.json { json } else { found.text() })
}

/// The fluid; none without its viscosity.
fn fluid(arguments: &Flow) -> Outcome<Option<Fluid>> {
    let Flow { viscosity, pressure, outlet, .. } = *arguments;
    let fluid = viscosity.zip(pressure).map(|(viscosity, drop)| Fluid { viscosity, drop, outlet });
    fluid.map_or(Ok(()), |fluid| fluid.check())?;
    Ok(fluid)
}

/// A gap with the flow through it.
struct Found<'a> {
    gap: &'a Field,
    grid: &'a Grid,
    fluid: Option<Fluid>,
    /// Leakage along each computed axis.
    leakage: Vec<Option<f64>>,
    flow: flow::Flow,
}

impl Found<'_> {
    /// The computed axes with their flow and leakage.
    fn along(&self) -> impl Iterator<Item = (usize, &FlowAlong, Option<f64>)> {
        let along =
            self.flow.along.iter().enumerate().filter_map(|(axis, along)| Some((axis, along.as_ref()?)));
        along.zip(&self.leakage).map(|((axis, along), leakage)| (axis, along, *leakage))
    }

    /// The centre of the critical constriction.
    fn place(&self, along: &FlowAlong) -> Option<[Metre; 2]> {
        along.critical_cell.map(|cell| [0, 1].map(|axis| self.grid.centre(axis, cell[axis])))
    }

    /// Reasons in the flow itself not to trust it.
    fn doubts(&self) -> Vec<String> {
        let cells = self.along().map(|(_, along, _)| along.critical_cells).filter(|cells| *cells > 0);
        let narrowest = cells.min().filter(|_| self.flow.closed_share > 0.0);
        let estimate = self.along().map(|(_, along, _)| along.estimate).fold(0.0, f64::max);
        flow::doubts(narrowest, estimate)
    }

    fn text(&self) -> String {
        let flow = &self.flow;
        let closed = format_number(100.0 * flow.closed_share);
        let mean = format(flow.mean_gap, Dimension::Length);
        let mut text = line("gap", &format!("{}; mean {mean}, {closed} % closed", maps::cells(self.grid)));
        for (axis, along, leakage) in self.along() {
            let name = AXES[axis];
            let permeability = format(along.permeability, Dimension::Volume);
            let (what, value) = match leakage {
                Some(leakage) => (format!("leakage along {name}"), format(leakage, Dimension::VolumeFlow)),
                None => (format!("flow along {name}"), format!("permeability {permeability}")),
            };
            let rows = flow::leaks(what, value, along.critical_gap, self.place(along), along.estimate);
            text.extend(rows.iter().map(|Line { name, value, .. }| line(name, value)));
            if along.permeability > 0.0 {
                let factor = format_number(along.flow_factor);
                let medium = format_number(flow.effective_medium / flow.mean_gap.powi(3));
                text += &line("flow factor", &format!("{factor}, an effective medium has {medium}"));
                if leakage.is_some() {
                    text += &line("permeability", &permeability);
                }
            }
            let [share, trapped] =
                [format_number(100.0 * along.flowing_share), format(along.trapped_volume, Dimension::Volume)];
            text += &line("flowing", &format!("{share} % of the cells; trapped volume {trapped}"));
        }
        text
    }

    fn json(&self) -> Value {
        let flow = &self.flow;
        let along = self.along().map(|(axis, along, leakage)| {
            let json = json!({
                "permeability": along.permeability,
                "hydraulic_gap": along.hydraulic_gap,
                "flow_factor": along.flow_factor,
                "leakage": leakage,
                "critical_gap": along.critical_gap,
                "critical_cell": along.critical_cell,
                "critical_position": self.place(along),
                "critical_cells": along.critical_cells,
                "flowing_share": along.flowing_share,
                "trapped_volume": along.trapped_volume,
                "other_faces": along.other_faces,
                "estimate": along.estimate,
                "residual": along.residual,
                "dissipation": along.dissipation,
            });
            (AXES[axis].to_owned(), json)
        });
        json!({
            "shape": self.grid.shape,
            "pitch": self.grid.pitch,
            "mean_gap": flow.mean_gap,
            "closed_share": flow.closed_share,
            "permeability": flow.permeability(),
            "effective_medium": flow.effective_medium,
            "along": along.collect::<serde_json::Map<_, _>>(),
        })
    }

    /// Writes the gap, and pressure and flow along each axis; without a fluid as shares of its pressure, and
    /// as fluxes per gradient.
    fn write_fields(&self, path: &Path) -> Outcome {
        let mut file = FieldFile::new(path);
        file.set("version", env!("CARGO_PKG_VERSION"));
        let mut add = |name: &str, unit: &str, values: &Field| {
            file.add_field(name, unit, self.grid, [0.0; 2], values);
        };
        add("gap", "m", self.gap);
        for (axis, along, _) in self.along() {
            let axis = AXES[axis];
            match &self.fluid {
                Some(fluid) => {
                    add(&format!("fluid_pressure_{axis}"), "Pa", &along.pressure_of(fluid));
                    add(&format!("flow_{axis}"), "m²/s", &along.rate_of(fluid));
                }
                None => {
                    add(&format!("fluid_pressure_share_{axis}"), "1", &along.pressure);
                    add(&format!("flux_{axis}"), "m³", &magnitude(along));
                }
            }
        }
        Ok(file.write()?)
    }

    /// Draws the map of the flow along each axis that has a path.
    fn draw(&self, files: &Files) -> Outcome {
        for (axis, along, _) in self.along().filter(|(_, along, _)| along.permeability > 0.0) {
            let (rate, quantity) = match &self.fluid {
                Some(fluid) if fluid.drop > 0.0 => {
                    (along.rate_of(fluid), Quantity::new("flow per width", Unit::Of("m²/s")))
                }
                _ => (magnitude(along), Quantity::new("flow per width, gradient and 1/12η", Unit::Of("m³"))),
            };
            let map = &Leakage::MAPS[axis];
            let drawn = field_map(map, &rate, self.grid, quantity, self.place(along));
            files.draw(map.field, map.title, &drawn)?;
        }
        Ok(())
    }
}

/// The flux per width over the mean gradient and 1/12η, m³.
fn magnitude(along: &FlowAlong) -> Field {
    let [mut flux, across] = along.flux_at_centres();
    flux.zip_mut_with(&across, |flux, across| *flux = flux.hypot(*across));
    flux
}

fn viscosity(text: &str) -> Result<f64, String> {
    within(text, Dimension::Viscosity, false)
}

fn pressure(text: &str) -> Result<f64, String> {
    within(text, Dimension::Pressure, false)
}

fn drop(text: &str) -> Result<f64, String> {
    within(text, Dimension::Pressure, true)
}
