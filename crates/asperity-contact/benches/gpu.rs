//! Contacts on a GPU: agreement with the processor, time and memory. Run by `benches/gpu/device.sh`, which
//! takes the program to a machine with a device.
//!
//! Arguments are the parts to run: `agree`, `periodic`, `free`, `pass`, `challenge`; all without one. `steps` counts on the
//! processor, and needs no device.

#![expect(clippy::print_stdout, reason = "a measurement prints its result")]

use std::time::Instant;

use asperity_base::{Field, Grid};
use asperity_contact::kernel::response;
use asperity_contact::material::{Coating, Material};
use asperity_contact::motion::{Motion, Pair, Simulation, Strategy};
use asperity_contact::operator::{Boundary, Operators};
use asperity_contact::solver::{Bounds, Control, Device, Params, solve_normal};
use asperity_gpu::{Accuracy, Compliance, Harmonics, Level, Precision, Rough};
use asperity_surface::{Amplitude, SelfAffine, Topography};

/// Composite modulus and rms slope of the timed contacts, in cells.
const MODULUS: f64 = 1.0;
const SLOPE: f64 = 0.1;
/// Mean pressures over the modulus that press about 5, 20 and 60 % of the area into contact.
const PRESSURES: [(f64, &str); 3] = [(0.0023, "5 %"), (0.0095, "20 %"), (0.036, "60 %")];
const TOLERANCE: f64 = 1e-6;

type Outcome = Result<(), Box<dyn std::error::Error>>;
/// A part of the measurements on a device.
type Part<'a> = (&'a str, &'a dyn Fn(&asperity_gpu::Device) -> Outcome);

fn main() -> Outcome {
    let asked: Vec<String> = std::env::args().skip(1).filter(|arg| !arg.starts_with("--")).collect();
    if asked == ["steps"] {
        return steps();
    }
    let wanted = |part: &str| asked.is_empty() || asked.iter().any(|each| each == part);
    let device = asperity_gpu::Device::cuda()?;
    let card = device.card()?.expect("a GPU has a card");
    let [major, minor] = card.capability.unwrap_or_default();
    println!(
        "{}, compute capability {major}.{minor}, {:.1} GB, {:.1} GB free; the processor has {} threads",
        card.name,
        card.memory / 1e9,
        card.free / 1e9,
        rayon_core::current_num_threads()
    );
    let parts: [Part; 5] = [
        ("agree", &agree),
        ("periodic", &periodic),
        ("pass", &pass),
        ("free", &free),
        ("challenge", &challenge),
    ];
    for (name, part) in parts {
        if wanted(name) {
            println!("\n== {name}");
            let began = Instant::now();
            // A part that fails does not keep the others from their turn.
            if let Err(error) = part(&device) {
                println!("failed: {error}");
            }
            println!("-- {name}: {:.1} s", began.elapsed().as_secs_f64());
        }
    }
    Ok(())
}

/// A self-affine gap with the given rms slope.
fn rough(grid: &Grid, seed: u64) -> Result<Field, Box<dyn std::error::Error>> {
    let shortest = Some(8.0 * grid.pitch[0]);
    let form = SelfAffine { hurst: 0.8, rolloff: None, shortest, amplitude: Amplitude::Sdq(SLOPE) };
    let heights = form.generate(grid, seed)?.into_heights();
    Ok(heights.iter().copied().fold(f64::NEG_INFINITY, f64::max) - heights)
}

fn largest(field: &Field) -> f64 {
    field.iter().fold(0.0, |most, value| f64::max(most, value.abs()))
}

