//! A film of oil between the bodies.

use serde::{Deserialize, Serialize};

use crate::units::{Metre, MetrePerSecond, Pascal};
use asperity_base::record::{columns, known_or_none};

columns! {
    /// The film between lubricated bodies: at a speed, at a position of a pass, or over the positions of a pass.
    ///
    /// The contact is the ellipse over which Hertz' pressure would have the moments of the dry pressure.
    #[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
    pub struct FilmRecord {
        /// Mean film over the contact.
        pub mean_film: Metre,
        /// Least film of all cells.
        pub min_film: Metre,
        /// λ: mean film over the composite rms roughness of both bodies in the contact, without their form; unknown of
        /// smooth bodies.
        #[serde(deserialize_with = "known_or_none")]
        pub lambda: Option<f64>,
        /// Share of the load that the solids bear, 0 to 1.
        pub solid_share: f64,
        /// Traction coefficient: shear of the oil and friction of the solids, over the load.
        pub traction_coefficient: f64,
        /// Share of the grid in which the film is broken by cavitation, 0 to 1.
        pub cavity_share: f64,
        /// Largest pressure of the oil.
        pub max_oil_pressure: Pascal,
        /// Largest share of a cell's hardness that its pressure is, above 1 where bodies would yield; 0 of elastic bodies.
        pub hardness_share: f64,
        /// Distance of the inlet from the centre of the contact over that of a fully flooded one, by Hamrock and Dowson
        /// (1977); unknown unless the gap is a paraboloid with free boundaries, and where bodies overlap in part.
        #[serde(deserialize_with = "known_or_none")]
        pub inlet_ratio: Option<f64>,
    }
}

impl FilmRecord {
    /// Returns the record of a pass from those of its positions: the least film and inlet, the largest pressures, and the
    /// means of the others; `None` without positions.
    pub(in crate::motion) fn of_pass(films: &[Self]) -> Option<Self> {
        let mean = |value: fn(&Self) -> f64| films.iter().map(value).sum::<f64>() / films.len() as f64;
        let most = |value: fn(&Self) -> f64| films.iter().map(value).fold(0.0, f64::max);
        let lambdas: Vec<f64> = films.iter().filter_map(|film| film.lambda).collect();
        films.first()?;
        Some(Self {
            mean_film: mean(|film| film.mean_film),
            min_film: films.iter().map(|film| film.min_film).fold(f64::INFINITY, f64::min),
            lambda: (!lambdas.is_empty()).then(|| lambdas.iter().sum::<f64>() / lambdas.len() as f64),
            solid_share: mean(|film| film.solid_share),
            traction_coefficient: mean(|film| film.traction_coefficient),
            cavity_share: mean(|film| film.cavity_share),
            max_oil_pressure: most(|film| film.max_oil_pressure),
            hardness_share: most(|film| film.hardness_share),
            inlet_ratio: films.iter().filter_map(|film| film.inlet_ratio).reduce(f64::min),
        })
    }
}

columns! {
    /// A steady film, its uncertainties, and the formula beside it.
    ///
    /// An uncertainty is the difference to the film on half as many cells along both axes, unknown if that film does
    /// not converge or the grid is too coarse to be halved.
    #[derive(Debug, Clone, Copy, Default, PartialEq, Serialize, Deserialize)]
    pub struct LubricationRecord {
        /// Difference of the speeds of both surfaces.
        pub sliding_speed: MetrePerSecond,
        /// Mean film over a tenth of the contact around its centre.
        pub central_film: Metre,
        /// The film.
        #[serde(flatten)]
        pub film: FilmRecord,
        /// Difference of the mean film to that on half as many cells along both axes.
        #[serde(deserialize_with = "known_or_none")]
        pub mean_film_uncertainty: Option<Metre>,
        /// Difference of the share of the solids to that on half as many cells along both axes.
        #[serde(deserialize_with = "known_or_none")]
        pub solid_share_uncertainty: Option<f64>,
        /// Difference of the traction coefficient to that on half as many cells along both axes.
        #[serde(deserialize_with = "known_or_none")]
        pub traction_uncertainty: Option<f64>,
        /// Rolling friction over the load: the oil that is carried against its pressure; half of it brakes each body.
        pub rolling_friction: f64,
        /// Central film of smooth bodies by Hamrock and Dowson (1977); unknown unless the gap is a paraboloid with free
        /// boundaries.
        #[serde(deserialize_with = "known_or_none")]
        pub hamrock_dowson_film: Option<Metre>,
    }
}
