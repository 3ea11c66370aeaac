//! The devices on which contacts are solved.

use asperity_base::error::{Result, check};
use asperity_base::grid::Field;
use asperity_base::units::Pascal;
use asperity_base::watch::Watch;
use web_time::Instant;

use crate::card::Card;
use crate::cascade::{Solved, Task};
#[cfg(feature = "cuda")]
use crate::cuda::Cuda;
use crate::fields::Fields;
use crate::host::Host;
use crate::problem::{Accuracy, Control, Level, Precision, Problem, Rough, Solution, Statistics};
use crate::{cascade, fields, solver};

/// A device on which contacts are solved.
#[derive(Clone)]
pub struct Device(Kind);

#[derive(Clone)]
enum Kind {
    Host,
    #[cfg(feature = "cuda")]
    Cuda(Cuda),
}

/// Evaluates an expression with the device of a [`Device`].
macro_rules! on {
    ($device:expr, $name:ident => $expression:expr) => {
        match &$device.0 {
            Kind::Host => {
                let $name = &Host;
                $expression
            }
            #[cfg(feature = "cuda")]
            Kind::Cuda($name) => $expression,
        }
    };
}

impl Device {
    /// The processor in plain loops: slow, and the reference of the other devices.
    pub const HOST: Self = Self(Kind::Host);

    /// Opens the first GPU of NVIDIA.
    ///
    /// # Errors
    /// [`asperity_base::Error::NoDevice`] with what was found, also if the program was built without the
    /// feature `cuda`.
    pub fn cuda() -> Result<Self> {
        #[cfg(feature = "cuda")]
        return Cuda::open().map(|cuda| Self(Kind::Cuda(cuda)));
        #[cfg(not(feature = "cuda"))]
        Err(asperity_base::error::Error::NoDevice {
            device: "cuda",
            found: "a program that was built without the feature `cuda`".to_owned(),
        })
    }

    /// Returns what the device is, with the memory that is free now; none for the processor.
    ///
    /// # Errors
    /// [`asperity_base::Error::DeviceFailed`].
    pub fn card(&self) -> Result<Option<Card>> {
        match &self.0 {
            Kind::Host => Ok(None),
            #[cfg(feature = "cuda")]
            Kind::Cuda(cuda) => cuda.card().map(Some),
        }
    }

    /// Solves contacts.
    ///
    /// # Errors
    /// [`asperity_base::Error::NotConverged`], [`asperity_base::Error::Interrupted`],
    /// [`asperity_base::Error::DeviceMemory`], [`asperity_base::Error::DeviceFailed`],
    /// [`asperity_base::Error::OutOfRange`] for results that are not finite.
    ///
    /// # Panics
    /// If there is no contact or no grid, or if a contact is larger than the transforms of its grid.
    pub fn solve(&self, problem: &Problem, watch: &dyn Watch) -> Result<Solution> {
        let padded = problem.grids[0].padded;
        let fits = |shape: &[usize]| shape[0] <= padded[0] && shape[1] <= padded[1];
        assert!(
            problem.contacts.iter().all(|contact| fits(contact.gap.shape())),
            "contacts within their grid"
        );
        on!(self, device => solve(device, problem, watch))
    }

    /// Solves the elastic contact of a rough surface that is made on the device, under a mean pressure.
    /// `grids` are those of [`Problem`], periodic; `histogram` is the largest pressure of the histogram and
    /// its number of bins.
    ///
    /// # Errors
    /// The errors of [`Device::solve`].
    ///
    /// # Panics
    /// If the finest of the `grids` is not that of the surface.
    pub fn press(
        &self,
        rough: &Rough,
        grids: &[Level],
        mean_pressure: Pascal,
        accuracy: &Accuracy,
        histogram: (Pascal, usize),
        watch: &dyn Watch,
    ) -> Result<Statistics> {
        on!(self, device => press(device, rough, grids, mean_pressure, accuracy, histogram, watch))
    }

    /// Returns the gap between a rough surface and a plane that touches its highest summit.
    ///
    /// # Errors
    /// [`asperity_base::Error::DeviceMemory`], [`asperity_base::Error::DeviceFailed`].
    ///
    /// # Panics
    /// If `level` is not the grid of the surface.
    pub fn gap_of(&self, rough: &Rough, level: &Level) -> Result<Field> {
        on!(self, device => gap_of(device, rough, level))
    }

