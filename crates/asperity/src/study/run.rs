//! From a case to its results: what the command line and every other caller run.

use std::path::Path;

use web_time::Instant;

use crate::error::Result;
use crate::motion::{FlowRecord, Pair, UpdateRecord, Watch};
use crate::solver::Params;
use crate::study::case::Case;
use crate::study::estimate::{Estimate, estimate};
use crate::study::given::Given;
use crate::study::identity;
use crate::study::passes::Passes;
use crate::study::prepare::{Bodies, bodies_until};
use crate::study::rest;
use crate::study::results::{Existing, Writer};
use crate::study::subsurface::SubsurfaceRecord;
use crate::study::summary::{Outcome, RunningIn, Summary};

/// Computes `case`, with the surfaces `given` that it names, and writes its results to `directory`, which is the writer's until
/// that is dropped: figures may be added to them.
///
/// What is there already stays until all has been checked that can be checked before something is solved; of a contact
/// in one step until it is solved.
///
/// # Errors
/// Everything that can be wrong with a case, its surfaces, the contact or the directory. A motion that ends early
/// leaves its finished passes, a loading its finished increments, from which [`Existing::Resume`] goes on.
pub fn run(
    case: &Case,
    given: Given,
    directory: &Path,
    existing: Existing,
    watch: &dyn Watch,
) -> Result<(Summary, Writer)> {
    if case.motion.is_some() {
        let mut passes = Passes::enter_until(case, given, directory, existing, &|| watch.stop())?;
        passes.done()?.iter().for_each(|pass| watch.pass(pass));
        while let Some(pass) = passes.solve(watch)? {
            passes.finish(pass, watch)?;
        }
        return passes.end();
    }
    let began = Instant::now();
    let bodies = bodies_until(case, given, &|| watch.stop())?;
    let Estimate { apparent_area, subsurface, mut warnings, .. } = estimate(case, &bodies)?;
    let resolved = identity::resolved(case, &bodies);
    let pair = pair(case, bodies)?;
    let writer = Writer::enter(directory, &resolved, existing)?;
    let (mut solved, of_answer) = rest::solve(case, &pair, apparent_area, Some(&writer), watch)?;
    warnings.extend(of_answer);
    let (outcome, sliding) = (solved.outcome(), solved.last_update());
    let under_way = solved.take_under_way();
    let flowed = solved.take_flowed();
    let fields = solved.into_fields(rest::displaced(pair, flowed.as_ref()));
    let below = subsurface.map(|plan| (plan, fields.tractions()));
    writer.write_rest(fields)?;
    let volumes = match &flowed {
        None => &[][..],
        Some(flowed) => {
            writer.write_flow(flowed)?;
            &flowed.volumes
        }
    };
    let stress =
        below.map(|(plan, tractions)| writer.write_subsurface(&plan, tractions, volumes)).transpose()?;
    let computed = Computed { outcome, subsurface: stress.into_iter().collect(), sliding, flow: None };
    let summary = conclude(case, &writer, resolved, began, computed, warnings)?;
    under_way.map_or(Ok(()), |under_way| under_way.done())?;
    writer.results().forget_sweep()?;
    Ok((summary, writer))
}

/// What a run has computed, in numbers.
pub(super) struct Computed {
    pub(super) outcome: Outcome,
    pub(super) subsurface: Vec<SubsurfaceRecord>,
    /// The last update of a contact that has slid in place.
    pub(super) sliding: Option<UpdateRecord>,
    /// What the passes of bodies that flow come to.
    pub(super) flow: Option<FlowRecord>,
}

/// Writes what comes at the end of every run.
pub(super) fn conclude(
    case: &Case,
    writer: &Writer,
    resolved: serde_json::Value,
    began: Instant,
    Computed { outcome, subsurface, sliding, flow }: Computed,
    mut warnings: Vec<String>,
) -> Result<Summary> {
    outcome.check()?;
    warnings.extend(writer.warning().map(str::to_owned));
    if case.output.paraview {
        writer.write_for_paraview()?;
    }
    let running_in = match &outcome {
        Outcome::Passes(passes) => RunningIn::of(passes),
        Outcome::Static(_) | Outcome::Sweep(_) => None,
    };
    let summary = Summary {
        running_in,
        sliding,
        plasticity: flow,
        version: env!("CARGO_PKG_VERSION").to_owned(),
        case: resolved,
        outcome,
        subsurface,
        warnings,
        wall_time_s: began.elapsed().as_secs_f64(),
    };
    writer.finish(&summary)?;
    Ok(summary)
}

/// The `bodies` of `case`, face to face.
pub(super) fn pair(case: &Case, bodies: Bodies) -> Result<Pair> {
    let Bodies { lower, upper } = bodies;
    let materials = [&case.lower.material, &case.upper.material];
    Pair::new(lower.topography, upper.topography, materials)?.with_hardness([lower.hardness, upper.hardness])
}

/// The solver that `case` asks for.
pub(super) fn params(case: &Case) -> Params {
    Params { method: case.contact.method, tolerance: case.contact.tolerance, ..Params::default() }
}
