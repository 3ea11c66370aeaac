//! Rules of the active set that solvers of contacts share, on the processor and on devices: when conjugate
//! gradients stop, caution after steps without progress, the sum of clipped pressures, the scale of a
//! residual.

/// Largest number of conjugate gradient steps on one predicted active set.
pub const MAX_CG_STEPS: usize = 60;
/// Conjugate gradients stop when the residual on the free cells is below this multiple of the violation of
/// the bounds, because the set is about to change.
const CG_EXIT: f64 = 3.0;
/// With each outer step without progress [`CG_EXIT`] is divided by this.
const CG_EXIT_DIVISOR: f64 = 3.0;
/// Smallest ratio of residual to violation at which conjugate gradients stop.
const MIN_CG_EXIT: f64 = 0.05;
/// With each outer step with progress this ratio is multiplied by this factor, up to [`CG_EXIT`].
const CG_EXIT_GROWTH: f64 = 1.5;
/// Conjugate gradients also stop when the largest residual is below this fraction of the target residual of
/// the solution.
pub const CG_TOLERANCE: f64 = 0.9;

/// An outer step makes progress if its norm is below this fraction of the best norm so far.
const PROGRESS: f64 = 0.7;
/// Number of consecutive outer steps without progress before a line search lowers the energy.
const MAX_STAGNATIONS: usize = 2;
/// With each outer step without progress the compliance in the prediction of the sets is multiplied by this
/// factor.
const COMPLIANCE_GROWTH: f64 = 4.0;
/// With each outer step with progress this compliance is multiplied by this factor, down to the
/// self-influence.
const COMPLIANCE_REDUCTION: f64 = 0.5;
/// A line search with a smaller step fraction makes no progress.
pub const MIN_SEARCH_STEP: f64 = 1e-3;
/// After a line search the best norm is multiplied by this factor, so that the next outer step may increase
/// it a little.
const BEST_AFTER_SEARCH: f64 = 2.0;

/// If a feasible solution misses the tolerance, it is solved again to this fraction of the previous target
/// residual.
pub const TOLERANCE_REDUCTION: f64 = 0.3;
/// Fraction of the interference of a cell that its first pressure closes under approach control, as if the
/// cell were alone.
pub const FIRST_PRESSURE: f64 = 0.3;
/// Number of scalings of the pressures to a sum; afterwards they are offset.
pub const MAX_SCALINGS: usize = 60;
/// Largest number of Newton steps and bisections for the offset.
const MAX_OFFSETS: usize = 200;

/// Tolerance of the coarse grids of a cascade, relative to std(u). The displacement of a cell by its own
/// pressure at the largest upper bound replaces std(u) if it is smaller: φ never exceeds it.
const COARSE_TOLERANCE: f64 = 1e-2;
/// Compliance for the first prediction of the sets from a given start, as a multiple of the self-influence. A
/// guess from coarse grids has smooth errors. The solution at another approach or of another geometry has
/// errors at single cells, and so have the sets predicted from it.
pub const COMPLIANCE_FACTOR: f64 = 2.0;

/// Displacements with a deviation below this fraction of their size count as uniform, as under flat bodies
/// and in full contact. Their deviation may be round-off, 10⁻¹⁵ of their size in double precision and 10⁻⁷ in
/// single.
const UNIFORM: f64 = 1e-4;

/// Caution against cycles of the predicted sets.
#[derive(Debug, Clone, Copy)]
pub struct Caution {
    /// Ratio of the residual to the violation of the bounds at which conjugate gradients stop.
    pub cg_exit: f64,
    /// The compliance in the prediction of the sets, as a multiple of the self-influence, ≥ 1.
    pub compliance_factor: f64,
    /// Smallest norm after an outer step.
    best: f64,
    /// Number of consecutive outer steps without progress.
    stagnations: usize,
}

impl Caution {
    /// Begins with a compliance in the prediction of the sets.
    pub fn new(compliance_factor: f64) -> Self {
        Self { cg_exit: CG_EXIT, compliance_factor, best: f64::INFINITY, stagnations: 0 }
    }

    /// Judges an outer step by its norm. Returns whether a line search must lower the energy, after some
    /// steps without progress.
    pub fn demands_a_search(&mut self, norm: f64) -> bool {
        if norm < PROGRESS * self.best {
            self.best = norm;
            self.stagnations = 0;
            self.cg_exit = CG_EXIT.min(CG_EXIT_GROWTH * self.cg_exit);
            self.compliance_factor = (COMPLIANCE_REDUCTION * self.compliance_factor).max(1.0);
            return false;
        }
        self.stagnations += 1;
        self.cg_exit = (self.cg_exit / CG_EXIT_DIVISOR).max(MIN_CG_EXIT);
        self.compliance_factor *= COMPLIANCE_GROWTH;
        self.stagnations >= MAX_STAGNATIONS
    }

    /// Continues after a line search.
    pub fn after_search(&mut self) {
        self.best *= BEST_AFTER_SEARCH;
    }

    /// Forgets the norms, which belong to another displacement.
    pub fn forget_norms(&mut self) {
        (self.best, self.stagnations) = (f64::INFINITY, 0);
    }
}

/// Returns the tolerance of a coarse grid of a cascade, whose contact is solved to the `tolerance` in the
/// end. `saturation` is the displacement of a cell by its own pressure at the largest upper bound, `scale`
/// that of the residual.
pub fn coarse_tolerance(tolerance: f64, saturation: f64, scale: f64) -> f64 {
    tolerance.max(COARSE_TOLERANCE * (saturation / scale).min(1.0))
}

/// Returns the scale of a residual: the `deviation` of the displacements, unless they are uniform compared
/// with their `size`. The size is the largest displacement, or the largest displacement of a cell by itself.
pub fn residual_scale(deviation: f64, size: f64) -> f64 {
    if deviation < UNIFORM * size { UNIFORM * size } else { deviation }
}

/// Computes the offset c with Σ clip(y + c) = `wanted`, for a sum within the bounds and values y whose offset
/// lies in the `bracket`. This is the Euclidean projection onto the bounds and the sum, which is met to the
/// `accuracy`. `sums` returns the sum and the number of the values that lie strictly between their bounds.
///
/// The sum is piecewise linear in c, so a bracketed Newton iteration is exact to round-off in a few passes.
///
/// # Errors
/// The errors of `sums`.
pub fn offset_for_sum<E>(
    [mut low, mut high]: [f64; 2],
    wanted: f64,
    accuracy: f64,
    mut sums: impl FnMut(f64) -> Result<[f64; 2], E>,
) -> Result<f64, E> {
    let mut offset = high.min(0.0).max(low);
    for _ in 0..MAX_OFFSETS {
        let [sum, between] = sums(offset)?;
        let excess = sum - wanted;
        if excess.abs() <= accuracy {
            break;
        }
        if excess < 0.0 {
            low = offset;
        } else {
            high = offset;
        }
        let newton = offset - excess / between;
        let next = if low < newton && newton < high { newton } else { 0.5 * (low + high) };
        if next <= low || next >= high {
            break;
        }
        offset = next;
    }
    Ok(offset)
}
