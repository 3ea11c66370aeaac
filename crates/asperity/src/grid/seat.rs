//! Where the cells of a contact lie on a body: the one place that maps them to each other.

use super::{CellValues, Field};

/// How the cells of a contact lie on those of one of the bodies.
///
/// A cell of the contact lies on one cell of the body, or between two along x: the surface there is the mean of both by their
/// weights. What is done to the cell of the contact comes back to the body by the same weights, whose sum is 1, so that nothing
/// is lost or gained on the way.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Seat {
    /// The body's column under the first one of the contact.
    first: usize,
    /// Cells by which the body is displaced along y.
    across: usize,
    fraction: f64,
    /// Columns and width of the body.
    shape: [usize; 2],
}

impl Seat {
    /// A contact on a body of this `shape` that begins on its cell `[column, row]`, counted cyclically, and lies by a `fraction` of a
    /// column, from 0, below 1, beyond it.
    ///
    /// # Panics
    /// If the cell is not one of the body, or the fraction none.
    pub fn new(shape: [usize; 2], [first, row]: [usize; 2], fraction: f64) -> Self {
        assert!(first < shape[0] && row < shape[1], "a cell of the body");
        assert!((0.0..1.0).contains(&fraction), "a fraction of a column");
        Self { first, across: (shape[1] - row) % shape[1], fraction, shape }
    }

    /// A contact on all cells of a body of this `shape`.
    pub fn flush(shape: [usize; 2]) -> Self {
        Self::new(shape, [0; 2], 0.0)
    }

    /// Cells of the body.
    pub(crate) fn shape(&self) -> [usize; 2] {
        self.shape
    }

    /// Of a field on the body what lies under a contact of so many `columns`.
    pub(crate) fn under(&self, field: &Field, columns: usize) -> Field {
        let mut under = Field::zeros([columns, self.shape[1]]);
        for (j, mut row) in under.outer_iter_mut().enumerate() {
            self.for_column(field, j, row.as_slice_mut().expect("standard layout"), |at, value| *at = value);
        }
        under
    }

    /// What a field on the contact is on the body, 0 beside it: the sum is that of the field.
    pub(crate) fn onto(&self, field: &Field) -> Field {
        let mut onto = Field::zeros(self.shape);
        let cells = onto.as_slice_mut().expect("standard layout");
        for (cell, value) in field.iter().enumerate().filter(|(_, value)| **value != 0.0) {
            self.parts(self.cell(cell)).for_each(|(cell, weight)| cells[cell] += weight * value);
        }
        onto
    }

    /// The flat cell of the body under a flat cell of the contact, or the first of two.
    pub(crate) fn cell(&self, cell: usize) -> usize {
        let [columns, width] = self.shape;
        let across = cell % width + width - self.across;
        (self.first + cell / width) % columns * width + if across < width { across } else { across - width }
    }

    /// Part of a column by which the contact lies beyond the columns of the body.
    pub(crate) fn fraction(&self) -> f64 {
        self.fraction
    }

    /// A flat cell of the body under the contact, and the next one where the contact lies between both, with their weights.
    pub(crate) fn parts(&self, cell: usize) -> impl Iterator<Item = (usize, f64)> + use<> {
        let count = if self.fraction == 0.0 { 1 } else { 2 };
        [(cell, 1.0 - self.fraction), (self.next(cell), self.fraction)].into_iter().take(count)
    }

    /// The flat cell beyond a flat cell of the body along x.
    fn next(&self, cell: usize) -> usize {
        let [columns, width] = self.shape;
        (cell + width) % (columns * width)
    }

    /// The values of a body where a flat cell of it lies under the contact.
    pub(crate) fn value(&self, values: &CellValues, cell: usize) -> f64 {
        match values {
            CellValues::Uniform(value) => *value,
            CellValues::Field(_) if self.fraction == 0.0 => values.at(cell),
            CellValues::Field(_) => self.parts(cell).map(|(cell, weight)| weight * values.at(cell)).sum(),
        }
    }

    /// The values of a body on all cells of the contact in its column `j`.
    pub(crate) fn fill(&self, values: &CellValues, j: usize, row: &mut [f64]) {
        match values {
            CellValues::Uniform(value) => row.fill(*value),
            CellValues::Field(values) => self.for_column(values, j, row, |at, value| *at = value),
        }
    }

    /// The values of a body on all cells of the contact in its column `j`, each as `change` makes it of what stands in `row`.
    pub(crate) fn for_column(
        &self,
        values: &Field,
        j: usize,
        row: &mut [f64],
        change: impl Fn(&mut f64, f64),
    ) {
        // What is displaced by some cells begins with the last ones.
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
