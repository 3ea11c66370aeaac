use ::tiff::encoder::{Compression, DeflateLevel, TiffEncoder, colortype};

use super::*;

fn tiff<C: colortype::ColorType>(pages: &[&[C::Inner]], compression: Compression) -> Vec<u8>
where
    [C::Inner]: ::tiff::encoder::TiffValue,
{
    let mut file = Cursor::new(Vec::new());
    let mut encoder = TiffEncoder::new(&mut file).unwrap().with_compression(compression);
    for page in pages {
        encoder.write_image::<C>(3, 2, page).unwrap();
    }
    file.into_inner()
}

pub(super) fn sample() -> Vec<u8> {
    tiff::<colortype::Gray32Float>(&[&[1.0, 2.0, 3.0, 4.0, f32::NAN, 6.0], &[0.5; 6]], Compression::Lzw)
}

pub(super) fn deflated_page() -> Vec<u8> {
    tiff::<colortype::Gray32Float>(&[&[1.0; 6]], Compression::Deflate(DeflateLevel::Best))
}

#[test]
fn floats_of_a_tiff_are_heights_and_pages_are_channels() {
    let expected = ndarray::array![[1.0, 4.0], [2.0, f64::NAN], [3.0, 6.0]];
    let heights = [1.0, 2.0, 3.0, 4.0, f64::INFINITY, 6.0];
    for compression in [Compression::Uncompressed, Compression::Lzw, Compression::Deflate(DeflateLevel::Fast)]
    {
        let scan = decode(&tiff::<colortype::Gray64Float>(&[&heights], compression), Some("height")).unwrap();
        assert_eq!((scan.format, scan.pitch), ("tiff", None));
        assert_same(&scan.heights, &expected);
    }
    let first = decode(&sample(), None).unwrap();
    assert_eq!(first.channels, ["height 1", "height 2"]);
    assert_same(&first.heights, &expected);
    let second = decode(&sample(), Some("height 2")).unwrap();
    assert_same(&second.heights, &Field::from_elem([3, 2], 0.5));
}

#[test]
fn levels_of_grey_are_heights_once_they_have_a_unit() {
    let name = Path::new("grey.tif");
    let levels = [0, 1, 2, 3, 40_000, 65_535];
    let files = [
        tiff::<colortype::Gray16>(&[&levels], Compression::Lzw),
        tiff::<colortype::Gray32>(&[&levels.map(u32::from)], Compression::Uncompressed),
    ];
    for file in files {
        let message = from_bytes(name, &file, None, None).unwrap_err().to_string();
        assert!(
            message.ends_with("`levels`, expected heights, or with them the unit that one level stands for")
        );
        let scan = from_bytes(name, &file, None, Some(2e-9)).unwrap();
        assert_same(&scan.heights, &(ndarray::array![[0.0, 3.0], [1.0, 40_000.0], [2.0, 65_535.0]] * 2e-9));
    }
}

#[test]
fn a_tiff_of_something_else_than_heights_is_an_error() {
    let colours = tiff::<colortype::RGB8>(&[&[1; 18]], Compression::Uncompressed);
    assert!(
        defect(&colours).starts_with("tiff: the kind of pixels is `RGB(8)`, expected one number per pixel")
    );
    let mut wide = tiff::<colortype::Gray32Float>(&[&[1.0; 6]], Compression::Uncompressed);
    assert!(decode(&wide, None).is_ok());
    // The width is the first entry of the directory.
    let at = wide.windows(8).position(|entry| entry == [0, 1, 4, 0, 1, 0, 0, 0]).unwrap();
    wide[at + 8..at + 12].copy_from_slice(&100_000u32.to_le_bytes());
    assert_eq!(defect(&wide), "tiff: failed to fill whole buffer");
    assert!(defect(b"II*\0\xff\0\0\0").starts_with("tiff: "));
}
