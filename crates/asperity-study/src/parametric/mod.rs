//! A parametric study: many cases made from one, each in its own folder, computed by any number of processes.
//!
//! ```text
//! STUDY/study.json          identity of the study
//!       plan.csv            a row per case: its number, the values of its axes
//!       files.json          digests of the files named in the study, when the plan was made
//!       cases/0001/         case.toml and the results of a run, created when a process takes the case
//!       cases/0002/failed.json    in place of results: the reason of the failure
//!       table.csv           a row per case, or per point of its sweep: the values of its axes, the numbers of its results
//! ```
//!
//! A case is done when its `summary.json` exists. Processes share only these files and their locks.

mod axis; // a key of the case and its values
mod base_case; // the base case
mod compute; // computation of the remaining cases in parallel
mod files; // digests of the files that it names
mod filter; // excluded cases
mod folder; // the directory of a study
mod named_file; // a file that it names
mod plan; // the values of each case
mod points; // the points of sweeps within it
mod queue; // the remaining cases of a process
mod spread; // the spread over samples
mod study_file; // the study file
mod table; // the table of results

pub use axis::Axis;
pub use compute::compute;
pub use folder::{Folder, State, Tally};
pub use plan::{MAX_CASES, Study};
pub use queue::{Computed, OwnedCase, Queue, Task};
pub use spread::Spread;
pub use table::{Row, Table, TableColumn};
