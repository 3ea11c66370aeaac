//! Steady rolling compared with rolling cell by cell until the state is stationary.

use asperity_base::{Field, Grid};
use asperity_elastic::material::{Compliances, Material};
use asperity_elastic::operator::{Boundary, CoupledOperator, Operators};
use asperity_elastic::solver::{
    Bounds, Control, Coupling, Creep, Friction, FrictionalSolution, Loading, Params, Rolling,
    RollingSolution, Tangential, solve_frictional, solve_rolling,
};

fn pair(young: [f64; 2]) -> Compliances {
    let [lower, upper] = young.map(|young| Material::elastic(young, 0.3).unwrap());
    Compliances::new(&lower, &upper).unwrap()
}

/// A sphere of radius 1 on `n`² cells of a square with this side.
fn sphere(n: usize, side: f64) -> (Grid, Field) {
    let grid = Grid::new([n, n], [side / n as f64; 2]).unwrap();
    let middle = 0.5 * side;
    let gap = Field::from_shape_fn(grid.shape, |(i, j)| {
        let [x, y] = [grid.centre(0, i) - middle, grid.centre(1, j) - middle];
        0.5 * (x * x + y * y)
    });
    (grid, gap)
}

/// Load at which the contact radius of a sphere of radius 1 is `a`, E* = 1.
fn hertz(a: f64) -> f64 {
    4.0 / 3.0 * a.powi(3)
}

/// A contact for rolling.
struct Contact<'a> {
    operator: &'a mut dyn CoupledOperator,
    gap: &'a Field,
    bounds: Bounds,
    friction: Friction,
    normal: Control,
}

impl Contact<'_> {
    fn steady(&mut self, rolling: Rolling, params: &Params) -> RollingSolution {
        solve_rolling(self.operator, self.gap, &self.bounds, &self.friction, self.normal, rolling, params)
            .unwrap()
    }

    /// Rolls cell by cell until the shear changes by less than this fraction of the largest.
    fn cell_by_cell(&mut self, rolling: Rolling, params: &Params, change: f64) -> FrictionalSolution {
        let grid = *self.operator.grid();
        let repeats = self.operator.normal().boundary().repeats(0);
        let [nx, _] = grid.shape;
        let tangential = match rolling.creep {
            Creep::Creepage(creepage) => Tangential::Displacement(creepage.map(|xi| xi * grid.pitch[0])),
            Creep::Force(force) => Tangential::Force(force),
        };
        let mut before: Option<FrictionalSolution> = None;
        for _ in 0..10 * nx {
            let arrived = before.clone().map(|mut state| {
                for axis in 0..2 {
                    let u = &state.displacement[axis];
                    let arm =
                        |at: [usize; 2]| grid.centre(1 - axis, at[1 - axis]) - 0.5 * grid.extent()[1 - axis];
                    let turned = [-1.0, 1.0][axis] * rolling.spin * grid.pitch[0];
                    state.displacement[axis] = Field::from_shape_fn(grid.shape, |(i, j)| {
                        let next = if i + 1 < nx {
                            i + 1
                        } else if repeats {
                            0
                        } else {
                            i
                        };
                        u[[next, j]] + turned * arm([i, j])
                    });
                }
                state.rigid_displacement = [0.0; 2];
                state
            });
            let tangential = if before.is_none() { Tangential::Force([0.0; 2]) } else { tangential };
            let loading = Loading { normal: self.normal, tangential };
            let next = solve_frictional(
                self.operator,
                self.gap,
                &self.bounds,
                &self.friction,
                loading,
                arrived.as_ref(),
                params,
            )
            .unwrap();
            let most = before.as_ref().map_or(f64::INFINITY, |before| apart(&next, before));
            before = Some(next);
            if most < change {
                return before.unwrap();
            }
        }
        panic!("not steady");
    }
}

/// Largest difference between the shear of two contacts, relative to the largest shear.
fn apart(one: &FrictionalSolution, other: &FrictionalSolution) -> f64 {
    let pairs = one.shear.iter().flatten().zip(other.shear.iter().flatten());
    pairs.fold(0.0f64, |most, (a, b)| most.max((a - b).abs())) / one.max_shear()
}

