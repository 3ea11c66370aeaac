//! Memory and time of a run, told from the numbers of cells alone: before a surface is made.

use web_time::Instant;

use crate::error::{Error, Result};
use crate::grid::Grid;
use crate::material::Compliances;
use crate::motion::{PlasticUpdate, memory_together};
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
    /// Passes that are computed, the others extrapolated; 1 of a contact at rest.
    pub passes: f64,
    /// Convolutions of all contacts together, those on coarser grids by their share of cells; none of bodies that flow below their
    /// surfaces.
    pub convolutions: f64,
    /// The work of solving and writing, in the time that an iteration takes for a cell and a binary digit of their number: about a
    /// nanosecond.
    pub effort: f64,
    /// The work of the figures and the page, in the same unit.
    pub drawing: f64,
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
    let Memory { solver, together, results, volumes } = sizes.memory();
    let solvers = threads.clamp(1, overlaps.len().max(1)) as f64 * solver;
    let memory = PROGRAM
        + match case.motion {
            // What a static contact leaves is written when its solver is gone, and drawn when all is written.
            None => {
                let drawn = PICTURES + NUMBER * DRAWN * sizes.facing().iter().product::<f64>();
                surfaces.making.max(surfaces.kept + solvers.max(results)).max(drawn)
            }
            Some(_) => {
                let working = (solvers + results - volumes).max(together + solver);
                let drawing = PICTURES + ANIMATION + surfaces.making.max(surfaces.kept + working);
                // What bodies flow in is large, and is gone before something is drawn.
                drawing.max(surfaces.kept + working + volumes)
            }
        };
    let (convolutions, solving) = sizes.solving(threads);
    let effort = solving + sizes.writing();
    let drawing = sizes.drawing(threads);
    let surfaces = surfaces.making.max(surfaces.kept);
    let passes = case.motion.map_or(1.0, |motion| sizes.computed_passes(motion.passes));
    Ok(Demand { surfaces, solver, together, results, memory, passes, convolutions, effort, drawing })
}

