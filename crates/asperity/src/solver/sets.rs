//! Which cells are at a bound, and which are free.

use crate::solver::bounds::{Bounds, Interval, with_bounds};
use crate::units::Pascal;

/// The predicted set of a cell: where in its bounds the answer is taken to have its pressure.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Set {
    /// The open cells, at their lower bound.
    Lower,
    /// The free cells, between their bounds, whose gap is to be closed.
    Free,
    /// The capped cells, at their upper bound.
    Upper,
}

impl Set {
    /// The set of a cell whose pressure is that, or beyond a bound.
    pub(super) fn of(pressure: Pascal, bounds: Interval) -> Self {
        match pressure {
            p if p <= bounds.lower => Self::Lower,
            p if p >= bounds.upper => Self::Upper,
            _ => Self::Free,
        }
    }
}

/// The set of each cell of a grid, and a list of the free ones.
pub(super) struct Sets {
    /// The set of each cell.
    of: Vec<Set>,
    /// Cells in a row of the grid.
    columns: usize,
    /// Flat indices of the free cells, increasing.
    free: Vec<u32>,
    /// Number of free cells before each row of the grid; last, the number of all.
    before: Vec<u32>,
}

impl Sets {
    pub(super) fn new(shape: [usize; 2]) -> Self {
        Self {
            of: vec![Set::Lower; shape[0] * shape[1]],
            columns: shape[1],
            free: Vec::with_capacity(shape[0] * shape[1]),
            before: vec![0; shape[0] + 1],
        }
    }

    /// Puts each cell at the bound that its pressure in `pressures` is at or beyond.
    pub(super) fn assign(&mut self, pressures: impl Iterator<Item = Pascal>, bounds: &Bounds) {
        with_bounds!(bounds, of => {
            self.put(pressures.enumerate().map(|(cell, p)| Set::of(p, of(cell))));
        });
    }

    /// Frees the cells that are `free`, and puts all others at their lower bound.
    pub(super) fn free_where(&mut self, free: impl Iterator<Item = bool>) {
        self.put(free.map(|free| if free { Set::Free } else { Set::Lower }));
    }

    /// Replaces the sets of all cells.
    fn put(&mut self, mut sets: impl Iterator<Item = Set>) {
        self.free.clear();
        let rows = self.of.chunks_exact_mut(self.columns).zip(&mut self.before);
        for (row, (cells, before)) in rows.enumerate() {
            *before = self.free.len() as u32;
            let first = row * self.columns;
            for (column, (cell, set)) in cells.iter_mut().zip(sets.by_ref()).enumerate() {
                *cell = set;
                if set == Set::Free {
                    self.free.push((first + column) as u32);
                }
            }
        }
        *self.before.last_mut().expect("one more than rows") = self.free.len() as u32;
    }

    /// The set of each cell.
    pub(super) fn of(&self) -> &[Set] {
        &self.of
    }

    /// Whether a flat cell is free.
    pub(super) fn is_free(&self, cell: usize) -> bool {
        self.of[cell] == Set::Free
    }

    /// Flat indices of the free cells, increasing.
    pub(super) fn free(&self) -> impl ExactSizeIterator<Item = usize> + '_ {
        self.free.iter().map(|cell| *cell as usize)
    }

    /// The rows with free cells: the number of each, its first cell, and its free cells.
    pub(super) fn rows(&self) -> impl Iterator<Item = (usize, usize, &[u32])> {
        let rows = self.before.windows(2).enumerate();
        let rows =
            rows.map(|(row, ends)| (row, row * self.columns, &self.free[ends[0] as usize..ends[1] as usize]));
        rows.filter(|(.., free)| !free.is_empty())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::Field;

    #[test]
    fn a_cell_is_at_the_bound_that_its_pressure_is_at_or_beyond() {
        let upper = Field::from_shape_fn([2, 3], |(i, j)| (1 + i + j) as f64);
        let bounds = Bounds::up_to(upper).above(-1.0);
        let mut sets = Sets::new([2, 3]);
        sets.assign([-2.0, -1.0, 3.0, 1.5, 3.5, -0.5].into_iter(), &bounds);
        let expected = [Set::Lower, Set::Lower, Set::Upper, Set::Free, Set::Upper, Set::Free];
        assert_eq!(sets.of(), expected);
        assert_eq!(sets.free().collect::<Vec<_>>(), [3, 5]);
        let rows: Vec<_> = sets.rows().map(|(row, first, free)| (row, first, free.to_vec())).collect();
        assert_eq!(rows, [(1, 3, vec![3, 5])]);
        assert!(sets.is_free(5) && !sets.is_free(4));
    }

    #[test]
    fn sets_given_anew_leave_nothing_of_the_old() {
        let mut sets = Sets::new([3, 4]);
        sets.free_where((0..12).map(|_| true));
        assert_eq!((sets.free().len(), sets.rows().count()), (12, 3));
        sets.free_where((0..12).map(|cell| cell == 6));
        assert_eq!(sets.free().collect::<Vec<_>>(), [6]);
        assert_eq!(sets.of().iter().filter(|set| **set == Set::Lower).count(), 11);
    }
}
