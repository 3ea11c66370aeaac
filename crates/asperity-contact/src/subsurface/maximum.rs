//! Search for the most stressed point.

use super::{Plane, Subsurface};
use crate::units::{Metre, Pascal};

/// A largest value and its place.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Extreme {
    /// The value.
    pub value: Pascal,
    /// The cell of the most stressed point.
    pub cell: [usize; 2],
    /// The depth of the most stressed point.
    pub depth: Metre,
}

/// The largest stresses on some planes.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub struct Maximum {
    /// Von Mises' stress.
    pub von_mises: Extreme,
    /// The largest shear stress on any plane, ½(σ₁ − σ₃).
    pub shear: Extreme,
}

impl Plane {
    /// Returns the largest stresses on the plane; the first of equal ones.
    pub fn maximum(&self) -> Maximum {
        let none = Extreme { value: 0.0, cell: [0, 0], depth: self.depth };
        let mut most = Maximum { von_mises: none, shear: none };
        let von_mises = self.von_mises();
        for ((i, j), &value) in von_mises.indexed_iter() {
            let here = |value| Extreme { value, cell: [i, j], depth: self.depth };
            if value > most.von_mises.value {
                most.von_mises = here(value);
            }
            // The largest shear is at most 1/√3 of von Mises' stress, so that it is not needed elsewhere.
            if value > 3f64.sqrt() * most.shear.value {
                let shear = self.stress([i, j]).max_shear();
                if shear > most.shear.value {
                    most.shear = here(shear);
                }
            }
        }
        most
    }
}

impl Subsurface {
    /// Returns the largest stresses on planes, each with its layer, and on a few more near the most stressed one.
    pub(super) fn refined(&self, planes: &mut [(usize, Maximum)]) -> Maximum {
        /// Number of refinements, each with a smaller depth interval around the largest stress so far.
        const REFINEMENTS: usize = 4;
        let mut most = planes.iter().map(|(_, plane)| *plane).reduce(Maximum::or).expect("there are depths");
        planes.sort_by(|(a, one), (b, other)| {
            one.von_mises.depth.total_cmp(&other.von_mises.depth).then(a.cmp(b))
        });
        let Some((layer, mut around)) = self.bracket(planes, &mut most) else { return most };
        for _ in 0..REFINEMENTS {
            let cell = most.von_mises.cell;
            let Some(depth) = vertex(around.each_ref().map(|p| [p.depth, p.stress(cell).von_mises()])) else {
                break;
            };
            let plane = self.plane_in(layer, depth);
            let found = plane.maximum();
            around = narrowed(around, plane, found.von_mises.value > most.von_mises.value);
            most = most.or(found);
        }
        most
    }

    /// Returns three planes in a layer, and the layer, with the most stressed one in the middle; `None` at the ends of the
    /// planes. Beside an interface it is looked for halfway to the next plane.
    fn bracket(&self, planes: &[(usize, Maximum)], most: &mut Maximum) -> Option<(usize, [Plane; 3])> {
        let depth = |k: usize| planes[k].1.von_mises.depth;
        let at_most = most.von_mises.depth;
        let mut best = None;
        for k in (1..planes.len() - 1).filter(|k| depth(*k) == at_most) {
            let layer = planes[k].0;
            let plane = |depth: Metre| self.plane_in(layer, depth);
            let inside =
                [k - 1, k + 1].map(|beside| Some(beside).filter(|beside| planes[*beside].0 == layer));
            let beside = match inside {
                [Some(above), Some(below)] => {
                    return Some((layer, [depth(above), at_most, depth(below)].map(plane)));
                }
                [above, below] => above.or(below),
            };
            let Some(beside) = beside else { continue };
            let middle = plane(0.5 * (at_most + depth(beside)));
            let found = middle.maximum();
            if found.von_mises.value > most.von_mises.value {
                *most = most.or(found);
                let [above, below] = [at_most.min(depth(beside)), at_most.max(depth(beside))].map(plane);
                best = Some((layer, [above, middle, below]));
            }
        }
        best
    }
}

/// Returns the vertex of the parabola through three points [depth, stress], the middle one the highest;
/// `None` if it is the middle one.
fn vertex([[above, a], [middle, m], [below, b]]: [[f64; 2]; 3]) -> Option<Metre> {
    let (up, down, rise, fall) = (middle - above, below - middle, m - a, m - b);
    let shift = 0.5 * (down * down * rise - up * up * fall) / (down * rise + up * fall);
    (shift.is_finite() && shift != 0.0).then_some(middle + shift)
}

