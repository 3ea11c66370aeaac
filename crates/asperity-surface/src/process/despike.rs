//! Removal of spikes.

use super::median::median;
use crate::{NEVER, Stop, Topography, check_stop};
use asperity_base::error::{Result, check};
use asperity_base::grid::Field;
use asperity_base::math::parallel;

/// Samples on each side of the judged one along x and y: 5 × 5 in all.
const REACH: usize = 2;

/// Strides of the neighbouring samples, in turn: first every second sample, over 9 × 9.
const STRIDES: [usize; 2] = [2, 1];

/// Width of the surroundings of a spike.
const SURROUNDINGS: usize = 2;

/// Largest fraction of the samples next to a spike that may stand out with it.
const OPEN: f64 = 0.25;

impl Topography {
    /// Makes the spikes of the topography undefined: samples, and groups of adjacent samples up to about 5 ×
    /// 5, whose deviation exceeds `factor` standard deviations. It must exceed them both for the surroundings
    /// and for the deviations over the whole topography. Factors of 5 to 10 are usual.
    ///
    /// Candidates have such a deviation from the median of 5 × 5 samples. First every second sample is used,
    /// so that a spike of 5 × 5 is not a majority, then every one. This is Hampel's identifier (Davies &
    /// Gather, J. Am. Stat. Assoc. 88, 782 (1993)), which preserves a rough part of a smooth surface.
    /// Adjacent candidates with similar deviations, of the same sign and within a factor of two, are judged
    /// together, using the samples around all of them, within two of any. They stay if they are longer along
    /// x or y than the 5 samples, like a groove, or if they continue. They continue if more than a quarter of
    /// the samples next to them stand out by half as much as they do, as at the corner of a step.
    ///
    /// The standard deviations are robust: 1.4826 times the median of the absolute deviations, on which
    /// spikes have little effect. If the median over the whole topography is 0, because more than half of the
    /// samples do not deviate, it is 1.2533 times their mean (Iglewicz & Hoaglin, How to Detect and Handle
    /// Outliers, 1993). Only defined samples count. Towards a boundary the neighbourhood of the median
    /// shrinks symmetrically, so that a plane has no spikes.
    ///
    /// # Errors
    /// [`asperity_base::Error::OutOfRange`] unless the factor is above 0.
    pub fn despike(self, factor: f64) -> Result<Self> {
        self.despike_until(factor, NEVER)
    }

    /// [`despike`](Self::despike) that can be stopped by `stop`.
    ///
    /// # Errors
    /// The errors of [`despike`](Self::despike); [`asperity_base::Error::Interrupted`].
    pub fn despike_until(mut self, factor: f64, stop: Stop<'_>) -> Result<Self> {
        check("despike", factor, factor > 0.0 && factor.is_finite(), "a number above 0 such as 6")?;
        for stride in STRIDES {
            let spikes = spikes(self.heights(), factor, stride, stop)?;
            spikes.into_iter().for_each(|at| self.heights_mut()[at] = f64::NAN);
        }
        Ok(self)
    }
}

/// Ratio of the standard deviation of Gaussian heights to the median of their absolute deviations.
const SIGMA: f64 = 1.4826;

/// Returns the spikes relative to medians of samples with this stride.
fn spikes(z: &Field, factor: f64, stride: usize, stop: Stop<'_>) -> Result<Vec<(usize, usize)>> {
    let deviations = deviations(z, stride, stop)?;
    let mut sizes: Vec<f64> = deviations.iter().filter(|d| !d.is_nan()).map(|d| d.abs()).collect();
    if sizes.is_empty() {
        return Ok(Vec::new());
    }
    let sigma = match SIGMA * median(&mut sizes) {
        0.0 => 1.2533 * sizes.iter().sum::<f64>() / sizes.len() as f64,
        sigma => sigma,
    };
    let (nx, ny) = z.dim();
    let mut candidates = deviations;
    let mut around = Vec::new();
    for ((ix, iy), deviation) in candidates.indexed_iter_mut() {
        if iy == 0 {
            check_stop(stop)?;
        }
        let is_one = deviation.abs() > factor * sigma && {
            let there = |i: usize, n: usize| {
                let start = i - stride * REACH.min(i / stride);
                (start..(i + stride * REACH + 1).min(n)).step_by(stride)
            };
            defined(z, there(ix, nx), there(iy, ny), &mut around);
            deviation.abs() > factor * SIGMA * median_deviation(&mut around).1
        };
        if !is_one {
            *deviation = 0.0;
        }
    }
    let groups = groups(candidates);
    let groups = groups.into_iter().filter(|group| extent(group) <= 2 * REACH * stride);
    let mut spikes = Vec::new();
    for group in groups {
        check_stop(stop)?;
        spikes.extend(outliers(z, group, factor, sigma));
    }
    Ok(spikes)
}

