//! Heights and their neighbourhood.

use crate::Topography;
use asperity_base::grid::Grid;

/// Heights in a flat list, surrounded by undefined samples, so that each sample has eight neighbours. A
/// sample is identified by its index, the cell.
pub(super) struct Relief {
    /// Heights, with the sign for which hills rise; NaN if undefined.
    pub(super) z: Vec<f64>,
    grid: Grid,
    /// Index steps from a cell to its neighbours, with their distances.
    steps: [(isize, f64); 8],
}

impl Relief {
    /// Creates the relief from the heights of `topography` times `up`.
    pub(super) fn new(topography: &Topography, up: f64) -> Self {
        let grid = *topography.grid();
        let width = (grid.shape[1] + 2) as isize;
        let [along, across] = [(width, grid.pitch[0]), (1, grid.pitch[1])];
        let diagonal = grid.pitch[0].hypot(grid.pitch[1]);
        let steps = [
            (-along.0, along.1),
            (-across.0, across.1),
            (across.0, across.1),
            (along.0, along.1),
            (-along.0 - across.0, diagonal),
            (-along.0 + across.0, diagonal),
            (along.0 - across.0, diagonal),
            (along.0 + across.0, diagonal),
        ];
        let frame = (grid.shape[0] + 2) * (grid.shape[1] + 2);
        let mut relief = Self { z: vec![f64::NAN; frame], grid, steps };
        for ((ix, iy), z) in topography.heights().indexed_iter() {
            let cell = relief.cell(ix, iy);
            // 0 in place of −0, so that equal heights have one order.
            relief.z[cell] = up * z + 0.0;
        }
        relief
    }

    /// Cell of a sample.
    pub(super) fn cell(&self, ix: usize, iy: usize) -> usize {
        (ix + 1) * (self.grid.shape[1] + 2) + iy + 1
    }

    /// Sample of a cell.
    pub(super) fn sample(&self, cell: usize) -> [usize; 2] {
        let width = self.grid.shape[1] + 2;
        [cell / width - 1, cell % width - 1]
    }

    /// Iterates over the cells of all samples, in order.
    pub(super) fn samples(&self) -> impl Iterator<Item = usize> {
        let [nx, ny] = self.grid.shape;
        (0..nx).flat_map(move |ix| (0..ny).map(move |iy| self.cell(ix, iy)))
    }

    /// Iterates over the neighbours of a cell.
    pub(super) fn neighbours(&self, cell: usize) -> impl Iterator<Item = usize> {
        self.steps.map(|(step, _)| cell.wrapping_add_signed(step)).into_iter()
    }

    /// Returns the neighbour with the steepest ascent among those accepted by `admit`; the first of equals.
    pub(super) fn steepest(&self, cell: usize, mut admit: impl FnMut(usize) -> bool) -> Option<usize> {
        let mut best = None;
        let mut steepest = f64::NEG_INFINITY;
        for (step, distance) in self.steps {
            let neighbour = cell.wrapping_add_signed(step);
            let slope = (self.z[neighbour] - self.z[cell]) / distance;
            if slope > steepest && admit(neighbour) {
                (best, steepest) = (Some(neighbour), slope);
            }
        }
        best
    }

    /// −½ (∂²z/∂x² + ∂²z/∂y²) by second differences.
    pub(super) fn curvature(&self, cell: usize) -> f64 {
        let second = |axis: usize, step: usize| match self.grid.shape[axis] {
            1 => 0.0,
            _ => {
                (self.z[cell + step] - 2.0 * self.z[cell] + self.z[cell - step])
                    / self.grid.pitch[axis].powi(2)
            }
        };
        -0.5 * (second(0, self.grid.shape[1] + 2) + second(1, 1))
    }

    /// Returns the cells beside the frame, or beside undefined samples connected to it. Along a direction
    /// with one sample there is no frame.
    pub(super) fn rim(&self) -> Vec<bool> {
        let shape = self.grid.shape;
        let in_frame = |cell: usize| {
            let [ix, iy] = [cell / (shape[1] + 2), cell % (shape[1] + 2)];
            shape[0] > 1 && (ix == 0 || ix > shape[0]) || shape[1] > 1 && (iy == 0 || iy > shape[1])
        };
        let mut outside: Vec<bool> = (0..self.z.len()).map(in_frame).collect();
        let mut inside = vec![false; self.z.len()];
        self.samples().for_each(|cell| inside[cell] = true);

        let beside = |cell: usize, outside: &[bool]| self.neighbours(cell).any(|other| outside[other]);
        let undefined = |cell: &usize| inside[*cell] && self.z[*cell].is_nan();
        let mut front: Vec<usize> =
            self.samples().filter(undefined).filter(|&cell| beside(cell, &outside)).collect();
        while let Some(cell) = front.pop() {
            if !std::mem::replace(&mut outside[cell], true) {
                front.extend(self.neighbours(cell).filter(undefined));
            }
        }
        (0..self.z.len()).map(|cell| inside[cell] && beside(cell, &outside)).collect()
    }
}
