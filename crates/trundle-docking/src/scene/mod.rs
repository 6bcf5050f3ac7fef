//! Obstacles around the robot: segments, points, solids and cells.

pub(crate) mod blocker;
pub(crate) mod cells;
pub(crate) mod clearance_query;
pub(crate) mod obstacle_scene;
pub(crate) mod outline;
pub(crate) mod point_index;