/// Returns the samples of a group that stand out from the surroundings of the whole group.
fn outliers(z: &Field, group: Vec<(usize, usize)>, factor: f64, sigma: f64) -> Vec<(usize, usize)> {
    let mut around: Vec<_> = group
        .iter()
        .flat_map(|at| within(z.dim(), *at, SURROUNDINGS))
        .filter(|at| !z[*at].is_nan() && group.binary_search(at).is_err())
        .collect();
    around.sort_unstable();
    around.dedup();
    if around.is_empty() {
        return Vec::new();
    }
    let mut heights: Vec<f64> = around.iter().map(|at| z[*at]).collect();
    let (middle, deviation) = median_deviation(&mut heights);
    let least = factor * sigma.max(SIGMA * deviation);
    let n_candidates = group.len();
    let found: Vec<_> = group.into_iter().filter(|at| (z[*at] - middle).abs() > least).collect();
    if 2 * found.len() < n_candidates {
        return Vec::new();
    }

    let half = 0.5 * median(&mut found.iter().map(|at| z[*at] - middle).collect::<Vec<_>>());
    let goes_on = |at: &(usize, usize)| (z[*at] - middle) / half > 1.0;
    let touches =
        |at: &&(usize, usize)| found.iter().any(|(x, y)| x.abs_diff(at.0).max(y.abs_diff(at.1)) == 1);
    let next: Vec<_> = around.iter().filter(touches).collect();
    let open = next.iter().filter(|at| goes_on(at)).count();
    if open as f64 > OPEN * next.len() as f64 { Vec::new() } else { found }
}

/// Groups the candidates, which have a nonzero deviation. Adjacent candidates, also at a corner, belong
/// together if their deviations have the same sign and agree within a factor of two. Each group is sorted.
fn groups(mut candidates: Field) -> Vec<Vec<(usize, usize)>> {
    let starts: Vec<_> = candidates.indexed_iter().filter(|(_, d)| **d != 0.0).map(|(at, _)| at).collect();
    let mut groups = Vec::new();
    for start in starts {
        let deviation = std::mem::take(&mut candidates[start]);
        if deviation == 0.0 {
            continue;
        }
        let mut group = Vec::new();
        let mut next = vec![(start, deviation)];
        while let Some((at, deviation)) = next.pop() {
            group.push(at);
            for touching in within(candidates.dim(), at, 1) {
                if (0.5..=2.0).contains(&(candidates[touching] / deviation)) {
                    next.push((touching, std::mem::take(&mut candidates[touching])));
                }
            }
        }
        group.sort_unstable();
        groups.push(group);
    }
    groups
}

/// Extent of a group in samples along x or y, whichever is larger.
fn extent(group: &[(usize, usize)]) -> usize {
    let along = |place: fn(&(usize, usize)) -> usize| {
        let places = group.iter().map(place);
        places.clone().max().zip(places.min()).map_or(0, |(last, first)| last - first + 1)
    };
    along(|at| at.0).max(along(|at| at.1))
}

/// Height of each sample above the median of its neighbourhood, which shrinks symmetrically towards a
/// boundary.
fn deviations(z: &Field, stride: usize, stop: Stop<'_>) -> Result<Field> {
    let mut deviations = z.clone();
    let rows = deviations.as_slice_mut().expect("fields are in standard layout").chunks_mut(z.ncols());
    let symmetric = |i: usize, n: usize| {
        let reach = stride * REACH.min(i.min(n - 1 - i) / stride);
        (i - reach..i + reach + 1).step_by(stride)
    };
    let done: Result<()> = parallel::tasks(rows.enumerate(), |(ix, row)| {
        check_stop(stop)?;
        let mut around = Vec::with_capacity((2 * REACH + 1).pow(2));
        for (iy, deviation) in row.iter_mut().enumerate().filter(|(_, z)| !z.is_nan()) {
            defined(z, symmetric(ix, z.nrows()), symmetric(iy, z.ncols()), &mut around);
            *deviation -= median(&mut around);
        }
        Ok(())
    })
    .into_iter()
    .collect();
    done.map(|()| deviations)
}

