//! Bodies that wear where they slip a little.

use super::{Case, Check, Expected, PARAMS, relative, study};
use crate::error::{Error, Result};
use crate::grid::{Field, Grid};
use crate::material::Material;
use crate::motion::{
    Acceleration, ChangedBodies, Changes, Cycles, IncrementRecord, LoadedContact, Pair, Stage, StagedLoading,
};
use crate::operator::Boundary;
use crate::reference::cattaneo::tangential_modulus;
use crate::reference::{CattaneoMindlin, HertzSphere};
use crate::solver::{Control, Friction, Loading, Tangential};
use crate::surface::Form;
use crate::units::{Newton, PerPascal};
use crate::wear::{WEAR, Wear, WearCoefficient};

/// A ball under a force that goes to and fro wears in the annulus that slips, by k/μ times the energy of a
/// cycle.
pub(super) const CYCLE: Case = Case {
    name: "fretting: Q = ±0.8 μW, a cycle of wear",
    source: "V = (k/μ) E, E by Mindlin & Deresiewicz (1953); no wear for r < c",
    checks: cycle,
};

/// Cycles that stand for several have the scar of all of them.
pub(super) const JUMPS: Case = Case {
    name: "fretting: a scar of 64 cycles, some computed",
    source: "the same cycles, each computed",
    checks: jumps,
};

const FRICTION: f64 = 0.6;
const LOAD: Newton = 10.0;

/// A ball of identical elastic bodies, without Poisson's effect: the slip is along the force, as the closed
/// form assumes.
struct Ball {
    contact: CattaneoMindlin,
    pair: Pair,
}

impl Ball {
    /// Creates the contact with `n` cells along its radius, under a `share` of the friction limit.
    fn new(n: usize, share: f64) -> Result<Self> {
        let body = Material::elastic(200e9, 0.0)?;
        let normal = HertzSphere { radius: 5e-3, modulus: 100e9, load: LOAD };
        let contact = CattaneoMindlin {
            normal,
            tangential_modulus: tangential_modulus(&body, &body),
            friction: FRICTION,
            tangential_load: share * FRICTION * LOAD,
        };
        let grid = Grid::new([2 * n + 8; 2], [normal.contact_radius() / n as f64; 2])?;
        let ball = Form::Sphere { radius: normal.radius }.on(&grid)?.underside();
        let pair = Pair::new(Form::Flat.on(&grid)?, ball, [&body, &body])?;
        Ok(Self { contact, pair })
    }

    /// Loads the ball, pushes it, and lets the lower body wear in `cycles` cycles.
    fn fret(
        &self,
        coefficient: PerPascal,
        increments: usize,
        cycles: usize,
        acceleration: Acceleration,
    ) -> Result<LoadedContact> {
        let force = self.contact.tangential_load;
        let to = |force| Loading { normal: Control::Load(LOAD), tangential: Tangential::Force([force, 0.0]) };
        let cycles = Some(Cycles { count: cycles, period: None });
        let stages = vec![
            Stage::new(to(0.0), 1),
            Stage::new(to(force), 1),
            Stage::new(to(-force), increments).with_cycles(cycles),
        ];
        let friction = Some(Friction::coulomb(FRICTION)?);
        let wear = Wear::new([Some(WearCoefficient::archard(coefficient)?), None], [None, None])?;
        StagedLoading::new(self.pair.clone(), Boundary::FREE, friction, stages, PARAMS)?
            .with_changes(Changes::by(wear).with_acceleration(acceleration))
            .run(None, &(), &mut [])
    }
}

fn bodies(contact: &LoadedContact) -> Result<&ChangedBodies> {
    contact.changed.as_ref().ok_or(Error::Unsupported("bodies that do not change"))
}

fn scar(contact: &LoadedContact) -> Result<&Field> {
    let worn = bodies(contact)?.pair.lower.state.get(WEAR);
    worn.map(|state| &state.values).ok_or(Error::Unsupported("a body without wear"))
}

fn cycle() -> Result<Vec<Check>> {
    let checks = [
        ("volume, (k/μ) E", Expected::Order { order: 1.6..=3.1, finest: 2e-3 }),
        ("volume, (k/μ) the dissipation", Expected::RoundOff(1e-6)),
        ("depth for r < c − 1.5 Δx", Expected::RoundOff(1e-9)),
    ];
    study("a/Δx", &[8, 16, 32], checks, |n| {
        /// So little wear that the contact does not change.
        const COEFFICIENT: PerPascal = 1e-22;
        let ball = Ball::new(n, 0.8)?;
        let contact = ball.fret(COEFFICIENT, 2, 1, Acceleration::NONE)?;
        // The push before the cycle wears, too.
        let volume = |record: &IncrementRecord| {
            record.fretting.map_or(f64::NAN, |fretting| fretting.laws.worn_volume_lower)
        };
        let of_cycle = |record: &&IncrementRecord| record.stage == 3;
        let before =
            contact.increments.iter().filter(|record| record.stage < 3).map(volume).fold(0.0, f64::max);
        let worn = contact.increments.last().map_or(f64::NAN, volume) - before;
        let dissipated: f64 =
            contact.increments.iter().filter(of_cycle).map(|record| record.dissipation).sum();
        let by_energy = |energy: f64| relative(worn, COEFFICIENT / FRICTION * energy);
        let grid = ball.pair.lower_grid();
        let scar = scar(&contact)?;
        let deepest = scar.iter().copied().fold(0.0, f64::max);
        let radius = |(i, j): (usize, usize)| {
            let from = |axis: usize, index: usize| grid.centre(axis, index) - 0.5 * grid.extent()[axis];
            from(0, i).hypot(from(1, j))
        };
        let stuck = ball.contact.stick_radius() - 1.5 * grid.pitch[0];
        let within = scar.indexed_iter().filter(|(cell, _)| radius(*cell) < stuck).map(|(_, depth)| *depth);
        Ok([
            by_energy(ball.contact.cycle_loss()),
            by_energy(dissipated),
            within.fold(0.0, f64::max) / deepest,
        ])
    })
}

fn jumps() -> Result<Vec<Check>> {
    const CYCLES: usize = 64;
    /// The scar changes the pressures by some percent.
    const COEFFICIENT: PerPascal = 5e-13;
    let ball = Ball::new(8, 0.8)?;
    let exact = ball.fret(COEFFICIENT, 1, CYCLES, Acceleration::NONE)?;
    let exact = scar(&exact)?.clone();
    let deepest = exact.iter().copied().fold(0.0, f64::max);
    let checks = [("depth", Expected::RoundOff(1e-3))];
    study("cycles computed", &[4, 8, 16], checks, |computed| {
        let acceleration =
            Acceleration::default().with_tolerance(1e9).with_max_wear(1.0).with_max_jump(CYCLES / computed);
        let contact = ball.fret(COEFFICIENT, 1, CYCLES, acceleration)?;
        let most =
            scar(&contact)?.iter().zip(&exact).map(|(one, other)| (one - other).abs()).fold(0.0, f64::max);
        Ok([most / deepest])
    })
}
