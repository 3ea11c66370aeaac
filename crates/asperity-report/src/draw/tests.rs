//! Each kind of figure, drawn from made-up data, read back, and looked at in places.

use std::path::Path;

use asperity_base::grid::{Field, Grid};
use ndarray::Array2;
use tempfile::TempDir;

use super::*;

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

fn pressures<'a>(title: &str, field: &'a Field, grid: &Grid) -> Map<'a> {
    Map::new(title, field, grid, Quantity::new("pressure", Unit::Pressure), Colours::Pressure)
}

fn heights<'a>(title: &str, field: &'a Field, grid: &Grid) -> Map<'a> {
    Map::new(title, field, grid, Quantity::new("height", Unit::Length), Colours::Heights)
}

/// Enough pixels to count.
const PAPER: Paper = Paper { format: Format::Png, dpi: 150.0, width: None, range: None, titled: true };

fn caption() -> Caption {
    Caption { title: "a figure".to_owned(), of: "case · load 2 N · pass 5".to_owned() }
}

/// A figure as its pixels.
fn drawn(figure: &dyn Figure) -> Picture {
    drawn_on(figure, &PAPER)
}

fn drawn_on(figure: &dyn Figure, paper: &Paper) -> Picture {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("figure.png");
    save(&path, figure, &caption(), paper).unwrap();
    Picture::read(&path)
}

/// Whether lengths agree to two pixels.
#[track_caller]
fn assert_near(found: usize, expected: f64) {
    assert!((found as f64 - expected).abs() <= 2.0, "{found}, expected {expected}");
}

// ---- maps ------------------------------------------------------------------------------------------------

#[test]
fn a_cell_has_its_colour_at_its_place() {
    let g = grid(20, 10, 1e-6);
    let mut field = g.zeros();
    field[[0, 0]] = 1e9;
    field[[15, 7]] = 2e9;
    let picture = drawn(&Maps::new(vec![pressures("two cells", &field, &g)]));
    assert!(picture.has_a_white_edge());
    let bar = picture.size[0] * 3 / 4;
    let [left, top, right, bottom] = picture.bounds(viridis(0.5), bar);
    let side = (right - left) as f64;
    assert_near(bottom - top, side);
    let other = picture.bounds(viridis(1.0), bar);
    // A side is known to a pixel.
    assert!((other[0] as f64 - left as f64 - 15.0 * side).abs() < 15.0, "{other:?}");
    assert!((other[3] as f64 - bottom as f64 + 7.0 * side).abs() < 7.0, "{other:?}");
    assert_eq!(picture.at(left + 5 * (right - left), top + 3), [255; 3], "no pressure is white");
}

#[test]
fn the_colour_bar_is_as_high_as_its_map_and_begins_and_ends_with_the_range() {
    let g = grid(20, 20, 1e-6);
    let field = Field::from_elem([20, 20], 1.5e9);
    let picture = drawn(&Maps::new(vec![pressures("bar", &field, &g).range([0.0, 3e9])]));
    let map = picture.bounds(viridis(0.5), picture.size[0] * 3 / 4);
    let [low, high] = [0.5 / 256.0, 255.5 / 256.0].map(|t| picture.bounds(viridis(t), picture.size[0]));
    assert!(low[0] > map[2] && (low[0], low[2]) == (high[0], high[2]));
    assert_near(high[1], map[1] as f64);
    assert_near(low[3], map[3] as f64);
}

#[test]
fn classes_fill_the_shares_of_their_cells_and_the_legend_names_grey() {
    let g = grid(64, 64, 0.5e-6);
    let classes = Field::from_shape_fn(g.shape, |(i, j)| match i {
        0..16 => f64::NAN,
        16..32 => 2.0,
        _ => f64::from(u8::from(j < 32)),
    });
    let contact = Map::new("", &classes, &g, Quantity::new("", Unit::Number), Colours::CONTACT);
    let picture = drawn(&Maps::new(vec![contact.missing("nothing faces it")]));
    let [plastic, elastic, grey] =
        [[213, 94, 0], [0, 114, 178], GREY].map(|colour| picture.count(colour) as f64);
    for share in [plastic / elastic, plastic / grey] {
        assert!((share - 1.0).abs() < 0.02, "{share}");
    }
}

