//! Transmissibilities of the faces between cells, and the networks that they form.

use asperity_base::choice::choice;

/// Rule that gives the transmissibility of the face between two cells from their gaps.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Faces {
    /// 2 g₁² g₂²/(g₁ + g₂): exact in series for a gap that is linear between the centres of the cells.
    #[default]
    Linear,
    /// 2 k₁ k₂/(k₁ + k₂) with k = g³: exact in series for a gap that is constant in each cell.
    Harmonic,
}

choice!(Faces: "linear" => Linear, "harmonic" => Harmonic);

impl Faces {
    /// Returns the mean permeability of two neighbouring cells with the gaps `a` and `b`, 0 beside a closed
    /// cell.
    ///
    /// Both rules are written with the ratio of the gaps, so that nothing underflows before the result does.
    pub fn mean(self, a: f64, b: f64) -> f64 {
        let (small, large) = if a < b { (a, b) } else { (b, a) };
        if small <= 0.0 {
            return 0.0;
        }
        let ratio = small / large;
        match self {
            Self::Linear => 2.0 * small * small * large / (1.0 + ratio),
            Self::Harmonic => 2.0 * small * small * small / (1.0 + ratio * ratio * ratio),
        }
    }
}

/// The grid and what lies beyond its edges.
#[derive(Clone, Copy)]
pub(super) struct Topology {
    /// Number of cells along x and y.
    pub(super) shape: [usize; 2],
    /// Whether nothing flows from the last cells along an axis to the first ones.
    pub(super) closed: [bool; 2],
    /// The axis with a reservoir at both ends.
    pub(super) between: Option<usize>,
}

/// Cells, joined by faces with a transmissibility each: permeability × length/distance.
pub(super) struct Network {
    /// Number of cells along x and y.
    pub(super) shape: [usize; 2],
    /// Transmissibility of the face before each cell along x and along y. The face before the first cell
    /// joins it to the last one.
    pub(super) faces: [Vec<f64>; 2],
    /// Reservoirs at the ends of an axis.
    pub(super) ends: Option<EndFaces>,
}

/// Transmissibilities to the two reservoirs, one for each cell of the first and of the last row across the
/// axis.
pub(super) struct EndFaces {
    /// The axis along which the reservoirs differ.
    pub(super) axis: usize,
    /// From the reservoir at the start of the axis, and to the one at its end.
    pub(super) transmissibility: [Vec<f64>; 2],
}

impl Network {
    /// Creates the network of these gaps, flat and scaled, on cells of size `pitch`.
    pub(super) fn new(
        gaps: &[f64],
        pitch: [f64; 2],
        rule: Faces,
        Topology { shape, closed, between }: Topology,
    ) -> Self {
        let ratio = [pitch[1] / pitch[0], pitch[0] / pitch[1]];
        let faces = [0, 1].map(|axis| {
            let face = |cell: usize| match before(shape, cell, axis) {
                (_, true) if closed[axis] => 0.0,
                (before, _) => ratio[axis] * rule.mean(gaps[before], gaps[cell]),
            };
            (0..shape[0] * shape[1]).map(face).collect()
        });
        let ends = between.map(|axis| {
            let row = |index: usize| {
                end_cells(shape, axis, index)
                    .map(|cell| 2.0 * ratio[axis] * rule.mean(gaps[cell], gaps[cell]))
            };
            EndFaces { axis, transmissibility: [row(0).collect(), row(shape[axis] - 1).collect()] }
        });
        Self { shape, faces, ends }
    }

    /// Number of cells.
    pub(super) fn cells(&self) -> usize {
        self.shape[0] * self.shape[1]
    }

    /// Returns the cell before `cell` along `axis`, and whether a period lies between them.
    pub(super) fn before(&self, cell: usize, axis: usize) -> (usize, bool) {
        before(self.shape, cell, axis)
    }
}

/// Returns the cell before `cell` along `axis`, and whether a period lies between them.
pub(super) fn before([nx, ny]: [usize; 2], cell: usize, axis: usize) -> (usize, bool) {
    match axis {
        0 if cell >= ny => (cell - ny, false),
        0 => (cell + (nx - 1) * ny, true),
        _ if !cell.is_multiple_of(ny) => (cell - 1, false),
        _ => (cell + ny - 1, true),
    }
}

/// Returns the flat cells with this `index` along `axis`.
pub(super) fn end_cells([nx, ny]: [usize; 2], axis: usize, index: usize) -> impl Iterator<Item = usize> {
    let (first, step, count) = if axis == 0 { (index * ny, 1, ny) } else { (index, ny, nx) };
    (0..count).map(move |k| first + k * step)
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_relative_eq;

    #[test]
    fn a_linear_gap_resists_as_its_integral() {
        let (a, b) = (0.3, 1.1);
        let steps = 100_000;
        let resistance: f64 =
            (0..steps).map(|i| (a + (b - a) * (i as f64 + 0.5) / steps as f64).powi(-3) / steps as f64).sum();
        assert_relative_eq!(Faces::Linear.mean(a, b), 1.0 / resistance, max_relative = 1e-8);
        assert_relative_eq!(
            Faces::Harmonic.mean(a, b),
            2.0 / (a.powi(-3) + b.powi(-3)),
            max_relative = 1e-15
        );
    }

    #[test]
    fn equal_cells_have_their_own_permeability_and_closed_ones_none() {
        for rule in [Faces::Linear, Faces::Harmonic] {
            assert_relative_eq!(rule.mean(0.7, 0.7), 0.343, max_relative = 1e-15);
            assert_eq!((rule.mean(0.0, 1.0), rule.mean(1.0, -1.0)), (0.0, 0.0));
            assert_eq!(rule.mean(0.2, 0.9), rule.mean(0.9, 0.2));
            assert!(rule.mean(1e-80, 1.0) > 0.0);
        }
    }
}
