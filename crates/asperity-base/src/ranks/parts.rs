//! Distribution of lines over ranks.

use std::ops::Range;

/// Lines of a grid, rows or columns, in consecutive parts, one for each rank.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Parts {
    /// First line of each part, and finally the number of lines.
    first: Vec<usize>,
}

impl Parts {
    /// Divides `lines` lines as evenly as possible.
    #[inline]
    pub fn even(lines: usize, ranks: usize) -> Self {
        Self::in_units(lines, 1, ranks)
    }

    /// Divides `lines` lines as evenly as possible into parts that begin at multiples of `unit`.
    pub(super) fn in_units(lines: usize, unit: usize, ranks: usize) -> Self {
        let units = lines.div_ceil(unit);
        Self { first: (0..=ranks).map(|rank| (rank * units / ranks * unit).min(lines)).collect() }
    }

    /// Returns the same parts for every second line; `None` if a part begins at an odd line.
    pub(super) fn halved(&self) -> Option<Self> {
        let (lines, firsts) = self.first.split_last().expect("one more than ranks");
        let even = firsts.iter().all(|first| first.is_multiple_of(2));
        even.then(|| Self {
            first: firsts.iter().map(|first| first / 2).chain([lines.div_ceil(2)]).collect(),
        })
    }

    /// Lines of a rank.
    #[inline]
    pub fn of_rank(&self, rank: usize) -> Range<usize> {
        self.first[rank]..self.first[rank + 1]
    }

    /// Iterates over the lines of each rank.
    #[inline]
    pub fn all(&self) -> impl ExactSizeIterator<Item = Range<usize>> {
        self.first.windows(2).map(|ends| ends[0]..ends[1])
    }

    /// Number of all lines.
    #[inline]
    pub fn lines(&self) -> usize {
        *self.first.last().expect("one more than ranks")
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn each_line_is_in_one_part_and_no_part_is_larger_by_more_than_a_unit() {
        arbtest::arbtest(|u| {
            let (lines, ranks) = (u.int_in_range(1..=300usize)?, u.int_in_range(1..=9usize)?);
            let unit = 1 << u.int_in_range(0..=3u32)?;
            let parts = Parts::in_units(lines, unit, ranks);
            let joined: Vec<usize> = parts.all().flatten().collect();
            assert_eq!(joined, (0..lines).collect::<Vec<_>>());
            let (least, most) =
                (parts.all().map(|part| part.len()).min(), parts.all().map(|part| part.len()).max());
            assert!(most <= least.map(|least| least + 2 * unit - 1), "{parts:?}");
            assert!(parts.all().all(|part| part.start.is_multiple_of(unit) || part.start == lines));
            Ok(())
        });
    }

    #[test]
    fn parts_that_begin_at_even_lines_have_a_half() {
        let parts = Parts::in_units(23, 4, 3);
        assert_eq!(parts.all().collect::<Vec<_>>(), [0..8, 8..16, 16..23]);
        let half = parts.halved().unwrap();
        assert_eq!(half.all().collect::<Vec<_>>(), [0..4, 4..8, 8..12]);
        assert_eq!(half.lines(), 12);
        assert_eq!(Parts::even(9, 3).halved(), None);
    }
}
