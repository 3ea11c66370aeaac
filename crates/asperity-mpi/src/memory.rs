//! Check that the machines have enough memory for their ranks.

use std::path::Path;

use asperity_base::Error;
use asperity_base::ranks::Ranks;
use asperity_cli::{available_memory, machine_name, memory_of_machine};
use asperity_mpi::{DemandOfRank, demand_of_collecting, demand_on_ranks};
use asperity_study::Case;

/// Returns an error on all ranks if a machine has too little memory for its ranks, or a rank for itself. If
/// the fields are `collected` at the end, the first rank needs the memory of all of them.
pub(crate) fn check(case: &Case, ranks: &dyn Ranks, collected: bool) -> Result<(), Error> {
    let DemandOfRank { steady, making, collecting, .. } = demand_on_ranks(case, ranks.count())?;
    let collecting = if collected { collecting } else { 0.0 };
    let own = [machine(), steady, making, collecting, available_memory(), memory_of_machine()];
    let all = ranks.gather(&own, &vec![own.len(); ranks.count()]);
    let all: Vec<Rank> = all.chunks(own.len()).map(Rank::new).collect();
    let short = all.iter().enumerate().find_map(|(rank, this)| {
        let alone = this.steady.max(this.making).max(if rank == 0 { this.collecting } else { 0.0 });
        let neighbours = all.iter().filter(|other| other.machine == this.machine);
        let together: f64 = neighbours.map(|other| other.steady).sum();
        [(alone, this.available), (together.max(alone), this.on_machine)]
            .into_iter()
            .find(|(needed, available)| needed > available)
    });
    match short {
        None => Ok(()),
        Some((needed, available)) => Err(Error::Memory { needed, available }),
    }
}

/// Returns an error if there is too little memory to collect the fields of the `results`.
pub(crate) fn check_collecting(results: &Path) -> Result<(), Error> {
    let (needed, available) = (demand_of_collecting(results)?, available_memory());
    if needed <= available { Ok(()) } else { Err(Error::Memory { needed, available }) }
}

/// Needed and available memory of a rank, bytes.
struct Rank {
    machine: f64,
    steady: f64,
    making: f64,
    collecting: f64,
    available: f64,
    on_machine: f64,
}

impl Rank {
    fn new(numbers: &[f64]) -> Self {
        let [machine, steady, making, collecting, available, on_machine] = *numbers else {
            unreachable!("each rank gives six numbers")
        };
        Self { machine, steady, making, collecting, available, on_machine }
    }
}

/// Returns a number shared by the ranks of one machine only.
fn machine() -> f64 {
    use std::hash::{DefaultHasher, Hash, Hasher};
    let mut hasher = DefaultHasher::new();
    machine_name().hash(&mut hasher);
    // As many binary digits as an `f64` represents exactly.
    (hasher.finish() >> 12) as f64
}
