//! GPUs of NVIDIA. This is the only file with unsafe code: it calls the driver, NVRTC and cuFFT, which are
//! loaded when a device is opened.
//!
//! All work is in one stream, in order. Each kernel runs on a fixed number of blocks, which merge their sums
//! in a fixed order, so that results do not depend on the run.

mod preconditioner;

use std::collections::BTreeMap;
use std::ffi::c_void;
use std::mem::size_of_val;
use std::ptr::{from_ref, null_mut};
use std::sync::{Arc, Mutex, PoisonError};

use asperity_base::error::{Error, Result};
use asperity_base::grid::{CellValues, Field, flat, in_rows};
use asperity_base::math::SparseInverse;
use asperity_base::units::{Metre, Pascal};
use cudarc::cufft::{result as fft, sys as fft_sys};
use cudarc::driver::{CudaContext, CudaFunction, DriverError, result as driver, sys as driver_sys};
use cudarc::nvrtc::{CompileOptions, compile_ptx_with_opts, sys as nvrtc_sys};

use crate::card::Card;
use crate::fields::{Device, Fields};
use crate::problem::{Compliance, Contact, Harmonics, Level, Precision, Rough};
use crate::waves::Waves;
use preconditioner::Preconditioner;

/// The kernels.
const KERNELS: &str = include_str!("../kernels.cu");
/// Names of the kernels.
const NAMES: [&str; 47] = [
    "accept",
    "add_to_free",
    "advance",
    "arrive",
    "bounds",
    "clear_outside",
    "clear_outside_single",
    "close_alone",
    "coarse_means",
    "descent",
    "direct",
    "direct_to_bounds",
    "from_factor",
    "gap_below",
    "histogram",
    "interpolate",
    "load_pressure",
    "merge_blocks",
    "multiplier",
    "multiply",
    "multiply_single",
    "patterns",
    "predict_sets",
    "pressure_sum",
    "products",
    "prolong",
    "propose",
    "proposed_sum",
    "residual",
    "response",
    "scale_below",
    "set_restricted",
    "set_solved",
    "set_uniform",
    "set_waves",
    "set_weight",
    "spread_influence",
    "statistics",
    "step_along_gap",
    "step_from_kept",
    "sum_lines",
    "summit",
    "take_spectrum",
    "take_touch",
    "to_factor",
    "touch_sum",
    "wave_sums",
];
/// Number of blocks of each kernel, on any card.
const BLOCKS: u32 = 1024;
/// Threads of a block.
const THREADS: u32 = 256;
/// Numbers that each block leaves.
const PARTS: usize = 8;

/// A GPU.
#[derive(Clone)]
pub(crate) struct Cuda {
    shared: Arc<Shared>,
}

struct Shared {
    context: Arc<CudaContext>,
    card: Card,
    /// Plans that no contact uses now. To make one takes longer than many transforms of a small grid.
    plans: Mutex<Vec<Plan>>,
    /// The compiled kernels, in double and in single precision.
    kernels: Mutex<[Option<Arc<Kernels>>; 2]>,
}

type Kernels = BTreeMap<&'static str, CudaFunction>;

/// An error of the driver or of a library.
fn failed(card: &str, what: impl std::fmt::Debug) -> Error {
    Error::DeviceFailed { device: card.to_owned(), reason: format!("{what:?}") }
}

impl Cuda {
    /// Opens the first GPU.
    pub(crate) fn open() -> Result<Self> {
        let none = |found: String| Error::NoDevice { device: "cuda", found };
        // SAFETY: only libraries of CUDA are opened, whose initialisers are those of any program that uses
        // them.
        let present = unsafe {
            [
                ("driver (libcuda)", driver_sys::is_culib_present()),
                ("NVRTC (libnvrtc)", nvrtc_sys::is_culib_present()),
                ("cuFFT (libcufft)", fft_sys::is_culib_present()),
            ]
        };
        let missing: Vec<&str> = present.iter().filter(|(_, is)| !is).map(|(name, _)| *name).collect();
        if !missing.is_empty() {
            return Err(none(format!("no {}", missing.join(", no "))));
        }
        let open = || -> std::result::Result<(Arc<CudaContext>, Card), DriverError> {
            let context = CudaContext::new(0)?;
            let (free, total) = context.mem_get_info()?;
            let (major, minor) = context.compute_capability()?;
            let card = Card {
                name: context.name()?,
                capability: Some([major, minor].map(|n| n as u32)),
                memory: total as f64,
                free: free as f64,
            };
            Ok((context, card))
        };
        let (context, card) =
            open().map_err(|error| none(format!("the driver, but no device: {error:?}")))?;
        let shared = Shared { context, card, plans: Mutex::default(), kernels: Mutex::default() };
        Ok(Self { shared: Arc::new(shared) })
    }

    /// Returns the card, with the memory that is free now.
    pub(crate) fn card(&self) -> Result<Card> {
        self.bind()?;
        let (free, _) = self.checked(self.shared.context.mem_get_info())?;
        Ok(Card { free: free as f64, ..self.shared.card.clone() })
    }

    fn checked<T, E: std::fmt::Debug>(&self, result: std::result::Result<T, E>) -> Result<T> {
        result.map_err(|error| failed(&self.shared.card.name, error))
    }

    fn bind(&self) -> Result<()> {
        self.checked(self.shared.context.bind_to_thread())
    }

