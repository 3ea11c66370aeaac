//! Steady rolling with random combinations of options; each solution is checked against the conditions of
//! friction cell by cell.
//!
//! `CASES=1000 cargo test -p asperity-contact --test it random_rolling` tries this number, starting from the
//! seed `SEED`.

use asperity_base::{Error, Field, Grid};
use asperity_elastic::material::{Compliances, Material};
use asperity_elastic::operator::{Boundary, CoupledOperator, CoupledSum, Edge, Operators};
use asperity_elastic::solver::{
    Bounds, Control, Coupling, Creep, Friction, Params, Rolling, RollingSolution, solve_rolling,
};
use rand::{Rng, RngExt, SeedableRng};
use rand_chacha::ChaCha8Rng;

const TOLERANCE: f64 = 1e-8;
/// Accepted errors of a solution, in tolerances: the solver measures them relative to other quantities.
const MARGIN: f64 = 10.0;

#[test]
fn steady_rolling_meets_the_conditions_of_friction_in_every_cell() {
    let number = |name: &str, default: u64| std::env::var(name).map_or(default, |text| text.parse().unwrap());
    let (cases, seed) = (number("CASES", 120), number("SEED", 0));
    let (mut solved, mut spent, mut failures) = (0, 0.0, Vec::new());
    for number in seed..seed + cases {
        let case = Case::random(&mut ChaCha8Rng::seed_from_u64(number));
        match case.solve() {
            Ok(solution) => {
                solved += 1;
                spent += solution.contact.normal.stats.convolutions;
                let mut wrong = case.faults(&solution);
                failures.extend(wrong.drain(..).map(|fault| format!("{number}: {fault}\n    {case:?}")));
            }
            // A random friction law may hold less than the force, a random hardness map less than the load.
            Err(Error::BeyondFriction { .. } | Error::BeyondPlasticLimit { .. }) => {}
            Err(error) => failures.push(format!("{number}: {error}\n    {case:?}")),
        }
    }
    assert!(failures.is_empty(), "{} of {cases}:\n{}", failures.len(), failures.join("\n"));
    assert!(solved > 9 * cases / 10, "{solved} solved with {spent} convolutions");
}

#[derive(Debug)]
struct Case {
    shape: [usize; 2],
    pitch: [f64; 2],
    boundary: Boundary,
    young: [f64; 2],
    poisson: [f64; 2],
    friction: Friction,
    hardness: f64,
    /// Whether the hardness differs from cell to cell.
    maps: bool,
    /// Curvature of the gap along x and y, offset of its middle from that of the grid, amplitude and phase of
    /// waves.
    curvature: [f64; 2],
    middle: [f64; 2],
    rough: f64,
    phase: f64,
    load: f64,
    rolling: Rolling,
}

impl Case {
    fn random(rng: &mut impl Rng) -> Self {
        let pick = |rng: &mut dyn Rng, n: usize| rng.random_range(0..n);
        let decades = |rng: &mut dyn Rng, from: f64, to: f64| 10f64.powf(rng.random_range(from..to));
        let shape = match pick(rng, 6) {
            0 => [1, rng.random_range(1..20)],
            1 => [rng.random_range(1..40), 1],
            2 => [2, rng.random_range(1..9)],
            3 | 4 => [rng.random_range(2..9), rng.random_range(2..9)],
            _ => [rng.random_range(5..20), rng.random_range(5..16)],
        };
        let boundary = Boundary([0, 1].map(|_| [Edge::Free, Edge::Periodic][pick(rng, 2)]));
        let pitch = [1.0, [1.0, 1.0, 0.4, 3.0][pick(rng, 4)]];
        let young = [[1.82, 1.82], [1.0, 40.0], [1.0, 3.0]][pick(rng, 3)];
        let poisson = [[0.3, 0.3], [0.0, 0.0], [0.5, 0.5], [0.1, 0.45]][pick(rng, 4)];
        let extent = [0, 1].map(|axis| shape[axis] as f64 * pitch[axis]);
        let area = extent[0] * extent[1];
        let mean_pressure = decades(rng, -6.0, -1.5);
        let load = mean_pressure * area;
        let caps = pick(rng, 3) == 0;
        let hardness = if caps { mean_pressure * rng.random_range(2.0..8.0) } else { f64::INFINITY };
        let coefficient = match pick(rng, 8) {
            0 => decades(rng, -3.0, -1.0),
            1 => rng.random_range(0.6..1.0),
            _ => rng.random_range(0.1..0.6),
        };
        let mut friction = Friction::coulomb(coefficient)
            .unwrap()
            .with_coupling([Coupling::Full, Coupling::Full, Coupling::Goodman, Coupling::None][pick(rng, 4)]);
        if pick(rng, 4) == 0 {
            friction = friction.with_shear_strength(coefficient * mean_pressure * rng.random_range(1.0..4.0));
        }
        if caps && pick(rng, 3) == 0 {
            friction = friction.with_junction_growth(rng.random_range(0.5..9.0));
        }
        let bend = |rng: &mut dyn Rng, axis: usize| match pick(rng, 4) {
            0 => 0.0,
            _ => mean_pressure * decades(rng, -1.0, 1.0) / extent[axis].max(extent[1 - axis].min(4.0)),
        };
        let curvature = [bend(rng, 0), bend(rng, 1)];
        let middle = extent.map(|side| side * [0.0, rng.random_range(-0.5..0.5)][pick(rng, 2)]);
        let rough = [0.0, mean_pressure * decades(rng, -1.0, 1.0)][pick(rng, 2)];
        let angle = match pick(rng, 4) {
            0 => std::f64::consts::FRAC_PI_2 * pick(rng, 4) as f64,
            _ => rng.random_range(0.0f64..6.3),
        };
        let direction = [angle.cos(), angle.sin()].map(|part| if part.abs() < 1e-9 { 0.0 } else { part });
        // From nearly full stick to gross slip, and sometimes zero.
        let size = match pick(rng, 10) {
            0 => 0.0,
            _ => coefficient * mean_pressure * decades(rng, -3.0, 2.0),
        };
        let creep = match pick(rng, 3) {
            0 => {
                let share = [0.0, 0.3, 0.9, 0.99, 0.999][pick(rng, 5)];
                Creep::Force(direction.map(|part| share * coefficient * load * part))
            }
            _ => Creep::Creepage(direction.map(|part| size * part)),
        };
        let spin = if boundary == Boundary::FREE && pick(rng, 2) == 0 {
            [-1.0, 1.0][pick(rng, 2)] * size * decades(rng, -1.0, 1.0) / extent[0].max(extent[1])
        } else {
            0.0
        };
        Self {
            shape,
            pitch,
            boundary,
            young,
            poisson,
            friction,
            hardness,
            maps: pick(rng, 3) == 0,
            curvature,
            middle,
            rough,
            phase: rng.random_range(0.0..6.3),
            load,
            rolling: Rolling { creep, spin },
        }
    }

