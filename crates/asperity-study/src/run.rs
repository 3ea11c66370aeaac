//! From a case to its results, for the command line and every other caller.

use std::path::Path;

use web_time::Instant;

use crate::case::Case;
use crate::estimate::{Estimate, estimate};
use crate::finish::{Computed, conclude, pair};
use crate::identity;
use crate::io::lock::Lock;
use crate::observe;
use crate::passes::Passes;
use crate::prepare::bodies_until;
use crate::results::{Existing, Writer};
use crate::static_contact::{self, StaticResult};
use crate::summary::{Outcome, Summary};
use crate::surface_input::SurfaceInput;
use asperity_base::error::Result;
use asperity_contact::motion::Watch;

/// Computes `case`, with the surfaces `given` that it names, and writes its results to `directory`. The
/// returned writer owns the directory until it is dropped, so that figures can be added.
///
/// Existing results stay until everything that can be checked before solving is checked. For a contact in one
/// step they stay until it is solved.
///
/// # Errors
/// Every error of a case, its surfaces, the contact or the directory. A motion that ends early leaves its
/// finished passes, a loading its finished increments. [`Existing::Resume`] continues from these.
pub fn run(
    case: &Case,
    given: SurfaceInput,
    directory: &Path,
    existing: Existing,
    watch: &dyn Watch,
) -> Result<(Summary, Writer)> {
    run_with(case, given, directory, (existing, None), watch)
}

/// [`run`] with a lock of the directory that may be held already.
pub(super) fn run_with(
    case: &Case,
    given: SurfaceInput,
    directory: &Path,
    (existing, lock): (Existing, Option<Lock>),
    watch: &dyn Watch,
) -> Result<(Summary, Writer)> {
    if case.course(1.0).moves() {
        let mut passes = Passes::enter_with(case, given, directory, (existing, lock), &|| watch.stop())?;
        passes.done()?.iter().for_each(|pass| watch.pass(pass));
        while let Some(pass) = passes.solve(watch)? {
            passes.finish(pass, watch)?;
        }
        return passes.end();
    }
    let began = Instant::now();
    let bodies = bodies_until(case, given, &|| watch.stop())?;
    let estimate = estimate(case, &bodies)?;
    let resolved = identity::resolved(case, &bodies);
    let pair = pair(case, bodies)?;
    let writer = Writer::enter_with(directory, &resolved, existing, lock)?;
    let rest = static_contact::solve(case, pair, &estimate, Some(&writer), watch)?;
    let Estimate { subsurface, mut warnings, .. } = estimate;
    let StaticResult {
        outcome,
        updates,
        fields,
        plastic_result,
        interface,
        closed_form,
        found,
        warnings: of_answer,
        ..
    } = rest;
    warnings.extend(of_answer);
    let below = subsurface.map(|plan| (plan, fields.tractions()));
    writer.write_rest(fields)?;
    let volumes = match &plastic_result {
        None => &[][..],
        Some(plastic_result) => {
            writer.write_plastic(plastic_result)?;
            &plastic_result.volumes
        }
    };
    let stress =
        below.map(|(plan, tractions)| writer.write_subsurface(&plan, tractions, volumes)).transpose()?;
    let (subsurface, sliding) = (stress.into_iter().collect(), updates.last().cloned());
    let computed = Computed {
        outcome,
        subsurface,
        sliding,
        plasticity: None,
        interface,
        closed_form,
        found: observe::summary(&found),
    };
    let summary = conclude(case, &writer, began, computed, warnings)?;
    // A resumed sweep of speeds solves its last point again, from the state after the one before.
    let kept = match &summary.outcome {
        Outcome::Sweep(points) => points.last().and_then(|last| last.speed.map(|_| last.point - 1)),
        Outcome::Static(_) | Outcome::Passes(_) => None,
    };
    writer.results().remove_states(kept)?;
    Ok((summary, writer))
}
