//! Estimate of a case before anything is solved: its key figures and its warnings.

mod beside;
mod contact;
mod demand;
mod plausible;

pub(super) use contact::CELLS_ACROSS;
pub use contact::{cut_off, spot, too_few_cells};
pub use demand::{Demand, demand, memory_on_device};

use super::case::{Body, Case, Course, Hardness, Layer, Source, TopographySpec};
use super::closed_form::ClosedForm;
use super::prepare::{Bodies, MountedSurface};
use crate::lubrication::lubrication;
use crate::subsurface::Plan;
use crate::viscoelastic::{self, ViscoelasticEstimate};
use asperity_base::error::{Error, Result};
use asperity_base::grid::{CellValues, Field, Grid};
use asperity_base::math::parallel;
use asperity_base::math::sum::sums;
use asperity_base::units::{self, Dimension, Metre, Newton, Pascal, Second, SquareMetre};
use asperity_contact::lubrication::Lubrication;
use asperity_contact::material::{Coating, Compliances, Material, plastic_share};
use asperity_contact::motion::{
    LoadControl, Paraboloid, Position, Stage, Strategy, check_limit, initial_gap, opposing_values,
};
use asperity_contact::reference::HertzSphere;
use asperity_contact::solver::{Control, Coupling, Creep, Friction, Rolling, Tangential};
use asperity_contact::with::InterfaceNumbers;
use asperity_surface::{Form, Level};

/// Largest rms slope of the gap for a half-space theory: up to here tan and sin of a slope agree within about
/// 5 %.
pub(super) const STEEP: f64 = 0.3;

/// Share of E* that the pressure of elastic bodies may reach. The shear strength of a perfect crystal is
/// about G/2π (Frenkel, Z. Phys. 37, 572 (1926)), and Hertz' contact has it below a pressure of about E*/10.
pub(super) const STRENGTH: f64 = 0.1;

/// Properties of a computation known before it starts.
#[derive(Debug, Clone, PartialEq)]
#[non_exhaustive]
pub struct Estimate {
    /// Composite modulus E* of the pair without its coatings; infinite if both bodies are rigid.
    pub modulus: Pascal,
    /// Dundurs' β of the pair.
    pub dundurs: f64,
    /// The course of the contact.
    pub course: Course,
    /// Cap on the pressure: the smaller hardness, infinite for an elastic pair; the smallest value of
    /// hardness maps.
    pub hardness: Pascal,
    /// Largest cap on the pressure of any two cells; equal to `hardness` if no hardness is a map.
    pub max_hardness: Pascal,
    /// Share of the lower body in the plastic deformation, 0 to 1; `None` if it differs from cell to cell.
    pub lower_share: Option<f64>,
    /// Prescribed load or approach.
    pub control: Control,
    /// Where a load holds; for a static contact, at its one position.
    pub load_control: LoadControl,
    /// Number of positions in a pass; 1 for a static contact.
    pub positions: usize,
    /// Number of passes; 1 for a static contact.
    pub passes: usize,
    /// Largest apparent area of a position.
    pub apparent_area: SquareMetre,
    /// Mean apparent area over the positions.
    pub mean_facing_area: SquareMetre,
    /// Upper limit of the load, with every cell of the overlap at the hardness, reduced by the shear of
    /// sliding bodies; infinite for an elastic pair.
    pub plastic_limit: Newton,
    /// Rms slope of the initial gap, for independent surfaces.
    pub gap_slope: f64,
    /// The interface of the bodies in numbers.
    pub interface: InterfaceNumbers,
    /// The oil between lubricated bodies; `None` between dry ones.
    pub lubrication: Option<Lubrication>,
    /// Closed form of the contact, if both bodies are smooth forms and stay elastic; `None` for others.
    pub closed_form: Option<ClosedForm>,
    /// Requested output of the stress under the surface.
    pub subsurface: Option<Plan>,
    /// Viscoelastic bodies; `None` if both are elastic.
    pub viscoelastic: Option<ViscoelasticEstimate>,
    /// Warnings for the user.
    pub warnings: Vec<String>,
    /// Warnings from Hertz' estimate, which a result shows by itself.
    pub predicted: Vec<String>,
}

impl Estimate {
    /// The shortest relaxation time and the longest retardation time of the bodies, and how much stiffer they
    /// are when they are fast; `None` for elastic bodies.
    fn relaxation(&self) -> Option<([Second; 2], f64)> {
        self.viscoelastic.as_ref().map(|bodies| (bodies.times, bodies.stiffening))
    }
}

