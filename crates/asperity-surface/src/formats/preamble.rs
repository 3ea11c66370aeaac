//! Words above the numbers of a text.
//!
//! A preamble is plain if each of its lines has a word, and the numbers below it go on to the end. Its last
//! line may name the columns of a table, or be the labels above a matrix behind a word. Known words give the
//! unit, the pitch and the size of a matrix, see [`VOCABULARY`]; a unit may stand behind the number, in the
//! next value or in brackets behind the word. Other words have no effect.

use super::csv;
use super::numbers::{Part, Separator, fields, value};
use super::words::{excerpt, unit_of_length};
use asperity_base::error::Defect;
use asperity_base::units::Metre;

/// Lines above the numbers of a text, and the place of the numbers.
pub(super) struct Preamble<'a> {
    pub(super) words: Words,
    /// Names of the columns, if these are positions and heights.
    pub(super) names: Option<Vec<&'a str>>,
    /// Labels above the columns of a matrix whose first column has labels, too.
    pub(super) above: Option<Vec<f64>>,
    /// The numbers, from their first line on.
    pub(super) numbers: Part<'a>,
    /// Whether each line of numbers begins with a word.
    pub(super) has_labels: bool,
    /// Whether there is nothing above the numbers.
    pub(super) starts_with_numbers: bool,
    /// The last line above the numbers, with its number.
    last: (usize, &'a str),
}

impl<'a> Preamble<'a> {
    /// Finds the numbers in a part of a text.
    pub(super) fn read(part: Part<'a>) -> Result<Self, Defect> {
        let (line, first) = part.lines().next().ok_or(Defect::Missing("values"))?;
        if let Kind::Numbers(_) | Kind::Nothing = Kind::of(first) {
            return Ok(Self {
                words: Words::default(),
                names: None,
                above: None,
                numbers: part,
                has_labels: false,
                starts_with_numbers: true,
                last: (line, first),
            });
        }
        let Found { start, kind, above } = Found::in_text(part).ok_or_else(|| not_a_number(line, first))?;
        let mut lines = Vec::new();
        for (number, line) in above {
            match Kind::of(line) {
                Kind::Nothing => {}
                Kind::Numbers(_) => return Err(unclear(number, line, start)),
                _ => lines.push((number, line)),
            }
        }
        let last = lines.last().copied().unwrap_or((line, first));
        let mut preamble = Self {
            words: Words::read(lines.iter().map(|(_, line)| *line))?,
            names: None,
            above: None,
            numbers: part.starting_at(start),
            has_labels: matches!(kind, Kind::Labelled(_)),
            starts_with_numbers: false,
            last,
        };
        if let (Kind::Numbers(columns), None) = (kind, Word::of(last.1)) {
            preamble.read_last(columns)?;
        }
        Ok(preamble)
    }

    /// Reads names or labels from the last line above so many columns of numbers.
    fn read_last(&mut self, columns: usize) -> Result<(), Defect> {
        let separator = Separator::from_line(self.last.1);
        let mut fields: Vec<_> = fields(self.last.1).collect();
        // A separator may end every line.
        if columns > 1 && fields.len() == columns && fields.last() == Some(&"") {
            fields.pop();
        } else if fields.len() != columns {
            return Ok(());
        }
        let is_word = |field: &&str| value(field, separator).is_none();
        if fields.iter().all(is_word) {
            if csv::are_positions(&fields) {
                self.names = Some(fields);
            } else if fields.len() <= MOST_NAMED
                && !are_numbered(&fields)
                && self.last.1.contains([';', '\t', ','])
            {
                // Words between spaces may be a title.
                return Err(self.unclear());
            }
        } else if fields.first().is_some_and(is_word) {
            self.above = fields[1..].iter().map(|field| value(field, separator)).collect();
        }
        Ok(())
    }

    /// Error for a last line above the numbers that may belong to them.
    pub(super) fn unclear(&self) -> Defect {
        unclear(self.last.0, self.last.1, self.numbers.before + 1)
    }

