//! The paper's figures 1, 2, 8, 9 and 10 with their numbers, and two more.

use std::path::Path;

use asperity::grid::Grid;
use asperity::kernel::{influence_matrix, influence_table};
use asperity::motion::{
    Contact, LoadControl, Motion, Output, Pair, PlasticUpdate, Simulation, Step, Strategy,
};
use asperity::operator::Boundary;
use asperity::solver::{Control, Params};
use asperity::surface::LowPass;
use asperity::units::{Dimension, Pascal, format};
use asperity::{Field, Result};
use indicatif::ProgressBar;
use ndarray::s;

use super::{CUTOFF, PITCH, SQ, pair};
use crate::report::Outcome;
use asperity_report::draw::{
    self, Caption, Colours, Figure, Map, Maps, Paper as Sheet, Quantity, Relief, Unit,
};
use asperity_report::figures::in_frame_of;
use asperity_report::words::numbers::in_column;

/// Cells of the surfaces along each side.
const SIDE: usize = 100;
/// Cells along a side of the surface whose influence matrix is shown, as in the paper.
const MATRIX_SIDE: usize = 20;
/// Number of coefficients of the filter on each side of the middle: two cut-off wavelengths.
const REACH: usize = 24;
/// Height of a single peak over the side of its base.
const PEAK: f64 = 0.45;
/// Points along a cell of figure 9, odd, so that one is its middle.
const FINER: usize = 5;
/// Pressure on the central cell of figure 9.
const PRESSURE: Pascal = 1e9;
/// Mean load of a pass, N.
const LOAD: f64 = 0.6;
/// Passes of the sliding bodies.
const PASSES: usize = 3;

/// Names of the figures' files.
pub(super) const NAMES: [&str; 7] =
    ["figure-1", "figure-2", "figure-8", "figure-9", "figure-10", "two-surfaces", "plastic-depth"];

/// Draws all of [`NAMES`] into `folder`.
pub(super) fn draw(folder: &Path, sheet: &Sheet, bar: &ProgressBar) -> Outcome {
    let save = |name: &str, title: &str, of: String, figure: &dyn Figure| -> Outcome {
        let caption = Caption { title: title.to_owned(), of };
        let path = folder.join(name).with_extension(sheet.format.extension());
        Ok(draw::save(&path, figure, &caption, sheet)?)
    };
    bar.set_message("figures 1, 2, 8, 9");
    let pair = pair(SIDE)?;
    filter_coefficients(&save)?;
    generated_surface(&pair, &save)?;
    matrix(&pair, &save)?;
    displacement(&pair, &save)?;
    two_surfaces(&pair, &save)?;
    let passes = passes(pair.clone(), bar)?;
    pressures(&pair, &passes[0], &save)?;
    plastic_depths(&pair, &passes, &save)
}

/// Saves a figure with its name, its title and its subject.
type Save<'s> = dyn Fn(&str, &str, String, &dyn Figure) -> Outcome + 's;

fn filter_coefficients(save: &Save) -> Outcome {
    let coefficients = LowPass::new(SQ, [CUTOFF; 2]).coefficients([PITCH; 2], [REACH; 2]);
    let ends = [-(REACH as f64), REACH as f64];
    let relief = Relief {
        field: &coefficients,
        ends: [ends; 2],
        names: ["k", "l"],
        unit: Unit::Count,
        quantity: Quantity::new("h(k, l)", Unit::Number),
        range: Some([coefficients.iter().copied().fold(0.0, f64::min), 0.025]),
        rise: PEAK,
    };
    let of = format!("cut-off wavelength {} cells: h(0, 0) = π/{0}²", CUTOFF / PITCH);
    save("figure-1", "Figure 1. Coefficients of the circular low-pass filter", of, &relief)
}

fn generated_surface(pair: &Pair, save: &Save) -> Outcome {
    let of = format!(
        "{SIDE} × {SIDE} cells of {}, Sq {}, no wave shorter than {}",
        format(PITCH, Dimension::Length),
        format(SQ, Dimension::Length),
        format(CUTOFF, Dimension::Length)
    );
    let relief = Relief::of_heights(&pair.lower.heights, &pair.lower_grid());
    save("figure-2", "Figure 2. Rough surface: random numbers through the filter", of, &relief)
}

