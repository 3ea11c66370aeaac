//! Plastic strain in Fourier space, and the residual stress transformed back.

use asperity_transforms::num_complex::Complex64;

use super::lanes::Lanes;
use super::sweep::{Sweep, SweepScratch};
use super::{COMPONENTS, INDEPENDENT, Layers};
use crate::grid::Grid;
use crate::math::parallel::{self, Pool};
use crate::math::{Planes, together};
use crate::units::Pascal;

/// Waves of a volume with a periodic surface; a smaller volume is padded with zeros.
pub(super) struct Waves {
    pub(super) planes: Planes,
    sweep: Sweep,
    layers: usize,
    /// Harmonics along y of all components, layer by layer: first of the strain, then of the stress.
    harmonics: Vec<Complex64>,
    /// Whether each component of the stored strain is nonzero.
    present: Vec<bool>,
    /// Harmonics along y of one field on the surface.
    surface: Vec<Complex64>,
    scratch: Pool<WavesScratch>,
}

/// Scratch memory of a thread.
struct WavesScratch {
    fft: Vec<Complex64>,
    /// Columns of a component, and of a sum over components.
    columns: [Vec<Complex64>; 2],
    sweep: SweepScratch,
    /// Amplitudes in the bins ±kx at one ky, `[kx, layer]`, kx = 0 … nx/2, with some room behind each kx.
    waves: Vec<[Lanes; COMPONENTS]>,
}

impl Waves {
    /// Creates the waves of a body on `grid`, with a surface of the `period` in cells.
    pub(super) fn new(grid: &Grid, period: [usize; 2], layers: &Layers, young: Pascal, poisson: f64) -> Self {
        let planes = Planes::new(period, grid.shape);
        let sweep = Sweep::new(layers, young, poisson, period, grid.pitch);
        let layers = layers.count();
        let harmonics = planes.harmonics(COMPONENTS * layers);
        let surface = planes.harmonics(1);
        Self {
            planes,
            sweep,
            layers,
            harmonics,
            present: vec![false; COMPONENTS * layers],
            surface,
            scratch: Pool::default(),
        }
    }

    /// Numbers at one frequency along y.
    fn at_frequency(&self) -> usize {
        COMPONENTS * self.layers * self.planes.shape()[0]
    }

    /// Layers from wave to wave, an odd number, so that neighbouring waves do not map to the same cache
    /// lines.
    fn stride(&self) -> usize {
        self.layers | 1
    }

    fn new_scratch(&self) -> WavesScratch {
        let bins = self.planes.shape()[0] / 2 + 1;
        WavesScratch {
            fft: self.planes.scratch(),
            columns: [self.planes.column(), self.planes.column()],
            sweep: self.sweep.scratch(),
            waves: vec![Default::default(); bins * self.stride()],
        }
    }

    /// Stores a plastic strain, `[layer, component, ix, iy]`. Returns whether it is nonzero.
    pub(super) fn take(&mut self, strain: &[f64]) -> bool {
        let cells = self.planes.cells();
        let planes: Vec<Option<&[f64]>> = strain
            .chunks_exact(cells[0] * cells[1])
            .enumerate()
            .map(|(plane, strain)| INDEPENDENT.contains(&(plane % COMPONENTS)).then_some(strain))
            .collect();
        self.present = self.planes.rows_forward(&planes, &mut self.harmonics);
        self.present.contains(&true)
    }

    /// Sums over the components of the stored strain, and transforms the sum back into a `field` on the
    /// surface. `add` adds the column of a component, by its plane and its ky, to the sum.
    pub(super) fn surface(
        &mut self,
        add: impl Fn([usize; 2], &[Complex64], &mut [Complex64]) + Sync,
        field: &mut [f64],
    ) {
        let mut surface = std::mem::take(&mut self.surface);
        let Self { planes, harmonics, present, scratch, .. } = &*self;
        parallel::each(
            planes.by_frequency(&mut surface).into_iter().enumerate(),
            together(self.at_frequency()),
            scratch,
            || self.new_scratch(),
            |WavesScratch { fft, columns: [column, sum], .. }, (ky, mut to)| {
                sum.fill(Complex64::default());
                for plane in (0..present.len()).filter(|plane| present[*plane]) {
                    planes.column_forward(planes.row(harmonics, plane, ky), column, fft);
                    add([plane, ky], column, sum);
                }
                planes.column_back(sum, to[0], fft);
            },
        );
        planes.rows_back(&surface, field, |_, _| ());
        self.surface = surface;
    }

    /// Replaces the stored strain by its residual stress if `any` is set, lets `change` alter the column of
    /// each component, by its plane and its ky, and transforms it back into `stress`. Then `finish` alters
    /// each row, by its plane and its ix.
    pub(super) fn stress(
        &mut self,
        any: bool,
        change: impl Fn([usize; 2], &mut [Complex64]) + Sync,
        finish: impl Fn([usize; 2], &mut [f64]) + Sync,
        stress: &mut [f64],
    ) {
        let mut harmonics = std::mem::take(&mut self.harmonics);
        let Self { planes, sweep, present, scratch, .. } = &*self;
        let stride = self.stride();
        parallel::each(
            planes.by_frequency(&mut harmonics).into_iter().enumerate(),
            together(self.at_frequency()),
            scratch,
            || self.new_scratch(),
            |WavesScratch { fft, columns: [column, _], sweep: scratch, waves }, (ky, mut harmonics)| {
                if any {
                    for (plane, harmonics) in harmonics.iter().enumerate() {
                        let (layer, component) = (plane / COMPONENTS, plane % COMPONENTS);
                        let waves =
                            waves[layer..].iter_mut().step_by(stride).map(|wave| &mut wave[component]);
                        if present[plane] {
                            planes.column_forward(harmonics, column, fft);
                            let opposite = column[..1].iter().chain(column.iter().rev());
                            waves
                                .zip(column.iter().zip(opposite))
                                .for_each(|(wave, (plus, minus))| *wave = Lanes::new(*plus, *minus));
                        } else {
                            waves.for_each(|wave| *wave = Lanes::default());
                        }
                    }
                    for (kx, wave) in waves.chunks_exact_mut(stride).enumerate() {
                        sweep.residual([kx, ky], &mut wave[..self.layers], scratch);
                    }
                }
                for (plane, harmonics) in harmonics.iter_mut().enumerate() {
                    if any {
                        let (layer, component) = (plane / COMPONENTS, plane % COMPONENTS);
                        let mut all = waves[layer..].iter().step_by(stride).map(|wave| wave[component]);
                        // Waves that are their own opposite: the first, and the last of an even number.
                        let (first, rest) = column.split_at_mut(1);
                        first.iter_mut().zip(&mut all).for_each(|(value, wave)| *value = wave.mean());
                        let (front, back) = rest.split_at_mut(rest.len() / 2);
                        let (middle, back) = back.split_at_mut(back.len() - front.len());
                        for ((plus, minus), wave) in front.iter_mut().zip(back.iter_mut().rev()).zip(&mut all)
                        {
                            (*plus, *minus) = (wave.plus(), wave.minus());
                        }
                        middle.iter_mut().zip(all).for_each(|(value, wave)| *value = wave.mean());
                    } else {
                        column.fill(Complex64::default());
                    }
                    change([plane, ky], column);
                    planes.column_back(column, harmonics, fft);
                }
            },
        );
        planes.rows_back(&harmonics, stress, finish);
        self.harmonics = harmonics;
    }
}
