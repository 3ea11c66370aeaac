//! A contact at rest between bodies of which one or both may flow.

use super::body::{Action, PlasticBody};
use super::increment::{FlowParams, Increment, Loading, advance};
use crate::error::{Error, Result};
use crate::grid::Field;
use crate::operator::Operator;
use crate::solver::{Bounds, Control, Params, Solution, solve_normal};
use crate::subsurface::Tractions;
use crate::units::{Joule, Metre, Newton};

/// A contact that is loaded and unloaded increment by increment, of one body that may flow, or of two.
///
/// The gap is that of the undeformed bodies; their plastic strain opens it by r: g = h − δ + C p + r_lower + r_upper.
pub struct PlasticContact {
    operator: Box<dyn Operator>,
    initial_gap: Field,
    bodies: Vec<PlasticBody>,
    flow: FlowParams,
    contact: Params,
    increments: usize,
    /// Pressure, C p and approach of the last increment.
    pressure: Field,
    elastic: Field,
    approach: Option<Metre>,
}

impl PlasticContact {
    /// Bodies that do not touch yet. The operator is that of the pair; the `bodies` are those of the pair that may flow.
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
            bodies,
            flow,
            contact,
            increments: 0,
            pressure: zeros.clone(),
            elastic: zeros,
            approach: None,
        }
    }

    /// Goes on to a load (0: the bodies are taken apart) or an approach in one increment.
    ///
    /// # Errors
    /// [`Error::AtIncrement`] with what is wrong there: [`Error::FlowNotConverged`], or what [`solve_normal`] finds.
    pub fn go_to(&mut self, control: Control) -> Result<Increment> {
        self.increments += 1;
        let Self { operator, initial_gap, bodies, flow, contact, pressure, .. } = self;
        let mut pressing = Pressing {
            operator: operator.as_mut(),
            initial_gap,
            control,
            params: contact,
            pressure: pressure.clone(),
            solution: None,
            bodies: bodies.len(),
        };
        let mut flowing: Vec<&mut PlasticBody> = bodies.iter_mut().collect();
        let at = |source| Error::AtIncrement { increment: self.increments, source: Box::new(source) };
        let increment = advance(&mut flowing, &mut pressing, Some([0, 0]), flow).map_err(at)?;
        let Pressing { pressure, solution, .. } = pressing;
        self.approach = solution.as_ref().map(|solution| solution.approach);
        self.elastic =
            solution.map_or_else(|| Field::zeros(pressure.raw_dim()), |solution| solution.displacement);
        self.pressure = pressure;
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
        self.approach
    }

    /// The bodies that may flow.
    pub fn bodies(&mut self) -> &mut [PlasticBody] {
        &mut self.bodies
    }

    /// What the surfaces have moved apart by, C p + r, m; under a periodic boundary the mean of C p is zero.
    pub fn displacement(&self) -> Field {
        self.bodies.iter().fold(self.elastic.clone(), |sum, body| sum + body.displacement())
    }

    /// Elastic energy ½ ΔA Σ p C p under the pressure, J: without that of the residual stress.
    pub fn elastic_energy(&self) -> Joule {
        0.5 * self.operator.grid().cell_area() * (&self.pressure * &self.elastic).sum()
    }
}

/// Presses bodies together under one load or at one approach.
struct Pressing<'a> {
    operator: &'a mut dyn Operator,
    initial_gap: &'a Field,
    control: Control,
    params: &'a Params,
    /// The last pressure: a start for the next.
    pressure: Field,
    solution: Option<Solution>,
    bodies: usize,
}

impl Loading for Pressing<'_> {
    fn act(&mut self, residual: &[Field]) -> Result<Vec<Action>> {
        if self.control == Control::Load(0.0) {
            self.pressure.fill(0.0);
            self.solution = None;
        } else {
            let gap = residual.iter().fold(self.initial_gap.clone(), |gap, r| gap + r);
            let start = self.pressure.iter().any(|p| *p > 0.0).then_some(&self.pressure);
            let solution =
                solve_normal(self.operator, &gap, &Bounds::ELASTIC, self.control, start, self.params)?;
            self.pressure.assign(&solution.pressure);
            self.solution = Some(solution);
        }
        Ok((0..self.bodies)
            .map(|_| Action::Tractions(Tractions::frictionless(self.pressure.clone())))
            .collect())
    }
}

#[cfg(test)]
mod tests;
