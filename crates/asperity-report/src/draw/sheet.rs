//! Maps on a sheet: aligned, with one legend, and one colour bar where they share a range.

use super::axis::{Quantity, Scale, Unit};
use super::colour::Colours;
use super::frame::{BELOW, beside};
use super::legend::{Key, Legend};
use super::map::{Map, bar, bar_scale};
use super::output::{Figure, Paper};
use super::scene::{Rect, Scene};
use super::text::LARGE;

/// Width of a map alone and of a sheet of them, pt.
const WIDTHS: [f64; 2] = [330.0, 482.0];
/// The most that a sheet of one row, or of several, is high, over its width.
const MAX_HEIGHTS: [f64; 2] = [1.1, 0.8];
/// What a narrow sheet may be high in any case, pt.
const MIN_HEIGHT: f64 = 240.0;
/// Width of a colour bar, pt.
const BAR: f64 = 9.0;
/// Gap between a panel and its colour bar, pt.
const GAP: f64 = 7.0;

/// Maps that are seen together.
#[derive(Debug, Clone)]
pub struct Maps<'a> {
    maps: Vec<Map<'a>>,
    /// In how many columns they may stand.
    pub(super) columns: Vec<usize>,
    remarks: Vec<String>,
}

impl<'a> Maps<'a> {
    /// Maps in as many columns as shows them largest.
    pub fn new(maps: Vec<Map<'a>>) -> Self {
        let count = maps.len();
        // Three stand in two rows rather than in a column, which leaves most of the width empty.
        let suits = |columns: &usize| if count == 3 { *columns > 1 } else { count.is_multiple_of(*columns) };
        let columns = (1..=count).filter(suits).collect();
        Self { maps, columns, remarks: Vec::new() }
    }

    /// The same maps with a remark in the legend.
    pub fn remark(mut self, remark: impl Into<String>) -> Self {
        self.remarks.push(remark.into());
        self
    }

    /// The same maps between given values, SI, at the ends of their colours.
    fn range(mut self, range: Option<[f64; 2]>) -> Self {
        if let Some(range) = range {
            let of_classes = |map: &Map| map.shading.is_of_classes();
            let maps = self.maps.into_iter();
            self.maps = maps.map(|map| if of_classes(&map) { map } else { map.range(range) }).collect();
        }
        self
    }

    /// Whether one bar tells the colours of all maps.
    fn share_a_bar(&self) -> bool {
        let first = &self.maps[0];
        let alike = |map: &Map| map.given && (map.shading, &map.quantity) == (first.shading, &first.quantity);
        self.maps.len() > 1 && self.maps.iter().all(alike)
    }

    /// The magnitude that decides the unit of a map's bar: one for all maps of a quantity that are not worlds
    /// apart.
    fn magnitude(&self, map: &Map) -> f64 {
        let of = |map: &Map| map.shading.range.iter().fold(0.0, |most: f64, v| most.max(v.abs()));
        let alike = self.maps.iter().filter(|other| other.quantity == map.quantity && !other.is_flat());
        let largest = alike.map(of).fold(0.0, f64::max);
        if largest > 1e3 * of(map) { of(map) } else { largest }
    }

    fn legend(&self) -> Legend {
        let mut legend = Legend::default();
        self.maps.iter().for_each(|map| map.explain(&mut legend));
        self.remarks.iter().for_each(|remark| legend.add(Key::Nothing, remark.clone()));
        legend
    }
}

impl Figure for Maps<'_> {
    fn scene(&self, paper: &Paper) -> Scene {
        let width = paper.width(WIDTHS[usize::from(self.maps.len() > 1)]);
        let ranged = self.clone().range(paper.range);
        let layouts = self.columns.iter().map(|columns| Layout::new(&ranged, *columns, width));
        let layout = layouts.max_by(|a, b| a.area().total_cmp(&b.area())).expect("a sheet holds a map");
        layout.draw(paper)
    }
}

