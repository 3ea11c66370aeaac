//! Changes of the bodies after a pass: by the laws, over the passes of its extrapolation, and by what they
//! remember.

use std::ops::Range;

use super::Simulation;
use crate::error::{Error, Result};
use crate::grid::Field;
use crate::motion::contact::Contact;
use crate::motion::extrapolation::{self, Bounds, Extrapolation, GridCompliance, LastExtrapolation, Removed};
use crate::motion::law::{self, Heat, Law, PositionData, Sums};
use crate::motion::memory::LoadCycle;
use crate::motion::pass::Pass;
use crate::motion::record::{HeatRecord, LawsInPass, RunningRecord, StepRecord};
use crate::motion::watch::Watch;
use crate::motion::worn_away;
use crate::units::CubicMetre;

/// Message for a pass whose removal is beyond what can be solved with it.
const DEEP_REMOVAL: &str = "a single pass removes more than the width of a cell from a whole body, far beyond the model: check its coefficient, \
     a volume over load and distance, or give a shorter pass";

/// Message for a pass that removes more than explicit steps allow from bodies that remember their contacts.
const FAST_REMOVAL: &str = "a single pass removes so much from bodies that creep or yield in it that their pressures change with it: check the \
     coefficient, a volume over load and distance, or give a shorter pass";

/// Removal in a pass by the laws that repeat.
pub(super) struct PassRemoval {
    compliance_of_grid: GridCompliance,
    /// Number of passes of such removal at which a checkerboard mode of the pressures would not decay with
    /// explicit steps.
    stable: f64,
    /// The depths that an explicit step would have removed, if the pass was solved implicitly.
    explicit: Option<Vec<[Field; 2]>>,
}

impl Simulation {
    /// Solves a pass again, with its removal, if that is too much for an explicit step. The new contacts
    /// replace those of the `outcome`. Returns `None` if no law repeats.
    pub(super) fn solve_with_removal(
        &self,
        outcome: &mut Pass,
        watch: &dyn Watch,
    ) -> Result<Option<PassRemoval>> {
        let Some(compliance_of_grid) = self.compliance_of_grid else { return Ok(None) };
        let position_data = self.position_data();
        let friction = self.motion.friction.map_or(0.0, |friction| friction.coefficient);
        let [_, laws] = self.changes.once_and_repeated();
        if laws.is_empty() {
            return Ok(Some(PassRemoval { compliance_of_grid, stable: f64::INFINITY, explicit: None }));
        }
        // Laws that act at each position remove the depth of one at once.
        let together = match outcome.taken {
            Some(_) => &outcome.contacts[fullest(&outcome.contacts)],
            None => &outcome.contacts[..],
        };
        let distance = position_data.distance;
        let relaxation = extrapolation::relaxation(&outcome.pair, together, laws, friction, distance);
        let stable = compliance_of_grid.checkerboard / relaxation;
        if stable > 0.5 {
            return Ok(Some(PassRemoval { compliance_of_grid, stable, explicit: None }));
        }
        let remembers = outcome.pair.relaxes() || outcome.pair.lubrication().is_some();
        if remembers || outcome.taken.is_some() || self.volumes.is_some() {
            let source = Box::new(Error::Unsupported(FAST_REMOVAL));
            return Err(Error::AtPass { pass: self.passes_done + 1, source });
        }
        let (sums, _) = law::sums(laws, &outcome.pair, &outcome.contacts, &position_data, None)?;
        // The return stroke removes as much again at the same pressures.
        let distance = position_data.distance * (self.positions.len() / self.distinct) as f64;
        let compliance = law::compliance(laws, &outcome.pair, &sums, friction, distance);
        let explicit = law::tried(laws, &outcome.pair, &sums, 1);
        worn_away::check_losses(&outcome.pair, &explicit)?;
        if worn_away::is_deep(&outcome.pair, &explicit) {
            let source = Box::new(Error::Unsupported(DEEP_REMOVAL));
            return Err(Error::AtPass { pass: self.passes_done + 1, source });
        }
        outcome.contacts.truncate(self.distinct);
        outcome.contacts = self.solver(watch).solve_implicitly(outcome, compliance, &self.params)?;
        self.come_back(&mut outcome.contacts);
        Ok(Some(PassRemoval { compliance_of_grid, stable, explicit: Some(explicit) }))
    }

