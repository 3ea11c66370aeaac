//! The definition of a property of a body, as a table of the body.

use std::fmt::Debug;
use std::path::Path;

use serde::Serialize;

use asperity_base::table::Table;

/// A property of a body that contacts do not change, such as its relaxation. Its struct is the table
/// `[lower.NAME]` and `[upper.NAME]` of a case.
pub trait BodyProperty: Table + Serialize + Clone + PartialEq + Debug + Send + Sync + 'static {
    /// Name of its table.
    const NAME: &'static str;
    /// Its meaning in the list of the keys of a body.
    const MEANING: &'static str;
    /// The body without it: "elastic".
    const WITHOUT: &'static str;

    /// Takes files that it names to be relative to a `folder`.
    #[must_use]
    fn in_folder(self, folder: &Path) -> Self {
        let _ = folder;
        self
    }

    /// Whether material may break out of the body, which ends each extrapolation over passes.
    fn breaks_out(&self) -> bool {
        false
    }
}