/// Sizes and places of the maps in so many columns.
struct Layout<'s, 'a> {
    sheet: &'s Maps<'a>,
    columns: usize,
    /// Size of each map, pt.
    sizes: Vec<[f64; 2]>,
    /// Left and right of the maps of each column, pt.
    margins: Vec<[f64; 2]>,
    width: f64,
    legend: Legend,
    shared: bool,
}

impl<'s, 'a> Layout<'s, 'a> {
    fn new(sheet: &'s Maps<'a>, columns: usize, width: f64) -> Self {
        let rows = sheet.maps.len().div_ceil(columns);
        let shared = sheet.share_a_bar();
        let legend = sheet.legend();
        let above = rows as f64 * (LARGE + 8.0 + BELOW + GAP) + legend.height(width - 12.0);
        // Numbers at the axes depend on the size of a map, which depends on the room that numbers take.
        let mut size = [width / columns as f64 * 0.7; 2];
        let mut layout =
            Self { sheet, columns, sizes: Vec::new(), margins: Vec::new(), width, legend, shared };
        for _ in 0..3 {
            layout.sizes = sheet.maps.iter().map(|map| fitted(size[0], size[1], map.aspect())).collect();
            layout.margins = layout.margins_of_columns();
            let margins: f64 = layout.margins.iter().flatten().sum::<f64>() + layout.shared_bar();
            let room = ((width - margins) / columns as f64).max(30.0);
            let highest = (MAX_HEIGHTS[usize::from(rows > 1)] * width).max(MIN_HEIGHT);
            let height = ((highest - above) / rows as f64).max(30.0);
            size = [room, height];
        }
        layout
    }

    /// The area of all maps; where they take more than the sheet has, what that lacks, negative.
    fn area(&self) -> f64 {
        let lacking = self.width - self.total();
        if lacking < -0.5 { lacking } else { self.sizes.iter().map(|[width, height]| width * height).sum() }
    }

    /// What all columns with their axes and bars take of the width.
    fn total(&self) -> f64 {
        (0..self.columns).map(|column| self.width_of(column)).sum::<f64>() + self.shared_bar()
    }

    /// What a column takes of the width.
    fn width_of(&self, column: usize) -> f64 {
        let maps = self.sizes.iter().skip(column).step_by(self.columns).map(|size| size[0]);
        self.margins[column][0] + maps.fold(0.0, f64::max) + self.margins[column][1]
    }

    fn margins_of_columns(&self) -> Vec<[f64; 2]> {
        let of = |i: usize| {
            let map = &self.sheet.maps[i];
            let [_, y] = map.scales(self.sizes[i]);
            let bar = if self.has_bar(map) { GAP + BAR + beside(&self.bar_scale(i)) } else { 0.0 };
            [4.0 + beside(&y), 8.0 + bar]
        };
        (0..self.columns)
            .map(|column| {
                let maps = (column..self.sheet.maps.len()).step_by(self.columns).map(of);
                maps.fold([0.0; 2], |most, margins| [0, 1].map(|side| f64::max(most[side], margins[side])))
            })
            .collect()
    }

    fn has_bar(&self, map: &Map) -> bool {
        !self.shared && !map.shading.is_of_classes() && !map.is_flat()
    }

    fn bar_scale(&self, i: usize) -> Scale {
        let map = &self.sheet.maps[i];
        bar_scale(map, self.sheet.magnitude(map), self.sizes[i][1])
    }

    /// Width of the bar that all maps share.
    fn shared_bar(&self) -> f64 {
        if self.shared && !self.sheet.maps[0].shading.is_of_classes() {
            BAR + GAP + beside(&self.bar_scale(0))
        } else {
            0.0
        }
    }

