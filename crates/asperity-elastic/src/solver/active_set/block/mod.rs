//! One of the contacts that share an approach: a diagonal block of their influence matrix.

mod convolution;
mod search;
mod step;

pub(super) use step::ResidualNorms;

use ndarray::Array2;

use crate::grid::{Field, SingleField, flat, flat_mut};
use crate::math::{Bands, extremes, parallel};
use crate::ranks::{Halo, Merged, Slab};
use crate::solver::bounds::{Interval, with_bounds};
use crate::solver::feasible::{Range, map_within, sum_within};
use crate::solver::preconditioner::Preconditioner;
use crate::solver::sets::Sets;
use crate::solver::site::Site;
use crate::units::{Metre, Pascal};

/// Radius in cells of the influence that predicts a residual without a convolution.
const NEAR_FIELD: usize = 4;

/// One contact in the iteration: pressure, displacement, direction and residual of its cells.
///
/// Pressure and displacement are in double precision. Directions and their responses are in single precision,
/// which is sufficient for steps that are small compared with the values they correct. The error bound of the
/// displacement includes them.
pub(super) struct Block<'a> {
    site: &'a dyn Site,
    /// The bands of rows for parallel work.
    bands: Bands,
    preconditioner: Preconditioner,
    /// The current pressure p, possibly a little outside its bounds.
    pressure: Field,
    /// The approach h + u at which each cell touches.
    touch: Field,
    /// Error bound of the displacement due to single precision.
    rounding: Metre,
    /// The last feasible pressure. The energy of feasible pressures only decreases.
    feasible: Field,
    /// The approaches h + u under the last feasible pressure, during a line search from it, or always with a
    /// near copy.
    feasible_touch: Option<Field>,
    /// Whether search directions are convolved with the near copy of the operator.
    near: bool,
    /// Error bound due to single precision of the residual under the last feasible pressure, if the operator
    /// itself computed it.
    feasible_rounding: Option<Metre>,
    /// The predicted set of each cell.
    sets: Sets,
    /// The search direction d.
    direction: SingleField,
    /// Number of proposed pressures in each band that may exceed a uniform lower bound, up to an offset.
    candidates: Vec<usize>,
    /// The largest offset for which the candidates are complete.
    candidates_offset: Pascal,
    /// The response C·d of the direction. Before the direction is known it holds the residual r of the free
    /// cells, and then the preconditioned residual z = M r; during the prediction of sets the proposed
    /// pressures, and then the predicted residual.
    response: SingleField,
    /// Largest |C·d|.
    max_response: f64,
    /// Influence coefficients up to [`NEAR_FIELD`] cells away: 0, 1 … along x, … −1, 0, 1 … along y.
    near_field: SingleField,
    /// The neighbouring rows within this radius.
    halo: Halo,
    /// The slab of this rank, if the grid is divided among ranks.
    slab: Slab,
    /// Self-influence c₀ for a periodic boundary, else 0. A periodic displacement may be smaller than the
    /// rounding of its transforms.
    local: f64,
    /// Convolutions so far.
    convolutions: usize,
    /// Applications of the near copy so far.
    near_applications: usize,
}

impl<'a> Block<'a> {
    /// Creates the contact at a site under a pressure that has not been convolved yet. With `near` its search
    /// directions are convolved with the near copy of the operator.
    pub(super) fn new(site: &'a dyn Site, pressure: Field, near: bool) -> Self {
        let (shape, slab) = (site.grid().shape, site.slab());
        let reach = slab.whole_grid().shape.map(|n| NEAR_FIELD.min((n - 1) / 2));
        let mut made = None;
        site.with_operator(&mut |operator| {
            let near_field = SingleField::from_shape_fn([reach[0] + 1, 2 * reach[1] + 1], |(i, j)| {
                operator.influence(i, j.abs_diff(reach[1])) as f32
            });
            let local =
                if operator.boundary().leaves_mean_free() { operator.influence(0, 0).abs() } else { 0.0 };
            made = Some((Preconditioner::new(operator), near_field, local));
        });
        let (preconditioner, near_field, local) = made.expect("a site lends its operator");
        Self {
            site,
            bands: Bands::new(shape),
            preconditioner,
            pressure,
            touch: Field::zeros(shape),
            rounding: 0.0,
            feasible: Field::zeros(shape),
            feasible_touch: None,
            sets: Sets::new(shape),
            direction: SingleField::zeros(shape),
            candidates: vec![0; Bands::new(shape).rows().len()],
            candidates_offset: f64::NEG_INFINITY,
            response: SingleField::zeros(shape),
            max_response: 0.0,
            halo: slab.halo(reach[0]),
            slab,
            near_field,
            local,
            near,
            feasible_rounding: None,
            convolutions: 0,
            near_applications: 0,
        }
    }

