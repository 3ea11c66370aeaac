//! Arguments of `asperity study`.

use std::path::PathBuf;

use asperity::solver::Device;
use asperity::study::parametric::Task;
use clap::Args;

use super::values::{choice, threads};

/// Compute a study: variations of one case over axes of values or the rows of a table
///
/// Each case is a folder DIR/cases/0001 with its case.toml and its results. DIR/table.csv and study.html
/// summarise all cases. Any number of processes, on machines with a common file system, may work on one study
/// at the same time. If one is stopped or killed, run the same command again. The exit code is 1 if a case
/// has failed.
#[derive(Debug, Args)]
#[command(
    after_help = "Examples:\n  asperity example study\n  asperity study study/load.toml\n  asperity study load.toml --task \
$SLURM_ARRAY_TASK_ID/$SLURM_ARRAY_TASK_COUNT --threads 1"
)]
pub(crate) struct Study {
    /// Study file
    #[arg(value_name = "STUDY.toml")]
    pub(crate) study: PathBuf,
    /// Directory of the study; default: study file name without its extension
    #[arg(long, value_name = "DIR")]
    pub(crate) out: Option<PathBuf>,
    /// Run only case I and every N-th case after it
    #[arg(long, value_name = "I/N", value_parser = task)]
    pub(crate) task: Option<Task>,
    /// Compute nothing; print the state of the cases and which are running
    #[arg(long, conflicts_with_all = ["collect", "retry"])]
    pub(crate) list: bool,
    /// Compute nothing; write the table and the page of the finished cases
    #[arg(long, conflicts_with = "retry")]
    pub(crate) collect: bool,
    /// Allow more than 5000 cases
    #[arg(long)]
    pub(crate) yes: bool,
    #[command(flatten)]
    pub(crate) cases: Cases,
}

/// How cases are computed.
#[derive(Debug, Args)]
pub(crate) struct Cases {
    /// Repeat failed cases
    #[arg(long)]
    pub(crate) retry: bool,
    /// Number of threads, and of cases at a time, at most 1024; default: the limit of a scheduler or
    /// container, otherwise all cores
    #[arg(long, value_name = "N", value_parser = threads)]
    pub(crate) threads: Option<usize>,
    /// Device that solves the contacts, in place of `device` in [contact]: cpu, cuda (a GPU of NVIDIA) or
    /// host
    #[arg(long, value_name = "DEVICE", value_parser = choice::<Device>())]
    pub(crate) device: Option<Device>,
    /// Print only warnings and errors
    #[arg(long)]
    pub(crate) quiet: bool,
}

fn task(text: &str) -> Result<Task, String> {
    let numbers =
        text.split_once('/').and_then(|(number, of)| Some((number.parse().ok()?, of.parse().ok()?)));
    match numbers {
        Some((number, of)) if (1..=of).contains(&number) => Ok(Task { number, of }),
        Some((0, of)) => Err(format!("tasks are numbered from 1: 1/{of} to {of}/{of}")),
        Some((_, of)) => Err(format!("there are {of} tasks: 1/{of} to {of}/{of}")),
        None => Err("expected two whole numbers such as 3/40".to_owned()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_task_is_one_of_all() {
        assert_eq!(task("3/40"), Ok(Task { number: 3, of: 40 }));
        assert_eq!(task("5/4").unwrap_err(), "there are 4 tasks: 1/4 to 4/4");
        assert!(task("0/4").unwrap_err().contains("from 1"));
        assert!(task("4").is_err() && task("-1/4").is_err() && task("1/0").is_err());
    }
}
