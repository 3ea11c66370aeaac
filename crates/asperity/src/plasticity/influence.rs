//! Stress in the layers under tractions on the surface, and its transpose.

use asperity_transforms::num_complex::Complex64;
use ndarray::Zip;

use super::waves::INDEPENDENT;
use super::{COMPONENTS, Layers};
use crate::grid::{Field, Grid};
use crate::kernel::{Traction, harmonic_stress, stress_table};
use crate::math::convolution::{Parity, Plans};
use crate::math::fft::angular_frequency;
use crate::math::{Planes, parallel};
use crate::operator::Boundary;
use crate::stress::Component;
use crate::units::Metre;

/// Transforms of the stress under one traction, as the mean over each layer.
///
/// - Free: the closed form of a loaded cell, at two Gauss depths per layer.
/// - Periodic: the closed form of each harmonic, with its exact mean over the layer.
pub(super) struct Influence {
    /// Indexed `[ky, kx]` up to half the period, by layer and component: the real factor of iⁿ, with n the number of axes
    /// in which the component is odd.
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
                plans.spectrum(&table, parity)
            }
        });
        let thickness = (0..layers.count()).map(|layer| layers.thickness(layer)).collect();
        Self { spectra, odd: Component::ALL.map(|component| traction.odd(component)), thickness }
    }

    /// Adds the stress under a `traction`, given by its column at `ky`, to the columns of all components of all layers.
    pub(super) fn add(&self, planes: &Planes, ky: usize, traction: &[Complex64], columns: &mut [Complex64]) {
        let nx = planes.shape()[0];
        for (plane, column) in columns.chunks_exact_mut(planes.stride()).enumerate() {
            let (spectrum, factor) = self.at(plane, ky);
            let [odd, _] = self.odd[plane % COMPONENTS];
            let (front, back) = column[..nx].split_at_mut(nx / 2 + 1);
            let (given, given_back) = traction[..nx].split_at(nx / 2 + 1);
            for ((to, p), s) in front.iter_mut().zip(given).zip(spectrum) {
                *to += factor.apply(*p) * *s;
            }
            let sign = if odd { -1.0 } else { 1.0 };
            for ((to, p), s) in back.iter_mut().rev().zip(given_back.iter().rev()).zip(&spectrum[1..]) {
                *to += factor.apply(*p) * (sign * s);
            }
        }
    }

    /// Applies the transpose: the displacement of the surface of the body along the traction, by traceless plastic strain,
    /// given by its columns at `ky`.
    pub(super) fn transpose(
        &self,
        planes: &Planes,
        ky: usize,
        columns: &[Complex64],
        displacement: &mut [Complex64],
    ) {
        let (nx, stride) = (planes.shape()[0], planes.stride());
        displacement.fill(Complex64::default());
        for (layer, thickness) in self.thickness.iter().enumerate() {
            let (below, _) = self.at(layer * COMPONENTS + Component::Zz as usize, ky);
            for component in INDEPENDENT {
                let plane = layer * COMPONENTS + component;
                let (spectrum, factor) = self.at(plane, ky);
                // εzz = −εxx − εyy; shears count twice.
                let normal = component < 3;
                let weight = if normal { *thickness } else { 2.0 * thickness };
                let of =
                    |bin: usize| weight * if normal { spectrum[bin] - below[bin] } else { spectrum[bin] };
                let sign = if self.odd[component][0] { -1.0 } else { 1.0 };
                let back = factor.conjugate();
                let (front, rear) = columns[plane * stride..][..nx].split_at(nx / 2 + 1);
                let (to_front, to_rear) = displacement[..nx].split_at_mut(nx / 2 + 1);
                for (bin, (to, strain)) in to_front.iter_mut().zip(front).enumerate() {
                    *to += back.apply(*strain) * of(bin);
                }
                for (bin, (to, strain)) in to_rear.iter_mut().rev().zip(rear.iter().rev()).enumerate() {
                    *to += back.apply(*strain) * (sign * of(bin + 1));
                }
            }
        }
    }

    fn at(&self, plane: usize, ky: usize) -> (&[f64], Power) {
        let spectrum = self.spectra[plane].row(ky).to_slice().expect("rows are contiguous");
        let odd = self.odd[plane % COMPONENTS];
        (spectrum, Power(odd.iter().filter(|odd| **odd).count()))
    }
}

/// A power of i.
#[derive(Clone, Copy)]
struct Power(usize);

impl Power {
    fn conjugate(self) -> Self {
        Self((4 - self.0) % 4)
    }

    #[inline]
    fn apply(self, value: Complex64) -> Complex64 {
        match self.0 {
            0 => value,
            1 => Complex64::new(-value.im, value.re),
            2 => -value,
            _ => Complex64::new(value.im, -value.re),
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
