//! A contact of two bodies, one or both elasto-plastic.

use super::body::{Action, PlasticBody, PlasticState, SurfaceDisplacement};
use super::increment::{self, Increment, PlasticParams, advance};
use crate::error::{Error, Result};
use crate::grid::{Field, Grid, Placement};
use crate::solver::{
    Bounds, ContactProblem, ContactSolver, Control, Equilibrium, Guess, Loading, Params, Solution,
    Tangential, Watch,
};
use crate::subsurface::Tractions;
use crate::units::{Joule, Metre, Newton};

/// A contact of two bodies, one or both elasto-plastic, that is loaded and unloaded in increments. The bodies
/// may move over each other between increments.
///
/// The gap is that of the undeformed bodies. Plastic strain opens it by r, g = h − δ + C p + r₁ + r₂, and
/// displaces the surfaces tangentially. A contact covers a part of each body, or all of it. Plastic strain
/// stays with the material.
pub struct PlasticContact {
    facing: RelativePosition,
    bodies: Vec<PlasticBody>,
    /// Side of each of the bodies: 0 the lower, 1 the upper one.
    sides: Vec<usize>,
    /// Shift of the load over the lower and over the upper body since the last increment, in cells.
    shifts: [[isize; 2]; 2],
    flow: PlasticParams,
    contact: Params,
    increments: usize,
    /// Pressure of the last increment; 0 before the first, and after separation.
    pressure: Field,
    equilibrium: Option<Equilibrium>,
    /// Relative tangential displacement of the surfaces by plastic strain after the last increment, if it is
    /// followed.
    along: Option<[Field; 2]>,
}

/// Relative position of two bodies.
pub struct RelativePosition {
    /// The solver of the contact, between hard walls.
    pub solver: Box<dyn ContactSolver>,
    /// Gap h of the undeformed bodies, m.
    pub initial_gap: Field,
    /// Bounds on the pressures: the hardness of a body that is not elasto-plastic.
    pub bounds: Bounds,
    /// Placement of the contact on the lower and on the upper body.
    pub placements: [Placement; 2],
}

impl PlasticContact {
    /// Creates a contact of bodies that do not touch yet, from the elasto-plastic ones: lower, upper.
    ///
    /// # Panics
    /// If neither body is elasto-plastic, if the grid of the gap differs from that of the solver, or if the
    /// contact reaches beyond a body.
    pub fn new(
        facing: RelativePosition,
        bodies: [Option<PlasticBody>; 2],
        flow: PlasticParams,
        contact: Params,
    ) -> Self {
        let follows = facing.solver.sticks();
        let follow = |body: PlasticBody| if follows { body.followed_along() } else { body };
        let given = bodies.into_iter().enumerate();
        let (sides, bodies): (Vec<_>, Vec<_>) =
            given.filter_map(|(side, body)| Some((side, follow(body?)))).unzip();
        assert!(!bodies.is_empty(), "a body that may flow");
        let zeros = facing.solver.grid().zeros();
        let mut contact = Self {
            facing,
            bodies,
            sides,
            shifts: [[0; 2]; 2],
            flow,
            contact,
            increments: 0,
            pressure: zeros,
            equilibrium: None,
            along: None,
        };
        contact.check();
        contact
    }

    /// Moves the bodies to another position for the next increment. The load moves over the lower and over
    /// the upper body by whole cells, `shifts`. Between the positions the bodies slide freely; a history of
    /// stick belongs to one position.
    ///
    /// # Panics
    /// If the grid of the gap differs from that of the solver, or if the contact reaches beyond a body.
    pub fn move_to(&mut self, facing: RelativePosition, shifts: [[isize; 2]; 2]) {
        // The pressure moves with the load over the first of the bodies.
        let side = self.sides[0];
        let before = self.facing.placements[side].onto(&self.pressure);
        let ([nx, ny], [dx, dy]) = (facing.placements[side].shape(), shifts[side]);
        let moved = Field::from_shape_fn([nx, ny], |(i, j)| {
            let back =
                |index: usize, by: isize, n: usize| (index as isize - by).rem_euclid(n as isize) as usize;
            before[[back(i, dx, nx), back(j, dy, ny)]]
        });
        self.pressure = facing.placements[side].under(&moved, facing.solver.grid().shape[0]);
        self.facing = facing;
        self.shifts = shifts;
        self.equilibrium = None;
        self.along = None;
        self.check();
    }

