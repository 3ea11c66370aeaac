//! The equilibrium towards which the rounds of lagged bounds converge.

use std::mem;

use crate::grid::Field;
use crate::units::Metre;

/// Largest part of the way to the equilibrium that is not along the last change of the lagged bounds. The
/// rounds converge to the stable equilibrium that the bodies reach, and one elsewhere is another one.
const MAX_DEVIATION: f64 = 0.3;
/// Largest length of this way, as a multiple of the sum of the changes that the rounds would still cause.
const MAX_LENGTH: f64 = 3.0;

/// Changes of the gap from round to round.
pub(super) struct Changes {
    gap: Option<Field>,
    /// Largest change of the last round.
    change: Metre,
    /// Estimate of the change left after the last round.
    left: Metre,
}

/// Forecast of the gap towards which the rounds converge: the changes left are in proportion to the last one.
pub(super) struct Forecast {
    /// The gap after the last round.
    gap: Field,
    /// Its change in the last round.
    change: Field,
    /// Sum of the changes left over the last change, if they decrease in a geometric series.
    share: f64,
}

impl Forecast {
    /// Whether the rounds converge towards an equilibrium with this gap, as far as the last change shows.
    pub(super) fn leads_to(&self, gap: &Field) -> bool {
        let [deviation, times] = self.way_to(gap);
        deviation < MAX_DEVIATION && times > 0.0 && times <= MAX_LENGTH * self.share
    }

    /// Whether a gap is farther away than the rounds still go.
    pub(super) fn is_beyond(&self, gap: &Field) -> bool {
        let [_, times] = self.way_to(gap);
        times.abs() > MAX_LENGTH * self.share
    }

    /// Returns the part of the distance to another gap that is not along the last change, as a fraction of
    /// that distance, and how many times the last change it is away.
    fn way_to(&self, gap: &Field) -> [f64; 2] {
        let way = gap - &self.gap;
        let [length, along] = [(&way * &way).sum(), (&way * &self.change).sum()];
        let times = along / (&self.change * &self.change).sum();
        let across = (length - along * times).max(0.0);
        [(across / length).sqrt(), times]
    }
}

impl Changes {
    pub(super) fn new() -> Self {
        Self { gap: None, change: 0.0, left: 0.0 }
    }

    /// Takes the gap after a round. Returns a forecast if the distance left has decreased. Near an
    /// equilibrium that has just vanished the changes decrease, too, but ever more slowly, so that the
    /// distance grows from round to round.
    pub(super) fn after(&mut self, gap: &Field) -> Option<Forecast> {
        let before = self.gap.replace(gap.clone())?;
        let change = largest_difference(&before, gap);
        let ratio = change / mem::replace(&mut self.change, change);
        let share = if ratio < 1.0 { ratio / (1.0 - ratio) } else { f64::INFINITY };
        let left_before = mem::replace(&mut self.left, change * share);
        let nearer = self.left < left_before && left_before.is_finite();
        nearer.then(|| Forecast { gap: gap.clone(), change: gap - &before, share })
    }
}

/// Returns the largest difference between two gaps.
pub(super) fn largest_difference(one: &Field, other: &Field) -> Metre {
    one.iter().zip(other).fold(0.0, |most, (one, other)| f64::max(most, (one - other).abs()))
}
