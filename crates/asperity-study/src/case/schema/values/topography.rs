//! Values of `[topography]`.

use crate::case::cursor::Entry;
use asperity_base::choice::choice;
use asperity_base::error::Result;
use asperity_base::grid::MAX_CELLS;
use asperity_base::units::Dimension;
use asperity_surface::Level;

/// Method of generating a random topography.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::case) enum Method {
    LowPass,
    Autocorrelation,
    SelfAffine,
}

choice!(Method: "low-pass" => LowPass, "autocorrelation" => Autocorrelation, "self-affine" => SelfAffine);

/// A [`Form`] without its parameters.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(in crate::case) enum Shape {
    Sphere,
    Ellipsoid,
    Cylinder,
    Cone,
    Flat,
    Sinusoid,
    Grooves,
}

choice!(
    Shape: "sphere" => Sphere,
    "ellipsoid" => Ellipsoid,
    "cylinder" => Cylinder,
    "cone" => Cone,
    "flat" => Flat,
    "sinusoid" => Sinusoid,
    "grooves" => Grooves
);

/// The part of a topography to keep.
pub(in crate::case) fn window(entry: &Entry<'_>) -> Result<[usize; 4]> {
    let window: [usize; 4] = entry.array("four whole numbers [x0, y0, nx, ny]", |item| item.count(0))?;
    if window[2..].contains(&0) {
        return Err(entry.unexpected("a window [x0, y0, nx, ny] of at least one sample", None));
    }
    Ok(window)
}

/// Reads a word of [`Level`]; each order of a polynomial has its own word.
pub(in crate::case) fn level(entry: &Entry<'_>) -> Result<Level> {
    if let Some(level) = entry.text().ok().and_then(|text| text.parse().ok()) {
        return Ok(level);
    }
    let choices = Level::WORDS.map(|word| (word, Level::None));
    let hint = || format!("the order of a polynomial is from 0 to {}", Level::MAX_ORDER);
    match entry.text() {
        Ok(text) if text.starts_with("polynomial") => {
            Err(entry.unexpected("a polynomial such as \"polynomial-3\"", Some(hint())))
        }
        _ => entry.word(&choices),
    }
}

/// Numbers of cells along x and y.
pub(in crate::case) fn shape(entry: &Entry<'_>) -> Result<[usize; 2]> {
    const EXPECTED: &str = "two whole numbers of at least 1, such as [256, 256]";
    let whole = |item: &Entry<'_>| item.whole(0).map(|cells| usize::try_from(cells).unwrap_or(usize::MAX));
    let shape: [usize; 2] = entry.array(EXPECTED, whole)?;
    match shape[0].checked_mul(shape[1]) {
        Some(0) => Err(entry.unexpected(EXPECTED, None)),
        Some(cells) if cells <= MAX_CELLS => Ok(shape),
        _ => Err(entry.unexpected("a grid of at most 2³² cells", None)),
    }
}

/// The radii of curvature of an ellipsoid.
pub(in crate::case) fn radii(entry: &Entry<'_>) -> Result<[f64; 2]> {
    const EXPECTED: &str = "two radii of curvature, along x and along y, such as [\"1 mm\", \"2 mm\"]";
    if !entry.is_array() {
        let hint = "a body of one radius is a `form = \"sphere\"`".to_owned();
        return Err(entry.unexpected(EXPECTED, Some(hint)));
    }
    entry.array(EXPECTED, |item| item.positive(Dimension::Length))
}
