//! State between two increments of a loading.

use super::super::Results;
use super::super::bodies::add_bodies;
use super::Stored;
use super::pass::{add_sums, sums};
use crate::io::fields::FieldFile;
use asperity_base::error::Result;
use asperity_base::grid::{CellValues, Field};
use asperity_contact::motion::{
    ChangedBodies, Flattening, IncrementRecord, LastCycle, LastExtrapolation, LoadingState, Origin, Pair,
    StageProgress,
};
use asperity_contact::solver::{Bounds, Equilibrium, FrictionalSolution, Solution, Stats};

/// Adds the state after an increment.
pub(crate) fn add(file: &mut FieldFile, state: &LoadingState) {
    let grid = &state.contact.normal().grid;
    let mut add = |name: &str, unit: &str, field: &Field| {
        file.add_field(name, unit, grid, [0.0, 0.0], field);
    };
    let normal = state.contact.normal();
    add("pressure", "Pa", &normal.pressure);
    add("displacement", "m", &normal.displacement);
    add("deepest", "m", &state.flattening.deepest);
    if let CellValues::Field(lower) = normal.bounds.lower() {
        add("least_pressure", "Pa", lower);
    }
    if let Some(kept) = &state.flattening.kept {
        add("kept", "m", kept);
    }
    if let Some([x, y]) = &state.slip {
        add("slip_x", "m", x);
        add("slip_y", "m", y);
    }
    if let Some(solution) = state.contact.frictional() {
        for (name, unit, [x, y]) in [
            ("traction", "Pa", &solution.shear),
            ("displacement", "m", &solution.displacement),
            ("last_slip", "m", &solution.slip),
        ] {
            add(&format!("{name}_x"), unit, x);
            add(&format!("{name}_y"), unit, y);
        }
        if let CellValues::Field(cap) = normal.bounds.upper() {
            add("cap", "Pa", cap);
        }
        add("shear_limit", "Pa", &solution.shear_limit);
        add("stick", "1", &solution.stick);
        file.set("rigid_displacement", solution.rigid_displacement.to_vec());
    }
    if let Some(changed) = &state.changed {
        let ChangedBodies { pair, sums, last, work, cycle_work, error, cycles } = changed;
        add_bodies(file, pair);
        let grids = [pair.lower_grid(), pair.upper_grid()];
        add_sums(file, "cycle", &grids, sums);
        if let Some(LastCycle { extrapolation, pressure, work }) = last {
            file.set("jump", extrapolation.passes).set("last_work", *work);
            file.add_field("cycle_pressure", "Pa", grid, [0.0, 0.0], pressure);
            add_sums(file, "sum", &grids, &extrapolation.sums);
        }
        file.set("friction_work", *work)
            .set("cycle_work", *cycle_work)
            .set("wear_error", *error)
            .set("cycles_done", *cycles);
    }
    let StageProgress { stage, cycles, step } = state.next;
    file.set("next_stage", stage).set("next_cycles", cycles).set("next_step", step);
    let Origin { load, approach, force, displacement } = state.origin;
    file.set("approach", normal.approach)
        .set("residual", normal.residual)
        .set("iterations", normal.stats.iterations)
        .set("convolutions", normal.stats.convolutions)
        .set("restarts", normal.stats.restarts)
        .set("dissipation_error", state.dissipation_error)
        .set("origin_load", load)
        .set("origin_approach", approach)
        .set("origin_force", force.to_vec())
        .set("origin_displacement", displacement.to_vec());
}

/// Reads the state after these `increments` of a loading of the `pair` from a `stored` state.
pub(crate) fn read(stored: &Stored, pair: &Pair, increments: Vec<IncrementRecord>) -> Result<LoadingState> {
    let changed = stored.holds("lower").then(|| changed(stored, pair)).transpose()?;
    let pair = changed.as_ref().map_or(pair, |changed| &changed.pair);
    let kept = stored.holds("kept").then(|| stored.field("kept")).transpose()?;
    let flattening = Flattening { kept, deepest: stored.field("deepest")? };
    let bounds = match stored.holds("cap") {
        true => Bounds::up_to(stored.field("cap")?),
        false => pair.bounds(&pair.at_rest(), None),
    };
    let bounds = match stored.holds("least_pressure") {
        true => bounds.above(stored.field("least_pressure")?),
        false => bounds,
    };
    let normal = Solution {
        grid: pair.lower_grid(),
        initial_gap: flattening.open(&pair.initial_gap(&pair.at_rest())).into_owned(),
        bounds,
        pressure: stored.field("pressure")?,
        displacement: stored.field("displacement")?,
        approach: stored.number("approach")?,
        residual: stored.number("residual")?,
        stats: Stats {
            iterations: stored.number("iterations")? as usize,
            convolutions: stored.number("convolutions")?,
            restarts: stored.number("restarts")? as usize,
            ..Stats::default()
        },
    };
    let has_friction = stored.holds("stick");
    let contact = match has_friction {
        false => Equilibrium::Frictionless(Box::new(normal)),
        true => Equilibrium::Frictional(Box::new(FrictionalSolution {
            normal,
            shear: stored.both("traction")?,
            shear_limit: stored.field("shear_limit")?,
            displacement: stored.both("displacement")?,
            rigid_displacement: stored.pair("rigid_displacement")?,
            slip: stored.both("last_slip")?,
            stick: stored.field("stick")?,
        })),
    };
    Ok(LoadingState {
        increments,
        contact,
        origin: Origin {
            load: stored.number("origin_load")?,
            approach: stored.number("origin_approach")?,
            force: stored.pair("origin_force")?,
            displacement: stored.pair("origin_displacement")?,
        },
        flattening,
        slip: has_friction.then(|| stored.both("slip")).transpose()?,
        dissipation_error: stored.number("dissipation_error")?,
        next: StageProgress {
            stage: stored.number("next_stage")? as usize,
            cycles: stored.number("next_cycles")? as usize,
            step: stored.number("next_step")? as usize,
        },
        changed,
    })
}

/// Reads bodies that laws have changed. They have the hardness of the `pair`, without their films.
fn changed(stored: &Stored, pair: &Pair) -> Result<ChangedBodies> {
    let mut pair = pair.clone();
    (pair.lower.heights, pair.upper.heights) = (stored.field("lower")?, stored.field("upper")?);
    [pair.lower.state, pair.upper.state] = Results::states_of(&stored.fields)?;
    let last = match stored.number("jump") {
        Ok(passes) => {
            let sums = sums(&stored.fields, "sum")?;
            Some(LastCycle {
                extrapolation: LastExtrapolation { passes: passes as usize, sums },
                pressure: stored.field("cycle_pressure")?,
                work: stored.number("last_work")?,
            })
        }
        Err(_) => None,
    };
    Ok(ChangedBodies {
        pair,
        sums: sums(&stored.fields, "cycle")?,
        last,
        work: stored.number("friction_work")?,
        cycle_work: stored.number("cycle_work")?,
        error: stored.number("wear_error")?,
        cycles: stored.number("cycles_done")? as usize,
    })
}