    /// Returns the compiled kernels.
    fn kernels(&self, precision: Precision) -> Result<Arc<Kernels>> {
        let mut all = self.shared.kernels.lock().unwrap_or_else(PoisonError::into_inner);
        let (slot, state) = match precision {
            Precision::Double => (&mut all[0], "double"),
            Precision::Single => (&mut all[1], "float"),
        };
        if let Some(kernels) = slot {
            return Ok(Arc::clone(kernels));
        }
        let [major, minor] = self.shared.card.capability.expect("a GPU has one");
        let options = CompileOptions {
            options: vec![format!("--gpu-architecture=compute_{major}{minor}")],
            ..CompileOptions::default()
        };
        let text = format!("typedef {state} state;\n{KERNELS}");
        let compiled = self.checked(compile_ptx_with_opts(text, options))?;
        let module = self.checked(self.shared.context.load_module(compiled))?;
        let kernels: Result<Kernels> =
            NAMES.into_iter().map(|name| Ok((name, self.checked(module.load_function(name))?))).collect();
        Ok(Arc::clone(slot.insert(Arc::new(kernels?))))
    }

    fn memory(&self, bytes: usize) -> Result<Memory> {
        self.bind()?;
        // SAFETY: the context is bound; the memory is freed once, by `Memory`.
        match unsafe { driver::malloc_sync(bytes.max(1)) } {
            Ok(at) => Ok(Memory { at, bytes, cuda: self.clone() }),
            Err(DriverError(driver_sys::CUresult::CUDA_ERROR_OUT_OF_MEMORY)) => {
                let card = self.card()?;
                Err(Error::DeviceMemory { device: card.name, needed: bytes as f64, free: card.free })
            }
            Err(other) => self.checked(Err(other)),
        }
    }

    fn copy_of<T: Copy>(&self, values: &[T]) -> Result<Memory> {
        let memory = self.memory(size_of_val(values))?;
        memory.set(0, values)?;
        Ok(memory)
    }

    /// Copies values to the device in the precision of `precision`.
    fn state_of(&self, values: &[f64], precision: Precision) -> Result<Memory> {
        let memory = self.memory(values.len() * bytes(precision))?;
        memory.set_state(0, values, precision)?;
        Ok(memory)
    }
}

/// Bytes of a number.
fn bytes(precision: Precision) -> usize {
    match precision {
        Precision::Double => 8,
        Precision::Single => 4,
    }
}

/// Memory of the device.
struct Memory {
    at: u64,
    bytes: usize,
    cuda: Cuda,
}

impl Drop for Memory {
    fn drop(&mut self) {
        if self.cuda.bind().is_ok() {
            // SAFETY: it was allocated by `Cuda::memory`, and is freed once. Freeing waits for the stream.
            let _ = unsafe { driver::free_sync(self.at) };
        }
    }
}

impl Memory {
    fn set<T: Copy>(&self, at: usize, values: &[T]) -> Result<()> {
        assert!(at + size_of_val(values) <= self.bytes, "within the memory");
        self.cuda.bind()?;
        // SAFETY: the destination lies within the memory, and T is plain data.
        self.cuda.checked(unsafe { driver::memcpy_htod_sync(self.at + at as u64, values) })
    }

    fn set_state(&self, first: usize, values: &[f64], precision: Precision) -> Result<()> {
        match precision {
            Precision::Double => self.set(8 * first, values),
            Precision::Single => {
                let single: Vec<f32> = values.iter().map(|value| *value as f32).collect();
                self.set(4 * first, &single)
            }
        }
    }

    fn read<T: Copy + Default>(&self, at: usize, count: usize) -> Result<Vec<T>> {
        let mut values = vec![T::default(); count];
        assert!(at + size_of_val(&*values) <= self.bytes, "within the memory");
        self.cuda.bind()?;
        // SAFETY: the source lies within the memory, and any bits are a T, which is a number.
        self.cuda.checked(unsafe { driver::memcpy_dtoh_sync(&mut values, self.at + at as u64) })?;
        Ok(values)
    }

    fn read_state(&self, first: usize, count: usize, precision: Precision) -> Result<Vec<f64>> {
        match precision {
            Precision::Double => self.read(8 * first, count),
            Precision::Single => Ok(self.read::<f32>(4 * first, count)?.into_iter().map(f64::from).collect()),
        }
    }

    fn clear(&self) -> Result<()> {
        self.cuda.bind()?;
        // SAFETY: the whole memory, in the stream of all kernels.
        self.cuda.checked(unsafe { driver::memset_d8_async(self.at, 0, self.bytes, null_mut()) })
    }

    fn copy_from(&self, other: &Self) -> Result<()> {
        assert_eq!(self.bytes, other.bytes, "as much memory");
        self.cuda.bind()?;
        // SAFETY: both have this length, in the stream of all kernels.
        self.cuda.checked(unsafe { driver::memcpy_dtod_async(self.at, other.at, self.bytes, null_mut()) })
    }
}

/// A row of a contact.
struct Row {
    contact: usize,
    row: usize,
    /// The flat cell at which it begins.
    first: u64,
    length: usize,
}

/// The contacts, one after another.
struct Layout {
    shapes: Vec<[usize; 2]>,
}

impl Layout {
    fn cells(&self) -> usize {
        self.shapes.iter().map(|[rows, columns]| rows * columns).sum()
    }

    /// Calls `of` for each row.
    fn rows<T>(&self, of: impl Fn(Row) -> T) -> Vec<T> {
        let mut first = 0;
        let mut all = Vec::new();
        for (contact, &[rows, length]) in self.shapes.iter().enumerate() {
            for row in 0..rows {
                all.push(of(Row { contact, row, first, length }));
                first += length as u64;
            }
        }
        all
    }

    /// Number of rows.
    fn height(&self) -> i32 {
        self.shapes.iter().map(|[rows, _]| *rows as i32).sum()
    }

