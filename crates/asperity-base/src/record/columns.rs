//! The declaration of columns. The fields of a record are the columns of its table and the keys of
//! `summary.json`.

/// A column of a table, or a number of `summary.json`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Column {
    /// Name: the head of the column, the key in `summary.json`.
    pub name: &'static str,
    /// SI unit: `"1"` for a pure number or a count, empty for a text.
    pub unit: &'static str,
    /// Meaning, in a sentence.
    pub text: &'static str,
    /// Names of the components: none for a number, `x` and `y` for a vector, `lower` and `upper` for both
    /// bodies.
    pub components: &'static [&'static str],
    /// Whether each record has the column.
    pub presence: Presence,
    /// How a value of the whole motion follows from the rows of its passes.
    pub over_motion: OverMotion,
}

/// How a value of a whole motion follows from the rows of its passes, each of which represents one pass or
/// several.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum OverMotion {
    /// It does not: the value is that of the last pass.
    LastPass,
    /// The value is a state after the pass, or a total since the start: that of the last row.
    State,
    /// The values add up.
    Sum,
    /// The values add up, each as often as the passes that its row represents.
    SumOfPasses,
    /// The value grows with the passes that its row represents, but does not add up: the value of a single
    /// pass at the end.
    MeanOfPass,
}

/// Whether a record has a value in a column.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Presence {
    /// Every record has a value.
    Always,
    /// The value may be unknown: an empty cell of a table, `null` in `summary.json`.
    Unknown,
    /// The column may be left out.
    Optional,
}

impl Column {
    /// A column that holds a number in each record.
    pub const fn new(name: &'static str, unit: &'static str, text: &'static str) -> Self {
        let (presence, over_motion) = (Presence::Always, OverMotion::LastPass);
        Self { name, unit, text, components: &[], presence, over_motion }
    }

    /// Names the components of a vector.
    pub const fn axes(components: usize) -> &'static [&'static str] {
        match components {
            2 => &["x", "y"],
            _ => &["x", "y", "z"],
        }
    }
}

/// Part of a record: a column, or a group of them.
pub struct Part {
    /// Its columns.
    pub columns: &'static [Column],
    /// Whether the part is a group that may be missing.
    pub is_group: bool,
}

impl Part {
    /// Counts the columns of the parts, with or without the groups.
    pub const fn count(parts: &[Self], with_groups: bool) -> usize {
        let (mut count, mut k) = (0, 0);
        while k < parts.len() {
            if with_groups || !parts[k].is_group {
                count += parts[k].columns.len();
            }
            k += 1;
        }
        count
    }

    /// Joins the columns of the parts, `N` = [`Part::count`] of them.
    pub const fn join<const N: usize>(parts: &[Self], with_groups: bool) -> [Column; N] {
        let mut columns = [Column::new("", "", ""); N];
        let (mut count, mut k) = (0, 0);
        while k < parts.len() {
            let mut of_part = 0;
            while of_part < parts[k].columns.len() && (with_groups || !parts[k].is_group) {
                columns[count] = parts[k].columns[of_part];
                count += 1;
                of_part += 1;
            }
            k += 1;
        }
        columns
    }
}

