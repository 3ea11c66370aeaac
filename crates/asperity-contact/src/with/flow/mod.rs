//! Flow of a fluid through the gap of a contact.
//!
//! A thin, slow flow of constant viscosity η follows Reynolds' equation: the flux per width is
//! `q = −(k/12η) ∇P` with the permeability `k = g³` of the local gap g, and `∇·q = 0`. The pressure P of the
//! fluid does not deform the bodies. Cells whose gap is not positive are in contact, and closed.
//!
//! [`solve`] computes the permeability of the whole gap: a tensor K with the mean flux `−K ∇P/12η`, in m³.
//!
//! ```
//! use asperity_contact::flow::{Fluid, Settings, solve};
//! use asperity_contact::{Field, Grid};
//!
//! // A gap of 1 µm with a row of contacts of 4 × 4 cells.
//! let grid = Grid::new([16, 16], [1e-6; 2])?;
//! let gap = Field::from_shape_fn(grid.shape, |(i, j)| if i < 4 && j < 4 { 0.0 } else { 1e-6 });
//! let flow = solve(&gap, &grid, &Settings::default())?;
//!
//! let along_x = flow.along[0].as_ref().expect("both directions are solved by default");
//! assert!(along_x.hydraulic_gap < 1e-6 && along_x.critical_gap == 1e-6);
//! // Water at a pressure drop of 1 bar, m³/s.
//! let leakage = along_x.leakage(&Fluid { viscosity: 1e-3, drop: 1e5, outlet: None })?;
//! assert!((leakage - along_x.permeability * 1e5 / 12e-3).abs() < 1e-12 * leakage);
//! # Ok::<(), asperity_contact::Error>(())
//! ```

mod comparisons;
mod components;
mod constriction;
mod doubts;
mod faces;
mod factor;
mod fluid;
mod multigrid;
mod observer;
mod ordering;
mod pressure;
mod record;
mod rules;
mod shear;
mod solver;
mod table;
mod views;

pub use comparisons::{effective_medium, patir_cheng, patir_cheng_shear, single_constriction};
pub use doubts::doubts;
pub use faces::Faces;
pub use fluid::Fluid;
pub use observer::FlowObserver;
pub use record::FlowRecord;
pub use shear::{ShearFlow, shear_flow, sliding_stress_factor};
pub use table::Leakage;
pub use views::{CONSTRICTION, LEAST_FLOW, TITLES, leaks};

use ndarray::Array2;

use components::{AT_END, AT_START, Components, WINDS_X, WINDS_Y};
use faces::{Network, Topology};
use pressure::Solved;
use solver::{FEWEST, Solver};

use crate::error::{Error, Result, check_in};
use crate::grid::{Field, Grid, check_finite, in_rows};
use crate::math::parallel;
use crate::units::{CubicMetre, Dimension, Metre};
use crate::with::views::{Answer, Curve, Line, Map};
use crate::with::{Capability, Given, Rule, Surroundings};
use asperity_base::choice::choice;

/// Work of a flow along both axes over that of a convolution: 0.2 to 0.4 µs for each cell and log₂ of their
/// number.
const EFFORT: f64 = 250.0;

impl Capability for Leakage {
    const NAME: &'static str = "flow";
    const TITLE: &'static str = "Leakage";
    const MEANING: &'static str = "flow of a fluid through the gap";
    const VERB: &'static str = "leaks";

    type Row = FlowRecord;
    type Observer = FlowObserver;

    const RULES: &'static [Rule<Self>] = rules::RULES;
    const CURVES: &'static [Curve<FlowRecord>] = views::CURVES;
    const MAPS: &'static [Map<FlowRecord>] = views::MAPS;
    const CONSTANTS: &'static [&'static str] = &[];
    const PREFIXES: &'static [&'static str] = &["flow_x_", "flow_y_"];

    fn every(&self) -> usize {
        self.every
    }

    fn begin(&self, given: &Given<'_>) -> Result<FlowObserver> {
        Ok(FlowObserver::new(self, given))
    }

    fn summary(rows: &[FlowRecord]) -> Vec<FlowRecord> {
        match rows.last() {
            Some(last) if last.pass.is_some() => FlowRecord::means(rows),
            _ => FlowRecord::last(rows).to_vec(),
        }
    }

    fn describe(&self, surroundings: &Surroundings) -> String {
        views::describe(self, surroundings)
    }

    fn answers(&self, rows: &[FlowRecord]) -> Vec<Answer> {
        views::answers(self, rows)
    }

    fn numbers(&self, row: &FlowRecord) -> Vec<Line> {
        views::numbers(self, row)
    }

    fn doubts(&self, rows: &[FlowRecord], surroundings: &Surroundings) -> Vec<String> {
        doubts::of_rows(self, rows, surroundings)
    }

    fn prefix(row: &FlowRecord, _: &str) -> &'static str {
        Self::PREFIXES[row.along as usize]
    }

    fn effort(&self) -> f64 {
        EFFORT
    }

    fn memory(shape: [usize; 2]) -> f64 {
        memory(shape) + 16.0 * (shape[0] * shape[1]) as f64
    }
}

