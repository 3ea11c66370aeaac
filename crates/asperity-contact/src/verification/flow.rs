//! Flow through a gap.

use std::f64::consts::{PI, TAU};

use super::{Case, Expected, relative, study};
use crate::error::Result;
use crate::grid::{Field, Grid};
use crate::with::flow::{Along, Ends, Faces, Flow, Settings, Sides, shear_flow, solve};

const HARMONIC: Settings =
    Settings { ends: Ends::Periodic, sides: Sides::Periodic, faces: Faces::Harmonic, along: Along::Both };

/// Solves for the flow through a unit square of n × m cells with the gap at the centre of each cell.
fn through(shape: [usize; 2], settings: &Settings, gap: impl Fn(f64, f64) -> f64) -> Result<Flow> {
    let grid = Grid::new(shape, shape.map(|n| 1.0 / n as f64))?;
    let gap = Field::from_shape_fn(shape, |(i, j)| gap(grid.centre(0, i), grid.centre(1, j)));
    solve(&gap, &grid, settings)
}

/// Permeabilities along x and y; NaN for a direction that was not asked for.
fn both(flow: &Flow) -> [f64; 2] {
    flow.along.each_ref().map(|along| along.as_ref().map_or(f64::NAN, |along| along.permeability))
}

/// An even gap between periodic ends, and between reservoirs; cells are not square.
pub(super) const PLATES: Case = Case {
    name: "flow: parallel plates",
    source: "Poiseuille: q = −(g³/12η) ∇P",
    checks: || {
        let checks =
            [("periodic", Expected::RoundOff(1e-13)), ("between reservoirs", Expected::RoundOff(1e-13))];
        study("cells", &[16, 32], checks, |n| {
            let k = |ends| -> Result<f64> {
                let settings = Settings { ends, ..Settings::default() };
                let [x, y] = both(&through([n, n / 2 + 3], &settings, |_, _| 0.7)?);
                Ok(relative(x, 0.343).abs().max(relative(y, 0.343).abs()))
            };
            Ok([k(Ends::Periodic)?, k(Ends::Reservoirs)?])
        })
    },
};

/// A corrugated gap 1 + a cos 2πx with a = 0.6. Sums over a period of a smooth function converge faster than
/// any power.
pub(super) const CORRUGATION: Case = Case {
    name: "flow: corrugation 1 + 0.6 cos",
    source: "mean of g³ along the crests, of g⁻³ across them",
    checks: || {
        let a = 0.6_f64;
        let across = (1.0 - a * a).powf(2.5) / (1.0 + 0.5 * a * a);
        let along = 1.0 + 1.5 * a * a;
        let checks = [
            ("across, harmonic faces", Expected::RoundOff(1e-12)),
            ("along", Expected::RoundOff(1e-13)),
            ("across, linear faces", Expected::Order { order: 1.9..=2.1, finest: 1e-2 }),
        ];
        study("cells a wave", &[48, 64, 128], checks, |n| {
            let gap = |x: f64, _: f64| 1.0 + a * (TAU * x).cos();
            let [x, y] = both(&through([n, 4], &HARMONIC, gap)?);
            let [linear, _] = both(&through([n, 4], &Settings::default(), gap)?);
            Ok([relative(x, across), relative(y, along), relative(linear, across)])
        })
    },
};

/// The corrugation slides over a smooth surface across its crests: Φ = ḡ − ⟨g⁻²⟩/⟨g⁻³⟩, with ⟨g⁻²⟩ = (1 − a²)^(−3/2).
pub(super) const SLIDING: Case = Case {
    name: "flow: sliding corrugation 1 + 0.6 cos",
    source: "Reynolds: g³ψ′ = ⟨g⁻²⟩/⟨g⁻³⟩ − g",
    checks: || {
        let a = 0.6_f64;
        let carried = 1.0 - (1.0 - a * a) / (1.0 + 0.5 * a * a);
        let checks = [
            ("across, linear faces", Expected::Order { order: 1.9..=2.1, finest: 1e-2 }),
            ("along", Expected::RoundOff(1e-13)),
        ];
        study("cells a wave", &[48, 64, 128], checks, |n| {
            let shape = [n, 4];
            let grid = Grid::new(shape, shape.map(|n| 1.0 / n as f64))?;
            let gap = Field::from_shape_fn(shape, |(i, _)| 1.0 + a * (TAU * grid.centre(0, i)).cos());
            let [across, along] = shear_flow(&gap, &grid, Faces::Linear);
            Ok([relative(across.carried, carried), along.carried])
        })
    },
};

/// Small roughness of relative rms height s: two crossed waves, which are isotropic to the second order, and
/// grooves. The error is of the next orders in s.
pub(super) const SMALL: Case = Case {
    name: "flow: small roughness of rms height s",
    source: "perturbation: φ = 1 − 3s²/2; across grooves 1 − 6s², along 1 + 3s²",
    checks: || {
        let order = || Expected::Order { order: 2.9..=4.1, finest: 1e-5 };
        let checks = [
            ("isotropic", order()),
            ("across grooves", order()),
            ("along grooves", Expected::RoundOff(1e-13)),
        ];
        study("1/s", &[16, 32, 64], checks, |inverse| {
            let s = 1.0 / inverse as f64;
            let crossed = |x: f64, y: f64| 1.0 + s * ((TAU * x).cos() + (TAU * y).cos());
            let [x, y] = both(&through([64, 64], &HARMONIC, crossed)?);
            let grooves = |x: f64, _: f64| 1.0 + s * 2.0_f64.sqrt() * (TAU * x).cos();
            let [across, along] = both(&through([64, 4], &HARMONIC, grooves)?);
            let isotropic = 1.0 - 1.5 * s * s;
            Ok([
                (x - isotropic).abs().max((y - isotropic).abs()),
                across - (1.0 - 6.0 * s * s),
                along - (1.0 + 3.0 * s * s),
            ])
        })
    },
};

