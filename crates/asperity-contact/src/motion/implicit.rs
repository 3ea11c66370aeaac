//! A pass solved together with its removal, so that the pressures are those at its end.

use std::ops::Range;

use rayon::prelude::*;

use super::control::LoadControl;
use crate::error::{Error, Result};
use crate::grid::{CellValues, Field, Grid};
use crate::motion::contact::Contact;
use crate::motion::pair::Pair;
use crate::motion::pass::{Pass, Solver};
use crate::motion::path::{Position, Stroke};
use crate::motion::watch::OneOfMany;
use crate::operator::{Boundary, Operator, Operators};
use crate::solver::{Bounds, Control, Device, Method, Params, Solution, solve_normal_watched};

impl Solver<'_> {
    /// Solves again a pass with too much removal for an explicit step. Each cell of the bodies is lowered by
    /// the depth lost at the end of the pass, which is `compliance`, m/Pa, times the sum of its pressures
    /// over all positions. All positions form one problem, which starts from the pressures of the `outcome`.
    /// This is backward Euler, stable for any removal, as in sliding in place.
    ///
    /// # Errors
    /// [`Error::Unsupported`] if a load holds at each position, the bodies attract each other, or shear
    /// displaces them normally; [`Error::NotConverged`], [`Error::Interrupted`].
    pub(super) fn solve_implicitly(
        &self,
        outcome: &Pass,
        compliance: [CellValues; 2],
        params: &Params,
    ) -> Result<Vec<Contact>> {
        let pair = &outcome.pair;
        if !pair.interface().is_hard() {
            return Err(Error::Unsupported(TOO_MUCH_REMOVAL));
        }
        let positions = self.positions.len();
        let control = match (self.motion.control, self.motion.load_control) {
            (Control::Load(_), LoadControl::Step) if positions > 1 => {
                return Err(Error::Unsupported(TOO_MUCH_REMOVAL));
            }
            (Control::Load(load), _) => Control::Load(load * positions as f64),
            (approach, _) => approach,
        };
        if self.motion.slip(Stroke::Forth).displaces_normally(pair) {
            return Err(Error::Unsupported(TOO_MUCH_REMOVAL));
        }
        let grid = pair.grid(self.positions.iter().map(|position| position.columns).sum());
        let mut operator =
            WornPass { pair, positions: self.positions, operators: self.operators, grid, compliance };
        let gap = stacked(self.positions.iter().map(|position| pair.initial_gap(position)));
        let bounds: Vec<_> =
            self.positions.iter().map(|position| self.motion.bounds(pair, position)).collect();
        let caps = Bounds::up_to(self.stacked_caps(pair, &bounds));
        let start = stacked(outcome.contacts.iter().map(|contact| contact.pressure_field(grid.shape[1])));
        let params = params.with_method(Method::PolonskyKeer).with_device(Device::Cpu);
        let watch = OneOfMany(self.watch);
        let solution =
            solve_normal_watched(&mut operator, &gap, &caps, control, Some(&start), &params, &watch)?;
        let contacts = rows(self.positions).zip(bounds).zip(&outcome.contacts);
        let contact =
            |(((position, rows), bounds), before): (((&Position, Range<usize>), Bounds), &Contact)| {
                let of_position = |field: &Field| field.slice(ndarray::s![rows.clone(), ..]).to_owned();
                let mut stats = solution.stats;
                stats.convolutions += before.stats.convolutions;
                let at_position = Solution {
                    grid: pair.grid(position.columns),
                    initial_gap: of_position(&solution.initial_gap),
                    bounds,
                    pressure: of_position(&solution.pressure),
                    displacement: of_position(&solution.displacement),
                    stats,
                    ..solution
                };
                let regime = self.motion.slip(position.stroke);
                let contact = Contact::new(*position, regime.sliding(), &at_position)
                    .with_gap(&at_position, before.gap.is_some());
                // The displacement of the solution includes the removal.
                Contact { max_displacement: None, ..contact }
            };
        Ok(contacts.map(contact).collect())
    }

    /// Returns the upper bounds at all positions, stacked; a number if they are all the same.
    fn stacked_caps(&self, pair: &Pair, bounds: &[Bounds]) -> CellValues {
        let uniform = bounds[0].upper().uniform();
        if let Some(cap) = uniform
            && bounds.iter().all(|bounds| bounds.upper().uniform() == uniform)
        {
            return CellValues::Uniform(cap);
        }
        let caps = bounds.iter().zip(self.positions).map(|(bounds, position)| {
            let shape = pair.grid(position.columns).shape;
            Field::from_shape_fn(shape, |(i, j)| bounds.upper().value(i * shape[1] + j))
        });
        CellValues::Field(stacked(caps))
    }
}

/// Message for a pass with too much removal for an explicit step that cannot be solved implicitly.
const TOO_MUCH_REMOVAL: &str = "a single pass removes so much that the pressures of single cells would oscillate: give a smaller coefficient, larger \
     cells or a shorter pass; the implicit solution needs one approach for the whole pass, no attraction and no coupling of \
     shear to normal displacements";

