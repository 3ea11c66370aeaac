//! Volumes that the bodies lose to laws: four columns for each law, by its name.

use std::fmt;

use serde::de::{Deserializer, Error, MapAccess, Visitor};
use serde::ser::Serializer;

use crate::units::CubicMetre;
use asperity_base::record::{Column, OptionalNumber, OverMotion};

/// Endings of the columns of a law, after its name.
pub const ENDINGS: [&str; 4] =
    ["_volume_lower", "_volume_upper", "_volume_lower_interior", "_volume_upper_interior"];

/// Whether a column holds the volume that a body loses to a law.
pub fn is_volume_of_law(column: &str) -> bool {
    ENDINGS.iter().any(|ending| column.ends_with(ending))
}

/// The volumes that the bodies lost to a law.
#[derive(Debug, Clone, PartialEq)]
pub struct LostVolume {
    /// Name of the law.
    pub law: String,
    /// Volumes that the lower and the upper body lost, m³.
    pub whole: [CubicMetre; 2],
    /// Volumes that the interiors of the lower and of the upper body lost, m³.
    pub interior: [CubicMetre; 2],
}

impl LostVolume {
    /// The columns of the law `plastic` in a pass. Other laws have columns with their own names.
    pub const IN_A_PASS: &'static [Column] = &[
        Self::of_passes(
            "plastic_volume_lower",
            "Volume that the law took from the lower body; below 0 while a film grows.",
        ),
        Self::of_passes("plastic_volume_upper", "Volume that the law took from the upper body."),
        Self::of_passes("plastic_volume_lower_interior", "Part of it from the interior of the lower body."),
        Self::of_passes("plastic_volume_upper_interior", "Part of it from the interior of the upper body."),
    ];
    /// The columns of the law `plastic` in an update.
    pub const SO_FAR: &'static [Column] = &[
        Column::new(
            "plastic_volume_lower",
            "m³",
            "Volume that the law has taken from the lower body so far; below 0 where a film has grown.",
        ),
        Column::new(
            "plastic_volume_upper",
            "m³",
            "Volume that the law has taken from the upper body so far.",
        ),
    ];

    const fn of_passes(name: &'static str, text: &'static str) -> Column {
        Column { over_motion: OverMotion::Sum, ..Column::new(name, "m³", text) }
    }

    /// Creates volumes of zero for the law of that name.
    pub fn nothing(law: &str) -> Self {
        Self { law: law.to_owned(), whole: [0.0; 2], interior: [0.0; 2] }
    }
}

pub(super) fn serialize<S: Serializer>(lost: &[LostVolume], serializer: S) -> Result<S::Ok, S::Error> {
    serializer.collect_map(lost.iter().flat_map(|lost| {
        let values = [lost.whole[0], lost.whole[1], lost.interior[0], lost.interior[1]];
        let columns = ENDINGS.map(|column| format!("{}{column}", lost.law));
        columns.into_iter().zip(values)
    }))
}

pub(super) fn deserialize<'de, D: Deserializer<'de>>(deserializer: D) -> Result<Vec<LostVolume>, D::Error> {
    let lost = read::<4, D>(deserializer, ENDINGS)?.into_iter();
    Ok(lost.map(|(law, [a, b, c, d])| LostVolume { law, whole: [a, b], interior: [c, d] }).collect())
}

/// Collects the values of the columns of each law.
fn read<'de, const N: usize, D: Deserializer<'de>>(
    deserializer: D,
    endings: [&str; N],
) -> Result<Vec<(String, [CubicMetre; N])>, D::Error> {
    // All columns without a field arrive here, including those of missing numbers.
    let columns = deserializer.deserialize_map(ColumnsInOrder)?;
    let laws = columns.iter().filter_map(|(column, _)| column.strip_suffix(endings[0]));
    laws.map(|law| {
        let mut values = [0.0; N];
        for (value, ending) in values.iter_mut().zip(endings) {
            let column = format!("{law}{ending}");
            let found = columns.iter().find(|(known, _)| *known == column).and_then(|(_, value)| *value);
            *value = found.ok_or_else(|| D::Error::custom(format!("no column `{column}`")))?;
        }
        Ok((law.to_owned(), values))
    })
    .collect()
}

/// Columns in the order of the laws.
struct ColumnsInOrder;

impl<'de> Visitor<'de> for ColumnsInOrder {
    type Value = Vec<(String, Option<CubicMetre>)>;

    fn expecting(&self, formatter: &mut fmt::Formatter) -> fmt::Result {
        formatter.write_str("columns of numbers")
    }

    fn visit_map<A: MapAccess<'de>>(self, mut map: A) -> Result<Self::Value, A::Error> {
        let mut columns = Vec::new();
        while let Some((column, OptionalNumber(value))) = map.next_entry()? {
            columns.push((column, value));
        }
        Ok(columns)
    }
}

/// Columns of the volumes of the whole bodies: two for each law.
pub(super) mod whole {
    use serde::{Deserializer, Serializer};

    use super::{ENDINGS, LostVolume};

    pub(in crate::motion::record) fn serialize<S: Serializer>(
        lost: &[LostVolume],
        serializer: S,
    ) -> Result<S::Ok, S::Error> {
        serializer.collect_map(
            lost.iter().flat_map(|lost| {
                [0, 1].map(|body| (format!("{}{}", lost.law, ENDINGS[body]), lost.whole[body]))
            }),
        )
    }

    pub(in crate::motion::record) fn deserialize<'de, D: Deserializer<'de>>(
        deserializer: D,
    ) -> Result<Vec<LostVolume>, D::Error> {
        let lost = super::read::<2, D>(deserializer, [ENDINGS[0], ENDINGS[1]])?.into_iter();
        Ok(lost.map(|(law, whole)| LostVolume { law, whole, interior: whole }).collect())
    }
}
