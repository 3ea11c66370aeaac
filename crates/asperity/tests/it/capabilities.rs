//! A capability is a folder: its name stands outside only in the files listed here, each of which lets a user
//! call it by name.

use std::fs;
use std::path::{Path, PathBuf};

use crate::support::{crates, files_below};

/// A word, the folders of its capability, and the files outside them in which the word stands.
const CAPABILITIES: [(&str, &[&str], &[&str]); 7] = [
    (
        "conductance",
        // The law of a joint has what capabilities find under its loads.
        &["with/conductance", "src/joint/", "figures/joint.rs", "page/joint.rs"],
        &[
            // A case that shows it, and the caption of its figure.
            "asperity-cli/src/example/kits.rs",
            "asperity-report/src/words/captions.rs",
            "asperity/_joint.py",
            // The list, and its names in both libraries.
            "asperity-contact/src/with/mod.rs",
            "asperity-contact/src/lib.rs",
            "asperity/src/lib.rs",
            // Units.
            "asperity-base/src/units/quantity.rs",
            "asperity-base/src/units/range.rs",
            // The command that begins from a map.
            "asperity-cli/src/from_map/conductance.rs",
            "asperity-cli/src/from_map/mod.rs",
            // Its functions in Python, and the types that are made from its table.
            "asperity-python/src/maps.rs",
            "asperity/__init__.py",
            "asperity/_capabilities.py",
            "asperity/_conductance.py",
            "asperity/keys.py",
        ],
    ),
    (
        "leakage",
        &["with/flow", "src/joint/"],
        &[
            "asperity-contact/src/with/mod.rs",
            "asperity-contact/src/lib.rs",
            "asperity/src/lib.rs",
            // A case that shows it.
            "asperity-cli/src/example/kits.rs",
            "asperity-cli/src/from_map/flow.rs",
            "asperity-derive/src/lib.rs",
            "asperity-python/src/maps.rs",
            "asperity/__init__.py",
            "asperity/_capabilities.py",
            "asperity/_gap_flow.py",
            "asperity/keys.py",
        ],
    ),
    (
        "wear",
        &["with/wear"],
        &[
            "asperity-contact/src/with/mod.rs",
            "asperity-contact/src/lib.rs",
            "asperity/src/lib.rs",
            // The columns of laws, and a key of the extrapolation.
            "asperity-contact/src/motion/record/laws.rs",
            "asperity-contact/src/motion/extrapolation.rs",
            // Rules that require a law name all of them.
            "asperity-study/src/case/rules/examples.rs",
            "asperity-study/src/case/rules/motion.rs",
            "asperity-study/src/case/rules/running.rs",
            "asperity-study/src/case/rules/temperature.rs",
            // A key of the solid lubricant, and the wear that is faster than fatigue.
            "with/film/table.rs",
            "with/fatigue/critical.rs",
            // A case that shows it.
            "asperity-cli/src/example/kits.rs",
            // The keywords of a body, its columns and its removal in Python.
            "asperity/keys.py",
            "asperity/simulation.py",
            "asperity/_contact.py",
            "asperity/_fatigue.py",
        ],
    ),
    (
        "fatigue",
        &["with/fatigue"],
        &[
            "asperity-contact/src/with/mod.rs",
            "asperity-contact/src/lib.rs",
            "asperity/src/lib.rs",
            // Limits without the table, and elasto-plastic bodies.
            "asperity-study/src/case/rules/bodies.rs",
            // An example of cycles in time, which only it looks at.
            "asperity-study/src/case/rules/viscoelastic.rs",
            // The title of its example.
            "asperity-cli/src/example/kits.rs",
            // Its function in Python, and the rows of a run.
            "asperity-python/src/fatigue.rs",
            "asperity-python/src/lib.rs",
            "asperity/__init__.py",
            "asperity/_capabilities.py",
            "asperity/_fatigue.py",
            "asperity/simulation.py",
            "asperity/keys.py",
        ],
    ),
    (
        "adhesi",
        &["solver/adhesion", "with/adhesion"],
        &[
            // The lists, and its names in both libraries.
            "asperity-elastic/src/solver/mod.rs",
            "asperity-contact/src/with/mod.rs",
            "asperity-contact/src/with/interface.rs",
            "asperity-contact/src/lib.rs",
            "asperity/src/lib.rs",
            // A load that pulls the bodies apart, or may pull.
            "asperity-base/src/error/mod.rs",
            "asperity-study/src/case/stage.rs",
            "asperity-study/src/case/rules/loading.rs",
            // Tables that viscoelastic and lubricated bodies do not support.
            "asperity-study/src/case/rules/viscoelastic.rs",
            "asperity-study/src/case/rules/lubrication.rs",
            // A case that shows it.
            "asperity-cli/src/example/kits.rs",
            // Its numbers in Python, its error, and the types that are made from its table.
            "asperity/_contact.py",
            "asperity/_html.py",
            "asperity/errors.py",
            "asperity/keys.py",
        ],
    ),
    (
        "viscoelas",
        &["src/viscoelastic/", "with/viscoelastic", "src/master_curve/"],
        &[
            // The list, and its names in both libraries.
            "asperity-contact/src/with/mod.rs",
            "asperity-contact/src/lib.rs",
            "asperity/src/lib.rs",
            // A pair of such bodies, their memory in stages and passes, and their steady sliding.
            "asperity-contact/src/motion/pair.rs",
            "asperity-contact/src/motion/creeping.rs",
            "asperity-contact/src/motion/state.rs",
            "asperity-contact/src/motion/steady.rs",
            "asperity-contact/src/motion/kinematics.rs",
            "asperity-contact/src/motion/sliding.rs",
            "asperity-contact/src/motion/stage.rs",
            "asperity-contact/src/motion/sweep.rs",
            "asperity-contact/src/motion/pass.rs",
            "asperity-contact/src/motion/extrapolation.rs",
            "asperity-contact/src/motion/simulation/mod.rs",
            "asperity-contact/src/motion/simulation/search.rs",
            // Their columns.
            "asperity-contact/src/motion/record/steady.rs",
            "asperity-contact/src/motion/record/creep.rs",
            "asperity-contact/src/motion/record/increment.rs",
            "asperity-contact/src/motion/record/pass.rs",
            "asperity-contact/src/motion/record/step.rs",
            "asperity-contact/src/motion/record/sweep.rs",
            // Laws that it excludes.
            "with/film/rules.rs",
            "with/wear/rules.rs",
            // A case of such bodies: its keys and rules, its master curves, its memory.
            "asperity-study/src/viscoelastic.rs",
            "asperity-study/src/lib.rs",
            "asperity-study/src/case/mod.rs",
            "asperity-study/src/case/rules/mod.rs",
            "asperity-study/src/case/rules/viscoelastic.rs",
            "asperity-study/src/case/rules/lubrication.rs",
            "asperity-study/src/case/rules/temperature.rs",
            "asperity-study/src/case/body.rs",
            "asperity-study/src/case/motion.rs",
            "asperity-study/src/case/root.rs",
            "asperity-study/src/case/stage.rs",
            "asperity-study/src/case/schema/mod.rs",
            "asperity-study/src/estimate/mod.rs",
            "asperity-study/src/estimate/demand.rs",
            "asperity-study/src/finish.rs",
            "asperity-study/src/identity.rs",
            "asperity-study/src/prepare.rs",
            "asperity-study/src/review.rs",
            // The pair in words, curves and the caption of the drag, and a case that shows it.
            "asperity-report/src/check.rs",
            "asperity-report/src/figures/course.rs",
            "asperity-report/src/figures/loading.rs",
            "asperity-report/src/words/captions.rs",
            "asperity-cli/src/example/kits.rs",
            // A layer in Python.
            "asperity/material.py",
            // The types that are made from its table.
            "asperity/keys.py",
        ],
    ),
    (
        "lubric",
        &[
            "src/lubrication/",
            "with/lubrication",
            "motion/lubricated",
            "motion/moving_film.rs",
            "record/lubrication.rs",
        ],
        &[
            // The list, and its names in both libraries.
            "asperity-contact/src/with/mod.rs",
            "asperity-contact/src/with/interface.rs",
            "asperity-contact/src/lib.rs",
            "asperity/src/lib.rs",
            // A pair with an oil between its bodies, and their films in sweeps and passes.
            "asperity-contact/src/motion/mod.rs",
            "asperity-contact/src/motion/contact.rs",
            "asperity-contact/src/motion/course.rs",
            "asperity-contact/src/motion/pair.rs",
            "asperity-contact/src/motion/pass.rs",
            "asperity-contact/src/motion/state.rs",
            "asperity-contact/src/motion/sweep.rs",
            "asperity-contact/src/motion/simulation/mod.rs",
            "asperity-contact/src/motion/simulation/removal.rs",
            "asperity-contact/src/motion/simulation/search.rs",
            // Their columns.
            "asperity-contact/src/motion/record/mod.rs",
            "asperity-contact/src/motion/record/pass.rs",
            "asperity-contact/src/motion/record/step.rs",
            "asperity-contact/src/motion/record/sweep.rs",
            "asperity-study/src/columns.rs",
            // Wear and films of lubricated metals, solid lubricants, and a fluid that lifts.
            "asperity-base/src/exists.rs",
            "with/film/mod.rs",
            "with/film/table.rs",
            "with/wear/table.rs",
            "with/flow/doubts.rs",
            // Factors of mean equations of lubrication.
            "with/flow/shear.rs",
            "with/flow/table.rs",
            // A case of such bodies: its keys, rules and oil, its fields.
            "asperity-study/src/lubrication.rs",
            "asperity-study/src/lib.rs",
            "asperity-study/src/finish.rs",
            "asperity-study/src/static_contact.rs",
            "asperity-study/src/case/mod.rs",
            "asperity-study/src/case/course.rs",
            "asperity-study/src/case/motion.rs",
            "asperity-study/src/case/rules/mod.rs",
            "asperity-study/src/case/rules/examples.rs",
            "asperity-study/src/case/rules/lubrication.rs",
            "asperity-study/src/case/rules/temperature.rs",
            "asperity-study/src/case/schema/sweep.rs",
            "asperity-study/src/estimate/mod.rs",
            "asperity-study/src/estimate/demand.rs",
            "asperity-study/src/results/step.rs",
            "asperity-study/src/parametric/points.rs",
            // The oil in words, figures, rows, a case that shows it, and the list of lubricants.
            "asperity-report/src/check.rs",
            "asperity-report/src/figures/mod.rs",
            "asperity-report/src/figures/static_contact.rs",
            "asperity-report/src/page/interface.rs",
            "asperity-cli/src/run/rows.rs",
            "asperity-cli/src/example/kits.rs",
            "asperity-cli/src/materials.rs",
            "asperity-cli/src/args/pair.rs",
            "asperity/material.py",
            // The types that are made from its table.
            "asperity/keys.py",
        ],
    ),
];

