//! Two bodies in relative motion: positions, passes, the pair's geometry and its plastic change.

mod approach;
mod body;
mod contact;
mod course;
mod film;
mod flowed;
mod flowing;
mod heat;
mod implicit;
mod jump;
mod law;
mod loading;
mod pair;
mod pass;
mod path;
mod plastic;
mod record;
mod regime;
mod report;
mod rim;
mod simulation;
mod sliding;
mod spot;
mod state;
mod sweep;
mod together;
mod volumes;
mod warm_start;
mod watch;
mod wear;

pub use body::{Body, State};
pub use contact::{Contact, StaticContact, press, press_slab};
pub use course::{Output, Step};
#[cfg(feature = "study")]
pub(crate) use film::{
    ACTIVATION_ENERGIES, ACTIVATION_VOLUMES, GROWTH_FACTORS, GROWTH_TEMPERATURES, REMOVAL_RATES,
};
pub use film::{FILM, Film, FilmLaw, FilmStress, Films};
pub use flowed::FlowedVolume;
pub use flowing::{FlowPath, Flowed, FlowedContact, press_flowing};
pub use heat::FLASH;
pub use jump::{Acceleration, Jump};
pub use law::{Law, Sums, Touching};
pub use loading::{Stage, load_in_stages, roll};
pub use pair::Pair;
#[cfg(feature = "study")]
pub(crate) use pair::{facing_values, initial_gap};
use path::shift_positions_after;
pub use path::{OffsetY, Path, Position, Way, overlap_positions, shift_positions};
pub use plastic::PlasticFlow;
pub(crate) use record::columns::{Part, columns};
#[cfg(feature = "study")]
pub(crate) use record::lost_volumes::{ENDINGS, is_volume_of_law};
pub use record::{
    Column, FlowRecord, FlowStepRecord, HeatRecord, IncrementRecord, LostVolume, PassFlowRecord, PassRecord,
    Presence, Regime, ResidualRecord, RunningRecord, ShearRecord, StaticRecord, StepRecord, SweepRecord,
    UpdateRecord,
};
pub use report::PassReport;
pub use rim::Interior;
pub use simulation::{Simulation, SolvedPass};
pub use sliding::{InPlace, Slide, WornContact};
#[cfg(feature = "study")]
pub(crate) use spot::largest_spot;
pub use state::{Flattening, LoadedContact, LoadingState, Origin, SlidingState};
pub use sweep::{Point, sweep};
#[cfg(feature = "study")]
pub(crate) use together::memory_together;
pub use warm_start::{Bearing, Guess, WarmStart};
pub use watch::{Progress, Watch};
pub use wear::{WEAR, Wear, WearCoefficient, WearDriver};

use crate::choice::choice;
use crate::error::{Error, Result};
use crate::solver::{Control, Friction, Sliding};
use crate::units::{Kelvin, Metre, MetrePerSecond, Newton, Second};

/// Where a load that is prescribed holds in a motion; an approach holds at every position of every pass.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum LoadControl {
    /// In the mean over a pass, at the one approach of all its positions that makes it so.
    Pass,
    /// At every position.
    Step,
}

/// The strategy by which the bodies pass over each other.
#[derive(Debug, Clone, Copy, PartialEq)]
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

impl LoadControl {
    /// The largest load that can be asked for where the cells at each position bear so much together: in the mean over a
    /// pass, or at the position that bears the least.
    pub fn plastic_limit(self, bearable: &[Newton]) -> Newton {
        match self {
            Self::Pass => bearable.iter().sum::<f64>() / bearable.len() as f64,
            Self::Step => bearable.iter().copied().fold(f64::INFINITY, f64::min),
        }
    }
}