    fn coarse(&self) -> Self {
        Self { shapes: self.shapes.iter().map(|shape| shape.map(|n| n.div_ceil(2))).collect() }
    }

    /// Returns the row at which each contact begins.
    fn first_rows(&self) -> Vec<i32> {
        let mut next = 0;
        let first = |[rows, _]: &[usize; 2]| {
            let first = next;
            next += *rows as i32;
            first
        };
        self.shapes.iter().map(first).collect()
    }

    /// Returns the flat cell at which each contact begins.
    fn starts(&self) -> Vec<u64> {
        let mut next = 0;
        let start = |shape: &[usize; 2]| {
            let start = next;
            next += (shape[0] * shape[1]) as u64;
            start
        };
        self.shapes.iter().map(start).collect()
    }
}

/// Gaps and upper bounds on the device.
pub(crate) struct Gaps {
    layout: Layout,
    precision: Precision,
    gap: Memory,
    upper: Option<Memory>,
    cap: f64,
}

/// Pressures on the device.
pub(crate) struct Pressure {
    layout: Layout,
    values: Memory,
}

impl Device for Cuda {
    type Gaps = Gaps;
    type Fields = CudaFields;
    type Pressure = Pressure;

    fn gaps(&self, contacts: &[Contact], precision: Precision) -> Result<Gaps> {
        let layout = Layout { shapes: contacts.iter().map(|contact| contact.gap.dim().into()).collect() };
        let (starts, bytes) = (layout.starts(), layout.cells() * bytes(precision));
        let gap = self.memory(bytes)?;
        for (contact, start) in contacts.iter().zip(&starts) {
            gap.set_state(*start as usize, flat(&in_rows(contact.gap)), precision)?;
        }
        let first = contacts[0].upper.uniform();
        let alike = contacts.iter().all(|contact| contact.upper.uniform() == first);
        let (upper, cap) = match first {
            Some(cap) if alike => (None, cap),
            _ => {
                let upper = self.memory(bytes)?;
                for (contact, start) in contacts.iter().zip(&starts) {
                    match contact.upper {
                        CellValues::Field(field) => {
                            upper.set_state(*start as usize, flat(&in_rows(field)), precision)?
                        }
                        CellValues::Uniform(cap) => {
                            upper.set_state(*start as usize, &vec![*cap; contact.gap.len()], precision)?;
                        }
                    }
                }
                (Some(upper), f64::INFINITY)
            }
        };
        Ok(Gaps { layout, precision, gap, upper, cap })
    }

    fn rough(&self, rough: &Rough, level: &Level, precision: Precision) -> Result<Gaps> {
        let kernels = self.kernels(precision)?;
        let (side, waves) = (rough.side as i32, Waves::from_rough(rough));
        let [parts, results] = [BLOCKS as usize, 1].map(|blocks| self.memory(blocks * PARTS * 8));
        let (parts, results) = (parts?, results?);
        // The sum of the results of all blocks, or the largest.
        let merged = |sums: i32| -> Result<f64> {
            let (blocks, numbers) = (BLOCKS as i32, 1);
            let arguments = [arg(&parts.at), arg(&blocks), arg(&numbers), arg(&sums), arg(&results.at)];
            self.launch(&kernels, "merge_blocks", 1, &arguments)?;
            Ok(results.read::<f64>(0, 1)?[0])
        };
        self.launch(&kernels, "wave_sums", BLOCKS, &[arg(&waves), arg(&side), arg(&parts.at)])?;
        let factor = rough.slope / merged(1)?.sqrt();
        let kind = match precision {
            Precision::Double => fft_sys::cufftType_t::CUFFT_Z2D,
            Precision::Single => fft_sys::cufftType_t::CUFFT_C2R,
        };
        let stride = 2 * (rough.side / 2 + 1);
        let plan = self.plan(Transforms { kind, shape: level.padded, count: 1 })?;
        let (buffer, work) = (self.memory(rough.side * stride * bytes(precision))?, self.memory(plan.work)?);
        self.launch(
            &kernels,
            "set_waves",
            BLOCKS,
            &[arg(&buffer.at), arg(&waves), arg(&side), arg(&factor)],
        )?;
        plan.work_in(self, &work)?;
        plan.transform(self, &buffer)?;
        let width = stride as i32;
        self.launch(&kernels, "summit", BLOCKS, &[arg(&buffer.at), arg(&side), arg(&width), arg(&parts.at)])?;
        let summit = merged(0)?;
        drop(work);
        self.keep_plans([plan]);
        let layout = Layout { shapes: vec![[rough.side; 2]] };
        let gap = self.memory(layout.cells() * bytes(precision))?;
        let first = self.copy_of(&layout.rows(|row| row.first))?;
        let padded = self.copy_of(&layout.rows(|row| (row.row * stride) as u64))?;
        let length = self.copy_of(&layout.rows(|row| row.length as i32))?;
        let arguments = Arguments {
            first: first.at,
            padded: padded.at,
            length: length.at,
            rows: layout.height(),
            gap: gap.at,
            ..Arguments::default()
        };
        self.launch(&kernels, "gap_below", BLOCKS, &[arg(&arguments), arg(&buffer.at), arg(&summit)])?;
        self.checked(self.shared.context.synchronize())?;
        Ok(Gaps { layout, precision, gap, upper: None, cap: f64::INFINITY })
    }

