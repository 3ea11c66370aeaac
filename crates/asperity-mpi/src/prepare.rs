//! The surfaces of a case on a grid that is distributed over ranks.

use std::sync::Arc;

use ndarray::s;

use crate::generate::{generate_slab, makes_slabs};
use asperity_base::error::Result;
use asperity_base::grid::{CellValues, Grid};
use asperity_base::ranks::{Ranks, Slab};
use asperity_study::SurfaceInput;
use asperity_study::case::{Body, Case, GridMatch, Layer, Mount, Source, TopographySpec};
use asperity_study::parts::{Fit, Place, grids, hardness, topography_of};
use asperity_study::{Bodies, MountedSurface, Origin, bodies};
use asperity_surface::{Form, Generator, Preparation, Topography};

/// The rows of this rank of the two surfaces of a case.
pub(crate) struct SlabBodies {
    /// The common grid, and the rows of this rank.
    pub(crate) slab: Slab,
    /// The lower and the upper body.
    pub(crate) bodies: [SlabBody; 2],
}

/// The rows of a surface as used in the contact.
pub(crate) struct SlabBody {
    pub(crate) topography: Topography,
    pub(crate) hardness: CellValues,
    pub(crate) hardness_sha256: Option<String>,
    pub(crate) origin: Option<Origin>,
}

/// Generates the topographies of a static contact by slabs, if both are generated without further
/// preparation. Otherwise each rank reads or generates and prepares them in full, and keeps only its own
/// rows.
///
/// # Errors
/// The errors of [`bodies`]; [`asperity_base::Error::TooManyRanks`].
pub(crate) fn slab_bodies(case: &Case, ranks: Arc<dyn Ranks>) -> Result<SlabBodies> {
    let specs = [&case.lower.topography, &case.upper.topography];
    if !specs.into_iter().all(made_by_slabs) || case.contact.grid == GridMatch::Common {
        let Bodies { lower, upper, .. } = bodies(case, SurfaceInput::default())?;
        let slab = Slab::new(ranks, *upper.topography.grid())?;
        let bodies = [cut(lower, &slab)?, cut(upper, &slab)?];
        return Ok(SlabBodies { slab, bodies });
    }
    let both = grids(case, &SurfaceInput::default())?;
    Fit::new(case, both).check(&[1, 0])?;
    let slab = Slab::new(ranks, Grid::new(both[1].shape, both[0].pitch)?)?;
    let bodies = [generate(case, "lower", &case.lower, &slab)?, generate(case, "upper", &case.upper, &slab)?];
    Ok(SlabBodies { slab, bodies })
}

/// Whether each rank generates only its own rows of a topography.
pub(crate) fn made_by_slabs(spec: &TopographySpec) -> bool {
    let source = match &spec.source {
        Source::Generate { generate, .. } => makes_slabs(generate),
        Source::Form { .. } => true,
        Source::File { .. } | Source::Given { .. } => false,
    };
    let layer = |layer: &Layer| match layer {
        Layer::Generate { generate, .. } => makes_slabs(generate),
        Layer::Form { .. } => true,
    };
    source && spec.preparation == Preparation::default() && spec.plus.iter().all(layer)
}

/// Generates the rows of a body on this rank.
fn generate(case: &Case, name: &str, body: &Body, slab: &Slab) -> Result<SlabBody> {
    let (table, spec) = (topography_of(name), &body.topography);
    let at = Place::new(case, &table, spec);
    let mount = body.mount.unwrap_or(Mount::TurnedOver);
    let turned_over = mount == Mount::TurnedOver;
    let generated = |generate: &Generator, seed| generate_slab(generate, slab, seed, turned_over);
    let formed = |form: &Form| form.rows_on(&slab.whole_grid(), slab.rows(), turned_over);
    let mut heights = match &spec.source {
        Source::Generate { generate, seed, .. } => generated(generate, *seed),
        Source::Form { form, .. } => formed(form),
        Source::File { .. } | Source::Given { .. } => unreachable!("heights that are made"),
    }
    .map_err(|error| at.parameter(error))?;
    for (n, layer) in spec.plus.iter().enumerate() {
        let added = match layer {
            Layer::Generate { generate, seed } => generated(generate, *seed),
            Layer::Form { form } => formed(form),
        };
        heights += &added.map_err(|error| at.parameter_of(&format!("plus.{n}."), error))?;
    }
    let topography = Topography::new(slab.grid(), heights)?;
    at.measurable(&topography)?;
    let given = &mut SurfaceInput::default();
    let (hardness, hardness_sha256) = hardness(case, name, body, &slab.whole_grid(), mount, given)?;
    Ok(SlabBody { topography, hardness: rows_of(hardness, slab), hardness_sha256, origin: None })
}

/// Returns the rows of a body that is read or generated in full.
fn cut(body: MountedSurface, slab: &Slab) -> Result<SlabBody> {
    let MountedSurface { topography, hardness, hardness_sha256, origin, .. } = body;
    let heights = topography.heights().slice(s![slab.rows(), ..]).to_owned();
    let topography = Topography::new(slab.grid(), heights)?;
    Ok(SlabBody { topography, hardness: rows_of(hardness, slab), hardness_sha256, origin })
}

/// Selects the values of this rank from those of all cells.
fn rows_of(values: CellValues, slab: &Slab) -> CellValues {
    match values {
        CellValues::Field(field) => CellValues::Field(field.slice(s![slab.rows(), ..]).to_owned()),
        uniform => uniform,
    }
}
