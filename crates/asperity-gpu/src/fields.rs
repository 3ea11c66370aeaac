//! The operations that a contact needs of a device.

use asperity_base::error::Result;
use asperity_base::grid::Field;
use asperity_base::units::{Metre, Pascal};

use crate::problem::{Contact, Level, Precision, Rough};

/// A device on which contacts are solved.
pub(crate) trait Device {
    /// Gap and upper bounds of all contacts on one grid.
    type Gaps;
    /// All fields of the contacts on one grid.
    type Fields: Fields;
    /// The pressures alone.
    type Pressure;

    /// Places the gaps and the upper bounds of the contacts on the device.
    fn gaps(&self, contacts: &[Contact], precision: Precision) -> Result<Self::Gaps>;

    /// Makes a rough surface on the device. Returns the gap between its highest summit and a plane, without
    /// an upper bound.
    fn rough(&self, rough: &Rough, level: &Level, precision: Precision) -> Result<Self::Gaps>;

    /// Returns gaps and upper bounds on a grid of half as many cells along each axis: means of 2 × 2 cells,
    /// of which those at the end of an odd number count twice.
    fn coarse(&self, fine: &Self::Gaps) -> Result<Self::Gaps>;

    /// Creates the fields of a grid. Pressure and displacement have no value yet.
    fn fields(&self, gaps: Self::Gaps, level: &Level) -> Result<Self::Fields>;

    /// Keeps the pressure alone.
    fn pressure_of(&self, fields: Self::Fields) -> Result<Self::Pressure>;

    /// Sets the pressure of each cell to that of the coarse cell that covers it.
    fn prolong(&self, coarse: &Self::Pressure, fine: &mut Self::Fields) -> Result<()>;
}

/// The fields of contacts on one grid, all on the device: the pressure p, the approach t = h + u at which
/// each cell touches, the gap h, upper bounds, the predicted set of each cell, the search direction d, the
/// last feasible pressure, and the padded buffer of the transforms.
///
/// Sums are numbers in double precision, added in the same order in each run. Each operation says what it
/// expects in the buffer, and what it leaves there.
pub(crate) trait Fields {
    /// Number of cells of all contacts.
    fn cells(&self) -> usize;

    /// Returns the displacement c₀ of a cell per unit pressure on itself.
    fn self_influence(&self) -> f64;

    /// Returns the sum of the upper bounds, and the largest one.
    fn upper(&self) -> [Pascal; 2];

    /// Sets the pressure of each contact.
    fn set_pressure(&mut self, pressure: &[&Field]) -> Result<()>;

    /// Sets all pressures to a value.
    fn set_uniform(&mut self, pressure: Pascal) -> Result<()>;

    /// Sets the pressures to `stiffness` (δ − h).
    fn close_alone(&mut self, approach: Metre, stiffness: f64) -> Result<()>;

    /// Multiplies the pressures below their upper bounds by `factor`, and brings all into their bounds.
    /// Returns the sum of all pressures and the sum of those below their upper bounds.
    fn scale_below(&mut self, factor: f64) -> Result<[Pascal; 2]>;

    /// Puts the proposed pressures p + (δ − t)·`stiffness` into the buffer. Returns the least and the
    /// largest.
    fn propose(&mut self, approach: Metre, stiffness: f64) -> Result<[Pascal; 2]>;

    /// Returns the sum of the proposed pressures after an offset and clipping, and the number of cells
    /// strictly between their bounds.
    fn proposed_sum(&mut self, offset: Pascal) -> Result<[f64; 2]>;

    /// Sets the pressures to the proposed ones after an offset and clipping.
    fn accept(&mut self, offset: Pascal) -> Result<()>;

    /// Predicts the sets from the proposed pressures after an offset. Returns the number of free cells, the
    /// number of other cells that are not at their bound, the sum of what these lack, and the sum of the
    /// clipped pressures of the free cells.
    fn predict_sets(&mut self, offset: Pascal) -> Result<[f64; 4]>;

