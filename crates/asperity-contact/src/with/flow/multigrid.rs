//! Conjugate gradients for the potentials of a network, preconditioned by algebraic multigrid.
//!
//! Cells are gathered in aggregates, the unknowns of the next coarser level, and these again, by smoothed aggregation without
//! the weak couplings (P. Vaněk, J. Mandel, M. Brezina, Computing 56, 179 (1996)). A cell depends strongly on a neighbour
//! if their transmissibility is not small beside the largest one of the cell. An aggregate is a root with the cells that
//! depend on it, not those on which the root depends: a narrow place between two wide ones belongs to one of them, and does
//! not tie them together.
//!
//! Coarse levels are networks, too. The sum of the transmissibilities of an unknown is never taken from its matrix: a
//! pressure that is even on both sides of a narrow place keeps its small energy on each level, at any contrast.

use super::faces::{Network, end_cells};

/// Least transmissibility of a strong dependence, over the largest one of the dependent unknown.
const STRONG: f64 = 0.25;

/// Weight of the step of Jacobi's method that smooths the interpolation.
const SMOOTHING: f64 = 2.0 / 3.0;

/// Most unknowns of the coarsest level, which are eliminated.
const COARSEST: usize = 100;

/// Not in an aggregate.
const NONE: u32 = u32::MAX;

/// Unknowns that are joined to each other, and to the reservoirs.
trait Links {
    fn unknowns(&self) -> usize;
    /// Returns the neighbours of an unknown and the transmissibilities to them.
    fn of(&self, unknown: usize) -> impl Iterator<Item = (usize, f64)>;
    /// Returns the transmissibility of an unknown to the reservoirs.
    fn end(&self, unknown: usize) -> f64;
    /// Gives the `sink` each unknown with the flow into it at these potentials.
    fn inflow(&self, potential: &[f64], sink: impl FnMut(usize, f64));
    /// Balances one unknown after the other, by Gauss and Seidel, from potentials of 0. Gives the `sink` each unknown with the
    /// imbalance that is left.
    fn descend(&self, current: &[f64], potential: &mut [f64], sink: impl FnMut(usize, f64));
    /// Adds a correction to each unknown, and balances them in the reverse order.
    fn ascend(&self, current: &[f64], potential: &mut [f64], correction: impl Fn(usize) -> f64);
}

/// Returns the reciprocals of the sums of the transmissibilities of the unknowns, 0 for a sum of 0.
fn inverse(unknowns: usize, sum: impl Fn(usize) -> f64) -> Vec<f64> {
    (0..unknowns).map(sum).map(|sum| if sum > 0.0 { sum.recip() } else { 0.0 }).collect()
}

/// The cells of a network.
struct Cells<'a> {
    network: &'a Network,
    /// Cells at the reservoirs, ascending, with the transmissibility to them.
    ends: Vec<(usize, f64)>,
    inverse: Vec<f64>,
}

impl<'a> Cells<'a> {
    fn new(network: &'a Network) -> Self {
        let mut ends = Vec::new();
        if let Some(reservoirs) = &network.ends {
            let rows = [0, network.shape[reservoirs.axis] - 1];
            for (index, transmissibility) in rows.into_iter().zip(&reservoirs.transmissibility) {
                let cells = end_cells(network.shape, reservoirs.axis, index);
                ends.extend(cells.zip(transmissibility.iter().copied()));
            }
        }
        ends.sort_unstable_by_key(|(cell, _)| *cell);
        let mut cells = Self { network, ends, inverse: Vec::new() };
        let sum = |cell: usize| cells.of(cell).map(|(_, value)| value).sum::<f64>() + cells.end(cell);
        cells.inverse = inverse(network.cells(), sum);
        cells
    }

    /// Returns where a row begins, and where the rows before and after it do.
    fn rows(&self, row: usize) -> [usize; 3] {
        let [nx, ny] = self.network.shape;
        [row * ny, (row + nx - 1) % nx * ny, (row + 1) % nx * ny]
    }

