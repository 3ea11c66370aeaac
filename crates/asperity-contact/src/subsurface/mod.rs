//! Stress under the surface of a body, plane by plane.
//!
//! z points into the body, and stress is positive in tension. A [`Subsurface`] stores the transforms of the
//! tractions on the surface. [`Subsurface::plane`] returns the stress at one depth, [`Subsurface::survey`]
//! the largest over many depths, in the body and in each of its layers.
//!
//! ```
//! use asperity_contact::reference::HertzSphere;
//! use asperity_contact::subsurface::{Subsurface, Tractions};
//! use asperity_contact::{Field, Grid};
//! use asperity_contact::operator::Boundary;
//!
//! let ball = HertzSphere { radius: 1e-3, modulus: 115e9, load: 1.0 };
//! let grid = Grid::new([65, 65], [1e-6; 2])?;
//! let pressure = Field::from_shape_fn(grid.shape, |(i, j)| {
//!     ball.pressure((grid.centre(0, i) - 32.5e-6).hypot(grid.centre(1, j) - 32.5e-6))
//! });
//! let steel = Subsurface::new(grid, Boundary::FREE, 0.3, &Tractions::frictionless(pressure));
//! let most = steel.maximum(&[0.0, 4e-6, 8e-6, 12e-6]).von_mises;
//! assert_eq!(most.cell, [32, 32]);
//! assert!((most.value / ball.peak_pressure() - 0.62).abs() < 0.002);
//! assert!((most.depth / ball.contact_radius() - 0.48).abs() < 0.02);
//! # Ok::<(), asperity_contact::Error>(())
//! ```

mod layered;
mod layers;
mod maximum;
mod response;
mod survey;

pub use layered::LayeredStress;
pub use layers::LayerStress;
pub use maximum::{Extreme, Maximum};
pub use response::StressAtDepth;
pub use survey::Survey;

use asperity_transforms::num_complex::Complex64;
use ndarray::{Array1, Array2, ArrayView1, Axis, s};

use crate::grid::{Field, Grid};
use crate::kernel::subsurface::{stress_lines, strip_stress};
use crate::kernel::{LayerCells, LayerStrip, Stack, Traction, WaveStress, harmonic_stress, stress_table};
use crate::math::{RealFft2, fft::angular_frequency, parallel};
use crate::operator::Boundary;
use crate::stress::{Component, Stress};
use crate::units::Metre;

/// Tractions on the surface of a body, on the cells of one grid.
#[derive(Debug, Clone, PartialEq)]
pub struct Tractions {
    /// Pressure p ≥ 0, into the body.
    pub pressure: Field,
    /// Shear tractions along +x and +y; `None` for zero.
    pub shear: [Option<Field>; 2],
}

impl Tractions {
    /// Creates a pressure without shear: contact without friction.
    pub fn frictionless(pressure: Field) -> Self {
        Self { pressure, shear: [None, None] }
    }

    /// Converts tractions on the lower body to those on the upper one: the same pressure, the reversed shear.
    /// The upper body's z also points into the body, so that its stresses are those of the mirror image.
    pub fn on_upper(self) -> Self {
        Self { shear: self.shear.map(|shear| shear.map(|q| -q)), ..self }
    }

    /// Iterates over the tractions that are not zero throughout.
    pub(crate) fn present(&self) -> impl Iterator<Item = (Traction, &Field)> {
        let [qx, qy] = &self.shear;
        let all = [
            (Traction::X, qx.as_ref()),
            (Traction::Y, qy.as_ref()),
            (Traction::Pressure, Some(&self.pressure)),
        ];
        all.into_iter()
            .filter_map(|(traction, field)| Some((traction, field?)))
            .filter(|(_, field)| field.iter().any(|value| *value != 0.0))
    }
}

/// A half-space under given tractions.
///
/// - [`Boundary::FREE`]: tractions are uniform in each cell, and zero outside the grid. A plane is the convolution of the
///   tractions with the closed form of [`crate::kernel::cell_stress`] by zero-padded transforms, exact to round-off.
/// - [`Boundary::PERIODIC`]: the harmonics of the values at the cells, each with the closed form of
///   [`crate::kernel::harmonic_stress`]. Under the mean pressure the body cannot expand laterally: σzz = −p̄,
///   σxx = σyy = −ν p̄/(1 − ν), at all depths.
/// - A body with [layers](Subsurface::with_layers) has the cells of [`LayerCells`] or the harmonics of [`Stack::stress`].
/// - Periodic along one axis, free along the other: each cell repeats endlessly along that axis. The cells of 17 periods are
///   summed, those beyond as the rest of an endless strip in plane strain. The part that is uniform along the axis is exact
///   to 1e-10 of the traction, the other part to 2e-4 of it.
pub struct Subsurface {
    grid: Grid,
    poisson: f64,
    boundary: Boundary,
    fft: RealFft2,
    /// Transforms of the tractions that are not zero.
    tractions: Vec<(Traction, Spectrum)>,
    /// Stress without tractions, if any.
    residual: Option<LayeredStress>,
    /// The layers, if any.
    stack: Option<Stack>,
}

