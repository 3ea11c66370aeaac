//! Threads that share the work of a command.

use std::env;
use std::thread::available_parallelism;

use asperity::{Error, Result};
use rayon::ThreadPoolBuilder;

use crate::report::note;

/// Largest number of threads.
pub const MAX_THREADS: usize = 1024;

/// Creates this number of threads, by default those available to this process. The first of them is the
/// calling thread.
pub(crate) fn start(wanted: Option<usize>) -> Result<()> {
    // Rayon takes its own variable, the affinity of the process and the limit of its control group into
    // account.
    let cores = available_parallelism().map_or(1, usize::from);
    if let Some(wanted) = wanted.filter(|wanted| *wanted > cores) {
        note(&format!(
            "note: --threads {wanted} is more than the {cores} of this machine's cores: more memory, no less time"
        ));
    }
    let own = env::var_os("RAYON_NUM_THREADS").is_none_or(|value| value.is_empty());
    let share = own.then(|| share_of_scheduler(|name| env::var(name).ok())).flatten();
    let threads = wanted.or(share.map(|share| share.min(cores))).unwrap_or(0);
    let pool = ThreadPoolBuilder::new().num_threads(threads).use_current_thread();
    pool.build_global().map_err(|error| Error::Threads { reason: error.to_string() })
}

/// Returns the cores of a SLURM task. Without a number for the task, returns the cores of the job on this
/// machine.
fn share_of_scheduler(variable: impl Fn(&str) -> Option<String>) -> Option<usize> {
    let count = |name| variable(name)?.trim().parse().ok().filter(|count| *count >= 1);
    count("SLURM_CPUS_PER_TASK").or_else(|| count("SLURM_CPUS_ON_NODE"))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_share_of_a_task_is_what_the_scheduler_says() {
        let told = |known: &'static [(&str, &str)]| {
            share_of_scheduler(|name| {
                known.iter().find(|(key, _)| *key == name).map(|(_, value)| (*value).to_owned())
            })
        };
        assert_eq!(told(&[]), None);
        assert_eq!(told(&[("SLURM_CPUS_PER_TASK", "4"), ("SLURM_CPUS_ON_NODE", "128")]), Some(4));
        assert_eq!(told(&[("SLURM_CPUS_ON_NODE", "8")]), Some(8));
        assert_eq!(told(&[("SLURM_CPUS_PER_TASK", "all")]), None);
    }
}
