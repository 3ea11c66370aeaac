//! Ideal forms: the bodies of the closed-form contacts.

use serde::Serialize;

use crate::Topography;
use std::ops::Range;

use asperity_base::beside::{self, Beside, Scale};
use asperity_base::choice::choice;
use asperity_base::error::{Result, check_in};
use asperity_base::exists;
use asperity_base::grid::{Field, Grid};
use asperity_base::math::parallel;
use asperity_base::table::{Bounds, Key, Kind, Source, Value, require, two};
use asperity_base::units::{Dimension, Metre, or_infs};
use asperity_derive::Part;

/// An ideal form, material's side up, with its apex in the centre of the grid at height 0.
#[derive(Part, Debug, Clone, Copy, PartialEq, Serialize)]
#[part(key = "form", example = "\"sphere\"", meaning = "the form", check = flat_enough)]
#[serde(tag = "form", rename_all = "kebab-case")]
pub enum Form {
    /// z = −r²/2R: the paraboloid that approximates a sphere in contact mechanics (Johnson 1985, eq. 4.1).
    Sphere {
        /// Radius R.
        #[key(quantity = Length, range = AboveZero, example = "\"1 mm\"", exists = exists::RADIUS)]
        radius: Metre,
    },
    /// z = −x²/2Rx − y²/2Ry: the paraboloid that approximates an ellipsoid, or a crowned roller.
    Ellipsoid {
        /// Principal radii of curvature; an ellipsoid with semi-axes a, b and c, c normal to the plane, has
        /// a²/c and b²/c.
        ///
        /// Rx and Ry at the apex, > 0: in the planes y = 0 and x = 0.
        #[key(
            special = radii,
            form = "`[Rx, Ry]`, two lengths > 0",
            dimension = Length,
            example = "[\"1 mm\", \"2 mm\"]",
            exists = exists::RADIUS
        )]
        radius: [Metre; 2],
    },
    /// z = −s²/2R, with s the distance from the line of the apex: the parabolic cylinder of line contact.
    Cylinder {
        /// Radius R.
        #[key(quantity = Length, range = AboveZero, example = "\"1 mm\"", exists = exists::RADIUS)]
        radius: Metre,
        /// Direction of the crest.
        #[key(choice, default = Axis::Y, example = "\"x\"")]
        axis: Axis,
    },
    /// z = −r tan α.
    Cone {
        /// Slope angle α from the plane, below 90°; a number without a unit is in radians.
        ///
        /// An indenter with semi-angle θ has α = π/2 − θ.
        #[key(quantity = Angle, range = AboveZero, example = "\"5 deg\"", exists = exists::ANGLE)]
        angle: f64,
    },
    /// z = 0.
    Flat,
    /// z = A (cos(2πx/λx) cos(2πy/λy) − 1), with a crest of height 0 in the centre and the mean height −A.
    Sinusoid {
        /// Amplitude A.
        ///
        /// Half the height from trough to crest, > 0.
        #[key(quantity = Length, range = AboveZero, example = "\"0.1 um\"", exists = exists::LENGTH)]
        amplitude: Metre,
        /// Wavelength λ, at least two pitches.
        ///
        /// λx and λy; infinite if the height does not vary in that direction.
        #[key(
            quantity = Length,
            range = AboveZeroOrInfinite("no variation in that direction"),
            pair,
            example = "\"64 um\"",
            exists = exists::WAVE,
            beside = [Beside::most(Scale::Side, 10.0, "the surface has less than a tenth of a wave")]
        )]
        #[serde(serialize_with = "or_infs")]
        wavelength: [Metre; 2],
    },
    /// z = −d p(u), parallel grooves with ridges of height 0 between them. u is the distance from a ridge
    /// over the period, and one ridge passes through the centre.
    ///
    /// Turning with a feed f and a tool of nose radius r gives parabolic grooves with period f and depth d =
    /// f²/8r. Then Sa/d is 4/(9√3) = 0.257 and Sq/d is 2/(3√5) = 0.298.
    Grooves {
        /// Distance from ridge to ridge, at least two pitches.
        #[key(quantity = Length, range = AboveZero, example = "\"0.1 mm\"", exists = exists::LENGTH, beside = [beside::LONG])]
        period: Metre,
        /// Depth d.
        ///
        /// Below the ridges, > 0.
        #[key(quantity = Length, range = AboveZero, example = "\"1 um\"", exists = exists::LENGTH)]
        depth: Metre,
        /// Shape of a groove.
        #[key(choice, default = Groove::Parabolic, example = "\"triangular\"")]
        profile: Groove,
        /// Angle of the grooves, or of the first correlation length, from x towards y.
        #[key(quantity = Angle, default = 0.0, written = "0", example = "\"90 deg\"", exists = exists::ANGLE)]
        lay: f64,
    },
}

