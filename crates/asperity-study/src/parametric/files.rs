//! Digests of the files named in a study, taken when its plan was made.

use std::collections::BTreeMap;
use std::io::ErrorKind;
use std::path::Path;

use rayon::prelude::*;

use super::named_file::NamedFile;
use super::plan::Study;
use crate::io::{atomic, regular, sha256_of_file};
use crate::surface_input::ExpectedContent;
use asperity_base::error::{Error, Result};

/// Digests by file name.
#[derive(Debug, Default)]
pub(super) struct Files {
    digests: BTreeMap<String, String>,
}

impl Files {
    /// Reads the digests at `path`; `None` if there is no such file.
    pub(super) fn read(path: &Path) -> Result<Option<Self>> {
        let failed = |source| Error::File { path: path.to_owned(), source };
        let text = match regular::read(path, "the digests of a study's files", u64::MAX) {
            Err(error) if error.kind() == ErrorKind::NotFound => return Ok(None),
            text => text.map_err(failed)?,
        };
        let digests = serde_json::from_slice(&text).map_err(|error| failed(error.into()))?;
        Ok(Some(Self { digests }))
    }

    /// Stores the digests of those files of a study that have none yet, at `path`.
    ///
    /// # Errors
    /// [`Error::File`].
    pub(super) fn keep(path: &Path, study: &Study) -> Result<()> {
        let named = study.files();
        loop {
            let known = Self::read(path)?;
            let is_first = known.is_none();
            let mut files = known.unwrap_or_default();
            let unknown: Vec<&NamedFile> =
                named.iter().filter(|file| !files.digests.contains_key(&file.name())).collect();
            let mut paths: Vec<&Path> = unknown.iter().map(|file| file.path.as_path()).collect();
            paths.sort_unstable();
            paths.dedup();
            // An unreadable file has no digest, and its cases will report why.
            let digests: BTreeMap<&Path, String> =
                paths.par_iter().filter_map(|path| Some((*path, sha256_of_file(path).ok()?))).collect();
            let found = unknown
                .iter()
                .filter_map(|file| Some((file.name(), digests.get(file.path.as_path())?.clone())));
            let before = files.digests.len();
            files.digests.extend(found);
            if files.digests.len() == before {
                return Ok(());
            }
            let text = serde_json::to_vec_pretty(&files.digests).expect("texts can be written");
            if !is_first {
                return atomic::replace(path, &text);
            }
            if atomic::create(path, &text)? {
                return Ok(());
            }
            // Another process was first, and its digests are valid.
        }
    }

    /// Required content of the files of a case, of a study in `directory`.
    pub(super) fn pinned(&self, directory: &Path, study: &Study, case: usize) -> ExpectedContent {
        let digest = |file: NamedFile| {
            let digest = self.digests.get(&file.name())?.clone();
            Some((file.key, (file.path, digest)))
        };
        let digests = study.files_of(case).into_iter().filter_map(digest).collect();
        ExpectedContent { directory: directory.to_owned(), digests }
    }
}
