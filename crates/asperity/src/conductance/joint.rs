//! The solution of a joint.

use ndarray::{Array2, Zip};

use crate::conductance::{ContactSpots, Gas, Joint};
use crate::error::{Error, Result, check};
use crate::grid::{CellValues, Field, Grid};
use crate::operator::{Boundary, Operator};
use crate::solver::{Params, Stats, UniformDisplacement, displace_uniformly};

/// Conductance of a contact.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Conductance {
    /// Grid of the contact.
    pub grid: Grid,
    /// Conductance G ≥ 0, W/K or S; 0 where nothing conducts. `None` where the joint adds no resistance: all of a period
    /// touches without a film.
    pub conductance: Option<f64>,
    /// Flux q per unit drop from the warmer body into the other, W/(m² K) or S/m², 0 in cells that do not conduct. `None` with
    /// the conductance: any flux then passes without a drop.
    pub flux: Option<Field>,
    /// Shares of what conducts.
    pub shares: Shares,
    /// The spots of the contact.
    pub spots: ContactSpots,
    /// Resistance of the clean spots alone by [`ContactSpots::holm_greenwood`], K/W or Ω; `None` without contact, and under a
    /// boundary that repeats itself, where spots have no end.
    pub holm_greenwood: Option<f64>,
    /// Residual max |(C + D) q/V − 1| on the cells that conduct.
    pub residual: f64,
    /// |qᵀ(C + D)q/(V Σ q) − 1|: how far the power of the field is from that of the joint as a whole. It is at most the residual
    /// unless fluxes differ in sign.
    pub imbalance: f64,
    /// Cost of the solution.
    pub stats: Stats,
}

/// Shares of spots, gas and film.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Shares {
    /// Share of the flux that passes through cells in contact, 0 to 1; 0 where nothing conducts.
    pub spots: f64,
    /// Share of the flux that passes through the gas, 0 to 1.
    pub gas: f64,
    /// Share ρ_f Σ q²/(V Σ q) of the resistance that the film on the spots takes, 0 to 1: above ½ the number given for the
    /// film decides.
    pub film: f64,
}

impl Conductance {
    /// Joint conductance h = G/A over the apparent area, that of the grid, W/(m² K) or S/m²; `None` with the conductance.
    pub fn joint_conductance(&self) -> Option<f64> {
        self.conductance.map(|conductance| conductance / self.grid.area())
    }

    /// Resistance R = 1/G, K/W or Ω; `None` where it is none (the conductance is `None`) and where nothing conducts (the
    /// conductance is 0).
    pub fn resistance(&self) -> Option<f64> {
        self.conductance.filter(|conductance| *conductance > 0.0).map(f64::recip)
    }

    /// Power that passes under a `drop` V, K or V: the heat GV in W, the Joule heat GV² in W. `None` with the conductance.
    pub fn power(&self, joint: &Joint, drop: f64) -> Option<f64> {
        let flow = self.conductance.map(|conductance| conductance * drop);
        match joint.kind {
            super::Kind::Thermal => flow,
            super::Kind::Electrical => flow.map(|current| current * drop),
        }
    }
}

