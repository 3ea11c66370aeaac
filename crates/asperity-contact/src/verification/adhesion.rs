//! Bodies that attract each other.

use std::f64::consts::{FRAC_1_PI, PI};

use super::{Case, Check, Expected, relative, study};
use crate::adhesion::{Adhesion, Potential};
use crate::error::Result;
use crate::grid::{CellValues, Field, Grid};
use crate::operator::{FreeFft, PeriodicFft};
use crate::reference::{AdhesiveWave, JkrSphere, MaugisSphere};
use crate::solver::{Bounds, Control, Params, Solution, solve_adhesive, solve_normal};
use crate::surface::Form;
use crate::units::{Joule, JoulePerSquareMetre, Metre};

const ELASTIC: CellValues = CellValues::Uniform(f64::INFINITY);
/// Modulus, radius and work of adhesion for which loads are in πwR, and lengths in the units of Maugis.
const MODULUS: f64 = 0.75;
const RADIUS: Metre = 1.0;
const WORK: JoulePerSquareMetre = FRAC_1_PI;

const JKR: JkrSphere = JkrSphere { radius: RADIUS, modulus: MODULUS, work: WORK };

/// The range of the attraction is the shortest one that the grid resolves. It falls as √Δx, and with it the
/// deviation from JKR.
pub(super) const JKR_LIMIT: Case = Case {
    name: "JKR: sphere, range of the grid",
    source: "Johnson, Kendall & Roberts (1971)",
    checks: jkr_limit,
};

fn jkr_limit() -> Result<Vec<Check>> {
    let half = |finest| Expected::Order { order: 0.4..=0.7, finest };
    let checks = [("pull-off force", half(7e-2)), ("load at approach 0", half(6e-2))];
    study("width/Δx", &[24, 48, 96], checks, |n| {
        let mut sphere = Sphere::new(n, 4.8)?;
        let range = Adhesion::grid_range(WORK, MODULUS, sphere.grid.pitch[0]);
        let adhesion = Adhesion::new(WORK, range)?;
        let pressed = sphere.at(&adhesion, Control::Approach(0.2), None)?;
        let level = sphere.at(&adhesion, Control::Approach(0.0), Some(&pressed))?;
        let at_level = level.load();
        let (mut loads, mut last) = (vec![at_level], level);
        for step in 1..=7 {
            last = sphere.at(&adhesion, Control::Approach(-0.1 * f64::from(step)), Some(&last))?;
            loads.push(last.load());
        }
        let a = (2.0 * PI * WORK * RADIUS * RADIUS / MODULUS).cbrt(); // δ = 0
        Ok([relative(least(&loads), JKR.pull_off()), relative(at_level, JKR.load(a))])
    })
}

/// Returns the minimum of the parabola through the least of equidistant values and its neighbours; the value
/// itself at an end.
fn least(values: &[f64]) -> f64 {
    let smallest = |best: usize, n: usize| if values[n] < values[best] { n } else { best };
    let n = (0..values.len()).fold(0, smallest);
    if n == 0 || n + 1 == values.len() {
        return values[n];
    }
    let [before, here, after] = [values[n - 1], values[n], values[n + 1]];
    let [slope, bend] = [0.5 * (after - before), after - 2.0 * here + before];
    here - 0.5 * slope * slope / bend
}

/// The constant tension ends at a line of cells, so that the load follows in steps, and the order scatters.
pub(super) const MAUGIS_LONG: Case = Case {
    name: "Maugis: sphere, λ = 0.3",
    source: "Maugis (1992)",
    checks: || maugis(0.3, 7.0, Expected::Order { order: 0.3..=2.0, finest: 1.2e-2 }),
};
pub(super) const MAUGIS_SHORT: Case = Case {
    name: "Maugis: sphere, λ = 1",
    source: "Maugis (1992)",
    checks: || maugis(1.0, 4.8, Expected::Order { order: 1.0..=2.0, finest: 4e-2 }),
};

/// Draws the sphere apart in steps of a tenth of Maugis' unit.
fn maugis(lambda: f64, width: Metre, expected: Expected) -> Result<Vec<Check>> {
    let exact = MaugisSphere::from_lambda(RADIUS, MODULUS, WORK, lambda);
    let adhesion = Adhesion::new(WORK, WORK / exact.tension)?.with_potential(Potential::Dugdale);
    study("width/Δx", &[48, 96], [("pull-off force", expected)], |n| {
        let mut sphere = Sphere::new(n, width)?;
        let mut last = sphere.at(&adhesion, Control::Approach(0.2), None)?;
        let mut least = last.load();
        for step in 1..=14 {
            let approach = Control::Approach(0.2 - 0.1 * f64::from(step));
            last = sphere.at(&adhesion, approach, Some(&last))?;
            least = least.min(last.load());
        }
        Ok([relative(least, exact.pull_off())])
    })
}

/// The finer the grid, the shorter the range. The mean pressure is compared at the half width of contact,
/// which is known to half a cell.
pub(super) const WAVE: Case =
    Case { name: "Johnson: adhesive wave, α = 0.3", source: "Johnson (1995)", checks: wave };

