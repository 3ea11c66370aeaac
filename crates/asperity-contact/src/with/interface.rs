//! The interface of the bodies of a case: hard walls, or that of the table that is given.

use std::sync::Arc;

use serde::{Deserialize, Serialize};

use super::views::{Answer, Line};
use super::{Interfaces, adhesion};
use crate::adhesion::Adhesion;
use crate::error::Result;
use crate::grid::{Field, Grid};
use crate::lubrication::Oil;
use crate::motion::{IncrementRecord, StaticRecord};
use crate::operator::Boundary;
use crate::solver::{HardWall, Interface, InterfaceCost, InterfacePassRecord, InterfaceRecord};
use crate::units::Pascal;
use asperity_base::record::Column;

impl Interfaces {
    /// Returns the interface of bodies with this composite modulus on a `grid`.
    ///
    /// # Errors
    /// [`Error::OutOfRange`](crate::Error::OutOfRange) for a value of the table.
    pub fn between(&self, grid: &Grid, modulus: Pascal) -> Result<Arc<dyn Interface>> {
        Ok(match &self.adhesion {
            None => Arc::new(HardWall),
            Some(attraction) => Arc::new(attraction.on(grid, modulus)?),
        })
    }

    /// Returns what is known before anything is solved, for bodies with this composite modulus and this
    /// initial `gap`: numbers, and reasons not to trust the result.
    ///
    /// # Errors
    /// The errors of [`Self::between`].
    pub fn numbers(
        &self,
        grid: &Grid,
        gap: &Field,
        boundary: Boundary,
        modulus: Pascal,
    ) -> Result<(InterfaceNumbers, Vec<String>)> {
        let Some(attraction) = &self.adhesion else { return Ok(Default::default()) };
        let (numbers, doubts) = attraction.numbers(grid, gap, boundary, modulus)?;
        Ok((InterfaceNumbers { adhesion: Some(numbers) }, doubts))
    }

    /// Whether the contact at each position of a pass begins with that at the position before.
    pub fn follows_path(&self) -> bool {
        self.adhesion.is_some_and(|attraction| attraction.follows_path())
    }

    /// Returns the cost of a contact; `None` between hard walls.
    pub fn cost(&self) -> Option<InterfaceCost> {
        self.adhesion.map(|_| Adhesion::COST)
    }

    /// Returns its name and its description for `asperity check`, with its `numbers` or its `oil`; `None` of hard
    /// walls.
    pub fn describe(&self, numbers: &InterfaceNumbers, oil: Option<&Oil>) -> Option<(&'static str, String)> {
        let attraction = self.adhesion.as_ref();
        let attraction =
            attraction.map(|table| (adhesion::Attraction::NAME, table.describe(numbers.adhesion.as_ref())));
        attraction
            .or_else(|| self.lubrication.as_ref().zip(oil).map(|(table, oil)| ("oil", table.describe(oil))))
    }
}

/// The interface of two bodies in numbers, in `summary.json`; nothing of hard walls.
#[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
#[non_exhaustive]
pub struct InterfaceNumbers {
    /// Attraction of the bodies.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub adhesion: Option<adhesion::AdhesionSummary>,
}

impl InterfaceNumbers {
    /// The groups of columns of interfaces, by the names of their records: of a contact, of a pass and of a
    /// summary.
    pub const GROUPS: [(&'static str, &'static [Column]); 3] = [
        ("AdhesionRecord", InterfaceRecord::OWN_COLUMNS),
        ("AdhesionPassRecord", InterfacePassRecord::OWN_COLUMNS),
        ("AdhesionSummary", adhesion::AdhesionSummary::OWN_COLUMNS),
    ];

    /// The columns that answer the question of the user, each with its name.
    pub const ANSWERS: &'static [(&'static str, &'static str)] = &adhesion::ANSWERS;

    /// Adds what the increments of a loading show.
    #[must_use]
    pub fn after(self, increments: &[IncrementRecord]) -> Self {
        Self { adhesion: self.adhesion.map(|numbers| numbers.after(increments)) }
    }

    /// Returns the record of the numbers.
    pub fn record(&self) -> Option<&impl Serialize> {
        self.adhesion.as_ref()
    }

    /// Returns the numbers for the terminal.
    pub fn lines(&self) -> Vec<Line> {
        self.adhesion.iter().flat_map(adhesion::AdhesionSummary::lines).collect()
    }

    /// Returns the record of a contact at rest for people: 0 where a force, a pressure or an energy is
    /// nothing beside the largest, as the attraction of separated bodies.
    pub fn as_shown(&self, record: &StaticRecord) -> StaticRecord {
        /// Share of the largest value below which the tolerance of the solver decides.
        const NOTHING: f64 = 1e-7;
        let [force, pressure, energy] =
            self.adhesion.as_ref().map_or([0.0; 3], adhesion::AdhesionSummary::scales);
        let force = force.max(record.load.abs());
        let pressure = pressure.max(record.max_pressure);
        let energy = energy.max(record.elastic_energy);
        let shown = |value: f64, scale: f64| if value.abs() < NOTHING * scale { 0.0 } else { value };
        StaticRecord {
            load: shown(record.load, force),
            max_pressure: shown(record.max_pressure, pressure),
            elastic_energy: shown(record.elastic_energy, energy),
            interface: record.interface.map(|interface| InterfaceRecord {
                adhesive_load: shown(interface.adhesive_load, force),
                min_pressure: shown(interface.min_pressure, pressure),
                adhesion_energy: shown(interface.adhesion_energy, energy),
                ..interface
            }),
            ..record.clone()
        }
    }

    /// Returns what a contact at rest with this `record` shows.
    pub fn answers(&self, record: &InterfaceRecord) -> Vec<Answer> {
        adhesion::answers(self.adhesion.as_ref(), record)
    }
}
