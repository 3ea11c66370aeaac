//! Memory and time of a run, estimated from the numbers of cells alone, before a surface is made.

use web_time::Instant;

use crate::case::{Body, Case, Course, Layer, Source};
use crate::prepare::grids;
use crate::subsurface::Plan;
use crate::surface_input::SurfaceInput;
use asperity_base::error::{Error, Result};
use asperity_base::grid::Grid;
use asperity_base::units::Second;
use asperity_contact::each;
use asperity_contact::kernel::response;
use asperity_contact::material::Compliances;
use asperity_contact::motion::{LoadControl, PlasticUpdate, Stage, memory_together};
use asperity_contact::operator::{FreeFft, Operator};
use asperity_contact::solver::{self, Control, Coupling, InterfaceCost, Method};
use asperity_contact::with::{BodyProperty, Capability, Listed};

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
    /// Convolutions of all contacts together, with those on coarser grids weighted by their number of cells.
    pub convolutions: f64,
    /// Work of solving, in units of the time per cell and log₂ N of one iteration: about a nanosecond.
    pub effort: f64,
    /// Work of the figures and the page, in the same unit.
    pub drawing: f64,
}

/// Estimates the cost of `case` on `threads` threads. Only the sizes of files are read.
///
/// # Errors
/// [`Error::Case`] if a file cannot be read, or if a step of its preparation is invalid on its grid.
pub fn demand(case: &Case, given: &SurfaceInput, threads: usize) -> Result<Demand> {
    let sizes = Sizes::of(case, given)?;
    let surfaces = sizes.surfaces();
    let Memory { solver, together, results, volumes } = sizes.memory(threads);
    let solvers = threads.clamp(1, sizes.overlaps.len().max(1)) as f64 * solver;
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
    let (convolutions, effort) = sizes.solving(threads);
    let mut breaks_out = false;
    for body in [&case.lower, &case.upper] {
        each!(property P => breaks_out |= P::of(&body.properties).is_some_and(P::breaks_out));
    }
    let is_least = breaks_out && case.acceleration.is_some();
    Ok(Demand {
        surfaces: surfaces.making.max(surfaces.kept),
        solver,
        together,
        results,
        memory,
        passes: sizes.passes(),
        is_least,
        convolutions,
        effort,
        drawing: sizes.drawing(threads),
    })
}

/// Returns an upper bound of the memory, bytes, that the contacts of `case` take on a device at a time, on
/// `threads` threads. Only the sizes of files are read.
///
/// # Errors
/// The errors of [`demand`].
pub fn memory_on_device(case: &Case, given: &SurfaceInput, threads: usize) -> Result<f64> {
    let sizes = Sizes::of(case, given)?;
    let [nx, ny] = sizes.facing().map(|n| n as usize);
    let yields = case.yields();
    let shapes: Vec<[usize; 2]> = match case.motion(1.0) {
        Some(motion) if motion.is_one_batch(yields) => {
            sizes.solved().iter().map(|columns| [*columns, ny]).collect()
        }
        // Each thread has a position.
        Some(_) => vec![[nx, ny]; threads.clamp(1, sizes.overlaps.len().max(1))],
        None => vec![[nx, ny]],
    };
    Ok(solver::memory_on_device(&shapes, case.contact.boundary, case.is_coated(), yields))
}

impl Demand {
    /// Estimates the time of solving and writing, and that of figures and page, on this machine in its
    /// present state.
    ///
    /// The time of a few convolutions is measured, in a few milliseconds. For the examples the estimate is off
    /// by at most a factor of two, for ordinary contacts by at most a factor of three.
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
    /// Number of columns at each position of the first pass.
    overlaps: Vec<usize>,
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

impl<'a> Sizes<'a> {
    fn of(case: &'a Case, given: &SurfaceInput) -> Result<Self> {
        let [lower, upper] = grids(case, given)?;
        let overlaps = super::positions(case, [lower, upper]).iter().map(|p| p.columns).collect();
        Ok(Self { case, lower, upper, overlaps })
    }

    /// Number of cells along x and y of the largest contact.
    fn facing(&self) -> [f64; 2] {
        [self.lower.shape[0].min(self.upper.shape[0]), self.lower.shape[1]].map(|n| n as f64)
    }

    fn compliances(&self) -> Option<Compliances> {
        Compliances::new(&self.case.lower.material, &self.case.upper.material).ok()
    }

