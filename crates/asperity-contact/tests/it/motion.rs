//! Physics of the motion: conditions that hold for any two surfaces that pass over each other.
//!
//! Two generated steel surfaces, with 24 or 32 cells per side, whose highest contacts yield.

use asperity_base::error::LoadLimit;
use asperity_base::{Error, Field, Grid};
use asperity_contact::material::Material;
use asperity_contact::motion::{
    LoadControl, Motion, Output, Pair, PassRecord, PlasticUpdate, Simulation, Step, StepRecord, Strategy,
};
use asperity_contact::operator::Boundary;
use asperity_contact::solver::{Control, Friction, Params};
use asperity_surface::{Amplitude, LowPass, Topography};

use crate::support::{
    Held, Kept, assert_close, at_approach, largest, pass_load, self_affine, steel, step_load,
};
use crate::watch::Patience;

const HARDNESS: f64 = 4e9;
const LOAD: f64 = 20e-3;

// ---- running-in ------------------------------------------------------------------------------------------

#[test]
fn at_a_constant_approach_the_bodies_shake_down_at_once() {
    let motion = motion(at_approach(approach_of(&rough_pair(32), LOAD)), 4);
    let volumes = plastic_volumes(&run(rough_pair(32), motion));
    assert!(volumes[0] > 0.0);
    for pair in volumes.windows(2) {
        assert!(pair[1] < 0.1 * pair[0], "plastic volume per pass {volumes:?}");
    }
}

#[test]
fn at_a_constant_load_the_plastic_volume_decays_while_the_bodies_sink_together() {
    // With plastic deformation at every position, running-in is faster than with the frozen geometry of a
    // pass, which decays by about 0.3.
    for (update, decay) in [(PlasticUpdate::Pass, 0.1..0.5), (PlasticUpdate::Step, 0.02..0.2)] {
        let load = motion(pass_load(10.0 * LOAD), 5).with_plastic_update(update);
        let kept = run(rough_pair(32), load);
        let volumes = plastic_volumes(&kept);
        for pair in volumes.windows(2) {
            assert!(decay.contains(&(pair[1] / pair[0])), "{update:?}: plastic volume per pass {volumes:?}");
        }
        let approach: Vec<f64> = kept.passes.iter().map(|p| p.approach).collect();
        assert!(approach.is_sorted(), "{update:?}: approach {approach:?}");
        let [first, last] = [0, 4].map(|pass| kept.passes[pass].mean_contact_area);
        assert!(last > first, "{update:?}: the bodies conform, area {first:e} → {last:e}");

        let held = load.with_control(Control::Approach(approach[0]));
        let held = plastic_volumes(&run(rough_pair(32), held));
        assert!((held[0] / volumes[0] - 1.0).abs() < 1e-4, "the first pass is the same");
        assert!((1..5).all(|pass| held[pass] < volumes[pass]), "held {held:?}, sinking {volumes:?}");
    }
}

#[test]
fn elastic_bodies_repeat_their_pass_for_ever() {
    let kept = run(elastic_pair(24), motion(at_approach(approach_of(&elastic_pair(24), LOAD)), 2));
    assert_eq!(plastic_volumes(&kept), [0.0, 0.0]);
    let [first, second] = [1, 2].map(|pass| loads_of(&kept, pass));
    assert_close(&first, &second, 1e-5, "loads of the two passes");
    assert_eq!(kept.pairs[1].lower, elastic_pair(24).lower);
    assert_eq!(kept.pairs[1].upper, elastic_pair(24).upper);
}

// ---- balances --------------------------------------------------------------------------------------------

#[test]
fn the_mean_load_is_found_from_a_touch_to_nearly_the_plastic_limit() {
    let limit = pass_limit(24, 24, 1);
    for (share, tolerance) in
        [(1e-9, 1e-4), (1e-6, 1e-2), (1e-3, 1e-7), (0.3, 1e-7), (0.9, 1e-4), (0.99, 1e-4)]
    {
        let load = share * limit;
        let motion = motion(pass_load(load), 1).with_stride(4).with_load_tolerance(tolerance);
        let kept = run(rough_pair(24), motion);
        assert!((kept.passes[0].mean_load / load - 1.0).abs() <= tolerance, "{share:e}");
        assert!(kept.steps.iter().all(|step| step.approach == kept.steps[0].approach), "{share:e}");
    }
}

