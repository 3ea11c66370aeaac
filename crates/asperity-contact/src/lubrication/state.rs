//! The state of a film on the way to its solution, and on which side of its complementarities each cell is.

/// Pressures of the oil and of the solids, cavity fractions, and the approach.
#[derive(Clone)]
pub(super) struct State {
    pub(super) oil: Vec<f64>,
    pub(super) solids: Vec<f64>,
    pub(super) cavity: Vec<f64>,
    pub(super) approach: f64,
}

impl State {
    /// Returns the state after a share of a step.
    pub(super) fn plus(&self, share: f64, step: &Self) -> Self {
        let sum = |a: &[f64], b: &[f64]| a.iter().zip(b).map(|(a, b)| a + share * b).collect();
        Self {
            oil: sum(&self.oil, &step.oil),
            solids: sum(&self.solids, &step.solids),
            cavity: sum(&self.cavity, &step.cavity),
            approach: self.approach + share * step.approach,
        }
    }

    /// Brings pressures and cavity fractions into their range. p + c stays unless it is negative itself, which
    /// the second result says.
    pub(super) fn within_range(mut self) -> (Self, bool) {
        let mut pulls = false;
        for (p, c) in self.oil.iter_mut().zip(&mut self.solids) {
            pulls |= *p + *c < 0.0;
            let total = (*p + *c).max(0.0);
            let solids = match (*p < 0.0, *c > 0.0) {
                (true, true) => total,
                (true, false) => 0.0,
                _ => c.clamp(0.0, total),
            };
            (*p, *c) = (total - solids, solids);
        }
        self.cavity.iter_mut().for_each(|share| *share = share.clamp(0.0, 1.0));
        (self, pulls)
    }
}

/// Factors that make residuals and unknowns dimensionless.
pub(super) struct Scales {
    /// Unit of pressure, Pa.
    pub(super) pressure: f64,
    /// Unit of film, m.
    pub(super) length: f64,
    /// Reciprocal of the unit of flow, s/m³.
    pub(super) flow: f64,
    /// Reciprocal of the unit of film.
    pub(super) film: f64,
}

impl Scales {
    pub(super) fn new(pressure: f64, length: f64, flow: f64) -> Self {
        Self { pressure, length, flow: flow.recip(), film: length.recip() }
    }
}

/// On which side of its complementarity each cell is.
#[derive(Clone)]
pub(super) struct Sides {
    /// Whether the film is partly empty, so that the oil has no pressure.
    pub(super) empty: Vec<bool>,
    /// Whether solids touch.
    pub(super) touch: Vec<bool>,
    /// The cells that touch.
    pub(super) contacts: Vec<usize>,
    rows: Vec<u32>,
}

impl Sides {
    pub(super) fn new(state: &State, h: &[f64], boundary_film: f64, scales: &Scales) -> Self {
        let is_empty = |(p, cavity): (&f64, &f64)| p / scales.pressure < *cavity;
        let touches = |(c, h): (&f64, &f64)| c / scales.pressure > (h - boundary_film) * scales.film;
        let empty = state.oil.iter().zip(&state.cavity).map(is_empty).collect();
        let touch: Vec<bool> = state.solids.iter().zip(h).map(touches).collect();
        let contacts: Vec<usize> = (0..touch.len()).filter(|k| touch[*k]).collect();
        let mut rows = vec![u32::MAX; touch.len()];
        for (n, k) in contacts.iter().enumerate() {
            rows[*k] = (touch.len() + n) as u32;
        }
        Self { empty, touch, contacts, rows }
    }

    /// Returns the row of the system that belongs to the solids of a cell.
    pub(super) fn contact_row(&self, cell: usize) -> Option<usize> {
        self.touch[cell].then(|| self.rows[cell] as usize)
    }
}
