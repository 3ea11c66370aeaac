//! A section along x through the most loaded spot: both bodies as they are pressed together, the gap, the
//! pressure.

use asperity_base::{Field, Grid};
use asperity_contact::kernel::response;
use asperity_contact::material::{Compliances, Material, plastic_share};
use asperity_contact::operator::Operators;
use asperity_study::Case;
use asperity_study::case::Hardness;
use ndarray::{Array1, ArrayView1};

use crate::draw::{Axis, Chart, Charts, Mark, Series, Unit};
use crate::error::Result;

/// Widths of the spot shown at each side of it.
const AROUND: usize = 4;
/// The least number of cells shown at each side.
const MIN_AROUND: usize = 12;

/// What faces at one position, all on one grid.
pub(super) struct OverlapFields<'a> {
    pub(super) pressure: &'a Field,
    /// Above 0 in contact.
    pub(super) touching: &'a Field,
    /// Fields along the row of the section.
    pub(super) row: Row<'a>,
    /// Elastic displacement of both bodies, positive where it opens the gap.
    pub(super) displacement: &'a Field,
    /// Whether any cell has yielded.
    pub(super) is_plastic: bool,
    pub(super) approach: f64,
    pub(super) pitch: [f64; 2],
    /// Where the grid begins on the lower body, in columns.
    pub(super) column: usize,
}

/// Fields along a row of cells.
pub(super) struct Row<'a> {
    pub(super) lower: ArrayView1<'a, f64>,
    /// The upper body's underside.
    pub(super) upper: ArrayView1<'a, f64>,
    /// Plastic interference of both bodies.
    pub(super) plastic: ArrayView1<'a, f64>,
}

/// A row of cells; pairs of x and a value.
#[derive(Debug)]
pub(super) struct Profile {
    /// Where it lies.
    y: f64,
    /// Lower and upper body before and after they deform.
    undeformed: [Vec<[f64; 2]>; 2],
    deformed: [Vec<[f64; 2]>; 2],
    gap: Vec<[f64; 2]>,
    pressure: Vec<[f64; 2]>,
}

impl Profile {
    /// The section through the cell of the largest pressure, [`most_loaded`]; none without a known approach.
    pub(super) fn through(facing: &OverlapFields, [ix, iy]: [usize; 2], case: &Case) -> Result<Option<Self>> {
        if !facing.approach.is_finite() {
            return Ok(None);
        }
        let row = facing.pressure.column(iy);
        let touching = facing.touching.column(iy);
        let first = (0..ix).rev().find(|i| touching[*i] <= 0.0).map_or(0, |i| i + 1);
        let end = (ix..row.len()).find(|i| touching[*i] <= 0.0).unwrap_or(row.len());
        let around = (AROUND * (end - first)).max(MIN_AROUND);
        let shown = first.saturating_sub(around)..(end + around).min(row.len());
        // Which body flows depends on the cell where one of them has a map of its hardness.
        let [lower, upper] = [&case.lower, &case.upper].map(|body| match body.hardness {
            Hardness::Uniform(hardness) => Some(hardness),
            Hardness::Map(_) => None,
        });
        let plastic = match (lower, upper) {
            (Some(lower), Some(upper)) => plastic_share(lower, upper),
            _ if facing.is_plastic => return Ok(None),
            _ => 0.0,
        };
        let lower_displacement = lower_displacement(facing, iy, case)?;
        let along = |value: &dyn Fn(usize) -> f64| -> Vec<[f64; 2]> {
            let x = |i: usize| ((facing.column + i) as f64 + 0.5) * facing.pitch[0];
            shown.clone().map(|i| [x(i), value(i)]).collect()
        };
        let (u, w) = (|i: usize| facing.displacement[[i, iy]], |i: usize| facing.row.plastic[i]);
        let lower_displacement = |i: usize| lower_displacement[i];
        let below = |i: usize| facing.row.lower[i];
        let above = |i: usize| facing.row.upper[i] - facing.approach;
        Ok(Some(Self {
            y: (iy as f64 + 0.5) * facing.pitch[1],
            undeformed: [along(&below), along(&above)],
            deformed: [
                along(&|i| below(i) - lower_displacement(i) - plastic * w(i)),
                along(&|i| above(i) + u(i) - lower_displacement(i) + (1.0 - plastic) * w(i)),
            ],
            // Where they touch there is none, and no rounding of one.
            gap: along(&|i| if touching[i] > 0.0 { 0.0 } else { above(i) - below(i) + u(i) + w(i) }),
            pressure: along(&|i| row[i]),
        }))
    }

