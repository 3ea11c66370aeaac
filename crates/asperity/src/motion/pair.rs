//! Two bodies that face each other.

use crate::error::{Error, Result};
use crate::grid::{CellValues, Field, Grid, Seat, check_finite};
use crate::kernel::{SharedResponse, response};
use crate::material::{Compliances, Material, plastic_share};
use crate::motion::body::{Body, State};
use crate::motion::path::Position;
use crate::operator::{Boundary, Operators};
use crate::solver::{Bounds, Friction};
use crate::surface::Topography;
use crate::units::{Dimension, Metre, Pascal, SquareMetre, format_distinct};

/// Two bodies that face each other, with the elastic response of their materials.
#[derive(Debug, Clone)]
pub struct Pair {
    /// The lower body.
    pub lower: Body,
    /// The upper body; its heights are those of its underside.
    pub upper: Body,
    pitch: [Metre; 2],
    compliances: Compliances,
    response: SharedResponse,
    /// The lower body's share of the plastic deformation, where it is not for the softer of two cells to take it.
    share: Option<f64>,
}

impl Pair {
    /// Two bodies of these materials; `upper` is the height of the underside.
    ///
    /// # Errors
    /// [`Error::GridMismatch`] if pitches or transverse widths differ, [`Error::UndefinedSamples`] where heights are
    /// missing, [`Error::OutOfRange`] if both materials are rigid and neither is coated.
    pub fn new(lower: Topography, upper: Topography, materials: [&Material; 2]) -> Result<Self> {
        let (a, b) = (*lower.grid(), *upper.grid());
        if (0..2).any(|axis| (a.pitch[axis] - b.pitch[axis]).abs() > 1e-9 * a.pitch[axis]) {
            let axis = usize::from((a.pitch[0] - b.pitch[0]).abs() <= 1e-9 * a.pitch[0]);
            let [left, right] = format_distinct([a.pitch[axis], b.pitch[axis]], Dimension::Length);
            let what = ["pitch of the two bodies along x", "pitch of the two bodies along y"][axis];
            return Err(Error::GridMismatch { what, left, right });
        }
        if a.shape[1] != b.shape[1] {
            let text = |g: Grid| format!("{} cells across", g.shape[1]);
            return Err(Error::GridMismatch {
                what: "transverse width of the two bodies",
                left: text(a),
                right: text(b),
            });
        }
        for body in [&lower, &upper] {
            let undefined = body.undefined();
            if undefined > 0 {
                return Err(Error::UndefinedSamples { undefined, samples: body.grid().cells() });
            }
        }
        let compliances = Compliances::new(materials[0], materials[1])?;
        Ok(Self {
            pitch: a.pitch,
            lower: Body::new(lower.into_heights(), materials[0].hardness),
            upper: Body::new(upper.into_heights(), materials[1].hardness),
            compliances,
            response: response(materials[0], materials[1])?,
            share: None,
        })
    }

    /// The same pair with another hardness of the lower and of the upper body, each a number or a map of its cells.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for a hardness that is not above 0.
    ///
    /// # Panics
    /// If a map has another shape than its body.
    pub fn with_hardness(mut self, [lower, upper]: [CellValues; 2]) -> Result<Self> {
        (self.lower.hardness, self.upper.hardness) = (lower, upper);
        self.lower.validate()?;
        self.upper.validate()?;
        Ok(self)
    }

    /// The same pair with another division of the plastic deformation: `share` of it to the lower body, 0 … 1.
    pub fn with_plastic_share(self, share: f64) -> Self {
        Self { share: Some(share), ..self }
    }

    /// The same surfaces on bodies of another `response` than that of the materials.
    ///
    /// Hardness and plastic share stay those of the materials; so do [`Pair::modulus`] and [`Pair::compliances`], which no
    /// contact depends on then.
    pub fn with_response(self, response: impl Into<SharedResponse>) -> Self {
        Self { response: response.into(), ..self }
    }

    /// Size of a cell.
    pub fn pitch(&self) -> [Metre; 2] {
        self.pitch
    }

    /// Composite modulus E* of the bodies without their coatings.
    pub fn modulus(&self) -> Pascal {
        self.compliances.modulus()
    }

    /// The elastic constants of the pair without the coatings.
    pub fn compliances(&self) -> &Compliances {
        &self.compliances
    }

    /// The elastic response of the bodies to a traction.
    pub fn response(&self) -> &SharedResponse {
        &self.response
    }

    /// Whether pressure displaces the bodies tangentially and shear normally; false where the response to shear is not known.
    pub(super) fn couples(&self) -> bool {
        self.response.coupled().is_some_and(|coupled| coupled.couples())
    }

    /// Refuses bodies whose response to shear is not known, by [`Error::Unsupported`].
    pub(super) fn check_shear(&self) -> Result<()> {
        self.response
            .coupled()
            .map(|_| ())
            .ok_or(Error::Unsupported("these bodies support friction only in gross sliding without coupling"))
    }

    /// The operators of contacts on the cells of a `largest` grid; [`Error::Unsupported`] where the response knows no such
    /// boundary.
    pub(super) fn operators(&self, largest: Grid, boundary: Boundary) -> Result<Operators> {
        self.check_line(&largest, boundary)?;
        Ok(Operators::new(largest, self.response.clone(), boundary))
    }

    /// Refuses a boundary that is periodic along one axis of a grid for bodies whose response to a line of cells is not known, by
    /// [`Error::Unsupported`].
    pub(super) fn check_line(&self, largest: &Grid, boundary: Boundary) -> Result<()> {
        let line = boundary.line(largest, boundary.datum(largest));
        if line.is_some_and(|line| self.response.line_influence(&line, self.pitch).is_none()) {
            return Err(Error::Unsupported(
                "these bodies do not support a boundary that is periodic along one axis only",
            ));
        }
        Ok(())
    }

