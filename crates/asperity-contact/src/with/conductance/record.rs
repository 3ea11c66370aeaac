//! The columns of a conductance.

use serde::de::Error as _;
use serde::ser::SerializeMap;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

use super::Kind;
use crate::error::Error;
use crate::units::{Newton, Pascal, SquareMetre, Watt};
use crate::with::Row;
use asperity_base::record::{Column, OptionalNumber, Part, Presence, Record, columns, known_or_none};

columns! {
    /// The conductance of a contact, a row of `conductance.csv`; in `summary.json` of the last contact, or
    /// the mean over the contacts of each pass. The columns of its [`Quantities`] come last.
    #[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
    #[non_exhaustive]
    pub struct ConductanceRecord {
        /// Pass of a motion, from 1; left out of a static contact.
        #[serde(default, skip_serializing_if = "Option::is_none")]
        pub pass: Option<usize>,
        /// Position in the pass, increment, point (each from 1) or update (from 0); unknown in the mean over
        /// a pass.
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
        /// Heat that passes under the temperature difference `drop`; of a current, the heat that it makes.
        /// Unknown where the joint has no resistance.
        #[serde(deserialize_with = "known_or_none")]
        pub power: Option<Watt>,
        /// Convolutions for the conductance.
        pub convolutions: f64,
        /// Residual of the conductance: largest relative deviation from the common temperature or potential.
        pub residual: f64,
        /// Conductance, resistances and comparisons, in columns that say `thermal` or `electrical`.
        #[serde(flatten)]
        pub quantities: Quantities,
    }
}

/// Declares the quantities once: each has a column for heat and one for a current, with the unit of either.
macro_rules! quantities {
    ($(
        $(#[doc = $text:literal])+
        $name:ident: [$thermal:literal, $electrical:literal], $presence:ident;
    )+) => {
        /// The quantities of a conductance. Their columns begin with the kind: `thermal_resistance`,
        /// `electrical_resistance`.
        #[derive(Debug, Clone, PartialEq)]
        #[non_exhaustive]
        pub struct Quantities {
            /// Whether heat or current passes.
            pub kind: Kind,
            $($(#[doc = $text])+ pub $name: Option<f64>,)+
        }

        impl Quantities {
            /// The columns of heat.
            pub const THERMAL: &'static [Column] = &[$(Column {
                presence: Presence::$presence,
                ..Column::new(concat!("thermal_", stringify!($name)), $thermal, concat!($($text),+).trim_ascii())
            }),+];
            /// The columns of a current.
            pub const ELECTRICAL: &'static [Column] = &[$(Column {
                presence: Presence::$presence,
                ..Column::new(concat!("electrical_", stringify!($name)), $electrical, concat!($($text),+).trim_ascii())
            }),+];

            fn of(kind: Kind, values: [Option<f64>; Self::THERMAL.len()]) -> Self {
                let [$($name),+] = values;
                Self { kind, $($name),+ }
            }

            fn values(&self) -> [Option<f64>; Self::THERMAL.len()] {
                [$(self.$name),+]
            }
        }
    };
}

quantities! {
    /// Composite conductivity of the bodies, without their coatings.
    conductivity: ["W/(m K)", "S/m"], Always;
    /// Conductance of the contact; unknown where it adds no resistance.
    conductance: ["W/K", "S"], Unknown;
    /// Joint conductance h over the apparent area, without the spreading from the outline of the grid into
    /// the bodies. It is unknown where the contact adds no resistance, and where the two cannot be split:
    /// curved bodies under a free boundary, spots in a part of the grid.
    joint_conductance: ["W/(m² K)", "S/m²"], Unknown;
    /// Resistance; unknown where nothing conducts, and where the contact adds no resistance.
    resistance: ["K/W", "Ω"], Unknown;
    /// Resistance with all cells in contact, that of the spreading from the outline of the grid; unknown
    /// under a periodic boundary, and in the mean over a pass.
    resistance_full: ["K/W", "Ω"], Unknown;
    /// Conductance by Barber's identity, 2K/(E*(ρ₁ + ρ₂)) with the normal stiffness K and the resistivities
    /// ρ, to check the conductance; known at the points of a sweep whose contact is elastic, without coating,
    /// film and gas.
    conductance_of_stiffness: ["W/K", "S"], Unknown;
    /// Estimate of Holm and Greenwood of the resistance of the spots, under a free boundary.
    resistance_holm_greenwood: ["K/W", "Ω"], Unknown;
    /// Joint conductance of clean spots by the correlation of Cooper, Mikic and Yovanovich, or of Mikic for
    /// elastic bodies; unknown from 5 % of contact on.
    joint_correlation: ["W/(m² K)", "S/m²"], Unknown;
}

