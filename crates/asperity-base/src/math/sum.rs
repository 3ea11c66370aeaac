//! Sums in a fixed order.

use std::iter::Sum;

use asperity_transforms::Precision;

/// Number of partial sums.
const LANES: usize = 8;

/// Returns the sums of `terms` of each index and value, in eight lanes and in the precision of the terms.
/// This is faster than one sum and has smaller rounding errors.
pub fn sums<T: Copy, S: Precision + Sum, const N: usize>(
    values: &[T],
    terms: impl Fn(usize, T) -> [S; N],
) -> [S; N] {
    let mut lanes = [[S::zero(); LANES]; N];
    let chunks = values.chunks_exact(LANES);
    let rest = chunks.remainder();
    for (number, chunk) in chunks.enumerate() {
        for lane in 0..LANES {
            let term = terms(number * LANES + lane, chunk[lane]);
            (0..N).for_each(|n| lanes[n][lane] = lanes[n][lane] + term[n]);
        }
    }
    let first = values.len() - rest.len();
    for (lane, value) in rest.iter().enumerate() {
        let term = terms(first + lane, *value);
        (0..N).for_each(|n| lanes[n][lane] = lanes[n][lane] + term[n]);
    }
    lanes.map(|lanes| lanes.into_iter().sum())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_value_counts_once() {
        for n in [0, 1, 7, 8, 9, 100] {
            let values: Vec<u32> = (1..=n).collect();
            let [sum, count] = sums(&values, |index, v| [f64::from(v), f64::from(index as u32 + 1 == v)]);
            assert_eq!((sum, count), (f64::from(n * (n + 1) / 2), f64::from(n)));
        }
    }
}
