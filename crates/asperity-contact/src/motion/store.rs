//! How a course keeps the state from which its next step begins, whatever keeps it: a file, or memory.

use std::any::Any;

use crate::error::Result;
use crate::grid::Field;
use crate::motion::law::Sums;
use crate::motion::pair::Pair;

/// Everything that the next step of a course depends on. A course that is resumed from it continues with the
/// same bits.
pub trait CourseState: Any {
    /// Keeps the state.
    fn store(&self, to: &mut dyn StateWriter);
}

/// Keeps the parts of a state by their names.
pub trait StateWriter {
    /// Keeps a field on the grid of its body, with its unit.
    fn field(&mut self, name: &str, unit: &str, values: &Field);

    /// Keeps a list of numbers along an `axis`, with their unit. An empty list is not kept.
    fn series(&mut self, name: &str, unit: &str, axis: &str, values: &[f64]);

    /// Keeps a number.
    fn number(&mut self, name: &str, value: f64);

    /// Keeps a count.
    fn count(&mut self, name: &str, value: usize);

    /// Keeps the components of a vector in the plane.
    fn vector(&mut self, name: &str, value: [f64; 2]);

    /// Keeps two bodies: their heights, their hardness if it is a map, and the state that laws store with
    /// them.
    fn bodies(&mut self, pair: &Pair);
}

/// Returns the parts of a state by their names.
pub trait StateReader {
    /// Whether there is a field, a list or a number of this name.
    fn holds(&self, name: &str) -> bool;

    /// Returns a field.
    ///
    /// # Errors
    /// [`Error::File`](crate::Error::File) if it is missing, or no field.
    fn field(&self, name: &str) -> Result<Field>;

    /// Returns a list of numbers; empty if it is missing.
    ///
    /// # Errors
    /// [`Error::File`](crate::Error::File).
    fn series(&self, name: &str) -> Result<Vec<f64>>;

    /// Returns a number or a count.
    ///
    /// # Errors
    /// [`Error::File`](crate::Error::File) if it is missing, or no number.
    fn number(&self, name: &str) -> Result<f64>;

    /// Returns the components of a vector in the plane.
    ///
    /// # Errors
    /// [`Error::File`](crate::Error::File) if it is missing, or no vector.
    fn vector(&self, name: &str) -> Result<[f64; 2]>;

    /// Gives the bodies of a `pair` the heights and the state of laws that are kept. Their hardness stays.
    ///
    /// # Errors
    /// [`Error::File`](crate::Error::File).
    fn bodies(&self, pair: &mut Pair) -> Result<()>;
}

/// Keeps two fields along x and y.
pub(super) fn store_both(to: &mut dyn StateWriter, name: &str, unit: &str, [x, y]: &[Field; 2]) {
    to.field(&format!("{name}_x"), unit, x);
    to.field(&format!("{name}_y"), unit, y);
}

/// Returns two fields along x and y.
pub(super) fn restore_both(from: &dyn StateReader, name: &str) -> Result<[Field; 2]> {
    Ok([from.field(&format!("{name}_x"))?, from.field(&format!("{name}_y"))?])
}

/// Returns an optional part of a state, which is there if there is something of this `name`.
pub(super) fn restore_if<T>(
    from: &dyn StateReader,
    name: &str,
    restore: impl FnOnce() -> Result<T>,
) -> Result<Option<T>> {
    from.holds(name).then(restore).transpose()
}

/// Keeps the sums of laws, each as a field `NAME_BODY_LAW_INDEX`.
pub(super) fn store_sums(to: &mut dyn StateWriter, name: &str, sums: &[Sums]) {
    for (law, sums) in sums.iter().enumerate() {
        for (body, of_body) in sums.iter().enumerate() {
            for (index, values) in of_body.iter().enumerate() {
                to.field(&sum_name(name, law, body, index), "1", values);
            }
        }
    }
}

/// Returns the sums of laws.
pub(super) fn restore_sums(from: &dyn StateReader, name: &str) -> Result<Vec<Sums>> {
    let of_body = |law: usize, body: usize| {
        let names = (0..).map(|index| sum_name(name, law, body, index));
        names.take_while(|name| from.holds(name)).map(|name| from.field(&name)).collect::<Result<Vec<_>>>()
    };
    let laws = (0..).take_while(|law| from.holds(&sum_name(name, *law, 0, 0)));
    laws.map(|law| Ok([of_body(law, 0)?, of_body(law, 1)?])).collect()
}

/// Name of the field with a sum of a law over a body; all indices are counted from 0.
fn sum_name(name: &str, law: usize, body: usize, index: usize) -> String {
    format!("{name}_{}_{}_{}", ["lower", "upper"][body], law + 1, index + 1)
}
