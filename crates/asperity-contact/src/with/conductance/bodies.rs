//! Conductivities of the bodies, and the response of a pair to a flux.

use crate::error::{Error, Result, check};
use crate::kernel::{Influence, Layering, Line, Response, SharedResponse, potential_compliance};
use crate::units::Metre;
use crate::with::BodyConstants;
use crate::with::conductance::Kind;

/// A body that conducts: a half-space, with or without layers.
#[derive(Debug, Clone, PartialEq)]
pub struct Conductor {
    /// Conductivity κ > 0 of the half-space, W/(m K) or S/m; infinite for a body without a resistance of its
    /// own.
    pub conductivity: f64,
    /// The layers, from the surface down.
    pub layers: Vec<ConductingLayer>,
}

/// A layer of uniform thickness on a body, with a conductivity of its own.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ConductingLayer {
    /// Thickness t > 0, m, finite.
    pub thickness: Metre,
    /// Conductivity κ > 0, W/(m K) or S/m, finite.
    pub conductivity: f64,
}

impl Conductor {
    /// Creates a body of this conductivity κ > 0, W/(m K) or S/m, or infinite.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for another number.
    pub fn new(conductivity: f64) -> Result<Self> {
        check("conductivity", conductivity, conductivity > 0.0, "a conductivity above 0, or inf")?;
        Ok(Self { conductivity, layers: Vec::new() })
    }

    /// Adds a layer of this thickness, m, and conductivity, W/(m K) or S/m, on the surface.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] unless both are above 0 and finite.
    pub fn coated(mut self, thickness: Metre, conductivity: f64) -> Result<Self> {
        let good = |value: f64| value > 0.0 && value.is_finite();
        check("thickness", thickness, good(thickness), "a finite thickness above 0")?;
        let expected = "a finite conductivity above 0";
        check("conductivity of the layer", conductivity, good(conductivity), expected)?;
        self.layers.insert(0, ConductingLayer { thickness, conductivity });
        Ok(self)
    }

    /// The response of this body to a flux from one without resistance.
    fn response(&self) -> SharedResponse {
        match self.layers.first() {
            None => (2.0 * self.conductivity).into(),
            Some(surface) => {
                let layering = Layering {
                    short: 0.5 / surface.conductivity,
                    long: 0.5 / self.conductivity,
                    depth: 2.0 * surface.thickness,
                };
                LayeredConductor { body: self.clone(), layering }.into()
            }
        }
    }
}

/// Conductivity of a body, W/(m K) or S/m; `None` if it is unknown.
fn conductivity(body: &BodyConstants, kind: Kind) -> Option<f64> {
    match kind {
        Kind::Thermal => body.conductivity,
        Kind::Electrical => body.resistivity.map(f64::recip),
    }
}

/// Returns how a body conducts, with its layers; `None` if a conductivity is unknown.
pub(super) fn conductor(body: &BodyConstants, kind: Kind) -> Option<Result<Conductor>> {
    let mut conductor = Conductor::new(conductivity(body, kind)?);
    for layer in body.material.layers.iter().rev() {
        let conductivity = match kind {
            Kind::Thermal => layer.conductivity?,
            Kind::Electrical => layer.resistivity?.recip(),
        };
        conductor = conductor.and_then(|body| body.coated(layer.thickness, conductivity));
    }
    Some(conductor)
}

/// Composite conductivity of bodies without their layers, W/(m K) or S/m; `None` if one is unknown.
pub(super) fn composite(bodies: &[BodyConstants; 2], kind: Kind) -> Option<Result<f64>> {
    let [lower, upper] = bodies.each_ref().map(|body| conductivity(body, kind));
    Some(composite_conductivity(lower?, upper?))
}