/// Continuation of the gap beyond the ends of the grid, along the pressure gradient.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Ends {
    /// The gap itself, over and over, under a constant mean gradient.
    #[default]
    Periodic,
    /// A reservoir at each end: the pressures are given at the outer faces of the first and the last cells.
    Reservoirs,
}

choice!(Ends: "periodic" => Periodic, "reservoirs" => Reservoirs);

/// Continuation of the gap beyond the sides of the grid, along the other axis.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Sides {
    /// The gap itself, over and over.
    #[default]
    Periodic,
    /// Walls.
    Closed,
}

choice!(Sides: "periodic" => Periodic, "closed" => Closed);

/// Directions of the pressure gradient.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Along {
    /// Along x alone.
    X,
    /// Along y alone.
    Y,
    /// Along x, and in a second solution along y.
    #[default]
    Both,
}

choice!(Along: "x" => X, "y" => Y, "both" => Both);

impl Along {
    /// Whether the flow along x, and along y, is wanted.
    pub fn axes(self) -> [bool; 2] {
        [self != Self::Y, self != Self::X]
    }
}

/// Settings of a flow.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Settings {
    /// The ends of the grid along the gradient.
    pub ends: Ends,
    /// The sides of the grid.
    pub sides: Sides,
    /// The transmissibilities of the faces between cells.
    pub faces: Faces,
    /// The directions of the gradient.
    pub along: Along,
}

impl Settings {
    /// Returns the settings for ends and sides that differ between a flow along x and one along y: one for
    /// both axes if they are alike, else one for each axis that is wanted.
    pub fn of_axes(ends: [Ends; 2], sides: [Sides; 2], faces: Faces, along: Along) -> Vec<Self> {
        let one = |axis: usize, along| Self { ends: ends[axis], sides: sides[axis], faces, along };
        if ends[0] == ends[1] && sides[0] == sides[1] {
            return vec![one(0, along)];
        }
        let each = [(0, Along::X), (1, Along::Y)].into_iter();
        each.filter(|(axis, _)| along.axes()[*axis]).map(|(axis, along)| one(axis, along)).collect()
    }
}

/// Flow through a gap.
#[derive(Debug, Clone)]
pub struct Flow {
    /// Flow under a gradient along x and along y; `None` for a direction that was not asked for.
    pub along: [Option<FlowAlong>; 2],
    /// K_xy = K_yx, m³; `None` unless both directions are solved with periodic ends and sides.
    pub coupling: Option<CubicMetre>,
    /// Mean gap over all cells, closed ones as 0, m.
    pub mean_gap: Metre,
    /// Share of closed cells, 0 … 1.
    pub closed_share: f64,
    /// The [effective medium](effective_medium) of these gaps, m³: a comparison.
    pub effective_medium: CubicMetre,
}

