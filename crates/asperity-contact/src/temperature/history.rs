//! Temperature of a body from the heat of earlier steps.

use std::f64::consts::{PI, TAU};

use ndarray::linalg::general_mat_mul;
use ndarray::{Array2, s};

use crate::grid::Grid;
use crate::operator::Boundary;
use crate::temperature::Thermal;
use crate::temperature::memory::exponentials;
use crate::units::{Kelvin, Metre, Second, WattPerSquareMetre};

/// Temperature of a body from the heat of all steps except the present one, as waves:
///
/// ```text
/// T̂(t) = ∫ q̂(t − τ) e^(−Dq²τ)/(β√(πτ)) dτ,  τ ≥ Δt
/// ```
///
/// with 1/√(πτ) as a sum of exponentials. Each exponential needs one number per wave from one step to the
/// next. Waves with D q² Δt > 12 decay within a step and are omitted. Along a free edge the waves have a
/// period longer than the body by 5 √(D t), with the time t of all steps. At this distance the temperature of
/// a source is reduced to erfc(2.5) = 4e-4.
///
/// Single precision is used; its error is far below that of the exponentials.
pub(super) struct History {
    width: usize,
    /// Waves along x and along y.
    axes: [Waves; 2],
    /// e^(−Dq²Δt) of each wave.
    decay: Vec<f32>,
    terms: Vec<Term>,
    /// Waves of the flux in the last step.
    flux: Array2<f32>,
    /// Waves of the flux in the step before it; scratch memory of the next.
    before: Array2<f32>,
    /// Waves of the temperature.
    temperature: Array2<f32>,
    /// Rows of waves along y.
    rows: Array2<f32>,
    /// Whether there has been any heat.
    warm: bool,
}

/// One exponential.
struct Term {
    /// e^(−s).
    decay: f32,
    /// Contributions of the flux at the end and at the beginning of the last step to the state.
    gains: [Vec<f32>; 2],
    /// Temperature from this exponential.
    state: Vec<f32>,
}

/// Waves along an axis: cos 0, then cos and sin of each wavenumber.
struct Waves {
    /// Angular wavenumber, 1/m.
    numbers: Vec<f64>,
    /// Mean square over the period, and the effect of sampling by cells on the wave.
    weights: Vec<f64>,
    /// Their values `[cell, wave]`.
    values: Array2<f32>,
    period: Metre,
}

impl History {
    /// Creates a body on `grid` over `steps` steps of equal time.
    pub(super) fn new(
        grid: &Grid,
        thermal: &Thermal,
        boundary: Boundary,
        steps: usize,
        step: Second,
    ) -> Self {
        let spread = thermal.diffusivity() * step;
        let axes = [0, 1].map(|axis| {
            let reach = 5.0 * (spread * steps as f64).sqrt();
            Waves::new(grid, axis, boundary, (!boundary.repeats(axis)).then_some(reach), spread)
        });
        let shape = [axes[0].numbers.len(), axes[1].numbers.len()];
        let exponents = Array2::from_shape_fn(shape, |(i, j)| {
            spread * (axes[0].numbers[i].powi(2) + axes[1].numbers[j].powi(2))
        });
        let unit = step.sqrt() / thermal.effusivity() * grid.cell_area() / (axes[0].period * axes[1].period);
        let weight = Array2::from_shape_fn(shape, |(i, j)| unit * axes[0].weights[i] * axes[1].weights[j]);
        let term = |(s, w): (f64, f64)| {
            // Moments of an exponential with the rate r = Dq² + s over a step: ∫ e^(−rt) dt and ∫ t e^(−rt)
            // dt.
            let moments = |exponent: f64| {
                let r = exponent + s;
                let whole = -(-r).exp_m1() / r;
                [whole, (whole - (-r).exp()) / r]
            };
            let gain = |of: fn([f64; 2]) -> f64| {
                exponents.iter().zip(&weight).map(|(a, unit)| (w * unit * of(moments(*a))) as f32).collect()
            };
            Term {
                decay: (-s).exp() as f32,
                gains: [gain(|[whole, first]| whole - first), gain(|[_, first]| first)],
                state: vec![0.0; exponents.len()],
            }
        };
        Self {
            width: grid.shape[1],
            decay: exponents.iter().map(|a| (-a).exp() as f32).collect(),
            terms: exponentials(steps as f64 + 1.0).into_iter().map(term).collect(),
            flux: Array2::zeros(shape),
            before: Array2::zeros(shape),
            temperature: Array2::zeros(shape),
            rows: Array2::zeros([grid.shape[0], shape[1]]),
            warm: false,
            axes,
        }
    }

    /// Resets the history: removes all heat.
    pub(super) fn reset(&mut self) {
        self.terms.iter_mut().for_each(|term| term.state.fill(0.0));
        self.flux.fill(0.0);
        self.before.fill(0.0);
        self.temperature.fill(0.0);
        self.warm = false;
    }

    /// Adds to `sum` the temperature at the flat `cells`.
    pub(super) fn add_temperature(&mut self, cells: &[u32], sum: &mut [Kelvin]) {
        let Some((first, last)) = self.span(cells).filter(|_| self.warm) else { return };
        let [x, y] = &self.axes;
        let mut rows = self.rows.slice_mut(s![first..=last, ..]);
        general_mat_mul(1.0, &x.values.slice(s![first..=last, ..]), &self.temperature, 0.0, &mut rows);
        for (&cell, sum) in cells.iter().zip(sum) {
            let (ix, iy) = (cell as usize / self.width, cell as usize % self.width);
            *sum += f64::from(self.rows.row(ix).dot(&y.values.row(iy)));
        }
    }

