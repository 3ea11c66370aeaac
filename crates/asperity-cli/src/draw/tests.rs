//! Each kind of figure, drawn from made-up data, read back, and looked at in places.

use std::path::{Path, PathBuf};

use asperity::grid::{Field, Grid};
use ndarray::Array2;

use super::axis::Scale;
use super::*;

/// Where figures go: a folder that is removed, or `ASPERITY_FIGURES` for eyes.
struct Folder {
    path: PathBuf,
    _removed_at_the_end: Option<tempfile::TempDir>,
}

impl Folder {
    fn new() -> Self {
        match std::env::var_os("ASPERITY_FIGURES") {
            Some(path) => Self { path: path.into(), _removed_at_the_end: None },
            None => {
                let folder = tempfile::tempdir().unwrap();
                Self { path: folder.path().to_owned(), _removed_at_the_end: Some(folder) }
            }
        }
    }

    fn file(&self, name: &str) -> PathBuf {
        self.path.join(name)
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

    /// Left, top, right and bottom of the pixels of the colour that lie left of `end`.
    fn bounds(&self, colour: [u8; 3], end: usize) -> [usize; 4] {
        let pixels = (0..self.size[1]).flat_map(|y| (0..end).map(move |x| (x, y)));
        let of_colour = pixels.filter(|&(x, y)| self.at(x, y) == colour);
        of_colour.fold([usize::MAX, usize::MAX, 0, 0], |b, (x, y)| {
            [b[0].min(x), b[1].min(y), b[2].max(x + 1), b[3].max(y + 1)]
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

const GREY: [u8; 3] = [218, 218, 218];

fn viridis(t: f64) -> [u8; 3] {
    colorous::VIRIDIS.eval_continuous(t).into_array()
}

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
    let path = folder.file("two-cells.png");
    let g = grid(20, 10, 1e-6);
    let mut field = g.zeros();
    field[[0, 0]] = 1e9;
    field[[15, 7]] = 2e9;
    map(&path, &pressures("two cells", &field, &g)).unwrap();
    let picture = Picture::read(&path);
    assert!(picture.has_a_white_edge());
    let bar = picture.size[0] - 100;
    let side = 27;
    let [left, top, right, bottom] = picture.bounds(viridis(0.5), bar);
    assert_eq!([right - left, bottom - top], [side; 2]);
    let other = picture.bounds(viridis(1.0), bar);
    assert_eq!(other, [left + 15 * side, top - 7 * side, right + 15 * side, bottom - 7 * side]);
    assert_eq!(picture.at(left + 5 * side, top), [255; 3], "no pressure is white");
    assert_eq!(picture.at(left - 1, bottom), [38; 3], "a frame");
}

#[test]
fn the_colour_bar_begins_and_ends_with_the_range() {
    let folder = Folder::new();
    let path = folder.file("bar.png");
    let g = grid(20, 20, 1e-6);
    let field = g.zeros();
    map(&path, &MapFigure { range: Some([0.0, 3e9]), ..pressures("bar", &field, &g) }).unwrap();
    let picture = Picture::read(&path);
    let end = picture.size[0];
    let (low, high) = (viridis(0.5 / 540.0), viridis(1.0 - 0.5 / 540.0));
    let [low, high] = [low, high].map(|colour| picture.bounds(colour, end));
    assert_eq!((low[0], low[2]), (high[0], high[2]));
    assert_eq!(low[3] - high[1], 540, "as high as the map");
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
    // 2 × 2 px per cell, and the box of the legend.
    let area = |of: &dyn Fn(f64) -> bool| 4 * p.iter().filter(|p| of(**p)).count() + 11 * 11;
    assert_eq!(picture.count([213, 94, 0]), area(&|p| p == 2.4e9));
    assert_eq!(picture.count([0, 114, 178]), area(&|p| p > 0.0 && p < 2.4e9));
}

#[test]
fn narrow_and_tall_domains() {
    let folder = Folder::new();
    let shapes = [[384, 128], [256, 64], [1024, 64], [64, 192], [20, 180], [1, 40], [40, 1], [1, 1]];
    for [nx, ny] in shapes {
        let g = grid(nx, ny, 0.25e-6);
        let path = folder.file(&format!("domain-{nx}-{ny}.png"));
        let p = spots(nx, ny, 0.3, 3e9);
        let contact =
            MapFigure { colours: Colours::Contact { hardness: 3e9 }, ..pressures("contact", &p, &g) };
        let title = format!("a domain of {nx} × {ny} cells");
        maps(&path, &[pressures(&title, &p, &g), contact], 1).unwrap();
        assert!(Picture::read(&path).has_a_white_edge(), "{nx} × {ny}");
    }
}

#[test]
fn maps_with_one_range_share_a_colour_bar() {
    let folder = Folder::new();
    let g = grid(192, 128, 1e-6);
    let fields: Vec<_> = (0..6).map(|i| spots(192, 128, 0.2 * f64::from(i), 4e9)).collect();
    let titled = |(i, f)| pressures(&format!("position {}", 16 * i), f, &g);
    let own: Vec<_> = fields.iter().enumerate().map(titled).collect();
    let shared: Vec<_> = own.iter().map(|f| MapFigure { range: Some([0.0, 4e9]), ..f.clone() }).collect();
    maps(&folder.file("own.png"), &own, 3).unwrap();
    maps(&folder.file("shared.png"), &shared, 3).unwrap();
    let [own, shared] = ["own.png", "shared.png"].map(|name| Picture::read(&folder.file(name)));
    assert!(own.size[0] > shared.size[0] + 100);
    assert!(own.has_a_white_edge() && shared.has_a_white_edge());

    let other = grid(256, 128, 1e-6);
    let (a, b) = (bumps(192, 128, 0.0) * 0.2e-6, bumps(256, 128, 2.0) * 3e-6);
    let two = [heights("lower body", &a, &g), heights("upper body", &b, &other)];
    maps(&folder.file("two.png"), &two, 2).unwrap();
}

#[test]
fn a_large_field_is_averaged() {
    let folder = Folder::new();
    let g = grid(1024, 1024, 0.1e-6);
    map(&folder.file("large.png"), &pressures("1024 × 1024", &spots(1024, 1024, 0.3, 3e9), &g)).unwrap();
    let path = folder.file("checkers.png");
    let field = Field::from_shape_fn([1024, 1024], |(i, j)| if (i + j) % 2 == 0 { 1.0 } else { -1.0 });
    map(&path, &heights("checkers", &field, &g)).unwrap();
    let middle = colorous::CIVIDIS.eval_continuous(0.5).into_array();
    assert!(Picture::read(&path).count(middle) >= 512 * 512);
}

#[test]
fn odd_fields_are_drawn() {
    let folder = Folder::new();
    let g = grid(8, 8, 1e-6);
    let path = folder.file("odd.png");
    let undefined = Field::from_elem([8, 8], f64::NAN);
    let constant = Field::from_elem([8, 8], 3e-7);
    let mut holed = bumps(8, 8, 0.0) * 1e-6;
    holed[[2, 3]] = f64::NAN;
    holed[[3, 3]] = f64::INFINITY;
    let none = g.zeros();
    let figures = [
        heights("undefined", &undefined, &g),
        heights("constant", &constant, &g),
        heights("holes", &holed, &g),
        pressures("no pressure", &none, &g),
    ];
    maps(&path, &figures, 2).unwrap();
    // 53 px per cell; a few pixels at the edges of letters are of the same grey.
    assert_eq!(Picture::read(&path).count(GREY) / (53 * 53), 64 + 2);
}

#[test]
fn the_same_figure_gives_the_same_bytes() {
    let folder = Folder::new();
    let g = grid(64, 64, 1e-6);
    let field = bumps(64, 64, 0.0);
    let draw = |name: &str| {
        map(&folder.file(name), &heights("once more", &field, &g)).unwrap();
        std::fs::read(folder.file(name)).unwrap()
    };
    assert!(draw("first.png") == draw("second.png"));
}

#[test]
fn the_first_row_of_a_matrix_is_at_the_top() {
    let folder = Folder::new();
    let path = folder.file("matrix.png");
    let n = 96;
    let near = |i: usize, j: usize| 1e-12 / (0.5 + (i as f64 - j as f64).abs());
    let mut m = Array2::from_shape_fn([n, n], |(i, j)| near(i, j));
    m[[0, n - 1]] = 1e-10;
    m[[n - 1, 0]] = 0.0;
    let figure = MatrixFigure {
        title: "influence coefficients".to_owned(),
        matrix: &m,
        quantity: Quantity::new("displacement per pressure", Unit::Of("m/Pa")),
        nodes: ["displaced cell".to_owned(), "pressed cell".to_owned()],
    };
    matrix(&path, &figure).unwrap();
    let picture = Picture::read(&path);
    let [left, top, right, bottom] = picture.bounds(viridis(1.0), picture.size[0] - 110);
    assert_eq!([right - left, bottom - top], [6, 6]);
    let first = [right - 6 * n, top];
    assert_eq!(picture.at(first[0] - 1, first[1] - 1), [38; 3], "the corner of the frame");
    assert_eq!(picture.at(first[0] + 3, first[1] + 6 * n - 3), [255; 3], "zero is white");
    assert!(picture.has_a_white_edge());
}

#[test]
fn a_section_has_the_surface_at_the_top_and_a_cross_at_its_mark() {
    let folder = Folder::new();
    let path = folder.file("section.png");
    let mut field = Field::zeros([20, 10]);
    field[[15, 2]] = 2e9;
    let figure = SectionFigure {
        title: "section".to_owned(),
        field: &field,
        ends: [[1e-6, 21e-6], [0.0, 10e-6]],
        quantity: Quantity::new("von Mises stress", Unit::Pressure),
        mark: None,
    };
    section(&path, &figure).unwrap();
    let picture = Picture::read(&path);
    assert!(picture.has_a_white_edge());
    let [left, top, right, bottom] = picture.bounds(viridis(1.0), picture.size[0] - 100);
    let side = 27;
    assert_eq!([right - left, bottom - top], [side; 2]);
    // Two cells below the frame; a map would have it seven cells below.
    assert_eq!(picture.at(left, top - 2 * side - 1), [38; 3]);

    section(&path, &SectionFigure { mark: Some([16.5e-6, 2.5e-6]), ..figure }).unwrap();
    let marked = Picture::read(&path);
    assert_eq!(marked.at(left + side / 2, top + side / 2), [38; 3]);
}

#[test]
fn load_and_area_have_an_axis_each() {
    let folder = Folder::new();
    let path = folder.file("load.png");
    let along = |f: &dyn Fn(f64) -> f64| (0..96).map(|i| [f64::from(i), f(f64::from(i))]).collect::<Vec<_>>();
    let area = along(&|i| 3e-10 + 1e-10 * (i / 9.0).cos());
    let mut figure = LineFigure {
        title: "pass 5".to_owned(),
        x: Axis::linear("position", Unit::Number),
        y: Axis::linear("load", Unit::Force),
        right: Some(Axis::linear("contact area", Unit::Area)),
        series: vec![
            Series::new("load", along(&|i| 2.0 + 0.4 * (i / 7.0).sin()), Mark::Line),
            Series::new("contact area", area, Mark::Line).on_the_right(),
            Series::new("mean load", vec![[0.0, 2.0], [95.0, 2.0]], Mark::Dashed),
        ],
    };
    lines(&path, &figure).unwrap();
    let picture = Picture::read(&path);
    assert_eq!(picture.size, [760, 460]);
    assert!(picture.has_a_white_edge());
    assert!(picture.count([213, 94, 0]) > 300, "the area is drawn");
    figure.right = None;
    let error = lines(&path, &figure).unwrap_err().to_string();
    assert!(error.contains("load.png") && error.contains("no axis"), "{error}");
}

#[test]
fn points_in_geometric_progression_are_evenly_spaced_on_logarithmic_axes() {
    let folder = Folder::new();
    let middle = |name: &str, axis: &dyn Fn() -> Axis| {
        let series = |points: &[[f64; 2]]| Series::new("", points.to_vec(), Mark::LineAndPoints);
        let figure = LineFigure {
            title: String::new(),
            x: axis(),
            y: axis(),
            right: None,
            series: vec![
                series(&[[10.0, 10.0]]),
                series(&[]),
                series(&[]),
                // A break between the two: no line.
                series(&[[1.0, 1.0], [f64::NAN; 2], [100.0, 100.0]]),
            ],
        };
        lines(&folder.file(name), &figure).unwrap();
        let picture = Picture::read(&folder.file(name));
        // Below the legend.
        let below = Picture { size: [760, 420], rgb: picture.rgb[3 * 40 * 760..].to_vec() };
        let centre = |b: [usize; 4]| [(b[0] + b[2]) as f64 / 2.0, (b[1] + b[3]) as f64 / 2.0];
        let (one, ends) = (below.bounds([0, 114, 178], 760), below.bounds([204, 121, 167], 760));
        [0, 1].map(|i| (centre(one)[i] - ends[i] as f64) / (ends[i + 2] - ends[i]) as f64)
    };
    let [x, y] = middle("log.png", &|| Axis::log("n", Unit::Number));
    assert!((x - 0.5).abs() < 0.01 && (y - 0.5).abs() < 0.01, "{x} {y}");
    let [x, y] = middle("linear.png", &|| Axis::linear("n", Unit::Number));
    assert!((x - 0.1).abs() < 0.02 && (y - 0.9).abs() < 0.02, "{x} {y}");
}

#[test]
fn roughness_over_passes_and_times_over_sizes() {
    let folder = Folder::new();
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
    for name in ["roughness.png", "times.png"] {
        assert!(Picture::read(&folder.file(name)).has_a_white_edge(), "{name}");
    }
}

#[test]
fn odd_series_are_drawn() {
    let folder = Folder::new();
    let odd: [&[[f64; 2]]; 7] = [
        &[],
        &[[1.0, 2.0]],
        &[[0.0, 0.0], [0.0, 0.0]],
        &[[f64::NAN, 1.0], [1.0, f64::INFINITY]],
        &[[1.0, 1e-14], [2.0, 2e-14], [3.0, f64::NAN], [4.0, 1e-14]],
        &[[-1.0, -1e9], [1.0, 1e9]],
        &[[0.0, 2.0], [1.0, 2.0 + 1e-12]],
    ];
    for (i, points) in odd.into_iter().enumerate() {
        for log in [false, true] {
            let axis = |label: &str| Axis { log, ..Axis::linear(label, Unit::Number) };
            let path = folder.file(&format!("odd-{i}-{log}.png"));
            let series = vec![Series::new("odd", points.to_vec(), Mark::LineAndPoints)];
            let figure =
                LineFigure { title: "odd".to_owned(), x: axis("x"), y: axis("y"), right: None, series };
            lines(&path, &figure).unwrap();
            assert!(Picture::read(&path).has_a_white_edge(), "{i} {log}");
        }
    }
}

#[test]
fn an_overlap_moves_through_the_common_frame() {
    let folder = Folder::new();
    let path = folder.file("pass.gif");
    let g = grid(128, 64, 1e-6);
    let p = spots(256, 64, 0.4, 3e9);
    let frames = (0..24usize).map(|step| {
        let offset = (4 * step).saturating_sub(48);
        let columns = (32 + 4 * step).min(128) - offset;
        let field = Field::from_shape_fn([128, 64], |(i, j)| {
            if (offset..offset + columns).contains(&i) { p[[i + 100 - 4 * step, j]] } else { f64::NAN }
        });
        (format!("position {} of 24", step + 1), field)
    });
    let frames: Vec<_> = frames.collect();
    let frames = frames.iter().map(|(title, field)| Frame { title: title.clone(), field });
    let (quantity, colours) = (pressure(), Colours::Pressure);
    let figure = Animation { grid: &g, quantity, colours, range: [0.0, 3e9], delay: 10 };
    animation(&path, &figure, frames).unwrap();

    let mut decoder = gif::Decoder::new(std::fs::File::open(&path).unwrap()).unwrap();
    let [width, height] = [decoder.width(), decoder.height()].map(usize::from);
    let palette = decoder.global_palette().unwrap().to_vec();
    let mut sheet = vec![[0; 3]; width * height];
    let mut greys = Vec::new();
    while let Some(frame) = decoder.read_next_frame().unwrap() {
        assert_eq!(frame.delay, 10);
        assert!(frame.palette.is_none());
        for (i, &index) in
            frame.buffer.iter().enumerate().filter(|(_, index)| Some(**index) != frame.transparent)
        {
            let (x, y) = (i % usize::from(frame.width), i / usize::from(frame.width));
            let colour = palette[3 * usize::from(index)..][..3].try_into().unwrap();
            sheet[(y + usize::from(frame.top)) * width + x + usize::from(frame.left)] = colour;
        }
        // The map without the labels around it.
        let map = (40..232).flat_map(|y| sheet[y * width + 60..y * width + 450].iter());
        greys.push(map.filter(|colour| **colour == GREY).count());
    }
    // 3 × 3 px per cell; the last overlap has columns 44 to 124.
    assert_eq!(greys.len(), 24);
    assert_eq!((greys[0], greys[23]), (9 * 64 * (128 - 32), 9 * 64 * (128 - 80)));
    assert_eq!(decoder.repeat(), gif::Repeat::Infinite);

    let too_wide = Frame { title: String::new(), field: &p };
    let error = animation(&path, &figure, [too_wide]).unwrap_err().to_string();
    assert!(error.contains("[256, 64]") && error.contains("[128, 64]"), "{error}");
}

#[test]
fn errors_name_the_file() {
    let g = grid(8, 8, 1e-6);
    let field = Field::zeros([8, 9]);
    let error = map(Path::new("x.png"), &heights("", &field, &g)).unwrap_err().to_string();
    assert_eq!(error, "cannot draw `x.png`: a field of shape [8, 9] on a grid of shape [8, 8]");
    let nowhere = Path::new("/no/such/folder/x.png");
    let error = map(nowhere, &heights("", &g.zeros(), &g)).unwrap_err().to_string();
    assert!(error.starts_with("cannot draw `/no/such/folder/x.png`: "), "{error}");
}

#[test]
fn a_unit_suits_the_largest_number() {
    let shown = |unit: Unit, v: f64| unit.shown(v).1;
    assert_eq!(shown(Unit::Length, 0.3e-6), "nm");
    assert_eq!(shown(Unit::Length, 128e-6), "µm");
    assert_eq!(shown(Unit::Pressure, 2.4e9), "GPa");
    assert_eq!(shown(Unit::Pressure, 950e6), "MPa");
    assert_eq!(shown(Unit::Area, 4e-10), "µm²");
    assert_eq!(shown(Unit::Area, 4e-8), "mm²");
    assert_eq!(shown(Unit::Force, 2.0), "N");
    assert_eq!(shown(Unit::Volume, 3e-17), "µm³");
    assert_eq!(shown(Unit::Number, 512.0), "");
    assert_eq!(shown(Unit::Number, 2.5e6), "10⁶");
    assert_eq!(shown(Unit::Of("m/Pa"), 3e-14), "10⁻¹⁴ m/Pa");
    assert_eq!(shown(Unit::Length, 0.0), "m");
}

#[test]
fn ticks_stand_at_round_numbers() {
    let labels = |scale: Scale| scale.ticks.into_iter().map(|tick| tick.1).collect::<Vec<_>>();
    let linear = |range, most| labels(Scale::linear(range, 1.0, Unit::Number, most));
    assert_eq!(linear([0.0, 1.0], 5), ["0.0", "0.2", "0.4", "0.6", "0.8", "1.0"]);
    assert_eq!(linear([-0.3, 0.31], 7), ["−0.3", "−0.2", "−0.1", "0.0", "0.1", "0.2", "0.3"]);
    assert_eq!(linear([0.0, 128.0], 8), ["0", "20", "40", "60", "80", "100", "120"]);
    let log = |range, most| labels(Scale::logarithmic(range, Unit::Number, most));
    assert_eq!(log([1e-8, 1e-5], 7), ["10⁻⁸", "10⁻⁷", "10⁻⁶", "10⁻⁵"]);
    assert_eq!(log([15.0, 1100.0], 8), ["20", "50", "100", "200", "500", "1000"]);
    assert_eq!(log([2e-13, 3e-13], 5), ["2×10⁻¹³", "3×10⁻¹³"]);
}
