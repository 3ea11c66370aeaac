//! Contact of viscoelastic bodies in time: what they remember of their loads, step by step.

use crate::error::{Result, check_in};
use crate::grid::{Field, in_rows};
use crate::operator::Operator;
use crate::solver::{Bounds, Control, Params, Solution, Watch, solve_normal_watched};
use crate::units::{Dimension, Pascal, PerPascal, Second};
use crate::viscoelastic::series::Creep;

/// Memory of the loads of a body, or of a pair at full overlap.
///
/// For each retardation time a field z on all of its cells, with `ρ ż = Lp − z`, where L is the elastic
/// half-space of a unit modulus. The displacement is `J_g Lp + Σ J_k z_k`. In a step of the time Δt, in which
/// Lp changes linearly, with e = e^(−Δt/ρ) and φ = (1 − e)ρ/Δt,
///
/// ```text
/// z ← e z + (φ − e) Lp_before + (1 − φ) Lp
/// ```
///
/// so that the step is an elastic contact with another compliance on another gap. Without a step of time the
/// body answers as glass.
#[derive(Debug, Clone, PartialEq)]
pub struct CreepMemory {
    creep: Creep,
    /// The field z of each term.
    delayed: Vec<Field>,
    /// Lp at the end of the last step.
    elastic: Field,
}

impl CreepMemory {
    /// Creates a body of `shape` cells with this `creep` compliance that has borne no load.
    pub fn new(creep: Creep, shape: [usize; 2]) -> Self {
        let delayed = vec![Field::zeros(shape); creep.terms.len()];
        Self { creep, delayed, elastic: Field::zeros(shape) }
    }

    /// Restores a body from the field z of each term of its `creep` compliance, and Lp at the end of the last
    /// step.
    ///
    /// # Panics
    /// If there is not a field for each term.
    pub fn restored(creep: Creep, delayed: Vec<Field>, elastic: Field) -> Self {
        assert_eq!(creep.terms.len(), delayed.len(), "a field for each term");
        Self { creep, delayed, elastic }
    }

    /// The field z of each term, Pa m.
    pub fn delayed(&self) -> &[Field] {
        &self.delayed
    }

    /// Lp at the end of the last step, Pa m.
    pub fn elastic(&self) -> &Field {
        &self.elastic
    }

    /// Returns the compliance with which a step of the time `duration` ≥ 0 answers: `J_g + Σ J_k (1 − φ_k)`.
    pub fn compliance(&self, duration: Second) -> PerPascal {
        let terms = self.creep.terms.iter().map(|term| term.compliance * weights(duration, term.time)[2]);
        self.creep.glassy + terms.sum::<f64>()
    }

    /// Computes the displacement at the end of a step of the time `duration` in which the body bears no more
    /// than before: `Σ J_k [e_k z_k + (φ_k − e_k) Lp]`, m.
    pub fn history(&self, duration: Second) -> Field {
        let mut history = Field::zeros(self.elastic.raw_dim());
        for (term, delayed) in self.creep.terms.iter().zip(&self.delayed) {
            let [kept, before, _] = weights(duration, term.time).map(|weight| term.compliance * weight);
            history.zip_mut_with(delayed, |history, z| *history += kept * z);
            history.scaled_add(before, &self.elastic);
        }
        history
    }

    /// Computes the present displacement: `J_g Lp + Σ J_k z_k`, m.
    pub fn displacement(&self) -> Field {
        let mut displacement = self.history(0.0);
        displacement.scaled_add(self.creep.glassy, &self.elastic);
        displacement
    }

    /// Unloads the body at once, and leaves it alone for the time `duration`.
    pub fn recover(&mut self, duration: Second) {
        self.advance(Field::zeros(self.elastic.raw_dim()), 0.0);
        self.advance(Field::zeros(self.elastic.raw_dim()), duration);
    }

    /// Advances by the time `duration`, at the end of which the elastic half-space of a unit modulus would be
    /// displaced by `elastic`, Pa m.
    ///
    /// # Panics
    /// If the field has another shape than the body.
    pub fn advance(&mut self, elastic: Field, duration: Second) {
        assert_eq!(elastic.dim(), self.elastic.dim(), "shape of the displacement");
        for (term, delayed) in self.creep.terms.iter().zip(&mut self.delayed) {
            let [kept, before, now] = weights(duration, term.time);
            let fields = delayed.iter_mut().zip(&self.elastic).zip(&elastic);
            fields.for_each(|((z, then), elastic)| *z = kept * *z + before * then + now * elastic);
        }
        self.elastic = elastic;
    }
}

/// Returns e, φ − e and 1 − φ.
fn weights(duration: Second, time: Second) -> [f64; 3] {
    if duration == 0.0 {
        return [1.0, 0.0, 0.0];
    }
    let x = duration / time;
    let (kept, share) = ((-x).exp(), -(-x).exp_m1() / x);
    [kept, share - kept, 1.0 - share]
}