    /// Advances by a step, at whose end the flat `cells` receive a `flux`, and all others none.
    pub(super) fn advance(&mut self, cells: &[u32], flux: &[WattPerSquareMetre]) {
        if cells.is_empty() && !self.warm {
            return;
        }
        std::mem::swap(&mut self.flux, &mut self.before);
        match self.span(cells) {
            Some((first, last)) => {
                let [x, y] = &self.axes;
                self.rows.slice_mut(s![first..=last, ..]).fill(0.0);
                for (&cell, &q) in cells.iter().zip(flux) {
                    let (ix, iy) = (cell as usize / self.width, cell as usize % self.width);
                    self.rows.row_mut(ix).scaled_add(q as f32, &y.values.row(iy));
                }
                let (waves, rows) =
                    (x.values.slice(s![first..=last, ..]), self.rows.slice(s![first..=last, ..]));
                general_mat_mul(1.0, &waves.t(), &rows, 0.0, &mut self.flux);
                self.warm = true;
            }
            None => self.flux.fill(0.0),
        }
        let sum = self.temperature.as_slice_mut().expect("standard layout");
        sum.fill(0.0);
        let [now, before] = [&self.flux, &self.before].map(|flux| flux.as_slice().expect("standard layout"));
        for Term { decay, gains, state } in &mut self.terms {
            let gained = gains[0].iter().zip(&gains[1]).zip(now.iter().zip(before));
            let waves = state.iter_mut().zip(sum.iter_mut()).zip(&self.decay).zip(gained);
            for (((state, sum), fading), ((new, old), (now, before))) in waves {
                let value = *decay * fading * (*state + new * now + old * before);
                *state = if value.abs() < NOTHING { 0.0 } else { value };
                *sum += *state;
            }
        }
    }

    /// Returns the first and the last row of the flat `cells`.
    fn span(&self, cells: &[u32]) -> Option<(usize, usize)> {
        let rows = || cells.iter().map(|cell| *cell as usize / self.width);
        rows().min().zip(rows().max())
    }
}

/// Smaller temperatures are set to zero, before they become denormal numbers, which are slow.
const NOTHING: f32 = 1e-25;
/// Waves with a larger D q² Δt are omitted.
const FADED: f64 = 12.0;

impl Waves {
    /// Creates the waves along an `axis` of `grid` that remain after a step with `spread` DΔt. Their period
    /// is that of the grid, or longer by a `reach`.
    fn new(grid: &Grid, axis: usize, boundary: Boundary, reach: Option<Metre>, spread: f64) -> Self {
        let (cells, pitch) = (grid.shape[axis], grid.pitch[axis]);
        let period = grid.extent()[axis] + reach.unwrap_or(0.0);
        let largest = (PI / pitch).min((FADED / spread).sqrt());
        let mut waves = vec![(0.0, 1.0, false)];
        for k in 1.. {
            let number = TAU * k as f64 / period;
            let nyquist = reach.is_none() && 2 * k == cells;
            if number > largest && !(nyquist && number <= largest * (1.0 + 1e-12)) {
                break;
            }
            if nyquist {
                waves.push((number, 1.0, false));
                break;
            }
            waves.extend([(number, 2.0, false), (number, 2.0, true)]);
        }
        let sampled = |number: f64| {
            if boundary == Boundary::FREE { even(number * pitch, spread / pitch.powi(2)) } else { 1.0 }
        };
        let values = Array2::from_shape_fn([cells, waves.len()], |(i, k)| {
            let (number, _, odd) = waves[k];
            let phase = number * pitch * i as f64;
            (if odd { phase.sin() } else { phase.cos() }) as f32
        });
        Self {
            numbers: waves.iter().map(|wave| wave.0).collect(),
            weights: waves.iter().map(|wave| wave.1 * sampled(wave.0)).collect(),
            values,
            period,
        }
    }
}

/// Response of the wave with `phase` φ = qΔx to a flux uniform over cells, sampled at their centres after a
/// step with `spread` DΔt/Δx². It is Σ sin(½φₙ)/½φₙ e^(−spread (φₙ² − φ²)) over all φₙ = φ + 2πn, which are
/// equal at the centres.
fn even(phase: f64, spread: f64) -> f64 {
    let alias = |n: i32| {
        let own = phase + TAU * f64::from(n);
        let share = if own == 0.0 { 1.0 } else { (0.5 * own).sin() / (0.5 * own) };
        share * (-spread * (own * own - phase * phase)).exp()
    };
    let last = 50;
    // The mean of two partial sums: without decay the signs alternate.
    let without: f64 = (1 - last..last).map(alias).sum();
    without + 0.5 * (alias(last) + alias(-last))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_even_where_heat_spreads_and_points_where_it_does_not() {
        for phase in [0.0, 0.3, 1.0, 3.0] {
            let half: f64 = 0.5 * phase;
            let sinc = if half == 0.0 { 1.0 } else { half.sin() / half };
            assert!((even(phase, 10.0) - sinc).abs() < 1e-6, "{phase}");
            assert!((even(phase, 0.0) - 1.0).abs() < 1e-2, "{phase}: {}", even(phase, 0.0));
        }
    }
}
