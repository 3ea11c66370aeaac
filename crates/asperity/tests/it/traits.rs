//! A trait has two implementations, or a reason.

use std::collections::{BTreeMap, BTreeSet};
use std::fs;

use crate::support::{crates, files_below};

const WITH_A_REASON: [&str; 9] = [
    // A macro or a generic struct implements it for many types.
    "Listed",
    "Look",
    "Precision",
    "Reported",
    // Its implementation stands in a crate or module that uses this one: fatigue, files of states, cases,
    // the page.
    "Memory",
    "StateReader",
    "StateWriter",
    "Value",
    "Witness",
];

#[test]
fn a_trait_has_two_implementations_or_a_reason() {
    let folders = crates().into_iter().map(|(_, source)| source);
    let texts = folders.flat_map(|folder| files_below(&folder)).map(|path| fs::read_to_string(path).unwrap());
    let text = texts.collect::<Vec<_>>().join("\n");
    let mut implementations: BTreeMap<&str, usize> =
        text.lines().filter_map(declared).map(|name| (name, 0)).collect();
    let implemented = text.split("impl").skip(1).filter_map(implemented);
    let derived = text.split("derive(").skip(1).flat_map(|rest| rest.split(')').next().unwrap().split(", "));
    for name in implemented.chain(derived) {
        if let Some(count) = implementations.get_mut(name) {
            *count += 1;
        }
    }
    assert!(implementations.len() > 30, "{implementations:?}");
    let few = implementations.into_iter().filter(|(_, count)| *count < 2).map(|(name, _)| name);
    assert_eq!(few.collect::<BTreeSet<_>>(), BTreeSet::from(WITH_A_REASON));
}

/// The trait that a line declares.
fn declared(line: &str) -> Option<&str> {
    let (before, name) = line.split_once("trait ")?;
    let is_declared = before.is_empty() || before.starts_with("pub") && !before.contains('"');
    name.split(|c: char| !c.is_alphanumeric()).next().filter(|_| is_declared)
}

/// The trait of an implementation, from its text after `impl`.
fn implemented(text: &str) -> Option<&str> {
    let (head, _) =
        text.split_once('{')?.0.split_once(" for ").filter(|(head, _)| !head.contains(['.', ';']))?;
    // Its generics come after its name.
    let name = if head.ends_with('>') { head.rsplit_once('<')?.0 } else { head };
    name.rsplit(|c: char| !c.is_alphanumeric()).next()
}
