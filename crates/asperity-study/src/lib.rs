//! Case files, their runs, and their results: contact of rough surfaces that press together and move.
//!
//! [`Case::load`] reads a case file. [`bodies`] reads or generates its surfaces and prepares them. [`demand`]
//! and [`estimate`] return cost and warnings in advance. [`run()`] does all of this and writes a [`Results`]
//! directory with a [`Summary`]. [`parametric`] computes studies of many cases.
//!
//! | you have | use | you get |
//! |---|---|---|
//! | a case file | [`Case::load`], [`run()`] | results on disk, a [`Summary`] |
//! | a case of a static contact, no disk | [`static_contact()`] | [`StaticResult`] with all fields |
//! | a case of a motion, pass by pass | [`Passes`] | each pass, and the bodies between passes |
//! | results | [`Results::open`] | its case, tables and fields |
//! | a study file | [`parametric::Study`] | a plan, its cases, a table |
//!
//! Everything of a case is checked key by key, with the place of a mistake: see
//! [`CaseError`](asperity_base::error::CaseError).
//!
//! # Results that survive
//!
//! **Order of writing.** Every file is written under a temporary name and renamed (`io::atomic`). Tables are
//! the exception: each step appends its rows (`study::tables`), so finished steps take no memory. A step is a
//! pass, an increment, an update or a point. It writes in this order:
//!
//! 1. its fields;
//! 2. the state from which the next step continues (`fields/state-NNNN.h5`, `study::state`);
//! 3. for a pass, the rows of `steps.csv`;
//! 4. its own row.
//!
//! A step is finished when its row is complete, including the end of the line. The state of the step before
//! is removed afterwards, so that a kill at any moment leaves a usable state. `summary.json` exists only once
//! the run is finished.
//!
//! **Start.** A run enters its directory (`study::results`, `Writer::enter`): it locks it and checks its
//! content. Then it begins (`Writer::begin`): it clears old results, removes stale temporary files and writes
//! `case.json`. Nothing changes between the two. Every error that does not need a solution is reported before
//! the begin. A contact in one step is solved before it begins. Clearing keeps `case.json` until it is
//! replaced, so that a results directory is always recognised. A run that is killed before its `case.json`
//! leaves only the lock file, temporary files and an empty `fields/`, which count as an empty directory.
//!
//! **Locks.** The lock is an operating-system lock on `.lock`. It ends with its process and is held until the
//! figures are drawn. Reading needs no lock. If the file system has no locks, `summary.json` contains a
//! warning. A process locks its temporary files (advisory locks, as on Unix). Every command removes stale
//! temporary files from the folders to which it writes, but only those of processes that have ended.
//!
//! **Memory.** Fields go to their temporary file one by one, and are read in parts (`io::fields`). Memory
//! holds the packed chunks of one field, not the file. Low bytes of numbers are noise, and are stored as they
//! are; any reader of HDF5 reads them.
//!
//! **Foreign files.** Only regular files are read (`io::regular`), because a pipe or a device has no end.
//!
//! **Studies.** Several processes may share the cases of a study (`study::parametric`). They communicate only
//! by files and locks. A case is finished if its `summary.json` or its `failed.json` exists. A process takes
//! a case by the lock of its results directory, checks again whether it is finished, and computes it under
//! that lock. The plan holds the digests of the files that the study names (`files.rs`). A case passes them
//! to `study::bodies` with its `SurfaceInput`, which compares them with the files read.
//!
//! **Identity.** `case.json` holds the SHA-256 of each surface file and an identity: the digest of all data
//! that decide the numbers (`study::identity`). The title, the number of passes and the folder of a file are
//! not part of it. Every field file carries the identity and a digest of its own content.
//!
//! **Resuming.** `--resume` compares the case key by key and the digests. It reads every field file of the
//! finished passes in full. If a file differs, is damaged or is missing, it names it in an error. Rows have
//! digests too (`study::tables::digest`, without times): a state has the digest of all rows before it, and
//! `summary.json` has the digest of the rows of finished results. A row that was edited by hand is an error.
//! Readers compare tables with the summary in the same way (`Results`), so that a truncated table is an error
//! that names the file.
//!
//! | resumed | taken from | same bits as an uninterrupted run |
//! |---|---|---|
//! | motion | surfaces of the last pass from its fields; from its state `motion::WarmStart`: the guess of the approach, and for each position the loaded cells with the change of their pressure | yes; but a finished motion with extrapolated passes that gets more passes has another last extrapolation |
//! | loading, sliding in place | its state, which holds everything the next step depends on | yes |
//! | sweep | its rows; the points do not depend on each other, so the state is the digest of the rows. The last point is always solved again, for `fields.h5` | yes |
//!
//! The state of a static contact is removed once `summary.json` exists.
//!
//! **Ranks.** Each file of a rank (`fields/rank-NNNN.h5`) holds the identity of the run, its rows and the
//! number of ranks. `fields/ranks.json` has the same data of all ranks, with a digest. `study::collect` reads
//! only files that agree. The first rank keeps a temporary file in the results directory until all ranks have
//! seen it, so that no two directories get parts of one run.
//!
//! **Interruptions.** Ctrl-C sets a flag that the watch reports. A motion stops at the next position, a
//! loading at the next increment, a sweep at the next point, and figures after the present one. Everything
//! written so far stays. The steps of a preparation and the description of a surface check a `surface::Stop`
//! regularly. A second Ctrl-C ends the process. A full disk, a limit on the size of files and a full stdout
//! are errors with exit code 1. A closed pipe is not an error.

