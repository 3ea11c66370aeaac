//! Displacement of bodies that slide steadily, in the frame of their contact.

use std::f64::consts::{FRAC_PI_4, TAU};
use std::sync::Arc;

use asperity_transforms::num_complex::Complex64;
use ndarray::Array2;

use crate::error::{Error, Result, check_in};
use crate::grid::{Field, Grid};
use crate::kernel::{Line, normal_displacement, normal_displacements_across};
use crate::math::fft::angular_frequency;
use crate::math::{SkewConvolution, SkewKernel, parallel};
use crate::operator::Boundary;
use crate::units::{Dimension, Metre, MetrePerSecond};
use crate::viscoelastic::layers::SlidingBodies;
use crate::viscoelastic::series::Creep;
use crate::viscoelastic::table::{ElasticCell, MovingCell};

/// Least cells along the longer axis of a grid that is coarsened.
const MIN_CELLS: usize = 32;

/// Two bodies in steady sliding: their displacement u = C p in the frame of the contact, which moves along x
/// over a viscoelastic body.
///
/// ```text
/// u(x) = J_g (Lp)(x) + Σ J_k (1/λ_k) ∫₀^∞ e^(−ξ/λ_k) (Lp)(x + ξ) dξ,   λ_k = vρ_k
/// û = (2/|q|) [J_g + Σ J_k/(1 − iq_x λ_k)] p̂
/// ```
///
/// L is the elastic half-space of a unit modulus. Bodies with layers have the û of their layers, with complex moduli at the
/// frequency ω = −q_x v. C is not symmetric; its symmetric part is positive.
pub struct SteadySliding {
    pub(super) response: Response,
    slope: SkewConvolution,
    field: Field,
}

/// The displacement of bodies that slide steadily, and its approximate inverse.
pub(super) struct Response {
    pub(super) grid: Grid,
    boundary: Boundary,
    bodies: SlidingBodies,
    speed: MetrePerSecond,
    /// Displacement of half-spaces at the offsets −nx < i < nx, 0 ≤ j < ny of a grid that is free along x.
    table: Option<Field>,
    displacement: SkewConvolution,
    preconditioner: SkewConvolution,
    /// Displacement of a cell per unit pressure on itself, m/Pa.
    pub(super) self_influence: f64,
    /// Calls of the displacement and the slope.
    pub(super) convolutions: f64,
}

/// Displacement under the pressure on one cell or of one wave.
enum Influence {
    /// Half-spaces on a grid that is free along x: their compliance, and the table of [`Response`].
    Cell(Creep, Field),
    /// Bodies on a periodic grid.
    Waves(Array2<Complex64>),
}

impl SteadySliding {
    /// Creates the operator on `grid` of `bodies` under pressure, such as the [`Creep`] compliance of both half-spaces
    /// together, whose contact moves at `speed` along x over the body that creeps. A speed below 0 is one
    /// along −x.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for a speed that is not finite; [`Error::Unsupported`] for a boundary that is
    /// periodic along x alone, and for bodies with layers on a grid that is not periodic.
    pub fn new(
        grid: Grid,
        boundary: Boundary,
        bodies: impl Into<SlidingBodies>,
        speed: MetrePerSecond,
    ) -> Result<Self> {
        check_in(Dimension::Speed, "speed", speed, speed.is_finite(), "a finite speed")?;
        let bodies = bodies.into();
        let (slope, influence) = match (boundary, &bodies) {
            (Boundary::PERIODIC, _) => {
                let waves = responses_to_waves(&grid, &bodies, speed);
                (slope_of_waves(&grid, &waves), Influence::Waves(waves))
            }
            _ if boundary.repeats(0) => {
                return Err(Error::Unsupported("steady sliding on a grid that is periodic along x alone"));
            }
            (_, SlidingBodies::Layered { .. }) => {
                return Err(Error::Unsupported(
                    "steady sliding of bodies with layers on a grid that is not periodic",
                ));
            }
            (_, SlidingBodies::HalfSpaces(creep)) => {
                let cell = moving_cell(&grid, boundary, creep, speed);
                let slope = cyclic(&cell.slope, &grid, boundary, speed, speed.signum());
                (slope, Influence::Cell(creep.clone(), cell.displacement))
            }
        };
        Ok(Self {
            response: Response::new(grid, boundary, bodies, speed, influence),
            slope: SkewConvolution::new(Arc::new(slope), grid.shape),
            field: grid.zeros(),
        })
    }

    /// The grid.
    pub fn grid(&self) -> &Grid {
        &self.response.grid
    }

    /// The boundary.
    pub fn boundary(&self) -> Boundary {
        self.response.boundary
    }

    /// Displacement of a cell per unit pressure on itself, m/Pa.
    pub fn self_influence(&self) -> f64 {
        self.response.self_influence
    }

