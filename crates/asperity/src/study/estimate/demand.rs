//! Memory and time of a run, told from the numbers of cells alone: before a surface is made.

use web_time::Instant;

use crate::error::{Error, Result};
use crate::grid::Grid;
use crate::material::Compliances;
use crate::motion::{PlasticUpdate, Point, memory_together};
use crate::operator::{FreeFft, Operator};
use crate::solver::{Control, Coupling, Friction, Method, Sliding};
use crate::study::case::{Body, Case, ControlKind, CounterBody, Layer, LoadingPath, MotionSpec, Source};
use crate::study::given::Given;
use crate::study::prepare::grids;
use crate::study::subsurface::Plan;
use crate::units::Second;

/// What a run takes. Memory in bytes.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Demand {
    /// The two surfaces, and the making of the larger one.
    pub surfaces: f64,
    /// One solver; each thread has one, of as many as there are positions.
    pub solver: f64,
    /// The positions of a pass together.
    pub together: f64,
    /// The results until they are written.
    pub results: f64,
    /// The most at any time.
    pub memory: f64,
    /// The work, in the time that an iteration takes for a cell and a binary digit of their number: about a nanosecond.
    pub effort: f64,
}

/// What `case` takes on so many `threads`. Of files only the size is looked at; nothing is made.
///
/// # Errors
/// [`Error::Case`] if a file cannot be read, or if a step of its preparation has no meaning on its grid.
pub fn demand(case: &Case, given: &Given, threads: usize) -> Result<Demand> {
    let [lower, upper] = grids(case, given)?;
    let overlaps: Vec<usize> = super::positions(case, [lower, upper]).iter().map(|p| p.columns).collect();
    let sizes = Sizes { case, lower, upper, overlaps: &overlaps };
    let surfaces = sizes.surfaces();
    let Memory { solver, together, results } = sizes.memory();
    let solvers = threads.clamp(1, overlaps.len().max(1)) as f64 * solver;
    let memory = PROGRAM
        + match case.motion {
            // What a static contact leaves is written when its solver is gone, and drawn when all is written.
            None => {
                let drawn = PICTURES + NUMBER * DRAWN * sizes.facing().iter().product::<f64>();
                surfaces.making.max(surfaces.kept + solvers.max(results)).max(drawn)
            }
            Some(_) => {
                let working = (solvers + results).max(together + solver);
                PICTURES + ANIMATION + surfaces.making.max(surfaces.kept + working)
            }
        };
    let effort = sizes.effort(threads);
    Ok(Demand { surfaces: surfaces.making.max(surfaces.kept), solver, together, results, memory, effort })
}

impl Demand {
    /// The time of the whole run without figures on this machine as it is now, which some convolutions tell in a few
    /// milliseconds: right within a factor of three where the contact is an ordinary one.
    pub fn time(&self) -> Second {
        self.effort * unit_of_effort()
    }

    /// An error if it takes more memory than there is, in bytes.
    ///
    /// # Errors
    /// [`Error::Memory`].
    pub fn fits(&self, available: f64) -> Result<()> {
        if self.memory <= available { Ok(()) } else { Err(Error::Memory { needed: self.memory, available }) }
    }
}

/// The program itself and its libraries.
const PROGRAM: f64 = 12e6;
/// Pictures as they are drawn.
const PICTURES: f64 = 60e6;
/// The pictures of the animation of a motion.
const ANIMATION: f64 = 12e6;
/// Fields of a static contact that are drawn at a time.
const DRAWN: f64 = 7.0;
/// Bytes of a number.
const NUMBER: f64 = 8.0;

struct Sizes<'a> {
    case: &'a Case,
    lower: Grid,
    upper: Grid,
    overlaps: &'a [usize],
}

struct Surfaces {
    kept: f64,
    making: f64,
}

/// What is held beside the surfaces, bytes.
struct Memory {
    /// Memory of one solver.
    solver: f64,
    /// Memory of the positions of a pass together.
    together: f64,
    /// Memory of the results until they are written.
    results: f64,
}