/// Round contacts on a square lattice, 30 % of the area, in an even gap: the rim is a staircase.
pub(super) const DISCS: Case = Case {
    name: "flow: discs of contact, 30 %",
    source: "Perrins, McKenzie, McPhedran, Proc. R. Soc. A 369, 207 (1979)",
    checks: || {
        let f = 0.3_f64;
        let exact = 1.0 - 2.0 * f / (1.0 + f - 0.305827 * f.powi(4) - 0.013362 * f.powi(8));
        let checks = [("permeability", Expected::Order { order: 0.8..=1.2, finest: 5e-3 })];
        study("cells a side", &[64, 128, 256], checks, |n| {
            let radius = (f / PI).sqrt();
            let disc = |x: f64, y: f64| if (x - 0.5).hypot(y - 0.5) < radius { 0.0 } else { 1.0 };
            let [x, _] = both(&through([n, n], &Settings::default(), disc)?);
            Ok([relative(x, exact)])
        })
    },
};

/// A gap that opens beside a round contact as an elastic one does, ∝ (r − a)^(3/2). The reference is
/// extrapolated from 512² and 1024².
pub(super) const RIM: Case = Case {
    name: "flow: gap ∝ (r − a)^(3/2) beside a contact",
    source: "extrapolation with the order 2",
    checks: || {
        let order = || Expected::Order { order: 1.9..=2.1, finest: 2e-3 };
        let checks = [("linear faces", order()), ("harmonic faces", order())];
        study("cells a side", &[32, 64, 128], checks, |n| {
            let gap = |x: f64, y: f64| ((x - 0.5).hypot(y - 0.5) - 0.3).max(0.0).powf(1.5);
            let [linear, _] = both(&through([n, n], &Settings::default(), gap)?);
            let [harmonic, _] = both(&through([n, n], &HARMONIC, gap)?);
            Ok([relative(linear, RIM_PERMEABILITY), relative(harmonic, RIM_PERMEABILITY)])
        })
    },
};

const RIM_PERMEABILITY: f64 = 1.461_991_504e-4;

/// Squares of permeability 1 and 4, two a period: the fluxes have weak singularities at the corners.
pub(super) const CHECKERBOARD: Case = Case {
    name: "flow: checkerboard of permeabilities 1 : 4",
    source: "Keller, J. Math. Phys. 5, 548 (1964): √(k₁k₂)",
    checks: || {
        let checks = [("permeability", Expected::Order { order: 1.1..=1.3, finest: 3e-3 })];
        study("cells a square", &[16, 32, 64], checks, |n| {
            let board = |x: f64, y: f64| if (x < 0.5) == (y < 0.5) { 1.0 } else { 4f64.powf(1.0 / 3.0) };
            let [x, _] = both(&through([2 * n, 2 * n], &HARMONIC, board)?);
            Ok([relative(x, 2.0)])
        })
    },
};

/// Gaps scattered over six decades, a quarter of the cells closed: sections, work, symmetry, and a channel
/// along a diagonal.
pub(super) const CONSERVATION: Case = Case {
    name: "flow: contrast 10¹⁸",
    source: "∇·q = 0: the same flux in every section; Σ q²/T = K G²",
    checks: || {
        let checks = [
            ("sections, periodic", Expected::RoundOff(1e-12)),
            ("sections, reservoirs", Expected::RoundOff(1e-12)),
            ("dissipation", Expected::RoundOff(1e-11)),
            ("diagonal channel", Expected::RoundOff(1e-13)),
        ];
        study("cells a side", &[32, 64, 128], checks, |n| {
            // An irrational step scatters the numbers evenly in 0 … 1.
            let scattered = |x: f64, y: f64| {
                let cell = (x * n as f64).floor() * n as f64 + (y * n as f64).floor();
                let at = (cell * cell * 0.618_033_988_749_894_9 + cell * 0.414_213_562_373_095).fract();
                if at < 0.25 { 0.0 } else { 10f64.powf(-8.0 * (at - 0.25)) }
            };
            let periodic = through([n, n], &Settings::default(), scattered)?;
            let settings = Settings { ends: Ends::Reservoirs, ..Settings::default() };
            let reservoirs = through([n, n], &settings, scattered)?;
            let worst = |flow: &Flow, of: fn(&crate::with::flow::FlowAlong) -> f64| {
                flow.along.iter().flatten().map(of).fold(0.0, f64::max)
            };
            let step = |x: f64, y: f64| {
                let (i, j) = ((x * n as f64) as usize, (y * n as f64) as usize);
                if j == i || j == (i + 1) % n { 1.0 } else { 0.0 }
            };
            let tensor = through([n, n], &Settings::default(), step)?.permeability().unwrap_or_default();
            let diagonal = tensor.as_flattened().iter().map(|k| relative(2.0 * n as f64 * k, 1.0).abs());
            Ok([
                worst(&periodic, |along| along.residual),
                worst(&reservoirs, |along| along.residual),
                worst(&periodic, |along| along.dissipation)
                    .max(worst(&reservoirs, |along| along.dissipation)),
                diagonal.fold(0.0, f64::max),
            ])
        })
    },
};