    /// Number of convolutions so far.
    pub fn convolutions(&self) -> f64 {
        self.response.convolutions
    }

    /// Computes the `displacement` under a `pressure`, m.
    pub fn displace(&mut self, pressure: &Field, displacement: &mut Field) {
        self.response.displace(pressure, displacement);
    }

    /// Computes the drag, `−ΔA Σ p ∂u/∂x` for a motion along +x, > 0 where energy is lost, N. The slope ∂u/∂x
    /// is its mean over a cell; its operator is odd for elastic bodies, whose drag is 0 but for rounding.
    pub fn drag(&mut self, pressure: &Field) -> f64 {
        self.response.convolutions += 1.0;
        let Self { slope, field, response: Response { grid, speed: direction, .. } } = self;
        slope.apply(pressure, field);
        -direction.signum()
            * grid.cell_area()
            * pressure.iter().zip(field.iter()).map(|(p, slope)| p * slope).sum::<f64>()
    }
}

impl Response {
    fn new(
        grid: Grid,
        boundary: Boundary,
        bodies: SlidingBodies,
        speed: MetrePerSecond,
        influence: Influence,
    ) -> Self {
        let (displacement, preconditioner, table) = match influence {
            Influence::Waves(waves) => {
                let [displacement, preconditioner] = kernels_of_waves(&grid, &waves, &bodies);
                (displacement, preconditioner, None)
            }
            Influence::Cell(creep, table) => (
                cyclic(&table, &grid, boundary, speed, 1.0),
                inverse_of_waves(&grid, boundary.padded(grid.shape), &creep, speed),
                Some(table),
            ),
        };
        let [displacement, preconditioner] =
            [displacement, preconditioner].map(|kernel| SkewConvolution::new(Arc::new(kernel), grid.shape));
        let (self_influence, convolutions) = (0.0, 0.0);
        let mut this = Self {
            grid,
            boundary,
            bodies,
            speed,
            table,
            displacement,
            preconditioner,
            self_influence,
            convolutions,
        };
        let mut unit = grid.zeros();
        unit[[0, 0]] = 1.0;
        let mut displaced = grid.zeros();
        this.displacement.apply(&unit, &mut displaced);
        this.self_influence = displaced[[0, 0]];
        this
    }

    /// Returns the response on a grid of twice the pitch; `None` on grids that are small or have an odd side. On a grid that is
    /// free along x it is the mean over four cells under the same pressure on four cells, on a periodic one that of the
    /// harmonics.
    pub(super) fn coarse(&self) -> Option<Self> {
        let shape = self.grid.shape;
        let divides = shape.iter().all(|cells| cells % 2 == 0);
        if !divides || shape[0].max(shape[1]) < MIN_CELLS {
            return None;
        }
        let pitch = self.grid.pitch.map(|pitch| 2.0 * pitch);
        let grid = Grid::new(shape.map(|cells| cells / 2), pitch).ok()?;
        let influence = match (&self.table, &self.bodies) {
            (Some(table), SlidingBodies::HalfSpaces(creep)) => {
                Influence::Cell(creep.clone(), self.coarse_table(table, grid.shape))
            }
            _ => Influence::Waves(responses_to_waves(&grid, &self.bodies, self.speed)),
        };
        Some(Self::new(grid, self.boundary, self.bodies.clone(), self.speed, influence))
    }

    /// Returns the table of a coarse grid. Along each axis two of the four pairs of cells in two coarse cells have the offset
    /// of these; one pair is a cell nearer, and one a cell farther.
    fn coarse_table(&self, table: &Field, shape: [usize; 2]) -> Field {
        const NEIGHBOURS: [(isize, f64); 3] = [(-1, 0.5), (0, 1.0), (1, 0.5)];
        let [nx, ny] = self.grid.shape.map(|cells| cells as isize);
        let across = |j: isize| match j.unsigned_abs() {
            j if self.boundary.repeats(1) && 2 * j > ny as usize => ny as usize - j,
            j => j,
        };
        Field::from_shape_fn([2 * shape[0] - 1, shape[1]], |(row, j)| {
            let i = 2 * (row as isize - (shape[0] as isize - 1));
            let terms = NEIGHBOURS.into_iter().flat_map(|along| NEIGHBOURS.map(|other| (along, other)));
            let value = |((a, u), (b, v)): ((isize, f64), (isize, f64))| {
                u * v * table[[(i + a + nx - 1) as usize, across(2 * j as isize + b)]]
            };
            terms.map(value).sum()
        })
    }

    /// Computes the `displacement` under a `pressure`, m.
    pub(super) fn displace(&mut self, pressure: &Field, displacement: &mut Field) {
        self.convolutions += 1.0;
        self.displacement.apply(pressure, displacement);
    }

    /// Computes an approximate pressure under a `displacement`.
    pub(super) fn precondition(&mut self, displacement: &Field, pressure: &mut Field) {
        self.preconditioner.apply(displacement, pressure);
    }
}

