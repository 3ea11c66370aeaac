//! A field in perspective, with light on it.

use asperity_base::grid::Field;
use rayon::prelude::*;

use super::axis::{Quantity, Scale, Unit, widened};
use super::colour::{Colours, MISSING, Range, Shading};
use super::frame::THIN;
use super::image::{Image, Rgb};
use super::output::{Figure, Paper};
use super::scene::{Anchor, FAINT, PAPER, Rect, Scene, Stroke};
use super::text::{MEDIUM, SMALL};

/// Width of a figure, pt.
const WIDTH: f64 = 360.0;
/// The most that it is high, over its width.
const MAX_HEIGHT: f64 = 0.8;
/// Height of the relief over the longer side of its base.
const RISE: f64 = 0.22;
/// Where the eye stands, in degrees from x towards y, and how high above the plane: it sees the corner of
/// least x and y.
const AZIMUTH: f64 = -120.0;
/// Elevation of the eye above the horizon, degrees.
const ELEVATION: f64 = 32.0;
/// Distance of the eye over the longer side of the base.
const DISTANCE: f64 = 3.6;
/// The light comes from over the left shoulder.
const LIGHT: [f64; 3] = [-0.75, -0.15, 0.64];
/// Patches along the longer side.
const PATCHES: usize = 400;
/// Fine pixels along a pixel.
const FINE: usize = 2;
/// Neighbouring patches of a row that a band of the image skips together.
const RUN: usize = 16;

/// A field in perspective. Values come in SI.
#[derive(Debug, Clone)]
pub struct Relief<'a> {
    /// The field, `[ix, iy]`.
    pub field: &'a Field,
    /// Where the axes begin and end.
    pub ends: [[f64; 2]; 2],
    /// Names of the axes.
    pub names: [&'a str; 2],
    /// Unit of the axes.
    pub unit: Unit,
    /// What the field holds.
    pub quantity: Quantity,
    /// Values at the lower and the upper end of the upright axis; by default those of the field.
    pub range: Option<[f64; 2]>,
    /// Height of the relief over the longer side of its base.
    pub rise: f64,
}

impl<'a> Relief<'a> {
    /// Heights over their grid.
    pub fn of_heights(field: &'a Field, grid: &asperity_base::Grid) -> Self {
        Self {
            field,
            ends: grid.extent().map(|length| [0.0, length]),
            names: ["x", "y"],
            unit: Unit::Length,
            quantity: Quantity::new("height", Unit::Length),
            range: None,
            rise: RISE,
        }
    }

    /// Whether there is nothing that rises.
    pub fn is_flat(&self) -> bool {
        let [low, high] = Range::of(self.field.view()).all;
        low >= high
    }

    /// The field averaged over patches.
    fn patches(&self) -> Field {
        let shape = [self.field.nrows(), self.field.ncols()];
        let block = shape[0].max(shape[1]).div_ceil(PATCHES);
        let counts = shape.map(|n| (n / block).max(1));
        let patch = |i: usize, j: usize| {
            let cells = (i * block..((i + 1) * block).min(shape[0]))
                .flat_map(|i| (j * block..((j + 1) * block).min(shape[1])).map(move |j| self.field[[i, j]]));
            let (sum, count) = cells.fold((0.0, 0.0), |(sum, count), z| (sum + z, count + 1.0));
            sum / count
        };
        let rows = (0..counts[0]).into_par_iter();
        let means: Vec<f64> = rows.flat_map_iter(|i| (0..counts[1]).map(move |j| patch(i, j))).collect();
        Field::from_shape_vec(counts, means).expect("a mean of each patch")
    }
}

impl Figure for Relief<'_> {
    fn scene(&self, paper: &Paper) -> Scene {
        let width = paper.width(WIDTH);
        let range = widened(paper.range.or(self.range).unwrap_or_else(|| Range::of(self.field.view()).all));
        let lengths = self.ends.map(|[begin, end]| (end - begin).abs());
        let (view, height) = View::new(lengths, self.rise, width);
        let mut scene = Scene::new([width, height]);
        self.back(&mut scene, &view, range);
        let at = Rect { x: 0.0, y: 0.0, width: scene.size[0], height: scene.size[1] };
        let size = scene.size.map(|length| paper.pixels(length).min(3000));
        scene.image(self.image(&view, range, size, scene.size), at);
        self.axes(&mut scene, &view, range);
        if self.unit == self.quantity.unit {
            let magnified = self.rise * lengths[0].max(lengths[1]) / (range[1] - range[0]);
            let digits = 10f64.powf(1.0 - magnified.log10().floor());
            let words = format!("{}s × {}", self.quantity.name, (magnified * digits).round() / digits);
            scene.words(&words, [width - 8.0, height - 8.0], SMALL, Anchor::End, FAINT);
        }
        scene
    }
}

