//! Pictures of pixels.

/// A colour on screen.
pub(super) type Rgb = [u8; 3];

/// A picture, row by row from the top.
#[derive(Debug, Clone)]
pub(super) struct Image {
    pub(super) width: usize,
    pub(super) height: usize,
    pub(super) pixels: Vec<Rgb>,
    /// White is clear.
    pub(super) clear: bool,
}

impl Image {
    /// The picture as a PNG file, with its resolution in dots per inch.
    pub(super) fn png(&self, dpi: Option<f64>) -> Vec<u8> {
        let mut bytes = Vec::new();
        let mut encoder = png::Encoder::new(&mut bytes, self.width as u32, self.height as u32);
        encoder.set_color(png::ColorType::Rgb);
        encoder.set_depth(png::BitDepth::Eight);
        encoder.set_compression(png::Compression::Fast);
        if self.clear {
            encoder.set_trns(vec![0, 255, 0, 255, 0, 255]);
        }
        if let Some(dpi) = dpi {
            let per_metre = (dpi / 0.0254).round() as u32;
            let unit = png::Unit::Meter;
            encoder.set_pixel_dims(Some(png::PixelDimensions { xppu: per_metre, yppu: per_metre, unit }));
        }
        let written = encoder.write_header().and_then(|mut writer| {
            writer.write_image_data(self.pixels.as_flattened())?;
            writer.finish()
        });
        written.expect("a picture in memory can be encoded");
        bytes
    }
}