/// Composite conductivity κ_s = 2κ₁κ₂/(κ₁ + κ₂) of two half-spaces, W/(m K) or S/m: it stands in place of the
/// composite modulus E* in an operator that makes a drop of a flux. One of them may be infinite, which makes
/// it twice the other.
///
/// # Errors
/// [`Error::OutOfRange`] unless both are above 0 and one is finite.
pub fn composite_conductivity(lower: f64, upper: f64) -> Result<f64> {
    for conductivity in [lower, upper] {
        Conductor::new(conductivity)?;
    }
    let composite = 2.0 / (lower.recip() + upper.recip());
    if composite.is_finite() {
        return Ok(composite);
    }
    Err(Error::OutOfRange {
        quantity: "conductivity of both bodies",
        dimension: None,
        value: composite,
        expected: "at least one finite conductivity".into(),
    })
}

/// Returns the response of a pair of bodies to a flux: the drop between far fields per unit flux, K m²/W or V
/// m²/A, for the [operators](crate::operator::Operators) of any boundary.
///
/// # Errors
/// [`Error::OutOfRange`] for conductivities without meaning, and if neither body has a resistance.
pub fn response(lower: &Conductor, upper: &Conductor) -> Result<SharedResponse> {
    let bodies = [lower, upper];
    if bodies.iter().all(|body| body.layers.is_empty()) {
        return Ok(composite_conductivity(lower.conductivity, upper.conductivity)?.into());
    }
    for body in bodies {
        let mut checked = Conductor::new(body.conductivity)?;
        for ConductingLayer { thickness, conductivity } in &body.layers {
            checked = checked.coated(*thickness, *conductivity)?;
        }
    }
    Ok(bodies.map(Conductor::response).into())
}

/// A conductor with layers.
#[derive(Debug, Clone)]
struct LayeredConductor {
    body: Conductor,
    layering: Layering,
}

impl LayeredConductor {
    /// û/q̂ of the wavenumber q > 0, to rounding.
    fn harmonic(&self, q: f64) -> f64 {
        let layers = self.body.layers.iter().rev().map(|layer| (layer.thickness, layer.conductivity));
        potential_compliance(layers, self.body.conductivity, q)
    }
}

impl Response for LayeredConductor {
    fn harmonic_displacement(&self, qx: f64, qy: f64) -> f64 {
        let q = qx.hypot(qy);
        if q == 0.0 { 0.0 } else { self.harmonic(q) }
    }

    fn influence(&self, pitch: [Metre; 2]) -> Box<dyn Influence> {
        self.layering.influence(|q| self.harmonic(q), pitch)
    }

    fn line_influence(&self, line: &Line, pitch: [Metre; 2]) -> Option<Box<dyn Influence>> {
        Some(self.layering.line_influence(|q| self.harmonic(q), line, pitch))
    }
}

#[cfg(test)]
mod tests {
    use std::f64::consts::PI;

    use approx::assert_relative_eq;

    use super::*;
    use crate::kernel::normal_displacement;
    use crate::math::gauss_legendre;

    fn harmonic(base: f64, thickness: f64, layer: f64, q: f64) -> f64 {
        let body = Conductor::new(base).unwrap().coated(thickness, layer).unwrap();
        body.response().harmonic_displacement(0.6 * q, -0.8 * q)
    }

    #[test]
    fn one_body_may_conduct_without_limit_but_not_both() {
        assert_relative_eq!(composite_conductivity(46.0, f64::INFINITY).unwrap(), 92.0, max_relative = 1e-15);
        assert_relative_eq!(composite_conductivity(3.0, 6.0).unwrap(), 4.0, max_relative = 1e-15);
        for (lower, upper) in
            [(f64::INFINITY, f64::INFINITY), (0.0, 1.0), (1.0, -1.0), (f64::NAN, 1.0), (1.0, f64::NAN)]
        {
            assert!(matches!(composite_conductivity(lower, upper), Err(Error::OutOfRange { .. })));
        }
    }

