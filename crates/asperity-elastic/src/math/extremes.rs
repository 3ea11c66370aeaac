//! Extremes of values, in lanes, so that no comparison waits for the one before.

use asperity_transforms::Precision;

/// Number of lanes.
const LANES: usize = 16;

/// Returns the largest of the `magnitude` of each index and value, at least 0. It ignores NaN.
pub(crate) fn largest<T: Copy, S: Precision + PartialOrd>(
    values: &[T],
    magnitude: impl Fn(usize, T) -> S,
) -> S {
    most(values, S::zero(), magnitude)
}

/// Returns the least and the largest value, infinite without values.
pub(crate) fn extremes<T: Precision + PartialOrd>(values: &[T]) -> [T; 2] {
    let least = -T::one() / T::zero();
    [-most(values, least, |_, value| -value), most(values, least, |_, value| value)]
}

fn most<T: Copy, S: Precision + PartialOrd>(values: &[T], least: S, of: impl Fn(usize, T) -> S) -> S {
    let larger = |a: S, b: S| if b > a { b } else { a };
    let mut lanes = [least; LANES];
    let chunks = values.chunks_exact(LANES);
    let rest = chunks.remainder();
    for (number, chunk) in chunks.enumerate() {
        for lane in 0..LANES {
            lanes[lane] = larger(lanes[lane], of(number * LANES + lane, chunk[lane]));
        }
    }
    let first = values.len() - rest.len();
    let rest = rest.iter().enumerate().map(|(index, value)| of(first + index, *value));
    lanes.into_iter().chain(rest).fold(least, larger)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_value_counts() {
        for n in [1, 15, 16, 17, 100] {
            for at in 0..n {
                let mut values = vec![1.0f32; n];
                values[at] = -3.0;
                assert_eq!(extremes(&values), [-3.0, if n > 1 { 1.0 } else { -3.0 }]);
                assert_eq!(largest(&values, |index, v| if index == at { v.abs() } else { 0.0 }), 3.0);
            }
        }
        assert_eq!(extremes::<f64>(&[]), [f64::INFINITY, f64::NEG_INFINITY]);
    }
}
