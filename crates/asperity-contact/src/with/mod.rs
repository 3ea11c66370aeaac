//! Capabilities: what is computed from the contacts of a case besides the contacts themselves.
//!
//! A capability is a folder here. It holds the table of the case, which is the physics struct itself; its
//! law; the columns of its rows; its rules; the reasons to doubt its results; its numbers, curves and maps.
//! Everything else is generic: the reader of case files, the files of a run and their resuming, the rows of
//! the terminal, the figures, the page, the table of a study. It walks the one list of capabilities in this
//! file, with [`each!`](crate::each).
//!
//! | module | table of the case | computes |
//! |---|---|---|
//! | [`flow`] | `[flow]` | the leakage of a fluid through the gap |
//! | [`conductance`] | `[conductance]` | heat or current through a contact |
//! | [`fatigue`] | `[fatigue]` | fatigue below bodies under loads that repeat |
//! | [`joint`] | `[joint]` | tangential stiffness of a joint, and theories beside |
//!
//! A [`BodyLaw`] is a folder, too: what contacts do to a body.
//!
//! | module | tables of the case | changes |
//! |---|---|---|
//! | [`wear`] | `[lower.wear]`, `[upper.wear]` | the heights |
//! | [`film`] | `[lower.film]`, `[upper.film]` | the thickness of a tribofilm, and with it heights and hardness |
//!
//! A [`BodyProperty`] is a table of a body that contacts do not change.
//!
//! | module | tables of the case | says |
//! |---|---|---|
//! | [`viscoelastic`] | `[lower.viscoelastic]`, `[upper.viscoelastic]` | how the body relaxes |
//! | [`fatigue`] | `[lower.fatigue]`, `[upper.fatigue]` | which alternating loads it endures |
//!
//! [`Interfaces`] are the tables of what acts between the surfaces. Their laws are
//! [`Interface`](crate::solver::Interface)s of the solver.
//!
//! | module | table of the case | is |
//! |---|---|---|
//! | [`adhesion`] | `[adhesion]` | an attraction across the gap |
//!
//! | module | table of the case | is |
//! |---|---|---|
//! | [`lubrication`] | `[lubrication]` | an oil between the surfaces, whose films [`crate::lubrication`] solves for |

mod capability;
mod interface;
mod law;
mod property;
pub mod adhesion;
pub mod views;
pub mod conductance;
pub mod fatigue;
pub mod film;
pub mod flow;
pub mod joint;
pub mod lubrication;
pub mod plasticity;
pub mod viscoelastic;
pub mod wear;

pub use adhesion::views::{interface_cell, interface_cells, interface_lines};
pub use capability::{
    BodyConstants, BodyField, Capability, Given, NamedField, Observer, Place, Reported, Row, Rule,
    Surroundings, answering, of_last, ordinal,
};
pub use interface::InterfaceNumbers;
pub use law::{BodyLaw, ChangedSurfaces, Circumstances, LawRule, Slip, Timeless};
pub use property::BodyProperty;

use serde::{Deserialize, Serialize};

use crate::error::Result;
use crate::grid::Field;
use crate::motion::{
    FrettingRecord, IncrementRecord, Law, Pair, PassRecord, StepRow, SweepRecord, UpdateRecord,
};
use crate::operator::Boundary;
use views::{Answer, Kept, Line, OfPoints};

