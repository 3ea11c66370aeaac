//! From a case to its results: what the command line and every other caller run.

use std::path::Path;
use std::time::Instant;

use crate::error::Result;
use crate::io::case::{Case, Course};
use crate::io::loading::LoadingWriter;
use crate::io::outlook::outlook;
use crate::io::prepare::bodies;
use crate::io::results::{Existing, PassWriter, Results};
use crate::io::review;
use crate::io::summary::{Outcome, Summary};
use crate::motion::{
    Equilibrium, LoadedContact, Motion, Pair, Simulation, StaticRecord, Watch, load_in_stages, press, roll,
};
use crate::solver::Params;
use crate::subsurface::Tractions;
use crate::surface::Topography;
use crate::units::SquareMetre;

/// Computes `case` and writes its results to `directory`.
///
/// # Errors
/// Everything that can be wrong with a case, its surfaces, the contact or the directory. A motion that ends early
/// leaves its finished passes, a loading its finished increments, from which [`Existing::Resume`] goes on.
pub fn run(case: &Case, directory: &Path, existing: Existing, watch: &dyn Watch) -> Result<Summary> {
    let began = Instant::now();
    let bodies = bodies(case)?;
    let outlook = outlook(case, &bodies)?;
    let pair = pair(case, [bodies.lower.topography, bodies.upper.topography])?;
    let resolved = serde_json::to_value(case).expect("a case can be written as JSON");
    let results = Results::create(directory, &resolved, existing)?;
    let params =
        Params { method: case.contact.method, tolerance: case.contact.tolerance, ..Params::default() };
    let area = outlook.apparent_area;
    let mut warnings = outlook.warnings;
    let mut under_way = None;
    let (outcome, subsurface) = match case.motion(area) {
        None => {
            let rest = rest(case, &results, &pair, area, &params, watch)?;
            warnings.extend(rest.warnings);
            warnings.extend(review::static_contact(&pair, case.contact.boundary, &rest.tractions.pressure));
            let stress = outlook.subsurface.map(|plan| results.write_subsurface(&plan, rest.tractions));
            under_way = rest.under_way;
            (Outcome::Static(rest.record), stress.transpose()?.into_iter().collect())
        }
        Some(motion) => {
            let writer = results.writer(case.output.pressure_every, outlook.subsurface)?;
            let shapes = [pair.lower_grid().shape, pair.upper_grid().shape];
            let writer = move_over(case, &results, writer, pair, motion, params, watch)?;
            warnings.extend(review::motion(case, shapes, writer.passes()));
            (Outcome::Passes(writer.passes().to_vec()), writer.subsurface().to_vec())
        }
    };
    let summary = Summary {
        version: env!("CARGO_PKG_VERSION").to_owned(),
        case: resolved,
        outcome,
        subsurface,
        warnings,
        wall_time_s: began.elapsed().as_secs_f64(),
    };
    results.finish(&summary)?;
    under_way.map_or(Ok(()), |writer| writer.done())?;
    Ok(summary)
}

fn pair(case: &Case, surfaces: [Topography; 2]) -> Result<Pair> {
    let [lower, upper] = surfaces;
    Pair::new(lower, upper, [&case.lower.material, &case.upper.material])
}

/// A static contact.
struct Rest {
    record: StaticRecord,
    /// What acts on the lower body.
    tractions: Tractions,
    warnings: Vec<String>,
    /// What has kept its increments.
    under_way: Option<LoadingWriter>,
}

/// Computes a static contact and writes its fields.
fn rest(
    case: &Case,
    results: &Results,
    pair: &Pair,
    apparent_area: SquareMetre,
    params: &Params,
    watch: &dyn Watch,
) -> Result<Rest> {
    let boundary = case.contact.boundary;
    let control = case.contact.prescribed.control(apparent_area);
    let law = case.friction.as_ref().map(|friction| &friction.law);
    let (contact, under_way) = match (case.course(apparent_area), law) {
        (Some(Course::Rolling(rolling)), Some(law)) => {
            (roll(pair, boundary, law, control, rolling, params)?, None)
        }
        (Some(Course::Stages(stages)), law) if law.is_some() || stages.len() > 1 => {
            let mut writer = results.loading(pair, stages.iter().map(|stage| stage.increments).sum());
            let done = writer.under_way()?;
            let contact = load_in_stages(pair, boundary, law, &stages, params, done, watch, &mut writer)?;
            (contact, Some(writer))
        }
        _ => {
            let (record, solution) = press(pair, boundary, control, params)?;
            results.write_static(pair, &solution)?;
            let tractions = Tractions::frictionless(solution.pressure);
            return Ok(Rest { record, tractions, warnings: Vec::new(), under_way: None });
        }
    };
    results.write_loaded(pair, &contact)?;
    let warnings = review::loaded(&contact);
    let LoadedContact { record, solution, .. } = contact;
    let tractions = match solution {
        Equilibrium::Frictionless(solution) => Tractions::frictionless(solution.pressure),
        Equilibrium::Frictional(solution) => {
            Tractions { pressure: solution.normal.pressure, shear: solution.shear.map(Some) }
        }
    };
    Ok(Rest { record, tractions, warnings, under_way })
}

/// The passes that are not yet there; the writer has then written them.
fn move_over(
    case: &Case,
    results: &Results,
    mut writer: PassWriter,
    initial: Pair,
    motion: Motion,
    params: Params,
    watch: &dyn Watch,
) -> Result<PassWriter> {
    let (boundary, rim) = (case.contact.boundary, case.output.rim);
    let done = results.passes()?;
    let mut simulation = match done.last() {
        None => {
            let simulation = Simulation::new(initial, boundary, motion, params)?.with_rim(rim)?;
            results.write_initial(simulation.pair())?;
            simulation
        }
        // Nothing is left to do.
        Some(_) if done.len() >= motion.passes => return Ok(writer),
        Some(_) => {
            let pair = pair(case, results.surfaces_after(done.len())?)?;
            let warm = results.warm_start_after(done.len(), &pair)?;
            Simulation::new(pair, boundary, motion, params)?.with_rim(rim)?.resumed(done.len(), warm)
        }
    };
    simulation.run(watch, &mut [&mut writer])?;
    Ok(writer)
}
