//! A stress that is known in layers.

use crate::grid::Field;
use crate::units::Metre;

/// A stress that is known at some depths, and between them by straight lines: that which plastic flow has left.
#[derive(Debug, Clone, PartialEq)]
pub struct LayeredStress {
    /// The depths, ascending.
    depths: Vec<Metre>,
    /// The components at each of them, in the order of [`crate::stress::Component::ALL`], Pa.
    planes: Vec<[Field; 6]>,
}

impl LayeredStress {
    /// The stress that has these components at the `depths`, ascending; above the first it goes on straight, below the last it
    /// stays.
    ///
    /// # Panics
    /// If there are none, or not as many planes.
    pub fn new(depths: Vec<Metre>, planes: Vec<[Field; 6]>) -> Self {
        assert!(!depths.is_empty() && depths.len() == planes.len(), "a plane at each depth");
        Self { depths, planes }
    }

    /// The components at a depth.
    pub fn at(&self, depth: Metre) -> [Field; 6] {
        let last = self.depths.len() - 1;
        let below =
            self.depths.iter().position(|known| *known > depth).unwrap_or(last).clamp(1.min(last), last);
        if last == 0 || depth >= self.depths[last] {
            return self.planes[last].clone();
        }
        let above = below - 1;
        let share = (depth - self.depths[above]) / (self.depths[below] - self.depths[above]);
        let between = |c: usize| &self.planes[above][c] * (1.0 - share) + &self.planes[below][c] * share;
        std::array::from_fn(between)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn between_its_depths_it_is_straight() {
        let plane = |value: f64| std::array::from_fn(|c| Field::from_elem([1, 2], value + c as f64));
        let stress = LayeredStress::new(vec![1.0, 2.0, 4.0], vec![plane(10.0), plane(20.0), plane(60.0)]);
        for (depth, expected) in
            [(1.0, 10.0), (1.5, 15.0), (2.0, 20.0), (3.0, 40.0), (0.0, 0.0), (4.0, 60.0), (9.0, 60.0)]
        {
            let found = stress.at(depth);
            assert_eq!((found[0][[0, 1]], found[5][[0, 0]]), (expected, expected + 5.0), "{depth}");
        }
        assert_eq!(LayeredStress::new(vec![1.0], vec![plane(3.0)]).at(0.2)[0][[0, 0]], 3.0);
    }
}
