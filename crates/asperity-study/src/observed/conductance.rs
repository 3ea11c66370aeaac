//! The conductance of a contact.

use serde::{Deserialize, Serialize};

use crate::tables::Record;
use asperity_base::error::Error;
use asperity_base::record::{columns, known_or_none};
use asperity_base::units::{
    KelvinPerWatt, Newton, Ohm, Pascal, Siemens, SiemensPerMetre, SiemensPerSquareMetre, SquareMetre, Watt,
    WattPerKelvin, WattPerMetreKelvin, WattPerSquareMetreKelvin,
};
use asperity_contact::conductance::Kind;
use asperity_contact::motion::Column;

columns! {
    /// The conductance of a contact, a row of `conductance.csv`; in `summary.json` of the last contact, or the mean over the contacts
    /// of each pass.
    #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
    #[non_exhaustive]
    pub struct ConductanceRecord {
        /// Pass of a motion, from 1; left out of a static contact.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub pass: Option<usize>,
        /// Position in the pass, increment, point (each from 1) or update (from 0); unknown in the mean over a pass.
        pub step: Option<usize>,
        /// Load.
        pub load: Newton,
        /// Mean pressure over the apparent area.
        pub mean_pressure: Pascal,
        /// Real area of contact.
        pub contact_area: SquareMetre,
        /// Number of spots, which are connected over edges and corners of cells.
        pub spots: f64,
        /// Median number of cells of a spot; 0 without contact.
        pub median_spot_cells: f64,
        /// Share of heat or current that passes the spots.
        pub spot_share: f64,
        /// Share of the heat that passes the gas.
        pub gas_share: f64,
        /// Share of the resistance that the film on the spots has.
        pub film_share: f64,
        /// Heat that passes under the temperature difference `drop`; of a current, the heat that it makes. Unknown where the joint has
        /// no resistance.
        #[serde(deserialize_with = "known_or_none")]
        pub power: Option<Watt>,
        /// Convolutions for the conductance.
        pub convolutions: f64,
        /// Residual of the conductance: largest relative deviation from the common temperature or potential.
        pub residual: f64,
        /// The conductance of heat.
        #[serde(flatten, skip_serializing_if = "Option::is_none")]
        pub thermal: Option<ThermalRecord>,
        /// The conductance of a current.
        #[serde(flatten, skip_serializing_if = "Option::is_none")]
        pub electrical: Option<ElectricalRecord>,
    }
}

columns! {
    /// The conductance of heat.
    #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
    #[non_exhaustive]
    pub struct ThermalRecord {
        /// Composite thermal conductivity of the bodies, without their coatings.
        pub thermal_conductivity: WattPerMetreKelvin,
        /// Thermal conductance of the contact; unknown where it adds no resistance.
        #[serde(deserialize_with = "known_or_none")]
        pub thermal_conductance: Option<WattPerKelvin>,
        /// Thermal joint conductance h, the conductance over the apparent area.
        #[serde(deserialize_with = "known_or_none")]
        pub thermal_joint_conductance: Option<WattPerSquareMetreKelvin>,
        /// Thermal resistance; unknown where nothing conducts, and where the contact adds no resistance.
        #[serde(deserialize_with = "known_or_none")]
        pub thermal_resistance: Option<KelvinPerWatt>,
        /// Thermal resistance with all cells in contact, which the bodies beyond the grid have; unknown under a periodic boundary, and
        /// at a position of a motion.
        #[serde(deserialize_with = "known_or_none")]
        pub thermal_resistance_full: Option<KelvinPerWatt>,
        /// Estimate of Holm and Greenwood of the thermal resistance of the spots, under a free boundary.
        #[serde(deserialize_with = "known_or_none")]
        pub thermal_resistance_holm_greenwood: Option<KelvinPerWatt>,
        /// Thermal joint conductance of clean spots by the correlation of Cooper, Mikic and Yovanovich, or of Mikic for elastic bodies;
        /// unknown from 5 % of contact on.
        #[serde(deserialize_with = "known_or_none")]
        pub thermal_joint_correlation: Option<WattPerSquareMetreKelvin>,
    }
}

columns! {
    /// The conductance of a current.
    #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
    #[non_exhaustive]
    pub struct ElectricalRecord {
        /// Composite electrical conductivity of the bodies, without their coatings.
        pub electrical_conductivity: SiemensPerMetre,
        /// Electrical conductance of the contact; unknown where it adds no resistance.
        #[serde(deserialize_with = "known_or_none")]
        pub electrical_conductance: Option<Siemens>,
        /// Electrical joint conductance, the conductance over the apparent area.
        #[serde(deserialize_with = "known_or_none")]
        pub electrical_joint_conductance: Option<SiemensPerSquareMetre>,
        /// Electrical resistance; unknown where nothing conducts, and where the contact adds no resistance.
        #[serde(deserialize_with = "known_or_none")]
        pub electrical_resistance: Option<Ohm>,
        /// Electrical resistance with all cells in contact, which the bodies beyond the grid have; unknown under a periodic boundary,
        /// and at a position of a motion.
        #[serde(deserialize_with = "known_or_none")]
        pub electrical_resistance_full: Option<Ohm>,
        /// Estimate of Holm and Greenwood of the electrical resistance of the spots, under a free boundary.
        #[serde(deserialize_with = "known_or_none")]
        pub electrical_resistance_holm_greenwood: Option<Ohm>,
        /// Electrical joint conductance of clean spots by the correlation of Cooper, Mikic and Yovanovich, or of Mikic for elastic bodies;
        /// unknown from 5 % of contact on.
        #[serde(deserialize_with = "known_or_none")]
        pub electrical_joint_correlation: Option<SiemensPerSquareMetre>,
    }
}