impl Demand {
    /// Estimates the time of solving and writing, and that of figures and page, on this machine as it is now.
    ///
    /// The time of some convolutions is measured, in a few milliseconds. The sum is right within a factor of 1.5 for the examples, and
    /// of three where the contact is an ordinary one.
    pub fn times(&self) -> [Second; 2] {
        let unit = unit_of_effort();
        [self.effort * unit, self.drawing * unit]
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
    /// What of it are the volumes of bodies that flow below their surfaces.
    volumes: f64,
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
        Memory { solver, together, results: NUMBER * results + volumes, volumes }
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

    /// Convolutions of all contacts, and the work of solving them with all that is computed beside, in units of a cell times the
    /// binary logarithm of the cells of its contact.
    fn solving(&self, threads: usize) -> (f64, f64) {
        let case = self.case;
        let [nx, ny] = self.facing();
        let work = |columns: f64| columns * ny * (columns * ny).max(2.0).log2();
        let boundary: f64 =
            case.contact.boundary.wraps().map(|wraps| if wraps { 0.3 } else { 0.5 }).iter().sum();
        let digits = (0.3 - 0.7 * case.contact.tolerance.log10() / 6.0).max(0.4);
        // A larger grid takes some more.
        let size = (nx * ny / LARGE).max(1.0).powf(GROWTH);
        let together = |works: usize| (threads.clamp(1, works.max(1)) as f64).powf(EFFICIENCY);
        let method = match case.contact.method {
            Method::PolonskyKeer => 10.0,
            _ => 1.0,
        };
        let all: f64 = self.solved().iter().map(|columns| work(*columns as f64)).sum();
        // Convolutions of each contact, and their work with that of the iteration around them.
        let of = |cost: Cost, contacts: f64| {
            let convolutions = contacts * cost.convolutions * digits;
            [convolutions, boundary * cost.work * convolutions * all]
        };
        let normal = Cost { convolutions: method * size * NORMAL.convolutions, ..NORMAL };
        let unlike = self.compliances().is_some_and(|compliances| compliances.dundurs().abs() > 1e-3);
        let rolling = if unlike { ROLLING_UNLIKE } else { ROLLING };
        let [convolutions, mut effort] = match (case.motion, &case.friction) {
            (Some(motion), _) => {
                let searches = match (motion.control, motion.plastic_update) {
                    (ControlKind::PassLoad, PlasticUpdate::Step) => 5.0,
                    _ => 1.0,
                };
                let positions = self.solved().len();
                let passes = self.computed_passes(motion.passes);
                let mut cost = if self.is_coupled() { SLIDING } else { normal };
                // Later passes start from the pressures of the one before.
                cost.convolutions *= WARM + (1.0 - WARM) / passes.max(1.0);
                let [convolutions, effort] = of(cost, passes * searches);
                let effort = effort + POSITION * passes * positions as f64;
                let beside = passes * self.running(motion.passes);
                [convolutions * positions as f64, effort / together(positions) + beside]
            }
            (None, _) if case.sliding.is_some() => {
                let updates = case.sliding.map_or(0, |sliding| sliding.updates) as f64;
                of(normal, 2.0 + updates)
            }
            (None, friction) => match case.loading_path(nx * ny * self.lower.cell_area()) {
                Some(LoadingPath::Rolling(_)) => of(rolling, 1.0),
                Some(LoadingPath::Stages(stages)) => {
                    let increments = stages.iter().map(|stage| stage.increments).sum::<usize>() as f64;
                    let shear = match friction.as_ref().map(|friction| friction.law.coupling) {
                        Some(Coupling::Full | Coupling::Goodman) if unlike => SHEAR_UNLIKE,
                        Some(_) => SHEAR,
                        None => normal,
                    };
                    of(shear, increments)
                }
                Some(LoadingPath::Sweep(points)) => {
                    let rolls = points.iter().filter(|point| point.rolling.is_some()).count() as f64;
                    let [a, b] = [of(rolling, rolls), of(normal, points.len() as f64 - rolls)];
                    let stiffness = STIFFNESS * boundary * digits * points.len() as f64 * all;
                    [a[0] + b[0], a[1] + b[1] + stiffness]
                }
                None => of(normal, 1.0),
            },
        };
        if let Some(spec) = &case.subsurface {
            let passes = self.computed_passes(case.motion.map_or(1, |motion| motion.passes));
            let planes = spec.layers + spec.planes.len();
            effort += passes * STRESS * planes as f64 * work(nx) / together(planes);
        }
        // A fresh counter-body is made for each pass.
        let times = match case.motion {
            Some(MotionSpec { counter: CounterBody::Fresh, passes, .. }) => [1.0, passes as f64],
            _ => [1.0; 2],
        };
        let made = self.making().into_iter().zip(times);
        let making =
            MAKING * made.map(|([cells, _], times)| times * cells * cells.max(2.0).log2()).sum::<f64>();
        (convolutions, effort + self.flow(threads) + making)
    }

    /// The work of films and flash temperatures in a computed pass.
    fn running(&self, passes: usize) -> f64 {
        let films = [&self.case.lower, &self.case.upper].iter().filter(|body| body.film.is_some()).count();
        let heated = match self.case.temperature {
            Some(spec) if spec.every > 0 => 1.0 / spec.every.min(passes.max(1)) as f64,
            _ => 0.0,
        };
        let cells = self.solved().iter().sum::<usize>() as f64 * self.facing()[1];
        cells * (FILM * films as f64 + HEAT * heated)
    }

    /// Cells of the two bodies together.
    fn cells(&self) -> f64 {
        [&self.lower, &self.upper].map(|grid| grid.shape[0] as f64 * grid.shape[1] as f64).iter().sum()
    }

    /// Positions of a pass whose pressures are kept, and their cells.
    fn kept(&self) -> [f64; 2] {
        match self.case.output.pressure_every {
            0 => [0.0; 2],
            every => {
                let kept = self.overlaps.iter().step_by(every);
                [kept.len() as f64, kept.sum::<usize>() as f64 * self.lower.shape[1] as f64]
            }
        }
    }

    /// The work of writing fields.
    fn writing(&self) -> f64 {
        let case = self.case;
        let bodies = [&case.lower, &case.upper];
        let of_body = |body: &&Body| if body.film.is_some() { 3.0 } else { 2.0 };
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

    /// The work of figures and page.
    fn drawing(&self, threads: usize) -> f64 {
        let case = self.case;
        let bodies = [&case.lower, &case.upper];
        let any = |has: fn(&Body) -> bool| f64::from(bodies.into_iter().any(has));
        let [wears, film] = [any(|body| body.wear.is_some()), any(|body| body.film.is_some())];
        let given = |there: bool| f64::from(there);
        let mut figures = match case.motion {
            Some(_) => 19.0 + given(case.friction.is_some()) + given(case.temperature.is_some()),
            None => 9.0 + if case.friction.is_some() { 4.0 } else { 0.0 },
        };
        figures += wears + film + 2.0 * wears.max(film) + given(case.subsurface.is_some());
        figures += 2.0 * given(case.plasticity.is_some()) + given(case.is_swept());
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
    /// Convolutions to 10⁻⁶, of few cells.
    convolutions: f64,
    /// The work of one, with that of the iteration around it, free, in the unit of effort.
    work: f64,
}

// Each measured (docs/performance.md).
/// A normal contact.
const NORMAL: Cost = Cost { convolutions: 15.8, work: 2.2 };
/// A contact whose shear displaces the surface normally, sliding.
const SLIDING: Cost = Cost { convolutions: 36.0, work: 6.5 };
/// An increment with friction of identical bodies, whose pressure is known without the shear.
const SHEAR: Cost = Cost { convolutions: 24.0, work: 7.0 };
/// An increment with friction of dissimilar bodies.
const SHEAR_UNLIKE: Cost = Cost { convolutions: 68.0, work: 7.0 };
/// Steady rolling of identical bodies.
const ROLLING: Cost = Cost { convolutions: 85.0, work: 4.6 };
/// Steady rolling of dissimilar bodies.
const ROLLING_UNLIKE: Cost = Cost { convolutions: 230.0, work: 5.0 };
/// Convolutions of a pass over those of the first.
const WARM: f64 = 0.8;
/// Cells from which on a contact takes more convolutions, and the power of their number by which it does.
const LARGE: f64 = 16384.0;
const GROWTH: f64 = 0.09;
/// A position beside its contact.
const POSITION: f64 = 3.7e5;
/// The stiffness of a contact, in the unit of effort for each cell and binary digit.
const STIFFNESS: f64 = 12.0;
/// The stress on a plane, likewise.
const STRESS: f64 = 120.0;
/// A surface: read or made, prepared, its figures for the estimate, likewise.
const MAKING: f64 = 6.0;
/// The growth of a film on a cell of a body at a position, in the unit of effort.
const FILM: f64 = 380.0;
/// The flash temperature of a cell at a position.
const HEAT: f64 = 90.0;
/// A field that is written, and each of its cells.
const FIELD: f64 = 4e5;
const WRITTEN: f64 = 110.0;
/// A figure, and a picture of an animation.
const FIGURE: f64 = 3.4e7;
const FRAME: f64 = 1.4e7;
/// A cell of a body in the figures.
const DRAWN_CELL: f64 = 450.0;
/// A pressure field on the page, and each of its cells.
const SHOWN: f64 = 4e5;
const SHOWN_CELL: f64 = 190.0;
/// The start and the end of the program.
const START: f64 = 2.5e7;
/// The power of the number of threads by which work that is shared out is sooner done.
const EFFICIENCY: f64 = 0.85;

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
    let least = std::iter::repeat_with(time).take(32).fold(f64::INFINITY, f64::min);
    let cells = (SIDE * SIDE) as f64;
    SHARE * least / (cells * cells.log2())
}
