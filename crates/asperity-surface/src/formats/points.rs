//! Tables of points: detection of a regular grid, of a profile and of other tables.

use ndarray::ArrayView1;

use super::MAX_CELLS;
use asperity_base::error::Defect;
use asperity_base::grid::Field;
use asperity_base::units::Metre;

/// Heights on a regular grid, NaN without a point.
pub(super) struct Raster {
    pub(super) pitch: [Metre; 2],
    pub(super) heights: Field,
}

/// Returns the heights in `column` over the positions in the first two, if these form a regular grid of at
/// least 2 × 2 points, in any order. Each position may deviate by a quarter of the pitch. Up to half of the
/// points may be missing, or all but four on each line, if the grid cannot be a coincidence.
pub(super) fn raster(table: &Field, column: usize) -> Option<Raster> {
    let points = table.nrows();
    if points < 4 {
        return None;
    }
    let [x, y] = [even(table.column(0))?, even(table.column(1))?];
    if x.count < 2 || y.count < 2 {
        return None;
    }
    let cells = x.count.checked_mul(y.count).filter(|cells| *cells <= MAX_CELLS)?;
    let complete = points == cells;
    let enough = points >= MIN_POINTS && (2 * points >= cells || points >= 4 * x.count.max(y.count));
    if points > cells || !(complete || enough) {
        return None;
    }
    let mut heights = Field::from_elem([x.count, y.count], f64::NAN);
    let mut seen = ndarray::Array2::from_elem([x.count, y.count], false);
    for point in table.rows() {
        let at = [x.index(point[0]), y.index(point[1])];
        if std::mem::replace(&mut seen[at], true) {
            return None;
        }
        heights[at] = point[column];
    }
    Some(Raster { pitch: [x.pitch, y.pitch], heights })
}

/// Number of points from which a grid with gaps is no coincidence.
const MIN_POINTS: usize = 6;

/// Heights that a table of points describes.
pub(super) enum Points {
    /// From x, y and height.
    Map(Raster),
    /// From x and height: a map of one line with square cells.
    Profile(Raster),
}

/// Returns the heights of a `table` whose columns are coordinates and height; none for a matrix.
///
/// # Errors
/// [`Defect::Points`] for a narrow table of many lines that form neither a map nor a profile,
/// [`Defect::Value`] for other tables of coordinates.
pub(super) fn points(table: &Field) -> Result<Option<Points>, Defect> {
    let (count, columns) = table.dim();
    if !(2..=MOST_COLUMNS).contains(&columns) {
        return Ok(None);
    }
    let [first, second] = [table.column(0), table.column(1)];
    if columns == 2 {
        let is_matrix = count < FEW && alike(first, second);
        if let (false, Some(profile)) = (is_matrix, profile(table, 1)) {
            return Ok(Some(Points::Profile(profile)));
        }
    }
    if columns == 3
        && let Some(map) = raster(table, 2)
    {
        return Ok(Some(Points::Map(map)));
    }
    let refused = |found: String, expected| Err(Defect::Value { what: "the table", found, expected });
    if columns == 3 && twice(table) {
        let found = format!("{count} points, some of them at one place");
        return refused(found, "one height at each x and y");
    }
    if columns > 3 && count >= MANY && raster(table, 2).is_some() {
        let found = format!("{columns} columns, the first two of them x and y");
        return refused(found, "x, y and height, or a first line that names the columns");
    }
    let points = |what, expected| Err(Defect::Points { count, columns, what, expected, named: false });
    let is_scan = |along, across| is_line(along) && (is_constant(across) || is_line(across));
    match columns {
        3 if count >= FEW && (is_scan(first, second) || is_scan(second, first)) => {
            points("a line scan with x, y and height", "lines at several y, or x and height alone")
        }
        2 if count >= FEW => points("x and height", "evenly spaced x"),
        3 if count >= FEW => points("points x, y and height on no grid", "a regular grid"),
        4.. if count >= MANY && count > 3 * columns => {
            points("points x, y, height and more on no grid", "x, y and height on a regular grid")
        }
        _ => Ok(None),
    }
}

/// Largest number of columns of a table of points: x, y, height and colours or a normal.
const MOST_COLUMNS: usize = 7;

/// Number of lines from which a table of three columns is no matrix.
const FEW: usize = 8;