type Spectrum = ndarray::Array2<Complex64>;

impl Subsurface {
    /// Creates a body with Poisson's ratio `poisson` under `tractions` on `grid`.
    ///
    /// # Panics
    /// If the grid of a traction differs.
    pub fn new(grid: Grid, boundary: Boundary, poisson: f64, tractions: &Tractions) -> Self {
        let fft = RealFft2::new(boundary.padded(grid.shape));
        let transform = |(traction, field): (Traction, &Field)| {
            assert_eq!(field.shape(), grid.shape, "shape of the tractions");
            (traction, fft.forward(field))
        };
        let tractions = tractions.present().map(transform).collect();
        Self { grid, poisson, boundary, fft, tractions, residual: None, stack: None }
    }

    /// Sets or removes a residual stress, which exists without tractions.
    pub fn with_residual(self, residual: impl Into<Option<LayeredStress>>) -> Self {
        Self { residual: residual.into(), ..self }
    }

    /// Sets or removes layers on the body.
    pub fn with_layers(self, stack: impl Into<Option<Stack>>) -> Self {
        Self { stack: stack.into(), ..self }
    }

    /// Residual stress, if any.
    pub fn residual(&self) -> Option<&LayeredStress> {
        self.residual.as_ref()
    }

    /// The grid of every plane.
    pub fn grid(&self) -> &Grid {
        &self.grid
    }

    /// Returns the stress at `depth` ≥ 0; at 0 its limit from inside the body, at an interface that from below, but
    /// from above on a rigid base.
    pub fn plane(&self, depth: Metre) -> Plane {
        self.plane_in(self.layer_at(depth), depth)
    }

    /// Returns the number of the layer at a depth, at an interface the one below, unless it is a rigid base.
    fn layer_at(&self, depth: Metre) -> usize {
        let Some(stack) = &self.stack else { return 0 };
        let tops = stack.interfaces();
        let base = tops.len() - 1;
        let reaches =
            |n: &usize| tops[*n] < depth || (tops[*n] == depth && !(*n == base && stack.has_rigid_base()));
        (0..tops.len()).rev().find(reaches).unwrap_or(0)
    }

    /// Returns the stress at a `depth` in a layer or at its faces; the body below all layers is the last one.
    pub fn plane_in(&self, layer: usize, depth: Metre) -> Plane {
        let inside = self.inside(layer, depth);
        let mut stress = Component::ALL.map(|component| self.component(component, depth, inside.as_ref()));
        if let Some(residual) = &self.residual {
            stress
                .iter_mut()
                .zip(residual.components(depth))
                .for_each(|(stress, residual)| *stress += &residual);
        }
        Plane { depth, stress }
    }

    /// Applies `look` to the plane at each of the `depths` in parallel, with one plane per thread. Returns
    /// the results in order.
    pub fn planes<T: Send>(&self, depths: &[Metre], look: impl Fn(Plane) -> T + Sync) -> Vec<T> {
        parallel::tasks(depths, |&depth| look(self.plane(depth)))
    }

    /// Returns the stress per unit of each traction, if the body has layers.
    fn inside(&self, layer: usize, depth: Metre) -> Option<Inside> {
        let stack = self.stack.as_ref()?;
        if !self.boundary.leaves_mean_free() {
            return Some(self.inside_cells(stack, layer, depth));
        }
        let [nx, ny] = self.fft.shape();
        Some(Inside::Waves(Array2::from_shape_fn([nx / 2 + 1, ny / 2 + 1], |(k, l)| {
            let q = angular_frequency(k, nx, self.grid.pitch[0]).hypot(angular_frequency(
                l,
                ny,
                self.grid.pitch[1],
            ));
            stack.stress(q, layer, depth)
        })))
    }

    fn inside_cells(&self, stack: &Stack, layer: usize, depth: Metre) -> Inside {
        let Grid { shape, pitch } = self.grid;
        let line =
            self.boundary.single_period().map(|axis| Repeated { axis, periods: PERIODS, grid: &self.grid });
        let (axis, along) = line.as_ref().map_or((1, shape[1]), |line| (line.axis, line.reach() + 1));
        let (across, width) = (shape[1 - axis], shape[1 - axis] as f64 * pitch[1 - axis]);
        let cells = LayerCells::new(stack, layer, depth, pitch, width.hypot(along as f64 * pitch[axis]));
        let line = line.map(|line| (line, LayerStrip::new(stack, layer, depth, pitch, axis, width)));
        let place = |i: usize, j: usize| if axis == 1 { [i, j] } else { [j, i] };
        let rows = parallel::tasks(0..across, |i| {
            let at = |j: usize| cells.at([0, 1].map(|axis| place(i, j)[axis] as f64 * pitch[axis]));
            let values: Vec<_> = (0..along).map(at).collect();
            match &line {
                None => values,
                Some((line, strip)) => line.folded_stresses(&values, strip.at(i as f64 * pitch[1 - axis])),
            }
        });
        let cell = |(i, j)| {
            let [across, along] = place(i, j);
            rows[across][along]
        };
        Inside::Cells { surface: cells.surface(), cells: Array2::from_shape_fn(shape, cell) }
    }

