//! Segmentation of a topography into hills and dales by its course and ridge lines.

mod relief;
mod watershed;

use ndarray::Array2;

use crate::{NEVER, Stop, Topography, check_stop};
use asperity_base::error::{Result, check};
use asperity_base::units::{CubicMetre, Metre, SquareMetre};
use relief::Relief;
use watershed::{Pruned, Watershed};

/// Wolf pruning of ISO 25178-3, as a fraction of Sz.
pub const WOLF_PRUNING: f64 = 0.05;

/// A topography divided into hills around its peaks, or into dales around its pits.
///
/// A Maxwellian hill is the area from which the steepest upward paths end at the same peak (ISO 25178-2:2012,
/// 3.3.1; Maxwell, Phil. Mag. 40, 421 (1870)). A sample belongs to the hill of the steepest of its eight
/// neighbours, with the true distance to diagonal ones. On a plateau the shortest path to a rise is followed;
/// a plateau without a rise is one peak, at its first sample. Dales are the hills of −z, also with eight
/// neighbours, so that a ridge and a course line may cross between four samples.
///
/// Low hills and shallow dales are pruned independently (ISO 16610-85; Wolf, Computers & Geosciences 17, 1359
/// (1991); Scott, Proc. R. Soc. Lond. A 460, 2845 (2004)). As long as a peak is less than the threshold above
/// the highest saddle around its hill, the lowest such hill is merged with the one across that saddle. The
/// peak is thus the highest sample of its hill.
///
/// An undefined sample is not a neighbour. Samples separated from all others by holes form an island, whose
/// highest peak is measured from the lowest sample. If even that is below the threshold, and on a plane,
/// there is no hill.
#[derive(Debug, Clone, PartialEq)]
pub struct Segmentation {
    /// For each sample the number of its hill or dale, from 1 in the order of `motifs`; 0 without one.
    pub labels: Array2<u32>,
    /// The hills, highest peak first, or the dales, deepest pit first.
    pub motifs: Vec<Motif>,
}

/// A hill with its peak, or a dale with its pit.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Motif {
    /// The sample `[ix, iy]` of the peak or pit.
    pub at: [usize; 2],
    /// Height z of the peak or pit in the topography.
    pub height: Metre,
    /// Height z of the connecting saddle: the highest around a hill, the lowest around a dale. For the only
    /// hill of an island it is the lowest sample, for the only dale the highest.
    pub saddle: Metre,
    /// Threshold above which it would be pruned, > 0: the height of the peak above the saddle towards a
    /// higher peak, or of an island's highest peak above its lowest sample. ≥ |height − saddle|.
    pub prominence: Metre,
    /// Mean curvature −½ (∂²z/∂x² + ∂²z/∂y²) at the peak or pit, 1/m: ≥ 0 at a peak, ≤ 0 at a pit.
    ///
    /// From the second differences (z₊₁ − 2 z₀ + z₋₁)/Δx², with a relative error of −(2πΔx/λ)²/12 for a wave
    /// of length λ. NaN beside an undefined sample and at the boundary; the curvature along a direction with
    /// one sample is 0.
    pub curvature: f64,
    /// Area of its samples.
    pub area: SquareMetre,
    /// Volume of the hill above the height of its saddle, or of the dale below it, which it holds before it
    /// overflows.
    pub volume: CubicMetre,
    /// Whether it does not reach the boundary of the measured area at the height of 50 % material ratio. Then
    /// no sample at the boundary is as high as that height in the hill, or as low in the dale. The boundary
    /// is the edge of the grid, or that of undefined samples connected to the edge. Inner holes and the sides
    /// of a single row do not count.
    pub closed: bool,
}

impl Motif {
    /// Local peak height or pit depth, Lpvh of ISO 25178-2: |height − saddle|, at least the pruning
    /// threshold.
    pub fn local_height(&self) -> Metre {
        (self.height - self.saddle).abs()
    }
}

impl Topography {
    /// Segments the hills at least `pruning` · Sz above their saddles; [`WOLF_PRUNING`] is usual.
    ///
    /// # Errors
    /// [`asperity_base::Error::OutOfRange`] if `pruning` is not from 0 to 1.
    pub fn hills(&self, pruning: f64) -> Result<Segmentation> {
        self.hills_until(pruning, NEVER)
    }

