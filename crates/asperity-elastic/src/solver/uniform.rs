//! A uniform displacement of any set of cells: a flat punch, or the flux under a uniform drop of temperature.

use ndarray::{Array2, Zip};

use crate::error::{Error, Result, check};
use crate::grid::{CellValues, Field, Grid, SingleField};
use crate::operator::{Compliant, Operator};
use crate::solver::preconditioner::Preconditioner;
use crate::solver::sets::Sets;
use crate::solver::{Params, Stats, self_influence};

/// The traction that displaces a set of cells by 1.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct UniformDisplacement {
    /// The traction q, per unit displacement; 0 off the cells.
    pub traction: Field,
    /// The sum Σ q, with an error of the second order in the residual.
    pub sum: f64,
    /// max |(C + D) q − 1| on the cells, of a true application of the operator.
    pub residual: f64,
    /// |qᵀ(C + D) q/Σ q − 1|: the relative difference of the powers of the field and of the total.
    pub imbalance: f64,
    /// Cost of the solution.
    pub stats: Stats,
}

/// Solves `(C + D) q = 1` on the `cells`, with q = 0 elsewhere, by preconditioned conjugate gradients.
///
/// C is the `operator`, D ≥ 0 the `compliance` of each cell by itself, a number or a field, in the units of
/// C; it does not count off the cells. `start` is a traction near the answer up to a factor, if one is known;
/// off the cells it does not count. The residual max |(C + D) q − 1| is below the tolerance of `params`.
///
/// # Errors
/// [`Error::OutOfRange`] for a compliance that is negative or not finite on a cell, [`Error::NotConverged`],
/// [`Error::Unsupported`] on several ranks, and where nothing determines the traction: all cells of a grid
/// that is periodic along both axes, with D = 0.
///
/// # Panics
/// If a field has another shape than the operator's grid.
pub fn displace_uniformly(
    operator: &mut dyn Operator,
    cells: &Array2<bool>,
    compliance: &CellValues,
    start: Option<&Field>,
    params: &Params,
) -> Result<UniformDisplacement> {
    let grid = *operator.grid();
    assert_eq!(cells.dim(), (grid.shape[0], grid.shape[1]), "shape of the cells");
    assert!(compliance.fits(grid.shape), "shape of the compliance");
    assert!(start.is_none_or(|start| start.dim() == cells.dim()), "shape of the start");
    if !operator.slab().is_whole() {
        return Err(Error::Unsupported("a uniform displacement is not solved on several ranks"));
    }
    let own = on_cells(cells, compliance);
    let expected = "a finite compliance of at least 0";
    own.iter().try_for_each(|own| check("compliance", *own, *own >= 0.0 && own.is_finite(), expected))?;
    let all = cells.iter().all(|is_cell| *is_cell);
    let least = Zip::from(cells)
        .and(&own)
        .fold(f64::INFINITY, |least, is_cell, own| if *is_cell { least.min(*own) } else { least });
    if operator.leaves_mean_free() && all && own.iter().all(|own| *own == 0.0) {
        return Err(Error::Unsupported("a uniform traction on all of a period displaces nothing"));
    }
    let preconditioner = CellPreconditioner::new(operator, cells, &own);
    let mut gradients = Gradients::preconditioned_by(&grid, cells, preconditioner, 0);
    let mut compliant = Compliant::new(&mut *operator, own)?;
    // A traction that is uniform over a period displaces it by D alone: no wave shows how large it is.
    let uniform = (compliant.boundary().leaves_mean_free() && all && least > 0.0).then(|| grid.zeros() + 1.0);
    let mut respond = |[q]: &[Field; 1], [u]: &mut [Field; 1]| compliant.apply(q, u);
    if let Some(start) = start.or(uniform.as_ref()) {
        gradients.begin(&mut respond, start);
    }
    let mut renewed = f64::INFINITY;
    loop {
        while gradients.max_residual() > params.tolerance {
            if gradients.stats.iterations >= params.max_convolutions {
                let Stats { iterations, .. } = gradients.stats;
                let residual = gradients.max_residual();
                return Err(Error::NotConverged { iterations, residual, tolerance: params.tolerance });
            }
            gradients.step(&mut respond)?;
        }
        gradients.renew(&mut respond);
        let residual = gradients.max_residual();
        if residual <= params.tolerance {
            break;
        }
        // The rest that steps cannot remove is rounding.
        if residual > 0.5 * renewed {
            let Stats { iterations, .. } = gradients.stats;
            return Err(Error::NotConverged { iterations, residual, tolerance: params.tolerance });
        }
        renewed = residual;
    }
    let (sum, residual) = (gradients.sum(), gradients.max_residual());
    let Gradients { traction: [traction], residual: [left], stats, .. } = gradients;
    let total = traction.sum();
    let imbalance = if total == 0.0 { 0.0 } else { ((&traction * &left).sum() / total).abs() };
    Ok(UniformDisplacement { traction, sum, residual, imbalance, stats })
}