/// Estimates `case` on its `bodies`.
///
/// # Errors
/// [`Error::BeyondPlasticLimit`] if no pressure within the hardness can carry the load,
/// [`Error::BeyondFriction`] if no shear within the friction can carry the tangential force.
pub fn estimate(case: &Case, bodies: &Bodies) -> Result<Estimate> {
    let (lower, upper) = (&case.lower.material, &case.upper.material);
    let [lower_grid, upper_grid] = [&bodies.lower, &bodies.upper].map(|body| *body.topography.grid());
    deep_enough(case, &lower_grid)?;
    let positions = positions(case, [lower_grid, upper_grid]);
    let overlaps: Vec<usize> = positions.iter().map(|position| position.columns).collect();
    let facing = lower_grid.shape[0].min(upper_grid.shape[0]);
    let column = lower_grid.shape[1] as f64 * lower_grid.cell_area();
    let column_area = |columns: usize| columns as f64 * column;
    let apparent_area = facing as f64 * column;
    let control = case.contact.prescribed().control(apparent_area);
    let [lower_hardness, upper_hardness] = [&bodies.lower.hardness, &bodies.upper.hardness];
    let hardness = lower_hardness.min().min(upper_hardness.min());
    let course = case.course(apparent_area);
    let load_control = load_control(&course);
    let law = case.friction.as_ref().map(|friction| &friction.law);
    // Hardness of opposing cells at a position: that of the softer one.
    let facing_hardness = |position: &Position| {
        let shapes = [lower_grid.shape, upper_grid.shape];
        opposing_values([lower_hardness, upper_hardness], shapes, position, f64::min)
    };
    let mean_hardness = |position: &Position| {
        let cells = position.columns * lower_grid.shape[1];
        facing_hardness(position).sum(cells) / cells as f64
    };
    bears(law, course.stages(), mean_hardness(&positions[0]), apparent_area)?;
    let cap = |hardness| cap(case, &course, hardness);
    let bearable: Vec<Newton> = positions
        .iter()
        .map(|position| match facing_hardness(position) {
            CellValues::Uniform(hardness) => cap(hardness) * column_area(position.columns),
            CellValues::Field(hardness) => lower_grid.cell_area() * hardness.mapv(cap).sum(),
        })
        .collect();
    let plastic_limit = match control {
        Control::Load(_) => load_control.plastic_limit(&bearable),
        Control::Approach(_) => bearable.iter().copied().fold(0.0, f64::max),
    };
    check_limit(control, plastic_limit)?;
    let compliances = Compliances::new(lower, upper)?;
    // An attraction presses bodies together by an unknown force.
    if let Some(law) = law.filter(|_| case.interface.is_empty()) {
        holds(law, &course, case.contact.prescribed().control(apparent_area), apparent_area)?;
    }
    let slopes = [&bodies.lower, &bodies.upper].map(|body| body.topography.sdq());
    let mut estimate = Estimate {
        modulus: compliances.modulus(),
        dundurs: compliances.dundurs(),
        course,
        hardness,
        max_hardness: lower_hardness.max().min(upper_hardness.max()),
        lower_share: share_of_lower(lower_hardness, upper_hardness),
        control,
        load_control,
        positions: overlaps.len(),
        passes: case.motion.map_or(1, |motion| motion.passes),
        apparent_area,
        mean_facing_area: overlaps.iter().sum::<usize>() as f64 / overlaps.len() as f64 * column,
        plastic_limit,
        gap_slope: slopes.iter().filter(|slope| slope.is_finite()).fold(0.0, |all: f64, s| all.hypot(*s)),
        interface: InterfaceNumbers::default(),
        closed_form: ClosedForm::from_case(case, lower_grid.extent(), control)
            .filter(|_| case.interface.is_empty() && !case.relaxes())
            .filter(|form| form.max_pressure.is_none_or(|pressure| pressure <= hardness)),
        lubrication: lubrication(case)?,
        subsurface: Plan::new(case, [&lower_grid, &upper_grid], &positions)?,
        viscoelastic: viscoelastic::estimate(
            case,
            [&bodies.lower.topography, &bodies.upper.topography],
            &bodies.master_curves,
        )?,
        warnings: Vec::new(),
        predicted: Vec::new(),
    };
    estimate.warnings = warnings(case, bodies, &estimate);
    estimate.warnings.extend(estimate.viscoelastic.iter().flat_map(|bodies| bodies.warnings.clone()));
    let curved = if case.interface.is_empty() {
        contacts(case, bodies, &positions, &mut estimate)
    } else {
        // Hertz' contact says little about bodies that are no hard walls to each other.
        let heights = [&bodies.lower, &bodies.upper].map(|body| body.topography.heights());
        let largest = positions.iter().max_by_key(|position| position.columns).expect("a position");
        let (gap, boundary) = (initial_gap(heights, largest), case.contact.boundary);
        let (numbers, doubts) = case.interface.numbers(&lower_grid, &gap, boundary, estimate.modulus)?;
        estimate.warnings.extend(doubts);
        estimate.interface = numbers;
        Paraboloid::fit(&gap, lower_grid.pitch).is_some()
    };
    let out_of_scale = beside::out_of_scale(case, bodies, &estimate, curved);
    let lost = beside::lost(case, bodies, &estimate);
    estimate.warnings.splice(0..0, out_of_scale.into_iter().chain(lost));
    let yields = rolls_plastically(case, bodies, &estimate);
    estimate.predicted.extend(yields);
    Ok(estimate)
}