    /// Error for a first line of numbers that are labels.
    pub(super) fn labels_above(&self) -> Defect {
        let mut lines = self.numbers.lines();
        let (labels, first) = (lines.next(), lines.next());
        match (labels, first) {
            (Some((line, labels)), Some((first, _))) => unclear(line, labels, first),
            _ => Defect::Missing("values"),
        }
    }
}

/// Whether these are labels such as `c1`, `c2`, `c3`.
fn are_numbered(labels: &[&str]) -> bool {
    let stem = |label: &&str| label.trim_end_matches(|c: char| c.is_ascii_digit()).to_owned();
    labels.iter().all(|label| stem(label).len() < label.len() && stem(label) == stem(&labels[0]))
}

/// Largest number of columns of a table of points; a wider one is a matrix.
const MOST_NAMED: usize = 7;

/// Returns the error for a matrix that follows other numbers, if this is how the text goes on.
pub(super) fn later_matrix(part: Part<'_>) -> Option<Defect> {
    let Found { start, kind, above } = Found::in_text(part)?;
    let (line, first) = *above.iter().find(|(_, line)| matches!(Kind::of(line), Kind::Numbers(_)))?;
    // A line of a matrix that is too long or too short begins no other matrix.
    above.iter().all(|(_, line)| Kind::of(line) != kind).then(|| unclear(line, first, start))
}

fn unclear(line: usize, text: &str, first: usize) -> Defect {
    Defect::Preamble { line, token: excerpt(text.trim()), first }
}

fn not_a_number(line: usize, text: &str) -> Defect {
    let separator = Separator::from_line(text);
    let token = separator.split(text).find(|token| value(token, separator).is_none());
    Defect::NotANumber { line, token: excerpt(token.unwrap_or(text)) }
}

/// Kind of a line.
#[derive(Clone, Copy, PartialEq)]
enum Kind {
    /// Separators alone.
    Nothing,
    Words,
    /// So many values, the first of them a word and the others numbers.
    Labelled(usize),
    /// So many numbers or missing values.
    Numbers(usize),
}

impl Kind {
    fn of(line: &str) -> Self {
        let separator = Separator::from_line(line);
        let fields: Vec<_> = separator.split(line).collect();
        let values = |fields: &[&str]| fields.iter().all(|field| value(field, separator).is_some());
        if fields.iter().all(|field| field.is_empty()) {
            return Self::Nothing;
        }
        if values(&fields) {
            return Self::Numbers(fields.len());
        }
        let is_label =
            |field: &str| field.starts_with(char::is_alphabetic) && value(field, separator).is_none();
        let is_number = |field: &&str| value(field, separator).is_some_and(f64::is_finite);
        match &fields[..] {
            [label, rest @ ..]
                if is_label(label) && rest.len() > 1 && values(rest) && rest.iter().any(is_number) =>
            {
                Self::Labelled(fields.len())
            }
            _ => Self::Words,
        }
    }
}

/// Lines of numbers of the same kind, which go on to the end of a text.
struct Found<'a> {
    /// Their first line, from 1.
    start: usize,
    kind: Kind,
    /// The lines above, with their numbers.
    above: Vec<(usize, &'a str)>,
}

impl<'a> Found<'a> {
    /// Finds the last such lines, or the first if others follow.
    fn in_text(part: Part<'a>) -> Option<Self> {
        /// Number of lines that are the numbers, whatever follows.
        const ENOUGH: usize = 16;
        // Start and number of lines, number of lines above.
        struct Run {
            start: usize,
            kind: Kind,
            lines: usize,
            above: usize,
        }
        let (mut run, mut first): (Option<Run>, Option<Run>) = (None, None);
        let mut above = Vec::new();
        for (number, line) in part.lines() {
            let kind = Kind::of(line);
            match (&mut run, kind) {
                // A line of separators alone is a line of missing heights.
                (Some(run), _) if run.kind == kind || kind == Kind::Nothing => run.lines += 1,
                _ => {
                    let ended = run.take().filter(|run| run.lines > 1);
                    first = first.or(ended);
                    if let Kind::Labelled(_) | Kind::Numbers(_) = kind {
                        run = Some(Run { start: number, kind, lines: 1, above: above.len() });
                    }
                }
            }
            if run.as_ref().is_some_and(|run| run.lines >= ENOUGH) {
                break;
            }
            above.push((number, line));
        }
        let alone = |run: &Run| matches!(run.kind, Kind::Numbers(2..)) && first.is_none();
        let run = run.filter(|run| run.lines > 1 || alone(run)).or(first)?;
        above.truncate(run.above);
        let mut found = Self { start: run.start, kind: run.kind, above };
        found.include_missing_lines();
        Some(found)
    }

