//! Bodies under load cycles, below their surfaces.

use super::{AtDepth, Basquin, DangVan, Fatigue, StressHistory};
use crate::error::Result;
use crate::kernel::Stack;
use crate::motion::{LoadCycle, Pair};
use crate::operator::Boundary;
use crate::units::Metre;
use crate::with::Given;

/// Where fatigue is looked at, and the bodies that have limits.
#[derive(Debug)]
pub(super) struct LimitedBodies {
    pub(super) fatigue: Fatigue,
    pub(super) boundary: Boundary,
    /// The bodies that have limits, lower one first.
    bodies: [Option<Limited>; 2],
}

/// A body with its limits.
#[derive(Debug)]
pub(super) struct Limited {
    poisson: f64,
    /// Its layers, whose fatigue is not looked at.
    stack: Option<Stack>,
    /// The depths, ascending.
    pub(super) depths: Vec<Metre>,
    pub(super) criterion: DangVan,
    pub(super) damage: Basquin,
    /// Number of depths to which material breaks out.
    pub(super) pitting: usize,
    /// Whether the risk is computed.
    pub(super) risk: bool,
    /// Whether there is no damage below the limit.
    pub(super) endurance: bool,
}

impl Limited {
    /// Whether layers lie on the material whose limits are known: it is not worn, and does not come nearer to the surface.
    pub(super) fn is_covered(&self) -> bool {
        self.stack.is_some()
    }
}

impl LimitedBodies {
    /// Reads the limits of the bodies.
    ///
    /// # Errors
    /// The reason why they are not accepted.
    pub(super) fn new(fatigue: &Fatigue, given: &Given<'_>) -> Result<Self> {
        let limited = |index: usize| {
            let body = &given.surroundings.bodies[index];
            let Some(limits) = body.properties.fatigue.as_ref() else { return Ok(None) };
            let depths = fatigue.depths(given.pair.pitch(), body.material.thickness());
            Ok(Some(Limited {
                poisson: body.material.poisson,
                stack: Stack::of(&body.material),
                criterion: limits.criterion()?,
                damage: limits.damage()?,
                pitting: depths.iter().take_while(|depth| **depth <= limits.pit_depth).count(),
                risk: limits.risk,
                endurance: limits.endurance,
                depths,
            }))
        };
        let bodies = [limited(0)?, limited(1)?];
        Ok(Self { fatigue: fatigue.clone(), boundary: given.surroundings.boundary, bodies })
    }

    /// The bodies with limits, each with its index.
    pub(super) fn limited(&self) -> impl Iterator<Item = (usize, &Limited)> {
        self.bodies.iter().enumerate().filter_map(|(index, body)| Some((index, body.as_ref()?)))
    }

    /// Computes the fatigue criterion of a body of a pair in a load cycle, at each depth.
    ///
    /// # Errors
    /// [`Error::Interrupted`](crate::Error::Interrupted).
    pub(super) fn dang_van(
        &self,
        (index, body): (usize, &Limited),
        pair: &Pair,
        cycle: &LoadCycle<'_>,
    ) -> Result<Vec<AtDepth>> {
        let grid = [pair.lower_grid(), pair.upper_grid()][index];
        let every = self.fatigue.every;
        let tractions = |number: usize| cycle.tractions(number * every, pair, index);
        let stop = || cycle.stop();
        let contacts = cycle.contacts().div_ceil(every);
        StressHistory::new(grid, self.boundary, body.poisson, contacts, tractions)
            .with_layers(body.stack.clone())
            .until(&stop)
            .dang_van(&body.criterion, &body.depths)
    }
}
