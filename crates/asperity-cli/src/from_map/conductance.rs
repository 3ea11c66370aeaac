//! `asperity conductance`: the conductance of a contact from a file.

use std::path::PathBuf;

use asperity::conductance::{self, Conductance as Solved, Joint, Kind, composite_conductivity};
use asperity::io::fields::FieldFile;
use asperity::operator::{Boundary, Edge, Operators};
use asperity::solver::Params;
use asperity::surface::Topography;
use asperity::units::{Dimension, format_number};
use asperity::with::Capability;
use asperity::with::views::Line;
use asperity::{Choice, Field};
use clap::Args;
use serde_json::{Value, json};

use crate::args::values::{boundary, choice, default};
use crate::args::{Input, RangedDrawing, Writing, within};
use crate::machine;
use crate::maps::{self, Files, line};
use crate::report::{Failure, Outcome, print, report_warning};
use asperity_report::draw::{Quantity, Unit};
use asperity_report::figures::field_map;

/// Memory of a solution, bytes a cell.
const MEMORY: f64 = 260.0;

/// Compute the conductance of a contact from a map of the cells that touch
///
/// Reads a mask, a map of pressure or an image of the contact, in any format of `asperity surface info`.
/// Cells above 0 touch, see --above and --below. Heat or current passes these cells, a film on them, and gas
/// in the gap. The bodies are half-spaces below their surfaces.
#[derive(Debug, Args)]
#[command(
    after_help = "Examples:\n  asperity conductance pressure.npy --pitch 1um --conductivity '46 W/(m K)' --boundary periodic
  asperity conductance pressure.npy --pitch 1um --conductivity '46 W/(m K)' --gap gap.npy --gas '0.026 W/(m K)' --jump 0.37um
  asperity conductance contact.tif --pitch 1um --below 100 --kind electrical --conductivity '58 MS/m,38 MS/m' --film '1e-12 ohm m2'"
)]
pub(crate) struct Conductance {
    /// Conductivity of both bodies, or of the lower and the upper one, of which one may be `inf`
    #[arg(long, value_name = "VALUE[,VALUE]")]
    pub(crate) conductivity: String,
    /// Whether heat or current passes
    #[arg(long, default_value = default::<Kind>(), value_parser = choice::<Kind>())]
    pub(crate) kind: Kind,
    /// Surroundings of the map, for both axes or for each
    #[arg(long, value_name = "free|periodic[,free|periodic]", default_value = default::<Edge>(), value_parser = boundary)]
    pub(crate) boundary: Boundary,
    /// Resistance of an area of the film on the spots, such as `1e-8 m2 K/W` or `1e-12 ohm m2`; default: none
    #[arg(long, value_name = "VALUE")]
    pub(crate) film: Option<String>,
    /// Conductivity of a gas in the gap, such as `0.026 W/(m K)`; default: none
    #[arg(long, value_name = "VALUE", requires = "gap", value_parser = positive_conductivity)]
    pub(crate) gas: Option<f64>,
    /// Temperature jump distance of the gas at both surfaces together, such as 0.37um; default: 0
    #[arg(long, value_name = "LENGTH", requires = "gas", value_parser = length)]
    pub(crate) jump: Option<f64>,
    /// Gap between the bodies for the gas: a file, read and prepared as the map of the contact
    #[arg(long, value_name = "FILE", requires = "gas")]
    pub(crate) gap: Option<PathBuf>,
    /// Cells above this number touch, in the units of the file, or in metres
    #[arg(long, value_name = "NUMBER", default_value_t = 0.0, allow_hyphen_values = true, value_parser = number)]
    pub(crate) above: f64,
    /// Cells below this number touch, not those above one
    #[arg(long, value_name = "NUMBER", conflicts_with = "above", allow_hyphen_values = true, value_parser = number)]
    pub(crate) below: Option<f64>,
    #[command(flatten)]
    pub(crate) writing: Writing,
    #[command(flatten)]
    pub(crate) drawing: RangedDrawing,
    #[command(flatten)]
    pub(crate) input: Input,
}

