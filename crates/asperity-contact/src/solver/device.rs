//! Contacts that a device solves.

use std::f64::consts::TAU;
use std::sync::{Mutex, PoisonError};

use asperity_base::choice::choice;
pub use asperity_gpu::Card;
use asperity_gpu::{Accuracy, Compliance, Harmonics, Level, Precision};

use crate::error::{Error, Result};
use crate::grid::{Field, Grid};
use crate::math::fft::angular_frequency;
use crate::math::parallel;
use crate::operator::{Boundary, Definition, Operator, Operators};
use crate::solver::bounds::Bounds;
use crate::solver::cascade::MIN_CELLS;
use crate::solver::{Answer, Control, Method, Params, Problem, Settings, Stats, Watch};
use crate::units::Metre;

/// The device that solves a contact.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Device {
    /// The processor.
    #[default]
    Cpu,
    /// A GPU of NVIDIA, by an active set with a preconditioner of harmonics. The program needs the feature `cuda`, and the
    /// machine the driver, NVRTC and cuFFT.
    Cuda,
    /// The solver of the GPU in plain loops on the processor, its reference. It is slow, and needs no device.
    Host,
}

choice!(Device: "cpu" => Cpu, "cuda" => Cuda, "host" => Host);

/// The GPU, once it is open.
static CUDA: Mutex<Option<asperity_gpu::Device>> = Mutex::new(None);

impl Device {
    /// Opens the device; none for the processor.
    pub(super) fn open(self) -> Result<Option<asperity_gpu::Device>> {
        match self {
            Self::Cpu => Ok(None),
            Self::Host => Ok(Some(asperity_gpu::Device::HOST)),
            Self::Cuda => {
                let mut open = CUDA.lock().unwrap_or_else(PoisonError::into_inner);
                if open.is_none() {
                    *open = Some(asperity_gpu::Device::cuda()?);
                }
                Ok(open.clone())
            }
        }
    }

    /// Returns the normal operator on `shape` cells for contacts that it solves. A device needs neither its transforms nor its
    /// coefficients, which are then computed only if the processor needs them.
    pub fn operator(self, operators: &Operators, shape: [usize; 2]) -> Box<dyn Operator> {
        match self {
            Self::Cpu => operators.on(shape),
            Self::Cuda | Self::Host => operators.deferred_on(shape),
        }
    }

    /// Returns what the device is, with the memory that is free now; none for the processor.
    ///
    /// # Errors
    /// [`Error::NoDevice`], [`Error::DeviceFailed`].
    pub fn card(self) -> Result<Option<Card>> {
        self.open()?.map_or(Ok(None), |device| device.card())
    }

    /// Returns an error with these words if it is not the processor.
    pub(crate) fn only_processor(self, words: &'static str) -> Result<()> {
        if self == Self::Cpu { Ok(()) } else { Err(Error::Unsupported(words)) }
    }
}

/// Returns an upper bound of the memory, bytes, that contacts of these shapes take on a device together. `coated` says whether
/// the bodies are no homogeneous half-spaces, `caps_differ` whether the largest pressure differs between cells.
///
/// # Panics
/// If there are no shapes.
pub fn memory_on_device(shapes: &[[usize; 2]], boundary: Boundary, coated: bool, caps_differ: bool) -> f64 {
    let cells: usize = shapes.iter().map(|[nx, ny]| nx * ny).sum();
    let largest = [0, 1].map(|axis| shapes.iter().map(|shape| shape[axis]).max().expect("a contact"));
    let [px, py] = boundary.padded(largest);
    let padded = (shapes.len() * px * (py + 2)) as f64;
    let tables = if coated { 2 } else { usize::from(!boundary.leaves_mean_free()) };
    asperity_gpu::memory(cells as f64, padded, caps_differ, tables, Precision::Double)
}

/// One of the contacts that a device solves together.
pub(super) struct Site<'a> {
    pub(super) gap: &'a Field,
    pub(super) bounds: &'a Bounds,
    pub(super) start: Option<&'a Field>,
}

/// Contacts in equilibrium under one approach.
pub(super) struct Found {
    /// Pressure and displacement of each contact.
    pub(super) fields: Vec<[Field; 2]>,
    pub(super) approach: Metre,
    pub(super) residual: f64,
    pub(super) self_influence: f64,
    pub(super) stats: Stats,
}

