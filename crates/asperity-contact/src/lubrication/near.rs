//! A preconditioner of Newton's matrix: the same matrix, in which the displacement of a cell depends only on the
//! pressures nearby, and the flow is upwind of first order.

use super::flow::{Balance, OFFSETS, SECOND_UPSTREAM, UPSTREAM};
use super::fronts::{Factor, Matrix};
use super::state::{Scales, Sides};
use crate::operator::Operator;

/// Cells along x and y up to which a cell is joined to others.
const REACH: [usize; 2] = [2, 1];

/// Displacements of a cell under pressure on those beside it, by [`Near::index`].
pub(super) struct Near([f64; 9]);

impl Near {
    pub(super) fn new(operator: &dyn Operator) -> Self {
        let [nx, ny] = operator.grid().shape;
        Self(std::array::from_fn(|n| {
            let (i, j) = ((n / 3).abs_diff(1), (n % 3).abs_diff(1));
            if i < nx && j < ny { operator.influence(i, j) } else { 0.0 }
        }))
    }

    fn each(&self) -> impl Iterator<Item = ([isize; 2], f64)> {
        self.0.iter().enumerate().map(|(n, value)| ([(n / 3) as isize - 1, (n % 3) as isize - 1], *value))
    }
}

/// The cells at offsets from another.
#[derive(Clone, Copy)]
pub(super) struct Neighbours {
    pub(super) shape: [usize; 2],
    pub(super) repeats: bool,
}

impl Neighbours {
    #[inline]
    pub(super) fn cell_at(self, cell: usize, [di, dj]: [isize; 2]) -> Option<usize> {
        let [nx, ny] = self.shape;
        let i = (cell / ny).checked_add_signed(di).filter(|i| *i < nx)?;
        let j = (cell % ny) as isize + dj;
        let j = if self.repeats { j.rem_euclid(ny as isize) } else { j };
        (0..ny as isize).contains(&j).then(|| i * ny + j as usize)
    }
}

/// The factors of the near matrix, without the approach and the load.
///
/// No other cell depends on the cavity fraction of one whose oil flows only into empty cells. Such cells are
/// solved for after all others.
pub(super) struct NearFactor {
    factor: Factor,
    /// Row of the system of each unknown that is factored.
    rows: Vec<u32>,
    trailing: Vec<Trailing>,
    /// Rows of the system and coefficients that the trailing cells depend on.
    known: Vec<(u32, f64)>,
}

/// A cell that is solved for after all others.
struct Trailing {
    row: u32,
    diagonal: f64,
    /// End of its part of `known`.
    end: usize,
}

impl NearFactor {
    pub(super) fn new(
        cells: Neighbours,
        balances: &[Balance],
        near: &Near,
        sides: &Sides,
        scales: &Scales,
    ) -> Self {
        let trails = trailing_cells(cells.shape, &sides.empty);
        let count = balances.len();
        let mut unknowns = vec![[None; 2]; count];
        let mut rows = Vec::new();
        for (k, own) in unknowns.iter_mut().enumerate() {
            if let Some(contact) = sides.contact_row(k) {
                own[0] = Some(rows.len() as u32);
                rows.push(contact as u32);
            }
            if !trails[k] {
                own[1] = Some(rows.len() as u32);
                rows.push(k as u32);
            }
        }
        let assembly = Assembly { cells, balances, near, sides, scales };
        let mut matrix = Matrix::new();
        for row in &rows {
            let mut push = |cell: usize, is_contact: bool, value: f64| {
                if let Some(column) = unknowns[cell][usize::from(!is_contact)] {
                    matrix.push(column, value);
                }
            };
            match (*row as usize).checked_sub(count) {
                Some(contact) => assembly.contact(sides.contacts[contact], &mut push),
                None => assembly.flow(*row as usize, &mut push),
            }
            matrix.end_row();
        }
        let (mut trailing, mut known) = (Vec::new(), Vec::new());
        for k in (0..count).filter(|k| trails[*k]) {
            let mut diagonal = 0.0;
            assembly.flow(k, &mut |cell, is_contact, value| {
                if cell == k && !is_contact {
                    // Across a single column, several neighbours are the cell itself.
                    diagonal += value;
                } else if value != 0.0 {
                    let row = if is_contact { sides.contact_row(cell).expect("it touches") } else { cell };
                    known.push((row as u32, value));
                }
            });
            trailing.push(Trailing { row: k as u32, diagonal, end: known.len() });
        }
        let factor = Factor::new(&matrix, cells.shape, cells.repeats, REACH, &unknowns);
        Self { factor, rows, trailing, known }
    }