impl Conductance {
    /// Returns the conductivities of both bodies, lower first, which may be infinite.
    ///
    /// # Errors
    /// The reason, with the name of the option.
    pub(crate) fn conductivities(&self) -> Result<[f64; 2], String> {
        let dimension = self.kind.conductivity();
        let positive = |text: &str| match text.trim() {
            "inf" => Ok(f64::INFINITY),
            text => within(text, dimension, false),
        };
        let parts = self.conductivity.split(',').map(positive).collect::<Result<Vec<_>, _>>();
        let both = match parts.as_deref() {
            Ok([both]) => Ok([*both; 2]),
            Ok([lower, upper]) => Ok([*lower, *upper]),
            Ok(_) => Err("expected one value, or two with a comma between".to_owned()),
            Err(error) => Err(error.clone()),
        };
        let both = both.and_then(|both| {
            if both.iter().any(|value| value.is_finite()) {
                Ok(both)
            } else {
                Err("expected a finite conductivity of one body at least".to_owned())
            }
        });
        both.map_err(|error| format!("invalid value '{}' for --conductivity: {error}", self.conductivity))
    }

    /// Returns the resistance of an area of the film; 0 without one.
    ///
    /// # Errors
    /// The reason, with the name of the option.
    pub(crate) fn film(&self) -> Result<f64, String> {
        let Some(text) = &self.film else { return Ok(0.0) };
        let film = within(text, self.kind.insulance(), true);
        film.map_err(|error| format!("invalid value '{text}' for --film: {error}"))
    }
}

pub(crate) fn conductance(arguments: &Conductance) -> Outcome {
    let usage = |message| Failure::usage(message, None);
    let [lower, upper] = arguments.conductivities().map_err(usage)?;
    let film = arguments.film().map_err(usage)?;
    if let (Some(_), Kind::Electrical) = (arguments.gas, arguments.kind) {
        let message = "--gas is given with --kind electrical: gas conducts heat, but no current";
        return Err(Failure::usage(message, None));
    }
    let files = Files::new(&arguments.writing, &arguments.input.file, arguments.drawing.papers())?;
    let contact = maps::read(&arguments.input)?;
    let gap = arguments.gap.as_ref().map(|path| maps::read_gap(path, &arguments.input, &contact));
    let gap = gap.transpose()?;
    let grid = *contact.grid();
    machine::holds(MEMORY * grid.cells() as f64)?;

    let touching = contact.heights().mapv(|value| match arguments.below {
        Some(below) => value < below,
        None => value > arguments.above,
    });
    let composite = composite_conductivity(lower, upper)?;
    let mut joint = Joint::new(arguments.kind).with_film(film);
    if let Some(conductivity) = arguments.gas {
        joint = joint.with_gas(conductivity, arguments.jump.unwrap_or(0.0));
    }
    let params = Params::default();
    let mut operator = Operators::new(grid, composite, arguments.boundary).on(grid.shape);
    let gap = gap.as_ref().map(Topography::heights);
    let solved = conductance::solve(operator.as_mut(), &touching, gap, &joint, None, &params)?;
    let full = conductance::full_resistance(operator.as_mut(), &params)?;
    let touching = touching.iter().filter(|touches| **touches).count();
    let holm_greenwood = solved.holm_greenwood(composite);
    let found = Found { kind: arguments.kind, solved, full, holm_greenwood, touching };

    let json = format!("{:#}\n", found.json());
    if let Some(files) = &files {
        files.write("conductance.json", json.as_bytes())?;
        found.write(files, contact.heights())?;
    }
    for warning in found.doubts() {
        report_warning(&warning);
    }
    print(&if arguments.writing.json { json } else { found.text() })
}

/// A contact with its conductance.
struct Found {
    kind: Kind,
    solved: Solved,
    /// Resistance with all cells in contact.
    full: Option<f64>,
    /// Resistance of the spots by the estimate of Holm and Greenwood.
    holm_greenwood: Option<f64>,
    /// Number of cells in contact.
    touching: usize,
}

