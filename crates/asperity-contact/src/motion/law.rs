//! Laws by which a pass changes the bodies.

use crate::error::Result;
use crate::grid::{CellValues, Field, Placement};
use crate::math::gathered;
use crate::motion::contact::Contact;
use crate::motion::kinematics::Motion;
use crate::motion::pair::Pair;
use crate::motion::path::{Position, Stroke};
use crate::motion::record::{LawsInCycles, LawsInPass, LawsInUpdate, LostVolume};
use crate::motion::rim::Interior;
use crate::solver::{FrictionalSolution, Sliding};
use crate::units::{Kelvin, Metre, Pascal, PerPascal, Second, WattPerSquareMetre};

/// A law by which the contacts of a pass change the bodies: plastic flow, removal of material, growth of a
/// film.
///
/// A law is called in two steps. [`Law::add`] reads the contact at each position, in order, and adds its
/// effect to sums over the pass. [`Law::advance`] then changes the bodies by these sums. A law stores data
/// between passes in [`crate::motion::Body::state`], never in itself. Results and resumed runs contain only
/// the bodies, and a pass is tried at several approaches before one is accepted.
pub trait Law: Send + Sync {
    /// Name of the law in results, in snake case. Plastic flow is `plastic`, with its volumes in the columns
    /// `plastic_volume_lower`, ….
    fn name(&self) -> &str;

    /// Prepares the bodies before their first pass: adds the state of the law if it is missing.
    fn prepare(&mut self, pair: &mut Pair) {
        let _ = pair;
    }

    /// Number of fields that the law sums over a pass for each body.
    fn sums(&self) -> usize {
        1
    }

    /// Adds the effect of the contact at one position to the sums on the lower and on the upper body, which
    /// are zero at the beginning of the pass.
    fn add(&self, pair: &Pair, contact_cells: &ContactCells, sums: &mut [Vec<Field>; 2]);

    /// Whether the law acts again in each extrapolated pass: removal does, plastic flow does not.
    fn repeats(&self) -> bool {
        true
    }

    /// Whether the depths that the law takes uncover the material below, which memories keep: removal of a
    /// body does, a film that grows on it does not.
    fn uncovers(&self) -> bool {
        false
    }

    /// Largest depth that the law removes from each body per pressure and distance slid, 1/Pa, with shear
    /// equal to `friction` times the pressure. If it is not 0, the first sum of the law is in proportion to
    /// the pressure. It limits the extrapolation over passes, before pressures oscillate.
    fn per_pressure(&self, friction: f64) -> [PerPascal; 2] {
        let _ = friction;
        [0.0; 2]
    }

    /// [`Law::per_pressure`] for each cell of the lower and of the upper body with these sums, used to solve
    /// a contact that slides in place. An estimate is enough, because [`Law::advance`] determines the depth
    /// removed. The closer it is, the longer the updates may be.
    fn per_pressure_of_cells(&self, pair: &Pair, sums: &[Vec<Field>; 2], friction: f64) -> [CellValues; 2] {
        let _ = (pair, sums);
        self.per_pressure(friction).map(CellValues::Uniform)
    }

    /// Changes the state of the bodies by `passes` passes with these sums. Returns the height that the law takes
    /// from each cell of the lower and of the upper body, m. It is below 0 if a cell grows. The caller lowers
    /// the heights.
    fn advance(&self, pair: &mut Pair, sums: &[Vec<Field>; 2], passes: f64) -> [Field; 2];

    /// Largest depth by which the law has lowered or raised a cell of the lower and of the upper body since
    /// the beginning, m; 0 if the law does not store it.
    fn deepest(&self, pair: &Pair) -> [Metre; 2] {
        let _ = pair;
        [0.0; 2]
    }

    /// Fills the columns of the law in the row of a pass, from the bodies after it and the depths `taken`
    /// from them.
    fn record_pass(&self, pair: &Pair, taken: &[Field; 2], columns: &mut LawsInPass) {
        let _ = (pair, taken, columns);
    }

    /// Fills the columns of the law in the row of an update, from the bodies after it and their `contact`.
    fn record_update(&self, pair: &Pair, contact: &Contact, columns: &mut LawsInUpdate) {
        let _ = (pair, contact, columns);
    }

