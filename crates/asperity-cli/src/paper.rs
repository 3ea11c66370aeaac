//! `asperity paper`: the figures of the paper whose method this is, and its claim on cost.
//!
//! Ghanbarzadeh, Wilson, Morina, Dowson, Neville, *A new strategy for the relative movement of rough surfaces in
//! contact using a boundary element method*. Figures 3 to 7 are sketches.

use std::path::Path;
use std::time::Instant;

use asperity::io::atomic;
use asperity::kernel::influence_matrix;
use asperity::material::Material;
use asperity::motion::{
    Contact, Control, Motion, Output, Pair, PassReport, PlasticUpdate, Simulation, Strategy,
};
use asperity::operator::{Boundary, Operators};
use asperity::solver::{Method, Params, solve_normal};
use asperity::surface::{LowPass, Topography};
use asperity::units::{Dimension, Metre, format};
use asperity::{Field, Grid, solver};

use crate::args::Paper;
use crate::draw::{
    self, Axis, Caption, Chart, Charts, Colours, Figure, Map, Maps, Mark, Paper as Sheet, Quantity, Series,
    Unit,
};
use crate::figures::in_frame_of;
use crate::report::{Outcome, note, print};

/// Cells of the paper's surfaces along each side.
const N: usize = 100;
const PITCH: Metre = 1e-6;
const SQ: Metre = 50e-9;
const PASSES: usize = 3;

/// Draws figures 1, 2, 8, 9 and 10 and prints the table of cost.
pub(crate) fn paper(arguments: &Paper) -> Outcome {
    let directory = &arguments.out;
    std::fs::create_dir_all(directory)
        .map_err(|source| asperity::Error::File { path: directory.clone(), source })?;
    atomic::sweep(directory);
    let at = |name: &str| directory.join(name);
    low_pass_surfaces(&at("figure-1.png"))?;
    let pair = pair(N)?;
    two_surfaces(&pair, &at("figure-2.png"))?;
    influence_matrices(&pair, &at("figure-8.png"))?;
    let passes = run_in(pair.clone())?;
    pressures(&pair, &passes, &at("figure-9.png"))?;
    plastic_deformation(&pair, &passes, &at("figure-10.png"))?;
    note(&format!("figures 1, 2, 8, 9 and 10 in {}", directory.display()));
    print(&matrix_sizes())?;
    let costs = Costs::measure(arguments.largest)?;
    print(&costs.table())?;
    costs.draw(&at("cost.png"))
}

fn steel() -> asperity::Result<Material> {
    Material::new(210e9, 0.3, 3e9)
}

/// A low-pass surface of n × n cells.
fn surface(n: usize, cutoff: Metre, seed: u64) -> asperity::Result<Topography> {
    LowPass::new(SQ, [cutoff; 2]).generate(&Grid::new([n, n], [PITCH; 2])?, seed)
}

fn pair(n: usize) -> asperity::Result<Pair> {
    let steel = steel()?;
    Pair::new(surface(n, 12.0 * PITCH, 11)?, surface(n, 12.0 * PITCH, 12)?.underside(), [&steel, &steel])
}

fn map<'a>(title: &str, field: &'a Field, grid: &Grid, name: &str, unit: Unit, colours: Colours) -> Map<'a> {
    Map::new(title, field, grid, Quantity::new(name, unit), colours)
}

fn save(path: &Path, title: &str, figure: &dyn Figure) -> Outcome {
    let caption = Caption { title: title.to_owned(), of: String::new() };
    Ok(draw::save(path, figure, &caption, &Sheet::default())?)
}

/// Figure 1: the same noise through circular low-pass filters of falling cut-off frequency.
fn low_pass_surfaces(path: &Path) -> Outcome {
    let cutoffs = [4.0, 8.0, 16.0, 32.0];
    let surfaces: Vec<Topography> =
        cutoffs.iter().map(|cells| surface(N, cells * PITCH, 7)).collect::<asperity::Result<_>>()?;
    let maps: Vec<Map> = surfaces
        .iter()
        .zip(cutoffs)
        .map(|(surface, cells)| {
            let title = format!("shortest wave {}", format(cells * PITCH, Dimension::Length));
            map(&title, surface.heights(), surface.grid(), "height", Unit::Length, Colours::Heights)
        })
        .collect();
    save(path, "low-pass surfaces of one noise", &Maps::new(maps))
}

