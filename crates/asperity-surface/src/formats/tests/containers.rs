//! Container files: compound files, archives, NetCDF and HDF5, and text in UTF-16.

use hdf5_pure::{AttrValue, FileBuilder};

use super::files::{floats, words};
use super::*;

pub(super) fn samples() -> Vec<Vec<u8>> {
    vec![
        mnt(4, Some([9, 9, 9, 9, 22, 9])),
        opdx(),
        vk4(16, &SHORTS),
        vk6(),
        nms(),
        netcdf(1, ["y", "x"], "nm", true),
        netcdf(2, ["x", "y"], "", false),
        results(),
        declared(),
        std::fs::read(corpus("hdf5", "zygo")).unwrap(),
        utf16("1;2;3\n4;;6\n", true),
    ]
}

fn nan() -> f64 {
    f64::NAN
}

#[track_caller]
fn assert_scan(scan: &Scan, format: &str, pitch: Option<[f64; 2]>, heights: &Field) {
    assert_eq!((scan.format, scan.heights.dim()), (format, heights.dim()));
    assert_eq!(scan.pitch.is_some(), pitch.is_some());
    for (found, expected) in scan.pitch.iter().flatten().zip(pitch.iter().flatten()) {
        assert_relative_eq!(*found, *expected, max_relative = 1e-12);
    }
    for (found, expected) in scan.heights.iter().zip(heights) {
        assert!(found.is_nan() == expected.is_nan(), "{} is not {heights}", scan.heights);
        assert!(found.is_nan() || (found - expected).abs() <= 1e-12 * expected.abs(), "{}", scan.heights);
    }
}

/// The heights 1, 2, 3 in the first line and 4, none, 6 in the next.
fn six() -> Field {
    ndarray::array![[1.0, 4.0], [2.0, nan()], [3.0, 6.0]]
}

const SHORTS: [u8; 12] = [1, 0, 2, 0, 3, 0, 4, 0, 5, 0, 6, 0];

// ---- mnt
// ---------------------------------------------------------------------------------------------------

#[test]
fn an_mnt_has_a_step_an_origin_and_a_mask() {
    for size in [2, 4] {
        let scan = decode(&mnt(size, Some([9, 9, 9, 9, 22, 9])), None).unwrap();
        assert_eq!(scan.channels, ["disc"]);
        assert_scan(&scan, "mnt", Some([1e-6, 1e-6]), &(six() * 2e-9 + 3e-6));
    }
    let whole = decode(&mnt(2, None), None).unwrap();
    assert_relative_eq!(whole.heights[[1, 1]], 3.01e-6, max_relative = 1e-12);
}

#[test]
fn a_damaged_mnt_is_an_error() {
    assert_eq!(defect(&mnt(3, None)), "mnt: the bytes of a height is `3`, expected 2 or 4");
    assert!(defect(&mnt(2, None)[..600]).starts_with("mnt: "));
    let mut other = cfb::CompoundFile::create(Cursor::new(Vec::new())).unwrap();
    other.create_stream("/WordDocument").unwrap();
    let other = other.into_inner().into_inner();
    let reason = "it is a compound file, but no document of Mountains";
    assert!(matches!(decode(&other, None), Err(Fault::NotATopography(found)) if found.reason == reason));
    // A small file allocates little memory.
    let claims = |bytes: u64| {
        let mut array = blocks(2, &[0; 12]);
        array[..8].copy_from_slice(&bytes.to_le_bytes());
        defect(&compound(&document(&surface(&array, None))))
    };
    assert_eq!(
        claims(1 << 40),
        "mnt: the bytes of an array is `1099511627776`, expected that of its numbers"
    );
    assert_eq!(claims(24), "mnt: zlib: failed to fill whole buffer");
}

fn entry(tag: u16, content: &[u8]) -> Vec<u8> {
    [&tag.to_le_bytes()[..], &(content.len() as u64).to_le_bytes(), content].concat()
}

fn entries(parts: &[(u16, &[u8])]) -> Vec<u8> {
    parts.iter().flat_map(|(tag, content)| entry(*tag, content)).collect()
}

fn object(class: u32, body: &[u8]) -> Vec<u8> {
    entries(&[(1, &entry(1, &class.to_le_bytes())), (2, body)])
}

