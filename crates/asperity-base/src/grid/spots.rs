//! Contact spots: connected cells of a grid.

/// Cells of a grid and the spots that they form. Cells are connected over edges and corners and, if the grid
/// is periodic along x or y, across its boundary.
pub struct Spots {
    /// The cells `[ix, iy]`, in ascending order of their flat index.
    pub cells: Vec<[usize; 2]>,
    /// For each of these the place in `cells` of the first cell of its spot.
    pub first: Vec<usize>,
}

impl Spots {
    /// Finds the spots of flat `cells`, in ascending order, on a grid of `shape` that is `periodic` along x
    /// or y.
    pub fn new(cells: impl Iterator<Item = usize>, shape: [usize; 2], periodic: [bool; 2]) -> Self {
        let [columns, width] = shape;
        let mut spots = Sets::default();
        let mut lines: Vec<Vec<(usize, usize)>> = vec![Vec::new(); columns];
        let mut cells_in_order = Vec::new();
        for cell in cells {
            let (x, y) = (cell / width, cell % width);
            lines[x].push((y, spots.add()));
            cells_in_order.push([x, y]);
        }
        for x in 0..columns {
            for pair in lines[x].windows(2) {
                if pair[1].0 == pair[0].0 + 1 {
                    spots.join(pair[0].1, pair[1].1);
                }
            }
            if let (true, Some(first), Some(last)) = (periodic[1], lines[x].first(), lines[x].last())
                && first.0 == 0
                && last.0 == width - 1
            {
                spots.join(first.1, last.1);
            }
            if x + 1 < columns {
                join_lines(&mut spots, &lines[x], &lines[x + 1], width, periodic[1]);
            } else if periodic[0] {
                join_lines(&mut spots, &lines[x], &lines[0], width, periodic[1]);
            }
        }
        let first = (0..cells_in_order.len()).map(|cell| spots.root(cell)).collect();
        Self { cells: cells_in_order, first }
    }

    /// Number of cells of each spot at the place of its first cell in `cells`, 0 at all others.
    pub fn counts(&self) -> Vec<usize> {
        let mut counts = vec![0; self.cells.len()];
        self.first.iter().for_each(|first| counts[*first] += 1);
        counts
    }
}

/// Joins the touching cells of two neighbouring lines.
fn join_lines(
    spots: &mut Sets,
    line: &[(usize, usize)],
    next: &[(usize, usize)],
    width: usize,
    periodic: bool,
) {
    let mut from = 0;
    for &(y, spot) in line {
        while from < next.len() && next[from].0 + 1 < y {
            from += 1;
        }
        for &(_, other) in next[from..].iter().take_while(|(other, _)| *other <= y + 1) {
            spots.join(spot, other);
        }
    }
    if !periodic {
        return;
    }
    for (one, other) in [(line, next), (next, line)] {
        if let (Some(first), Some(last)) = (one.first(), other.last())
            && first.0 == 0
            && last.0 == width - 1
        {
            spots.join(first.1, last.1);
        }
    }
}

/// Disjoint sets of connected cells (union–find); the first cell of a set stands for it.
#[derive(Default)]
struct Sets {
    parent: Vec<usize>,
}

impl Sets {
    /// Adds a cell as a new set.
    fn add(&mut self) -> usize {
        self.parent.push(self.parent.len());
        self.parent.len() - 1
    }

    /// The representative of the set of a cell.
    fn root(&mut self, mut cell: usize) -> usize {
        while self.parent[cell] != cell {
            self.parent[cell] = self.parent[self.parent[cell]];
            cell = self.parent[cell];
        }
        cell
    }

    /// Joins the sets of two cells.
    fn join(&mut self, one: usize, other: usize) {
        let (one, other) = (self.root(one), self.root(other));
        self.parent[one.max(other)] = one.min(other);
    }
}
