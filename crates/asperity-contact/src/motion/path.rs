//! Relative positions of a pass.

use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use crate::grid::Placement;
use crate::units::MetrePerSecond;
use asperity_base::choice::choice;

/// Strokes of a pass.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Path {
    /// All positions once.
    OneWay,
    /// All positions in a forward stroke, then in reverse order in a return stroke with sliding and friction
    /// reversed.
    Reciprocating,
}

choice!(Path: "one-way" => OneWay, "reciprocating" => Reciprocating);

/// Stroke of a pass to which a position belongs.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Stroke {
    /// The forward stroke, in the direction of the strategy.
    Forth,
    /// The return stroke.
    Back,
}

impl Stroke {
    /// 1 on the forward stroke, −1 on the return stroke.
    pub fn sign(self) -> f64 {
        match self {
            Self::Forth => 1.0,
            Self::Back => -1.0,
        }
    }
}

/// Offset of the upper body along y, pass by pass. Cells beyond the width re-enter on the other side.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum OffsetY {
    /// This many cells more in each pass than in the one before; the first pass is at 0.
    Cells(usize),
    /// A random offset for each pass, drawn from the seed and the number of the pass.
    Random {
        /// The seed.
        seed: u64,
    },
}

impl OffsetY {
    /// No offset: all passes lie where the first does.
    pub const NONE: Self = Self::Cells(0);

    /// Returns the offset of the upper body in a `pass`, from 1, in cells, below the `width` of the bodies.
    pub fn of_pass(self, pass: usize, width: usize) -> usize {
        match self {
            Self::Cells(cells) => (cells % width * ((pass - 1) % width)) % width,
            Self::Random { seed } => {
                let mut random = ChaCha8Rng::seed_from_u64(seed);
                random.set_stream(pass as u64);
                random.random_range(0..width as u64) as usize
            }
        }
    }
}

/// A relative position: which columns of the lower and of the upper body overlap.
///
/// Column `j` of the contact is column `lower + j` of the lower body and `upper + j` of the upper one, both
/// counted cyclically (in an overlap neither wraps around). If a surface lies between two of its columns,
/// column `j` is displaced from that column to the next by the `fraction` of the body.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Position {
    /// Columns by which the upper body has moved to the right of the lower one.
    pub offset: f64,
    /// First column of the lower body in the overlap.
    pub lower: usize,
    /// First column of the upper body in the overlap.
    pub upper: usize,
    /// Fraction of a column, 0 ≤ fraction < 1, by which the contact is displaced from the columns of the
    /// lower and of the upper body.
    pub fraction: [f64; 2],
    /// Number of columns of the overlap.
    pub columns: usize,
    /// Cells along y by which the upper body is displaced, counted cyclically.
    pub across: usize,
    /// The stroke of the position.
    pub stroke: Stroke,
}

impl Position {
    /// Creates the position of full overlap of two bodies with `columns` columns.
    pub fn flush(columns: usize) -> Self {
        Self {
            offset: 0.0,
            lower: 0,
            upper: 0,
            fraction: [0.0; 2],
            columns,
            across: 0,
            stroke: Stroke::Forth,
        }
    }

    /// Returns the same position on the return stroke.
    pub(super) fn back(self) -> Self {
        Self { stroke: Stroke::Back, ..self }
    }

    /// Placement of the contact on bodies of these shapes, lower one first.
    pub(crate) fn placements(&self, shapes: [[usize; 2]; 2]) -> [Placement; 2] {
        let row = (shapes[1][1] - self.across) % shapes[1][1];
        [
            Placement::new(shapes[0], [self.lower, 0], self.fraction[0]),
            Placement::new(shapes[1], [self.upper, row], self.fraction[1]),
        ]
    }

    /// Start of the contact on the lower and on the upper body, in columns.
    pub fn places(&self) -> [f64; 2] {
        [self.lower as f64 + self.fraction[0], self.upper as f64 + self.fraction[1]]
    }
}

/// Returns the positions of an overlap pass: the upper body enters from the left, passes over and leaves on
/// the right.
///
/// There are `lower + upper − 1` positions at which the bodies overlap. Every `stride`-th is returned, always
/// including the one at which the left edges are flush.
pub fn overlap_positions(lower: usize, upper: usize, stride: usize) -> Vec<Position> {
    // A stride larger than both bodies leaves one position.
    let stride = stride.min(lower + upper);
    let (lower, upper, stride) = (lower as isize, upper as isize, stride as isize);
    let first = -((upper - 1) / stride);
    let last = (lower - 1) / stride;
    (first..=last)
        .map(|k| {
            let offset = k * stride;
            let start = offset.max(0);
            let end = lower.min(upper + offset);
            Position {
                offset: offset as f64,
                lower: start as usize,
                upper: (start - offset) as usize,
                ..Position::flush((end - start) as usize)
            }
        })
        .collect()
}

/// Returns the positions of a pass by circular shift: the faster surface goes once around, `stride` columns
/// per step.
///
/// All `columns` overlap throughout. Equal speeds are rolling, a zero speed is sliding. The slower surface
/// moves by fractions of a column if the ratio of the speeds requires it.
pub fn shift_positions(
    columns: usize,
    stride: usize,
    speed_lower: MetrePerSecond,
    speed_upper: MetrePerSecond,
) -> Vec<Position> {
    shift_positions_after(0, columns, stride, [speed_lower, speed_upper])
}

