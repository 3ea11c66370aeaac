//! The Contact-Mechanics Challenge, on a grid of any size.
//!
//! # Problem
//!
//! Müser et al., Tribol. Lett. 65, 118 (2017), asked many groups for the same contact: an elastic body on a
//! rough rigid surface that attracts it. Which area touches, how wide is the gap, and how large are the
//! pressures and the patches in contact?
//!
//! # Mathematics
//!
//! ```text
//! E* = 25 MPa,  w = 50 mJ/m²,  σ = (w/ϱ) e^(−g/ϱ),  ϱ = 2.071 nm,  p̄ = 250 kPa
//! periodic, 100 µm wide; self-affine, Hurst exponent 0.8, waves from 20 µm to 0.1 µm, rms slope 1
//! ```
//!
//! A grid has no waves shorter than four cells here. Without them the rms slope is below 1, so that the
//! spectrum is the same on all grids. From 4096² on, all waves are present.
//!
//! # Program
//!
//! `cargo run --release -p asperity --example contact_challenge -- CELLS SEED RANGE [WIDTH_UM [LOADS]]`
//!
//! RANGE is `none`, `true`, `grid` or a length in nanometres. LOADS are mean pressures over 250 kPa,
//! separated by commas. Each load goes on from the one before.
//!
//! # Result
//!
//! A line of JSON for each load, and the distributions at 250 kPa. docs/challenge.md has the numbers.
#![expect(clippy::print_stdout, reason = "an example prints its result")]

use std::time::Instant;

use asperity::adhesion::Adhesion;
use asperity::operator::PeriodicFft;
use asperity::solver::{Bounds, Control, Params, Solution, solve_adhesive, solve_normal};
use asperity::surface::{Amplitude, SelfAffine};
use asperity::{CellValues, Field, Grid};
use serde_json::{Value, json};

const MODULUS: f64 = 25e6;
const WORK: f64 = 0.05;
const RANGE: f64 = 2.071e-9;
const MEAN_PRESSURE: f64 = 250e3;
const HURST: f64 = 0.8;
const ROLL_OFF: f64 = 20e-6;
const SHORTEST: f64 = 0.1e-6;
/// Cells of the shortest wave, at least.
const WAVE_CELLS: f64 = 4.0;

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let arguments: Vec<String> = std::env::args().skip(1).collect();
    let of = |n: usize, default: &str| arguments.get(n).map_or(default, String::as_str).to_owned();
    let cells: usize = of(0, "512").parse()?;
    let seed: u64 = of(1, "1").parse()?;
    let range = of(2, "grid");
    let width = 1e-6 * of(3, "100").parse::<f64>()?;
    let loads = of(4, "0.02,0.05,0.1,0.2,0.5,1,2,5");
    let loads = loads.split(',').map(str::parse).collect::<Result<Vec<f64>, _>>()?;

    let pitch = width / cells as f64;
    let grid = Grid::new([cells, cells], [pitch, pitch])?;
    let shortest = SHORTEST.max(WAVE_CELLS * pitch);
    let slope = (mean_square_slope(width, shortest) / mean_square_slope(100e-6, SHORTEST)).sqrt();
    let roughness = SelfAffine {
        hurst: HURST,
        rolloff: (width > ROLL_OFF).then_some(ROLL_OFF),
        shortest: Some(shortest),
        amplitude: Amplitude::Sdq(slope),
    };
    let heights = roughness.generate(&grid, seed)?.into_heights();
    let summit = heights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let gap = heights.mapv_into(|z| summit - z);
    let adhesion = match range.as_str() {
        "none" => None,
        "true" => Some(Adhesion::new(WORK, RANGE)?),
        "grid" => Some(Adhesion::new(WORK, Adhesion::grid_range(WORK, MODULUS, pitch))?),
        length => Some(Adhesion::new(WORK, 1e-9 * length.parse::<f64>()?)?),
    };
    let zone = adhesion.map_or(0.0, |adhesion| adhesion.process_zone(MODULUS) / pitch);
    let head = json!({
        "cells": cells, "seed": seed, "range": range, "width": width, "pitch": pitch, "shortest": shortest, "slope": slope,
        "range_nm": adhesion.map(|adhesion| 1e9 * adhesion.range), "process_zone_cells": zone,
    });
    println!("{head}");

    let mut operator = PeriodicFft::new(grid, MODULUS);
    let params = Params::default();
    let mut last: Option<Solution> = None;
    for load in loads {
        let begin = Instant::now();
        let control = Control::Load(load * MEAN_PRESSURE * grid.area());
        let solution = match &adhesion {
            Some(adhesion) => {
                let elastic = CellValues::Uniform(f64::INFINITY);
                solve_adhesive(&mut operator, &gap, adhesion, &elastic, control, last.as_ref(), &params)?
            }
            None => {
                let start = last.as_ref().map(|last| &last.pressure);
                solve_normal(&mut operator, &gap, &Bounds::ELASTIC, control, start, &params)?
            }
        };
        let mut row = state(&solution, load);
        row["seconds"] = json!(begin.elapsed().as_secs_f64());
        println!("{row}");
        if load == 1.0 {
            println!("{}", distributions(&solution));
        }
        last = Some(solution);
    }
    Ok(())
}