    fn grid(&self) -> Grid {
        Grid::new(self.shape, self.pitch).unwrap()
    }

    fn pair(&self) -> Compliances {
        let [lower, upper] = [0, 1].map(|k| Material::elastic(self.young[k], self.poisson[k]).unwrap());
        Compliances::new(&lower, &upper).unwrap()
    }

    fn gap(&self) -> Field {
        let grid = self.grid();
        Field::from_shape_fn(self.shape, |(i, j)| {
            let [x, y] = [[0, i], [1, j]]
                .map(|[axis, n]| grid.centre(axis, n) - 0.5 * grid.extent()[axis] - self.middle[axis]);
            let bend = 0.5 * (self.curvature[0] * x * x + self.curvature[1] * y * y);
            bend + self.rough * (2.1 * x + self.phase).sin() * (1.7 * y + 2.0 * self.phase).cos()
        })
    }

    /// Returns the hardness of each cell.
    fn caps(&self) -> Field {
        Field::from_shape_fn(self.shape, |(i, j)| {
            if self.maps {
                self.hardness * (0.75 + 0.25 * ((3 * i + 5 * j) as f64 + self.phase).sin())
            } else {
                self.hardness
            }
        })
    }

    fn solve(&self) -> Result<RollingSolution, Error> {
        let mut operator = Operators::new(self.grid(), self.pair(), self.boundary).coupled_on(self.shape);
        let bounds = if self.maps && self.hardness.is_finite() {
            Bounds::up_to(self.caps())
        } else {
            Bounds::up_to(self.hardness)
        };
        solve_rolling(
            operator.as_mut(),
            &self.gap(),
            &bounds,
            &self.friction,
            Control::Load(self.load),
            self.rolling,
            &Params::default().with_tolerance(TOLERANCE),
        )
    }

    /// Returns the displacement under the tractions of a solution, by a direct sum for a free boundary.
    fn displacement(&self, solution: &RollingSolution) -> [Field; 3] {
        let (grid, pair) = (self.grid(), self.pair());
        let mut operator: Box<dyn CoupledOperator> = match self.boundary {
            Boundary::FREE => Box::new(CoupledSum::new(grid, pair)),
            boundary => Operators::new(grid, pair, boundary).coupled_on(self.shape),
        };
        let [q_x, q_y] = solution.contact.shear.each_ref().map(Some);
        let p = Some(&solution.contact.normal.pressure);
        let mut u = [grid.zeros(), grid.zeros(), grid.zeros()];
        let [u_x, u_y, u_z] = u.each_mut().map(Some);
        let coupling = self.friction.coupling;
        operator.apply([q_x, q_y, p.filter(|_| coupling != Coupling::None)], [u_x, u_y, None]);
        match coupling {
            Coupling::Full => operator.apply([q_x, q_y, p], [None, None, u_z]),
            _ => operator.apply([None, None, p], [None, None, u_z]),
        }
        u
    }