fn wave(grid: &Grid, [kx, ky]: [usize; 2]) -> [f64; 2] {
    let [nx, ny] = grid.shape;
    [angular_frequency(kx, nx, grid.pitch[0]), angular_frequency(ky, ny, grid.pitch[1])]
}

/// Displacement û of a periodic grid under each wave, `[kx, ky]` for `ky ≤ ny/2`; 0 under the mean pressure.
fn responses_to_waves(grid: &Grid, bodies: &SlidingBodies, speed: MetrePerSecond) -> Array2<Complex64> {
    let mut responses = Array2::zeros([grid.shape[0], grid.shape[1] / 2 + 1]);
    parallel::tasks(responses.outer_iter_mut().enumerate(), |(kx, mut row)| {
        let at_frequency = bodies.at(-wave(grid, [kx, 0])[0] * speed);
        for (ky, response) in row.iter_mut().enumerate().skip(usize::from(kx == 0)) {
            let [qx, qy] = wave(grid, [kx, ky]);
            *response = at_frequency.response(qx.hypot(qy));
        }
    });
    responses
}

/// Displacement of a periodic grid from its harmonics, and its inverse.
fn kernels_of_waves(grid: &Grid, waves: &Array2<Complex64>, bodies: &SlidingBodies) -> [SkewKernel; 2] {
    // The mean of the pressure is preconditioned like the longest wave.
    let longest = TAU / grid.extent()[0].max(grid.extent()[1]);
    let mean = Complex64::from(bodies.relaxed_stiffness(longest));
    let inverse = |kx, ky| if [kx, ky] == [0, 0] { mean } else { waves[[kx, ky]].inv() };
    [
        SkewKernel::from_transform(grid.shape, |kx, ky| waves[[kx, ky]]),
        SkewKernel::from_transform(grid.shape, inverse),
    ]
}

/// Slope of the displacement of a periodic grid from its harmonics.
fn slope_of_waves(grid: &Grid, waves: &Array2<Complex64>) -> SkewKernel {
    // Only the even part of the shortest wave of an even number of cells is known, and it has no slope.
    SkewKernel::from_transform(grid.shape, |kx, ky| match [kx, ky] {
        [kx, ky] if kx == 0 && ky == 0 || 2 * kx == grid.shape[0] => 0.0.into(),
        [kx, ky] => Complex64::i() * wave(grid, [kx, ky])[0] * waves[[kx, ky]],
    })
}

/// Inverse of the harmonics of a padded grid.
fn inverse_of_waves(grid: &Grid, padded: [usize; 2], creep: &Creep, speed: MetrePerSecond) -> SkewKernel {
    SkewKernel::from_transform(padded, |kx, ky| {
        let [qx, qy] =
            [[kx, 0], [ky, 1]].map(|[k, axis]| angular_frequency(k, padded[axis], grid.pitch[axis]));
        match qx.hypot(qy) {
            0.0 => Complex64::from(FRAC_PI_4 / (grid.shape[0] as f64 * grid.pitch[0]) / creep.relaxed()),
            q => 0.5 * q / creep.complex(-qx * speed),
        }
    })
}

/// Tables of a cell on a grid that is free along x.
fn moving_cell(grid: &Grid, boundary: Boundary, creep: &Creep, speed: MetrePerSecond) -> MovingCell {
    let (pitch, line) = (grid.pitch, boundary.line(grid, boundary.datum(grid)));
    let columns = grid.shape[1];
    let near = |x: Metre, across: bool| -> Option<Vec<f64>> {
        let row = |y: Metre, columns: usize| {
            if across {
                normal_displacements_across(x, y, columns, pitch, 1.0)
            } else {
                (0..columns).map(|j| normal_displacement(x, y + j as f64 * pitch[1], pitch, 1.0)).collect()
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
    cell
}

/// Puts a table at the offsets −nx < i < nx, 0 ≤ j < ny on a cyclic grid, times a factor; mirrored along x for a contact that
/// moves backwards.
fn cyclic(table: &Field, grid: &Grid, boundary: Boundary, speed: MetrePerSecond, factor: f64) -> SkewKernel {
    let padded = boundary.padded(grid.shape);
    let nx = table.nrows().div_ceil(2);
    let mut values = Field::zeros(padded);
    for ((row, j), value) in table.indexed_iter() {
        let i = row as isize - (nx as isize - 1);
        let i = (if speed < 0.0 { -i } else { i }).rem_euclid(padded[0] as isize) as usize;
        if boundary.repeats(1) && j > padded[1] / 2 {
            continue;
        }
        values[[i, j]] = factor * value;
        if j > 0 {
            values[[i, padded[1] - j]] = factor * value;
        }
    }
    SkewKernel::from_values(&values)
}