    fn check(&mut self) {
        let grid = *self.facing.solver.grid();
        assert_eq!(self.facing.initial_gap.shape(), grid.shape, "shape of the initial gap");
        for (body, side) in self.bodies.iter_mut().zip(&self.sides) {
            let volume = body.volume();
            let (placement, of_body) = (&self.facing.placements[*side], volume.grid());
            assert_eq!(placement.shape(), of_body.shape, "grid of the bodies");
            assert_eq!(of_body.pitch, grid.pitch, "grid of the bodies");
            let fits = placement.cell(0) / of_body.shape[1] + grid.shape[0] <= of_body.shape[0];
            assert!(fits || volume.boundary().leaves_mean_free(), "a contact on the body");
        }
    }

    /// Separates the bodies, and restores the plastic `states` of the elasto-plastic ones. The result has the
    /// same bits for any history. Cost: one operator application each.
    ///
    /// # Panics
    /// If the number of states differs from that of the bodies, or if a state belongs to another body.
    pub fn restore(&mut self, states: &[PlasticState]) {
        assert_eq!(states.len(), self.bodies.len(), "a state for each body");
        self.bodies.iter_mut().zip(states).for_each(|(body, state)| body.restore(state));
        self.pressure.fill(0.0);
        self.equilibrium = None;
        self.along = None;
        self.increments = 0;
    }

    /// Applies a load (0 separates the bodies) or an approach in one increment, without tangential loading.
    ///
    /// # Errors
    /// [`Error::AtIncrement`] with its cause: [`Error::PlasticNotConverged`], or an error of
    /// [`crate::solver::solve_normal`].
    pub fn go_to(&mut self, control: Control) -> Result<Increment> {
        self.load(Loading { normal: control, tangential: Tangential::Force([0.0; 2]) }, &())
    }

    /// Applies a loading in one increment under a watch. Tangential loading counts only for surfaces that may
    /// stick.
    ///
    /// # Errors
    /// The errors of [`PlasticContact::go_to`] and of [`crate::solver::solve_frictional`];
    /// [`Error::Interrupted`].
    pub fn load(&mut self, loading: Loading, watch: &dyn Watch) -> Result<Increment> {
        self.increments += 1;
        let sticks = self.facing.solver.sticks();
        let mut pressing = ElasticStep {
            facing: &mut self.facing,
            sides: &self.sides,
            loading,
            params: &self.contact,
            watch,
            before: self.equilibrium.as_ref().filter(|_| sticks),
            along_before: self.along.clone(),
            pressure: self.pressure.clone(),
            equilibrium: None,
            along: None,
        };
        let shifts: Vec<_> = self.sides.iter().map(|side| self.shifts[*side]).collect();
        let mut flowing: Vec<&mut PlasticBody> = self.bodies.iter_mut().collect();
        let at = |source| Error::AtIncrement { increment: self.increments, source };
        let increment = advance(&mut flowing, &mut pressing, Some(&shifts), &self.flow)
            .map_err(|error| error.unless_interrupted(at))?;
        let ElasticStep { pressure, equilibrium, along, .. } = pressing;
        (self.pressure, self.equilibrium, self.along) = (pressure, equilibrium, along);
        self.shifts = [[0; 2]; 2];
        Ok(increment)
    }

    /// Applies a load in `increments` equal increments from the present one.
    ///
    /// # Errors
    /// The errors of [`PlasticContact::go_to`].
    pub fn load_to(&mut self, load: Newton, increments: usize) -> Result<Vec<Increment>> {
        let from = self.normal_force();
        (1..=increments)
            .map(|n| self.go_to(Control::Load(from + (load - from) * n as f64 / increments as f64)))
            .collect()
    }

