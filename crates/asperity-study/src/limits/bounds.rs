//! The bounds of the limits, with their reasons.

use std::f64::consts::{PI, SQRT_2};

use crate::case::Case;
use crate::estimate::{Estimate, STEEP, STRENGTH};
use asperity_base::units::{Kelvin, Metre, Pascal};
use asperity_contact::material::composite_modulus;
use asperity_contact::motion::{Body, Pair};
use asperity_contact::solver::Control;

/// E* up to which bodies are rubbers and gels, which stay elastic at any strain.
const RUBBER: Pascal = 1e8;
/// Share of the cells at the hardness above which hardly a gap is left, as the share of the plastic limit in
/// an estimate.
const NEAR_PLASTIC_LIMIT: f64 = 0.5;
/// Temperature at which steel melts; most other metals and glasses melt or soften below it.
const MELTING: Kelvin = 1800.0;
/// Elastic displacement over the longer side of the bodies: strains are then no longer small.
pub(super) const LARGE_DISPLACEMENT: f64 = 0.1;

/// The bounds of the limits for the bodies of a case; infinite where a limit does not apply, or where the
/// estimate of the case already warns.
pub(super) struct Bounds {
    /// Up to [`STEEP`] tan and sin of a slope agree.
    pub(super) slope: f64,
    /// The width of a cell, or the depth d at which a wave of the mean length λ = 2π Sq/Sdq of the gap that
    /// loses its summits alone becomes steep by itself: its rms slope is πd/√2λ.
    pub(super) removal: Metre,
    /// [`STRENGTH`] times the E* of the materials at the surfaces.
    pub(super) pressure: Pascal,
    /// [`NEAR_PLASTIC_LIMIT`].
    pub(super) hardness: f64,
    /// [`MELTING`].
    pub(super) temperature: Kelvin,
    /// [`LARGE_DISPLACEMENT`] times the longer side of the bodies.
    pub(super) displacement: Metre,
    /// The height of both bodies from the lowest to the highest cell.
    pub(super) interference: Metre,
}

impl Bounds {
    pub(super) fn new(case: &Case, pair: &Pair, estimate: &Estimate) -> Self {
        let unless = |known: bool, bound: f64| if known { f64::INFINITY } else { bound };
        let bodies = [&pair.lower, &pair.upper];
        let sq = bodies.iter().fold(0.0, |all: f64, body| all.hypot(body.heights.std(0.0)));
        let wave = 2.0 * PI * sq / estimate.gap_slope;
        let steep = STEEP * SQRT_2 / PI * wave;
        let [dx, dy] = pair.pitch();
        let [lower, upper] = [&case.lower, &case.upper].map(|body| body.material.at_surface());
        // Surfaces that do not deform have no limit.
        let modulus = composite_modulus(&lower, &upper).unwrap_or(f64::INFINITY);
        let strength = STRENGTH * modulus;
        // A hardness that is not much larger caps the pressure.
        let is_capped = (strength..=2.0 * strength).contains(&pair.min_hardness());
        let near = matches!(estimate.control, Control::Load(load) if load > NEAR_PLASTIC_LIMIT * estimate.plastic_limit);
        let sides = [pair.lower_grid(), pair.upper_grid()].map(|grid| grid.extent());
        let longest = sides.into_iter().flatten().fold(0.0, f64::max);
        let heights = bodies.map(Body::height_range).iter().sum::<f64>();
        Self {
            slope: unless(estimate.gap_slope > STEEP, STEEP),
            removal: if steep > 0.0 { steep.min(dx).min(dy) } else { dx.min(dy) },
            pressure: unless(is_capped || modulus < RUBBER, strength),
            hardness: unless(near, NEAR_PLASTIC_LIMIT),
            temperature: MELTING,
            displacement: LARGE_DISPLACEMENT * longest,
            // Without heights nothing can be compared with them.
            interference: unless(heights == 0.0, heights),
        }
    }
}