/// The compliance of each cell, 0 off the cells.
fn on_cells(cells: &Array2<bool>, compliance: &CellValues) -> Field {
    match compliance {
        CellValues::Uniform(value) => cells.mapv(|is_cell| if is_cell { *value } else { 0.0 }),
        CellValues::Field(field) => {
            Zip::from(cells).and(field).map_collect(|is_cell, own| if *is_cell { *own } else { 0.0 })
        }
    }
}

/// Displacements by components of traction.
pub(super) type Respond<'a, const N: usize> = dyn FnMut(&[Field; N], &mut [Field; N]) + 'a;

/// Conjugate gradients for a unit displacement of some cells along one of N components.
pub(super) struct Gradients<const N: usize> {
    /// 1 on the cells, 0 elsewhere.
    mask: Field,
    pub(super) preconditioner: CellPreconditioner,
    /// The component of the displacement.
    component: usize,
    /// The traction so far.
    traction: [Field; N],
    residual: [Field; N],
    direction: [Field; N],
    response: [Field; N],
    single: SingleField,
    preconditioned: [SingleField; N],
    product_before: f64,
    /// Cost so far.
    pub(super) stats: Stats,
}

impl Gradients<1> {
    /// Starts from the multiple of `start` that comes nearest to the answer in the energy.
    fn begin(&mut self, respond: &mut Respond<'_, 1>, start: &Field) {
        let start = [start * &self.mask];
        respond(&start, &mut self.response);
        self.stats.convolutions += 1.0;
        let factor = start[0].sum() / dot(&start, &self.response);
        if factor.is_finite() && factor > 0.0 {
            self.traction = start.map(|start| start * factor);
            self.subtract(factor);
        }
    }

    /// Computes the residual from the traction: the one that the steps have updated has gathered rounding
    /// errors.
    fn renew(&mut self, respond: &mut Respond<'_, 1>) {
        respond(&self.traction, &mut self.response);
        self.stats.convolutions += 1.0;
        let Self { residual: [residual], response: [response], mask, .. } = self;
        Zip::from(residual).and(response).and(mask).for_each(|r, u, inside| *r = (1.0 - *u) * *inside);
        self.product_before = f64::INFINITY;
    }
}

impl<const N: usize> Gradients<N> {
    /// Starts from 0 on the `cells`.
    pub(super) fn preconditioned_by(
        grid: &Grid,
        cells: &Array2<bool>,
        preconditioner: CellPreconditioner,
        component: usize,
    ) -> Self {
        let mask = cells.mapv(|is_cell| f64::from(u8::from(is_cell)));
        let zeros = || std::array::from_fn(|_| grid.zeros());
        let mut residual: [Field; N] = zeros();
        residual[component].assign(&mask);
        Self {
            mask,
            preconditioner,
            component,
            traction: zeros(),
            residual,
            direction: zeros(),
            response: zeros(),
            single: SingleField::zeros(grid.shape),
            preconditioned: std::array::from_fn(|_| SingleField::zeros(grid.shape)),
            product_before: f64::INFINITY,
            stats: Stats::default(),
        }
    }

    /// One step; returns what it adds to the sum of the traction.
    pub(super) fn step(&mut self, respond: &mut Respond<'_, N>) -> Result<f64> {
        let mut product = 0.0;
        for (r, z) in self.residual.iter().zip(&mut self.preconditioned) {
            self.preconditioner.apply(r, &mut self.single, z);
            product += Zip::from(r).and(&*z).fold(0.0, |sum, r, z| sum + r * f64::from(*z));
        }
        let beta = product / self.product_before;
        self.product_before = product;
        for (direction, z) in self.direction.iter_mut().zip(&self.preconditioned) {
            direction.zip_mut_with(z, |d, z| *d = f64::from(*z) + beta * *d);
        }
        respond(&self.direction, &mut self.response);
        let step = product / dot(&self.direction, &self.response);
        check("stiffness", step, step.is_finite(), "a number in double precision")?;
        for (traction, direction) in self.traction.iter_mut().zip(&self.direction) {
            traction.scaled_add(step, direction);
        }
        self.subtract(step);
        self.stats.iterations += 1;
        self.stats.convolutions += N as f64;
        Ok(step * product)
    }

    /// Takes a multiple of the response off the residual.
    fn subtract(&mut self, step: f64) {
        for (residual, response) in self.residual.iter_mut().zip(&self.response) {
            let cells = Zip::from(residual).and(response).and(&self.mask);
            cells.for_each(|r, u, inside| *r -= step * *u * *inside);
        }
    }

    /// Steps until the sum of the traction is known to a tenth of the tolerance.
    pub(super) fn converge(&mut self, respond: &mut Respond<'_, N>, params: &Params) -> Result<()> {
        // From 0: the sum lacks what the steps to come will add, and none of them takes from it.
        let tolerance = ACCURACY * params.tolerance;
        let mut added = [f64::INFINITY; LAST_STEPS];
        while self.max_residual() != 0.0
            && added.iter().sum::<f64>() > tolerance * self.traction[self.component].sum()
        {
            let iterations = self.stats.iterations;
            if iterations >= params.max_convolutions {
                let residual = added.iter().sum::<f64>() / self.traction[self.component].sum();
                return Err(Error::NotConverged { iterations, residual, tolerance });
            }
            added.rotate_left(1);
            added[LAST_STEPS - 1] = self.step(respond)?;
        }
        Ok(())
    }

