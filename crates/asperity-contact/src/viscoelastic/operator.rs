//! Displacement of bodies that slide steadily, in the frame of their contact.

use std::f64::consts::{FRAC_PI_4, TAU};
use std::sync::Arc;

use asperity_transforms::num_complex::Complex64;

use crate::error::{Error, Result, check_in};
use crate::grid::{Field, Grid};
use crate::kernel::{Line, normal_displacement, normal_displacements_across};
use crate::math::fft::angular_frequency;
use crate::math::{SkewConvolution, SkewKernel};
use crate::operator::Boundary;
use crate::units::{Dimension, Metre, MetrePerSecond};
use crate::viscoelastic::series::Creep;
use crate::viscoelastic::table::{ElasticCell, MovingCell};

/// Two bodies in steady sliding: their displacement u = C p in the frame of the contact, which moves along x
/// over a viscoelastic body.
///
/// ```text
/// u(x) = J_g (Lp)(x) + Σ J_k (1/λ_k) ∫₀^∞ e^(−ξ/λ_k) (Lp)(x + ξ) dξ,   λ_k = vρ_k
/// û = (2/|q|) [J_g + Σ J_k/(1 − iq_x λ_k)] p̂
/// ```
///
/// L is the elastic half-space of a unit modulus. C is not symmetric; its symmetric part is positive.
pub struct SteadySliding {
    grid: Grid,
    boundary: Boundary,
    speed: MetrePerSecond,
    displacement: SkewConvolution,
    slope: SkewConvolution,
    preconditioner: SkewConvolution,
    self_influence: f64,
    /// Calls of the displacement and the slope.
    convolutions: f64,
    field: Field,
}

impl SteadySliding {
    /// Creates the operator on `grid` of bodies with this `creep` compliance under pressure, that of both
    /// together, whose contact moves at `speed` along x over the body that creeps. A speed below 0 is one
    /// along −x.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for a speed that is not finite; [`Error::Unsupported`] for a boundary that is
    /// periodic along x alone.
    pub fn new(grid: Grid, boundary: Boundary, creep: &Creep, speed: MetrePerSecond) -> Result<Self> {
        check_in(Dimension::Speed, "speed", speed, speed.is_finite(), "a finite speed")?;
        let kernels = match boundary {
            Boundary::PERIODIC => Kernels::of_waves(&grid, creep, speed),
            _ if boundary.repeats(0) => {
                return Err(Error::Unsupported("steady sliding on a grid that is periodic along x alone"));
            }
            _ => Kernels::of_cells(&grid, boundary, creep, speed),
        };
        let [displacement, slope, preconditioner] =
            [kernels.displacement, kernels.slope, kernels.preconditioner]
                .map(|kernel| SkewConvolution::new(Arc::new(kernel), grid.shape));
        let mut this = Self {
            grid,
            boundary,
            speed,
            displacement,
            slope,
            preconditioner,
            self_influence: 0.0,
            convolutions: 0.0,
            field: grid.zeros(),
        };
        let mut unit = grid.zeros();
        unit[[0, 0]] = 1.0;
        let mut displaced = grid.zeros();
        this.displacement.apply(&unit, &mut displaced);
        this.self_influence = displaced[[0, 0]];
        Ok(this)
    }

    /// The grid.
    pub fn grid(&self) -> &Grid {
        &self.grid
    }

    /// The boundary.
    pub fn boundary(&self) -> Boundary {
        self.boundary
    }

    /// Displacement of a cell per unit pressure on itself, m/Pa.
    pub fn self_influence(&self) -> f64 {
        self.self_influence
    }

    /// Number of convolutions so far.
    pub fn convolutions(&self) -> f64 {
        self.convolutions
    }

    /// Computes the `displacement` under a `pressure`, m.
    pub fn displace(&mut self, pressure: &Field, displacement: &mut Field) {
        self.convolutions += 1.0;
        self.displacement.apply(pressure, displacement);
    }

    /// Computes an approximate pressure under a `displacement`.
    pub(super) fn precondition(&mut self, displacement: &Field, pressure: &mut Field) {
        self.preconditioner.apply(displacement, pressure);
    }

    /// Computes the drag, `−ΔA Σ p ∂u/∂x` for a motion along +x, > 0 where energy is lost, N. The slope ∂u/∂x
    /// is its mean over a cell; its operator is odd for elastic bodies, whose drag is 0 but for rounding.
    pub fn drag(&mut self, pressure: &Field) -> f64 {
        self.convolutions += 1.0;
        let Self { slope, field, grid, speed: direction, .. } = self;
        slope.apply(pressure, field);
        -direction.signum()
            * grid.cell_area()
            * pressure.iter().zip(field.iter()).map(|(p, slope)| p * slope).sum::<f64>()
    }
}

/// The kernels of an operator.
struct Kernels {
    displacement: SkewKernel,
    slope: SkewKernel,
    preconditioner: SkewKernel,
}

