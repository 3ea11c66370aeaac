//! Files of instruments, built byte by byte: small ones for tests, large ones for the reading benchmark.
//!
//! `shape` is the number of heights along x and y, `data` are the heights as stored in the format. The pitch
//! is 0.5 and 0.25 µm unless stated otherwise.

/// Heights in metres, an even number per line; −1 is missing.
pub(super) fn al3d([nx, ny]: [u32; 2], data: &[u8]) -> Vec<u8> {
    let tags = [
        ("Version", "1"),
        ("TagCount", "6"),
        ("Cols", &nx.to_string()),
        ("Rows", &ny.to_string()),
        ("DepthImageOffset", "500"),
        ("InvalidPixelValue", "-1"),
        ("PixelSizeXMeter", "5e-7"),
        ("PixelSizeYMeter", "2.5e-7"),
    ];
    let mut header = b"AliconaImaging\0\r\n".to_vec();
    for (name, value) in tags {
        let tag: [(usize, &[u8]); 3] = [(0, name.as_bytes()), (20, value.as_bytes()), (50, b"\r\n")];
        header.extend(file(52, &tag, &[]));
    }
    file(500, &[(0, &header)], data)
}

/// Heights in units of half a nanometre; the `kind` is bcrstm or bcrf, or either with `_unicode`.
pub(super) fn bcr(kind: &str, big: bool, [nx, ny]: [u32; 2], data: &[u8]) -> Vec<u8> {
    let (lengths, intel) = ([0.5 * f64::from(nx), 250.0 * f64::from(ny)], i32::from(!big));
    let header = format!(
        "fileformat = {kind}\nxpixels = {nx}\nypixels = {ny}\nxlength = {}\nylength = {}\nxunit = um\nbit2nm = 0.5\n\
         intelmode = {intel}\n% end\n",
        lengths[0], lengths[1]
    );
    let header = format!("{header:<2048}");
    let header = if kind.ends_with("unicode") {
        header.encode_utf16().flat_map(u16::to_le_bytes).collect()
    } else {
        header.into_bytes()
    };
    [header.as_slice(), data].concat()
}

/// Blocks with a type and a content, over 3 × 1 mm, in nanometres.
pub(super) fn frt([nx, ny]: [u32; 2], bits: u32, blocks: &[(u16, &[u8])]) -> Vec<u8> {
    let lengths: Vec<u8> = [3e-3f64, 1e-3].iter().flat_map(|length| length.to_le_bytes()).collect();
    let unit = [&[5, 0, 0, 0], &1e-9f64.to_le_bytes()[..]].concat();
    let sizes = words(&[nx, ny, bits]);
    let common: [(u16, &[u8]); 3] = [(0x66, &sizes), (0x67, &lengths), (0x6c, &unit)];
    let mut file = b"FRTM_GLIDERV1.00".to_vec();
    file.extend((common.len() as u16 + blocks.len() as u16).to_le_bytes());
    for (kind, content) in common.iter().chain(blocks) {
        file.extend(kind.to_le_bytes());
        file.extend((content.len() as u32).to_le_bytes());
        file.extend(*content);
    }
    file
}

/// Phases in units of 0.5 · 500 nm / 32768, 2 µm apart.
pub(super) fn metropro([nx, ny]: [u16; 2], phases: &[u8]) -> Vec<u8> {
    let header: [(usize, &[u8]); 11] = [
        (0, b"\x88\x1b\x03\x6f"),
        (6, &834u32.to_be_bytes()),
        (60, &4u32.to_be_bytes()),
        (68, &nx.to_be_bytes()),
        (70, &ny.to_be_bytes()),
        (164, &0.5f32.to_be_bytes()),
        (168, &5e-7f32.to_be_bytes()),
        (176, &1f32.to_be_bytes()),
        (184, &2e-6f32.to_be_bytes()),
        (218, &1u16.to_be_bytes()),
        (830, b"last"),
    ];
    file(834, &header, &[&[9; 4], phases].concat())
}

/// The type of the array as written by NumPy, `'<f8'` with its quotes, and the shape as `(3, 2)`.
pub(super) fn npy(descr: &str, fortran: bool, shape: &str, data: &[u8]) -> Vec<u8> {
    let fortran = if fortran { "True" } else { "False" };
    let header = format!("{{'descr': {descr}, 'fortran_order': {fortran}, 'shape': {shape}, }}");
    let header = format!("{header:<117}\n");
    let length = (header.len() as u16).to_le_bytes();
    [b"\x93NUMPY\x01\0", length.as_slice(), header.as_bytes(), data].concat()
}

