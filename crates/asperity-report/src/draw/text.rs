//! The font of all figures: how wide a text is, and the part of the font that a file needs.

use std::collections::BTreeSet;
use std::sync::LazyLock;

use ttf_parser::{Face, GlyphId, OutlineBuilder};

use super::scene::{Anchor, Words};

/// DejaVu Sans 2.35, whose licence permits embedding. Its `OS/2` table is brought to version 4 and the
/// direction in `head` to 2, which font-subset asks for; tables of its layout are left out.
#[cfg(not(target_arch = "wasm32"))]
pub(super) const FONT: &[u8] = include_bytes!("../../assets/DejaVuSans.ttf");
/// Its Latin and Greek letters, digits, units and mathematical signs, for a page that is loaded first
/// (`assets/make_small_font.sh`).
#[cfg(target_arch = "wasm32")]
pub(super) const FONT: &[u8] = include_bytes!("../../assets/DejaVuSans-small.ttf");
pub(super) const FAMILY: &str = "DejaVu Sans";

/// Height of a capital over the size of the font.
pub(super) const CAPITAL: f64 = 0.73;

/// Size of the numbers at the ticks, pt.
pub(super) const SMALL: f64 = 7.0;
/// Size of axis labels and legends, pt.
pub(super) const MEDIUM: f64 = 7.5;
/// Size of the titles of panels, pt.
pub(super) const LARGE: f64 = 8.5;

static FACE: LazyLock<Face<'static>> =
    LazyLock::new(|| Face::parse(FONT, 0).expect("the embedded font is whole"));

/// The glyphs of `text`, and the way from each to the next in the unit of `size`.
pub(super) fn glyphs(text: &str, size: f64) -> impl Iterator<Item = (GlyphId, f64)> {
    text.chars().map(move |c| {
        let glyph = glyph_of(c);
        let advance = FACE.glyph_hor_advance(glyph).unwrap_or_default();
        (glyph, f64::from(advance) / units_per_em() * size)
    })
}

/// The glyph of a character; 0, an empty box, if the font has none.
pub(super) fn glyph_of(c: char) -> GlyphId {
    FACE.glyph_index(c).unwrap_or_default()
}

/// Width of `text` in the unit of `size`.
pub(super) fn width_of(text: &str, size: f64) -> f64 {
    glyphs(text, size).map(|(_, advance)| advance).sum()
}

/// Where a text begins, seen from the point that it is anchored at.
pub(super) fn start(words: &Words) -> f64 {
    let width = width_of(&words.text, words.size);
    match words.anchor {
        Anchor::Start => 0.0,
        Anchor::Middle => -width / 2.0,
        Anchor::End => -width,
    }
}

/// Draws the outline of a glyph in the font's own units.
pub(super) fn outline(glyph: GlyphId, builder: &mut dyn OutlineBuilder) {
    // A space has none.
    let _ = FACE.outline_glyph(glyph, builder);
}

/// The font's units in its size.
pub(super) fn units_per_em() -> f64 {
    f64::from(FACE.units_per_em())
}

/// The words of `text` in lines no wider than `room`, where a single word allows it.
pub(super) fn wrapped(text: &str, size: f64, room: f64) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if width_of(&format!("{line} {word}"), size) <= room => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
}

/// A font with the glyphs of `characters` and no others, as OpenType.
pub(super) fn subset(characters: &BTreeSet<char>) -> std::io::Result<Vec<u8>> {
    let font = font_subset::Font::opentype(FONT).map_err(std::io::Error::other)?;
    let known: BTreeSet<char> = characters.iter().copied().filter(|c| font.contains_char(*c)).collect();
    Ok(font.subset(&known).map_err(std::io::Error::other)?.to_opentype())
}
