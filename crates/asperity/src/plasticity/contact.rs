//! A contact at rest between bodies of which one or both may flow.

use super::body::{Action, PlasticBody};
use super::increment::{FlowParams, Increment, Loading, advance};
use crate::error::{Error, Result};
use crate::grid::{Field, Grid};
use crate::operator::Operator;
use crate::solver::{Bounds, Control, Params, Solution, Watch, solve_normal_watched};
use crate::subsurface::Tractions;
use crate::units::{Joule, Metre, Newton};

/// A contact that is loaded and unloaded increment by increment, of one body that may flow, or of two, which may move over each
/// other in between.
///
/// The gap is that of the undeformed bodies; their plastic strain opens it by r: g = h − δ + C p + r_lower + r_upper. A contact
/// lies on a part of each body, or on all of it; plastic strain stays with the material.
pub struct PlasticContact {
    operator: Box<dyn Operator>,
    initial_gap: Field,
    bodies: Vec<PlasticBody>,
    /// Where the contact begins on each body.
    places: Vec<[usize; 2]>,
    /// By how many cells the load has moved over each body since the last increment.
    shifts: Vec<[isize; 2]>,
    flow: FlowParams,
    contact: Params,
    increments: usize,
    /// Pressure of the last increment, and what it was found with; no solution before the first, and where the bodies are apart.
    pressure: Field,
    solution: Option<Solution>,
}

impl PlasticContact {
    /// Bodies that do not touch yet, and face each other with all of their cells. The operator is that of the pair; the `bodies`
    /// are those of the pair that may flow.
    ///
    /// # Panics
    /// If the gap, the operator and the bodies are not on one grid.
    pub fn new(
        operator: Box<dyn Operator>,
        initial_gap: Field,
        mut bodies: Vec<PlasticBody>,
        flow: FlowParams,
        contact: Params,
    ) -> Self {
        let shape = operator.grid().shape;
        assert_eq!(initial_gap.shape(), shape, "shape of the initial gap");
        assert!(bodies.iter_mut().all(|body| body.volume().grid() == operator.grid()), "grid of the bodies");
        let zeros = operator.grid().zeros();
        Self {
            operator,
            initial_gap,
            places: vec![[0; 2]; bodies.len()],
            shifts: vec![[0; 2]; bodies.len()],
            bodies,
            flow,
            contact,
            increments: 0,
            pressure: zeros,
            solution: None,
        }
    }

    /// Brings the bodies to another position, which the next increment will meet: its undeformed gap, on cells that the `operator`
    /// is for, of which the first is `places` of each body (counted cyclically under a periodic boundary), and by how many whole
    /// cells the load moves over each of them.
    ///
    /// # Panics
    /// If the gap is not on the operator's grid, a contact reaches beyond a body, or there are not as many places and shifts
    /// as bodies.
    pub fn move_to(
        &mut self,
        operator: Box<dyn Operator>,
        initial_gap: Field,
        places: &[[usize; 2]],
        shifts: &[[isize; 2]],
    ) {
        let shape = operator.grid().shape;
        assert_eq!(initial_gap.shape(), shape, "shape of the initial gap");
        assert!(places.len() == self.bodies.len() && shifts.len() == places.len(), "a place for each body");
        for (body, place) in self.bodies.iter_mut().zip(places) {
            let volume = body.volume();
            let fits = (0..2).all(|axis| place[axis] + shape[axis] <= volume.grid().shape[axis]);
            assert!(fits || volume.boundary().leaves_mean_free(), "a contact on the body");
        }
        // The pressure goes with the load over the first body.
        let (body, [dx, dy]) = (self.bodies[0].displacement(), shifts[0]);
        let [nx, ny] = [body.nrows(), body.ncols()];
        let before = on_body(&self.pressure, self.places[0], [nx, ny]);
        let moved = Field::from_shape_fn([nx, ny], |(i, j)| {
            let back =
                |index: usize, by: isize, n: usize| (index as isize - by).rem_euclid(n as isize) as usize;
            before[[back(i, dx, nx), back(j, dy, ny)]]
        });
        self.pressure = on_contact(&moved, places[0], shape);
        self.operator = operator;
        self.initial_gap = initial_gap;
        self.places = places.to_vec();
        self.shifts = shifts.to_vec();
    }

    /// Goes on to a load (0: the bodies are taken apart) or an approach in one increment.
    ///
    /// # Errors
    /// [`Error::AtIncrement`] with what is wrong there: [`Error::FlowNotConverged`], or what [`crate::solver::solve_normal`] finds.
    pub fn go_to(&mut self, control: Control) -> Result<Increment> {
        self.go_to_watched(control, &())
    }

    /// As [`PlasticContact::go_to`], while somebody looks on.
    pub(crate) fn go_to_watched(&mut self, control: Control, watch: &dyn Watch) -> Result<Increment> {
        self.increments += 1;
        let Self { operator, initial_gap, bodies, flow, contact, pressure, places, .. } = self;
        let shapes = bodies.iter().map(|body| [body.displacement().nrows(), body.displacement().ncols()]);
        let mut pressing = Pressing {
            operator: operator.as_mut(),
            initial_gap,
            control,
            params: contact,
            watch,
            pressure: pressure.clone(),
            solution: None,
            facing: places.iter().copied().zip(shapes).collect(),
        };
        let mut flowing: Vec<&mut PlasticBody> = bodies.iter_mut().collect();
        let at = |source| match source {
            Error::Interrupted => source,
            source => Error::AtIncrement { increment: self.increments, source: Box::new(source) },
        };
        let increment = advance(&mut flowing, &mut pressing, Some(&self.shifts), flow).map_err(at)?;
        let Pressing { pressure, solution, .. } = pressing;
        self.solution = solution;
        self.pressure = pressure;
        self.shifts.fill([0; 2]);
        Ok(increment)
    }

