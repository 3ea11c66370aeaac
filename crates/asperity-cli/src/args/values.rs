//! Values of arguments: quantities with units, pairs of them, shapes, words.

use crate::threads::MAX_THREADS;
use asperity::Choice;
use asperity::operator::{Boundary, Edge};
use asperity::surface::Resample;
use asperity::units::{self, Dimension, MAX_COUNT, NUMBERS, UnitError};
use clap::builder::{PossibleValuesParser, TypedValueParser};

/// A number of threads.
pub(crate) fn threads(text: &str) -> Result<usize, String> {
    let count = text.parse().ok().filter(|count| (1..=MAX_THREADS).contains(count));
    count.ok_or_else(|| format!("expected a whole number from 1 to {MAX_THREADS}"))
}

pub(crate) fn quantity(text: &str, dimension: Dimension) -> Result<f64, String> {
    units::parse(text, dimension).map_err(|error| in_words(&error))
}

fn in_words(error: &UnitError) -> String {
    error.hint().map_or_else(|| error.to_string(), |hint| format!("{error}; {hint}"))
}

pub(crate) fn positive_length(text: &str) -> Result<f64, String> {
    above_zero(quantity(text, Dimension::Length)?)
}

/// A unit of length, by its name or as a length.
pub(crate) fn unit_of_length(text: &str) -> Result<f64, String> {
    above_zero(units::parse_unit(text, Dimension::Length).map_err(|error| in_words(&error))?)
}

fn above_zero(length: f64) -> Result<f64, String> {
    let range = Dimension::Length.range();
    match length {
        length if range.holds(length) => Ok(length),
        length if length > 0.0 => Err(format!("expected a length of {range}")),
        _ => Err("expected a length above 0 such as 0.25um".to_owned()),
    }
}

pub(crate) fn angle(text: &str) -> Result<f64, String> {
    let range = Dimension::Angle.range();
    let angle = range.without_dust(quantity(text, Dimension::Angle)?);
    if range.holds_signed(angle) { Ok(angle) } else { Err(format!("expected an angle of {range}")) }
}

fn pair(text: &str, read: impl Fn(&str) -> Result<f64, String>) -> Result<[f64; 2], String> {
    match text.split(',').collect::<Vec<_>>()[..] {
        [both] => read(both).map(|both| [both; 2]),
        [x, y] => Ok([read(x)?, read(y)?]),
        _ => Err("expected one length, or two with a comma between".to_owned()),
    }
}

/// Two lengths, along x and y, or one for both.
pub(crate) fn lengths(text: &str) -> Result<[f64; 2], String> {
    pair(text, positive_length)
}

pub(crate) fn wavelengths(text: &str) -> Result<[f64; 2], String> {
    pair(text, |text| if text.trim() == "inf" { Ok(f64::INFINITY) } else { positive_length(text) })
}

fn counts<const N: usize>(text: &str, separators: &[char], expected: &str) -> Result<[usize; N], String> {
    let count = |text: &str| text.trim().parse().ok().filter(|count: &usize| *count <= MAX_COUNT);
    let counts: Option<Vec<usize>> = text.split(separators).map(count).collect();
    counts.and_then(|counts| counts.try_into().ok()).ok_or_else(|| format!("expected {expected}"))
}

/// Numbers of cells along x and y.
pub(crate) fn shape(text: &str) -> Result<[usize; 2], String> {
    const EXPECTED: &str = "two whole numbers of at least 1, such as 256x256, and at most 2²⁸ cells";
    const MAX_CELLS: usize = 1 << 28;
    let shape: [usize; 2] = counts(text, &['x', '×', ','], EXPECTED)?;
    match shape[0].checked_mul(shape[1]) {
        Some(1..=MAX_CELLS) => Ok(shape),
        _ => Err(format!("expected {EXPECTED}")),
    }
}

