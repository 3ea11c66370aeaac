//! The ground on which the crates of asperity stand: units, grids, errors, options with words, files, shared
//! mathematics, and ranks.
//!
//! Use it through [`asperity-surface`](https://docs.rs/asperity-surface) for topographies, or through
//! [`asperity`](https://docs.rs/asperity) for contacts. They re-export what their users need.
//!
//! | module | content |
//! |---|---|
//! | [`units`] | aliases of SI quantities; texts such as `"2.4 GPa"`, read and written |
//! | [`choice`](mod@choice) | [`Choice`]: the words of an option |
//! | [`error`] | [`Error`] and [`Result`] |
//! | [`record`] | [`columns!`]: the fields of a record are the columns of its table |
//! | [`mod@table`] | tables of keys, each key declared once |
//! | [`grid`] | [`Grid`], [`Field`], [`CellValues`], the placement of a grid on another |
//! | `io`, a feature | atomic writing, reading of regular files |
//! | [`ranks`] | processes that share the rows of one grid |
//! | [`watch`] | [`watch::Watch`]: observation of a contact while it is solved |
//! | [`math`] | transforms of real fields, work in bands of rows, quadrature, sums |

// A module may use those above it, never those below.
pub mod units;
pub mod choice;
pub mod error;
pub mod grid;
pub mod record;
pub mod beside;
pub mod table;
pub mod exists;
#[cfg(feature = "io")]
pub mod io;
pub mod ranks;
pub mod watch;
pub mod math;

pub use ndarray;

pub use choice::Choice;
pub use error::{Error, Result};
pub use grid::{CellValues, Field, Grid, SingleField};