    fn surfaces(&self) -> Surfaces {
        let making = |body: &Body, grid: &Grid, other: &Grid| {
            let [made, fields] = match &body.topography.source {
                // A spectrum, noise, heights.
                Source::Generate { generate, .. } => {
                    let on = body.topography.made_on(Some(*other));
                    [on.map_or(cells(grid), |grid| generate.cells(&grid)), 3.0]
                }
                Source::File { .. } | Source::Given { .. } => [cells(grid), 3.0],
                Source::Form { shape, .. } => {
                    let shape = shape.unwrap_or(other.shape);
                    [shape[0] as f64 * shape[1] as f64, 2.0]
                }
            };
            let layers = body.topography.plus.iter().map(|layer| match layer {
                Layer::Generate { generate, .. } => generate.cells(grid),
                Layer::Form { .. } => cells(grid),
            });
            NUMBER * fields * layers.fold(made, f64::max)
        };
        let Self { case, lower, upper, .. } = self;
        let kept = [lower, upper].map(|grid| NUMBER * cells(grid));
        let making = [making(&case.lower, lower, upper), making(&case.upper, upper, lower)];
        Surfaces { kept: kept[0] + kept[1], making: making[0].max(kept[0] + making[1]) }
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
        if case.interface.lubrication.is_some() {
            solver += NUMBER * FILM_MEMORY * nx * ny;
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
            .filter(|_| !case.follows_itself())
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
            let [_, kept] = self.kept();
            2.0 * self.cells() + if case.friction.is_some() { 4.0 * kept } else { 2.0 * kept }
        });
        let results = NUMBER * (results + self.remembered()) + volumes + self.memory_of_capabilities(threads);
        Memory { solver, together, results, volumes }
    }

    /// Numbers that a motion keeps: viscoelastic bodies remember before a pass, in it and after it; lubricated bodies keep
    /// the tractions at each position.
    fn remembered(&self) -> f64 {
        let of = |(body, grid): (&Body, &Grid)| {
            let given = body.relaxation_terms()?;
            let terms = if given > 0 { given } else { FITTED };
            Some(REMEMBERED * (terms + 1) as f64 * grid.cells() as f64)
        };
        let bodies = [(&self.case.lower, &self.lower), (&self.case.upper, &self.upper)];
        if self.case.motion.is_none() {
            return 0.0;
        }
        let lubricated = self.case.interface.lubrication.is_some();
        let overlaps = (self.overlaps.iter().sum::<usize>() * self.lower.shape[1]) as f64;
        bodies.into_iter().filter_map(of).sum::<f64>() + if lubricated { 2.0 * overlaps } else { 0.0 }
    }

    /// Number of overlap columns at the solved positions.
    fn solved(&self) -> &[usize] {
        let response = response(&self.case.lower.material, &self.case.upper.material);
        let couples = response.is_ok_and(|pair| pair.coupled().is_some_and(|coupled| coupled.couples()));
        let (yields, all) = (self.case.yields(), self.overlaps.len());
        let follows = self.case.interface.follows_path();
        let motion = self.case.motion(1.0).filter(|_| !self.case.follows_itself());
        &self.overlaps[..motion.map_or(all, |motion| motion.distinct(all, yields, couples, follows))]
    }

    /// Number of cells in all layers of each elasto-plastic body, and whether its boundary is periodic.
    fn volumes(&self) -> impl Iterator<Item = (f64, bool)> {
        let layers = self.case.plasticity.map_or(0, |plasticity| plasticity.layers) as f64;
        let periodic = self.case.contact.boundary.repeats(0) && self.case.contact.boundary.repeats(1);
        let bodies = [(&self.case.lower, &self.lower), (&self.case.upper, &self.upper)].into_iter();
        bodies
            .filter(|(body, _)| body.plasticity.is_some())
            .map(move |(_, grid)| (cells(grid) * layers, periodic))
    }

