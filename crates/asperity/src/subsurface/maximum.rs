//! Where the material is stressed the most.

use super::{Plane, Subsurface};
use crate::units::{Metre, Pascal};

/// The largest value of something, and where.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Extreme {
    /// The value.
    pub value: Pascal,
    /// Its cell.
    pub cell: [usize; 2],
    /// Its depth.
    pub depth: Metre,
}

/// The largest stresses of some planes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Maximum {
    /// Von Mises' stress.
    pub von_mises: Extreme,
    /// The largest shear stress on any plane, ½(σ₁ − σ₃).
    pub shear: Extreme,
}

impl Plane {
    /// The largest stresses on the plane; of equal ones the first.
    pub fn maximum(&self) -> Maximum {
        let none = Extreme { value: 0.0, cell: [0, 0], depth: self.depth };
        let mut most = Maximum { von_mises: none, shear: none };
        let von_mises = self.von_mises();
        for ((i, j), &value) in von_mises.indexed_iter() {
            let here = |value| Extreme { value, cell: [i, j], depth: self.depth };
            if value > most.von_mises.value {
                most.von_mises = here(value);
            }
            // The largest shear is at most 1/√3 of von Mises' stress: elsewhere it need not be known.
            if value > 3f64.sqrt() * most.shear.value {
                let shear = self.at([i, j]).max_shear();
                if shear > most.shear.value {
                    most.shear = here(shear);
                }
            }
        }
        most
    }
}

impl Subsurface {
    /// The largest stresses on planes at the `depths`, ascending, and on one more: that at which a parabola through the
    /// depth of the largest von Mises stress and the two beside it has its vertex. Each value is that of a cell at a
    /// depth, not of the parabola.
    ///
    /// # Panics
    /// If there are no depths.
    pub fn maximum(&self, depths: &[Metre]) -> Maximum {
        let planes = self.planes(depths, |plane| plane.maximum());
        let first_of =
            |planes: &[Maximum]| planes.iter().copied().reduce(Maximum::or).expect("there are depths");
        let coarse = first_of(&planes);
        match self.vertex(&coarse.von_mises, depths) {
            Some(depth) => coarse.or(self.plane(depth).maximum()),
            None => coarse,
        }
    }

    /// Where the parabola through the von Mises stresses of the cell of `most` at its depth and those beside it is
    /// largest; none at the ends of the depths.
    fn vertex(&self, most: &Extreme, depths: &[Metre]) -> Option<Metre> {
        let k = depths.iter().position(|depth| *depth == most.depth)?;
        let [above, below] = [k.checked_sub(1)?, k + 1].map(|k| depths.get(k).copied());
        let at = |depth: Metre| self.plane(depth).at(most.cell).von_mises();
        let (up, down) = (most.depth - above?, below? - most.depth);
        let (rise, fall) = (most.value - at(above?), most.value - at(below?));
        let shift = 0.5 * (down * down * rise - up * up * fall) / (down * rise + up * fall);
        shift.is_finite().then_some(most.depth + shift)
    }
}

impl Maximum {
    /// The larger of each; of equal ones the first.
    fn or(self, other: Self) -> Self {
        let larger = |a: Extreme, b: Extreme| if b.value > a.value { b } else { a };
        Self { von_mises: larger(self.von_mises, other.von_mises), shear: larger(self.shear, other.shear) }
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

    /// a = p₀ = 1, on 24 cells a side of which 16 are in contact.
    fn sphere(friction: f64) -> (Subsurface, SlidingSphere) {
        let normal = HertzSphere { radius: 1.0, modulus: PI / 2.0, load: 2.0 * PI / 3.0 };
        let contact = SlidingSphere { normal, friction, poisson: 0.3 };
        let grid = Grid::new([25, 25], [0.125; 2]).unwrap();
        let pressure = crate::Field::from_shape_fn(grid.shape, |(i, j)| {
            normal.pressure(0.125 * (i as f64 - 12.0).hypot(j as f64 - 12.0))
        });
        let tractions = Tractions { shear: [Some(friction * &pressure), None], pressure };
        (Subsurface::new(grid, Boundary::Free, 0.3, &tractions), contact)
    }

    #[test]
    fn the_parabola_finds_the_depth_between_coarse_planes() {
        let (body, _) = sphere(0.0);
        let most = body.maximum(&[0.0, 0.3, 0.6, 0.7, 1.5]);
        assert_eq!((most.von_mises.cell, most.shear.cell), ([12, 12], [12, 12]));
        assert!((most.von_mises.depth - 0.481).abs() < 0.03, "{most:?}");
        assert!(
            (most.von_mises.value - 0.6200).abs() < 2e-3 && (most.shear.value - 0.31).abs() < 1e-3,
            "{most:?}"
        );
        // It is a value that the body has there.
        let there = body.plane(most.von_mises.depth).at([12, 12]);
        assert_eq!(there.von_mises(), most.von_mises.value);
    }

    #[test]
    fn it_is_the_largest_of_all_cells_and_depths() {
        let (body, _) = sphere(0.3);
        let depths = [0.1, 0.2, 0.4, 0.8];
        let most = body.maximum(&depths);
        for plane in body.planes(&depths, |plane| plane) {
            for cell in ndarray::indices(body.grid().shape) {
                let here = plane.at([cell.0, cell.1]);
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
        // Deep below, the first plane is the most stressed.
        assert_eq!(body.maximum(&[2.0, 3.0, 4.0]).von_mises.depth, 2.0);
    }
}