pub mod case; // the case file, checked key by key
mod cell; // cells of tables as CSV
mod closed_form; // closed forms beside computed contacts
mod estimate; // cost and warnings of a case in advance
mod fields; // the fields of a static contact
mod finish; // beginning and end of every run
mod elasto_plastic; // elasto-plastic bodies of a case
mod surface_input; // surfaces in memory that a case names
mod identity; // identity of a run, to resume it
pub mod io; // fields in HDF5 and for ParaView, digests, locks
mod json; // records as JSON
pub mod joint; // the law of a joint for other programs
mod joined; // the steps of a run with everything found in them
mod limit; // a limit of the model that a result exceeds
mod lubrication; // the oil between the bodies of a case
mod master_curve; // master curves from files of instruments
mod viscoelastic; // viscoelastic bodies of a case
mod limits; // the limits of the model, compared with results
mod columns; // the dictionary of columns and numbers
pub mod parametric; // many cases made from one, each in its folder
mod observe; // observers of solved contacts
mod passes; // a motion, pass after pass
mod prepare; // from a case to its two surfaces
mod static_contact; // a static contact
mod results; // the results directory
mod review; // warnings about a result
mod run; // from a case to its results
mod subsurface; // the stress under the surface: plan and file
mod summary; // summary.json
mod tables; // steps.csv, passes.csv, increments.csv, sweep.csv

/// Parts of [`run()`], for programs that run a case in another way, such as on the ranks of MPI.
pub mod parts {
    pub use crate::estimate::{cut_off, spot, too_few_cells};
    pub use crate::finish::{Computed, closed_form, conclude, params};
    pub use crate::identity::{BodyData, identity_of, resolved_of};
    pub use crate::prepare::{Fit, Place, grids, hardness, topography_of};
    pub use crate::static_contact::pressed;
    pub use crate::summary::write as write_summary;
}

pub use case::Case;
pub use case::json_schema;
pub use case::rules::rules;
pub use case::schema::keys;
pub use case::schema::tables::dimension as dimension_of_key;
pub use closed_form::{ClosedForm, ClosedFormRecord, Theory};
pub use columns::{
    INCREMENT_COLUMNS, PASS_COLUMNS, STEP_COLUMNS, SWEEP_COLUMNS, column, columns, dimension_of_column,
    records, unit_of_column,
};
pub use estimate::{Demand, Estimate, demand, estimate, memory_on_device};
pub use fields::{NamedField, RestFields};
pub use identity::resolved;
pub use limit::{BrokenLimit, Limit};
pub use master_curve::MasterCurve;
pub use passes::Passes;
pub use prepare::{
    Bodies, MountedSurface, Origin, PreparedTopography, bodies, bodies_until, exact_pitch, grids, topography,
    topography_spec, topography_until,
};
pub use results::{
    Existing, Results, StepWriter, Writer, cap_name, pressure_name, temperature_name, traction_name,
};
pub use run::run;
pub use static_contact::{StaticResult, static_contact};
pub use subsurface::{Plan, SubsurfaceRecord};
pub use summary::{Outcome, RunningIn, Summary};
pub use surface_input::SurfaceInput;
pub use viscoelastic::ViscoelasticEstimate;
