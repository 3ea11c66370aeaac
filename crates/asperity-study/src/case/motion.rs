//! `[motion]`: motion of the bodies.

use serde::{Serialize, Serializer};

use super::prescribed::Prescribed;
use super::stage::WAITS;
use asperity_base::beside::{self, Beside, Scale};
use asperity_base::choice::choice;
use asperity_base::error::Result;
use asperity_base::exists;
use asperity_base::table::{Exists, Key, Kind, Source, Value};
use asperity_base::units::{MetrePerSecond, Second};
use asperity_contact::motion::{LoadControl, Motion, OffsetY, Path, PlasticUpdate, Strategy};
use asperity_contact::solver::Control;
use asperity_derive::Table;

/// A motion without its load, which is in [`Contact`](super::Contact); see
/// [`Case::motion`](super::Case::motion).
#[derive(Table, Debug, Clone, Copy, PartialEq, Serialize)]
#[table("motion", check = moves)]
#[non_exhaustive]
pub struct MotionSpec {
    /// `"overlap"`: the upper body enters on the left, passes over the lower one and leaves on the right;
    /// only the overlap is solved. `"shift"`: both bodies are shifted cyclically and the full contact is
    /// solved.
    #[key(choice, default = StrategyKind::Overlap, example = "\"shift\"")]
    pub strategy: StrategyKind,
    /// Number of passes.
    #[key(count = 1, default = 1, example = "5")]
    pub passes: usize,
    /// Cells from one position to the next.
    #[key(count = 1, default = 1, example = "4")]
    pub stride: usize,
    /// Prescribed quantity. `"pass-load"`: the mean load of a pass, with one approach for the pass;
    /// `"step-load"`: the load at each position; `"approach"`: the approach at all positions.
    ///
    /// Always there in a case.
    #[key(
        choice,
        absent = "`\"pass-load\"`; `\"approach\"` if [contact] gives an approach",
        example = "\"step-load\""
    )]
    pub control: Option<ControlKind>,
    /// When plastic deformation changes the surfaces: after each pass, or at every step; for elasto-plastic
    /// bodies always `"step"`.
    #[key(choice, default = PlasticUpdate::Pass, example = "\"step\"")]
    pub plastic_update: PlasticUpdate,
    /// Relative tolerance of the mean load of a pass.
    #[key(
        number = "a number",
        range = Between { least: 0.0, most: 1.0, open: [true, true] },
        default = 1e-4,
        written = "1e-4",
        example = "1e-6"
    )]
    pub load_tolerance: f64,
    /// `"shift"` only: speed of the lower surface along x; apart from times, only the ratio of the speeds
    /// matters.
    ///
    /// Always there in a shift.
    #[key(quantity = Speed, written = "0", example = "\"0.3 m/s\"", exists = exists::SPEED, beside = [beside::SPEED])]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub speed_lower: Option<MetrePerSecond>,
    /// `"shift"` only: speed of the upper surface along x; at most one speed may be 0.
    ///
    /// Always there in a shift.
    #[key(quantity = Speed, written = "\"1 m/s\"", example = "\"0.5 m/s\"", exists = exists::SPEED, beside = [beside::SPEED])]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub speed_upper: Option<MetrePerSecond>,
    /// `"overlap"` only: speed of the upper body; required for growing films, temperature, viscoelastic and
    /// lubricated bodies.
    #[key(
        quantity = Speed,
        range = AboveZero,
        absent = "unknown",
        example = "\"0.5 m/s\"",
        exists = exists::SPEED, beside = [beside::SPEED]
    )]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub speed: Option<MetrePerSecond>,
    /// Viscoelastic bodies only: time for which they are apart between two passes; without it the passes of a
    /// shift follow each other in contact.
    #[key(
        quantity = Time,
        range = FromZero,
        default = 0.0,
        written = "0",
        example = "\"10 s\"",
        exists = Exists::Any("a pause of any time"),
        beside = [Beside::within(Scale::RelaxationTimes, [0.03, 200.0], WAITS)]
    )]
    #[serde(skip_serializing_if = "is_zero")]
    pub pause: Second,
    /// `"reciprocating"`: a pass goes forth and back.
    #[key(choice, default = Path::OneWay, example = "\"reciprocating\"")]
    #[serde(skip_serializing_if = "is_one_way")]
    pub path: Path,
    /// Shift of the upper body along y from pass to pass, in cells; `"random"`: a random position, from
    /// `seed` and the number of the pass.
    #[key(
        special = offset,
        form = "whole number ≥ 0, or `\"random\"`",
        default = Offset::NONE,
        written = "0",
        example = "\"random\""
    )]
    #[serde(skip_serializing_if = "is_none")]
    pub offset_y: Offset,
    /// Seed of `offset_y = "random"`.
    ///
    /// Always there with random offsets.
    #[key(whole = 0, written = "0", example = "7")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub seed: Option<u64>,
    /// Upper body in the passes after the first: the same, or a fresh one, generated and prepared in the same
    /// way from another seed.
    #[key(choice, default = CounterBody::Same, example = "\"fresh\"")]
    #[serde(skip_serializing_if = "is_same")]
    pub counter: CounterBody,
}

/// The motion of the bodies over each other.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StrategyKind {
    /// Only the overlap is solved.
    Overlap,
    /// The surfaces are shifted circularly.
    Shift,
}

