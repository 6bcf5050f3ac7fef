//! The last check before the wheels: it passes only twists from which the robot can still stop.
//!
//! Problem: a plan rests on a map and an estimate, and both can be wrong. Idea: sweep the footprint along the
//! commanded arc against the last scan, carried forward by odometry, and against the map near by (the camera is blind below 0.5 m). Allow
//! the speed at which the robot still stops before the first contact. Obstacles that the footprint does not sweep do not matter, such as
//! a wall beside it. A disc may always turn on the spot; a polygon only as fast as it can stop before a corner meets an obstacle.
//! The monitor uses no plan and no goal. Cost: O(beams + cells within reach), without allocation after the first call.
//!
//! Reaction and braking over the free distance s: v t + v^2 / (2 a) <= s, so v = -a t + sqrt(a^2 t^2 + 2 a s).

pub(crate) mod hold;
pub(crate) mod obstacles;
pub(crate) mod safety_action;
pub(crate) mod safety_config;
pub(crate) mod safety_monitor;
pub(crate) mod station_motion;
