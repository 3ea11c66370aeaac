//! First guess of the approach of a pass from a sample of its positions. The sample is solved as one problem,
//! with the approach as the multiplier of its mean load.

use std::borrow::Cow;
use std::cell::OnceCell;

use crate::error::{Error, Result};
use crate::grid::{Field, Grid};
use crate::motion::approach::MAX_RESIDUAL;
use crate::motion::contact::Contact;
use crate::motion::control::LoadControl;
use crate::motion::kinematics::Motion;
use crate::motion::pair::Pair;
use crate::motion::pass::Solver;
use crate::motion::path::Position;
use crate::motion::warm_start::Guess;
use crate::motion::watch::{OneOfMany, Progress};
use crate::operator::{Operator, Operators};
use crate::solver::Control;
use crate::solver::{Bounds, JointSolution, Method, Params, Residual, Site, coarse_site, solve_together};
use crate::units::{Newton, Pascal};

/// Largest number of cells of all sampled positions that are stored at once.
const MAX_CELLS: usize = 40_000_000;
/// Memory per cell while all sampled positions are stored at once, bytes.
const BYTES_PER_CELL: f64 = 60.0;

/// Least number of sampled positions. A pass with fewer positions is sampled as a whole.
const SAMPLED: usize = 16;
/// Relative increase of the load between the two solutions of the sample.
const LOAD_INCREASE: f64 = 0.02;

/// Returns the sampled ones of `count` positions.
fn sampled(count: usize) -> impl Iterator<Item = usize> {
    let interval = (count / SAMPLED).max(1);
    (interval / 2..count).step_by(interval)
}

/// Returns the memory, bytes, to solve a sample of the positions of a pass together, each with `columns`
/// columns. Returns `None` if the pass has no sample, because it would have too many cells, the user chose a
/// method, no mean load is prescribed, or the geometry changes from one position to the next.
pub fn memory_together(
    motion: &Motion,
    method: Method,
    yields: bool,
    columns: &[usize],
    width: usize,
) -> Option<f64> {
    let cells = width * sampled(columns.len()).map(|position| columns[position]).sum::<usize>();
    let iterative = matches!(method, Method::Auto | Method::ActiveSet);
    let searched = matches!((motion.control, motion.load_control), (Control::Load(_), LoadControl::Pass));
    (motion.is_frozen(yields) && iterative && searched && cells <= MAX_CELLS)
        .then_some(BYTES_PER_CELL * cells as f64)
}

/// Largest residual at the end, as a fraction of the first one, which may be small from a good start. The errors
/// of such a start all have the same sign, and they shift the approach.
const MIN_PROGRESS: f64 = 0.1;

impl Solver<'_> {
    /// Guesses the approach at which the mean load of the pass is `load`, and the slope there. A sample of the
    /// positions is solved together, roughly, under two mean loads. If it contains all positions, one load is
    /// enough: the approach of the pass is near, and the search hardly needs a slope.
    ///
    /// Returns the guess and the contact at each position, which has no pressure outside the sample. Returns
    /// `None` if the sample cannot carry the loads, or if it does not converge.
    ///
    /// # Errors
    /// [`Error::Interrupted`].
    pub(super) fn sample(
        &self,
        pair: &Pair,
        load: Newton,
        params: &Params,
    ) -> Result<Option<(Guess, Vec<Contact>)>> {
        let sampled: Vec<usize> = sampled(self.positions.len()).collect();
        let facing = |index: &usize| RelativePosition {
            pair,
            operators: self.operators,
            motion: self.motion,
            position: self.positions[*index],
        };
        let facing: Vec<RelativePosition> = sampled.iter().map(facing).collect();
        let (total, scale) = (load * sampled.len() as f64, pair.height_scale());
        let more = (1.0 + LOAD_INCREASE) * total;
        let bearable = facing.iter().map(|site| site.bounds().upper().sum(site.grid().cells()));
        if more >= pair.cell_area() * bearable.sum::<f64>() {
            return Ok(None);
        }
        let solved = self.solve_together(&facing, total, None, params).and_then(|first| {
            if sampled.len() == self.positions.len() {
                return Ok((Guess { error: 0.0, ..Guess::new(first.approach, 1.0 / scale) }, first));
            }
            let width = pair.lower.width();
            let field = |(site, pressure): (&RelativePosition, &Vec<(u32, Pascal)>)| {
                Contact::from_pressure(pair, site.position, first.approach, pressure.clone(), first.stats)
                    .pressure_field(width)
            };
            let start = facing.iter().zip(&first.pressures).map(field).collect();
            let further = self.solve_together(&facing, more, Some(start), params)?;
            let guess = Guess::between(first.approach, further.approach, 1.0 + LOAD_INCREASE, scale);
            let stats = first.stats.and(&further.stats);
            Ok((guess, JointSolution { stats, ..further }))
        });
        let (guess, JointSolution { approach, pressures, stats }) = match solved {
            Ok(solved) => solved,
            Err(Error::NotConverged { .. }) => return Ok(None),
            Err(other) => return Err(other),
        };
        let mut found = sampled.into_iter().zip(pressures).peekable();
        let contact = |(index, position): (usize, &Position)| {
            let (pressure, stats) = match found.next_if(|(at, _)| *at == index) {
                Some((_, pressure)) => (pressure, stats),
                None => Default::default(),
            };
            Contact::from_pressure(pair, *position, approach, pressure, stats)
        };
        let contacts = self.positions.iter().enumerate().map(contact).collect();
        Ok(Some((guess, contacts)))
    }

    /// Solves the `sites` roughly at the common approach at which their loads add up to `total`. The `start`
    /// holds a pressure near the solution for each site, if known.
    ///
    /// # Errors
    /// [`Error::NotConverged`], [`Error::Interrupted`].
    fn solve_together(
        &self,
        sites: &[RelativePosition<'_>],
        total: Newton,
        start: Option<Vec<Field>>,
        params: &Params,
    ) -> Result<JointSolution> {
        let first = OnceCell::new();
        let tolerance = |state: &Residual| {
            let first = *first.get_or_init(|| state.eta);
            let wanted = MAX_RESIDUAL.min(MIN_PROGRESS * first).max(params.tolerance);
            let progress = (first / state.eta).ln() / (first / wanted).ln();
            let progress = if progress.is_finite() { progress.clamp(0.0, 1.0) } else { 0.0 };
            let load = total / sites.len() as f64;
            self.watch.position(&Progress { load, together: Some(progress), ..self.progress });
            wanted
        };
        let watch = OneOfMany(self.watch);
        let sites: Vec<&dyn Site> = sites.iter().map(|site| site as &dyn Site).collect();
        solve_together(&sites, total, start, &tolerance, params.max_convolutions, &watch)
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