fn text(text: &str) -> Vec<u8> {
    std::iter::once(4).chain(text.encode_utf16().flat_map(u16::to_le_bytes)).collect()
}

/// Numbers with `size` bytes in two blocks, the last one first.
fn blocks(size: usize, numbers: &[u8]) -> Vec<u8> {
    let mut array = (numbers.len() as u64).to_le_bytes().to_vec();
    let half = numbers.len() / size / 2 * size;
    for (first, part) in [(half / size, &numbers[half..]), (0, &numbers[..half])] {
        let mut encoder = flate2::write::ZlibEncoder::new(Vec::new(), flate2::Compression::default());
        encoder.write_all(part).unwrap();
        let packed = encoder.finish().unwrap();
        array.extend((first as u64).to_le_bytes());
        array.extend(words(&[(part.len() / size) as u32, packed.len() as u32]));
        array.extend(packed);
    }
    array
}

/// A surface of 3 × 2 heights of 2 nm above 3 µm, 1 µm apart.
fn surface(heights: &[u8], mask: Option<[u8; 6]>) -> Vec<u8> {
    let array = |count: u32, blocks: &[u8]| object(9049, &entries(&[(1, &count.to_le_bytes()), (2, blocks)]));
    let scale = |step: f64, unit: &str, shown: &str, origin: f64| {
        let [step, origin] = [step, origin].map(f64::to_le_bytes);
        entries(&[(1, &step), (2, &text(unit)), (3, &text(shown)), (5, &origin)])
    };
    let axis = |count: u32| {
        entry(0xffff, &entries(&[(0xffff, &scale(1e-3, "mm", "µm", 7.0)), (1, &count.to_le_bytes())]))
    };
    let mut framed = vec![0; 20];
    for (index, mark) in mask.unwrap_or_default().iter().enumerate() {
        framed[6 + index % 3 + 5 * (index / 3)] = *mark;
    }
    let mask_body = entry(5, &array(20, &blocks(1, &framed)));
    let name = entry(0xffff, &entry(0xffff, &entry(1, &text("disc"))));
    let mut grid = [name, entry(1, &axis(3)), entry(2, &axis(2))].concat();
    if mask.is_some() {
        grid.extend(entry(3, &object(9056, &mask_body)));
    }
    let height = entry(0xffff, &scale(2e-6, "mm", "µm", 3.0));
    let data = entries(&[(0xffff, &grid), (1, &array(6, heights)), (2, &height)]);
    let title = entry(0xffff, &entry(4, &text("title")));
    object(9012, &[title, entry(1, &object(9062, &entry(0xffff, &data)))].concat())
}

fn document(surface: &[u8]) -> Vec<u8> {
    let listed = |object: &[u8]| [&[7; 8], entry(1, object).as_slice()].concat();
    let list = [listed(&object(9000, b"view")), listed(surface)].concat();
    let objects = entry(0x2bd, &[entry(1, &[2]), entry(2, &entry(1, &list))].concat());
    [&[0; 8], entry(3, &[1]).as_slice(), &entry(1, &[entry(0xc8, &[0; 4]), objects].concat())].concat()
}

fn compound(document: &[u8]) -> Vec<u8> {
    let mut file = cfb::CompoundFile::create(Cursor::new(Vec::new())).unwrap();
    file.create_stream("/ScopedContents").unwrap().write_all(document).unwrap();
    file.flush().unwrap();
    file.into_inner().into_inner()
}

fn mnt(size: usize, mask: Option<[u8; 6]>) -> Vec<u8> {
    let numbers: Vec<u8> = (1..=6u32).flat_map(|number| number.to_le_bytes()[..size].to_vec()).collect();
    compound(&document(&surface(&blocks(size, &numbers), mask)))
}

// ---- opdx
// --------------------------------------------------------------------------------------------------

#[test]
fn matrices_of_an_opdx_are_channels_the_primary_one_first() {
    let scan = decode(&opdx(), None).unwrap();
    assert_eq!(scan.channels, ["Height", "Levelled"]);
    assert_scan(&scan, "opdx", Some([1e-3, 2e-6]), &(six() * 0.5e-6));
    let mut deep = MAGIC_OF_OPDX.to_vec();
    for _ in 0..1000 {
        deep.extend([1, 0, 0, 0, b'a', 0x7d, 4, 0xff, 0, 0, 0]);
    }
    deep.resize(deep.len() + 300, 0);
    assert!(defect(&deep).starts_with("opdx: "), "{}", defect(&deep));
    let file = opdx();
    let (end, whole) = (file.len() - 40, file.len() - MAGIC_OF_OPDX.len());
    let expected = format!("opdx: the file holds {} bytes, expected {whole}", whole - 40);
    assert_eq!(defect(&file[..end]), expected);
}