/// A shape, or a pitch.
pub(crate) fn resample(text: &str) -> Result<Resample, String> {
    match shape(text) {
        Ok(shape) => Ok(Resample::Shape(shape)),
        Err(error) if text.contains(['x', '×']) => Err(error),
        Err(_) => lengths(text).map(Resample::Pitch),
    }
}

/// Two quantities of any one kind, the first below the second.
pub(crate) fn range(text: &str) -> Result<[f64; 2], String> {
    const EXPECTED: &str = "two quantities with a comma between, the lower first, such as 0,2GPa";
    const KINDS: [Dimension; 3] = [Dimension::Length, Dimension::Pressure, Dimension::Force];
    let read = |text: &str| KINDS.iter().find_map(|kind| units::parse(text.trim(), *kind).ok());
    let [low, high] = match text.split(',').map(read).collect::<Vec<_>>()[..] {
        [Some(low), Some(high)] => [low, high],
        _ => return Err(format!("expected {EXPECTED}")),
    };
    if low < high { Ok([low, high]) } else { Err(format!("expected {EXPECTED}")) }
}

/// The surroundings along both axes, or along each.
pub(crate) fn boundary(text: &str) -> Result<Boundary, String> {
    let edges: Option<Vec<Edge>> = text.split(',').map(|word| Edge::of_word(word.trim())).collect();
    match edges.as_deref() {
        Some([both]) => Ok(Boundary([*both; 2])),
        Some([x, y]) => Ok(Boundary([*x, *y])),
        _ => Err("expected free or periodic, or one of them for each axis, such as periodic,free".to_owned()),
    }
}

/// A number above 0.
pub(crate) fn factor(text: &str) -> Result<f64, String> {
    let factor = text.parse().ok().filter(|factor: &f64| NUMBERS.holds(*factor));
    factor.ok_or_else(|| format!("expected a number above 0 such as 6, of {NUMBERS}"))
}

/// x0, y0, nx, ny.
pub(crate) fn window(text: &str) -> Result<[usize; 4], String> {
    counts(text, &[','], "four whole numbers x0,y0,nx,ny")
}

/// Parses the word of an option.
pub(crate) fn choice<T: Choice + Send + Sync>() -> impl TypedValueParser<Value = T> {
    PossibleValuesParser::new(T::WORDS.iter().map(|(word, _)| *word))
        .map(|word| T::of_word(&word).expect("only these words pass"))
}

/// Returns the word of the default of an option.
pub(crate) fn default<T: Choice + Default>() -> &'static str {
    T::default().word()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lists_of_numbers_are_read_in_full_or_not_at_all() {
        assert_eq!(shape("256x128").unwrap(), [256, 128]);
        assert_eq!(window("1, 2,3,4").unwrap(), [1, 2, 3, 4]);
        assert_eq!(wavelengths("8um,inf").unwrap(), [8e-6, f64::INFINITY]);
        for text in ["256", "0x4", "4x-4", "4x4x4", "99999999x99999999", ""] {
            assert!(shape(text).is_err(), "{text}");
        }
        assert_eq!(resample("256x128"), Ok(Resample::Shape([256, 128])));
        assert_eq!(resample("0.5um,1um"), Ok(Resample::Pitch([0.5e-6, 1e-6])));
        assert_eq!(range("-20nm, 0.1um").unwrap(), [-20e-9, 0.1e-6]);
        assert_eq!(range("0,2GPa").unwrap(), [0.0, 2e9]);
        assert!(range("2GPa,0").is_err() && range("1").is_err() && range("1 furlong,2").is_err());
        assert!(resample("0x4").is_err() && resample("4x4um").is_err());
        assert_eq!(boundary("periodic").unwrap(), Boundary::PERIODIC);
        assert_eq!(boundary("free, periodic").unwrap(), Boundary([Edge::Free, Edge::Periodic]));
        assert!(boundary("").is_err() && boundary("free,free,free").is_err() && boundary("closed").is_err());
        assert!(lengths("8um,inf").is_err() && lengths("1um,2um,3um").is_err() && lengths("0").is_err());
    }
}