    /// Lets the laws change the bodies after a solved pass, by the number of passes of its extrapolation.
    pub(super) fn advance(
        &self,
        pass: &mut Pass,
        steps: &mut [StepRecord],
        removal: Option<&PassRemoval>,
    ) -> Result<(Option<RunningRecord>, Option<LastExtrapolation>)> {
        let position_data = self.position_data();
        let [flow, laws] = self.changes.once_and_repeated();
        let jumps = self.changes.jumps();
        let is_simple = laws.is_empty() && self.heat.is_none() && !jumps;
        if let Some(taken) = pass.taken.take() {
            self.add_heat(pass, steps, &position_data);
            worn_away::check_cells(&pass.pair, laws)?;
            let worn = law::uncovered(laws, &taken);
            let gone = self.changes.follow(&mut pass.pair, worn, 1, &self.interiors, &mut pass.lost);
            self.uncover(pass, &gone);
            let running = (!is_simple).then(|| self.running(pass, steps, &taken, Extrapolation::ONE));
            return Ok((running, None));
        }
        let mut heat =
            self.heat.as_ref().map(|heat| heat.of_pass(self.passes_done, &pass.pair, position_data.bulk));
        let step = heat.as_deref_mut().map(|heat| heat as &mut Heat);
        let (mut sums, warm) =
            law::sums(&self.changes.laws, &pass.pair, &pass.contacts, &position_data, step)?;
        drop(heat);
        for (contact, temperature) in pass.contacts.iter_mut().zip(warm) {
            contact.temperature = Some(temperature);
        }
        self.add_heat(pass, steps, &position_data);
        let repeated = sums.split_off(flow.len());
        let mut lost = std::mem::take(&mut pass.lost);
        law::advance(flow, &mut pass.pair, &sums, 1.0, &self.interiors, &mut lost[..flow.len()]);
        let flown = lost.iter().flat_map(|lost| lost.whole).sum();
        let mut extrapolation = match removal {
            // Implicit and explicit Euler steps have equal errors of opposite sign.
            Some(PassRemoval { explicit: Some(explicit), .. }) => {
                let taken = law::tried(laws, &pass.pair, &repeated, 1);
                Extrapolation { error: 0.5 * law::difference(explicit, &taken), ..Extrapolation::ONE }
            }
            Some(removal) => self.extrapolate(pass, laws, &repeated, flown, removal),
            None => Extrapolation::ONE,
        };
        let (passes, mean) = (extrapolation.passes, extrapolation.mean.take());
        let mean = mean.as_deref().unwrap_or(&repeated);
        let times = [passes; 2];
        let taken = self.changes.act(laws, &mut pass.pair, mean, times, &self.interiors, &mut lost);
        pass.lost = lost;
        worn_away::check_cells(&pass.pair, laws)?;
        self.uncover(pass, &taken.gone);
        if is_simple {
            return Ok((None, None));
        }
        let running = self.running(pass, steps, &taken.by_laws, extrapolation);
        let extrapolation = jumps.then_some(LastExtrapolation { passes, sums: repeated });
        Ok((Some(running), extrapolation))
    }

    /// Returns the data of the positions of a pass that laws need besides its contacts.
    pub(super) fn position_data(&self) -> PositionData {
        PositionData::new(&self.motion, &self.pair, self.changes.bulk)
    }

    /// Lets the memories look at a solved pass.
    pub(super) fn look(&self, outcome: &mut Pass, watch: &dyn Watch) -> Result<()> {
        let cycle = LoadCycle {
            number: self.passes_done + 1,
            plastic_volumes: outcome.plastic_pass.as_ref().map_or(&[], |pass| &pass.volumes),
            extrapolated: self.warm.extrapolated_passes(),
            stop: &|| watch.stop(),
            ..LoadCycle::of_pass(&outcome.contacts, &self.motion)
        };
        self.changes.look(&cycle, &mut outcome.pair)
    }

    /// Moves the plastic strain below the surfaces up where material above it has gone, by these depths one
    /// after the other.
    pub(super) fn uncover(&self, pass: &mut Pass, gone: &[[Field; 2]]) {
        if let (Some(volumes), Some(plastic)) = (&self.volumes, &mut pass.plastic_pass) {
            gone.iter().for_each(|depth| volumes.uncover(&mut plastic.volumes, &mut pass.pair, depth));
        }
    }