/// Returns the heights in `column` over the positions in the first one, in rising order, if these are evenly
/// spaced and all different. With many points up to half of the positions may be missing.
pub(super) fn profile(table: &Field, column: usize) -> Option<Raster> {
    let points = table.nrows();
    let x = even(table.column(0))?;
    if points < 3 || x.count < points || x.count > if points < FEW { points } else { 2 * points } {
        return None;
    }
    let mut heights = Field::from_elem([x.count, 1], f64::NAN);
    let mut seen = vec![false; x.count];
    for point in table.rows() {
        let at = x.index(point[0]);
        if std::mem::replace(&mut seen[at], true) {
            return None;
        }
        heights[[at, 0]] = point[column];
    }
    Some(Raster { pitch: [x.pitch; 2], heights })
}

/// Number of rows from which an order is no coincidence.
const MANY: usize = 16;

/// Whether these are positions of a line scan: evenly spaced, each once, at least half of them present.
fn is_line(column: ArrayView1<'_, f64>) -> bool {
    let points = column.len();
    if points < 8 || !(is_rising(column) || points >= MANY) {
        return false;
    }
    let Some(even) = even(column) else { return false };
    if even.count < points || even.count > 2 * points {
        return false;
    }
    let mut seen = vec![false; even.count];
    column.iter().all(|position| !std::mem::replace(&mut seen[even.index(*position)], true))
}

/// Whether two columns rise uniformly with similar slopes: heights of a plane rather than positions.
fn alike(one: ArrayView1<'_, f64>, other: ArrayView1<'_, f64>) -> bool {
    let climb = |column: ArrayView1<'_, f64>| column[column.len() - 1] - column[0];
    is_rising(one)
        && is_rising(other)
        && even(other).is_some()
        && (0.5..=2.0).contains(&(climb(one) / climb(other)))
}

/// Whether all steps are ≥ 0 or all ≤ 0, and some are not 0.
fn is_rising(column: ArrayView1<'_, f64>) -> bool {
    let steps = || column.iter().zip(column.iter().skip(1)).map(|(here, next)| next - here);
    !is_constant(column) && (steps().all(|step| step >= 0.0) || steps().all(|step| step <= 0.0))
}

fn is_constant(column: ArrayView1<'_, f64>) -> bool {
    column.iter().all(|value| *value == column[0])
}

/// Whether the points lie on a grid, with a few places occupied more than once.
fn twice(table: &Field) -> bool {
    let points = table.nrows();
    let (Some(x), Some(y)) = (even(table.column(0)), even(table.column(1))) else { return false };
    let cells = x.count.saturating_mul(y.count);
    if points < MANY || x.count < 2 || y.count < 2 || cells > 2 * points {
        return false;
    }
    let mut seen = vec![false; cells];
    let shared = table
        .rows()
        .into_iter()
        .filter(|point| std::mem::replace(&mut seen[x.index(point[0]) * y.count + y.index(point[1])], true));
    10 * shared.count() <= points
}

/// Positions `start + i · pitch`, `i < count`.
struct Positions {
    start: Metre,
    /// 0 for a single position.
    pitch: Metre,
    count: usize,
}

impl Positions {
    fn index(&self, position: Metre) -> usize {
        if self.count == 1 { 0 } else { ((position - self.start) / self.pitch).round() as usize }
    }
}

/// Fraction of a pitch by which a position may deviate, because of the stage of an instrument.
const OFF: f64 = 0.25;
/// The same fraction for so few points that a coincidence is possible, because of the rounding of printed
/// numbers.
const OFF_IF_FEW: f64 = 0.02;
/// Widest gap between existing positions, in pitches.
const WIDEST_GAP: usize = 16;

/// Returns the uniform spacing of `values`, some of whose positions may be missing.
fn even(values: ArrayView1<'_, f64>) -> Option<Positions> {
    let mut sorted = values.to_vec();
    if sorted.iter().any(|position| position.is_nan()) {
        return None;
    }
    sorted.sort_unstable_by(f64::total_cmp);
    let (start, end) = (sorted[0], sorted[sorted.len() - 1]);
    if start == end {
        return Some(Positions { start, pitch: 0.0, count: 1 });
    }
    let gaps = || sorted.windows(2).map(|pair| pair[1] - pair[0]);
    let widest = gaps().fold(0.0, f64::max);
    let off = if sorted.len() < MANY { OFF_IF_FEW } else { OFF };
    (1..=WIDEST_GAP).find_map(|pitches| {
        let near = widest / pitches as f64;
        let advance = |gap: f64| if gap > 0.5 * near { (gap / near).round() } else { 0.0 };
        let steps = gaps().map(advance).sum::<f64>();
        let pitch = (end - start) / steps;
        let is_near = |position: &f64| {
            let index = (position - start) / pitch;
            (index - index.round()).abs() < off
        };
        let good = steps < MAX_CELLS as f64 && pitch.is_finite() && pitch > 0.0 && sorted.iter().all(is_near);
        good.then_some(Positions { start, pitch, count: steps as usize + 1 })
    })
}