const MAGIC_OF_OPDX: &[u8] = b"VCA DATA\x01\0\0\x55";

fn opdx() -> Vec<u8> {
    let name = |name: &str| [&(name.len() as u32).to_le_bytes()[..], name.as_bytes()].concat();
    let item = |path: &str, kind: u8, content: &[u8]| [name(path).as_slice(), &[kind], content].concat();
    let sized = |content: &[u8]| [&[2], &(content.len() as u16).to_le_bytes()[..], content].concat();
    let quantity = |path: &str, number: f64, unit: &str| {
        item(path, 0x13, &sized(&[&number.to_le_bytes(), name("name").as_slice(), &name(unit)].concat()))
    };
    let container = |path: &str, items: &[Vec<u8>]| {
        item(path, 0x7d, &sized(&[items.concat(), item("", 0x7f, &[]), vec![1, 2]].concat()))
    };
    let matrix = |numbers: &[f32]| {
        let content = sized(&[words(&[2, 3]), floats(numbers)].concat());
        item("Matrix", 0, &[name("Matrix"), words(&[7]), name("float"), content].concat())
    };
    let set = |path: &str, kind: &str, unit: &str, numbers: &[f32]| {
        container(
            path,
            &[
                item("DataKind", 0x12, &sized(kind.as_bytes())),
                quantity("Dimension1Extent", 2.0, "µm"),
                quantity("Dimension2Extent", 2.0, "mm"),
                quantity("DataScale", 0.5, unit),
                matrix(numbers),
            ],
        )
    };
    let sets = [
        set("Intensity", "Light", "V", &[0.0; 6]),
        set("Form", "Levelled", "µm", &[0.0; 6]),
        set("Raw", "Height", "µm", &[1.0, 2.0, 3.0, 4.0, 3.4e38, 6.0]),
    ];
    let about = [
        item("Flag", 0x01, &[1]),
        item("Short", 0x04, &[1; 2]),
        item("Long", 0x0a, &[1; 8]),
        item("Time", 0x15, &[1; 9]),
        item("Names", 0x42, &[name("list"), sized(&name("Raw"))].concat()),
        item("PrimaryData2D", 0x12, &sized(b"Raw")),
    ];
    [MAGIC_OF_OPDX.to_vec(), container("2D_Data", &sets), container("MetaData", &about)].concat()
}

// ---- vk, nms
// -----------------------------------------------------------------------------------------------

#[test]
fn heights_of_a_vk_are_in_picometres() {
    let whole = ndarray::array![[1.0, 4.0], [2.0, 5.0], [3.0, 6.0]];
    let (bytes, long): (Vec<u8>, Vec<u8>) = ((1..=6).collect(), words(&[1, 2, 3, 4, 5, 6]));
    for (bits, data) in [(8, &bytes[..]), (16, &SHORTS), (32, &long)] {
        let scan = decode(&vk4(bits, data), None).unwrap();
        assert_eq!(scan.channels, ["height", "height 3"]);
        assert_scan(&scan, "vk", Some([5e-7, 2.5e-7]), &(&whole * 1e-10));
    }
    let mut older = vk4(16, &SHORTS);
    older[..4].copy_from_slice(b"VK3_");
    older.drain(80..84);
    for place in [36, 44] {
        let at = u32::from_le_bytes(older[place..place + 4].try_into().unwrap()) - 4;
        older[place..place + 4].copy_from_slice(&at.to_le_bytes());
    }
    assert_scan(&decode(&older, None).unwrap(), "vk", Some([5e-7, 2.5e-7]), &(&whole * 1e-10));
    assert_scan(&decode(&vk6(), None).unwrap(), "vk", Some([5e-7, 2.5e-7]), &(&whole * 1e-10));
}

