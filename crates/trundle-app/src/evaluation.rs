//! Judging a trajectory by its absolute and relative errors: numbers, pictures and page.

mod output;
mod page;
mod trajectory_evaluation;

pub use output::write_evaluation;
pub use trajectory_evaluation::TrajectoryEvaluation;
