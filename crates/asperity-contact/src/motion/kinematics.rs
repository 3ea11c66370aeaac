//! The passes of two bodies over each other: their positions, and the times and distances between these.

use asperity_base::choice::choice;

use super::control::LoadControl;
use super::pair::Pair;
use super::path::{
    OffsetY, Path, Position, Stroke, overlap_positions, shift_positions, shift_positions_after,
};
use super::slip::SlipRegime;
use crate::solver::{Bounds, Control, Friction, Sliding};
use crate::units::{Metre, MetrePerSecond, Second};

/// How the bodies pass over each other.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Strategy {
    /// The upper body enters on the left, passes over and leaves on the right. Only the overlap is solved.
    Overlap,
    /// Both surfaces are shifted circularly, and the full problem is solved at each step.
    Shift {
        /// Speed of the lower surface along x. Only the ratio of the two speeds matters.
        speed_lower: MetrePerSecond,
        /// Speed of the upper surface along x.
        speed_upper: MetrePerSecond,
    },
}

impl Strategy {
    /// Sign of the velocity of the upper body relative to the lower one; 0 if both roll alike.
    pub fn direction(&self) -> f64 {
        match *self {
            Self::Overlap => 1.0,
            Self::Shift { speed_lower, speed_upper } if speed_lower == speed_upper => 0.0,
            Self::Shift { speed_lower, speed_upper } => (speed_upper - speed_lower).signum(),
        }
    }

    /// Returns every `stride`-th position of a pass of two bodies with `lower` and `upper` columns.
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
    /// After the pass: each cell is lowered by its share of the largest plastic interference during the pass.
    Pass,
    /// At every position: each position is solved on the surfaces left by the one before.
    Step,
}

choice!(PlasticUpdate: "pass" => Pass, "step" => Step);

/// Parameters of a motion: number of passes, steps, control, friction.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Motion {
    /// Overlap or circular shift.
    pub strategy: Strategy,
    /// Number of passes, ≥ 1.
    pub passes: usize,
    /// Cells per step, ≥ 1.
    pub stride: usize,
    /// Control of the normal direction: load or approach.
    pub control: Control,
    /// Where a prescribed load holds.
    pub load_control: LoadControl,
    /// When plastic deformation is applied.
    pub plastic_update: PlasticUpdate,
    /// Relative tolerance on the pass-mean load, > 0.
    pub load_tolerance: f64,
    /// Friction of the sliding bodies, if any.
    pub friction: Option<Friction>,
    /// Speed of the upper body over the lower one in an overlap, > 0, if known. A shift has its own speeds.
    pub speed: Option<MetrePerSecond>,
    /// Whether a pass is one forward stroke, or a forward and a return stroke.
    pub path: Path,
    /// Offset of the passes along y. An offset other than 0 needs a boundary periodic along y.
    pub offset_y: OffsetY,
    /// Time, ≥ 0, for which viscoelastic bodies are apart between two passes. Without it the next pass of a
    /// shift begins from the last contact; the bodies of an overlap then come apart for no time.
    pub pause: Second,
}

