//! Sums of values by cell.

/// Sums the values of each cell in their order. Returns the cells in ascending order.
pub(crate) fn gathered(parts: impl Iterator<Item = (u32, f64)>) -> Vec<(u32, f64)> {
    let mut parts: Vec<_> = parts.collect();
    parts.sort_by_key(|(cell, _)| *cell);
    parts.dedup_by(|(next, value), (cell, sum)| {
        let same = next == cell;
        if same {
            *sum += *value;
        }
        same
    });
    parts
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_cell_comes_once_with_all_that_came_to_it() {
        let parts = [(4, 1.0), (2, 0.5), (4, 0.25), (0, 3.0), (2, 2.0)];
        assert_eq!(gathered(parts.into_iter()), [(0, 3.0), (2, 2.5), (4, 1.25)]);
        assert_eq!(gathered(std::iter::empty()), []);
    }
}
