//! Two bodies that face each other.

use crate::error::{Error, Result};
use crate::grid::{Field, Grid};
use crate::kernel::SharedResponse;
use crate::material::{Compliances, Material, composite_hardness, plastic_share};
use crate::motion::path::Position;
use crate::operator::{Boundary, Operators};
use crate::surface::Topography;
use crate::units::{Dimension, Metre, Pascal, SquareMetre, format_distinct};

/// The two surfaces, and what the materials make of them together.
#[derive(Debug, Clone)]
pub struct Pair {
    /// Heights of the lower surface, m.
    pub lower: Field,
    /// Heights of the upper body's underside, m.
    pub upper: Field,
    pitch: [Metre; 2],
    compliances: Compliances,
    response: SharedResponse,
    hardness: Pascal,
    cap: Pascal,
    share: f64,
}

impl Pair {
    /// Two bodies; `upper` is the height of the underside.
    ///
    /// # Errors
    /// [`Error::GridMismatch`] if pitches or transverse widths differ, [`Error::UndefinedSamples`] where heights are
    /// missing, [`Error::OutOfRange`] if both materials are rigid.
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
        let hardness = composite_hardness(materials[0], materials[1]);
        Ok(Self {
            pitch: a.pitch,
            lower: lower.into_heights(),
            upper: upper.into_heights(),
            compliances,
            response: compliances.into(),
            hardness,
            cap: hardness,
            share: plastic_share(materials[0], materials[1]),
        })
    }

    /// The same pair with another division of the plastic deformation: `share` of it to the lower body, 0 … 1.
    pub fn with_plastic_share(self, share: f64) -> Self {
        Self { share, ..self }
    }

    /// The same pair, whose cells bear at most the pressure `cap`, > 0.
    pub fn with_cap(self, cap: Pascal) -> Self {
        Self { cap, ..self }
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

    /// Composite modulus E*.
    pub fn modulus(&self) -> Pascal {
        self.compliances.modulus()
    }

    /// The elastic constants of the pair.
    pub fn compliances(&self) -> &Compliances {
        &self.compliances
    }

    /// What the bodies answer to a traction.
    pub fn response(&self) -> &SharedResponse {
        &self.response
    }

    /// Whether a pressure displaces tangentially and a shear normally, as far as that is known.
    pub(super) fn couples(&self) -> bool {
        self.response.coupled().is_some_and(|coupled| coupled.couples())
    }

    /// [`Error::Unsupported`] where what shear does is not known.
    pub(super) fn check_shear(&self) -> Result<()> {
        self.response.coupled().map(|_| ()).ok_or(Error::Unsupported(
            "what shear does to these bodies is not known: their friction is that of full sliding without coupling",
        ))
    }

    /// The operators of contacts on the cells of a `largest` grid; [`Error::Unsupported`] where the response knows no such
    /// boundary.
    pub(super) fn operators(&self, largest: Grid, boundary: Boundary) -> Result<Operators> {
        let line = boundary.line(&largest, boundary.datum(&largest));
        if line.is_some_and(|line| self.response.line_influence(&line, self.pitch).is_none()) {
            return Err(Error::Unsupported(
                "these bodies have no boundary that is periodic along one axis alone",
            ));
        }
        Ok(Operators::new(largest, self.response.clone(), boundary))
    }

    /// Hardness of the pair, infinite where both bodies are elastic.
    pub fn hardness(&self) -> Pascal {
        self.hardness
    }

    /// The most pressure that a cell bears: the hardness, or what a shear leaves of it.
    pub fn cap(&self) -> Pascal {
        self.cap
    }

    /// The lower body's share of the plastic deformation.
    pub fn plastic_share(&self) -> f64 {
        self.share
    }

    /// Whether the pair can deform plastically.
    pub fn yields(&self) -> bool {
        self.hardness.is_finite()
    }

    /// Area ΔA of a cell.
    pub fn cell_area(&self) -> SquareMetre {
        self.pitch[0] * self.pitch[1]
    }

    /// The lower body's grid.
    pub fn lower_grid(&self) -> Grid {
        self.grid(self.lower.nrows())
    }

    /// The upper body's grid.
    pub fn upper_grid(&self) -> Grid {
        self.grid(self.upper.nrows())
    }

    /// A grid of so many columns of this pair.
    pub fn grid(&self, columns: usize) -> Grid {
        Grid { shape: [columns, self.lower.ncols()], pitch: self.pitch }
    }

    /// Undeformed gap h = z₂ − z₁ of the cells that face each other.
    pub fn initial_gap(&self, position: &Position) -> Field {
        initial_gap([&self.lower, &self.upper], position)
    }

    /// Of a flat cell of the contact at `position`: its flat cells of the lower and of the upper body.
    pub fn cells_of_bodies(&self, position: &Position, cell: usize) -> [usize; 2] {
        let width = self.lower.ncols();
        let (column, across) = (cell / width, cell % width);
        [
            (position.lower + column) % self.lower.nrows() * width + across,
            (position.upper + column) % self.upper.nrows() * width + across,
        ]
    }
}

/// Undeformed gap h = z₂ − z₁ of the cells of the lower and the upper surface that face each other.
pub(crate) fn initial_gap(surfaces: [&Field; 2], position: &Position) -> Field {
    let [lower, upper] = surfaces;
    let mut gap = Field::zeros([position.columns, lower.ncols()]);
    for (j, mut row) in gap.outer_iter_mut().enumerate() {
        let lower = lower.row((position.lower + j) % lower.nrows());
        let upper = upper.row((position.upper + j) % upper.nrows());
        ndarray::Zip::from(&mut row).and(lower).and(upper).for_each(|h, z1, z2| *h = z2 - z1);
    }
    gap
}
