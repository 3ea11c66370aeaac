//! Layers of the plastic volume.

use crate::error::{Result, check, check_in};
use crate::units::{Dimension, Metre};

/// Layers parallel to the surface, from the surface down to a depth. The plastic strain of a cell is uniform
/// in each layer.
#[derive(Debug, Clone, PartialEq)]
pub struct Layers {
    /// Depths of their faces, from 0; one more than layers.
    faces: Vec<Metre>,
}

/// Largest number of layers.
pub const MAX_LAYERS: usize = 512;

impl Layers {
    /// Creates `count` layers down to a `depth`, each `growth` times as thick as the one above it.
    ///
    /// # Errors
    /// [`crate::Error::OutOfRange`] if the depth is not positive and finite, if there are none or more than
    /// 512 layers, or if the growth is not within 1 … 2.
    pub fn new(depth: Metre, count: usize, growth: f64) -> Result<Self> {
        let positive = depth > 0.0 && depth.is_finite();
        check_in(Dimension::Length, "depth", depth, positive, "a finite depth above 0")?;
        check("layers", count as f64, (1..=MAX_LAYERS).contains(&count), "1 … 512 layers")?;
        check(
            "growth",
            growth,
            (1.0..=2.0).contains(&growth),
            "a growth of thickness from layer to layer of 1 … 2",
        )?;
        let mut thickness = 1.0;
        let mut faces = vec![0.0];
        for layer in 0..count {
            faces.push(faces[layer] + thickness);
            thickness *= growth;
        }
        let scale = depth / faces[count];
        faces.iter_mut().for_each(|face| *face *= scale);
        faces[count] = depth;
        Ok(Self { faces })
    }

    /// Creates the layers between `faces`, which begin at 0 and increase.
    ///
    /// # Errors
    /// [`crate::Error::OutOfRange`] if they do not, or if there are more than 512 layers.
    pub fn between(faces: &[Metre]) -> Result<Self> {
        let count = faces.len().saturating_sub(1);
        check("layers", count as f64, (1..=MAX_LAYERS).contains(&count), "1 … 512 layers")?;
        check_in(
            Dimension::Length,
            "first face",
            faces[0],
            faces[0] == 0.0,
            "a first face on the surface, at 0",
        )?;
        let low = faces.windows(2).find(|pair| !(pair[0] < pair[1] && pair[1].is_finite()));
        let grow = "faces of layers at increasing depths";
        low.map_or(Ok(()), |pair| check_in(Dimension::Length, "face", pair[1], false, grow))?;
        Ok(Self { faces: faces.to_vec() })
    }

    /// Number of layers.
    pub fn count(&self) -> usize {
        self.faces.len() - 1
    }

    /// Depths of their faces, from 0; one more than layers.
    pub fn faces(&self) -> &[Metre] {
        &self.faces
    }

    /// Depth of the lowest face.
    pub fn depth(&self) -> Metre {
        self.faces[self.count()]
    }

    /// Thickness of a layer.
    ///
    /// # Panics
    /// If there is no such layer.
    pub fn thickness(&self, layer: usize) -> Metre {
        self.faces[layer + 1] - self.faces[layer]
    }

    /// Depth of the middle of a layer.
    ///
    /// # Panics
    /// If there is no such layer.
    pub fn centre(&self, layer: usize) -> Metre {
        0.5 * (self.faces[layer] + self.faces[layer + 1])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn they_grow_and_end_at_the_depth() {
        let layers = Layers::new(20e-6, 16, 1.1).unwrap();
        assert_eq!((layers.count(), layers.faces()[0], layers.depth()), (16, 0.0, 20e-6));
        for layer in 1..16 {
            let ratio = layers.thickness(layer) / layers.thickness(layer - 1);
            assert_relative_eq!(ratio, 1.1, max_relative = 1e-12);
        }
        assert_eq!(Layers::new(4.0, 4, 1.0).unwrap().faces(), [0.0, 1.0, 2.0, 3.0, 4.0]);
        assert_eq!(Layers::new(4.0, 4, 1.0).unwrap().centre(2), 2.5);
        assert_eq!(Layers::between(&[0.0, 1.0, 3.0]).unwrap().thickness(1), 2.0);
    }

    #[test]
    fn layers_without_meaning_are_refused() {
        for (depth, count, growth) in
            [(0.0, 4, 1.0), (f64::NAN, 4, 1.0), (1.0, 0, 1.0), (1.0, 513, 1.0), (1.0, 4, 0.9), (1.0, 4, 2.1)]
        {
            assert!(Layers::new(depth, count, growth).is_err(), "{depth} {count} {growth}");
        }
        for faces in [&[0.0][..], &[], &[1.0, 2.0], &[0.0, 1.0, 1.0], &[0.0, f64::NAN], &[0.0, f64::INFINITY]]
        {
            assert!(Layers::between(faces).is_err(), "{faces:?}");
        }
    }
}
