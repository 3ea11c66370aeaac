//! Compressed data expand to no more than the header specifies, and a small file allocates little memory.

use super::*;

const MUCH: usize = 1 << 24;

fn deflated<W: Write>(mut encoder: W, finish: impl FnOnce(W) -> std::io::Result<Vec<u8>>) -> Vec<u8> {
    encoder.write_all(&vec![0; MUCH]).unwrap();
    let packed = finish(encoder).unwrap();
    assert!(packed.len() < MUCH / 500);
    packed
}

#[test]
fn a_gzipped_file_is_unpacked_to_a_limit() {
    let encoder = flate2::write::GzEncoder::new(Vec::new(), flate2::Compression::default());
    let packed = deflated(encoder, |encoder| encoder.finish());
    assert_eq!(unpacked(&packed, MUCH as u64).unwrap().len(), MUCH);
    let Err(Fault::Corrupt { reason, .. }) = unpacked(&packed, 999) else { panic!("expected a defect") };
    assert_eq!(reason.to_string(), "the unpacked file holds 1000 bytes, expected 999");
}

#[test]
fn a_compressed_sur_is_unpacked_to_the_heights_of_its_header() {
    let encoder = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::default());
    let packed = deflated(encoder, |encoder| encoder.finish());
    let mut file = sur_of(16, "", 1)[..515].to_vec();
    file[..12].copy_from_slice(b"DSCOMPRESSED");
    file.extend(files::words(&[1, 12, packed.len() as u32]));
    file.extend(packed);
    assert_eq!(defect(&file), "sur: the heights holds 13 bytes, expected 12");
}

#[test]
fn an_x3p_is_unpacked_to_the_heights_of_its_header() {
    let zeros = vec![0; MUCH];
    let more = [x3p_with("D", &zeros, None, ""), x3p_with("D", &[0; 80], Some(&zeros), "")];
    assert_eq!(defect(&more[0]), "x3p: the point data holds 81 bytes, expected 80");
    assert_eq!(defect(&more[1]), "x3p: the mask of valid points holds 11 bytes, expected 2");
    let main = zipped(&[("main.xml", &vec![b' '; (1 << 26) + 1])]);
    assert_eq!(defect(&main), "x3p: main.xml holds 67108865 bytes, expected 67108864");
}

#[test]
fn an_x3p_names_no_more_layers_than_are_likely() {
    let layers = |count: &str| {
        let bytes = x3p_with("I", &[1; 20], None, "");
        let mut archive = zip::ZipArchive::new(Cursor::new(bytes)).unwrap();
        let mut main = String::new();
        archive.by_name("main.xml").unwrap().read_to_string(&mut main).unwrap();
        let sizes = "<SizeX>5</SizeX><SizeY>2</SizeY><SizeZ>1</SizeZ>";
        let other = format!("<SizeX>1</SizeX><SizeY>1</SizeY><SizeZ>{count}</SizeZ>");
        zipped(&[("main.xml", main.replace(sizes, &other).as_bytes()), ("bindata/data.bin", &[1; 20])])
    };
    assert_eq!(decode(&layers("10"), None).unwrap().channels.len(), 10);
    assert_eq!(defect(&layers("268435456")), "x3p: SizeZ is `268435456`, expected at most 65536");
}

#[test]
fn a_compressed_tiff_has_no_more_pixels_than_its_bytes_can_stand_for() {
    let mut file = tiff::deflated_page();
    let entry = |tag: u16| [tag.to_le_bytes(), 4u16.to_le_bytes()].concat();
    for tag in [256, 257] {
        let at = file.windows(4).position(|bytes| bytes == entry(tag)).unwrap();
        file[at + 8..at + 12].copy_from_slice(&(1u32 << 14).to_le_bytes());
    }
    assert!(file.len() < 1 << 10);
    assert_eq!(defect(&file), "tiff: decoder limits exceeded");
}

#[test]
fn the_xml_of_an_x3p_has_no_more_attributes_than_the_format() {
    let began = std::time::Instant::now();
    let attributes: String = (0..100_000).map(|n| format!(" a{n}='<'")).collect();
    let with = |root: String| defect(&zipped(&[("main.xml", root.as_bytes())]));
    let message = "x3p: the number of attributes in main.xml is `100000 or more`, expected at most 1024";
    assert_eq!(with(format!("<!-- > --><p:ISO5436_2{attributes}/>")), message);
    let nested = |depth| format!("{}{}", "<a>".repeat(depth), "</a>".repeat(depth));
    assert_eq!(with(nested(300)), "x3p: the depth of main.xml is `257 or more`, expected at most 256");
    let shallow = decode(&zipped(&[("main.xml", nested(200).as_bytes())]), None);
    assert!(matches!(shallow, Err(Fault::NotATopography(_))), "{shallow:?}");
    assert!(began.elapsed().as_secs_f64() < 2.0);
}

#[test]
fn a_tiff_has_no_more_values_in_a_directory_than_bytes() {
    let mut file = tiff::deflated_page();
    let bytes = file.len() as u32;
    // The offsets of strips.
    let entry = [273u16.to_le_bytes(), 4u16.to_le_bytes()].concat();
    let at = file.windows(4).position(|bytes| bytes == entry).unwrap();
    file[at + 4..at + 8].copy_from_slice(&(8u32 << 20).to_le_bytes());
    assert_eq!(defect(&file), format!("tiff: the file holds {bytes} bytes, expected {}", 32 << 20));
}