    /// Balances the cells of a row, from the first or from the last one. `known` is scratch of its length.
    fn balance<const FORWARD: bool>(
        &self,
        row: usize,
        current: &[f64],
        potential: &mut [f64],
        known: &mut [f64],
    ) {
        let ny = known.len();
        let [x, y] = &self.network.faces;
        let [at, before, after] = self.rows(row);
        let [up, down] = [before, after].map(|start| &potential[start..start + ny]);
        let [from_up, to_down] = [at, after].map(|start| &x[start..start + ny]);
        for (j, (known, current)) in known.iter_mut().zip(&current[at..at + ny]).enumerate() {
            *known = current + (from_up[j] * up[j] + to_down[j] * down[j]);
        }
        let [y, inverse] = [y, &self.inverse].map(|values| &values[at..at + ny]);
        let own = &mut potential[at..at + ny];
        let (range, others) = if FORWARD { (0..ny - 1, &own[1..]) } else { (1..ny, &own[..ny - 1]) };
        for (known, (y, other)) in known[range].iter_mut().zip(y[1..].iter().zip(others)) {
            *known += y * other;
        }
        // Only what the neighbour that has just been balanced adds is left.
        if FORWARD {
            let mut last = own[ny - 1];
            for (own, ((known, inverse), y)) in own.iter_mut().zip(known.iter().zip(inverse).zip(y)) {
                last = inverse * known + (inverse * y) * last;
                *own = last;
            }
            own[ny - 1] += inverse[ny - 1] * y[0] * own[0];
        } else {
            let mut last = inverse[ny - 1] * (known[ny - 1] + y[0] * own[0]);
            own[ny - 1] = last;
            let rest = known[..ny - 1].iter().zip(inverse).zip(&y[1..]);
            for (own, ((known, inverse), y)) in own[..ny - 1].iter_mut().zip(rest).rev() {
                last = inverse * known + (inverse * y) * last;
                *own = last;
            }
            own[0] += inverse[0] * y[0] * own[ny - 1];
        }
    }

    /// Gives the `sink` the flow into the cells of a row from those that come after them. `inflow` is scratch of its length.
    fn flow_from_later(
        &self,
        row: usize,
        potential: &[f64],
        inflow: &mut [f64],
        mut sink: impl FnMut(usize, f64),
    ) {
        let ny = inflow.len();
        let [x, y] = &self.network.faces;
        let [at, before, after] = self.rows(row);
        let [own, up, down] = [at, before, after].map(|start| &potential[start..start + ny]);
        let [from_up, to_down] = [at, after].map(|start| &x[start..start + ny]);
        let y = &y[at..at + ny];
        if after > at {
            inflow
                .iter_mut()
                .zip(to_down.iter().zip(down))
                .for_each(|(inflow, (x, down))| *inflow = x * down);
        } else {
            inflow.fill(0.0);
        }
        if row == 0 {
            inflow.iter_mut().zip(from_up.iter().zip(up)).for_each(|(inflow, (x, up))| *inflow += x * up);
        }
        inflow
            .iter_mut()
            .zip(y[1..].iter().zip(&own[1..]))
            .for_each(|(inflow, (y, right))| *inflow += y * right);
        inflow[0] += y[0] * own[ny - 1];
        inflow.iter().enumerate().for_each(|(j, inflow)| sink(at + j, *inflow));
    }
}

