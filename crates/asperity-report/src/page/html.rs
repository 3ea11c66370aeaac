//! Text that becomes HTML.

use std::fmt::Write;

/// `text` with nothing in it that is markup, in an element as well as in an attribute.
pub(super) fn escaped(text: &str) -> String {
    let mut safe = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => safe.push_str("&amp;"),
            '<' => safe.push_str("&lt;"),
            '>' => safe.push_str("&gt;"),
            '"' => safe.push_str("&quot;"),
            '\'' => safe.push_str("&#39;"),
            // Neither HTML nor JSON for a script takes them.
            c if c.is_control() && c != '\n' => safe.push('\u{fffd}'),
            c => safe.push(c),
        }
    }
    safe
}

/// JSON that may stand in a script: nothing in it ends the script or begins a comment.
pub(super) fn script_data(data: &serde_json::Value) -> String {
    // These signs occur within texts only.
    data.to_string().replace('<', "\\u003c").replace('>', "\\u003e").replace('&', "\\u0026")
}

/// `text` as HTML, in which what stands between backticks is code.
pub(super) fn with_code(text: &str) -> String {
    let parts: Vec<&str> = text.split('`').collect();
    // A backtick without its other one stays.
    if parts.len().is_multiple_of(2) {
        return escaped(text);
    }
    let part = |(n, part): (usize, &&str)| match n % 2 {
        0 => escaped(part),
        _ => format!("<code>{}</code>", escaped(part)),
    };
    parts.iter().enumerate().map(part).collect()
}

/// Writes the sign of negative numbers in a text as in print. Hyphens stay.
pub(super) fn minus(text: &str) -> String {
    let mut printed = String::with_capacity(text.len());
    let mut before = ' ';
    let mut rest = text.chars().peekable();
    while let Some(c) = rest.next() {
        let begins = before == 'e' || !before.is_alphanumeric();
        let is_sign = c == '-' && begins && rest.peek().is_some_and(char::is_ascii_digit);
        printed.push(if is_sign { '−' } else { c });
        before = c;
    }
    printed
}

/// A number with its value, SI, for programs that read the page; `key` says where it stands in
/// `summary.json`.
pub(super) fn number(key: &str, value: &serde_json::Value, text: &str) -> String {
    match value {
        serde_json::Value::Number(value) => {
            format!("<data data-key=\"{}\" value=\"{value}\">{}</data>", escaped(key), escaped(&minus(text)))
        }
        _ => escaped(text),
    }
}

/// Rows of a name and what has been made HTML already.
pub(super) fn facts(rows: impl IntoIterator<Item = (String, String)>) -> String {
    let mut html = String::from("<table class=\"facts\"><tbody>");
    for (name, value) in rows {
        let _ = write!(html, "<tr><th scope=\"row\">{}</th><td>{value}</td></tr>", escaped(&name));
    }
    html + "</tbody></table>"
}

/// What can be unfolded.
pub(super) fn details(summary: &str, content: &str) -> String {
    format!("<details><summary>{}</summary>{content}</details>", escaped(summary))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn negative_numbers_have_a_minus_and_words_a_hyphen() {
        assert_eq!(minus("-3.2 nm, (-1, 8.5e-3)"), "−3.2 nm, (−1, 8.5e−3)");
        assert_eq!(minus("Rigid-body approach by ISO 21920-2"), "Rigid-body approach by ISO 21920-2");
    }

    #[test]
    fn code_is_what_stands_between_backticks() {
        assert_eq!(with_code("give `s_filter` < 1"), "give <code>s_filter</code> &lt; 1");
        assert_eq!(with_code("a ` alone"), "a ` alone");
    }

    #[test]
    fn no_markup_survives() {
        let title = "</script><img src=x onerror=alert(1)> & \"x\" 'y' \u{0}\u{1b}";
        let safe = escaped(title);
        assert!(!safe.contains(['<', '>', '"', '\'', '\u{0}', '\u{1b}']), "{safe}");
        let data = serde_json::json!({ "title": title, "<!--": "]]>" });
        let script = script_data(&data);
        assert!(!script.contains(['<', '>', '&']), "{script}");
        assert_eq!(serde_json::from_str::<serde_json::Value>(&script).unwrap(), data);
    }
}
