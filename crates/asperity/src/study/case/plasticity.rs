//! `[lower.plasticity]`, `[upper.plasticity]` and `[plasticity]`: bodies that flow below their surfaces.

use serde::Serialize;

use super::cursor::{Entry, Table};
use super::schema::plasticity::{flow, volume as keys};
use super::schema::tables::known_in;
use super::{Body, CounterBody, FrictionSpec, Hardness, MotionSpec};
use crate::choice::choice;
use crate::error::Result;
use crate::material::Coating;
use crate::motion::{PlasticUpdate, Strategy};
use crate::operator::Boundary;
use crate::plasticity::{FlowParams, Hardening, J2, Layers};
use crate::units::{Dimension, Metre, Pascal};

/// How a body flows: von Mises' yield criterion, with hardening of both kinds.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[non_exhaustive]
pub struct FlowSpec {
    /// The yield stress over the plastic strain.
    #[serde(flatten)]
    pub hardening: HardeningKey,
    /// Prager's modulus of the back stress, ≥ 0.
    pub kinematic: Pascal,
    /// Armstrong's and Frederick's recovery of the back stress, ≥ 0.
    pub recovery: f64,
}

/// The yield stress over the plastic strain: by two keys, or by a measured curve.
#[derive(Debug, Clone, PartialEq, Serialize)]
#[serde(untagged)]
pub enum HardeningKey {
    /// A line.
    Linear {
        /// Yield stress of the virgin body in tension, > 0.
        yield_stress: Pascal,
        /// Its growth with the plastic strain, ≥ 0.
        hardening: Pascal,
    },
    /// Straight lines between measured points, level beyond the last.
    Curve {
        /// Plastic strains, from 0 on, rising, and the stresses there, not falling.
        curve: Vec<(f64, Pascal)>,
    },
}

/// The volumes that may flow, and how far the plastic strain is to be found.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[non_exhaustive]
pub struct PlasticitySpec {
    /// Depth of the volume that may flow.
    pub depth: Metre,
    /// Number of its layers, 1 to 512.
    pub layers: usize,
    /// Thickness of a layer over that of the one above, 1 to 2.
    pub growth: f64,
    /// Equal steps of the load of a static contact, ≥ 1; none with friction, which has them, nor in a motion.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub increments: Option<usize>,
    /// Largest mismatch of the stress over the yield stress, 0 < tolerance < 1.
    pub tolerance: f64,
    /// Whether the load of a static contact is taken off at the end; none in a motion, where it is.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub unload: Option<bool>,
    /// Of which passes of a motion the volumes are kept; none of a contact at rest.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub keep: Option<Keep>,
}

/// The passes of a motion whose volumes are kept.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Keep {
    /// The last one.
    Last,
    /// All of them.
    Passes,
}

choice!(Keep: "last" => Last, "passes" => Passes);

/// `[lower.plasticity]` in the table of a body that is as stiff as `young`.
pub(super) fn flow(
    table: &Table<'_>,
    body: &Table<'_>,
    young: Pascal,
    hardness: &Hardness,
    coating: Option<&Coating>,
) -> Result<FlowSpec> {
    known_in(table)?;
    if !young.is_finite() {
        let hint = Some("give it a finite 'young', or leave its plasticity out".to_owned());
        return Err(table.error("a rigid body does not flow".to_owned(), hint));
    }
    if let Some(entry) = body.get("hardness").filter(|_| hardness.yields()) {
        let hint = Some("leave 'hardness' out, or the plasticity".to_owned());
        return Err(entry.error("a body that flows below its surface has no 'hardness'".to_owned(), hint));
    }
    if coating.is_some() {
        let hint = Some("leave the coating or the plasticity out".to_owned());
        return Err(table.error("flow under a coating is not known yet".to_owned(), hint));
    }
    let hint = "for example `yield_stress = \"1.5 GPa\"`";
    let hardening = match table.exactly_one(&["yield_stress", "curve"], hint)? {
        "curve" => {
            if let Some(entry) = flow::HARDENING.entry(table) {
                let hint = Some("the curve has the hardening: leave this key out".to_owned());
                return Err(entry.error("'hardening' has no meaning beside a 'curve'".to_owned(), hint));
            }
            HardeningKey::Curve { curve: flow::CURVE.required(table)? }
        }
        _ => HardeningKey::Linear {
            yield_stress: flow::YIELD_STRESS.required(table)?,
            hardening: flow::HARDENING.of(table)?,
        },
    };
    let (kinematic, recovery) = (flow::KINEMATIC.of(table)?, flow::RECOVERY.of(table)?);
    if let Some(entry) = flow::RECOVERY.entry(table).filter(|_| recovery > 0.0 && kinematic == 0.0) {
        let hint = Some("give a modulus `kinematic`, or leave 'recovery' out".to_owned());
        let message = "'recovery' is that of a back stress, of which there is none".to_owned();
        return Err(entry.error(message, hint));
    }
    Ok(FlowSpec { hardening, kinematic, recovery })
}

