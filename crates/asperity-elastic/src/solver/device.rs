//! Contacts that a device solves.

use std::f64::consts::TAU;
use std::sync::{Mutex, PoisonError};

use asperity_base::choice::choice;
pub use asperity_gpu::Card;
use asperity_gpu::{Accuracy, Compliance, Contact, Harmonics, Level, Precision};

use crate::error::{Error, Result};
use crate::grid::{Field, Grid};
use crate::math::fft::angular_frequency;
use crate::math::parallel;
use crate::operator::{Boundary, Definition, Operator, Operators};
use crate::solver::bounds::Bounds;
use crate::solver::cascade::MIN_CELLS;
use crate::solver::{Answer, Control, Method, Params, Problem, Stats, Watch};

/// The device that solves a contact.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Device {
    /// The processor.
    #[default]
    Cpu,
    /// A GPU of NVIDIA, by the active set of the processor. The program needs the feature `cuda`, and the
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

    /// Returns the normal operator on `shape` cells for contacts that it solves. A device needs neither its
    /// transforms nor its coefficients, which are then computed only if the processor needs them.
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

    /// Refuses a device other than the processor, with these words.
    ///
    /// # Errors
    /// [`Error::Unsupported`].
    pub fn only_processor(self, words: &'static str) -> Result<()> {
        if self == Self::Cpu { Ok(()) } else { Err(Error::Unsupported(words)) }
    }
}

/// Returns an upper bound of the memory, bytes, that contacts of these shapes take on a device together.
/// `coated` says whether the bodies are no homogeneous half-spaces, `caps_differ` whether the largest
/// pressure differs between cells.
///
/// # Panics
/// If there are no shapes.
pub fn memory_on_device(shapes: &[[usize; 2]], boundary: Boundary, coated: bool, caps_differ: bool) -> f64 {
    let cells: usize = shapes.iter().map(|[nx, ny]| nx * ny).sum();
    let largest = [0, 1].map(|axis| shapes.iter().map(|shape| shape[axis]).max().expect("a contact"));
    let [px, py] = boundary.padded(largest);
    let padded = (shapes.len() * px * (py + 2)) as f64;
    let tables = usize::from(coated || !boundary.leaves_mean_free());
    asperity_gpu::memory(cells as f64, padded, caps_differ, tables, Precision::Double)
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
            "a device does not solve contacts whose cells lose height or creep while they are pressed",
        ));
    };
    let contact = contact(problem.initial_gap, problem.bounds, start)?;
    let settings = &problem.settings;
    let mut found = together(device, &definition, &[contact], settings.control, params, settings.watch)?;
    let [pressure, displacement] = found.fields.pop().expect("one contact");
    let stats = stats(&found);
    Ok(Answer { pressure, displacement, approach: found.approach, residual: found.residual, stats })
}

/// Returns one of the contacts that a device solves together.
pub(super) fn contact<'a>(
    gap: &'a Field,
    bounds: &'a Bounds,
    start: Option<&'a Field>,
) -> Result<Contact<'a>> {
    if bounds.lower().min() < 0.0 {
        return Err(Error::Unsupported("a device does not solve contacts under tension"));
    }
    Ok(Contact { gap, upper: bounds.upper(), start })
}

/// Returns the cost of a solution.
pub(super) fn stats(found: &asperity_gpu::Solution) -> Stats {
    let asperity_gpu::Cost { iterations, convolutions, restarts } = found.cost;
    Stats { iterations, convolutions, restarts, ..Stats::default() }
}

/// Solves contacts of one pair of bodies under one approach. The `definition` is that of the largest.
pub(super) fn together(
    device: &asperity_gpu::Device,
    definition: &Definition,
    contacts: &[Contact],
    control: Control,
    params: &Params,
    watch: &dyn Watch,
) -> Result<asperity_gpu::Solution> {
    if !matches!(params.method, Method::Auto | Method::ActiveSet) {
        return Err(Error::Unsupported("a device solves contacts by the active set only"));
    }
    if let Some(Card { name, free, .. }) = device.card()? {
        let shapes: Vec<[usize; 2]> = contacts.iter().map(|contact| contact.gap.dim().into()).collect();
        let coated = definition.response.half_space_modulus().is_none();
        let first = contacts[0].upper.uniform();
        let caps_differ = first.is_none() || contacts.iter().any(|contact| contact.upper.uniform() != first);
        let needed = memory_on_device(&shapes, definition.boundary, coated, caps_differ);
        if needed > free {
            return Err(Error::DeviceMemory { device: name, needed, free });
        }
    }
    let warm = contacts.iter().all(|contact| contact.start.is_some());
    let problem = asperity_gpu::Problem {
        contacts,
        grids: &levels(definition, warm),
        control: match control {
            Control::Load(load) => asperity_gpu::Control::PressureSum(load / definition.grid.cell_area()),
            Control::Approach(approach) => asperity_gpu::Control::Approach(approach),
        },
        accuracy: Accuracy {
            tolerance: params.tolerance,
            max_convolutions: params.max_convolutions,
            precision: Precision::Double,
        },
    };
    device.solve(&problem, watch)
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