/// Draws the influence matrix; the matrix of an overlap is its leading block.
fn matrix(pair: &Pair, save: &Save) -> Outcome {
    let matrix = influence_matrix([MATRIX_SIDE; 2], pair.pitch(), pair.modulus());
    let quantity = || Quantity::new("influence", Unit::Of("m/Pa"));
    let axes = ["displaced cell", "loaded cell"];
    let first = matrix.slice(s![..MATRIX_SIDE, ..MATRIX_SIDE]).to_owned();
    let range = [&matrix, &first].map(|matrix| matrix.iter().copied());
    let [low, high] =
        range.into_iter().flatten().fold([f64::INFINITY, 0.0], |[low, high], v| [v.min(low), v.max(high)]);
    let block = format!("one column overlaps: the first {MATRIX_SIDE} × {MATRIX_SIDE}, in the second map");
    let maps = vec![
        Map::matrix("all columns overlap", &matrix, axes, quantity())
            .with_block(MATRIX_SIDE, block)
            .range([low, high]),
        Map::matrix("one column overlaps", &first, axes, quantity()).range([low, high]),
    ];
    let cells = MATRIX_SIDE * MATRIX_SIDE;
    let of = format!(
        "{MATRIX_SIDE} × {MATRIX_SIDE} cells of 1 µm: {cells} × {cells} coefficients, cells numbered column by column"
    );
    save("figure-8", "Figure 8. Influence matrix", of, &Maps::new(maps))
}

/// Draws the displacement under a load on the central cell. A central cell requires an odd number of cells.
fn displacement(pair: &Pair, save: &Save) -> Outcome {
    let side = MATRIX_SIDE + 1;
    let points = side * FINER;
    let middle = points / 2;
    let fine = PITCH / FINER as f64;
    let half = FINER / 2;
    let influence = influence_table([middle + half + 1; 2], [fine; 2], pair.modulus());
    // The cell is a square of finer ones under the same pressure.
    let loaded =
        || (middle - half..=middle + half).flat_map(|a| (middle - half..=middle + half).map(move |b| (a, b)));
    let field = Field::from_shape_fn([points; 2], |(i, j)| {
        loaded().map(|(a, b)| PRESSURE * influence[[i.abs_diff(a), j.abs_diff(b)]]).sum()
    });
    let grid = Grid::new([points; 2], [fine; 2])?;
    let quantity = Quantity::new("displacement", Unit::Length);
    let relief =
        Relief { quantity, range: Some([0.0, 10e-9]), rise: PEAK, ..Relief::of_heights(&field, &grid) };
    let of = format!(
        "{side} × {side} cells of 1 µm, {} on the central one; displacement into the body, drawn upwards",
        format(PRESSURE, Dimension::Pressure)
    );
    save("figure-9", "Figure 9. Displacement of the surface under a load on its central cell", of, &relief)
}

fn two_surfaces(pair: &Pair, save: &Save) -> Outcome {
    let grid = pair.lower_grid();
    let gap = pair.initial_gap(&pair.at_rest());
    let gap = &gap - gap.iter().copied().fold(f64::INFINITY, f64::min);
    let heights = |title, field| map(title, field, &grid, "height", Unit::Length, Colours::Heights);
    let maps = vec![
        heights("lower surface", &pair.lower.heights),
        heights("upper surface, underside", &pair.upper.heights),
        map("gap at first touch", &gap, &grid, "gap", Unit::Length, Colours::Heights),
    ];
    save("two-surfaces", "Two surfaces and the gap between them", String::new(), &Maps::new(maps))
}

fn map<'a>(title: &str, field: &'a Field, grid: &Grid, name: &str, unit: Unit, colours: Colours) -> Map<'a> {
    Map::new(title, field, grid, Quantity::new(name, unit), colours)
}

/// The contacts of a pass, and the bodies after it.
struct Pass {
    contacts: Vec<Contact>,
    pair: Pair,
}

struct PassCollector(Vec<Pass>);

impl Output for PassCollector {
    fn step(&mut self, step: &Step<'_>) -> Result<()> {
        let Some(report) = step.pass() else { return Ok(()) };
        self.0.push(Pass { contacts: report.contacts.to_vec(), pair: report.pair.clone() });
        Ok(())
    }
}

fn passes(pair: Pair, bar: &ProgressBar) -> Result<Vec<Pass>> {
    let motion = Motion::new(Strategy::Overlap, Control::Load(LOAD))
        .with_passes(PASSES)
        .with_stride(1)
        .with_load_control(LoadControl::Pass)
        .with_plastic_update(PlasticUpdate::Pass)
        .with_load_tolerance(1e-4)
        .with_friction(None);
    bar.set_message(format!("figure 10: {PASSES} passes of {} positions", 2 * SIDE - 1));
    let mut kept = PassCollector(Vec::new());
    Simulation::new(pair, Boundary::FREE, motion, Params::default())?.run(&(), &mut [&mut kept])?;
    Ok(kept.0)
}