/// Flow under a pressure gradient along one axis.
///
/// All of its numbers are 0 if no path is open along this axis.
#[derive(Debug, Clone)]
pub struct FlowAlong {
    /// Permeability K_xx or K_yy, m³: the mean flux per width is K ΔP/(12 η L) for a pressure drop ΔP over
    /// the length L.
    pub permeability: CubicMetre,
    /// Gap between parallel plates of this permeability, ∛K, m.
    pub hydraulic_gap: Metre,
    /// K over the cube of the mean gap.
    pub flow_factor: f64,
    /// Critical constriction: the largest gap that all cells of some path along the axis reach, m.
    pub critical_gap: Metre,
    /// The cell `[ix, iy]` of the critical constriction; `None` without a path.
    pub critical_cell: Option<[usize; 2]>,
    /// Width of the critical constriction: open cells in a row across the axis; 0 without a path.
    pub critical_cells: usize,
    /// Share of the cells of the grid that are part of a path, with their dead ends, 0 … 1.
    pub flowing_share: f64,
    /// Volume in the open cells from which no path leads out, m³: around no period, and to neither end.
    pub trapped_volume: CubicMetre,
    /// Bounds of the permeability with the other [`Faces`], m³, by the principles of Thomson and Dirichlet.
    pub other_faces: [CubicMetre; 2],
    /// Estimate of the relative error of the permeability: its relative difference to the geometric mean of
    /// the bounds for the other faces.
    pub estimate: f64,
    /// Largest relative difference of the flux through a section across the axis from the mean of all
    /// sections.
    pub residual: f64,
    /// Relative difference of the work Σ q²/T that is dissipated in all faces from that of the mean flux.
    pub dissipation: f64,
    /// Largest imbalance of the fluxes of a cell over the largest flux.
    pub imbalance: f64,
    /// Solutions for what was left of the imbalance.
    pub rounds: usize,
    /// Pressure at the centres of the cells over the pressure drop: 1 at the start of the axis, 0 at its end.
    /// 0 in closed cells, and where no path leads to an end. For an ideal gas it is the square of the
    /// pressure that falls like this.
    pub pressure: Field,
    /// Flux per width through the faces across x, `[nx + 1, ny]`, and across y, `[nx, ny + 1]`, over the mean
    /// gradient and 1/12η, m³. Its mean is the permeability. The first and the last face of a periodic axis
    /// are the same.
    pub flux: [Field; 2],
    /// Whether a cell is part of a path along the axis.
    pub flowing: Array2<bool>,
    /// Length of the grid along the axis.
    length: Metre,
    /// Width of the grid across the axis.
    width: Metre,
    /// Whether the axis is y.
    is_along_y: bool,
}

impl FlowAlong {
    /// Returns the stress factor φ_fp: the mean of gap times gradient of pressure, over the mean gap times the mean
    /// gradient; 0 without a path. The gap is that of the flow.
    pub fn pressure_stress_factor(&self, gap: &Field) -> f64 {
        let [along_x, along_y] = self.flux_at_centres();
        let flux = if self.is_along_y { along_y } else { along_x };
        let flowing = gap.iter().zip(&flux).filter(|(gap, _)| **gap > 0.0);
        let mean = gap.iter().map(|gap| gap.max(0.0)).sum::<f64>();
        // −∂P/∂x = q/g³, of a unit gradient.
        if mean > 0.0 { flowing.map(|(gap, flux)| flux / (gap * gap)).sum::<f64>() / mean } else { 0.0 }
    }

    /// Computes the flux per width at the centres of the cells, m³ as [`Self::flux`]: `[along x, along y]`,
    /// means of two faces.
    pub fn flux_at_centres(&self) -> [Field; 2] {
        let shape = self.pressure.dim();
        let [x, y] = &self.flux;
        [
            Field::from_shape_fn(shape, |(i, j)| 0.5 * (x[[i, j]] + x[[i + 1, j]])),
            Field::from_shape_fn(shape, |(i, j)| 0.5 * (y[[i, j]] + y[[i, j + 1]])),
        ]
    }
}

impl Flow {
    /// Returns the permeability tensor, m³; `None` unless both directions are solved with periodic ends and
    /// sides.
    pub fn permeability(&self) -> Option<[[CubicMetre; 2]; 2]> {
        let [x, y] = self.along.each_ref().map(|along| along.as_ref().map(|along| along.permeability));
        let (x, y, xy) = (x?, y?, self.coupling?);
        Some([[x, xy], [xy, y]])
    }
}

/// Largest relative difference of sections, or of the dissipation, with which a flow is returned.
const TOLERANCE: f64 = 1e-10;

/// Estimates the memory that [`solve`] needs for a gap of this shape, bytes, if all cells are open.
pub fn memory(shape: [usize; 2]) -> f64 {
    let cells = shape[0] as f64 * shape[1] as f64;
    let side = shape[0].min(shape[1]).max(2) as f64;
    // Entries of the factor of a square grid: 52 a cell at 128², 60 at 256². Levels and vectors of multigrid: 88 bytes a cell.
    let solver = if cells < FEWEST as f64 { 1.3 * (8.5 * side.log2() - 7.0).max(10.0) } else { 11.0 };
    8.0 * cells * (solver + 40.0)
}

