//! The devices on which contacts are solved.

use asperity_base::error::{Error, Result, check};

#[cfg(feature = "cuda")]
use crate::cuda::Cuda;
use crate::host::Host;
use crate::problem::{Precision, Problem, Solution, Watch};
use crate::{cascade, solver};

/// A device on which contacts are solved.
#[derive(Clone)]
pub struct Device(Kind);

#[derive(Clone)]
enum Kind {
    Host,
    #[cfg(feature = "cuda")]
    Cuda(Cuda),
}

/// What a device is.
#[derive(Debug, Clone, PartialEq)]
pub struct Card {
    /// Its name.
    pub name: String,
    /// Its compute capability, if it is a GPU.
    pub capability: Option<[u32; 2]>,
    /// Its memory, bytes.
    pub memory: f64,
    /// Memory that is free, bytes.
    pub free: f64,
}

impl Device {
    /// The processor in plain loops: slow, and the reference of the other devices.
    pub const HOST: Self = Self(Kind::Host);

    /// Opens the first GPU of NVIDIA.
    ///
    /// # Errors
    /// [`Error::NoDevice`] with what was found, also if the program was built without the feature `cuda`.
    pub fn cuda() -> Result<Self> {
        #[cfg(feature = "cuda")]
        return Cuda::open().map(|cuda| Self(Kind::Cuda(cuda)));
        #[cfg(not(feature = "cuda"))]
        Err(Error::NoDevice {
            device: "cuda",
            found: "a program that was built without the feature `cuda`".to_owned(),
        })
    }

    /// Returns what the device is, with the memory that is free now; none for the processor.
    ///
    /// # Errors
    /// [`Error::DeviceFailed`].
    pub fn card(&self) -> Result<Option<Card>> {
        match &self.0 {
            Kind::Host => Ok(None),
            #[cfg(feature = "cuda")]
            Kind::Cuda(cuda) => cuda.card().map(Some),
        }
    }

    /// Solves contacts.
    ///
    /// # Errors
    /// [`Error::NotConverged`], [`Error::Interrupted`], [`Error::DeviceMemory`], [`Error::DeviceFailed`],
    /// [`Error::OutOfRange`] for results that are not finite.
    ///
    /// # Panics
    /// If there is no contact or no grid, or if a contact is larger than the transforms of its grid.
    pub fn solve(&self, problem: &Problem, watch: &dyn Watch) -> Result<Solution> {
        let padded = problem.grids[0].padded;
        let fits = |shape: &[usize]| shape[0] <= padded[0] && shape[1] <= padded[1];
        assert!(problem.contacts.iter().all(|contact| fits(contact.gap.shape())), "contacts within their grid");
        let solution = match &self.0 {
            Kind::Host => cascade::solve(&Host, problem, watch),
            #[cfg(feature = "cuda")]
            Kind::Cuda(cuda) => cascade::solve(cuda, problem, watch),
        }?;
        check("approach", solution.approach, solution.approach.is_finite(), solver::FINITE)?;
        Ok(solution)
    }
}

/// Returns an upper bound of the memory, bytes, that contacts of `cells` cells in all take on a device, with transforms of
/// `padded` values in all. `capped` says whether the upper bounds differ between cells, `tables` how many tables of the
/// displacement there are.
pub fn memory(cells: f64, padded: f64, capped: bool, tables: usize, precision: Precision) -> f64 {
    let state = match precision {
        Precision::Double => 8.0,
        Precision::Single => 4.0,
    };
    // Pressure, h + u, gap, last feasible pressure and bounds; direction and set; buffer and work area; a quarter for each
    // table; the pressure of the next coarser grid.
    let fields = if capped { 5.0 } else { 4.0 };
    cells * (fields * state + 5.0 + 0.25 * state) + padded * state * (2.0 + 0.25 * tables as f64)
}