impl Links for Cells<'_> {
    fn unknowns(&self) -> usize {
        self.network.cells()
    }

    #[inline]
    fn of(&self, cell: usize) -> impl Iterator<Item = (usize, f64)> {
        let [nx, ny] = self.network.shape;
        let [x, y] = &self.network.faces;
        let j = cell % ny;
        let up = if cell >= ny { cell - ny } else { cell + (nx - 1) * ny };
        let left = if j > 0 { cell - 1 } else { cell + ny - 1 };
        let right = if j + 1 < ny { cell + 1 } else { cell + 1 - ny };
        let down = if cell + ny < nx * ny { cell + ny } else { j };
        [(up, x[cell]), (left, y[cell]), (right, y[right]), (down, x[down])].into_iter()
    }

    fn end(&self, cell: usize) -> f64 {
        self.ends.binary_search_by_key(&cell, |(cell, _)| *cell).map_or(0.0, |place| self.ends[place].1)
    }

    fn inflow(&self, potential: &[f64], mut sink: impl FnMut(usize, f64)) {
        let [nx, ny] = self.network.shape;
        let [x, y] = &self.network.faces;
        let mut inflow = vec![0.0; ny];
        let mut ends = self.ends.iter().peekable();
        for row in 0..nx {
            let [at, before, after] = self.rows(row);
            let [own, up, down] = [at, before, after].map(|start| &potential[start..start + ny]);
            let [from_up, to_down] = [at, after].map(|start| &x[start..start + ny]);
            let y = &y[at..at + ny];
            for (j, inflow) in inflow.iter_mut().enumerate() {
                *inflow = from_up[j] * (up[j] - own[j]) + to_down[j] * (down[j] - own[j]);
            }
            for j in 1..ny - 1 {
                inflow[j] += y[j] * (own[j - 1] - own[j]) + y[j + 1] * (own[j + 1] - own[j]);
            }
            let last = ny - 1;
            inflow[0] += y[0] * (own[last] - own[0]) + y[1] * (own[1] - own[0]);
            inflow[last] += y[last] * (own[last - 1] - own[last]) + y[0] * (own[0] - own[last]);
            while let Some((cell, end)) = ends.next_if(|(cell, _)| *cell < at + ny) {
                inflow[cell - at] -= end * potential[*cell];
            }
            inflow.iter().enumerate().for_each(|(j, inflow)| sink(at + j, *inflow));
        }
    }

    fn descend(&self, current: &[f64], potential: &mut [f64], mut sink: impl FnMut(usize, f64)) {
        let [nx, ny] = self.network.shape;
        let mut known = vec![0.0; ny];
        potential.fill(0.0);
        // The row before is still in the cache. The first one waits for the last.
        for row in 0..nx {
            self.balance::<true>(row, current, potential, &mut known);
            if row > 1 {
                self.flow_from_later(row - 1, potential, &mut known, &mut sink);
            }
        }
        for row in [nx - 1, 0] {
            self.flow_from_later(row, potential, &mut known, &mut sink);
        }
    }

    fn ascend(&self, current: &[f64], potential: &mut [f64], correction: impl Fn(usize) -> f64) {
        let [nx, ny] = self.network.shape;
        let mut known = vec![0.0; ny];
        let correct = |row: usize, potential: &mut [f64]| {
            (row * ny..(row + 1) * ny).for_each(|cell| potential[cell] += correction(cell));
        };
        // A row is balanced when its neighbours are corrected, of which the last row has the first one.
        [nx - 1, 0].into_iter().for_each(|row| correct(row, potential));
        for row in (0..nx).rev() {
            if row > 1 {
                correct(row - 1, potential);
            }
            self.balance::<false>(row, current, potential, &mut known);
        }
    }
}

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

    /// Returns the transpose of a matrix with this number of `columns`.
    fn transposed(&self, columns: usize) -> Self {
        let mut starts = vec![0; columns + 1];
        self.columns.iter().for_each(|column| starts[*column as usize + 1] += 1);
        for row in 0..columns {
            starts[row + 1] += starts[row];
        }
        let mut next = starts.clone();
        let (mut columns, mut values) = (vec![0; self.columns.len()], vec![0.0; self.columns.len()]);
        for row in 0..self.starts.len() - 1 {
            for (column, value) in self.of(row) {
                let place = next[column] as usize;
                (columns[place], values[place]) = (row as u32, value);
                next[column] += 1;
            }
        }
        Self { starts, columns, values }
    }
}

/// A coarse level.
struct Level {
    links: Rows,
    ends: Vec<f64>,
    inverse: Vec<f64>,
}

impl Level {
    #[inline]
    fn balance(&self, unknown: usize, current: &[f64], potential: &mut [f64]) {
        let inflow = current[unknown] + self.links.product(unknown, potential);
        potential[unknown] = self.inverse[unknown] * inflow;
    }
}

impl Links for Level {
    fn unknowns(&self) -> usize {
        self.ends.len()
    }

    #[inline]
    fn of(&self, unknown: usize) -> impl Iterator<Item = (usize, f64)> {
        self.links.of(unknown)
    }

    fn end(&self, unknown: usize) -> f64 {
        self.ends[unknown]
    }

    fn inflow(&self, potential: &[f64], mut sink: impl FnMut(usize, f64)) {
        for (unknown, own) in potential.iter().enumerate() {
            let between =
                self.of(unknown).map(|(other, value)| value * (potential[other] - own)).sum::<f64>();
            sink(unknown, between - self.ends[unknown] * own);
        }
    }

    fn descend(&self, current: &[f64], potential: &mut [f64], mut sink: impl FnMut(usize, f64)) {
        potential.fill(0.0);
        (0..self.unknowns()).for_each(|unknown| self.balance(unknown, current, potential));
        self.inflow(potential, |unknown, inflow| sink(unknown, current[unknown] + inflow));
    }

    fn ascend(&self, current: &[f64], potential: &mut [f64], correction: impl Fn(usize) -> f64) {
        potential.iter_mut().enumerate().for_each(|(unknown, potential)| *potential += correction(unknown));
        (0..self.unknowns()).rev().for_each(|unknown| self.balance(unknown, current, potential));
    }
}