/// Solves for the flow through a `gap`, in metres. Cells whose gap is not positive are closed.
///
/// Up to 30 000 flowing cells are eliminated. More are solved for by multigrid, whose time and memory are linear in their
/// number. They are eliminated too if that does not converge, so that any contrast of the gaps is permitted. Gaps below
/// 10⁻²⁰ of the largest count as closed. The answer does not depend on the number of threads.
///
/// # Errors
/// - [`Error::GridMismatch`] if the gap has another shape than the grid.
/// - [`Error::NotFinite`] if a gap is NaN or infinite.
/// - [`Error::OutOfRange`] if the largest gap exceeds the largest length.
/// - [`Error::NotConverged`] if the flux differs from section to section by more than 10⁻¹⁰, or the dissipation from its mean value.
///
/// No open path is no error: the permeability is 0.
pub fn solve(gap: &Field, grid: &Grid, settings: &Settings) -> Result<Flow> {
    let shape = grid.shape;
    if gap.dim() != (shape[0], shape[1]) {
        let text = |[nx, ny]: [usize; 2]| format!("{nx} × {ny}");
        let left = text([gap.nrows(), gap.ncols()]);
        return Err(Error::GridMismatch {
            what: "shape of the gap and of its grid",
            left,
            right: text(shape),
        });
    }
    check_finite("gap", &shape, gap.iter())?;
    let largest = gap.iter().fold(0.0_f64, |most, gap| most.max(*gap));
    let most = Dimension::Length.range().most;
    check_in(Dimension::Length, "gap", largest, largest <= most, "at most 1e6 m")?;

    let gap = in_rows(gap);
    let gaps = Gaps::new(&gap, grid, largest);
    let asked = settings.along.axes();
    let periodic = settings.ends == Ends::Periodic && settings.sides == Sides::Periodic;
    let mut along = [None, None];
    let mut coupling = None;
    if periodic {
        // One solver serves both directions.
        let part = Part::new(&gaps, Topology { shape, closed: [false; 2], between: None }, settings.faces);
        if asked == [true; 2] {
            let [x, y] = part.solve([0, 1])?;
            let scale = gaps.permeability / grid.cells() as f64;
            coupling = Some(x.0.work(&y.0, &part.network) * scale);
            along = [Some(x.1), Some(y.1)];
        } else {
            let axis = usize::from(asked[1]);
            let [only] = part.solve([axis])?;
            along[axis] = Some(only.1);
        }
    } else {
        let axes = (0..2).filter(|axis| asked[*axis]);
        let solved = parallel::tasks(axes, |axis| {
            let mut closed = [settings.sides == Sides::Closed; 2];
            closed[axis] = settings.ends == Ends::Reservoirs;
            let between = (settings.ends == Ends::Reservoirs).then_some(axis);
            let part = Part::new(&gaps, Topology { shape, closed, between }, settings.faces);
            part.solve([axis]).map(|[solved]| (axis, solved.1))
        });
        for solved in solved {
            let (axis, solved) = solved?;
            along[axis] = Some(solved);
        }
    }
    let open = gaps.scaled.iter().filter(|gap| **gap > 0.0).count();
    Ok(Flow {
        along,
        coupling,
        mean_gap: gaps.mean * largest,
        closed_share: 1.0 - open as f64 / grid.cells() as f64,
        effective_medium: effective_medium(&gap),
    })
}

/// Gaps over the largest one, below which a cell counts as closed: transmissibilities reach 10⁻⁶⁰ of the
/// largest.
const LEAST: f64 = 1e-20;

/// Gaps over the largest one.
struct Gaps<'a> {
    gap: &'a Field,
    scaled: Vec<f64>,
    grid: &'a Grid,
    largest: Metre,
    /// Mean of the scaled gaps.
    mean: f64,
    /// Permeability of the largest gap.
    permeability: f64,
}

impl<'a> Gaps<'a> {
    fn new(gap: &'a Field, grid: &'a Grid, largest: Metre) -> Self {
        let scale = if largest > 0.0 { largest } else { 1.0 };
        let open = |gap: f64| if gap > LEAST * scale { gap / scale } else { 0.0 };
        let scaled: Vec<f64> = gap.iter().map(|gap| open(*gap)).collect();
        let mean = scaled.iter().sum::<f64>() / scaled.len() as f64;
        Self { gap, scaled, grid, largest, mean, permeability: largest.powi(3) }
    }
}

/// A gap with its ends and sides, and what its cells are connected to.
struct Part<'a> {
    gaps: &'a Gaps<'a>,
    topology: Topology,
    faces: Faces,
    network: Network,
    /// Marks of the component of each cell.
    marks: Vec<u8>,
}

impl<'a> Part<'a> {
    fn new(gaps: &'a Gaps<'a>, topology: Topology, faces: Faces) -> Self {
        let network = Network::new(&gaps.scaled, gaps.grid.pitch, faces, topology);
        let mut components = Components::from_network(&network);
        let marks = (0..network.cells()).map(|cell| components.marks(cell)).collect();
        Self { gaps, topology, faces, network, marks }
    }