#[test]
fn a_damaged_vk_is_an_error() {
    let file = vk4(16, &SHORTS);
    assert_eq!(defect(&vk4(12, &SHORTS)), "vk: the bits of a height is `12`, expected 8, 16 or 32");
    assert_eq!(defect(&vk4(32, &SHORTS)), "vk: the heights holds 12 bytes, expected 24");
    assert_eq!(defect(&file[..file.len() - 2]), "vk: the part of the heights holds 10 bytes, expected 12");
    assert!(defect(b"VK6 and no archive").starts_with("vk: "));
    let other = [b"VK7", zipped(&[("other", b"VK4_")]).as_slice()].concat();
    assert_eq!(defect(&other), "vk: no Vk4File in the archive");
    let other = [b"VK7", zipped(&[("Vk4File", b"VK6_")]).as_slice()].concat();
    assert_eq!(defect(&other), "vk: no VK4_ at the start of Vk4File");
}

/// Heights in units of 100 pm, 0.5 and 0.25 µm apart, as the first and as the third image.
fn vk4(bits: u32, data: &[u8]) -> Vec<u8> {
    let image = [words(&[3, 2, bits, 0, data.len() as u32, 0, 0]), vec![3; 768], data.to_vec()].concat();
    let start = 12 + 18 * 4 + 45 * 4;
    let mut places = [0; 18];
    (places[6], places[8]) = (start, start + image.len() as u32);
    let mut conditions = [0; 45];
    conditions[42..].copy_from_slice(&[500_000, 250_000, 100]);
    [b"VK4_\x07\0\0\0\0\0\0\0", words(&places).as_slice(), &words(&conditions), &image, &image].concat()
}

fn vk6() -> Vec<u8> {
    let archive = zipped(&[("HDRImage", b"a picture"), ("Vk4File", &vk4(16, &SHORTS))]);
    [b"VK6\x01 some picture before it", archive.as_slice()].concat()
}

#[test]
fn heights_of_an_nms_reach_from_the_least_to_the_largest() {
    let scan = decode(&nms(), None).unwrap();
    let heights = ndarray::array![[1.0, 4.0], [2.0, 5.0], [3.0, 6.0]] * 1e-9 + 1e-6;
    assert_scan(&scan, "nms", Some([5e-7, 2.5e-7]), &heights);
    assert_eq!(defect(&nms()[..3475]), "nms: the part of the heights holds 7 bytes, expected 12");
}

fn nms() -> Vec<u8> {
    let mut file = vec![0; 3468];
    let mut put = |at: usize, bytes: &[u8]| file[at..at + bytes.len()].copy_from_slice(bytes);
    put(16, &[1f64, 66.534].map(f64::to_le_bytes).concat());
    put(32, b"OM_MS_2.0");
    put(1368, &words(&[3, 2]));
    put(1376, &[500f64, 250.0].map(f64::to_le_bytes).concat());
    file.extend(SHORTS);
    file
}

// ---- netcdf
// ------------------------------------------------------------------------------------------------

#[test]
fn a_netcdf_tells_which_of_its_dimensions_is_x() {
    let heights = six() * 1e-9 + 1e-8;
    let pitch = Some([5e-10, 2e-9]);
    for version in [1, 2] {
        assert_scan(
            &decode(&netcdf(version, ["y", "x"], "nm", true), None).unwrap(),
            "netcdf",
            pitch,
            &heights,
        );
        assert_scan(
            &decode(&netcdf(version, ["x", "y"], "nm", true), None).unwrap(),
            "netcdf",
            pitch,
            &heights,
        );
    }
    let without = netcdf(1, ["y", "x"], "", false);
    let scan = from_bytes(Path::new("a"), &without, None, Some(1e-9)).unwrap();
    let whole = ndarray::array![[1.0, 4.0], [2.0, 5.0], [3.0, 6.0]] * 1e-9 + 1e-8;
    assert_scan(&scan, "netcdf", pitch, &whole);
    assert_eq!(defect(&netcdf(1, ["y", "x"], "V", false)), "netcdf: no channel of lengths");
    assert_eq!(
        defect(&without[..without.len() - 2]),
        "netcdf: the part of the heights holds 10 bytes, expected 12"
    );
    assert_eq!(defect(&without[..30]), "netcdf: the header holds 30 bytes, expected 32");
    assert!(matches!(decode(b"CDF\x05", None), Err(Fault::NotATopography(_))));
}