/// Reads two radii; one would be that of a sphere.
fn radii(value: &dyn Value, key: &Key) -> Result<[Metre; 2]> {
    const EXPECTED: &str = "two radii of curvature, along x and along y, such as [\"1 mm\", \"2 mm\"]";
    if !value.is_array() {
        return Err(value.unexpected(EXPECTED, Some("a body of one radius is a `form = \"sphere\"`")));
    }
    let kind = Kind::Quantity(Dimension::Length, Bounds::AboveZero);
    let radius = |value: &dyn Value| value.real(key, &kind);
    two(value, EXPECTED, radius)
}

fn flat_enough(read: &Form, source: &dyn Source) -> Result<()> {
    let is_steep = matches!(read, Form::Cone { angle } if *angle >= std::f64::consts::FRAC_PI_2);
    let hint = "a number without a unit is in radians";
    require(source, "angle", !is_steep, "an angle below 90 deg such as \"5 deg\"", Some(hint))
}

/// The profile p(u) of a groove, 0 ≤ u ≤ 1 from ridge to ridge.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Groove {
    /// 4u(1 − u), from a round tool.
    #[default]
    Parabolic,
    /// 1 − |1 − 2u|, from a pointed tool.
    Triangular,
}

choice!(Groove: "parabolic" => Parabolic, "triangular" => Triangular);

/// A direction in the plane of the surface.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, serde::Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Axis {
    /// The direction of motion.
    X,
    /// The direction across the motion: that of the axis of a rolling cylinder.
    #[default]
    Y,
}

choice!(Axis: "x" => X, "y" => Y);

impl Form {
    /// Creates the topography of this form on `grid`.
    ///
    /// # Errors
    /// [`asperity_base::Error::OutOfRange`] if a parameter is invalid, or if a wavelength is below two
    /// pitches.
    pub fn on(&self, grid: &Grid) -> Result<Topography> {
        Topography::new(*grid, self.rows_on(grid, 0..grid.shape[0], false)?)
    }

    /// Creates some rows of the heights of [`Form::on`]; those of its underside, if it is turned over.
    ///
    /// # Errors
    /// The errors of [`Form::on`].
    pub fn rows_on(&self, grid: &Grid, rows: Range<usize>, turned_over: bool) -> Result<Field> {
        self.check(grid)?;
        let extent = grid.extent();
        Ok(parallel::field([rows.len(), grid.shape[1]], |i, iy| {
            let at =
                |ix| self.height(grid.centre(0, ix) - 0.5 * extent[0], grid.centre(1, iy) - 0.5 * extent[1]);
            let ix = rows.start + i;
            if turned_over { -at(grid.shape[0] - 1 - ix) } else { at(ix) }
        }))
    }

