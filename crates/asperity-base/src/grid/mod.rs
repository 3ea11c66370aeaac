//! Regular grids and the fields on them.

mod finite; // the check of all results
mod placement;
mod spots; // connected cells

pub use finite::check_finite;
pub use placement::Placement;
pub use spots::Spots;

use std::borrow::Cow;

use crate::error::{Error, Result};
use crate::units::{Dimension, Metre, SquareMetre};

/// Values on the cells of a [`Grid`], indexed `[ix, iy]`, `iy` fastest in memory.
pub type Field = ndarray::Array2<f64>;

/// A [`Field`] in single precision, for low-accuracy quantities such as the directions of an iteration.
pub type SingleField = ndarray::Array2<f32>;

/// Returns the values of a field by flat index.
#[inline]
pub fn flat<T>(field: &ndarray::Array2<T>) -> &[T] {
    field.as_slice().expect("standard layout")
}

/// Returns a field in standard layout, in which [`flat`] reads it; a copy of one whose memory has another
/// order.
#[inline]
pub fn in_rows<T: Clone>(field: &ndarray::Array2<T>) -> Cow<'_, ndarray::Array2<T>> {
    if field.is_standard_layout() {
        Cow::Borrowed(field)
    } else {
        Cow::Owned(field.as_standard_layout().into_owned())
    }
}

/// Returns the length of `count` cells, without the rounding of a product where a metre has a whole number of
/// cells.
///
/// ```
/// assert_eq!(asperity_base::grid::length_of(115.0, 5e-7), 5.75e-5);
/// assert_eq!(115.0 * 5e-7, 5.7499999999999995e-5);
/// ```
pub fn length_of(count: f64, pitch: Metre) -> Metre {
    let per_metre = pitch.recip().round();
    if per_metre.recip() == pitch { count / per_metre } else { count * pitch }
}

/// Returns the mutable values of a field by flat index.
#[inline]
pub fn flat_mut<T>(field: &mut ndarray::Array2<T>) -> &mut [T] {
    field.as_slice_mut().expect("standard layout")
}

/// A quantity on the cells of a grid: one value for all cells, or one for each.
#[derive(Debug, Clone, PartialEq)]
pub enum CellValues {
    /// The same value in every cell.
    Uniform(f64),
    /// A value for each cell.
    Field(Field),
}

impl CellValues {
    /// Returns the values with a field in standard layout.
    #[inline]
    pub fn in_rows(self) -> Self {
        match self {
            Self::Field(field) if !field.is_standard_layout() => {
                Self::Field(field.as_standard_layout().into_owned())
            }
            values => values,
        }
    }

    /// Returns the common value of all cells; `None` if they are given as a field.
    #[inline]
    pub fn uniform(&self) -> Option<f64> {
        match self {
            Self::Uniform(value) => Some(*value),
            Self::Field(_) => None,
        }
    }

    /// Returns the value at the flat index `cell`.
    ///
    /// # Panics
    /// If there is no such cell, or if a field is not in standard layout.
    #[inline]
    pub fn value(&self, cell: usize) -> f64 {
        match self {
            Self::Uniform(value) => *value,
            Self::Field(field) => field.as_slice().expect("standard layout")[cell],
        }
    }

    /// Returns the smallest value.
    #[inline]
    pub fn min(&self) -> f64 {
        self.fold(f64::INFINITY, f64::min)
    }

    /// Returns the largest value.
    #[inline]
    pub fn max(&self) -> f64 {
        self.fold(f64::NEG_INFINITY, f64::max)
    }

    /// Returns the sum over `cells` cells.
    #[inline]
    pub fn sum(&self, cells: usize) -> f64 {
        match self {
            Self::Uniform(value) => *value * cells as f64,
            Self::Field(field) => field.sum(),
        }
    }

    /// Returns whether the values fit a grid of shape `shape`.
    #[inline]
    pub fn fits(&self, shape: [usize; 2]) -> bool {
        match self {
            Self::Uniform(_) => true,
            Self::Field(field) => field.dim() == (shape[0], shape[1]),
        }
    }

    /// Applies `change` to each value.
    #[inline]
    pub fn map(&self, change: impl Fn(f64) -> f64) -> Self {
        match self {
            Self::Uniform(value) => Self::Uniform(change(*value)),
            Self::Field(field) => Self::Field(field.mapv(change)),
        }
    }

