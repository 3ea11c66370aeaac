//! From a case to its results: what the command line and every other caller run.

use std::path::Path;

use web_time::Instant;

use crate::error::Result;
use crate::grid::CellValues;
use crate::motion::{
    Equilibrium, LoadedContact, Motion, Pair, Simulation, StaticContact, Watch, load_in_stages, press, roll,
    sweep,
};
use crate::solver::Params;
use crate::study::case::{Case, LoadingPath};
use crate::study::estimate::estimate;
use crate::study::identity;
use crate::study::loading::LoadingWriter;
use crate::study::prepare::bodies;
use crate::study::results::{Existing, Writer};
use crate::study::review;
use crate::study::summary::{Outcome, Summary};
use crate::subsurface::Tractions;
use crate::surface::Topography;
use crate::units::SquareMetre;

/// Computes `case` and writes its results to `directory`, which is the writer's until that is dropped: figures may be
/// added to them.
///
/// What is there already stays until all has been checked that can be checked before something is solved; of a contact
/// in one step until it is solved.
///
/// # Errors
/// Everything that can be wrong with a case, its surfaces, the contact or the directory. A motion that ends early
/// leaves its finished passes, a loading its finished increments, from which [`Existing::Resume`] goes on.
pub fn run(
    case: &Case,
    directory: &Path,
    existing: Existing,
    watch: &dyn Watch,
) -> Result<(Summary, Writer)> {
    let began = Instant::now();
    let bodies = bodies(case)?;
    let estimate = estimate(case, &bodies)?;
    let resolved = identity::resolved(case, &bodies);
    let hardness = [bodies.lower.hardness, bodies.upper.hardness];
    let initial = pair(case, [bodies.lower.topography, bodies.upper.topography], hardness.clone())?;
    let params =
        Params { method: case.contact.method, tolerance: case.contact.tolerance, ..Params::default() };
    let area = estimate.apparent_area;
    let (boundary, rim) = (case.contact.boundary, case.output.rim);
    let simulate = |pair, motion| Simulation::new(pair, boundary, motion, params)?.with_rim(rim);
    let work = match case.motion(area) {
        None => Work::Rest(Box::new(initial)),
        Some(motion) => Work::Motion(motion, Box::new(simulate(initial, motion)?)),
    };
    let writer = Writer::enter(directory, &resolved, existing)?;
    let mut warnings = estimate.warnings;
    let mut under_way = None;
    let (outcome, subsurface) = match work {
        Work::Rest(pair) => {
            let rest = rest(case, &writer, &pair, area, &params, watch)?;
            warnings.extend(rest.warnings);
            if let Outcome::Static(_) = rest.outcome {
                warnings.extend(review::static_contact(&pair, boundary, &rest.tractions.pressure));
            }
            let stress = estimate.subsurface.map(|plan| writer.write_subsurface(&plan, rest.tractions));
            under_way = rest.under_way;
            (rest.outcome, stress.transpose()?.into_iter().collect())
        }
        Work::Motion(motion, mut simulation) => {
            writer.begin()?;
            let shapes =
                [simulation.pair().lower_grid(), simulation.pair().upper_grid()].map(|grid| grid.shape);
            let mut passes = writer.passes(case.output.pressure_every, estimate.subsurface)?;
            let done = passes.passes().len();
            if done == 0 {
                writer.write_initial(simulation.pair(), motion.friction.as_ref())?;
            } else if done < motion.passes {
                let mut pair = pair(case, writer.results().surfaces_after(done)?, hardness)?;
                [pair.lower.state, pair.upper.state] = writer.results().states_after(done)?;
                *simulation = simulate(pair, motion)?.resumed(done, writer.results().warm_start_after(done)?);
            }
            passes.passes().iter().for_each(|pass| watch.pass(pass));
            if done < motion.passes {
                simulation.run(watch, &mut [&mut passes])?;
            }
            warnings.extend(review::motion(case, shapes, passes.passes()));
            (Outcome::Passes(passes.passes().to_vec()), passes.subsurface().to_vec())
        }
    };
    warnings.extend(writer.warning().map(str::to_owned));
    if case.output.paraview {
        writer.write_for_paraview()?;
    }
    let summary = Summary {
        version: env!("CARGO_PKG_VERSION").to_owned(),
        case: resolved,
        outcome,
        subsurface,
        warnings,
        wall_time_s: began.elapsed().as_secs_f64(),
    };
    writer.finish(&summary)?;
    under_way.map_or(Ok(()), |loading| loading.done())?;
    Ok((summary, writer))
}

