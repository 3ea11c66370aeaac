//! Memory of the machine.

use asperity::solver::Card;
use asperity::study::{self, Case, Demand, SurfaceInput};
use asperity::{Error, Result};
use sysinfo::{MemoryRefreshKind, RefreshKind, System};

/// Returns the demand of the case on all threads, or an error if the memory is insufficient.
pub(crate) fn demand(case: &Case) -> Result<Demand> {
    let demand = study::demand(case, &SurfaceInput::default(), rayon::current_num_threads())?;
    demand.fits(available())?;
    Ok(demand)
}

/// The card that solves a case.
pub(crate) struct OnDevice {
    pub(crate) card: Card,
    /// Memory of the contact on it, bytes.
    pub(crate) needed: f64,
}

/// Opens the device that solves the case, if it is not the processor, before anything is computed.
pub(crate) fn device(case: &Case) -> Result<Option<OnDevice>> {
    let Some(card) = case.contact.device.card()? else { return Ok(None) };
    let needed = study::memory_on_device(case, &SurfaceInput::default(), rayon::current_num_threads())?;
    if needed > card.free {
        return Err(Error::DeviceMemory { device: card.name, needed, free: card.free });
    }
    Ok(Some(OnDevice { card, needed }))
}

/// Returns an error if there is less memory than this number of bytes.
pub(crate) fn holds(needed: f64) -> Result<()> {
    let available = available();
    if needed <= available { Ok(()) } else { Err(Error::Memory { needed, available }) }
}

/// Returns the bytes available to this process: memory and swap of the machine or its container, up to the
/// limit of its address space (`ulimit -v`).
pub fn available() -> f64 {
    address_space().map_or(f64::INFINITY, |bytes| bytes as f64).min(on_machine())
}

/// Returns the free bytes of memory and swap of the machine or of the container, shared by all its processes.
pub fn on_machine() -> f64 {
    let memory = MemoryRefreshKind::nothing().with_ram().with_swap();
    let system = System::new_with_specifics(RefreshKind::nothing().with_memory(memory));
    let system = sysinfo::IS_SUPPORTED_SYSTEM.then_some(system);
    let free = system.as_ref().map(|system| system.available_memory() + system.free_swap());
    // The file cache of a container can be reclaimed, so only resident memory counts.
    let limits = system.and_then(|system| system.cgroup_limits());
    let contained = limits.map(|limits| limits.total_memory.saturating_sub(limits.rss));
    [free, contained].into_iter().flatten().fold(f64::INFINITY, |least, bytes| least.min(bytes as f64))
}

/// Returns an identifier of this machine. It is equal for all processes under its kernel, and unique.
pub fn name() -> String {
    let host = System::host_name().unwrap_or_else(|| "unknown".to_owned());
    // Containers with one host name may be different machines, and a restarted machine counts as another one.
    let boot = std::fs::read_to_string("/proc/sys/kernel/random/boot_id");
    let boot = boot.unwrap_or_else(|_| System::boot_time().to_string());
    format!("{host} {}", boot.trim())
}

/// Returns the remaining address space, if it is limited.
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
