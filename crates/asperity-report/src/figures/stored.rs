//! Fields as they are stored, ready to be drawn.

use std::borrow::Cow;

use asperity_base::units::CELSIUS;
use asperity_base::{Field, Grid};
use asperity_study::io::fields::{Attribute, Fields};
use ndarray::Zip;

use crate::draw::{Colours, Map, Quantity, Relief, Unit};
use crate::error::{Error, Result};

/// A field as stored, with the grid that it lies on.
pub struct StoredArray {
    pub field: Field,
    pub grid: Grid,
    /// The lower body's column in which its corner is, or the nearest.
    pub(super) column: usize,
    /// Distance of its corner from the lower body's, in columns.
    pub place: f64,
}

impl StoredArray {
    pub fn read(fields: &Fields, name: &str) -> Result<Self> {
        let stored = fields.read(name)?;
        let pitch = [stored.pitch[0], stored.pitch[1]];
        let place = stored.origin[0] / pitch[0] - 0.5;
        let column = place.round().max(0.0) as usize;
        let field =
            stored.into_field().ok_or_else(|| Error::missing(format!("`{name}` is not a field"), None))?;
        let grid = Grid::new([field.nrows(), field.ncols()], pitch)?;
        Ok(Self { field, grid, column, place })
    }

    /// The same place with other values.
    pub fn with(&self, field: Field) -> Self {
        Self { field, ..*self }
    }

    /// Temperatures in °C.
    pub fn celsius(&self) -> Self {
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
        if let Some(range) = range_with_tension(&self.field) {
            return self.pressure_within(title, range);
        }
        self.map(title, "pressure", Unit::Pressure, Colours::Pressure)
            .missing("outside the overlap")
            .blank("no contact")
    }

    /// Pressures in colours over a range, which begins below 0 if there is tension.
    pub(super) fn pressure_within(&self, title: impl Into<String>, range: [f64; 2]) -> Map<'_> {
        let colours = of_pressures(range);
        let name = if colours == Colours::Signed { "pressure, tension below 0" } else { "pressure" };
        let map = self.map(title, name, Unit::Pressure, colours).missing("outside the overlap");
        map.blank("no contact").range(range)
    }

    pub(super) fn heights(&self, title: impl Into<String>) -> Map<'_> {
        self.map(title, "height", Unit::Length, Colours::Heights)
    }

    pub(super) fn relief(&self) -> Relief<'_> {
        Relief::of_heights(&self.field, &self.grid)
    }

    /// Where the cells of a pressure are elastic (1) and plastic (2). Those without contact have no pressure.
    pub fn contact(&self, cap: &Cap) -> Self {
        self.contact_on(&touched(&self.field), cap)
    }

    /// Where the cells of a pressure are elastic (1) and plastic (2), of those in contact: `touching` above
    /// 0.
    pub fn contact_on(&self, touching: &Field, cap: &Cap) -> Self {
        let class = |p: f64, touching: f64, cap: f64| match p {
            p if p >= cap * (1.0 - 1e-6) => 2.0,
            p if p.is_nan() => f64::NAN,
            _ if touching > 0.0 => 1.0,
            _ => 0.0,
        };
        self.with(match cap {
            Cap::Field(caps) => Zip::from(&self.field)
                .and(touching)
                .and(caps)
                .map_collect(|p, touching, cap| class(*p, *touching, *cap)),
            Cap::Number(cap) => {
                Zip::from(&self.field).and(touching).map_collect(|p, touching| class(*p, *touching, *cap))
            }
        })
    }

    /// Values above 0 on the cells in contact under this pressure: the field `contact` of bodies that attract
    /// each other at rest, which pull across the gap. Others have no pressure there.
    pub fn touching<'a>(fields: &Fields, pressure: &'a Self) -> Result<Cow<'a, Field>> {
        if fields.names()?.iter().any(|name| name == "contact") {
            Ok(Cow::Owned(Self::read(fields, "contact")?.field))
        } else {
            Ok(Cow::Borrowed(&pressure.field))
        }
    }
}

/// Values above 0 on the cells with a pressure or a tension.
pub(super) fn touched(pressure: &Field) -> Field {
    pressure.mapv(f64::abs)
}

/// Largest pressure at the end of the colours, as a multiple of the largest tension, which would be pale
/// beside a much larger one.
const MAX_RATIO: f64 = 4.0;

/// The colours of pressures over a range, which begins below 0 if there is tension.
pub(super) fn of_pressures(range: [f64; 2]) -> Colours {
    if range[0] < 0.0 { Colours::Signed } else { Colours::Pressure }
}

/// The ends of the colours of pressures with tension among them, the same above 0 as below; none without
/// tension.
pub(super) fn range_with_tension(pressure: &Field) -> Option<[f64; 2]> {
    let finite = || pressure.iter().copied().filter(|p| p.is_finite());
    let [low, high] = [finite().fold(0.0, f64::min), finite().fold(0.0, f64::max)];
    ends_with_tension([low, high])
}

/// The ends of the colours of pressures from `low` to `high`; none without tension.
pub(crate) fn ends_with_tension([low, high]: [f64; 2]) -> Option<[f64; 2]> {
    let end = high.min(-MAX_RATIO * low).max(-low);
    (low < 0.0).then_some([-end, end])
}

/// A field whose first column is the lower body's `first`, on that body's grid; what does not face the upper
/// body is undefined.
pub fn in_frame_of(field: &Field, first: usize, grid: Grid) -> Field {
    let mut framed = Field::from_elem(grid.shape, f64::NAN);
    for (column, values) in field.outer_iter().enumerate() {
        framed.row_mut((first + column) % grid.shape[0]).assign(&values);
    }
    framed
}

/// The largest pressure that a cell bears: below the hardness where shear softens what is plastic.
pub enum Cap {
    /// Of each cell.
    Field(Field),
    /// Of all cells.
    Number(f64),
}

impl Cap {
    /// The field `cap`, else the attribute `cap` of the file, else the hardness.
    pub fn read(fields: &Fields) -> Result<Self> {
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
