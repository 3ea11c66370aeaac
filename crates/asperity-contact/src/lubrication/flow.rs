//! The balance of the oil in each cell, and its derivatives.
//!
//! Oil enters a face by the motion of the surfaces, upwind and of second order, and by the gradient of the
//! pressure, with the logarithmic mean of m = ρh³/12η of both cells, which is exact where η rises exponentially
//! with pressure. All quantities are divided by the density at ambient pressure.

use super::oil::Oil;
use crate::grid::Grid;
use crate::math::parallel;
use crate::units::Second;

/// Cells that the balance of a cell depends on: itself, upstream, downstream, before and after it along y, and
/// two upstream.
pub(super) const OFFSETS: [[isize; 2]; 6] = [[0, 0], [-1, 0], [1, 0], [0, -1], [0, 1], [-2, 0]];

const HERE: usize = 0;
pub(super) const UPSTREAM: usize = 1;
const DOWNSTREAM: usize = 2;
const BEFORE: usize = 3;
const AFTER: usize = 4;
pub(super) const SECOND_UPSTREAM: usize = 5;

/// A backward step of time.
#[derive(Debug, Clone, Copy)]
pub struct OilStep<'a> {
    /// Oil in each cell before the step, ρh(1 − θ)/ρ₀, m: [`FilmSolution::oil`](super::FilmSolution::oil).
    pub before: &'a [f64],
    /// Duration of the step, > 0.
    pub duration: Second,
}

/// The flow of an oil through a gap. It moves along +x.
pub(super) struct Flow<'a> {
    pub(super) grid: Grid,
    /// Whether the gap repeats along y.
    pub(super) repeats: bool,
    pub(super) oil: Oil,
    /// Mean speed of the surfaces, m/s, ≥ 0.
    pub(super) speed: f64,
    /// h_c.
    pub(super) boundary_film: f64,
    /// Pressures at the inlet and the outlet.
    pub(super) ends: [f64; 2],
    pub(super) step: Option<OilStep<'a>>,
}

/// The balance of a cell: what leaves it and is stored in it, m³/s, and its derivatives.
#[derive(Clone, Copy, Default)]
pub(super) struct Balance {
    pub(super) residual: f64,
    /// By the pressure of each cell of [`OFFSETS`].
    pub(super) by_pressure: [f64; 6],
    /// By the film thickness of each.
    pub(super) by_film: [f64; 6],
    /// By the cavity fraction of the cell, and of the one upstream.
    pub(super) by_cavity: [f64; 2],
}

/// The flow through a face, with its derivatives by what lies two cells and one cell upstream of the face and
/// downstream of it.
#[derive(Clone, Copy, Default)]
struct Face {
    flow: f64,
    by_pressure: [f64; 3],
    by_film: [f64; 3],
    by_cavity: f64,
}

/// The oil in a cell.
#[derive(Clone, Copy, Default)]
struct Held {
    film: f64,
    /// dfilm/dh; below 1 where h is below the boundary film.
    film_by_h: f64,
    density: f64,
    density_rise: f64,
    mobility: f64,
    mobility_by_p: f64,
    mobility_by_h: f64,
}

/// Returns the film that the flow sees, and its derivative. Below the boundary film, where only a step on the
/// way to a solution gets, it bends smoothly to half of that.
#[inline]
pub(super) fn seen(h: f64, boundary_film: f64) -> [f64; 2] {
    if h >= boundary_film {
        return [h, 1.0];
    }
    let slope = (2.0 * (h / boundary_film - 1.0)).exp();
    [0.5 * boundary_film * (1.0 + slope), slope]
}

/// Returns the logarithmic mean, and its derivatives.
#[inline]
fn log_mean(a: f64, b: f64) -> [f64; 3] {
    let r = (a / b).ln();
    if r.abs() < 1e-4 {
        return [0.5 * (a + b), 0.5, 0.5];
    }
    [(a - b) / r, (r - 1.0 + b / a) / (r * r), (a / b - 1.0 - r) / (r * r)]
}

