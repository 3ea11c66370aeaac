//! What the colours, lines and signs of a sheet mean: names with their keys, in rows.

use super::frame::THIN;
use super::image::Rgb;
use super::scene::{Anchor, INK, PAPER, Rect, Scene, Stroke};
use super::text::{SMALL, width_of};

/// What stands before a name.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Key {
    /// A box of one colour.
    Box(Rgb),
    /// A line, with a marker of a shape on it.
    Line(Stroke, Option<usize>),
    /// A marker of a shape.
    Marker(Rgb, usize),
    /// An arrow.
    Arrow(Rgb),
    /// A cross.
    Cross,
    /// Nothing: the name is a remark.
    Nothing,
}

impl Key {
    fn width(self) -> f64 {
        match self {
            Self::Box(_) => 11.0,
            Self::Line(..) => 21.0,
            Self::Arrow(_) => 17.0,
            Self::Cross | Self::Marker(..) => 11.0,
            Self::Nothing => 0.0,
        }
    }
}

/// Height of a row, pt.
const ROW: f64 = 12.0;
/// Between two entries, pt.
const GAP: f64 = 12.0;

/// Names with their keys, each once.
#[derive(Debug, Clone, Default)]
pub(super) struct Legend {
    entries: Vec<(Key, String)>,
}

impl Legend {
    pub(super) fn add(&mut self, key: Key, name: impl Into<String>) {
        let entry = (key, name.into());
        if !self.entries.contains(&entry) {
            self.entries.push(entry);
        }
    }

    /// The upper left corner of each entry, in rows of `room`.
    fn places(&self, room: f64) -> Vec<[f64; 2]> {
        let (mut x, mut y) = (0.0, 0.0);
        let place = |(key, name): &(Key, String)| {
            let length = key.width() + width_of(name, SMALL);
            if x > 0.0 && x + length > room {
                (x, y) = (0.0, y + ROW);
            }
            let place = [x, y];
            x += length + GAP;
            place
        };
        self.entries.iter().map(place).collect()
    }

    pub(super) fn height(&self, room: f64) -> f64 {
        self.places(room).last().map_or(0.0, |place| place[1] + ROW + 2.0)
    }

    pub(super) fn draw(&self, scene: &mut Scene, at: [f64; 2], room: f64) {
        for ((key, name), place) in self.entries.iter().zip(self.places(room)) {
            let [x, y] = [at[0] + place[0], at[1] + place[1] + ROW / 2.0];
            match *key {
                Key::Box(colour) => {
                    let edge = Rect { x, y: y - 3.5, width: 7.0, height: 7.0 };
                    scene.rect(edge, Some(colour), Some(THIN));
                }
                Key::Line(stroke, shape) => {
                    scene.line(&[[x, y], [x + 17.0, y]], stroke);
                    if let Some(shape) = shape {
                        marker(scene, [x + 8.5, y], shape, stroke.colour);
                    }
                }
                Key::Marker(colour, shape) => marker(scene, [x + 4.0, y], shape, colour),
                Key::Arrow(colour) => arrow(scene, [[x, y], [x + 13.0, y]], Stroke::new(colour, 1.0), 4.0),
                Key::Cross => cross(scene, [x + 4.0, y]),
                Key::Nothing => {}
            }
            scene.text(name, [x + key.width(), y], SMALL, Anchor::Start);
        }
    }
}

/// A marker of the first, second or third shape.
pub(super) fn marker(scene: &mut Scene, [x, y]: [f64; 2], shape: usize, colour: Rgb) {
    let about = |corners: &[[f64; 2]]| corners.iter().map(|c| [x + c[0], y + c[1]]).collect::<Vec<_>>();
    match shape % 3 {
        0 => scene.circle([x, y], 2.2, colour),
        1 => scene.polygon(&about(&[[-2.0, -2.0], [2.0, -2.0], [2.0, 2.0], [-2.0, 2.0]]), colour),
        _ => scene.polygon(&about(&[[0.0, -2.6], [2.5, 2.0], [-2.5, 2.0]]), colour),
    }
}

/// An arrow from the first to the second point.
pub(super) fn arrow(scene: &mut Scene, [from, to]: [[f64; 2]; 2], stroke: Stroke, head: f64) {
    let along = [to[0] - from[0], to[1] - from[1]];
    let length = along[0].hypot(along[1]);
    if length > 0.0 {
        let [ux, uy] = along.map(|v| v / length);
        let head = head.min(length);
        let neck = [to[0] - head * ux, to[1] - head * uy];
        scene.line(&[from, neck], stroke);
        let half = 0.4 * head;
        let sides = [1.0, -1.0].map(|s| [neck[0] - s * half * uy, neck[1] + s * half * ux]);
        scene.polygon(&[to, sides[0], sides[1]], stroke.colour);
    }
}

/// A cross that is seen on any colour.
pub(super) fn cross(scene: &mut Scene, [x, y]: [f64; 2]) {
    const ARM: f64 = 3.5;
    let lines =
        vec![vec![[x - ARM, y - ARM], [x + ARM, y + ARM]], vec![[x - ARM, y + ARM], [x + ARM, y - ARM]]];
    for (colour, width) in [(PAPER, 2.6), (INK, 1.1)] {
        scene.lines(lines.clone(), Stroke::new(colour, width));
    }
}