/// Twenty contacts on the card and on the processor.
fn agree(_: &asperity_gpu::Device) -> Outcome {
    println!(
        "| grid | boundary | cap | control | η | difference of p / max p | of δ / max u | convolutions | again the same |"
    );
    println!("|---|---|---|---|---|---|---|---|---|");
    for seed in 0..20 {
        let shape = [[64, 64], [128, 96], [250, 130], [77, 61], [256, 256]][seed % 5];
        let boundary = [Boundary::PERIODIC, Boundary::FREE][seed / 5 % 2];
        let grid = Grid::new(shape, [1.0, 1.0])?;
        let gap = rough(&grid, seed as u64)?;
        let cap = [f64::INFINITY, 0.08][seed % 2];
        let bounds = match seed % 4 {
            3 => Bounds::up_to(Field::from_shape_fn(shape, |(i, j)| {
                0.05 + 0.01 * ((3 * i + 5 * j) % 7) as f64
            })),
            _ => Bounds::up_to(cap),
        };
        let control = if seed < 14 {
            Control::Load(PRESSURES[seed % 3].0 * grid.area())
        } else {
            Control::Approach(0.5 * gap.mean().unwrap_or(0.0))
        };
        let soft = Material::elastic(0.9 * MODULUS, 0.3)?;
        let coated = soft.coated(Coating::new(5.0, 4.0 * MODULUS, 0.25)?);
        let rigid = Material::elastic(f64::INFINITY, 0.3)?;
        let operators = match seed % 5 {
            1 => Operators::new(grid, response(&coated, &rigid)?, boundary),
            _ => Operators::new(grid, MODULUS, boundary),
        };
        let solve = |device: Device| {
            let params = Params::new().with_tolerance(TOLERANCE).with_device(device);
            solve_normal(device.operator(&operators, shape).as_mut(), &gap, &bounds, control, None, &params)
        };
        let (found, again, expected) = (solve(Device::Cuda)?, solve(Device::Cuda)?, solve(Device::Cpu)?);
        println!(
            "| {} × {}{} | {} | {} | {} | {:.1e} | {:.1e} | {:.1e} | {:.0} | {} |",
            shape[0],
            shape[1],
            if seed % 5 == 1 { ", coated" } else { "" },
            if boundary.leaves_mean_free() { "periodic" } else { "free" },
            if seed % 4 == 3 {
                "map"
            } else if cap.is_finite() {
                "one"
            } else {
                "none"
            },
            if seed < 14 { "load" } else { "approach" },
            found.residual,
            largest(&(&found.pressure - &expected.pressure)) / largest(&expected.pressure),
            (found.approach - expected.approach).abs() / largest(&expected.displacement),
            found.stats.convolutions,
            if found.pressure == again.pressure { "yes" } else { "NO" },
        );
    }
    Ok(())
}

/// The grids of a periodic cascade.
fn levels(side: usize, pitch: f64, modulus: f64) -> Vec<Level> {
    let mut grids = Vec::new();
    let (mut side, mut pitch) = (side, pitch);
    loop {
        grids.push(Level {
            padded: [side; 2],
            pitch: [pitch; 2],
            compliance: Compliance::Harmonic,
            harmonics: Harmonics::HalfSpaces(modulus),
        });
        if side < 64 {
            return grids;
        }
        (side, pitch) = (side / 2, 2.0 * pitch);
    }
}

/// The surface of the timed contacts, which is made on the device.
fn on_device(side: usize) -> Rough {
    let longest = side as f64 / 4.0;
    Rough { side, pitch: 1.0, hurst: 0.8, longest, shortest: 8.0, slope: SLOPE, seed: 11 }
}

fn median(mut times: Vec<f64>) -> f64 {
    times.sort_by(f64::total_cmp);
    times[times.len() / 2]
}

fn accuracy(precision: Precision, tolerance: f64) -> Accuracy {
    Accuracy { tolerance, max_convolutions: 3000, precision }
}

