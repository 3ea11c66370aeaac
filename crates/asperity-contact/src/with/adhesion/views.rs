//! Attraction in words.

use super::AdhesionSummary;
use crate::motion::AdhesionRecord;
use crate::units::{Dimension, format};
use crate::with::views::Answer;

/// Returns what a contact at rest of bodies that attract each other shows: their pull-off if they retreat, else their attraction.
pub fn answers(numbers: Option<&AdhesionSummary>, record: &AdhesionRecord) -> Vec<Answer> {
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
