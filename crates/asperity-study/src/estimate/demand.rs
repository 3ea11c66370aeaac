//! Memory and time of a run, estimated from the numbers of cells alone, before a surface is made.

use web_time::Instant;

use crate::case::{Body, Case, ControlKind, CounterBody, Course, Layer, MotionSpec, Source};
use crate::given::SurfaceInput;
use crate::prepare::grids;
use crate::subsurface::Plan;
use asperity_base::error::{Error, Result};
use asperity_base::grid::Grid;
use asperity_base::units::Second;
use asperity_contact::material::Compliances;
use asperity_contact::motion::{LoadControl, PlasticUpdate, Stage, memory_together};
use asperity_contact::operator::{FreeFft, Operator};
use asperity_contact::solver::{self, Control, Coupling, InterfaceCost, Method};
use asperity_contact::with::{BodyProperty, Capability, Listed};
use asperity_contact::{each_capability, each_property};

/// Cost of a run. Memory in bytes.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Demand {
    /// Memory of the two surfaces, and of making the larger one.
    pub surfaces: f64,
    /// Memory of one solver. Each thread has one, up to the number of positions.
    pub solver: f64,
    /// Memory to solve the positions of a pass together.
    pub together: f64,
    /// Memory of the results until they are written.
    pub results: f64,
    /// Largest memory at any time.
    pub memory: f64,
    /// Number of computed passes, without extrapolated ones; 1 for a static contact.
    pub passes: f64,
    /// Whether bodies may need more passes than estimated: those whose pits end an extrapolation.
    pub is_least: bool,
    /// Convolutions of all contacts together, with those on coarser grids weighted by their number of cells;
    /// 0 for elasto-plastic bodies.
    pub convolutions: f64,
    /// Work of solving and writing, in units of the time per cell and log₂ N of one iteration: about a
    /// nanosecond.
    pub effort: f64,
    /// Work of the figures and the page, in the same unit.
    pub drawing: f64,
}

/// Estimates the cost of `case` on `threads` threads. Only the sizes of files are read.
///
/// # Errors
/// [`Error::Case`] if a file cannot be read, or if a step of its preparation is invalid on its grid.
pub fn demand(case: &Case, given: &SurfaceInput, threads: usize) -> Result<Demand> {
    let [lower, upper] = grids(case, given)?;
    let overlaps: Vec<usize> = super::positions(case, [lower, upper]).iter().map(|p| p.columns).collect();
    let sizes = Sizes { case, lower, upper, overlaps: &overlaps };
    let surfaces = sizes.surfaces();
    let Memory { solver, together, results, volumes } = sizes.memory(threads);
    let solvers = threads.clamp(1, overlaps.len().max(1)) as f64 * solver;
    let memory = PROGRAM
        + match case.motion {
            // Results of a static contact are written after its solver is freed, and drawn after all are
            // written.
            None => {
                let drawn = PICTURES + NUMBER * DRAWN * sizes.facing().iter().product::<f64>();
                surfaces.making.max(surfaces.kept + solvers.max(results)).max(drawn)
            }
            Some(_) => {
                let working = (solvers + results - volumes).max(together + solver);
                let drawing = PICTURES + ANIMATION + surfaces.making.max(surfaces.kept + working);
                // The volumes of elasto-plastic bodies are large, and are freed before drawing.
                drawing.max(surfaces.kept + working + volumes)
            }
        };
    let (convolutions, solving) = sizes.solving(threads);
    let effort = solving + sizes.writing();
    let drawing = sizes.drawing(threads);
    let surfaces = surfaces.making.max(surfaces.kept);
    let passes = case.motion.map_or(1.0, |motion| sizes.computed_passes(motion.passes));
    let mut breaks_out = false;
    for body in [&case.lower, &case.upper] {
        each_property!(P => breaks_out |= P::of(&body.properties).is_some_and(P::breaks_out));
    }
    let is_least = breaks_out && case.acceleration.is_some();
    Ok(Demand {
        surfaces,
        solver,
        together,
        results,
        memory,
        passes,
        is_least,
        convolutions,
        effort,
        drawing,
    })
}

