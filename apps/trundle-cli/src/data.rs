//! `trundle data`: the data sets that do not come with trundle.

use crate::console;
use crate::outcome::Outcome;
use clap::{Args, Subcommand};
use trundle::app::AppError;
use trundle::experiments::data_sets::DATA_SETS;

/// `trundle data`
#[derive(Debug, Args)]
pub struct DataArgs {
    /// The action.
    #[command(subcommand)]
    pub command: DataCommand,
}

/// Actions on data sets.
#[derive(Debug, Subcommand)]
pub enum DataCommand {
    /// List each data set: description, source, licence, and the command that fetches it.
    FetchList,
}

/// `trundle data ...`.
pub fn run(args: &DataArgs) -> Result<Outcome, AppError> {
    match args.command {
        DataCommand::FetchList => {
            DATA_SETS.iter().flat_map(|set| set.lines()).for_each(|line| console::print(&line))
        }
    }
    Ok(Outcome::Reached)
}