/// Returns the share of the lower body in the plastic deformation, if it is the same for all cells.
fn share_of_lower(lower: &CellValues, upper: &CellValues) -> Option<f64> {
    let one_each = |values: &CellValues| values.min() == values.max();
    match (one_each(lower) && one_each(upper), lower.max() < upper.min(), lower.min() > upper.max()) {
        (true, ..) => Some(plastic_share(lower.min(), upper.min())),
        (_, true, _) => Some(1.0),
        (_, _, true) => Some(0.0),
        _ => None,
    }
}

/// Checks the plastic limit of a case from its grids alone, without its surfaces. A case with a hardness map
/// passes.
///
/// # Errors
/// [`Error::BeyondPlasticLimit`] if no pressure within the hardness can carry the load.
pub(super) fn check_plastic_limit(case: &Case, grids: [Grid; 2]) -> Result<()> {
    let (Hardness::Uniform(lower), Hardness::Uniform(upper)) = (&case.lower.hardness, &case.upper.hardness)
    else {
        return Ok(());
    };
    let hardness = lower.min(*upper);
    let [grid, other] = grids;
    let column = grid.shape[1] as f64 * grid.cell_area();
    let apparent_area = grid.shape[0].min(other.shape[0]) as f64 * column;
    let course = case.course(apparent_area);
    bears(case.friction.as_ref().map(|friction| &friction.law), course.stages(), hardness, apparent_area)?;
    let cap = cap(case, &course, hardness);
    let positions = positions(case, grids);
    let bearable: Vec<Newton> =
        positions.iter().map(|position| cap * position.columns as f64 * column).collect();
    check_limit(
        case.contact.prescribed().control(apparent_area),
        load_control(&course).plastic_limit(&bearable),
    )
}

/// Whether a load is prescribed for each step or for the mean of a pass.
fn load_control(course: &Course) -> LoadControl {
    match course {
        Course::Passes(motion) => motion.load_control,
        _ => LoadControl::Step,
    }
}

/// Largest pressure on cells of a hardness, reduced by the shear of sliding bodies.
fn cap(case: &Case, course: &Course, hardness: Pascal) -> Pascal {
    let law = case.friction.as_ref().map(|friction| &friction.law);
    match course {
        Course::Passes(_) | Course::InPlace(_) => {
            law.map_or(hardness, |friction| friction.sliding_cap(hardness))
        }
        Course::Stages(stages) => stage_cap(law, &stages[0], hardness),
        Course::Rolling(_) | Course::Sweep(_) => hardness,
    }
}

/// Returns the positions of the first pass, or the only one of a static contact.
fn positions(case: &Case, [lower, upper]: [Grid; 2]) -> Vec<Position> {
    let columns = [lower.shape[0], upper.shape[0]];
    // The load does not affect the positions.
    match case.motion(1.0) {
        None => vec![Position::flush(columns[0].min(columns[1]))],
        Some(motion) => motion.positions(columns, lower.shape[1], 1),
    }
}

/// Largest pressure on cells of the `hardness` at the end of a stage, whatever its tangential force.
fn stage_cap(friction: Option<&Friction>, stage: &Stage, hardness: Pascal) -> Pascal {
    match (friction, stage.loading.tangential) {
        (Some(friction), Tangential::Sliding(_)) => friction.sliding_cap(hardness),
        _ => hardness,
    }
}

/// Returns an error if a stage prescribes more load than its cells can carry together with its shear. The
/// sums of p and of √α q over all cells are at most H, as on each cell. In gross slip this holds from the
/// first increment of the stage, when most of the load of the stage before is still present.
fn bears(
    friction: Option<&Friction>,
    stages: &[Stage],
    hardness: Pascal,
    apparent_area: SquareMetre,
) -> Result<()> {
    let mut before = Some(0.0);
    for stage in stages {
        let Control::Load(load) = stage.loading.normal else {
            before = None;
            continue;
        };
        let limit = apparent_area * stage_cap(friction, stage, hardness);
        let (load_borne, limit) = match stage.loading.tangential {
            Tangential::Sliding(_) => {
                let first = before.map_or(load, |before| before + (load - before) / stage.increments as f64);
                (first.max(load), limit)
            }
            Tangential::Force([x, y]) if limit.is_finite() => {
                let growth = friction.map_or(0.0, |friction| friction.junction_growth);
                let beside = growth * (x * x + y * y);
                (load, (limit * limit - beside).max(0.0).sqrt())
            }
            _ => (load, limit),
        };
        if load_borne >= limit {
            return Err(Error::BeyondPlasticLimit { load: load_borne, limit });
        }
        before = Some(load);
    }
    Ok(())
}