    /// The pressure, Pa.
    pub fn pressure(&self) -> &Field {
        &self.pressure
    }

    /// The load W, N.
    pub fn normal_force(&self) -> Newton {
        self.grid().cell_area() * self.pressure.sum()
    }

    /// Approach δ of the undeformed bodies, m; `None` before the first contact and after separation.
    pub fn approach(&self) -> Option<Metre> {
        self.solution().map(|solution| solution.approach)
    }

    /// The elastic contact of the bodies with their plastic displacement; `None` before the first increment,
    /// and after separation or a move.
    pub fn equilibrium(&self) -> Option<&Equilibrium> {
        self.equilibrium.as_ref()
    }

    /// The normal part of [`PlasticContact::equilibrium`].
    pub fn solution(&self) -> Option<&Solution> {
        self.equilibrium().map(Equilibrium::normal)
    }

    /// The grid of the contact.
    pub fn grid(&self) -> &Grid {
        self.facing.solver.grid()
    }

    /// Approach at which the bodies in their present state first touch, m.
    pub fn first_touch(&self) -> Metre {
        self.with_residual(self.facing.initial_gap.clone()).iter().copied().fold(f64::INFINITY, f64::min)
    }

    /// Sets the gap h of the undeformed bodies for the next increment.
    ///
    /// # Panics
    /// If its shape differs.
    pub fn set_gap(&mut self, gap: &Field) {
        self.facing.initial_gap.assign(gap);
    }

    /// Gap h of the undeformed bodies, m.
    pub fn initial_gap(&self) -> &Field {
        &self.facing.initial_gap
    }

    /// Bounds on the pressures.
    pub fn bounds(&self) -> &Bounds {
        &self.facing.bounds
    }

    /// Whether cells may stick.
    pub fn sticks(&self) -> bool {
        self.facing.solver.sticks()
    }

    /// Moves the plastic strain of each body up where the depth `worn` of the material above it has gone, on
    /// the cells of the lower and of the upper body. The contact stays as it is for the next increment,
    /// without the tangential displacement of the surfaces by the strain that has gone.
    ///
    /// # Panics
    /// If a shape differs from that of its body.
    pub fn uncover(&mut self, worn: &[Field; 2]) {
        for (body, side) in self.bodies.iter_mut().zip(&self.sides) {
            let depth = &worn[*side];
            if depth.iter().all(|depth| *depth <= 0.0) {
                continue;
            }
            let faces = body.volume().layers().faces().to_vec();
            let state = body.state().uncovered(&faces, depth);
            body.restore(&state);
            self.along = None;
        }
    }

    /// The elasto-plastic bodies.
    pub fn bodies(&mut self) -> &mut [PlasticBody] {
        &mut self.bodies
    }

    /// Side of each of these bodies: 0 the lower, 1 the upper one.
    pub fn sides(&self) -> &[usize] {
        &self.sides
    }

    /// Relative normal displacement of the surfaces, C p + r, m. Under a periodic boundary the mean of C p is
    /// zero.
    pub fn displacement(&self) -> Field {
        let zeros = || Field::zeros(self.pressure.raw_dim());
        self.with_residual(self.solution().map_or_else(zeros, |solution| solution.displacement.clone()))
    }

    /// Adds the plastic displacements of both surfaces to a field on the cells of the contact.
    fn with_residual(&self, field: Field) -> Field {
        let columns = self.grid().shape[0];
        let bodies = self.bodies.iter().zip(&self.sides);
        bodies.fold(field, |sum, (body, side)| {
            sum + self.facing.placements[*side].under(body.displacement(), columns)
        })
    }

    /// Elastic energy under the tractions, J, without that of the residual stress.
    pub fn elastic_energy(&self) -> Joule {
        self.equilibrium.as_ref().map_or(0.0, Equilibrium::elastic_energy)
    }
}