impl Relief<'_> {
    /// The lines behind the relief.
    fn back(&self, scene: &mut Scene, view: &View, range: [f64; 2]) {
        let faint = Stroke::new([205; 3], 0.5);
        let z = self.scale_of_z(range);
        for (share, _) in &z.ticks {
            scene.line(
                &[[0.0, 1.0, *share], [1.0, 1.0, *share], [1.0, 0.0, *share]].map(|p| view.place(p)),
                faint,
            );
        }
        for corner in [[0.0, 1.0], [1.0, 1.0], [1.0, 0.0]] {
            scene.line(&[0.0, 1.0].map(|z| view.place([corner[0], corner[1], z])), faint);
        }
        scene.line(&[[0.0, 1.0, 0.0], [1.0, 1.0, 0.0], [1.0, 0.0, 0.0]].map(|p| view.place(p)), faint);
    }

    fn scale_of_z(&self, range: [f64; 2]) -> Scale {
        Scale::linear(
            range,
            range[0].abs().max(range[1].abs()),
            self.quantity.unit,
            (4.0 * self.rise / RISE).round() as usize,
        )
    }

    /// The axes in front: x along the near edge on the left, y along that on the right, z at the left corner.
    fn axes(&self, scene: &mut Scene, view: &View, range: [f64; 2]) {
        let magnitude = self.ends.iter().flatten().fold(0.0, |most: f64, v| most.max(v.abs()));
        let scales = self.ends.map(|ends| Scale::linear(ends, magnitude, self.unit, 5));
        let middle = view.place([0.5, 0.5, 0.0]);
        let along: [fn(f64) -> [f64; 3]; 2] = [|s| [s, 0.0, 0.0], |s| [0.0, s, 0.0]];
        for (axis, place) in along.iter().enumerate() {
            let ends = [0.0, 1.0].map(|s| view.place(place(s)));
            scene.line(&ends, THIN);
            // Away from the relief, at right angles to the edge.
            let edge = [ends[1][0] - ends[0][0], ends[1][1] - ends[0][1]];
            let length = edge[0].hypot(edge[1]);
            let mut out = [-edge[1] / length, edge[0] / length];
            if out[0] * (ends[0][0] - middle[0]) + out[1] * (ends[0][1] - middle[1]) < 0.0 {
                out = out.map(|v| -v);
            }
            let beyond = |[x, y]: [f64; 2], by: f64| [x + by * out[0], y + by * out[1]];
            let anchor = if out[0] < 0.0 { Anchor::End } else { Anchor::Start };
            for (share, label) in &scales[axis].ticks {
                let at = view.place(place(*share));
                scene.line(&[at, beyond(at, 3.0)], THIN);
                scene.text(label, beyond(at, 6.5), SMALL, anchor);
            }
            let name = scales[axis].label(self.names[axis]);
            let wide = scales[axis].width();
            scene.text(&name, beyond(view.place(place(0.5)), 16.0 + 0.8 * wide), MEDIUM, anchor);
        }
        let z = self.scale_of_z(range);
        let at = |share: f64| view.place([0.0, 1.0, share]);
        scene.line(&[at(0.0), at(1.0)], THIN);
        for (share, label) in &z.ticks {
            let [x, y] = at(*share);
            scene.line(&[[x, y], [x - 3.0, y]], THIN);
            scene.text(label, [x - 5.5, y], SMALL, Anchor::End);
        }
        let [x, y] = at(1.0);
        scene.text(&z.label(&self.quantity.name), [(x - 10.0).max(4.0), y - 9.0], MEDIUM, Anchor::Start);
    }

    /// The relief; what is behind shows where it is not.
    fn image(&self, view: &View, range: [f64; 2], [width, height]: [usize; 2], size: [f64; 2]) -> Image {
        let patches = self.patches();
        let shading = Shading { range, colours: Colours::Heights };
        let counts = [patches.nrows(), patches.ncols()];
        let scale = [(width * FINE) as f64 / size[0], (height * FINE) as f64 / size[1]];
        let mut canvas = Canvas::new(width * FINE, height * FINE);
        let share =
            |index: usize, count: usize| if count > 1 { index as f64 / (count - 1) as f64 } else { 0.5 };
        let rise = |z: f64| ((z - range[0]) / (range[1] - range[0])).clamp(0.0, 1.0);
        let place = |[i, j]: [usize; 2]| {
            let z = patches[[i, j]];
            [share(i, counts[0]), share(j, counts[1]), if z.is_finite() { rise(z) } else { 0.0 }]
        };
        // Each corner is lit by the slopes around it.
        let corners = ndarray::Array2::from_shape_fn(counts, |(i, j)| {
            let ends = |at: usize, n: usize| [at.saturating_sub(1), (at + 1).min(n - 1)];
            let around =
                [ends(i, counts[0]).map(|i| place([i, j])), ends(j, counts[1]).map(|j| place([i, j]))];
            let z = patches[[i, j]];
            let colour = if z.is_finite() { shading.of(z) } else { MISSING };
            (view.fine(place([i, j]), scale), view.lit(colour, around))
        });
        let next = |index: usize, axis: usize| (index + 1).min(counts[axis] - 1);
        let [rows, columns] = counts.map(|count| count.max(2) - 1);
        // The row and the columns of a run of patches, and the distances down the canvas of its highest and
        // its lowest corner.
        let run = |i: usize, first: usize| {
            let patches = first..(first + RUN).min(columns);
            let ends = (first..=next(patches.end - 1, 1))
                .flat_map(|j| [i, next(i, 0)].map(|i| corners[[i, j]].0[1]));
            let ends = ends.fold([f64::INFINITY, f64::NEG_INFINITY], |[a, b], y| [a.min(y), b.max(y)]);
            (i, patches, ends)
        };
        let runs: Vec<_> =
            (0..rows).flat_map(|i| (0..columns).step_by(RUN).map(move |j| run(i, j))).collect();
        canvas.bands().for_each(|mut band| {
            for (i, patches, ends) in &runs {
                if !band.reaches(*ends) {
                    continue;
                }
                for j in patches.clone() {
                    let (i, [below, right]) = (*i, [next(*i, 0), next(j, 1)]);
                    let patch = [[i, j], [below, j], [below, right], [i, right]].map(|c| corners[c]);
                    band.triangle([patch[0], patch[1], patch[2]]);
                    band.triangle([patch[0], patch[2], patch[3]]);
                }
            }
        });
        canvas.reduced(width, height)
    }
}