    /// Fills the columns of the law in the row of an increment, from the bodies after it.
    fn record_cycles(&self, pair: &Pair, columns: &mut LawsInCycles) {
        let _ = (pair, columns);
    }
}

/// The cells in contact at one position.
///
/// Their quantities are slices of equal length. A cell in contact lies on one cell of each body or, in a
/// shift, between two of its columns. [`ContactCells::add`] and [`ContactCells::keep_largest`] transfer its
/// values to the body.
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub struct ContactCells<'a> {
    /// The relative position of the bodies.
    pub position: &'a Position,
    /// Flat cells of the lower and of the upper body under those in contact; the first one if a cell lies
    /// between two.
    cells: [&'a [u32]; 2],
    placements: [Placement; 2],
    /// Pressure on each of the cells in contact, Pa.
    pub pressure: &'a [Pascal],
    /// Plastic interference w of each of these cells, m; 0 if the pressure is below the hardness.
    pub interference: &'a [Metre],
    /// Magnitude of the shear traction on each of these cells, Pa; 0 without friction.
    pub shear: &'a [Pascal],
    /// Surface temperature of the lower and of the upper body on each of these cells, K; NaN if unknown.
    pub temperature: [&'a [Kelvin]; 2],
    sliding: Slid<'a>,
    /// Time for which this position stands, s; NaN if the speed is unknown.
    pub time: Second,
}

/// How far the cells in contact slide.
#[derive(Debug, Clone, Copy)]
enum Slid<'a> {
    /// All of them as far, m.
    Alike(Metre),
    /// Each by its own distance, m.
    Each(&'a [Metre]),
}

impl ContactCells<'_> {
    /// Returns the distance that a cell in contact slides, by its index: on the way for which this position
    /// stands, or in an increment, m.
    pub fn sliding_distance(&self, index: usize) -> Metre {
        match self.sliding {
            Slid::Alike(distance) => distance,
            Slid::Each(distances) => distances[index],
        }
    }

    /// Adds the value of each cell in contact, by its index, to a sum on a body, 0 the lower or 1 the upper
    /// one. Between two columns the value is split by their weights, so that the total added is the sum of
    /// the values.
    pub fn add(&self, body: usize, sum: &mut Field, value: impl Fn(usize) -> f64) {
        let sum = sum.as_slice_mut().expect("standard layout");
        let (placement, cells) = (&self.placements[body], self.cells[body].iter().enumerate());
        if placement.fraction() == 0.0 {
            cells.for_each(|(index, &cell)| sum[cell as usize] += value(index));
            return;
        }
        for (index, &cell) in cells {
            let value = value(index);
            placement.parts(cell as usize).for_each(|(cell, weight)| sum[cell] += weight * value);
        }
    }

    /// Updates the largest value of each cell of a body, 0 the lower or 1 the upper one, over all positions.
    /// The values at this position are given for each cell in contact by its index, and transferred as in
    /// [`ContactCells::add`].
    pub fn keep_largest(&self, body: usize, largest: &mut Field, value: impl Fn(usize) -> f64) {
        let largest = largest.as_slice_mut().expect("standard layout");
        let placement = &self.placements[body];
        let parts = self.cells[body].iter().enumerate().flat_map(|(index, &cell)| {
            let value = value(index);
            placement.parts(cell as usize).map(move |(cell, weight)| (cell as u32, weight * value))
        });
        let values = if placement.fraction() == 0.0 { parts.collect() } else { gathered(parts) };
        for (cell, value) in values {
            let largest = &mut largest[cell as usize];
            *largest = largest.max(value);
        }
    }

    /// Returns the value of a body, 0 the lower or 1 the upper one, at a cell in contact, by its index.
    /// Between two columns it is the weighted mean.
    pub fn value(&self, body: usize, values: &CellValues, index: usize) -> f64 {
        self.placements[body].value(values, self.cells[body][index] as usize)
    }
}

