//! Description of a topography in numbers.

use asperity::surface::{
    Axis, FeatureParameters, GreenwoodWilliamson, HybridParameters, Parameters, ProfileParameters,
    SelfAffinity, SpatialParameters, SpectralMoments, Spectrum, Summits, Window,
};
use asperity::units::Metre;
use asperity_report::figures::RINGS;
use serde::Serialize;

use super::{ReadSurface, line_of};
use crate::report::Outcome;

/// Numbers of `asperity surface info` beyond those of the file itself, SI.
#[derive(Serialize)]
pub(super) struct Description {
    /// Areal parameters of ISO 25178-2; none of a single line.
    pub(super) parameters: Option<Parameters>,
    /// None without a pitch, and of a single line.
    #[serde(flatten)]
    pub(super) statistics: Option<Statistics>,
    /// None without a cut-off.
    pub(super) profiles: Option<Profiles>,
}

/// Quantities of the theories of random surfaces.
#[derive(Serialize)]
pub(super) struct Statistics {
    /// Spectral moments under Hann's window.
    pub(super) moments: SpectralMoments,
    /// Nayak's α.
    pub(super) bandwidth: f64,
    pub(super) asperities: Asperities,
    /// The self-affine law on the longest range that follows one.
    pub(super) self_affine: Option<Law>,
}

/// A power law of the spectrum, and its range.
#[derive(Serialize)]
pub(super) struct Law {
    #[serde(flatten)]
    pub(super) fit: SelfAffinity,
    pub(super) decades: f64,
    pub(super) doubt: Option<String>,
}

impl From<SelfAffinity> for Law {
    fn from(fit: SelfAffinity) -> Self {
        Self { fit, decades: fit.decades(), doubt: fit.doubt() }
    }
}

/// The surface of Greenwood and Williamson.
#[derive(Serialize)]
pub(super) struct Asperities {
    /// Values from the summits.
    pub(super) counted: GreenwoodWilliamson,
    /// Values from the moments.
    pub(super) by_moments: GreenwoodWilliamson,
}

/// Parameters of ISO 21920-2 of the roughness, means over all lines; of a single line those along it.
#[derive(Serialize)]
pub(super) struct Profiles {
    pub(super) cutoff: Metre,
    pub(super) x: Option<ProfileParameters>,
    pub(super) y: Option<ProfileParameters>,
}

impl Description {
    pub(super) fn of(file: &ReadSurface, cutoff: Option<Metre>) -> Outcome<Self> {
        let topography = &file.topography;
        let line = line_of(topography);
        let parameters = line.is_none().then(|| {
            let mut parameters = topography.parameters();
            if file.pitch.is_none() {
                // These quantities need lengths along the surface.
                parameters.spatial = SpatialParameters::undefined();
                parameters.hybrid = HybridParameters::undefined();
                parameters.feature = FeatureParameters::undefined();
            }
            parameters
        });
        let profiles = cutoff.map(|cutoff| {
            let along = |axis| {
                let exists = line.is_none_or(|line| line == axis);
                exists.then(|| topography.profile_parameters(axis, cutoff)).transpose()
            };
            Ok::<_, asperity::Error>(Profiles { cutoff, x: along(Axis::X)?, y: along(Axis::Y)? })
        });
        let statistics = file.pitch.filter(|_| line.is_none()).map(|_| Statistics::of(file));
        Ok(Self { parameters, statistics, profiles: profiles.transpose()? })
    }
}

impl Statistics {
    fn of(file: &ReadSurface) -> Self {
        let spectrum = Spectrum::of(&file.topography, Window::Hann);
        let moments = spectrum.moments();
        Self {
            moments,
            bandwidth: moments.bandwidth(),
            asperities: Asperities {
                counted: Summits::of(&file.topography).greenwood_williamson(),
                by_moments: moments.greenwood_williamson(),
            },
            self_affine: SelfAffinity::of_longest_range(&spectrum.radial(RINGS)).ok().map(Law::from),
        }
    }
}