/// From shares of the base and of the rise to the sheet.
struct View {
    /// Lengths of the base, the longer 1, and the rise.
    box_size: [f64; 3],
    turn: [f64; 2],
    tilt: [f64; 2],
    scale: f64,
    shift: [f64; 2],
}

impl View {
    /// The view that fills a sheet of a width, and the height of that.
    fn new(lengths: [f64; 2], rise: f64, width: f64) -> (Self, f64) {
        let longest = lengths[0].max(lengths[1]);
        // A side of a tenth of the other is still seen.
        let base = lengths.map(|length| (length / longest).max(0.15));
        let turn = AZIMUTH.to_radians().sin_cos();
        let tilt = ELEVATION.to_radians().sin_cos();
        let mut view = Self {
            box_size: [base[0], base[1], rise],
            turn: [turn.0, turn.1],
            tilt: [tilt.0, tilt.1],
            scale: 1.0,
            shift: [0.0; 2],
        };
        let corners = (0..8).map(|c| view.place([c & 1, c >> 1 & 1, c >> 2].map(f64::from)));
        let [mut low, mut high] = [[f64::INFINITY; 2], [f64::NEG_INFINITY; 2]];
        for corner in corners {
            for axis in [0, 1] {
                low[axis] = low[axis].min(corner[axis]);
                high[axis] = high[axis].max(corner[axis]);
            }
        }
        // Room for ticks and names at the left, right, top and bottom.
        const MARGINS: [[f64; 2]; 2] = [[40.0, 36.0], [22.0, 34.0]];
        let room = [width, MAX_HEIGHT * width];
        let room = [0, 1].map(|axis| room[axis] - MARGINS[axis][0] - MARGINS[axis][1]);
        view.scale = (room[0] / (high[0] - low[0])).min(room[1] / (high[1] - low[1]));
        let height = view.scale * (high[1] - low[1]);
        let room = [room[0], height];
        // The name of the upright axis stands above its corner, which is mostly lower than the one behind.
        let lower = view.projected([0.0, 1.0, 1.0])[1] - low[1];
        let top = (MARGINS[1][0] - view.scale * lower).max(8.0);
        view.shift = [0, 1].map(|axis| {
            let middle = [MARGINS[0][0], top][axis] + room[axis] / 2.0;
            middle - view.scale * 0.5 * (low[axis] + high[axis])
        });
        (view, height + top + MARGINS[1][1])
    }