/// Solves the contact at the end of a step of the time `duration`, and advances the `memory` of the bodies.
/// The `operator` is that of elastic half-spaces with the composite `modulus`, on the grid of the memory. A
/// load or an approach that changes at once has the duration 0. `start` is a pressure near the solution.
///
/// # Errors
/// [`Error::OutOfRange`](crate::Error::OutOfRange) for a time that is not finite and ≥ 0; the errors of
/// [`solve_normal`](crate::solver::solve_normal).
///
/// # Panics
/// If a field has another shape than the operator's grid.
#[expect(clippy::too_many_arguments, reason = "the contact, its memory, and what is asked of it")]
pub fn solve_in_time(
    operator: &mut dyn Operator,
    modulus: Pascal,
    memory: &mut CreepMemory,
    initial_gap: &Field,
    control: Control,
    duration: Second,
    start: Option<&Field>,
    params: &Params,
    watch: &dyn Watch,
) -> Result<Solution> {
    let is_time = duration >= 0.0 && duration.is_finite();
    check_in(Dimension::Time, "duration", duration, is_time, "a finite time of at least 0")?;
    let (compliance, history) = (memory.compliance(duration), memory.history(duration));
    let (solution, elastic) =
        solve_step(operator, modulus, (compliance, &history), initial_gap, control, start, params, watch)?;
    memory.advance(elastic, duration);
    Ok(solution)
}