#[test]
fn the_bodies_lose_what_their_positions_deform_when_each_position_changes_them() {
    for control in [pass_load(LOAD), step_load(0.5 * LOAD)] {
        let motion = motion(control, 2).with_plastic_update(PlasticUpdate::Step);
        let kept = run(rough_pair(24), motion);
        // A load at each position is met to the last digits.
        let is_met = |step: &StepRecord| (step.load / (0.5 * LOAD) - 1.0).abs() < 1e-10;
        assert!(control.1 == LoadControl::Pass || kept.steps.iter().all(is_met));
        let lost = |pass: &PassRecord| pass.lost("plastic")[0] + pass.lost("plastic")[1];
        let first = lost(&kept.passes[0]);
        assert!(first > 0.0);
        // With a load at each position the second pass causes no deformation beyond round-off.
        for pass in &kept.passes {
            let steps: f64 = steps_of(&kept, pass.pass).map(|s| s.plastic_volume).sum();
            assert!((lost(pass) - steps).abs() < 1e-12 * first, "lost {:e}, deformed {steps:e}", lost(pass));
        }
        assert_each_body_lost_what_it_fell(&rough_pair(24), &kept);
    }
}

#[test]
fn a_body_loses_the_fall_of_its_mean_height_times_its_area() {
    let kept = run(rough_pair(24), motion(pass_load(LOAD), 3));
    assert_each_body_lost_what_it_fell(&rough_pair(24), &kept);
    for pass in &kept.passes {
        // A cell keeps the largest of its interferences, not their sum.
        let steps: f64 = steps_of(&kept, pass.pass).map(|s| s.plastic_volume).sum();
        assert!(pass.lost("plastic")[0] + pass.lost("plastic")[1] <= steps * (1.0 + 1e-12));
    }
}

/// Compares columns of records with the fields, with free and with joined ends.
#[test]
fn what_is_told_of_the_interior_is_that_of_the_cells_off_the_free_ends() {
    let slide = Strategy::Shift { speed_lower: 0.0, speed_upper: 1.0 };
    for (strategy, boundary, update) in [
        (Strategy::Overlap, Boundary::FREE, PlasticUpdate::Pass),
        (Strategy::Overlap, Boundary::FREE, PlasticUpdate::Step),
        (slide, Boundary::FREE, PlasticUpdate::Pass),
        (slide, Boundary::PERIODIC, PlasticUpdate::Step),
    ] {
        let motion = motion(pass_load(20.0 * LOAD), 2).with_strategy(strategy).with_plastic_update(update);
        let [kept, whole] = [0.2, 0.0].map(|rim| {
            let simulation = Simulation::new(rough_pair(24), boundary, motion, Params::default()).unwrap();
            continued(simulation.with_rim(rim).unwrap())
        });
        // Those of the 24 cells with centres farther than 4.8 cells from an end.
        let interior = |field: &Field, columns: bool| {
            let (inside, all) = (5..19, 0..24);
            let x = if columns { inside.clone() } else { all.clone() };
            let y = if boundary == Boundary::FREE { inside } else { all };
            field.slice(ndarray::s![x, y]).to_owned()
        };
        let ends =
            [strategy == Strategy::Overlap || boundary == Boundary::FREE, strategy == Strategy::Overlap];
        let (mut before, mut lost_inside) = (rough_pair(24), 0.0);
        for (pass, after) in kept.passes.iter().zip(&kept.pairs) {
            let told = [
                [pass.lost_inside("plastic")[0], pass.sq_lower_interior, pass.lost("plastic")[0]],
                [pass.lost_inside("plastic")[1], pass.sq_upper_interior, pass.lost("plastic")[1]],
            ];
            for (body, [lost, sq, all]) in told.into_iter().enumerate() {
                let [from, to] =
                    [&before, after].map(|pair| [&pair.lower.heights, &pair.upper.heights][body]);
                let fell = interior(&(from - to), ends[body]).sum().abs() * before.cell_area();
                let roundoff = 1e-14 * before.cell_area() * 576.0 * 35e-9;
                assert!(
                    (fell - lost).abs() <= 1e-9 * lost + roundoff,
                    "{strategy:?}: {fell:e}, lost {lost:e}"
                );
                lost_inside += lost;
                assert_close(&[interior(to, ends[body]).std(0.0)], &[sq], 1e-14, "Sq");
                assert!(if boundary == Boundary::PERIODIC { lost == all } else { lost < all });
            }
            before = after.clone();
        }
        assert!(lost_inside > 0.0);
        for (pass, other) in kept.passes.iter().zip(&whole.passes) {
            let area = mean(&steps_of(&kept, pass.pass).map(|s| s.contact_area_interior).collect::<Vec<_>>());
            assert_close(&[area], &[pass.mean_contact_area_interior], 1e-13, "contact area");
            assert_eq!(area < pass.mean_contact_area, boundary == Boundary::FREE);
            let [lost_lower, lost_upper] = other.lost("plastic");
            let told = [
                other.mean_contact_area_interior,
                other.lost_inside("plastic")[0],
                other.lost_inside("plastic")[1],
                other.sq_lower_interior,
            ];
            assert_eq!(told, [other.mean_contact_area, lost_lower, lost_upper, other.sq_lower]);
        }
        assert!(whole.steps.iter().all(|s| s.plastic_volume_interior == s.plastic_volume));
    }
    for rim in [0.5, -0.1, f64::NAN] {
        let simulation =
            Simulation::new(rough_pair(24), Boundary::FREE, motion(pass_load(LOAD), 1), Params::default());
        let Err(error) = simulation.unwrap().with_rim(rim) else { panic!("a rim of {rim}") };
        assert!(error.to_string().starts_with("rim is"), "{error}");
    }
}