    /// To the right, up and towards the eye.
    fn turned(&self, point: [f64; 3]) -> [f64; 3] {
        let [x, y, z] = [0, 1, 2].map(|axis| (point[axis] - 0.5) * self.box_size[axis]);
        let ([sin, cos], [rise, level]) = (self.turn, self.tilt);
        let [right, towards] = [y * cos - x * sin, x * cos + y * sin];
        [right, z * level - towards * rise, z * rise + towards * level]
    }

    fn projected(&self, point: [f64; 3]) -> [f64; 3] {
        let [right, up, near] = self.turned(point);
        let perspective = DISTANCE / (DISTANCE - near);
        [right * perspective, -up * perspective, near]
    }

    /// Where a point of the unit box lies on the sheet.
    fn place(&self, point: [f64; 3]) -> [f64; 2] {
        let [x, y, _] = self.projected(point);
        [self.shift[0] + self.scale * x, self.shift[1] + self.scale * y]
    }

    /// Where it lies in pixels, and how near it is.
    fn fine(&self, point: [f64; 3], scale: [f64; 2]) -> [f64; 3] {
        let [x, y] = self.place(point);
        [x * scale[0], y * scale[1], self.projected(point)[2]]
    }

    /// A colour in the light, between its neighbours along x and along y.
    fn lit(&self, colour: Rgb, neighbours: [[[f64; 3]; 2]; 2]) -> [f64; 3] {
        let along = |[a, b]: [[f64; 3]; 2]| [0, 1, 2].map(|axis| (b[axis] - a[axis]) * self.box_size[axis]);
        let [a, b] = neighbours.map(along);
        let normal = [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
        let length = |v: [f64; 3]| v.iter().map(|v| v * v).sum::<f64>().sqrt();
        let dot: f64 = normal.iter().zip(LIGHT).map(|(n, l)| n * l).sum();
        let cosine = dot / (length(normal) * length(LIGHT)).max(f64::MIN_POSITIVE);
        let brightness = 0.45 + 0.85 * cosine.max(0.0);
        colour.map(|c| f64::from(c) * brightness)
    }
}

/// A corner of a triangle: where it is in pixels and how near, and its colour.
type Corner = ([f64; 3], [f64; 3]);

/// Pixels with their nearness.
struct Canvas {
    width: usize,
    pixels: Vec<(f32, Rgb)>,
}

impl Canvas {
    fn new(width: usize, height: usize) -> Self {
        Self { width, pixels: vec![(f32::NEG_INFINITY, PAPER); width * height] }
    }

    /// Bands of rows, which threads draw each alone.
    fn bands(&mut self) -> impl ParallelIterator<Item = Band<'_>> {
        /// Rows of a band.
        const ROWS: usize = 128;
        let width = self.width;
        let bands = self.pixels.par_chunks_mut(ROWS * width).enumerate();
        bands.map(move |(at, pixels)| Band { width, first: at * ROWS, pixels })
    }

    fn reduced(&self, width: usize, height: usize) -> Image {
        let pixel = |y: usize, x: usize| {
            let fine =
                (0..FINE).flat_map(|j| (0..FINE).map(move |i| (y * FINE + j) * self.width + x * FINE + i));
            let sum = fine
                .fold([0u32; 3], |sum, i| std::array::from_fn(|c| sum[c] + u32::from(self.pixels[i].1[c])));
            sum.map(|s| (s / (FINE * FINE) as u32) as u8)
        };
        let rows = (0..height).into_par_iter();
        let pixels = rows.flat_map_iter(|y| (0..width).map(move |x| pixel(y, x))).collect();
        Image { width, height, pixels, clear: true }
    }
}

