//! Removal of the mean form.

use std::fmt;
use std::str::FromStr;

use serde::Serialize;

use super::polynomial::Polynomial;
use super::round::{self, Round};
use crate::Topography;
use asperity_base::error::{Result, check};

/// Form subtracted from the heights: a least-squares fit to the defined samples.
///
/// Written as `none`, `mean`, `plane`, `quadratic`, `polynomial-3`, `sphere`, `cylinder`.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Serialize)]
#[serde(into = "String")]
pub enum Level {
    /// Nothing.
    #[default]
    None,
    /// The mean height.
    Mean,
    /// A plane: 1, x, y.
    Plane,
    /// A full second-order polynomial: 1, x, y, x², xy, y².
    Quadratic,
    /// All xᵃyᵇ with a + b up to the order, 0 to [`Level::MAX_ORDER`].
    Polynomial(usize),
    /// A sphere, convex or concave, see [`Topography::best_sphere`].
    Sphere,
    /// A circular cylinder with its axis in any direction, see [`Topography::best_cylinder`].
    Cylinder,
}

impl Level {
    /// Largest order of a polynomial, which has 153 terms.
    pub const MAX_ORDER: usize = 16;

    /// Texts accepted by [`Level::from_str`], for messages.
    pub const WORDS: [&str; 7] = ["none", "mean", "plane", "quadratic", "polynomial-3", "sphere", "cylinder"];
}

impl fmt::Display for Level {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::None => f.write_str("none"),
            Self::Mean => f.write_str("mean"),
            Self::Plane => f.write_str("plane"),
            Self::Quadratic => f.write_str("quadratic"),
            Self::Polynomial(order) => write!(f, "polynomial-{order}"),
            Self::Sphere => f.write_str("sphere"),
            Self::Cylinder => f.write_str("cylinder"),
        }
    }
}

/// Error of a text that names no [`Level`].
#[derive(Debug, Clone, Copy, PartialEq, Eq, thiserror::Error)]
#[error(
    "expected one of {}; the order of a polynomial is from 0 to {}",
    Level::WORDS.join(", "),
    Level::MAX_ORDER
)]
pub struct LevelError;

impl FromStr for Level {
    type Err = LevelError;

    fn from_str(text: &str) -> std::result::Result<Self, LevelError> {
        Ok(match text {
            "none" => Self::None,
            "mean" => Self::Mean,
            "plane" => Self::Plane,
            "quadratic" => Self::Quadratic,
            "sphere" => Self::Sphere,
            "cylinder" => Self::Cylinder,
            _ => {
                let order = text.strip_prefix("polynomial-").ok_or(LevelError)?;
                let order = order.parse().map_err(|_| LevelError)?;
                if order > Self::MAX_ORDER {
                    return Err(LevelError);
                }
                Self::Polynomial(order)
            }
        })
    }
}

impl From<Level> for String {
    fn from(level: Level) -> Self {
        level.to_string()
    }
}

impl Topography {
    /// Subtracts the least-squares fit given by `level`. Undefined samples stay undefined.
    ///
    /// Terms that the samples do not determine (x for a single column, for example) are left out of the fit.
    ///
    /// # Errors
    /// [`asperity_base::Error::OutOfRange`] if the order of a polynomial is above [`Level::MAX_ORDER`].
    pub fn level(mut self, level: Level) -> Result<Self> {
        self.remove(level)?;
        Ok(self)
    }