impl Kernels {
    /// Creates the kernels of a periodic grid from its harmonics.
    fn of_waves(grid: &Grid, creep: &Creep, speed: MetrePerSecond) -> Self {
        let [nx, ny] = grid.shape;
        let wave = |kx: usize, ky: usize| {
            [angular_frequency(kx, nx, grid.pitch[0]), angular_frequency(ky, ny, grid.pitch[1])]
        };
        let response = |kx, ky| {
            let [qx, qy] = wave(kx, ky);
            2.0 / qx.hypot(qy) * creep.complex(-qx * speed)
        };
        let zero = |kx: usize, ky: usize| kx == 0 && ky == 0;
        // The mean of the pressure is preconditioned like the longest wave.
        let longest = TAU / grid.extent()[0].max(grid.extent()[1]);
        let mean = Complex64::from(0.5 * longest / creep.relaxed());
        Self {
            displacement: SkewKernel::from_transform(grid.shape, |kx, ky| {
                if zero(kx, ky) { 0.0.into() } else { response(kx, ky) }
            }),
            // Only the even part of the shortest wave of an even number of cells is known, and it has no
            // slope.
            slope: SkewKernel::from_transform(grid.shape, |kx, ky| {
                if zero(kx, ky) || 2 * kx == nx {
                    0.0.into()
                } else {
                    Complex64::i() * wave(kx, ky)[0] * response(kx, ky)
                }
            }),
            preconditioner: SkewKernel::from_transform(grid.shape, |kx, ky| {
                if zero(kx, ky) { mean } else { response(kx, ky).inv() }
            }),
        }
    }

    /// Creates the kernels of a grid that is free along x from the tables of a cell.
    fn of_cells(grid: &Grid, boundary: Boundary, creep: &Creep, speed: MetrePerSecond) -> Self {
        let (pitch, line) = (grid.pitch, boundary.line(grid, boundary.datum(grid)));
        let columns = grid.shape[1];
        let near = |x: Metre, across: bool| -> Option<Vec<f64>> {
            let row = |y: Metre, columns: usize| {
                if across {
                    normal_displacements_across(x, y, columns, pitch, 1.0)
                } else {
                    (0..columns)
                        .map(|j| normal_displacement(x, y + j as f64 * pitch[1], pitch, 1.0))
                        .collect()
                }
            };
            let nearest = |line: Line, j: usize| {
                line.nearest(j as f64 * pitch[1]).map(|y| row(y, 1)[0]).iter().sum::<f64>()
            };
            Some(match line {
                None => row(0.0, columns),
                Some(line) => (0..columns).map(|j| nearest(line, j)).collect(),
            })
        };
        let far = |x: Metre, across: bool| Some(line?.beyond_nearest(x, columns, pitch, 1.0, across));
        let elastic = ElasticCell { near: &near, far: &far };
        let mut glassy = creep.glassy;
        let mut decays = Vec::new();
        for term in &creep.terms {
            match speed.abs() * term.time {
                0.0 => glassy += term.compliance,
                decay => decays.push([term.compliance, decay]),
            }
        }
        // Along a periodic axis the offsets beyond half the period are those of the other direction.
        let mut cell = MovingCell::new(&elastic, grid.shape, grid.pitch[0], glassy, &decays);
        let least = cell.displacement.iter().copied().fold(f64::INFINITY, f64::min);
        if boundary.single_period().is_some() && least < 0.0 {
            cell.displacement -= least;
        }
        let padded = boundary.padded(grid.shape);
        let backwards = speed < 0.0;
        let sign = if backwards { -1.0 } else { 1.0 };
        let preconditioner = SkewKernel::from_transform(padded, |kx, ky| {
            let [qx, qy] =
                [[kx, 0], [ky, 1]].map(|[k, axis]| angular_frequency(k, padded[axis], grid.pitch[axis]));
            match qx.hypot(qy) {
                0.0 => Complex64::from(FRAC_PI_4 / (grid.shape[0] as f64 * grid.pitch[0]) / creep.relaxed()),
                q => 0.5 * q / creep.complex(-qx * speed),
            }
        });
        Self {
            displacement: SkewKernel::from_values(&cyclic(
                &cell.displacement,
                padded,
                backwards,
                1.0,
                boundary,
            )),
            slope: SkewKernel::from_values(&cyclic(&cell.slope, padded, backwards, sign, boundary)),
            preconditioner,
        }
    }
}

/// Puts a table at the offsets −nx < i < nx, 0 ≤ j < ny on a cyclic grid; mirrored along x, and times a
/// factor, for a contact that moves `backwards`.
fn cyclic(table: &Field, padded: [usize; 2], backwards: bool, factor: f64, boundary: Boundary) -> Field {
    let nx = table.nrows().div_ceil(2);
    let mut values = Field::zeros(padded);
    for ((row, j), value) in table.indexed_iter() {
        let i = row as isize - (nx as isize - 1);
        let i = (if backwards { -i } else { i }).rem_euclid(padded[0] as isize) as usize;
        if boundary.repeats(1) && j > padded[1] / 2 {
            continue;
        }
        values[[i, j]] = factor * value;
        if j > 0 {
            values[[i, padded[1] - j]] = factor * value;
        }
    }
    values
}
