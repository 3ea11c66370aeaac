//! `asperity example`: cases to start from, part of the program.

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use asperity::Error;
use asperity::io::atomic;

use crate::args::Example;
use crate::report::{Failure, Outcome, note, print};

/// A case with its data.
struct Kit {
    name: &'static str,
    about: &'static str,
    files: &'static [(&'static str, &'static [u8])],
}

const KITS: [Kit; 4] = [
    Kit {
        name: "quickstart",
        about: "two rough steel surfaces run in: 64 × 64 cells, 5 passes",
        files: &[("case.toml", include_bytes!("../examples/quickstart/case.toml"))],
    },
    Kit {
        name: "hertz",
        about: "a ball on a plane, at rest: compare with Hertz",
        files: &[("case.toml", include_bytes!("../examples/hertz/case.toml"))],
    },
    Kit {
        name: "measured",
        about: "a ground disc from an x3p file with missing heights, against a polished plate",
        files: &[
            ("case.toml", include_bytes!("../examples/measured/case.toml")),
            ("disc.x3p", include_bytes!("../examples/measured/disc.x3p")),
            ("README.md", include_bytes!("../examples/measured/README.md")),
        ],
    },
    Kit {
        name: "paper",
        about: "the paper's problem: 100 × 100 cells, every position of 3 passes",
        files: &[("case.toml", include_bytes!("../examples/paper/case.toml"))],
    },
];

pub(crate) fn example(arguments: &Example) -> Outcome {
    let Some(name) = &arguments.name else {
        print(&list());
        return Ok(());
    };
    let Some(kit) = KITS.iter().find(|kit| kit.name == name) else {
        let names: Vec<_> = KITS.iter().map(|kit| format!("`{}`", kit.name)).collect();
        let hint = format!("there are {}", names.join(", "));
        return Err(Failure::usage(format!("no example `{name}`"), Some(&hint)));
    };
    let folder = arguments.out.clone().unwrap_or_else(|| PathBuf::from(kit.name));
    write(kit, &folder)?;
    note(&format!("next: asperity check {}", folder.join("case.toml").display()));
    Ok(())
}

fn list() -> String {
    KITS.iter().fold(String::new(), |mut list, kit| {
        let _ = writeln!(list, "{:<12} {}", kit.name, kit.about);
        list
    })
}

fn write(kit: &Kit, folder: &Path) -> Outcome {
    if folder.exists() {
        let message = format!("`{}` exists", folder.display());
        return Err(Failure::usage(message, Some("name another folder with --out")));
    }
    fs::create_dir_all(folder).map_err(|source| Error::File { path: folder.to_owned(), source })?;
    for (name, content) in kit.files {
        atomic::write(&folder.join(name), content)?;
        print(&format!("{}\n", folder.join(name).display()));
    }
    Ok(())
}
