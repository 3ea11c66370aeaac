//! A scene as PDF: text as text, with the glyphs that it needs.

use std::collections::BTreeMap;
use std::io::Write;

use flate2::Compression;
use flate2::write::ZlibEncoder;
use pdf_writer::types::{CidFontType, FontFlags, LineJoinStyle, SystemInfo, UnicodeCmap};
use pdf_writer::{Content, Filter, Finish, Name, Pdf, Rect as Box, Ref, Str};

use super::image::{Image, Rgb};
use super::scene::{Rect, Scene, Step, Stroke, Words};
use super::text::{CAPITAL, FONT, glyph_of, start, width_of};

const NAME: Name = Name(b"ASPERI+DejaVuSans");
const SYSTEM: SystemInfo = SystemInfo { registry: Str(b"Adobe"), ordering: Str(b"Identity"), supplement: 0 };

/// What a page is made of, by the numbers of the file's objects; images follow.
const CATALOG: i32 = 1;
const PAGES: i32 = 2;
const PAGE: i32 = 3;
const CONTENT: i32 = 4;
const TYPE0: i32 = 5;
const CID: i32 = 6;
const DESCRIPTOR: i32 = 7;
const FILE: i32 = 8;
const CMAP: i32 = 9;
const IMAGES: i32 = 10;

pub(super) fn document(scene: &Scene) -> std::io::Result<Vec<u8>> {
    let mut glyphs = Glyphs { mapper: subsetter::GlyphRemapper::new(), used: BTreeMap::new() };
    let mut images: Vec<&Image> = Vec::new();
    let mut content = Content::new();
    // From here on y runs down, as in the scene.
    let height = scene.size[1] as f32;
    content.transform([1.0, 0.0, 0.0, -1.0, 0.0, height]).set_line_join(LineJoinStyle::RoundJoin);
    for step in &scene.steps {
        match step {
            Step::Path { lines, closed, fill, stroke } => path(&mut content, lines, *closed, *fill, *stroke),
            Step::Text(words) => glyphs.write(&mut content, words),
            Step::Image(image, at) => {
                let Rect { x, y, width, height } = *at;
                content.save_state();
                content.transform([width, 0.0, 0.0, -height, x, y + height].map(|v| v as f32));
                content.x_object(Name(format!("I{}", images.len()).as_bytes()));
                content.restore_state();
                images.push(image);
            }
            Step::Clip(at) => {
                content.save_state();
                let [x, y, width, height] = [at.x, at.y, at.width, at.height].map(|v| v as f32);
                content.rect(x, y, width, height).clip_nonzero().end_path();
            }
            Step::Unclip => {
                content.restore_state();
            }
        }
    }

    let mut pdf = Pdf::new();
    pdf.catalog(Ref::new(CATALOG)).pages(Ref::new(PAGES));
    pdf.pages(Ref::new(PAGES)).kids([Ref::new(PAGE)]).count(1);
    let mut page = pdf.page(Ref::new(PAGE));
    page.parent(Ref::new(PAGES)).contents(Ref::new(CONTENT));
    page.media_box(Box::new(0.0, 0.0, scene.size[0] as f32, height));
    let mut resources = page.resources();
    resources.fonts().pair(Name(b"F"), Ref::new(TYPE0));
    let mut objects = resources.x_objects();
    for index in 0..images.len() {
        objects.pair(Name(format!("I{index}").as_bytes()), Ref::new(IMAGES + index as i32));
    }
    objects.finish();
    resources.finish();
    page.finish();
    pdf.stream(Ref::new(CONTENT), &deflated(&content.finish())?).filter(Filter::FlateDecode);
    for (index, image) in images.into_iter().enumerate() {
        let data = deflated(image.pixels.as_flattened())?;
        let mut object = pdf.image_xobject(Ref::new(IMAGES + index as i32), &data);
        object.filter(Filter::FlateDecode);
        object.width(image.width as i32).height(image.height as i32);
        object.color_space().device_rgb();
        object.bits_per_component(8);
        if image.clear {
            object.insert(Name(b"Mask")).array().items([255; 6]);
        }
    }
    glyphs.embed(&mut pdf)?;
    Ok(pdf.finish())
}