/// Draws the pressures while the upper surface enters from the left, covers the lower one and leaves to the
/// right.
fn pressures(pair: &Pair, pass: &Pass, save: &Save) -> Outcome {
    let grid = pair.lower_grid();
    let shown = [("a", 1), ("b", 2), ("c", 3), ("d", 4), ("e", 5), ("f", 6)]
        .map(|(letter, quarters)| (letter, &pass.contacts[quarters * SIDE / 4 - 1]));
    let largest = shown.iter().map(|(_, c)| c.max_pressure()).fold(f64::MIN_POSITIVE, f64::max);
    let fields: Vec<Field> = shown
        .iter()
        .map(|(_, contact)| in_frame_of(&contact.pressure_field(SIDE), contact.position.lower, grid))
        .collect();
    let maps = shown
        .iter()
        .zip(&fields)
        .map(|((letter, contact), field)| {
            let stage = match contact.position.offset {
                0.0 => "full overlap",
                offset if offset < 0.0 => "entering",
                _ => "leaving",
            };
            let title = format!("({letter}) {stage}, {} mN", in_column(contact.load / 1e-3));
            map(&title, field, &grid, "pressure", Unit::Pressure, Colours::Pressure)
                .range([0.0, largest])
                .missing("outside the overlap")
                .blank("no contact")
        })
        .collect();
    let of = format!("one approach for all positions; mean load {}", format(LOAD, Dimension::Force));
    save("figure-10", "Figure 10. Pressure on the lower body as the upper one passes", of, &Maps::new(maps))
}

fn plastic_depths(initial: &Pair, passes: &[Pass], save: &Save) -> Outcome {
    let grid = initial.lower_grid();
    let depths: Vec<(String, Field)> = [0, passes.len() - 1]
        .into_iter()
        .flat_map(|pass| {
            let pair = &passes[pass].pair;
            [
                (format!("lower surface, pass {}", pass + 1), &pair.lower.heights - &initial.lower.heights),
                (format!("upper surface, pass {}", pass + 1), &initial.upper.heights - &pair.upper.heights),
            ]
        })
        .collect();
    let sizes = depths.iter().flat_map(|(_, change)| change.iter()).map(|change| change.abs());
    let largest = sizes.fold(f64::MIN_POSITIVE, f64::max);
    let maps = depths
        .iter()
        .map(|(title, change)| {
            let map = map(title, change, &grid, "change of height", Unit::Length, Colours::Signed);
            map.range([-largest, largest])
        })
        .collect();
    save(
        "plastic-depth",
        "Change of height by plastic flow, material upwards",
        String::new(),
        &Maps::new(maps),
    )
}

/// Returns a table of the size of the influence matrix over a pass.
pub(super) fn matrix_sizes() -> String {
    let mut text = format!(
        "influence matrix over a pass of {SIDE} × {SIDE} cells\n{:>10}{:>10}{:>8}{:>13}\n",
        "position", "columns", "rows", "memory, GB"
    );
    for k in
        [1, SIDE / 4, SIDE / 2, 3 * SIDE / 4, SIDE, 5 * SIDE / 4, 3 * SIDE / 2, 7 * SIDE / 4, 2 * SIDE - 1]
    {
        let columns = SIDE - k.abs_diff(SIDE);
        let rows = columns * SIDE;
        let gigabytes = (rows * rows * 8) as f64 / 1e9;
        text.push_str(&format!("{k:>10}{columns:>10}{rows:>8}{gigabytes:>13.4}\n"));
    }
    text
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_figure_is_drawn_under_its_number() {
        let folder = tempfile::tempdir().unwrap();
        draw(folder.path(), &Sheet::default(), &ProgressBar::hidden()).unwrap();
        for name in NAMES {
            assert!(folder.path().join(format!("{name}.png")).is_file(), "{name}");
        }
        assert_eq!(std::fs::read_dir(folder.path()).unwrap().count(), NAMES.len());
    }

    #[test]
    fn the_passes_of_figure_10_bear_their_load_and_cover_all_at_d() {
        let passes = passes(pair(SIDE).unwrap(), &ProgressBar::hidden()).unwrap();
        for pass in &passes {
            let mean = pass.contacts.iter().map(|c| c.load).sum::<f64>() / pass.contacts.len() as f64;
            assert!((mean / LOAD - 1.0).abs() < 1e-3, "{mean}");
        }
        let [a, d, f] = [1, 4, 6].map(|quarters| &passes[0].contacts[quarters * SIDE / 4 - 1].position);
        assert_eq!([a.columns, d.columns, f.columns], [25, 100, 50]);
        assert_eq!([a.lower, a.upper, f.lower], [0, 75, 50]);
    }

    #[test]
    fn matrix_sizes_are_those_of_the_paper() {
        let text = matrix_sizes();
        assert!(text.contains("       100       100   10000       0.8000"), "{text}");
    }
}