/// What is to be solved, checked.
enum Work {
    Rest(Box<Pair>),
    Motion(Motion, Box<Simulation>),
}

/// The bodies of `case` with these surfaces.
fn pair(case: &Case, surfaces: [Topography; 2], hardness: [CellValues; 2]) -> Result<Pair> {
    let [lower, upper] = surfaces;
    Pair::new(lower, upper, [&case.lower.material, &case.upper.material])?.with_hardness(hardness)
}

/// A static contact.
struct Rest {
    outcome: Outcome,
    /// What acts on the lower body, at the last point of a sweep.
    tractions: Tractions,
    warnings: Vec<String>,
    /// What has kept its increments.
    under_way: Option<LoadingWriter>,
}

/// Computes a static contact and writes its fields.
fn rest(
    case: &Case,
    writer: &Writer,
    pair: &Pair,
    apparent_area: SquareMetre,
    params: &Params,
    watch: &dyn Watch,
) -> Result<Rest> {
    let boundary = case.contact.boundary;
    let control = case.contact.prescribed.control(apparent_area);
    let law = case.friction.as_ref().map(|friction| &friction.law);
    let (contact, points, under_way) = match (case.loading_path(apparent_area), law) {
        (Some(LoadingPath::Sweep(points)), law) => {
            writer.begin()?;
            let mut output = writer.sweep(pair, case.output.pressure_every);
            let done = writer.results().sweep()?;
            let (points, contact) = sweep(pair, boundary, law, &points, params, done, watch, &mut output)?;
            (contact, Some(points), None)
        }
        (Some(LoadingPath::Rolling(rolling)), Some(law)) => {
            let contact = roll(pair, boundary, law, control, rolling, params, watch)?;
            writer.begin()?;
            (contact, None, None)
        }
        (Some(LoadingPath::Stages(stages)), law) if law.is_some() || stages.len() > 1 => {
            writer.begin()?;
            let mut loading = writer.loading(pair, stages.iter().map(|stage| stage.increments).sum());
            let done = loading.under_way()?;
            let contact = load_in_stages(pair, boundary, law, &stages, params, done, watch, &mut loading)?;
            (contact, None, Some(loading))
        }
        _ => {
            let StaticContact { record, solution } = press(pair, boundary, control, params, watch)?;
            writer.begin()?;
            writer.write_static(pair, &solution)?;
            let tractions = Tractions::frictionless(solution.pressure);
            let outcome = Outcome::Static(Box::new(record));
            return Ok(Rest { outcome, tractions, warnings: Vec::new(), under_way: None });
        }
    };
    writer.write_loaded(pair, &contact)?;
    let warnings = match &points {
        Some(points) => review::sweep(points, &contact),
        None => review::loaded(&contact),
    };
    let LoadedContact { record, solution, .. } = contact;
    let outcome = points.map_or_else(|| Outcome::Static(Box::new(record)), Outcome::Sweep);
    let tractions = match solution {
        Equilibrium::Frictionless(solution) => Tractions::frictionless(solution.pressure),
        Equilibrium::Frictional(solution) => {
            Tractions { pressure: solution.normal.pressure, shear: solution.shear.map(Some) }
        }
    };
    Ok(Rest { outcome, tractions, warnings, under_way })
}
