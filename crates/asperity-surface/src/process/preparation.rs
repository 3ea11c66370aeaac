//! All preparation steps of a measured topography, in their order.

use serde::Serialize;

use super::resample::{grid_of_pitch, grid_of_shape};
use super::turn::rotated;
use super::window::within;
use super::{Fill, Filter, Interpolation, Level, Round};
use crate::{Axis, NEVER, Stop, Topography, check_stop};
use asperity_base::choice::near;
use asperity_base::error::{Result, check_in};
use asperity_base::grid::Grid;
use asperity_base::table::{Key, Kind, Source, Value, cells, list, require};
use asperity_base::units::{Dimension, Metre};
use asperity_base::{beside, exists};
use asperity_derive::Part;

/// Preparation steps of a topography; none by default.
///
/// The steps act in the order of the fields. First are the effects of the instrument: the part to keep,
/// spikes, holes. Then comes the form, which needs defined heights without spikes, then the direction. The
/// filters follow, because they need a surface without form. Then comes the grid, whose cells may be as large
/// as the shortest remaining wave allows, and last the taper.
#[derive(Part, Debug, Clone, Copy, Default, PartialEq, Serialize)]
#[part(check = filters_leave_waves)]
pub struct Preparation {
    /// Part to keep.
    ///
    /// `[x0, y0, nx, ny]` in samples.
    #[key(
        special = window,
        form = "`[x0, y0, nx, ny]`, in samples: first sample from 0, number of samples ≥ 1",
        absent = "everything",
        example = "[0, 0, 96, 128]"
    )]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub window: Option<[usize; 4]>,
    /// Turns spikes into missing heights: samples that deviate from their surroundings by more than this
    /// number of standard deviations, usually 5 to 10.
    ///
    /// The factor of [`Topography::despike`].
    #[key(number = "a number", range = AboveZero, absent = "nothing", example = "6", with = ["file", "given"])]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub despike: Option<f64>,
    /// Treatment of missing heights: with `"none"` they are an error, `"harmonic"` is a membrane over each
    /// hole.
    ///
    /// With [`Fill::None`] undefined samples stay undefined.
    #[key(choice, default = Fill::None, example = "\"harmonic\"", with = ["file", "given"])]
    #[serde(skip_serializing_if = "is_default")]
    pub fill: Fill,
    /// Form to subtract, fitted by least squares.
    #[key(
        special = level,
        form = "`\"none\"`, `\"mean\"`, `\"plane\"`, `\"quadratic\"`, `\"polynomial-3\"` (all terms up to an order, 0 … 16), `\"sphere\"`, \
                `\"cylinder\"`",
        default = Level::None,
        written = "\"none\"",
        example = "\"plane\""
    )]
    pub level: Level,
    /// Direction to reverse.
    #[key(choice, absent = "none", example = "\"x\"")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub mirror: Option<Axis>,
    /// Angle of rotation, from x towards y; a number without a unit is in radians.
    ///
    /// See [`Topography::rotate`].
    #[key(quantity = Angle, default = 0.0, written = "0", example = "\"90 deg\"", exists = exists::ANGLE)]
    #[serde(skip_serializing_if = "is_default")]
    pub rotate: f64,
    /// S-filter: nesting index below which waves are removed, at least two pitches and below `l_filter`.
    #[key(quantity = Length, range = AboveZero, absent = "none", example = "\"2.5 um\"", exists = exists::LENGTH)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub s_filter: Option<Metre>,
    /// L-filter: nesting index above which waves are removed, at least two pitches.
    #[key(quantity = Length, range = AboveZero, absent = "none", example = "\"0.8 mm\"", exists = exists::LENGTH, beside = [beside::LONG])]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub l_filter: Option<Metre>,
    /// Kind of both filters.
    #[key(choice, default = Filter::Gaussian, example = "\"robust\"")]
    #[serde(skip_serializing_if = "is_default")]
    pub filter: Filter,
    /// Number of cells after resampling to the same extent.
    #[key(special = resample, form = "`[nx, ny]`, each ≥ 1", absent = "as it is", example = "[256, 256]")]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub resample: Option<Resample>,
    /// Interpolation of heights between samples on finer grids; the spline is cubic.
    #[key(choice, default = Interpolation::Linear, example = "\"spline\"")]
    #[serde(skip_serializing_if = "is_default")]
    pub interpolate: Interpolation,
    /// Width of the rim that tapers to the mean height, at most half of the topography.
    ///
    /// See [`Topography::taper`].
    #[key(quantity = Length, range = AboveZero, absent = "none", example = "\"10 um\"", exists = exists::LENGTH)]
    #[serde(skip_serializing_if = "Option::is_none")]
    pub taper: Option<Metre>,
}

