//! The commands of the capabilities that need no case: they begin from a map in a file.

mod conductance;
mod flow;

use clap::Subcommand;

use crate::report::Outcome;
use conductance::Conductance;
use flow::Flow;

#[derive(Debug, Subcommand)]
pub(crate) enum FromMap {
    Conductance(Conductance),
    Flow(Flow),
}

impl FromMap {
    pub(crate) fn run(&self) -> Outcome {
        match self {
            Self::Conductance(arguments) => conductance::conductance(arguments),
            Self::Flow(arguments) => flow::flow(arguments),
        }
    }
}