    /// The bodies, the gap and the pressure, one below the other.
    pub(super) fn charts(self) -> Charts {
        let x = |label: &str| Axis::linear(label, Unit::Length);
        let length = |label: &str| Axis::linear(label, Unit::Length);
        let [lower, upper] = self.undeformed;
        let [lower_deformed, upper_deformed] = self.deformed;
        let bodies = vec![
            Series::new("lower body", lower_deformed, Mark::Line),
            Series::new("upper body", upper_deformed, Mark::Line),
            Series::new("lower body, undeformed", lower, Mark::Dashed),
            Series::new("upper body, undeformed", upper, Mark::Dashed),
        ];
        let title = format!(
            "pressed together, y = {}",
            asperity_base::units::format(self.y, asperity_base::units::Dimension::Length)
        );
        let gap = vec![Series::new("", self.gap, Mark::Line)];
        let pressure = vec![Series::new("", self.pressure, Mark::Line)];
        Charts {
            charts: vec![
                Chart::new(title, x("x"), length("height"), bodies),
                Chart::new("deformed gap", x("x"), length("gap"), gap),
                Chart::new("pressure", x("x"), Axis::linear("pressure", Unit::Pressure), pressure),
            ],
            columns: 1,
            aspect: 0.36,
        }
    }
}

/// The cell of the largest pressure; of several, such as all at the hardness, that whose surroundings bear
/// the most.
pub(super) fn most_loaded(pressure: &Field, touching: &Field) -> Option<[usize; 2]> {
    const AROUND: usize = 2;
    let cells = || pressure.iter().zip(touching).enumerate().filter(|(_, (_, touching))| **touching > 0.0);
    let largest = cells().map(|(_, (p, _))| *p).fold(f64::NEG_INFINITY, f64::max);
    let around = |&[i, j]: &[usize; 2]| {
        let ends = |at: usize, n: usize| at.saturating_sub(AROUND)..(at + AROUND + 1).min(n);
        let cells = ndarray::s![ends(i, pressure.nrows()), ends(j, pressure.ncols())];
        pressure.slice(cells).sum()
    };
    let loaded = cells().filter(|(_, (p, _))| **p >= largest - 1e-6 * largest.abs());
    let place = |cell: usize| [cell / pressure.ncols(), cell % pressure.ncols()];
    loaded.map(|(cell, _)| place(cell)).max_by(|a, b| around(a).total_cmp(&around(b)))
}

/// The part of the elastic displacement along row `iy` that is the lower body's, positive downwards.
fn lower_displacement(facing: &OverlapFields, iy: usize, case: &Case) -> Result<Array1<f64>> {
    let (lower, upper) = (&case.lower.material, &case.upper.material);
    let rigid = Material::elastic(f64::INFINITY, 0.0)?;
    if lower.young.is_infinite() && !lower.is_layered() {
        return Ok(Array1::zeros(facing.pressure.nrows()));
    }
    if !lower.is_layered() && !upper.is_layered() {
        let share = Compliances::new(lower, &rigid)?.normal / Compliances::new(lower, upper)?.normal;
        return Ok(share * &facing.displacement.column(iy));
    }
    // The share of a body in a pair with layers depends on the wavelength.
    let grid = Grid { shape: facing.pressure.dim().into(), pitch: facing.pitch };
    let mut lower_displacement = grid.zeros();
    Operators::new(grid, response(lower, &rigid)?, case.contact.boundary)
        .on(grid.shape)
        .apply(facing.pressure, &mut lower_displacement);
    Ok(lower_displacement.column(iy).to_owned())
}
