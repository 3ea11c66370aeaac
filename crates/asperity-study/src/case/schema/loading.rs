//! Keys of a contact, its friction and its history.

use super::Bounds::{AboveZero, AboveZeroOrInfinite, Any, FromZero, FromZeroOrInfinite};
use super::Exists;
use super::typed::{
    FRACTION, Optional, PRESSURE, Typed, Value, choice, count, defaulted, number, number_named, optional,
    other, quantity, required, section, vector,
};
use super::values::contact as read;
use super::values::sweep as list;
use asperity_base::exists;
use asperity_base::units::Dimension;

const FORCE: Value<f64> = quantity(Dimension::Force, AboveZero).exists(exists::LOAD);
const SIGNED_FORCE: Value<f64> = quantity(Dimension::Force, Any).exists(exists::LOAD);
const SIGNED_LENGTH: Value<f64> = quantity(Dimension::Length, Any).exists(exists::LENGTH);
const CREEPAGE: Value<f64> = number_named("a finite number", Any);

const ONE: &str = "exactly one of the six that give a load or an approach";
const NONE: &str = "at most one of the six in the plane";

/// The form of a list of values.
const SEVERAL: &str = "list of at least one value, or a [table](#a-sweep)";

const LOAD: Optional<f64> = optional(
    "load",
    FORCE,
    ONE,
    "\"2 N\"",
    "total normal force; in a motion, the mean over a pass or the force at each position, see `control`",
);
const MEAN_PRESSURE: Optional<f64> = optional(
    "mean_pressure",
    PRESSURE.exists(exists::LOAD),
    ONE,
    "\"1 MPa\"",
    "load over the apparent area, the area of all cells at full overlap; during an overlap motion half of them overlap on average, so \
     that the mean pressure there is about twice as large",
);
const APPROACH: Optional<f64> = optional(
    "approach",
    SIGNED_LENGTH,
    ONE,
    "\"10 nm\"",
    "distance by which the bodies have approached, of any sign; 0 if the planes z = 0 of both height maps coincide",
);

/// The load of a stage. Below 0 it pulls at bodies that attract each other.
const SIGNED_LOAD: Optional<f64> = optional(
    "load",
    SIGNED_FORCE,
    "unchanged",
    "\"2 N\"",
    "as in [contact]; at most one of the three; with [adhesion] it may be 0 or pull, below 0",
);
const SIGNED_MEAN_PRESSURE: Optional<f64> = optional(
    "mean_pressure",
    quantity(Dimension::Pressure, Any).exists(exists::LOAD),
    "unchanged",
    "\"1 MPa\"",
    "as in [contact]; at most one of the three; with [adhesion] it may be 0 or pull, below 0",
);

/// `[contact]`.
pub(crate) mod contact {
    use super::*;
    use crate::case::GridMatch;
    use asperity_contact::operator::Boundary;
    use asperity_contact::solver::{Device, Method};

    section! { &["contact"], "";
        LOAD: Optional<f64> = super::LOAD;
        MEAN_PRESSURE: Optional<f64> = super::MEAN_PRESSURE;
        APPROACH: Optional<f64> = super::APPROACH;
        LOADS: Optional<Vec<f64>> = optional(
            "loads",
            other(Some(Dimension::Force), SEVERAL, |_, entry| list::loads(entry))
                .exists(exists::LOAD),
            ONE,
            "[\"0.1 N\", \"1 N\"]",
            "several loads, one after the other",
        );
        MEAN_PRESSURES: Optional<Vec<f64>> = optional(
            "mean_pressures",
            other(Some(Dimension::Pressure), SEVERAL, |_, entry| list::mean_pressures(entry))
                .exists(exists::LOAD),
            ONE,
            "[\"1 MPa\", \"10 MPa\"]",
            "several mean pressures, one after the other",
        );
        APPROACHES: Optional<Vec<f64>> = optional(
            "approaches",
            other(Some(Dimension::Length), SEVERAL, |_, entry| list::approaches(entry))
                .exists(exists::LENGTH),
            ONE,
            "[\"10 nm\", \"20 nm\"]",
            "several approaches, one after the other",
        );
        BOUNDARY: Typed<Boundary> = defaulted(
            "boundary",
            other(None, "`\"free\"`, `\"periodic\"`, or one word for each axis: `[\"free\", \"periodic\"]`", |_, entry| {
                read::boundary(entry)
            }),
            "\"free\"",
            "[\"free\", \"periodic\"]",
            "continuation beyond the edges: `\"free\"`, an unloaded half-space; `\"periodic\"`, copies of the contact; one of \
             each: a line contact",
        );
        GRID: Typed<GridMatch> = defaulted(
            "grid",
            choice::<GridMatch>(),
            "\"as-prepared\"",
            "\"common\"",
            "`\"common\"` resamples both prepared surfaces to the coarser pitch and crops them about their centres to a common size; \
             `\"as-prepared\"` requires surfaces that fit",
        );
        METHOD: Typed<Method> =
            defaulted("method", choice::<Method>(), "\"auto\"", "\"direct\"", "solver; all methods give the same result");
        DEVICE: Typed<Device> = defaulted(
            "device",
            choice::<Device>(),
            "\"cpu\"",
            "\"cuda\"",
            "what solves the contact: `\"cpu\"`; `\"cuda\"`, a GPU of NVIDIA; `\"host\"`, the solver of the GPU in plain loops \
             on the processor, for comparison",
        );
        TOLERANCE: Typed<f64> = defaulted(
            "tolerance",
            FRACTION,
            "1e-6",
            "1e-8",
            "residual η at which the solver stops, see [theory](theory.md)",
        );
    }
}

