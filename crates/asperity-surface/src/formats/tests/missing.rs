//! Numbers that stand for missing heights, and numbers beside them that do not.

use ::tiff::encoder::{TiffEncoder, colortype};
use ::tiff::tags::Tag;
use hdf5_pure::{AttrValue, FileBuilder};

use super::containers::netcdf;
use super::files::bcr;
use super::*;

/// Returns whether each height of a file is missing, line by line.
fn missing(bytes: &[u8]) -> Vec<bool> {
    decode(bytes, None).unwrap().heights.t().iter().map(|height| height.is_nan()).collect()
}

#[test]
fn the_largest_number_of_a_bcrstm_is_missing_and_the_smallest_is_a_height() {
    let numbers = [1i16, i16::MIN, -i16::MAX, i16::MAX, i16::MAX - 1, 6].map(i16::to_le_bytes).concat();
    assert_eq!(missing(&bcr("bcrstm", false, [3, 2], &numbers)), [false, false, false, true, false, false]);
    let numbers = [1f32, f32::MIN, 1.7e38, 1e30, f32::NAN, 6.0].map(f32::to_le_bytes).concat();
    assert_eq!(missing(&bcr("bcrf", false, [3, 2], &numbers)), [false, true, true, false, true, false]);
}

#[test]
fn a_value_of_a_netcdf_that_was_never_written_is_missing() {
    let mut file = netcdf(1, ["y", "x"], "nm", false);
    let numbers = [1i16, 2, 3, 4, 5, 6].map(i16::to_be_bytes).concat();
    let at = file.windows(numbers.len()).position(|part| part == numbers).unwrap();
    file[at + 6..at + 8].copy_from_slice(&(-32_767i16).to_be_bytes());
    assert_eq!(missing(&file), [false, false, false, true, false, false]);
}

#[test]
fn a_netcdf_whose_positions_fall_is_read_from_its_other_end() {
    let file = netcdf(1, ["y", "x"], "nm", false);
    let rising = decode(&file, None).unwrap();
    let places = [2f32, 4.0].map(f32::to_be_bytes).concat();
    let at = file.windows(places.len()).position(|part| part == places).unwrap();
    let mut falling = file.clone();
    falling[at..at + 8].copy_from_slice(&[4f32, 2.0].map(f32::to_be_bytes).concat());
    let falling = decode(&falling, None).unwrap();
    assert_eq!(falling.pitch, rising.pitch);
    let mut heights = rising.heights;
    heights.invert_axis(ndarray::Axis(1));
    assert_same(&falling.heights, &heights);
}

#[test]
fn a_data_set_of_hdf5_names_its_missing_value() {
    let mut file = FileBuilder::new();
    let set = file.create_dataset("height");
    set.with_i32_data(&[1, 2, 3, -9999, 5, 0]).with_shape(&[2, 3]);
    set.set_attr("_FillValue", AttrValue::I32(-9999)).set_attr("missing_value", AttrValue::F64(5.0));
    let heights = decode(&file.finish().unwrap(), None).unwrap().heights;
    assert_same(&heights, &ndarray::array![[1.0, 2.0, 3.0], [f64::NAN, f64::NAN, 0.0]]);
}

#[test]
fn a_tiff_of_gdal_names_its_missing_value() {
    let mut file = Cursor::new(Vec::new());
    let mut encoder = TiffEncoder::new(&mut file).unwrap();
    let mut image = encoder.new_image::<colortype::Gray32Float>(3, 2).unwrap();
    image.encoder().write_tag(Tag::GdalNodata, "-9999").unwrap();
    image.write_data(&[1.0, 2.0, 3.0, -9999.0, 5.0, 0.0]).unwrap();
    assert_eq!(missing(&file.into_inner()), [false, false, false, true, false, false]);
}
