//! Maxwellian hills, their saddle tree, and its pruning.

use rayon::slice::ParallelSliceMut;

use super::relief::Relief;
use crate::{Stop, check_stop, check_stop_at};
use asperity_base::error::Result;

/// No upward path.
const NONE: usize = usize::MAX;

/// No hill.
const NOWHERE: u32 = u32::MAX;

/// All hills, even low ones, and their connections.
pub(super) struct Watershed {
    /// Hill of each cell; hills are numbered from 0 in the order of their peaks, highest first.
    of: Vec<u32>,
    /// Cell and height of each peak.
    peaks: Vec<(usize, f64)>,
    /// The places where each peak ceases to be the highest of its surroundings.
    ends: Vec<End>,
}

/// Height down to which a peak is the highest of its surroundings.
struct End {
    height: f64,
    /// The two hills at the saddle towards a higher peak, one on each side. `None` for the highest peak of an
    /// island, whose surroundings end at the lowest sample.
    saddle: Option<[u32; 2]>,
}

/// Result of pruning.
pub(super) struct Pruned {
    /// Hill of each cell, from 1; 0 without one.
    pub(super) of: Vec<u32>,
    /// The hills, highest first.
    pub(super) hills: Vec<Hill>,
}

/// A hill that is not pruned.
pub(super) struct Hill {
    /// Cell of its peak.
    pub(super) peak: usize,
    /// Height of the peak above the saddle to a higher one, or above the lowest sample of the island.
    pub(super) prominence: f64,
    /// Height of the highest saddle around it; for the only hill of an island, that of the lowest sample.
    pub(super) saddle: f64,
}

impl Watershed {
    /// Finds the hills of `relief`, and the saddles where areas above a sinking water level merge.
    ///
    /// Linear in the number of samples, except for sorting the peaks and the samples at borders between
    /// hills.
    pub(super) fn from_relief(relief: &Relief, stop: Stop<'_>) -> Result<Self> {
        let z = &relief.z;
        let (of, peaks) = hills(relief, stop)?;
        let meets = |cell: usize, other: usize| z[other] >= z[cell] && of[other] != of[cell];
        let mut border: Vec<(f64, usize)> = Vec::new();
        for (n, cell) in relief.samples().enumerate() {
            check_stop_at(n, stop)?;
            if relief.neighbours(cell).any(|other| meets(cell, other)) {
                border.push((z[cell], cell));
            }
        }
        border.par_sort_unstable_by(|a, b| b.0.total_cmp(&a.0).then(a.1.cmp(&b.1)));

        let mut lands: Vec<usize> = (0..peaks.len()).collect();
        let mut ends: Vec<End> = peaks.iter().map(|&(_, height)| End { height, saddle: None }).collect();
        for (n, (height, cell)) in border.into_iter().enumerate() {
            check_stop_at(n, stop)?;
            while let Some(other) = relief.steepest(cell, |other| {
                meets(cell, other)
                    && find(&mut lands, of[other] as usize) != find(&mut lands, of[cell] as usize)
            }) {
                let [here, across] = [cell, other].map(|cell| find(&mut lands, of[cell] as usize));
                // The indices of peaks increase as their heights decrease.
                let (higher, lower) = (here.min(across), here.max(across));
                let (inner, outer) = if lower == here { (cell, other) } else { (other, cell) };
                ends[lower] = End { height, saddle: Some([of[inner], of[outer]]) };
                lands[lower] = higher;
            }
        }
        for (n, cell) in relief.samples().filter(|&cell| !z[cell].is_nan()).enumerate() {
            check_stop_at(n, stop)?;
            let end = &mut ends[find(&mut lands, of[cell] as usize)];
            end.height = end.height.min(z[cell]);
        }
        Ok(Self { of, peaks, ends })
    }

    /// Merges each hill lower than `threshold`, or without height, with the hill across its saddle.
    pub(super) fn prune(self, threshold: f64) -> Pruned {
        let mut hills: Vec<Hill> = Vec::new();
        let mut number = vec![0; self.peaks.len()];
        let mut into: Vec<usize> = (0..self.peaks.len()).collect();
        for (hill, (&(peak, height), end)) in self.peaks.iter().zip(&self.ends).enumerate() {
            let prominence = height - end.height;
            if prominence > 0.0 && prominence >= threshold {
                hills.push(Hill { peak, prominence, saddle: end.height });
                number[hill] = hills.len() as u32;
            } else if let Some([_, across]) = end.saddle {
                into[hill] = across as usize;
            }
        }
        for hill in 0..number.len() {
            number[hill] = number[find(&mut into, hill)];
        }
        for end in &self.ends {
            let sides = end.saddle.map(|sides| sides.map(|hill| number[hill as usize]));
            for side in sides.filter(|[a, b]| a != b).into_iter().flatten() {
                let hill = &mut hills[side as usize - 1];
                hill.saddle = hill.saddle.max(end.height);
            }
        }
        let of = self.of.iter().map(|&hill| number.get(hill as usize).copied().unwrap_or(0)).collect();
        Pruned { of, hills }
    }
}

/// Hill of each cell, and the peaks with their heights.
type Hills = (Vec<u32>, Vec<(usize, f64)>);

/// Returns the hill of each cell, and the peaks with their heights.
fn hills(relief: &Relief, stop: Stop<'_>) -> Result<Hills> {
    let z = &relief.z;
    // The upward path: the next cell of each cell. It ends at a cell that is its own successor.
    let mut next = vec![NONE; z.len()];
    for (n, cell) in relief.samples().enumerate() {
        check_stop_at(n, stop)?;
        if let Some(higher) = relief.steepest(cell, |other| z[other] > z[cell]) {
            next[cell] = higher;
        }
    }
    let level = |cell: usize, next: &[usize]| {
        relief.neighbours(cell).any(|other| z[other] == z[cell] && next[other] == NONE)
    };
    check_stop(stop)?;
    let brinks = relief.samples().filter(|&cell| next[cell] != NONE && level(cell, &next)).collect();
    spread(relief, &mut next, brinks);
    let mut peaks = Vec::new();
    for (n, cell) in relief.samples().filter(|&cell| !z[cell].is_nan()).enumerate() {
        check_stop_at(n, stop)?;
        if next[cell] == NONE {
            next[cell] = cell;
            peaks.push((cell, z[cell]));
            spread(relief, &mut next, vec![cell]);
        }
    }
    peaks.sort_unstable_by(|a, b| b.1.total_cmp(&a.1).then(a.0.cmp(&b.0)));

    let mut of = vec![NOWHERE; z.len()];
    for (hill, &(peak, _)) in peaks.iter().enumerate() {
        of[peak] = hill as u32;
    }
    for (n, cell) in relief.samples().filter(|&cell| !z[cell].is_nan()).enumerate() {
        check_stop_at(n, stop)?;
        of[cell] = of[find(&mut next, cell)];
    }
    Ok((of, peaks))
}

/// Sets the paths from the cells of `front` over their plateaus, nearest first, for cells without an upward
/// path.
fn spread(relief: &Relief, next: &mut [usize], mut front: Vec<usize>) {
    let mut first = 0;
    while let Some(&cell) = front.get(first) {
        for other in relief.neighbours(cell) {
            if relief.z[other] == relief.z[cell] && next[other] == NONE {
                next[other] = cell;
                front.push(other);
            }
        }
        first += 1;
    }
}

/// Returns the end of the path from `at`, which points to itself, and shortens the path.
fn find(to: &mut [usize], mut at: usize) -> usize {
    while to[at] != at {
        to[at] = to[to[at]];
        at = to[at];
    }
    at
}
