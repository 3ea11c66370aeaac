//! Each kind of figure, drawn from made-up data, read back, and looked at in places.

use std::borrow::Cow;
use std::path::{Path, PathBuf};

use asperity::grid::{Field, Grid};
use ndarray::Array2;

use super::*;

/// Where figures go: a folder that is removed, or `ASPERITY_FIGURES` for eyes.
struct Folder(Option<tempfile::TempDir>, PathBuf);

impl Folder {
    fn new() -> Self {
        match std::env::var_os("ASPERITY_FIGURES") {
            Some(path) => Self(None, path.into()),
            None => {
                let folder = tempfile::tempdir().unwrap();
                let path = folder.path().to_owned();
                Self(Some(folder), path)
            }
        }
    }

    fn file(&self, name: &str) -> PathBuf {
        self.1.join(name)
    }
}

struct Picture {
    size: [usize; 2],
    rgb: Vec<u8>,
}

impl Picture {
    fn read(path: &Path) -> Self {
        let file = std::io::BufReader::new(std::fs::File::open(path).unwrap());
        let mut reader = png::Decoder::new(file).read_info().unwrap();
        let mut rgb = vec![0; reader.output_buffer_size().unwrap()];
        let info = reader.next_frame(&mut rgb).unwrap();
        assert_eq!((info.color_type, info.bit_depth), (png::ColorType::Rgb, png::BitDepth::Eight));
        Self { size: [info.width as usize, info.height as usize], rgb }
    }

    fn at(&self, x: usize, y: usize) -> [u8; 3] {
        let i = 3 * (y * self.size[0] + x);
        [self.rgb[i], self.rgb[i + 1], self.rgb[i + 2]]
    }

    /// How many pixels have the colour.
    fn count(&self, colour: [u8; 3]) -> usize {
        self.rgb.chunks_exact(3).filter(|p| *p == colour).count()
    }

    /// Left, top, right and bottom of the pixels of the colour.
    fn bounds(&self, colour: [u8; 3]) -> [usize; 4] {
        let pixels = (0..self.size[1]).flat_map(|y| (0..self.size[0]).map(move |x| (x, y)));
        let of_colour = pixels.filter(|&(x, y)| self.at(x, y) == colour);
        of_colour.fold([usize::MAX, usize::MAX, 0, 0], |b, (x, y)| {
            [b[0].min(x), b[1].min(y), b[2].max(x), b[3].max(y)]
        })
    }

    /// Text is dark; none of it may touch the edge of the sheet.
    fn has_a_white_edge(&self) -> bool {
        let [w, h] = self.size;
        let top_and_bottom = (0..w).flat_map(|x| [(x, 0), (x, 1), (x, h - 2), (x, h - 1)]);
        let sides = (0..h).flat_map(|y| [(0, y), (1, y), (w - 2, y), (w - 1, y)]);
        top_and_bottom.chain(sides).all(|(x, y)| self.at(x, y) == [255; 3])
    }
}

const VIRIDIS_TOP: [u8; 3] = [253, 231, 37];
const GREY: [u8; 3] = [218, 218, 218];

fn grid(nx: usize, ny: usize, pitch: f64) -> Grid {
    Grid::new([nx, ny], [pitch, pitch]).unwrap()
}

/// A bumpy field of zero mean and about unit height.
fn bumps(nx: usize, ny: usize, phase: f64) -> Field {
    let waves: Vec<[f64; 4]> = (0..40)
        .map(|i| {
            let i = f64::from(i);
            let angle = (i * 2.399_963 + phase).rem_euclid(std::f64::consts::TAU);
            let k = 0.03 + 0.004 * i;
            [k * angle.cos(), k * angle.sin(), i * i + phase, 1.0 / (1.0 + 0.1 * i)]
        })
        .collect();
    Field::from_shape_fn([nx, ny], |(x, y)| {
        waves.iter().map(|w| w[3] * (w[0] * x as f64 + w[1] * y as f64 + w[2]).sin()).sum::<f64>() / 3.5
    })
}

/// Sparse spots of pressure, capped.
fn spots(nx: usize, ny: usize, phase: f64, hardness: f64) -> Field {
    bumps(nx, ny, phase).mapv(|h| (3e9 * (h - 0.55).max(0.0).sqrt()).min(hardness))
}

fn pressure() -> Quantity {
    Quantity::new("pressure", Unit::Pressure)
}

fn height() -> Quantity {
    Quantity::new("height", Unit::Length)
}

