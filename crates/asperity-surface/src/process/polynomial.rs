//! Least-squares polynomials in x and y.

use super::normal_equations::NormalEquations;
use asperity_base::grid::Field;

/// Products of Legendre polynomials P_a(ξ) P_b(η), a + b ≤ order. ξ and η range from −1 to 1 over the part of
/// the field with defined samples. There the products are nearly orthogonal, so that high orders lose no
/// digits.
pub(super) struct Polynomial {
    order: usize,
    /// First row of the defined part, with the polynomials P_0 … P_order on each of its rows; the same for
    /// the columns.
    along: [(usize, Vec<Vec<f64>>); 2],
}

impl Polynomial {
    /// Creates the polynomials of total degree up to `order`; `None` if no sample is defined.
    pub(super) fn on(z: &Field, order: usize) -> Option<Self> {
        let mut range = [[usize::MAX, 0]; 2];
        for ((ix, iy), _) in z.indexed_iter().filter(|(_, z)| !z.is_nan()) {
            for (range, index) in range.iter_mut().zip([ix, iy]) {
                *range = [range[0].min(index), range[1].max(index)];
            }
        }
        let along = range.map(|[first, last]| {
            let n = (last + 1).checked_sub(first)?;
            let values = (0..n).map(|i| legendre((2 * i + 1) as f64 / n as f64 - 1.0, order)).collect();
            Some((first, values))
        });
        let [Some(x), Some(y)] = along else { return None };
        Some(Self { order, along: [x, y] })
    }

    /// Subtracts the least-squares fit from the defined samples; returns its coefficients, in the order of
    /// [`Polynomial::terms`].
    ///
    /// A second fit removes the round-off of the first.
    pub(super) fn remove(&self, z: &mut Field) -> Vec<f64> {
        let normal = NormalEquations::new(self.products(z));
        let mut coefficients = vec![0.0; self.terms().count()];
        for _ in 0..2 {
            let found = normal.solve(self.moments(z));
            self.subtract(&found, z);
            coefficients.iter_mut().zip(found).for_each(|(sum, found)| *sum += found);
        }
        coefficients
    }

    /// Iterates over the degrees (a, b), lower ones first.
    fn terms(&self) -> impl Iterator<Item = (usize, usize)> + use<> {
        let order = self.order;
        (0..=order).flat_map(|degree| (0..=degree).map(move |b| (degree - b, b)))
    }

    /// Sums the products of two terms over the defined samples, lower triangle.
    fn products(&self, z: &Field) -> Vec<Vec<f64>> {
        let terms: Vec<_> = self.terms().collect();
        let mut sums: Vec<Vec<f64>> = (1..=terms.len()).map(|row| vec![0.0; row]).collect();
        let [(x0, along_x), (y0, along_y)] = &self.along;
        for (i, px) in along_x.iter().enumerate() {
            // First along the row: the products of two polynomials of η.
            let mut row = vec![vec![0.0; self.order + 1]; self.order + 1];
            for (j, py) in along_y.iter().enumerate() {
                if !z[[x0 + i, y0 + j]].is_nan() {
                    (0..=self.order).for_each(|b| (0..=b).for_each(|d| row[b][d] += py[b] * py[d]));
                }
            }
            for (m, &(a, b)) in terms.iter().enumerate() {
                for (n, &(c, d)) in terms[..=m].iter().enumerate() {
                    sums[m][n] += px[a] * px[c] * row[b.max(d)][b.min(d)];
                }
            }
        }
        sums
    }

    /// Sums height times term over the defined samples.
    fn moments(&self, z: &Field) -> Vec<f64> {
        let mut sums = vec![0.0; self.terms().count()];
        let [(x0, along_x), (y0, along_y)] = &self.along;
        for (i, px) in along_x.iter().enumerate() {
            let mut row = vec![0.0; self.order + 1];
            for (j, py) in along_y.iter().enumerate() {
                let z = z[[x0 + i, y0 + j]];
                if !z.is_nan() {
                    row.iter_mut().zip(py).for_each(|(sum, p)| *sum += p * z);
                }
            }
            sums.iter_mut().zip(self.terms()).for_each(|(sum, (a, b))| *sum += px[a] * row[b]);
        }
        sums
    }

    fn subtract(&self, coefficients: &[f64], z: &mut Field) {
        let [(x0, along_x), (y0, along_y)] = &self.along;
        for (i, px) in along_x.iter().enumerate() {
            let mut row = vec![0.0; self.order + 1];
            coefficients.iter().zip(self.terms()).for_each(|(c, (a, b))| row[b] += c * px[a]);
            for (j, py) in along_y.iter().enumerate() {
                z[[x0 + i, y0 + j]] -= row.iter().zip(py).map(|(c, p)| c * p).sum::<f64>();
            }
        }
    }
}

/// P_0 … P_order at `x`, by Bonnet's recursion (n + 1) P_{n+1} = (2n + 1) x P_n − n P_{n−1}.
fn legendre(x: f64, order: usize) -> Vec<f64> {
    let mut p = vec![1.0, x];
    for n in 1..order {
        let n_th = n as f64;
        p.push(((2.0 * n_th + 1.0) * x * p[n] - n_th * p[n - 1]) / (n_th + 1.0));
    }
    p.truncate(order + 1);
    p
}
