//! Growth and removal of a mechano-chemical film at constant rates.

use crate::units::Metre;

/// (1 − e⁻ᵃ)/a.
pub(super) fn mean_decay(a: f64) -> f64 {
    if a > 1e-8 { -(-a).exp_m1() / a } else { 1.0 - 0.5 * a }
}

/// Growth g and removal l of a mechano-chemical film in a cell at constant exponents G and R per pass, as
/// functions of the passes t since the beginning.
///
/// g = f_max + (g₀ − f_max) e^(−Gt),  l = C₃ + (l₀ − C₃) e^(−Rt),  f = g − l
///
/// Where f would fall below 0 the cell is bare, l = g, while R (C₃ − g) ≥ G (f_max − g). It grows again from
/// g* = (R C₃ − G f_max)/(R − G) on.
pub(super) struct Balance {
    /// The largest thickness f_max, and the final removal C₃.
    ends: [Metre; 2],
    /// Exponents G and R.
    rates: [f64; 2],
    /// Initial growth and removal.
    begin: [Metre; 2],
    /// The passes at which the film is used up and at which it grows again; `None` if it is never used up.
    bare: Option<[f64; 2]>,
}

impl Balance {
    /// Creates the balance of a cell of this thickness and growth.
    pub(super) fn new(ends: [Metre; 2], rates: [f64; 2], [thickness, grown]: [Metre; 2]) -> Self {
        let begin = [grown, grown - thickness];
        let mut balance = Self { ends, rates, begin, bare: None };
        balance.bare = balance.bare();
        balance
    }

    /// Growth after `passes` passes.
    pub(super) fn grown(&self, passes: f64) -> Metre {
        self.ends[0] + (self.begin[0] - self.ends[0]) * (-self.rates[0] * passes).exp()
    }

    /// Removal of a film that is not used up.
    fn removed(&self, passes: f64) -> Metre {
        self.ends[1] + (self.begin[1] - self.ends[1]) * (-self.rates[1] * passes).exp()
    }

    /// Thickness after `passes` passes.
    pub(super) fn thickness(&self, passes: f64) -> Metre {
        match self.bare {
            Some([begin, end]) if passes >= begin => {
                if passes <= end {
                    0.0
                } else {
                    self.regrown(end).thickness(passes - end)
                }
            }
            _ => at_least_0(self.grown(passes) - self.removed(passes)),
        }
    }

    /// Mean thickness over `passes` passes; the initial thickness for 0 passes.
    pub(super) fn mean_thickness(&self, passes: f64) -> Metre {
        match self.bare {
            Some([begin, end]) if passes > begin => {
                let before = begin * self.mean_unbounded(begin);
                let after = if passes > end {
                    (passes - end) * self.regrown(end).mean_thickness(passes - end)
                } else {
                    0.0
                };
                at_least_0((before + after) / passes)
            }
            _ => at_least_0(self.mean_unbounded(passes)),
        }
    }

    /// Mean of g − l.
    fn mean_unbounded(&self, passes: f64) -> Metre {
        let mean = |which: usize| {
            let end = self.ends[which];
            end + (self.begin[which] - end) * mean_decay(self.rates[which] * passes)
        };
        mean(0) - mean(1)
    }

    /// Returns the balance of a cell that regrows after it has been bare until `end`.
    fn regrown(&self, end: f64) -> Self {
        let grown = self.grown(end);
        Self { begin: [grown; 2], bare: None, ..*self }
    }

    /// Returns the passes between which the cell is bare, for a film that is used up, whose removal is faster
    /// than its growth.
    fn bare(&self) -> Option<[f64; 2]> {
        let ([most, removed], [growth, removal]) = (self.ends, self.rates);
        let (to_grow, to_remove) = (most - self.begin[0], removed - self.begin[1]);
        if removal <= growth || removal * to_remove <= growth * to_grow {
            return None;
        }
        let difference = |passes: f64| self.grown(passes) - self.removed(passes);
        // The film is thinnest when growth and removal are equally fast.
        let thinnest = ((removal * to_remove) / (growth * to_grow)).ln() / (removal - growth);
        let thinnest = if thinnest.is_finite() { thinnest } else { f64::MAX.sqrt() / removal };
        if difference(thinnest) >= 0.0 {
            return None;
        }
        let begin = first_zero(difference, thinnest);
        // f_max − g decreases to f_max − g*.
        let again = removal * (most - removed) / (removal - growth);
        let end = (to_grow / again).ln() / growth;
        Some([begin, if end.is_finite() { end.max(begin) } else { f64::INFINITY }])
    }
}

/// Returns the value, or 0 if it is below 0. NaN stays NaN.
pub(super) fn at_least_0(value: f64) -> f64 {
    if value < 0.0 { 0.0 } else { value }
}

/// Finds the zero of a function that falls from a value of at least 0 at 0 to a value below 0 at `end`.
fn first_zero(value: impl Fn(f64) -> f64, end: f64) -> f64 {
    if value(0.0) <= 0.0 {
        return 0.0;
    }
    let (mut above, mut below) = (0.0, end);
    loop {
        let middle = 0.5 * (above + below);
        if middle <= above || middle >= below {
            return below;
        }
        if value(middle) > 0.0 { above = middle } else { below = middle }
    }
}