#[test]
fn the_steady_state_is_what_rolling_cell_by_cell_comes_to() {
    let alike = pair([1.82, 1.82]);
    let dissimilar = pair([1.0, 100.0]);
    let (film, plain) = (
        |mu: f64| Friction::coulomb(mu).unwrap().with_shear_strength(0.03),
        |mu: f64| Friction::coulomb(mu).unwrap(),
    );
    let creepage = |x, y| Creep::Creepage([x, y]);
    let force = |x, y| Creep::Force([x, y]);
    let (free, periodic) = (Boundary::FREE, Boundary::PERIODIC);
    let elastic = Bounds::ELASTIC;
    // Shape, bodies, boundary, roughness, friction, bounds, prescribed values relative to the load or to 1,
    // spin.
    #[rustfmt::skip]
    let cases = [
        ([24, 24], alike, free, 0.0, plain(0.3), elastic.clone(), force(0.18, 0.0), 0.0),
        ([24, 24], alike, free, 0.0, plain(0.3), elastic.clone(), creepage(0.02, 0.03), 0.8),
        ([21, 24], dissimilar, free, 0.0, plain(0.3), elastic.clone(), force(0.1, -0.2), 0.0),
        ([24, 20], dissimilar, free, 0.03, plain(0.6), elastic.clone(), force(0.3, 0.4), -0.7),
        ([22, 22], dissimilar, periodic, 0.0, plain(0.1), elastic.clone(), creepage(-0.01, 0.005), 0.0),
        ([26, 1], dissimilar, periodic, 0.0, plain(0.5), elastic.clone(), force(0.2, 0.1), 0.0),
        ([20, 16], alike, free, 0.0, film(0.6), elastic.clone(), creepage(0.01, 0.0), 0.0),
        ([24, 24], alike, free, 0.0, plain(0.3), Bounds::up_to(0.12), force(0.0, 0.29), 0.0),
        ([20, 20], dissimilar, free, 0.02, plain(0.4).with_coupling(Coupling::Goodman), elastic.clone(), creepage(0.0, 0.05), 0.0),
        ([16, 16], alike, free, 0.0, plain(f64::INFINITY), elastic, creepage(0.1, 0.0), 0.5),
    ];
    let params = Params::default().with_tolerance(1e-8);
    for (shape, pair, boundary, rough, friction, bounds, creep, spin) in cases {
        let grid = Grid::new(shape, [1.0 / shape[0] as f64; 2]).unwrap();
        let wide = shape[1] > 1;
        let gap = Field::from_shape_fn(shape, |(i, j)| {
            let [x, y] = [[0, i], [1, j]].map(|[axis, n]| grid.centre(axis, n) - 0.5 * grid.extent()[axis]);
            let y = if wide { y } else { 0.0 };
            0.5 * (x * x + y * y) + rough * (17.0 * x + 1.0).sin() * (23.0 * y + 2.0).cos()
        });
        let load = 0.03 * grid.extent()[1];
        let creep = match creep {
            Creep::Force(force) => Creep::Force(force.map(|share| share * load)),
            Creep::Creepage(_) => creep,
        };
        let mut operator = Operators::new(grid, pair, boundary).coupled_on(shape);
        let normal = Control::Load(load);
        let mut contact = Contact { operator: operator.as_mut(), gap: &gap, bounds, friction, normal };
        let rolling = Rolling { creep, spin };
        let steady = contact.steady(rolling, &params);
        let slow = contact.cell_by_cell(rolling, &params, 1e-9);
        let what = format!("{shape:?} {boundary:?} {rolling:?}");
        let apart = apart(&steady.contact, &slow);
        assert!(apart < 2e-6, "{what}: {apart:e}");
        let creepage = slow.rigid_displacement.map(|displacement| displacement / grid.pitch[0]);
        let size = creepage[0].hypot(creepage[1]).max(spin.abs());
        for (found, creepage) in steady.creepage.into_iter().zip(creepage) {
            assert!((found - creepage).abs() < 1e-5 * size, "{what}: {found} {creepage}");
        }
        let [one, other] = [&steady.contact, &slow].map(|contact| contact.stick.sum());
        assert!((one - other).abs() <= 1.0, "{what}: {one} and {other} cells stick");
    }
}