/// The numbers 1 to 6 as i16, with the offset 10; x by its side length, y by its positions.
pub(super) fn netcdf(version: u8, dimensions: [&str; 2], unit: &str, masked: bool) -> Vec<u8> {
    let word = u32::to_be_bytes;
    let padded = |bytes: &[u8]| {
        let mut bytes = bytes.to_vec();
        bytes.resize(bytes.len().next_multiple_of(4), 0);
        bytes
    };
    let name = |name: &str| [word(name.len() as u32).to_vec(), padded(name.as_bytes())].concat();
    let unit_of = |unit: &str| [name("units"), word(2).to_vec(), name(unit)].concat();
    let double = |of: &str, number: f64| {
        [name(of), word(6).to_vec(), word(1).to_vec(), number.to_be_bytes().to_vec()].concat()
    };
    let list = |tag: u32, items: &[Vec<u8>]| match items.len() {
        0 => vec![0; 8],
        count => [word(tag).to_vec(), word(count as u32).to_vec(), items.concat()].concat(),
    };
    let units: Vec<Vec<u8>> = if unit.is_empty() { vec![] } else { vec![unit_of(unit)] };
    let along_x = dimensions == ["y", "x"];
    let order: [i16; 6] = if along_x { [1, 2, 3, 4, 5, 6] } else { [1, 4, 2, 5, 3, 6] };
    let heights: Vec<u8> = order.iter().flat_map(|number| number.to_be_bytes()).collect();
    let mask: Vec<u8> = order.iter().map(|number| u8::from(*number == 5)).collect();
    let y: Vec<u8> = [2f32, 4.0].iter().flat_map(|place| place.to_be_bytes()).collect();
    let id = |axis: &str| u32::from(dimensions[1] == axis);
    let length = [units.clone(), vec![double("length", 1.5)]].concat();
    let shift = [units.clone(), vec![double("add_offset", 10.0)]].concat();
    let mut variables = vec![
        ("x", vec![id("x")], length, 5, vec![0; 12]),
        ("y", vec![id("y")], units, 5, y),
        ("z", vec![0, 1], shift, 3, heights),
    ];
    if masked {
        variables.insert(2, ("mask", vec![0, 1], vec![], 1, mask));
    }
    let sizes = dimensions.map(|axis| if axis == "x" { 3 } else { 2 });
    let header = |start: usize| {
        let mut start = start;
        let dims: Vec<_> = (0..2).map(|i| [name(dimensions[i]), word(sizes[i]).to_vec()].concat()).collect();
        let mut vars = Vec::new();
        for (of, ids, attributes, kind, data) in &variables {
            let ids =
                [word(ids.len() as u32).to_vec(), ids.iter().flat_map(|id| word(*id)).collect()].concat();
            let place = if version == 2 {
                (start as u64).to_be_bytes().to_vec()
            } else {
                word(start as u32).to_vec()
            };
            let size = word(data.len() as u32).to_vec();
            vars.push([name(of), ids, list(0x0c, attributes), word(*kind).to_vec(), size, place].concat());
            start += data.len().next_multiple_of(4);
        }
        [
            b"CDF".to_vec(),
            vec![version],
            word(0).to_vec(),
            list(0x0a, &dims),
            list(0x0c, &[]),
            list(0x0b, &vars),
        ]
        .concat()
    };
    let mut file = header(header(0).len());
    for (index, (.., data)) in variables.iter().enumerate() {
        let last = index == variables.len() - 1;
        file.extend(if last { data.clone() } else { padded(data) });
    }
    file
}

// ---- hdf5
// --------------------------------------------------------------------------------------------------

#[test]
fn fields_of_results_in_metres_are_channels() {
    let (_, heights) = example();
    let scan = decode(&results(), None).unwrap();
    assert_eq!(scan.channels, ["lower", "upper", "gap"]);
    assert_eq!((scan.format, scan.channel.as_str(), scan.is_underside()), ("results", "lower", false));
    assert_eq!(scan.pitch, Some(example().0.pitch));
    assert_same(&scan.heights, &heights);
    let upper = decode(&results(), Some("upper")).unwrap();
    assert!(upper.is_underside());
    assert_same(&upper.heights, &(heights * 2.0));
    let Err(Fault::NoChannel { available }) = decode(&results(), Some("pressure")) else {
        panic!("a channel")
    };
    assert_eq!(available, ["lower", "upper", "gap"]);
    let unit = from_bytes(Path::new("a"), &results(), None, Some(1e-9)).unwrap_err();
    assert!(matches!(unit, Error::OwnUnit { .. }));
}

