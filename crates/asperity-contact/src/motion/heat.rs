//! Flash temperature over the passes of a motion, computed in every pass or in every n-th.

use std::sync::{Mutex, PoisonError};

use crate::grid::{CellValues, Field};
use crate::motion::body::State;
use crate::motion::contact::Contact;
use crate::motion::law::Heat;
use crate::motion::pair::Pair;
use crate::motion::path::Position;
use crate::temperature::FlashTemperature;
use crate::units::Kelvin;

/// Name of the body state that stores the mean temperature rise of each cell over its contacts of the last
/// pass with a computed flash temperature, K. It exists only if the flash temperature is not computed in
/// every pass.
pub const FLASH: &str = "flash_temperature";

/// The flash temperature of every n-th computed pass.
pub(super) struct PassHeat {
    flash: Mutex<FlashTemperature>,
    every: usize,
}

impl PassHeat {
    pub(super) fn new(flash: FlashTemperature, every: usize) -> Self {
        Self { flash: Mutex::new(flash), every }
    }

    /// Returns the temperature model of the pass after `done` computed ones, position by position, for a
    /// `pair` with these `bulk` temperatures.
    pub(super) fn of_pass(&self, done: usize, pair: &Pair, bulk: [Kelvin; 2]) -> Box<Heat<'_>> {
        if self.is_computed(done) {
            let mut flash = self.flash.lock().unwrap_or_else(PoisonError::into_inner);
            flash.begin();
            return Box::new(move |cells: [&[u32]; 2], position: &Position, flux: &[f64]| {
                Ok(flash.step_between(cells, position.fraction, flux)?.temperature)
            });
        }
        let shapes = [pair.lower_grid().shape, pair.upper_grid().shape];
        let rise = [&pair.lower, &pair.upper].map(|body| {
            body.state.get(FLASH).map_or(CellValues::Uniform(0.0), |state| state.values.clone().into())
        });
        Box::new(move |cells: [&[u32]; 2], position: &Position, _: &[f64]| {
            let placements = position.placements(shapes);
            // Both surfaces have the same temperature in contact.
            let of_body =
                |body: usize, cell: u32| bulk[body] + placements[body].value(&rise[body], cell as usize);
            let both = cells[0].iter().zip(cells[1]);
            Ok(both.map(|(&lower, &upper)| 0.5 * (of_body(0, lower) + of_body(1, upper))).collect())
        })
    }

    /// Stores in the bodies the temperatures used by passes without their own computation.
    pub(super) fn store_in_bodies(
        &self,
        done: usize,
        pair: &mut Pair,
        contacts: &[Contact],
        bulk: [Kelvin; 2],
    ) {
        if self.every == 1 || !self.is_computed(done) {
            return;
        }
        for (body, bulk) in bulk.into_iter().enumerate() {
            let shape = [&pair.lower, &pair.upper][body].heights.raw_dim();
            let [mut rise, mut weights] = [(); 2].map(|()| Field::zeros(shape));
            for contact in contacts {
                let placement = pair.placements(&contact.position)[body];
                let temperatures = contact.temperature.iter().flatten();
                for ((cell, _), temperature) in contact.pressure.iter().zip(temperatures) {
                    for (cell, weight) in placement.parts(placement.cell(*cell as usize)) {
                        rise.as_slice_mut().expect("standard layout")[cell] += weight * (temperature - bulk);
                        weights.as_slice_mut().expect("standard layout")[cell] += weight;
                    }
                }
            }
            rise.zip_mut_with(&weights, |rise, weight| {
                *rise = if *weight > 0.0 { *rise / weight } else { 0.0 }
            });
            let state = State { unit: "K".to_owned(), values: rise };
            [&mut pair.lower, &mut pair.upper][body].state.insert(FLASH.to_owned(), state);
        }
    }

    fn is_computed(&self, done: usize) -> bool {
        done.is_multiple_of(self.every)
    }
}
