//! The solution of a joint.

use ndarray::{Array2, Zip};

use crate::error::{Error, Result, check, check_in};
use crate::grid::{CellValues, Field, Grid, in_rows};
use crate::operator::{Boundary, Operator};
use crate::solver::{Params, Stats, UniformDisplacement, displace_uniformly};
use crate::units::Dimension;
use crate::with::conductance::{ContactSpots, Joint};

/// Conductance of a contact.
#[derive(Debug, Clone)]
#[non_exhaustive]
pub struct Conductance {
    /// Grid of the contact.
    pub grid: Grid,
    /// Continuation of the contact beyond its grid.
    pub boundary: Boundary,
    /// Conductance G ≥ 0, W/K or S; 0 where nothing conducts. `None` where the joint adds no resistance: all
    /// of a period touches without a film.
    pub conductance: Option<f64>,
    /// Flux q per unit drop from the warmer body into the other, W/(m² K) or S/m², 0 in cells that do not
    /// conduct. `None` with the conductance: any flux then passes without a drop.
    pub flux: Option<Field>,
    /// Shares of what conducts.
    pub shares: Shares,
    /// The spots of the contact.
    pub spots: ContactSpots,
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
    /// Share ρ_f Σ q²/(V Σ q) of the resistance that the film on the spots takes, 0 to 1: above ½ the number
    /// given for the film decides.
    pub film: f64,
}

impl Conductance {
    /// Joint conductance h over the apparent area A, that of the grid, W/(m² K) or S/m²: what the joint alone
    /// conducts.
    ///
    /// Under a periodic boundary it is G/A. Else G includes the spreading from the outline of the grid into
    /// the half-spaces, whose resistance `full` is that of [`full_resistance`]. The joint has 1/((R − R_full)
    /// A). `None` with the conductance, and where the resistance cannot be split: the spots lie in a part of
    /// the grid, as those of a ball, or all of the grid touches.
    pub fn joint_conductance(&self, full: Option<f64>) -> Option<f64> {
        /// Share of R − R_full in R above which it is more than the error of the solution.
        const SIGNIFICANT: f64 = 1e-6;
        let conductance = self.conductance?;
        let area = self.grid.area();
        if conductance == 0.0 || self.boundary == Boundary::PERIODIC {
            return Some(conductance / area);
        }
        let resistance = conductance.recip();
        let of_joint = resistance - full.filter(|_| self.fills_the_grid())?;
        (of_joint > SIGNIFICANT * resistance).then(|| (of_joint * area).recip())
    }

    /// Whether the flux is spread over all of the grid along its free axes: the variance of its places is at
    /// least a part of that of an even flux.
    fn fills_the_grid(&self) -> bool {
        /// Variance of a disc a third as wide as the grid.
        const LEAST: f64 = 0.1;
        let Some(flux) = &self.flux else { return true };
        let total = flux.sum();
        (0..2).filter(|axis| !self.boundary.repeats(*axis)).all(|axis| {
            let count = self.grid.shape[axis] as f64;
            let lines = flux.sum_axis(ndarray::Axis(1 - axis));
            let moment = |place: &dyn Fn(f64) -> f64| {
                lines.iter().enumerate().map(|(i, q)| place(i as f64) * q).sum::<f64>() / total
            };
            let middle = moment(&|i| i);
            moment(&|i| (i - middle).powi(2)) >= LEAST * (count * count - 1.0) / 12.0
        })
    }

    /// Resistance R = 1/G, K/W or Ω; `None` where it is none (the conductance is `None`) and where nothing
    /// conducts (the conductance is 0).
    pub fn resistance(&self) -> Option<f64> {
        self.conductance.filter(|conductance| *conductance > 0.0).map(f64::recip)
    }

    /// Resistance of the clean spots alone by [`ContactSpots::holm_greenwood`] between bodies of this
    /// `composite` conductivity, K/W or Ω; `None` without contact, and under a boundary that repeats itself,
    /// where spots have no end.
    pub fn holm_greenwood(&self, composite: f64) -> Option<f64> {
        let is_alone = self.boundary == Boundary::FREE;
        is_alone.then(|| self.spots.holm_greenwood(composite)).flatten()
    }

    /// Power that passes under the drop V of the `joint`, K or V: the heat GV in W, the Joule heat GV² in W.
    /// `None` with the conductance.
    pub fn power(&self, joint: &Joint) -> Option<f64> {
        let flow = self.conductance.map(|conductance| conductance * joint.drop);
        match joint.kind {
            super::Kind::Thermal => flow,
            super::Kind::Electrical => flow.map(|current| current * joint.drop),
        }
    }
}

