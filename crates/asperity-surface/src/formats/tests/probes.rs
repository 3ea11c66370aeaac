//! Files of scanning probe microscopes, which are only read. They are built here; measured ones are compared
//! with other programs.

use super::files::{floats, words};
use super::*;

pub(super) fn samples() -> Vec<Vec<u8>> {
    vec![
        nanoscope(0x0512_0000, 2, &SHORTS.concat()),
        ibw_5(false, "", &[("", SIX)]),
        ibw_5(true, NOTE, &[("HeightTrace", SIX), ("PhaseTrace", SIX)]),
        ibw_2("m", &SIX),
        nid(16, true, &SHORTS.concat()),
        wsxm("short", &SHORTS.concat()),
        mi("BINARY", &[("Topography", "um", &SHORTS.concat()), ("Deflection", "V", &SHORTS.concat())]),
    ]
}

/// Heights read from [`SHORTS`], in units of the numbers, with lines from the last y to the first.
fn upside_down() -> Field {
    ndarray::array![[4.0, 1.0], [-5.0, 2.0], [6.0, 3.0]]
}

/// Two lines of three numbers.
const SHORTS: [[u8; 6]; 2] = [[1, 0, 2, 0, 3, 0], [4, 0, 0xfb, 0xff, 6, 0]];
const SIX: [f32; 6] = [1.0, 2.0, 3.0, 4.0, -5.0, 6.0];

fn integers() -> Vec<u8> {
    SIX.iter().flat_map(|number| (*number as i32).to_le_bytes()).collect()
}

#[track_caller]
fn assert_scan(scan: &Scan, format: &str, pitch: [f64; 2], heights: &Field) {
    assert_eq!((scan.format, scan.heights.dim()), (format, heights.dim()));
    for (found, expected) in scan.pitch.unwrap().iter().zip(pitch) {
        assert_relative_eq!(*found, expected, max_relative = 1e-12);
    }
    for (found, expected) in scan.heights.iter().zip(heights) {
        assert_relative_eq!(*found, *expected, max_relative = 1e-12);
    }
}

#[test]
fn heights_of_a_nanoscope_are_volts_by_their_sensitivity() {
    let unit = |bytes: i32| 32.0 / 256f64.powi(bytes) * 12.5e-9;
    let scan = decode(&nanoscope(0x0512_0000, 2, &SHORTS.concat()), None).unwrap();
    assert_eq!(scan.channels, ["Height Sensor", "Input"]);
    assert_scan(&scan, "nanoscope", [1e-6, 1e-6], &(upside_down() * unit(2)));
    // A sensitivity per volt with a scale in mV.
    let scan = decode(&nanoscope(0x0512_0000, 2, &SHORTS.concat()), Some("Input")).unwrap();
    assert_scan(&scan, "nanoscope", [1e-6, 1e-6], &(upside_down() * (unit(2) * 1e-3)));
    let scan = decode(&nanoscope(0x0512_0000, 4, &integers()), None).unwrap();
    assert_scan(&scan, "nanoscope", [1e-6, 1e-6], &(upside_down() * unit(4)));
    // From version 9.2 on, two bytes in the header mean four in the data.
    let scan = decode(&nanoscope(0x0920_0000, 2, &integers()), None).unwrap();
    assert_scan(&scan, "nanoscope", [1e-6, 1e-6], &(upside_down() * unit(2)));
}

