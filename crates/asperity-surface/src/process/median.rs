//! The median.

/// Returns the median of the values, without NaN; for an even number the mean of the two in the middle.
///
/// # Panics
/// If there are no values.
pub(super) fn median(values: &mut [f64]) -> f64 {
    let middle = values.len() / 2;
    let odd = values.len() % 2 == 1;
    let (below, upper, _) = values.select_nth_unstable_by(middle, f64::total_cmp);
    if odd { *upper } else { 0.5 * (*upper + below.iter().copied().fold(f64::NEG_INFINITY, f64::max)) }
}

#[cfg(test)]
mod tests {
    use super::median;

    #[test]
    fn as_many_values_lie_above_as_below() {
        assert_eq!(median(&mut [3.0, -1.0, 7.0]), 3.0);
        assert_eq!(median(&mut [3.0, -1.0, 7.0, 4.0]), 3.5);
        assert_eq!(median(&mut [2.0]), 2.0);
    }
}