/// Extrapolates ρh to the face downstream of a cell, within half and twice its own. Returns its derivatives by
/// ρh of the cell upstream and of the cell, too.
#[inline]
fn extrapolated(upstream: f64, here: f64) -> [f64; 3] {
    let free = 1.5 * here - 0.5 * upstream;
    if free < 0.5 * here {
        [0.5 * here, 0.0, 0.5]
    } else if free > 2.0 * here {
        [2.0 * here, 0.0, 2.0]
    } else {
        [free, -0.5, 1.5]
    }
}

impl Balance {
    fn add(&mut self, sign: f64, face: &Face, cells: [usize; 3], cavity: usize) {
        self.residual += sign * face.flow;
        for (n, cell) in cells.into_iter().enumerate() {
            self.by_pressure[cell] += sign * face.by_pressure[n];
            self.by_film[cell] += sign * face.by_film[n];
        }
        self.by_cavity[cavity] += sign * face.by_cavity;
    }
}

impl Flow<'_> {
    /// Returns the oil in each cell, ρh(1 − θ)/ρ₀.
    pub(super) fn stored(&self, p: &[f64], cavity: &[f64], h: &[f64]) -> Vec<f64> {
        let full = cavity.iter().map(|cavity| 1.0 - cavity);
        self.held(p, h).iter().zip(full).map(|(held, full)| held.density * held.film * full).collect()
    }

    /// Returns the balance of each cell.
    pub(super) fn balances(&self, p: &[f64], cavity: &[f64], h: &[f64]) -> Vec<Balance> {
        let [nx, ny] = self.grid.shape;
        let [dx, dy] = self.grid.pitch;
        let held = self.held(p, h);
        let mut balances = vec![Balance::default(); nx * ny];
        let along = dy / dx;
        for j in 0..ny {
            let mut inlet = to_end(&held[j], p[j], self.ends[0], 2.0 * along);
            let next = if nx > 1 { j + ny } else { j };
            let entering = self.speed * dy * self.oil.under(self.ends[0]).density;
            let [film, by_next, by_film] = extrapolated(held[next].film, held[j].film);
            inlet.flow -= entering * film;
            inlet.by_film[1] -= entering * by_film * held[j].film_by_h;
            inlet.by_film[0] -= entering * by_next * held[next].film_by_h;
            balances[j].add(1.0, &inlet, [DOWNSTREAM, HERE, HERE], HERE);
        }
        for k in 0..nx * ny {
            let mut face = if k + ny < nx * ny {
                between(&held[k], &held[k + ny], [p[k], p[k + ny]], along)
            } else {
                to_end(&held[k], p[k], self.ends[1], 2.0 * along)
            };
            let upstream = k.checked_sub(ny);
            self.entrain(&mut face, upstream.map(|k| &held[k]), &held[k], cavity[k]);
            balances[k].add(1.0, &face, [UPSTREAM, HERE, DOWNSTREAM], 0);
            if k + ny < nx * ny {
                balances[k + ny].add(-1.0, &face, [SECOND_UPSTREAM, UPSTREAM, HERE], 1);
            }
        }
        let across = dx / dy;
        for k in 0..nx * ny {
            let j = k % ny;
            if !self.repeats {
                for _ in [j == 0, j + 1 == ny].into_iter().filter(|is_end| *is_end) {
                    balances[k].add(1.0, &to_end(&held[k], p[k], 0.0, 2.0 * across), [HERE; 3], HERE);
                }
            }
            let after = if j + 1 < ny { k + 1 } else { k + 1 - ny };
            if after == k || (after < k && !self.repeats) {
                continue;
            }
            let face = between(&held[k], &held[after], [p[k], p[after]], across);
            balances[k].add(1.0, &face, [HERE, HERE, AFTER], HERE);
            balances[after].add(-1.0, &face, [HERE, BEFORE, HERE], HERE);
        }
        if let Some(step) = &self.step {
            let rate = dx * dy / step.duration;
            for (k, balance) in balances.iter_mut().enumerate() {
                let (held, full) = (&held[k], 1.0 - cavity[k]);
                balance.residual += rate * (held.density * held.film * full - step.before[k]);
                balance.by_pressure[HERE] += rate * held.density_rise * held.film * full;
                balance.by_film[HERE] += rate * held.density * held.film_by_h * full;
                balance.by_cavity[0] -= rate * held.density * held.film;
            }
        }
        balances
    }

    /// Adds what the surfaces carry out of a cell.
    #[inline]
    fn entrain(&self, face: &mut Face, upstream: Option<&Held>, here: &Held, cavity: f64) {
        let carries = self.speed * self.grid.pitch[1];
        let full = carries * (1.0 - cavity);
        let oil = |held: &Held| held.density * held.film;
        let [carried, mut by_upstream, mut by_here] =
            extrapolated(upstream.map_or(oil(here), oil), oil(here));
        if let Some(upstream) = upstream {
            face.by_pressure[0] += full * by_upstream * upstream.density_rise * upstream.film;
            face.by_film[0] += full * by_upstream * upstream.density * upstream.film_by_h;
        } else {
            by_here += std::mem::take(&mut by_upstream);
        }
        face.flow += full * carried;
        face.by_pressure[1] += full * by_here * here.density_rise * here.film;
        face.by_film[1] += full * by_here * here.density * here.film_by_h;
        face.by_cavity = -carries * carried;
    }

    /// Returns the share of the flow through each face across x that the surfaces entrain, as a film of the
    /// density there, m; face `i` lies upstream of column `i`.
    pub(super) fn entrained_films(&self, p: &[f64], cavity: &[f64], h: &[f64]) -> Vec<f64> {
        let [nx, ny] = self.grid.shape;
        let held = self.held(p, h);
        let oil = |k: usize| held[k].density * held[k].film;
        let inlet = |j: usize| extrapolated(held[if nx > 1 { j + ny } else { j }].film, held[j].film)[0];
        let within = |k: usize| {
            extrapolated(oil(k.checked_sub(ny).unwrap_or(k)), oil(k))[0] / held[k].density * (1.0 - cavity[k])
        };
        (0..ny).map(inlet).chain((0..nx * ny).map(within)).collect()
    }

    fn held(&self, p: &[f64], h: &[f64]) -> Vec<Held> {
        let mut all = vec![Held::default(); p.len()];
        let parts = all.chunks_mut(4096).zip(p.chunks(4096)).zip(h.chunks(4096));
        parallel::map(parts, |((all, p), h)| {
            for ((held, p), h) in all.iter_mut().zip(p).zip(h) {
                *held = self.held_under(*p, *h);
            }
        });
        all
    }

    #[inline]
    fn held_under(&self, p: f64, h: f64) -> Held {
        let oil = self.oil.under(p);
        let [film, film_by_h] = seen(h, self.boundary_film);
        let mobility = oil.density * film * film * film / (12.0 * oil.viscosity);
        Held {
            film,
            film_by_h,
            density: oil.density,
            density_rise: oil.density_rise,
            mobility,
            mobility_by_p: mobility * (oil.density_rise / oil.density - oil.viscosity_rise),
            mobility_by_h: 3.0 * mobility / film * film_by_h,
        }
    }
}

/// Returns the flow that a gradient of the pressure drives from a cell to the next; `across` is the width of
/// the face over the distance of the cells.
#[inline]
fn between(one: &Held, other: &Held, [p, q]: [f64; 2], across: f64) -> Face {
    let [mobility, by_one, by_other] = log_mean(one.mobility, other.mobility);
    let fall = (p - q) * across;
    Face {
        flow: mobility * fall,
        by_pressure: [
            0.0,
            mobility * across + by_one * one.mobility_by_p * fall,
            by_other * other.mobility_by_p * fall - mobility * across,
        ],
        by_film: [0.0, by_one * one.mobility_by_h * fall, by_other * other.mobility_by_h * fall],
        by_cavity: 0.0,
    }
}

/// Returns the flow from a cell to a pressure at its end.
#[inline]
fn to_end(held: &Held, p: f64, end: f64, across: f64) -> Face {
    let fall = (p - end) * across;
    Face {
        flow: held.mobility * fall,
        by_pressure: [0.0, held.mobility * across + held.mobility_by_p * fall, 0.0],
        by_film: [0.0, held.mobility_by_h * fall, 0.0],
        by_cavity: 0.0,
    }
}
