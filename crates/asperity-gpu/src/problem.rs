//! The contact that is solved: its grids, gaps, bounds and control.

use std::f64::consts::TAU;

use asperity_base::grid::{CellValues, Field};
use asperity_base::units::{Metre, Pascal};

/// Contacts of one pitch and one pair of bodies that are solved together: their cells, and what presses them.
pub struct Problem<'a> {
    /// The contacts. They share the approach, and carry the load together.
    pub contacts: &'a [Contact<'a>],
    /// The grid of these contacts and the next coarser ones, from fine to coarse, as many as serve a first
    /// guess. Each has half as many cells along each axis as the one before, rounded up.
    pub grids: &'a [Level],
    /// The load or the approach of the bodies.
    pub control: Control,
    /// How exactly it is solved.
    pub accuracy: Accuracy,
}

/// How exactly a contact is solved.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Accuracy {
    /// Scale-free complementarity residual η at which the contacts are accepted, > 0.
    pub tolerance: f64,
    /// Largest number of convolutions.
    pub max_convolutions: usize,
    /// Precision of pressure, gap and displacement.
    pub precision: Precision,
}

/// One of the contacts that are solved together.
#[derive(Clone, Copy)]
pub struct Contact<'a> {
    /// The undeformed gap h, m, at each cell.
    pub gap: &'a Field,
    /// The largest pressure of each cell, Pa, > 0; infinite for elastic bodies.
    pub upper: &'a CellValues,
    /// A pressure near the solution, Pa, if one is known.
    pub start: Option<&'a Field>,
}

/// The prescribed quantity.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Control {
    /// The sum Σ p of the pressures of all cells, Pa.
    PressureSum(Pascal),
    /// The rigid-body approach δ, m.
    Approach(Metre),
}

/// Precision of pressure, gap and displacement. Search directions and their transforms are in single
/// precision.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Precision {
    /// Double precision. The residual is that of a convolution in double precision.
    #[default]
    Double,
    /// Single precision, with sums in double precision. It takes half of the memory, and reaches a residual
    /// of about 10⁻⁴.
    Single,
}

/// A grid with the displacement of the bodies under pressure.
pub struct Level {
    /// Size of the transforms along x and y: at least the shape of each contact, and twice that along a free
    /// axis.
    pub padded: [usize; 2],
    /// Size of a cell along x and y, m.
    pub pitch: [Metre; 2],
    /// The displacement under pressure.
    pub compliance: Compliance,
    /// The displacement of harmonics, whose inverse is the stiffness of long waves in the preconditioner.
    pub harmonics: Harmonics,
}

/// Displacement of the cells under the pressure of the others.
pub enum Compliance {
    /// The displacement of the [`Harmonics`], along two periodic axes. The mean displacement is 0.
    Harmonic,
    /// The displacement at the distance of `[i, j]` cells per unit pressure on a cell, m/Pa, up to half of
    /// the padded shape.
    Influence(Field),
}

/// Displacement per unit pressure of harmonics.
pub enum Harmonics {
    /// 2/(E* |q|) for the composite modulus E* of half-spaces.
    HalfSpaces(Pascal),
    /// The displacement per unit pressure, m/Pa, > 0, of the frequencies up to half of the padded shape along
    /// x and y, as rows of one x. In place of the uniform pressure, the first is a wave as long as a cell
    /// along x.
    Table(Field),
}

/// The contacts in equilibrium.
#[derive(Debug, Clone)]
pub struct Solution {
    /// Pressure p, Pa, and displacement u, m, of each contact.
    pub fields: Vec<[Field; 2]>,
    /// The rigid-body approach δ, m.
    pub approach: Metre,
    /// Scale-free complementarity residual η of all contacts together.
    pub residual: f64,
    /// Displacement c₀ of a cell per unit pressure on itself, m/Pa.
    pub self_influence: f64,
    /// Cost.
    pub cost: Cost,
}

/// A periodic self-affine surface that is made on the device, and never leaves it. Its waves have random
/// amplitudes and phases, which depend on the seed and on the number of waves along x and y: on a finer grid
/// it is the same surface.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Rough {
    /// Number of cells along x and y, the same, an even number.
    pub side: usize,
    /// Size of a cell, m.
    pub pitch: Metre,
    /// Hurst exponent H: the power spectrum falls as q^(−2 − 2H).
    pub hurst: f64,
    /// Wavelength above which the power spectrum is constant, m.
    pub longest: Metre,
    /// Shortest wavelength, m.
    pub shortest: Metre,
    /// Root mean square of the slope.
    pub slope: f64,
    /// Seed.
    pub seed: u64,
}

/// A contact of a [`Rough`] surface, of which only numbers are kept.
#[derive(Debug, Clone, PartialEq)]
pub struct Statistics {
    /// Share of the cells in contact.
    pub area: f64,
    /// Mean of the deformed gap, m.
    pub mean_gap: Metre,
    /// Largest pressure, Pa.
    pub max_pressure: Pascal,
    /// Number of cells in contact by pressure: bins of the same width from 0 to the pressure asked for. Those
    /// above are in the last.
    pub histogram: Vec<u64>,
    /// Scale-free complementarity residual η.
    pub residual: f64,
    /// Cost.
    pub cost: Cost,
    /// Time, s, of the surface, and of the solution with its memory and plans.
    pub times: [f64; 2],
    /// Memory of the finest grid over its number of cells, bytes.
    pub bytes_a_cell: f64,
}

/// The cost of a solution.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Cost {
    /// Conjugate gradient steps on the grid of the contacts.
    pub iterations: usize,
    /// Convolutions, and preconditioned residuals, each of which takes as long; on a coarse grid they count
    /// by its share of cells.
    pub convolutions: f64,
    /// Returns to the last feasible pressure for lack of progress.
    pub restarts: usize,
}

impl Level {
    /// Returns the angular wavenumber of the first frequency along each axis.
    pub(crate) fn wavenumbers(&self) -> [f64; 2] {
        [0, 1].map(|axis| TAU / (self.padded[axis] as f64 * self.pitch[axis]))
    }

    /// Returns the displacement of a cell per unit pressure on itself, from the one that its convolution
    /// `found`. A single periodic cell has none, because its mean is free; the displacement of a wave of this
    /// length then serves as a scale.
    pub(crate) fn self_influence(&self, found: f64) -> f64 {
        if found > 0.0 {
            return found;
        }
        match &self.harmonics {
            Harmonics::HalfSpaces(modulus) => 2.0 / (modulus * TAU / self.pitch[0]),
            Harmonics::Table(table) => table[[0, 0]],
        }
    }
}
