//! Warnings about the samples of a law, and about what it leaves out.

use crate::case::Case;

/// Letters by which warnings are taken to be the same.
const SAME_LETTERS: usize = 32;

/// Returns what the law of a joint of this case leaves out.
pub(super) fn left_out(case: &Case, yields: bool) -> Vec<String> {
    let attract = !case.interface.is_empty();
    let sentences = [
        (
            yields,
            "cells yield: the law holds while the bodies are loaded for the first time, and theories are those of elastic bodies",
        ),
        (
            attract,
            "the law begins above a pressure of 0: attraction beyond is not in it, and theories know no attraction",
        ),
        (case.is_coated(), "theories take the bodies without their layers"),
    ];
    sentences.into_iter().filter(|(holds, _)| *holds).map(|(_, sentence)| sentence.to_owned()).collect()
}

/// Brings the warnings of the samples together: each is told once, with the number of samples that have it.
pub(super) fn of_samples(warnings: &[&[String]]) -> Vec<String> {
    let letters =
        |text: &str| text.chars().filter(|c| c.is_alphabetic()).take(SAME_LETTERS).collect::<String>();
    let mut found: Vec<(String, &str, usize)> = Vec::new();
    for warning in warnings.iter().copied().flatten() {
        let key = letters(warning);
        match found.iter_mut().find(|(known, ..)| *known == key) {
            Some((_, _, count)) => *count += 1,
            None => found.push((key, warning, 1)),
        }
    }
    let told = |(_, warning, count): (String, &str, usize)| match (warnings.len(), count) {
        (1, _) => warning.to_owned(),
        (samples, count) => format!("{} of {samples} samples: {warning}", count.min(samples)),
    };
    found.into_iter().map(told).collect()
}

#[cfg(test)]
mod tests {
    use super::of_samples;

    #[test]
    fn a_warning_of_several_samples_is_told_once() {
        let of = |texts: &[&str]| texts.iter().map(|text| (*text).to_owned()).collect::<Vec<_>>();
        let warnings = [
            of(&["the mesh has 4.8 cells", "point 3: it is hot"]),
            of(&["the mesh has 5 cells"]),
            Vec::new(),
        ];
        let warnings = warnings.each_ref().map(Vec::as_slice);
        assert_eq!(
            of_samples(&warnings),
            ["2 of 3 samples: the mesh has 4.8 cells", "1 of 3 samples: point 3: it is hot"]
        );
        assert_eq!(of_samples(&warnings[..1]), ["the mesh has 4.8 cells", "point 3: it is hot"]);
    }
}
