//! Films of an oil.

use std::f64::consts::PI;

use super::{Case, Expected, largest, relative, relative_max, study};
use crate::error::Result;
use crate::grid::{Field, Grid};
use crate::lubrication::{
    Film, FilmForces, FilmParams, FilmProblem, FilmSolution, FilmSpeeds, Oil, OilStep, Shear, ViscosityLaw,
    solve_film,
};
use crate::operator::{Boundary, Edge, FreeFft, Operator};
use crate::solver::Control;

/// An oil that neither thickens nor is compressed.
const PLAIN: Oil = Oil {
    viscosity: 0.04,
    pressure_viscosity: 0.0,
    law: ViscosityLaw::Constant,
    compressible: false,
    free_volume: None,
};

/// A mineral oil.
const MINERAL: Oil = Oil {
    viscosity: 0.04,
    pressure_viscosity: 20e-9,
    law: ViscosityLaw::Roelands,
    compressible: true,
    free_volume: None,
};

/// Mean speed of the rigid bodies, m/s.
const SPEED: f64 = 1.0;

const PARAMS: FilmParams = FilmParams { tolerance: 1e-9, max_iterations: 60 };

/// Bodies that do not deform, in a gap that repeats along y.
struct Rigid(Grid);

impl Operator for Rigid {
    fn grid(&self) -> &Grid {
        &self.0
    }

    fn boundary(&self) -> Boundary {
        Boundary([Edge::Free, Edge::Periodic])
    }

    fn harmonic_displacement(&self, _: f64, _: f64) -> f64 {
        0.0
    }

    fn influence(&self, _: usize, _: usize) -> f64 {
        0.0
    }

    fn apply(&mut self, _: &Field, displacement: &mut Field) {
        displacement.fill(0.0);
    }

    fn coarse(&self) -> Box<dyn Operator> {
        Box::new(Self(self.boundary().coarse(&self.0)))
    }
}

/// A film between rigid bodies, its gap and its grid.
struct RigidFilm {
    grid: Grid,
    gap: Field,
    solution: FilmSolution,
}

/// Solves for the oil in a rigid gap h(x) of n cells, `length` long.
fn rigid(
    n: usize,
    length: f64,
    oil: Oil,
    speed: f64,
    rate: f64,
    h: impl Fn(f64) -> f64,
) -> Result<RigidFilm> {
    let pitch = length / n as f64;
    let grid = Grid::new([n, 3], [pitch, length])?;
    let gap = Field::from_shape_fn(grid.shape, |(i, _)| h(grid.centre(0, i)));
    let zeros = Field::zeros(grid.shape);
    let start =
        Film { oil_pressure: zeros.clone(), solid_pressure: zeros.clone(), cavity: zeros, approach: 0.0 };
    // Closing at the rate V, the gap was wider by V before a second.
    let before: Vec<f64> = gap.iter().map(|h| h + rate).collect();
    let step = (rate > 0.0).then_some(OilStep { before: &before, duration: 1.0 });
    let control = Control::Approach(0.0);
    let problem = FilmProblem { gap: &gap, oil, speed, boundary_film: 1e-9, control, ends: [0.0; 2], step };
    let solution = solve_film(&mut Rigid(grid), &problem, &start, &PARAMS)?;
    Ok(RigidFilm { grid, gap, solution })
}

