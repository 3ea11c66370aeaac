//! The table of a law.

use std::fmt::Write as _;
use std::path::Path;

use super::law::{Band, Edge, Law};
use crate::io::atomic;
use asperity_base::error::Result;

impl Law {
    /// Writes the law as CSV. A row has the pressure, the closure of the median, and the median, the lower and the upper edge
    /// of each quantity. Unknown values leave their cells empty.
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
        for (n, (pressure, closure)) in self.pressures.iter().zip(self.closures(Edge::Median)).enumerate() {
            let _ = write!(csv, "{pressure:e},{closure:e}");
            for quantity in &self.quantities {
                let values: [Option<f64>; 3] = match quantity.bands[n] {
                    Some(Band { low, median, high }) => [Some(median), Some(low), Some(high)],
                    None => [None; 3],
                };
                let _ = write!(csv, ",{}", values.map(cell).join(","));
            }
            let row = &self.theories[n];
            let beside = [
                row.persson_fraction,
                row.bgt_fraction,
                row.persson_stiffness_of_area(),
                row.greenwood_williamson_pressure,
            ];
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
