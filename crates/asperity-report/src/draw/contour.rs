//! Lines along which a field has one value.

use asperity_base::Field;

use super::scene::Point;

/// The pieces of the line at a level, by marching squares between the middles of the cells; `place` maps
/// cells as numbers, from 0 at the middle of the first one, to the sheet.
pub(super) fn line(field: &Field, level: f64, place: impl Fn([f64; 2]) -> Option<Point>) -> Vec<Vec<Point>> {
    let mut pieces = Vec::new();
    for i in 0..field.nrows().saturating_sub(1) {
        for j in 0..field.ncols().saturating_sub(1) {
            // Around the square.
            let corners = [[i, j], [i + 1, j], [i + 1, j + 1], [i, j + 1]];
            let crossings: Vec<[f64; 2]> = (0..4)
                .filter_map(|side| crossing(field, level, corners[side], corners[(side + 1) % 4]))
                .collect();
            // A saddle has two pieces.
            for pair in crossings.chunks_exact(2) {
                pieces.push(pair.iter().filter_map(|at| place(*at)).collect());
            }
        }
    }
    pieces
}

/// Where the side from one corner to another crosses the level.
fn crossing(field: &Field, level: f64, from: [usize; 2], to: [usize; 2]) -> Option<[f64; 2]> {
    let (a, b) = (field[from] - level, field[to] - level);
    ((a < 0.0) != (b < 0.0) && a.is_finite() && b.is_finite()).then(|| {
        let part = a / (a - b);
        [0, 1].map(|axis| from[axis] as f64 + part * (to[axis] as f64 - from[axis] as f64))
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_line_of_a_cone_is_a_circle() {
        let field = Field::from_shape_fn([21, 21], |(i, j)| (i as f64 - 10.0).hypot(j as f64 - 10.0));
        let pieces = line(&field, 6.3, Some);
        assert!(pieces.len() > 30, "{}", pieces.len());
        for [x, y] in pieces.into_iter().flatten() {
            assert!(((x - 10.0).hypot(y - 10.0) - 6.3).abs() < 0.05, "{x}, {y}");
        }
    }
}