#[test]
fn a_damaged_nanoscope_file_is_an_error() {
    let with = |old: &str, new: &str| {
        let header = latin1(&nanoscope(0x0512_0000, 2, &SHORTS.concat())).replacen(old, new, 9);
        defect(&header.chars().map(|character| character as u8).collect::<Vec<_>>())
    };
    assert_eq!(
        with("Samps/line: 3", "Samps/line: -3"),
        "nanoscope: samps/line is `-3`, expected a whole number"
    );
    assert_eq!(
        with("Samps/line: 3", "Samps/line: 4000000000"),
        "nanoscope: 8000000000 heights, at most 268435456 are read"
    );
    assert_eq!(with("pixel: 2", "pixel: 3"), "nanoscope: Bytes/pixel is `3`, expected 2 or 4");
    assert_eq!(
        with("offset: 2048", "offset: 4096"),
        "nanoscope: the part of the heights holds 0 bytes, expected 12"
    );
    assert_eq!(with("nm/V", "nA/V"), "nanoscope: no channel of lengths");
    assert_eq!(with("~m", "V"), "nanoscope: Scan Size is `3 2 V`, expected lengths with their unit");
    assert_eq!(
        with("@2:Z scale", "Z scale"),
        "nanoscope: no @2:Z scale, which files before version 4.3 have not"
    );
    assert_eq!(
        with("Start context: OL2", "Start context: FOL"),
        "nanoscope: Start context is `FOL`, expected an image, not a force curve"
    );
}

#[test]
fn a_nanoscope_file_may_tell_the_length_of_its_slow_axis() {
    let with = |old: &str, new: &str| {
        let file =
            latin1(&nanoscope(0x0512_0000, 2, &SHORTS.concat())).replacen(old, new, 9) + &" ".repeat(9);
        decode(&file.chars().map(|character| character as u8).collect::<Vec<_>>(), None).unwrap()
    };
    let slow = "\\*Ciao scan list\r\n\\Scan Size: 3000 nm\r\n\\Slow Axis Size: 500 nm\r\n\\Lines: 4";
    let pitch = |scan: Scan| scan.pitch.unwrap();
    assert_relative_eq!(pitch(with("\\*Ciao scan list", slow))[1], 125e-9, max_relative = 1e-12);
    let square = with("\\Scan Size: 3 2 ~m", "\\Scan Size: 3 ~m");
    assert_relative_eq!(pitch(square)[1], 1.5e-6, max_relative = 1e-12);
}

fn latin1(bytes: &[u8]) -> String {
    bytes.iter().map(|byte| char::from(*byte)).collect()
}

/// Three images of 3 × 2 numbers: 12.5 nm/V with 32 V, with 32 mV, and a phase.
fn nanoscope(version: u32, bytes: u32, data: &[u8]) -> Vec<u8> {
    let image = |index: usize, name: &str, scale: &str| {
        format!(
            "\\*Ciao image list\r\n\\Data offset: {}\r\n\\Data length: {}\r\n\\Bytes/pixel: {bytes}\r\n\\Samps/line: 3\r\n\
             \\Number of lines: 2\r\n\\Aspect Ratio: 3:2\r\n\\Scan Size: 3 2 ~m\r\n\
             \\@2:Image Data: S [{name}] \"{name}\"\r\n\\@2:Z scale: V {scale}\r\n",
            2048 + index * data.len(),
            data.len()
        )
    };
    let header = format!(
        "\\*File list\r\n\\Version: {version:#010x}\r\n\\Start context: OL2\r\n\\*Scanner list\r\n\\@Sens. Zsens: V 12.50000 nm/V\r\n\
         \\*Ciao scan list\r\n\\@Sens. Phase: V 1.000000 \r\n\\Empty: \r\n{}{}{}\\*File list end\r\n\x1a",
        image(0, "Height Sensor", "[Sens. Zsens] (0.0005 V/LSB) 32.00000 V"),
        image(1, "Phase", "[Sens. Phase] (0.005 log(Arb)/LSB) 180.0000 \u{b0}"),
        image(2, "Input", "[Sens. Zsens] (0.0005 mV/LSB) 32.00000 mV"),
    );
    let mut file: Vec<u8> = header.chars().map(|character| character as u8).collect();
    file.resize(2048, 0);
    [file.as_slice(), data, data, data].concat()
}

const NOTE: &str = "ScanSize: 2e-05\rPhaseUnit: deg\rVersion: 1";