/// Least transmissibility at which each unknown depends strongly on a neighbour; infinite without neighbours.
fn thresholds(links: &impl Links) -> Vec<f64> {
    let of = |unknown| {
        let most = links.of(unknown).fold(0.0_f64, |most, (_, value)| most.max(value));
        if most > 0.0 { STRONG * most } else { f64::INFINITY }
    };
    (0..links.unknowns()).map(of).collect()
}

/// Gathers the unknowns in aggregates. Returns the aggregate of each, and their number.
fn aggregates(links: &impl Links, least: &[f64]) -> (Vec<u32>, usize) {
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
fn gather(links: &impl Links, least: &[f64], root: usize, count: u32, aggregate: &mut [u32]) {
    aggregate[root] = count;
    for (other, value) in links.of(root) {
        if value >= least[other] && aggregate[other] == NONE {
            aggregate[other] = count;
        }
    }
}

/// Returns the neighbour on which an unknown depends most, among the `eligible` ones.
fn strongest(
    links: &impl Links,
    least: &[f64],
    unknown: usize,
    eligible: impl Fn(usize) -> bool,
) -> Option<usize> {
    let strong = links.of(unknown).filter(|(other, value)| *value >= least[unknown] && eligible(*other));
    strong.max_by(|a, b| a.1.total_cmp(&b.1)).map(|(other, _)| other)
}

/// Interpolates from aggregates: constants, after a step of Jacobi's method with the strong couplings. Rows add up to 1.
fn interpolation(links: &impl Links, least: &[f64], aggregate: &[u32]) -> Rows {
    let mut rows = Rows::new();
    for unknown in 0..least.len() {
        if aggregate[unknown] != NONE {
            let first = rows.columns.len();
            let strong = || links.of(unknown).filter(|(_, value)| *value >= least[unknown]);
            let scale = SMOOTHING / strong().map(|(_, value)| value).sum::<f64>();
            let neighbours = strong().map(|(other, value)| (aggregate[other], scale * value));
            for (column, weight) in [(aggregate[unknown], 1.0 - SMOOTHING)].into_iter().chain(neighbours) {
                match rows.columns[first..].iter().position(|other| *other == column) {
                    Some(place) => rows.values[first + place] += weight,
                    None => {
                        rows.columns.push(column);
                        rows.values.push(weight);
                    }
                }
            }
            if rows.columns.len() == first + 1 {
                rows.values[first] = 1.0;
            }
        }
        rows.end_row();
    }
    rows
}

/// Returns the interpolation from the next coarser level, and that level: the matrix of this one between interpolated
/// potentials.
fn coarsen(links: &impl Links) -> (Rows, Level) {
    let least = thresholds(links);
    let (aggregate, count) = aggregates(links, &least);
    let interpolation = interpolation(links, &least, &aggregate);
    drop((least, aggregate));
    let transposed = interpolation.transposed(count);
    let mut coarse = Rows::new();
    let mut ends = Vec::with_capacity(count);
    let mut place = vec![NONE; count];
    for unknown in 0..count {
        let first = coarse.columns.len();
        let mut end = 0.0;
        let mut add = |column: usize, value: f64| {
            if place[column] == NONE {
                place[column] = coarse.columns.len() as u32;
                coarse.columns.push(column as u32);
                coarse.values.push(0.0);
            }
            coarse.values[place[column] as usize] += value;
        };
        for (fine, weight) in transposed.of(unknown) {
            let own_end = weight * links.end(fine);
            let mut sum = own_end;
            for (other, value) in links.of(fine).filter(|(_, value)| *value != 0.0) {
                let value = weight * value;
                sum += value;
                interpolation.of(other).for_each(|(column, weight)| add(column, value * weight));
            }
            interpolation.of(fine).for_each(|(column, weight)| add(column, -sum * weight));
            end += own_end;
        }
        coarse.columns[first..].iter().for_each(|column| place[*column as usize] = NONE);
        let own = coarse.columns[first..].iter().position(|column| *column as usize == unknown);
        let own = first + own.expect("an unknown interpolates to its own aggregate");
        coarse.columns.swap_remove(own);
        coarse.values.swap_remove(own);
        coarse.end_row();
        ends.push(end);
    }
    let sum = |unknown: usize| coarse.of(unknown).map(|(_, value)| value).sum::<f64>() + ends[unknown];
    let inverse = inverse(count, sum);
    (interpolation, Level { links: coarse, ends, inverse })
}

/// The unknowns of the coarsest level, eliminated as the cells of a network are.
struct Coarsest {
    /// Fractions of the sum of the transmissibilities of each unknown that lead to the later ones, and to the reservoirs.
    rows: Vec<f64>,
    sums: Vec<f64>,
}

impl Coarsest {
    fn new(level: &Level) -> Self {
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
}

/// The levels of a network.
pub(super) struct Multigrid<'a> {
    cells: Cells<'a>,
    levels: Vec<Level>,
    /// Interpolation to the cells and to each level but the last one.
    interpolations: Vec<Rows>,
    coarsest: Coarsest,
}

impl<'a> Multigrid<'a> {
    /// Creates the levels of a network, of at least two cells along each axis.
    pub(super) fn new(network: &'a Network) -> Self {
        let cells = Cells::new(network);
        let (first, mut level) = coarsen(&cells);
        let mut interpolations = vec![first];
        let mut levels = Vec::new();
        while level.unknowns() > COARSEST {
            let (interpolation, next) = coarsen(&level);
            interpolations.push(interpolation);
            levels.push(std::mem::replace(&mut level, next));
        }
        let coarsest = Coarsest::new(&level);
        levels.push(level);
        Self { cells, levels, interpolations, coarsest }
    }

    /// Solves for the potentials under the currents `right` into each cell, in its place, until the error has fallen to the
    /// `tolerance` in the norm of energy. Returns the number of iterations: `most` if it has not.
    pub(super) fn solve(&self, right: &mut [f64], tolerance: f64, most: usize) -> usize {
        let scratch = |level: &Level| {
            let [current, potential, first] = [(); 3].map(|()| vec![0.0; level.unknowns()]);
            Scratch { current, potential, first }
        };
        let mut scratch: Vec<Scratch> = self.levels.iter().map(scratch).collect();
        let n = right.len();
        let (mut potential, mut direction, mut other) = (vec![0.0; n], vec![0.0; n], vec![0.0; n]);
        let (mut before, mut enough) = (0.0, 0.0);
        let mut iterations = 0;
        while iterations < most {
            self.correct(&self.cells, 0, right, &mut other, &mut scratch);
            let product = dot(right, &other);
            if iterations == 0 {
                enough = tolerance * tolerance * product;
            }
            if product <= enough {
                break;
            }
            let beta = if iterations == 0 { 0.0 } else { product / before };
            direction.iter_mut().zip(&other).for_each(|(direction, z)| *direction = z + beta * *direction);
            let mut energy = 0.0;
            self.cells.inflow(&direction, |cell, inflow| {
                other[cell] = inflow;
                energy -= direction[cell] * inflow;
            });
            let alpha = product / energy;
            if !alpha.is_finite() {
                iterations = most;
                break;
            }
            for ((x, r), (d, inflow)) in
                potential.iter_mut().zip(&mut *right).zip(direction.iter().zip(&other))
            {
                *x += alpha * d;
                *r += alpha * inflow;
            }
            before = product;
            iterations += 1;
        }
        right.copy_from_slice(&potential);
        iterations
    }

    /// Approximates the potentials of the unknowns above the interpolation at `depth` under these currents, by one cycle.
    fn correct(
        &self,
        links: &impl Links,
        depth: usize,
        current: &[f64],
        potential: &mut [f64],
        scratch: &mut [Scratch],
    ) {
        let interpolation = &self.interpolations[depth];
        let restricted = &mut scratch[0].current;
        restricted.fill(0.0);
        links.descend(current, potential, |unknown, left| {
            interpolation.of(unknown).for_each(|(column, weight)| restricted[column] += weight * left);
        });
        self.correct_level(depth, scratch);
        // The levels below the first coarse one are visited twice: else iterations increase with their number.
        if depth > 0 && depth + 1 < self.levels.len() {
            let Scratch { current, potential, first } = &mut scratch[0];
            self.levels[depth].inflow(potential, |unknown, inflow| current[unknown] += inflow);
            std::mem::swap(potential, first);
            self.correct_level(depth, scratch);
            let Scratch { potential, first, .. } = &mut scratch[0];
            potential.iter_mut().zip(first).for_each(|(potential, first)| *potential += *first);
        }
        let correction = &scratch[0].potential;
        links.ascend(current, potential, |unknown| interpolation.product(unknown, correction));
    }

    /// Approximates the potentials of a coarse level in its scratch, the first one.
    fn correct_level(&self, level: usize, scratch: &mut [Scratch]) {
        let (own, coarser) = scratch.split_first_mut().expect("each level has its scratch");
        if coarser.is_empty() {
            self.coarsest.solve(&own.current, &mut own.potential);
        } else {
            self.correct(&self.levels[level], level + 1, &own.current, &mut own.potential, coarser);
        }
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
