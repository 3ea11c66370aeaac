//! The command `asperity-mpi`: a static contact on a grid distributed over the ranks of MPI.

mod memory; // check of the memory of the machines
mod world; // the processes started by mpirun

use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::Arc;
use std::time::Duration;

use asperity_base::Error;
use asperity_base::ranks::Ranks;
use asperity_cli::{Program, print_data, report_error, report_warning, text_of_results};
use asperity_mpi::{collect, run_on_ranks};
use asperity_study::{Case, Existing, Results, Summary};
use clap::{Parser, Subcommand};
use mpi::Threading;
use mpi::topology::SimpleCommunicator;
use mpi::traits::Communicator;

use memory::check;
use world::World;

/// Compute a static contact on a grid that is divided among MPI ranks, each with a slab of rows
#[derive(Debug, Parser)]
#[command(version, after_help = "For example: mpirun -np 4 asperity-mpi run case.toml --collect")]
struct Arguments {
    #[command(subcommand)]
    command: Command,
}

#[derive(Debug, Subcommand)]
enum Command {
    /// Compute the static contact of a case on all ranks started by mpirun
    Run {
        /// Case file; all ranks must be able to read it
        #[arg(value_name = "CASE.toml")]
        case: PathBuf,
        /// Results directory on a file system shared by all ranks; default: case file name with `-results`
        #[arg(long, value_name = "DIR")]
        out: Option<PathBuf>,
        /// Replace existing results
        #[arg(long)]
        overwrite: bool,
        /// Gather the fields of all ranks into fields.h5 at the end; the first rank must have enough memory
        #[arg(long)]
        collect: bool,
    },
    /// Gather the fields of the ranks of a finished run into fields.h5
    Collect {
        /// Results directory
        #[arg(value_name = "DIR")]
        results: PathBuf,
    },
}

fn main() -> ExitCode {
    asperity_cli::survive_size_limit();
    let Some((universe, _)) = mpi::initialize_with_threading(Threading::Serialized) else {
        unreachable!("nothing has initialised MPI before");
    };
    let rank = World::new().rank();
    end_all_on_panic();
    let arguments = match Arguments::try_parse() {
        Ok(arguments) => arguments,
        Err(error) => {
            if rank == 0 {
                let _ = error.print();
            }
            drop(universe);
            return ExitCode::from(error.exit_code() as u8);
        }
    };
    // Each rank is one thread: machines with many cores have many ranks.
    let threads = rayon::ThreadPoolBuilder::new().num_threads(1).build_global();
    threads.expect("nothing has used the threads before");
    match run(arguments.command) {
        Ok(()) => ExitCode::SUCCESS,
        Err(error) => fail(rank, error),
    }
}

fn run(command: Command) -> Result<(), Error> {
    match command {
        Command::Run { case: path, out, overwrite, collect: collects } => {
            let case = Case::load(&path)?;
            let directory = out.unwrap_or_else(|| results_of(&path));
            let existing = if overwrite { Existing::Overwrite } else { Existing::Keep };
            let ranks: Arc<dyn Ranks> = Arc::new(World::new());
            check(&case, &*ranks, collects)?;
            let summary = run_on_ranks(&case, &ranks, &directory, existing)?;
            let memory = ranks.gather(&[peak_memory()], &vec![1; ranks.count()]);
            if let Some(mut summary) = summary {
                if collects {
                    collect(&directory)?;
                    summary = Results::open(&directory)?.summary()?;
                }
                summary.warnings.iter().for_each(|warning| report_warning(warning));
                print_data(&text(&case, &summary, &memory))?;
            }
        }
        Command::Collect { results } => {
            if World::new().rank() == 0 {
                memory::check_collecting(&results)?;
                collect(&results)?;
            }
        }
    }
    Ok(())
}

/// Returns the default results directory of a case.
fn results_of(case: &Path) -> PathBuf {
    let mut name = case.file_stem().unwrap_or_default().to_owned();
    name.push("-results");
    PathBuf::from(name)
}

/// Formats the contact in numbers, like `asperity run`, and the peak memory of the ranks.
fn text(case: &Case, summary: &Summary, memory: &[f64]) -> String {
    let most = memory.iter().copied().fold(0.0, f64::max);
    format!(
        "{}ranks             {}, each of at most {:.1} MB\ntime              {:.2} s\n",
        text_of_results(case, summary, &summary.found, &[]),
        memory.len(),
        most / 1e6,
        summary.wall_time_s
    )
}

/// Returns the peak memory of this process in bytes; 0 if the system does not report it.
fn peak_memory() -> f64 {
    let status = std::fs::read_to_string("/proc/self/status").unwrap_or_default();
    let peak = status.lines().find_map(|line| line.strip_prefix("VmHWM:"));
    let number =
        peak.and_then(|peak| peak.split_whitespace().next()).and_then(|peak| peak.parse::<f64>().ok());
    1024.0 * number.unwrap_or(0.0)
}

/// Reports the error and ends all ranks, which would wait for this one.
fn fail(rank: usize, error: Error) -> ExitCode {
    // Most errors occur on all ranks, so the first one reports them.
    if rank > 0 {
        std::thread::sleep(Duration::from_secs(2));
    }
    let code = report_error(error, Program::Rank(rank));
    SimpleCommunicator::world().abort(code.into())
}

/// Makes a panic end all ranks.
fn end_all_on_panic() {
    let tell = std::panic::take_hook();
    std::panic::set_hook(Box::new(move |panic| {
        tell(panic);
        SimpleCommunicator::world().abort(101);
    }));
}
