//! Memories of whole passes.

use crate::error::Result;
use crate::grid::Field;
use crate::motion::Motion;
use crate::motion::contact::Contact;
use crate::motion::pair::Pair;
use crate::motion::plastic_volume::PlasticVolume;
use crate::motion::watch::Watch;

/// A memory of the material below the surfaces: what whole passes do to it, and what the bodies lose by that in the end.
///
/// A [`Law`](crate::motion::Law) adds up the contacts position by position. A memory needs all contacts of a pass together. Like a law it
/// stores its data in [`Body::state`](crate::motion::Body::state), never in itself.
pub trait Memory: Send + Sync {
    /// Name in results of the volumes that the bodies lose by it, in snake case; `None` if they lose nothing.
    fn takes(&self) -> Option<&str>;

    /// Prepares the bodies before their first pass: adds the state of the memory if it is missing.
    fn prepare(&self, pair: &mut Pair);

    /// Looks at a solved pass, before laws change its bodies.
    ///
    /// # Errors
    /// [`Error::Interrupted`](crate::Error::Interrupted), and the reason why it cannot look at the pass.
    fn look(&self, pass: &WholePass<'_>, pair: &mut Pair) -> Result<()>;

    /// Largest number of passes, ≥ 1, over which the pass may be extrapolated.
    fn most_passes(&self, pair: &Pair) -> f64;

    /// Changes its state by `passes` passes like this one, in which the lower and the upper body were worn by these depths, m. Returns the
    /// further height that each cell of the bodies loses, m. The caller lowers the heights.
    fn advance(&self, pair: &mut Pair, passes: f64, worn: &[Field; 2]) -> [Field; 2];
}

/// A solved pass, for memories.
#[derive(Clone, Copy)]
#[non_exhaustive]
pub struct WholePass<'a> {
    /// Number of the computed pass, from 1.
    pub pass: usize,
    /// The contacts, position by position.
    pub contacts: &'a [Contact],
    /// The parameters of the motion.
    pub motion: &'a Motion,
    /// The plastic state below the surfaces after unloading; empty for other than elasto-plastic bodies.
    pub plastic_volumes: &'a [PlasticVolume],
    /// Passes over which the computed pass before was extrapolated, itself included; 1 for the first.
    pub extrapolated: f64,
    pub(super) watch: &'a dyn Watch,
}

impl WholePass<'_> {
    /// Whether the computation is to end.
    pub fn stop(&self) -> bool {
        self.watch.stop()
    }
}
