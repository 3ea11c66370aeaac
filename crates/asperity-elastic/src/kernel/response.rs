//! Response of a pair of bodies to a traction.

use std::fmt::Debug;
use std::ops::Deref;
use std::sync::Arc;

use crate::grid::Field;
use crate::kernel::{Coefficients, Line};
use crate::math::parallel;
use crate::units::{Metre, Pascal};

/// Normal displacement of a pair of bodies under a normal pressure.
///
/// It depends only on the distance: the bodies are uniform along the surface and infinitely deep. A periodic
/// boundary uses its harmonics, a free boundary its cells, and the preconditioner of the solvers its
/// harmonics. For free boundaries alone the harmonics may be approximate, because only the preconditioner
/// uses them.
///
/// If only the harmonics are known, [`crate::kernel::Layering`] computes the cells.
pub trait Response: Debug + Send + Sync {
    /// Returns the displacement per unit pressure of the harmonic of angular wavenumber `(qx, qy)`, m/Pa. It
    /// is above 0, and 0 at q = 0, where the displacement of a periodic surface is free.
    fn harmonic_displacement(&self, qx: f64, qy: f64) -> f64;

    /// Returns the displacement per unit pressure on a cell of size `pitch`, m/Pa.
    fn influence(&self, pitch: [Metre; 2]) -> Box<dyn Influence>;

    /// Returns the displacement per unit pressure on each cell of size `pitch` in a `line`, m/Pa; `None` if
    /// it is unknown. A boundary with a single periodic axis is then not available.
    fn line_influence(&self, line: &Line, pitch: [Metre; 2]) -> Option<Box<dyn Influence>> {
        let _ = (line, pitch);
        None
    }

    /// Returns the composite modulus E* of homogeneous half-spaces, whose harmonics have the displacement
    /// 2/(E* |q|); `None` for other bodies.
    fn half_space_modulus(&self) -> Option<Pascal> {
        None
    }

    /// Returns the displacement in all directions under a traction in any direction; `None` if it is unknown.
    /// Friction is then limited to full sliding without normal displacement.
    fn coupled(&self) -> Option<&dyn CoupledResponse> {
        None
    }
}

/// Displacement of a pair of bodies in all directions under a traction in any direction.
pub trait CoupledResponse: Send + Sync {
    /// Whether a pressure displaces tangentially and a shear normally.
    fn couples(&self) -> bool;

    /// Returns the displacements per unit traction of the harmonic of angular wavenumber `(qx, qy)`, m/Pa, and zeros
    /// at q = 0, where the displacement of a periodic surface is free. zx and zy are the imaginary parts of
    /// purely imaginary coefficients.
    fn harmonic_displacements(&self, qx: f64, qy: f64) -> Coefficients;

    /// Returns the displacements per unit traction on a cell of size `pitch`, m/Pa.
    fn coupled_influence(&self, pitch: [Metre; 2]) -> Box<CoupledInfluence>;

    /// Returns the displacements per unit traction on each cell of size `pitch` in a `line`, m/Pa; `None` if they are
    /// unknown.
    fn coupled_line_influence(&self, line: &Line, pitch: [Metre; 2]) -> Option<Box<CoupledInfluence>> {
        let _ = (line, pitch);
        None
    }
}

/// Displacements at `(x, y)` per unit traction on a cell centred at the origin, m/Pa.
pub type CoupledInfluence = dyn Fn(Metre, Metre) -> Coefficients + Send + Sync;

/// Normal displacement around a loaded cell centred at the origin.
pub trait Influence: Send + Sync {
    /// Returns the displacement at `(x, y)` per unit pressure on the cell, m/Pa; it is even in x and in y.
    fn displacement(&self, x: Metre, y: Metre) -> f64;

    /// Returns the displacements of all cells `[i, j]` at the offsets `(i Δx, j Δy)`, m/Pa.
    fn table(&self, shape: [usize; 2], pitch: [Metre; 2]) -> Field {
        parallel::field(shape, |i, j| self.displacement(i as f64 * pitch[0], j as f64 * pitch[1]))
    }
}

impl<F: Fn(Metre, Metre) -> f64 + Send + Sync> Influence for F {
    fn displacement(&self, x: Metre, y: Metre) -> f64 {
        self(x, y)
    }
}

/// A response shared by all operators of a pair. Any [`Response`] converts to it. A composite modulus E* and
/// the [`Compliances`](crate::material::Compliances) of a pair convert to the response of
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