fn heights<'a>(title: &str, field: &'a Field, grid: &'a Grid) -> MapFigure<'a> {
    let title = title.to_owned();
    MapFigure { title, field, grid, quantity: height(), colours: Colours::Heights, range: None }
}

fn pressures<'a>(title: &str, field: &'a Field, grid: &'a Grid) -> MapFigure<'a> {
    MapFigure { quantity: pressure(), colours: Colours::Pressure, ..heights(title, field, grid) }
}

#[test]
fn a_cell_has_its_colour_at_its_place() {
    let folder = Folder::new();
    let path = folder.file("one-cell.png");
    let g = grid(20, 10, 1e-6);
    let mut field = g.zeros();
    field[[15, 7]] = 2e9;
    map(&path, &pressures("one cell", &field, &g)).unwrap();
    let picture = Picture::read(&path);
    // 27 px per cell: cell 15 from the left, cell 7 from below.
    let top = picture.at(picture.size[0] / 2, 45);
    assert_eq!(top, [255; 3], "no pressure is white");
    let cell = 27 * 27;
    let bar = 16 * picture.bounds(VIRIDIS_TOP)[3];
    assert!((cell..cell + bar).contains(&picture.count(VIRIDIS_TOP)));
    let [left, top] = [(0..), (0..)].map(|_: std::ops::RangeFrom<usize>| 0);
    let _ = (left, top);
    assert!(picture.has_a_white_edge());
}

#[test]
fn a_rough_topography_and_its_contact() {
    let folder = Folder::new();
    let g = grid(256, 256, 0.5e-6);
    map(&folder.file("heights.png"), &heights("lower body", &(bumps(256, 256, 0.0) * 0.3e-6), &g)).unwrap();
    let p = spots(256, 256, 1.0, 2.4e9);
    map(&folder.file("pressure.png"), &pressures("pressure at pass 3, position 17", &p, &g)).unwrap();
    let contact = MapFigure { colours: Colours::Contact { hardness: 2.4e9 }, ..pressures("contact", &p, &g) };
    map(&folder.file("contact.png"), &contact).unwrap();
    let picture = Picture::read(&folder.file("contact.png"));
    assert!(picture.count([0, 114, 178]) > 1000);
    assert!(picture.count([213, 94, 0]) > 1000);
}

#[test]
fn narrow_and_tall_domains() {
    let folder = Folder::new();
    for (name, nx, ny) in [
        ("wide-3", 384, 128),
        ("wide-4", 256, 64),
        ("wide-16", 1024, 64),
        ("tall-3", 64, 192),
        ("tall-9", 20, 180),
    ] {
        let g = grid(nx, ny, 0.25e-6);
        let path = folder.file(&format!("{name}.png"));
        map(&path, &pressures(&format!("a domain of {nx} × {ny} cells"), &spots(nx, ny, 0.3, 3e9), &g))
            .unwrap();
        assert!(Picture::read(&path).has_a_white_edge(), "{name}");
    }
}

#[test]
fn several_maps() {
    let folder = Folder::new();
    let g = grid(192, 128, 1e-6);
    let fields: Vec<_> = (0..6).map(|i| spots(192, 128, 0.2 * f64::from(i), 4e9)).collect();
    let figures: Vec<_> = fields
        .iter()
        .enumerate()
        .map(|(i, f)| MapFigure {
            range: Some([0.0, 4e9]),
            ..pressures(&format!("position {}", 16 * i), f, &g)
        })
        .collect();
    maps(&folder.file("six.png"), &figures, 3).unwrap();
    let other = grid(256, 128, 1e-6);
    let (a, b) = (bumps(192, 128, 0.0) * 0.2e-6, bumps(256, 128, 2.0) * 3e-6);
    maps(&folder.file("two.png"), &[heights("lower body", &a, &g), heights("upper body", &b, &other)], 2)
        .unwrap();
}

#[test]
fn a_large_field_is_averaged() {
    let folder = Folder::new();
    let path = folder.file("large.png");
    let g = grid(1024, 1024, 0.1e-6);
    map(&path, &pressures("1024 × 1024", &spots(1024, 1024, 0.3, 3e9), &g)).unwrap();
    let field = Field::from_shape_fn([1024, 1024], |(i, j)| if (i + j) % 2 == 0 { 1.0 } else { -1.0 });
    map(&folder.file("checkers.png"), &heights("checkers", &field, &g)).unwrap();
}