#[test]
fn the_mean_pressure_is_the_mean_load_over_the_mean_area_that_faces() {
    let pass = &run(rough_pair(24), motion(pass_load(LOAD), 1)).passes[0];
    // 47 positions of 24 columns: 24²/47 columns overlap on average.
    let area = 24.0 * 24.0 / 47.0 * rough_pair(24).grid(1).area();
    assert_close(&[pass.mean_pressure], &[pass.mean_load / area], 1e-12, "mean pressure");
}

#[test]
fn the_harder_body_loses_nothing() {
    let [soft, hard] = [2e9, 7e9].map(steel);
    for update in [PlasticUpdate::Pass, PlasticUpdate::Step] {
        for (materials, harder) in [([&soft, &hard], 1), ([&hard, &soft], 0)] {
            let motion = motion(pass_load(LOAD), 2).with_plastic_update(update);
            let initial = Pair::new(surface([24, 24], 1), surface([24, 24], 2), materials).unwrap();
            let kept = run(initial.clone(), motion);
            for pass in &kept.passes {
                let lost = [pass.lost("plastic")[0], pass.lost("plastic")[1]];
                assert!(lost[harder] == 0.0 && lost[1 - harder] > 0.0, "{update:?}: {lost:?}");
                assert!(pass.max_pressure <= 2e9);
            }
            let after = kept.last();
            let same = [after.lower == initial.lower, after.upper == initial.upper];
            assert!(same[harder] && !same[1 - harder]);
        }
    }
}

#[test]
fn the_mean_pressures_of_both_bodies_carry_the_loads() {
    let shift = Strategy::Shift { speed_lower: 1.0, speed_upper: -0.5 };
    for strategy in [Strategy::Overlap, shift] {
        let motion = motion(pass_load(LOAD), 2).with_strategy(strategy);
        let initial = rough_pair(24);
        let kept = run(initial.clone(), motion);
        for (pass, means) in kept.passes.iter().zip(&kept.mean_pressure) {
            let loads = loads_of(&kept, pass.pass);
            for mean in means {
                let carried = initial.cell_area() * loads.len() as f64 * mean.sum();
                assert!(
                    (carried / loads.iter().sum::<f64>() - 1.0).abs() < 1e-12,
                    "{strategy:?}: {carried:e}"
                );
            }
        }
    }
}

#[test]
fn no_pressure_exceeds_the_hardness_and_every_position_is_in_equilibrium() {
    let kept = run(rough_pair(32), motion(pass_load(LOAD), 3));
    for step in &kept.steps {
        assert!(step.max_pressure <= HARDNESS && step.residual < 1e-6, "{step:?}");
        assert_eq!(step.plastic_cells > 0, step.max_pressure == HARDNESS);
        assert!(step.load >= 0.0 && step.contact_area * HARDNESS >= step.load * (1.0 - 1e-12));
    }
}

// ---- positions -------------------------------------------------------------------------------------------

#[test]
fn overlap_and_shift_are_one_where_all_faces_all() {
    let approach = at_approach(approach_of(&rough_pair(24), LOAD));
    let overlap = run(rough_pair(24), motion(approach, 1));
    let sliding = Strategy::Shift { speed_lower: 0.0, speed_upper: 1.0 };
    let shift = run(rough_pair(24), motion(approach, 1).with_strategy(sliding));
    let flush = overlap.steps.iter().find(|s| s.offset == 0.0).unwrap();
    assert_eq!(flush.overlap_columns, 24);
    let first = &shift.steps[0];
    assert_eq!((flush.load, flush.contact_area), (first.load, first.contact_area));
}

#[test]
fn rolling_at_equal_speeds_keeps_the_load_of_a_periodic_contact() {
    let loads = periodic_loads(Strategy::Shift { speed_lower: 1.0, speed_upper: 1.0 });
    let first = vec![loads[0]; loads.len()];
    assert_eq!(loads.len(), 32);
    assert_close(&loads, &first, 1e-5, "rolling");
}