/// A grid to resample to.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
#[serde(untagged)]
pub enum Resample {
    /// This number of cells along x and y on the same extent, see [`Topography::resample_to_shape`].
    Shape([usize; 2]),
    /// Cells of this size, see [`Topography::resample_to_pitch`].
    Pitch([Metre; 2]),
}

/// Findings of a preparation.
#[derive(Debug, Clone, Copy, Default, PartialEq)]
#[non_exhaustive]
pub struct Findings {
    /// Number of samples in the window.
    pub samples: usize,
    /// Number of undefined samples in the window, before filling.
    pub undefined: usize,
    /// Number of samples removed as spikes.
    pub spikes: usize,
    /// The sphere or cylinder that was subtracted; its lengths are relative to the corner of the window.
    pub form: Option<Round>,
}

impl Preparation {
    /// Returns the grid after all steps, without applying them.
    ///
    /// # Errors
    /// The errors of the steps that change the grid.
    pub fn grid(&self, mut grid: Grid) -> Result<Grid> {
        if let Some(window) = self.window {
            grid = within(&grid, window)?;
        }
        grid = rotated(&grid, self.rotate)?;
        match self.resample {
            Some(Resample::Shape(shape)) => grid_of_shape(&grid, shape),
            Some(Resample::Pitch(pitch)) if pitch != grid.pitch => grid_of_pitch(&grid, pitch),
            _ => Ok(grid),
        }
    }

    /// Applies all steps; returns the topography and the findings. Samples stay undefined if no step fills
    /// them.
    ///
    /// # Errors
    /// The errors of the steps; [`asperity_base::Error::OutOfRange`] also if no waves remain between S-filter
    /// and L-filter.
    pub fn apply(&self, topography: Topography) -> Result<(Topography, Findings)> {
        self.apply_until(topography, NEVER)
    }

    /// [`apply`](Self::apply) that can be stopped by `stop`.
    ///
    /// # Errors
    /// The errors of [`apply`](Self::apply); [`asperity_base::Error::Interrupted`].
    pub fn apply_until(&self, mut topography: Topography, stop: Stop<'_>) -> Result<(Topography, Findings)> {
        check_stop(stop)?;
        if let (Some(shortest), Some(longest)) = (self.s_filter, self.l_filter) {
            check_in(
                Dimension::Length,
                "s_filter",
                shortest,
                shortest < longest,
                "a wavelength below that of l_filter",
            )?;
        }
        if let Some(window) = self.window {
            topography = topography.window(window)?;
        }
        let (samples, undefined) = (topography.grid().cells(), topography.undefined());
        if let Some(factor) = self.despike {
            topography = topography.despike_until(factor, stop)?;
        }
        let spikes = topography.undefined() - undefined;
        check_stop(stop)?;
        if self.fill != Fill::None {
            topography = topography.fill(self.fill)?;
        }
        let form = topography.remove(self.level)?;
        if let Some(axis) = self.mirror {
            topography = topography.mirror(axis);
        }
        check_stop(stop)?;
        topography = topography.rotate(self.rotate)?;
        check_stop(stop)?;
        if let Some(nesting_index) = self.s_filter {
            topography = topography.s_filter(nesting_index, self.filter)?;
        }
        check_stop(stop)?;
        if let Some(nesting_index) = self.l_filter {
            topography = topography.l_filter(nesting_index, self.filter)?;
        }
        check_stop(stop)?;
        topography = match self.resample {
            Some(Resample::Shape(shape)) => topography.resample_to_shape(shape, self.interpolate)?,
            Some(Resample::Pitch(pitch)) if pitch != topography.grid().pitch => {
                topography.resample_to_pitch(pitch, self.interpolate)?
            }
            _ => topography,
        };
        if let Some(width) = self.taper {
            topography = topography.taper(width)?;
        }
        Ok((topography, Findings { samples, undefined, spikes, form }))
    }
}

/// Reads the part of a topography to keep.
fn window(value: &dyn Value, key: &Key) -> Result<[usize; 4]> {
    const EXPECTED: &str = "four whole numbers [x0, y0, nx, ny]";
    const SAMPLES: Kind = Kind::Count { least: 0, most: u64::MAX };
    let window: [usize; 4] = list(value, EXPECTED, |item| item.count(key, &SAMPLES))?
        .try_into()
        .map_err(|_| value.unexpected(EXPECTED, None))?;
    if window[2..].contains(&0) {
        Err(value.unexpected("a window [x0, y0, nx, ny] of at least one sample", None))
    } else {
        Ok(window)
    }
}

/// Reads a word of [`Level`]; each order of a polynomial has its own word.
fn level(value: &dyn Value, _: &Key) -> Result<Level> {
    let text = value.text();
    if let Some(level) = text.as_ref().ok().and_then(|text| text.parse().ok()) {
        return Ok(level);
    }
    if text.is_ok_and(|text| text.starts_with("polynomial")) {
        let hint = format!("the order of a polynomial is from 0 to {}", Level::MAX_ORDER);
        return Err(value.unexpected("a polynomial such as \"polynomial-3\"", Some(&hint)));
    }
    value.word(&Level::WORDS, &near(&Level::WORDS)).map(|_| Level::None)
}