/// Declares a record: each field is a column with its unit (by its type) and its meaning (its documentation).
///
/// The record has the constants `OWN_COLUMNS` and `COLUMNS`. `COLUMNS` includes the columns of its groups, in
/// the order in which they are written. Attributes of `serde` mark values that may be missing, see
/// [`Presence`]:
///
/// - `deserialize_with = "number_or_none"` or `"known_or_none"`, or an `Option` without attributes: the value may be unknown,
/// - any other attribute of an `Option`: the column may be left out,
/// - `flatten`, with or without `skip_serializing_if`: a group of columns that may be missing.
///
/// Before them, `#[over_motion(Sum)]` says how a value of a whole motion follows from the passes, see
/// [`OverMotion`].
#[macro_export]
macro_rules! columns {
    (
        $(#[$attribute:meta])*
        pub struct $record:ident {
            $(
                $(#[doc = $text:literal])+
                $(#[over_motion($over:ident)])?
                $(#[serde($($serde:tt)*)])?
                pub $name:ident: $type:tt $(<$($of:tt),+>)?,
            )*
        }
    ) => {
        $(#[$attribute])*
        pub struct $record {
            $(
                $(#[doc = $text])+
                $(#[serde($($serde)*)])?
                pub $name: $type $(<$($of),+>)?,
            )*
        }

        impl $record {
            /// Columns of a record without its groups.
            pub const OWN_COLUMNS: &'static [$crate::record::Column] =
                &$crate::record::Part::join::<{ $crate::record::Part::count(Self::PARTS, false) }>(Self::PARTS, false);
            /// Columns of a record with all groups, in the order in which they are written.
            pub const COLUMNS: &'static [$crate::record::Column] =
                &$crate::record::Part::join::<{ $crate::record::Part::count(Self::PARTS, true) }>(Self::PARTS, true);
            const PARTS: &'static [$crate::record::Part] = &[$(
                $crate::columns!(@part [$($($serde)*)?] $name [$type $($($of)+)?] [$($over)?] $($text)+)
            ),*];
        }
    };
    (@part [flatten, skip_serializing_if = "Option::is_none"] $name:ident [Option $group:tt] $over:tt $($text:tt)+) => {
        $crate::record::Part { columns: $group::COLUMNS, is_group: true }
    };
    (@part [flatten] $name:ident [$group:tt] $over:tt $($text:tt)+) => {
        $crate::record::Part { columns: $group::COLUMNS, is_group: true }
    };
    (@part [flatten, with = "lost_volumes"] $name:ident $type:tt $over:tt $($text:tt)+) => {
        $crate::record::Part { columns: LostVolume::IN_A_PASS, is_group: false }
    };
    (@part [flatten, with = "lost_volumes::whole"] $name:ident $type:tt $over:tt $($text:tt)+) => {
        $crate::record::Part { columns: LostVolume::SO_FAR, is_group: false }
    };
    (@part $serde:tt $name:ident $type:tt $over:tt $($text:tt)+) => {
        $crate::record::Part {
            columns: &[$crate::record::Column {
                name: stringify!($name),
                unit: $crate::columns!(@unit $type),
                text: concat!($($text),+).trim_ascii(),
                components: $crate::columns!(@components $type),
                presence: $crate::columns!(@presence $serde $type),
                over_motion: $crate::columns!(@over $over),
            }],
            is_group: false,
        }
    };
    (@presence [deserialize_with = "number_or_none"] $type:tt) => { $crate::record::Presence::Unknown };
    (@presence [deserialize_with = "known_or_none"] [Option $of:tt]) => { $crate::record::Presence::Unknown };
    (@presence [] [Option $of:tt]) => { $crate::record::Presence::Unknown };
    (@presence $serde:tt [Option $of:tt]) => { $crate::record::Presence::Optional };
    (@presence $serde:tt $type:tt) => { $crate::record::Presence::Always };
    (@over []) => { $crate::record::OverMotion::LastPass };
    (@over [$over:ident]) => { $crate::record::OverMotion::$over };
    (@components [Option $of:tt]) => { $crate::columns!(@components [$of]) };
    (@components [BTreeMap String [$of:tt; 2]]) => { &["lower", "upper"] };
    (@components [[$of:tt; $components:tt]]) => { $crate::record::Column::axes($components) };
    (@components $type:tt) => { &[] };
    (@unit [Option $of:tt]) => { $crate::columns!(@unit [$of]) };
    (@unit [BTreeMap String $of:tt]) => { $crate::columns!(@unit [$of]) };
    (@unit [[$of:tt; $components:tt]]) => { $crate::columns!(@unit [$of]) };
    (@unit [bool]) => { "" };
    (@unit [Regime]) => { "" };
    (@unit [Theory]) => { "" };
    (@unit [Axis]) => { "" };
    (@unit [OnBody]) => { "" };
    (@unit [usize]) => { "1" };
    (@unit [f64]) => { "1" };
    (@unit [Metre]) => { "m" };
    (@unit [SquareMetre]) => { "m²" };
    (@unit [CubicMetre]) => { "m³" };
    (@unit [PerMetre]) => { "1/m" };
    (@unit [Pascal]) => { "Pa" };
    (@unit [Newton]) => { "N" };
    (@unit [NewtonMetre]) => { "N m" };
    (@unit [NewtonPerMetre]) => { "N/m" };
    (@unit [Joule]) => { "J" };
    (@unit [Second]) => { "s" };
    (@unit [Kelvin]) => { "K" };
    (@unit [Watt]) => { "W" };
    (@unit [MetrePerSecond]) => { "m/s" };
    (@unit [CubicMetrePerSecond]) => { "m³/s" };
}
