//! Loading history of a static contact, on which its state depends.

mod increments;

use crate::error::{Error, Result};
use crate::grid::Field;
use crate::motion::changes::Changes;
use crate::motion::contact::facing;
use crate::motion::course::{self, Output};
use crate::motion::fretting::Fretting;
use crate::motion::pair::Pair;
use crate::motion::press::{shear_record, static_record};
use crate::motion::record::{IncrementRecord, StaticRecord};
use crate::motion::report::CycleReport;
use crate::motion::slip::SlipRegime;
use crate::motion::stage::Stage;
use crate::motion::state::{LoadedContact, LoadingState};
use crate::motion::watch::Watch;
use crate::motion::yielding::Yielding;
use crate::operator::Boundary;
use crate::plasticity::{PlasticBody, PlasticParams};
use crate::solver::{ContactSolver, Friction, Params};

use increments::Increments;

/// Loads a pair at full overlap, stage after stage, from before contact or from a state `under_way`. A
/// resumed loading gives the same result, bit by bit.
///
/// Within a stage, a load, an approach, a force or a displacement grows in equal steps. The first stage
/// starts from 0, or from first touch for an approach. If a stage prescribes another quantity than the one
/// before, that quantity starts from its present value.
///
/// Plastic deformation is irreversible. As long as no plastic interference would decrease, an increment is
/// solved as if loaded at once. As soon as one would, the surfaces stay flattened by the plastic deformation
/// so far, and the increment is solved again on them. This is the incremental law of perfect plasticity: in
/// each increment w grows where p is at its cap, and shrinks nowhere.
///
/// # Errors
/// The errors of [`StagedLoading`].
///
/// # Panics
/// If the bodies have different shapes.
#[expect(clippy::too_many_arguments, reason = "the contact, its history, and who looks on")]
pub fn load_in_stages(
    pair: &Pair,
    boundary: Boundary,
    friction: Option<&Friction>,
    stages: &[Stage],
    params: &Params,
    under_way: Option<LoadingState>,
    watch: &dyn Watch,
    outputs: &mut [&mut dyn Output],
) -> Result<LoadedContact> {
    let loading = StagedLoading::new(pair.clone(), boundary, friction.copied(), stages.to_vec(), *params)?;
    loading.run(under_way, watch, outputs)
}

/// Two bodies that are loaded at full overlap, stage after stage, see [`load_in_stages`], and that laws may
/// change where they slip.
pub struct StagedLoading {
    pair: Pair,
    /// Initial gap of the undeformed bodies.
    gap: Field,
    response: Response,
    params: Params,
    boundary: Boundary,
    stages: Vec<Stage>,
    changes: Changes,
}

/// How the bodies of a loading answer.
enum Response {
    /// By an elastic contact, with their memory if they creep.
    Elastic(Box<dyn ContactSolver>),
    /// With plastic flow below their surfaces.
    Yielding(Box<Yielding>),
}

impl Response {
    /// Whether cells may stick.
    fn sticks(&self) -> bool {
        match self {
            Self::Elastic(solver) => solver.sticks(),
            Self::Yielding(yielding) => yielding.sticks(),
        }
    }
}

impl StagedLoading {
    /// Creates the loading of a `pair`.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] or [`Error::Unsupported`] for invalid input.
    ///
    /// # Panics
    /// If the bodies have different shapes.
    pub fn new(
        pair: Pair,
        boundary: Boundary,
        friction: Option<Friction>,
        stages: Vec<Stage>,
        params: Params,
    ) -> Result<Self> {
        stages.iter().filter_map(|stage| stage.cycles).try_for_each(|cycles| cycles.checked().map(|_| ()))?;
        pair.check_memory()?;
        let (operators, gap) = facing(&pair, boundary)?;
        let shape = pair.lower_grid().shape;
        let solver = SlipRegime::from(friction).solver(&pair, &operators, shape, params.device)?;
        let (response, changes) = (Response::Elastic(solver), Changes::default());
        Ok(Self { pair, gap, response, params, boundary, stages, changes })
    }

    /// Adds plastic flow below the surfaces of the given `bodies`, lower one first, with the convergence
    /// criteria of a step. Their load is taken off at the end in so many `unloading` steps, ≥ 1, or stays.
    /// Such a loading is not resumed.
    ///
    /// # Errors
    /// [`Error::Unsupported`] for an elasto-plastic body with a hardness, and for bodies that creep or
    /// attract each other.
    ///
    /// # Panics
    /// If no body is given, or if the grid of one differs from that of its surface.
    pub fn with_plastic(
        self,
        bodies: [Option<PlasticBody>; 2],
        plastic: PlasticParams,
        unloading: Option<usize>,
    ) -> Result<Self> {
        let Response::Elastic(solver) = self.response else {
            return Err(Error::Unsupported("the bodies of this loading are elasto-plastic already"));
        };
        let end = (plastic, unloading);
        let yielding = Yielding::new(&self.pair, &self.gap, solver, bodies, end, self.params)?;
        Ok(Self { response: Response::Yielding(Box::new(yielding)), ..self })
    }

    /// Sets what slip does to the bodies. It needs friction, and heat needs the periods of the cycles.
    #[must_use]
    pub fn with_changes(self, changes: Changes) -> Self {
        Self { changes, ..self }
    }

    /// The bodies before the loading.
    pub fn pair(&self) -> &Pair {
        &self.pair
    }

