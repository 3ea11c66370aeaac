//! Elasto-plastic bodies of a case: the tables `[lower.plasticity]`, `[upper.plasticity]` and `[plasticity]`.
//!
//! The laws are in [`crate::plasticity`].

use serde::Serialize;

use crate::error::Result;
use crate::plasticity::{Hardening, J2, Layers, PlasticParams};
use crate::units::{Dimension, Metre, Pascal};
use asperity_base::beside::{Beside, Scale};
use asperity_base::choice::choice;
use asperity_base::exists;
use asperity_base::table::{Bounds, Exists, Key, Kind, Source, Value, list};
use asperity_derive::{Part, Table};

/// Flow law of a body: von Mises' yield criterion, with isotropic and kinematic hardening.
#[derive(Table, Debug, Clone, PartialEq, Serialize)]
#[table("lower.plasticity", "upper.plasticity", check = together)]
#[non_exhaustive]
pub struct Yielding {
    /// Yield stress as a function of the plastic strain.
    #[key(part)]
    #[serde(flatten)]
    pub yields: YieldKey,
    /// Increase of the yield stress per plastic strain, E·Eₜ/(E − Eₜ) for a tangent modulus Eₜ; with
    /// `yield_stress`.
    ///
    /// 0 beside a curve, which has the hardening.
    #[key(
        quantity = Pressure,
        range = FromZero,
        written = "0",
        example = "\"20 GPa\"",
        exists = HARDENING,
        beside = [HARDENS, Beside::most(Scale::Young, 1.0, "no solid hardens so much")]
    )]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub hardening: Option<Pascal>,
    /// Modulus M of the back stress by Prager, ⅔Mε.
    #[key(
        quantity = Pressure,
        range = FromZero,
        default = 0.0,
        written = "0",
        example = "\"20 GPa\"",
        exists = HARDENING,
        beside = [HARDENS]
    )]
    pub kinematic: Pascal,
    /// Recovery of the back stress by Armstrong and Frederick; with `kinematic`.
    #[key(number = "a number", range = FromZero, default = 0.0, written = "0", example = "50")]
    pub recovery: f64,
}

/// Yield stress as a function of the plastic strain.
#[derive(Part, Debug, Clone, PartialEq, Serialize)]
#[part(
    absent = "exactly one of `yield_stress` and `curve`",
    hint = "for example `yield_stress = \"1.5 GPa\"`"
)]
#[serde(rename_all = "snake_case")]
pub enum YieldKey {
    /// Yield stress in tension σ_Y of the virgin body.
    #[key(quantity = Pressure, range = AboveZero, example = "\"1.5 GPa\"", exists = YIELD, beside = [SOFT])]
    YieldStress(Pascal),
    /// Increasing points of plastic strain and yield stress, from strain 0; constant beyond the last.
    ///
    /// Straight lines between measured points, whose stresses do not decrease.
    #[key(
        special = curve,
        form = "list of points `[strain, stress]`",
        example = "[[0, \"1.5 GPa\"], [0.01, \"1.7 GPa\"]]"
    )]
    Curve(Vec<(f64, Pascal)>),
}

/// The plastic volumes, and the tolerance of the plastic strain.
#[derive(Table, Debug, Clone, Copy, PartialEq, Serialize)]
#[table("plasticity")]
#[non_exhaustive]
pub struct PlasticRegion {
    /// Depth of the volume that may deform plastically, from one cell to the smaller side of the grid; 2.5
    /// radii of the largest spot are enough.
    #[key(quantity = Length, range = AboveZero, example = "\"20 um\"", exists = exists::LENGTH)]
    pub depth: Metre,
    /// Number of layers.
    #[key(count = 1, most = 512, example = "16")]
    pub layers: usize,
    /// Ratio of the thickness of a layer to that of the layer above.
    #[key(
        number = "a number",
        range = Between { least: 1.0, most: 2.0, open: [false, false] },
        default = 1.0,
        written = "1",
        example = "1.2"
    )]
    pub growth: f64,
    /// Static: equal steps of the loading in \[contact\], of each \[\[history\]\] stage without its own
    /// number, and of the unloading.
    ///
    /// `None` with friction, which sets them, and in a motion.
    #[key(count = 1, written = "16", example = "32")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub increments: Option<usize>,
    /// Return-mapping residual over the yield stress at which an increment has converged.
    #[key(
        number = "a number",
        range = Between { least: 0.0, most: 1.0, open: [true, true] },
        default = 1e-4,
        written = "1e-4",
        example = "1e-5"
    )]
    pub tolerance: f64,
    /// Static: whether the contact is unloaded at the end.
    ///
    /// `None` in a motion, which always unloads.
    #[key(flag, written = "true", example = "false")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub unload: Option<bool>,
    /// \[motion\] only: whether the volumes of the last pass or of all passes are stored.
    ///
    /// `None` for a static contact.
    #[key(choice, written = "\"last\"", example = "\"passes\"")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub keep: Option<Keep>,
}