/// Solves a joint for its conductance.
///
/// `operator` makes a drop of a flux: of the composite conductivity κ_s in place of E*, or of
/// [`conductance::response`](super::response). `touching` are the cells in contact. `gap` is the deformed gap, m, of which open
/// cells count, negative ones as 0; it is needed with gas alone. `start` is a flux near the answer, up to a factor, such as that
/// of the position before, if one is known. Of the `params` tolerance and largest number of operator calls count: the
/// conductance has an error of about the square of the residual.
///
/// # Errors
/// [`Error::OutOfRange`] for a joint or a gap outside its range, [`Error::Unsupported`] for gas without a gap, for gas between
/// electrical conductors and on several ranks, [`Error::NotConverged`].
///
/// # Panics
/// If a field has another shape than the operator's grid.
pub fn solve(
    operator: &mut dyn Operator,
    touching: &Array2<bool>,
    gap: Option<&Field>,
    joint: &Joint,
    start: Option<&Field>,
    params: &Params,
) -> Result<Conductance> {
    joint.check()?;
    let grid = *operator.grid();
    assert_eq!(touching.dim(), (grid.shape[0], grid.shape[1]), "shape of the cells in contact");
    let (conducting, resistance) = cells(touching, gap, joint)?;
    let boundary = operator.boundary();
    let spots = ContactSpots::new(&grid, touching, boundary.wraps());
    let alone = boundary == Boundary::FREE;
    let holm_greenwood = alone.then(|| spots.holm_greenwood(joint.composite)).flatten();
    let found = |conductance, flux, shares| Conductance {
        grid,
        conductance,
        flux,
        shares,
        spots,
        holm_greenwood,
        residual: 0.0,
        imbalance: 0.0,
        stats: Stats::default(),
    };
    if !conducting.iter().any(|conducts| *conducts) {
        return Ok(found(Some(0.0), Some(grid.zeros()), Shares::default()));
    }
    let perfect = operator.leaves_mean_free()
        && conducting.iter().all(|conducts| *conducts)
        && resistance.min() == 0.0
        && resistance.max() == 0.0;
    if perfect {
        return Ok(found(None, None, Shares { spots: 1.0, ..Shares::default() }));
    }
    let UniformDisplacement { traction: flux, sum, residual, imbalance, stats, .. } =
        displace_uniformly(operator, &conducting, &resistance, start, params)?;
    let conductance = grid.cell_area() * sum;
    check("conductance", conductance, conductance.is_finite(), "a number in double precision")?;
    let shares = shares(&flux, touching, joint.film);
    Ok(Conductance { residual, imbalance, stats, ..found(Some(conductance), Some(flux), shares) })
}

/// Resistance R_full of a joint all of whose cells touch without a film, K/W or Ω: that of the spreading from the grid into the
/// half-spaces. R − R_full is what the roughness adds. `None` under a periodic boundary, where there is no spreading.
///
/// It depends on the operator alone: of contacts on one grid it is computed once.
///
/// # Errors
/// [`Error::NotConverged`], [`Error::Unsupported`] on several ranks.
pub fn full_resistance(operator: &mut dyn Operator, params: &Params) -> Result<Option<f64>> {
    if operator.leaves_mean_free() {
        return Ok(None);
    }
    let grid = *operator.grid();
    let all = Array2::from_elem(grid.shape, true);
    let found = displace_uniformly(operator, &all, &CellValues::Uniform(0.0), None, params)?;
    Ok(Some((grid.cell_area() * found.sum).recip()))
}

/// The cells that conduct, and their resistance D of an area.
fn cells(touching: &Array2<bool>, gap: Option<&Field>, joint: &Joint) -> Result<(Array2<bool>, CellValues)> {
    let Some(Gas { conductivity, jump }) = joint.gas else {
        return Ok((touching.clone(), joint.film.into()));
    };
    let Some(gap) = gap else {
        return Err(Error::Unsupported(
            "gas conducts across the gap between the bodies, and there is no gap",
        ));
    };
    assert_eq!(gap.dim(), touching.dim(), "shape of the gap");
    let open = || gap.iter().zip(touching).filter(|(_, touches)| !**touches).map(|(gap, _)| *gap);
    open().try_for_each(|gap| check("gap", gap, gap.is_finite(), "a finite gap in all open cells"))?;
    let resistance = Zip::from(touching)
        .and(gap)
        .map_collect(|touches, gap| if *touches { joint.film } else { (gap.max(0.0) + jump) / conductivity });
    Ok((touching.mapv(|_| true), resistance.into()))
}

/// Shares of a flux.
fn shares(flux: &Field, touching: &Array2<bool>, film: f64) -> Shares {
    let total = flux.sum();
    let mut sums = [0.0; 2];
    Zip::from(flux).and(touching).for_each(|q, touches| {
        if *touches {
            sums[0] += q;
            sums[1] += film * q * q;
        }
    });
    let [spots, film] = sums.map(|sum| if total > 0.0 { sum / total } else { 0.0 });
    Shares { spots, gas: if total > 0.0 { 1.0 - spots } else { 0.0 }, film }
}
