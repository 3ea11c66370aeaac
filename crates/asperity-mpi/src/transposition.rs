//! Transposition of a grid between rows by rank and columns by rank.

use std::sync::Arc;

use asperity_transforms::num_complex::Complex;

use asperity_base::ranks::{Number, Parts, Ranks};

/// Complex numbers `[row, column]` with rows, or columns, on each rank.
///
/// Two ranks exchange the cells in the rows of one and the columns of the other, column by column. The memory
/// is two real numbers per cell in each of the two forms.
pub(crate) struct Transposition<T> {
    ranks: Arc<dyn Ranks>,
    rows: Parts,
    columns: Parts,
    /// The rows of this rank, split into the columns of each rank.
    by_rows: Vec<T>,
    /// The columns of this rank, split into the rows of each rank.
    by_columns: Vec<T>,
    row_counts: Vec<usize>,
    column_counts: Vec<usize>,
}

impl<T: Number> Transposition<T> {
    /// Creates zeros with these `rows`, and these `columns`, on each of the `ranks`.
    pub(crate) fn new(ranks: Arc<dyn Ranks>, rows: Parts, columns: Parts) -> Self {
        let (own_rows, own_columns) = (rows.of_rank(ranks.rank()).len(), columns.of_rank(ranks.rank()).len());
        let row_counts: Vec<usize> = columns.all().map(|part| 2 * own_rows * part.len()).collect();
        let column_counts: Vec<usize> = rows.all().map(|part| 2 * part.len() * own_columns).collect();
        Self {
            by_rows: vec![T::default(); row_counts.iter().sum()],
            by_columns: vec![T::default(); column_counts.iter().sum()],
            ranks,
            rows,
            columns,
            row_counts,
            column_counts,
        }
    }

    /// Sets consecutive rows of this rank from its row `first` on, from `values` row by row.
    pub(crate) fn set_rows(&mut self, first: usize, values: &[Complex<T>]) {
        let (width, own) = (self.columns.lines(), self.own_rows());
        let count = values.len() / width;
        for (column, cells) in self.by_rows.chunks_exact_mut(2 * own).enumerate() {
            let cells = cells[2 * first..][..2 * count].chunks_exact_mut(2);
            for (cell, row) in cells.zip(values.chunks_exact(width)) {
                cell.copy_from_slice(&[row[column].re, row[column].im]);
            }
        }
    }

    /// Reads consecutive rows, the inverse of [`Self::set_rows`].
    pub(crate) fn rows(&self, first: usize, values: &mut [Complex<T>]) {
        let (width, own) = (self.columns.lines(), self.own_rows());
        let count = values.len() / width;
        for (column, cells) in self.by_rows.chunks_exact(2 * own).enumerate() {
            let cells = cells[2 * first..][..2 * count].chunks_exact(2);
            for (cell, row) in cells.zip(values.chunks_exact_mut(width)) {
                row[column] = Complex { re: cell[0], im: cell[1] };
            }
        }
    }

    /// Sets a column of this rank, counted from its first column, with a value for each row of the grid.
    pub(crate) fn set_column(&mut self, column: usize, values: &[Complex<T>]) {
        let width = self.own_columns();
        for part in self.rows.all() {
            let cells = &mut self.by_columns[2 * (part.start * width + column * part.len())..];
            for (cell, value) in cells.chunks_exact_mut(2).zip(&values[part]) {
                cell.copy_from_slice(&[value.re, value.im]);
            }
        }
    }

    /// Reads a column, the inverse of [`Self::set_column`].
    pub(crate) fn column(&self, column: usize, values: &mut [Complex<T>]) {
        let width = self.own_columns();
        for part in self.rows.all() {
            let cells = &self.by_columns[2 * (part.start * width + column * part.len())..];
            for (cell, value) in cells.chunks_exact(2).zip(&mut values[part]) {
                *value = Complex { re: cell[0], im: cell[1] };
            }
        }
    }

    /// Transposes the rows of all ranks to columns.
    pub(crate) fn make_columns(&mut self) {
        let Self { ranks, by_rows, by_columns, row_counts, column_counts, .. } = self;
        T::exchange(&**ranks, by_rows, row_counts, by_columns, column_counts);
    }

    /// Transposes the columns of all ranks to rows.
    pub(crate) fn make_rows(&mut self) {
        let Self { ranks, by_rows, by_columns, row_counts, column_counts, .. } = self;
        T::exchange(&**ranks, by_columns, column_counts, by_rows, row_counts);
    }

    /// Number of columns of this rank.
    pub(crate) fn own_columns(&self) -> usize {
        self.columns.of_rank(self.ranks.rank()).len()
    }

    /// Number of rows of all ranks.
    pub(crate) fn all_rows(&self) -> usize {
        self.rows.lines()
    }

    fn own_rows(&self) -> usize {
        self.rows.of_rank(self.ranks.rank()).len()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use asperity_base::ranks::threads::on_ranks;

    #[test]
    fn rows_become_columns_and_columns_rows() {
        for (count, rows, columns) in [(1, 4, 3), (2, 5, 9), (3, 7, 4), (4, 4, 2)] {
            on_ranks(count, |ranks| {
                let rank = ranks.rank();
                let [by_rows, by_columns] = [rows, columns].map(|lines| Parts::even(lines, count));
                let (own_rows, own_columns) = (by_rows.of_rank(rank), by_columns.of_rank(rank));
                let mut transposition = Transposition::new(ranks, by_rows, by_columns);
                let value = |row: usize, column: usize| Complex::new(row as f64, column as f64);
                for (n, row) in own_rows.clone().enumerate() {
                    let values: Vec<_> = (0..columns).map(|column| value(row, column)).collect();
                    transposition.set_rows(n, &values);
                }
                transposition.make_columns();
                let mut line = vec![Complex::default(); rows];
                for (n, column) in own_columns.enumerate() {
                    transposition.column(n, &mut line);
                    assert!(line.iter().enumerate().all(|(row, found)| *found == value(row, column)));
                    line.iter_mut().for_each(|value| *value = value.conj());
                    transposition.set_column(n, &line);
                }
                transposition.make_rows();
                let mut found = vec![Complex::default(); own_rows.len() * columns];
                transposition.rows(0, &mut found);
                for (cell, found) in found.iter().enumerate() {
                    assert_eq!(*found, value(own_rows.start + cell / columns, cell % columns).conj());
                }
            });
        }
    }
}
