//! Halo rows: copies of the rows of neighbouring ranks.

use std::borrow::Cow;
use std::ops::Range;
use std::sync::Arc;

use super::{Ranks, Slab};
use crate::ranks::Number;

/// The rows of a rank and further rows on either side, within the grid.
pub struct Halo {
    ranks: Arc<dyn Ranks>,
    /// The rows of this rank, relative to the first row of the halo.
    own: Range<usize>,
    /// Number of rows, halo included.
    rows: usize,
    columns: usize,
    /// The own rows that each rank requires, in the numbering of `own`.
    wanted: Vec<Range<usize>>,
    sent_counts: Vec<usize>,
    received_counts: Vec<usize>,
}

impl Slab {
    /// Creates the halo of this rank's rows with `reach` more on either side.
    #[inline]
    pub fn halo(&self, reach: usize) -> Halo {
        Halo::new(self, reach)
    }
}

impl Halo {
    /// Creates the halo of the rows of a `slab` with `reach` more on either side.
    fn new(slab: &Slab, reach: usize) -> Self {
        let [rows, columns] = slab.whole_grid().shape;
        let (rank, parts) = (slab.ranks().rank(), slab.parts());
        let with_halo = |own: Range<usize>| own.start.saturating_sub(reach)..(own.end + reach).min(rows);
        let own = parts.of_rank(rank);
        let extended = with_halo(own.clone());
        let both = |a: &Range<usize>, b: &Range<usize>| {
            let both = a.start.max(b.start)..a.end.min(b.end);
            if both.is_empty() { 0..0 } else { both }
        };
        let other = |other: usize, rows: Range<usize>| if other == rank { 0..0 } else { rows };
        let wanted = parts.all().enumerate().map(|(n, part)| other(n, both(&own, &with_halo(part))));
        let wanted: Vec<Range<usize>> = wanted.collect();
        let received = parts.all().enumerate().map(|(n, part)| other(n, both(&part, &extended)));
        Self {
            ranks: Arc::clone(slab.ranks()),
            sent_counts: wanted.iter().map(|rows| rows.len() * columns).collect(),
            received_counts: received.map(|rows| rows.len() * columns).collect(),
            wanted: wanted
                .into_iter()
                .map(|rows| {
                    rows.start.saturating_sub(extended.start)..rows.end.saturating_sub(extended.start)
                })
                .collect(),
            own: own.start - extended.start..own.end - extended.start,
            rows: extended.len(),
            columns,
        }
    }

    /// Number of rows and columns, halo included.
    #[inline]
    pub fn shape(&self) -> [usize; 2] {
        [self.rows, self.columns]
    }

    /// The cells of this rank among those of the halo.
    #[inline]
    pub fn own(&self) -> Range<usize> {
        self.own.start * self.columns..self.own.end * self.columns
    }

    /// Returns the `values` of this rank's rows together with those of the neighbours on either side.
    #[inline]
    pub fn around<'a, T: Number>(&self, values: &'a [T]) -> Cow<'a, [T]> {
        if self.ranks.count() == 1 {
            return Cow::Borrowed(values);
        }
        let mut all = vec![T::default(); self.rows * self.columns];
        all[self.own()].copy_from_slice(values);
        self.fill(&mut all);
        Cow::Owned(all)
    }

    /// The own rows, relative to the first row of the halo.
    #[inline]
    pub fn own_rows(&self) -> Range<usize> {
        self.own.clone()
    }

    /// Fills the rows on either side with those of the neighbours; `values` has the shape of the halo.
    pub fn fill<T: Number>(&self, values: &mut [T]) {
        if self.ranks.count() == 1 {
            return;
        }
        let columns = self.columns;
        let sent: Vec<T> = self
            .wanted
            .iter()
            .flat_map(|rows| &values[rows.start * columns..rows.end * columns])
            .copied()
            .collect();
        let mut received = vec![T::default(); self.received_counts.iter().sum()];
        T::exchange(&*self.ranks, &sent, &self.sent_counts, &mut received, &self.received_counts);
        let own = self.own();
        let (above, below) = received.split_at(own.start);
        values[..own.start].copy_from_slice(above);
        values[own.end..].copy_from_slice(below);
    }
}

#[cfg(test)]
mod tests {
    use crate::grid::Grid;
    use crate::ranks::Slab;
    use crate::ranks::threads::on_ranks;

    #[test]
    fn the_rows_on_either_side_are_those_of_the_neighbours_however_few_these_have() {
        for (count, reach) in [(1, 2), (2, 2), (3, 4), (4, 4), (6, 3), (6, 20)] {
            let whole = Grid::new([11, 3], [1.0; 2]).unwrap();
            on_ranks(count, |ranks| {
                let slab = Slab::new(ranks, whole).unwrap();
                let halo = slab.halo(reach);
                let [rows, columns] = halo.shape();
                let first = slab.rows().start.saturating_sub(reach);
                assert_eq!((rows, columns), ((slab.rows().end + reach).min(11) - first, 3));
                let all: Vec<f32> = (3 * first..3 * (first + rows)).map(|cell| cell as f32).collect();
                let mut values = vec![-1.0; all.len()];
                values[halo.own()].copy_from_slice(&all[halo.own()]);
                assert_eq!(*halo.around(&all[halo.own()]), all);
                halo.fill(&mut values);
                assert_eq!(values, all, "{count} ranks, rank {}", slab.ranks().rank());
            });
        }
    }
}
