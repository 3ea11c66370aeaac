//! Keys of a case file, each declared once, as a field of the struct of its table.
//!
//! A declaration holds the name, the accepted values, the default, an example and the meaning. The reader of
//! case files, its messages, the units of study axes and the tables of `docs/input` are derived from it.

mod numbers;
mod source;
pub(crate) mod sweep;
pub(crate) mod tables;

use std::sync::LazyLock;

use super::body::{BodyKeys, LayerKeys, UpperKeys};
use super::root::Root;
use super::{Contact, FrictionSpec, HardnessMap, MotionSpec, StageSpec, SubsurfaceSpec, TopographySpec};
pub use asperity_base::table::{Bounds, Exists, Fallback, Key, Kind, Section};
use asperity_base::table::{Part as _, Table as _};
use asperity_contact::each;
use asperity_contact::temperature::Temperature;
use asperity_contact::with::plasticity::{PlasticRegion, Yielding};
use asperity_contact::with::viscoelastic::Steady;
use asperity_contact::with::{BodyLaw, BodyProperty, Capability};

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
        let (mut root, mut of_capabilities) = (Root::sections()[0].keys.to_vec(), Vec::new());
        each!(interface I => root.push(table(I::NAME, "none", I::MEANING)));
        each!(capability C => {
            root.push(table(C::NAME, "none", C::MEANING));
            of_capabilities.extend(C::sections());
        });
        let root = Section { tables: &[], kind: "", keys: root.leak() };
        [vec![root], of_every_case(), of_capabilities].concat()
    });
    &KEYS
}

/// Returns the sections other than those above all tables, and other than those of the capabilities.
fn of_every_case() -> Vec<Section> {
    let mut body = BodyKeys::sections();
    let (mut of_both, mut of_laws) = (body[0].keys.to_vec(), Vec::new());
    let (mut of_properties, mut of_interfaces) = (Vec::new(), Vec::new());
    each!(interface I => of_interfaces.extend(I::sections()));
    each!(property P => {
        of_both.push(table(P::NAME, P::WITHOUT, P::MEANING));
        of_properties.extend(P::sections());
    });
    each!(law L => {
        of_both.push(table(L::NAME, "none", L::MEANING));
        of_laws.extend(L::sections());
    });
    body[0].keys = of_both.leak();
    [
        body,
        UpperKeys::sections(),
        LayerKeys::sections(),
        Contact::sections(),
        of_interfaces,
        MotionSpec::sections(),
        FrictionSpec::sections(),
        SubsurfaceSpec::sections(),
        crate::case::Output::sections(),
        asperity_contact::motion::Acceleration::sections(),
        crate::case::SlidingSpec::sections(),
        Temperature::sections(),
        of_laws,
        of_properties,
        Steady::sections(),
        Yielding::sections(),
        PlasticRegion::sections(),
        merged(TopographySpec::sections()),
        StageSpec::sections(),
        sweep::Ends::sections(),
        HardnessMap::sections(HardnessMap::TABLES),
    ]
    .concat()
}

/// Declares a table of a list.
fn table(name: &'static str, absent: &'static str, text: &'static str) -> Key {
    Key {
        name,
        kind: Kind::Table,
        default: Fallback::Absent(absent),
        example: "",
        text,
        exists: Exists::Undeclared,
        beside: &[],
    }
}

/// Puts the keys of the same choice in one section.
fn merged(sections: Vec<Section>) -> Vec<Section> {
    let mut merged: Vec<Section> = Vec::new();
    for section in sections {
        match merged.iter_mut().find(|known| known.kind == section.kind) {
            Some(known) => known.keys = [known.keys, section.keys].concat().leak(),
            None => merged.push(section),
        }
    }
    merged
}

#[cfg(test)]
mod tests {
    use std::fmt::Debug;

    use asperity_base::error::Result;
    use asperity_base::table::{Fallback, Key, Part, Section, Source, Table};
    use asperity_contact::motion::Acceleration;
    use asperity_contact::temperature::Temperature;
    use asperity_contact::with::adhesion::Attraction;
    use asperity_contact::with::lubrication::Lubricant;
    use asperity_contact::with::plasticity::{PlasticRegion, Yielding};
    use asperity_contact::with::viscoelastic::{Steady, Viscoelasticity};
    use asperity_contact::{each, film, wear};
    use asperity_surface::{Form, Generator};

