//! Viscoelastic bodies of a case: their relaxation, and what a check says of their sliding and loading.

use crate::case::{Body, Case, StageSpec};
use crate::master_curve::MasterCurve;
use asperity_base::error::{Error, Result};
use asperity_base::units::{self, Dimension, Kelvin, Metre, MetrePerSecond, Pascal, Second};
use asperity_contact::motion::{MovingBody, Pair};
use asperity_contact::operator::Boundary;
use asperity_contact::viscoelastic::{Creep, MasterFit, MasterPoint, Relaxation};
use asperity_contact::with;
use asperity_contact::with::viscoelastic::Steady;
use asperity_surface::Topography;

/// Fewest steps of a stage in time with which its load and area are within some per cent.
const STEPS: usize = 8;
/// Storage modulus at the first frequency of a master curve over the relaxed modulus from which on it has not
/// relaxed there.
const FALLEN: f64 = 1.2;
/// Largest error of a fit that is not told.
const POOR: f64 = 0.15;
/// The relaxation of a body, with the fit of a master curve.
type BodyRelaxation = (Relaxation, Option<MasterFit>);

/// Returns the relaxation of each body of a case, `None` for an elastic one.
///
/// # Errors
/// [`Error::Case`] at the table of the body.
pub(super) fn relaxations(
    case: &Case,
    curves: &[Option<MasterCurve>; 2],
) -> Result<[Option<BodyRelaxation>; 2]> {
    let of = |index: usize, name: &str, body: &Body| {
        let Some(viscoelastic) = &body.properties.viscoelastic else { return Ok(None) };
        let temperature = temperature(case, index);
        let curve = curves[index].as_ref().map(|curve| &curve.points[..]);
        let found = viscoelastic.relaxation(body.material.young, temperature, curve);
        found.map(Some).map_err(|source| at(case, name, &source))
    };
    Ok([of(0, "lower", &case.lower)?, of(1, "upper", &case.upper)?])
}

/// Returns the temperature of a body, lower one first, if it is known.
fn temperature(case: &Case, index: usize) -> Option<Kelvin> {
    case.temperature.map(|temperature| temperature.bulk[index])
}

/// Returns an error of a fit at the key that it concerns.
fn at(case: &Case, name: &str, source: &Error) -> Error {
    let key = match source {
        Error::OutOfRange { quantity: "young", .. } => format!("{name}.young"),
        Error::OutOfRange { quantity: "terms_per_decade", .. } => {
            format!("{name}.viscoelastic.terms_per_decade")
        }
        Error::OutOfRange { quantity: "bulk", .. } => "temperature.bulk".to_owned(),
        _ => format!("{name}.viscoelastic.file"),
    };
    case.error_at(&key, source.to_string(), source.hint())
}

/// Makes the bodies of a `pair` viscoelastic, as their case says.
///
/// # Errors
/// The errors of [`relaxations`].
pub(super) fn relax(case: &Case, pair: Pair, curves: &[Option<MasterCurve>; 2]) -> Result<Pair> {
    let [lower, upper] = relaxations(case, curves)?;
    if lower.is_none() && upper.is_none() {
        return Ok(pair);
    }
    let materials = [&case.lower.material, &case.upper.material];
    pair.with_relaxation(materials, [lower, upper].map(|body| body.map(|(relaxation, _)| relaxation)))
}

/// Viscoelastic bodies, their steady sliding and their history before anything is solved.
#[derive(Debug, Clone, Default, PartialEq)]
#[non_exhaustive]
pub struct ViscoelasticEstimate {
    /// A line for each viscoelastic body: its moduli and times, and the fit of its master curve.
    pub bodies: Vec<String>,
    /// Reasons to doubt the answer.
    pub warnings: Vec<String>,
    /// The shortest relaxation time and the longest retardation time of both bodies.
    pub times: [Second; 2],
    /// The largest ratio of the modulus of a fast body to its relaxed modulus.
    pub stiffening: f64,
}

