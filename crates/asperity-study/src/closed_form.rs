//! The closed form of a contact between two smooth forms, beside which the computed contact stands.

use serde::{Deserialize, Serialize};

use super::case::{Case, Source};
use asperity_base::record::columns;
use asperity_base::units::{Metre, Newton, Pascal, SquareMetre};
use asperity_contact::material::composite_modulus;
use asperity_contact::motion::{StaticRecord, SweepRecord};
use asperity_contact::operator::Boundary;
use asperity_contact::reference::{Cone, HertzEllipse, HertzLine};
use asperity_contact::solver::Control;
use asperity_surface::{Axis, Form, Preparation};

/// Theory of a closed form.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize, Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Theory {
    /// Hertz' point contact of two paraboloids.
    HertzPoint,
    /// Hertz' line contact of parabolic cylinders, in plane strain.
    HertzLine,
    /// Sneddon's contact of a cone and a flat body.
    SneddonCone,
}

impl std::fmt::Display for Theory {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        f.write_str(match self {
            Self::HertzPoint => "Hertz",
            Self::HertzLine => "Hertz (line)",
            Self::SneddonCone => "Sneddon",
        })
    }
}

/// Closed form of the elastic contact of two smooth forms without friction.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct ClosedForm {
    /// The theory.
    pub theory: Theory,
    /// Load at which it is evaluated.
    pub load: Newton,
    /// Half widths of the contact along x and y; along a line contact, half the length of the grid.
    pub half_widths: [Metre; 2],
    /// Contact area.
    pub contact_area: SquareMetre,
    /// Largest pressure; `None` if it is unbounded, under the tip of a cone.
    pub max_pressure: Option<Pascal>,
    /// Approach; `None` for a line contact, whose approach depends on where it is measured.
    pub approach: Option<Metre>,
}

columns! {
    /// Closed form of the contact of two smooth forms, and the deviation of the computed contact from it:
    /// `closed_form` in `summary.json`.
    #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
    #[non_exhaustive]
    pub struct ClosedFormRecord {
        /// Theory: `hertz-point`, `hertz-line` or `sneddon-cone`.
        pub theory: Theory,
        /// Half widths of the contact along x and y by the theory; along a line contact, half the length of
        /// the grid.
        pub theory_half_widths: [Metre; 2],
        /// Contact area by the theory.
        pub theory_contact_area: SquareMetre,
        /// Largest pressure by the theory; `null` for a cone, whose tip has an unbounded pressure.
        pub theory_max_pressure: Option<Pascal>,
        /// Approach by the theory; `null` for a line contact.
        pub theory_approach: Option<Metre>,
        /// Computed contact area over that of the theory, less 1.
        pub contact_area_deviation: f64,
        /// Computed largest pressure over that of the theory, less 1.
        pub max_pressure_deviation: Option<f64>,
        /// Computed approach over that of the theory, less 1.
        pub approach_deviation: Option<f64>,
    }
}

/// The numbers of a computed contact that a closed form also has.
pub(super) struct ElasticContact {
    pub(super) load: Newton,
    contact_area: SquareMetre,
    max_pressure: Pascal,
    approach: Metre,
}

impl From<&StaticRecord> for ElasticContact {
    fn from(record: &StaticRecord) -> Self {
        let StaticRecord { load, contact_area, max_pressure, approach, .. } = *record;
        Self { load, contact_area, max_pressure, approach }
    }
}

impl From<&SweepRecord> for ElasticContact {
    fn from(record: &SweepRecord) -> Self {
        let SweepRecord { load, contact_area, max_pressure, approach, .. } = *record;
        Self { load, contact_area, max_pressure, approach }
    }
}

impl ClosedForm {
    /// Returns the closed form of a static contact of `case` on a grid of this extent, under `control`.
    ///
    /// `None` if there is none: for bodies that are not both bare forms (flat, sphere, ellipsoid, cylinder,
    /// cone), for coated bodies, for boundaries that the theory does not have, and if nothing presses.
    pub fn from_case(case: &Case, extent: [Metre; 2], control: Control) -> Option<Self> {
        if case.motion.is_some() || case.is_coated() {
            return None;
        }
        let modulus = composite_modulus(&case.lower.material, &case.upper.material).ok()?;
        let shape = Shape::of(case)?;
        let boundary = case.contact.boundary;
        let form = match shape {
            Shape::Cone(slope) if boundary == Boundary::FREE => cone(slope, modulus, control),
            Shape::Curved([x, y]) if x > 0.0 && y > 0.0 && boundary == Boundary::FREE => {
                point([x.recip(), y.recip()], modulus, control)
            }
            Shape::Curved([x, y]) if (x > 0.0) != (y > 0.0) => {
                // Axis across the line.
                let across = usize::from(x == 0.0);
                let fits = !boundary.repeats(across) && boundary.repeats(1 - across);
                let radius = [x, y][across].recip();
                line(radius, across, extent, modulus, control).filter(|_| fits)
            }
            _ => None,
        }?;
        (form.load > 0.0 && form.load.is_finite()).then_some(form)
    }