/// Data of a position for laws, besides the contact.
#[derive(Clone, Copy)]
pub(super) struct PositionData {
    /// Sliding on the forward stroke, if there is friction.
    pub(super) sliding: Option<Sliding>,
    /// Sliding distance for which the position stands.
    pub(super) distance: Metre,
    /// Time for which the position stands.
    pub(super) time: Second,
    /// Temperatures of the bodies.
    pub(super) bulk: [Kelvin; 2],
}

impl PositionData {
    /// Returns the data of a position of a `motion` of a `pair` with these temperatures of its bodies.
    pub(super) fn new(motion: &Motion, pair: &Pair, bulk: [Kelvin; 2]) -> Self {
        let (cells, pitch) = (motion.cells_of_position(pair.lower.columns()), pair.pitch()[0]);
        Self {
            sliding: motion.sliding(Stroke::Forth),
            distance: motion.sliding_distance_of(cells, pitch),
            time: motion.time_of(cells, pitch),
            bulk,
        }
    }
}

/// Sums of a law over a pass, on the lower and on the upper body.
pub type Sums = [Vec<Field>; 2];

/// Computes the temperature of cells in contact, of the lower and of the upper body at a position, from the
/// frictional heat flux on each.
pub(super) type Heat<'a> =
    dyn FnMut([&[u32]; 2], &Position, &[WattPerSquareMetre]) -> Result<Vec<Kelvin>> + 'a;

/// Returns how many of the `laws`, the first ones, act once per computed pass. The others also act in the
/// extrapolated passes.
pub(super) fn once(laws: &[Box<dyn Law>]) -> usize {
    laws.iter().take_while(|law| !law.repeats()).count()
}

/// Creates zero sums for `laws` on a `pair`.
pub(super) fn nothing(laws: &[Box<dyn Law>], pair: &Pair) -> Vec<Sums> {
    let shapes = [pair.lower.heights.raw_dim(), pair.upper.heights.raw_dim()];
    laws.iter().map(|law| shapes.map(|shape| vec![Field::zeros(shape); law.sums()])).collect()
}

/// Depths that `laws` take from no cell of a `pair`.
pub(super) fn untouched(laws: &[Box<dyn Law>], pair: &Pair) -> Vec<[Field; 2]> {
    let shapes = [pair.lower.heights.raw_dim(), pair.upper.heights.raw_dim()];
    laws.iter().map(|_| shapes.map(Field::zeros)).collect()
}

/// Volumes of `laws` that have removed nothing.
pub(super) fn nothing_lost(laws: &[Box<dyn Law>]) -> Vec<LostVolume> {
    laws.iter().map(|law| LostVolume::nothing(law.name())).collect()
}

/// Sums `laws` over contacts on frozen bodies. `heat` computes the temperatures at each contact; without it
/// the surfaces have the temperatures of the bodies. Returns the sums, and with `heat` the temperature of the
/// cells of each contact.
pub(super) fn sums(
    laws: &[Box<dyn Law>],
    pair: &Pair,
    contacts: &[Contact],
    position_data: &PositionData,
    mut heat: Option<&mut Heat<'_>>,
) -> Result<(Vec<Sums>, Vec<Vec<Kelvin>>)> {
    let mut sums = nothing(laws, pair);
    let mut warm = Vec::new();
    for contact in contacts {
        let placements = pair.placements(&contact.position);
        let [lower, upper] = placements.map(|placement| -> Vec<u32> {
            contact.pressure.iter().map(|(cell, _)| placement.cell(*cell as usize) as u32).collect()
        });
        // Laws count pressure alone, not tension.
        let pressure: Vec<Pascal> = contact.pressure.iter().map(|(_, p)| p.max(0.0)).collect();
        let magnitude = |&p: &Pascal| {
            position_data
                .sliding
                .map_or(0.0, |sliding| sliding.shear(p).iter().fold(0.0, |q: f64, part| q.hypot(*part)))
        };
        let shear: Vec<Pascal> = pressure.iter().map(magnitude).collect();
        let mut temperature = position_data.bulk.map(|temperature| vec![temperature; pressure.len()]);
        if let Some(heat) = &mut heat {
            let speed = position_data.distance / position_data.time;
            let flux: Vec<f64> = shear.iter().map(|q| q * speed).collect();
            let of_cells = heat([&lower, &upper], &contact.position, &flux)?;
            temperature = [of_cells.clone(), of_cells.clone()];
            warm.push(of_cells);
        }
        let contact_cells = ContactCells {
            position: &contact.position,
            cells: [&lower, &upper],
            placements,
            pressure: &pressure,
            interference: &contact.interference(),
            shear: &shear,
            temperature: [&temperature[0], &temperature[1]],
            sliding: Slid::Alike(position_data.distance),
            time: position_data.time,
        };
        laws.iter().zip(&mut sums).for_each(|(law, sums)| law.add(pair, &contact_cells, sums));
    }
    Ok((sums, warm))
}