/// Solves a joint for its conductance.
///
/// `operator` makes a drop of a flux: of the composite conductivity κ_s in place of E*, or of
/// [`conductance::response`](super::response). `touching` are the cells in contact. `gap` is the deformed
/// gap, m, of which open cells count, negative ones as 0; it is needed with gas alone. `start` is a flux near
/// the answer, up to a factor, such as that of the position before, if one is known. Of the `params`
/// tolerance and largest number of operator calls count: the conductance has an error of about the square of
/// the residual.
///
/// # Errors
/// [`Error::OutOfRange`] for a joint or a gap outside its range, [`Error::Unsupported`] for gas without a
/// gap, for gas between electrical conductors and on several ranks, [`Error::NotConverged`].
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
    let (touching, gap, start) = (in_rows(touching), gap.map(in_rows), start.map(in_rows));
    let (touching, gap, start) = (&*touching, gap.as_deref(), start.as_deref());
    let grid = *operator.grid();
    assert_eq!(touching.dim(), (grid.shape[0], grid.shape[1]), "shape of the cells in contact");
    let (conducting, resistance) = cells(touching, gap, joint)?;
    let boundary = operator.boundary();
    let spots = ContactSpots::new(&grid, touching, boundary.wraps());
    let found = |conductance, flux, shares| Conductance {
        grid,
        boundary,
        conductance,
        flux,
        shares,
        spots,
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
    let shares = shares(&flux, touching, joint.film.unwrap_or(0.0));
    Ok(Conductance { residual, imbalance, stats, ..found(Some(conductance), Some(flux), shares) })
}

/// Resistance R_full of a joint all of whose cells touch without a film, K/W or Ω: that of the spreading from
/// the grid into the half-spaces. R − R_full is what the roughness adds. `None` under a periodic boundary,
/// where there is no spreading.
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
    let (film, jump) = (joint.film.unwrap_or(0.0), joint.jump);
    let Some(conductivity) = joint.gas else {
        return Ok((touching.clone(), film.into()));
    };
    let Some(gap) = gap else {
        return Err(Error::Unsupported(
            "gas conducts across the gap between the bodies, and there is no gap",
        ));
    };
    assert_eq!(gap.dim(), touching.dim(), "shape of the gap");
    let open = || gap.iter().zip(touching).filter(|(_, touches)| !**touches).map(|(gap, _)| *gap);
    open().try_for_each(|gap| {
        check_in(Dimension::Length, "gap", gap, gap.is_finite(), "a finite gap in all open cells")
    })?;
    let resistance = Zip::from(touching)
        .and(gap)
        .map_collect(|touches, gap| if *touches { film } else { (gap.max(0.0) + jump) / conductivity });
    Ok((touching.mapv(|_| true), resistance.into()))
}

