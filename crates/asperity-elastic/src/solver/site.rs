//! The grid, the gap, the bounds and the operator of one contact among several.

use std::borrow::Cow;
use std::ops::DerefMut;
use std::sync::Mutex;

use crate::grid::{Field, Grid, coarse_means};
use crate::operator::Operator;
use crate::ranks::Slab;
use crate::solver::bounds::Bounds;

/// Site of one of the contacts that share an approach.
///
/// A site may create its operator and its initial gap on each request, so that many simultaneous contacts
/// take little memory.
pub trait Site: Sync {
    /// Returns the grid of the contact, or the rows of this rank.
    fn grid(&self) -> Grid;

    /// Returns the slab of this rank on a grid divided among ranks.
    fn slab(&self) -> Slab {
        Slab::whole(self.grid())
    }

    /// Returns the undeformed gap h.
    fn initial_gap(&self) -> Cow<'_, Field>;

    /// Returns the bounds of the pressure.
    fn bounds(&self) -> Cow<'_, Bounds>;

    /// Calls a task with the operator of the grid.
    fn with_operator(&self, task: &mut dyn FnMut(&mut dyn Operator));

    /// Returns the contact on a grid of about half as many cells along each axis.
    fn coarse(&self) -> Box<dyn Site>;
}

/// A site that owns its operator, gap and bounds.
pub struct OwnedSite<'a, P> {
    grid: Grid,
    gap: Cow<'a, Field>,
    bounds: Cow<'a, Bounds>,
    operator: Mutex<P>,
}

impl<'a, 'o, P: DerefMut<Target = dyn Operator + 'o>> OwnedSite<'a, P> {
    /// Creates the site.
    pub fn new(operator: P, gap: Cow<'a, Field>, bounds: Cow<'a, Bounds>) -> Self {
        Self { grid: *operator.grid(), gap, bounds, operator: Mutex::new(operator) }
    }
}

impl<'o, P: DerefMut<Target = dyn Operator + 'o> + Send> Site for OwnedSite<'_, P> {
    fn grid(&self) -> Grid {
        self.grid
    }

    fn slab(&self) -> Slab {
        self.operator.lock().expect("no holder panics").slab()
    }

    fn initial_gap(&self) -> Cow<'_, Field> {
        Cow::Borrowed(&self.gap)
    }

    fn bounds(&self) -> Cow<'_, Bounds> {
        Cow::Borrowed(&self.bounds)
    }

    fn with_operator(&self, task: &mut dyn FnMut(&mut dyn Operator)) {
        task(&mut **self.operator.lock().expect("no holder panics"));
    }

    fn coarse(&self) -> Box<dyn Site> {
        let fine = self.slab();
        let operator = self.operator.lock().expect("no holder panics").coarse();
        if fine.is_whole() || !operator.slab().is_whole() {
            return Box::new(coarse_site(operator, &self.gap, &self.bounds));
        }
        Box::new(coarse_site(operator, &fine.collected(&self.gap), &self.bounds.collected(&fine)))
    }
}

/// Creates the site of a coarse `operator` from the gap and the bounds of the fine grid.
pub fn coarse_site(
    operator: Box<dyn Operator>,
    gap: &Field,
    bounds: &Bounds,
) -> OwnedSite<'static, Box<dyn Operator>> {
    OwnedSite::new(operator, Cow::Owned(coarse_means(gap)), Cow::Owned(bounds.coarse()))
}