/// The slip of an increment, on the cells in contact.
pub(super) struct CyclicSlip {
    pub(super) cells: Vec<u32>,
    /// Mean of the pressures before and after the increment.
    pressure: Vec<Pascal>,
    /// Mean of the largest shear before and after it.
    shear: Vec<Pascal>,
    distance: Vec<Metre>,
}

impl CyclicSlip {
    /// Returns the slip of the increment of `contact`, as [`FrictionalSolution::dissipation`] counts it: the
    /// energy is the sum of shear and distance.
    pub(super) fn from_contact(contact: &FrictionalSolution, before: Option<&FrictionalSolution>) -> Self {
        let mut found =
            Self { cells: Vec::new(), pressure: Vec::new(), shear: Vec::new(), distance: Vec::new() };
        let cells = contact.normal.pressure.indexed_iter().enumerate();
        for (flat, (cell, pressure)) in cells.filter(|(_, (_, pressure))| **pressure > 0.0) {
            let limit = contact.shear_limit[cell];
            let [then, limit_then] = before.map_or([*pressure, limit], |before| {
                [before.normal.pressure[cell].max(0.0), before.shear_limit[cell]]
            });
            let slips = limit > 0.0 && contact.stick[cell] == 0.0;
            found.cells.push(flat as u32);
            found.pressure.push(0.5 * (then + pressure));
            found.shear.push(0.5 * (limit_then + limit));
            found.distance.push(if slips { contact.slip[0][cell].hypot(contact.slip[1][cell]) } else { 0.0 });
        }
        if let Some(before) = before {
            let columns = before.normal.pressure.ncols();
            for ([i, j], shear, distance) in contact.leaving(before) {
                found.cells.push((i * columns + j) as u32);
                found.pressure.push(0.5 * before.normal.pressure[[i, j]].max(0.0));
                found.shear.push(0.5 * shear);
                found.distance.push(distance);
            }
        }
        found
    }

    /// Energy that friction takes on each cell, J/m².
    pub(super) fn energies(&self) -> impl Iterator<Item = (usize, f64)> + '_ {
        let cells = self.cells.iter().zip(&self.shear).zip(&self.distance);
        cells.map(|((cell, shear), distance)| (*cell as usize, shear * distance))
    }
}

/// Adds the slip of an increment at rest, on cells of this `temperature`, to the sums of `laws`.
pub(super) fn add_slip(
    laws: &[Box<dyn Law>],
    pair: &Pair,
    slip: &CyclicSlip,
    time: Second,
    temperature: &[Vec<Kelvin>; 2],
    sums: &mut [Sums],
) {
    let position = pair.at_rest();
    let nothing = vec![0.0; slip.cells.len()];
    let contact_cells = ContactCells {
        position: &position,
        cells: [&slip.cells, &slip.cells],
        placements: pair.placements(&position),
        pressure: &slip.pressure,
        interference: &nothing,
        shear: &slip.shear,
        temperature: [&temperature[0], &temperature[1]],
        sliding: Slid::Each(&slip.distance),
        time,
    };
    laws.iter().zip(sums).for_each(|(law, sums)| law.add(pair, &contact_cells, sums));
}

