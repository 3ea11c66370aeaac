//! Memories of the passes of a motion.

use super::Simulation;
use crate::error::Result;
use crate::motion::extrapolation::GridCompliance;
use crate::motion::memory::{LoadCycle, Memory};
use crate::motion::pass::Pass;
use crate::motion::watch::Watch;

impl Simulation {
    /// Adds a `memory` of its passes.
    pub fn with_memory(mut self, memory: Box<dyn Memory>) -> Self {
        memory.prepare(&mut self.pair);
        self.changes.remember(memory, || GridCompliance::of(&self.pair, self.boundary));
        self
    }

    /// Lets the memories look at a solved pass.
    pub(super) fn look(&self, outcome: &mut Pass, watch: &dyn Watch) -> Result<()> {
        let cycle = LoadCycle {
            number: self.passes_done + 1,
            plastic_volumes: outcome.plastic_pass.as_ref().map_or(&[], |pass| &pass.volumes),
            extrapolated: self.warm.extrapolated_passes(),
            stop: &|| watch.stop(),
            ..LoadCycle::of_pass(&outcome.contacts, &self.motion)
        };
        self.changes.memories.iter().try_for_each(|memory| memory.look(&cycle, &mut outcome.pair))
    }
}
