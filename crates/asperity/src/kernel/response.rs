//! What a pair of bodies answers to a traction.

use std::fmt::Debug;
use std::ops::Deref;
use std::sync::Arc;

use crate::grid::Field;
use crate::kernel::{Coefficients, Line};
use crate::math::parallel;
use crate::units::Metre;

/// What a normal pressure does to the surfaces of a pair of bodies in the normal direction.
///
/// It depends on the distance alone: the bodies are the same at all places, and as deep as wide. A periodic boundary takes it
/// by its harmonics, a free one by its cells, and the preconditioner of the solvers by its harmonics. Where one boundary alone
/// is of interest, the other form may be rough: harmonics then only precondition.
///
/// A body whose harmonics alone are known has its cells by [`crate::kernel::Layering`].
pub trait Response: Debug + Send + Sync {
    /// Displacement per unit pressure of the harmonic of angular wavenumber `(qx, qy)`, m/Pa: above 0, and 0 at q = 0, where
    /// the displacement of what repeats itself is free.
    fn harmonic_displacement(&self, qx: f64, qy: f64) -> f64;

    /// Displacement per unit pressure on a cell of size `pitch`, m/Pa.
    fn influence(&self, pitch: [Metre; 2]) -> Box<dyn Influence>;

    /// Displacement per unit pressure on each of the cells of size `pitch` that stand in a `line`, m/Pa; `None` where it is
    /// not known, so that there is no boundary that is periodic along one axis alone.
    fn line_influence(&self, line: &Line, pitch: [Metre; 2]) -> Option<Box<dyn Influence>> {
        let _ = (line, pitch);
        None
    }

    /// What a traction in any direction does in all directions; `None` where it is not known, so that there is no friction
    /// but that of full sliding which displaces nothing normally.
    fn coupled(&self) -> Option<&dyn CoupledResponse> {
        None
    }
}

/// What a traction in any direction does to the surfaces of a pair of bodies, in the order and with the signs of
/// [`Coefficients`].
pub trait CoupledResponse: Send + Sync {
    /// Whether a pressure displaces tangentially and a shear normally: not if all zx and zy are 0.
    fn couples(&self) -> bool;

    /// Displacements per unit traction of the harmonic of angular wavenumber `(qx, qy)`, m/Pa, 0 at q = 0; zx and zy are the
    /// imaginary parts of what has no real one.
    fn harmonic_displacements(&self, qx: f64, qy: f64) -> Coefficients;

    /// Displacement at `(x, y)` per unit traction on the cell of size `pitch` centred at the origin, m/Pa.
    fn displacement(&self, x: Metre, y: Metre, pitch: [Metre; 2]) -> Coefficients;

    /// Displacement at `(x, y)` per unit traction on each of the cells of size `pitch` that stand in a `line`, of which one is
    /// centred at the origin, m/Pa; `None` where it is not known.
    fn line_displacement(&self, line: &Line, x: Metre, y: Metre, pitch: [Metre; 2]) -> Option<Coefficients>;
}

/// Normal displacement around a loaded cell that is centred at the origin.
pub trait Influence: Send + Sync {
    /// Displacement at `(x, y)` per unit pressure on the cell, m/Pa: even in x and in y.
    fn at(&self, x: Metre, y: Metre) -> f64;

    /// Displacements of all cells `[i, j]` at the offsets `(i Δx, j Δy)`, m/Pa.
    fn table(&self, shape: [usize; 2], pitch: [Metre; 2]) -> Field {
        parallel::field(shape, |i, j| self.at(i as f64 * pitch[0], j as f64 * pitch[1]))
    }
}

impl<F: Fn(Metre, Metre) -> f64 + Send + Sync> Influence for F {
    fn at(&self, x: Metre, y: Metre) -> f64 {
        self(x, y)
    }
}

/// A response that all operators of a pair share. It is made of any [`Response`]; of a composite modulus E* or the
/// [`Compliances`](crate::material::Compliances) of a pair it is that of
/// [`HalfSpaces`](crate::kernel::HalfSpaces).
#[derive(Debug, Clone)]
pub struct SharedResponse(Arc<dyn Response>);

impl Deref for SharedResponse {
    type Target = dyn Response;

    fn deref(&self) -> &Self::Target {
        self.0.as_ref()
    }
}

impl<R: Response + 'static> From<R> for SharedResponse {
    fn from(response: R) -> Self {
        Self(Arc::new(response))
    }
}
