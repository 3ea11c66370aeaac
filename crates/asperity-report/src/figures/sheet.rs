//! Where figures are gathered, and written at the end.

use std::path::PathBuf;

use asperity_study::Results;
use asperity_study::io::{self, fs};
use rayon::prelude::*;

use super::{Curves, FigureOptions};
use crate::draw::{self, Caption, Colours, Figure, Format, Paper, Scene};
use crate::error::{Error, Result};

/// Hundredths of a second that a frame of an animation is shown.
const DELAY: u16 = 12;

/// The figures drawn so far. They are written in the end, on as many threads as there are.
pub struct Sheet<'a> {
    folder: PathBuf,
    wanted: &'a FigureOptions,
    case: String,
    names: Vec<String>,
    drawings: Vec<(PathBuf, Drawing)>,
    /// A second paper, and the names of the figures that are also drawn on it.
    beside: Option<(Paper, &'a [&'a str])>,
    /// Scenes on the second paper, with the names of their figures.
    pictures: Vec<(String, Scene)>,
    /// Whether no more are wanted.
    stop: &'a (dyn Fn() -> bool + Sync),
}

/// The longest title of a case that stands in full on its figures, characters.
const MAX_CHARACTERS: usize = 160;

enum Drawing {
    Still(Scene),
    Moving(Vec<Scene>, Colours),
}

impl<'a> Sheet<'a> {
    pub(super) fn new(
        results: &Results,
        wanted: &'a FigureOptions,
        stop: &'a (dyn Fn() -> bool + Sync),
    ) -> Result<Self> {
        Ok(Self::into_folder(results.figures_folder(), &results.case()?.title, wanted, stop))
    }

    /// A sheet whose figures go into a folder, of what has this title.
    pub(super) fn into_folder(
        folder: PathBuf,
        title: &str,
        wanted: &'a FigureOptions,
        stop: &'a (dyn Fn() -> bool + Sync),
    ) -> Self {
        let mut case: String = title.chars().take(MAX_CHARACTERS).collect();
        if case.len() < title.len() {
            case.push('…');
        }
        let (names, drawings, pictures) = (Vec::new(), Vec::new(), Vec::new());
        Self { folder, wanted, case, names, drawings, beside: None, pictures, stop }
    }

