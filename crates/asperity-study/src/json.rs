//! JSON of results: as `serde_json` writes it, with 0 for −0.

use std::io;

use serde::Serialize;
use serde_json::Serializer;
use serde_json::ser::{CompactFormatter, Formatter, PrettyFormatter};

/// Writes a record on one line.
pub(super) fn to_string(record: &impl Serialize) -> String {
    let mut text = Vec::new();
    let mut serializer = Serializer::with_formatter(&mut text, Unsigned(CompactFormatter));
    record.serialize(&mut serializer).expect("a record of numbers is JSON");
    String::from_utf8(text).expect("JSON is UTF-8")
}

/// Writes a record with one value per line.
///
/// # Errors
/// The reason why it could not be written.
pub(super) fn write_pretty(writer: impl io::Write, record: &impl Serialize) -> serde_json::Result<()> {
    record.serialize(&mut Serializer::with_formatter(writer, Unsigned(PrettyFormatter::new())))
}

/// A format in which 0 has no sign.
struct Unsigned<F>(F);

impl<F: Formatter> Formatter for Unsigned<F> {
    fn write_f64<W: ?Sized + io::Write>(&mut self, writer: &mut W, value: f64) -> io::Result<()> {
        // −0 + 0 = 0
        self.0.write_f64(writer, value + 0.0)
    }

    fn begin_array<W: ?Sized + io::Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.0.begin_array(writer)
    }

    fn end_array<W: ?Sized + io::Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.0.end_array(writer)
    }

    fn begin_array_value<W: ?Sized + io::Write>(&mut self, writer: &mut W, first: bool) -> io::Result<()> {
        self.0.begin_array_value(writer, first)
    }

    fn end_array_value<W: ?Sized + io::Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.0.end_array_value(writer)
    }

    fn begin_object<W: ?Sized + io::Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.0.begin_object(writer)
    }

    fn end_object<W: ?Sized + io::Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.0.end_object(writer)
    }

    fn begin_object_key<W: ?Sized + io::Write>(&mut self, writer: &mut W, first: bool) -> io::Result<()> {
        self.0.begin_object_key(writer, first)
    }

    fn begin_object_value<W: ?Sized + io::Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.0.begin_object_value(writer)
    }

    fn end_object_value<W: ?Sized + io::Write>(&mut self, writer: &mut W) -> io::Result<()> {
        self.0.end_object_value(writer)
    }
}

#[cfg(test)]
mod tests {
    use serde_json::json;

    use super::*;

    #[test]
    fn zero_has_no_sign_and_all_else_is_as_ever() {
        let record =
            json!({"force": [-0.0, -1.5], "text": "-0.0", "none": null, "deep": {"empty": [], "n": 3}});
        assert_eq!(to_string(&record), record.to_string().replace("[-0.0", "[0.0"));
        let mut pretty = Vec::new();
        write_pretty(&mut pretty, &record).unwrap();
        let expected = serde_json::to_string_pretty(&record).unwrap().replace("    -0.0", "    0.0");
        assert_eq!(String::from_utf8(pretty).unwrap(), expected);
    }
}
