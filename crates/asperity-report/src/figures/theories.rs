//! Theories of random surfaces beside a sweep of rough bodies, from the moments of the undeformed gap alone.

use asperity_contact::joint::{GapRoughness, JointLaw};
use asperity_contact::material::composite_modulus;
use asperity_contact::motion::SweepRecord;
use asperity_contact::operator::Boundary;
use asperity_contact::reference::rough::{PERSSON_DECAY, bgt_area_fraction, persson_area_fraction};
use asperity_contact::with::Listed as _;
use asperity_study::Results;
use asperity_study::case::{Body, Case, Layer, Source};
use asperity_surface::Form;

/// The moments of the gap, and the composite modulus.
pub(crate) struct Theories {
    roughness: GapRoughness,
    modulus: f64,
}

/// A theory of a column of a sweep: its name, and its value at a point.
type Theory = (&'static str, fn(&Theories, &SweepRecord) -> f64);

impl Theories {
    /// Returns the theories of rough elastic half-spaces that repeat along both axes; `None` for other bodies, whose surfaces
    /// are not read, and of those whose surfaces cannot be read. The table `[joint]` has theories of its own.
    pub(crate) fn of(results: &Results, case: &Case, points: &[SweepRecord]) -> Option<Self> {
        let bodies = [&case.lower, &case.upper];
        let are_rough = bodies.into_iter().any(is_rough)
            && bodies.into_iter().all(|body| is_rough(body) || is_flat(body));
        let yields = points.iter().any(|point| point.plastic_area > 0.0) || case.plasticity.is_some();
        let moves = points.iter().any(|point| point.speed.is_some());
        let is_plain = case.interface.is_empty() && !case.is_coated() && !yields && !moves;
        let repeats = case.contact.boundary == Boundary::PERIODIC;
        if !(are_rough && is_plain && repeats && JointLaw::of(&case.with).is_none()) {
            return None;
        }
        let [lower, upper] = results.static_surfaces().ok()?;
        if lower.grid().shape != upper.grid().shape {
            return None;
        }
        let roughness = GapRoughness::new(lower.grid(), &-(lower.heights() + upper.heights())).ok()?;
        let modulus = composite_modulus(&case.lower.material, &case.upper.material).ok()?;
        (roughness.rms_height() > 0.0).then_some(Self { roughness, modulus })
    }

    /// Returns name and value at `point` of each theory of a column.
    pub(super) fn beside(&self, column: &str, point: &SweepRecord) -> Vec<(&'static str, f64)> {
        let theories: &[Theory] = match column {
            "contact_area" => &[
                ("Persson", |of, p| area(p) * of.fraction(persson_area_fraction, p)),
                ("Bush, Gibson, Thomas", |of, p| area(p) * of.fraction(bgt_area_fraction, p)),
            ],
            "stiffness" => &[("Persson", |of, p| p.load / (PERSSON_DECAY * of.roughness.rms_height()))],
            _ => &[],
        };
        theories.iter().map(|(name, value)| (*name, value(self, point))).collect()
    }

    /// Contact fraction by a theory of mean pressure, modulus and slope; NaN beyond the whole area.
    fn fraction(&self, theory: fn(f64, f64, f64) -> f64, point: &SweepRecord) -> f64 {
        let fraction = theory(point.mean_pressure, self.modulus, self.roughness.rms_slope());
        if fraction < 1.0 { fraction } else { f64::NAN }
    }
}

/// Apparent area.
fn area(point: &SweepRecord) -> f64 {
    point.load / point.mean_pressure
}

/// Whether all of a surface is measured or generated.
fn is_rough(body: &Body) -> bool {
    let is_form = |layer: &Layer| matches!(layer, Layer::Form { .. });
    !matches!(body.topography.source, Source::Form { .. }) && !body.topography.plus.iter().any(is_form)
}

fn is_flat(body: &Body) -> bool {
    matches!(body.topography.source, Source::Form { form: Form::Flat, .. }) && body.topography.plus.is_empty()
}
