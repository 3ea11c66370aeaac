//! The figures of bodies that flow below their surfaces: plastic strain and residual stress on a section, and the surface that is left.

use asperity::io::fields::{Attribute, Fields};
use asperity::units::{Dimension, format};
use asperity::{Field, Grid};

use super::sheet::Sheet;
use super::stored::Stored;
use crate::draw::{Colours, Map, Maps, Quantity, Unit};
use crate::report::{Failure, Outcome};

/// Rows into which the thinnest layer is drawn.
const ROWS: f64 = 2.0;
/// Rows of a section, at most.
const MAX_ROWS: usize = 400;

/// Draws them, of each body that has flowed.
pub(super) fn draw(fields: &Fields, of: &str, sheet: &mut Sheet) -> Outcome {
    let names = fields.names()?;
    for body in ["lower", "upper"] {
        let name = |quantity: &str| format!("{quantity}_{body}");
        if !names.contains(&name("accumulated")) {
            continue;
        }
        let accumulated = Layered::read(fields, &name("accumulated"), body)?;
        let stress = Layered::read(fields, &name("residual_stress_xx"), body)?;
        let row = accumulated.row_of_largest();
        let section =
            format!("{of}, section at y = {}", format(accumulated.grid.centre(1, row), Dimension::Length));
        let [strain, residual] = [&accumulated, &stress].map(|layered| layered.section(row));
        sheet.add(
            &name("plastic_strain"),
            &format!("accumulated plastic strain in the {body} body"),
            &section,
            || {
                let ends = accumulated.ends();
                Ok(Maps::new(vec![Map::section(
                    "",
                    &strain,
                    ends,
                    Quantity::new("plastic strain", Unit::Number),
                    Colours::Pressure,
                )]))
            },
        )?;
        sheet.add(
            &name("residual_stress"),
            &format!("residual stress along x in the {body} body"),
            &section,
            || {
                let quantity = Quantity::new("residual stress", Unit::Pressure);
                Ok(Maps::new(vec![Map::section("", &residual, stress.ends(), quantity, Colours::Heights)]))
            },
        )?;
        let left = Stored::read(fields, &name("residual_displacement"))?;
        let surface = left.with(-&left.field);
        sheet.add(
            &name("residual_surface"),
            &format!("what flow leaves of the surface of the {body} body"),
            of,
            || Ok(Maps::new(vec![surface.heights("")])),
        )?;
    }
    Ok(())
}

/// Values in the layers of a body, `[ix, iy, iz]`.
struct Layered {
    values: Vec<f64>,
    shape: [usize; 3],
    grid: Grid,
    /// Depths of the faces of the layers.
    faces: Vec<f64>,
}

impl Layered {
    fn read(fields: &Fields, name: &str, body: &str) -> Outcome<Self> {
        let stored = fields.read(name)?;
        let damaged = || Failure::usage(format!("`{name}` is not in layers"), None);
        let attributes = fields.attributes()?;
        let Some(Attribute::Numbers(faces)) = attributes.get(&format!("depths_{body}")) else {
            return Err(damaged());
        };
        let shape: [usize; 3] = stored.values.shape().try_into().map_err(|_| damaged())?;
        let grid = Grid::new([shape[0], shape[1]], [stored.pitch[0], stored.pitch[1]])?;
        Ok(Self { values: stored.values.into_iter().collect(), shape, grid, faces: faces.clone() })
    }

    fn at(&self, [ix, iy, iz]: [usize; 3]) -> f64 {
        self.values[(ix * self.shape[1] + iy) * self.shape[2] + iz]
    }

    /// The row of cells along x under which the largest value lies.
    fn row_of_largest(&self) -> usize {
        let largest = (0..self.values.len()).max_by(|a, b| self.values[*a].total_cmp(&self.values[*b]));
        largest.map_or(0, |index| index / self.shape[2] % self.shape[1])
    }

    /// The values under a row of cells, evenly spaced in depth.
    fn section(&self, row: usize) -> Field {
        let thinnest = self.faces.windows(2).map(|pair| pair[1] - pair[0]).fold(f64::INFINITY, f64::min);
        let depth = self.faces[self.faces.len() - 1];
        let rows = ((ROWS * depth / thinnest).round() as usize).clamp(1, MAX_ROWS);
        Field::from_shape_fn([self.shape[0], rows], |(ix, k)| {
            let z = (k as f64 + 0.5) * depth / rows as f64;
            let layer = self.faces[1..].iter().take_while(|face| **face <= z).count().min(self.shape[2] - 1);
            self.at([ix, row, layer])
        })
    }

    fn ends(&self) -> [[f64; 2]; 2] {
        [[0.0, self.grid.extent()[0]], [0.0, self.faces[self.faces.len() - 1]]]
    }
}
