//! Sets of cells: at a bound, or free.

use std::ops::Range;
use std::slice;

use crate::math::{Bands, indices_where, parallel};
use crate::solver::bounds::{Bounds, Interval, with_bounds};
use crate::units::Pascal;

/// Predicted set of a cell: the position of its pressure within its bounds.
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
    /// Returns the set of a cell with this pressure, which may lie beyond a bound.
    pub(super) fn from_pressure(pressure: Pascal, bounds: Interval) -> Self {
        match pressure {
            p if p <= bounds.lower => Self::Lower,
            p if p >= bounds.upper => Self::Upper,
            _ => Self::Free,
        }
    }
}

/// The set of each cell of a grid, and lists of the free ones.
pub(super) struct Sets {
    bands: Bands,
    /// The set of each cell.
    of: Vec<Set>,
    /// The free cells of each band.
    free: Vec<FreeCells>,
}

/// The free cells of a band of rows.
pub(super) struct FreeCells {
    /// Their indices in the band, increasing.
    cells: Vec<u32>,
    /// Number of free cells before each row of the band; last, the number of all.
    before: Vec<u32>,
}

impl Sets {
    pub(super) fn new(shape: [usize; 2]) -> Self {
        let bands = Bands::new(shape);
        let free = |rows: Range<usize>| FreeCells { cells: Vec::new(), before: vec![0; rows.len() + 1] };
        Self { bands, of: vec![Set::Lower; shape[0] * shape[1]], free: bands.rows().map(free).collect() }
    }

    /// Assigns to a bound each cell whose pressure is at or beyond it. `pressures` returns the pressures of
    /// consecutive cells.
    pub(super) fn assign<P: Iterator<Item = Pascal>>(
        &mut self,
        pressures: impl Fn(Range<usize>) -> P + Sync + Send,
        bounds: &Bounds,
    ) {
        with_bounds!(bounds, of => {
            self.put(|cells| {
                let first = cells.start;
                pressures(cells).enumerate().map(move |(cell, p)| Set::from_pressure(p, of(first + cell)))
            });
        });
    }

    /// Sets the given cells free, and all others to their lower bound.
    pub(super) fn free_where(&mut self, is_free: impl Fn(usize) -> bool + Sync + Send) {
        self.put(|cells| cells.map(|cell| if is_free(cell) { Set::Free } else { Set::Lower }));
    }

    /// Replaces the sets of all cells. `sets` returns the sets of consecutive cells.
    fn put<S: Iterator<Item = Set>>(&mut self, sets: impl Fn(Range<usize>) -> S + Sync + Send) {
        let Self { bands, of, free } = self;
        let parts = bands.cut_mut(of).zip(free).enumerate();
        parallel::map(parts, |(band, (of, free))| {
            let first = bands.first(band);
            let sets = sets(first..first + of.len());
            of.iter_mut().zip(sets).for_each(|(value, set)| *value = set);
            free.list(of, bands.columns());
        });
    }

    /// The bands of the grid.
    pub(super) fn bands(&self) -> Bands {
        self.bands
    }

    /// The set of each cell.
    pub(super) fn by_cell(&self) -> &[Set] {
        &self.of
    }

    /// Whether a flat cell is free.
    pub(super) fn is_free(&self, cell: usize) -> bool {
        self.of[cell] == Set::Free
    }

    /// Number of free cells.
    pub(super) fn free_cells(&self) -> usize {
        self.free.iter().map(|band| band.cells.len()).sum()
    }

    /// The free cells of each band.
    pub(super) fn in_bands(&self) -> slice::Iter<'_, FreeCells> {
        self.free.iter()
    }

    /// Returns the free cells of a row of the grid, by their indices in its band, and the index of the first
    /// cell of the row.
    pub(super) fn row(&self, row: usize) -> (&[u32], usize) {
        let [band, row] = self.bands.place(row);
        let FreeCells { cells, before } = &self.free[band];
        (&cells[before[row] as usize..before[row + 1] as usize], row * self.bands.columns())
    }
}

impl FreeCells {
    /// Lists the free cells of a band with the sets `of`.
    fn list(&mut self, of: &[Set], columns: usize) {
        self.cells.clear();
        self.cells.reserve_exact(of.iter().filter(|set| **set == Set::Free).count());
        for (row, of) in of.chunks(columns).enumerate() {
            self.before[row] = self.cells.len() as u32;
            indices_where(of, |set| *set == Set::Free)
                .for_each(|column| self.cells.push((row * columns + column) as u32));
        }
        *self.before.last_mut().expect("one more than rows") = self.cells.len() as u32;
    }

    /// Indices of the free cells in their band, increasing.
    pub(super) fn cells(&self) -> impl ExactSizeIterator<Item = usize> + '_ {
        self.cells.iter().map(|cell| *cell as usize)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::Field;

    /// Flat indices of the free cells.
    fn free(sets: &Sets) -> Vec<usize> {
        let bands = sets.in_bands().enumerate();
        let cells = bands.map(|(band, free)| free.cells().map(move |cell| sets.bands().first(band) + cell));
        cells.flatten().collect()
    }

    #[test]
    fn a_cell_is_at_the_bound_that_its_pressure_is_at_or_beyond() {
        let upper = Field::from_shape_fn([2, 3], |(i, j)| (1 + i + j) as f64);
        let bounds = Bounds::up_to(upper).above(-1.0);
        let mut sets = Sets::new([2, 3]);
        let pressures = [-2.0, -1.0, 3.0, 1.5, 3.5, -0.5];
        sets.assign(|cells| pressures[cells].iter().copied(), &bounds);
        let expected = [Set::Lower, Set::Lower, Set::Upper, Set::Free, Set::Upper, Set::Free];
        assert_eq!(sets.by_cell(), expected);
        assert_eq!(free(&sets), [3, 5]);
        let rows = [0, 1].map(|row| sets.row(row));
        assert_eq!(rows, [(&[][..], 0), (&[3, 5][..], 3)]);
        assert!(sets.is_free(5) && !sets.is_free(4));
    }

    #[test]
    fn sets_given_anew_leave_nothing_of_the_old() {
        let mut sets = Sets::new([3, 4]);
        sets.free_where(|_| true);
        assert_eq!((sets.free_cells(), sets.row(2).0.len()), (12, 4));
        sets.free_where(|cell| cell == 6);
        assert_eq!(free(&sets), [6]);
        assert_eq!(sets.by_cell().iter().filter(|set| **set == Set::Lower).count(), 11);
    }

    #[test]
    fn a_large_grid_lists_its_free_cells_band_by_band() {
        let shape = [300, 1000];
        let mut sets = Sets::new(shape);
        let is_free = |cell: usize| (cell * 7 + cell / 1000).is_multiple_of(5);
        sets.free_where(is_free);
        assert!(sets.in_bands().len() > 3);
        let expected: Vec<usize> = (0..300_000).filter(|cell| is_free(*cell)).collect();
        assert_eq!(free(&sets), expected);
        let by_row = (0..300).flat_map(|row| {
            let (cells, first) = sets.row(row);
            cells.iter().map(move |cell| row * 1000 + *cell as usize - first)
        });
        assert_eq!(by_row.collect::<Vec<_>>(), expected);
    }
}