    /// Returns the time, s, of a convolution on a periodic grid with `side` cells along each axis, in single
    /// and in double precision, without the rest of an iteration: the mean of `times`.
    ///
    /// # Errors
    /// [`asperity_base::Error::DeviceMemory`], [`asperity_base::Error::DeviceFailed`].
    pub fn time_of_convolutions(&self, level: &Level, side: usize, times: usize) -> Result<[f64; 2]> {
        on!(self, device => time_of_convolutions(device, level, side, times))
    }
}

fn solve<D: fields::Device>(device: &D, problem: &Problem, watch: &dyn Watch) -> Result<Solution> {
    let Problem { contacts, grids, control, accuracy } = *problem;
    let gaps = device.gaps(contacts, accuracy.precision)?;
    let starts = contacts.iter().map(|contact| contact.start).collect();
    let Solved { fields, state, cost } =
        cascade::solve(device, Task { gaps, starts, grids, control, accuracy }, watch)?;
    check("approach", state.approach, state.approach.is_finite(), solver::FINITE)?;
    let self_influence = fields.self_influence();
    Ok(Solution {
        fields: fields.results()?,
        approach: state.approach,
        residual: state.eta,
        self_influence,
        cost,
    })
}

fn press<D: fields::Device>(
    device: &D,
    rough: &Rough,
    grids: &[Level],
    mean_pressure: Pascal,
    accuracy: &Accuracy,
    (largest, bins): (Pascal, usize),
    watch: &dyn Watch,
) -> Result<Statistics> {
    assert_eq!(grids[0].padded, [rough.side; 2], "the grid of the surface");
    let began = Instant::now();
    let gaps = device.rough(rough, &grids[0], accuracy.precision)?;
    let made = began.elapsed().as_secs_f64();
    let cells = (rough.side * rough.side) as f64;
    let control = Control::PressureSum(mean_pressure * cells);
    let task = Task { gaps, starts: None, grids, control, accuracy: *accuracy };
    let began = Instant::now();
    let Solved { mut fields, state, cost } = cascade::solve(device, task, watch)?;
    fields.wait()?;
    let solved = began.elapsed().as_secs_f64();
    let [gap, contact, max_pressure] = fields.statistics(state.approach)?;
    Ok(Statistics {
        area: contact / cells,
        mean_gap: gap / cells,
        max_pressure,
        histogram: fields.histogram(largest / bins as f64, bins)?,
        residual: state.eta,
        cost,
        times: [made, solved],
        bytes_a_cell: fields.bytes() as f64 / cells,
    })
}

fn gap_of<D: fields::Device>(device: &D, rough: &Rough, level: &Level) -> Result<Field> {
    assert_eq!(level.padded, [rough.side; 2], "the grid of the surface");
    let gaps = device.rough(rough, level, Precision::Double)?;
    Ok(device.fields(gaps, level)?.gaps()?.remove(0))
}

fn time_of_convolutions<D: fields::Device>(
    device: &D,
    level: &Level,
    side: usize,
    times: usize,
) -> Result<[f64; 2]> {
    let [pitch, _] = level.pitch;
    let (longest, shortest) = (side as f64 * pitch, 8.0 * pitch);
    let rough = Rough { side, pitch, hurst: 0.8, longest, shortest, slope: 1.0, seed: 1 };
    let mut fields = device.fields(device.rough(&rough, level, Precision::Double)?, level)?;
    // Transforms are timed on values like those of a contact.
    fields.close_alone(0.0, 1.0)?;
    fields.convolve()?;
    let mut mean = |single: bool| -> Result<f64> {
        fields.wait()?;
        let began = Instant::now();
        for _ in 0..times {
            fields.multiply(single)?;
        }
        fields.wait()?;
        Ok(began.elapsed().as_secs_f64() / times as f64)
    };
    Ok([mean(true)?, mean(false)?])
}

