//! The quantities of a step that the limits bound.

use crate::case::Side;
use asperity_base::units::{Kelvin, Metre, Pascal};
use asperity_contact::motion::{
    Contact, Pair, PassRecord, PassReport, Step, StepRecord, StepRow, UpdateRecord,
};
use asperity_contact::solver::Solution;

/// A result beyond a limit.
pub(super) struct Finding {
    /// Position in the pass, increment, update or point.
    pub(super) step: Option<usize>,
    pub(super) body: Option<Side>,
    pub(super) value: f64,
    pub(super) bound: f64,
}

/// Quantities of a step.
#[derive(Default)]
pub(super) struct Findings<'a> {
    /// The pass of a motion.
    pub(super) pass: Option<usize>,
    pub(super) contacts: Vec<ContactFindings>,
    /// The bodies after the step, if it may have changed them.
    pub(super) changed: Option<&'a Pair>,
    /// The row of a step after which laws have changed the bodies.
    pub(super) row: Option<ChangingRow<'a>>,
    /// Sq of the lower and of the upper body after it.
    pub(super) sq: [Metre; 2],
    /// Largest temperature, and where.
    pub(super) temperature: Option<(usize, Kelvin)>,
}

/// A row of a step that laws change the bodies after.
pub(super) enum ChangingRow<'a> {
    Pass(&'a PassRecord),
    Update(&'a UpdateRecord),
}

/// Quantities of a contact.
pub(super) struct ContactFindings {
    /// Number of the position, increment, update or point.
    pub(super) step: usize,
    pub(super) max_pressure: Pascal,
    /// Largest elastic displacement, if it is known.
    pub(super) displacement: Option<Metre>,
    /// Largest plastic interference.
    pub(super) interference: Metre,
    /// Number of cells at the hardness, and of all cells.
    pub(super) cells: [usize; 2],
}

impl ContactFindings {
    pub(super) fn new(step: usize, solution: &Solution) -> Self {
        let capped = |(cell, p): &(usize, &f64)| solution.bounds.caps(*cell, **p);
        Self {
            step,
            max_pressure: solution.max_pressure(),
            displacement: Some(solution.max_displacement()),
            interference: solution.max_interference(),
            cells: [solution.pressure.iter().enumerate().filter(capped).count(), solution.grid.cells()],
        }
    }

    fn at_position(step: usize, contact: &Contact, width: usize) -> Self {
        Self {
            step,
            max_pressure: contact.max_pressure(),
            displacement: contact.max_displacement,
            interference: contact.plastic.iter().fold(0.0, |most: f64, (_, w)| most.max(*w)),
            cells: [contact.plastic.len(), contact.position.columns * width],
        }
    }
}

impl<'a> Findings<'a> {
    pub(super) fn from_step(step: &Step<'a>) -> Self {
        if let Some(report) = step.pass() {
            return Self::from_pass(report);
        }
        let contact = step.contact.map(|solution| ContactFindings::new(step.number, solution));
        let found =
            Self { contacts: contact.into_iter().collect(), changed: step.changed, ..Self::default() };
        match step.row {
            StepRow::Update(update) => found.of_update(update),
            _ => found,
        }
    }

    /// Adds the row and the temperature of an update.
    fn of_update(mut self, update: &'a UpdateRecord) -> Self {
        // The displacement of an update includes its removal.
        if update.update > 0 {
            self.contacts.iter_mut().for_each(|contact| contact.displacement = None);
        }
        let sq = self
            .changed
            .map_or([0.0; 2], |pair| [&pair.lower, &pair.upper].map(|body| body.heights.std(0.0)));
        Self {
            row: Some(ChangingRow::Update(update)),
            sq,
            temperature: Some((update.update, update.max_temperature)),
            ..self
        }
    }

    fn from_pass(report: &PassReport<'a>) -> Self {
        let PassReport { record, steps, contacts, pair, .. } = *report;
        let width = pair.lower.width();
        let contacts = contacts.iter().enumerate();
        let hot = |step: &StepRecord| Some((step.step, step.heat?.max_flash_temperature));
        Self {
            pass: Some(record.pass),
            contacts: contacts
                .map(|(index, each)| ContactFindings::at_position(index + 1, each, width))
                .collect(),
            changed: Some(pair),
            row: Some(ChangingRow::Pass(record)),
            sq: [record.sq_lower, record.sq_upper],
            temperature: steps
                .iter()
                .filter_map(hot)
                .reduce(|most, next| if next.1 > most.1 { next } else { most }),
        }
    }

    /// Returns the largest value of its contacts, if it exceeds a bound.
    pub(super) fn largest(&self, bound: f64, value: impl Fn(&ContactFindings) -> f64) -> Option<Finding> {
        let values = self.contacts.iter().map(|contact| (contact.step, value(contact)));
        let (step, value) = values.reduce(|most, next| if next.1 > most.1 { next } else { most })?;
        (value > bound).then_some(Finding { step: Some(step), body: None, value, bound })
    }

    /// Returns the value of the body that exceeds its bound most, if one does.
    pub(super) fn of_bodies(&self, [lower, upper]: [[f64; 2]; 2]) -> Option<Finding> {
        let [lower_beyond, upper_beyond] = [lower, upper].map(|[value, bound]| value > bound);
        let (body, [value, bound]) = if lower_beyond && !(upper_beyond && upper[0] > lower[0]) {
            (Side::Lower, lower)
        } else {
            (Side::Upper, upper)
        };
        self.as_a_whole(Some(body), value, bound)
    }

    /// Returns a value of the whole step, if it exceeds a bound.
    pub(super) fn as_a_whole(&self, body: Option<Side>, value: f64, bound: f64) -> Option<Finding> {
        let step = self.contacts.first().map(|contact| contact.step).filter(|_| self.pass.is_none());
        (value > bound).then_some(Finding { step, body, value, bound })
    }
}
