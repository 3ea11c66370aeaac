//! Placement of a contact on a body: the one place that maps their cells to each other.

use super::{CellValues, Field};

/// Placement of the cells of a contact on the cells of one body.
///
/// A cell of the contact lies on one cell of the body, or between two along x. Between two cells, the surface
/// is their weighted mean. A change of the contact cell is distributed to the body with the same weights.
/// They sum to 1, so nothing is lost or gained.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Placement {
    /// Column of the body under the first column of the contact.
    first: usize,
    /// Shift of the body along y, in cells.
    across: usize,
    fraction: f64,
    /// Columns and width of the body.
    shape: [usize; 2],
}

impl Placement {
    /// Creates the placement of a contact whose first cell lies on `[column, row]` of a body of shape
    /// `shape`, counted cyclically, plus a `fraction` of a column, 0 ≤ `fraction` < 1.
    ///
    /// # Panics
    /// If the cell is not one of the body, or if the fraction is out of range.
    #[inline]
    pub fn new(shape: [usize; 2], [first, row]: [usize; 2], fraction: f64) -> Self {
        assert!(first < shape[0] && row < shape[1], "a cell of the body");
        assert!((0.0..1.0).contains(&fraction), "a fraction of a column");
        Self { first, across: (shape[1] - row) % shape[1], fraction, shape }
    }

    /// Creates the placement of a contact that covers all cells of a body of shape `shape`.
    #[inline]
    pub fn flush(shape: [usize; 2]) -> Self {
        Self::new(shape, [0; 2], 0.0)
    }

    /// Shape of the body's grid.
    #[inline]
    pub fn shape(&self) -> [usize; 2] {
        self.shape
    }

    /// Gathers the part of a body field under a contact `columns` wide.
    #[inline]
    pub fn under(&self, field: &Field, columns: usize) -> Field {
        let mut under = Field::zeros([columns, self.shape[1]]);
        for (j, mut row) in under.outer_iter_mut().enumerate() {
            self.for_column(field, j, row.as_slice_mut().expect("standard layout"), |at, value| *at = value);
        }
        under
    }

    /// Scatters a field on the contact to the body, 0 beside it. The sum is preserved.
    #[inline]
    pub fn onto(&self, field: &Field) -> Field {
        let mut onto = Field::zeros(self.shape);
        let cells = onto.as_slice_mut().expect("standard layout");
        for (cell, value) in field.iter().enumerate().filter(|(_, value)| **value != 0.0) {
            self.parts(self.cell(cell)).for_each(|(cell, weight)| cells[cell] += weight * value);
        }
        onto
    }

    /// Flat cell of the body under a flat cell of the contact; the first one if the contact cell lies between
    /// two.
    #[inline]
    pub fn cell(&self, cell: usize) -> usize {
        let [columns, width] = self.shape;
        let across = cell % width + width - self.across;
        (self.first + cell / width) % columns * width + if across < width { across } else { across - width }
    }

    /// Fraction of a column by which the contact is displaced from the columns of the body.
    #[inline]
    pub fn fraction(&self) -> f64 {
        self.fraction
    }

    /// Iterates over the one or two flat cells of the body under a cell of the contact, with their weights.
    #[inline]
    pub fn parts(&self, cell: usize) -> impl Iterator<Item = (usize, f64)> + use<> {
        let count = if self.fraction == 0.0 { 1 } else { 2 };
        [(cell, 1.0 - self.fraction), (self.next(cell), self.fraction)].into_iter().take(count)
    }

    /// Flat cell that follows a flat cell of the body along x.
    fn next(&self, cell: usize) -> usize {
        let [columns, width] = self.shape;
        (cell + width) % (columns * width)
    }

    /// Gathers the value of a body under a flat cell of the contact.
    #[inline]
    pub fn value(&self, values: &CellValues, cell: usize) -> f64 {
        match values {
            CellValues::Uniform(value) => *value,
            CellValues::Field(_) if self.fraction == 0.0 => values.value(cell),
            CellValues::Field(_) => self.parts(cell).map(|(cell, weight)| weight * values.value(cell)).sum(),
        }
    }

    /// Gathers the values of a body under all cells of the contact in its column `j`.
    #[inline]
    pub fn fill(&self, values: &CellValues, j: usize, row: &mut [f64]) {
        match values {
            CellValues::Uniform(value) => row.fill(*value),
            CellValues::Field(values) => self.for_column(values, j, row, |at, value| *at = value),
        }
    }

    /// Gathers the values of a body under all cells of the contact in its column `j`, combined with `row` by
    /// `change`.
    pub fn for_column(&self, values: &Field, j: usize, row: &mut [f64], change: impl Fn(&mut f64, f64)) {
        // A shift along y starts with the last cells.
        let column = |ahead: usize| {
            let column = values.row((self.first + j + ahead) % self.shape[0]);
            let (most, last) = column.split_at(ndarray::Axis(0), self.shape[1] - self.across);
            last.into_iter().chain(most)
        };
        if self.fraction == 0.0 {
            row.iter_mut().zip(column(0)).for_each(|(at, value)| change(at, *value));
        } else {
            let (near, far) = (1.0 - self.fraction, self.fraction);
            let both = column(0).zip(column(1));
            row.iter_mut().zip(both).for_each(|(at, (one, next))| change(at, near * one + far * next));
        }
    }
}
