//! Profile elements: hills and dales between crossings of the mean line.

/// Minimum size of a hill or a dale.
pub(super) struct Discrimination {
    /// Height of a hill above the mean line.
    pub(super) hill: f64,
    /// Depth of a dale below it, positive.
    pub(super) dale: f64,
    /// Width, in samples.
    pub(super) width: f64,
}

/// A hill followed by a dale, or a dale followed by a hill.
pub(super) struct Element {
    /// Width of both, in samples.
    pub(super) spacing: f64,
    /// Height of the hill plus depth of the dale.
    pub(super) height: f64,
}

/// Finds the elements of `heights`, which are relative to the mean line.
///
/// Crossing-the-line segmentation: the profile is cut where its polygon crosses the mean line. A hill or dale
/// below the minimum size is merged with its predecessor. Both orders of hill and dale count, and the profile
/// is processed in both directions, so that the elements overlap and no direction is preferred. A part cut
/// off by an end or by an undefined sample is no element. ISO 21920-2:2021; Scott, Meas. Sci. Technol. 17,
/// 559 (2006).
pub(super) fn elements(heights: &[f64], discrimination: &Discrimination) -> Vec<Element> {
    let reversed: Vec<f64> = heights.iter().rev().copied().collect();
    [heights, &reversed]
        .into_iter()
        .flat_map(|heights| heights.split(|z| z.is_nan()))
        .flat_map(|run| {
            let parts = significant(&parts(run), discrimination);
            let complete = parts.get(1..parts.len().saturating_sub(1)).unwrap_or_default();
            complete.windows(2).map(|pair| Element::of(&pair[0], &pair[1])).collect::<Vec<_>>()
        })
        .collect()
}

impl Element {
    fn of(first: &Part, second: &Part) -> Self {
        Self { spacing: second.end - first.start, height: (first.extreme - second.extreme).abs() }
    }
}

/// A hill or a dale, in samples from the start of its run.
#[derive(Clone)]
struct Part {
    start: f64,
    end: f64,
    /// Highest or lowest height of the element.
    extreme: f64,
}

impl Part {
    fn alike(&self, other: &Self) -> bool {
        (self.extreme > 0.0) == (other.extreme > 0.0)
    }

    fn passes(&self, discrimination: &Discrimination) -> bool {
        let &Discrimination { hill, dale, width } = discrimination;
        let high = if self.extreme > 0.0 { self.extreme >= hill } else { -self.extreme >= dale };
        high && self.end - self.start >= width
    }
}

/// Cuts the run at each crossing of the mean line.
fn parts(run: &[f64]) -> Vec<Part> {
    let mut parts: Vec<Part> = Vec::new();
    for (i, &z) in run.iter().enumerate() {
        match parts.last_mut() {
            Some(last) if last.extreme * z >= 0.0 => {
                last.end = i as f64;
                last.extreme = if z.abs() > last.extreme.abs() { z } else { last.extreme };
            }
            before => {
                let start = before.map_or(0.0, |last| {
                    let crossing = (i - 1) as f64 + run[i - 1] / (run[i - 1] - z);
                    last.end = crossing;
                    crossing
                });
                parts.push(Part { start, end: i as f64, extreme: z });
            }
        }
    }
    parts
}

/// Returns alternating hills and dales, each above the minimum size.
fn significant(parts: &[Part], discrimination: &Discrimination) -> Vec<Part> {
    let mut kept: Vec<Part> = Vec::new();
    for part in parts {
        let passes = part.passes(discrimination);
        match kept.last_mut() {
            Some(last) if !passes || last.alike(part) => {
                last.end = part.end;
                if last.alike(part) && part.extreme.abs() > last.extreme.abs() {
                    last.extreme = part.extreme;
                }
            }
            _ if passes => kept.push(part.clone()),
            _ => {}
        }
    }
    kept
}

#[cfg(test)]
mod tests {
    use std::f64::consts::TAU;

    use super::*;

    const ANY: Discrimination = Discrimination { hill: 0.0, dale: 0.0, width: 0.0 };

    fn spacings(heights: &[f64], discrimination: &Discrimination) -> Vec<f64> {
        elements(heights, discrimination).iter().map(|element| element.spacing).collect()
    }

    #[test]
    fn elements_of_a_wave_are_as_wide_as_the_wave() {
        let heights: Vec<f64> = (0..400).map(|i| (TAU * (i as f64 + 0.3) / 37.0).sin()).collect();
        let found = elements(&heights, &ANY);
        // 21 crossings bound 20 whole hills and dales, in 19 pairs, in both directions. A chord of the sine
        // deviates from the curve by h²/8 · |sin| ≤ h³/16 near its node, and so does the crossing, h = 2π/37.
        assert_eq!(found.len(), 2 * 19);
        for element in &found {
            assert!(
                (element.spacing - 37.0).abs() < 2.0 * (TAU / 37.0).powi(2) / 16.0,
                "{}",
                element.spacing
            );
            assert!((2.0 - element.height).abs() < (TAU / 37.0).powi(2) / 4.0);
        }
    }

    #[test]
    fn ripples_on_the_mean_line_do_not_count() {
        // A square wave of period 40 with a ripple on each of its flanks.
        let mut heights: Vec<f64> = (0..400).map(|i| if i / 20 % 2 == 0 { 1.0 } else { -1.0 }).collect();
        for flank in (20..400).step_by(20) {
            heights[flank - 1] *= -0.05;
            heights[flank] *= -0.05;
        }
        assert!(spacings(&heights, &ANY).iter().all(|&spacing| spacing < 39.0));
        let rough = Discrimination { hill: 0.1, dale: 0.1, width: 0.0 };
        let found = spacings(&heights, &rough);
        assert!(!found.is_empty() && found.iter().all(|&spacing| (spacing - 40.0).abs() < 1e-12));
    }

    #[test]
    fn a_spike_too_narrow_does_not_count() {
        let mut heights: Vec<f64> = (0..300).map(|i| (TAU * (i as f64 + 0.5) / 50.0).sin()).collect();
        heights[112] = -0.9;
        let crossed = spacings(&heights, &ANY).len();
        let found = spacings(&heights, &Discrimination { width: 3.0, ..ANY });
        assert_eq!(crossed - found.len(), 2 * 2);
        assert!(found.iter().all(|&spacing| (spacing - 50.0).abs() < 1e-9));
    }

    #[test]
    fn both_directions_give_the_same_elements_and_holes_end_them() {
        let mut heights: Vec<f64> =
            (0..300).map(|i| (0.3 * i as f64).sin() + 0.4 * (1.7 * i as f64).sin()).collect();
        heights[150] = f64::NAN;
        let rough = Discrimination { hill: 0.3, dale: 0.3, width: 2.0 };
        let sorted = |heights: &[f64]| {
            let mut found = spacings(heights, &rough);
            found.sort_by(f64::total_cmp);
            found
        };
        let forward = sorted(&heights);
        heights.reverse();
        assert_eq!(forward, sorted(&heights));
        assert!(!forward.is_empty() && forward.iter().all(|&spacing| spacing < 150.0));
        assert!(spacings(&[f64::NAN; 5], &rough).is_empty() && spacings(&[0.0; 5], &rough).is_empty());
    }
}
