//! Which cells are at a bound, and which are free.

/// Where the answer is taken to have a cell.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Set {
    /// At p = 0.
    Zero,
    /// Between the bounds, where the gap is to be closed.
    Free,
    /// At p = H.
    Hardness,
}

/// The set of each cell of a grid, and a list of the free ones.
pub(super) struct Sets {
    of: Vec<Set>,
    columns: usize,
    /// Flat indices of the free cells, increasing.
    free: Vec<u32>,
    /// For each row of the grid, how many free cells come before it; at last how many there are.
    before: Vec<u32>,
}

impl Sets {
    pub(super) fn new(shape: [usize; 2]) -> Self {
        Self {
            of: vec![Set::Zero; shape[0] * shape[1]],
            columns: shape[1],
            free: Vec::with_capacity(shape[0] * shape[1]),
            before: vec![0; shape[0] + 1],
        }
    }

    /// A cell is at the bound that its pressure in `pressures` is at or beyond.
    pub(super) fn assign(&mut self, mut pressures: impl Iterator<Item = f64>, hardness: f64) {
        self.free.clear();
        let rows = self.of.chunks_exact_mut(self.columns).zip(&mut self.before);
        for (row, (sets, before)) in rows.enumerate() {
            *before = self.free.len() as u32;
            let first = row * self.columns;
            for (column, (set, p)) in sets.iter_mut().zip(pressures.by_ref()).enumerate() {
                *set = match p {
                    p if p <= 0.0 => Set::Zero,
                    p if p >= hardness => Set::Hardness,
                    _ => Set::Free,
                };
                if *set == Set::Free {
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