impl Quantities {
    /// Its columns, those of heat before those of a current.
    pub const COLUMNS: &'static [Column] =
        &Part::join::<{ Part::count(Self::PARTS, true) }>(Self::PARTS, true);
    const PARTS: &'static [Part] = &[
        Part { columns: Self::THERMAL, is_group: true },
        Part { columns: Self::ELECTRICAL, is_group: true },
    ];

    const fn columns(kind: Kind) -> &'static [Column] {
        match kind {
            Kind::Thermal => Self::THERMAL,
            Kind::Electrical => Self::ELECTRICAL,
        }
    }

    /// Name of the column of the conductance.
    pub(super) const fn conductance_column(&self) -> &'static str {
        Self::columns(self.kind)[1].name
    }

    /// Name of the column of the joint conductance.
    pub(super) const fn joint_column(&self) -> &'static str {
        Self::columns(self.kind)[2].name
    }

    /// Relative difference of the conductance from that of the stiffness, where both are known.
    pub(super) fn off_the_stiffness(&self) -> Option<f64> {
        Some(self.conductance? / self.conductance_of_stiffness? - 1.0)
    }
}

impl Serialize for Quantities {
    fn serialize<S: Serializer>(&self, serializer: S) -> std::result::Result<S::Ok, S::Error> {
        let columns = Self::columns(self.kind);
        let mut map = serializer.serialize_map(Some(columns.len()))?;
        for (column, value) in columns.iter().zip(self.values()) {
            map.serialize_entry(column.name, &value)?;
        }
        map.end()
    }
}

impl<'de> Deserialize<'de> for Quantities {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> std::result::Result<Self, D::Error> {
        struct Columns;

        impl<'de> serde::de::Visitor<'de> for Columns {
            type Value = Quantities;

            fn expecting(&self, formatter: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
                formatter.write_str("the columns of a conductance")
            }

            fn visit_map<A: serde::de::MapAccess<'de>>(
                self,
                mut map: A,
            ) -> std::result::Result<Quantities, A::Error> {
                let mut found = None;
                while let Some(name) = map.next_key::<String>()? {
                    let kinds = [Kind::Thermal, Kind::Electrical];
                    let at = kinds.into_iter().find_map(|kind| {
                        let index =
                            Quantities::columns(kind).iter().position(|column| column.name == name)?;
                        Some((kind, index))
                    });
                    let Some((kind, index)) = at else {
                        map.next_value::<serde::de::IgnoredAny>()?;
                        continue;
                    };
                    let OptionalNumber(value) = map.next_value()?;
                    let (_, values) = found.get_or_insert((kind, [None; Quantities::THERMAL.len()]));
                    values[index] = value;
                }
                let (kind, values) =
                    found.ok_or_else(|| A::Error::missing_field(Quantities::THERMAL[0].name))?;
                Ok(Quantities::of(kind, values))
            }
        }

        deserializer.deserialize_map(Columns)
    }
}

impl Record for ConductanceRecord {
    const COLUMNS: &'static [Column] = Self::COLUMNS;

    fn error_at(&self, error: Error) -> Error {
        match self.pass {
            Some(pass) => error.if_of_step(|source| Error::AtPass { pass, source }),
            None => error,
        }
    }
}

impl Row for ConductanceRecord {
    const GROUPS: &'static [(&'static str, &'static [Column])] = &[
        ("ConductanceRecord", Self::OWN_COLUMNS),
        ("ThermalRecord", Quantities::THERMAL),
        ("ElectricalRecord", Quantities::ELECTRICAL),
    ];

    fn pass(&self) -> Option<usize> {
        self.pass
    }

    fn mean_pressure(&self) -> Pascal {
        self.mean_pressure
    }
}

impl ConductanceRecord {
    /// Real contact area over the apparent area; 0 without a load.
    pub fn contact_fraction(&self) -> f64 {
        if self.load == 0.0 { 0.0 } else { self.contact_area * self.mean_pressure / self.load }
    }

    /// Returns the mean over the contacts of each pass: at a common difference of temperature or potential
    /// the conductance has the mean of its values, and the resistance is its reciprocal. The joint
    /// conductance is the mean of those that are known.
    pub fn means(rows: &[Self]) -> Vec<Self> {
        rows.chunk_by(|one, other| one.pass == other.pass).map(Self::mean).collect()
    }

    fn mean(rows: &[Self]) -> Self {
        let count = rows.len() as f64;
        let mean = |value: &dyn Fn(&Self) -> f64| rows.iter().map(value).sum::<f64>() / count;
        let known = |value: &dyn Fn(&Self) -> Option<f64>| {
            rows.iter().map(value).sum::<Option<f64>>().map(|sum| sum / count)
        };
        let conductance = known(&|row| row.quantities.conductance);
        let joints: Vec<f64> = rows.iter().filter_map(|row| row.quantities.joint_conductance).collect();
        let joint = joints.iter().sum::<f64>() / joints.len() as f64;
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
            power: known(&|row| row.power),
            convolutions: mean(&|row| row.convolutions),
            residual: rows.iter().map(|row| row.residual).fold(0.0, f64::max),
            quantities: Quantities {
                kind: rows[0].quantities.kind,
                conductivity: rows[0].quantities.conductivity,
                conductance,
                joint_conductance: Some(joint).filter(|joint| joint.is_finite()),
                resistance: conductance.filter(|conductance| *conductance > 0.0).map(f64::recip),
                resistance_full: None,
                conductance_of_stiffness: None,
                resistance_holm_greenwood: None,
                joint_correlation: known(&|row| row.quantities.joint_correlation),
            },
        }
    }
}