    fn coarse(&self, fine: &Gaps) -> Result<Gaps> {
        let layout = fine.layout.coarse();
        let starts = fine.layout.starts();
        let shapes = &fine.layout.shapes;
        let at = |contact: usize, row: usize| {
            let [rows, columns] = shapes[contact];
            starts[contact] + (row.min(rows - 1) * columns) as u64
        };
        let first = self.copy_of(&layout.rows(|row| at(row.contact, 2 * row.row)))?;
        let second = self.copy_of(&layout.rows(|row| at(row.contact, 2 * row.row + 1)))?;
        let length = self.copy_of(&layout.rows(|row| shapes[row.contact][1] as i32))?;
        let to = self.copy_of(&layout.rows(|row| row.first))?;
        let rows = layout.height();
        let kernels = self.kernels(fine.precision)?;
        let means = |of: &Memory| -> Result<Memory> {
            let coarse = self.memory(layout.cells() * bytes(fine.precision))?;
            let arguments = [
                arg(&of.at),
                arg(&coarse.at),
                arg(&first.at),
                arg(&second.at),
                arg(&length.at),
                arg(&to.at),
                arg(&rows),
            ];
            self.launch(&kernels, "coarse_means", BLOCKS, &arguments)?;
            Ok(coarse)
        };
        let (gap, upper) = (means(&fine.gap)?, fine.upper.as_ref().map(means).transpose()?);
        // The tables are freed when the kernels have read them.
        self.checked(self.shared.context.synchronize())?;
        Ok(Gaps { layout, precision: fine.precision, gap, upper, cap: fine.cap })
    }

    fn fields(&self, gaps: Gaps, level: &Level) -> Result<CudaFields> {
        CudaFields::new(self, gaps, level)
    }

    fn pressure_of(&self, mut fields: CudaFields) -> Result<Pressure> {
        let layout = Layout { shapes: std::mem::take(&mut fields.layout.shapes) };
        Ok(Pressure { layout, values: std::mem::replace(&mut fields.pressure, self.memory(0)?) })
    }

    fn prolong(&self, coarse: &Pressure, fine: &mut CudaFields) -> Result<()> {
        let starts = coarse.layout.starts();
        let of = |row: Row| starts[row.contact] + (row.row / 2 * coarse.layout.shapes[row.contact][1]) as u64;
        let from = self.copy_of(&fine.layout.rows(of))?;
        fine.on_cells("prolong", &[arg(&coarse.values.at), arg(&from.at)])?;
        self.checked(self.shared.context.synchronize())
    }
}

/// A pointer to an argument of a kernel.
fn arg<T: Copy>(value: &T) -> *mut c_void {
    from_ref(value).cast_mut().cast()
}

impl Cuda {
    /// Starts a kernel.
    fn launch(&self, kernels: &Kernels, name: &str, blocks: u32, arguments: &[*mut c_void]) -> Result<()> {
        let mut arguments = arguments.to_vec();
        // SAFETY: each call passes the arguments that the kernel of this name has, of the same types; memory
        // that it reaches is that of the fields, and is freed after the kernel by a call that waits.
        let launched = unsafe {
            driver::launch_kernel(
                kernels[name].cu_function(),
                (blocks, 1, 1),
                (THREADS, 1, 1),
                0,
                null_mut(),
                &mut arguments,
            )
        };
        self.checked(launched)
    }
}

/// The structure `Contacts` of the kernels.
#[repr(C)]
#[derive(Clone, Copy, Default)]
struct Arguments {
    first: u64,
    padded: u64,
    length: u64,
    around: u64,
    rows: i32,
    pressure: u64,
    touch: u64,
    gap: u64,
    kept: u64,
    upper: u64,
    cap: f64,
    direction: u64,
    set: u64,
    pattern: u64,
}

/// The structure `Spectrum` of the kernels.
#[repr(C)]
#[derive(Clone, Copy)]
struct Spectrum {
    table: u64,
    constant: f64,
    at_zero: f64,
    unit: [f64; 2],
    inverse: i32,
}

/// A plan of transforms in place, whose work area is given.
struct Plan {
    /// Kind, shape and number of its transforms.
    of: Transforms,
    handle: fft_sys::cufftHandle,
    /// Bytes of its work area.
    work: usize,
}

/// Transforms of one kind, shape and number.
#[derive(Clone, Copy, PartialEq)]
struct Transforms {
    kind: fft_sys::cufftType,
    shape: [usize; 2],
    count: usize,
}

/// Number of plans that are kept for later contacts: those of a cascade up to 32768², in double precision.
const KEPT_PLANS: usize = 66;

impl Cuda {
    /// Returns a plan, one that was given back if there is one.
    fn plan(&self, of: Transforms) -> Result<Plan> {
        let mut plans = self.shared.plans.lock().unwrap_or_else(PoisonError::into_inner);
        match plans.iter().position(|plan| plan.of == of) {
            Some(index) => Ok(plans.remove(index)),
            None => Plan::new(self, of),
        }
    }

    /// Gives plans back.
    fn keep_plans(&self, plans: impl IntoIterator<Item = Plan>) {
        let mut kept = self.shared.plans.lock().unwrap_or_else(PoisonError::into_inner);
        kept.extend(plans);
        let old = kept.len().saturating_sub(KEPT_PLANS);
        kept.drain(..old);
    }
}

impl Drop for Plan {
    fn drop(&mut self) {
        // SAFETY: it was created by `Plan::new`, and is destroyed once.
        let _ = unsafe { fft::destroy(self.handle) };
    }
}

