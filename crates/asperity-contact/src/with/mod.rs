//! Capabilities: what is computed from the contacts of a case besides the contacts themselves.
//!
//! A capability is a folder here. It holds the table of the case, which is the physics struct itself; its law; the columns of its
//! rows; its rules; the reasons to doubt its results; its numbers, curves and maps. Everything else is generic: the reader of case
//! files, the files of a run and their resuming, the rows of the terminal, the figures, the page, the table of a study. It walks
//! the one list of capabilities in this file, with [`each_capability!`](crate::each_capability).
//!
//! | module | table of the case | computes |
//! |---|---|---|
//! | [`conductance`] | `[conductance]` | heat or current through a contact |
//! | [`flow`] | `[flow]` | the leakage of a fluid through its gap |

mod capability;
pub mod views;
pub mod conductance;
pub mod flow;

pub use capability::{
    BodyConstants, Capability, Given, Listed, NamedField, Observer, Place, Row, Rule, Surroundings,
};

use serde::{Deserialize, Serialize};

/// Declares the capabilities: their tables, each by its module and its struct. `$dollar` is the sign `$` of the macro that walks the list.
macro_rules! capabilities {
    ($dollar:tt; $($(#[doc = $text:literal])+ $name:ident::$table:ident;)+) => {
        /// The capabilities that a case asks for, each by its table.
        #[derive(Debug, Clone, Default, PartialEq, Serialize)]
        #[non_exhaustive]
        pub struct Capabilities {
            $($(#[doc = $text])+ #[serde(skip_serializing_if = "Option::is_none")] pub $name: Option<$name::$table>,)+
        }

        /// The rows of the capabilities in a summary; empty for those that a case did not ask for.
        #[derive(Debug, Clone, Default, PartialEq, Serialize, Deserialize)]
        #[non_exhaustive]
        pub struct Observations {
            $(
                $(#[doc = $text])+
                #[serde(default, skip_serializing_if = "Vec::is_empty")]
                pub $name: Vec<<$name::$table as Capability>::Row>,
            )+
        }

        $(impl Listed for $name::$table {
            fn asked(all: &Capabilities) -> Option<&Self> {
                all.$name.as_ref()
            }

            fn ask(self, all: &mut Capabilities) {
                all.$name = Some(self);
            }

            fn rows(all: &Observations) -> &[Self::Row] {
                &all.$name
            }

            fn add(all: &mut Observations, rows: Vec<Self::Row>) {
                all.$name = rows;
            }
        })+

        /// Repeats statements for each capability of the list, whose table has the given name in them.
        ///
        /// ```
        /// use asperity_contact::each_capability;
        /// use asperity_contact::with::Capability;
        ///
        /// let mut names = Vec::new();
        /// each_capability!(C => names.push(C::NAME));
        /// assert_eq!(names, ["conductance", "flow"]);
        /// ```
        #[macro_export]
        macro_rules! each_capability {
            ($dollar of:ident => $dollar statements:expr) => {{
                $({
                    type $dollar of = $dollar crate::with::$name::$table;
                    $dollar statements;
                })+
            }};
        }
    };
}

capabilities! { $;
    /// Heat or current through each contact.
    conductance::Joint;
    /// A fluid through the gap of each contact.
    flow::Leakage;
}

/// Whether a capability whose table is given uses a constant of the bodies without the others of its group.
pub fn uses(constant: &str, is_given: impl Fn(&str) -> bool) -> bool {
    let mut uses = false;
    each_capability!(C => uses |= is_given(C::NAME) && C::CONSTANTS.contains(&constant));
    uses
}