    /// Largest residual.
    pub(super) fn max_residual(&self) -> f64 {
        self.residual.iter().flatten().fold(0.0, |most, r| most.max(r.abs()))
    }

    /// 2 Σ q − qᵀC q, the sum of the traction with an error of the second order in the residual.
    pub(super) fn sum(&self) -> f64 {
        let components = self.traction.iter().zip(&self.residual).enumerate();
        let of_component = |(component, (traction, residual))| {
            let one = f64::from(u8::from(component == self.component));
            Zip::from(traction).and(residual).fold(0.0, |sum, q, r| sum + q * (one + r))
        };
        components.map(of_component).sum()
    }
}

/// Number of last steps of conjugate gradients whose total contribution to the sum must be small.
const LAST_STEPS: usize = 2;
/// Fraction of the tolerance that the last steps may contribute to the sum.
const ACCURACY: f64 = 0.1;

fn dot<const N: usize>(a: &[Field; N], b: &[Field; N]) -> f64 {
    a.iter().zip(b).map(|(a, b)| (a * b).sum()).sum()
}

/// The preconditioner: that of a contact on the cells which the bodies displace, and their own compliance on
/// those which hardly anything else displaces.
pub(super) struct CellPreconditioner {
    sets: Sets,
    /// None without cells that the bodies displace.
    bodies: Option<Preconditioner>,
    /// Flat cells whose own compliance is much larger than that of the bodies, with the inverse of it.
    alone: Vec<(usize, f32)>,
}

impl CellPreconditioner {
    /// Preconditioner of cells without a compliance of their own.
    pub(super) fn alike(operator: &dyn Operator, cells: &Array2<bool>) -> Self {
        let sets = sets(cells.dim().into(), cells.iter().copied().collect());
        let mut bodies = Preconditioner::new(operator);
        bodies.adapt(&sets);
        Self { sets, bodies: Some(bodies), alone: Vec::new() }
    }

    /// Preconditioner of cells of this compliance, which is 0 outside the cells.
    fn new(operator: &mut dyn Operator, cells: &Array2<bool>, own: &Field) -> Self {
        let influence = self_influence(operator);
        let is_alone = |own: f64| own > ALONE * influence;
        let flat = || cells.iter().zip(own).enumerate();
        let alone = flat().filter(|(_, (is_cell, own))| **is_cell && is_alone(**own));
        let alone = alone.map(|(cell, (_, own))| (cell, (influence + own).recip() as f32)).collect();
        let displaced: Vec<bool> = flat().map(|(_, (is_cell, own))| *is_cell && !is_alone(*own)).collect();
        let count = displaced.iter().filter(|is| **is).count();
        let values = || displaced.iter().zip(own).filter(|(is, _)| **is).map(|(_, own)| *own);
        let mean = values().sum::<f64>() / count.max(1) as f64;
        let uniform = values().all(|own| (own - mean).abs() <= 1e-6 * mean);
        let mut compliance = own.clone();
        compliance.iter_mut().zip(&displaced).for_each(|(own, is)| *own = if *is { *own } else { mean });
        let sets = sets(cells.dim().into(), displaced);
        let bodies = (count > 0).then(|| {
            let compliance = if uniform { CellValues::Uniform(mean) } else { CellValues::Field(compliance) };
            let mut bodies = match Compliant::new(operator, compliance) {
                Ok(compliant) => Preconditioner::new(&compliant),
                Err(_) => unreachable!("a mean of compliances that are at least 0 and below a bound"),
            };
            bodies.adapt(&sets);
            bodies
        });
        Self { sets, bodies, alone }
    }

    /// Computes the preconditioned residual.
    pub(super) fn apply(
        &mut self,
        residual: &Field,
        single: &mut SingleField,
        preconditioned: &mut SingleField,
    ) {
        let Self { sets, bodies, alone } = self;
        single.zip_mut_with(residual, |single, r| *single = *r as f32);
        let [r, z] = [&mut *single, preconditioned].map(|f| f.as_slice_mut().expect("standard layout"));
        let of_alone: Vec<f32> = alone.iter().map(|(cell, inverse)| inverse * r[*cell]).collect();
        alone.iter().for_each(|(cell, _)| r[*cell] = 0.0);
        match bodies {
            Some(bodies) => {
                bodies.apply(sets, |cell| r[cell], z);
            }
            None => z.fill(0.0),
        }
        alone.iter().zip(of_alone).for_each(|((cell, _), own)| z[*cell] = own);
    }
}

fn sets(shape: [usize; 2], is_free: Vec<bool>) -> Sets {
    let mut sets = Sets::new(shape);
    sets.free_where(|cell| is_free[cell]);
    sets
}

/// Ratio of a cell's own compliance to its self-influence above which the cell stands alone in the
/// preconditioner.
const ALONE: f64 = 10.0;
