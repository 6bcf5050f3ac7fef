//! Judging a trajectory by its absolute and relative errors: numbers, pictures and page.

mod output;
mod page;
mod relations;
mod trajectory_evaluation;

pub use output::write_evaluation;
pub use relations::{path_length, relation_rows, relation_summary, unrounded_trajectory};
pub use trajectory_evaluation::TrajectoryEvaluation;
