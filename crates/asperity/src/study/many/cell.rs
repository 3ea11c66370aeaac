//! Cells of tables of values separated by commas.

/// What a spreadsheet takes for the beginning of a formula.
const FORMULAS: [char; 6] = ['=', '+', '-', '@', '\t', '\r'];

/// A cell of a table of values separated by commas. A text that begins as a formula, which a spreadsheet would compute, has an
/// apostrophe before it; a number has none.
pub(super) fn quoted(text: &str) -> String {
    match text.starts_with(FORMULAS) && text.parse::<f64>().is_err() {
        true => in_quotes(&format!("'{text}")),
        false => in_quotes(text),
    }
}

/// The text of a cell without the apostrophe that guards it.
pub(super) fn unguarded(cell: &str) -> &str {
    cell.strip_prefix('\'').filter(|text| text.starts_with(FORMULAS)).unwrap_or(cell)
}

/// A cell with its text in quotes, where it needs them.
pub(super) fn in_quotes(text: &str) -> String {
    if text.contains([',', '"', '\n', '\r']) {
        format!("\"{}\"", text.replace('"', "\"\""))
    } else {
        text.to_owned()
    }
}
