//! From a case to its results: what the command line and every other caller run.

use std::path::Path;
use std::time::Instant;

use crate::error::Result;
use crate::io::case::{Case, Course};
use crate::io::outlook::outlook;
use crate::io::prepare::bodies;
use crate::io::results::{Existing, PassWriter, Results};
use crate::io::summary::{Outcome, Summary};
use crate::motion::{Motion, Pair, Simulation, StaticRecord, Watch, load_in_stages, press, roll};
use crate::solver::Params;
use crate::subsurface::Tractions;
use crate::surface::Topography;
use crate::units::SquareMetre;

/// Computes `case` and writes its results to `directory`.
///
/// # Errors
/// Everything that can be wrong with a case, its surfaces, the contact or the directory. A motion that ends early
/// leaves its finished passes, from which [`Existing::Resume`] goes on.
pub fn run(case: &Case, directory: &Path, existing: Existing, watch: &dyn Watch) -> Result<Summary> {
    let began = Instant::now();
    let bodies = bodies(case)?;
    let outlook = outlook(case, &bodies)?;
    let resolved = serde_json::to_value(case).expect("a case can be written as JSON");
    let results = Results::create(directory, &resolved, existing)?;
    let pair = pair(case, [bodies.lower.topography, bodies.upper.topography])?;
    let params =
        Params { method: case.contact.method, tolerance: case.contact.tolerance, ..Params::default() };
    let area = outlook.apparent_area;
    let (outcome, subsurface) = match case.motion(area) {
        None => {
            let (record, tractions) = rest(case, &results, &pair, area, &params, watch)?;
            let stress = outlook.subsurface.map(|plan| results.write_subsurface(&plan, tractions));
            (Outcome::Static(record), stress.transpose()?.into_iter().collect())
        }
        Some(motion) => {
            let writer = results.writer(case.output.pressure_every, outlook.subsurface)?;
            let writer = move_over(case, &results, writer, pair, motion, params, watch)?;
            (Outcome::Passes(writer.passes().to_vec()), writer.subsurface().to_vec())
        }
    };
    let summary = Summary {
        version: env!("CARGO_PKG_VERSION").to_owned(),
        case: resolved,
        outcome,
        subsurface,
        warnings: outlook.warnings,
        wall_time_s: began.elapsed().as_secs_f64(),
    };
    results.finish(&summary)?;
    Ok(summary)
}

fn pair(case: &Case, surfaces: [Topography; 2]) -> Result<Pair> {
    let [lower, upper] = surfaces;
    Pair::new(lower, upper, [&case.lower.material, &case.upper.material])
}

/// A static contact: its numbers and what acts on the lower body.
fn rest(
    case: &Case,
    results: &Results,
    pair: &Pair,
    apparent_area: SquareMetre,
    params: &Params,
    watch: &dyn Watch,
) -> Result<(StaticRecord, Tractions)> {
    let boundary = case.contact.boundary;
    let control = case.contact.prescribed.control(apparent_area);
    let Some(friction) = case.friction else {
        let (record, solution) = press(pair, boundary, control, params)?;
        results.write_static(pair, &solution)?;
        return Ok((record, Tractions::frictionless(solution.pressure)));
    };
    let contact = match friction.course(case.contact.prescribed, &case.history, apparent_area) {
        Course::Stages(stages) => load_in_stages(pair, boundary, &friction.law, &stages, params, watch)?,
        Course::Rolling(rolling) => roll(pair, boundary, &friction.law, control, rolling, params)?,
    };
    results.write_frictional(pair, &contact)?;
    let solution = contact.solution;
    let tractions = Tractions { pressure: solution.normal.pressure, shear: solution.shear.map(Some) };
    Ok((contact.record, tractions))
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
    let boundary = case.contact.boundary;
    let done = results.passes()?;
    let mut simulation = match done.last() {
        None => {
            let simulation = Simulation::new(initial, boundary, motion, params)?;
            results.write_initial(simulation.pair())?;
            simulation
        }
        // Nothing is left to do.
        Some(_) if done.len() >= motion.passes => return Ok(writer),
        Some(_) => {
            let pair = pair(case, results.surfaces_after(done.len())?)?;
            let warm = results.warm_start_after(done.len(), &pair)?;
            Simulation::new(pair, boundary, motion, params)?.resumed(done.len(), warm)
        }
    };
    simulation.run(watch, &mut [&mut writer])?;
    Ok(writer)
}
