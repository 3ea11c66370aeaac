//! An increment: consistent plastic strain and contact pressure.

use super::anderson::Anderson;
use super::body::{Action, BodyIncrement, PlasticBody, Start, SurfaceDisplacement};
use crate::error::{Error, Result, check};
use crate::units::Joule;

/// The counterpart of the surfaces of the bodies, which may depend on their displacement.
pub trait Loading {
    /// Returns the action on each body, on its own grid, for surfaces displaced plastically by `residual`.
    ///
    /// # Errors
    /// The errors of the loading.
    fn act(&mut self, residual: &[SurfaceDisplacement]) -> Result<Vec<Action>>;
}

/// Convergence criteria of an increment.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct PlasticParams {
    /// Return-mapping residual at convergence, > 0, relative to the yield stress.
    pub tolerance: f64,
    /// Number of applications of the residual-stress operator after which the increment fails.
    pub max_products: usize,
}

impl PlasticParams {
    /// Return-mapping residual 10⁻⁴, at most 200 operator applications.
    pub const fn new() -> Self {
        Self { tolerance: 1e-4, max_products: 200 }
    }

    /// Sets the return-mapping residual at convergence.
    #[must_use]
    pub const fn with_tolerance(self, tolerance: f64) -> Self {
        Self { tolerance, ..self }
    }

    /// Sets the largest number of operator applications.
    #[must_use]
    pub const fn with_max_products(self, max_products: usize) -> Self {
        Self { max_products, ..self }
    }
}

impl Default for PlasticParams {
    fn default() -> Self {
        Self::new()
    }
}

/// Results of an increment.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Increment {
    /// Number of applications of the residual-stress operator to each body; 0 without flow.
    pub products: usize,
    /// Return-mapping residual over the yield stress; 0 without flow.
    pub mismatch: f64,
    /// Results for each body.
    pub bodies: Vec<BodyIncrement>,
}

impl Increment {
    /// Number of cells of all layers of all bodies that have flowed.
    pub fn yielding_cells(&self) -> usize {
        self.bodies.iter().map(|body| body.yielding_cells).sum()
    }

    /// Plastic work in all bodies, J.
    pub fn plastic_work(&self) -> Joule {
        self.bodies.iter().map(|body| body.plastic_work).sum()
    }
}

/// Brings elasto-plastic bodies into equilibrium under a `loading`, in one increment from their present
/// state.
///
/// The loading is evaluated anew for every plastic strain, so that contact and flow do not alternate. The
/// iterated quantity is the predictor y of the flow law: y → ε → the loading → σ → y. It uses Anderson
/// acceleration on the cells that may flow. A step that fails is halved, then taken without acceleration.
/// Flow is a step of backward Euler, with an error of first order in the increments.
///
/// The iteration starts from the present strain, or from the present strain plus that of the last increment,
/// whichever is closer to the solution. The added strain is moved with the load over each body by the whole
/// cells of `shifts` since the last increment (0 if only the load has grown).
///
/// # Errors
/// [`Error::PlasticNotConverged`]; [`Error::OutOfRange`] for an invalid tolerance; the errors of the loading.
/// The bodies are then unchanged.
pub fn advance(
    bodies: &mut [&mut PlasticBody],
    loading: &mut dyn Loading,
    shifts: Option<&[[isize; 2]]>,
    params: &PlasticParams,
) -> Result<Increment> {
    check("tolerance", params.tolerance, params.tolerance > 0.0, "a mismatch above 0")?;
    let mut trial = Trial { bodies, products: 0, actions: Vec::new(), residual: Vec::new() };
    trial.begin_elastic(loading)?;
    let start = trial.flow(Start::PreviousStates);
    if start == 0.0 {
        return Ok(trial.end(0.0));
    }
    if let Some(shifts) = shifts
        && trial.has_yielded()
    {
        let nearer = trial.guess(shifts, loading)? && trial.flow(Start::Trial) < start;
        if !nearer {
            trial.begin_elastic(loading)?;
            trial.flow(Start::PreviousStates);
        }
    }
    let mismatch = iterate(&mut trial, loading, params)?;
    Ok(trial.end(mismatch))
}

