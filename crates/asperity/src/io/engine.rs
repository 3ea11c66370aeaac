//! From a case to its results: what the command line and every other caller run.

use std::path::Path;
use std::time::Instant;

use crate::error::Result;
use crate::io::case::{Case, Course};
use crate::io::outlook::outlook;
use crate::io::prepare::bodies;
use crate::io::results::{Existing, Results};
use crate::io::summary::{Outcome, Summary};
use crate::motion::{Motion, Pair, PassRecord, Simulation, Watch, load_in_stages, press, roll};
use crate::solver::Params;
use crate::surface::Topography;

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
    let outcome = match case.motion(area) {
        None => {
            let control = case.contact.prescribed.control(area);
            Outcome::Static(match case.friction {
                None => {
                    let (record, solution) = press(&pair, case.contact.boundary, control, &params)?;
                    results.write_static(&pair, &solution)?;
                    record
                }
                Some(friction) => {
                    let course = friction.course(case.contact.prescribed, &case.history, area);
                    let contact = match course {
                        Course::Stages(stages) => load_in_stages(
                            &pair,
                            case.contact.boundary,
                            &friction.law,
                            &stages,
                            &params,
                            watch,
                        )?,
                        Course::Rolling(rolling) => {
                            roll(&pair, case.contact.boundary, &friction.law, control, rolling, &params)?
                        }
                    };
                    results.write_frictional(&pair, &contact)?;
                    contact.record
                }
            })
        }
        Some(motion) => Outcome::Passes(move_over(case, &results, pair, motion, params, watch)?),
    };
    let summary = Summary {
        version: env!("CARGO_PKG_VERSION").to_owned(),
        case: resolved,
        outcome,
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

/// The passes that are not yet there.
fn move_over(
    case: &Case,
    results: &Results,
    initial: Pair,
    motion: Motion,
    params: Params,
    watch: &dyn Watch,
) -> Result<Vec<PassRecord>> {
    let boundary = case.contact.boundary;
    let done = results.passes()?;
    let mut simulation = match done.last() {
        None => {
            let simulation = Simulation::new(initial, boundary, motion, params)?;
            results.write_initial(simulation.pair())?;
            simulation
        }
        Some(last) => {
            let pair = pair(case, results.surfaces_after(done.len())?)?;
            Simulation::new(pair, boundary, motion, params)?.resumed(done.len(), last.approach)
        }
    };
    let mut writer = results.writer(case.output.pressure_every)?;
    simulation.run(watch, &mut [&mut writer])?;
    Ok(writer.passes().to_vec())
}
