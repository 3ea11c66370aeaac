//! The laws by which a pass changes the bodies.

use crate::grid::Field;
use crate::motion::contact::Contact;
use crate::motion::pair::Pair;
use crate::motion::path::Position;
use crate::motion::record::LostVolume;
use crate::motion::rim::Interior;
use crate::units::{Metre, Pascal};

/// A law by which the contacts of a pass change the bodies: plastic flow, wear, a film.
///
/// A pass goes through it in two calls. [`Law::add`] reads the contact at each position, in order, and adds what it does to
/// sums over the pass. [`Law::advance`] then changes the bodies by these sums. A law keeps what it needs from one pass to the
/// next in the bodies' [`crate::motion::Body::state`], never in itself: results and resumed runs know the bodies alone, and a
/// pass is tried at several approaches before one of them counts.
pub trait Law: Send + Sync {
    /// The word by which results know the law, in snake case: that of the plastic flow is `plastic`, and its volumes are in
    /// the columns `plastic_volume_lower`, ….
    fn name(&self) -> &str;

    /// Prepares the bodies before their first pass: adds the state that the law keeps of them where it is not there yet.
    fn prepare(&self, pair: &mut Pair) {
        let _ = pair;
    }

    /// Number of fields that the law sums over a pass on each body.
    fn sums(&self) -> usize {
        1
    }

    /// Adds what the contact at one position does to the sums on the lower and on the upper body, which are zero at the
    /// beginning of the pass.
    fn add(&self, pair: &Pair, touching: &Touching, sums: &mut [Vec<Field>; 2]);

    /// Changes the state of the bodies by so many `passes` with these sums, and gives the height that each cell of the lower
    /// and of the upper body loses to the law, m: below 0 where a cell grows. The heights are lowered by the caller.
    fn advance(&self, pair: &mut Pair, sums: &[Vec<Field>; 2], passes: f64) -> [Field; 2];
}

/// The cells in contact at one position.
#[derive(Debug, Clone, Copy)]
#[non_exhaustive]
pub struct Touching<'a> {
    /// The relative position of the bodies.
    pub position: &'a Position,
    /// Flat cells in contact of the lower and of the upper body: those of the same index face each other.
    pub cells: [&'a [u32]; 2],
    /// Pressure on each of these cells, Pa.
    pub pressure: &'a [Pascal],
    /// Plastic interference w of each of these cells, m; 0 where the pressure is below what the cells bear.
    pub interference: &'a [Metre],
    /// Distance over which the bodies slide from this position to the next, m.
    pub sliding_distance: Metre,
}

/// Applies `laws` to a `pair` after contacts on frozen bodies, which slide over a distance from each to the next. Returns what
/// each law took, added to the `lost` so far.
pub(super) fn apply(
    laws: &[Box<dyn Law>],
    pair: &mut Pair,
    contacts: &[Contact],
    sliding_distance: Metre,
    interiors: &[Interior; 2],
    lost: &mut [LostVolume],
) {
    let shapes = [pair.lower.heights.raw_dim(), pair.upper.heights.raw_dim()];
    let zeros = |law: &dyn Law| shapes.map(|shape| vec![Field::zeros(shape); law.sums()]);
    let mut sums: Vec<_> = laws.iter().map(|law| zeros(law.as_ref())).collect();
    for contact in contacts {
        let cells = |body: usize| -> Vec<u32> {
            let of =
                |cell: &(u32, Pascal)| pair.cells_of_bodies(&contact.position, cell.0 as usize)[body] as u32;
            contact.pressure.iter().map(of).collect()
        };
        let (lower, upper) = (cells(0), cells(1));
        let pressure: Vec<Pascal> = contact.pressure.iter().map(|(_, p)| *p).collect();
        let touching = Touching {
            position: &contact.position,
            cells: [&lower, &upper],
            pressure: &pressure,
            interference: &contact.interference(),
            sliding_distance,
        };
        laws.iter().zip(&mut sums).for_each(|(law, sums)| law.add(pair, &touching, sums));
    }
    for ((law, sums), lost) in laws.iter().zip(&sums).zip(lost) {
        let depth = law.advance(pair, sums, 1.0);
        remove(pair, &depth, interiors, lost);
    }
}

/// Takes a `depth` off each cell of the lower and of the upper body, m, and adds its volume to what is `lost`.
pub(super) fn remove(pair: &mut Pair, depth: &[Field; 2], interiors: &[Interior; 2], lost: &mut LostVolume) {
    pair.lower.heights -= &depth[0];
    pair.upper.heights += &depth[1];
    for (body, depth) in depth.iter().enumerate() {
        lost.whole[body] += pair.cell_area() * depth.sum();
        lost.interior[body] += pair.cell_area() * interiors[body].of(depth).sum();
    }
}
