//! Solution of all positions of a pass as one problem, with the approach as the multiplier of their mean
//! load.

use std::borrow::Cow;
use std::cell::OnceCell;

use crate::error::Result;
use crate::grid::{Field, Grid};
use crate::motion::contact::Contact;
use crate::motion::control::LoadControl;
use crate::motion::kinematics::Motion;
use crate::motion::pair::Pair;
use crate::motion::pass::Solver;
use crate::motion::path::Position;
use crate::motion::watch::{OneOfMany, Progress};
use crate::operator::{Operator, Operators};
use crate::solver::Control;
use crate::solver::{Bounds, Method, Params, Residual, Site, coarse_site, solve_together};
use crate::units::Newton;

/// Largest number of cells of all positions together that are stored at once.
const MAX_CELLS: usize = 40_000_000;
/// Memory per cell while all positions are stored at once, bytes.
const BYTES_PER_CELL: f64 = 60.0;

/// Upper bound of the residual η at which the approach is known well enough. From there on the positions are
/// solved one by one, each with its own number of iterations.
const MAX_RESIDUAL: f64 = 3e-2;
/// Residual over the relative accuracy of the mean load. At the approach found with a residual η the
/// error of the load is below 10⁻³ η; 10⁻⁵ to 7·10⁻⁴ η were measured.
const RESIDUAL_PER_ACCURACY: f64 = 300.0;

/// Returns the memory, bytes, to solve all positions of a pass together, each with `columns` columns. `None`
/// if they are not solved together: they are too many, the user chose a method, no mean load is prescribed,
/// or the geometry changes from one position to the next.
pub fn memory_together(
    motion: &Motion,
    method: Method,
    yields: bool,
    columns: &[usize],
    width: usize,
) -> Option<f64> {
    let cells = width * columns.iter().sum::<usize>();
    let iterative = matches!(method, Method::Auto | Method::ActiveSet);
    let searched = matches!((motion.control, motion.load_control), (Control::Load(_), LoadControl::Pass));
    (motion.is_frozen(yields) && iterative && searched && cells <= MAX_CELLS)
        .then_some(BYTES_PER_CELL * cells as f64)
}

/// Fraction of the first residual below which the iteration goes even from a good start. After a change of
/// the geometry, the errors of such a start all have the same sign, and so does that of its approach.
const MIN_PROGRESS: f64 = 0.1;

impl Solver<'_> {
    /// Solves all positions at the common approach at which their mean load is `load` to the relative
    /// `accuracy`. It starts from the pressures of `earlier` contacts at the same positions, if there are
    /// any.
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
        let facing = |position: &Position| RelativePosition {
            pair,
            operators: self.operators,
            motion: self.motion,
            position: *position,
        };
        let facing: Vec<RelativePosition> = self.positions.iter().map(facing).collect();
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
            self.watch.position(&Progress { load, together: Some(progress), ..self.progress });
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
struct RelativePosition<'a> {
    pair: &'a Pair,
    operators: &'a Operators,
    motion: &'a Motion,
    position: Position,
}

impl Site for RelativePosition<'_> {
    fn grid(&self) -> Grid {
        self.pair.grid(self.position.columns)
    }

    fn initial_gap(&self) -> Cow<'_, Field> {
        Cow::Owned(self.pair.initial_gap(&self.position))
    }

    fn bounds(&self) -> Cow<'_, Bounds> {
        Cow::Owned(self.motion.bounds(self.pair, &self.position))
    }

    fn with_operator(&self, task: &mut dyn FnMut(&mut dyn Operator)) {
        task(self.operators.on(self.grid().shape).as_mut());
    }

    fn coarse(&self) -> Box<dyn Site> {
        let operator = self.operators.on(self.grid().shape).coarse();
        Box::new(coarse_site(operator, &self.initial_gap(), &self.bounds()))
    }
}