    #[test]
    fn a_layer_alike_is_no_layer_and_its_limits_are_half_spaces() {
        for q in [1e-6, 1e-2, 1.0, 30.0] {
            assert_relative_eq!(harmonic(2.0, 0.4, 2.0, q), 1.0 / (2.0 * q), max_relative = 1e-14);
            assert_relative_eq!(harmonic(5.0, 1e9, 2.0, q), 1.0 / (2.0 * q), max_relative = 1e-14);
        }
        let (line, pitch) = (Line { axis: 0, period: 3.0, datum: 20.0 }, [0.5, 0.3]);
        let of = |body: SharedResponse| body.line_influence(&line, pitch).unwrap();
        let body = Conductor::new(2.0).unwrap().coated(0.4, 2.0).unwrap();
        let (layered, plain) = (of(body.response()), of(4.0.into()));
        for [x, y] in [[0.0, 0.0], [0.5, 0.6], [1.5, 9.0], [0.0, 30.0]] {
            assert_relative_eq!(layered.displacement(x, y), plain.displacement(x, y), epsilon = 1e-13);
        }
        // Thin: the layer adds its resistance t/κ₁ less that of the base which it displaces, t κ₁/κ₂² along
        // it.
        let (base, layer, t) = (5.0, 2.0, 1e-6);
        let added = harmonic(base, t, layer, 1.0) - 1.0 / base;
        assert_relative_eq!(added, t * (1.0 / layer - layer / (base * base)), max_relative = 1e-4);
    }

    #[test]
    fn a_layer_on_a_perfect_conductor_resists_alone_and_one_on_a_bad_one_spreads() {
        let t = 1e-3;
        assert_relative_eq!(harmonic(f64::INFINITY, t, 4.0, 1e-3), t / 4.0, max_relative = 1e-10);
        // tanh(qt)/κ₁q on an isothermal base, coth(qt)/κ₁q on an insulating one.
        assert_relative_eq!(
            harmonic(f64::INFINITY, 2.0, 4.0, 0.7),
            1.4f64.tanh() / 2.8,
            max_relative = 1e-14
        );
        assert_relative_eq!(
            harmonic(1e-300, 2.0, 4.0, 0.7),
            1.0 / (2.8 * 1.4f64.tanh()),
            max_relative = 1e-14
        );
    }

    /// The harmonics are those of image sources at the depths 2nt, of the strengths 2Λⁿ.
    #[test]
    fn a_cell_on_a_coated_body_has_images_below_it() {
        let nodes = gauss_legendre(24);
        for (base, thickness, layer, pitch) in
            [(1.0, 1.5, 3.0, [1.0, 1.0]), (5.0, 0.4, 2.0, [1.0, 0.7]), (2.0, 3.0, 1.0, [0.3, 0.2])]
        {
            let body = Conductor::new(base).unwrap().coated(thickness, layer).unwrap();
            let influence = body.response().influence(pitch);
            let contrast: f64 = (layer - base) / (layer + base);
            for [x, y] in
                [[0.0, 0.0], [2.0, 0.0], [3.0, 7.0]].map(|cells| [cells[0] * pitch[0], cells[1] * pitch[1]])
            {
                let image = |depth: f64| {
                    let mut sum = 0.0;
                    for (s, u) in &nodes {
                        for (t, v) in &nodes {
                            let (dx, dy) = (x + 0.5 * s * pitch[0], y + 0.5 * t * pitch[1]);
                            sum += 0.25 * u * v / dx.hypot(dy).hypot(depth);
                        }
                    }
                    sum * pitch[0] * pitch[1] / (2.0 * PI * layer)
                };
                let own = normal_displacement(x, y, pitch, 2.0 * layer);
                let images: f64 =
                    (1..60).map(|n| 2.0 * contrast.powi(n) * image(2.0 * f64::from(n) * thickness)).sum();
                assert_relative_eq!(influence.displacement(x, y), own + images, max_relative = 1e-9);
            }
        }
    }
}
