//! Plastic strain in Fourier space, and the residual stress transformed back.

use asperity_transforms::num_complex::Complex64;

use super::sweep::{Sweep, SweepScratch};
use super::{COMPONENTS, Layers};
use crate::grid::Grid;
use crate::math::parallel::{self, Pool};
use crate::math::{Planes, together};
use crate::units::Pascal;

/// Independent components of plastic strain; zz follows from volume preservation.
pub(super) const INDEPENDENT: [usize; 5] = [0, 1, 3, 4, 5];

/// Waves of a volume with a periodic surface; a smaller volume is padded with zeros.
pub(super) struct Waves {
    pub(super) planes: Planes,
    sweep: Sweep,
    layers: usize,
    /// Transforms of the rows of the independent components, layer by layer.
    rows: Vec<Complex64>,
    /// Columns of all components, layer by layer: first of the strain, then of the stress.
    pub(super) columns: Vec<Complex64>,
}

/// Scratch memory of a thread.
pub(super) struct WavesScratch {
    pub(super) fft: Vec<Complex64>,
    /// A column.
    pub(super) column: Vec<Complex64>,
    sweep: SweepScratch,
}

impl Waves {
    /// Creates the waves of a body on `grid`, with a surface of the `period` in cells.
    pub(super) fn new(grid: &Grid, period: [usize; 2], layers: &Layers, young: Pascal, poisson: f64) -> Self {
        let planes = Planes::new(period, grid.shape);
        let sweep = Sweep::new(layers, young, poisson, period, grid.pitch);
        let layers = layers.count();
        let rows = planes.rows(INDEPENDENT.len() * layers);
        let columns = planes.columns(COMPONENTS * layers);
        Self { planes, sweep, layers, rows, columns }
    }

    /// Number of values at one frequency along y.
    pub(super) fn at_frequency(&self) -> usize {
        COMPONENTS * self.layers * self.planes.stride()
    }

    /// Stores a plastic strain, `[layer, component, ix, iy]`. Returns whether it is nonzero.
    pub(super) fn take(&mut self, strain: &[f64]) -> bool {
        let cells = self.planes.cells();
        let planes: Vec<&[f64]> = strain.chunks_exact(cells[0] * cells[1]).collect();
        let known: Vec<&[f64]> = planes
            .chunks_exact(COMPONENTS)
            .flat_map(|layer| INDEPENDENT.map(|component| layer[component]))
            .collect();
        let present = self.planes.rows_forward(&known, &mut self.rows);
        if !present.contains(&true) {
            return false;
        }
        let (chunk, stride) = (self.at_frequency(), self.planes.stride());
        let Self { planes, rows, columns, .. } = self;
        parallel::each(
            columns.chunks_exact_mut(chunk).enumerate(),
            together(chunk),
            &Pool::default(),
            || planes.scratch(),
            |scratch, (ky, columns)| {
                for (layer, columns) in columns.chunks_exact_mut(COMPONENTS * stride).enumerate() {
                    for (n, component) in INDEPENDENT.into_iter().enumerate() {
                        let plane = layer * INDEPENDENT.len() + n;
                        let column = &mut columns[component * stride..][..stride];
                        match present[plane] {
                            true => planes.column_forward(rows, [plane, ky], column, scratch),
                            false => column.fill(Complex64::default()),
                        }
                    }
                }
            },
        );
        true
    }

    /// Replaces the stored strain by its residual stress if `any` is set, lets `change` add to the columns of each
    /// frequency along y, and transforms the sum back into `stress`.
    pub(super) fn back(
        &mut self,
        any: bool,
        change: impl Fn(&Planes, usize, &mut [Complex64], &mut WavesScratch) + Sync,
        stress: &mut [f64],
    ) {
        let (chunk, stride) = (self.at_frequency(), self.planes.stride());
        let Self { planes, sweep, columns, .. } = self;
        let make = || WavesScratch {
            fft: planes.scratch(),
            column: vec![Complex64::default(); stride],
            sweep: sweep.scratch(),
        };
        parallel::each(
            columns.chunks_exact_mut(chunk).enumerate(),
            together(chunk),
            &Pool::default(),
            make,
            |scratch, (ky, columns)| {
                match any {
                    true => sweep.residual(planes, ky, columns, &mut scratch.sweep),
                    false => columns.fill(Complex64::default()),
                }
                change(planes, ky, columns, scratch);
                for column in columns.chunks_exact_mut(stride) {
                    planes.column_back(column, &mut scratch.fft);
                }
            },
        );
        self.planes.rows_back(&self.columns, stress);
    }
}
