//! Changes of the bodies in a loading. Laws change them where they slip by less than the size of the contact.
//! Memories look at whole cycles.
//!
//! In a stage the laws act after each increment. In a cycle the bodies are frozen: the laws sum over its
//! increments and act at its end, for the cycle itself or for several at once, with the slip of the computed
//! one. The pressures change with the removal of these cycles. The depth of a cell follows from the mean of
//! its pressures on the bodies before and after them (the trapezoidal rule), of which the second is found as
//! a contact with [`Compliant`] cells. Any number of cycles is stable.

use crate::error::Result;
use crate::grid::{CellValues, Field};
use crate::motion::changes::{Changes, FrictionalHeat};
use crate::motion::cycle_heat::{CycleHeat, CyclicTemperature};
use crate::motion::extrapolation::{self, Bounds, GridCompliance, LastExtrapolation};
use crate::motion::kinematics::Strategy;
use crate::motion::law::{self, CyclicSlip, Law, Sums};
use crate::motion::memory::LoadCycle;
use crate::motion::pair::Pair;
use crate::motion::plastic_volume::PlasticVolume;
use crate::motion::record::{FrettingRecord, HeatRecord, LawsInCycles};
use crate::motion::rim::Interior;
use crate::motion::worn_away;
use crate::operator::{Boundary, Compliant, Operator, Operators};
use crate::solver::{Before, Control, Equilibrium, FrictionalSolution, NormalProblem, Params, Solution};
use crate::subsurface::Tractions;
use crate::units::{Joule, Metre, Second};

/// Changes of the bodies of a loading by slip.
pub(super) struct Fretting {
    changes: Changes,
    heat: Option<CyclicTemperature>,
    interiors: [Interior; 2],
    operator: Box<dyn Operator>,
    compliance: GridCompliance,
    params: Params,
}

/// Bodies that have changed so far, and the present cycle.
#[derive(Debug, Clone)]
pub struct ChangedBodies {
    /// The bodies.
    pub pair: Pair,
    /// Sums of each law over the increments of the present cycle.
    pub sums: Vec<Sums>,
    /// The last computed cycle of the present stage.
    pub last: Option<LastCycle>,
    /// Energy dissipated by friction so far, with the cycles that were not computed.
    pub work: Joule,
    /// The part of the present cycle of it.
    pub cycle_work: Joule,
    /// Estimate of the error of the heights so far.
    pub error: Metre,
    /// Cycles of all stages so far.
    pub cycles: usize,
    /// Computed cycles of the present stage.
    pub computed: usize,
    /// Heat of friction; `None` if its temperature is not computed.
    pub heat: Option<CycleHeat>,
    /// Tractions on the lower body in the contacts of the present cycle, from that at its beginning; empty
    /// without memories.
    pub contacts: Vec<Tractions>,
}

/// The last computed cycle, needed to choose how many cycles the next one stands for.
#[derive(Debug, Clone)]
pub struct LastCycle {
    /// Cycles that it stands for, and its sums of each law.
    pub extrapolation: LastExtrapolation,
    /// Pressure at its end, Pa.
    pub pressure: Field,
    /// Energy that friction took in it.
    pub work: Joule,
}

impl Fretting {
    pub(super) fn new(
        pair: &mut Pair,
        mut changes: Changes,
        (operators, boundary, params): (&Operators, Boundary, Params),
    ) -> Result<Self> {
        changes.prepare(pair)?;
        let (grid, shape) = (pair.lower_grid(), pair.lower_grid().shape);
        let heat = changes.heated(true)?.map(|FrictionalHeat { thermal, .. }| {
            CyclicTemperature::new(grid, thermal, boundary, changes.bulk)
        });
        Ok(Self {
            heat: heat.transpose()?,
            changes,
            interiors: Interior::of_bodies([shape; 2], boundary, Strategy::Overlap, 0.0),
            operator: operators.on(shape),
            compliance: GridCompliance::new(pair, boundary),
            params,
        })
    }

    /// The bodies before the first increment.
    pub(super) fn begin(&self, pair: Pair) -> ChangedBodies {
        let sums = law::nothing(&self.changes.laws, &pair);
        let heat = self.heat.as_ref().map(|_| CycleHeat::nothing(&pair.lower_grid()));
        ChangedBodies {
            heat,
            pair,
            sums,
            last: None,
            work: 0.0,
            cycle_work: 0.0,
            error: 0.0,
            cycles: 0,
            computed: 0,
            contacts: Vec::new(),
        }
    }

