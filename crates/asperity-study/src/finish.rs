//! Shared beginning and end of every run.

use web_time::Instant;

use crate::case::Case;
use crate::closed_form::{ClosedForm, ClosedFormRecord, ElasticContact};
use crate::joined;
use crate::lubrication::lubrication;
use crate::prepare::Bodies;
use crate::results::Writer;
use crate::subsurface::SubsurfaceRecord;
use crate::summary::{Outcome, RunningIn, Summary};
use crate::viscoelastic;
use asperity_base::error::Result;
use asperity_base::units::Metre;
use asperity_contact::motion::{Pair, PlasticRecord, SweepRecord, UpdateRecord};
use asperity_contact::solver::{Control, Params};
use asperity_contact::with::{InterfaceNumbers, Observations};

/// Results of a run for its summary.
pub struct Computed {
    pub(super) outcome: Outcome,
    pub(super) subsurface: Vec<SubsurfaceRecord>,
    /// The last update of a contact that slides in place.
    pub(super) sliding: Option<UpdateRecord>,
    /// The plastic flow of a motion of elasto-plastic bodies.
    pub(super) plasticity: Option<PlasticRecord>,
    /// The interface of the bodies in numbers.
    pub(super) interface: InterfaceNumbers,
    /// The closed form of the contact of smooth forms.
    pub(super) closed_form: Option<ClosedFormRecord>,
    /// The rows of the capabilities.
    pub(super) found: Observations,
}

impl Computed {
    /// Adds the closed form of the contact.
    pub fn with_closed_form(self, closed_form: Option<ClosedFormRecord>) -> Self {
        Self { closed_form, ..self }
    }

    /// Creates results with an outcome and nothing else.
    pub fn from_outcome(outcome: Outcome) -> Self {
        Self {
            outcome,
            subsurface: Vec::new(),
            sliding: None,
            plasticity: None,
            interface: InterfaceNumbers::default(),
            closed_form: None,
            found: Observations::default(),
        }
    }
}

/// Writes the results at the end of every run.
pub fn conclude(
    case: &Case,
    writer: &Writer,
    began: Instant,
    Computed { outcome, subsurface, sliding, plasticity, interface, closed_form, found }: Computed,
    mut warnings: Vec<String>,
) -> Result<Summary> {
    outcome.check()?;
    warnings.extend(writer.warning().map(str::to_owned));
    if case.output.paraview {
        writer.write_for_paraview()?;
    }
    let running_in = match &outcome {
        Outcome::Passes(passes) => RunningIn::from_passes(passes),
        Outcome::Static(_) | Outcome::Sweep(_) => None,
    };
    let summary = Summary {
        running_in,
        sliding,
        plasticity,
        interface,
        closed_form,
        version: env!("CARGO_PKG_VERSION").to_owned(),
        case: writer.case().clone(),
        outcome,
        subsurface,
        found,
        warnings,
        wall_time_s: began.elapsed().as_secs_f64(),
    };
    joined::write(writer.results(), &summary)?;
    writer.finish(&summary)?;
    Ok(summary)
}

/// Returns the closed form beside the computed contact of `case` on a grid of this extent, for a sweep at its
/// last point. `None` if there is none, or if cells have yielded or worn, which no closed form here
/// describes.
pub fn closed_form(case: &Case, extent: [Metre; 2], outcome: &Outcome) -> Option<ClosedFormRecord> {
    let computed: ElasticContact = match outcome {
        Outcome::Static(record) => {
            let yields = record.plastic.as_ref().is_some_and(|plastic| plastic.max_plastic_strain > 0.0);
            (record.plastic_cells == 0 && !yields).then(|| (&**record).into())
        }
        Outcome::Sweep(points) => {
            let yields =
                |point: &SweepRecord| point.plastic.is_some_and(|flow| flow.max_plastic_strain > 0.0);
            points.last().filter(|point| point.plastic_area == 0.0 && !yields(point)).map(Into::into)
        }
        Outcome::Passes(_) => None,
    }?;
    let is_plain = case.sliding.is_none() && !case.relaxes() && case.interface.is_empty() && !case.runs_in();
    let form = ClosedForm::from_case(case, extent, Control::Load(computed.load)).filter(|_| is_plain)?;
    Some(form.beside(computed))
}

/// Creates the pair of the `bodies` of `case`.
pub(super) fn pair(case: &Case, bodies: Bodies) -> Result<Pair> {
    let Bodies { lower, upper, master_curves } = bodies;
    let materials = [&case.lower.material, &case.upper.material];
    let pair = Pair::new(lower.topography, upper.topography, materials)?
        .with_hardness([lower.hardness, upper.hardness])?;
    let interface = case.interface.between(&pair.lower_grid(), pair.modulus())?;
    let pair = pair.with_interface(interface).with_lubrication(lubrication(case)?);
    viscoelastic::relax(case, pair, &master_curves)
}

/// Returns the solver parameters of `case`.
pub fn params(case: &Case) -> Params {
    let super::case::Contact { method, device, tolerance, .. } = case.contact;
    Params::new().with_method(method).with_device(device).with_tolerance(tolerance)
}
