//! The preconditioner on a GPU.

#![deny(unsafe_code)]

use asperity_base::error::Result;
use cudarc::cufft::sys::cufftType_t::{CUFFT_C2R, CUFFT_R2C};

use super::{Cuda, CudaFields, Layout, Memory, Plan, Spectrum, Transforms, arg, waves};
use crate::nodes::{MIN_COVER, Nodes};
use crate::problem::{Harmonics, Level, Precision};

/// The preconditioner of all contacts on one grid.
pub(super) struct Preconditioner {
    nodes: Nodes,
    arguments: Arguments,
    /// The rows of the sparse inverse, for each pattern; empty until they are taken.
    inverse: Memory,
    /// Whether the columns are periodic.
    wrap: i32,
    /// Address of the image of the residual under a factor of the sparse inverse.
    image: u64,
    /// Transforms of the nodes, there and back.
    plans: Vec<Plan>,
    stiffness: Spectrum,
    table: Option<Memory>,
    precision: Precision,
    /// Work area of the transforms of the nodes, and what the arguments point to besides the fields.
    memory: Vec<Memory>,
}

/// The structure `Nodes` of the kernels.
#[repr(C)]
#[derive(Clone, Copy)]
struct Arguments {
    shapes: u64,
    starts: u64,
    contacts: i32,
    rows: i32,
    columns: i32,
    stride: i32,
    width: i32,
    spacing: [f64; 2],
    lines: u64,
    weight: u64,
    restricted: u64,
    solved: u64,
}

impl Preconditioner {
    /// Creates the preconditioner, without the sparse inverse, from the shapes of the contacts on the device. It
    /// has its scratch in the `work` area of the transforms of the cells as far as that has room.
    pub(super) fn new(
        cuda: &Cuda,
        layout: &Layout,
        level: &Level,
        precision: Precision,
        [shapes, work]: [&Memory; 2],
    ) -> Result<Self> {
        let nodes = Nodes::new(level);
        let [rows, columns] = nodes.shape;
        let contacts = layout.shapes.len();
        let plan = |kind| cuda.plan(Transforms { kind, shape: nodes.shape, count: contacts });
        let plans = vec![plan(CUFFT_R2C)?, plan(CUFFT_C2R)?];
        let mut memory = vec![cuda.memory(plans.iter().map(|plan| plan.work).max().unwrap_or(0))?];
        for plan in &plans {
            plan.work_in(cuda, &memory[0])?;
        }
        let mut keep = |part: Memory| {
            let at = part.at;
            memory.push(part);
            at
        };
        let mut used = 0;
        let mut scratch = |bytes: usize, keep: &mut dyn FnMut(Memory) -> u64| -> Result<u64> {
            if used + bytes > work.bytes {
                return Ok(keep(cuda.memory(bytes)?));
            }
            let at = work.at + used as u64;
            used += bytes.next_multiple_of(256);
            Ok(at)
        };
        let stride = 2 * (columns / 2 + 1);
        let width = layout.shapes.iter().map(|[_, columns]| *columns).max().unwrap_or(0);
        let image = scratch(4 * layout.cells(), &mut keep)?;
        let lines = scratch(4 * contacts * rows * width, &mut keep)?;
        let on_nodes = || cuda.memory(4 * contacts * rows * stride);
        let arguments = Arguments {
            shapes: shapes.at,
            starts: keep(cuda.copy_of(&layout.first_rows())?),
            contacts: contacts as i32,
            rows: rows as i32,
            columns: columns as i32,
            stride: stride as i32,
            width: width as i32,
            spacing: nodes.spacing,
            lines,
            weight: keep(on_nodes()?),
            restricted: keep(on_nodes()?),
            solved: keep(on_nodes()?),
        };
        let [_, wrap] = level.wraps(layout.shapes[0]);
        let mut stiffness = waves(level, false);
        let table = match &level.harmonics {
            Harmonics::HalfSpaces(_) => None,
            Harmonics::Table(table) => {
                let bins = (0..rows / 2 + 1).flat_map(|k| (0..columns / 2 + 1).map(move |l| [k, l]));
                let values: Vec<f64> = bins.map(|bins| 1.0 / table[bins]).collect();
                Some(cuda.state_of(&values, precision)?)
            }
        };
        stiffness.table = table.as_ref().map_or(0, |table| table.at);
        let inverse = cuda.memory(0)?;
        let wrap = i32::from(wrap);
        Ok(Self { nodes, arguments, inverse, wrap, image, plans, stiffness, table, precision, memory })
    }