    /// Adds lines of separators directly above, unless these fill up lines of words, too, as in a
    /// spreadsheet.
    fn include_missing_lines(&mut self) {
        let Kind::Numbers(columns) = self.kind else { return };
        let is_filled = |line: &str| fields(line).count() == columns;
        if self.above.iter().any(|(_, line)| Kind::of(line) != Kind::Nothing && is_filled(line)) {
            return;
        }
        while let Some((number, line)) = self.above.last()
            && Kind::of(line) == Kind::Nothing
            && is_filled(line)
        {
            self.start = *number;
            self.above.pop();
        }
    }
}

/// Meaning of a known word.
#[derive(Clone, Copy, PartialEq)]
enum Word {
    /// Unit of all numbers without another unit.
    Unit,
    HeightUnit,
    LateralUnit,
    /// Pitch along both axes, or along one.
    Pitch,
    PitchAlong(usize),
    SizeAlong(usize),
    /// Heights, whose unit may stand in brackets.
    Heights,
}

/// Known words, in lower case with single spaces.
const VOCABULARY: [(Word, &[&str]); 9] = [
    (Word::Unit, &["unit", "units"]),
    (
        Word::HeightUnit,
        &["z unit", "z units", "unit z", "height unit", "height units", "value unit", "value units"],
    ),
    (
        Word::LateralUnit,
        &["xy unit", "xy units", "unit xy", "x unit", "y unit", "lateral unit", "lateral units"],
    ),
    (
        Word::Pitch,
        &["xy calibration", "pitch", "xy pitch", "pixel size", "cell size", "spacing", "xy spacing"],
    ),
    (
        Word::PitchAlong(0),
        &["x calibration", "x pitch", "pitch x", "dx", "x spacing", "x pixel size", "pixel size x", "x step"],
    ),
    (
        Word::PitchAlong(1),
        &["y calibration", "y pitch", "pitch y", "dy", "y spacing", "y pixel size", "pixel size y", "y step"],
    ),
    (Word::SizeAlong(0), &["x pixels", "pixels x", "columns", "horizontal", "nx"]),
    (Word::SizeAlong(1), &["y pixels", "pixels y", "rows", "vertical", "ny"]),
    (Word::Heights, &["z", "height", "heights", "height map", "topography"]),
];

impl Word {
    /// Returns the meaning of the word at the start of a line, if it is known.
    fn of(line: &str) -> Option<Self> {
        let name = Entry::of(line)?.name;
        VOCABULARY.iter().find(|(_, names)| names.contains(&name.as_str())).map(|(word, _)| *word)
    }
}

/// Meaning of the known words.
#[derive(Default)]
pub(super) struct Words {
    pub(super) height_unit: Option<Metre>,
    pub(super) lateral_unit: Option<Metre>,
    /// Along x and y, in the lateral unit.
    pub(super) pitch: Option<[f64; 2]>,
    /// Number of heights along x and y.
    pub(super) sizes: Option<[usize; 2]>,
}