    /// Height at `(x, y)` relative to the apex.
    fn height(&self, x: Metre, y: Metre) -> Metre {
        match *self {
            Self::Flat => 0.0,
            Self::Sphere { radius } => -(x * x + y * y) / (2.0 * radius),
            Self::Ellipsoid { radius: [rx, ry] } => -x * x / (2.0 * rx) - y * y / (2.0 * ry),
            Self::Cylinder { radius, axis: Axis::Y } => -x * x / (2.0 * radius),
            Self::Cylinder { radius, axis: Axis::X } => -y * y / (2.0 * radius),
            Self::Cone { angle } => -x.hypot(y) * angle.tan(),
            Self::Sinusoid { amplitude, wavelength } => {
                let wave = |s: Metre, length: Metre| (std::f64::consts::TAU * s / length).cos();
                amplitude * (wave(x, wavelength[0]) * wave(y, wavelength[1]) - 1.0)
            }
            Self::Grooves { period, depth, profile, lay } => {
                let u = ((y * lay.cos() - x * lay.sin()) / period).rem_euclid(1.0);
                -depth
                    * match profile {
                        Groove::Parabolic => 4.0 * u * (1.0 - u),
                        Groove::Triangular => 1.0 - (1.0 - 2.0 * u).abs(),
                    }
            }
        }
    }

