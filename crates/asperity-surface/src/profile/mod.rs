//! Profiles: heights along a line, filtered and described according to ISO 21920-2:2021.

mod elements;
mod gaussian;
mod parameters;

pub use parameters::ProfileParameters;

use crate::topography::check_heights;
use crate::{Axis, BearingCurve, Topography};
use asperity_base::error::{Result, check, check_in};
use asperity_base::units::{Dimension, Metre};

/// Heights along a line at uniform spacing, in metres; an undefined sample is NaN.
///
/// A roughness profile also stores its section length, the cut-off λc.
#[derive(Debug, Clone, PartialEq)]
pub struct Profile {
    pitch: Metre,
    heights: Vec<Metre>,
    /// Section length; `None` if the whole profile is one section.
    section: Option<Metre>,
}

impl Profile {
    /// Creates a profile with these `heights`, each finite, or NaN if undefined, `pitch` apart.
    ///
    /// # Errors
    /// [`asperity_base::Error::OutOfRange`] if there are no heights, if one is infinite, or if the pitch is not
    /// a positive length.
    pub fn new(pitch: Metre, heights: Vec<Metre>) -> Result<Self> {
        check_in(Dimension::Length, "pitch", pitch, pitch > 0.0 && pitch.is_finite(), "a positive length")?;
        check("number of heights", heights.len() as f64, !heights.is_empty(), "at least 1")?;
        check_heights(heights.iter())?;
        Ok(Self { pitch, heights, section: None })
    }

    /// Distance between two samples.
    pub fn pitch(&self) -> Metre {
        self.pitch
    }

    /// Heights; NaN if undefined.
    pub fn heights(&self) -> &[Metre] {
        &self.heights
    }

    /// Evaluation length: the pitch times the number of samples.
    pub fn length(&self) -> Metre {
        self.pitch * self.heights.len() as f64
    }

    /// Returns the primary profile: without waves below the nesting index λs.
    ///
    /// A wave of length λ is reduced to the fraction 2^−(λs/λ)², which is a half at λs. ISO 16610-21.
    ///
    /// # Errors
    /// [`asperity_base::Error::OutOfRange`] unless the nesting index is at least two pitches.
    pub fn primary(&self, nesting_index: Metre) -> Result<Self> {
        self.with(self.smoothed(nesting_index)?, None)
    }

    /// Returns the waviness: without waves below the cut-off λc, by the same filter as [`Profile::primary`].
    ///
    /// # Errors
    /// The errors of [`Profile::primary`].
    pub fn waviness(&self, cutoff: Metre) -> Result<Self> {
        self.primary(cutoff)
    }

    /// Returns the roughness: the profile minus its waviness, to be described in sections of the length λc.
    ///
    /// # Errors
    /// The errors of [`Profile::primary`].
    pub fn roughness(&self, cutoff: Metre) -> Result<Self> {
        let waviness = self.smoothed(cutoff)?;
        let rough = self.heights.iter().zip(waviness).map(|(z, w)| z - w).collect();
        self.with(rough, Some(cutoff))
    }

    /// Returns the material ratio curve: Rmr(c), Rmc(p), and Rdc(p, q) = Rmc(p) − Rmc(q).
    ///
    /// # Errors
    /// [`asperity_base::Error::NothingDefined`] without a defined sample.
    pub fn bearing_curve(&self) -> Result<BearingCurve> {
        BearingCurve::new(&self.heights)
    }

    fn with(&self, heights: Vec<Metre>, section: Option<Metre>) -> Result<Self> {
        Ok(Self { section, ..Self::new(self.pitch, heights)? })
    }

    fn smoothed(&self, cutoff: Metre) -> Result<Vec<Metre>> {
        let pitches = cutoff / self.pitch;
        check_in(
            Dimension::Length,
            "cutoff",
            cutoff,
            pitches >= 2.0 && pitches.is_finite(),
            "a length of at least two pitches",
        )?;
        Ok(gaussian::smooth(&self.heights, pitches))
    }
}

impl Topography {
    /// Returns the profile along `axis` at the sample `index` of the other axis.
    ///
    /// # Errors
    /// [`asperity_base::Error::OutOfRange`] if there is no such line.
    pub fn profile(&self, axis: Axis, index: usize) -> Result<Profile> {
        let lines = self.grid().shape[1 - axis as usize];
        check("index of the profile", index as f64, index < lines, "one of the samples across the profile")?;
        Ok(self.line(axis, index))
    }

    /// Iterates over all profiles along `axis`.
    pub fn profiles(&self, axis: Axis) -> impl Iterator<Item = Profile> {
        (0..self.grid().shape[1 - axis as usize]).map(move |index| self.line(axis, index))
    }

    /// Computes the parameters of the roughness profiles along `axis` with the cut-off λc, each as the mean
    /// over the lines.
    ///
    /// # Errors
    /// [`asperity_base::Error::OutOfRange`] unless the cut-off is at least two pitches.
    pub fn profile_parameters(&self, axis: Axis, cutoff: Metre) -> Result<ProfileParameters> {
        let lines = self.profiles(axis).map(|profile| Ok(profile.roughness(cutoff)?.parameters()));
        Ok(ProfileParameters::mean(&lines.collect::<Result<Vec<_>>>()?))
    }

    fn line(&self, axis: Axis, index: usize) -> Profile {
        let across = ndarray::Axis(1 - axis as usize);
        let heights = self.heights().index_axis(across, index).to_vec();
        Profile { pitch: self.grid().pitch[axis as usize], heights, section: None }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::topography::tests::numbered;

    #[test]
    fn a_profile_runs_along_its_axis_at_the_pitch_of_that_axis() {
        let along_x = numbered().profile(Axis::X, 2).unwrap();
        assert_eq!((along_x.heights(), along_x.pitch()), (&[2.0, 12.0, 22.0, 32.0][..], 1.0));
        let along_y = numbered().profile(Axis::Y, 3).unwrap();
        assert_eq!((along_y.heights(), along_y.length()), (&[30.0, 31.0, 32.0][..], 6.0));
        assert_eq!((numbered().profiles(Axis::X).count(), numbered().profiles(Axis::Y).count()), (3, 4));
    }

    #[test]
    fn what_is_no_profile_is_refused() {
        let message = |profile: Result<Profile>| profile.unwrap_err().to_string();
        assert!(message(numbered().profile(Axis::X, 3)).starts_with("index of the profile is 3"));
        assert!(message(Profile::new(0.0, vec![1.0])).starts_with("pitch is 0 m"));
        assert!(message(Profile::new(1.0, vec![])).starts_with("number of heights is 0"));
        assert!(message(Profile::new(1.0, vec![f64::INFINITY])).starts_with("height is inf"));
        let profile = Profile::new(1.0, vec![0.0; 9]).unwrap();
        for cutoff in [1.9, f64::NAN, f64::INFINITY] {
            assert!(message(profile.roughness(cutoff)).starts_with("cutoff is"));
        }
    }
}