    /// The shares of the plastic deformation that the lower and the upper body take where cells of this `hardness` face each
    /// other: all of it the softer, half of it each where both are equally hard.
    pub fn plastic_shares(&self, hardness: [Pascal; 2]) -> [f64; 2] {
        let lower = self.share.unwrap_or_else(|| plastic_share(hardness[0], hardness[1]));
        [lower, 1.0 - lower]
    }

    /// Whether any cell of the pair can deform plastically.
    pub fn yields(&self) -> bool {
        self.lower.hardness.min().min(self.upper.hardness.min()).is_finite()
    }

    /// The most pressure that any two cells bear where they face each other, infinite where both are elastic.
    pub fn max_hardness(&self) -> Pascal {
        self.lower.hardness.max().min(self.upper.hardness.max())
    }

    /// The least pressure that two cells bear where they face each other.
    pub fn min_hardness(&self) -> Pascal {
        self.lower.hardness.min().min(self.upper.hardness.min())
    }

    /// Bounds of the pressure on the cells that face each other: none above the hardness of the softer, nor above what the
    /// shear of bodies that slide under `friction` leaves of it.
    pub fn bounds(&self, position: &Position, friction: Option<&Friction>) -> Bounds {
        self.bounds_of([&self.lower.hardness, &self.upper.hardness], position, friction)
    }

    /// The bounds of bodies on the same grids that have this hardness, lower one first.
    pub(super) fn bounds_of(
        &self,
        hardness: [&CellValues; 2],
        position: &Position,
        friction: Option<&Friction>,
    ) -> Bounds {
        let shapes = [self.lower_grid().shape, self.upper_grid().shape];
        let bounds = Bounds::up_to(facing_values(hardness, shapes, position, f64::min));
        friction.map_or_else(|| bounds.clone(), |friction| friction.sliding_bounds(&bounds))
    }

    /// The one position of a contact at rest, whose bodies face each other with all their columns.
    pub fn at_rest(&self) -> Position {
        Position::flush(self.lower.columns())
    }

    /// Area ΔA of a cell.
    pub fn cell_area(&self) -> SquareMetre {
        self.pitch[0] * self.pitch[1]
    }

    /// The lower body's grid.
    pub fn lower_grid(&self) -> Grid {
        self.grid(self.lower.columns())
    }

    /// The upper body's grid.
    pub fn upper_grid(&self) -> Grid {
        self.grid(self.upper.columns())
    }

    /// A grid of so many columns of this pair.
    pub fn grid(&self, columns: usize) -> Grid {
        Grid { shape: [columns, self.lower.width()], pitch: self.pitch }
    }

    /// Checks the heights of both bodies, and what laws keep of them.
    ///
    /// # Errors
    /// [`Error::NotFinite`].
    pub(super) fn check_finite(&self) -> Result<()> {
        for (name, body) in [("lower", &self.lower), ("upper", &self.upper)] {
            check_finite(name, body.heights.shape(), &body.heights)?;
            for (state, State { values, .. }) in &body.state {
                check_finite(&format!("{state}_{name}"), values.shape(), values)?;
            }
        }
        Ok(())
    }

    /// Undeformed gap h = z₂ − z₁ of the cells that face each other.
    pub fn initial_gap(&self, position: &Position) -> Field {
        initial_gap([&self.lower.heights, &self.upper.heights], position)
    }

    /// How the cells of the contact at `position` lie on the lower and on the upper body.
    pub(crate) fn seats(&self, position: &Position) -> [Seat; 2] {
        position.seats([self.lower_grid().shape, self.upper_grid().shape])
    }

    /// The flat cells of the lower and of the upper body under a flat cell of the contact at `position`: of the two that it may lie
    /// between the one before, whose part is 1 − [`Position::fraction`].
    pub fn cells_of_bodies(&self, position: &Position, cell: usize) -> [usize; 2] {
        self.seats(position).map(|seat| seat.cell(cell))
    }
}

/// The values `of` of the values of two bodies of these shapes where their cells face each other.
pub(crate) fn facing_values(
    values: [&CellValues; 2],
    shapes: [[usize; 2]; 2],
    position: &Position,
    of: impl Fn(f64, f64) -> f64,
) -> CellValues {
    if let [CellValues::Uniform(lower), CellValues::Uniform(upper)] = values {
        return CellValues::Uniform(of(*lower, *upper));
    }
    let shape = [position.columns, shapes[0][1]];
    let [lower, upper] = position.seats(shapes);
    let mut facing = Field::zeros(shape);
    let mut above = vec![0.0; shape[1]];
    for (j, mut row) in facing.outer_iter_mut().enumerate() {
        let row = row.as_slice_mut().expect("standard layout");
        lower.fill(values[0], j, row);
        upper.fill(values[1], j, &mut above);
        row.iter_mut().zip(&above).for_each(|(value, above)| *value = of(*value, *above));
    }
    CellValues::Field(facing)
}

/// Undeformed gap h = z₂ − z₁ of the cells of the lower and the upper surface that face each other.
pub(crate) fn initial_gap(surfaces: [&Field; 2], position: &Position) -> Field {
    let [lower, upper] = position.seats(surfaces.map(|surface| [surface.nrows(), surface.ncols()]));
    let mut gap = Field::zeros([position.columns, surfaces[0].ncols()]);
    for (j, mut row) in gap.outer_iter_mut().enumerate() {
        let row = row.as_slice_mut().expect("standard layout");
        upper.for_column(surfaces[1], j, row, |h, z2| *h = z2);
        lower.for_column(surfaces[0], j, row, |h, z1| *h -= z1);
    }
    gap
}
