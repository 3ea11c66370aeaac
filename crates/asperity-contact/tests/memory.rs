//! Memory use of a solve, counted by a special allocator, so that these tests run one after another.

use std::alloc::{GlobalAlloc, Layout, System};
use std::sync::Mutex;
use std::sync::atomic::{AtomicUsize, Ordering::Relaxed};

use asperity_base::{Field, Grid};
use asperity_contact::operator::{Boundary, Operator, Operators};
use asperity_contact::solver::{Bounds, Control, Method, Params, Solution, solve_normal};
use asperity_surface::{Amplitude, SelfAffine};

struct Counting;

static HELD: AtomicUsize = AtomicUsize::new(0);
static PEAK: AtomicUsize = AtomicUsize::new(0);
/// Allocations whose size grows with the number of cells.
static CALLS: AtomicUsize = AtomicUsize::new(0);

#[expect(unsafe_code, reason = "an allocator is unsafe; this one hands everything on to the system's")]
unsafe impl GlobalAlloc for Counting {
    unsafe fn alloc(&self, layout: Layout) -> *mut u8 {
        CALLS.fetch_add(usize::from(layout.size() >= LARGE), Relaxed);
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

/// Held by the counting test.
static ONE_AT_A_TIME: Mutex<()> = Mutex::new(());

const SIDE: usize = 256;
/// A quarter of a field in single precision, bytes.
const LARGE: usize = SIDE * SIDE;

fn square() -> Grid {
    Grid::new([SIDE, SIDE], [1.0, 1.0]).unwrap()
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
    // Each further thread has its own scratch memory.
    let one = rayon::ThreadPoolBuilder::new().num_threads(1).build().unwrap();
    one.install(|| solve_normal(operator, gap, &Bounds::ELASTIC, load, start, &params).unwrap())
}

#[test]
fn a_contact_takes_no_more_than_so_many_bytes_for_each_cell() {
    let _alone = ONE_AT_A_TIME.lock().unwrap();
    // Its operator, padded for a free boundary, and its gap; 16 more for the heights of two bodies.
    for (boundary, most) in [(Boundary::FREE, 72.0), (Boundary::PERIODIC, 61.0)] {
        for mean in [0.0025, 0.05, 0.5] {
            let before = HELD.load(Relaxed);
            PEAK.store(before, Relaxed);
            let grid = square();
            let gap = rough(&grid);
            let mut operator = Operators::new(grid, 1.0, boundary).on(grid.shape);
            let solution = solve(operator.as_mut(), &gap, mean, None, 1e-6);
            let bytes = (PEAK.load(Relaxed) - before) as f64 / gap.len() as f64;
            let share = solution.contact_cells() as f64 / gap.len() as f64;
            assert!(bytes < most, "{bytes:.1}, at {share:.2} in contact");
        }
    }
}

#[test]
fn no_field_is_allocated_from_step_to_step() {
    let _alone = ONE_AT_A_TIME.lock().unwrap();
    for boundary in [Boundary::FREE, Boundary::PERIODIC] {
        let mut operator = Operators::new(square(), 1.0, boundary).on([SIDE; 2]);
        let gap = rough(operator.grid());
        let start = solve(operator.as_mut(), &gap, 0.002, None, 1e-6).pressure;
        // Tolerances that need double precision equally often: the scratch memory of the transforms changes
        // with them.
        let [few, many] = [1e-1, 5e-3].map(|tolerance| {
            let before = CALLS.load(Relaxed);
            let solution = solve(operator.as_mut(), &gap, 0.01, Some(&start), tolerance);
            (solution.stats.convolutions, CALLS.load(Relaxed) - before)
        });
        assert!(few.0 < 0.8 * many.0 && few.1 == many.1, "convolutions and allocations: {few:?}, {many:?}");
    }
}
