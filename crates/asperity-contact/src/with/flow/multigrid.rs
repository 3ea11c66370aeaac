//! Conjugate gradients for the potentials of a network, preconditioned by algebraic multigrid.
//!
//! Every second cell is eliminated, as on a chessboard: its neighbours are joined to each other in its place, which is exact.
//! The cells that are left are gathered in aggregates, the unknowns of the next coarser level, and these again, by smoothed
//! aggregation without the weak couplings (P. Vaněk, J. Mandel, M. Brezina, Computing 56, 179 (1996)). A cell depends strongly
//! on a neighbour if their transmissibility is not small beside the largest one of the cell. An aggregate is a root with the
//! cells that depend on it, not those on which the root depends: a narrow place between two wide ones belongs to one of them,
//! and does not tie them together.
//!
//! Coarse levels are networks, too. The sum of the transmissibilities of an unknown is never taken from its matrix: a
//! pressure that is even on both sides of a narrow place keeps its small energy on each level, at any contrast.

use super::faces::Network;

/// Least transmissibility of a strong dependence, over the largest one of the dependent unknown.
const STRONG: f64 = 0.25;

/// Weight of the step of Jacobi's method that smooths the interpolation.
const SMOOTHING: f64 = 0.8;

/// Most unknowns of the coarsest level, which are eliminated.
const COARSEST: usize = 100;

/// Number of a cell that is eliminated.
const ELIMINATED: u32 = u32::MAX - 1;

/// Number of what is not solved for, or not in an aggregate.
const NONE: u32 = u32::MAX;

/// Rows of a sparse matrix.
struct Rows {
    starts: Vec<u32>,
    columns: Vec<u32>,
    values: Vec<f64>,
}

impl Rows {
    fn new() -> Self {
        Self { starts: vec![0], columns: Vec::new(), values: Vec::new() }
    }

    /// Adds to the entry of a column in the row that has not ended.
    #[inline]
    fn add(&mut self, column: u32, value: f64) {
        let first = self.starts[self.starts.len() - 1] as usize;
        match self.columns[first..].iter().position(|other| *other == column) {
            Some(place) => self.values[first + place] += value,
            None => {
                self.columns.push(column);
                self.values.push(value);
            }
        }
    }

    fn end_row(&mut self) {
        self.starts.push(self.columns.len() as u32);
    }

    #[inline]
    fn of(&self, row: usize) -> impl Iterator<Item = (usize, f64)> {
        let range = self.starts[row] as usize..self.starts[row + 1] as usize;
        let columns = self.columns[range.clone()].iter().map(|column| *column as usize);
        columns.zip(self.values[range].iter().copied())
    }

    #[inline]
    fn product(&self, row: usize, values: &[f64]) -> f64 {
        self.of(row).map(|(column, weight)| weight * values[column]).sum()
    }
}

/// Interpolation from the next coarser level, entry by entry: loops over rows of one to four entries would take longer.
struct Interpolation {
    /// Row and column of each entry.
    entries: Vec<(u32, u32)>,
    weights: Vec<f64>,
}

impl Interpolation {
    fn new(Rows { starts, columns, values }: Rows) -> Self {
        let rows =
            starts.windows(2).enumerate().flat_map(|(row, ends)| (ends[0]..ends[1]).map(move |_| row as u32));
        Self { entries: rows.zip(columns).collect(), weights: values }
    }

    /// Adds the values interpolated from `coarse` ones.
    fn add(&self, coarse: &[f64], fine: &mut [f64]) {
        for ((row, column), weight) in self.entries.iter().zip(&self.weights) {
            fine[*row as usize] += weight * coarse[*column as usize];
        }
    }

    /// Sums `fine` values with the weights of the interpolation.
    fn restrict(&self, fine: &[f64], coarse: &mut [f64]) {
        coarse.fill(0.0);
        for ((row, column), weight) in self.entries.iter().zip(&self.weights) {
            coarse[*column as usize] += weight * fine[*row as usize];
        }
    }
}

/// Unknowns that are joined to each other, and to the reservoirs.
struct Links {
    rows: Rows,
    /// Transmissibility to the reservoirs.
    ends: Vec<f64>,
}