const IN_PLANE_FORCE: Optional<[f64; 2]> =
    optional("force", vector(&SIGNED_FORCE), "0", "\"0.1 N\"", "force of the upper body on the lower one");
const DISPLACEMENT: Optional<[f64; 2]> = optional(
    "displacement",
    vector(&SIGNED_LENGTH),
    NONE,
    "\"0.1 um\"",
    "displacement of the upper body relative to the lower one",
);
const SLIDING: Optional<[f64; 2]> = optional(
    "sliding",
    other(None, "`[x, y]` of any length", |_, entry| read::direction(entry)),
    NONE,
    "[1, 0]",
    "sliding direction of the upper body; every cell slips",
);

/// `[friction]`.
pub(crate) mod friction {
    use super::*;
    use asperity_contact::solver::Coupling;

    section! { &["friction"], "";
        COEFFICIENT: Typed<f64> =
            required("coefficient", number(FromZeroOrInfinite("nothing slips")).exists(exists::FRICTION), "0.3", "coefficient of friction μ");
        COUPLING: Typed<Coupling> = defaulted(
            "coupling",
            choice::<Coupling>(),
            "\"full\"",
            "\"none\"",
            "coupling between dissimilar bodies: `\"goodman\"`, pressure displaces tangentially, but shear does not displace \
             normally; `\"none\"`, neither",
        );
        SHEAR_STRENGTH: Typed<f64> = defaulted(
            "shear_strength",
            quantity(Dimension::Pressure, AboveZeroOrInfinite("no limit")).exists(exists::SHEAR_STRENGTH),
            "inf",
            "\"20 MPa\"",
            "τ, the largest shear stress of the interface under any pressure, for example of a boundary film",
        );
        JUNCTION_GROWTH: Typed<f64> = defaulted(
            "junction_growth",
            number(FromZero),
            "0",
            "9",
            "α in p² + αq² ≤ H²: shear lowers the cap of the pressure, and the contact grows; about 9 for metals",
        );
        FORCE: Optional<[f64; 2]> = super::IN_PLANE_FORCE;
        DISPLACEMENT: Optional<[f64; 2]> = super::DISPLACEMENT;
        SLIDING: Optional<[f64; 2]> = super::SLIDING;
        CREEPAGE: Optional<[f64; 2]> = optional(
            "creepage",
            vector(&super::CREEPAGE),
            NONE,
            "0.001",
            "steady rolling along x: velocity of the upper body relative to the lower one, over the rolling velocity",
        );
        CREEPAGES: Optional<Vec<[f64; 2]>> = optional(
            "creepages",
            other(None, SEVERAL, |_, entry| list::creepages(entry)),
            NONE,
            "[0.001]",
            "several creepages, one after the other",
        );
        SPIN: Typed<f64> = defaulted(
            "spin",
            number_named("a number, in 1/m", Any),
            "0",
            "25",
            "rolling only, in 1/m: angular velocity of the upper body relative to the lower one, over the rolling velocity, about z through \
             the middle of the grid, positive from +x towards +y",
        );
        ROLLING_FORCE: Optional<[f64; 2]> = optional(
            "rolling_force",
            vector(&SIGNED_FORCE),
            NONE,
            "\"0.1 N\"",
            "steady rolling along x: force of the upper body on the lower one",
        );
        INCREMENTS: Typed<usize> = defaulted(
            "increments",
            count(1),
            "1",
            "20",
            "equal steps in which load and tangential load grow from 0",
        );
    }
}

/// `[[history]]`.
pub(crate) mod history {
    use super::*;

    section! { &["history"], "";
        LOAD: Optional<f64> = super::SIGNED_LOAD;
        MEAN_PRESSURE: Optional<f64> = super::SIGNED_MEAN_PRESSURE;
        APPROACH: Optional<f64> = super::APPROACH.elsewhere("unchanged", "as in [contact]; at most one of the three");
        FORCE: Optional<[f64; 2]> = super::IN_PLANE_FORCE.elsewhere("unchanged", "as in [friction], which it requires; at most one of the three");
        DISPLACEMENT: Optional<[f64; 2]> = super::DISPLACEMENT.elsewhere("unchanged", "as in [friction], which it requires; at most one of the three");
        SLIDING: Optional<[f64; 2]> = super::SLIDING.elsewhere("unchanged", "as in [friction], which it requires; at most one of the three");
        INCREMENTS: Optional<usize> = optional(
            "increments",
            count(1),
            "1; with a `duration` or a `dwell` 16; for elasto-plastic bodies the number in [plasticity]",
            "10",
            "equal steps from the end of the previous stage; in a cycle of each way",
        );
        CYCLES: Optional<usize> = optional(
            "cycles",
            count(1),
            "none: the loading goes there once",
            "10000",
            "number of cycles, in each of which the loading goes there and comes back",
        );
        DURATION: Optional<f64> = optional(
            "duration",
            quantity(Dimension::Time, AboveZero).exists(Exists::Any("a stage of any time")),
            "none: at once",
            "\"0.1 s\"",
            "time in which the loading goes there, in equal steps, for viscoelastic bodies",
        );
        DWELL: Optional<f64> = optional(
            "dwell",
            quantity(Dimension::Time, AboveZero).exists(Exists::Any("a dwell of any time")),
            "none",
            "\"10 s\"",
            "time for which the loading then stays, in `increments` steps that grow, for viscoelastic bodies",
        );
        PERIOD: Optional<f64> = optional(
            "period",
            quantity(Dimension::Time, AboveZero).exists(Exists::Any("a cycle of any time")),
            "unknown",
            "\"50 ms\"",
            "time of a cycle, for films that grow and for viscoelastic bodies",
        );
    }
}