fn results() -> Vec<u8> {
    let (grid, heights) = example();
    let mut file = FileBuilder::new();
    for (name, value) in [("version", "0.1.0"), ("identity", "a digest")] {
        file.set_attr(name, AttrValue::VarLenString(value.into()));
    }
    let mut add = |name: &str, unit: &str, axes: &str, sizes: &[u64], numbers: &[f64]| {
        let set = file.create_dataset(name);
        set.with_f64_data(numbers).with_shape(sizes);
        set.set_attr("unit", AttrValue::VarLenString(unit.into()));
        set.set_attr("axes", AttrValue::VarLenString(axes.into()));
        set.set_attr("pitch", AttrValue::F64Array(grid.pitch.to_vec()));
    };
    let double = &heights * 2.0;
    let fields = [
        ("gap", "m", &heights),
        ("pressure", "Pa", &heights),
        ("upper", "m", &double),
        ("lower", "m", &heights),
    ];
    for (name, unit, field) in fields {
        let sizes = grid.shape.map(|n| n as u64);
        add(name, unit, "x,y", &sizes, &field.iter().copied().collect::<Vec<_>>());
    }
    add("line", "m", "x", &[2], &[1.0, 2.0]);
    file.finish().unwrap()
}

#[test]
fn of_several_data_sets_one_is_to_be_chosen() {
    let Err(Fault::NoChannel { available }) = decode(&declared(), None) else { panic!("a choice") };
    assert_eq!(available, ["/counts", "/scan/height", "/scan/speed"]);
    let message = from_bytes(Path::new("a.h5"), &declared(), None, None).unwrap_err();
    assert_eq!(message.to_string(), "a.h5 holds several data sets: choose one");
    assert!(message.hint().unwrap().starts_with("it holds `/counts`, `/scan/height`"));
    let height = decode(&declared(), Some("/scan/height")).unwrap();
    assert_eq!((height.format, height.pitch, height.unit), ("hdf5", None, LengthUnit::Known));
    let expected = ndarray::array![[1.0, 2.0], [3.0, nan()], [5.0, 6.0]];
    for (found, expected) in height.heights.iter().zip(&(expected * 1e-9)) {
        assert!(found == expected || found.is_nan() && expected.is_nan());
    }
    let counts = from_bytes(Path::new("a"), &declared(), Some("counts"), Some(2e-9)).unwrap();
    assert_eq!(counts.channel, "/counts");
    assert_same(&counts.heights, &(ndarray::array![[1.0, 2.0, 3.0], [4.0, 5.0, 6.0]] * 2e-9));
    let Err(Fault::Corrupt { reason, .. }) = decode(&declared(), Some("/scan/speed")) else {
        panic!("a unit")
    };
    assert_eq!(reason.to_string(), "a unit is `m/s`, expected one of length");
    let mut empty = FileBuilder::new();
    empty.create_dataset("line").with_f64_data(&[1.0, 2.0]);
    assert_eq!(defect(&empty.finish().unwrap()), "hdf5: no data set of two dimensions and real numbers");
}

fn declared() -> Vec<u8> {
    let mut file = FileBuilder::new();
    file.create_dataset("counts").with_i32_data(&[1, 2, 3, 4, 5, 6]).with_shape(&[2, 3]);
    file.create_dataset("line").with_f64_data(&[1.0, 2.0]);
    let mut group = file.create_group("scan");
    let height = group.create_dataset("height");
    height.with_f32_data(&[1.0, 2.0, 3.0, f32::NAN, 5.0, 6.0]).with_shape(&[3, 2]);
    height.set_attr("units", AttrValue::String("nm".into()));
    let speed = group.create_dataset("speed");
    speed.with_f64_data(&[1.0, 2.0]).with_shape(&[1, 2]).set_attr("unit", AttrValue::String("m/s".into()));
    file.add_group(group.finish());
    file.finish().unwrap()
}

// ---- datx
// --------------------------------------------------------------------------------------------------