    /// Subtracts the form given by `level`; returns the sphere or cylinder, if it was one.
    pub(super) fn remove(&mut self, level: Level) -> Result<Option<Round>> {
        let order = match level {
            Level::None => return Ok(None),
            Level::Mean => 0,
            Level::Plane => 1,
            Level::Quadratic => 2,
            Level::Polynomial(order) => {
                let good = order <= Level::MAX_ORDER;
                check("level", order as f64, good, "a polynomial of an order from 0 to 16")?;
                order
            }
            Level::Sphere => return Ok(round::remove_sphere(self)),
            Level::Cylinder => return Ok(round::remove_cylinder(self)),
        };
        if let Some(polynomial) = Polynomial::on(self.heights(), order) {
            polynomial.remove(self.heights_mut());
        }
        Ok(None)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use asperity_base::grid::{Field, Grid};

    fn with_heights(height: impl Fn(f64, f64) -> f64) -> Topography {
        let grid = Grid::new([40, 25], [1e-6, 3e-6]).unwrap();
        let heights = Field::from_shape_fn(grid.shape, |(i, j)| {
            height(grid.centre(0, i) * 1e6, grid.centre(1, j) * 1e6)
        });
        Topography::new(grid, heights).unwrap()
    }

    fn largest(topography: &Topography) -> f64 {
        topography.heights().iter().filter(|z| !z.is_nan()).fold(0.0, |m, z| z.abs().max(m))
    }

    #[test]
    fn a_polynomial_is_removed_to_round_off_by_the_level_of_its_order() {
        let constant = with_heights(|_, _| 3.0);
        assert!(largest(&constant.level(Level::Mean).unwrap()) < 1e-15);
        let plane = with_heights(|x, y| 3.0 + 0.2 * x - 0.1 * y);
        assert!(largest(&plane.clone().level(Level::Mean).unwrap()) > 1.0);
        assert!(largest(&plane.level(Level::Plane).unwrap()) < 1e-13);
        let quadratic = with_heights(|x, y| 3.0 + 0.2 * x - 0.1 * y + 0.01 * (x * x - x * y + 2.0 * y * y));
        assert!(largest(&quadratic.clone().level(Level::Plane).unwrap()) > 1.0);
        assert!(largest(&quadratic.level(Level::Quadratic).unwrap()) < 1e-12);
    }

    #[test]
    fn holes_do_not_tilt_the_fit() {
        let mut plane = with_heights(|x, y| 3.0 + 0.2 * x - 0.1 * y);
        (5..20).for_each(|i| (2..9).for_each(|j| plane.heights_mut()[[i, j]] = f64::NAN));
        let levelled = plane.level(Level::Quadratic).unwrap();
        assert_eq!(levelled.undefined(), 15 * 7);
        assert!(largest(&levelled) < 1e-12);
    }

    #[test]
    fn what_is_left_is_orthogonal_to_what_was_removed() {
        let rough = with_heights(|x, y| (3.0 * x).sin() * (2.0 * y).cos() + 0.3 * x);
        let left = rough.level(Level::Quadratic).unwrap();
        let terms: [fn(f64, f64) -> f64; 6] =
            [|_, _| 1.0, |x, _| x, |_, y| y, |x, _| x * x, |x, y| x * y, |_, y| y * y];
        for (n, term) in terms.iter().enumerate() {
            let products =
                left.heights().indexed_iter().map(|((i, j), z)| z * term(i as f64 / 39.0, j as f64 / 24.0));
            let product: f64 = products.sum();
            assert!(product.abs() < 1e-11, "term {n}: {product:e}");
        }
    }

    #[test]
    fn a_polynomial_is_removed_to_round_off_by_its_order_and_not_by_the_one_below() {
        for order in 1..=Level::MAX_ORDER {
            let n = order as i32;
            // x and y from −1 to 1, all terms of the highest degree.
            let mut surface = with_heights(|x, y| {
                let (x, y) = (x / 20.0 - 1.0, y / 37.5 - 1.0);
                (0..=n).map(|a| x.powi(a) * y.powi(n - a)).sum::<f64>() + x
            });
            (12..15).for_each(|i| (3..20).for_each(|j| surface.heights_mut()[[i, j]] = f64::NAN));
            let left = |order| largest(&surface.clone().level(Level::Polynomial(order)).unwrap());
            assert!(left(order) < 1e-13, "order {order}: {:e}", left(order));
            // The residual of xⁿ with a lower order is at least its Chebyshev bound 2¹⁻ⁿ.
            assert!(left(order - 1) > 2f64.powi(1 - n), "order {order}: {:e}", left(order - 1));
        }
        let quadratic = with_heights(|x, y| (x * y).sin());
        let [named, numbered] =
            [Level::Quadratic, Level::Polynomial(2)].map(|level| quadratic.clone().level(level).unwrap());
        assert_eq!(named.heights(), numbered.heights());
    }

    #[test]
    fn a_fit_to_a_corner_of_the_samples_is_as_good_as_one_to_all() {
        let mut corner =
            with_heights(|x, y| 1.0 + (x / 40.0).powi(5) - (x / 40.0).powi(2) * (y / 75.0).powi(4));
        corner
            .heights_mut()
            .indexed_iter_mut()
            .filter(|((i, j), _)| *i < 30 || *j < 15)
            .for_each(|(_, z)| *z = f64::NAN);
        assert!(largest(&corner.level(Level::Polynomial(6)).unwrap()) < 1e-14);
    }

    #[test]
    fn a_level_is_what_its_words_say() {
        for word in Level::WORDS {
            assert_eq!(word.parse::<Level>().unwrap().to_string(), word);
        }
        for word in ["polynomial", "polynomial-", "polynomial-17", "polynomial--1", "Plane", ""] {
            assert_eq!(word.parse::<Level>(), Err(LevelError));
        }
        let message = with_heights(|x, _| x).level(Level::Polynomial(17)).unwrap_err().to_string();
        assert_eq!(message, "level is 17, expected a polynomial of an order from 0 to 16");
    }

    #[test]
    fn a_nanometre_on_a_millimetre_keeps_its_digits() {
        let ripple = |x: f64, y: f64| 1e-9 * (x * 0.7).sin() * (y * 0.3).cos();
        let low = with_heights(ripple).level(Level::Plane).unwrap();
        let high = with_heights(|x, y| 1e-3 + 1e-5 * x + ripple(x, y)).level(Level::Plane).unwrap();
        let difference = (low.heights() - high.heights()).iter().fold(0.0, |m: f64, d| d.abs().max(m));
        assert!(difference < 1e-18 * 1e3, "{difference:e}");
    }

    #[test]
    fn what_the_samples_do_not_determine_is_left_alone() {
        let grid = Grid::new([1, 5], [1.0, 1.0]).unwrap();
        let heights = Field::from_shape_fn([1, 5], |(_, j)| 1.0 + 2.0 * j as f64);
        let levelled = Topography::new(grid, heights).unwrap().level(Level::Quadratic).unwrap();
        assert!(largest(&levelled) < 1e-14);
        let nothing = Topography::new(grid, Field::from_elem([1, 5], f64::NAN)).unwrap();
        assert_eq!(nothing.level(Level::Plane).unwrap().undefined(), 5);
    }
}