/// Returns an error if the tangential force of a stage exceeds the friction limit under its load: at most μp
/// and at most τ on each cell.
fn holds(friction: &Friction, course: &Course, control: Control, apparent_area: SquareMetre) -> Result<()> {
    let ends: Vec<_> = match course {
        Course::Stages(stages) => {
            stages.iter().map(|Stage { loading, .. }| (loading.normal, loading.tangential)).collect()
        }
        Course::Rolling(rolling) => pushed(control, *rolling).into_iter().collect(),
        Course::Sweep(points) => {
            points.iter().filter_map(|point| pushed(point.control, point.regime.rolling()?)).collect()
        }
        Course::Passes(_) | Course::InPlace(_) => Vec::new(),
    };
    for end in ends {
        if let (Control::Load(load), Tangential::Force([x, y])) = end {
            let limit = (friction.coefficient * load).min(friction.shear_strength * apparent_area);
            let force = x.hypot(y);
            if force > 0.0 && force >= limit {
                return Err(Error::BeyondFriction { force, limit });
            }
        }
    }
    Ok(())
}

/// Returns the prescribed values of a contact that rolls under a tangential force.
fn pushed(control: Control, rolling: Rolling) -> Option<(Control, Tangential)> {
    match rolling.creep {
        Creep::Force(force) => Some((control, Tangential::Force(force))),
        Creep::Creepage(_) => None,
    }
}

fn warnings(case: &Case, bodies: &Bodies, estimate: &Estimate) -> Vec<String> {
    let mut warnings = Vec::new();
    plausible::implausible(case, bodies.lower.topography.grid(), estimate, &mut warnings);
    let heats = case.temperature.is_some_and(|temperature| temperature.every() > 0);
    for (name, body, given) in [("lower", &bodies.lower, &case.lower), ("upper", &bodies.upper, &case.upper)]
    {
        warnings.extend(filled(name, body));
        coarse(name, body, &mut warnings);
        warnings.extend(thin(name, &given.material, body.topography.grid().pitch));
        if heats && given.thermal.is_some() && given.material.is_layered() {
            warnings.push(format!(
                "the flash temperature takes the {name} body without its layers: under layers that conduct worse than the body the \
                 surfaces get hotter"
            ));
        }
        if matches!(given.topography.source, Source::File { .. } | Source::Given { .. })
            && given.topography.preparation.level == Level::None
        {
            tilted(name, body, &mut warnings);
        }
        let shifts = matches!(case.motion, Some(motion) if motion.strategy() != Strategy::Overlap);
        let wraps = [0, 1].map(|axis| case.contact.boundary.repeats(axis) || (shifts && axis == 0));
        torn(name, body, wraps, &mut warnings);
    }
    warnings.extend(fast(case, bodies.lower.topography.grid().pitch[0]));
    if estimate.gap_slope > STEEP {
        warnings.push(format!(
            "the surfaces are steep for a half-space theory of small slopes: the rms slope of the gap is {:.4}, up to {STEEP} \
             tan and sin agree; an `s_filter` takes short waves out",
            estimate.gap_slope
        ));
    }
    // Rms pressure of a rough contact pressed flat, E* h'/2; Persson (2001). The real contact has about this
    // pressure at any load. The slope of a form is largest at its rim, far from the contact.
    let pressure = 0.5 * estimate.modulus * estimate.gap_slope;
    let is_form = |body: &Body| {
        let TopographySpec { source, plus, .. } = &body.topography;
        matches!(source, Source::Form { .. }) || plus.iter().any(|layer| matches!(layer, Layer::Form { .. }))
    };
    if pressure > estimate.hardness
        && !case.is_coated()
        && ![&case.lower, &case.upper].into_iter().any(is_form)
    {
        warnings.push(format!(
            "most of the contact will be plastic: slopes of {:.4} call for pressures of {}, the hardness is {}: \
             the hardness, not elasticity, will make the answer",
            estimate.gap_slope,
            units::format(pressure, Dimension::Pressure),
            units::format(estimate.hardness, Dimension::Pressure)
        ));
    }
    if let Control::Load(load) = estimate.control
        && load > 0.5 * estimate.plastic_limit
    {
        warnings.push(format!(
            "the load is near the plastic limit, {}: contact will be almost complete; a lower load or a \
             greater hardness leaves a gap",
            units::format(estimate.plastic_limit, Dimension::Force)
        ));
    }
    if let Some(motion) = case.motion
        && motion.stride > 1
        && estimate.hardness.is_finite()
    {
        warnings.push(format!(
            "with `stride = {}` each column meets {:.2} % of those that pass it: asperities that yield leave a comb \
             instead of a track, and the plastic volume is too small; `stride = 1` lets all of them meet",
            motion.stride,
            100.0 / motion.stride as f64
        ));
    }
    if let Some(friction) = &case.friction {
        frictional(case, bodies, &friction.law, estimate, &mut warnings);
    }
    warnings
}