impl Record for ConductanceRecord {
    const COLUMNS: &'static [Column] = Self::COLUMNS;

    fn at(&self, error: Error) -> Error {
        match self.pass {
            Some(pass) => error.if_of_step(|source| Error::AtPass { pass, source }),
            None => error,
        }
    }
}

impl ConductanceRecord {
    /// Conductance, W/K or S; `None` where the contact adds no resistance.
    pub fn conductance(&self) -> Option<f64> {
        match (&self.thermal, &self.electrical) {
            (Some(thermal), _) => thermal.thermal_conductance,
            (None, Some(electrical)) => electrical.electrical_conductance,
            (None, None) => None,
        }
    }

    /// Real contact area over the apparent area; 0 without a load.
    pub fn contact_fraction(&self) -> f64 {
        if self.load == 0.0 { 0.0 } else { self.contact_area * self.mean_pressure / self.load }
    }

    /// Joint conductance, W/(m² K) or S/m², and that of clean spots by the correlation.
    pub fn joint(&self) -> [Option<f64>; 2] {
        match (&self.thermal, &self.electrical) {
            (Some(thermal), _) => [thermal.thermal_joint_conductance, thermal.thermal_joint_correlation],
            (None, Some(of)) => [of.electrical_joint_conductance, of.electrical_joint_correlation],
            (None, None) => [None; 2],
        }
    }

    /// Returns the mean over the contacts of each pass: at a common difference of temperature or potential the conductance has the
    /// mean of its values, and the resistance is its reciprocal.
    pub fn means(rows: &[Self]) -> Vec<Self> {
        rows.chunk_by(|one, other| one.pass == other.pass).map(Self::mean).collect()
    }

    fn mean(rows: &[Self]) -> Self {
        let count = rows.len() as f64;
        let mean = |value: &dyn Fn(&Self) -> f64| rows.iter().map(value).sum::<f64>() / count;
        let known = |value: &dyn Fn(&Self) -> Option<f64>| {
            rows.iter().map(value).sum::<Option<f64>>().map(|sum| sum / count)
        };
        let conductance = known(&Self::conductance);
        let [joint, correlation] = [0, 1].map(|which| known(&|row: &Self| row.joint()[which]));
        let conductivity = match (&rows[0].thermal, &rows[0].electrical) {
            (Some(thermal), _) => thermal.thermal_conductivity,
            (None, electrical) => electrical.as_ref().map_or(0.0, |of| of.electrical_conductivity),
        };
        let quantities = Quantities {
            conductivity,
            conductance,
            joint,
            resistance: conductance.filter(|conductance| *conductance > 0.0).map(f64::recip),
            full: None,
            holm_greenwood: None,
            correlation,
        };
        let kind = if rows[0].thermal.is_some() { Kind::Thermal } else { Kind::Electrical };
        let (thermal, electrical) = quantities.of_kind(kind);
        Self {
            pass: rows[0].pass,
            step: None,
            load: mean(&|row| row.load),
            mean_pressure: mean(&|row| row.mean_pressure),
            contact_area: mean(&|row| row.contact_area),
            spots: mean(&|row| row.spots),
            median_spot_cells: mean(&|row| row.median_spot_cells),
            spot_share: mean(&|row| row.spot_share),
            gas_share: mean(&|row| row.gas_share),
            film_share: mean(&|row| row.film_share),
            power: known(&|row: &Self| row.power),
            convolutions: mean(&|row| row.convolutions),
            residual: rows.iter().map(|row| row.residual).fold(0.0, f64::max),
            thermal,
            electrical,
        }
    }
}

/// The quantities of either kind.
pub(crate) struct Quantities {
    pub(crate) conductivity: f64,
    pub(crate) conductance: Option<f64>,
    pub(crate) joint: Option<f64>,
    pub(crate) resistance: Option<f64>,
    pub(crate) full: Option<f64>,
    pub(crate) holm_greenwood: Option<f64>,
    pub(crate) correlation: Option<f64>,
}

impl Quantities {
    /// Returns the record of a kind.
    pub(crate) fn of_kind(self, kind: Kind) -> (Option<ThermalRecord>, Option<ElectricalRecord>) {
        let Self { conductivity, conductance, joint, resistance, full, holm_greenwood, correlation } = self;
        match kind {
            Kind::Thermal => {
                let record = ThermalRecord {
                    thermal_conductivity: conductivity,
                    thermal_conductance: conductance,
                    thermal_joint_conductance: joint,
                    thermal_resistance: resistance,
                    thermal_resistance_full: full,
                    thermal_resistance_holm_greenwood: holm_greenwood,
                    thermal_joint_correlation: correlation,
                };
                (Some(record), None)
            }
            Kind::Electrical => {
                let record = ElectricalRecord {
                    electrical_conductivity: conductivity,
                    electrical_conductance: conductance,
                    electrical_joint_conductance: joint,
                    electrical_resistance: resistance,
                    electrical_resistance_full: full,
                    electrical_resistance_holm_greenwood: holm_greenwood,
                    electrical_joint_correlation: correlation,
                };
                (None, Some(record))
            }
        }
    }
}
