//! Attraction in numbers and words.

use super::{AdhesionRange, AdhesionSummary, Attraction};
use crate::adhesion::{AdhesionPassRecord, AdhesionRecord};
use crate::motion::IncrementRecord;
use crate::units::{Dimension, format, format_number};
use crate::with::views::{Answer, Line, OfPoints, RowCell};
use asperity_base::choice::Choice;

/// The numbers that answer the question of the user.
pub(in crate::with) const ANSWERS: [(&str, &str); 2] =
    [("pull_off", "pull-off"), ("work_of_separation", "work of separation")];

/// The numbers in the order of the page, with their names there.
pub(super) const LABELS: [(&str, &str); 9] = [
    ANSWERS[0],
    ANSWERS[1],
    ("tabor", "Tabor's parameter"),
    ("pastewka_robbins", "Pastewka and Robbins"),
    ("range", "range"),
    ("max_tension", "largest tension"),
    ("process_zone", "process zone"),
    ("process_zone_cells", "cells of the process zone"),
    ("full_contact_energy", "energy of full contact"),
];

/// The curve over the points of a sweep.
pub(in crate::with) const OF_POINTS: OfPoints = OfPoints {
    column: "adhesive_load",
    label: "adhesive load",
    may_be_log: false,
    value: |point| point.interface.map(|record| record.adhesive_load),
    beside: &[],
};

impl Attraction {
    /// Describes it for `asperity check`, with its `numbers` if they are known.
    pub fn describe(&self, numbers: Option<&AdhesionSummary>) -> String {
        let length = |value| format(value, Dimension::Length);
        let work = format(self.work, Dimension::SurfaceEnergy);
        let mut text = format!("work {work}, {}", self.potential.word());
        let Some(numbers) = numbers else { return text };
        let of_the_grid = if self.range == AdhesionRange::Grid { " from the grid" } else { "" };
        text += &format!(
            ", range {}{of_the_grid}, tension up to {}; process zone {}, {:.2} cells",
            length(numbers.range),
            format(numbers.max_tension, Dimension::Pressure),
            length(numbers.process_zone),
            numbers.process_zone_cells
        );
        if let Some(tabor) = numbers.tabor {
            text += &format!("; Tabor's parameter {}", format_number(tabor));
        }
        if let Some(parameter) = numbers.pastewka_robbins {
            text += &format!("; Pastewka and Robbins {} (sticky below 1)", format_number(parameter));
        }
        if let Some(energy) = numbers.full_contact_energy {
            text += &format!("; full contact stores {} of the work", format_number(energy));
        }
        text
    }
}

impl AdhesionSummary {
    /// Returns the numbers for the terminal: what a retreat shows, and Tabor's parameter.
    pub fn lines(&self) -> Vec<Line> {
        let pull_off = self.pull_off.map(|load| Line::new("pull-off", format(load, Dimension::Force)));
        let separation = self.work_of_separation.map(|work| {
            let work = format(work, Dimension::Energy);
            Line::new("separation", format!("{work} of work under loads that pull"))
        });
        let tabor = self.tabor.map(|tabor| Line::new("Tabor's parameter", format_number(tabor)));
        [pull_off, separation, tabor].into_iter().flatten().collect()
    }
}

/// Returns the numbers of the interface of a contact at rest.
pub fn interface_lines(record: &AdhesionRecord) -> Vec<Line> {
    let energy = |value| format(value, Dimension::Energy);
    let mut lines = vec![
        Line::new("least pressure", format(record.min_pressure, Dimension::Pressure)),
        Line::new("adhesive load", format(record.adhesive_load, Dimension::Force)),
        Line::new("adhesion energy", energy(record.adhesion_energy)),
    ];
    if record.jumps > 0 {
        let jumps = if record.jumps == 1 { "jump" } else { "jumps" };
        let lost = format!("{} in {} {jumps}", energy(record.energy_lost), record.jumps);
        lines.push(Line::new("energy lost", lost));
    }
    lines
}

/// Returns the number of the interface in the row of a point of a sweep on the terminal.
pub fn interface_cell(record: &AdhesionRecord) -> RowCell {
    RowCell { head: "adhesive", column: "adhesive_load", value: record.adhesive_load, is_answer: false }
}

/// Returns the numbers of the interface in the row of a pass on the terminal.
pub fn interface_cells(record: &AdhesionPassRecord) -> Vec<RowCell> {
    let (head, column) = ("adhesive", "mean_adhesive_load");
    let load = RowCell { head, column, value: record.mean_adhesive_load, is_answer: false };
    let (head, column) = ("drag", "adhesive_drag");
    let drag = RowCell { head, column, value: record.adhesive_drag, is_answer: true };
    [load].into_iter().chain((record.adhesive_drag > 0.0).then_some(drag)).collect()
}

/// Returns the jumps of a loading, one by one.
pub(in crate::with) fn jumps(increments: &[IncrementRecord]) -> Vec<Line> {
    let jump = |pair: &[IncrementRecord]| {
        let [before, after] = [&pair[0], &pair[1]];
        let record = after.interface.filter(|record| record.jumps > 0)?;
        let text = format!(
            "load {} → {}, area of contact {} → {}, energy lost {}",
            format(before.load, Dimension::Force),
            format(after.load, Dimension::Force),
            format(before.contact_area, Dimension::Area),
            format(after.contact_area, Dimension::Area),
            format(record.energy_lost, Dimension::Energy)
        );
        Some(Line::new(format!("jump in increment {}", after.increment), text))
    };
    increments.windows(2).filter_map(jump).collect()
}

/// Returns what a contact at rest of bodies that attract each other shows: their pull-off if they retreat,
/// else their attraction.
pub(in crate::with) fn answers(numbers: Option<&AdhesionSummary>, record: &AdhesionRecord) -> Vec<Answer> {
    let retreat = numbers.and_then(|numbers| numbers.pull_off.zip(numbers.work_of_separation));
    let Some((least, work)) = retreat else {
        let value = format(record.adhesive_load, Dimension::Force);
        return vec![Answer {
            name: "adhesive load".into(),
            about: "Force of the attraction across the gap.".to_owned(),
            sentence: format!("The bodies attract each other with {value} across the gap."),
            value,
        }];
    };
    if least >= 0.0 {
        return vec![Answer {
            name: "pull-off".into(),
            value: "none".to_owned(),
            about: "The retreat takes no pull.".to_owned(),
            sentence: "The bodies separate without a pull.".to_owned(),
        }];
    }
    let (pull, work) = (format(-least, Dimension::Force), format(work, Dimension::Energy));
    let lost = (record.jumps > 0).then(|| {
        let jumps = if record.jumps == 1 { "a jump".to_owned() } else { format!("{} jumps", record.jumps) };
        format!("{} is lost in {jumps}", format(record.energy_lost, Dimension::Energy))
    });
    vec![
        Answer {
            name: "pull-off force".into(),
            about: "Largest pull of the retreat.".to_owned(),
            sentence: format!("The bodies come apart at a pull of {pull}."),
            value: pull,
        },
        Answer {
            name: "work of separation".into(),
            about: match &lost {
                Some(lost) => format!("Of the loads that pull, over the retreat; {lost}."),
                None => "Of the loads that pull, over the retreat.".to_owned(),
            },
            sentence: match &lost {
                Some(lost) => format!("Their separation takes {work} of work; {lost}."),
                None => format!("Their separation takes {work} of work."),
            },
            value: work,
        },
    ]
}
