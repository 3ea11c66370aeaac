//! Fatigue below a contact that passes.

use super::{Case, Check, Expected, relative, study};
use crate::error::Result;
use crate::fatigue::{DangVan, StressHistory};
use crate::grid::{Field, Grid};
use crate::operator::{Boundary, Edge};
use crate::reference::HertzLine;
use crate::stress::Stress;
use crate::subsurface::Tractions;

/// A line contact that rolls, and one that slides, over a body. On the grid the pressure is its mean over a
/// cell.
pub(super) const LINE: Case = Case {
    name: "Dang Van: line contact that passes",
    source: "McEwen (1949); Johnson (1985), eq. 4.49; Dang Van (1993)",
    checks: line,
};

fn line() -> Result<Vec<Check>> {
    const POISSON: f64 = 0.3;
    /// Half widths of the contact on either side of a point that see it.
    const REACH: f64 = 12.0;
    let contact = HertzLine { radius: 1.0, modulus: 2.0, load_per_length: std::f64::consts::FRAC_PI_2 };
    let criterion = DangVan::new(1.0, 3.0 / 1.8)?;
    let depths = [0.5, 1.0];
    let exact = |depth: f64, friction: f64| {
        let at = |k: i32| contact.stress(0.001 * f64::from(k), depth, POISSON, friction);
        criterion.evaluate(&(-12_000..=12_000).map(at).collect::<Vec<Stress>>())[0]
    };
    // The largest of what the positions see of a smooth path, and a ball through some of them.
    let order = |finest| Expected::Order { order: 0.8..=4.0, finest };
    let checks = [
        ("σxz, z = a/2", order(1e-3)),
        ("f, z = a/2", order(5e-3)),
        ("f, z = a", order(5e-3)),
        ("f, z = a/2, μ = 0.1", order(5e-3)),
    ];
    study("cells a half width", &[4, 12, 36], checks, |n| {
        let pitch = 1.0 / n as f64;
        let columns = 2 * REACH as usize * n + 1;
        let grid = Grid::new([columns, 1], [pitch; 2])?;
        // ∫ √(1 − t²) dt
        let area = |t: f64| {
            let t = t.clamp(-1.0, 1.0);
            0.5 * (t * (1.0 - t * t).sqrt() + t.asin())
        };
        let pressure = |centre: usize| {
            let from = |i: usize| (i as f64 - centre as f64 - 0.5) * pitch;
            Field::from_shape_fn(grid.shape, |(i, _)| (area(from(i) + pitch) - area(from(i))) / pitch)
        };
        let middle = [columns / 2, 0];
        let with = |friction: f64| {
            let line = Boundary([Edge::Free, Edge::Periodic]);
            let pass = StressHistory::new(grid, line, POISSON, columns, |at| {
                let pressure = pressure(at);
                let shear = friction * &pressure;
                Tractions { pressure, shear: [Some(shear), None] }
            });
            pass.dang_van(&criterion, &depths)
        };
        let (rolls, slides) = (with(0.0)?, with(0.1)?);
        Ok([
            relative(rolls[0].shear_amplitude[middle], 0.25),
            relative(rolls[0].f[middle], exact(0.5, 0.0)),
            relative(rolls[1].f[middle], exact(1.0, 0.0)),
            relative(slides[0].f[middle], exact(0.5, 0.1)),
        ])
    })
}
