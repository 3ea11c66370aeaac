//! Elasto-plastic bodies that lose material, that warm up, and that meet a body with a hardness; laws and
//! heat under plastic deformation at each position.

use asperity_base::{Field, Grid};
use asperity_contact::motion::{
    Changes, Contact, ContactCells, Cycles, Law, LoadControl, LoadedContact, Motion, Pair, PlasticPath,
    PlasticUpdate, Point, Simulation, SlipRegime, Stage, StagedLoading, Strategy, SweepState, YieldingBodies,
    load_in_stages, press_elasto_plastic, sweep_elasto_plastic,
};
use asperity_contact::operator::Boundary;
use asperity_contact::plasticity::{Hardening, J2, Layers, PlasticBody, PlasticParams, Volume};
use asperity_contact::solver::{Control, Friction, Loading, Params, Tangential};
use asperity_contact::temperature::{FlashTemperature, Thermal};
use asperity_surface::{Amplitude, Topography};

use crate::support::{Kept, archard, largest, self_affine, steel};

const PITCH: f64 = 5e-6;
const SHAPE: [usize; 2] = [32, 16];
const LAYER: f64 = 6e-6;
const SLIDES: Strategy = Strategy::Shift { speed_lower: 0.0, speed_upper: 0.5 };
const BULK: [f64; 2] = [373.0, 353.0];

fn flowing(yield_stress: f64) -> PlasticBody {
    let faces: Vec<f64> = (0..=10).map(|face| LAYER * f64::from(face)).collect();
    let grid = Grid::new(SHAPE, [PITCH; 2]).unwrap();
    let volume =
        Volume::new(grid, Layers::between(&faces).unwrap(), Boundary::PERIODIC, &steel(f64::INFINITY));
    PlasticBody::new(volume.unwrap(), J2::new(Hardening::perfect(yield_stress).unwrap()))
}

/// A ball of a radius of 0.5 mm on a flat body.
fn pair([lower, upper]: [f64; 2]) -> Pair {
    let grid = Grid::new(SHAPE, [PITCH; 2]).unwrap();
    let ball = Field::from_shape_fn(SHAPE, |(i, j)| {
        let [x, y] = [i as f64 - 15.5, j as f64 - 7.5].map(|cells| cells * PITCH);
        (x * x + y * y) / 1e-3
    });
    let flat = Topography::new(grid, Field::zeros(SHAPE)).unwrap();
    Pair::new(flat, Topography::new(grid, ball).unwrap(), [&steel(lower), &steel(upper)]).unwrap()
}

fn motion(load: f64, passes: usize) -> Motion {
    Motion::new(SLIDES, Control::Load(load))
        .with_load_control(LoadControl::Step)
        .with_friction(Friction::coulomb(0.1).unwrap())
        .with_passes(passes)
}

fn simulation(pair: Pair, motion: Motion) -> Simulation {
    Simulation::new(pair, Boundary::PERIODIC, motion, Params::default().with_tolerance(1e-9)).unwrap()
}

fn yielding(simulation: Simulation, yield_stress: f64) -> Simulation {
    simulation.with_plastic([Some(flowing(yield_stress)), None], PlasticParams::new()).unwrap()
}

/// Takes the same depth off all of the lower body in each pass.
struct Milling(f64);

impl Law for Milling {
    fn name(&self) -> &str {
        "milled"
    }

    fn add(&self, _: &Pair, _: &ContactCells, _: &mut [Vec<Field>; 2]) {}

    fn uncovers(&self) -> bool {
        true
    }

    fn advance(&self, _: &mut Pair, [lower, upper]: &[Vec<Field>; 2], passes: f64) -> [Field; 2] {
        [Field::from_elem(lower[0].raw_dim(), self.0 * passes), Field::zeros(upper[0].raw_dim())]
    }
}

/// The heights that the lower body would have without plastic strain.
fn undeformed(kept: &Kept, pass: usize) -> Field {
    &kept.pairs[pass].lower.heights + &kept.volumes[pass][0].displacement
}

