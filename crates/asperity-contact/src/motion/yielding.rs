//! The contact of elasto-plastic bodies in a loading.

use crate::error::{Error, Result};
use crate::grid::Field;
use crate::motion::pair::Pair;
use crate::motion::plastic_volume::{PlasticResult, PlasticSums, PlasticVolume};
use crate::motion::record::{PlasticRecord, PlasticStepRecord};
use crate::motion::stage::Stage;
use crate::motion::state::LoadedContact;
use crate::plasticity::{PlasticBody, PlasticContact, PlasticParams, RelativePosition};
use crate::solver::{
    ContactSolver, Control, Equilibrium, Loading, Params, Solution, Stats, Tangential, Watch,
};

/// Elasto-plastic bodies of a loading, in their present state.
pub(super) struct Yielding {
    contact: PlasticContact,
    sums: PlasticSums,
    /// Number of equal unloading steps at the end; `None` if the load stays.
    pub(super) unloading: Option<usize>,
}

impl Yielding {
    /// Creates the contact of a `pair` at rest from its elasto-plastic `bodies`, lower one first.
    pub(super) fn new(
        pair: &Pair,
        gap: &Field,
        solver: Box<dyn ContactSolver>,
        bodies: [Option<PlasticBody>; 2],
        (plastic, unloading): (PlasticParams, Option<usize>),
        params: Params,
    ) -> Result<Self> {
        pair.interface().check_combined()?;
        pair.check_elastic()?;
        pair.check_flow(&bodies)?;
        let at_rest = pair.at_rest();
        let (bounds, placements) = (pair.bounds(&at_rest), pair.placements(&at_rest));
        let facing = RelativePosition { solver, initial_gap: gap.clone(), bounds, placements };
        let contact = PlasticContact::new(facing, bodies, plastic, params);
        Ok(Self { contact, sums: PlasticSums::default(), unloading })
    }

    /// Whether cells may stick.
    pub(super) fn sticks(&self) -> bool {
        self.contact.sticks()
    }

    /// Loads the bodies over this `gap` of their surfaces without plastic strain.
    pub(super) fn load(
        &mut self,
        gap: &Field,
        loading: Loading,
        watch: &dyn Watch,
    ) -> Result<(Equilibrium, PlasticStepRecord)> {
        self.contact.set_gap(gap);
        let increment = self.contact.load(loading, watch).map_err(|error| match error {
            Error::AtIncrement { source, .. } => *source,
            other => other,
        })?;
        self.sums.add(&increment);
        let flow = PlasticStepRecord::from_increments(std::slice::from_ref(&increment), &mut self.contact);
        let apart = || Equilibrium::Frictionless(Box::new(self.apart(gap)));
        Ok((self.contact.equilibrium().cloned().unwrap_or_else(apart), flow))
    }

    /// Bodies that are not in contact, whose approach is unknown.
    fn apart(&self, gap: &Field) -> Solution {
        let grid = *self.contact.grid();
        Solution {
            grid,
            initial_gap: gap.clone(),
            bounds: self.contact.bounds().clone(),
            pressure: grid.zeros(),
            displacement: grid.zeros(),
            approach: f64::NAN,
            residual: 0.0,
            stats: Stats::default(),
        }
    }

    /// Displacement r of both surfaces by plastic strain in a `contact`, m.
    pub(super) fn displacement(&self, contact: &Solution) -> Field {
        &contact.initial_gap - self.contact.initial_gap()
    }

    /// Moves the plastic strain up where the depth `worn` of the material above it has gone.
    pub(super) fn uncover(&mut self, worn: &[Field; 2]) {
        self.contact.uncover(worn);
    }

    /// Returns the present volumes.
    pub(super) fn volumes(&mut self) -> Vec<PlasticVolume> {
        PlasticVolume::loaded(&mut self.contact)
    }

    /// Creates the stage that takes off the load of a contact, if it is taken off.
    pub(super) fn unloading_from(&self, solution: &Equilibrium) -> Option<Stage> {
        // The force of bodies in gross slip is the whole friction force, also under each smaller load.
        let slides = Some(solution).filter(|solution| solution.stick_area() == 0.0);
        let tangential = match slides.map(Equilibrium::force) {
            Some([x, y]) if x.hypot(y) > 0.0 => Tangential::Sliding([x, y].map(|part| part / x.hypot(y))),
            _ => Tangential::Force([0.0; 2]),
        };
        Some(Stage::new(Loading { normal: Control::Load(0.0), tangential }, self.unloading?))
    }

    /// Adds the plastic state under the last load to the contact there.
    pub(super) fn loaded(&mut self, mut contact: LoadedContact) -> LoadedContact {
        let volumes = self.volumes();
        contact.record.plastic = Some(PlasticRecord::new(&volumes, &self.sums));
        contact.plastic_result = Some(PlasticResult { volumes, residual: Vec::new() });
        contact
    }

    /// Adds the plastic state after the unloading to a contact under its last load.
    pub(super) fn unloaded(&mut self, mut contact: LoadedContact) -> LoadedContact {
        let residual = match self.unloading {
            Some(_) => PlasticVolume::unloaded(&mut self.contact),
            None => Vec::new(),
        };
        if let Some(plastic) = &mut contact.record.plastic {
            (plastic.products, plastic.mismatch) = (self.sums.products, self.sums.mismatch);
            plastic.residual =
                self.unloading.map(|_| PlasticRecord::new(&residual, &self.sums).into_residual());
        }
        if let Some(result) = &mut contact.plastic_result {
            result.residual = residual;
        }
        contact
    }
}
