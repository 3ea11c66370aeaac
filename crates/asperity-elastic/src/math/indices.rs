//! Indices of a few of many values.

/// Number of values that are tested together.
const SOME: usize = 16;

/// Iterates over the indices of the `values` that satisfy a condition, in increasing order. It is fastest
/// with `for_each` if few values satisfy it.
pub(crate) fn indices_where<'a, T>(
    values: &'a [T],
    is_so: impl Fn(&T) -> bool + Copy + 'a,
) -> impl Iterator<Item = usize> + 'a {
    let some = values.chunks(SOME).enumerate();
    some.filter(move |(_, some)| some.iter().fold(false, |any, value| any | is_so(value))).flat_map(
        move |(number, some)| {
            let some = some.iter().enumerate().filter(move |(_, value)| is_so(value));
            some.map(move |(index, _)| number * SOME + index)
        },
    )
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_value_that_is_so_is_found_once() {
        for n in [0, 1, 15, 16, 17, 100] {
            let values: Vec<usize> = (0..n).map(|i| i * i % 7).collect();
            let expected: Vec<usize> = (0..n).filter(|i| i * i % 7 == 2).collect();
            assert_eq!(indices_where(&values, |value| *value == 2).collect::<Vec<_>>(), expected);
        }
    }
}
