//! The figures of bodies that flow below their surfaces: plastic strain and residual stress on a section, and
//! the surface that is left.

use asperity_base::units::{Dimension, format};
use asperity_base::{Field, Grid};
use asperity_contact::motion::{IncrementRecord, PlasticStepRecord};
use asperity_study::io::fields::{Attribute, Fields};

use super::Curves;
use super::sheet::Sheet;
use super::stored::StoredArray;
use crate::draw::{Axis, Chart, Charts, Colours, Map, Maps, Mark, Quantity, Series, Unit};
use crate::error::{Error, Result};

/// Rows into which the thinnest layer is drawn.
const ROWS: f64 = 2.0;
/// Rows of a section, at most.
const MAX_ROWS: usize = 400;

/// Draws them, of each body that has flowed.
pub(super) fn draw(fields: &Fields, of: &str, sheet: &mut Sheet) -> Result {
    for PlasticSection { body, y, extent, strain, stress, surface } in plastic_sections(fields)? {
        let section = format!("{of}, section at y = {}", format(y, Dimension::Length));
        let ends = extent.map(|length| [0.0, length]);
        let map = |field, name, unit, colours| {
            Ok(Maps::new(vec![Map::section("", field, ends, Quantity::new(name, unit), colours)]))
        };
        let title = format!("accumulated plastic strain in the {body} body");
        sheet.add(&format!("plastic_strain_{body}"), &title, &section, || {
            map(&strain, "plastic strain", Unit::Number, Colours::Pressure)
        })?;
        if let Some(stress) = &stress {
            let title = format!("residual stress along x in the {body} body");
            sheet.add(&format!("residual_stress_{body}"), &title, &section, || {
                map(stress, "residual stress", Unit::Pressure, Colours::Signed)
            })?;
        }
        if let Some(surface) = &surface {
            let title = format!("change of height of the {body} body by plastic flow");
            sheet.add(&format!("residual_surface_{body}"), &title, of, || {
                Ok(Maps::new(vec![surface.map("", "change of height", Unit::Length, Colours::Signed)]))
            })?;
        }
    }
    Ok(())
}

/// What has flowed over the increments of a loading: the largest plastic strain and the plastic work so far;
/// none where nothing has.
pub(crate) fn of_increments(increments: &[IncrementRecord]) -> Option<Curves> {
    let steps: Vec<(f64, PlasticStepRecord)> =
        increments.iter().filter_map(|i| Some((i.increment as f64, i.plastic?))).collect();
    if steps.iter().all(|(_, plastic)| plastic.max_plastic_strain == 0.0) {
        return None;
    }
    let chart = |y, points| {
        let series = vec![Series::new("", points, Mark::LineAndPoints)];
        Chart::new("", Axis::linear("increment", Unit::Count), y, series)
    };
    let mut sum = 0.0;
    let work = steps.iter().map(|(x, plastic)| {
        sum += plastic.plastic_work;
        [*x, sum]
    });
    let work = work.collect();
    let strain = steps.iter().map(|(x, plastic)| [*x, 100.0 * plastic.max_plastic_strain]).collect();
    let charts = vec![
        chart(Axis::linear("largest plastic strain", Unit::Of("%")), strain),
        chart(Axis::of("plastic work so far", "plastic_work"), work),
    ];
    let title = "plastic strain and work over the increments";
    Some(Curves::new("plastic_flow", title, Charts { charts, columns: 2, aspect: 0.8 }))
}

/// A body that flows, on a section along x through its largest plastic strain.
pub(crate) struct PlasticSection {
    /// `lower` or `upper`.
    pub body: &'static str,
    /// Where the section is.
    pub y: f64,
    /// Length of the section and its depth.
    pub extent: [f64; 2],
    /// Accumulated plastic strain, evenly spaced along both.
    pub strain: Field,
    /// Residual stress along x, where it is kept.
    pub stress: Option<Field>,
    /// Change of the heights by plastic flow, where it is kept.
    pub surface: Option<StoredArray>,
}

/// The bodies that flow.
pub(crate) fn plastic_sections(fields: &Fields) -> Result<Vec<PlasticSection>> {
    let names = fields.names()?;
    let of = |body: &'static str| -> Result<Option<PlasticSection>> {
        let layered = |quantity: &str| -> Result<Option<Layered>> {
            let name = format!("{quantity}_{body}");
            if names.contains(&name) { Layered::read(fields, &name, body).map(Some) } else { Ok(None) }
        };
        let Some(accumulated) = layered("accumulated")? else { return Ok(None) };
        let row = accumulated.row_of_largest();
        let left = format!("residual_displacement_{body}");
        let left = if names.contains(&left) { Some(StoredArray::read(fields, &left)?) } else { None };
        Ok(Some(PlasticSection {
            body,
            y: accumulated.grid.centre(1, row),
            extent: [accumulated.grid.extent()[0], accumulated.faces[accumulated.faces.len() - 1]],
            strain: accumulated.section(row),
            stress: layered("residual_stress_xx")?.map(|stress| stress.section(row)),
            surface: left.map(|left| left.with(-&left.field)),
        }))
    };
    ["lower", "upper"].into_iter().map(of).filter_map(Result::transpose).collect()
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
    fn read(fields: &Fields, name: &str, body: &str) -> Result<Self> {
        let stored = fields.read(name)?;
        let damaged = || Error::missing(format!("`{name}` is not in layers"), None);
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
}
