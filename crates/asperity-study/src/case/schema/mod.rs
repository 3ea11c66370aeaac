//! Keys of a case file, each declared once.
//!
//! A declaration holds the name, the accepted values, the default, an example and the meaning. The reader of case files,
//! its messages, the units of study axes and the tables of `docs/input` are derived from it.

pub(crate) mod adhesion;
pub(crate) mod body;
pub(crate) mod loading;
pub(crate) mod hardness;
pub(crate) mod list;
pub(crate) mod moving;
pub(crate) mod results;
pub(crate) mod plasticity;
pub(crate) mod root;
pub(crate) mod tables;
pub(crate) mod topography;
pub(crate) mod typed;
pub(crate) mod values;
pub(crate) mod running_in;

use std::sync::LazyLock;

use asperity_base::table::Table as _;
pub use asperity_base::table::{Bounds, Exists, Fallback, Key, Kind, Section};
use asperity_contact::each_capability;
use asperity_contact::with::Capability;

/// Returns all keys of a case file, section by section, in the order in which a misplaced key is searched.
///
/// ```
/// let keys = asperity_study::keys();
/// let motion = keys.iter().find(|section| section.tables == ["motion"]).unwrap();
/// let stride = motion.keys.iter().find(|key| key.name == "stride").unwrap();
/// assert_eq!(stride.kind.to_string(), "whole number ≥ 1");
/// assert_eq!(stride.default.to_string(), "`1`");
/// ```
pub fn keys() -> &'static [Section] {
    static KEYS: LazyLock<Vec<Section>> = LazyLock::new(|| {
        let (mut root, mut of_capabilities) = (root::SECTION.keys.to_vec(), Vec::new());
        each_capability!(C => {
            root.push(typed::table(C::NAME, Fallback::Absent("none"), C::MEANING).key);
            of_capabilities.push(C::SECTION);
        });
        let root = Section { keys: root.leak(), ..root::SECTION };
        [&[root], OF_EVERY_CASE, &of_capabilities].concat()
    });
    &KEYS
}

/// The sections other than those above all tables, and other than those of the capabilities.
const OF_EVERY_CASE: &[Section] = &[
    body::both::SECTION,
    body::upper::SECTION,
    body::coating::SECTION,
    loading::contact::SECTION,
    adhesion::SECTION,
    moving::motion::SECTION,
    loading::friction::SECTION,
    results::subsurface::SECTION,
    crate::case::Output::SECTION,
    asperity_contact::motion::Acceleration::SECTION,
    crate::case::SlidingSpec::SECTION,
    running_in::temperature::SECTION,
    running_in::wear::SECTION,
    running_in::film::SECTION,
    running_in::arrhenius::SECTION,
    running_in::mechano_chemical::SECTION,
    running_in::solid_lubricant::SECTION,
    plasticity::body::SECTION,
    plasticity::volume::SECTION,
    topography::every::SECTION,
    topography::file::SECTION,
    topography::given::SECTION,
    topography::generate::SECTION,
    topography::low_pass::SECTION,
    topography::autocorrelation::SECTION,
    topography::self_affine::SECTION,
    topography::form::SECTION,
    topography::sphere::SECTION,
    topography::ellipsoid::SECTION,
    topography::cylinder::SECTION,
    topography::cone::SECTION,
    topography::flat::SECTION,
    topography::sinusoid::SECTION,
    topography::grooves::SECTION,
    loading::history::SECTION,
    list::SECTION,
    hardness::map::SECTION,
    hardness::given::SECTION,
];

#[cfg(test)]
mod tests {
    use std::fmt::Debug;

    use asperity_base::table::{Fallback, Table};
    use asperity_contact::each_capability;
    use asperity_contact::motion::Acceleration;

    use super::super::cursor::Table as Written;
    use super::super::document::Document;
    use crate::case::{Output, SlidingSpec};

    #[test]
    fn a_derived_table_reads_its_defaults_as_it_writes_them() {
        /// Reads the table with the examples of the required keys, and with the default of the others if they are `told`.
        fn read<T: Table>(told: bool) -> T {
            let lines = T::SECTION.keys.iter().filter_map(|key| match key.default {
                Fallback::Required => Some(format!("{} = {}\n", key.name, key.example)),
                Fallback::Value(default) => told.then(|| format!("{} = {default}\n", key.name)),
                Fallback::Absent(_) => None,
            });
            let (mut document, text) = (Document::default(), lines.collect::<String>());
            let entries = document.parse(&text).unwrap();
            T::read(&Written::root(&document, entries.get_ref())).unwrap()
        }
        fn check<T: Table + PartialEq + Debug>() {
            assert_eq!(read::<T>(true), read::<T>(false));
        }
        check::<Output>();
        check::<Acceleration>();
        check::<SlidingSpec>();
        each_capability!(C => check::<C>());
        assert_eq!(Acceleration::default(), read(true));
        assert_eq!(Output::default(), read(true));
    }
}