/// Returns an upper bound of the memory, bytes, that contacts of `cells` cells in all take on a device, with
/// transforms of `padded` values in all. `caps_differ` says whether the upper bounds differ between cells,
/// `tables` how many tables of the displacement there are.
pub fn memory(cells: f64, padded: f64, caps_differ: bool, tables: usize, precision: Precision) -> f64 {
    let state = match precision {
        Precision::Double => 8.0,
        Precision::Single => 4.0,
    };
    // Pressure, h + u, gap, last feasible pressure and bounds; direction, set and pattern; the pressure of the
    // next coarser grid; buffer and work area, with a quarter for each table; the fields of the nodes and their
    // work area, one in 256; the sums between cells and nodes, one in 16.
    let fields = if caps_differ { 5.0 } else { 4.0 };
    let on_nodes = 4.0 * (4.0 / 256.0 + 1.0 / 16.0);
    cells * (fields * state + 6.0 + 0.25 * state) + padded * (state * (2.0 + 0.25 * tables as f64) + on_nodes)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::problem::{Compliance, Harmonics};

    fn levels(side: usize) -> Vec<Level> {
        let level = |coarser: u32| Level {
            padded: [side >> coarser; 2],
            pitch: [f64::from(1u32 << coarser) / side as f64; 2],
            compliance: Compliance::Harmonic,
            harmonics: Harmonics::HalfSpaces(1.0),
        };
        (0..=side.ilog2() - 5).map(level).collect()
    }

    fn rough(side: usize) -> Rough {
        let pitch = 1.0 / side as f64;
        Rough { side, pitch, hurst: 0.8, longest: 0.25, shortest: 1.0 / 12.0, slope: 0.1, seed: 7 }
    }

    /// Root mean square of the slope along both axes, by differences of neighbours.
    fn slope(gap: &Field, pitch: f64) -> f64 {
        let [nx, ny] = [gap.nrows(), gap.ncols()];
        let squares = gap.indexed_iter().map(|((i, j), h)| {
            let along = [gap[[(i + 1) % nx, j]] - h, gap[[i, (j + 1) % ny]] - h];
            along[0] * along[0] + along[1] * along[1]
        });
        (squares.sum::<f64>() / gap.len() as f64).sqrt() / pitch
    }

    #[test]
    fn a_surface_is_the_same_on_a_finer_grid() {
        let [coarse, fine] =
            [64, 128].map(|side| Device::HOST.gap_of(&rough(side), &levels(side)[0]).unwrap());
        assert!((slope(&fine, 1.0 / 128.0) / 0.1 - 1.0).abs() < 0.05, "{}", slope(&fine, 1.0 / 128.0));
        let offset = fine[[0, 0]] - coarse[[0, 0]];
        let largest = coarse.iter().fold(0.0, |m: f64, h| m.max(*h));
        for ((i, j), h) in coarse.indexed_iter() {
            assert!((fine[[2 * i, 2 * j]] - offset - h).abs() < 1e-12 * largest, "{i}, {j}");
        }
    }

    #[test]
    fn a_rough_contact_is_told_in_numbers() {
        let (side, mean) = (64, 0.01);
        let accuracy = Accuracy { tolerance: 1e-7, max_convolutions: 1000, precision: Precision::Double };
        let grids = levels(side);
        let found = Device::HOST.press(&rough(side), &grids, mean, &accuracy, (0.2, 400), &()).unwrap();
        assert!(found.residual < 1e-7 && found.mean_gap > 0.0 && found.max_pressure > mean);
        let counted: u64 = found.histogram.iter().sum();
        assert_eq!(counted as f64, found.area * (side * side) as f64);
        // The pressures of the bins carry the load.
        let width = 0.2 / 400.0;
        let borne: f64 =
            found.histogram.iter().enumerate().map(|(bin, n)| (bin as f64 + 0.5) * width * *n as f64).sum();
        assert!((borne / (side * side) as f64 / mean - 1.0).abs() < 0.01, "{borne}");
        // The same contact from heights.
        let gap = Device::HOST.gap_of(&rough(side), &grids[0]).unwrap();
        let upper = asperity_base::grid::CellValues::Uniform(f64::INFINITY);
        let problem = Problem {
            contacts: &[crate::Contact { gap: &gap, upper: &upper, start: None }],
            grids: &grids,
            control: Control::PressureSum(mean * gap.len() as f64),
            accuracy,
        };
        let same = Device::HOST.solve(&problem, &()).unwrap();
        assert_eq!(same.residual, found.residual);
    }

    #[test]
    fn memory_is_that_of_the_fields() {
        let side = 64.0f64 * 64.0;
        assert!(memory(side, side, false, 0, Precision::Double) / side <= 57.0);
        assert!(memory(side, side, false, 0, Precision::Single) / side <= 32.0);
    }
}