    fn component(&self, component: Component, depth: Metre, inside: Option<&Inside>) -> Field {
        let mut sum = Spectrum::zeros([self.fft.shape()[0], self.fft.half()]);
        let (imaginary, real): (Vec<_>, Vec<_>) =
            self.tractions.iter().partition(|(traction, _)| is_imaginary(*traction, component));
        for k in 0..real.len().max(imaginary.len()) {
            let pair = [real.get(k), imaginary.get(k)].map(|term| term.map(|(traction, _)| *traction));
            let symbol = self.symbol(component, pair, depth, inside);
            if let Some((_, traction)) = real.get(k) {
                ndarray::Zip::from(&mut sum).and(&symbol).and(traction).for_each(|s, g, q| *s += q * g.re);
            }
            if let Some((_, traction)) = imaginary.get(k) {
                ndarray::Zip::from(&mut sum)
                    .and(&symbol)
                    .and(traction)
                    .for_each(|s, g, q| *s += Complex64::new(-q.im * g.im, q.re * g.im));
            }
        }
        self.fft.inverse_leading(&sum, self.grid.shape)
    }

    /// Returns the transform of the influence of two tractions, one with a real transform in the real part,
    /// one with an imaginary transform in the imaginary part. The influence of the first is even in both
    /// directions or odd in both, that of the second odd in one.
    fn symbol(
        &self,
        component: Component,
        pair: [Option<Traction>; 2],
        depth: Metre,
        inside: Option<&Inside>,
    ) -> Spectrum {
        let shape @ [nx, ny] = self.fft.shape();
        if !self.boundary.leaves_mean_free() {
            let mut influence = Field::zeros(shape);
            for traction in pair.into_iter().flatten() {
                let Grid { shape: offsets, pitch } = self.grid;
                let odd = traction.odd(component);
                let (poisson, cells) = match inside {
                    Some(Inside::Cells { surface, cells }) => (*surface, Some(cells)),
                    _ => (Some(self.poisson), None),
                };
                let in_layers = cells.map(|cells| {
                    cells.mapv(|stresses| stresses[traction as usize].components()[component as usize])
                });
                match self.boundary.single_period() {
                    Some(axis) => {
                        let line = Repeated { axis, periods: PERIODS, grid: &self.grid };
                        if let Some(poisson) = poisson {
                            line.add(&mut influence, depth, poisson, component, traction);
                        }
                        for (i, values) in
                            in_layers.iter().flat_map(|table| table.axis_iter(Axis(1 - axis))).enumerate()
                        {
                            line.add_line(&mut influence, i, &values, odd);
                        }
                    }
                    None => {
                        let half_space =
                            poisson.map(|nu| stress_table(offsets, depth, pitch, nu, component, traction));
                        for table in half_space.iter().chain(&in_layers) {
                            add_folded(&mut influence, table, odd);
                        }
                    }
                }
            }
            return self.fft.forward(&influence);
        }
        Spectrum::from_shape_fn([nx, self.fft.half()], |(k, l)| {
            let q =
                [angular_frequency(k, nx, self.grid.pitch[0]), angular_frequency(l, ny, self.grid.pitch[1])];
            // A wave that alternates from cell to cell runs half in each direction, so that its odd part
            // cancels.
            let alternates = [2 * k == nx, 2 * l == ny];
            let part = |traction: Option<Traction>| match traction {
                Some(traction) if !cancels(alternates, traction.odd(component)) => match inside {
                    Some(Inside::Waves(waves)) => {
                        let length = q[0].hypot(q[1]);
                        let direction = if length == 0.0 { [1.0, 0.0] } else { q.map(|q| q / length) };
                        waves[[k.min(nx - k), l]].component(direction, component, traction)
                    }
                    _ => harmonic_stress(q, depth, self.poisson, component, traction),
                },
                _ => 0.0,
            };
            Complex64::new(part(pair[0]), part(pair[1]))
        })
    }
}

/// The stress in layers at a depth.
enum Inside {
    /// Stress of each wave of the grid, for wavenumbers ≥ 0.
    Waves(Array2<WaveStress>),
    /// At the offsets ≥ 0 from a cell, per unit of each traction, minus that of a half-space with Poisson's ratio `surface`. Along the
    /// axis of a line of cells that of all of them.
    Cells { surface: Option<f64>, cells: Array2<[Stress; 3]> },
}

/// Periods of a line of cells that are summed one by one, odd.
const PERIODS: usize = 17;

/// Cells that repeat endlessly along an axis.
struct Repeated<'g> {
    axis: usize,
    periods: usize,
    grid: &'g Grid,
}