/// Repeats statements for each table of a list, which has the given name in them: `capability`, `law`,
/// `property` or `interface`. The lists stand here.
///
/// ```
/// use asperity_contact::each;
/// use asperity_contact::with::{BodyLaw, Capability};
///
/// let mut names = Vec::new();
/// each!(capability C => names.push(C::NAME));
/// each!(law L => names.push(L::NAME));
/// assert_eq!(names, ["flow", "conductance", "fatigue", "joint", "wear", "film"]);
/// ```
#[macro_export]
macro_rules! each {
    (capability $($what:tt)+) => {
        $crate::each! {
            [
                /// A fluid through the gap of each contact.
                flow::Leakage,
                /// Heat or current through each contact.
                conductance::Joint,
                /// Fatigue below bodies under loads that repeat.
                fatigue::Fatigue,
                /// The law of a joint under each load.
                joint::JointLaw,
            ]
            $($what)+
        }
    };
    (law $($what:tt)+) => {
        $crate::each! {
            [
                /// Wear of the body.
                wear::WearCoefficient,
                /// Tribofilm on the body.
                film::Film,
            ]
            $($what)+
        }
    };
    (property $($what:tt)+) => {
        $crate::each! {
            [
                /// Relaxation of the body.
                viscoelastic::Viscoelasticity,
                /// Limits of the body under alternating loads.
                fatigue::FatigueLimits,
            ]
            $($what)+
        }
    };
    (interface $($what:tt)+) => {
        $crate::each! {
            [
                /// Attraction between the bodies.
                adhesion::Attraction,
                /// Oil between the bodies.
                lubrication::Lubricant,
            ]
            $($what)+
        }
    };
    ([$($(#[$text:meta])+ $name:ident::$table:ident,)+] $of:ident => $statements:expr) => {{
        $({
            type $of = $crate::with::$name::$table;
            $statements;
        })+
    }};
    // The struct that holds those that are given.
    ([$($(#[$text:meta])+ $name:ident::$table:ident,)+] $(#[$about:meta])+ struct $all:ident) => {
        $(#[$about])+
        #[derive(Debug, Clone, Default, PartialEq, Serialize)]
        #[non_exhaustive]
        pub struct $all {
            $($(#[$text])+ #[serde(skip_serializing_if = "Option::is_none")] pub $name: Option<$name::$table>,)+
        }

        impl $all {
            /// Whether no table is given.
            pub fn is_empty(&self) -> bool {
                true $(&& self.$name.is_none())+
            }
        }

        $(impl Listed<$all> for $name::$table {
            fn of(all: &$all) -> Option<&Self> {
                all.$name.as_ref()
            }

            fn give(self, all: &mut $all) {
                all.$name = Some(self);
            }
        })+
    };
    // The struct that holds the rows of all capabilities.
    ([$($(#[$text:meta])+ $name:ident::$table:ident,)+] $(#[$about:meta])+ rows $all:ident) => {
        $(#[$about])+
        #[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
        #[non_exhaustive]
        pub struct $all {
            $(
                $(#[$text])+
                #[serde(default, skip_serializing_if = "Vec::is_empty")]
                pub $name: Vec<<$name::$table as Capability>::Row>,
            )+
        }

        $(impl Reported for $name::$table {
            fn rows(all: &$all) -> &[Self::Row] {
                &all.$name
            }

            fn add(all: &mut $all, rows: Vec<Self::Row>) {
                all.$name = rows;
            }
        })+
    };
}

each!(capability
    /// The capabilities that a case asks for, each by its table.
    struct Capabilities);
each!(capability
    /// The rows of the capabilities in a summary; empty for those that a case did not ask for.
    rows Observations);
each!(law
    /// The laws of a body, each by its table.
    struct BodyLaws);
each!(property
    /// The properties of a body that contacts do not change, each by its table.
    struct BodyProperties);
each!(interface
    /// The interface of the bodies, by its table; hard walls if none is given.
    struct Interfaces);

/// A table in the list of those that a case or a body may have.
pub trait Listed<All>: Sized {
    /// Returns it, if it is given.
    fn of(all: &All) -> Option<&Self>;

    /// Gives it.
    fn give(self, all: &mut All);
}

/// Whether a capability whose table is given uses a constant of the bodies without the others of its group.
pub fn uses(constant: &str, is_given: impl Fn(&str) -> bool) -> bool {
    let mut uses = false;
    each!(capability C => uses |= is_given(C::NAME) && C::CONSTANTS.contains(&constant));
    uses
}

/// Creates the laws of the lower and of the upper body of a pair.
///
/// # Errors
/// The reason why one does not apply to a body.
pub fn laws(bodies: [&BodyLaws; 2], pair: &Pair) -> Result<Vec<Box<dyn Law>>> {
    let mut laws = Vec::new();
    each!(law L => laws.extend(L::law(bodies, pair)?));
    Ok(laws)
}

/// Returns the fields that the laws keep of each body.
pub fn kept() -> Vec<Kept> {
    let mut kept = Vec::new();
    each!(law L => kept.extend(L::KEPT));
    kept
}

/// Returns what these passes have done to the bodies, as far as it answers a question of the user.
pub fn after_passes(passes: &[PassRecord]) -> Vec<Answer> {
    let mut answers = Vec::new();
    answers.extend(viscoelastic::in_passes(passes));
    answers.extend(lubrication::views::in_passes(passes));
    each!(law L => answers.extend(L::after_passes(passes)));
    answers
}

/// Returns what the increments of a loading show in time.
pub fn after_increments(increments: &[IncrementRecord]) -> Vec<Answer> {
    viscoelastic::in_time(increments).into_iter().collect()
}

/// Returns what the points of a sweep show beside the contact.
pub fn after_points(points: &[SweepRecord]) -> Vec<Answer> {
    [viscoelastic::answers(points), lubrication::views::answers(points)].concat()
}

/// Returns a number that is largest for the step of a course that the answers describe: the least load of
/// bodies that attract each other, the largest drag or the least traction of a sweep of speeds. `None` where the answers describe
/// the last step.
pub fn answering_rank(row: StepRow<'_>) -> Option<f64> {
    match row {
        StepRow::Increment(row) => row.interface.as_ref().map(|_| -row.load),
        StepRow::Point(row) => {
            let of_oil = row.lubrication.map(|film| -film.film.traction_coefficient);
            row.steady.map(|steady| steady.drag_coefficient).or(of_oil)
        }
        StepRow::Update(_) | StepRow::Pass(_) => None,
    }
}

/// Returns what cycles of slip have done to the bodies.
pub fn after_cycles(cycles: &FrettingRecord) -> Vec<Answer> {
    let mut answers = Vec::new();
    each!(law L => answers.extend(L::after_cycles(cycles)));
    answers
}

/// Returns what sliding in place has done to the bodies up to the last of the updates, which begin before it
/// slides.
pub fn after_sliding(updates: &[UpdateRecord]) -> Vec<Answer> {
    let mut answers = Vec::new();
    each!(law L => answers.extend(L::after_sliding(updates)));
    answers
}

/// Returns the jumps of a loading from one equilibrium to another, in words.
pub fn jumps(increments: &[IncrementRecord]) -> Vec<Line> {
    adhesion::jumps(increments)
}

/// Returns the curves over the points of a sweep besides those of the contact.
pub fn of_points() -> Vec<OfPoints> {
    let of_one = [viscoelastic::OF_POINTS, adhesion::OF_POINTS];
    of_one.into_iter().chain(lubrication::views::OF_POINTS).collect()
}

/// Returns the columns of a run that answer the question of the user, each with its name: those of the
/// interface, and those of the curves over points, passes, updates and cycles. Those of a capability are the
/// columns of its curves ([`Curve`](views::Curve)).
pub fn answering_columns() -> Vec<(String, String)> {
    let mut columns: Vec<(String, String)> = InterfaceNumbers::ANSWERS
        .iter()
        .copied()
        .chain(of_points().iter().map(|curve| (curve.column, curve.label)))
        .map(|(column, name)| (column.to_owned(), name.to_owned()))
        .collect();
    each!(law L => {
        let passes = L::OF_PASSES.iter().map(|curve| (curve.column, curve.name));
        let updates = L::OF_UPDATES.iter().map(|curve| (curve.column, curve.name));
        let cycles = L::OF_CYCLES.iter().map(|curve| (curve.column, curve.name));
        for (column, name) in passes.chain(cycles).chain(updates) {
            let both = ["lower", "upper"].map(|body| (column.replace("lower", body), format!("{name}, {body} body")));
            columns.extend(both);
        }
    });
    columns
}

/// Returns reasons in the `pressure` of a contact at rest not to trust it. `curved` says whether the bodies
/// are curved.
pub fn doubts_at_rest(pressure: &Field, boundary: Boundary, curved: impl FnOnce() -> bool) -> Option<String> {
    adhesion::cut_off(pressure, boundary, curved)
}

/// Returns reasons in the points of a sweep not to trust it.
pub fn doubts_after_points(interface: &Interfaces, points: &[SweepRecord]) -> Vec<String> {
    interface.lubrication.iter().flat_map(|oil| lubrication::after_points(oil, points)).collect()
}

/// Returns reasons in the increments of a loading not to trust it.
pub fn doubts_after_increments(increments: &[IncrementRecord]) -> Option<String> {
    adhesion::jumped(increments)
}

/// Returns reasons in the passes of a motion not to trust them.
pub fn doubts_after_passes(interface: &Interfaces, passes: &[PassRecord]) -> Vec<String> {
    let of_oil = interface.lubrication.iter().flat_map(|oil| lubrication::after_passes(oil, passes));
    adhesion::depends_on_history(passes).into_iter().chain(of_oil).collect()
}