#[test]
fn only_the_offset_of_two_periodic_surfaces_counts() {
    let upper = periodic_loads(Strategy::Shift { speed_lower: 0.0, speed_upper: 1.0 });
    let lower = periodic_loads(Strategy::Shift { speed_lower: -3.0, speed_upper: 0.0 });
    assert!(deviation(&upper) > 0.02, "the load changes over the pass: {upper:?}");
    assert_close(&lower, &upper, 1e-5, "either surface may move");
    // Both move by half a period against each other: a whole period, at twice the speed.
    let both = periodic_loads(Strategy::Shift { speed_lower: -1.0, speed_upper: 1.0 });
    let twice: Vec<f64> = (0..32).map(|k| upper[2 * k % 32]).collect();
    assert_close(&both, &twice, 1e-5, "a period later the load is the first again");
}

#[test]
fn a_mirrored_pair_meets_the_same_loads_in_reverse() {
    let mirrored = |z: &Field| z.slice(ndarray::s![..;-1, ..]).to_owned();
    let forth = rough_pair(24);
    let mut back = forth.clone();
    (back.lower.heights, back.upper.heights) =
        (mirrored(&forth.lower.heights), mirrored(&forth.upper.heights));
    let control = pass_load(LOAD);
    let (forth, back) = (run(forth, motion(control, 2)), run(back, motion(control, 2)));
    for pass in [1, 2] {
        let reversed: Vec<f64> = loads_of(&back, pass).into_iter().rev().collect();
        assert_close(&reversed, &loads_of(&forth, pass), 1e-4, "loads");
        assert_close(&[back.passes[pass - 1].approach], &[forth.passes[pass - 1].approach], 1e-4, "approach");
        let heights = mirrored(&back.pairs[pass - 1].lower.heights);
        let difference = largest(&(&heights - &forth.pairs[pass - 1].lower.heights));
        assert!(difference < 1e-4 * 35e-9, "surfaces differ by {difference:e} m");
    }
}

#[test]
fn exchanging_the_bodies_exchanges_their_losses() {
    // Upside down: z₁ ↔ −z₂, and the body enters from the right instead of the left.
    let forth = rough_pair(24);
    let mut over = forth.clone();
    (over.lower.heights, over.upper.heights) = (-&forth.upper.heights, -&forth.lower.heights);
    let control = pass_load(LOAD);
    let (forth, over) = (run(forth, motion(control, 2)), run(over, motion(control, 2)));
    for pass in [1, 2] {
        let reversed: Vec<f64> = loads_of(&over, pass).into_iter().rev().collect();
        assert_close(&reversed, &loads_of(&forth, pass), 1e-4, "loads");
        let lost = |kept: &Kept| {
            let pass = &kept.passes[pass - 1];
            [pass.lost("plastic")[0], pass.lost("plastic")[1]]
        };
        let [lower, upper] = lost(&forth);
        assert_close(&lost(&over), &[upper, lower], 1e-3, "volumes lost");
    }
}

#[test]
fn bodies_of_different_lengths_pass_in_strides_that_do_not_divide_them() {
    for (lower, upper, stride) in [(20, 33, 3), (33, 20, 7), (24, 5, 40), (7, 24, 1)] {
        let pair = steel_pair(surface([lower, 16], 1), surface([upper, 16], 2));
        let load = 5e-2 * HARDNESS * PITCH * PITCH * 16.0 * lower.min(upper) as f64;
        for update in [PlasticUpdate::Pass, PlasticUpdate::Step] {
            let motion = motion(pass_load(load), 2).with_stride(stride).with_plastic_update(update);
            let kept = run(pair.clone(), motion);
            let offsets: Vec<isize> =
                steps_of(&kept, 1).map(|s| (s.offset / PITCH).round() as isize).collect();
            let expected: Vec<isize> =
                (1 - upper as isize..lower as isize).filter(|offset| offset % stride as isize == 0).collect();
            assert_eq!(offsets, expected, "{lower}, {upper}, {stride}");
            assert!(kept.passes.iter().all(|p| (p.mean_load / load - 1.0).abs() <= 1e-4));
            assert_each_body_lost_what_it_fell(&pair, &kept);
        }
    }
}

// ---- the course of a computation -------------------------------------------------------------------------

