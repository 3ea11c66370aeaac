//! The table of a law.

use std::fmt::Write as _;
use std::path::Path;

use super::law::{Band, Law};
use super::quantities::Kind;
use crate::io::atomic;
use asperity_base::error::Result;

impl Law {
    /// Writes the law as CSV: a row for each pressure, with median, lower and upper edge of each quantity, and the closure
    /// of the median. Unknown values are empty.
    pub fn csv(&self) -> String {
        let head = |name: &str, unit: &str| {
            if unit.is_empty() { name.to_owned() } else { format!("{name} ({unit})") }
        };
        let mut columns = vec![head("mean_pressure", "Pa"), head("closure", "m")];
        for quantity in &self.quantities {
            let (name, unit) = (quantity.kind.name(), quantity.kind.unit());
            columns.extend(["", "_low", "_high"].map(|edge| head(&format!("{name}{edge}"), unit)));
        }
        let theories = [
            "persson_fraction",
            "bgt_fraction",
            "persson_stiffness (Pa/m)",
            "greenwood_williamson_pressure (Pa)",
        ];
        columns.extend(theories.map(str::to_owned));
        let mut csv = columns.join(",") + "\n";
        let cell = |value: Option<f64>| {
            value.filter(|value| value.is_finite()).map_or(String::new(), |value| format!("{value:e}"))
        };
        for (n, pressure) in self.pressures.iter().enumerate() {
            let gap = self.quantity(Kind::MeanGap).and_then(|gap| gap.bands[n]);
            let _ = write!(csv, "{pressure:e},{}", cell(gap.map(|gap| self.datum - gap.median)));
            for quantity in &self.quantities {
                let values: [Option<f64>; 3] = match quantity.bands[n] {
                    Some(Band { low, median, high }) => [Some(median), Some(low), Some(high)],
                    None => [None; 3],
                };
                let _ = write!(csv, ",{}", values.map(cell).join(","));
            }
            let row = &self.theories[n];
            let of_area = row.persson_stiffness.map(|stiffness| stiffness * row.mean_pressure / row.load);
            let beside = [row.persson_fraction, row.bgt_fraction, of_area, row.greenwood_williamson_pressure];
            let _ = writeln!(csv, ",{}", beside.map(cell).join(","));
        }
        csv
    }

    /// Writes the [table](Self::csv), atomically.
    ///
    /// # Errors
    /// [`asperity_base::Error::File`].
    pub fn write_csv(&self, path: &Path) -> Result<()> {
        atomic::replace(path, self.csv().as_bytes())
    }
}
