//! The spread of a number over the samples of a random surface.

use std::collections::BTreeMap;

use super::table::Table;

/// Mean and spread of a number over several cases.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Spread {
    /// Mean.
    pub mean: f64,
    /// Standard deviation of a sample, with count − 1 in the denominator; `None` for a single case.
    pub deviation: Option<f64>,
    /// Number of cases that have the number.
    pub count: usize,
}

impl Spread {
    /// Returns the spread of the finite values; `None` without any.
    pub fn from_values(values: impl IntoIterator<Item = f64>) -> Option<Self> {
        let values: Vec<f64> = values.into_iter().filter(|value| value.is_finite()).collect();
        let count = values.len();
        let mean = values.iter().sum::<f64>() / count as f64;
        let squares: f64 = values.iter().map(|value| (value - mean).powi(2)).sum();
        let deviation = (count > 1).then(|| (squares / (count - 1) as f64).sqrt());
        (count > 0).then_some(Self { mean, deviation, count })
    }
}

impl Table {
    /// Returns the finished rows that differ in nothing but seeds together, by their indices, in the order of
    /// the table.
    pub fn samples(&self) -> Vec<Vec<usize>> {
        let mut places = BTreeMap::new();
        let mut samples: Vec<Vec<usize>> = Vec::new();
        for (n, row) in self.rows().iter().enumerate().filter(|(_, row)| row.failure.is_none()) {
            let others = self.axes().iter().zip(&row.indices).filter(|(axis, _)| !axis.is_seed());
            let others: Vec<u32> = others.map(|(_, index)| *index).collect();
            let place = *places.entry((others, row.point)).or_insert(samples.len());
            match samples.get_mut(place) {
                Some(sample) => sample.push(n),
                None => samples.push(vec![n]),
            }
        }
        samples
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_spread_is_that_of_the_known_values() {
        let spread = |values: &[f64]| {
            Spread::from_values(values.iter().copied()).map(|s| (s.mean, s.deviation, s.count))
        };
        assert_eq!(spread(&[1.0, 2.0, f64::NAN, 3.0]), Some((2.0, Some(1.0), 3)));
        assert_eq!(spread(&[5.0]), Some((5.0, None, 1)));
        assert_eq!(spread(&[f64::NAN]), None);
    }
}
