//! Evaluating a trajectory or a map against the truth: numbers, pictures and page.

mod map_evaluation;
mod named_error;
mod output;
mod page;
mod relations;
mod trajectory_evaluation;

pub use map_evaluation::MapEvaluation;
pub use output::{write_evaluation, write_summary_folder};
pub use relations::{RelationEvaluation, RelationReference, unrounded_trajectory};
pub use trajectory_evaluation::TrajectoryEvaluation;