/// Reads the numbers of cells to resample to.
fn resample(value: &dyn Value, key: &Key) -> Result<Resample> {
    cells(value, key).map(Resample::Shape)
}

fn filters_leave_waves(read: &Preparation, source: &dyn Source) -> Result<()> {
    let crossed =
        matches!((read.s_filter, read.l_filter), (Some(shortest), Some(longest)) if shortest >= longest);
    require(source, "s_filter", !crossed, "a wavelength below that of 'l_filter'", None)
}

fn is_default<T: Default + PartialEq>(value: &T) -> bool {
    *value == T::default()
}

#[cfg(test)]
mod tests {
    use super::*;
    use asperity_base::grid::Field;

    fn rough() -> Topography {
        let grid = Grid::new([60, 50], [1e-6, 1e-6]).unwrap();
        let mut heights = Field::from_shape_fn(grid.shape, |(i, j)| {
            1e-7 * ((0.9 * i as f64).sin() * (0.7 * j as f64).cos() + 0.1 * i as f64)
        });
        heights[[20, 20]] = 1e-4;
        heights[[0, 0]] = f64::NAN;
        heights[[40, 10]] = f64::NAN;
        Topography::new(grid, heights).unwrap()
    }

    #[test]
    fn nothing_is_done_by_default() {
        let (same, findings) = Preparation::default().apply(rough()).unwrap();
        let bits = |topography: &Topography| topography.heights().mapv(f64::to_bits);
        assert_eq!(bits(&same), bits(&rough()));
        assert_eq!(findings, Findings { samples: 3000, undefined: 2, ..Findings::default() });
    }

    #[test]
    fn the_steps_act_in_the_order_of_the_fields() {
        let preparation = Preparation {
            window: Some([1, 0, 58, 50]),
            despike: Some(8.0),
            fill: Fill::Harmonic,
            level: Level::Cylinder,
            mirror: Some(Axis::Y),
            rotate: 0.2,
            s_filter: Some(3e-6),
            l_filter: Some(20e-6),
            filter: Filter::Robust,
            resample: Some(Resample::Shape([50, 50])),
            interpolate: Interpolation::Spline,
            taper: Some(4e-6),
        };
        let (prepared, findings) = preparation.apply(rough()).unwrap();
        assert_eq!((findings.samples, findings.undefined, findings.spikes), (58 * 50, 1, 1));
        assert_eq!(findings.form.unwrap().axis.map(|axis| axis.is_finite()), Some(true));
        let by_hand = rough().window([1, 0, 58, 50]).unwrap().despike(8.0).unwrap();
        let by_hand = by_hand.fill(Fill::Harmonic).unwrap().level(Level::Cylinder).unwrap();
        let by_hand = by_hand.mirror(Axis::Y).rotate(0.2).unwrap();
        let by_hand =
            by_hand.s_filter(3e-6, Filter::Robust).unwrap().l_filter(20e-6, Filter::Robust).unwrap();
        let by_hand =
            by_hand.resample_to_shape([50, 50], Interpolation::Spline).unwrap().taper(4e-6).unwrap();
        assert_eq!(prepared.heights(), by_hand.heights());
        assert_eq!(prepared.undefined(), 0);
        assert_eq!(preparation.grid(*rough().grid()).unwrap(), *prepared.grid());
        for angle in [0.0, 1.2, 1.6, -1.3, 4.5] {
            let resample = Some(Resample::Pitch([0.7e-6, 1.3e-6]));
            let turned =
                Preparation { rotate: angle, resample, fill: Fill::Nearest, ..Preparation::default() };
            let (prepared, _) = turned.apply(rough()).unwrap();
            assert_eq!(turned.grid(*rough().grid()).unwrap(), *prepared.grid(), "{angle}");
        }
    }

    #[test]
    fn filters_that_leave_nothing_between_them_are_refused() {
        let crossed = Preparation { s_filter: Some(9e-6), l_filter: Some(8e-6), ..Preparation::default() };
        let message = crossed.apply(rough()).unwrap_err().to_string();
        assert_eq!(message, "s_filter is 9 µm, expected a wavelength below that of l_filter");
    }

    #[test]
    fn only_what_is_done_is_written() {
        let preparation = Preparation {
            level: Level::Polynomial(4),
            resample: Some(Resample::Pitch([1e-6, 2e-6])),
            mirror: Some(Axis::X),
            ..Preparation::default()
        };
        let text = serde_json::to_string(&preparation).unwrap();
        assert_eq!(text, r#"{"level":"polynomial-4","mirror":"x","resample":[1e-6,2e-6]}"#);
    }
}