/// Returns an error if the plastic volume is shallower than a cell, or deeper than the grid is wide.
fn deep_enough(case: &Case, grid: &Grid) -> Result<()> {
    let Some(plasticity) = case.plasticity else { return Ok(()) };
    let [dx, dy] = grid.pitch;
    let [least, most] = [dx.max(dy), grid.extent()[0].min(grid.extent()[1])];
    if (least..=most).contains(&plasticity.depth) {
        return Ok(());
    }
    let length = |value| units::format(value, Dimension::Length);
    let message = format!(
        "'depth' is {}, expected from a cell, {}, to the smaller side of the grid, {}",
        length(plasticity.depth),
        length(least),
        length(most)
    );
    Err(case.error_at("plasticity.depth", message, None))
}

/// Warns if heat stays in its cell while the bodies slide over one cell.
fn fast(case: &Case, pitch: Metre) -> Option<String> {
    if case.temperature.is_none_or(|temperature| temperature.every() == 0) {
        return None;
    }
    // Only the time and distance of the motion are used, which do not depend on the load.
    let motion = case.motion(1.0)?;
    let speed = motion.sliding_speed();
    let peclet = |body: &Body| body.thermal.map(|thermal| 0.5 * speed * pitch / thermal.diffusivity());
    let [lower, upper] = [&case.lower, &case.upper].map(peclet);
    let largest = lower?.max(upper?);
    (largest > 1.0).then(|| {
        format!(
            "heat hardly leaves a cell while the bodies slide over one: its Péclet number is {}, up to 1 the flash temperature \
             is right to a few per cent; take a smaller `pitch`",
            units::format_number(largest)
        )
    })
}

/// Warns of layers that the cells do not resolve: all of them together, or one of them.
fn thin(name: &str, material: &Material, pitch: [Metre; 2]) -> Option<String> {
    /// Thickness of a layer over the size of a cell, from which it counts by more than its compliance.
    const LEAST: f64 = 0.1;
    let layers = &material.layers;
    let cell = pitch[0].max(pitch[1]);
    let total = material.thickness();
    // Layers that lie deeper than a cell are not felt as such, nor parts of a layer.
    let thinnest = || {
        let alike = |one: &Coating, other: &Coating| [one.young, one.poisson] == [other.young, other.poisson];
        let mut depth = 0.0;
        let mut number = 0;
        layers.chunk_by(alike).find_map(|layer| {
            let thickness = layer.iter().map(|part| part.thickness).sum::<Metre>();
            let found = (depth < cell && thickness < LEAST * cell).then_some((number, thickness));
            depth += thickness;
            number += layer.len();
            found
        })
    };
    let (what, thickness, than) = if layers.is_empty() {
        return None;
    } else if total < cell {
        let what = if layers.len() > 1 { "layers" } else { "coating" };
        (format!("the thickness of the {what}"), total, "a cell")
    } else {
        let (n, thickness) = thinnest()?;
        (format!("the thickness of layer {}", n + 1), thickness, "a tenth of a cell")
    };
    let length = |value| units::format(value, Dimension::Length);
    Some(format!(
        "{what} of the {name} body, {}, is less than {than}; a cell is {}: the mean displacement of a cell is right, but the \
         pressure is not resolved over this thickness; take a smaller `pitch` for that",
        length(thickness),
        length(cell)
    ))
}

/// Warns if there is no contact, if the boundary of the grid cuts the contact off, or if the contact has too
/// few cells. Returns whether the bodies are curved.
fn contacts(case: &Case, bodies: &Bodies, positions: &[Position], estimate: &mut Estimate) -> bool {
    let surfaces = [bodies.lower.topography.heights(), bodies.upper.topography.heights()];
    if let Control::Approach(approach) = estimate.control
        && let Some(touch) = contact::apart(surfaces, positions, approach)
    {
        estimate.warnings.push(contact::no_contact(approach, touch));
        return true;
    }
    let most = positions.iter().map(|position| position.columns).max().unwrap_or(0);
    let fullest: Vec<&Position> = positions.iter().filter(|position| position.columns == most).collect();
    let Some(position) = fullest.get(fullest.len() / 2) else { return true };
    let control = match (estimate.control, estimate.load_control) {
        (Control::Load(load), LoadControl::Pass) => {
            Control::Load(load * estimate.apparent_area / estimate.mean_facing_area)
        }
        (control, _) => control,
    };
    // The largest load of a history.
    let control =
        estimate.course.stages().iter().fold(control, |most, stage| match (most, stage.loading.normal) {
            (Control::Load(most), Control::Load(load)) => Control::Load(most.max(load)),
            (most, _) => most,
        });
    let gap = initial_gap(surfaces, position);
    let pitch = bodies.lower.topography.grid().pitch;
    if case.is_coated() {
        // Hertz' theory does not cover layers.
        return true;
    }
    let prediction = contact::predict(&gap, pitch, estimate.modulus, case.contact.boundary, control);
    // A motion and a load sweep leave only tables, which do not show where in a contact the pressure is.
    let tabled = estimate.course.moves() || estimate.course.is_sweep();
    let warnings = if tabled { &mut estimate.warnings } else { &mut estimate.predicted };
    warnings.extend(prediction.rim);
    estimate.warnings.extend(prediction.wide);
    estimate.predicted.extend(prediction.coarse);
    prediction.curved
}