/// Arrays with the number of bytes of an element, in units of 500 nm (integers of 50 nm), 2 and 1 µm apart.
pub(super) fn opd([nx, ny]: [u16; 2], arrays: &[(&str, u16, &[u8])]) -> Vec<u8> {
    let (wavelength, pixel, aspect) = (floats(&[500.0]), floats(&[2e-3]), floats(&[0.5]));
    let mut blocks: Vec<(&str, u16, Vec<u8>)> = vec![
        ("Wavelength", 7, wavelength),
        ("Pixel_size", 7, pixel),
        ("Aspect", 7, aspect),
        ("Mult", 6, vec![10, 0]),
        ("Title", 5, b"a test".to_vec()),
    ];
    for (name, size, data) in arrays {
        let sizes = [nx, ny, *size].map(u16::to_le_bytes).concat();
        blocks.push((name, 3, [sizes.as_slice(), data].concat()));
    }
    blocks.insert(0, ("Directory", 1, vec![0; 24 * (blocks.len() + 1)]));
    let mut content = vec![1, 0];
    for (name, kind, data) in &blocks {
        let size = (data.len() as u32).to_le_bytes();
        let entry: [(usize, &[u8]); 4] =
            [(0, name.as_bytes()), (16, &kind.to_le_bytes()), (18, &size), (22, &[8, 0])];
        content.extend(file(24, &entry, &[]));
    }
    content.extend(blocks[1..].iter().flat_map(|(_, _, data)| data));
    content
}

/// Heights in micrometres.
pub(super) fn plu([nx, ny]: [u32; 2], data: &[u8]) -> Vec<u8> {
    let header: [(usize, &[u8]); 4] = [
        (0, b"Tue Mar  7 16:35:59 2023"),
        (132, b"a test"),
        (404, &floats(&[0.5, 0.25])),
        (428, &3u32.to_le_bytes()),
    ];
    file(500, &header, &[words(&[ny, nx]).as_slice(), data].concat())
}

/// Numbers in units of 2 m, 0.5 and 0.25 m apart, of the type `kind`.
pub(super) fn sdf(kind: u8, shape: [u16; 2], data: &[u8]) -> Vec<u8> {
    let mut file = b"bISO-1.0tester    010120250000010120250000".to_vec();
    file.extend(shape.map(u16::to_le_bytes).concat());
    file.extend([0.5f64, 0.25, 2.0, 0.0].map(f64::to_le_bytes).concat());
    file.extend([0, kind, 0]);
    file.extend(data);
    file
}

/// One of `objects` objects, with heights in units of 2 µm above 0.5 µm, 0.5 and 0.25 mm apart; −7 is
/// missing.
pub(super) fn sur(bits: u16, name: &str, objects: u16, [nx, ny]: [u32; 2], data: &[u8]) -> Vec<u8> {
    let header: [(usize, &[u8]); 17] = [
        (0, b"DIGITAL SURF"),
        (14, &objects.to_le_bytes()),
        (18, &2i16.to_le_bytes()),
        (20, name.as_bytes()),
        (86, &1i16.to_le_bytes()),
        (98, &bits.to_le_bytes()),
        (100, &(-5i32).to_le_bytes()),
        (108, &nx.to_le_bytes()),
        (112, &ny.to_le_bytes()),
        (120, &0.5f32.to_le_bytes()),
        (124, &0.25f32.to_le_bytes()),
        (128, &2f32.to_le_bytes()),
        (180, b"mm              "),
        (196, b"mm              "),
        (212, b"\xb5m"),
        (334, &3i16.to_le_bytes()),
        (474, &0.5f32.to_le_bytes()),
    ];
    file(512, &header, &[b"abc", data].concat())
}

/// The file `plain` of [`sur`], with its heights in two zlib streams, the first of 5 bytes.
pub(super) fn sur_compressed(plain: &[u8]) -> Vec<u8> {
    use std::io::Write;
    const START: usize = 515;
    let parts = [&plain[START..START + 5], &plain[START + 5..]];
    let packed = parts.map(|part| {
        let mut encoder = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::default());
        encoder.write_all(part).expect("memory takes all");
        encoder.finish().expect("memory takes all")
    });
    let lengths = [0, 1].map(|part| words(&[parts[part].len() as u32, packed[part].len() as u32]));
    let directory = [words(&[2]), lengths.concat()].concat();
    [b"DSCOMPRESSED", &plain[12..START], &directory, &packed.concat()].concat()
}

/// Heights in millimetres, 0.5 and 0.25 mm apart.
pub(super) fn tmd([nx, ny]: [u32; 2], data: &[u8]) -> Vec<u8> {
    let lengths = floats(&[0.5 * nx as f32, 0.25 * ny as f32, 0.0, 0.0]);
    [b"Binary TrueMap Data File v2.0\r\n\0a test\0", words(&[nx, ny]).as_slice(), &lengths, data].concat()
}

pub(super) fn floats(numbers: &[f32]) -> Vec<u8> {
    numbers.iter().flat_map(|number| number.to_le_bytes()).collect()
}

pub(super) fn words(numbers: &[u32]) -> Vec<u8> {
    numbers.iter().flat_map(|number| number.to_le_bytes()).collect()
}

/// A header of zeros with `parts` at their places, followed by `data`.
fn file(header: usize, parts: &[(usize, &[u8])], data: &[u8]) -> Vec<u8> {
    let mut file = vec![0; header];
    for (at, part) in parts {
        file[*at..at + part.len()].copy_from_slice(part);
    }
    file.extend(data);
    file
}