/// Returns the median, and the median of the absolute deviations from it, which overwrite the values.
fn median_deviation(values: &mut [f64]) -> (f64, f64) {
    let middle = median(values);
    values.iter_mut().for_each(|value| *value = (*value - middle).abs());
    (middle, median(values))
}

/// Returns the existing samples up to `reach` on each side of one.
fn within(
    (nx, ny): (usize, usize),
    (x, y): (usize, usize),
    reach: usize,
) -> impl Iterator<Item = (usize, usize)> {
    let xs = x.saturating_sub(reach)..(x + reach + 1).min(nx);
    let ys = y.saturating_sub(reach)..(y + reach + 1).min(ny);
    xs.flat_map(move |x| ys.clone().map(move |y| (x, y)))
}

/// Returns the defined heights at these places.
fn defined(
    z: &Field,
    xs: impl Iterator<Item = usize>,
    ys: impl Iterator<Item = usize> + Clone,
    heights: &mut Vec<f64>,
) {
    heights.clear();
    for ix in xs {
        heights.extend(ys.clone().map(|iy| z[[ix, iy]]).filter(|z| !z.is_nan()));
    }
}

#[cfg(test)]
mod tests {
    use rand::{RngExt, SeedableRng};
    use rand_chacha::ChaCha8Rng;
    use rand_distr::{Distribution, StandardNormal};

    use super::*;
    use crate::{
        Amplitude, Autocorrelation, Band, Decay, Generator, HeightDistribution, LowPass, SelfAffine,
    };
    use asperity_base::grid::Grid;

    fn with_heights(height: impl Fn(usize, usize) -> f64) -> Topography {
        let grid = Grid::new([60, 50], [1.0, 1.0]).unwrap();
        Topography::new(grid, Field::from_shape_fn(grid.shape, |(i, j)| height(i, j))).unwrap()
    }

    /// A tilted plane with waves of amplitude 1.
    fn rough(i: usize, j: usize) -> f64 {
        0.4 * i as f64 - 0.1 * j as f64 + (0.9 * i as f64).sin() * (1.1 * j as f64).cos()
    }

    fn undefined(topography: &Topography) -> Vec<(usize, usize)> {
        topography.heights().indexed_iter().filter(|(_, z)| z.is_nan()).map(|(at, _)| at).collect()
    }

    #[test]
    fn spikes_become_undefined_and_nothing_else_does() {
        let spikes = [(0, 17), (12, 49), (30, 20), (30, 21), (31, 20), (45, 8)];
        let height = |i, j| rough(i, j) + if spikes.contains(&(i, j)) { 15.0 } else { 0.0 };
        let cleared = with_heights(height).despike(6.0).unwrap();
        assert_eq!(undefined(&cleared), spikes);
        let pits = with_heights(|i, j| -height(i, j)).despike(6.0).unwrap();
        assert_eq!(undefined(&pits), spikes);
        assert_eq!(with_heights(rough).despike(6.0).unwrap().undefined(), 0);
    }

    #[test]
    fn a_spike_on_a_flat_is_found_although_the_median_deviation_is_nought() {
        let flat = with_heights(|i, j| if (i, j) == (7, 9) { 1e-9 } else { 0.0 });
        assert_eq!(undefined(&flat.despike(10.0).unwrap()), [(7, 9)]);
        // Steps of the last digit are not spikes.
        let quantised = with_heights(|i, j| if (7 * i + 3 * j * j) % 10 == 0 { 1.0 } else { 0.0 });
        assert_eq!(quantised.despike(10.0).unwrap().undefined(), 0);
    }

    #[test]
    fn a_plane_has_no_spikes_and_holes_stay() {
        let mut plane = with_heights(|i, j| 2.0 * i as f64 - 3.0 * j as f64);
        assert_eq!(plane.clone().despike(1e-6).unwrap().undefined(), 0);
        plane.heights_mut().column_mut(4).fill(f64::NAN);
        plane.heights_mut()[[30, 30]] = 1e3;
        assert_eq!(plane.despike(10.0).unwrap().undefined(), 61);
        assert!(with_heights(rough).despike(0.0).is_err());
    }