/// A pad whose gap narrows from 20 to 10 µm over 1 mm.
pub(super) const PAD: Case = Case {
    name: "lubrication: inclined pad",
    source: "Reynolds (1886)",
    checks: || {
        let (length, wide, thin) = (1e-3, 20e-6, 10e-6);
        let slope = (wide - thin) / length;
        let viscosity = PLAIN.viscosity;
        let k: f64 = wide / thin - 1.0;
        let pressure = |h: f64| {
            let sum = wide + thin;
            12.0 * viscosity * SPEED / slope * (1.0 / h - wide * thin / (sum * h * h) - 1.0 / sum)
        };
        let load = 12.0 * viscosity * SPEED * length * length / (thin * thin)
            * (k.ln_1p() - 2.0 * k / (2.0 + k))
            / (k * k);
        // Shear of a surface that slides at twice the mean speed over one at rest.
        let friction = viscosity * 2.0 * SPEED * length / thin * (4.0 * k.ln_1p() / k - 6.0 / (2.0 + k));
        let second = |finest| Expected::Order { order: 1.9..=2.3, finest };
        let checks = [
            ("pressure", second(1e-4)),
            ("load", second(1e-4)),
            ("friction", second(1e-4)),
            ("forces on both bodies", Expected::RoundOff(1e-12)),
        ];
        study("cells", &[64, 128, 256], checks, |n| {
            let RigidFilm { grid, gap, solution } =
                rigid(n, length, PLAIN, SPEED, 0.0, |x| wide - slope * x)?;
            let exact = gap.mapv(pressure);
            let problem = FilmProblem {
                gap: &gap,
                oil: PLAIN,
                speed: SPEED,
                boundary_film: 1e-9,
                control: Control::Approach(0.0),
                ends: [0.0; 2],
                step: None,
            };
            let boundary = Boundary([Edge::Free, Edge::Periodic]);
            let forces = FilmForces::new(&problem, &solution, &grid, boundary, 2.0 * SPEED, Shear::Newtonian);
            let width = grid.extent()[1];
            Ok([
                relative_max(&solution.film.oil_pressure, &exact),
                relative(forces.oil_load / width, load),
                relative((forces.oil_shear + 0.5 * forces.rolling) / width, friction),
                (forces.rolling - forces.slopes) / forces.rolling,
            ])
        })
    },
};

/// A parabolic gap, whose film ruptures behind its narrowest place.
pub(super) const RUPTURE: Case = Case {
    name: "lubrication: parabola with rupture",
    source: "Reynolds' conditions at the rupture, q = u h there",
    checks: || {
        let (radius, thin) = (10e-3, 1e-6_f64);
        let unit = (2.0 * radius * thin).sqrt();
        let (inlet, outlet) = (-4.0 * unit, 2.0 * unit);
        let gap = |x: f64| thin + x * x / (2.0 * radius);
        // ∫ h^−2 and ∫ h^−3 from the inlet, by tan γ = x/√(2Rh₀).
        let angle = |x: f64| (x / unit).atan();
        let squares = |g: f64| unit / thin.powi(2) * (0.5 * g + 0.25 * (2.0 * g).sin());
        let cubes =
            |g: f64| unit / thin.powi(3) * (0.375 * g + 0.25 * (2.0 * g).sin() + (4.0 * g).sin() / 32.0);
        let pressure = |x: f64, rupture: f64| {
            let [to, from] = [angle(x), angle(inlet)];
            let (i2, i3) = (squares(to) - squares(from), cubes(to) - cubes(from));
            12.0 * PLAIN.viscosity * SPEED * (i2 - gap(rupture) * i3)
        };
        let (mut low, mut high) = (0.0, outlet);
        for _ in 0..100 {
            let middle = 0.5 * (low + high);
            if pressure(middle, middle) > 0.0 { low = middle } else { high = middle }
        }
        let rupture = low;
        let checks = [
            ("pressure", Expected::Order { order: 1.8..=2.3, finest: 1e-3 }),
            ("cavity fraction", Expected::Order { order: 0.8..=1.6, finest: 2e-2 }),
        ];
        study("cells", &[64, 128, 256], checks, |n| {
            let RigidFilm { grid, solution, .. } =
                rigid(n, outlet - inlet, PLAIN, SPEED, 0.0, |x| gap(x + inlet))?;
            let exact = Field::from_shape_fn(grid.shape, |(i, _)| {
                let x = grid.centre(0, i) + inlet;
                if x < rupture { pressure(x, rupture) } else { 0.0 }
            });
            let cavity = Field::from_shape_fn(grid.shape, |(i, _)| {
                let x = grid.centre(0, i) + inlet;
                if x < rupture { 0.0 } else { 1.0 - gap(rupture) / gap(x) }
            });
            Ok([
                relative_max(&solution.film.oil_pressure, &exact),
                relative_max(&solution.film.cavity, &cavity),
            ])
        })
    },
};

/// Two plates that approach each other.
pub(super) const SQUEEZE: Case = Case {
    name: "lubrication: squeezed strip",
    source: "load ηVB³/h³ for each length",
    checks: || {
        let (width, h, rate) = (1e-3_f64, 5e-6_f64, 1e-9);
        let checks = [("load", Expected::Order { order: 1.95..=2.05, finest: 1e-3 })];
        study("cells", &[16, 32, 64], checks, |n| {
            let RigidFilm { grid, solution, .. } = rigid(n, width, PLAIN, 0.0, rate, |_| h)?;
            let [dx, _] = grid.pitch;
            let load = dx * solution.film.oil_pressure.column(0).sum();
            Ok([relative(load, PLAIN.viscosity * rate * width.powi(3) / h.powi(3))])
        })
    },
};

