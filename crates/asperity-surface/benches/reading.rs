//! Reading of topographies of 2048 × 2048 heights from memory; bytes are those of the file.

use std::sync::LazyLock;

use asperity_base::{Field, Grid};
use asperity_surface::{Amplitude, ReadOptions, SelfAffine, Topography};
use divan::counter::BytesCount;
use tiff::encoder::{Compression, DeflateLevel, TiffEncoder, colortype};

#[path = "../src/formats/tests/files.rs"]
mod files;

const SIDE: u32 = 2048;

fn main() {
    divan::main();
}

#[divan::bench(args = [
    "al3d", "bcr i16", "bcr f32", "frt u16", "frt i32", "gwy", "metropro", "npy f4", "npy f8", "npy f8 fortran",
    "opd i16", "opd f32", "plu", "sdf u8", "sdf u16", "sdf i16", "sdf i32", "sdf f32", "sdf f64", "sur i16", "sur i32",
    "tiff f32", "tmd",
], sample_count = 30)]
fn plain(bencher: divan::Bencher, kind: &str) {
    measure(bencher, &file(kind, SIDE));
}

#[divan::bench(args = ["sur i16", "tiff f32 deflate", "tiff f32 lzw", "x3p"], sample_count = 10)]
fn compressed(bencher: divan::Bencher, kind: &str) {
    measure(bencher, &file_compressed(kind));
}

#[divan::bench(args = ["sdf i16", "sdf f64"], sample_count = 10)]
fn plain_of_4096(bencher: divan::Bencher, kind: &str) {
    measure(bencher, &file(kind, 4096));
}

fn measure(bencher: divan::Bencher, file: &[u8]) {
    bencher
        .counter(BytesCount::of_slice(file))
        .bench_local(|| ReadOptions::default().scan_bytes("file", file).expect("a topography"));
}

fn file(kind: &str, side: u32) -> Vec<u8> {
    let shape = [side; 2];
    let short = [side as u16; 2];
    let u8s = || x_fastest(side, |height| [(height * 100.0) as i8 as u8]);
    let i16s = || x_fastest(side, |height| ((height * 1e4) as i16).to_le_bytes());
    let i32s = || x_fastest(side, |height| ((height * 1e6) as i32).to_le_bytes());
    let i32s_big = || x_fastest(side, |height| ((height * 1e6) as i32).to_be_bytes());
    let f32s = || x_fastest(side, |height| (height as f32).to_le_bytes());
    let f64s = || x_fastest(side, f64::to_le_bytes);
    let text_shape = format!("({side}, {side})");
    match kind {
        "al3d" => files::al3d(shape, &f32s()),
        "bcr i16" => files::bcr("bcrstm", false, shape, &i16s()),
        "bcr f32" => files::bcr("bcrf", false, shape, &f32s()),
        "frt u16" => files::frt(shape, 16, &[(0x0b, &i16s())]),
        "frt i32" => files::frt(shape, 32, &[(0x0b, &i32s())]),
        "gwy" => written("gwy"),
        "metropro" => files::metropro(short, &i32s_big()),
        "npy f4" => files::npy("'<f4'", false, &text_shape, &f32s()),
        "npy f8" => written("npy"),
        "npy f8 fortran" => files::npy("'<f8'", true, &text_shape, &f64s()),
        "opd i16" => files::opd(short, &[("Raw", 2, &i16s())]),
        "opd f32" => files::opd(short, &[("Raw", 4, &f32s())]),
        "plu" => files::plu(shape, &f32s()),
        "sdf u8" => files::sdf(0, short, &u8s()),
        "sdf u16" => files::sdf(1, short, &i16s()),
        "sdf i16" => files::sdf(5, short, &i16s()),
        "sdf i32" => files::sdf(6, short, &i32s()),
        "sdf f32" => files::sdf(3, short, &f32s()),
        "sdf f64" => files::sdf(7, short, &f64s()),
        "sur i16" => files::sur(16, "", 1, shape, &i16s()),
        "sur i32" => files::sur(32, "", 1, shape, &i32s()),
        "tiff f32" => tiff_of(Compression::Uncompressed),
        "tmd" => files::tmd(shape, &f32s()),
        _ => unreachable!("no file of the kind {kind}"),
    }
}

fn file_compressed(kind: &str) -> Vec<u8> {
    match kind {
        "sur i16" => files::sur_compressed(&file(kind, SIDE)),
        "tiff f32 deflate" => tiff_of(Compression::Deflate(DeflateLevel::Balanced)),
        "tiff f32 lzw" => tiff_of(Compression::Lzw),
        "x3p" => written("x3p"),
        _ => unreachable!("no file of the kind {kind}"),
    }
}

/// A rough surface in units of its rms, within about ±3.
static HEIGHTS: LazyLock<Field> = LazyLock::new(|| {
    let form = SelfAffine { hurst: 0.8, rolloff: Some(100.0), shortest: None, amplitude: Amplitude::Sq(0.3) };
    form.generate(&grid(), 1).expect("a surface").into_heights()
});

fn grid() -> Grid {
    Grid::new([SIDE as usize; 2], [1.0; 2]).expect("a grid")
}

/// The heights as numbers, x fastest, on as many copies of the surface as `side` requires.
fn x_fastest<const N: usize>(side: u32, number: impl Fn(f64) -> [u8; N]) -> Vec<u8> {
    let (side, of) = (side as usize, SIDE as usize);
    (0..side * side).flat_map(|cell| number(HEIGHTS[[cell % side % of, cell / side % of]])).collect()
}

fn written(format: &str) -> Vec<u8> {
    let folder = tempfile::tempdir().expect("a folder");
    let path = folder.path().join("file").with_extension(format);
    Topography::new(grid(), HEIGHTS.clone()).expect("heights").write(&path).expect("a file");
    std::fs::read(&path).expect("a file")
}

fn tiff_of(compression: Compression) -> Vec<u8> {
    let mut file = std::io::Cursor::new(Vec::new());
    let pixels: Vec<f32> = HEIGHTS.t().iter().map(|height| *height as f32).collect();
    let mut encoder = TiffEncoder::new(&mut file).expect("a file").with_compression(compression);
    encoder.write_image::<colortype::Gray32Float>(SIDE, SIDE, &pixels).expect("a file");
    file.into_inner()
}