impl Links {
    /// Creates the links, each of them in both of its rows, from those of each unknown to later ones.
    fn from_later(later: &[Vec<(u32, f64)>], ends: Vec<f64>) -> Self {
        let mut starts = vec![0; later.len() + 1];
        for (unknown, links) in later.iter().enumerate() {
            starts[unknown + 1] += links.len() as u32;
            links.iter().for_each(|(other, _)| starts[*other as usize + 1] += 1);
        }
        for unknown in 0..later.len() {
            starts[unknown + 1] += starts[unknown];
        }
        let mut next = starts.clone();
        let entries = starts[later.len()] as usize;
        let (mut columns, mut values) = (vec![0; entries], vec![0.0; entries]);
        for (unknown, links) in later.iter().enumerate() {
            for &(other, value) in links {
                for (row, column) in [(unknown, other), (other as usize, unknown as u32)] {
                    let place = next[row] as usize;
                    (columns[place], values[place]) = (column, value);
                    next[row] += 1;
                }
            }
        }
        Self { rows: Rows { starts, columns, values }, ends }
    }

    fn unknowns(&self) -> usize {
        self.ends.len()
    }

    #[inline]
    fn of(&self, unknown: usize) -> impl Iterator<Item = (usize, f64)> {
        self.rows.of(unknown)
    }
}

/// Unknowns that are joined to each other, and to the reservoirs. Each link is stored once.
struct Level {
    /// Links to earlier unknowns.
    earlier: Rows,
    /// Transmissibility to the reservoirs.
    ends: Vec<f64>,
    /// Reciprocal of the sum of the transmissibilities, 0 for a sum of 0.
    inverse: Vec<f64>,
}

impl Level {
    fn new(Links { rows: mut earlier, ends }: Links) -> Self {
        let (mut inverse, mut kept, mut first) = (Vec::with_capacity(ends.len()), 0, 0);
        for (unknown, end) in ends.iter().enumerate() {
            let mut sum = *end;
            for entry in first..earlier.starts[unknown + 1] as usize {
                let (column, value) = (earlier.columns[entry], earlier.values[entry]);
                sum += value;
                if (column as usize) < unknown {
                    (earlier.columns[kept], earlier.values[kept]) = (column, value);
                    kept += 1;
                }
            }
            first = earlier.starts[unknown + 1] as usize;
            earlier.starts[unknown + 1] = kept as u32;
            inverse.push(if sum > 0.0 { sum.recip() } else { 0.0 });
        }
        earlier.columns.truncate(kept);
        earlier.columns.shrink_to_fit();
        earlier.values.truncate(kept);
        earlier.values.shrink_to_fit();
        Self { earlier, ends, inverse }
    }

    /// Adds the flow into each unknown at these potentials. Returns the energy of the flow.
    fn add_inflow(&self, potential: &[f64], inflow: &mut [f64]) -> f64 {
        let mut energy = 0.0;
        for (unknown, own) in potential.iter().enumerate() {
            let mut sum = -self.ends[unknown] * own;
            let mut dissipated = -sum * own;
            for (other, value) in self.earlier.of(unknown) {
                let drop = potential[other] - own;
                let flow = value * drop;
                sum += flow;
                dissipated += flow * drop;
                inflow[other] -= flow;
            }
            inflow[unknown] += sum;
            energy += dissipated;
        }
        energy
    }

    /// Balances one unknown after the other, by Gauss and Seidel, from potentials of 0. Computes the `imbalance`
    /// that is left.
    fn descend(&self, current: &[f64], potential: &mut [f64], imbalance: &mut [f64]) {
        for (unknown, current) in current.iter().enumerate() {
            let inflow = current + self.earlier.product(unknown, potential);
            let own = self.inverse[unknown] * inflow;
            potential[unknown] = own;
            imbalance[unknown] = 0.0;
            self.earlier.of(unknown).for_each(|(other, value)| imbalance[other] += value * own);
        }
    }

    /// Balances the unknowns in the reverse order. `known` is scratch.
    fn ascend(&self, current: &[f64], potential: &mut [f64], known: &mut [f64]) {
        known.copy_from_slice(current);
        for unknown in (0..current.len()).rev() {
            let inflow = known[unknown] + self.earlier.product(unknown, potential);
            let own = self.inverse[unknown] * inflow;
            potential[unknown] = own;
            self.earlier.of(unknown).for_each(|(other, value)| known[other] += value * own);
        }
    }
}

/// The cells of a network, every second one of them eliminated.
struct Cells<'a> {
    network: &'a Network,
    /// Number of each cell that is left, [`ELIMINATED`] or [`NONE`].
    numbers: Vec<u32>,
    /// The cell of each number.
    left: Vec<u32>,
}