#[test]
fn domains_of_all_shapes_are_drawn_large_enough_at_all_widths() {
    for [nx, ny] in [[384, 128], [1024, 64], [64, 192], [20, 180], [1, 40], [40, 1], [1, 1]] {
        let g = grid(nx, ny, 0.25e-6);
        let p = Field::from_elem([nx, ny], 1e9);
        for width in [None, Some(0.085), Some(0.04)] {
            let paper = Paper { width, ..PAPER };
            let title = format!("{nx} × {ny} cells");
            let maps = vec![
                pressures(&title, &p, &g).range([0.0, 2e9]),
                pressures(&title, &p, &g).range([0.0, 2e9]),
            ];
            let picture = drawn_on(&Maps::new(maps), &paper);
            assert!(picture.has_a_white_edge(), "{nx} × {ny}, {width:?}");
            let expected = width.unwrap_or(482.0 / 72.0 * 0.0254) / 0.0254 * 150.0;
            assert_near(picture.size[0], expected);
            let least = if width == Some(0.04) { 0.003 } else { 0.02 };
            assert!(
                picture.count(viridis(0.5)) as f64 > least * expected * expected,
                "{nx} × {ny}, {width:?}"
            );
        }
    }
}

#[test]
fn maps_of_one_range_share_a_bar_and_maps_of_one_column_their_edge() {
    let g = grid(192, 128, 1e-6);
    let fields: Vec<_> = (0..6).map(|i| spots(192, 128, 0.2 * f64::from(i), 4e9)).collect();
    let maps = |range: Option<[f64; 2]>| {
        let map = |field| {
            let map = pressures("position", field, &g);
            range.map_or(map.clone(), |range| map.range(range))
        };
        Maps::new(fields.iter().map(map).collect())
    };
    let bars = |maps: Maps| text_of(&maps).iter().filter(|words| words.starts_with("pressure")).count();
    assert_eq!([bars(maps(None)), bars(maps(Some([0.0, 4e9])))], [6, 1]);

    // Labels of different widths.
    let (a, b) = (Field::from_elem([30, 60], 1.0), Field::from_elem([30, 60], 1.0));
    let (near, far) = (grid(30, 60, 1e-6), grid(30, 60, 123.4e-6));
    let mut two = Maps::new(vec![pressures("", &a, &near), pressures("", &b, &far)]);
    two.columns = vec![1];
    let picture = drawn(&two);
    let half = picture.size[1] / 2;
    let left = |rows: std::ops::Range<usize>| {
        (0..picture.size[0]).find(|x| rows.clone().any(|y| picture.at(*x, y) == viridis(1.0))).unwrap()
    };
    assert_eq!(left(0..half), left(half..picture.size[1]));
}

#[test]
fn a_large_field_is_averaged() {
    let g = grid(1024, 1024, 0.1e-6);
    let field = Field::from_shape_fn([1024, 1024], |(i, j)| if (i + j) % 2 == 0 { 1.0 } else { -1.0 });
    let paper = Paper { dpi: 72.0, width: Some(0.06), ..PAPER };
    let picture = drawn_on(&Maps::new(vec![heights("checkers", &field, &g)]), &paper);
    let middle = colorous::CIVIDIS.eval_continuous(0.5).into_array();
    let near = picture.rgb.chunks_exact(3).filter(|p| (0..3).all(|c| p[c].abs_diff(middle[c]) < 30));
    assert!(near.count() > 60 * 60);
}

#[test]
fn flat_heights_have_no_bar_and_rare_ones_do_not_set_the_colours() {
    let g = grid(100, 100, 1e-6);
    let flat = Field::from_elem([100, 100], 3e-7);
    let text = |figure: &Maps| text_of(figure);
    assert!(text(&super::heights(&flat, &g)).contains(&"flat".to_owned()));
    assert!(!text(&super::heights(&flat, &g)).iter().any(|words| words.starts_with("height")));
    let mut rough = bumps(100, 100, 0.0) * 1e-6;
    assert!(!text(&super::heights(&rough, &g)).iter().any(|words| words.contains("percentiles")));
    rough[[50, 50]] = 1e-3;
    let figure = super::heights(&rough, &g);
    assert!(text(&figure).iter().any(|words| words.contains("percentiles 0.1 % and 99.9 %")));
    assert!(text(&figure).contains(&"height (µm)".to_owned()), "not in mm");
}