/// Mean square slope of the waves up to a width, over that of a reference amplitude: ∫ q³ C(q) dq, with C
/// constant for waves longer than the roll-off.
fn mean_square_slope(width: f64, shortest: f64) -> f64 {
    let wave = |length: f64| std::f64::consts::TAU / length;
    let [longest, roll_off, shortest] = [width, ROLL_OFF, shortest].map(wave);
    let power = 2.0 - 2.0 * HURST;
    let flat = if longest < roll_off { (roll_off.powi(4) - longest.powi(4)) / 4.0 } else { 0.0 };
    let from = longest.max(roll_off);
    flat + roll_off.powf(2.0 + 2.0 * HURST) * (shortest.powf(power) - from.powf(power)) / power
}

fn state(solution: &Solution, load: f64) -> Value {
    let cells = solution.pressure.len() as f64;
    json!({
        "load": load,
        "mean_pressure": solution.pressure.sum() / cells,
        "contact_fraction": solution.contact_cells() as f64 / cells,
        "mean_gap": solution.gap().mean(),
        "approach": solution.approach,
        "convolutions": solution.stats.convolutions,
        "residual": solution.residual,
    })
}

/// Densities of the pressure in contact, of the gap outside, and of the area of a patch in contact.
fn distributions(solution: &Solution) -> Value {
    let touches: Vec<bool> =
        solution.pressure.iter().enumerate().map(|(cell, p)| solution.bounds.touches(cell, *p)).collect();
    let gap = solution.gap();
    let cells = touches.len() as f64;
    let pressures = solution.pressure.iter().zip(&touches).filter(|(_, touches)| **touches);
    let pressures = histogram(pressures.map(|(p, _)| p / MODULUS), &steps(-1.0, 2.0, 0.1), cells);
    let gaps = gap.iter().zip(&touches).filter(|(_, touches)| !**touches).map(|(g, _)| g * 1e6);
    let gaps = histogram(gaps, &powers(-3.0, 1.0, 0.25), cells);
    let patches = patches(&touches, &gap);
    let count = patches.len() as f64;
    let area = solution.grid.cell_area() * 1e12;
    let largest = patches.iter().copied().max().unwrap_or(0) as f64 * area;
    let sizes = histogram(patches.iter().map(|cells| *cells as f64 * area), &powers(-4.0, 3.0, 0.5), count);
    json!({
        "pressure_over_modulus": pressures, "gap_um": gaps, "patch_area_um2": sizes, "patches": count, "largest_patch_um2": largest,
    })
}

fn steps(from: f64, to: f64, step: f64) -> Vec<f64> {
    let count = ((to - from) / step).round() as i32;
    (0..=count).map(|n| from + f64::from(n) * step).collect()
}

fn powers(from: f64, to: f64, step: f64) -> Vec<f64> {
    steps(from, to, step).into_iter().map(|power| 10f64.powf(power)).collect()
}

/// Returns the density of values between each pair of edges: the lower edge, the upper edge, and the share of
/// `all` over the width.
fn histogram(values: impl Iterator<Item = f64>, edges: &[f64], all: f64) -> Vec<[f64; 3]> {
    let mut counts = vec![0.0; edges.len() - 1];
    for value in values {
        let above = edges.partition_point(|edge| *edge <= value);
        if (1..edges.len()).contains(&above) {
            counts[above - 1] += 1.0;
        }
    }
    let bins = edges.windows(2).zip(counts);
    bins.map(|(edges, count)| [edges[0], edges[1], count / all / (edges[1] - edges[0])]).collect()
}

/// Returns the number of cells of each patch of touching cells that share an edge, on a periodic grid.
fn patches(touches: &[bool], gap: &Field) -> Vec<usize> {
    let [nx, ny] = [gap.nrows(), gap.ncols()];
    let mut seen = vec![false; touches.len()];
    let mut sizes = Vec::new();
    let mut left = Vec::new();
    for first in 0..touches.len() {
        if !touches[first] || seen[first] {
            continue;
        }
        seen[first] = true;
        left.push(first);
        let mut size = 0;
        while let Some(cell) = left.pop() {
            size += 1;
            let (i, j) = (cell / ny, cell % ny);
            let neighbours =
                [((i + 1) % nx, j), ((i + nx - 1) % nx, j), (i, (j + 1) % ny), (i, (j + ny - 1) % ny)];
            for (i, j) in neighbours {
                let cell = i * ny + j;
                if touches[cell] && !seen[cell] {
                    seen[cell] = true;
                    left.push(cell);
                }
            }
        }
        sizes.push(size);
    }
    sizes
}