impl<'a> Cells<'a> {
    fn new(network: &'a Network, wanted: &[bool]) -> Self {
        let [nx, ny] = network.shape;
        let (mut numbers, mut left) = (vec![NONE; nx * ny], Vec::new());
        for cell in (0..nx * ny).filter(|cell| wanted[*cell]) {
            let [i, j] = [cell / ny, cell % ny];
            // Around a period of an odd number of cells, two neighbours have the same colour.
            let seam = (nx % 2 == 1 && i + 1 == nx) || (ny % 2 == 1 && j + 1 == ny);
            if (i + j) % 2 == 1 && !seam {
                numbers[cell] = ELIMINATED;
            } else {
                numbers[cell] = left.len() as u32;
                left.push(cell as u32);
            }
        }
        Self { network, numbers, left }
    }

    /// Returns the neighbours of a cell and the transmissibilities to them.
    #[inline]
    fn of(&self, cell: usize) -> impl Iterator<Item = (usize, f64)> {
        let [nx, ny] = self.network.shape;
        let [x, y] = &self.network.faces;
        let j = cell % ny;
        let up = if cell >= ny { cell - ny } else { cell + (nx - 1) * ny };
        let left = if j > 0 { cell - 1 } else { cell + ny - 1 };
        let right = if j + 1 < ny { cell + 1 } else { cell + 1 - ny };
        let down = if cell + ny < nx * ny { cell + ny } else { j };
        [(up, x[cell]), (left, y[cell]), (right, y[right]), (down, x[down])]
            .into_iter()
            .filter(|(_, value)| *value > 0.0)
    }

    /// Returns the transmissibility of a cell to the reservoirs.
    #[inline]
    fn end(&self, cell: usize) -> f64 {
        let Some(ends) = &self.network.ends else { return 0.0 };
        let ny = self.network.shape[1];
        let at = [cell / ny, cell % ny];
        let [first, last] = &ends.transmissibility;
        let across = at[1 - ends.axis];
        if at[ends.axis] == 0 {
            first[across]
        } else if at[ends.axis] + 1 == self.network.shape[ends.axis] {
            last[across]
        } else {
            0.0
        }
    }

    /// Returns the sum of the transmissibilities of a cell.
    fn sum(&self, cell: usize) -> f64 {
        self.of(cell).map(|(_, value)| value).sum::<f64>() + self.end(cell)
    }

    /// Returns the links between the cells that are left. An eliminated cell with the sum T of its transmissibilities joins two
    /// neighbours by t₁ t₂/T.
    fn links(&self) -> Links {
        let inverse =
            |(cell, number): (usize, &u32)| if *number == ELIMINATED { self.sum(cell).recip() } else { 0.0 };
        let inverse: Vec<f64> = self.numbers.iter().enumerate().map(inverse).collect();
        let (mut rows, mut ends) = (Rows::new(), Vec::with_capacity(self.left.len()));
        for cell in self.left.iter().map(|cell| *cell as usize) {
            let mut end = self.end(cell);
            for (other, value) in self.of(cell) {
                if self.numbers[other] == ELIMINATED {
                    let fraction = value * inverse[other];
                    end += fraction * self.end(other);
                    for (next, value) in self.of(other).filter(|(next, _)| *next != cell) {
                        rows.add(self.numbers[next], fraction * value);
                    }
                } else {
                    rows.add(self.numbers[other], value);
                }
            }
            rows.end_row();
            ends.push(end);
        }
        Links { rows, ends }
    }

    /// Returns the currents into the cells that are left, with their shares of those into eliminated ones.
    fn restrict(&self, current: &[f64]) -> Vec<f64> {
        let mut left = vec![0.0; self.left.len()];
        for (cell, (number, current)) in self.numbers.iter().zip(current).enumerate() {
            match *number {
                NONE => {}
                ELIMINATED if *current == 0.0 => {}
                ELIMINATED => {
                    let scale = current / self.sum(cell);
                    self.of(cell)
                        .for_each(|(other, value)| left[self.numbers[other] as usize] += scale * value);
                }
                number => left[number as usize] += current,
            }
        }
        left
    }

