//! The rows of a grid on one rank.

use std::fmt;
use std::ops::Range;
use std::sync::Arc;

use super::{Merged, Parts, Ranks, SingleProcess};
use crate::error::{Error, Result};
use crate::grid::{Field, Grid};

/// Largest number of cells of a coarse grid that each rank stores in full.
const MAX_WHOLE: usize = 1 << 16;

/// A grid distributed over ranks: each has a slab of consecutive rows, those of equal x.
#[derive(Clone)]
pub struct Slab {
    ranks: Arc<dyn Ranks>,
    whole: Grid,
    rows: Parts,
}

impl Slab {
    /// Creates the slab of this one of the `ranks` on a `grid`, with nearly equal numbers of rows. If there
    /// are enough rows, it begins at a row of the coarser grids, too.
    ///
    /// # Errors
    /// [`Error::TooManyRanks`].
    pub fn new(ranks: Arc<dyn Ranks>, grid: Grid) -> Result<Self> {
        let (count, rows) = (ranks.count(), grid.shape[0]);
        if count > rows {
            return Err(Error::TooManyRanks { ranks: count, rows });
        }
        let coarse = |unit: usize| grid.shape.map(|n| n.div_ceil(unit));
        let divided = |unit: usize| coarse(unit)[0] * coarse(unit)[1] > MAX_WHOLE && coarse(unit)[0] >= count;
        let mut unit = 1;
        while divided(2 * unit) {
            unit *= 2;
        }
        let rows = Parts::in_units(rows, unit, count);
        Ok(Self { ranks, whole: grid, rows })
    }

    /// Creates the slab of a single process with the whole grid.
    #[inline]
    pub fn whole(grid: Grid) -> Self {
        Self { ranks: Arc::new(SingleProcess), whole: grid, rows: Parts::even(grid.shape[0], 1) }
    }

    /// The ranks.
    #[inline]
    pub fn ranks(&self) -> &Arc<dyn Ranks> {
        &self.ranks
    }

    /// The grid of all rows.
    #[inline]
    pub fn whole_grid(&self) -> Grid {
        self.whole
    }

    /// The grid of the rows of this rank.
    #[inline]
    pub fn grid(&self) -> Grid {
        let [_, columns] = self.whole.shape;
        Grid { shape: [self.rows().len(), columns], pitch: self.whole.pitch }
    }

    /// The rows of this rank.
    #[inline]
    pub fn rows(&self) -> Range<usize> {
        self.rows.of_rank(self.ranks.rank())
    }

    /// The rows of each rank.
    #[inline]
    pub fn parts(&self) -> &Parts {
        &self.rows
    }

    /// Whether one process has all rows.
    #[inline]
    pub fn is_whole(&self) -> bool {
        self.ranks.count() == 1
    }

    /// Returns the slab of a coarse `grid` with half as many rows. It is the whole grid if that is small, or
    /// if the rows of a rank do not match its coarse ones.
    #[inline]
    pub fn coarse(&self, grid: Grid) -> Self {
        match self.rows.halved() {
            Some(rows) if !self.is_whole() && grid.cells() > MAX_WHOLE => {
                Self { ranks: Arc::clone(&self.ranks), whole: grid, rows }
            }
            _ => Self::whole(grid),
        }
    }

    /// Merges the parts of all ranks in rank order; the result is the same on each of them.
    #[inline]
    pub fn merged<M: Merged>(&self, part: M) -> M {
        if self.is_whole() {
            return part;
        }
        let numbers = part.numbers();
        let gathered = self.ranks.gather(&numbers, &vec![numbers.len(); self.ranks.count()]);
        M::of_parts(gathered.chunks_exact(numbers.len()).map(M::of_numbers))
    }

    /// Collects the whole field from the rows of all ranks.
    ///
    /// # Panics
    /// If the shape of the field differs from that of the grid of this rank.
    pub fn collected(&self, field: &Field) -> Field {
        let [rows, columns] = self.whole.shape;
        assert_eq!(field.dim(), (self.rows().len(), columns), "shape of the field");
        if self.is_whole() {
            return field.clone();
        }
        let counts: Vec<usize> = self.rows.all().map(|rows| rows.len() * columns).collect();
        let numbers =
            self.ranks.gather(field.as_standard_layout().as_slice().expect("standard layout"), &counts);
        Field::from_shape_vec([rows, columns], numbers).expect("the rows of all ranks")
    }
}

impl fmt::Debug for Slab {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.debug_struct("Slab").field("whole", &self.whole).field("rows", &self.rows()).finish()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::ranks::Largest;
    use crate::ranks::threads::on_ranks;

    fn grid(shape: [usize; 2]) -> Grid {
        Grid::new(shape, [1.0; 2]).unwrap()
    }

    #[test]
    fn what_is_merged_and_collected_is_the_same_on_every_rank() {
        for count in 1..=4 {
            let whole = grid([13, 5]);
            let found = on_ranks(count, |ranks| {
                let slab = Slab::new(ranks, whole).unwrap();
                let field = Field::from_shape_fn(slab.grid().shape, |(i, j)| {
                    (10 * (slab.rows().start + i) + j) as f64
                });
                let [sum] = slab.merged([field.sum()]);
                let Largest(largest) = slab.merged(Largest(field[[0, 0]]));
                let last = slab.merged(slab.rows().end == 13 && slab.rows().start > 0);
                (sum, largest, last, slab.collected(&field))
            });
            let expected = Field::from_shape_fn([13, 5], |(i, j)| (10 * i + j) as f64);
            for (sum, largest, last, field) in found {
                assert_eq!((sum, last), (expected.sum(), count > 1));
                assert_eq!(largest, 10.0 * ((count - 1) * 13 / count) as f64);
                assert_eq!(field, expected);
            }
        }
    }

    #[test]
    fn slabs_of_a_large_grid_stay_slabs_of_its_coarse_grids_until_these_are_small() {
        let slabs = on_ranks(3, |ranks| Slab::new(ranks, grid([1500, 1100])).unwrap());
        for mut slab in slabs {
            let [fine, half] = [grid([1500, 1100]), grid([750, 550])];
            assert_eq!(slab.whole_grid(), fine);
            slab = slab.coarse(half);
            assert!(!slab.is_whole());
            slab = slab.coarse(grid([375, 275]));
            assert!(!slab.is_whole(), "103125 cells");
            assert!(slab.coarse(grid([188, 138])).is_whole());
        }
    }

    #[test]
    fn more_ranks_than_rows_are_refused() {
        let errors = on_ranks(4, |ranks| Slab::new(ranks, grid([3, 100])).unwrap_err().to_string());
        assert!(errors.iter().all(|error| error == "4 ranks are too many for a grid of 3 rows along x"));
    }
}