    /// Returns the marks of a component that carries a flow along `axis`.
    fn needed(&self, axis: usize) -> u8 {
        if self.topology.between.is_some() { AT_START | AT_END } else { [WINDS_X, WINDS_Y][axis] }
    }

    fn solve<const N: usize>(&self, axes: [usize; N]) -> Result<[(Solved, FlowAlong); N]> {
        let flowing = axes.map(|axis| {
            let needed = self.needed(axis);
            self.marks.iter().map(|marks| marks & needed == needed).collect::<Vec<bool>>()
        });
        let wanted: Vec<bool> =
            (0..self.marks.len()).map(|cell| flowing.iter().any(|flowing| flowing[cell])).collect();
        let periodic = self.topology.closed.map(|closed| !closed);
        let mut solver = Solver::new(&self.network, &wanted, periodic);
        let each: [usize; N] = std::array::from_fn(|n| n);
        let solved = each.map(|n| pressure::solve(&self.network, &mut solver, axes[n], &flowing[n]));
        drop(solver);
        let paths =
            constriction::constrictions(&self.gaps.scaled, self.topology, axes.map(|axis| self.needed(axis)));
        let other = match self.faces {
            Faces::Linear => Faces::Harmonic,
            Faces::Harmonic => Faces::Linear,
        };
        let other = Network::new(&self.gaps.scaled, self.gaps.grid.pitch, other, self.topology);
        let mut results = Vec::with_capacity(N);
        for ((solved, flowing), path) in solved.into_iter().zip(flowing).zip(paths) {
            let along = self.along(&solved, flowing, path, &other)?;
            results.push((solved, along));
        }
        Ok(results.try_into().unwrap_or_else(|_| unreachable!("one result for each axis")))
    }