/// Returns the positions of a pass by circular shift after `rounds` rounds of the faster surface.
pub(super) fn shift_positions_after(
    rounds: usize,
    columns: usize,
    stride: usize,
    [speed_lower, speed_upper]: [MetrePerSecond; 2],
) -> Vec<Position> {
    let stride = stride.min(columns);
    let fastest = speed_lower.abs().max(speed_upper.abs());
    (0..columns.div_ceil(stride))
        .map(|step| {
            let before =
                |speed: f64| whole_if_near((rounds * columns) as f64 * speed / fastest) % columns as f64;
            let moved = |speed: f64| whole_if_near(before(speed) + (step * stride) as f64 * speed / fastest);
            let (lower, upper) = (moved(speed_lower), moved(speed_upper));
            // The contact begins at −moved in the frame of the body.
            let start = |moved: f64| (-moved).floor().rem_euclid(columns as f64) as usize;
            let fraction = |moved: f64| -moved - (-moved).floor();
            Position {
                offset: upper - lower,
                lower: start(lower),
                upper: start(upper),
                fraction: [fraction(lower), fraction(upper)],
                ..Position::flush(columns)
            }
        })
        .collect()
}

/// Removes the rounding error from a nearly whole number of columns.
fn whole_if_near(moved: f64) -> f64 {
    /// Fractions of a column below this are rounding error after up to 10⁸ columns.
    const NEAR: f64 = 1e-7;
    // Adding 0 turns −0 into 0.
    if (moved - moved.round()).abs() < NEAR { moved.round() + 0.0 } else { moved }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_upper_body_enters_on_the_left_and_leaves_on_the_right() {
        let positions = overlap_positions(4, 4, 1);
        let columns: Vec<usize> = positions.iter().map(|p| p.columns).collect();
        assert_eq!(columns, [1, 2, 3, 4, 3, 2, 1]);
        assert_eq!(positions[0], Position { offset: -3.0, upper: 3, ..Position::flush(1) });
        assert_eq!(positions[6], Position { offset: 3.0, lower: 3, ..Position::flush(1) });
    }

    #[test]
    fn a_stride_keeps_the_position_at_which_all_faces_all() {
        for (lower, upper, stride) in [(10, 10, 3), (10, 4, 4), (3, 12, 5), (7, 7, 20), (7, 7, usize::MAX)] {
            let positions = overlap_positions(lower, upper, stride);
            let flush = positions.iter().find(|p| p.offset == 0.0).unwrap();
            assert_eq!(flush.columns, lower.min(upper));
            for p in &positions {
                assert!(p.columns >= 1 && p.lower + p.columns <= lower && p.upper + p.columns <= upper);
                assert_eq!(p.lower as f64 - p.upper as f64, p.offset);
                assert_eq!(p.offset.abs() % stride as f64, 0.0);
            }
        }
    }

    #[test]
    fn rolling_turns_both_surfaces_and_sliding_one() {
        let rolling = shift_positions(5, 2, 1.0, 1.0);
        assert_eq!(rolling.iter().map(|p| (p.lower, p.upper)).collect::<Vec<_>>(), [(0, 0), (3, 3), (1, 1)]);
        let sliding = shift_positions(5, 1, 0.0, 2.0);
        assert!(sliding.iter().all(|p| p.lower == 0) && sliding[1].upper == 4 && sliding.len() == 5);
        let slip = shift_positions(8, 1, 1.0, -0.5);
        assert_eq!(slip[2], Position { offset: -3.0, lower: 6, upper: 1, ..Position::flush(8) });
        let between =
            Position { offset: -4.5, lower: 5, upper: 1, fraction: [0.0, 0.5], ..Position::flush(8) };
        assert_eq!(slip[3], between);
        // One round later the slower surface continues from its last place, at half of its own round.
        let next = shift_positions_after(1, 8, 1, [1.0, -0.5]);
        assert_eq!((next[0].lower, next[0].upper, next[0].offset), (0, 4, -4.0));
        assert_eq!(shift_positions_after(2, 8, 1, [1.0, -0.5]), slip);
    }

    #[test]
    fn the_upper_body_moves_across_by_its_cells_or_anywhere() {
        let of = |offset: OffsetY| (1..=7).map(|pass| offset.of_pass(pass, 5)).collect::<Vec<_>>();
        assert_eq!(of(OffsetY::Cells(2)), [0, 2, 4, 1, 3, 0, 2]);
        assert_eq!(of(OffsetY::Cells(12)), of(OffsetY::Cells(2)));
        assert_eq!(of(OffsetY::NONE), [0; 7]);
        // Frozen: a change of these numbers changes how a resumed motion continues.
        assert_eq!(of(OffsetY::Random { seed: 0 }), [3, 1, 0, 4, 0, 0, 2]);
        let mut met = [0; 5];
        (1..=500).for_each(|pass| met[OffsetY::Random { seed: 3 }.of_pass(pass, 5)] += 1);
        assert!(met.iter().all(|count| (70..130).contains(count)), "{met:?}");
    }

    #[test]
    fn the_slower_surface_moves_by_its_share_to_the_last_bit_that_counts() {
        for (ratio, columns, stride) in [(0.1, 40, 1), (-0.3, 30, 2), (1.0 / 3.0, 27, 1), (0.75, 16, 3)] {
            for (step, p) in shift_positions(columns, stride, 2.0, 2.0 * ratio).iter().enumerate() {
                let moved = ratio * (step * stride) as f64;
                let place = p.upper as f64 + p.fraction[1];
                let turns = (place + moved) / columns as f64;
                assert!((turns - turns.round()).abs() < 1e-12, "{ratio} {step}: {p:?}");
                assert!((0.0..1.0).contains(&p.fraction[1]) && p.fraction[0] == 0.0);
                assert_eq!(
                    p.fraction[1] == 0.0,
                    (moved - moved.round()).abs() < 1e-9,
                    "{ratio} {step}: {p:?}"
                );
            }
        }
    }
}
