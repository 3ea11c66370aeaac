//! Two surfaces of different grids meet on a common one.

use asperity_base::{CellValues, Error, Field, Grid, ndarray};
use asperity_study::{Case, SurfaceInput, bodies, grids};
use asperity_surface::Topography;

use crate::support::parsed;

const STEEL: &str = "young = \"210 GPa\"\npoisson = 0.3\n";

/// A case of two named surfaces, the lower one with this hardness, with these lines under `[contact]`, and
/// further tables.
fn case_of(hardness: &str, contact: &str, more: &str) -> Case {
    parsed(&format!(
        "[lower]\n{STEEL}{hardness}\ntopography = {{ given = \"lower\" }}\n\
         [upper]\n{STEEL}topography = {{ given = \"upper\" }}\n[contact]\n{contact}\n{more}"
    ))
}

/// A case whose lower body has a map of the hardness.
fn case(contact: &str, more: &str) -> Case {
    case_of("hardness = { given = \"map\" }", contact, more)
}

/// A paraboloid about the centre of a grid, and a hardness of the lower body that grows along x.
fn given() -> SurfaceInput {
    let heights = |shape: [usize; 2], pitch: [f64; 2]| {
        let grid = Grid::new(shape, pitch).unwrap();
        let [lx, ly] = grid.extent();
        let z = |(i, j): (usize, usize)| {
            let (x, y) = (grid.centre(0, i) - 0.5 * lx, grid.centre(1, j) - 0.5 * ly);
            -(x * x + y * y) / 2e-2
        };
        Topography::new(grid, Field::from_shape_fn(shape, z)).unwrap()
    };
    let mut given = SurfaceInput::default();
    given.topographies.insert("lower".to_owned(), heights([64, 50], [1e-6, 1e-6]));
    given.topographies.insert("upper".to_owned(), heights([80, 60], [0.75e-6, 1.25e-6]));
    // The lower surface is resampled to 1.25 µm along y.
    given.hardness.insert("map".to_owned(), Field::from_shape_fn([64, 40], |(i, _)| 1e9 + i as f64 * 1e6));
    given
}

#[test]
fn surfaces_are_resampled_to_the_coarser_pitch_and_cropped_about_their_centres() {
    let common = case("load = \"0.1 N\"\ngrid = \"common\"", "");
    let both = bodies(&common, given()).unwrap();
    let expected = Grid::new([60, 40], [1e-6, 1.25e-6]).unwrap();
    for body in [&both.lower, &both.upper] {
        let grid = *body.topography.grid();
        assert_eq!(grid.shape, expected.shape);
        assert!((0..2).all(|axis| (grid.pitch[axis] / expected.pitch[axis] - 1.0).abs() < 1e-12));
        // The apex stays in the centre.
        let heights = body.topography.heights();
        let mirrored = heights.slice(ndarray::s![..;-1, ..;-1]);
        let range = heights.iter().fold(0.0, |most: f64, z| most.max(z.abs()));
        assert!(heights.iter().zip(&mirrored).all(|(a, b)| (a - b).abs() < 1e-3 * range));
    }
    assert_eq!(grids(&common, &given()).unwrap().map(|grid| grid.shape), [expected.shape; 2]);
    let CellValues::Field(hardness) = &both.lower.hardness else { panic!("a map") };
    assert_eq!((hardness.dim(), hardness[[0, 0]]), ((60, 40), 1e9 + 2e6));
    assert!(
        asperity_study::static_contact(&common, given(), &()).unwrap().fields.grid.shape == expected.shape
    );
    // Bodies of any length meet in an overlap.
    let overlap = case("load = \"0.1 N\"\ngrid = \"common\"", "[motion]\n");
    assert_eq!(grids(&overlap, &given()).unwrap().map(|grid| grid.shape), [[64, 40], [60, 40]]);
}

#[test]
fn without_a_common_grid_the_error_says_how_to_get_one() {
    let error = bodies(&case_of("", "load = \"0.1 N\"", ""), given()).unwrap_err();
    assert!(error.to_string().contains("different pitches"), "{error}");
    let Error::Case(case) = &error else { panic!("{error:?}") };
    assert!(case.hint.as_ref().unwrap().contains("`grid = \"common\"` in [contact]"), "{error:?}");
}