    /// Takes the rows of the sparse inverse.
    pub(super) fn take(&mut self, cuda: &Cuda, rows: &[[f32; 7]]) -> Result<()> {
        self.inverse = cuda.copy_of(rows.as_flattened())?;
        Ok(())
    }

    /// Sets the stiffness of the mean if so many `free` ones of all `cells` bear a pressure.
    pub(super) fn set_mean(&mut self, free: f64, cells: f64) -> Result<()> {
        let of_mean = self.nodes.stiffness_of_mean(free, cells);
        self.stiffness.at_zero = of_mean;
        self.table.as_ref().map_or(Ok(()), |table| table.set_state(0, &[of_mean], self.precision))
    }

    /// Adapts to the predicted sets of the fields.
    pub(super) fn adapt(&self, fields: &CudaFields) -> Result<()> {
        fields.on_cells("patterns", &[arg(&self.wrap)])?;
        self.sum_lines(fields, 0)?;
        fields.run("set_weight", &[arg(&self.arguments), arg(&MIN_COVER)])
    }

    /// Replaces the residual in the buffer of the fields by the preconditioned one.
    pub(super) fn apply(&self, fields: &CudaFields) -> Result<()> {
        let buffer = fields.buffer.at;
        let each = 1.0 / self.nodes.cells();
        self.sum_lines(fields, buffer)?;
        fields.run("set_restricted", &[arg(&self.arguments)])?;
        self.multiply(fields)?;
        let interpolate = |solved: i32, factor: f64| {
            fields.on_cells("interpolate", &[arg(&buffer), arg(&self.arguments), arg(&solved), arg(&factor)])
        };
        interpolate(0, -each)?;
        let inverse = self.inverse.at;
        for name in ["to_factor", "from_factor"] {
            fields.on_cells(name, &[arg(&buffer), arg(&self.image), arg(&inverse), arg(&self.wrap)])?;
        }
        self.sum_lines(fields, buffer)?;
        fields.run("set_solved", &[arg(&self.arguments)])?;
        interpolate(1, 1.0)
    }

    /// Sums the values of the buffer along x, or 1 for each free cell if it is 0.
    fn sum_lines(&self, fields: &CudaFields, buffer: u64) -> Result<()> {
        fields.on_cells("sum_lines", &[arg(&buffer), arg(&self.arguments)])
    }

    /// Multiplies the waves of the nodes by their stiffness.
    fn multiply(&self, fields: &CudaFields) -> Result<()> {
        let Arguments { contacts, rows, columns, .. } = self.arguments;
        let half = columns / 2 + 1;
        let scale = 1.0 / (f64::from(rows) * f64::from(columns) * self.nodes.cells());
        let solved = self.solved();
        self.plans[0].transform(&fields.cuda, solved)?;
        let arguments =
            [arg(&solved.at), arg(&self.stiffness), arg(&contacts), arg(&rows), arg(&half), arg(&scale)];
        fields.run("multiply_single", &arguments)?;
        self.plans[1].transform(&fields.cuda, solved)
    }

    fn solved(&self) -> &Memory {
        self.memory.last().expect("the solution is the last")
    }

    /// Returns the memory that it has of its own.
    pub(super) fn memory(&self) -> impl Iterator<Item = &Memory> {
        self.memory.iter().chain([&self.inverse]).chain(&self.table)
    }

    /// Takes the plans out, to give them back.
    pub(super) fn plans(&mut self) -> impl Iterator<Item = Plan> {
        self.plans.drain(..)
    }
}