#[test]
fn layers_of_an_igor_wave_are_channels() {
    for big in [false, true] {
        let layers =
            [("HeightTrace", SIX), ("PhaseTrace", SIX.map(|n| 10.0 * n)), ("NapZSensorRetrace", SIX)];
        let scan = decode(&ibw_5(big, NOTE, &layers), None).unwrap();
        assert_eq!(scan.channels, ["HeightTrace", "NapZSensorRetrace"]);
        assert_scan(&scan, "ibw", [0.5, 0.25], &upside_down());
        // Without the note of a microscope, each channel has the unit of the wave.
        let scan = decode(&ibw_5(big, "", &layers), Some("PhaseTrace")).unwrap();
        assert_scan(&scan, "ibw", [0.5, 0.25], &(upside_down() * 10.0));
        assert_eq!(scan.unit, LengthUnit::Known);
    }
    let unnamed = decode(&ibw_5(false, "", &[("", SIX)]), None).unwrap();
    assert_eq!(unnamed.channels, ["height"]);
}

#[test]
fn an_igor_wave_of_version_2_is_a_profile() {
    let scan = decode(&ibw_2("nm", &SIX), None).unwrap();
    let profile = Field::from_shape_vec([6, 1], SIX.iter().map(|n| f64::from(*n) * 1e-9).collect()).unwrap();
    assert_scan(&scan, "ibw", [0.5e-9; 2], &profile);
    let scan = from_bytes(Path::new("a"), &ibw_2("", &SIX), None, Some(1e-9)).unwrap();
    assert_scan(&scan, "ibw", [0.5e-9; 2], &profile);
    assert_eq!(defect(&ibw_2("V", &SIX)), "ibw: no channel of lengths");
}

#[test]
fn a_damaged_igor_wave_is_an_error() {
    let with = |at: usize, bytes: &[u8]| {
        let mut file = ibw_5(false, "", &[("", SIX)]);
        file[at..at + bytes.len()].copy_from_slice(bytes);
        defect(&with_checksum(file, false))
    };
    assert_eq!(with(80, &[3]), "ibw: the kind of wave is `0x3`, expected of real numbers");
    assert_eq!(with(132, &[9]), "ibw: the wave holds 344 bytes, expected 392");
    assert_eq!(with(135, &[0x7f]), "ibw: 4261412870 heights, at most 268435456 are read");
    assert_eq!(with(144, &[2]), "ibw: the size of the fourth dimension is `2`, expected none");
    // Without a valid checksum it could be any file.
    let mut other = ibw_5(false, "", &[("", SIX)]);
    other[100] ^= 1;
    assert!(matches!(decode(&other, None), Err(Fault::NotATopography(_))));
}

/// Layers of 3 × 2 numbers in metres, 0.5 and 0.25 m apart.
fn ibw_5(big: bool, note: &str, layers: &[(&str, [f32; 6])]) -> Vec<u8> {
    let word = |number: u32| if big { number.to_be_bytes() } else { number.to_le_bytes() };
    let short = |number: u16| if big { number.to_be_bytes() } else { number.to_le_bytes() };
    let double = |number: f64| if big { number.to_be_bytes() } else { number.to_le_bytes() };
    let data: Vec<u8> =
        layers.iter().flat_map(|(_, numbers)| numbers.map(|n| word(n.to_bits())).concat()).collect();
    let names = [&[("", SIX)], layers].concat();
    let labels: Vec<u8> = names.iter().flat_map(|(name, _)| format!("{name:\0<32}").into_bytes()).collect();
    let mut file = vec![0; 384];
    let mut put = |at: usize, bytes: &[u8]| file[at..at + bytes.len()].copy_from_slice(bytes);
    put(0, &short(5));
    put(4, &word(320 + data.len() as u32));
    put(12, &word(note.len() as u32));
    put(44, &word(labels.len() as u32));
    put(64 + 12, &word(6 * layers.len() as u32));
    put(64 + 16, &short(2));
    put(64 + 68, &[word(3), word(2), word(layers.len() as u32)].concat());
    put(64 + 84, &[double(0.5), double(-0.25)].concat());
    put(64 + 148, b"m\0\0\0m\0\0\0m");
    file.extend(data);
    file.extend(note.as_bytes());
    file.extend(labels);
    with_checksum(file, big)
}