    /// Returns the faults of a solution.
    fn faults(&self, solution: &RollingSolution) -> Vec<String> {
        let mut faults = Vec::new();
        let mut hold = |what: &str, error: f64, most: f64| {
            // NaN is a fault.
            if error.is_nan() || error > most {
                faults.push(format!("{what}: {error:e}, at most {most:e}"));
            }
        };
        let (grid, contact) = (self.grid(), &solution.contact);
        let [u_x, u_y, u_z] = self.displacement(solution);
        let (p, h, caps) = (&contact.normal.pressure, self.gap(), self.caps());
        let own = Operators::new(grid, self.pair(), self.boundary).coupled_on(self.shape).self_influence();
        let largest = |field: &Field| field.iter().fold(0.0f64, |most, v| most.max(v.abs()));
        let normal_error = MARGIN * TOLERANCE * largest(&u_z).max(own.zz * largest(p)) + 1e-14 * largest(&h);
        let shear_error = MARGIN * TOLERANCE * contact.max_shear();
        // A periodic contact of one cell does not deform, and slips according to its creepage.
        let given = solution.creepage[0].hypot(solution.creepage[1]) * self.pitch[0];
        let slip_error =
            shear_error * 0.5 * (own.xx + own.yy) + 1e-12 * given + 1e-14 * largest(&u_x).max(largest(&u_y));
        let rough = 1e-12 * largest(p);
        hold("load", (grid.cell_area() * p.sum() / self.load - 1.0).abs(), 1e-9);
        for (cell, &p) in p.indexed_iter() {
            let (i, j) = cell;
            let open = h[cell] + u_z[cell] - contact.normal.approach;
            let q = [contact.shear[0][cell], contact.shear[1][cell]];
            let size = q[0].hypot(q[1]);
            let alpha = self.friction.junction_growth;
            let cap = contact.normal.bounds.upper().value(i * self.shape[1] + j);
            hold("pressure below 0", -p, 0.0);
            hold("pressure above the hardness", p.hypot(alpha.sqrt() * size) / caps[cell] - 1.0, 1e-6);
            hold("gap", if p > 0.0 { open } else { 0.0 }, normal_error);
            hold("penetration", if p < cap { -open } else { 0.0 }, normal_error);
            // In rolling the material of the next cell arrives.
            let next = match i + 1 < self.shape[0] {
                true => (i + 1, j),
                false if self.boundary.repeats(0) => (0, j),
                false => cell,
            };
            let [x, y] = [[0, i], [1, j]].map(|[axis, n]| grid.centre(axis, n) - 0.5 * grid.extent()[axis]);
            let spin = self.rolling.spin;
            let creepage = [solution.creepage[0] - spin * y, solution.creepage[1] + spin * x];
            let slip = [
                creepage[0] * self.pitch[0] + u_x[next] - u_x[cell],
                creepage[1] * self.pitch[0] + u_y[next] - u_y[cell],
            ];
            let limit =
                if p > 0.0 { (self.friction.coefficient * p).min(self.friction.shear_strength) } else { 0.0 };
            hold("shear beyond friction", size - limit, rough.max(shear_error));
            if p == 0.0 {
                continue;
            }
            if size < limit - shear_error {
                hold("slip where it sticks", slip[0].hypot(slip[1]), slip_error);
            } else if alpha == 0.0 {
                let along = (slip[0] * q[0] + slip[1] * q[1]) / size;
                let across = (slip[0] * q[1] - slip[1] * q[0]) / size;
                hold("slip against the shear", -along, slip_error);
                // An error of the shear rotates it by as much, and the slip with it.
                hold("slip across the shear", across.abs(), slip_error + along.abs() * shear_error / size);
            }
        }
        match self.rolling.creep {
            Creep::Creepage(creepage) => assert_eq!(solution.creepage, creepage),
            Creep::Force(force) => {
                let borne = contact.force();
                let size =
                    grid.cell_area() * contact.shear.iter().flatten().fold(0.0, |sum, q| sum + q.abs());
                for axis in 0..2 {
                    hold("force", (borne[axis] - force[axis]).abs(), MARGIN * TOLERANCE * size);
                }
            }
        }
        // The energy of the step from cell to cell is positive if all cells have the cell ahead on the grid.
        let alike = (self.young[0] == self.young[1] && self.poisson[0] == self.poisson[1])
            || self.friction.coupling == Coupling::None;
        if alike && self.boundary.repeats(0) {
            let work =
                grid.cell_area() * self.pitch[0] * contact.max_shear() * largest(&u_x).max(largest(&u_y));
            let loads = contact.shear.iter().flatten().fold(0.0, |sum, q| sum + q.abs());
            let moved = largest(&u_x).max(largest(&u_y)) + given;
            let rounding = 1e-12 * grid.cell_area() * loads * moved;
            hold("slip work below 0", -solution.slip_work(), 1e-6 * work + rounding);
            hold(
                "slip work above the dissipation",
                solution.slip_work() - solution.dissipation,
                1e-6 * work + rounding,
            );
        }
        faults
    }
}