#[test]
fn odd_fields_are_drawn_and_nothing_is_called_none() {
    let g = grid(8, 8, 1e-6);
    let undefined = Field::from_elem([8, 8], f64::NAN);
    let constant = Field::from_elem([8, 8], 3e-7);
    let mut holed = bumps(8, 8, 0.0) * 1e-6;
    holed[[2, 3]] = f64::NAN;
    holed[[3, 3]] = f64::INFINITY;
    let none = g.zeros();
    let figure = Maps::new(vec![
        heights("undefined", &undefined, &g),
        heights("constant", &constant, &g),
        heights("holes", &holed, &g),
        pressures("no pressure", &none, &g),
    ]);
    assert!(drawn(&figure).has_a_white_edge());
    let words = text_of(&figure);
    assert!(words.contains(&"none".to_owned()) && words.contains(&"not defined".to_owned()), "{words:?}");
}

#[test]
fn the_first_row_of_a_matrix_is_at_the_top_and_its_block_is_outlined() {
    let n = 48;
    let near = |i: usize, j: usize| 1e-12 / (0.5 + (i as f64 - j as f64).abs());
    let mut m = Array2::from_shape_fn([n, n], |(i, j)| near(i, j));
    m[[0, n - 1]] = 1e-10;
    m[[n - 1, 0]] = 0.0;
    let quantity = || Quantity::new("influence", Unit::Of("m/Pa"));
    let map = Map::matrix("", &m, ["displaced cell", "pressed cell"], quantity());
    let picture = drawn(&Maps::new(vec![map.clone()]));
    let corner = picture.bounds(viridis(1.0), picture.size[0] * 5 / 6);
    let whole = picture.bounds([38; 3], picture.size[0]);
    assert!(corner[0] > picture.size[0] / 2 && corner[1] < picture.size[1] / 3, "{corner:?} in {whole:?}");
    let marked = drawn(&Maps::new(vec![map.with_block(12, "the first overlap")]));
    assert!(marked.count([213, 94, 0]) > picture.count([213, 94, 0]) + 100);
}

#[test]
fn a_section_has_the_surface_at_the_top_and_a_cross_at_its_mark() {
    let mut field = Field::zeros([20, 10]);
    field[[15, 2]] = 2e9;
    let ends = [[1e-6, 21e-6], [0.0, 10e-6]];
    let map =
        Map::section("", &field, ends, Quantity::new("von Mises stress", Unit::Pressure), Colours::Pressure);
    let picture = drawn(&Maps::new(vec![map.clone()]));
    let end = picture.size[0] * 3 / 4;
    let [left, top, right, bottom] = picture.bounds(viridis(1.0), end);
    let side = right - left;
    // Two cells below the frame; a map would have it seven cells below.
    let frame = (top - 5 * side / 2..top - 3 * side / 2).find(|y| picture.at(left + side / 2, *y) == [38; 3]);
    assert!(frame.is_some());
    let marked = drawn(&Maps::new(vec![map.marked([16.5e-6, 2.5e-6], "here")]));
    let offset = marked.size[1] - picture.size[1];
    let middle = marked.at((left + right) / 2, (top + bottom) / 2);
    assert!(middle.iter().all(|c| *c < 90), "{middle:?}, {offset}");
}

#[test]
fn an_outline_and_arrows_lie_where_their_fields_are() {
    let g = grid(20, 20, 1e-6);
    let mut spot = g.zeros();
    spot.slice_mut(ndarray::s![4..8, 12..16]).fill(1.0);
    let zeros = g.zeros();
    let map = heights("", &zeros, &g).outlined(&spot, "edge").with_arrows([&spot, &zeros], "direction");
    let words = text_of(&Maps::new(vec![map.clone()]));
    assert!(words.contains(&"edge".to_owned()) && words.contains(&"direction".to_owned()));
    let picture = drawn(&Maps::new(vec![map]));
    let edge: Vec<[usize; 2]> = (0..picture.size[1] * 5 / 6)
        .flat_map(|y| (0..picture.size[0]).map(move |x| [x, y]))
        .filter(|[x, y]| matches!(picture.at(*x, *y), [180..=255, 0..120, 0..120]))
        .collect();
    let ends = |axis: usize| {
        let along = edge.iter().map(|p| p[axis]);
        (along.clone().min().unwrap(), along.max().unwrap())
    };
    let ((left, right), (top, bottom)) = (ends(0), ends(1));
    assert_near(right - left, (bottom - top) as f64);
    // A fifth of the map, in its upper left quarter.
    assert!(right < picture.size[0] / 2 && bottom < picture.size[1] / 2, "{left} {right} {top} {bottom}");
}