    /// Also draws the figures of these names on another paper, whether they are wanted or not.
    pub(super) fn with_pictures(self, beside: (Paper, &'a [&'a str])) -> Self {
        Self { beside: Some(beside), ..self }
    }

    /// Takes the scenes on the second paper, with the names of their figures.
    pub fn take_pictures(&mut self) -> Vec<(String, Scene)> {
        std::mem::take(&mut self.pictures)
    }

    /// Adds a figure, if it is wanted: what it shows, of what load and pass.
    pub(super) fn add<F: Figure>(
        &mut self,
        name: &str,
        title: &str,
        of: &str,
        figure: impl FnOnce() -> Result<F>,
    ) -> Result {
        let is_wanted = self.wants(name);
        let beside = self.beside.filter(|(_, names)| names.contains(&name)).map(|(paper, _)| paper);
        if !is_wanted && beside.is_none() {
            return Ok(());
        }
        self.check_interrupted()?;
        let (figure, caption) = (figure()?, self.caption(title, of));
        if is_wanted {
            let scene = draw::captioned(&figure, &caption, &self.wanted.paper);
            let path = self.folder.join(format!("{name}.{}", self.wanted.paper.format.extension()));
            self.drawings.push((path, Drawing::Still(scene)));
        }
        if let Some(paper) = beside {
            self.pictures.push((name.to_owned(), draw::captioned(&figure, &caption, &paper)));
        }
        Ok(())
    }

    /// Adds curves, if they are wanted.
    pub(super) fn add_curves(&mut self, curves: Curves, of: &str) -> Result {
        let Curves { name, title, charts, .. } = curves;
        self.add(name, &title, of, || Ok(charts))
    }

    /// Adds curves that take their time, if any of these names is wanted.
    pub(super) fn add_dear(
        &mut self,
        names: &[&str],
        of: &str,
        curves: impl FnOnce() -> Result<Vec<Curves>>,
    ) -> Result {
        let only = &self.wanted.only;
        if only.is_empty() || only.iter().any(|wanted| names.contains(&wanted.as_str())) {
            return curves()?.into_iter().try_for_each(|curves| self.add_curves(curves, of));
        }
        self.names.extend(names.iter().map(|name| (*name).to_owned()));
        Ok(())
    }

    /// Adds an animation, if it is wanted, whose frames differ in a map of `colours`: as a GIF.
    pub(super) fn animate<F: Figure>(
        &mut self,
        name: &str,
        title: &str,
        colours: Colours,
        frames: impl FnOnce() -> Result<Vec<(String, F)>>,
    ) -> Result {
        let name = format!("{name}.gif");
        if !self.wants(&name) {
            return Ok(());
        }
        self.check_interrupted()?;
        let paper = Paper { format: Format::Png, dpi: 100.0, ..self.wanted.paper };
        let frames = frames()?.into_iter().map(|(of, figure)| (figure, self.caption(title, &of)));
        let scenes = draw::captioned_alike(&frames.collect::<Vec<_>>(), &paper);
        self.drawings.push((self.folder.join(name), Drawing::Moving(scenes, colours)));
        Ok(())
    }

    /// Names of all figures of the results, whether they are wanted or not.
    pub fn names(&self) -> &[String] {
        &self.names
    }

    /// All that do not move as PNG files, with their names.
    pub fn pictures(self) -> Result<Vec<(String, Vec<u8>)>> {
        let dpi = self.wanted.paper.dpi;
        let still = self.drawings.iter().filter_map(|(path, drawing)| match drawing {
            Drawing::Still(scene) => Some((path, scene)),
            Drawing::Moving(..) => None,
        });
        let picture = |(path, scene): (&PathBuf, &Scene)| {
            let name = path.file_stem().unwrap_or_default().to_string_lossy().into_owned();
            let failed = |source| draw::Error { path: path.clone(), source };
            Ok((name, draw::picture(scene, dpi).map_err(failed)?))
        };
        still.map(picture).collect()
    }

    /// Writes all figures and returns their paths.
    pub fn finish(self) -> Result<Vec<PathBuf>> {
        if let Some(unknown) = self.wanted.only.iter().find(|name| !self.names.contains(name)) {
            let hint = format!("there are {}", self.names.join(", "));
            return Err(Error::missing(format!("no figure `{unknown}` of these results"), Some(&hint)));
        }
        let existing = self.drawings.iter().map(|(path, _)| path).find(|path| fs::exists(path));
        if let Some(path) = existing.filter(|_| self.wanted.keep) {
            return Err(Error::missing(
                format!("`{}` exists", path.display()),
                Some("--overwrite replaces the figures that are there"),
            ));
        }
        let made = fs::create_dir_all(&self.folder);
        made.map_err(|source| asperity_base::Error::File { path: self.folder.clone(), source })?;
        io::sweep(&self.folder);
        let paper = &self.wanted.paper;
        let write = |(path, drawing): &(PathBuf, Drawing)| {
            self.check_interrupted()?;
            match drawing {
                Drawing::Still(scene) => draw::write_scene(path, scene, paper),
                Drawing::Moving(frames, colours) => draw::animation(path, frames, *colours, DELAY),
            }
        };
        let written: Vec<draw::Result<()>> = self.drawings.par_iter().map(write).collect();
        // Of several that cannot be written the first is named.
        written.into_iter().collect::<draw::Result<()>>()?;
        Ok(self.drawings.into_iter().map(|(path, _)| path).collect())
    }

    /// An error of the kind `Interrupted` once no more figures are wanted.
    fn check_interrupted(&self) -> draw::Result<()> {
        let interrupted = || std::io::ErrorKind::Interrupted.into();
        if (self.stop)() {
            Err(draw::Error { path: self.folder.clone(), source: interrupted() })
        } else {
            Ok(())
        }
    }

    /// Whether a figure is wanted; its name is one of those that could be.
    fn wants(&mut self, name: &str) -> bool {
        self.names.push(name.to_owned());
        self.wanted.only.is_empty() || self.wanted.only.iter().any(|wanted| wanted == name)
    }

    fn caption(&self, title: &str, of: &str) -> Caption {
        let parts: Vec<&str> = [self.case.as_str(), of].into_iter().filter(|part| !part.is_empty()).collect();
        Caption { title: title.to_owned(), of: parts.join(" · ") }
    }
}