impl Repeated<'_> {
    /// Adds the influence of one cell and its images at all offsets, those to negative offsets stored at the
    /// end.
    ///
    /// Beyond the periods that are summed, the images are a strip without end less the strip that is summed.
    fn add(
        &self,
        influence: &mut Field,
        depth: Metre,
        poisson: f64,
        component: Component,
        traction: Traction,
    ) {
        let Grid { shape, pitch } = *self.grid;
        let (axis, odd) = (self.axis, traction.odd(component));
        let lines = shape[1 - axis];
        let strip = strip_stress(lines, axis, depth, pitch, poisson, component, traction);
        let add = |i: usize, values: &[f64]| {
            let line = self.folded(values.iter().copied(), odd[axis], strip[i]);
            self.add_line(influence, i, &line.view(), odd);
        };
        stress_lines([lines, self.reach() + 1], axis, depth, pitch, poisson, component, traction, add);
    }

    /// Number of cells on either side that are summed one by one.
    fn reach(&self) -> usize {
        self.periods * self.grid.shape[self.axis] / 2
    }

    /// Sums the `values` under a cell at the offsets from 0 along the line over all its images. Those that are not summed one by one
    /// are an endless strip less what is.
    fn folded(&self, values: impl Iterator<Item = f64>, odd: bool, strip: f64) -> Array1<f64> {
        let n = self.grid.shape[self.axis];
        let sign = if odd { -1.0 } else { 1.0 };
        // Each offset along the axis then has as many images: of an even number the last ones count half.
        let last = if (self.periods * n).is_multiple_of(2) { 0.5 } else { 1.0 };
        let mut line = Array1::<f64>::zeros(n);
        let mut sum = 0.0;
        for (j, value) in values.enumerate() {
            let value = if j == self.reach() { last * value } else { value };
            line[j % n] += value;
            sum += value;
            if j > 0 {
                line[(n - j % n) % n] += sign * value;
                sum += sign * value;
            }
        }
        // Components that are odd along a strip vanish.
        if odd { line } else { line + (strip - sum) / n as f64 }
    }

    /// Sums all stresses under a cell, as [`folded`](Self::folded).
    fn folded_stresses(&self, values: &[[Stress; 3]], strip: [Stress; 3]) -> Vec<[Stress; 3]> {
        let sums = Traction::ALL.map(|traction| {
            let of = |stresses: &[Stress; 3]| stresses[traction as usize].components();
            Component::ALL.map(|component| {
                let n = component as usize;
                let odd = traction.odd(component)[self.axis];
                self.folded(values.iter().map(|stresses| of(stresses)[n]), odd, of(&strip)[n])
            })
        });
        let at =
            |j: usize| sums.each_ref().map(|sums| Stress::from_components(sums.each_ref().map(|sum| sum[j])));
        (0..self.grid.shape[self.axis]).map(at).collect()
    }

    /// Adds the i-th line from the cell at both sides of it.
    fn add_line(&self, influence: &mut Field, i: usize, line: &ArrayView1<f64>, odd: [bool; 2]) {
        let across = Axis(1 - self.axis);
        influence.index_axis_mut(across, i).scaled_add(1.0, line);
        if i > 0 {
            let sign = if odd[1 - self.axis] { -1.0 } else { 1.0 };
            let opposite = influence.len_of(across) - i;
            influence.index_axis_mut(across, opposite).scaled_add(sign, line);
        }
    }
}

/// Whether the transform of the influence is imaginary: odd in one direction only.
fn is_imaginary(traction: Traction, component: Component) -> bool {
    let [odd_x, odd_y] = traction.odd(component);
    odd_x != odd_y
}

fn cancels(alternates: [bool; 2], odd: [bool; 2]) -> bool {
    (0..2).any(|axis| alternates[axis] && odd[axis])
}

/// Adds a table of offsets from 0, and its mirror images at the negative offsets, which are stored at the
/// end.
fn add_folded(influence: &mut Field, table: &Field, odd: [bool; 2]) {
    let [sign_x, sign_y] = odd.map(|odd| if odd { -1.0 } else { 1.0 });
    let (rows, across) = (influence.nrows(), influence.ncols());
    let mut add = |i: usize, values: ArrayView1<f64>, sign: f64| {
        let mut row = influence.row_mut(i);
        row.slice_mut(s![..values.len()]).scaled_add(sign, &values);
        row.slice_mut(s![across + 1 - values.len()..]).scaled_add(sign * sign_y, &values.slice(s![1..;-1]));
    };
    for (i, values) in table.outer_iter().enumerate() {
        add(i, values, 1.0);
        if i > 0 {
            add(rows - i, values, sign_x);
        }
    }
}

/// The stress on a plane parallel to the surface.
#[derive(Debug, Clone, PartialEq)]
pub struct Plane {
    /// Distance from the surface.
    pub depth: Metre,
    /// The components, in the order of [`Component::ALL`].
    pub stress: [Field; 6],
}

impl Plane {
    /// Returns the stress at a cell.
    pub fn stress(&self, cell: [usize; 2]) -> Stress {
        Stress::from_components(self.stress.each_ref().map(|component| component[cell]))
    }

    /// Returns the components on the cells of a row along x, the `row`th in y.
    pub fn row(&self, row: usize) -> [Array1<f64>; 6] {
        self.stress.each_ref().map(|component| component.column(row).to_owned())
    }