#[test]
fn contacts_of_few_cells_roll_under_nearly_all_that_friction_holds() {
    let params = Params::default().with_tolerance(1e-8);
    let pair = pair([1.0, 40.0]);
    for (n, shape) in [[3, 5], [6, 8], [5, 1]].into_iter().enumerate() {
        let boundary = if shape[1] == 1 { Boundary::PERIODIC } else { Boundary::FREE };
        for k in 0..24 {
            let share = [0.9, 0.99, 0.9995][k % 3];
            let angle = 0.7 * k as f64;
            let aside = [0.5 * (k % 2) as f64, 0.5 * (k / 2 % 2) as f64];
            let grid = Grid::new(shape, [1.0 / shape[0] as f64; 2]).unwrap();
            let gap = Field::from_shape_fn(shape, |(i, j)| {
                let from = |axis: usize, n: usize| {
                    grid.centre(axis, n) - 0.5 * grid.extent()[axis] + aside[axis] * grid.pitch[axis]
                };
                let y = if shape[1] == 1 { 0.0 } else { from(1, j) };
                0.5 * (from(0, i).powi(2) + y * y)
            });
            let load = 1e-5 * 4f64.powi((k % 5) as i32);
            let friction = Friction::coulomb(0.45).unwrap();
            let rolling = Rolling {
                creep: Creep::Force([angle.cos(), angle.sin()].map(|part| share * 0.45 * load * part)),
                spin: if n == 0 { 0.3 * (k % 4) as f64 } else { 0.0 },
            };
            let mut operator = Operators::new(grid, pair, boundary).coupled_on(shape);
            let (operator, normal, bounds) = (operator.as_mut(), Control::Load(load), Bounds::ELASTIC);
            let mut contact = Contact { operator, gap: &gap, bounds, friction, normal };
            let steady = contact.steady(rolling, &params);
            let cells = steady.contact.shear_limit.iter().filter(|limit| **limit > 0.0).count();
            let spent = steady.contact.normal.stats.convolutions;
            assert!(cells > 1 || spent < 15.0, "{shape:?}, {k}: {spent} convolutions");
            let slow = contact.cell_by_cell(rolling, &params, 1e-9);
            let apart = apart(&steady.contact, &slow);
            assert!(apart < 2e-6, "{shape:?}, {k}, {cells} cells: {apart:e}");
        }
    }
}

#[test]
fn a_sphere_rolls_at_the_price_of_some_increments() {
    let (grid, gap) = sphere(96, 1.0);
    let radius = 0.27;
    #[rustfmt::skip]
    let creeps = [
        (Creep::Force([0.15, 0.0]), 0.0),
        (Creep::Force([0.0, 0.29]), 0.3),
        (Creep::Creepage([0.3, 0.0]), 0.0),
        (Creep::Creepage([0.1, 0.2]), 0.0),
        (Creep::Creepage([0.0, 0.0]), 0.2),
        (Creep::Creepage([0.2, 0.04]), 0.5),
    ];
    for (young, most) in [([1.82, 1.82], 120.0), ([1.0, 200.0], 280.0)] {
        let pair = pair(young);
        let load = hertz(radius) * pair.modulus();
        for (creep, spin) in creeps {
            let creep = match creep {
                Creep::Force(force) => Creep::Force(force.map(|share| share * load)),
                Creep::Creepage(creepage) => Creep::Creepage(creepage.map(|xi| xi * radius)),
            };
            let mut operator = Operators::new(grid, pair, Boundary::FREE).coupled_on(grid.shape);
            let friction = Friction::coulomb(0.3).unwrap();
            let normal = Control::Load(load);
            let (operator, bounds) = (operator.as_mut(), Bounds::ELASTIC);
            let mut contact = Contact { operator, gap: &gap, bounds, friction, normal };
            let steady = contact.steady(Rolling { creep, spin }, &Params::default());
            let spent = steady.contact.normal.stats.convolutions;
            assert!(spent < most, "{young:?} {creep:?} {spin}: {spent} convolutions");
        }
    }
}