    /// Whether every pressure is within its bounds.
    pub(super) fn is_within_bounds(&self) -> bool {
        let bounds = self.site.bounds();
        let bands = self.bands.cut(flat(&self.pressure)).enumerate();
        let within = parallel::map(bands, |(band, pressure)| {
            let first = self.bands.first(band);
            with_bounds!(bounds, of => {
                pressure.iter().enumerate().all(|(cell, p)| of(first + cell).clamp(*p) == *p)
            })
        });
        within.into_iter().all(|within| within)
    }

    /// Returns the sums over the cells of `terms` of each pressure and its bounds.
    pub(super) fn sum<const N: usize>(
        &self,
        terms: impl Fn(Pascal, Interval) -> [f64; N] + Sync + Send,
    ) -> [f64; N] {
        self.sum_within(&self.pressure, terms)
    }

    /// Returns the sums over the cells of `terms` of each value and the bounds of its cell.
    fn sum_within<T: Copy + Sync, const N: usize>(
        &self,
        values: &Array2<T>,
        terms: impl Fn(T, Interval) -> [f64; N] + Sync + Send,
    ) -> [f64; N] {
        let bounds = self.site.bounds();
        let parts = parallel::map(self.bands.cut(flat(values)).enumerate(), |(band, values)| {
            sum_within(values, self.bands.first(band), &bounds, &terms)
        });
        Merged::of_parts(parts)
    }

    /// Replaces each pressure by a function of it and its bounds.
    pub(super) fn map(&mut self, change: impl Fn(Pascal, Interval) -> Pascal + Sync + Send) {
        let (bands, bounds) = (self.bands, self.site.bounds());
        parallel::map(bands.cut_mut(flat_mut(&mut self.pressure)).enumerate(), |(band, pressures)| {
            map_within(pressures, bands.first(band), &bounds, &change);
        });
    }

    /// Returns the range of the pressures and of their bounds.
    pub(super) fn range(&self) -> Range {
        self.range_of(parallel::map(self.bands.cut(flat(&self.pressure)), extremes))
    }

    /// Returns the range of values whose extremes in each band are these, and of the bounds of the pressure.
    fn range_of(&self, parts: Vec<[Pascal; 2]>) -> Range {
        let [min, max] = parts.into_iter().reduce(|a, b| [a[0].min(b[0]), a[1].max(b[1])]).expect("a band");
        Range::new([min, max], self.pressure.len(), &self.site.bounds())
    }

    /// Returns pressure and displacement.
    pub(super) fn into_fields(self) -> (Field, Field) {
        let displacement = self.touch - &*self.site.initial_gap();
        (self.pressure, displacement)
    }

    /// Number of free cells.
    pub(super) fn free_cells(&self) -> usize {
        self.sets.free_cells()
    }

    /// Convolutions so far.
    pub(super) fn convolutions(&self) -> usize {
        self.convolutions
    }

    /// Applications of the near copy so far.
    pub(super) fn near_applications(&self) -> usize {
        self.near_applications
    }

    /// Error bound of the displacement due to single precision.
    pub(super) fn rounding(&self) -> Metre {
        self.rounding
    }
}

/// Changes each value of a field by the value of another field.
fn zip<A: Send, B: Sync>(
    bands: Bands,
    field: &mut Array2<A>,
    other: &Array2<B>,
    change: impl Fn(&mut A, &B) + Sync + Send,
) {
    parallel::map(bands.cut_mut(flat_mut(field)).zip(bands.cut(flat(other))), |(field, other)| {
        field.iter_mut().zip(other).for_each(|(value, other)| change(value, other));
    });
}