    /// Returns the mean over `cells` cells.
    #[inline]
    pub fn mean(&self, cells: usize) -> f64 {
        match self {
            Self::Uniform(value) => *value,
            Self::Field(field) => field.sum() / cells as f64,
        }
    }

    /// Returns the values on a grid of about half as many cells along each axis. A value is the mean over the
    /// fine cells in a coarse cell.
    #[inline]
    pub fn coarse(&self) -> Self {
        match self {
            Self::Uniform(value) => Self::Uniform(*value),
            Self::Field(field) => Self::Field(coarse_means(field)),
        }
    }

    fn fold(&self, first: f64, both: fn(f64, f64) -> f64) -> f64 {
        match self {
            Self::Uniform(value) => *value,
            Self::Field(field) => field.iter().copied().fold(first, both),
        }
    }
}

impl From<f64> for CellValues {
    fn from(value: f64) -> Self {
        Self::Uniform(value)
    }
}

impl From<Field> for CellValues {
    fn from(field: Field) -> Self {
        Self::Field(field)
    }
}

/// Means of 2 × 2 cells, or of the cells left at the end of an odd number.
#[inline]
pub fn coarse_means(fine: &Field) -> Field {
    let (nx, ny) = fine.dim();
    let cells = fine.as_slice().expect("standard layout");
    Field::from_shape_fn([nx.div_ceil(2), ny.div_ceil(2)], |(i, j)| {
        // At the end of an odd number the last row or column is counted twice.
        let (rows, columns) = ([2 * i, (2 * i + 1).min(nx - 1)], [2 * j, (2 * j + 1).min(ny - 1)]);
        let sum = |row: usize| cells[row * ny + columns[0]] + cells[row * ny + columns[1]];
        0.25 * (sum(rows[0]) + sum(rows[1]))
    })
}

/// Largest number of cells of a grid, at which a field takes 32 GiB; `usize::MAX` on 32-bit machines.
pub const MAX_CELLS: usize = if usize::BITS > 32 { (1_u64 << 32) as usize } else { usize::MAX };

/// A regular grid of rectangular cells.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Grid {
    /// Number of cells along x and y.
    pub shape: [usize; 2],
    /// Size of a cell along x and y.
    pub pitch: [Metre; 2],
}

impl Grid {
    /// Creates a grid of `shape` cells of size `pitch`.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] if there are no cells or more than [`MAX_CELLS`], or if a pitch is not positive
    /// or is outside [`Dimension::range`].
    pub fn new(shape: [usize; 2], pitch: [Metre; 2]) -> Result<Self> {
        if shape.contains(&0) {
            return Err(Error::OutOfRange {
                quantity: "shape",
                dimension: None,
                value: 0.0,
                expected: "at least one cell along x and y".into(),
            });
        }
        let cells = shape[0].checked_mul(shape[1]).filter(|cells| *cells <= MAX_CELLS);
        if cells.is_none() {
            let value = shape[0] as f64 * shape[1] as f64;
            return Err(Error::OutOfRange {
                quantity: "shape",
                dimension: None,
                value,
                expected: "at most 2³² cells".into(),
            });
        }
        if let Some(&value) = pitch.iter().find(|p| !Dimension::Length.range().holds(**p)) {
            let expected = "a positive length of 1e-15 … 1e6 m".into();
            return Err(Error::OutOfRange {
                quantity: "pitch",
                dimension: Some(Dimension::Length),
                value,
                expected,
            });
        }
        Ok(Self { shape, pitch })
    }

    /// Number of cells.
    #[inline]
    pub fn cells(&self) -> usize {
        self.shape[0] * self.shape[1]
    }

    /// Area ΔA of one cell.
    #[inline]
    pub fn cell_area(&self) -> SquareMetre {
        self.pitch[0] * self.pitch[1]
    }

    /// Area of the whole grid: the apparent area of a contact on it.
    #[inline]
    pub fn area(&self) -> SquareMetre {
        self.cell_area() * self.cells() as f64
    }

    /// Lengths of the grid along x and y.
    #[inline]
    pub fn extent(&self) -> [Metre; 2] {
        [self.pitch[0] * self.shape[0] as f64, self.pitch[1] * self.shape[1] as f64]
    }

    /// Position of the centre of cell `index` along `axis`, from the grid's corner.
    #[inline]
    pub fn centre(&self, axis: usize, index: usize) -> Metre {
        (index as f64 + 0.5) * self.pitch[axis]
    }

    /// Creates a field of zeros on this grid.
    #[inline]
    pub fn zeros(&self) -> Field {
        Field::zeros(self.shape)
    }
}