/// The supplied energy is that of force, moment and pressure; the energy of the slip of the cells converges
/// to it as the cells become small.
#[test]
fn the_work_of_the_slip_comes_to_the_energy_that_is_given() {
    let radius = 0.3;
    let scale = 0.3 * radius;
    let creepage = |x, y| Creep::Creepage([x * scale, y * scale]);
    let free = Creep::Force([0.0, 0.0]);
    #[rustfmt::skip]
    let cases = [
        ([1.82, 1.82], 0.3, creepage(1.0, 0.0), 0.0),
        ([1.82, 1.82], 0.3, creepage(0.0, -0.8), 0.0),
        ([1.82, 1.82], 0.3, creepage(0.3, 0.4), 0.6),
        ([1.0, 30.0], 0.3, creepage(0.5, -0.6), -0.4),
        ([1.0, 30.0], 0.02, free, 0.0),
    ];
    for (young, coefficient, creep, spin) in cases {
        let pair = pair(young);
        let what = format!("{young:?} {creep:?} {spin}");
        let [coarse, fine] = [16, 32].map(|n| {
            let (grid, gap) = sphere(n, 1.0);
            let mut operator = Operators::new(grid, pair, Boundary::FREE).coupled_on(grid.shape);
            let mut contact = Contact {
                operator: operator.as_mut(),
                gap: &gap,
                bounds: Bounds::ELASTIC,
                friction: Friction::coulomb(coefficient).unwrap(),
                normal: Control::Load(hertz(radius) * pair.modulus()),
            };
            let rolled = contact.steady(Rolling { creep, spin }, &Params::default().with_tolerance(1e-8));
            let RollingSolution { contact, creepage, dissipation, .. } = &rolled;
            let given: f64 = creepage.iter().zip(contact.force()).map(|(xi, force)| xi * force).sum();
            // Pressure does work on the gap that moves on with the contact.
            let u = &contact.normal.displacement;
            let gradient = Field::from_shape_fn(grid.shape, |(i, j)| {
                0.5 * (u[[(i + 1).min(n - 1), j]] - u[[i.max(1) - 1, j]])
            });
            let resisted = -grid.cell_area() * (&contact.normal.pressure * &gradient).sum();
            let given = (given + spin * contact.moment()) * grid.pitch[0];
            [*dissipation, rolled.slip_work(), given, resisted].map(|energy| n as f64 * energy)
        });
        let missing = [coarse, fine].map(|[dissipation, slip_work, ..]| 1.0 - slip_work / dissipation);
        assert!(coarse[0] > 0.0 && (fine[0] / coarse[0] - 1.0).abs() < 0.1, "{what}: {coarse:?} {fine:?}");
        assert!(missing[1].abs() < 0.65 * missing[0].abs() && missing[1].abs() < 0.1, "{what}: {missing:?}");
        for [dissipation, _, given, resisted] in [coarse, fine] {
            let error = (given + resisted - dissipation).abs() / dissipation;
            assert!(error < 1e-6, "{what}: {dissipation:e} {given:e} {resisted:e}");
            let share = (resisted / dissipation).abs();
            assert!(if young[0] == young[1] { share < 1e-6 } else { share > 0.03 }, "{what}: {share:e}");
        }
    }
}

/// In gross slip all frictional energy is that of the slip, up to the step from cell to cell of a stationary
/// shear.
#[test]
fn in_gross_sliding_all_energy_goes_into_slip() {
    let (grid, gap) = sphere(12, 1.0);
    let pair = pair([1.82, 1.82]);
    let load = hertz(0.3);
    let mut operator = Operators::new(grid, pair, Boundary::FREE).coupled_on(grid.shape);
    let mut contact = Contact {
        operator: operator.as_mut(),
        gap: &gap,
        bounds: Bounds::ELASTIC,
        friction: Friction::coulomb(0.3).unwrap(),
        normal: Control::Load(load),
    };
    let creepage = 3e3;
    let rolling = Rolling { creep: Creep::Creepage([0.6 * creepage, -0.8 * creepage]), spin: 0.0 };
    let rolled = contact.steady(rolling, &Params::default());
    let taken = 0.3 * load * creepage * grid.pitch[0];
    assert!((rolled.dissipation / taken - 1.0).abs() < 1e-6, "{:e} {taken:e}", rolled.dissipation);
    assert!((rolled.slip_work() / taken - 1.0).abs() < 1e-3, "{:e} {taken:e}", rolled.slip_work());
}

/// On a grid with one column there is no strain along the rolling direction: all cells slip according to the
/// creepage.
#[test]
fn a_single_column_slides_whatever_the_creepage() {
    let pair = pair([1.0, 30.0]);
    for boundary in [Boundary::PERIODIC, Boundary::FREE] {
        let grid = Grid::new([1, 8], [1.0, 1.0]).unwrap();
        let gap = Field::from_shape_fn(grid.shape, |(_, j)| 1e-3 * (0.7 * j as f64).sin());
        let load = 8e-4;
        for creepage in [[1e-4, 1e-4], [1e-9, -3e-9], [-2.0, 0.0]] {
            let mut operator = Operators::new(grid, pair, boundary).coupled_on(grid.shape);
            let mut contact = Contact {
                operator: operator.as_mut(),
                gap: &gap,
                bounds: Bounds::ELASTIC,
                friction: Friction::coulomb(0.3).unwrap().with_coupling(Coupling::Goodman),
                normal: Control::Load(load),
            };
            let creep = Creep::Creepage(creepage);
            let rolled = contact.steady(Rolling { creep, spin: 0.0 }, &Params::default());
            let size = creepage[0].hypot(creepage[1]);
            for (force, xi) in rolled.contact.force().into_iter().zip(creepage) {
                assert!(
                    (force / (0.3 * load) - xi / size).abs() < 1e-9,
                    "{boundary:?} {creepage:?}: {force}"
                );
            }
            for energy in [rolled.dissipation, rolled.slip_work()] {
                assert!((energy / (0.3 * load * size) - 1.0).abs() < 1e-9, "{boundary:?} {creepage:?}");
            }
            assert!(rolled.contact.normal.stats.convolutions < 30.0);
        }
    }
}