#[test]
fn the_worn_volume_is_that_of_archard_and_the_strain_stays_with_its_material() {
    const WEAR: f64 = 2e-14;
    let kept = Kept::run(yielding(
        simulation(pair([f64::INFINITY; 2]), motion(4.0, 3))
            .with_changes(Changes::by(archard([WEAR, 0.0])))
            .unwrap(),
        1.5e9,
    ));
    let mut before = Field::zeros(SHAPE);
    for (pass, record) in kept.passes.iter().enumerate() {
        let work = PITCH * kept.force(pass);
        let [worn, _] = record.lost("wear");
        assert!((worn / (WEAR * work) - 1.0).abs() < 1e-12, "{worn:e}");
        let now = undeformed(&kept, pass);
        let fell = PITCH * PITCH * (&before - &now).sum();
        assert!((fell / worn - 1.0).abs() < 1e-6, "{fell:e} {worn:e}");
        assert!(record.plastic.unwrap().plastic_work_lower > 0.0);
        let running = record.running.unwrap();
        assert_eq!((running.represents, running.error_estimate), (1, 0.0));
        assert!((running.friction_work / (0.1 * work) - 1.0).abs() < 1e-12);
        before = now;
    }
    // Little wear changes little.
    let unworn = Kept::run(yielding(simulation(pair([f64::INFINITY; 2]), motion(4.0, 3)), 1.5e9));
    let strain = |kept: &Kept| kept.passes[2].plastic.unwrap().max_plastic_strain_lower;
    let ratio = strain(&kept) / strain(&unworn);
    assert!((ratio - 1.0).abs() < 0.1 && ratio != 1.0, "{ratio}");
}

#[test]
fn milling_a_layer_off_brings_the_strain_up_by_one_and_all_of_them_leave_a_plane() {
    let body = || simulation(pair([f64::INFINITY; 2]), motion(4.0, 1));
    let as_it_was = Kept::run(yielding(body(), 1.5e9));
    let milled = Kept::run(yielding(body().with_changes(Changes::by(Milling(LAYER))).unwrap(), 1.5e9));
    let [was, is] = [&as_it_was, &milled].map(|kept| &kept.volumes[0][0].state);
    assert!(was.accumulated.iter().any(|strain| *strain > 0.0));
    for ((layer, component, ix, iy), now) in is.strain.indexed_iter() {
        let expected = if layer == 9 { 0.0 } else { was.strain[[layer + 1, component, ix, iy]] };
        assert!((now - expected).abs() < 1e-12, "{layer}, {component}: {now:e} {expected:e}");
    }
    assert!((undeformed(&milled, 0) + LAYER).iter().all(|height| height.abs() < 1e-15));
    // The displacement is that of the strain that is left, by its definition.
    let mut alone = flowing(1.5e9);
    alone.restore(is);
    assert!((alone.displacement() - &milled.volumes[0][0].displacement).iter().all(|d| d.abs() < 1e-18));
    let through =
        Kept::run(yielding(body().with_changes(Changes::by(Milling(10.0 * LAYER))).unwrap(), 1.5e9));
    assert!(through.volumes[0][0].state.strain.iter().all(|strain| strain.abs() < 1e-15));
    assert!((&through.pairs[0].lower.heights + 10.0 * LAYER).iter().all(|height| height.abs() < 1e-15));
}

#[test]
fn a_pass_that_removes_too_much_for_its_contacts_is_refused() {
    let worn = yielding(
        simulation(pair([f64::INFINITY; 2]), motion(4.0, 1))
            .with_changes(Changes::by(archard([1e-9, 0.0])))
            .unwrap(),
        1.5e9,
    );
    let error = worn.solve(&()).map(|_| ()).unwrap_err().to_string();
    assert!(error.contains("removes so much from bodies that creep or yield"), "{error}");
}

fn thermal() -> [Thermal; 2] {
    [Thermal::new(46.0, 460.0, 7850.0).unwrap(); 2]
}