impl Plan {
    fn new(cuda: &Cuda, of: Transforms) -> Result<Self> {
        let Transforms { kind, shape: [rows, columns], count } = of;
        cuda.bind()?;
        let handle = cuda.checked(fft::create())?;
        let mut plan = Self { of, handle, work: 0 };
        let half = (columns / 2 + 1) as i64;
        let (mut shape, mut real, mut waves) =
            ([rows as i64, columns as i64], [rows as i64, 2 * half], [rows as i64, half]);
        let distances = [real[0] * real[1], waves[0] * waves[1]];
        let forward = matches!(kind, fft_sys::cufftType_t::CUFFT_R2C | fft_sys::cufftType_t::CUFFT_D2Z);
        let ([from, from_distance], [to, to_distance]) = if forward {
            ([real.as_mut_ptr() as i64, distances[0]], [waves.as_mut_ptr() as i64, distances[1]])
        } else {
            ([waves.as_mut_ptr() as i64, distances[1]], [real.as_mut_ptr() as i64, distances[0]])
        };
        // SAFETY: the handle is new, and the arrays have two numbers each.
        plan.work = cuda.checked(unsafe {
            fft::set_auto_allocation(handle, false).and_then(|()| {
                fft::make_plan_many64(
                    handle,
                    2,
                    shape.as_mut_ptr(),
                    from as *mut i64,
                    1,
                    from_distance,
                    to as *mut i64,
                    1,
                    to_distance,
                    kind,
                    count as i64,
                )
            })
        })?;
        Ok(plan)
    }

    /// Sets the work area, which must outlive the next transforms.
    fn work_in(&self, cuda: &Cuda, area: &Memory) -> Result<()> {
        assert!(area.bytes >= self.work, "as large an area as the plan asks for");
        // SAFETY: the area is as large as the plan asks for, and whoever transforms by the plan has both.
        cuda.checked(unsafe { fft::set_work_area(self.handle, area.at as *mut c_void) })
    }

    /// Transforms a buffer in place.
    fn transform(&self, cuda: &Cuda, buffer: &Memory) -> Result<()> {
        use fft_sys::cufftType_t::{CUFFT_C2R, CUFFT_D2Z, CUFFT_R2C};
        let Transforms { kind, shape: [rows, columns], count } = self.of;
        let number = if matches!(kind, CUFFT_R2C | CUFFT_C2R) { 4 } else { 8 };
        assert!(count * rows * 2 * (columns / 2 + 1) * number <= buffer.bytes, "within the buffer");
        cuda.bind()?;
        let (handle, at) = (self.handle, buffer.at);
        // SAFETY: the plan is for buffers of this size, in place, in this precision and direction.
        let done = unsafe {
            match kind {
                CUFFT_R2C => fft::exec_r2c(handle, at as *mut _, at as *mut _),
                CUFFT_C2R => fft::exec_c2r(handle, at as *mut _, at as *mut _),
                CUFFT_D2Z => fft::exec_d2z(handle, at as *mut _, at as *mut _),
                _ => fft::exec_z2d(handle, at as *mut _, at as *mut _),
            }
        };
        cuda.checked(done)
    }
}

/// The fields of all contacts.
pub(crate) struct CudaFields {
    cuda: Cuda,
    kernels: Arc<Kernels>,
    layout: Layout,
    precision: Precision,
    rows: i32,
    /// Tables of the rows: first cell, first value in the buffer, length, and the rows around.
    tables: [Memory; 4],
    shapes: Memory,
    padded: [usize; 2],
    /// Whether the buffer has values outside of the contacts.
    has_outside: bool,
    gap: Memory,
    upper: Option<Memory>,
    cap: f64,
    pressure: Memory,
    touch: Memory,
    kept: Memory,
    direction: Memory,
    set: Memory,
    pattern: Memory,
    buffer: Memory,
    work: Memory,
    /// Plans in single precision, there and back, and those in double precision if that is the precision of
    /// the pressure.
    plans: Vec<Plan>,
    parts: Memory,
    results: Memory,
    compliance: Spectrum,
    spectra: Vec<Memory>,
    preconditioner: Preconditioner,
    self_influence: f64,
    bounds: [Pascal; 2],
}

impl CudaFields {
    fn new(cuda: &Cuda, gaps: Gaps, level: &Level) -> Result<Self> {
        let Gaps { layout, precision, gap, upper, cap } = gaps;
        let [rows, columns] = level.padded;
        let stride = 2 * (columns / 2 + 1);
        let (cells, contacts) = (layout.cells(), layout.shapes.len());
        let padded = |row: Row| ((row.contact * rows + row.row) * stride) as u64;
        let tables = [
            cuda.copy_of(&layout.rows(|row| row.first))?,
            cuda.copy_of(&layout.rows(padded))?,
            cuda.copy_of(&layout.rows(|row| row.length as i32))?,
            cuda.copy_of(&layout.rows(around(&layout, level)))?,
        ];
        let shapes: Vec<i32> = layout.shapes.iter().flatten().map(|n| *n as i32).collect();
        let shapes = cuda.copy_of(&shapes)?;
        use fft_sys::cufftType_t::{CUFFT_C2R, CUFFT_D2Z, CUFFT_R2C, CUFFT_Z2D};
        let kinds: &[fft_sys::cufftType] = match precision {
            Precision::Double => &[CUFFT_R2C, CUFFT_C2R, CUFFT_D2Z, CUFFT_Z2D],
            Precision::Single => &[CUFFT_R2C, CUFFT_C2R],
        };
        let plan = |kind: &fft_sys::cufftType| {
            cuda.plan(Transforms { kind: *kind, shape: level.padded, count: contacts })
        };
        let plans: Vec<Plan> = kinds.iter().map(plan).collect::<Result<_>>()?;
        let work = cuda.memory(plans.iter().map(|plan| plan.work).max().unwrap_or(0))?;
        for plan in &plans {
            plan.work_in(cuda, &work)?;
        }
        let state = || cuda.memory(cells * bytes(precision));
        let mut fields = Self {
            kernels: cuda.kernels(precision)?,
            rows: layout.height(),
            tables,
            preconditioner: Preconditioner::new(cuda, &layout, level, precision, [&shapes, &work])?,
            shapes,
            padded: level.padded,
            has_outside: layout.shapes.iter().any(|shape| *shape != level.padded),
            gap,
            upper,
            cap,
            pressure: state()?,
            touch: state()?,
            kept: state()?,
            direction: cuda.memory(4 * cells)?,
            set: cuda.memory(cells)?,
            pattern: cuda.memory(cells)?,
            buffer: cuda.memory(contacts * rows * stride * bytes(precision))?,
            work,
            plans,
            parts: cuda.memory(BLOCKS as usize * PARTS * 8)?,
            results: cuda.memory(PARTS * 8)?,
            compliance: waves(level, true),
            spectra: Vec::new(),
            self_influence: 0.0,
            bounds: [0.0; 2],
            layout,
            precision,
            cuda: cuda.clone(),
        };
        fields.take_tables(level)?;
        fields.buffer.clear()?;
        fields.buffer.set_state(0, &[1.0], precision)?;
        fields.filter(fields.compliance, false)?;
        fields.self_influence = level.self_influence(fields.buffer.read_state(0, 1, precision)?[0]);
        fields.take_inverse(level)?;
        fields.bounds = fields.sums("bounds", 1, &[])?;
        Ok(fields)
    }