// ---- curves ----------------------------------------------------------------------------------------------

#[test]
fn load_and_area_have_an_axis_each_and_a_legend_once() {
    let along = |f: &dyn Fn(f64) -> f64| (0..96).map(|i| [f64::from(i), f(f64::from(i))]).collect::<Vec<_>>();
    let area = along(&|i| 3e-10 + 1e-10 * (i / 9.0).cos());
    let series = vec![
        Series::new("load", along(&|i| 2.0 + 0.4 * (i / 7.0).sin()), Mark::Line),
        Series::new("contact area", area, Mark::Line).on_the_right(),
        Series::new("mean load", vec![[0.0, 2.0], [95.0, 2.0]], Mark::Dashed),
    ];
    let chart =
        Chart::new("", Axis::linear("position", Unit::Count), Axis::linear("load", Unit::Force), series);
    let chart = chart.with_right(Axis::linear("contact area", Unit::Area));
    let picture = drawn(&Charts::from(chart.clone()));
    assert!(picture.has_a_white_edge());
    assert!(picture.count([213, 94, 0]) > 300, "the area is drawn");
    let sheet = Charts { charts: vec![chart.clone(), chart], columns: 2, aspect: 0.6 };
    let words = text_of(&sheet);
    let named = |name: &str| words.iter().filter(|words| *words == name).count();
    assert_eq!(
        (named("contact area (right)"), named("mean load"), named("load (N)")),
        (1, 1, 2),
        "{words:?}"
    );
}

#[test]
fn passes_have_whole_ticks_and_no_data_are_called_none() {
    let figure = |points: Vec<[f64; 2]>| {
        let (x, y) = (Axis::linear("pass", Unit::Count), Axis::linear("Sq", Unit::Length));
        Charts::from(Chart::new("", x, y, vec![Series::new("lower", points, Mark::LineAndPoints)]))
    };
    let words = text_of(&figure(vec![[0.0, 1e-7], [1.0, 2e-7], [2.0, 3e-7]]));
    assert!(words.contains(&"1".to_owned()) && !words.iter().any(|w| w == "0.5" || w == "1.5"), "{words:?}");
    for none in [vec![], vec![[f64::NAN, 1.0]]] {
        assert!(text_of(&figure(none)).contains(&"none".to_owned()));
    }
}

#[test]
fn points_in_geometric_progression_are_evenly_spaced_on_logarithmic_axes() {
    let middle = |axis: &dyn Fn() -> Axis| {
        let series = |points: &[[f64; 2]]| Series::new("", points.to_vec(), Mark::Points);
        // A break between the two: no line.
        let points = [[1.0, 1.0], [10.0, 10.0], [100.0, 100.0]];
        let picture = drawn(&Charts::from(Chart::new("", axis(), axis(), vec![series(&points)])));
        let columns: Vec<usize> = (0..picture.size[0])
            .filter(|x| (0..picture.size[1]).any(|y| picture.at(*x, y) == [0, 114, 178]))
            .collect();
        // Three runs of columns.
        let mut runs: Vec<Vec<usize>> = Vec::new();
        for x in columns {
            match runs.last_mut() {
                Some(run) if run.last() == Some(&(x - 1)) => run.push(x),
                _ => runs.push(vec![x]),
            }
        }
        assert_eq!(runs.len(), 3);
        let centres: Vec<f64> = runs.iter().map(|run| (run[0] + run[run.len() - 1]) as f64 / 2.0).collect();
        (centres[1] - centres[0]) / (centres[2] - centres[0])
    };
    let log = middle(&|| Axis::log("n", Unit::Number));
    let linear = middle(&|| Axis::linear("n", Unit::Number));
    assert!((log - 0.5).abs() < 0.01 && (linear - 1.0 / 11.0).abs() < 0.02, "{log} {linear}");
}

