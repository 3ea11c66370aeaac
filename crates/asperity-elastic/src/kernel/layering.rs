//! Response in space of layered bodies, from their harmonics.

use std::f64::consts::PI;

use crate::grid::Field;
use crate::kernel::cell::integrals_below;
use crate::kernel::remainder::{Remainder, Transform};
use crate::kernel::smooth_line::{SmoothLine, Strips};
use crate::kernel::{Influence, Line, normal_displacement};
use crate::math::parallel;
use crate::units::Metre;

/// Isotropic layered bodies with known harmonics. Short waves have the response of one half-space, long waves
/// that of another one.
///
/// The displacement under a cell follows from the harmonics û(q) in three parts:
///
/// ```text
/// û(q) = (2/q) [s + (b − s) e^(−qd)] + R(q)      s, b the compliances 1/E* of short and of long waves, d the depth
/// ```
///
/// The first part is a half-space, the second the potential of the cell at the depth d, both in closed form.
/// R is bounded at q = 0 and decays as e^(−qd). Its Hankel transform ρ(r) = ∫ R(q) J₀(qr) q dq/2π is
/// therefore smooth on the scale d. It is tabulated over r, and integrated over the cell.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Layering {
    /// Compliance 1/E* for short waves, 1/Pa, ≥ 0: the compliance of the uppermost layer.
    pub short: f64,
    /// Compliance 1/E* for long waves, 1/Pa, ≥ 0: the compliance of the substrate.
    pub long: f64,
    /// The depth d > 0. For q → ∞, qû(q) approaches its limit as e^(−qd) or a little slower. For a layer on a
    /// half-space it is twice the thickness.
    pub depth: Metre,
}

impl Layering {
    /// Returns the displacement per unit pressure on a cell of size `pitch` of bodies with the `harmonics`
    /// û(q), m/Pa, q > 0 in 1/m.
    ///
    /// The error is below 1e-11 of the displacement of a cell under its own pressure if û(q) is as exact and
    /// a smooth function of ln q. This holds for any ratio of cell size to depth.
    pub fn influence(&self, harmonics: impl Fn(f64) -> f64 + Sync, pitch: [Metre; 2]) -> Box<dyn Influence> {
        let (short, below) = (self.short, self.below(&harmonics));
        let half = pitch.map(|p| 0.5 * p);
        Box::new(move |x: Metre, y: Metre| {
            let [rest] = below.displacement([x, y], half);
            short * normal_displacement(x, y, pitch, 1.0) + rest
        })
    }

    /// Returns the displacement as [`Layering::influence`], under each cell of a `line`. See [`Line`]: its uniform part is 0 at the
    /// datum, or relative to a body that does not give way to long waves.
    ///
    /// The error is below 1e-10 of the displacement of a cell under its own pressure, on these bodies or on the half-space of
    /// short waves, whichever is larger.
    pub fn line_influence(
        &self,
        harmonics: impl Fn(f64) -> f64 + Sync,
        line: &Line,
        pitch: [Metre; 2],
    ) -> Box<dyn Influence> {
        let below = self.below_line(harmonics, line, pitch);
        Box::new(LayeredLine { line: *line, pitch, short: self.short, below })
    }

    /// Returns the displacement under each cell of a `line` minus that of the half-space of short waves.
    pub(super) fn below_line(
        &self,
        harmonics: impl Fn(f64) -> f64 + Sync,
        line: &Line,
        pitch: [Metre; 2],
    ) -> SmoothLine<1> {
        let below = self.below(&harmonics);
        let rest = |q: f64| [self.rest(&harmonics, q)];
        let scales = [self.depth, line.datum];
        let strips = Strips::new(rest, [Transform::Cosine], [below.image], scales, Metre::INFINITY);
        let strips = if self.long > 0.0 { strips.relative_to_datum() } else { strips };
        SmoothLine::new(
            line,
            pitch,
            [[false; 2]],
            move |at, half| below.displacement(at, half),
            move |x, half| strips.under_strip(x, half),
        )
    }