/// A measured curve of the yield stress.
pub(super) fn curve(entry: &Entry<'_>) -> Result<Vec<(f64, Pascal)>> {
    const EXPECTED: &str =
        "points of plastic strain and stress such as [[0, \"1.5 GPa\"], [0.01, \"1.7 GPa\"]]";
    let point = |item: &Entry<'_>| -> Result<(f64, Pascal)> {
        let values = item.items(EXPECTED)?;
        match values.as_slice() {
            [strain, stress] => Ok((
                strain.number(|strain| strain >= 0.0, "a plastic strain of at least 0")?,
                stress.positive(Dimension::Pressure)?,
            )),
            _ => Err(item.unexpected(EXPECTED, None)),
        }
    };
    let points = entry.list(EXPECTED, point)?;
    let first = points.first().ok_or_else(|| entry.unexpected(EXPECTED, None))?;
    let hint = |text: &str| Some(text.to_owned());
    if first.0 != 0.0 {
        return Err(entry.error(
            "the first point of 'curve' has a plastic strain above 0".to_owned(),
            hint("it begins with the yield stress of the virgin body, `[0, \"1.5 GPa\"]`"),
        ));
    }
    if points.windows(2).any(|pair| pair[1].0 <= pair[0].0) {
        return Err(entry.error("the strains of 'curve' do not rise from point to point".to_owned(), None));
    }
    if points.windows(2).any(|pair| pair[1].1 < pair[0].1) {
        let softens = hint("a body that softens flows in bands, which depend on the cells: level the curve");
        return Err(entry.error("the stresses of 'curve' fall".to_owned(), softens));
    }
    Ok(points)
}

/// `[plasticity]`, of bodies of which one flows; with what it changes in their `motion` and `friction`.
pub(super) fn plasticity(
    root: &Table<'_>,
    bodies: [&Body; 2],
    boundary: Boundary,
    motion: &mut Option<MotionSpec>,
    friction: &mut Option<FrictionSpec>,
) -> Result<Option<PlasticitySpec>> {
    let flows = ["lower", "upper"].into_iter().zip(bodies).find(|(_, body)| body.plasticity.is_some());
    let table = root.table("plasticity")?;
    let (name, table) = match (flows, table) {
        (None, None) => return Ok(None),
        (None, Some(table)) => {
            let hint = "give a body `[lower.plasticity]` with its `yield_stress`, or leave [plasticity] out";
            return Err(
                table.error("no body flows: neither has a plasticity".to_owned(), Some(hint.to_owned()))
            );
        }
        (Some((name, _)), None) => {
            let hint = "for example `[plasticity]` with `depth = \"20 um\"` and `layers = 16`";
            let message = format!("missing table [plasticity]: [{name}.plasticity] has no volume to flow in");
            return Err(flow_table(root, name)?.error(message, Some(hint.to_owned())));
        }
        (Some((name, _)), Some(table)) => (name, table),
    };
    known_in(&table)?;
    suits(root, name, bodies)?;
    if let Some(entry) = root.required_table("contact")?.get("boundary")
        && boundary.repeats(0) != boundary.repeats(1)
    {
        let message = "a boundary periodic along one axis alone has no plastic strain yet";
        let hint = "use \"free\" or \"periodic\", or give the bodies a `hardness`".to_owned();
        return Err(entry.error(message.to_owned(), Some(hint)));
    }
    let (depth, layers) = (keys::DEPTH.of(&table)?, keys::LAYERS.of(&table)?);
    if let Some(motion) = motion {
        moves(root, &table, bodies, boundary, motion)?;
    } else if let Some(entry) = keys::KEEP.entry(&table) {
        let hint = Some("leave it out: a contact at rest has one volume, that of its end".to_owned());
        return Err(entry.error("'keep' is that of the passes of a [motion]".to_owned(), hint));
    }
    let at_rest = motion.is_none();
    let increments = keys::INCREMENTS.of(&table)?;
    if let Some(friction) = friction.as_mut().filter(|_| at_rest) {
        rubs(root, &table, friction, increments)?;
    }
    Ok(Some(PlasticitySpec {
        depth,
        layers,
        growth: keys::GROWTH.of(&table)?,
        increments: (at_rest && friction.is_none()).then_some(increments),
        tolerance: keys::TOLERANCE.of(&table)?,
        unload: at_rest.then_some(keys::UNLOAD.of(&table)?),
        keep: (!at_rest).then_some(keys::KEEP.of(&table)?),
    }))
}