    /// [`hills`](Self::hills) that can be stopped by `stop`.
    ///
    /// # Errors
    /// The errors of [`hills`](Self::hills); [`asperity_base::Error::Interrupted`].
    pub fn hills_until(&self, pruning: f64, stop: Stop<'_>) -> Result<Segmentation> {
        segment(self, 1.0, pruning, stop)
    }

    /// Segments the dales at least `pruning` · Sz below their saddles; [`WOLF_PRUNING`] is usual.
    ///
    /// # Errors
    /// [`asperity_base::Error::OutOfRange`] if `pruning` is not from 0 to 1.
    pub fn dales(&self, pruning: f64) -> Result<Segmentation> {
        self.dales_until(pruning, NEVER)
    }

    /// [`dales`](Self::dales) that can be stopped by `stop`.
    ///
    /// # Errors
    /// The errors of [`dales`](Self::dales); [`asperity_base::Error::Interrupted`].
    pub fn dales_until(&self, pruning: f64, stop: Stop<'_>) -> Result<Segmentation> {
        segment(self, -1.0, pruning, stop)
    }
}

/// Segments the hills of `up` · z.
fn segment(topography: &Topography, up: f64, pruning: f64, stop: Stop<'_>) -> Result<Segmentation> {
    check("pruning", pruning, (0.0..=1.0).contains(&pruning), "a share of Sz from 0 to 1")?;
    let relief = Relief::new(topography, up);
    let mut defined: Vec<f64> = relief.z.iter().copied().filter(|z| !z.is_nan()).collect();
    if defined.is_empty() {
        return Ok(Segmentation { labels: Array2::zeros(topography.grid().shape), motifs: Vec::new() });
    }
    let middle = defined.len() / 2;
    let half = *defined.select_nth_unstable_by(middle, |a, b| b.total_cmp(a)).1;
    let highest = defined.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    let lowest = defined.iter().copied().fold(f64::INFINITY, f64::min);
    let Pruned { of, hills } = Watershed::from_relief(&relief, stop)?.prune(pruning * (highest - lowest));

    let mut motifs: Vec<Motif> = hills
        .iter()
        .map(|hill| Motif {
            at: relief.sample(hill.peak),
            height: relief.z[hill.peak],
            saddle: hill.saddle,
            prominence: hill.prominence,
            curvature: relief.curvature(hill.peak),
            area: 0.0,
            volume: 0.0,
            closed: true,
        })
        .collect();
    check_stop(stop)?;
    let labels = Array2::from_shape_fn(topography.grid().shape, |(ix, iy)| of[relief.cell(ix, iy)]);
    check_stop(stop)?;
    let rim = relief.rim();
    check_stop(stop)?;
    let cell_area = topography.grid().cell_area();
    for ((ix, iy), &label) in labels.indexed_iter().filter(|(_, label)| **label > 0) {
        let (motif, cell) = (&mut motifs[label as usize - 1], relief.cell(ix, iy));
        let z = relief.z[cell];
        motif.area += cell_area;
        motif.volume += cell_area * (z - motif.saddle).max(0.0);
        motif.closed &= !(rim[cell] && z >= half);
    }
    for motif in &mut motifs {
        for value in [&mut motif.height, &mut motif.saddle, &mut motif.curvature] {
            *value *= up;
        }
    }
    Ok(Segmentation { labels, motifs })
}

#[cfg(test)]
mod tests {
    use std::cmp::Ordering;
    use std::f64::consts::{PI, TAU};

    use approx::assert_relative_eq;
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;

    use super::*;
    use asperity_base::grid::{Field, Grid};

    fn topography(heights: Field) -> Topography {
        Topography::new(Grid::new(heights.dim().into(), [1.0, 1.0]).unwrap(), heights).unwrap()
    }