    fn below(&self, harmonics: &(impl Fn(f64) -> f64 + Sync)) -> Below {
        let both = |q: f64| [self.rest(harmonics, q); 2];
        let transforms = [Transform::Hankel, Transform::Mean];
        Below {
            depth: self.depth,
            image: (self.long - self.short) / PI,
            remainder: Remainder::new(both, transforms, self.depth, Metre::INFINITY),
        }
    }

    /// R(q).
    fn rest(&self, harmonics: &impl Fn(f64) -> f64, q: f64) -> f64 {
        let Self { short, long, depth } = self;
        harmonics(q) - 2.0 / q * (short + (long - short) * (-q * depth).exp())
    }
}

/// Displacement under a cell minus that of the half-space of short waves.
struct Below {
    depth: Metre,
    /// Amplitude of the potential at the depth.
    image: f64,
    remainder: Remainder<2>,
}

impl Below {
    fn displacement(&self, at: [Metre; 2], half: [Metre; 2]) -> [f64; 1] {
        let Self { depth, image, remainder } = self;
        let image_at = |x: f64, y: f64| image / (x * x + y * y + depth * depth).sqrt();
        integrals_below(
            at,
            *depth,
            half,
            |x, y| [image * potential_below(x, y, *depth) + remainder.of_rectangle(x, y)],
            |x, y| [image_at(x, y) + remainder.at(x.hypot(y))[0]],
        )
    }
}

/// The influence returned by [`Layering::line_influence`].
struct LayeredLine {
    line: Line,
    pitch: [Metre; 2],
    short: f64,
    below: SmoothLine<1>,
}

impl LayeredLine {
    fn below(&self, x: Metre, y: Metre) -> f64 {
        self.below.displacement(self.line.turned([x, y]))[0]
    }
}

impl Influence for LayeredLine {
    fn displacement(&self, x: Metre, y: Metre) -> f64 {
        self.short * self.line.normal_displacement(x, y, self.pitch, 1.0) + self.below(x, y)
    }

    fn table(&self, shape: [usize; 2], pitch: [Metre; 2]) -> Field {
        let half_space = self.line.influence_table(shape, pitch, 1.0);
        self.short * half_space
            + parallel::field(shape, |i, j| self.below(i as f64 * pitch[0], j as f64 * pitch[1]))
    }
}

/// Computes ∬ 1/√(ξ² + η² + z²) over 0 … x and 0 … y.
fn potential_below(x: f64, y: f64, z: f64) -> f64 {
    let r = x.hypot(y).hypot(z);
    let (across, along) = (x.hypot(z), y.hypot(z));
    x * (y / across).asinh() + y * (x / along).asinh() - z * (x * y / (z * r)).atan()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn harmonics_that_are_potentials_at_depths_give_these() {
        // Half-spaces at the depths d and 3d/2, and far beyond the table of the remainder.
        let (short, long, depth) = (0.7, 2.9, 0.4);
        let layering = Layering { short, long, depth };
        let half = 0.5 * (long - short);
        let harmonics = |q: f64| 2.0 / q * (short + half * ((-q * depth).exp() + (-1.5 * q * depth).exp()));
        for pitch in [[1.0, 1.0], [0.01, 0.02], [0.3, 40.0], [1e3, 2e3]] {
            let influence = layering.influence(harmonics, pitch);
            let own = influence.displacement(0.0, 0.0);
            for cells in [[0.0, 0.0], [1.0, 0.0], [0.0, 7.0], [14.0, 15.0], [300.0, 20.0], [0.0, 1e7]] {
                let [x, y] = [0, 1].map(|axis| cells[axis] * pitch[axis]);
                let seen_at = |z: f64| {
                    let [seen] = integrals_below(
                        [x, y],
                        z,
                        pitch.map(|p| 0.5 * p),
                        |x, y| [potential_below(x, y, z)],
                        |x, y| [1.0 / x.hypot(y).hypot(z)],
                    );
                    seen
                };
                let exact = short * normal_displacement(x, y, pitch, 1.0)
                    + half / PI * (seen_at(depth) + seen_at(1.5 * depth));
                let error = influence.displacement(x, y) - exact;
                assert!(error.abs() < 1e-11 * own, "{pitch:?}, {cells:?}: {:e}", error / own);
            }
        }
    }
}
