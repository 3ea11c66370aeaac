use rand::{RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

use super::*;
use crate::reference::Inclusion;
use crate::stress::Stress;
use crate::subsurface::Subsurface;

const YOUNG: f64 = 1.0;

fn volume(shape: [usize; 2], pitch: [f64; 2], faces: &[f64], boundary: Boundary, poisson: f64) -> Volume {
    let grid = Grid::new(shape, pitch).unwrap();
    let material = Material::elastic(YOUNG, poisson).unwrap();
    Volume::new(grid, Layers::between(faces).unwrap(), boundary, &material).unwrap()
}

/// Random traceless components between −1 and 1.
fn strain(volume: &Volume, seed: u64) -> TensorField {
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut strain = volume.zeros();
    strain.iter_mut().for_each(|value| *value = random.random_range(-1.0..1.0));
    deviator(&mut strain);
    strain
}

fn deviator(tensor: &mut TensorField) {
    for mut layer in tensor.outer_iter_mut() {
        let mean = (&layer.index_axis(ndarray::Axis(0), 0)
            + &layer.index_axis(ndarray::Axis(0), 1)
            + layer.index_axis(ndarray::Axis(0), 2))
            / 3.0;
        (0..3).for_each(|component| {
            layer.index_axis_mut(ndarray::Axis(0), component).zip_mut_with(&mean, |a, b| *a -= b)
        });
    }
}

fn most(field: &TensorField) -> f64 {
    field.iter().fold(0.0, |m, v| m.max(v.abs()))
}

const FACES: [f64; 5] = [0.0, 0.05, 0.13, 0.23, 0.38];

/// Odd and even, wide and narrow grids.
const GRIDS: [([usize; 2], [f64; 2]); 4] =
    [([9, 11], [0.1, 0.13]), ([8, 6], [0.1, 0.1]), ([12, 1], [0.05, 0.2]), ([1, 4], [1.0, 0.07])];

#[test]
fn residual_stress_is_symmetric_takes_work_and_is_bounded() {
    for (shape, pitch) in GRIDS {
        for poisson in [0.0, 0.3, 0.5] {
            let mut body = volume(shape, pitch, &FACES, Boundary::PERIODIC, poisson);
            let (a, b) = (strain(&body, 1), strain(&body, 2));
            let (ka, kb) = (body.residual(&a), body.residual(&b));
            let (one, other) = (body.inner_product(&ka, &b), body.inner_product(&a, &kb));
            let scale = body.inner_product(&a, &a);
            assert!((one - other).abs() < 1e-13 * scale, "{shape:?}, ν = {poisson}: {one} is {other}");
            assert!(body.inner_product(&ka, &a) < 0.0);
            // The largest eigenvalue of −K on deviators is at most 2μ, found by power iteration on −K and on
            // 2μ + K, whose smallest is 0.
            let bound = YOUNG / (1.0 + poisson);
            let mut vectors = [a.clone(), b.clone()];
            for (n, vector) in vectors.iter_mut().enumerate() {
                let mut value = 0.0;
                for _ in 0..40 {
                    let mut next = body.residual(vector);
                    deviator(&mut next);
                    next *= -1.0;
                    if n == 1 {
                        next = bound * &*vector - next;
                    }
                    value = body.inner_product(&next, vector) / body.inner_product(vector, vector);
                    let norm = body.inner_product(&next, &next).sqrt();
                    *vector = next / norm;
                    assert!((-1e-13..bound * (1.0 + 1e-13)).contains(&value), "{value} of {bound}");
                }
                assert!(value > 0.5 * bound, "{shape:?}: {value} of {bound}");
            }
        }
    }
}

#[test]
fn residual_stress_of_a_free_body_is_symmetric_too() {
    for shape in [[9, 11], [24, 17], [16, 1], [33, 40]] {
        let mut body = volume(shape, [0.1, 0.1], &FACES, Boundary::FREE, 0.3);
        let (a, b) = (strain(&body, 1), strain(&body, 2));
        let (ka, kb) = (body.residual(&a), body.residual(&b));
        let (one, other) = (body.inner_product(&ka, &b), body.inner_product(&a, &kb));
        assert!((one - other).abs() < 1e-12 * body.inner_product(&a, &a), "{shape:?}: {one} is {other}");
        assert!(body.inner_product(&ka, &a) < 0.0);
    }
}

#[test]
fn betti_holds_between_tractions_and_plastic_strain() {
    for boundary in [Boundary::PERIODIC, Boundary::FREE] {
        for (shape, pitch) in GRIDS {
            let mut body = volume(shape, pitch, &FACES, boundary, 0.3);
            let strain = strain(&body, 3);
            let mut random = ChaCha8Rng::seed_from_u64(4);
            let traction = Field::from_shape_simple_fn(shape, || random.random_range(0.0..1.0));
            for kind in Traction::ALL {
                let zero = Field::zeros(shape);
                let only = |other: Traction| if other == kind { traction.clone() } else { zero.clone() };
                let tractions = Tractions {
                    pressure: only(Traction::Pressure),
                    shear: [Some(only(Traction::X)), Some(only(Traction::Y))],
                };
                let stress = body.elastic(&tractions);
                let inside = body.inner_product(&stress, &strain);
                let at_surface =
                    (&traction * &body.displacement(&strain, kind)).sum() * body.grid().cell_area();
                let scale =
                    body.inner_product(&stress, &stress).sqrt() * body.inner_product(&strain, &strain).sqrt();
                assert!(
                    (inside - at_surface).abs() < 1e-14 * scale,
                    "{boundary:?} {kind:?}: {inside} is {at_surface}"
                );
                assert!(scale > 0.0);
            }
        }
    }
}

#[test]
fn stress_under_tractions_is_that_of_the_planes() {
    // The mean over a layer by three Gauss points, of order 6; two points are of order 4.
    for (boundary, tolerance) in [(Boundary::PERIODIC, 1e-6), (Boundary::FREE, 5e-4)] {
        let faces = [0.0, 0.04, 0.1, 0.16];
        let mut body = volume([10, 9], [0.2, 0.2], &faces, boundary, 0.3);
        let mut random = ChaCha8Rng::seed_from_u64(5);
        let mut field = || Field::from_shape_simple_fn([10, 9], || random.random_range(0.0..1.0));
        let tractions = Tractions { pressure: field(), shear: [Some(field()), Some(field())] };
        let planes = Subsurface::new(*body.grid(), boundary, 0.3, &tractions);
        let stress = body.elastic(&tractions);
        for layer in 1..3 {
            let (middle, half) = (body.layers().centre(layer), 0.5 * body.layers().thickness(layer));
            let points = [(-0.6f64.sqrt(), 5.0), (0.0, 8.0), (0.6f64.sqrt(), 5.0)];
            for (component, found) in stress.index_axis(ndarray::Axis(0), layer).outer_iter().enumerate() {
                let mut mean = Field::zeros([10, 9]);
                for (at, weight) in points {
                    mean.scaled_add(weight / 18.0, &planes.plane(middle + at * half).stress[component]);
                }
                for (a, b) in found.iter().zip(&mean) {
                    assert!((a - b).abs() < tolerance, "{boundary:?}, layer {layer}: {a} is {b}");
                }
            }
        }
    }
}

#[test]
fn the_surface_bears_no_traction() {
    // In a layer much thinner than any other length.
    let faces = [0.0, 1e-13, 0.05, 0.13, 0.3];
    let mut body = volume([9, 8], [0.1, 0.13], &faces, Boundary::PERIODIC, 0.3);
    let stress = body.residual(&strain(&body, 6));
    for component in [2, 3, 4] {
        let top = stress.index_axis(ndarray::Axis(0), 0);
        let traction = top.index_axis(ndarray::Axis(0), component).iter().fold(0.0f64, |m, v| m.max(v.abs()));
        assert!(traction < 1e-11 * most(&stress), "{traction:e} of {}", most(&stress));
    }
}

/// A smooth strain of waves along x, y and both, times a profile in depth.
fn smooth(body: &Volume) -> TensorField {
    let [lx, ly] = body.grid().extent();
    let mut strain = body.zeros();
    for ((layer, component, ix, iy), value) in strain.indexed_iter_mut() {
        let z = body.layers().centre(layer);
        let profile = z * z * (-8.0 * z).exp() + 0.01 * (-5.0 * z).exp();
        let (x, y) = (body.grid().centre(0, ix) / lx, body.grid().centre(1, iy) / ly);
        let phase = std::f64::consts::TAU * (x + y) + component as f64;
        *value = profile * (1.0 + 0.3 * component as f64) * phase.cos();
    }
    deviator(&mut strain);
    strain
}

#[test]
fn it_is_in_equilibrium_and_compatible_to_the_second_order() {
    let errors = [24, 48, 96].map(|layers| {
        let faces: Vec<f64> = (0..=layers).map(|i| 1.2 * i as f64 / layers as f64).collect();
        let mut body = volume([8, 12], [0.125, 0.125], &faces, Boundary::PERIODIC, 0.3);
        let (h, nu) = (faces[1], 0.3);
        let plastic = smooth(&body);
        let stress = body.residual(&plastic);
        // A wave along the diagonal: ∂x moves it by a quarter of its length along x.
        let [qx, qy] = body.grid().extent().map(|l| std::f64::consts::TAU / l);
        let at = |f: &TensorField, layer: usize, c: usize, x: usize, y: usize| f[[layer, c, x % 8, y % 12]];
        let dx = |f: &TensorField, l: usize, c: usize, x: usize, y: usize| qx * at(f, l, c, x + 2, y);
        let dy = |f: &TensorField, l: usize, c: usize, x: usize, y: usize| qy * at(f, l, c, x, y + 3);
        let strain = TensorField::from_shape_fn(stress.raw_dim(), |(l, c, x, y)| {
            let trace = at(&stress, l, 0, x, y) + at(&stress, l, 1, x, y) + at(&stress, l, 2, x, y);
            (1.0 + nu) * at(&stress, l, c, x, y) - if c < 3 { nu * trace } else { 0.0 }
                + at(&plastic, l, c, x, y)
        });
        let [mut force, mut misfit] = [0.0f64; 2];
        // Between the same depths.
        for l in layers / 8..layers * 7 / 8 {
            for (x, y) in (0..8).flat_map(|x| (0..12).map(move |y| (x, y))) {
                let dz = |f: &TensorField, c: usize, x: usize, y: usize| {
                    (at(f, l + 1, c, x, y) - at(f, l - 1, c, x, y)) / (2.0 * h)
                };
                for [a, b, c] in [[0, 5, 4], [5, 1, 3], [4, 3, 2]] {
                    force = force.max(
                        (dx(&stress, l, a, x, y) + dy(&stress, l, b, x, y) + dz(&stress, c, x, y)).abs(),
                    );
                }
                let dzz = |c: usize| {
                    let e = |l: usize| at(&strain, l, c, x, y);
                    (e(l + 1) - 2.0 * e(l) + e(l - 1)) / (h * h)
                };
                // ∂zz Exx + ∂xx Ezz − 2 ∂xz Exz, the same along y, and ∂zz Exy + ∂xy Ezz − ∂xz Eyz − ∂yz Exz.
                let e = |c: usize| at(&strain, l, c, x, y);
                let along_x = dzz(0) - qx * qx * e(2) - 2.0 * qx * dz(&strain, 4, x + 2, y);
                let along_y = dzz(1) - qy * qy * e(2) - 2.0 * qy * dz(&strain, 3, x, y + 3);
                let mixed =
                    dzz(5) - qx * qy * e(2) - qx * dz(&strain, 3, x + 2, y) - qy * dz(&strain, 4, x, y + 3);
                misfit = misfit.max(along_x.abs()).max(along_y.abs()).max(mixed.abs());
            }
        }
        [force, misfit]
    });
    for kind in 0..2 {
        for pair in errors.windows(2) {
            let order = (pair[0][kind] / pair[1][kind]).log2();
            assert!((1.8..2.2).contains(&order), "order {order}: {errors:?}");
        }
    }
}

#[test]
fn deep_below_the_surface_it_is_that_of_cuboids() {
    // A Gaussian of 1.5 cells in an infinite body, cuboid by cuboid; the mean over a layer by Gauss.
    let strain = [[0.3, 0.1, -0.2], [0.1, -0.5, 0.25], [-0.2, 0.25, 0.2]];
    let mut faces = vec![0.0];
    faces.extend((0..=11).map(|i| 16.0 + f64::from(i)));
    for (boundary, n) in [(Boundary::PERIODIC, 48), (Boundary::FREE, 32)] {
        let mut body = volume([n, n], [1.0; 2], &faces, boundary, 0.3);
        let middle = (n / 2) as f64;
        let bell = |layer: usize, x: usize, y: usize| {
            let [x, y] = [x, y].map(|i| i as f64 - middle);
            let z = body.layers().centre(layer) - 21.5;
            if layer == 0 { 0.0 } else { (-(x * x + y * y + z * z) / 4.5).exp() }
        };
        let components = [strain[0][0], strain[1][1], strain[2][2], strain[1][2], strain[0][2], strain[0][1]];
        let plastic =
            TensorField::from_shape_fn(body.zeros().raw_dim(), |(l, c, x, y)| components[c] * bell(l, x, y));
        let sources: Vec<([f64; 3], f64)> = ndarray::indices([12, n, n])
            .into_iter()
            .map(|(l, x, y)| ([x as f64, y as f64, body.layers().centre(l)], bell(l, x, y)))
            .filter(|(_, share)| *share > 1e-5)
            .collect();
        let found = body.residual(&plastic);
        let cuboid = Inclusion { sides: [1.0; 3], strain, young: YOUNG, poisson: 0.3 };
        for (x, y, layer) in [(0, 0, 6), (2, 1, 6), (4, 0, 5), (0, 3, 9)] {
            let (ix, iy) = (n / 2 + x, n / 2 + y);
            let mut exact = Stress::default();
            for (shift, weight) in [(-0.3873, 5.0 / 18.0), (0.0, 8.0 / 18.0), (0.3873, 5.0 / 18.0)] {
                for (from, share) in &sources {
                    // Away from the planes of faces and edges.
                    let at = [
                        ix as f64 + 1e-9 - from[0],
                        iy as f64 + 1e-9 - from[1],
                        body.layers().centre(layer) + shift - from[2],
                    ];
                    exact = exact + (weight * share) * cuboid.stress(at);
                }
            }
            for (component, exact) in exact.components().iter().enumerate() {
                let error = (found[[layer, component, ix, iy]] - exact).abs() / most(&found);
                assert!(error < 0.01, "{boundary:?} at {x}, {y}, {layer}: {component} is wrong by {error}");
            }
        }
    }
}

#[test]
fn a_free_body_is_a_period_of_eight_times_its_size() {
    for (n, zone) in [(24, 8), (24, 22), (32, 20)] {
        let faces: Vec<f64> = (0..=8).map(|i| 1.5 * f64::from(i)).collect();
        let mut free = volume([n, n], [1.0; 2], &faces, Boundary::FREE, 0.3);
        let mut wide = volume([8 * n, 8 * n], [1.0; 2], &faces, Boundary::PERIODIC, 0.3);
        // As below a contact: compressed under it, bell-shaped over this number of cells, and one shear.
        let middle = 0.5 * (n as f64 - 1.0);
        let mut plastic = free.zeros();
        for ((layer, component, ix, iy), value) in plastic.indexed_iter_mut() {
            let [x, y] = [ix, iy].map(|i| (i as f64 - middle) / (0.5 * zone as f64));
            let z = free.layers().centre(layer) / zone as f64;
            let bell = (1.0 - x * x - y * y).max(0.0) * (-4.0 * (z - 0.3) * (z - 0.3)).exp();
            *value = [0.5, 0.5, -1.0, 0.6 * y, 0.6 * x, 0.1][component] * bell;
        }
        let inside = ndarray::s![.., .., ..n, ..n];
        let mut padded = wide.zeros();
        padded.slice_mut(inside).assign(&plastic);
        let (found, exact) = (free.residual(&plastic), wide.residual(&padded));
        let error = most(&(&found - &exact.slice(inside))) / most(&found);
        assert!(error < 1e-3, "{n} cells, zone of {zone}: {error:e}");
    }
}

#[test]
fn threads_do_not_change_a_bit() {
    let answer = |threads: usize, boundary: Boundary| {
        let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
        pool.install(|| {
            let mut body = volume([20, 17], [0.1, 0.1], &FACES, boundary, 0.3);
            let strain = strain(&body, 8);
            (body.residual(&strain), body.displacement(&strain, Traction::Pressure))
        })
    };
    for boundary in [Boundary::PERIODIC, Boundary::FREE] {
        let one = answer(1, boundary);
        assert_eq!(one, answer(2, boundary));
        assert_eq!(one, answer(7, boundary));
    }
}

#[test]
fn bodies_that_cannot_flow_are_refused() {
    let grid = Grid::new([4, 4], [1.0; 2]).unwrap();
    let layers = Layers::new(1.0, 2, 1.0).unwrap();
    let rigid = Material::elastic(f64::INFINITY, 0.3).unwrap();
    assert!(Volume::new(grid, layers.clone(), Boundary::FREE, &rigid).is_err());
    let steel = Material::elastic(1.0, 0.3).unwrap();
    let mixed = Boundary([crate::operator::Edge::Free, crate::operator::Edge::Periodic]);
    assert!(Volume::new(grid, layers.clone(), mixed, &steel).is_err());
    let coating = crate::material::Coating::new(1.0, 1.0, 0.3).unwrap();
    assert!(Volume::new(grid, layers, Boundary::FREE, &steel.coated(coating)).is_err());
}