#[test]
fn odd_fields_are_drawn() {
    let folder = Folder::new();
    let g = grid(8, 8, 1e-6);
    let path = folder.file("odd.png");
    let all_nan = Field::from_elem([8, 8], f64::NAN);
    let constant = Field::from_elem([8, 8], 3e-7);
    let mut holed = bumps(8, 8, 0.0);
    holed[[2, 3]] = f64::NAN;
    holed[[3, 3]] = f64::INFINITY;
    let none = g.zeros();
    let figures = [
        heights("undefined", &all_nan, &g),
        heights("constant", &constant, &g),
        heights("holes", &holed, &g),
        pressures("no pressure", &none, &g),
    ];
    maps(&path, &figures, 2).unwrap();
    let _ = GREY;
}

#[test]
fn an_influence_matrix() {
    let folder = Folder::new();
    let n = 96;
    let m =
        Array2::from_shape_fn([n, n], |(i, j)| 1e-12 / (0.5 + (i as f64 - j as f64).abs() + 0.05 * j as f64));
    let figure = MatrixFigure {
        title: "influence coefficients".to_owned(),
        matrix: &m,
        quantity: Quantity::new("displacement per pressure", Unit::Of("m/Pa")),
        nodes: ["displaced cell".to_owned(), "pressed cell".to_owned()],
    };
    matrix(&folder.file("matrix.png"), &figure).unwrap();
}

#[test]
fn curves() {
    let folder = Folder::new();
    let along = |f: &dyn Fn(f64) -> f64| (0..96).map(|i| [f64::from(i), f(f64::from(i))]).collect::<Vec<_>>();
    let figure = LineFigure {
        title: "pass 5".to_owned(),
        x: Axis::linear("position", Unit::Number),
        y: Axis::linear("load", Unit::Force),
        right: Some(Axis::linear("contact area", Unit::Area)),
        series: vec![
            Series::new("load", along(&|i| 2.0 + 0.4 * (i / 7.0).sin()), Mark::Line),
            Series::new("contact area", along(&|i| 3e-10 + 1e-10 * (i / 9.0).cos()), Mark::Line)
                .on_the_right(),
            Series::new("mean load", vec![[0.0, 2.0], [95.0, 2.0]], Mark::Dashed),
        ],
    };
    lines(&folder.file("load.png"), &figure).unwrap();
    let passes =
        |a: f64, b: f64| (0..=10).map(|i| [f64::from(i), a + b * (-f64::from(i)).exp()]).collect::<Vec<_>>();
    let figure = LineFigure {
        title: "running in".to_owned(),
        x: Axis::linear("pass", Unit::Number),
        y: Axis::linear("Sq", Unit::Length),
        right: None,
        series: vec![
            Series::new("lower body", passes(0.21e-6, 0.05e-6), Mark::LineAndPoints),
            Series::new("upper body", passes(0.32e-6, 0.01e-6), Mark::LineAndPoints),
            Series::new("composite", passes(0.38e-6, 0.04e-6), Mark::LineAndPoints),
        ],
    };
    lines(&folder.file("roughness.png"), &figure).unwrap();
    let power =
        |a: f64, n: f64| (4..11).map(|k| [2f64.powi(k), a * 2f64.powi(k).powf(n)]).collect::<Vec<_>>();
    let figure = LineFigure {
        title: "time of one solution".to_owned(),
        x: Axis::log("cells along x", Unit::Number),
        y: Axis::log("time", Unit::Time),
        right: None,
        series: vec![
            Series::new("direct", power(2e-9, 4.0), Mark::LineAndPoints),
            Series::new("Polonsky–Keer", power(5e-7, 2.1), Mark::LineAndPoints),
            Series::new("∝ n²", power(1e-7, 2.0), Mark::Dashed),
        ],
    };
    lines(&folder.file("times.png"), &figure).unwrap();
    assert_eq!(Picture::read(&folder.file("times.png")).size, [760, 460]);
}

#[test]
fn an_animation() {
    let folder = Folder::new();
    let g = grid(128, 64, 1e-6);
    let p = spots(256, 64, 0.4, 3e9);
    let frames = (0..24).map(|step| {
        let offset = (4 * step as usize).saturating_sub(48);
        let columns = (32 + 4 * step as usize).min(128) - offset;
        let field = Field::from_shape_fn([columns, 64], |(i, j)| p[[i + 100 - 4 * step, j]]);
        Frame { title: format!("position {} of 24", step + 1), field: Cow::Owned(field), offset }
    });
    let figure = Animation {
        grid: &g,
        quantity: pressure(),
        colours: Colours::Pressure,
        range: [0.0, 3e9],
        delay: 10,
    };
    animation(&folder.file("pass.gif"), &figure, frames).unwrap();
}
