//! A pair of contacting bodies.

use std::sync::Arc;

use crate::error::{Error, Result};
use crate::grid::{CellValues, Field, Grid, Placement, check_finite, flat_mut};
use crate::kernel::{CoupledResponse, SharedResponse, response};
use crate::lubrication::Lubrication;
use crate::material::{Compliances, Material, plastic_share};
use crate::math::{Bands, parallel};
use crate::motion::body::{Body, State};
use crate::motion::path::Position;
use crate::operator::{Boundary, Operators};
use crate::plasticity::PlasticBody;
use crate::solver::{Bounds, HardWall, Interface};
use crate::surface::Topography;
use crate::units::{Dimension, Metre, Pascal, SquareMetre, format_distinct};
use crate::viscoelastic::{BodyRelaxation, Creep, Relaxation, ViscoelasticStack};

/// Two contacting bodies, with the elastic response of their materials.
#[derive(Debug, Clone)]
pub struct Pair {
    /// The lower body.
    pub lower: Body,
    /// The upper body, with the heights of its underside.
    pub upper: Body,
    pitch: [Metre; 2],
    compliances: Compliances,
    response: SharedResponse,
    /// Prescribed share of the lower body in the plastic deformation; `None` if the softer of two cells takes
    /// all of it.
    share: Option<f64>,
    interface: Arc<dyn Interface>,
    /// The lower and the upper body as they relax; `None` if neither is viscoelastic.
    viscoelastic: Option<Viscoelastic>,
    lubrication: Option<Lubrication>,
}

/// Two bodies, of which one is viscoelastic, lower one first.
#[derive(Debug, Clone)]
pub(super) enum Viscoelastic {
    /// The composite creep compliance of each half-space.
    HalfSpaces([Creep; 2]),
    /// Bodies of which one has layers.
    Layered([ViscoelasticStack; 2]),
}