#[test]
fn the_name_of_a_capability_stands_outside_its_folder_in_few_files() {
    let package = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../python/asperity");
    let sources = crates().into_iter().map(|(_, source)| source).chain([package]);
    let files: Vec<PathBuf> = sources.flat_map(|source| files_below(&source)).collect();
    assert!(files.len() > 300, "{} files", files.len());
    for (word, folders, known) in CAPABILITIES {
        let is_elsewhere = |file: &&PathBuf| {
            let path = file.to_string_lossy();
            !folders.iter().any(|folder| path.contains(folder))
                && !["/verification", "/reference", "/tests"].iter().any(|part| path.contains(part))
        };
        let names_it = |file: &&PathBuf| {
            let text = fs::read_to_string(file).unwrap();
            let text = text.split("#[cfg(test)]").next().unwrap_or_default().to_lowercase();
            text.match_indices(word).any(|(at, _)| !is_journal(&text[at + word.len()..]))
        };
        let found: Vec<&PathBuf> = files.iter().filter(is_elsewhere).filter(names_it).collect();
        let unknown: Vec<_> =
            found.iter().filter(|file| !known.iter().any(|known| file.ends_with(known))).collect();
        assert!(unknown.is_empty(), "'{word}' stands in {unknown:#?}");
        let gone: Vec<_> =
            known.iter().filter(|known| !found.iter().any(|file| file.ends_with(known))).collect();
        assert!(gone.is_empty(), "'{word}' no longer stands in {gone:#?}");
    }
}

/// Whether the word before this text is the name of a journal, which a volume follows: "Wear 42, 263 (1977)".
fn is_journal(text: &str) -> bool {
    text.strip_prefix(' ').is_some_and(|rest| rest.starts_with(|c: char| c.is_ascii_digit()))
}
