//! Columns of a master curve: their numbers, at rising frequencies.

use super::Read;
use super::cells::{Line, has_decimal_commas, number};
use super::titles::{Deformation, Head, Quantity};
use asperity_base::units::format_number;
use asperity_contact::viscoelastic::MasterPoint;

/// Largest span of the temperatures of a sweep at one temperature, K.
const ISOTHERMAL: f64 = 5.0;
/// Largest drop of E′ from one frequency to the next one above it that noise explains.
const NOISE: f64 = 1.5;

/// Columns of a curve.
pub(super) struct Columns {
    pub(super) frequency: usize,
    /// Two quantities that give both moduli.
    pub(super) moduli: [(Quantity, usize); 2],
    /// Factors of the frequency and of these quantities.
    pub(super) factors: [f64; 3],
    pub(super) temperature: Option<usize>,
    pub(super) deformation: Deformation,
}

/// A line of numbers.
pub(super) struct Row {
    line: usize,
    point: MasterPoint,
}

impl Columns {
    /// Reads the numbers of the lines below the titles.
    pub(super) fn points(&self, head: &Head, body: &[Line]) -> Read<Vec<Row>> {
        let needed = [(Quantity::Frequency, self.frequency), self.moduli[0], self.moduli[1]];
        let places = needed.map(|(_, column)| column);
        let mut lines = Vec::new();
        for line in body.iter().filter(|line| !line.is_comment) {
            let is_head = line.cells.iter().eq(head.titles.iter().map(|title| &title.text));
            if line.has_numbers(places) {
                lines.push(line);
            } else if !is_head && Head::from_line(line).names_a_modulus() {
                return Err(format!(
                    "line {} names other columns than line {}: a second table begins there",
                    line.number, head.line
                ));
            }
        }
        let last = places.into_iter().max().unwrap_or_default();
        for line in &lines {
            let found = line.cells.iter().rposition(|cell| !cell.is_empty()).map_or(0, |index| index + 1);
            let expected = head.titles.len();
            if found <= last || found > expected || (line.is_spaced && found != expected) {
                let number = line.number;
                return Err(format!(
                    "line {number} has {found} columns, expected the {expected} of line {}",
                    head.line
                ));
            }
        }
        let cells = lines.iter().flat_map(|line| places.map(|column| line.cell(column)));
        let comma = has_decimal_commas(cells);
        let row = |line: &&Line| {
            let mut values = [0.0; 3];
            for (index, (quantity, column)) in needed.into_iter().enumerate() {
                let (cell, name) = (line.cell(column), quantity.name());
                let value = number(cell, comma).filter(|value| *value > 0.0);
                let value = value.ok_or_else(|| {
                    let found = if cell.is_empty() { "missing".to_owned() } else { format!("`{cell}`") };
                    format!("line {}: the {name} is {found}, expected a number above 0", line.number)
                })?;
                values[index] = value * self.factors[index];
            }
            let [storage, loss] = moduli(self.moduli.map(|(quantity, _)| quantity), [values[1], values[2]]);
            let point = MasterPoint { frequency: values[0], storage, loss };
            Ok(Row { line: line.number, point })
        };
        let rows: Vec<Row> = lines.iter().map(row).collect::<Read<_>>()?;
        match self.temperature.filter(|_| !is_one_sweep(&rows)) {
            Some(column) => {
                let temperatures = lines.iter().filter_map(|line| number(line.cell(column), comma));
                isothermal(&head.titles[column].text, temperatures).map(|()| rows)
            }
            None => Ok(rows),
        }
    }

    /// Returns the points at rising frequencies, unless they belong to several sweeps.
    pub(super) fn ordered(mut rows: Vec<Row>) -> Read<Vec<MasterPoint>> {
        let is_mixed = !is_one_sweep(&rows);
        rows.sort_by(|one, other| one.point.frequency.total_cmp(&other.point.frequency));
        for pair in rows.windows(2) {
            let [one, other] = [&pair[0], &pair[1]];
            let lines = format!("lines {} and {}", one.line.min(other.line), one.line.max(other.line));
            if one.point.frequency == other.point.frequency {
                return Err(format!(
                    "{lines} have the same frequency, expected one sweep with each frequency once"
                ));
            }
            if is_mixed && one.point.storage > NOISE * other.point.storage {
                return Err(format!(
                    "its frequencies go up and down, and {lines} are no neighbours on one curve, expected one sweep"
                ));
            }
        }
        Ok(rows.into_iter().map(|row| row.point).collect())
    }
}

/// Whether the frequencies rise throughout, or fall throughout.
fn is_one_sweep(rows: &[Row]) -> bool {
    let frequency = |row: &Row| row.point.frequency;
    rows.is_sorted_by(|one, other| frequency(one) < frequency(other))
        || rows.is_sorted_by(|one, other| frequency(one) > frequency(other))
}

/// Returns an error if the temperatures of a column are those of several sweeps.
fn isothermal(title: &str, temperatures: impl Iterator<Item = f64> + Clone) -> Read<()> {
    let least = temperatures.clone().fold(f64::INFINITY, f64::min);
    let most = temperatures.fold(f64::NEG_INFINITY, f64::max);
    if most - least <= ISOTHERMAL {
        return Ok(());
    }
    let [least, most] = [least, most].map(format_number);
    Err(format!(
        "`{title}` goes from {least} to {most}, expected a curve at one temperature: shift the sweeps to one and export that curve, or remove \
         the column if the frequencies are reduced already"
    ))
}

/// Returns E′ and E″ from the two quantities that a file has.
fn moduli(quantities: [Quantity; 2], [modulus, other]: [f64; 2]) -> [f64; 2] {
    let tangent = if quantities[1] == Quantity::PhaseAngle { other.tan() } else { other };
    match quantities {
        [Quantity::Storage, Quantity::Loss] => [modulus, other],
        [Quantity::Loss, _] => [modulus / tangent, modulus],
        [Quantity::Complex, _] => {
            let storage = modulus / tangent.hypot(1.0);
            [storage, storage * tangent]
        }
        _ => [modulus, modulus * tangent],
    }
}