#[test]
fn odd_curves_are_drawn() {
    let odd: [&[[f64; 2]]; 7] = [
        &[],
        &[[1.0, 1.0]],
        &[[1.0, 0.0], [2.0, 0.0]],
        &[[1.0, -4e-9], [2.0, 3e9]],
        &[[0.0, 1e-14], [2.0, 2e-14], [3.0, f64::NAN], [4.0, 1e-14]],
        &[[-1.0, -1e9], [1.0, 1e9]],
        &[[0.0, 2.0], [1.0, 2.0 + 1e-12]],
    ];
    for points in odd {
        for mark in [Mark::Line, Mark::Dashed, Mark::LineAndPoints, Mark::Points, Mark::Arrows, Mark::Bars] {
            for log in [false, true] {
                let axis = |label: &str| Axis { log, ..Axis::linear(label, Unit::Number) };
                let series = vec![Series::new("odd", points.to_vec(), mark)];
                let figure = Charts::from(Chart::new("", axis("x"), axis("y"), series));
                assert!(
                    drawn_on(&figure, &Paper { dpi: 50.0, ..PAPER }).has_a_white_edge(),
                    "{points:?} {mark:?}"
                );
            }
        }
    }
}

// ---- reliefs ---------------------------------------------------------------------------------------------

#[test]
fn reliefs_of_all_shapes_are_drawn() {
    for [nx, ny] in [[1, 1], [1, 30], [40, 1], [700, 30]] {
        let field = bumps(nx, ny, 0.0);
        assert!(drawn(&Relief::of_heights(&field, &grid(nx, ny, 1e-6))).has_a_white_edge(), "{nx} × {ny}");
    }
}

// ---- files -----------------------------------------------------------------------------------------------

/// All texts of a figure under its caption.
fn text_of(figure: &dyn Figure) -> Vec<String> {
    let steps = captioned(figure, &caption(), &PAPER).steps;
    let words = |step| if let scene::Step::Text(words) = step { Some(words.text) } else { None };
    steps.into_iter().filter_map(words).collect()
}

fn example<'a>(field: &'a Field, grid: &Grid) -> Maps<'a> {
    Maps::new(vec![pressures("p < H & \u{1}", field, grid)])
}

#[test]
fn a_png_has_its_resolution_and_its_width() {
    let folder = TempDir::new().unwrap();
    let (g, path) = (grid(8, 8, 1e-6), folder.path().join("figure.png"));
    let field = Field::from_elem([8, 8], 1e9);
    let paper = Paper { width: Some(0.085), ..Paper::default() };
    save(&path, &example(&field, &g), &caption(), &paper).unwrap();
    let file = std::io::BufReader::new(std::fs::File::open(&path).unwrap());
    let reader = png::Decoder::new(file).read_info().unwrap();
    let dimensions = reader.info().pixel_dims.unwrap();
    assert_eq!((dimensions.xppu, dimensions.yppu, dimensions.unit), (11_811, 11_811, png::Unit::Meter));
    assert_near(reader.info().width as usize, 0.085 / 0.0254 * 300.0);
}

#[test]
fn text_is_text_in_svg_and_pdf_and_brings_its_glyphs() {
    let folder = TempDir::new().unwrap();
    let g = grid(8, 8, 1e-6);
    let field = Field::from_elem([8, 8], 1e9);
    let file = |format: Format| {
        let path = folder.path().join("figure");
        save(&path, &example(&field, &g), &caption(), &Paper { format, ..PAPER }).unwrap();
        std::fs::read(path).unwrap()
    };
    let svg = String::from_utf8(file(Format::Svg)).unwrap();
    let document = roxmltree::Document::parse(&svg).unwrap();
    let texts: Vec<&str> =
        document.descendants().filter(|n| n.has_tag_name("text")).filter_map(|n| n.text()).collect();
    assert!(texts.contains(&"p < H &  ") && texts.contains(&"case · load 2 N · pass 5"), "{texts:?}");
    assert!(svg.contains("src: url('data:font/ttf;base64,"));
    assert!(svg.len() < 60_000, "{} bytes: a part of the font", svg.len());

    let pdf = file(Format::Pdf);
    let has = |needle: &[u8]| pdf.windows(needle.len()).any(|window| window == needle);
    assert!(
        pdf.starts_with(b"%PDF-1") && has(b"/FontFile2") && has(b"/ToUnicode") && has(b"/Subtype /Image")
    );
    assert!(pdf.len() < 60_000, "{} bytes: a part of the font", pdf.len());
}

#[test]
fn the_same_figure_gives_the_same_bytes() {
    let folder = TempDir::new().unwrap();
    let g = grid(64, 64, 1e-6);
    let field = bumps(64, 64, 0.0);
    for format in [Format::Png, Format::Svg, Format::Pdf] {
        let draw = |name: &str| {
            let path = folder.path().join(name);
            let figure = Maps::new(vec![heights("once more", &field, &g)]);
            save(&path, &figure, &caption(), &Paper { format, ..PAPER }).unwrap();
            std::fs::read(path).unwrap()
        };
        assert!(draw("first") == draw("second"));
    }
}

