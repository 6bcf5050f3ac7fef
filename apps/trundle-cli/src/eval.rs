//! `trundle eval`: errors of a trajectory or a map against the truth.

mod args;
mod maps;
mod named_error;
mod relations;
mod trajectory;

pub use args::EvalArgs;

use crate::outcome::Outcome;
use args::Which;
use trundle::app::AppError;

/// `trundle eval ...`.
pub fn run(args: &EvalArgs) -> Result<Outcome, AppError> {
    match &args.which {
        Which::Trajectory(args) => trajectory::run(args),
        Which::Relations(args) => relations::run(args),
        Which::Map(args) => maps::run(args),
    }
}
