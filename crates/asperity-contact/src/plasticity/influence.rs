//! Stress in the layers under tractions on the surface, and its transpose.

use asperity_transforms::num_complex::Complex64;
use ndarray::Zip;

use super::{COMPONENTS, Layers};
use crate::grid::{Field, Grid};
use crate::kernel::{Traction, harmonic_stress, stress_table};
use crate::math::convolution::{Parity, spectrum};
use crate::math::fft::angular_frequency;
use crate::math::parallel;
use crate::operator::Boundary;
use crate::stress::Component;
use crate::units::Metre;
use asperity_base::math::plans::Plans;

/// Transforms of the stress under one traction, as the mean over each layer.
///
/// - Free: the closed form of a loaded cell, at two Gauss depths per layer.
/// - Periodic: the closed form of each harmonic, with its exact mean over the layer.
pub(super) struct Influence {
    /// Indexed `[ky, kx]` up to half the period, by layer and component: the real factor of iⁿ, with n the
    /// number of axes in which the component is odd.
    spectra: Vec<Field>,
    /// Axes in which each component is odd.
    odd: [[bool; 2]; COMPONENTS],
    thickness: Vec<Metre>,
}

impl Influence {
    pub(super) fn new(
        grid: &Grid,
        period: [usize; 2],
        boundary: Boundary,
        layers: &Layers,
        poisson: f64,
        traction: Traction,
    ) -> Self {
        let plans = Plans::new(period);
        let spectra = parallel::tasks(0..layers.count() * COMPONENTS, |index| {
            let (layer, component) = (index / COMPONENTS, Component::ALL[index % COMPONENTS]);
            let faces = [layers.faces()[layer], layers.faces()[layer + 1]];
            if boundary.leaves_mean_free() {
                periodic(grid, faces, poisson, component, traction)
            } else {
                let half = period.map(|n| n / 2 + 1);
                let table = free(half, grid.pitch, faces, poisson, component, traction);
                let parity = traction.odd(component).map(|odd| if odd { Parity::Odd } else { Parity::Even });
                spectrum(&plans, &table, parity)
            }
        });
        let thickness = (0..layers.count()).map(|layer| layers.thickness(layer)).collect();
        Self { spectra, odd: Component::ALL.map(|component| traction.odd(component)), thickness }
    }

    /// Adds the stress under a `traction`, given by its column at `ky`, to the `column` of a component of a
    /// layer.
    pub(super) fn add(&self, [plane, ky]: [usize; 2], traction: &[Complex64], column: &mut [Complex64]) {
        let (spectrum, turn, sign) = self.at(plane, ky);
        let middle = column.len() / 2 + 1;
        let rear = if self.odd[plane % COMPONENTS][0] { -sign } else { sign };
        turn.add(traction[..middle].iter(), spectrum.iter().map(|s| sign * s), column[..middle].iter_mut());
        turn.add(
            traction[middle..].iter().rev(),
            spectrum[1..].iter().map(|s| rear * s),
            column[middle..].iter_mut().rev(),
        );
    }

    /// Adds the part of a component of traceless plastic strain, given by its `column` at `ky`, to the
    /// transpose: the displacement of the surface of the body along the traction.
    pub(super) fn transpose(
        &self,
        [plane, ky]: [usize; 2],
        column: &[Complex64],
        displacement: &mut [Complex64],
    ) {
        let (layer, component) = (plane / COMPONENTS, plane % COMPONENTS);
        let (spectrum, turn, sign) = self.at(plane, ky);
        let (below, ..) = self.at(layer * COMPONENTS + Component::Zz as usize, ky);
        // εzz = −εxx − εyy; shears count twice.
        let (weight, less) = if component < 3 { (1.0, 1.0) } else { (2.0, 0.0) };
        // The conjugate power of i.
        let weight = weight * self.thickness[layer] * if turn == Turn::Quarter { -sign } else { sign };
        let middle = column.len() / 2 + 1;
        let rear = if self.odd[component][0] { -weight } else { weight };
        let of = |weight: f64| move |(s, below): (&f64, &f64)| weight * (s - less * below);
        turn.add(
            column[..middle].iter(),
            spectrum.iter().zip(below).map(of(weight)),
            displacement[..middle].iter_mut(),
        );
        turn.add(
            column[middle..].iter().rev(),
            spectrum[1..].iter().zip(&below[1..]).map(of(rear)),
            displacement[middle..].iter_mut().rev(),
        );
    }

