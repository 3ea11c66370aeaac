//! What a solve takes of the memory: counted by an allocator of its own, so these tests run one after another.

use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

use asperity::operator::{FreeFft, Operator, PeriodicFft};
use asperity::solver::{Bounds, Control, Method, Params, Solution, solve_normal};
use asperity::surface::{Amplitude, SelfAffine};
use asperity::{Field, Grid};

struct Counting;

static HELD: AtomicUsize = AtomicUsize::new(0);
static PEAK: AtomicUsize = AtomicUsize::new(0);
static CALLS: AtomicUsize = AtomicUsize::new(0);

#[expect(unsafe_code, reason = "an allocator is unsafe; this one hands everything on to the system's")]
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        CALLS.fetch_add(1, Relaxed);
        PEAK.fetch_max(HELD.fetch_add(layout.size(), Relaxed) + layout.size(), Relaxed);
        unsafe { System.alloc(layout) }
    }

    unsafe fn dealloc(&self, memory: *mut u8, layout: Layout) {
        HELD.fetch_sub(layout.size(), Relaxed);
        unsafe { System.dealloc(memory, layout) }
    }
}

#[global_allocator]
static ALLOCATOR: Counting = Counting;

/// Held by the test that counts.
static ONE_AT_A_TIME: Mutex<()> = Mutex::new(());

const SIDE: usize = 256;

fn operators() -> [Box<dyn Operator>; 2] {
    let grid = Grid::new([SIDE, SIDE], [1.0, 1.0]).unwrap();
    [Box::new(FreeFft::new(grid, 1.0)), Box::new(PeriodicFft::new(grid, 1.0))]
}

fn rough(grid: &Grid) -> Field {
    let form = SelfAffine { hurst: 0.8, rolloff: None, shortest: Some(8.0), amplitude: Amplitude::Sdq(0.1) };
    -form.generate(grid, 1).unwrap().into_heights()
}

fn solve(
    operator: &mut dyn Operator,
    gap: &Field,
    mean: f64,
    start: Option<&Field>,
    tolerance: f64,
) -> Solution {
    let load = Control::Load(mean * operator.grid().area());
    let params = Params::default().with_method(Method::ActiveSet).with_tolerance(tolerance);
    solve_normal(operator, gap, &Bounds::ELASTIC, load, start, &params).unwrap()
}

#[test]
fn a_solve_takes_eight_doubles_for_each_cell_besides_the_transforms() {
    let _alone = ONE_AT_A_TIME.lock().unwrap();
    for mut operator in operators() {
        let gap = rough(operator.grid());
        for mean in [0.0025, 0.05, 0.5] {
            // The operator keeps the scratch of its transforms from the first solve on.
            solve(operator.as_mut(), &gap, mean, None, 1e-6);
            let before = HELD.load(Relaxed);
            PEAK.store(before, Relaxed);
            let solution = solve(operator.as_mut(), &gap, mean, None, 1e-6);
            let doubles = (PEAK.load(Relaxed) - before) as f64 / 8.0;
            let per_cell = 1.0 + doubles / gap.len() as f64;
            let share = solution.contact_cells() as f64 / gap.len() as f64;
            assert!(per_cell < 8.0, "{per_cell:.2}, the gap included, at {share:.2} in contact");
        }
    }
}

#[test]
fn nothing_is_allocated_from_step_to_step() {
    let _alone = ONE_AT_A_TIME.lock().unwrap();
    for mut operator in operators() {
        let gap = rough(operator.grid());
        let start = solve(operator.as_mut(), &gap, 0.002, None, 1e-6).pressure;
        let [few, many] = [1e-2, 1e-9].map(|tolerance| {
            let before = CALLS.load(Relaxed);
            let solution = solve(operator.as_mut(), &gap, 0.01, Some(&start), tolerance);
            (solution.stats.convolutions, CALLS.load(Relaxed) - before)
        });
        assert!(few.0 < 0.7 * many.0 && few.1 == many.1, "convolutions and allocations: {few:?}, {many:?}");
    }
}