    /// Places the tables of the displacement on the device.
    fn take_tables(&mut self, level: &Level) -> Result<()> {
        let [rows, columns] = self.padded;
        let half = columns / 2 + 1;
        match (&level.compliance, &level.harmonics) {
            (Compliance::Influence(influence), _) => {
                let influence = self.cuda.state_of(flat(&in_rows(influence)), self.precision)?;
                let spectrum = self.cuda.memory((rows / 2 + 1) * half * bytes(self.precision))?;
                let (rows, columns, stride) = (rows as i32, columns as i32, 2 * half as i32);
                self.buffer.clear()?;
                let from =
                    [arg(&self.buffer.at), arg(&influence.at), arg(&rows), arg(&columns), arg(&stride)];
                self.cuda.launch(&self.kernels, "spread_influence", BLOCKS, &from)?;
                self.transform(true, false)?;
                let half = half as i32;
                let to = [arg(&self.buffer.at), arg(&spectrum.at), arg(&rows), arg(&half)];
                self.cuda.launch(&self.kernels, "take_spectrum", BLOCKS, &to)?;
                self.cuda.checked(self.cuda.shared.context.synchronize())?;
                self.compliance.table = spectrum.at;
                self.spectra.push(spectrum);
            }
            (Compliance::Harmonic, Harmonics::Table(table)) => {
                let mut values = flat(&in_rows(table)).to_vec();
                values[0] = 0.0;
                let compliance = self.cuda.state_of(&values, self.precision)?;
                self.compliance.table = compliance.at;
                self.spectra.push(compliance);
            }
            (Compliance::Harmonic, Harmonics::HalfSpaces(_)) => {}
        }
        Ok(())
    }

    /// Places the sparse inverse on the device, from the displacement under a unit pressure on the first cell,
    /// which is in the buffer.
    fn take_inverse(&mut self, level: &Level) -> Result<()> {
        let [rows, columns] = self.padded;
        let stride = 2 * (columns / 2 + 1);
        let row = |i: usize| self.buffer.read_state(i * stride, columns, self.precision);
        let near: Vec<Vec<f64>> = (0..rows.min(SparseInverse::REACH[0])).map(row).collect::<Result<_>>()?;
        let far = row(rows / 2)?;
        let influence = |i: usize, j: usize| near.get(i).unwrap_or(&far)[j];
        self.preconditioner.take(&self.cuda, level.sparse_inverse(self.padded, influence).rows())
    }

    fn arguments(&self) -> Arguments {
        Arguments {
            first: self.tables[0].at,
            padded: self.tables[1].at,
            length: self.tables[2].at,
            around: self.tables[3].at,
            rows: self.rows,
            pressure: self.pressure.at,
            touch: self.touch.at,
            gap: self.gap.at,
            kept: self.kept.at,
            upper: self.upper.as_ref().map_or(0, |upper| upper.at),
            cap: self.cap,
            direction: self.direction.at,
            set: self.set.at,
            pattern: self.pattern.at,
        }
    }

    /// Returns the values of a contact.
    fn read(&self, memory: &Memory, start: u64, [rows, columns]: [usize; 2]) -> Result<Field> {
        let values = memory.read_state(start as usize, rows * columns, self.precision)?;
        Ok(Field::from_shape_vec([rows, columns], values).expect("the shape of the contact"))
    }

    /// Starts a kernel with these arguments.
    fn run(&self, name: &str, arguments: &[*mut c_void]) -> Result<()> {
        self.cuda.bind()?;
        self.cuda.launch(&self.kernels, name, BLOCKS, arguments)
    }

    /// Starts a kernel on the cells with these arguments after the fields.
    fn on_cells(&self, name: &str, arguments: &[*mut c_void]) -> Result<()> {
        let fields = self.arguments();
        let all: Vec<_> = [arg(&fields)].into_iter().chain(arguments.iter().copied()).collect();
        self.run(name, &all)
    }