    /// Returns the real factor of a component of a layer at `ky`, and the power of i.
    fn at(&self, plane: usize, ky: usize) -> (&[f64], Turn, f64) {
        let spectrum = self.spectra[plane].row(ky).to_slice().expect("rows are contiguous");
        match self.odd[plane % COMPONENTS] {
            [false, false] => (spectrum, Turn::None, 1.0),
            [true, true] => (spectrum, Turn::None, -1.0),
            _ => (spectrum, Turn::Quarter, 1.0),
        }
    }
}

/// A factor 1 or i.
#[derive(Clone, Copy, PartialEq)]
enum Turn {
    None,
    Quarter,
}

impl Turn {
    /// Adds the numbers in `from`, times the `weights` and this factor.
    #[inline]
    fn add<'a>(
        self,
        from: impl Iterator<Item = &'a Complex64>,
        weights: impl Iterator<Item = f64>,
        to: impl Iterator<Item = &'a mut Complex64>,
    ) {
        let all = to.zip(from).zip(weights);
        match self {
            Self::None => all.for_each(|((to, value), weight)| *to += *value * weight),
            Self::Quarter => {
                all.for_each(|((to, value), weight)| *to += Complex64::new(-value.im, value.re) * weight);
            }
        }
    }
}

/// Returns the values at the offsets (i Δx, j Δy): the mean over the layer, by two Gauss points.
fn free(
    shape: [usize; 2],
    pitch: [Metre; 2],
    [top, bottom]: [Metre; 2],
    poisson: f64,
    component: Component,
    traction: Traction,
) -> Field {
    let apart = (bottom - top) / 12f64.sqrt();
    let at = |depth| stress_table(shape, depth, pitch, poisson, component, traction);
    let middle = 0.5 * (top + bottom);
    let mut table = at(middle - apart);
    Zip::from(&mut table).and(&at(middle + apart)).for_each(|one, other| *one = 0.5 * (*one + other));
    table
}

/// Returns the transform at `[ky, kx]`. A harmonic is (a + b qz) e^−qz, whose means over the layer are known.
fn periodic(
    grid: &Grid,
    [top, bottom]: [Metre; 2],
    poisson: f64,
    component: Component,
    traction: Traction,
) -> Field {
    let [nx, ny] = grid.shape;
    let odd = traction.odd(component);
    // If it is odd in both axes, it is real and equals −1 times i².
    let sign = if odd == [true; 2] { -1.0 } else { 1.0 };
    Field::from_shape_fn([ny / 2 + 1, nx / 2 + 1], |(ky, kx)| {
        let wave = [angular_frequency(kx, nx, grid.pitch[0]), angular_frequency(ky, ny, grid.pitch[1])];
        // A wave that alternates from cell to cell runs half in each direction, so that its odd part cancels.
        if odd[0] && 2 * kx == nx || odd[1] && 2 * ky == ny {
            return 0.0;
        }
        let q = wave[0].hypot(wave[1]);
        let harmonic = |depth| harmonic_stress(wave, depth, poisson, component, traction);
        let a = harmonic(0.0);
        if q == 0.0 {
            return a;
        }
        let b = harmonic(1.0 / q) * 1f64.exp() - a;
        let thickness = q * (bottom - top);
        let mean = -(-thickness).exp_m1() / thickness;
        let rise = mean - (-thickness).exp();
        let above = q * top;
        sign * (-above).exp() * (a * mean + b * (above * mean + rise))
    })
}
