//! Memories of whole load cycles.

use crate::error::Result;
use crate::grid::Field;
use crate::motion::contact::Contact;
use crate::motion::kinematics::Motion;
use crate::motion::law;
use crate::motion::pair::Pair;
use crate::motion::plastic_volume::PlasticVolume;
use crate::motion::record::LostVolume;
use crate::motion::rim::Interior;
use crate::subsurface::Tractions;

/// A memory of the material below the surfaces: what whole load cycles do to it, and what the bodies lose by
/// that in the end.
///
/// A [`Law`](crate::motion::Law) adds up the contacts of a cycle one by one. A memory needs all of them
/// together. Like a law it stores its data in [`Body::state`](crate::motion::Body::state), never in itself.
pub trait Memory: Send + Sync {
    /// Name in results of the volumes that the bodies lose by it, in snake case; `None` if they lose nothing.
    fn takes(&self) -> Option<&str>;

    /// Prepares the bodies before their first cycle: adds the state of the memory if it is missing.
    fn prepare(&self, pair: &mut Pair);

    /// Looks at a solved cycle, before laws change its bodies.
    ///
    /// # Errors
    /// [`Error::Interrupted`](crate::Error::Interrupted), and the reason why it cannot look at the cycle.
    fn look(&self, cycle: &LoadCycle<'_>, pair: &mut Pair) -> Result<()>;

    /// Largest number of cycles, ≥ 1, over which the cycle may be extrapolated.
    fn most_cycles(&self, pair: &Pair) -> f64;

    /// Changes its state by so many `cycles` like the last one, in which the lower and the upper body lost
    /// these depths by laws, m; by these alone if there are 0. Returns the further height that each cell of
    /// the bodies loses, m. The caller lowers the heights.
    fn advance(&self, pair: &mut Pair, cycles: f64, worn: &[Field; 2]) -> [Field; 2];
}

/// A solved load cycle, for memories: a pass of a motion, or a cycle of a loading at rest.
#[derive(Clone, Copy)]
pub struct LoadCycle<'a> {
    pub(super) contacts: Contacts<'a>,
    /// Number of the computed pass, or of the computed cycle of its stage, from 1.
    pub number: usize,
    /// The plastic state below the surfaces after unloading; empty for other than elasto-plastic bodies.
    pub plastic_volumes: &'a [PlasticVolume],
    /// Cycles over which the computed cycle before was extrapolated, itself included; 1 for the first.
    pub extrapolated: f64,
    pub(super) stop: &'a (dyn Fn() -> bool + Sync),
}

#[derive(Clone, Copy)]
pub(super) enum Contacts<'a> {
    OfPass(&'a [Contact], &'a Motion),
    AtRest(&'a [Tractions]),
}

impl<'a> LoadCycle<'a> {
    /// Creates the first pass of a `motion` from its contacts, position by position.
    pub fn of_pass(contacts: &'a [Contact], motion: &'a Motion) -> Self {
        Self::first(Contacts::OfPass(contacts, motion))
    }

    /// Creates the first cycle of two bodies at rest from the tractions on the lower one, contact by contact.
    pub fn at_rest(contacts: &'a [Tractions]) -> Self {
        Self::first(Contacts::AtRest(contacts))
    }

    /// Lets the memories stop where this says so.
    #[must_use]
    pub fn until(self, stop: &'a (dyn Fn() -> bool + Sync)) -> Self {
        Self { stop, ..self }
    }

    fn first(contacts: Contacts<'a>) -> Self {
        Self { contacts, number: 1, plastic_volumes: &[], extrapolated: 1.0, stop: &|| false }
    }

    /// Number of contacts, ≥ 1.
    pub fn contacts(&self) -> usize {
        match self.contacts {
            Contacts::OfPass(contacts, _) => contacts.len(),
            Contacts::AtRest(contacts) => contacts.len(),
        }
    }

    /// Returns the tractions on a body of the `pair`, 0 the lower or 1 the upper one, in a contact, by its
    /// index.
    pub fn tractions(&self, contact: usize, pair: &Pair, body: usize) -> Tractions {
        let on_lower = match self.contacts {
            Contacts::AtRest(contacts) => contacts[contact].clone(),
            Contacts::OfPass(contacts, motion) => {
                let contact = &contacts[contact];
                let sliding = motion.sliding(contact.position.stroke);
                let Tractions { pressure, shear } = contact.tractions(pair.lower.width(), sliding.as_ref());
                let placement = pair.placements(&contact.position)[body];
                let onto = |traction: Field| placement.onto(&traction);
                Tractions { pressure: onto(pressure), shear: shear.map(|shear| shear.map(onto)) }
            }
        };
        if body == 0 { on_lower } else { on_lower.on_upper() }
    }

    /// Whether the computation is to end.
    pub fn stop(&self) -> bool {
        (self.stop)()
    }
}

/// Lets the `memories` go on by so many `cycles` in which laws that uncover material have taken the depth
/// `worn` from both bodies, `None` without such laws. Returns the volumes that the bodies lose by it, and
/// their depths.
pub(super) fn advance(
    memories: &[Box<dyn Memory>],
    pair: &mut Pair,
    cycles: f64,
    worn: Option<&[Field; 2]>,
    interiors: &[Interior; 2],
) -> Vec<(LostVolume, [Field; 2])> {
    if memories.is_empty() {
        return Vec::new();
    }
    let unworn;
    let worn = match worn {
        Some(worn) => worn,
        None => {
            unworn = [&pair.lower, &pair.upper].map(|body| Field::zeros(body.heights.raw_dim()));
            &unworn
        }
    };
    let mut lost = Vec::new();
    for memory in memories {
        let depth = memory.advance(pair, cycles, worn);
        if let Some(name) = memory.takes() {
            let mut volume = LostVolume::nothing(name);
            law::remove(pair, &depth, interiors, &mut volume);
            lost.push((volume, depth));
        }
    }
    lost
}
