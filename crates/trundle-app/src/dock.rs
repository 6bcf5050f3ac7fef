//! Pictures and tables of a manoeuvre of turns and straight moves.

mod picture;
mod table;

pub use picture::{DockingObstacles, manoeuvre_picture, step_pictures, view};
pub use table::{motions, rows, steps_csv, verdict};