/// Applies `laws` to a `pair` for `passes` passes with these sums. Adds the volume removed by each law to
/// `lost`, and returns the depths removed.
pub(super) fn advance(
    laws: &[Box<dyn Law>],
    pair: &mut Pair,
    sums: &[Sums],
    passes: f64,
    interiors: &[Interior; 2],
    lost: &mut [LostVolume],
) -> Vec<[Field; 2]> {
    let mut depths = Vec::new();
    for ((law, sums), lost) in laws.iter().zip(sums).zip(lost) {
        let depth = law.advance(pair, sums, passes);
        remove(pair, &depth, interiors, lost);
        depths.push(depth);
    }
    depths
}

/// Returns the depth that `laws` remove from each cell of the lower and of the upper body per pressure over a
/// `distance`, m/Pa. They act with these sums, and with shear equal to `friction` times the pressure.
pub(super) fn compliance(
    laws: &[Box<dyn Law>],
    pair: &Pair,
    sums: &[Sums],
    friction: f64,
    distance: Metre,
) -> [CellValues; 2] {
    let of_laws: Vec<_> =
        laws.iter().zip(sums).map(|(law, sums)| law.per_pressure_of_cells(pair, sums, friction)).collect();
    [0, 1].map(|body| {
        let at = |cell: usize| distance * of_laws.iter().map(|of_law| of_law[body].value(cell)).sum::<f64>();
        if of_laws.iter().all(|of_law| of_law[body].uniform().is_some()) {
            return CellValues::Uniform(at(0));
        }
        let mut depth = Field::zeros([&pair.lower, &pair.upper][body].heights.raw_dim());
        depth.iter_mut().enumerate().for_each(|(cell, depth)| *depth = at(cell));
        depth.into()
    })
}

/// Returns the depths that `laws` would remove from a `pair` in `passes` passes with these sums.
pub(super) fn tried(laws: &[Box<dyn Law>], pair: &Pair, sums: &[Sums], passes: usize) -> Vec<[Field; 2]> {
    let mut pair = pair.clone();
    laws.iter().zip(sums).map(|(law, sums)| law.advance(&mut pair, sums, passes as f64)).collect()
}

/// Returns the depth by which the `laws` that uncover material have lowered both bodies, from what each has
/// `taken`; `None` without such laws.
pub(super) fn uncovered(laws: &[Box<dyn Law>], taken: &[[Field; 2]]) -> Option<[Field; 2]> {
    let uncovers = laws.iter().zip(taken).filter(|(law, _)| law.uncovers());
    uncovers.map(|(_, taken)| taken.clone()).reduce(|[a, b], [c, d]| [a + c, b + d])
}

/// Returns the largest depth removed from a cell of each body by all laws together.
pub(super) fn deepest(depths: &[[Field; 2]]) -> [Metre; 2] {
    let of_law = |depth: &[Field; 2]| [0, 1].map(|body| largest(&depth[body]));
    depths.iter().map(of_law).fold([0.0; 2], |sum: [f64; 2], most| [sum[0] + most[0], sum[1] + most[1]])
}

/// Returns the largest value of a field, at least 0.
pub(crate) fn largest(field: &Field) -> f64 {
    field.iter().fold(0.0, |most: f64, value| most.max(*value))
}

/// Returns the largest difference between two sets of depths at a cell, summed over all laws.
pub(super) fn difference(one: &[[Field; 2]], other: &[[Field; 2]]) -> Metre {
    let of_field = |one: &Field, other: &Field| {
        one.iter().zip(other).fold(0.0, |most: f64, (one, other)| most.max((one - other).abs()))
    };
    let of_law = |(one, other): (&[Field; 2], &[Field; 2])| {
        of_field(&one[0], &other[0]).max(of_field(&one[1], &other[1]))
    };
    one.iter().zip(other).map(of_law).sum()
}

/// Removes a `depth` from each cell of the lower and of the upper body, m, and adds its volume to `lost`.
pub(super) fn remove(pair: &mut Pair, depth: &[Field; 2], interiors: &[Interior; 2], lost: &mut LostVolume) {
    pair.lower.heights -= &depth[0];
    pair.upper.heights += &depth[1];
    for (body, depth) in depth.iter().enumerate() {
        lost.whole[body] += pair.cell_area() * depth.sum();
        lost.interior[body] += pair.cell_area() * interiors[body].slice(depth).sum();
    }
}
