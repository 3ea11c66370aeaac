//! Laws that change the bodies, and the heat of friction.

use super::{Body, Case};
use asperity_base::error::Result;
use asperity_base::units::PerPascal;
use asperity_contact::motion::{Acceleration, Law, Memory, Pair, Simulation, SlidingContact, StagedLoading};
use asperity_contact::solver::Params;
use asperity_contact::temperature::Thermal;
use asperity_contact::with::{self, BodyLaw, Capability, Given, Listed};
use asperity_contact::{each_capability, each_law};

impl Case {
    /// Adds to a motion the laws that change its bodies, and what capabilities remember of its passes.
    ///
    /// # Errors
    /// The errors of the library, and of the capabilities.
    pub(crate) fn running(&self, simulation: Simulation, params: Params) -> Result<Simulation> {
        let laws = self.laws(simulation.pair())?;
        let simulation = simulation.with_laws(laws);
        let memories = self.memories(simulation.pair(), params)?;
        let mut simulation = memories.into_iter().fold(simulation, Simulation::with_memory);
        if let (Some(thermal), Some(temperature)) = (self.heated(), self.temperature) {
            simulation = simulation.with_heat(thermal, temperature.every())?;
        }
        match self.acceleration {
            Some(acceleration) => simulation.with_acceleration(acceleration),
            None => Ok(simulation),
        }
    }

    /// Adds the same laws to a contact that slides in place.
    ///
    /// # Errors
    /// The errors of the library.
    pub(crate) fn running_in_place(&self, contact: SlidingContact) -> Result<SlidingContact> {
        let laws = self.laws(contact.pair())?;
        let contact = contact.with_laws(laws);
        match self.heated() {
            Some(thermal) => contact.with_heat(thermal),
            None => Ok(contact),
        }
    }

    /// Adds the same laws to a loading in stages, and what capabilities remember of its cycles.
    ///
    /// # Errors
    /// The errors of the library, and of the capabilities.
    pub(crate) fn fretting(&self, loading: StagedLoading, params: Params) -> Result<StagedLoading> {
        let laws = self.laws(loading.pair())?;
        let loading = loading.with_laws(laws);
        let memories = self.memories(loading.pair(), params)?;
        let mut loading = memories.into_iter().fold(loading, StagedLoading::with_memory);
        if let Some(temperature) = self.temperature {
            loading = loading.with_bulk(temperature.bulk);
        }
        if let Some(thermal) = self.heated() {
            loading = loading.with_heat(thermal);
        }
        Ok(loading.with_acceleration(self.acceleration.unwrap_or(Acceleration::NONE)))
    }

    /// Creates the laws of the bodies of a `pair`.
    fn laws(&self, pair: &Pair) -> Result<Vec<Box<dyn Law>>> {
        with::laws([&self.lower.laws, &self.upper.laws], pair)
    }

    /// Returns the thermal constants of bodies heated by friction; `None` if this is not computed.
    fn heated(&self) -> Option<[Thermal; 2]> {
        let wanted = self.temperature.is_some_and(|temperature| temperature.every() > 0);
        Some([self.lower.thermal?, self.upper.thermal?]).filter(|_| wanted)
    }

    /// Returns what capabilities remember of the load cycles of a `pair`.
    ///
    /// # Errors
    /// The errors of the capabilities.
    pub(crate) fn memories(&self, pair: &Pair, params: Params) -> Result<Vec<Box<dyn Memory>>> {
        let given = Given { pair, surroundings: self.surroundings(), params };
        let mut memories = Vec::new();
        each_capability!(C => if let Some(asked) = C::of(&self.with) {
            memories.extend(asked.cycle_memory(&given)?);
        });
        Ok(memories)
    }

    /// Number of fields that capabilities keep with each body.
    pub(crate) fn remembered(&self) -> usize {
        let mut kept = 0;
        each_capability!(C => kept += C::of(&self.with).map_or(0, Capability::remembered));
        kept
    }

    /// Whether passes or cycles change the bodies: by a law, a custom one, too, or what a capability remembers of them.
    pub(crate) fn is_changed_by_cycles(&self) -> bool {
        self.runs_in() || self.remembered() > 0 || self.has_custom_laws
    }

    /// Whether contacts change the bodies by a law.
    pub fn runs_in(&self) -> bool {
        [&self.lower, &self.upper].iter().any(|body| !body.laws.is_empty())
    }

    /// Depth that both bodies lose per pressure and distance slid, 1/Pa, with shear equal to `friction` times the pressure.
    pub(crate) fn loss_per_pressure(&self, friction: f64) -> PerPascal {
        let mut loss = 0.0;
        for body in [&self.lower, &self.upper] {
            each_law!(L => loss += L::of(&body.laws).map_or(0.0, |law| law.per_pressure(friction)));
        }
        loss
    }

    /// Number of maps of the fields that the laws of a body keep.
    pub(crate) fn maps_of_laws(&self) -> usize {
        let mut maps = 0;
        each_law!(L => if [&self.lower, &self.upper].iter().any(|body| L::of(&body.laws).is_some()) {
            maps += L::KEPT.iter().filter(|kept| kept.map.is_some()).count();
        });
        maps
    }
}

impl Body {
    /// Number of fields that its laws keep.
    pub(crate) fn kept_by_laws(&self) -> usize {
        let mut kept = 0;
        each_law!(L => kept += L::of(&self.laws).map_or(0, |_| L::KEPT.len()));
        kept
    }

    /// Work of its laws on a cell in contact at a position, in the unit of effort.
    pub(crate) fn effort_of_laws(&self) -> f64 {
        let mut effort = 0.0;
        each_law!(L => effort += L::of(&self.laws).map_or(0.0, |_| L::EFFORT));
        effort
    }
}
