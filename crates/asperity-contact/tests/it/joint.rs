//! The area of contact, corrected for the edges of spots.

use asperity_contact::motion::corrected_area;
use asperity_contact::operator::FreeFft;
use asperity_contact::reference::HertzSphere;
use asperity_contact::solver::{Bounds, Control, Params, solve_normal};
use asperity_contact::{Field, Grid};

/// Balls at several places between cells: on the mean the cells touch over too much by about a cell for each of the radius,
/// and corrected by less than half of it.
#[test]
fn the_corrected_area_of_balls_is_that_of_hertz() {
    let (radius, modulus, load) = (10e-3, 115e9, 2.0);
    let hertz = HertzSphere { radius, modulus, load };
    let area = std::f64::consts::PI * hertz.contact_radius().powi(2);
    for cells in [72, 108] {
        let pitch = 2.4 * hertz.contact_radius() / cells as f64;
        let grid = Grid::new([cells; 2], [pitch; 2]).unwrap();
        let mut operator = FreeFft::new(grid, modulus);
        let params = Params::default().with_tolerance(1e-8);
        let (mut raw, mut corrected) = (0.0, 0.0);
        let places = [
            [0.0, 0.0],
            [0.5, 0.0],
            [0.5, 0.5],
            [0.21, 0.37],
            [0.83, 0.12],
            [0.4, 0.71],
            [0.05, 0.62],
            [0.29, 0.9],
        ];
        for place in places {
            let gap = Field::from_shape_fn(grid.shape, |(i, j)| {
                let at =
                    |n: usize, axis: usize| (n as f64 + place[axis]) * pitch - 1.2 * hertz.contact_radius();
                (at(i, 0).powi(2) + at(j, 1).powi(2)) / (2.0 * radius)
            });
            let control = Control::Load(load);
            let contact =
                solve_normal(&mut operator, &gap, &Bounds::ELASTIC, control, None, &params).unwrap();
            let touches: Vec<bool> = contact.pressure.iter().map(|p| *p > 0.0).collect();
            let count = touches.iter().filter(|touches| **touches).count() as f64;
            raw += (count * grid.cell_area() / area - 1.0) / places.len() as f64;
            corrected += (corrected_area(&touches, &grid, [false; 2]) / area - 1.0) / places.len() as f64;
        }
        assert!(raw > 1e-3 && corrected.abs() < 0.5 * raw, "{cells}: {raw:.2e} {corrected:.2e}");
    }
}