    /// The laws, memories and heat of the loading.
    pub(super) fn changes(&self) -> &Changes {
        &self.changes
    }

    /// Prepares bodies that come from a file.
    pub(super) fn resume(&mut self, bodies: &mut ChangedBodies) -> Result<()> {
        self.changes.prepare(&mut bodies.pair)
    }

    /// Adds an increment to the sums of the laws: its slip since the contact `before`, in this `time`.
    pub(super) fn add(
        &self,
        bodies: &mut ChangedBodies,
        contact: &FrictionalSolution,
        before: Option<&FrictionalSolution>,
        time: Second,
    ) {
        let slip = CyclicSlip::from_contact(contact, before);
        let temperature = match (&self.heat, &bodies.heat) {
            (Some(steady), Some(heat)) => steady.of_cells(heat, &slip.cells),
            _ => self.changes.bulk.map(|bulk| vec![bulk; slip.cells.len()]),
        };
        law::add_slip(&self.changes.laws, &bodies.pair, &slip, time, &temperature, &mut bodies.sums);
        if let Some(heat) = &mut bodies.heat {
            heat.add(&slip);
        }
    }

    /// Adds a contact to those of the present cycle, which begins with the contact `before` if it is on the
    /// same bodies.
    pub(super) fn see(
        &self,
        bodies: &mut ChangedBodies,
        contact: &Equilibrium,
        before: Option<&Equilibrium>,
    ) {
        if self.changes.memories.is_empty() {
            return;
        }
        let tractions = |contact: &Equilibrium| {
            let shear = contact.shear().map_or([None, None], |shear| shear.map(Some));
            Tractions { pressure: contact.normal().pressure.clone(), shear }
        };
        if bodies.contacts.is_empty() {
            bodies.contacts.extend(before.map(tractions));
        }
        bodies.contacts.push(tractions(contact));
    }

    /// Computes the temperature by the heat of the cycle of this `period` that ends with a `contact`, if it
    /// is requested.
    pub(super) fn warm(
        &mut self,
        bodies: &mut ChangedBodies,
        contact: &Solution,
        period: Second,
    ) -> Result<()> {
        match (&mut self.heat, &mut bodies.heat) {
            (Some(steady), Some(heat)) => steady.end(heat, contact, period),
            _ => Ok(()),
        }
    }

    /// Lets the memories look at the cycle that has ended.
    pub(super) fn look(
        &self,
        bodies: &mut ChangedBodies,
        plastic_volumes: &[PlasticVolume],
        stop: &(dyn Fn() -> bool + Sync),
    ) -> Result<()> {
        bodies.computed += 1;
        let contacts = std::mem::take(&mut bodies.contacts);
        let cycle = LoadCycle {
            number: bodies.computed,
            extrapolated: bodies.last.as_ref().map_or(1.0, |last| last.extrapolation.passes as f64),
            stop,
            plastic_volumes,
            ..LoadCycle::at_rest(&contacts)
        };
        self.changes.look(&cycle, &mut bodies.pair)
    }

    /// Lets the laws act once for their sums, which begin anew. Returns the depths of the material that has
    /// gone from both bodies.
    pub(super) fn act_once(&self, bodies: &mut ChangedBodies) -> Result<Vec<[Field; 2]>> {
        let sums = std::mem::replace(&mut bodies.sums, law::nothing(&self.changes.laws, &bodies.pair));
        if let Some(heat) = &mut bodies.heat {
            // The heat of a stage takes no known time.
            heat.taken.fill(0.0);
        }
        worn_away::check_losses(&bodies.pair, &law::tried(&self.changes.laws, &bodies.pair, &sums, 1))?;
        Ok(self.act(bodies, &sums, 1, 0))
    }

