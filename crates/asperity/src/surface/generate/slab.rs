//! Random topographies of which each rank makes its slab.

use super::noise::{check_cells, white_noise};
use super::{Autocorrelation, Generator, HeightDistribution, LowPass, SelfAffine};
use crate::error::Result;
use crate::grid::Field;
use crate::math::SlabTransform;
use crate::ranks::Slab;
use crate::units::Metre;

impl Generator {
    /// Whether each rank makes its rows alone: heights of another distribution than Gaussian ones are made as a whole.
    pub fn makes_slabs(&self) -> bool {
        match self {
            Self::LowPass(LowPass { heights, .. })
            | Self::Autocorrelation(Autocorrelation { heights, .. }) => {
                *heights == HeightDistribution::GAUSSIAN
            }
            Self::SelfAffine(_) => true,
        }
    }

    /// The heights on a `slab` of what [`Generator::generate`] makes, to the round-off of sums; those of its underside, if it
    /// is turned over. All ranks make them together.
    ///
    /// # Errors
    /// [`crate::Error::OutOfRange`] if a parameter has no meaning, or none on this grid.
    ///
    /// # Panics
    /// Unless it [makes slabs](Self::makes_slabs).
    pub fn generate_slab(&self, slab: &Slab, seed: u64, turned_over: bool) -> Result<Field> {
        assert!(self.makes_slabs(), "heights that are Gaussian");
        let grid = slab.whole_grid();
        match self {
            Self::LowPass(method) => {
                let shape = method.shape(&grid)?;
                let transform = SlabTransform::new(slab.ranks(), shape);
                let spectrum = method.spectrum(shape, grid.pitch, transform.frequencies());
                stationary(slab, &transform, spectrum, seed, method.sq, turned_over)
            }
            Self::Autocorrelation(method) => {
                let shape = method.shape(&grid)?;
                let transform = SlabTransform::new(slab.ranks(), shape);
                let covariance = method.covariance(shape, grid.pitch);
                let [nx, ny] = shape;
                let row = |ix: usize, values: &mut [f64]| {
                    for (iy, value) in values.iter_mut().enumerate() {
                        // Point-symmetric: the rows −i are the rows i backwards.
                        *value = if 2 * ix > nx {
                            covariance(nx - ix, (ny - iy) % ny)
                        } else {
                            covariance(ix, iy)
                        };
                    }
                };
                let spectrum = transform.forward(row).mapv(|value| value.re.max(0.0));
                stationary(slab, &transform, spectrum, seed, method.sq, turned_over)
            }
            Self::SelfAffine(method) => self_affine(method, slab, seed, turned_over),
        }
    }
}

/// White noise filtered to a `spectrum`, of which each rank has its frequencies, cut to the grid, its mean removed, and scaled
/// to the rms height `sq`.
fn stationary(
    slab: &Slab,
    transform: &SlabTransform,
    spectrum: Field,
    seed: u64,
    sq: Metre,
    turned_over: bool,
) -> Result<Field> {
    let grid = slab.whole_grid();
    check_cells(&grid)?;
    let mut noise = white_noise(seed);
    let mut rows = 0;
    let mut columns = transform.forward(|ix, values| {
        // The numbers of the rows before are those of other ranks.
        while rows < ix {
            noise.by_ref().take(values.len()).for_each(drop);
            rows += 1;
        }
        values.iter_mut().zip(&mut noise).for_each(|(value, n)| *value = n);
        rows += 1;
    });
    columns.zip_mut_with(&spectrum, |value, s| *value *= s.sqrt());
    let mut heights = transform.inverse(columns, slab, turned_over);
    let cells = grid.cells() as f64;
    let [sum] = slab.merged([heights.sum()]);
    heights -= sum / cells;
    let [squares] = slab.merged([heights.iter().map(|z| z * z).sum::<f64>()]);
    let sign = if turned_over { -1.0 } else { 1.0 };
    heights *= sign * sq / (squares / cells).sqrt();
    Ok(heights)
}

fn self_affine(method: &SelfAffine, slab: &Slab, seed: u64, turned_over: bool) -> Result<Field> {
    let grid = slab.whole_grid();
    let transform = SlabTransform::new(slab.ranks(), grid.shape);
    let (mut spectrum, squares) = method.spectrum(&grid, seed, transform.frequencies())?;
    let scale = method.scale(&grid, slab.merged(squares))?;
    let sign = if turned_over { -1.0 } else { 1.0 };
    spectrum.mapv_inplace(|value| value * (sign * scale));
    Ok(transform.inverse(spectrum, slab, turned_over))
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::Grid;
    use crate::ranks::threads::on_ranks;
    use crate::surface::{Amplitude, Topography};

    #[test]
    fn slabs_are_those_of_the_whole() {
        let generators = [
            Generator::LowPass(LowPass::new(2e-7, [4e-6, 4e-6])),
            Generator::Autocorrelation(Autocorrelation::new(2e-7, [2e-6, 4e-6])),
            Generator::SelfAffine(SelfAffine {
                hurst: 0.8,
                rolloff: Some(8e-6),
                shortest: None,
                amplitude: Amplitude::Sdq(0.1),
            }),
        ];
        for (shape, count) in [([48, 35], 3), ([32, 40], 4), ([33, 24], 2), ([32, 24], 1)] {
            let grid = Grid::new(shape, [0.5e-6, 1e-6]).unwrap();
            for generator in generators {
                let whole = generator.generate(&grid, 5).unwrap();
                for (turned_over, whole) in [(false, whole.clone()), (true, whole.underside())]
                    .map(|(t, w)| (t, Topography::into_heights(w)))
                {
                    let found = on_ranks(count, |ranks| {
                        let slab = Slab::new(ranks, grid).unwrap();
                        let heights = generator.generate_slab(&slab, 5, turned_over).unwrap();
                        slab.collected(&heights)
                    });
                    for (a, b) in found.iter().flatten().zip(whole.iter().cycle()) {
                        assert!((a - b).abs() < 1e-19, "{generator:?} on {count} ranks: {a:e}, {b:e}");
                    }
                }
            }
        }
    }
}
