//! A study: many cases made of one, each in a folder of its own, computed by any number of processes.
//!
//! ```text
//! STUDY/study.json          what the study is known by
//!       plan.csv            a row per case: its number, the values of its axes
//!       files.json          digests of the files that the study names, as they were when the plan was made
//!       cases/0001/         case.toml and the results of a run, made when the case is claimed
//!       cases/0002/failed.json    in place of results: why there are none
//!       claims/0003-1       a case under way: who computes it, written again and again
//!       table.csv table.h5  a row per case: the values of its axes, the numbers of its summary
//! ```
//!
//! A case is done when its `summary.json` is there. Processes share nothing but these files.

mod axis; // a key of the case and its values
mod base; // the case that all others are made of
mod claims; // who computes which case
mod compute; // computing what is left, case beside case
mod file; // the study file
mod files; // what the files held that it names
mod filter; // cases that are left out
mod folder; // what is there of a study
mod plan; // which values each case has
mod table; // what came of the cases
mod work; // what is left to a process, case after case

pub use axis::Axis;
pub use claims::{Holder, Worker};
pub use compute::compute;
pub use folder::{Folder, State, Tally};
pub use plan::{MAX_CASES, Study};
pub(super) use table::COLUMNS as TABLE_COLUMNS;
pub use table::{Row, Table};
pub use work::{Computed, Queue, Task, Turn};
