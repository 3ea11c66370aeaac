//! A solved contact as observers see it.

use std::borrow::Cow;

use ndarray::Array2;

use crate::grid::{Field, Grid};
use crate::motion::contact::Contact;
use crate::motion::course::{Step, StepRow};
use crate::solver::Solution;
use crate::units::{Metre, Newton, NewtonPerMetre};

/// A solved contact with the fields that observers need: where the bodies touch, with what pressure, and how
/// far apart they are elsewhere.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct ObservedContact<'a> {
    /// Index of the position in its pass; 0 for a contact of two bodies at full overlap.
    pub index: usize,
    /// The grid of the overlap.
    pub grid: Grid,
    /// The corner of the overlap on the lower body, m.
    pub corner: [Metre; 2],
    /// Load, N.
    pub load: Newton,
    /// Pressure, Pa.
    pub pressure: Cow<'a, Field>,
    /// The cells in contact, those at the hardness among them.
    pub touching: Array2<bool>,
    /// Gap, m: 0 on cells in contact, ≥ 0 elsewhere.
    pub gap: Field,
    /// Normal stiffness of an elastic contact, N/m, if it is known.
    pub stiffness: Option<NewtonPerMetre>,
}

impl<'a> ObservedContact<'a> {
    /// Creates the contact of two bodies at full overlap from its solution.
    pub fn at_rest(solution: &'a Solution) -> Self {
        let mut cells = solution.pressure.iter().enumerate();
        let touching = Array2::from_shape_simple_fn(solution.pressure.raw_dim(), || {
            cells.next().is_some_and(|(cell, p)| solution.bounds.touches(cell, *p))
        });
        Self {
            index: 0,
            grid: solution.grid,
            corner: [0.0; 2],
            load: solution.load(),
            pressure: Cow::Borrowed(&solution.pressure),
            gap: open(solution.gap(), &touching),
            touching,
            stiffness: None,
        }
    }

    /// Creates the contact at a position of a pass with this index; `None` if it has not kept its gap.
    fn at_position(index: usize, contact: &'a Contact, pitch: [Metre; 2]) -> Option<Self> {
        let gap = contact.gap.as_deref()?.clone();
        let grid = Grid { shape: [gap.nrows(), gap.ncols()], pitch };
        let mut touching = Array2::from_elem(gap.raw_dim(), false);
        let cells = touching.as_slice_mut().expect("standard layout");
        contact.pressure.iter().for_each(|(cell, _)| cells[*cell as usize] = true);
        Some(Self {
            index,
            grid,
            corner: [contact.position.places()[0] * pitch[0], 0.0],
            load: contact.load,
            pressure: Cow::Owned(contact.pressure_field(grid.shape[1])),
            gap: open(gap, &touching),
            touching,
            stiffness: None,
        })
    }
}

/// Returns a gap that is 0 on the cells in contact and nowhere below 0.
fn open(mut gap: Field, touching: &Array2<bool>) -> Field {
    gap.zip_mut_with(touching, |gap, touches| *gap = if *touches { 0.0 } else { gap.max(0.0) });
    gap
}

impl<'a> Step<'a> {
    /// Returns the contacts of the step, one after another; of a pass those that have kept their gap.
    pub fn contacts(&self) -> impl Iterator<Item = ObservedContact<'a>> + use<'a> {
        let pass = self.pass().map(|report| (report.contacts, report.pair.pitch()));
        let of_pass = pass.into_iter().flat_map(|(contacts, pitch)| {
            let contacts = contacts.iter().enumerate();
            contacts.filter_map(move |(index, contact)| ObservedContact::at_position(index, contact, pitch))
        });
        let stiffness = match self.row {
            StepRow::Point(record) if record.plastic_area == 0.0 => record.stiffness,
            _ => None,
        };
        let at_rest = move |solution| ObservedContact { stiffness, ..ObservedContact::at_rest(solution) };
        self.contact.into_iter().map(at_rest).chain(of_pass)
    }
}