/// Temperatures of the cells of contacts, from their shear at a speed, with nothing else from the motion.
fn temperatures(pair: &Pair, contacts: &[Contact]) -> Vec<Vec<f64>> {
    let grids = [&pair.lower_grid(), &pair.upper_grid()];
    let time = PITCH / 0.5;
    let mut flash =
        FlashTemperature::new(grids, thermal(), Boundary::PERIODIC, contacts.len(), time, BULK).unwrap();
    flash.begin();
    let each = contacts.iter().map(|contact| {
        let flux: Vec<f64> = contact.pressure.iter().map(|(_, p)| 0.1 * p * 0.5).collect();
        let [lower, upper] = pair.placements(&contact.position).map(|placement| {
            contact.pressure.iter().map(|(cell, _)| placement.cell(*cell as usize) as u32).collect::<Vec<_>>()
        });
        flash.step_between([&lower, &upper], contact.position.fraction, &flux).unwrap().temperature
    });
    each.collect()
}

#[test]
fn yielding_bodies_have_the_flash_temperature_of_their_own_contacts() {
    let flows = simulation(pair([f64::INFINITY; 2]), motion(4.0, 2))
        .with_changes(Changes::default().with_bulk(BULK).with_heat(thermal(), 1))
        .unwrap();
    let motion = motion(4.0, 2).with_plastic_update(PlasticUpdate::Step);
    let flattens = simulation(pair([2.5e9, f64::INFINITY]), motion)
        .with_changes(Changes::default().with_bulk(BULK).with_heat(thermal(), 1))
        .unwrap();
    for warm in [yielding(flows, 1.5e9), flattens] {
        let kept = Kept::run(warm);
        for (pass, contacts) in kept.contacts.iter().enumerate() {
            let expected = temperatures(&kept.pairs[0], contacts);
            for (index, (contact, expected)) in contacts.iter().zip(expected).enumerate() {
                assert_eq!(contact.temperature.as_ref(), Some(&expected));
                let warmest = expected.iter().copied().fold(0.0, f64::max);
                let heat = kept.steps[pass * contacts.len() + index].heat.unwrap();
                assert_eq!(heat.max_flash_temperature, warmest);
                assert!(warmest > BULK[0]);
            }
        }
    }
}

/// Where nothing yields, positions that could have changed the bodies leave the contacts, the heat and the
/// wear of frozen bodies.
#[test]
fn heat_and_wear_at_each_position_are_those_after_the_pass_where_nothing_changes() {
    let of = |update, wear: f64| {
        let simulation = simulation(pair([60e9, f64::INFINITY]), motion(4.0, 1).with_plastic_update(update));
        Kept::run(
            simulation
                .with_changes(Changes::by(archard([wear, 0.0])).with_bulk(BULK).with_heat(thermal(), 1))
                .unwrap(),
        )
    };
    let [pass, step] = [PlasticUpdate::Pass, PlasticUpdate::Step].map(|update| of(update, 1e-22));
    for (pass, step) in pass.steps.iter().zip(&step.steps) {
        let [pass, step] = [pass, step].map(|step| step.heat.unwrap().max_flash_temperature - BULK[0]);
        assert!((pass / step - 1.0).abs() < 1e-6, "{pass} {step}");
    }
    // The difference of both grows as the square of the wear: each position meets what the ones before it
    // have taken.
    let difference = |wear: f64| {
        let [pass, step] = [PlasticUpdate::Pass, PlasticUpdate::Step].map(|update| of(update, wear));
        let [pass, step] = [&pass, &step].map(|kept| &kept.pairs[0].lower.heights);
        largest(&(pass - step))
    };
    let order = (difference(4e-14) / difference(2e-14)).log2();
    assert!((1.7..2.2).contains(&order), "{order}");
}

#[test]
fn a_hardness_opposite_a_body_that_never_yields_is_that_of_elastic_bodies() {
    let hard = [f64::INFINITY, 2.5e9];
    let elastic = Kept::run(simulation(pair(hard), motion(4.0, 2)));
    let both = Kept::run(yielding(simulation(pair(hard), motion(4.0, 2)), 1e12));
    let [[_, a], [_, b]] = [&elastic, &both].map(|kept| kept.passes[0].lost("plastic"));
    assert!(a > 1e-18 && (a / b - 1.0).abs() < 1e-4, "{a:e} {b:e}");
    let differences = &elastic.pairs[1].upper.heights - &both.pairs[1].upper.heights;
    assert!(differences.iter().all(|difference| difference.abs() < 1e-12));
    assert!(both.volumes[1][0].displacement.iter().all(|r| *r == 0.0));
}

