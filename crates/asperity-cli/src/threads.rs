//! The threads that share the work of a command.

use std::thread::available_parallelism;

use rayon::ThreadPoolBuilder;

use crate::report::{Failure, Outcome, note};

/// Makes so many threads, by default one for each core; the first of them is the one that calls.
pub(crate) fn start(wanted: Option<usize>) -> Outcome {
    let cores = available_parallelism().map_or(1, usize::from);
    if let Some(wanted) = wanted.filter(|wanted| *wanted > cores) {
        note(&format!(
            "note: --threads {wanted} is more than the {cores} of this machine's cores: more memory, no less time"
        ));
    }
    let pool = ThreadPoolBuilder::new().num_threads(wanted.unwrap_or(0)).use_current_thread();
    pool.build_global().map_err(|error| Failure::Threads { reason: error.to_string() })
}
