//! The tables `[fatigue]`, `[lower.fatigue]` and `[upper.fatigue]`.

use serde::Serialize;

use super::{Basquin, DangVan};
use crate::error::Result;
use crate::units::{Metre, Pascal};
use crate::with::BodyProperty;
use asperity_base::beside::{Beside, DEEPEST, DEPTH, Scale};
use asperity_base::exists;
use asperity_base::table::{Bounds, Exists, Key, Kind, Source, Value, list, require};
use asperity_derive::Table;

/// Fatigue below the surfaces of bodies under loads that repeat: in the passes of a motion, or in the cycles
/// of a history.
#[derive(Table, Debug, Clone, PartialEq, Serialize)]
#[table("fatigue")]
#[non_exhaustive]
pub struct Fatigue {
    /// Largest depth, below which nothing is looked at.
    #[key(quantity = Length, range = AboveZero, example = "\"8 um\"", exists = exists::LAYER, beside = [DEPTH, DEEPEST])]
    pub to: Metre,
    /// Number of depths, geometric from half a cell, or from the lowest interface of a body with thicker layers, to the
    /// largest.
    #[key(count = 1, default = 8, example = "12")]
    pub layers: usize,
    /// Interval of the positions of a pass, or of the increments of a cycle, whose stress is computed.
    #[key(count = 1, default = 1, example = "2")]
    pub every: usize,
    /// Passes, or cycles of each stage, that are looked at, counted as they are computed.
    #[key(
        special = passes,
        form = "list of whole numbers ≥ 1",
        default = Vec::new(),
        absent = "all computed ones",
        example = "[1, 100]"
    )]
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub passes: Vec<usize>,
}

/// Limits of a material under loads that alternate.
#[derive(Table, Debug, Clone, Copy, PartialEq, Serialize)]
#[table("lower.fatigue", "upper.fatigue", check = limits)]
#[non_exhaustive]
pub struct FatigueLimits {
    /// Limit τ₋₁ in alternating torsion: an amplitude.
    #[key(quantity = Pressure, range = AboveZero, example = "\"350 MPa\"", exists = STRENGTH)]
    pub torsion: Pascal,
    /// Limit σ₋₁ in alternating tension: an amplitude, at most twice that in torsion.
    #[key(quantity = Pressure, range = AboveZero, example = "\"600 MPa\"", exists = STRENGTH, beside = [TENSION])]
    pub tension: Pascal,
    /// Exponent m of Basquin's law: a pass or cycle does the damage (f/b)^m/N₀.
    #[key(
        number = "a number",
        range = Between { least: 0.0, most: 100.0, open: [true, false] },
        default = 10.0,
        example = "8",
        exists = EXPONENT
    )]
    pub exponent: f64,
    /// Cycles N₀ that a material endures at the limit.
    #[key(number = "a number", range = AboveZero, default = 2e6, example = "1e7", exists = CYCLES)]
    pub cycles: f64,
    /// Whether there is no damage below the limit.
    #[key(flag, default = false, example = "true")]
    pub endurance: bool,
    /// Largest depth from which material breaks out where the damage reaches 1; 0 only reports it.
    #[key(
        quantity = Length,
        range = FromZero,
        default = 0.0,
        written = "\"0 um\"",
        example = "\"5 um\"",
        exists = Exists::Any("a choice of the user: how deep a crack counts as a micropit"),
        beside = [DEPTH, DEEPEST]
    )]
    pub pit_depth: Metre,
    /// Whether the life is compared to that of the bodies without their roughness.
    #[key(flag, default = false, example = "true")]
    pub risk: bool,
}

/// Ashby, Materials Selection in Mechanical Design: endurance limits of soft polymers to hardened steels,
/// with a margin.
const STRENGTH: Exists =
    Exists::Within { least: 1e5, most: 5e9, of: "soft polymers to hardened steels", slips: &["MPa"] };

/// Stephens, Fatemi, Stephens, Fuchs, Metal Fatigue in Engineering: 3 of welds to about 25 of smooth steel
/// and ceramics.
const EXPONENT: Exists = Exists::Within { least: 2.0, most: 40.0, of: "welds to ceramics", slips: &[] };
const CYCLES: Exists =
    Exists::Within { least: 3e4, most: 5e9, of: "the knee of soft metals to very high cycles", slips: &[] };
/// A brittle material fails under the same amplitude of the largest stress, so that both limits are equal.
const TENSION: Beside =
    Beside::least(Scale::Key("torsion"), 0.8, "no material bears more torsion than tension");

fn passes(value: &dyn Value, key: &Key) -> Result<Vec<usize>> {
    let one = |item: &dyn Value| match item.real(key, &Kind::Number("a whole number", Bounds::AboveZero))? {
        number if number.fract() == 0.0 && number < 1e15 => Ok(number as usize),
        _ => Err(item.unexpected("a whole number of at least 1", None)),
    };
    list(value, "a list of passes such as [1, 100]", one)
}

fn limits(read: &FatigueLimits, source: &dyn Source) -> Result<()> {
    let is_limit = read.tension <= 2.0 * read.torsion;
    require(source, "tension", is_limit, "at most twice the limit in `torsion`", None)
}

impl BodyProperty for FatigueLimits {
    const NAME: &'static str = "fatigue";
    const MEANING: &'static str = "limits of the material under alternating loads, see [fatigue](#fatigue)";
    const WITHOUT: &'static str = "not looked at";

    fn breaks_out(&self) -> bool {
        self.pit_depth > 0.0
    }
}

impl FatigueLimits {
    /// Returns the criterion of the material.
    ///
    /// # Errors
    /// [`Error::OutOfRange`](crate::Error::OutOfRange).
    pub fn criterion(&self) -> Result<DangVan> {
        DangVan::new(self.torsion, self.tension)
    }

    /// Returns the law of the damage of a load cycle.
    ///
    /// # Errors
    /// [`Error::OutOfRange`](crate::Error::OutOfRange).
    pub fn damage(&self) -> Result<Basquin> {
        Basquin::new(self.exponent, self.cycles, self.endurance)
    }
}

impl Fatigue {
    /// Returns the depths below the layers of a body, ascending, on a grid with this pitch.
    pub fn depths(&self, pitch: [Metre; 2], layers: Metre) -> Vec<Metre> {
        let first = layers.max(0.5 * pitch[0].min(pitch[1]));
        if self.layers == 1 || self.to <= first {
            return vec![self.to];
        }
        let step = (self.to / first).powf(1.0 / (self.layers - 1) as f64);
        (0..self.layers).map(|k| first * step.powi(k as i32)).collect()
    }

    /// Whether it looks at a load cycle, by the number of the computed pass, or of the computed cycle of its
    /// stage.
    pub fn wants(&self, number: usize) -> bool {
        self.passes.is_empty() || self.passes.contains(&number)
    }
}