/// Loaded and partly unloaded, as rough bodies with a hardness are in stages.
#[test]
fn in_stages_a_hardness_opposite_a_body_that_never_yields_stays_flattened() {
    let grid = Grid::new(SHAPE, [PITCH; 2]).unwrap();
    let rough = self_affine(&grid, Amplitude::Sq(0.3e-6), Some(4.0 * PITCH), 3);
    let flat = Topography::new(grid, Field::zeros(SHAPE)).unwrap();
    let pair = Pair::new(rough, flat, [&steel(2e9), &steel(f64::INFINITY)]).unwrap();
    let stage = |load: f64, steps: usize| Stage::new(Loading::pressing(Control::Load(load)), steps);
    let stages = vec![stage(12.0, 12), stage(4.0, 4), stage(8.0, 4)];
    let params = Params::default().with_tolerance(1e-9);
    let boundary = Boundary::PERIODIC;
    let elastic = load_in_stages(&pair, boundary, None, &stages, &params, None, &(), &mut []).unwrap();
    let bodies = [None, Some(flowing(1e12))];
    let path = PlasticPath::new(stages);
    let both = press_elasto_plastic(&pair, boundary, None, bodies, &path, &params, &(), &mut []).unwrap();
    let [a, b] = [&elastic.increments, &both.increments];
    assert_eq!((a.len(), b.len()), (20, 20));
    for (a, b) in a.iter().zip(b) {
        assert!(a.plastic_volume > 0.0, "{a:?}");
        assert!((a.plastic_volume / b.plastic_volume - 1.0).abs() < 2e-3, "{a:?} {b:?}");
        assert!((a.contact_area / b.contact_area - 1.0).abs() < 0.02);
    }
    // Unloading leaves the flattening.
    assert!((b[11].plastic_volume - b[15].plastic_volume).abs() < 1e-9 * b[11].plastic_volume);
    let [a, b] = [&elastic.record, &both.record];
    assert!((a.mean_gap / b.mean_gap - 1.0).abs() < 1e-3, "{:e} {:e}", a.mean_gap, b.mean_gap);
    assert!((a.plastic_volume / b.plastic_volume - 1.0).abs() < 2e-3);
}

/// Each point presses virgin bodies, in as many steps as a single load.
#[test]
fn a_point_of_a_sweep_is_the_contact_of_its_load_alone() {
    let pair = pair([f64::INFINITY; 2]);
    let params = Params::default();
    let virgin = || Ok([Some(flowing(1.5e9)), None]);
    let bodies = YieldingBodies { virgin: &virgin, increments: 6, plastic: PlasticParams::new() };
    let loads = [0.2, 8.0, 3.0];
    let points = loads.map(|load| Point {
        control: Control::Load(load),
        regime: SlipRegime::Frictionless,
        speed: None,
    });
    let boundary = Boundary::PERIODIC;
    let sweep = |under_way| {
        sweep_elasto_plastic(&pair, boundary, &points, bodies, &params, under_way, &(), &mut []).unwrap()
    };
    let (records, last) = sweep(SweepState::default());
    for (load, record) in loads.into_iter().zip(&records) {
        let path = PlasticPath::new(vec![Stage::new(Loading::pressing(Control::Load(load)), 6)]);
        let alone =
            press_elasto_plastic(&pair, boundary, None, virgin().unwrap(), &path, &params, &(), &mut []);
        let alone = alone.unwrap();
        let plastic = alone.record.plastic.unwrap();
        let flow = record.plastic.unwrap();
        assert_eq!(
            (record.approach, record.contact_area),
            (alone.record.approach, alone.record.contact_area)
        );
        assert_eq!(flow.max_plastic_strain, plastic.max_plastic_strain);
        assert_eq!((flow.plastic_work, flow.products), (plastic.plastic_work, plastic.products));
        // Below first yield, 1.6 σ_Y by Hertz, nothing flows.
        assert_eq!(flow.max_plastic_strain > 0.0, load > 1.0, "{load}: {flow:?}");
    }
    assert_eq!(
        last.plastic_result.unwrap().volumes[0].max_strain.0,
        records[2].plastic.unwrap().max_plastic_strain
    );
    // A sweep that was interrupted after two points goes on to the same bits.
    let done = SweepState { records: records[..2].to_vec(), ..SweepState::default() };
    assert_eq!(sweep(done).0, records);
}

