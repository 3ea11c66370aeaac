//! `[output]`: output options.

use serde::Serialize;

use asperity_derive::Table;

/// Output options.
#[derive(Table, Debug, Clone, Copy, PartialEq, Serialize)]
#[table("output", default)]
#[non_exhaustive]
pub struct Output {
    /// Interval of the steps whose fields are stored, from the first one on; 0: none. A position of a pass
    /// has its pressure, a point of a sweep and an increment of bodies that attract each other have pressure
    /// and gap; the point of the largest drag and the increment of the largest pull are stored as well.
    #[key(count = 0, default = 8, example = "4")]
    pub pressure_every: usize,
    /// Part of a body's length, at its free ends, that the columns `…_interior` of the tables leave out.
    #[key(
        number = "a part of the length",
        range = Between { least: 0.0, most: 0.5, open: [false, true] },
        default = 0.1,
        example = "0.2"
    )]
    pub rim: f64,
    /// Whether all fields, and the stress below the surface as a volume, are also written as VTK image data
    /// (`.vti`).
    #[key(flag, default = false, example = "true")]
    pub paraview: bool,
}
