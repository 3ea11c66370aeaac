//! `asperity paper`: the figures of the paper with this method, and its claim on cost.
//!
//! Ghanbarzadeh, Wilson, Morina, Dowson, Neville, *A new strategy for the relative movement of rough surfaces
//! in contact using a boundary element method*. Figures 3 to 7 are sketches.

mod cost;
mod figures;

use std::path::Path;

use asperity::io;
use asperity::material::Material;
use asperity::motion::Pair;
use asperity::surface::{LowPass, Topography};
use asperity::units::{Metre, Pascal};
use asperity::{Grid, Result};
use indicatif::{ProgressBar, ProgressDrawTarget, ProgressStyle};

use crate::args::Paper;
use crate::report::{Failure, Outcome, note, print};
use asperity_report::draw::Format;
use cost::Costs;

/// The paper's cells: squares of 1 µm.
const PITCH: Metre = 1e-6;
/// Rms height of the surfaces. The paper does not give this value or the following ones.
const SQ: Metre = 50e-9;
/// Shortest wave of the surfaces, m.
const CUTOFF: Metre = 12e-6;
/// Young's modulus of both bodies, Pa.
const YOUNG: Pascal = 210e9;
/// Poisson's ratio of both bodies.
const POISSON: f64 = 0.3;
/// Hardness of both bodies, Pa.
const HARDNESS: Pascal = 3e9;

/// Draws the paper's figures, and measures the cost of its strategy.
pub(crate) fn paper(arguments: &Paper) -> Outcome {
    let folder = &arguments.out;
    let sheets = arguments.drawing.papers();
    sheets.iter().try_for_each(|sheet| refuse_existing(folder, sheet.format, arguments.overwrite))?;
    std::fs::create_dir_all(folder)
        .map_err(|source| asperity::Error::File { path: folder.clone(), source })?;
    io::sweep(folder);
    let bar = progress(arguments.quiet);
    sheets.iter().try_for_each(|sheet| figures::draw(folder, sheet, &bar))?;
    let costs = Costs::measure(arguments.largest.into(), &bar)?;
    bar.finish_and_clear();
    for sheet in &sheets {
        costs.draw(&folder.join("cost").with_extension(sheet.format.extension()), sheet)?;
    }
    io::replace(&folder.join("cost.csv"), costs.csv().as_bytes())?;
    print(&format!("{}\n{}\n{}", figures::matrix_sizes(), costs.table(), costs.verdict()))?;
    note(&format!("figures and cost.csv in {}", folder.display()));
    Ok(())
}

/// Returns an error if a file to be written exists.
fn refuse_existing(folder: &Path, format: Format, overwrite: bool) -> Outcome {
    let names = figures::NAMES.into_iter().chain(["cost"]);
    let files = names.map(|name| format!("{name}.{}", format.extension()));
    let mut files = files.chain(["cost.csv".to_owned()]).map(|file| folder.join(file));
    match files.find(|path| path.exists()).filter(|_| !overwrite) {
        Some(path) => {
            let hint = "--overwrite replaces the figures, --out names another folder";
            Err(Failure::usage(format!("`{}` exists", path.display()), Some(hint)))
        }
        None => Ok(()),
    }
}

/// Creates a progress bar on stderr.
fn progress(quiet: bool) -> ProgressBar {
    let target = if quiet { ProgressDrawTarget::hidden() } else { ProgressDrawTarget::stderr() };
    let style = ProgressStyle::with_template("{spinner} {msg}").expect("a valid template");
    ProgressBar::with_draw_target(None, target).with_style(style)
}

/// Generates a low-pass surface of `side` × `side` cells.
fn surface(side: usize, seed: u64) -> Result<Topography> {
    LowPass::new(SQ, [CUTOFF; 2]).generate(&Grid::new([side; 2], [PITCH; 2])?, seed)
}

/// Generates two opposing surfaces of `side` × `side` cells.
fn pair(side: usize) -> Result<Pair> {
    let steel = Material::new(YOUNG, POISSON, HARDNESS)?;
    Pair::new(surface(side, 11)?, surface(side, 12)?.underside(), [&steel, &steel])
}