/// The elastic part of an increment: presses the bodies together under the prescribed loading.
struct ElasticStep<'a> {
    facing: &'a mut RelativePosition,
    sides: &'a [usize],
    loading: Loading,
    params: &'a Params,
    watch: &'a dyn Watch,
    /// The last increment of surfaces that may stick, with the relative tangential displacement of the
    /// surfaces by plastic strain after it.
    before: Option<&'a Equilibrium>,
    along_before: Option<[Field; 2]>,
    /// The last pressure, as the start of the next solve.
    pressure: Field,
    equilibrium: Option<Equilibrium>,
    along: Option<[Field; 2]>,
}

impl increment::Loading for ElasticStep<'_> {
    fn act(&mut self, residual: &[SurfaceDisplacement]) -> Result<Vec<Action>> {
        if self.watch.stop() {
            return Err(Error::Interrupted);
        }
        let RelativePosition { initial_gap, placements, .. } = &*self.facing;
        let columns = initial_gap.nrows();
        let on_bodies = || residual.iter().zip(self.sides.iter().map(|side| (*side, &placements[*side])));
        let gap = on_bodies()
            .fold(initial_gap.clone(), |gap, (r, (_, placement))| gap + placement.under(&r.inward, columns));
        // Lower minus upper body, like the tangential displacement by tractions.
        let along = on_bodies().fold(None, |sum: Option<[Field; 2]>, (r, (side, placement))| {
            let sign = [1.0, -1.0][side];
            let of_body = r.along.as_ref()?.each_ref().map(|along| sign * placement.under(along, columns));
            Some(match sum {
                None => of_body,
                Some([x, y]) => {
                    let [more_x, more_y] = of_body;
                    [x + more_x, y + more_y]
                }
            })
        });
        // For bodies that did not touch, it is the present displacement.
        if self.along_before.is_none() {
            self.along_before.clone_from(&along);
        }
        let shear = self.press(&gap, along.as_ref())?;
        self.along = along;
        let placements = &self.facing.placements;
        let actions = self.sides.iter().map(|side| {
            let placement = &placements[*side];
            let shear = match &shear {
                None => [None, None],
                Some(shear) => shear.each_ref().map(|shear| Some(placement.onto(shear))),
            };
            let tractions = Tractions { pressure: placement.onto(&self.pressure), shear };
            Action::Tractions(if *side == 0 { tractions } else { tractions.on_upper() })
        });
        Ok(actions.collect())
    }
}

impl ElasticStep<'_> {
    /// Presses together surfaces with a `gap` and a relative tangential displacement `along` by plastic
    /// strain. Returns the shear on the lower one.
    fn press(&mut self, gap: &Field, along: Option<&[Field; 2]>) -> Result<Option<[Field; 2]>> {
        let (control, params, watch) = (self.loading.normal, self.params, self.watch);
        params.device.only_processor("a device does not solve elasto-plastic bodies")?;
        if control == Control::Load(0.0) {
            self.pressure.fill(0.0);
            self.equilibrium = None;
            return Ok(None);
        }
        let pressure = Some(&self.pressure).filter(|pressure| pressure.iter().any(|p| *p > 0.0));
        let latest = self.equilibrium.as_ref();
        // The displacement by plastic strain is no slip.
        let drift = along
            .zip(self.along_before.as_ref())
            .map(|(now, then)| [0, 1].map(|axis| &now[axis] - &then[axis]));
        let problem = ContactProblem {
            before: self.before,
            guess: latest.map(Guess::Contact).or(pressure.map(Guess::Pressure)),
            drift: drift.as_ref(),
            ..ContactProblem::new(gap, &self.facing.bounds, self.loading, params, watch)
        };
        // Cost of this increment so far.
        let spent = latest.map_or(0.0, |latest| latest.normal().stats.convolutions);
        let mut equilibrium = self.facing.solver.solve(&problem)?;
        equilibrium.normal_mut().stats.convolutions += spent;
        let shear = equilibrium.shear();
        self.pressure.assign(&equilibrium.normal().pressure);
        self.equilibrium = Some(equilibrium);
        Ok(shear)
    }
}

#[cfg(test)]
mod tests;