/// An error where a load is prescribed that is not below the [`LoadControl::plastic_limit`].
pub(crate) fn check_limit(control: Control, limit: Newton) -> Result<()> {
    match control {
        Control::Load(load) if load >= limit => Err(Error::BeyondPlasticLimit { load, limit }),
        _ => Ok(()),
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
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum PlasticUpdate {
    /// After the pass: each cell is lowered by its share of the largest plastic interference it saw.
    Pass,
    /// At every position, each on the surfaces that the one before has left.
    Step,
}

choice!(PlasticUpdate: "pass" => Pass, "step" => Step);

/// A motion: how often, how finely and under what the bodies pass over each other.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Motion {
    /// How the bodies pass over each other: overlap or circular shift.
    pub strategy: Strategy,
    /// Number of passes, ≥ 1.
    pub passes: usize,
    /// Cells per step, ≥ 1.
    pub stride: usize,
    /// Control of the normal direction: load or approach.
    pub control: Control,
    /// Where a load holds.
    pub load_control: LoadControl,
    /// When plastic deformation is applied.
    pub plastic_update: PlasticUpdate,
    /// Relative tolerance on the pass-mean load, > 0.
    pub load_tolerance: f64,
    /// Friction of the sliding bodies, if they have any.
    pub friction: Option<Friction>,
    /// Speed of the upper body over the lower one in an overlap, > 0, where it is known; a shift has its own speeds.
    pub speed: Option<MetrePerSecond>,
    /// Temperatures of the lower and of the upper body, > 0, where they are known.
    pub bulk: Option<[Kelvin; 2]>,
    /// Whether a pass goes one way, or there and back.
    pub path: Path,
    /// Where along y the passes lie; other than at 0 where the boundary is periodic along y.
    pub offset_y: OffsetY,
}

impl Motion {
    /// One pass in steps of a cell, in which a load holds in the mean over the pass to 10⁻⁴ and plastic deformation is applied
    /// after it; without friction.
    pub const fn new(strategy: Strategy, control: Control) -> Self {
        Self {
            strategy,
            passes: 1,
            stride: 1,
            control,
            load_control: LoadControl::Pass,
            plastic_update: PlasticUpdate::Pass,
            load_tolerance: 1e-4,
            friction: None,
            speed: None,
            bulk: None,
            path: Path::OneWay,
            offset_y: OffsetY::NONE,
        }
    }

    /// The same by another strategy.
    #[must_use]
    pub const fn with_strategy(self, strategy: Strategy) -> Self {
        Self { strategy, ..self }
    }

    /// The same over so many passes, ≥ 1.
    #[must_use]
    pub const fn with_passes(self, passes: usize) -> Self {
        Self { passes, ..self }
    }

    /// The same in steps of so many cells, ≥ 1.
    #[must_use]
    pub const fn with_stride(self, stride: usize) -> Self {
        Self { stride, ..self }
    }

    /// The same under another load or approach.
    #[must_use]
    pub const fn with_control(self, control: Control) -> Self {
        Self { control, ..self }
    }

    /// The same with a load that holds there.
    #[must_use]
    pub const fn with_load_control(self, load_control: LoadControl) -> Self {
        Self { load_control, ..self }
    }

    /// The same with plastic deformation applied then.
    #[must_use]
    pub const fn with_plastic_update(self, plastic_update: PlasticUpdate) -> Self {
        Self { plastic_update, ..self }
    }

    /// The same to another relative tolerance on the pass-mean load, > 0.
    #[must_use]
    pub const fn with_load_tolerance(self, load_tolerance: f64) -> Self {
        Self { load_tolerance, ..self }
    }

    /// The same with friction, or without.
    #[must_use]
    pub fn with_friction(self, friction: impl Into<Option<Friction>>) -> Self {
        Self { friction: friction.into(), ..self }
    }

    /// The same at a speed of the upper body in an overlap, > 0.
    #[must_use]
    pub fn with_speed(self, speed: impl Into<Option<MetrePerSecond>>) -> Self {
        Self { speed: speed.into(), ..self }
    }

    /// The same with bodies of these temperatures, > 0.
    #[must_use]
    pub fn with_bulk(self, bulk: impl Into<Option<[Kelvin; 2]>>) -> Self {
        Self { bulk: bulk.into(), ..self }
    }

    /// The same with passes that go one way, or there and back.
    #[must_use]
    pub const fn with_path(self, path: Path) -> Self {
        Self { path, ..self }
    }

    /// The same with passes that lie elsewhere along y.
    #[must_use]
    pub const fn with_offset_y(self, offset_y: OffsetY) -> Self {
        Self { offset_y, ..self }
    }

    /// The positions of a `pass`, from 1, of a lower and an upper body of so many `columns`, `width` cells across.
    ///
    /// Passes in one direction by a shift go on from one another: the slower surface is where the pass before has left it.
    pub fn positions(&self, columns: [usize; 2], width: usize, pass: usize) -> Vec<Position> {
        let forth = match (self.strategy, self.path) {
            (Strategy::Shift { speed_lower, speed_upper }, Path::OneWay) => {
                shift_positions_after(pass - 1, columns[0], self.stride, [speed_lower, speed_upper])
            }
            (strategy, _) => strategy.positions(columns[0], columns[1], self.stride),
        };
        let across = self.offset_y.of_pass(pass, width);
        let mut positions: Vec<_> =
            forth.into_iter().map(|position| Position { across, ..position }).collect();
        if self.path == Path::Reciprocating {
            let back: Vec<_> = positions.iter().rev().map(|position| position.back()).collect();
            positions.extend(back);
        }
        positions
    }

    /// Whether all passes have the same positions: they all lie at one place along y, and the surfaces of a shift are back where they
    /// began, because they move by whole rounds, or there and back.
    pub fn repeats(&self) -> bool {
        let returns = match (self.strategy, self.path) {
            (Strategy::Overlap, _) | (_, Path::Reciprocating) => true,
            (Strategy::Shift { speed_lower, speed_upper }, Path::OneWay) => {
                let slowest = speed_lower.abs().min(speed_upper.abs());
                slowest == 0.0 || slowest == speed_lower.abs().max(speed_upper.abs())
            }
        };
        returns && self.offset_y == OffsetY::NONE
    }

    /// How many of so many positions of a pass, the first ones, are contacts of their own: the way back of bodies that stay as they
    /// are meets the contacts of the way forth again, unless friction displaces their surfaces normally.
    pub(crate) fn distinct(&self, positions: usize, yields: bool, couples: bool) -> usize {
        let stays = self.plastic_update == PlasticUpdate::Pass || !yields;
        let pushed =
            self.sliding(Way::Forth).is_some_and(|sliding| sliding.shear_displaces_normally(couples));
        if self.path == Path::Reciprocating && stays && !pushed { positions / 2 } else { positions }
    }

    /// Time from one position to the next of bodies of that pitch along x; NaN where the speed is not known.
    pub fn step_time(&self, pitch: Metre) -> Second {
        let step = self.stride as f64 * pitch;
        match self.strategy {
            Strategy::Overlap => self.speed.map_or(f64::NAN, |speed| step / speed),
            Strategy::Shift { speed_lower, speed_upper } => step / speed_lower.abs().max(speed_upper.abs()),
        }
    }

    /// What laws see of a position of bodies of that pitch along x besides the contact.
    fn passage(&self, pitch: Metre) -> law::Passage {
        law::Passage {
            sliding: self.sliding(Way::Forth),
            distance: self.sliding_distance(pitch),
            time: self.step_time(pitch),
            bulk: self.bulk.unwrap_or([f64::NAN; 2]),
        }
    }

    /// How the bodies slide on one of the ways, if there is friction: the upper one towards where it goes.
    pub fn sliding(&self, way: Way) -> Option<Sliding> {
        let direction = [way.sign() * self.strategy.direction(), 0.0];
        self.friction.map(|friction| Sliding { friction, direction })
    }

    /// Distance over which bodies of that pitch slide over each other from one position to the next.
    pub fn sliding_distance(&self, pitch: Metre) -> Metre {
        let step = self.stride as f64 * pitch;
        match self.strategy {
            Strategy::Overlap => step,
            Strategy::Shift { speed_lower, speed_upper } => {
                step * (speed_upper - speed_lower).abs() / speed_lower.abs().max(speed_upper.abs())
            }
        }
    }
}
