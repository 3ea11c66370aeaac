//! Two bodies in relative motion: positions, passes, the geometry of the pair and its plastic change.

mod approach;
mod batch;
mod body;
mod contact;
mod control;
mod course;
mod creeping;
mod fretting;
mod plastic_volume;
mod elasto_plastic;
mod heat;
mod implicit;
mod kinematics;
mod extrapolation;
mod law;
mod loading;
mod memory;
mod observed;
mod pair;
mod paraboloid;
mod pass;
mod path;
mod press;
mod truncation;
mod record;
mod regime;
mod report;
mod rim;
mod simulation;
mod sliding;
mod slip;
mod spot;
mod stage;
mod state;
mod steady;
mod store;
mod sweep;
mod together;
mod volumes;
mod warm_start;
mod watch;
mod worn_away;

pub use asperity_base::record::{Column, Presence};
pub use body::{Body, State};
pub use contact::Contact;
pub use control::{LoadControl, check_limit};
pub use course::{Output, Step, StepRow};
pub use elasto_plastic::{PlasticPath, press_elasto_plastic};
pub use extrapolation::{Acceleration, LastExtrapolation};
pub use fretting::{ChangedBodies, LastCycle};
pub use heat::FLASH;
pub use kinematics::{Motion, PlasticUpdate, Strategy};
pub(crate) use law::largest;
pub use law::{ContactCells, Law, Sums};
pub use loading::{StagedLoading, load_in_stages};
pub use memory::{LoadCycle, Memory};
pub use observed::ObservedContact;
pub use pair::Pair;
pub use pair::{initial_gap, opposing_values};
pub use paraboloid::Paraboloid;
pub use path::{OffsetY, Path, Position, Stroke, overlap_positions, shift_positions};
pub use plastic_volume::{PlasticResult, PlasticVolume};
pub use press::press;
pub use record::lost_volumes::{ENDINGS, is_volume_of_law};
pub use record::{
    CreepRecord, DragRecord, FrettingRecord, HeatRecord, IncrementRecord, LawsInCycles, LawsInPass,
    LawsInUpdate, LostVolume, PassDragRecord, PassPlasticRecord, PassRecord, PlasticRecord,
    PlasticStepRecord, Regime, ResidualRecord, RunningRecord, ShearRecord, StaticRecord, SteadyRecord,
    StepRecord, SweepRecord, UpdateRecord,
};
pub use report::{CycleReport, PassReport};
pub use rim::Interior;
pub use simulation::{Simulation, SolvedPass};
pub use sliding::{Slide, SlidingContact, SlidingOutcome};
pub use slip::SlipRegime;
pub use spot::largest_spot;
pub use stage::{Cycles, Origin, Progress as StageProgress, Stage, StageTime};
pub use state::{Flattening, LoadedContact, LoadingState, SlidingState};
pub use steady::MovingBody;
pub use store::{CourseState, StateReader, StateWriter};
pub use sweep::{Point, SweepState, YieldingBodies, sweep, sweep_elasto_plastic};
pub use together::memory_together;
pub use truncation::Truncation;
pub use warm_start::{Guess, LoadedCells, WarmStart};
pub use watch::{Progress, StepCell, StopsWith, Watch};