    /// Work of the operator applications of elasto-plastic bodies.
    fn flow(&self, course: &Course) -> f64 {
        /// Operator applications of an increment of a static contact, and of a position in a motion.
        const PRODUCTS: [f64; 2] = [8.0, 3.5];
        let increments = self.case.plasticity.and_then(|plasticity| plasticity.increments).unwrap_or(1);
        let products = match course {
            Course::Passes(_) => PRODUCTS[1],
            Course::Sweep(_) => PRODUCTS[0] * increments as f64,
            _ => PRODUCTS[0],
        };
        let product = |(cells, periodic)| cells * if periodic { 250.0 } else { 1000.0 };
        self.trials(course) * self.contacts(course) * products * self.volumes().map(product).sum::<f64>()
    }

    /// Number of approaches tried in a pass of a prescribed mean load, if its bodies change on the way.
    fn trials(&self, course: &Course) -> f64 {
        let Course::Passes(motion) = course else { return 1.0 };
        let searches = matches!(motion.control, Control::Load(_)) && motion.load_control == LoadControl::Pass;
        let changes = motion.plastic_update == PlasticUpdate::Step
            || self.case.follows_itself()
            || self.case.plasticity.is_some();
        if searches && changes { 5.0 } else { 1.0 }
    }

    /// Whether tangential tractions are computed.
    fn is_coupled(&self) -> bool {
        let slides = matches!(self.case.course(1.0), Course::Passes(_) | Course::InPlace(_));
        self.case.friction.is_some() && (!slides || self.case.shear_displaces_normally())
    }

