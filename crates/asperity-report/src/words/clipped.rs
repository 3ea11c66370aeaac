//! Messages of bounded length.

/// Longest message that is shown in full, in characters: a few lines of a terminal.
pub const MAX_CHARACTERS: usize = 600;

/// Limits a message to one paragraph of bounded length; a longer message keeps its beginning and its end.
/// Control characters are escaped.
pub fn clipped(text: &str) -> String {
    let shown = |text: &str| -> String {
        let escaped = |c: char| -> String {
            if c.is_control() && c != '\n' { c.escape_default().collect() } else { c.into() }
        };
        let lines: Vec<_> = text.lines().map(|line| line.chars().map(escaped).collect::<String>()).collect();
        lines.join("\n")
    };
    let ends = |n: usize| {
        let begin = text.char_indices().nth(n).map_or(text.len(), |(at, _)| at);
        let end = text.char_indices().rev().nth(n - 1).map_or(0, |(at, _)| at);
        [begin, end]
    };
    let [longest, _] = ends(MAX_CHARACTERS);
    if longest == text.len() && text.lines().count() <= MAX_LINES {
        return shown(text);
    }
    let [begin, end] = ends(MAX_CHARACTERS / 3);
    let flat = |text: &str| shown(text).replace('\n', " ");
    format!("{} … {}", flat(&text[..begin]), flat(&text[end.max(begin)..]))
}

/// Largest number of lines of a message that is shown in full.
pub const MAX_LINES: usize = 8;