fn wave() -> Result<Vec<Check>> {
    let wave = AdhesiveWave::from_alpha(0.01, 1.0, 1.0, 0.3);
    let checks = [("mean pressure", Expected::Order { order: 1.0..=1.8, finest: 1.2e-2 })];
    study("amplitude/range", &[5, 10, 20], checks, |n| {
        let cells = 128 * (n / 5) * (n / 5);
        let grid = Grid::new([cells, 1], [wave.wavelength / cells as f64, wave.wavelength])?;
        let form = Form::Sinusoid { amplitude: wave.amplitude, wavelength: [wave.wavelength, f64::INFINITY] };
        let gap = -form.on(&grid)?.into_heights();
        let adhesion = Adhesion::new(wave.work, wave.amplitude / n as f64)?;
        let mut operator = PeriodicFft::new(grid, wave.modulus);
        let (mut last, mut sum, mut count) = (None, 0.0, 0.0);
        // From near full contact apart.
        for step in 0..16 {
            let approach = Control::Approach(wave.amplitude * (0.97 - 0.1 * f64::from(step)));
            let solution = solve_adhesive(
                &mut operator,
                &gap,
                &adhesion,
                &ELASTIC,
                approach,
                last.as_ref(),
                &Params::new(),
            )?;
            let half_width = 0.5 * grid.pitch[0] * solution.contact_cells() as f64;
            if (0.1..0.4).contains(&half_width) {
                let mean_pressure = solution.load() / grid.area();
                sum += (mean_pressure - wave.mean_pressure(half_width)) / wave.full_contact_pressure();
                count += 1.0;
            }
            if half_width < 0.1 {
                break;
            }
            last = Some(solution);
        }
        Ok([sum / count])
    })
}

/// Along a path without jumps, the energy grows by the work of the load, by the trapezoidal rule.
pub(super) const ENERGY: Case =
    Case { name: "adhesive sphere: work of the load", source: "dU = W dδ", checks: energy };

fn energy() -> Result<Vec<Check>> {
    let checks = [("energy stored", Expected::Order { order: 1.8..=2.4, finest: 3e-4 })];
    let mut sphere = Sphere::new(32, 4.8)?;
    let adhesion = Adhesion::new(WORK, WORK / 0.75)?;
    study("steps", &[4, 8, 16], checks, |steps| {
        let approach = |step: usize| Control::Approach(-0.3 + 0.8 * step as f64 / steps as f64);
        let mut last = sphere.at(&adhesion, approach(0), None)?;
        let mut work = 0.0;
        let first = stored(&adhesion, &last);
        for step in 1..=steps {
            let next = sphere.at(&adhesion, approach(step), Some(&last))?;
            work += 0.5 * (next.load() + last.load()) * (next.approach - last.approach);
            last = next;
        }
        Ok([relative(stored(&adhesion, &last) - first, work)])
    })
}

/// Elastic energy and energy of the attraction.
fn stored(adhesion: &Adhesion, solution: &Solution) -> Joule {
    let attraction: f64 = solution.gap().iter().map(|gap| adhesion.energy(*gap)).sum();
    solution.elastic_energy() + solution.grid.cell_area() * attraction
}

/// The load of bodies held by their approach falls in proportion to a small work of adhesion.
pub(super) const NO_WORK: Case =
    Case { name: "adhesive sphere: w → 0", source: "contact without adhesion", checks: no_work };

fn no_work() -> Result<Vec<Check>> {
    let mut sphere = Sphere::new(32, 4.8)?;
    let approach = Control::Approach(1.0);
    let plain = solve_normal(&mut sphere.operator, &sphere.gap, &Bounds::ELASTIC, approach, None, &PRECISE)?;
    let checks = [("load", Expected::Order { order: 0.95..=1.05, finest: 2e-4 })];
    study("1/w", &[100, 1000, 10_000], checks, |n| {
        let adhesion = Adhesion::new(WORK / n as f64, 0.4)?;
        Ok([relative(sphere.at(&adhesion, approach, None)?.load(), plain.load())])
    })
}

const PRECISE: Params = Params::new().with_tolerance(1e-8);

/// A sphere on a square grid.
struct Sphere {
    grid: Grid,
    gap: Field,
    operator: FreeFft,
}

impl Sphere {
    fn new(cells: usize, width: Metre) -> Result<Self> {
        let grid = Grid::new([cells; 2], [width / cells as f64; 2])?;
        let at = |index| grid.centre(0, index) - 0.5 * width;
        let gap = Field::from_shape_fn(grid.shape, |(i, j)| 0.5 * (at(i).powi(2) + at(j).powi(2)) / RADIUS);
        Ok(Self { grid, gap, operator: FreeFft::new(grid, MODULUS) })
    }

    fn at(&mut self, adhesion: &Adhesion, control: Control, last: Option<&Solution>) -> Result<Solution> {
        solve_adhesive(&mut self.operator, &self.gap, adhesion, &ELASTIC, control, last, &PRECISE)
    }
}