/// Returns the larger Dundurs' β of the surfaces of the bodies and of the bodies below their layers, unless the grid with
/// this side does not feel these.
fn dundurs(case: &Case, estimate: &Estimate, side: Metre) -> f64 {
    let bodies = [&case.lower.material, &case.upper.material];
    let [lower, upper] = bodies.map(Material::at_surface);
    let at_surfaces = Compliances::new(&lower, &upper).map_or(0.0, |pair| pair.dundurs());
    let covered = bodies.into_iter().any(|material| material.thickness() > side);
    if covered || at_surfaces.abs() > estimate.dundurs.abs() { at_surfaces } else { estimate.dundurs }
}

/// Warns if friction is modelled more simply than the user may expect.
fn frictional(
    case: &Case,
    bodies: &Bodies,
    friction: &Friction,
    estimate: &Estimate,
    warnings: &mut Vec<String>,
) {
    /// Shear under pressure alone is about β p, which is negligible below this.
    const ALIKE: f64 = 0.01;
    /// Dundurs' β from which the coupling changes pressures and stick by more than a few per cent.
    const UNLIKE: f64 = 0.1;
    let beta = dundurs(case, estimate, bodies.lower.topography.grid().extent()[0]);
    if friction.coupling != Coupling::Full && beta.abs() > UNLIKE && !case.is_coated() {
        warnings.push(format!(
            "the bodies are dissimilar, Dundurs' β is {beta:.2}: `coupling = \"full\"` is exact"
        ));
    }
    let stages = match &estimate.course {
        Course::Stages(stages) => stages,
        Course::Rolling(_) | Course::Sweep(_) => {
            if !roll_alike(case, bodies) {
                warnings.push(
                    "steady rolling of a rough surface: its roughness stays in the contact instead of moving through it; \
                     creepage and force are those of a track that is the same everywhere"
                        .to_owned(),
                );
            }
            return;
        }
        Course::Passes(_) | Course::InPlace(_) => return,
    };
    let first = &stages[0];
    let slips = !matches!(first.loading.tangential, Tangential::Sliding(_));
    let matters = friction.coupling != Coupling::None && beta.abs().min(friction.coefficient) > ALIKE;
    if slips && matters && estimate.gap_slope > 0.0 && loads_at_once(stages) {
        warnings.push(format!(
            "dissimilar bodies (Dundurs' β is {beta:.2}) shear while their contact grows: loaded in one step they \
             stick where they first touch; give `increments` in [friction]"
        ));
    }
    let pushes = match first.loading.tangential {
        Tangential::Force([x, y]) | Tangential::Displacement([x, y]) => x.hypot(y) > 0.0,
        Tangential::Sliding(_) => false,
    };
    if first.increments == 1 && pushes && friction.coefficient > 0.0 && friction.shear_limit(1.0).is_finite()
    {
        warnings.push(
            "pressed and pushed in one step: stick, slip and `dissipation` are those of a push under the full load; push in a [[history]] \
             to follow the push step by step; `increments` in [friction] let load and push grow together, which is another path"
                .to_owned(),
        );
    }
    let unloads = stages.windows(2).any(|pair| match (pair[0].loading.normal, pair[1].loading.normal) {
        (Control::Load(before), Control::Load(after))
        | (Control::Approach(before), Control::Approach(after)) => after < before,
        _ => false,
    });
    if unloads && friction.shear_limit(1.0).is_infinite() {
        warnings.push(
            "under an infinite coefficient unloading may have no answer: cells that bear any shear open; give a large one"
                .to_owned(),
        );
    }
}

/// Warns of steady rolling of bodies that yield.
fn rolls_plastically(case: &Case, bodies: &Bodies, estimate: &Estimate) -> Option<String> {
    estimate.course.rolling().next()?;
    let pressure =
        rolling_pressure(case, bodies, estimate).filter(|pressure| *pressure > estimate.hardness)?;
    let [pressure, hardness] = [pressure, estimate.hardness].map(|p| units::format(p, Dimension::Pressure));
    Some(format!(
        "pressures of about {pressure} are beyond the hardness, {hardness}: cells yield {NOT_FLATTENED}"
    ))
}

/// The limitation of steady rolling of bodies that yield.
pub(super) const NOT_FLATTENED: &str = "in steady rolling, over a track that was not flattened before: what has been \
                                        rolled over meets a lower surface; a [motion] with `passes` flattens it";

