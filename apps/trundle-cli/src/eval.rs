//! `trundle eval`: errors of a trajectory or a map against the truth.

mod args;
mod maps;
mod named_error;
mod relations;

pub use args::EvalArgs;

use crate::outcome::Outcome;
use args::Which;
use trundle::app::AppError;

/// `trundle eval ...`.
pub fn run(args: &EvalArgs) -> Result<Outcome, AppError> {
    match &args.which {
        Which::Relations(args) => relations::run(args),
        Which::Map(args) => maps::run(args),
    }
}