    /// Returns the record of the closed form beside the `computed` contact, whose load it has.
    pub(super) fn beside(&self, computed: ElasticContact) -> ClosedFormRecord {
        ClosedFormRecord {
            theory: self.theory,
            theory_half_widths: self.half_widths,
            theory_contact_area: self.contact_area,
            theory_max_pressure: self.max_pressure,
            theory_approach: self.approach,
            contact_area_deviation: computed.contact_area / self.contact_area - 1.0,
            max_pressure_deviation: self.max_pressure.map(|pressure| computed.max_pressure / pressure - 1.0),
            approach_deviation: self.approach.map(|approach| computed.approach / approach - 1.0),
        }
    }
}

/// The gap between two forms.
enum Shape {
    /// A paraboloid, by its curvatures along x and y, 1/m.
    Curved([f64; 2]),
    /// A cone, by its slope.
    Cone(f64),
}

impl Shape {
    /// Returns the shape of the gap; `None` unless both bodies are bare forms of a closed form.
    fn of(case: &Case) -> Option<Self> {
        let forms = [&case.lower, &case.upper].map(|body| {
            let spec = &body.topography;
            match spec.source {
                Source::Form { form, .. }
                    if spec.plus.is_empty() && spec.preparation == Preparation::default() =>
                {
                    Some(form)
                }
                _ => None,
            }
        });
        match forms {
            [Some(Form::Flat), Some(Form::Cone { angle })]
            | [Some(Form::Cone { angle }), Some(Form::Flat)] => Some(Self::Cone(angle.tan())),
            [Some(lower), Some(upper)] => {
                let ([x, y], [more_x, more_y]) = (curvatures(lower)?, curvatures(upper)?);
                Some(Self::Curved([x + more_x, y + more_y]))
            }
            _ => None,
        }
    }
}

/// Returns the curvatures of a form along x and y, 1/m; `None` for a form that is no paraboloid.
fn curvatures(form: Form) -> Option<[f64; 2]> {
    match form {
        Form::Flat => Some([0.0; 2]),
        Form::Sphere { radius } => Some([radius.recip(); 2]),
        Form::Ellipsoid { radius } => Some(radius.map(f64::recip)),
        Form::Cylinder { radius, axis: Axis::X } => Some([0.0, radius.recip()]),
        Form::Cylinder { radius, axis: Axis::Y } => Some([radius.recip(), 0.0]),
        Form::Cone { .. } | Form::Sinusoid { .. } | Form::Grooves { .. } => None,
    }
}

fn point(radii: [Metre; 2], modulus: Pascal, control: Control) -> Option<ClosedForm> {
    let contact = |load: Newton| HertzEllipse::new(radii, modulus, load);
    let load = match control {
        Control::Load(load) => load,
        // δ is proportional to W^⅔.
        Control::Approach(approach) => (approach.max(0.0) / contact(1.0).approach).powf(1.5),
    };
    let hertz = contact(load);
    Some(ClosedForm {
        theory: Theory::HertzPoint,
        load,
        half_widths: hertz.semi_axes,
        contact_area: hertz.contact_area(),
        max_pressure: Some(hertz.peak_pressure),
        approach: Some(hertz.approach),
    })
}

fn line(
    radius: Metre,
    across: usize,
    extent: [Metre; 2],
    modulus: Pascal,
    control: Control,
) -> Option<ClosedForm> {
    // The approach of a line contact depends on where it is measured.
    let Control::Load(load) = control else { return None };
    let length = extent[1 - across];
    let hertz = HertzLine { radius, modulus, load_per_length: load / length };
    let mut half_widths = [0.5 * length; 2];
    half_widths[across] = hertz.half_width();
    Some(ClosedForm {
        theory: Theory::HertzLine,
        load,
        half_widths,
        contact_area: 2.0 * hertz.half_width() * length,
        max_pressure: Some(hertz.peak_pressure()),
        approach: None,
    })
}

fn cone(slope: f64, modulus: Pascal, control: Control) -> Option<ClosedForm> {
    let cone = match control {
        Control::Load(load) => Cone { slope, modulus, load },
        Control::Approach(approach) => Cone::from_approach(slope, modulus, approach.max(0.0)),
    };
    let radius = cone.contact_radius();
    Some(ClosedForm {
        theory: Theory::SneddonCone,
        load: cone.load,
        half_widths: [radius; 2],
        contact_area: std::f64::consts::PI * radius * radius,
        max_pressure: None,
        approach: Some(cone.approach()),
    })
}