/// Returns an upper bound of the memory, bytes, that the contacts of `case` take on a device at a time, on
/// `threads` threads. Only the sizes of files are read.
///
/// # Errors
/// The errors of [`demand`].
pub fn memory_on_device(case: &Case, given: &SurfaceInput, threads: usize) -> Result<f64> {
    let [lower, upper] = grids(case, given)?;
    let overlaps: Vec<usize> = super::positions(case, [lower, upper]).iter().map(|p| p.columns).collect();
    let sizes = Sizes { case, lower, upper, overlaps: &overlaps };
    let [nx, ny] = sizes.facing().map(|n| n as usize);
    let yields = case.yields();
    let shapes: Vec<[usize; 2]> = match case.motion(1.0) {
        Some(motion) if motion.is_one_batch(yields) => {
            sizes.solved().iter().map(|columns| [*columns, ny]).collect()
        }
        // Each thread has a position.
        Some(_) => vec![[nx, ny]; threads.clamp(1, overlaps.len().max(1))],
        None => vec![[nx, ny]],
    };
    Ok(solver::memory_on_device(&shapes, case.contact.boundary, case.is_coated(), yields))
}

impl Demand {
    /// Estimates the time of solving and writing, and that of figures and page, on this machine in its
    /// present state.
    ///
    /// The time of a few convolutions is measured, in a few milliseconds. The sum is accurate within a factor
    /// of 1.5 for the examples, and of three for ordinary contacts.
    pub fn times(&self) -> [Second; 2] {
        let unit = unit_of_effort();
        [self.effort * unit, self.drawing * unit]
    }

    /// Returns an error if the needed memory exceeds the `available` memory, in bytes.
    ///
    /// # Errors
    /// [`Error::Memory`].
    pub fn fits(&self, available: f64) -> Result<()> {
        if self.memory <= available { Ok(()) } else { Err(Error::Memory { needed: self.memory, available }) }
    }
}

/// Memory of the program and its libraries.
const PROGRAM: f64 = 12e6;
/// Memory of pictures while they are drawn.
const PICTURES: f64 = 60e6;
/// Memory of the pictures of the animation of a motion.
const ANIMATION: f64 = 12e6;
/// Number of fields of a static contact that are drawn at a time.
const DRAWN: f64 = 6.0;
/// Numbers of each cell for steady sliding: the directions of a step of Newton's iteration on half of the
/// cells, and the fields.
const DIRECTIONS: f64 = 40.0;
/// Terms of a fit to a master curve, and the fields of a term in a motion.
const FITTED: usize = 24;
const REMEMBERED: f64 = 4.0;
/// Numbers of each cell for an iteration, with the gap; some are in single precision.
const ITERATION: f64 = 5.7;
/// Numbers of each cell for the near copy of the operator on a free grid.
const NEAR_COPY: f64 = 1.3;
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

/// Memory besides the surfaces, bytes.
struct Memory {
    /// Memory of one solver.
    solver: f64,
    /// Memory of the positions of a pass together.
    together: f64,
    /// Memory of the results until they are written.
    results: f64,
    /// Part of it for the volumes of elasto-plastic bodies.
    volumes: f64,
}

