//! Cells of CSV tables.

/// First characters of a formula in a spreadsheet.
const FORMULAS: [char; 6] = ['=', '+', '-', '@', '\t', '\r'];

/// Writes a cell of a CSV table. A text that a spreadsheet would compute as a formula gets an apostrophe in
/// front; a number gets none.
pub(crate) fn quoted(text: &str) -> String {
    if text.starts_with(FORMULAS) && text.parse::<f64>().is_err() {
        in_quotes(&format!("'{text}"))
    } else {
        in_quotes(text)
    }
}

/// Returns the text of a cell without its protecting apostrophe.
pub(crate) fn unguarded(cell: &str) -> &str {
    cell.strip_prefix('\'').filter(|text| text.starts_with(FORMULAS)).unwrap_or(cell)
}

/// Returns a cell with its text in quotes, if it needs them.
pub(crate) fn in_quotes(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}
