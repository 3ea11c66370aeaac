//! `asperity conductance`: the conductance of a contact from a file.

use asperity::conductance::{self, Conductance as Solved, Gas, Joint, Kind, composite_conductivity};
use asperity::io::fields::FieldFile;
use asperity::operator::Operators;
use asperity::solver::Params;
use asperity::surface::Topography;
use asperity::units::format_number;
use asperity::{Choice, Field};
use serde_json::{Value, json};

use crate::args::Conductance;
use crate::machine;
use crate::maps::{self, Files, line};
use crate::report::{Failure, Outcome, print, report_warning};
use asperity_report::draw::Unit;
use asperity_report::figures::{FLUX, flux_map};
use asperity_report::words::passage;

/// Memory of a solution, bytes a cell.
const MEMORY: f64 = 260.0;

pub(crate) fn conductance(arguments: &Conductance) -> Outcome {
    let usage = |message| Failure::usage(message, None);
    let [lower, upper] = arguments.conductivities().map_err(usage)?;
    let film = arguments.film().map_err(usage)?;
    if let (Some(_), Kind::Electrical) = (arguments.gas, arguments.kind) {
        let message = "--gas is given with --kind electrical: gas conducts heat, but no current";
        return Err(Failure::usage(message, None));
    }
    let files = Files::new(&arguments.writing, &arguments.input.file, arguments.drawing.paper())?;
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
    let mut joint = Joint::new(arguments.kind, composite).with_film(film);
    if let Some(conductivity) = arguments.gas {
        joint = joint.with_gas(Gas { conductivity, jump: arguments.jump.unwrap_or(0.0) });
    }
    let params = Params::default();
    let mut operator = Operators::new(grid, composite, arguments.boundary).on(grid.shape);
    let gap = gap.as_ref().map(Topography::heights);
    let solved = conductance::solve(operator.as_mut(), &touching, gap, &joint, None, &params)?;
    let full = conductance::full_resistance(operator.as_mut(), &params)?;
    let touching = touching.iter().filter(|touches| **touches).count();
    let found = Found { kind: arguments.kind, solved, full, touching };

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
        let Solved { grid, shares, spots, holm_greenwood, .. } = &self.solved;
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
        let rows = passage::conducts(self.kind, self.solved.conductance, self.solved.joint_conductance());
        text.extend(rows.iter().map(|(name, value)| line(name, value)));
        if let Some(full) = self.full {
            let full = passage::resistance(self.kind, full);
            text += &line("all in contact", &format!("resistance {full}: that of the bodies around the map"));
        }
        if let Some(estimate) = holm_greenwood {
            let estimate = passage::resistance(self.kind, *estimate);
            text += &line("Holm, Greenwood", &format!("resistance of the spots about {estimate}"));
        }
        let [spots, gas, film] = [shares.spots, shares.gas, shares.film].map(percent);
        text += &line(
            "passes",
            &format!("spots {spots}, gas {gas} of what passes; film {film} of the resistance"),
        );
        text
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
            "joint_conductance": self.solved.joint_conductance(),
            "resistance": self.solved.resistance(),
            "full_resistance": self.full,
            "holm_greenwood": self.solved.holm_greenwood,
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
                files.draw("flux", FLUX, &flux_map(flux, &self.solved.grid, Unit::Of(unit)))
            }
            _ => Ok(()),
        }
    }
}
