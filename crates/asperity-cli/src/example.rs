//! `asperity example`: cases to start from, embedded in the program.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use asperity::Error;
use asperity::io;

use crate::args::Example;
use crate::report::{Failure, Outcome, note, print};

/// A case with its data.
struct ExampleFiles {
    name: &'static str,
    about: &'static str,
    files: &'static [(&'static str, &'static [u8])],
}

/// The study file of an example, if it has one.
const STUDY: &str = "load.toml";

/// The examples that the command writes.
const KITS: [ExampleFiles; 14] = [
    ExampleFiles {
        name: "quickstart",
        about: "two rough steel surfaces run in: 64 × 64 cells, 5 passes",
        files: &[("case.toml", include_bytes!("../examples/quickstart/case.toml"))],
    },
    ExampleFiles {
        name: "hertz",
        about: "a ball on a plane, at rest: compare with Hertz",
        files: &[("case.toml", include_bytes!("../examples/hertz/case.toml"))],
    },
    ExampleFiles {
        name: "friction",
        about: "a ball pushed to and fro on a plane: stick, slip and the loop of Cattaneo and Mindlin",
        files: &[("case.toml", include_bytes!("../examples/friction/case.toml"))],
    },
    ExampleFiles {
        name: "fretting",
        about: "a ball that frets on a plate: 10 000 cycles of partial slip, of which some 20 are computed",
        files: &[
            ("case.toml", include_bytes!("../examples/fretting/case.toml")),
            ("gross-slip.toml", include_bytes!("../examples/fretting/gross-slip.toml")),
        ],
    },
    ExampleFiles {
        name: "viscoelastic",
        about: "a rough slider over rubber: friction and real area of contact over five decades of speed",
        files: &[
            ("case.toml", include_bytes!("../examples/viscoelastic/case.toml")),
            ("master.csv", include_bytes!("../examples/viscoelastic/master.csv")),
        ],
    },
    ExampleFiles {
        name: "micropitting",
        about: "two ground surfaces tire: f over its limit by Dang Van, and the wear that would be faster",
        files: &[("case.toml", include_bytes!("../examples/micropitting/case.toml"))],
    },
    ExampleFiles {
        name: "measured",
        about: "a ground disc from an x3p file with missing heights, against a polished plate",
        files: &[
            ("case.toml", include_bytes!("../examples/measured/case.toml")),
            ("disc.x3p", include_bytes!("../examples/measured/disc.x3p")),
            ("README.md", include_bytes!("../examples/measured/README.md")),
        ],
    },
    ExampleFiles {
        name: "running-in",
        about: "wear, tribofilm and flash temperature over 100 000 passes, 141 of them computed",
        files: &[("case.toml", include_bytes!("../examples/running-in/case.toml"))],
    },
    ExampleFiles {
        name: "rolling",
        about: "a ball rolls ten times over ground steel, which flows below its surface and shakes down",
        files: &[("case.toml", include_bytes!("../examples/rolling/case.toml"))],
    },
    ExampleFiles {
        name: "pull-off",
        about: "an AFM tip on a rough polymer: the force-distance curve of two bodies that attract each other",
        files: &[("case.toml", include_bytes!("../examples/pull-off/case.toml"))],
    },
    ExampleFiles {
        name: "contact-challenge",
        about: "the Contact-Mechanics Challenge, adhesive and rough, on 512 × 512 cells",
        files: &[("case.toml", include_bytes!("../examples/contact-challenge/case.toml"))],
    },
    ExampleFiles {
        name: "seal",
        about: "a measured disc against a flat ring: leakage and heat over loads, as the ring wears, and over samples",
        files: &[
            ("case.toml", include_bytes!("../examples/seal/case.toml")),
            ("wear.toml", include_bytes!("../examples/seal/wear.toml")),
            ("sample.toml", include_bytes!("../examples/seal/sample.toml")),
            ("samples.toml", include_bytes!("../examples/seal/samples.toml")),
            ("disc.x3p", include_bytes!("../examples/measured/disc.x3p")),
        ],
    },
    ExampleFiles {
        name: "study",
        about: "many cases made of one: contact area over pressure for two roughnesses, in samples",
        files: &[
            ("case.toml", include_bytes!("../examples/study/case.toml")),
            (STUDY, include_bytes!("../examples/study/load.toml")),
        ],
    },
    ExampleFiles {
        name: "paper",
        about: "the paper's problem: 100 × 100 cells, every position of 3 passes",
        files: &[("case.toml", include_bytes!("../examples/paper/case.toml"))],
    },
];

pub(crate) fn example(arguments: &Example) -> Outcome {
    let Some(name) = &arguments.name else {
        return print(&list());
    };
    let kit = kit(name)?;
    let folder = arguments.out.clone().unwrap_or_else(|| PathBuf::from(kit.name));
    if folder.exists() {
        let message = format!("`{}` exists", folder.display());
        return Err(Failure::usage(message, Some("name another folder with --out")));
    }
    let paths = write(kit, &folder)?;
    let next = match kit.files.iter().any(|(name, _)| *name == STUDY) {
        true => format!("study {}", folder.join(STUDY).display()),
        false => format!("run {}", folder.join("case.toml").display()),
    };
    note(&format!("next: asperity {next}"));
    print(&paths.iter().map(|path| format!("{}\n", path.display())).collect::<String>())
}

/// Writes the example `name` into `folder`, over existing files, and returns the path of its case file.
pub(crate) fn unpack(name: &str, folder: &Path) -> Outcome<PathBuf> {
    write(kit(name)?, folder)?;
    Ok(folder.join("case.toml"))
}

fn kit(name: &str) -> Outcome<&'static ExampleFiles> {
    KITS.iter().find(|kit| kit.name == name).ok_or_else(|| {
        let names: Vec<_> = KITS.iter().map(|kit| format!("`{}`", kit.name)).collect();
        let hint = format!("there are {}", names.join(", "));
        Failure::usage(format!("no example `{name}`"), Some(&hint))
    })
}

fn list() -> String {
    KITS.iter().fold(String::new(), |mut list, kit| {
        let _ = writeln!(list, "{:<17} {}", kit.name, kit.about);
        list
    })
}

fn write(kit: &ExampleFiles, folder: &Path) -> Outcome<Vec<PathBuf>> {
    fs::create_dir_all(folder).map_err(|source| Error::File { path: folder.to_owned(), source })?;
    io::sweep(folder);
    kit.files
        .iter()
        .map(|(name, content)| {
            let path = folder.join(name);
            io::replace(&path, content)?;
            Ok(path)
        })
        .collect()
}