    /// Turns the currents into the cells into their potentials, from those of the cells that are left.
    fn extend(&self, left: &[f64], current: &mut [f64]) {
        for (cell, (number, current)) in self.numbers.iter().zip(current).enumerate() {
            *current = match *number {
                NONE => 0.0,
                ELIMINATED => {
                    let inflow =
                        self.of(cell).map(|(other, value)| value * left[self.numbers[other] as usize]);
                    (*current + inflow.sum::<f64>()) / self.sum(cell)
                }
                number => left[number as usize],
            };
        }
    }
}

/// Least transmissibility at which each unknown depends strongly on a neighbour; infinite without neighbours.
fn thresholds(links: &Links) -> Vec<f64> {
    let of = |unknown| {
        let most = links.of(unknown).fold(0.0_f64, |most, (_, value)| most.max(value));
        if most > 0.0 { STRONG * most } else { f64::INFINITY }
    };
    (0..links.unknowns()).map(of).collect()
}

/// Gathers the unknowns in aggregates. Returns the aggregate of each, and their number.
fn aggregates(links: &Links, least: &[f64]) -> (Vec<u32>, usize) {
    let mut aggregate = vec![NONE; least.len()];
    let mut count = 0;
    // Roots whose dependents are all free.
    for root in (0..least.len()).filter(|root| least[*root] < f64::INFINITY) {
        let mut dependents = links.of(root).filter(|(other, value)| *value >= least[*other]).peekable();
        if aggregate[root] != NONE
            || dependents.peek().is_none()
            || dependents.any(|(other, _)| aggregate[other] != NONE)
        {
            continue;
        }
        gather(links, least, root, count, &mut aggregate);
        count += 1;
    }
    // Others join the aggregate of the neighbour on which they depend most.
    let roots = aggregate.clone();
    for unknown in (0..least.len()).filter(|unknown| roots[*unknown] == NONE) {
        if let Some(other) = strongest(links, least, unknown, |other| roots[other] != NONE) {
            aggregate[unknown] = roots[other];
        }
    }
    for unknown in 0..least.len() {
        if aggregate[unknown] == NONE
            && let Some(other) = strongest(links, least, unknown, |_| true)
        {
            if aggregate[other] == NONE {
                gather(links, least, other, count, &mut aggregate);
                count += 1;
            }
            aggregate[unknown] = aggregate[other];
        }
    }
    (aggregate, count as usize)
}

/// Makes an aggregate of a root and of the free unknowns that depend on it.
fn gather(links: &Links, least: &[f64], root: usize, count: u32, aggregate: &mut [u32]) {
    aggregate[root] = count;
    for (other, value) in links.of(root) {
        if value >= least[other] && aggregate[other] == NONE {
            aggregate[other] = count;
        }
    }
}

/// Returns the neighbour on which an unknown depends most, among the `eligible` ones.
fn strongest(
    links: &Links,
    least: &[f64],
    unknown: usize,
    eligible: impl Fn(usize) -> bool,
) -> Option<usize> {
    let strong = links.of(unknown).filter(|(other, value)| *value >= least[unknown] && eligible(*other));
    strong.max_by(|a, b| a.1.total_cmp(&b.1)).map(|(other, _)| other)
}

/// Interpolates from aggregates: constants, after a step of Jacobi's method with the strong couplings. Rows add up to 1.
fn interpolation(links: &Links, least: &[f64], aggregate: &[u32]) -> Rows {
    let mut rows = Rows::new();
    for unknown in 0..least.len() {
        if aggregate[unknown] != NONE {
            let first = rows.columns.len();
            let strong = || links.of(unknown).filter(|(_, value)| *value >= least[unknown]);
            let scale = SMOOTHING / strong().map(|(_, value)| value).sum::<f64>();
            let neighbours = strong().map(|(other, value)| (aggregate[other], scale * value));
            for (column, weight) in [(aggregate[unknown], 1.0 - SMOOTHING)].into_iter().chain(neighbours) {
                rows.add(column, weight);
            }
            if rows.columns.len() == first + 1 {
                rows.values[first] = 1.0;
            }
        }
        rows.end_row();
    }
    rows
}