/// An error where bodies that flow have what goes with a hardness alone.
fn suits(root: &Table<'_>, name: &str, bodies: [&Body; 2]) -> Result<()> {
    let contact = root.required_table("contact")?;
    for (other, body) in ["lower", "upper"].into_iter().zip(bodies) {
        let table = root.required_table(other)?;
        if let Some(entry) = table.get("hardness").filter(|_| body.hardness.yields()) {
            let hint = Some("give this body a plasticity, or neither of them".to_owned());
            let message =
                format!("[{name}] flows below its surface: 'hardness' has no meaning on either body");
            return Err(entry.error(message, hint));
        }
        if body.material.coating.is_some() {
            let hint = Some("leave the coating or the plasticity out".to_owned());
            return Err(table
                .required("coating", "")?
                .error("flow beside a coating is not known yet".to_owned(), hint));
        }
        for key in ["wear", "film"] {
            if let Some(table) = table.table(key)? {
                let hint = Some("leave the plasticity out, and give the bodies a `hardness`".to_owned());
                return Err(
                    table.error(format!("bodies that flow below their surfaces have no {key} yet"), hint)
                );
            }
        }
    }
    if let Some(table) = root.table("temperature")? {
        let hint = Some("leave [temperature] or the plasticity out".to_owned());
        let message = "a flash temperature is that of bodies that stay as they are in a pass".to_owned();
        return Err(table.error(message, hint));
    }
    if let Some(entry) = ["loads", "mean_pressures", "approaches"].iter().find_map(|key| contact.get(key)) {
        let hint = Some("give stages in a [[history]]".to_owned());
        return Err(entry.error("bodies that flow keep what has flowed: they have no sweep".to_owned(), hint));
    }
    Ok(())
}

/// A motion of bodies that flow: they do at every position.
fn moves(
    root: &Table<'_>,
    table: &Table<'_>,
    bodies: [&Body; 2],
    boundary: Boundary,
    motion: &mut MotionSpec,
) -> Result<()> {
    let of_motion = root.required_table("motion")?;
    if let Some(entry) = ["increments", "unload"].iter().find_map(|key| table.get(key)) {
        let message = format!("'{}' is that of a contact at rest", entry.key());
        let hint = "leave it out: in a [motion] the bodies flow position by position, and each pass ends without load";
        return Err(entry.error(message, Some(hint.to_owned())));
    }
    if let Some(entry) = of_motion.get("plastic_update")
        && motion.plastic_update == PlasticUpdate::Pass
    {
        let hint = Some("leave it out, or set `plastic_update = \"step\"`".to_owned());
        let message = "bodies that flow below their surfaces do so at every position".to_owned();
        return Err(entry.error(message, hint));
    }
    if motion.counter == CounterBody::Fresh && bodies[1].plasticity.is_some() {
        let hint = Some("leave the plasticity of the upper body out, or 'counter'".to_owned());
        let message = "an upper body that is another in each pass does not keep what has flowed".to_owned();
        return Err(of_motion.required("counter", "\"same\"")?.error(message, hint));
    }
    if motion.strategy != Strategy::Overlap && !boundary.repeats(0) {
        let hint = Some("set `boundary = \"periodic\"` in [contact]".to_owned());
        let message = "plastic strain goes round with the surfaces of a shift: their boundary is periodic";
        return Err(of_motion.required("strategy", "\"shift\"")?.error(message.to_owned(), hint));
    }
    motion.plastic_update = PlasticUpdate::Step;
    Ok(())
}

/// Friction of bodies that flow: their load comes in the steps of the volume, unless it has its own.
fn rubs(root: &Table<'_>, table: &Table<'_>, friction: &mut FrictionSpec, increments: usize) -> Result<()> {
    let of_friction = root.required_table("friction")?;
    if friction.rolls() || !friction.creepages.is_empty() {
        let hint = "move the bodies in a [motion], where one rolls over the other at a speed of 0";
        let message = "the steady state of rolling is that of bodies that do not flow".to_owned();
        return Err(of_friction.error(message, Some(hint.to_owned())));
    }
    match (of_friction.get("increments"), table.get("increments")) {
        (Some(_), Some(entry)) => {
            let hint = Some("leave it out: those of [friction] count".to_owned());
            Err(entry.error("'increments' is given in [plasticity] and in [friction]".to_owned(), hint))
        }
        (Some(_), None) => Ok(()),
        (None, _) => {
            friction.increments = increments;
            Ok(())
        }
    }
}

/// The table of a body's plasticity.
fn flow_table<'a>(root: &Table<'a>, name: &str) -> Result<Table<'a>> {
    root.required_table(name)?.required_table("plasticity")
}

impl FlowSpec {
    /// The flow law.
    pub(in crate::study) fn law(&self) -> Result<J2> {
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
    /// The layers of the volume that may flow.
    pub(in crate::study) fn layers(&self) -> Result<Layers> {
        Layers::new(self.depth, self.layers, self.growth)
    }

    /// When an increment is done.
    pub(in crate::study) fn params(&self) -> FlowParams {
        FlowParams::new().with_tolerance(self.tolerance)
    }
}