/// The passes of a motion whose volumes are stored.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Keep {
    /// The last one.
    Last,
    /// All of them.
    Passes,
}

choice!(Keep: "last" => Last, "passes" => Passes);

const YIELD: Exists =
    Exists::Within { least: 1e5, most: 2e10, of: "soft solder to whiskers", slips: &["MPa", "GPa"] };
/// Ashby, Materials Selection in Mechanical Design: yield strain 10⁻⁴ of annealed metals to 0.05 of polymers.
const SOFT: Beside = Beside::within(
    Scale::Young,
    [3e-5, 0.1],
    ["no solid of this modulus is so soft", "no solid of this modulus is so hard"],
);
const HARDENS: Beside = Beside::least(Scale::Key("yield_stress"), 1e-2, "it changes nothing");
const HARDENING: Exists =
    Exists::Within { least: 1e5, most: 1e12, of: "polymers to cold-worked steel", slips: &["MPa", "GPa"] };

/// Steps of the loading without `increments`.
pub const INCREMENTS: usize = 16;

/// Checks which keys go together, with their errors at the entries.
fn together(read: &Yielding, source: &dyn Source) -> Result<()> {
    if matches!(read.yields, YieldKey::Curve(_))
        && let Some(value) = source.value("hardening")
    {
        let hint = "the curve has the hardening: leave this key out";
        return Err(value.error("'hardening' has no meaning beside a 'curve'", Some(hint)));
    }
    let is_alone = read.recovery > 0.0 && read.kinematic == 0.0;
    match source.value("recovery").filter(|_| is_alone) {
        Some(value) => {
            let hint = "give a modulus `kinematic`, or leave 'recovery' out";
            Err(value.error("'recovery' needs a back stress", Some(hint)))
        }
        None => Ok(()),
    }
}

/// A measured curve of the yield stress.
fn curve(value: &dyn Value, key: &Key) -> Result<Vec<(f64, Pascal)>> {
    const EXPECTED: &str =
        "points of plastic strain and stress such as [[0, \"1.5 GPa\"], [0.01, \"1.7 GPa\"]]";
    const STRAIN: Kind = Kind::Number("a plastic strain", Bounds::FromZero);
    const STRESS: Kind = Kind::Quantity(Dimension::Pressure, Bounds::AboveZero);
    let point = |item: &dyn Value| match item.items(EXPECTED)?.as_slice() {
        [strain, stress] => Ok((strain.real(key, &STRAIN)?, stress.real(key, &STRESS)?)),
        _ => Err(item.unexpected(EXPECTED, None)),
    };
    let points = list(value, EXPECTED, point)?;
    let first = points.first().ok_or_else(|| value.unexpected(EXPECTED, None))?;
    if first.0 != 0.0 {
        return Err(value.error(
            "the first point of 'curve' has a plastic strain above 0",
            Some("begin with the yield stress of the virgin body, `[0, \"1.5 GPa\"]`"),
        ));
    }
    if points.windows(2).any(|pair| pair[1].0 <= pair[0].0) {
        return Err(value.error("the strains of 'curve' do not increase from point to point", None));
    }
    if points.windows(2).any(|pair| pair[1].1 < pair[0].1) {
        let softens = "a falling curve localises strain in bands whose width depends on the grid: make the curve constant there";
        return Err(value.error("the stresses of 'curve' fall", Some(softens)));
    }
    Ok(points)
}

impl Yielding {
    /// Returns the law with the hardening that holds where the table gives none.
    pub fn resolved(self) -> Self {
        let hardening = match self.yields {
            YieldKey::YieldStress(_) => self.hardening.or(Some(0.0)),
            YieldKey::Curve(_) => None,
        };
        Self { hardening, ..self }
    }

    /// Returns the law by which the body yields.
    ///
    /// # Errors
    /// The errors of [`Hardening`] and [`J2`].
    pub fn law(&self) -> Result<J2> {
        let hardening = match &self.yields {
            YieldKey::YieldStress(stress) => Hardening::linear(*stress, self.hardening.unwrap_or(0.0))?,
            YieldKey::Curve(curve) => Hardening::curve(curve)?,
        };
        match self.kinematic {
            0.0 => Ok(J2::new(hardening)),
            modulus => J2::new(hardening).with_back_stress(modulus, self.recovery),
        }
    }

    /// Yield stress of the virgin body in tension.
    pub fn yield_stress(&self) -> Pascal {
        match &self.yields {
            YieldKey::YieldStress(stress) => *stress,
            YieldKey::Curve(curve) => curve[0].1,
        }
    }
}

impl PlasticRegion {
    /// Returns the layers of the plastic volume.
    ///
    /// # Errors
    /// The errors of [`Layers::new`].
    pub fn layers(&self) -> Result<Layers> {
        Layers::new(self.depth, self.layers, self.growth)
    }

    /// Returns the convergence criteria of an increment.
    pub fn params(&self) -> PlasticParams {
        PlasticParams::new().with_tolerance(self.tolerance)
    }
}