    /// Goes on to a load in so many equal increments from the present one.
    ///
    /// # Errors
    /// Those of [`PlasticContact::go_to`].
    pub fn load_to(&mut self, load: Newton, increments: usize) -> Result<Vec<Increment>> {
        let from = self.load();
        (1..=increments)
            .map(|n| self.go_to(Control::Load(from + (load - from) * n as f64 / increments as f64)))
            .collect()
    }

    /// The pressure, Pa.
    pub fn pressure(&self) -> &Field {
        &self.pressure
    }

    /// The load W, N.
    pub fn load(&self) -> Newton {
        self.operator.grid().cell_area() * self.pressure.sum()
    }

    /// The approach δ of the undeformed bodies, m; none before the first contact, and where they have been taken apart.
    pub fn approach(&self) -> Option<Metre> {
        self.solution.as_ref().map(|solution| solution.approach)
    }

    /// The elastic contact of the bodies as they are, with what has flowed; none before the first, and where they have been taken
    /// apart.
    pub fn solution(&self) -> Option<&Solution> {
        self.solution.as_ref()
    }

    /// The grid of the contact.
    pub fn grid(&self) -> &Grid {
        self.operator.grid()
    }

    /// The approach at which the bodies as they are now first touch, m.
    pub fn first_touch(&self) -> Metre {
        self.with_residual(self.initial_gap.clone()).iter().copied().fold(f64::INFINITY, f64::min)
    }

    /// The bodies that may flow.
    pub fn bodies(&mut self) -> &mut [PlasticBody] {
        &mut self.bodies
    }

    /// What the surfaces have moved apart by, C p + r, m; under a periodic boundary the mean of C p is zero.
    pub fn displacement(&self) -> Field {
        let zeros = || Field::zeros(self.pressure.raw_dim());
        let elastic = self.solution.as_ref().map_or_else(zeros, |solution| solution.displacement.clone());
        self.with_residual(elastic)
    }

    /// A field on the cells of the contact with the displacements of both surfaces by their plastic strain.
    fn with_residual(&self, field: Field) -> Field {
        let shape = self.operator.grid().shape;
        let bodies = self.bodies.iter().zip(&self.places);
        bodies.fold(field, |sum, (body, place)| sum + on_contact(body.displacement(), *place, shape))
    }

    /// Elastic energy ½ ΔA Σ p C p under the pressure, J: without that of the residual stress.
    pub fn elastic_energy(&self) -> Joule {
        self.solution.as_ref().map_or(0.0, Solution::elastic_energy)
    }
}

/// Presses bodies together under one load or at one approach.
struct Pressing<'a> {
    operator: &'a mut dyn Operator,
    initial_gap: &'a Field,
    control: Control,
    params: &'a Params,
    watch: &'a dyn Watch,
    /// The last pressure: a start for the next.
    pressure: Field,
    solution: Option<Solution>,
    /// Where the contact begins on each body, and the body's shape.
    facing: Vec<([usize; 2], [usize; 2])>,
}

impl Loading for Pressing<'_> {
    fn act(&mut self, residual: &[Field]) -> Result<Vec<Action>> {
        if self.watch.stop() {
            return Err(Error::Interrupted);
        }
        if self.control == Control::Load(0.0) {
            self.pressure.fill(0.0);
            self.solution = None;
        } else {
            let shape = self.operator.grid().shape;
            let facing = residual.iter().zip(&self.facing);
            let gap = facing
                .fold(self.initial_gap.clone(), |gap, (r, (place, _))| gap + on_contact(r, *place, shape));
            let start = self.pressure.iter().any(|p| *p > 0.0).then_some(&self.pressure);
            let (control, params) = (self.control, self.params);
            let solution = solve_normal_watched(
                self.operator,
                &gap,
                &Bounds::ELASTIC,
                control,
                start,
                params,
                self.watch,
            )?;
            self.pressure.assign(&solution.pressure);
            self.solution = Some(solution);
        }
        let on = |(place, shape): &([usize; 2], [usize; 2])| on_body(&self.pressure, *place, *shape);
        Ok(self.facing.iter().map(|facing| Action::Tractions(Tractions::frictionless(on(facing)))).collect())
    }
}

/// Of a field on a body the part on a contact that begins at `place`, counted cyclically.
fn on_contact(field: &Field, place: [usize; 2], shape: [usize; 2]) -> Field {
    let [nx, ny] = [field.nrows(), field.ncols()];
    Field::from_shape_fn(shape, |(i, j)| field[[(place[0] + i) % nx, (place[1] + j) % ny]])
}

/// A field on a contact that begins at `place` of a body of this `shape`, counted cyclically; 0 elsewhere.
fn on_body(field: &Field, place: [usize; 2], shape: [usize; 2]) -> Field {
    let mut on = Field::zeros(shape);
    for ((i, j), value) in field.indexed_iter() {
        on[[(place[0] + i) % shape[0], (place[1] + j) % shape[1]]] = *value;
    }
    on
}

#[cfg(test)]
mod tests;