/// A ball pressed on a flat body and pushed to and fro in cycles, with wear of the flat one.
fn fretted(yield_stress: Option<f64>, wear: f64, cycles: usize) -> LoadedContact {
    let pair = pair([f64::INFINITY; 2]);
    let stage = |way: f64, steps: usize| {
        let tangential = Tangential::Displacement([way, 0.0]);
        Stage::new(Loading { normal: Control::Load(4.0), tangential }, steps)
    };
    let cycling = stage(-0.4e-6, 3).with_cycles(Some(Cycles { count: cycles, period: None }));
    let friction = Friction::coulomb(0.3).unwrap();
    let params = Params::default().with_tolerance(1e-9);
    let stages = vec![stage(0.0, 6), stage(0.4e-6, 3), cycling];
    let loading = StagedLoading::new(pair, Boundary::PERIODIC, Some(friction), stages, params).unwrap();
    let loading = match yield_stress {
        None => loading,
        Some(stress) => {
            loading.with_plastic([Some(flowing(stress)), None], PlasticParams::new(), Some(3)).unwrap()
        }
    };
    loading.with_changes(Changes::by(archard([wear, 0.0]))).run(None, &(), &mut []).unwrap()
}

#[test]
fn bodies_that_never_yield_fret_as_elastic_ones() {
    let [elastic, yielding] = [None, Some(1e12)].map(|stress| fretted(stress, 1e-13, 4));
    let (a, b) = (&elastic.increments, &yielding.increments);
    // The increments of the unloading come at the end.
    assert_eq!(b.len(), a.len() + 3);
    for (a, b) in a.iter().zip(b) {
        assert!((a.approach / b.approach - 1.0).abs() < 1e-6, "{a:?} {b:?}");
        assert!(
            (a.dissipation - b.dissipation).abs() < 1e-6 * elastic.record.shear.as_ref().unwrap().dissipation
        );
        assert_eq!(a.fretting.unwrap().cycles, b.fretting.unwrap().cycles);
    }
    let [a, b] =
        [&elastic, &yielding].map(|contact| contact.changed.as_ref().unwrap().pair.lower.heights.clone());
    let deepest = a.iter().fold(0.0_f64, |most, height| most.max(-height));
    let difference = largest(&(&a - &b));
    assert!(deepest > 1e-10 && difference < 1e-5 * deepest, "{difference:e} of {deepest:e}");
    let [a, b] = [&elastic.record, &yielding.record];
    assert!((a.mean_gap / b.mean_gap - 1.0).abs() < 1e-6 && a.contact_area == b.contact_area);
}

/// Each cycle wears off k/μ times the energy that friction takes in it, while the strain below stays with its
/// material.
#[test]
fn yielding_bodies_fret_off_what_their_friction_takes() {
    let worn = fretted(Some(1.5e9), 1e-15, 3);
    let flow = worn.record.plastic.as_ref().unwrap();
    assert!(flow.max_plastic_strain > 1e-3 && flow.residual.is_some());
    let last = worn.increments[worn.increments.len() - 4].fretting.unwrap();
    let pair = &worn.changed.as_ref().unwrap().pair;
    let volume = -PITCH * PITCH * pair.lower.heights.sum();
    assert!((volume * 0.3 / (1e-15 * last.friction_work) - 1.0).abs() < 1e-4, "{volume:e} {last:?}");
    let volumes = &worn.plastic_result.as_ref().unwrap().volumes[0];
    assert!(volumes.state.accumulated.iter().any(|strain| *strain > 0.0));
}