    use super::super::cursor::Table as Written;
    use super::super::document::Document;
    use super::sweep::Ends;
    use super::{BodyKeys, HardnessMap, LayerKeys, TopographySpec, UpperKeys};
    use crate::case::{Contact, FrictionSpec, MotionSpec, Output, SlidingSpec, StageSpec, SubsurfaceSpec};

    /// Reads a table of this dotted name and of these sections, once for each choice, with the examples of
    /// the required keys, and with the default of the others if they are `told`. `one` is a key of which one
    /// of several is required.
    fn read<T>(
        path: &str,
        sections: &[Section],
        one: &str,
        told: bool,
        read: impl Fn(&dyn Source) -> Result<T>,
    ) -> Vec<T> {
        let line = |key: &Key| match key.default {
            Fallback::Required => Some(format!("{} = {}\n", key.name, key.example)),
            Fallback::Value(default) => told.then(|| format!("{} = {default}\n", key.name)),
            Fallback::Absent(_) => None,
        };
        let lines = |section: &Section, but: &str| -> String {
            section.keys.iter().filter(|key| key.name != but).filter_map(line).collect()
        };
        let (own, choices): (Vec<&Section>, Vec<_>) =
            sections.iter().partition(|section| section.kind.is_empty());
        let texts = match choices.as_slice() {
            [] => vec![own.iter().map(|section| lines(section, "")).collect::<String>()],
            choices => {
                let of_choice = |choice: &&Section| {
                    let key = choice.kind.split(' ').next().unwrap_or_default();
                    let own: String = own.iter().map(|section| lines(section, key)).collect();
                    format!("{}\n{own}{}", choice.kind, lines(choice, key))
                };
                choices.iter().map(of_choice).collect()
            }
        };
        let read = |text: String| {
            read_text(path, &format!("{one}\n{text}"), &read)
                .unwrap_or_else(|error| panic!("[{path}]\n{one}\n{text}{error}"))
        };
        texts.into_iter().map(read).collect()
    }

    fn check<T: Table + PartialEq + Debug>(one: &str) {
        let read = |told| read(T::TABLES[0], &T::sections(), one, told, T::read);
        assert_eq!(read(true), read(false));
    }

    /// Reads a table of this dotted name.
    fn read_text<T>(path: &str, text: &str, read: impl Fn(&dyn Source) -> Result<T>) -> Result<T> {
        let (mut document, text) = (Document::default(), format!("[{path}]\n{text}"));
        let entries = document.parse(&text)?;
        let root = Written::root(&document, entries.get_ref());
        read(&path.split('.').fold(root, |table, name| table.table(name).unwrap().unwrap()))
    }

    /// Checks that a table reads the example of each key of the sections of a `kind`, beside the keys
    /// `beside` or in place of them.
    fn check_examples<T>(
        path: &str,
        sections: &[Section],
        kind: &str,
        beside: &str,
        read: impl Fn(&dyn Source) -> Result<T>,
    ) {
        let keys = sections.iter().filter(|section| section.kind == kind).flat_map(|section| section.keys);
        let mut read_keys = 0;
        for Key { name, example, .. } in keys.filter(|key| !key.example.is_empty()) {
            let line = format!("{name} = {example}");
            let others: Vec<&str> =
                beside.lines().filter(|other| !other.starts_with(&format!("{name} ="))).collect();
            // Beside all others, or without those that it excludes.
            let mut results = (0..1 << others.len()).map(|left_out: usize| {
                let rest = others.iter().enumerate().filter(|(index, _)| left_out >> index & 1 == 0);
                let text: String = rest.map(|(_, other)| format!("{other}\n")).collect();
                read_text(path, &format!("{text}{line}\n"), &read)
            });
            let first = results.next().expect("at least one");
            let is_read = first.is_ok() || results.any(|result| result.is_ok());
            assert!(is_read, "[{path}]\n{beside}\n{line}\n{}", first.err().unwrap());
            read_keys += 1;
        }
        assert!(read_keys > 0, "[{path}] has no key with {kind}");
    }

    fn check_table<T: Table>(beside: &str) {
        check_examples(T::TABLES[0], &T::sections(), "", beside, T::read);
    }