/// Figure 2: the two surfaces that meet, and the gap between them where all faces all.
fn two_surfaces(pair: &Pair, path: &Path) -> Outcome {
    let grid = pair.lower_grid();
    let gap = &pair.upper - &pair.lower;
    let gap = &gap - gap.iter().copied().fold(f64::INFINITY, f64::min);
    let heights = |title, field| map(title, field, &grid, "height", Unit::Length, Colours::Heights);
    let maps = vec![
        heights("lower surface", &pair.lower),
        heights("upper surface, underside", &pair.upper),
        map("gap at first touch", &gap, &grid, "gap", Unit::Length, Colours::Heights),
    ];
    save(path, "two surfaces and the gap between them", &Maps::new(maps))
}

/// Figure 8: the influence matrix of an overlap is the leading block of the full one.
fn influence_matrices(pair: &Pair, path: &Path) -> Outcome {
    let side = 12;
    let matrix = influence_matrix([side; 2], pair.pitch(), pair.modulus());
    let quantity = Quantity::new("influence", Unit::Of("m/Pa"));
    let map = Map::matrix("", &matrix, ["displaced cell", "loaded cell"], quantity);
    let map = map.with_block(side, format!("the first overlap: {side} × {side}"));
    save(path, &format!("influence matrix of {side} × {side} cells"), &Maps::new(vec![map]))
}

/// What figures 9 and 10 show of a pass.
struct Kept {
    contacts: Vec<Contact>,
    pair: Pair,
}

struct Keep(Vec<Kept>);

impl Output for Keep {
    fn pass(&mut self, report: &PassReport) -> asperity::Result<()> {
        self.0.push(Kept { contacts: report.contacts.to_vec(), pair: report.pair.clone() });
        Ok(())
    }
}

fn run_in(pair: Pair) -> asperity::Result<Vec<Kept>> {
    let motion = Motion {
        strategy: Strategy::Overlap,
        passes: PASSES,
        stride: 1,
        control: Control::PassLoad(0.6),
        plastic_update: PlasticUpdate::Pass,
        load_tolerance: 1e-4,
        friction: None,
    };
    let mut kept = Keep(Vec::new());
    Simulation::new(pair, Boundary::Free, motion, Params::default())?.run(&(), &mut [&mut kept])?;
    Ok(kept.0)
}

/// Figure 9: pressures as the upper surface enters, passes over and leaves.
fn pressures(pair: &Pair, passes: &[Kept], path: &Path) -> Outcome {
    let grid = pair.lower_grid();
    let shown = [N / 4, N / 2, 3 * N / 4, N, N + N / 4, N + N / 2].map(|k| &passes[0].contacts[k - 1]);
    let largest = shown.iter().map(|c| c.max_pressure()).fold(f64::MIN_POSITIVE, f64::max);
    let fields: Vec<Field> = shown
        .iter()
        .map(|contact| in_frame_of(&contact.pressure_field(N), contact.position.lower, grid))
        .collect();
    let maps: Vec<Map> = shown
        .iter()
        .zip(&fields)
        .map(|(contact, field)| {
            let load = format(contact.load, Dimension::Force);
            let title = format!("position {}: {load}", contact.position.offset + N as isize);
            let map = map(&title, field, &grid, "pressure", Unit::Pressure, Colours::Pressure);
            map.range([0.0, largest])
        })
        .collect();
    save(path, "pressure on the lower surface", &Maps::new(maps))
}

/// Figure 10: plastic deformation of both surfaces after the first and after the last pass.
fn plastic_deformation(initial: &Pair, passes: &[Kept], path: &Path) -> Outcome {
    let grid = initial.lower_grid();
    let depths: Vec<(String, Field)> = [0, passes.len() - 1]
        .into_iter()
        .flat_map(|pass| {
            let pair = &passes[pass].pair;
            [
                (format!("lower surface, pass {}", pass + 1), &initial.lower - &pair.lower),
                (format!("upper surface, pass {}", pass + 1), &pair.upper - &initial.upper),
            ]
        })
        .collect();
    let largest = depths.iter().flat_map(|(_, d)| d.iter()).copied().fold(f64::MIN_POSITIVE, f64::max);
    let maps: Vec<Map> = depths
        .iter()
        .map(|(title, depth)| {
            let map = map(title, depth, &grid, "plastic depth", Unit::Length, Colours::Pressure);
            map.range([0.0, largest])
        })
        .collect();
    save(path, "plastic deformation", &Maps::new(maps))
}