    /// Returns the largest of a number of the stress over all cells, the first of equal ones.
    fn largest(&self, of: impl Fn(&Stress) -> f64) -> Extreme {
        let here = |((i, j), _)| Extreme { value: of(&self.stress([i, j])), cell: [i, j], depth: self.depth };
        self.stress[0].indexed_iter().map(here).reduce(Extreme::or).expect("a plane has cells")
    }

    /// Computes von Mises' stress of each cell, Pa.
    pub fn von_mises(&self) -> Field {
        von_mises(&self.stress)
    }
}

/// Computes von Mises' stress, Pa, from the components in the order of [`Component::ALL`].
pub fn von_mises(stress: &[Field; 6]) -> Field {
    let at = |cell| Stress::from_components(stress.each_ref().map(|component| component[cell]));
    Field::from_shape_fn(stress[0].raw_dim(), |(i, j)| at([i, j]).von_mises())
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::kernel::cell_stress;
    use crate::material::{Coating, Material};
    use crate::operator::Edge;
    use approx::assert_relative_eq;

    const LINE: Boundary = Boundary([Edge::Free, Edge::Periodic]);
    const LINE_ALONG_X: Boundary = Boundary([Edge::Periodic, Edge::Free]);

    fn patchy(shape: [usize; 2], seed: usize) -> Field {
        Field::from_shape_fn(shape, |(i, j)| {
            if (i / 2 + j) % 3 == 1 { 0.0 } else { ((7 * i + 3 * j * j + seed * i * j) % 11) as f64 - 3.0 }
        })
    }

    fn all_three(shape: [usize; 2]) -> Tractions {
        Tractions { pressure: patchy(shape, 0), shear: [Some(patchy(shape, 1)), Some(patchy(shape, 2))] }
    }

    #[test]
    fn a_plane_is_the_direct_sum_to_round_off() {
        for (shape, pitch) in [
            ([12, 12], [1.0, 1.0]),
            ([1, 9], [1.0, 0.5]),
            ([9, 1], [1.0, 2.0]),
            ([7, 10], [3e-6, 1e-6]),
            ([1, 1], [1.0, 1.0]),
        ] {
            let (grid, tractions) = (Grid::new(shape, pitch).unwrap(), all_three(shape));
            let body = Subsurface::new(grid, Boundary::FREE, 0.3, &tractions);
            for depth in [0.0, 0.2 * pitch[0], 4.0 * pitch[1]] {
                let plane = body.plane(depth);
                let most = plane.stress.iter().flatten().fold(0.0f64, |m, s| m.max(s.abs()));
                for cell in ndarray::indices(shape) {
                    let mut exact = Stress::default();
                    for (traction, field) in tractions.present() {
                        for (from, value) in field.indexed_iter() {
                            let x = (cell.0 as f64 - from.0 as f64) * pitch[0];
                            let y = (cell.1 as f64 - from.1 as f64) * pitch[1];
                            exact = exact + *value * cell_stress([x, y], depth, pitch, 0.3, traction);
                        }
                    }
                    let found = plane.stress([cell.0, cell.1]);
                    for (a, b) in found.components().iter().zip(exact.components()) {
                        assert!((a - b).abs() < 1e-13 * most, "{shape:?} at {depth}, {cell:?}: {a} is {b}");
                    }
                }
            }
        }
    }

    #[test]
    fn a_wave_decays_with_the_depth_and_a_mean_does_not() {
        let grid = Grid::new([16, 9], [0.5, 1.0]).unwrap();
        let (k, poisson, depth) = (std::f64::consts::TAU / 8.0, 0.3, 0.7);
        let wave =
            |phase: f64| Field::from_shape_fn(grid.shape, |(i, _)| (k * grid.centre(0, i) + phase).sin());
        let [sine, cosine] = [wave(0.0), wave(std::f64::consts::FRAC_PI_2)];
        let decay = (-k * depth).exp();
        let tractions = Tractions { pressure: 5.0 + &sine, shear: [Some(2.0 + &sine), None] };
        let plane = Subsurface::new(grid, Boundary::PERIODIC, poisson, &tractions).plane(depth);
        // Plane strain: Johnson (1985), section 13.2, plus the mean; σyy = ν(σxx + σzz) for the wave.
        let (s, c) = (&sine * decay, &cosine * decay);
        let kz = k * depth;
        let exact = [
            (Component::Zz, -5.0 - (1.0 + kz) * &s + kz * &c),
            (Component::Xz, -2.0 + kz * &c - (1.0 - kz) * &s),
            (Component::Xx, -5.0 * 0.3 / 0.7 - (1.0 - kz) * &s + (2.0 - kz) * &c),
            (Component::Yy, -5.0 * 0.3 / 0.7 - 0.3 * 2.0 * &s + 0.3 * 2.0 * &c),
            (Component::Xy, grid.zeros()),
        ];
        for (component, exact) in exact {
            for (a, b) in plane.stress[component as usize].iter().zip(&exact) {
                assert_relative_eq!(*a, *b, epsilon = 1e-13);
            }
        }
    }

    #[test]
    fn what_balances_itself_is_the_same_on_a_free_and_on_a_wide_periodic_body() {
        let grid = Grid::new([64, 64], [1.0, 1.0]).unwrap();
        // Without force and without moments of the first three orders, the effect of the other periods is of
        // order 1/r⁶. Steps in place of waves differ by (qΔx)²/24.
        let bell = Field::from_shape_fn(grid.shape, |(i, j)| {
            let [x, y] = [grid.centre(0, i) - 30.0, grid.centre(1, j) - 33.0].map(|t| t / 5.0);
            (1.0 - x * x) * (1.0 - y * y) * (-0.5 * (x * x + y * y)).exp()
        });
        let zero = grid.zeros();
        for traction in Traction::ALL {
            let only = |one| if traction == one { bell.clone() } else { zero.clone() };
            let tractions = Tractions {
                pressure: only(Traction::Pressure),
                shear: [Some(only(Traction::X)), Some(only(Traction::Y))],
            };
            let plane = |boundary| Subsurface::new(grid, boundary, 0.3, &tractions).plane(3.0);
            let (free, periodic) = (plane(Boundary::FREE), plane(Boundary::PERIODIC));
            for component in Component::ALL {
                let (free, periodic) =
                    (&free.stress[component as usize], &periodic.stress[component as usize]);
                let most = free.iter().fold(0.0f64, |m, s| m.max(s.abs()));
                let apart = (free - periodic).iter().fold(0.0f64, |m, s| m.max(s.abs()));
                assert!(most > 0.03 && apart < 0.01, "{traction:?} {component:?}: {apart} of {most}");
            }
        }
    }

    #[test]
    fn tractions_of_zero_cost_nothing_and_change_nothing() {
        let grid = Grid::new([8, 6], [1.0, 1.0]).unwrap();
        let pressure = patchy(grid.shape, 0);
        let zeros = Tractions { pressure: pressure.clone(), shear: [Some(grid.zeros()), Some(grid.zeros())] };
        let (with, without) = [zeros, Tractions::frictionless(pressure)]
            .map(|tractions| Subsurface::new(grid, Boundary::FREE, 0.3, &tractions))
            .into();
        assert_eq!(with.tractions.len(), 1);
        assert_eq!(with.plane(0.5), without.plane(0.5));
        let none = Subsurface::new(grid, Boundary::FREE, 0.3, &Tractions::frictionless(grid.zeros()));
        assert!(none.plane(1.0).von_mises().iter().all(|v| *v == 0.0));
    }

    #[test]
    fn the_upper_body_is_drawn_the_other_way() {
        let grid = Grid::new([9, 8], [1.0, 1.0]).unwrap();
        let (pressure, shear) = (patchy(grid.shape, 0).mapv(f64::abs), patchy(grid.shape, 1));
        let tractions = Tractions { pressure: pressure.clone(), shear: [Some(shear.clone()), None] };
        let plane = |tractions: &Tractions| Subsurface::new(grid, Boundary::FREE, 0.3, tractions).plane(0.8);
        let (lower, upper) = (plane(&tractions), plane(&tractions.clone().on_upper()));
        let pressed = plane(&Tractions::frictionless(pressure));
        for ((lower, upper), pressed) in lower.stress.iter().zip(&upper.stress).zip(&pressed.stress) {
            assert!((lower + upper - 2.0 * pressed).iter().all(|s| s.abs() < 1e-12));
        }
    }

    /// Stress at `(x, z)` under the uniform pressure 1 on |x| < a, endless along y: Johnson, *Contact
    /// mechanics*, 2.5.
    fn under_a_strip(x: f64, z: f64, a: f64, poisson: f64) -> [f64; 6] {
        let [first, second] = [z.atan2(x - a), z.atan2(x + a)];
        let [angle, difference] = [2.0 * (first - second), (2.0 * first).sin() - (2.0 * second).sin()];
        let tau = std::f64::consts::TAU;
        let [xx, zz] = [-(angle + difference) / tau, -(angle - difference) / tau];
        let xz = ((2.0 * first).cos() - (2.0 * second).cos()) / tau;
        [xx, poisson * (xx + zz), zz, 0.0, xz, 0.0]
    }

    #[test]
    fn a_pressure_that_is_uniform_along_a_line_stresses_the_body_in_plane_strain() {
        for (shape, boundary) in [([24, 1], "y"), ([24, 5], "y"), ([24, 6], "y"), ([6, 24], "x")] {
            let grid = Grid::new(shape, [0.5e-6, 0.7e-6]).unwrap();
            let axis = usize::from(boundary == "y");
            let boundary = Boundary([0, 1].map(|a| if a == axis { Edge::Periodic } else { Edge::Free }));
            let pressure = Field::from_shape_fn(shape, |(i, j)| {
                f64::from(u8::from((8..16).contains(&[i, j][1 - axis])))
            });
            let body = Subsurface::new(grid, boundary, 0.3, &Tractions::frictionless(pressure));
            let half = 4.0 * grid.pitch[1 - axis];
            for depth in [0.0, 0.1e-6, 1e-6, 7e-6] {
                let plane = body.plane(depth);
                for i in 0..24 {
                    let x = grid.centre(1 - axis, i) - 3.0 * half;
                    let mut exact = under_a_strip(x, depth, half, 0.3);
                    if axis == 0 {
                        exact.swap(0, 1);
                        exact.swap(3, 4);
                    }
                    let cell = if axis == 1 { [i, shape[1] / 2] } else { [shape[0] / 2, i] };
                    for (component, (stress, exact)) in
                        plane.stress(cell).components().iter().zip(exact).enumerate()
                    {
                        assert!(
                            (stress - exact).abs() < 2e-9,
                            "{shape:?} {component} {i} {depth}: {stress} {exact}"
                        );
                    }
                }
            }
        }
    }

    #[test]
    fn a_line_of_cells_is_a_long_free_grid_of_them() {
        const TIMES: usize = 41;
        let grid = Grid::new([6, 4], [1e-6, 1.5e-6]).unwrap();
        let long = Grid::new([6, TIMES * 4], grid.pitch).unwrap();
        let endless = Boundary([Edge::Free, Edge::Periodic]);
        let tractions = all_three(grid.shape);
        let repeated = |field: &Field| Field::from_shape_fn(long.shape, |(i, j)| field[[i, j % 4]]);
        let many = Tractions {
            pressure: repeated(&tractions.pressure),
            shear: tractions.shear.each_ref().map(|field| field.as_ref().map(repeated)),
        };
        let layer = Coating::new(1e-6, 3.0, 0.2).unwrap();
        let layers = Stack::new(&Material::elastic(1.0, 0.4).unwrap().layered(vec![layer]));
        for stack in [None, Some(layers)] {
            let [line, free] = [(grid, endless, &tractions), (long, Boundary::FREE, &many)].map(
                |(grid, boundary, tractions)| {
                    Subsurface::new(grid, boundary, 0.3, tractions).with_layers(stack.clone())
                },
            );
            for depth in [0.0, 0.5e-6, 3e-6] {
                let (one, all) = (line.plane(depth), free.plane(depth));
                for (one, all) in one.stress.iter().zip(&all.stress) {
                    let middle = all.slice(s![.., TIMES / 2 * 4..(TIMES / 2 + 1) * 4]);
                    // The free grid ends: its far parts lack (width · depth)/(half length)², 24 tractions of 5 at
                    // 123 µm.
                    let difference =
                        (one - &middle).iter().fold(0.0, |most: f64, value| most.max(value.abs()));
                    assert!(difference < 0.02, "{depth}: {difference}, {}", stack.is_some());
                }
            }
        }
    }

    #[test]
    fn lines_of_coefficients_are_those_of_the_table() {
        let (shape, pitch) = ([3, 4], [1e-6, 1.5e-6]);
        for (traction, component) in Traction::ALL
            .into_iter()
            .flat_map(|traction| Component::ALL.map(|component| (traction, component)))
        {
            let table = stress_table(shape, 0.4e-6, pitch, 0.3, component, traction);
            for axis in [0, 1] {
                let (lines, along) = (shape[1 - axis], shape[axis]);
                stress_lines([lines, along], axis, 0.4e-6, pitch, 0.3, component, traction, |i, values| {
                    for (j, value) in values.iter().enumerate() {
                        let at = if axis == 1 { [i, j] } else { [j, i] };
                        assert!(
                            (value - table[at]).abs() < 1e-14,
                            "{traction:?} {component:?} {axis} {at:?}"
                        );
                    }
                });
            }
        }
    }

    #[test]
    fn more_periods_change_a_line_by_no_more_than_is_said() {
        let mut most = 0.0f64;
        let grid = Grid::new([20, 4], [1e-6, 1.5e-6]).unwrap();
        for (traction, component) in Traction::ALL
            .into_iter()
            .flat_map(|traction| Component::ALL.map(|component| (traction, component)))
        {
            for depth in [0.0, 0.5e-6, 4e-6] {
                let [some, many] = [PERIODS, 8 * PERIODS + 1].map(|periods| {
                    let mut influence = Field::zeros([40, 4]);
                    let line = Repeated { axis: 1, periods, grid: &grid };
                    line.add(&mut influence, depth, 0.3, component, traction);
                    influence
                });
                let difference = (&some - &many).iter().fold(0.0, |most: f64, value| most.max(value.abs()));
                most = most.max(difference);
            }
        }
        assert!(most < 2e-4, "{most:e}");
    }

    /// Waves of pressure and shear, with a mean.
    fn waves_of_tractions(grid: &Grid) -> Tractions {
        let field = |seed: usize| {
            Field::from_shape_fn(grid.shape, |(i, j)| {
                (0.7 * (i * (seed + 1)) as f64 + 0.3 * (j * j) as f64).sin() + 0.2 * seed as f64
            })
        };
        Tractions { pressure: field(3), shear: [Some(field(1)), Some(field(2))] }
    }

    #[test]
    fn in_layers_alike_it_is_that_of_the_half_space_at_both_sides_of_interfaces() {
        let grid = Grid::new([10, 9], [0.5, 0.7]).unwrap();
        let tractions = waves_of_tractions(&grid);
        let layer = Coating::new(0.8, 2.0, 0.3).unwrap();
        let stack = Stack::new(&Material::elastic(2.0, 0.3).unwrap().layered(vec![layer; 3]));
        for (boundary, tolerance) in
            [(Boundary::PERIODIC, 1e-12), (Boundary::FREE, 1e-5), (LINE, 1e-5), (LINE_ALONG_X, 1e-5)]
        {
            let plain = Subsurface::new(grid, boundary, 0.3, &tractions);
            let layered = Subsurface::new(grid, boundary, 0.3, &tractions).with_layers(stack.clone());
            for (n, depth) in [(0, 0.0), (0, 0.8), (1, 0.8), (1, 1.3), (3, 2.4), (3, 4.0)] {
                let (expected, found) = (plain.plane(depth), layered.plane_in(n, depth));
                for (expected, found) in expected.stress.iter().zip(&found.stress) {
                    for (expected, found) in expected.iter().zip(found) {
                        assert_relative_eq!(*found, *expected, epsilon = tolerance);
                    }
                }
            }
            let depths = [0.0, 0.5, 1.0, 1.5, 2.0];
            let most = plain.maximum(&[0.0, 0.8, 1.6, 0.5, 1.0, 1.5, 2.0]).von_mises;
            let layers = layered.survey(&depths, |_, _| ()).layers;
            assert_eq!(layers.iter().map(|layer| layer.depth).collect::<Vec<_>>(), [0.0, 0.8, 1.6]);
            // Beside an interface, too, the search goes on.
            let [refined, whole] = [&layered, &plain].map(|body| body.maximum(&depths).von_mises);
            assert!(refined.value >= (1.0 - 1e-3) * whole.value, "{refined:?} {whole:?}");
            let found = layers.iter().map(|layer| layer.von_mises.value).fold(0.0, f64::max);
            assert_relative_eq!(found, most.value, max_relative = 10.0 * tolerance);
        }
    }

    #[test]
    fn a_stiff_layer_on_a_soft_body_is_pulled_where_it_bends_and_tractions_cross_the_interface() {
        let grid = Grid::new([64, 64], [0.25; 2]).unwrap();
        let pressure = Field::from_shape_fn(grid.shape, |(i, j)| {
            (1.0 - ((i as f64 - 32.0).powi(2) + (j as f64 - 32.0).powi(2)) / 64.0).max(0.0).sqrt()
        });
        let base = Material::elastic(1.0, 0.3).unwrap();
        let stack = Stack::new(&base.layered(vec![Coating::new(0.5, 10.0, 0.2).unwrap()]));
        let tractions = Tractions::frictionless(pressure);
        let body = Subsurface::new(grid, Boundary::PERIODIC, 0.3, &tractions).with_layers(stack);
        let [above, below] = [0, 1].map(|layer| body.plane_in(layer, 0.5));
        for component in [Component::Zz, Component::Yz, Component::Xz] {
            for (above, below) in
                above.stress[component as usize].iter().zip(&below.stress[component as usize])
            {
                assert_relative_eq!(*above, *below, epsilon = 1e-12);
            }
        }
        let layers = body.survey(&[0.0, 0.25, 0.75, 1.5], |_, _| ()).layers;
        let [layer, base] = layers.as_slice() else { panic!("{layers:?}") };
        // Below the contact the layer bends: its lower face is pulled harder than anything on its surface.
        assert!(layer.tension_below.unwrap() > layer.tension.value.max(0.0), "{layer:?}");
        assert!(base.tension_below.is_none() && base.shear > 0.0 && layer.shear < 1e-10, "{layers:?}");
        assert!(layer.von_mises.value > base.von_mises.value);
    }

    #[test]
    fn a_rigid_body_below_a_layer_has_no_stress_but_takes_the_tractions_of_the_layer() {
        let grid = Grid::new([10, 9], [0.5, 0.7]).unwrap();
        let tractions = waves_of_tractions(&grid);
        let rigid = Material::elastic(f64::INFINITY, 0.0).unwrap();
        let stack = Stack::new(&rigid.layered(vec![Coating::new(0.8, 2.0, 0.3).unwrap()]));
        for boundary in [Boundary::PERIODIC, Boundary::FREE, LINE] {
            let body = Subsurface::new(grid, boundary, 0.0, &tractions).with_layers(stack.clone());
            assert!(body.plane(1.0).stress.iter().flatten().all(|stress| *stress == 0.0));
            assert_eq!(body.plane(0.8).stress, body.plane_in(0, 0.8).stress);
            let layers = body.survey(&[0.0, 0.5, 1.0], |_, _| ()).layers;
            let lower = body.plane_in(0, 0.8);
            assert_eq!(layers[1].shear, lower.largest(|stress| stress.xz.hypot(stress.yz)).value);
            assert_eq!(layers[1].pull, lower.largest(|stress| stress.zz).value);
            assert_eq!((layers[1].von_mises.value, layers[1].von_mises.depth), (0.0, 0.8));
            assert!(layers[1].shear > 0.1, "{layers:?}");
        }
    }
}