fn ibw_2(unit: &str, numbers: &[f32]) -> Vec<u8> {
    let mut file = vec![0; 126];
    let mut put = |at: usize, bytes: &[u8]| file[at..at + bytes.len()].copy_from_slice(bytes);
    put(0, &[2, 0]);
    put(16, &[2, 0]);
    put(46, unit.as_bytes());
    put(50, unit.as_bytes());
    put(58, &words(&[numbers.len() as u32]));
    put(64, &0.5f64.to_le_bytes());
    file.extend(floats(numbers));
    with_checksum(file, false)
}

/// Sets the header number that makes the checksum 0.
fn with_checksum(mut file: Vec<u8>, big: bool) -> Vec<u8> {
    let (place, headers) = if file[0].max(file[1]) == 2 { (14, 126) } else { (2, 384) };
    file[place..place + 2].fill(0);
    let word = |word: &[u8]| {
        let word = [word[0], word[1]];
        if big { u16::from_be_bytes(word) } else { u16::from_le_bytes(word) }
    };
    let sum = file[..headers].chunks(2).fold(0u16, |sum, next| sum.wrapping_add(word(next))).wrapping_neg();
    file[place..place + 2].copy_from_slice(&if big { sum.to_be_bytes() } else { sum.to_le_bytes() });
    file
}

#[test]
fn numbers_of_a_nid_reach_from_the_least_height_on() {
    let unit = 65.536e-6 / 65_536.0;
    for signed in [true, false] {
        let scan = decode(&nid(16, signed, &SHORTS.concat()), None).unwrap();
        assert_eq!(scan.channels, ["Scan forward (Z-Axis)"]);
        let least = if signed { 0.0 } else { -32_768.0 };
        let heights = upside_down().mapv(|n| if !signed && n < 0.0 { n + 65_536.0 } else { n }) + least;
        assert_scan(&scan, "nid", [1e-6, 0.5e-6], &(heights * unit));
    }
    let bad =
        |old: &str, new: &str| defect(latin1(&nid(16, true, &SHORTS.concat())).replace(old, new).as_bytes());
    assert_eq!(bad("SaveBits=16", "SaveBits=12"), "nid: SaveBits is `12`, expected 8, 16 or 32");
    assert_eq!(bad("Points=3", "Points=5"), "nid: the part of the heights holds 8 bytes, expected 20");
    assert_eq!(bad("\n#!", "\n#?"), "nid: no mark of the data, #!");
    assert_eq!(bad("Dim2Unit=m", "Dim2Unit=V"), "nid: no channel of lengths");
}

/// A data set in volts and one of heights, with the minimum −32.768 µm.
fn nid(bits: u32, signed: bool, data: &[u8]) -> Vec<u8> {
    let sign = if signed { "Signed" } else { "Unsigned" };
    let set = |name: &str, unit: &str| {
        format!(
            "[DataSet-{name}]\r\nFrame=Scan forward\r\nPoints=3\r\nLines=2\r\nDim0Range=3e-06\r\nDim0Unit=m\r\nDim1Range=1\r\n\
             Dim1Unit=um\r\nDim2Name=Z-Axis\r\nDim2Unit={unit}\r\nDim2Min=-3.2768e-05\r\nDim2Range=6.5536e-05\r\n\
             SaveMode=Binary\r\nSaveBits={bits}\r\nSaveSign={sign}\r\nSaveOrder=Intel\r\n\r\n"
        )
    };
    let header = format!(
        "[DataSet]\r\nVersion=2\r\nGr0-Count=2\r\nGr0-Ch1=DataSet-0:1\r\nGr0-Ch0=DataSet-0:0\r\nGr1-Ch0=none\r\n\r\n{}{}#!",
        set("0:1", "m"),
        set("0:0", "V")
    );
    [header.as_bytes(), &data.iter().rev().copied().collect::<Vec<_>>(), data].concat()
}

