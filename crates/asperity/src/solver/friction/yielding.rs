//! The normal contact of cells that bear different pressures at the most.

use crate::error::{Error, Result};
use crate::grid::Field;
use crate::operator::Operator;
use crate::solver::friction::Friction;
use crate::solver::{Control, Params, Solution, Stats, solve_normal};
use crate::units::Pascal;

/// The most pressure that each cell bears beside its shear, from the present pressure.
pub(super) fn caps(friction: &Friction, hardness: Pascal, pressure: &Field, shear: &[Field; 2]) -> Field {
    let mut caps = pressure.clone();
    ndarray::Zip::from(&mut caps).and(&shear[0]).and(&shear[1]).for_each(|p, x, y| {
        *p = friction.cap(hardness, *p, x.hypot(*y));
    });
    caps
}

/// Changes of the cells at their cap after which the iteration is given up.
const MOST_CHANGES: usize = 100;

/// Pressures of which some are at their caps.
pub(super) struct AtCaps {
    /// The caps where they are reached, 0 elsewhere.
    capped: Field,
    /// The pressure of the other cells.
    pressure: Field,
}

impl AtCaps {
    /// The cells that have reached their `caps` go along with these to the `next`.
    pub(super) fn of(pressure: &Field, caps: &Field, next: &Field) -> Self {
        let mut this = Self { capped: pressure.clone(), pressure: pressure.clone() };
        ndarray::Zip::from(&mut this.capped).and(&mut this.pressure).and(caps).and(next).for_each(
            |capped, p, cap, next| {
                (*capped, *p) = if *p >= *cap { (*next, 0.0) } else { (0.0, *p) };
            },
        );
        this
    }
}

/// Solves the contact with 0 ≤ p ≤ `caps` from the pressure `start`.
///
/// The cells at their cap are taken out of the contact, and their pressure and displacement are given, until no other
/// cell bears more than its cap and none of them opens; each time [`solve_normal`] does the rest.
pub(super) fn solve_capped(
    operator: &mut dyn Operator,
    initial_gap: &Field,
    caps: &Field,
    control: Control,
    start: AtCaps,
    params: &Params,
) -> Result<Solution> {
    let (grid, c0) = (*operator.grid(), operator.influence(0, 0));
    let AtCaps { mut capped, mut pressure } = start;
    let mut stats = Stats::default();
    let mut under = grid.zeros();
    for _ in 0..MOST_CHANGES {
        let given = grid.cell_area() * capped.sum();
        let rest = match control {
            Control::Load(load) if load <= given => {
                let limit = grid.cell_area() * caps.sum();
                if load >= limit {
                    return Err(Error::BeyondPlasticLimit { load, limit });
                }
                // Caps that have risen bear too much: all cells are free to find out which do.
                pressure += &capped;
                capped.fill(0.0);
                control
            }
            Control::Load(load) => Control::Load(load - given),
            Control::Approach(_) => control,
        };
        operator.apply(&capped, &mut under);
        let mut gap = initial_gap + &under;
        // The cells that are given are far out of reach.
        let largest = |field: &Field| field.iter().fold(0.0f64, |m, v| m.max(v.abs()));
        let far = 10.0 * largest(&gap) + 1e4 * c0 * largest(caps);
        gap.zip_mut_with(&capped, |h, cap| *h = if *cap > 0.0 { far } else { *h });
        let mut solution = solve_normal(operator, &gap, f64::INFINITY, rest, Some(&pressure), params)?;
        stats = stats.and(&solution.stats);
        stats.convolutions += 1.0;
        pressure.assign(&solution.pressure);
        solution.displacement += &under;
        let allowed = params.tolerance * solution.displacement.std(0.0);
        let mut changed = false;
        let mut largest = 0.0f64;
        ndarray::Zip::from(&mut capped)
            .and(caps)
            .and(&solution.pressure)
            .and(&solution.displacement)
            .and(initial_gap)
            .for_each(|capped, cap, p, u, h| {
                let w = solution.approach - h - u;
                let beyond = if *capped > 0.0 { -w } else { c0 * (p - cap) };
                if beyond > allowed {
                    *capped = if *capped > 0.0 { 0.0 } else { *cap };
                    changed = true;
                } else if beyond > 0.0 {
                    largest = largest.max(beyond);
                }
            });
        if !changed {
            solution.pressure += &capped;
            solution.residual = solution.residual.max(largest / solution.displacement.std(0.0));
            solution.stats = stats;
            return Ok(solution);
        }
    }
    let (iterations, tolerance) = (stats.iterations, params.tolerance);
    Err(Error::NotConverged { iterations, residual: f64::NAN, tolerance })
}