    /// Lets the laws act at the end of a cycle, after those of its stage that are `done`, over the `gap`
    /// between the bodies before the load, flattened as far as they are, under the same load or at the same
    /// approach. Returns the number of cycles that it stands for, of the `left` ones, and the depths of the
    /// material that has gone from both bodies.
    pub(super) fn act_for_cycles(
        &mut self,
        bodies: &mut ChangedBodies,
        contact: &Solution,
        (gap, control): (&Field, Control),
        [done, left]: [usize; 2],
    ) -> Result<(usize, Vec<[Field; 2]>)> {
        /// Cycles at the beginning of a stage that stand for themselves: the first one still remembers how
        /// the loading came there.
        const SETTLING: usize = 2;
        let sums = std::mem::replace(&mut bodies.sums, law::nothing(&self.changes.laws, &bodies.pair));
        let one = law::tried(&self.changes.laws, &bodies.pair, &sums, 1);
        worn_away::check_losses(&bodies.pair, &one)?;
        let bounds = Bounds {
            left,
            volumes: [0.0, 1.0],
            deepest: law::deepest(&one).into_iter().fold(0.0, f64::max),
            stable: f64::INFINITY,
        };
        let most = bodies.last.as_ref().filter(|_| done >= SETTLING && self.changes.jumps());
        let most = most.map_or(1, |last| self.changes.acceleration.most(&bounds, &last.extrapolation));
        let mut cycles = most.min(self.changes.most_cycles(&bodies.pair)).max(1);
        let highest = contact.pressure.iter().copied().fold(0.0, f64::max);
        let allowed = self.changes.acceleration.tolerance * self.compliance.single * highest;
        let (implicit, error) = loop {
            let of_slip = self.with_slip(bodies, &contact.pressure, &sums, cycles);
            let implicit = self.implicitly(bodies, contact, (gap, control), of_slip.clone(), cycles)?;
            let error = self.error(bodies, &sums, [&of_slip, &implicit], cycles);
            if cycles == 1 || error <= allowed {
                break (implicit, error);
            }
            // The error grows as the square.
            let fewer = (cycles as f64 * (allowed / error).sqrt()) as usize;
            cycles = fewer.clamp(1, cycles - 1);
        };
        let gone = self.act(bodies, &implicit, cycles, cycles);
        let (work, several) = (bodies.cycle_work, cycles as f64);
        let growth = bodies
            .last
            .as_ref()
            .filter(|_| cycles > 1)
            .map_or(0.0, |last| 0.5 * several / last.extrapolation.passes as f64 * (work - last.work));
        // One of the cycles has been counted.
        bodies.work += several * (work + growth) - work;
        bodies.cycle_work = 0.0;
        let extrapolation = LastExtrapolation { passes: cycles, sums };
        bodies.last = Some(LastCycle { extrapolation, pressure: contact.pressure.clone(), work });
        bodies.error += error;
        bodies.cycles += cycles;
        Ok((cycles, gone))
    }

    /// Returns the sums of a cycle over so many `cycles`, in the mean of the pressures before and after their
    /// removal, from those with the pressures before.
    fn implicitly(
        &mut self,
        bodies: &ChangedBodies,
        normal: &Solution,
        (gap, control): (&Field, Control),
        mut sums: Vec<Sums>,
        cycles: usize,
    ) -> Result<Vec<Sums>> {
        if !self.changes.laws.iter().any(|law| follows_pressure(law.as_ref())) {
            return Ok(sums);
        }
        let one = law::tried(&self.changes.laws, &bodies.pair, &sums, 1);
        let mut depth = Field::zeros(normal.pressure.raw_dim());
        for ([lower, upper], _) in
            one.iter().zip(&self.changes.laws).filter(|(_, law)| follows_pressure(law.as_ref()))
        {
            depth += lower;
            depth += upper;
        }
        // Half of the removal is that of the pressures before, half is in proportion to those after.
        let half = 0.5 * cycles as f64;
        let mut compliance = depth.clone();
        compliance.zip_mut_with(&normal.pressure, |depth, pressure| {
            *depth = if *pressure > 0.0 { half * *depth / pressure } else { 0.0 };
        });
        // The gap under the shear, whose contact without removal is the present one.
        let mut of_pressure = Field::zeros(normal.pressure.raw_dim());
        self.operator.apply(&normal.pressure, &mut of_pressure);
        let gap = gap + &normal.displacement - &of_pressure + half * depth;
        let mut operator = Compliant::new(self.operator.as_mut(), CellValues::Field(compliance))?;
        let interface = bodies.pair.interface();
        let attracted = (!interface.is_hard()).then(|| Solution {
            initial_gap: gap.clone(),
            displacement: of_pressure,
            ..normal.clone()
        });
        let before = attracted.as_ref().map_or(Before::Guess(&normal.pressure), Before::Contact);
        let (bounds, params) = (&normal.bounds, &self.params);
        let problem = NormalProblem { gap: &gap, bounds, control, before, params, watch: &() };
        let worn = interface.solve(&mut operator, &problem)?;
        for (sums, _) in
            sums.iter_mut().zip(&self.changes.laws).filter(|(_, law)| follows_pressure(law.as_ref()))
        {
            for of_body in sums.iter_mut() {
                ndarray::Zip::from(&mut of_body[0]).and(&worn.pressure).and(&normal.pressure).for_each(
                    |sum, worn, before| {
                        *sum *= if *before > 0.0 { 0.5 + 0.5 * worn.max(0.0) / before } else { 1.0 };
                    },
                );
            }
        }
        Ok(sums)
    }