impl Sizes<'_> {
    /// Cells along x and y of the largest contact.
    fn facing(&self) -> [f64; 2] {
        [self.lower.shape[0].min(self.upper.shape[0]), self.lower.shape[1]].map(|n| n as f64)
    }

    fn compliances(&self) -> Option<Compliances> {
        Compliances::new(&self.case.lower.material, &self.case.upper.material).ok()
    }

    /// Cells that the making of each surface takes, and fields on them.
    fn making(&self) -> [[f64; 2]; 2] {
        let making = |body: &Body, grid: &Grid, other: &Grid| {
            let cells = grid.shape[0] as f64 * grid.shape[1] as f64;
            let layers = body.topography.plus.iter().map(|layer| match layer {
                Layer::Generate { generate, .. } => generate.cells(grid),
                Layer::Form { .. } => cells,
            });
            match &body.topography.source {
                // A spectrum, noise, heights.
                Source::Generate { generate, .. } => {
                    let cells =
                        body.topography.made_on(Some(*other)).map_or(cells, |grid| generate.cells(&grid));
                    [layers.fold(cells, f64::max), 3.0]
                }
                Source::File { .. } | Source::Given { .. } => [layers.fold(cells, f64::max), 3.0],
                Source::Form { shape, .. } => {
                    let shape = shape.unwrap_or(other.shape);
                    [layers.fold(shape[0] as f64 * shape[1] as f64, f64::max), 2.0]
                }
            }
        };
        let Self { case, lower, upper, .. } = self;
        [making(&case.lower, lower, upper), making(&case.upper, upper, lower)]
    }

    fn surfaces(&self) -> Surfaces {
        let bytes =
            [&self.lower, &self.upper].map(|grid| NUMBER * grid.shape[0] as f64 * grid.shape[1] as f64);
        let [lower, upper] = self.making().map(|[cells, fields]| NUMBER * fields * cells);
        Surfaces { kept: bytes[0] + bytes[1], making: lower.max(bytes[0] + upper) }
    }

    fn memory(&self) -> Memory {
        let case = self.case;
        let [nx, ny] = self.facing();
        // Seven numbers of the iteration for each cell. Of the padded transform half is stored, where that is enough in single
        // precision; of the real kernel a quarter, and those of the coarse grids.
        let [padded_x, padded_y] = case.contact.boundary.wraps().map(|wraps| if wraps { 1.0 } else { 2.0 });
        let padded = padded_x * nx * (padded_y * ny + 2.0);
        let stored = if matches!(case.contact.method, Method::Auto | Method::ActiveSet) { 0.5 } else { 1.0 };
        let transforms = padded * (stored / padded_x + 1.0 / 3.0);
        let dense = if case.contact.method == Method::Direct { (0.5 * nx * ny).powi(2) } else { 0.0 };
        let normal = 7.0 * nx * ny + transforms + dense;
        // Six kernels, three transforms; of the tractions, displacements and slips of two increments and of the tangential
        // iteration some thirty numbers for each cell.
        let coupled = 1.5 * padded + 3.0 * nx * (padded_y * ny + 2.0) + 34.0 * nx * ny;
        let mut solver = NUMBER * if self.is_coupled() { normal + coupled } else { normal };
        let positions = super::positions(case, [self.lower, self.upper]);
        if let Ok(Some(plan)) = Plan::new(case, [&self.lower, &self.upper], &positions) {
            solver += plan.memory();
        }
        // In a motion what the passes before have left, and what a pass leaves, are held beside the volume.
        let kept = if case.motion.is_some() { 260.0 } else { 0.0 };
        let volume = |(cells, periodic)| cells * (kept + if periodic { 350.0 } else { 500.0 });
        let volumes: f64 = self.volumes().map(volume).sum();
        let motion = case.motion(nx * ny * self.lower.cell_area());
        let yields = case.lower.hardness.yields() || case.upper.hardness.yields();
        let together = motion
            .and_then(|motion| {
                memory_together(&motion, case.contact.method, yields, self.solved(), self.lower.shape[1])
            })
            .unwrap_or(0.0);
        // The fields besides the bodies, and one as it is written.
        let statics = if case.friction.is_some() { 16.0 } else { 8.0 };
        let results = case.motion.map_or(statics * nx * ny, |_| {
            let cells = [&self.lower, &self.upper].map(|grid| grid.shape[0] as f64 * grid.shape[1] as f64);
            let kept = match case.output.pressure_every {
                0 => 0.0,
                every => self.overlaps.iter().step_by(every).sum::<usize>() as f64 * ny,
            };
            let kept = if case.friction.is_some() { 2.0 * kept } else { kept };
            2.0 * (cells[0] + cells[1]) + 2.0 * kept
        });
        Memory { solver, together, results: NUMBER * results + volumes }
    }

    /// Columns that face each other at the positions that are solved.
    fn solved(&self) -> &[usize] {
        let couples = self.compliances().is_some_and(|compliances| compliances.coupling != 0.0);
        let yields = self.case.lower.hardness.yields() || self.case.upper.hardness.yields();
        let all = self.overlaps.len();
        &self.overlaps[..self.case.motion(1.0).map_or(all, |motion| motion.distinct(all, yields, couples))]
    }

    /// Cells of all layers of each body that flows below its surface, and whether its boundary is periodic.
    fn volumes(&self) -> impl Iterator<Item = (f64, bool)> {
        let layers = self.case.plasticity.map_or(0, |plasticity| plasticity.layers) as f64;
        let periodic = self.case.contact.boundary.repeats(0) && self.case.contact.boundary.repeats(1);
        let bodies = [(&self.case.lower, &self.lower), (&self.case.upper, &self.upper)].into_iter();
        bodies
            .filter(|(body, _)| body.plasticity.is_some())
            .map(move |(_, grid)| (grid.shape[0] as f64 * grid.shape[1] as f64 * layers, periodic))
    }

    /// The work of the products of bodies that flow below their surfaces.
    fn flow(&self, threads: usize) -> f64 {
        /// Products of an increment that flows, and those of one that is taken off.
        const PRODUCTS: [f64; 2] = [8.0, 1.0];
        /// Products of a position of a motion, and approaches tried in a pass.
        const ROLLING: [f64; 2] = [3.5, 4.0];
        let Some(plasticity) = self.case.plasticity else { return 0.0 };
        let products = match self.case.motion {
            Some(motion) => {
                let [products, trials] = ROLLING;
                let trials = if motion.control == ControlKind::PassLoad { trials } else { 1.0 };
                trials * products * (motion.passes * self.overlaps.len()) as f64
            }
            None => {
                let later: usize = self.case.history.iter().map(|stage| stage.increments).sum();
                let [flowing, unloading] = PRODUCTS;
                let unloading = if plasticity.unload == Some(true) { unloading } else { 0.0 };
                let friction = self.case.friction.as_ref().map_or(1, |friction| friction.increments);
                let first = plasticity.increments.unwrap_or(friction) as f64;
                flowing * (first + later as f64) + unloading * first
            }
        };
        let product = |(cells, periodic)| cells * if periodic { 250.0 } else { 1000.0 };
        products * self.volumes().map(product).sum::<f64>() / (threads.clamp(1, 2) as f64).powf(0.85)
    }

    /// Whether tractions along all directions are computed.
    fn is_coupled(&self) -> bool {
        let sliding = |friction: Friction| Sliding { friction, direction: [1.0, 0.0] };
        let shear_displaces_normally = |friction| {
            self.compliances().is_some_and(|compliances| {
                sliding(friction).shear_displaces_normally(compliances.coupling != 0.0)
            })
        };
        self.case.friction.as_ref().is_some_and(|friction| {
            (self.case.motion.is_none() && self.case.sliding.is_none())
                || shear_displaces_normally(friction.law)
        })
    }

    /// The work, in units of a cell times the binary logarithm of the cells of its contact.
    /// How many of so many passes are computed, about: as many as stability and the deepest wear of a jump want.
    fn computed_passes(&self, passes: usize) -> f64 {
        /// Depth that the cell which wears the most loses, over the mean.
        const DEEPEST: f64 = 8.0;
        let (case, passes) = (self.case, passes as f64);
        let (Some(acceleration), Some(compliances)) = (case.acceleration, self.compliances()) else {
            return passes;
        };
        let [nx, ny] = self.facing();
        let area = nx * ny * self.lower.cell_area();
        let Some(motion) = case.motion(area) else { return passes };
        let friction = case.friction.as_ref().map_or(0.0, |friction| friction.law.coefficient);
        let worn: f64 =
            [&case.lower, &case.upper].into_iter().map(|body| body.wear_per_pressure(friction)).sum();
        let slid = self.overlaps.len() as f64 * motion.sliding_distance(self.lower.pitch[0]);
        let mean = match motion.control {
            Control::Load(load) => load / area,
            Control::Approach(_) => 0.0,
        };
        let stable =
            0.45 * self.lower.pitch[0].min(self.lower.pitch[1]) / (compliances.modulus() * worn * slid);
        let shallow = acceleration.max_wear / (DEEPEST * worn * mean * slid);
        let jump = stable.min(shallow).min(acceleration.max_jump as f64).min(passes).max(1.0);
        passes.min(passes / jump + jump.log2())
    }

    fn effort(&self, threads: usize) -> f64 {
        let case = self.case;
        let ny = self.lower.shape[1] as f64;
        let work = |columns: f64| columns * ny * (columns * ny).max(2.0).log2();
        let boundary: f64 =
            case.contact.boundary.wraps().map(|wraps| if wraps { 0.3 } else { 0.5 }).iter().sum();
        let method = match case.contact.method {
            Method::PolonskyKeer => 10.0,
            _ => 1.0,
        };
        let digits = (-case.contact.tolerance.log10() / 6.0).max(0.3);
        let normal = SOLVE * boundary * method * digits;
        let all: f64 = self.solved().iter().map(|columns| work(*columns as f64)).sum();
        let mut effort = match (case.motion, &case.friction) {
            (Some(motion), _) => {
                let searches = match (motion.control, motion.plastic_update) {
                    (ControlKind::PassLoad, PlasticUpdate::Step) => 5.0,
                    (ControlKind::PassLoad, PlasticUpdate::Pass) => 1.3,
                    _ => 1.0,
                };
                let sliding = if self.is_coupled() { 8.0 } else { 1.0 };
                let at_once = threads.clamp(1, self.solved().len().max(1)) as f64;
                self.computed_passes(motion.passes) * searches * sliding * normal * all / at_once.powf(0.85)
            }
            (None, _) if case.sliding.is_some() => {
                let updates = case.sliding.map_or(0, |sliding| sliding.updates) as f64;
                (2.0 + updates) * normal * all
            }
            (None, friction) => {
                let [nx, ny] = self.facing();
                match case.loading_path(nx * ny * self.lower.cell_area()) {
                    Some(LoadingPath::Rolling(_)) => ROLLING * boundary * digits * all,
                    Some(LoadingPath::Stages(stages)) => {
                        let increments: usize = stages.iter().map(|stage| stage.increments).sum();
                        let unlike =
                            self.compliances().is_some_and(|compliances| compliances.dundurs().abs() > 1e-3);
                        let shear = friction.as_ref().map_or(0.0, |friction| match friction.law.coupling {
                            Coupling::Full | Coupling::Goodman if unlike => SHEAR,
                            _ => SHEAR_ALIKE,
                        });
                        increments as f64 * (normal + shear * boundary * digits) * all
                    }
                    Some(LoadingPath::Sweep(points)) => {
                        let point = |point: &Point| match point.rolling {
                            Some(_) => ROLLING * boundary * digits,
                            None => normal,
                        };
                        let stiffness = STIFFNESS * boundary * digits * points.len() as f64;
                        (points.iter().map(point).sum::<f64>() + stiffness) * all
                    }
                    None => normal * all,
                }
            }
        };
        if let Some(spec) = &case.subsurface {
            let [nx, _] = self.facing();
            let tractions = if case.friction.is_some() { 2.0 } else { 1.0 };
            let passes = self.computed_passes(case.motion.map_or(1, |motion| motion.passes));
            effort += passes * STRESS * tractions * (spec.layers + spec.planes.len()) as f64 * work(nx);
        }
        // A fresh counter-body is made for each pass.
        let times = match case.motion {
            Some(MotionSpec { counter: CounterBody::Fresh, passes, .. }) => [1.0, passes as f64],
            _ => [1.0; 2],
        };
        let made = self.making().into_iter().zip(times);
        effort
            + self.flow(threads)
            + MAKING * made.map(|([cells, _], times)| times * cells * cells.max(2.0).log2()).sum::<f64>()
    }
}

