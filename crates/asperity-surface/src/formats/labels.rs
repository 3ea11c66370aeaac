//! Labels above and beside a matrix of text: positions, or numbers of samples.

use ndarray::{ArrayView1, s};

use super::preamble::Preamble;
use super::words::excerpt;
use asperity_base::error::Defect;
use asperity_base::grid::Field;

/// Lines of numbers, indexed `[line, column]`, without the labels.
pub(super) struct Unlabelled {
    pub(super) matrix: Field,
    /// Distance of the labels along a line and from line to line, in their unit; none if they count the
    /// samples.
    pub(super) pitch: Option<[f64; 2]>,
    pub(super) had_labels: bool,
}

impl Unlabelled {
    /// Removes the labels of `lines`: words beside it, and evenly spaced numbers above and beside a matrix.
    pub(super) fn from_lines(lines: Field, preamble: &Preamble<'_>) -> Result<Self, Defect> {
        let (rows, columns) = lines.dim();
        if preamble.has_labels {
            return Ok(Self { matrix: below_words(lines), pitch: None, had_labels: true });
        }
        if let Some(above) = &preamble.above {
            let labels = Steps::of(ArrayView1::from(&above[..])).zip(Steps::of(lines.column(0)));
            // Two numbers are always evenly spaced.
            let labels = labels.filter(|(x, y)| x.len.max(y.len) > 2);
            let (x, y) = labels.ok_or_else(|| preamble.unclear())?;
            return Ok(Self::between(&lines.slice(s![.., 1..]).to_owned(), x, y));
        }
        if rows > 2 && columns > 2 {
            let (above, beside) = (lines.slice(s![0, 1..]), lines.slice(s![1.., 0]));
            let inner = [lines.slice(s![1, 1..]), lines.slice(s![1.., 1])];
            if let (Some(x), Some(y)) = (Steps::of(above), Steps::of(beside)) {
                let enough = if lines[[0, 0]].is_nan() {
                    above.len().max(beside.len()) > 2
                } else {
                    x.len.min(y.len) > 3
                };
                if enough && inner.iter().all(|line| line.len() < 3 || Steps::of(*line).is_none()) {
                    return Ok(Self::between(&lines.slice(s![1.., 1..]).to_owned(), x, y));
                }
            }
        }
        Ok(Self { matrix: lines, pitch: None, had_labels: false })
    }

    /// The matrix between labels along its lines, `x`, and from line to line, `y`, in rising order.
    fn between(matrix: &Field, x: Steps, y: Steps) -> Self {
        let rising = |step: f64| if step > 0.0 { 1 } else { -1 };
        let matrix = matrix.slice(s![..;rising(y.step), ..;rising(x.step)]).as_standard_layout().into_owned();
        let pitch = if x.counts && y.counts { None } else { Some([x.step.abs(), y.step.abs()]) };
        Self { matrix, pitch, had_labels: true }
    }
}

/// Returns an error if only the first line or only the first column of a matrix is evenly spaced.
pub(super) fn refuse_lone_labels(matrix: &Field, preamble: &Preamble<'_>) -> Result<(), Defect> {
    /// Number of labels that are no coincidence.
    const MANY: usize = 8;
    let (rows, columns) = matrix.dim();
    if rows < 2 || columns < 2 {
        return Ok(());
    }
    let alone = |line, next| Steps::of(line).is_some() && Steps::of(next).is_none();
    if columns >= MANY && alone(matrix.row(0), matrix.row(1)) {
        return Err(preamble.labels_above());
    }
    if rows >= MANY && alone(matrix.column(0), matrix.column(1)) {
        let found = excerpt(&format!("{}, {} …", matrix[[0, 0]], matrix[[1, 0]]));
        return Err(Defect::Labels { columns, found });
    }
    Ok(())
}

/// Removes what is left of labels of words: numbers of lines after a word, and a first line of labels.
fn below_words(lines: Field) -> Field {
    let (rows, columns) = lines.dim();
    let column = usize::from(columns > 2 && Steps::of(lines.column(0)).is_some_and(|labels| labels.counts));
    let labels_above = rows > 2
        && columns > column + 2
        && Steps::of(lines.slice(s![0, column..])).is_some()
        && Steps::of(lines.slice(s![1, column..])).is_none();
    lines.slice(s![usize::from(labels_above).., column..]).as_standard_layout().into_owned()
}

/// Evenly spaced numbers.
#[derive(Clone, Copy)]
struct Steps {
    step: f64,
    len: usize,
    /// Whether they are 0, 1, 2 … or 1, 2, 3 …, in either order.
    counts: bool,
}

impl Steps {
    /// Returns the steps of at least two evenly spaced numbers.
    fn of(numbers: ArrayView1<'_, f64>) -> Option<Self> {
        /// Largest deviation from even spacing, by rounding of printed numbers, in steps.
        const ROUNDING: f64 = 0.02;
        let len = numbers.len();
        let [first, last] = [*numbers.first()?, *numbers.last()?];
        let step = (last - first) / (len - 1) as f64;
        if !step.is_finite() || step == 0.0 {
            return None;
        }
        let near = |(index, number): (usize, &f64)| {
            (number - first - index as f64 * step).abs() <= ROUNDING * step.abs()
        };
        let counts = step.abs() == 1.0 && [0.0, 1.0].contains(&first.min(last));
        numbers.iter().enumerate().all(near).then_some(Self { step, len, counts })
    }
}