    /// Adds the heat of friction at each position to the `steps`, and to the bodies the temperature for
    /// passes without their own computation.
    fn add_heat(&self, pass: &mut Pass, steps: &mut [StepRecord], position_data: &PositionData) {
        let Some(heat) = &self.heat else { return };
        let PositionData { distance, time, bulk, .. } = *position_data;
        for (step, contact) in steps.iter_mut().zip(&pass.contacts) {
            let warmest = contact.temperature.iter().flatten().copied().reduce(f64::max);
            step.heat = Some(HeatRecord {
                friction_power: contact.tangential_force.abs() * (distance / time),
                max_flash_temperature: warmest.unwrap_or(bulk[0].max(bulk[1])),
            });
        }
        heat.store_in_bodies(self.passes_done, &mut pass.pair, &pass.contacts, bulk);
    }

    /// Describes a pass and its extrapolation, in which the laws that repeat have `taken` these depths.
    fn running(
        &self,
        pass: &Pass,
        steps: &[StepRecord],
        taken: &[[Field; 2]],
        Extrapolation { passes, error, .. }: Extrapolation,
    ) -> RunningRecord {
        let position_data = self.position_data();
        let [_, laws] = self.changes.once_and_repeated();
        let mut of_laws = LawsInPass::default();
        laws.iter().zip(taken).for_each(|(law, taken)| law.record_pass(&pass.pair, taken, &mut of_laws));
        let positions = self.positions.len() as f64;
        let done = (self.represented() + passes) as f64;
        let rubbed = pass.contacts.iter().map(|contact| contact.tangential_force.abs()).sum::<f64>();
        RunningRecord {
            represents: passes,
            time: done * positions * position_data.time,
            distance: done * positions * position_data.distance,
            laws: of_laws,
            friction_work: passes as f64 * rubbed * position_data.distance,
            max_flash_temperature: match steps
                .iter()
                .filter_map(|step| step.heat)
                .map(|heat| heat.max_flash_temperature)
                .reduce(f64::max)
            {
                Some(warmest) => warmest,
                None => position_data.bulk[0].max(position_data.bulk[1]),
            },
            error_estimate: error,
        }
    }

    /// Chooses the number of passes of the extrapolation from the sums of the `laws` and from the plastic
    /// volume.
    fn extrapolate(
        &self,
        pass: &Pass,
        laws: &[Box<dyn Law>],
        sums: &[Sums],
        flown: CubicMetre,
        removal: &PassRemoval,
    ) -> Extrapolation {
        let Some(before) = self.warm.extrapolation.as_ref().filter(|_| self.changes.jumps()) else {
            return Extrapolation::ONE;
        };
        let one = law::tried(laws, &pass.pair, sums, 1);
        let worn = one.iter().flatten().map(|depth| depth.iter().map(|depth| depth.max(0.0)).sum::<f64>());
        let pressures = pass.contacts.iter().flat_map(|contact| &contact.pressure);
        let highest = pressures.fold(0.0, |most: f64, (_, p)| most.max(*p));
        let allowed = self.changes.acceleration.tolerance * removal.compliance_of_grid.single * highest;
        let custom = self.warm.removed.as_ref();
        let by_custom = |value: &dyn Fn(&Removed) -> f64| custom.map_or(0.0, value);
        let deepest = |depths: &[[Field; 2]]| law::deepest(depths).into_iter().fold(0.0, f64::max);
        let worn = worn.sum::<f64>() + by_custom(&Removed::sum);
        let bounds = Bounds {
            left: self.motion.passes - self.represented(),
            volumes: [flown, self.pair.cell_area() * worn],
            deepest: deepest(&one) + by_custom(&|custom| deepest(std::slice::from_ref(&custom.depth))),
            stable: custom.map_or(f64::INFINITY, |custom| custom.within(allowed)).min(removal.stable),
        };
        let mut passes =
            self.changes.acceleration.most(&bounds, before).min(self.changes.most_cycles(&pass.pair)).max(1);
        while passes > 1 {
            let mean = extrapolation::extrapolated(sums, before, passes);
            let error = law::difference(
                &law::tried(laws, &pass.pair, sums, passes),
                &law::tried(laws, &pass.pair, &mean, passes),
            );
            if error <= allowed {
                return Extrapolation { passes, mean: Some(mean), error };
            }
            // The error of the removal grows as the square.
            let fewer = (passes as f64 * (allowed / error).sqrt()) as usize;
            passes = fewer.clamp(1, passes - 1);
        }
        Extrapolation::ONE
    }
}

/// The range of the contact with the most cells.
fn fullest(contacts: &[Contact]) -> Range<usize> {
    let most = (0..contacts.len()).max_by_key(|index| contacts[*index].pressure.len());
    most.map_or(0..0, |index| index..index + 1)
}