    #[test]
    fn a_rough_part_of_a_smooth_surface_is_no_spike() {
        let wave = |i: usize, j: usize| (1.7 * i as f64).sin() + (2.3 * j as f64).cos();
        let streak = |i: usize| 1.0 + 99.0 * (-((i as f64 - 25.0) / 8.0).powi(2)).exp();
        let streaked = with_heights(|i, j| streak(i) * wave(i, j));
        let mut with_spike = streaked.clone();
        with_spike.heights_mut()[[25, 25]] += 4e4;
        assert_eq!(undefined(&with_spike.despike(8.0).unwrap()), [(25, 25)]);
        assert_eq!(streaked.despike(8.0).unwrap().undefined(), 0);
    }

    /// Normal deviates with standard deviation 1.
    fn noise() -> impl FnMut(usize, usize) -> f64 {
        let mut random = ChaCha8Rng::seed_from_u64(1);
        move |_, _| StandardNormal.sample(&mut random)
    }

    type Height = fn(usize, usize) -> f64;

    /// Surfaces without spikes on noise of standard deviation 1, with their names.
    fn surfaces() -> [(&'static str, Height); 5] {
        let grooves = |i: usize, _: usize| match i {
            20 | 40..42 | 60..63 | 80..84 => -40.0,
            _ => 0.0,
        };
        let plateaus = |i: usize, j: usize| {
            let disc = i.abs_diff(64).pow(2) + j.abs_diff(64).pow(2) < 400;
            let diamond = i.abs_diff(30) + j.abs_diff(30) < 15;
            50.0 * f64::from(u8::from(disc)) + 25.0 * f64::from(u8::from(diamond))
        };
        [
            ("rough", |_, _| 0.0),
            ("wavy", |i, j| 20.0 * ((i as f64 / 8.0).sin() + (j as f64 / 11.0).cos())),
            ("ground", |i, _| 5.0 * ((i as f64 * 1.3).sin() + (i as f64 * 0.7).cos())),
            ("grooved", grooves),
            ("stepped", plateaus),
        ]
    }

    fn on_a_map(mut height: impl FnMut(usize, usize) -> f64) -> Topography {
        let grid = Grid::new([128, 128], [1.0, 1.0]).unwrap();
        Topography::new(grid, Field::from_shape_fn(grid.shape, |(i, j)| height(i, j))).unwrap()
    }

    #[test]
    fn spikes_and_pits_of_up_to_five_by_five_samples_are_found_and_nothing_else_is() {
        for (name, surface) in surfaces() {
            let mut random = noise();
            let clean = on_a_map(|i, j| surface(i, j) + random(i, j));
            assert_eq!(undefined(&clean.clone().despike(8.0).unwrap()), [], "{name}");
            for size in 1..=5 {
                let spikes: Vec<_> = (0..36).map(|n| (12 + 18 * (n % 6), 12 + 18 * (n / 6))).collect();
                let mut with_spikes = clean.clone();
                for (n, (i, j)) in spikes.iter().enumerate() {
                    let height = if n % 2 == 0 { 300.0 } else { -300.0 };
                    for (k, l) in (0..size).flat_map(|k| (0..size).map(move |l| (k, l))) {
                        with_spikes.heights_mut()[[i + k, j + l]] += height;
                    }
                }
                let found = undefined(&with_spikes.despike(8.0).unwrap());
                let is_spike = |at: &&(usize, usize)| {
                    spikes
                        .iter()
                        .any(|(i, j)| (*i..i + size).contains(&at.0) && (*j..j + size).contains(&at.1))
                };
                let right = found.iter().filter(is_spike).count();
                assert_eq!(found.len(), right, "{name}, {size} × {size}");
                // Beside a groove or a step, a spike of more than three samples is no longer in a minority.
                let is_beside = size > 3 && ["grooved", "stepped"].contains(&name);
                let least = if is_beside { 0.8 } else { 1.0 } * (36 * size * size) as f64;
                assert!(right as f64 >= least, "{name}, {size} × {size}: {right} found");
            }
        }
    }

    /// Places of spikes of 1 × 1 to 5 × 5 samples, separated from each other and from the boundary.
    fn places(random: &mut ChaCha8Rng) -> Vec<[std::ops::Range<usize>; 2]> {
        let mut places: Vec<[std::ops::Range<usize>; 2]> = Vec::new();
        for _ in 0..60 {
            let [x, y] = [(); 2].map(|()| {
                let start: usize = random.random_range(5..118);
                start..start + random.random_range(1..=5)
            });
            if places.iter().all(|[a, b]| x.start.abs_diff(a.start).max(y.start.abs_diff(b.start)) > 14) {
                places.push([x, y]);
            }
        }
        places
    }

    #[test]
    fn spikes_of_any_size_at_any_place_are_found() {
        for (name, surface) in surfaces() {
            let [mut n_spikes, mut n_found, mut n_others] = [0; 3];
            for seed in 0..40 {
                let mut random = ChaCha8Rng::seed_from_u64(seed);
                let places = places(&mut random);
                let mut map = on_a_map(|i, j| {
                    let noise: f64 = StandardNormal.sample(&mut random);
                    surface(i, j) + noise
                });
                for at in 0..150 {
                    map.heights_mut()[[random.random_range(0..128), at % 128]] = f64::NAN;
                }
                let clean = map.clone();
                for [xs, ys] in &places {
                    let height = 100.0 * 30f64.powf(random.random()) * [-1.0, 1.0][random.random_range(0..2)];
                    for at in xs.clone().flat_map(|x| ys.clone().map(move |y| [x, y])) {
                        map.heights_mut()[at] += height * random.random_range(0.6..1.0);
                    }
                }
                let cleared = map.despike(8.0).unwrap();
                for ((at, z), before) in cleared.heights().indexed_iter().zip(clean.heights()) {
                    let is_spike = places.iter().any(|[x, y]| x.contains(&at.0) && y.contains(&at.1));
                    let is_found = z.is_nan() && !before.is_nan();
                    n_spikes += usize::from(is_spike && !before.is_nan());
                    n_found += usize::from(is_spike && is_found);
                    n_others += usize::from(!is_spike && is_found);
                }
            }
            // Pieces of a groove between a spike and a missing sample look like spikes.
            assert!(n_found as f64 > 0.96 * n_spikes as f64, "{name}: {n_found} of {n_spikes}");
            assert!((n_others as f64) < 0.02 * n_spikes as f64, "{name}: {n_others} beside {n_spikes}");
        }
    }

    #[test]
    fn random_roughness_without_spikes_loses_nothing() {
        let grid = Grid::new([256, 256], [1.0, 1.0]).unwrap();
        let self_affine =
            |hurst| SelfAffine { hurst, rolloff: None, shortest: None, amplitude: Amplitude::Sq(1.0) };
        let autocorrelation = |decay, lengths| Autocorrelation {
            sq: 1.0,
            correlation_length: lengths,
            decay,
            lay: 0.3,
            heights: HeightDistribution::GAUSSIAN,
        };
        let low_pass = |heights| LowPass { sq: 1.0, cutoff: [8.0, 8.0], band: Band::Elliptic, heights };
        let generators = [
            Generator::SelfAffine(self_affine(0.5)),
            Generator::SelfAffine(self_affine(0.8)),
            Generator::Autocorrelation(autocorrelation(Decay::Exponential, [10.0, 10.0])),
            Generator::Autocorrelation(autocorrelation(Decay::Gaussian, [40.0, 8.0])),
            Generator::LowPass(low_pass(HeightDistribution::GAUSSIAN)),
            Generator::LowPass(low_pass(HeightDistribution { ssk: -1.0, sku: 5.0 })),
        ];
        for (index, generator) in generators.iter().enumerate() {
            for seed in 0..3 {
                let surface = generator.generate(&grid, seed).unwrap();
                for (factor, most) in [(8.0, 0), (5.0, 20)] {
                    let lost = surface.clone().despike(factor).unwrap().undefined();
                    assert!(lost <= most, "{index}, seed {seed}, {factor}: {lost} lost");
                }
            }
        }
    }

    #[test]
    fn a_pit_beside_missing_samples_is_found() {
        // A pit with a hole at each end, as instruments leave it where no light returns.
        let (deep, gone) = (
            [(7, 2), (7, 3), (7, 4), (8, 2), (8, 3), (8, 4), (9, 3)],
            [(6, 3), (6, 4), (9, 1), (9, 2), (10, 2)],
        );
        let mut pitted = with_heights(rough);
        deep.iter().for_each(|(i, j)| pitted.heights_mut()[[20 + i, 20 + j]] -= 1200.0);
        gone.iter().for_each(|(i, j)| pitted.heights_mut()[[20 + i, 20 + j]] = f64::NAN);
        let mut expected: Vec<_> = deep.iter().chain(&gone).map(|(i, j)| (20 + i, 20 + j)).collect();
        expected.sort_unstable();
        assert_eq!(undefined(&pitted.despike(8.0).unwrap()), expected);
    }
}
