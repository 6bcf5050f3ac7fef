//! A manoeuvre of turns and straight moves outside a run: the task, its pictures, tables and folder.

mod output;
mod picture;
mod table;
mod task;

pub use output::{impossible_text, write_docking};
pub use picture::{DockingObstacles, manoeuvre_picture, step_pictures, view};
pub use table::{motions, rows, steps_csv, verdict};
pub use task::{DockingTask, ScanProblem, built_in_problem, file_problem, scan_problem};
