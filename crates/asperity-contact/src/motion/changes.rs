//! Changes of the bodies of a course by its contacts.

use crate::error::{Error, Result};
use crate::grid::Field;
use crate::motion::extrapolation::Acceleration;
use crate::motion::law::{self, Law, Sums};
use crate::motion::memory::{self, LoadCycle, Memory};
use crate::motion::pair::Pair;
use crate::motion::record::LostVolume;
use crate::motion::rim::Interior;
use crate::temperature::Thermal;
use crate::units::Kelvin;

/// Changes of the bodies of a course by its contacts: laws, memories of whole load cycles, the heat of
/// friction, and the extrapolation over passes or cycles that are not computed. One list serves passes,
/// loadings in stages and sliding in place.
pub struct Changes {
    /// The laws; the ones that act once for each computed pass come first.
    pub(super) laws: Vec<Box<dyn Law>>,
    pub(super) memories: Vec<Box<dyn Memory>>,
    pub(super) acceleration: Acceleration,
    /// Temperatures of the lower and of the upper body, NaN if they are unknown.
    pub(super) bulk: [Kelvin; 2],
    pub(super) heat: Option<FrictionalHeat>,
}

/// Heating by friction.
#[derive(Debug, Clone, Copy)]
pub(super) struct FrictionalHeat {
    /// Thermal constants of the lower and of the upper body.
    pub(super) thermal: [Thermal; 2],
    /// Interval of the computed passes with a temperature of their own, ≥ 1.
    pub(super) every: usize,
}

/// Result of one action of the laws and of the memories.
pub(super) struct Taken {
    /// Depth that each law has taken from both bodies.
    pub(super) by_laws: Vec<[Field; 2]>,
    /// Depths of material that have gone, one after the other: by laws that uncover what is below, then by
    /// each memory.
    pub(super) gone: Vec<[Field; 2]>,
}

impl Default for Changes {
    fn default() -> Self {
        let (laws, memories) = (Vec::new(), Vec::new());
        Self { laws, memories, acceleration: Acceleration::NONE, bulk: [f64::NAN; 2], heat: None }
    }
}

impl Changes {
    /// Changes by one law.
    pub fn by(law: impl Law + 'static) -> Self {
        Self::default().with_law(law)
    }

    /// Adds a law. It acts after those before it, but a law that does not [repeat](Law::repeats) acts before
    /// those that do: an extrapolation depends on their results.
    #[must_use]
    pub fn with_law(self, law: impl Law + 'static) -> Self {
        self.with_laws(vec![Box::new(law)])
    }

    /// Adds several laws, as [`Self::with_law`] does.
    #[must_use]
    pub fn with_laws(mut self, laws: Vec<Box<dyn Law>>) -> Self {
        for law in laws {
            let place = if law.repeats() { self.laws.len() } else { law::once(&self.laws) };
            self.laws.insert(place, law);
        }
        self
    }

    /// Adds memories of whole load cycles: of passes, and of the cycles of a loading.
    #[must_use]
    pub fn with_memories(mut self, memories: Vec<Box<dyn Memory>>) -> Self {
        self.memories.extend(memories);
        self
    }

    /// Lets computed passes, and computed cycles of a loading, stand for several.
    #[must_use]
    pub fn with_acceleration(self, acceleration: Acceleration) -> Self {
        Self { acceleration, ..self }
    }

    /// Sets the temperatures of the lower and of the upper body, > 0, far from their contact.
    #[must_use]
    pub fn with_bulk(self, bulk: [Kelvin; 2]) -> Self {
        Self { bulk, ..self }
    }

    /// Adds the heat of friction in bodies with these thermal constants, lower one first. Laws then see the
    /// temperature of the cells in contact: the flash temperature of passes, computed in the first and in
    /// each `every`-th computed pass, ≥ 1, with the mean of the last such pass in between; the steady
    /// temperature of each update of a contact that slides in place; in the cycles of a loading the steady
    /// temperature by the mean heat of the last computed cycle. It needs friction, the temperatures of the
    /// bodies, and a speed or a period.
    #[must_use]
    pub fn with_heat(self, thermal: [Thermal; 2], every: usize) -> Self {
        Self { heat: Some(FrictionalHeat { thermal, every }), ..self }
    }