impl Words {
    fn read<'a>(lines: impl Iterator<Item = &'a str>) -> Result<Self, Defect> {
        let (mut unit, mut height_unit, mut lateral_unit) = (None, None, None);
        let (mut pitch, mut sizes) = ([None; 2], [None; 2]);
        for line in lines {
            let (Some(word), Some(entry)) = (Word::of(line), Entry::of(line)) else { continue };
            match word {
                Word::Unit => unit = unit.or(entry.unit_alone()?),
                Word::HeightUnit => height_unit = height_unit.or(entry.unit_alone()?),
                Word::LateralUnit => lateral_unit = lateral_unit.or(entry.unit_alone()?),
                Word::Heights => height_unit = height_unit.or(entry.bracketed_unit()?),
                Word::SizeAlong(axis) => sizes[axis] = sizes[axis].or(entry.count()),
                Word::Pitch => {
                    let found = entry.length();
                    pitch = pitch.map(|pitch| pitch.or(found));
                }
                Word::PitchAlong(axis) => pitch[axis] = pitch[axis].or(entry.length()),
            }
        }
        let lateral = lateral_unit.or(unit);
        let mut found = Self { height_unit: height_unit.or(unit), lateral_unit: lateral, ..Self::default() };
        if let [Some(x), Some(y)] = pitch {
            // Both in metres, or both in the lateral unit.
            let units = [x.1.or(lateral), y.1.or(lateral)];
            match units {
                [Some(x_unit), Some(y_unit)] => {
                    found.lateral_unit = Some(1.0);
                    found.pitch = Some([x.0 * x_unit, y.0 * y_unit]);
                }
                [None, None] => found.pitch = Some([x.0, y.0]),
                _ => {}
            }
        }
        if let [Some(x), Some(y)] = sizes {
            found.sizes = Some([x, y]);
        }
        Ok(found)
    }
}

/// A line with a name and its values.
struct Entry<'a> {
    /// In lower case, without brackets, with single spaces.
    name: String,
    /// In brackets behind the name.
    bracketed: Option<&'a str>,
    values: Vec<&'a str>,
    separator: Separator,
}

impl<'a> Entry<'a> {
    fn of(line: &'a str) -> Option<Self> {
        let separator = match line {
            line if line.contains(';') => Separator::Semicolon,
            line if line.contains('\t') => Separator::Tab,
            line if line.contains([':', '=']) => Separator::Space,
            _ => Separator::Comma,
        };
        let mut values: Vec<_> = match separator {
            Separator::Space => vec![line.trim()],
            _ => separator.split(line).collect(),
        };
        let first = *values.first()?;
        let name = match first.split_once([':', '=']) {
            Some((name, value)) => {
                values[0] = value.trim();
                name
            }
            None => values.remove(0),
        };
        values.retain(|value| !value.is_empty());
        let (name, bracketed) = match name.split_once(['(', '[']) {
            Some((name, unit)) => (name, Some(unit.trim_end_matches([')', ']', ' ']))),
            None => (name, None),
        };
        let words: Vec<_> =
            name.split(|c: char| !c.is_alphanumeric()).filter(|word| !word.is_empty()).collect();
        Some(Self { name: words.join(" ").to_lowercase(), bracketed, values, separator })
    }

    fn unit_alone(&self) -> Result<Option<Metre>, Defect> {
        let unit = self.values.first().map(|unit| unit.trim_matches(['(', ')', '[', ']']));
        unit.map(unit_of_length).transpose()
    }

    fn bracketed_unit(&self) -> Result<Option<Metre>, Defect> {
        self.bracketed.filter(|_| self.values.is_empty()).map(unit_of_length).transpose()
    }

    fn count(&self) -> Option<usize> {
        self.values.first()?.parse().ok()
    }

    /// Returns a positive number and its unit, which may be missing; none if it is not in one of these forms.
    fn length(&self) -> Option<(f64, Option<Metre>)> {
        let [first, rest @ ..] = &self.values[..] else { return None };
        let is_unit = |c: char| c.is_whitespace() || c.is_alphabetic() && !matches!(c, 'e' | 'E');
        let (number, unit) = first.split_at(first.find(is_unit).unwrap_or(first.len()));
        let number = value(number, self.separator).filter(|number| *number > 0.0)?;
        let unit = match (unit.trim(), rest) {
            ("", []) => self.bracketed,
            ("", [unit]) => Some(*unit),
            (unit, []) => Some(unit),
            _ => return None,
        };
        match unit.map(|unit| unit_of_length(unit.trim_matches(['(', ')', '[', ']']))) {
            None => Some((number, None)),
            Some(unit) => Some((number, Some(unit.ok()?))),
        }
    }
}
