//! Memories of whole passes in a motion.

use super::Simulation;
use crate::error::Result;
use crate::grid::Field;
use crate::motion::extrapolation::GridCompliance;
use crate::motion::law;
use crate::motion::memory::{Memory, WholePass};
use crate::motion::pass::Pass;
use crate::motion::record::LostVolume;
use crate::motion::watch::Watch;

impl Simulation {
    /// Adds a `memory` of whole passes.
    pub fn with_memory(mut self, memory: Box<dyn Memory>) -> Self {
        memory.prepare(&mut self.pair);
        self.changes.remember(memory, || GridCompliance::of(&self.pair, self.boundary));
        self
    }

    /// Lets the memories look at a solved pass.
    pub(super) fn look(&self, outcome: &mut Pass, watch: &dyn Watch) -> Result<()> {
        let pass = WholePass {
            pass: self.passes_done + 1,
            contacts: &outcome.contacts,
            motion: &self.motion,
            plastic_volumes: outcome.plastic_pass.as_ref().map_or(&[], |pass| &pass.volumes),
            extrapolated: self.warm.extrapolated_passes(),
            watch,
        };
        self.changes.memories.iter().try_for_each(|memory| memory.look(&pass, &mut outcome.pair))
    }

    /// Largest number of passes over which the memories allow a pass to be extrapolated.
    pub(super) fn most_remembered(&self, pass: &Pass) -> usize {
        let most = self.changes.memories.iter().map(|memory| memory.most_passes(&pass.pair));
        most.fold(f64::INFINITY, f64::min) as usize
    }

    /// Lets the memories go on by a number of passes in which laws that uncover material have taken the depth `worn` from both bodies, none
    /// without such laws.
    pub(super) fn remember(&self, pass: &mut Pass, passes: usize, worn: Option<&[Field; 2]>) {
        let unworn;
        let worn = match worn {
            Some(worn) => worn,
            None if self.changes.memories.is_empty() => return,
            None => {
                unworn =
                    [&pass.pair.lower, &pass.pair.upper].map(|body| Field::zeros(body.heights.raw_dim()));
                &unworn
            }
        };
        for memory in &self.changes.memories {
            let depth = memory.advance(&mut pass.pair, passes as f64, worn);
            if let Some(name) = memory.takes() {
                let mut lost = LostVolume::nothing(name);
                law::remove(&mut pass.pair, &depth, &self.interiors, &mut lost);
                pass.lost.push(lost);
            }
        }
    }
}
