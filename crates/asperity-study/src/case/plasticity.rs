//! `[lower.plasticity]`, `[upper.plasticity]` and `[plasticity]`: elasto-plastic bodies.

use serde::Serialize;

use super::cursor::Table;
use super::schema::loading::friction::INCREMENTS;
use super::schema::plasticity::{body as of_body, volume as keys};
use super::schema::tables::known_in;
use super::schema::values::plasticity::Keep;
use super::{FrictionSpec, MotionSpec};
use asperity_base::error::Result;
use asperity_base::units::{Metre, Pascal};
use asperity_contact::motion::PlasticUpdate;
use asperity_contact::plasticity::{Hardening, J2, Layers, PlasticParams};

/// Flow law of a body: von Mises' yield criterion, with isotropic and kinematic hardening.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct YieldSpec {
    /// Yield stress as a function of the plastic strain.
    #[serde(flatten)]
    pub hardening: HardeningKey,
    /// Prager's modulus of the back stress, ≥ 0.
    pub kinematic: Pascal,
    /// Armstrong's and Frederick's recovery of the back stress, ≥ 0.
    pub recovery: f64,
}

/// Yield stress as a function of the plastic strain: by two keys, or by a measured curve.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
pub enum HardeningKey {
    /// Linear hardening.
    Linear {
        /// Yield stress of the virgin body in tension, > 0.
        yield_stress: Pascal,
        /// Its increase per plastic strain, ≥ 0.
        hardening: Pascal,
    },
    /// Straight lines between measured points, constant beyond the last.
    Curve {
        /// Plastic strains, from 0, increasing, and the stresses there, not decreasing.
        curve: Vec<(f64, Pascal)>,
    },
}

/// The plastic volumes, and the tolerance of the plastic strain.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[non_exhaustive]
pub struct PlasticitySpec {
    /// Depth of the plastic volume.
    pub depth: Metre,
    /// Number of its layers, 1 to 512.
    pub layers: usize,
    /// Ratio of the thickness of a layer to that of the one above, 1 to 2.
    pub growth: f64,
    /// Number of equal load steps of a static contact, ≥ 1; `None` with friction, which sets them, and in a motion.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub increments: Option<usize>,
    /// Largest return-mapping residual over the yield stress, 0 < tolerance < 1.
    pub tolerance: f64,
    /// Whether a static contact is unloaded at the end; `None` in a motion, which always unloads.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub unload: Option<bool>,
    /// The passes of a motion whose volumes are kept; `None` for a static contact.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub keep: Option<Keep>,
}

/// `[lower.plasticity]`.
pub(super) fn yielding(table: &Table<'_>) -> Result<YieldSpec> {
    known_in(table)?;
    let hint = "for example `yield_stress = \"1.5 GPa\"`";
    let hardening = match table.exactly_one(&["yield_stress", "curve"], hint)? {
        "curve" => {
            if let Some(entry) = of_body::HARDENING.entry(table) {
                let hint = Some("the curve has the hardening: leave this key out".to_owned());
                return Err(entry.error("'hardening' has no meaning beside a 'curve'".to_owned(), hint));
            }
            HardeningKey::Curve { curve: of_body::CURVE.required(table)? }
        }
        _ => HardeningKey::Linear {
            yield_stress: of_body::YIELD_STRESS.required(table)?,
            hardening: of_body::HARDENING.of(table)?,
        },
    };
    let (kinematic, recovery) = (of_body::KINEMATIC.of(table)?, of_body::RECOVERY.of(table)?);
    if let Some(entry) = of_body::RECOVERY.entry(table).filter(|_| recovery > 0.0 && kinematic == 0.0) {
        let hint = Some("give a modulus `kinematic`, or leave 'recovery' out".to_owned());
        let message = "'recovery' needs a back stress".to_owned();
        return Err(entry.error(message, hint));
    }
    Ok(YieldSpec { hardening, kinematic, recovery })
}

/// `[plasticity]`, with its effect on the `motion` of the bodies and on their `friction`.
pub(super) fn plasticity(
    table: &Table<'_>,
    root: &Table<'_>,
    motion: &mut Option<MotionSpec>,
    friction: &mut Option<FrictionSpec>,
) -> Result<PlasticitySpec> {
    known_in(table)?;
    let at_rest = motion.is_none();
    let increments = keys::INCREMENTS.of(table)?;
    if let Some(motion) = motion {
        // Plastic flow occurs at every position.
        motion.plastic_update = PlasticUpdate::Step;
    } else if let (Some(friction), Some(of_friction)) = (friction.as_mut(), root.table("friction")?)
        && INCREMENTS.entry(&of_friction).is_none()
    {
        // The load is applied in the steps of the volume.
        friction.increments = increments;
    }
    Ok(PlasticitySpec {
        depth: keys::DEPTH.of(table)?,
        layers: keys::LAYERS.of(table)?,
        growth: keys::GROWTH.of(table)?,
        increments: (at_rest && friction.is_none()).then_some(increments),
        tolerance: keys::TOLERANCE.of(table)?,
        unload: at_rest.then_some(keys::UNLOAD.of(table)?),
        keep: (!at_rest).then_some(keys::KEEP.of(table)?),
    })
}

impl YieldSpec {
    /// Returns the law by which the body yields.
    pub(crate) fn law(&self) -> Result<J2> {
        let hardening = match &self.hardening {
            HardeningKey::Linear { yield_stress, hardening } => Hardening::linear(*yield_stress, *hardening)?,
            HardeningKey::Curve { curve } => Hardening::curve(curve)?,
        };
        match self.kinematic {
            0.0 => Ok(J2::new(hardening)),
            modulus => J2::new(hardening).with_back_stress(modulus, self.recovery),
        }
    }

    /// Yield stress of the virgin body in tension.
    pub fn yield_stress(&self) -> Pascal {
        match &self.hardening {
            HardeningKey::Linear { yield_stress, .. } => *yield_stress,
            HardeningKey::Curve { curve } => curve[0].1,
        }
    }
}

impl PlasticitySpec {
    /// Returns the layers of the plastic volume.
    pub(crate) fn layers(&self) -> Result<Layers> {
        Layers::new(self.depth, self.layers, self.growth)
    }

    /// Returns the convergence criteria of an increment.
    pub(crate) fn params(&self) -> PlasticParams {
        PlasticParams::new().with_tolerance(self.tolerance)
    }
}