/// Motions of every kind, with three passes that yield.
fn motions_of_every_kind() -> Vec<(Boundary, Motion)> {
    let slides = Friction::coulomb(0.3).unwrap();
    let grows = slides.with_junction_growth(9.0);
    let shift = Strategy::Shift { speed_lower: -0.5, speed_upper: 1.0 };
    let mut motions = Vec::new();
    for (strategy, boundary) in
        [(Strategy::Overlap, Boundary::FREE), (shift, Boundary::FREE), (shift, Boundary::PERIODIC)]
    {
        for control in [pass_load(5.0 * LOAD), step_load(0.8 * LOAD), at_approach(40e-9)] {
            for plastic_update in [PlasticUpdate::Pass, PlasticUpdate::Step] {
                for friction in [None, Some(slides), Some(grows)] {
                    let kind = motion(control, 3)
                        .with_strategy(strategy)
                        .with_plastic_update(plastic_update)
                        .with_friction(friction)
                        .with_stride(3);
                    motions.push((boundary, kind));
                }
            }
        }
    }
    motions
}

#[test]
fn a_resumed_motion_goes_on_with_the_same_bits() {
    for (index, (boundary, motion)) in motions_of_every_kind().into_iter().enumerate() {
        // Every other pair has dissimilar bodies, which shear displaces normally.
        let pair = if index % 2 == 0 { rough_pair(16) } else { dissimilar_pair(16) };
        let simulation = |pair: &Pair, passes: usize| {
            Simulation::new(pair.clone(), boundary, motion.with_passes(passes), Params::default())
                .unwrap_or_else(|error| panic!("{error}: {motion:?}"))
        };
        let whole = continued(simulation(&pair, 3));
        let mut parts = continued(simulation(&pair, 1));
        let pool = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
        for passes in [2, 3] {
            let (done, last) = (parts.passes.len(), parts.last());
            let mut left = pair.clone();
            (left.lower.heights, left.upper.heights) =
                (last.lower.heights.clone(), last.upper.heights.clone());
            let warm = parts.warm_starts.last().unwrap().clone();
            let mut next = simulation(&left, passes).resumed(done, warm);
            pool.install(|| next.run(&(), &mut [&mut parts])).unwrap();
        }
        assert!(plastic_volumes(&whole)[0] > 0.0, "{motion:?}");
        assert_same_bits(&parts, &whole, &format!("{boundary:?} {motion:?}"));
    }
}

#[test]
fn an_interrupted_motion_keeps_its_finished_passes_and_goes_on_with_the_same_bits() {
    for (control, positions) in [(step_load(0.5 * LOAD), 60), (pass_load(LOAD), 200)] {
        for update in [PlasticUpdate::Pass, PlasticUpdate::Step] {
            let motion = motion(control, 3).with_plastic_update(update);
            let whole = run(rough_pair(24), motion);
            let mut kept = Kept::default();
            let mut simulation =
                Simulation::new(rough_pair(24), Boundary::FREE, motion, Params::default()).unwrap();
            // A pass has 47 positions, and several trials if its load is prescribed.
            let mut interrupted = 0;
            while kept.passes.len() < 3 {
                let watch = Patience::positions(positions + 300 * interrupted);
                let before = kept.passes.len();
                let ended = simulation.run(&watch, &mut [&mut kept]);
                assert!(matches!(ended, Err(Error::Interrupted)) || kept.passes.len() == 3, "{ended:?}");
                assert_eq!(kept.steps.len(), 47 * kept.passes.len());
                if let Some(pair) = kept.pairs.last() {
                    assert_eq!(simulation.pair().lower, pair.lower, "the unfinished pass leaves no trace");
                }
                interrupted += usize::from(kept.passes.len() == before);
            }
            assert_same_bits(&kept, &whole, &format!("{motion:?}"));
        }
    }
}

#[test]
fn an_output_that_fails_ends_the_motion() {
    struct Full;
    impl Output for Full {
        fn step(&mut self, _: &Step<'_>) -> asperity_base::Result<()> {
            Err(Error::Unsupported("no space left"))
        }
    }
    let motion = motion(step_load(0.2 * LOAD), 3).with_stride(8);
    let mut simulation = Simulation::new(rough_pair(24), Boundary::FREE, motion, Params::default()).unwrap();
    assert!(matches!(simulation.run(&(), &mut [&mut Full]), Err(Error::Unsupported("no space left"))));
}

// ---- loads without an approach ---------------------------------------------------------------------------