/// Displacement at all positions of a pass, stacked in one field, under the pressures at all of them. It is
/// the elastic displacement of the bodies plus the depth worn by the end of the pass, C + κ₁ S₁ᵀS₁ + κ₂
/// S₂ᵀS₂, where S sums the pressures on a cell of a body over the positions.
struct WornPass<'a> {
    pair: &'a Pair,
    positions: &'a [Position],
    operators: &'a Operators,
    /// Grid with the total number of overlap columns of all positions.
    grid: Grid,
    /// Depth per sum of pressures κ of the lower and of the upper body, m/Pa.
    compliance: [CellValues; 2],
}

impl WornPass<'_> {
    /// Iterates over the positions, in order, with their rows.
    fn rows(&self) -> impl Iterator<Item = (&Position, Range<usize>)> {
        rows(self.positions)
    }

    /// Returns the depths worn off the bodies by the pressures at all positions.
    fn worn(&self, pressure: &Field) -> [Option<Field>; 2] {
        [0, 1].map(|body| {
            let compliance = &self.compliance[body];
            if compliance.max() == 0.0 {
                return None;
            }
            let heights = [&self.pair.lower, &self.pair.upper][body].heights.raw_dim();
            let mut worn = Field::zeros(heights);
            let cells = worn.as_slice_mut().expect("standard layout");
            for (position, rows) in self.rows() {
                let placement = &self.pair.placements(position)[body];
                let pressure = pressure.slice(ndarray::s![rows, ..]);
                for (cell, p) in pressure.iter().enumerate().filter(|(_, p)| **p != 0.0) {
                    placement
                        .parts(placement.cell(cell))
                        .for_each(|(cell, weight)| cells[cell] += weight * p);
                }
            }
            cells.iter_mut().enumerate().for_each(|(cell, sum)| *sum *= compliance.value(cell));
            Some(worn)
        })
    }
}

impl Operator for WornPass<'_> {
    fn grid(&self) -> &Grid {
        &self.grid
    }

    /// Free for every boundary of the positions: once all cells lose height, no mean displacement is
    /// undetermined.
    fn boundary(&self) -> Boundary {
        Boundary::FREE
    }

    fn harmonic_displacement(&self, qx: f64, qy: f64) -> f64 {
        self.pair.response().harmonic_displacement(qx, qy)
    }

    /// Influence between cells at one position, from the elastic response alone.
    fn influence(&self, i: usize, j: usize) -> f64 {
        let pitch = self.grid.pitch;
        self.pair.response().influence(pitch).displacement(i as f64 * pitch[0], j as f64 * pitch[1])
    }

    fn self_influence(&self) -> CellValues {
        let elastic = self.influence(0, 0);
        let mut own = Field::from_elem(self.grid.shape, elastic);
        for (position, rows) in self.rows() {
            let mut own = own.slice_mut(ndarray::s![rows, ..]);
            for (placement, compliance) in self.pair.placements(position).iter().zip(&self.compliance) {
                for (cell, own) in own.iter_mut().enumerate() {
                    let parts = placement.parts(placement.cell(cell));
                    *own += parts.map(|(cell, weight)| weight * weight * compliance.value(cell)).sum::<f64>();
                }
            }
        }
        own.into()
    }

    fn apply(&mut self, pressure: &Field, displacement: &mut Field) {
        let each = |rows: Range<usize>| {
            let pressure = pressure.slice(ndarray::s![rows, ..]).to_owned();
            let mut displacement = Field::zeros(pressure.raw_dim());
            let shape = [pressure.nrows(), pressure.ncols()];
            self.operators.on(shape).apply(&pressure, &mut displacement);
            displacement
        };
        let blocks: Vec<_> = self.rows().map(|(_, rows)| rows).collect();
        let elastic: Vec<Field> = blocks.into_par_iter().map(each).collect();
        displacement.assign(&stacked(elastic.into_iter()));
        let worn = self.worn(pressure);
        for (position, rows) in self.rows() {
            let placements = self.pair.placements(position);
            for (placement, worn) in placements.iter().zip(&worn) {
                let Some(worn) = worn else { continue };
                for (j, row) in rows.clone().enumerate() {
                    let mut row = displacement.row_mut(row);
                    let row = row.as_slice_mut().expect("standard layout");
                    placement.for_column(worn, j, row, |u, worn| *u += worn);
                }
            }
        }
    }

    fn coarse(&self) -> Box<dyn Operator> {
        unreachable!("conjugate gradients without a preconditioner need no coarse grid")
    }
}

/// Iterates over the positions with their stacked rows.
fn rows(positions: &[Position]) -> impl Iterator<Item = (&Position, Range<usize>)> {
    let mut first = 0;
    positions.iter().map(move |position| {
        let rows = first..first + position.columns;
        first = rows.end;
        (position, rows)
    })
}

/// Stacks fields of one width.
fn stacked(fields: impl Iterator<Item = Field>) -> Field {
    let fields: Vec<Field> = fields.collect();
    let views: Vec<_> = fields.iter().map(|field| field.view()).collect();
    ndarray::concatenate(ndarray::Axis(0), &views).expect("fields of one width")
}
