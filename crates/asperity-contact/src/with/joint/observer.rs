//! The law of a joint, contact by contact.

use std::sync::{Mutex, PoisonError};

use super::{GapRoughness, JointRecord};
use crate::error::Result;
use crate::motion::{ObservedContact, corrected_area};
use crate::operator::{CoupledOperator, Operators};
use crate::reference::rough::{PERSSON_DECAY, bgt_area_fraction, persson_area_fraction};
use crate::solver::{Bounds, Params, tangential_stiffness};
use crate::units::Pascal;
use crate::with::{Given, NamedField, Observer, Place};

/// Computes the law of a joint under each load.
pub struct JointObserver {
    /// The tangential response; none of bodies whose response to shear is unknown.
    operator: Option<Mutex<Box<dyn CoupledOperator>>>,
    bounds: Bounds,
    modulus: Pascal,
    roughness: GapRoughness,
    params: Params,
}

impl JointObserver {
    pub(super) fn new(given: &Given<'_>) -> Result<Self> {
        let Given { pair, surroundings, params } = given;
        let grid = pair.lower_grid();
        let position = pair.at_rest();
        let operator = pair.response().coupled().map(|_| {
            let operators = Operators::new(grid, pair.response().clone(), surroundings.boundary);
            Mutex::new(operators.coupled_on(grid.shape))
        });
        Ok(Self {
            operator,
            bounds: pair.bounds(&position),
            modulus: pair.modulus(),
            roughness: GapRoughness::new(&grid, &pair.initial_gap(&position))?,
            params: *params,
        })
    }
}

impl Observer for JointObserver {
    type Row = JointRecord;

    fn observe(
        &self,
        place: Place,
        contact: &ObservedContact<'_>,
    ) -> Result<(Vec<JointRecord>, Vec<NamedField>)> {
        let ObservedContact { grid, touching, pressure, gap, load, .. } = contact;
        let mut elastic = touching.clone();
        for (cell, (is_elastic, p)) in elastic.iter_mut().zip(pressure.iter()).enumerate() {
            *is_elastic &= !self.bounds.caps(cell, *p);
        }
        let (stiffness, convolutions) = match &self.operator {
            Some(operator) => {
                let mut operator = operator.lock().unwrap_or_else(PoisonError::into_inner);
                let (stiffness, stats) = tangential_stiffness(&mut **operator, &elastic, &self.params)?;
                (stiffness, stats.convolutions)
            }
            None => (None, 0.0),
        };
        let touches: Vec<bool> = touching.iter().copied().collect();
        let mean_pressure = load / grid.area();
        let (rough, slope) = (self.roughness.rms_height(), self.roughness.rms_slope());
        let of_rough = |value: f64| Some(value).filter(|value| slope > 0.0 && value.is_finite());
        let mean_gap = gap.sum() / gap.len() as f64;
        let record = JointRecord {
            step: Some(place.step),
            load: *load,
            mean_pressure,
            stiffness_x: stiffness.map(|[x, _]| x),
            stiffness_y: stiffness.map(|[_, y]| y),
            corrected_fraction: corrected_area(&touches, grid, [true; 2]) / grid.area(),
            first_touch_gap: self.roughness.first_touch_gap,
            rms_height: rough,
            rms_slope: slope,
            nayak: self.roughness.nayak(),
            correlation_length: Some(self.roughness.correlation_length).filter(|length| length.is_finite()),
            modulus: self.modulus,
            persson_fraction: of_rough(persson_area_fraction(mean_pressure, self.modulus, slope)),
            bgt_fraction: of_rough(bgt_area_fraction(mean_pressure, self.modulus, slope)),
            persson_stiffness: of_rough(load / (PERSSON_DECAY * rough)),
            greenwood_williamson_pressure: self.roughness.pressure(self.modulus, mean_gap),
            convolutions,
        };
        Ok((vec![record], Vec::new()))
    }
}
