//! Viscoelastic bodies of a case: their relaxation, and what a check says of their sliding and loading.

use crate::case::{Case, Part, StageSpec};
use crate::master_curve::MasterCurve;
use asperity_base::error::{Error, Result};
use asperity_base::units::{self, Dimension, Kelvin, Metre, MetrePerSecond, Pascal, Second};
use asperity_contact::motion::{MovingBody, Pair};
use asperity_contact::operator::Boundary;
use asperity_contact::viscoelastic::{BodyRelaxation, Creep, MasterFit, MasterPoint, Relaxation};
use asperity_contact::with;
use asperity_contact::with::viscoelastic::{Steady, Viscoelasticity};
use asperity_surface::Topography;

/// Fewest steps of a stage in time with which its load and area are within some per cent.
const STEPS: usize = 8;
/// Storage modulus at the first frequency of a master curve over the relaxed modulus from which on it has not
/// relaxed there.
const FALLEN: f64 = 1.2;
/// Largest error of a fit that is not told.
const POOR: f64 = 0.15;

/// A viscoelastic body or layer.
struct RelaxingPart<'a> {
    /// Its name: "lower body", "2nd layer of the lower body".
    name: String,
    part: Part<'a>,
    viscoelastic: &'a Viscoelasticity,
    curve: Option<&'a MasterCurve>,
    temperature: Option<Kelvin>,
    relaxation: Relaxation,
    /// The fit of its master curve.
    fit: Option<MasterFit>,
}

/// Returns the viscoelastic parts of each body of a case: its layers from the surface down, then the body below them.
///
/// # Errors
/// [`Error::Case`] at the table of the part.
fn relaxing_parts<'a>(
    case: &'a Case,
    curves: &'a [Vec<Option<MasterCurve>>; 2],
) -> Result<[Vec<RelaxingPart<'a>>; 2]> {
    let of = |index: usize| {
        let (body, name) = [(&case.lower, "lower"), (&case.upper, "upper")][index];
        let temperature = case.temperature.map(|temperature| temperature.bulk[index]);
        let parts = body.parts().zip(&curves[index]).filter_map(|(part, curve)| {
            let (viscoelastic, curve) = (part.viscoelastic?, curve.as_ref());
            let points = curve.map(|curve| &curve.points[..]);
            let found = viscoelastic.relaxation(part.young, temperature, points);
            let found = found.map_err(|source| at(case, &case.table_of(name, part.layer), &source));
            let name = match part.layer {
                None => format!("{name} body"),
                Some(_) if body.material.layers.len() == 1 => format!("coating of the {name} body"),
                Some(n) => format!("{} layer of the {name} body", with::ordinal(n + 1)),
            };
            let part = |(relaxation, fit)| RelaxingPart {
                name,
                part,
                viscoelastic,
                curve,
                temperature,
                relaxation,
                fit,
            };
            Some(found.map(part))
        });
        parts.collect::<Result<Vec<_>>>()
    };
    Ok([of(0)?, of(1)?])
}

/// Returns an error of a fit at the key that it concerns, of a part in this `table`.
fn at(case: &Case, table: &str, source: &Error) -> Error {
    let key = match source {
        Error::OutOfRange { quantity: "young", .. } => format!("{table}.young"),
        Error::OutOfRange { quantity: "terms_per_decade", .. } => {
            format!("{table}.viscoelastic.terms_per_decade")
        }
        Error::OutOfRange { quantity: "bulk", .. } => "temperature.bulk".to_owned(),
        _ => format!("{table}.viscoelastic.file"),
    };
    case.error_at(&key, source.to_string(), source.hint())
}

/// Makes the bodies of a `pair` viscoelastic, as their case says.
///
/// # Errors
/// The errors of [`relaxing_parts`].
pub(super) fn relax(case: &Case, pair: Pair, curves: &[Vec<Option<MasterCurve>>; 2]) -> Result<Pair> {
    let materials = [&case.lower.material, &case.upper.material];
    let relaxations = relaxing_parts(case, curves)?;
    let of = |body: usize| {
        let mut relaxation = BodyRelaxation { body: None, layers: vec![None; materials[body].layers.len()] };
        for part in &relaxations[body] {
            let place = part.part.layer.map_or(&mut relaxation.body, |n| &mut relaxation.layers[n]);
            *place = Some(part.relaxation.clone());
        }
        relaxation
    };
    pair.with_relaxation(materials, [of(0), of(1)])
}

