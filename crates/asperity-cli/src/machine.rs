//! The machine: how much memory there is, and whether it suffices.

use asperity::study::{self, Case, Demand, SurfaceInput};
use asperity::{Error, Result};
use sysinfo::{MemoryRefreshKind, RefreshKind, System};

/// What the case takes on all threads, an error if there is not so much.
pub(crate) fn demand(case: &Case) -> Result<Demand> {
    let demand = study::demand(case, &SurfaceInput::default(), rayon::current_num_threads())?;
    demand.fits(available())?;
    Ok(demand)
}

/// An error if there is less memory than so many bytes.
pub(crate) fn holds(needed: f64) -> Result<()> {
    let available = available();
    if needed <= available { Ok(()) } else { Err(Error::Memory { needed, available }) }
}

/// Returns the bytes that this process can have: memory and swap of the machine or its container, within the limit of its address
/// space (`ulimit -v`).
pub fn available() -> f64 {
    address_space().map_or(f64::INFINITY, |bytes| bytes as f64).min(on_machine())
}

/// Returns the free bytes of memory and swap of the machine, or of the container, which all its processes share.
pub fn on_machine() -> f64 {
    let memory = MemoryRefreshKind::nothing().with_ram().with_swap();
    let system = System::new_with_specifics(RefreshKind::nothing().with_memory(memory));
    let system = sysinfo::IS_SUPPORTED_SYSTEM.then_some(system);
    let free = system.as_ref().map(|system| system.available_memory() + system.free_swap());
    // What a container holds of files can be had back: only what is resident is taken.
    let limits = system.and_then(|system| system.cgroup_limits());
    let contained = limits.map(|limits| limits.total_memory.saturating_sub(limits.rss));
    [free, contained].into_iter().flatten().fold(f64::INFINITY, |least, bytes| least.min(bytes as f64))
}

/// Returns what this machine is known by: the same for all processes that share its kernel, and for no others.
pub fn name() -> String {
    let host = System::host_name().unwrap_or_else(|| "unknown".to_owned());
    // Containers of one name need not be one machine, nor is a machine after a new start.
    let boot = std::fs::read_to_string("/proc/sys/kernel/random/boot_id");
    let boot = boot.unwrap_or_else(|_| System::boot_time().to_string());
    format!("{host} {}", boot.trim())
}

/// What is left of the address space, where it is limited.
#[cfg(unix)]
fn address_space() -> Option<u64> {
    /// Bytes of a memory page.
    const PAGE: u64 = 4096;
    let (limit, _) = rlimit::Resource::AS.get().ok().filter(|(limit, _)| *limit != rlimit::INFINITY)?;
    let sizes = std::fs::read_to_string("/proc/self/statm").unwrap_or_default();
    let pages: u64 = sizes.split_whitespace().next().and_then(|pages| pages.parse().ok()).unwrap_or(0);
    Some(limit.saturating_sub(PAGE * pages))
}

#[cfg(not(unix))]
fn address_space() -> Option<u64> {
    None
}