/// Solves one contact by the device of the `params`.
pub(super) fn solve(
    device: &asperity_gpu::Device,
    definition: Option<Definition>,
    problem: &Problem,
    start: Option<&Field>,
    params: &Params,
) -> Result<Answer> {
    if !problem.slab.is_whole() {
        return Err(Error::Unsupported("a device does not solve a contact on several ranks"));
    }
    let Some(definition) = definition else {
        return Err(Error::Unsupported(
            "a device does not solve contacts whose cells wear or creep while they are pressed",
        ));
    };
    let site = Site { gap: problem.initial_gap, bounds: problem.bounds, start };
    let mut found = together(device, &definition, &[site], &problem.settings, params)?;
    let [pressure, displacement] = found.fields.pop().expect("one contact");
    let Found { approach, residual, stats, .. } = found;
    Ok(Answer { pressure, displacement, approach, residual, stats })
}

/// Solves contacts of one pair of bodies under one approach. The `definition` is that of the largest.
pub(super) fn together(
    device: &asperity_gpu::Device,
    definition: &Definition,
    sites: &[Site],
    settings: &Settings,
    params: &Params,
) -> Result<Found> {
    if !matches!(params.method, Method::Auto | Method::ActiveSet) {
        return Err(Error::Unsupported("a device solves contacts by the active set only"));
    }
    if sites.iter().any(|site| site.bounds.lower().min() < 0.0) {
        return Err(Error::Unsupported("a device does not solve adhesive contacts"));
    }
    let uniform = |site: &Site| site.bounds.upper().uniform();
    let caps_differ = sites.iter().any(|site| uniform(site).is_none() || uniform(site) != uniform(&sites[0]));
    if let Some(Card { name, free, .. }) = device.card()? {
        let shapes: Vec<[usize; 2]> = sites.iter().map(|site| site.gap.dim().into()).collect();
        let coated = definition.response.half_space_modulus().is_none();
        let needed = memory_on_device(&shapes, definition.boundary, coated, caps_differ);
        if needed > free {
            return Err(Error::DeviceMemory { device: name, needed, free });
        }
    }
    let contacts: Vec<asperity_gpu::Contact> = sites
        .iter()
        .map(|site| asperity_gpu::Contact { gap: site.gap, upper: site.bounds.upper(), start: site.start })
        .collect();
    let warm = contacts.iter().all(|contact| contact.start.is_some());
    let grids = levels(definition, warm);
    let control = match settings.control {
        Control::Load(load) => asperity_gpu::Control::PressureSum(load / settings.cell_area),
        Control::Approach(approach) => asperity_gpu::Control::Approach(approach),
    };
    let problem = asperity_gpu::Problem {
        contacts: &contacts,
        grids: &grids,
        control,
        accuracy: Accuracy {
            tolerance: params.tolerance,
            max_convolutions: params.max_convolutions,
            precision: Precision::Double,
        },
    };
    let found = device.solve(&problem, &Watched(settings.watch))?;
    let asperity_gpu::Cost { iterations, convolutions, restarts } = found.cost;
    let stats = Stats { iterations, convolutions, restarts, ..Stats::default() };
    let asperity_gpu::Solution { fields, approach, residual, self_influence, .. } = found;
    Ok(Found { fields, approach, residual, self_influence, stats })
}

/// Returns the grids of a cascade; of a `warm` start only the grid itself.
fn levels(definition: &Definition, warm: bool) -> Vec<Level> {
    let mut definition = definition.clone();
    let mut levels = vec![level(&definition)];
    while !warm && definition.grid.shape.iter().all(|n| *n >= MIN_CELLS) {
        definition = definition.coarse();
        levels.push(level(&definition));
    }
    levels
}

/// Returns the displacement of the bodies on a grid in the form that a device computes.
fn level(definition: &Definition) -> Level {
    let Definition { grid: Grid { shape, pitch }, boundary, ref response, .. } = *definition;
    let padded = boundary.padded(shape);
    let half = padded.map(|n| n / 2 + 1);
    let harmonics = match response.half_space_modulus() {
        Some(modulus) => Harmonics::HalfSpaces(modulus),
        None => Harmonics::Table(parallel::field(half, |k, l| {
            let q = |bin: usize, axis: usize| angular_frequency(bin, padded[axis], pitch[axis]);
            let [qx, qy] = if [k, l] == [0, 0] { [TAU / pitch[0], 0.0] } else { [q(k, 0), q(l, 1)] };
            response.harmonic_displacement(qx, qy)
        })),
    };
    let compliance = if boundary.leaves_mean_free() {
        Compliance::Harmonic
    } else {
        Compliance::Influence(definition.influence().table(half, pitch))
    };
    Level { padded, pitch, compliance, harmonics }
}

/// A watch of the solver as one of the device.
struct Watched<'a>(&'a dyn Watch);

impl asperity_gpu::Watch for Watched<'_> {
    fn iteration(&self, residual: f64, tolerance: f64) {
        self.0.iteration(residual, tolerance);
    }

    fn stop(&self) -> bool {
        self.0.stop()
    }
}