    fn check_part<P: Part + PartialEq + Debug>() {
        const PATH: &str = "lower.topography";
        let sections = P::sections(&[PATH]);
        assert!(sections.len() > 1);
        for section in sections {
            let one = if section.keys.iter().any(|key| key.name == "sdq") { "sdq = 0.1" } else { "" };
            let read = |told| read(PATH, &[section], one, told, P::read);
            assert_eq!(read(true), read(false));
        }
    }

    #[test]
    fn a_derived_table_reads_its_defaults_as_it_writes_them() {
        check::<Output>("");
        check::<Acceleration>("");
        check::<SlidingSpec>("");
        each!(capability C => check::<C>(""));
        check::<wear::WearCoefficient>("coefficient = 1e-16");
        check::<film::Film>("");
        check::<Temperature>("");
        check::<Attraction>("");
        check::<Lubricant>("viscosity = 0.04\npressure_viscosity = 2e-8\nspeed = 1");
        check::<SubsurfaceSpec>("");
        check::<LayerKeys>("young = 1e9\npoisson = 0.3");
        check::<Viscoelasticity>("moduli = [1e6]\ntimes = [1]");
        check::<Steady>("speed = 1");
        check::<Contact>("load = 1");
        check::<FrictionSpec>("");
        check::<StageSpec>("");
        assert_eq!(Acceleration::default(), read("acceleration", &[], "", true, Acceleration::read)[0]);
        assert_eq!(Output::default(), read("output", &[], "", true, Output::read)[0]);
        check_part::<Form>();
        check_part::<Generator>();
    }

    #[test]
    fn a_table_reads_the_example_of_each_of_its_keys() {
        check_table::<Contact>("load = 1");
        check_table::<FrictionSpec>("coefficient = 0.3");
        check_table::<StageSpec>("");
        check_table::<MotionSpec>("");
        check_table::<SlidingSpec>("distance = 1");
        check_table::<SubsurfaceSpec>("to = 1");
        check_table::<Output>("");
        check_table::<Acceleration>("");
        check_table::<Temperature>("bulk = 300");
        check_table::<LayerKeys>("thickness = 1\nmaterial = \"dlc\"");
        check_table::<Steady>("speed = 1");
        check_table::<PlasticRegion>("depth = 1\nlayers = 2");
        check_table::<Yielding>("yield_stress = 1e9\nkinematic = 1e9");
        check_table::<BodyKeys>("topography = { form = \"flat\" }");
        check_table::<UpperKeys>("");
        check_table::<Ends>("from = 1\nto = 2");
        check_table::<Attraction>("work = 0.05\nrange = 2e-9");
        let oil = "viscosity = 0.04\npressure_viscosity = 2e-8\nspeed = 1\nlaw = \"doolittle\"\nbulk_modulus = 1.4e9\noccupied_volume = 0.6";
        check_table::<Lubricant>(oil);
        let topography = |kind: &str, beside: &str| {
            let path = TopographySpec::TABLES[0];
            check_examples(path, &TopographySpec::sections(), kind, beside, TopographySpec::read);
        };
        topography("", "form = \"flat\"");
        topography("file", "file = \"disc.x3p\"");
        topography("given", "given = \"disc\"");
        topography("generate", "generate = \"low-pass\"\nsq = 1e-6\ncutoff = 1e-5");
        topography("form", "form = \"sphere\"\nradius = 1");
        let map = HardnessMap::sections(HardnessMap::TABLES);
        check_examples(HardnessMap::TABLES[0], &map, "file", "file = \"map.npy\"", HardnessMap::read);
        check_examples(HardnessMap::TABLES[0], &map, "given", "", HardnessMap::read);
    }

    /// The defaults of these depend on the case: the table alone leaves them open.
    #[test]
    fn a_derived_table_reads_its_examples() {
        let motion = read("motion", &MotionSpec::sections(), "", false, MotionSpec::read);
        assert_eq!((motion[0].speed_lower, motion[0].speed_upper, motion[0].seed), (None, None, None));
        let yielding =
            read("lower.plasticity", &Yielding::sections(), "yield_stress = 1e9", false, Yielding::read);
        assert_eq!(yielding[0].hardening, None);
        let volume = read("plasticity", &PlasticRegion::sections(), "", false, PlasticRegion::read);
        assert_eq!((volume[0].depth, volume[0].layers, volume[0].unload), (20e-6, 16, None));
    }
}