    /// Loads the bodies, from before contact or from a state `under_way`. A resumed loading gives the same
    /// result, bit by bit.
    ///
    /// # Errors
    /// The errors of [`crate::solver::solve_frictional`], with several increments in an
    /// [`Error::AtIncrement`]; those of the outputs; [`Error::Unsupported`] without stages and for laws
    /// without friction; [`Error::WornAway`]; [`Error::Interrupted`].
    pub fn run(
        mut self,
        under_way: Option<LoadingState>,
        watch: &dyn Watch,
        outputs: &mut [&mut dyn Output],
    ) -> Result<LoadedContact> {
        let mut state = under_way;
        let mut fretting = self.fretting()?;
        if let (Some(fretting), Some(changed)) =
            (&mut fretting, state.as_mut().and_then(|state| state.changed.as_mut()))
        {
            fretting.resume(changed)?;
        }
        let mut increments = Increments { loading: self, fretting, state, loaded: None };
        course::run(&mut increments, watch, outputs)?;
        let Increments { mut loading, state, loaded, .. } = increments;
        let state = state.ok_or(Error::Unsupported("a loading needs at least one increment"))?;
        Ok(match (&mut loading.response, loaded) {
            (Response::Yielding(yielding), Some(loaded)) => {
                yielding.unloaded(LoadedContact { increments: state.increments, ..loaded })
            }
            _ => loading.finish(state),
        })
    }

    /// Prepares the bodies for what slip does to them; `None` if it does nothing.
    fn fretting(&mut self) -> Result<Option<Fretting>> {
        let changes = std::mem::take(&mut self.changes);
        if changes.is_empty() {
            return Ok(None);
        }
        let heats = changes.heat.is_some();
        if (!changes.laws.is_empty() || heats) && !self.response.sticks() {
            return Err(Error::Unsupported(
                "laws change the bodies of a loading, and heat warms them, by slip, which needs friction",
            ));
        }
        let mut cycles = self.stages.iter().filter_map(|stage| stage.cycles);
        if heats && cycles.any(|cycles| cycles.period.is_none()) {
            return Err(Error::Unsupported("a flash temperature in cycles needs the period of a cycle"));
        }
        let remembers = self.pair.relaxes() || matches!(self.response, Response::Yielding(_));
        if remembers && changes.jumps() {
            return Err(Error::Unsupported(
                "cycles of bodies that creep or flow below their surfaces are not extrapolated",
            ));
        }
        let (operators, _) = facing(&self.pair, self.boundary)?;
        let with = (&operators, self.boundary, self.params);
        Fretting::new(&mut self.pair, changes, with).map(Some)
    }
}

impl StagedLoading {
    /// Returns the cycle that ends with the last increment of a `state`, if there is one and its bodies
    /// change or have a memory.
    fn cycle<'a>(&self, state: &'a LoadingState) -> Option<CycleReport<'a>> {
        let (end, before) = state.increments.split_last()?;
        let changed = state.changed.as_ref()?;
        let done = |increment: &IncrementRecord| increment.fretting.map_or(0, |bodies| bodies.cycles);
        if done(end) == before.last().map_or(0, done) {
            return None;
        }
        let increments = state.increments.rchunks(self.stages[end.stage - 1].steps()).next()?;
        let load = increments.iter().map(|increment| increment.load).sum::<f64>() / increments.len() as f64;
        Some(CycleReport {
            number: changed.computed,
            done: done(end),
            step: end.increment,
            stage: Some(end.stage),
            mean_pressure: load / changed.pair.lower_grid().area(),
            pair: &changed.pair,
            pass: None,
            watch: &(),
        })
    }

    /// Returns the contact at the end of its loading.
    fn finish(&self, state: LoadingState) -> LoadedContact {
        let LoadingState {
            increments, contact: solution, flattening, slip, dissipation_error, changed, ..
        } = state;
        let normal = solution.normal();
        let plastic = match (&self.response, &flattening.kept) {
            (Response::Elastic(_), _) => flattening.total(normal.plastic_interference()),
            // All of it is kept.
            (Response::Yielding(_), Some(kept)) => kept.clone(),
            (Response::Yielding(_), None) => Field::zeros(normal.pressure.raw_dim()),
        };
        let sum = |value: fn(&IncrementRecord) -> f64| increments.iter().map(value).sum::<f64>();
        // Cycles that were not computed have taken energy, too, with the relative error of those that were.
        let computed = sum(|increment| increment.dissipation);
        let dissipation = changed.as_ref().map_or(computed, |changed| changed.work);
        let dissipation_error =
            if computed > 0.0 { dissipation_error * (dissipation / computed) } else { dissipation_error };
        let shear = shear_record(&solution, dissipation);
        let (fretting, heat) = increments.last().map_or((None, None), |last| (last.fretting, last.heat));
        let of_interface = || increments.iter().filter_map(|increment| increment.interface.as_ref());
        let interface = of_interface().next_back().map(|last| last.after(of_interface()));
        let gap = match (&self.response, &changed) {
            (Response::Yielding(yielding), Some(changed)) => {
                changed.pair.initial_gap(&changed.pair.at_rest()) + yielding.displacement(normal)
            }
            // The surfaces with their plastic displacement, below 0 by what a hardness has flattened, as for
            // other bodies.
            (Response::Yielding(_), None) => {
                &normal.initial_gap - &(&plastic - &normal.plastic_interference())
            }
            (Response::Elastic(_), Some(changed)) => changed.pair.initial_gap(&changed.pair.at_rest()),
            (Response::Elastic(_), None) => self.gap.clone(),
        };
        let record = StaticRecord {
            mean_gap: normal.mean_gap_over(&gap),
            iterations: increments.iter().map(|increment| increment.iterations).sum(),
            convolutions: sum(|increment| increment.convolutions),
            shear,
            interface,
            fretting,
            heat,
            ..static_record(&solution, &plastic)
        };
        let plastic_result = None;
        LoadedContact {
            record,
            increments,
            solution,
            plastic,
            slip,
            dissipation_error,
            changed,
            plastic_result,
            film: None,
        }
    }
}
