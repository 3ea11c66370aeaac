//! `asperity example`: cases to start from, embedded in the program.

mod kits;

use std::fmt::Write as _;
use std::fs;
use std::path::{Path, PathBuf};

use asperity::Error;
use asperity::io;

use crate::args::Example;
use crate::report::{Failure, Outcome, note, print};
use kits::{ExampleFiles, KITS};

/// The study file of an example, if it has one.
const STUDY: &str = "load.toml";

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
    let next = if kit.files.iter().any(|(name, _)| *name == STUDY) {
        format!("study {}", folder.join(STUDY).display())
    } else {
        format!("run {}", folder.join("case.toml").display())
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