    /// Converts a solution to SI, and checks it.
    fn along(
        &self,
        solved: &Solved,
        flowing: Vec<bool>,
        path: Option<usize>,
        other: &Network,
    ) -> Result<FlowAlong> {
        let (grid, axis) = (self.gaps.grid, solved.axis);
        let [nx, ny] = grid.shape;
        let across = 1 - axis;
        let steps = grid.shape[axis] as f64;
        // Length over which the unit of pressure falls.
        let length =
            if self.topology.between.is_some() { steps * grid.pitch[axis] } else { grid.pitch[axis] };
        let width = grid.extent()[across];
        let scaled = solved.through * length / width;
        let permeability = scaled * self.gaps.permeability;
        let drop = if self.topology.between.is_some() { 1.0 } else { steps };
        let dissipation = if solved.through > 0.0 {
            (solved.work(solved, &self.network) / (solved.through * drop) - 1.0).abs()
        } else {
            0.0
        };
        let residual = solved.sections.max(dissipation);
        if residual.is_nan() || residual > TOLERANCE {
            return Err(Error::NotConverged { iterations: solved.rounds, residual, tolerance: TOLERANCE });
        }
        let bounds = solved.bounds(&self.network, other);
        let estimate = if scaled > 0.0 { (1.0 - (bounds[0] * bounds[1]).sqrt()).abs() } else { 0.0 };

        let out = if self.topology.between.is_some() { AT_START | AT_END } else { WINDS_X | WINDS_Y };
        let trapped: f64 = (self.gaps.scaled.iter().zip(&self.marks))
            .filter(|(_, marks)| **marks & out == 0)
            .map(|(gap, _)| gap)
            .sum();
        let pressure = Field::from_shape_fn([nx, ny], |(i, j)| {
            let cell = i * ny + j;
            if flowing[cell] {
                let fallen = ([i, j][axis] as f64 + 0.5) / steps;
                if self.topology.between.is_some() {
                    solved.pressure[cell]
                } else {
                    1.0 - fallen + solved.pressure[cell] / steps
                }
            } else if self.marks[cell] & AT_START != 0 {
                1.0
            } else {
                0.0
            }
        });
        let at_edge = |direction: usize, index: usize, line: usize| {
            if self.topology.between == Some(direction) && direction == axis {
                return solved.ends[usize::from(index > 0)][line];
            }
            // The face before the first cell and the one after the last are the same, and 0 at a wall.
            solved.flux[direction][if direction == 0 { line } else { line * ny }]
        };
        let flux = [0, 1].map(|direction| {
            let unit = length / grid.pitch[1 - direction] * self.gaps.permeability;
            let mut faces = grid.shape;
            faces[direction] += 1;
            Field::from_shape_fn(faces, |(i, j)| {
                let (index, line) = if direction == 0 { (i, j) } else { (j, i) };
                let through = if index == 0 || index == grid.shape[direction] {
                    at_edge(direction, index, line)
                } else {
                    solved.flux[direction][i * ny + j]
                };
                through * unit
            })
        });
        let flowing_cells = flowing.iter().filter(|flowing| **flowing).count();
        Ok(FlowAlong {
            permeability,
            hydraulic_gap: permeability.cbrt(),
            flow_factor: if scaled > 0.0 { scaled / self.gaps.mean.powi(3) } else { 0.0 },
            critical_gap: path.map_or(0.0, |cell| self.gaps.gap[[cell / ny, cell % ny]]),
            critical_cell: path.map(|cell| [cell / ny, cell % ny]),
            critical_cells: path.map_or(0, |cell| {
                constriction::width(&self.gaps.scaled, grid.shape, cell, axis, !self.topology.closed[across])
            }),
            flowing_share: flowing_cells as f64 / grid.cells() as f64,
            trapped_volume: trapped * self.gaps.largest * grid.cell_area(),
            other_faces: bounds.map(|bound| bound * permeability),
            estimate,
            residual: solved.sections,
            dissipation,
            imbalance: solved.imbalance,
            rounds: solved.rounds,
            pressure,
            flux,
            flowing: Array2::from_shape_vec((nx, ny), flowing).expect("a cell has a place"),
            length: grid.extent()[axis],
            width,
            is_along_y: axis == 1,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::math::Cholesky;
    use approx::assert_relative_eq;

    /// Permeability along an axis by a dense nodal solution over all open cells, one of each component held.
    fn nodal(gap: &Field, grid: &Grid, settings: &Settings, axis: usize) -> [f64; 2] {
        let [nx, ny] = grid.shape;
        let reservoirs = settings.ends == Ends::Reservoirs;
        let mut closed = [settings.sides == Sides::Closed; 2];
        closed[axis] = reservoirs;
        // Faces as pairs of cells with their transmissibility and direction.
        let mut faces = Vec::new();
        for (i, j) in ndarray::indices([nx, ny]) {
            for (direction, to) in [(0, ((i + 1) % nx, j)), (1, (i, (j + 1) % ny))] {
                let last = [i + 1 == nx, j + 1 == ny][direction];
                let mean = settings.faces.mean(gap[[i, j]], gap[to]);
                if mean > 0.0 && !(last && closed[direction]) {
                    let t = mean * grid.pitch[1 - direction] / grid.pitch[direction];
                    faces.push((i * ny + j, to.0 * ny + to.1, direction, t));
                }
            }
        }
        let end = |cell: usize, index: usize| {
            let at = [cell / ny, cell % ny];
            let k = gap[at].max(0.0).powi(3);
            let t = 2.0 * k * grid.pitch[1 - axis] / grid.pitch[axis];
            if reservoirs && at[axis] == index { t } else { 0.0 }
        };
        let n = nx * ny;
        let last = grid.shape[axis] - 1;
        let mut matrix = Field::zeros([n, n]);
        let mut right = vec![0.0; n];
        for &(a, b, direction, t) in &faces {
            matrix[[a, a]] += t;
            matrix[[b, b]] += t;
            matrix[[a, b]] -= t;
            matrix[[b, a]] -= t;
            if direction == axis && !reservoirs {
                right[a] -= t;
                right[b] += t;
            }
        }
        let mut grounded = vec![false; n];
        for cell in 0..n {
            matrix[[cell, cell]] += end(cell, 0) + end(cell, last);
            right[cell] += end(cell, 0);
            grounded[cell] = end(cell, 0) + end(cell, last) > 0.0;
        }
        // Components by spreading from cell to cell.
        let mut part: Vec<usize> = (0..n).collect();
        for _ in 0..n {
            for &(a, b, ..) in &faces {
                let least = part[a].min(part[b]);
                (part[a], part[b]) = (least, least);
            }
        }
        for root in 0..n {
            let members = || (0..n).filter(|cell| part[*cell] == root);
            if part[root] == root && !members().any(|cell| grounded[cell]) {
                matrix[[root, root]] += 1.0;
            }
        }
        let pressure = Cholesky::new(matrix).expect("positive definite").solve(&right);
        let mut mean = [0.0; 2];
        for &(a, b, direction, t) in &faces {
            let drive = if direction == axis && !reservoirs { 1.0 } else { 0.0 };
            mean[direction] += t * (pressure[a] - pressure[b] + drive);
        }
        if reservoirs {
            let inflow: f64 = (0..n).map(|cell| end(cell, 0) * (1.0 - pressure[cell])).sum();
            let [length, width] = [grid.extent()[axis], grid.extent()[1 - axis]];
            return [inflow * length / width, 0.0];
        }
        let per_gradient = grid.pitch[axis] / (n as f64);
        [mean[axis] * per_gradient / grid.pitch[1 - axis], mean[1 - axis] * per_gradient / grid.pitch[axis]]
    }

    fn any_settings(u: &mut arbtest::arbitrary::Unstructured) -> arbtest::arbitrary::Result<Settings> {
        Ok(Settings {
            ends: *u.choose(&[Ends::Periodic, Ends::Reservoirs])?,
            sides: *u.choose(&[Sides::Periodic, Sides::Closed])?,
            faces: *u.choose(&[Faces::Linear, Faces::Harmonic])?,
            along: Along::Both,
        })
    }

    #[test]
    fn three_hundred_random_contacts_agree_with_a_dense_solution() {
        let mut cases = 0;
        let mut flowing = 0;
        let test = |u: &mut arbtest::arbitrary::Unstructured| {
            let shape = [u.int_in_range(1..=9)?, u.int_in_range(1..=9)?];
            let pitch = [1.0, f64::from(u.int_in_range(2..=30)?) / 10.0];
            let contact = u.int_in_range(0..=60)?;
            let mut gap = Field::zeros(shape);
            for gap in &mut gap {
                let open = u.int_in_range(0..=99)? >= contact;
                *gap = if open { f64::from(u.int_in_range(10..=1000)?) * 1e-3 } else { -0.1 };
            }
            let (grid, settings) = (Grid::new(shape, pitch).unwrap(), any_settings(u)?);
            let flow = solve(&gap, &grid, &settings).unwrap();
            cases += 1;
            for (axis, along) in flow.along.iter().enumerate() {
                let along = along.as_ref().unwrap();
                let [own, across] = nodal(&gap, &grid, &settings, axis);
                assert!(
                    (along.permeability - own).abs() < 1e-11,
                    "{settings:?} {gap} {} {own}",
                    along.permeability
                );
                if let Some(coupling) = flow.coupling {
                    assert!((coupling - across).abs() < 1e-11, "{gap} {coupling} {across}");
                }
                assert!(along.critical_cell.is_some() == (along.permeability > 0.0));
                assert!(along.residual < 1e-13 && along.dissipation < 1e-12);
                flowing += usize::from(along.permeability > 0.0);
            }
            Ok(())
        };
        // A budget in time would make fewer cases of a slow machine.
        arbtest::arbtest(test).size_min(200).size_max(400).budget_ms(1_500);
        assert!(cases >= 300 && flowing > 150, "{cases} cases, {flowing} flows");
    }

    /// Scatter with a contrast of permeability up to 10¹⁸.
    fn scattered(seed: u64, shape: [usize; 2], contact: f64) -> Field {
        let mut state = seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1;
        let mut random = move || {
            state ^= state << 13;
            state ^= state >> 7;
            state ^= state << 17;
            (state >> 11) as f64 / (1u64 << 53) as f64
        };
        Field::from_shape_fn(shape, |_| if random() < contact { 0.0 } else { 10f64.powf(-6.0 * random()) })
    }

    #[test]
    fn every_section_carries_the_same_flux_at_a_contrast_of_1e18() {
        let mut flows = 0;
        for seed in 0..60 {
            let shape = [8 + (seed as usize * 7) % 41, 8 + (seed as usize * 13) % 37];
            let gap = scattered(seed, shape, 0.06 * (seed % 7) as f64);
            let grid = Grid::new(shape, [1e-6, 1.5e-6]).unwrap();
            for ends in [Ends::Periodic, Ends::Reservoirs] {
                let flow = solve(&gap, &grid, &Settings { ends, ..Settings::default() }).unwrap();
                for (axis, along) in flow.along.iter().flatten().enumerate() {
                    let mean = along.permeability * grid.shape[1 - axis] as f64;
                    if mean == 0.0 {
                        continue;
                    }
                    flows += 1;
                    for section in
                        along.flux[axis].lanes(ndarray::Axis(1 - axis)).into_iter().map(|s| s.sum())
                    {
                        assert!(
                            (section / mean - 1.0).abs() < 1e-12,
                            "seed {seed} {ends:?}: {section:e} {mean:e}"
                        );
                    }
                    assert!(along.residual < 1e-12 && along.dissipation < 1e-11, "{:e}", along.dissipation);
                }
            }
        }
        assert!(flows > 150, "{flows}");
    }

    #[test]
    fn sections_agree_where_two_halls_are_joined_by_a_pinhole() {
        // Wide halls, closed walls but for one cell of 10⁻⁶ of their gap: the flux is that of the pinhole.
        let n = 48;
        let gap = Field::from_shape_fn([n, n], |(i, j)| match i % 24 {
            0 if j == 17 => 1e-6,
            0 => 0.0,
            _ => 1.0 + 0.3 * ((i * j) as f64).sin(),
        });
        let grid = Grid::new([n, n], [1.0; 2]).unwrap();
        for ends in [Ends::Periodic, Ends::Reservoirs] {
            let flow =
                solve(&gap, &grid, &Settings { ends, along: Along::X, ..Settings::default() }).unwrap();
            let along = flow.along[0].as_ref().unwrap();
            assert!(along.residual < 1e-12 && along.dissipation < 1e-12, "{ends:?} {along:?}");
            assert_eq!(along.critical_gap, 1e-6);
            // The halls resist less by twelve orders of magnitude; a reservoir is half a cell from the first
            // pinhole.
            let faces = [(0, 1), (23, 24), (24, 25), (47, 0)];
            let resistance = faces.map(|(i, k)| Faces::Linear.mean(gap[[i, 17]], gap[[k, 17]]).recip());
            let series = match ends {
                Ends::Periodic => resistance.iter().sum::<f64>(),
                Ends::Reservoirs => resistance[..3].iter().sum::<f64>() + 0.5e18,
            };
            assert_relative_eq!(along.permeability, series.recip(), max_relative = 1e-10);
        }
    }

    #[test]
    fn a_network_and_its_dual_have_reciprocal_tensors() {
        // K′ = K/det K for the transmissibilities 1/T on the crossed faces.
        let (nx, ny) = (14, 10);
        let scatter = |seed| scattered(seed, [nx, ny], 0.0).mapv(|x| x.powf(0.3)).into_raw_vec_and_offset().0;
        let faces = [scatter(1), scatter(2)];
        let cell = |i: usize, j: usize| (i % nx) * ny + j % ny;
        let mut dual = [vec![0.0; nx * ny], vec![0.0; nx * ny]];
        for (i, j) in ndarray::indices([nx, ny]) {
            // Nodes of the dual lie at the corners after each cell; its face along x crosses one along y.
            dual[0][cell(i, j)] = 1.0 / faces[1][cell(i, j + 1)];
            dual[1][cell(i, j)] = 1.0 / faces[0][cell(i + 1, j)];
        }
        let tensor = |faces: [Vec<f64>; 2]| {
            let network = Network { shape: [nx, ny], faces, ends: None };
            let wanted = vec![true; nx * ny];
            let mut solver = Solver::new(&network, &wanted, [true; 2]);
            let [x, y] = [0, 1].map(|axis| pressure::solve(&network, &mut solver, axis, &wanted));
            let xy = x.work(&y, &network) / (nx * ny) as f64;
            [x.through / ny as f64, xy, y.through / nx as f64]
        };
        let ([xx, xy, yy], [dual_xx, dual_xy, dual_yy]) = (tensor(faces), tensor(dual));
        let determinant = xx * yy - xy * xy;
        assert_relative_eq!(dual_xx * determinant, xx, max_relative = 1e-13);
        assert_relative_eq!(dual_yy * determinant, yy, max_relative = 1e-13);
        assert!((dual_xy * determinant - xy).abs() < 1e-13 * xx);
    }

    /// A strip of one to four cells across the flow, whose columns are alike: the faces are in series. As one axis is closed
    /// to a ring of few cells, cutting it open must not join all cells of the other one.
    #[test]
    fn long_strips_are_cut_across_and_have_their_faces_in_series() {
        let n = 20_000;
        let gap = |i: usize| 1e-6 * (1.2 + (0.7 * i as f64).sin());
        let settings = Settings::default();
        let resistance: f64 = (0..n).map(|i| settings.faces.mean(gap(i), gap((i + 1) % n)).recip()).sum();
        for width in [1, 2, 4] {
            for axis in [0, 1] {
                let shape = if axis == 0 { [n, width] } else { [width, n] };
                let field = Field::from_shape_fn(shape, |(i, j)| gap([i, j][axis]));
                let flow = solve(&field, &Grid::new(shape, [1e-6; 2]).unwrap(), &settings).unwrap();
                let found = flow.along[axis].as_ref().unwrap().permeability;
                assert_relative_eq!(found, n as f64 / resistance, max_relative = 1e-9);
            }
        }
    }
}