/// Viscoelastic bodies, their steady sliding and their history before anything is solved.
#[derive(Debug, Clone, Default, PartialEq)]
#[non_exhaustive]
pub struct ViscoelasticEstimate {
    /// A line for each viscoelastic body or layer: its moduli and times, and the fit of its master curve.
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
    curves: &[Vec<Option<MasterCurve>>; 2],
) -> Result<Option<ViscoelasticEstimate>> {
    if !case.relaxes() {
        return Ok(None);
    }
    let parts = relaxing_parts(case, curves)?;
    let found = || parts.iter().flatten().map(|part| &part.relaxation);
    let shortest = found().flat_map(Relaxation::terms).map(|term| term.time).fold(f64::INFINITY, f64::min);
    let longest = found().flat_map(|body| body.creep().terms).map(|term| term.time).fold(0.0, f64::max);
    let stiffening = found().map(|body| body.glassy() / body.relaxed()).fold(1.0, f64::max);
    let mut estimate =
        ViscoelasticEstimate { times: [shortest, longest], stiffening, ..ViscoelasticEstimate::default() };
    for part in parts.iter().flatten() {
        estimate.bodies.push(part.described());
        estimate.warnings.extend(part.converted());
        estimate.warnings.extend(part.viscoelastic.doubt(&part.name, part.temperature));
        estimate.warnings.extend(part.poor());
    }
    estimate.warnings.extend(case.history.iter().flat_map(coarse));
    if let Some(steady) = &case.steady {
        estimate.warnings.extend(of_steady(case, steady, bodies, &parts)?);
    }
    if let Some(motion) = case.motion(1.0) {
        let step = motion.stride as f64 * bodies[0].grid().pitch[0];
        let speed = motion.sliding_speed();
        for index in [0, 1].into_iter().filter(|index| !parts[*index].is_empty() && speed > 0.0) {
            // Waves along y do not matter: bodies that pass over each other come apart from everywhere.
            let passed = Passed { boundary: Boundary::FREE, step, speeds: &[speed] };
            estimate.warnings.extend(doubts(index, &passed, bodies, &parts[index])?);
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
    parts: &[Vec<RelaxingPart<'_>>; 2],
) -> Result<Vec<String>> {
    let grid = bodies[0].grid();
    let heights = bodies.map(Topography::heights);
    let creeps = parts.each_ref().map(|parts| !parts.is_empty());
    let moving = MovingBody::from_heights(heights, grid.pitch, creeps).map_err(|source| {
        let hint = "give one body heights that do not change along x, such as `form = \"flat\"`".to_owned();
        case.error_at("steady", source.to_string(), Some(hint))
    })?;
    let index = if moving == MovingBody::Lower { 0 } else { 1 };
    let passed = Passed { boundary: case.contact.boundary, step: grid.pitch[0], speeds: &steady.all() };
    doubts(index, &passed, bodies, &parts[index])
}

/// Returns reasons not to trust the contact that passes over a body, 0 for the lower one, with these viscoelastic `parts`.
fn doubts(
    index: usize,
    passed: &Passed<'_>,
    bodies: [&Topography; 2],
    parts: &[RelaxingPart<'_>],
) -> Result<Vec<String>> {
    let Passed { boundary, step, speeds } = *passed;
    let extent = bodies[index].grid().extent()[0];
    let of_creep = |creep: &Creep| with::viscoelastic::doubts(creep, boundary, step, extent, speeds);
    if parts.is_empty() {
        return Ok(of_creep(&Creep::elastic(1.0)));
    }
    let mut doubts = Vec::new();
    for part in parts {
        let of_part = of_creep(&part.relaxation.creep()).into_iter();
        // Only a body without layers needs no name.
        let is_alone = parts.len() == 1 && part.part.layer.is_none();
        doubts.extend(of_part.map(|doubt| if is_alone { doubt } else { format!("{}: {doubt}", part.name) }));
        if let Some(curve) = part.curve {
            let factor = part.viscoelastic.shift_factor(part.temperature)?;
            doubts.extend(beyond(&part.name, curve, factor, part.part.young, bodies[1 - index], speeds));
        }
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
            "at {} the waves of the roughness, about {} long, deform the {name} at {} Hz, and its master curve {verb} at {} Hz: the fit \
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

impl RelaxingPart<'_> {
    /// Returns how the shear moduli of the master curve became moduli of tension.
    fn converted(&self) -> Option<String> {
        let factor = units::format_number(self.curve?.from_shear?);
        Some(format!(
            "the master curve of the {} has the shear moduli G′ and G″: they are multiplied by E/G = 2 (1 + ν) = {factor}",
            self.name
        ))
    }

    /// Returns a reason not to trust the fit to the master curve.
    fn poor(&self) -> Option<String> {
        let fit = self.fit.as_ref()?;
        let worst = fit.errors[0].max(fit.errors[1]);
        (worst > POOR).then(|| {
            format!(
                "the fit to the master curve of the {} is off by up to {} %: more `terms_per_decade` help, or a `young` that is what the \
                 storage modulus falls to",
                self.name,
                units::format_number(100.0 * worst)
            )
        })
    }

    /// Describes the body or layer.
    fn described(&self) -> String {
        let pressure = |value| units::format(value, Dimension::Pressure);
        let time = |value| units::format(value, Dimension::Time);
        let times = match self.relaxation.terms() {
            [only] => format!("in {}", time(only.time)),
            several => format!(
                "in {} times from {} to {}",
                several.len(),
                time(several[several.len() - 1].time),
                time(several[0].time)
            ),
        };
        let moduli = format!(
            "the {} relaxes from {} to {} {times}",
            self.name,
            pressure(self.relaxation.glassy()),
            pressure(self.relaxation.relaxed())
        );
        match &self.fit {
            None => moduli,
            Some(fit) => {
                let [storage, loss] = fit.errors.map(|error| units::format_number(100.0 * error));
                format!(
                    "{moduli}, fitted to its master curve within {storage} % (storage) and {loss} % (loss)"
                )
            }
        }
    }
}
