//! Relaxation moduli from a measured master curve.

use std::f64::consts::TAU;

use crate::error::{Error, Result, check, check_in};
use crate::units::{Dimension, Pascal};
use crate::viscoelastic::series::{Relaxation, RelaxationTerm};

/// Decades by which the times of a fit go beyond the frequencies of the data.
const BEYOND: f64 = 1.0;
/// Most times of a fit.
const MAX_TERMS: f64 = 200.0;

/// A point of a master curve: storage and loss modulus of a body under tension at a frequency, reduced to one
/// temperature.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct MasterPoint {
    /// Frequency, Hz.
    pub frequency: f64,
    /// Storage modulus E′.
    pub storage: Pascal,
    /// Loss modulus E″.
    pub loss: Pascal,
}

/// A fit of a master curve.
#[derive(Debug, Clone, PartialEq)]
pub struct MasterFit {
    /// The fitted modulus.
    pub relaxation: Relaxation,
    /// Largest relative errors of E′ and of E″.
    pub errors: [f64; 2],
}

/// Fits a body with this `relaxed` modulus to a master curve: moduli ≥ 0 at `per_decade` times a decade, by
/// least squares of the relative errors of E′ and E″ (Lawson and Hanson, Solving Least Squares Problems,
/// 1974). The times reach a decade beyond the data.
///
/// # Errors
/// [`Error::OutOfRange`] for a frequency or a modulus that is not finite and > 0, a `relaxed` modulus above
/// the least E′, and a number of times a decade that is not > 0 or gives more than 200 times;
/// [`Error::Unsupported`] for fewer than three points, or frequencies that do not rise.
pub fn fit_master_curve(points: &[MasterPoint], relaxed: Pascal, per_decade: f64) -> Result<MasterFit> {
    if points.len() < 3 {
        return Err(Error::Unsupported("a master curve of fewer than three points"));
    }
    let is_valid = |value: f64| value > 0.0 && value.is_finite();
    for point in points {
        const EXPECTED: &str = "a finite value above 0";
        check("frequency", point.frequency, is_valid(point.frequency), EXPECTED)?;
        let modulus = |name, value| check_in(Dimension::Pressure, name, value, is_valid(value), EXPECTED);
        modulus("storage modulus", point.storage)?;
        modulus("loss modulus", point.loss)?;
    }
    if points.windows(2).any(|pair| pair[1].frequency <= pair[0].frequency) {
        return Err(Error::Unsupported("a master curve whose frequencies do not rise"));
    }
    let least = points.iter().map(|point| point.storage).fold(f64::INFINITY, f64::min);
    let is_below = relaxed > 0.0 && relaxed <= least;
    check_in(
        Dimension::Pressure,
        "young",
        relaxed,
        is_below,
        "at most the least storage modulus of the master curve",
    )?;
    let [slow, fast] = [points[0].frequency, points[points.len() - 1].frequency].map(|f| -(TAU * f).log10());
    let (first, last) = (fast - BEYOND, slow + BEYOND);
    let intervals = ((last - first) * per_decade).round();
    let is_few = (1.0..=MAX_TERMS).contains(&intervals);
    check("terms_per_decade", per_decade, is_few, "a number above 0 that gives at most 200 times")?;
    let count = intervals as usize + 1;
    let times: Vec<f64> =
        (0..count).map(|n| 10f64.powf(first + (last - first) * n as f64 / intervals)).collect();
    // Rows of E′ and of E″, each divided by the measured value.
    let rows = |of: fn(&MasterPoint) -> f64, part: fn(f64) -> f64| {
        let row = |point: &MasterPoint| {
            let times = times.iter().map(|time| part(TAU * point.frequency * time) / of(point));
            times.collect::<Vec<f64>>()
        };
        points.iter().map(row).collect::<Vec<_>>()
    };
    let storage = rows(|point| point.storage, |z| z * z / (1.0 + z * z));
    let loss = rows(|point| point.loss, |z| z / (1.0 + z * z));
    let wanted: Vec<f64> =
        points.iter().map(|point| 1.0 - relaxed / point.storage).chain(points.iter().map(|_| 1.0)).collect();
    let matrix: Vec<Vec<f64>> = storage.into_iter().chain(loss).collect();
    let moduli = non_negative(&matrix, &wanted);
    let terms = moduli.iter().zip(&times).filter(|(modulus, _)| **modulus > 0.0);
    let terms = terms.map(|(modulus, time)| RelaxationTerm { modulus: *modulus, time: *time });
    let relaxation = Relaxation::new(relaxed, terms.collect::<Vec<_>>())?;
    let error = |part: fn(&MasterPoint, (f64, f64)) -> f64| {
        let of = |point: &MasterPoint| {
            let modulus = relaxation.complex(TAU * point.frequency);
            part(point, (modulus.re, modulus.im)).abs()
        };
        points.iter().map(of).fold(0.0, f64::max)
    };
    let errors =
        [error(|point, (re, _)| re / point.storage - 1.0), error(|point, (_, im)| im / point.loss - 1.0)];
    Ok(MasterFit { relaxation, errors })
}

