//! All positions of a pass together, as one problem: the approach is the multiplier of their mean load.

use std::borrow::Cow;
use std::cell::OnceCell;

use crate::error::Result;
use crate::grid::{Field, Grid};
use crate::motion::contact::Contact;
use crate::motion::pair::Pair;
use crate::motion::pass::Solver;
use crate::motion::path::Position;
use crate::motion::watch::{OneOfMany, Progress};
use crate::motion::{LoadControl, Motion, PlasticUpdate};
use crate::operator::{Operator, Operators};
use crate::solver::Control;
use crate::solver::{Bounds, Friction, Method, Params, Residual, Site, coarse_site, solve_together};
use crate::units::Newton;

/// The most cells of all positions together that are held at once.
const MAX_CELLS: usize = 40_000_000;
/// Memory of a cell while all positions are held at once, bytes.
const BYTES_PER_CELL: f64 = 60.0;

/// Residual η at which the approach is known well enough, at the most. From there on the positions are solved one by one,
/// each with the iterations that it needs itself.
const MAX_RESIDUAL: f64 = 3e-2;
/// The residual for a relative accuracy of the mean load: at the approach found with a residual η the load is off by less
/// than 10⁻³ η (measured: 10⁻⁵ to 7·10⁻⁴ η).
const RESIDUAL_PER_ACCURACY: f64 = 300.0;

/// Memory, bytes, for the positions of a pass all at once, so many `columns` of so many cells at each: none where they are
/// not solved together, because they are too many, a method of the user's own is to be used, no mean load is prescribed or
/// the geometry changes from one to the next.
pub(crate) fn memory_together(
    motion: &Motion,
    method: Method,
    yields: bool,
    columns: &[usize],
    width: usize,
) -> Option<f64> {
    let cells = width * columns.iter().sum::<usize>();
    let frozen = motion.plastic_update == PlasticUpdate::Pass || !yields;
    let iterative = matches!(method, Method::Auto | Method::ActiveSet);
    let searched = matches!((motion.control, motion.load_control), (Control::Load(_), LoadControl::Pass));
    (frozen && iterative && searched && cells <= MAX_CELLS).then_some(BYTES_PER_CELL * cells as f64)
}

/// Share of the first residual that the iteration goes below even from a good start: that is wrong where the geometry has
/// changed, all in one direction, and so is its approach.
const MIN_PROGRESS: f64 = 0.1;

impl Solver<'_> {
    /// Solves all positions under the one approach at which their mean load is `load`, so well that it is met to the
    /// relative `accuracy`, from the pressures of `earlier` contacts at the same positions, if there are any.
    ///
    /// # Errors
    /// [`Error::NotConverged`], [`Error::Interrupted`].
    pub(super) fn solve_together(
        &self,
        pair: &Pair,
        load: Newton,
        accuracy: f64,
        params: &Params,
        earlier: Option<&Vec<Contact>>,
    ) -> Result<Vec<Contact>> {
        let friction = self.motion.friction;
        let facing =
            |position: &Position| Facing { pair, operators: self.operators, friction, position: *position };
        let facing: Vec<Facing> = self.positions.iter().map(facing).collect();
        let sites: Vec<&dyn Site> = facing.iter().map(|site| site as &dyn Site).collect();
        let width = pair.lower.width();
        let start = earlier.map(|contacts| contacts.iter().map(|c| c.pressure_field(width)).collect());
        let total = load * self.positions.len() as f64;
        let residual = (RESIDUAL_PER_ACCURACY * accuracy).min(MAX_RESIDUAL);
        let first = OnceCell::new();
        let tolerance = |state: &Residual| {
            let first = *first.get_or_init(|| state.eta);
            let wanted = residual.min(MIN_PROGRESS * first).max(params.tolerance);
            let progress = (first / state.eta).ln() / (first / wanted).ln();
            let progress = if progress.is_finite() { progress.clamp(0.0, 1.0) } else { 0.0 };
            self.watch.at(&Progress { load, together: Some(progress), ..self.progress });
            wanted
        };
        let watch = OneOfMany(self.watch);
        let found = solve_together(&sites, total, start, &tolerance, params.max_convolutions, &watch)?;
        let contact = |(position, pressure): (&Position, _)| {
            Contact::from_pressure(pair, *position, found.approach, pressure, found.stats)
        };
        Ok(self.positions.iter().zip(found.pressures).map(contact).collect())
    }
}

/// The contact at one position.
struct Facing<'a> {
    pair: &'a Pair,
    operators: &'a Operators,
    friction: Option<Friction>,
    position: Position,
}

impl Site for Facing<'_> {
    fn grid(&self) -> Grid {
        self.pair.grid(self.position.columns)
    }

    fn initial_gap(&self) -> Cow<'_, Field> {
        Cow::Owned(self.pair.initial_gap(&self.position))
    }

    fn bounds(&self) -> Cow<'_, Bounds> {
        Cow::Owned(self.pair.bounds(&self.position, self.friction.as_ref()))
    }

    fn with_operator(&self, task: &mut dyn FnMut(&mut dyn Operator)) {
        task(self.operators.on(self.grid().shape).as_mut());
    }

    fn coarse(&self) -> Box<dyn Site> {
        let operator = self.operators.on(self.grid().shape).coarse();
        Box::new(coarse_site(operator, &self.initial_gap(), &self.bounds()))
    }
}