/// Examines the viscoelastic bodies of a case, their steady sliding and their history; `None` without such
/// bodies.
///
/// # Errors
/// [`Error::Case`] if both bodies are rough along x, and the errors of the fits.
pub(super) fn estimate(
    case: &Case,
    bodies: [&Topography; 2],
    curves: &[Option<MasterCurve>; 2],
) -> Result<Option<ViscoelasticEstimate>> {
    if !case.relaxes() {
        return Ok(None);
    }
    let relaxations = relaxations(case, curves)?;
    let found = || relaxations.iter().flatten().map(|(relaxation, _)| relaxation);
    let shortest = found().flat_map(Relaxation::terms).map(|term| term.time).fold(f64::INFINITY, f64::min);
    let longest = found().flat_map(|body| body.creep().terms).map(|term| term.time).fold(0.0, f64::max);
    let stiffening = found().map(|body| body.glassy() / body.relaxed()).fold(1.0, f64::max);
    let mut estimate =
        ViscoelasticEstimate { times: [shortest, longest], stiffening, ..ViscoelasticEstimate::default() };
    for (index, (name, body)) in [("lower", &case.lower), ("upper", &case.upper)].into_iter().enumerate() {
        estimate.bodies.extend(relaxations[index].as_ref().map(|found| described(name, found)));
        let doubt =
            body.properties.viscoelastic.as_ref().and_then(|body| body.doubt(name, temperature(case, index)));
        let fit = relaxations[index].as_ref().and_then(|(_, fit)| fit.as_ref());
        estimate.warnings.extend(curves[index].as_ref().and_then(|curve| converted(name, curve)));
        estimate.warnings.extend(doubt.into_iter().chain(fit.and_then(|fit| poor(name, fit))));
    }
    estimate.warnings.extend(case.history.iter().flat_map(coarse));
    if let Some(steady) = &case.steady {
        estimate.warnings.extend(of_steady(case, steady, bodies, &relaxations, curves)?);
    }
    if let Some(motion) = case.motion(1.0) {
        let step = motion.stride as f64 * bodies[0].grid().pitch[0];
        let speed = motion.sliding_speed();
        for index in [0, 1].into_iter().filter(|index| relaxations[*index].is_some() && speed > 0.0) {
            // Waves along y do not matter: bodies that pass over each other come apart from everywhere.
            let passed = Passed { boundary: Boundary::FREE, step, speeds: &[speed] };
            estimate.warnings.extend(doubts(case, index, &passed, bodies, &relaxations, curves)?);
        }
    }
    Ok(Some(estimate))
}

/// Returns reasons not to trust a stage that takes its time in few steps.
fn coarse(stage: &StageSpec) -> impl Iterator<Item = String> {
    let steps = stage.steps();
    let times = [("duration", stage.duration), ("dwell", stage.dwell), ("period", stage.period)];
    times.into_iter().filter(move |_| steps < STEPS).filter_map(move |(key, time)| {
        Some(format!(
            "a `{key}` of {} is computed in {}: in a step the displacement of every cell changes evenly, and with fewer than {STEPS} steps \
             load, area and pressures may be far off; give the stage more `increments`",
            units::format(time?, Dimension::Time),
            if steps == 1 { "a single step".to_owned() } else { format!("{steps} steps") }
        ))
    })
}

/// How a contact passes over a body.
struct Passed<'a> {
    boundary: Boundary,
    /// Length of the steps that resolve it.
    step: Metre,
    speeds: &'a [MetrePerSecond],
}

/// Returns reasons not to trust the steady sliding of a case.
///
/// # Errors
/// [`Error::Case`] if both bodies are rough along x.
fn of_steady(
    case: &Case,
    steady: &Steady,
    bodies: [&Topography; 2],
    relaxations: &[Option<BodyRelaxation>; 2],
    curves: &[Option<MasterCurve>; 2],
) -> Result<Vec<String>> {
    let grid = bodies[0].grid();
    let heights = bodies.map(Topography::heights);
    let creeps = relaxations.each_ref().map(Option::is_some);
    let moving = MovingBody::from_heights(heights, grid.pitch, creeps).map_err(|source| {
        let hint = "give one body heights that do not change along x, such as `form = \"flat\"`".to_owned();
        case.error_at("steady", source.to_string(), Some(hint))
    })?;
    let index = if moving == MovingBody::Lower { 0 } else { 1 };
    let passed = Passed { boundary: case.contact.boundary, step: grid.pitch[0], speeds: &steady.all() };
    doubts(case, index, &passed, bodies, relaxations, curves)
}