/// Rows of a canvas, from the `first` on.
struct Band<'a> {
    width: usize,
    first: usize,
    pixels: &'a mut [(f32, Rgb)],
}

impl Band<'_> {
    /// Whether the band may have pixels between two distances down the canvas, the smaller one first.
    fn reaches(&self, [low, high]: [f64; 2]) -> bool {
        let (first, end) = (self.first as f64, (self.first + self.pixels.len() / self.width) as f64);
        low <= end && first <= high.ceil()
    }

    fn triangle(&mut self, triangle: [Corner; 3]) {
        let (corners, colours) = (triangle.map(|corner| corner.0), triangle.map(|corner| corner.1));
        let [a, b, c] = corners;
        let cross = |p: [f64; 3], q: [f64; 3], x: f64, y: f64| {
            (q[0] - p[0]) * (y - p[1]) - (q[1] - p[1]) * (x - p[0])
        };
        let area = cross(a, b, c[0], c[1]);
        if area == 0.0 {
            return;
        }
        let ends = |axis: usize, most: usize| {
            let values = corners.map(|corner| corner[axis]);
            let low = values.iter().copied().fold(f64::INFINITY, f64::min).floor().max(0.0) as usize;
            let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max).ceil().max(0.0) as usize;
            low..high.min(most)
        };
        let (first, end) = (self.first, self.first + self.pixels.len() / self.width);
        let rows = ends(1, end);
        for y in rows.start.max(first)..rows.end {
            for x in ends(0, self.width) {
                let (px, py) = (x as f64 + 0.5, y as f64 + 0.5);
                let parts = [cross(b, c, px, py), cross(c, a, px, py), cross(a, b, px, py)];
                // Most pixels are clearly outside, which takes no division to see.
                if parts.iter().any(|part| part * area.signum() < -1e-8 * area.abs()) {
                    continue;
                }
                let shares = parts.map(|part| part / area);
                if shares.iter().all(|share| *share >= -1e-9) {
                    let near = (shares[0] * a[2] + shares[1] * b[2] + shares[2] * c[2]) as f32;
                    let pixel = &mut self.pixels[(y - first) * self.width + x];
                    if near > pixel.0 {
                        let mixed = |i: usize| (0..3).map(|k| shares[k] * colours[k][i]).sum::<f64>();
                        *pixel = (near, [0, 1, 2].map(|i| mixed(i).clamp(0.0, 254.0) as u8));
                    }
                }
            }
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_slope_towards_the_light_is_the_brighter() {
        let (view, _) = View::new([1.0, 1.0], RISE, 300.0);
        // The light comes from −x.
        let lit = |rise: f64| {
            let along_x = [[0.0, 0.5, 0.5 - rise], [1.0, 0.5, 0.5 + rise]];
            view.lit([100; 3], [along_x, [[0.5, 0.0, 0.5], [0.5, 1.0, 0.5]]])[0]
        };
        assert!(lit(0.5) > 1.2 * lit(-0.5) && lit(0.0) > lit(-0.5), "{} {}", lit(0.5), lit(-0.5));
    }

    #[test]
    fn the_near_corner_is_low_on_the_sheet_and_heights_rise() {
        let (view, height) = View::new([1.0, 1.0], RISE, 300.0);
        let at = |x, y, z| view.place([x, y, z]);
        assert!(at(0.0, 0.0, 0.0)[1] > at(1.0, 1.0, 0.0)[1] && at(0.5, 0.5, 1.0)[1] < at(0.5, 0.5, 0.0)[1]);
        assert!(at(1.0, 0.0, 0.0)[0] > at(0.0, 1.0, 0.0)[0]);
        for [x, y] in [at(0.0, 0.0, 0.0), at(1.0, 0.0, 0.0), at(0.0, 1.0, 1.0), at(1.0, 1.0, 1.0)] {
            assert!((0.0..300.0).contains(&x) && (0.0..height).contains(&y), "{x} {y}");
        }
    }
}
