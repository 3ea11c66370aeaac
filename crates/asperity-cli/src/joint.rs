//! `asperity joint`: the law of a joint for other programs, from samples of its surfaces.

use std::fs;
use std::path::{Path, PathBuf};

use asperity::study::joint::{Client, ClientSettings, Law, samples};
use asperity::study::parametric::{Folder, Queue, Study, Task};
use asperity::{Choice as _, Error};

use crate::report::{Outcome, note, print};
use crate::{args, place, study};
use asperity_report::{figures, page};

/// Computes the samples that are left, and writes the law with what is asked for.
pub(crate) fn joint(arguments: &args::Joint) -> Outcome {
    place::case(&arguments.case, "joint")?;
    let study = samples(&arguments.case, &arguments.clients)?;
    let study = match arguments.cases.device {
        Some(device) => study.on(device)?,
        None => study,
    };
    let directory = arguments.out.clone().unwrap_or_else(|| beside(&arguments.case));
    study.open_devices()?;
    let folder = Folder::enter(&directory, &study)?;
    study::compute(&Queue::new(&study, &folder, Task::ALL, arguments.cases.retry)?, arguments.cases.quiet)?;
    let settings = ClientSettings { units: arguments.units, friction: arguments.friction };
    let (law, doubts) = write_joint(&study, &folder, &arguments.clients, &settings)?;
    doubts.iter().for_each(|doubt| note(&format!("warning: {doubt}")));
    if arguments.cases.quiet { Ok(()) } else { print(&(page::joint_in_words(&law) + "\n")) }
}

/// Writes the table, the page, the figures of a law, and the files for these programs in place of those of an earlier command.
/// Returns the law and its warnings.
///
/// # Errors
/// [`Error::Unsupported`] if no sample is done, or if a program cannot take the law; [`Error::File`].
pub fn write_joint(
    study: &Study,
    folder: &Folder,
    clients: &[Client],
    settings: &ClientSettings,
) -> asperity::Result<(Law, Vec<String>)> {
    let law = Law::collect(study, folder)?;
    let path = |name: &str| folder.path().join(name);
    law.write_csv(&path("joint.csv"))?;
    let mut names = vec!["joint.csv".to_owned()];
    remove_files(folder.path())?;
    let mut refused = None;
    for client in clients {
        match client.files(&law, settings) {
            Ok(files) => {
                for file in files {
                    asperity::study::io::replace(&path(&file.name), file.text.as_bytes())?;
                    if !names.contains(&file.name) {
                        names.push(file.name);
                    }
                }
            }
            Err(error) => refused = refused.or(Some(error)),
        }
    }
    let doubts: Vec<String> = law.doubts().into_iter().chain(settings.doubt(&law)).collect();
    let failed = |error: asperity_report::Error| Error::File {
        path: path("figures"),
        source: std::io::Error::other(error.to_string()),
    };
    figures::draw_joint(&law, &path("figures"), &figures::FigureOptions::default(), &|| false)
        .map_err(failed)?;
    page::write_joint(&law, &names, &doubts, &path("joint.html"))?;
    // Files that another program takes are there all the same.
    refused.map_or(Ok((law, doubts)), Err)
}

/// Removes the files for other programs.
fn remove_files(folder: &Path) -> asperity::Result<()> {
    let failed = |source| Error::File { path: folder.to_owned(), source };
    let is_for = |name: &str| {
        name.strip_prefix("joint-")
            .is_some_and(|rest| Client::NAMES.iter().any(|client| rest.starts_with(client)))
    };
    for entry in fs::read_dir(folder).map_err(failed)? {
        let path = entry.map_err(failed)?.path();
        if path.is_file() && path.file_name().is_some_and(|name| is_for(&name.to_string_lossy())) {
            fs::remove_file(&path).map_err(|source| Error::File { path, source })?;
        }
    }
    Ok(())
}

/// The directory beside a case file.
fn beside(case: &Path) -> PathBuf {
    let mut name = case.file_stem().unwrap_or_default().to_owned();
    name.push("-joint");
    case.with_file_name(name)
}