#[test]
fn a_figure_that_cannot_be_written_names_its_file() {
    let folder = TempDir::new().unwrap();
    let (g, field) = (grid(2, 2, 1e-6), Field::zeros([2, 2]));
    let path = folder.path().join("missing/figure.png");
    let error = save(&path, &example(&field, &g), &caption(), &PAPER).unwrap_err().to_string();
    assert!(error.contains("cannot draw") && error.contains("figure.png"), "{error}");
}

#[test]
fn frames_whose_captions_and_legends_differ_are_of_one_size() {
    let (g, field) = (grid(8, 8, 1e-6), Field::zeros([8, 8]));
    let missing = Field::from_elem([8, 8], f64::NAN);
    let frame = |field, of: &str| {
        let caption = Caption { of: of.to_owned(), ..caption() };
        (Maps::new(vec![pressures("", field, &g).range([0.0, 4e9]).missing("nothing faces it")]), caption)
    };
    let long = "pass 1, position 100, load 10.5 N ".repeat(6);
    let frames = [frame(&field, "pass 1"), frame(&field, &long), frame(&missing, "pass 1")];
    let sizes = captioned_alike(&frames, &PAPER).iter().map(|scene| scene.size).collect::<Vec<_>>();
    assert!(sizes[0] == sizes[1] && sizes[1] == sizes[2], "{sizes:?}");
    let alone = captioned(&frames[0].0, &frames[0].1, &PAPER).size;
    assert!(alone[1] < sizes[0][1], "{alone:?}, {sizes:?}");
}

#[test]
fn an_animation_shows_each_frame_in_its_time() {
    let folder = TempDir::new().unwrap();
    let path = folder.path().join("pass.gif");
    let g = grid(32, 16, 1e-6);
    let fields: Vec<Field> = (0..6)
        .map(|step| {
            Field::from_shape_fn(
                [32, 16],
                |(i, _)| if (4 * step..4 * step + 8).contains(&i) { 2e9 } else { f64::NAN },
            )
        })
        .collect();
    let scene =
        |field| captioned(&Maps::new(vec![pressures("", field, &g).range([0.0, 4e9])]), &caption(), &PAPER);
    let scenes: Vec<Scene> = fields.iter().map(scene).collect();
    animation(&path, &scenes, Colours::Pressure, 10).unwrap();

    let mut decoder = gif::Decoder::new(std::fs::File::open(&path).unwrap()).unwrap();
    let [width, height] = [decoder.width(), decoder.height()].map(usize::from);
    let palette = decoder.global_palette().unwrap().to_vec();
    let mut sheet = vec![[0; 3]; width * height];
    let mut lefts = Vec::new();
    while let Some(frame) = decoder.read_next_frame().unwrap() {
        assert!(frame.delay == 10 && frame.palette.is_none());
        for (i, &index) in
            frame.buffer.iter().enumerate().filter(|(_, index)| Some(**index) != frame.transparent)
        {
            let (x, y) = (i % usize::from(frame.width), i / usize::from(frame.width));
            let colour = palette[3 * usize::from(index)..][..3].try_into().unwrap();
            sheet[(y + usize::from(frame.top)) * width + x + usize::from(frame.left)] = colour;
        }
        // The largest run of colour in a row through the middle of the map.
        let row = &sheet[width * (height / 2)..][..width * 3 / 4];
        let coloured = |c: &[u8; 3]| (0..3).all(|i| c[i].abs_diff(viridis(0.5)[i]) < 8);
        lefts.push(row.iter().position(coloured).unwrap());
    }
    assert_eq!((lefts.len(), decoder.repeat()), (6, gif::Repeat::Infinite));
    let step = (lefts[5] - lefts[0]) as f64 / 5.0;
    for (i, left) in lefts.iter().enumerate() {
        assert_near(*left, lefts[0] as f64 + step * i as f64);
    }
    assert!(animation(&path, &[], Colours::Pressure, 10).unwrap_err().to_string().contains("no frame"));
}

#[test]
fn each_unit_is_the_si_unit_of_its_dimension() {
    for dimension in asperity_base::units::Dimension::ALL {
        assert_eq!(Unit::from(dimension).base(), dimension.si(), "{dimension:?}");
    }
}