fn path(
    content: &mut Content,
    lines: &[Vec<[f64; 2]>],
    closed: bool,
    fill: Option<Rgb>,
    stroke: Option<Stroke>,
) {
    for line in lines {
        for (i, [x, y]) in line.iter().enumerate() {
            let (x, y) = (*x as f32, *y as f32);
            if i == 0 {
                content.move_to(x, y)
            } else {
                content.line_to(x, y)
            };
        }
        if closed {
            content.close_path();
        }
    }
    if let Some(fill) = fill {
        let [r, g, b] = unit(fill);
        content.set_fill_rgb(r, g, b);
    }
    if let Some(stroke) = stroke {
        let [r, g, b] = unit(stroke.colour);
        let dashes = Stroke::DASHES.map(|v| v as f32);
        let dashes = if stroke.dashed { &dashes[..] } else { &[] };
        content.set_stroke_rgb(r, g, b).set_line_width(stroke.width as f32);
        content.set_dash_pattern(dashes.iter().copied(), 0.0);
    }
    match (fill, stroke) {
        (Some(_), Some(_)) => content.fill_nonzero_and_stroke(),
        (Some(_), None) => content.fill_nonzero(),
        (None, Some(_)) => content.stroke(),
        (None, None) => content.end_path(),
    };
}

/// The glyphs that the text needs, and their characters.
struct Glyphs {
    mapper: subsetter::GlyphRemapper,
    used: BTreeMap<u16, char>,
}

impl Glyphs {
    fn write(&mut self, content: &mut Content, words: &Words) {
        let shown: Vec<u8> = words.text.chars().flat_map(|c| self.code(c).to_be_bytes()).collect();
        let [x, y] = words.at;
        let (along, down) = (start(words), words.size * CAPITAL / 2.0);
        // The text's own y runs up.
        let matrix = if words.upright {
            [0.0, -1.0, -1.0, 0.0, x + down, y - along]
        } else {
            [1.0, 0.0, 0.0, -1.0, x + along, y + down]
        };
        let [r, g, b] = unit(words.colour);
        content.begin_text().set_fill_rgb(r, g, b).set_font(Name(b"F"), words.size as f32);
        content.set_text_matrix(matrix.map(|v| v as f32)).show(Str(&shown)).end_text();
    }

    fn code(&mut self, c: char) -> u16 {
        let code = self.mapper.remap(glyph_of(c).0);
        self.used.entry(code).or_insert(c);
        code
    }

    fn embed(&self, pdf: &mut Pdf) -> std::io::Result<()> {
        let font = subsetter::subset(FONT, 0, &self.mapper).map_err(std::io::Error::other)?;
        let mut type0 = pdf.type0_font(Ref::new(TYPE0));
        type0.base_font(NAME).encoding_predefined(Name(b"Identity-H"));
        type0.descendant_font(Ref::new(CID)).to_unicode(Ref::new(CMAP));
        type0.finish();
        let mut cid = pdf.cid_font(Ref::new(CID));
        cid.subtype(CidFontType::Type2).base_font(NAME).system_info(SYSTEM);
        cid.font_descriptor(Ref::new(DESCRIPTOR)).cid_to_gid_map_predefined(Name(b"Identity"));
        let mut widths = cid.widths();
        for (code, c) in &self.used {
            widths.consecutive(*code, [width_of(&c.to_string(), 1000.0) as f32]);
        }
        widths.finish();
        cid.finish();
        let mut descriptor = pdf.font_descriptor(Ref::new(DESCRIPTOR));
        descriptor.name(NAME).flags(FontFlags::SYMBOLIC).bbox(Box::new(-1021.0, -463.0, 1793.0, 1232.0));
        descriptor.italic_angle(0.0).ascent(928.0).descent(-236.0).cap_height(729.0).stem_v(90.0);
        descriptor.font_file2(Ref::new(FILE));
        descriptor.finish();
        let data = deflated(&font)?;
        let mut file = pdf.stream(Ref::new(FILE), &data);
        file.filter(Filter::FlateDecode).pair(Name(b"Length1"), font.len() as i32);
        file.finish();
        let mut characters = UnicodeCmap::new(Name(b"Custom"), SYSTEM);
        for (code, c) in &self.used {
            characters.pair(*code, *c);
        }
        let cmap = characters.finish();
        pdf.cmap(Ref::new(CMAP), &cmap);
        Ok(())
    }
}

fn unit(colour: Rgb) -> [f32; 3] {
    colour.map(|c| f32::from(c) / 255.0)
}

fn deflated(bytes: &[u8]) -> std::io::Result<Vec<u8>> {
    let mut encoder = ZlibEncoder::new(Vec::new(), Compression::default());
    encoder.write_all(bytes)?;
    encoder.finish()
}