    fn check(&self, grid: &Grid) -> Result<()> {
        let positive = |value: f64| value > 0.0 && value.is_finite();
        match *self {
            Self::Flat => Ok(()),
            Self::Sphere { radius } | Self::Cylinder { radius, .. } => {
                check_in(Dimension::Length, "radius", radius, positive(radius), "a radius above 0")
            }
            Self::Ellipsoid { radius } => radius.into_iter().try_for_each(|radius| {
                check_in(Dimension::Length, "radius", radius, positive(radius), "a radius above 0")
            }),
            Self::Cone { angle } => {
                let good = angle > 0.0 && angle < std::f64::consts::FRAC_PI_2;
                check_in(
                    Dimension::Angle,
                    "angle",
                    angle,
                    good,
                    "a slope against the plane between 0° and 90°",
                )
            }
            Self::Sinusoid { amplitude, wavelength } => {
                check_in(
                    Dimension::Length,
                    "amplitude",
                    amplitude,
                    positive(amplitude),
                    "an amplitude above 0",
                )?;
                wavelength.iter().zip(grid.pitch).try_for_each(|(&length, pitch)| {
                    let good = length >= 2.0 * pitch;
                    check_in(
                        Dimension::Length,
                        "wavelength",
                        length,
                        good,
                        "at least two pitches, or inf for no variation",
                    )
                })
            }
            Self::Grooves { period, depth, lay, .. } => {
                let good = period >= 2.0 * grid.pitch[0].max(grid.pitch[1]) && period.is_finite();
                check_in(Dimension::Length, "period", period, good, "a length of at least two pitches")?;
                check_in(Dimension::Length, "depth", depth, positive(depth), "a depth above 0")?;
                check_in(Dimension::Angle, "lay", lay, lay.is_finite(), "an angle")
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;

    use super::*;
    use crate::HeightParameters;

    fn grid() -> Grid {
        Grid::new([9, 5], [0.5, 1.0]).unwrap()
    }

    #[test]
    fn the_apex_is_in_the_centre_at_height_zero() {
        let forms = [
            Form::Flat,
            Form::Sphere { radius: 3.0 },
            Form::Ellipsoid { radius: [3.0, 5.0] },
            Form::Cylinder { radius: 3.0, axis: Axis::X },
            Form::Cone { angle: 0.1 },
            Form::Sinusoid { amplitude: 0.2, wavelength: [3.0, 4.0] },
            Form::Grooves { period: 3.0, depth: 0.2, profile: Groove::Triangular, lay: 0.3 },
        ];
        for form in forms {
            let topography = form.on(&grid()).unwrap();
            assert_eq!(topography.heights()[[4, 2]], 0.0, "{form:?}");
            assert!(topography.heights().iter().all(|&z| z <= 0.0), "{form:?}");
        }
    }

    #[test]
    fn curvatures_and_slopes_are_those_asked_for() {
        let sphere = Form::Sphere { radius: 4.0 }.on(&grid()).unwrap();
        assert_eq!(sphere.heights()[[8, 4]], -(4.0 + 4.0) / 8.0);
        let ellipsoid = Form::Ellipsoid { radius: [4.0, 8.0] }.on(&grid()).unwrap();
        assert_eq!(ellipsoid.heights()[[8, 4]], -(4.0 / 8.0 + 4.0 / 16.0));
        let rolling = Form::Cylinder { radius: 4.0, axis: Axis::default() }.on(&grid()).unwrap();
        assert_eq!(rolling.heights()[[8, 4]], -4.0 / 8.0);
        let cone = Form::Cone { angle: 0.1 }.on(&grid()).unwrap();
        assert_eq!(cone.heights()[[8, 2]], -2.0 * 0.1f64.tan());
    }

    #[test]
    fn a_sinusoid_of_infinite_wavelength_does_not_vary() {
        let form = Form::Sinusoid { amplitude: 0.2, wavelength: [2.0, Metre::INFINITY] };
        let topography = form.on(&grid()).unwrap();
        for line in topography.heights().outer_iter() {
            assert!(line.iter().all(|z| *z == line[0]));
        }
        assert!((topography.heights()[[2, 0]] + 0.4).abs() < 1e-15);
    }

    #[test]
    fn turned_grooves_have_the_roughness_of_their_parabolas_at_any_lay() {
        for (lay, shape) in [(0.0, [3, 4000]), (std::f64::consts::FRAC_PI_2, [4000, 3]), (0.6, [1000, 1000])]
        {
            let form = Form::Grooves { period: 100.0, depth: 2.0, profile: Groove::Parabolic, lay };
            let parameters = HeightParameters::new(&form.on(&Grid::new(shape, [1.0; 2]).unwrap()).unwrap());
            // Whole periods are accurate to the square of pitch/period; across the grid the number of periods
            // is not whole.
            let tolerance = if lay == 0.6 { 0.02 } else { 1e-3 };
            assert_relative_eq!(parameters.sa, 2.0 * 4.0 / 243f64.sqrt(), max_relative = tolerance);
            assert_relative_eq!(parameters.sq, 2.0 * 2.0 / 45f64.sqrt(), max_relative = tolerance);
            // A sample is up to half a pitch from the ridge.
            assert_relative_eq!(parameters.sz, 2.0, max_relative = 4.0 * 0.5 / 100.0);
        }
    }

    #[test]
    fn grooves_do_not_vary_along_their_lay() {
        let grid = Grid::new([41, 41], [1.0, 0.5]).unwrap();
        for profile in [Groove::Parabolic, Groove::Triangular] {
            let lay = 1f64.atan2(2.0);
            let z = Form::Grooves { period: 7.3, depth: 1.0, profile, lay }.on(&grid).unwrap().into_heights();
            // Along (2, 1): one step of one sample in x and of one sample, half the pitch, in y.
            let same = (0..40).all(|i| (0..40).all(|j| (z[[i, j]] - z[[i + 1, j + 1]]).abs() < 1e-12));
            assert!(same && (z[[20, 20]] - z[[20, 24]]).abs() > 0.1, "{profile:?}");
        }
    }

    #[test]
    fn parameters_without_meaning_are_refused() {
        let grooves = |period, depth, lay| Form::Grooves { period, depth, profile: Groove::Parabolic, lay };
        let bad = [
            (Form::Sphere { radius: 0.0 }, "radius is 0 m"),
            (Form::Cylinder { radius: -1.0, axis: Axis::Y }, "radius is -1 m"),
            (Form::Ellipsoid { radius: [1.0, f64::INFINITY] }, "radius is inf"),
            (Form::Cone { angle: 2.0 }, "angle is 114.6°"),
            (Form::Sinusoid { amplitude: f64::NAN, wavelength: [3.0, 3.0] }, "amplitude is NaN"),
            (Form::Sinusoid { amplitude: 1.0, wavelength: [3.0, 1.5] }, "wavelength is 1.5 m"),
            (grooves(1.9, 1.0, 0.0), "period is 1.9 m"),
            (grooves(2.0, -1.0, 0.0), "depth is -1 m"),
            (grooves(2.0, 1.0, f64::NAN), "lay is NaN"),
        ];
        for (form, message) in bad {
            let error = form.on(&grid()).unwrap_err().to_string();
            assert!(error.starts_with(message), "{error}");
        }
    }
}
