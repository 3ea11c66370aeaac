//! A rectangle with axes: ticks, numbers, names.

use super::axis::Scale;
use super::scene::{Anchor, INK, Rect, Scene, Stroke};
use super::text::{MEDIUM, SMALL};

/// Length of a tick, pt.
const TICK: f64 = 3.0;
/// Between a tick and its number, and between numbers and a name, pt.
const GAP: f64 = 2.5;
/// A thin line.
pub(super) const THIN: Stroke = Stroke { colour: INK, width: 0.6, dashed: false };

/// Height of what stands below a frame: ticks, numbers and a name, pt.
pub(super) const BELOW: f64 = TICK + 2.0 * GAP + SMALL + MEDIUM + 3.0;

/// Width of what stands beside an axis: ticks, numbers and a name, pt.
pub(super) fn beside(scale: &Scale) -> f64 {
    TICK + 2.0 * GAP + scale.width() + MEDIUM + 3.0
}

/// The axes around a rectangle.
pub(super) struct Frame<'a> {
    pub(super) at: Rect,
    pub(super) x: &'a Scale,
    pub(super) y: &'a Scale,
    /// y runs downwards.
    pub(super) down: bool,
}

/// Where the axis of y has its numbers.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) enum Side {
    Left,
    Right,
}

impl Frame<'_> {
    /// Where a point in SI lies; `None` if the axes cannot show it.
    pub(super) fn place(&self, [x, y]: [f64; 2]) -> Option<[f64; 2]> {
        Some(self.at([self.x.share(x)?, self.y.share(y)?]))
    }

    /// Where shares of the axes lie.
    fn at(&self, [x, y]: [f64; 2]) -> [f64; 2] {
        let down = if self.down { y } else { 1.0 - y };
        [self.at.x + x * self.at.width, self.at.y + down * self.at.height]
    }

    /// Whether a place is within the frame.
    pub(super) fn holds(&self, [x, y]: [f64; 2]) -> bool {
        let Rect { x: left, y: top, .. } = self.at;
        let slack = 0.01;
        (left - slack..=self.at.right() + slack).contains(&x)
            && (top - slack..=self.at.bottom() + slack).contains(&y)
    }

    /// Draws the mesh.
    pub(super) fn mesh(&self, scene: &mut Scene) {
        let [strong, weak] = [[222; 3], [240; 3]].map(|colour| Stroke::new(colour, 0.5));
        let across =
            |scene: &mut Scene, x: f64, stroke| scene.line(&[self.at([x, 0.0]), self.at([x, 1.0])], stroke);
        let along =
            |scene: &mut Scene, y: f64, stroke| scene.line(&[self.at([0.0, y]), self.at([1.0, y])], stroke);
        self.x.minor.iter().for_each(|x| across(scene, *x, weak));
        self.y.minor.iter().for_each(|y| along(scene, *y, weak));
        self.x.ticks.iter().for_each(|(x, _)| across(scene, *x, strong));
        self.y.ticks.iter().for_each(|(y, _)| along(scene, *y, strong));
    }

    /// Draws the edge and the axis of x with its name.
    pub(super) fn edge(&self, scene: &mut Scene, name: &str) {
        scene.rect(self.at, None, Some(THIN));
        let bottom = self.at.bottom();
        for (share, label) in &self.x.ticks {
            let x = self.at.x + share * self.at.width;
            scene.line(&[[x, bottom], [x, bottom + TICK]], THIN);
            scene.text(label, [x, bottom + TICK + GAP + SMALL / 2.0], SMALL, Anchor::Middle);
        }
        let y = bottom + TICK + 2.0 * GAP + SMALL + MEDIUM / 2.0;
        scene.text(name, [self.at.middle()[0], y], MEDIUM, Anchor::Middle);
    }

    /// Draws an axis of y with its name.
    pub(super) fn side(&self, scene: &mut Scene, scale: &Scale, name: &str, side: Side) {
        let (edge, out, anchor) = match side {
            Side::Left => (self.at.x, -1.0, Anchor::End),
            Side::Right => (self.at.right(), 1.0, Anchor::Start),
        };
        for (share, label) in &scale.ticks {
            let [_, y] = self.at([0.0, *share]);
            scene.line(&[[edge, y], [edge + out * TICK, y]], THIN);
            scene.text(label, [edge + out * (TICK + GAP), y], SMALL, anchor);
        }
        let x = edge + out * (TICK + 2.0 * GAP + scale.width() + MEDIUM / 2.0);
        scene.upright(name, [x, self.at.middle()[1]], MEDIUM);
    }
}