#[test]
fn a_wsxm_image_is_turned_round() {
    // From −5 to 6 the heights span 22 nm.
    let turned = ndarray::array![[6.0, 3.0], [-5.0, 2.0], [4.0, 1.0]];
    let scan = decode(&wsxm("short", &SHORTS.concat()), None).unwrap();
    assert_scan(&scan, "wsxm", [200e-9, 300e-9], &(&turned * 2e-9));
    let doubles: Vec<u8> = SIX.iter().flat_map(|n| f64::from(*n).to_le_bytes()).collect();
    for (kind, data) in [("double", doubles), ("float", floats(&SIX))] {
        let scan = decode(&wsxm(kind, &data), None).unwrap();
        assert_scan(&scan, "wsxm", [200e-9, 300e-9], &(&turned * 1e-9));
    }
    let bad =
        |old: &str, new: &str| defect(latin1(&wsxm("short", &SHORTS.concat())).replace(old, new).as_bytes());
    assert_eq!(bad("short", "long"), "wsxm: Image Data Type is `long`, expected short, float or double");
    assert_eq!(
        bad("SxM Image", "SxM Curve"),
        "wsxm: the kind of file is `SxM Curve file`, expected SxM Image file"
    );
    assert_eq!(bad("22 nm", "22 nA"), "wsxm: a unit is `nA`, expected one of length");
    assert_eq!(bad("size: ", "size: 9"), "wsxm: the file holds 515 bytes, expected 9500");
    assert_eq!(bad("columns: 3", "columns: 0"), "wsxm: the size along x is `0`, expected at least 1");
}

fn wsxm(kind: &str, data: &[u8]) -> Vec<u8> {
    let header = format!(
        "WSxM file copyright UAM\r\nSxM Image file\r\nImage header size: 500\r\n\r\n[Control]\r\n\r\n    X Amplitude: 600 nm\r\n\
         \x20   Y Amplitude: 0.6 um\r\n[General Info]\r\n    Image Data Type: {kind}\r\n    Number of columns: 3\r\n\
         \x20   Number of rows: 2\r\n    Z Amplitude: 22 nm\r\n[Miscellaneous]\r\n    Maximum: 6\r\n    Minimum: -5\r\n\r\n"
    );
    [format!("{header:<487}[Header end]\n").as_bytes(), data].concat()
}

#[test]
fn buffers_of_an_mi_are_channels() {
    let short = [
        ("Topography", "um", &SHORTS.concat()[..]),
        ("Deflection", "V", &[9; 12]),
        ("Sensor", "um", &[0; 12]),
    ];
    let scan = decode(&mi("BINARY", &short), None).unwrap();
    assert_eq!(scan.channels, ["Topography", "Sensor"]);
    assert_scan(&scan, "mi", [1e-6, 2e-6], &(upside_down() * 2e-6));
    let scan = decode(&mi("BINARY_32", &[("Topography", "um", &integers())]), None).unwrap();
    assert_scan(&scan, "mi", [1e-6, 2e-6], &(upside_down() * (2e-6 / 65_536.0)));
    let bad = |old: &str, new: &str| defect(latin1(&mi("BINARY", &short[..1])).replace(old, new).as_bytes());
    assert_eq!(bad("BINARY", "ASCII"), "mi: data is `ASCII`, expected BINARY or BINARY_32");
    assert_eq!(bad("Image", "Spectroscopy"), "mi: fileType is `Spectroscopy`, expected Image");
    assert_eq!(bad("data  ", "date  "), "mi: no line of the data");
    assert_eq!(
        bad("xPixels       3", "xPixels       9"),
        "mi: the part of the heights holds 14 bytes, expected 36"
    );
}

fn mi(kind: &str, buffers: &[(&str, &str, &[u8])]) -> Vec<u8> {
    let mut file = "fileType      Image\nversion       PicoView\nxPixels       3\nyPixels       2\nxLength       3e-006\n\
                    yLength       4e-006\nacDOFromServo1FALSE\n"
        .to_owned();
    for (name, unit, _) in buffers {
        file += &format!("bufferLabel   {name}\nbufferUnit    {unit}\nbufferRange   6.5536e+004\n  trace\n");
    }
    let data: Vec<u8> = buffers.iter().flat_map(|(_, _, data)| *data).copied().collect();
    [format!("{file}data          {kind}\n").as_bytes(), &data].concat()
}
