//! Quantities of a case beside which a value is judged. A value far from them most likely has another unit
//! than its author meant.

/// A quantity of a case, or a range between two.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Scale {
    /// The size of a cell.
    Cell,
    /// The longer side of the grid.
    Side,
    /// The longer side of the grid, if the boundary is free along an axis.
    FreeSide,
    /// The rms height of both surfaces together.
    Heights,
    /// The shortest relaxation time and the longest retardation time.
    RelaxationTimes,
    /// The speeds at which a cell passes in the longest retardation time, and the longer side of the grid in
    /// the shortest one.
    RelaxationSpeeds,
    /// The hardness of the body.
    Hardness,
    /// Young's modulus of the body.
    Young,
    /// The largest friction force.
    Friction,
    /// The largest mean pressure of the contact over the grid.
    MeanPressure,
    /// The loads, or mean pressures, at which rough surfaces touch in one cell and everywhere.
    Flattening,
    /// Another key of the table.
    Key(&'static str),
}

/// The multiples of a scale between which a value is plausible.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Beside {
    /// The scale.
    pub scale: Scale,
    /// The least multiple of the smaller end of the scale.
    pub least: f64,
    /// The largest multiple of the larger end.
    pub most: f64,
    /// Meaning of smaller and of larger values, in words.
    pub meaning: [&'static str; 2],
}

impl Beside {
    /// A value of at least a multiple of a scale.
    pub const fn least(scale: Scale, least: f64, meaning: &'static str) -> Self {
        Self { scale, least, most: f64::INFINITY, meaning: [meaning, ""] }
    }

    /// A value of at most a multiple of a scale.
    pub const fn most(scale: Scale, most: f64, meaning: &'static str) -> Self {
        Self { scale, least: 0.0, most, meaning: ["", meaning] }
    }

    /// A value between two multiples of a scale.
    pub const fn within(scale: Scale, [least, most]: [f64; 2], meaning: [&'static str; 2]) -> Self {
        Self { scale, least, most, meaning }
    }
}

/// Depths that are looked at below the surface.
pub const DEPTH: Beside = Beside::most(Scale::Side, 2.0, "the stress of the contacts does not reach so deep");
/// Wavelengths that bound a spectrum, and periods.
pub const LONG: Beside = Beside::most(Scale::Side, 3.0, "no such wave lies on the surface");
/// The deepest of several depths.
pub const DEEPEST: Beside = Beside::least(Scale::Cell, 0.5, "nothing lies between it and the surface");
/// Speeds at which bodies that relax are passed over.
pub const SPEED: Beside = Beside::within(
    Scale::RelaxationSpeeds,
    [0.01, 100.0],
    ["the bodies are relaxed throughout", "nothing relaxes while the contact passes"],
);
/// Tangential forces.
pub const FORCE: Beside = Beside::least(Scale::Friction, 1e-3, "the whole contact sticks");
/// Tangential displacements.
pub const DISPLACEMENT: Beside =
    Beside::most(Scale::Side, 0.1, "the model keeps the same cells opposite each other");
/// Approaches.
pub const APPROACH: Beside = Beside::most(Scale::Side, 1.0, "no body of this size moves so far");
/// Loads of a history, which may be small.
pub const LOAD: Beside = Beside::most(Scale::Flattening, 3.0, "the contact is complete");
/// Loads.
pub const LOADS: Beside =
    Beside::within(Scale::Flattening, [1.0, 3.0], ["hardly a cell is in contact", "the contact is complete"]);

impl Scale {
    /// The smaller and the larger end in words.
    pub fn words(self) -> [String; 2] {
        let both = |words: &str| [words.to_owned(), words.to_owned()];
        match self {
            Self::Cell => both("a cell"),
            Self::Side | Self::FreeSide => both("the longer side of the grid"),
            Self::Heights => both("the rms height of both surfaces"),
            Self::RelaxationTimes => {
                ["the shortest relaxation time".to_owned(), "the longest retardation time".to_owned()]
            }
            Self::RelaxationSpeeds => [
                "the speed at which a cell passes in the longest retardation time".to_owned(),
                "the speed at which the grid passes in the shortest relaxation time".to_owned(),
            ],
            Self::Hardness => both("the hardness of the body"),
            Self::Young => both("Young's modulus of the body"),
            Self::Friction => both("the largest friction force"),
            Self::MeanPressure => both("the mean pressure of the contact"),
            Self::Flattening => {
                ["what presses one cell flat".to_owned(), "what presses the surfaces flat".to_owned()]
            }
            Self::Key(key) => both(&format!("`{key}`")),
        }
    }
}