/// Estimate of the largest pressure of a contact without a hardness, if there is one: Hertz' pressure of a
/// ball, or E* h'/2 for a rough surface.
fn rolling_pressure(case: &Case, prepared: &Bodies, estimate: &Estimate) -> Option<Pascal> {
    let bodies = [&case.lower, &case.upper];
    if !roll_alike(case, prepared) {
        return Some(0.5 * estimate.modulus * estimate.gap_slope);
    }
    let curvature = |body: &Body| match body.topography.source {
        Source::Form { form: Form::Sphere { radius }, .. } => Some(1.0 / radius),
        Source::Form { form: Form::Flat, .. } => Some(0.0),
        _ => None,
    };
    let radius = 1.0 / (curvature(bodies[0])? + curvature(bodies[1])?);
    let plain = bodies.iter().all(|body| body.topography.plus.is_empty());
    let hertz = match (estimate.control, estimate.load_control) {
        (Control::Approach(approach), _) => HertzSphere::from_approach(radius, estimate.modulus, approach),
        (Control::Load(load), LoadControl::Step) => HertzSphere { radius, modulus: estimate.modulus, load },
        (Control::Load(_), LoadControl::Pass) => return None,
    };
    (plain && radius.is_finite()).then(|| hertz.peak_pressure())
}

/// Whether both bodies are uniform along the rolling direction, apart from a slowly varying form.
fn roll_alike(case: &Case, bodies: &Bodies) -> bool {
    let both = [(&case.lower, &bodies.lower), (&case.upper, &bodies.upper)];
    both.into_iter().all(|(body, prepared)| has_smooth_form(body) || is_smooth(prepared))
}

/// Whether the heights of a body are those of a ball or a cylinder within a fiftieth. A surface from a file
/// may be one.
fn is_smooth(body: &MountedSurface) -> bool {
    /// Rms height of the roughness relative to the rms height about a plane.
    const ROUGH: f64 = 0.02;
    let rms = |level| body.topography.clone().level(level).map(|left| left.heights().std(0.0));
    match (rms(Level::Plane), rms(Level::Quadratic)) {
        (Ok(form), Ok(rough)) => rough <= ROUGH * form,
        // Too few cells for a form.
        _ => false,
    }
}

/// Whether a body consists of slowly varying forms.
fn has_smooth_form(body: &Body) -> bool {
    let smooth = |form: &Form| {
        matches!(
            form,
            Form::Sphere { .. }
                | Form::Ellipsoid { .. }
                | Form::Cylinder { .. }
                | Form::Cone { .. }
                | Form::Flat
        )
    };
    let TopographySpec { source, plus, .. } = &body.topography;
    matches!(source, Source::Form { form, .. } if smooth(form))
        && plus.iter().all(|layer| matches!(layer, Layer::Form { form, .. } if smooth(form)))
}

/// Whether one increment applies most of the load, or all of an approach.
fn loads_at_once(stages: &[Stage]) -> bool {
    let load = |stage: &Stage| match stage.loading.normal {
        Control::Load(load) => Some(load),
        Control::Approach(_) => None,
    };
    match stages.iter().map(load).collect::<Option<Vec<_>>>() {
        Some(loads) => {
            let before = std::iter::once(0.0).chain(loads.iter().copied());
            let steps =
                loads.iter().zip(before).zip(stages).map(|((to, from), s)| (to - from) / s.increments as f64);
            steps.fold(0.0, f64::max) > 0.5 * loads.iter().copied().fold(0.0, f64::max)
        }
        None => {
            let changes = |pair: &[Stage]| pair[1].loading.normal != pair[0].loading.normal;
            stages[0].increments == 1 && !stages.windows(2).any(changes)
        }
    }
}

/// Warns of a grid on which the waves that determine the slope have too few cells.
///
/// The slope of a wave of n cells by differences over one cell is larger by 1/cos(π/n) than over two.
fn coarse(name: &str, body: &MountedSurface, warnings: &mut Vec<String>) {
    /// Cells per wave below which the pitch is too coarse.
    const CELLS_PER_WAVE: f64 = 8.0;
    for axis in 0..2 {
        let [one, two] = [1, 2].map(|cells| difference(body.topography.heights(), axis, cells));
        if one > 0.0 && two > 0.0 && one > two {
            let cells = std::f64::consts::PI / (two / one).acos();
            if cells < CELLS_PER_WAVE {
                warnings.push(format!(
                    "the mesh is coarse for the {name} surface: along {} the waves that make its slope have about \
                     {cells:.1} cells, {CELLS_PER_WAVE} or more are needed for a contact area within some 10 %; take a smaller `pitch`, or take \
                     short waves out (`s_filter`)",
                    ["x", "y"][axis]
                ));
                return;
            }
        }
    }
}