/// Returns the interpolation from the next coarser level, and that level: the energy of this one at interpolated potentials.
///
/// A link t between two unknowns adds −t d_a d_b to that between the aggregates a and b, with the differences d of the weights of
/// the unknowns.
fn coarsen(links: &Links) -> (Rows, Links) {
    let least = thresholds(links);
    let (aggregate, count) = aggregates(links, &least);
    let interpolation = interpolation(links, &least, &aggregate);
    drop((least, aggregate));
    let (mut later, mut ends) = (vec![Vec::new(); count], vec![0.0; count]);
    let mut add = |value: f64, drops: &[(u32, f64)]| {
        for (n, (a, first)) in drops.iter().enumerate() {
            for (b, second) in &drops[n + 1..] {
                let (links, other): (&mut Vec<(u32, f64)>, _) = (&mut later[*a.min(b) as usize], *a.max(b));
                let value = -value * first * second;
                match links.iter_mut().find(|(known, _)| *known == other) {
                    Some((_, sum)) => *sum += value,
                    None => links.push((other, value)),
                }
            }
        }
    };
    let (mut own, mut drops) = (Vec::new(), Vec::new());
    for unknown in 0..links.unknowns() {
        own.clear();
        own.extend(interpolation.of(unknown).map(|(column, weight)| (column as u32, weight)));
        let end = links.ends[unknown];
        if end != 0.0 {
            own.iter().for_each(|(column, weight)| ends[*column as usize] += end * weight);
            add(end, &own);
        }
        for (other, value) in links.of(unknown).filter(|(other, _)| *other < unknown) {
            drops.clone_from(&own);
            for (column, weight) in interpolation.of(other) {
                match drops.iter().position(|(known, _)| *known as usize == column) {
                    Some(place) if drops[place].1 == weight => {
                        drops.swap_remove(place);
                    }
                    Some(place) => drops[place].1 -= weight,
                    None => drops.push((column as u32, -weight)),
                }
            }
            add(value, &drops);
        }
    }
    let coarse = Links::from_later(&later, ends);
    (interpolation, coarse)
}

/// The unknowns of the coarsest level, eliminated as the cells of a network are.
struct Coarsest {
    /// Fractions of the sum of the transmissibilities of each unknown that lead to the later ones, and to the reservoirs.
    rows: Vec<f64>,
    sums: Vec<f64>,
}

impl Coarsest {
    fn new(level: &Links) -> Self {
        let n = level.unknowns();
        let mut rows = vec![0.0; n * (n + 1)];
        for (unknown, row) in rows.chunks_exact_mut(n + 1).enumerate() {
            level.of(unknown).for_each(|(other, value)| row[other] = value);
            row[n] = level.ends[unknown];
        }
        let mut sums = vec![0.0; n];
        for k in 0..n {
            let (row, later) = rows[k * (n + 1)..].split_at_mut(n + 1);
            let sum = row[k + 1..].iter().sum::<f64>();
            // A cell that is left alone at the end of a component without reservoirs is held at 0.
            let scale = if sum > 0.0 { sum.recip() } else { 0.0 };
            for (i, other) in (k + 1..n).zip(later.chunks_exact_mut(n + 1)) {
                let factor = row[i] * scale;
                if factor != 0.0 {
                    other[k + 1..].iter_mut().zip(&row[k + 1..]).for_each(|(x, value)| *x += factor * value);
                }
            }
            row[k + 1..].iter_mut().for_each(|value| *value *= scale);
            sums[k] = scale;
        }
        Self { rows, sums }
    }

    fn solve(&self, current: &[f64], potential: &mut [f64]) {
        let n = self.sums.len();
        potential.copy_from_slice(current);
        for (k, row) in self.rows.chunks_exact(n + 1).enumerate() {
            let (own, later) = potential.split_at_mut(k + 1);
            later.iter_mut().zip(&row[k + 1..]).for_each(|(x, fraction)| *x += fraction * own[k]);
        }
        for (k, row) in self.rows.chunks_exact(n + 1).enumerate().rev() {
            let (own, later) = potential.split_at_mut(k + 1);
            let from_later: f64 = later.iter().zip(&row[k + 1..]).map(|(x, fraction)| x * fraction).sum();
            own[k] = own[k] * self.sums[k] + from_later;
        }
    }
}

/// Scratch of a level.
struct Scratch {
    current: Vec<f64>,
    potential: Vec<f64>,
    first: Vec<f64>,
    imbalance: Vec<f64>,
}

/// The levels of a network.
pub(super) struct Multigrid<'a> {
    cells: Cells<'a>,
    levels: Vec<Level>,
    /// Interpolation to each level but the last one.
    interpolations: Vec<Interpolation>,
    coarsest: Coarsest,
}