#[test]
fn bodies_that_yield_at_each_position_bear_so_much_and_no_more() {
    let step = motion(pass_load(1.0), 1).with_plastic_update(PlasticUpdate::Step);
    // The lower body takes all of the plastic deformation.
    let [soft, hard] = [1.0, 2.0].map(|times| steel(times * HARDNESS));
    let pair = || Pair::new(surface([24, 24], 1), surface([24, 24], 2), [&soft, &hard]).unwrap();
    let limit = pass_limit(24, 24, 1);
    let tried = |load: f64| {
        let motion = step.with_control(Control::Load(load)).with_load_control(LoadControl::Pass);
        let mut kept = Kept::default();
        let mut simulation = Simulation::new(pair(), Boundary::FREE, motion, Params::default()).unwrap();
        simulation.run(&(), &mut [&mut kept]).map(|()| kept)
    };
    let Err(Error::BeyondPass { load, most, approach, cause }) = tried(0.9 * limit) else {
        panic!("there is no such approach");
    };
    assert_eq!((load, cause), (0.9 * limit, LoadLimit::Yielded));
    // At any larger approach: a body lowered by more has the same shape, and the same load.
    for far in [1.5, 20.0] {
        let at = step.with_control(Control::Approach(far * approach));
        let bears = run(pair(), at).passes[0].mean_load;
        assert!((bears / most - 1.0).abs() < 1e-5, "{bears:e} N and {most:e} N");
    }
    for share in [0.5, 0.9, 0.99] {
        let kept = tried(share * most).unwrap();
        assert!((kept.passes[0].mean_load / (share * most) - 1.0).abs() <= 1e-4, "{share}");
        assert!(kept.passes[0].approach < approach);
    }
    // Bodies that yield after the pass can carry it.
    let after = step
        .with_plastic_update(PlasticUpdate::Pass)
        .with_control(Control::Load(0.9 * limit))
        .with_load_control(LoadControl::Pass);
    assert!((run(pair(), after).passes[0].mean_load / (0.9 * limit) - 1.0).abs() <= 1e-4);
}

#[test]
fn periodic_bodies_share_a_load_up_to_full_contact() {
    let sliding = Strategy::Shift { speed_lower: 0.0, speed_upper: 1.0 };
    let tried = |load: f64| {
        let motion = motion(pass_load(load), 1).with_strategy(sliding).with_stride(4);
        let mut kept = Kept::default();
        let mut simulation =
            Simulation::new(periodic_pair(), Boundary::PERIODIC, motion, Params::default()).unwrap();
        simulation.run(&(), &mut [&mut kept]).map(|()| kept)
    };
    let Err(Error::BeyondPass { most, approach, cause: LoadLimit::FullContact, .. }) = tried(100.0) else {
        panic!("how the positions share it is not determined");
    };
    let pair = periodic_pair();
    let mean_gap = pair.upper.heights.mean().unwrap() - pair.lower.heights.mean().unwrap();
    assert!((approach - mean_gap).abs() < 1e-5 * 50e-9, "{approach:e} {mean_gap:e}");
    let apparent = pair.lower_grid().area();
    let mut areas = Vec::new();
    for share in [0.3, 0.8, 0.95, 0.99] {
        let kept = tried(share * most).unwrap_or_else(|error| panic!("{share}: {error}"));
        assert!((kept.passes[0].mean_load / (share * most) - 1.0).abs() <= 1e-4, "{share}");
        assert!(kept.passes[0].approach < approach);
        areas.push(kept.passes[0].mean_contact_area / apparent);
    }
    assert!(areas.is_sorted() && areas[3] > 0.95 && areas[3] < 1.0, "{areas:?}");
}

// ---- what cannot be computed -----------------------------------------------------------------------------

#[test]
fn a_load_beyond_the_plastic_limit_is_refused_with_the_limit() {
    // 24² cells over 47 positions are 12.26 columns in the mean; the shortest overlap has one.
    let limits = [
        (Strategy::Overlap, pass_load as fn(f64) -> Held, 576.0 / 47.0),
        (Strategy::Overlap, step_load, 1.0),
        (Strategy::Shift { speed_lower: 0.0, speed_upper: 1.0 }, pass_load, 24.0),
        (Strategy::Shift { speed_lower: 0.0, speed_upper: 1.0 }, step_load, 24.0),
    ];
    for (strategy, control, columns) in limits {
        let expected = HARDNESS * PITCH * PITCH * 24.0 * columns;
        let simulation = |load: f64| {
            let motion = motion(control(load), 1).with_strategy(strategy);
            Simulation::new(rough_pair(24), Boundary::FREE, motion, Params::default())
        };
        match simulation(1.001 * expected).map(|_| ()) {
            Err(Error::BeyondPlasticLimit { load, limit }) => {
                assert_close(&[load, limit], &[1.001 * expected, expected], 1e-12, "load and limit");
            }
            other => panic!("{other:?}"),
        }
        assert!(simulation(0.999 * expected).is_ok());
    }
}