choice!(StrategyKind: "overlap" => Overlap, "shift" => Shift);

/// The control of a motion without its value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ControlKind {
    /// The mean load of a pass.
    PassLoad,
    /// The load at every position.
    StepLoad,
    /// The approach.
    Approach,
}

choice!(ControlKind: "pass-load" => PassLoad, "step-load" => StepLoad, "approach" => Approach);

/// Offset of the passes along y.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Offset {
    /// This many cells from pass to pass.
    Cells(usize),
    /// A random position in each pass.
    Random,
}

/// The upper body in the passes after the first.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum CounterBody {
    /// The same as in the first pass.
    Same,
    /// A new one for each pass, from the same generator with another seed.
    Fresh,
}

choice!(CounterBody: "same" => Same, "fresh" => Fresh);

impl MotionSpec {
    /// Returns the motion of bodies under this loading, with the values that depend on others.
    pub(super) fn resolved(self, prescribed: Prescribed) -> Self {
        let natural = match prescribed {
            Prescribed::Approach(_) => ControlKind::Approach,
            Prescribed::Load(_) | Prescribed::MeanPressure(_) => ControlKind::PassLoad,
        };
        let [speed_lower, speed_upper] = match self.strategy {
            StrategyKind::Overlap => [None; 2],
            StrategyKind::Shift => [self.speed_lower.or(Some(0.0)), self.speed_upper.or(Some(1.0))],
        };
        let seed = (self.offset_y == Offset::Random).then_some(self.seed.unwrap_or(0));
        Self { control: self.control.or(Some(natural)), speed_lower, speed_upper, seed, ..self }
    }

    /// Returns overlap or circular shift, with its speeds.
    pub fn strategy(&self) -> Strategy {
        match self.strategy {
            StrategyKind::Overlap => Strategy::Overlap,
            StrategyKind::Shift => Strategy::Shift {
                speed_lower: self.speed_lower.unwrap_or(0.0),
                speed_upper: self.speed_upper.unwrap_or(1.0),
            },
        }
    }

    /// Returns where the load in [`Contact`](super::Contact) holds: as the mean over a pass, or at each
    /// position.
    pub fn control(&self) -> ControlKind {
        self.control.unwrap_or(ControlKind::PassLoad)
    }

    /// Returns the offset of the passes along y.
    pub fn offset_y(&self) -> OffsetY {
        match self.offset_y {
            Offset::Cells(cells) => OffsetY::Cells(cells),
            Offset::Random => OffsetY::Random { seed: self.seed.unwrap_or(0) },
        }
    }

    /// Whether all passes have the same bodies at the same positions.
    pub fn repeats(&self) -> bool {
        self.counter == CounterBody::Same && self.under(Control::Approach(0.0)).repeats()
    }

    /// Returns the motion under a control.
    pub(super) fn under(&self, control: Control) -> Motion {
        Motion {
            strategy: self.strategy(),
            passes: self.passes,
            stride: self.stride,
            control,
            load_control: self.control().load_control(),
            plastic_update: self.plastic_update,
            load_tolerance: self.load_tolerance,
            friction: None,
            speed: self.speed,
            path: self.path,
            offset_y: self.offset_y(),
            pause: self.pause,
        }
    }
}

impl ControlKind {
    /// Where a load holds; irrelevant for an approach.
    fn load_control(self) -> LoadControl {
        match self {
            Self::StepLoad => LoadControl::Step,
            Self::PassLoad | Self::Approach => LoadControl::Pass,
        }
    }
}

impl Offset {
    const NONE: Self = Self::Cells(0);
}

/// The word for passes at random offsets along y.
const RANDOM: &str = "random";

impl Serialize for Offset {
    fn serialize<S: Serializer>(&self, serializer: S) -> std::result::Result<S::Ok, S::Error> {
        match self {
            Self::Cells(cells) => cells.serialize(serializer),
            Self::Random => RANDOM.serialize(serializer),
        }
    }
}

/// Reads a number of cells, or the word for random offsets.
fn offset(value: &dyn Value, key: &Key) -> Result<Offset> {
    if value.text().is_err() {
        return value.count(key, &Kind::Count { least: 0, most: u64::MAX }).map(Offset::Cells);
    }
    let random = value.word(&[RANDOM], &|_| None).map(|_| Offset::Random);
    random.map_err(|_| value.unexpected("a whole number of cells, or \"random\"", None))
}

fn moves(read: &MotionSpec, source: &dyn Source) -> Result<()> {
    let is_still = read.strategy == StrategyKind::Shift
        && read.speed_lower.unwrap_or(0.0) == 0.0
        && read.speed_upper == Some(0.0);
    match source.value("speed_upper").filter(|_| is_still) {
        Some(value) => Err(value.error("neither surface moves: both speeds are 0", None)),
        None => Ok(()),
    }
}

// Default values are omitted, so that cases from before these keys keep their digests.

fn is_zero(value: &f64) -> bool {
    *value == 0.0
}

fn is_one_way(path: &Path) -> bool {
    *path == Path::OneWay
}

fn is_none(offset: &Offset) -> bool {
    *offset == Offset::NONE
}

fn is_same(counter: &CounterBody) -> bool {
    *counter == CounterBody::Same
}
