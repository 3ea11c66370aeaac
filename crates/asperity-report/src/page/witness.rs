//! Parts of the page of a large static contact, made while its arrays are in memory for the figures.

use asperity_study::Results;
use asperity_study::io::fields::Fields;
use rayon::prelude::*;

use super::layers::levels_of;
use super::quantised::{self, Levels, QuantisedField};
use super::shown_body::{MAX_CELLS, ShownBody};
use crate::draw::{self, Charts, Paper};
use crate::error::Result;
use crate::figures::{self, FigureOptions, HeightRange, Sheet, StoredArray, Witness};

/// Figures that the page shows without JavaScript.
pub(super) const PICTURES: [&str; 3] = ["topographies", "pressure", "contact"];
/// Dots per inch of these.
pub(super) const DPI: f64 = 96.0;

/// Parts of a page made of the arrays so far.
#[derive(Default)]
pub struct Seen {
    maps: Vec<(&'static str, Levels)>,
    bodies: Vec<ShownBody>,
    profile: Option<Charts>,
    pictures: Vec<(String, draw::Scene)>,
    block: usize,
}

/// Parts of a page, ready to be written.
pub(super) struct Prepared {
    /// Maps of the contact by the names of their layers.
    pub(super) maps: Vec<(&'static str, QuantisedField)>,
    /// Lower and upper body.
    pub(super) bodies: Vec<ShownBody>,
    /// The section through the most loaded spot.
    pub(super) profile: Option<Charts>,
    /// PNG files, with their names.
    pub(super) pictures: Vec<(String, Vec<u8>)>,
    /// Cells along a side of the blocks that are shown.
    pub(super) block: usize,
}

impl Witness for Seen {
    fn array(&mut self, name: &'static str, array: &StoredArray) {
        self.maps.extend(levels_of(name, array, false).map(|levels| (name, levels)));
        if name == "pressure" {
            self.block = quantised::block(&array.field);
        }
    }

    fn body(&mut self, body: &StoredArray, range: Option<HeightRange>) {
        self.bodies.push(ShownBody::new(body, range));
    }

    fn profile(&mut self, profile: Option<&Charts>) {
        self.profile = profile.cloned();
    }
}

/// Draws the figures of `results`, and makes the parts of the page that show the same arrays. Only large
/// static contacts of hard walls without friction have such parts. Other pages are made from their files.
pub fn gathered<'a>(
    results: &Results,
    wanted: &'a FigureOptions,
    stop: &'a (dyn Fn() -> bool + Sync),
) -> (Result<Sheet<'a>>, Option<Seen>) {
    match large_contact(results) {
        Some(fields) => seen_on(&fields, results, wanted, stop),
        None => (figures::gathered(results, wanted, stop), None),
    }
}

/// Makes the parts of the page that show the arrays of a large static contact without friction.
pub(super) fn parts(results: &Results) -> Option<Seen> {
    let nothing = FigureOptions { only: vec![String::new()], ..FigureOptions::default() };
    seen_on(&large_contact(results)?, results, &nothing, &|| false).1
}

fn seen_on<'a>(
    fields: &Fields,
    results: &Results,
    wanted: &'a FigureOptions,
    stop: &'a (dyn Fn() -> bool + Sync),
) -> (Result<Sheet<'a>>, Option<Seen>) {
    let mut seen = Seen::default();
    let paper = Paper { dpi: DPI, ..Paper::default() };
    let mut sheet = figures::gathered_with(results, wanted, (paper, &PICTURES), stop, (fields, &mut seen));
    // The page reports a damaged file.
    let is_whole = sheet.is_ok() && fields.verify().is_ok();
    if let Ok(sheet) = &mut sheet {
        seen.pictures = sheet.take_pictures();
    }
    (sheet, is_whole.then_some(seen))
}

/// The fields of a static contact of many cells, if they are those of every static contact.
fn large_contact(results: &Results) -> Option<Fields> {
    let fields = results.static_fields().ok()?.with_digests();
    let names = fields.names().ok()?;
    let has = |name: &str| names.iter().any(|other| other == name);
    // Bodies that attract each other have a field of the cells in contact.
    let is_plain = !["stick", "traction_x", "temperature", "contact"].iter().any(|name| has(name));
    let is_static = results.passes().is_ok_and(|passes| passes.is_empty())
        && results.sweep().is_ok_and(|points| points.is_empty());
    let cells: usize = fields.shape("pressure").ok()?.iter().product();
    (is_plain && is_static && cells > MAX_CELLS).then_some(fields)
}

impl Seen {
    /// Compresses the maps, and draws the pictures.
    pub(super) fn prepared(self) -> Prepared {
        let Self { maps, mut bodies, profile, pictures, block } = self;
        let pictures = || {
            pictures
                .par_iter()
                .filter_map(|(name, scene)| Some((name.clone(), draw::picture(scene, DPI).ok()?)))
        };
        let maps = || maps.into_par_iter().map(|(name, levels)| (name, levels.deflated())).collect();
        let deflate = || bodies.par_iter_mut().for_each(ShownBody::deflate);
        let (pictures, (maps, ())) = rayon::join(|| pictures().collect(), || rayon::join(maps, deflate));
        Prepared { maps, bodies, profile, pictures, block }
    }
}