#[test]
fn a_motion_without_meaning_is_refused() {
    let good = motion(pass_load(LOAD), 1);
    let refused = |motion: Motion, boundary: Boundary, pair: Pair| {
        Simulation::new(pair, boundary, motion, Params::default()).map(|_| ()).unwrap_err().to_string()
    };
    let free = |motion| refused(motion, Boundary::FREE, rough_pair(24));
    assert!(free(good.with_passes(0)).starts_with("passes is 0"));
    assert!(free(good.with_stride(0)).starts_with("stride is 0"));
    assert!(free(good.with_load_tolerance(0.0)).starts_with("load_tolerance is 0"));
    for load in [0.0, -1.0, f64::NAN, f64::INFINITY] {
        assert!(
            free(good.with_control(Control::Load(load)).with_load_control(LoadControl::Pass))
                .starts_with("load is "),
            "{load}"
        );
        assert!(
            free(good.with_control(Control::Load(load)).with_load_control(LoadControl::Step))
                .starts_with("load is "),
            "{load}"
        );
    }
    assert!(free(good.with_control(Control::Approach(f64::NAN))).starts_with("approach is NaN"));
    let still = Strategy::Shift { speed_lower: 0.0, speed_upper: 0.0 };
    assert!(free(good.with_strategy(still)).starts_with("speed is 0"));
    let periodic = refused(good, Boundary::PERIODIC, rough_pair(24));
    assert!(periodic.contains("a boundary that is free along x"), "{periodic}");
    let sliding = Strategy::Shift { speed_lower: 0.0, speed_upper: 1.0 };
    let unequal = steel_pair(surface([24, 24], 1), surface([20, 24], 2));
    let unequal = refused(good.with_strategy(sliding), Boundary::FREE, unequal);
    assert!(unequal.contains("24 cells along x and 20 cells along x differ"), "{unequal}");
}

#[test]
fn an_approach_that_closes_a_periodic_gap_is_refused_during_the_pass() {
    let sliding = Strategy::Shift { speed_lower: 0.0, speed_upper: 1.0 };
    let motion = motion(at_approach(1e-6), 1).with_strategy(sliding);
    let mut simulation =
        Simulation::new(periodic_pair(), Boundary::PERIODIC, motion, Params::default()).unwrap();
    let ended = simulation.run(&(), &mut []);
    match ended {
        Err(Error::AtPosition { pass: 1, position, positions: 32, source }) => {
            assert!(position >= 1 && matches!(*source, Error::PeriodicFullContact { .. }), "{source:?}");
        }
        other => panic!("{other:?}"),
    }
}

// ---- helpers ---------------------------------------------------------------------------------------------

const PITCH: f64 = 1e-6;

fn surface(shape: [usize; 2], seed: u64) -> Topography {
    let grid = Grid::new(shape, [PITCH, PITCH]).unwrap();
    let cutoff = 8e-6_f64.min(shape[0] as f64 * PITCH);
    LowPass::new(35e-9, [cutoff, 8e-6]).generate(&grid, seed).unwrap()
}

fn steel_pair(lower: Topography, upper: Topography) -> Pair {
    Pair::new(lower, upper, [&steel(HARDNESS); 2]).unwrap()
}

fn rough_pair(cells: usize) -> Pair {
    steel_pair(surface([cells, cells], 1), surface([cells, cells], 2))
}

/// A compliant body on a stiff one, so that shear displaces the surfaces normally; both yield earlier than
/// steel.
fn dissimilar_pair(cells: usize) -> Pair {
    let [soft, hard] = [70e9, 210e9].map(|young| Material::new(young, 0.3, 0.4 * HARDNESS).unwrap());
    Pair::new(surface([cells, cells], 1), surface([cells, cells], 2), [&soft, &hard]).unwrap()
}

fn elastic_pair(cells: usize) -> Pair {
    Pair::new(surface([cells, cells], 1), surface([cells, cells], 2), [&steel(f64::INFINITY); 2]).unwrap()
}

/// Two elastic periodic surfaces.
fn periodic_pair() -> Pair {
    let grid = Grid::new([32, 32], [PITCH, PITCH]).unwrap();
    let [lower, upper] = [1, 2].map(|seed| self_affine(&grid, Amplitude::Sq(35e-9), Some(6e-6), seed));
    Pair::new(lower, upper, [&steel(f64::INFINITY); 2]).unwrap()
}

/// Loads over a pass of the periodic pair, at an approach with about a tenth of it in contact.
fn periodic_loads(strategy: Strategy) -> Vec<f64> {
    let motion = motion(at_approach(-70e-9), 1).with_strategy(strategy);
    let params = Params::default().with_tolerance(1e-8);
    let simulation = Simulation::new(periodic_pair(), Boundary::PERIODIC, motion, params).unwrap();
    let loads = loads_of(&continued(simulation), 1);
    assert!(loads[0] > 0.0);
    loads
}

