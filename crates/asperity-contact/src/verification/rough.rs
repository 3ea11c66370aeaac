//! Identities that hold for any roughness.

use super::{Case, Check, Expected, PARAMS, largest, press, relative, relative_max, study};
use crate::error::Result;
use crate::grid::{Field, Grid};
use crate::operator::{DirectSum, FreeFft, Operator, PeriodicFft};
use crate::reference::rough::fully_plastic_area;
use crate::solver::{Bounds, Control, Device, Method, solve_normal};
use crate::surface::{Amplitude, SelfAffine};
use crate::units::Pascal;

pub(super) const MODULUS: f64 = 1.0;
pub(super) const SLOPE: f64 = 0.1;

/// Gap between a rough surface with the rms slope [`SLOPE`] and a plane, with the highest summit at 0.
pub(super) fn rough_gap(grid: &Grid) -> Result<Field> {
    let surface = SelfAffine {
        hurst: 0.8,
        rolloff: None,
        shortest: Some(4.0 * grid.pitch[0]),
        amplitude: Amplitude::Sdq(SLOPE),
    };
    let heights = surface.generate(grid, 1926)?.into_heights();
    let summit = heights.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    Ok(summit - heights)
}

/// A rough surface that yields: the softer it is, the closer is its area to W/H. The excess is that of
/// contact edges with a pressure below H. For narrow edges, their width is the range 0 < δ − h − u < c₀H over
/// the slope h′: order 1 in H/E*h′. Before that, convergence is faster, because whole contacts are below H.
pub(super) const PLASTIC_LIMIT: Case =
    Case { name: "fully plastic: W = 0.2 H A₀", source: "Bowden & Tabor (1950)", checks: plastic_limit };

fn plastic_limit() -> Result<Vec<Check>> {
    let grid = Grid::new([128; 2], [1.0; 2])?;
    let gap = rough_gap(&grid)?;
    let mut operator = PeriodicFft::new(grid, MODULUS);
    let checks = [("excess of the area", Expected::Order { order: 0.8..=1.6, finest: 2e-3 })];
    study("E*h′/H", &[2, 5, 20, 100], checks, |ratio| {
        let hardness = MODULUS * SLOPE / ratio as f64;
        let load = 0.2 * hardness * grid.area();
        let solution = press(&mut operator, &gap, hardness, Control::Load(load))?;
        let area = solution.contact_cells() as f64 * grid.cell_area();
        Ok([relative(area, fully_plastic_area(load, hardness))])
    })
}

/// The bodies store the work of the load. U = ∫ W dδ from first touch, by the trapezoidal rule, and W =
/// dU/dδ, by central differences. Between the events at which a cell comes into contact W is linear in δ:
/// both are of order 2.
pub(super) const WORK: Case =
    Case { name: "rough contact: work of the load", source: "Clapeyron's theorem", checks: work };

fn work() -> Result<Vec<Check>> {
    const STEPS: usize = 64;
    let grid = Grid::new([32; 2], [1.0; 2])?;
    let gap = rough_gap(&grid)?;
    let deepest = 0.5 * gap.mean().unwrap_or(0.0);
    let mut operator = FreeFft::new(grid, MODULUS);
    let curve = (0..=STEPS)
        .map(|step| {
            let approach = Control::Approach(deepest * step as f64 / STEPS as f64);
            let solution = press(&mut operator, &gap, f64::INFINITY, approach)?;
            Ok((solution.load(), solution.elastic_energy()))
        })
        .collect::<Result<Vec<_>>>()?;
    let (load, stored) = curve[STEPS];
    let second = Expected::Order { order: 1.7..=2.3, finest: 1e-3 };
    let checks = [("∫ W dδ against U", second.clone()), ("dU/dδ against W, rms", second)];
    study("steps", &[8, 16, 32, 64], checks, |steps| {
        let stride = STEPS / steps;
        let step = deepest / steps as f64;
        let curve: Vec<_> = curve.iter().step_by(stride).collect();
        let work: f64 = curve.windows(2).map(|ends| 0.5 * step * (ends[0].0 + ends[1].0)).sum();
        let slopes = curve.windows(3).map(|three| (three[2].1 - three[0].1) / (2.0 * step) - three[1].0);
        let square = slopes.map(|error| error * error).sum::<f64>() / (steps - 1) as f64;
        Ok([relative(work, stored), square.sqrt() / load])
    })
}

/// Three methods that share only the operator, and the solver of devices, on one rough contact. The direct
/// one is exact. The bound is the tolerance of the others times the condition number of the contact.
pub(super) const METHODS: Case = Case {
    name: "rough contact: three methods, device",
    source: "uniqueness of the contact",
    checks: methods,
};

fn methods() -> Result<Vec<Check>> {
    let checks = [
        ("free, elastic", Expected::RoundOff(1e-7)),
        ("free, hardness", Expected::RoundOff(1e-7)),
        ("periodic, elastic", Expected::RoundOff(1e-7)),
        ("periodic, hardness", Expected::RoundOff(1e-7)),
    ];
    study("cells a side", &[8, 16, 32], checks, |n| {
        let grid = Grid::new([n; 2], [1.0; 2])?;
        let gap = rough_gap(&grid)?;
        let mut free = DirectSum::new(grid, MODULUS);
        let mut periodic = PeriodicFft::new(grid, MODULUS);
        let hardness = 0.5 * MODULUS * SLOPE;
        Ok([
            disagreement(&mut free, &gap, f64::INFINITY)?,
            disagreement(&mut free, &gap, hardness)?,
            disagreement(&mut periodic, &gap, f64::INFINITY)?,
            disagreement(&mut periodic, &gap, hardness)?,
        ])
    })
}

/// Largest difference between the pressures of the iterative methods and the direct one, over the largest
/// pressure.
fn disagreement(operator: &mut dyn Operator, gap: &Field, hardness: Pascal) -> Result<f64> {
    let load = Control::Load(0.1 * MODULUS * SLOPE * operator.grid().area());
    let mut pressure = |method, device| {
        let params = PARAMS.with_method(method).with_device(device);
        Ok(solve_normal(operator, gap, &Bounds::up_to(hardness), load, None, &params)?.pressure)
    };
    let exact = pressure(Method::Direct, Device::Cpu)?;
    let others = [
        pressure(Method::PolonskyKeer, Device::Cpu)?,
        pressure(Method::ActiveSet, Device::Cpu)?,
        pressure(Method::ActiveSet, Device::Host)?,
    ];
    Ok(largest(&others.map(|pressure| relative_max(&pressure, &exact))))
}
