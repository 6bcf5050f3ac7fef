//! The native module of the Python package `trundle`: classes and functions of the crates with arrays of numpy.
//!
//! Long calls release the interpreter's lock. Input of a wrong type raises `TypeError`; an invalid value raises `ValueError` with the
//! message of the crates.

mod arrays;
mod body_events;
mod camera;
mod command;
mod docking;
mod errors;
mod evaluation;
mod event_kinds;
mod events;
mod geometry;
mod grid;
mod mapper;
mod numbers;
mod planning;
mod rgbd;
mod robot;
mod robot_config;
mod scan;
mod sim_drive;
mod simulator;
mod simulator_pool;
mod slam;
mod track;
mod tum;

use pyo3::prelude::*;

/// Classes and functions; the package `trundle` re-exports them.
#[pymodule]
mod _native {
    #[pymodule_export]
    use crate::body_events::{BodyCondition, Odometry, Truth};
    #[pymodule_export]
    use crate::camera::Camera;
    #[pymodule_export]
    use crate::command::run_command;
    #[pymodule_export]
    use crate::docking::dock;
    #[pymodule_export]
    use crate::evaluation::{ate, rpe};
    #[pymodule_export]
    use crate::events::{Cliff, Gyro, Touch, Wheels};
    #[pymodule_export]
    use crate::grid::OccupancyGrid;
    #[pymodule_export]
    use crate::mapper::{GridMapper, ParticleMapper};
    #[pymodule_export]
    use crate::planning::plan;
    #[pymodule_export]
    use crate::rgbd::Rgbd;
    #[pymodule_export]
    use crate::robot::{Robot, Step};
    #[pymodule_export]
    use crate::robot_config::RobotConfig;
    #[pymodule_export]
    use crate::scan::Scan;
    #[pymodule_export]
    use crate::simulator::Simulator;
    #[pymodule_export]
    use crate::simulator_pool::SimulatorPool;
    #[pymodule_export]
    use crate::slam::{RgbdSlam, slam_folder};
    #[pymodule_export]
    use crate::track::Track;
    #[pymodule_export]
    use crate::tum::{TumSequence, read_laser_log, read_trajectory, write_trajectory};
}