    /// Starts a kernel on the cells, and returns its results, of which the first `sums` are sums and the
    /// others largest values.
    fn sums<const N: usize>(&self, name: &str, sums: i32, arguments: &[*mut c_void]) -> Result<[f64; N]> {
        let all: Vec<_> = arguments.iter().copied().chain([arg(&self.parts.at)]).collect();
        self.on_cells(name, &all)?;
        let (blocks, numbers) = (BLOCKS as i32, N as i32);
        let arguments = [arg(&self.parts.at), arg(&blocks), arg(&numbers), arg(&sums), arg(&self.results.at)];
        self.cuda.launch(&self.kernels, "merge_blocks", 1, &arguments)?;
        let results = self.results.read(0, N)?;
        Ok(std::array::from_fn(|n| results[n]))
    }

    /// Transforms the buffer in place, there or back, in single precision or in that of the pressure.
    fn transform(&self, there: bool, single: bool) -> Result<()> {
        let first = if single || self.precision == Precision::Single { 0 } else { 2 };
        self.plans[first + usize::from(!there)].transform(&self.cuda, &self.buffer)
    }

    /// Multiplies the transforms of the buffer, in single precision or in that of the pressure.
    fn filter(&self, spectrum: Spectrum, single: bool) -> Result<()> {
        let [rows, columns] = self.padded;
        let half = (columns / 2 + 1) as i32;
        let (contacts, stride) = (self.layout.shapes.len() as i32, 2 * half);
        let scale = 1.0 / (rows * columns) as f64;
        let rows = rows as i32;
        let name = |state: &'static str, of_single: &'static str| if single { of_single } else { state };
        if self.has_outside {
            let arguments =
                [arg(&self.buffer.at), arg(&self.shapes.at), arg(&contacts), arg(&rows), arg(&stride)];
            self.run(name("clear_outside", "clear_outside_single"), &arguments)?;
        }
        self.transform(true, single)?;
        let arguments =
            [arg(&self.buffer.at), arg(&spectrum), arg(&contacts), arg(&rows), arg(&half), arg(&scale)];
        self.run(name("multiply", "multiply_single"), &arguments)?;
        self.transform(false, single)
    }
}

/// Returns the factors of half-spaces: of the displacement, or of the stiffness.
fn waves(level: &Level, displacement: bool) -> Spectrum {
    let modulus = match level.harmonics {
        Harmonics::HalfSpaces(modulus) => modulus,
        Harmonics::Table(_) => 0.0,
    };
    let constant = if displacement { 2.0 / modulus } else { 0.5 * modulus };
    Spectrum { table: 0, constant, at_zero: 0.0, unit: level.wavenumbers(), inverse: i32::from(displacement) }
}

/// Returns the contact of a row, its place in the contact, and the rows 2 and 1 before and 1 and 2 after it;
/// −1 without such a row.
fn around(layout: &Layout, level: &Level) -> impl Fn(Row) -> [i32; 6] {
    let first_rows = layout.first_rows();
    move |Row { contact, row, .. }| {
        let shape = layout.shapes[contact];
        let (rows, row) = (shape[0] as i32, row as i32);
        let [wraps, _] = level.wraps(shape);
        let at = |distance: i32| match row + distance {
            other if (0..rows).contains(&other) => first_rows[contact] + other,
            other if wraps => first_rows[contact] + other.rem_euclid(rows),
            _ => -1,
        };
        [contact as i32, row, at(-2), at(-1), at(1), at(2)]
    }
}

impl Drop for CudaFields {
    fn drop(&mut self) {
        self.cuda.keep_plans(self.plans.drain(..).chain(self.preconditioner.plans()));
    }
}

impl Fields for CudaFields {
    fn cells(&self) -> usize {
        self.layout.cells()
    }

    fn self_influence(&self) -> f64 {
        self.self_influence
    }

    fn upper(&self) -> [Pascal; 2] {
        self.bounds
    }

    fn set_pressure(&mut self, pressure: &[&Field]) -> Result<()> {
        for (field, start) in pressure.iter().zip(self.layout.starts()) {
            self.pressure.set_state(start as usize, flat(&in_rows(field)), self.precision)?;
        }
        Ok(())
    }

    fn set_uniform(&mut self, pressure: Pascal) -> Result<()> {
        self.on_cells("set_uniform", &[arg(&pressure)])
    }

    fn close_alone(&mut self, approach: Metre, stiffness: f64) -> Result<()> {
        self.on_cells("close_alone", &[arg(&approach), arg(&stiffness)])
    }

    fn scale_below(&mut self, factor: f64) -> Result<[Pascal; 2]> {
        self.sums("scale_below", 2, &[arg(&factor)])
    }

    fn propose(&mut self, approach: Metre, stiffness: f64) -> Result<[Pascal; 2]> {
        let [least, largest] =
            self.sums("propose", 0, &[arg(&self.buffer.at), arg(&approach), arg(&stiffness)])?;
        Ok([-least, largest])
    }

    fn proposed_sum(&mut self, offset: Pascal) -> Result<[f64; 2]> {
        self.sums("proposed_sum", 2, &[arg(&self.buffer.at), arg(&offset)])
    }

    fn accept(&mut self, offset: Pascal) -> Result<()> {
        self.on_cells("accept", &[arg(&self.buffer.at), arg(&offset)])
    }

    fn predict_sets(&mut self, offset: Pascal) -> Result<[f64; 4]> {
        self.sums("predict_sets", 4, &[arg(&self.buffer.at), arg(&offset)])
    }

    fn convolve(&mut self) -> Result<()> {
        self.on_cells("load_pressure", &[arg(&self.buffer.at), arg(&0)])?;
        self.filter(self.compliance, false)?;
        self.on_cells("take_touch", &[arg(&self.buffer.at)])
    }

    fn multiplier(&mut self) -> Result<[f64; 3]> {
        self.sums("multiplier", 2, &[])
    }

