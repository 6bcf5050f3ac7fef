//! A manoeuvre of turns and straight moves outside a run: the task, its pictures, tables and folder.

mod impossible;
mod output;
mod picture;
mod request;
mod result;
mod table;
mod task;

pub use output::write_docking;
pub use picture::{DockingObstacles, manoeuvre_picture, step_pictures, view};
pub use request::DockingRequest;
pub use result::DockingResult;
pub use table::{motions, rows, steps_csv, verdict};
pub use task::{DockingTask, built_in_problem, file_problem};