impl Pair {
    /// Creates a pair of bodies with these materials; `upper` is the height of the underside.
    ///
    /// # Errors
    /// [`Error::GridMismatch`] if pitches or transverse widths differ, [`Error::UndefinedSamples`] if heights
    /// are missing, [`Error::OutOfRange`] if both materials are rigid and neither has layers.
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
            interface: Arc::new(HardWall),
            viscoelastic: None,
            lubrication: None,
        })
    }

    /// Makes bodies viscoelastic, whose materials have the relaxed moduli: `relaxations` are those of the
    /// lower and of the upper body, `None` for an elastic one, or those of a body and its layers. A load on a body at
    /// rest is borne by the relaxed moduli.
    ///
    /// # Errors
    /// [`Error::Unsupported`] for relaxations of another number of layers than a body has.
    pub fn with_relaxation(
        mut self,
        materials: [&Material; 2],
        relaxations: [impl Into<BodyRelaxation>; 2],
    ) -> Result<Self> {
        let relaxations = relaxations.map(Into::into);
        self.viscoelastic = if relaxations.iter().all(BodyRelaxation::is_elastic) {
            None
        } else if materials.iter().any(|material| material.is_layered()) {
            let [lower, upper] = relaxations;
            let stack = |body: usize, relaxation| ViscoelasticStack::new(materials[body], relaxation);
            Some(Viscoelastic::Layered([stack(0, lower)?, stack(1, upper)?]))
        } else {
            let creep = |body: usize| {
                let &Material { young, poisson, .. } = materials[body];
                let relaxation = relaxations[body].body.as_ref();
                relaxation
                    .map_or(Creep::elastic(1.0 / young), Relaxation::creep)
                    .times(1.0 - poisson * poisson)
            };
            Some(Viscoelastic::HalfSpaces([creep(0), creep(1)]))
        };
        Ok(self)
    }

    /// Whether a body is viscoelastic.
    pub(super) fn relaxes(&self) -> bool {
        self.viscoelastic.is_some()
    }

    /// The viscoelastic bodies; `None` if neither is.
    pub(super) fn viscoelastic(&self) -> Option<&Viscoelastic> {
        self.viscoelastic.as_ref()
    }

    /// Composite creep compliance of both bodies together, as long as the same cells stay opposite each
    /// other; `None` if neither is viscoelastic, or one has layers.
    pub fn creep_together(&self) -> Option<Creep> {
        self.creep().map(|[lower, upper]| lower.plus(upper))
    }

    /// Composite creep compliance of the lower and of the upper body, (1 − ν²) J(t); `None` if neither is
    /// viscoelastic, or one has layers.
    pub fn creep(&self) -> Option<&[Creep; 2]> {
        match &self.viscoelastic {
            Some(Viscoelastic::HalfSpaces(creep)) => Some(creep),
            _ => None,
        }
    }

    /// Sets the hardness of the lower and of the upper body, each a number or a map of its cells.
    ///
    /// # Errors
    /// [`Error::OutOfRange`] for a hardness that is not above 0.
    ///
    /// # Panics
    /// If the shape of a map differs from that of its body.
    pub fn with_hardness(mut self, [lower, upper]: [CellValues; 2]) -> Result<Self> {
        (self.lower.hardness, self.upper.hardness) = (lower, upper);
        self.lower.validate()?;
        self.upper.validate()?;
        Ok(self)
    }

    /// Sets the share of the lower body in the plastic deformation, 0 … 1.
    pub fn with_plastic_share(self, share: f64) -> Self {
        Self { share: Some(share), ..self }
    }

    /// Sets the interface of the bodies, by default [`HardWall`]. Static contacts without friction and passes
    /// take it into account.
    #[must_use]
    pub fn with_interface(self, interface: Arc<dyn Interface>) -> Self {
        Self { interface, ..self }
    }

    /// Puts an oil between the bodies. A [`sweep`](crate::motion::sweep()) of speeds solves for its films.
    #[must_use]
    pub fn with_lubrication(self, lubrication: Option<Lubrication>) -> Self {
        Self { lubrication, ..self }
    }

    /// Whether cells are in contact where their pressure is above 0: between dry hard walls.
    pub fn touches_by_pressure(&self) -> bool {
        self.interface.is_hard() && self.lubrication.is_none()
    }

    /// The oil between the bodies; `None` between dry ones.
    pub fn lubrication(&self) -> Option<&Lubrication> {
        self.lubrication.as_ref()
    }

    /// Replaces the elastic response of the materials by another `response`.
    ///
    /// Hardness and plastic share stay those of the materials. So do [`Pair::modulus`] and
    /// [`Pair::compliances`], which then no longer affect any contact.
    pub fn with_response(self, response: impl Into<SharedResponse>) -> Self {
        Self { response: response.into(), ..self }
    }

    /// The interface of the bodies.
    pub fn interface(&self) -> &dyn Interface {
        self.interface.as_ref()
    }

    /// The interface of the bodies, for a solver.
    pub(super) fn shared_interface(&self) -> Arc<dyn Interface> {
        Arc::clone(&self.interface)
    }

    /// Size of a cell.
    pub fn pitch(&self) -> [Metre; 2] {
        self.pitch
    }

    /// Composite modulus E* of the bodies, without their layers.
    pub fn modulus(&self) -> Pascal {
        self.compliances.modulus()
    }

    /// Elastic compliances of the pair, without the layers.
    pub fn compliances(&self) -> &Compliances {
        &self.compliances
    }

    /// The elastic response of the bodies to a traction.
    pub fn response(&self) -> &SharedResponse {
        &self.response
    }

    /// Whether pressure displaces the bodies tangentially, and shear displaces them normally; false if the
    /// response to shear is unknown.
    pub(super) fn couples(&self) -> bool {
        self.response.coupled().is_some_and(CoupledResponse::couples)
    }

    /// Returns [`Error::Unsupported`] if contacts with stick are not solved between these bodies.
    pub(super) fn check_stick(&self) -> Result<()> {
        self.check_elastic()?;
        self.check_shear()
    }

    /// Returns [`Error::Unsupported`] if the response to shear is unknown.
    pub(super) fn check_shear(&self) -> Result<()> {
        self.response
            .coupled()
            .map(|_| ())
            .ok_or(Error::Unsupported("these bodies support friction only in gross sliding without coupling"))
    }

    /// Returns [`Error::Unsupported`] if a body is viscoelastic.
    pub(super) fn check_elastic(&self) -> Result<()> {
        match self.viscoelastic {
            Some(_) => Err(Error::Unsupported(
                "viscoelastic bodies slide steadily, pass over each other or are loaded in time without friction; nothing else is computed for them",
            )),
            None => Ok(()),
        }
    }

    /// Returns [`Error::Unsupported`] for lubricated bodies, of which only steady films are computed.
    pub(super) fn check_dry(&self) -> Result<()> {
        match self.lubrication {
            Some(_) => Err(Error::Unsupported("lubricated bodies in other contacts than steady films")),
            None => Ok(()),
        }
    }

    /// Returns [`Error::Unsupported`] if lubricated bodies are viscoelastic or attract each other.
    pub(super) fn check_lubricated(&self) -> Result<()> {
        if self.relaxes() || !self.interface.is_hard() {
            return Err(Error::Unsupported("lubricated bodies that are viscoelastic or attract each other"));
        }
        Ok(())
    }

    /// Returns [`Error::Unsupported`] if viscoelastic bodies yield or have an interface other than hard
    /// walls.
    pub(super) fn check_creep(&self) -> Result<()> {
        if self.relaxes() && (!self.interface.is_hard() || self.yields()) {
            Err(Error::Unsupported("viscoelastic bodies that attract each other or have a hardness"))
        } else {
            Ok(())
        }
    }

    /// Returns [`Error::Unsupported`] for viscoelastic bodies whose memory in time is not computed.
    pub(super) fn check_memory(&self) -> Result<()> {
        match self.viscoelastic {
            Some(Viscoelastic::Layered(_)) => Err(Error::Unsupported(
                "viscoelastic bodies with layers in other contacts than steady sliding",
            )),
            _ => self.check_creep(),
        }
    }

    /// Creates the operators of contacts on grids up to `largest`; [`Error::Unsupported`] if the response
    /// does not support the boundary.
    pub(super) fn operators(&self, largest: Grid, boundary: Boundary) -> Result<Operators> {
        self.check_line(&largest, boundary)?;
        Ok(Operators::new(largest, self.response.clone(), boundary))
    }

    /// Returns [`Error::Unsupported`] if the boundary is periodic along one axis of a grid and the response
    /// to a line of cells is unknown.
    pub fn check_line(&self, largest: &Grid, boundary: Boundary) -> Result<()> {
        let line = boundary.line(largest, boundary.datum(largest));
        if line.is_some_and(|line| self.response.line_influence(&line, self.pitch).is_none()) {
            return Err(Error::Unsupported(
                "these bodies do not support a boundary that is periodic along one axis only",
            ));
        }
        Ok(())
    }

    /// Returns the shares of the lower and of the upper body in the plastic deformation of cells with this
    /// `hardness`: all for the softer, half each if both are equally hard.
    pub fn plastic_shares(&self, hardness: [Pascal; 2]) -> [f64; 2] {
        let lower = self.share.unwrap_or_else(|| plastic_share(hardness[0], hardness[1]));
        [lower, 1.0 - lower]
    }

    /// Whether any cell of the pair can deform plastically.
    pub fn yields(&self) -> bool {
        self.lower.hardness.min().min(self.upper.hardness.min()).is_finite()
    }

    /// Checks that no elasto-plastic body, lower one first, has a hardness besides.
    ///
    /// # Errors
    /// [`Error::Unsupported`].
    pub(super) fn check_flow(&self, bodies: &[Option<PlasticBody>; 2]) -> Result<()> {
        let mut hardness = [&self.lower, &self.upper].map(|body| body.hardness.min()).into_iter().zip(bodies);
        if hardness.any(|(hardness, body)| body.is_some() && hardness.is_finite()) {
            Err(Error::Unsupported("an elasto-plastic body does not take a hardness"))
        } else {
            Ok(())
        }
    }

    /// Largest pressure that any two opposing cells can carry; infinite if both are elastic.
    pub fn max_hardness(&self) -> Pascal {
        self.lower.hardness.max().min(self.upper.hardness.max())
    }

    /// Smallest pressure that any two opposing cells can carry.
    pub fn min_hardness(&self) -> Pascal {
        self.lower.hardness.min().min(self.upper.hardness.min())
    }

    /// Returns the pressure bounds on the cells of the overlap without shear: the hardness of the softer
    /// cell.
    pub fn bounds(&self, position: &Position) -> Bounds {
        self.bounds_of([&self.lower.hardness, &self.upper.hardness], position)
    }

    /// Returns the bounds for bodies on the same grids with this hardness, lower one first.
    pub(super) fn bounds_of(&self, hardness: [&CellValues; 2], position: &Position) -> Bounds {
        let shapes = [self.lower_grid().shape, self.upper_grid().shape];
        Bounds::up_to(opposing_values(hardness, shapes, position, f64::min))
    }

    /// Returns the single position of a static contact at full overlap.
    pub fn at_rest(&self) -> Position {
        Position::flush(self.lower.columns())
    }

    /// Area ΔA of a cell.
    pub fn cell_area(&self) -> SquareMetre {
        self.pitch[0] * self.pitch[1]
    }

    /// Length over which the load changes by a factor of about e, for a first guess: a tenth of the roughness.
    pub(super) fn height_scale(&self) -> Metre {
        let roughness = self.lower.heights.std(0.0).hypot(self.upper.heights.std(0.0));
        if roughness > 0.0 { 0.1 * roughness } else { self.pitch[0] }
    }

    /// The lower body's grid.
    pub fn lower_grid(&self) -> Grid {
        self.grid(self.lower.columns())
    }

    /// The upper body's grid.
    pub fn upper_grid(&self) -> Grid {
        self.grid(self.upper.columns())
    }

    /// Creates a grid with `columns` columns of this pair.
    pub fn grid(&self, columns: usize) -> Grid {
        Grid { shape: [columns, self.lower.width()], pitch: self.pitch }
    }

    /// Checks the heights of both bodies, and the state that laws store with them.
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

    /// Undeformed gap h = z₂ − z₁ of the cells of the overlap.
    pub fn initial_gap(&self, position: &Position) -> Field {
        initial_gap([&self.lower.heights, &self.upper.heights], position)
    }

    /// Placement of the contact at `position` on the lower and on the upper body.
    pub fn placements(&self, position: &Position) -> [Placement; 2] {
        position.placements([self.lower_grid().shape, self.upper_grid().shape])
    }

    /// Returns the flat cells of the lower and of the upper body under a flat cell of the contact at
    /// `position`. If it lies between two columns, this is the first one, whose weight is 1 −
    /// [`Position::fraction`].
    pub fn cells_of_bodies(&self, position: &Position, cell: usize) -> [usize; 2] {
        self.placements(position).map(|placement| placement.cell(cell))
    }
}