    /// Solves in the place of the right-hand side.
    pub(super) fn solve(&self, right: &mut [f64]) {
        let mut x: Vec<f64> = self.rows.iter().map(|row| right[*row as usize]).collect();
        self.factor.solve(&mut x);
        self.rows.iter().zip(x).for_each(|(row, x)| right[*row as usize] = x);
        let mut start = 0;
        for cell in &self.trailing {
            let known = &self.known[start..cell.end];
            let sum: f64 = known.iter().map(|(row, value)| value * right[*row as usize]).sum();
            right[cell.row as usize] = (right[cell.row as usize] - sum) / cell.diagonal;
            start = cell.end;
        }
    }
}

/// Returns the empty cells all of whose cells downstream are empty.
fn trailing_cells([nx, ny]: [usize; 2], empty: &[bool]) -> Vec<bool> {
    let mut trails = vec![false; nx * ny];
    for k in (0..nx * ny).rev() {
        trails[k] = empty[k] && (k + ny >= nx * ny || trails[k + ny]);
    }
    trails
}

struct Assembly<'a> {
    cells: Neighbours,
    balances: &'a [Balance],
    near: &'a Near,
    sides: &'a Sides,
    scales: &'a Scales,
}

const WINDOW: [usize; 2] = [2 * REACH[0] + 1, 2 * REACH[1] + 1];

/// Returns the place of an offset in the window that a cell is joined to.
#[inline]
fn in_window([i, j]: [isize; 2]) -> Option<usize> {
    let i =
        i.checked_add_unsigned(REACH[0]).and_then(|i| usize::try_from(i).ok()).filter(|i| *i < WINDOW[0])?;
    let j =
        j.checked_add_unsigned(REACH[1]).and_then(|j| usize::try_from(j).ok()).filter(|j| *j < WINDOW[1])?;
    Some(i * WINDOW[1] + j)
}

impl Assembly<'_> {
    /// Lists the entries in the row of the balance of a cell: the cell, whether the unknown is the pressure of
    /// its solids, and the value.
    fn flow(&self, k: usize, push: &mut impl FnMut(usize, bool, f64)) {
        let mut by_pressure = [0.0; WINDOW[0] * WINDOW[1]];
        let mut by_total = [0.0; WINDOW[0] * WINDOW[1]];
        let balance = &self.balances[k];
        for (n, offset) in OFFSETS.iter().enumerate() {
            // First order: what lies two cells upstream counts as if it lay one upstream.
            let [di, dj] = if n == SECOND_UPSTREAM { OFFSETS[UPSTREAM] } else { *offset };
            if let Some(at) = in_window([di, dj]) {
                by_pressure[at] += balance.by_pressure[n];
            }
            if balance.by_film[n] != 0.0 {
                for ([i, j], displacement) in self.near.each() {
                    if let Some(at) = in_window([di + i, dj + j]) {
                        by_total[at] += balance.by_film[n] * displacement;
                    }
                }
            }
        }
        let Scales { pressure, flow, .. } = *self.scales;
        for at in 0..by_total.len() {
            let offset = [
                (at / WINDOW[1]) as isize - REACH[0] as isize,
                (at % WINDOW[1]) as isize - REACH[1] as isize,
            ];
            let Some(other) = self.cells.cell_at(k, offset) else { continue };
            let value = if self.sides.empty[other] {
                match offset {
                    [0, 0] => balance.by_cavity[0],
                    [-1, 0] => balance.by_cavity[1],
                    _ => 0.0,
                }
            } else {
                (by_pressure[at] + by_total[at]) * pressure
            };
            push(other, false, value * flow);
            if self.sides.touch[other] {
                push(other, true, by_total[at] * pressure * flow);
            }
        }
    }

    /// Lists the entries in the row of the film of a cell whose solids touch.
    fn contact(&self, k: usize, push: &mut impl FnMut(usize, bool, f64)) {
        let Scales { pressure, film, .. } = *self.scales;
        for (offset, displacement) in self.near.each() {
            let Some(other) = self.cells.cell_at(k, offset) else { continue };
            let value = displacement * pressure * film;
            if !self.sides.empty[other] {
                push(other, false, value);
            }
            if self.sides.touch[other] {
                push(other, true, value);
            }
        }
    }
}