    /// Estimates the number of computed passes from the stability limit and the largest depth of an
    /// extrapolation; 1 for a static contact.
    fn passes(&self) -> f64 {
        /// Depth lost by the most worn cell over the mean.
        const DEEPEST: f64 = 8.0;
        let case = self.case;
        let passes = case.motion.map_or(1.0, |motion| motion.passes as f64);
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
    /// besides.
    fn solving(&self, threads: usize) -> (f64, f64) {
        let case = self.case;
        let [nx, ny] = self.facing();
        let work = |columns: f64| columns * ny * (columns * ny).max(2.0).log2();
        let together = |works: usize| (threads.clamp(1, works.max(1)) as f64).powf(EFFICIENCY);
        let course = case.course(nx * ny * self.lower.cell_area());
        let Cost { convolutions, work: of_convolution } = self.cost(&course);
        let digits = (0.3 - 0.7 * case.contact.tolerance.log10() / 6.0).max(0.4);
        let convolutions = digits * convolutions;
        let boundary: f64 =
            case.contact.boundary.wraps().map(|wraps| if wraps { 0.3 } else { 0.5 }).iter().sum();
        let (steps, trials) = (self.steps(&course), self.trials(&course));
        let solved = self.solved();
        let positions = solved.len() as f64;
        let all: f64 = solved.iter().map(|columns| work(*columns as f64)).sum();
        let of_step = trials * convolutions * boundary * of_convolution * all + POSITION * positions;
        // Viscoelastic bodies and films of oil remember one position after the other.
        let at_once = if case.follows_itself() { 1 } else { solved.len() };
        let mut effort = steps * of_step / together(at_once);
        let laws = case.lower.effort_of_laws() + case.upper.effort_of_laws();
        effort += steps * laws * ny * solved.iter().sum::<usize>() as f64;
        if let Some(spec) = &case.subsurface {
            let planes = spec.layers + spec.planes.len();
            effort += self.passes() * STRESS * planes as f64 * work(nx) / together(planes);
        }
        each!(capability C => if let Some(asked) = C::of(&case.with) {
            let every = asked.every();
            let at_once = self.observed_together(every, C::OF_LOAD_CYCLES);
            effort += asked.effort() * self.observed(&course, every) * work(nx) / together(at_once);
        });
        effort += self.flow(&course) / together(2);
        (steps * trials * positions * convolutions, effort)
    }

    /// Returns the cost of a contact of the `course`.
    fn cost(&self, course: &Course) -> Cost {
        let case = self.case;
        let [nx, ny] = self.facing();
        let unlike = self.compliances().is_some_and(|compliances| compliances.dundurs().abs() > 1e-3);
        let coupling = case.friction.as_ref().map(|friction| friction.law.coupling);
        match course {
            Course::Passes(_) | Course::InPlace(_) if self.is_coupled() => return SLIDING,
            Course::Stages(_) if coupling.is_some() => {
                let couples = matches!(coupling, Some(Coupling::Full | Coupling::Goodman));
                return if couples && unlike { SHEAR_UNLIKE } else { SHEAR };
            }
            Course::Rolling(_) | Course::Sweep(_) if course.rolling().next().is_some() => {
                return if unlike { ROLLING_UNLIKE } else { ROLLING };
            }
            Course::Sweep(_) | Course::Passes(_) if case.interface.lubrication.is_some() => {
                let larger = (nx * ny / LARGE).powf(FILM_GROWTH);
                return Cost { convolutions: larger * FILM.convolutions, ..FILM };
            }
            Course::Sweep(_) if case.steady.is_some() => {
                let larger = (nx * ny / LARGE).powf(STEADY_GROWTH);
                return Cost { convolutions: larger * STEADY.convolutions, ..STEADY };
            }
            _ => (),
        }
        let of_interface = |InterfaceCost { convolutions, work, .. }| Cost { convolutions, work };
        let normal = case.interface.cost().map_or(NORMAL, of_interface);
        let method = if case.contact.method == Method::PolonskyKeer { 10.0 } else { 1.0 };
        // A larger grid takes slightly more.
        let size = (nx * ny / LARGE).max(1.0).powf(GROWTH);
        Cost { convolutions: method * size * normal.convolutions, ..normal }
    }

    /// Number of computed passes, updates, increments or points.
    fn steps(&self, course: &Course) -> f64 {
        match course {
            Course::Passes(_) => self.passes(),
            Course::InPlace(slide) => 1.0 + slide.ends.len() as f64,
            Course::Stages(stages) => self.increments(stages),
            Course::Sweep(points) => points.len() as f64,
            Course::Rolling(_) => 1.0,
        }
    }

    /// Number of contacts that are computed: steps, or the positions of all computed passes.
    fn contacts(&self, course: &Course) -> f64 {
        self.steps(course) * self.overlaps.len() as f64
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
    fn observed(&self, course: &Course, every: usize) -> f64 {
        let passes = self.passes();
        if every == 0 { passes } else { (self.contacts(course) / every as f64).max(passes) }
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
        each!(capability C => if let Some(asked) = C::of(&self.case.with) {
            let positions = self.observed_together(asked.every(), C::OF_LOAD_CYCLES);
            let at_once = threads.clamp(1, positions.max(1)).min(positions) as f64;
            looked_at = looked_at.max(positions);
            largest = largest.max(at_once * C::memory([nx as usize, ny as usize]));
        });
        let states = 2.0 * self.case.remembered() as f64 * self.cells();
        NUMBER * (looked_at as f64 * nx * ny + states) + largest
    }

    /// Number of cells of both bodies together.
    fn cells(&self) -> f64 {
        cells(&self.lower) + cells(&self.upper)
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

    /// Work of figures and page.
    fn drawing(&self, threads: usize) -> f64 {
        let [figures, pictures, cells] = match self.case.motion {
            Some(_) => {
                let [pictures, cells] = self.kept();
                [20.0, pictures, self.passes() * cells]
            }
            None => [10.0, 0.0, 0.0],
        };
        let work = FIGURE * figures + PICTURE * pictures + DRAWN_CELL * (self.cells() + cells);
        START + work / (threads.clamp(1, 4) as f64).powf(EFFICIENCY)
    }
}

fn cells(grid: &Grid) -> f64 {
    grid.shape[0] as f64 * grid.shape[1] as f64
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
/// Cost of a film of oil at a speed, together with the film on half as many cells, or at a position of a motion, whose
/// steps of time are halved where they do not end at once; the exponent of its growth with the
/// number of cells; and the numbers that it keeps for each cell, most of them in the factor of the near matrix.
const FILM: Cost = Cost { convolutions: 300.0, work: 6.0 };
const FILM_GROWTH: f64 = 0.7;
const FILM_MEMORY: f64 = 1500.0;
/// Number of cells from which a contact takes more convolutions, and the exponent of this growth.
const LARGE: f64 = 16384.0;
const GROWTH: f64 = 0.09;
/// Work at a position besides its contact.
const POSITION: f64 = 3.7e5;
/// Work of the stress on a plane, in the unit of effort for each cell and log₂ N.
const STRESS: f64 = 120.0;
/// Work of a figure, and of a picture of an animation.
const FIGURE: f64 = 3.4e7;
const PICTURE: f64 = 1.4e7;
/// Work of a cell of a body, or of a stored pressure, in files, figures and page.
const DRAWN_CELL: f64 = 250.0;
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