impl Motion {
    /// Creates a motion of one pass in steps of one cell, without friction. A load holds as the mean over the
    /// pass to 10⁻⁴, and plastic deformation is applied after the pass.
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
            path: Path::OneWay,
            offset_y: OffsetY::NONE,
            pause: 0.0,
        }
    }

    /// Sets the strategy.
    #[must_use]
    pub const fn with_strategy(self, strategy: Strategy) -> Self {
        Self { strategy, ..self }
    }

    /// Sets the number of passes, ≥ 1.
    #[must_use]
    pub const fn with_passes(self, passes: usize) -> Self {
        Self { passes, ..self }
    }

    /// Sets the number of cells per step, ≥ 1.
    #[must_use]
    pub const fn with_stride(self, stride: usize) -> Self {
        Self { stride, ..self }
    }

    /// Sets the load or approach.
    #[must_use]
    pub const fn with_control(self, control: Control) -> Self {
        Self { control, ..self }
    }

    /// Sets where a prescribed load holds.
    #[must_use]
    pub const fn with_load_control(self, load_control: LoadControl) -> Self {
        Self { load_control, ..self }
    }

    /// Sets when plastic deformation is applied.
    #[must_use]
    pub const fn with_plastic_update(self, plastic_update: PlasticUpdate) -> Self {
        Self { plastic_update, ..self }
    }

    /// Sets the relative tolerance on the pass-mean load, > 0.
    #[must_use]
    pub const fn with_load_tolerance(self, load_tolerance: f64) -> Self {
        Self { load_tolerance, ..self }
    }

    /// Sets or removes the friction.
    #[must_use]
    pub fn with_friction(self, friction: impl Into<Option<Friction>>) -> Self {
        Self { friction: friction.into(), ..self }
    }

    /// Sets the speed of the upper body in an overlap, > 0.
    #[must_use]
    pub fn with_speed(self, speed: impl Into<Option<MetrePerSecond>>) -> Self {
        Self { speed: speed.into(), ..self }
    }

    /// Sets the path of a pass: one forward stroke, or a forward and a return stroke.
    #[must_use]
    pub const fn with_path(self, path: Path) -> Self {
        Self { path, ..self }
    }

    /// Sets the offset of the passes along y.
    #[must_use]
    pub const fn with_offset_y(self, offset_y: OffsetY) -> Self {
        Self { offset_y, ..self }
    }

    /// Sets the time, ≥ 0, for which viscoelastic bodies are apart between two passes.
    #[must_use]
    pub const fn with_pause(self, pause: Second) -> Self {
        Self { pause, ..self }
    }

    /// Time for which the bodies are apart before a pass; `None` if they stay in contact.
    pub(super) fn apart(&self) -> Option<Second> {
        (self.strategy == Strategy::Overlap || self.pause > 0.0).then_some(self.pause)
    }

    /// Returns the positions of a `pass`, from 1, for a lower and an upper body of `columns` columns, `width`
    /// cells across.
    ///
    /// One-way passes by a shift continue from one another: the slower surface starts where the pass before
    /// left it.
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

    /// Whether all passes have the same positions. They do if they share one offset along y, and if the
    /// surfaces of a shift return to their start: by whole rounds, or by a return stroke.
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

    /// Whether the bodies stay as they are during a pass. `yields` says whether a cell of them can deform
    /// plastically.
    pub fn is_frozen(&self, yields: bool) -> bool {
        self.plastic_update == PlasticUpdate::Pass || !yields
    }

    /// Whether a device solves all positions of a pass as one batch: none depends on another, and they share
    /// an approach.
    pub fn is_one_batch(&self, yields: bool) -> bool {
        let shared = matches!(self.control, Control::Approach(_)) || self.load_control == LoadControl::Pass;
        self.is_frozen(yields) && shared
    }

    /// Returns how many of the `positions` of a pass must be solved, the first ones. If the bodies do not
    /// change, the return stroke repeats the contacts of the forward stroke, unless friction displaces the
    /// surfaces normally, or each position `follows` from the one before.
    pub fn distinct(&self, positions: usize, yields: bool, couples: bool, follows: bool) -> usize {
        let stays = self.is_frozen(yields) && !follows;
        let pushed =
            self.sliding(Stroke::Forth).is_some_and(|sliding| sliding.shear_displaces_normally(couples));
        if self.path == Path::Reciprocating && stays && !pushed { positions / 2 } else { positions }
    }

    /// Number of cells along x of the way for which each position of a stroke stands. The positions of a
    /// shift of bodies with `columns` columns share one round.
    pub fn cells_of_position(&self, columns: usize) -> f64 {
        match self.strategy {
            Strategy::Overlap => self.stride as f64,
            Strategy::Shift { .. } => columns as f64 / columns.div_ceil(self.stride.min(columns)) as f64,
        }
    }

    /// Number of cells along x from the position before to the one of this `index`, from 0, of a pass of
    /// bodies with `columns` columns. The first position of a stroke of a shift comes last on the round, and
    /// is nearer if the stride does not divide the columns.
    pub fn cells_to_position(&self, index: usize, columns: usize) -> f64 {
        match self.strategy {
            Strategy::Overlap => self.stride as f64,
            Strategy::Shift { .. } => {
                let stride = self.stride.min(columns);
                let begins = index.is_multiple_of(columns.div_ceil(stride));
                if begins { ((columns - 1) % stride + 1) as f64 } else { stride as f64 }
            }
        }
    }

    /// Time in which the faster body moves by a number of `cells` of this pitch along x; NaN if the speed is
    /// not known.
    pub fn time_of(&self, cells: f64, pitch: Metre) -> Second {
        let way = cells * pitch;
        match self.strategy {
            Strategy::Overlap => self.speed.map_or(f64::NAN, |speed| way / speed),
            Strategy::Shift { speed_lower, speed_upper } => way / speed_lower.abs().max(speed_upper.abs()),
        }
    }

    /// Distance that the bodies slide while the faster one moves by a number of `cells` of this pitch along
    /// x.
    pub fn sliding_distance_of(&self, cells: f64, pitch: Metre) -> Metre {
        let way = cells * pitch;
        match self.strategy {
            Strategy::Overlap => way,
            Strategy::Shift { speed_lower, speed_upper } => {
                way * (speed_upper - speed_lower).abs() / speed_lower.abs().max(speed_upper.abs())
            }
        }
    }

    /// Speed at which the bodies slide over each other; NaN if it is not known.
    pub fn sliding_speed(&self) -> MetrePerSecond {
        match self.strategy {
            Strategy::Overlap => self.speed.unwrap_or(f64::NAN),
            Strategy::Shift { speed_lower, speed_upper } => (speed_upper - speed_lower).abs(),
        }
    }

    /// Direction of sliding and friction on a stroke, if there is friction: the upper body slides towards its
    /// motion.
    pub fn sliding(&self, stroke: Stroke) -> Option<Sliding> {
        let direction = [stroke.sign() * self.strategy.direction(), 0.0];
        self.friction.map(|friction| Sliding { friction, direction })
    }

    /// Returns how the bodies slip on each other on a stroke.
    pub fn slip(&self, stroke: Stroke) -> SlipRegime {
        self.sliding(stroke).into()
    }

    /// Returns the pressure bounds of the cells of a `pair` at a position, under the shear of the sliding
    /// bodies.
    pub(super) fn bounds(&self, pair: &Pair, position: &Position) -> Bounds {
        self.slip(position.stroke).sheared(pair.bounds(position))
    }
}