#[test]
fn fringes_of_a_datx_are_half_wavelengths_in_lines_along_x() {
    // Written by h5py 3, with the groups and attributes of Mx.
    let scan = read(&corpus("hdf5", "zygo"), None, None).unwrap();
    assert_eq!(scan.channels, ["/Data/Surface/{1A}"]);
    let lines = ndarray::array![[1.0, 2.0, 3.0, 4.0], [5.0, 6.0, nan(), 8.0], [9.0, 10.0, 11.0, 12.0]];
    let heights = (lines * (6e-7 * 0.5 * 1.1)).t().as_standard_layout().into_owned();
    assert_scan(&scan, "datx", Some([2e-6; 2]), &heights);
}

#[test]
fn a_datx_has_its_numbers_beside_the_heights_or_in_the_measurement_attributes() {
    let factor = |unit: &str, beside: &[(&str, f64)], among: &[(&str, f64)]| {
        let mut file = FileBuilder::new();
        let mut group = file.create_group("Measurement");
        let surface = group.create_dataset("Surface");
        surface.with_f64_data(&[1.0, 2.0, 3.0, 4.0, 1e30, 6.0]).with_shape(&[2, 3]);
        surface.set_attr("Unit", AttrValue::StringArray(vec![unit.into()]));
        surface.set_attr("No Data", AttrValue::F64Array(vec![1e30]));
        beside.iter().for_each(|(name, value)| _ = surface.set_attr(name, AttrValue::F64(*value)));
        let mut attributes = group.create_group("Attributes");
        for (name, value) in among {
            attributes.set_attr(&format!("Data Context.{name}:Value"), AttrValue::F64Array(vec![*value]));
        }
        group.add_group(attributes.finish());
        file.add_group(group.finish());
        decode(&file.finish().unwrap(), None).map(|scan| {
            assert_scan(&scan, "datx", None, &(six() * scan.heights[[0, 0]]));
            (scan.heights[[0, 0]], scan.unit)
        })
    };
    let wave = ("Wavelength", 6e-7);
    for (unit, beside, among, expected) in [
        ("Fringes", &[wave][..], &[][..], 3e-7),
        ("Fringes", &[wave, ("Interferometric Scale Factor", 1.0), ("Obliquity Factor", 1.5)], &[], 9e-7),
        ("Fringes", &[], &[wave, ("Data Attributes.Interf Scale Factor", 1.0), ("Obliquity", 2.0)], 1.2e-6),
        ("Waves", &[wave], &[], 6e-7),
        ("NanoMeters", &[wave], &[], 1e-9),
        ("MicroInches", &[], &[], 25.4e-9),
    ] {
        let (found, kind) = factor(unit, beside, among).unwrap();
        assert_relative_eq!(found, expected, max_relative = 1e-12);
        assert_eq!(kind, LengthUnit::Known);
    }
    for (unit, told) in
        [("Fringes", "no Wavelength of its fringes"), ("NoUnits", "`NoUnits`, expected Fringes")]
    {
        let Err(Fault::Corrupt { reason, .. }) = factor(unit, &[], &[]) else { panic!("{unit}") };
        assert!(reason.to_string().contains(told), "{reason}");
    }
}

// ---- text in UTF-16
// ----------------------------------------------------------------------------------------

#[test]
fn text_in_utf_16_is_read_as_any() {
    for big in [false, true] {
        let matrix = decode(&utf16("# µm\r\n1,5;2;3\r\n4;;6\r\n", big), None).unwrap();
        assert_same(&matrix.heights, &ndarray::array![[1.5, 4.0], [2.0, nan()], [3.0, 6.0]]);
        let csv =
            decode(&utf16("x [µm],y [µm],height (nm)\n0,0,1\n0,1,2\n1,0,3\n1,1,4\n", big), None).unwrap();
        assert_eq!((csv.format, csv.pitch), ("csv", Some([1e-6, 1e-6])));
        let headed = utf16("# Channel: Z\n# Width: 2 µm\n# Height: 1 µm\n# Value units: nm\n1 2\n", big);
        assert_eq!(decode(&headed, None).unwrap().format, "gwyddion text");
    }
    assert_eq!(defect(b"\xff\xfe\x00\xd8"), "text: line 1: `\u{fffd}` is not a height");
    assert_eq!(defect(b"\xff\xfe"), "text: no values");
}

fn utf16(text: &str, big: bool) -> Vec<u8> {
    let units = std::iter::once(0xfeff).chain(text.encode_utf16());
    units.flat_map(|unit| if big { unit.to_be_bytes() } else { unit.to_le_bytes() }).collect()
}