impl Found {
    /// Reasons in the conductance itself not to trust it.
    fn doubts(&self) -> Vec<String> {
        let cells = if self.touching > 0 { self.solved.spots.median_cells } else { f64::INFINITY };
        conductance::doubts(cells, self.solved.shares.film)
    }

    fn text(&self) -> String {
        let Solved { grid, shares, spots, .. } = &self.solved;
        let percent = |share: f64| format!("{} %", format_number(100.0 * share));
        let mut contact = format!(
            "{}; {} in contact",
            maps::cells(grid),
            percent(self.touching as f64 / grid.cells() as f64)
        );
        match spots.count() {
            0 => {}
            1 => contact += ", one spot",
            count => {
                contact += &format!(", {count} spots, median {} cells", format_number(spots.median_cells));
            }
        }
        let mut text = line("contact", &contact);
        let joint = self.solved.joint_conductance(self.full);
        let rows = conductance::conducts(self.kind, self.solved.conductance, joint);
        text.extend(rows.iter().map(|Line { name, value, .. }| line(name, value)));
        if let Some(full) = self.full {
            let full = conductance::resistance(self.kind, full);
            text += &line(
                "all in contact",
                &format!(
                    "resistance {full}: that of the spreading from the outline of the map, without the joint"
                ),
            );
        }
        if let Some(estimate) = self.holm_greenwood {
            let estimate = conductance::resistance(self.kind, estimate);
            text += &line("Holm, Greenwood", &format!("resistance of the spots about {estimate}"));
        }
        let shares = [shares.spots, shares.gas, shares.film].map(percent);
        text + &line("passes", &conductance::shares(shares))
    }

    fn json(&self) -> Value {
        let Solved { grid, shares, spots, .. } = &self.solved;
        json!({
            "kind": self.kind.word(),
            "shape": grid.shape,
            "pitch": grid.pitch,
            "contact_area": grid.cell_area() * self.touching as f64,
            "contact_fraction": self.touching as f64 / grid.cells() as f64,
            "conductance": self.solved.conductance,
            "joint_conductance": self.solved.joint_conductance(self.full),
            "resistance": self.solved.resistance(),
            "full_resistance": self.full,
            "holm_greenwood": self.holm_greenwood,
            "spot_share": shares.spots,
            "gas_share": shares.gas,
            "film_share": shares.film,
            "spots": spots.count(),
            "median_cells": spots.median_cells,
            "iterations": self.solved.stats.iterations,
            "residual": self.solved.residual,
        })
    }

    /// Writes the fields and draws the flux per unit drop.
    fn write(&self, files: &Files, contact: &Field) -> Outcome {
        let unit = match self.kind {
            Kind::Thermal => "W/(m² K)",
            Kind::Electrical => "S/m²",
        };
        let mut file = FieldFile::new(&files.path("fields.h5"));
        file.set("version", env!("CARGO_PKG_VERSION"));
        file.add_field("contact", "1", &self.solved.grid, [0.0; 2], contact);
        if let Some(flux) = &self.solved.flux {
            file.add_field("flux", unit, &self.solved.grid, [0.0; 2], flux);
        }
        file.write()?;
        match &self.solved.flux {
            Some(flux) if flux.iter().any(|flux| *flux > 0.0) => {
                let [map, ..] = Joint::MAPS else { unreachable!("a flux has a map") };
                let quantity = Quantity::new(map.quantity, Unit::Of(unit));
                files.draw(map.field, map.title, &field_map(map, flux, &self.solved.grid, quantity, None))
            }
            _ => Ok(()),
        }
    }
}

fn positive_conductivity(text: &str) -> Result<f64, String> {
    within(text, Dimension::Conductivity, false)
}

fn length(text: &str) -> Result<f64, String> {
    within(text, Dimension::Length, true)
}

fn number(text: &str) -> Result<f64, String> {
    let number = text.trim().parse().ok().filter(|number: &f64| number.is_finite());
    number.ok_or_else(|| "expected a number".to_owned())
}