/// Returns the planes beside the most stressed one after adding `plane`; `most` is whether that is now the
/// most stressed.
fn narrowed([above, middle, below]: [Plane; 3], plane: Plane, most: bool) -> [Plane; 3] {
    match (plane.depth < middle.depth, most) {
        (true, true) => [above, plane, middle],
        (true, false) => [plane, middle, below],
        (false, true) => [middle, plane, below],
        (false, false) => [above, middle, plane],
    }
}

impl Extreme {
    /// Returns the larger one; the first of equal ones.
    pub(super) fn or(self, other: Self) -> Self {
        if other.value > self.value { other } else { self }
    }
}

impl Maximum {
    /// Returns the larger of each; the first of equal ones.
    pub(super) fn or(self, other: Self) -> Self {
        Self { von_mises: self.von_mises.or(other.von_mises), shear: self.shear.or(other.shear) }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::grid::Grid;
    use crate::operator::Boundary;
    use crate::reference::{HertzSphere, SlidingSphere};
    use crate::subsurface::Tractions;
    use std::f64::consts::PI;

    /// a = p₀ = 1, on a side of 24 cells, 16 of which are in contact.
    fn sphere(friction: f64) -> (Subsurface, SlidingSphere) {
        let normal = HertzSphere { radius: 1.0, modulus: PI / 2.0, load: 2.0 * PI / 3.0 };
        let contact = SlidingSphere { normal, friction, poisson: 0.3 };
        let grid = Grid::new([25, 25], [0.125; 2]).unwrap();
        let pressure = crate::Field::from_shape_fn(grid.shape, |(i, j)| {
            normal.pressure(0.125 * (i as f64 - 12.0).hypot(j as f64 - 12.0))
        });
        let tractions = Tractions { shear: [Some(friction * &pressure), None], pressure };
        (Subsurface::new(grid, Boundary::FREE, 0.3, &tractions), contact)
    }

    #[test]
    fn the_parabolas_find_the_depth_between_coarse_planes() {
        let (body, _) = sphere(0.0);
        let fine: Vec<f64> = (440..520).map(|k| 1e-3 * f64::from(k)).collect();
        let exact = body.planes(&fine, |plane| plane.maximum()).into_iter().reduce(Maximum::or).unwrap();
        let most = body.maximum(&[0.0, 0.3, 0.6, 0.9, 1.5]);
        assert_eq!((most.von_mises.cell, most.shear.cell), ([12, 12], [12, 12]));
        let [depth, found] = [exact, most].map(|most| most.von_mises.depth);
        assert!((depth - 0.481).abs() < 0.01 && (found - depth).abs() < 3e-3, "{found}, {depth}");
        assert!((most.von_mises.value / exact.von_mises.value - 1.0).abs() < 1e-5);
        assert!((most.shear.value / exact.shear.value - 1.0).abs() < 1e-5);
        // It is a value of the body at that place.
        assert_eq!(body.plane(found).stress([12, 12]).von_mises(), most.von_mises.value);
    }

    #[test]
    fn the_vertex_of_a_parabola_is_exact() {
        let at = |z: f64| [z, 3.0 - 2.0 * (z - 0.3).powi(2)];
        assert!((vertex([at(-1.0), at(0.1), at(0.8)]).unwrap() - 0.3).abs() < 1e-15);
        assert_eq!(vertex([[0.0, 1.0], [1.0, 1.0], [2.0, 1.0]]), None);
    }

    #[test]
    fn it_is_the_largest_of_all_cells_and_depths() {
        let (body, _) = sphere(0.3);
        let depths = [0.1, 0.2, 0.4, 0.8];
        let most = body.maximum(&depths);
        for plane in body.planes(&depths, |plane| plane) {
            for cell in ndarray::indices(body.grid().shape) {
                let here = plane.stress([cell.0, cell.1]);
                assert!(here.von_mises() <= most.von_mises.value && here.max_shear() <= most.shear.value);
            }
        }
    }

    #[test]
    fn with_much_friction_it_lies_on_the_surface_where_no_parabola_is_tried() {
        let (body, contact) = sphere(0.6);
        let most = body.maximum(&[0.0, 0.2, 0.4]).von_mises;
        assert_eq!(most.depth, 0.0);
        let [x, y] = most.cell.map(|i| 0.125 * (i as f64 - 12.0));
        assert!((most.value / contact.stress([x, y], 0.0).von_mises() - 1.0).abs() < 0.1, "{most:?}");
        // At large depths the first plane is the most stressed.
        assert_eq!(body.maximum(&[2.0, 3.0, 4.0]).von_mises.depth, 2.0);
    }
}
