//! The conductance of each contact of a case.

use std::collections::HashMap;
use std::sync::{Mutex, PoisonError};

use super::views::flux_unit;
use super::{ConductanceRecord, Joint, JointRoughness, MAX_CORRELATED_FRACTION, Quantities};
use super::{composite, conductor, full_resistance, response, solve};
use crate::error::{Error, Result};
use crate::motion::{ObservedContact, Paraboloid, Position};
use crate::operator::{Boundary, Operators};
use crate::solver::Params;
use crate::units::{NewtonPerMetre, Pascal};
use crate::with::{Given, NamedField, Observer, Place};

/// Computes the conductance of each contact.
pub struct ConductanceObserver {
    joint: Joint,
    operators: Operators,
    /// Composite conductivity of the bodies without their layers.
    composite: f64,
    params: Params,
    /// Roughness of the undeformed gap of the bodies at full overlap, and what the correlations need besides.
    roughness: JointRoughness,
    hardness: Pascal,
    modulus: Pascal,
    /// Whether the bodies are curved: their spots lie around one place, and have no joint.
    is_curved: bool,
    /// Whether the conductance is in proportion to the stiffness of an elastic contact.
    is_clean: bool,
    /// Resistances with all cells in contact of the overlaps so far, by their columns.
    full: Mutex<HashMap<usize, Option<f64>>>,
}

impl ConductanceObserver {
    pub(super) fn new(joint: &Joint, given: &Given<'_>) -> Result<Self> {
        let Given { pair, surroundings, params } = given;
        let unknown = || Error::Unsupported("a conductance needs the conductivities of both bodies");
        let [lower, upper] = surroundings.bodies.each_ref().map(|body| conductor(body, joint.kind));
        let response = response(&lower.ok_or_else(unknown)??, &upper.ok_or_else(unknown)??)?;
        let boundary = surroundings.boundary;
        let largest = pair.grid(pair.lower_grid().shape[0].min(pair.upper_grid().shape[0]));
        let flush = pair.initial_gap(&Position::flush(largest.shape[0]));
        Ok(Self {
            joint: *joint,
            operators: Operators::new(largest, response, boundary),
            composite: composite(&surroundings.bodies, joint.kind).ok_or_else(unknown)??,
            params: *params,
            roughness: JointRoughness::new(&largest, &flush, [0, 1].map(|axis| boundary.repeats(axis))),
            hardness: pair.min_hardness(),
            modulus: pair.modulus(),
            is_curved: boundary != Boundary::PERIODIC && Paraboloid::fit(&flush, largest.pitch).is_some(),
            is_clean: joint.film.is_none()
                && joint.gas.is_none()
                && surroundings.bodies.iter().all(|body| !body.material.is_layered()),
            full: Mutex::default(),
        })
    }

    /// Returns the resistance with all cells of an overlap in contact.
    fn full(&self, shape: [usize; 2]) -> Result<Option<f64>> {
        let known = || self.full.lock().unwrap_or_else(PoisonError::into_inner);
        if let Some(full) = known().get(&shape[0]) {
            return Ok(*full);
        }
        let full = full_resistance(self.operators.on(shape).as_mut(), &self.params)?;
        known().insert(shape[0], full);
        Ok(full)
    }

    /// Returns the conductance of a contact of this normal stiffness by Barber's identity.
    fn of_stiffness(&self, stiffness: NewtonPerMetre) -> Option<f64> {
        self.is_clean.then(|| stiffness * self.composite / self.modulus)
    }

    /// Returns the joint conductance by a correlation.
    fn correlation(&self, pressure: Pascal) -> Option<f64> {
        if self.hardness.is_finite() {
            self.roughness.cooper_mikic_yovanovich(self.composite, pressure, self.hardness)
        } else {
            self.roughness.mikic(self.composite, pressure, self.modulus)
        }
    }
}

impl Observer for ConductanceObserver {
    type Row = ConductanceRecord;

    fn observe(
        &self,
        place: Place,
        contact: &ObservedContact<'_>,
    ) -> Result<(Vec<ConductanceRecord>, Vec<NamedField>)> {
        let (shape, joint) = (contact.grid.shape, &self.joint);
        // A flux of the contact before would be nearer, but a resumed run does not know it.
        let start = Some(contact.pressure.as_ref());
        let mut operator = self.operators.on(shape);
        let gap = joint.gas.map(|_| &contact.gap);
        let found = solve(operator.as_mut(), &contact.touching, gap, joint, start, &self.params)?;
        drop(operator);
        let full = self.full(shape)?;
        let touching = contact.touching.iter().filter(|touches| **touches).count();
        let fraction = touching as f64 / contact.touching.len() as f64;
        let is_correlated = touching > 0 && fraction <= MAX_CORRELATED_FRACTION;
        let mean_pressure = contact.load / contact.grid.area();
        let record = ConductanceRecord {
            pass: place.pass,
            step: Some(place.step),
            load: contact.load,
            mean_pressure,
            contact_area: contact.grid.cell_area() * touching as f64,
            spots: found.spots.count() as f64,
            median_spot_cells: found.spots.median_cells,
            spot_share: found.shares.spots,
            gas_share: found.shares.gas,
            film_share: found.shares.film,
            power: found.power(joint),
            convolutions: found.stats.convolutions,
            residual: found.residual,
            quantities: Quantities {
                kind: joint.kind,
                conductivity: Some(self.composite),
                conductance: found.conductance,
                joint_conductance: found.joint_conductance(full).filter(|_| !self.is_curved),
                resistance: found.resistance(),
                resistance_full: full,
                conductance_of_stiffness: contact
                    .stiffness
                    .and_then(|stiffness| self.of_stiffness(stiffness)),
                resistance_holm_greenwood: found.holm_greenwood(self.composite),
                joint_correlation: self.correlation(mean_pressure).filter(|_| is_correlated),
            },
        };
        let unit = flux_unit(joint.kind);
        let flux = found.flux.map(|flux| NamedField::new("flux", unit, flux * joint.drop));
        Ok((vec![record], flux.into_iter().collect()))
    }
}