/// A steel ball of 10 mm radius under a largest pressure of 0.6 GPa.
struct Ball {
    grid: Grid,
    gap: Field,
    load: f64,
    /// Cell of the centre of the contact.
    centre: [usize; 2],
}

const MODULUS: f64 = 115.385e9;

impl Ball {
    /// A grid of `n` cells on 4 contact radii, times `longer` along both axes.
    fn new(n: usize, longer: f64) -> Result<Self> {
        let (radius, most) = (10e-3, 0.6e9);
        let a = PI * most * radius / (2.0 * MODULUS);
        let pitch = 4.0 * a / n as f64;
        let cells = (longer * n as f64).round() as usize;
        let grid = Grid::new([cells; 2], [pitch; 2])?;
        let [inlet, side] = [2.4, 2.0].map(|radii| radii * longer * a);
        let gap = Field::from_shape_fn(grid.shape, |(i, j)| {
            let (x, y) = (grid.centre(0, i) - inlet, grid.centre(1, j) - side);
            (x * x + y * y) / (2.0 * radius)
        });
        let load = 2.0 / 3.0 * PI * a * a * most;
        Ok(Self { grid, gap, load, centre: [inlet, side].map(|length| (length / pitch) as usize) })
    }

    fn problem(&self) -> FilmProblem<'_> {
        FilmProblem {
            gap: &self.gap,
            oil: MINERAL,
            speed: 1.0,
            boundary_film: 2e-9,
            control: Control::Load(self.load),
            ends: [0.0; 2],
            step: None,
        }
    }
}

/// A ball on a plate under a full film. The values are those of an independent program, extrapolated.
pub(super) const BALL: Case = Case {
    name: "lubrication: ball under a full film",
    source: "an independent program, extrapolated; Moes' formula gives 254 nm",
    checks: || {
        let checks = [
            ("film at the centre", Expected::Order { order: 1.5..=3.0, finest: 2e-2 }),
            ("least film", Expected::Order { order: 1.5..=3.0, finest: 1e-2 }),
            ("forces on both bodies", Expected::RoundOff(1e-10)),
        ];
        study("cells over 4 contact radii", &[32, 48, 72], checks, |n| {
            let ball = Ball::new(n, 2.0)?;
            let mut operator = FreeFft::new(ball.grid, MODULUS);
            let solution = FilmSpeeds::new(&mut operator, &ball.problem(), FilmParams::default())?
                .film_at(&mut operator, 1.0)?
                .solution;
            let h = &solution.thickness;
            let least = h.iter().copied().fold(f64::INFINITY, f64::min);
            let forces = FilmForces::new(
                &ball.problem(),
                &solution,
                &ball.grid,
                Boundary::FREE,
                2.0,
                Shear::Limited(0.05),
            );
            let [i, j] = ball.centre;
            Ok([
                relative(h[(i, j)], 256e-9),
                relative(least, 171e-9),
                (forces.rolling - forces.slopes) / forces.rolling,
            ])
        })
    },
};

/// A ball with waves that slides so slowly that no film forms.
pub(super) const SLOW: Case = Case {
    name: "lubrication: slow sliding",
    source: "pressures of the dry contact under the same load",
    checks: || {
        let checks = [("pressure of solids", Expected::Order { order: 0.9..=1.1, finest: 1e-5 })];
        study("1 µm/s over the speed", &[1, 10, 100], checks, |slow| {
            let n = 32;
            let mut ball = Ball::new(n, 1.0)?;
            let wave = |k: usize| (2.0 * PI * 7.0 * k as f64 / n as f64).cos();
            ball.gap.indexed_iter_mut().for_each(|((i, j), gap)| *gap += 50e-9 * wave(i) * wave(j));
            let mut operator = FreeFft::new(ball.grid, MODULUS);
            let mut speeds = FilmSpeeds::new(&mut operator, &ball.problem(), PARAMS)?;
            let solution = speeds.film_at(&mut operator, 1e-6 / slow as f64)?.solution;
            let dry = &speeds.dry().solid_pressure;
            Ok([largest(&(&solution.film.solid_pressure - dry)) / largest(dry)])
        })
    },
};