    /// Whether nothing changes, is remembered or warms up.
    pub(super) fn is_empty(&self) -> bool {
        self.laws.is_empty() && self.memories.is_empty() && self.heat.is_none()
    }

    /// Whether the heights of the bodies change.
    pub(super) fn removes(&self) -> bool {
        !self.laws.is_empty() || self.memories.iter().any(|memory| memory.takes().is_some())
    }

    /// Whether an extrapolation is allowed.
    pub(super) fn jumps(&self) -> bool {
        self.acceleration.max_jump > 1
    }

    /// Higher one of the temperatures of the bodies.
    pub(super) fn warmer_bulk(&self) -> Kelvin {
        self.bulk[0].max(self.bulk[1])
    }

    /// Returns what frictional heating needs; `None` without it.
    ///
    /// # Errors
    /// [`Error::Unsupported`] if the temperatures of the bodies are unknown, or if there is no friction or no
    /// speed.
    pub(super) fn heated(&self, rubs: bool) -> Result<Option<FrictionalHeat>> {
        match self.heat {
            Some(_) if !rubs || self.bulk.iter().any(|kelvin| kelvin.is_nan()) => Err(Error::Unsupported(
                "a flash temperature needs friction, a speed and the temperatures of the bodies",
            )),
            heat => Ok(heat),
        }
    }

    /// Checks the limits of the extrapolation, and adds the states of laws and memories to the bodies.
    ///
    /// # Errors
    /// [`Error::OutOfRange`](crate::Error::OutOfRange).
    pub(super) fn prepare(&mut self, pair: &mut Pair) -> Result<()> {
        self.acceleration = self.acceleration.checked()?;
        self.laws.iter_mut().for_each(|law| law.prepare(pair));
        self.memories.iter().for_each(|memory| memory.prepare(pair));
        Ok(())
    }

    /// The laws that act once for each computed pass, and those that act in the extrapolated passes, too.
    pub(super) fn once_and_repeated(&self) -> [&[Box<dyn Law>]; 2] {
        self.laws.split_at(law::once(&self.laws)).into()
    }

    /// Lets the memories look at a load cycle.
    pub(super) fn look(&self, cycle: &LoadCycle<'_>, pair: &mut Pair) -> Result<()> {
        self.memories.iter().try_for_each(|memory| memory.look(cycle, pair))
    }

    /// Largest number of cycles, ≥ 1, over which the memories allow a cycle to be extrapolated.
    pub(super) fn most_cycles(&self, pair: &Pair) -> usize {
        self.memories.iter().map(|memory| memory.most_cycles(pair)).fold(f64::INFINITY, f64::min) as usize
    }

    /// Lets the `laws`, the last ones of the list, change a `pair` by so many `times` with these sums, and
    /// then the memories by so many `cycles`. Adds the volumes of the laws to `lost`, and those of the
    /// memories behind them.
    pub(super) fn act(
        &self,
        laws: &[Box<dyn Law>],
        pair: &mut Pair,
        sums: &[Sums],
        [times, cycles]: [usize; 2],
        interiors: &[Interior; 2],
        lost: &mut Vec<LostVolume>,
    ) -> Taken {
        let first = lost.len() - laws.len();
        let by_laws = law::advance(laws, pair, sums, times as f64, interiors, &mut lost[first..]);
        let gone = self.follow(pair, law::uncovered(laws, &by_laws), cycles, interiors, lost);
        Taken { by_laws, gone }
    }

    /// Lets the memories go on by so many `cycles`, in which laws that uncover material have taken the depth
    /// `worn` from both bodies, `None` without such laws. Adds the volumes that the bodies lose by that to
    /// `lost`, and returns the depths of all material that has gone.
    pub(super) fn follow(
        &self,
        pair: &mut Pair,
        worn: Option<[Field; 2]>,
        cycles: usize,
        interiors: &[Interior; 2],
        lost: &mut Vec<LostVolume>,
    ) -> Vec<[Field; 2]> {
        let broken_out = memory::advance(&self.memories, pair, cycles as f64, worn.as_ref(), interiors);
        let mut gone: Vec<[Field; 2]> = worn.into_iter().collect();
        for (volume, depth) in broken_out {
            lost.push(volume);
            gone.push(depth);
        }
        gone
    }
}