/// Shares of a flux.
fn shares(flux: &Field, touching: &Array2<bool>, film: f64) -> Shares {
    let [mut spots, mut gas, mut lost] = [0.0; 3];
    Zip::from(flux).and(touching).for_each(|q, touches| {
        if *touches {
            spots += q;
            lost += film * q * q;
        } else {
            gas += q;
        }
    });
    let total = spots + gas;
    // Rounding must not take them out of 0 … 1.
    let [spots, film] =
        [spots, lost].map(|sum| if total > 0.0 { (sum / total).clamp(0.0, 1.0) } else { 0.0 });
    Shares { spots, gas: if total > 0.0 { 1.0 - spots } else { 0.0 }, film }
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    use super::*;
    use crate::math::Cholesky;
    use crate::operator::{DirectSum, Edge, FreeFamily, FreeFft, PeriodicFft};
    use crate::with::conductance::Kind;

    const FINE: Params = Params::new().with_tolerance(1e-10).with_max_convolutions(3000);

    fn clean() -> Joint {
        Joint::new(Kind::Thermal)
    }

    /// ΔA 1ᵀ(C + D)⁻¹ 1 by a dense factorisation.
    fn dense(operator: &dyn Operator, conducting: &Array2<bool>, resistance: &CellValues) -> f64 {
        let cells: Vec<_> =
            conducting.indexed_iter().filter(|(_, conducts)| **conducts).map(|(at, _)| at).collect();
        let columns = operator.grid().shape[1];
        let matrix = Array2::from_shape_fn([cells.len(); 2], |(i, j)| {
            let ((a, b), (c, d)) = (cells[i], cells[j]);
            let own = if i == j { resistance.value(a * columns + b) } else { 0.0 };
            operator.influence(a.abs_diff(c), b.abs_diff(d)) + own
        });
        let flux = Cholesky::new(matrix).unwrap().solve(&vec![1.0; cells.len()]);
        operator.grid().cell_area() * flux.iter().sum::<f64>()
    }

    #[test]
    fn random_joints_conduct_as_by_a_dense_factorisation() {
        let mut random = ChaCha8Rng::seed_from_u64(11);
        let mut most = 0.0f64;
        for n in 0..300 {
            let shape = [random.random_range(1..20), random.random_range(1..20)];
            let grid = Grid::new(shape, [1.0, random.random_range(0.5..2.0)]).unwrap();
            let (share, patch) = (random.random_range(0.0..1.0), random.random_range(1..5));
            let patches = Array2::from_shape_fn([22, 22], |_| random.random_bool(share));
            let mut touching = Array2::from_shape_fn(shape, |(i, j)| patches[[i / patch, j / patch]]);
            touching[[0, 0]] = true;
            let mut logarithmic = |from: f64, to: f64| 10f64.powf(random.random_range(from..to));
            let (film, conductivity, jump) =
                (logarithmic(-3.0, 3.0), logarithmic(-4.0, 2.0), logarithmic(-3.0, 0.0));
            let gap = Field::from_shape_fn(shape, |_| random.random_range(-0.1..3.0));
            let joint = match n % 4 {
                0 => clean(),
                1 => clean().with_film(film),
                2 => clean().with_gas(conductivity, jump),
                _ => clean().with_film(film).with_gas(conductivity, jump),
            };
            let line = Boundary([Edge::Free, Edge::Periodic]);
            let mut operator: Box<dyn Operator> = match n % 3 {
                0 => Box::new(DirectSum::new(grid, 1.7)),
                1 => Box::new(FreeFamily::new(&grid, 1.7, line).operator(shape)),
                _ => Box::new(PeriodicFft::new(grid, 1.7)),
            };
            let (conducting, resistance) = cells(&touching, Some(&gap), &joint).unwrap();
            let all = operator.leaves_mean_free()
                && conducting.iter().all(|conducts| *conducts)
                && resistance.max() == 0.0;
            let found = solve(operator.as_mut(), &touching, Some(&gap), &joint, None, &FINE).unwrap();
            if all {
                assert_eq!((found.conductance, found.resistance()), (None, None));
                continue;
            }
            let exact = dense(operator.as_ref(), &conducting, &resistance);
            let error = found.conductance.unwrap() / exact - 1.0;
            assert!(error.abs() < 1e-9, "{n}: {shape:?} {joint:?} {error:e}");
            assert!(found.residual <= 1e-10 && found.imbalance <= 1e-9, "{n}: {found:?}");
            let flux = found.flux.as_ref().unwrap();
            let power = grid.cell_area() * flux.sum();
            assert_relative_eq!(power, exact, max_relative = 1e-9);
            let Shares { spots, gas, film } = found.shares;
            assert!((0.0..=1.0).contains(&film) && (spots + gas - 1.0).abs() < 1e-12, "{n}: {found:?}");
            // From any start it comes to the same.
            let start = Field::from_shape_fn(shape, |(i, j)| ((i + 2 * j) % 5) as f64);
            let again = solve(operator.as_mut(), &touching, Some(&gap), &joint, Some(&start), &FINE).unwrap();
            assert_relative_eq!(again.conductance.unwrap(), exact, max_relative = 1e-9);
            most = most.max(found.stats.iterations as f64);
        }
        assert!(most < 150.0, "{most}");
    }

    #[test]
    fn no_contact_conducts_nothing_and_full_periodic_contact_has_no_resistance() {
        for shape in [[1, 1], [1, 7], [6, 1], [5, 4]] {
            let grid = Grid::new(shape, [1.0, 0.5]).unwrap();
            let all = Array2::from_elem(shape, true);
            let none = !all.clone();
            let gap = grid.zeros() + 2.0;
            let operators: [Box<dyn Operator>; 2] =
                [Box::new(PeriodicFft::new(grid, 2.0)), Box::new(FreeFft::new(grid, 2.0))];
            for (mut operator, is_periodic) in operators.into_iter().zip([true, false]) {
                let mut solve = |touching, joint: Joint| {
                    solve(operator.as_mut(), touching, Some(&gap), &joint, None, &FINE).unwrap()
                };
                let open = solve(&none, clean());
                assert_eq!((open.conductance, open.resistance(), open.spots.count()), (Some(0.0), None, 0));
                assert_eq!((open.shares, open.holm_greenwood(1.0)), (Shares::default(), None));
                let closed = solve(&all, clean());
                assert_eq!(closed.conductance.is_none(), is_periodic, "{shape:?}");
                assert_eq!(closed.resistance().is_none(), is_periodic);
                assert_eq!((closed.shares.spots, closed.spots.count()), (1.0, 1));
                // Through an even film or gap on all cells h is one over its resistance, in a period alone.
                for (touching, joint) in
                    [(&all, clean().with_film(0.3)), (&none, clean().with_gas(10.0, 1.0))]
                {
                    let found = solve(touching, joint);
                    let h = found.conductance.unwrap() / grid.area();
                    if is_periodic {
                        assert_eq!(found.joint_conductance(None), Some(h));
                        assert_relative_eq!(h * 0.3, 1.0, max_relative = 1e-12);
                    } else {
                        assert!(0.0 < h && h < 1.0 / 0.3, "{shape:?} {h}");
                    }
                }
                let film = solve(&all, clean().with_film(0.3));
                assert!(film.shares.film <= 1.0 + 1e-12 && (film.shares.film > 0.999999) == is_periodic);
            }
        }
    }

    #[test]
    fn a_full_contact_spreads_from_the_grid_alone() {
        let grid = Grid::new([32, 32], [1.0 / 32.0; 2]).unwrap();
        let mut free = FreeFft::new(grid, 1.0);
        let full = full_resistance(&mut free, &FINE).unwrap().unwrap();
        let all = Array2::from_elem(grid.shape, true);
        let found = solve(&mut free, &all, None, &clean(), None, &FINE).unwrap();
        assert_relative_eq!(found.resistance().unwrap(), full, max_relative = 1e-12);
        assert_eq!(full_resistance(&mut PeriodicFft::new(grid, 1.0), &FINE).unwrap(), None);
    }

    #[test]
    fn what_has_no_meaning_is_refused_in_a_sentence() {
        let grid = Grid::new([4, 4], [1.0; 2]).unwrap();
        let touching = Array2::from_shape_fn(grid.shape, |(i, _)| i == 1);
        let gap = grid.zeros() + 1.0;
        let mut free = FreeFft::new(grid, 1.0);
        let with_gas = |joint: Joint| joint.with_gas(0.026, 0.1);
        let mut message = |gap: Option<&Field>, joint: Joint| {
            solve(&mut free, &touching, gap, &joint, None, &FINE).unwrap_err().to_string()
        };
        let mut unknown = gap.clone();
        unknown[[3, 3]] = f64::NAN;
        let electrical = Joint { kind: Kind::Electrical, ..clean() };
        for (found, expected) in [
            (message(None, clean().with_film(-1.0)), "film is -1"),
            (message(None, clean().with_film(f64::NAN)), "film is NaN"),
            (message(Some(&gap), clean().with_gas(0.0, 0.1)), "conductivity of the gas is 0"),
            (message(Some(&gap), clean().with_gas(0.026, -1.0)), "jump is -1"),
            (message(None, with_gas(clean())), "gas conducts across the gap"),
            (message(Some(&unknown), with_gas(clean())), "gap is NaN"),
            (message(Some(&gap), with_gas(electrical)), "gas conducts heat"),
        ] {
            let found = found.replace('−', "-");
            assert!(found.starts_with(expected), "{found}");
        }
        // The gap of cells in contact does not count.
        unknown[[3, 3]] = 1.0;
        unknown[[1, 2]] = f64::NAN;
        let joint = with_gas(clean());
        let found = solve(&mut free, &touching, Some(&unknown), &joint, None, &FINE).unwrap();
        assert!(found.conductance.unwrap().is_finite());
    }

    #[test]
    fn heat_is_in_proportion_to_the_drop_and_joule_heat_to_its_square() {
        let grid = Grid::new([8, 8], [1.0; 2]).unwrap();
        let all = Array2::from_elem(grid.shape, true);
        let found = solve(&mut FreeFft::new(grid, 1.0), &all, None, &clean(), None, &FINE).unwrap();
        let conductance = found.conductance.unwrap();
        assert_relative_eq!(found.power(&Joint { drop: 3.0, ..clean() }).unwrap(), 3.0 * conductance);
        let joint = Joint { kind: Kind::Electrical, drop: 3.0, ..clean() };
        assert_relative_eq!(found.power(&joint).unwrap(), 9.0 * conductance);
    }
}