// Each measured (docs/performance.md), in the unit of effort: some 17 to 25 convolutions, each with what the iteration
// does besides.
/// A normal contact, free, to 10⁻⁶.
const SOLVE: f64 = 28.0;
/// An increment with friction, of dissimilar bodies.
const SHEAR: f64 = 450.0;
/// The work of an increment with friction of identical bodies, whose pressure is known without the shear.
const SHEAR_ALIKE: f64 = 150.0;
/// Steady rolling.
const ROLLING: f64 = 25_000.0;
/// The stiffness of a contact.
const STIFFNESS: f64 = 12.0;
/// The stress on a plane.
const STRESS: f64 = 35.0;
/// A surface: read or made, prepared, its figures for the estimate.
const MAKING: f64 = 6.0;

/// Seconds for a cell and a bit of the logarithm: the least of some convolutions, on this machine as it is now.
fn unit_of_effort() -> Second {
    /// Cells along each axis of the convolutions that are timed.
    const SIDE: usize = 128;
    /// What a solve takes of the time of a double convolution, for each of its own.
    const SHARE: f64 = 1.4;
    let grid = Grid { shape: [SIDE, SIDE], pitch: [1.0; 2] };
    let mut operator = FreeFft::new(grid, 1.0);
    let (pressure, mut displacement) = (grid.zeros(), grid.zeros());
    let time = || {
        let began = Instant::now();
        operator.apply(&pressure, &mut displacement);
        began.elapsed().as_secs_f64()
    };
    let least = std::iter::repeat_with(time).take(8).fold(f64::INFINITY, f64::min);
    let cells = (SIDE * SIDE) as f64;
    SHARE * least / (cells * cells.log2())
}