    /// ½ (cos kx + cos ky) with `n` samples of pitch 1 per wave, n odd, and m × m whole waves. Each square of
    /// n × n samples is a hill with a peak in its middle; the saddles between them are at height 0.
    fn egg_box(n: usize, m: usize) -> Topography {
        let cosine = |i: usize| (TAU * (i as f64 - 0.5 * (n as f64 - 1.0)) / n as f64).cos();
        topography(Field::from_shape_fn([n * m, n * m], |(ix, iy)| 0.5 * (cosine(ix) + cosine(iy))))
    }

    #[test]
    fn what_takes_long_asks_often_and_stops_at_any_question() {
        use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

        use crate::{Fill, Parameters, Preparation};
        use asperity_base::error::Error;

        let surface = egg_box(15, 9);
        type Work = fn(&Topography, Stop<'_>) -> Result<()>;
        let works: [(&str, usize, Work); 4] = [
            ("hills", 8, |surface, stop| surface.hills_until(WOLF_PRUNING, stop).map(drop)),
            ("parameters", 16, |surface, stop| Parameters::until(surface, stop).map(drop)),
            ("despike", 100, |surface, stop| surface.clone().despike_until(6.0, stop).map(drop)),
            ("preparation", 5, |surface, stop| {
                let preparation = Preparation { fill: Fill::Nearest, ..Preparation::default() };
                preparation.apply_until(surface.clone(), stop).map(drop)
            }),
        ];
        for (name, least, work) in works {
            let asked = AtomicUsize::new(0);
            work(&surface, &|| asked.fetch_add(1, Relaxed) > usize::MAX / 2).unwrap();
            let all = asked.into_inner();
            assert!(all >= least, "{name} asks {all} times");
            for last in 0..all.min(12) {
                let asked = AtomicUsize::new(0);
                let stopped = work(&surface, &|| asked.fetch_add(1, Relaxed) >= last);
                assert!(matches!(stopped, Err(Error::Interrupted)), "{name} goes on after question {last}");
            }
        }
    }

    #[test]
    fn an_egg_box_is_divided_into_its_squares() {
        let segmentation = egg_box(15, 5).hills(WOLF_PRUNING).unwrap();
        assert_eq!(segmentation.motifs.len(), 25);
        for (hill, motif) in segmentation.motifs.iter().enumerate() {
            assert_eq!(motif.area, 225.0);
            let [x, y] = motif.at.map(|i| i / 15);
            assert_eq!(motif.at, [15 * x + 7, 15 * y + 7]);
            let square = segmentation.labels.slice(ndarray::s![15 * x..15 * (x + 1), 15 * y..15 * (y + 1)]);
            assert!(square.iter().all(|&label| label as usize == hill + 1));
            // The boundary passes through the saddles between the outer peaks and the next ones outside.
            assert_eq!(motif.closed, [x, y].iter().all(|i| (1..4).contains(i)));
        }
    }

    #[test]
    fn height_volume_and_curvature_of_an_egg_box_converge_at_second_order() {
        let errors = |n: usize| {
            let hill = egg_box(n, 3).hills(WOLF_PRUNING).unwrap().motifs[4];
            let k = TAU / n as f64;
            // The sample closest to the saddle is half a pitch away.
            assert_relative_eq!(
                hill.local_height(),
                0.5 * (1.0 + (PI / n as f64).cos()),
                max_relative = 1e-14
            );
            assert_relative_eq!(hill.height, 1.0);
            // Above z = 0: |x| + |y| < λ/2, where the integral of the height is 8/k².
            [
                hill.local_height() - 1.0,
                hill.volume / (8.0 / (k * k)) - 1.0,
                hill.curvature / (0.5 * k * k) - 1.0,
            ]
        };
        let (coarse, fine) = (errors(15), errors(45));
        for (coarse, fine) in coarse.iter().zip(fine) {
            let order = (coarse / fine).ln() / 3f64.ln();
            assert!((1.9..2.1).contains(&order), "error {coarse:e} → {fine:e} is order {order:.2}");
        }
        assert_relative_eq!(fine[2], -(TAU / 45.0).powi(2) / 12.0, max_relative = 0.01);
    }

    #[test]
    fn a_low_noise_does_not_change_the_hills_that_pruning_leaves() {
        let mut random = ChaCha8Rng::seed_from_u64(1);
        let mut rough = egg_box(63, 3);
        // Heights changed by at most 0.02 move a saddle relative to its peak by 0.04; the pruning is 5 % of
        // Sz = 2.
        rough.heights_mut().mapv_inplace(|z| z + 0.02 * (2.0 * random.random::<f64>() - 1.0));
        assert!(rough.hills(0.0).unwrap().motifs.len() > 50);
        assert_eq!(rough.hills(WOLF_PRUNING).unwrap().motifs.len(), 9);
        assert_eq!(rough.dales(WOLF_PRUNING).unwrap().motifs.len(), 16);
    }

    #[test]
    fn the_lower_of_two_summits_is_pruned_above_the_depth_of_the_saddle_between_them() {
        let summit = |x: f64, y: f64| (-(x * x + y * y) / 100.0).exp();
        let height = |x: f64, y: f64| summit(x + 16.0, y) + 0.8 * summit(x - 16.0, y);
        let summits =
            topography(Field::from_shape_fn([81, 41], |(ix, iy)| height(ix as f64 - 40.0, iy as f64 - 20.0)));
        // The best path between them is the row that contains both.
        let row = summits.heights().column(20);
        let saddle = row.iter().skip(24).take(33).fold(f64::INFINITY, |low, &z| z.min(low));
        let lower = row.iter().skip(40).fold(0.0, |high: f64, &z| z.max(high));
        let highest = row.iter().fold(0.0, |high: f64, &z| z.max(high));
        let lowest = summits.heights().iter().fold(1.0, |low: f64, &z| z.min(low));
        let depth = (lower - saddle) / (highest - lowest);
        let below = summits.hills(depth * (1.0 - 1e-12)).unwrap();
        assert_eq!(below.motifs.iter().map(|hill| hill.at).collect::<Vec<_>>(), [[24, 20], [56, 20]]);
        assert!(below.motifs.iter().all(|hill| hill.saddle == saddle));
        assert_eq!(below.motifs[0].prominence, highest - lowest);
        assert_eq!(below.motifs[1].prominence, lower - saddle);
        let above = summits.hills(depth * (1.0 + 1e-12)).unwrap();
        assert_eq!(above.motifs.len(), 1);
        assert_eq!((above.motifs[0].area, above.motifs[0].saddle), (81.0 * 41.0, lowest));
    }

    #[test]
    fn a_pruned_hill_goes_to_the_one_across_its_saddle_not_to_the_highest() {
        let row = [0.0, 9.0, 2.0, 6.0, 5.0, 5.5, 0.0];
        let ridge = topography(Field::from_shape_fn([7, 1], |(ix, _)| row[ix]));
        let hills = ridge.hills(0.1).unwrap();
        assert_eq!(hills.labels.iter().copied().collect::<Vec<_>>(), [1, 1, 1, 2, 2, 2, 2]);
        assert_eq!(hills.motifs.iter().map(|hill| hill.volume).collect::<Vec<_>>(), [7.0, 4.0 + 3.0 + 3.5]);
    }

    #[test]
    fn dales_are_the_hills_of_the_surface_upside_down() {
        let rough = random_topography(24, 31);
        let dales = rough.dales(WOLF_PRUNING).unwrap();
        let mut hills = topography(-rough.heights()).hills(WOLF_PRUNING).unwrap();
        assert!(dales.motifs.len() > 5);
        for hill in &mut hills.motifs {
            *hill = Motif { height: -hill.height, saddle: -hill.saddle, curvature: -hill.curvature, ..*hill };
        }
        // Curvatures at the border are undefined.
        let text = |segmentation: &Segmentation| format!("{segmentation:?}");
        assert_eq!(text(&dales), text(&hills));
        assert!(dales.motifs.iter().all(|dale| dale.height < dale.saddle && dale.curvature.max(-1.0) <= 0.0));
    }

    #[test]
    fn a_mirrored_surface_has_mirrored_hills() {
        let rough = random_topography(24, 31);
        let hills = rough.hills(WOLF_PRUNING).unwrap();
        for axis in [0, 1] {
            let mut mirrored = rough.heights().clone();
            mirrored.invert_axis(ndarray::Axis(axis));
            let mut labels = topography(mirrored).hills(WOLF_PRUNING).unwrap().labels;
            labels.invert_axis(ndarray::Axis(axis));
            assert_eq!(labels, hills.labels);
        }
    }

    #[test]
    fn a_plateau_is_one_peak_and_a_terrace_none() {
        // A horseshoe on a slope: its first samples in order are at its two ends.
        let picture = ["0000000", "0900900", "0900900", "0999900", "0111110", "0000000"];
        let height = |ix: usize, iy: usize| f64::from(picture[iy].as_bytes()[ix] - b'0');
        let horseshoe = topography(Field::from_shape_fn([7, 6], |(ix, iy)| height(ix, iy)));
        let hills = horseshoe.hills(0.0).unwrap();
        assert_eq!(
            hills.motifs.iter().map(|hill| (hill.at, hill.area)).collect::<Vec<_>>(),
            [([1, 1], 42.0)]
        );
        // A terrace between two summits is divided in the middle.
        let terrace = topography(Field::from_shape_fn([10, 1], |(ix, _)| {
            [4.0, 1.0, 3.0][usize::from(ix > 0) + usize::from(ix > 8)]
        }));
        let labels = terrace.hills(0.0).unwrap().labels;
        assert_eq!(labels.iter().copied().collect::<Vec<_>>(), [1, 1, 1, 1, 1, 2, 2, 2, 2, 2]);
    }

    #[test]
    fn holes_divide_islands_and_the_low_ones_have_no_hill() {
        let mut heights = Field::from_shape_fn([30, 9], |(ix, iy)| {
            -((ix as f64 - 7.0).powi(2) + (iy as f64 - 4.0).powi(2))
        });
        heights.slice_mut(ndarray::s![15, ..]).fill(f64::NAN);
        heights.slice_mut(ndarray::s![16.., ..]).mapv_inplace(|_| -50.0);
        heights[[20, 4]] = -49.0;
        let hills = topography(heights.clone()).hills(WOLF_PRUNING).unwrap();
        assert_eq!(
            hills.motifs.iter().map(|hill| (hill.at, hill.area)).collect::<Vec<_>>(),
            [([7, 4], 135.0)]
        );
        assert!(hills.labels.slice(ndarray::s![15.., ..]).iter().all(|&label| label == 0));
        heights[[20, 4]] = -40.0;
        let hills = topography(heights).hills(WOLF_PRUNING).unwrap();
        assert_eq!(
            hills.motifs[1],
            Motif {
                at: [20, 4],
                height: -40.0,
                saddle: -50.0,
                prominence: 10.0,
                area: 126.0,
                volume: 10.0,
                curvature: 20.0,
                closed: false
            }
        );
    }

    #[test]
    fn a_hole_inside_is_no_rim_but_the_end_of_the_data_is() {
        let mut holed = egg_box(15, 5);
        holed.heights_mut()[[37, 40]] = f64::NAN;
        let centre = |topography: &Topography| {
            let motifs = topography.hills(WOLF_PRUNING).unwrap().motifs;
            *motifs.iter().find(|hill| hill.at == [37, 37]).unwrap()
        };
        assert!(centre(&holed).closed);
        assert_eq!(centre(&holed).area, 224.0);
        holed.heights_mut().slice_mut(ndarray::s![37, 40..]).fill(f64::NAN);
        assert!(!centre(&holed).closed);
    }

    #[test]
    fn each_sample_is_in_one_hill_whose_peak_is_highest_and_above_the_threshold() {
        arbtest::arbtest(|u| {
            let shape = [u.int_in_range(1..=7)?, u.int_in_range(1..=6)?];
            let mut heights = Field::zeros(shape);
            for z in &mut heights {
                *z = match u.int_in_range(0..=9)? {
                    0 => f64::NAN,
                    _ => f64::from(u.int_in_range(0..=12)?),
                };
            }
            let pruning = f64::from(u.int_in_range(0..=5)?) / 12.0;
            let rough = topography(heights);
            let segmentation = rough.hills(pruning).unwrap();
            let (peaks, in_hill) = peaks_by_bottleneck(rough.heights(), pruning);
            let found: Vec<_> = segmentation.motifs.iter().map(|hill| (hill.at, hill.prominence)).collect();
            assert_eq!(found, peaks);
            for ((at, &label), &in_hill) in segmentation.labels.indexed_iter().zip(&in_hill) {
                assert_eq!(label > 0, in_hill, "at {at:?}");
                assert!(label == 0 || rough.heights()[at] <= segmentation.motifs[label as usize - 1].height);
            }
            let lowest = peaks.iter().fold(f64::INFINITY, |low, peak| peak.1.min(low));
            for (hill, motif) in segmentation.motifs.iter().enumerate() {
                assert_eq!(segmentation.labels[motif.at] as usize, hill + 1);
                assert!((lowest..=motif.prominence).contains(&motif.local_height()));
                let area = segmentation.labels.iter().filter(|&&label| label as usize == hill + 1).count();
                assert_eq!(motif.area, area as f64);
            }
            Ok(())
        });
    }

    /// Returns the peaks with their prominence, highest first, and the samples on an island with a peak. It
    /// uses the lowest sample on the best path between any two samples, by the Floyd–Warshall recursion.
    fn peaks_by_bottleneck(z: &Field, pruning: f64) -> (Vec<([usize; 2], f64)>, Vec<bool>) {
        let samples: Vec<(usize, usize)> = z.indexed_iter().map(|(at, _)| at).collect();
        let n = samples.len();
        let beside = |a: (usize, usize), b: (usize, usize)| a.0.abs_diff(b.0) <= 1 && a.1.abs_diff(b.1) <= 1;
        // −∞ without a path; comparisons with NaN are false.
        let mut way = Field::from_shape_fn([n, n], |(a, b)| {
            let (low, high) = (z[samples[a]].min(z[samples[b]]), z[samples[a]].max(z[samples[b]]));
            if beside(samples[a], samples[b]) && !(z[samples[a]] + z[samples[b]]).is_nan() {
                low.min(high)
            } else {
                f64::NEG_INFINITY
            }
        });
        for via in 0..n {
            for a in 0..n {
                for b in 0..n {
                    way[[a, b]] = way[[a, b]].max(way[[a, via]].min(way[[via, b]]));
                }
            }
        }
        let defined = || z.iter().copied().filter(|z| !z.is_nan());
        let sz = defined().fold(f64::NEG_INFINITY, f64::max) - defined().fold(f64::INFINITY, f64::min);
        let higher =
            |a: usize, b: usize| z[samples[a]] > z[samples[b]] || (z[samples[a]] == z[samples[b]] && a < b);
        let reached = |a: usize, b: usize| way[[a, b]] > f64::NEG_INFINITY;
        let mut peaks: Vec<(usize, f64)> = (0..n)
            .filter(|&a| !z[samples[a]].is_nan())
            .map(|a| {
                let saddle =
                    (0..n).filter(|&b| higher(b, a) && reached(a, b)).map(|b| way[[a, b]]).reduce(f64::max);
                let foot =
                    (0..n).filter(|&b| reached(a, b)).map(|b| z[samples[b]]).fold(f64::INFINITY, f64::min);
                (a, z[samples[a]] - saddle.unwrap_or(foot))
            })
            .filter(|&(_, prominence)| prominence > 0.0 && prominence >= pruning * sz)
            .collect();
        peaks.sort_by(|&(a, _), &(b, _)| if higher(a, b) { Ordering::Less } else { Ordering::Greater });
        let in_hill = (0..n).map(|a| peaks.iter().any(|&(peak, _)| reached(a, peak))).collect();
        (peaks.into_iter().map(|(a, prominence)| (samples[a].into(), prominence)).collect(), in_hill)
    }

    #[test]
    fn a_pruning_beyond_the_whole_height_is_refused() {
        for pruning in [-0.1, 1.1, f64::NAN] {
            let refused = egg_box(5, 1).hills(pruning).unwrap_err();
            assert!(refused.to_string().starts_with("pruning is "), "{refused}");
        }
    }

    fn random_topography(nx: usize, ny: usize) -> Topography {
        let mut random = ChaCha8Rng::seed_from_u64(7);
        topography(Field::from_shape_simple_fn([nx, ny], || random.random()))
    }
}
