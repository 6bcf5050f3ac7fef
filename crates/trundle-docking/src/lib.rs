//! Fine positioning in narrow spaces: rotations and straight moves, footprint-exact.

mod bound;
mod cloud;
mod config;
pub mod corridor;
mod flood;
mod limits;
mod manoeuvre;
mod margin;
mod margins;
pub mod optimal;
mod pace;
pub mod paper;
mod plan;
mod planner;
mod positioner;
pub mod scene;
mod space;

pub use config::{DockingConfig, Method};
pub use limits::MotionLimits;
pub use manoeuvre::{Manoeuvre, Motion, Step};
pub use margin::margin_of;
pub use optimal::Certificate;
pub use pace::Planning;
pub use plan::{Impossible, Limit, Plan, Refusal, Solution};
pub use planner::Docker;
pub use positioner::{Positioner, PositionerConfig, PositionerInput, PositionerReport, Reason};
pub use scene::{Blocker, Obstacle, Scene, Thing};
pub use space::{FreeDrive, FreeTurn, Space};
