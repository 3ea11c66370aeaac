//! The thickness up to which a film is as stiff as its body.

use crate::motion::{PassRecord, UpdateRecord};
use crate::units::{Dimension, Metre, format};
use crate::with::ChangedSurfaces;

/// Returns the mean thickness of the film on each body, and the Sq of the body.
pub(super) fn in_pass(pass: &PassRecord, surfaces: &ChangedSurfaces) -> [[Metre; 2]; 2] {
    let [lower, upper] = surfaces.sq;
    pass.running.map_or([[0.0; 2]; 2], |running| {
        [[running.laws.mean_film_lower, lower], [running.laws.mean_film_upper, upper]]
    })
}

/// Returns the mean thickness of the film in contact on each body, and the Sq of the body.
pub(super) fn in_update(update: &UpdateRecord, surfaces: &ChangedSurfaces) -> [[Metre; 2]; 2] {
    let [lower, upper] = surfaces.sq;
    [[update.laws.mean_film_lower, lower], [update.laws.mean_film_upper, upper]]
}

pub(super) fn beyond(body: &str, thickness: Metre, sq: Metre) -> String {
    let [thickness, sq] = [thickness, sq].map(|value| format(value, Dimension::Length));
    format!(
        "the film on the {body} body is {thickness} thick, and the body has an Sq of {sq}: the contact takes the film to be as stiff as the \
         body, which holds for films thinner than the roughness"
    )
}
