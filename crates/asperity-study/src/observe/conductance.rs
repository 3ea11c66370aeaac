//! Conductance of the contacts of a case.

use std::sync::OnceLock;

use super::{Observer, Place};
use crate::case::{Case, ConductanceSpec};
use crate::fields::NamedField;
use crate::finish::params;
use crate::observed::{ConductanceRecord, Quantities};
use asperity_base::error::{Error, Result};
use asperity_base::units::Pascal;
use asperity_contact::conductance::{self, Conductance, JointRoughness, Kind, MAX_CORRELATED_FRACTION};
use asperity_contact::motion::{ObservedContact, Pair, Position};
use asperity_contact::operator::Operators;
use asperity_contact::solver::Params;

/// Computes the conductance of each contact.
pub(super) struct ConductanceObserver {
    spec: ConductanceSpec,
    operators: Operators,
    /// Composite conductivity of the bodies without their coatings.
    composite: f64,
    params: Params,
    /// Roughness of the undeformed gap of the bodies at full overlap, and what the correlations need besides.
    roughness: JointRoughness,
    hardness: Pascal,
    modulus: Pascal,
    /// Resistance with all cells in contact at full overlap, computed once.
    full: OnceLock<Option<f64>>,
}

impl ConductanceObserver {
    /// Creates the observer of a `case` with these bodies; `None` if it wants no conductance.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for conductivities without meaning.
    pub(super) fn of(case: &Case, pair: &Pair) -> Result<Option<Self>> {
        let Some(spec) = case.conductance else { return Ok(None) };
        let unknown = || Error::Unsupported("a conductance needs the conductivities of both bodies");
        let composite = case.composite_conductivity(spec.kind).ok_or_else(unknown)??;
        let [lower, upper] = [&case.lower, &case.upper].map(|body| body.conductor(spec.kind));
        let response = conductance::response(&lower.ok_or_else(unknown)??, &upper.ok_or_else(unknown)??)?;
        let boundary = case.contact.boundary;
        let largest = pair.grid(pair.lower_grid().shape[0].min(pair.upper_grid().shape[0]));
        let flush = pair.initial_gap(&Position::flush(largest.shape[0]));
        Ok(Some(Self {
            spec,
            operators: Operators::new(largest, response, boundary),
            composite,
            params: params(case),
            roughness: JointRoughness::new(&largest, &flush, [0, 1].map(|axis| boundary.repeats(axis))),
            hardness: pair.min_hardness(),
            modulus: pair.modulus(),
            full: OnceLock::new(),
        }))
    }

    /// Returns the resistance with all cells in contact at full overlap.
    fn full(&self, shape: [usize; 2]) -> Result<Option<f64>> {
        if let Some(full) = self.full.get() {
            return Ok(*full);
        }
        let full = conductance::full_resistance(self.operators.on(shape).as_mut(), &self.params)?;
        Ok(*self.full.get_or_init(|| full))
    }

    /// Returns the joint conductance by a correlation.
    fn correlation(&self, pressure: Pascal) -> Option<f64> {
        match self.hardness.is_finite() {
            true => self.roughness.cooper_mikic_yovanovich(self.composite, pressure, self.hardness),
            false => self.roughness.mikic(self.composite, pressure, self.modulus),
        }
    }
}

impl Observer for ConductanceObserver {
    type Record = ConductanceRecord;

    const NAME: &'static str = "conductance";

    fn every(&self) -> usize {
        self.spec.every
    }

    fn observe(
        &self,
        place: Place,
        contact: &ObservedContact<'_>,
    ) -> Result<(Vec<ConductanceRecord>, Vec<NamedField>)> {
        let shape = contact.grid.shape;
        let joint = self.spec.joint(self.composite);
        // A flux of the contact before would be nearer, but a resumed run does not know it.
        let start = Some(contact.pressure.as_ref());
        let mut operator = self.operators.on(shape);
        let gap = joint.gas.map(|_| &contact.gap);
        let found =
            conductance::solve(operator.as_mut(), &contact.touching, gap, &joint, start, &self.params)?;
        drop(operator);
        let full = if place.pass.is_none() { self.full(shape)? } else { None };
        let touching = contact.touching.iter().filter(|touches| **touches).count();
        let fraction = touching as f64 / contact.touching.len() as f64;
        let is_correlated = touching > 0 && fraction <= MAX_CORRELATED_FRACTION;
        let mean_pressure = contact.load / contact.grid.area();
        let quantities = Quantities {
            conductivity: self.composite,
            conductance: found.conductance,
            joint: found.joint_conductance(),
            resistance: found.resistance(),
            full,
            holm_greenwood: found.holm_greenwood,
            correlation: self.correlation(mean_pressure).filter(|_| is_correlated),
        };
        let (thermal, electrical) = quantities.of_kind(self.spec.kind);
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
            power: found.power(&joint, self.spec.drop),
            convolutions: found.stats.convolutions,
            residual: found.residual,
            thermal,
            electrical,
        };
        let Conductance { flux, .. } = found;
        let unit = match self.spec.kind {
            Kind::Thermal => "W/m²",
            Kind::Electrical => "A/m²",
        };
        let flux = flux.map(|flux| NamedField { name: "flux", unit, values: flux * self.spec.drop });
        Ok((vec![record], flux.into_iter().collect()))
    }
}
