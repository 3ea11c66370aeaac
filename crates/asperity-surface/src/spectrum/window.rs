//! Windows: weights that decrease to zero at the boundary.

use asperity_base::choice::choice;
use asperity_base::grid::Field;

/// Weights that make a topography periodic before its transform, as functions of ξ and η, which range from −1
/// to 1 between opposite sides. They are scaled to ⟨w²⟩ = 1, so that white noise keeps its density.
///
/// Without a window, a nonperiodic topography has a step at the boundary. Its spectrum then decreases no
/// faster than q⁻² along the axes, whatever the surface. Harris, Proc. IEEE 66, 51 (1978); for surfaces
/// Jacobs, Junge & Pastewka, Surf. Topogr.: Metrol. Prop. 5, 013001 (2017).
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub enum Window {
    /// 1 everywhere: for periodic surfaces.
    #[default]
    None,
    /// Hann's window along x and along y, cos²(πξ/2) cos²(πη/2).
    Hann,
    /// Hann's window over the radius, cos²(πr/2) for r = √(ξ² + η²) < 1, else 0: isotropic, but without the
    /// corners.
    RadialHann,
    /// Welch's window along x and along y, (1 − ξ²)(1 − η²): narrower in wave number, but with a tail in q⁻⁴.
    Welch,
}

choice!(Window: "none" => None, "hann" => Hann, "radial-hann" => RadialHann, "welch" => Welch);

impl Window {
    /// Returns the weights on `shape` samples, evaluated at their centres.
    pub(super) fn weights(self, shape: [usize; 2]) -> Field {
        let scaled = |axis: usize, index: usize| (2.0 * index as f64 + 1.0) / shape[axis] as f64 - 1.0;
        let line = |axis: usize, weight: fn(f64) -> f64| -> Vec<f64> {
            (0..shape[axis]).map(|index| weight(scaled(axis, index))).collect()
        };
        let separable = |weight: fn(f64) -> f64| {
            let (along_x, along_y) = (line(0, weight), line(1, weight));
            Field::from_shape_fn(shape, |(ix, iy)| along_x[ix] * along_y[iy])
        };
        let mut weights = match self {
            Self::None => return Field::ones(shape),
            Self::Hann => separable(hann),
            Self::Welch => separable(|s| 1.0 - s * s),
            Self::RadialHann => {
                Field::from_shape_fn(shape, |(ix, iy)| hann(scaled(0, ix).hypot(scaled(1, iy))))
            }
        };
        let mean_square = weights.iter().map(|w| w * w).sum::<f64>() / weights.len() as f64;
        weights /= mean_square.sqrt();
        weights
    }
}

fn hann(s: f64) -> f64 {
    if s.abs() < 1.0 { 0.5 + 0.5 * (std::f64::consts::PI * s).cos() } else { 0.0 }
}

#[cfg(test)]
mod tests {
    use approx::assert_relative_eq;

    use super::*;

    #[test]
    fn every_window_has_a_mean_square_of_one_and_its_own_height() {
        // 1/⟨w²⟩ of the unscaled windows: (8/3)², (15/8)², and for the disc in the square 4/(2π ∫ r
        // cos⁴(πr/2) dr), where the integral is 3/16 − 1/π².
        use std::f64::consts::PI;
        let radial = 2.0 / (PI * (0.1875 - 1.0 / (PI * PI)));
        for (window, gain) in [
            (Window::None, 1.0),
            (Window::Hann, (8.0f64 / 3.0).powi(2)),
            (Window::Welch, (15.0f64 / 8.0).powi(2)),
            (Window::RadialHann, radial),
        ] {
            let weights = window.weights([301, 201]);
            assert_relative_eq!(weights.mapv(|w| w * w).mean().unwrap(), 1.0, max_relative = 1e-12);
            // The sample in the centre; sums in place of integrals are accurate to 1/n².
            assert_relative_eq!(weights[[150, 100]], gain.sqrt(), max_relative = 1.0 / 201f64.powi(2) * 10.0);
        }
    }

    #[test]
    fn a_single_line_is_windowed_along_itself_only() {
        let line = Window::Hann.weights([64, 1]);
        assert_relative_eq!(line[[31, 0]], (8.0f64 / 3.0).sqrt(), max_relative = 1e-2);
        assert!(line[[0, 0]] < 1e-2);
    }
}