/// Iterates from the trial strain, which is already the flow of its predictor.
fn iterate(trial: &mut Trial, loading: &mut dyn Loading, params: &PlasticParams) -> Result<f64> {
    let places: Vec<Vec<usize>> = trial.bodies.iter().map(|body| body.candidates()).collect();
    let mut anderson = Anderson::default();
    let (mut least, mut step) = (f64::INFINITY, Step::Plain);
    loop {
        trial.respond(loading)?;
        let mismatch = trial.mismatch();
        if mismatch < params.tolerance {
            return Ok(mismatch);
        }
        if trial.products >= params.max_products || mismatch.is_nan() {
            return Err(Error::PlasticNotConverged {
                products: trial.products,
                mismatch,
                tolerance: params.tolerance,
            });
        }
        let [y, f] = trial.gather(&places);
        let worse = mismatch >= FAR_WORSE * least;
        let next = match (step, anderson.last()) {
            (Step::Accelerated, Some((before, _))) if worse => {
                step = Step::Halved;
                before.iter().zip(&y).map(|(a, b)| 0.5 * (a + b)).collect()
            }
            (Step::Halved, Some((before, wrong))) if worse => {
                step = Step::Plain;
                let plain = before.iter().zip(wrong).map(|(y, f)| y + f).collect();
                anderson.begin_again();
                plain
            }
            _ => {
                let counts = trial.yielding_entries(&places);
                least = least.min(mismatch);
                step = if anderson.last().is_some() { Step::Accelerated } else { Step::Plain };
                anderson.next(y, f, &counts)
            }
        };
        trial.predict(&places, &next);
        trial.flow(Start::PreviousStates);
    }
}

/// A step has failed if its residual exceeds the smallest so far by this factor. Steps that increase it
/// slightly are needed: without them a fully plastic contact takes half as many operator applications again.
const FAR_WORSE: f64 = 10.0;

/// Origin of the present predictor.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Step {
    Plain,
    Accelerated,
    Halved,
}

/// Bodies within an increment.
struct Trial<'a, 'b> {
    bodies: &'a mut [&'b mut PlasticBody],
    products: usize,
    actions: Vec<Action>,
    residual: Vec<SurfaceDisplacement>,
}

impl Trial<'_, '_> {
    fn begin_elastic(&mut self, loading: &mut dyn Loading) -> Result<()> {
        self.residual = self.bodies.iter().map(|body| body.displacement_before()).collect();
        self.actions = loading.act(&self.residual)?;
        let mut product = false;
        for (body, action) in self.bodies.iter_mut().zip(&self.actions) {
            product |= body.predict_elastic(action);
        }
        self.products += usize::from(product);
        Ok(())
    }

    /// Whether a body flowed in the last increment.
    fn has_yielded(&self) -> bool {
        self.bodies.iter().any(|body| body.has_yielded())
    }

    /// Computes the predictor of a strain that grows once more as in the last increment. Returns whether
    /// there was any.
    fn guess(&mut self, shifts: &[[isize; 2]], loading: &mut dyn Loading) -> Result<bool> {
        let any = self.bodies.iter_mut().zip(shifts).fold(false, |any, (body, by)| body.guess(*by) | any);
        if any {
            self.respond(loading)?;
            self.bodies.iter_mut().for_each(|body| body.predict());
        }
        Ok(any)
    }

    /// Computes the stress of the trial strain under the resulting loading.
    fn respond(&mut self, loading: &mut dyn Loading) -> Result<()> {
        self.residual = self.bodies.iter_mut().map(|body| body.take_trial()).collect();
        self.actions = loading.act(&self.residual)?;
        self.bodies.iter_mut().zip(&self.actions).for_each(|(body, action)| body.respond(action));
        self.products += 1;
        Ok(())
    }

    fn flow(&mut self, start: Start) -> f64 {
        self.bodies.iter_mut().map(|body| body.flow(start)).fold(0.0, f64::max)
    }

    /// Returns the largest return-mapping residual; NaN if there is one, which `f64::max` would ignore.
    fn mismatch(&self) -> f64 {
        let bodies = self.bodies.iter().map(|body| body.mismatch());
        bodies.fold(0.0, |most, m| if m > most || m.is_nan() { m } else { most })
    }

    fn gather(&self, places: &[Vec<usize>]) -> [Vec<f64>; 2] {
        let mut all = [Vec::new(), Vec::new()];
        for (body, places) in self.bodies.iter().zip(places) {
            let part = body.gather(places);
            all.iter_mut().zip(part).for_each(|(all, part)| all.extend(part));
        }
        all
    }

    fn yielding_entries(&self, places: &[Vec<usize>]) -> Vec<usize> {
        let mut first = 0;
        let mut entries = Vec::new();
        for (body, places) in self.bodies.iter().zip(places) {
            entries.extend(body.yielding_entries(places).map(|entry| first + entry));
            first += super::COMPONENTS * places.len();
        }
        entries
    }

    /// Sets the next predictor: `values` in cells that may flow, elsewhere the one of the trial stress.
    fn predict(&mut self, places: &[Vec<usize>], values: &[f64]) {
        let mut rest = values;
        for (body, places) in self.bodies.iter_mut().zip(places) {
            let (own, others) = rest.split_at(super::COMPONENTS * places.len());
            body.predict();
            body.scatter(places, own);
            rest = others;
        }
    }

    fn end(self, mismatch: f64) -> Increment {
        let Self { bodies, products, actions, residual } = self;
        let ends = bodies.iter_mut().zip(actions).zip(residual);
        let bodies = ends.map(|((body, action), residual)| body.commit(action, residual)).collect();
        Increment { products, mismatch, bodies }
    }
}