fn motion((control, load_control): Held, passes: usize) -> Motion {
    Motion::new(Strategy::Overlap, control)
        .with_passes(passes)
        .with_stride(1)
        .with_load_control(load_control)
        .with_plastic_update(PlasticUpdate::Pass)
        .with_load_tolerance(1e-4)
        .with_friction(None)
}

/// Returns the approach of a first pass with the mean load `load`.
fn approach_of(pair: &Pair, load: f64) -> f64 {
    run(pair.clone(), motion(pass_load(load), 1)).passes[0].approach
}

/// Returns the plastic limit of the mean load of a pass over two bodies with this number of columns.
fn pass_limit(columns: usize, width: usize, stride: usize) -> f64 {
    let columns = columns as f64 * columns as f64 / ((2 * columns - 1) as f64 / stride as f64);
    HARDNESS * PITCH * PITCH * width as f64 * columns
}

/// Records of the positions of a pass.
fn steps_of(kept: &Kept, pass: usize) -> impl Iterator<Item = &StepRecord> {
    kept.steps.iter().filter(move |step| step.pass == pass)
}

fn loads_of(kept: &Kept, pass: usize) -> Vec<f64> {
    steps_of(kept, pass).map(|step| step.load).collect()
}

fn run(pair: Pair, motion: Motion) -> Kept {
    continued(Simulation::new(pair, Boundary::FREE, motion, Params::default()).unwrap())
}

fn continued(simulation: Simulation) -> Kept {
    let kept = Kept::run(simulation);
    let loads: Vec<f64> = kept.contacts.iter().flatten().map(|contact| contact.load).collect();
    assert_eq!(loads, kept.steps.iter().map(|step| step.load).collect::<Vec<_>>());
    for pass in &kept.passes {
        let approach: Vec<f64> = steps_of(&kept, pass.pass).map(|step| step.approach).collect();
        assert!((pass.mean_load / mean(&loads_of(&kept, pass.pass)) - 1.0).abs() < 1e-14);
        assert!((pass.approach / mean(&approach) - 1.0).abs() < 1e-12);
    }
    kept
}

fn plastic_volumes(kept: &Kept) -> Vec<f64> {
    kept.passes.iter().map(|p| p.lost("plastic")[0] + p.lost("plastic")[1]).collect()
}

/// Returns the records without times.
fn untimed(passes: &[PassRecord]) -> Vec<PassRecord> {
    let mut passes = passes.to_vec();
    passes.iter_mut().for_each(|pass| pass.wall_time_s = 0.0);
    passes
}

#[track_caller]
fn assert_same_bits(found: &Kept, expected: &Kept, what: &str) {
    assert_eq!(untimed(&found.passes), untimed(&expected.passes), "{what}");
    assert_eq!(found.steps, expected.steps, "{what}");
    assert_eq!(found.mean_pressure, expected.mean_pressure, "{what}");
    assert_eq!(found.warm_starts, expected.warm_starts, "{what}");
    let heights = |kept: &Kept| -> Vec<u64> {
        kept.pairs
            .iter()
            .flat_map(|pair| pair.lower.heights.iter().chain(&pair.upper.heights))
            .map(|z| z.to_bits())
            .collect()
    };
    assert!(heights(found) == heights(expected), "{what}");
}

fn mean(values: &[f64]) -> f64 {
    values.iter().sum::<f64>() / values.len() as f64
}

/// Rms deviation from the mean, relative to it.
fn deviation(values: &[f64]) -> f64 {
    let mean = mean(values);
    (values.iter().map(|v| (v / mean - 1.0).powi(2)).sum::<f64>() / values.len() as f64).sqrt()
}

#[track_caller]
fn assert_each_body_lost_what_it_fell(initial: &Pair, kept: &Kept) {
    let area = initial.cell_area();
    // Round-off of the sums of heights.
    let roundoff = 1e-14 * area * initial.lower.heights.len() as f64 * 35e-9;
    let mut before = initial;
    for (pass, after) in kept.passes.iter().zip(&kept.pairs) {
        let fell = [
            (&before.lower.heights - &after.lower.heights).sum() * area,
            (&after.upper.heights - &before.upper.heights).sum() * area,
        ];
        let lost = [pass.lost("plastic")[0], pass.lost("plastic")[1]];
        for (fell, lost) in fell.into_iter().zip(lost) {
            assert!((fell - lost).abs() <= 1e-9 * lost + roundoff, "fell by {fell:e} m³, lost {lost:e} m³");
        }
        before = after;
    }
    assert!(kept.passes[0].lost("plastic")[0] > 0.0 && kept.passes[0].lost("plastic")[1] > 0.0);
}
