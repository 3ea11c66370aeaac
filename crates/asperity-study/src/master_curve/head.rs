//! The line that names the columns of a table, and the units below it.

use super::Read;
use super::cells::{Line, is_number};
use super::columns::Columns;
use super::titles::{Deformation, Head, Quantity, Title, Unit};

impl Head {
    /// Finds the titles, and the lines below them.
    pub(super) fn find(lines: &[Line]) -> Read<(Self, &[Line])> {
        let head = Self::of_signals(lines)
            .or_else(|| Self::above_numbers(lines, |line| !line.is_comment))
            .or_else(|| Self::above_numbers(lines, |line| line.is_comment))
            .or_else(|| lines.iter().filter(|line| !line.is_comment).find_map(Self::by_position))
            .ok_or("no line names a frequency and a modulus")?;
        let below = lines.partition_point(|line| line.number <= head.line);
        Ok((head, &lines[below..]))
    }

    /// A title on each line, behind `Sig1`, `Sig2`, …
    fn of_signals(lines: &[Line]) -> Option<Self> {
        let signal = |line: &Line| {
            let number = line.cells[0].strip_prefix("Sig")?.parse::<u16>().ok();
            number.map(|_| (line.number, Title::from_text(line.cell(1))))
        };
        let (lines, titles): (Vec<usize>, Vec<Title>) = lines.iter().filter_map(signal).unzip();
        Some(Self { line: *lines.last()?, titles })
    }

    /// The last `suitable` line that names a modulus above the first numbers. A description above it may name
    /// one, too.
    fn above_numbers(lines: &[Line], suitable: impl Fn(&Line) -> bool) -> Option<Self> {
        let head =
            |line: &Line| Some(Self::from_line(line)).filter(|head| suitable(line) && head.names_a_modulus());
        let first = lines.iter().position(|line| head(line).is_some())?;
        let has_numbers =
            |line: &Line| !line.is_comment && line.cells.iter().filter(|cell| is_number(cell)).count() > 2;
        let count = lines[first..].iter().position(has_numbers).unwrap_or(1);
        lines[first..][..count.max(1)].iter().rev().find_map(head)
    }

    /// Titles that name nothing else: units of frequency, storage modulus and loss modulus, in this order.
    fn by_position(line: &Line) -> Option<Self> {
        let mut head = Self::from_line(line);
        let quantities = [Quantity::Frequency, Quantity::Storage, Quantity::Loss];
        for (title, quantity) in head.titles.iter_mut().zip(quantities) {
            title.quantity = title.quantity.or(Some(quantity)).filter(|found| *found == quantity);
        }
        (head.titles.len() == 3 && head.titles.iter().all(|title| title.factor().is_some())).then_some(head)
    }

    /// Takes units from the lines above the numbers, and returns the columns of the curve with the lines from
    /// the numbers on.
    pub(super) fn columns<'a>(&self, body: &'a [Line]) -> Read<(Columns, &'a [Line])> {
        let deformation = self.deformation();
        let suits = |title: &Title| title.deformation.is_none_or(|found| found == deformation);
        let all = |quantity: Quantity| {
            let titles =
                self.titles.iter().enumerate().filter(move |(_, title)| title.quantity == Some(quantity));
            titles.filter(move |(_, title)| !quantity.is_modulus() || suits(title)).collect::<Vec<_>>()
        };
        let one = |quantity: Quantity, found: Vec<(usize, &Title)>| match found[..] {
            [] => Ok(None),
            [(index, _)] => Ok(Some((quantity, index))),
            [(first, _), (second, _), ..] => Err(format!(
                "line {} names the {} in columns {} and {}, expected one: remove the other",
                self.line,
                quantity.name(),
                first + 1,
                second + 1
            )),
        };
        let frequency = || {
            let mut found = all(Quantity::Frequency);
            // A reduced frequency is that of the curve, and ω is 2πf once more.
            for is_better in [|title: &Title| title.is_reduced, |title: &Title| !title.is_angular] {
                if found.iter().any(|(_, title)| is_better(title)) {
                    found.retain(|(_, title)| is_better(title));
                }
            }
            found
        };
        let (_, frequency) = one(Quantity::Frequency, frequency())?.ok_or("no line names a frequency")?;
        let modulus = |quantity| one(quantity, all(quantity));
        let angle = |other: Quantity| {
            let tangent = modulus(Quantity::LossTangent)?;
            tangent.or(modulus(Quantity::PhaseAngle)?).ok_or_else(|| self.lacks(other))
        };
        let moduli = match (modulus(Quantity::Storage)?, modulus(Quantity::Loss)?) {
            (Some(storage), Some(loss)) => [storage, loss],
            (Some(found), None) | (None, Some(found)) => [found, angle(found.0)?],
            (None, None) => {
                let complex = modulus(Quantity::Complex)?.ok_or("no line names a frequency and a modulus")?;
                [complex, angle(Quantity::Complex)?]
            }
        };
        let places = [frequency, moduli[0].1, moduli[1].1];
        let start = body.iter().position(|line| line.has_numbers(places)).unwrap_or(body.len());
        let (units, body) = body.split_at(start);
        let factor = |(quantity, index): (Quantity, usize)| {
            let title = &self.titles[index];
            let factor = title.factor().or_else(|| unit_below(title, index, units));
            factor.or((quantity == Quantity::LossTangent).then_some(1.0)).ok_or_else(|| {
                let (line, name) = (self.line, quantity.name());
                format!("line {line}: the {name} `{}` has no unit that is known", title.text)
            })
        };
        let factors = [(Quantity::Frequency, frequency), moduli[0], moduli[1]];
        let factors = [factor(factors[0])?, factor(factors[1])?, factor(factors[2])?];
        let temperature = all(Quantity::Temperature)
            .first()
            .map(|(index, _)| *index)
            .filter(|_| !self.titles[frequency].is_reduced);
        Ok((Columns { frequency, moduli, factors, temperature, deformation }, body))
    }

    /// Returns the deformation of the moduli: that of tension if there are such, else what any title says.
    fn deformation(&self) -> Deformation {
        let moduli = || self.titles.iter().filter(|title| title.quantity.is_some_and(Quantity::is_modulus));
        let says = |title: &Title, deformation| title.deformation == Some(deformation);
        let is_tension = moduli().any(|title| says(title, Deformation::Tension));
        let is_shear = self.titles.iter().any(|title| says(title, Deformation::Shear));
        if is_shear && !is_tension { Deformation::Shear } else { Deformation::Tension }
    }

    /// Message for a modulus without a second quantity.
    fn lacks(&self, found: Quantity) -> String {
        let other = if found == Quantity::Loss { "storage modulus" } else { "loss modulus" };
        let (line, found) = (self.line, found.name());
        format!(
            "line {line} names a frequency and a {found}, expected also a {other}, tan δ or a phase angle"
        )
    }
}

/// Returns the factor of a column without a unit in its title: of the unit below it, else of the only one of
/// its kind in the lines below, whose cells blanks may shift.
fn unit_below(title: &Title, index: usize, lines: &[Line]) -> Option<f64> {
    let factor = |cell: &str| {
        let unit = Some(Unit::from_text(cell)?);
        Title { unit, text: String::new(), ..*title }.factor()
    };
    let below = lines.iter().find_map(|line| factor(line.cell(index)));
    below.or_else(|| {
        let cells = lines.iter().filter(|line| line.is_spaced).flat_map(|line| &line.cells);
        let mut all = cells.filter_map(|cell| factor(cell));
        let first = all.next()?;
        all.all(|other| other == first).then_some(first)
    })
}
