//! Two bodies in relative motion: positions, passes, the pair's geometry and its plastic change.

mod approach;
mod contact;
mod loading;
mod pair;
mod pass;
mod together;
mod path;
mod plastic;
mod record;
mod rim;
mod simulation;
mod spot;
mod sweep;
mod warm_start;
mod watch;

pub use contact::{Contact, press};
pub use loading::{
    Equilibrium, Flattening, LoadedContact, LoadingOutput, LoadingState, Origin, Stage, load_in_stages, roll,
};
pub use pair::Pair;
pub(crate) use pair::initial_gap;
pub use path::{Position, overlap_positions, shift_positions};
pub use record::{IncrementRecord, PassRecord, ShearRecord, StaticRecord, StepRecord, SweepRecord};
pub use rim::Interior;
pub use simulation::Simulation;
pub(crate) use spot::largest_spot;
pub use sweep::{Point, SweepOutput, sweep};
pub(crate) use together::memory_together;
pub use warm_start::{Bearing, Guess, WarmStart};
pub use watch::{Output, PassReport, Progress, Watch};

use crate::error::{Error, Result};
use crate::solver::{Friction, Sliding};
use crate::units::{Metre, MetrePerSecond, Newton, Pascal, SquareMetre};

/// What is prescribed in the normal direction during the motion.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Control {
    /// One approach for a whole pass, found so that the mean load over its positions is this.
    PassLoad(Newton),
    /// This load at every position.
    StepLoad(Newton),
    /// This approach at every position of every pass.
    Approach(Metre),
}

/// How the bodies pass over each other.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum Strategy {
    /// The upper body enters on the left, passes over, leaves on the right; only what faces is solved.
    Overlap,
    /// Both height matrices are shifted circularly and the full problem is solved at each step.
    Shift {
        /// Speed of the lower surface along x; only the ratio of the two matters.
        speed_lower: MetrePerSecond,
        /// Speed of the upper surface along x.
        speed_upper: MetrePerSecond,
    },
}

impl Control {
    /// The largest load that this control can ask for where columns of the area `column` face each other, so many at
    /// each position: the hardness on all of them, in the mean over a pass, or at the position with the fewest.
    pub fn plastic_limit(&self, columns: &[usize], column: SquareMetre, hardness: Pascal) -> Newton {
        let bearing = match self {
            Self::PassLoad(_) => columns.iter().sum::<usize>() as f64 / columns.len() as f64,
            Self::StepLoad(_) => columns.iter().copied().min().unwrap_or(0) as f64,
            Self::Approach(_) => columns.iter().copied().max().unwrap_or(0) as f64,
        };
        hardness * column * bearing
    }

    /// Holds a load against the [`Control::plastic_limit`].
    ///
    /// # Errors
    /// [`Error::BeyondPlasticLimit`].
    pub fn check_limit(&self, limit: Newton) -> Result<()> {
        match *self {
            Self::PassLoad(load) | Self::StepLoad(load) if load >= limit => {
                Err(Error::BeyondPlasticLimit { load, limit })
            }
            _ => Ok(()),
        }
    }
}

impl Strategy {
    /// Sign of the velocity of the upper body against the lower one: 0 where both roll alike.
    pub fn direction(&self) -> f64 {
        match *self {
            Self::Overlap => 1.0,
            Self::Shift { speed_lower, speed_upper } if speed_lower == speed_upper => 0.0,
            Self::Shift { speed_lower, speed_upper } => (speed_upper - speed_lower).signum(),
        }
    }

    /// The positions of a pass of two bodies of so many columns, every `stride`-th.
    pub fn positions(&self, lower: usize, upper: usize, stride: usize) -> Vec<Position> {
        match *self {
            Self::Overlap => overlap_positions(lower, upper, stride),
            Self::Shift { speed_lower, speed_upper } => {
                shift_positions(lower, stride, speed_lower, speed_upper)
            }
        }
    }
}

/// When plastic deformation changes the geometry.
#[derive(Debug, Clone, Copy, PartialEq, Eq, serde::Serialize, serde::Deserialize)]
#[serde(rename_all = "kebab-case")]
pub enum PlasticUpdate {
    /// After the pass: each cell is lowered by its share of the largest plastic interference it saw.
    Pass,
    /// At every position, in sequence.
    Step,
}

/// A motion: how often, how finely and under what the bodies pass over each other.
#[derive(Debug, Clone, Copy, PartialEq, serde::Serialize, serde::Deserialize)]
pub struct Motion {
    /// Overlap or circular shift.
    pub strategy: Strategy,
    /// Number of passes, ≥ 1.
    pub passes: usize,
    /// Cells per step, ≥ 1.
    pub stride: usize,
    /// Load or approach.
    pub control: Control,
    /// When plastic deformation is applied.
    pub plastic_update: PlasticUpdate,
    /// Relative tolerance on the pass-mean load, > 0.
    pub load_tolerance: f64,
    /// Friction of the sliding bodies, if they have any.
    pub friction: Option<Friction>,
}

impl Motion {
    /// How the bodies slide, if there is friction: the upper one towards where it goes.
    pub(crate) fn sliding(&self) -> Option<Sliding> {
        self.friction.map(|friction| Sliding { friction, direction: [self.strategy.direction(), 0.0] })
    }

    /// The most pressure that cells of the `hardness` bear in this motion.
    pub(crate) fn cap(&self, hardness: Pascal) -> Pascal {
        self.friction.map_or(hardness, |friction| friction.sliding_cap(hardness))
    }
}
