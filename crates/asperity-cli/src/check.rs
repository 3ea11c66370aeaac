//! `asperity check`.

use std::fmt::Write as _;

use asperity::study::{SurfaceInput, bodies, estimate, json_schema};
use asperity::units::bytes;
use asperity_report::check::{Row, rows};
use asperity_report::words::clipped;

use crate::args::Check;
use crate::machine::OnDevice;
use crate::report::{Outcome, note, print};
use crate::{machine, place};

pub(crate) fn check(arguments: &Check) -> Outcome {
    let Some(path) = &arguments.case else {
        return print(&format!("{:#}\n", json_schema()));
    };
    let case = place::case_on(path, "check", arguments.device)?;
    let demand = machine::demand(&case)?;
    let bodies = bodies(&case, SurfaceInput::default())?;
    let estimate = estimate(&case, &bodies)?;
    let device = machine::device(&case)?;
    let mut rows = rows(&case, &bodies, &estimate, &demand);
    if let Some(device) = &device {
        add_device(&mut rows, device);
    }
    let mut page = format!("{}\n\n", case.title);
    rows.iter().for_each(|(name, text)| _ = writeln!(page, "{name:<8} {text}"));
    print(&page)?;
    for warning in estimate.warnings.iter().chain(&estimate.predicted) {
        note(&format!("warning: {}", clipped(warning)));
    }
    Ok(())
}

/// Adds the device after the cost, which is that of the processor.
fn add_device(rows: &mut Vec<Row>, device: &OnDevice) {
    let time = rows.iter().position(|(name, _)| *name == "time").expect("each case takes time");
    rows[time].1.push_str(", on the processor");
    rows.insert(time + 1, ("device", on_device(device)));
}

fn on_device(device: &OnDevice) -> String {
    let OnDevice { card, needed } = device;
    let capability = card
        .capability
        .map_or_else(String::new, |[major, minor]| format!(", compute capability {major}.{minor}"));
    format!(
        "{}{capability}; the contact takes {} of {} that are free",
        card.name,
        bytes(*needed),
        bytes(card.free)
    )
}