/// Combines by `of` the values of two bodies of these shapes at opposing cells.
pub fn opposing_values(
    values: [&CellValues; 2],
    shapes: [[usize; 2]; 2],
    position: &Position,
    of: impl Fn(f64, f64) -> f64,
) -> CellValues {
    if let [CellValues::Uniform(lower), CellValues::Uniform(upper)] = values {
        return CellValues::Uniform(of(*lower, *upper));
    }
    let shape = [position.columns, shapes[0][1]];
    let [lower, upper] = position.placements(shapes);
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

/// Undeformed gap h = z₂ − z₁ between opposing cells of the lower and of the upper surface.
pub fn initial_gap(surfaces: [&Field; 2], position: &Position) -> Field {
    let [lower, upper] = position.placements(surfaces.map(|surface| [surface.nrows(), surface.ncols()]));
    let shape = [position.columns, surfaces[0].ncols()];
    let mut gap = Field::zeros(shape);
    let bands = Bands::new(shape);
    parallel::map(bands.rows().zip(bands.cut_mut(flat_mut(&mut gap))), |(rows, gap)| {
        for (j, row) in rows.zip(gap.chunks_mut(shape[1])) {
            upper.for_column(surfaces[1], j, row, |h, z2| *h = z2);
            lower.for_column(surfaces[0], j, row, |h, z1| *h -= z1);
        }
    });
    gap
}