    fn draw(&self, paper: &Paper) -> Scene {
        let maps = &self.sheet.maps;
        let rows = maps.len().div_ceil(self.columns);
        let height_of = |row: usize| {
            let of_row = self.sizes.iter().skip(row * self.columns).take(self.columns);
            of_row.map(|size| size[1]).fold(0.0, f64::max)
        };
        let titled = maps.iter().any(|map| !map.title.is_empty());
        let above = if titled { LARGE + 8.0 } else { 8.0 };
        let heights: Vec<f64> = (0..rows).map(|row| above + height_of(row) + BELOW + GAP).collect();
        let widths: Vec<f64> = (0..self.columns).map(|column| self.width_of(column)).collect();
        let body = heights.iter().sum::<f64>();
        // What a tall map leaves of the width is left at both sides alike.
        let left = ((self.width - self.total()) / 2.0).max(0.0);
        let room = self.width - 12.0;
        let mut scene = Scene::new([self.width, body + self.legend.height(room)]);
        for (i, map) in maps.iter().enumerate() {
            let (row, column) = (i / self.columns, i % self.columns);
            let [width, height] = self.sizes[i];
            let at = Rect {
                x: left + widths[..column].iter().sum::<f64>() + self.margins[column][0],
                y: heights[..row].iter().sum::<f64>() + above,
                width,
                height,
            };
            let [x, y] = map.scales(self.sizes[i]);
            map.draw(&mut scene, at, [&x, &y], paper);
            if self.has_bar(map) {
                let beside = Rect { x: at.right() + GAP, width: BAR, ..at };
                bar(&mut scene, beside, map, &self.bar_scale(i), map.clipped);
            }
        }
        if self.shared_bar() > 0.0 {
            // As high as all panels.
            let height = body - above - BELOW - GAP;
            let at = Rect { x: left + widths.iter().sum::<f64>() + GAP, y: above, width: BAR, height };
            // Ends are pointed where any map goes beyond them.
            let clipped = [0, 1].map(|end| maps.iter().any(|map| map.clipped[end]));
            bar(&mut scene, at, &maps[0], &self.bar_scale(0), clipped);
        }
        self.legend.draw(&mut scene, [6.0, body], room);
        scene
    }
}

/// The largest size of an aspect within a width and a height.
fn fitted(width: f64, height: f64, aspect: f64) -> [f64; 2] {
    let width = width.min(height * aspect);
    [width, width / aspect]
}

/// The range of colours for heights that are seen together: all of them, or, where a few stand out, from the
/// 0.1 % to the 99.9 % percentile; then also a remark that says so.
pub(crate) fn range_of_heights<'a>(
    fields: impl IntoIterator<Item = &'a asperity_base::Field>,
) -> Option<([f64; 2], Option<&'static str>)> {
    let finite = |z: &f64| z.is_finite();
    let mut heights: Vec<f64> = fields.into_iter().flat_map(|f| f.iter().copied().filter(finite)).collect();
    if heights.is_empty() {
        return None;
    }
    let mut at = |share: f64| {
        let place = ((heights.len() - 1) as f64 * share).round() as usize;
        *heights.select_nth_unstable_by(place, f64::total_cmp).1
    };
    let (all, most) = ([at(0.0), at(1.0)], [at(0.001), at(0.999)]);
    let width = |[low, high]: [f64; 2]| high - low;
    if width(most) > 0.0 && width(all) > 1.5 * width(most) {
        return Some((most, Some("colours end at the percentiles 0.1 % and 99.9 % of the heights")));
    }
    Some((all, None))
}

/// Heights on their grid, in colours over their range.
pub fn heights<'a>(field: &'a asperity_base::Field, grid: &asperity_base::Grid) -> Maps<'a> {
    let quantity = Quantity::new("height", Unit::Length);
    let map = Map::new("", field, grid, quantity, Colours::Heights);
    match range_of_heights([field]) {
        Some((range, remark)) => remark.into_iter().fold(Maps::new(vec![map.range(range)]), Maps::remark),
        None => Maps::new(vec![map]),
    }
}