/// Periodic contacts of 512² to 32768².
fn periodic(device: &asperity_gpu::Device) -> Outcome {
    println!(
        "| grid | area | iterations | convolutions | η | solution, ms | of these transforms, ms | set-up, ms | a convolution in single, double, ms | bytes a cell | processor, ms |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|---|");
    for side in [512usize, 1024, 2048, 4096, 8192, 16384, 32768] {
        let rough = on_device(side);
        let grids = levels(side, 1.0, MODULUS);
        let convolution = device.time_of_convolutions(&grids[0], side, 10)?;
        for (pressure, _) in PRESSURES {
            if side == 32768 && pressure != PRESSURES[1].0 {
                continue;
            }
            let press = || {
                let accuracy = accuracy(Precision::Double, TOLERANCE);
                device.press(&rough, &grids, pressure * MODULUS, &accuracy, (1.0, 1), &())
            };
            let repeats = match side {
                ..2049 => 7,
                2049..8193 => 5,
                8193..16385 => 3,
                _ => 1,
            };
            let found: Vec<_> = (0..repeats).map(|_| press()).collect::<Result<_, _>>()?;
            let [made, solved] = [0, 1].map(|n| median(found.iter().map(|each| each.times[n]).collect()));
            let found = &found[0];
            let processor = if side <= 2048 || (side == 4096 && pressure == PRESSURES[1].0) {
                let grid = Grid::new([side; 2], [1.0; 2])?;
                let gap = device.gap_of(&rough, &grids[0])?;
                let mut operator = Operators::new(grid, MODULUS, Boundary::PERIODIC).on(grid.shape);
                let control = Control::Load(pressure * grid.area());
                let params = Params::new().with_tolerance(TOLERANCE);
                let began = Instant::now();
                let expected =
                    solve_normal(operator.as_mut(), &gap, &Bounds::ELASTIC, control, None, &params)?;
                let time = began.elapsed().as_secs_f64();
                let area = expected.contact_cells() as f64 / gap.len() as f64;
                format!("{:.1} (area differs by {:.0e})", 1e3 * time, (area / found.area - 1.0).abs())
            } else {
                String::new()
            };
            println!(
                "| {side}² | {:.2} % | {} | {:.1} | {:.1e} | {:.1} | {:.1} | {:.1} | {:.3}, {:.3} | {:.1} | {processor} |",
                100.0 * found.area,
                found.cost.iterations,
                found.cost.convolutions,
                found.residual,
                1e3 * solved,
                1e3 * convolution[0] * found.cost.convolutions,
                1e3 * made,
                1e3 * convolution[0],
                1e3 * convolution[1],
                found.bytes_a_cell,
            );
        }
    }
    Ok(())
}

/// Steps and convolutions of periodic contacts, in the plain loops of the processor.
fn steps() -> Outcome {
    println!(
        "| grid | steps and convolutions at {}, {}, {} |",
        PRESSURES[0].1, PRESSURES[1].1, PRESSURES[2].1
    );
    println!("|---|---|");
    for side in [512usize, 1024, 2048] {
        print!("| {side}² |");
        for (pressure, _) in PRESSURES {
            let accuracy = accuracy(Precision::Double, TOLERANCE);
            let grids = levels(side, 1.0, MODULUS);
            let host = asperity_gpu::Device::HOST;
            let found = host.press(&on_device(side), &grids, pressure * MODULUS, &accuracy, (1.0, 1), &())?;
            print!(" {}, {:.0};", found.cost.iterations, found.cost.convolutions);
        }
        println!(" |");
    }
    Ok(())
}

/// A free contact of 8192², from heights on the processor to fields on the processor.
fn free(device: &asperity_gpu::Device) -> Outcome {
    println!("| grid | area | iterations | convolutions | η | from heights to fields, s |");
    println!("|---|---|---|---|---|---|");
    for side in [1024usize, 4096, 8192] {
        let rough = on_device(side);
        let gap = device.gap_of(&rough, &levels(side, 1.0, MODULUS)[0])?;
        let grid = Grid::new([side; 2], [1.0; 2])?;
        let operators = Operators::new(grid, MODULUS, Boundary::FREE);
        let params = Params::new().with_tolerance(TOLERANCE).with_device(Device::Cuda);
        let control = Control::Load(PRESSURES[1].0 * grid.area());
        let began = Instant::now();
        let mut operator = Device::Cuda.operator(&operators, grid.shape);
        let found = solve_normal(operator.as_mut(), &gap, &Bounds::ELASTIC, control, None, &params)?;
        println!(
            "| {side}² | {:.2} % | {} | {:.1} | {:.1e} | {:.2} |",
            100.0 * found.contact_cells() as f64 / gap.len() as f64,
            found.stats.iterations,
            found.stats.convolutions,
            found.residual,
            began.elapsed().as_secs_f64()
        );
    }
    Ok(())
}