impl<'a> Multigrid<'a> {
    /// Creates the levels of a network, of at least two cells along each axis.
    pub(super) fn new(network: &'a Network, wanted: &[bool]) -> Self {
        let cells = Cells::new(network, wanted);
        let mut links = cells.links();
        let mut interpolations = Vec::new();
        let mut levels = Vec::new();
        while links.unknowns() > COARSEST {
            let (interpolation, next) = coarsen(&links);
            interpolations.push(Interpolation::new(interpolation));
            levels.push(Level::new(std::mem::replace(&mut links, next)));
        }
        let coarsest = Coarsest::new(&links);
        levels.push(Level::new(links));
        Self { cells, levels, interpolations, coarsest }
    }

    /// Solves for the potentials under the currents `right` into each cell, in its place, until the error has fallen to the
    /// `tolerance` in the norm of energy. Returns the number of iterations: `most` if it has not.
    pub(super) fn solve(&self, right: &mut [f64], tolerance: f64, most: usize) -> usize {
        let scratch = |level: &Level| {
            let [current, potential, first, imbalance] = [(); 4].map(|()| vec![0.0; level.ends.len()]);
            Scratch { current, potential, first, imbalance }
        };
        let mut scratch: Vec<Scratch> = self.levels[1..].iter().map(scratch).collect();
        let mut current = self.cells.restrict(right);
        let n = current.len();
        let (mut potential, mut direction, mut other) = (vec![0.0; n], vec![0.0; n], vec![0.0; n]);
        let mut inflow = vec![0.0; n];
        let (mut before, mut enough) = (0.0, 0.0);
        let mut iterations = 0;
        while iterations < most {
            self.correct(0, &current, &mut other, &mut inflow, &mut scratch);
            let product = dot(&current, &other);
            if iterations == 0 {
                enough = tolerance * tolerance * product;
            }
            if product <= enough {
                break;
            }
            let beta = if iterations == 0 { 0.0 } else { product / before };
            direction.iter_mut().zip(&other).for_each(|(direction, z)| *direction = z + beta * *direction);
            inflow.fill(0.0);
            let energy = self.levels[0].add_inflow(&direction, &mut inflow);
            let alpha = product / energy;
            if !alpha.is_finite() {
                iterations = most;
                break;
            }
            for ((x, r), (d, inflow)) in
                potential.iter_mut().zip(&mut current).zip(direction.iter().zip(&inflow))
            {
                *x += alpha * d;
                *r += alpha * inflow;
            }
            before = product;
            iterations += 1;
        }
        self.cells.extend(&potential, right);
        iterations
    }

    /// Approximates the potentials of the unknowns of a level under these currents, by one cycle. `imbalance` is scratch.
    fn correct(
        &self,
        depth: usize,
        current: &[f64],
        potential: &mut [f64],
        imbalance: &mut [f64],
        scratch: &mut [Scratch],
    ) {
        let Some((coarse, coarser)) = scratch.split_first_mut() else {
            return self.coarsest.solve(current, potential);
        };
        let (level, interpolation) = (&self.levels[depth], &self.interpolations[depth]);
        level.descend(current, potential, imbalance);
        interpolation.restrict(imbalance, &mut coarse.current);
        self.correct(depth + 1, &coarse.current, &mut coarse.potential, &mut coarse.imbalance, coarser);
        // Each coarse level is visited twice: else iterations increase with their number.
        if !coarser.is_empty() {
            self.levels[depth + 1].add_inflow(&coarse.potential, &mut coarse.current);
            std::mem::swap(&mut coarse.potential, &mut coarse.first);
            self.correct(depth + 1, &coarse.current, &mut coarse.potential, &mut coarse.imbalance, coarser);
            coarse.potential.iter_mut().zip(&coarse.first).for_each(|(potential, first)| *potential += first);
        }
        interpolation.add(&coarse.potential, potential);
        level.ascend(current, potential, imbalance);
    }
}

/// Returns the product of two vectors, summed in four strands.
fn dot(a: &[f64], b: &[f64]) -> f64 {
    let mut sums = [0.0; 4];
    for (a, b) in a.chunks(4).zip(b.chunks(4)) {
        sums.iter_mut().zip(a.iter().zip(b)).for_each(|(sum, (a, b))| *sum += a * b);
    }
    (sums[0] + sums[1]) + (sums[2] + sums[3])
}
