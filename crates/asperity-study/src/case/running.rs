//! Laws that change the bodies, and the heat of friction.

use super::{Body, Case};
use asperity_base::error::Result;
use asperity_base::units::PerPascal;
use asperity_contact::each;
use asperity_contact::motion::{Acceleration, Changes, Memory, Pair};
use asperity_contact::solver::Params;
use asperity_contact::with::{self, BodyLaw, Capability, Given, Listed};

impl Case {
    /// Returns the changes of the bodies of a `pair` by their contacts: laws, memories of load cycles, heat and
    /// extrapolation.
    ///
    /// # Errors
    /// The errors of the library, and of the capabilities.
    pub(crate) fn changes(&self, pair: &Pair, params: Params) -> Result<Changes> {
        let mut changes = Changes::default()
            .with_laws(with::laws([&self.lower.laws, &self.upper.laws], pair)?)
            .with_memories(self.memories(pair, params)?)
            .with_acceleration(self.acceleration.unwrap_or(Acceleration::NONE));
        if let Some(temperature) = self.temperature {
            changes = changes.with_bulk(temperature.bulk);
            if let (Some(lower), Some(upper), every @ 1..) =
                (self.lower.thermal, self.upper.thermal, temperature.every())
            {
                changes = changes.with_heat([lower, upper], every);
            }
        }
        Ok(changes)
    }

    /// Returns what capabilities remember of the load cycles of a `pair`.
    ///
    /// # Errors
    /// The errors of the capabilities.
    fn memories(&self, pair: &Pair, params: Params) -> Result<Vec<Box<dyn Memory>>> {
        let given = Given { pair, surroundings: self.surroundings(), params };
        let mut memories = Vec::new();
        each!(capability C => if let Some(asked) = C::of(&self.with) {
            memories.extend(asked.cycle_memory(&given)?);
        });
        Ok(memories)
    }

    /// Number of fields that capabilities keep with each body.
    pub(crate) fn remembered(&self) -> usize {
        let mut kept = 0;
        each!(capability C => kept += C::of(&self.with).map_or(0, Capability::remembered));
        kept
    }

    /// Whether passes or cycles change the bodies: by a law, a custom one, too, or what a capability
    /// remembers of them.
    pub(crate) fn is_changed_by_cycles(&self) -> bool {
        self.runs_in() || self.remembered() > 0 || self.has_custom_laws
    }

    /// Whether contacts change the bodies by a law.
    pub fn runs_in(&self) -> bool {
        [&self.lower, &self.upper].iter().any(|body| !body.laws.is_empty())
    }

    /// Depth that both bodies lose per pressure and distance slid, 1/Pa, with shear equal to `friction` times
    /// the pressure.
    pub(crate) fn loss_per_pressure(&self, friction: f64) -> PerPascal {
        let mut loss = 0.0;
        for body in [&self.lower, &self.upper] {
            each!(law L => loss += L::of(&body.laws).map_or(0.0, |law| law.per_pressure(friction)));
        }
        loss
    }
}

impl Body {
    /// Work of its laws on a cell in contact at a position, in the unit of effort.
    pub(crate) fn effort_of_laws(&self) -> f64 {
        let mut effort = 0.0;
        each!(law L => effort += L::of(&self.laws).map_or(0.0, |_| L::EFFORT));
        effort
    }
}