/// A pass of two bodies of 256 × 256 cells over each other.
fn pass(_: &asperity_gpu::Device) -> Outcome {
    println!("| device | positions | mean load / W − 1 | largest η | first solution, s | again, s |");
    println!("|---|---|---|---|---|---|");
    for device in [Device::Cuda, Device::Cpu] {
        let grid = Grid::new([256, 256], [1e-6, 1e-6])?;
        let surface = |seed: u64| -> Result<Topography, Box<dyn std::error::Error>> {
            Ok(Topography::new(grid, -rough(&Grid::new([256, 256], [1.0; 2])?, seed)? * 1e-6)?)
        };
        let steel = Material::elastic(210e9, 0.3)?;
        let pair = Pair::new(surface(3)?, surface(4)?, [&steel, &steel])?;
        let load = 0.0095 * 115e9 * grid.area() * 0.5;
        let motion = Motion::new(Strategy::Overlap, Control::Load(load)).with_stride(4);
        let params = Params::new().with_tolerance(TOLERANCE).with_device(device);
        let simulation = Simulation::new(pair, Boundary::FREE, motion, params)?;
        let mut times = Vec::new();
        let mut last = None;
        for _ in 0..2 {
            let began = Instant::now();
            last = Some(simulation.solve(&())?);
            times.push(began.elapsed().as_secs_f64());
        }
        let pass = last.expect("two passes");
        let contacts = pass.contacts();
        let mean = contacts.iter().map(|contact| contact.load).sum::<f64>() / contacts.len() as f64;
        let residual = contacts.iter().map(|contact| contact.residual).fold(0.0, f64::max);
        println!(
            "| {device:?} | {} | {:.1e} | {residual:.1e} | {:.3} | {:.3} |",
            contacts.len(),
            mean / load - 1.0,
            times[0],
            times[1]
        );
    }
    Ok(())
}

/// The Contact-Mechanics Challenge without adhesion, in single and in double precision.
fn challenge(device: &asperity_gpu::Device) -> Outcome {
    const EXTENT: f64 = 100e-6;
    const MODULUS: f64 = 25e6;
    println!(
        "| grid | precision | pitch, nm | area, % | mean gap, nm | max p / E* | iterations | convolutions | η | surface and memory, s | solution, s | bytes a cell |"
    );
    println!("|---|---|---|---|---|---|---|---|---|---|---|---|");
    let mut histograms = Vec::new();
    for (side, precision, tolerance) in [
        (8192usize, Precision::Double, 1e-6),
        (8192, Precision::Single, 1e-4),
        (16384, Precision::Double, 1e-6),
        (16384, Precision::Single, 1e-4),
        (32768, Precision::Double, 1e-6),
        (32768, Precision::Single, 1e-4),
        (65536, Precision::Single, 1e-3),
    ] {
        let pitch = EXTENT / side as f64;
        let rough = Rough { side, pitch, hurst: 0.8, longest: 20e-6, shortest: 0.1e-6, slope: 1.0, seed: 1 };
        let grids = levels(side, pitch, MODULUS);
        let accuracy = accuracy(precision, tolerance);
        let found = match device.press(&rough, &grids, 0.01 * MODULUS, &accuracy, (1.5 * MODULUS, 30), &()) {
            Ok(found) => found,
            Err(error) => {
                println!("| {side}² | {precision:?} | {error} |");
                continue;
            }
        };
        println!(
            "| {side}² | {precision:?} | {:.2} | {:.4} | {:.2} | {:.3} | {} | {:.1} | {:.1e} | {:.2} | {:.2} | {:.1} |",
            1e9 * pitch,
            100.0 * found.area,
            1e9 * found.mean_gap,
            found.max_pressure / MODULUS,
            found.cost.iterations,
            found.cost.convolutions,
            found.residual,
            found.times[0],
            found.times[1],
            found.bytes_a_cell,
        );
        histograms.push((side, precision, found.histogram));
    }
    println!("\nShare of all cells by p/E*, in bins of 0.05:");
    for (side, precision, histogram) in histograms {
        let cells = (side * side) as f64;
        let shares: Vec<String> =
            histogram.iter().map(|count| format!("{:.3e}", *count as f64 / cells)).collect();
        println!("{side}² {precision:?}: {}", shares.join(" "));
    }
    Ok(())
}
