//! Fields as they are stored, ready to be drawn.

use asperity::io::fields::{Attribute, Fields};
use asperity::units::CELSIUS;
use asperity::{Field, Grid};

use crate::draw::{Colours, Map, Quantity, Relief, Unit};
use crate::report::{Failure, Outcome};

/// A field as stored, with the grid that it lies on.
pub(crate) struct StoredArray {
    pub(crate) field: Field,
    pub(crate) grid: Grid,
    /// The lower body's column in which its corner is, or the nearest.
    pub(super) column: usize,
    /// Distance of its corner from the lower body's, in columns.
    pub(crate) place: f64,
}

impl StoredArray {
    pub(crate) fn read(fields: &Fields, name: &str) -> Outcome<Self> {
        let stored = fields.read(name)?;
        let pitch = [stored.pitch[0], stored.pitch[1]];
        let place = stored.origin[0] / pitch[0] - 0.5;
        let column = place.round().max(0.0) as usize;
        let field =
            stored.into_field().ok_or_else(|| Failure::usage(format!("`{name}` is not a field"), None))?;
        let grid = Grid::new([field.nrows(), field.ncols()], pitch)?;
        Ok(Self { field, grid, column, place })
    }

    /// The same place with other values.
    pub(crate) fn with(&self, field: Field) -> Self {
        Self { field, ..*self }
    }

    /// Temperatures in °C.
    pub(crate) fn celsius(&self) -> Self {
        self.with(&self.field - CELSIUS)
    }

    /// The field on the grid of the lower body, undefined where nothing faces it.
    pub(super) fn framed(&self, grid: Grid) -> Self {
        Self { field: in_frame_of(&self.field, self.column, grid), grid, column: 0, place: 0.0 }
    }

    pub(super) fn map(&self, title: impl Into<String>, name: &str, unit: Unit, colours: Colours) -> Map<'_> {
        Map::new(title, &self.field, &self.grid, Quantity::new(name, unit), colours)
    }

    pub(super) fn pressure(&self, title: impl Into<String>) -> Map<'_> {
        self.map(title, "pressure", Unit::Pressure, Colours::Pressure)
            .missing("outside the overlap")
            .blank("no contact")
    }

    pub(super) fn heights(&self, title: impl Into<String>) -> Map<'_> {
        self.map(title, "height", Unit::Length, Colours::Heights)
    }

    pub(super) fn relief(&self) -> Relief<'_> {
        Relief::of_heights(&self.field, &self.grid)
    }

    /// Where the cells of a pressure are elastic (1) and plastic (2).
    pub(crate) fn contact(&self, cap: &Cap) -> Self {
        let class = |p: f64, cap: f64| match p {
            p if p >= cap * (1.0 - 1e-6) => 2.0,
            p if p > 0.0 => 1.0,
            p if p.is_nan() => f64::NAN,
            _ => 0.0,
        };
        self.with(match cap {
            Cap::Field(caps) => {
                let mut classes = self.field.clone();
                classes.zip_mut_with(caps, |p, cap| *p = class(*p, *cap));
                classes
            }
            Cap::Number(cap) => self.field.mapv(|p| class(p, *cap)),
        })
    }
}

/// A field whose first column is the lower body's `first`, on that body's grid; what does not face the upper body is
/// undefined.
pub(crate) fn in_frame_of(field: &Field, first: usize, grid: Grid) -> Field {
    let mut framed = Field::from_elem(grid.shape, f64::NAN);
    for (column, values) in field.outer_iter().enumerate() {
        framed.row_mut((first + column) % grid.shape[0]).assign(&values);
    }
    framed
}

/// The largest pressure that a cell bears: below the hardness where shear softens what is plastic.
pub(crate) enum Cap {
    /// Of each cell.
    Field(Field),
    /// Of all cells.
    Number(f64),
}

impl Cap {
    /// The field `cap`, else the attribute `cap` of the file, else the hardness.
    pub(crate) fn read(fields: &Fields) -> Outcome<Self> {
        if fields.names()?.iter().any(|name| name == "cap") {
            return Ok(Self::Field(StoredArray::read(fields, "cap")?.field));
        }
        let number = |name| match fields.attributes() {
            Ok(attributes) => match attributes.get(name) {
                Some(Attribute::Number(cap)) => Ok(Some(*cap)),
                _ => Ok(None),
            },
            Err(error) => Err(error),
        };
        Ok(Self::Number(number("cap")?.or(number("hardness")?).unwrap_or(f64::INFINITY)))
    }

    /// Whether there is a pressure at which a cell yields.
    pub(super) fn is_finite(&self) -> bool {
        match self {
            Self::Field(caps) => caps.iter().any(|cap| cap.is_finite()),
            Self::Number(cap) => cap.is_finite(),
        }
    }

    /// The colours of a contact of bodies that yield, or do not.
    pub(super) fn colours(&self) -> Colours {
        if self.is_finite() { Colours::CONTACT } else { Colours::TOUCH }
    }
}