    fn residual(&mut self, approach: Metre) -> Result<[f64; 5]> {
        self.sums("residual", 2, &[arg(&approach), arg(&self.self_influence)])
    }

    fn move_to_bounds(&mut self, each: Pascal, per_pressure: f64) -> Result<()> {
        self.on_cells("direct_to_bounds", &[arg(&self.buffer.at), arg(&each), arg(&per_pressure)])?;
        self.filter(self.compliance, true)?;
        self.on_cells("arrive", &[arg(&self.buffer.at)])
    }

    fn reset_direction(&mut self) -> Result<f64> {
        self.direction.clear()?;
        let [sum] = self.sums("touch_sum", 1, &[])?;
        Ok(sum)
    }

    fn advance(&mut self, step: f64, datum: Metre) -> Result<[f64; 3]> {
        self.sums("advance", 2, &[arg(&self.buffer.at), arg(&step), arg(&datum), arg(&self.self_influence)])
    }

    fn adapt(&mut self, free: f64) -> Result<()> {
        self.preconditioner.set_mean(free, self.cells() as f64)?;
        self.preconditioner.adapt(self)
    }

    fn precondition(&mut self, datum: Metre) -> Result<[f64; 3]> {
        self.preconditioner.apply(self)?;
        self.sums("products", 3, &[arg(&self.buffer.at), arg(&datum)])
    }

    fn respond(&mut self, mean: f64, beta: f64) -> Result<[f64; 2]> {
        self.on_cells("direct", &[arg(&self.buffer.at), arg(&mean), arg(&beta)])?;
        self.filter(self.compliance, true)?;
        self.sums("response", 2, &[arg(&self.buffer.at)])
    }

    fn pressure_sum(&mut self) -> Result<Pascal> {
        let [sum] = self.sums("pressure_sum", 1, &[])?;
        Ok(sum)
    }

    fn add_to_free(&mut self, pressure: Pascal) -> Result<()> {
        self.on_cells("add_to_free", &[arg(&pressure)])
    }

    fn step_along_gap(&mut self, approach: Metre, compliance: f64) -> Result<()> {
        self.on_cells("step_along_gap", &[arg(&approach), arg(&compliance)])
    }

    fn keep(&mut self) -> Result<()> {
        self.kept.copy_from(&self.pressure)
    }

    fn convolve_kept(&mut self) -> Result<()> {
        self.on_cells("load_pressure", &[arg(&self.buffer.at), arg(&1)])?;
        self.filter(self.compliance, false)
    }

    fn descent(&mut self, approach: Metre) -> Result<[f64; 2]> {
        self.sums("descent", 2, &[arg(&self.buffer.at), arg(&approach)])
    }

    fn step_from_kept(&mut self, share: f64) -> Result<()> {
        self.on_cells("step_from_kept", &[arg(&self.buffer.at), arg(&share)])
    }

    fn statistics(&mut self, approach: Metre) -> Result<[f64; 3]> {
        self.sums("statistics", 2, &[arg(&approach)])
    }

    fn histogram(&mut self, width: Pascal, bins: usize) -> Result<Vec<u64>> {
        let counts = self.cuda.copy_of(&vec![0u64; bins])?;
        let bins_of = bins as i32;
        self.on_cells("histogram", &[arg(&width), arg(&bins_of), arg(&counts.at)])?;
        counts.read(0, bins)
    }

    fn gaps(&self) -> Result<Vec<Field>> {
        let contacts = self.layout.shapes.iter().zip(self.layout.starts());
        contacts.map(|(shape, start)| self.read(&self.gap, start, *shape)).collect()
    }

    fn multiply(&mut self, single: bool) -> Result<()> {
        self.filter(self.compliance, single)
    }

    fn bytes(&self) -> usize {
        let fields = [&self.gap, &self.pressure, &self.touch, &self.kept, &self.direction, &self.buffer];
        let all = fields.into_iter().chain([&self.set, &self.pattern]).chain(self.preconditioner.memory());
        let all =
            all.into_iter().chain(&self.upper).chain(&self.tables).chain(&self.spectra).chain([&self.work]);
        all.map(|memory| memory.bytes).sum()
    }

    fn wait(&self) -> Result<()> {
        self.cuda.bind()?;
        self.cuda.checked(self.cuda.shared.context.synchronize())
    }

    fn results(&self) -> Result<Vec<[Field; 2]>> {
        let contacts = self.layout.shapes.iter().zip(self.layout.starts());
        let both = |(shape, start): (&[usize; 2], u64)| -> Result<[Field; 2]> {
            let (mut u, h) = (self.read(&self.touch, start, *shape)?, self.read(&self.gap, start, *shape)?);
            u -= &h;
            Ok([self.read(&self.pressure, start, *shape)?, u])
        };
        contacts.map(both).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_kernels_that_are_named_are_those_of_the_text() {
        let of_macros = ["clear_outside", "clear_outside_single", "multiply", "multiply_single"];
        let defined = KERNELS.matches("__global__ void ").count() - 2 + of_macros.len();
        assert_eq!(defined, NAMES.len());
        for name in NAMES {
            let plain = KERNELS.contains(&format!("__global__ void {name}("));
            assert!(plain || of_macros.contains(&name), "{name}");
        }
        assert!(NAMES.is_sorted());
    }

    #[test]
    fn a_machine_without_a_gpu_says_what_is_missing() {
        match Cuda::open() {
            Ok(cuda) => assert!(cuda.card().unwrap().memory > 0.0),
            Err(error) => assert!(matches!(error, Error::NoDevice { .. }), "{error}"),
        }
    }
}