impl Sizes<'_> {
    /// Number of cells along x and y of the largest contact.
    fn facing(&self) -> [f64; 2] {
        [self.lower.shape[0].min(self.upper.shape[0]), self.lower.shape[1]].map(|n| n as f64)
    }

    fn compliances(&self) -> Option<Compliances> {
        Compliances::new(&self.case.lower.material, &self.case.upper.material).ok()
    }

    /// Number of cells used to make each surface, and of fields on them.
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

    fn memory(&self, threads: usize) -> Memory {
        let case = self.case;
        let [nx, ny] = self.facing();
        // Numbers of the iteration for each cell. Half of the padded transform is stored, if single precision
        // is enough. Of the real kernel a quarter is stored, and the kernels of the coarse grids.
        let [padded_x, padded_y] = case.contact.boundary.wraps().map(|wraps| if wraps { 1.0 } else { 2.0 });
        let padded = padded_x * nx * (padded_y * ny + 2.0);
        let stored = if matches!(case.contact.method, Method::Auto | Method::ActiveSet) { 0.5 } else { 1.0 };
        let transforms = padded * (stored / padded_x + 1.0 / 3.0);
        let dense = if case.contact.method == Method::Direct { (0.5 * nx * ny).powi(2) } else { 0.0 };
        let iteration = if padded_x * padded_y > 1.0 { ITERATION + NEAR_COPY } else { ITERATION };
        let normal = iteration * nx * ny + transforms + dense;
        // Six kernels, three transforms, and about thirty numbers for each cell: tractions, displacements and
        // slips of two increments, and the tangential iteration.
        let coupled = 1.5 * padded + 3.0 * nx * (padded_y * ny + 2.0) + 34.0 * nx * ny;
        let mut solver = NUMBER * if self.is_coupled() { normal + coupled } else { normal };
        if let Some(cost) = case.interface.cost() {
            solver += NUMBER * cost.memory * nx * ny;
        }
        if case.steady.is_some() {
            solver += NUMBER * (DIRECTIONS * nx * ny + 6.0 * padded);
        }
        let positions = super::positions(case, [self.lower, self.upper]);
        if let Ok(Some(plan)) = Plan::new(case, [&self.lower, &self.upper], &positions) {
            solver += plan.memory();
        }
        // A motion also stores the results of the passes before, and of the current pass.
        let kept = if case.motion.is_some() { 260.0 } else { 0.0 };
        let volume = |(cells, periodic)| cells * (kept + if periodic { 350.0 } else { 500.0 });
        let volumes: f64 = self.volumes().map(volume).sum();
        let motion = case.motion(nx * ny * self.lower.cell_area());
        let together = motion
            .filter(|_| !case.relaxes())
            .and_then(|motion| {
                memory_together(
                    &motion,
                    case.contact.method,
                    case.yields(),
                    self.solved(),
                    self.lower.shape[1],
                )
            })
            .unwrap_or(0.0);
        // The fields besides the bodies, and one while it is written.
        let statics = if case.friction.is_some() { 16.0 } else { 6.0 };
        let results = case.motion.map_or(statics * nx * ny, |_| {
            let cells = [&self.lower, &self.upper].map(|grid| grid.shape[0] as f64 * grid.shape[1] as f64);
            let kept = match case.output.pressure_every {
                0 => 0.0,
                every => self.overlaps.iter().step_by(every).sum::<usize>() as f64 * ny,
            };
            let kept = if case.friction.is_some() { 2.0 * kept } else { kept };
            2.0 * (cells[0] + cells[1]) + 2.0 * kept
        });
        let results = NUMBER * (results + self.remembered()) + volumes + self.memory_of_capabilities(threads);
        Memory { solver, together, results, volumes }
    }

    /// Numbers that viscoelastic bodies remember in a motion: before a pass, in it and after it.
    fn remembered(&self) -> f64 {
        let of = |(body, grid): (&Body, &Grid)| {
            let given = body.relaxation_terms()?;
            let terms = if given > 0 { given } else { FITTED };
            Some(REMEMBERED * (terms + 1) as f64 * grid.cells() as f64)
        };
        let bodies = [(&self.case.lower, &self.lower), (&self.case.upper, &self.upper)];
        if self.case.motion.is_some() { bodies.into_iter().filter_map(of).sum() } else { 0.0 }
    }

    /// Number of overlap columns at the solved positions.
    fn solved(&self) -> &[usize] {
        let couples = self.compliances().is_some_and(|compliances| compliances.coupling != 0.0);
        let (yields, all) = (self.case.yields(), self.overlaps.len());
        let follows = self.case.interface.follows_path();
        let motion = self.case.motion(1.0).filter(|_| !self.case.relaxes());
        &self.overlaps[..motion.map_or(all, |motion| motion.distinct(all, yields, couples, follows))]
    }

    /// Number of cells in all layers of each elasto-plastic body, and whether its boundary is periodic.
    fn volumes(&self) -> impl Iterator<Item = (f64, bool)> {
        let layers = self.case.plasticity.map_or(0, |plasticity| plasticity.layers) as f64;
        let periodic = self.case.contact.boundary.repeats(0) && self.case.contact.boundary.repeats(1);
        let bodies = [(&self.case.lower, &self.lower), (&self.case.upper, &self.upper)].into_iter();
        bodies
            .filter(|(body, _)| body.plasticity.is_some())
            .map(move |(_, grid)| (grid.shape[0] as f64 * grid.shape[1] as f64 * layers, periodic))
    }

    /// Work of the operator applications of elasto-plastic bodies.
    fn flow(&self, threads: usize) -> f64 {
        /// Operator applications of a plastic increment, and of an unloading increment.
        const PRODUCTS: [f64; 2] = [8.0, 1.0];
        /// Operator applications per position of a motion, and number of approaches tried in a pass.
        const ROLLING: [f64; 2] = [3.5, 4.0];
        let Some(plasticity) = self.case.plasticity else { return 0.0 };
        let products = match self.case.motion {
            Some(motion) => {
                let [products, trials] = ROLLING;
                let trials = if motion.control() == ControlKind::PassLoad { trials } else { 1.0 };
                trials * products * (motion.passes * self.overlaps.len()) as f64
            }
            None => {
                let course = self.case.course(1.0);
                let [flowing, unloading] = PRODUCTS;
                let unloading = if plasticity.unload == Some(true) { unloading } else { 0.0 };
                let friction = self.case.friction.as_ref().map_or(1, |friction| friction.increments);
                let first = plasticity.increments.unwrap_or(friction) as f64;
                let steps = match course.stages() {
                    [] => self.case.contact.sweep().len() as f64 * first,
                    stages => Stage::increments(stages) as f64,
                };
                flowing * steps + unloading * first
            }
        };
        let product = |(cells, periodic)| cells * if periodic { 250.0 } else { 1000.0 };
        products * self.volumes().map(product).sum::<f64>() / (threads.clamp(1, 2) as f64).powf(0.85)
    }

    /// Whether tangential tractions are computed.
    fn is_coupled(&self) -> bool {
        let slides = matches!(self.case.course(1.0), Course::Passes(_) | Course::InPlace(_));
        self.case.friction.is_some() && (!slides || self.case.shear_displaces_normally())
    }

    /// Estimates the number of computed passes from the stability limit and the largest depth of an
    /// extrapolation.
    fn computed_passes(&self, passes: usize) -> f64 {
        /// Depth lost by the most worn cell over the mean.
        const DEEPEST: f64 = 8.0;
        let (case, passes) = (self.case, passes as f64);
        let (Some(acceleration), Some(compliances)) = (case.acceleration, self.compliances()) else {
            return passes;
        };
        let [nx, ny] = self.facing();
        let area = nx * ny * self.lower.cell_area();
        let Some(motion) = case.motion(area) else { return passes };
        let friction = case.friction.as_ref().map_or(0.0, |friction| friction.law.coefficient);
        let worn = case.loss_per_pressure(friction);
        let cells = self.overlaps.len() as f64 * motion.cells_of_position(self.lower.shape[0]);
        let slid = motion.sliding_distance_of(cells, self.lower.pitch[0]);
        let mean = match motion.control {
            Control::Load(load) => load / area,
            Control::Approach(_) => 0.0,
        };
        let stable =
            0.45 * self.lower.pitch[0].min(self.lower.pitch[1]) / (compliances.modulus() * worn * slid);
        let shallow = acceleration.max_depth() / (DEEPEST * worn * mean * slid);
        let jump = stable.min(shallow).min(acceleration.max_jump as f64).min(passes).max(1.0);
        passes.min(passes / jump + jump.log2())
    }

    /// Returns the convolutions of all contacts, and the work of solving them with everything computed
    /// besides, in units of a cell times the binary logarithm of the cells of its contact.
    fn solving(&self, threads: usize) -> (f64, f64) {
        let case = self.case;
        let [nx, ny] = self.facing();
        let work = |columns: f64| columns * ny * (columns * ny).max(2.0).log2();
        let boundary: f64 =
            case.contact.boundary.wraps().map(|wraps| if wraps { 0.3 } else { 0.5 }).iter().sum();
        let digits = (0.3 - 0.7 * case.contact.tolerance.log10() / 6.0).max(0.4);
        // A larger grid takes slightly more.
        let size = (nx * ny / LARGE).max(1.0).powf(GROWTH);
        let together = |works: usize| (threads.clamp(1, works.max(1)) as f64).powf(EFFICIENCY);
        let method = match case.contact.method {
            Method::PolonskyKeer => 10.0,
            _ => 1.0,
        };
        let all: f64 = self.solved().iter().map(|columns| work(*columns as f64)).sum();
        // Convolutions of each contact, and their work including the iteration around them.
        let of = |cost: Cost, contacts: f64| {
            let convolutions = contacts * cost.convolutions * digits;
            [convolutions, boundary * cost.work * convolutions * all]
        };
        let of_interface = |InterfaceCost { convolutions, work, .. }| Cost { convolutions, work };
        let normal = case.interface.cost().map_or(NORMAL, of_interface);
        let normal = Cost { convolutions: method * size * normal.convolutions, ..normal };
        let unlike = self.compliances().is_some_and(|compliances| compliances.dundurs().abs() > 1e-3);
        let rolling = if unlike { ROLLING_UNLIKE } else { ROLLING };
        let course = case.course(nx * ny * self.lower.cell_area());
        let [convolutions, mut effort] = match &course {
            Course::Passes(motion) => {
                let changes = motion.plastic_update == PlasticUpdate::Step || case.relaxes();
                let is_searched =
                    matches!(motion.control, Control::Load(_)) && motion.load_control == LoadControl::Pass;
                let searches = if is_searched && changes { 5.0 } else { 1.0 };
                let positions = self.solved().len();
                let passes = self.computed_passes(motion.passes);
                let mut cost = if self.is_coupled() { SLIDING } else { normal };
                // Later passes start from the pressures of the pass before.
                cost.convolutions *= WARM + (1.0 - WARM) / passes.max(1.0);
                let [convolutions, effort] = of(cost, passes * searches);
                let effort = effort + POSITION * passes * positions as f64;
                let beside = passes * self.running(motion.passes);
                // Viscoelastic bodies remember one position after the other.
                let together = if case.relaxes() { 1.0 } else { together(positions) };
                [convolutions * positions as f64, effort / together + beside]
            }
            Course::InPlace(slide) => {
                of(if self.is_coupled() { SLIDING } else { normal }, 2.0 + slide.ends.len() as f64)
            }
            Course::Rolling(_) => of(rolling, 1.0),
            Course::Stages(stages) => {
                let shear = match case.friction.as_ref().map(|friction| friction.law.coupling) {
                    Some(Coupling::Full | Coupling::Goodman) if unlike => SHEAR_UNLIKE,
                    Some(_) => SHEAR,
                    None => normal,
                };
                of(shear, self.increments(stages))
            }
            Course::Sweep(points) if case.steady.is_some() => {
                let larger = (nx * ny / LARGE).powf(STEADY_GROWTH);
                of(Cost { convolutions: larger * STEADY.convolutions, ..STEADY }, points.len() as f64)
            }
            Course::Sweep(points) => {
                let rolls = points.iter().filter(|point| point.regime.rolling().is_some()).count() as f64;
                let [a, b] = [of(rolling, rolls), of(normal, points.len() as f64 - rolls)];
                // Only the stiffness of hard walls is computed.
                let each = if case.interface.is_empty() { STIFFNESS } else { 0.0 };
                let stiffness = each * boundary * digits * points.len() as f64 * all;
                [a[0] + b[0], a[1] + b[1] + stiffness]
            }
        };
        if let Some(spec) = &case.subsurface {
            let passes = self.computed_passes(case.motion.map_or(1, |motion| motion.passes));
            let planes = spec.layers + spec.planes.len();
            effort += passes * STRESS * planes as f64 * work(nx) / together(planes);
        }
        effort += self.of_capabilities(boundary, digits, &together);
        // A new counterbody is made for each pass.
        let times = match case.motion {
            Some(MotionSpec { counter: CounterBody::Fresh, passes, .. }) => [1.0, passes as f64],
            _ => [1.0; 2],
        };
        let made = self.making().into_iter().zip(times);
        let making =
            MAKING * made.map(|([cells, _], times)| times * cells * cells.max(2.0).log2()).sum::<f64>();
        (convolutions, effort + self.flow(threads) + making)
    }

    /// Number of contacts that are solved: increments, updates, points, or positions of all computed passes.
    fn contacts(&self) -> f64 {
        match self.case.course(1.0) {
            Course::Passes(motion) => self.computed_passes(motion.passes) * self.overlaps.len() as f64,
            Course::InPlace(slide) => 1.0 + slide.ends.len() as f64,
            Course::Stages(stages) => self.increments(&stages),
            Course::Sweep(points) => points.len() as f64,
            Course::Rolling(_) => 1.0,
        }
    }

    /// Number of increments of the stages of a loading that are computed.
    fn increments(&self, stages: &[Stage]) -> f64 {
        /// Computed cycles for each doubling of their number, where computed ones stand for several.
        const COMPUTED: f64 = 12.0;
        let jumps = self.case.acceleration.is_some_and(|acceleration| acceleration.max_jump > 1);
        let of_stage = |stage: &Stage| {
            let all = Stage::increments(std::slice::from_ref(stage)) as f64;
            let cycles = stage.cycles.map_or(1.0, |cycles| cycles.count as f64);
            let computed = if jumps { cycles.min(COMPUTED * cycles.log2().max(1.0)) } else { cycles };
            all * computed / cycles
        };
        stages.iter().map(of_stage).sum()
    }

    /// Number of contacts that an observer with this interval looks at.
    fn observed(&self, every: usize) -> f64 {
        let passes = self.case.motion.map_or(1.0, |motion| self.computed_passes(motion.passes));
        if every == 0 { passes } else { (self.contacts() / every as f64).max(passes) }
    }

    /// Work of the capabilities.
    fn of_capabilities(&self, boundary: f64, digits: f64, together: &dyn Fn(usize) -> f64) -> f64 {
        let [nx, ny] = self.facing();
        let work = nx * ny * (nx * ny).max(2.0).log2();
        let mut effort = 0.0;
        each_capability!(C => if let Some(asked) = C::of(&self.case.with) {
            let every = asked.every();
            let at_once = self.observed_together(every, C::OF_LOAD_CYCLES);
            effort += asked.effort(boundary, digits) * self.observed(every) / together(at_once);
        });
        effort * work
    }

    /// Number of contacts that an observer with this interval looks at together: those of a step, or of a
    /// whole cycle.
    fn observed_together(&self, every: usize, whole: bool) -> usize {
        match (self.case.motion, every) {
            (None, every) if whole => {
                let steps = self.case.history.iter().filter(|stage| stage.cycles.is_some());
                steps.map(|stage| 2 * stage.steps() + 1).max().unwrap_or(1).div_ceil(every)
            }
            (None, _) | (Some(_), 0) => 1,
            (Some(_), every) => self.overlaps.len().div_ceil(every),
        }
    }

    /// Memory of the capabilities, bytes: their solvers, one for each thread, and the gaps of a pass.
    fn memory_of_capabilities(&self, threads: usize) -> f64 {
        let [nx, ny] = self.facing();
        let (mut looked_at, mut largest) = (0, 0.0_f64);
        each_capability!(C => if let Some(asked) = C::of(&self.case.with) {
            let positions = self.observed_together(asked.every(), C::OF_LOAD_CYCLES);
            let at_once = threads.clamp(1, positions.max(1)).min(positions) as f64;
            looked_at = looked_at.max(positions);
            largest = largest.max(at_once * C::memory([nx as usize, ny as usize]));
        });
        let states = 2.0 * self.case.remembered() as f64 * self.cells();
        NUMBER * (looked_at as f64 * nx * ny + states) + largest
    }

    /// Work of the laws of the bodies and of flash temperatures in a computed pass.
    fn running(&self, passes: usize) -> f64 {
        let effort = self.case.lower.effort_of_laws() + self.case.upper.effort_of_laws();
        let heated = match self.case.temperature.map(|temperature| temperature.every()) {
            Some(every) if every > 0 => 1.0 / every.min(passes.max(1)) as f64,
            _ => 0.0,
        };
        let cells = self.solved().iter().sum::<usize>() as f64 * self.facing()[1];
        cells * (effort + HEAT * heated)
    }

    /// Number of cells of both bodies together.
    fn cells(&self) -> f64 {
        [&self.lower, &self.upper].map(|grid| grid.shape[0] as f64 * grid.shape[1] as f64).iter().sum()
    }

    /// Number of positions of a pass whose pressures are stored, and of their cells.
    fn kept(&self) -> [f64; 2] {
        match self.case.output.pressure_every {
            0 => [0.0; 2],
            every => {
                let kept = self.overlaps.iter().step_by(every);
                [kept.len() as f64, kept.sum::<usize>() as f64 * self.lower.shape[1] as f64]
            }
        }
    }

    /// Work of writing fields.
    fn writing(&self) -> f64 {
        let case = self.case;
        let bodies = [&case.lower, &case.upper];
        let of_body = |body: &&Body| (2 + body.kept_by_laws() + case.remembered()) as f64;
        let [fields, cells] = match case.motion {
            Some(motion) => {
                let shear = if case.friction.is_some() { 2.0 } else { 1.0 };
                let kept = self.kept().map(|kept| shear * kept);
                let heat = if case.temperature.is_some() { 2.0 } else { 0.0 };
                let of_bodies = bodies.iter().map(of_body).sum::<f64>() + heat;
                let pass = [kept[0] + of_bodies, kept[1] + 0.5 * of_bodies * self.cells()];
                pass.map(|of_pass| self.computed_passes(motion.passes) * of_pass)
            }
            None => {
                let fields = if case.friction.is_some() { 12.0 } else { 6.0 };
                [fields, fields * self.facing().iter().product::<f64>()]
            }
        };
        FIELD * fields + WRITTEN * cells
    }

    /// Work of figures and page.
    fn drawing(&self, threads: usize) -> f64 {
        let case = self.case;
        let maps = case.maps_of_laws() as f64;
        let given = |there: bool| f64::from(there);
        let mut figures = match case.motion {
            Some(_) => 19.0 + given(case.friction.is_some()) + given(case.temperature.is_some()),
            None => 9.0 + if case.friction.is_some() { 4.0 } else { 0.0 },
        };
        figures += maps + 2.0 * maps.min(1.0) + given(case.subsurface.is_some());
        figures += 2.0 * given(case.plasticity.is_some()) + given(case.course(1.0).is_sweep());
        let [frames, kept, cells] = match case.motion {
            Some(motion) => {
                let [fields, cells] = self.kept();
                let passes = self.computed_passes(motion.passes);
                [fields, passes * fields, passes * cells]
            }
            None => [0.0; 3],
        };
        let pictures = FIGURE * figures + FRAME * frames + DRAWN_CELL * self.cells();
        let page = SHOWN * kept + SHOWN_CELL * cells + 0.5 * DRAWN_CELL * self.cells();
        START + (pictures + page) / (threads.clamp(1, 4) as f64).powf(EFFICIENCY)
    }
}