/// Solves the contact at the end of a step in which the bodies answer with this compliance, beyond their
/// displacement by earlier loads. Returns it with the displacement Lp of the elastic half-space of a unit
/// modulus.
#[expect(clippy::too_many_arguments, reason = "the contact, the answer of the bodies, and who looks on")]
pub(crate) fn solve_step(
    operator: &mut dyn Operator,
    modulus: Pascal,
    (compliance, history): (PerPascal, &Field),
    initial_gap: &Field,
    control: Control,
    start: Option<&Field>,
    params: &Params,
    watch: &dyn Watch,
) -> Result<(Solution, Field)> {
    // The pressures of the elastic contact are those of this one times its compliance over that of the
    // operator.
    let scale = compliance * modulus;
    let gap = history + &*in_rows(initial_gap);
    let control = match control {
        Control::Load(load) => Control::Load(scale * load),
        approach @ Control::Approach(_) => approach,
    };
    let start = start.map(|start| start * scale);
    let start = start.as_ref();
    let solved = solve_normal_watched(operator, &gap, &Bounds::ELASTIC, control, start, params, watch)?;
    let elastic = &solved.displacement / compliance;
    let solution = Solution {
        initial_gap: initial_gap.clone(),
        pressure: solved.pressure / scale,
        displacement: solved.displacement + history,
        ..solved
    };
    Ok((solution, elastic))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::Grid;
    use crate::operator::{Boundary, Edge, FreeFft, Operators};
    use crate::reference::viscoelastic::sphere_under_step;
    use crate::viscoelastic::{Relaxation, RelaxationTerm, SteadySliding, solve_steady};

    /// A body with E₀ = 1, this glassy modulus and this retardation time.
    fn standard(glassy: f64, time: f64) -> Relaxation {
        Relaxation::new(1.0, [RelaxationTerm { modulus: glassy - 1.0, time: time / glassy }]).unwrap()
    }

    fn paraboloid(grid: &Grid, middle: f64) -> Field {
        let at = |axis: usize, n: usize| grid.centre(axis, n) - 0.5 * grid.extent()[axis];
        Field::from_shape_fn(grid.shape, |(i, j)| {
            0.5 * ((grid.centre(0, i) - middle).powi(2) + at(1, j).powi(2))
        })
    }

    const FINE: Params = Params::new().with_tolerance(1e-8);

    #[test]
    fn a_sphere_under_a_step_of_load_creeps_as_lee_and_radok_say() {
        let (body, load, n) = (standard(10.0, 1.0), 0.01, 48);
        let dx = 2.3 * (0.75f64 * load).cbrt() / n as f64;
        let grid = Grid::new([n, n], [dx; 2]).unwrap();
        let gap = paraboloid(&grid, 0.5 * grid.extent()[0]);
        let errors = [8, 32].map(|steps| {
            let mut operator = FreeFft::new(grid, 1.0);
            let mut memory = CreepMemory::new(body.creep(), grid.shape);
            let mut press = |duration: f64, start: Option<&Field>| {
                let control = Control::Load(load);
                solve_in_time(&mut operator, 1.0, &mut memory, &gap, control, duration, start, &FINE, &())
                    .unwrap()
            };
            let mut found = press(0.0, None);
            let mut errors =
                vec![found.approach / sphere_under_step(1.0, load, body.creep().compliance(0.0))[0] - 1.0];
            let time = |step: usize| 2.0 * (step as f64 / steps as f64).powi(2);
            for step in 1..=steps {
                found = press(time(step) - time(step - 1), Some(&found.pressure));
                assert!((found.load() / load - 1.0).abs() < 1e-9 && found.residual < 1e-8);
                errors.push(
                    found.approach / sphere_under_step(1.0, load, body.creep().compliance(time(step)))[0]
                        - 1.0,
                );
            }
            errors
        });
        // The error is that of the grid: the same with eight steps as with more.
        assert!(errors.iter().flatten().all(|error| error.abs() < 6e-4), "{errors:?}");
        assert!((errors[0][8] - errors[1][32]).abs() < 1e-6, "{errors:?}");
    }

    #[test]
    fn a_sphere_at_an_approach_relaxes_as_its_modulus_with_the_second_order() {
        let (body, n) = (standard(5.0, 1.0), 24);
        let grid = Grid::new([n, n], [1.0 / n as f64; 2]).unwrap();
        let gap = paraboloid(&grid, 0.5);
        let time = 0.4;
        let modulus = |t: f64| 1.0 + 4.0 * (-t / 0.2).exp();
        let errors = [4, 8, 16].map(|steps| {
            let mut operator = FreeFft::new(grid, 1.0);
            let mut memory = CreepMemory::new(body.creep(), grid.shape);
            let mut press = |duration: f64| {
                let control = Control::Approach(0.05);
                solve_in_time(&mut operator, 1.0, &mut memory, &gap, control, duration, None, &FINE, &())
                    .unwrap()
            };
            let first = press(0.0).load();
            let loads: Vec<f64> = (0..steps).map(|_| press(time / f64::from(steps)).load()).collect();
            let last = loads[loads.len() - 1];
            last / first / (modulus(time) / modulus(0.0)) - 1.0
        });
        let order = (errors[0] / errors[2]).abs().log2() / 2.0;
        assert!(errors[2].abs() < 2e-3 && (1.8..2.2).contains(&order), "{errors:?}, order {order}");
    }

    #[test]
    fn a_pass_over_a_long_body_becomes_steady_with_the_second_order() {
        let line = Boundary([Edge::Free, Edge::Periodic]);
        let (body, load, speed) = (standard(10.0, 0.1), 0.05, 2.0);
        let creep = body.creep();
        let n = 64;
        let dx = 0.7 / n as f64;
        // In the frame of the contact.
        let near = Grid::new([n, 1], [dx; 2]).unwrap();
        let shape = |grid: &Grid, at: f64| {
            Field::from_shape_fn(grid.shape, |(i, _)| 0.5 * (grid.centre(0, i) - at).powi(2))
        };
        let mut operator = SteadySliding::new(near, line, &creep, speed).unwrap();
        let middle = 0.5 * near.extent()[0];
        let control = Control::Load(load * dx);
        let steady = solve_steady(&mut operator, &shape(&near, middle), control, None, &FINE, &()).unwrap();
        let moment = |grid: &Grid, pressure: &Field, at: f64| {
            dx * pressure.indexed_iter().map(|((i, _), p)| p * (grid.centre(0, i) - at)).sum::<f64>() / load
        };
        let wanted = moment(&near, &steady.solution.pressure, middle);
        // In the frame of the body, which the contact has never touched before.
        let grid = Grid::new([4 * n, 1], [dx; 2]).unwrap();
        let errors = [4usize, 2].map(|stride| {
            let mut elastic = Operators::new(grid, 1.0, line).on(grid.shape);
            let mut memory = CreepMemory::new(creep.clone(), grid.shape);
            let (mut at, mut duration) = (middle, 0.0);
            let mut pressure = None;
            while at < grid.extent()[0] - middle {
                let gap = shape(&grid, at);
                let found = solve_in_time(
                    elastic.as_mut(),
                    1.0,
                    &mut memory,
                    &gap,
                    control,
                    duration,
                    pressure.as_ref(),
                    &FINE,
                    &(),
                );
                pressure = Some(found.unwrap().pressure);
                duration = stride as f64 * dx / speed;
                at += stride as f64 * dx;
            }
            let last = at - stride as f64 * dx;
            moment(&grid, &pressure.unwrap(), last) / wanted - 1.0
        });
        let order = (errors[0] / errors[1]).abs().log2();
        assert!(errors[1].abs() < 1e-2 && (1.5..3.0).contains(&order), "{errors:?}, order {order}");
    }

    #[test]
    fn no_time_is_not_a_time_before() {
        let grid = Grid::new([4, 4], [1.0; 2]).unwrap();
        let mut memory = CreepMemory::new(standard(2.0, 1.0).creep(), grid.shape);
        let mut operator = FreeFft::new(grid, 1.0);
        let control = Control::Load(1.0);
        let error =
            solve_in_time(&mut operator, 1.0, &mut memory, &grid.zeros(), control, -1.0, None, &FINE, &());
        assert!(error.unwrap_err().to_string().contains("duration"));
    }
}
