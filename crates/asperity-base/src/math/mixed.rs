//! Objects in two precisions.

use std::sync::{Arc, OnceLock};

/// An object D in double precision, and on first use S in single precision. Several may share it.
pub struct Mixed<D, S> {
    double: Arc<D>,
    single: OnceLock<Arc<S>>,
}

impl<D, S> Mixed<D, S> {
    /// Creates both from the one in double precision.
    pub fn new(double: D) -> Self {
        Self { double: Arc::new(double), single: OnceLock::new() }
    }

    /// Returns the object in double precision.
    pub fn double(&self) -> Arc<D> {
        Arc::clone(&self.double)
    }

    /// Returns the object in single precision.
    pub fn single(&self, to_single: impl FnOnce(&D) -> S) -> Arc<S> {
        Arc::clone(self.single.get_or_init(|| Arc::new(to_single(&self.double))))
    }
}

/// Holds the object for the precision that was used last. A change of precision replaces it.
pub enum LastUsed<D, S> {
    /// Nothing has been used.
    None,
    /// The object for double precision.
    Double(D),
    /// The object for single precision.
    Single(S),
}

impl<D, S> LastUsed<D, S> {
    /// Returns the object for double precision. If necessary, it releases that for single precision, and
    /// `new` creates it.
    pub fn double(&mut self, new: impl FnOnce() -> D) -> &mut D {
        if !matches!(self, Self::Double(_)) {
            *self = Self::None;
            *self = Self::Double(new());
        }
        let Self::Double(latest) = self else { unreachable!("just made") };
        latest
    }

    /// Returns the object for single precision. If necessary, it releases that for double precision, and
    /// `new` creates it.
    pub fn single(&mut self, new: impl FnOnce() -> S) -> &mut S {
        if !matches!(self, Self::Single(_)) {
            *self = Self::None;
            *self = Self::Single(new());
        }
        let Self::Single(latest) = self else { unreachable!("just made") };
        latest
    }
}
