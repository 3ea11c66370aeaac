//! Lines of a text as cells, and the numbers in them.

/// Blanks at which no line breaks.
const NARROW: [char; 2] = ['\u{a0}', '\u{202f}'];

/// A line of a text that is not blank.
pub(super) struct Line {
    /// Number of the line, from 1.
    pub(super) number: usize,
    pub(super) cells: Vec<String>,
    /// Whether blanks divide the cells.
    pub(super) is_spaced: bool,
    /// Whether it begins with `#`.
    pub(super) is_comment: bool,
}

impl Line {
    /// Returns a cell, empty behind the last one.
    pub(super) fn cell(&self, column: usize) -> &str {
        self.cells.get(column).map_or("", String::as_str)
    }

    /// Whether there is a number in the column of the frequency, or in both others.
    pub(super) fn has_numbers(&self, [frequency, one, other]: [usize; 3]) -> bool {
        let has = |column| is_number(self.cell(column));
        !self.is_comment && (has(frequency) || (has(one) && has(other)))
    }
}

/// Divides each line of a text into cells, at tabs, else at semicolons, else at commas, else at blanks. A
/// cell may be quoted.
pub(super) fn lines(text: &str) -> Vec<Line> {
    let line = |(index, line): (usize, &str)| {
        let is_comment = line.starts_with('#');
        let line = line.trim_start_matches('#');
        let separator = ['\t', ';'].into_iter().find(|separator| line.contains(*separator));
        let separator = separator.or_else(|| commas_separate(line).then_some(','));
        let cells = separator.map_or_else(|| spaced(line), |separator| separated(line, separator));
        Line { number: index + 1, cells, is_spaced: separator.is_none(), is_comment }
    };
    let text = text.replace("\r\n", "\n").replace('\r', "\n").replace(NARROW, " ");
    let lines = text.lines().enumerate().map(line);
    lines.filter(|line| line.cells.iter().any(|cell| !cell.is_empty())).collect()
}

/// Whether commas divide the cells of a line: `1, 2` and `1,2`, not `1,5 2,5`.
fn commas_separate(line: &str) -> bool {
    let is_decimal = |token: &str| token.trim_matches(',') == token && token.matches(',').count() <= 1;
    let is_number = |c: char| c.is_ascii_digit() || c.is_whitespace() || "+-eE,".contains(c);
    let has_blanks = line.split_whitespace().nth(1).is_some();
    line.contains(',')
        && !(has_blanks && line.chars().all(is_number) && line.split_whitespace().all(is_decimal))
}

/// Divides a line at a separator outside of quotes. A quote opens at the start of a cell and closes at its
/// end.
fn separated(line: &str, separator: char) -> Vec<String> {
    let mut cells = vec![String::new()];
    let mut is_quoted = false;
    let mut rest = line.chars();
    while let Some(character) = rest.next() {
        let behind = rest.as_str();
        let ends = || behind.trim_start_matches(' ').chars().next().is_none_or(|next| next == separator);
        let cell = cells.last_mut().expect("at least one cell");
        match character {
            '"' if is_quoted && behind.starts_with('"') => cell.extend(rest.next()),
            '"' if is_quoted && ends() => is_quoted = false,
            '"' if !is_quoted && cell.trim().is_empty() => is_quoted = true,
            _ if character == separator && !is_quoted => cells.push(String::new()),
            _ => cell.push(character),
        }
    }
    cells.iter().map(|cell| cell.trim().to_owned()).collect()
}

/// Divides a line at blanks: numbers at each, words at two or more if there are such. A unit in brackets
/// belongs to the word before it.
fn spaced(line: &str) -> Vec<String> {
    let words: Vec<&str> = line.split_whitespace().collect();
    if !words.iter().all(|word| is_number(word)) && line.trim().contains("  ") {
        let parts = line.split("  ").map(str::trim);
        return parts.filter(|part| !part.is_empty()).map(str::to_owned).collect();
    }
    let mut cells: Vec<String> = Vec::new();
    for word in words {
        match cells.last_mut() {
            Some(name) if word.starts_with(['(', '[']) && !name.starts_with(['(', '[']) => {
                *name = format!("{name} {word}");
            }
            _ => cells.push(word.to_owned()),
        }
    }
    cells
}

/// Whether a comma is the decimal mark of these numbers: `0,5`, `1.000,5`; not `1,000.5`.
pub(super) fn has_decimal_commas<'a>(cells: impl Iterator<Item = &'a str> + Clone) -> bool {
    let after_point =
        |cell: &str| cell.find('.').zip(cell.rfind(',')).is_some_and(|(point, comma)| point < comma);
    cells.clone().any(after_point)
        || (!cells.clone().any(|cell| cell.contains('.')) && cells.clone().any(|cell| cell.contains(',')))
}

/// Whether a cell is a number with either decimal mark.
pub(super) fn is_number(cell: &str) -> bool {
    number(cell, false).or(number(cell, true)).is_some()
}

/// Returns the finite number in a cell. The mark that is not the decimal one may divide thousands.
pub(super) fn number(cell: &str, has_decimal_comma: bool) -> Option<f64> {
    let [decimal, thousands] = if has_decimal_comma { [',', '.'] } else { ['.', ','] };
    let cell = cell.trim().replace('−', "-");
    let whole = cell.split(decimal).next().unwrap_or_default();
    let groups = whole.split(thousands).skip(1).all(|group| group.len() == 3);
    let plain = cell.replace(thousands, "").replace(decimal, ".");
    plain.parse().ok().filter(|number: &f64| groups && number.is_finite())
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn cells_are_divided_as_instruments_divide_them() {
        for (line, cells) in [
            ("1,5\t2\t", &["1,5", "2", ""][..]),
            ("0,01;3,1;", &["0,01", "3,1", ""]),
            ("0,01 3,1", &["0,01", "3,1"]),
            ("1, 2,3", &["1", "2", "3"]),
            ("\"0,01\",\"3,1\"", &["0,01", "3,1"]),
            ("\"f (Hz)\",\"E\"\" (Pa)\",\"E\" (Pa)\"", &["f (Hz)", "E\" (Pa)", "E\" (Pa)"]),
            ("f / Hz;E\" / Pa", &["f / Hz", "E\" / Pa"]),
            ("f (Hz) E' (Pa)  ", &["f (Hz)", "E' (Pa)"]),
            ("  Loss modulus   f (Hz)", &["Loss modulus", "f (Hz)"]),
            ("  [Hz] [Pa]", &["[Hz]", "[Pa]"]),
            ("##f/Hz;E'/Pa", &["f/Hz", "E'/Pa"]),
        ] {
            assert_eq!(lines(line)[0].cells, cells, "{line}");
        }
    }

    #[test]
    fn numbers_have_either_decimal_mark() {
        for (cells, expected) in [
            (&["0,5", "12"][..], [0.5, 12.0]),
            (&["1.000,5", "1,23E+05"], [1000.5, 1.23e5]),
            (&["1,000.5", "1,000"], [1000.5, 1000.0]),
            (&["0.5", "1e−3"], [0.5, 1e-3]),
        ] {
            let comma = has_decimal_commas(cells.iter().copied());
            let found: Vec<f64> = cells.iter().map(|cell| number(cell, comma).unwrap()).collect();
            assert_eq!(found, expected);
        }
        assert!(["", "soft", "1,23", "nan"].iter().all(|cell| number(cell, false).is_none()));
    }
}
