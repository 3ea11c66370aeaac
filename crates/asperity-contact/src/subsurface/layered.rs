//! A stress given at several depths.

use crate::grid::Field;
use crate::units::Metre;

/// A stress given at several depths, linear between them: the residual stress of plastic strain.
#[derive(Debug, Clone, PartialEq)]
pub struct LayeredStress {
    /// The depths, ascending.
    depths: Vec<Metre>,
    /// The components at each depth, in the order of [`crate::stress::Component::ALL`], Pa.
    planes: Vec<[Field; 6]>,
}

impl LayeredStress {
    /// Creates the stress with these components at the `depths`, ascending. Above the first it is
    /// extrapolated linearly, below the last it is constant.
    ///
    /// # Panics
    /// If there are no depths, or if their number differs from that of the planes.
    pub fn new(depths: Vec<Metre>, planes: Vec<[Field; 6]>) -> Self {
        assert!(!depths.is_empty() && depths.len() == planes.len(), "a plane at each depth");
        Self { depths, planes }
    }

    /// Returns the components at a depth.
    pub fn components(&self, depth: Metre) -> [Field; 6] {
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
            let found = stress.components(depth);
            assert_eq!((found[0][[0, 1]], found[5][[0, 0]]), (expected, expected + 5.0), "{depth}");
        }
        assert_eq!(LayeredStress::new(vec![1.0], vec![plane(3.0)]).components(0.2)[0][[0, 0]], 3.0);
    }
}