/// How the influence matrix grows and shrinks over a pass.
fn matrix_sizes() -> String {
    let mut text = format!(
        "\ninfluence matrix over a pass, {N} × {N} cells\n{:>10}{:>10}{:>16}{:>14}\n",
        "position", "columns", "rows", "memory"
    );
    for k in [1, N / 4, N / 2, 3 * N / 4, N, N + N / 4, N + N / 2, N + 3 * N / 4, 2 * N - 1] {
        let columns = N - k.abs_diff(N);
        let rows = columns * N;
        let gigabytes = (rows * rows * 8) as f64 / 1e9;
        text.push_str(&format!("{k:>10}{columns:>10}{rows:>16}{gigabytes:>11.4} GB\n"));
    }
    text
}

/// Seconds per position of a pass by both strategies.
struct Cost {
    method: &'static str,
    n: usize,
    overlap: f64,
    shift: f64,
}

/// What the strategies cost, one thread, one approach, frozen surfaces.
struct Costs(Vec<Cost>);

impl Costs {
    fn measure(largest: usize) -> asperity::Result<Self> {
        let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().expect("a pool of one thread");
        one.install(|| {
            let mut costs = Vec::new();
            for n in (12..=32).step_by(4) {
                costs.push(Cost::of("dense", Method::Direct, n, 1)?);
            }
            for n in [16, 32, 64, 128, 256].into_iter().filter(|n| *n <= largest) {
                // Every position costs about the same as its neighbours: a few dozen tell the mean.
                costs.push(Cost::of("FFT", Method::ActiveSet, n, (n / 32).max(1))?);
            }
            Ok(Self(costs))
        })
    }

    fn table(&self) -> String {
        let mut text = format!(
            "\ncost of a position, mean over a pass (one thread, one approach)\n{:>8}{:>6}{:>18}{:>18}{:>10}\n",
            "method", "N", "circular shift", "sub-matrices", "ratio"
        );
        for Cost { method, n, overlap, shift } in &self.0 {
            let [shift_text, overlap_text] = [shift, overlap].map(|s| format(*s, Dimension::Time));
            let ratio = shift / overlap;
            text.push_str(&format!("{method:>8}{n:>6}{shift_text:>18}{overlap_text:>18}{ratio:>10.2}\n"));
        }
        text + "theory, work ∝ columns^q: q + 1, that is 4 for dense factorisations, 2 for FFT\n"
    }

    fn draw(&self, path: &Path) -> Outcome {
        let series = |method: &str, name: &str, value: fn(&Cost) -> f64| {
            let costs = self.0.iter().filter(|cost| cost.method == method);
            Series::new(
                format!("{method}, {name}"),
                costs.map(|cost| [cost.n as f64, value(cost)]).collect(),
                Mark::LineAndPoints,
            )
        };
        let series = vec![
            series("dense", "shift", |c| c.shift),
            series("dense", "sub-matrices", |c| c.overlap),
            series("FFT", "shift", |c| c.shift),
            series("FFT", "sub-matrices", |c| c.overlap),
        ];
        let x = Axis::log("cells along a side", Unit::Number);
        let chart = Chart::new("", x, Axis::log("time", Unit::Time), series);
        save(path, "cost of a position, mean over a pass", &Charts::from(chart))
    }
}

impl Cost {
    fn of(method: &'static str, solver: Method, n: usize, stride: usize) -> asperity::Result<Self> {
        let pair = pair(n)?;
        let params = Params { method: solver, ..Params::default() };
        // The approach at which all over all bears a mean pressure of 1 % of the composite modulus: much contact.
        let gap = &pair.upper - &pair.lower;
        let load = solver::Control::Load(0.01 * pair.modulus() * pair.lower_grid().area());
        let mut operator = Operators::new(pair.pitch(), *pair.compliances(), Boundary::Free).on([n, n]);
        let hardness = f64::INFINITY;
        let approach = solve_normal(operator.as_mut(), &gap, hardness, load, None, &params)?.approach;
        let time = |strategy| -> asperity::Result<f64> {
            let motion = Motion {
                strategy,
                passes: 1,
                stride,
                control: Control::Approach(approach),
                plastic_update: PlasticUpdate::Pass,
                load_tolerance: 1e-4,
                friction: None,
            };
            let mut simulation = Simulation::new(pair.clone(), Boundary::Free, motion, params)?;
            let positions = simulation.positions().len() as f64;
            let began = Instant::now();
            simulation.run(&(), &mut [])?;
            Ok(began.elapsed().as_secs_f64() / positions)
        };
        Ok(Self {
            method,
            n,
            overlap: time(Strategy::Overlap)?,
            shift: time(Strategy::Shift { speed_lower: 0.0, speed_upper: 1.0 })?,
        })
    }
}