    /// Returns the sums of a cycle, in the mean over so many `cycles`, with the slip that goes on changing as
    /// since the computed cycle before. The pressures stay.
    fn with_slip(&self, bodies: &ChangedBodies, pressure: &Field, sums: &[Sums], cycles: usize) -> Vec<Sums> {
        let mut changing = sums.to_vec();
        let Some(last) = bodies.last.as_ref().filter(|_| cycles > 1) else { return changing };
        let factor = 0.5 * cycles as f64 / last.extrapolation.passes as f64;
        let laws = self.changes.laws.iter().zip(&mut changing).zip(&last.extrapolation.sums);
        for ((_, sums), then) in laws.filter(|((law, _), _)| follows_pressure(law.as_ref())) {
            for (sum, then) in sums.iter_mut().zip(then) {
                ndarray::Zip::from(&mut sum[0]).and(&then[0]).and(&last.pressure).and(pressure).for_each(
                    |sum, then, before, now| {
                        if *before > 0.0 {
                            *sum = (*sum + factor * (*sum - then * now.max(0.0) / before)).max(0.0);
                        }
                    },
                );
            }
        }
        changing
    }

    /// Estimates the error of the heights by so many `cycles` at once from the sums of the cycle, from those
    /// with the change of the slip, and from those with that of the pressures, too. It is the larger one of
    /// two differences: between the last ones and an explicit step, whose sums change as since the computed
    /// cycle before; and between the sums with and without the change of the slip.
    fn error(
        &self,
        bodies: &ChangedBodies,
        sums: &[Sums],
        [of_slip, implicit]: [&[Sums]; 2],
        cycles: usize,
    ) -> Metre {
        let tried = |sums: &[Sums]| law::tried(&self.changes.laws, &bodies.pair, sums, cycles);
        let explicit = match &bodies.last {
            Some(last) => tried(&extrapolation::extrapolated(sums, &last.extrapolation, cycles)),
            None => tried(sums),
        };
        let of_slip = law::difference(&tried(of_slip), &tried(sums));
        law::difference(&explicit, &tried(implicit)).max(of_slip)
    }

    /// Lets the laws act for their `sums` over so many `times`, and the memories go on by so many `cycles`.
    /// Returns the depths of the material that has gone from both bodies, one after the other.
    fn act(&self, bodies: &mut ChangedBodies, sums: &[Sums], times: usize, cycles: usize) -> Vec<[Field; 2]> {
        let laws = &self.changes.laws;
        let (mut lost, times) = (law::nothing_lost(laws), [times, cycles]);
        self.changes.act(laws, &mut bodies.pair, sums, times, &self.interiors, &mut lost).gone
    }

    /// Describes the heat of the last computed cycle, if its temperature is requested.
    pub(super) fn heat_record(&self, bodies: &ChangedBodies) -> Option<HeatRecord> {
        let heat = bodies.heat.as_ref()?;
        let warmest = heat.warmest().unwrap_or(self.changes.warmer_bulk());
        Some(HeatRecord { friction_power: heat.power, max_flash_temperature: warmest })
    }

    /// Describes the bodies after an increment.
    pub(super) fn record(&self, bodies: &ChangedBodies) -> FrettingRecord {
        let mut columns = LawsInCycles::default();
        self.changes.laws.iter().for_each(|law| law.record_cycles(&bodies.pair, &mut columns));
        FrettingRecord::new(bodies.cycles, columns, bodies.work, bodies.error)
    }
}

/// Whether the first sum of a law is in proportion to the pressure.
fn follows_pressure(law: &dyn Law) -> bool {
    law.per_pressure(1.0) != [0.0; 2]
}
