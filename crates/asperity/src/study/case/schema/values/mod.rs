//! Readers of values of special forms, and their words.

pub(in crate::study::case) mod adhesion;
pub(in crate::study::case) mod contact;
pub(in crate::study::case) mod hardness;
pub(in crate::study::case) mod motion;
pub(in crate::study::case) mod plasticity;
pub(in crate::study::case) mod running;
pub(in crate::study::case) mod subsurface;
pub(in crate::study::case) mod sweep;
pub(in crate::study::case) mod topography;