/// Returns reasons not to trust the contact that passes over a body, 0 for the lower one.
fn doubts(
    case: &Case,
    index: usize,
    passed: &Passed<'_>,
    bodies: [&Topography; 2],
    relaxations: &[Option<BodyRelaxation>; 2],
    curves: &[Option<MasterCurve>; 2],
) -> Result<Vec<String>> {
    let (name, body) = [("lower", &case.lower), ("upper", &case.upper)][index];
    let creep = match &relaxations[index] {
        Some((relaxation, _)) => relaxation.creep(),
        None => Creep::elastic(1.0),
    };
    let Passed { boundary, step, speeds } = *passed;
    let mut doubts =
        with::viscoelastic::doubts(&creep, boundary, step, bodies[index].grid().extent()[0], speeds);
    if let (Some(curve), Some(viscoelastic)) = (&curves[index], &body.properties.viscoelastic) {
        let factor = viscoelastic.shift_factor(temperature(case, index))?;
        doubts.extend(beyond(name, curve, factor, body.material.young, bodies[1 - index], speeds));
    }
    Ok(doubts)
}

/// Returns reasons not to trust a master curve, whose times are multiplied by a `factor`, at the frequencies
/// at which a `rough` body passes.
fn beyond(
    name: &str,
    MasterCurve { points, .. }: &MasterCurve,
    factor: f64,
    young: Pascal,
    rough: &Topography,
    speeds: &[MetrePerSecond],
) -> Vec<String> {
    let (Some(first), Some(last), true) = (points.first(), points.last(), rough.sdq() > 0.0) else {
        return Vec::new();
    };
    let wave = std::f64::consts::TAU * rough.sq() / rough.sdq();
    let told = |speed: MetrePerSecond, end: &MasterPoint, verb: &str| {
        format!(
            "at {} the waves of the roughness, about {} long, deform the {name} body at {} Hz, and its master curve {verb} at {} Hz: the fit \
             beyond it is a guess",
            units::format(speed, Dimension::Speed),
            units::format(wave, Dimension::Length),
            units::format_number(speed / wave),
            units::format_number(end.frequency / factor)
        )
    };
    let slowest = speeds.iter().copied().fold(f64::INFINITY, f64::min);
    let fastest = speeds.iter().copied().fold(0.0, f64::max);
    // Below the curve the modulus can only fall to the relaxed one.
    let begins = slowest / wave < first.frequency / factor && first.storage > FALLEN * young;
    let ends = fastest / wave > last.frequency / factor;
    let begins = begins.then(|| told(slowest, first, "begins"));
    begins.into_iter().chain(ends.then(|| told(fastest, last, "ends"))).collect()
}

/// Returns how the shear moduli of the master curve of the body `name` became moduli of tension.
fn converted(name: &str, curve: &MasterCurve) -> Option<String> {
    let factor = units::format_number(curve.from_shear?);
    Some(format!(
        "the master curve of the {name} body has the shear moduli G′ and G″: they are multiplied by E/G = 2 (1 + ν) = {factor}"
    ))
}

/// Returns a reason not to trust a fit to the master curve of the body `name`.
fn poor(name: &str, fit: &MasterFit) -> Option<String> {
    let worst = fit.errors[0].max(fit.errors[1]);
    (worst > POOR).then(|| {
        format!(
            "the fit to the master curve of the {name} body is off by up to {} %: more `terms_per_decade` help, or a `young` that is what the \
             storage modulus falls to",
            units::format_number(100.0 * worst)
        )
    })
}

/// Describes a viscoelastic body.
fn described(name: &str, (relaxation, fit): &BodyRelaxation) -> String {
    let pressure = |value| units::format(value, Dimension::Pressure);
    let time = |value| units::format(value, Dimension::Time);
    let terms = relaxation.terms();
    let times = match terms {
        [only] => format!("in {}", time(only.time)),
        several => format!(
            "in {} times from {} to {}",
            several.len(),
            time(several[several.len() - 1].time),
            time(several[0].time)
        ),
    };
    let moduli = format!(
        "the {name} body relaxes from {} to {} {times}",
        pressure(relaxation.glassy()),
        pressure(relaxation.relaxed())
    );
    match fit {
        None => moduli,
        Some(fit) => {
            let [storage, loss] = fit.errors.map(|error| units::format_number(100.0 * error));
            format!("{moduli}, fitted to its master curve within {storage} % (storage) and {loss} % (loss)")
        }
    }
}
