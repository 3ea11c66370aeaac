//! Readers of values of special forms, and their words.

pub(in crate::case) mod hardness;
pub(in crate::case) mod topography;