/// The cost of a contact.
#[derive(Clone, Copy)]
struct Cost {
    /// Convolutions to 10⁻⁶ on a small grid.
    convolutions: f64,
    /// Work of one, including the iteration around it, with free boundary, in the unit of effort.
    work: f64,
}

// Each is measured (docs/performance.md).
/// A normal contact.
const NORMAL: Cost = Cost { convolutions: 15.8, work: 2.2 };
/// A contact in gross slip whose shear displaces the surface normally.
const SLIDING: Cost = Cost { convolutions: 36.0, work: 6.5 };
/// An increment with friction of identical bodies, whose pressure does not depend on the shear.
const SHEAR: Cost = Cost { convolutions: 24.0, work: 7.0 };
/// An increment with friction of dissimilar bodies.
const SHEAR_UNLIKE: Cost = Cost { convolutions: 68.0, work: 7.0 };
/// Steady rolling of identical bodies.
const ROLLING: Cost = Cost { convolutions: 85.0, work: 4.6 };
/// Steady rolling of dissimilar bodies.
const ROLLING_UNLIKE: Cost = Cost { convolutions: 230.0, work: 5.0 };
/// Steady sliding of a viscoelastic body, at each speed, and the exponent by which its convolutions grow with
/// the number of cells.
const STEADY: Cost = Cost { convolutions: 135.0, work: 2.5 };
const STEADY_GROWTH: f64 = 0.6;
/// Convolutions of a later pass relative to the first.
const WARM: f64 = 0.8;
/// Number of cells from which a contact takes more convolutions, and the exponent of this growth.
const LARGE: f64 = 16384.0;
const GROWTH: f64 = 0.09;
/// Work at a position besides its contact.
const POSITION: f64 = 3.7e5;
/// Work of the stiffness of a contact, in the unit of effort for each cell and log₂ N.
const STIFFNESS: f64 = 12.0;
/// Work of the stress on a plane, in the same unit.
const STRESS: f64 = 120.0;
/// Work of a surface: read or generated, prepared, with its figures for the estimate, in the same unit.
const MAKING: f64 = 6.0;
/// Work of the flash temperature of a cell at a position.
const HEAT: f64 = 90.0;
/// Work of writing a field, and of each of its cells.
const FIELD: f64 = 4e5;
const WRITTEN: f64 = 55.0;
/// Work of a figure, and of a picture of an animation.
const FIGURE: f64 = 3.4e7;
const FRAME: f64 = 1.4e7;
/// Work of a cell of a body in the figures.
const DRAWN_CELL: f64 = 150.0;
/// Work of a pressure field on the page, and of each of its cells.
const SHOWN: f64 = 4e5;
const SHOWN_CELL: f64 = 190.0;
/// Work of the start and the end of the program.
const START: f64 = 2.5e7;
/// Exponent of the number of threads in the speed-up of shared work.
const EFFICIENCY: f64 = 0.85;

/// Measures the seconds per cell and log₂ N: the smallest of several convolutions, on this machine in its
/// present state.
fn unit_of_effort() -> Second {
    /// Number of cells along each axis of the timed convolutions.
    const SIDE: usize = 128;
    /// Time of a solve relative to that of a double-precision convolution, for each of its own convolutions.
    const SHARE: f64 = 1.4;
    let grid = Grid { shape: [SIDE, SIDE], pitch: [1.0; 2] };
    let mut operator = FreeFft::new(grid, 1.0);
    let (pressure, mut displacement) = (grid.zeros(), grid.zeros());
    let time = || {
        let began = Instant::now();
        operator.apply(&pressure, &mut displacement);
        began.elapsed().as_secs_f64()
    };
    let least = std::iter::repeat_with(time).take(32).fold(f64::INFINITY, f64::min);
    let cells = (SIDE * SIDE) as f64;
    SHARE * least / (cells * cells.log2())
}