    /// Computes t = h + C p in the precision of the pressure.
    fn convolve(&mut self) -> Result<()>;

    /// Returns Σ p and Σ p t over the cells strictly between their bounds, and the largest t of the capped
    /// cells, −∞ if there are none.
    fn multiplier(&mut self) -> Result<[f64; 3]>;

    /// Returns Σ u, Σ u², the largest |φ|, the largest |p| and the largest |u|, with φ = c₀ (p − clip(p + (δ
    /// − t)/c₀)).
    fn residual(&mut self, approach: Metre) -> Result<[f64; 5]>;

    /// Moves the cells predicted at a bound to it, and adds −`each` − `per_pressure`·p to the free cells,
    /// with the response.
    fn move_to_bounds(&mut self, each: Pascal, per_pressure: f64) -> Result<()>;

    /// Sets the direction to 0. Returns Σ t over the free cells.
    fn reset_direction(&mut self) -> Result<f64>;

    /// Moves p and t by `step` times the direction and its response, which the buffer holds unless the step
    /// is 0. Leaves the residual δ − t of the free cells in the buffer, 0 at the others. Returns the sum of
    /// its squares, the sum of the squared violations of the bounds, and the largest residual.
    fn advance(&mut self, step: f64, datum: Metre) -> Result<[f64; 3]>;

    /// Adapts the preconditioner to the predicted sets, which have so many `free` cells.
    fn adapt(&mut self, free: f64) -> Result<()>;

    /// Replaces the residual r in the buffer by the preconditioned one, z = M r. Returns Σ z, Σ r and Σ r z
    /// over the free cells.
    fn precondition(&mut self, datum: Metre) -> Result<[f64; 3]>;

    /// Sets the direction of the free cells to d = z − `mean` + `beta` d, with z in the buffer, where it
    /// leaves the response C d. Returns Σ d C d and Σ C d over the free cells.
    fn respond(&mut self, mean: f64, beta: f64) -> Result<[f64; 2]>;

    /// Returns Σ p.
    fn pressure_sum(&mut self) -> Result<Pascal>;

    /// Adds the same pressure to all free cells.
    fn add_to_free(&mut self, pressure: Pascal) -> Result<()>;

    /// Adds (δ − t)/`compliance` to each pressure.
    fn step_along_gap(&mut self, approach: Metre, compliance: f64) -> Result<()>;

    /// Keeps the pressure as the last feasible one.
    fn keep(&mut self) -> Result<()>;

    /// Puts the displacement under the last feasible pressure into the buffer.
    fn convolve_kept(&mut self) -> Result<()>;

    /// Returns slope and curvature of the energy at an approach, from the last feasible pressure, whose
    /// displacement the buffer holds, to the present one.
    fn descent(&mut self, approach: Metre) -> Result<[f64; 2]>;

    /// Moves to the fraction `share` of the way from the last feasible pressure, whose displacement the
    /// buffer holds, to the present one.
    fn step_from_kept(&mut self, share: f64) -> Result<()>;

    /// Returns the sum of the deformed gaps at an approach, the number of cells in contact, and the largest
    /// pressure.
    fn statistics(&mut self, approach: Metre) -> Result<[f64; 3]>;

    /// Counts the cells in contact by pressure, in `bins` of this width; those above are in the last.
    fn histogram(&mut self, width: Pascal, bins: usize) -> Result<Vec<u64>>;

    /// Returns the gap of each contact.
    fn gaps(&self) -> Result<Vec<Field>>;

    /// Convolves whatever the buffer holds, in single precision or in that of the pressure, to measure its
    /// time.
    fn multiply(&mut self, single: bool) -> Result<()>;

    /// Returns the memory of the fields, bytes.
    fn bytes(&self) -> usize;

    /// Waits until all operations are done.
    fn wait(&self) -> Result<()>;

    /// Returns pressure and displacement of each contact.
    fn results(&self) -> Result<Vec<[Field; 2]>>;
}