/// Returns the x ≥ 0 with the least |A x − b|, by the active set of Lawson and Hanson.
fn non_negative(a: &[Vec<f64>], b: &[f64]) -> Vec<f64> {
    let count = a[0].len();
    let mut x = vec![0.0; count];
    let mut passive: Vec<usize> = Vec::new();
    for _ in 0..10 * count {
        let residual: Vec<f64> =
            a.iter().zip(b).map(|(row, b)| b - row.iter().zip(&x).map(|(a, x)| a * x).sum::<f64>()).collect();
        let gradient = |j: usize| a.iter().zip(&residual).map(|(row, r)| row[j] * r).sum::<f64>();
        let candidates = (0..count).filter(|j| !passive.contains(j)).map(|j| (j, gradient(j)));
        let Some((next, steepest)) = candidates.max_by(|one, other| one.1.total_cmp(&other.1)) else { break };
        if steepest <= 1e-13 {
            break;
        }
        passive.push(next);
        loop {
            let trial = least_squares(a, b, &passive);
            let shares = passive.iter().zip(&trial).filter(|(_, t)| **t <= 0.0);
            let share = shares.map(|(j, t)| x[*j] / (x[*j] - t)).fold(1.0, f64::min);
            for (j, t) in passive.iter().zip(&trial) {
                x[*j] += share * (t - x[*j]);
            }
            if share >= 1.0 {
                break;
            }
            let largest = x.iter().copied().fold(0.0, f64::max);
            passive.retain(|j| x[*j] > 1e-15 * largest);
            (0..count).filter(|j| !passive.contains(j)).for_each(|j| x[j] = 0.0);
        }
    }
    x
}

/// Returns the least squares solution with these columns of A, by Householder reflections.
fn least_squares(a: &[Vec<f64>], b: &[f64], columns: &[usize]) -> Vec<f64> {
    let mut q: Vec<Vec<f64>> = columns.iter().map(|j| a.iter().map(|row| row[*j]).collect()).collect();
    let mut right = b.to_vec();
    let size = columns.len();
    for k in 0..size {
        let norm = q[k][k..].iter().map(|v| v * v).sum::<f64>().sqrt();
        let alpha = if q[k][k] > 0.0 { -norm } else { norm };
        let mut v = q[k][k..].to_vec();
        v[0] -= alpha;
        let length = v.iter().map(|v| v * v).sum::<f64>();
        if length == 0.0 {
            continue;
        }
        let reflect = |column: &mut [f64]| {
            let along = 2.0 * v.iter().zip(column.iter()).map(|(v, c)| v * c).sum::<f64>() / length;
            column.iter_mut().zip(&v).for_each(|(c, v)| *c -= along * v);
        };
        q[k..].iter_mut().for_each(|column| reflect(&mut column[k..]));
        reflect(&mut right[k..]);
    }
    let mut x = vec![0.0; size];
    for k in (0..size).rev() {
        let known: f64 = (k + 1..size).map(|j| q[j][k] * x[j]).sum();
        x[k] = if q[k][k] == 0.0 { 0.0 } else { (right[k] - known) / q[k][k] };
    }
    x
}

#[cfg(test)]
mod tests {
    use super::*;

    fn curve(of: impl Fn(f64) -> [f64; 2], from: f64, to: f64, count: usize) -> Vec<MasterPoint> {
        let frequency = |n: usize| 10f64.powf(from + (to - from) * n as f64 / (count - 1) as f64);
        let point = |n| {
            let [storage, loss] = of(frequency(n));
            MasterPoint { frequency: frequency(n), storage, loss }
        };
        (0..count).map(point).collect()
    }

    /// A fractional Zener body, whose loss is broad: E₀ + (E_g − E₀) z/(1 + z), z = (iωt)^α.
    fn fractional(alpha: f64) -> Vec<MasterPoint> {
        let of = |frequency: f64| {
            let (size, angle) = ((TAU * frequency * 1e-5).powf(alpha), alpha * std::f64::consts::FRAC_PI_2);
            let z = asperity_transforms::num_complex::Complex64::from_polar(size, angle);
            let modulus = 3e6 + (1.5e9 - 3e6) * z / (1.0 + z);
            [modulus.re, modulus.im]
        };
        curve(of, -2.0, 10.0, 121)
    }

    #[test]
    fn two_times_a_decade_describe_a_broad_loss_within_a_per_cent() {
        for (alpha, per_decade, most) in [(0.6, 1.0, 0.2), (0.6, 2.0, 0.01), (0.35, 2.0, 0.01)] {
            let fit = fit_master_curve(&fractional(alpha), 3e6, per_decade).unwrap();
            assert!(fit.errors.iter().all(|error| *error < most), "{alpha} {per_decade}: {:?}", fit.errors);
        }
    }

    #[test]
    fn three_sharp_times_are_found_within_a_few_per_cent() {
        let body = Relaxation::new(
            1e6,
            [(2e6, 1.0), (5e6, 0.1), (3e7, 3e-3)].map(|(modulus, time)| RelaxationTerm { modulus, time }),
        )
        .unwrap();
        let of = |frequency: f64| {
            let modulus = body.complex(TAU * frequency);
            [modulus.re, modulus.im]
        };
        let fit = fit_master_curve(&curve(of, -2.0, 4.0, 61), 1e6, 3.0).unwrap();
        assert!(fit.errors.iter().all(|error| *error < 0.06), "{:?}", fit.errors);
    }

    #[test]
    fn nonsense_is_refused() {
        let good = fractional(0.6);
        let refused = |points: &[MasterPoint], relaxed, per_decade| {
            fit_master_curve(points, relaxed, per_decade).unwrap_err().to_string()
        };
        assert!(refused(&good[..2], 3e6, 1.0).contains("fewer than three points"));
        let mut falling = good.clone();
        falling.swap(3, 4);
        assert!(refused(&falling, 3e6, 1.0).contains("do not rise"));
        let mut negative = good.clone();
        negative[5].loss = -1.0;
        assert!(refused(&negative, 3e6, 1.0).contains("loss modulus"));
        assert!(refused(&good, 1e9, 1.0).contains("young"));
        assert!(refused(&good, 3e6, 0.0).contains("terms_per_decade"));
    }
}
