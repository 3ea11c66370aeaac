//! Views of results: figures, and a page that opens without a network.
//!
//! Both are made from a results directory and from nothing else, so that they can be made again.
//!
//! | module | content |
//! |---|---|
//! | [`check`] | a case in words before it is computed |
//! | [`describe`] | a topography in numbers |
//! | [`draw`] | maps, curves, reliefs and animations as PNG, SVG and PDF |
//! | [`figures`] | the figures of results |
//! | [`page`] | `report.html` |
//! | [`words`] | results in words and numbers |

pub mod words;
pub mod draw;
mod error;
pub mod figures;
pub mod page;
pub mod check;
pub mod describe;

pub use error::{Error, Result};