/// Rms difference of heights `cells` apart, per cell of distance.
fn difference(heights: &Field, axis: usize, cells: usize) -> f64 {
    let n = heights.len_of(ndarray::Axis(axis));
    if n <= cells {
        return 0.0;
    }
    let far = heights.slice_axis(ndarray::Axis(axis), (cells..).into());
    let near = heights.slice_axis(ndarray::Axis(axis), (..n - cells).into());
    let [sum] = parallel::merged([far.nrows(), far.ncols()], |rows| {
        let squares = rows.map(|row| {
            let (far, near) = (far.row(row), near.row(row));
            let near = near.to_slice().expect("rows are contiguous");
            sums(far.to_slice().expect("rows are contiguous"), |cell, far| [(far - near[cell]).powi(2)])[0]
        });
        [squares.sum::<f64>()]
    });
    (sum / far.len() as f64).sqrt() / cells as f64
}

/// Warns of a surface with many heights that were missing.
fn filled(name: &str, body: &MountedSurface) -> Option<String> {
    /// Share of missing heights from which on the surface is doubtful.
    const MANY: f64 = 0.2;
    let missing = body.findings.undefined + body.findings.spikes;
    let share = missing as f64 / body.findings.samples as f64;
    (share >= MANY).then(|| {
        format!(
            "{} % of the heights of the {name} surface are missing, and were filled from the heights around them: where they touch, the contact is a \
             guess; measure again, or keep a `window` with fewer gaps",
            units::format_number(100.0 * share)
        )
    })
}

/// Warns of a tilted measured surface.
fn tilted(name: &str, body: &MountedSurface, warnings: &mut Vec<String>) {
    let without_plane = body.topography.clone().level(Level::Plane).expect("a plane has an order");
    let (as_is, levelled) = (body.topography.sq(), without_plane.sq());
    if as_is > 1.5 * levelled {
        warnings.push(format!(
            "the {name} surface is tilted: Sq is {}, without its plane {}; `level = \"plane\"` removes it",
            units::format(as_is, Dimension::Length),
            units::format(levelled, Dimension::Length)
        ));
    }
}

/// Warns of a surface that is discontinuous across its edges along an axis on which it `wraps`.
fn torn(name: &str, body: &MountedSurface, wraps: [bool; 2], warnings: &mut Vec<String>) {
    let heights = body.topography.heights();
    for axis in (0..2).filter(|axis| wraps[*axis]) {
        let n = heights.len_of(ndarray::Axis(axis));
        let (first, last) =
            (heights.index_axis(ndarray::Axis(axis), 0), heights.index_axis(ndarray::Axis(axis), n - 1));
        let sum: f64 = first.iter().zip(last).map(|(first, last)| (first - last).powi(2)).sum();
        let jump: Metre = (sum / first.len() as f64).sqrt();
        if jump > 3.0 * difference(heights, axis, 1) {
            warnings.push(format!(
                "the {name} surface is repeated, but its edges along {} do not meet: a step of {} rms; `taper` \
                 brings them together",
                ["x", "y"][axis],
                units::format(jump, Dimension::Length)
            ));
            return;
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::prepare::bodies;
    use asperity_base::Error;

    fn case(motion: &str, load: &str) -> Case {
        let body = |name: &str, columns: usize| {
            format!(
                "[{name}]\nyoung = 1e9\npoisson = 0.3\nhardness = 1e9\n[{name}.topography]\nform = \"sphere\"\n\
                 radius = 1\nshape = [{columns}, 4]\npitch = 1e-3\n"
            )
        };
        let text = format!("{}{}[contact]\n{load}\n{motion}", body("lower", 5), body("upper", 3));
        Case::parse(&text, "case.toml".as_ref(), "".as_ref()).unwrap()
    }

    #[test]
    fn every_position_of_a_pass_has_a_column_that_faces_another() {
        let columns = |stride| -> Vec<usize> {
            let case = case(&format!("[motion]\nstride = {stride}"), "load = 1");
            let grid = |columns| Grid::new([columns, 4], [1e-3; 2]).unwrap();
            positions(&case, [grid(5), grid(3)]).iter().map(|position| position.columns).collect()
        };
        assert_eq!(columns(1), [1, 2, 3, 3, 3, 2, 1]);
        assert_eq!(columns(2), [1, 3, 3, 1]);
        assert_eq!(columns(9), [3]);
    }

    #[test]
    fn the_mean_overlap_bounds_the_mean_load_of_a_pass_and_the_least_a_steady_one() {
        let estimate = |control: &str, load: &str| {
            let case = case(&format!("[motion]\ncontrol = \"{control}\""), load);
            super::estimate(&case, &bodies(&case, crate::SurfaceInput::default()).unwrap())
        };
        // A column of 4 mm² carries 4 kN; seven positions share 15 columns.
        let limit = estimate("pass-load", "load = 1").unwrap().plastic_limit;
        assert!((limit / (4e3 * 15.0 / 7.0) - 1.0).abs() < 1e-12, "{limit}");
        assert!(estimate("pass-load", "load = 8e3").is_ok());
        let beyond = estimate("step-load", "load = 8e3").unwrap_err();
        assert!(matches!(beyond, Error::BeyondPlasticLimit { limit, .. } if (limit - 4e3).abs() < 1e-6));
    }
}
